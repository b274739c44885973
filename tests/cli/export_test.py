"""Tests `fovea scene export` from outside. Usage: export_test.py PROGRAM SOURCE_DIR [CLASS...]"""

import json
import struct
import sys
import unittest
import xml.etree.ElementTree as ElementTree

from program import BAD_INPUT, CANNOT_WRITE, SMALL, USAGE, CliTest


class SceneExport(CliTest):
    def export(self, scene, *arguments):
        """The file that the command names."""
        return self.folder / self.succeeds("scene", "export", scene, "-o", "out", *arguments).stdout.strip()

    def test_gltf_renders_like_the_scene(self):
        file = self.export("cornellbox")
        self.assertEqual(file.name, "cornellbox.json")
        model = json.loads(file.with_suffix(".gltf").read_text())
        self.assertEqual(model["extensions"]["KHR_lights_punctual"]["lights"][0]["type"], "spot")
        self.assertEqual(len(model["cameras"]), 1)
        arguments = ["render", "direct", *SMALL, "--quiet", "-o"]
        self.succeeds(*arguments, "a.pfm", "--scene", "cornellbox")
        self.succeeds(*arguments, "b.pfm", "--scene", file)
        a, b = ((self.folder / name).read_bytes()[-48 * 32 * 12:] for name in ("a.pfm", "b.pfm"))
        values = [struct.unpack(f"<{48 * 32 * 3}f", data) for data in (a, b)]
        # Quaternions are written where the scene had directions, so the last bits differ.
        self.assertLess(sum(abs(x - y) for x, y in zip(*values)) / sum(values[0]), 1e-3)

    def test_mitsuba_files_are_there(self):
        file = self.export("cornellbox", "--format", "mitsuba", "--size", "40x30", "--spp", "8", "--depth", "2")
        root = ElementTree.parse(file).getroot()
        defaults = {d.get("name"): d.get("value") for d in root.findall("default")}
        self.assertEqual(defaults, {"width": "40", "height": "30", "spp": "8", "depth": "2"})
        names = [s.get("value") for s in root.iter("string") if s.get("name") == "filename"]
        self.assertEqual(len(names), 7)  # a mesh for each material, the spot light's image
        for name in names:
            self.assertTrue((file.parent / name).is_file(), name)

    def test_a_moment(self):
        at_start, later = (self.export("cornellbox_moving", "--format", "mitsuba", *more).parent
                           .joinpath("meshes/yellow_cube_yellow.ply").read_bytes() for more in ([], ["--frame", "63"]))
        self.assertNotEqual(at_start, later)
        self.export("cornellbox_moving", "--format", "mitsuba", "--time", "1.5")
        self.assertEqual((self.folder / "out/meshes/yellow_cube_yellow.ply").read_bytes(), later)

    def test_mistakes(self):
        self.fails(USAGE, "scene", "export", "cornellbox", says=["--output"])
        self.fails(USAGE, "scene", "export", "cornellbox", "-o", "out", "--format", "obj", says=["obj", "mitsuba"])
        self.fails(USAGE, "scene", "export", "cornellbox", "-o", "out", "--time", "-1")
        self.fails(USAGE, "scene", "export", "cornellbox", "-o", "out", "--time", "1", "--frame", "1")
        self.fails(BAD_INPUT, "scene", "export", "cornelbox", "-o", "out", says=["did you mean `cornellbox`"])
        self.write("file", "in the way")
        self.fails(CANNOT_WRITE, "scene", "export", "cornellbox", "-o", "file", says=["`file`"])


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]])
