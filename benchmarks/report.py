#!/usr/bin/env python3
"""One self-contained page from the results of `fovea bench`: tables next to the paper's numbers, plots, pictures, error pictures, zooms.

Usage: benchmarks/report.py DIR    (fovea bench calls it; DIR holds report.json, results, tables and pictures)
Writes DIR/report.html and DIR/plots/*.png. Exit code 9 without matplotlib.
"""
import base64
import csv
import html
import io
import json
import math
import os
import pathlib
import sys

try:
    import matplotlib
    matplotlib.use("Agg")
    import matplotlib.pyplot as plt
    import matplotlib.ticker
except ImportError:
    if sys.executable != "/usr/bin/python3" and os.path.exists("/usr/bin/python3"):  # Debian's, where the package is
        os.execv("/usr/bin/python3", ["/usr/bin/python3", *sys.argv])
    print("report.py: matplotlib is missing", file=sys.stderr)
    sys.exit(9)

# name -> (heading, factor, explanation); the paper gives its errors times 1000.
MEASURES = {
    "error.fovea.mse": ("MSE fovea ×10⁻³", 1e3, "mean square error of the displayed picture inside the foveal circle, reference noise subtracted"),
    "error.fovea.mse_over_ours": ("more than ours ×10⁻³", 1e3, "MSE in the fovea less that of ours, seed by seed: above its ±, ours is better"),
    "error.periphery.mse": ("MSE periphery ×10⁻³", 1e3, "the same outside it"),
    "error.light": ("light", 1, "sum of the compared radiance over the whole picture, as a part of the reference's"),
    "error.fovea.relmse": ("relMSE indirect fovea", 1, "relative square error of the indirect radiance alone"),
    "error.periphery.relmse": ("relMSE indirect periphery", 1, "the same outside the fovea"),
    "error.fovea.flip": ("FLIP fovea", 1, "visible difference when one picture replaces the other, 0 to 1"),
    "error.fovea.blocks": ("blocks fovea", 1, "how much more neighbouring pixels differ across the lines of lattices of 8 and 16 pixels than beside them, relative to the reference; 1 without blocks"),
    "error.periphery.blocks": ("blocks periphery", 1, "the same outside the fovea"),
    "error.fovea.direct_floor": ("direct floor fovea ×10⁻³", 1e3, "the MSE that would remain with perfect indirect light"),
    "temporal.fovea.mse_prime": ("MSE' fovea ×10⁻³", 1e3, "mean square change between consecutive frames (the paper's Eq. 4); contains the scene's own motion, so the best value is the reference's"),
    "temporal.fovea.reference_mse_prime": ("MSE' fovea of the reference ×10⁻³", 1e3, "the same of the reference, less its noise: the scene's motion alone"),
    "temporal.periphery.mse_prime": ("MSE' periphery ×10⁻³", 1e3, "the same outside the fovea"),
    "temporal.periphery.reference_mse_prime": ("MSE' periphery of the reference ×10⁻³", 1e3, "of the reference, outside the fovea"),
    "temporal.fovea.excess": ("excess fovea ×10⁻³", 1e3, "mean square of (change of the sequence - change of the reference): flicker without the scene's motion"),
    "temporal.fovea.excess_over_ours": ("excess more than ours ×10⁻³", 1e3, "excess in the fovea less that of ours, seed by seed"),
    "temporal.periphery.excess": ("excess periphery ×10⁻³", 1e3, "the same outside the fovea"),
    "temporal.fovea.mse": ("MSE fovea, all frames ×10⁻³", 1e3, "mean over the frames of the sequence"),
    "time.wall_ms": ("frame ms", 1, "wall time of a frame, median"),
    "speed_up.ir_1000": ("speed-up over ir_1000", 1, "frame time of ir_1000 / of this graph"),
    "speed_up.ir_eq": ("speed-up over ir_eq", 1, "frame time of instant radiosity with as small a foveal error / of this graph"),
    "match.value": ("N of ir_eq", 1, "VPLs with which instant radiosity reaches the foveal error of ours, by bisection"),
    "second_eye.ms": ("second eye ms", 1, "passes of the second eye"),
    "second_eye.of_first": ("second eye / first", 1, "passes of the second eye over all others: the first eye's whole frame"),
    "second_eye.new_pixels": ("new pixels", 1, "share of the second eye's pixels that the first one has not seen"),
}
NOTES = {"error.fovea.mse": "error.fovea.mse_over_ours", "temporal.fovea.excess": "temporal.fovea.excess_over_ours"}  # told inside the other's cell
HIGHER = {"speed_up.ir_1000", "speed_up.ir_eq", "match.value"}
NEUTRAL = {"error.fovea.direct_floor", "temporal.fovea.mse_prime", "temporal.periphery.mse_prime", "temporal.fovea.reference_mse_prime",
           "temporal.periphery.reference_mse_prime", "match.value", "second_eye.ms", "second_eye.of_first", "second_eye.new_pixels"}
