"""The command-line program from outside: exit codes, messages, files. Usage: cli_test.py PROGRAM SOURCE_DIR [CLASS...]"""

import base64
import csv
import json
import os
import pathlib
import re
import resource
import shutil
import signal
import struct
import subprocess
import sys
import tempfile
import time
import unittest

PROGRAM = pathlib.Path(sys.argv[1]).resolve() if len(sys.argv) > 1 else None
SOURCE = pathlib.Path(sys.argv[2]).resolve() if len(sys.argv) > 2 else None

USAGE, BAD_INPUT, NO_DEVICE, OUT_OF_MEMORY, CANNOT_WRITE, INTERRUPTED = 2, 3, 4, 5, 7, 130
# Small and quick; what is tested here does not depend on the size of the work.
SMALL = ["--size", "48x32"]
DIRECT = ["render", "direct", "--scene", "cornellbox", *SMALL]


class CliTest(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="fovea-cli-"))
        self.addCleanup(shutil.rmtree, self.folder, ignore_errors=True)

    def command(self, *arguments):
        return [str(PROGRAM), *map(str, arguments)]

    def call(self, *arguments, env=None, **more):
        return subprocess.run(self.command(*arguments), cwd=self.folder, env={**os.environ, **(env or {})},
                              stdin=subprocess.DEVNULL, capture_output=True, text=True, timeout=300, **more)

    def succeeds(self, *arguments, **more):
        run = self.call(*arguments, **more)
        self.assertEqual(run.returncode, 0, f"{arguments}: {run.stderr}")
        return run

    def fails(self, code, *arguments, says=(), **more):
        """Exit code, one clear message that names things, and no file that was not there before."""
        before = sorted(self.folder.iterdir())
        run = self.call(*arguments, **more)
        self.assertEqual(run.returncode, code, f"{arguments}: {run.stderr}")
        self.assertTrue(run.stderr.startswith("fovea: "), run.stderr)
        self.assertNotIn("defect", run.stderr)
        self.assertEqual(run.stdout, "")
        for text in says:
            self.assertIn(text, run.stderr)
        self.assertEqual(sorted(self.folder.iterdir()), before)
        return run

    def write(self, name, content):
        path = self.folder / name
        path.write_text(content if isinstance(content, str) else json.dumps(content, indent=2))
        return path

    def graph(self, **changes):
        """A graph file that extends direct.json."""
        return self.write("graph.json", {"extends": "direct.json", **changes})


