"""Where positions are counted from: what a break makes unknown, and who waits until it is known."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from bondgraph.runtime.diagnosis.healthy import slack
from bondgraph.runtime.diagnosis.history import History
from bondgraph.runtime.diagnosis.hypotheses import COUNT, Bank, Hypothesis
from bondgraph.runtime.diagnosis.origin_fit import Case, Fit, fitted, replayed
from bondgraph.runtime.diagnosis.remembered import Memory
from bondgraph.runtime.diagnosis.rows import Row, weight
from bondgraph.runtime.log import Array, Mask
from bondgraph.runtime.monitoring.engine import Batch, Engine
from bondgraph.runtime.monitoring.plain import array, numbers
from bondgraph.text.numerals import listed
from bondgraph.text.tuples import NamedTuple

_HOLD = 3  # warm-ups that a start is told before the first sample: encoders may jump far
_FEW = 3  # rows beyond the warm-up before a start is looked for
_MANY = 20  # such rows that are looked at; with so many something has to explain them
_HOPELESS = 3.0  # times its threshold a residual is, whatever the start
_LOST = 12  # such rows that are enough then
_SELDOM = 20  # rows between two looks, at most
_KNOWN = 0.5  # of the threshold: what an unknown start may do to a residual that is watched
_NARROW = 10.0  # deviations of a start, within which it stays when all else has been forgotten
_SLACK = 3.0  # standard deviations of a start that a threshold leaves room for
_LATEST = 10  # rows in which slopes before a break are taken
_ROOM = 1e-9  # s that times may be off by
_FASTER = 1.5  # times as fast as ever before a machine may have moved in a gap
_TURN = 2.0**32  # counts after which a counter runs over


class Settled(NamedTuple):
    """What changes for a diagnosis once a start is known."""

    bank: Bank
    rows: list[Row]
    tolerated: tuple[Hypothesis, ...]
    history: History


def starts_in(state: dict[str, Any]) -> tuple[Hypothesis, ...]:
    """The starts that were estimated, in the order in which a diagnosis had them."""
    return tuple(
        Hypothesis(str(fault), "start", str(unit), float(usual), False)
        for fault, unit, usual in state["starts"]
    )


class _Group:
    """Residuals that remember the same starts, and what is known of these."""

    def __init__(self, engine: Engine, memory: Memory, parameters: Sequence[str]) -> None:
        place = {k.path: at for at, k in enumerate(engine.signals)}
        number = {name: at for at, name in enumerate(engine.residuals)}
        self.memory = memory
        self.residuals = [number[name] for name in memory.residuals]
        self.signals = [place[path] for path in memory.signals]
        self.reads = [place[path] for path in memory.reads]
        #: Of what is added up the parameters of its start, else it begins with a pulse in a signal.
        own = memory.begins if memory.integral else ()
        self.pulse = memory.integral and not own
        self.places = [len(place) + parameters.index(name) for name in own] or self.signals
        self.names = {*memory.signals, *own}
        self.counters = [at for at in self.signals if engine.signals[at].counts is not None]
        self.starts: tuple[Hypothesis, ...] = ()  # that were estimated, and their covariance
        self.spread: Array = np.zeros((0, 0))
        self.fresh = not memory.unknown  # no sample yet: the model says where it begins
        self.restart(waiting=not self.fresh)

    def restart(self, waiting: bool = True) -> None:
        """Nothing is known of the samples to come."""
        self.waiting = waiting
        self.ours = False  # whether residuals are computed here: the given ones began elsewhere
        self.begun = False
        self.doubtful = False  # whether it is judged by a start that explains nothing
        self.resumed = False
        self.kept = False  # whether the start is what it was before the break
        self.since = math.inf
        self.seen = math.nan  # s, of the newest row
        self.window = math.nan  # s, of the first sample that the start is that of
        self.count = self.next = 0  # rows so far, and those with which a start is looked for again


class Origins:
    """Watches breaks in the samples, and looks for the starts that they make unknown.

    At the very first sample positions are what the model says, but for those that it does not know.
    After a break, where encoders have gone on, they still count from where they did. Otherwise
    residuals that depend on it wait, until the samples since the break tell what their first one
    should have been, or for so long that some start has to do.
    """

    def __init__(self, engine: Engine, memories: Sequence[Memory], every: int) -> None:
        self._engine, self._every = engine, every
        self._parameters = [name for memory in memories for name in memory.begins]
        self._groups = [_Group(engine, memory, self._parameters) for memory in memories]
        many = len(engine.signals) + len(self._parameters)
        self._told = np.full(many, math.nan)  # the first sample and parameters, where they count
        self._readings = Readings(len(engine.signals), engine.sample_time)
        self._far = np.zeros(many)  # counts from the start
        self._steep = np.zeros((len(engine.residuals), many))
        self._warm = math.ceil(engine.warm_up / engine.sample_time)
        counted = any(group.counters for group in self._groups)
        self._hold = _HOLD * self._warm if counted else 0

    @property
    def waiting(self) -> Mask:
        """The residuals that are not judged."""
        return self._residuals_of([g for g in self._groups if g.waiting])

    @property
    def looking(self) -> bool:
        """Whether a start is looked for."""
        return any(group.waiting or group.doubtful for group in self._groups)

    @property
    def lost(self) -> Mask:
        """Those of them whose start nobody knows."""
        return self._residuals_of([g for g in self._groups if g.waiting and g.begun and not g.kept])

    def _residuals_of(self, groups: Sequence[_Group]) -> Mask:
        found: Mask = np.zeros(len(self._engine.residuals), dtype=np.bool_)
        for group in groups:
            found[group.residuals] = True
        return found

    def unknown(self, of: Mask) -> str:
        """What these residuals wait for, in words: by the parameters of starts, or by signals."""
        own = [g.memory for g in self._groups if of[g.residuals].any()]
        named = list(dict.fromkeys(name for memory in own for name in memory.unknown))
        began = [name for memory in own if not memory.unknown for name in memory.signals]
        verb = "is" if len(named) == 1 else "are"
        said = [f"what {listed(named, 'and')} {verb}"] if named else []
        said += [f"where {listed(began, 'and')} began"] if began else []
        return listed(said, "and")

    # --------------------------------------------------------------------- breaks

    def restart(self, past: Sequence[Row]) -> None:
        """All residuals begin anew."""
        for group in self._groups:
            self._look_back(group, past)
        for group in self._groups:
            if not group.fresh:
                group.restart()

    def _look_back(self, group: _Group, past: Sequence[Row]) -> None:
        """Put down how steep residuals were while the start was known."""
        rows = [row for row in list(past)[-_LATEST:] if row.valid[group.residuals].all()]
        if group.waiting or group.memory.integral or not rows:
            return
        engines = [rows[0].engine.configured(bounds=False) for _ in range(2)]
        samples = np.concatenate([row.samples for row in rows])
        ends = np.cumsum([len(row.samples) for row in rows])
        ends = ends[ends > self._warm] - 1
        for at in group.counters if len(ends) else []:
            value = []
            for engine, step in zip(engines, (1.0, -1.0), strict=True):
                engine.follow(rows[0].engine)
                moved = samples.copy()
                moved[:, at] -= step  # later counts less are a start more
                value.append(engine.run(moved).value[ends][:, group.residuals])
            slopes = (value[0] - value[1]) / 2.0
            most = np.argmax(np.abs(slopes), axis=0)
            self._steep[group.residuals, at] = slopes[most, np.arange(len(most))]

    def take(self, time: Array, samples: Array, past: Sequence[Row], again: bool) -> None:
        """Note samples before they are run; `again`: they are those of before the watch ended."""
        for group in self._groups:
            whole = np.isfinite(samples[:, group.reads]).all(axis=1)
            first = 0
            if not whole.all():
                if group.begun:
                    self._look_back(group, past)
                    group.restart()
                first = int(np.flatnonzero(~whole)[-1]) + 1
            if not group.begun and first < len(samples):
                self._begin(group, time, samples, first, again)
        signals = sorted({at for group in self._groups for at in group.signals})
        self._readings.note(time, samples, signals, self._every // 2)
        for at in signals:
            if math.isfinite(self._told[at]):
                way = abs(self._readings.last(at) - self._told[at])
                self._far[at] = max(self._far[at], way)

    def _begin(self, group: _Group, time: Array, samples: Array, first: int, again: bool) -> None:
        """The first sample of a group after a break."""
        group.begun = True
        group.since = float(time[first])
        now = samples[first]
        if group.fresh:
            group.fresh = False
            if not group.memory.integral:
                self._told[group.signals] = now[group.signals]
            return
        known = bool(np.isfinite(self._told[group.signals]).all()) and not group.memory.integral
        group.kept = known and (
            (again and group.resumed) or self._readings.go_on(time, samples, first, group.counters)
        )
        if not group.kept:
            self._told[group.signals] = self._told[group.places] = math.nan
            self._far[group.signals] = np.maximum(
                self._far[group.signals], np.abs(now[group.signals])
            )

    # --------------------------------------------------------------------- samples

    def judged(self, batch: Batch, bank: Bank, slopes: Array) -> Batch:
        """What may be judged of further samples; `slopes` and own residuals are of the `bank`."""
        own = [g for g in self._groups if g.waiting or g.ours]
        if not own or bank.batch is None:
            return batch
        value, valid, bound = batch.value.copy(), batch.valid.copy(), batch.bound.copy()
        for group in own:
            at = group.residuals
            value[:, at] = bank.batch.value[:, at]
            bound[:, at] = bank.batch.bound[:, at]
            if group.waiting:
                valid[:, at] = False
            else:
                bound[:, at] += self._slack(group, bank.hypotheses, slopes)[:, at]
        value[~valid] = 0.0
        bound[~valid] = 0.0
        return Batch(value, valid, bound)

    def learn(self, known: Sequence[Hypothesis], history: History) -> None:
        """What healthy rows have told of starts since these are used: leave less room for them."""
        starts = [h for h in known if h.kind == "start"]
        if not starts:
            return
        mean, spread = history.last(len(starts))
        for group in self._groups:
            if group.waiting or group.doubtful or not group.starts:
                continue
            own = [starts.index(h) for h in group.starts]
            found = spread[np.ix_(own, own)] + np.outer(mean[own], mean[own]) / _SLACK**2
            if np.trace(found) < np.trace(group.spread):
                group.spread = found

    def _slack(self, group: _Group, known: Sequence[Hypothesis], slopes: Array) -> Array:
        """What a start that is not known exactly may do, beyond what a count more or less does."""
        own = slopes[..., [known.index(h) for h in group.starts], :]
        square = np.einsum("...sr,su,...ur->...r", own, group.spread, own)
        paths = set(group.memory.signals)
        counts = slack(known, slopes * np.array([h.fault in paths for h in known])[:, None])
        return np.asarray(np.maximum(_SLACK * np.sqrt(np.maximum(square, 0.0)) - counts, 0.0))

    # ------------------------------------------------------------------------ starts

    def settled(
        self,
        past: Sequence[Row],
        tolerated: tuple[Hypothesis, ...],
        nominal: Mapping[str, float],
        history: History,
        limits: Array,
    ) -> Settled | None:
        """A group that waits no longer, at the end of a row; None where there is none."""
        for group in self._groups:
            rows = [row for row in past if self._begins(row) >= group.since - _ROOM]
            looks = (group.waiting or group.doubtful) and group.begun
            if not looks or not rows or rows[-1].time == group.seen:
                continue
            group.seen = rows[-1].time
            group.count += 1
            recent, length = rows[-self._behind(group, _MANY) :], len(rows) * self._every
            case = self._case(group, recent, tolerated, nominal, history, limits)
            if group.kept:
                if rows[0].valid.any() and length <= self._warm:
                    continue  # residuals that go on need slopes that have settled
                bank, again = replayed(case, case.start, tolerated)
                return self._accepted(group, Settled(bank, again, tolerated, history))
            few = length < self._warm * self._slow(group) + _FEW * self._every
            if few or group.count < group.next:
                continue
            group.next = group.count + min(max(1, group.count // 4), _SELDOM)
            try:
                with np.errstate(over="ignore", invalid="ignore"):
                    found = fitted(case)
            except np.linalg.LinAlgError:
                continue
            if found is None or not self._good(group, found):
                continue
            group.doubtful = found.level > 1.0
            self._told[group.places] = found.start[group.places]
            group.starts, group.spread = found.starts, found.spread
            self._taught(group, found, case)
            settled = Settled(found.bank, found.rows, found.tolerated, found.history)
            return self._accepted(group, settled)
        return None

    def _behind(self, group: _Group, rows: int) -> int:
        """So many rows and those of the warm-up."""
        return self._warm * self._slow(group) // self._every + rows

    def _slow(self, group: _Group) -> int:
        """Warm-ups until nothing is seen of the start itself, or of a pulse that it is told as."""
        return 2 if group.pulse else 1

    def _begins(self, row: Row) -> float:
        return row.time - (len(row.samples) - 1.5) * self._engine.sample_time

    def _good(self, group: _Group, found: Fit) -> bool:
        """Whether a start may be used: it is known well, or nothing explains what is seen."""
        if found.level > 1.0:
            enough = _LOST if found.level > _HOPELESS else _MANY
            return group.waiting and group.count >= self._behind(group, enough)
        return found.doubt <= _KNOWN

    def _taught(self, group: _Group, found: Fit, case: Case) -> None:
        """A healthy machine has told of its parameters since the break."""
        if found.level > 1.0:
            return
        own = np.zeros(len(self._engine.residuals))
        own[group.residuals] = 1.0
        for row in found.rows:
            found.history.add(row.value, weight(row, case.sigma) * own, row.slopes, 1.0)
        found.history.narrow(_NARROW * np.sqrt(np.diag(found.spread)))

    def _accepted(self, group: _Group, settled: Settled) -> Settled:
        group.waiting, group.ours = False, True
        group.window = self._begins(settled.rows[0])
        for other in self._groups:
            if other.ours and other.memory.integral and other.window != group.window:
                other.waiting, other.next = True, 0  # its start was that of another first sample
                other.seen = math.nan
                self._told[other.places] = math.nan
        for row in settled.rows:
            row.bound[group.residuals] += self._slack(group, settled.tolerated, row.slopes)[
                group.residuals
            ]
            at = self.waiting
            row.value[at], row.bound[at], row.valid[at] = 0.0, 0.0, False
        return settled

    def _case(
        self,
        group: _Group,
        rows: Sequence[Row],
        tolerated: tuple[Hypothesis, ...],
        nominal: Mapping[str, float],
        history: History,
        limits: Array,
    ) -> Case:
        declared = [self._engine.parameters[name] for name in self._parameters]
        start = np.append(rows[0].samples[0], declared)
        known = np.isfinite(self._told)
        start[known] = self._told[known]
        sigma = limits[:, 0].copy()
        with np.errstate(invalid="ignore"):
            limit = limits[:, 2] * sigma
        unknown = ~np.isfinite(limit) | (limit <= 0)
        if unknown.any() and not group.kept:  # until noise has been learned
            rough = self._rough(start, rows)
            sigma[unknown], limit[unknown] = 0.1 * rough[unknown], 0.5 * rough[unknown]
        gone = [k for k, h in enumerate(tolerated)
                if h.fault in group.names and (h.kind == "start" or h.unit == COUNT)]  # fmt: skip
        starts = [k for k in gone if tolerated[k].kind == "start"]
        return Case(
            self._engine, group.residuals, group.places, self._parameters, start, rows, tolerated,
            gone, starts, nominal, history, limit, sigma, self._far, self._steep, _KNOWN,
            self._hold, self._warm * self._slow(group),
        )  # fmt: skip

    def _rough(self, start: Array, rows: Sequence[Row]) -> Array:
        """About what residuals are allowed, where nobody knows their noise."""
        engine = self._engine.configured()
        engine.run(start[None, : len(engine.signals)])
        batch = engine.run(np.concatenate([row.samples for row in rows]))
        bound = np.median(batch.bound[-self._every :], axis=0)
        size = np.sqrt(np.mean(np.square(batch.value[-self._every :]), axis=0))
        return np.asarray(np.where(bound > 0, bound, size) + 1e-300)

    # ---------------------------------------------------------------- persistence

    def state(self, starts: Sequence[Hypothesis]) -> dict[str, Any]:
        """All that `resume` needs, as plain JSON; `starts` in the order of the diagnosis."""
        return {
            "starts": [[h.fault, h.unit, h.usual] for h in starts],
            "told": numbers(self._told),
            "readings": self._readings.state(),
            "far": numbers(self._far),
            "steep": numbers(self._steep),
            "fresh": [group.fresh for group in self._groups],
            "waiting": [group.waiting and not group.kept for group in self._groups],
            "spread": [numbers(group.spread) for group in self._groups],
        }

    def resume(self, state: dict[str, Any]) -> None:
        """Go on from a state."""
        starts = starts_in(state)
        own = [tuple(h for h in starts if h.fault in g.names) for g in self._groups]
        spread = [array(s, (len(h),) * 2) for s, h in zip(state["spread"], own, strict=True)]
        waiting = [bool(w) for w in state["waiting"]]
        fresh = [bool(f) for f in state["fresh"]]
        told, far = array(state["told"], self._told.shape), array(state["far"], self._far.shape)
        steep = array(state["steep"], self._steep.shape)
        self._readings.resume(state["readings"])
        self._told = np.where(np.isfinite(told), told, math.nan)
        self._far, self._steep = far, steep
        for k, group in enumerate(self._groups):
            group.starts, group.spread = own[k], spread[k]
            group.fresh = fresh[k]
            group.restart(waiting=not group.fresh)
            group.resumed = not waiting[k]


class Readings:
    """The newest value of some signals, when it was, and the largest speed, in counts a second."""

    def __init__(self, signals: int, sample_time: float) -> None:
        self._last = np.full(signals, math.nan)
        self._when = np.full(signals, math.nan)
        self._fast = np.zeros(signals)
        self._sample_time = sample_time

    def last(self, at: int) -> float:
        """The newest value of a signal, NaN before the first."""
        return float(self._last[at])

    def note(self, time: Array, samples: Array, signals: Sequence[int], enough: int) -> None:
        """Further samples; a speed is taken over `enough` of them at least."""
        for at in signals:
            there = np.flatnonzero(np.isfinite(samples[:, at]))
            if not len(there):
                continue
            begin, end = there[0], there[-1]
            self._last[at], self._when[at] = samples[end, at], time[end]
            if end - begin >= enough:
                way = abs(float(samples[end, at] - samples[begin, at]))
                self._fast[at] = max(self._fast[at], way / float(time[end] - time[begin]))

    def go_on(self, time: Array, samples: Array, first: int, counters: Sequence[int]) -> bool:
        """Whether all counters stand where they can have come to since, and not only by chance.

        `first` is the first sample after a gap. A counter that has begun anew has not come further
        since than it could either. Signals that are no counters go on anyway.
        """
        sure = not counters
        for at in counters:
            there = np.flatnonzero(np.isfinite(samples[:first, at]))
            last, when = self._last[at], self._when[at]
            if len(there):
                last, when = samples[there[-1], at], time[there[-1]]
            gap = float(time[first] - when)
            room = _FASTER * float(self._fast[at]) * gap + 2.0
            way = (float(samples[first, at] - last) + _TURN / 2) % _TURN - _TURN / 2
            if not (gap > 0.0 and abs(way) <= room):
                return False
            sure |= gap < 1.5 * self._sample_time or bool(abs(samples[first, at]) > room)
        return sure

    def state(self) -> dict[str, Any]:
        """All that `resume` needs, as plain JSON."""
        return {
            "last": numbers(self._last),
            "when": numbers(self._when),
            "fast": numbers(self._fast),
        }

    def resume(self, state: dict[str, Any]) -> None:
        """Go on from a state."""
        last, when, fast = (array(state[k], self._last.shape) for k in ("last", "when", "fast"))
        self._last = np.where(np.isfinite(last), last, math.nan)
        self._when = np.where(np.isfinite(when), when, math.nan)
        self._fast = fast
