"""Tests what `fovea render` writes and how it ends. Usage: render_test.py PROGRAM SOURCE_DIR [CLASS...]"""

import csv
import json
import re
import resource
import signal
import struct
import subprocess
import sys
import time
import unittest

from program import CANNOT_WRITE, DIRECT, INTERRUPTED, SMALL, CliTest


class Files(CliTest):
    def test_default_picture(self):
        run = self.succeeds(*DIRECT)
        self.assertIn("wrote direct-cornellbox.png", run.stdout)
        self.assertEqual([p.name for p in self.folder.iterdir()], ["direct-cornellbox.png"])

    def test_layers_and_metadata(self):
        self.succeeds(*DIRECT, "-o", "a.png", "-o", "a.exr", "--seed", "7", "--gaze", "0.25,0.75")
        text = subprocess.run(["iinfo", "-v", "a.exr"], cwd=self.folder, capture_output=True, text=True,
                              check=True).stdout
        self.assertIn("48 x   32", text)
        for name in ("radiance", "direct"):
            for channel in "RGB":
                self.assertIn(f"{name}.{channel}", text)
        for key, value in (("graph", "direct"), ("scene", "cornellbox"), ("seed", "7"), ("gaze", "0.25,0.75"),
                           ("size", "48x32"), ("graph_hash", ""), ("device", ""), ("version", "")):
            self.assertRegex(text, rf'fovea[.:]{key}: "{re.escape(value)}')
        png = (self.folder / "a.png").read_bytes()
        self.assertEqual(struct.unpack(">II", png[16:24]), (48, 32))

    def test_one_output(self):
        """OUTPUT=FILE writes any output of the graph; it does not affect an EXR of everything."""
        self.succeeds("render", "ir_stereo", "--scene", "cornellbox", *SMALL, "--set", "vpl_count=8", "--set",
                      "map_size=16", "-o", "side_by_side=pair.png", "-o", "image_right=right.png", "-o", "all.exr",
                      "-o", "direct_right=one.exr")
        size = lambda name: struct.unpack(">II", (self.folder / name).read_bytes()[16:24])
        self.assertEqual(size("right.png"), (48, 32))
        self.assertEqual(size("pair.png"), (96, 32))
        layers = lambda name: subprocess.run(["iinfo", "-v", name], cwd=self.folder, capture_output=True, text=True,
                                             check=True).stdout
        self.assertIn("radiance_right.R", layers("all.exr"))
        self.assertIn("direct_right.R", layers("one.exr"))
        self.assertNotIn("radiance", layers("one.exr"))
        self.fails(3, *DIRECT, "-o", "image_left=a.png", says=("has no output `image_left`",))

    def test_gaze_of_a_trace(self):
        self.write("g.csv", "t,x,y,valid\n0,0.25,0.75,1\n0.04,0.27,0.75,1\n0.06,0.9,0.1,1\n")
        self.succeeds(*DIRECT, "-o", "a_%d.exr", "--frames", "4", "--gaze-trace", "g.csv")
        gaze = [re.search(r'gaze: "([^"]*)"', subprocess.run(["iinfo", "-v", f"a_{i}.exr"], cwd=self.folder,
                          capture_output=True, text=True, check=True).stdout)[1] for i in range(4)]
        xs = [float(g.split(",")[0]) for g in gaze]
        for got, expected in zip(xs, (0.25, 0.25 + 0.02 / 42 / 0.04, 0.27, 0.9)):
            self.assertAlmostEqual(got, expected, places=4)

    def test_sequence(self):
        self.succeeds(*DIRECT, "-o", "a_%03d.png", "-o", "last.png", "--frames", "3", "--warmup", "1")
        self.assertEqual(sorted(p.name for p in self.folder.iterdir()),
                         ["a_001.png", "a_002.png", "a_003.png", "last.png"])

    def test_first_frame(self):
        """A run may start at any time of the scene."""
        moving = ["render", "direct", "--scene", "cornellbox_moving", *SMALL]
        self.succeeds(*moving, "-o", "a_%03d.exr", "--frames", "12")
        self.succeeds(*moving, "-o", "b_%03d.exr", "--frames", "2", "--warmup", "1", "--first", "9")
        self.assertEqual(sorted(p.name for p in self.folder.glob("b_*")), ["b_010.exr", "b_011.exr"])
        same = lambda a, b: subprocess.run(["idiff", "-q", a, b], cwd=self.folder, capture_output=True).returncode == 0
        self.assertTrue(same("a_011.exr", "b_011.exr"))
        self.assertFalse(same("a_000.exr", "b_011.exr"))

    def test_moving_scene_and_fovea(self):
        moving = ["render", "direct", "--scene", "cornellbox_moving", *SMALL, "--frames", "70"]
        self.succeeds(*moving, "-o", "a_%03d.exr", "-o", "plain.png")
        self.succeeds(*moving, "-o", "marked.png", "-o", "last.exr", "--show-fovea")
        differ = lambda a, b: subprocess.run(["idiff", "-q", a, b], cwd=self.folder, capture_output=True).returncode != 0
        self.assertTrue(differ("a_000.exr", "a_060.exr"))
        self.assertFalse(differ("a_069.exr", "last.exr"), "the circle belongs on pictures only")
        self.assertTrue(differ("plain.png", "marked.png"))

    def test_cannot_write(self):
        (self.folder / "folder.png").mkdir()
        for name in ("missing/a.png", "folder.png", "/proc/fovea.png"):
            with self.subTest(name=name):
                self.fails(CANNOT_WRITE, *DIRECT, "-o", name, says=[name])
        self.fails(CANNOT_WRITE, *DIRECT, "--timings", "missing/a.json", says=["missing/a.json"])
        self.fails(CANNOT_WRITE, *DIRECT, "--trace", "missing/a.json", says=["missing/a.json"])

    def test_disk_full(self):
        def tiny_files():
            signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
            resource.setrlimit(resource.RLIMIT_FSIZE, (512, 512))
        (self.folder / "a.exr").write_text("an older picture")
        env = {"XDG_CACHE_HOME": str(self.folder.parent / "nowhere")}
        self.fails(CANNOT_WRITE, *DIRECT, "-o", "a.exr", says=["a.exr"], preexec_fn=tiny_files, env=env)
        self.assertEqual((self.folder / "a.exr").read_text(), "an older picture")

    def test_same_seed_same_bits(self):
        common = ["render", "ir_1000", "--scene", "cornellbox", *SMALL, "--set", "vpl_count=32"]
        self.succeeds(*common, "-o", "a.exr", "--seed", "5")
        self.succeeds(*common, "-o", "b.exr", "--seed", "5")
        self.succeeds(*common, "-o", "c.exr", "--seed", "6")
        # Compares the pixels only, because the header contains the time of day.
        text = subprocess.run(["iinfo", "--hash", "a.exr", "b.exr", "c.exr"], cwd=self.folder, capture_output=True,
                              text=True, check=True).stdout
        a, b, c = re.findall(r"SHA-1: (\w+)", text)
        self.assertEqual(a, b, "the same seed gave another picture")
        self.assertNotEqual(a, c, "another seed gave the same picture")


