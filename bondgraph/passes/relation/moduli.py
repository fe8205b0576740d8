"""The moduli that a relation was divided by on its way, and that may be zero.

A two-port that a known signal modulates is read backwards by dividing by its modulus: by 1 - a of
a duty cycle a, by a speed of a rotating body. Both may be zero while the machine runs, and a leak,
or the difference of two moments of inertia, is zero all the time.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from bondgraph.algebra.cleared import divisors
from bondgraph.algebra.nominal import Nominal
from bondgraph.ir.equation_system import EquationSystem
from bondgraph.ir.expr import KNOWN_SIGNALS, Expr, topological
from bondgraph.ir.nodes import constant, holding
from bondgraph.ir.residuals import Step


def moduli(system: EquationSystem, steps: Sequence[Step]) -> list[Expr]:
    """The moduli of two-ports that some step divides by, in known signals, and what a loop does.

    Moduli stand in the law of a two-port or, where it modulates another one, in a balance. What a
    law itself has below a stroke is none.
    Constant ones are left out: a transformer whose ratio is zero is none.
    """
    pool = system.graph.pool
    top: dict[Expr, None] = {}
    inside: dict[Expr, None] = {}
    seen: set[Expr] = set()  # values of a loop share nearly all that they are made of
    for step in steps:
        equation = step.equation
        kind = system.graph.nodes[equation.node].kind if equation.node >= 0 else ""
        if step.how == "loop":
            top.update(dict.fromkeys(_fresh(step.closed, seen)))
        elif equation.kind == "balance" or kind in ("TF", "GY"):
            own = _fresh(step.value, seen)
            if own:  # what is written is no work of the elimination
                written = {*divisors(topological([equation.zero]))}
                inside.update(dict.fromkeys(d for d in own if d not in written))
    values = {s.variable: s.closed for s in steps}
    if top:  # of a loop no law that it rests on, either
        laws = divisors(topological([s.equation.zero for s in steps]))
        for base in pool.substitute(laws, values):
            top.pop(base, None)
    return _moving([*top, *pool.substitute(inside, values)])


def _fresh(value: Expr, seen: set[Expr]) -> list[Expr]:
    """What a value divides by, in nodes that were not seen before."""
    nodes = topological([value], stop=seen.__contains__)
    own = divisors(n for n in nodes if n not in seen)
    seen.update(nodes)
    return own


def signals_below(expr: Expr) -> list[Expr]:
    """What a relation divides by and that holds known signals: it may become zero on the way."""
    return _moving(divisors(topological([expr])))


def _moving(bases: Iterable[Expr]) -> list[Expr]:
    found = dict.fromkeys(bases)
    moving = holding(found, lambda n: n.kind in KNOWN_SIGNALS)
    return [base for base in found if base in moving]


def vanishing_divisors(nominal: Nominal, expr: Expr) -> list[Expr]:
    """The constants below an expression that it divides by and that are nominally zero."""
    nodes = topological([expr])
    known: dict[Expr, bool] = {}
    found = dict.fromkeys(divisors(nodes))
    return [base for base in found if constant(base, known) and nominal.vanishes(base)]
