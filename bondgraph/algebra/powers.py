"""An expression as a polynomial in one of its parts."""

from __future__ import annotations

from collections.abc import Sequence

from bondgraph.algebra.summands import summands
from bondgraph.algebra.zero import is_zero
from bondgraph.ir.expr import Expr, Op, Pool, topological

_DEGREE = 12  # of polynomials that are written out


def powers(
    pool: Pool, expr: Expr, base: Expr, most: int = _DEGREE, whole: bool = True
) -> list[Expr] | None:
    """The coefficients of the powers from 0 on; None beyond a degree, or below a fraction.

    The base may stand nowhere else, as in a function; if not `whole`, what it stands in so is a
    coefficient like any other.

    >>> from bondgraph.ir.expr import Kind
    >>> p = Pool(); x, y = p.symbol("x", Kind.INPUT), p.symbol("y", Kind.SENSOR)
    >>> powers(p, p.sub(p.mul(y, p.power(x, 2)), x), x)
    [0, -1, y]
    >>> powers(p, p.mul(x, p.der(x)), x), powers(p, p.mul(x, p.der(x)), x, whole=False)
    (None, [0, D(x)])
    """
    forms: dict[Expr, list[Expr]] = {base: [pool.zero, pool.one]}
    nodes = topological([expr], stop=lambda n: n is base or n.op not in (Op.ADD, Op.MUL))
    for node in nodes:
        if node is not base and node.op not in (Op.ADD, Op.MUL):
            if whole and base in topological([node]):
                return None
            continue
        if node is base or not any(a in forms for a in node.args):
            continue
        own = [forms.get(a) or [a] for a in node.args]
        if node.op is Op.ADD:
            weighted = list(zip(node.coefficients, own, strict=True))
            found = [pool.add(*[(c, x[k]) for c, x in weighted if k < len(x)])
                     for k in range(max(map(len, own)))]  # fmt: skip
        else:
            found = [pool.one]
            for arg, part, power in zip(node.args, own, node.exponents, strict=True):
                if arg not in forms:
                    found = [pool.mul(x, pool.power(arg, power)) for x in found]
                    continue
                if power < 0 or (len(part) - 1) * power > most:
                    return None
                for _ in range(power):
                    found = _product(pool, found, part)
        while len(found) > 1 and found[-1] is pool.zero:
            found.pop()
        if len(found) > most + 1:
            return None
        forms[node] = found
    return forms.get(expr) or [expr]


def _product(pool: Pool, a: Sequence[Expr], b: Sequence[Expr]) -> list[Expr]:
    terms: list[list[tuple[int, Expr]]] = [[] for _ in range(len(a) + len(b) - 1)]
    for i, x in enumerate(a):
        for j, y in enumerate(b):
            terms[i + j].append((1, pool.mul(x, y)))
    return [pool.add(*own) for own in terms]


def undivided(pool: Pool, expr: Expr, base: Expr) -> Expr:
    """The expression without the powers of a base that all of it can be divided by.

    >>> from bondgraph.ir.expr import Kind
    >>> p = Pool(); x, y = p.symbol("x", Kind.INPUT), p.symbol("y", Kind.SENSOR)
    >>> square = p.power(p.add((1, x), (1, y)), 2)
    >>> undivided(p, p.sub(square, p.power(y, 2)), x)
    x + 2*y
    """
    found = powers(pool, expr, base, whole=False)
    if found is None or not is_zero(found[0]):
        return expr
    lowest = next((k for k, x in enumerate(found) if not is_zero(x)), 0)
    if not lowest:
        return expr
    flat = [pool.add(*[(c, term) for term, c in summands(x).items()]) for x in found[lowest:]]
    return pool.add(*[(1, pool.mul(x, pool.power(base, k))) for k, x in enumerate(flat)])
