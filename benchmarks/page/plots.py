"""Curves and bars of the page."""
import math

from report import plt

from .panels import write
from .results import mean_of
from .verdict import MISSING


def curves(results, file, sweeps, measures, scenes):
    """A curve for each graph, in a row for each scene and measure, and a column for each sweep.

    sweeps: (sweep, axis, label of the axis); measures: (name, label, factor). Returns whether there is anything.
    """
    rows = [(measure, scene) for measure in measures for scene in scenes]
    if not rows or not any(results.select(s) for s, _, _ in sweeps):
        return False
    figure, places = plt.subplots(len(rows), len(sweeps), squeeze=False,
                                  figsize=(2.7 * len(sweeps), 1.9 * len(rows) + 0.2))
    for (measure, scene), line in zip(rows, places):
        for place, (sweep, axis, label) in zip(line, sweeps):
            for graph in dict.fromkeys(r["job"]["label"] for r in results.select(sweep, scene)):
                curve(results, place, (sweep, scene, graph, measure[0]), axis, measure[2])
            place.tick_params(labelsize=6)
            place.set_xlabel(label, fontsize=7)
            low, high = place.get_ylim()
            place.set_ylim(min(0, low), high + 0.05 * (high - min(0, low)))
            if not place.lines:
                place.set_xticks([])
                place.set_yticks([])
                place.text(0.5, 0.5, MISSING, ha="center", fontsize=7, transform=place.transAxes)
            place.set_title(scene, fontsize=7)
        line[0].set_ylabel(measure[1], fontsize=7)
    names = max((place.get_legend_handles_labels() for place in places.flat), key=lambda found: len(found[0]))
    figure.tight_layout(rect=(0, 0, 1, 1 - 0.2 / figure.get_figheight()))
    figure.legend(*names, fontsize=7, ncol=3, loc="upper center")
    write(file)
    return True


def colour(graph):
    """The same in every plot."""
    return f"C{('ours', 'ir_1000').index(graph) if graph in ('ours', 'ir_1000') else 2}"


def curve(results, place, where, axis, factor):
    points = []
    for value in results.values(where[0], axis):
        seeds = results.seeds(*where, **{axis: value})
        if seeds:
            points.append((float(value), *mean_of(factor * v for v in seeds.values())))
    if points:
        x, y, half = zip(*points)
        bars = [h if math.isfinite(h) else 0 for h in half]
        place.errorbar(x, y, yerr=bars if any(bars) else None, marker="o", markersize=3, linewidth=1, capsize=2,
                       label=where[2], color=colour(where[2]))


def stacked(file, bars, steps, unit):
    """bars: label -> {step: amount}."""
    figure, place = plt.subplots(figsize=(2.9 + 0.34 * len(bars), 3.6))
    bottom = [0.0] * len(bars)
    for i, step in enumerate(steps):
        heights = [amounts.get(step, 0) for amounts in bars.values()]
        place.bar(range(len(bars)), heights, 0.7, bottom=bottom, label=step, color=plt.get_cmap("tab10").colors[i % 10])
        bottom = [b + h for b, h in zip(bottom, heights)]
    place.set_xticks(range(len(bars)))
    place.set_xticklabels(bars, fontsize=6, rotation=60, ha="right")
    place.tick_params(axis="y", labelsize=6)
    place.set_ylabel(unit, fontsize=7)
    place.legend(fontsize=6, bbox_to_anchor=(1, 1), loc="upper left")
    figure.tight_layout()
    write(file)
