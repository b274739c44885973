#!/usr/bin/env python3
"""One self-contained page from the results of `fovea bench`: tables next to the paper's numbers, plots, pictures, error pictures, zooms.

Usage: benchmarks/report.py DIR [--against OTHER]    (fovea bench calls it; DIR holds report.json, results, tables and pictures)
Writes DIR/report.html, DIR/plots as PNG, SVG and PDF, and DIR/tables/*.tex. With --against, the page also says what differs
from another run. Exit code 9 without matplotlib.
"""
import base64
import csv
import html
import io
import json
import math
import os
import pathlib
import re
import sys

try:
    import matplotlib
    matplotlib.use("Agg")
    import matplotlib.pyplot as plt
except ImportError:
    if sys.executable != "/usr/bin/python3" and os.path.exists("/usr/bin/python3"):  # Debian's, where the package is
        os.execv("/usr/bin/python3", ["/usr/bin/python3", *sys.argv])
    print("report.py: matplotlib is missing", file=sys.stderr)
    sys.exit(9)

sys.dont_write_bytecode = True  # the modules lie in the source tree
from suite_page import plots, runs, tables  # noqa: E402
from suite_page.measures import MEASURES, NOTES, badness, digits, number  # noqa: E402
from suite_page.outliers import outliers  # noqa: E402
from suite_page.settings import settings  # noqa: E402
from suite_page.style import STYLE  # noqa: E402

CSV_COLUMNS = {"scene", "graph", "measure", "mean", "half_width", "seeds", "paper", "ratio", "bound"}


def data_url(data, kind="png"):
    return f"data:image/{kind};base64," + base64.b64encode(data).decode()


def prose(text):
    """A description in HTML, whose `names` are set as code."""
    return re.sub("`([^`]+)`", r"<code>\1</code>", html.escape(text))


