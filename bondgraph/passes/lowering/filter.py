"""The first-order stage that all residuals are filtered with: its coefficients, its settling."""

from __future__ import annotations

from fractions import Fraction
from functools import cached_property
from math import exp, factorial

from bondgraph.ir.program import Expression, Product, Ref
from bondgraph.passes.lowering.builder import Builder

#: What is left of a start when a filter has settled, and when it counts as having forgotten.
USUAL, FORGOTTEN = 1e-3, 1e-8


class Filter:
    """The coefficients of one stage, and of the trapezoid rule, as constant expressions.

    The stage is y = s + b u, then s = a y + b u, with a = (2-x)/(2+x), b = (1-a)/2 and x =
    bandwidth * sample_time: 1/(1 + D/w) with the trapezoid rule D and w = bandwidth (Tustin, 1947).
    Above x = 2 it stays what it is there, the mean of two samples, for a filter that is faster than
    the samples rings. Where 1-a stands below it is of the a that is used, however few digits that
    has: a constant passes with factor 1, and D is the trapezoid rule to the last digit.

    Before a law with derivatives in it signals pass a faster one, `inner` (see there).
    """

    def __init__(self, builder: Builder, outer: Filter | None = None) -> None:
        pool = builder.pool
        self._builder = builder
        self.of = "" if outer is None else "law_"
        self.bandwidth = builder.option("bandwidth")
        time = builder.option("sample_time")
        if outer is None:
            product = Product((Ref("option", "bandwidth"), Ref("option", "sample_time")))
            self.pace = builder.local("x", product, "bandwidth*sample_time")
        else:
            faster = pool.fn("max", pool.scale(2, outer.pace), pool.fn("sqrt", outer.pace))
            doc = "x of the filter before laws, between the filter and the samples"
            self.pace = builder.local("law_x", builder.expression(faster), doc)
        two = pool.num(2)
        slow = pool.fn("max", pool.sub(two, self.pace), pool.zero)
        a = builder.expression(pool.div(slow, pool.add((1, two), (1, self.pace))))
        self.a = builder.local(f"{self.of}pole", a, "of a stage: what is left of its memory")
        past = pool.sub(pool.one, self.a)
        self.b = pool.scale(Fraction(1, 2), past)
        #: what a stage remembers of a constant 1.
        self.rest = pool.sub(pool.one, self.b)
        turn = pool.div(pool.scale(2, past), pool.add((1, pool.one), (1, self.a)))
        value = builder.expression(turn)
        self.turn = builder.local(f"{self.of}turn", value, "w*sample_time, x or 2")
        #: w in rad/s.
        rate = builder.expression(pool.div(self.turn, time))
        self.rate = builder.local(f"{self.of}w", rate, "w of the filter 1/(1 + D/w)")
        #: (w T)**2/12 and T**2/12, what D and the trapezoid rule are off by.
        self.bend = pool.scale(Fraction(1, 12), pool.power(self.turn, 2))
        self.twelfth = pool.scale(Fraction(1, 12), pool.power(time, 2))
        #: H D of an angle for one count of an encoder.
        self.count = pool.mul(self.rate, self.rest)
        self.half = pool.scale(Fraction(1, 2), time)
        self.half_twelfth = pool.scale(Fraction(1, 24), time)

    @cached_property
    def inner(self) -> Filter:
        """The filter that signals pass before a law that has derivatives of them in it.

        A law of filtered signals is not the filtered law: it is off by the square of their delay,
        and by all of the law where that is sharp, as friction is at rest. A law of noise is off by
        the square of the noise, which grows with the third power of the bandwidth for a speed. The
        geometric mean of the bandwidth and of the samples a second is between the two, at least
        twice the bandwidth (`law_pace`, docs/decisions/laws-of-derivatives.md). What comes out
        passes the filter as all else does.
        """
        return Filter(self._builder, self)

    def coefficients(self, builder: Builder) -> tuple[Expression, Expression]:
        """a and b of a stage."""
        of, told = self.of, "filter before laws" if self.of else "filter"
        return (
            builder.coef(self.a, f"{of}a", f"{told}: what is left of a memory a sample later"),
            builder.coef(self.b, f"{of}b", f"{told}: weight of a sample, new and a sample later"),
        )


def settle(stages: int, part: float = USUAL) -> float:
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
