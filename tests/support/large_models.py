#!/usr/bin/env python3
"""Writes large glTF models to measure with: `instances.glb`, in which 1,000 nodes share one mesh of 5,000 triangles, and
`terrain.glb`, one mesh of 2 million triangles.

  tests/support/large_models.py FOLDER
"""

import array
import json
import math
import pathlib
import struct
import sys


def surface(columns, rows, vertex):
    """Positions and normals of a grid of quads, and the indices of two triangles a quad. vertex(u, v) gives both."""
    positions, normals, indices = array.array("f"), array.array("f"), array.array("I")
    for y in range(rows + 1):
        for x in range(columns + 1):
            position, normal = vertex(x / columns, y / rows)
            positions.extend(position)
            normals.extend(normal)
    for y in range(rows):
        for x in range(columns):
            a, b = y * (columns + 1) + x, (y + 1) * (columns + 1) + x
            indices.extend((a, b, b + 1, a, b + 1, a + 1))
    return positions, normals, indices


def ball(u, v):
    """A little flattened at its poles, so that no triangle there is without area."""
    polar, around = 0.02 + v * (math.pi - 0.04), -2 * math.pi * u
    n = (math.sin(polar) * math.cos(around), math.cos(polar), math.sin(polar) * math.sin(around))
    return [0.4 * c for c in n], n


def hills(u, v):
    x, z = 40 * (u - 0.5), 40 * (v - 0.5)
    slope_x, slope_z = math.cos(x) * math.cos(0.7 * z), -0.7 * math.sin(x) * math.sin(0.7 * z)
    length = math.sqrt(slope_x**2 + slope_z**2 + 1)
    return (x, math.sin(x) * math.cos(0.7 * z), z), (-slope_x / length, 1 / length, -slope_z / length)


def floor(u, v):
    return (40 * (u - 0.5), -0.4, 40 * (v - 0.5)), (0, 1, 0)


def write(file, meshes, nodes):
    data, views, accessors, described = bytearray(), [], [], []
    for positions, normals, indices in meshes:
        first = len(accessors)
        for values, kind, width in ((positions, "VEC3", 3), (normals, "VEC3", 3), (indices, "SCALAR", 1)):
            views.append({"buffer": 0, "byteOffset": len(data), "byteLength": 4 * len(values)})
            accessors.append({"bufferView": len(views) - 1, "componentType": 5125 if width == 1 else 5126,
                              "count": len(values) // width, "type": kind})
            data += values.tobytes()
        described.append({"primitives": [{"attributes": {"POSITION": first, "NORMAL": first + 1}, "indices": first + 2}]})
    nodes = nodes + [{"rotation": [-0.6, 0.2, 0.1, 0.768], "extensions": {"KHR_lights_punctual": {"light": 0}}},
                     {"camera": 0, "translation": [0, 7, 22], "rotation": [-0.17, 0, 0, 0.985]}]
    document = {
        "asset": {"version": "2.0"}, "extensionsUsed": ["KHR_lights_punctual"],
        "extensions": {"KHR_lights_punctual": {"lights": [{"type": "directional", "intensity": 3}]}},
        "cameras": [{"type": "perspective", "perspective": {"yfov": 0.9, "znear": 0.1}}],
        "scene": 0, "scenes": [{"nodes": list(range(len(nodes)))}], "nodes": nodes, "meshes": described,
        "accessors": accessors, "bufferViews": views, "buffers": [{"byteLength": len(data)}]}
    text = json.dumps(document).encode()
    text += b" " * (-len(text) % 4)
    chunks = struct.pack("<I4s", len(text), b"JSON") + text + struct.pack("<I4s", len(data), b"BIN\0") + data
    file.write_bytes(struct.pack("<4sII", b"glTF", 2, 12 + len(chunks)) + chunks)


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    folder = pathlib.Path(sys.argv[1])
    folder.mkdir(parents=True, exist_ok=True)
    field = [{"mesh": 0, "translation": [x - 19.5, 0, z - 12]} for x in range(40) for z in range(25)]
    write(folder / "instances.glb", [surface(50, 50, ball), surface(1, 1, floor)], field + [{"mesh": 1}])
    write(folder / "terrain.glb", [surface(1000, 1000, hills)], [{"mesh": 0}])


if __name__ == "__main__":
    main()
