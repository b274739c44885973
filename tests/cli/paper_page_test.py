"""Tests the page of benchmarks/paper.py from made-up results. Usage: paper_page_test.py PROGRAM SOURCE_DIR [CLASS...]

They are skipped without matplotlib; the exit code is then 77.
"""

import json
import re
import sys
import unittest

try:
    import matplotlib  # noqa: F401
    import numpy
    from PIL import Image
except ImportError as error:
    print(f"skipped: {error}")
    sys.exit(77)

from program import BENCHMARKS, ToolTest

sys.path.insert(0, str(BENCHMARKS))
sys.dont_write_bytecode = True
from page import motion, panels  # noqa: E402
from page.fit import fitted  # noqa: E402
from page.results import mean_of  # noqa: E402
from page.readings import CHOICE_TEXTS  # noqa: E402
from page.sweeps import (CHOICES, COSINE_SEQUENCES, COSINE_STILLS, COUNTS, MAPS, PARAMETERS, RADII,  # noqa: E402
                         REUSE, SCALED, SECOND_EYE, SEQUENCES, SPEED, STILLS, TIMES, UNCLAMPED)
from page.text import anchor, short  # noqa: E402
from page.verdict import FAILS, HOLDS, MISSING, UNDECIDED, claim, is_at_least, is_less  # noqa: E402

METHODS = ("ir_1000", "ir_v", "ours_r", "ours")
TITLES = ["Table 1", "Table 2", "Figure 1", *(f"Figure {i}" for i in range(3, 11)), "Prose",
          "The size of the scenes, and a baseline that differs in its VPLs alone", "Reuse by importance and at random",
          "What each choice costs that the text leaves open"]


def error(mse, light=1.0):
    region = {"mse": mse, "flip": 10 * mse, "indirect_mse": mse / 2, "scaled_indirect_mse": mse / 4,
              "direct_floor": mse / 10}
    return {"fovea": region, "periphery": region, "indirect_light": light, "disc": [16, 16, 8]}


def temporal(change, reference=0.0):
    region = {"mse_prime": change, "excess": change / 2, "indirect_excess": change / 4,
              "reference_mse_prime": reference, "excess_noise_floor": reference}
    return {"fovea": region, "periphery": region}


def time(ms, passes=(), **more):
    spread = lambda value: {"median": value}
    return {"frame": {"wall_ms": spread(ms)}, "counters": {}, **more, "passes": [
        {"name": name, "gpu_ms": spread(value), "cpu_ms": spread(0)} for name, value in dict(passes).items()]}


class PaperPageDecisions(unittest.TestCase):
    def test_less_of_one_seed(self):
        self.assertIs(is_less({1: 2.0}, {1: 3.0}), True)
        self.assertIs(is_less({1: 3.0}, {1: 2.0}), False)
        self.assertIs(is_less({1: 2.0}, {1: 3.0}, factor=0.5), False)

    def test_seeds_decide_in_pairs(self):
        """What the seeds have in common cancels out; what remains is compared with its interval."""
        self.assertIs(is_less({1: 1.0, 2: 5.0, 3: 9.0}, {1: 1.1, 2: 5.1, 3: 9.11}), True)
        self.assertIs(is_less({1: 1.1, 2: 5.1, 3: 9.11}, {1: 1.0, 2: 5.0, 3: 9.0}), False)
        self.assertIsNone(is_less({1: 1.0, 2: 5.0, 3: 9.0}, {1: 2.0, 2: 4.0, 3: 9.5}))
        with self.assertRaises(ValueError):
            is_less({1: 1.0}, {2: 1.0})

    def test_at_least(self):
        self.assertIs(is_at_least({1: 3.0}, 2.5), True)
        self.assertIs(is_at_least({1: 2.0}, 2.5), False)
        self.assertIsNone(is_at_least({1: 2.0, 2: 3.1}, 2.5))

    def test_intervals(self):
        mean, half = mean_of([1.0, 2.0, 3.0])
        self.assertEqual(mean, 2)
        self.assertAlmostEqual(half, 4.303 / 3 ** 0.5)
        self.assertNotEqual(mean_of([1.0])[1], mean_of([1.0])[1])  # unknown

    def test_sentences(self):
        made = claim("It is so", {"a": True, "b": True})
        self.assertEqual((made.verdict, made.sentence), (HOLDS, "It is so. **Holds here**: it holds in `a` and `b`."))
        made = claim("It is so", {"a": True, "b": False, "c": None}, "1 and 2", lambda scene: f"Why in {scene}.")
        self.assertEqual(made.verdict, FAILS)
        self.assertEqual(made.sentence, "It is so. **Does not hold here**: it holds in `a`; it does not in `b`; the "
                                        "measurements leave it open in `c` (1 and 2). Why in b.")
        self.assertEqual(claim("It is so", {"a": True, "c": None}).verdict, UNDECIDED)
        self.assertEqual(claim("It is so", {}).verdict, MISSING)

    def test_numbers(self):
        self.assertEqual([short(v) for v in (None, 0, 0.0123, 2.5, 1234.5, 0.00001234)],
                         ["-", "0", "0.0123", "2.5", "1234", "1.2e-05"])
        self.assertEqual(anchor("Figure 5: a, b and c"), "#figure-5-a-b-and-c")


