"""Truncated power series: a list of Taylor coefficients of any kind of number, missing ones zero.

Functions follow the recurrences of automatic differentiation (Griewank and Walther, 2008, ch. 13),
quadratic in the number of coefficients. `n` is the number of coefficients wanted throughout, `f`
the kind of the numbers.
"""

from __future__ import annotations

from fractions import Fraction
from operator import mul as _times
from typing import TypeAlias

from bondgraph.field.numbers import Number, Numbers, Undefined

Series: TypeAlias = list[Number]


def scale(c: Number, a: Series) -> Series:
    """A number times a series."""
    return [c * x for x in a]


def add(a: Series, b: Series) -> Series:
    """The sum."""
    if len(a) < len(b):
        a, b = b, a
    out = a.copy()
    for i, x in enumerate(b):
        out[i] = out[i] + x
    return out


def mul(a: Series, b: Series, n: int) -> Series:
    """The product."""
    if len(a) > len(b):
        a, b = b, a
    size = len(a)
    if size == 1:
        c = a[0]
        return [c * x for x in b[:n]] if c else [0]
    length = len(b)
    backwards = b[::-1]
    out = []
    for k in range(min(n, size + length - 1)):
        low = k - length + 1 if k >= length else 0
        high = k + 1 if k < size else size
        shift = length - 1 - k
        out.append(sum(map(_times, a[low:high], backwards[shift + low : shift + high])))
    return out


def reciprocal(f: Numbers, a: Series, n: int) -> Series:
    """1/a; raises `Undefined` if a(0) = 0."""
    first = f.inverse(a[0])
    if len(a) == 1:
        return [first]
    out = [first]
    for k in range(1, n):
        top = min(k, len(a) - 1)
        total = sum(map(_times, a[1 : top + 1], out[k - top : k][::-1]))
        out.append(-total * first)
    return out


def power(f: Numbers, a: Series, exponent: int, n: int) -> Series:
    """An integer power; raises `Undefined` for a negative one where a(0) = 0."""
    if exponent == 1:
        return a
    base = a if exponent > 0 else reciprocal(f, a, n)
    out = base
    for bit in bin(abs(exponent))[3:]:
        out = mul(out, out, n)
        if bit == "1":
            out = mul(out, base, n)
    return out if exponent else [1]


def derivative(a: Series) -> Series:
    """The time derivative; one coefficient shorter."""
    return [k * x for k, x in enumerate(a[1:], 1)] or [0]


def integral(f: Numbers, a: Series, start: Number) -> Series:
    """The integral that begins at `start`."""
    return [start, *[x * f.reciprocal_of(k) for k, x in enumerate(a, 1)]]


def moves(f: Numbers, a: Series) -> bool:
    """Whether a series is not zero in any of its coefficients."""
    return any(map(f.nonzero, a))


def _power_from(f: Numbers, a: Series, exponent: Number, start: Number, n: int) -> Series:
    """The series y with y(0) = start and a y' = exponent a' y."""
    out = [start]
    if len(a) == 1:
        return out
    first = f.inverse(a[0])
    for k in range(1, n):
        total = 0
        for j in range(1, min(k, len(a) - 1) + 1):
            total += (exponent * j - k + j) * a[j] * out[k - j]
        out.append(total * first * f.reciprocal_of(k))
    return out


def rational_power(f: Numbers, a: Series, exponent: Fraction, n: int) -> Series:
    """a**exponent, positive for positive a; raises `Undefined` where it does not exist."""
    if exponent.denominator == 1:
        return power(f, a, exponent.numerator, n)
    if exponent > 0 and not moves(f, a):
        return [0]
    return _power_from(f, a, f.fraction(exponent), f.power(a[0], exponent), n)


_HALF = Fraction(1, 2)


def _two(
    f: Numbers, start: tuple[Number, Number], a: Series, sigma: int, n: int
) -> tuple[Series, Series]:
    """(c, s) with c' = sigma s a', s' = c a': cos and sin for sigma = -1, cosh and sinh for 1."""
    c, s = [start[0]], [start[1]]
    weighted = [k * x for k, x in enumerate(a)]
    for k in range(1, n if len(a) > 1 else 1):
        top = min(k, len(a) - 1)
        part = weighted[1 : top + 1]
        inv = f.reciprocal_of(k)
        next_c = sigma * sum(map(_times, part, s[k - top : k][::-1])) * inv
        s.append(sum(map(_times, part, c[k - top : k][::-1])) * inv)
        c.append(next_c)
    return c, s


