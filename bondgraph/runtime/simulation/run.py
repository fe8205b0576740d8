"""Run a scenario: integrate the state equations, sample the instruments, let faults come and go.

A run ends with its scenario; a `Robot` goes on and on, its samples given while it runs.
"""

from __future__ import annotations

import math
from bisect import bisect_right
from collections.abc import Callable, Iterator, Mapping

import numpy as np

from bondgraph.ir.causal import CausalGraph
from bondgraph.ir.equation_system import EquationSystem
from bondgraph.ir.graph import BondGraph
from bondgraph.runtime.c_library import warn
from bondgraph.runtime.log import Array, Log
from bondgraph.runtime.simulation.given import Given, inside
from bondgraph.runtime.simulation.instruments import Readings, passed_on, readers
from bondgraph.runtime.simulation.integrate import Integrator, SimulationError
from bondgraph.runtime.simulation.machine import Machine
from bondgraph.runtime.simulation.native_machine import Coding, NativeMachine
from bondgraph.runtime.simulation.parameters import drawn, units
from bondgraph.runtime.simulation.scenario import Scenario
from bondgraph.runtime.simulation.stepping import Mode, Stepper
from bondgraph.runtime.simulation.storages import start
from bondgraph.text.limits import RUN_VALUES
from bondgraph.text.tuples import NamedTuple

Progress = Callable[[float], None]
_WINDOW = 2048  # samples, at least, for which is looked ahead
_FLUSH = 0.02  # s of samples that are given together


class Run(NamedTuple):
    """What a virtual machine did.

    `log` holds what is known: commands as told and readings as taken, at the samples that arrived;
    `truth` the states, the true value of every sensor, the `let`s and what was recorded besides, at
    every sample, without noise. `parameters` are the numbers the machine had.
    """

    scenario: Scenario
    log: Log
    truth: Log
    parameters: dict[str, float]
    static: tuple[str, ...]
    dependent: tuple[str, ...]
    undeclared: tuple[str, ...]


def simulate(
    system: EquationSystem,
    integral: CausalGraph,
    scenario: Scenario,
    progress: Progress = lambda _: None,
    coding: Coding | None = None,
    tell: Callable[[str], None] = warn,
) -> Run:
    """Run a scenario of the model behind `system`.

    With a `coding` a long run is compiled; where it cannot be, `tell` is told why in a line. Raises
    `CompileError` where there are no state equations, `SimulationError` where integration ends
    early, KeyError with the name of a parameter without a value.
    """
    return _Simulation(system, integral, scenario, coding, tell).run(progress)


