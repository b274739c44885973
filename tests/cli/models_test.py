"""Tests pictures of glTF models written here. Usage: models_test.py PROGRAM SOURCE_DIR [CLASS...]"""

import base64
import math
import struct
import sys
import unittest
import zlib

from program import CliTest


def chunk(kind, data):
    return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))


def png(width, height, texels):
    """An RGB picture; texels: rows of (r, g, b)."""
    rows = b"".join(b"\0" + bytes(sum(texels[y * width:(y + 1) * width], ())) for y in range(height))
    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)) +
            chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b""))


def uri(data, kind="application/octet-stream"):
    return f"data:{kind};base64," + base64.b64encode(data).decode()


class Model:
    """A glTF document to which accessors, images and quads are added."""

    def __init__(self):
        self.data = b""
        self.json = {"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": []}], "nodes": [], "meshes": [],
                     "materials": [], "accessors": [], "bufferViews": [], "cameras": []}

    def accessor(self, rows, kind="f", component=5126, normalized=False):
        data = b"".join(struct.pack(f"<{len(r)}{kind}", *r) for r in rows)
        self.json["bufferViews"].append({"buffer": 0, "byteOffset": len(self.data), "byteLength": len(data)})
        self.data += data + b"\0" * (-len(data) % 4)
        kind = {1: "SCALAR", 2: "VEC2", 3: "VEC3", 4: "VEC4", 16: "MAT4"}[len(rows[0])]
        self.json["accessors"].append({"bufferView": len(self.json["bufferViews"]) - 1, "componentType": component,
                                       "count": len(rows), "type": kind, "normalized": normalized})
        return len(self.json["accessors"]) - 1

    def node(self, **keys):
        self.json["nodes"].append(keys)
        self.json["scenes"][0]["nodes"].append(len(self.json["nodes"]) - 1)
        return len(self.json["nodes"]) - 1

    def material(self, **keys):
        self.json["materials"].append({"pbrMetallicRoughness": {"metallicFactor": 0}, "doubleSided": True, **keys})
        return len(self.json["materials"]) - 1

    def quad(self, corners, material, attributes=None, node=None):
        """Corners in the order of a strip."""
        names = {"POSITION": self.accessor(corners), "TEXCOORD_0": self.accessor([(0, 1), (1, 1), (0, 0), (1, 0)])}
        self.json["meshes"].append({"primitives": [{"attributes": {**names, **(attributes or {})}, "mode": 5,
                                                    "material": material}]})
        return self.node(mesh=len(self.json["meshes"]) - 1, **(node or {}))

    def camera(self, distance=4.0, half=1.0):
        """Sees x and y from -half to half in the plane z = 0."""
        self.json["cameras"].append({"type": "perspective", "perspective": {
            "yfov": 2 * math.atan(half / distance), "znear": 0.05, "zfar": 100}})
        self.node(camera=len(self.json["cameras"]) - 1, translation=[0, 0, distance])

    def text(self):
        self.json["buffers"] = [{"byteLength": len(self.data), "uri": uri(self.data)}]
        return self.json


def square(x0, x1, y0=-1.0, y1=1.0, z=0.0):
    return [(x0, y0, z), (x1, y0, z), (x0, y1, z), (x1, y1, z)]


