"""Where a machine stands while it is well, beside others that stood elsewhere.

Healthy logs of several machines, or of several runs of one, differ by more than the noise in each:
a sensor was mounted again, the weather is another. A limit about the mean of all of them takes each
for wrong that stands elsewhere, for as long as it runs. So a tuning says how far they stand apart,
and a watch learns from its first rows where its own machine stands.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np
from scipy.special import stdtrit

from bondgraph.runtime.diagnosis.noise import noise
from bondgraph.runtime.diagnosis.tuning import UNKNOWN
from bondgraph.runtime.diagnosis.wander import Wander
from bondgraph.runtime.log import Array, Mask
from bondgraph.runtime.monitoring.plain import array, numbers

FIRST = 6  #: rows of a log, or of a machine, that tell where it stands
_SETTLES = 200  # rows after which it is known as well as it will be where a residual stands
_BEYOND = 0.0005  # probability that one more log stands beyond the room for that, to either side


class Levels:
    """Where the residuals of a healthy machine stand, and how sure that is.

    A filter of Kalman (1960) for each: its level has a variance that grows by that of a `Wander`
    with each row, and shrinks with each row of a healthy machine. Of another machine than those of
    a tuning some rows have to tell first where it stands: before there is room for all places, as
    these rows may be of one that warms up. What goes further than it wanders is a fault that comes
    on slowly: it is not followed.
    """

    def __init__(self, residuals: int) -> None:
        self._step, self._most, self._noise, self._variance = np.zeros((4, residuals))
        self._covered = np.zeros(residuals)  # of the variance, that limits have room for
        self._room = np.zeros(residuals)  # before some rows have told
        self._gone, self._free = np.zeros((2, residuals))  # since then, and the variance of that
        self._rows, self._last = np.zeros(residuals), np.full(residuals, -math.inf)

    @classmethod
    def tuned(cls, limits: Array) -> Levels:
        """Of some machine, as the `limits` of a tuning say."""
        found = cls(len(limits))
        found._step, found._most = limits[:, 15:17].T.copy()
        alone = limits[:, 0] * np.sqrt(limits[:, 5])
        lasting = limits[:, 6] / (1.0 + limits[:, 8:12].sum(axis=1))
        found._noise = np.where(limits[:, 6] > 0.0, lasting, alone)
        known = np.isfinite(limits[:, 0])
        found._variance = np.where(known, limits[:, 14] ** 2 + found._noise**2, 0.0)
        found._room = UNKNOWN * np.sqrt(found._variance)
        return found

    def begin(self, k: int, found: Wander, stood: float, mean: float, rows: int) -> float:
        """Where a residual stands that wanders as was `found` of so many rows with this mean.

        Found once more, it stands where it `stood` by the rows since, and not where these come to
        with parameters that fit them best: those are others than what a row is judged beside.
        """
        follows = self._step[k] > 0.0
        self._free[k] = self._free[k] if follows else found.variance
        self._gone[k] = self._gone[k] if follows else 0.0
        self._step[k], self._most[k], self._noise[k] = found.step, found.most, found.noise
        self._variance[k] = max(self._variance[k], found.variance) if found.step > 0.0 else 0.0
        self._rows[k], self._covered[k] = rows, found.noise**2 / rows
        return (stood if follows else found.level) if found.step > 0.0 else mean

    @property
    def unsure(self) -> Array:
        """How far from where it is taken to stand each residual may be, (residuals,).

        What a mean of rows is off by for their noise is no part of it where limits have room for
        that.
        """
        unknown = UNKNOWN * np.sqrt(np.maximum(self._variance - self._covered, 0.0))
        return np.where(self._rows < FIRST, self._room, unknown)

    def beyond(self, limits: Array) -> Array:
        """How far beyond their bounds samples may be, (residuals,).

        By the noise of a sample and what is not known of the level, together.
        """
        unsure = np.where(self._rows < FIRST, 0.0, self.unsure)
        return _line(limits, unsure / UNKNOWN) - unsure

    def deviations(self, excess: Array, limits: Array) -> Array:
        """How far samples are off in deviations, of an `excess` over their bounds, (2, residuals).

        To either side; their level is not known for sure, and has a room before rows have told.
        """
        known = np.isfinite(limits[:, 0])
        begins = self._rows < FIRST
        unsure = np.where(begins, 0.0, self.unsure / UNKNOWN)
        deviation = np.where(known, np.hypot(limits[:, 0], unsure), math.inf)
        return np.asarray((excess.max(axis=0) - np.where(begins, self._room, 0.0)) / deviation)

    def ahead(self, alarmed: bool) -> None:
        """A row passes. An alarm is what a walk makes, too: while it lasts there is one."""
        more = (self._most if alarmed else self._step) ** 2
        self._variance += more
        self._free += more

    def moves(self, rows: int) -> Array:
        """The variance of where each residual stands so many rows later, (residuals,)."""
        return np.asarray(np.maximum(self._variance, self._covered) + rows * self._step**2)

    def far(self, limits: Array) -> Mask:
        """Which have been followed too far: as far as no sample may be, from where they stood."""
        return np.asarray(np.abs(self._gone) > _line(limits, np.sqrt(self._free)))

    def drifted(self, limits: Array) -> Array:
        """By how much residuals have been followed that have gone too far, which is taken back."""
        far = self.far(limits)
        back = np.where(far, -self._gone, 0.0)
        self._variance = np.where(far, self._free, self._variance)
        self._gone[far] = 0.0
        return back

    def learn(
        self, time: float, value: Array, bound: Array, valid: Mask, first: bool = False
    ) -> Array:
        """By how much residuals are taken to stand elsewhere, after a healthy row of this time.

        `value` is how far they are from where they were taken to stand, within a `bound` that has
        room for what is not known of that: what else it has room for tells nothing of a level. The
        `first` rows tell at once, later ones when it is known that no fault began in them; none
        tells twice.
        """
        other = np.maximum(bound - self.unsure, 0.0) / UNKNOWN
        own = valid & (self._variance > 0.0) & (time > self._last)
        own &= (self._rows < FIRST) | (not first)
        whole = self._variance + self._noise**2 + other**2
        gain = np.where(own, self._variance / np.where(own, whole, 1.0), 0.0)
        moved = gain * np.where(own, value, 0.0)
        self._variance *= 1.0 - gain
        begins = own & (self._rows < FIRST)
        self._rows += own
        self._last[own] = time
        self._gone = np.where(begins, 0.0, self._gone + moved)
        self._free = np.where(begins, self._variance, self._free)
        return moved

    def copy(self) -> Levels:
        """The same, which learns no more."""
        other = Levels(len(self._step))
        other.go_back(self, np.ones(len(self._step), dtype=bool))
        return other

    def go_back(self, known: Levels, own: Mask) -> None:
        """Take some residuals to stand where they were `known` to."""
        for table, before in zip(self._tables(), known._tables(), strict=True):
            table[own] = before[own]

    def state(self) -> list[Any]:
        """All that `resume` needs, as plain JSON."""
        return [numbers(table) for table in self._tables()]

    def resume(self, state: Any) -> None:
        """Go on from a state; raises TypeError or ValueError for one of another kind."""
        for table, known in zip(self._tables(), state, strict=True):
            table[:] = array(known, table.shape)

    def _tables(self) -> tuple[Array, ...]:
        return (self._step, self._most, self._noise, self._variance, self._covered, self._room,
                self._gone, self._free, self._rows, self._last)  # fmt: skip


def _line(limits: Array, deviation: Array) -> Array:
    """How far samples with these `limits` may be off, whose level has such a deviation."""
    known = np.isfinite(limits[:, 0])
    sigma = np.where(known, limits[:, 0], 0.0)
    return np.where(known, limits[:, 2] * np.hypot(sigma, deviation), math.inf)


def followed(limits: Array, rows: int, wait: int) -> tuple[Array, Array]:
    """How a level that is followed hides a fault, with each of so many rows since that began.

    How well it is known where each residual stands, a deviation, and which share of a fault that is
    constant is not followed, (rows, residuals) each. A row tells after a `wait` of some.

    >>> from bondgraph.runtime.diagnosis.tuning import Limit
    >>> table = np.array([Limit(1.0, 1.0, 4.0, 9.0), Limit(1.0, 1.0, 4.0, 9.0, step=0.1)])
    >>> deviation, share = followed(table, 20, wait=5)
    >>> deviation[-1].round(2).tolist(), share[-1].round(2).tolist()
    ([0.07, 0.32], [0.94, 0.25])
    """
    levels, known = Levels.tuned(limits), np.isfinite(limits[:, 0])
    deviations, stands = np.zeros((rows, len(known))), np.zeros((rows + 1, len(known)))
    for row in range(-_SETTLES, rows):
        levels.ahead(alarmed=False)
        at = max(row, 0)
        deviations[at] = levels.unsure / UNKNOWN
        value = float(row >= wait) - stands[at]
        stands[at + 1] = stands[at] + levels.learn(row, value, levels.unsure, known)
    return deviations, 1.0 - stands[:-1]


def apart(logs: Sequence[Array]) -> tuple[float, Array]:
    """How far healthy logs of a residual stand apart, from the rows of each, NaN without a value.

    The deviation by which one more log may stand elsewhere than their mean, and where each stands
    beside that, (logs,). Few logs tell it badly: one more stands within `UNKNOWN` deviations in 999
    of 1000 cases (the prediction interval of Student's t). One log alone tells nothing.

    >>> draw = np.random.default_rng(1)
    >>> same = [draw.normal(3.0, 1.0, 400) for _ in range(5)]
    >>> other = [one + level for one, level in zip(same, (-2.0, 1.0, 0.0, 2.0, -1.0))]
    >>> found, stands = apart(other)
    >>> round(apart(same)[0], 1), round(found, 1), stands.round(1).tolist()
    (0.3, 7.5, [-2.1, 1.0, -0.0, 2.0, -0.9])
    """
    found = [noise(one) for one in logs]
    good = np.array([one.rows >= FIRST for one in found])
    means = np.array([one.mean for one in found])[good]
    count, stands = len(means), np.zeros(len(logs))
    if count < 2:
        return 0.0, stands
    stands[good] = means - means.mean()
    wider = -float(stdtrit(count - 1, _BEYOND)) / UNKNOWN
    return wider * float(means.std(ddof=1)) * math.sqrt(1.0 + 1.0 / count), stands
