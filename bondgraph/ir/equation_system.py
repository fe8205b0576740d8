"""The acausal equations of a bond graph: one balance a junction, the laws, the states."""

from __future__ import annotations

from typing import Literal

from bondgraph.ir.expr import Expr
from bondgraph.ir.graph import BondGraph
from bondgraph.text.source import Span
from bondgraph.text.tuples import NamedTuple

EquationKind = Literal["balance", "law", "state", "integral", "sensor"]


class Equation(NamedTuple):
    """`zero` = 0 in the unknown `variables`.

    kind balance: a junction; law: an element; sensor: a measurement; state and integral:
    `variables[0]`' = `rate` (zero is then der(state) - rate), `initial` the SYM of the initial
    value or None where the model declares none. `node` is the index in the graph, -1 for none.
    """

    kind: EquationKind
    name: str
    zero: Expr
    variables: tuple[Expr, ...]
    node: int
    origin: Span
    state: Expr | None = None
    rate: Expr | None = None
    initial: Expr | None = None


class EquationSystem(NamedTuple):
    """All equations; variables aliased by junctions are already one.

    `efforts` and `flows` give the two variables of each bond, with a sign where a port's variable
    stands for it. A variable's name is the one a person knows it by (`m[1].el.i.f`). `shared` says
    what stands for a variable of a port or junction that is not in the equations itself.
    """

    graph: BondGraph
    equations: tuple[Equation, ...]
    unknowns: tuple[Expr, ...]
    efforts: tuple[Expr, ...]
    flows: tuple[Expr, ...]
    shared: dict[Expr, Expr]
