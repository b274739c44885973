"""Tests the commands for authors of graphs and passes: graphs, describe, fmt, diff, new, completion, check --strict.

Usage: author_test.py PROGRAM SOURCE_DIR [CLASS...]
"""

import json
import os
import re
import shutil
import subprocess
import sys
import unittest

from program import BAD_INPUT, CANNOT_WRITE, PROGRAM, SMALL, SOURCE, USAGE, CliTest

GRAPHS = SOURCE / "graphs"
FILES = sorted(path for path in GRAPHS.rglob("*.json") if not path.name.endswith(".schema.json"))
NAMES = [path.relative_to(GRAPHS).with_suffix("").as_posix() for path in FILES if path.parent.name != "parts"]


class AuthorStories(CliTest):
    def story(self, *arguments):
        return json.loads(self.succeeds("describe", *arguments, "--json").stdout)

    def test_graphs(self):
        listed = self.succeeds("graphs").stdout.splitlines()
        self.assertEqual(sorted(line.split()[0] for line in listed), sorted(NAMES))
        self.assertEqual([line for line in listed if len(line) > 140 or len(line.split()) < 3], [])
        entries = {entry["name"]: entry for entry in json.loads(self.succeeds("graphs", "--json").stdout)}
        self.assertEqual(entries["ours_r"]["extends"], "ours.json")
        self.assertIsNone(entries["direct"]["extends"])
        self.write("mine.json", {"version": 2, "extends": "ours.json", "description": "my own"})
        self.assertEqual(self.succeeds("graphs", ".").stdout, "mine  my own\n")
        self.fails(BAD_INPUT, "graphs", "nowhere", says=["`nowhere` is no folder"])

    def test_describe(self):
        text = self.succeeds("describe", "ours", "--size", "64x64").stdout
        for part in (r"vpl_count +1000 \(1 to \d+, whole\) .* -> manage.count", r"intensity +importance-area \(one of .*area",
                     r"reuse +linear .* -> manage.reuse", r"view.materials ", r"0 gbuffer +\d+ ", r"memory at 64x64: "):
            self.assertRegex(text, part)
        ours = self.story("ours", "--set", "kernel=disc")
        parameters = {p["name"]: p for p in ours["parameters"]}
        self.assertEqual(parameters["kernel"]["value"], "disc")
        self.assertEqual(parameters["voxels"]["reaches"], ["voxelize.resolution"])
        self.assertGreater(parameters["voxels"]["max"], parameters["voxels"]["min"])
        self.assertEqual([p["level"] for p in ours["passes"]], sorted(p["level"] for p in ours["passes"]))
        self.assertGreater(ours["memory"]["kept"], 0)

    def test_strategies_fit(self):
        """The types that a strategy may name in general, and those to which this graph's wires lead."""
        offered = {name: next(p["choices"] for p in self.story(name)["parameters"] if p["name"] == "intensity")
                   for name in ("ours", "foveal")}
        self.assertIn("pdf", offered["ours"])
        self.assertEqual(offered["foveal"], ["importance-area"])

    def test_json_of_lists(self):
        passes = json.loads(self.succeeds("passes", "--json").stdout)
        self.assertEqual([p["name"] for p in passes], [line.split()[0] for line in self.succeeds("passes").stdout.splitlines()])
        tonemap = json.loads(self.succeeds("passes", "tonemap", "--json").stdout)
        self.assertIn(tonemap, passes)
        self.assertEqual([p["name"] for p in tonemap["ports"] if p["direction"] == "out"], ["image"])
        scene = json.loads(self.succeeds("scene", "info", "cornellbox", "--json").stdout)
        self.assertGreater(scene["triangles"], 10)
        self.assertEqual(len(scene["cameras"][0]["position"]), 3)
        devices = json.loads(self.succeeds("devices", "--json").stdout)
        self.assertEqual(devices[0]["index"], 0)


