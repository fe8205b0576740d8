"""Time-stamped samples on the uniform grid that `step` wants: gaps, jitter, missing values, wraps.

A filter that takes samples as uniform when they are not sees motion that is not there, and one
value that is no number stays in it for ever. So every signal is taken between its neighbours in
time, over gaps of up to one time constant of the filter; beyond that nobody knows what the machine
has done, and the filters start anew.
"""

from __future__ import annotations

from collections.abc import Iterable
from itertools import pairwise

import numpy as np

from bondgraph.ir.program import Known
from bondgraph.runtime.log import Array, Mask
from bondgraph.runtime.monitoring.engine import Engine
from bondgraph.text.moment import moment
from bondgraph.text.tuples import NamedTuple

#: Why a sample is thrown away: its time is before that of another one, or the same; it has no
#: value at all, or no time.
THROWN = ("late", "twice", "empty", "untimed")

#: The period of a clock that counts microseconds in 32 bits, in s.
WRAP_32 = 2.0**32 / 1e6

_EXACT = 1e-6  # of the sample time: nearer to a point of the grid a sample is taken as it is
_FOREVER = 1e15  # s: beyond it a double does not tell one sample from the next
_COUNTER, _LARGEST = 2.0**32, 2.0**53
_BLOCK = 8192  # samples taken at a time
_MISSED = 3.0  # steps of the grid that are bridged by the fastest filter: two samples lost
_WINDOW = 256  # samples in which a break is looked for first


class Gap(NamedTuple):
    """Why the filters start anew: `start` and `end` are the times of the samples before and after.

    `lost` is how many samples of the grid are missing between them; 0 where the clock went back.
    They may be missing because the machine was `off`. The clock may have stood still meanwhile, for
    so many samples (`still`).
    """

    start: float
    end: float
    lost: int
    off: bool = False
    still: int = 0

    @property
    def text(self) -> str:
        """One sentence for people."""
        start, end = (moment(time, ".6g") for time in self[:2])
        if self.end < self.start:
            back = self.start - self.end
            return f"the clock went back by {back:.6g} s at {start}"
        if self.off:
            return f"the machine was off from {start} to {end}"
        if self.still:
            return f"the clock stood still at {start} for {self.still} samples"
        missing = f"{self.lost} sample{'s' if self.lost != 1 else ''}"
        return f"{missing} lost from {start} to {end}"


class Piece(NamedTuple):
    """Samples on the grid, (n,) in s and (n, signals), NaN where a signal is not known.

    `anew` says why the filters have to start anew with them, "" where they go on; then `gap` says
    the same in numbers.
    """

    time: Array
    samples: Array
    anew: str = ""
    gap: Gap | None = None


