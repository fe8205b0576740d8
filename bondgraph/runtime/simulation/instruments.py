"""What instruments make of true values: noise, resolution, counts, their own rate.

`Reader` is one sensor, `Readings` are all of a machine that runs without an end.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from bondgraph.ir.expr import symbols
from bondgraph.ir.graph import BondGraph
from bondgraph.runtime.log import Array
from bondgraph.runtime.simulation.faults import Wrong
from bondgraph.runtime.simulation.parameters import Values
from bondgraph.runtime.simulation.scenario import Course, Instrument, Scenario


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
        self._error = self._drawn(samples)  # that is added at each sample
        self._phase = float(self._draw.uniform())
        own = instrument.rate
        self._every = 1 if own is None or own >= rate else round(min(rate / own, samples))

    def renew(self) -> None:
        """Noise for as many samples more, which are counted from 0 again."""
        self._error = self._drawn(len(self._error))

    def _drawn(self, samples: int) -> Array:
        noise = self._draw.standard_normal(samples) * self.instrument.noise
        return np.asarray(noise + self.instrument.bias)

    def passed_on(self, times: Array) -> Course:
        """Noise and bias at the samples, in straight lines between them, for a law that gets them.

        The true value has them from now on, so that they are not added when it is read.
        """
        own = slice(None, None, self._every)
        told = zip(times[own].tolist(), self._error[own].tolist(), strict=False)
        self._error = np.zeros(len(self._error))
        return Course(None, tuple(told))

    def freeze(self, first: int, last: int) -> None:
        """From sample `first` to before `last` it shows noise no more: the sensor is stuck."""
        self._error[first:last] = self._error[max(first - 1, 0)]

    @property
    def errs(self) -> bool:
        """Whether it adds noise or a bias."""
        return bool(self.instrument.noise or self.instrument.bias)

    @property
    def unit(self) -> float:
        """How much one of what is read is, in the unit of the sensor: a count in rad, else 1."""
        return 1.0 if self.counts is None else 2 * math.pi / self.counts

    def own_sample(self, k: int) -> int:
        """The sample whose value is shown at sample k: earlier for a slow instrument."""
        return k - k % self._every

    def read(self, k: int, value: float) -> float:
        """What is read of a true value at sample k."""
        value += self._error[k]
        if self.counts is not None:
            return float(math.floor(value * self.counts / (2 * math.pi) + self._phase))
        step = self.instrument.step
        return round(value / step) * step if step else value

    def all(self, values: Array) -> Array:
        """What is read at all samples; `values` are the true ones."""
        n = len(values)
        seen = values + self._error[:n]
        if self.counts is not None:
            seen = np.floor(seen * self.counts / (2 * math.pi) + self._phase)
        elif self.instrument.step:
            seen = np.round(seen / self.instrument.step) * self.instrument.step
        k = np.arange(n)
        return np.asarray(seen[k - k % self._every], dtype=float)


def readers(
    graph: BondGraph, scenario: Scenario, values: Values, samples: int
) -> dict[str, Reader]:
    """The instruments of a scenario for so many samples, by name of the sensor."""
    found = {}
    for k, sensor in enumerate(s for s in graph.sensors if s.same_as is None):
        counts = None if sensor.counts is None else values.number(sensor.counts)
        instrument = scenario.instruments.get(sensor.name, Instrument())
        seed = [scenario.seed, 2, k]
        found[sensor.name] = Reader(instrument, counts, samples, scenario.sampling.rate, seed)
    return found


def obeyed(graph: BondGraph) -> frozenset[str]:
    """The sensors that a law, an integral or another sensor reads, those that count aside.

    They act on the machine with what their instruments add.
    """
    read = [law.zero for node in graph.nodes for law in node.laws]
    read += [i.integrand for i in graph.integrals] + [s.reads for s in graph.sensors]
    used = {*symbols(*read)}
    names = {s.name for symbol, s in graph.readings.items() if symbol in used}
    names |= {i.of for i in graph.inputs if i.of}
    return frozenset(names - {s.name for s in graph.sensors if s.counts is not None})


def passed_on(graph: BondGraph, readers: Mapping[str, Reader], times: Array) -> dict[str, Course]:
    """What instruments add to the readings that laws obey (`Reader.passed_on`), by sensor."""
    heard = obeyed(graph)
    return {n: r.passed_on(times) for n, r in readers.items() if n in heard and r.errs}


class Readings:
    """The instruments of a scenario, window after window of `size` samples (at least `least`).

    The noise of a window is drawn when it begins (`renew`); the counts of an encoder go on.
    """

    def __init__(self, graph: BondGraph, scenario: Scenario, values: Values, least: int) -> None:
        self.sensors = tuple(s for s in graph.sensors if s.same_as is None)
        self.names = frozenset(s.name for s in self.sensors)
        rates = [scenario.instruments.get(s.name, Instrument()).rate for s in self.sensors]
        step = math.lcm(*(max(1, round(scenario.sampling.rate / r)) for r in rates if r))
        self.size = -(-least // step) * step  # a slow instrument begins with the window
        self._readers = readers(graph, scenario, values, self.size)
        self._graph = graph
        self._own: dict[str, float] = {}  # what a slow instrument took last
        self._shown: dict[str, float] = {}
        self._fresh = True

    def renew(self) -> None:
        """The next window begins."""
        if not self._fresh:
            for reader in self._readers.values():
                reader.renew()
        self._fresh = False

    def passed_on(self, times: Array) -> dict[str, Course]:
        """What instruments add in this window to the readings that laws obey, by sensor."""
        return passed_on(self._graph, self._readers, times)

    def unit(self, name: str) -> float:
        """See `Reader.unit`."""
        return self._readers[name].unit

    def read(self, name: str, k: int, true: float) -> float:
        """What one sensor reads at sample k of the window."""
        reader = self._readers[name]
        own = reader.own_sample(k)
        if own < k and name in self._own:
            true = self._own[name]
        return reader.read(own, true)

    def all(
        self,
        first: int,
        times: Array,
        rows: Sequence[Mapping[str, float]],
        wrong: Mapping[str, Wrong],
    ) -> dict[str, Array]:
        """What each sensor reads at samples of the window from `first` on; NaN: no sample.

        `rows` are the true values by name; one that is stuck shows what it showed last.
        """
        found: dict[str, Array] = {}
        for name, reader in self._readers.items():
            column = np.empty(len(times))
            faulty = wrong.get(name)
            for k, (t, row) in enumerate(zip(times.tolist(), rows, strict=True), first):
                true = row.get(name, math.nan)
                if reader.own_sample(k) == k:
                    self._own[name] = true
                if faulty is not None and faulty.missing(t):
                    column[k - first] = math.nan
                    continue
                if not (faulty is not None and faulty.stuck(t) and name in self._shown):
                    self._shown[name] = self.read(name, k, true) if true == true else math.nan
                column[k - first] = self._shown[name]
            found[name] = column
        return found
