"""Tests benchmarks/recovery.py and denoise.py from outside. Usage: tools_test.py PROGRAM SOURCE_DIR [CLASS...]

They are skipped without the modules that read pictures; the exit code is then 77. Denoising itself is skipped without
pyoidn.
"""

import importlib.util
import json
import pathlib
import sys
import unittest

try:
    import numpy
    import OpenImageIO
except ImportError as error:
    print(f"skipped: {error}")
    sys.exit(77)

from program import BAD_INPUT, BENCHMARKS, CANNOT_WRITE, PROGRAM, USAGE, ToolTest

sys.path.insert(0, str(BENCHMARKS))
sys.dont_write_bytecode = True
import recovery  # noqa: E402

# A lamp that becomes five times as bright in frame 10.
SCENE = {"models": [{"builtin": "cornellbox", "lights": False}],
         "lights": [{"type": "point", "name": "lamp", "position": [0, 1.5, 0], "intensity": 1}],
         "moving_lights": [{"light": "lamp", "interpolation": "linear",
                            "keys": [{"t": 0, "intensity": 1}, {"t": 0.23, "intensity": 1},
                                     {"t": 0.235, "intensity": 5}]}]}


class Recovery(ToolTest):
    script = "recovery.py"

    def test_frames_until(self):
        for ratios, frames in (([1, 1.3, 1.2], 2), ([3, 2, 1.2, 1.3, 1.1], 4), ([1, 1, 1], 0), ([1, 1.3], None)):
            self.assertEqual(recovery.frames_until(ratios, 1.25), frames, ratios)

    def test_noise_of_references_is_no_error(self):
        random = numpy.random.default_rng(1)
        first, second = (1 + random.normal(0, 0.5, (20000, 3)) for _ in range(2))
        self.assertAlmostEqual(recovery.error(numpy.full((20000, 3), 1.0), (first, second)), 0, delta=0.01)
        self.assertAlmostEqual(recovery.error(numpy.full((20000, 3), 1.5), (first, second)), 0.25, delta=0.01)

    def test_command_line(self):
        scene = self.write("scene.json", SCENE)
        self.refuses(USAGE, scene, says=["--change"])
        self.refuses(USAGE, scene, "--change", "0", says=["--change", "at least 1"])
        self.refuses(BAD_INPUT, "none.json", "--change", "5", says=["none.json"])
        self.refuses(CANNOT_WRITE, scene, "--change", "5", "--json", "nowhere/a.json", says=["nowhere/a.json"])

    def test_scenes_that_go_on_moving(self):
        moving = {**SCENE, "movers": [{"shape": "box", "size": [1, 1, 1],
                                       "keys": [{"t": 0}, {"t": 1, "translation": [1, 0, 0]}]}]}
        scene = self.write("scene.json", moving)
        self.refuses(BAD_INPUT, scene, "--change", 10, "--frames", 3, "--size", "32x32", "--fovea", PROGRAM,
                     says=["scene.json", "between the frames 10 and 22", "animation"])

    def test_changes_are_seen(self):
        """A method that keeps nothing is as good as ever at once; one that adds up all frames remembers."""
        scene = self.write("scene.json", SCENE)
        graphs = [str(self.write(f"small_{pathlib.Path(graph).stem}.json", {"extends": f"{graph}.json", "parameters": {"vpl_count": 64}}))
                  for graph in ("ir_fixed_seed", "debug/ir_accumulated")]
        self.succeeds(scene, "--change", 10, "--graphs", ",".join(graphs), "--before", 4, "--frames", 3, "--seeds", 2,
                      "--size", "32x32", "--spp", 16, "--fovea", PROGRAM, "--json", self.folder / "a.json")
        forgets, remembers = json.loads((self.folder / "a.json").read_text())["methods"]
        self.assertEqual(forgets["frames"], 0)
        for ratio in forgets["ratios"]:
            self.assertAlmostEqual(ratio, 1)
        self.assertIsNone(remembers["frames"])
        self.assertEqual(remembers["ratios"], sorted(remembers["ratios"], reverse=True))

    def test_graphs_that_cannot_be_rendered(self):
        scene = self.write("scene.json", SCENE)
        run = self.call(scene, "--change", 10, "--size", "32x32", "--spp", 2, "--graphs", "direkt", "--fovea", PROGRAM)
        self.assertEqual(run.returncode, BAD_INPUT, run.stderr)
        self.assertIn("direkt", run.stderr)


class Denoise(ToolTest):
    script = "denoise.py"

    def picture(self, name, layers):
        spec = OpenImageIO.ImageSpec(16, 16, 3 * len(layers), "float")
        spec.channelnames = tuple(f"{layer}.{colour}" for layer in layers for colour in "RGB")
        pixels = numpy.concatenate([*layers.values()], axis=2).astype(numpy.float32)
        file = OpenImageIO.ImageOutput.create(str(self.folder / name))
        self.assertTrue(file.open(str(self.folder / name), spec), file.geterror())
        self.assertTrue(file.write_image(pixels))
        file.close()
        return self.folder / name

    def test_what_is_refused(self):
        noisy = self.picture("noisy.exr", {"albedo": numpy.ones((16, 16, 3))})
        self.refuses(USAGE, noisy, says=["denoised"])
        self.refuses(USAGE, noisy, self.folder / "." / "noisy.exr", says=["noisy.exr", "another name"])

    @unittest.skipUnless(importlib.util.find_spec("pyoidn"), "pyoidn is not installed")
    def test_noise_is_taken_out(self):
        random = numpy.random.default_rng(1)
        radiance, albedo = random.gamma(1, 1, (16, 16, 3)), numpy.full((16, 16, 3), 0.5)
        noisy = self.picture("noisy.exr", {"radiance": radiance, "albedo": albedo})
        self.refuses(BAD_INPUT, "none.exr", "a.exr", says=["none.exr"])
        self.refuses(BAD_INPUT, noisy, "a.exr", "--layer", "depth", says=["`depth`"])
        self.succeeds(noisy, "a.exr")
        image = OpenImageIO.ImageBuf(str(self.folder / "a.exr"))
        names, pixels = list(image.spec().channelnames), image.get_pixels(OpenImageIO.FLOAT)
        layer = {name: pixels[:, :, [names.index(f"{name}.{c}") for c in "RGB"]] for name in ("radiance", "albedo")}
        self.assertLess(layer["radiance"].std(), 0.5 * radiance.std())
        numpy.testing.assert_array_equal(layer["albedo"], albedo.astype(numpy.float32))


if __name__ == "__main__":
    unittest.main(argv=["tools_test.py", *sys.argv[3:]], verbosity=2)
