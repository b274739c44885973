"""Numbers and tables as Markdown."""
import re

from .results import mean_of


def anchor(title):
    """What a link to a heading ends with."""
    return "#" + re.sub(r"[^\w\- ]", "", title.lower()).replace(" ", "-")


def short(value):
    """Three significant digits, without an exponent for what tables hold."""
    if value is None:
        return "-"
    if abs(value) >= 1000:
        return f"{value:.0f}"
    return f"{value:.3g}" if abs(value) >= 1e-3 or value == 0 else f"{value:.1e}"


def spread(seeds, factor=1):
    """Mean over seeds with half the 95% interval, if there is more than one: "2.57 ± 0.09"."""
    if not seeds:
        return "-"
    mean, half = mean_of(factor * v for v in seeds.values())
    return short(mean) + (f" ± {short(half)}" if half == half else "")


def table(head, rows):
    """A table, or "" without rows."""
    if not rows:
        return ""
    lines = [f"| {' | '.join(head)} |", f"|{'---|' * len(head)}"]
    return "\n".join(lines + [f"| {' | '.join(map(str, row))} |" for row in rows])


def beside(mine, published):
    """Our number and, in brackets, the paper's."""
    return mine if published is None else f"{mine} ({short(published)})"


def one_or_many(count, noun):
    return f"{count} {noun}{'' if count == 1 else 's'}"
