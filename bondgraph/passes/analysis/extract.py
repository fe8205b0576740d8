"""The structure of a compiled bond graph, from its acausal equations."""

from __future__ import annotations

from bondgraph.ir.equation_system import Equation, EquationSystem
from bondgraph.ir.expr import KNOWN_SIGNALS, Expr, Op, symbols, topological, variables
from bondgraph.ir.structural_model import Mark, StructuralEquation, StructuralModel


def extract(system: EquationSystem) -> StructuralModel:
    """Which unknowns, known signals and faults each equation holds.

    A fault is a parameter, a known input or a sensor, in every equation with its symbol; a
    sensor and an input are a known signal as well. A law that uses the reading of a sensor holds
    the signal without the fault: it acts on the number that it got. The equation of a state, and
    every other that holds a derivative, is a differential constraint: the variable under the
    derivative is integrated (I), the others are or make up its derivative (D).
    """
    graph = system.graph
    fault_of = {s: i for i, s in enumerate(graph.fault_symbols().values())}
    known: dict[Expr, int] = {}
    column = {v: i for i, v in enumerate(system.unknowns)}
    rows = []
    for equation in system.equations:
        held = symbols(equation.zero)
        signals = [s for s in held if s.symbol.kind in KNOWN_SIGNALS]
        for symbol in graph.pool.logged(signals):
            known.setdefault(symbol, len(known))
        marked = sorted(_marks(equation, column))
        rows.append(
            StructuralEquation(
                f"{equation.kind} {equation.name}",
                tuple(c for c, _ in marked),
                tuple(m for _, m in marked),
                tuple(sorted({known[s] for s in graph.pool.logged(signals)})),
                tuple(sorted(fault_of[s] for s in held if s in fault_of)),
                equation.origin,
            )
        )
    return StructuralModel(
        graph.name,
        tuple(v.symbol.name for v in system.unknowns),
        tuple(s.symbol.name for s in known),
        graph.faults,
        tuple(rows),
    )


def _marks(equation: Equation, column: dict[Expr, int]) -> list[tuple[int, Mark]]:
    """The columns of the unknowns with how they occur."""
    held = variables(equation.zero)
    derived = [n for n in topological([equation.zero]) if n.op is Op.DER]
    states = {v for node in derived for v in variables(node)}
    if not states:
        return [(column[v], "") for v in held]
    return [(column[v], "I" if v in states else "D") for v in held]
