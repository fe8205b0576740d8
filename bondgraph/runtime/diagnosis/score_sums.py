"""Sums along what a fault does: what moves a residual to and fro adds up in no sum of the residual.

A mass that is wrong pushes a residual one way while a machine gains speed and the other way while
it brakes, a gain that is wrong does so with the sign of a reading. The mean stays where it is.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np

from bondgraph.ir.residual_limit import SHARE
from bondgraph.runtime.diagnosis.cusum import OVER
from bondgraph.runtime.diagnosis.history import History
from bondgraph.runtime.diagnosis.noise import COVERED
from bondgraph.runtime.diagnosis.peaks import Peaks
from bondgraph.runtime.diagnosis.row_averages import Before
from bondgraph.runtime.diagnosis.rows import Average, Row, model_error
from bondgraph.runtime.diagnosis.tuning import UNKNOWN, Limit
from bondgraph.runtime.log import Array, Mask
from bondgraph.runtime.monitoring.plain import array, numbers

_LONG = 64  # rows in which a sum shows what it sees: twice its height, at a design of one deviation
_RARE = 4.0  # all sums of a residual are to come to their heights so much more seldom than a test
_FIRST = 24  # rows that tell of a fault as much as any, from which is learned where residuals stand
_KEPT = 1.0 - 1.0 / 1000.0  # of what is learned, with each further row
_ALONG = Limit._fields.index("along")


class ScoreSums:
    """Two sums of each residual for each direction in which faults move it: for more and for less.

    Each adds up by how much a change of the fault makes averages of rows more probable (Page, 1954)
    that are free of memory (see `Before`): the score, which is the slope by the fault times the
    residual over its variance (Basseville and Nikiforov, 1993; Zhang, Basseville and Benveniste,
    1994). The change is such that a row which tells most of the fault is moved by one deviation of
    its noise. Taken off is

    - what others do that may be off while all is well: each tolerated parameter by what is not
      known of it and by what it may drift, times the products of its slope with that of the fault.
      These are summed before their size is taken: what stands still while the fault moves to and
      fro adds up to little. The largest so far counts, so that a few motions alone tell nothing;
    - what no parameter explains, of each row;
    - what noise in the slope adds that is in the residual as well, which is no more than the change
      over the whole of what is changed, in each row (attenuation; Fuller, 1987);
    - where a residual stands along a direction that is not `tolerated`, as no model is exact. That
      is learned, from the first rows that tell of it and from each later one that is healthy.

    `sizes` are the whole of what each direction changes, (directions,). A residual has no such sums
    where its averages are not known. Other arguments are those of `Cusum`.
    """

    def __init__(
        self,
        sizes: Array,
        residuals: int,
        learns: bool = True,
        healthy: bool = False,
        tolerated: Sequence[bool] = (),
    ) -> None:
        self._sizes, self._shape = np.abs(sizes)[:, None], (2, len(sizes), residuals)
        self._tolerated: Mask = np.array(tolerated or [False] * len(sizes), dtype=np.bool_)
        self._learns, self._above = learns, math.inf if healthy else OVER
        self._peaks = Peaks(*self._shape)
        #: What rows tell of a change of one, and its squares: sums of all so far.
        self._tells = np.zeros((2, *self._shape[1:]))
        #: Scores of rows, and what they tell: of those that the offset is known from.
        self._learned = np.zeros((2, *self._shape[1:]))
        self._learned[1, self._tolerated] = math.inf
        self.restart()

    def restart(self) -> None:
        """The sums begin anew; what is known of healthy rows is still known."""
        self.sums, self._since = np.zeros(self._shape), np.zeros(self._shape)
        #: What is to be taken off each sum, and products that it comes from, added up: of the slope
        #: with those by tolerated parameters and with itself, over the variance.
        self._room, self._products = np.zeros(self._shape), np.zeros((*self._shape, 1))
        self._waits = np.zeros((2, *self._shape[1:]))  # to be learned, once no sum is above zero
        self._before: Before | None = None
        self._peaks.restart()

    def end(self) -> None:
        """A healthy log ends: where its sums stand is the end of a peak as well."""
        self.sums[:] = 0.0
        self._peaks.learn(self.beyond)
        self.restart()

    @property
    def beyond(self) -> Array:
        """By how much sums are above what a healthy machine does, (2, directions, residuals)."""
        return np.asarray(np.maximum(self.sums - self._room, 0.0))

    @property
    def held(self) -> Array:
        """Rows since all sums of a residual were zero that tell of more than a healthy machine."""
        held = np.where(self.beyond > 0.0, self._since, 0.0)
        return np.asarray(held.max(axis=(0, 1), initial=0.0))

    def onset(self, limits: Array) -> int:
        """Rows since a sum was zero that is too high now: since then something is wrong."""
        return int(self._since[self.beyond > self.heights(limits)].max(initial=0.0))

    def high(self, limits: Array) -> Mask:
        """Which residuals have a sum that is too high now."""
        return np.asarray((self.beyond > self.heights(limits)).any(axis=(0, 1)))

    def heights(self, limits: Array) -> Array:
        """The heights that tell of a fault; as nothing climbs above x more often than exp(-x)."""
        many = limits[:, 3] + math.log(_RARE * max(len(self._sizes), 1))
        return self._peaks.heights(np.where(limits[:, _ALONG] > 0.0, limits[:, _ALONG], many))

    def add(self, row: Row, limits: Array, history: History, healthy: bool = True) -> Mask:
        """One row more, as for `Cusum`, and what is known of the machine before it.

        Nothing is learned where it is not known to be `healthy`.
        """
        if row.average is None or row.directions is None:
            self.restart()
            return np.zeros(self._shape[2], dtype=np.bool_)
        count = len(history.prior)
        if self._products.shape[3] != count + 1:  # starts that were estimated are tolerated, too
            self.restart()
            self._products = np.zeros((*self._shape, count + 1))
        table = self._whitened(row.average, row.directions, row.valid, limits)
        value, bound, slopes, moves = table[0], table[1], table[2 : 2 + count], table[2 + count :]
        with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
            weight = moves / (limits[:, 6] ** 2 + model_error(value, bound))
            score, tells = weight * value, weight * moves
            here = np.isfinite(score) & np.isfinite(tells**2)
            self._waits += np.where(here, [score, tells], 0.0)
            self._tells += np.where(here, [tells, tells**2], 0.0)
            step = np.sqrt(self._tells[0] / self._tells[1])
            first = ~(self._tells[0] ** 2 > _FIRST * self._tells[1]) & ~self._tolerated[:, None]
            parameters = self._drift(history) @ np.abs(slopes) + self._unknown(slopes, history)
            doubt = np.maximum(bound - parameters, 0.0)
            new = step * (score - tells * self._learned[0] / self._learned[1])
            less = step * (0.5 * step * tells + np.abs(weight) * doubt + 1.0 / self._sizes)
            top = self.heights(limits)
            sums = self.sums + np.minimum(np.stack([new, -new]) - less, SHARE * top)
            self._go_on(sums, np.isfinite(sums) & ~first, weight, slopes, moves)
            self._make_room(step, history)
        self._learn(first, healthy)
        self.sums -= np.maximum(self.beyond - top - self._above, 0.0)  # as a Cusum
        if self._learns:
            self._peaks.learn(self.beyond)
        return np.asarray((self.beyond > top).any(axis=(0, 1)))

    def _whitened(self, own: Average, moves: Array, valid: Mask, limits: Array) -> Array:
        """Residuals, bounds and slopes of all kinds in averages that have no memory, NaN where
        that is not known."""
        watched = np.isfinite(limits[:, 0]) & (limits[:, 6] > 0.0)
        self._tells[..., ~watched] = 0.0  # what is known of it is learned anew
        forgotten = ~(watched | self._tolerated[:, None])
        self._learned[:, forgotten] = 0.0
        table = np.vstack([own.value - limits[:, 7], own.bound, own.slopes, moves])
        self._before = self._before or Before(len(table), self._shape[2])
        return self._before.added(np.where(valid & own.valid & watched, table, math.nan), limits)

    def _go_on(
        self, sums: Array, known: Mask, weight: Array, slopes: Array, moves: Array
    ) -> None:
        """Sums that come to zero begin anew, as do those that have told nothing for long."""
        going = known & (sums > 0.0) & ((self._since < _LONG) | (sums > self._room))
        fresh = going & (self._since == 0.0)
        self._room[~going | fresh] = self._products[fresh] = 0.0
        self.sums = np.where(going, sums, 0.0)
        self._since = np.where(going, self._since + 1.0, 0.0)
        _, of, where = at = np.nonzero(going)
        own = np.column_stack([slopes.T[where], moves[of, where]])
        self._products[at] += weight[of, where][:, None] * own

    def _make_room(self, step: Array, history: History) -> None:
        """The largest so far of what healthy parameters may have added to each sum."""
        _, of, where = at = np.nonzero(self.sums > self._room)  # others tell nothing
        products = self._products[at].T
        most = self._drift(history) @ np.abs(products[:-1])
        most += self._unknown(products[:-1], history)
        most += UNKNOWN * products[-1] / np.sqrt(self._learned[1][of, where])
        self._room[at] = np.maximum(self._room[at], step[of, where] * most)

    def _learn(self, first: Mask, healthy: bool) -> None:
        """Learn where residuals stand along each direction, from rows that tell of no fault."""
        over = first | ~(self.sums > 0.0).any(axis=0)
        if healthy:
            self._learned = _KEPT * self._learned + np.where(over, self._waits, 0.0)
        self._waits = np.where(over, 0.0, self._waits)

    @staticmethod
    def _drift(history: History) -> Array:
        """By how much parameters may have drifted."""
        return np.asarray(COVERED * math.sqrt(3.0) * history.prior)

    @staticmethod
    def _unknown(products: Array, history: History) -> Array:
        """What is not known of parameters adds up to at most, (n,); products (parameters, n)."""
        return UNKNOWN * np.sqrt(history.expected(products)[1])

    def state(self) -> dict[str, Any]:
        """All that `resumed` needs, as plain JSON: of sums only those that are not zero."""
        going = self.sums > 0.0
        own = [self.sums, self._since, self._room, self._peaks.open]
        table = np.column_stack([np.argwhere(going), *[x[going] for x in own]])
        return {
            "peaks": self._peaks.state(),
            "learned": numbers(np.vstack([*self._tells, *self._learned, *self._waits])),
            "going": numbers(np.hstack([table, self._products[going]])),
        }

    def resumed(self, state: dict[str, Any]) -> ScoreSums:
        """The same in a state; raises KeyError, TypeError or ValueError for one of another kind."""
        tolerated = self._tolerated.tolist()
        other = ScoreSums(self._sizes[:, 0], self._shape[2], self._learns, False, tolerated)
        other._peaks.resume(state["peaks"])
        learned = array(state["learned"], (6, *self._shape[1:]))
        other._tells, other._learned, other._waits = learned[:2], learned[2:4], learned[4:]
        columns = len(state["going"][0]) if state["going"] else 8
        table = array(state["going"], (len(state["going"]), columns))
        at = tuple(table[:, :3].astype(int).T)
        other.sums[at], other._since[at], other._room[at], other._peaks.open[at] = table[:, 3:7].T
        other._products = np.zeros((*self._shape, columns - 7))
        other._products[at] = table[:, 7:]
        return other
