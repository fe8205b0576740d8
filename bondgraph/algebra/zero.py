"""Decide whether expressions are identically zero, equal or a number, by values at two points.

The points are random ones of a prime field; see `bondgraph.field.random_point`.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from fractions import Fraction
from math import gcd

from flint import nmod_poly

from bondgraph.field.prime import P
from bondgraph.field.random_point import RandomPoint
from bondgraph.ir.expr import Expr

_LARGEST = 2**28  # numerator and denominator of a number that is recognised


def is_zero(expr: Expr) -> bool:
    """Whether `expr` vanishes identically; a division by zero at both points counts as not zero.

    >>> from bondgraph.ir.expr import Pool, Kind
    >>> p = Pool(); a = p.symbol("a", Kind.PARAM); b = p.symbol("b", Kind.PARAM)
    >>> square = p.power(p.add((1, a), (1, b)), 2)
    >>> cross = p.add((1, p.power(a, 2)), (2, p.mul(a, b)), (1, p.power(b, 2)))
    >>> is_zero(p.sub(square, cross))
    True
    """
    return all(RandomPoint(seed).value(expr) == 0 for seed in (1, 2))


def agree(pairs: Sequence[tuple[Expr, Expr]]) -> list[bool]:
    """Whether two expressions are identically equal, for each of the pairs, in one pass over all.

    Errs towards "not equal", as `is_zero` does; one that divides by zero at a point equals itself.

    >>> from bondgraph.ir.expr import Pool, Kind
    >>> p = Pool(); a = p.symbol("a", Kind.PARAM); b = p.symbol("b", Kind.PARAM)
    >>> agree([(p.add((2, p.add((1, a), (1, b))), (-2, b)), p.scale(2, a)), (a, b)])
    [True, False]
    """
    told = [(one, other) for one, other in pairs if one is not other]
    same = dict.fromkeys(told, True)
    for seed in (1, 2):
        point = RandomPoint(seed)
        for one, other in told:
            value = point.value(one)
            same[one, other] &= value is not None and value == point.value(other)
    return [one is other or same[one, other] for one, other in pairs]


def share_factor(a: list[Expr], b: list[Expr]) -> bool:
    """Whether two polynomials (coefficients from the constant up) have a common factor.

    Of their values at a random point; a division by zero there counts as yes.
    """
    point = RandomPoint(3)
    one, other = ([x for c in p if (x := point.value(c)) is not None] for p in (a, b))
    if (len(one), len(other)) != (len(a), len(b)):
        return True
    return bool(nmod_poly(one, P).gcd(nmod_poly(other, P)).degree() > 0)


class Constants:
    """What coefficients are whatever the parameters are; values are kept, for one shares another.

    `given` are the expressions of which some symbols have the values.
    """

    def __init__(self, given: Mapping[Expr, Expr] | None = None) -> None:
        self._points = [RandomPoint(seed, given) for seed in (1, 2)]

    def vanishes(self, expr: Expr) -> bool:
        """Whether a coefficient is exactly zero."""
        return all(point.value(expr) == 0 for point in self._points)

    def number(self, expr: Expr) -> Fraction | None:
        """The number that a coefficient always is, if it is one, neither large nor fine.

        >>> from bondgraph.ir.expr import Pool, Kind
        >>> p = Pool(); a = p.symbol("a", Kind.PARAM)
        >>> Constants().number(p.div(p.add((3, a), (3, p.one)), p.add((7, a), (7, p.one))))
        Fraction(3, 7)
        """
        one, other = (point.value(expr) for point in self._points)
        return None if one is None or one != other else _rational(one)


def _rational(value: int) -> Fraction | None:
    """The small fraction that is `value` modulo the prime (Wang 1981), if there is one."""
    r0, r1, t0, t1 = P, value, 0, 1
    while r1 > _LARGEST:
        quotient = r0 // r1
        r0, r1, t0, t1 = r1, r0 - quotient * r1, t1, t0 - quotient * t1
    if t1 == 0 or abs(t1) > _LARGEST or gcd(r1, abs(t1)) != 1:
        return None
    return Fraction(r1, t1)
