"""From evidence to what is told: the class that is named, candidates with sizes, a sentence."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from typing import Any

from bondgraph.runtime.diagnosis.isolation import Explained, probabilities
from bondgraph.runtime.monitoring.verdict import Candidate, Verdict, described
from bondgraph.text.tuples import NamedTuple

_SURE = 0.75  # probability from which on a class is named
_ELSE = 0.5  # of the most probable fault of a class: what none outside may be above
_SHOWN = 0.02  # probability from which on a candidate is worth telling
_EXPLAINS = 0.7  # share of the misfit that a single fault has to take away
_AGAIN = 5  # rows between an update and the next, twice as many each time
LONGEST = 320  # rows that anything said again has to wait


def possible(explained: Explained, nominal: float | None) -> Explained:
    """No fault turns a parameter into its opposite: what would need that is no explanation."""
    if nominal:
        left = 1.0 - explained.change / nominal  # of the value, as the machine has it now
        if left < -0.1 - 3.0 * explained.deviation / abs(nominal):
            return explained._replace(evidence=-math.inf)
    return explained


def candidates(
    found: Sequence[Explained],
    faults: Mapping[str, float | None],
    sees: Mapping[str, Sequence[str]],
    fired: Iterable[str],
) -> list[Explained]:
    """With no evidence for what cannot be: see `possible`; nor can what a fired residual sees not.

    Evidence alone is of magnitudes, and where no fault fits well the one that spoils least may
    leave such a residual unexplained. Where no fault is seen by all that have fired, none is ruled
    out by that. `faults` are nominal values, `sees` the faults of each residual.
    """
    left = [possible(e, faults.get(e.fault)) for e in found]
    seen = [set(sees.get(name, ())) for name in fired]
    whole = [all(e.fault in own for own in seen) for e in left]
    if not any(good and e.evidence > -math.inf for good, e in zip(whole, left, strict=True)):
        return left
    return [
        e if good else e._replace(evidence=-math.inf) for good, e in zip(whole, left, strict=True)
    ]


class Judgement(NamedTuple):
    """The class that is named, () if of none, and the most probable candidate."""

    group: tuple[str, ...]
    fault: str | None


class Latched(NamedTuple):
    """An alarm: `since` when (s), what was `said` of it last, and how many `times` so far."""

    since: float
    said: Judgement | None = None
    times: int = 0

    def state(self) -> dict[str, Any]:
        """All that `resumed` needs, as plain JSON."""
        said = self.said and [list(self.said.group), self.said.fault, self.times]
        return {"since": self.since, "said": said}

    @classmethod
    def resumed(cls, state: Mapping[str, Any]) -> Latched:
        """From a state; raises KeyError, TypeError or ValueError for one of another kind.

        >>> latched = Latched(3.5, Judgement(("a", "b"), "a"), 2)
        >>> Latched.resumed(latched.state()) == latched
        True
        """
        since = float(state["since"])
        if state["said"] is None:
            return cls(since)
        group, fault, times = state["said"]
        return cls(since, Judgement(tuple(group), fault), int(times))


def news(latched: Latched, wanted: Judgement, again: bool, waited: int) -> bool:
    """Whether a judgement is to be told: something else than before, and for good.

    `again` says whether the judgement before had the same, `waited` how many rows ago the last one
    was told. Who waits longer each time does not go back and forth between two that are alike.

    >>> a, b = Judgement(("a", "b"), "a"), Judgement(("a", "b"), "b")
    >>> news(Latched(0.0, a, 1), b, False, 100)
    False
    >>> [news(Latched(0.0, a, k), b, True, 20) for k in (1, 2, 3)]
    [True, True, False]
    """
    said = latched.said
    if said is None:
        return True
    if wanted == said or (not wanted.group and wanted.fault in said.group):
        return False  # the same, or only less sure of it
    if wanted.group and not said.group:
        return True
    return again and waited >= min(_AGAIN * 2.0 ** min(latched.times, 9), LONGEST)


def classes(
    groups: Sequence[tuple[str, ...]], sees: Mapping[str, Sequence[str]], noise: Mapping[str, float]
) -> Sequence[tuple[str, ...]]:
    """The classes that are told apart by those residuals whose noise is known, not infinite.

    >>> sees = {"r1": ["a", "b"], "r2": ["b", "c"]}
    >>> classes([("a",), ("b",), ("c",)], sees, {"r1": math.inf, "r2": 0.1})
    [('a',), ('b', 'c')]
    >>> classes([("a",), ("b",), ("c",)], sees, {"r1": 0.2, "r2": 0.1})
    [('a',), ('b',), ('c',)]
    """
    watched = [name for name, sigma in noise.items() if math.isfinite(sigma)]
    if set(sees) <= set(watched):
        return groups
    found: dict[tuple[str, ...], tuple[str, ...]] = {}
    for group in groups:
        own = tuple(r for r in watched if not set(group).isdisjoint(sees.get(r, ())))
        found[own] = found.get(own, ()) + group
    return list(found.values())


def named(
    found: Sequence[Explained], groups: Sequence[tuple[str, ...]]
) -> tuple[tuple[str, ...], tuple[str, ...]]:
    """The class that the evidence is sure of, () if of none, and the one that leads."""
    chance = probabilities(found)
    classes = {g: sum(chance.get(f, 0.0) for f in g) for g in groups}
    leads = max(classes, key=lambda g: classes[g], default=())
    inside = max((chance.get(f, 0.0) for f in leads), default=0.0)
    outside = max((p for f, p in chance.items() if f not in leads), default=0.0)
    sure = classes.get(leads, 0.0) >= _SURE and _best(found).share >= _EXPLAINS
    sure = sure and outside <= _ELSE * inside  # many members make no fault more probable
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
    if hypothesis.held is not None:  # what acts is nothing of what is told, or the other position
        lost = hypothesis.fault == hypothesis.held.signal
        size, unit = (-100.0, "%") if lost else (None, "")
        return Candidate(explained.fault, size, unit, round(chance, 4))
    size = -change if hypothesis.turned else change
    if hypothesis.kind == "gain" and not hypothesis.turned:
        left = 1.0 - size  # told is true/left: nothing is left of what is told for no reason
        size = size / left if abs(left) > 1e-3 else math.copysign(1e3, left)
    if hypothesis.kind == "gain":
        return Candidate(explained.fault, 100.0 * size, "%", round(chance, 4))
    return Candidate(explained.fault, size, hypothesis.unit, round(chance, 4))