class Usage(CliTest):
    def test_command_is_needed(self):
        self.fails(USAGE, says=["--help"])
        self.fails(USAGE, "rendre", "direct", says=["`rendre`", "`render`"])

    def test_help_and_version(self):
        self.assertIn("Exit codes", self.succeeds("--help").stdout)
        self.assertIn("--gaze", self.succeeds("render", "--help").stdout)
        self.assertRegex(self.succeeds("--version").stdout, r"fovea \d+\.\d+\.\d+")

    def test_unknown_option(self):
        self.fails(USAGE, *DIRECT, "--sizes", "4x4", says=["--sizes", "fovea render --help"])
        self.fails(USAGE, "render", "direct", says=["--scene"])

    def test_sizes(self):
        for size in ("0x0", "0x16", "100000x100000", "16385x16", "99999999999999999999x1"):
            with self.subTest(size=size):
                run = self.fails(USAGE, *DIRECT[:4], "--size", size, says=[size])
                self.assertIn("16384" if len(size) < 20 else "WIDTHxHEIGHT", run.stderr)
        for size in ("12", "x", "12x", "x12", "-4x4", "1e2x4", "4x4x4", "4 x 4", ""):
            with self.subTest(size=size):
                self.fails(USAGE, *DIRECT[:4], "--size=" + size)

    def test_numbers(self):
        for arguments in (["--frames", "0"], ["--frames", "-1"], ["--frames", "many"], ["--warmup", "-1"],
                          ["--seed", "-1"], ["--seed", "1.5"], ["--seed", "4294967296"], ["--first", "-1"]):
            with self.subTest(arguments=arguments):
                self.fails(USAGE, *DIRECT, *arguments, says=[arguments[0]])

    def test_gaze(self):
        for gaze in ("0.5", "2,0", "-0.1,0.5", "nan,0", "0.5,0.5,0.5", "a,b", ","):
            with self.subTest(gaze=gaze):
                self.fails(USAGE, *DIRECT, "--gaze=" + gaze, says=["0 to 1"])

    def test_lens(self):
        for lens in ("55", "55,45,50", "55,45,50,90", "55,45,50,0", "55,45,50,nan", "a,b,c,d", "55,45,50,52,"):
            with self.subTest(lens=lens):
                self.fails(USAGE, *DIRECT, "--lens=" + lens, says=["1 to 80"])
        self.fails(USAGE, *DIRECT, "--lens", "55,45,50,52", says=["direct", "no eyes"])

    def test_gaze_trace(self):
        self.fails(USAGE, *DIRECT, "--gaze-trace", "g.csv", "--gaze", "0.5,0.5", says=["--gaze"])
        self.fails(USAGE, *DIRECT, "--gaze-gap", "20", says=["--gaze-trace"])
        self.fails(BAD_INPUT, *DIRECT, "--gaze-trace", "none.csv", says=["none.csv"])
        self.write("g.csv", "t,x,y,valid\n0,0.5,0.5,1\nrubbish\n0.2,0.5,7,1\n")
        self.fails(BAD_INPUT, *DIRECT, "--gaze-trace", "g.csv", says=["g.csv:3", "g.csv:4"])

    def test_fovea_degrees(self):
        self.fails(USAGE, *DIRECT, "--fovea-degrees", "0", says=["--fovea-degrees"])
        self.fails(USAGE, *DIRECT, "--fovea-degrees", "10", says=["direct", "no fovea"])

    def test_output_names(self):
        self.fails(USAGE, *DIRECT, "-o", "picture", says=["picture", "png"])
        self.fails(USAGE, *DIRECT, "-o", "picture.txt", says=["exr"])
        self.fails(USAGE, *DIRECT, "-o", "a.png", "-o", "a.png", says=["twice"])
        for name in ("a_%s.png", "a_%.png", "%d_%d.png", "a_%4d.png", "a_%0999d.png"):
            with self.subTest(name=name):
                self.fails(USAGE, *DIRECT, "-o", name, says=["%04d"])
        self.fails(USAGE, *DIRECT, "--timings", "times.txt", says=[".csv"])

    def test_set_without_value(self):
        self.fails(USAGE, *DIRECT, "--set", "shadow_map_size", says=["shadow_map_size"])


