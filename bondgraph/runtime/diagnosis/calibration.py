"""From healthy samples and a wanted rate of false alarms to limits."""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Callable, Iterator, Mapping, Sequence
from types import MappingProxyType

import numpy as np

from bondgraph.ir.residual_limit import NEVER
from bondgraph.runtime.diagnosis.cusum import Cusum
from bondgraph.runtime.diagnosis.healthy import (
    DiagnosisModel,
    centred,
    directions,
    drifting,
    tolerated,
)
from bondgraph.runtime.diagnosis.history import HEALTHY, History
from bondgraph.runtime.diagnosis.hypotheses import (
    Bank,
    Sizes,
    hypotheses,
    rows_apart,
    sized,
)
from bondgraph.runtime.diagnosis.noise import (
    CAREFUL,
    FILTERED,
    Noise,
    noise,
    stepped,
    uncovered,
    within,
)
from bondgraph.runtime.diagnosis.remembered import up_to_gaps
from bondgraph.runtime.diagnosis.row_averages import WHITE, lasting
from bondgraph.runtime.diagnosis.rows import Row, averaged, beside, steady, weight
from bondgraph.runtime.diagnosis.score_sums import ScoreSums
from bondgraph.runtime.diagnosis.shown_sizes import Shown, ShownSizes
from bondgraph.runtime.diagnosis.standing import FIRST, Levels, apart
from bondgraph.runtime.diagnosis.started import started
from bondgraph.runtime.diagnosis.tuning import Limit, Tuning, height, kappa, limits
from bondgraph.runtime.diagnosis.wander import NONE, Wander, wander
from bondgraph.runtime.diagnosis.whole_thresholds import WholeThresholds
from bondgraph.runtime.log import Array
from bondgraph.runtime.monitoring.engine import Batch, Engine, copied
from bondgraph.text.tuples import NamedTuple

_TESTS = 4  # of each residual: samples, sums of rows and of averages, how loud rows are
_TAIL = 3.29  # standard deviations that one normal sample in a thousand exceeds
_ABOVE = 1.2  # times the largest excess of a healthy machine that a limit stays above
_ACCURACY = 1e-7  # of the terms of a residual: that of a simulation, and of floats of 32 bits
_NOTHING = 1e-150  # of a residual that nothing moves
_CHUNK = 5000  # samples at a time
_APART = 16  # rows without a value between two logs, more than noise is taken to remember


class Tuned(NamedTuple):
    """A tuning with what follows from it, for one bandwidth.

    `lost` are the seconds of the logs, by residual, behind gaps where nobody knows its start.
    """

    tuning: Tuning
    shown: tuple[Shown, ...]
    window: float
    lost: Mapping[str, float] = MappingProxyType({})


def tune(
    engine: Engine,
    model: DiagnosisModel,
    logs: Sequence[Array],
    digest: str,
    false_alarms: float,
    window: float = 2.0,
    progress: Callable[[float], None] = lambda _: None,
    later: Sequence[bool] = (),
) -> Tuned:
    """Limits for an engine, from `logs` of healthy machines: (n, signals) samples each.

    `false_alarms` wanted per hour; a fault is taken to be there for a `window` of seconds, and for
    as long as the longest delay besides. Every log may be of another machine, with parameters of
    its own inside their tolerances. Some are the `later` parts of a log, behind a gap: there
    residuals that keep something of their first sample tell nothing. Raises ValueError where the
    logs are too short to be of use.
    """
    work = _Work(engine, model, logs, later)
    window += engine.lags[-1]
    total = 2 * len(logs)
    learned = work.learned(logs, lambda k: progress(k / total))
    if work.walks(learned):
        learned = work.learned(logs, lambda _: None)
    seconds = sum(n.rows for n in learned) * engine.sample_time
    if seconds <= 0:
        raise ValueError(
            f"no log is longer than the warm-up of {engine.warm_up:g} s: nothing can be learned"
            + up_to_gaps(engine.residuals, work.lost)
        )
    found = _limits(engine, learned, false_alarms, centred(model, engine.residuals), work)
    bounds = dict(zip(engine.residuals, np.max([n.bound for n in learned], axis=0).tolist(),
                      strict=True))  # fmt: skip
    tuning = Tuning(
        digest, 1 / engine.sample_time, engine.bandwidth, false_alarms, seconds, found, bounds
    )
    rigid = np.array([bounds[name] for name in engine.residuals])
    shows = ShownSizes(engine, model, work.all, found, window, rigid)
    held = np.array([limit.held for limit in limits(found, engine.residuals)])
    for k, log in enumerate(logs):
        least = int(work.lasts[k].min(initial=len(log)))
        told = work.histories.get(k, History(work.spread))
        shows.add(log[:least], work.thresholds(k, held), told)
        progress((len(logs) + k + 1) / total)
    lost = {n: s for n, s in zip(engine.residuals, work.lost.tolist(), strict=True) if s}
    whole = tuning._replace(shows=shows.by_fault(), window=window)
    return Tuned(whole, shows.shown(), window, lost)


