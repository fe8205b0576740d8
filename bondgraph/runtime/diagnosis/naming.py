"""From evidence to what is told: the class that is named, candidates with sizes, a sentence."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any

from bondgraph.ir.signature_matrix import DoubleFaults
from bondgraph.runtime.diagnosis.hypotheses import Hypothesis
from bondgraph.runtime.diagnosis.isolation import Explained, ExplainedPair, probabilities
from bondgraph.runtime.diagnosis.possible import SHOWN, changed, explains, nothing_left
from bondgraph.runtime.diagnosis.two_at_once import OneOrTwo
from bondgraph.runtime.monitoring.verdict import (
    Candidate,
    Pair,
    Verdict,
    described,
    described_pairs,
    described_unexplained,
)
from bondgraph.text.numerals import listed
from bondgraph.text.tuples import NamedTuple

_SURE = 0.75  # probability from which on a class is named
_ELSE = 0.5  # of the most probable fault of a class: what none outside may be above
_GROWN = 1.5  # times its size that a fault has to have to be told again
_OFF = 3.0  # times as far off, of a share beside an offset: where they are alike, either does
_SURER = math.log(20.0)  # of its odds: by so much surer a fault is told again
_CERTAIN = math.log(99.0)  # odds that are as good as any larger ones
_AGAIN = 5  # rows between an update and the next, twice as many each time
LONGEST = 320  # rows that anything said again has to wait


class Judgement(NamedTuple):
    """The class that is named, () if of none, and the most probable candidate with size and unit.

    Where no single fault explains what was seen, `pair` are two that do, or classes of such. `off`
    says how far the signal was off that is wrong, in its own unit, 0 where nobody knows that;
    `probability` how probable the candidate was, `kind` how it is wrong (see `Hypothesis`).
    """

    group: tuple[str, ...]
    fault: str | None
    pair: tuple[str, ...] = ()
    size: float | None = None
    unit: str = ""
    off: float = 0.0
    probability: float | None = None
    kind: str = ""

    def at(self, value: float, lasted: float) -> Judgement:
        """The same, off by what it says where the signal is told a value, after so long (s).

        >>> share = Judgement(("i",), "i", size=-20.0, unit="%", kind="gain")
        >>> [round(share.at(value, 9.0).off, 3) for value in (10.0, -30.0)]
        [-2.0, 6.0]
        """
        if self.size is None or self.kind not in ("gain", "offset", "drift"):
            return self
        off = self.size * (lasted if self.kind == "drift" else 1.0)
        return self._replace(off=off / 100.0 * value if self.unit == "%" else off)

    def says(self, other: Judgement) -> bool:
        """Whether it says the same, whatever the sizes: off by some, or by none as it stands.

        >>> off = Judgement(("u", "R"), "u", size=0.2)
        >>> off.says(off._replace(size=-0.1)), off.says(off._replace(size=None))
        (True, False)
        """
        return self[:3] == other[:3] and (self.size is None) == (other.size is None)

    def grown(self, other: Judgement) -> bool:
        """Whether the same fault is half as large again as in another one, or as much smaller.

        A share, an offset and a rate of the same signal are no two sizes that could be compared:
        there it has to be three times as far off now by one as by the other, or to the other side.
        """
        if self.size is None or other.size is None or self.fault != other.fault:
            return False
        if self.unit != other.unit:
            times = self.off / (other.off or math.inf)
            return times != 0.0 and not (math.isnan(times) or 1.0 / _OFF <= times <= _OFF)
        return not 1.0 / _GROWN <= self.size / (other.size or math.inf) <= _GROWN

    def surer(self, other: Judgement) -> bool:
        """Whether the same fault is twenty times as probable, beside all else, as in another one.

        >>> told, now = (Judgement(("R", "v"), "v", probability=p) for p in (0.5, 0.96))
        >>> now.surer(told), told.surer(now), now._replace(fault="R").surer(told)
        (True, False, False)
        """
        if self.probability is None or other.probability is None or self.fault != other.fault:
            return False
        return _odds(self.probability) - _odds(other.probability) >= _SURER


def _odds(probability: float) -> float:
    """The logarithm of the odds, as far as larger ones say more."""
    least = 1.0 / (1.0 + math.exp(_CERTAIN))
    inside = min(max(probability, least), 1.0 - least)
    return math.log(inside / (1.0 - inside))


class Latched(NamedTuple):
    """An alarm: `since` when (s), what was `said` of it last, and how many `times` so far.

    `itself` says whether it was put down to a signal that is unusual by itself.
    """

    since: float
    said: Judgement | None = None
    times: int = 0
    itself: bool = False

    def state(self) -> dict[str, Any]:
        """All that `resumed` needs, as plain JSON."""
        said = self.said and [list(self.said.group), self.said.fault, self.times, self.said.pair,
                              self.said.size, self.said.unit, self.said.off,
                              self.said.probability, self.said.kind]  # fmt: skip
        return {"since": self.since, "said": said, "itself": self.itself}

    @classmethod
    def resumed(cls, state: Mapping[str, Any]) -> Latched:
        """From a state; raises KeyError, TypeError or ValueError for one of another kind.

        >>> latched = Latched(3.5, Judgement(("a", "b"), "a"), 2, itself=True)
        >>> Latched.resumed(latched.state()) == latched
        True
        """
        since, itself = float(state["since"]), bool(state.get("itself", True))  # before 2026-12
        if state["said"] is None:
            return cls(since, itself=itself)
        group, fault, times, pair, size, *more = state["said"]
        size = None if size is None else float(size)
        unit, off = more[:2] or ("", 0.0)  # none before 2026-11-28
        chance = float(more[2]) if more[2:] and more[2] is not None else None  # nor this before -30
        kind = str(more[3]) if more[3:] else ""  # nor this
        said = Judgement(
            tuple(group), fault, tuple(pair), size, str(unit), float(off), chance, kind
        )
        return cls(since, said, int(times), itself)


def news(latched: Latched, wanted: Judgement, again: bool, waited: int) -> bool:
    """Whether a judgement is to be told: something else than before, of another size, or surer.

    `again` says whether the judgement before had the same, `waited` how many rows ago the last one
    was told. Who waits longer each time does not go back and forth between two that are alike.

    >>> a, b = Judgement(("a", "b"), "a"), Judgement(("a", "b"), "b")
    >>> news(Latched(0.0, a, 1), b, False, 100)
    False
    >>> [news(Latched(0.0, a, k), b, True, 20) for k in (1, 2, 3)]
    [True, True, False]
    >>> small, same, large = (a._replace(size=x) for x in (2.0, 2.9, 3.1))
    >>> [news(Latched(0.0, small, 1), now, True, 20) for now in (same, large)]
    [False, True]
    >>> share, more = (large._replace(unit="%", off=x) for x in (2.9, 3.1))
    >>> [news(Latched(0.0, small._replace(off=1.0), 1), now, True, 20) for now in (share, more)]
    [False, True]
    >>> [news(Latched(0.0, a._replace(probability=p), 1), a._replace(probability=0.97), True, 20)
    ...  for p in (0.5, 0.7)]
    [True, False]
    """
    said = latched.said
    if said is None:
        return True
    late = again and waited >= min(_AGAIN * 2.0 ** min(latched.times, 9), LONGEST)
    if wanted.says(said) or (not wanted.group and wanted.fault in said.group):
        return late and (wanted.grown(said) or wanted.surer(said))  # else the same, or less sure
    if (wanted.group and not said.group) or (wanted.pair and not (said.pair or said.group)):
        return True
    return late


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
    sure = classes.get(leads, 0.0) >= _SURE and explains(found)
    sure = sure and outside <= _ELSE * inside  # many members make no fault more probable
    return (leads if sure else ()), leads


def update(
    time: float,
    since: float,
    levels: Mapping[str, float],
    group: tuple[str, ...],
    found: Sequence[Explained],
    two: OneOrTwo,
    doubles: DoubleFaults | None = None,
) -> Verdict:
    """What there is to say: the class that is named, if any, and what else it could be.

    `doubles` tells which pairs of `two` nothing tells apart, and whether what is named could be two
    others.
    """
    pairs = two.pairs
    chance = probabilities(found)
    shown = sorted((e for e in found if chance[e.fault] >= SHOWN),
                   key=lambda e: (-chance[e.fault], e.fault))  # fmt: skip
    candidates = tuple(candidate(e, chance[e.fault]) for e in shown)
    verdict = Verdict("update", time, since, dict(levels), group, candidates)
    if explains(found) and candidates and two.alone and not pairs:
        message = described(verdict)
        if group and (two.perhaps or (doubles is not None and doubles.looks_like_two(group[0]))):
            message += "; or two others at once"
        return verdict._replace(message=message)
    if not pairs:
        return verdict._replace(message=described_unexplained(verdict))
    verdict = verdict._replace(pairs=_shown(pairs))
    alike = [] if doubles is None else _alike(pairs[0], doubles)
    well = " as well" if two.perhaps else ""
    message = f"no single fault explains this{well}; {described_pairs(verdict)}"
    message += "; or something that is not modelled"
    if alike:
        every = doubles is not None and len(alike) == len(doubles.groups)
        which = "faults" if every else f"of {listed([' or '.join(g) for g in alike], 'and')}"
        message += f"; any two {which} could look like that"
    return verdict._replace(message=message)


def _shown(pairs: Sequence[ExplainedPair]) -> tuple[Pair, ...]:
    weights = [math.exp(max(pair.whole - pairs[0].whole, -700.0)) for pair in pairs]
    found = []
    for pair, weight in zip(pairs, weights, strict=True):
        chance = weight / sum(weights)
        if chance >= SHOWN:
            (a, b), changes = pair.hypotheses, pair.changes
            (x, p), (y, q) = _size(a, changes[0]), _size(b, changes[1])
            found.append(Pair((a.fault, b.fault), (x, y), (p, q), round(chance, 4)))
    return tuple(found)


def _alike(pair: ExplainedPair, doubles: DoubleFaults) -> list[tuple[str, ...]]:
    """The groups of the pair and those that it could look like: any two do the same, if any."""
    place = {f: k for k, group in enumerate(doubles.groups) for f in group}
    own = [place[h.fault] for h in pair.hypotheses if h.fault in place]
    more = [k for k, several in enumerate(doubles.alike)
            if any(set(own) <= set(one) for one in several)]  # fmt: skip
    return [doubles.groups[k] for k in (*own, *more)] if more and len(set(own)) == 2 else []


def candidate(explained: Explained, chance: float) -> Candidate:
    """A fault with the change that fits best: of the machine where it has changed.

    Of a sensor of which perhaps nothing is right nobody knows how many times too large it is.
    """
    held = explained.hypothesis.held
    if held is not None:  # what acts is nothing of what is told, or the other position
        if held.stays:
            place = explained.change if math.isfinite(explained.change) else None
            unit = explained.hypothesis.unit
            return Candidate(explained.fault, None, unit, round(chance, 4), place)
        lost = explained.fault == held.signal
        size, unit = (-100.0, "%") if lost else (None, "")
        return Candidate(explained.fault, size, unit, round(chance, 4))
    size, unit = _size(explained.hypothesis, explained.change)
    told = None if nothing_left(explained) else size
    return Candidate(explained.fault, told, unit, round(chance, 4))


def _size(hypothesis: Hypothesis, change: float) -> tuple[float, str]:
    """The change of the machine, or of the sensor, with its unit."""
    return hypothesis.told(changed(hypothesis, change))
