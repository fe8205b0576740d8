"""The way of a sample: source, columns, clock, engine, decision, journal, and those who listen."""

from __future__ import annotations

import time as clocks
from collections import deque
from collections.abc import Callable, Iterable, Sequence
from contextlib import closing
from threading import Event
from typing import TYPE_CHECKING, Any, Protocol

from bondgraph.runtime.log import TIME, TIME_UNIT, Array, Log, LogError
from bondgraph.runtime.monitoring.clock import Clock, Piece
from bondgraph.runtime.monitoring.engine import Batch, Engine
from bondgraph.runtime.monitoring.journal import Journal, JournalError, Past
from bondgraph.runtime.monitoring.mqtt_client import Publisher
from bondgraph.runtime.monitoring.sources.sample_source import Chunk, Source
from bondgraph.runtime.monitoring.verdict import Verdict, described, to_json
from bondgraph.runtime.time_column import Pace
from bondgraph.text.numerals import listed
from bondgraph.text.tuples import NamedTuple

if TYPE_CHECKING:
    from bondgraph.runtime.monitoring.operating import Operating

_EVERY = 1.0  # s between two positions in the journal
_DIGITS = 9  # of a time in s
_BACK = 3.0  # warm-ups to go back: what the filters began with is forgotten to 12 digits then


class Stop(Event):
    """A wish to stop, with what wished so."""

    reason = ""

    def ask(self, reason: str) -> None:
        """Wish so."""
        self.reason = reason
        self.set()


class Decision(Protocol):
    """What says verdicts; a monitor owns one."""

    def update(self, time: Array, batch: Batch, samples: Array) -> list[Verdict]:
        """What there is to say after further samples, in order. Times in s."""

    def look(self, time: Array, batch: Batch, samples: Array) -> None:
        """Samples that were decided on before a restart, to warm up by."""

    def decided(self) -> Batch:
        """By what the samples of the last `update` were decided on.

        Values may be others than those that came in, where it knows better, and so may be which of
        them are valid. The bound is the whole threshold: adaptive, for what nobody knows of the
        machine, and for noise; NaN while that is learned. Further out for long enough is an alarm.
        """

    def restart(self) -> None:
        """The residuals begin anew, after a gap; what was said is still said."""

    def state(self) -> dict[str, Any]:
        """All that `resume` needs, as plain JSON."""

    def resume(self, state: dict[str, Any]) -> None:
        """Go on from a state; raises KeyError, TypeError or ValueError for one of another kind."""


class Listener(Protocol):
    """What gets every sample with what it was decided on."""

    def add(self, time: Array, decided: Batch, verdicts: Iterable[Verdict]) -> None:
        """Further samples, see `Decision.decided`, and what was said of them, in order."""


class Parts(NamedTuple):
    """What a monitor is made of.

    `columns` picks the signals of the engine out of a log, (n, signals); raises LogError where
    some are missing. `sinks` hear every verdict with its number, `states` gets every sample with
    what it was decided on. Only while the machine is `operating` its samples count. `note` is told
    which column was taken for the time. The rate may be one that was `asked` for.
    """

    source: Source
    columns: Callable[[Log], Array]
    clock: Clock
    engine: Engine
    decision: Decision
    sinks: Sequence[Callable[[int, Verdict], None]] = ()
    publisher: Publisher | None = None
    journal: Journal | None = None
    operating: Operating | None = None
    note: Callable[[str], None] = lambda text: None
    asked: bool = False
    states: Listener | None = None


