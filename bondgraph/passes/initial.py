"""Take undeclared initial values out of a relation by differentiating it."""

from __future__ import annotations

from collections.abc import Callable

from bondgraph.ir.expr import Expr, Kind, Op, Pool, topological
from bondgraph.passes.solve import constant

_Value = Callable[[Expr, int], Expr]
_MOST = 12  # no relation worth having rests on more nested integrals


def without_free_integrals(pool: Pool, expr: Expr) -> tuple[Expr, int] | None:
    """The relation, differentiated as often as its integrals of unknown start require; how often.

    None where such an integral stands inside a nonlinear function, so that no derivative of the
    relation is free of it. Parameters are constant in time here.
    """
    for order in range(_MOST):
        pushed = _push(pool, expr, order)
        if pushed is None:
            return None
        if not _holding(pushed):
            return pushed, order
    return None


def _holding(expr: Expr) -> dict[Expr, None]:
    """The nodes that hold an integral whose start is not declared, arguments first."""
    found: dict[Expr, None] = {}
    for node in topological([expr]):
        own = node.op is Op.INT and node.symbol.kind is Kind.FREE
        if own or any(a in found for a in node.args):
            found[node] = None
    return found


def _push(pool: Pool, expr: Expr, order: int) -> Expr | None:
    """The derivative of `order`, moved inwards as far as undeclared integrals make necessary."""
    holding = _holding(expr)
    demand: dict[Expr, set[int]] = {node: set() for node in holding}
    demand.setdefault(expr, set()).add(order)
    for node in reversed(holding):
        for k in demand[node]:
            below = _order_below(node, k, holding)
            if below is None:
                return None
            for arg in node.args:
                if arg in holding:
                    demand[arg].add(below)
    made: dict[tuple[Expr, int], Expr] = {}

    def value(node: Expr, k: int) -> Expr:
        if node in holding:
            return made[node, k]
        for _ in range(k):
            node = pool.der(node)
        return node

    for node in holding:
        for k in sorted(demand[node]):
            made[node, k] = _derived(pool, node, k, holding, value)
    return value(expr, order)


def _order_below(node: Expr, k: int, holding: dict[Expr, None]) -> int | None:
    """Which derivative of its arguments the k-th derivative of a node needs; None: too many."""
    if node.op is Op.DER:
        return k + 1
    if node.op is Op.INT:
        return max(k - 1, 0)
    if node.op is Op.ADD or k == 0:
        return k
    if node.op is Op.MUL:
        inside = [e for a, e in zip(node.args, node.exponents, strict=True) if a in holding]
        outside = [a for a in node.args if a not in holding]
        if inside == [1] and all(constant(a) for a in outside):
            return k
    return None


def _derived(pool: Pool, node: Expr, k: int, holding: dict[Expr, None], value: _Value) -> Expr:
    if node.op is Op.DER:
        return value(node.args[0], k + 1)
    if node.op is Op.INT and k > 0:
        return value(node.args[0], k - 1)
    if node.op is Op.ADD:
        terms = zip(node.coefficients, node.args, strict=True)
        return pool.add(*[(c, value(a, k)) for c, a in terms])
    if node.op is Op.MUL and k > 0:
        return pool.mul(
            *[
                value(a, k) if a in holding else pool.power(a, e)
                for a, e in zip(node.args, node.exponents, strict=True)
            ]
        )
    return pool.rebuild(node, tuple(value(a, 0) for a in node.args))
