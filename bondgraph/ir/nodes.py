"""What an expression holds: the words in which passes ask about the nodes below it."""

from __future__ import annotations

from collections.abc import Callable, Iterable

from bondgraph.ir.expr import CONSTANTS, Expr, Op, Pool, below, topological


def holding(roots: Iterable[Expr], own: Callable[[Expr], bool]) -> dict[Expr, None]:
    """The nodes of which `own` is true, and all that are made of them, arguments first.

    >>> from bondgraph.ir.expr import Kind, Pool
    >>> p = Pool(); x, y = p.symbol("x", Kind.SENSOR), p.symbol("y", Kind.SENSOR)
    >>> list(holding([p.add((1, x), (2, p.mul(x, y)))], lambda node: node is y))
    [y, x*y, x + 2*x*y]
    """
    found: dict[Expr, None] = {}
    for node in topological(roots):
        if own(node) or any(a in found for a in node.args):
            found[node] = None
    return found


def occurs(wanted: Expr, *roots: Expr) -> bool:
    """Whether a node is one of the roots or below one of them."""
    return wanted in below(roots)


def has(roots: Iterable[Expr], *operations: Op) -> bool:
    """Whether one of the roots holds a node that does one of these operations."""
    return any(n.op in operations for n in below(roots))


def constant(expr: Expr, memo: dict[Expr, bool] | None = None) -> bool:
    """Whether an expression is made of parameters and numbers only: an integral grows with time.

    With a `memo` kept between calls, questions about parts of one large expression stay linear.
    """
    known = {} if memo is None else memo
    for node in topological([expr], stop=known.__contains__):
        if node not in known:
            own = node.kind in CONSTANTS if node.op is Op.SYM else node.op is not Op.INT
            known[node] = own and all(known[a] for a in node.args)
    return known[expr]


def rebuilt(
    pool: Pool, exprs: Iterable[Expr], rule: Callable[[Expr, tuple[Expr, ...]], Expr | None]
) -> list[Expr]:
    """The expressions made anew from the leaves up, each node as a rule makes it.

    The rule is told a node and its new arguments; where it gives None the node is rebuilt of these.

    >>> from bondgraph.ir.expr import Kind
    >>> p = Pool(); x, k = p.symbol("x", Kind.SENSOR), p.symbol("k", Kind.PARAM)
    >>> rebuilt(p, [p.der(p.mul(k, x))], lambda n, args: args[0] if n.op is Op.DER else None)
    [x*k]
    """
    exprs = list(exprs)
    new: dict[Expr, Expr] = {}
    for node in topological(exprs):
        args = tuple([new[a] for a in node.args])
        new[node] = rule(node, args) or pool.rebuild(node, args)
    return [new[e] for e in exprs]
