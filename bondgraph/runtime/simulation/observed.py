"""What can be seen of a virtual machine, by name: states, sensors, `let`s, efforts and flows."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from bondgraph.ir.equation_system import EquationSystem
from bondgraph.ir.expr import CONSTANTS, Expr, Kind, Op, topological
from bondgraph.ir.graph import BondGraph
from bondgraph.ir.state import StateEquations
from bondgraph.text.tuples import NamedTuple

_GIVEN = CONSTANTS | {Kind.INPUT, Kind.UNKNOWN, Kind.MODE}


class Observed(NamedTuple):
    """Names with the expression of each, in the variables of the state equations."""

    names: tuple[str, ...]
    exprs: tuple[Expr, ...]


def observed(system: EquationSystem, equations: StateEquations, record: Sequence[str]) -> Observed:
    """All states, sensors and `let`s, and the signals to `record`.

    What the equations leave open is left out. Raises KeyError for a name to record that is none.
    """
    graph, pool = system.graph, system.graph.pool
    everything = named(graph)
    wanted: dict[str, Expr] = {}
    for equation in system.equations:
        if equation.state is not None:
            wanted[equation.state.symbol.name] = equation.state
    wanted |= {s.name: s.symbol for s in graph.sensors if s.same_as is None}
    wanted |= {let.name: let.value for let in graph.lets}
    wanted |= {name: everything[name] for name in record}
    found = {u for b in equations.blocks for u in b.unknowns}
    found |= {s.symbol for s in equations.states}
    own = pool.substitute(pool.logged(wanted.values()), system.shared)
    kept = {n: e for n, e in zip(wanted, own, strict=True) if _computable(e, found)}
    return Observed(tuple(kept), tuple(kept.values()))


def named(graph: BondGraph) -> Mapping[str, Expr]:
    """Every effort and flow by the name that a person knows it by (`m[1].el.i.f`)."""
    found: dict[str, Expr] = {}
    for node in graph.nodes:
        if node.common is not None:
            found[node.common.symbol.name] = node.common
        for port in node.ports:
            for variable in (port.effort, port.flow):
                found[variable.symbol.name] = variable
    return found


def _computable(expr: Expr, found: set[Expr]) -> bool:
    return all(
        node.op is not Op.DER
        and (node.op is not Op.SYM or node in found or node.symbol.kind in _GIVEN)
        for node in topological([expr])
    )
