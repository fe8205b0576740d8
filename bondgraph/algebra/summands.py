"""What an expression adds up, with the sums inside of sums."""

from __future__ import annotations

from fractions import Fraction

from bondgraph.ir.expr import Expr, Op


def summands(expr: Expr) -> dict[Expr, Fraction]:
    """What an expression adds up, sums inside of sums included, each with its coefficient.

    >>> from bondgraph.ir.expr import Kind, Pool
    >>> p = Pool(); a, b = p.symbol("a", Kind.PARAM), p.symbol("b", Kind.PARAM)
    >>> found = summands(p.add((1, a), (2, p.add((1, b), (3, a)))))
    >>> found[a], found[b]
    (Fraction(7, 1), Fraction(2, 1))
    """
    found: dict[Expr, Fraction] = {}
    stack = [(Fraction(1), expr)]
    while stack:
        factor, node = stack.pop()
        if node.op is Op.ADD:
            pairs = node.terms
            stack.extend((factor * c, a) for c, a in pairs)
        else:
            found[node] = found.get(node, Fraction(0)) + factor
    return {node: c for node, c in found.items() if c}
