"""The causal path behind a relation: how each variable on the way follows from known signals."""

from __future__ import annotations

from bondgraph.algebra.present import tidy
from bondgraph.ir.causal import CausalGraph
from bondgraph.ir.equation_system import EquationSystem
from bondgraph.ir.expr import Expr, Op, Pool
from bondgraph.ir.residuals import Residual, Step
from bondgraph.notation.line import show
from bondgraph.text.source import Span
from bondgraph.text.tuples import NamedTuple

_WORDS = {
    "balance": "balance of junction",
    "law": "law of",
    "state": "state of",
    "integral": "integral",
    "sensor": "measured by",
}


class PathStep(NamedTuple):
    """One line of a path: `variable = value`, why, where in the source.

    `node` and `expr` are the two sides of `variable` = `value` as nodes. `leaves` says that the
    step runs against the strokes of the derivative-causality drawing, as the inversion of a gyrator
    or of a source does (bicausal, Gawthrop 1995).
    """

    variable: str
    value: str
    why: str
    origin: Span
    leaves: bool
    node: Expr
    expr: Expr


def path(residual: Residual, system: EquationSystem, derivative: CausalGraph) -> list[PathStep]:
    """The steps from the known signals to the relation, in the order they can be computed."""
    imposed = _imposed(system, derivative)
    return [_line(system.graph.pool, s, imposed) for s in residual.steps]


def _line(pool: Pool, step: Step, imposed: dict[tuple[Expr, int], bool]) -> PathStep:
    equation = step.equation
    why = f"{_WORDS[equation.kind]} {equation.name}"
    if step.how in ("differentiated", "integrated", "inverted", "loop"):
        why += f", {step.how if step.how != 'loop' else 'closed by the loop'}"
    leaves = not imposed.get((step.variable, equation.node), True)
    value = tidy(pool, step.value)[0]
    name = step.variable.symbol.name
    return PathStep(name, show(value), why, equation.origin, leaves, step.variable, value)


def _imposed(system: EquationSystem, causal: CausalGraph) -> dict[tuple[Expr, int], bool]:
    """For a bond's variable and a node of the bond: whether the strokes let the node impose it."""
    found: dict[tuple[Expr, int], bool] = {}
    for bond, stroke in zip(system.graph.bonds, causal.strokes, strict=True):
        receiver = bond.head.node if stroke.at == "head" else bond.tail.node
        effort, flow = (
            _variable(v) for v in (system.efforts[bond.number], system.flows[bond.number])
        )
        for node in (bond.tail.node, bond.head.node):
            for variable, gives in ((effort, node != receiver), (flow, node == receiver)):
                if variable is not None:
                    found[variable, node] = found.get((variable, node), False) or gives
    return found


def _variable(expr: Expr) -> Expr | None:
    _, plain = expr.scaled
    return plain if plain.op is Op.SYM else None
