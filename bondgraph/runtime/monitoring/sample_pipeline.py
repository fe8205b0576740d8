"""The way of a sample: source, columns, clock, engine, decision, journal, and those who listen."""

from __future__ import annotations

import time as clocks
from collections import deque
from contextlib import closing
from typing import Any

from bondgraph.runtime.log import TIME, TIME_UNIT, Log, LogError
from bondgraph.runtime.monitoring.account import Account, numbers
from bondgraph.runtime.monitoring.clock import Piece
from bondgraph.runtime.monitoring.disturbances import Disturbances, Hearing
from bondgraph.runtime.monitoring.journal import JournalError, Past
from bondgraph.runtime.monitoring.residual_states import ALARM, BLIND, ResidualStates
from bondgraph.runtime.monitoring.silence import Silence
from bondgraph.runtime.monitoring.snapshot import Snapshot, presence
from bondgraph.runtime.monitoring.sources.sample_source import Chunk
from bondgraph.runtime.monitoring.verdict import Verdict, described, to_json
from bondgraph.runtime.monitoring.watch_parts import Parts, Stop
from bondgraph.runtime.time_column import Pace
from bondgraph.text.moment import moment
from bondgraph.text.numerals import listed

_EVERY = 1.0  # s between two positions in the journal
_DIGITS = 9  # of a time in s
_BACK = 3.0  # warm-ups to go back: what the filters began with is forgotten to 12 digits then


