"""Power series of time with 50 digits: functions that can be multiplied, inverted, integrated."""

from __future__ import annotations

from collections.abc import Callable
from fractions import Fraction

import mpmath

mpmath.mp.dps = 50
LENGTH = 16
Number = int | Fraction | mpmath.mpf


def _number(x: Number) -> mpmath.mpf:
    return mpmath.mpf(x.numerator) / x.denominator if isinstance(x, Fraction) else mpmath.mpf(x)


class Series:
    """c0 + c1 t + c2 t^2 + ...; a derivative knows one coefficient less than its function."""

    def __init__(self, coefficients: list[Number]) -> None:
        self.c = [_number(x) for x in coefficients]

    @staticmethod
    def of(x: Series | Number) -> Series:
        return x if isinstance(x, Series) else Series([x, *[0] * (LENGTH - 1)])

    def _pair(self, other: Series | Number) -> tuple[list[mpmath.mpf], list[mpmath.mpf]]:
        one, two = self.c, Series.of(other).c
        n = min(len(one), len(two))
        return one[:n], two[:n]

    def __add__(self, other: Series | Number) -> Series:
        return Series([a + b for a, b in zip(*self._pair(other), strict=True)])

    def __neg__(self) -> Series:
        return Series([-a for a in self.c])

    def __sub__(self, other: Series | Number) -> Series:
        return self + (-Series.of(other))

    def __rsub__(self, other: Number) -> Series:
        return -self + other

    def __mul__(self, other: Series | Number) -> Series:
        a, b = self._pair(other)
        return Series([mpmath.fsum(a[i] * b[n - i] for i in range(n + 1)) for n in range(len(a))])

    def __truediv__(self, other: Series | Number) -> Series:
        a, b = self._pair(other)
        out: list[mpmath.mpf] = []
        for n in range(len(a)):
            out.append((a[n] - mpmath.fsum(out[i] * b[n - i] for i in range(n))) / b[0])
        return Series(list(out))

    def __rtruediv__(self, other: Number) -> Series:
        return Series.of(other) / self

    def __pow__(self, exponent: Number) -> Series:
        n = int(exponent)
        out = Series.of(1)
        for _ in range(abs(n)):
            out = out * self
        return out if n >= 0 else 1 / out

    __radd__ = __add__
    __rmul__ = __mul__

    def composed(self, outer: Callable[[mpmath.mpf, int], list[mpmath.mpf]]) -> Series:
        """f(self), where `outer` gives the Taylor coefficients of f at a point."""
        inner = Series([0, *self.c[1:]])
        out = Series.of(0)
        for coefficient in reversed(outer(self.c[0], len(self.c))):
            out = out * inner + Series.of(coefficient)
        return Series(list(out.c[: len(self.c)]))


t = Series([0, 1, *[0] * (LENGTH - 2)])


def d(x: Series | Number, order: Number = 1) -> Series:
    """The time derivative of an order."""
    out = Series.of(x)
    for _ in range(int(order)):
        out = Series([n * a for n, a in enumerate(out.c)][1:])
    return out


def since_start(x: Series | Number, start: Series | Number = 0) -> Series:
    """The integral from time zero, plus its initial value."""
    whole = Series.of(x)
    first = start.c[0] if isinstance(start, Series) else start
    return Series([first, *[a / (n + 1) for n, a in enumerate(whole.c)]][: len(whole.c)])


def sqrt(x: Series) -> Series:
    return x.composed(lambda at, n: mpmath.taylor(mpmath.sqrt, at, n - 1))


def sin(x: Series) -> Series:
    return x.composed(lambda at, n: mpmath.taylor(mpmath.sin, at, n - 1))


def cos(x: Series) -> Series:
    return x.composed(lambda at, n: mpmath.taylor(mpmath.cos, at, n - 1))


def tanh(x: Series) -> Series:
    return x.composed(lambda at, n: mpmath.taylor(mpmath.tanh, at, n - 1))


def sign(x: Series) -> int:
    assert x.c[0] != 0
    return 1 if x.c[0] > 0 else -1


def magnitude(x: Series) -> Series:
    return sign(x) * x


def ssqrt(x: Series) -> Series:
    return sign(x) * sqrt(magnitude(x))
