"""What happens to samples on their way, told as it happens and never as a flood.

Lines that are no samples, samples that are thrown away, gaps, signals without a number, a source
that has fallen silent: each has a `Recurrence` or a `Silence` that says when, and words here.
"""

from __future__ import annotations

from collections.abc import Callable, Container, Mapping

from bondgraph.runtime.log import Array, Mask
from bondgraph.runtime.monitoring.account import Account
from bondgraph.runtime.monitoring.clock import THROWN, Clock, Piece
from bondgraph.runtime.monitoring.recurrence import Recurrence
from bondgraph.runtime.monitoring.residual_states import NO_VALUE, Change, ResidualStates
from bondgraph.runtime.monitoring.silence import Silence
from bondgraph.runtime.monitoring.sources.lines import Decoder
from bondgraph.runtime.monitoring.verdict import Verdict
from bondgraph.text.moment import moment
from bondgraph.text.numerals import listed, plural

_CAUSES = {
    "late": "behind a later one",
    "twice": "with the time of the one before",
    "empty": "without any number",
    "untimed": "without a time",
}
_NOTHING: Change = Change(0, 0.0, (), (), False)


class Disturbances:
    """Says verdicts about samples and lines; `say` takes them.

    `progress` is how far the watch is in s, which never goes back: samples that were read, and
    silence. All `time` is of the stream, in s.
    """

    def __init__(
        self,
        account: Account,
        states: ResidualStates,
        warm_up: float,
        say: Callable[[Verdict], None],
    ) -> None:
        self._account, self._states, self._warm_up, self._say = account, states, warm_up, say
        self._lines, self._unmatched = Recurrence(warm_up), Recurrence(warm_up)
        self._overflow, self._thrown = Recurrence(warm_up), Recurrence(warm_up)
        self._gaps, self._values = Recurrence(warm_up), Recurrence(warm_up)
        self._exhausted = Recurrence(warm_up)
        self._why = ""  # samples could not be matched
        self._causes = dict.fromkeys(THROWN, 0)  # of samples that were thrown away, not told yet
        self._now = _NOTHING  # the signals that are missing
        self._since = 0.0  # s, when the first of them began to be
        self._blind = _NOTHING  # as it was told
        self._worn: tuple[str, ...] = ()  # residuals that were told to have no value for long
        self.progress = 0.0

    # -------------------------------------------------------------------- lines and samples

    def unmatched(self, count: int, why: str) -> None:
        """So many samples do not have the columns that are needed."""
        self._why = why
        self._unmatched.add(count, self.progress)

    def garbage(self, count: int) -> None:
        """So many lines more are no samples."""
        self._lines.add(count, self.progress)

    def overflow(self, count: int) -> None:
        """So many lines more were dropped, as nobody read them in time."""
        self._overflow.add(count, self.progress)

    def thrown(self, before: Mapping[str, int], clock: Clock) -> None:
        """The clock has thrown away more samples than it had before."""
        more = {name: clock.thrown[name] - before[name] for name in THROWN}
        if any(more.values()):
            self._causes = {name: self._causes[name] + more[name] for name in THROWN}
            self._thrown.add(sum(more.values()), self.progress)

    def told(self, time: float, decoder: Decoder | None, clock: Clock) -> None:
        """Say what is due."""
        if self._unmatched.due(self.progress):
            count = self._account.samples["unmatched"]
            text = f"{plural(count, 'sample')} cannot be used: {self._why}"
            self._say(Verdict("invalid", time, message=text))
        if decoder is not None and (count := self._lines.due(self.progress)):
            what = "1 line is no sample" if count == 1 else f"{count} lines are no samples"
            text = f"{what}, the last is `{decoder.example}` ({decoder.why})"
            self._say(Verdict("invalid", time, message=text))
        if count := self._overflow.due(self.progress):
            what = "1 line was" if count == 1 else f"{count} lines were"
            text = f"samples come faster than they are computed: {what} dropped"
            self._say(Verdict("late", time, message=text))
        if self._thrown.due(self.progress):
            self._say(Verdict("late", time, message=self._thrown_words(clock, time)))
            self._causes = dict.fromkeys(THROWN, 0)
        self._tell_values(time)

    def _thrown_words(self, clock: Clock, time: float) -> str:
        parts = [f"{n} {_CAUSES[name]}" for name, n in self._causes.items() if n]
        count = sum(self._causes.values())
        verb = "is" if count == 1 else "are"
        since = "" if clock.thrown_since is None else f", from {_moment(clock.thrown_since)} on"
        clock.thrown_since = None
        text = f"{plural(count, 'sample')} {verb} thrown away{since}: {listed(parts, 'and')}"
        return text + (f"; the clock stands still at {_moment(time)}" if clock.stands else "")

    # --------------------------------------------------------------------------------- gaps

    def gap(self, piece: Piece) -> None:
        """Samples are missing before a piece, and the filters start anew."""
        self._gaps.add(1, self.progress)
        count = self._gaps.due(self.progress)
        if not count:
            return
        start = float(piece.time[0])
        begin = start if piece.gap is None else min(start, piece.gap.start)
        message = f"{piece.anew}; the residuals warm up, and what happens from {_moment(begin)} to"
        message += f" about {_moment(start + self._warm_up)} may be missed"
        if count > 2:
            lost = piece.gap is None or (piece.gap.lost and not piece.gap.off)
            rate = ": tell the rate of the samples by --rate" if lost else ""
            message += f" ({count} gaps in a row{rate})"
        self._say(Verdict("gap", start, message=message))

    # --------------------------------------------------------------------- signals and values

    def values(
        self, time: Array, valid: Mask, changes: list[Change], waits: Callable[[], Container[str]]
    ) -> None:
        """Signals began or ceased to be missing in some samples, of which residuals are `valid`.

        Of which residuals the decision has said itself that it `waits` with them.
        """
        ends = [c.at for c in changes] + [len(time)]
        self._returned(time, valid, 0, ends[0])
        for change, end in zip(changes, ends[1:], strict=True):
            self._tell_values(change.time)
            if change.signals and set(change.signals) - set(self._now.signals):
                self._values.add(1, self.progress)
            if not self._now.signals:
                self._since = change.time
            self._now = change
            self._tell_values(change.time)
            self._returned(time, valid, change.at, end)
        worn = self._states.exhausted
        if worn:
            known = waits()
            worn = tuple(name for name in worn if name not in known)
        self._wear(float(time[-1]), worn)

    def _tell_values(self, time: float) -> None:
        """Say which signals are missing, if that is news that is due."""
        now, told = self._now, self._blind
        if not set(now.signals) - set(told.signals):
            return
        if now.first:
            if time - self._since < self._warm_up:
                return  # a slow signal has not come yet
            time = self._since + self._warm_up
        if self._values.due(self.progress):
            verb = "has" if len(now.signals) == 1 else "have"
            text = f"{listed(now.signals, 'and')} {verb} no number (empty, null, NaN, infinite or"
            text += f" absent) since {moment(self._since)}: {_blind(now.residuals)}"
            self._say(Verdict("invalid", time, message=text))
            self._blind = now

    def _returned(self, time: Array, valid: Mask, start: int, end: int) -> None:
        """Say that residuals have a value again, whose signals are there again."""
        told = self._blind
        if not told.signals or self._now.signals:
            return
        of = [self._states.residuals.index(name) for name in told.residuals]
        sound = valid[start:end, of].all(axis=1)
        if not sound.any():
            return
        at = float(time[start + int(sound.argmax())])
        text = f"{listed(told.residuals, 'and')} {'has' if len(of) == 1 else 'have'} a value again:"
        text += f" {listed(told.signals, 'and')} {'is' if len(told.signals) == 1 else 'are'} there;"
        text += f" what happened from {moment(self._since)} to {moment(at)} may have been missed"
        self._say(Verdict("warm-up", at, message=text))
        self._blind = _NOTHING

    def _wear(self, time: float, worn: tuple[str, ...]) -> None:
        """Say which residuals have had no value for long, for no signal's sake."""
        if set(worn) - set(self._worn):
            self._exhausted.add(1, self.progress)
            if not self._exhausted.due(self.progress):
                return
            self._say(Verdict("invalid", time, message=f"{_blind(worn)}: {NO_VALUE}"))
        elif self._worn and not worn:
            verb = "has" if len(self._worn) == 1 else "have"
            text = f"{listed(self._worn, 'and')} {verb} a value again"
            self._say(Verdict("warm-up", time, message=text))
        self._worn = worn


