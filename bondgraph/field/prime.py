"""Arithmetic modulo a prime in which signs, roots and functions obey the laws they obey on reals.

The prime is 3 modulo 4, so that the Legendre symbol is a sign: sign(-x) = -sign(x), and every
square is positive. It is a safe prime, P = 2Q + 1 with Q prime, so that every rational power of a
positive number exists, is positive, and the laws of powers hold without exception. Transcendental
functions are random tables that keep the identities between them.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from fractions import Fraction
from random import Random
from typing import Any

from flint import nmod

from bondgraph.field.numbers import DividedByZero, Number, Patch, Undefined

P = (1 << 61) - 2373
Q = (P - 1) // 2

ZERO, ONE = nmod(0, P), nmod(1, P)


def inverse(x: Number) -> Number:
    """1/x; raises `DividedByZero` for zero."""
    try:
        return ONE / x
    except ZeroDivisionError:
        raise DividedByZero("division by zero") from None


def sign(x: Number) -> int:
    """The Legendre symbol as 1, 0 or -1 (multiplicative, and odd as P = 3 mod 4)."""
    power = pow(int(x), Q, P)
    return power if power < 2 else -1


def of_fraction(value: int | Fraction) -> Number:
    """A rational number as field element; raises `Undefined` if P divides the denominator."""
    return nmod(value.numerator, P) * inverse(value.denominator)


def root(x: Number, exponent: Fraction) -> Number:
    """x**exponent for positive x, itself positive; of zero only a positive power.

    Raises `Undefined` for a negative x unless the exponent is an integer.
    """
    x = ONE * x
    if exponent.denominator == 1:
        return x**exponent.numerator if x or exponent > 0 else inverse(0)
    if not x and exponent > 0:
        return x
    if sign(x) != 1:
        raise Undefined("a fractional power of a number that is not positive")
    return x ** (exponent.numerator * pow(exponent.denominator, -1, Q) % Q)


_HALF = Fraction(1, 2)
_TWO = inverse(2)


def square_root(x: Number) -> Number:
    """The positive square root; raises `Undefined` for a negative x."""
    return root(x, _HALF)


class PrimeField:
    """The functions of the expression graph at field elements; random, the same for one seed.

    `exp` is a random bijection onto positive numbers with exp(-x) exp(x) = 1, `log` its inverse;
    cosh, sinh, tanh and their inverses follow from it by their definitions. sin and cos are a
    random point of the circle for each x with the right parity; tan and the inverse functions
    follow. A table has a random value and a random slope at each argument.
    """

    real = False
    nonzero = staticmethod(bool)
    inverse = staticmethod(inverse)
    sign = staticmethod(sign)
    fraction = staticmethod(of_fraction)
    power = staticmethod(root)

    def __init__(self, seed: int) -> None:
        self.seed = seed
        self._random = Random(seed)
        self._exp: dict[Number, Number] = {ZERO: ONE}
        self._log: dict[Number, Number] = {ONE: ZERO}
        self._half_tangent: dict[Number, Number] = {ZERO: ZERO}
        self._angle: dict[Number, Number] = {ZERO: ZERO}
        self._tables: dict[tuple[Any, ...], Patch] = {}
        self.roots: dict[object, Number] = {}

    def draw(self) -> Number:
        """A random number, each time another."""
        return nmod(self._random.randrange(2, P - 1), P)

    def number(self, x: int) -> Number:
        """A whole number."""
        return nmod(x, P)

    def reciprocal_of(self, k: int) -> Number:
        """1/k for a small positive integer."""
        while len(_reciprocals) <= k:
            _reciprocals.append(inverse(len(_reciprocals)))
        return _reciprocals[k]

    def label(self, x: Number) -> object:
        """The number itself."""
        return int(x)

    def any(self, random: Random) -> Number:
        """A random number, not zero."""
        return nmod(random.randrange(1, P), P)

    def around(self, random: Random, value: Number) -> Number:
        """A random number: nothing is near anything in a field."""
        return self.any(random)

    def off(self, random: Random, value: Number, turn: bool, compared: bool) -> Number:
        """A random number."""
        return self.any(random)

    def error(self, random: Random, value: Number, limits: Sequence[Number] = ()) -> Number:
        """A random number."""
        return self.any(random)

    def argument(
        self, random: Random, of: str, at: int, scales: list[float], beside: list[Number]
    ) -> Number:
        """A random number."""
        return self.any(random)

    def exp(self, x: Number) -> Number:
        """A positive number; exp(-x) = 1/exp(x)."""
        x = ONE * x
        found = self._exp.get(x)
        if found is None:
            draw = self.draw()
            found = draw * draw
            self._pair_exp(x, found)
        return found

    def log(self, x: Number) -> Number:
        """The inverse of `exp`; raises `Undefined` for what is not positive."""
        x = ONE * x
        found = self._log.get(x)
        if found is None:
            if sign(x) != 1:
                raise Undefined("the logarithm of a number that is not positive")
            found = self.draw()
            self._pair_exp(found, x)
        return found

    def _pair_exp(self, x: Number, value: Number) -> None:
        other = inverse(value)
        self._exp[x], self._exp[-x] = value, other
        self._log[value], self._log[other] = x, -x

    def circle(self, x: Number) -> tuple[Number, Number]:
        """(cos x, sin x)."""
        x = ONE * x
        t = self._half_tangent.get(x)
        if t is None:
            t = self.draw()
            self._pair_angle(x, t)
        scale = inverse(1 + t * t)
        return (1 - t * t) * scale, 2 * t * scale

    def angle(self, cosine: Number, sine: Number) -> Number:
        """The x with these cos x and sin x."""
        t = sine * inverse(1 + cosine)
        found = self._angle.get(t)
        if found is None:
            found = self.draw()
            self._pair_angle(found, t)
        return found

    def _pair_angle(self, x: Number, t: Number) -> None:
        self._half_tangent[x], self._half_tangent[-x] = t, -t
        self._angle[t], self._angle[-t] = x, -x

    def hyperbola(self, x: Number) -> tuple[Number, Number]:
        """(cosh x, sinh x)."""
        up = self.exp(x)
        down = inverse(up)
        return (up + down) * _TWO, (up - down) * _TWO

    def table(self, name: str, args: list[Number]) -> Patch:
        """A table near some arguments; one of two is a random bilinear one."""
        key = (name, *[ONE * x for x in args])
        found = self._tables.get(key)
        if found is None:
            found = self._tables[key] = Patch(*[self.draw() for _ in range(2 ** len(args))])
        return found

    def value(self, name: str, x: Number) -> Number:
        """A function of one argument of `bondgraph.ir.functions.FUNCTIONS`.

        Raises `Undefined` where the function has no value.
        """
        x = ONE * x
        simple = _SIMPLE.get(name)
        if simple is not None:
            return simple(x)
        return self._transcendental(name, x)

    def _transcendental(self, name: str, x: Number) -> Number:
        match name:
            case "exp":
                return self.exp(x)
            case "log":
                return self.log(x)
            case "cos" | "sin":
                return self.circle(x)[name == "sin"]
            case "tan":
                cosine, sine = self.circle(x)
                return sine * inverse(cosine)
            case "asin":
                return self.angle(square_root(1 - x * x), x)
            case "acos":
                return self.angle(x, square_root(1 - x * x))
            case "atan":
                cosine = inverse(square_root(1 + x * x))
                return self.angle(cosine, x * cosine)
            case "cosh" | "sinh":
                return self.hyperbola(x)[name == "sinh"]
            case "tanh":
                cosh, sinh = self.hyperbola(x)
                return sinh * inverse(cosh)
            case "asinh":
                # of y + w and y - w, whose product is -1, exactly one is positive
                return self.log(_positive(x, square_root(1 + x * x)))
            case "acosh":
                found = self.log(x + square_root(x * x - 1))
                return found if sign(found) >= 0 else -found
            case "atanh":
                return self.log(square_root((1 + x) * inverse(1 - x)))
        raise KeyError(name)


_reciprocals: list[Number] = [ZERO]  # of small whole numbers


def _positive(x: Number, w: Number) -> Number:
    """The positive one of x + w and x - w, whose product is -1."""
    return x + w if sign(x + w) == 1 else x - w


def _signed_root(x: Number) -> Number:
    s = sign(x)
    return s * square_root(s * x)


def _cube_root(x: Number) -> Number:
    s = sign(x)
    return s * root(s * x, Fraction(1, 3))


_SIMPLE: dict[str, Callable[[Number], Number]] = {
    "abs": lambda x: sign(x) * x,
    "sign": lambda x: ONE * sign(x),
    "sqrt": square_root,
    "cbrt": _cube_root,
    "ssqrt": _signed_root,
    "ssq": lambda x: sign(x) * x * x,
}
