"""Writes every_light.gltf and every_light.json beside this file: a small scene with every type of light, a mask, emissive
triangles on one and on both sides, smooth normals, textures with a transform, a factor and every wrap mode."""

import base64
import json
import math
import pathlib
import struct
import zlib

HERE = pathlib.Path(__file__).parent


def png(width, height, texel):
    """texel(x, y) -> four values 0..255."""
    rows = b"".join(b"\0" + bytes(v for x in range(width) for v in texel(x, y)) for y in range(height))

    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 6, 0, 0, 0))
            + chunk(b"IDAT", zlib.compress(rows, 9)) + chunk(b"IEND", b""))


class Model:
    def __init__(self):
        self.bytes, self.views, self.accessors, self.meshes, self.nodes = b"", [], [], [], []

    def accessor(self, values, kind, component="f", code=5126):
        flat = [c for v in values for c in (v if isinstance(v, (list, tuple)) else [v])]
        data = struct.pack(f"<{len(flat)}{component}", *flat)
        self.views.append({"buffer": 0, "byteOffset": len(self.bytes), "byteLength": len(data)})
        self.bytes += data
        entry = {"bufferView": len(self.views) - 1, "componentType": code, "count": len(values), "type": kind}
        if kind == "VEC3":
            entry["min"] = [min(v[i] for v in values) for i in range(3)]
            entry["max"] = [max(v[i] for v in values) for i in range(3)]
        self.accessors.append(entry)
        return len(self.accessors) - 1

    def mesh(self, name, positions, normals, uvs, indices, material, **node):
        attributes = {"POSITION": self.accessor(positions, "VEC3"), "NORMAL": self.accessor(normals, "VEC3"),
                      "TEXCOORD_0": self.accessor(uvs, "VEC2")}
        self.meshes.append({"name": name, "primitives": [
            {"attributes": attributes, "indices": self.accessor(indices, "SCALAR", "I", 5125), "material": material}]})
        self.nodes.append({"name": name, "mesh": len(self.meshes) - 1, **node})

    def quad(self, name, a, u, v, material, **node):
        """The front is the side from which u turns to v counter-clockwise."""
        add = lambda *vs: [sum(c) for c in zip(*vs)]
        n = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]]
        n = [c / math.sqrt(sum(x * x for x in n)) for c in n]
        self.mesh(name, [a, add(a, u), add(a, u, v), add(a, v)], [n] * 4, [[0, 1], [1, 1], [1, 0], [0, 0]],
                  [0, 1, 2, 0, 2, 3], material, **node)

    def sphere(self, name, centre, radius, segments, rings, material):
        positions, normals, uvs, indices = [], [], [], []
        for r in range(rings + 1):
            for s in range(segments + 1):
                t, p = math.pi * r / rings, 2 * math.pi * (s % segments) / segments
                n = [math.sin(t) * math.cos(p), math.cos(t), -math.sin(t) * math.sin(p)]
                if r in (0, rings):
                    n = [0, 1 if r == 0 else -1, 0]
                normals.append(n)
                positions.append([c + radius * x for c, x in zip(centre, n)])
                uvs.append([s / segments, r / rings])
        for r in range(rings):
            for s in range(segments):
                a, b = r * (segments + 1) + s, (r + 1) * (segments + 1) + s
                indices += ([a, b, b + 1] if r < rings - 1 else []) + ([a, b + 1, a + 1] if r > 0 else [])
        self.mesh(name, positions, normals, uvs, indices, material)