class Hearing:
    """Whether a live source is heard, on the clock of this computer; says so if not.

    A sample counts that the clock of the stream goes on with, or while the machine is off.
    """

    def __init__(self, silence: Silence, clock: Clock, say: Callable[[Verdict], None]) -> None:
        self._silence, self._clock, self._say = silence, clock, say
        self._taken = 0
        self._fresh = False  # whether samples have come that are being computed
        self._seen = (0, 0)  # samples that were thrown away, lines that are none

    def look(self, time: float, garbage: int, now: float) -> None:
        """See whether samples have come until `now`; `garbage` lines were none so far."""
        taken = self._clock.used + self._clock.left_out
        seen = self._clock.dropped, garbage
        if taken != self._taken:
            told, lasted = self._silence.told, self._silence.heard(now)
            self._taken, self._seen, self._fresh = taken, seen, True
            if told:
                text = f"samples come again, after {lasted:.1f} s on the clock of this computer"
                self._say(Verdict("gap", time, message=text))
        elif lasts := self._silence.due(now):
            text = f"no sample for {lasts:.1f} s on the clock of this computer{self._what(seen)};"
            text += " all residuals are blind"
            self._say(Verdict("gap", time, message=text))

    def why(self, garbage: int, now: float) -> str:
        """Why nothing is watched, "" while samples come."""
        lasts = self._silence.lasts(now)
        if lasts <= self._silence.limit:
            return ""
        return f"no sample for {lasts:.1f} s{self._what((self._clock.dropped, garbage))}"

    def awake(self, now: float) -> None:
        """What has come was computed until now; see `Silence.awake`."""
        if self._fresh:
            self._silence.awake(now)
        self._fresh = False

    def _what(self, seen: tuple[int, int]) -> str:
        """What comes instead."""
        thrown, lines = (a - b for a, b in zip(seen, self._seen, strict=True))
        if self._clock.stands:
            return ", but some of the same time: the clock of the device stands still"
        if thrown:
            return ", but some that are late, come twice or are empty"
        return ", but lines that are none" if lines else ""


def _blind(residuals: tuple[str, ...]) -> str:
    return f"{listed(residuals, 'and')} {'is' if len(residuals) == 1 else 'are'} blind"


def _moment(seconds: float) -> str:
    return moment(seconds, ".6g")
