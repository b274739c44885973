"""Compares random glTF models as fovea flattens them with what a plain evaluator makes of the same files with numpy:
accessors, nodes, morph targets, skins and animations as the specification has them. Usage: readings_test.py PROGRAM SOURCE_DIR"""

import base64
import json
import sys
import unittest
import xml.etree.ElementTree as ElementTree

import numpy

from program import CliTest

TYPES = {5120: "<i1", 5121: "<u1", 5122: "<i2", 5123: "<u2", 5125: "<u4", 5126: "<f4"}
WIDTHS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4, "MAT4": 16}
TIME = 0.7  # seconds


class Writer:
    """A random model: two meshes below random nodes, one of them skinned, both with morph targets and moving."""

    def __init__(self, seed):
        self.random = numpy.random.default_rng(seed)
        self.data = bytearray()
        self.model = {"asset": {"version": "2.0"}, "bufferViews": [], "accessors": [], "nodes": [], "meshes": [],
                      "materials": [{"name": "cloth"}, {"name": "stone"}], "scene": 0,
                      "extensionsUsed": ["KHR_mesh_quantization"], "extensionsRequired": ["KHR_mesh_quantization"]}
        self.write()

    def coin(self):
        return self.random.random() < 0.5

    def view(self, content, **more):
        self.data += bytes(-len(self.data) % 4)
        self.model["bufferViews"].append({"buffer": 0, "byteOffset": len(self.data), "byteLength": len(content),
                                          **more})
        self.data += content
        return len(self.model["bufferViews"]) - 1

    def accessor(self, values, width, component=5126, normalized=False, strided=False, **more):
        values = numpy.asarray(values).reshape(len(values), -1)
        if normalized:
            values = numpy.round(values * numpy.iinfo(TYPES[component]).max)
        stored = numpy.ascontiguousarray(values, TYPES[component])
        entry = {"componentType": component, "count": len(values), "type": width, **more}
        if normalized:
            entry["normalized"] = True
        if strided:
            size = stored.itemsize * stored.shape[1]
            gap = -size % 4 + 4 * int(self.random.integers(0, 3))
            rows = b"".join(row.tobytes() + bytes(gap) for row in stored)
            entry["bufferView"] = self.view(rows, byteStride=size + gap)
        elif self.coin() and len(values) > 2 and component == 5126:  # half of the values come from sparse entries
            used = numpy.sort(self.random.permutation(len(values))[:len(values) // 2]).astype("<u2")
            kept = stored.copy()
            kept[used] = self.random.random(kept[used].shape)
            entry["bufferView"] = self.view(kept.tobytes())
            entry["sparse"] = {"count": len(used),
                               "indices": {"bufferView": self.view(used.tobytes()), "componentType": 5123},
                               "values": {"bufferView": self.view(stored[used].tobytes())}}
        else:
            entry["bufferView"] = self.view(stored.tobytes())
        self.model["accessors"].append(entry)
        return len(self.model["accessors"]) - 1

    def rotation(self):
        q = self.random.normal(size=4)
        return q / numpy.linalg.norm(q)

    def node(self, **more):
        if self.coin():
            matrix = numpy.eye(4)
            matrix[:3, :3] = rotation_of(self.rotation()) * self.random.uniform(0.5, 2)
            matrix[:3, 3] = self.random.normal(size=3)
            more["matrix"] = matrix.T.ravel().tolist()
        else:
            more.update(translation=self.random.normal(size=3).tolist(), rotation=self.rotation().tolist(),
                        scale=self.random.uniform(0.5, 2, 3).tolist())
        self.model["nodes"].append(more)
        return len(self.model["nodes"]) - 1

    def mesh(self, material, joints):
        count, triangles = int(self.random.integers(8, 40)), int(self.random.integers(4, 30))
        component = int(self.random.choice([5121, 5123, 5125]))
        if self.coin():
            positions = self.random.normal(size=(count, 3))
            attributes = {"POSITION": self.accessor(positions, "VEC3", strided=self.coin(),
                                                    min=positions.min(0).tolist(), max=positions.max(0).tolist())}
        else:
            positions = self.random.uniform(-1, 1, (count, 3))
            attributes = {"POSITION": self.accessor(positions, "VEC3", 5122, normalized=True, strided=True,
                                                    min=[-32767] * 3, max=[32767] * 3)}
        sets = int(self.random.integers(1, 3)) if joints else 0
        for s in range(sets):
            attributes[f"JOINTS_{s}"] = self.accessor(self.random.integers(0, joints, (count, 4)), "VEC4",
                                                      int(self.random.choice([5121, 5123])), strided=True)
            weights = self.random.dirichlet(numpy.ones(4), count) / sets
            attributes[f"WEIGHTS_{s}"] = (self.accessor(weights, "VEC4", 5123, normalized=True, strided=True)
                                          if self.coin() else self.accessor(weights, "VEC4", strided=True))
        targets = [{"POSITION": self.accessor(self.random.normal(size=(count, 3)), "VEC3", min=[-9] * 3, max=[9] * 3)}
                   for _ in range(2)]
        # Every vertex is used, and no triangle has two corners in one place.
        order = self.random.permutation(count)[:count // 3 * 3].reshape(-1, 3)
        more = numpy.array([self.random.permutation(count)[:3] for _ in range(triangles)])
        indices = self.accessor(numpy.vstack([order, more]).reshape(-1, 1), "SCALAR", component)
        self.model["meshes"].append({"primitives": [{"attributes": attributes, "indices": indices, "material": material,
                                                     "targets": targets}], "weights": [0.25, -0.5]})
        return len(self.model["meshes"]) - 1

    def animate(self, channels):
        animation = {"channels": [], "samplers": []}
        for node, path in channels:
            times = numpy.array([0.0, 0.5, 1.25])
            kind = str(self.random.choice(["LINEAR", "STEP", "CUBICSPLINE"]))
            keys = len(times) * (3 if kind == "CUBICSPLINE" else 1)
            width = {"weights": "SCALAR", "rotation": "VEC4"}.get(path, "VEC3")
            values = self.random.normal(size=(keys * (2 if path == "weights" else 1), WIDTHS[width]))
            if path == "rotation" and kind != "CUBICSPLINE":
                values /= numpy.linalg.norm(values, axis=1, keepdims=True)
            elif path == "rotation":
                values[1::3] /= numpy.linalg.norm(values[1::3], axis=1, keepdims=True)
            # These accessors are strided, as only others get sparse entries: the values that those replace are random
            # numbers, which are no rotations.
            animation["samplers"].append({"input": self.accessor(times, "SCALAR", strided=True, min=[0.0], max=[1.25]),
                                          "output": self.accessor(values, width, strided=True), "interpolation": kind})
            animation["channels"].append({"sampler": len(animation["samplers"]) - 1,
                                          "target": {"node": node, "path": path}})
        self.model["animations"] = [animation]

    def write(self):
        joints = [self.node(translation=[0, 0, 0]) for _ in range(3)]
        for joint in joints:  # animated nodes have no matrix
            self.model["nodes"][joint].pop("matrix", None)
        self.model["nodes"][joints[0]]["children"] = joints[1:]
        inverse = [numpy.linalg.inv(matrix_of(self.model["nodes"][self.node()])).T.ravel() for _ in joints]
        del self.model["nodes"][-len(joints):]
        self.model["skins"] = [{"joints": joints}]
        if self.coin():
            self.model["skins"][0]["inverseBindMatrices"] = self.accessor(inverse, "MAT4", strided=False)
        cloth = self.node(mesh=self.mesh(0, len(joints)), skin=0)
        stone = self.node(mesh=self.mesh(1, 0))
        parent = self.node(children=[joints[0], stone])
        camera = self.node(camera=0)
        self.model["cameras"] = [{"type": "perspective", "perspective": {"yfov": 1.0, "znear": 0.1}}]
        self.model["scenes"] = [{"nodes": [parent, cloth, camera]}]
        self.animate([(joints[1], "rotation"), (joints[2], "translation"), (stone, "weights"), (cloth, "weights")])

    def text(self):
        uri = "data:application/octet-stream;base64," + base64.b64encode(self.data).decode()
        return json.dumps({**self.model, "buffers": [{"byteLength": len(self.data), "uri": uri}]})


def rotation_of(q):
    x, y, z, w = numpy.asarray(q, float) / numpy.linalg.norm(q)
    return numpy.array([[1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
                        [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
                        [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]])


def matrix_of(node):
    if "matrix" in node:
        return numpy.array(node["matrix"]).reshape(4, 4).T
    matrix = numpy.eye(4)
    matrix[:3, :3] = rotation_of(node.get("rotation", [0, 0, 0, 1])) * node.get("scale", [1, 1, 1])
    matrix[:3, 3] = node.get("translation", [0, 0, 0])
    return matrix


class Evaluator:
    """What the specification makes of a file at a moment."""

    def __init__(self, text, time):
        self.model = json.loads(text)
        self.data = base64.b64decode(self.model["buffers"][0]["uri"].partition(",")[2])
        self.parents = {child: i for i, node in enumerate(self.model["nodes"]) for child in node.get("children", [])}
        for animation in self.model["animations"]:
            for channel in animation["channels"]:
                node, path = channel["target"]["node"], channel["target"]["path"]
                self.model["nodes"][node][path] = self.moved(animation["samplers"][channel["sampler"]], path, time)

    def rows(self, view, offset, count, dtype, width):
        view = self.model["bufferViews"][view]
        stride = view.get("byteStride", numpy.dtype(dtype).itemsize * width)
        start = view["byteOffset"] + offset
        return numpy.array([numpy.frombuffer(self.data, dtype, width, start + i * stride) for i in range(count)])

    def accessor(self, index):
        entry = self.model["accessors"][index]
        dtype, width = TYPES[entry["componentType"]], WIDTHS[entry["type"]]
        values = self.rows(entry["bufferView"], entry.get("byteOffset", 0), entry["count"], dtype, width)
        if "sparse" in entry:
            sparse = entry["sparse"]
            places = self.rows(sparse["indices"]["bufferView"], 0, sparse["count"],
                               TYPES[sparse["indices"]["componentType"]], 1)
            values[places[:, 0]] = self.rows(sparse["values"]["bufferView"], 0, sparse["count"], dtype, width)
        values = values.astype(float)
        if not entry.get("normalized"):
            return values
        return numpy.maximum(values / numpy.iinfo(dtype).max, -1)

    def moved(self, sampler, path, time):
        times, values = self.accessor(sampler["input"])[:, 0], self.accessor(sampler["output"])
        cubic = sampler["interpolation"] == "CUBICSPLINE"
        values = values.reshape(len(times), 3 if cubic else 1, -1)
        k = int(numpy.clip(numpy.searchsorted(times, time, "right") - 1, 0, len(times) - 2))
        span = times[k + 1] - times[k]
        t = numpy.clip((time - times[k]) / span, 0, 1)
        if cubic:
            (_, a, out), (into, b, _) = values[k], values[k + 1]
            value = ((2 * t**3 - 3 * t**2 + 1) * a + span * (t**3 - 2 * t**2 + t) * out +
                     (-2 * t**3 + 3 * t**2) * b + span * (t**3 - t**2) * into)
            return value / numpy.linalg.norm(value) if path == "rotation" else value
        a, b = values[k, 0], values[k + 1, 0]
        if sampler["interpolation"] == "STEP":
            return a
        if path != "rotation":
            return (1 - t) * a + t * b
        if numpy.dot(a, b) < 0:
            b = -b
        angle = numpy.arccos(min(numpy.dot(a, b), 1.0))
        return (numpy.sin((1 - t) * angle) * a + numpy.sin(t * angle) * b) / numpy.sin(angle)

    def world(self, node):
        own = matrix_of(self.model["nodes"][node])
        return self.world(self.parents[node]) @ own if node in self.parents else own

    def triangles(self, material):
        """Corners of the triangles of the one primitive with this material, in world space."""
        for index, node in enumerate(self.model["nodes"]):
            if "mesh" not in node:
                continue
            mesh = self.model["meshes"][node["mesh"]]
            primitive = mesh["primitives"][0]
            if primitive["material"] != material:
                continue
            attributes = primitive["attributes"]
            positions = self.accessor(attributes["POSITION"])
            for weight, target in zip(node.get("weights", mesh["weights"]), primitive["targets"]):
                positions = positions + weight * self.accessor(target["POSITION"])
            positions = numpy.hstack([positions, numpy.ones((len(positions), 1))])
            if "skin" in node:
                positions = self.skinned(self.model["skins"][node["skin"]], attributes, positions)
            else:
                positions = positions @ self.world(index).T
            return positions[self.accessor(primitive["indices"]).astype(int).ravel(), :3].reshape(-1, 3, 3)

    def skinned(self, skin, attributes, positions):
        inverse = [numpy.eye(4)] * len(skin["joints"])
        if "inverseBindMatrices" in skin:
            inverse = self.accessor(skin["inverseBindMatrices"]).reshape(-1, 4, 4).transpose(0, 2, 1)
        matrices = numpy.array([self.world(joint) @ m for joint, m in zip(skin["joints"], inverse)])
        sets = [s for s in range(2) if f"JOINTS_{s}" in attributes]
        joints = numpy.hstack([self.accessor(attributes[f"JOINTS_{s}"]) for s in sets]).astype(int)
        weights = numpy.hstack([self.accessor(attributes[f"WEIGHTS_{s}"]) for s in sets])
        weights /= weights.sum(1, keepdims=True)
        blended = numpy.einsum("vj,vjrc->vrc", weights, matrices[joints])
        return numpy.einsum("vrc,vc->vr", blended, positions)


def read_ply(path):
    """Corners of the triangles of a binary PLY file."""
    data = path.read_bytes()
    end = data.index(b"end_header\n") + len(b"end_header\n")
    header = data[:end].decode().split("\n")
    counts = {line.split()[1]: int(line.split()[2]) for line in header if line.startswith("element")}
    kinds = {"float": "<f4", "int": "<i4", "uint": "<u4", "uchar": "<u1"}
    of_vertex = header[:next(i for i, line in enumerate(header) if line.startswith("element face"))]
    record = numpy.dtype([(line.split()[2], kinds[line.split()[1]]) for line in of_vertex
                          if line.startswith("property")])
    vertices = numpy.frombuffer(data, record, counts["vertex"], end)
    faces = numpy.frombuffer(data, [("n", "<u1"), ("i", "<u4", 3)], counts["face"], end + vertices.nbytes)
    positions = numpy.stack([vertices[axis] for axis in "xyz"], 1).astype(float)
    return positions[faces["i"]]


class Readings(CliTest):
    def exported(self, name, text):
        """Corners of the triangles of each material's meshes at TIME, as the program exports them."""
        self.write(f"{name}.gltf", text)
        run = self.succeeds("scene", "export", f"{name}.gltf", "-o", name, "--format", "mitsuba", "--time", TIME)
        file = self.folder / run.stdout.strip()
        root = ElementTree.parse(file).getroot()
        files = [s.get("value") for s in root.iter("string") if s.get("name") == "filename"]
        return {material: [read_ply(file.parent / f) for f in files if f.endswith(f"_{material}.ply")]
                for material in ("cloth", "stone")}

    def test_models_are_where_numpy_has_them(self):
        for seed in range(25):
            text = Writer(seed).text()
            meshes = self.exported(f"model{seed}", text)
            evaluated = Evaluator(text, TIME)
            for index, name in enumerate(("cloth", "stone")):
                with self.subTest(seed=seed, mesh=name):
                    self.assertEqual(len(meshes[name]), 1)
                    found, expected = meshes[name][0], evaluated.triangles(index)
                    self.assertEqual(found.shape, expected.shape)
                    numpy.testing.assert_allclose(found, expected, rtol=1e-5, atol=2e-5)


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]])
