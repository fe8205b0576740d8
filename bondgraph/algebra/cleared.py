"""Multiply a relation through with what it divides by, so that it holds where that is zero.

The relation is kept as a fraction and only its numerator is left: (N/m)' becomes N' m - N m'.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from bondgraph.algebra.powers import undivided
from bondgraph.algebra.summands import summands
from bondgraph.ir.expr import Expr, Op, Pool, topological
from bondgraph.ir.nodes import constant

Denominator = dict[Expr, int]


def divisors(nodes: Iterable[Expr]) -> list[Expr]:
    """What some nodes divide by, once for each that does."""
    return [arg for item in nodes for arg, exponent in item.factors if exponent < 0]


def below_terms(expr: Expr) -> list[Expr]:
    """The signals that whole terms of a relation are divided by.

    >>> from bondgraph.ir.expr import Kind
    >>> p = Pool(); U, y = p.symbol("U", Kind.INPUT), p.symbol("y", Kind.SENSOR)
    >>> below_terms(p.add((1, p.div(U, y)), (1, p.der(p.div(y, U)))))
    [y]
    """
    return [base for base in divisors(summands(expr)) if not constant(base)]


def cleared(pool: Pool, expr: Expr, bases: Iterable[Expr], inside: bool = True) -> Expr:
    """The numerator of a relation, as far as its denominators are among the `bases`.

    If not `inside`, whole terms are multiplied, and a quotient that is part of one stays.

    >>> from bondgraph.ir.expr import Kind
    >>> p = Pool(); U, y, m = (p.symbol(n, Kind.INPUT) for n in ("U", "y", "m"))
    >>> cleared(p, p.sub(U, p.div(y, m)), [m])
    U*m - y
    >>> cleared(p, p.sub(U, p.der(p.div(y, m))), [m])
    U*m^2 - (m*D(y) - y*D(m))
    >>> cleared(p, p.sub(p.div(U, p.sub(m, p.div(U, y))), m), [p.sub(m, p.div(U, y)), y])
    U*y - m*(y*m - U)
    >>> cleared(p, p.sub(p.div(U, m), p.der(p.div(y, m))), [m], inside=False)
    U - m*D(y/m)
    """
    work = _Fractions(pool, dict.fromkeys(bases))
    for node in topological([expr], stop=lambda n: not inside and n.op is not Op.ADD):
        work.visit(node)
    if expr not in work.parts:
        return expr
    found, below = work.parts[expr]
    for base in below if inside else ():
        found = undivided(pool, found, base)
    return found


class _Fractions:
    """Numerator and denominator of the nodes that hold one of the bases as a divisor."""

    def __init__(self, pool: Pool, bases: dict[Expr, None]) -> None:
        self.pool = pool
        self.bases = bases
        self.parts: dict[Expr, tuple[Expr, Denominator]] = {}

    def visit(self, node: Expr) -> None:
        if node.op is Op.MUL:
            self.product(node)
            return
        if not any(a in self.parts for a in node.args):
            return
        if node.op is Op.ADD:
            terms, below = self.common(node.args)
            sum_ = self.pool.add(*zip(node.coefficients, terms, strict=True))
            self.parts[node] = sum_, below
        elif node.op is Op.DER:
            self.parts[node] = self.derivative(*self.parts[node.args[0]])
        elif node.op is Op.IF and node.args[0] not in self.parts:
            (yes, no), below = self.common(node.args[1:])
            self.parts[node] = self.pool.choose(node.args[0], yes, no), below
        # inside a function or an integral a quotient stays one

    def product(self, node: Expr) -> None:
        if not any(
            a in self.parts or (e < 0 and a in self.bases)
            for a, e in node.factors
        ):
            return
        factors: list[Expr] = []
        below: Denominator = {}
        for arg, exponent in node.factors:
            upper, lower = self.parts.get(arg, (arg, {}))
            if arg in self.bases:  # which may be a fraction itself
                lower = {**lower, upper: lower.get(upper, 0) - 1}
            else:
                factors.append(self.pool.power(upper, exponent))
            for base, power in lower.items():
                below[base] = below.get(base, 0) + power * exponent
        factors += [self.pool.power(b, -k) for b, k in below.items() if k < 0]
        self.parts[node] = self.pool.mul(*factors), {b: k for b, k in below.items() if k > 0}

    def common(self, args: Sequence[Expr]) -> tuple[list[Expr], Denominator]:
        """The numerators over the least common denominator."""
        split = [self.parts.get(a, (a, {})) for a in args]
        below: Denominator = {}
        for _, lower in split:
            for base, power in lower.items():
                below[base] = max(below.get(base, 0), power)
        out = []
        for upper, lower in split:
            lift = [self.pool.power(b, k - lower.get(b, 0)) for b, k in below.items()]
            out.append(self.pool.mul(upper, *lift))
        return out, below

    def derivative(self, upper: Expr, lower: Denominator) -> tuple[Expr, Denominator]:
        """(N / prod b^k)' = (N' prod b - N sum k b' prod of the other b) / prod b^(k+1)."""
        pool = self.pool
        terms = [(1, pool.mul(pool.der(upper), *lower))]
        for base, power in lower.items():
            others = [b for b in lower if b is not base]
            terms.append((-power, pool.mul(upper, pool.der(base), *others)))
        return pool.add(*terms), {b: k + 1 for b, k in lower.items()}
