"""Tests benchmarks/perceptual.py from outside. Usage: perceptual_test.py PROGRAM SOURCE_DIR [CLASS...]

Tests of the metric itself are skipped where pyfvvdp cannot be imported, and all of them without the modules that read
pictures; the exit code is then 77.
"""

import importlib.util
import json
import math
import os
import sys
import unittest

try:
    import numpy
    import OpenImageIO
except ImportError as error:
    print(f"skipped: {error}")
    sys.exit(77)

from program import BAD_INPUT, BENCHMARKS, CANNOT_WRITE, USAGE, ToolTest

sys.path.insert(0, str(BENCHMARKS))
sys.dont_write_bytecode = True
import perceptual  # noqa: E402

SIZE = (24, 16)
METADATA = {"gaze": "0.25,0.75", "exposure": "1.25"}


class PerceptualTest(ToolTest):
    script = "perceptual.py"

    def picture(self, name, pixels, metadata=None, layer="radiance."):
        height, width, channels = pixels.shape
        spec = OpenImageIO.ImageSpec(width, height, channels, "float")
        spec.channelnames = tuple(layer + colour for colour in "RGB")
        for key, value in (METADATA if metadata is None else metadata).items():
            spec.attribute(f"fovea.{key}", value)
        file = OpenImageIO.ImageOutput.create(str(self.folder / name))
        self.assertTrue(file.open(str(self.folder / name), spec), file.geterror())
        self.assertTrue(file.write_image(pixels.astype(numpy.float32)))
        file.close()
        return str(self.folder / name)

    def sequence(self, name, frames, **more):
        """`frames` has the pixels of every frame; the first has the number 40. Returns the pattern."""
        for number, pixels in enumerate(frames, 40):
            self.picture(f"{name}_{number:04}.exr", pixels, **more)
        return f"{name}_%04d.exr"

    def grey(self, name, count=3, size=SIZE, value=0.5, **more):
        return self.sequence(name, [numpy.full((size[1], size[0], 3), value)] * count, **more)


