"""Tests `fovea bench model` from outside. Usage: bench_model_test.py PROGRAM SOURCE_DIR [CLASS...]"""

import json
import sys
import unittest

from program import BAD_INPUT, CANNOT_WRITE, NO_DEVICE, USAGE, CliTest

SETTINGS = ["ir_1000", "--size", "64x64", "--set", "vpl_count=16", "--set", "map_size=16"]
COMMON = ["bench", "model", *SETTINGS, "--scene", "cornellbox", "--frames", "3", "--warmup", "1"]


class BenchModel(CliTest):
    def model(self, *arguments):
        self.shown = self.succeeds(*COMMON, "--json", "model.json", *arguments).stdout
        return json.loads((self.folder / "model.json").read_text())

    def check_pass(self, found, planned, rates):
        # Without the scene, a plan knows nothing else for certain.
        self.assertEqual(found["traffic"]["pictures"], planned["traffic"]["pictures"])
        if planned["commands"] is not None:
            self.assertEqual(found["commands"], planned["commands"])
        amounts = {"bytes": sum(found["traffic"]["pictures"].values()), "operations": found["operations"], "rays": found["rays"]}
        times = {what: 1e3 * amount / rates[what + "_per_s"] for what, amount in amounts.items()}
        self.assertAlmostEqual(found["bound_ms"], max(times.values()))
        self.assertEqual(found["bound_by"], max(times, key=times.get))
        self.assertLess(found["bound_ms"], found["measured_ms"])
        self.assertLessEqual(found["bound_ms"], found["bound_in_full_ms"])
        self.assertIn(found["name"], self.shown)

    def test_figures(self):
        model = self.model("--kind", "cpu")
        plan = json.loads(self.succeeds("check", *SETTINGS, "--plan", "json").stdout)
        planned = [p for level in plan["levels"] for p in level["passes"]]
        self.assertEqual([p["name"] for p in model["passes"]], [p["name"] for p in planned])
        self.assertTrue(any(p["commands"] for p in planned))
        for found, expected in zip(model["passes"], planned):
            with self.subTest(name=found["name"]):
                self.check_pass(found, expected, model["rates"])
        passes = {p["name"]: p for p in model["passes"]}
        self.assertGreater(passes["tonemap"]["operations"], 64 * 64)
        self.assertGreater(passes["emit"]["rays"], 16)
        self.assertAlmostEqual(model["sum"]["bound_ms"], sum(p["bound_ms"] for p in model["passes"]))
        self.assertLess(model["sum"]["bound_ms"], model["frame"]["gpu_ms"])
        for what in ("bound", "measured"):
            queues = model["second_queue"][what]
            self.assertLess(0, queues["longest_chain_ms"])
            self.assertLessEqual(queues["longest_chain_ms"], queues["sum_ms"])
            self.assertAlmostEqual(queues["most_gain"], queues["sum_ms"] / queues["longest_chain_ms"])
        for word in ("leaves out caches", "second queue", "Ryzen"):
            self.assertIn(word, self.shown)

    def test_rates_of_ones_own(self):
        """The counts do not depend on them."""
        before, after = self.model(), self.model("--bandwidth", "0.001", "--flops", "2", "--ray-rate", "3")
        self.assertEqual((before["kind"]["name"], before["rates"]["bytes_per_s"]), ("headset", 67.2e9))
        self.assertEqual([after["rates"][name + "_per_s"] for name in ("bytes", "operations", "rays")], [1e6, 2e12, 3e9])
        self.assertIn("given as an option", self.shown)
        self.assertEqual([p["operations"] for p in before["passes"]], [p["operations"] for p in after["passes"]])
        tonemap = after["passes"][-1]
        self.assertEqual((tonemap["name"], tonemap["bound_by"]), ("tonemap", "bytes"))
        self.assertAlmostEqual(tonemap["bound_ms"], sum(tonemap["traffic"]["pictures"].values()) / 1e3)

    def test_mistakes(self):
        for options, code, says in (
                (["--kind", "toaster"], USAGE, ["toaster", "headset, laptop"]), (["--bandwidth", "0"], USAGE, ["--bandwidth"]),
                (["--flops=-1"], USAGE, ["--flops"]), (["--ray-rate", "nan"], USAGE, ["--ray-rate"]),
                (["--frames", "0"], USAGE, ["--frames"]), (["--device", "none such"], NO_DEVICE, ["none such"]),
                (["--set", "vpl_cout=3"], BAD_INPUT, ["vpl_count"]), (["--json", "no/where.json"], CANNOT_WRITE, ["no/where.json"])):
            with self.subTest(options=options):
                self.fails(code, *COMMON, *options, says=says)
        self.fails(BAD_INPUT, "bench", "model", "ir_100", "--scene", "cornellbox", says=["ir_100", "`ir_1000`"])
        self.fails(BAD_INPUT, "bench", "model", "direct", "--scene", "cornelbox", says=["cornelbox"])
        self.fails(USAGE, "bench", "model", "direct", "--scene", "cornellbox", "--size", "0x3", says=["0x3"])
        self.fails(USAGE, "bench", "model", "direct", says=["--scene", "fovea bench model --help"])
        self.fails(USAGE, "bench", says=["SUITE", "fovea bench --help"])


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]], verbosity=2)