CSV_COLUMNS = {"scene", "graph", "measure", "mean", "half_width", "seeds", "paper", "ratio", "bound"}
STYLE = """body{font:15px/1.5 system-ui,sans-serif;margin:2em auto;max-width:1180px;padding:0 1em;color:#1b1b1f}
table{border-collapse:collapse;margin:1em 0;font-size:13px}th,td{border-bottom:1px solid #ddd;padding:.3em .7em;text-align:right;vertical-align:top}
th{background:#f3f3f6}td:first-child,th:first-child,.names td:nth-child(2),.names th:nth-child(2){text-align:left}small{color:#667;display:block}
figure{display:inline-block;margin:.4em;vertical-align:top;max-width:100%}figcaption{font-size:13px;color:#445}.pixels{image-rendering:pixelated}
img{max-width:100%}.grid{overflow-x:auto}.num td{white-space:nowrap}.num th{vertical-align:bottom;max-width:7.5em}.steps th{max-width:none}.best{font-weight:bold}
.first td{border-top:2px solid #889}.pics td{border:0;padding:.15em;text-align:left;white-space:normal}.pics td:first-child{max-width:7em;color:#445}.pics img{display:block}
td.text{text-align:left;white-space:normal}.warn{background:#fff3d6;padding:.6em 1em;border-radius:6px}code{background:#f3f3f6;padding:0 .3em}"""


