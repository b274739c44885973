"""Tests the report of `fovea bench` on results whose numbers are known. Usage: report_test.py PROGRAM SOURCE_DIR [CLASS...]

It is skipped without matplotlib; the exit code is then 77.
"""

import csv
import json
import re
import subprocess
import sys
import unittest

from program import BENCHMARKS, CliTest

PYTHON = "/usr/bin/python3"
if subprocess.run([PYTHON, "-c", "import matplotlib"], capture_output=True).returncode != 0:
    print("skipped: no matplotlib (apt: python3-matplotlib)")
    sys.exit(77)

sys.path.insert(0, str(BENCHMARKS))
sys.dont_write_bytecode = True
from suite_page.measures import MEASURES, NEITHER, badness  # noqa: E402

# Three methods and two seeds: warm-up, frame time in ms by seed, light, error. One seed of `slow` has compiled shaders in a
# measured frame.
METHODS = {"fast": (4, (10.0, 11.0), 1.02, 2e-3), "slow": (16, (100.0, 630.0), 0.6, 1e-3), "odd": (16, (50.0, 52.0), 1.3, 3e-3)}
PASSES = {"gbuffer": 0.1, "deferred": 0.7, "tonemap": 0.2}  # shares of the frame


def result(label, seed):
    warmup, walls, light, error = METHODS[label]
    wall = walls[seed - 1]
    return {"job": {"sweep": "all", "scene": "cornellbox", "graph": "direct", "label": label, "set": {"vpl_count": "64"},
                    "varied": {}, "size": [48, 32], "first": 20, "frames": 3, "warmup": warmup, "seed": seed,
                    "frame_rate": 42.0, "measures": ["time", "error"], "reference": {"spp": 16, "depth": 3}},
            "made_with": {"device": "a device"}, "version": "0.1.0", "commit": "c0ffee", "seconds": 1,
            "time": {"frame": {"wall_ms": {"median": wall, "min": wall, "p95": 5 * wall if (label, seed) == ("odd", 2) else wall}},
                     "passes": [{"name": name, "gpu_ms": {"median": share * wall}, "cpu_ms": {"median": 0.0}}
                                for name, share in PASSES.items()]},
            "error": {"light": light, "fovea": {"mse": error}}}


