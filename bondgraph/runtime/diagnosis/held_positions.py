"""What a switch or a command does to residuals that is held at a position: it stays there."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence

import numpy as np

from bondgraph.runtime.diagnosis.hypotheses import Bank, Hypothesis, Stuck, summed
from bondgraph.runtime.log import Array, Mask
from bondgraph.runtime.monitoring.engine import Engine

_ROUGHLY = 3.0  # times: how well it is known how loud one residual is beside another


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


class Loudness:
    """How loud noise of sensors makes residuals in the positions of a switch.

    What a residual is in one position may have another unit than what it is in the other. White
    noise of the usual size of each offset among the `hypotheses` passes the program at the last of
    some samples (n, signals): the root of the sum of squares of its answers to an impulse.
    """

    def __init__(
        self, engine: Engine, hypotheses: Sequence[Hypothesis], nominal: Mapping[str, float],
        samples: Array,
    ) -> None:  # fmt: skip
        self._engine, self._nominal = engine, nominal
        self._place = {k.path: at for at, k in enumerate(engine.signals)}
        read = {k.path for k in engine.signals if k.kind == "sensor" and k.counts is None}
        self._noisy = [h for h in hypotheses if h.kind == "offset" and h.fault in read]
        last = samples[-1] if len(samples) else np.zeros(len(self._place))
        self._sample = np.nan_to_num(last)
        self._known: dict[str, Array] = {}  # with the switch off and on, (2, residuals)

    def beside(self, held: Stuck) -> Array:
        """How many times as loud residuals surely are where a switch is `held` as where it is told.

        That is a factor of `_ROUGHLY` less than what is found, to either side. One where that is
        not known, and for a command that stays: it is near what is told.
        """
        if held.stays:
            return np.ones(len(self._engine.residuals))
        if held.signal not in self._known:
            self._known[held.signal] = np.array([self._at(held.signal, x) for x in (0.0, 1.0)])
        here = int(held.position != 0.0)
        own, other = self._known[held.signal][[here, 1 - here]]
        times = np.divide(own, other, out=np.ones_like(own), where=(own > 0.0) & (other > 0.0))
        return np.asarray(np.clip(1.0, times / _ROUGHLY, times * _ROUGHLY))

    def _at(self, signal: str, position: float) -> Array:
        count = 2 * math.ceil(self._engine.warm_up / self._engine.sample_time) + 2
        still = np.repeat(self._sample[None], count, axis=0)
        still[:, self._place[signal]] = position
        at_rest = self._engine.configured(bounds=False)
        at_rest.run(still)
        steps = Bank(at_rest, self._noisy, self._nominal).run(still)
        answers = np.diff(steps, axis=0, prepend=np.zeros_like(steps[:1]))
        answers *= np.array([h.usual for h in self._noisy])[:, None]
        return np.asarray(np.sqrt(np.square(np.nan_to_num(answers)).sum(axis=(0, 1))))


class Instead:
    """The residuals of a machine in which a position is `held`: told that, they should be quiet.

    The programs of the `bank` on the same samples with the position in place of what is told, from
    the moment at which it begins, beside `as_told`, a bank of the same hypotheses. Where something
    else is told residuals are so much `louder` in the position.
    """

    def __init__(self, bank: Bank, as_told: Bank, held: Stuck, louder: Array) -> None:
        self._bank, self._as_told, self.held, self._louder = bank, as_told, held, louder
        place = {k.path: at for at, k in enumerate(bank.engine.signals)}
        self._at, self._modes = place[held.signal], [place[m] for m in held.modes]
        self._moved = np.zeros(len(bank.engine.residuals), dtype=np.bool_)

    def rows(
        self, samples: Array, ends: Sequence[int], lengths: Sequence[int]
    ) -> tuple[Array, Array, Mask, Array]:
        """By how much it moves residuals, and their slopes, beside what was told.

        At the ends of rows and in averages over them (see `Bank.rows`), both (rows, 1 + slopes,
        residuals); which are valid at the ends, and how many times as loud as they were told.
        Residuals that the position cannot have moved in the modes that were told so far are to be
        judged as they were told: they should be quiet as well.
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
        apart = (samples[at, self._at] != self.held.position)[:, None]
        louder = np.where(moved[at] & apart, self._louder, 1.0)
        # of another unit, what parameters within their tolerances do as it is told is none of it
        as_told = np.where(louder == 1.0, 1.0, 0.0)[:, None]
        slopes = [np.where(moved[at][:, None], a - as_told * b, 0.0)
                  for a, b in zip(*both, strict=True)]  # fmt: skip
        last, means = (np.concatenate([one[:, None], by], axis=1)
                       for one, by in zip(values, slopes, strict=True))  # fmt: skip
        return last, means, other.valid[at] | ~moved[at], louder