def data_url(data):
    return "data:image/png;base64," + base64.b64encode(data).decode()


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
        self.add(f"<h1>Benchmark <code>{html.escape(self.head['suite'])}</code></h1><p>{html.escape(self.head['description'])}</p>")
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
            f"<tr><td><b>{html.escape(k)}</b></td><td class=text>{html.escape(v)}</td></tr>" for k, v in rows.items()) + "</table>")

    def explanation(self, names):
        rows = "".join(f"<tr><td><b>{html.escape(MEASURES[n][0])}</b></td><td class=text>{html.escape(MEASURES[n][2])}"
                       f"{'' if n in NEUTRAL else '; higher is better' if n in HIGHER else '; lower is better'}</td></tr>" for n in MEASURES if n in names and n not in NOTES.values())
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

    def settings(self, sweep):
        jobs = [r["job"] for r in self.results if r["job"]["sweep"] == sweep]
        one = jobs[0]
        sizes = sorted({tuple(j["size"]) for j in jobs})
        last, seeds = one["first"] + one["frames"] - 1, len({j["seed"] for j in jobs})
        frames = f"frames {one['first']} to {last}" if one["frames"] > 1 else f"frame {last}"
        text = "Errors are those of the last frame. " if "error" in one["measures"] and one["frames"] > 1 else ""
        text += f"{', '.join(f'{w}×{h}' for w, h in sizes)} pixels; {frames} of the scene's animation at {one['frame_rate']:g} frames per second, " \
                f"after {one['warmup']} frames to warm up; {seeds} seed{'s' if seeds > 1 else ''}"
        if "reference" in one:
            text += f"; reference: {one['reference']['spp']} samples per pixel, depth {one['reference']['depth']}"
        fixed = {k: v for k, v in one["set"].items() if k not in one["varied"]}
        shared = {k: v for k, v in fixed.items() if all(j["set"].get(k) == v for j in jobs)}
        if shared:
            text += "; " + ", ".join(f"{k} = {v}" for k, v in shared.items())
        return text + ". The same for every graph."

    def cell(self, row, name, best, note):
        factor = MEASURES[name][1]
        number = lambda text: f"{factor * float(text):.3g}" if abs(factor * float(text)) < 1000 else f"{factor * float(text):.0f}"
        if not row or not row["mean"]:
            return "<td>-</td>"
        spread = lambda r: f" ± {number(r['half_width'])}" if float(r["half_width"] or 0) > 0 else ""
        bound = html.escape(row["bound"]) + " " if row.get("bound") else ""
        text = f"<span{' class=best' if best else ''}>{bound}{number(row['mean'])}</span><small>{spread(row)}</small>"
        if note and note["mean"]:
            text += f"<small>ours {'better' if float(note['mean']) > 0 else 'worse'} by {number(note['mean'].lstrip('-'))}{spread(note)}</small>"
        if row["paper"]:
            ratio = float(row["ratio"])
            text += f"<small>Paper {number(row['paper'])} (×{f'{ratio:.2g}' if ratio < 100 else f'{ratio:.0f}'})</small>"
        return f"<td>{text}</td>"

    @staticmethod
    def best(name, rows):
        """Of each scene and setting: the rows with the best mean, where there is something to compare."""
        groups = {}
        for r in rows:
            if r["measure"] == name and r["mean"] and name not in NEUTRAL:
                groups.setdefault(tuple(v for k, v in r.items() if k == "scene" or k not in CSV_COLUMNS), []).append(r)
        pick = max if name in HIGHER else min
        return [pick(g, key=lambda r: float(r["mean"])) for g in groups.values() if len(g) > 1]

    def table(self, sweep, axes, rows):
        names = [n for n in MEASURES if any(r["measure"] == n and r["mean"] for r in rows)]
        shown = [n for n in names if n not in NOTES.values()]
        best = {n: self.best(n, rows) for n in shown}
        keys = list(dict.fromkeys((r["scene"], r["graph"], *(r[a] for a in axes)) for r in rows))
        cells = {((r["scene"], r["graph"], *(r[a] for a in axes)), r["measure"]): r for r in rows}
        text = "<div class=grid><table class='num names'><tr><th>scene</th><th>graph</th>" + "".join(f"<th>{html.escape(a)}</th>" for a in axes)
        text += "".join(f"<th>{html.escape(MEASURES[n][0])}</th>" for n in shown) + "</tr>"
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
        return set(names)

    # ---- Plots

    def figure(self, name, title):
        plots = self.folder / "plots"
        plots.mkdir(exist_ok=True)
        memory = io.BytesIO()
        plt.tight_layout()
        plt.savefig(memory, format="png", dpi=110)
        plt.close()
        (plots / f"{name}.png").write_bytes(memory.getvalue())
        self.add(f"<figure><img src='{data_url(memory.getvalue())}' alt='{html.escape(title)}'><figcaption>{html.escape(title)}</figcaption></figure>")

    def line_plots(self, sweep, axis, rows, names):
        scenes = list(dict.fromkeys(r["scene"] for r in rows))
        for name in (n for n in names if n in ("error.fovea.mse", "error.periphery.mse", "temporal.fovea.mse_prime", "temporal.fovea.excess",
                                               "time.wall_ms")):
            plt.figure(figsize=(1 + 3.4 * len(scenes), 3.1))
            for i, scene in enumerate(scenes):
                plt.subplot(1, len(scenes), i + 1)
                for graph in dict.fromkeys(r["graph"] for r in rows):
                    points = [(self.number(r[axis]), MEASURES[name][1] * float(r["mean"])) for r in rows
                              if r["scene"] == scene and r["graph"] == graph and r["measure"] == name and r["mean"] and r[axis]]
                    if points:
                        plt.plot(*zip(*sorted(points)), marker="o", label=graph)
                plt.title(scene, fontsize=9)
                plt.xlabel(axis, fontsize=9)
                plt.ylim(bottom=min(0, plt.ylim()[0]))
                plt.legend(fontsize=7)
                if i == 0:
                    plt.ylabel(MEASURES[name][0], fontsize=9)
            self.figure(f"{sweep}-{axis}-{name}", f"{MEASURES[name][0]} over {axis}; lower is better")

    def time_plots(self, sweep, axes, rows, names):
        """Errors over the time of a frame: one curve a graph, each of whose points does another amount of work."""
        scenes, graphs = (list(dict.fromkeys(r[k] for r in rows)) for k in ("scene", "graph"))
        columns = min(3, len(scenes))
        for name in (n for n in names if n in ("error.fovea.mse", "error.periphery.mse", "temporal.fovea.excess")):
            plt.figure(figsize=(1 + 3.6 * columns, 3.2 * math.ceil(len(scenes) / columns)))
            for i, scene in enumerate(scenes):
                plt.subplot(math.ceil(len(scenes) / columns), columns, i + 1)
                for number, graph in enumerate(graphs):
                    found = {}  # in the order of the suite, so that a curve joins amounts of work that follow each other
                    for r in (r for r in rows if r["scene"] == scene and r["graph"] == graph and r["mean"]):
                        found.setdefault(tuple(r[a] for a in axes), {})[r["measure"]] = float(r["mean"])
                    points = [(v["time.wall_ms"], MEASURES[name][1] * v[name]) for v in found.values() if v.get(name, 0) > 0]
                    plt.loglog(*zip(*points or [(math.nan, math.nan)]), marker="o", markersize=4, label=graph, color=f"C{number}")
                plt.title(scene, fontsize=9)
                plt.xlabel(MEASURES["time.wall_ms"][0], fontsize=9)
                plt.grid(alpha=0.3, which="both")
                for axis in (plt.gca().xaxis, plt.gca().yaxis):
                    axis.set_major_locator(matplotlib.ticker.LogLocator(subs=(1, 2, 5)))
                    axis.set_major_formatter("{x:g}")
                    axis.set_minor_formatter("")
                if i % columns == 0:
                    plt.ylabel(MEASURES[name][0], fontsize=9)
                if i == 0:
                    plt.legend(fontsize=7)
            self.figure(f"{sweep}-time-{name}", f"{MEASURES[name][0]} over {MEASURES['time.wall_ms'][2]}; lower is better")

    @staticmethod
    def number(text):
        return float(text.split("x")[0])  # sizes: by width

    def bar_plots(self, sweep, rows, names):
        scenes, graphs = (list(dict.fromkeys(r[k] for r in rows)) for k in ("scene", "graph"))
        for name in (n for n in names if n in ("error.fovea.mse", "error.periphery.mse", "temporal.fovea.excess", "time.wall_ms")):
            plt.figure(figsize=(2 + 1.6 * len(scenes), 2.9))
            found = {(r["scene"], r["graph"]): r for r in rows if r["measure"] == name and r["mean"]}
            for i, graph in enumerate(graphs):
                xs = [s + (i - (len(graphs) - 1) / 2) * 0.8 / len(graphs) for s, scene in enumerate(scenes) if (scene, graph) in found]
                mine = [found[scene, graph] for scene in scenes if (scene, graph) in found]
                factor = MEASURES[name][1]
                spread = [factor * float(r["half_width"] or 0) if int(r["seeds"]) > 2 else 0 for r in mine]
                plt.bar(xs, [factor * float(r["mean"]) for r in mine], 0.8 / len(graphs), label=graph, yerr=spread if any(spread) else None, capsize=2)
            plt.xticks(range(len(scenes)), scenes, fontsize=8)
            plt.xlim(-0.6, len(scenes) - 0.4)
            plt.ylim(min(0, 1.2 * min(factor * float(r["mean"]) for r in found.values())), None)
            plt.ylabel(MEASURES[name][0], fontsize=9)
            plt.legend(fontsize=7)
            self.figure(f"{sweep}-{name}", f"{MEASURES[name][0]}; lower is better" +
                        ("; lines: 95% interval over seeds" if any(int(r["seeds"]) > 2 for r in found.values()) else ""))

    def step_plot(self, sweep, axes):
        """Stacked times of the passes, on the device or, for host passes, on the host."""
        bars, steps = {}, {}
        for r in self.results:
            job = r["job"]
            if job["sweep"] != sweep or job["seed"] != 1:
                continue
            label = "\n".join([job["scene"], job["label"], *(str(job["varied"].get(a, "")) for a in axes)])
            bars[label] = {p["name"]: max(p["gpu_ms"]["median"], p["cpu_ms"]["median"]) for p in r["time"]["passes"]}
        for times in bars.values():
            for step, ms in times.items():
                steps[step] = max(steps.get(step, 0), ms / max(sum(times.values()), 1e-9))
        head = "".join(f"<th>{html.escape(b)}</th>" for b in bars)
        rows = "".join(f"<tr><td>{html.escape(s)}</td>" + "".join(f"<td>{f'{t[s]:.3g}' if s in t else '-'}</td>" for t in bars.values()) + "</tr>" for s in steps)
        self.add(f"<p>Milliseconds of every pass, median over frames, on the device or, for passes that work there, on the host; seed 1.</p>"
                 f"<div class=grid><table class='num steps'><tr><th>pass</th>{head}</tr>{rows}</table></div>")
        shown = [s for s in steps if steps[s] > 0.02]
        plt.figure(figsize=(2.5 + 1.0 * len(bars), 4.2))
        bottom = [0.0] * len(bars)
        colours = plt.get_cmap("tab20").colors
        for i, step in enumerate([*shown, "others"]):
            heights = [t.get(step, 0) if step != "others" else sum(ms for s, ms in t.items() if s not in shown) for t in bars.values()]
            plt.bar(range(len(bars)), heights, 0.7, bottom=bottom, label=step, color=colours[i % 20])
            bottom = [b + h for b, h in zip(bottom, heights)]
        plt.xticks(range(len(bars)), bars, fontsize=7)
        plt.ylabel("ms per frame, by pass", fontsize=9)
        plt.legend(fontsize=7, bbox_to_anchor=(1, 1), loc="upper left")
        self.figure(f"{sweep}-steps", "time of every pass, median; seed 1")

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
            width = max(240, min(420, 1040 // len(labels)))
            discs = [r.get("error", {}).get("disc") for r in mine]
            rows = {"picture": [self.picture(n, width) for n in names],
                    "half of the fovea, enlarged": [self.picture(n, width, d) if d else "" for n, d in zip(names, discs)],
                    "error against the reference, its noise included; circle: fovea": [self.picture(n + "-error", width) for n in names],
                    "change between the last two frames that is not the reference's, its noise included": [self.picture(n + "-temporal", width) for n in names]}
            if disc:
                truths = [self.picture(names[0] + "-reference", width), self.picture(names[0] + "-reference", width, disc), "", ""]
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
        self.add(f"<h2>{html.escape(sweep)}</h2><p>{html.escape(self.settings(sweep))}</p>")
        names = self.table(sweep, axes, rows)
        ordered = [n for n in MEASURES if n in names]
        numeric = [a for a in axes if all(self.is_number(r[a]) for r in rows if r[a])]
        if len(axes) == 1 and numeric:
            self.line_plots(sweep, axes[0], rows, ordered)
        elif not axes:
            self.bar_plots(sweep, rows, ordered)
        elif self.each_has_an_axis_of_its_own(axes, rows):
            self.time_plots(sweep, axes, rows, ordered)
        if not any(n.startswith(("error", "temporal")) for n in names):
            self.step_plot(sweep, axes)
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

    def write(self):
        self.introduction()
        self.graphs()
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
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    Report(pathlib.Path(sys.argv[1])).write()