def exponential(f: Numbers, a: Series, start: Number, n: int) -> Series:
    """The series y with y(0) = start and y' = a' y."""
    out = [start]
    weighted = [k * x for k, x in enumerate(a)]
    for k in range(1, n if len(a) > 1 else 1):
        top = min(k, len(a) - 1)
        total = sum(map(_times, weighted[1 : top + 1], out[k - top : k][::-1]))
        out.append(total * f.reciprocal_of(k))
    return out


def _circle(f: Numbers, a: Series, n: int) -> tuple[Series, Series]:
    return _two(f, f.circle(a[0]), a, -1, n)


def _hyperbola(f: Numbers, a: Series, n: int) -> tuple[Series, Series]:
    return _two(f, f.hyperbola(a[0]), a, 1, n)


def _sign_of(f: Numbers, a: Series) -> int:
    """The sign at the point and around it; raises `Undefined` where the series passes zero."""
    s = f.sign(a[0])
    if s == 0 and moves(f, a):
        raise Undefined("the sign of a signal that passes zero")
    return s


def _side_of(f: Numbers, a: Series) -> int:
    """The sign just after the point, for functions that are continuous at zero."""
    return f.sign(next((x for x in a if f.nonzero(x)), 0))


def _root_from_rest(f: Numbers, a: Series, exponent: Fraction, n: int) -> Series:
    """A root of a signal that is positive just after the point, and may be zero there.

    Raises `Undefined` where the root is no power series.
    """
    start = next(k for k, x in enumerate(a) if f.nonzero(x))
    if start * exponent.numerator % exponent.denominator:
        raise Undefined("the root of a signal that passes zero")
    shift = start * exponent.numerator // exponent.denominator
    return ([0] * shift + rational_power(f, a[start:], exponent, n))[:n]


def function(f: Numbers, name: str, a: Series, n: int) -> Series:
    """A function of one argument; raises `Undefined` where it has no value."""
    match name:
        case "abs":
            return scale(_side_of(f, a), a)
        case "sign":
            return [_sign_of(f, a)]
        case "ssq":
            return scale(_side_of(f, a), mul(a, a, n))
        case "sqrt":
            return rational_power(f, a, _HALF, n)
        case "ssqrt" | "cbrt":
            s = _side_of(f, a)
            exponent = _HALF if name == "ssqrt" else Fraction(1, 3)
            return scale(s, _root_from_rest(f, scale(s, a), exponent, n)) if s else [0]
        case "exp":
            return exponential(f, a, f.exp(a[0]), n)
        case "cos" | "sin":
            return _circle(f, a, n)[name == "sin"]
        case "cosh" | "sinh":
            return _hyperbola(f, a, n)[name == "sinh"]
        case "tan":
            below, above = _circle(f, a, n)
            return mul(above, reciprocal(f, below, n), n)
    if name.startswith("table:"):
        return table(f, name, [a], n)[0]
    if name == "tanh":
        return _tanh(f, a, n)
    start = f.value(name, a[0])
    if len(a) == 1:
        return [start]
    return integral(f, mul(slope_of(f, name, a, [start], n), derivative(a), n), start)[:n]


def _tanh(f: Numbers, a: Series, n: int) -> Series:
    """The series y with y' = (1 - y^2) a'; cosh may be too large for a number."""
    out = [f.value("tanh", a[0])]
    weighted = [k * x for k, x in enumerate(a)]
    slope: Series = [1 - out[0] * out[0]]
    for k in range(1, n if len(a) > 1 else 1):
        top = min(k, len(a) - 1)
        total = sum(map(_times, weighted[1 : top + 1], slope[k - top : k][::-1]))
        out.append(total * f.reciprocal_of(k))
        slope.append(-sum(map(_times, out, reversed(out))))
    return out


