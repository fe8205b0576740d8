"""That something is wrong: a residual far out for some samples, or a little for many rows."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np

from bondgraph.runtime.diagnosis.healthy import grown
from bondgraph.runtime.diagnosis.naming import LONGEST
from bondgraph.runtime.diagnosis.rows import Part, Row
from bondgraph.runtime.log import Array, Mask
from bondgraph.runtime.monitoring.plain import array, numbers

_BACK = 10  # rows that residuals must be quiet before a fault is over, twice as many each time


class Detection:
    """Two tests of each residual; one that has fired stays so until the fault is over.

    `fired` says which have, `most` by how much of its threshold each was out at most, of the last
    samples while none has fired; `alarms` counts them. The sample test fires after `least` samples
    in a row. `limits` have the columns of `Limit`, (residuals, 4).
    """

    def __init__(self, residuals: Sequence[str], least: int) -> None:
        self._names, self._least = tuple(residuals), least
        self.fired: Mask = np.zeros(len(residuals), dtype=np.bool_)
        self.most = np.zeros(len(residuals))
        self.alarms = 0
        self.restart()

    def restart(self) -> None:
        """The residuals begin anew; what has fired still has."""
        self._streak = np.zeros(len(self._names), dtype=int)
        self._sums = np.zeros((2, len(self._names)))
        self._quiet = 0  # rows

    @property
    def alarmed(self) -> bool:
        """Whether any residual has fired."""
        return bool(self.fired.any())

    def levels(self) -> dict[str, float]:
        """By how much of its threshold each fired residual was out at most."""
        found = zip(self._names, self.most, self.fired, strict=True)
        return {name: round(float(most), 3) for name, most, fired in found if fired}

    def samples(self, part: Part, line: Array) -> Iterator[tuple[int, Mask]]:
        """Numbers of samples at which residuals fire, and which; `line` are whole thresholds.

        Whoever takes them has to `latch` them before the next.
        """
        known = part.valid & np.isfinite(line)
        level = np.where(known, np.abs(part.value) / line, 0.0)
        past = self.most if self.alarmed else 0.0
        self.most = np.maximum(past, level.max(axis=0))
        over = (level > 1.0) & ~self.fired
        if not over.any():
            self._streak[:] = 0
            return
        for k in range(len(over)):
            self._streak = np.where(over[k], self._streak + 1, 0)
            fresh = (self._streak >= self._least) & ~self.fired
            if fresh.any():
                yield k, fresh

    def row(self, row: Row, limits: Array) -> Mask:
        """Which fire by the sum of what is too much in rows, to either side (Page, 1954)."""
        sigma, top = limits[:, 0], limits[:, 3]
        after = np.minimum(grown(self._sums, row.value, row.bound, sigma), 2.0 * top)
        self._sums = np.where(row.valid, after, 0.0)
        return np.asarray((self._sums.max(axis=0) > top) & ~self.fired)

    def latch(self, fresh: Mask) -> bool:
        """These have fired; whether they are the first of an alarm."""
        first = not self.alarmed
        self.fired = self.fired | fresh
        self._quiet = 0
        self.alarms += first
        return first

    def suspects(self, row: Row, limits: Array) -> bool:
        """Whether something is further out than it usually is, though nothing has fired yet."""
        return bool((self._streak > 0).any() or _loud(row, limits).any())

    def over(self, row: Row, limits: Array) -> bool:
        """Whether what has fired has been quiet for long enough, with one row more."""
        quiet = self._quiet + bool(row.valid[self.fired].all())  # who cannot be seen is not quiet
        self._quiet = 0 if (row.valid & _loud(row, limits) & self.fired).any() else quiet
        return bool(self._quiet >= min(_BACK * 2 ** min(self.alarms - 1, 9), LONGEST))

    def clear(self) -> None:
        """The fault is over."""
        self.fired = np.zeros_like(self.fired)
        self.most[:] = 0.0
        self._sums[:] = 0.0

    def state(self) -> dict[str, Any]:
        """All that `resumed` needs, as plain JSON."""
        return {
            "fired": self.fired.tolist(),
            "most": numbers(self.most),
            "sums": numbers(self._sums),
            "alarms": self.alarms,
        }

    def resumed(self, state: dict[str, Any]) -> Detection:
        """The same in a state; raises KeyError, TypeError or ValueError for one of another kind."""
        other = Detection(self._names, self._least)
        other.fired = array(state["fired"], self.fired.shape) != 0.0
        other.most = array(state["most"], self.most.shape)
        other._sums = array(state["sums"], self._sums.shape)
        other.alarms = int(state["alarms"])
        return other


def _loud(row: Row, limits: Array) -> Mask:
    """Residuals that are above half of what noise may add to the adaptive threshold."""
    return np.asarray(np.abs(row.value) - row.bound > 0.5 * limits[:, 2] * limits[:, 0])
