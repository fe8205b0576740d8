"""The noise that residuals share, as they read the same sensors: how they are correlated in rows.

What two residuals read of one noisy sensor says the same twice, and what is left of one beside the
other says more than either: the balance of heat of a tank that is drained is as noisy as its
balance of water, and beside that a tenth of the noise is left.
"""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Mapping
from typing import Any

import numpy as np
import numpy.typing as npt

from bondgraph.runtime.diagnosis.row_averages import LAGS
from bondgraph.runtime.diagnosis.rows import Row
from bondgraph.runtime.diagnosis.tuning import Limit
from bondgraph.runtime.log import Array, Mask
from bondgraph.runtime.monitoring.plain import array
from bondgraph.text.tuples import NamedTuple

_SURE = 2.0  # deviations by which a correlation is taken for less than rows show
_MEMORY = 1.5  # differences of independent rows that tell as much as one: neighbours share a row
_FAR = 4.0  # deviations that a difference counts for at most
_ALIKE = 0.1  # of its deviation: the least noise of a residual beside all others
_MOST = 24  # residuals of a group, at most, whose noise is taken as shared


class SharedNoise:
    """Learns how the noise of residuals is correlated from rows of a machine that is well.

    By what neighbouring rows differ by, of last samples and of sums (see `Lasting`): where
    residuals stand, and how that wanders, is no noise that they share. Rows are `apart` (s).
    """

    def __init__(self, residuals: int, apart: float) -> None:
        shape, self._apart = (2, residuals, residuals), apart
        self._products, self._squares = np.zeros(shape), np.zeros(shape)
        self._count = np.zeros(shape)
        self._found: Array | None = None
        self.restart()

    def restart(self) -> None:
        """The residuals begin anew."""
        self._means: deque[Array] = deque(maxlen=LAGS + 1)
        self._last: tuple[float, Array] | None = None

    def add(self, row: Row, limits: Array) -> None:
        """One more healthy row, less what is expected, with the limits of its residuals."""
        if self._last is not None and abs(row.time - self._last[0] - self._apart) > self._apart / 2:
            self.restart()
        limit, own = Limit(*limits.T), row.average
        none = np.full(len(limits), math.nan)
        sigma = np.where(np.isfinite(limit.sigma), limit.sigma, none)
        self._means.append(none if own is None else np.where(own.valid, own.value, math.nan))
        now = np.stack([np.where(row.valid, row.value, math.nan) / sigma, none])
        if len(self._means) == LAGS + 1:
            weights = np.stack([limit.before4, limit.before3, limit.before2, limit.before1])
            added = self._means[-1] + (weights * np.array(self._means)[:-1]).sum(axis=0)
            now[1] = added / np.where(limit.unit > 0.0, limit.unit, math.nan)
        if self._last is not None:
            self._take(now - self._last[1])
        self._last = row.time, now

    def _take(self, steps: Array) -> None:
        known = np.isfinite(steps)
        steps = np.where(known, np.clip(steps, -_FAR, _FAR), 0.0)
        both = known[:, :, None] & known[:, None, :]
        self._products += steps[:, :, None] * steps[:, None, :]
        self._squares += both * np.square(steps)[:, :, None]
        self._count += both
        self._found = None

    def correlations(self) -> Array:
        """Of last samples and of sums, (2, residuals, residuals), as far as they are sure.

        By the lower end of what rows leave open (Fisher, 1915), so that few of them tell of none.
        """
        if self._found is None:
            shown = self._shown()
            size = np.arctanh(np.minimum(np.abs(shown), 1.0 - 1e-9))
            size -= _SURE / np.sqrt(np.maximum(self._count / _MEMORY - 3.0, 1e-9))
            found = np.copysign(np.tanh(np.maximum(size, 0.0)), shown)
            self._found = np.stack([_possible(one) for one in found])
        return self._found

    def _shown(self) -> Array:
        squares = self._squares * self._squares.transpose(0, 2, 1)
        return np.asarray(self._products / np.sqrt(np.where(squares > 0.0, squares, 1.0)))

    def state(self) -> dict[str, Any]:
        """What rows have told, as plain JSON: how many they were, and which pairs they showed."""
        sure, shown = self.correlations(), self._shown()
        pairs = [[*at, round(float(shown[*at]), 4)]
                 for at in np.argwhere(np.triu(sure, 1)).tolist()]  # fmt: skip
        return {"rows": self._count.max(axis=(1, 2), initial=0.0).tolist(), "pairs": pairs}

    def resume(self, state: Mapping[str, Any]) -> None:
        """Go on from a state; raises KeyError, TypeError or ValueError for one of another kind."""
        rows = array(state["rows"], (2,))[:, None, None]
        shown = np.zeros(self._products.shape) + np.eye(self._products.shape[1])
        pairs = array(state["pairs"], (len(state["pairs"]), 4))
        at, value = pairs[:, :3].astype(int).T, pairs[:, 3]
        least, most = at.min(axis=1, initial=0), at.max(axis=1, initial=0)
        if (least < 0).any() or (most >= np.array(shown.shape)).any() or (abs(value) > 1.0).any():
            raise ValueError("there are no such residuals, or what they share is more than all")
        shown[*at] = shown[at[0], at[2], at[1]] = value
        self._count, self._squares = (np.zeros(shown.shape) + rows for _ in range(2))
        self._products, self._found = shown * rows, None
        self.restart()