# Stock graphs of version 1 of the format, and what has changed in the methods since: the values that today's graphs have.
VERSION_1 = SOURCE / "tests/data/graphs/version1/stock"
OURS = ["candidates.region=mixed", "vpl-intensity.region=mixed", "importance.luminance=true",
        "importance.luminance_floor=0.1", "near-field.spacing=4",
        *(f"{name}.{value}" for name in ("deferred", "vpl-intensity")
          for value in ("clamp_distance=0.25", "clamp_unit=mean-free-paths"))]
CLAMPED = [*OURS, "vpl-intensity.kernel=clamp"]
BOTH_EYES = [*CLAMPED, "right/deferred.clamp_distance=0.25", "right/deferred.clamp_unit=mean-free-paths"]
VOXEL_PATHS = ["candidates.image_share=0.6", "vpl-intensity.image_share=0.6"]
EYE_PATHS = [*VOXEL_PATHS, "eye-paths.image_share=0.6", "eye-paths.paths=32768"]
FOVEAL = [*EYE_PATHS, "contact-rays.rays=4", "near-field.fovea_samples=3", "near-field-mean.fovea_samples=3"]
CHANGED = {**dict.fromkeys(["ours", "ours_cosine", "ours_saccades", "debug/atlas", "debug/voxels", "debug/vpls"], CLAMPED),
           "ours_r": [*CLAMPED, "manage.random_share=0.5"],
           **dict.fromkeys(["stereo", "debug/mask"], BOTH_EYES), "ours_unclamped": OURS,
           **dict.fromkeys(["ir_v", "debug/ir_v_accumulated"], ["near-field.spacing=4"]),
           **dict.fromkeys(["foveal", "foveal_view", "foveal_stereo", "foveal_no_shadow_rays"], FOVEAL),
           "foveal_no_near_field": [*EYE_PATHS, "deferred.near_light=none"],
           "foveal_voxel_paths": [*VOXEL_PATHS, "deferred.near_light=none"]}
# These had no passes for near-field light. Today's have them, but they do not run.
NOT_RUN = [r"\+ pass (motion-vectors|near-field|near-field-mean): .*", r"\+ plan .*: does not run", r"memory .*"]


class AuthorMigration(CliTest):
    def test_graphs_of_version_1_have_the_plans_of_todays(self):
        old = self.folder / "old"
        shutil.copytree(VERSION_1, old)
        files = sorted(old.rglob("*.json"))
        self.succeeds("migrate", *files)
        self.succeeds("migrate", "--check", *files)
        for file in files:
            name = file.relative_to(old).with_suffix("").as_posix()
            if name.startswith("parts/"):
                continue
            if name in ("ir_accumulated", "ir_v_accumulated"):
                name = "debug/" + name  # where it is today
            with self.subTest(graph=name):
                values = [word for value in CHANGED.get(name, []) for word in ("--set", value)]
                lines = self.succeeds("diff", file, name, *values).stdout.splitlines()
                expected = NOT_RUN if name in ("foveal_no_near_field", "foveal_voxel_paths") else []
                self.assertEqual([line for line in lines if not any(re.fullmatch(e, line) for e in expected)], [])