class Timings(CliTest):
    def test_json(self):
        self.succeeds(*DIRECT, "--timings", "t.json", "--frames", "3", "--warmup", "1")
        self.assertEqual([p.name for p in self.folder.iterdir()], ["t.json"])
        t = json.loads((self.folder / "t.json").read_text())
        self.assertEqual((t["graph"], t["scene"], t["size"], len(t["frames"])), ("direct", "cornellbox", [48, 32], 3))
        self.assertTrue(t["device"])
        times = [t["frame"][key] for key in ("gpu_ms", "cpu_ms", "wall_ms")]
        self.assertGreaterEqual({p["name"] for p in t["passes"]}, {"gbuffer", "direct", "tonemap"})
        for p in t["passes"]:
            self.assertEqual(set(p) - {"steps"}, {"name", "type", "gpu_ms", "cpu_ms", "commands"})
            times += [p["gpu_ms"], p["cpu_ms"]] + [step["gpu_ms"] for step in p.get("steps", [])]
        commands = {p["name"]: p["commands"] for p in t["passes"]}
        self.assertEqual(commands["gbuffer"]["renderings"], 2)  # one a step
        self.assertEqual(commands["tonemap"], {"dispatches": 0, "indirect_dispatches": 0, "draws": 1, "renderings": 1,
                                               "transfers": 0, "barriers": 1})
        steps = {p["name"]: [step["name"] for step in p.get("steps", [])] for p in t["passes"]}
        self.assertEqual(steps["gbuffer"], ["visibility", "resolve"])
        self.assertEqual(steps["tonemap"], [])  # a single step is the pass
        for spread in times:
            self.assertEqual(set(spread), {"median", "min", "p95"})
            self.assertTrue(0 <= spread["min"] <= spread["median"] <= spread["p95"], spread)
        self.assertIsInstance(t["counters"], dict)
        self.assertEqual([f["frame"] for f in t["frames"]], [1, 2, 3])
        for f in t["frames"]:
            self.assertEqual(set(f), {"frame", "wall_ms", "gpu_ms", "cpu_ms", "counters"})
            self.assertEqual(set(f["counters"]), set(t["counters"]))
            self.assertTrue(0 < f["gpu_ms"] and 0 < f["wall_ms"])
        # The passes are inside the frame.
        self.assertLessEqual(sum(p["gpu_ms"]["min"] for p in t["passes"]), t["frame"]["gpu_ms"]["p95"])

    def test_views(self):
        """The timings give the cost of each eye, unless there is only one view."""
        self.succeeds("render", "ir_stereo", "--scene", "cornellbox", "--size", "48x32", "--set", "vpl_count=20",
                      "--set", "map_size=16", "--timings", "t.json")
        t = json.loads((self.folder / "t.json").read_text())
        self.assertEqual(list(t["views"]), ["none", "left", "right"])
        right = [p for p in t["passes"] if p["name"].startswith("right/")]
        self.assertEqual(t["views"]["right"]["passes"], len(right))
        self.assertAlmostEqual(t["views"]["right"]["ms"]["median"], sum(p["gpu_ms"]["median"] for p in right), 1)
        self.assertEqual(sum(v["passes"] for v in t["views"].values()), len(t["passes"]))
        self.succeeds(*DIRECT, "--timings", "t.json")
        self.assertNotIn("views", json.loads((self.folder / "t.json").read_text()))

    def test_csv(self):
        self.succeeds(*DIRECT, "--timings", "t.csv", "--frames", "2", "--warmup", "1")
        with open(self.folder / "t.csv", newline="") as file:
            rows = list(csv.DictReader(file))
        passes = {row["pass"] for row in rows}
        self.assertGreaterEqual(passes, {"gbuffer", "direct", "tonemap"})
        self.assertEqual({(row["frame"], row["pass"]) for row in rows}, {(f, p) for f in "12" for p in passes})
        self.assertEqual(len(rows), 2 * len(passes))
        for row in rows:
            self.assertGreaterEqual(float(row["gpu_ms"]), 0)
            self.assertGreaterEqual(float(row["cpu_ms"]), 0)

    def test_trace(self):
        self.succeeds(*DIRECT, "--trace", "t.json", "--frames", "2")
        events = json.loads((self.folder / "t.json").read_text())["traceEvents"]
        slices = [e for e in events if e["ph"] == "X"]
        for e in slices:
            self.assertGreaterEqual(e["dur"], 0)
        gbuffer = [e for e in slices if e["name"] == "gbuffer" and e["tid"] == 1]
        frames = [e for e in slices if e["cat"] == "frame" and e["tid"] == 1]
        self.assertEqual((len(gbuffer), len(frames)), (2, 2))
        for frame, p in zip(frames, gbuffer):
            self.assertLessEqual(frame["ts"], p["ts"])
            self.assertLessEqual(p["ts"] + p["dur"], frame["ts"] + frame["dur"] + 1)
        self.assertLessEqual(frames[0]["ts"] + frames[0]["dur"], frames[1]["ts"] + 1)

    def test_table(self):
        text = self.succeeds(*DIRECT, "-o", "a.png").stdout
        for name in ("gbuffer", "direct", "tonemap", "frame"):
            self.assertRegex(text, rf"(?m)^{name} .*\d")
        shares = [float(s) for s in re.findall(r"([\d.]+)%", text)]
        self.assertAlmostEqual(sum(shares), 100, delta=0.5)
        self.assertIn("peak memory", text)

    def test_quiet(self):
        run = self.succeeds(*DIRECT, "-o", "a.png", "--quiet")
        self.assertEqual((run.stdout, run.stderr), ("", ""))

    def test_validation(self):
        self.succeeds(*DIRECT, "-o", "a.png", "--validation")