class Monitor:
    """Watches one machine from its first sample, or from where a journal ends, to the last.

    `gaps` counts how often the filters began anew, `left_out` the samples that did not have the
    columns that are needed.
    """

    def __init__(self, parts: Parts, what: str) -> None:
        self._parts = parts
        self._what = what  # for the first verdict
        self._time = 0.0  # s, of the newest sample that was decided on
        self._newest = 0.0  # s, of the newest one that was computed
        self._samples = 0
        self._number = 0
        self._pending: list[tuple[int, Verdict]] = []
        self._latched: Verdict | None = None
        self._places: deque[tuple[float, dict[str, Any] | None]] = deque([(float("-inf"), None)])
        self._place: dict[str, Any] | None = None
        self._past: Past | None = None  # until it is told what was missed since
        self._garbage = 0
        self.gaps = self.left_out = 0
        self._left_told = 0
        self._gaps = 0  # one after the other, without residuals between them
        self._anew = float("-inf")  # s, when the filters began
        self._matched = False
        self._pace = Pace(parts.engine.sample_time, parts.source.name, parts.asked)
        self._written = clocks.monotonic()  # when the position was put down
        self._put_down = 0  # samples until then

    def run(self, stop: Stop) -> int:
        """Watch until the source ends or `stop` is set; how many verdicts the broker has not taken.

        Raises LogError where no sample can be used.
        """
        try:
            self._begin()
            for chunk in self._parts.source.chunks(stop):
                self._take(chunk)
            self._end(stop)
        finally:
            untaken = self._close()
        if not self._samples and not stop.is_set():
            if self._parts.source.decoder is not None:
                self._parts.source.decoder.check()
            raise LogError(self._parts.source.name, None, "no samples came")
        return untaken

    # ---------------------------------------------------------------- beginning and end

    def _begin(self) -> None:
        journal, source = self._parts.journal, self._parts.source
        past = journal.past if journal is not None else None
        if past is None:
            time = source.time()
            what = f"{self._what}, from {source.name}" + (f"; time is {time}" if time else "")
            self._say(Verdict("start", 0.0, message=what))
        else:
            self._resume(past)
        self._commit()

    def _resume(self, past: Past) -> None:
        """Take up what a journal knows."""
        publisher, source = self._parts.publisher, self._parts.source
        for number, verdict in past.verdicts:
            self._number = max(self._number, number)
            self._keep(verdict)
            if publisher is not None and number > past.sent:
                publisher.publish(number, to_json(verdict, number))
        self._time = float(past.position.get("time", 0.0))
        self._samples = int(past.position.get("samples", 0))
        self._number = max(self._number, past.number)
        if past.damage:
            self._parts.note(past.damage)
        same = past.source == source.name
        try:
            if past.state is not None:
                self._parts.decision.resume(past.state)
            why = source.go(past.position) if same else f"the source was {past.source}"
        except (AttributeError, LookupError, OverflowError, TypeError, ValueError) as error:
            message = "the journal is of another version of bondgraph; move it away to begin anew"
            raise JournalError(message) from error
        if why:
            self._parts.decision.restart()
        if same and not source.replays:
            self._past = past  # what was missed is known with the first sample
            return
        if why:
            self._resumed(past, f"from the start of {source.name}: {why}")
            self._samples = 0
        else:
            back = past.position.get("back")
            self._places = deque([(float("-inf"), back)])
            self._place = past.position.get("place")
            self._resumed(past, f"{source.name} goes on where the watch ended: nothing is missed")

    def _resumed(self, past: Past, message: str) -> None:
        away = max(0.0, clocks.time() - past.at)
        message = f"after {away:.0f} s away, {message}" + (past.damage and f"; {past.damage}")
        known = self._latched
        if known is None:
            self._say(Verdict("resumed", self._time, message=f"{message}; no fault is known"))
            return
        told = described(known._replace(residuals={}))
        self._say(known._replace(event="resumed", time=self._time,
                                 message=f"{message}; still latched: {told}"))  # fmt: skip

    def _missed(self, first: float) -> None:
        """Say what a source that cannot go back has lost while nobody watched."""
        past, self._past = self._past, None
        if past is None:
            return
        lost = first - self._time
        if lost > 0.0:
            count = max(0, round(lost / self._parts.engine.sample_time) - 1)
            what = f"at most {lost:.3f} s of the stream are missed ({count} samples)"
        else:
            what = (
                f"the time of the stream begins anew at {first:.3f} s, what was missed is unknown"
            )
        self._resumed(past, what)

    def _end(self, stop: Stop) -> None:
        if self._past is not None:
            past, self._past = self._past, None
            self._resumed(past, "no sample came")
        if not stop.is_set():
            for piece in self._parts.clock.finish():
                # A file that is read again has told its end.
                first = 0 if piece.anew else int((piece.time <= self._time).sum())
                if first < len(piece.time):
                    rest = piece._replace(time=piece.time[first:], samples=piece.samples[first:])
                    self._step(rest, False)
        why = f"stopped by {stop.reason}" if stop.is_set() else "the samples end"
        message = f"{why}, after {self._samples} samples"
        if self._parts.clock.dropped:
            message += f", {self._parts.clock.dropped} of them too late, twice or empty"
        if self._parts.clock.left_out:
            message += f", {self._parts.clock.left_out} of them while the machine was off"
        lines = self._parts.decision.decided().bound[-1:]
        blind = [
            n for k, n in enumerate(self._parts.engine.residuals) if (lines != lines)[:, k].any()
        ]
        if blind:
            verb = "is" if len(blind) == 1 else "are"
            message += f"; {listed(blind, 'and')} {verb} not watched: the noise is not known"
        self._say(Verdict("stop", self._time, message=message))
        self._commit()

    def _close(self) -> int:
        parts = self._parts
        parts.source.close()
        untaken = 0 if parts.publisher is None else parts.publisher.close()
        if parts.journal is not None:
            with closing(parts.journal):
                if parts.publisher is not None:
                    parts.journal.sent(parts.publisher.taken)
        return untaken

    # -------------------------------------------------------------------------- samples

    def _take(self, chunk: Chunk) -> None:
        for news in chunk.news:
            self._say(Verdict(news.event, self._time, message=news.message))
        if chunk.log is not None and chunk.log.rows:
            if not chunk.again:
                self._missed(float(chunk.log.time[0]))
            self._compute(chunk.log, chunk.again)
        if chunk.place is not None:
            self._remember(chunk.place, chunk.again)
        if not chunk.again:
            self._noise()
            self._news()
            self._commit()
        if chunk.done is not None:
            chunk.done()

    def _compute(self, log: Log, again: bool) -> None:
        """The residuals of some samples, and what follows; nothing of those computed `again`."""
        parts = self._parts
        try:
            samples = parts.columns(log)
        except LogError as error:
            if not self._matched:
                raise
            self.left_out += log.rows
            if self.left_out >= 2 * self._left_told:
                self._left_told = self.left_out
                message = f"{self.left_out} samples are left out: {error}"
                self._say(Verdict("invalid", self._time, message=message))
            return
        self._pace.look(log)
        on = None if parts.operating is None else parts.operating(log)
        if not self._matched:
            self._matched = True
            parts.clock.wraps = _wraps(log)
            if TIME in log.meta and (parts.journal is None or parts.journal.past is None):
                parts.note(f"{parts.source.name}: time is {log.meta[TIME]}")
        if not again:
            self._samples += log.rows
        for piece in parts.clock.feed(log.time, samples, on):
            self._step(piece, again)

    def _step(self, piece: Piece, again: bool) -> None:
        """Compute samples on the grid."""
        parts = self._parts
        if piece.anew:
            parts.engine.reset()
        batch = parts.engine.run(piece.samples)
        self._newest = float(piece.time[-1])
        if again:
            if piece.anew:
                parts.decision.restart()
            parts.decision.look(piece.time, batch, piece.samples)
            return
        if piece.anew:
            parts.decision.restart()
            self._gap(piece)
        said = parts.decision.update(piece.time, batch, piece.samples)
        for verdict in said:
            self._say(verdict)
        if parts.states is not None:
            parts.states.add(piece.time, parts.decision.decided(), said)
        self._time = self._newest

    def _gap(self, piece: Piece) -> None:
        """Tell why the filters start anew; of many gaps in a row the first, second, fourth ..."""
        self.gaps += 1
        start = float(piece.time[0])
        near = 0.0 <= self._time - self._anew < self._parts.engine.warm_up
        self._gaps = self._gaps + 1 if near else 1
        self._anew = start
        if self._gaps & (self._gaps - 1):
            return
        message = f"{piece.anew}; the residuals warm up"
        if self._gaps > 2:
            message += f" ({self._gaps} gaps in a row: tell the rate of the samples by --rate)"
        self._say(Verdict("gap", start, message=message))

    def _remember(self, place: dict[str, Any], again: bool) -> None:
        """Places of the source, back to one from which the filters are warm by now."""
        self._places.append((self._newest, place))
        warm = self._newest - _BACK * self._parts.engine.warm_up - self._parts.clock.most
        while len(self._places) > 1 and self._places[1][0] <= warm:
            self._places.popleft()
        if not again:
            self._place = place

    def _noise(self) -> None:
        """Tell of lines that are no samples: the first, and whenever they have doubled."""
        decoder = self._parts.source.decoder
        if decoder is None or decoder.garbage < max(1, 2 * self._garbage):
            return
        self._garbage = decoder.garbage
        lines = (
            "1 line is no sample" if self._garbage == 1 else f"{self._garbage} lines are no samples"
        )
        self._say(
            Verdict(
                "invalid",
                self._time,
                message=f"{lines}, the last is `{decoder.example}` ({decoder.why})",
            )
        )

    def _news(self) -> None:
        """Tell what the publisher has to tell, and put down what it has published."""
        publisher, journal = self._parts.publisher, self._parts.journal
        if publisher is None:
            return
        for text in publisher.news():
            self._say(Verdict("gap", self._time, message=f"verdicts: {text}"))
        if journal is not None:
            journal.sent(publisher.taken)

    # ------------------------------------------------------------------------- verdicts

    def _say(self, verdict: Verdict) -> None:
        since = None if verdict.since is None else round(verdict.since, _DIGITS)
        verdict = verdict._replace(time=round(verdict.time, _DIGITS), since=since)
        self._number += 1
        self._keep(verdict)
        self._pending.append((self._number, verdict))

    def _keep(self, verdict: Verdict) -> None:
        if verdict.event in ("fault", "update"):
            self._latched = verdict
        elif verdict.event == "cleared":
            self._latched = None

    def _commit(self) -> None:
        """Put down what is to be said, then say it; and how far the watch is, each second."""
        journal = self._parts.journal
        now = clocks.monotonic()
        due = self._samples != self._put_down and now - self._written >= _EVERY
        if journal is not None and (self._pending or due):
            position = {
                "time": self._time,
                "samples": self._samples,
                "place": self._place,
                "back": self._places[0][1],
            }
            journal.write(position, self._parts.decision.state(), self._pending)
            self._written, self._put_down = now, self._samples
        said, self._pending = self._pending, []
        for number, verdict in said:
            for sink in self._parts.sinks:
                sink(number, verdict)
            if self._parts.publisher is not None:
                self._parts.publisher.publish(number, to_json(verdict, number))


def _wraps(log: Log) -> float | None:
    """The period of the clock of a device that counts in 32 bits, in s; harmless for others."""
    return {"us": 2.0**32 / 1e6, "ms": 2.0**32 / 1e3}.get(log.meta.get(TIME_UNIT, ""))
