#!/usr/bin/env python3
"""One page from the results of `fovea bench paper`: every table and figure of the paper, and whether its claims hold.

Usage: benchmarks/paper.py DIR    (fovea bench calls it; DIR holds report.json, results and pictures)
Writes the folder DIR/paper: the page as Markdown and its pictures. Exit code 9 without matplotlib.
"""
import pathlib
import sys

sys.dont_write_bytecode = True  # the modules lie in the source tree
from report import Report  # noqa: E402
from page import figures, readings, table_entries, times  # noqa: E402
from page.results import Results  # noqa: E402
from page.text import anchor, one_or_many  # noqa: E402
from page.verdict import FAILS, HOLDS, MISSING, UNDECIDED  # noqa: E402

HEADINGS = {FAILS: "Do not hold in every scene", HOLDS: "Hold in every scene",
            UNDECIDED: "Left open by the measurements, as seeds differ too much or a search ended at a bound",
            MISSING: "Not measured yet"}


def entries(results, folder):
    """Every table and figure of the paper in its order; Figure 2 is a diagram. Then its prose, and what it leaves open."""
    return [table_entries.table1(results), table_entries.table2(results),
            *(make(results, folder) for make in (figures.figure1, figures.figure3, figures.figure4, figures.figure5,
                                                 figures.figure6, figures.figure7, figures.figure8, figures.figure9,
                                                 times.figure10)),
            times.moving_plane(results), readings.scale(results), readings.reuse(results), readings.choices(results)]


def summary(found):
    """How many claims have each verdict, and which; those that do not hold come first."""
    claims = {verdict: [(entry, claim) for entry in found for claim in entry.claims if claim.verdict == verdict]
              for verdict in HEADINGS}
    count = {verdict: len(list_) for verdict, list_ in claims.items()}
    lines = [f"Of {sum(count.values())} claims, **{count[FAILS]} do not hold in every scene, {count[HOLDS]} hold in "
             f"all**; {count[UNDECIDED]} undecided, {count[MISSING]} not measured yet. They are those of the "
             "paper's tables and text, what its figures are there to show and, last, what it leaves open."]
    for verdict, heading in HEADINGS.items():
        if claims[verdict]:
            lines.append(f"{heading} ({count[verdict]}):")
            lines.append("\n".join(f"- [{entry.title.split(':')[0]}]({anchor(entry.title)}): {claim.text}"
                                   for entry, claim in claims[verdict]))
    return lines


def origin(results):
    """What the numbers come from: scale, sizes, samples, seeds, device and commit, with a warning if commits differ."""
    jobs = [r["job"] for r in results.all]
    sizes = sorted({tuple(j["size"]) for j in jobs})
    samples = sorted({j["reference"]["spp"] for j in jobs if "reference" in j})
    scale = results.head.get("scale")
    lines = [
        f"Scale: {f'`{scale}`' if scale else 'the suite as it is'}; pictures of "
        f"{', '.join(f'{w}x{h}' for w, h in sizes)} pixels, references of {', '.join(map(str, samples)) or 'no'} "
        f"samples a pixel, {one_or_many(len({j['seed'] for j in jobs}), 'seed')}. "
        f"{len(results.all)} of {results.head['jobs']} jobs are measured. "
        "A ± is half the 95% interval over seeds; where there is one seed, verdicts rest on it alone.",
        f"Device: {'; '.join(results.devices())}.",
        f"Commit: {', '.join(results.commits())}.",
        f"Command: `{results.head.get('command', '')}`."]
    warnings = []
    if len(results.commits()) > 1:
        warnings.append(f"> **Warning: these results come from {len(results.commits())} commits.** Measure them again "
                        "with one build before relying on a comparison.")
    for scene, why in results.head.get("missing_scenes", {}).items():
        warnings.append(f"> **The scene `{scene}` is left out:** {why}")
    return [*warnings, "\n".join(f"- {line}" for line in lines)]


def write(folder):
    report = Report(folder)
    results = Results(report.head, report.results, folder)
    page = folder / "paper"
    page.mkdir(parents=True, exist_ok=True)
    for picture in page.glob("figure*.png"):  # of results that may be gone
        picture.unlink()
    found = entries(results, page)
    lines = ["# Every table and figure of the paper",
             "*Foveated Instant Radiosity* (ISMAR 2020), measured with this implementation.",
             *summary(found), *origin(results)]
    for entry in found:
        lines += [f"## {entry.title}", *(b for b in entry.blocks if b),
                  "\n".join(f"- {claim.sentence}" for claim in entry.claims)]
    partial = page / "README.md.partial"
    partial.write_text("\n\n".join(lines) + "\n", encoding="utf-8")
    partial.rename(page / "README.md")


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    write(pathlib.Path(sys.argv[1]))
