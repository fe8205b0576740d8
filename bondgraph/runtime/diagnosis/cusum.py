"""Sums of what is too much in rows (CUSUM), and how high those of a healthy machine climb."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from bondgraph.ir.residual_limit import OVERSHOOT, SHARE, ResidualLimit
from bondgraph.runtime.diagnosis.peaks import Peaks
from bondgraph.runtime.diagnosis.row_averages import Before
from bondgraph.runtime.diagnosis.rows import Row
from bondgraph.runtime.diagnosis.tuning import UNKNOWN, Limit
from bondgraph.runtime.log import Array, Mask
from bondgraph.runtime.monitoring.plain import array, numbers

_LOUDER = 4.0  # times the variance of noise: twice as loud
_SQUARE, _LOUD = 0.5 * (1.0 - 1.0 / _LOUDER), 0.5 * math.log(_LOUDER)
SUMS = 5  #: of each residual
OVER = math.log(20.0)  #: how much more probable it has to be that a fault is over (Wald, 1945)
_FURTHER = np.array([[0.0], [0.0], [OVERSHOOT], [0.0], [0.0]])  # added to the heights of a mean


class Cusum:
    """Five sums of each residual: of what is above, of what is below, of how loud it is.

    Each adds up logarithms, by how much a fault makes a row more probable, and begins anew at zero
    (Page, 1954): a mean that is one deviation off, to either side, or twice the deviation. The last
    two are of averages of rows, to either side, each with so much of those before it as leaves no
    memory (see `Lasting`): they see what stays and is small beside the noise from row to row.
    Heights are above what `Peaks` tell.

    `limits` have the columns of `Limit`. A sum climbs no further above its height than what makes
    it twenty times as probable that a fault is over: where it has come down by that, no alarm would
    be given any more. Of a machine that is known to be `healthy` it climbs as high as it is.
    """

    def __init__(self, residuals: int, learns: bool = True, healthy: bool = False) -> None:
        self._learns, self._above = learns, math.inf if healthy else OVER
        self._peaks = Peaks(SUMS, residuals)
        self._since = np.zeros((SUMS, residuals))  # rows since each sum was zero
        self.restart()

    def end(self) -> None:
        """A healthy log ends: where its sums stand is the end of a peak as well."""
        self.sums[:] = 0.0
        self._peaks.learn(self.sums)

    def restart(self) -> None:
        """The sums begin anew; what is known of peaks is still known."""
        count = self._since.shape[1]
        self.sums = np.zeros((SUMS, count))
        self._peaks.restart()
        self._since[:] = 0.0
        self._before = Before(2, count)  # averages and bounds
        #: Of the last row: what averages are above their bound, in deviations; NaN where unknown.
        self.excess = np.full(count, math.nan)
        #: The averages of the last row without memory, and their bounds, (2, residuals).
        self.lasting = np.full((2, count), math.nan)

    @property
    def held(self) -> Array:
        """Rows since all sums of a residual were zero."""
        return np.asarray(self._since.max(axis=0))

    def onset(self, limits: Array) -> int:
        """Rows since a sum was zero that is too high now: since then something is wrong."""
        over = self.sums > self._tops(limits)
        return int(self._since[over].max(initial=0.0))

    def high(self, limits: Array) -> Mask:
        """Which residuals have a sum that is too high now."""
        return np.asarray((self.sums > self._tops(limits)).any(axis=0))

    def heights(self, normal: Array) -> Array:
        """The heights that tell of a fault, (5, residuals); `normal` are those for normal rows."""
        return self._peaks.heights(normal)

    def add(self, row: Row, limits: Array) -> Mask:
        """One row more, whose values are near zero within its bound; which residuals are too far.

        A residual without a value, or of unknown noise, begins anew.
        """
        known = row.valid & np.isfinite(limits[:, 0])
        sigma, memory = limits[:, 0], limits[:, 5]
        top = self._tops(limits)
        squares = squared(memory)
        with np.errstate(divide="ignore", invalid="ignore"):
            off = (np.stack([row.value, -row.value]) - row.bound) / (sigma * np.sqrt(memory)) - 0.5
            size = np.maximum(np.abs(row.value) - row.bound, 0.0) / sigma
            loud = (size**2 * _SQUARE - _LOUD) / squares
            loud = np.minimum(loud, SHARE * top[2])
            more = np.vstack([off, loud[None], self._lasting(row, limits)])
            after = np.clip(self.sums + more, 0.0, top + self._above)
        self.sums = np.where(known & np.isfinite(more), after, 0.0)
        if self._learns:
            self._peaks.learn(self.sums)
        self._since = np.where(self.sums > 0.0, self._since + 1.0, 0.0)
        return np.asarray((self.sums > top).any(axis=0))

    def _tops(self, limits: Array) -> Array:
        return self.heights(limits[:, 3] + _FURTHER)

    def _lasting(self, row: Row, limits: Array) -> Array:
        """What averages add, (2, residuals); NaN where it is not known."""
        none = np.full((2, len(limits)), math.nan)
        own = none
        if row.average is not None:
            known = row.average.valid & (limits[:, 6] > 0.0)
            value, bound = row.average.value - limits[:, 7], row.average.bound
            own = np.where(known, [value, bound], math.nan)
        value, bound = self.lasting = self._before.added(own, limits)
        self.excess = np.sign(value) * np.maximum(np.abs(value) - bound, 0.0) / limits[:, 6]
        return np.asarray((np.stack([value, -value]) - bound) / limits[:, 6] - 0.5)

    def state(self) -> dict[str, Any]:
        """All that `resumed` needs, as plain JSON."""
        return {"sums": numbers(self.sums), "peaks": self._peaks.state()}

    def resumed(self, state: dict[str, Any]) -> Cusum:
        """The same in a state; raises KeyError, TypeError or ValueError for one of another kind."""
        other = Cusum(self._since.shape[1], self._learns)
        other.sums = array(state["sums"], self.sums.shape)
        other._peaks.resume(state["peaks"])
        return other


def squared(memory: Any) -> Any:
    """The memory of squares, of noise of first order that has this one."""
    return 0.5 * (memory + 1.0 / memory)


def on_board(limit: Limit, bound: float = 0.0) -> ResidualLimit:
    """The limit as code has it that has no history: what it multiplies with, once and for all.

    `bound` is the largest adaptive threshold. It has room for where a machine may stand, too, and
    for how far it goes from there: code on board does not learn where this one does.

    >>> on_board(Limit(sigma=0.2, crossings=10.0, kappa=4.5, height=9.3))[:3]
    (0.0, 0.9, 5.0)
    """
    sigma, memory = limit.sigma, limit.memory
    squares = squared(memory)
    unit = 1.0 / (sigma * math.sqrt(memory))
    loud = _SQUARE / (squares * sigma**2)
    far = bound + UNKNOWN * limit.apart + limit.goes
    return ResidualLimit(
        limit.mean, limit.kappa * sigma, unit, loud, _LOUD / squares, limit.height, far
    )
