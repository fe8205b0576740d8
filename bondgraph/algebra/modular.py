"""Exact questions about coefficients, answered by their values at random points of a prime field.

A coefficient that is zero at two random points modulo 2**61 - 1 is zero but for a chance of
degree/2**61 each (Schwartz 1980, Zippel 1979). A function of parameters counts as a free variable
of its own, so a zero that rests on an identity of functions is not seen: the term is then kept.
"""

from __future__ import annotations

import math
from fractions import Fraction

from bondgraph.algebra.zero import PRIME, random_point
from bondgraph.ir.expr import Expr

_POINTS = 2
_LARGEST = 2**28  # numerator and denominator of a number that is recognised

Point = tuple[int, ...]


class Field:
    """Values of coefficients at random points; `zero` is the name of a symbol that is zero."""

    def __init__(self, zero: str | None = None) -> None:
        self._points = [random_point(f"modular {k}", zero) for k in range(_POINTS)]

    def value(self, node: Expr) -> Point | None:
        """The values at the points, None where a division by zero was met."""
        found = [x for point in self._points if (x := point.value(node)) is not None]
        return tuple(found) if len(found) == _POINTS else None

    def vanishes(self, node: Expr) -> bool:
        """Whether the coefficient is exactly zero."""
        value = self.value(node)
        return value is not None and not any(value)

    def number(self, node: Expr) -> Fraction | None:
        """The number that the coefficient is whatever the parameters are, if it is one."""
        value = self.value(node)
        if value is None or len(set(value)) != 1:
            return None
        return _rational(value[0])


def _rational(value: int) -> Fraction | None:
    """The small fraction that is `value` modulo the prime (Wang 1981), if there is one."""
    r0, r1, t0, t1 = PRIME, value, 0, 1
    while r1 > _LARGEST:
        quotient = r0 // r1
        r0, r1, t0, t1 = r1, r0 - quotient * r1, t1, t0 - quotient * t1
    if t1 == 0 or abs(t1) > _LARGEST or math.gcd(r1, abs(t1)) != 1:
        return None
    return Fraction(r1, t1)