def slope_of(f: Numbers, name: str, a: Series, value: Series, n: int) -> Series:
    """The derivative of a function at the series a, where the function is `value`."""
    match name:
        case "abs":
            return [_side_of(f, a)]
        case "sign":
            return [0]
        case "ssq":
            return scale(2 * _side_of(f, a), a)
        case "sqrt":
            return reciprocal(f, scale(2, value), n)
        case "ssqrt":
            return reciprocal(f, scale(2 * _side_of(f, value), value), n)
        case "cbrt":
            return reciprocal(f, scale(3, mul(value, value, n)), n)
        case "exp":
            return value
        case "log":
            return reciprocal(f, a, n)
        case "sin":
            return _circle(f, a, n)[0]
        case "cos":
            return scale(-1, _circle(f, a, n)[1])
        case "sinh" | "cosh":
            return _hyperbola(f, a, n)[name == "cosh"]
        case "tan":
            return add([1], mul(value, value, n))
        case "tanh":
            return add([1], scale(-1, mul(value, value, n)))
    if name.startswith("table:"):
        return table(f, name, [a], n)[1]
    return _slope_of_inverse(f, name, a, value[0], n)


def _slope_of_inverse(f: Numbers, name: str, a: Series, value: Number, n: int) -> Series:
    square = mul(a, a, n)
    minus = scale(-1, square)
    half = -f.reciprocal_of(2)
    match name:
        case "atan":
            return reciprocal(f, add([1], square), n)
        case "atanh":
            return reciprocal(f, add([1], minus), n)
        case "asin":
            start = f.inverse(f.circle(value)[0])
            return _power_from(f, add([1], minus), half, start, n)
        case "acos":
            start = f.inverse(f.circle(value)[1])
            return scale(-1, _power_from(f, add([1], minus), half, start, n))
        case "asinh":
            start = f.inverse(f.hyperbola(value)[0])
            return _power_from(f, add([1], square), half, start, n)
        case "acosh":
            start = f.inverse(f.hyperbola(value)[1])
            return _power_from(f, add([-1], square), half, start, n)
    raise KeyError(name)


def table(f: Numbers, name: str, args: list[Series], n: int) -> list[Series]:
    """A table of one or two arguments, and its slopes by them."""
    p = f.table(name, [a[0] for a in args])
    u, v = [[0, *a[1:n]] for a in (*args, [0])[:2]]
    by_u = add([p.a], scale(p.c, v))
    moved = add(mul(by_u, u, n), scale(p.b, v))
    by_v = add([p.b], scale(p.c, u))
    if f.nonzero(p.d):
        below = reciprocal(f, add([1], scale(p.d, v)), n)
        by_u, moved = mul(by_u, below, n), mul(moved, below, n)
        by_v = mul(add(by_v, scale(-p.d, moved)), below, n)
    return [add([p.f], moved), by_u, by_v][: 1 + len(args)]


# ------------------------------------------------------------ functions of two arguments


def function_of_two(f: Numbers, name: str, a: Series, b: Series, n: int) -> Series:
    """`pow`, `min`, `max`, `atan2` or a table; raises `Undefined` where it has no value."""
    if name.startswith("table:"):
        return table(f, name, [a, b], n)[0]
    match name:
        case "pow":
            exponent = mul(b, function(f, "log", a, n), n)
            return exponential(f, exponent, f.exp(exponent[0]), n)
        case "min" | "max":
            return a if takes_first(f, name, a, b) else b
        case "atan2":
            square = add(mul(a, a, n), mul(b, b, n))
            radius = f.inverse(f.power(square[0], _HALF))
            start = f.angle(b[0] * radius, a[0] * radius)
            if len(a) == len(b) == 1:
                return [start]
            turn = add(mul(b, derivative(a), n), scale(-1, mul(a, derivative(b), n)))
            return integral(f, mul(turn, reciprocal(f, square, n), n), start)[:n]
    raise KeyError(name)


def takes_first(f: Numbers, name: str, a: Series, b: Series) -> bool:
    """Whether `min` or `max` of two series is the first of them."""
    return (f.sign(b[0] - a[0]) >= 0) == (name == "min")


def slopes_of_two(
    f: Numbers, name: str, a: Series, b: Series, value: Series, n: int
) -> tuple[Series, Series]:
    """The two partial derivatives of a function of two arguments."""
    if name.startswith("table:"):
        _, by_a, by_b = table(f, name, [a, b], n)
        return by_a, by_b
    match name:
        case "pow":
            inner = mul(b, mul(value, reciprocal(f, a, n), n), n)
            return inner, mul(value, function(f, "log", a, n), n)
        case "min" | "max":
            return ([1], [0]) if takes_first(f, name, a, b) else ([0], [1])
        case "atan2":
            square = reciprocal(f, add(mul(a, a, n), mul(b, b, n)), n)
            return mul(b, square, n), scale(-1, mul(a, square, n))
    raise KeyError(name)
