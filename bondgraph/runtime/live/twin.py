"""The virtual machine that gets the commands of the monitored one and shows what it should do."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from bondgraph.ir.causal import CausalGraph
from bondgraph.ir.equation_system import EquationSystem
from bondgraph.runtime.live.fed import Fed
from bondgraph.runtime.log import Array
from bondgraph.runtime.simulation.instruments import Readings
from bondgraph.runtime.simulation.scenario import Fault, Scenario
from bondgraph.runtime.simulation.stepping import Stepper

_WINDOW = 2048  # samples for which noise is drawn together
_LONGEST = 5.0  # s without samples that it goes on through; after more it waits where it is


class Twin:
    """One virtual machine in step with the samples of another.

    It has the nominal parameters, instruments with noise of their own (another seed than the
    scenario's), and only those faults that are injected. Nothing of what it does depends on what
    the monitored machine reads, only on what that one is told.
    """

    def __init__(self, system: EquationSystem, integral: CausalGraph, scenario: Scenario) -> None:
        own = scenario._replace(spread="none", seed=scenario.seed + 1_000_003, faults=())
        self._scenario = own
        self._graph = system.graph
        self.stepper = Stepper(system, integral, own)
        self.fed = Fed(system.graph, own, self.stepper.values)
        self.restart()

    def restart(self) -> None:
        """Begin anew, with all well."""
        self.stepper.restart()
        self.fed.clear()
        self.fed.restart()
        self._readings = Readings(self._graph, self._scenario, self.stepper.values, _WINDOW)
        self._at = self._readings.size  # of the window
        self._started = False

    @property
    def time(self) -> float:
        """Where it stands, in s."""
        return self.stepper.time

    @property
    def sensors(self) -> frozenset[str]:
        """The names of its sensors."""
        return self._readings.names

    def inject(self, fault: Fault) -> None:
        """Something goes wrong with it from now on; `at` and `until` count from now, in s."""
        now = self.time
        self.fed.inject(fault._replace(at=now + fault.at, until=now + fault.until))

    def clear(self) -> None:
        """All is well again; storages keep what they hold."""
        self.fed.clear()

    def advance(
        self, time: Array, told: Mapping[str, Array]
    ) -> tuple[list[dict[str, float]], dict[str, Array]]:
        """Go on to further samples of the monitored one: what is true there, and what is read.

        Times in s, (n,), ascending; `told` by name, (n,). Raises what `Stepper.advance` raises.
        """
        start = float(time[0])
        if not self._started or not 0.0 < start - self.time <= _LONGEST:
            self.stepper.jump(start)
            self.fed.restart()
            self._started = True
        rows: list[dict[str, float]] = []
        read: dict[str, list[Array]] = {}
        for b in self.fed.feed(time, told):
            done = len(rows)
            last = max(done, int(np.searchsorted(time, b, side="right")))
            self._stick()
            if b > self.time:
                rows += self.stepper.advance(self.fed, b, time[done:last])
            elif last > done:  # the very first sample: nothing has moved yet
                rows += [self.stepper.look(self.fed)] * (last - done)
            self._read(time[done:last], rows[done:last], read)
        return rows, {n: np.concatenate(parts) for n, parts in read.items()}

    def _stick(self) -> None:
        """What is stuck from now on keeps what it has now."""
        names = self.fed.sticking()
        if not names:
            return
        now = self.stepper.look(self.fed)
        values = {v.name: v.symbol for v in self._graph.values}
        for name in names:
            wrong = self.fed.wrong[name]
            if name in self._readings.names:
                gain, bias = wrong.at(self.time)
                healthy = (now[name] - bias) / gain if gain else 0.0
            elif name in values:
                healthy = self.stepper.values.number(values[name])
            else:
                healthy = self.fed.told(name, self.time)
            wrong.hold(self.time, healthy)

    def _read(
        self, time: Array, rows: list[dict[str, float]], read: dict[str, list[Array]]
    ) -> None:
        """What the instruments make of some samples, window after window."""
        start = 0
        while start < len(time):
            if self._at == self._readings.size:
                self._readings.renew()
                self._at = 0
            stop = min(len(time), start + self._readings.size - self._at)
            found = self._readings.all(self._at, time[start:stop], rows[start:stop], self.fed.wrong)
            for name, column in found.items():
                read.setdefault(name, []).append(column)
            self._at += stop - start
            start = stop
