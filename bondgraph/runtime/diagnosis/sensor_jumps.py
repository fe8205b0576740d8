"""How far out of all that a signal has done is no chance, and which of its steps are: jumps."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from bondgraph.runtime.log import Array

ENOUGH = 200  # samples of a signal to know it by
OUT = 2.0  # times as far out as any sample, or row, was while all was well


def far_out(samples: npt.ArrayLike) -> Array:
    """Times as far out as any of so many samples was: the fewer there are, the farther.

    A road is rougher in one second than in the last. Twice as far as the most of very many samples,
    four times as far as that of `ENOUGH`.
    """
    return np.asarray(OUT * (1.0 + np.sqrt(ENOUGH / np.maximum(samples, ENOUGH))))


class Jumps:
    """Which steps from sample to sample are jumps: far larger than the one before, and than ever.

    What moves in straight lines between samples has steps like the one before, noise has them as
    large as ever. A jump is as far above all that was none as a spike has to be.

    >>> at = np.arange(400.0)
    >>> signal = np.sin(0.1 * at) + 5.0 * (at >= 300)
    >>> jumps = Jumps(1).run(np.diff(signal, prepend=0.0)[:, None])
    >>> np.flatnonzero(jumps).tolist(), round(float(jumps[300, 0]), 1)
    ([300], 5.0)
    """

    def __init__(self, count: int) -> None:
        self._step = np.zeros(count)  # the last one
        self._most = np.zeros(count)  # that one was more than the one before, and no jump
        self._samples = 0

    def run(self, steps: Array) -> Array:
        """How much of further steps (n, signals) is a jump, n being one or more.

        To or from what is no number is no step.
        """
        steps = np.where(np.isfinite(steps), steps, 0.0)
        sizes = np.abs(np.concatenate([self._step[None], steps]))
        more = np.maximum(sizes[1:] - sizes[:-1], 0.0)
        number = (self._samples + np.arange(len(steps)))[:, None]
        times, jump = far_out(number), np.zeros(steps.shape, dtype=np.bool_)
        while True:
            usual = np.concatenate([self._most[None], np.where(jump, 0.0, more)])
            most = np.maximum.accumulate(usual, axis=0)
            known = (most[:-1] > 0.0) & (number >= ENOUGH) & ~jump
            found = known & (more > times * most[:-1])
            if not found.any():
                break
            jump |= found & (np.cumsum(found, axis=0) == 1)  # those behind are looked at again
        self._step, self._most = steps[-1], most[-1]
        self._samples += len(steps)
        return np.where(jump, np.sign(steps) * more, 0.0)
