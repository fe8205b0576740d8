"""A machine that never stops: a scenario run on and on, its samples given while it runs."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from bondgraph.ir.causal import CausalGraph
from bondgraph.ir.equation_system import EquationSystem
from bondgraph.runtime.log import Array, Log
from bondgraph.runtime.simulation.given import Given, inside
from bondgraph.runtime.simulation.instruments import Readings
from bondgraph.runtime.simulation.parameters import drawn, units
from bondgraph.runtime.simulation.scenario import Scenario
from bondgraph.runtime.simulation.stepping import Stepper

_WINDOW = 2048  # samples, at least, for which is looked ahead
_FLUSH = 0.02  # s of samples that are given together


class Robot:
    """A scenario without an end: what happens in it happens, and then it goes on.

    Everything is drawn from the seed of the scenario, as `simulate` does it, but not the same
    numbers.
    """

    def __init__(self, system: EquationSystem, integral: CausalGraph, scenario: Scenario) -> None:
        self.graph, self.scenario = system.graph, scenario
        values = drawn(self.graph, scenario)
        self.readings = Readings(self.graph, scenario, values, _WINDOW)
        self.rate = scenario.sampling.rate
        self.given = Given(self.graph, scenario, values, self._times(0))
        self.stepper = Stepper(system, integral, scenario, self.given)
        known = [i.name for i in self.graph.inputs if i.known]
        self._known = known
        self.meta = {"model": self.graph.name, "scenario": scenario.name,
                     "seed": str(scenario.seed)}  # fmt: skip
        counted = {s.name: "count" for s in self.readings.sensors if s.counts is not None}
        told = units(self.graph) | counted
        self.units = {n: told[n] for n in [*known, *(s.name for s in self.readings.sensors)]}

    def logs(self) -> Iterator[Log]:
        """The samples, a few at a time, for ever. Raises what `Stepper.advance` raises."""
        window = 0
        while True:
            times = self._times(window)
            self.given.times = times
            yield from self._window(window, times)
            window += 1

    def _times(self, window: int) -> Array:
        """The instants of one window of samples, and the first one of the next, in s."""
        size = self.readings.size
        sampling = self.scenario.sampling
        k = np.arange(window * size, (window + 1) * size + 1)
        times = k / sampling.rate
        if sampling.jitter:
            draw = np.random.default_rng([self.scenario.seed, 1, window])
            shift = draw.uniform(-0.5, 0.5, size) * sampling.jitter / sampling.rate
            shift[0] = 0.0
            times[:-1] += shift
        return np.asarray(times, dtype=float)

    def _window(self, window: int, times: Array) -> Iterator[Log]:
        self.readings.renew()
        start, end = float(times[0]), float(times[-1])
        stops = {t for t in self.given.stops(end) if start < t < end}
        stops |= {float(t) for t in times[:: max(1, round(_FLUSH * self.rate))] if t > start}
        kept = np.ones(self.readings.size, dtype=bool)
        if self.scenario.sampling.lost:
            draw = np.random.default_rng([self.scenario.seed, 3, window])
            kept = draw.uniform(size=len(kept)) >= self.scenario.sampling.lost
        done = 0
        for b in [*sorted(stops), end]:
            if b <= self.stepper.time:
                continue
            last = int(np.searchsorted(times[:-1], b))
            self._begin(done, b)
            wanted = times[done:last]
            rows = self.stepper.advance(b, wanted)
            log = self._log(done, wanted, rows)
            here = kept[done:last]
            done = last
            if here.any():
                columns = {n: c[here] for n, c in log.columns.items()}
                yield log._replace(time=log.time[here], columns=columns)

    def _begin(self, k: int, end: float) -> None:
        """At a jump, with sample k of the window: faults take hold, controllers read and decide."""
        t = inside(self.stepper.time, end)(self.stepper.time)
        self.given.hold(t, lambda: self.stepper.look(end))
        self.given.control(
            t,
            lambda: self.stepper.look(end),
            lambda name, true: self.readings.read(name, k, true) * self.readings.unit(name),
        )

    def _log(self, first: int, times: Array, rows: list[dict[str, float]]) -> Log:
        told = {n: np.array([self.given.told(n, t) for t in times.tolist()]) for n in self._known}
        wrong = self.given.wrong
        read = self.readings.all(first, times, rows, wrong)
        return Log(times, told | read, self.units, self.meta)
