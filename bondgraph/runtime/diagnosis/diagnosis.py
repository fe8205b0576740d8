"""From residuals to verdicts: when something is wrong, since when, and what it can be."""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np
import numpy.typing as npt

from bondgraph.runtime.diagnosis.comparison import Comparison
from bondgraph.runtime.diagnosis.doubt import Doubt
from bondgraph.runtime.diagnosis.healthy import DiagnosisModel, grown, slack, tolerated
from bondgraph.runtime.diagnosis.hypotheses import Bank, Sizes, hypotheses, rows_apart, sized
from bondgraph.runtime.diagnosis.isolation import History, inverse
from bondgraph.runtime.diagnosis.learning import Learning
from bondgraph.runtime.diagnosis.naming import LONGEST, candidates, classes, named, news, update
from bondgraph.runtime.diagnosis.onset import calm, odd
from bondgraph.runtime.diagnosis.origins import Origins, starts_in
from bondgraph.runtime.diagnosis.rows import Part, Row, together, usual, weight
from bondgraph.runtime.diagnosis.status import Telling
from bondgraph.runtime.diagnosis.tuning import Tuning, limits
from bondgraph.runtime.log import Array
from bondgraph.runtime.monitoring.engine import Batch, Engine
from bondgraph.runtime.monitoring.plain import array, numbers
from bondgraph.runtime.monitoring.verdict import Verdict

_MEMORY = 60.0  # rows of the past that are kept, to go back to the onset
_FORGET = 1000.0  # rows after which healthy operation counts a third
_JUDGE = 5  # rows after an alarm before a fault is named
_AGAIN = 5  # rows between later judgements
_CALM = 5  # rows that have to be calm behind one before it counts as healthy
_BACK = 10  # rows that residuals must be quiet before a fault is over, twice as many each time


