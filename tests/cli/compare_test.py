"""Tests `fovea compare` and `fovea compare-sequence` from outside. Usage: compare_test.py PROGRAM SOURCE_DIR [CLASS...]"""

import json
import math
import struct
import subprocess
import sys
import unittest

import exr
from program import BAD_INPUT, CANNOT_WRITE, USAGE, CliTest

SIZE = (16, 8)


def srgb(x):
    x = min(max(x, 0), 1)
    return 12.92 * x if x <= 0.0031308 else 1.055 * x ** (1 / 2.4) - 0.055


class CompareTest(CliTest):
    def pfm(self, name, value, size=SIZE):
        """`value` is a number or a function of x, y (from the top) and the channel."""
        pixel = value if callable(value) else lambda x, y, c: value
        (self.folder / name).parent.mkdir(exist_ok=True)
        values = [pixel(x, y, c) for y in reversed(range(size[1])) for x in range(size[0]) for c in range(3)]
        (self.folder / name).write_bytes(b"PF\n%d %d\n-1.0\n" % size + struct.pack(f"<{len(values)}f", *values))
        return name

    def json(self, *arguments):
        return json.loads(self.succeeds(*arguments, "--json").stdout)


class Compare(CompareTest):
    def test_numbers(self):
        self.pfm("g.pfm", 0.25)
        # One pixel of the fovea is wrong; the fovea is the pixels at most 2 from (8, 4).
        self.pfm("a.pfm", lambda x, y, c: 0.5 if (x, y) == (7, 3) else 0.25)
        m = self.json("compare", "a.pfm", "g.pfm", "--radius", "0.125", "--exposure", "2")
        self.assertEqual((m["exposure"], m["gaze"], m["size"]), (2, [0.5, 0.5], list(SIZE)))
        pixels = sum((x + 0.5 - 8) ** 2 + (y + 0.5 - 4) ** 2 <= 4 for x in range(16) for y in range(8))
        self.assertEqual((m["fovea"]["pixels"], m["whole"]["pixels"]), (pixels, 128))
        error = (srgb(1) - srgb(0.5)) ** 2
        self.assertAlmostEqual(m["fovea"]["mse"], error / pixels, delta=1e-6)
        self.assertAlmostEqual(m["whole"]["mse"], error / 128, delta=1e-7)
        self.assertAlmostEqual(m["whole"]["psnr"], -10 * math.log10(error / 128), delta=1e-3)
        self.assertAlmostEqual(m["whole"]["relmse"], (0.25 / 0.26) ** 2 / 128, delta=1e-6)
        self.assertEqual((m["periphery"]["mse"], m["periphery"]["relmse"], m["periphery"]["psnr"]), (0, 0, None))
        self.assertGreater(m["fovea"]["flip"], m["periphery"]["flip"])
        self.assertIsNone(m["whole"]["noise_floor"])
        # The fovea is elsewhere, and then empty.
        self.assertEqual(self.json("compare", "a.pfm", "g.pfm", "--radius", "0.1", "--gaze", "0,0")["fovea"]["mse"], 0)
        self.assertIsNone(self.json("compare", "a.pfm", "g.pfm", "--radius", "0")["fovea"]["mse"])

    def test_halves(self):
        self.pfm("g.pfm", 0.5)
        self.pfm("a.pfm", 0.4)
        self.pfm("h1.pfm", 0.52)
        self.pfm("h2.pfm", 0.48)
        m = self.json("compare", "a.pfm", "g.pfm", "--halves", "h1.pfm", "h2.pfm")["fovea"]
        noise = (srgb(0.52) - srgb(0.48)) ** 2 / 4
        self.assertAlmostEqual(m["noise_floor"], noise, delta=1e-8)
        self.assertAlmostEqual(m["mse"], (srgb(0.5) - srgb(0.4)) ** 2 - noise, delta=1e-7)
        self.assertAlmostEqual(m["relmse_noise_floor"], 0.04 ** 2 / 4 / 0.51 ** 2, delta=1e-7)
        self.pfm("h2.pfm", 0.48, (8, 8))
        self.fails(BAD_INPUT, "compare", "a.pfm", "g.pfm", "--halves", "h1.pfm", "h2.pfm", says=["half", "8x8", "16x8"])
        self.fails(USAGE, "compare", "a.pfm", "g.pfm", "--halves", "h1.pfm")

    def test_rendered(self):
        """Metadata and layers of the program's own files."""
        reference = ["render", "reference", "--scene", "cornellbox", "--size", "32x32", "--set", "spp=8"]
        self.succeeds("render", "ours", "--scene", "cornellbox", "--size", "32x32", "--fovea-radius", "0.2", "--set",
                      "vpl_count=16", "--set", "map_size=16", "-o", "a.exr", "-o", "a.png", "--gaze", "0.25,0.75")
        self.succeeds(*reference, "-o", "g.exr")
        m = self.json("compare", "a.exr", "g.exr")
        self.assertEqual([round(g, 6) for g in m["gaze"]], [0.25, 0.75])
        self.assertEqual((m["layer"], m["exposure"], round(m["fovea_radius"], 6)), ("radiance", 1.25, 0.2))
        for region in ("fovea", "periphery", "whole"):
            for key in ("mse", "relmse", "flip", "noise_floor", "direct_floor"):
                self.assertIsInstance(m[region][key], float, (region, key))
        indirect = self.json("compare", "a.exr", "g.exr", "--layer", "indirect")["whole"]
        self.assertGreater(indirect["noise_floor"], 0)
        shown = self.json("compare", "a.png", "g.exr")
        self.assertAlmostEqual(shown["whole"]["mse"], m["whole"]["mse"], delta=2e-4)
        self.assertIsNone(shown["whole"]["relmse"])
        self.fails(BAD_INPUT, "compare", "a.exr", "g.exr", "--layer", "half_a", says=["a.exr", "`half_a`", "`radiance`"])
        self.fails(BAD_INPUT, "compare", "a.png", "g.exr", "--layer", "radiance", says=["a.png"])
        change = lambda *how: subprocess.run(["oiiotool", *how], cwd=self.folder, check=True)
        for key, value in (("gaze", "0.5,abc"), ("gaze", "0.5"), ("fovea_radius", "nan"), ("exposure", "-1")):
            change("a.exr", "--sattrib", "fovea." + key, value, "-o", "changed.exr")
            self.fails(BAD_INPUT, "compare", "changed.exr", "g.exr", says=["changed.exr", value.split(",")[-1]])
        change("g.exr", "--ch", "radiance.R,radiance.G,radiance.B,half_a.R,half_a.G,half_a.B", "-o", "changed.exr")
        self.fails(BAD_INPUT, "compare", "a.exr", "changed.exr", says=["only one", "half_b"])
        self.succeeds(*reference, "--set", "tonemap.exposure=3", "-o", "bright.exr")
        self.fails(BAD_INPUT, "compare", "a.exr", "bright.exr", says=["1.25", "3", "--exposure"])
        self.succeeds("compare", "a.exr", "bright.exr", "--exposure", "2")

    def exr(self, name, *parts):
        exr.write(self.folder / name, *parts)
        return name

    @staticmethod
    def rgb(value, prefix="", **more):
        pixel = value if callable(value) else lambda x, y: value
        return {**{prefix + c: pixel for c in "RGB"}, **more}

    def whole(self, *arguments):
        return self.json("compare", *arguments, "--exposure", "1")["whole"]["mse"]

    def test_parts(self):
        """Every part of an EXR is a layer, or several."""
        window = (0, 0, 8, 4)
        for name, light in (("g.exr", 0.25), ("a.exr", 0.5)):
            self.exr(name, exr.Part(self.rgb(0.75), window, name="albedo"),
                     exr.Part(self.rgb(light), window, name="radiance"),
                     exr.Part({**self.rgb(light, "diffuse."), **self.rgb(0.1, "glossy.")}, window, name="left"),
                     exr.Part(self.rgb(light, "sky."), window, name="sky"))
        error = (srgb(0.5) - srgb(0.25)) ** 2
        run = self.json("compare", "a.exr", "g.exr", "--exposure", "1")
        self.assertEqual(run["layer"], "radiance")
        self.assertAlmostEqual(run["whole"]["mse"], error, delta=1e-6)
        for layer, expected in (("albedo", 0), ("left.diffuse", error), ("left.glossy", 0), ("sky", error)):
            self.assertAlmostEqual(self.whole("a.exr", "g.exr", "--layer", layer), expected, delta=1e-6, msg=layer)
        self.fails(BAD_INPUT, "compare", "a.exr", "g.exr", "--layer", "beauty",
                   says=["`beauty`", "`albedo`", "`radiance`", "`left.diffuse`", "`left.glossy`", "`sky`", "--layer"])
        for name in ("g.exr", "a.exr"):
            self.exr(name, exr.Part(self.rgb(0.75), window, name="one"), exr.Part(self.rgb(0.25), window, name="two"))
        self.fails(BAD_INPUT, "compare", "a.exr", "g.exr", says=["`one`", "`two`", "--layer"])
        self.exr("one.exr", exr.Part(self.rgb(0.75, "diffuse."), window))
        self.fails(BAD_INPUT, "compare", "one.exr", "g.exr", "--layer", "one", says=["one.exr", "`diffuse`"])

    def test_windows(self):
        """Crops are compared where they lie in the picture."""
        whole, ramp = (0, 0, 16, 8), lambda x, y: 0.05 * x + 0.02 * y
        self.exr("g.exr", exr.Part(self.rgb(ramp), whole))
        self.exr("a.exr", exr.Part(self.rgb(ramp), (4, 2, 6, 4), whole))
        self.exr("b.exr", exr.Part(self.rgb(ramp), (8, 3, 8, 5), whole))
        self.exr("c.exr", exr.Part(self.rgb(ramp), (12, 3, 4, 4), whole))
        self.exr("over.exr", exr.Part(self.rgb(lambda x, y: ramp(x, y) if 0 <= x < 16 and 0 <= y < 8 else 9),
                                      (-2, -3, 20, 14), whole))
        for one, other, window in (("a.exr", "g.exr", [4, 2, 6, 4]), ("g.exr", "a.exr", [4, 2, 6, 4]),
                                   ("a.exr", "b.exr", [8, 3, 2, 3]), ("b.exr", "g.exr", [8, 3, 8, 5])):
            run = self.succeeds("compare", one, other, "--json", "--exposure", "1")
            m = json.loads(run.stdout)
            self.assertEqual((m["window"], m["size"]), (window, [16, 8]))
            self.assertEqual((m["whole"]["mse"], m["whole"]["pixels"]), (0, window[2] * window[3]))
            self.assertIn("are compared", run.stderr)
        run = self.succeeds("compare", "over.exr", "g.exr", "--json", "--exposure", "1")
        self.assertEqual((run.stderr, json.loads(run.stdout)["whole"]["mse"]), ("", 0))
        self.assertNotIn("window", json.loads(run.stdout))
        # The fovea stays where it is in the picture: four pixels around 12, 4.
        m = self.json("compare", "b.exr", "g.exr", "--gaze", "0.75,0.5", "--radius", "0.0625", "--exposure", "1")
        self.assertEqual(m["fovea"]["pixels"], 4)
        m = self.json("compare", "a.exr", "g.exr", "--gaze", "0.75,0.5", "--radius", "0.0625", "--exposure", "1")
        self.assertEqual(m["fovea"]["pixels"], 0)
        self.fails(BAD_INPUT, "compare", "a.exr", "c.exr", says=["none in common", "6x4 from 4, 2", "4x4 from 12, 3"])
        self.exr("cut.exr", exr.Part(self.rgb(ramp), (4, 2, 6, 4)))
        self.exr("moved.exr", exr.Part(self.rgb(ramp), (1, 0, 16, 8)))
        self.exr("outside.exr", exr.Part(self.rgb(ramp), (20, 0, 4, 4), whole))
        for name in ("cut.exr", "moved.exr"):
            self.fails(BAD_INPUT, "compare", name, "g.exr", says=[name, "differ in size", "from"])
        self.fails(BAD_INPUT, "compare", "outside.exr", "outside.exr", says=["none in common"])
        self.exr("h.exr", exr.Part(self.rgb(0.5), (4, 2, 6, 4), whole))
        self.fails(BAD_INPUT, "compare", "g.exr", "g.exr", "--halves", "h.exr", "h.exr", says=["h.exr", "not all of"])
        self.succeeds("compare", "a.exr", "g.exr", "--halves", "h.exr", "h.exr")
        self.pfm("p.pfm", lambda x, y, c: ramp(x, y))
        self.assertEqual(self.whole("a.exr", "p.pfm"), 0)

    def test_channels(self):
        window, far = (0, 0, 8, 4), lambda x, y: math.inf
        self.exr("g.exr", exr.Part(self.rgb(0.25), window))
        error = (srgb(0.5) - srgb(0.25)) ** 2
        # Depth, alpha and numbers of objects are no light.
        self.exr("a.exr", exr.Part(self.rgb(0.5, A=lambda x, y: 0, Z=far, id=("uint", lambda x, y: 2 ** 31)), window))
        run = self.succeeds("compare", "a.exr", "g.exr", "--json", "--exposure", "1")
        self.assertAlmostEqual(json.loads(run.stdout)["whole"]["mse"], error, delta=1e-6)
        self.assertIn("`Z`", run.stderr)
        self.fails(BAD_INPUT, "compare", "a.exr", "a.exr", "--layer", "id", says=["`id`", "integers"])
        self.exr("half.exr", exr.Part({c: ("half", lambda x, y: 0.5) for c in "rgb"}, window))
        self.assertAlmostEqual(self.whole("half.exr", "g.exr"), error, delta=1e-6)
        self.exr("grey.exr", exr.Part({"Y": lambda x, y: 0.5}, window))
        run = self.succeeds("compare", "grey.exr", "g.exr")
        self.assertIn("`grey.exr` is grey", run.stderr)
        for name, depth in (("near.exr", 0.5), ("far.exr", 0.25)):
            self.exr(name, exr.Part({"Z": lambda x, y, d=depth: d}, window))
        self.assertAlmostEqual(self.whole("near.exr", "far.exr"), error, delta=1e-6)
        self.exr("normal.exr", exr.Part({"N." + c: lambda x, y: 0.5 for c in "XYZ"}, window))
        self.exr("motion.exr", exr.Part({"motion." + c: lambda x, y: 0.5 for c in "XY"}, window))
        self.assertAlmostEqual(self.whole("normal.exr", "g.exr"), error, delta=1e-6)
        self.fails(BAD_INPUT, "compare", "motion.exr", "g.exr", says=["`motion`", "`X`, `Y`", "no colours"])
        run = self.succeeds("compare", "normal.exr", self.exr("n.exr", exr.Part(self.rgb(0.5, "albedo."), window)))
        self.assertIn("`N` of `normal.exr` is compared with the layer `albedo`", run.stderr)
        self.exr("ids.exr", exr.Part({"id": ("uint", lambda x, y: x)}, window))
        self.fails(BAD_INPUT, "compare", "ids.exr", "ids.exr", says=["ids.exr", "integers"])
        light = ("float", lambda x, y: 0.5, 2)
        self.exr("chroma.exr", exr.Part({"Y": lambda x, y: 0.5, "RY": light, "BY": light}, window))
        self.fails(BAD_INPUT, "compare", "chroma.exr", "g.exr", says=["chroma.exr", "`BY`", "2x2"])
        self.exr("chroma.exr", exr.Part({c: lambda x, y: 0.5 for c in ("Y", "RY", "BY")}, window))
        self.fails(BAD_INPUT, "compare", "chroma.exr", "g.exr", says=["chroma.exr", "luminance"])
        self.exr("deep.exr", exr.Part(self.rgb(0.5), window, deep=True))
        self.fails(BAD_INPUT, "compare", "deep.exr", "g.exr", says=["deep.exr", "deep"])
        self.exr("deep.exr", exr.Part(self.rgb(0.5), window, name="volume", deep=True),
                 exr.Part(self.rgb(0.5), window, name="flat"))
        self.assertAlmostEqual(self.whole("deep.exr", "g.exr"), error, delta=1e-6)
        self.fails(BAD_INPUT, "compare", "deep.exr", "deep.exr", "--layer", "volume",
                   says=["`volume`", "deep", "`flat`"])

    def test_kinds_of_files(self):
        """Tiles and mip maps are pictures; what a file holds tells its kind, not its name."""
        oiio = lambda *how: subprocess.run(["oiiotool", *how], cwd=self.folder, check=True)
        self.pfm("g.pfm", lambda x, y, c: 0.02 * x)
        for name, how in (("tiled.exr", ["--tile", "8", "8"]), ("half.exr", ["-d", "half"]), ("light.hdr", [])):
            oiio("g.pfm", *how, "-o", name)
            self.assertLess(self.whole(name, "g.pfm"), 1e-5, name)
        oiio("g.pfm", "-otex:fileformatname=openexr", "mip.exr")
        self.assertLess(self.whole("mip.exr", "g.pfm"), 1e-5)
        (self.folder / "g.exr").write_bytes((self.folder / "tiled.exr").read_bytes())
        (self.folder / "named.png").write_bytes((self.folder / "tiled.exr").read_bytes())
        self.assertLess(self.whole("named.png", "g.exr"), 1e-9)

    def test_table_and_error_picture(self):
        self.pfm("g.pfm", 0.25, (80, 40))
        self.pfm("a.pfm", 0.3, (80, 40))
        out = self.succeeds("compare", "a.pfm", "g.pfm", "--error-image", "error.png").stdout
        for row in ("fovea", "periphery", "whole"):
            self.assertRegex(out, rf"(?m)^{row} +\d+ +[\d.e-]+")
        self.assertIn("halves", out)
        width, height = struct.unpack(">II", (self.folder / "error.png").read_bytes()[16:24])
        self.assertEqual(width, 80)
        self.assertGreater(height, 40)
        self.fails(CANNOT_WRITE, "compare", "a.pfm", "g.pfm", "--error-image", "none/error.png", says=["none"])

    def test_what_cannot_be_compared(self):
        self.pfm("g.pfm", 0.25)
        self.pfm("wide.pfm", 0.25, (17, 8))
        self.fails(BAD_INPUT, "compare", "wide.pfm", "g.pfm", says=["wide.pfm", "17x8", "16x8"])
        self.fails(BAD_INPUT, "compare", "none.pfm", "g.pfm", says=["none.pfm"])
        self.write("text.exr", "no picture")
        self.fails(BAD_INPUT, "compare", "g.pfm", "text.exr", says=["text.exr"])
        self.fails(BAD_INPUT, "compare", "g.pfm", "g.pfm", "--layer", "indirect", says=["indirect"])
        for bad in (math.nan, math.inf, -math.inf):
            self.pfm("bad.pfm", lambda x, y, c: bad if (x, y, c) == (3, 5, 1) else 0.25)
            self.fails(BAD_INPUT, "compare", "bad.pfm", "g.pfm", says=["bad.pfm", "3, 5"])
            self.fails(BAD_INPUT, "compare", "g.pfm", "bad.pfm", "--json", says=["bad.pfm"])
            self.fails(BAD_INPUT, "compare", "bad.pfm", "bad.pfm")
            self.fails(BAD_INPUT, "compare", "g.pfm", "g.pfm", "--halves", "g.pfm", "bad.pfm", says=["bad.pfm"])

    def test_usage(self):
        self.pfm("g.pfm", 0.25)
        for arguments in (["--gaze", "2,0"], ["--gaze", "x"], ["--radius", "-1"], ["--radius", "nan"], ["--exposure", "0"],
                          ["--exposure", "many"], ["--error-scale", "0"], ["--ppd", "0"], ["--ppd", "nan"]):
            with self.subTest(arguments=arguments):
                self.fails(USAGE, "compare", "g.pfm", "g.pfm", *arguments, says=[arguments[0]])
        self.fails(USAGE, "compare", "g.pfm", says=["REFERENCE"])


