"""The plots of a report. Each is saved as PNG, SVG and PDF; legends stand beside the axes, where they cover nothing."""
import math

import matplotlib.pyplot as plt
import matplotlib.ticker

from .measures import HIGHER, LOWER, MEASURES

OVER_AXIS = ("error.fovea.mse", "error.periphery.mse", "error.light", "temporal.fovea.mse_prime", "temporal.fovea.excess",
             "time.wall_ms")
OVER_TIME = ("error.fovea.mse", "error.periphery.mse", "temporal.fovea.excess")
AS_BARS = ("error.fovea.mse", "error.periphery.mse", "error.light", "temporal.fovea.excess", "time.wall_ms")


def save(folder, name):
    """Writes NAME.png, NAME.svg and NAME.pdf, and returns the text of the SVG."""
    folder.mkdir(exist_ok=True)
    figure = plt.gcf()
    box = figure.get_tightbbox(figure.canvas.get_renderer()).padded(0.05)  # with the legend; once for all formats
    # Without dates, so that the same results give the same files.
    for ending, metadata in (("png", {}), ("pdf", {"CreationDate": None}), ("svg", {"Date": None})):
        figure.savefig(folder / f"{name}.{ending}", dpi=150, bbox_inches=box, metadata=metadata)
    plt.close()
    return (folder / f"{name}.svg").read_text()


def beside(axes):
    """A legend of what is in any of the axes, beside the last one of the first row."""
    found = {}
    for axis in axes:
        for handle, label in zip(*axis.get_legend_handles_labels()):
            found.setdefault(label, handle)
    axes[-1].legend(found.values(), found.keys(), fontsize=7, loc="upper left", bbox_to_anchor=(1.02, 1))


def spread(row, name):
    """Half the 95% interval over seeds, as it is plotted; 0 where there is one seed."""
    return MEASURES[name].factor * float(row["half_width"] or 0)


def mean(row, name):
    return MEASURES[name].factor * float(row["mean"])


def from_zero(axis, name, means):
    """Intervals that reach below the lowest mean, and below 0, are cut off."""
    if MEASURES[name].better in (LOWER, HIGHER):
        axis.set_ylim(bottom=min([0, *(1.1 * m for m in means)]))
    else:
        axis.axhline(1, color="grey", linewidth=0.8, linestyle="--")


def lines(axis, number, rows, name):
    """A curve for each graph over the values of an axis, with intervals."""
    scenes = list(dict.fromkeys(r["scene"] for r in rows))
    _, places = plt.subplots(1, len(scenes), figsize=(1 + 3.4 * len(scenes), 3.1), squeeze=False)
    for scene, place in zip(scenes, places[0]):
        means = []
        for graph in dict.fromkeys(r["graph"] for r in rows):
            points = sorted((number(r[axis]), mean(r, name), spread(r, name)) for r in rows
                            if r["scene"] == scene and r["graph"] == graph and r["measure"] == name and r["mean"] and r[axis])
            if points:
                x, y, half = zip(*points)
                means += y
                place.errorbar(x, y, yerr=half if any(half) else None, marker="o", capsize=2, label=graph)
        place.set_title(scene, fontsize=9)
        place.set_xlabel(axis, fontsize=9)
        from_zero(place, name, means)
    places[0][0].set_ylabel(MEASURES[name].heading, fontsize=9)
    beside(places[0])


def over_time(axes, rows, name):
    """Errors over the time of a frame: one curve a graph, each of whose points does another amount of work."""
    scenes, graphs = (list(dict.fromkeys(r[k] for r in rows)) for k in ("scene", "graph"))
    columns = min(3, len(scenes))
    height = math.ceil(len(scenes) / columns)
    _, places = plt.subplots(height, columns, figsize=(1 + 3.6 * columns, 3.2 * height), squeeze=False)
    for scene, place in zip(scenes, places.flat):
        for i, graph in enumerate(graphs):
            found = {}  # in the order of the suite, so that a curve joins amounts of work that follow each other
            for r in (r for r in rows if r["scene"] == scene and r["graph"] == graph and r["mean"]):
                found.setdefault(tuple(r[a] for a in axes), {})[r["measure"]] = float(r["mean"])
            points = [(v["time.wall_ms"], MEASURES[name].factor * v[name]) for v in found.values() if v.get(name, 0) > 0]
            place.loglog(*zip(*points or [(math.nan, math.nan)]), marker="o", markersize=4, label=graph, color=f"C{i}")
        place.set_title(scene, fontsize=9)
        place.set_xlabel(MEASURES["time.wall_ms"].heading, fontsize=9)
        place.grid(alpha=0.3, which="both")
        for axis in (place.xaxis, place.yaxis):
            axis.set_major_locator(matplotlib.ticker.LogLocator(subs=(1, 2, 5)))
            axis.set_major_formatter("{x:g}")
            axis.set_minor_formatter("")
    for place in places.flat[len(scenes):]:
        place.set_axis_off()
    for row in places:
        row[0].set_ylabel(MEASURES[name].heading, fontsize=9)
    beside(places[0])


def bars(rows, name):
    """A bar for each scene and graph, with intervals."""
    scenes, graphs = (list(dict.fromkeys(r[k] for r in rows)) for k in ("scene", "graph"))
    found = {(r["scene"], r["graph"]): r for r in rows if r["measure"] == name and r["mean"]}
    _, place = plt.subplots(figsize=(2 + 1.6 * len(scenes), 2.9))
    for i, graph in enumerate(graphs):
        mine = [(s, found[scene, graph]) for s, scene in enumerate(scenes) if (scene, graph) in found]
        if not mine:
            continue
        half = [spread(r, name) for _, r in mine]
        place.bar([s + (i - (len(graphs) - 1) / 2) * 0.8 / len(graphs) for s, _ in mine], [mean(r, name) for _, r in mine],
                  0.8 / len(graphs), label=graph, yerr=half if any(half) else None, capsize=2)
    place.set_xticks(range(len(scenes)))
    place.set_xticklabels(scenes, fontsize=8)
    place.set_xlim(-0.6, len(scenes) - 0.4)
    from_zero(place, name, [mean(r, name) for r in found.values()])
    place.set_ylabel(MEASURES[name].heading, fontsize=9)
    beside([place])


def stacked(stacks):
    """stacks: label -> {pass: mean}. Passes in order of cost, the most expensive at the bottom; small ones together."""
    costs = cost(stacks)
    shown = [step for step in costs if any(times.get(step, 0) > 0.02 * sum(times.values()) for times in stacks.values())]
    _, place = plt.subplots(figsize=(2.5 + 1.0 * len(stacks), 4.2))
    bottom = [0.0] * len(stacks)
    colours = plt.get_cmap("tab20").colors
    for i, step in enumerate([*shown, "others"]):
        heights = [t.get(step, 0) if step != "others" else sum(ms for s, ms in t.items() if s not in shown)
                   for t in stacks.values()]
        place.bar(range(len(stacks)), heights, 0.7, bottom=bottom, label=step, color=colours[i % 20])
        bottom = [b + h for b, h in zip(bottom, heights)]
    place.set_xticks(range(len(stacks)))
    place.set_xticklabels(stacks, fontsize=7)
    place.set_ylabel("ms per frame, by pass", fontsize=9)
    beside([place])


def cost(stacks):
    """The passes of all stacks, the most expensive first."""
    totals = {}
    for times in stacks.values():
        for step, ms in times.items():
            totals[step] = totals.get(step, 0) + ms
    return sorted(totals, key=lambda step: -totals[step])
