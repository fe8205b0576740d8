"""Run a scenario: integrate the state equations, sample the instruments, let faults come and go."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from bondgraph.ir.causal import CausalGraph
from bondgraph.ir.equations import EquationSystem
from bondgraph.ir.graph import BondGraph
from bondgraph.passes.state_equations import Wanted, state_equations
from bondgraph.runtime.log import Log
from bondgraph.runtime.simulation import courses
from bondgraph.runtime.simulation.controllers import Pid
from bondgraph.runtime.simulation.faults import Wrong, edges
from bondgraph.runtime.simulation.instruments import Reader
from bondgraph.runtime.simulation.integrate import Integrator, SimulationError
from bondgraph.runtime.simulation.machine import Machine, NoSolution
from bondgraph.runtime.simulation.observed import observed
from bondgraph.runtime.simulation.scenario import Course, Instrument, Scenario
from bondgraph.runtime.simulation.spread import spread
from bondgraph.runtime.simulation.values import Values
from bondgraph.text.diagnostic import CompileError, Report

Array = npt.NDArray[np.float64]
Progress = Callable[[float], None]


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
) -> Run:
    """Run a scenario of the model behind `system`.

    Raises `CompileError` where there are no state equations, `SimulationError` where integration
    ends early, KeyError with the name of a parameter without a value.
    """
    return _Simulation(system, integral, scenario).run(progress)


class _Simulation:
    def __init__(self, system: EquationSystem, integral: CausalGraph, scenario: Scenario) -> None:
        self.system, self.integral, self.scenario = system, integral, scenario
        self.graph: BondGraph = system.graph
        drawn = spread(self.graph, scenario)
        self.values = Values(self.graph, {**scenario.parameters, **drawn})
        self.sensors = [s for s in self.graph.sensors if s.same_as is None]
        self.wrong = self._wrong()
        self.modes = [i.name for i in self.graph.inputs if i.mode]
        self.told = self._told()
        self.pids = [
            Pid(c, courses.function(c.setpoint, self.graph.pool, self.values))
            for c in scenario.controllers
        ]
        self.times = self._times()
        self.readers = self._readers()
        self.machines: dict[tuple[bool, ...], Machine] = {}
        self._names: dict[int, tuple[str, ...]] = {}
        self._given: dict[int, Callable[[float], list[float]]] = {}
        self._driven: dict[str, list[tuple[float, float]]] = {
            c.input: [] for c in scenario.controllers
        }

    # -------------------------------------------------------------- what is given

    def _wrong(self) -> dict[str, Wrong]:
        targets = dict.fromkeys(f.target for f in self.scenario.faults)
        return {
            name: Wrong([f for f in self.scenario.faults if f.target == name]) for name in targets
        }

    def _told(self) -> dict[str, Course]:
        """The course of every input that no controller has in hand; zero where none is given."""
        zero = Course(None, ((0.0, 0.0),))
        driven = {c.input for c in self.scenario.controllers}
        given = {**self.scenario.inputs, **self.scenario.modes}
        names = [i.name for i in self.graph.inputs if i.name not in driven]
        return {name: given.get(name, zero) for name in names}

    def _times(self) -> Array:
        """The instants of the samples, in s; jitter is there, lost samples too."""
        sampling = self.scenario.sampling
        count = math.floor(self.scenario.duration * sampling.rate + 1e-9) + 1
        times = np.arange(count) / sampling.rate
        if sampling.jitter:
            draw = np.random.default_rng([self.scenario.seed, 1])
            shift = draw.uniform(-0.5, 0.5, count) * sampling.jitter / sampling.rate
            times[1:-1] += shift[1:-1]
        return np.asarray(times, dtype=float)

    def _readers(self) -> dict[str, Reader]:
        found = {}
        for k, sensor in enumerate(self.sensors):
            counts = None if sensor.counts is None else self.values.number(sensor.counts)
            instrument = self.scenario.instruments.get(sensor.name, Instrument())
            seed = [self.scenario.seed, 2, k]
            rate = self.scenario.sampling.rate
            found[sensor.name] = Reader(instrument, counts, len(self.times), rate, seed)
        return found

    def _machine(self, setting: tuple[bool, ...]) -> Machine:
        """The virtual machine in one mode of its switches."""
        if setting not in self.machines:
            report = Report()
            disturbed = tuple(
                n for n, w in self.wrong.items() if any(f.op != "missing" for f in w.faults)
            )
            modes = dict(zip(self.modes, setting, strict=True))
            wanted = Wanted(modes, self.scenario.static, disturbed, self.values.replaced)
            equations = state_equations(self.system, self.integral, wanted, report)
            if equations is None:
                raise CompileError(tuple(report.diagnostics))
            view = observed(self.system, equations, self.scenario.record)
            machine = Machine(equations, self.values, view.exprs)
            self.machines[setting] = machine
            self._given[id(machine)] = self._inputs(machine)
            self._names[id(machine)] = view.names
        return self.machines[setting]

    # -------------------------------------------------------------------- running

    def run(self, progress: Progress) -> Run:
        """Segment by segment, from jump to jump of anything."""
        times = self.times
        end = float(times[-1])
        stops = self._stops(end)
        first = self._machine(self._setting(0.0))
        names = self._names[id(first)]
        table = np.empty((len(times), len(names)))
        states = dict(zip(first.states, first.start().tolist(), strict=True))
        states |= self.scenario.initial
        integrator = Integrator(self.scenario.method, end)
        done = 0
        for a, b in zip([0.0, *stops], [*stops, end], strict=True):
            machine = self._machine(self._setting(a))
            inputs = self._given[id(machine)]
            x = np.array([states[name] for name in machine.states], dtype=float)
            self._begin(machine, a, x, table, done)
            for pid in self.pids:
                self._driven[pid.controller.input].append((a, pid.output))
            last = len(times) if b == end else int(np.searchsorted(times, b - 1e-12))
            wanted = times[done:last]
            try:
                rows = integrator.run(machine, inputs, a, b, x, wanted)
                for k, (t, row) in enumerate(zip(wanted.tolist(), rows, strict=False)):
                    now = self._row(machine, t, row)
                    table[done + k] = [now.get(name, math.nan) for name in names]
                after = self._row(machine, b, rows[-1])
            except NoSolution as failure:
                raise SimulationError(f"between {a:g} s and {b:g} s {failure}") from failure
            done = last
            states = {**after, **dict(zip(machine.states, rows[-1].tolist(), strict=True))}
            progress(b / end if end else 1.0)
        return self._result(first, names, table)

    def _setting(self, t: float) -> tuple[bool, ...]:
        pool, values = self.graph.pool, self.values
        return tuple(courses.function(self.told[name], pool, values)(t) != 0 for name in self.modes)

    def _stops(self, end: float) -> list[float]:
        """The moments between start and end at which something jumps or bends."""
        found = set(edges(self.scenario.faults, end))
        pool, values = self.graph.pool, self.values
        for name, course in self.told.items():
            found.update(courses.bends(course, end))
            jumps = courses.jumps(course, pool, values, self.times, name in self.modes)
            found.update(t for t in jumps if 0 < t < end)
        for controller in self.scenario.controllers:
            found.update(courses.jumps(controller.setpoint, pool, values, self.times, False))
            ticks = np.arange(1, math.ceil(end / controller.period)) * controller.period
            found.update(t for t in ticks.tolist() if t < end)
        kept: list[float] = []
        for t in sorted(t for t in found if 0 < t < end):
            if not kept or t - kept[-1] > 1e-9:
                kept.append(t)
        return kept

    def _inputs(self, machine: Machine) -> Callable[[float], list[float]]:
        """What `machine.signals` are, as functions of time."""
        pool, values = self.graph.pool, self.values
        pids = {p.controller.input: p for p in self.pids}
        made: list[Callable[[float], float]] = []
        for name, order in machine.signals:
            what, _, target = name.partition(" of ")
            if name in self.told:
                made.append(courses.function(self.told[name], pool, values, order))
            elif name in pids:
                made.append(_output(pids[name]) if order == 0 else _nothing)
            elif order > 1:
                made.append(_nothing)
            else:
                made.append(_disturbed(self.wrong[target], ("gain", "bias").index(what), order))
        return lambda t: [f(t) for f in made]

    def _row(self, machine: Machine, t: float, x: Array) -> dict[str, float]:
        """Everything that can be seen, by name."""
        names = self._names[id(machine)]
        return dict(
            zip(names, machine.observe(t, x.tolist(), self._given[id(machine)](t)), strict=True)
        )

    def _begin(self, machine: Machine, t: float, x: Array, table: Array, done: int) -> None:
        """What happens at a jump: faults that stick take hold, controllers read and decide."""
        waiting = [w for w in self.wrong.values() if any(f.op == "stuck" for f in w.faults)]
        due = [p for p in self.pids if _multiple(t, p.controller.period)]
        if not waiting and not due:
            return
        now = self._row(machine, t, x)
        columns = self._names[id(next(iter(self.machines.values())))]
        for name, wrong in self.wrong.items():
            wrong.hold(t, lambda name=name: self._acting(name, now, t))  # type: ignore[misc]
        k = min(int(np.searchsorted(self.times, t - 0.25 / self.scenario.sampling.rate)),
                len(self.times) - 1)  # fmt: skip
        for pid in due:
            name = pid.controller.measures
            reader = self.readers[name]
            own = reader.own_sample(k)
            true = now[name] if own >= done else table[own, columns.index(name)]
            gone = name in self.wrong and self.wrong[name].missing(t)
            seen = math.nan if gone else reader.read(own, true)
            unit = 1.0 if reader.counts is None else 2 * math.pi / reader.counts
            pid.update(t, seen, unit)

    def _acting(self, name: str, now: Mapping[str, float], t: float) -> float:
        """What a value, input or sensor is at this moment."""
        if name in now:
            return now[name]
        for pid in self.pids:
            if pid.controller.input == name:
                return pid.output
        if name in self.told:
            return courses.function(self.told[name], self.graph.pool, self.values)(t)
        symbols = {v.name: v.symbol for v in self.graph.values}
        return self.values.number(symbols[name])

    # -------------------------------------------------------------------- results

    def _result(self, machine: Machine, names: Sequence[str], table: Array) -> Run:
        scenario, graph = self.scenario, self.graph
        truth = {name: table[:, k].copy() for k, name in enumerate(names)}
        units = {s.name: s.unit or "" for s in graph.sensors}
        units |= {i.name: i.unit or "" for i in graph.inputs}
        units |= {x.name: x.unit or "" for x in graph.lets}
        known: dict[str, Array] = {}
        for item in graph.inputs:
            column = self._recorded(item.name)
            (known if item.known else truth)[item.name] = column
        for sensor in self.sensors:
            reader = self.readers[sensor.name]
            blank = np.full(len(self.times), math.nan)
            read = reader.all(truth.get(sensor.name, blank))
            if sensor.name in self.wrong:
                gone = [self.wrong[sensor.name].missing(t) for t in self.times]
                read = np.where(gone, math.nan, read)
            known[sensor.name] = read
        kept = np.ones(len(self.times), dtype=bool)
        if scenario.sampling.lost:
            draw = np.random.default_rng([scenario.seed, 3])
            kept = draw.uniform(size=len(kept)) >= scenario.sampling.lost
            kept[0] = True
        counted = {s.name: "count" for s in self.sensors if s.counts is not None}
        meta = {"model": graph.name, "scenario": scenario.name, "seed": str(scenario.seed)}
        own = {name: {**units, **counted}.get(name, "") for name in known}
        log = Log(self.times[kept], {n: c[kept] for n, c in known.items()}, own, meta)
        shown = {name: units.get(name, "") for name in truth}
        equations = machine.equations
        numbers = {v.name: self.values.constant(v.symbol) for v in graph.values}
        return Run(
            scenario,
            log,
            Log(self.times, truth, shown, meta),
            {name: n for name, n in numbers.items() if n is not None},
            equations.static,
            equations.dependent,
            tuple(n for n in machine.undeclared() if n not in scenario.initial),
        )

    def _recorded(self, name: str) -> Array:
        """An input as it was told, at every sample."""
        if name in self.told:
            f = courses.function(self.told[name], self.graph.pool, self.values)
            return np.array([f(t) for t in self.times.tolist()])
        changes = self._driven[name]
        at = np.searchsorted([t for t, _ in changes], self.times + 1e-12, side="right") - 1
        return np.array([v for _, v in changes])[at]


def _output(pid: Pid) -> Callable[[float], float]:
    return lambda _: pid.output


def _nothing(_: float) -> float:
    return 0.0


def _disturbed(wrong: Wrong, which: int, order: int) -> Callable[[float], float]:
    return (lambda t: wrong.slope(t)[which]) if order else (lambda t: wrong.at(t)[which])


def _multiple(t: float, period: float) -> bool:
    return abs(t / period - round(t / period)) * period < 1e-9
