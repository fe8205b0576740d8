"""Arithmetic modulo a prime in which signs, roots and functions obey the laws they obey on reals.

The prime is 3 modulo 4, so that the Legendre symbol is a sign: sign(-x) = -sign(x), and every
square is positive. It is a safe prime, P = 2Q + 1 with Q prime, so that every rational power of a
positive number exists, is positive, and the laws of powers hold without exception. Transcendental
functions are random tables that keep the identities between them.
"""

from __future__ import annotations

from collections.abc import Callable
from fractions import Fraction
from random import Random

P = (1 << 61) - 2373
Q = (P - 1) // 2


class Undefined(ArithmeticError):
    """A value does not exist at this random point (1/0, root of a negative): draw another."""


def inverse(x: int) -> int:
    """1/x; raises `Undefined` for zero."""
    try:
        return pow(x, -1, P)
    except ValueError:
        raise Undefined("division by zero") from None


def sign(x: int) -> int:
    """The Legendre symbol as 1, 0 or -1 (multiplicative, and odd as P = 3 mod 4)."""
    power = pow(x, Q, P)
    return power if power < 2 else -1


def of_fraction(value: Fraction) -> int:
    """A rational number as field element; raises `Undefined` if P divides the denominator."""
    below = value.denominator
    if below == 1:
        return value.numerator % P
    found = _below.get(below)
    if found is None:
        found = _below[below] = inverse(below)
    return value.numerator * found % P


_below: dict[int, int] = {}  # inverses of denominators, which are few


def root(x: int, exponent: Fraction) -> int:
    """x**exponent for positive x, itself positive; of zero only a positive power.

    Raises `Undefined` for a negative x unless the exponent is an integer.
    """
    x %= P
    if exponent.denominator == 1:
        return pow(x, exponent.numerator, P) if x or exponent > 0 else inverse(0)
    if x == 0 and exponent > 0:
        return 0
    if sign(x) != 1:
        raise Undefined("a fractional power of a number that is not positive")
    return pow(x, exponent.numerator * pow(exponent.denominator, -1, Q) % Q, P)


_HALF = Fraction(1, 2)
_TWO = pow(2, -1, P)


def square_root(x: int) -> int:
    """The positive square root; raises `Undefined` for a negative x."""
    return root(x, _HALF)


