"""From evidence to what is told: the class that is named, candidates with sizes, a sentence."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping, Sequence
from types import MappingProxyType
from typing import Any

from scipy.special import log_ndtr

from bondgraph.ir.signature_matrix import DoubleFaults
from bondgraph.runtime.diagnosis.hypotheses import Hypothesis
from bondgraph.runtime.diagnosis.isolation import (
    RARER,
    Explained,
    ExplainedPair,
    probabilities,
)
from bondgraph.runtime.diagnosis.rows import CORRELATED
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
_SHOWN = 0.02  # probability from which on a candidate is worth telling
_EXPLAINS = 3.0  # logarithm of how much more probable a fault has to make what was seen
_MOST = 0.7  # share of the misfit that a fault has to take away where nothing fits
_LEVEL = 1e-3  # probability of what noise may leave over
_LARGER = 2.0  # times the variance that noise is taken for, that it may have
_GROWN = 1.5  # times its size that a fault has to have to be told again
_WRONG, _BEYOND = 0.1, 3.0  # of a value, and deviations, that it may seem to be on the wrong side
_FAR = 1e3  # deviations: farther out a normal distribution is an exponential one
_OFF = 3.0  # times as far off, of a share beside an offset: they are alike at one level only
_SURER = math.log(20.0)  # of its odds: by so much surer a fault is told again
_CERTAIN = math.log(99.0)  # odds that are as good as any larger ones
_AGAIN = 5  # rows between an update and the next, twice as many each time
LONGEST = 320  # rows that anything said again has to wait


def possible(explained: Explained, nominal: float | None, sign: int | None = None) -> Explained:
    """No fault turns a parameter into its opposite: what would need that is no explanation.

    Nor does one that is zero take the sign with which an R would deliver power, where only one
    `sign` dissipates. `change` is how much less than now the parameter was. Where that is on the
    wrong side by no more than three deviations, beyond a tenth of the value, by which laws may be
    wrong, the change is the mean of what can be (a normal distribution, truncated), and the
    evidence is less by how improbable that is.

    >>> from bondgraph.runtime.diagnosis.hypotheses import Hypothesis
    >>> area = Hypothesis("A", "value", "m^2", 0.02, turned=True)
    >>> told = [Explained("A", 9.0, area, change, deviation=0.04) for change in (0.1, 0.21, 0.4)]
    >>> can = [possible(one, nominal=0.2) for one in told]
    >>> [(round(one.evidence, 2), round(one.change, 3)) for one in can]
    [(9.0, 0.1), (9.0, 0.171), (-inf, 0.4)]
    """
    change, deviation = explained.change, explained.deviation
    side = math.copysign(1.0, nominal) if nominal else float(sign or 0)
    value = side * ((nominal or 0.0) - change)  # as the machine has it now
    if nominal is None or value >= 0.0:
        return explained
    far = -value - _WRONG * abs(nominal)
    if far > _BEYOND * deviation:
        return explained._replace(evidence=-math.inf)
    less = float(log_ndtr(-far / deviation)) + math.log(2.0) if far > 0.0 else 0.0
    left = deviation * _mean_above(-value / deviation) if deviation > 0.0 else 0.0
    change += side * (value - left)
    return explained._replace(evidence=explained.evidence + less, change=change)


def _mean_above(z: float) -> float:
    """The mean of what a normal deviate is above z > 0, where it is."""
    if z > _FAR:
        return 1.0 / z
    return math.exp(-0.5 * z * z - float(log_ndtr(-z))) / math.sqrt(2.0 * math.pi) - z


def suspects(
    faults: Iterable[str], sees: Mapping[str, Sequence[str]], fired: Mapping[str, float]
) -> list[str]:
    """The faults that every residual sees which has fired; all of them where there is none.

    Noise that is larger than it is taken for is for once above a threshold: what has `fired` by no
    more than that, in thresholds, is not asked for beside what has by more.

    >>> sees = {"r1": ["a", "b"], "r2": ["b", "c"], "r3": ["c"]}
    >>> [suspects("abc", sees, dict.fromkeys(fired, 2.0)) for fired in (["r1"], ["r1", "r2"])]
    [['a', 'b'], ['b']]
    >>> [suspects("abc", sees, {"r1": 2.0, "r3": level}) for level in (2.0, 1.1)]
    [['a', 'b', 'c'], ['a', 'b']]
    """
    every, most = list(faults), loud(fired)
    return [f for f in every if all(f in sees.get(name, ()) for name in most)] or every


def candidates(
    found: Sequence[Explained],
    faults: Mapping[str, float | None],
    sees: Mapping[str, Sequence[str]],
    fired: Mapping[str, float],
    signs: Mapping[str, int] = MappingProxyType({}),
) -> list[Explained]:
    """With no evidence for what cannot be: see `possible`; nor can what a fired residual sees not.

    Evidence alone is of magnitudes, and where no fault fits well the one that spoils least may
    leave such a residual unexplained. Of a fault that fits only what is loud has to be seen, as in
    `suspects`, and of any where no fault is seen by all that have fired. Where none is seen by what
    is loud, none is ruled out by that. `faults` are nominal values, `sees` the faults of each
    residual, `signs` those of what is nominally zero.
    """
    left = [possible(e, faults.get(e.fault), signs.get(e.fault)) for e in found]
    most = loud(fired)
    for asked in (fired, most):
        whole = [all(e.fault in sees.get(name, ()) for name in (most if fits(e) else asked))
                 for e in left]  # fmt: skip
        if any(good and e.evidence > -math.inf for good, e in zip(whole, left, strict=True)):
            return [e if good else e._replace(evidence=-math.inf)
                    for good, e in zip(whole, left, strict=True)]  # fmt: skip
    return left


def loud(fired: Mapping[str, float]) -> list[str]:
    """What has fired by more than `_LARGER` noise does, or all where nothing has."""
    return [name for name, level in fired.items() if level * level > _LARGER] or list(fired)


class Judgement(NamedTuple):
    """The class that is named, () if of none, and the most probable candidate with size and unit.

    Where no single fault explains what was seen, `pair` are two that do, or classes of such. `off`
    says how far the reading was off that is wrong, in its own unit, 0 where nobody knows that;
    `probability` how probable the candidate was.
    """

    group: tuple[str, ...]
    fault: str | None
    pair: tuple[str, ...] = ()
    size: float | None = None
    unit: str = ""
    off: float = 0.0
    probability: float | None = None

    def says(self, other: Judgement) -> bool:
        """Whether it says the same, whatever the sizes: off by some, or by none as it stands.

        >>> off = Judgement(("u", "R"), "u", size=0.2)
        >>> off.says(off._replace(size=-0.1)), off.says(off._replace(size=None))
        (True, False)
        """
        return self[:3] == other[:3] and (self.size is None) == (other.size is None)

    def grown(self, other: Judgement) -> bool:
        """Whether the same fault is half as large again as in another one, or as much smaller.

        A share, an offset and a rate of the same reading are no two sizes that could be compared:
        there the reading has to be three times as far off as it was.
        """
        if self.size is None or other.size is None or self.fault != other.fault:
            return False
        if self.unit != other.unit:
            return self.off > _OFF * other.off > 0.0
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
    """An alarm: `since` when (s), what was `said` of it last, and how many `times` so far."""

    since: float
    said: Judgement | None = None
    times: int = 0

    def state(self) -> dict[str, Any]:
        """All that `resumed` needs, as plain JSON."""
        said = self.said and [list(self.said.group), self.said.fault, self.times, self.said.pair,
                              self.said.size, self.said.unit, self.said.off,
                              self.said.probability]  # fmt: skip
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
        group, fault, times, pair, size, *more = state["said"]
        size = None if size is None else float(size)
        unit, off = more[:2] or ("", 0.0)  # none before 2026-11-28
        chance = float(more[2]) if more[2:] and more[2] is not None else None  # nor this before -30
        said = Judgement(tuple(group), fault, tuple(pair), size, str(unit), float(off), chance)
        return cls(since, said, int(times))


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


class OneOrTwo(NamedTuple):
    """Whether a single fault is enough for what was seen, and `alone` may be named.

    If it is not, `pairs` are those that are, the best one first, none where these are not either.
    `perhaps` says that of the faults that look like no single one two may be it all the same, or
    that one may be it that explains what was seen, if less well than two.
    """

    alone: bool = True
    pairs: Sequence[ExplainedPair] = ()
    perhaps: bool = False


def one_or_two(
    alone: Sequence[Explained],
    pairs: Sequence[ExplainedPair],
    one: bool,
    doubles: Callable[[], DoubleFaults],
) -> OneOrTwo:
    """How probable two faults at once are beside one `alone`; of `one` it is known that it fits.

    Two at once are rarer, and how a fault sets in and goes on is not known: where a single fault
    fits, two that look like some single one are not asked for.
    """
    least = max((e.evidence for e in alone), default=-math.inf) + RARER
    left = [pair for pair in pairs if pair.evidence >= least and fits(pair)]
    if not (one or any(fits(e) for e in alone)):
        return OneOrTwo(False, left)
    near = [p for p in pairs if p.evidence >= least + math.log(_SHOWN) and fits(p)]
    told = [p for p in near if doubles().like_none(h.fault for h in p.hypotheses)]
    if any(pair.evidence >= least for pair in told):
        return OneOrTwo(False, left, True)
    return OneOrTwo(True, (), bool(told))


def pairs_that_can(
    found: Sequence[ExplainedPair],
    faults: Mapping[str, float | None],
    sees: Mapping[str, Sequence[str]],
    fired: Iterable[str],
    signs: Mapping[str, int] = MappingProxyType({}),
) -> list[ExplainedPair]:
    """Without the pairs that cannot be, as `candidates`: what has fired one of both has to move."""
    seen = [set(sees.get(name, ())) for name in fired]
    left = []
    for pair in found:
        own = {h.fault for h in pair.hypotheses}
        each = [Explained(h.fault, 0.0, h, change, 0.0)
                for h, change in zip(pair.hypotheses, pair.changes, strict=True)]  # fmt: skip
        kept = [possible(e, faults.get(e.fault), signs.get(e.fault)) for e in each]
        can = all(e.evidence == 0.0 for e in kept)
        if can and not any(own.isdisjoint(s) for s in seen):
            left.append(pair._replace(changes=(kept[0].change, kept[1].change)))
    return left


def explains(found: Sequence[Explained]) -> bool:
    """Whether a single fault explains what was seen, of all residuals, or most of it."""
    return bool(found) and (fits(_best(found)) or _best(found).share >= _MOST)


def fits(one: Explained | ExplainedPair) -> bool:
    """Whether what is left over may be noise: a test of fit over all residuals (Pearson, 1900).

    Noise may have twice the variance that it is taken for, and be such that it is exceeded once in
    a thousand; neighbouring values share some of it. What is hardly more probable than a healthy
    machine explains nothing.
    """
    from scipy.special import chdtri

    independent = max(one.values / CORRELATED, 1.0)
    most = _LARGER / CORRELATED * float(chdtri(independent, _LEVEL)) / independent
    return one.evidence >= _EXPLAINS and one.left <= most


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
    shown = sorted((e for e in found if chance[e.fault] >= _SHOWN),
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
        if chance >= _SHOWN:
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


def _best(found: Sequence[Explained]) -> Explained:
    return max(found, key=lambda e: e.evidence)


def candidate(explained: Explained, chance: float) -> Candidate:
    """A fault with the change that fits best: of the machine where it has changed."""
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
    return Candidate(explained.fault, size, unit, round(chance, 4))


def _size(hypothesis: Hypothesis, change: float) -> tuple[float, str]:
    """The change of the machine, or of the sensor, with its unit."""
    size = -change if hypothesis.turned else change
    if hypothesis.kind == "gain" and not hypothesis.turned:
        left = 1.0 - size  # told is true/left: nothing is left of what is told for no reason
        size = size / left if abs(left) > 1e-3 else math.copysign(1e3, left)
    return hypothesis.told(size)
