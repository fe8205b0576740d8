"""A virtual machine that goes on from moment to moment, under whatever acts on it then."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence

import numpy as np

from bondgraph.ir.causal import CausalGraph
from bondgraph.ir.equation_system import EquationSystem
from bondgraph.passes.elimination.state_equations import Wanted, state_equations
from bondgraph.runtime.log import Array
from bondgraph.runtime.simulation.given import Acting, Inputs, inside
from bondgraph.runtime.simulation.integrate import Integrator, ShortSegments, SimulationError
from bondgraph.runtime.simulation.machine import Machine, observed
from bondgraph.runtime.simulation.native_machine import NativeMachine, Segment
from bondgraph.runtime.simulation.scenario import Scenario
from bondgraph.runtime.simulation.storages import handed_over, start
from bondgraph.text.diagnostic import CompileError, Report
from bondgraph.text.tuples import NamedTuple

_HORIZON = 60.0  # s, by which it is judged what rings too fast to be followed


class Mode(NamedTuple):
    """The machine in one position of its switches, the names of its outputs, what it is given.

    `native` is the same machine compiled, or to be compiled; None where it is left to Python.
    """

    machine: Machine
    names: tuple[str, ...]
    inputs: Inputs
    native: NativeMachine | None


class Stepper:
    """The model behind `system` with what acts on it, started and integrated as a scenario says.

    Another machine is made when a switch turns, and when something new goes wrong: what storages
    hold is handed over. `record` are signals that can be seen beside states, sensors and `let`s.
    `names` are what can be seen, `time` is where it stands, in s. Who does not `remember` is
    refused a machine with delays (`SimulationError`).
    """

    def __init__(
        self,
        system: EquationSystem,
        integral: CausalGraph,
        scenario: Scenario,
        acting: Acting,
        record: Sequence[str] = (),
        remembers: bool = False,
    ) -> None:
        late = [i.of for i in system.graph.inputs if i.of]
        late += [s.symbol.name for s in system.graph.lags()]
        if late and not remembers:
            raise SimulationError(
                f"`{late[0]}` is delayed, and a machine that runs without an end has no past: "
                "`simulate` a scenario with an end, and watch its log"
            )
        self.system, self.integral, self.scenario = system, integral, scenario
        self.acting, self.record = acting, record
        self._modes: dict[tuple[tuple[bool, ...], tuple[str, ...]], Mode] = {}
        self.restart()

    def restart(self) -> None:
        """Go back to the start."""
        self.time = 0.0
        self.names: tuple[str, ...] = ()
        self.last: dict[str, float] = {}  # all that could be seen last
        self._held: dict[str, float] | None = None
        scenario = self.scenario
        self.integrator: Integrator | ShortSegments = ShortSegments(
            scenario.method, scenario.tolerance, _HORIZON
        )

    def jump(self, t: float) -> None:
        """Go on from another time: the clock has jumped, the machine has not moved."""
        self.time = t

    def look(self, end: float) -> dict[str, float]:
        """Everything that can be seen now, where a segment begins that goes on to `end`."""
        when = inside(self.time, end)
        mode = self.mode(when((self.time + end) / 2))
        now = when(self.time)
        return self._seen(mode, now, self._state(mode, now))

    def advance(self, end: float, wanted: Array) -> list[dict[str, float]]:
        """Go on to `end`; what can be seen at the `wanted` times, which lie between now and then.

        Raises `SimulationError` where the machine has no motion, `CompileError` where it has no
        state equations, KeyError with the name of a parameter without a value.
        """
        names, values = self.go_on(end, wanted)
        return [dict(zip(names, row, strict=True)) for row in values.tolist()]

    def go_on(self, end: float, wanted: Array) -> tuple[tuple[str, ...], Array]:
        """As `advance`: the names of what can be seen, and its values, shape (times, names)."""
        when = inside(self.time, end)
        middle = when((self.time + end) / 2)
        mode = self.mode(middle)  # what turns at the very start has turned
        x = self._state(mode, when(self.time))

        def inputs(t: float) -> list[float]:
            return mode.inputs(when(t))

        if mode.native is not None:
            moving = self.acting.moving(mode.machine, middle)
            mode.native.begin(Segment(when(-math.inf), when(math.inf), inputs, moving))
        found = self.integrator.run(mode.machine, inputs, self.time, end, x, wanted, mode.native)
        times = np.append(wanted, end)
        values = self._values(mode, when, times, found)
        after = dict(zip(mode.names, values[-1].tolist(), strict=True))
        held = self._held
        assert held is not None
        held |= {n: v for n, v in after.items() if n in held and v == v}
        held |= zip(mode.machine.states, found[-1].tolist(), strict=True)
        self.time, self.last = end, after
        return mode.names, values[:-1]

    def _values(
        self, mode: Mode, when: Callable[[float], float], times: Array, states: Array
    ) -> Array:
        """What can be seen at each time, shape (times, names)."""
        native = None if mode.native is None else mode.native.outputs(times, states)
        if native is None:
            if mode.native is not None:
                mode.native.count(len(times))
            native = np.empty((len(times), len(mode.names))), np.ones(len(times), dtype=np.bool_)
        values, odd = native
        for k in np.flatnonzero(odd).tolist():
            t = when(float(times[k]))
            values[k] = mode.machine.observe(t, states[k].tolist(), mode.inputs(t))
        self._check(mode, when, times, states, values)
        return values

    def mode(self, t: float) -> Mode:
        """The machine with its switches as they are at time t, and what is wrong by now."""
        acting = self.acting
        key = acting.setting(t), acting.disturbed
        if key not in self._modes:
            report = Report()
            modes = dict(zip(acting.modes, key[0], strict=True))
            wanted = Wanted(modes, self.scenario.static, acting.disturbed, acting.values.replaced)
            equations = state_equations(self.system, self.integral, wanted, report)
            if equations is None:
                raise CompileError(tuple(report.diagnostics))
            view = observed(self.system, equations, self.record)
            machine = Machine(equations, acting.values, view.exprs)
            native = self._native(machine)
            self._modes[key] = Mode(machine, view.names, acting.inputs(machine), native)
        mode = self._modes[key]
        self.names = self.names or mode.names
        return mode

    def _state(self, mode: Mode, now: float) -> Array:
        machine, u = mode.machine, mode.inputs(now)
        if self._held is None:
            before = self.acting.before(machine)
            self._held = start(machine, self.system.graph, self.scenario, u, before)
        for name in machine.states:  # of an encoder that may count wrong from now on
            self._held.setdefault(name, self.last.get(name.removesuffix(".counted"), 0.0))
        return handed_over(machine, self.time, u, self._held)

    def _native(self, machine: Machine) -> NativeMachine | None:
        """The machine to be compiled once that pays; None where it is left to Python."""
        return None

    def _seen(self, mode: Mode, t: float, x: Array) -> dict[str, float]:
        times, states = np.array([t]), x.reshape(1, -1)
        found = np.array([mode.machine.observe(t, x.tolist(), mode.inputs(t))]).reshape(1, -1)
        self._check(mode, lambda now: now, times, states, found)
        return dict(zip(mode.names, found[0].tolist(), strict=True))

    def _check(
        self,
        mode: Mode,
        when: Callable[[float], float],
        times: Array,
        states: Array,
        values: Array,
    ) -> None:
        """Raise `SimulationError` where the machine has run away."""
        bad = ~np.isfinite(states).all(axis=1)
        if bad.any():
            k = int(np.argmax(bad))
            t = when(float(times[k]))
            what = mode.machine.trouble(t, states[k].tolist(), mode.inputs(t))
            raise SimulationError(
                f"it ends at {t:.6g} s: {what or 'the solution grows without bound'}"
            )