class Interrupt(CliTest):
    def start(self, *arguments):
        process = subprocess.Popen(self.command(*arguments), cwd=self.folder, stdin=subprocess.DEVNULL,
                                   stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        self.addCleanup(process.stderr.close)
        self.addCleanup(process.stdout.close)
        self.addCleanup(process.wait)
        self.addCleanup(process.kill)
        return process

    def wait_for(self, process, name):
        end = time.monotonic() + 120
        while not (self.folder / name).exists():
            self.assertIsNone(process.poll(), "it ended by itself")
            self.assertLess(time.monotonic(), end, "no frame was finished")
            time.sleep(0.02)

    def test_keeps_what_is_done(self):
        process = self.start(*DIRECT, "--frames", "1000000", "-o", "a_%06d.png", "-o", "last.exr", "--timings", "t.json")
        self.wait_for(process, "a_000001.png")
        process.send_signal(signal.SIGINT)
        out, err = process.communicate(timeout=120)
        self.assertEqual(process.returncode, INTERRUPTED, err)
        self.assertIn("interrupted", err)
        self.assertIn("wrote last.exr", out)
        t = json.loads((self.folder / "t.json").read_text())
        self.assertEqual(len(t["frames"]), len(list(self.folder.glob("a_*.png"))))
        subprocess.run(["iinfo", "last.exr"], cwd=self.folder, check=True, capture_output=True)
        self.assertEqual([p for p in self.folder.iterdir() if p.suffix not in (".png", ".exr", ".json")], [])

    def test_picture_without_sequence(self):
        for delay in (2, 8, 30):  # until a frame is done, which nothing shows
            process = self.start(*DIRECT, "--frames", "1000000", "-o", "last.png")
            time.sleep(delay)
            process.send_signal(signal.SIGINT)
            out, err = process.communicate(timeout=120)
            self.assertEqual(process.returncode, INTERRUPTED, err)
            self.assertEqual("wrote last.png" in out, (self.folder / "last.png").exists())
            if (self.folder / "last.png").exists():
                return
            self.assertIn("interrupted", err)
        self.fail("no frame in 30 seconds")

    def test_second_one_ends_at_once(self):
        # Frames take a good while, so that the second signal arrives before the frame ends.
        process = self.start("render", "ir_1000", "--scene", "cornellbox", "--size", "512x512", "--frames", "1000",
                             "-o", "a_%04d.png")
        self.wait_for(process, "a_0000.png")
        process.send_signal(signal.SIGINT)
        self.assertIn("interrupted", process.stderr.readline() + process.stderr.readline())
        process.send_signal(signal.SIGINT)
        self.assertEqual(process.wait(timeout=10), -signal.SIGINT)


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]], verbosity=2)
