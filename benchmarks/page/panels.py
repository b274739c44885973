"""Pictures beside each other: with the circle of the fovea, its middle enlarged, and error pictures."""
import io
import pathlib

import numpy
from PIL import Image

from report import plt

from .verdict import MISSING

COLOURS = 256  # of a file; enough to see what there is to see, at a third of the bytes
PANEL = 1.75  # inches
DPI = 110
NOTHING = ()  # in place of pixels: an empty panel


def name_of(job):
    """The name of a job's files, as the program makes it."""
    text = f"{job['sweep']}-{pathlib.Path(job['scene']).stem}-{job['label']}"
    text += "".join(f"-{k}={v}" for k, v in job["varied"].items())
    return "".join("_" if c in "/ *?" else c for c in text) + f"-s{job['seed']}"


def read(results, result, kind=""):
    """Pixels of a picture of a result, or None: kind is "", "-reference", "-error" or "-temporal"."""
    file = results.folder / "pictures" / f"{name_of(result['job'])}{kind}.png"
    if not file.exists():
        return None
    with Image.open(file) as image:
        return numpy.asarray(image.convert("RGB"))


def first_seed(results, sweep, scene, graph, **varied):
    """The result of the least seed whose picture is there, or None."""
    found = sorted(results.select(sweep, scene, graph, **varied), key=lambda r: r["job"]["seed"])
    return next((r for r in found if "pictures" in r["job"]["measures"]), None)


def middle(pixels, disc):
    """The square of half the fovea's width around its centre, and its left, top and side."""
    x, y, radius = disc
    side = max(8, min(int(radius), *pixels.shape[:2]))
    left, top = (int(max(0, min(edge - side, at - side / 2)))
                 for edge, at in ((pixels.shape[1], x), (pixels.shape[0], y)))
    return pixels[top:top + side, left:left + side], (left, top, side)


def write(file):
    """Writes the current figure with few colours."""
    memory = io.BytesIO()
    plt.savefig(memory, format="png", dpi=DPI)
    plt.close()
    file.parent.mkdir(parents=True, exist_ok=True)
    Image.open(memory).convert("RGB").quantize(COLOURS).save(file, optimize=True)


def panel(place, pixels, disc=None, box=None):
    place.set_xticks([])
    place.set_yticks([])
    if pixels is NOTHING:
        place.set_frame_on(False)
        return
    for edge in place.spines.values():
        edge.set_linewidth(0.5)
    if pixels is None:
        place.text(0.5, 0.5, MISSING, ha="center", va="center", fontsize=7, transform=place.transAxes)
        return
    place.imshow(pixels)
    if disc:
        place.add_patch(plt.Circle(disc[:2], disc[2], fill=False, color="white", linewidth=0.8))
    if box:
        left, top, side = box
        place.add_patch(plt.Rectangle((left, top), side, side, fill=False, color="yellow", linewidth=0.8))
    place.set_xlim(-0.5, pixels.shape[1] - 0.5)
    place.set_ylim(pixels.shape[0] - 0.5, -0.5)


def grid(file, columns, rows):
    """A figure with `columns` of headings and `rows` of (label, [(pixels, disc, box)])."""
    figure, places = plt.subplots(len(rows), len(columns), squeeze=False,
                                  figsize=(PANEL * len(columns) + 0.25, (PANEL + 0.03) * len(rows) + 0.25))
    for line, (label, cells) in zip(places, rows):
        for place, cell in zip(line, cells):
            panel(place, *cell)
        line[0].set_ylabel(label, fontsize=7)
    for place, heading in zip(places[0], columns):
        place.set_title(heading, fontsize=8, pad=3)
    figure.subplots_adjust(left=0.2 / figure.get_figwidth(), right=0.995, bottom=0.005,
                           top=1 - 0.22 / figure.get_figheight(), wspace=0.02, hspace=0.02)
    write(file)


def with_reference(results, found, errors=True):
    """Headings and rows of a grid: the reference and each result of `found`, label -> result (or None)."""
    known = [r for r in found.values() if r]
    truth = read(results, known[0], "-reference") if known else None
    if truth is None:
        return None
    disc = known[0]["error"]["disc"]
    pictures = [truth, *(read(results, r) if r else None for r in found.values())]
    box = middle(truth, disc)[1]
    rows = [("picture", [(p, disc, box) for p in pictures]),
            ("enlarged", [(None if p is None else middle(p, disc)[0],) for p in pictures])]
    if errors:
        error = [read(results, r, "-error") if r else None for r in found.values()]
        rows.append(("error", [(NOTHING,), *((p,) for p in error)]))
    return ["reference", *found], rows
