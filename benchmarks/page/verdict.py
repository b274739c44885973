"""Whether claims of the paper hold here, decided from numbers alone."""
from dataclasses import dataclass, field

from .results import mean_of

HOLDS, FAILS, UNDECIDED, MISSING = "holds", "does not hold", "undecided", "not measured yet"


@dataclass
class Claim:
    """One statement of the paper, and what the numbers here say of it."""
    text: str
    verdict: str
    sentence: str


@dataclass
class Entry:
    """A table, a figure or a statement in prose: what the page shows of it."""
    title: str
    blocks: list = field(default_factory=list)  # of Markdown
    claims: list = field(default_factory=list)

    def add(self, block):
        self.blocks.append(block)

    def missing(self, what):
        self.add(f"**{what}: {MISSING}.**")


def is_less(small, large, factor=1):
    """Whether `small` is less than `factor` times `large`, both seed -> number.

    None if they cannot be told apart: the 95% interval of the differences, seed by seed, contains 0. A single seed has
    no interval and decides by itself.
    """
    common = sorted(set(small) & set(large))
    if not common:
        raise ValueError("no seed in common")
    mean, half = mean_of(factor * large[s] - small[s] for s in common)
    if half == half and abs(mean) <= half:
        return None
    return mean > 0


def is_at_least(values, limit):
    """The same for seed -> number and a number."""
    mean, half = mean_of(values.values())
    if half == half and abs(mean - limit) <= half:
        return None
    return mean >= limit


def all_of(outcomes):
    """True if all are, False if one is False, None if that is open."""
    outcomes = list(outcomes)
    if any(o is False for o in outcomes):
        return False
    return None if any(o is None for o in outcomes) else True


def listed(names):
    names = [f"`{n}`" for n in names]
    return ", ".join(names[:-1]) + " and " + names[-1] if len(names) > 1 else "".join(names)


def claim(text, outcomes, detail="", reason=""):
    """A claim about every scene, from scene -> True, False or None (undecided).

    detail: numbers that belong into the sentence; reason: a function of a scene that gives a measured reason why the
    claim fails there, or "".
    """
    if not outcomes:
        return Claim(text, MISSING, f"{text}: {MISSING}.")
    kinds = {kind: [s for s, o in outcomes.items() if o is kind] for kind in (True, False, None)}
    parts = []
    if kinds[True]:
        parts.append(f"it holds in {listed(kinds[True])}")
    if kinds[False]:
        parts.append(f"it does not in {listed(kinds[False])}")
    if kinds[None]:
        parts.append(f"the measurements leave it open in {listed(kinds[None])}")
    verdict = FAILS if kinds[False] else UNDECIDED if kinds[None] else HOLDS
    head = {FAILS: "**Does not hold here**", UNDECIDED: "**Undecided**", HOLDS: "**Holds here**"}[verdict]
    sentence = f"{text}. {head}: {'; '.join(parts)}{f' ({detail})' if detail else ''}."
    reasons = [why for why in map(reason, kinds[False]) if why] if reason else []
    return Claim(text, verdict, " ".join([sentence, *reasons]))