class Functions:
    """The functions of the expression graph at field elements; random, the same for one seed.

    `exp` is a random bijection onto positive numbers with exp(-x) exp(x) = 1, `log` its inverse;
    cosh, sinh, tanh and their inverses follow from it by their definitions. sin and cos are a
    random point of the circle for each x with the right parity; tan and the inverse functions
    follow. A table has a random value and a random slope at each argument.
    """

    def __init__(self, seed: int) -> None:
        self.seed = seed
        self._random = Random(seed)
        self._exp: dict[int, int] = {0: 1}
        self._log: dict[int, int] = {1: 0}
        self._half_tangent: dict[int, int] = {0: 0}
        self._angle: dict[int, int] = {0: 0}
        self._tables: dict[tuple[str, int], tuple[int, int]] = {}
        #: solutions of equations by equation and arguments, see `bondgraph.exact.implicit`
        self.roots: dict[object, int] = {}

    def draw(self) -> int:
        """A random number, each time another."""
        return self._random.randrange(2, P - 1)

    def exp(self, x: int) -> int:
        """A positive number; exp(-x) = 1/exp(x)."""
        x %= P
        found = self._exp.get(x)
        if found is None:
            draw = self.draw()
            found = draw * draw % P
            self._pair_exp(x, found)
        return found

    def log(self, x: int) -> int:
        """The inverse of `exp`; raises `Undefined` for what is not positive."""
        x %= P
        found = self._log.get(x)
        if found is None:
            if sign(x) != 1:
                raise Undefined("the logarithm of a number that is not positive")
            found = self.draw()
            self._pair_exp(found, x)
        return found

    def _pair_exp(self, x: int, value: int) -> None:
        other = inverse(value)
        self._exp[x], self._exp[P - x] = value, other
        self._log[value], self._log[other] = x, P - x

    def circle(self, x: int) -> tuple[int, int]:
        """(cos x, sin x)."""
        x %= P
        t = self._half_tangent.get(x)
        if t is None:
            t = self.draw()
            self._pair_angle(x, t)
        scale = inverse(1 + t * t)
        return (1 - t * t) * scale % P, 2 * t * scale % P

    def angle(self, cosine: int, sine: int) -> int:
        """The x with these cos x and sin x."""
        t = sine * inverse(1 + cosine) % P
        found = self._angle.get(t)
        if found is None:
            found = self.draw()
            self._pair_angle(found, t)
        return found

    def _pair_angle(self, x: int, t: int) -> None:
        self._half_tangent[x], self._half_tangent[P - x] = t, P - t
        self._angle[t], self._angle[P - t] = x, P - x

    def hyperbola(self, x: int) -> tuple[int, int]:
        """(cosh x, sinh x)."""
        up = self.exp(x)
        down = inverse(up)
        return (up + down) * _TWO % P, (up - down) * _TWO % P

    def table(self, name: str, x: int) -> tuple[int, int]:
        """Value and slope of a table at x."""
        found = self._tables.get((name, x))
        if found is None:
            found = self._tables[name, x] = (self.draw(), self.draw())
        return found

    def force(self, name: str, x: int, value: int) -> None:
        """Let a function of `FORCED` or a table have a value at x.

        Raises `Undefined` where it has another one already, or cannot have this one.
        """
        x, value = x % P, value % P
        if name.startswith("table:"):
            if self._tables.setdefault((name, x), (value, self.draw()))[0] != value:
                raise Undefined("a table that has another value")
            return
        match name:
            case "exp":
                at, power = x, value
            case "log":
                at, power = value, x
            case "sinh":
                at, power = x, _positive(value, square_root(1 + value * value))
            case "asinh":
                at, power = value, _positive(x, square_root(1 + x * x))
            case "tanh":
                at, power = x, square_root((1 + value) * inverse(1 - value))
            case "atanh":
                at, power = value, square_root((1 + x) * inverse(1 - x))
            case "atan" | "tan":
                at, slope = (value, x) if name == "atan" else (x, value)
                cosine = inverse(square_root(1 + slope * slope))
                half = slope * cosine * inverse(1 + cosine) % P
                if self._half_tangent.get(at, half) != half or half in self._angle:
                    raise Undefined("an angle that has another tangent")
                self._pair_angle(at, half)
                return
            case _:
                raise Undefined(f"{name} cannot be given a value")
        if sign(power) != 1 or self._exp.get(at, power) != power or power in self._log:
            raise Undefined("an exponential that has another value")
        self._pair_exp(at, power)

    def value(self, name: str, x: int) -> int:
        """A function of one argument of `bondgraph.ir.expr.FUNCTIONS`, or `table:<id>`.

        Raises `Undefined` where the function has no value.
        """
        simple = _SIMPLE.get(name)
        if simple is not None:
            return simple(x % P) % P
        if name.startswith("table:"):
            return self.table(name, x % P)[0]
        return self._transcendental(name, x % P) % P

    def _transcendental(self, name: str, x: int) -> int:
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


def _positive(x: int, w: int) -> int:
    """The positive one of x + w and x - w, whose product is -1."""
    return (x + w) % P if sign(x + w) == 1 else (x - w) % P


def _signed_root(x: int) -> int:
    s = sign(x)
    return s * square_root(s * x)


def _cube_root(x: int) -> int:
    s = sign(x)
    return s * root(s * x, Fraction(1, 3))


_SIMPLE: dict[str, Callable[[int], int]] = {
    "abs": lambda x: sign(x) * x,
    "sign": sign,
    "sqrt": square_root,
    "cbrt": _cube_root,
    "ssqrt": _signed_root,
    "ssq": lambda x: sign(x) * x * x,
}

#: Functions that `Functions.force` can give a value.
FORCED = frozenset("exp log sinh asinh tanh atanh tan atan".split())

#: The function that undoes a function of one argument.
INVERSES = {
    "cbrt": "cube",
    "ssqrt": "ssq",
    "ssq": "ssqrt",
    "sqrt": "square",
    "exp": "log",
    "log": "exp",
    "sin": "asin",
    "cos": "acos",
    "tan": "atan",
    "asin": "sin",
    "acos": "cos",
    "atan": "tan",
    "sinh": "asinh",
    "cosh": "acosh",
    "tanh": "atanh",
    "asinh": "sinh",
    "acosh": "cosh",
    "atanh": "tanh",
}
