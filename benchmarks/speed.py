#!/usr/bin/env python3
"""Speed of ir_1000 on Sponza compared with the targets for two cores with lavapipe: 1024x1024, 1000 VPLs, exact 128x128 maps.

Usage: benchmarks/speed.py [--build FOLDER] [--frames N] [--json FILE]
Needs the Sponza model (see samples/scenes/README.md). Exit code 1 when a target is missed, 2 when it cannot run.
Absolute times are meaningful only on an otherwise idle machine; run it alone.
"""
import argparse
import json
import pathlib
import resource
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent


def render(program, frames):
    """Timings of a run as `fovea render --timings` writes them, and the peak memory of the process in MiB."""
    with tempfile.TemporaryDirectory() as folder:
        timings = pathlib.Path(folder) / "timings.json"
        command = [program, "render", "ir_1000", "--scene", "sponza", "--size", "1024x1024", "--warmup", "1",
                   "--frames", str(frames), "--quiet", "--timings", str(timings),
                   "-o", str(pathlib.Path(folder) / "picture.png")]
        if subprocess.run(command).returncode != 0:
            sys.exit(2)
        peak = resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss / 1024
        return json.loads(timings.read_text()), peak


def compiler_cost(program):
    """Worst microseconds a pass from bind to plan over the graphs of the micro-benchmark, and that graph's name."""
    command = [program, "--benchmark_format=json", "--benchmark_filter=BindToPlan"]
    result = subprocess.run(command, capture_output=True, text=True)
    if result.returncode != 0:
        return None
    unit = {"ns": 1e-3, "us": 1.0, "ms": 1e3}
    rows = [(b["cpu_time"] * unit[b["time_unit"]] / int(b["name"].rsplit(":", 1)[-1]), b["name"])
            for b in json.loads(result.stdout)["benchmarks"]]
    return max(rows) if rows else None


def counter(timings, name):
    value = timings["counters"][name]
    return value["median"] if isinstance(value, dict) else value


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--build", default=str(ROOT / "build" / "release"))
    parser.add_argument("--frames", type=int, default=5)
    parser.add_argument("--json", help="write the table as JSON, too")
    arguments = parser.parse_args()
    programs = pathlib.Path(arguments.build) / "bin"

    timings, peak = render(str(programs / "fovea"), arguments.frames)
    passes = {p["name"]: p["gpu_ms"]["median"] for p in timings["passes"]}
    pairs = counter(timings, "deferred.pixels") * counter(timings, "deferred.vpls_per_pixel")
    rows = [
        ("G-buffer, ms", passes["gbuffer"], 300, "at most"),
        ("exact shadow atlas, ms per VPL", passes["shadow-atlas"] / counter(timings, "shadow-atlas.maps"), 12, "at most"),
        ("VPL shading, million pixel-VPL pairs/s", pairs / passes["deferred"] / 1e3, 80, "at least"),
        ("peak memory, MiB", peak, 2048, "at most"),
    ]
    cost = compiler_cost(str(programs / "micro_benchmarks"))
    if cost:
        rows.append((f"bind to plan, us per pass ({cost[1]})", cost[0], 0.5, "at most"))

    print(f"{timings['device']}, {arguments.frames} frames, medians; whole frame {timings['frame']['wall_ms']['median']:.0f} ms")
    missed = 0
    for name, value, target, sense in rows:
        good = value <= target if sense == "at most" else value >= target
        missed += not good
        print(f"{name:62} {value:10.2f}   {sense} {target:<5} {'' if good else 'MISSED'}")
    if arguments.json:
        pathlib.Path(arguments.json).write_text(json.dumps(
            {"device": timings["device"], "frames": arguments.frames,
             "rows": [{"name": n, "value": v, "target": t, "sense": s} for n, v, t, s in rows]}, indent=1) + "\n")
    return 1 if missed else 0


if __name__ == "__main__":
    sys.exit(main())
