"""A virtual machine that goes on from moment to moment, under whatever acts on it then."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from typing import Protocol

from bondgraph.ir.causal import CausalGraph
from bondgraph.ir.equation_system import EquationSystem
from bondgraph.passes.elimination.state_equations import Wanted, state_equations
from bondgraph.runtime.log import Array
from bondgraph.runtime.simulation.faults import Wrong
from bondgraph.runtime.simulation.given import inside
from bondgraph.runtime.simulation.handover import handed_over
from bondgraph.runtime.simulation.integrate import ShortSegments, SimulationError
from bondgraph.runtime.simulation.machine import Machine
from bondgraph.runtime.simulation.observed import observed
from bondgraph.runtime.simulation.parameters import Values, spread
from bondgraph.runtime.simulation.scenario import Scenario
from bondgraph.runtime.simulation.start import start
from bondgraph.text.diagnostic import CompileError, Report
from bondgraph.text.tuples import NamedTuple

Inputs = Callable[[float], Sequence[float]]

_HORIZON = 60.0  # s, by which it is judged what rings too fast to be followed


class Acting(Protocol):
    """What acts on a machine: commands and what is wrong; smooth within a segment."""

    wrong: dict[str, Wrong]

    @property
    def modes(self) -> tuple[str, ...]:
        """The names of the switches."""

    def setting(self, t: float) -> tuple[bool, ...]:
        """Their position at time t, in s."""

    def inputs(self, machine: Machine) -> Inputs:
        """What `machine.signals` are, as a function of time."""

    def before(self, machine: Machine) -> list[float]:
        """What they were before the start."""


class _Mode(NamedTuple):
    machine: Machine
    names: tuple[str, ...]


class Stepper:
    """The model behind `system`, with the parameters, initial values and method of a scenario.

    Another machine is made when a switch turns, and when something new goes wrong: what storages
    hold is handed over. `names` are what can be seen, `time` is where it stands, in s.
    """

    def __init__(self, system: EquationSystem, integral: CausalGraph, scenario: Scenario) -> None:
        self.system, self.integral, self.scenario = system, integral, scenario
        drawn = spread(system.graph, scenario)
        self.values = Values(system.graph, {**scenario.parameters, **drawn})
        self._modes: dict[tuple[tuple[bool, ...], tuple[str, ...]], _Mode] = {}
        self.restart()

    def restart(self) -> None:
        """Go back to the start."""
        self.time = 0.0
        self.names: tuple[str, ...] = ()
        self.last: dict[str, float] = {}  # all that could be seen last
        self._held: dict[str, float] | None = None
        self._inputs: dict[int, Inputs] = {}
        self._acting: Acting | None = None
        scenario = self.scenario
        self._integrator = ShortSegments(scenario.method, scenario.tolerance, _HORIZON)

    def jump(self, t: float) -> None:
        """Go on from another time: the clock has jumped, the machine has not moved."""
        self.time = t

    def look(self, acting: Acting) -> dict[str, float]:
        """Everything that can be seen now."""
        mode, inputs = self._mode(acting, self.time)
        x = self._state(mode, inputs, acting)
        return self._seen(mode, inputs, self.time, x)

    def advance(self, acting: Acting, end: float, wanted: Array) -> list[dict[str, float]]:
        """Go on to `end`; what can be seen at the `wanted` times, which lie between now and then.

        Raises `SimulationError` where the machine has no motion, `CompileError` where it has no
        state equations, KeyError with the name of a parameter without a value.
        """
        when = inside(self.time, end)
        mode, inputs = self._mode(acting, when(self.time))
        x = self._state(mode, inputs, acting, when(self.time))
        rows = self._integrator.run(
            mode.machine, lambda t: inputs(when(t)), self.time, end, x, wanted
        )
        seen = [
            self._seen(mode, inputs, when(t), row)
            for t, row in zip(wanted.tolist(), rows, strict=False)
        ]
        after = self._seen(mode, inputs, when(end), rows[-1])
        held = self._held
        assert held is not None
        held |= {n: v for n, v in after.items() if n in held and v == v}
        held |= zip(mode.machine.states, rows[-1].tolist(), strict=True)
        self.time, self.last = end, after
        return seen

    # ------------------------------------------------------------------------ helpers

    def _mode(self, acting: Acting, t: float) -> tuple[_Mode, Inputs]:
        if acting is not self._acting:
            self._acting, self._inputs = acting, {}
        disturbed = tuple(
            n for n, w in acting.wrong.items() if any(f.op != "missing" for f in w.faults)
        )
        key = acting.setting(t), disturbed
        if key not in self._modes:
            self._modes[key] = self._made(dict(zip(acting.modes, key[0], strict=True)), disturbed)
        mode = self._modes[key]
        number = id(mode.machine)
        if number not in self._inputs:
            self._inputs[number] = acting.inputs(mode.machine)
        self.names = self.names or mode.names
        return mode, self._inputs[number]

    def _made(self, modes: Mapping[str, bool], disturbed: tuple[str, ...]) -> _Mode:
        report = Report()
        wanted = Wanted(modes, self.scenario.static, disturbed, self.values.replaced)
        equations = state_equations(self.system, self.integral, wanted, report)
        if equations is None:
            raise CompileError(tuple(report.diagnostics))
        view = observed(self.system, equations, ())
        return _Mode(Machine(equations, self.values, view.exprs), view.names)

    def _state(self, mode: _Mode, inputs: Inputs, acting: Acting, t: float | None = None) -> Array:
        machine, now = mode.machine, self.time if t is None else t
        if self._held is None:
            graph, before = self.system.graph, acting.before(machine)
            self._held = start(machine, graph, self.scenario, inputs(now), before)
        for name in machine.states:  # of an encoder that may count wrong from now on
            self._held.setdefault(name, self.last.get(name.removesuffix(".counted"), 0.0))
        return handed_over(machine, self.time, inputs(now), self._held)

    def _seen(self, mode: _Mode, inputs: Inputs, t: float, x: Array) -> dict[str, float]:
        state, u = x.tolist(), inputs(t)
        found = mode.machine.observe(t, state, u)
        if not all(map(math.isfinite, state)):
            what = mode.machine.trouble(t, state, u) or "the solution grows without bound"
            raise SimulationError(f"it ends at {t:.6g} s: {what}")
        return dict(zip(mode.names, found, strict=True))
