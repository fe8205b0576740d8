"""Checkpoints: what was known of a machine earlier, to go back to when a fault came on slowly.

A healthy machine drifts, and is followed. What drifts faster than that is followed for a while,
too, as each row tells so little of it: a sensor, a leak that grows. Once it is told as a fault,
what was learned since it began is wrong: it would be told too small, and with the other sign when
it is gone.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence

import numpy as np

from bondgraph.runtime.diagnosis.history import HEALTHY, History
from bondgraph.runtime.diagnosis.rows import Row
from bondgraph.runtime.diagnosis.standing import Levels
from bondgraph.runtime.log import Array, Mask
from bondgraph.text.tuples import NamedTuple

_EACH = 8  # that are kept, of ages from one power of two to the next
_FAR = 3.0  # deviations of what a healthy machine moves by
_GOES_ON = 0.25  # of what has moved, that did in the last half of the time, at least
_PEAK = 0.5  # of the largest square: a drift began no later than it stands out most
_LAST = 3  # rows that tell what is out now
_ALIKE = 0.9  # cosine: what is out now is more of what has been learned
_SUDDEN = 1.5  # times what a step leaves: a line that leaves more is none


class Checkpoint(NamedTuple):
    """What is known of a machine after so many rows, at a time in seconds."""

    row: int
    time: float
    history: History
    limits: Array
    levels: Levels

    def expected(self, rows: Sequence[Row], own: Mask) -> Array:
        """What residuals are in rows by what is known, (rows, own)."""
        found = self.history.expected(_slopes(rows, own))[0].reshape(len(rows), -1)
        return np.asarray(found + self.limits[own, 4])

    def moves(self, age: int, rows: Sequence[Row], own: Mask, drifting: Sequence[int]) -> Array:
        """The variance of where they are so many rows later, while all is well, (rows, own)."""
        later = self.history.drifted(drifting, rows=age)
        variance = later.expected(_slopes(rows, own))[1].reshape(len(rows), -1)
        return np.asarray(variance + self.levels.moves(age)[own])

    def out(self, row: Row) -> bool:
        """Whether something is out in a row, by what is known."""
        sure = row.valid & np.isfinite(self.limits[:, 0])
        value = np.where(sure, row.value + row.mean - self.limits[:, 4], 0.0)
        own = self.history.innovation(row._replace(value=value, average=None), sure)
        loud = np.abs(own.value) - own.bound > self.limits[:, 0]
        return bool((sure & loud).any())


class Checkpoints:
    """What was known after earlier rows, the more seldom the longer that is ago."""

    def __init__(self) -> None:
        self._known: list[Checkpoint] = []
        self._drift: Checkpoint | None = None
        self._usual = 0  # rows that have been as before the drift

    def add(self, known: Checkpoint) -> None:
        """What is known now."""
        kept = [one for one in self._known if one.row % _apart(known.row - one.row) == 0]
        self._known = [*kept, known]

    def clear(self) -> None:
        """What was known is of something else."""
        self._known, self._drift = [], None

    def alarm(
        self, now: Checkpoint, rows: Sequence[Row], out: Mask, drifting: Sequence[int]
    ) -> Checkpoint | None:
        """What was known before the drift that makes an alarm: residuals that are `out` in rows."""
        found = self._before(now, rows, out, drifting)
        on = found is not None and _goes_on(found, now, rows)
        self._drift, self._usual = None if on else found, 0
        return self._taken(found) if on else None

    def returned(self, row: Row, now: Callable[[], Checkpoint]) -> Checkpoint | None:
        """What was known before a drift, once the machine is as then: what is told ends the drift.

        That takes as many rows as are waited for before one counts as healthy, in each of which
        something is out by what is known `now`.
        """
        if self._drift is None:
            return None
        if self._drift.out(row):
            self._usual = 0
        elif now().out(row):
            self._usual += 1
        return self._taken(self._drift) if self._usual >= HEALTHY else None

    def _taken(self, known: Checkpoint | None) -> Checkpoint | None:
        """What was learned after that is gone."""
        if known is not None:
            self._known = [one for one in self._known if one.row <= known.row]
            self._drift = None
        return known

    def _before(
        self, now: Checkpoint, rows: Sequence[Row], out: Mask, drifting: Sequence[int]
    ) -> Checkpoint | None:
        """What was known before a drift began that goes on until now, if there is one.

        The residuals that are `out` have been followed further than those of a healthy machine
        move, whose parameters `drifting` drift, and they moved until now. Such a drift stands out
        most, in deviations of what is healthy, beside what was known when it began: where it began
        is where that is largest, as with a generalized likelihood ratio (Willsky and Jones, 1976).
        """
        known = [one for one in self._known
                 if one.row < now.row and np.isfinite(one.limits[out, 0]).all()]  # fmt: skip
        if not (rows and known and out.any()):
            return None
        weight = np.array([one.valid[out] for one in rows]) / now.limits[out, 0] ** 2
        here = now.expected(rows, out)
        moved = {one.row: here - one.expected(rows, out) for one in known}
        best, found = 0.0, None
        for one in reversed(known):
            age, gone = now.row - one.row, moved[one.row]
            whole = float((weight * gone**2).sum())
            healthy = float((weight * one.moves(age, rows, out, drifting)).sum())
            far = whole / healthy if healthy > 0.0 else 0.0
            half = min(moved, key=lambda row: abs(2 * (now.row - row) - age))
            lately = float((weight * gone * moved[half]).sum())
            stands_out = far >= max(_FAR**2, _PEAK * best)
            if far < _PEAK * best or (stands_out and lately < _GOES_ON * whole):
                break
            if stands_out:
                best, found = max(best, far), one
        return found


def _goes_on(known: Checkpoint, now: Checkpoint, rows: Sequence[Row]) -> bool:
    """Whether what is out in the last rows is more of what has been learned, and not sudden."""
    own = np.isfinite(known.limits[:, 0]) & np.isfinite(now.limits[:, 0])
    root = np.array([one.valid[own] for one in rows]) / now.limits[own, 0]
    there = known.expected(rows, own)
    learned = root * (now.expected(rows, own) - there)
    out = root * (np.array([(one.value + one.mean)[own] for one in rows]) - there)
    both, squares = (out * learned).sum(axis=1), (learned**2).sum(axis=1)
    sizes = float(np.linalg.norm(out[-_LAST:]) * np.linalg.norm(learned[-_LAST:]))
    alike = float(both[-_LAST:].sum()) >= _ALIKE * sizes
    sure = squares > 0.0
    return alike and steady(both[sure] / squares[sure], squares[sure])


def steady(values: Array, weights: Array) -> bool:
    """Whether values (n,) with these weights are no worse on a line than on a step near their end.

    >>> row = np.arange(40.0)
    >>> steady(row + 3.0 * np.sin(row), np.ones(40)), steady(30.0 * (row > 36), np.ones(40))
    (True, False)
    """
    row = np.arange(len(values), dtype=float)
    steps = [row >= k for k in range(len(row) // 2, len(row))]
    return _left(row, values, weights) <= _SUDDEN * min(
        (_left(one.astype(float), values, weights) for one in steps), default=math.inf
    )


def _left(shape: Array, values: Array, weights: Array) -> float:
    """What is left of values beside a constant and so much of a shape as fits best."""
    shape, values = (x - np.average(x, weights=weights) for x in (shape, values))
    square = float(weights @ shape**2)
    size = float(weights @ (shape * values)) / square if square > 0.0 else 0.0
    return float(weights @ (values - size * shape) ** 2)


def _slopes(rows: Sequence[Row], own: Mask) -> Array:
    """By what is tolerated, of some residuals, (tolerated, rows * own)."""
    return np.concatenate([one.slopes[:, own] for one in rows], axis=1)


def _apart(age: int) -> int:
    """How many rows apart what was known so many rows ago is kept.

    >>> [_apart(age) for age in (1, 15, 16, 100, 1000)]
    [1, 1, 2, 8, 64]
    """
    return max(1, (1 << (age.bit_length() - 1)) // _EACH)
