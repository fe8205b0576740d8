"""What each residual is at each sample: healthy, in alarm, warming up or blind, and why.

All that tells of states takes them from here: the table of `--states`, what is said when one
changes, the account at the end, heartbeats and metrics.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence

import numpy as np
import numpy.typing as npt

from bondgraph.runtime.log import Array, Mask
from bondgraph.runtime.monitoring.engine import Batch, Engine
from bondgraph.runtime.monitoring.verdict import Verdict
from bondgraph.text.numerals import listed
from bondgraph.text.tuples import NamedTuple

ALARM, HEALTHY, BLIND, WARMING = "alarm", "healthy", "blind", "warming up"

#: All that a residual can be.
STATES = (HEALTHY, ALARM, WARMING, BLIND)
_HEALTHY, _ALARM, _WARMING, _BLIND = range(4)
_CODES = np.arange(len(STATES), dtype=np.int8)
_TOLD = ("fault", "update", "cleared", "accepted")  # what changes what is latched

_SIGNAL = ""  # an alarm of no residual: a signal is unusual by itself
_PATIENCE = 5.0  # warm-ups after which a residual without a value is not warming up any more


class Told(NamedTuple):
    """What some samples were: `codes` into `STATES`, (n, residuals), and for the whole machine.

    `fired` is true while a fault is latched or a signal is unusual, (n,); `named` has the faults
    of the class that is named then.
    """

    codes: npt.NDArray[np.int8]
    whole: npt.NDArray[np.int8]
    fired: Mask
    named: npt.NDArray[np.object_]


class Change(NamedTuple):
    """From a sample on these `signals` have no number, and so these `residuals` no value.

    Both are empty where all is there again. `at` is the number of the sample among those that were
    added, `time` its time in s. `first`: none of the residuals has had a value until then.
    """

    at: int
    time: float
    signals: tuple[str, ...]
    residuals: tuple[str, ...]
    first: bool


class ResidualStates:
    """Follows the states of the residuals of an engine from sample to sample.

    A residual is in `alarm` from when it has fired until that is cleared or accepted, and where it
    is above its threshold meanwhile; else `healthy` while it has a value and a threshold; `blind`
    while nobody knows its noise, while a signal that it reads has no number, and where it had no
    value for five warm-ups for another reason; else `warming up`. `samples` counts them,
    (residuals, states).
    """

    def __init__(self, engine: Engine) -> None:
        self.residuals = tuple(engine.residuals)
        self._signals = [k.path for k in engine.signals]
        self._reads: Mask = np.asarray(engine.reads, dtype=np.bool_)
        self._patience = round(_PATIENCE * engine.warm_up / engine.sample_time) + 1
        count = len(self.residuals)
        self.samples = np.zeros((count, len(STATES)), dtype=np.int64)
        self._fired: frozenset[str] = frozenset()
        self._class = ""
        self._same: Told | None = None  # as many healthy samples as came last
        self._age = np.zeros(count, dtype=np.int64)  # samples without a value, for no signal's sake
        self._codes = np.full(count, _WARMING, dtype=np.int8)  # of the newest sample
        self._missing: Mask = np.zeros(len(self._signals), dtype=np.bool_)  # in the newest sample
        self._valid: Mask = np.zeros(count, dtype=np.bool_)
        self.begun = np.zeros(count, dtype=np.bool_)  # that have had a value

    def restart(self) -> None:
        """The residuals begin anew, after a gap."""
        self._age[:] = 0

    def resume(self, latched: Verdict | None) -> None:
        """What a journal knows to be latched still is."""
        if latched is not None:
            self._hear(latched._replace(event="fault"))

    def add(
        self, time: Array, samples: Array, decided: Batch, verdicts: Sequence[Verdict]
    ) -> tuple[Told, list[Change]]:
        """What further samples are, and where signals began or ceased to be missing.

        `time` (n,) in s, `samples` (n, signals), by what they were `decided` on, and what was said
        of them, in order.
        """
        valid, known, there = decided.valid, np.isfinite(decided.bound), np.isfinite(samples)
        quiet = not self._fired and not any(v.event in _TOLD for v in verdicts)
        if quiet and not self._missing.any() and there.all() and valid.all() and known.all():
            return self._healthy(len(time)), []
        absent = ~there
        if absent.any() or self._missing.any():
            lacking = (absent.astype(np.int8) @ self._reads.T.astype(np.int8)) > 0
            changes = self._changes(time, absent, lacking, valid)
        else:
            lacking, changes = np.zeros_like(valid), []
        codes = np.full(valid.shape, _HEALTHY, dtype=np.int8)
        codes[valid & ~known] = _BLIND
        if valid.all():
            self._age[:] = 0
        else:
            age = self._ages(valid | lacking)
            codes[~valid] = np.where(age > self._patience, _BLIND, _WARMING)[~valid]
            codes[~valid & lacking] = _BLIND
        fired, named = self._latched(time, verdicts)
        active: Mask = np.asarray(fired.any(axis=1), dtype=np.bool_)
        with np.errstate(invalid="ignore"):
            beyond = known & valid & (np.abs(decided.value) > decided.bound)
        codes[fired[:, :-1] | (beyond & active[:, None])] = _ALARM
        whole = np.where(valid.any(axis=1), _BLIND, _WARMING)
        whole[(valid & known).any(axis=1)] = _HEALTHY
        whole[active] = _ALARM
        self.samples += (codes[:, :, None] == _CODES).sum(axis=0)
        self._codes, self._valid = codes[-1].copy(), valid[-1].copy()
        self.begun |= valid.any(axis=0)
        return Told(codes, whole.astype(np.int8), active, named), changes

    def _healthy(self, count: int) -> Told:
        """So many samples of which there is nothing to say."""
        self.samples[:, _HEALTHY] += count
        self._age[:] = 0
        self._codes[:], self._valid[:], self.begun[:] = _HEALTHY, True, True
        if self._same is None or len(self._same.whole) != count:  # nobody changes it
            self._same = Told(
                np.full((count, len(self.residuals)), _HEALTHY, dtype=np.int8),
                np.full(count, _HEALTHY, dtype=np.int8),
                np.zeros(count, dtype=np.bool_),
                np.full(count, "", dtype=object),
            )
        return self._same

    def now(self, waits: Mapping[str, str]) -> dict[str, tuple[str, str]]:
        """The state of each residual by name, and why where that is no matter of course.

        `waits` says why residuals that could have a value are not watched.
        """
        found = {}
        for k, name in enumerate(self.residuals):
            state, why = STATES[self._codes[k]], ""
            if gone := self._gone(k):
                why = f"{listed(gone, 'and')} {'has' if len(gone) == 1 else 'have'} no number"
            elif name in waits:
                why = waits[name]
            elif state == BLIND:
                why = "its noise is not known" if self._valid[k] else NO_VALUE
            found[name] = (state, why)
        return found

    @property
    def exhausted(self) -> tuple[str, ...]:
        """The residuals that had a value once, and for long none, though nothing is missing."""
        old = (self._age > self._patience) & self.begun
        return tuple(n for n, own in zip(self.residuals, old, strict=True) if own)

    @property
    def latched(self) -> bool:
        """Whether a fault is."""
        return bool(self._fired)

    def _gone(self, k: int) -> list[str]:
        """The signals without a number that a residual reads."""
        gone = zip(self._signals, self._missing & self._reads[k], strict=True)
        return [name for name, own in gone if own]

    def _ages(self, reset: Mask) -> npt.NDArray[np.int64]:
        """Samples since the last one at which a residual had a value or lacked a signal."""
        at = np.arange(1, len(reset) + 1)[:, None]
        last = np.maximum.accumulate(np.where(reset, at, 0), axis=0)
        age = np.where(last > 0, at - last, self._age + at)
        self._age = age[-1].copy()
        return np.asarray(age, dtype=np.int64)

    def _changes(self, time: Array, absent: Mask, lacking: Mask, valid: Mask) -> list[Change]:
        """Where the signals that are missing became others, as far as a residual reads them."""
        read = self._reads.any(axis=0)
        gone = absent & read
        before = np.vstack([self._missing, gone[:-1]])
        found = []
        for k in np.flatnonzero((gone != before).any(axis=1)).tolist():
            signals = tuple(n for n, own in zip(self._signals, gone[k], strict=True) if own)
            blind = tuple(n for n, own in zip(self.residuals, lacking[k], strict=True) if own)
            begun = (self.begun | valid[:k].any(axis=0))[lacking[k]]
            found.append(Change(k, float(time[k]), signals, blind, not begun.any()))
        self._missing = gone[-1].copy()
        return found

    def _latched(
        self, time: Array, verdicts: Iterable[Verdict]
    ) -> tuple[Mask, npt.NDArray[np.object_]]:
        """What has fired at each sample, the last column for signals, and the class."""
        fired = np.zeros((len(time), len(self.residuals) + 1), dtype=np.bool_)
        named = np.full(len(time), "", dtype=object)
        self._mark(fired, named, 0)
        for verdict in verdicts:
            if self._hear(verdict):
                self._mark(fired, named, int(np.searchsorted(time, verdict.time - 1e-9)))
        return fired, named

    def _hear(self, verdict: Verdict) -> bool:
        if verdict.event in ("fault", "update"):
            self._fired = self._fired | frozenset(verdict.residuals or [_SIGNAL])
            self._class = " or ".join(verdict.group) or self._class
        elif verdict.event in ("cleared", "accepted"):
            self._fired, self._class = frozenset(), ""
        else:
            return False
        return True

    def _mark(self, fired: Mask, named: npt.NDArray[np.object_], start: int) -> None:
        """What is latched from a sample on."""
        fired[start:] = [name in self._fired for name in (*self.residuals, _SIGNAL)]
        named[start:] = self._class


#: Why a residual has no value though all that it reads is there.
NO_VALUE = (
    "it has no value: a law or a table is left where it is not defined, an equation has no"
    " solution, or switches turn too often"
)