class _Noise(NamedTuple):
    """Of one log: how many valid samples, by residual the upward crossings of its mean, the level
    that one sample in a thousand exceeds beside it, the largest excess over the threshold to either
    side; the rows, those of the warm-up too, with how far samples of each are above the threshold
    and below it at most, and what is left of the others beside parameters and is not covered by
    tolerances, and of their averages; the largest threshold."""

    rows: int
    crossings: Array
    tail: Array
    excess: Array
    every: tuple[Row, ...]
    peaks: tuple[Array, ...]
    rest: Array
    averages: Array
    bound: Array


class _Work:
    def __init__(
        self,
        engine: Engine,
        model: DiagnosisModel,
        logs: Sequence[Array],
        later: Sequence[bool] = (),
    ) -> None:
        self.engine = engine
        self.model = model
        #: Of each log what runs it from its start, and for how many samples residuals know that.
        begun = [started(engine, model, log, own)
                 for log, own in zip(logs, later or (False,) * len(logs), strict=True)]  # fmt: skip
        self.engines, self.lasts = [own for own, _ in begun], [last for _, last in begun]
        far = [len(log) - own for log, own in zip(logs, self.lasts, strict=True)]
        self.lost = np.zeros(len(engine.residuals)) + engine.sample_time * np.sum(far, axis=0)
        sizes = Sizes(engine)
        for log in logs:
            sizes.add(log)
        found = hypotheses(engine, model.faults, model.units, sizes.found(), zeros=model.signs)
        longest = max(logs, key=len, default=np.empty((0, len(engine.signals))))[:_CHUNK]
        self.all = sized(engine, found, self.model.nominal, longest)
        self.tolerated, self.spread = tolerated(self.all, model)
        self.directions, self.sizes = directions(self.all, model)
        self.every = rows_apart(engine)
        self.least = _ACCURACY * self._terms(longest)
        modes = [model.natures[name].modes for name in engine.residuals]
        #: What half a sample of commands makes in these logs is in the noise, but behind a switch.
        self.free = np.array([0.0 if own else math.inf for own in modes])
        self.held = np.zeros(len(modes))
        self._drifts = [model.natures[name].drifts for name in engine.residuals]
        #: By number of a log what it tells of its machine.
        self.histories: dict[int, History] = {}
        #: Of residuals whose noise adds up, how far they go in a row and what noise is beside.
        self.walk, self.beside = np.zeros(len(modes)), np.zeros(len(modes))

    def learned(self, logs: Sequence[Array], progress: Callable[[int], None]) -> list[_Noise]:
        """What each log tells, but for those that are no longer than the warm-up."""
        found = []
        for k, log in enumerate(logs):
            own = self.noise(k, log)
            if own is not None:
                found.append(own)
            progress(k + 1)
        return found

    def walks(self, logs: Sequence[_Noise]) -> bool:
        """Whether residuals that add up readings go further in some log than their noise.

        An integral of what encoders count does not, nor one that a limit keeps where it is.
        """
        for log in logs:
            for k in [k for k, drifts in enumerate(self._drifts) if drifts]:
                rows = log.rest[:, k]
                found = wander(rows)
                if found.step * math.sqrt(np.isfinite(rows).sum()) > found.noise:
                    self.walk[k] = max(self.walk[k], found.step)
                self.beside[k] = max(self.beside[k], CAREFUL * stepped(rows))
        return bool(self.walk.any())

    def thresholds(self, number: int, held: Array) -> WholeThresholds:
        """Those of a log that begins, where so much of what commands make is in the noise."""
        own = self.engines[number], self.model, self.tolerated
        return WholeThresholds(*own, self.walk, held, self.lasts[number])

    def _parts(self, samples: Array) -> Iterator[Array]:
        """Whole rows of a log, some thousand samples at a time."""
        step = self.every * max(1, _CHUNK // self.every)
        for k in range(0, len(samples), step):
            yield samples[k : k + step]

    def _terms(self, samples: Array) -> Array:
        """How much signals move each residual at most; counts are exact, however far they are."""
        counted = {k.path for k in self.engine.signals if k.counts is not None}
        gains = [h for h in self.all if h.kind == "gain" and h.fault not in counted]
        moved = Bank(copied(self.engine), gains, self.model.nominal).run(samples)
        return np.asarray(np.abs(moved).max(axis=(0, 1), initial=0.0))

    def noise(self, number: int, samples: Array) -> _Noise | None:
        """What is left once parameters are taken as they fit best inside their tolerances.

        For as many samples as each residual lasts in the log with this number. None for one that is
        not longer than the warm-up.
        """
        start = math.ceil(self.engine.warm_up / self.engine.sample_time) + 1
        start += -start % self.every  # the rows are those of a monitor, which begin with the log
        if len(samples) <= start + self.every:
            return None
        history = History(self.spread)
        whole = next(self._chunks(samples[start:], samples[:start], number))[0].value
        rough = np.std(np.diff(whole[:: self.every], axis=0), axis=0)
        weight = 1.0 / np.maximum(rough, self.least + _NOTHING) ** 2
        every, peaks = [], []
        for batch, slopes, doubt in self._chunks(samples[start:], samples[:start], number):
            for k, row, peak in self._rows(batch, slopes, doubt):
                history.add(batch.value[k], weight * batch.valid[k], slopes[k], 1.0)
                every.append(row)
                peaks.append(peak)
        found, self.histories[number] = history.fit_within(), history
        # a residual with fewer stages than others is watched while these warm up
        early = list(self._chunks(samples[:start], samples[:0], number))
        excess = [_beyond(chunk[0]) for chunk in early]
        first = [own for chunk in early for own in self._rows(*chunk)]
        rest, spaced = [], []
        rows = sum(int(batch.valid.all(axis=1).sum()) for batch, _, _ in early)
        bound = np.zeros(len(self.engine.residuals))
        for batch, slopes, _ in self._chunks(samples[start:], samples[:start], number):
            left = batch.value - np.einsum("thr,h->tr", slopes, found)
            rest.append(np.where(batch.valid, left, np.nan))
            spaced.append(rest[-1][self.every - 1 :: self.every])
            excess.append(_beyond(batch))
            rows += int(batch.valid.any(axis=1).sum())
            bound = np.maximum(bound, batch.bound.max(axis=0, initial=0.0))
        left = np.concatenate(rest)
        off = np.nan_to_num(left - [_mean(column) for column in left.T])
        moves = self._moves(number, samples)
        return _Noise(
            rows,
            ((off[:-1] < 0) & (off[1:] >= 0)).sum(axis=0).astype(float),
            np.quantile(np.abs(off), 0.999, axis=0),
            np.max(excess, axis=0),
            tuple(
                row._replace(directions=own)
                for row, own in zip((*(row for _, row, _ in first), *every), moves, strict=True)
            ),
            (*(peak for *_, peak in first), *peaks),
            uncovered(np.concatenate(spaced), np.array([row.bound for row in every])),
            _averages(every, found),
            bound,
        )

    def _rows(
        self, batch: Batch, slopes: Array, doubt: Array
    ) -> Iterator[tuple[int, Row, Array]]:
        """The rows of a chunk, each with the number of its sample, and how far its samples go."""
        for k in range(self.every - 1, len(slopes), self.every):
            own = [x[k] for x in (*batch, doubt, slopes)]
            block = slice(k + 1 - self.every, k + 1)
            value, valid, bound = batch.value[block], batch.valid[block], batch.bound[block]
            mean = averaged(value, valid, bound, doubt[block], slopes[block])
            row = Row(0.0, np.empty((0, len(self.engine.signals))), self.engine, *own)
            yield k, row._replace(average=mean), _beyond(Batch(value, valid, bound))

    def _moves(self, number: int, samples: Array) -> Array:
        """How faults move residuals in the mean of each row, (rows, directions, residuals)."""
        bank = Bank(self.engines[number].configured(bounds=False), self.directions,
                    self.model.nominal)  # fmt: skip
        bank.reset()
        found = [np.empty((0, len(self.directions), len(self.engine.residuals)))]
        for part in self._parts(samples):
            ends = np.arange(self.every, len(part) + 1, self.every) - 1
            found.append(bank.rows(part, ends.tolist(), [self.every] * len(ends))[1])
        return np.concatenate(found)

    def _chunks(
        self, samples: Array, before: Array, number: int
    ) -> Iterator[tuple[Batch, Array, Array]]:
        """Residuals, slopes of what is tolerated, and doubt, some thousand samples at a time."""
        whole = self.thresholds(number, self.free)
        whole.run(before)
        for part in self._parts(samples):
            yield whole.run(part)
            self.held = np.maximum(self.held, whole.acted)


def _beyond(batch: Batch) -> Array:
    """How far each residual is above its threshold at most, and below, (2, residuals)."""
    sides = np.stack([batch.value, -batch.value]) - batch.bound
    return np.asarray(np.where(batch.valid, sides, -np.inf).max(axis=1, initial=-np.inf))


def _averages(rows: Sequence[Row], found: Array) -> Array:
    """What is left of the averages of rows, (rows, residuals), NaN where one is not whole."""
    left, bounds = [], []
    for row in rows:
        assert row.average is not None
        value, valid, bound, _, slopes = row.average
        left.append(np.where(valid, value - found @ slopes, np.nan))
        bounds.append(bound)
    return uncovered(np.array(left), np.array(bounds))


def _limits(
    engine: Engine, logs: Sequence[_Noise], false_alarms: float, stands: Sequence[bool],
    work: _Work,
) -> dict[str, Limit]:
    rows = sum(n.rows for n in logs)
    logs, far = _beside_their_own(logs, stands)
    tail = np.max([n.tail for n in logs], axis=0) / _TAIL
    crossings = np.sum([n.crossings for n in logs], axis=0) / (rows * engine.sample_time)
    excess = np.max([n.excess for n in logs], axis=0)
    apart = np.full((_APART, len(tail)), np.nan)
    rest = np.concatenate([np.vstack([n.rest, apart]) for n in logs])
    averages = np.concatenate([np.vstack([n.averages, apart]) for n in logs])
    used = np.isfinite(rest).any(axis=0) & (np.maximum(tail, work.least) > 0)
    alarms = false_alarms / 3600.0 / (_TESTS * max(1, int(used.sum())))
    often = 1.0 / (rows_apart(engine) * engine.sample_time)
    found = {}
    for k in np.flatnonzero(used).tolist():  # others were never valid in these logs
        own = noise(rest[:, k], centred=stands[k])
        rate = max(float(crossings[k]), engine.bandwidth / (2 * math.pi))
        asked = kappa(rate, alarms)
        least = float(work.least[k])
        sigma = max(own.foreseen(asked), float(tail[k]), least)
        top, bottom = excess[:, k].tolist()
        if work.walk[k]:  # no sum of a walk tells anything
            sigma = max(float(work.beside[k]), least)
            level = max(asked, _ABOVE * max(top, bottom) / sigma)
            limit = Limit(sigma, rate, level, NEVER.height, walk=float(work.walk[k]))
        else:
            limit = Limit(sigma, rate, asked, height(often, alarms), own.mean, own.memory)
            # what a single sample reached says nothing of the noise of averages
            mean = lasting(averages[:, k], 0.0, stands[k], asked)
            if math.isfinite(mean.unit):
                off = mean.mean - own.mean if stands[k] else 0.0
                unit = mean.unit * sigma / max(own.foreseen(asked), least)
                unit = max(unit, least * (1.0 + float(mean.weights.sum())))
                limit = Limit(*limit[:6], unit, off, *mean.weights.tolist())
            limit = _beside_its_level(limit, own, logs, k, least)
            if not limit.step:
                most = _ABOVE * max(top - own.mean, bottom + own.mean) / sigma
                limit = limit._replace(kappa=max(asked, most))
        held = float(work.held[k]) if work.free[k] else 0.0
        found[engine.residuals[k]] = limit._replace(held=held, apart=float(far[k]))
    return _higher(found, engine, work, logs)


def _beside_its_level(
    limit: Limit, own: Noise, logs: Sequence[_Noise], k: int, least: float
) -> Limit:
    """The limit of a residual whose noise is its `own` about a mean, as its level is followed.

    Beside that as many rows are independent as there are. Tails are as much longer than those of
    normal noise as they are about the mean. How far samples go is seen with `_higher`.
    """
    rows = _path(logs, k, lasts=False)
    path = _path(logs, k, lasts=True) if limit.unit > 0.0 else rows
    if not (path.step > 0.0 and rows.alone > 0.0):
        return limit
    beside = own._replace(sigma=rows.alone, memory=0.0, freedom=max(own.rows - 2.0, 1.0))
    wider = limit.sigma / own.foreseen(limit.kappa)
    sigma = min(max(wider * beside.foreseen(limit.kappa), least), limit.sigma)
    memory = (rows.lasting(own.sigma * math.sqrt(own.memory), FILTERED) / rows.alone) ** 2
    added = 1.0 + limit.before1 + limit.before2 + limit.before3 + limit.before4
    unit = added * wider * path.lasting(limit.unit / (added * wider), WHITE)
    return limit._replace(
        sigma=sigma,
        memory=max(memory, min(own.memory, 1.0)),
        unit=max(unit, min(least * added, limit.unit)),
        step=path.step,
        most=path.most,
    )


def _path(logs: Sequence[_Noise], k: int, lasts: bool) -> Wander:
    """How the level of a residual wanders in logs, in the mean of them by their rows."""
    values = [(n.averages if lasts else n.rest)[:, [k]] for n in logs]
    values = [np.where(within(one), one, np.nan)[:, 0] for one in values]
    found = [(wander(one), np.isfinite(one).sum()) for one in values]
    told = [(np.square(path), rows) for path, rows in found if path != NONE]
    if not told:
        return NONE
    squares, rows = zip(*told, strict=True)
    return Wander(*np.sqrt(np.average(np.array(squares), axis=0, weights=rows)).tolist())


def _beside_their_own(
    logs: Sequence[_Noise], stands: Sequence[bool]
) -> tuple[list[_Noise], Array]:
    """The logs with each residual beside where it stands in each, where logs stand apart in that,
    and how far they do, by residual."""
    far, shift = np.zeros(len(stands)), np.zeros((len(logs), len(stands)))
    for k in [k for k, own in enumerate(stands) if own]:
        far[k], shift[:, k] = apart([n.rest[:, k] for n in logs])
    return [
        n._replace(
            rest=n.rest - own,
            averages=n.averages - own,
            excess=n.excess - np.stack([own, -own]),
        )
        for n, own in zip(logs, shift, strict=True)
    ], far


def _higher(
    found: Mapping[str, Limit], engine: Engine, work: _Work, logs: Sequence[_Noise]
) -> dict[str, Limit]:
    """The same above what samples of healthy machines, watched so, and their sums come to."""
    residuals, values = engine.residuals, drifting(work.tolerated)
    own = np.array(limits(found, residuals), dtype=float)
    given = [h in work.tolerated for h in work.directions]
    scores = ScoreSums(work.sizes, len(own), healthy=True, tolerated=given)
    cusum = Cusum(len(own), healthy=True)
    sure = np.ones(len(own), dtype=bool)
    most, goes = np.zeros((2, len(own)))
    for log in logs:
        history, levels = History(work.spread), Levels.tuned(own)
        cusum.restart()
        scores.restart()
        waiting: deque[Row] = deque()
        mean = own[:, 4].copy()
        path = []
        for number, one in enumerate(log.every):
            row = _where_it_stands(one, number, mean, levels.unsure)
            most = np.maximum(most, levels.deviations(log.peaks[number] - [mean, -mean], own))
            new = history.innovation(row, sure)
            levels.ahead(alarmed=False)
            cusum.add(new, own)
            scores.add(new, own, history)
            waiting.append(row)
            moved = levels.learn(row.time, *beside(new, own), first=True)
            if len(waiting) > HEALTHY:
                old = waiting.popleft()
                moved += levels.learn(old.time, *beside(history.innovation(old, sure), own))
                history = history.drifted(values, rows=1)
                history.add(*steady(old, weight(old, own[:, 0])))
            mean += moved
            for later in waiting:
                later.lower(moved)
            if number >= FIRST:
                path.append((mean.copy(), levels.unsure))
        cusum.end()
        scores.end()
        goes = np.maximum(goes, _farthest(path) if path else 0.0)
    heights = dict(zip(residuals, cusum.heights(own[:, 3]).max(axis=0).tolist(), strict=True))
    along = dict(zip(residuals, scores.heights(own).max(axis=(0, 1), initial=0.0).tolist(),
                     strict=True))  # fmt: skip
    far = dict(zip(residuals, (_ABOVE * np.stack([most, goes]).T).tolist(), strict=True))
    return {
        name: limit._replace(
            kappa=max(limit.kappa, far[name][0]) if limit.step else limit.kappa,
            height=heights[name],
            along=along[name],
            goes=far[name][1] if limit.step else 0.0,
        )
        for name, limit in found.items()
    }


def _farthest(path: Sequence[tuple[Array, Array]]) -> Array:
    """How far levels (rows, residuals) surely went from their mean, each as sure as it is."""
    level, unsure = (np.array(x) for x in zip(*path, strict=True))
    off = np.abs(level - level.mean(axis=0))
    return np.asarray(np.where(off > unsure, off, 0.0).max(axis=0))


def _where_it_stands(row: Row, number: int, mean: Array, unsure: Array) -> Row:
    """A row beside a mean, with room for what is not known of that."""
    own = row.average
    assert own is not None
    bound, doubt = own.bound + unsure, own.doubt + unsure
    own = own._replace(value=own.value.copy(), bound=bound, doubt=doubt)
    bound, doubt = row.bound + unsure, row.doubt + unsure
    value = np.where(row.valid, row.value, 0.0)
    found = row._replace(time=number, value=value, bound=bound, doubt=doubt, average=own)
    found.lower(mean)
    return found


def _mean(column: Array) -> float:
    known = column[np.isfinite(column)]
    return float(known.mean()) if len(known) else 0.0
