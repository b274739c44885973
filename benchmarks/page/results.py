"""The results of a suite by sweep, scene, graph and seed, beside the paper's numbers."""
import json
import math
import pathlib

# 97.5% points of Student's t distribution for 1, 2, .. degrees of freedom.
STUDENT = (12.706, 4.303, 3.182, 2.776, 2.571, 2.447, 2.365, 2.306, 2.262, 2.228)


def mean_of(values):
    """Mean and half the width of its 95% interval, which is NaN for fewer than two values."""
    values = list(values)
    mean = sum(values) / len(values)
    if len(values) < 2:
        return mean, math.nan
    freedom = len(values) - 1
    t = STUDENT[freedom - 1] if freedom <= len(STUDENT) else 1.96 + 2.5 / freedom
    return mean, t * math.sqrt(sum((v - mean) ** 2 for v in values) / freedom / len(values))


def numbers_of(result):
    """Every number of a result by its name, as in the tables of the suite."""
    numbers = {}
    for part in ("error", "temporal"):
        for region, measures in result.get(part, {}).items():
            if isinstance(measures, dict):
                numbers.update({f"{part}.{region}.{name}": value for name, value in measures.items()})
            else:
                numbers[f"{part}.{region}"] = measures
    if "match" in result:
        numbers["match.value"] = result["match"]["value"]
    time = result.get("time", {})
    numbers.update({f"time.{name}": spread["median"] for name, spread in time.get("frame", {}).items()})
    for name, ms in pass_times(result).items():
        numbers[f"pass.{name}"] = ms
    numbers.update({f"counter.{name}": value for name, value in time.get("counters", {}).items()})
    numbers.update({f"second_eye.{name}": value for name, value in time.get("second_eye", {}).items()})
    return {name: value for name, value in numbers.items() if isinstance(value, (int, float))}


def pass_times(result):
    """Milliseconds of every pass: on the device or, for passes that work there, on the host."""
    passes = result.get("time", {}).get("passes", [])
    return {p["name"]: max(p["gpu_ms"]["median"], p["cpu_ms"]["median"]) for p in passes}


def match_bound(result):
    """`>` or `<` if the number that a search looked for lies beyond its range, else ""."""
    match = result.get("match", {})
    if not match.get("reached", True):
        return ">"
    return "<" if len(match.get("steps", [])) == 1 else ""


class Results:
    def __init__(self, head, results, folder):
        self.head, self.all, self.folder = head, results, pathlib.Path(folder)
        file = pathlib.Path(__file__).resolve().parent.parent / "paper.json"
        self.published = json.loads(file.read_text())
        self.numbers = {id(r): numbers_of(r) for r in results}

    def select(self, sweep, scene=None, graph=None, **varied):
        """Results of a sweep; `varied` are values of its parameters, as in the names of jobs."""
        wanted = {k: str(v) for k, v in varied.items()}
        return [r for r in self.all if r["job"]["sweep"] == sweep
                and scene in (None, r["job"]["scene"]) and graph in (None, r["job"]["label"])
                and all(r["job"]["varied"].get(k) == v for k, v in wanted.items())]

    def scenes(self, *sweeps):
        return list(dict.fromkeys(r["job"]["scene"] for r in self.all if r["job"]["sweep"] in sweeps))

    def values(self, sweep, axis):
        """The values of a parameter in a sweep, in rising order."""
        found = {r["job"]["varied"][axis] for r in self.select(sweep) if axis in r["job"]["varied"]}
        return sorted(found, key=float)

    def seeds(self, sweep, scene, graph, measure, **varied):
        """seed -> number, of the results that have it."""
        found = {r["job"]["seed"]: self.numbers[id(r)].get(measure)
                 for r in self.select(sweep, scene, graph, **varied)}
        return {seed: value for seed, value in found.items() if value is not None}

    def mean(self, *where, **varied):
        """Mean over seeds, or None."""
        seeds = self.seeds(*where, **varied)
        return mean_of(seeds.values())[0] if seeds else None

    def paper_scene(self, scene):
        return self.published["scenes"].get(scene, "")

    def paper(self, table, scene, graph, measure):
        """The paper's number, or None."""
        of_scene = self.published["tables"].get(table, {}).get(self.paper_scene(scene), {})
        return of_scene.get(graph, {}).get(measure)

    def published_range(self, table, graph, measure):
        """The least and the largest of the paper's numbers over its scenes."""
        scenes = self.published["tables"][table].values()
        found = [s[graph][measure] for s in scenes if measure in s.get(graph, {})]
        return min(found), max(found)

    # ---- What the results were made with

    def devices(self):
        return sorted({r["made_with"]["device"] for r in self.all})

    def commits(self):
        return sorted({r.get("commit") or "unknown" for r in self.all})

    def on_processor(self):
        return any("llvmpipe" in device for device in self.devices())