class PaperPageBias(unittest.TestCase):
    COUNTS = (250, 500, 1000, 2000, 4000)

    def test_known_parts_are_found(self):
        for bias, variance in ((0.002, 1.5), (0.01, 0.25), (0.003, 0.0), (0.0, 2.0)):
            fit = fitted([(n, bias + variance / n) for n in self.COUNTS])
            self.assertAlmostEqual(fit.bias, bias, places=9)
            self.assertAlmostEqual(fit.variance, variance, places=6)
            self.assertAlmostEqual(fit.share(1000), bias / (bias + variance / 1000), places=6)

    def test_no_part_is_negative(self):
        falls_faster = fitted([(n, 1 / n ** 2) for n in self.COUNTS])
        self.assertEqual(falls_faster.bias, 0)
        self.assertGreater(falls_faster.variance, 0)
        rises = fitted([(n, 1 + n / 1000) for n in self.COUNTS])
        self.assertEqual(rises.variance, 0)
        self.assertGreater(rises.bias, 0)

    def test_number_for_an_error(self):
        fit = fitted([(n, 0.002 + 1.5 / n) for n in self.COUNTS])
        self.assertAlmostEqual(fit.count_for(0.0026), 2500, places=3)
        self.assertIsNone(fit.count_for(0.002 - 1e-9))

    def test_what_cannot_be_fitted(self):
        self.assertIsNone(fitted([]))
        self.assertIsNone(fitted([(1000, 0.1), (1000, 0.2)]))
        self.assertIsNone(fitted([(250, 0.1), (1000, -0.001)]))


