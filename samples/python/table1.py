# %% [markdown]
# # A row of the paper's Table 1
#
# The error of four methods in the Cornell box, inside and outside the fovea, beside the paper's own numbers. The paper
# rendered 1024×1024 pixels with 1000 VPLs; with fewer of both, the order of the methods is what to look at.

# %% Parameters
SIZE = (256, 256)
VPLS = 1000
SEEDS = 3
SAMPLES = 512  # of the reference, per pixel
WARMUP = 12    # frames before the one that is measured
DETAIL: dict[str, int] = {}  # sizes of shadow maps and voxels, where they are not those of the graph

# %% The paper's numbers: MSE of what is displayed.
import statistics

import fovea

PAPER = {"ir_1000": (0.00161, 0.00159), "ir_v": (0.00247, 0.00336), "ours_r": (0.00092, 0.00207),
         "ours": (0.00074, 0.00112)}

# %% Ours.
scene = fovea.load_scene("cornellbox")
reference = fovea.reference(scene, size=SIZE, spp=SAMPLES, seed=4711, index=WARMUP)
measured: dict[str, tuple[float, float]] = {}
for graph in PAPER:
    found = []
    for seed in range(1, SEEDS + 1):
        renderer = fovea.Renderer(graph, scene, size=SIZE, seed=seed, set={**DETAIL, "vpl_count": VPLS})
        for _ in range(WARMUP):
            renderer.frame(read=False)
        found.append(fovea.compare(renderer.frame(), reference, gaze=(0.42, 0.55), exposure=scene.exposure))
    measured[graph] = (statistics.mean(m["fovea"]["mse"] for m in found),
                       statistics.mean(m["periphery"]["mse"] for m in found))

# %% The row.
print(f"{'method':<10} {'fovea':>10} {'paper':>10} {'periphery':>10} {'paper':>10}")
for graph, (fovea_error, outside) in measured.items():
    print(f"{graph:<10} {fovea_error:>10.5f} {PAPER[graph][0]:>10.5f} {outside:>10.5f} {PAPER[graph][1]:>10.5f}")
