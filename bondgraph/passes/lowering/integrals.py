"""Sums of integrals as integrals of sums: a small difference is not lost in large integrals."""

from __future__ import annotations

from fractions import Fraction

from bondgraph.ir.expr import Expr, Op, Pool
from bondgraph.ir.nodes import constant, rebuilt


def gathered(pool: Pool, expr: Expr, start: Expr) -> Expr:
    """The expression with a Int(x) + b Int(y) written as Int(a x + b y), for constant a and b.

    Only integrals from the symbol `start` (zero) are joined; the change Int(D(x)) stays.
    """

    def gathering(node: Expr, args: tuple[Expr, ...]) -> Expr:
        made = pool.rebuild(node, args)
        return _joined(pool, made, start) if made.op is Op.ADD else made

    return rebuilt(pool, [expr], gathering)[0]


def _joined(pool: Pool, node: Expr, start: Expr) -> Expr:
    rest: list[tuple[Fraction | int, Expr]] = []
    rates: list[tuple[Fraction | int, Expr]] = []
    for c, arg in node.terms:
        found = [
            f
            for f, _ in arg.factors
            if f.op is Op.INT and f.data == start.data and f.args[0].op is not Op.DER
        ]
        other = pool.div(arg, found[0]) if found else arg
        if len(found) == 1 and constant(other):
            rates.append((c, pool.mul(other, found[0].args[0])))
        else:
            rest.append((c, arg))
    if len(rates) < 2:
        return node
    return pool.add(*rest, (1, pool.integral(pool.add(*rates), start)))
