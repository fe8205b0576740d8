"""Take parts that cancel out of expressions, and nothing else with them.

A part cancels where the value is the same whatever the part is, so that zero may stand for it: but
only where zero leaves every function its argument. log(k x) - log(k y) does not depend on k, yet
k = 0 makes it log(0) - log(0), in which the terms in x and y are lost as well; atan2(k x, k y)
would be atan2(0, 0). Such a part stays, and the value is right.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from bondgraph.algebra.zero import agree
from bondgraph.ir.expr import Expr, Op, Pool, topological

#: What may be given another argument: a product says itself where it divides by zero.
_TOTAL = (Op.ADD, Op.MUL, Op.DER, Op.INT, Op.IF)
_TRIED = 8  # parts that one may stand for; each costs a substitution


def without(
    pool: Pool,
    expr: Expr,
    parts: Iterable[Expr],
    others: Sequence[Expr] = (),
    number: Expr | None = None,
) -> list[Expr]:
    """The expression with zero for the parts, as far as every operation keeps its meaning.

    Its value must not depend on the parts. A part stays where zero for it would change the argument
    of a function or of a comparison, or stand below a fraction. The same parts are then taken out
    of the `others`, which follow in the result; one that would divide by zero stays as it is. A
    `number` may be given to stand for the parts in place of zero.

    >>> from bondgraph.ir.expr import Kind
    >>> p = Pool(); x, y, k = (p.symbol(n, Kind.SENSOR) for n in "xyk")
    >>> without(p, p.add((1, x), (1, p.add((1, y), (1, k))), (-1, k)), [k])
    [x + y]
    >>> without(p, p.sub(p.fn("log", p.mul(k, x)), p.fn("log", p.mul(k, y))), [k])
    [log(x*k) - log(y*k)]
    >>> without(p, p.div(k, p.add((1, x), (1, p.sub(p.mul(k, y), x)))), [k, x])
    [1/y]
    """
    left = {n: number or pool.zero for n in parts if n.op is not Op.NUM}
    while left:
        lost = _lost(*_apart(pool, expr, left))
        if lost and number is None:
            left, lost = _with_one(pool, expr, left, lost)
        if not lost:
            changed = _substituted(pool, [expr, *others], left)
            return [changed[e] or e for e in (expr, *others)]
        stay = {n for n in topological(lost) if n in left}
        left = {n: new for n, new in left.items() if n not in stay}
    return [expr, *others]


def _apart(
    pool: Pool, expr: Expr, left: dict[Expr, Expr]
) -> tuple[dict[Expr, Expr | None], dict[Expr, Expr | None]]:
    """The nodes of an expression after a substitution without those that were put in, and all."""
    changed = _substituted(pool, [expr], left)
    return {n: new for n, new in changed.items() if n not in left}, changed


def _with_one(
    pool: Pool, expr: Expr, left: dict[Expr, Expr], lost: list[Expr]
) -> tuple[dict[Expr, Expr], list[Expr]]:
    """One for parts that zero cannot stand for, where that loses nothing: m*x/(m*y) has x and y.

    Any number may stand for a part that cancels. Of those below what is lost the largest are tried.
    """
    below = [n for n in topological(lost, stop=left.__contains__) if n in left]
    trial = dict(left)
    for part in below[: -_TRIED - 1 : -1]:
        trial[part] = pool.one
        nodes, changed = _apart(pool, expr, trial)
        new = changed[expr]
        if new is not None and not _lost(nodes, changed) and agree([(expr, new)])[0]:
            return trial, []
    return left, lost


def _substituted(
    pool: Pool, exprs: Sequence[Expr], new: dict[Expr, Expr]
) -> dict[Expr, Expr | None]:
    """The nodes of the expressions after a substitution; None where one divides by zero."""
    done: dict[Expr, Expr | None] = {}
    for node in topological(exprs, stop=new.__contains__):
        if node in new:
            done[node] = new[node]
            continue
        args = [done[a] for a in node.args]
        known = tuple(a for a in args if a is not None)
        try:
            done[node] = pool.rebuild(node, known) if len(known) == len(args) else None
        except ZeroDivisionError:
            done[node] = None
    return done


def _lost(nodes: dict[Expr, Expr | None], changed: dict[Expr, Expr | None]) -> list[Expr]:
    """The nodes that lose their meaning: by a division, or by another argument of a function."""
    lost = [node for node, new in nodes.items() if new is None]
    functions = [n for n, new in nodes.items() if n.args and new and n.op not in _TOTAL]
    pairs = [(a, changed[a] or a) for n in functions for a in n.args]
    kept = agree(pairs)
    moved = {a for (a, _), same in zip(pairs, kept, strict=True) if not same}
    return lost + [n for n in functions if any(a in moved for a in n.args)]