class Report(CliTest):
    def run_folder(self, name="out", factor=1.0):
        """A folder as `fovea bench` leaves it."""
        folder = self.folder / name
        (folder / "results").mkdir(parents=True)
        (folder / "tables").mkdir()
        rows, names = [], []
        for label, (_, walls, light, error) in METHODS.items():
            for seed in (1, 2):
                names.append(f"all-cornellbox-{label}-s{seed}.json")
                (folder / "results" / names[-1]).write_text(json.dumps(result(label, seed)))
            mean, half = sum(walls) / 2, 12.706 * abs(walls[0] - walls[1]) / 2
            values = {"error.fovea.mse": (factor * error, 1e-5), "error.light": (light, 0), "time.wall_ms": (mean, half),
                      **{f"pass.{p}.gpu_ms": (share * mean, share * half) for p, share in PASSES.items()}}
            rows += [{"scene": "cornellbox", "graph": label, "measure": m, "mean": v, "half_width": h, "seeds": 2, "paper": "",
                      "ratio": "", "bound": ""} for m, (v, h) in values.items()]
        with open(folder / "tables/all.csv", "w", newline="") as file:
            writer = csv.DictWriter(file, rows[0])
            writer.writeheader()
            writer.writerows(rows)
        (folder / "report.json").write_text(json.dumps({
            "suite": "known", "description": "known numbers", "command": "fovea bench", "jobs": 6, "results": names, "paper": False,
            "paper_scenes": {}, "missing_scenes": {}, "sweeps": [{"sweep": "all", "axes": []}]}))
        return folder

    def page(self, *arguments):
        folder = self.run_folder()
        run = subprocess.run([PYTHON, BENCHMARKS / "report.py", folder, *arguments], cwd=self.folder, capture_output=True, text=True,
                             timeout=240)
        self.assertEqual(run.returncode, 0, run.stderr)
        return folder, (folder / "report.html").read_text()

    def test_page(self):
        other = self.run_folder("other", factor=2)
        folder, page = self.page("--against", other)
        for text in ("4 frames to warm up (fast) and 16 frames to warm up (slow, odd)", "2 seeds", "vpl_count = 64",
                     "seed 2: a frame takes 630 ms, 6.3 times that of the fastest seed",
                     "odd, seed 2: the slowest frames take 260 ms, 5 times the median of 52 ms"):
            self.assertIn(text, page)
        self.assertNotIn("same for every graph", page)
        # The light that is closest to 1 is the best, not the least.
        self.assertIn("close to 1 is better", page)
        self.assertIn("<span class=best>1.02</span>", page)
        self.assertNotIn("<span class=best>0.6</span>", page)
        # Means with their intervals, and the sum of the passes is the frame.
        cells = re.search(r"<td>deferred</td>(.*?)</tr>", page)[1]
        found = re.findall(r"<td>([\d.]+)<small> ± ([\d.]+)</small>", cells)
        for (mean, half), (_, walls, _, _) in zip(found, METHODS.values(), strict=True):
            self.assertAlmostEqual(float(mean), 0.7 * sum(walls) / 2, delta=0.005 * float(mean))
            self.assertAlmostEqual(float(half), 0.7 * 12.706 * abs(walls[0] - walls[1]) / 2, delta=0.05 * float(half))
        self.assertEqual(re.findall(r"<b>([\d.]+)</b>", re.search(r"<b>all</b></td>(.*?)</tr>", page)[1]), ["10.5", "365", "51"])
        order = [page.index(f"<td>{name}</td>") for name in ("deferred", "tonemap", "gbuffer")]
        self.assertEqual(order, sorted(order))
        # Against a run with twice the errors.
        self.assertEqual(page.count(">better</td>"), 3)
        self.assertEqual(page.count(">worse</td>"), 0)
        self.assertIn("-50.0%", page)
        for name in ("all-error.fovea.mse", "all-error.light", "all-time.wall_ms", "all-passes"):
            for ending, start in (("png", b"\x89PNG"), ("svg", b"<?xml"), ("pdf", b"%PDF")):
                self.assertTrue((folder / f"plots/{name}.{ending}").read_bytes().startswith(start), (name, ending))
        latex = (folder / "tables/all.tex").read_text()
        self.assertIn(r"cornellbox & fast & $2 \pm 0.01$ & $\mathbf{1.02}$ & $\mathbf{10.5 \pm 6.35}$ \\", latex)

    def test_legends_cover_nothing(self):
        """They stand beside the axes in every plot."""
        folder = self.run_folder()
        script = ("import csv, sys; sys.dont_write_bytecode = True; sys.path.insert(0, sys.argv[1]); import matplotlib; "
                  "matplotlib.use('Agg'); from suite_page import plots; plt = plots.plt\n"
                  "rows = list(csv.DictReader(open(sys.argv[2])))\n"
                  "for draw in (lambda: plots.bars(rows, 'error.fovea.mse'), lambda: plots.stacked({'a': {'p': 1}, 'b': {'q': 2}}),\n"
                  "             lambda: plots.lines('seeds', float, rows, 'error.light'), lambda: plots.over_time([], rows, 'error.fovea.mse')):\n"
                  "    draw(); figure = plt.gcf(); figure.canvas.draw()\n"
                  "    for place in figure.axes:\n"
                  "        legend = place.get_legend()\n"
                  "        if legend: assert not any(legend.get_window_extent().overlaps(a.get_window_extent()) for a in figure.axes), draw\n"
                  "    assert any(a.get_legend() for a in figure.axes)\n"
                  "    plt.close()\n")
        run = subprocess.run([PYTHON, "-c", script, BENCHMARKS, folder / "tables/all.csv"], capture_output=True, text=True, timeout=120)
        self.assertEqual(run.returncode, 0, run.stderr)

    def test_every_measure_says_which_way_is_better(self):
        for name, measure in MEASURES.items():
            self.assertTrue(measure.better and measure.text, name)
            self.assertEqual(badness(name, {"mean": "2"}, {name.replace("mse_prime", "reference_mse_prime"): 1.0}) is None,
                             measure.better == NEITHER, name)
        self.assertLess(badness("error.light", {"mean": "0.9"}, {}), badness("error.light", {"mean": "0.5"}, {}))
        self.assertEqual(badness("error.light", {"mean": "0.5"}, {}), badness("error.light", {"mean": "2"}, {}))
        self.assertLess(badness("speed_up.ir_1000", {"mean": "3"}, {}), badness("speed_up.ir_1000", {"mean": "2"}, {}))


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]], verbosity=2)
