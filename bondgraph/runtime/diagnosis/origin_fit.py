"""Where positions began that nobody has told: the start that explains the samples since a break."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence

import numpy as np

from bondgraph.runtime.diagnosis.healthy import slack
from bondgraph.runtime.diagnosis.history import History
from bondgraph.runtime.diagnosis.hypotheses import COUNT, Bank, Hypothesis
from bondgraph.runtime.diagnosis.isolation import inverse
from bondgraph.runtime.diagnosis.rows import Row, weight
from bondgraph.runtime.log import Array
from bondgraph.runtime.monitoring.engine import Engine, copied
from bondgraph.text.tuples import NamedTuple

_SPREAD = 3.0  # standard deviations that a start may be off by
_LOCAL = 2.0  # counts that a slope is taken over, at least
_FINE = 2.0**-6  # of the size of a signal: the smallest change of its start that is tried
_OCTAVES = 22  # from there to the largest one
_FINEST = 2.0**-16  # the same of a parameter that says where something begins, of its value
_FEWER = 20  # from there to the largest one: sixteen times its value
_PARTS = 32  # of a turn, so that laws that turn are not stepped over
_VALLEYS = 6  # places with small residuals from which the smallest are looked for
_EXACT = 1e-6  # of a start that is no count: nearer it need not be known
_INSIDE = 9  # points between two where the best one lies
_STEPS = 6  # of Gauss and Newton
_VAIN = 4.0  # times the doubt that is allowed: more than the rest of the threshold makes up for
_BEYOND = 16.0  # squares of a deviation by which another start has to be worse
_OTHER = 0.3  # share of its slope by which a further start does something else


class Case(NamedTuple):
    """What has been seen since a break, and what was known before.

    `own` are the residuals that remember. `start` is the first sample as engines are told it, and
    behind it the values of the `parameters` of starts; `places` are those of both that are unknown.
    `gone` are the tolerated parameters that the break makes unknown, `starts` those of them that
    are starts. `limit` is what a residual may have above its adaptive threshold, `sigma` its noise.
    `reach` is how far an encoder has come, in counts, `steep` (residuals, signals and parameters)
    the largest slopes that were seen before; with no more doubt than `known` a start is of use.
    `hold` samples are told between the start and the first sample, `warm` ones pass before
    residuals are valid.
    """

    engine: Engine
    own: Sequence[int]
    places: Sequence[int]
    parameters: Sequence[str]
    start: Array
    rows: Sequence[Row]
    tolerated: tuple[Hypothesis, ...]
    gone: Sequence[int]
    starts: Sequence[int]
    nominal: Mapping[str, float]
    history: History
    limit: Array
    sigma: Array
    reach: Array
    steep: Array
    known: float
    hold: int
    warm: int

    def told(self, start: Array) -> tuple[Array, dict[str, float]]:
        """The first sample, (1, signals), and the parameters of such a start."""
        first, values = np.split(start, [len(self.engine.signals)])
        return first[None], dict(zip(self.parameters, values.tolist(), strict=True))


class Fit(NamedTuple):
    """The start that explains most, and all that follows from it.

    `starts` are the hypotheses that stand at the end of `tolerated` now, `spread` the covariance of
    what they are off by; `history` knows nothing yet of the rows since the break. `level` is the
    largest residual over its threshold, `doubt` what the spread may do to a residual over it.
    """

    start: Array
    tolerated: tuple[Hypothesis, ...]
    starts: tuple[Hypothesis, ...]
    spread: Array
    history: History
    bank: Bank
    rows: list[Row]
    level: float
    doubt: float


def replayed(case: Case, start: Array, tolerated: tuple[Hypothesis, ...]) -> tuple[Bank, list[Row]]:
    """The rows again, as residuals would have had them that began with another first sample."""
    told, parameters = case.told(start)
    bank = Bank(case.engine.configured(parameters), tolerated, case.nominal)
    bank.reset()
    first = case.rows[0].samples[:1]
    bank.run(told)
    length = max(len(row.samples) for row in case.rows)
    for _ in range(-(-case.hold // length)):
        bank.run(np.repeat(first, length, axis=0))
    own = list(case.own)
    found, age = [], 0
    for row in case.rows:
        before = copied(bank.engine)
        slopes = bank.run(row.samples)[-1].copy()
        batch = bank.batch
        assert batch is not None
        age += len(row.samples)
        value, valid, bound = row.value.copy(), row.valid.copy(), row.bound.copy()
        valid[own] = batch.valid[-1, own] & (age > case.warm)
        value[own] = batch.value[-1, own] * valid[own]
        whole = batch.bound[-1] + slack(tolerated, slopes) + row.doubt
        bound[own] = whole[own] * valid[own]
        found.append(Row(row.time, row.samples, before, value, valid, bound, row.doubt, slopes))
    return bank, found


def fitted(case: Case) -> Fit | None:
    """The start that explains the rows best; None where they tell nothing of it."""
    trial = _Trial(case)
    signals = trial.order() if trial.ready else []
    if not signals:
        return None
    change = np.zeros(len(case.start))
    for at in signals[:1]:
        change = trial.scanned(change, at)
    more = trial.independent(change, signals)
    for at in [*more[1:], *more[:1]] if len(more) > 1 else []:
        change = trial.scanned(change, at)
    if trial.hopeless(change, more):
        return None
    found = _refined(case, trial, change, more)
    sure = found.level > 1.0 or found.doubt >= case.known or trial.unique(found, more[0])
    return found if sure else found._replace(doubt=math.inf)


class _Trial:
    """Residuals at the ends of the rows for one first sample or another."""

    def __init__(self, case: Case) -> None:
        self._case = case
        self._engine = case.engine.configured(bounds=False)
        self._told: dict[str, float] = {}  # parameters of starts that it has
        self._samples = np.concatenate([row.samples for row in case.rows])
        ends = np.cumsum([len(row.samples) for row in case.rows])
        self._ends = ends[ends > case.warm] - 1
        self._own = list(case.own)
        self._limit = case.limit[self._own]
        self._many = len(case.engine.signals)
        self._counts = [k.counts for k in case.engine.signals] + [None] * len(case.parameters)
        size = np.sqrt(np.nanmean(np.square(self._samples), axis=0))
        size = np.append(size, np.abs([case.engine.parameters[p] for p in case.parameters]))
        self._size = np.where(size > 0, size, 1.0)

    @property
    def ready(self) -> bool:
        """Whether there is a row with residuals."""
        return len(self._ends) > 0

    def values(self, change: Array) -> Array:
        """The residuals, (rows, own), when the start is changed by that much; NaN where that cannot
        be.
        """
        first, own = self._case.told(self._case.start + change)
        if own != self._told:  # a new engine takes longer than one that forgets
            try:
                self._engine, self._told = self._case.engine.configured(own, bounds=False), own
            except ValueError:  # outside of where its laws are defined
                return np.full((len(self._ends), len(self._own)), math.nan)
        engine = self._engine
        engine.reset()
        engine.run(first)
        if self._case.hold:
            engine.run(np.repeat(self._samples[:1], self._case.hold, axis=0))
        return np.asarray(engine.run(self._samples).value[self._ends][:, self._own])

    def counted(self, at: int) -> bool:
        """Whether a start is that of an encoder."""
        return self._counts[at] is not None

    def unit(self, at: int) -> float:
        """The smallest change of a start that is worth trying."""
        if self.counted(at):
            return 1.0
        return (_FINE if at < self._many else _FINEST) * float(self._size[at])

    def most(self, at: int) -> float:
        """The largest one."""
        turn = self._counts[at]
        if turn is None:
            return self.unit(at) * 2.0 ** (_OCTAVES if at < self._many else _FEWER)
        return max(turn / 2, 2.0 * float(self._case.reach[at]))

    def order(self) -> list[int]:
        """The signals whose start makes a difference, the one that can be set most finely first."""
        effects = {}
        nothing = self.values(np.zeros(len(self._case.start)))
        for at in self._case.places:
            step = np.zeros(len(self._case.start))
            step[at] = 1024.0 * self.unit(at)
            effect = float(np.abs((self.values(step) - nothing) / self._limit).max(initial=0.0))
            if effect > 0:
                effects[at] = effect
        return sorted(effects, key=lambda at: (effects[at], at))

    def scanned(self, change: Array, at: int) -> Array:
        """The change with the smallest residuals along one signal; the others stay."""
        unit, most = self.unit(at), self.most(at)
        octaves = math.ceil(math.log2(max(most / unit, 1.0)))
        sizes = {unit * 2.0**k for k in range(octaves + 1)}
        turn = self._counts[at]
        if turn is not None:
            sizes |= {float(round(turn * k / 2 / _PARTS)) for k in range(1, _PARTS + 1)}
        points = np.array(sorted({0.0, *sizes, *(-s for s in sizes)}))
        scores = self._scores(change, at, points)
        found = [self._bottom(change, at, points, scores, k) for k in _valleys(scores)[:_VALLEYS]]
        return self._moved(change, at, min(found)[1])

    def _bottom(
        self, change: Array, at: int, points: Array, scores: Array, best: int
    ) -> tuple[float, float]:
        """The score and the place of the smallest residuals around one of the points."""
        whole = self._counts[at] is not None
        while True:
            low, high = points[max(best - 1, 0)], points[min(best + 1, len(points) - 1)]
            place = float(points[best])
            if high - low <= (2.0 if whole else max(abs(place), self.unit(at)) * _EXACT):
                return float(scores[best]), place
            inner = np.linspace(low, high, _INSIDE + 2)
            points = np.unique(np.append(np.rint(inner) if whole else inner, place))
            scores = self._scores(change, at, points)
            best = _valleys(scores)[0]

    def _scores(self, change: Array, at: int, points: Array) -> Array:
        found = [np.sum((self.values(self._moved(change, at, p)) / self._limit) ** 2)
                 for p in points]  # fmt: skip
        return np.nan_to_num(np.array(found), nan=math.inf)

    def _moved(self, change: Array, at: int, by: float) -> Array:
        moved = change.copy()
        moved[at] += by
        return moved

    def slopes(self, change: Array, at: int) -> Array:
        """How the residuals move with the start of one signal, (rows, own)."""
        step = _LOCAL * self.unit(at)
        up = self.values(self._moved(change, at, step))
        return np.asarray((up - self.values(self._moved(change, at, -step))) / (2 * step))

    def independent(self, change: Array, signals: Sequence[int]) -> list[int]:
        """The signals without those whose start does what the starts before them do."""
        found: list[int] = []
        basis: list[Array] = []
        for at in signals:
            slope = (self.slopes(change, at) / self._limit).ravel()
            rest = slope.copy()
            for one in basis:
                rest -= one * float(one @ rest)
            size = float(np.linalg.norm(rest))
            if not found or size > _OTHER * float(np.linalg.norm(slope)):
                found.append(at)
                if size > 0:
                    basis.append(rest / size)
        return found

    def hopeless(self, change: Array, signals: Sequence[int]) -> bool:
        """Whether not even the noise alone would let the rows tell the start well enough."""
        value = self.values(change)
        if (np.abs(value) > self._limit).any():
            return False  # something is to be explained
        slopes = np.array([self.slopes(change, at) for at in signals])  # (starts, rows, own)
        information = np.einsum("str,utr->su", slopes / self._case.sigma[self._own] ** 2, slopes)
        prior = np.diag([self.most(at) ** -2.0 for at in signals])
        spread = np.linalg.inv(information + prior)
        before = self._case.steep[np.ix_(self._own, list(signals))].T
        seen = np.concatenate([slopes, before[:, None]], axis=1)
        moved = np.sqrt(np.einsum("str,su,utr->tr", seen, spread, seen)).max(axis=0)
        first, own = self._case.told(self._case.start + change)
        engine = self._case.engine.configured(own)
        engine.run(first)
        bound = engine.run(self._samples).bound[self._ends][:, self._own]
        allowed = self._limit + np.median(bound, axis=0)
        return bool((_SPREAD * moved > _VAIN * self._case.known * allowed).any())

    def unique(self, found: Fit, at: int) -> bool:
        """Whether no other start explains the rows too that would matter later."""
        rows = found.rows[-len(self._ends) :]
        allowed = np.array([row.bound[self._own] for row in rows]) + self._limit
        factor = self._whitening(found)
        change = found.start - self._case.start
        own = self.values(change)
        worst = float(np.sum((factor @ own.ravel()) ** 2)) + _BEYOND
        near = max(4.0 * self.unit(at), 2.0 * _SPREAD * math.sqrt(found.spread[0, 0]))
        most = self.most(at)
        tries = np.linspace(-most, most, 2 * _PARTS + 1)
        turn = self._counts[at]
        if turn is not None:
            tries = np.rint(np.append(tries, np.linspace(-turn / 2, turn / 2, 2 * _PARTS + 1)))
        for by in (float(t) for t in tries if abs(t) > near):
            other = self._moved(change, at, by)
            value = self.values(other)
            if not float(np.sum((factor @ value.ravel()) ** 2)) < worst:
                continue
            for shift in (0.0, most / 7, -most / 5):
                here = self.values(self._moved(change, at, shift)) if shift else own
                there = self.values(self._moved(other, at, shift)) if shift else value
                if not (np.abs(there - here) < 0.1 * allowed).all():
                    return False
        return True

    def _whitening(self, found: Fit) -> Array:
        """What makes the residuals of the rows independent, with what is known of parameters."""
        case, rows = self._case, found.rows[-len(self._ends) :]
        kept = [k for k in range(len(case.tolerated)) if k not in case.starts]
        history = case.history.anew(case.gone, kept, [])
        slopes = np.concatenate([row.slopes[: len(kept), self._own] for row in rows], axis=1)
        own = np.concatenate([inverse(weight(row, case.sigma)[self._own]) for row in rows])
        own = np.minimum(own, 1e12 * float(np.min(own)))
        scaled = slopes * history.prior[:, None]
        moved = np.linalg.solve(history.known()[:, :-1].T, scaled)
        spread = moved.T @ moved + np.diag(own)
        return np.asarray(np.linalg.inv(np.linalg.cholesky(spread)))


def _valleys(scores: Array) -> list[int]:
    """Where scores are smaller than beside, the smallest first; of a plain, its ends."""
    near = 1e-6 * np.minimum(np.append(scores[1:], math.inf), scores) + 1e-12
    padded = np.concatenate([[math.inf], scores, [math.inf]])
    before, after = padded[:-2] - scores, padded[2:] - scores
    with np.errstate(invalid="ignore"):
        low = (before >= -near) & (after >= -near) & ((before > near) | (after > near))
    found = [int(k) for k in np.flatnonzero(low)] or [int(np.argmin(scores))]
    return sorted(found, key=lambda k: (scores[k], k))


def _refined(case: Case, trial: _Trial, change: Array, signals: Sequence[int]) -> Fit:
    """Gauss and Newton, with the parameters that are tolerated as what is known of them."""
    signals = list(signals)
    counts = np.array([trial.counted(at) for at in signals])
    units = np.array([trial.unit(at) for at in signals])
    kept = [k for k in range(len(case.tolerated)) if k not in case.starts]
    history = case.history.anew(case.gone, kept, [trial.most(at) for at in signals])
    usual = _LOCAL * units
    start = case.start + change
    best: tuple[float, Fit] | None = None
    for _ in range(_STEPS):
        starts = _starts(case, signals, usual)
        tolerated = (*(case.tolerated[k] for k in kept), *starts)
        bank, rows = replayed(case, start, tolerated)
        after = _after(case, history, rows)
        mean, spread = after.last(len(signals))
        level, doubt = _judged(case, rows, signals, tolerated, after)
        fit = Fit(start, tolerated, starts, spread, history, bank, rows, level, doubt)
        score = _misfit(case, rows)
        if best is not None and score > best[0]:
            break
        best = score, fit
        step = np.where(counts, np.rint(mean), mean)
        wider = np.clip(_SPREAD * np.sqrt(np.diag(spread)), _LOCAL * units, 1024.0 * units)
        still = np.abs(step) <= np.where(counts, 0.0, 0.1 * np.sqrt(np.diag(spread)))
        if still.all() and np.allclose(wider, usual, rtol=0.3):
            break
        usual = wider
        start = start.copy()
        start[signals] -= step
    assert best is not None
    return best[1]


def _starts(case: Case, signals: Sequence[int], usual: Array) -> tuple[Hypothesis, ...]:
    found = []
    for at, size in zip(signals, usual, strict=True):
        if at >= len(case.engine.signals):
            name = case.parameters[at - len(case.engine.signals)]
            found.append(Hypothesis(name, "start", "", float(size), False))
            continue
        known = case.engine.signals[at]
        unit = known.unit if known.counts is None else COUNT
        found.append(Hypothesis(known.path, "start", unit, float(size), False))
    return tuple(found)


def _after(case: Case, history: History, rows: Sequence[Row]) -> History:
    """What is known of parameters and starts, which stand last, with some rows more."""
    own = list(case.own)
    found = History(history.prior)
    found.root = history.root
    for row in rows:
        found.add(row.value[own], weight(row, case.sigma)[own], row.slopes[:, own], 1.0)
    return found


def _misfit(case: Case, rows: Sequence[Row]) -> float:
    own = list(case.own)
    return float(sum(np.sum((row.value[own] / case.limit[own]) ** 2) for row in rows))


def _judged(
    case: Case,
    rows: Sequence[Row],
    signals: Sequence[int],
    tolerated: Sequence[Hypothesis],
    known: History,
) -> tuple[float, float]:
    """The largest residual over its threshold, and what not to know the starts may do to one.

    That is by how much its variance is larger than with starts that are known. A start need not be
    told from a parameter that does the same: what both are off by together, the samples tell. With
    the starts last, the whole variance is a sum of squares of which they have the last ones.
    """
    own, count = list(case.own), len(signals)
    good = [row for row in rows if row.valid[own].any()]
    if not good:
        return math.inf, math.inf
    allowed = np.array([row.bound[own] + case.limit[own] for row in good])
    level = float((np.abs([row.value[own] for row in good]) / allowed).max())
    before = np.zeros_like(good[0].slopes[:, own])
    before[-count:] = case.steep[np.ix_(own, list(signals))].T
    starts = {h.fault: at for at, h in enumerate(tolerated[-count:], len(tolerated) - count)}
    for at, one in enumerate(tolerated[:-count]):
        if one.kind == "offset" and one.unit == COUNT and one.fault in starts:
            before[at] = -before[starts[one.fault]]  # a first count is off by the opposite
    slopes = np.stack([*(row.slopes[:, own] for row in good), before])
    whole = known.known()[:, :-1].T
    moved = np.linalg.solve(whole, slopes * known.prior[:, None])[:, -count:]
    moved = np.sqrt(np.square(moved).sum(axis=1))
    return level, float((_SPREAD * moved / np.median(allowed, axis=0)).max())
