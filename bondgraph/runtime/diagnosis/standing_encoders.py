"""Encoders that stand still while others that see the same motion go on.

What an encoder makes of a motion once it sticks is arbitrary: it is off by all that the machine
does from then on, and no gain or offset of what it reads is that. But its count says so itself.
"""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Collection, Mapping, Sequence
from typing import Any

import numpy as np

from bondgraph.runtime.log import Array
from bondgraph.runtime.monitoring.plain import array, numbers
from bondgraph.text.tuples import NamedTuple

_COUNTS = 10.0  # that one would have gone on by, and does not
_LOOSE = 10.0  # times what it was ever off in a row: a shaft that is held is twisted by some times
_TIED = 0.99  # of what one does in a row follows from what the other one does, in squares
_ROWS = 20  # from which that is known
_LATE = 5  # rows before an alarm that may have been faulty already
_SLOW = 50.0  # times as long as that takes at the usual speed: who was at rest may go on alone


class Standing(NamedTuple):
    """An encoder has had its count for so many samples, while an `other` one went on."""

    samples: int
    other: str


class StandingEncoders:
    """Looks at the counts row by row; `encoders` are the columns that they have in the samples.

    Which of them see the same motion, and how far they are off while shafts give way, is known from
    the healthy machine. One stands still if all that are tied to it have gone on by more than that.
    Who rests on a machine that rests, or that is held, does not.
    """

    def __init__(self, encoders: Mapping[str, int]) -> None:
        self.names, self._at = tuple(encoders), list(encoders.values())
        count = len(self.names)
        self._samples = self._rows = 0.0  # while all was well
        self._gone = np.zeros(count)  # counts in that time, forth and back
        self._products = np.zeros((count, count))  # of what two have come to in rows, added up
        self._off = np.zeros((count, count))  # of the first, beside what the second lets expect
        self._calm: deque[Array] = deque()  # steps of rows that are learned from when more are well
        #: Those that have stood still since there are suspects: what was not counted is lost.
        self.stood: set[str] = set()
        self.restart()

    def restart(self) -> None:
        """The samples begin anew."""
        count = len(self.names)
        self._last = np.full(count, math.nan)
        self._run = np.zeros(count)  # samples for which each has had its count
        self._from = np.full((count, count), math.nan)  # counts of all where each has stopped
        #: Samples after which each of all was so far from there that both should have gone on.
        self._after = np.full((count, count), math.inf)

    def row(self, samples: Array, healthy: bool, among: Collection[str]) -> dict[str, Standing]:
        """Which of some encoders stand still, after further (n, all signals) samples."""
        own = samples[:, self._at]
        steps = np.diff(np.concatenate([self._last[None], own]), axis=0)
        self._last = own[-1]
        self._calm.append(np.nan_to_num(steps))
        if not healthy:
            self._calm.clear()
        elif len(self._calm) > _LATE:
            self._learn(self._calm.popleft())
        moved = steps[::-1] != 0.0  # or unknown; the last sample first
        ran = np.where(moved.any(axis=0), moved.argmax(axis=0), len(own))
        needed = self._needed() if ran.any() else None
        for k, samples_ago in enumerate(ran.tolist()):
            since, before = own, self._run[k] + 1.0
            if samples_ago < len(own):
                since, before = own[len(own) - 1 - samples_ago :], 0.0
                self._from[k], self._after[k] = since[0], math.inf
            if needed is not None and samples_ago:
                far = np.abs(since - self._from[k]) >= needed[k]
                late = np.where(far.any(axis=0), before + far.argmax(axis=0), math.inf)
                self._after[k] = np.minimum(self._after[k], late)
            self._run[k] = before + len(since) - 1.0
        found = {} if needed is None or not among else self._found(among, needed)
        self.stood = {*self.stood.intersection(among), *found}
        return found

    def _learn(self, steps: Array) -> None:
        self._gone += np.abs(steps).sum(axis=0)
        self._samples += len(steps)
        net = steps.sum(axis=0)
        self._rows += 1.0
        self._products += np.outer(net, net)
        if self._rows > _ROWS:
            self._off = np.maximum(self._off, np.abs(net[:, None] - self._slopes() * net))

    def _slopes(self) -> Array:
        """Counts of the first for one of the second."""
        return self._products / np.maximum(np.diag(self._products), 1.0)

    def _needed(self) -> Array:
        """Counts of the second by which the first would have gone on by more than it may be off."""
        slopes = np.abs(self._slopes())
        wanted = np.maximum(_COUNTS, _LOOSE * self._off)
        needed = np.divide(wanted, slopes, out=np.full_like(slopes, math.inf), where=slopes > 0.0)
        return np.maximum(needed, _COUNTS)

    def _found(self, among: Collection[str], needed: Array) -> dict[str, Standing]:
        squares = np.diag(self._products)
        tied = np.square(self._products) > _TIED * np.outer(squares, squares)
        np.fill_diagonal(tied, False)
        found: dict[str, Standing] = {}
        for k, name in enumerate(self.names):
            others = np.flatnonzero(tied[k])
            if name not in among or self._rows <= _ROWS or not len(others):
                continue
            usual = self._gone[others] / self._samples
            if (self._after[k, others] * usual <= _SLOW * needed[k, others]).all():
                other = others[np.argmin(self._after[k, others])]
                found[name] = Standing(int(self._run[k]), self.names[other])
        return found

    def state(self) -> list[Any]:
        """What is known of the healthy machine, as plain JSON."""
        tables = [numbers(x) for x in (self._gone, self._products, self._off)]
        return [*tables, self._samples, self._rows]

    def resume(self, state: Sequence[Any]) -> None:
        """Go on from a state; raises TypeError or ValueError for one of another kind."""
        gone, products, off, samples, rows = state
        self._gone = array(gone, self._gone.shape)
        self._products = array(products, self._products.shape)
        self._off = array(off, self._off.shape)
        self._samples, self._rows = float(samples), float(rows)
