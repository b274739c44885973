"""Measured reasons why an error is not lower: how much of it is bias, and how much is that of the direct light."""
from .fit import fitted
from .steps import STEPS, mean_steps
from .sweeps import COUNTS, SEQUENCES, STILLS, TIMES
from .text import short

FIT_TITLE = "Figure 5: error over the size of maps, the number of VPLs and the size of the fovea"  # has the fits
MUCH = 0.5  # a reason is given from this share on


def fit_of(results, scene, graph, measure):
    """E(N) = b + v / N over the numbers of VPLs, or None."""
    points = []
    for count in results.values(COUNTS, "vpl_count"):
        error = results.mean(COUNTS, scene, graph, measure, vpl_count=count)
        if error is not None:
            points.append((float(count), error))
    return fitted(points)


def of_error(results):
    """A function of a scene that says why the foveal error of `ours` is not lower there, or ""."""
    def reason(scene):
        parts = []
        fit = fit_of(results, scene, "ours", "error.fovea.mse")
        if fit and fit.share(1000) >= MUCH:
            parts.append(f"{fit.share(1000):.0%} of the error of `ours` with 1000 VPLs is bias, "
                         "which more VPLs do not reduce")
        error, floor = (results.mean(STILLS, scene, "ours", f"error.fovea.{m}") for m in ("mse", "direct_floor"))
        if error and floor and floor / error >= MUCH:
            parts.append(f"direct light alone has {floor / error:.0%} of the error")
        light = results.mean(STILLS, scene, "ours", "error.indirect_light")
        if light is not None and abs(light - 1) > 0.1:
            parts.append(f"`ours` has {short(light)} of the indirect light of the reference")
        return f"In `{scene}`, {', and '.join(parts)}." if parts else ""
    return reason


def of_change(results, scene):
    """How much of MSE' of `ours` is the motion of the scene, which every method has."""
    change, motion = (results.mean(SEQUENCES, scene, "ours", f"temporal.fovea.{m}")
                      for m in ("mse_prime", "reference_mse_prime"))
    if not change or not motion or motion / change < MUCH:
        return ""
    return (f"In `{scene}`, MSE' of the reference, the motion of the scene alone, is {motion / change:.0%} of that of "
            "`ours`.")


def of_flicker(results, scene):
    """Whether the noise of the reference is as large as the excess that was measured."""
    excess, noise = (results.mean(SEQUENCES, scene, "ours", f"temporal.fovea.{m}")
                     for m in ("excess", "excess_noise_floor"))
    if not excess or not noise or noise / excess < MUCH:
        return ""
    return (f"In `{scene}`, the noise of the reference, which was subtracted, is {noise / excess:.0%} of the excess of "
            "`ours`, so small differences say little.")


def of_time(results, scene):
    """Which steps a frame of `ours` spends most of its time in."""
    steps = mean_steps(results, TIMES, scene, "ours")
    whole = sum(steps.values())
    if not whole:
        return ""
    most = sorted(steps, key=steps.get, reverse=True)[:2]
    return f"In `{scene}`, a frame of `ours` spends " + " and ".join(
        f"{steps[step] / whole:.0%} of its time in {step}" for step in most) + "."


def of_generation(results, scene):
    """How much of the time to generate VPLs are voxels and their light."""
    steps = mean_steps(results, TIMES, scene, "ours")
    voxels, others = steps.get("voxels and their light", 0), (steps.get(s, 0) for s in list(STEPS)[1:3])
    whole = voxels + sum(others)
    return f"In `{scene}`, {voxels / whole:.0%} of that time are voxels and their light." if whole else ""
