"""Exact questions about coefficients, answered by their values at random points of a prime field.

A coefficient that is zero at two random points modulo 2**61 - 1 is zero but for a chance of
degree/2**61 each (Schwartz 1980, Zippel 1979). A function of parameters counts as a free variable
of its own, so a zero that rests on an identity of functions is not seen: the term is then kept.
"""

from __future__ import annotations

import math
import random
from fractions import Fraction

from bondgraph.ir.expr import Expr, Op, topological

PRIME = 2**61 - 1
_POINTS = 2
_LARGEST = 2**28  # numerator and denominator of a number that is recognised

Point = tuple[int, ...]


class Field:
    """Values of coefficients at random points; `zero` is the name of a symbol that is zero."""

    def __init__(self, zero: str | None = None) -> None:
        self._zero = zero
        self._values: dict[Expr, Point | None] = {}

    def value(self, node: Expr) -> Point | None:
        """The values at the points, None where a division by zero was met."""
        for n in topological([node], stop=self._values.__contains__):
            if n not in self._values:
                self._values[n] = self._compute(n)
        return self._values[node]

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

    def _compute(self, node: Expr) -> Point | None:
        if node.op is Op.NUM:
            q = node.number
            return (q.numerator * pow(q.denominator, -1, PRIME) % PRIME,) * _POINTS
        if node.op is Op.SYM:
            if node.symbol.name == self._zero:
                return (0,) * _POINTS
            return _draw("symbol", node.symbol.name)
        args = [self._values[a] for a in node.args]
        known = [a for a in args if a is not None]
        if len(known) < len(args):
            return None
        if node.op is Op.ADD:
            weights = [c.numerator * pow(c.denominator, -1, PRIME) for c in node.coefficients]
            return tuple(
                sum(w * a[i] for w, a in zip(weights, known, strict=True)) % PRIME
                for i in range(_POINTS)
            )
        if node.op is Op.MUL:
            if any(e < 0 and 0 in a for a, e in zip(known, node.exponents, strict=True)):
                return None
            out = [1] * _POINTS
            for a, e in zip(known, node.exponents, strict=True):
                out = [o * pow(x, e, PRIME) % PRIME for o, x in zip(out, a, strict=True)]
            return tuple(out)
        data = node.root.zero.id if node.op is Op.ROOT else node.data
        return _draw(node.op.value, data, *known)


def _draw(*key: object) -> Point:
    """Numbers that depend on the key alone (a text seed does not depend on the hash seed)."""
    source = random.Random(repr(key))
    return tuple(source.randrange(1, PRIME) for _ in range(_POINTS))


def _rational(value: int) -> Fraction | None:
    """The small fraction that is `value` modulo the prime (Wang 1981), if there is one."""
    r0, r1, t0, t1 = PRIME, value, 0, 1
    while r1 > _LARGEST:
        quotient = r0 // r1
        r0, r1, t0, t1 = r1, r0 - quotient * r1, t1, t0 - quotient * t1
    if t1 == 0 or abs(t1) > _LARGEST or math.gcd(r1, abs(t1)) != 1:
        return None
    return Fraction(r1, t1)
