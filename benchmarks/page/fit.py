"""How much of an error is bias, which more VPLs do not reduce: E(N) = b + v / N."""
from dataclasses import dataclass


@dataclass
class Fit:
    bias: float
    variance: float  # of one VPL

    def error(self, count):
        return self.bias + self.variance / count

    def share(self, count):
        """The part of the error with `count` VPLs that is bias."""
        return self.bias / self.error(count)

    def count_for(self, error):
        """The number of VPLs with which the error is `error`, or None where the bias alone is as large."""
        return self.variance / (error - self.bias) if error > self.bias else None


def fitted(points):
    """The fit of [(count, error)] by least squares of relative deviations, or None; neither part is negative.

    None if there are fewer than two counts, or if an error is not positive, so that it has no relative deviation.
    """
    if len({n for n, _ in points}) < 2 or any(e <= 0 for _, e in points):
        return None
    rows = [(1 / e, 1 / (n * e)) for n, e in points]  # times (b, v) should be 1
    aa, ab, bb = (sum(p * q for p, q in pairs) for pairs in (
        [(a, a) for a, _ in rows], rows, [(b, b) for _, b in rows]))
    a, b = sum(a for a, _ in rows), sum(b for _, b in rows)
    determinant = aa * bb - ab * ab
    bias, variance = (bb * a - ab * b) / determinant, (aa * b - ab * a) / determinant
    if bias < 0:
        bias, variance = 0, b / bb
    elif variance < 0:
        bias, variance = a / aa, 0
    return Fit(bias, variance)
