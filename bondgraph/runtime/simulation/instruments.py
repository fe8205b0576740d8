"""What instruments make of true values: noise, resolution, counts, their own rate."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from bondgraph.runtime.log import Array
from bondgraph.runtime.simulation.scenario import Instrument


class Reader:
    """Reads one sensor at the samples of a run, the same whoever asks and in whatever order.

    An encoder (`counts` a turn) gives whole counts; where its first count stands within a count is
    drawn at random, as that of a real one is.
    """

    def __init__(
        self, instrument: Instrument, counts: float | None, samples: int, rate: float, seed: Any
    ) -> None:
        self._draw = np.random.default_rng(seed)
        self.instrument = instrument
        self.counts = counts
        self._noise = self._draw.standard_normal(samples) * instrument.noise
        self._phase = float(self._draw.uniform())
        own = instrument.rate
        self._every = 1 if own is None or own >= rate else round(min(rate / own, samples))

    def renew(self) -> None:
        """Noise for as many samples more, which are counted from 0 again."""
        self._noise = self._draw.standard_normal(len(self._noise)) * self.instrument.noise

    def freeze(self, first: int, last: int) -> None:
        """From sample `first` to before `last` it shows noise no more: the sensor is stuck."""
        self._noise[first:last] = self._noise[max(first - 1, 0)]

    def own_sample(self, k: int) -> int:
        """The sample whose value is shown at sample k: earlier for a slow instrument."""
        return k - k % self._every

    def read(self, k: int, value: float) -> float:
        """What is read of a true value at sample k."""
        value += self.instrument.bias + self._noise[k]
        if self.counts is not None:
            return float(math.floor(value * self.counts / (2 * math.pi) + self._phase))
        step = self.instrument.step
        return round(value / step) * step if step else value

    def all(self, values: Array) -> Array:
        """What is read at all samples; `values` are the true ones."""
        n = len(values)
        seen = values + self.instrument.bias + self._noise[:n]
        if self.counts is not None:
            seen = np.floor(seen * self.counts / (2 * math.pi) + self._phase)
        elif self.instrument.step:
            seen = np.round(seen / self.instrument.step) * self.instrument.step
        k = np.arange(n)
        return np.asarray(seen[k - k % self._every], dtype=float)
