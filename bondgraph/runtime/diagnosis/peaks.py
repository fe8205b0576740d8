"""How high sums climb while all is well, learned from their peaks."""

from __future__ import annotations

from typing import Any

import numpy as np

from bondgraph.runtime.log import Array
from bondgraph.runtime.monitoring.plain import array, numbers

_LOW = 1.0  # peaks below are not counted
_BEFORE = 20.0  # peaks of normal rows that are reckoned with before the first one
_ABOVE = 1.2  # times the highest peak of a healthy machine that a height stays above


class Peaks:
    """Of sums (..., residuals), each between two zeros.

    Where noise is independent and normal a sum of logarithms of likelihoods climbs higher than x so
    much more seldom than exp(-x); where it is not, as where a machine is louder in some of its
    motions, that is exp(-x/s), and the stretch s is seen in the peaks (Pickands, 1975: an excess
    over a level is exponential).
    """

    def __init__(self, *shape: int) -> None:
        self._count, self._excess = np.zeros((2, shape[-1]))  # of peaks, and all of them together
        self._highest, self.open = np.zeros(shape), np.zeros(shape)

    def restart(self) -> None:
        """The sums begin anew; what is known of peaks is still known."""
        self.open[:] = 0.0

    def heights(self, normal: Array) -> Array:
        """The heights that tell of a fault; `normal` are those for normal rows.

        They are s times these, and above every peak.
        """
        stretch = np.maximum((self._excess + _BEFORE) / (self._count + _BEFORE), 1.0)
        return np.maximum(stretch * normal, _ABOVE * self._highest)

    def learn(self, sums: Array) -> None:
        """A peak counts when its sum is at zero again: those of a fault come to an alarm."""
        zero = sums == 0.0
        over = zero & (self.open > _LOW)
        if over.any():
            every = tuple(range(over.ndim - 1))
            self._count += over.sum(axis=every)
            self._excess += np.where(over, self.open - _LOW, 0.0).sum(axis=every)
            self._highest = np.where(over, np.maximum(self._highest, self.open), self._highest)
        self.open = np.where(zero, 0.0, np.maximum(self.open, sums))

    def state(self) -> list[Any]:
        """What is known, as plain JSON."""
        count = len(self._count)
        rows = np.vstack([self._count, self._excess, self._highest.reshape(-1, count)])
        return numbers(rows)

    def resume(self, state: Any) -> None:
        """What is known in a state; raises TypeError or ValueError for one of another kind."""
        shape = self._highest.shape
        peaks = array(state, (2 + self._highest.size // shape[-1], shape[-1]))
        self._count, self._excess, self._highest = peaks[0], peaks[1], peaks[2:].reshape(shape)
