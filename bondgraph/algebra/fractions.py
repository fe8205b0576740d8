"""Polynomials in one unknown whose coefficients are expressions, shared and never expanded.

SymPy gives nicer results while they are small; these are what is left to do where an expansion in
all parameters would not fit. Whether a coefficient is zero is asked at random points.
"""

from __future__ import annotations

from collections.abc import Callable

from bondgraph.algebra.zero import is_zero, share_factor
from bondgraph.ir.expr import Expr, Op, Pool, topological
from bondgraph.text.tuples import NamedTuple

Coefficients = list[Expr]  # of the unknown's powers from 0 up

_MOST = 1 << 40
_DEGREE = 8  # of equations for one unknown


def monomials(exprs: list[Expr], leaves: set[Expr] | None = None) -> int:
    """About how many terms the expressions have when they are expanded, `leaves` being symbols.

    >>> from bondgraph.ir.expr import Kind
    >>> p = Pool(); a, b = p.symbol("a", Kind.PARAM), p.symbol("b", Kind.PARAM)
    >>> monomials([p.power(p.add((1, a), (1, b)), 3)])
    8
    """
    stop = leaves or set()
    count: dict[Expr, int] = {}
    for node in topological(exprs, stop=stop.__contains__):
        if node in stop or node.op not in (Op.ADD, Op.MUL):
            count[node] = 1
        elif node.op is Op.ADD:
            count[node] = min(_MOST, sum(count[a] for a in node.args))
        else:
            total = 1
            for a, e in node.factors:
                total = min(_MOST, total * count[a] ** min(abs(e), 40))
            count[node] = total
    return sum(count[e] for e in exprs)


# ------------------------------------------------------------------------------ polynomials


def trimmed(polynomial: Coefficients) -> Coefficients:
    """Without leading coefficients that are identically zero."""
    size = len(polynomial)
    while size and is_zero(polynomial[size - 1]):
        size -= 1
    return polynomial[:size]


def divided(pool: Pool, a: Coefficients, b: Coefficients) -> tuple[Coefficients, Coefficients]:
    """Quotient and remainder of two trimmed polynomials."""
    rest, quotient = list(a), [pool.zero] * max(0, len(a) - len(b) + 1)
    for shift in reversed(range(len(quotient))):
        factor = pool.div(rest[shift + len(b) - 1], b[-1])
        quotient[shift] = factor
        for k, c in enumerate(b[:-1]):
            rest[shift + k] = pool.sub(rest[shift + k], pool.mul(factor, c))
    return quotient, trimmed(rest[: len(b) - 1])


def without_common_divisor(
    pool: Pool, a: Coefficients, b: Coefficients, vanishes: Callable[[Expr], bool]
) -> tuple[Coefficients, Coefficients]:
    """Both polynomials divided by their greatest common divisor, by Euclid's algorithm.

    As they are, where that would divide by a coefficient that `vanishes` at the nominal values.

    >>> from bondgraph.ir.expr import Kind
    >>> p = Pool(); x = p.symbol("x", Kind.PARAM)
    >>> square, line = [p.mul(x, x), p.scale(2, x), p.one], [x, p.one]
    >>> left, right = without_common_divisor(p, square, line, lambda _: False)
    >>> left == [x, p.one], right == [p.one]
    (True, True)
    """
    one, other = trimmed(a), trimmed(b)
    while other:
        if vanishes(other[-1]):
            return a, b
        one, other = other, divided(pool, one, other)[1]
    if len(one) < 2:
        return a, b
    return divided(pool, trimmed(a), one)[0], divided(pool, trimmed(b), one)[0]


# ----------------------------------------------------------------------------- one equation


class _Fraction(NamedTuple):
    """A polynomial over powers of others."""

    top: Coefficients
    below: dict[tuple[Expr, ...], int]


def only_root(pool: Pool, zero: Expr, variable: Expr) -> Expr | None:
    """The value of a variable in an equation of sums, products and quotients, if it is one only.

    >>> from bondgraph.ir.expr import Kind
    >>> p = Pool(); f, a = p.symbol("f", Kind.FLOW), p.symbol("a", Kind.PARAM)
    >>> only_root(p, p.sub(p.div(f, p.add((1, p.one), (1, f))), a), f)
    a/(1 - a)
    """
    work = _Work(pool, variable)
    fraction = work.fraction(zero)
    if fraction is None:
        return None
    top = trimmed(fraction.top)
    if len(top) != 2 or any(share_factor(top, list(factor)) for factor in fraction.below):
        return None
    return pool.neg(pool.div(top[0], top[1]))


class _Work:
    def __init__(self, pool: Pool, variable: Expr) -> None:
        self.pool = pool
        self.variable = variable

    def fraction(self, zero: Expr) -> _Fraction | None:
        """The expression as one fraction in the variable; None where its degree is too high."""
        found: dict[Expr, _Fraction] = {
            self.variable: _Fraction([self.pool.zero, self.pool.one], {})
        }
        for node in topological([zero]):
            if node in found or not any(a in found for a in node.args):
                continue
            parts = [found.get(a) or _Fraction([a], {}) for a in node.args]
            if node.op is Op.ADD:
                value = self.sum(node, parts)
            elif node.op is Op.MUL:
                value = self.product(node, parts)
            else:
                return None
            if len(value.top) > _DEGREE:
                return None
            found[node] = value
        return found.get(zero)

    def sum(self, node: Expr, parts: list[_Fraction]) -> _Fraction:
        below: dict[tuple[Expr, ...], int] = {}
        for part in parts:
            for factor, power in part.below.items():
                below[factor] = max(below.get(factor, 0), power)
        total: Coefficients = []
        for c, part in zip(node.coefficients, parts, strict=True):
            top = part.top
            for factor, power in below.items():
                for _ in range(power - part.below.get(factor, 0)):
                    top = self.times(top, list(factor))
            size = max(len(total), len(top))
            left = total + [self.pool.zero] * (size - len(total))
            right = top + [self.pool.zero] * (size - len(top))
            total = [self.pool.add((1, x), (c, y)) for x, y in zip(left, right, strict=True)]
        return _Fraction(total, below)

    def product(self, node: Expr, parts: list[_Fraction]) -> _Fraction:
        top: Coefficients = [self.pool.one]
        below: dict[tuple[Expr, ...], int] = {}
        for part, power in zip(parts, node.exponents, strict=True):
            if len(part.top) == 1 and not part.below:
                constant = self.pool.power(part.top[0], power)
                top = [self.pool.mul(c, constant) for c in top]
                continue
            up = (
                [part.top]
                if power > 0
                else [list(f) for f, e in part.below.items() for _ in range(e)]
            )
            down = part.below if power > 0 else {tuple(part.top): 1}
            for _ in range(abs(power)):
                for factor in up:
                    top = self.times(top, factor)
            for name, count in down.items():
                below[name] = below.get(name, 0) + count * abs(power)
        return _Fraction(top, below)

    def times(self, a: Coefficients, b: Coefficients) -> Coefficients:
        terms: list[list[Expr]] = [[] for _ in range(len(a) + len(b) - 1)]
        for i, x in enumerate(a):
            for j, y in enumerate(b):
                terms[i + j].append(self.pool.mul(x, y))
        return [self.pool.add(*[(1, t) for t in ts]) for ts in terms]