class Report:
    def __init__(self, folder):
        self.folder = folder
        self.head = json.loads((folder / "report.json").read_text())
        self.results = [json.loads((folder / "results" / name).read_text()) for name in self.head["results"]]
        self.parts = []

    def add(self, text):
        self.parts.append(text)

    def paper_name(self, scene):
        return self.head["paper_scenes"].get(scene, "")

    # ---- Head

    def introduction(self):
        first = self.results[0]
        devices = sorted({r["made_with"]["device"] for r in self.results})
        commits = sorted({r["commit"] or "?" for r in self.results})
        self.add(f"<h1>Benchmark <code>{html.escape(self.head['suite'])}</code></h1><p>{prose(self.head['description'])}.</p>")
        cpu = any("llvmpipe" in d for d in devices)
        self.add("<p>Device: " + html.escape("; ".join(devices)) + (
            ". This is lavapipe, Vulkan in software on the processor: its times, and the ratios between them, "
            "are not those of a graphics card; errors and counters are the same everywhere." if cpu else ".") +
            f"<br>Made by <code>{html.escape(self.head.get('command', ''))}</code>; built from commit {html.escape(', '.join(commits))}, version {html.escape(first['version'])}; "
            f"{len(self.results)} of {self.head['jobs']} jobs measured, {sum(r.get('seconds', 0) for r in self.results) / 60:.1f} minutes of work. "
            "Times hold only as far as the machine had nothing else to do.</p>")
        for scene, why in self.head["missing_scenes"].items():
            self.add(f"<p class=warn>Scene <b>{html.escape(scene)}</b> was left out: {html.escape(why)}</p>")
        if len(self.results) < self.head["jobs"]:
            self.add("<p class=warn>Not every job has a result yet: means are over what is there.</p>")

    def graphs(self):
        """What the labels in the tables stand for, in the words of the graph files."""
        rows = {}
        for job in (r["job"] for r in self.results):
            file = pathlib.Path(job["graph"])
            file = file if file.suffix else pathlib.Path(__file__).resolve().parent.parent / "graphs" / f"{file}.json"
            text = json.loads(file.read_text()).get("description", "") if file.exists() else ""
            if job["label"] != pathlib.Path(job["graph"]).stem:
                text = f"graph {job['graph']}: {text}"
            rows.setdefault(job["label"], text)
        self.add("<h2>What is compared</h2><table>" + "".join(
            f"<tr><td><b>{html.escape(k)}</b></td><td class=text>{prose(v)}</td></tr>" for k, v in rows.items()) + "</table>")

    def explanation(self, names):
        rows = "".join(f"<tr><td><b>{html.escape(MEASURES[n].heading)}</b></td><td class=text>{html.escape(MEASURES[n].text)}; "
                       f"{MEASURES[n].better}</td></tr>" for n in MEASURES if n in names and n not in NOTES.values())
        self.add("<h2>What the numbers mean</h2><p>Displayed picture: sRGB(clamp(exposure × radiance)). The fovea is a circle around where the "
                 "eye looks; references are path-traced, and their own noise is measured from two halves and subtracted, which can leave a "
                 "small error slightly below 0. Errors have no unit; ×10⁻³: the table's number is 1000 times the value. <b>±</b>: half width of the "
                 "95% interval over seeds, wide where there are two or three. <b>Bold</b>: best of its scene and setting. <i>ours better by</i>: difference "
                 "to ours, seed by seed; it decides only where it is larger than its ±. <i>Paper</i>: the paper's number, with measured here ÷ the paper's in "
                 "brackets; its models, camera paths and machine (RTX 2080 Ti, 1024×1024) are others.</p>"
                 f"<table>{rows}</table>")

    # ---- Tables

    def rows(self, sweep):
        with open(self.folder / "tables" / f"{sweep}.csv", newline="") as file:
            return list(csv.DictReader(file))

    def cell(self, row, name, best, note):
        shown = lambda text: number(name, text)
        if not row or not row["mean"]:
            return "<td>-</td>"
        spread = lambda r: f" ± {shown(r['half_width'])}" if float(r["half_width"] or 0) > 0 else ""
        bound = html.escape(row["bound"]) + " " if row.get("bound") else ""
        text = f"<span{' class=best' if best else ''}>{bound}{shown(row['mean'])}</span><small>{spread(row)}</small>"
        if note and note["mean"]:
            text += f"<small>ours {'better' if float(note['mean']) > 0 else 'worse'} by {shown(note['mean'].lstrip('-'))}{spread(note)}</small>"
        if row["paper"]:
            ratio = float(row["ratio"])
            text += f"<small>Paper {shown(row['paper'])} (×{digits(ratio, 2)})</small>"
        return f"<td>{text}</td>"

    @staticmethod
    def best(name, rows):
        """Of each scene and setting: the row with the best mean, where there is something to compare."""
        def place(row, columns):
            return tuple(v for k, v in row.items() if k in columns or k not in CSV_COLUMNS)
        groups = {}
        for r in rows:
            if r["measure"] != name or not r["mean"]:
                continue
            others = {o["measure"]: float(o["mean"]) for o in rows
                      if o["mean"] and place(o, {"scene", "graph"}) == place(r, {"scene", "graph"})}
            bad = badness(name, r, others)
            if bad is not None:
                groups.setdefault(place(r, {"scene"}), []).append((bad, r))
        return [min(g, key=lambda pair: pair[0])[1] for g in groups.values() if len(g) > 1]

    def table(self, sweep, axes, rows):
        names = [n for n in MEASURES if any(r["measure"] == n and r["mean"] for r in rows)]
        shown = [n for n in names if n not in NOTES.values()]
        best = {n: self.best(n, rows) for n in shown}
        keys = list(dict.fromkeys((r["scene"], r["graph"], *(r[a] for a in axes)) for r in rows))
        cells = {((r["scene"], r["graph"], *(r[a] for a in axes)), r["measure"]): r for r in rows}
        text = "<div class=grid><table class='num names'><tr><th>scene</th><th>graph</th>" + "".join(f"<th>{html.escape(a)}</th>" for a in axes)
        text += "".join(f"<th>{html.escape(MEASURES[n].heading)}</th>" for n in shown) + "</tr>"
        scene = None
        for key in keys:
            paper = self.paper_name(key[0])
            text += "<tr>" if key[0] == scene else "<tr class=first>"
            scene = key[0]
            text += f"<td>{html.escape(key[0])}" + (f"<small>paper: {html.escape(paper)}</small>" if self.head["paper"] and paper else "") + "</td>"
            text += "".join(f"<td>{html.escape(k)}</td>" for k in key[1:])
            for n in shown:
                row = cells.get((key, n))
                text += self.cell(row, n, any(row is b for b in best[n]), cells.get((key, NOTES.get(n))))
            text += "</tr>"
        self.add(text + "</table></div>")
        (self.folder / "tables" / f"{sweep}.tex").write_text(
            tables.latex(f"{self.head['suite']}, {sweep}: means and half the 95% interval over seeds", axes, keys, shown, cells, best))
        return set(names)

    # ---- Plots

    def figure(self, name, title):
        """Saves the current plot and shows it."""
        vector = plots.save(self.folder / "plots", name)
        self.add(f"<figure><img src='{data_url(vector.encode(), 'svg+xml')}' alt='{html.escape(title)}'>"
                 f"<figcaption>{html.escape(title)}; <code>plots/{html.escape(name)}</code>.png, .svg, .pdf</figcaption></figure>")

    def plots_over(self, sweep, axis, rows, names):
        for name in (n for n in names if n in plots.OVER_AXIS):
            plots.lines(axis, self.number, rows, name)
            self.figure(f"{sweep}-{axis}-{name}", self.title(f"{MEASURES[name].heading} over {axis}", name, rows))

    def plots_over_time(self, sweep, axes, rows, names):
        for name in (n for n in names if n in plots.OVER_TIME):
            plots.over_time(axes, rows, name)
            self.figure(f"{sweep}-time-{name}",
                        f"{MEASURES[name].heading} over {MEASURES['time.wall_ms'].text}; {MEASURES[name].better}")

    def bar_plots(self, sweep, rows, names):
        for name in (n for n in names if n in plots.AS_BARS):
            plots.bars(rows, name)
            self.figure(f"{sweep}-{name}", self.title(MEASURES[name].heading, name, rows))

    @staticmethod
    def title(what, name, rows):
        intervals = any(float(r["half_width"] or 0) > 0 for r in rows if r["measure"] == name)
        return f"{what}; {MEASURES[name].better}" + ("; lines: 95% interval over seeds" if intervals else "")

    @staticmethod
    def number(text):
        return float(text.split("x")[0])  # sizes: by width

    def passes(self, sweep, axes, rows):
        """Times of the passes, on the device or, for host passes, on the host: means over seeds of medians over frames."""
        bars = {}
        for r in rows:
            name, _, kind = r["measure"].removeprefix("pass.").rpartition(".")
            if not r["measure"].startswith("pass.") or kind not in ("gpu_ms", "cpu_ms") or not r["mean"]:
                continue
            label = "\n".join([r["scene"], r["graph"], *(r[a] for a in axes)])
            times = bars.setdefault(label, {})
            if name not in times or float(r["mean"]) > float(times[name]["mean"]):
                times[name] = r
        stacks = {label: {step: float(r["mean"]) for step, r in times.items()} for label, times in bars.items()}
        if not stacks:
            return

        def cell(row):
            if row is None:
                return "<td>-</td>"
            half = float(row["half_width"] or 0)
            return f"<td>{digits(float(row['mean']))}<small>{f' ± {digits(half, 2)}' if half > 0 else ''}</small></td>"
        head = "".join(f"<th>{html.escape(b)}</th>" for b in bars)
        body = "".join(f"<tr><td>{html.escape(s)}</td>" + "".join(cell(t.get(s)) for t in bars.values()) + "</tr>"
                       for s in plots.cost(stacks))
        total = "".join(f"<td><b>{digits(sum(t.values()))}</b></td>" for t in stacks.values())
        self.add("<p>Milliseconds of every pass, on the device or, for passes that work there, on the host: means over seeds of "
                 "medians over frames, the most expensive pass first.</p>"
                 f"<div class=grid><table class='num steps'><tr><th>pass</th>{head}</tr>{body}<tr><td><b>all</b></td>{total}</tr></table></div>")
        plots.stacked(stacks)
        self.figure(f"{sweep}-passes", "time of every pass, mean over seeds; lower is better")

    # ---- Two runs

    def against(self, other):
        """What differs from another run of the same sweeps."""
        parts, same = [], 0
        for sweep in self.head["sweeps"]:
            file = other / "tables" / f"{sweep['sweep']}.csv"
            if not file.exists():
                continue
            with open(file, newline="") as stream:
                before = list(csv.DictReader(stream))
            for key, name, old, new, verdict in runs.changes(before, self.rows(sweep["sweep"]), sweep["axes"]):
                if name in NOTES.values():
                    continue
                if verdict == runs.SAME:
                    same += 1
                    continue
                was = float(old["mean"])
                change = f"{100 * (float(new['mean']) / was - 1):+.1f}%" if was else "-"
                cells = [sweep["sweep"], " ".join(filter(None, key)), MEASURES[name].heading,
                         *(f"{number(name, r['mean'])} ± {number(name, r['half_width'] or 0)}" for r in (old, new)), change, verdict]
                parts.append("<tr>" + "".join(f"<td{' class=text' if i in (1, 2, 6) else ''}>{html.escape(c)}</td>"
                                              for i, c in enumerate(cells)) + "</tr>")
        self.add(f"<h2>Against <code>{html.escape(str(other))}</code></h2>")
        if not parts:
            self.add(f"<p>None of the {same} values that both runs have differs by more than their intervals together.</p>" if same
                     else "<p>The two runs have no values in common.</p>")
            return
        self.add(f"<p>Means over seeds of both runs, where the two differ by more than their intervals together; {same} other values do "
                 "not.</p><div class=grid><table class=num><tr><th>sweep</th><th>of</th><th>measure</th><th>other run</th>"
                 "<th>this run</th><th>change</th><th></th></tr>" + "".join(parts) + "</table></div>")

    # ---- Pictures

    def picture(self, name, width, zoom=None):
        """An <img>, or "": of the file, or of the part around `zoom` = (x, y, radius)."""
        file = self.folder / "pictures" / f"{name}.png"
        if not file.exists():
            return ""
        data = file.read_bytes()
        if zoom:
            x, y, radius = zoom
            pixels = plt.imread(io.BytesIO(data))
            h, w = pixels.shape[:2]
            half = max(8, int(radius / 2))
            x0, y0 = max(0, min(w - 2 * half, int(x) - half)), max(0, min(h - 2 * half, int(y) - half))
            memory = io.BytesIO()
            plt.imsave(memory, pixels[y0:y0 + 2 * half, x0:x0 + 2 * half], format="png")
            data = memory.getvalue()
        return f"<img class=pixels width={width} src='{data_url(data)}' alt='{html.escape(name)}'>"

    def pictures(self, sweep):
        """Per scene a grid: a column for the reference and each graph, a row for each kind of picture."""
        jobs = [r for r in self.results if r["job"]["sweep"] == sweep and r["job"]["seed"] == 1 and "pictures" in r["job"]["measures"]]
        for scene in dict.fromkeys(r["job"]["scene"] for r in jobs):
            mine = [r for r in jobs if r["job"]["scene"] == scene]
            disc = mine[0].get("error", {}).get("disc")
            labels = ["reference"] if disc else []
            names = []
            for job in (r["job"] for r in mine):
                name = f"{sweep}-{pathlib.Path(scene).stem}-{job['label']}" + "".join(f"-{k}={v}" for k, v in job["varied"].items()) + "-s1"
                names.append(name.replace("/", "_").replace(" ", "_"))
                labels.append(", ".join([job["label"], *(f"{k} = {v}" for k, v in job["varied"].items())]))
            width = max(180, min(420, 1040 // len(labels)))
            discs = [r.get("error", {}).get("disc") for r in mine]
            rows = {"picture": [self.picture(n, width) for n in names],
                    "half of the fovea, enlarged": [self.picture(n, width, d) if d else "" for n, d in zip(names, discs)],
                    "error against the reference, its noise included; circle: fovea": [self.picture(n + "-error", width) for n in names],
                    "change between the last two frames that is not the reference's, its noise included": [self.picture(n + "-temporal", width) for n in names],
                    "difference of the eyes that is not the reference's, its noise included; black: seen by the left eye alone": [self.picture(n + "-eyes", width) for n in names]}
            if disc:
                truths = [self.picture(names[0] + "-reference", width), self.picture(names[0] + "-reference", width, disc), "", "", ""]
                for truth, row in zip(truths, rows.values()):
                    row.insert(0, truth)
            self.add(f"<h3>{html.escape(scene)}</h3><div class=grid><table class=pics><tr><td></td>" +
                     "".join(f"<td><b>{html.escape(label)}</b></td>" for label in labels) + "</tr>")
            for caption, row in rows.items():
                if any(row):
                    self.add(f"<tr><td>{html.escape(caption)}</td>" + "".join(f"<td>{p}</td>" for p in row) + "</tr>")
            self.add("</table></div>")

    def sweep(self, sweep, axes):
        rows = self.rows(sweep)
        if not rows:
            return set()
        mine = [r for r in self.results if r["job"]["sweep"] == sweep]
        self.add(f"<h2>{html.escape(sweep)}</h2><p>{html.escape(settings([r['job'] for r in mine]))}</p>")
        for sentence in outliers(mine):
            self.add(f"<p class=warn>{html.escape(sentence)}</p>")
        names = self.table(sweep, axes, rows)
        ordered = [n for n in MEASURES if n in names]
        numeric = [a for a in axes if all(self.is_number(r[a]) for r in rows if r[a])]
        if len(axes) == 1 and numeric:
            self.plots_over(sweep, axes[0], rows, ordered)
        elif not axes:
            self.bar_plots(sweep, rows, ordered)
        elif self.each_has_an_axis_of_its_own(axes, rows):
            self.plots_over_time(sweep, axes, rows, ordered)
        self.passes(sweep, axes, rows)
        self.pictures(sweep)
        return names

    @staticmethod
    def each_has_an_axis_of_its_own(axes, rows):
        """Whether graphs are varied by different parameters, so that only times tell what their settings have in common."""
        return all(sum(bool(r[a]) for a in axes) == 1 for r in rows)

    def is_number(self, text):
        try:
            return math.isfinite(self.number(text))
        except ValueError:
            return False

    def write(self, other=None):
        self.introduction()
        self.graphs()
        if other:
            self.against(other)
        place = len(self.parts)
        used = set()
        for sweep in self.head["sweeps"]:
            used |= self.sweep(sweep["sweep"], sweep["axes"])
        body = self.parts[place:]
        self.parts = self.parts[:place]
        self.explanation(used)
        self.parts += body
        page = f"<!doctype html><html lang=en><meta charset=utf-8><title>fovea bench {html.escape(self.head['suite'])}</title><style>{STYLE}</style>" + "\n".join(self.parts)
        partial = self.folder / f"report.html.partial{os.getpid()}"
        partial.write_text(page, encoding="utf-8")
        partial.rename(self.folder / "report.html")


if __name__ == "__main__":
    if len(sys.argv) not in (2, 4) or sys.argv[2:3] not in ([], ["--against"]):
        sys.exit(__doc__)
    Report(pathlib.Path(sys.argv[1])).write(pathlib.Path(sys.argv[3]) if len(sys.argv) == 4 else None)