class Models(CliTest):
    def picture(self, model, graph="direct", *options):
        """Rows of (r, g, b) of a square picture."""
        self.write("model.gltf", model if isinstance(model, dict) else model.text())
        self.write("scene.json", {"models": [{"file": "model.gltf"}], "exposure": 1, "environment": [0, 0, 0]})
        self.run_ = self.succeeds("render", graph, "--scene", "scene.json", "--size", "64x64", "-o", "a.png", *options)
        data = (self.folder / "a.png").read_bytes()
        at, body, header = 8, b"", None
        while at < len(data):
            size, kind = struct.unpack(">I4s", data[at:at + 8])
            if kind == b"IHDR":
                header = struct.unpack(">IIBB", data[at + 8:at + 18])
            if kind == b"IDAT":
                body += data[at + 8:at + 8 + size]
            at += 12 + size
        width, height, depth, colour = header
        self.assertEqual(depth, 8)
        channels = {0: 1, 2: 3, 6: 4}[colour]
        raw, stride = zlib.decompress(body), width * channels
        rows, before = [], bytearray(stride)
        for y in range(height):
            kind, row = raw[y * (stride + 1)], bytearray(raw[y * (stride + 1) + 1:(y + 1) * (stride + 1)])
            for i in range(stride):
                a, b, c = row[i - channels] if i >= channels else 0, before[i], before[i - channels] if i >= channels else 0
                p = a + b - c
                paeth = min(((abs(p - a), 0, a), (abs(p - b), 1, b), (abs(p - c), 2, c)))[2]
                row[i] = (row[i] + (0, a, b, (a + b) // 2, paeth)[kind]) & 255
            rows.append([tuple(row[x * channels:x * channels + 3]) for x in range(width)])
            before = row
        return rows

    def test_nearest_texels(self):
        """Four flat quarters with hard edges, also where a mip map is asked for."""
        for filters in ({"magFilter": 9728, "minFilter": 9728}, {"magFilter": 9728, "minFilter": 9986}):
            m = Model()
            m.json["images"] = [{"uri": uri(png(2, 2, [(255, 0, 0), (0, 255, 0), (0, 0, 255), (255, 255, 255)]))}]
            m.json["samplers"], m.json["textures"] = [filters], [{"source": 0, "sampler": 0}]
            unlit = m.material(emissiveFactor=[1, 1, 1], emissiveTexture={"index": 0})
            m.quad(square(-1, 1), unlit)
            m.camera()
            rows = self.picture(m)
            seen = {rows[y][x] for y in list(range(1, 31)) + list(range(33, 63))
                    for x in list(range(1, 31)) + list(range(33, 63))}
            self.assertEqual(len(seen), 4, f"{filters}: {sorted(seen)[:9]}")

    def test_alpha_of_vertex_colours(self):
        """Left of the cutoff nothing is there, right of it the surface, in each way of looking."""
        for graph, options in (("direct", ()), ("direct", ("--materials", "full")), ("reference", ("--set", "spp=16")),
                               ("reference", ("--set", "spp=16", "--materials", "full"))):
            m = Model()
            masked = m.material(alphaMode="MASK", alphaCutoff=0.5, emissiveFactor=[1, 1, 1])
            for x0, x1, alpha in ((-1, 0, 0.48), (0, 1, 0.52)):
                m.quad(square(x0, x1), masked, {"COLOR_0": m.accessor([(1, 1, 1, alpha)] * 4)})
            m.camera()
            rows = self.picture(m, graph, *options)
            self.assertLess(max(max(rows[y][x]) for y in range(64) for x in range(0, 30)), 250, f"{graph} {options}")
            self.assertGreater(min(min(rows[y][x]) for y in range(4, 60) for x in range(34, 60)), 250,
                               f"{graph} {options}")

    def test_equal_cones(self):
        """A disc of radius d tan(angle) with a hard edge."""
        m = Model()
        m.quad(square(-2, 2, -2, 2), m.material())
        m.json["extensions"] = {"KHR_lights_punctual": {"lights": [
            {"type": "spot", "intensity": 100, "spot": {"innerConeAngle": 0.2, "outerConeAngle": 0.2}}]}}
        m.node(translation=[0, 0, 3], extensions={"KHR_lights_punctual": {"light": 0}})
        m.camera()
        rows = self.picture(m)
        inside = [max(rows[32][x]) > 60 for x in range(64)]
        radius = sum(inside) / 64
        self.assertAlmostEqual(radius, 3 * math.tan(0.2), delta=0.04)
        self.assertIn("lights[0].spot", self.run_.stderr)

    def test_eight_joints(self):
        """Joints of the second set move the square to the right."""
        m = Model()
        joints = [m.node(translation=[-1.5 if i < 4 else 0.5, 0, 0]) for i in range(8)]
        m.json["skins"] = [{"joints": joints}]
        names = {}
        for k, (first, weight) in enumerate(((0, 0.0125), (4, 0.2375))):
            names[f"JOINTS_{k}"] = m.accessor([tuple(range(first, first + 4))] * 4, "B", 5121)
            names[f"WEIGHTS_{k}"] = m.accessor([(weight,) * 4] * 4)
        m.quad(square(-0.2, 0.2, -0.2, 0.2), m.material(emissiveFactor=[1, 1, 1]), names, {"skin": 0})
        m.camera()
        rows = self.picture(m)
        columns = [x for x in range(64) if min(rows[32][x]) > 250]
        self.assertAlmostEqual((columns[0] + columns[-1] + 1) / 64 - 1, 0.95 * 0.5 - 0.05 * 1.5, delta=0.04)


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]])
