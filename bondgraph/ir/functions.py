"""The functions of the language: one record each, with all that mathematics knows of it.

What passes ask of a function is asked here; a kind of number or a language has one table of values
or spellings beside it. The oracle has its own knowledge of functions: it checks what is made of
this one.
"""

from __future__ import annotations

from collections.abc import Callable
from fractions import Fraction
from math import inf, pi
from typing import Any

from bondgraph.text.tuples import NamedTuple


class Interval(NamedTuple):
    """Numbers from `low` to `high`; a bound that is `open` is met at single points at most."""

    low: float = -inf
    high: float = inf
    open_low: bool = True
    open_high: bool = True

    def holds(self, x: Fraction) -> bool:
        """Whether a number is in it, taking an open bound as outside."""
        above = self.low < x if self.open_low else self.low <= x
        return above and (x < self.high if self.open_high else x <= self.high)


ALL = Interval()
POSITIVE = Interval(0.0)
_FROM_ZERO = Interval(0.0, open_low=False)
_UNIT = Interval(0.0, 1.0)
_BETWEEN = Interval(-1.0, 1.0)
_ENDS = Interval(-1.0, 1.0, False, False)
_ABOVE_ONE = Interval(1.0)

#: The derivative by one argument, of a pool, the value and the arguments: as d|x|/dx = sign(x).
Slope = Callable[..., Any]


class Function(NamedTuple):
    """A real function of one or two arguments.

    `slopes` are its derivatives by the arguments, piece by piece. `values` and `rates` are the
    intervals that the value and the (first) slope keep to wherever the `domain` has its argument;
    both are given for functions of one argument that have them. `inverse` undoes a function that is
    one to one: a name, or the power to raise to. `integral` of f(x) dx is a number times a function
    of x. `zero` is f(0). `odd` is the g of f(x) = sign(x) g(|x|), a name or the power to raise to.
    `unit` is the power of its argument's unit that the value has, None for functions of pure
    numbers. A function `bends`, or jumps, where its argument is zero, or its arguments are equal.
    `spoken` is what mathematicians call it, and what a model may call it as well. `parity` is what
    f(-x) is times f(x), 0 where it is neither.
    """

    slopes: tuple[Slope, ...]
    unit: Fraction | None = None
    domain: Interval = ALL
    values: Interval = ALL
    rates: Interval | None = None
    inverse: str | int | None = None
    integral: tuple[Fraction, str] | None = None
    zero: int | None = None
    odd: str | int | None = None
    bends: bool = False
    spoken: str | None = None
    parity: int = 0

    @property
    def grows(self) -> bool:
        """Whether it is defined everywhere and grows strictly."""
        rates = self.rates
        return self.domain == ALL and rates is not None and rates.low >= 0 and rates.open_low


def _over_root(p: Any, square: Any) -> Any:
    return p.power(p.fn("sqrt", square), -1)


def _circle(p: Any, x: Any, y: Any) -> Any:
    return p.add((1, p.power(x, 2)), (1, p.power(y, 2)))


def _choice(which: str, first: int) -> Slope:
    """The slope of the smaller or the larger of two by the first or the second of them."""
    return lambda p, f, x, y: p.choose(p.compare(which, x, y), p.num(first), p.num(1 - first))


def _lowered(p: Any, x: Any, y: Any) -> Any:
    """x**(y - 1)."""
    return p.fn("pow", x, p.add(*y.terms, (-1, p.one)))


