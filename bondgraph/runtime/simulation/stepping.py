"""A virtual machine that goes on from moment to moment, under whatever acts on it then."""

from __future__ import annotations

import math
from collections.abc import Sequence

from bondgraph.ir.causal import CausalGraph
from bondgraph.ir.equation_system import EquationSystem
from bondgraph.passes.elimination.state_equations import Wanted, state_equations
from bondgraph.runtime.log import Array
from bondgraph.runtime.simulation.given import Acting, Inputs, inside
from bondgraph.runtime.simulation.integrate import Integrator, ShortSegments, SimulationError
from bondgraph.runtime.simulation.machine import Machine, observed
from bondgraph.runtime.simulation.scenario import Scenario
from bondgraph.runtime.simulation.storages import handed_over, start
from bondgraph.text.diagnostic import CompileError, Report
from bondgraph.text.tuples import NamedTuple

_HORIZON = 60.0  # s, by which it is judged what rings too fast to be followed


class Mode(NamedTuple):
    """The machine in one position of its switches, the names of its outputs, what it is given."""

    machine: Machine
    names: tuple[str, ...]
    inputs: Inputs


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
        when = inside(self.time, end)
        mode = self.mode(when((self.time + end) / 2))  # what turns at the very start has turned
        x = self._state(mode, when(self.time))
        rows = self.integrator.run(
            mode.machine, lambda t: mode.inputs(when(t)), self.time, end, x, wanted
        )
        seen = [
            self._seen(mode, when(t), row) for t, row in zip(wanted.tolist(), rows, strict=False)
        ]
        after = self._seen(mode, when(end), rows[-1])
        held = self._held
        assert held is not None
        held |= {n: v for n, v in after.items() if n in held and v == v}
        held |= zip(mode.machine.states, rows[-1].tolist(), strict=True)
        self.time, self.last = end, after
        return seen

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
            self._modes[key] = Mode(machine, view.names, acting.inputs(machine))
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

    def _seen(self, mode: Mode, t: float, x: Array) -> dict[str, float]:
        state, u = x.tolist(), mode.inputs(t)
        found = mode.machine.observe(t, state, u)
        if not all(map(math.isfinite, state)):
            what = mode.machine.trouble(t, state, u) or "the solution grows without bound"
            raise SimulationError(f"it ends at {t:.6g} s: {what}")
        return dict(zip(mode.names, found, strict=True))