class PerceptualInputs(PerceptualTest):
    def test_command_line(self):
        self.refuses(USAGE, says=["REFERENCE", "--help"])
        self.refuses(USAGE, "a_%d.exr", says=["REFERENCE"])
        for option in (["--fps", "0"], ["--fps", "many"], ["--display-width-deg", "180"], ["--pixels-per-degree", "-1"],
                       ["--luminance", "inf"], ["--ambient", "-5"], ["--exposure", "nan"], ["--gaze", "0.5"],
                       ["--gaze", "0.5,2"], ["--heatmap", "heat.jpg"], ["--heatmap", "heat_%d_%d.png"]):
            self.refuses(USAGE, "a_%d.exr", "b_%d.exr", *option, says=[option[0]])
        self.refuses(USAGE, "a_%d.exr", "b_%d.exr", "--gaze", "0,0", "--no-foveation", says=["--no-foveation"])
        self.refuses(USAGE, "a_%d.exr", "b_%d.exr", "--display-width-deg", "50", "--pixels-per-degree", "9",
                     says=["--pixels-per-degree"])
        self.refuses(USAGE, "a_%d.exr", "b_%d.exr", "c_%d.exr", "--heatmap", "heat.png", says=["--heatmap", "one TEST"])

    def test_names(self):
        self.grey("truth")
        self.refuses(BAD_INPUT, "truth_0040.exr", "truth_%04d.exr", says=["truth_0040.exr", "%04d"])
        self.refuses(BAD_INPUT, "nothing_%04d.exr", "truth_%04d.exr", says=["nothing_%04d.exr", "fovea render"])
        self.refuses(BAD_INPUT, "nowhere/a_%04d.exr", "truth_%04d.exr", says=["nowhere"])

    def test_frames(self):
        truth = self.grey("truth")
        self.refuses(BAD_INPUT, self.grey("short", 2), truth, says=["frames 40 to 41", "frames 40 to 42", "--frames"])
        self.grey("gap")
        (self.folder / "gap_0041.exr").unlink()
        self.refuses(BAD_INPUT, "gap_%04d.exr", truth, says=["gap_%04d.exr", "lacks frame 41"])
        self.picture("truth_41.exr", numpy.zeros((4, 4, 3)))
        self.refuses(BAD_INPUT, truth, truth, says=["truth_%04d.exr", "digits"])

    def test_sizes(self):
        truth, small = self.grey("truth"), self.grey("small", size=(8, 8))
        self.refuses(BAD_INPUT, small, truth, says=["small_0040.exr", "8x8", "truth_0040.exr", "24x16", "--size"])

    def test_pictures(self):
        truth = self.grey("truth", 1)
        self.write("text_0040.exr", "this is no picture")
        self.refuses(BAD_INPUT, "text_%04d.exr", truth, says=["text_0040.exr", "cannot be read"])
        self.refuses(BAD_INPUT, self.grey("depth", 1, layer="depth."), truth, says=["depth_0040.exr", "`radiance`"])
        self.assertEqual(perceptual.Frame(self.picture("plain.exr", numpy.ones((2, 2, 3)), layer="")).channels, [*"RGB"])
        bad = perceptual.Frame(self.picture("nan.exr", numpy.full((2, 2, 3), math.nan)))
        with self.assertRaises(SystemExit) as end:
            bad.pixels()
        self.assertEqual(end.exception.code, BAD_INPUT)

    def test_metadata(self):
        truth = self.grey("truth")
        self.refuses(BAD_INPUT, self.grey("bright", metadata={**METADATA, "exposure": "2"}), truth,
                     says=["bright_0040.exr", "truth_0040.exr", "1.25", "--exposure"])
        for name, metadata, remedy in (("a", {"gaze": "0,0"}, "--exposure"), ("b", {"exposure": "1.25"}, "--no-foveation"),
                                       ("c", {**METADATA, "gaze": "left"}, "--gaze"),
                                       ("d", {**METADATA, "gaze": "0.5"}, "--gaze"),
                                       ("e", {**METADATA, "exposure": "inf"}, "--exposure")):
            self.refuses(BAD_INPUT, self.grey(name, metadata=metadata), truth, says=[f"{name}_0040.exr", remedy])

    def test_missing_module(self):
        truth = self.grey("truth")
        for module in ("OpenImageIO", "pyfvvdp"):
            (self.folder / module).mkdir()
            self.write(f"{module}/{module}.py", "raise ImportError('left out on purpose')")
            run = self.call(truth, truth, env={"PYTHONPATH": os.pathsep.join([str(self.folder / module), *sys.path])})
            self.assertEqual(run.returncode, BAD_INPUT, run.stderr)
            self.assertRegex(run.stderr, rf"\Aperceptual\.py: .*{module}.*left out on purpose.*README\.md.*\n\Z")

    def test_heatmap_is_refused_before_the_work(self):
        truth = self.grey("truth")
        self.refuses(CANNOT_WRITE, truth, truth, "--heatmap", "nowhere/heat.png", says=["nowhere/heat.png"])


class PerceptualDisplay(PerceptualTest):
    def test_gaze_of_every_frame(self):
        files = [self.picture(f"{i}.exr", numpy.ones((16, 24, 3)), {"gaze": gaze})
                 for i, gaze in enumerate(["0,0", "0.5,0.25", "1,1"])]
        pictures = [perceptual.Frame(file) for file in files]
        self.assertEqual(perceptual.fixations(pictures, None), [[-0.5, -0.5], [11.5, 3.5], [23.5, 15.5]])
        self.assertEqual(perceptual.fixations(pictures, (0.5, 0.5)), [[11.5, 7.5]] * 3)

    def test_luminance(self):
        radiance = numpy.array([[[0, 0, 0], [0.2, 0.2, 0.2], [9, 9, 9], [0, 9, 0]]], numpy.float32)
        black, grey, white, green = perceptual.displayed_luminance(radiance, 2.5, 100, 0)[0]
        self.assertAlmostEqual(black, 0.1, places=5)
        self.assertAlmostEqual(grey, 0.1 + 0.5 * 99.9, places=4)
        self.assertAlmostEqual(white, 100, places=4)
        self.assertAlmostEqual(green, 0.1 + 0.7152 * 99.9, places=4)
        reflected = perceptual.displayed_luminance(radiance, 2.5, 100, 250)[0] - [black, grey, white, green]
        self.assertTrue(numpy.allclose(reflected, 250 * 0.005 / math.pi, atol=1e-4))

    def test_geometry(self):
        # In the middle of a flat display a pixel fills more degrees than on average.
        self.assertAlmostEqual(perceptual.width_in_degrees(1000, perceptual.resolution_in_degrees(1000, 60)), 60)
        self.assertAlmostEqual(perceptual.resolution_in_degrees(1000, 90), 1000 * math.pi / 360, places=4)

    def test_layer_among_others(self):
        names = ["direct.R", "radiance.B", "radiance.G", "radiance.R"]
        spec = OpenImageIO.ImageSpec(2, 2, 4, "float")
        spec.channelnames = tuple(names)
        file = OpenImageIO.ImageOutput.create(str(self.folder / "layers.exr"))
        self.assertTrue(file.open(str(self.folder / "layers.exr"), spec))
        file.write_image(numpy.tile(numpy.array([9, 3, 2, 1], numpy.float32), (2, 2, 1)))
        file.close()
        pixels = perceptual.Frame(str(self.folder / "layers.exr")).pixels()
        self.assertEqual(pixels[1, 1].tolist(), [1, 2, 3])


