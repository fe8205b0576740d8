"""Where encoders stand and how fast they go: whether they have gone on over a gap."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np

from bondgraph.runtime.log import Array
from bondgraph.runtime.monitoring.plain import array, numbers

_FASTER = 1.5  # times as fast as ever before a machine may have moved in a gap
_TURN = 2.0**32  # counts after which a counter runs over


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