class Inputs(CliTest):
    def test_missing_graph(self):
        self.fails(BAD_INPUT, "render", "no_such_graph", "--scene", "cornellbox", says=["no_such_graph"])
        self.fails(BAD_INPUT, "check", "no/such/graph.json", says=["no/such/graph.json"])

    def test_broken_json_names_the_place(self):
        self.write("graph.json", '{\n  "passes": {\n    "a": ,\n  }\n}\n')
        self.fails(BAD_INPUT, "check", "graph.json", says=["graph.json:3:"])

    def test_all_mistakes_of_a_graph_at_once(self):
        self.write("graph.json", {
            "extends": "direct.json",
            "passes": {"tonemap": {"params": {"exposuer": 2}}, "more": {"type": "tonemapp"},
                       "direct": {"inputs": {"maps": "nothing"}}}})
        run = self.fails(BAD_INPUT, "check", "graph.json", says=["exposuer", "`exposure`", "tonemapp", "nothing"])
        self.assertGreaterEqual(len(re.findall(r"graph\.json:\d+:\d+: error", run.stderr)), 3, run.stderr)
        self.fails(BAD_INPUT, "render", "graph.json", "--scene", "cornellbox", says=["exposuer"])

    def test_unknown_override(self):
        self.fails(BAD_INPUT, *DIRECT, "--set", "shadow_map_sise=64", says=["shadow_map_sise", "shadow_map_size"])
        self.fails(BAD_INPUT, *DIRECT, "--set", "tonemap.exposuer=1", says=["exposuer"])
        self.fails(BAD_INPUT, *DIRECT, "--set", "shadow_map_size=big", says=["big"])
        self.fails(BAD_INPUT, *DIRECT, "--set", "shadow_map_size=-5", says=["-5"])

    def test_missing_scene(self):
        self.fails(BAD_INPUT, "render", "direct", "--scene", "no_such_scene", says=["no_such_scene"])
        self.fails(BAD_INPUT, "scene", "info", "no_such.gltf", says=["no_such.gltf"])

    def test_scene_names_missing_model(self):
        sponza = SOURCE / "samples/scenes/sponza.json"
        text = sponza.read_text().replace("Sponza.gltf", "NotThere.gltf")
        self.assertIn("NotThere", text)
        self.write("hall.json", text)
        self.fails(BAD_INPUT, "scene", "info", "hall.json", says=["NotThere.gltf"])

    def model(self, positions):
        data = struct.pack("<9f", *positions)
        return self.write("model.gltf", {
            "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
            "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
            "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3",
                           "min": [0, 0, 0], "max": [1, 1, 0]}],
            "bufferViews": [{"buffer": 0, "byteLength": 36}],
            "buffers": [{"byteLength": 36,
                         "uri": "data:application/octet-stream;base64," + base64.b64encode(data).decode()}]})

    def test_numbers_that_are_none(self):
        good = [0, 0, 0, 1, 0, 0, 0, 1, 0]
        self.model(good)
        self.assertRegex(self.succeeds("scene", "info", "model.gltf").stdout, r"triangles +1 ")
        for bad in (float("nan"), float("inf")):
            self.model(good[:4] + [bad] + good[5:])
            self.fails(BAD_INPUT, "render", "direct", "--scene", "model.gltf", *SMALL, says=["model.gltf"])

    def test_warnings_once(self):
        self.model([0, 0, 0, 1, 0, 0, 0, 1, 0])
        run = self.succeeds("render", "direct", "--scene", "model.gltf", *SMALL, "-o", "a.png", "--frames", "3")
        lines = [line for line in run.stderr.splitlines() if "warning" in line]
        self.assertGreaterEqual(len(lines), 1, run.stderr)
        self.assertEqual(len(lines), len(set(lines)), run.stderr)

    def test_graph_without_what_a_file_shows(self):
        self.graph(outputs={"image": None})
        self.fails(BAD_INPUT, "render", "graph.json", "--scene", "cornellbox", *SMALL, "-o", "a.png", says=["`image`"])

    def test_plugins(self):
        self.fails(BAD_INPUT, "passes", "--plugin", "none.so", says=["none.so"])
        self.write("text.so", "not a library")
        self.fails(BAD_INPUT, "passes", "--plugin", "text.so", says=["text.so"])

    def test_data_folder(self):
        self.fails(BAD_INPUT, "check", "direct", env={"FOVEA_DATA": "/nowhere"}, says=["FOVEA_DATA", "/nowhere"])


class Devices(CliTest):
    # The loader's old and new names of the same thing.
    NONE = {"VK_DRIVER_FILES": "/dev/null", "VK_ICD_FILENAMES": "/dev/null"}

    def test_list(self):
        self.assertRegex(self.succeeds("devices").stdout, r"(?m)^ *0  \S")

    def test_none(self):
        self.fails(NO_DEVICE, "devices", env=self.NONE)
        self.fails(NO_DEVICE, *DIRECT, "-o", "a.png", env=self.NONE, says=["mesa-vulkan-drivers"])

    def test_unknown(self):
        self.fails(NO_DEVICE, *DIRECT, "-o", "a.png", "--device", "Voodoo 2", says=["Voodoo 2"])
        self.fails(NO_DEVICE, *DIRECT, "-o", "a.png", "--device", "99", says=["99"])

    def test_memory(self):
        if "llvmpipe" not in self.succeeds("devices").stdout:
            self.skipTest("other devices may have the memory")
        self.fails(OUT_OF_MEMORY, "render", "direct", "--scene", "cornellbox", "--size", "16384x16384", "-o", "a.png",
                   says=["MiB", "smaller"])

    def test_what_needs_none(self):
        for arguments in (["check", "direct"], ["passes"], ["schema"], ["scene", "info", "cornellbox"]):
            with self.subTest(arguments=arguments):
                self.succeeds(*arguments, env=self.NONE)