class Diagnosis:
    """A `Decision`: thresholds and CUSUM say that something is wrong, evidence says what.

    The engine is the model's own; copies of it are run beside (see `Bank`). Without a `tuning` the
    noise is learned from the first seconds, which then have to be healthy ones.
    """

    def __init__(self, engine: Engine, model: DiagnosisModel, tuning: Tuning | None = None) -> None:
        self._model = model
        self._engine = engine
        self._every = rows_apart(engine)
        self._nominal = {f: v for f, v in model.faults.items() if v is not None}
        self._sizes = Sizes(engine)
        known = hypotheses(engine, model.faults, model.units, {})
        self._tolerated, spread = tolerated(known, model)
        self._lasting = len(spread)  # those that stay; starts that were estimated stand behind
        self._history = History(spread)
        self._used = np.array([name in model.sees for name in engine.residuals], dtype=bool)
        self._telling = Telling(engine, self._used)
        self._doubt = Doubt(engine, model, walks=tuning is None)
        self._origins = Origins(engine, model.memories, self._every)
        self._past: deque[Row] = deque(maxlen=int(_MEMORY))
        self._learning: Learning | None = None
        if tuning is None:
            self._learning = Learning(engine, known, self._used, model)
            self._limits = self._learning.limits
        else:
            self._limits = np.array(limits(tuning, engine.residuals), dtype=float)
        self._latched: dict[str, Any] | None = None
        self._count = 0  # alarms so far
        self._fired: npt.NDArray[np.bool_] = np.zeros(len(self._used), dtype=bool)
        self._most = np.zeros(len(self._used))
        self._last: list[Batch] = []  # of the last update, with whole thresholds
        self.restart()

    def restart(self) -> None:
        """The residuals begin anew, after a gap; what was said is still said."""
        self._bank = Bank(self._engine.configured(), self._tolerated, self._nominal)
        self._bank.reset()
        self._doubt.reset()
        self._origins.restart(self._past)
        self._past.clear()
        self._calm: deque[Row] = deque()
        self._piece: list[Array] = []
        self._before = self._here()
        self._ends = False  # whether the present samples complete a row
        self._streak = np.zeros(len(self._used), dtype=int)
        self._sums = np.zeros((2, len(self._used)))
        self._telling.restart()
        self._quiet = 0
        self._after = self._told = 0  # rows since the alarm, and until the last update
        self._leads: tuple[str, ...] = ()  # the class that the last judgement found best
        self._wanted: Any = None  # what the last judgement would have said
        if self._learning is not None:
            self._learning.restart()
        self._compared: Comparison | None = None

    def decided(self) -> Batch:
        """See `Decision`."""
        return together(self._last, len(self._used))

    def _here(self) -> Engine:
        """The engine as it is now."""
        copy = self._bank.engine.configured(bounds=False)
        copy.follow(self._bank.engine)
        return copy

    # -------------------------------------------------------------------- samples

    def update(self, time: Array, batch: Batch, samples: Array) -> list[Verdict]:
        """What there is to say after further samples, in order."""
        out: list[Verdict] = []
        self._last = []
        for part in self._parts(time, batch, samples, out):
            if self._learning is not None:
                fresh = self._learning.part(part, healthy=not self._fired.any())
                self._telling.anew(float(part.time[0]), fresh, out)
            line = part.bound + self._limits[:, 2] * self._limits[:, 0]
            line[~np.isfinite(line)] = math.nan
            self._last.append(Batch(part.value, part.valid, line))
            self._alarms(part, line, out)
            row = self._row(part, out)
            if row is not None:
                self._judged(row, out)
        return out

    def look(self, time: Array, batch: Batch, samples: Array) -> None:
        """Samples that were judged before: only what is remembered of them is wanted."""
        for part in self._parts(time, batch, samples, [], again=True):
            row = self._row(part, [])
            if row is not None and self._learning is not None:
                self._learning.row(row, healthy=False)

    def _parts(
        self, time: Array, batch: Batch, samples: Array, out: list[Verdict], again: bool = False
    ) -> Iterator[Part]:
        """Up to the end of each row; rows end at the same times whenever one begins to look."""
        start = 0
        while start < len(time):
            number = round(float(time[start]) / self._engine.sample_time)
            stop = min(len(time), start + self._every - number % self._every)
            own = slice(start, stop)
            self._ends = (number + stop - start) % self._every == 0
            self._origins.take(time[own], samples[own], self._past, again)
            slopes = self._bank.run(samples[own])
            given = Batch(batch.value[own], batch.valid[own], batch.bound[own])
            doubt, sound = self._doubt.run(samples[own], given, number, self._limits[:, 0])
            value, valid, bound = self._origins.judged(given, self._bank, slopes)
            valid = valid & sound
            self._telling.warmth(time[own], valid, self._limits[:, 0], self._origins, out)
            bound = np.where(valid, bound + slack(self._tolerated, slopes) + doubt, 0.0)
            yield Part(time[own], samples[own], value, valid, bound, doubt, slopes)
            start = stop

    def _alarms(self, part: Part, line: Array, out: list[Verdict]) -> None:
        """Sample by sample: is a residual above its whole threshold for long enough?"""
        known = part.valid & np.isfinite(line)
        level = np.where(known, np.abs(part.value) / line, 0.0)
        past = self._most if self._fired.any() else 0.0  # before: that of the last samples
        self._most = np.maximum(past, level.max(axis=0))
        over = (level > 1.0) & ~self._fired
        if not over.any():
            self._streak[:] = 0
            return
        wanted = max(3, self._every // 10)
        for k, at in enumerate(part.time.tolist()):
            self._streak = np.where(over[k], self._streak + 1, 0)
            fresh = (self._streak >= wanted) & ~self._fired
            if fresh.any():
                self._fire(at, fresh, [*self._piece, part.samples[: k + 1]], out)

    def _row(self, part: Part, out: list[Verdict]) -> Row | None:
        """Add samples to the row; the row, when it is full."""
        self._piece.append(part.samples.copy())
        if not self._ends:
            return None
        whole = np.concatenate(self._piece)
        self._sizes.add(whole)
        row = Row(float(part.time[-1]), whole, self._before, *[x[-1].copy() for x in part[2:]])
        self._piece, self._before = [], self._here()
        self._past.append(row)
        if self._origins.looking:
            self._settle()
        self._telling.row(row.time, self._limits[:, 0], self._origins, out)
        return self._past[-1]

    def _settle(self) -> None:
        """Go on with starts that nobody knew, once they are known; rows are as with these then."""
        for _ in self._model.memories:
            found = self._origins.settled(
                self._past, self._tolerated, self._nominal, self._history, self._limits
            )
            if found is None:
                break
            self._calm.clear()
            self._bank, self._tolerated, self._history = found.bank, found.tolerated, found.history
            self._past = deque(found.rows, maxlen=self._past.maxlen)
            self._before = self._here()
            self._compared = None
            if self._latched is not None and self._latched["said"] is not None:
                self._latched["said"][2] = 0  # there is more to go by

    def _judged(self, row: Row, out: list[Verdict]) -> None:
        """What a row tells."""
        if self._learning is not None:
            fresh = self._learning.row(row, healthy=not self._fired.any())
            self._telling.learned(row.time, fresh, self._learning.hopeless, out)
            if self._learning.over:
                self._learning = None
        self._sum(row, out)
        if not self._fired.any():
            self._remember(row)
            return
        if self._compared is None and not self._begin_again(row):
            return
        assert self._compared is not None
        if not self._compared.has(row):
            self._compared.step(row, self._weight(row))
        self._after += 1
        self._judge(row, out)
        self._over(row, out)

    def _begin_again(self, row: Row) -> bool:
        """After a restart: compare faults from the onset on, or from where there are residuals."""
        assert self._latched is not None
        since = self._latched["since"]
        anew = row.time <= since  # the clock has begun again
        rows = [r for r in self._past if self._weight(r).any() and (anew or r.time > since)]
        if not rows:
            return False
        first, samples = rows[0], len(rows[0].samples)
        ago = math.ceil((first.time - since) / self._engine.sample_time)
        healthy = 0 if anew or ago >= samples else samples - max(1, ago)
        self._compare(first.engine, first.samples[:healthy], healthy, rows)
        return True

    def _remember(self, row: Row) -> None:
        """Learn from a row once the ones behind it are calm too: before an alarm a fault acts.

        While noise is being learned nobody knows how much a row is worth: it waits.
        """
        half = 0.5 * self._limits[:, 2] * self._limits[:, 0]
        if (self._streak > 0).any() or (np.abs(row.value) - row.bound > half).any():
            self._calm.clear()
            return
        self._calm.append(row)
        wait = _CALM if self._learning is None else int(_MEMORY)
        while len(self._calm) > wait:
            old = self._calm.popleft()
            self._history.add(old.value, self._weight(old), old.slopes, 1.0 - 1.0 / _FORGET)
            self._origins.learn(self._tolerated, self._history)

    def _weight(self, row: Row) -> Array:
        return weight(row, self._limits[:, 0])

    # --------------------------------------------------------------------- alarms

    def _sum(self, row: Row, out: list[Verdict]) -> None:
        """Row by row: the sum of what is too much, to either side (Page, 1954)."""
        sigma, top = self._limits[:, 0], self._limits[:, 3]
        after = np.minimum(grown(self._sums, row.value, row.bound, sigma), 2.0 * top)
        self._sums = np.where(row.valid, after, 0.0)
        fresh = (self._sums.max(axis=0) > top) & ~self._fired
        if fresh.any():
            self._fire(row.time, fresh, [], out)

    def _fire(
        self, time: float, fresh: npt.NDArray[np.bool_], piece: list[Array], out: list[Verdict]
    ) -> None:
        """Latch an alarm; `piece` are the samples since the last row."""
        first = not self._fired.any()
        self._fired |= fresh
        self._calm.clear()
        self._quiet = 0
        if first:
            since = self._onset(time, piece)
            self._latched = {"since": since, "said": None}
            self._count += 1
            message = f"{self._telling.names(fresh)} above what a healthy machine does since"
            message += f" {since:.3f} s; looking for the fault"
            out.append(Verdict("fault", time, since, self._levels(), message=message))

    def _levels(self) -> dict[str, float]:
        found = zip(self._engine.residuals, self._most, self._fired, strict=True)
        return {name: round(float(most), 3) for name, most, fired in found if fired}

    def _onset(self, time: float, piece: list[Array]) -> float:
        """Begin to compare faults at the last sample that was as it had been before."""
        past = usual(self._past)
        start = len(past) - 1
        while start > 0 and self._odd(past[start]).any():
            start -= 1
        begin = max(0, start)  # its samples are still healthy ones, the fault begins behind them
        chosen = past[begin + 1 :]
        self._wanted = None
        if not past:
            self._compare(self._before, np.empty((0, len(self._engine.signals))), 0, [])
            return time
        engine, piece = (chosen[0].engine, [chosen[0].samples]) if chosen else (self._before, piece)
        last = past[begin]
        noise = inverse(self._weight(last))
        samples = np.concatenate([last.samples[:0], *piece])
        count = calm(engine, samples, self._history, last.slopes, noise, self._fired)
        self._compare(last.engine, np.concatenate([last.samples, samples[:count]]), count, chosen)
        return last.time + count * self._engine.sample_time

    def _compare(self, engine: Engine, healthy: Array, own: int, rows: Sequence[Row]) -> None:
        """Begin to compare faults behind the `healthy` samples, `own` of these of the first row."""
        model = self._model
        self._after = self._told = 0
        found = hypotheses(self._engine, model.faults, model.units, self._sizes.found())
        samples = np.concatenate([healthy, *[row.samples for row in rows]])
        found = sized(engine, found, model.deliveries, self._nominal, samples)
        self._compared = Comparison(engine, healthy, own, found, self._nominal)
        for row in rows:
            self._compared.step(row, self._weight(row))

    def _odd(self, row: Row) -> npt.NDArray[np.bool_]:
        """Which fired residuals are not what the history lets expect."""
        off = odd(self._history, row.value, row.slopes, inverse(self._weight(row)))
        return off & (self._fired if self._fired.any() else True)

    # ------------------------------------------------------------------ judgement

    def _judge(self, row: Row, out: list[Verdict]) -> None:
        """Name the fault when there is enough to go by, and again when that changes."""
        due = self._after >= _JUDGE and (self._after < 10 or self._after % _AGAIN == 0)
        if not due or self._latched is None or not self._compared:
            return
        try:
            found = self._compared.explained(self._history)
        except np.linalg.LinAlgError:
            return
        found = candidates(found, self._model.faults, self._model.sees, self._levels())
        sigma = np.where(self._origins.waiting, math.inf, self._limits[:, 0]).tolist()
        noise = dict(zip(self._engine.residuals, sigma, strict=True))
        groups = classes(self._model.groups, self._model.sees, noise)
        group, leads = named(found, groups)
        sure, self._leads = group if leads == self._leads else (), leads
        if group and not sure and self._latched["said"] is None and self._after == _JUDGE:
            return  # the next row may confirm it
        verdict = update(row.time, self._latched["since"], self._levels(), sure, found)
        wanted = [list(sure), verdict.candidates[0].fault if verdict.candidates else None]
        again, self._wanted = self._wanted == wanted, wanted
        if news(self._latched["said"], wanted, again, self._after - self._told):
            times = 1 if self._latched["said"] is None else self._latched["said"][2] + 1
            self._latched["said"] = [*wanted, times]
            self._told = self._after
            out.append(verdict)

    def _over(self, row: Row, out: list[Verdict]) -> None:
        """A fault is over when its residuals have been quiet for long enough."""
        excess = np.abs(row.value) - row.bound
        loud = row.valid & (excess > 0.5 * self._limits[:, 2] * self._limits[:, 0])
        quiet = self._quiet + bool(row.valid[self._fired].all())  # who cannot be seen is not quiet
        self._quiet = 0 if (loud & self._fired).any() else quiet
        if self._quiet < min(_BACK * 2 ** min(self._count - 1, 9), LONGEST):
            return
        assert self._latched is not None
        what = "back to what a healthy machine does; what was said stays said"
        message = f"{self._telling.names(self._fired)} {what}"
        out.append(Verdict("cleared", row.time, self._latched["since"], message=message))
        self._fired[:] = False
        self._most[:] = 0.0
        self._sums[:] = 0.0
        self._compared, self._latched = None, None

    # ---------------------------------------------------------------- persistence

    def state(self) -> dict[str, Any]:
        """All that `resume` needs, as plain JSON."""
        return {
            "limits": numbers(self._limits),
            "history": self._history.root.tolist(),
            "fired": self._fired.tolist(),
            "most": numbers(self._most),
            "sums": numbers(self._sums),
            "alarms": self._count,
            "latched": self._latched,
            "prior": numbers(self._history.prior),
            "origins": self._origins.state(self._tolerated[self._lasting :]),
        }

    def resume(self, state: dict[str, Any]) -> None:
        """Go on from a state: limits that were learned, what is known of parameters and faults."""
        levels = array(state["limits"], self._limits.shape)
        known = (*self._tolerated[: self._lasting], *starts_in(state["origins"]))
        history = History(array(state["prior"], (len(known),)))
        history.root = array(state["history"], history.root.shape)
        fired = array(state["fired"], self._fired.shape) != 0.0
        most = array(state["most"], self._most.shape)
        sums = array(state["sums"], self._sums.shape)
        count, latched = int(state["alarms"]), state["latched"]
        if latched is not None:
            latched = {"since": float(latched["since"]), "said": latched["said"]}
        if fired.any() != (latched is not None):
            raise ValueError("residuals have fired and nothing is latched, or the other way round")
        self._tolerated, self._history = known, history
        self.restart()
        self._origins.resume(state["origins"])
        if self._learning is not None:
            self._learning.known(levels)
            self._limits = levels
        self._fired, self._most, self._sums = fired, most, sums
        self._count, self._latched = count, latched