class Clock:
    """Brings samples to a grid of `sample_time` s, the same for whatever blocks they come in.

    Gaps of up to `most` s are bridged: signals as straight lines, encoders rounded to whole counts
    (a counter of 32 bits may run over), modes as they were. A value that is not finite counts as
    missing, in its own signal only; over a longer time it is NaN. A longer gap of all signals, and
    a clock that goes back by more than `most`, make a new piece. A sample that comes twice or late
    is dropped, and `thrown` says how many for which of the causes of `THROWN`. Other samples for
    longer than `most`, all of the same time, make a new piece too: the clock stood still. `used`
    counts those that are neither dropped nor `left_out`. `wraps` is the period of a clock that runs
    over, in s.
    """

    def __init__(
        self, signals: Iterable[Known], sample_time: float, most: float, wraps: float | None = None
    ) -> None:
        known = tuple(signals)
        self.sample_time, self.most, self.wraps = sample_time, most, wraps
        self.thrown = dict.fromkeys(THROWN, 0)
        self.thrown_since: float | None = None  # s, where the first one was; whoever tells forgets
        self.left_out = 0  # samples in which the machine was off
        self.used = 0
        self.missing = np.zeros(len(known), dtype=np.int64)  # of these, without each signal
        self.still = 0  # samples since the last one that was used: of its time, with other values
        self._latest: Array = np.full(len(known), np.nan)  # the values that came last
        self._since: float | None = None  # the newest time before it was
        self._modes: Mask = np.array([k.kind == "mode" for k in known], dtype=np.bool_)
        self._counts = [at for at, k in enumerate(known) if k.counts is not None]
        self._taken = 0  # samples without time
        self._raw: float | None = None  # the newest time as it came
        self._laps = 0
        self._top: float | None = None  # the newest time of this stretch, None before the first
        self._start, self._exact = 0.0, 0.0
        self._next = 0  # the point of the grid that comes next
        self._gap: Gap | None = None  # to be told with the next piece
        self._last = np.full((2, len(known)), np.nan)  # of each encoder: as it came, and in all
        self._times: Array = np.empty(0)
        self._rows: Array = np.empty((0, len(known)))

    def feed(
        self, time: Array | None, samples: Array, on: Mask | None = None
    ) -> list[Piece]:
        """What further samples make known of the grid; without times they are uniform.

        `time` (n,) in s, `samples` (n, signals). Where a signal is missing, the grid waits for its
        next value, `most` s at the longest. While the machine is not `on` (n,) there is no grid,
        however short that is.
        """
        rows = np.asarray(samples, dtype=np.float64)
        turns = [] if on is None else (np.flatnonzero(on[1:] != on[:-1]) + 1).tolist()
        pieces: list[Piece] = []
        for start, end in pairwise([0, *turns, len(rows)]):
            works = on is None or start == end or bool(on[start])
            for first in range(start, end, _BLOCK):
                block = slice(first, min(first + _BLOCK, end))
                part = None if time is None else time[block]
                pieces += self._feed(part, rows[block]) if works else self._off(part, rows[block])
        return pieces

    def _off(self, time: Array | None, samples: Array) -> list[Piece]:
        """Leave out samples, and end the stretch before them."""
        times, _ = self._stamped(time, samples)
        self.left_out += len(times)
        self.still = 0
        pieces = self.finish()
        self._since = self._since if self._top is None else self._top
        self._top = None
        return pieces

    def _feed(self, time: Array | None, samples: Array) -> list[Piece]:
        """A block that fits into the caches of the processor."""
        times, rows = self._stamped(time, samples)
        pieces: list[Piece] = []
        at = 0
        while at < len(times):
            if self._top is None:
                if self._since is not None:
                    self._gap = self._between(self._since, float(times[at]), True)
                    self._since = None
                self._begin(float(times[at]))
            assert self._top is not None
            top, stood = self._top, 0
            end, steps = self._stretch(times, at)
            fresh = steps > 4.0 * self._exact
            if self.still or not fresh.all():
                count, stood = self._thrown(times[at:end], rows[at:end], steps, fresh)
                if stood:
                    end, fresh = at + count, fresh[:count]
                    self._top = float(times[at:end][fresh].max(initial=top))
            self._extend(times[at:end][fresh], rows[at:end][fresh])
            self._latest = rows[max(end, 1) - 1].copy()
            pieces += self._emit(end < len(times))
            if end < len(times):
                self._break(float(times[end]), stood)
            at = end
        return pieces

    @property
    def dropped(self) -> int:
        """Samples that were thrown away, for whatever cause."""
        return sum(self.thrown.values())

    @property
    def off(self) -> bool:
        """Whether the machine is."""
        return self._since is not None

    @property
    def stands(self) -> bool:
        """Whether the clock has stood still for too long: what comes next makes a new piece."""
        return self.still * self.sample_time > self.most

    def finish(self) -> list[Piece]:
        """What is left at the end of the samples."""
        return self._emit(True) if self._top is not None else []

    # ------------------------------------------------------------------ times as they come

    def _stamped(self, time: Array | None, rows: Array) -> tuple[Array, Array]:
        """Times that do not run over, and the rows that have a time and a value."""
        times: Array = np.asarray(time, dtype=np.float64)
        if time is None:
            whole = self._taken + np.arange(len(rows), dtype=np.float64)
            times = whole * self.sample_time
            self._taken += len(rows)
        there = np.abs(times) < _FOREVER  # false for NaN too
        if self.wraps is not None and there.any():
            raw = times[there]
            steps = np.diff(raw, prepend=raw[0] if self._raw is None else self._raw)
            turns = (steps < -self.wraps / 2).astype(np.int64) - (steps > self.wraps / 2)
            laps = self._laps + np.cumsum(turns)
            self._raw, self._laps = float(raw[-1]), int(laps[-1])
            times = times.copy()
            times[there] = raw + laps * self.wraps
        some = np.isfinite(rows).any(axis=1)
        if not (there & some).all():
            self.thrown["untimed"] += int((~there).sum())
            self.thrown["empty"] += int((there & ~some).sum())
            self._throw(times[there & ~some])
            there &= some
        return times[there], rows[there]

    def _begin(self, start: float) -> None:
        """Start a grid at a time."""
        self._start, self._next = start, 0
        self._exact = max(_EXACT * self.sample_time, 2.0 * float(np.spacing(abs(start))))
        self._top = -np.inf
        self.still = 0
        self._last[:] = np.nan
        self._times, self._rows = self._times[:0], self._rows[:0]

    def _break(self, time: float, still: int) -> None:
        """Start a new grid behind a gap."""
        assert self._top is not None
        still = still or (self.still if self.stands else 0)  # it stood, and was set right
        self._gap = self._between(self._top, time)._replace(still=still)
        self._begin(time)

    def _between(self, start: float, end: float, off: bool = False) -> Gap:
        lost = round((end - start) / self.sample_time) - 1
        return Gap(start, end, max(0, lost), off)

    def _throw(self, times: Array) -> None:
        """Put down where the first sample was thrown away."""
        if len(times) and self.thrown_since is None:
            self.thrown_since = float(times[0])

    def _thrown(self, times: Array, rows: Array, steps: Array, fresh: Mask) -> tuple[int, int]:
        """Count samples that are thrown away, up to one behind which the clock stood for too long.

        How many there are up to it, and for how many samples it stood; all, and 0, where there is
        none.
        """
        late = steps < -4.0 * self._exact
        before = np.vstack([self._latest, rows[:-1]])
        other = ((rows != before) & ~(np.isnan(rows) & np.isnan(before))).any(axis=1)
        stood = self.still + np.cumsum(other & ~late & ~fresh)
        at = np.flatnonzero(fresh)
        spells = np.diff(stood[at], prepend=0)
        count, spell = len(rows), 0
        if (long := spells * self.sample_time > self.most).any():
            first = int(np.argmax(long))
            count, spell = int(at[first]), int(spells[first])
        self.thrown["late"] += int(late[:count].sum())
        self.thrown["twice"] += int((~late & ~fresh)[:count].sum())
        self._throw(times[:count][~fresh[:count]])
        self.still = 0 if spell else int(stood[-1] - (stood[at[-1]] if len(at) else 0))
        return count, spell

    def _stretch(self, times: Array, at: int) -> tuple[int, Array]:
        """Up to where the times from `at` on belong together, and their steps to the newest one."""
        assert self._top is not None
        found: list[Array] = []
        width, start = _WINDOW, at
        while start < len(times):
            part = times[start : start + width]
            before = np.maximum.accumulate(np.concatenate([[self._top], part[:-1]]))
            steps = part - before
            apart = (np.abs(steps) > self.most + self._exact) & np.isfinite(steps)
            if apart.any():
                cut = int(np.argmax(apart))
                found.append(steps[:cut])
                self._top = float(before[cut])
                return start + cut, np.concatenate(found)
            found.append(steps)
            self._top = max(float(before[-1]), float(part[-1]))
            start, width = start + len(part), 2 * width
        return len(times), np.concatenate(found)

    # ------------------------------------------------------------------- samples as they come

    def _extend(self, times: Array, rows: Array) -> None:
        """Take samples of the stretch, counters without their runs over."""
        there = np.isfinite(rows)
        rows = np.where(there, rows, np.nan)
        for at in self._counts:
            self._count(rows[:, at], at)
        self.used += len(times)
        self.missing += len(times) - there.sum(axis=0)
        self._times = np.concatenate([self._times, times])
        self._rows = np.concatenate([self._rows, rows])

    def _count(self, column: Array, at: int) -> None:
        """Replace the counts of an encoder by those of a counter that never runs over."""
        there = np.abs(column) < _LARGEST
        column[~there] = np.nan
        raw = column[there]
        if not len(raw):
            return
        last, total = self._last[:, at] if np.isfinite(self._last[0, at]) else (raw[0], raw[0])
        steps = np.diff(raw, prepend=last)
        steps -= _COUNTER * np.floor(steps / _COUNTER + 0.5)  # whole numbers: exact
        column[there] = total + np.cumsum(steps)
        self._last[:, at] = raw[-1], column[there][-1]

    # ---------------------------------------------------------------------------- the grid

    def _emit(self, ended: bool) -> list[Piece]:
        """The points of the grid that no later sample changes; all, where the stretch has ended."""
        times, rows = self._times, self._rows
        if not len(times):
            return []
        there = np.isfinite(rows)
        limit = float(times[-1]) if ended else self._known(there)
        most = int((limit - self._start) / self.sample_time) + 2
        points = np.arange(self._next, max(most, self._next), dtype=np.float64)
        grid: Array = self._start + points * self.sample_time
        grid = grid[grid <= limit + self._exact]
        if not len(grid):
            return []
        full = there.all(axis=0) & ~self._modes
        if full.all():
            found = self._lines(grid, times, rows)
        else:
            found = np.empty((len(grid), rows.shape[1]))
            found[:, full] = self._lines(grid, times, rows[:, full])
        for at in np.flatnonzero(~full):
            good = there[:, at]
            between = self._held if self._modes[at] else self._lines
            found[:, at] = between(grid, times[good], rows[good, at : at + 1])[:, 0]
        found[:, self._counts] = np.rint(found[:, self._counts])
        self._next += len(grid)
        self._forget()
        gap, self._gap = self._gap, None
        return [Piece(grid, found, gap.text if gap else "", gap)]

    def _known(self, there: Mask) -> float:
        """Up to where all signals are known, or will not be."""
        last = float(self._times[-1])
        waiting = there.any(axis=0) & ~there[-1] & ~self._modes
        newest = [float(self._times[there[:, at]][-1]) for at in np.flatnonzero(waiting)]
        return min([t for t in newest if last - t <= self.most + self._exact], default=last)

    def _lines(self, grid: Array, times: Array, rows: Array) -> Array:
        """Straight lines between samples that are no more than `most` apart, elsewhere NaN."""
        if not len(times):
            return np.full((len(grid), rows.shape[1]), np.nan)
        at = np.searchsorted(times, grid + self._exact, side="right") - 1
        left, right = np.maximum(at, 0), np.minimum(at + 1, len(times) - 1)
        width = times[right] - times[left]
        found = rows[left]
        off = (at < 0) | (times[left] < grid - self._exact)  # not on a sample
        inside = np.flatnonzero(off & (at >= 0) & (width > 0) & (width <= self.most + self._exact))
        a, b = left[inside], right[inside]
        share = ((grid[inside] - times[a]) / width[inside])[:, None]
        with np.errstate(over="ignore", invalid="ignore"):
            found[inside] += (rows[b] - found[inside]) * share
        off[inside] = False
        found[off] = np.nan
        return found

    def _held(self, grid: Array, times: Array, rows: Array) -> Array:
        """The sample before, where it is no more than `most` old, elsewhere NaN."""
        if not len(times):
            return np.full((len(grid), rows.shape[1]), np.nan)
        at = np.searchsorted(times, grid + self._exact, side="right") - 1
        found = rows[np.maximum(at, 0)]
        old = (at < 0) | (grid - times[np.maximum(at, 0)] > self.most + self._exact)
        found[old] = np.nan
        return found

    def _forget(self) -> None:
        """Drop samples that no further point of the grid can need."""
        point = self._start + self._next * self.sample_time
        oldest = point - self.most - self.sample_time - 4.0 * self._exact
        first = int(np.searchsorted(self._times, oldest))
        first = min(first, len(self._times) - 1)  # the newest one says what is late
        self._times, self._rows = self._times[first:].copy(), self._rows[first:].copy()


def clock_of(engine: Engine, most: float | None = None, wraps: float | None = None) -> Clock:
    """The clock of an engine; `most` is one time constant of its filter unless told otherwise.

    Not less than two samples that are missed, as one in twenty is in logs of a sample a second.
    """
    bridged = max(1.0 / engine.bandwidth, _MISSED * engine.sample_time) if most is None else most
    return Clock(engine.signals, engine.sample_time, bridged, wraps)
