#!/usr/bin/env python3
"""The paper's Table 1: errors of each method in fovea and periphery against path-traced references, and its flicker.

Usage: benchmarks/table1.py [--scenes A,B] [--graphs A,B] [--size WxH] [--first N] [--frames N] [--warmup N] [--seeds N]
       [--spp N] [--depth N] [--radius R] [--set NAME=VALUE ...] [--work FOLDER] [--json FILE] [--build FOLDER]

For every scene: the frames FIRST..FIRST+FRAMES-1 path-traced once (graph `reference`; its noise is measured from its halves and
subtracted), and rendered by every graph with every seed after WARMUP frames before them. Printed are, as mean and 95% interval over
the seeds (Student's t), all but relMSE times 1000:

  MSE      of what a screen shows, sRGB(clamp(exposure x radiance))
  MSE'     between consecutive frames (the paper's Eq. 4); it rewards light that is frozen
  excess   mean square of the difference between the sequence's changes and the reference's
  relMSE   of the indirect radiance of the last frame

The paper's means stand below them (other models of the scenes, a camera path of its own, 1024x1024, an RTX 2080 Ti). Then: whether the
foveal MSE of `ours` is below that of `ours_r` and `ir_1000`, from differences by seed.

The full run (days on 2 cores, most of it for the references, which --work keeps for the next time):
  benchmarks/table1.py --size 1024x1024 --frames 10 --seeds 5 --spp 2000 --work table1 --json benchmarks/results/table1.json
One of minutes, to see that all works:
  benchmarks/table1.py --size 96x96 --frames 3 --warmup 4 --seeds 3 --spp 64 --set map_size=32

Exit code 0 when everything was measured, 2 when something could not be rendered or compared.
"""
import argparse
import json
import math
import pathlib
import shutil
import statistics
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent
# The paper's Table 1, times 1000: MSE fovea, MSE periphery, MSE' fovea, MSE' periphery.
PAPER = {
    "sponza": {"ir_1000": (3.16, 4.84, 0.06, 0.74), "ir_v": (7.63, 6.28, 0.20, 1.10),
               "ours_r": (2.50, 4.65, 0.18, 1.50), "ours": (1.09, 3.89, 0.04, 0.83)},
    "cornellbox": {"ir_1000": (1.61, 1.59, 0.14, 0.24), "ir_v": (2.47, 3.36, 0.08, 0.24),
                   "ours_r": (0.92, 2.07, 0.14, 0.21), "ours": (0.74, 1.12, 0.04, 0.14)},
}
# 97.5% points of Student's t for 1, 2, .. degrees of freedom.
STUDENT = (12.706, 4.303, 3.182, 2.776, 2.571, 2.447, 2.365, 2.306, 2.262, 2.228, 2.201, 2.179, 2.160, 2.145, 2.131)
MEASURES = (("mse", "MSE"), ("mse_prime", "MSE'"), ("excess", "excess"), ("relmse", "relMSE"))
REGIONS = ("fovea", "periphery")


def interval(values):
    """Mean and half width of its 95% interval; None where one value says nothing about the spread."""
    if None in values:  # a region without pixels
        return {"mean": None, "half_width": None, "values": values}
    mean = statistics.fmean(values)
    if len(values) < 2:
        return {"mean": mean, "half_width": None, "values": values}
    t = STUDENT[len(values) - 2] if len(values) - 2 < len(STUDENT) else 1.96 + 2.5 / (len(values) - 1)
    return {"mean": mean, "half_width": t * statistics.stdev(values) / math.sqrt(len(values)), "values": values}


class Bench:
    def __init__(self, arguments, work):
        self.a, self.work = arguments, work
        self.program = str(pathlib.Path(arguments.build) / "bin" / "fovea")

    def call(self, *arguments):
        run = subprocess.run([self.program, *map(str, arguments)], stdout=subprocess.PIPE, text=True)
        if run.returncode != 0:
            print(f"failed ({run.returncode}): fovea {' '.join(map(str, arguments))}", file=sys.stderr)
            sys.exit(2)
        return run.stdout

    def render(self, graph, scene, folder, warmup, *more):
        """Frames as folder/NNNN.exr, whatever came before them."""
        folder.mkdir(parents=True)
        self.call("render", graph, "--scene", scene, "--size", self.a.size, "--first", self.a.first - warmup, "--warmup", warmup,
                  "--frames", self.a.frames, "-o", folder / "%04d.exr", *more)

    def reference(self, scene):
        """Rendered once; kept as long as the work folder."""
        a = self.a
        key = f"{pathlib.Path(scene).stem}-{a.size}-{a.first}-{a.frames}-{a.spp}-{a.depth}"
        folder, partial = self.work / ("reference-" + key), self.work / ("partial-" + key)
        if not folder.exists():
            shutil.rmtree(partial, ignore_errors=True)
            self.render("reference", scene, partial, 0, "--set", f"spp={a.spp}", "--set", f"depth={a.depth}", "--seed", 4711)
            partial.rename(folder)
        return folder

    def measure(self, scene, graph, seed, reference):
        folder = self.work / "frames"
        shutil.rmtree(folder, ignore_errors=True)
        overrides = [word for text in self.a.set for word in ("--set", text)]
        self.render(graph, scene, folder, min(self.a.warmup, self.a.first), "--seed", seed, "--quiet", *overrides)
        last = f"{self.a.first + self.a.frames - 1:04d}.exr"
        common = ("--radius", self.a.radius, "--json")
        sequence = json.loads(self.call("compare-sequence", folder, reference, *common))
        picture = json.loads(self.call("compare", folder / last, reference / last, "--layer", "indirect", *common))
        shutil.rmtree(folder)
        return {region: {**sequence[region], "relmse": picture[region]["relmse"]} for region in REGIONS}

    def scene(self, scene):
        reference = self.reference(scene)
        graphs = {}
        for graph in self.a.graphs.split(","):
            runs = [self.measure(scene, graph, seed, reference) for seed in range(1, self.a.seeds + 1)]
            graphs[graph] = {region: {key: interval([run[region][key] for run in runs]) for key, _ in MEASURES}
                             for region in REGIONS}
        floors = {region: {key: runs[0][region][key] for key in ("noise_floor", "reference_mse_prime", "excess_noise_floor")}
                  for region in REGIONS}
        return {"graphs": graphs, "reference": floors, "order": order(graphs)}


