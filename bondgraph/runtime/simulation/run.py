"""Run a scenario: integrate the state equations, sample the instruments, let faults come and go."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping

import numpy as np

from bondgraph.ir.causal import CausalGraph
from bondgraph.ir.equation_system import EquationSystem
from bondgraph.ir.graph import BondGraph
from bondgraph.passes.elimination.state_equations import Wanted, state_equations
from bondgraph.runtime.log import Array, Log
from bondgraph.runtime.simulation.given import Given, Inputs, inside
from bondgraph.runtime.simulation.handover import handed_over
from bondgraph.runtime.simulation.instruments import Reader
from bondgraph.runtime.simulation.integrate import Integrator, SimulationError
from bondgraph.runtime.simulation.machine import Machine
from bondgraph.runtime.simulation.observed import observed
from bondgraph.runtime.simulation.parameters import Values, spread
from bondgraph.runtime.simulation.scenario import Instrument, Scenario
from bondgraph.runtime.simulation.start import start
from bondgraph.text.diagnostic import CompileError, Report
from bondgraph.text.tuples import NamedTuple

_MOST = 10**8  # samples, all of them in memory
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


class _Mode(NamedTuple):
    """The machine in one position of its switches, the names of its outputs, what it is given."""

    machine: Machine
    names: tuple[str, ...]
    inputs: Inputs


def _within(mode: _Mode, when: Callable[[float], float]) -> Inputs:
    """What the machine is given in a segment, jumps at its ends left out."""
    return lambda t: mode.inputs(when(t))


class _Simulation:
    def __init__(self, system: EquationSystem, integral: CausalGraph, scenario: Scenario) -> None:
        self.system, self.integral, self.scenario = system, integral, scenario
        self.graph: BondGraph = system.graph
        drawn = spread(self.graph, scenario)
        self.values = Values(self.graph, {**scenario.parameters, **drawn})
        self.sensors = [s for s in self.graph.sensors if s.same_as is None]
        self.times = self._times()
        self.given = Given(self.graph, scenario, self.values, self.times)
        self.readers = self._readers()
        self.modes: dict[tuple[bool, ...], _Mode] = {}
        samples = len(self.times)
        self.told = {i.name: np.empty(samples) for i in self.graph.inputs}
        self.gone = {s.name: np.zeros(samples, dtype=bool) for s in self.sensors}

    def _times(self) -> Array:
        """The instants of the samples, in s; jitter is there, lost samples too."""
        sampling = self.scenario.sampling
        count = math.floor(self.scenario.duration * sampling.rate + 1e-9) + 1
        if count > _MOST:
            raise SimulationError(f"a run of {count:.0e} samples is too long: take a lower rate")
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

    def _mode(self, t: float) -> _Mode:
        """The virtual machine with its switches as they are at time t."""
        setting = self.given.setting(t)
        if setting not in self.modes:
            report = Report()
            disturbed = tuple(
                n for n, w in self.given.wrong.items() if any(f.op != "missing" for f in w.faults)
            )
            modes = dict(zip(self.given.modes, setting, strict=True))
            wanted = Wanted(modes, self.scenario.static, disturbed, self.values.replaced)
            equations = state_equations(self.system, self.integral, wanted, report)
            if equations is None:
                raise CompileError(tuple(report.diagnostics))
            view = observed(self.system, equations, self.scenario.record)
            machine = Machine(equations, self.values, view.exprs)
            self.modes[setting] = _Mode(machine, view.names, self.given.inputs(machine))
        return self.modes[setting]

    # -------------------------------------------------------------------- running

    def run(self, progress: Progress) -> Run:
        """Segment by segment, from jump to jump of anything; the last one is a moment."""
        times, given = self.times, self.given
        end = float(times[-1])
        stops = given.stops(end)
        first = self._mode(0.0)
        table = np.full((len(times), len(first.names)), math.nan)
        before = given.before(first.machine)
        held = start(first.machine, self.graph, self.scenario, first.inputs(0.0), before)
        longest = 2 / self.scenario.sampling.rate if given.smooth else math.inf
        progress(0.0)
        integrator = Integrator(
            self.scenario.method,
            self.scenario.tolerance,
            end,
            longest,
            lambda t: progress(min(t / end, 1.0)),
        )
        done = 0
        for a, b in zip([0.0, *stops, end], [*stops, end, end], strict=True):
            when = inside(a, b)
            setting = when((a + b) / 2)  # what turns at the very start has turned
            mode = self._mode(setting)
            last = len(times) if a == end else int(np.searchsorted(times, b))
            x = handed_over(mode.machine, a, mode.inputs(when(a)), held)
            if self._begin(mode, when(a), x, table, (done, last)):
                x = handed_over(mode.machine, a, mode.inputs(when(a)), held)
            rows = integrator.run(mode.machine, _within(mode, when), a, b, x, times[done:last])
            for k, t in enumerate(times[done:last].tolist(), done):
                now = self._seen(mode, when(t), rows[k - done])
                table[k] = [now.get(name, math.nan) for name in first.names]
                self._note(k, when(t), setting)
            after = self._seen(mode, when(b), rows[-1])
            held |= {n: v for n, v in after.items() if n in held and v == v}
            held |= zip(mode.machine.states, rows[-1].tolist(), strict=True)
            done = last
            progress(b / end if end else 1.0)
        return self._result(first, table)

    def _seen(self, mode: _Mode, t: float, x: Array) -> dict[str, float]:
        """Everything that can be seen, by name."""
        state, u = x.tolist(), mode.inputs(t)
        found = mode.machine.observe(t, state, u)
        if not all(map(math.isfinite, found)):
            lets = {x.name for x in self.graph.lets}
            if any(n not in lets and v != v for n, v in zip(mode.names, found, strict=True)):
                what = mode.machine.trouble(t, state, u) or "the solution grows without bound"
                raise SimulationError(f"the run ends at {t:.6g} s: {what}")
        return dict(zip(mode.names, found, strict=True))

    def _begin(
        self, mode: _Mode, t: float, x: Array, table: Array, samples: tuple[int, int]
    ) -> bool:
        """What happens at a jump: faults that stick take hold, controllers read and decide.

        `samples` are the first of this segment and of the next. Whether anything was done.
        """
        wrong = self.given.wrong
        sticking = [n for n, w in wrong.items() if any(f.op == "stuck" for f in w.faults)]
        due = [p for p in self.given.pids if _multiple(t, p.controller.period)]
        if not sticking and not due:
            return False
        now = self._seen(mode, t, x)
        for name in sticking:
            wrong[name].hold(t, self._healthy(name, now, t))
            if name in self.readers and wrong[name].stuck(t):
                self.readers[name].freeze(*samples)
        if sticking:
            now = self._seen(mode, t, x)
        step = 1 / self.scenario.sampling.rate
        k = min(int(np.searchsorted(self.times, t - 0.25 * step)), len(self.times) - 1)
        first = next(iter(self.modes.values())).names
        for pid in due:
            name = pid.controller.measures
            reader = self.readers[name]
            own = reader.own_sample(k)
            true = now[name] if own >= samples[0] else table[own, first.index(name)]
            gone = name in wrong and wrong[name].missing(t)
            seen = math.nan if gone else reader.read(own, true)
            unit = 1.0 if reader.counts is None else 2 * math.pi / reader.counts
            pid.update(t, seen, unit)
        return True

    def _healthy(self, name: str, now: Mapping[str, float], t: float) -> float:
        """What a value, input or sensor would be at this moment if nothing were wrong with it."""
        if name in self.readers:
            gain, bias = self.given.wrong[name].at(t)
            return (now[name] - bias) / gain if gain else 0.0
        if name in self.told:
            return self.given.told(name, t)
        symbols = {v.name: v.symbol for v in self.graph.values}
        return self.values.number(symbols[name])

    def _note(self, k: int, t: float, setting: float) -> None:
        """Write down what is told at sample k, and what is not read.

        `setting` is a time at which the switches are as they are throughout the segment.
        """
        for name, column in self.told.items():
            column[k] = self.given.told(name, setting if name in self.given.modes else t)
            if not math.isfinite(column[k]):
                raise SimulationError(f"the run ends at {t:.6g} s: the input `{name}` has no value")
        for name, column in self.gone.items():
            if name in self.given.wrong:
                column[k] = self.given.wrong[name].missing(t)

    # -------------------------------------------------------------------- results

    def _result(self, mode: _Mode, table: Array) -> Run:
        scenario, graph = self.scenario, self.graph
        truth = {name: table[:, k].copy() for k, name in enumerate(mode.names)}
        units = {s.name: s.unit or "" for s in graph.sensors}
        units |= {i.name: i.unit or "" for i in graph.inputs}
        units |= {x.name: x.unit or "" for x in graph.lets}
        known: dict[str, Array] = {}
        for item in graph.inputs:
            (known if item.known else truth)[item.name] = self.told[item.name]
        blank = np.full(len(self.times), math.nan)
        for sensor in self.sensors:
            read = self.readers[sensor.name].all(truth.get(sensor.name, blank))
            known[sensor.name] = np.where(self.gone[sensor.name], math.nan, read)
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


def _multiple(t: float, period: float) -> bool:
    return abs(t / period - round(t / period)) < 1e-6
