"""Two runs of a suite compared: what has changed, and whether by more than seeds differ."""
import math

from .measures import MEASURES, badness

BETTER, WORSE, SAME, OTHER = "better", "worse", "same", "other"


def by_key(rows, axes):
    return {(r["scene"], r["graph"], *(r.get(a, "") for a in axes), r["measure"]): r for r in rows if r["mean"]}


def verdict(name, before, after, others_before, others_after):
    """Whether `after` is better, where the intervals of the two means do not overlap."""
    apart = abs(float(after["mean"]) - float(before["mean"]))
    if apart <= math.hypot(float(before["half_width"] or 0), float(after["half_width"] or 0)):
        return SAME
    was, now = badness(name, before, others_before), badness(name, after, others_after)
    if was is None or now is None:
        return OTHER
    return BETTER if now < was else WORSE


def changes(before, after, axes):
    """(key, measure, row before, row after, verdict) of what both runs have measured."""
    old, new = by_key(before, axes), by_key(after, axes)

    def others(rows, key):
        return {k[-1]: float(r["mean"]) for k, r in rows.items() if k[:-1] == key}

    return [(key[:-1], key[-1], old[key], row,
             verdict(key[-1], old[key], row, others(old, key[:-1]), others(new, key[:-1])))
            for key, row in new.items() if key in old and key[-1] in MEASURES]
