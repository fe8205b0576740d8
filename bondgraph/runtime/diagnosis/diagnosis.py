"""From residuals to verdicts: when something is wrong, since when, and what it can be."""

from __future__ import annotations

import itertools
import math
from collections import deque
from collections.abc import Iterator
from functools import partial
from typing import Any

import numpy as np

from bondgraph.runtime.diagnosis.checkpoints import Checkpoint, Checkpoints
from bondgraph.runtime.diagnosis.detection import Detection
from bondgraph.runtime.diagnosis.doubt import Doubt
from bondgraph.runtime.diagnosis.healthy import (
    DiagnosisModel,
    directions,
    drifting,
    slack,
    tolerated,
)
from bondgraph.runtime.diagnosis.history import HEALTHY, History
from bondgraph.runtime.diagnosis.hypotheses import Bank, hypotheses, rows_apart
from bondgraph.runtime.diagnosis.input_moves import passed_on
from bondgraph.runtime.diagnosis.isolation import Explained
from bondgraph.runtime.diagnosis.judge import Judge
from bondgraph.runtime.diagnosis.learning import Learning
from bondgraph.runtime.diagnosis.naming import Latched
from bondgraph.runtime.diagnosis.noise import COVERED
from bondgraph.runtime.diagnosis.onset import onset
from bondgraph.runtime.diagnosis.origins import Origins, starts_in
from bondgraph.runtime.diagnosis.possible import loud
from bondgraph.runtime.diagnosis.rows import (
    Average,
    Part,
    Row,
    all_of,
    averaged,
    beside,
    pause,
    steady,
    to_row_ends,
    together,
    usual,
    weight,
)
from bondgraph.runtime.diagnosis.score_sums import ScoreSums
from bondgraph.runtime.diagnosis.sensor_offsets import SensorOffsets, sensor_offsets
from bondgraph.runtime.diagnosis.shared_noise import SharedNoise
from bondgraph.runtime.diagnosis.signal_checks import SignalChecks, Unusual
from bondgraph.runtime.diagnosis.standing import Levels
from bondgraph.runtime.diagnosis.status import WatchStatus
from bondgraph.runtime.diagnosis.tuning import Tuning, limits
from bondgraph.runtime.log import Array, Mask
from bondgraph.runtime.monitoring.engine import Batch, Engine, copied
from bondgraph.runtime.monitoring.plain import array, numbers
from bondgraph.runtime.monitoring.verdict import Candidate, Verdict
from bondgraph.text.moment import moment
from bondgraph.text.numerals import listed

_MEMORY = 60.0  # rows of the past that are kept, to go back to the onset


