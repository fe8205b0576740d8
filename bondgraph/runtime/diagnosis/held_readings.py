"""Readings that are taken in one position of a switch and held in the other."""

from __future__ import annotations

import numpy as np

from bondgraph.runtime.diagnosis.rare_steps import sizes
from bondgraph.runtime.log import Array, Mask


class HeldReadings:
    """Which signals stand since a switch has turned: they have another value once it turns again.

    The load of an elevator is weighed while its brake is shut. A sensor that dies just when a
    switch turns looks the same until it turns again: that is for residuals to say. Each of the
    `signals` is compared with each of the `modes`: it stands since some samples before or behind a
    turn, no more than it may be `late`.

    >>> held = HeldReadings(2, 1, late=2)
    >>> on = np.array([[0.0], [0.0], [1.0], [1.0], [1.0], [1.0]])
    >>> held.row(on, np.array([9.0, 3.0])).tolist()
    [False, True]
    """

    def __init__(self, signals: int, modes: int, late: int) -> None:
        self._shape, self._late = (signals, modes), late
        self.restart()

    def restart(self) -> None:
        """The samples begin anew."""
        signals, modes = self._shape
        self.held: Mask = np.zeros(signals, dtype=np.bool_)
        self._last = np.empty((0, modes))
        self._ago = np.full(modes, np.inf)  # samples since each has turned, with that one

    def row(self, modes: Array, runs: Array) -> Mask:
        """Those that are held at the end of a row (n, modes), each the same for so many samples."""
        turns = sizes(np.concatenate([self._last, modes]))[len(self._last) :] > 0.0
        here = np.where(turns.any(axis=0), turns[::-1].argmax(axis=0) + 1.0, np.inf)
        self._ago = np.minimum(self._ago + len(modes), here)
        self._last = modes[-1:]
        since = np.abs(runs[:, None] - self._ago) <= self._late
        # what it was held for may come to it some samples late
        still = self.held & (self._ago <= self._late).any()
        self.held = np.asarray(since.any(axis=1) | still)
        return self.held
