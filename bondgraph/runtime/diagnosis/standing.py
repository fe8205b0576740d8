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
from scipy.special import chdtri, stdtrit

from bondgraph.runtime.diagnosis.noise import noise
from bondgraph.runtime.diagnosis.tuning import UNKNOWN
from bondgraph.runtime.log import Array, Mask
from bondgraph.runtime.monitoring.plain import array, numbers

_ALIKE = 0.01  # probability that logs of one mean are taken for some that stand apart
FIRST = 6  #: rows of a log, or of a machine, that tell where it stands
_BEYOND = 0.0005  # probability that one more log stands beyond the room for that, to either side


class Standing:
    """Learns where residuals stand, of which the `limits` of a tuning say how far that may be.

    Its first rows tell (Kalman 1960, of a level that stays): before there are some of them there is
    room for all places where a machine may stand, as these rows may be of one that warms up. Each
    healthy row behind them tells more.
    """

    def __init__(self, limits: Array) -> None:
        self._variance = np.square(limits[:, 14])
        self._room = UNKNOWN * limits[:, 14]
        self._level, self._rows = np.zeros(len(limits)), np.zeros(len(limits))
        alone = limits[:, 0] * np.sqrt(limits[:, 5])
        lasting = limits[:, 6] / (1.0 + limits[:, 8:12].sum(axis=1))
        #: Deviation with which noise of a row adds up.
        self._noise = np.where(limits[:, 6] > 0.0, lasting, alone)

    def __bool__(self) -> bool:
        return bool(self._room.any())

    @property
    def unsure(self) -> Array:
        """How far from where it is taken to stand each residual may be, (residuals,)."""
        return np.where(self._rows < FIRST, self._room, UNKNOWN * np.sqrt(self._variance))

    def learn(self, value: Array, valid: Mask) -> Array:
        """By how much residuals are taken to stand elsewhere, after a healthy row.

        `value` is how far they are from where they were taken to stand.
        """
        own = valid & (self._variance > 0.0)
        whole = self._variance + self._noise**2
        gain = np.where(own, self._variance / np.where(own, whole, 1.0), 0.0)
        self._level += gain * np.where(own, value - self._level, 0.0)
        self._variance *= 1.0 - gain
        self._rows += own
        moved = np.where(self._rows >= FIRST, self._level, 0.0)
        self._level -= moved
        return moved

    def state(self) -> list[Any]:
        """All that `resume` needs, as plain JSON."""
        return [numbers(table) for table in self._tables()]

    def resume(self, state: Any) -> None:
        """Go on from a state; raises TypeError or ValueError for one of another kind."""
        for table, known in zip(self._tables(), state, strict=True):
            table[:] = array(known, table.shape)

    def _tables(self) -> tuple[Array, ...]:
        return self._variance, self._level, self._rows


def apart(logs: Sequence[Array]) -> tuple[float, Array]:
    """How far healthy logs of a residual stand apart, from the rows of each, NaN without a value.

    The deviation by which one more log may stand elsewhere than their mean, and where each stands
    beside that, (logs,). Both are zero where all may have the same mean by the noise of each
    (Cochran 1937, Q), else the first is by the moments (DerSimonian and Laird 1986), and wider, as
    few logs tell it badly: the room for it is by Student's t. A row of the machine tells more.

    >>> draw = np.random.default_rng(1)
    >>> same = [draw.normal(3.0, 1.0, 400) for _ in range(5)]
    >>> apart(same)[0]
    0.0
    >>> other = [one + level for one, level in zip(same, (-2.0, 1.0, 0.0, 2.0, -1.0))]
    >>> found, stands = apart(other)
    >>> round(found, 1), stands.round(1).tolist()
    (7.5, [-2.1, 1.0, -0.0, 2.0, -0.9])
    """
    found = [noise(one) for one in logs]
    good = np.array([one.rows >= FIRST for one in found])
    means = np.array([one.mean for one in found])[good]
    count, stands = len(means), np.zeros(len(logs))
    if count < 2:
        return 0.0, stands
    own = [one for one, known in zip(found, good, strict=True) if known]
    variance = np.array([one.sigma**2 * one.memory / one.rows for one in own])
    if not variance.all():
        return 0.0, stands
    common = float((means / variance).sum() / (1.0 / variance).sum())
    between = float(np.var(means, ddof=1)) - float(variance.mean())
    if between <= 0.0 or ((means - common) ** 2 / variance).sum() < chdtri(count - 1, _ALIKE):
        return 0.0, stands
    stands[good] = means - means.mean()
    wider = -float(stdtrit(count - 1, _BEYOND)) / UNKNOWN
    return wider * math.sqrt(between * (1.0 + 1.0 / count)), stands
