"""From evidence to what is told: the class that is named, candidates with sizes, a sentence."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from bondgraph.runtime.monitoring.isolation import Explained, probabilities
from bondgraph.runtime.monitoring.verdict import Candidate, Verdict, described

_SURE = 0.75  # probability from which on a class is named
_SHOWN = 0.02  # probability from which on a candidate is worth telling
_EXPLAINS = 0.7  # share of the misfit that a single fault has to take away


def named(
    found: Sequence[Explained], groups: Sequence[tuple[str, ...]]
) -> tuple[tuple[str, ...], tuple[str, ...]]:
    """The class that the evidence is sure of, () if of none, and the one that leads."""
    chance = probabilities(found)
    classes = {g: sum(chance.get(f, 0.0) for f in g) for g in groups}
    leads = max(classes, key=lambda g: classes[g], default=())
    sure = classes.get(leads, 0.0) >= _SURE and _best(found).share >= _EXPLAINS
    return (leads if sure else ()), leads


def update(
    time: float,
    since: float,
    levels: Mapping[str, float],
    group: tuple[str, ...],
    found: Sequence[Explained],
) -> Verdict:
    """What there is to say: the class that is named, if any, and what else it could be."""
    chance = probabilities(found)
    shown = sorted((e for e in found if chance[e.fault] >= _SHOWN),
                   key=lambda e: (-chance[e.fault], e.fault))  # fmt: skip
    candidates = tuple(_candidate(e, chance[e.fault]) for e in shown)
    verdict = Verdict("update", time, since, dict(levels), group, candidates)
    if _best(found).share >= _EXPLAINS and candidates:
        return verdict._replace(message=described(verdict))
    message = (
        "no single fault explains this: several at once, or one that is not modelled;"
        f" {described(verdict)}"
    )
    return verdict._replace(message=message)


def _best(found: Sequence[Explained]) -> Explained:
    return max(found, key=lambda e: e.evidence)


def _candidate(explained: Explained, chance: float) -> Candidate:
    """A fault with the change that fits best: of the machine where it has changed."""
    hypothesis, change = explained.hypothesis, explained.change
    size = -change if hypothesis.turned else change
    if hypothesis.kind == "gain" and not hypothesis.turned:
        size = size / max(1.0 - size, 1e-3)  # of what is true, not of what is told
    if hypothesis.kind == "gain":
        return Candidate(explained.fault, 100.0 * size, "%", round(chance, 4))
    return Candidate(explained.fault, size, hypothesis.unit, round(chance, 4))
