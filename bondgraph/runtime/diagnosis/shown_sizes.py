"""What limits let a monitor see: from which size on a fault shows, when, and in what."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence

import numpy as np

from bondgraph.ir.residual_limit import ShownSize
from bondgraph.runtime.diagnosis.healthy import DiagnosisModel, directions
from bondgraph.runtime.diagnosis.history import HEALTHY, History
from bondgraph.runtime.diagnosis.hypotheses import ALL, Bank, Hypothesis, rows_apart
from bondgraph.runtime.diagnosis.noise import COVERED, left_for_drift
from bondgraph.runtime.diagnosis.row_averages import LAGS
from bondgraph.runtime.diagnosis.rows import model_error
from bondgraph.runtime.diagnosis.standing import followed
from bondgraph.runtime.diagnosis.tuning import UNKNOWN, Limit, limits
from bondgraph.runtime.diagnosis.whole_thresholds import WholeThresholds
from bondgraph.runtime.log import Array, Mask
from bondgraph.runtime.monitoring.engine import Batch, Engine, copied
from bondgraph.text.tuples import NamedTuple

_SURE = 0.9  # share of the windows in which the smallest change shows
_LEAST = 0.1  # that in which a change may show
_LUCK = 1.28  # deviations that noise is against a fault by at most, nine times of ten
_ALONG = Limit._fields.index("along")
_TIMES = 20  # in a window, at which it is asked what shows so far


class Shown(NamedTuple):
    """What can be seen of one hypothesis: the smallest change that is sure to show.

    `size` in the unit of the hypothesis (None: nothing moves), in nine windows of ten; `delay` is
    the median time in s until it shows. `residual` is the one that shows it first most often. A
    storage that becomes another one keeps what it holds, and what is measured of it jumps; where
    nothing jumps, as of what comes on slowly, it takes a change of `smooth`. What shows at so many
    times of the window, by a sample or by a sum of rows, is its `course`, infinite before anything
    does. What shows in fewer windows than that, as of a fan while it is off, does in this `share`.
    """

    hypothesis: Hypothesis
    size: float | None
    delay: float | None
    residual: str
    smooth: float | None = None
    course: tuple[float, ...] = (math.inf,) * _TIMES
    share: float = 0.0


class _Seen(NamedTuple):
    """Of one window: the smallest change that shows, when, and in which residual; for each residual
    the one that may show in it, and the one that does with a threshold that never moves; and what
    shows so far, by sums too, in the `course` of the window.
    """

    size: float
    delay: float
    residual: int
    least: Array
    sure: Array
    course: Array


class _Known(NamedTuple):
    """Of rows of a window, (rows, ...): what a watch leaves room for that knows the machine, slopes
    by tolerated parameters, what no parameter explains; and what it knows."""

    room: Array
    slopes: Array
    doubt: Array
    history: History


class ShownSizes:
    """Collects from healthy logs what faults would show in them, each begun in every window.

    `all_` are the hypotheses, `known` the limits by residual, `window` is how long each fault is
    taken to be there, in s. `rigid` are thresholds that never move, by residual.
    """

    def __init__(
        self,
        engine: Engine,
        model: DiagnosisModel,
        all_: Sequence[Hypothesis],
        known: Mapping[str, Limit],
        window: float,
        rigid: Array,
    ) -> None:
        self._model, self._all, self._rigid = model, all_, rigid
        self._names, self._every = engine.residuals, rows_apart(engine)
        self._table = np.array(limits(known, engine.residuals), dtype=float)
        self._length = max(2, round(window / engine.sample_time))
        self._level = followed(self._table, -(-self._length // self._every), HEALTHY)
        # each as what may jump; behind them those that need not
        self._lasting = [h for h in all_ if h.fault in model.dynamic]
        self._front = [max(model.dynamic[h.fault]) for h in self._lasting]
        self._ways = [*all_, *self._lasting]
        #: The whole of what each way changes, 0 where it has no direction (see `directions`).
        along = dict(zip(*directions(all_, model), strict=True))
        self._whole = np.abs([float(along.get(h, 0.0)) for h in self._ways])
        tolerances, nominal = model.tolerances, model.nominal
        self._tolerated = np.array([
            tolerances.get(h.fault, 0.0) * abs(nominal.get(h.fault, 0.0)) for h in self._ways
        ])
        self._found: list[list[_Seen]] = [[] for _ in self._ways]

    def add(self, samples: Array, whole: WholeThresholds, history: History) -> None:
        """Take the windows of one more log, whose thresholds begin with it, and what it tells."""
        engine = whole.engine
        start = math.ceil(engine.warm_up / engine.sample_time) + 1
        behind = engine.configured(bounds=False)  # where it was a warm-up ago
        whole.run(samples[:start])
        for begin in range(start, len(samples) - self._length + 1, self._length):
            part = samples[begin : begin + self._length]
            slopes = self._moved(engine, behind, samples[begin - start : begin], part)
            if self._lasting:
                behind.run(samples[begin - start : begin - start + self._length])
            batch, tolerated, doubt = whole.run(part)
            if self._ways:
                known = self._known(batch.bound, tolerated, doubt, history)
                seen = self._seen(slopes, batch, known, engine.sample_time)
                for own, one in zip(self._found, seen, strict=True):
                    own.append(one)

    def _moved(self, engine: Engine, behind: Engine, past: Array, part: Array) -> Array:
        """What each way does to residuals in a window, (n, ways, residuals), of a unit.

        One engine stands before the window, the other one `behind`, before the samples of the past.
        """
        nominal, last = self._model.nominal, past[-1]
        moved = Bank(copied(engine), self._all, nominal, last).run(part)
        if not self._lasting:
            return moved
        always = Bank(copied(behind), self._lasting, nominal)
        left = always.run(past, [len(past) - 1])[0]
        jumps = Bank(copied(engine), self._lasting, nominal, last) if 1 in self._front else None
        found = []
        for front in (0, 1)[: 1 + (jumps is not None)]:
            bank = always.copied()
            bank.onset(left, jumps if front else None)
            found.append(bank.run(part))
        for k, h in enumerate(self._lasting):
            if self._front[k] < ALL:
                moved[:, self._all.index(h)] = found[int(self._front[k])][:, k]
        return np.concatenate([moved, found[0]], axis=1)

    def shown(self) -> tuple[Shown, ...]:
        """What can be seen of each hypothesis, in the order of all."""
        every = [_shown(way, own, self._names)
                 for way, own in zip(self._ways, self._found, strict=True)]  # fmt: skip
        count = len(self._all)
        smooth = {one.hypothesis: one.size for one in every[count:]}
        return tuple(
            one._replace(smooth=smooth.get(one.hypothesis, one.size)) for one in every[:count]
        )

    def by_fault(self) -> dict[str, dict[str, ShownSize]]:
        """By residual and fault, from which size on the fault shows (see `_by_fault`)."""
        return _by_fault(self._ways, self._found, self._names)

    def _known(self, bound: Array, tolerated: Array, doubt: Array, history: History) -> _Known:
        """What a watch that has seen healthy rows leaves room for in the rows of a window."""
        rows, slopes = self._rows(left_for_drift(bound, doubt)), self._rows(tolerated)
        variance = np.zeros_like(rows)
        for k, own in enumerate(slopes):
            variance[k] = history.expected(own)[1]
        return _Known(rows + UNKNOWN * np.sqrt(variance), slopes, self._rows(doubt), history)

    def _rows(self, samples: Array) -> Array:
        """The means of whole rows."""
        count = len(samples) // self._every
        whole = samples[: count * self._every].reshape(count, self._every, *samples.shape[1:])
        return np.asarray(whole.mean(axis=1))

    def _seen(
        self, moved: Array, batch: Batch, known: _Known, sample_time: float
    ) -> list[_Seen]:
        """Of one window, what shows of each way; `moved` is (n, ways, residuals)."""
        slopes, own, bound = np.abs(moved), self._table, batch.bound[:, None]
        room = 2.0 * bound - np.minimum(self._tolerated[:, None] * slopes, bound)
        top = own[:, 2] * own[:, 0]
        shows = (batch.valid & np.isfinite(top))[:, None]
        least = _size(room + top, slopes, shows)
        sure = _size(2.0 * self._rigid + top, slopes, shows).min(axis=0)
        course = self._course(np.where(shows, moved, 0.0), room, known)
        found = []
        for k in range(len(self._ways)):
            of_way = least[:, k]
            at, residual = np.unravel_index(int(np.argmin(of_way)), of_way.shape)
            found.append(_Seen(
                float(of_way[at, residual]),
                (int(at) + 1) * sample_time,
                int(residual),
                of_way.min(axis=0),
                sure[k],
                course[:, k],
            ))
        return found

    def _course(self, moved: Array, room: Array, known: _Known) -> Array:
        """The smallest change that has shown at each of so many times, by a sample or by a sum.

        All are beside a level that is followed (see `Levels`, `Cusum` and `ScoreSums`), sums beside
        a machine that is known. Of each way.
        """
        own, level = self._table, self._level
        count = len(moved) // self._every
        deviation, share = (np.repeat(x, self._every, axis=0)[: len(moved), None] for x in level)
        beyond = own[:, 2] * np.hypot(own[:, 0], deviation)
        course = _size(room + beyond, np.abs(moved * share), np.isfinite(beyond)).min(axis=2)
        ends = slice(self._every - 1, count * self._every, self._every)
        rows, unsure = self._rows(moved * share), UNKNOWN * level[0][:count]
        for found in (self._by_sums(rows, known.room + unsure), self._by_scores(rows, known)):
            course[ends] = np.minimum(course[ends], found.min(axis=2, initial=math.inf))
        times = np.ceil(np.arange(1, _TIMES + 1) * len(course) / _TIMES).astype(int) - 1
        return np.asarray(np.minimum.accumulate(course, axis=0)[times])

    def _by_sums(self, rows: Array, room: Array) -> Array:
        """What sums of rows show so far, (rows, ways, residuals), in nine of ten.

        A healthy machine may be anywhere in the `room`, against the fault, too.
        """
        own = self._table
        unit = np.where(own[:, 6] > 0.0, own[:, 6], own[:, 0] * np.sqrt(own[:, 5]))
        count = np.arange(1.0, len(rows) + 1.0)[:, None]
        need = own[:, 3] * unit + np.cumsum(2.0 * self._white(room) + 0.5 * unit, axis=0)
        need = (need + _LUCK * unit * np.sqrt(count))[:, None]
        return _size(need, np.abs(np.cumsum(self._white(rows), axis=0)), np.isfinite(need))

    def _by_scores(self, rows: Array, known: _Known) -> Array:
        """What sums along a fault show so far, (rows, ways, residuals), in nine of ten."""
        own, history = self._table, known.history
        if not len(rows):
            return np.empty(rows.shape)
        moved, slopes = self._white(rows), self._white(known.slopes)
        count = np.arange(1.0, len(rows) + 1.0)[:, None, None]
        with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
            variance = own[:, 6] ** 2 + model_error(0.0 * known.room, self._white(known.room))
            weight = moved / np.where(own[:, 6] > 0.0, variance, math.nan)[:, None]
            tells = np.cumsum(weight * moved, axis=0)
            step = np.sqrt(tells[-1] / np.sum((weight * moved) ** 2, axis=0))
            less = np.maximum.accumulate(_by_others(weight, slopes, history), axis=0)
            less += np.cumsum(np.abs(weight) * self._white(known.doubt)[:, None], axis=0)
            less *= 2.0  # as in sums
            less += count / self._whole[:, None] + _LUCK * np.sqrt(tells)
            need = own[:, _ALONG] / step + 0.5 * step * tells + less
            return _size(need, tells, np.isfinite(need) & (own[:, _ALONG] > 0.0))

    def _white(self, rows: Array) -> Array:
        """Rows (n, ..., residuals) with so much of those before as leaves averages no memory."""
        found = rows.copy()
        for k in range(1, min(LAGS, len(rows) - 1) + 1):
            found[k:] += self._table[:, 7 + k] * rows[:-k]
        return found


def _by_others(weight: Array, slopes: Array, history: History) -> Array:
    """What healthy parameters add to each score so far, (rows, ways, residuals), see `ScoreSums`.

    The `weight` of rows is of that shape, `slopes` are (rows, parameters, residuals).
    """
    drift = COVERED * math.sqrt(3.0) * history.prior
    products = np.zeros((len(drift), *weight.shape[1:]))
    found = np.zeros(weight.shape)
    for k, (row, own) in enumerate(zip(weight, slopes, strict=True)):
        products += own[:, None] * row
        unknown = history.expected(products.reshape(len(drift), row.size))[1]
        found[k] = np.tensordot(drift, np.abs(products), 1)
        found[k] += UNKNOWN * np.sqrt(unknown.reshape(row.shape))
    return found


def _size(need: Array, slopes: Array, shows: Mask) -> Array:
    """The change that moves residuals as far as needed; infinite where it cannot show."""
    return np.divide(need, slopes, out=np.full_like(slopes, math.inf), where=shows & (slopes > 0))


def _by_fault(
    all_: Sequence[Hypothesis], found: Sequence[Sequence[_Seen]], residuals: Sequence[str]
) -> dict[str, dict[str, ShownSize]]:
    """By residual and fault, from which size on the fault shows, in whatever way it is wrong.

    Beside the smallest size that is sure to show in any residual in the same window: what a machine
    that hardly moves shows of nothing does not count, and ways of different units compare.
    """
    by: dict[str, dict[str, ShownSize]] = {name: {} for name in residuals}
    for one, windows in zip(all_, found, strict=True):
        units = [float(s.sure.min()) for s in windows]
        moved = [(s, unit) for s, unit in zip(windows, units, strict=True) if math.isfinite(unit)]
        if not moved:
            continue
        last = len(moved) - 1
        least = np.sort([s.least / unit for s, unit in moved], axis=0)[math.floor(_LEAST * last)]
        sure = np.sort([s.sure / unit for s, unit in moved], axis=0)[math.ceil(_SURE * last)]
        for k, name in enumerate(residuals):  # a way that does not move one may be what is wrong
            own = ShownSize(float(least[k]), float(sure[k]))
            was = by[name].get(one.fault, own)
            by[name][one.fault] = ShownSize(min(was.least, own.least), max(was.sure, own.sure))
    return {
        name: {f: size for f, size in faults.items() if math.isfinite(size.least)}
        for name, faults in by.items()
    }


def _shown(hypothesis: Hypothesis, found: Sequence[_Seen], residuals: Sequence[str]) -> Shown:
    if not found:
        return Shown(hypothesis, None, None, "")
    at = min(len(found) - 1, math.floor(_SURE * len(found)))
    course = tuple(np.sort([s.course for s in found], axis=0)[at].tolist())
    size = sorted(s.size for s in found)[at]
    seen = [s for s in found if math.isfinite(s.size)]
    share = len(seen) / len(found)
    if not math.isfinite(size) or not seen:
        return Shown(hypothesis, None, None, "", course=course, share=share)
    delay = float(np.median([s.delay for s in seen]))
    often = np.bincount([s.residual for s in seen])
    first = residuals[int(np.argmax(often))]
    return Shown(hypothesis, size, delay, first, course=course, share=share)
