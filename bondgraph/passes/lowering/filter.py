"""The first-order stage that all residuals are filtered with: its coefficients, its settling."""

from __future__ import annotations

from fractions import Fraction
from math import exp, factorial

from bondgraph.ir.program import Product, Ref
from bondgraph.passes.lowering.builder import Builder


class Filter:
    """The coefficients of one stage, and of the trapezoid rule, as constant expressions."""

    def __init__(self, builder: Builder) -> None:
        pool = builder.pool
        self.rate = builder.option("bandwidth")
        time = builder.option("sample_time")
        product = Product((Ref("option", "bandwidth"), Ref("option", "sample_time")))
        x = builder.local("x", product, "bandwidth*sample_time")
        a = pool.fn("exp", pool.neg(x))
        # 1 - (1 - exp(-x))/x loses digits where x is small: there its series
        series = pool.num(Fraction(1, 5040))
        for divisor in (720, 120, 24, 6, 2):
            series = pool.sub(pool.num(Fraction(1, divisor)), pool.mul(x, series))
        closed = pool.sub(pool.one, pool.div(pool.sub(pool.one, a), x))
        small = pool.compare("<", x, pool.num(Fraction(1, 8)))
        self.b0 = pool.choose(small, pool.mul(x, series), closed)
        self.a = a
        self.b1 = pool.add((1, pool.one), (-1, a), (-1, self.b0))
        self.rest = pool.sub(pool.one, self.b0)
        self.count = pool.mul(self.rate, self.rest)
        self.half = pool.scale(Fraction(1, 2), time)


def settle(stages: int, part: float = 1e-3) -> float:
    """Time constants after which a start away from rest has decayed to `part` of itself.

    The step response of n equal stages misses 1 by exp(-x) sum_{k<n} x**k/k!.
    """

    def missing(x: float) -> float:
        return exp(-x) * sum(x**k / factorial(k) for k in range(stages))

    low, high = 0.0, 10.0 + 4.0 * stages
    for _ in range(60):
        middle = (low + high) / 2
        low, high = (middle, high) if missing(middle) > part else (low, middle)
    return high
