"""Goes on with a fault that stays: it is taken for the machine as it is, and the next is told."""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Callable
from typing import Any

import numpy as np

from bondgraph.runtime.diagnosis.diagnosis import Diagnosis
from bondgraph.runtime.diagnosis.healthy import DiagnosisModel
from bondgraph.runtime.diagnosis.hypotheses import rows_apart
from bondgraph.runtime.diagnosis.naming import candidate
from bondgraph.runtime.diagnosis.rows import to_row_ends, together
from bondgraph.runtime.log import Array
from bondgraph.runtime.monitoring.engine import Batch, Engine
from bondgraph.runtime.monitoring.verdict import Candidate, Verdict, from_json, to_json
from bondgraph.text.numerals import listed
from bondgraph.text.tuples import NamedTuple

_BACK = 3.0  # warm-ups to go back: what the filters began with is forgotten to 12 digits then
_KINDS = ("value", "offset", "gain", "stuck", "lost")
_REPAIRED = 3.0  # deviations that a parameter may be off what was declared once it is repaired


class Accepted(NamedTuple):
    """A fault that is taken for the machine as it is; see `Hypothesis` for the kinds.

    A parameter is smaller by the `change` than it was (`value`), or a signal is told as more than
    it is, by the change (`offset`) or by a share of what is told (`gain`), or what acts is the
    change whatever is told (`stuck`), or nothing is known of it any more (`lost`). What was
    estimated has a `deviation`.
    """

    fault: str
    kind: str
    change: float = 0.0
    deviation: float = 0.0

    def told(self, column: Array) -> Array:
        """Samples of the signal as they should have been told.

        >>> Accepted("speed", "gain", 0.2).told(np.array([5.0, 10.0])).tolist()
        [4.0, 8.0]
        """
        if self.kind == "offset":
            return column - self.change
        if self.kind == "gain":
            return column * (1.0 - self.change)
        return np.full_like(column, self.change if self.kind == "stuck" else math.nan)


