#!/usr/bin/env python3
"""Speed of foveated instant radiosity beside instant radiosity: 1024x1024, 1000 VPLs, exact 128x128 maps, along the camera
path of each scene, one after the other on the same machine.

Usage: benchmarks/foveated.py [--build FOLDER] [--frames N] [--scenes A,B] [--json FILE]
Exit code 1 when a target is missed, 2 when it cannot run. Run it alone. Ratios are of medians over frames.
"""
import argparse
import json
import pathlib
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent
SHARED = ("gbuffer", "shadow-map", "direct", "deferred", "tonemap")  # what both methods do alike
SECOND_EYE = "right/"                                                # prefix of its passes in graphs/stereo.json


def render(program, graph, scene, frames, warmup):
    with tempfile.TemporaryDirectory() as folder:
        timings = pathlib.Path(folder) / "timings.json"
        command = [program, "render", graph, "--scene", scene, "--size", "1024x1024", "--warmup", str(warmup),
                   "--frames", str(frames), "--quiet", "--timings", str(timings)]
        if subprocess.run(command).returncode != 0:
            sys.exit(2)
        return json.loads(timings.read_text())


def passes(timings):
    """Milliseconds of every pass: on the device, or on the host for the passes that work there."""
    return {p["name"]: max(p["gpu_ms"]["median"], p["cpu_ms"]["median"]) for p in timings["passes"]}


def counter(timings, name):
    value = timings["counters"].get(name, 0)
    return value["median"] if isinstance(value, dict) else value


def measure(program, scene, frames):
    ir = render(program, "ir_1000", scene, frames, 1)
    ours = render(program, "ours", scene, 2 * frames, 4)
    stereo = render(program, "stereo", scene, frames, 4)
    ir_passes, our_passes, stereo_passes = passes(ir), passes(ours), passes(stereo)
    ir_ms, our_ms = ir["frame"]["wall_ms"]["median"], ours["frame"]["wall_ms"]["median"]
    second = sum(ms for name, ms in stereo_passes.items() if name.startswith(SECOND_EYE))
    first = sum(ms for name, ms in stereo_passes.items() if not name.startswith(SECOND_EYE))
    shared = sum(ir_passes.get(name, 0) for name in SHARED)
    alive = max(counter(ours, "manage.alive"), 1)
    return {
        "scene": scene,
        "ir_1000_ms": ir_ms,
        "ours_ms": our_ms,
        "speed_up": ir_ms / our_ms,
        "bound": ir_ms / shared,  # Amdahl: were everything but the shared passes free
        "ir_1000_maps_ms": ir_passes["shadow-atlas"],
        "ours_maps_ms": our_passes["shadow-atlas"],
        "maps_ratio": our_passes["shadow-atlas"] / ir_passes["shadow-atlas"],
        "replaced_share": counter(ours, "manage.added") / alive,
        "maps_drawn": counter(ours, "shadow-atlas.maps"),
        "second_eye_ms": second,
        "first_eye_ms": first,
        "second_eye_ratio": second / first,
        "new_pixels_share": counter(stereo, "right/reproject.new_pixels") / max(counter(stereo, "right/reproject.pixels"), 1),
        "passes": {"ir_1000": ir_passes, "ours": our_passes, "stereo": stereo_passes},
    }


def table(row, speed_up_target):
    targets = [
        ("speed-up of ours over ir_1000", row["speed_up"], speed_up_target, "at least"),
        ("map time of ours / ir_1000", row["maps_ratio"], 0.2, "at most"),
        ("second eye / first eye's frame", row["second_eye_ratio"], 0.4, "at most"),
    ]
    if row["scene"].startswith("sponza"):
        targets.append(("frame of ours, ms", row["ours_ms"], 2500, "at most"))
    print(f"{row['scene']}: ir_1000 {row['ir_1000_ms']:.0f} ms, ours {row['ours_ms']:.0f} ms a frame; shared passes bound the "
          f"speed-up at {row['bound']:.2f}; {100 * row['replaced_share']:.1f}% of the VPLs replaced, {row['maps_drawn']:.0f} maps "
          f"drawn a frame; second eye: {100 * row['new_pixels_share']:.1f}% new pixels")
    missed = 0
    for name, value, target, sense in targets:
        good = value <= target if sense == "at most" else value >= target
        missed += not good
        print(f"  {name:40} {value:9.3f}   {sense} {target:<5} {'' if good else 'MISSED'}")
    for graph in ("ir_1000", "ours"):
        print(f"  {graph:8}", ", ".join(f"{n} {ms:.0f}" for n, ms in row["passes"][graph].items() if ms >= 0.5))
    return missed


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--build", default=str(ROOT / "build" / "release"))
    parser.add_argument("--frames", type=int, default=6)
    parser.add_argument("--scenes", default="sponza_plane,cornellbox_moving")
    parser.add_argument("--json", help="write what was measured")
    arguments = parser.parse_args()
    program = str(pathlib.Path(arguments.build) / "bin" / "fovea")
    rows, missed = [], 0
    for scene in arguments.scenes.split(","):
        rows.append(measure(program, scene, arguments.frames))
        missed += table(rows[-1], 4 if scene.startswith("sponza") else 2)
    if arguments.json:
        pathlib.Path(arguments.json).write_text(json.dumps(rows, indent=1) + "\n")
    return 1 if missed else 0


if __name__ == "__main__":
    sys.exit(main())