class Lists(CliTest):
    def test_passes(self):
        listed = self.succeeds("passes").stdout
        for name in ("gbuffer", "shadow-map", "direct", "tonemap"):
            self.assertRegex(listed, rf"(?m)^{name} +\S+")
        for name in [line.split()[0] for line in listed.splitlines()]:
            with self.subTest(name=name):
                self.assertRegex(self.succeeds("passes", name).stdout, "outputs|updated in place")
        self.assertRegex(self.succeeds("passes", "tonemap").stdout, r"(?m)^  exposure +0 \(")
        self.fails(BAD_INPUT, "passes", "tonemapp", says=["`tonemap`"])

    def test_schema_accepts_the_graphs(self):
        schema = json.loads(self.succeeds("schema").stdout)
        self.assertIn("properties", schema)
        import jsonschema
        validator = jsonschema.validators.validator_for(schema)
        validator.check_schema(schema)
        for path in sorted((SOURCE / "graphs").glob("*.json")):
            if path.name.endswith(".schema.json"):
                continue
            with self.subTest(graph=path.name):
                graph = json.loads(path.read_text())
                validator(schema).validate(graph)
                with self.assertRaises(jsonschema.ValidationError):
                    validator(schema).validate({**graph, "passses": {}})

    def test_stored_schema_is_current(self):
        stored = SOURCE / "graphs/fovea-graph.schema.json"
        self.assertEqual(json.loads(stored.read_text()), json.loads(self.succeeds("schema").stdout),
                         "graphs/fovea-graph.schema.json is out of date: write `fovea schema` into it")

    def test_check(self):
        for path in sorted((SOURCE / "graphs").glob("*.json")):
            if path.name.endswith(".schema.json") or path.name == "vpl-base.json":
                continue
            if "inputs" in json.loads(path.read_text()):
                continue  # a part: checked with the graphs that use it
            with self.subTest(graph=path.name):
                self.assertIn(path.stem, self.succeeds("check", path.stem).stdout)

    def test_plans(self):
        self.assertIn("tonemap", self.succeeds("check", "direct", "--plan", "text").stdout)
        self.assertTrue(self.succeeds("check", "direct", "--plan", "dot").stdout.lstrip().startswith("digraph"))
        json.loads(self.succeeds("check", "direct", "--plan", "json").stdout)
        self.fails(USAGE, "check", "direct", "--plan", "xml", says=["--plan"])

    def test_scene_info(self):
        text = self.succeeds("scene", "info", "cornellbox").stdout
        for word in ("triangles", "light", "camera", "exposure"):
            self.assertRegex(text, rf"(?m)^{word} +\S")


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
        """OUTPUT=FILE shows any output of the graph; an EXR of everything is not touched by it."""
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
        """A run may start where in the scene's time it likes."""
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
        # The pixels: the header carries the time of day.
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
            self.assertEqual(set(p), {"name", "type", "gpu_ms", "cpu_ms"})
            times += [p["gpu_ms"], p["cpu_ms"]]
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
        """The cost of each eye; nothing of the kind where there is one view."""
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
            self.assertIn("before the first frame", err)
        self.fail("no frame in 30 seconds")

    def test_second_one_ends_at_once(self):
        # Frames of seconds, so that the second signal comes before the frame's end.
        process = self.start("render", "ir_1000", "--scene", "cornellbox", "--size", "1024x1024", "--frames", "1000",
                             "-o", "a_%04d.png")
        self.wait_for(process, "a_0000.png")
        process.send_signal(signal.SIGINT)
        self.assertIn("interrupted", process.stderr.readline() + process.stderr.readline())
        process.send_signal(signal.SIGINT)
        self.assertEqual(process.wait(timeout=10), -signal.SIGINT)


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]], verbosity=2)
