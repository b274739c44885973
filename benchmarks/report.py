#!/usr/bin/env python3
"""One self-contained page from the results of `fovea bench`: tables beside the paper's numbers, plots, pictures, error pictures, zooms.

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
    "error.fovea.relmse": ("relMSE indirect fovea", 1, "relative square error of the indirect radiance alone"),
    "error.periphery.relmse": ("relMSE indirect periphery", 1, "the same outside the fovea"),
    "error.fovea.flip": ("FLIP fovea", 1, "visible difference when one picture replaces the other, 0 to 1"),
    "error.fovea.direct_floor": ("direct floor fovea ×10⁻³", 1e3, "the MSE that would remain with perfect indirect light"),
    "temporal.fovea.mse_prime": ("MSE' fovea ×10⁻³", 1e3, "mean square change between consecutive frames (the paper's Eq. 4); contains the scene's own motion"),
    "temporal.periphery.mse_prime": ("MSE' periphery ×10⁻³", 1e3, "the same outside the fovea"),
    "temporal.fovea.excess": ("excess fovea ×10⁻³", 1e3, "mean square of (change of the sequence - change of the reference): flicker without the scene's motion"),
    "temporal.fovea.excess_over_ours": ("excess more than ours ×10⁻³", 1e3, "excess in the fovea less that of ours, seed by seed"),
    "temporal.periphery.excess": ("excess periphery ×10⁻³", 1e3, "the same outside the fovea"),
    "temporal.fovea.mse": ("MSE fovea, all frames ×10⁻³", 1e3, "mean over the frames of the sequence"),
    "time.wall_ms": ("frame ms", 1, "wall time of a frame, median"),
    "speed_up.ir_1000": ("speed-up over ir_1000", 1, "frame time of ir_1000 / of this graph"),
    "speed_up.ir_eq": ("speed-up over ir_eq", 1, "frame time of instant radiosity with as small a foveal error / of this graph"),
    "match.value": ("N of ir_eq", 1, "VPLs with which instant radiosity reaches the foveal error of ours, by bisection"),
    "second_eye.ms": ("second eye ms", 1, "passes of the second eye"),
    "second_eye.new_pixels": ("new pixels", 1, "share of the second eye's pixels that the first one has not seen"),
}
STYLE = """body{font:15px/1.5 system-ui,sans-serif;margin:2em auto;max-width:1180px;padding:0 1em;color:#1b1b1f}
table{border-collapse:collapse;margin:1em 0;font-size:13px}th,td{border-bottom:1px solid #ddd;padding:.3em .7em;text-align:right;vertical-align:top}
th{background:#f3f3f6}td:first-child,td:nth-child(2),th:first-child,th:nth-child(2){text-align:left}small{color:#667;display:block}
figure{display:inline-block;margin:.4em;vertical-align:top}figcaption{font-size:12px;color:#556;max-width:256px}.pixels{image-rendering:pixelated}
img{max-width:100%}.grid{overflow-x:auto;white-space:nowrap}.warn{background:#fff3d6;padding:.6em 1em;border-radius:6px}code{background:#f3f3f6;padding:0 .3em}"""


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
            ". This is lavapipe, Vulkan in software on the processor: its absolute times say nothing about a graphics card, "
            "ratios between methods say little; errors and counters are the same everywhere." if cpu else ".") +
            f"<br>Built from commit {html.escape(', '.join(commits))}, version {html.escape(first['version'])}; "
            f"{len(self.results)} of {self.head['jobs']} jobs measured, {sum(r.get('seconds', 0) for r in self.results) / 60:.1f} minutes of work.</p>")
        for scene, why in self.head["missing_scenes"].items():
            self.add(f"<p class=warn>Scene <b>{html.escape(scene)}</b> was left out: {html.escape(why)}</p>")
        if len(self.results) < self.head["jobs"]:
            self.add("<p class=warn>Not every job has a result yet: means are over what is there.</p>")

    def explanation(self, names):
        rows = "".join(f"<tr><td>{html.escape(MEASURES[n][0])}</td><td style='text-align:left'>{html.escape(MEASURES[n][2])}</td></tr>"
                       for n in MEASURES if n in names)
        self.add("<h2>What the numbers mean</h2><p>Displayed picture: sRGB(clamp(exposure × radiance)). The fovea is a circle around where the "
                 "eye looks; references are path-traced, and their own noise is measured from two halves and subtracted, which can leave a "
                 "small error slightly below 0. <b>±</b>: half width of the 95% interval over seeds. <i>Paper</i>: the paper's number, with "
                 "ours ÷ the paper's in brackets; its models, camera paths and machine (RTX 2080 Ti, 1024×1024) are others.</p>"
                 f"<table>{rows}</table>")

    # ---- Tables

    def rows(self, sweep):
        with open(self.folder / "tables" / f"{sweep}.csv", newline="") as file:
            return list(csv.DictReader(file))

    def settings(self, sweep):
        jobs = [r["job"] for r in self.results if r["job"]["sweep"] == sweep]
        one = jobs[0]
        sizes = sorted({tuple(j["size"]) for j in jobs})
        text = f"{', '.join(f'{w}×{h}' for w, h in sizes)} pixels; {one['frames']} frame{'s' if one['frames'] > 1 else ''} from number {one['first']}, " \
               f"after {one['warmup']} to warm up; {len({j['seed'] for j in jobs})} seed(s)"
        if "reference" in one:
            text += f"; reference: {one['reference']['spp']} samples a pixel, depth {one['reference']['depth']}"
        fixed = {k: v for k, v in one["set"].items() if k not in one["varied"]}
        if fixed:
            text += "; " + ", ".join(f"{k} = {v}" for k, v in fixed.items())
        return text + ". The same for every graph."

    def cell(self, row, name):
        factor = MEASURES[name][1]
        number = lambda text: f"{factor * float(text):.3g}" if abs(factor * float(text)) < 1000 else f"{factor * float(text):.0f}"
        if not row or not row["mean"]:
            return "<td>-</td>"
        text = number(row["mean"]) + (f" ± {number(row['half_width'])}" if row["half_width"] else "")
        if row["paper"]:
            text += f"<small>Paper {number(row['paper'])} (×{float(row['ratio']):.2g})</small>"
        return f"<td>{text}</td>"

    def table(self, sweep, axes, rows):
        names = [n for n in MEASURES if any(r["measure"] == n for r in rows)]
        keys = list(dict.fromkeys((r["scene"], r["graph"], *(r[a] for a in axes)) for r in rows))
        cells = {((r["scene"], r["graph"], *(r[a] for a in axes)), r["measure"]): r for r in rows}
        text = "<div class=grid><table><tr><th>scene</th><th>graph</th>" + "".join(f"<th>{html.escape(a)}</th>" for a in axes)
        text += "".join(f"<th>{html.escape(MEASURES[n][0])}</th>" for n in names) + "</tr>"
        for key in keys:
            paper = self.paper_name(key[0])
            text += f"<tr><td>{html.escape(key[0])}" + (f"<small>paper: {html.escape(paper)}</small>" if self.head["paper"] and paper else "") + "</td>"
            text += "".join(f"<td>{html.escape(k)}</td>" for k in key[1:])
            text += "".join(self.cell(cells.get((key, n)), n) for n in names) + "</tr>"
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
        self.add(f"<figure><img src='{data_url(memory.getvalue())}' alt='{html.escape(title)}'></figure>")

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
            self.figure(f"{sweep}-{axis}-{name}", f"{MEASURES[name][0]} over {axis}")

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
                plt.bar(xs, [factor * float(r["mean"]) for r in mine], 0.8 / len(graphs), label=graph,
                        yerr=[factor * float(r["half_width"] or 0) for r in mine], capsize=2)
            plt.xticks(range(len(scenes)), scenes, fontsize=8)
            plt.ylabel(MEASURES[name][0], fontsize=9)
            plt.legend(fontsize=7)
            self.figure(f"{sweep}-{name}", MEASURES[name][0])

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
        shown = [s for s in steps if steps[s] > 0.02]
        plt.figure(figsize=(2.5 + 1.0 * len(bars), 4.2))
        bottom = [0.0] * len(bars)
        colours = plt.get_cmap("tab20").colors
        for i, step in enumerate([*shown, "others"]):
            heights = [t.get(step, 0) if step != "others" else sum(ms for s, ms in t.items() if s not in shown) for t in bars.values()]
            plt.bar(range(len(bars)), heights, 0.7, bottom=bottom, label=step, color=colours[i % 20])
            bottom = [b + h for b, h in zip(bottom, heights)]
        plt.xticks(range(len(bars)), bars, fontsize=7)
        plt.ylabel("ms a frame, by pass", fontsize=9)
        plt.legend(fontsize=7, bbox_to_anchor=(1, 1), loc="upper left")
        self.figure(f"{sweep}-steps", "time of every pass")

    # ---- Pictures

    def picture(self, name, caption, zoom=None):
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
        return f"<figure><img class=pixels width=256 src='{data_url(data)}' alt='{html.escape(caption)}'><figcaption>{html.escape(caption)}</figcaption></figure>"

    def pictures(self, sweep):
        jobs = [r for r in self.results if r["job"]["sweep"] == sweep and r["job"]["seed"] == 1 and "pictures" in r["job"]["measures"]]
        for scene in dict.fromkeys(r["job"]["scene"] for r in jobs):
            mine = [r for r in jobs if r["job"]["scene"] == scene]
            self.add(f"<h4>{html.escape(scene)}</h4>")
            rows = {"": "", "-error": "", "zoom": "", "-temporal": ""}
            for r in mine:
                job = r["job"]
                name = f"{sweep}-{pathlib.Path(scene).stem}-{job['label']}" + "".join(f"-{k}={v}" for k, v in job["varied"].items()) + "-s1"
                name = name.replace("/", "_").replace(" ", "_")
                label = " ".join([job["label"], *(f"{k} = {v}" for k, v in job["varied"].items())])
                disc = r.get("error", {}).get("disc")
                if r is mine[0]:
                    rows[""] += self.picture(name + "-reference", "reference")
                    if disc:
                        rows["zoom"] += self.picture(name + "-reference", "reference, where the eye looks", disc)
                rows[""] += self.picture(name, label)
                if disc:
                    rows["zoom"] += self.picture(name, label + ", where the eye looks", disc)
                rows["-error"] += self.picture(name + "-error", label + ": error (scale below), circle: fovea")
                rows["-temporal"] += self.picture(name + "-temporal", label + ": change that is not the reference's, last two frames")
            for text in rows.values():
                if text:
                    self.add(f"<div class=grid>{text}</div>")

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
        if not any(n.startswith(("error", "temporal")) for n in names):
            self.step_plot(sweep, axes)
        self.pictures(sweep)
        return names

    def is_number(self, text):
        try:
            return math.isfinite(self.number(text))
        except ValueError:
            return False

    def write(self):
        self.introduction()
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