class AuthorValues(CliTest):
    def offered(self, graph):
        """Names and ranges of what can be set: of the graph, of each of its passes, and of the frame."""
        story = json.loads(self.succeeds("describe", graph, "--json").stdout)
        return [(before + p["name"], p)
                for before, owner in [("", story["parameters"]), ("view.", story["view"]),
                                      *((p["name"] + ".", p["parameters"]) for p in story["passes"])]
                for p in owner if "given_by" not in p]

    def tries(self, command, graph, values):
        arguments = ["--scene", "cornellbox", "--quiet", "-o", "a.exr"] if command == "render" else []
        if graph in ("reference", "alternatives/reference_stereo") and not any(value.startswith("spp=") for value in values):
            arguments += ["--set", "spp=2"]
        return self.call(command, graph, "--size", "16x16", *arguments, *(w for v in values for w in ("--set", v)))

    def refused(self, command, graph, values):
        """Those of the values with which the graph does not render, and what is said then: in halves, as most values do."""
        run = self.tries(command, graph, values)
        if run.returncode == 0:
            return []
        if len(values) == 1:
            return [(values[0], run)]
        half = len(values) // 2
        return self.refused(command, graph, values[:half]) + self.refused(command, graph, values[half:])

    def test_every_value_that_is_offered_renders(self):
        """Every value of strategies and flags, and the least of each number. The greatest is checked, as it may take long.

        A number may still contradict another one, as it is not known what it will be combined with, and the device
        may be too small for a choice.
        """
        for graph in NAMES:
            rounds = {}  # many values at once: the first of each, the second of each, ...
            for name, p in self.offered(graph):
                chosen = p.get("choices") or (["true", "false"] if p["type"] == "bool" else [])
                for k, value in enumerate(value for value in chosen if str(p["value"]).lower() != value):
                    rounds.setdefault(("render", k), []).append(f"{name}={value}")
                for command, end in (("render", "min"), ("check", "max")):
                    if end in p and not chosen:
                        rounds.setdefault((command, end), []).append(f"{name}={p[end]:.9g}")
            for (command, which), values in rounds.items():
                for value, run in self.refused(command, graph, values):
                    with self.subTest(graph=graph, value=value):
                        self.assertTrue(which in ("min", "max") or "exceed this device's maxImageArrayLayers" in run.stderr, run.stderr)
                        self.assertEqual(run.returncode, BAD_INPUT, run.stderr)
                        self.assertRegex(run.stderr, r"fovea: --set \S+: error: .+\n  -> .+")


