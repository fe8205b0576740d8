"""From residuals to verdicts: when something is wrong, since when, and what it can be."""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from bondgraph.runtime.log import Array
from bondgraph.runtime.monitoring.engine import Batch, Engine
from bondgraph.runtime.monitoring.hypotheses import (
    COUNT,
    Bank,
    Hypothesis,
    Sizes,
    hypotheses,
    rows_apart,
)
from bondgraph.runtime.monitoring.isolation import (
    Explained,
    History,
    Rows,
    explain,
    probabilities,
)
from bondgraph.runtime.monitoring.tuning import Limit, Tuning, height, kappa
from bondgraph.runtime.monitoring.verdict import Candidate, Verdict, listed

_MEMORY = 60.0  # rows of the past that are kept, to go back to the onset
_MOST = 600  # rows since the onset that are compared
_FORGET = 1000.0  # rows after which healthy operation counts a third
_LEARNING = 30  # rows from which noise is learned where nobody has tuned
_JUDGE = 5  # rows after an alarm before a fault is named
_AGAIN = 5  # rows between later judgements
_CALM = 5  # rows that have to be calm behind one before it counts as healthy
_BACK = 10  # rows that residuals must be quiet before a fault is over
_MODEL_ERROR = 0.02  # of the adaptive threshold: what the linearised model is off by
_SLOPE_ERROR = 0.05  # of the residual: what its sensitivities are off by
_ONSET_ERROR = 0.8  # of the residual, in the first row: somewhere in it the fault began
_ONSET_FADES = 0.4  # what is left of that in every row after
_CORRELATED = 2.0  # variance of the mean of rows, to that of independent ones
_SURE = 0.75  # probability from which on a class is named
_SHOWN = 0.02  # probability from which on a candidate is worth telling
_EXPLAINS = 0.7  # share of the misfit that a single fault has to take away
_COUNT = 1.0  # counts by which the first one of an encoder may be off
_DEFAULT_ALARMS = 1.0  # per hour, where nobody has tuned


class Facts(NamedTuple):
    """What a diagnosis knows of the machine.

    `faults` that some residual sees, with the nominal value of a parameter and None for a signal;
    `tolerances` relative; `sees` for each residual its faults; `groups` the faults that structure
    does not tell apart.
    """

    faults: Mapping[str, float | None]
    tolerances: Mapping[str, float]
    units: Mapping[str, str]
    sees: Mapping[str, Sequence[str]]
    groups: Sequence[tuple[str, ...]]


def tolerated(known: Sequence[Hypothesis], facts: Facts) -> tuple[tuple[Hypothesis, ...], Array]:
    """What may be off for ever while all is well, and by how much (standard deviations).

    Parameters within their tolerances, and encoders by one count: where within a count an encoder
    stands when it begins to count, nobody knows.
    """
    found, most = [], []
    for one in known:
        if one.kind == "value" and facts.tolerances.get(one.fault):
            most.append(facts.tolerances[one.fault] * abs(facts.faults[one.fault] or 0.0))
        elif one.kind == "offset" and one.unit == COUNT:
            most.append(_COUNT)
        else:
            continue
        found.append(one)
    keep = [k for k, size in enumerate(most) if size > 0]
    return tuple(found[k] for k in keep), np.array([most[k] for k in keep]) / math.sqrt(3.0)


def slack(known: Sequence[Hypothesis], slopes: Array) -> Array:
    """What the first counts of encoders add to the adaptive threshold; slopes (..., known, r)."""
    own = [k for k, h in enumerate(known) if h.unit == COUNT]
    return np.asarray(_COUNT * np.abs(slopes[..., own, :]).sum(axis=-2))


def grown(sums: Array, value: Array, allowed: Array, sigma: Array) -> Array:
    """One row more of the sums of what is above the allowed and below its opposite (Page, 1954).

    `sums` has the shape (2, residuals). Half a sigma less a row keeps noise from adding up.
    """
    above = (np.stack([value, -value]) - allowed) / sigma - 0.5
    return np.asarray(np.maximum(0.0, sums + above))


class _Row(NamedTuple):
    """One row of the past, with the samples that led to it and the engine before these."""

    time: float
    samples: Array
    engine: Engine
    value: Array
    weight: Array
    slopes: Array  # of the tolerated parameters, wrong for ever


