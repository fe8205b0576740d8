"""Rings of the junction structure: what goes around in them is open; a balance says nothing."""

from __future__ import annotations

from collections.abc import Callable, Sequence, Set

from bondgraph.algebra.affine import rest
from bondgraph.algebra.sensitivity import sensitivity
from bondgraph.ir.equation_system import Equation, EquationSystem
from bondgraph.ir.expr import VARIABLES, Expr, Op, topological, variables
from bondgraph.ir.graph import Node
from bondgraph.ir.groups import Groups

_STRUCTURE = ("0", "1", "TF", "GY")
_ROUNDING = 1e-9  # of the coefficients of a balance

Number = Callable[[Expr], float | None]


def rings(
    system: EquationSystem, equations: Sequence[tuple[Equation, Expr]], number: Number
) -> dict[int, Expr]:
    """The balances that follow from others, by their place, each with a variable that is open.

    Where two ways lead from a junction to another (0 - 1 - 0 and 0 - 1 - 0), both say the same of
    the efforts at their ends, and nothing says how a flow divides among them. The power of a flow
    around the ring is zero: any value does, so the variable may be set to zero. `equations` are
    given with their zeros, `number` evaluates constant coefficients.

    The null vectors of the balances of one kind are the open variables of the other, as power
    is conserved (Tellegen, 1952).
    """
    if not _closed(system):
        return {}
    nodes = system.graph.nodes
    places = [k for k, (e, _) in enumerate(equations) if e.node >= 0]
    laws = [
        k for k in places
        if equations[k][0].kind == "law" and nodes[equations[k][0].node].kind in ("TF", "GY")
    ]  # fmt: skip
    pivots: dict[Expr, dict[Expr, float]] = {}
    found: dict[int, Expr] = {}
    for k in (*laws, *[k for k in places if equations[k][0].kind == "balance"]):
        equation, zero = equations[k]
        row = _linear(system, zero, number)
        said = frozenset(row)
        if row and not _reduced(row, pivots):
            variable = _open(system, nodes[equation.node], said)
            if variable is not None:
                found[k] = variable
    return found


def _open(system: EquationSystem, node: Node, said: Set[Expr]) -> Expr | None:
    """The variable that is open where an equation in the variables `said` says nothing new."""

    def own(variable: Expr) -> Expr:
        """The variable that it stands for, without its sign."""
        shared = system.shared.get(variable, variable)
        return next((n for n in topological([shared]) if n.op is Op.SYM), shared)

    conjugates = [(p.effort, p.flow) for p in node.ports]
    candidates = [own(f if own(e) in said else e) for e, f in conjugates]
    if node.common is not None:
        candidates = [own(node.common)]
    return next((c for c in candidates if c.kind in VARIABLES), None)


def _closed(system: EquationSystem) -> bool:
    """Whether bonds between junctions and two-ports run in a circle."""
    nodes, joined = system.graph.nodes, Groups[int]()
    return any(
        nodes[b.tail.node].kind in _STRUCTURE
        and nodes[b.head.node].kind in _STRUCTURE
        and not joined.join(b.tail.node, b.head.node)
        for b in system.graph.bonds
    )


def _linear(system: EquationSystem, zero: Expr, number: Number) -> dict[Expr, float]:
    """The coefficients of a homogeneous linear equation; empty where it is none."""
    pool = system.graph.pool
    unknown = variables(zero)
    if rest(pool, zero, unknown) is not pool.zero:
        return {}
    found = {}
    for variable, slope in sensitivity(pool, zero, unknown).items():
        value = number(slope)
        if value is None:
            return {}
        if value:
            found[variable] = value
    return found


def _reduced(row: dict[Expr, float], pivots: dict[Expr, dict[Expr, float]]) -> bool:
    """Subtract the rows before; whether something is left, which then is a row of its own."""
    size = max(map(abs, row.values()))
    while True:
        pivot = next((v for v in row if v in pivots), None)
        if pivot is None:
            break
        share = row[pivot]
        for variable, value in pivots[pivot].items():
            left = row.get(variable, 0.0) - share * value
            if variable is pivot or abs(left) <= _ROUNDING * size:
                row.pop(variable, None)
            else:
                row[variable] = left
    if not row:
        return False
    pivot = max(row, key=lambda v: (abs(row[v]), -v.id))
    pivots[pivot] = {v: c / row[pivot] for v, c in row.items()}
    return True
