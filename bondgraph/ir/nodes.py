"""What an expression holds: the words in which passes ask about the nodes below it."""

from __future__ import annotations

from collections.abc import Callable, Container, Iterable

from bondgraph.ir.expr import CONSTANTS, Expr, Kind, Op, Pool, Rational, below, topological
from bondgraph.text.tuples import NamedTuple


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


class LinearTerm(NamedTuple):
    """`coefficient` * `arg` * the `others`, each to its power."""

    coefficient: Rational
    arg: Expr
    others: tuple[tuple[Expr, int], ...]

    def factor(self, pool: Pool) -> Expr:
        """What `arg` is multiplied by."""
        powers = [pool.power(a, e) for a, e in self.others]
        return pool.scale(self.coefficient, pool.mul(*powers))

    def of(self, pool: Pool, x: Expr) -> tuple[Rational, Expr]:
        """The term with something else in the place of `arg`, as `Pool.add` takes it."""
        if not self.others:
            return self.coefficient, x
        return self.coefficient, pool.mul(x, *[pool.power(a, e) for a, e in self.others])


def linear_terms(node: Expr, moving: Container[Expr]) -> list[LinearTerm] | None:
    """The terms of a sum, or of a product that is linear in what moves in it; else None.

    >>> from bondgraph.ir.expr import Kind, Pool
    >>> p = Pool(); x, k = p.symbol("x", Kind.SENSOR), p.symbol("k", Kind.PARAM)
    >>> linear_terms(p.div(x, k), [x])
    [LinearTerm(coefficient=1, arg=x, others=((k, -1),))]
    """
    if node.op is Op.ADD:
        return [LinearTerm(c, a, ()) for c, a in node.terms]
    if node.op is not Op.MUL:
        return None
    inside = [(a, e) for a, e in node.factors if a in moving]
    if len(inside) != 1 or inside[0][1] != 1:
        return None
    arg = inside[0][0]
    return [LinearTerm(1, arg, tuple([(a, e) for a, e in node.factors if a is not arg]))]


def first_degree(expr: Expr, variables: Container[Expr], choices: bool) -> bool:
    """Whether an expression is of the first degree in some variables taken together.

    With `choices` between such too, as long as the variables decide nothing.
    """
    holders = holding([expr], variables.__contains__)
    return all(
        node in variables
        or linear_terms(node, holders) is not None
        or (choices and node.op is Op.IF and node.args[0] not in holders)
        for node in holders
    )


def decided(condition: Expr) -> bool:
    """Whether boolean inputs alone decide a condition."""
    return all(
        n.op in (Op.NUM, Op.LOGIC) or n.kind is Kind.MODE for n in topological([condition])
    )


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