class Monitor:
    """Watches one machine from its first sample, or from where a journal ends, to the last.

    `account` counts what became of all samples, `states` has those of the residuals.
    """

    def __init__(self, parts: Parts, what: str) -> None:
        self._parts = parts
        self._what = what  # for the first verdict
        self._time = 0.0  # s, of the newest sample that was decided on
        self._newest = 0.0  # s, of the newest one that was computed
        self._number = 0
        self._pending: list[tuple[int, Verdict]] = []
        self.states = ResidualStates(parts.engine)
        signals = [k.path for k in parts.engine.signals]
        self.account = Account(self.states, parts.engine.sample_time, signals)
        self._disturbances = Disturbances(
            self.account, self.states, parts.engine.warm_up, self._say
        )
        self._hearing: Hearing | None = None
        self._heard: float | None = None  # on the monotonic clock, when samples came
        self._turn = self._beat = clocks.monotonic()
        self._idle = 0.0  # s without samples
        self._overflow = 0  # lines that were dropped until now
        self._ending = ""  # how the watch ended
        self._latched: Verdict | None = None
        self._places: deque[tuple[float, dict[str, Any] | None]] = deque([(float("-inf"), None)])
        self._place: dict[str, Any] | None = None
        self._past: Past | None = None  # until it is told what was missed since
        self._garbage = 0  # lines that are no samples until now
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
        except BaseException as error:
            self._ending = str(error) or type(error).__name__
            raise
        finally:
            untaken = self._close()
        if self._parts.publisher is not None:
            self._parts.publisher.check()
        if not self._samples and not stop.is_set():
            if self._parts.source.decoder is not None:
                self._parts.source.decoder.check()
            raise LogError(self._parts.source.name, None, "no samples came")
        return untaken

    @property
    def _samples(self) -> int:
        """Samples that could be looked at."""
        return self.account.samples["read"] - self.account.samples["unmatched"]

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
        if source.live:
            now = clocks.monotonic()
            silence = Silence(self._parts.silence, self._parts.engine.sample_time, now)
            self._hearing = Hearing(silence, self._parts.clock, self._say)
        self._commit()
        self._tell(True)

    def _resume(self, past: Past) -> None:
        """Take up what a journal knows."""
        publisher, source = self._parts.publisher, self._parts.source
        for number, verdict in past.verdicts:
            self._number = max(self._number, number)
            self.account.verdicts[verdict.event] += 1
            self._keep(verdict)
            if publisher is not None and number > past.sent:
                publisher.publish(number, to_json(verdict, number))
        self._time = float(past.position.get("time", 0.0))
        self._number = max(self._number, past.number)
        if past.damage:
            self._parts.note(past.damage)
        same = past.source == source.name
        try:
            if past.state is not None:
                self._parts.decision.resume(past.state)
                self.account.resume(past.position["account"])
            self.states.resume(self._latched)
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
                f"the time of the stream begins anew at {moment(first)}, what was missed is unknown"
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
        if self.account.thrown:
            message += f", {self.account.thrown} of them too late, twice, empty or without a column"
        if self.account.samples["off"]:
            message += f", {self.account.samples['off']} of them while the machine was off"
        if words := self.account.words():
            message += f"; {words}"
        waits = self._parts.decision.waits()
        lines = self._parts.decision.decided().bound[-1:]
        unknown = zip(self._parts.engine.residuals, (lines != lines).any(axis=0), strict=True)
        blind = [name for name, own in unknown if own and name not in waits]
        if blind:
            verb = "is" if len(blind) == 1 else "are"
            message += f"; {listed(blind, 'and')} {verb} not watched: the noise is not known"
        message += "".join(f"; {name} is not watched: {why}" for name, why in waits.items())
        self._ending = message
        self.account.verdicts["stop"] += 1  # it is in its own account
        snapshot = self.snapshot(clocks.monotonic()).to_record()
        self.account.verdicts["stop"] -= 1
        self._say(Verdict("stop", self._time, message=message, account=snapshot))
        self._commit()

    def _close(self) -> int:
        parts = self._parts
        parts.source.close()
        if parts.publisher is not None:
            parts.publisher.present(presence("ended", self._ending))
        untaken = 0 if parts.publisher is None else parts.publisher.close()
        if parts.journal is not None:
            with closing(parts.journal):
                if parts.publisher is not None:
                    parts.journal.sent(parts.publisher.taken)
        return untaken

    # -------------------------------------------------------------------------- samples

    def _take(self, chunk: Chunk) -> None:
        now = clocks.monotonic()
        for news in chunk.news:
            self._say(Verdict(news.event, self._time, message=news.message))
        if chunk.log is not None and chunk.log.rows:
            if not chunk.again:
                self._missed(float(chunk.log.time[0]))
            self._compute(chunk.log, chunk.again, now)
        else:
            self._idle += now - self._turn
            self._listen(now)
        if chunk.place is not None:
            self._remember(chunk.place, chunk.again)
        self._noise(chunk.again)
        if not chunk.again:
            self._news()
            self._disturbances.told(self._time, self._parts.source.decoder, self._parts.clock)
            # Of a source that can go back, samples without a place are computed again.
            if chunk.log is None or chunk.place is not None or not self._parts.source.replays:
                self._commit()
        if chunk.done is not None:
            chunk.done()
        self._turn = clocks.monotonic()
        if chunk.log is not None and self._hearing is not None:
            self._hearing.awake(self._turn)
        self._tell(False)

    def _compute(self, log: Log, again: bool, now: float) -> None:
        """The residuals of some samples, and what follows; nothing of those computed `again`."""
        parts = self._parts
        if not again:
            self.account.samples["read"] += log.rows
            self._disturbances.progress = (
                self.account.samples["read"] * parts.engine.sample_time + self._idle
            )
        try:
            samples = parts.columns(log)
        except LogError as error:
            if not self._matched:
                raise
            if not again:
                self.account.samples["unmatched"] += log.rows
                self._disturbances.unmatched(log.rows, str(error))
            self._listen(now)
            return
        self._pace.look(log)
        on = None if parts.operating is None else parts.operating(log)
        if not self._matched:
            self._matched = True
            parts.clock.wraps = _wraps(log)
            if TIME in log.meta and (parts.journal is None or parts.journal.past is None):
                parts.note(f"{parts.source.name}: time is {log.meta[TIME]}")
        before, missing = numbers(parts.clock), parts.clock.missing.copy()
        pieces = parts.clock.feed(log.time, samples, on)
        if not again:
            self.account.take(parts.clock, before, missing)
            self._disturbances.thrown(before, parts.clock)
            after = numbers(parts.clock)
            if any(after[n] != before[n] for n in ("used", "off")):
                self._heard = now
            self._listen(now)
        for piece in pieces:
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
            self.states.restart()
            self.account.gap(piece)
            self._disturbances.gap(piece)
        said = parts.decision.update(piece.time, batch, piece.samples)
        decided = parts.decision.decided()
        told, changes = self.states.add(piece.time, piece.samples, decided, said)
        for verdict in said:
            self._say(verdict)
        self._disturbances.values(piece.time, decided.valid, changes, parts.decision.waits)
        for listener in parts.listeners:
            listener.add(piece.time, decided, told)
        self._time = self._newest

    @property
    def _lines(self) -> int:
        """Lines that are no samples."""
        decoder = self._parts.source.decoder
        return 0 if decoder is None else decoder.garbage

    def _listen(self, now: float) -> None:
        """See whether a live source is heard."""
        if self._hearing is not None:
            self._hearing.look(self._time, self._lines, now)

    def _remember(self, place: dict[str, Any], again: bool) -> None:
        """Places of the source, back to one from which the filters are warm by now."""
        self._places.append((self._newest, place))
        warm = self._newest - _BACK * self._parts.engine.warm_up - self._parts.clock.most
        while len(self._places) > 1 and self._places[1][0] <= warm:
            self._places.popleft()
        if not again:
            self._place = place

    def _noise(self, again: bool) -> None:
        """Count lines that are no samples, and those that were dropped."""
        source, garbage = self._parts.source, self._lines
        more, dropped = garbage - self._garbage, source.dropped - self._overflow
        self._garbage, self._overflow = garbage, source.dropped
        if again:
            return
        self.account.lines["garbage"] += more
        self.account.lines["overflow"] += dropped
        if more > 0:
            self._disturbances.garbage(more)
        if dropped:
            self._disturbances.overflow(dropped)

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
        self.account.verdicts[verdict.event] += 1
        self._keep(verdict)
        self._pending.append((self._number, verdict))

    def _keep(self, verdict: Verdict) -> None:
        if verdict.event in ("fault", "update"):
            self._latched = verdict
        elif verdict.event in ("cleared", "accepted"):
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
                "account": self.account.to_record(),
            }
            journal.write(position, self._parts.decision.state(), self._pending)
            self._written, self._put_down = now, self._samples
        said, self._pending = self._pending, []
        for number, verdict in said:
            for sink in self._parts.sinks:
                sink(number, verdict)
            if self._parts.publisher is not None:
                self._parts.publisher.publish(number, to_json(verdict, number))

    # --------------------------------------------------------------------------- how it stands

    def snapshot(self, now: float) -> Snapshot:
        """How the watch stands at a moment of the monotonic clock, in s."""
        parts = self._parts
        found = self.states.now(parts.decision.waits())
        blind = "" if self._hearing is None else self._hearing.why(self._lines, now)
        if not blind and parts.clock.off:
            blind = "the machine is off"
        if not blind and parts.clock.stands:
            blind = "the clock of the samples stands still"
        if blind:
            found = {n: (s if s == ALARM else BLIND, blind) for n, (s, _) in found.items()}
        return Snapshot(
            self._what, parts.source.name, self._time, self._heard, found, self.states.latched,
            self.account.to_record(),
        )  # fmt: skip

    def _tell(self, first: bool) -> None:
        """Let those know how the watch stands who want to: observers, and each heartbeat."""
        parts, now = self._parts, self._turn
        beat = parts.heartbeat is not None and now - self._beat >= parts.heartbeat
        if parts.observe is None and not beat and not (first and parts.publisher):
            return
        snapshot = self.snapshot(now)
        if parts.observe is not None:
            parts.observe(snapshot)
        if not beat and not first:
            return
        age = snapshot.age(now)
        record = snapshot.to_record() | {"age": None if age is None else round(age, 3)}
        if parts.publisher is not None:
            parts.publisher.present(presence("watching", snapshot.words(now), record))
        if beat and parts.heartbeat is not None:
            self._beat = max(self._beat + parts.heartbeat, now - parts.heartbeat)
            message = snapshot.words(now)
            verdict = Verdict("heartbeat", self._time, message=message, account=record)
            for sink in parts.sinks:
                sink(self._number, verdict)


def _wraps(log: Log) -> float | None:
    """The period of the clock of a device that counts in 32 bits, in s; harmless for others."""
    return {"us": 2.0**32 / 1e6, "ms": 2.0**32 / 1e3}.get(log.meta.get(TIME_UNIT, ""))
