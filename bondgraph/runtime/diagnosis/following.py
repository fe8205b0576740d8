"""Which commands follow what a sensor shows, as a controller does that reads it."""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import cached_property

import numpy as np

from bondgraph.runtime.log import Array

_SIDE = 2  # samples by which one may be behind the other
_FOLLOWS = 0.5  # correlation from which on two do the same
_MADE = 0.5  # share of what a sensor shows that a command in the very sample makes, if it does


class Following:
    """Of `count` signals, by their numbers, in one row after the other.

    `passed_on` says what relations make of a sample (see `input_moves.passed_on`).
    """

    def __init__(self, count: int, passed_on: Callable[[Array, Array], Array] | None) -> None:
        self._passed_on = passed_on
        self.row(np.zeros((1, count)), np.zeros(count), np.zeros(count))

    def row(self, error: Array, sample: Array, sizes: Array) -> None:
        """The next row: by how much its samples are off what their neighbours let expect.

        With one sample of all that the program is told, and the sizes of the signals.
        """
        self._error, self._sample, self._sizes = error, sample, sizes
        vars(self).pop("passes", None)

    @cached_property
    def passes(self) -> Array:
        """How far signals go in a sample for a unit of another one, as relations say."""
        if self._passed_on is None:
            return np.full(2 * (self._error.shape[1],), math.inf)
        return self._passed_on(self._sample, self._sizes)

    def leads(self, sensor: int, command: int) -> bool:
        """Whether a command does what a sensor has shown some samples before.

        What a sensor shows of a machine that is driven comes with the command, or behind it. With
        it comes no more than relations say that it makes: a controller may answer at once.
        """
        later = self.later(sensor, command)
        if later != 0:
            return later > 0
        one, other = np.sqrt(np.square(self._error[:, [sensor, command]]).mean(axis=0))
        return bool(self.passes[sensor, command] * other < _MADE * one)

    def later(self, sensor: int, command: int) -> float:
        """Samples after which a command does what a sensor has shown, NaN if it does not."""
        one, other = self._error[:, sensor], self._error[:, command]
        size = math.sqrt(float(one @ one) * float(other @ other))
        along = [abs(float(one[: len(one) - max(lag, 0)][max(-lag, 0) :]
                           @ other[max(lag, 0) :][: len(other) - max(-lag, 0)]))
                 for lag in range(-_SIDE, _SIDE + 1)]  # fmt: skip
        best = int(np.argmax(along))
        return best - _SIDE if along[best] > _FOLLOWS * size else math.nan