class CompareSequence(CompareTest):
    def sequence(self, folder, values, first=0):
        for i, value in enumerate(values):
            self.pfm(f"{folder}/f_{first + i:03d}.pfm", value)

    def test_numbers(self):
        self.sequence("a", [0.15, 0.25, 0.65])
        self.sequence("g", [0.1, 0.2, 0.3])
        a, g = [srgb(x) for x in (0.15, 0.25, 0.65)], [srgb(x) for x in (0.1, 0.2, 0.3)]
        steps = lambda v: (v[1] - v[0], v[2] - v[1])
        for names in (("a", "g"), ("a/f_%03d.pfm", "g"), ("a", "g/f_%d.pfm")):
            m = self.json("compare-sequence", *names)
            self.assertEqual((m["frames"], m["whole"]["pairs"]), (3, 2))
            for region in ("fovea", "periphery", "whole"):
                r = m[region]
                self.assertAlmostEqual(r["mse"], sum((x - y) ** 2 for x, y in zip(a, g)) / 3, delta=1e-6)
                self.assertAlmostEqual(r["mse_prime"], sum(s ** 2 for s in steps(a)) / 2, delta=1e-6)
                self.assertAlmostEqual(r["reference_mse_prime"], sum(s ** 2 for s in steps(g)) / 2, delta=1e-6)
                self.assertAlmostEqual(r["excess"], sum((s - t) ** 2 for s, t in zip(steps(a), steps(g))) / 2, delta=1e-6)
                self.assertIsNone(r["excess_noise_floor"])
        self.assertRegex(self.succeeds("compare-sequence", "a", "g").stdout, r"(?m)^fovea +2 ")

    def test_what_cannot_be_compared(self):
        command = ["compare-sequence", "a", "g"]
        self.sequence("g", [0.1, 0.2, 0.3])
        self.fails(BAD_INPUT, *command, says=["`a`"])
        (self.folder / "a").mkdir()
        self.fails(BAD_INPUT, *command, says=["`a`", "no frames"])
        self.sequence("a", [0.1, 0.2])
        self.fails(BAD_INPUT, *command, says=["0 to 1", "0 to 2"])
        self.sequence("a", [0.2], first=3)
        self.fails(BAD_INPUT, *command, says=["lacks frame 2"])
        self.sequence("a", [0.2, math.nan], first=2)
        (self.folder / "g/f_003.pfm").write_bytes((self.folder / "g/f_002.pfm").read_bytes())
        self.fails(BAD_INPUT, *command, says=["a/f_003.pfm", "NaN"])
        self.pfm("a/f_003.pfm", 0.1, (8, 8))
        self.fails(BAD_INPUT, *command, says=["a/f_003.pfm", "8x8"])
        self.pfm("a/other_0.pfm", 0.1)
        self.fails(BAD_INPUT, *command, says=["more than one sequence"])
        self.fails(BAD_INPUT, "compare-sequence", "a/f_%02x.pfm", "g", says=["%04d"])
        self.fails(BAD_INPUT, "compare-sequence", "g/f_000.pfm", "g", says=["folder"])
        for i, window in enumerate(((0, 0, 8, 4), (4, 0, 8, 4))):
            for folder in ("crops", "whole"):
                (self.folder / folder).mkdir(exist_ok=True)
                exr.write(self.folder / folder / f"f_{i}.exr",
                          exr.Part({c: lambda x, y: 0.5 for c in "RGB"}, window if folder == "crops" else (0, 0, 16, 8),
                                   (0, 0, 16, 8)))
        self.fails(BAD_INPUT, "compare-sequence", "crops", "whole", says=["f_1.exr", "other pixels"])
        self.sequence("one", [0.1])
        self.fails(BAD_INPUT, "compare-sequence", "one", "one", says=["two frames"])


