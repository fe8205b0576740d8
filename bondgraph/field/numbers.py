"""What the oracle asks of a kind of number: a prime field, or real numbers in balls.

Everything above writes `+`, `-` and `*` and leaves to the kind what differs: whether a number is
zero, what a function is, how a random number is drawn. Small whole numbers may stand beside both.
"""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from random import Random
from typing import Any, Protocol, TypeAlias

from bondgraph.text.tuples import NamedTuple

Number: TypeAlias = Any  # an element of the kind of numbers at hand, or a small whole number


class Undefined(ArithmeticError):
    """A value does not exist at this random point (1/0, root of a negative): draw another."""


class DividedByZero(Undefined):
    """1/0: at a random point a divisor is zero only where it is so all around the point."""


class Patch(NamedTuple):
    """What a table is near a point: f + (a u + b v + c u v)/(1 + d v) at arguments off by u, v."""

    f: Number
    a: Number
    b: Number = 0
    c: Number = 0
    d: Number = 0


class Numbers(Protocol):
    """A field with order and functions; operations raise `Undefined` where there is no value."""

    #: Whether these are the numbers of the machine, with all identities of functions.
    real: bool
    #: Solutions of equations that were found, see `bondgraph.exact.implicit_roots`.
    roots: dict[object, Number]

    def number(self, x: int) -> Number:
        """A whole number."""
        ...

    def fraction(self, value: int | Fraction) -> Number:
        """A rational number."""
        ...

    def reciprocal_of(self, k: int) -> Number:
        """1/k for a small positive integer."""
        ...

    def inverse(self, x: Number) -> Number:
        """1/x."""
        ...

    def nonzero(self, x: Number) -> bool:
        """Whether a number is not zero; decided, never guessed."""
        ...

    def sign(self, x: Number) -> int:
        """1, 0 or -1."""
        ...

    def power(self, x: Number, exponent: Fraction) -> Number:
        """x**exponent, positive for positive x; of zero only a positive power."""
        ...

    def value(self, name: str, x: Number) -> Number:
        """A function of one argument of `bondgraph.ir.functions.FUNCTIONS`."""
        ...

    def exp(self, x: Number) -> Number:
        """The exponential."""
        ...

    def log(self, x: Number) -> Number:
        """Its inverse."""
        ...

    def circle(self, x: Number) -> tuple[Number, Number]:
        """(cos x, sin x)."""
        ...

    def hyperbola(self, x: Number) -> tuple[Number, Number]:
        """(cosh x, sinh x)."""
        ...

    def angle(self, cosine: Number, sine: Number) -> Number:
        """The x with these cos x and sin x."""
        ...

    def table(self, name: str, args: list[Number]) -> Patch:
        """A table near some arguments."""
        ...

    def label(self, x: Number) -> object:
        """The same for equal numbers."""
        ...

    def any(self, random: Random) -> Number:
        """A random number, not zero: generic, and of a size that machines have."""
        ...

    def around(self, random: Random, value: Number) -> Number:
        """A random number that a parameter of this value may have instead."""
        ...

    def off(self, random: Random, value: Number, turn: bool, compared: bool) -> Number:
        """A parameter after a fault of any size; at a `turn` of the other sign.

        One that signals are `compared` with may be of their size instead.
        """
        ...

    def error(self, random: Random, value: Number, limits: Sequence[Number] = ()) -> Number:
        """What a reading of this value, or of about one, is wrong by: any of some decades.

        Where readings are compared with `limits`, it may also be across one of these.
        """
        ...

    def argument(
        self, random: Random, of: str, at: int, scales: list[float], beside: list[Number]
    ) -> Number:
        """A random argument number `at` for a function, of a size at which it matters.

        `of` is its name; `scales` are the sizes of numbers that the model has beside it, and
        `beside` the values of its other arguments, as far as they are known.
        """
        ...


#: The function that undoes a function of one argument, on its principal branch.
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

#: Functions with several branches: a parameter of the other sign may show where none else does.
CUT = frozenset({"sqrt", "pow", "log", "acosh", "asin", "acos", "atan"})