def _possible(shown: Array) -> Array:
    """Correlations that noise can have, each residual with some of its own.

    Of what would be too many residuals the weakest correlations count as none.
    """
    found, least = shown.copy(), 0.0
    np.fill_diagonal(found, 1.0)
    while max(map(len, groups(found)), default=0) > _MOST:
        least += 0.1
        found[np.abs(found) < least] = 0.0
    less = _ALIKE**2 - float(np.linalg.eigvalsh(found)[0]) if len(found) else 0.0
    if less > 0.0:
        found /= 1.0 + less / (1.0 - _ALIKE**2)
        np.fill_diagonal(found, 1.0)
    return found


def groups(correlations: Array) -> list[npt.NDArray[np.intp]]:
    """The numbers of residuals that share noise, with each other or with one between them.

    >>> table = np.eye(4)
    >>> table[0, 2] = table[2, 0] = 0.5
    >>> [own.tolist() for own in groups(table)]
    [[0, 2]]
    """
    from scipy.sparse.csgraph import connected_components

    _, label = connected_components(correlations != 0.0, directed=False)
    sizes = np.bincount(label) if len(label) else np.empty(0)
    return [np.flatnonzero(label == k) for k in np.flatnonzero(sizes > 1).tolist()]


class Shared(NamedTuple):
    """Of rows that are compared: the variance of their noise, which of them tell by sums, both
    (rows, residuals), and the correlations of either, (2, residuals, residuals)."""

    noise: Array
    sums: Mask
    correlations: Array

    def unroots(self, share: Array) -> list[tuple[npt.NDArray[np.intp], Array]]:
        """What whitens residuals of groups whose noise has such a share of their variance.

        Numbers of residuals, (n,), and a matrix for each row, (rows, n, n).
        """
        found = []
        sums = np.zeros(share.shape, dtype=bool)
        sums[len(share) - len(self.sums) :] = self.sums  # what stands before them is nothing
        for own in groups(np.abs(self.correlations).sum(axis=0)):
            last, added = self.correlations[:, own[:, None], own]
            mine = sums[:, own]
            kin = np.where(mine[:, :, None] & mine[:, None, :], added, 0.0)
            kin = np.where(mine[:, :, None] | mine[:, None, :], kin, last)
            root = np.sqrt(np.minimum(share[:, own], 1.0))
            kin = kin * root[:, :, None] * root[:, None, :]
            kin[:, range(len(own)), range(len(own))] = 1.0
            found.append((own, np.asarray(np.linalg.inv(np.linalg.cholesky(kin)))))
        return found