def order(graphs):
    """Differences of the foveal MSE from that of `ours`, by seed."""
    found = {}
    for other in ("ours_r", "ir_1000"):
        if "ours" in graphs and other in graphs and graphs["ours"]["fovea"]["mse"]["mean"] is not None:
            ours, theirs = (graphs[g]["fovea"]["mse"]["values"] for g in ("ours", other))
            d = interval([b - a for a, b in zip(ours, theirs)])
            known = d["half_width"] is not None
            verdict = "undecided" if not known or abs(d["mean"]) <= d["half_width"] else "yes" if d["mean"] > 0 else "no"
            found[other] = {"less": verdict, **d}
    return found


def text_of(cell, scale):
    if cell["mean"] is None:
        return "-"
    digits = 4 if scale == 1 else 2
    spread = "" if cell["half_width"] is None else f" ±{scale * cell['half_width']:.{digits}f}"
    return f"{scale * cell['mean']:.{digits}f}{spread}"


def table(scene, result):
    head = [f"{name} {region}" for name in dict(MEASURES).values() for region in REGIONS]
    print(f"\n{scene}\n{'':16}" + "".join(f"{h:>18}" for h in head))
    for graph, regions in result["graphs"].items():
        cells = [text_of(regions[region][key], 1 if key == "relmse" else 1000) for key, _ in MEASURES for region in REGIONS]
        print(f"{graph:16}" + "".join(f"{c:>18}" for c in cells))
    for name, rows in PAPER.items():
        if pathlib.Path(scene).stem.startswith(name):
            for graph in (g for g in result["graphs"] if g in rows):
                print(f"{graph + ', paper':16}" + "".join(f"{v:>18.2f}" for v in rows[graph]))
    floors = result["reference"]
    thousandths = lambda key: ", ".join(f"{1000 * (floors[r][key] or 0):.3f} {r}" for r in REGIONS)
    print(f"reference: noise {thousandths('noise_floor')}; its MSE' {thousandths('reference_mse_prime')} (less its noise)")
    for other, d in result["order"].items():
        print(f"foveal MSE of ours < {other}: {d['less']} (difference {text_of(d, 1000)})")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--build", default=str(ROOT / "build" / "release"))
    parser.add_argument("--scenes", default="cornellbox_moving,sponza_plane", help="default: %(default)s, which move")
    parser.add_argument("--graphs", default="ir_1000,ir_v,ours_r,ours")
    parser.add_argument("--size", default="1024x1024")
    parser.add_argument("--first", type=int, default=40, help="number of the first frame that counts; default %(default)s")
    parser.add_argument("--frames", type=int, default=10, help="consecutive frames that count; default %(default)s")
    parser.add_argument("--warmup", type=int, default=40, help="frames before them; default %(default)s, at most --first")
    parser.add_argument("--seeds", type=int, default=5)
    parser.add_argument("--spp", type=int, default=2000, help="samples a pixel of the reference; default %(default)s")
    parser.add_argument("--depth", type=int, default=4, help="path depth of the reference; default %(default)s")
    parser.add_argument("--radius", type=float, default=0.25, help="of the fovea, image widths; default %(default)s")
    parser.add_argument("--set", action="append", default=[], metavar="NAME=VALUE", help="for every graph; may be repeated")
    parser.add_argument("--work", help="folder that keeps the references; default: a temporary one")
    parser.add_argument("--json", help="write what was measured")
    arguments = parser.parse_args()
    if arguments.frames < 2 or arguments.seeds < 1:
        parser.error("--frames from 2, --seeds from 1")
    results = {}
    with tempfile.TemporaryDirectory() as temporary:
        bench = Bench(arguments, pathlib.Path(arguments.work or temporary).resolve())
        for scene in arguments.scenes.split(","):
            results[scene] = bench.scene(scene)
            table(scene, results[scene])
            if arguments.json:  # after each, in case the next is interrupted
                options = {k: v for k, v in vars(arguments).items() if k not in ("build", "work", "json")}
                pathlib.Path(arguments.json).write_text(json.dumps({"options": options, "scenes": results}, indent=1) + "\n")
    return 0


if __name__ == "__main__":
    sys.exit(main())
