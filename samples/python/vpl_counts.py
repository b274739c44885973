# %% [markdown]
# # How many virtual point lights does a picture need?
#
# The error of two strategies over the number of their VPLs. Each point is a mean over seeds, with the 95% interval of
# that mean, as one seed says little about a method that chooses lights at random.

# %% Parameters
SIZE = (128, 128)
COUNTS = [60, 125, 250, 500]
SEEDS = 8
SAMPLES = 256  # of the reference, per pixel
WARMUP = 8     # frames before the one that is measured
DETAIL: dict[str, int] = {}  # sizes of shadow maps and voxels, where they are not those of the graph
PICTURE = "vpl_counts.png"

# %% The reference is path traced once.
import math
import statistics

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt

import fovea

SCENE = fovea.load_scene("cornellbox")
GAZE = (0.42, 0.55)
reference = fovea.reference(SCENE, size=SIZE, spp=SAMPLES, seed=4711, index=WARMUP)

# %% A strategy is a graph or a parameter. Another number of VPLs is set between frames, which compiles nothing anew; frame
# 0 begins history anew.
STRATEGIES: dict[str, tuple[str, dict[str, fovea.Value]]] = {
    "ir_1000": ("ir_1000", {}),
    "ir_1000, discs": ("ir_1000", {"kernel": "disc"}),
    "ours": ("ours", {}),
}


def errors(graph: str, settings: dict[str, fovea.Value], seed: int) -> list[float]:
    """The error in the fovea for each number of VPLs, times 1000."""
    renderer = fovea.Renderer(graph, SCENE, size=SIZE, seed=seed, set={**DETAIL, **settings})
    found = []
    for count in COUNTS:
        renderer.set("vpl_count", count)
        for index in range(WARMUP):
            renderer.frame(index, gaze=GAZE, read=False)
        measures = fovea.compare(renderer.frame(gaze=GAZE), reference, gaze=GAZE, exposure=SCENE.exposure)
        found.append(1000 * measures["fovea"]["mse"])
    return found


# %% Student's t for the interval of a mean of so few values.
T = {2: 12.71, 3: 4.30, 4: 3.18, 5: 2.78, 6: 2.57, 7: 2.45, 8: 2.36}
figure, axes = plt.subplots(figsize=(6, 4))
for name, (graph, settings) in STRATEGIES.items():
    series = list(zip(*(errors(graph, settings, seed) for seed in range(1, SEEDS + 1))))
    means = [statistics.mean(values) for values in series]
    widths = [T[SEEDS] * statistics.stdev(values) / math.sqrt(SEEDS) for values in series]
    axes.errorbar(COUNTS, means, widths, label=name, capsize=3, marker="o")
    print(name, ", ".join(f"{count}: {m:.2f} ± {w:.2f}" for count, m, w in zip(COUNTS, means, widths)))
axes.set(xscale="log", yscale="log", xlabel="VPLs", ylabel="error in the fovea, MSE × 1000", xticks=COUNTS,
         xticklabels=[str(count) for count in COUNTS], yticks=[0.2, 0.3, 0.5, 1, 2, 3, 5])
axes.yaxis.set_major_formatter("{x:g}")
axes.minorticks_off()
axes.legend()
figure.savefig(PICTURE, dpi=100, bbox_inches="tight")