class CompareEyes(CompareTest):
    WINDOW = (0, 0, 16, 8)

    def eyes(self, name, left, right, window=WINDOW, display=None, places=None, **layers):
        """Writes a picture of both eyes. `places` gives x, y and the pixels of the correspondence."""
        pixels = {"radiance": lambda x, y: (left,) * 3, "radiance_right": lambda x, y: (right,) * 3}
        pixels.update({layer: lambda x, y, v=value: (v,) * 3 for layer, value in layers.items()})
        if places:
            pixels["correspondence"] = places
        channels = {f"{layer}.{c}": lambda x, y, f=f, i=i: f(x, y)[i]
                    for layer, f in pixels.items() for i, c in enumerate("RGB")}
        (self.folder / name).parent.mkdir(exist_ok=True)
        exr.write(self.folder / name, exr.Part(channels, window, display))
        return name

    @staticmethod
    def straight(x, y):
        """Both eyes are at one place, and the right one does not see the column on the left."""
        return (x + 0.5, y + 0.5, 1) if x > 0 else (0, 0, 0)

    def test_numbers(self):
        self.eyes("a.exr", 0.25, 0.5)
        self.eyes("g.exr", 0.25, 0.3, places=self.straight)
        m = self.json("compare", "--eyes", "a.exr", "g.exr", "--exposure", "2", "--radius", "0.125")
        self.assertEqual((m["layer"], m["exposure"], m["size"]), ("radiance", 2, [16, 8]))
        d, wanted = srgb(0.5) - srgb(1), srgb(0.5) - srgb(0.6)
        for region in ("fovea", "periphery", "whole"):
            r = m[region]
            self.assertAlmostEqual(r["difference"], d ** 2, delta=1e-6)
            self.assertAlmostEqual(r["reference_difference"], wanted ** 2, delta=1e-6)
            self.assertAlmostEqual(r["excess"], (d - wanted) ** 2, delta=1e-6)
            self.assertIsNone(r["noise_floor"])
            self.assertNotIn("flicker", r)
        self.assertEqual((m["whole"]["pixels"], m["whole"]["share"], m["fovea"]["share"]), (120, 15 / 16, 1))
        run = self.succeeds("compare", "--eyes", "a.exr", "g.exr", "--error-image", "error.png")
        self.assertRegex(run.stdout, r"(?m)^whole +120 +0.9375 ")
        self.assertIn("half_b_right", run.stdout)
        self.assertTrue((self.folder / "error.png").exists())

    def test_layers_and_halves(self):
        self.eyes("a.exr", 9, 9, indirect=0.2, indirect_right=0.3, places=self.straight)
        halves = {"half_a": 0.52, "half_b": 0.48, "half_a_right": 0.5, "half_b_right": 0.5}
        self.eyes("g.exr", 0.5, 0.5, direct=0.1, direct_right=0.1, indirect=0.4, indirect_right=0.4, **halves)
        noise = (srgb(0.52) - srgb(0.48)) ** 2 / 4
        m = self.json("compare", "--eyes", "a.exr", "g.exr", "--exposure", "1")["whole"]
        self.assertAlmostEqual(m["noise_floor"], noise, delta=1e-7)
        self.assertAlmostEqual(m["reference_difference"], -noise, delta=1e-7)
        noise = (srgb(0.42) - srgb(0.38)) ** 2 / 4
        m = self.json("compare", "--eyes", "a.exr", "g.exr", "--exposure", "1", "--layer", "indirect")
        self.assertEqual(m["layer"], "indirect")
        self.assertAlmostEqual(m["whole"]["excess"], (srgb(0.2) - srgb(0.3)) ** 2 - noise, delta=1e-6)
        # Halves of the right eye count for its layers without --eyes, too.
        right = self.json("compare", "a.exr", "g.exr", "--exposure", "1", "--layer", "radiance_right")["whole"]
        self.assertEqual(right["noise_floor"], 0)
        self.eyes("g.exr", 0.5, 0.5, half_a=0.5, half_b=0.5, half_a_right=0.5)
        self.fails(BAD_INPUT, "compare", "--eyes", "a.exr", "g.exr", says=["only one", "`half_b_right`"])

    def test_rendered(self):
        options = ["--scene", "cornellbox", "--size", "32x32"]
        self.succeeds("render", "ir_stereo", *options, "--set", "vpl_count=16", "--set", "map_size=16", "--frames", "2",
                      "-o", "a_%d.exr")
        self.succeeds("render", "alternatives/reference_stereo", *options, "--set", "spp=8", "--frames", "2", "-o", "g_%d.exr")
        m = self.json("compare", "--eyes", "a_1.exr", "g_1.exr")
        self.assertEqual((m["layer"], m["exposure"]), ("radiance", 1.25))
        self.assertGreater(m["whole"]["share"], 0.9)
        for region in ("fovea", "periphery", "whole"):
            for key in ("difference", "reference_difference", "excess", "noise_floor"):
                self.assertIsInstance(m[region][key], float, (region, key))
        sequence = self.json("compare-sequence", "--eyes", "a_%d.exr", "g_%d.exr", "--layer", "indirect")
        self.assertEqual((sequence["frames"], sequence["layer"]), (2, "indirect"))
        self.assertGreater(sequence["whole"]["flicker_noise_floor"], 0)
        # The reference against itself, whose noise is then in no difference.
        self.assertAlmostEqual(self.json("compare", "--eyes", "g_0.exr", "g_0.exr")["whole"]["excess"]
                               + self.json("compare", "--eyes", "g_0.exr", "g_0.exr")["whole"]["noise_floor"], 0)

    def test_sequence(self):
        for i, right in enumerate((0.2, 0.3, 0.3)):
            self.eyes(f"a/f_{i}.exr", 0.2, right)
            self.eyes(f"g/f_{i}.exr", 0.2, 0.2, places=self.straight)
        m = self.json("compare-sequence", "--eyes", "a", "g")
        self.assertEqual((m["frames"], m["first_frame"], m["whole"]["pixels"]), (3, 0, 360))
        step = (srgb(0.3) - srgb(0.2)) ** 2
        self.assertAlmostEqual(m["whole"]["excess"], 2 * step / 3, delta=1e-6)
        self.assertAlmostEqual(m["whole"]["flicker"], step / 2, delta=1e-6)
        self.assertIsNone(m["whole"]["flicker_noise_floor"])
        self.assertRegex(self.succeeds("compare-sequence", "--eyes", "a", "g").stdout, r"flicker +its noise\n")
        self.eyes("a/f_1.exr", 0.2, 0.3, window=(0, 0, 8, 8))
        self.eyes("g/f_1.exr", 0.2, 0.2, window=(0, 0, 8, 8), places=self.straight)
        self.fails(BAD_INPUT, "compare-sequence", "--eyes", "a", "g", says=["a/f_1.exr", "other pixels"])

    def test_what_cannot_be_compared(self):
        self.eyes("a.exr", 0.2, 0.3)
        self.eyes("g.exr", 0.2, 0.2, places=self.straight)
        fails = lambda a, g, *says, options=(): self.fails(BAD_INPUT, "compare", "--eyes", a, g, *options, says=says)
        one = exr.Part({f"radiance.{c}": lambda x, y: 0.5 for c in "RGB"}, self.WINDOW)
        exr.write(self.folder / "one.exr", one)
        fails("one.exr", "g.exr", "one.exr", "`radiance_right`", "it has `radiance`", "`stereo`")
        fails("a.exr", "one.exr", "one.exr", "`radiance_right`", "`alternatives/reference_stereo`")
        fails("a.exr", "g.exr", "a.exr", "`indirect`", options=["--layer", "indirect"])
        fails("a.exr", "a.exr", "`correspondence`", "`alternatives/reference_stereo`")
        self.pfm("a.pfm", 0.5)
        fails("a.pfm", "g.exr", "a.pfm", "`radiance`", "one picture alone")
        fails("none.exr", "g.exr", "none.exr")
        self.eyes("wide.exr", 0.2, 0.2, window=(0, 0, 17, 8))
        fails("wide.exr", "g.exr", "wide.exr", "17x8", "16x8", "--size")
        self.eyes("crop.exr", 0.2, 0.2, window=(4, 2, 6, 4), display=self.WINDOW)
        fails("crop.exr", "g.exr", "crop.exr", "6x4 from 4, 2", "16x8", "whole pictures")
        self.eyes("bad.exr", 0.2, math.nan)
        fails("bad.exr", "g.exr", "bad.exr", "`radiance_right`", "NaN")
        for places in ((99, 0.5, 1), (0.5, 0.5, 3.5), (0.5, 0.5, 16), (-0.25, 0.5, 1)):
            self.eyes("bad.exr", 0.2, 0.2, places=lambda x, y, p=places: p if (x, y) == (3, 5) else (0, 0, 0))
            fails("a.exr", "bad.exr", "pixel 3, 5", "`correspondence`")
        self.eyes("bad.exr", 0.2, 0.2, places=lambda x, y: (math.inf, 0, 1))
        fails("a.exr", "bad.exr", "bad.exr", "`correspondence`", "infinity")
        parts = [exr.Part({c: lambda x, y: 0.5 for c in "RGB"}, window, self.WINDOW, name=name)
                 for name, window in (("radiance", self.WINDOW), ("radiance_right", self.WINDOW),
                                      ("correspondence", (0, 0, 8, 8)))]
        exr.write(self.folder / "parts.exr", *parts)
        fails("a.exr", "parts.exr", "parts.exr", "`correspondence`", "16x8", "8x8")
        for option in (["--halves", "g.exr", "g.exr"], ["--ppd", "30"]):
            self.fails(USAGE, "compare", "--eyes", "a.exr", "g.exr", *option, says=["--eyes", option[0]])


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]], verbosity=2)
