#!/usr/bin/env python3
"""Measures how many frames methods take after a sudden change until their error has nearly settled.

Usage: benchmarks/recovery.py SCENE.json --change N [--graphs foveal,ours] [--json FILE]
The scene is static before and after frame N, in which something changes: the gaze jumps, a light is switched, a door
opens. Each graph renders the frames before and after the change, and in a second run only frames long after it, whose
error is the settled one. Both are compared with two path-traced pictures with independent noise, so that this noise
adds nothing to the error. Errors are means over several seeds, as a list of VPLs may by chance be twice as good as
another. benchmarks/README.md describes the table.

Exit code 2: the command line is wrong; 3: a file or a Python module cannot be used; 7: the table cannot be written;
otherwise that of `fovea`.
"""
import argparse
import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile

from pictures import BAD_INPUT, CANNOT_WRITE, Parser, Picture, fail, load

ROOT = pathlib.Path(__file__).resolve().parent.parent
SETTLED_FRAMES = 10
REFERENCE_SEEDS = 1001, 1002  # unlike those of the methods, which may trace the same paths
ALMOST = 1.25  # of the settled error


class Renderer:
    """Renders sequences of one scene into a folder and reads what the eye sees of them."""

    def __init__(self, options, folder):
        self.options, self.folder = options, folder

    def frames(self, graph, first, warmup, count, *more):
        """The fovea of `count` frames of the graph, each an array of pixels x 3, radiance in W/(sr m^2)."""
        return [self.fovea(file) for file in self.render(graph, first, warmup, count, *more)]

    def stands_still(self, first, last):
        """Whether the eye sees the same direct light in both frames."""
        early, late = (Picture(str(self.render("direct", frame, 0, 1)[0])).pixels() for frame in (first, last))
        return (early == late).all()

    def render(self, graph, first, warmup, count, *more):
        """The files of `count` frames, until the next call."""
        for file in self.folder.iterdir():
            file.unlink()
        command = [self.options.fovea, "render", graph, "--scene", self.options.scene, "--size", self.options.size,
                   "--first", str(first), "--warmup", str(warmup), "--frames", str(count), "--quiet",
                   "-o", str(self.folder / "frame_%05d.exr"), *more]
        run = subprocess.run(command, capture_output=True, text=True)
        if run.returncode != 0:
            fail(run.returncode, f"`{graph}` cannot be rendered: {run.stderr.strip()}")
        return sorted(self.folder.iterdir())

    def fovea(self, file):
        numpy = load("numpy")
        picture = Picture(str(file), [self.options.layer])
        width, height = picture.size
        remedy = "render it again"
        gaze, radius = picture.metadata("gaze", 2, remedy), picture.metadata("fovea_radius", 1, remedy)[0]
        y, x = numpy.mgrid[0:height, 0:width]
        inside = numpy.hypot(x + 0.5 - gaze[0] * width, y + 0.5 - gaze[1] * height) <= radius * width
        return picture.pixels()[inside].astype(float)


def error(picture, references):
    """Mean squared error of radiance. References with independent noise make it free of theirs."""
    first, second = references
    return float(((picture - first) * (picture - second)).mean())


def recovery(renderer, graph, references):
    """Ratios of the errors after the change to the settled one, and the latter."""
    o = renderer.options

    def errors(first, warmup, count):
        """The errors of `count` frames, each the mean over the seeds."""
        runs = [renderer.frames(graph, first, warmup, count, "--seed", str(seed)) for seed in range(1, o.seeds + 1)]
        return [sum(error(picture, references) for picture in frame) / o.seeds for frame in zip(*runs)]

    settled = sum(errors(o.change, o.frames, SETTLED_FRAMES)) / SETTLED_FRAMES
    after = errors(max(o.change - o.before, 0), min(o.before, o.change), o.frames)
    return [e / settled for e in after], settled


def frames_until(ratios, limit):
    """The first frame after the change from which on no ratio exceeds the limit; None if the last one does."""
    above = [i for i, ratio in enumerate(ratios) if ratio > limit]
    first = above[-1] + 1 if above else 0
    return first if first < len(ratios) else None


# ---- Command line

def whole(least):
    def read(text):
        if not re.fullmatch("[0-9]+", text) or int(text) < least:
            raise argparse.ArgumentTypeError(f"`{text}` is not a whole number of at least {least}")
        return int(text)
    return read


def parse(arguments):
    parser = Parser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    add = parser.add_argument
    add("scene", help="scene file in which something happens")
    add("--change", type=whole(1), required=True, metavar="N", help="the first frame after it")
    add("--graphs", default="foveal,ours,ir_1000", metavar="A,B", help="default: foveal,ours,ir_1000")
    add("--before", type=whole(1), default=40, metavar="N", help="frames rendered before the change; default 40")
    add("--frames", type=whole(1), default=40, metavar="N", help="frames rendered after it; default 40")
    add("--seeds", type=whole(1), default=3, metavar="N", help="runs over which errors are averaged; default 3")
    add("--size", default="256x256", metavar="WxH", help="default: 256x256")
    add("--spp", type=whole(1), default=256, help="samples per pixel of each path-traced picture; default 256")
    add("--layer", default="indirect", help="layer that is compared; default: indirect")
    add("--fovea", default=str(ROOT / "build/release/bin/fovea"), metavar="FILE", help="the program")
    add("--json", metavar="FILE", help="write all ratios, too")
    return parser.parse_args(arguments)


def main():
    options = parse(sys.argv[1:])
    if not os.path.isfile(options.scene):
        fail(BAD_INPUT, f"`{options.scene}` is not a file; name a scene file")
    if options.json and not os.access(os.path.dirname(options.json) or ".", os.W_OK):
        fail(CANNOT_WRITE, f"`{options.json}` cannot be written; choose a folder that exists and can be written to")
    rows = []
    with tempfile.TemporaryDirectory() as folder:
        renderer = Renderer(options, pathlib.Path(folder))
        last = options.change + options.frames + SETTLED_FRAMES - 1
        if not renderer.stands_still(options.change, last):
            fail(BAD_INPUT, f"something moves in `{options.scene}` between the frames {options.change} and {last}; let "
                            "nothing change after --change (`\"animation\": false` stills a model)")
        references = [renderer.frames("reference", options.change, 0, 1, "--set", f"spp={options.spp}",
                                      "--seed", str(seed))[0] for seed in REFERENCE_SEEDS]
        for graph in options.graphs.split(","):
            ratios, settled = recovery(renderer, graph, references)
            rows.append({"graph": graph, "settled": settled, "frames": frames_until(ratios, ALMOST), "ratios": ratios})
            print(f"{graph}: {rows[-1]['frames']}", file=sys.stderr)
    if options.json:
        pathlib.Path(options.json).write_text(json.dumps(
            {"scene": options.scene, "change": options.change, "seeds": options.seeds, "size": options.size,
             "layer": options.layer, "spp": options.spp, "limit": ALMOST, "methods": rows}, indent=2) + "\n")
    shown = [i for i in (0, 1, 2, 4, 8, 16, 32) if i < options.frames]
    column = max(len(row["graph"]) for row in rows)
    print(f"{'graph':{column}} {'settled':>9} frames " + " ".join(f"{i:>6}" for i in shown))
    for row in rows:
        until = str(row["frames"]) if row["frames"] is not None else f">{options.frames - 1}"
        print(f"{row['graph']:{column}} {row['settled']:9.3g} {until:>6} "
              + " ".join(f"{row['ratios'][i]:6.2f}" for i in shown))


if __name__ == "__main__":
    main()
