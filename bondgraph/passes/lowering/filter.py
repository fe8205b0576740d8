"""The first-order stage that all residuals are filtered with: its coefficients, its settling."""

from __future__ import annotations

from fractions import Fraction
from math import exp, factorial

from bondgraph.ir.expr import Expr
from bondgraph.ir.program import Product, Ref
from bondgraph.passes.lowering.builder import Builder

_STAGES = 20  # more than any residual has
_BRACKETS = 6  # inside each other, in what configure computes


class Filter:
    """The coefficients of one stage, and of the trapezoid rule, as constant expressions.

    `largest` is the largest bandwidth * sample_time that they are used for.
    """

    def __init__(self, builder: Builder, largest: float = 3.0) -> None:
        self._builder, self._largest = builder, largest
        self._series: list[Expr] = []
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
        self.pace = x

    # A memory y that n stages pass is y x**n/n! exp(-x) a sample later, x = wc T. An input that is
    # linear between samples, from v to w, adds up to the integral of (w - (w-v) s/x) s**q/q!
    # exp(-s) over s from 0 to x after q further stages. With E(n) = exp(x) - sum_{k<n} x**k/k!,
    # the integral of s**q/q! exp(-s) is exp(-x) E(q+1), and no small difference is ever formed.

    def left(self, q: int) -> Expr:
        """What is left of a memory at the next sample, `q` stages further."""
        pool = self._builder.pool
        return pool.mul(pool.num(Fraction(1, factorial(q))), pool.power(self.pace, q), self.a)

    def old(self, q: int) -> Expr:
        """The weight of the sample before, `q` stages further."""
        pool = self._builder.pool
        rest = pool.div(self._tail(q + 2), self.pace)
        return pool.mul(pool.num(q + 1), rest, self.a)

    def new(self, q: int) -> Expr:
        """The weight of the new sample, `q` stages further."""
        pool = self._builder.pool
        return pool.sub(pool.mul(self._tail(q + 1), self.a), self.old(q))

    def _tail(self, n: int) -> Expr:
        """exp(x) without the first n terms of its series."""
        pool, builder = self._builder.pool, self._builder
        if not self._series:  # E(n) = x**n/n! series[n], series[n] = 1 + x/(n+1) series[n+1]
            size, last = 1.0, _STAGES
            while size > 1e-18:
                last += 1
                size *= self._largest / last
            self._series = [pool.one] * last
            for k in range(last - 1, 0, -1):
                inner = pool.mul(self.pace, self._series[k])
                inner = pool.add((1, pool.one), (Fraction(1, k), inner))
                if k % _BRACKETS == 0:
                    value = builder.expression(inner)
                    inner = builder.local(f"series{k}", value, f"exp(x) from x^{k - 1} on")
                self._series[k - 1] = inner
        power = pool.power(self.pace, n)
        return pool.scale(Fraction(1, factorial(n)), pool.mul(power, self._series[n]))


def settle(stages: int, part: float = 1e-3) -> float:
    """Time constants after which a start away from rest has decayed to `part` of itself.

    The step response of n equal stages misses 1 by exp(-x) sum_{k<n} x**k/k!.
    """

    def missing(x: float) -> float:
        return exp(-x) * sum(x**k / factorial(k) for k in range(stages))

    low, high = 0.0, 10.0 + 4.0 * stages
    while missing(high) > part:
        low, high = high, 2.0 * high
    for _ in range(60):
        middle = (low + high) / 2
        low, high = (middle, high) if missing(middle) > part else (low, middle)
    return high