class AuthorFiles(CliTest):
    def plan(self, graph):
        return json.loads(self.succeeds("check", graph, "--plan", "json").stdout)["hash"]

    def test_stock_graphs_have_the_stable_layout(self):
        self.assertEqual(self.succeeds("fmt", "--check", *FILES).stdout, "")

    def test_stock_graphs_say_nothing_in_vain(self):
        for graph in NAMES:
            with self.subTest(graph=graph):
                self.assertEqual(self.succeeds("check", graph, "--strict").stderr, "")

    def test_fmt(self):
        ugly = '{"passes":{"tonemap":{"params":{"operator":"reinhard"}}},\n\n"extends":"ours.json",  "version":2}'
        self.write("ugly.json", ugly)
        plan = self.plan("ugly.json")
        check = self.call("fmt", "--check", "ugly.json")
        self.assertEqual((check.returncode, (self.folder / "ugly.json").read_text()), (BAD_INPUT, ugly))
        self.assertIn("ugly.json: has another layout", check.stdout)
        self.succeeds("fmt", "ugly.json")
        self.assertEqual((self.folder / "ugly.json").read_text(),
                         '{\n  "version": 2,\n  "extends": "ours.json",\n'
                         '  "passes": { "tonemap": { "params": { "operator": "reinhard" } } }\n}\n')
        self.assertEqual(self.plan("ugly.json"), plan)
        self.succeeds("fmt", "--check", "ugly.json")
        self.fails(BAD_INPUT, "fmt", "none.json", says=["none.json"])
        self.write("wrong.json", "{")
        self.fails(BAD_INPUT, "fmt", "wrong.json", says=["wrong.json:1:2"])

    def test_strict(self):
        self.write("mine.json", {"version": 2, "extends": "ours.json", "parameters": {"kernel": "clamp", "mine": 1},
                                 "passes": {"mean": {"type": "accumulate", "inputs": {"value": "direct"}}}})
        self.succeeds("check", "mine.json")
        run = self.fails(BAD_INPUT, "check", "mine.json", "--strict",
                         says=["mine.json:5:5: error: `kernel` is the text \"clamp\" without this",
                               "nothing uses the graph parameter `mine`", "pass `mean` does not run"])
        self.assertEqual(run.stderr.count("error"), 3, run.stderr)
        for name in NAMES:
            with self.subTest(graph=name):
                self.succeeds("check", name, "--strict")

    def test_diff_of_graphs(self):
        self.assertEqual(self.succeeds("diff", "ours", "ours", "--check").stdout, "")
        for name in NAMES:
            with self.subTest(graph=name):
                self.write("merged.json", self.succeeds("check", name, "--merged").stdout)
                self.assertEqual(self.succeeds("diff", name, "merged.json", "--check").stdout, "")
        self.write("mine.json", {"version": 2, "extends": "ours.json", "parameters": {"vpl_count": 500},
                                 "passes": {"mean": {"type": "accumulate", "inputs": {"value": "deferred.radiance"}},
                                            "tonemap": {"inputs": {"radiance": "mean"}}}})
        run = self.call("diff", "ours", "mine.json", "--check")
        self.assertEqual(run.returncode, BAD_INPUT)
        lines = run.stdout.splitlines()
        for line in ("+ pass mean: accumulate", "parameter manage.count: 1000 -> 500",
                     "wire tonemap.radiance: deferred.radiance -> mean.mean"):
            self.assertIn(line, lines)
        self.assertEqual([line for line in lines if " mean." in line and line[0] in "+-"], [], "said with the pass")

    def test_diff_of_pictures(self):
        for name, curve in (("a", "clamp"), ("b", "clamp"), ("c", "reinhard")):
            self.succeeds("render", "direct", "--scene", "cornellbox", *SMALL, "--set", f"tonemap.operator={curve}",
                          "-o", f"{name}.png")
        self.assertEqual(self.succeeds("diff", "a.png", "b.png", "--check").stdout, "")
        run = self.call("diff", "a.png", "c.png", "--check")
        self.assertEqual(run.returncode, BAD_INPUT)
        numbers = json.loads(self.succeeds("compare", "a.png", "c.png", "--json").stdout)["whole"]
        self.assertEqual(float(run.stdout.split()[1].rstrip(",")), float(f"{numbers['mse']:.4g}"))

    def test_new_graph(self):
        self.assertIn("describe mine.json", self.succeeds("new", "graph", "mine", "--extends", "foveal").stdout)
        self.succeeds("check", "mine.json", "--strict")
        self.assertEqual(self.succeeds("diff", "foveal", "mine.json").stdout, "")
        self.succeeds("fmt", "--check", "mine.json")
        self.fails(CANNOT_WRITE, "new", "graph", "mine", says=["mine.json is there already"])
        self.fails(BAD_INPUT, "new", "graph", "other", "--extends", "fovael", says=["`foveal`"])

    def test_new_pass(self):
        self.succeeds("new", "pass", "vignette-two")
        test = subprocess.run([self.folder / "vignette-two/test.sh"], env={**os.environ, "FOVEA": str(PROGRAM)},
                              capture_output=True, text=True, timeout=120)
        self.assertEqual((test.returncode, test.stdout.splitlines()[-1:]), (0, ["passed"]), test.stdout + test.stderr)
        self.succeeds("fmt", "--check", "vignette-two/vignette-two.json")
        self.fails(CANNOT_WRITE, "new", "pass", "vignette-two", says=["is there already"])
        self.fails(BAD_INPUT, "new", "pass", "tonemap", says=["there is a pass type `tonemap`"])
        self.fails(USAGE, "new", "pass", "My_Pass", says=["lower-case"])

    def complete(self, *words):
        script = ('source <("$0" completion bash); fovea() { "$program" "$@"; }; COMP_WORDS=("$@"); '
                  'COMP_CWORD=$(($# - 1)); _fovea; printf "%s\\n" "${COMPREPLY[@]}"')
        run = subprocess.run(["bash", "-c", script, PROGRAM, "fovea", *words], cwd=self.folder, capture_output=True,
                             text=True, timeout=60, env={**os.environ, "program": str(PROGRAM)})
        self.assertEqual((run.returncode, run.stderr), (0, ""))
        return set(run.stdout.split())

    def complete_in_fish(self, line):
        script = '$program completion fish | source; function fovea; $program $argv; end; complete -C "fovea $line"'
        run = subprocess.run(["fish", "--no-config", "-c", script], cwd=self.folder, capture_output=True, text=True, timeout=60,
                             env={**os.environ, "program": str(PROGRAM), "line": line})
        self.assertEqual((run.returncode, run.stderr), (0, ""))
        return {answer.split("\t")[0] for answer in run.stdout.splitlines()}

    def test_completion(self):
        self.assertLessEqual({"render", "describe", "diff", "completion"}, self.complete(""))
        self.assertEqual(self.complete("des"), {"describe"})
        self.assertEqual(self.complete("check", "--pl"), {"--plan", "--plugin"})
        self.assertEqual(self.complete("check", "ours", "--plan", ""), {"text", "dot", "json"})
        self.assertEqual(self.complete("check", "foveal_v"), {"foveal_view", "foveal_voxel_paths"})
        self.assertEqual(self.complete("passes", "tonem"), {"tonemap"})
        self.assertEqual(self.complete("scene", "inf"), {"info"})
        self.write("files.json", {})
        self.assertEqual(self.complete("new", ""), {"--help", "graph", "pass"})
        self.assertEqual(self.complete("scene", "info", "fil"), {"files.json"})
        self.assertEqual(self.complete("render", "ours", "--scene", "atr"), {"atrium"})
        self.assertEqual(self.complete("render", "ours", "--scene", "fil"), {"files.json"})
        for shell in ("zsh", "fish"):
            text = self.succeeds("completion", shell).stdout
            self.assertIn("describe", text)
            if shutil.which(shell):
                subprocess.run([shell, "-n", "/dev/stdin"], input=text, text=True, check=True, timeout=60)
        if shutil.which("fish"):
            self.assertEqual(self.complete_in_fish("check ours --plan "), {"text", "dot", "json"})
            self.assertEqual(self.complete_in_fish("check foveal_v"), {"foveal_view", "foveal_voxel_paths"})
            self.assertEqual(self.complete_in_fish("new "), {"graph", "pass"})
            self.assertEqual(self.complete_in_fish("render ours --scene atr"), {"atrium"})
        if shutil.which("zsh"):
            run = subprocess.run(["zsh", "-fc", 'source <($program completion zsh) && print -r -- $_comps[fovea]'],
                                 capture_output=True, text=True, timeout=60, env={**os.environ, "program": str(PROGRAM)})
            self.assertEqual((run.returncode, run.stdout.strip()), (0, "_bash_complete -o filenames -F _fovea"), run.stderr)
        self.fails(USAGE, "completion", "csh", says=["bash", "zsh", "fish"])

    def test_schema_of_variants(self):
        import jsonschema
        schema = json.loads((GRAPHS / "fovea-graph.schema.json").read_text())
        validator = jsonschema.validators.validator_for(schema)(schema)

        def mistakes(**graph):
            return len(list(validator.iter_errors({"version": 2, **graph})))

        ours = {"extends": "ours.json"}
        self.assertEqual(mistakes(**ours, parameters={"reuse": "cosine", "vpl_count": 5}), 0)
        self.assertGreater(mistakes(**ours, parameters={"reuse": "cosinus"}), 0)
        self.assertGreater(mistakes(**ours, parameters={"intensity": "areas"}), 0)
        self.assertGreater(mistakes(**ours, parameters={"vpl_count": 0}), 0)
        self.assertEqual(mistakes(**ours, passes={"manage": {"params": {"count": "$vpl_count"}}}), 0)
        self.assertGreater(mistakes(**ours, passes={"manage": {"params": {"ordr": 1}}}), 0)
        self.assertGreater(mistakes(**ours, passes={"manage": {"params": {"count": "$nope"}}}), 0)
        self.assertGreater(mistakes(**ours, passes={"manege": {"params": {"count": 5}}}), 0)
        self.assertGreater(mistakes(**ours, passes={"vpl-intensity": {"params": {"ordr": 1}}}), 0)
        self.assertEqual(mistakes(**ours, parameters={"mine": 5}, passes={"manage": {"params": {"count": "$mine"}}}), 0)
        self.assertEqual(mistakes(**ours, passes={"mean": {"type": "accumulate"}, "mipmap": None}), 0)
        alone = {"passes": {"gbuffer": {"type": "gbuffer"},
                            "tonemap": {"type": "tonemap", "params": {"exposure": "$nope"}}}}
        self.assertGreater(mistakes(**alone), 0)
        self.assertEqual(mistakes(**alone, parameters={"nope": 1}), 0)
        self.assertEqual(mistakes(extends="own.json", passes={"any": {"params": {"ordr": 1}}}), 0)


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]], verbosity=2)