def tiles(x, y):
    """A texture coarse enough for its filter to show."""
    bright = 220 if (x // 2 + y // 2) % 2 else 90
    return [bright, (bright * 3 // 4 + 9 * x) % 256, 60 + 12 * y, 255]


def lattice(x, y):
    """Alpha runs smoothly through the cutoff, which gives round holes."""
    alpha = 0.5 + 0.5 * math.cos(math.pi * (x + 0.5) / 4) * math.cos(math.pi * (y + 0.5) / 4)
    return [40 + 8 * x, 150, 40 + 6 * y, round(255 * min(max(alpha, 0), 1))]


def glow(x, y):
    return [255, 60 + 40 * x, 30 + 50 * y, 255]


def use(index, **transform):
    return {"index": index, **({"extensions": {"KHR_texture_transform": transform}} if transform else {})}


def material(name, color=(1, 1, 1), texture=None, metallic=0, **more):
    pbr = {"baseColorFactor": [*color, 1], "metallicFactor": metallic}
    if texture:
        pbr["baseColorTexture"] = texture
    return {"name": name, "pbrMetallicRoughness": pbr, **more}


def embedded(m, images, materials, textures=None):
    """The document, with everything inside. By default texture i is image i, repeated."""
    uri = lambda kind, data: f"data:{kind};base64," + base64.b64encode(data).decode()
    sampler = lambda s, t: {"magFilter": 9729, "minFilter": 9729, "wrapS": s, "wrapT": t}
    repeat, clamp, mirror = 10497, 33071, 33648
    return {
        "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": list(range(len(m.nodes)))}],
        "extensionsUsed": ["KHR_texture_transform", "KHR_materials_emissive_strength"],
        "nodes": m.nodes, "meshes": m.meshes, "accessors": m.accessors, "bufferViews": m.views,
        "buffers": [{"byteLength": len(m.bytes), "uri": uri("application/octet-stream", m.bytes)}],
        "images": [{"uri": uri("image/png", i)} for i in images],
        "samplers": [sampler(repeat, repeat), sampler(mirror, repeat), sampler(clamp, clamp)],
        "textures": textures or [{"source": i, "sampler": 0} for i in range(len(images))],
        "materials": materials,
    }


def main():
    m = Model()
    m.quad("floor", [-3, 0, 3], [6, 0, 0], [0, 0, -6], 0)
    m.quad("back wall", [-3, 0, -3], [6, 0, 0], [0, 4, 0], 1)
    m.quad("left wall", [-3, 0, 3], [0, 0, -6], [0, 4, 0], 2)
    m.sphere("ball", [1.4, 0.8, -0.6], 0.8, 20, 12, 3)
    m.quad("lattice", [-1.9, 0.05, 0.4], [2.2, 0, -0.9], [0, 2.2, 0], 4)
    m.quad("lamp", [-0.6, 3.2, -2.2], [0, 0, 1], [1.2, 0, 0], 5, rotation=[math.sin(0.1), 0, 0, math.cos(0.1)])
    m.quad("screen", [0.4, 0.3, 1.5], [0.8, 0, -0.5], [0, 0.7, 0], 6)
    m.quad("box top", [-0.6, 0.9, -1.2], [0.8, 0, 0], [0, 0, -0.8], 7)
    m.quad("box front", [-0.6, 0, -1.2], [0.8, 0, 0], [0, 0.9, 0], 7)
    m.quad("box right", [0.2, 0, -1.2], [0, 0, -0.8], [0, 0.9, 0], 7)
    m.quad("box left", [-0.6, 0, -2.0], [0, 0, 0.8], [0, 0.9, 0], 7)
    model = embedded(m, [png(8, 8, tiles), png(16, 16, lattice), png(4, 4, glow)], [
        material("tiles", texture=use(0, offset=[0.1, 0.3], rotation=0.4, scale=[2, 1.5])),
        material("white", (0.75, 0.75, 0.72)),
        material("mirrored tiles", (0.9, 0.5, 0.4), use(1, scale=[2.5, 1])),
        material("ball", (0.6, 0.65, 0.8), metallic=0.2),
        material("lattice", texture=use(2), doubleSided=True, alphaMode="MASK", alphaCutoff=0.4),
        material("lamp", (0.5, 0.5, 0.5), emissiveFactor=[1, 0.8, 0.5],
                 extensions={"KHR_materials_emissive_strength": {"emissiveStrength": 6}}),
        material("screen", (0.2, 0.2, 0.2), emissiveFactor=[0.5, 1, 1], emissiveTexture=use(3), doubleSided=True,
                 extensions={"KHR_materials_emissive_strength": {"emissiveStrength": 1.5}}),
        material("box", (0.7, 0.3, 0.25)),
    ], textures=[{"source": 0, "sampler": 0}, {"source": 0, "sampler": 1}, {"source": 1, "sampler": 2},
                 {"source": 2, "sampler": 2}])
    scene = {
        "name": "every_light",
        "description": "every type of light, a mask, emission; generated by make_scene.py",
        "models": [{"file": "every_light.gltf"}],
        "lights": [
            {"type": "directional", "name": "sun", "intensity": 1.5, "color": [1, 0.9, 0.7],
             "direction": [-0.5, -1, -0.35]},
            {"type": "point", "name": "bulb", "intensity": 4, "color": [0.5, 0.7, 1], "position": [2.2, 2.6, 1.0]},
            {"type": "spot", "name": "spot", "intensity": 60, "color": [1, 0.85, 0.8], "position": [-1.2, 3.4, 2.6],
             "direction": [0.12, -0.75, -1], "inner_cone_deg": 8, "outer_cone_deg": 30},
        ],
        "camera": {"eye": [1.2, 2.2, 6.2], "target": [-0.2, 1.25, -0.6], "fov_deg": 42},
        "exposure": 0.7,
    }
    (HERE / "every_light.gltf").write_text(json.dumps(model) + "\n")
    (HERE / "every_light.json").write_text(json.dumps(scene, indent=1) + "\n")


if __name__ == "__main__":
    main()
