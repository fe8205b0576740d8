"""Which explanations of what was seen can be, and whether one of them is good enough."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from types import MappingProxyType

from scipy.special import log_ndtr

from bondgraph.runtime.diagnosis.hypotheses import Hypothesis
from bondgraph.runtime.diagnosis.isolation import Explained, ExplainedPair
from bondgraph.runtime.diagnosis.rows import CORRELATED

SHOWN = 0.02  #: probability from which on an explanation is worth telling
_EXPLAINS = 3.0  # logarithm of how much more probable a fault has to make what was seen
_MOST = 0.7  # share of the misfit that a fault has to take away where nothing fits
_LEVEL = 1e-3  # probability of what noise may leave over
_LARGER = 2.0  # times the variance that noise is taken for, that it may have
_WRONG, _BEYOND = 0.1, 3.0  # of a value, and deviations, that it may seem to be on the wrong side
_FAR = 1e3  # deviations: farther out a normal distribution is an exponential one


def possible(explained: Explained, nominal: float | None, sign: int | None = None) -> Explained:
    """No fault turns a parameter into its opposite: what would need that is no explanation.

    One that is declared to be zero may take either sign, but for the one with which an R would
    deliver power, where only the other dissipates: it has a `sign`, 0 for either. `change` is how
    much less than now the parameter was. Where that is on the wrong side by no more than three
    deviations, beyond a tenth of the value, by which laws may be wrong, the change is the mean of
    what can be (a normal distribution, truncated), and the evidence is less by how improbable that
    is.

    >>> from bondgraph.runtime.diagnosis.hypotheses import Hypothesis
    >>> area = Hypothesis("A", "value", "m^2", 0.02, turned=True)
    >>> told = [Explained("A", 9.0, area, change, deviation=0.04) for change in (0.1, 0.21, 0.4)]
    >>> can = [possible(one, nominal=0.2) for one in told]
    >>> [(round(one.evidence, 2), round(one.change, 3)) for one in can]
    [(9.0, 0.1), (9.0, 0.171), (-inf, 0.4)]
    """
    change, deviation = explained.change, explained.deviation
    side = float(sign) if sign is not None else math.copysign(1.0, nominal) if nominal else 0.0
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


def changed(hypothesis: Hypothesis, change: float) -> float:
    """The change of the machine, or of what a sensor reads, where residuals tell such a one.

    >>> sensor, supply = (Hypothesis(n, "gain", "", 0.3, n == "U") for n in ("speed", "U"))
    >>> changed(sensor, 0.5), changed(supply, 0.5)
    (1.0, -0.5)
    """
    if hypothesis.kind != "gain" or hypothesis.turned:
        return -change if hypothesis.turned else change
    left = 1.0 - change  # told is true/left
    return change / left if abs(left) > 1e-3 else math.copysign(1e3, left)


def nothing_left(one: Explained) -> bool:
    """Whether what a sensor says may have nothing of what is there: no gain makes one of the other.

    >>> from bondgraph.runtime.diagnosis.hypotheses import Hypothesis
    >>> sensor = Hypothesis("ay", "gain", "", 0.3, turned=False)
    >>> told = [Explained("ay", 9.0, sensor, change, deviation=0.02) for change in (0.9, 0.96)]
    >>> [nothing_left(one) for one in told]
    [False, True]
    """
    gain = one.hypothesis.kind == "gain" and not one.hypothesis.turned
    return gain and abs(1.0 - one.change) <= _BEYOND * one.deviation


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
    residual, `signs` those of what is declared to be zero.
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


def explains(found: Sequence[Explained]) -> bool:
    """Whether a single fault explains what was seen, of all residuals, or most of it."""
    best = max(found, key=lambda e: e.evidence, default=None)
    return best is not None and (fits(best) or best.share >= _MOST)


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