FUNCTIONS: dict[str, Function] = {
    "abs": Function(
        (lambda p, f, x: p.fn("sign", x),), Fraction(1), values=POSITIVE, rates=_ENDS,
        integral=(Fraction(1, 2), "ssq"), zero=0, bends=True, parity=1,
    ),
    "sign": Function(
        (lambda p, f, x: p.zero,), Fraction(0), values=_ENDS,
        rates=Interval(0.0, open_low=False), zero=0, bends=True, spoken="sgn", parity=-1,
    ),
    "sqrt": Function(
        (lambda p, f, x: p.scale(Fraction(1, 2), p.power(f, -1)),), Fraction(1, 2), _FROM_ZERO,
        POSITIVE, POSITIVE, inverse=2, zero=0,
    ),
    "cbrt": Function(
        (lambda p, f, x: p.scale(Fraction(1, 3), p.power(f, -2)),), Fraction(1, 3),
        rates=POSITIVE, inverse=3, zero=0, parity=-1,
    ),
    "ssqrt": Function(
        (lambda p, f, x: p.scale(Fraction(1, 2), p.power(p.fn("abs", f), -1)),), Fraction(1, 2),
        rates=POSITIVE, inverse="ssq", zero=0, odd="sqrt", parity=-1,
    ),
    "ssq": Function(
        (lambda p, f, x: p.scale(2, p.fn("abs", x)),), Fraction(2),
        rates=POSITIVE, inverse="ssqrt", zero=0, odd=2, parity=-1,
    ),
    "exp": Function(
        (lambda p, f, x: f,), values=POSITIVE, rates=POSITIVE, inverse="log",
        integral=(Fraction(1), "exp"), zero=1,
    ),
    "log": Function(
        (lambda p, f, x: p.power(x, -1),), domain=POSITIVE, rates=POSITIVE, inverse="exp",
        spoken="ln",
    ),
    "sin": Function(
        (lambda p, f, x: p.fn("cos", x),), values=_BETWEEN, rates=_BETWEEN,
        integral=(Fraction(-1), "cos"), zero=0, parity=-1,
    ),
    "cos": Function(
        (lambda p, f, x: p.neg(p.fn("sin", x)),), values=_BETWEEN, rates=_BETWEEN,
        integral=(Fraction(1), "sin"), zero=1, parity=1,
    ),
    "tan": Function((lambda p, f, x: p.add((1, p.one), (1, p.power(f, 2))),), zero=0, parity=-1),
    "asin": Function(
        (lambda p, f, x: _over_root(p, p.sub(p.one, p.power(x, 2))),), domain=_ENDS,
        values=Interval(-pi / 2, pi / 2), rates=_ABOVE_ONE, inverse="sin", zero=0,
        spoken="arcsin", parity=-1,
    ),
    "acos": Function(
        (lambda p, f, x: p.neg(_over_root(p, p.sub(p.one, p.power(x, 2)))),), domain=_ENDS,
        values=Interval(0.0, pi), rates=Interval(-inf, -1.0), spoken="arccos",
    ),
    "atan": Function(
        (lambda p, f, x: p.power(p.add((1, p.one), (1, p.power(x, 2))), -1),),
        values=Interval(-pi / 2, pi / 2), rates=_UNIT, inverse="tan", zero=0,
        spoken="arctan", parity=-1,
    ),
    "sinh": Function(
        (lambda p, f, x: p.fn("cosh", x),), rates=_ABOVE_ONE, inverse="asinh",
        integral=(Fraction(1), "cosh"), zero=0, parity=-1,
    ),
    "cosh": Function(
        (lambda p, f, x: p.fn("sinh", x),), values=_ABOVE_ONE, rates=ALL,
        integral=(Fraction(1), "sinh"), zero=1, parity=1,
    ),
    "tanh": Function(
        (lambda p, f, x: p.sub(p.one, p.power(f, 2)),), values=_BETWEEN, rates=_UNIT,
        inverse="atanh", zero=0, parity=-1,
    ),
    "asinh": Function(
        (lambda p, f, x: p.power(p.fn("cosh", f), -1),), rates=_UNIT, inverse="sinh", zero=0,
        parity=-1,
    ),
    "acosh": Function(
        (lambda p, f, x: _over_root(p, p.sub(p.power(x, 2), p.one)),),
        domain=Interval(1.0, open_low=False), values=POSITIVE, rates=POSITIVE,
    ),
    "atanh": Function(
        (lambda p, f, x: p.power(p.sub(p.one, p.power(x, 2)), -1),), domain=_BETWEEN,
        rates=_ABOVE_ONE, inverse="tanh", zero=0, parity=-1,
    ),
    "min": Function((_choice("<=", 1), _choice("<=", 0)), Fraction(1), bends=True),
    "max": Function((_choice(">=", 1), _choice(">=", 0)), Fraction(1), bends=True),
    "atan2": Function((
        lambda p, f, x, y: p.div(y, _circle(p, x, y)),
        lambda p, f, x, y: p.neg(p.div(x, _circle(p, x, y))),
    )),
    "pow": Function((
        lambda p, f, x, y: p.mul(y, _lowered(p, x, y)),
        lambda p, f, x, y: p.mul(f, p.fn("log", x)),
    )),
}  # fmt: skip

#: x |x|, as one function.
SIGNED_SQUARE = next(name for name, f in FUNCTIONS.items() if f.odd == 2)

#: The root of |x| with the sign of x.
SIGNED_ROOT = next(name for name, f in FUNCTIONS.items() if f.inverse == SIGNED_SQUARE)


def root(power: int) -> str | None:
    """The function that undoes a power of any number; an even power is that of two.

    >>> root(3), root(2)
    ('cbrt', None)
    """
    return next((name for name, f in FUNCTIONS.items() if f.inverse == power and f.grows), None)
