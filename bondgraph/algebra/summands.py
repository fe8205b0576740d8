"""What an expression adds up, with the sums inside of sums."""

from __future__ import annotations

from fractions import Fraction

from bondgraph.ir.expr import Expr, Op, topological


def summands(expr: Expr) -> dict[Expr, Fraction]:
    """What an expression adds up, sums inside of sums included, each with its coefficient.

    >>> from bondgraph.ir.expr import Kind, Pool
    >>> p = Pool(); a, b = p.symbol("a", Kind.PARAM), p.symbol("b", Kind.PARAM)
    >>> found = summands(p.add((1, a), (2, p.add((1, b), (3, a)))))
    >>> found[a], found[b]
    (Fraction(7, 1), Fraction(2, 1))
    """
    found = {expr: Fraction(1)}
    for node in reversed(topological([expr], stop=lambda n: n.op is not Op.ADD)):
        if node.op is Op.ADD:  # after all that it is a term of: once, however often it is one
            factor = found.pop(node)
            for c, arg in node.terms:
                found[arg] = found.get(arg, 0) + factor * c
    return {node: c for node, c in found.items() if c}