class Diagnosis:
    """A `Decision`: thresholds and CUSUM say that something is wrong, evidence says what.

    The engine is the model's own; copies of it are run beside (see `Bank`). Without a `tuning` the
    noise is learned from the first seconds, which then have to be healthy ones.
    """

    def __init__(self, engine: Engine, facts: Facts, tuning: Tuning | None = None) -> None:
        self._facts = facts
        self._engine = engine
        self._every = rows_apart(engine)
        self._nominal = {f: v for f, v in facts.faults.items() if v is not None}
        self._sizes = Sizes(engine)
        self._all = hypotheses(engine, facts.faults, facts.units, {})
        self._tolerated, spread = tolerated(self._all, facts)
        self._history = History(spread)
        self._limits = None if tuning is None else self._arrays(tuning.limits)
        self._learned: list[Array] = []
        self._latched: dict[str, Any] | None = None
        self._used = np.array([name in facts.sees for name in engine.residuals], dtype=bool)
        self.restart()

    def _arrays(self, limits: Mapping[str, Limit]) -> Array:
        """Limits as an array (residuals, fields); one without limits never fires."""
        never = Limit(math.inf, 1.0, 1.0, math.inf)
        return np.array([limits.get(name, never) for name in self._engine.residuals], dtype=float)

    def restart(self) -> None:
        """The residuals begin anew, after a gap; what was said is still said."""
        count = len(self._engine.residuals)
        self._bank = Bank(self._engine.configured(), self._tolerated, self._nominal)
        self._bank.reset()
        self._past: deque[_Row] = deque(maxlen=int(_MEMORY))
        self._calm: deque[_Row] = deque()
        self._piece: list[Array] = []
        self._before = self._copy()
        self._filled = 0
        self._streak = np.zeros(count, dtype=int)
        self._sums = np.zeros((2, count))
        self._warm = False
        self._fired: npt.NDArray[np.bool_] = np.zeros(count, dtype=bool)
        self._most = np.zeros(count)
        self._quiet = 0
        self._after = 0  # rows since the alarm
        self._leads: tuple[str, ...] = ()  # the class that the last judgement found best
        self._steps: Bank | None = None
        self._rows: list[Rows] = []

    def _copy(self) -> Engine:
        copy = self._bank.engine.configured(bounds=False)
        copy.follow(self._bank.engine)
        return copy

    # -------------------------------------------------------------------- samples

    def update(self, time: Array, batch: Batch, samples: Array) -> list[Verdict]:
        """What there is to say after further samples, in order."""
        out: list[Verdict] = []
        start = 0
        while start < len(time):
            stop = min(len(time), start + self._every - self._filled)
            own = slice(start, stop)
            slopes = self._bank.run(samples[own])
            bound = batch.bound[own] + slack(self._tolerated, slopes)
            part = Batch(batch.value[own], batch.valid[own], bound)
            self._warmth(time[own], part.valid, out)
            self._alarms(time[own], part, out)
            self._take(time[own], part, samples[own], slopes, out)
            start = stop
        return out

    def _alarms(self, time: Array, batch: Batch, out: list[Verdict]) -> None:
        """Sample by sample: is a residual above its limit for long enough?"""
        if self._limits is None:
            return
        sigma, limit = self._limits[:, 0], self._limits[:, 2] * self._limits[:, 0]
        excess = np.where(batch.valid, np.abs(batch.value) - batch.bound, -math.inf)
        level = np.where(batch.valid, np.abs(batch.value) / (batch.bound + limit), 0.0)
        self._most = np.maximum(self._most * ~self._fired_none(), level.max(axis=0))
        over = excess > limit
        if not over.any():
            self._streak[:] = 0
            return
        wanted = max(3, self._every // 10)
        for k in range(len(time)):
            self._streak = np.where(over[k], self._streak + 1, 0)
            fresh = (self._streak >= wanted) & ~self._fired & np.isfinite(sigma)
            if fresh.any():
                self._fire(float(time[k]), fresh, out)

    def _fired_none(self) -> npt.NDArray[np.bool_]:
        """Every residual, while none has fired: then its level is that of the last samples."""
        return np.full(len(self._fired), not self._fired.any())

    def _take(
        self, time: Array, batch: Batch, samples: Array, every: Array, out: list[Verdict]
    ) -> None:
        """Add samples to the row; when it is full, look at it."""
        self._piece.append(samples.copy())
        self._filled += len(samples)
        if self._filled < self._every:
            return
        whole = np.concatenate(self._piece) if len(self._piece) > 1 else self._piece[0]
        slopes = every[-1]
        self._sizes.add(whole)
        valid = batch.valid[-1]
        value, bound = batch.value[-1], batch.bound[-1]
        row = _Row(
            float(time[-1]), whole, self._before, value, self._weight(value, bound, valid), slopes
        )
        self._piece, self._filled, self._before = [], 0, self._copy()
        self._past.append(row)
        if self._limits is None:
            self._learn(row, valid)
            return
        self._sum(row, bound, valid, out)
        if self._steps is not None:
            self._step_row(row)
            self._after += 1
            self._judge(row, out)
            self._over(row, bound, valid, out)
        elif not self._fired.any():
            self._remember(row, bound)

    def _remember(self, row: _Row, bound: Array) -> None:
        """Learn from a row once the ones behind it are calm too: before an alarm a fault acts."""
        assert self._limits is not None
        half = 0.5 * self._limits[:, 2] * self._limits[:, 0]
        if (self._streak > 0).any() or (np.abs(row.value) - bound > half).any():
            self._calm.clear()
            return
        self._calm.append(row)
        if len(self._calm) > _CALM:
            old = self._calm.popleft()
            self._history.add(old.value, old.weight, old.slopes, 1.0 - 1.0 / _FORGET)

    def _weight(self, value: Array, bound: Array, valid: npt.NDArray[np.bool_]) -> Array:
        sigma = np.ones(len(value)) if self._limits is None else self._limits[:, 0]
        variance = _CORRELATED * sigma**2 + (_MODEL_ERROR * bound) ** 2
        variance = variance + (_SLOPE_ERROR * value) ** 2
        return np.where(valid & (variance > 0), 1.0 / np.maximum(variance, 1e-300), 0.0)

    def _warmth(self, time: Array, valid: npt.NDArray[np.bool_], out: list[Verdict]) -> None:
        """Say so once all are valid that ever will be: the slowest filter has settled."""
        settled = valid[:, self._used].all(axis=1)
        if self._warm or not settled.any():
            return
        self._warm = True
        names = [n for n, used in zip(self._engine.residuals, self._used, strict=True) if used]
        verb = "is" if len(names) == 1 else "are"
        message = f"{listed(names, 'and')} {verb} watched from now on"
        at = float(time[int(np.argmax(settled))])
        out.append(Verdict("warm-up", at, message=message))

    def _learn(self, row: _Row, valid: npt.NDArray[np.bool_]) -> None:
        """Noise from the differences of neighbouring rows, where nobody has tuned."""
        self._learned.append(np.where(valid, row.value, math.nan))
        if len(self._learned) < _LEARNING:
            return
        values = np.array(self._learned)
        steps = np.abs(np.diff(values, axis=0)) / math.sqrt(2.0)
        known = np.isfinite(steps).sum(axis=0) >= _LEARNING // 2
        if not known.any():
            self._learned.pop(0)
            return
        size = np.nanmax(np.abs(values), axis=0, initial=0.0, where=np.isfinite(values))
        middle = np.array([np.nanmedian(s) if ok else 0.0 for s, ok in zip(steps.T, known)])  # noqa: B905
        sigma = np.where(known, np.maximum(2.0 * 1.4826 * middle, 1e-9 * size), math.inf)
        crossings = self._engine.bandwidth / 4.0
        alarms = _DEFAULT_ALARMS / 3600.0 / (2 * max(1, int(known.sum())))
        rows = 1.0 / (self._every * self._engine.sample_time)
        limit = kappa(crossings, alarms), height(rows, alarms)
        self._limits = np.array([[s, crossings, *limit] for s in sigma])
        self._learned.clear()

    # --------------------------------------------------------------------- alarms

    def _sum(
        self, row: _Row, bound: Array, valid: npt.NDArray[np.bool_], out: list[Verdict]
    ) -> None:
        """Row by row: the sum of what is too much, to either side (Page, 1954)."""
        assert self._limits is not None
        sigma, top = self._limits[:, 0], self._limits[:, 3]
        after = np.minimum(grown(self._sums, row.value, bound, sigma), 2.0 * top)
        self._sums = np.where(valid, after, 0.0)
        fresh = (self._sums.max(axis=0) > top) & ~self._fired
        if fresh.any():
            self._fire(row.time, fresh, out)

    def _fire(self, time: float, fresh: npt.NDArray[np.bool_], out: list[Verdict]) -> None:
        first = not self._fired.any()
        self._fired |= fresh
        self._calm.clear()
        self._quiet = 0
        if first:
            since = self._onset(time)
            self._latched = {"since": since, "said": None}
            names = listed(
                [n for n, f in zip(self._engine.residuals, fresh, strict=True) if f], "and"
            )
            message = f"{names} above what a healthy machine does; looking for the fault"
            out.append(Verdict("fault", time, since, self._levels(), message=message))

    def _levels(self) -> dict[str, float]:
        found = zip(self._engine.residuals, self._most, self._fired, strict=True)
        return {name: round(float(most), 3) for name, most, fired in found if fired}

    def _onset(self, time: float) -> float:
        """Begin to compare faults at the last row that was as it had been before."""
        assert self._limits is not None
        past = list(self._past)
        start = len(past) - 1
        while start > 0 and self._odd(past[start]):
            start -= 1
        begin = max(0, start)  # its samples are still healthy ones, the fault begins behind them
        self._after = 0
        self._rows = []
        if not past:
            self._begin(self._before)
            return time
        chosen = past[begin + 1 :]
        self._begin(chosen[0].engine if chosen else self._before)
        for row in chosen:
            self._step_row(row)
        return past[begin].time

    def _begin(self, engine: Engine) -> None:
        facts = self._facts
        self._all = hypotheses(self._engine, facts.faults, facts.units, self._sizes.found())
        copy = engine.configured(bounds=False)
        copy.follow(engine)
        self._steps = Bank(copy, self._all, self._nominal)

    def _odd(self, row: _Row) -> bool:
        """Whether a fired residual is not what the history lets expect."""
        expected, variance = self._history.expected(row.slopes)
        own = np.where(row.weight > 0, 1.0 / np.maximum(row.weight, 1e-300), math.inf)
        off = np.abs(row.value - expected) > 3.0 * np.sqrt(variance + own)
        return bool((off & (self._fired if self._fired.any() else True)).any())

    def _step_row(self, row: _Row) -> None:
        """One more row of what every fault would have done since the onset."""
        assert self._steps is not None
        slopes = self._steps.run(row.samples)[-1]
        early = _ONSET_ERROR * _ONSET_FADES ** len(self._rows)
        variance = np.divide(1.0, row.weight, out=np.full_like(row.weight, math.inf),
                             where=row.weight > 0) + (early * row.value) ** 2  # fmt: skip
        self._rows.append(Rows(row.value, 1.0 / variance, row.slopes, slopes))
        del self._rows[_MOST:]  # by then it is known as well as it will be

    # ------------------------------------------------------------------ judgement

    def _judge(self, row: _Row, out: list[Verdict]) -> None:
        """Name the fault when there is enough to go by, and again when that changes."""
        due = self._after >= _JUDGE and (self._after < 10 or self._after % _AGAIN == 0)
        if not due or self._latched is None or not self._rows:
            return
        rows = Rows(*[np.array(x) for x in zip(*self._rows, strict=True)])
        try:
            found = explain(rows, self._all, self._history)
        except np.linalg.LinAlgError:
            return
        verdict = self._verdict(row.time, [self._possible(e) for e in found])
        said = [list(verdict.group), verdict.candidates[0].fault]
        if said != self._latched["said"]:
            self._latched["said"] = said
            out.append(verdict)

    def _possible(self, explained: Explained) -> Explained:
        """No fault turns a parameter into its opposite: what would need that is no explanation."""
        nominal = self._nominal.get(explained.fault)
        if nominal:
            left = 1.0 - explained.change / nominal  # of the value, as the machine has it now
            if left < -0.1 - 3.0 * explained.deviation / abs(nominal):
                return explained._replace(evidence=-math.inf)
        return explained

    def _verdict(self, time: float, found: Sequence[Explained]) -> Verdict:
        assert self._latched is not None
        chance = probabilities(found)
        best = max(found, key=lambda e: e.evidence)
        classes = {g: sum(chance.get(f, 0.0) for f in g) for g in self._facts.groups}
        group = max(classes, key=lambda g: classes[g])
        twice, self._leads = self._leads == group, group
        sure = classes[group] >= _SURE and best.share >= _EXPLAINS and twice
        shown = sorted((e for e in found if chance[e.fault] >= _SHOWN),
                       key=lambda e: (-chance[e.fault], e.fault))  # fmt: skip
        candidates = tuple(self._candidate(e, chance[e.fault]) for e in shown)
        message = ""
        if best.share < _EXPLAINS:
            message = "no single fault explains this: several at once, or one that is not modelled"
        return Verdict(
            "update",
            time,
            self._latched["since"],
            self._levels(),
            group if sure else (),
            candidates,
            message,
        )

    def _candidate(self, explained: Explained, chance: float) -> Candidate:
        """A fault with the change that fits best: of the machine where it has changed."""
        hypothesis, change = explained.hypothesis, explained.change
        size = -change if hypothesis.turned else change
        if hypothesis.kind == "gain" and not hypothesis.turned:
            size = size / max(1.0 - size, 1e-3)  # of what is true, not of what is told
        if hypothesis.kind == "gain":
            return Candidate(explained.fault, 100.0 * size, "%", round(chance, 4))
        return Candidate(explained.fault, size, hypothesis.unit, round(chance, 4))

    def _over(
        self, row: _Row, bound: Array, valid: npt.NDArray[np.bool_], out: list[Verdict]
    ) -> None:
        """A fault is over when its residuals have been quiet for long enough."""
        assert self._limits is not None
        excess = np.abs(row.value) - bound
        loud = valid & (excess > 0.5 * self._limits[:, 2] * self._limits[:, 0])
        self._quiet = 0 if (loud & self._fired).any() or not valid.any() else self._quiet + 1
        if self._quiet < _BACK:
            return
        names = listed(
            [n for n, f in zip(self._engine.residuals, self._fired, strict=True) if f], "and"
        )
        assert self._latched is not None
        message = f"{names} back to what a healthy machine does; what was said stays said"
        out.append(Verdict("cleared", row.time, self._latched["since"], message=message))
        self._fired[:] = False
        self._most[:] = 0.0
        self._sums[:] = 0.0
        self._steps, self._rows, self._latched = None, [], None

    # ---------------------------------------------------------------- persistence

    def state(self) -> dict[str, Any]:
        """All that `resume` needs, as plain JSON."""
        limits = None if self._limits is None else _numbers(self._limits)
        return {
            "limits": limits,
            "matrix": self._history.matrix.tolist(),
            "vector": self._history.vector.tolist(),
            "fired": self._fired.tolist(),
            "most": _numbers(self._most),
            "latched": self._latched,
        }

    def resume(self, state: dict[str, Any]) -> None:
        """Go on from a state: limits that were learned, what is known of parameters and faults."""
        self.restart()
        if self._limits is None and state["limits"] is not None:
            self._limits = _array(state["limits"])
        matrix = np.array(state["matrix"], dtype=float)
        if matrix.shape == self._history.matrix.shape:
            self._history.matrix = matrix
            self._history.vector = np.array(state["vector"], dtype=float)
        self._latched = state["latched"]
        self._fired = np.array(state["fired"], dtype=bool)
        self._most = _array(state["most"])
        if self._latched is not None and self._limits is not None:
            self._begin(self._before)  # onset and samples are gone: compare from here on


def _numbers(values: Array) -> list[Any]:
    """An array as JSON can hold it: None for what is not finite."""
    return [
        _numbers(v) if isinstance(v, np.ndarray) else (float(v) if math.isfinite(v) else None)
        for v in values
    ]


def _array(values: Sequence[Any]) -> Array:
    return np.array(
        [[math.inf if v is None else v for v in row] if isinstance(row, list) else
         (math.inf if row is None else row) for row in values], dtype=float)  # fmt: skip