class _Simulation(Stepper):
    """A machine that goes on from jump to jump of anything, sampled until its scenario ends."""

    def __init__(
        self,
        system: EquationSystem,
        integral: CausalGraph,
        scenario: Scenario,
        coding: Coding | None = None,
        tell: Callable[[str], None] = warn,
    ) -> None:
        self.graph: BondGraph = system.graph
        self.scenario = scenario
        self._coding, self._tell = coding, tell
        self.values = drawn(self.graph, scenario)
        self.sensors = [s for s in self.graph.sensors if s.same_as is None]
        self.times = self._times()
        self.given = Given(self.graph, scenario, self.values, self.times)
        super().__init__(system, integral, scenario, self.given, scenario.record, remembers=True)
        self.late = {s.name: float(s.delay) for s in self.sensors if s.delay}
        self.given.recall = self._recall
        self._then: list[float] = []  # when what is remembered was
        received = [i.of for i in self.graph.inputs if i.of]
        self._past: dict[str, list[float]] = {name: [] for name in (*self.late, *received)}
        samples = len(self.times)
        self.readers = readers(self.graph, scenario, self.values, samples)
        self.given.obey(passed_on(self.graph, self.readers, self.times))
        self.told = {i.name: np.empty(samples) for i in self.graph.inputs if not i.of}
        self.gone = {s.name: np.zeros(samples, dtype=bool) for s in self.sensors}

    def _times(self) -> Array:
        """The instants of the samples, in s; jitter is there, lost samples too."""
        sampling = self.scenario.sampling
        count = math.floor(self.scenario.duration * sampling.rate + 1e-9) + 1
        signals = 1 + len(self.graph.inputs) + len(self.sensors)
        if count * signals > RUN_VALUES:
            raise SimulationError(
                f"a run of {count:,} samples of {signals} signals is too long: {RUN_VALUES:,}"
                " numbers are the most; take a lower rate or a shorter duration"
            )
        times = np.arange(count) / sampling.rate
        if sampling.jitter:
            draw = np.random.default_rng([self.scenario.seed, 1])
            shift = draw.uniform(-0.5, 0.5, count) * sampling.jitter / sampling.rate
            times[1:-1] += shift[1:-1]
        return np.asarray(times, dtype=float)

    # -------------------------------------------------------------------- running

    def run(self, progress: Progress) -> Run:
        """Segment by segment, from jump to jump of anything; the last one is a moment."""
        times, given, scenario = self.times, self.given, self.scenario
        end = float(times[-1])
        stops = given.stops(end)
        first = self.mode(0.0)
        table = np.full((len(times), len(first.names)), math.nan)
        before = given.before(first.machine)
        self._held = start(first.machine, self.graph, scenario, first.inputs(0.0), before)
        progress(0.0)
        self.integrator = Integrator(
            scenario.method,
            scenario.tolerance,
            end,
            # noise bends at each sample
            (1 if given.errors else 2) / scenario.sampling.rate if given.smooth else math.inf,
            lambda t: progress(min(t / end, 1.0)),
        )
        done = 0
        if self._past:
            self._remember(0.0, self.look([*stops, end][0]))
        for b in [*stops, end, end]:
            a, when = self.time, inside(self.time, b)
            last = len(times) if a == end else int(np.searchsorted(times, b))
            self._begin(when(a), b, table, (done, last))
            wanted = times[done:last]
            names, values = self.go_on(b, wanted)
            if names == first.names:
                table[done:last] = values
            else:
                both = [n for n in first.names if n in names]
                places = [first.names.index(n) for n in both]
                table[done:last, places] = values[:, [names.index(n) for n in both]]
            inner = [when(t) for t in wanted.tolist()]
            self._note(slice(done, last), inner, when((a + b) / 2))
            for t, row in zip(wanted.tolist() if self._past else (), values.tolist(), strict=False):
                self._remember(t, dict(zip(names, row, strict=True)))
            self._remember(b, self.last)
            done = last
            progress(b / end if end else 1.0)
        return self._result(first, table)

    def _remember(self, t: float, now: Mapping[str, float]) -> None:
        """Keep the true values of the sensors whose past is asked for."""
        if self._past:
            self._then.append(t)
            for name, values in self._past.items():
                values.append(now.get(name, math.nan))

    def _recall(self, name: str, t: float) -> float:
        """The true value of a sensor at an earlier time, before the start that at the start."""
        values, k = self._past[name], bisect_right(self._then, t)
        if not 0 < k < len(values):
            return values[min(k, len(values)) - 1 if k else 0] if values else 0.0
        a, b = self._then[k - 1 : k + 1]
        return values[k - 1] + (values[k] - values[k - 1]) * (t - a) / (b - a)

    def _native(self, machine: Machine) -> NativeMachine | None:
        if self._coding is None:
            return None
        return NativeMachine(machine, self.given.followed(machine), self._coding, self._tell)

    def _check(
        self,
        mode: Mode,
        when: Callable[[float], float],
        times: Array,
        states: Array,
        values: Array,
    ) -> None:
        """Only `let`s may have no value."""
        if np.isfinite(values).all():
            return
        lets = {x.name for x in self.graph.lets}
        needed = [k for k, n in enumerate(mode.names) if n not in lets]
        bad = np.isnan(values[:, needed]).any(axis=1)
        if bad.any():
            k = int(np.argmax(bad))
            t = when(float(times[k]))
            what = mode.machine.trouble(t, states[k].tolist(), mode.inputs(t))
            what = what or "the solution grows without bound"
            raise SimulationError(f"the run ends at {t:.6g} s: {what}")

    def _begin(self, t: float, end: float, table: Array, samples: tuple[int, int]) -> None:
        """At the start of a segment; `samples` are the first of it and of the next."""
        step = 1 / self.scenario.sampling.rate
        k = min(int(np.searchsorted(self.times, t - 0.25 * step)), len(self.times) - 1)

        def read(name: str, now: float) -> float:
            reader = self.readers[name]
            own = reader.own_sample(k)
            if name in self.late:
                true = self._recall(name, self.times[own] - self.late[name])
            else:
                true = now if own >= samples[0] else table[own, self.names.index(name)]
            return reader.read(own, true) * reader.unit

        self.given.hold(t, lambda: self.look(end))
        for name, reader in self.readers.items():
            if name in self.given.wrong and self.given.wrong[name].stuck(t):
                reader.freeze(*samples)
        self.given.control(t, lambda: self.look(end), read)

    def _note(self, samples: slice, times: list[float], setting: float) -> None:
        """Write down what is told at some samples, and what is not read.

        `setting` is a time inside of the segment: switches, and all that stands still, are as then.
        """
        for name, column in self.told.items() if times else ():
            moments = [setting] if self.given.still(name) else times
            column[samples] = [self.given.told(name, t) for t in moments]
            odd = ~np.isfinite(column[samples])
            if odd.any():
                t = times[int(np.argmax(odd))]
                raise SimulationError(f"the run ends at {t:.6g} s: the input `{name}` has no value")
        for name, column in self.gone.items():
            if name in self.given.wrong:
                column[samples] = [self.given.wrong[name].missing(t) for t in times]

    # -------------------------------------------------------------------- results

    def _result(self, mode: Mode, table: Array) -> Run:
        scenario, graph = self.scenario, self.graph
        truth = {name: table[:, k].copy() for k, name in enumerate(mode.names)}
        written = units(graph) | {x.name: x.unit or "" for x in graph.lets}
        known: dict[str, Array] = {}
        for item in (i for i in graph.inputs if not i.of):
            (known if item.known else truth)[item.name] = self.told[item.name]
        blank = np.full(len(self.times), math.nan)
        for sensor in self.sensors:
            true = truth.get(sensor.name, blank)
            if sensor.name in self.late:  # before the start it was as it was then
                true = np.interp(self.times - self.late[sensor.name], self.times, true)
            read = self.readers[sensor.name].all(true)
            if sensor.name in self.given.errors and sensor.name in truth:
                truth[sensor.name] -= [self.given.error(sensor.name, t) for t in self.times]
            known[sensor.name] = np.where(self.gone[sensor.name], math.nan, read)
        kept = np.ones(len(self.times), dtype=bool)
        if scenario.sampling.lost:
            draw = np.random.default_rng([scenario.seed, 3])
            kept = draw.uniform(size=len(kept)) >= scenario.sampling.lost
            kept[0] = True
        counted = {s.name: "count" for s in self.sensors if s.counts is not None}
        meta = {"model": graph.name, "scenario": scenario.name, "seed": str(scenario.seed)}
        own = {name: {**written, **counted}.get(name, "") for name in known}
        log = Log(self.times[kept], {n: c[kept] for n, c in known.items()}, own, meta)
        shown = {name: written.get(name, "") for name in truth}
        equations = mode.machine.equations
        numbers = {v.name: self.values.constant(v.symbol) for v in graph.values}
        return Run(
            scenario,
            log,
            Log(self.times, truth, shown, meta),
            {name: n for name, n in numbers.items() if n is not None},
            equations.static,
            tuple(dict.fromkeys(i.storage for i in equations.dependent)),
            ()
            if scenario.start == "steady"
            else tuple(n for n in mode.machine.undeclared() if n not in scenario.initial),
        )


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
        self.given.obey(self.readings.passed_on(times[:-1]))
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
