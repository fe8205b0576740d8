"""A machine that never stops: a scenario run on and on, its samples given while it runs."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping

import numpy as np

from bondgraph.ir.causal import CausalGraph
from bondgraph.ir.equation_system import EquationSystem
from bondgraph.runtime.log import Array, Log
from bondgraph.runtime.simulation.given import Given
from bondgraph.runtime.simulation.instruments import Readings
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
        self.stepper = Stepper(system, integral, scenario)
        self.readings = Readings(self.graph, scenario, self.stepper.values, _WINDOW)
        self.rate = scenario.sampling.rate
        self.given = Given(self.graph, scenario, self.stepper.values, self._times(0))
        known = [i.name for i in self.graph.inputs if i.known]
        self._known = known
        self.meta = {"model": self.graph.name, "scenario": scenario.name,
                     "seed": str(scenario.seed)}  # fmt: skip
        counted = {s.name: "count" for s in self.readings.sensors if s.counts is not None}
        units = {i.name: i.unit or "" for i in self.graph.inputs}
        units |= {s.name: s.unit or "" for s in self.readings.sensors} | counted
        self.units = {n: units[n] for n in [*known, *(s.name for s in self.readings.sensors)]}

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
            self._begin(done)
            wanted = times[done:last]
            rows = self.stepper.advance(self.given, b, wanted)
            log = self._log(done, wanted, rows)
            here = kept[done:last]
            done = last
            if here.any():
                columns = {n: c[here] for n, c in log.columns.items()}
                yield log._replace(time=log.time[here], columns=columns)

    def _begin(self, k: int) -> None:
        """At the start of a segment: faults that stick take hold, controllers read and decide."""
        t, wrong = self.stepper.time, self.given.wrong
        sticking = [n for n, w in wrong.items() if any(f.op == "stuck" for f in w.faults)]
        due = [p for p in self.given.pids if _multiple(t, p.controller.period)]
        if not sticking and not due:
            return
        now = self.stepper.look(self.given)
        for name in sticking:
            wrong[name].hold(t, self._healthy(name, now, t))
        if sticking:
            now = self.stepper.look(self.given)
        for pid in due:
            name = pid.controller.measures
            gone = name in wrong and wrong[name].missing(t)
            seen = math.nan if gone else self.readings.read(name, k, now[name])
            pid.update(t, seen, self.readings.unit(name))

    def _healthy(self, name: str, now: Mapping[str, float], t: float) -> float:
        """What a value, input or sensor would be now if nothing were wrong with it."""
        if name in self.readings.names:
            gain, bias = self.given.wrong[name].at(t)
            return (now[name] - bias) / gain if gain else 0.0
        if any(i.name == name for i in self.graph.inputs):
            return self.given.told(name, t)
        symbols = {v.name: v.symbol for v in self.graph.values}
        return self.stepper.values.number(symbols[name])

    def _log(self, first: int, times: Array, rows: list[dict[str, float]]) -> Log:
        told = {n: np.array([self.given.told(n, t) for t in times.tolist()]) for n in self._known}
        wrong = self.given.wrong
        read = self.readings.all(first, times, rows, wrong)
        return Log(times, told | read, self.units, self.meta)


def _multiple(t: float, period: float) -> bool:
    return abs(t / period - round(t / period)) < 1e-6