class AcceptedFaults:
    """A `Decision` that accepts a class of faults once it has been named for `after` seconds.

    From then on the engine has the parameters that the machine has, and samples are corrected
    before anything looks at them: to what is watched the machine is well, and what comes next is
    told as the first fault was. What is known of noise and of the other parameters is kept; of a
    parameter that was accepted is known what its estimate says, with its deviation.

    Not accepted are encoders, sensors whose readings laws use, and two faults at once: they stay in
    alarm, and that is said once, with the reason, when they would have been accepted. The `engine`
    is that of the model as it was declared, whose residuals come in.
    """

    def __init__(
        self,
        engine: Engine,
        model: DiagnosisModel,
        made: Callable[[Engine, DiagnosisModel], Diagnosis],
        after: float = math.inf,
    ) -> None:
        self._declared, self._model, self._made, self._after = engine, model, made, after
        self._every = rows_apart(engine)
        self._place = {k.path: at for at, k in enumerate(engine.signals)}
        self._warm = math.ceil(_BACK * engine.warm_up / engine.sample_time)
        self._recent: deque[tuple[Array, Array]] = deque()  # times and samples as they came in
        self._count = 0  # of these samples
        self._last: list[Batch] = []  # of the last update
        self._named: Verdict | None = None  # the newest verdict of this alarm that names faults
        self._refused = False  # whether a fault of this alarm was not accepted
        self.accepted: tuple[Accepted, ...] = ()
        self._begin(())

    def _begin(self, accepted: tuple[Accepted, ...]) -> None:
        """Watch the machine with these faults; raises ValueError where it cannot have them."""
        values: dict[str, float] = {}
        for one in accepted:
            if one.kind == "value":
                before = values.get(one.fault, self._model.nominal[one.fault])
                values[one.fault] = before - one.change
        engine = self._declared.configured(values)
        known = {(one.fault, one.kind): one.deviation for one in accepted if one.deviation > 0.0}
        model = self._model._replace(faults={**self._model.faults, **values}, accepted=known)
        self._engine, self._watch, self.accepted = engine, self._made(engine, model), accepted

    # -------------------------------------------------------------------- samples

    def update(self, time: Array, batch: Batch, samples: Array) -> list[Verdict]:
        """See `Decision`; row by row, so that faults are accepted at the same times always."""
        out: list[Verdict] = []
        self._last = []
        for own in to_row_ends(time, self._declared.sample_time, self._every):
            told = self._told(samples[own])
            given = Batch(batch.value[own], batch.valid[own], batch.bound[own])
            if self.accepted:
                given = self._engine.run(told)
            said = self._watch.update(time[own], given, told)
            self._last.append(self._watch.decided())
            self._remember(time[own], samples[own])
            for verdict in said:
                if verdict.event in ("fault", "update", "cleared"):
                    self._named = verdict if verdict.group or verdict.pairs else None
                    self._refused &= verdict.event == "update"
            out += said
            now, named = float(time[own][-1]), self._named
            if named is not None and now - max(named.time, named.since or 0.0) >= self._after:
                out += self.accept(now)
        return out

    def look(self, time: Array, batch: Batch, samples: Array) -> None:
        """See `Decision`."""
        told = self._told(samples)
        self._watch.look(time, self._engine.run(told) if self.accepted else batch, told)
        self._remember(time, samples)

    def decided(self) -> Batch:
        """See `Decision`."""
        return together(self._last, len(self._declared.residuals))

    def restart(self) -> None:
        """See `Decision`."""
        self._watch.restart()
        self._engine.reset()
        self._recent.clear()
        self._count = 0

    def waits(self) -> dict[str, str]:
        """See `Decision`."""
        return self._watch.waits()

    def _told(self, samples: Array) -> Array:
        """Samples as the machine that is watched should have told them."""
        signals = [one for one in self.accepted if one.kind != "value"]
        if not signals:
            return samples
        found = samples.copy()
        for one in signals:
            at = self._place[one.fault]
            found[:, at] = one.told(found[:, at])
        return found

    def _remember(self, time: Array, samples: Array) -> None:
        """Samples by which the filters of another engine become warm."""
        self._recent.append((time.copy(), samples.copy()))
        self._count += len(time)
        while self._count - len(self._recent[0][0]) >= self._warm:
            self._count -= len(self._recent.popleft()[0])

    # ----------------------------------------------------------------- acceptance

    def accept(self, now: float) -> list[Verdict]:
        """Take what is named for the machine as it is, at a time in s.

        The verdict says why where that cannot be, the first time in an alarm; else there is none.
        """
        named, self._named = self._named, None
        if named is None:
            return []
        found = self._wrong(named)
        if isinstance(found, str):
            return self._refuse(named, now, found)
        fault, candidate = found
        before = self._watch
        try:
            self._begin((*self.accepted, fault))
        except ValueError:
            return self._refuse(named, now, f"the model cannot have {fault.fault} of such a value")
        self._watch.succeed(before)
        since = -math.inf if named.since is None else named.since
        for time, samples in self._recent:  # filters are to know the machine as it is only
            told = self._told(samples[time > since])
            if len(told):
                self._watch.look(time[time > since], self._engine.run(told), told)
        verdict = named._replace(event="accepted", time=now, candidates=(candidate,), pairs=())
        return [verdict._replace(message=self._said(verdict, fault))]

    def _refuse(self, named: Verdict, now: float, why: str) -> list[Verdict]:
        """Say why what is named stays in alarm, unless that was said of this alarm."""
        again, self._refused = self._refused, True
        if again:
            return []
        what = listed(named.group, "or") or listed(named.pairs[0].faults, "and")
        message = f"{what} cannot be accepted, and stays in alarm: {why}"
        return [named._replace(event="refused", time=now, message=message)]

    def _wrong(self, named: Verdict) -> tuple[Accepted, Candidate] | str:
        """The fault of the class that is most probable, as it is known by now, or why it is none
        that is accepted."""
        if not named.group:
            return "these are two faults at once"
        (signal, *others), found = named.group, self._watch.wrong()
        if signal in self._watch.unusual and not others:
            return Accepted(signal, "lost"), Candidate(signal, None, "", 1.0)
        if found is None or found.fault not in named.group:
            return "something else explains by now what is seen"
        chances = {c.fault: c.probability for c in named.candidates}
        own, told = found.hypothesis, candidate(found, chances.get(found.fault, 1.0))
        if own.held is not None:
            position = found.change if own.held.stays else own.held.position
            return Accepted(own.held.signal, "stuck", position), told
        if own.kind != "value":
            at = self._place[own.fault]
            if self._declared.signals[at].counts is not None:
                return f"{own.fault} is an encoder, whose counts are not corrected"
            if at in self._declared.readings:
                return f"laws of the model use what {own.fault} reads"
            if own.kind not in ("offset", "gain"):
                return f"{own.fault} is wrong by neither an offset nor a gain"
        return Accepted(own.fault, own.kind, found.change, found.deviation), told

    def _said(self, verdict: Verdict, fault: Accepted) -> str:
        """A sentence for people."""
        (told,) = verdict.candidates
        size = "" if told.size is None else f"{told.size:+.3g} {told.unit}".rstrip()
        if fault.kind == "value":
            value, declared = self._engine.parameters[fault.fault], self._model.nominal[fault.fault]
            text = f"{told.fault} is taken for {value:.4g} {told.unit}".rstrip() + f" ({size})"
            before = any(one[:2] == fault[:2] for one in self.accepted[:-1])
            if before and abs(value - declared) <= _REPAIRED * fault.deviation:
                text += ", which is what was declared"
        elif fault.kind == "stuck":
            text = f"{told.fault} is taken so, whatever is told"
        elif fault.kind == "lost":
            text = f"{told.fault} is not listened to any more"
        else:
            text = f"{told.fault} is corrected by what it is wrong by ({size})"
        others = [f for f in verdict.group if f != told.fault]
        if others:
            text += f", though it may be {listed(others, 'or')}"
        return f"{text}; the watch goes on with that"

    # ---------------------------------------------------------------- persistence

    def state(self) -> dict[str, Any]:
        """See `Decision`."""
        return {
            "accepted": [list(one) for one in self.accepted],
            "named": self._named and to_json(self._named, 0),
            "refused": self._refused,
            "watch": self._watch.state(),
        }

    def resume(self, state: dict[str, Any]) -> None:
        """See `Decision`."""
        accepted = tuple(Accepted(str(f), str(k), float(c), float(d))
                         for f, k, c, d in state["accepted"])  # fmt: skip
        for one in accepted:
            places = self._model.nominal if one.kind == "value" else self._place
            if one.kind not in _KINDS or one.fault not in places:
                raise ValueError(f"{one.fault} cannot have been accepted")
            if not math.isfinite(one.change + one.deviation):
                raise ValueError("a size is no number")
        named = None if state["named"] is None else from_json(state["named"])[1]
        self._begin(accepted)
        self._watch.resume(state["watch"])
        self._named, self._refused = named, bool(state["refused"])
