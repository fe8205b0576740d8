"""What all sensors of a machine read while it runs, without an end."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence

import numpy as np

from bondgraph.ir.graph import BondGraph
from bondgraph.runtime.log import Array
from bondgraph.runtime.simulation.faults import Wrong
from bondgraph.runtime.simulation.instruments import Reader
from bondgraph.runtime.simulation.parameters import Values
from bondgraph.runtime.simulation.scenario import Instrument, Scenario


class Readings:
    """The instruments of a scenario, window after window of `size` samples (at least `least`).

    The noise of a window is drawn when it begins (`renew`); the counts of an encoder go on.
    """

    def __init__(self, graph: BondGraph, scenario: Scenario, values: Values, least: int) -> None:
        self.sensors = tuple(s for s in graph.sensors if s.same_as is None)
        self.names = frozenset(s.name for s in self.sensors)
        rate = scenario.sampling.rate
        instruments = {s.name: scenario.instruments.get(s.name, Instrument()) for s in self.sensors}
        slow = [max(1, round(rate / i.rate)) for i in instruments.values() if i.rate]
        step = math.lcm(*slow) if slow else 1
        self.size = -(-least // step) * step  # a slow instrument begins with the window
        self._readers = {
            s.name: Reader(
                instruments[s.name],
                None if s.counts is None else values.number(s.counts),
                self.size,
                rate,
                [scenario.seed, 2, k],
            )
            for k, s in enumerate(self.sensors)
        }
        self._own: dict[str, float] = {}  # what a slow instrument took last
        self._shown: dict[str, float] = {}
        self._fresh = True

    def renew(self) -> None:
        """The next window begins."""
        if not self._fresh:
            for reader in self._readers.values():
                reader.renew()
        self._fresh = False

    def unit(self, name: str) -> float:
        """How much one of what is read is, in the unit of the sensor: a count in rad, else 1."""
        counts = self._readers[name].counts
        return 1.0 if counts is None else 2 * math.pi / counts

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
