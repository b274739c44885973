"""The steps of a frame, and the time that each takes."""
from .results import mean_of, pass_times

# Steps of a frame and the passes that belong to them. All other passes draw the scene and its direct light.
STEPS = {
    "voxels and their light": ("voxelize", "light-inject", "mipmap"),
    "generation of VPLs": ("emit", "candidates", "radiance", "vpl-origins", "vpl-intensity"),
    "management of VPLs": ("weight-map", "vpl-motion", "importance", "manage"),
    "shadow maps of VPLs": ("shadow-atlas",),
    "shading by VPLs": ("deferred", "near-field", "near-field-mean"),
}
SCENE = "scene and direct light"


def steps_of(result):
    """Milliseconds of each step of a frame."""
    found = dict.fromkeys([*STEPS, SCENE], 0.0)
    for name, ms in pass_times(result).items():
        found[next((step for step, names in STEPS.items() if name in names), SCENE)] += ms
    return found


def mean_steps(results, sweep, scene, graph):
    """The mean over seeds of each step, or {}."""
    found = [steps_of(r) for r in results.select(sweep, scene, graph)]
    return {step: mean_of(f[step] for f in found)[0] for step in found[0]} if found else {}