class PaperPageMotion(unittest.TestCase):
    def test_a_thing_that_crosses_the_picture(self):
        """It moves by half the width of a view of 90 degrees in a second."""
        scene = {"camera": {"fov_deg": 90, "path": [{"t": 0, "eye": [0, 0, 4], "target": [0, 0, 0]}]},
                 "movers": [{"keys": [{"t": 0, "translation": [0, 0, 0]}, {"t": 1, "translation": [4, 0, 0]}]}]}
        for time_, x in ((0, 0), (0.5, 256), (1, 512)):
            self.assertAlmostEqual(motion.projected(scene, time_, 1024)[0], x)

    def test_the_plane_in_sponza(self):
        """The sequences have speeds within those of the paper's claim, and others."""
        suite = json.loads((BENCHMARKS / "suites/paper.json").read_text())
        sweep = next(s for s in suite["sweeps"] if s["name"] == SPEED)
        speeds = [42 * motion.pixels_per_frame("sponza_plane", rate, 40, sweep["frames"], 1024)
                  for rate in sweep["frame_rate"]]
        self.assertTrue(any(100 <= s <= 150 for s in speeds), speeds)
        self.assertTrue(any(s > 200 for s in speeds), speeds)
        self.assertTrue(100 <= speeds[len(speeds) // 2] <= 150, speeds)  # the one that smaller scales keep, too
        self.assertIsNone(motion.pixels_per_frame("no_such_scene", 42, 40, 16, 1024))


class PaperPagePage(ToolTest):
    script = "paper.py"

    def setUp(self):
        super().setUp()
        self.names = []
        for name in ("results", "pictures"):
            (self.folder / name).mkdir()

    def result(self, sweep, scene, graph, seed=1, varied=None, commit="abc", kinds=(), **numbers):
        varied = {k: str(v) for k, v in (varied or {}).items()}
        job = {"sweep": sweep, "scene": scene, "graph": graph, "label": graph, "set": varied, "varied": varied,
               "size": [32, 32], "first": 40, "frames": 16, "warmup": 8, "seed": seed, "frame_rate": 42.0,
               "measures": ["time", *(["pictures"] if kinds else [])], "reference": {"spp": 4, "depth": 4}}
        if "frame_rate" in varied:
            job["frame_rate"] = float(varied["frame_rate"])
        name = panels.name_of(job)
        self.names.append(f"{name}.json")
        (self.folder / "results" / self.names[-1]).write_text(json.dumps(
            {"job": job, "made_with": {"device": "a device"}, "version": "1", "commit": commit, **numbers}))
        for kind in kinds:
            pixels = numpy.random.default_rng(1).integers(0, 255, (32, 32, 3), dtype=numpy.uint8)
            Image.fromarray(pixels).save(self.folder / "pictures" / f"{name}{kind}.png")

    def page(self, **head):
        (self.folder / "report.json").write_text(json.dumps(
            {"suite": "paper", "command": "fovea bench paper -o DIR", "jobs": 200, "missing_scenes": {},
             "paper_scenes": {}, "results": self.names, **head}))
        self.succeeds(self.folder)
        return (self.folder / "paper" / "README.md").read_text()

    def sentence(self, page, start):
        found = [line for line in page.split("\n") if line.startswith(f"- {start}")]
        self.assertEqual(len(found), 1, f"{start}: {found}")
        return found[0]

    def stills(self, ours=1.0, **more):
        for scene in ("cornellbox_moving", "sponza_plane"):
            for graph, mse in zip(METHODS, (2e-3, 3e-3, 1.5e-3, ours * 1e-3)):
                self.result(STILLS, scene, graph, error=error(mse), kinds=("", "-reference", "-error"), **more)

    def counts(self, ours, instant):
        """The sweep over the number of VPLs, from (bias, variance) of each."""
        for graph, (bias, variance) in (("ours", ours), ("ir_1000", instant)):
            for count in (250, 500, 1000, 2000, 4000):
                self.result(COUNTS, "sponza_plane", graph, varied={"vpl_count": count},
                            error=error(bias + variance / count), temporal=temporal(1 / count))

    def test_one_result_is_enough_for_every_entry(self):
        self.result(SPEED, "sponza_plane", "ours", varied={"frame_rate": 84}, temporal=temporal(1e-5))
        page = self.page()
        self.assertEqual([h.split(":")[0] for h in re.findall(r"^## (.*)$", page, re.M)], TITLES)
        self.assertGreater(page.count(MISSING), 25)
        for title in re.findall(r"\]\((#[^)]+)\)", page):
            self.assertIn(title, [anchor(h) for h in re.findall(r"^## (.*)$", page, re.M)])

    def test_verdicts_follow_the_numbers(self):
        start = "In the fovea, Ours has less error than instant radiosity"
        for factor, verdict in ((1, "**Holds here**"), (2.5, "**Does not hold here**")):
            self.names.clear()
            self.stills(ours=factor)
            page = self.page()
            self.assertIn(verdict, self.sentence(page, start))
            self.assertIn(verdict, self.sentence(page, "In the fovea of this picture"))
            self.assertIn(verdict, self.sentence(page, "In the fovea, Ours differs visibly less"))
            self.assertRegex(page, r"\| `sponza_plane` \| Sponza \| 2 \(3\.16\) \| 3 \(7\.63\) \| 1\.5 \(2\.5\) \| "
                             rf"{factor:g} \(1\.09\) \| ")
            summary = page[:page.index("## Table 1")]
            heading = "Hold in every scene" if factor == 1 else "Do not hold in every scene"
            self.assertRegex(summary, rf"{heading} \(\d+\):\n\n(- .*\n)*- \[Table 1\][^\n]*{start}")
        self.assertRegex(summary, r"Of \d+ claims, \*\*\d+ do not hold in every scene, \d+ hold in all\*\*")

    def test_counts_of_the_summary_are_those_of_the_sentences(self):
        self.stills()
        page = self.page()
        headings = "Hold in every scene|Do not hold in every scene|Not measured yet"
        counts = dict(re.findall(rf"^({headings}) \((\d+)\):$", page, re.M))
        for heading, text in (("Hold in every scene", "**Holds here**"),
                              ("Do not hold in every scene", "**Does not hold here**"),
                              ("Not measured yet", f": {MISSING}.\n")):
            self.assertEqual(int(counts.get(heading, 0)), page.count(text), heading)

    def test_seeds_give_intervals_and_may_leave_it_open(self):
        for seed, mse in enumerate((1e-3, 4e-3, 1e-3), 1):
            self.result(STILLS, "sponza_plane", "ours", seed, error=error(mse))
            for graph in METHODS[:3]:
                self.result(STILLS, "sponza_plane", graph, seed, error=error(2.1e-3))
        page = self.page()
        self.assertIn("**Undecided**", self.sentence(page, "In the fovea, Ours has less error than instant radiosity"))
        self.assertIn("2 ± 4.3 (1.09)", page)
        self.assertIn("3 seeds", page)

    def test_bias(self):
        """The shares of the fit, N of IR_eq, and why an error is not lower."""
        self.stills(ours=2.5)
        self.counts((0.003, 1.0), (0.001, 6.0))
        page = self.page()
        self.assertRegex(page, r"\| `sponza_plane` \| `ir_1000` \| 1 \| 6 \| 14% \|")
        self.assertRegex(page, r"\| `sponza_plane` \| `ours` \| 3 \| 1 \| 75% \|")
        self.assertIn("75% of the error of `ours` with 1000 VPLs is bias",
                      self.sentence(page, "In the fovea, Ours has less error than instant radiosity"))
        self.result(TIMES, "sponza_plane", "ours", time=time(10))
        self.assertIn("| 2000 |", self.page())  # 0.001 + 6 / N = 0.003 + 1 / 1000
        self.names.clear()
        self.result(TIMES, "sponza_plane", "ours", time=time(10))
        self.counts((0.003, 1.0), (0.0041, 6.0))
        self.assertIn("undefined, as the bias alone exceeds the error of `ours`", self.page())

    def test_times(self):
        """Speed-ups with the bounds of a search, the second eye, the steps of a frame, and maps that are kept."""
        match = {"value": 8000, "reached": False, "steps": [{}, {}]}
        passes = {"voxelize": 1, "candidates": 1, "manage": 0.5, "shadow-atlas": 1, "deferred": 2}
        for faster, verdict in ((4, "**Holds here**"), (2, "**Does not hold here**")):
            self.names.clear()
            self.result(TIMES, "room", "ours", time=time(10, passes))
            self.result(TIMES, "room", "ir_1000", time=time(10 * faster, {"emit": 1, "shadow-atlas": 9}))
            self.result(TIMES, "room", "ir_eq", time=time(300), match=match)
            self.result(SECOND_EYE, "room", "stereo",
                        time=time(15, second_eye={"ms": 5, "of_first": 0.3 * 3 / faster, "new_pixels": 0.3 / faster}))
            self.result(TIMES, "room", "ours_all_maps", time=time(10, {**passes, "shadow-atlas": 2.4 * faster}))
            page = self.page()
            self.assertIn(verdict, self.sentence(page, "Ours is at least 3 times as fast"))
            self.assertIn(verdict, self.sentence(page, "At most 9%") if faster == 2 else verdict)
            self.assertIn("**Holds here**", self.sentence(page, "Generating VPLs"))
            saved = self.sentence(page, "Keeping maps")
            self.assertIn("89.6%" if faster == 4 else "79.2%", saved)
            self.assertIn(verdict, saved)
            self.assertRegex(page, rf"\| `room` \| Room \| 10 \(26\) \| {faster} \(3\) \| &gt; 8000 \(3000\) \| "
                             r"not measured yet \| &gt; 30 \(13\)")
        # As the least number of VPLs was enough, it is not known how much faster Ours would be with fewer.
        self.names.clear()
        self.result(TIMES, "room", "ours", time=time(10))
        self.result(TIMES, "room", "ir_eq", time=time(300), match={"value": 250, "reached": True, "steps": [{}]})
        page = self.page()
        self.assertIn("**Undecided**", self.sentence(page, "Ours is at least 10 times as fast"))
        self.assertIn("**Does not hold here**", self.sentence(page, "Instant radiosity needs at least 2400 VPLs"))
        self.assertIn("&lt; 250 (3000)", page)
        self.names.clear()
        self.result(TIMES, "room", "ours", time=time(10, {**passes, "light-inject": 30}))
        self.result(TIMES, "room", "ir_1000", time=time(40, {"emit": 1}))
        self.assertIn("of that time are voxels and their light", self.sentence(self.page(), "Generating VPLs"))

    def test_flicker(self):
        """A claim that fails is given the motion of the scene and the noise of the reference as reasons."""
        for graph in METHODS[:3]:
            self.result(SEQUENCES, "room", graph, temporal=temporal(1e-3, 8e-4))
        self.result(SEQUENCES, "room", "ours", temporal=temporal(2e-3, 1.6e-3))
        page = self.page()
        self.assertIn("is 80% of that of `ours`", self.sentence(page, "In the fovea, Ours changes less"))
        self.assertIn("is 160% of the excess of `ours`", self.sentence(page, "In the fovea, Ours flickers less"))

    def test_the_moving_plane(self):
        start = "In the fovea, MSE' stays below"
        for change, reference, verdict in ((5e-5, 1e-5, "**Holds here**"), (9e-5, 1e-5, "**Does not hold here**"),
                                           (9e-5, 8e-5, "so no method can hold it")):
            self.names.clear()
            for rate in (84, 21):  # the second is faster than the paper's
                self.result(SPEED, "sponza_plane", "ours", varied={"frame_rate": rate},
                            temporal=temporal(change if rate == 84 else 1, reference))
            sentence = self.sentence(self.page(), start)
            self.assertIn(verdict, sentence)
            self.assertEqual("no method" in sentence, reference > 6e-5)

    def test_enlarged_scenes(self):
        """Bias at that size, and ratios to both baselines; the light of one of them is scaled first."""
        setting = {"clamp_distance": 0.1875, "vpl_count": 250}
        for count, instant in ((250, 7e-3), (1000, 4e-3)):  # b = 3e-3, v = 1
            setting["vpl_count"] = count
            self.result(SCALED, "room", "ir_1000", varied=setting, error=error(instant))
            self.result(SCALED, "room", "ir_same", varied=setting, error=error(3e-3))
            self.result(SCALED, "room", "ours", varied=setting, error=error(1e-3 if count == 1000 else 1))
        self.result(STILLS, "room", "ours", error=error(3e-3))
        self.result(STILLS, "room", "ir_1000", error=error(4e-3))
        self.result(STILLS, "room", "ir_same", error=error(5e-3))
        page = self.page()
        self.assertIn("1.5 m in one 8 times as large", page)
        self.assertIn("| `room` | - | 75% | 0.75 | 0.25 | 1.2 | 0.667 |", page)
        self.assertRegex(self.sentence(page, "In enlarged scenes"), r"Holds here.*0\.25 on the mean of 1 scene\b")
        self.assertRegex(self.sentence(page, "In the fovea, Ours has less error of the indirect light than the same"),
                         r"Does not hold here.*1\.2 on the mean of 1 scene\b")

    def test_reuse_at_random(self):
        for random, verdict in ((2e-3, "**Holds here**"), (0.5e-3, "**Does not hold here**")):
            self.names.clear()
            self.result(REUSE, "room", "ours", temporal=temporal(1e-3))
            self.result(REUSE, "room", "ours_r", temporal=temporal(random))
            page = self.page()
            self.assertIn(f"| `room` | 0.25 | {short(250 * random)} |", page)
            self.assertIn(verdict, self.sentence(page, "With one area for all VPLs"))

    def test_choices(self):
        """Every label of the sweep has a row."""
        suite = json.loads((BENCHMARKS / "suites/paper.json").read_text())
        sweep = next(s for s in suite["sweeps"] if s["name"] == CHOICES)
        labels = [g if isinstance(g, str) else g.get("label", g["graph"]) for g in sweep["graphs"]]
        self.assertEqual(labels, ["ours", *CHOICE_TEXTS])
        for factor, label in enumerate(labels, 1):
            self.result(CHOICES, "room", label, error=error(1e-3 * factor, light=1 / factor))
        page = self.page()
        for factor, text in enumerate(CHOICE_TEXTS.values(), 2):
            self.assertIn(f"| {text} | {factor} ({short(1 / factor)}) |", page)

    def test_every_picture_is_linked_and_the_folder_is_small(self):
        self.stills()
        kinds = ("", "-reference", "-error")
        for graph in METHODS:
            self.result(SEQUENCES, "sponza_plane", graph, temporal=temporal(1e-3), kinds=("", "-temporal"))
        for count in (250, 4000):
            for radius in (0.15, 0.35):
                self.result(PARAMETERS, "sponza_plane", "ours", kinds=kinds, error=error(1 / count),
                            varied={"vpl_count": count, "view.fovea_radius": radius})
        self.result(COSINE_STILLS, "sponza_plane", "ours_cosine", error=error(9e-3), kinds=kinds)
        self.result(COSINE_SEQUENCES, "sponza_plane", "ours_cosine", temporal=temporal(9e-3))
        for graph in ("ours_unclamped", "ir_1000_unclamped"):
            self.result(UNCLAMPED, "sponza_plane", graph, error=error(1e-4), kinds=kinds)
        for sweep, axis, values in ((MAPS, "map_size", (32, 128)), (RADII, "view.fovea_radius", (0.15, 0.35))):
            for value in values:
                self.result(sweep, "sponza_plane", "ours", varied={axis: value}, error=error(1e-3 * float(value)),
                            temporal=temporal(1e-3))
        self.counts((0.001, 1.0), (0.002, 6.0))
        self.result(TIMES, "sponza_plane", "ours", time=time(10, {"shadow-atlas": 1}))
        page = self.page(scale="small")
        linked = re.findall(r"!\[[^\]]*\]\(([^)]+)\)", page)
        self.assertEqual(sorted(linked), sorted(p.name for p in (self.folder / "paper").glob("*.png")))
        self.assertEqual({name.split("-")[0].split(".")[0] for name in linked},
                         {f"figure{i}" for i in (1, 3, 4, 5, 6, 7, 8, 9, 10)})
        self.assertLess(sum(p.stat().st_size for p in (self.folder / "paper").iterdir()), 2e6)
        self.assertIn("Scale: `small`", page)
        for start, verdict in (("More VPLs lower the error", "**Holds here**"),
                               ("Larger maps lower the error", "**Does not hold here**"),
                               ("A smaller fovea has less error", "**Holds here**"),
                               ("In the fovea, the linear rule has less error", "**Holds here**"),
                               ("In the fovea, the clamp makes the error of Ours less", "**Does not hold here**"),
                               ("With more VPLs, the error in the fovea is less", "**Holds here**")):
            self.assertIn(verdict, self.sentence(page, start))

    def test_results_of_several_commits(self):
        self.stills()
        self.assertNotIn("Warning", self.page())
        self.result(SEQUENCES, "sponza_plane", "ours", commit="def", temporal=temporal(1e-3))
        page = self.page(missing_scenes={"yard": "no file"})
        self.assertIn("these results come from 2 commits", page[:page.index("## Table 1")])
        self.assertIn("The scene `yard` is left out:** no file", page)


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]], verbosity=2)
