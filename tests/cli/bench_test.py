"""Tests `fovea bench` from outside. Usage: bench_test.py PROGRAM SOURCE_DIR [CLASS...]"""

import csv
import json
import os
import shutil
import signal
import subprocess
import sys
import time
import unittest

from program import BAD_INPUT, CANNOT_WRITE, INTERRUPTED, PROGRAM, SOURCE, USAGE, CliTest

SLOWER = 8
SUITE = {
    "description": "two scenes, two graphs",
    "paper": "table1",
    "scenes": ["cornellbox", "cornellbox_moving"],
    "graphs": ["direct", "ir_1000"],
    "size": "32x32", "first": 3, "frames": 2, "warmup": 1, "reference": {"spp": 4, "depth": 3},
    "measures": ["error", "temporal", "pictures"],
    "sweeps": [{"name": "all", "graphs": [{"graph": "direct"}, {"graph": "ir_1000", "set": {"vpl_count": 16, "map_size": 16}}],
                "speed_up": {"of": "direct", "over": ["ir_1000"]}}],
}


class BenchSuites(CliTest):
    def suite(self, **changes):
        return self.write("tiny.json", {**SUITE, **changes})

    def results(self, folder="out"):
        return {p.name: json.loads(p.read_text()) for p in (self.folder / folder / "results").glob("*.json")}

    def rows(self, sweep="all", folder="out"):
        with open(self.folder / folder / "tables" / f"{sweep}.csv", newline="") as file:
            return {(r["scene"], r["graph"], r["measure"]): r for r in csv.DictReader(file)}

    def test_from_suite_to_report(self):
        """Checks results, references that jobs share, tables beside the paper's numbers, and a self-contained page."""
        self.suite(graphs=["ours", "ir_1000"], set={"vpl_count": 16, "map_size": 16, "shadow_map_size": 256}, sweeps=[{"name": "all"}])
        run = self.succeeds("bench", "tiny.json", "-o", "out")
        self.assertIn("[4/4] all-cornellbox_moving-ir_1000-s1", run.stdout)
        self.assertIn("4 of 4 jobs have results", run.stdout)
        self.assertRegex(run.stdout, r"(?m)^cornellbox_moving +ir_1000 .*\d")  # the table on the terminal
        self.assertRegex(run.stdout, r"(?m)^scene +graph .*error\.fovea\.mse")
        results = self.results()
        self.assertEqual(len(results), 4)
        for result in results.values():
            self.assertGreater(result["error"]["fovea"]["noise_floor"], 0)
            self.assertGreater(result["error"]["whole"]["indirect_mse"], 0)
            self.assertGreater(result["error"]["indirect_light"], 0)
            self.assertNotEqual(result["error"]["whole"]["scaled_indirect_mse"], result["error"]["whole"]["indirect_mse"])
            self.assertIsInstance(result["temporal"]["fovea"]["indirect_excess"], float)
            self.assertIsInstance(result["temporal"]["periphery"]["excess"], float)
            self.assertGreater(result["time"]["frame"]["wall_ms"]["median"], 0)
            self.assertGreater(result["time"]["counters"]["deferred.shaded_pixels"], 0)
        self.assertEqual(len(list((self.folder / "out/references").iterdir())), 4)  # two scenes, two frames
        self.assertEqual(len(list((self.folder / "out/pictures").iterdir())), 16)
        row = self.rows()["cornellbox", "ours", "error.fovea.mse"]
        self.assertAlmostEqual(float(row["paper"]), 0.74e-3)
        self.assertAlmostEqual(float(row["ratio"]), float(row["mean"]) / 0.74e-3, delta=1e-4 * abs(float(row["ratio"])))
        page = self.folder / "out/report.html"
        if not page.exists():
            self.assertIn("matplotlib", run.stderr)
            self.skipTest("no report without matplotlib (apt: python3-matplotlib)")
        text = page.read_text()
        self.assertGreaterEqual(text.count("data:image/png;base64,"), 16)
        self.assertNotIn("src='pictures", text)
        for word in ("Sponza", "Cornellbox"):
            self.assertEqual(word in text, word == "Cornellbox")
        # Nothing is measured twice, and the errors agree with `compare`.
        again = self.succeeds("bench", "tiny.json", "-o", "out", "--resume")
        self.assertIn("4 of 4 jobs are done already", again.stdout)
        self.assertEqual(self.results(), results)

    def test_same_as_render_and_compare(self):
        self.suite()
        self.succeeds("bench", "tiny.json", "-o", "out", "--only", "*-cornellbox-ir*")
        (result,) = self.results().values()
        (last,) = (self.folder / "out/references").glob("*-f4-*.exr")
        self.succeeds("render", "ir_1000", "--scene", "cornellbox", "--size", "32x32", "--first", 2, "--warmup", 2, "--frames", 1,
                      "--set", "vpl_count=16", "--set", "map_size=16", "-o", "a.exr")
        m = json.loads(self.succeeds("compare", "a.exr", last, "--json").stdout)
        for region in ("fovea", "periphery", "whole"):
            self.assertAlmostEqual(m[region]["mse"], result["error"][region]["mse"], delta=1e-9)
            self.assertAlmostEqual(m[region]["direct_floor"], result["error"][region]["direct_floor"], delta=1e-9)

    def test_eyes(self):
        """The eyes of a stereo graph, of the last frame or of all, as `compare` finds them."""
        graph = {"graph": "ir_stereo", "set": {"vpl_count": 16, "map_size": 16}}
        self.suite(scenes=["cornellbox"], sweeps=[
            {"name": "last", "graphs": [graph], "measures": ["eyes", "error", "pictures"]},
            {"name": "both", "graphs": [graph], "layer": "indirect", "measures": ["eyes", "temporal"]},
            {"name": "alone", "graphs": [{"graph": "ir_1000", "set": graph["set"]}], "measures": ["error"]}])
        run = self.succeeds("bench", "tiny.json", "-o", "out")
        self.assertRegex(run.stdout, r"(?m)^scene +graph .*eyes\.fovea\.excess")
        results = {r["job"]["sweep"]: r for r in self.results().values()}
        self.assertNotIn("eyes", results["alone"])
        # Two for both eyes, of which the sweeps share one, and one of the other graph.
        self.assertEqual(len(list((self.folder / "out/references").iterdir())), 3)
        self.assertTrue((self.folder / "out/pictures/last-cornellbox-ir_stereo-s1-eyes.png").exists())
        (self.folder / "a").mkdir()
        self.succeeds("render", "ir_stereo", "--scene", "cornellbox", "--size", "32x32", "--first", 3, "--frames", 2, "--set",
                      "vpl_count=16", "--set", "map_size=16", "-o", "a/f_%d.exr")
        (self.folder / "g").mkdir()
        for frame in 3, 4:
            found = [f for f in (self.folder / "out/references").glob(f"*-f{frame}-*.exr") if b"correspondence" in f.read_bytes()]
            self.assertEqual(len(found), 1)
            shutil.copy(found[0], self.folder / f"g/f_{frame}.exr")
        last = json.loads(self.succeeds("compare", "--eyes", "a/f_4.exr", "g/f_4.exr", "--json").stdout)
        both = json.loads(self.succeeds("compare-sequence", "--eyes", "a", "g", "--layer", "indirect", "--json").stdout)
        for region in ("fovea", "periphery", "whole"):
            self.assertEqual(results["last"]["eyes"][region], last[region])
            self.assertEqual(results["both"]["eyes"][region], both[region])
            self.assertIsInstance(both[region]["flicker"], float)
        # The errors are those of the left eye.
        error = json.loads(self.succeeds("compare", "a/f_4.exr", "g/f_4.exr", "--json").stdout)["whole"]["mse"]
        self.assertAlmostEqual(results["last"]["error"]["whole"]["mse"], error, delta=1e-9)
        self.assertEqual(float(self.rows("both")["cornellbox", "ir_stereo", "eyes.fovea.flicker"]["mean"]),
                         float(f"{both['fovea']['flicker']:.6g}"))
        page = self.folder / "out/report.html"
        if page.exists():
            self.assertIn("eyes excess fovea", page.read_text())

    def test_eyes_of_a_graph_for_one(self):
        suite = self.write("tiny.json", json.dumps({**SUITE, "measures": ["eyes"]}, indent=1))
        line = next(i for i, text in enumerate(suite.read_text().splitlines(), 1) if '"graph": "direct"' in text) - 1
        run = self.call("bench", "tiny.json", "-o", "out")
        self.assertEqual(run.returncode, BAD_INPUT)
        for text in (f"tiny.json:{line}:", "the eyes of graph `direct` cannot be compared", "`radiance_right`", "as `stereo`"):
            self.assertIn(text, run.stderr)
        self.assertFalse(self.results())

    def test_two_shards_at_once(self):
        """Two processes share the folder and its references; together they do what one does alone."""
        self.suite()
        shards = [subprocess.Popen(self.command("bench", "tiny.json", "-o", "out", "--shard", f"{i}/2"), cwd=self.folder,
                                   stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) for i in (1, 2)]
        for shard in shards:
            out, err = shard.communicate(timeout=120)
            self.assertEqual(shard.returncode, 0, err)
        self.assertEqual(len(self.results()), 4)
        self.assertIn("4 of 4", self.succeeds("bench", "tiny.json", "-o", "out", "--report").stdout)
        self.succeeds("bench", "tiny.json", "-o", "alone", "-q")
        merged, alone = self.rows(), self.rows(folder="alone")
        self.assertEqual(merged.keys(), alone.keys())
        for key, row in alone.items():
            if not key[2].startswith(("time.", "pass.", "speed_up.")):
                self.assertEqual(merged[key], row)
        self.assertFalse([p for p in (self.folder / "out").rglob("*") if "claim" in p.name or "partial" in p.name])

    def test_goes_on_after_a_kill(self):
        """Finished results stay, also if the process is killed and leaves a claim behind."""
        self.suite(reference={"spp": 2000, "depth": 3})
        run = subprocess.Popen(self.command("bench", "tiny.json", "-o", "out"), cwd=self.folder, stdout=subprocess.PIPE, text=True)
        self.assertIn("4 jobs to measure, 4 references", run.stdout.readline())
        self.assertIn("[1/4]", run.stdout.readline())
        while not list(self.folder.glob("out/references/*.claim")) and run.poll() is None:
            time.sleep(0.001)
        run.kill()
        run.communicate()
        before = self.results()
        self.assertTrue(1 <= len(before) < 4)
        for claim in self.folder.glob("out/references/*.claim"):
            claim.write_text("")  # killed before it had written whose it is
        started = time.monotonic()
        self.suite(reference={"spp": 2000, "depth": 3})
        out = self.succeeds("bench", "tiny.json", "-o", "out", "--resume").stdout
        self.assertLess(time.monotonic() - started, 120)
        self.assertIn(f"{len(before)} of 4 jobs are done already", out)
        after = self.results()
        self.assertEqual(len(after), 4)
        self.assertTrue(before.items() <= after.items())

    def test_ctrl_c(self):
        self.suite(reference={"spp": 200000, "depth": 3})
        run = subprocess.Popen(self.command("bench", "tiny.json", "-o", "out"), cwd=self.folder, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        while not list(self.folder.glob("out/references/*.claim")) and run.poll() is None:
            time.sleep(0.01)
        run.send_signal(signal.SIGINT)
        _, err = run.communicate(timeout=60)
        self.assertEqual(run.returncode, INTERRUPTED, err)
        self.assertIn("0 of 4 jobs are done", err)
        self.assertEqual(self.results(), {})
        self.assertEqual(list((self.folder / "out/references").iterdir()), [])

    def test_refuses_to_mix(self):
        """Sizes, scenes, graphs and passes that have changed."""
        self.suite(measures=["time"])
        self.succeeds("bench", "tiny.json", "-o", "out", "-q")
        self.fails(BAD_INPUT, "bench", "tiny.json", "-o", "out", "--size", "16x16", says=["size", "32", "16", "--replace"])
        self.fails(BAD_INPUT, "bench", "tiny.json", "-o", "out", "--size", "16x16", "--report", says=["size"])
        # Results of another device and of a pass with other code, copied from elsewhere.
        name, result = next((n, r) for n, r in self.results().items() if "-direct-" in n)
        other = json.loads(json.dumps(result))
        other["made_with"]["device"] = "another"
        (self.folder / "out/results" / name).write_text(json.dumps(other))
        self.fails(BAD_INPUT, "bench", "tiny.json", "-o", "out", "--report", says=["another", "device", name])
        other = json.loads(json.dumps(result))
        other["made_with"]["passes"]["gbuffer"] = "0" * 16
        (self.folder / "out/results" / name).write_text(json.dumps(other))
        self.fails(BAD_INPUT, "bench", "tiny.json", "-o", "out", "--report", says=["gbuffer"])
        other["key"] = "0" * 16
        (self.folder / "out/results" / name).unlink()
        stale = self.folder / "out/results" / (name[:-21] + "0" * 16 + ".json")
        stale.write_text(json.dumps(other))
        self.fails(BAD_INPUT, "bench", "tiny.json", "-o", "out", says=["gbuffer", "0" * 16, "--replace"])
        self.succeeds("bench", "tiny.json", "-o", "out", "--replace")
        self.assertFalse(stale.exists())
        stale.write_text("{")
        self.fails(BAD_INPUT, "bench", "tiny.json", "-o", "out", says=[stale.name, "no result"])

    def test_changed_shader(self):
        """Results that depend on it are no longer comparable; the others are."""
        self.suite(measures=["time"])
        self.succeeds("bench", "tiny.json", "-o", "out", "-q")
        for folder in ("shaders", "passes"):
            shutil.copytree(SOURCE / folder, self.folder / "data" / folder)
        with open(self.folder / "data/passes/deferred/blocks.glsl", "a") as file:
            file.write("// a remark\n")
        with open(self.folder / "data/shaders/scene/scene.glsl", "a") as file:
            file.write("\n")
        data = {"FOVEA_DATA": str(self.folder / "data")}
        self.assertIn("4 of 4 jobs are done", self.succeeds("bench", "tiny.json", "-o", "out", env=data).stdout)
        with open(self.folder / "data/passes/deferred/blocks.glsl", "a") as file:
            file.write("#define CHANGED\n")
        self.fails(BAD_INPUT, "bench", "tiny.json", "-o", "out", "--only", "ir_1000", says=["passes.deferred"], env=data)
        self.assertIn("2 of 2 jobs are done", self.succeeds("bench", "tiny.json", "-o", "out", "--only", "direct", env=data).stdout)

    def test_what_a_result_is_made_with(self):
        """Results depend on their plan and on the code of their passes, the framework and the measures; references on the path tracer."""
        self.suite(scenes=["cornellbox"], size="16x16")
        self.succeeds("bench", "tiny.json", "-o", "out", "-q", "--only", "direct")
        (result,) = self.results().values()
        made = result["made_with"]
        for part in ("scene", "graph", "plan", "framework", "measures"):
            self.assertRegex(made[part], "^[0-9a-f]{16}$")
        self.assertEqual(set(made["passes"]), {"gbuffer", "shadow-map", "direct", "tonemap"})
        self.assertEqual(set(made["reference"]), {"path-trace", "parameters of path-trace"})
        # A change of a shader that the path tracer does not use makes no new reference.
        references = sorted((self.folder / "out/references").iterdir())
        for folder in ("shaders", "passes"):
            shutil.copytree(SOURCE / folder, self.folder / "data" / folder)
        for name in ("passes/tonemap/tonemap.frag", "passes/gbuffer/resolve.frag", "shaders/scene/animate.comp"):
            with open(self.folder / "data" / name, "a") as file:
                file.write("#define CHANGED\n")
        data = {"FOVEA_DATA": str(self.folder / "data")}
        self.fails(BAD_INPUT, "bench", "tiny.json", "-o", "out", "--only", "direct", says=["passes.gbuffer"], env=data)
        self.succeeds("bench", "tiny.json", "-o", "out", "-q", "--only", "direct", "--replace", env=data)
        (again,) = self.results().values()
        self.assertNotEqual(again["made_with"]["framework"], made["framework"])
        self.assertEqual(again["made_with"]["reference"], made["reference"])
        self.assertEqual(sorted((self.folder / "out/references").iterdir()), references)

    def test_only_keeps_the_other_rows(self):
        """Tables show all results in the folder, whichever jobs a run had; results that do not fit are left out with a message."""
        self.suite(measures=["time"])
        self.succeeds("bench", "tiny.json", "-o", "out", "-q", "--only", "*-cornellbox-*")
        self.succeeds("bench", "tiny.json", "-o", "out", "-q", "--only", "*_moving-direct*")
        out = self.succeeds("bench", "tiny.json", "-o", "out", "--only", "*_moving-ir*").stdout
        self.assertIn("4 of 4 jobs have results", out)
        self.assertEqual({key[:2] for key in self.rows()}, {(s, g) for s in SUITE["scenes"] for g in SUITE["graphs"]})
        name, result = next((n, r) for n, r in self.results().items() if "-cornellbox-direct-" in n)
        result["made_with"]["framework"] = "0" * 16
        (self.folder / "out/results" / name).write_text(json.dumps(result))
        run = self.succeeds("bench", "tiny.json", "-o", "out", "--only", "*_moving-ir*")
        self.assertIn("3 of 4 jobs have results", run.stdout)
        self.assertIn("left out of the tables", run.stderr)
        self.assertIn("framework", run.stderr)
        self.assertNotIn(("cornellbox", "direct", "time.wall_ms"), self.rows())
        self.fails(BAD_INPUT, "bench", "tiny.json", "-o", "out", "--report", says=["framework", name])

    def test_scenes_of_the_command_line(self):
        """A folder of scene files and a bare name replace the scenes of the suite."""
        self.suite(measures=["time"], scenes=["cornellbox"])
        (self.folder / "mine/none").mkdir(parents=True)
        for name in ("dim", "bright"):
            self.write(f"mine/{name}.json", {"models": [{"builtin": "cornellbox"}], "exposure": 2 if name == "bright" else 1})
        listed = self.succeeds("bench", "tiny.json", "--list", "--scene", "mine/", "--scene", "cornellbox_moving").stdout.split()
        self.assertEqual(listed, [f"all-{s}-{g}-s1" for s in ("bright", "dim", "cornellbox_moving") for g in ("direct", "ir_1000")])
        self.succeeds("bench", "tiny.json", "-o", "out", "-q", "--scene", "mine/", "--only", "direct")
        self.assertEqual({key[:2] for key in self.rows()}, {("mine/bright.json", "direct"), ("mine/dim.json", "direct")})
        self.write("mine/none/readme.txt", "")
        self.fails(BAD_INPUT, "bench", "tiny.json", "--list", "--scene", "mine/none/", says=["mine/none", "no readable scene files"])
        self.fails(USAGE, "bench", "tiny.json", "--list", "--scene", "mine/", "--scene", "mine/dim.json", says=["mine/dim.json", "both", "rename"])
        self.fails(USAGE, "bench", "passes", "--graph", "direct", says=["--scene", "cornellbox"])
        # A scene that the command line names has to be there, even if the suite could do without it.
        self.suite(measures=["time"], scenes=["cornellbox", "nowhere"], optional_scenes=["nowhere"])
        for name in ("nowhere", "mine/" + 300 * "x" + "/"):
            self.fails(BAD_INPUT, "bench", "tiny.json", "-o", "out", "--scene", name, says=[name[:20], "cannot be used"])

    def test_scales_and_page(self):
        """A scale changes what is measured; results of two scales are not mixed; the suite's own script writes a page."""
        self.suite(measures=["time"], page="paper", frames=3,
                   scales={"tiny": {"size": "16x16", "max_frames": 2, "scenes": ["cornellbox"]}, "own": {}})
        listed = self.succeeds("bench", "tiny.json", "--list", "--scale", "tiny").stdout.split()
        self.assertEqual(listed, ["all-cornellbox-direct-s1", "all-cornellbox-ir_1000-s1"])
        self.assertEqual(len(self.succeeds("bench", "tiny.json", "--list", "--scale", "own").stdout.split()), 4)
        self.fails(USAGE, "bench", "tiny.json", "--list", "--scale", "tini", says=["`tini`", "tiny, own"])
        out = self.succeeds("bench", "tiny.json", "-o", "out", "--scale", "tiny").stdout
        self.assertIn("2 jobs to measure, 0 references", out)
        self.assertIn("wrote out/paper/README", out)
        for result in self.results().values():
            self.assertEqual((result["job"]["size"], result["job"]["frames"]), ([16, 16], 2))
        head = json.loads((self.folder / "out/report.json").read_text())
        self.assertEqual((head["scale"], head["command"]), ("tiny", "fovea bench tiny.json -o DIR --scale tiny"))
        page = (self.folder / "out/paper" / "README.md").read_text()
        self.assertIn("Scale: `tiny`; pictures of 16x16 pixels", page)
        self.assertIn("not measured yet", page)
        self.fails(BAD_INPUT, "bench", "tiny.json", "-o", "out", "--report", says=["--scale"])

    def test_shared_references(self):
        """Several suites share one cache, which may be filled at any time; the jobs then make no references."""
        self.suite(scenes=["cornellbox"])
        self.write("other.json", {**SUITE, "scenes": ["cornellbox"], "frames": 3, "measures": ["error"]})
        out = self.succeeds("bench", "tiny.json", "-o", "a", "--cache", "cache", "--references-only", "--shard", "1/2").stdout
        self.assertIn("1 references: 1 made, 0 were there", out)
        out = self.succeeds("bench", "tiny.json", "-o", "a", "--cache", "cache", "--references-only").stdout
        self.assertIn("2 references: 1 made, 1 were there", out)
        self.assertEqual(self.results("a"), {})
        made = {p.name: p.stat().st_mtime_ns for p in (self.folder / "cache").iterdir()}
        self.assertEqual(len(made), 2)
        self.succeeds("bench", "tiny.json", "-o", "a", "--cache", "cache", "-q")
        self.assertEqual({p.name: p.stat().st_mtime_ns for p in (self.folder / "cache").iterdir()}, made)
        # Another suite in another folder; its only new reference is that of its last frame.
        self.succeeds("bench", "other.json", "-o", "b", "-q", env={"FOVEA_BENCH_CACHE": str(self.folder / "cache")})
        self.assertEqual(len(list((self.folder / "cache").iterdir())), 3)
        self.assertFalse((self.folder / "b/references").exists())
        self.suite(measures=["time"])
        self.fails(USAGE, "bench", "tiny.json", "-o", "a", "--references-only", says=["no job", "reference"])

    def test_match(self):
        """Bisection finds the number of VPLs at which a graph is as good as another one."""
        self.suite(scenes=["cornellbox"], measures=["error"], frames=1, reference={"spp": 32, "depth": 3}, sweeps=[
            {"name": "eq", "set": {"map_size": 16}, "graphs": [
                {"graph": "ir_1000", "label": "wanted", "set": {"vpl_count": 6}},
                {"graph": "ir_1000", "label": "found", "match": {"like": "wanted", "from": 2, "to": 256, "measure": "error.whole.mse"}}]}])
        self.succeeds("bench", "tiny.json", "-o", "out", "-q")
        found = next(r for n, r in self.results().items() if "found" in n)
        wanted = next(r for n, r in self.results().items() if "wanted" in n)
        self.assertTrue(found["match"]["reached"])
        self.assertEqual(found["match"]["target"], wanted["error"]["whole"]["mse"])
        self.assertLessEqual(found["error"]["whole"]["mse"], wanted["error"]["whole"]["mse"])
        row = self.rows("eq")["cornellbox", "found", "match.value"]
        self.assertEqual((float(row["mean"]), row["bound"]), (found["match"]["value"], ""))

    def test_match_out_of_range(self):
        """A result outside the range of a bisection is a bound, also for the speed-up, and is not compared with the paper's number."""
        matched = {"like": "ours", "measure": "error.whole.mse"}
        self.suite(scenes=["cornellbox"], paper="table2", measures=["error"], frames=1, reference={"spp": 32, "depth": 3}, sweeps=[
            {"name": "eq", "set": {"map_size": 16}, "speed_up": {"of": "ours", "over": ["ir_eq", "few"]}, "graphs": [
                {"graph": "ir_1000", "label": "ours", "set": {"vpl_count": 40}},
                {"graph": "ir_1000", "label": "ir_eq", "match": dict(matched, **{"from": 1, "to": 2})},
                {"graph": "ir_1000", "label": "few", "match": dict(matched, **{"from": 400, "to": 500})}]}])
        shown = self.succeeds("bench", "tiny.json", "-o", "out").stdout
        rows = self.rows("eq")
        for label, value, sign in (("ir_eq", "2", ">"), ("few", "400", "<")):
            found = rows["cornellbox", label, "match.value"]
            self.assertEqual((found["mean"], found["bound"], found["paper"] and found["ratio"]), (value, sign, ""))
            self.assertEqual(rows["cornellbox", "ours", "speed_up." + label]["bound"], sign)
            self.assertRegex(shown, rf"{label} .*{sign} {value}")
        self.assertEqual(rows["cornellbox", "ours", "speed_up.ir_eq"]["ratio"], "")
        page = (self.folder / "out/report.html").read_text()
        self.assertIn("&gt; 2", page)
        self.assertIn("&lt; 400", page)

    def test_mistakes_before_anything_runs(self):
        self.suite(scenes=["cornellbox", "cornelbox"])
        self.located("tiny.json:", "cornelbox")
        self.suite(sweeps=[{"name": "a"}, {"name": "b", "graphs": ["direct", "iir_1000"]}])
        self.located("tiny.json:", "iir_1000")
        self.suite(set={"vpl_cout": 3}, sweeps=[{"name": "a", "graphs": ["ir_1000"]}])
        self.located("tiny.json:", "vpl_cout", "vpl_count")
        self.suite(size="0x3")
        self.located("tiny.json:", "size")
        self.suite()
        for arguments, words in ((["tiny.json"], ["-o"]), (["tiny.json", "-o", "o", "--shard", "3/2"], ["3/2"]),
                                 (["tiny.json", "-o", "o", "--only", "x*y"], ["x*y"]), (["tiny.json", "-o", "o", "--graph", "ours"], ["passes"])):
            self.fails(USAGE, "bench", *arguments, says=words)
        self.fails(BAD_INPUT, "bench", "quik", "-o", "o", says=["quik", "`quick`"])
        self.fails(BAD_INPUT, "bench", "tiny.json", "-o", "o", "--resume", says=["nothing to resume"])

    def located(self, *says):
        run = self.call("bench", "tiny.json", "-o", "out")
        self.assertEqual(run.returncode, BAD_INPUT, run.stderr)
        for text in says:
            self.assertIn(text, run.stderr)
        self.assertEqual(self.results(), {})

    def test_missing_scene(self):
        """An optional scene is left out with a message, also on the page."""
        self.suite(scenes=["cornellbox", "nowhere"], optional_scenes=["nowhere"], measures=["time"])
        run = self.succeeds("bench", "tiny.json", "-o", "out")
        self.assertIn("`nowhere` is left out", run.stderr)
        self.assertIn("2 of 4 jobs have results", run.stdout)
        self.assertIn("nowhere", json.loads((self.folder / "out/report.json").read_text())["missing_scenes"])

    def test_read_only_folder(self):
        self.suite()
        (self.folder / "file").write_text("")
        self.fails(CANNOT_WRITE, "bench", "tiny.json", "-o", "file/out", says=["file/out"])
        if os.geteuid() == 0:
            self.skipTest("root may write everywhere")
        (self.folder / "out").mkdir(mode=0o500)
        self.fails(CANNOT_WRITE, "bench", "tiny.json", "-o", "out", says=["out"])

    def test_full_disk(self):
        """Too small a disk is reported before anything is rendered; one that fills up meanwhile is an error, not a broken result."""
        self.suite()
        disk = self.folder / "disk"
        disk.mkdir()
        if subprocess.run(["mount", "-t", "tmpfs", "-o", "size=100k", "tmpfs", str(disk)], capture_output=True).returncode != 0:
            self.skipTest("no right to mount a small file system")
        self.addCleanup(subprocess.run, ["umount", str(disk)], check=True)
        run = self.call("bench", "tiny.json", "-o", "disk/out", "--size", "512x512")
        self.assertEqual(run.returncode, CANNOT_WRITE, run.stderr)
        self.assertIn("needs about", run.stderr)
        (disk / "filler").write_bytes(b"x" * 80000)
        run = self.call("bench", "tiny.json", "-o", "disk/out", "--size", "8x8")
        self.assertEqual(run.returncode, CANNOT_WRITE, run.stderr)
        self.assertFalse(list(disk.glob("out/results/*")))


class BenchPasses(CliTest):
    COMMON = ["bench", "passes", "--graph", "direct", "--scene", "cornellbox", "--size", "32x32", "--frames", "3", "--warmup", "1", "--repeats", "3"]

    def test_table_and_baseline(self):
        out = self.succeeds(*self.COMMON, "-o", "base.json").stdout
        for word in ("gbuffer", "p95", "wall time of a frame"):
            self.assertIn(word, out)
        base = json.loads((self.folder / "base.json").read_text())
        self.assertEqual(len(base["repeats"]), 3)
        self.assertEqual(len(base["repeats"][0]["passes"]["gbuffer"]["gpu_ms"]), 3)
        # The same result is neither slower nor faster by a factor of 4; one that is a hundred times as fast or slow is.
        self.assertNotIn("SLOWER", self.succeeds(*self.COMMON, "--baseline", "base.json", "--threshold", "300").stdout)
        for factor, code, word in ((0.01, SLOWER, "SLOWER"), (100, 0, "faster")):
            changed = json.loads(json.dumps(base))
            for repeat in changed["repeats"]:
                for times in (*repeat["passes"].values(), repeat["frame"]):
                    for clock in ("gpu_ms", "cpu_ms", "wall_ms"):
                        if clock in times:
                            times[clock] = [factor * t for t in times[clock]]
            self.write("changed.json", changed)
            run = self.call(*self.COMMON, "--baseline", "changed.json")
            self.assertEqual(run.returncode, code, run.stderr + run.stdout)
            self.assertIn(word, run.stdout)

    def test_against_another_build(self):
        """The repeats of both builds take turns."""
        run = self.call(*self.COMMON, "--baseline", PROGRAM, "--threshold", "400")
        self.assertEqual(run.returncode, 0, run.stderr + run.stdout)
        self.assertIn("99% interval", run.stdout)

    def test_mistakes(self):
        self.fails(USAGE, "bench", "passes", "--graph", "direct", says=["--scene"])
        self.fails(BAD_INPUT, *self.COMMON, "--baseline", "nothing.json", says=["nothing.json"])
        self.succeeds(*self.COMMON, "-q", "-o", "base.json")
        run = self.call(*self.COMMON[:7], "16x16", "--baseline", "base.json")
        self.assertEqual(run.returncode, BAD_INPUT)
        self.assertIn("size is 32x32 there and 16x16 here", run.stderr)
        self.fails(CANNOT_WRITE, *self.COMMON, "-o", "no/where.json", says=["no/where.json"])


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]], verbosity=2)
