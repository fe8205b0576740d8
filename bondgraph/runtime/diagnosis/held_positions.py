"""What a switch or a command does to residuals that is held at a position: it stays there."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from bondgraph.runtime.diagnosis.hypotheses import Bank, Stuck, summed
from bondgraph.runtime.log import Array, Mask


def staying(before: Array, since: Array) -> float:
    """Where a command was, (n,) samples before an onset and since, that is not followed any more.

    Where it moves at the onset it is where it was. Where it stands there nothing would show yet: it
    was not followed in its last step, on the way of which there may be a sample.

    >>> staying(np.array([1.0, 2.0, 3.0]), np.array([4.0, 5.0]))
    3.0
    >>> staying(np.array([1.0, 1.0, 2.4, math.nan, 3.0, 3.0]), np.array([3.0, 5.0]))
    1.0
    """
    before, since = before[np.isfinite(before)], since[np.isfinite(since)]
    if not len(before):
        return float(since[0]) if len(since) else math.nan
    others = np.flatnonzero(before != before[-1])
    if not len(others) or (len(since) and since[0] != before[-1]):
        return float(before[-1])
    return float(before[max(int(others[-1]) - 1, 0)])


class Instead:
    """The residuals of a machine in which a position is `held`: told that, they should be quiet.

    The programs of the `bank` on the same samples with the position in place of what is told, from
    the moment at which it begins, beside `as_told`, a bank of the same hypotheses.
    """

    def __init__(self, bank: Bank, as_told: Bank, held: Stuck) -> None:
        self._bank, self._as_told, self.held = bank, as_told, held
        place = {k.path: at for at, k in enumerate(bank.engine.signals)}
        self._at, self._modes = place[held.signal], [place[m] for m in held.modes]
        self._moved = np.zeros(len(bank.engine.residuals), dtype=np.bool_)

    def rows(
        self, samples: Array, ends: Sequence[int], lengths: Sequence[int]
    ) -> tuple[Array, Array, Mask]:
        """By how much it moves residuals, and their slopes, beside what was told.

        At the ends of rows and in averages over them (see `Bank.rows`), both (rows, 1 + slopes,
        residuals); and which are valid at the ends. Residuals that the position cannot have moved
        in the modes that were told so far are to be judged as they were told: they should be quiet
        as well.
        """
        told = samples.copy()
        told[:, self._at] = self.held.position
        both = [bank.rows(table, ends, lengths)
                for bank, table in ((self._bank, told), (self._as_told, samples))]  # fmt: skip
        other, own = self._bank.batch, self._as_told.batch
        assert other is not None and own is not None
        moved = np.zeros(other.valid.shape, dtype=np.bool_)
        if len(samples):
            moved = self.held.moved(samples[:, self._modes], self._bank.engine.residuals)
            moved[0] |= self._moved
            moved = np.logical_or.accumulate(moved, axis=0)
            self._moved = moved[-1]
        value = np.where(moved & other.valid & own.valid, other.value - own.value, 0.0)
        at = np.asarray(ends, dtype=np.intp)
        sums = summed(value[None], at)[0, : len(at)] if len(at) else value[:0]
        values = value[at], sums / np.asarray(lengths)[:, None]
        slopes = [np.where(moved[at][:, None], a - b, 0.0) for a, b in zip(*both, strict=True)]
        last, means = (np.concatenate([one[:, None], by], axis=1)
                       for one, by in zip(values, slopes, strict=True))  # fmt: skip
        return last, means, other.valid[at] | ~moved[at]