@unittest.skipUnless(importlib.util.find_spec("pyfvvdp"), "pyfvvdp is not installed")
class PerceptualMetric(PerceptualTest):
    SIDE, FRAMES = 96, 6

    def noisy(self, name, amplitude, columns=slice(None), **more):
        """Grey frames with noise that changes from frame to frame, in some of the columns."""
        random = numpy.random.default_rng(1)
        frames = numpy.full((self.FRAMES, self.SIDE, self.SIDE, 3), 0.4)
        frames[:, :, columns] += amplitude * random.uniform(-1, 1, frames[:, :, columns].shape)
        return self.sequence(name, frames, **more)

    def measure(self, *arguments):
        return json.loads(self.succeeds(*arguments, "--json").stdout)

    def jod(self, *arguments):
        return [row["jod"] for row in self.measure(*arguments)["sequences"]]

    def test_noise(self):
        truth = self.noisy("truth", 0)
        same, weak, strong = self.jod(truth, self.noisy("weak", 0.05), self.noisy("strong", 0.3), truth)
        self.assertAlmostEqual(same, 10, delta=0.01)
        self.assertLess(weak, 9.9)
        self.assertLess(strong, weak)

    def test_what_is_far_from_the_gaze_counts_less(self):
        left = slice(0, 24)
        truth = self.noisy("truth", 0)
        near = self.noisy("near", 0.3, left, metadata={**METADATA, "gaze": "0.12,0.5"})
        far = self.noisy("far", 0.3, left, metadata={**METADATA, "gaze": "0.95,0.5"})
        at_gaze, away = self.jod(near, far, truth)
        self.assertLess(at_gaze + 0.1, away)
        self.assertEqual(self.jod(far, truth, "--gaze", "0.12,0.5"), [at_gaze])
        first, second = self.jod(near, far, truth, "--no-foveation")
        self.assertEqual(first, second)

    def test_settings_and_heatmaps(self):
        truth, weak = self.noisy("truth", 0), self.noisy("weak", 0.2)
        result = self.measure(weak, truth, "--pixels-per-degree", "10", "--heatmap", "heat_%02d.png")
        self.assertAlmostEqual(result["pixels_per_degree"], 10)
        self.assertEqual((result["fps"], result["exposure"], result["foveated"]), (42, 1.25, True))
        self.assertEqual(result["sequences"][0]["frames"], self.FRAMES)
        self.assertEqual(sorted(p.name for p in self.folder.glob("heat*")), [f"heat_{n}.png" for n in range(40, 46)])
        table = self.succeeds(weak, truth, "--pixels-per-degree", "10", "--heatmap", "heat.png").stdout
        self.assertRegex(table, rf"weak_%04d\.exr +{result['sequences'][0]['jod']:.3f} +6\n")
        self.assertEqual((self.folder / "heat.png").read_bytes(), (self.folder / "heat_45.png").read_bytes())

    def test_still(self):
        still = self.sequence("still", [numpy.full((self.SIDE, self.SIDE, 3), 0.4)])
        self.assertAlmostEqual(self.jod(still, still)[0], 10, delta=0.01)


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]], verbosity=2)
