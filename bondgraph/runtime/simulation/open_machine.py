"""State equations whose parameters stay open, as lines of C: a machine to be run elsewhere.

It is the machine of `simulate`, written by what compiles that one. What needs more than rates (a
switch that turns, a past, an impulse) is refused with a word about it.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence

from bondgraph.ir.causal import CausalGraph
from bondgraph.ir.equation_system import EquationSystem
from bondgraph.ir.expr import Expr, Op, topological
from bondgraph.ir.graph import BondGraph
from bondgraph.ir.rate_source import MachineSensor, OpenMachine, OpenParameter
from bondgraph.ir.state import StateEquations
from bondgraph.notation.dialect import Language
from bondgraph.passes.elimination.state_equations import Wanted, state_equations
from bondgraph.runtime.log import Array
from bondgraph.runtime.simulation.code import Numbers
from bondgraph.runtime.simulation.integrate import SimulationError
from bondgraph.runtime.simulation.machine import Machine, observed
from bondgraph.runtime.simulation.native_machine import Unsuitable, Written
from bondgraph.runtime.simulation.parameters import Values
from bondgraph.runtime.simulation.scenario import Scenario
from bondgraph.runtime.simulation.storages import handed_over, start
from bondgraph.text.diagnostic import Report

_SAME = 1e-9  # next to a unit of effort or flow: a start that needs no impulse


def open_machine(
    system: EquationSystem, integral: CausalGraph, language: Language, report: Report
) -> OpenMachine | None:
    """The machine behind `system`; None, with a warning in the report, where there can be none."""
    try:
        return _Opened(system, integral).written(language)
    except Unsuitable as error:
        report.warning(
            "no-machine-fmu",
            f"There is no FMU of this machine: {error}.",
            *error.origins[:4],
            help="`simulate` runs it; its monitor FMU takes samples from there or from elsewhere.",
        )
        return None


class _OpenValues(Values):
    """The numbers of a machine, of which what the open parameters are in has none."""

    def __init__(self, graph: BondGraph, names: Iterable[str]) -> None:
        super().__init__(graph)
        own = set(names)
        self.symbols = {v.name: v.symbol for v in graph.values if v.name in own}
        self._is_open: dict[Expr, bool] = {symbol: True for symbol in self.symbols.values()}

    def constant(self, expr: Expr) -> float | None:
        """See `Values`."""
        known = self._is_open
        for node in topological([expr], stop=known.__contains__):
            if node not in known:
                known[node] = any(known[arg] for arg in node.args)
        return None if known[expr] else super().constant(expr)


class _OpenRates(Machine):
    """A machine that reads its open parameters from the constants `p`, where they come first."""

    values: _OpenValues

    def leaves(self) -> dict[Expr, str]:
        """See `Machine`."""
        own = {symbol: f"p[{k}]" for k, symbol in enumerate(self.values.symbols.values())}
        return super().leaves() | own


class _Opened:
    def __init__(self, system: EquationSystem, integral: CausalGraph) -> None:
        self.system, self.integral, self.graph = system, integral, system.graph
        self._refuse_what_is_late()
        self.sensors = [s for s in self.graph.sensors if s.same_as is None]
        self.equations, self.nominal = self._equations()
        self._refuse_derivatives()

    def written(self, language: Language) -> OpenMachine:
        """The machine as lines; raises `Unsuitable`."""
        outputs, parameters = self.nominal.outputs, self._parameters()
        values = _OpenValues(self.graph, [p.name for p in parameters])
        numbers = Numbers()
        numbers.put([p.value for p in parameters])
        machine = _OpenRates(self.equations, values, outputs)
        source = Written(machine, [], language, numbers).source
        x = self._start()
        scale = self.nominal.scale(0.0, x.tolist(), [0.0] * len(machine.signals))
        impulses = {i.signal.symbol.name for i in self.equations.dependent}
        return OpenMachine(
            source,
            tuple(parameters),
            tuple(numbers.values[len(parameters) :]),
            machine.states,
            tuple(x.tolist()),
            tuple(scale.tolist()),
            tuple(None if s.name in impulses else s.name for s in machine.signals),
            tuple(self.graph.inputs),
            tuple(
                MachineSensor(
                    s.name, s.unit or "", s.doc, s.origin,
                    0.0 if s.counts is None else self.nominal.values.number(s.counts),
                )
                for s in self.sensors
            ),
        )  # fmt: skip

    # ------------------------------------------------------------- what is refused

    def _refuse_what_is_late(self) -> None:
        """A delay has a past, and a switch its own equations for each position."""
        for item in self.graph.inputs:
            if item.mode:
                raise Unsuitable(
                    f"`{item.name}` turns a switch, and each position has other states",
                    [item.origin],
                )
            if item.of or item.delay:
                raise Unsuitable(f"`{item.of or item.name}` is delayed", [item.origin])
        for sensor in self.graph.sensors:
            if sensor.of or sensor.delay:
                raise Unsuitable(f"`{sensor.of or sensor.name}` is delayed", [sensor.origin])

    def _refuse_derivatives(self) -> None:
        """An input that jumps gives an impulse where its derivative is needed."""
        origins = {i.name: i.origin for i in self.graph.inputs}
        for signal in self.nominal.signals:
            if signal.order and signal.name in origins:
                raise Unsuitable(
                    f"it needs the derivative of `{signal.name}`, which imposes the effort or flow"
                    " of a storage",
                    [origins[signal.name]],
                )

    # ------------------------------------------------------------- equations

    def _equations(self) -> tuple[StateEquations, Machine]:
        """The state equations, and the machine at the numbers of the model.

        A parameter that is zero stays in them where the machine has rates with it.
        """
        names = [v.name for v in self.graph.values]
        for kept in (frozenset(names), frozenset[str]()):
            own = Report()
            found = state_equations(self.system, self.integral, Wanted({}, open=kept), own)
            if found is None:
                if kept:
                    continue
                first = own.diagnostics[0]
                why = first.message.rstrip(".")
                raise Unsuitable(f"{why[:1].lower()}{why[1:]}", [s for s, _ in first.labels])
            machine = self._at_nominal(found)
            if not kept or self._runs(machine):
                return found, machine
        raise AssertionError("the last one is returned")

    def _at_nominal(self, equations: StateEquations) -> Machine:
        view = observed(self.system, equations, ())
        seen = dict(zip(view.names, view.exprs, strict=True))
        for sensor in self.sensors:
            if sensor.name not in seen:
                why = f"its equations do not tell what `{sensor.name}` reads"
                raise Unsuitable(why, [sensor.origin])
        values = Values(self.graph)
        try:
            return Machine(equations, values, [seen[s.name] for s in self.sensors])
        except KeyError as error:
            name = error.args[0]
            origins = [v.origin for v in self.graph.values if v.name == name]
            raise Unsuitable(f"`{name}` has no value", origins) from error

    def _runs(self, machine: Machine) -> bool:
        u = [0.0] * len(machine.signals)
        x = [machine.start().get(name, 0.0) for name in machine.states]
        return all(map(math.isfinite, [*machine.rates(0.0, x, u), *machine.observe(0.0, x, u)]))

    def _start(self) -> Array:
        """The states at the start, with all inputs zero as before it."""
        machine, u = self.nominal, [0.0] * len(self.nominal.signals)
        try:
            held = start(machine, self.graph, Scenario("start"), u, u)
            return handed_over(machine, 0.0, u, held)
        except SimulationError as error:
            raise Unsuitable(str(error)) from error

    # ------------------------------------------------------------- parameters

    def _parameters(self) -> list[OpenParameter]:
        """The values that the equations read, in the order of the model.

        What a dependent storage holds follows from the states by some of them: they are fixed, as
        it would take an impulse to change them.
        """
        machine, equations = self.nominal, self.equations
        read = self._read([*(s.rate for s in equations.states), *machine.outputs])
        fixed = self._read([i.state for i in equations.dependent])
        return [
            OpenParameter(
                v.name,
                math.nan if (number := machine.values.constant(v.symbol)) is None else number,
                v.unit or "", v.doc, v.origin, v.symbol in fixed,
            )
            for v in self.graph.values
            if v.symbol in read or v.symbol in fixed
        ]  # fmt: skip

    def _read(self, roots: Sequence[Expr]) -> set[Expr]:
        """The symbols that expressions rest on, through the blocks of the equations."""
        own = [
            e
            for k in sorted(self.nominal.needed(roots))
            for b in [self.equations.blocks[k]]
            for e in ([b.value] if b.value is not None else [*b.zeros, *b.rests])
        ]
        return {node for node in topological([*roots, *own]) if node.op is Op.SYM}


