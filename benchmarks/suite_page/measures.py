"""What the numbers of a report are called, mean, and which way they are better."""
import math
from typing import NamedTuple

LOWER, HIGHER = "lower is better", "higher is better"
ONE = "close to 1 is better"
REFERENCE = "close to that of the reference is better"
NEITHER = "describes the scene, so that neither way is better"


class Measure(NamedTuple):
    heading: str
    factor: float  # of the number that is shown; the paper gives its errors times 1000
    better: str
    text: str


MEASURES = {
    "error.fovea.mse": Measure(
        "MSE fovea ×10⁻³", 1e3, LOWER,
        "mean square error of the displayed picture inside the foveal circle, reference noise subtracted"),
    "error.fovea.mse_over_ours": Measure(
        "more than ours ×10⁻³", 1e3, LOWER,
        "MSE in the fovea less that of ours, seed by seed: above its ±, ours is better"),
    "error.periphery.mse": Measure(
        "MSE periphery ×10⁻³", 1e3, LOWER,
        "the same outside it"),
    "error.light": Measure(
        "light", 1, ONE,
        "sum of the compared radiance over the whole picture, as a part of the reference's"),
    "error.fovea.relmse": Measure(
        "relMSE indirect fovea", 1, LOWER,
        "relative square error of the indirect radiance alone"),
    "error.periphery.relmse": Measure(
        "relMSE indirect periphery", 1, LOWER,
        "the same outside the fovea"),
    "error.fovea.flip": Measure(
        "FLIP fovea", 1, LOWER,
        "visible difference when one picture replaces the other, 0 to 1"),
    "error.fovea.blocks": Measure(
        "blocks fovea", 1, ONE,
        "how much more neighbouring pixels differ across the lines of lattices of 8 and 16 pixels than "
        "beside them, relative to the reference"),
    "error.periphery.blocks": Measure(
        "blocks periphery", 1, ONE,
        "the same outside the fovea"),
    "error.fovea.direct_floor": Measure(
        "direct floor fovea ×10⁻³", 1e3, NEITHER,
        "the MSE that would remain with perfect indirect light"),
    "temporal.fovea.mse_prime": Measure(
        "MSE' fovea ×10⁻³", 1e3, REFERENCE,
        "mean square change between consecutive frames (the paper's Eq. 4); contains the scene's own "
        "motion"),
    "temporal.fovea.reference_mse_prime": Measure(
        "MSE' fovea of the reference ×10⁻³", 1e3, NEITHER,
        "the same of the reference, less its noise: the scene's motion alone"),
    "temporal.periphery.mse_prime": Measure(
        "MSE' periphery ×10⁻³", 1e3, REFERENCE,
        "the same outside the fovea"),
    "temporal.periphery.reference_mse_prime": Measure(
        "MSE' periphery of the reference ×10⁻³", 1e3, NEITHER,
        "of the reference, outside the fovea"),
    "temporal.fovea.excess": Measure(
        "excess fovea ×10⁻³", 1e3, LOWER,
        "mean square of (change of the sequence - change of the reference): flicker without the scene's "
        "motion"),
    "temporal.fovea.excess_over_ours": Measure(
        "excess more than ours ×10⁻³", 1e3, LOWER,
        "excess in the fovea less that of ours, seed by seed"),
    "temporal.periphery.excess": Measure(
        "excess periphery ×10⁻³", 1e3, LOWER,
        "the same outside the fovea"),
    "temporal.fovea.mse": Measure(
        "MSE fovea, all frames ×10⁻³", 1e3, LOWER,
        "mean over the frames of the sequence"),
    "eyes.fovea.excess": Measure(
        "eyes excess fovea ×10⁻³", 1e3, LOWER,
        "mean square of (difference of the eyes - that of the reference's) beyond parallax, reference noise "
        "subtracted"),
    "eyes.periphery.excess": Measure(
        "eyes excess periphery ×10⁻³", 1e3, LOWER,
        "the same outside the fovea of the left eye"),
    "eyes.fovea.flicker": Measure(
        "eyes flicker fovea ×10⁻³", 1e3, LOWER,
        "mean square of the change of that difference from frame to frame, less that of the reference"),
    "eyes.periphery.flicker": Measure(
        "eyes flicker periphery ×10⁻³", 1e3, LOWER,
        "the same outside the fovea of the left eye"),
    "eyes.whole.share": Measure(
        "both eyes see", 1, NEITHER,
        "share of the left eye's pixels whose surface the right one sees, too"),
    "time.wall_ms": Measure(
        "frame ms", 1, LOWER,
        "wall time of a frame, median"),
    "speed_up.ir_1000": Measure(
        "speed-up over ir_1000", 1, HIGHER,
        "frame time of ir_1000 / of this graph"),
    "speed_up.ir_eq": Measure(
        "speed-up over ir_eq", 1, HIGHER,
        "frame time of instant radiosity with as small a foveal error / of this graph"),
    "match.value": Measure(
        "N of ir_eq", 1, HIGHER,
        "VPLs with which instant radiosity reaches the foveal error of ours, by bisection"),
    "second_eye.ms": Measure(
        "second eye ms", 1, LOWER,
        "passes of the second eye"),
    "second_eye.of_first": Measure(
        "second eye / first", 1, LOWER,
        "passes of the second eye over all others: the first eye's whole frame"),
    "second_eye.new_pixels": Measure(
        "new pixels", 1, NEITHER,
        "share of the second eye's pixels that the first one has not seen"),
}
# These measures are shown in the cell of another one.
NOTES = {"error.fovea.mse": "error.fovea.mse_over_ours", "temporal.fovea.excess": "temporal.fovea.excess_over_ours"}


def badness(name, row, others):
    """How far a value is from the best possible one; None where neither way is better.

    row: that of the table with the value; others: the values of the other measures of the same scene, graph and setting.
    """
    value, better = float(row["mean"]), MEASURES[name].better
    if better == LOWER:
        return value
    if better == HIGHER:
        return -value
    if better == ONE:
        return abs(math.log(value)) if value > 0 else math.inf
    if better == REFERENCE:
        reference = others.get(name.replace("mse_prime", "reference_mse_prime"))
        return None if reference is None else abs(value - reference)
    return None


def number(name, text):
    """A value of the table as it is shown, with three digits."""
    return digits(MEASURES[name].factor * float(text))


def digits(value, count=3):
    """A value with so many digits, or all of its whole number: never as 1.2e+03."""
    return f"{value:.{count}g}" if abs(value) < 10**count - 0.5 else f"{value:.0f}"
