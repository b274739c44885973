#!/usr/bin/env python3
"""What `fovea vr` counted, as a table and a plot: frames that were missed, the age of the gaze, and the time of each eye.

Usage: benchmarks/vr_report.py FRAMES.csv [TIMINGS.json] -o FOLDER
FRAMES.csv is what `fovea vr --log` wrote, TIMINGS.json what its `--timings` did in the same run. FOLDER receives
vr.txt, a table with medians and 95th percentiles, and the plot of all frames as vr.png, vr.svg and vr.pdf.

Exit code 2: the command line is wrong; 3: a file or a Python module cannot be used; 7: the folder cannot be written.
"""
import csv
import json
import math
import pathlib

from pictures import BAD_INPUT, CANNOT_WRITE, Parser, fail, load

COLUMNS = ("frame", "time_s", "missed", "gaze", "gaze_to_display_ms", "gaze_to_submit_ms", "recording_ms")
AGES = {"gaze_to_display_ms": "gaze to display", "gaze_to_submit_ms": "gaze to submission", "recording_ms": "recording"}


def read_frames(file):
    """Rows of numbers; NaN where a cell is empty."""
    try:
        with open(file, newline="", encoding="utf-8") as stream:
            rows = list(csv.DictReader(stream))
        frames = [{column: float(row[column] or "nan") for column in COLUMNS} for row in rows]
    except (OSError, UnicodeDecodeError, KeyError, TypeError, ValueError) as error:
        fail(BAD_INPUT, f"`{file}` is not what `fovea vr --log` writes ({error})")
    if not frames:
        fail(BAD_INPUT, f"`{file}` has no frames; run `fovea vr --log {file}` again")
    return frames


def read_eyes(file):
    """Milliseconds of each view: median and 95th percentile."""
    try:
        views = json.loads(pathlib.Path(file).read_text(encoding="utf-8")).get("views", {})
        return {name: (view["ms"]["median"], view["ms"]["p95"]) for name, view in views.items()}
    except (OSError, ValueError, KeyError, TypeError, AttributeError) as error:
        fail(BAD_INPUT, f"`{file}` is not what `fovea vr --timings` writes ({error})")


def spread(values):
    """Median, and the smallest value that at least 95% do not exceed."""
    values = sorted(value for value in values if not math.isnan(value))
    if not values:
        return None
    middle = (values[(len(values) - 1) // 2] + values[len(values) // 2]) / 2
    return middle, values[math.ceil(0.95 * len(values)) - 1]


def table(frames, eyes):
    missed = int(sum(frame["missed"] for frame in frames))
    blind = sum(frame["gaze"] == 0 for frame in frames)
    text = (f"{len(frames)} frames shown, {missed} periods of the display missed, {blind} frames without gaze.\n\n"
            "| ms | median | 95% |\n|---|---|---|\n")
    rows = {AGES[column]: spread([frame[column] for frame in frames]) for column in AGES}
    rows |= {"passes of no view" if name == "none" else f"passes of view `{name}`": time for name, time in eyes.items()}
    return text + "".join(f"| {name} | {row[0]:.2f} | {row[1]:.2f} |\n" for name, row in rows.items() if row)


def plot(frames, folder):
    load("matplotlib").use("Agg")
    import matplotlib.pyplot as plt
    from suite_page.plots import beside, save
    _, axes = plt.subplots(figsize=(9, 3.2))
    times = [frame["time_s"] for frame in frames]
    for column, name in AGES.items():
        values = [frame[column] for frame in frames]
        if not all(map(math.isnan, values)):
            axes.plot(times, values, label=name, linewidth=1)
    late = [frame["time_s"] for frame in frames if frame["missed"]]
    if late:
        axes.plot(late, [0] * len(late), "|", color="tab:red", markersize=12, label="after missed frames")
    axes.set(xlabel="time of the scene, s", ylabel="ms", ylim=(0, None))
    beside([axes])
    save(folder, "vr")


def main():
    parser = Parser(description=__doc__.split("\n\n")[0])
    parser.add_argument("frames", metavar="FRAMES.csv")
    parser.add_argument("timings", metavar="TIMINGS.json", nargs="?")
    parser.add_argument("-o", dest="folder", metavar="FOLDER", required=True, type=pathlib.Path)
    options = parser.parse_args()
    frames = read_frames(options.frames)
    eyes = read_eyes(options.timings) if options.timings else {}
    try:
        plot(frames, options.folder)
        (options.folder / "vr.txt").write_text(table(frames, eyes), encoding="utf-8")
    except OSError as error:
        fail(CANNOT_WRITE, f"`{options.folder}` cannot be written ({error.strerror})")


if __name__ == "__main__":
    main()