class Diagnosis:
    """A `Decision`: thresholds and CUSUM say that something is wrong, evidence says what.

    The engine is the model's own; copies of it are run beside (see `Bank`). Without a `tuning` the
    noise is learned from the first seconds, which then have to be healthy ones.
    """

    def __init__(
        self, engine: Engine, model: DiagnosisModel, tuning: Tuning | None = None
    ) -> None:
        self._model = model
        self._engine = engine
        self._every = rows_apart(engine)
        known = hypotheses(engine, model.faults, model.units, {}, zeros=model.signs)
        own, spread = tolerated(known, model)
        offsets = sensor_offsets(known, model)
        self._tolerated = (*own, *offsets)
        place = {k.path: at for at, k in enumerate(engine.signals)}
        self._offsets = SensorOffsets(offsets, len(own), place)
        spread = np.append(spread, np.zeros(len(offsets)))
        self._lasting = len(spread)  # those that stay; starts that were estimated stand behind
        used = np.array([name in model.sees for name in engine.residuals], dtype=bool)
        self._shared = SharedNoise(len(used), self._every * engine.sample_time)
        self._history = History(spread, self._shared)
        self._status = WatchStatus(engine, used)
        self._doubt = Doubt(engine, model)
        self._origins = Origins(engine, model.memories, self._every)
        self._past: deque[Row] = deque(maxlen=int(_MEMORY))
        self._learning: Learning | None = None
        if tuning is None:
            self._learning = Learning(engine, known, used, model)
            self._levels = self._learning.levels
            self._limits = self._learning.limits
        else:
            self._limits = np.array(limits(tuning.limits, engine.residuals), dtype=float)
            self._levels = Levels.tuned(self._limits)
        learns = tuning is None
        most = pause(self._every * engine.sample_time)
        self._directions, sizes = directions(known, model)
        given = [h in own for h in self._directions]
        scores = ScoreSums(sizes, len(engine.residuals), learns, tolerated=given)
        least = max(3, self._every // 10)
        self._detection = Detection(engine.residuals, least, learns, most, scores)
        model.doubles()  # found now: an alarm cannot wait for it
        self._judge = Judge(engine, model)
        checked = [(k.path, at) for at, k in enumerate(engine.signals)
                   if k.path in model.faults and k.kind != "mode" and k.counts is None]  # fmt: skip
        names, at = zip(*checked, strict=True) if checked else ((), ())
        inputs = {k.path for k in engine.signals if k.kind == "input"}
        encoders = {k.path: at for at, k in enumerate(engine.signals)
                    if k.path in model.faults and k.counts is not None}  # fmt: skip
        modes = [at for at, k in enumerate(engine.signals) if k.kind == "mode"]
        self._checks = SignalChecks(names, at, engine.sample_time, inputs, encoders, modes, most,
                                    partial(passed_on, engine, names))  # fmt: skip
        self._checkpoints, self._rows = Checkpoints(), 0
        self._last: list[Batch] = []  # of the last update, with whole thresholds
        self.restart()

    def restart(self) -> None:
        """The residuals begin anew, after a gap; what was said is still said."""
        self._bank = Bank(self._engine.configured(), self._tolerated, self._model.nominal)
        self._bank.reset()
        bare = self._engine.configured(bounds=False)
        self._moves = Bank(bare, self._directions, self._model.nominal)
        self._moves.reset()
        self._doubt.reset()
        self._origins.restart(self._past)
        self._past.clear()
        self._calm: deque[Row] = deque()
        self._piece: list[Array] = []
        self._averages: list[tuple[int, Average]] = []
        self._before = copied(self._bank.engine)
        self._ends = False  # whether the present samples complete a row
        self._spikes: list[tuple[float, Mask]] = []  # until when residuals show one that was told
        self._outlasted = False  # whether residuals are back, and a signal is still unusual
        self._status.restart()
        self._detection.restart()
        self._judge.restart()
        self._checks.restart()
        self._shared.restart()
        if self._learning is not None:
            self._learning.restart()

    def decided(self) -> Batch:
        """See `Decision`."""
        return together(self._last, len(self._engine.residuals))

    def waits(self) -> dict[str, str]:
        """See `Decision`."""
        return self._status.waits(self._origins)

    # -------------------------------------------------------------------- samples

    def update(self, time: Array, batch: Batch, samples: Array) -> list[Verdict]:
        """What there is to say after further samples, in order."""
        out: list[Verdict] = []
        self._last = []
        for part in self._parts(time, batch, samples, out):
            if self._learning is not None:
                anew = self._learning.part(part, self._healthy, self._doubt.acted)
                self._status.relearning(float(part.time[0]), *anew, out)
                if self._learning.anew:
                    self._checkpoints.clear()
            line = part.bound + self._levels.beyond(self._limits)
            line += self._offsets.room(part, line, self._history)
            if self._learning is not None:
                line[:, self._learning.settling] = math.nan
            line[~np.isfinite(line)] = math.nan
            self._last.append(Batch(part.value, part.valid, line))
            told = part._replace(valid=part.valid & ~self._passing(float(part.time[0])))
            for k, fresh in self._detection.samples(told, line):
                self._fire(float(part.time[k]), fresh, [*self._piece, part.samples[: k + 1]], out)
            row = self._row(part, out)
            if row is not None:
                self._judged(row, out)
        return out

    @property
    def _healthy(self) -> bool:
        """Whether nothing is wrong, as far as is told."""
        return not (self._detection.alarmed or self._checks.active)

    def look(self, time: Array, batch: Batch, samples: Array) -> None:
        """Samples that were judged before: only what is remembered of them is wanted."""
        for part in self._parts(time, batch, samples, [], again=True):
            row = self._row(part, [])
            if row is not None and self._learning is not None:
                self._learn(row, healthy=False)

    def _parts(
        self, time: Array, batch: Batch, samples: Array, out: list[Verdict], again: bool = False
    ) -> Iterator[Part]:
        """Up to the end of each row."""
        for own in to_row_ends(time, self._engine.sample_time, self._every):
            number = round(float(time[own.start]) / self._engine.sample_time)
            self._ends = (number + own.stop - own.start) % self._every == 0
            self._origins.take(time[own], samples[own], self._past, again)
            slopes = self._bank.run(samples[own])
            given = Batch(batch.value[own], batch.valid[own], batch.bound[own])
            walk, held = self._limits[:, 12], self._limits[:, 13]
            doubt, sound = self._doubt.run(samples[own], given, number, walk, held)
            value, valid, bound = self._origins.judged(given, self._bank, slopes)
            valid = valid & sound
            value = np.where(valid, value - self._limits[:, 4], 0.0)
            self._status.warm_up(time[own], valid, self._limits[:, 0], self._origins, out)
            doubt = doubt + self._levels.unsure
            if self._learning is not None:
                doubt = doubt + self._learning.room(samples[own])
            bound = np.where(valid, bound + slack(self._tolerated, slopes) + doubt, 0.0)
            yield Part(time[own], samples[own], value, valid, bound, doubt, slopes)

    def _row(self, part: Part, out: list[Verdict]) -> Row | None:
        """Add samples to the row; the row, when it is full."""
        self._piece.append(part.samples.copy())
        self._averages.append((len(part.time), averaged(*part[2:])))
        if not self._ends:
            return None
        whole = np.concatenate(self._piece)
        self._judge.learn(whole)
        row = Row(float(part.time[-1]), whole, self._before, *[x[-1].copy() for x in part[2:]])
        row = row._replace(
            mean=self._limits[:, 4].copy(),
            average=all_of(self._averages),
            directions=self._moves.rows(whole, [len(whole) - 1], [len(whole)])[1][0].copy(),
        )
        self._piece, self._averages, self._before = [], [], copied(self._bank.engine)
        self._past.append(row)
        if self._origins.looking:
            self._settle()
        self._status.row(row.time, self._limits[:, 0], self._origins, out)
        return self._past[-1]

    def _settle(self) -> None:
        """Go on with starts that nobody knew, once they are known; rows are as with these then."""
        for _ in self._model.memories:
            found = self._origins.settled(
                self._past, self._tolerated, self._model.nominal, self._history, self._limits
            )
            if found is None:
                break
            self._calm.clear()
            self._checkpoints.clear()
            self._bank, self._tolerated, self._history = found.bank, found.tolerated, found.history
            mean = self._limits[:, 4].copy()
            rows = [r._replace(value=np.where(r.valid, r.value - mean, 0.0), mean=mean.copy())
                    for r in found.rows]  # fmt: skip
            self._past = deque(rows, maxlen=self._past.maxlen)
            self._before = copied(self._bank.engine)
            self._judge.renew()

    def _checked(self, row: Row, out: list[Verdict]) -> None:
        """What signals show by themselves in a row, told as a fault of theirs.

        Where others show something too, it may come from one of these: a controller acts on what
        it reads, and so a noisy sensor moves others. What is named already stays named beside what
        does not last, or does not move all that has fired.
        """
        before, healthy = set(self._checks.active), self._healthy
        suspects = self._seen_by_all() if self._detection.alarmed else []
        for one in self._checks.row(row.time, row.samples, healthy, suspects):
            first = not self._detection.alarmed and not before
            since = one.since if first or self._judge.latched is None else self._judge.latched.since
            others = sorted(before & set(self._checks.active))
            which = tuple(Candidate(s, None, "", 1.0 / (1 + len(others)))
                          for s in (*others, one.signal))  # fmt: skip
            message = f"{one.text}, since {moment(one.since)}"
            message += f", beside {listed(others, 'and')}" if others else ""
            group = () if others else (one.signal,)
            event, levels = "fault" if first else "update", self._detection.levels()
            told = Verdict(event, row.time, since, levels, group, which, message=message)
            if self._judge.said and one.kind == "spike":
                self._pass_over(one)
            if self._judge.said and (one.kind == "spike" or one.signal not in suspects):
                told = self._judge.beside(told)
            out.append(told)
            self._judge.by_itself()
            before.add(one.signal)
        if before and not self._checks.active and not self._detection.alarmed:
            message = f"{listed(sorted(before), 'and')} as while the machine was well"
            out.append(Verdict("cleared", row.time, message=message))

    def _pass_over(self, spike: Unusual) -> None:
        """What residuals show of a spike beside a fault that is named tells nothing of that."""
        sees = np.array([spike.signal in self._model.sees.get(name, ())
                         for name in self._engine.residuals])  # fmt: skip
        until = spike.since + self._engine.warm_up + self._engine.lags[-1]
        self._spikes.append((until, sees))
        late = [row for row in self._past if row.time >= spike.since]
        for row in late:
            row.leave_out(sees)
        self._judge.leave_out(spike.since, sees)
        self._detection.withdraw(sees, len(late))

    def _passing(self, time: float) -> Mask:
        """The residuals that show a spike still that was told."""
        self._spikes = [one for one in self._spikes if one[0] > time]
        found: Mask = np.zeros(len(self._engine.residuals), dtype=np.bool_)
        for _, sees in self._spikes:
            found |= sees
        return found

    def _judged(self, row: Row, out: list[Verdict]) -> None:
        """What a row tells."""
        self._rows += 1
        self._checked(row, out)
        row.leave_out(self._passing(row.time))
        if self._learning is not None:
            settling = self._learning.settling
            fresh = self._learn(row, self._healthy)
            self._status.learned(row.time, fresh, self._learning, out)
            if self._learning.over:
                self._learning = None
            row = row._replace(valid=row.valid & ~settling)
        unsure = False if self._learning is None else self._learning.unsure
        self._levels.ahead(self._detection.alarmed)
        own = self._innovation(row, unsure)
        fresh = self._detection.row(own, self._limits, self._history)
        if fresh.any():
            self._fire(row.time, fresh, [], out)
        if not self._detection.alarmed:
            self._remember(row)
        elif self._judge.step(
            row, self._past, self._limits, self._tolerated, self._history
        ):
            known = self._judge.best
            ending = self._judge.said and self._detection.ending(own, self._limits)
            if not (self._unusual() or ending or self._outlasted):
                self._explain(row, out)
            if known is None and self._judge.best is not None:
                self._detection.reconsider()
            self._over(row, own, out)

    def _innovation(self, row: Row, unsure: Mask | bool) -> Row:
        """A row less what is expected, with room for what offsets of sensors may drift by."""
        steep = self._offsets.steep(row, self._history)
        own = self._history.innovation(row, ~(steep | unsure))
        share = np.where(steep, 1.0, COVERED)
        return own._replace(bound=own.bound + share * self._offsets.most(row, self._history))

    def _learn(self, row: Row, healthy: bool) -> Mask:
        """Which residuals are known with this row; where they stand holds for rows before too."""
        assert self._learning is not None
        before = self._limits[:, 4].copy()
        fresh = self._learning.row(row, healthy, self._detection.held)
        self._stood(self._limits[:, 4] - before)
        return fresh

    def _stands(self, row: Row, first: bool = False) -> Row:
        """Where this machine stands while all is well, with a healthy row more; what is new in it.
        """
        sound = ~self._offsets.steep(row, self._history)
        new = self._history.innovation(row, sound)
        value, bound, valid = beside(new, self._limits)
        moved = self._levels.learn(row.time, value, bound, valid & sound, first)
        self._limits[:, 4] += moved
        self._stood(moved)
        return new

    def _stood(self, moved: Array) -> None:
        """So it did in the rows before."""
        if moved.any():
            longer = itertools.islice(self._calm, max(0, len(self._calm) - len(self._past)))
            for one in (*longer, *self._past):
                one.lower(moved)

    def _remember(self, row: Row) -> None:
        """Learn from a row once the ones behind it are as usual too: before an alarm a fault acts.

        While noise is being learned nobody knows how much a row is worth: it waits.
        """
        if self._checks.active or self._detection.suspects(row, self._limits):
            self._calm.clear()
            return
        self._calm.append(row)
        self._stands(row, first=True)
        self._offsets.row(row, self._history)
        waits = not self._offsets.known or (self._learning is not None and self._learning.first)
        wait = int(_MEMORY) if waits else max(HEALTHY, int(self._detection.held.max(initial=0)))
        while len(self._calm) > wait:
            old = self._calm.popleft()
            self._shared.add(self._stands(old), self._limits)
            sound = ~self._offsets.steep(old, self._history)
            self._history = self._history.drifted(drifting(self._tolerated), rows=1)
            self._history.add(*steady(old, self._weight(old) * sound))
            self._offsets.learned(old, self._history)
            self._origins.learn(self._tolerated, self._history)
        self._checkpoints.add(self._checkpoint())
        far = self._levels.far(self._limits)
        if far.any():
            self._drifted(far)
            self._calm.clear()
            moved = self._levels.drifted(self._limits)
            self._limits[:, 4] += moved
            self._stood(moved)

    def _checkpoint(self) -> Checkpoint:
        """What is known now."""
        levels, limits = self._levels.copy(), self._limits.copy()
        return Checkpoint(self._rows, self._past[-1].time, self._history, limits, levels)

    def _drifted(self, out: Mask) -> None:
        """What is `out` may have come on slowly: what was learned since that began is wrong."""
        if self._past:
            drifts = drifting(self._tolerated)
            found = self._checkpoints.alarm(self._checkpoint(), usual(self._past), out, drifts)
            if found is not None:
                self._go_back(found)

    def _go_back(self, known: Checkpoint) -> None:
        """To what was known before a drift."""
        age, own = self._rows - known.row, np.isfinite(known.limits[:, 0])
        self._history = known.history.drifted(drifting(self._tolerated), rows=age)
        self._levels.go_back(known.levels, own)
        before = self._limits[:, 4].copy()
        self._limits[own] = known.limits[own]
        self._stood(self._limits[:, 4] - before)
        if self._learning is not None:
            self._learning.alarm(np.full(len(own), age))

    def _weight(self, row: Row) -> Array:
        return weight(row, self._limits[:, 0])

    # --------------------------------------------------------------------- alarms

    def _fire(
        self, time: float, fresh: Mask, piece: list[Array], out: list[Verdict]
    ) -> None:
        """Latch an alarm; `piece` are the samples since the last row."""
        self._calm.clear()
        if self._detection.latch(fresh):
            if self._learning is not None:
                self._learning.alarm(self._detection.held)
            self._drifted(self._detection.fired)
            since = self._begin(time, piece)
            self._judge.latch(since)
            message = f"{self._status.names(fresh)} above what a healthy machine does since"
            message += f" {moment(since)}"
            levels = self._detection.levels()
            told = self._unusual()
            if told:
                which = tuple(Candidate(s, None, "", 1.0 / len(told)) for s in told)
                message += f", by {listed(told, 'or')}"
                self._judge.by_itself()
                event = "update" if self._checks.active else "fault"
                group = tuple(told) if len(told) == 1 else ()
                out.append(Verdict(event, time, since, levels, group, which, message=message))
                return
            message += "; looking for the fault"
            out.append(Verdict("fault", time, since, levels, message=message))

    def _begin(self, time: float, piece: list[Array]) -> float:
        """Begin to compare faults behind the onset, the time of which is returned."""
        began = onset(time, self._before, piece, usual(self._past), self._detection, self._limits,
                      self._history)  # fmt: skip
        self._judge.compare(began, self._limits, self._tolerated, self._history)
        return began.time

    # ------------------------------------------------------------------ judgement

    def _unusual(self) -> list[str]:
        """Signals that are unusual by themselves, or were so a few rows ago.

        Those that all residuals see which have fired: they may be what is wrong.
        """
        return [s for s in self._seen_by_all() if self._checks.lately(s)]

    def _seen_by_all(self) -> list[str]:
        """The faults that all residuals see which have fired by more than loud noise does."""
        sees = [self._model.sees.get(r, ()) for r in loud(self._detection.levels())]
        return [f for f in self._model.faults if all(f in own for own in sees)]

    def _explain(self, row: Row, out: list[Verdict]) -> None:
        """What there is to say of the fault, if that is news."""
        sigma = np.where(self._origins.waiting, math.inf, self._limits[:, 0]).tolist()
        noise = dict(zip(self._engine.residuals, sigma, strict=True))
        verdict = self._judge.verdict(row.time, self._detection.levels(), noise, self._history)
        if verdict is not None:
            out.append(verdict)

    def _over(self, row: Row, own: Row, out: list[Verdict]) -> None:
        """A fault is over when its residuals have been quiet for long enough, and its signal."""
        over = self._detection.over(own, self._limits, self._judge.moves)
        self._outlasted = over and bool(self._checks.active)
        known = self._checkpoints.returned(row, self._checkpoint)
        what = "back to what a healthy machine does; what was "
        what += "wrong is not known" if self._judge.silent else "said stays said"
        if known is not None:
            self._go_back(known)
            what = f"as they were at {moment(known.time)}, before a drift that was followed"
            what += " as healthy; what was said is how that ended"
        elif not over or self._judge.waits or self._checks.active:
            return
        assert self._judge.latched is not None
        message = f"{self._status.names(self._detection.fired)} {what}"
        out.append(Verdict("cleared", row.time, self._judge.latched.since, message=message))
        self._detection.clear()
        self._judge.clear()

    # ----------------------------------------------------------------- acceptance

    @property
    def unusual(self) -> frozenset[str]:
        """The signals that are unusual by themselves now."""
        return frozenset(self._checks.active)

    def wrong(self) -> Explained | None:
        """The fault that explains all, as it is known by now; None while there is none."""
        return self._judge.wrong(self._history)

    def succeed(self, other: Diagnosis) -> None:
        """Take over all that another watch knows of a machine that has an accepted fault less.

        Its alarm is over. What was accepted since is known as it is accepted.
        """
        mine, its = self._model.accepted, other._model.accepted
        anew = {key for key, deviation in mine.items() if its.get(key) != deviation}
        before = {(h.fault, h.kind): k for k, h in enumerate(other._tolerated)}
        known = (*self._tolerated, *other._tolerated[other._lasting :])
        keys = [(h.fault, h.kind) for h in known]
        keep = [k for k in keys if k in before and k not in anew]
        more = [k for k in keys if k not in keep]
        priors = [float(self._history.prior[keys.index(k)]) for k in more]
        gone = [before[k] for k in more if k in before]
        history = other._history.anew(gone, [before[k] for k in keep], priors)
        self._history = history.ordered([[*keep, *more].index(k) for k in keys])
        self._shared = other._shared
        self._tolerated = known
        self.restart()
        scores, self._detection = self._detection.scores, other._detection
        self._detection.scores = scores  # what is no longer zero has a direction now
        self._detection.clear()
        self._judge.succeed(other._judge)
        self._origins.resume(other._origins.state(known[self._lasting :]))
        self._checks.resume({**other._checks.state(), "active": []})
        self._levels.resume(other._levels.state())
        if self._learning is not None and other._learning is not None:
            self._learning.resume(other._limits, other._learning.state())
        elif other._learning is None:
            self._learning = None
        self._limits = other._limits
        self._offsets.resume(self._history)

    # ---------------------------------------------------------------- persistence

    def state(self) -> dict[str, Any]:
        """All that `resume` needs, as plain JSON."""
        latched = self._judge.latched
        return {
            "limits": numbers(self._limits),
            "history": self._history.root.tolist(),
            **self._detection.state(),
            "latched": latched and latched.state(),
            "prior": numbers(self._history.prior),
            "origins": self._origins.state(self._tolerated[self._lasting :]),
            "unusual": self._checks.state(),
            "driving": self._learning and self._learning.state(),
            "levels": self._levels.state(),
            "shared": self._shared.state(),
        }

    def resume(self, state: dict[str, Any]) -> None:
        """Go on from a state: limits that were learned, what is known of parameters and faults."""
        given, columns = state["limits"], self._limits.shape[1]
        given = [[*row, *[0.0] * (columns - len(row))] for row in given]  # fewer before 2026-11-30
        levels = array(given, self._limits.shape)
        known = (*self._tolerated[: self._lasting], *starts_in(state["origins"]))
        history = History(array(state["prior"], (len(known),)), self._shared)
        history.root = array(state["history"], history.root.shape)
        detection = self._detection.resumed(state)
        latched = None if state["latched"] is None else Latched.resumed(state["latched"])
        if detection.alarmed != (latched is not None):
            raise ValueError("residuals have fired and nothing is latched, or the other way round")
        self._tolerated, self._history = known, history
        self._checkpoints.clear()
        self._offsets.resume(history)
        self.restart()
        self._detection, self._judge.latched = detection, latched
        self._origins.resume(state["origins"])
        self._checks.resume(state["unusual"])
        self._levels.resume(state["levels"])
        if state.get("shared"):  # none before 2026-11-29
            self._shared.resume(state["shared"])
        if self._learning is not None:
            self._learning.resume(levels, state["driving"])
            self._limits = levels
        else:
            self._limits[:, 4] = levels[:, 4]
