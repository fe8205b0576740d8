"""Real numbers as balls: a midpoint, and a radius that bounds every rounding error (Arb).

A ball that leaves out zero proves that a number is not zero. One that holds zero and is smaller
than any quantity a model could mean settles that it is; a larger one asks for more digits
(Johansson, 2017). Random numbers have the sizes at which a machine's laws do something: a function
is asked near one, a table within its points, a decision near the numbers of its model.
"""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Callable, Mapping, Sequence
from fractions import Fraction
from itertools import pairwise
from random import Random

from flint import arb, ctx, fmpq

from bondgraph.field.numbers import DividedByZero, Number, Patch, Undefined
from bondgraph.ir.tables import Rows, backwards, columns, knots

#: A ball around zero of at most this radius is zero: 2**-256 is 1e-77.
NOTHING = arb(2) ** -256
_LARGEST = 100_000  # an exponential of more has no meaning on a machine
_MOST_BITS = 1 << 13


class Imprecise(Undefined):
    """A ball too large to say whether it is zero; what comes next has more digits."""


class Precision:
    """The digits that all numbers of one plant have: more as soon as they were too few."""

    def __init__(self) -> None:
        self.bits = 512

    def more(self) -> Exception:
        """What to raise where the digits are too few."""
        if self.bits >= _MOST_BITS:
            return Undefined("a number that no digits tell from zero")
        self.bits *= 2
        ctx.prec = max(ctx.prec, self.bits)
        return Imprecise("a number that needs more digits")


class Reals:
    """The real numbers and the functions of the expression graph."""

    real = True

    def __init__(
        self, tables: Mapping[str, Rows], precision: Precision | None = None, scale: float = 1.0
    ) -> None:
        self._scale = scale  # of random signals
        self._tables = tables
        self._precision = precision or Precision()
        self.roots: dict[object, Number] = {}
        self._reciprocals: list[Number] = [arb(0)]
        ctx.prec = max(ctx.prec, self._precision.bits)

    # --------------------------------------------------------------------------- arithmetic

    def number(self, x: int) -> Number:
        """A whole number."""
        return arb(x)

    def fraction(self, value: int | Fraction) -> Number:
        """A rational number."""
        return arb(fmpq(value.numerator, value.denominator))

    def reciprocal_of(self, k: int) -> Number:
        """1/k for a small positive integer."""
        while len(self._reciprocals) <= k:
            self._reciprocals.append(arb(1) / len(self._reciprocals))
        return self._reciprocals[k]

    def nonzero(self, x: Number) -> bool:
        """Whether a number is not zero; raises `Imprecise` where the ball is too large to say."""
        if x != 0:
            return True
        if not x:
            return False
        if arb(x).rad() < NOTHING:
            return False
        raise self._precision.more()

    def inverse(self, x: Number) -> Number:
        """1/x; raises `DividedByZero` for zero."""
        if not self.nonzero(x):
            raise DividedByZero("division by zero")
        return arb(1) / x

    def sign(self, x: Number) -> int:
        """1, 0 or -1."""
        if not self.nonzero(x):
            return 0
        return 1 if x > 0 else -1

    def power(self, x: Number, exponent: Fraction) -> Number:
        """x**exponent for positive x; of zero only a positive power."""
        if exponent.denominator == 1:
            power = exponent.numerator
            return arb(x) ** power if power > 0 else self.inverse(x) ** -power
        side = self.sign(x)
        if side == 0 and exponent > 0:
            return arb(0)
        if side != 1:
            raise Undefined("a fractional power of a number that is not positive")
        if exponent.denominator == 2:
            return arb(x).sqrt() ** exponent.numerator
        return self.exp(arb(x).log() * self.fraction(exponent))

    # ---------------------------------------------------------------------------- functions

    def exp(self, x: Number) -> Number:
        """The exponential; raises `Undefined` where it is beyond any meaning."""
        if not abs(arb(x)) < _LARGEST:
            raise Undefined("an exponential that is too large")
        return arb(x).exp()

    def log(self, x: Number) -> Number:
        """The logarithm of a positive number."""
        if self.sign(x) != 1:
            raise Undefined("the logarithm of a number that is not positive")
        return arb(x).log()

    def circle(self, x: Number) -> tuple[Number, Number]:
        """(cos x, sin x)."""
        sine, cosine = arb(x).sin_cos()
        return cosine, sine

    def hyperbola(self, x: Number) -> tuple[Number, Number]:
        """(cosh x, sinh x)."""
        if not abs(arb(x)) < _LARGEST:
            raise Undefined("an exponential that is too large")
        sine, cosine = arb(x).sinh_cosh()
        return cosine, sine

    def angle(self, cosine: Number, sine: Number) -> Number:
        """The x from -pi to pi with these cos x and sin x."""
        return arb.atan2(arb(sine), arb(cosine))

    def table(self, name: str, args: list[Number]) -> Patch:
        """A table near some arguments: straight between its knots, constant beyond its ends.

        One that is read backwards has no value from its ends on: it could be any.
        """
        name = name.removeprefix("table:")
        rows = self._tables[name]
        first, *second = [list(map(self.fraction, numbers)) for numbers in knots(rows)]
        values = [list(map(self.fraction, line)) for line in zip(*columns(rows), strict=True)]
        across = self._weights(second[0], args[1]) if second else [(0, 1, 0)]
        low = [sum(w * z[j] for j, w, _ in across) for z in values]
        lean = [sum(s * z[j] for j, _, s in across) for z in values]
        x, ends = args[0], first
        if backwards(name) and second:
            order = range(len(first)) if low[0] < low[-1] else range(len(first) - 1, -1, -1)
            first, low, lean = ([of[i] for i in order] for of in (first, low, lean))
            ends = low
        if backwards(name) and [self.sign(x - ends[k]) for k in (0, -1)] != [1, -1]:
            raise Undefined("a table read backwards from its ends on")
        along = self._weights(ends, x)
        heights = first if ends is low else low
        f, a = (sum(weight[k] * heights[weight[0]] for weight in along) for k in (1, 2))
        b, c = (sum(weight[k] * lean[weight[0]] for weight in along) for k in (1, 2))
        if ends is low:  # from z = f + a u + b v + c u v, where a, b, c are those of the map itself
            return Patch(f, a, -a * b, 0, c)
        return Patch(f, a, b, c)

    def _weights(self, numbers: list[Number], x: Number) -> list[tuple[int, Number, Number]]:
        """The knots around x, how much each counts there, and how fast that grows with x."""
        at = bisect_right(numbers, 0, key=lambda knot: -self.sign(x - knot))
        if at in (0, len(numbers)):
            return [(min(at, len(numbers) - 1), 1, 0)]
        slope = self.inverse(numbers[at] - numbers[at - 1])
        share = (x - numbers[at - 1]) * slope
        return [(at - 1, 1 - share, -slope), (at, share, slope)]

    def value(self, name: str, x: Number) -> Number:
        """A function of one argument; raises `Undefined` where it has no value."""
        return _FUNCTIONS[name](self, arb(x))

    def label(self, x: Number) -> object:
        """The number to twelve digits."""
        return f"{float(x):.12g}"

    # ------------------------------------------------------------------------ random numbers

    def any(self, random: Random) -> Number:
        """A signal of about the scale, of either sign."""
        return arb(random.choice((-1, 1)) * random.lognormvariate(0, 0.7) * self._scale)

    def around(self, random: Random, value: Number) -> Number:
        """A value within a factor of two, or within one of zero."""
        if self.nonzero(value):
            return value * arb(2) ** arb(random.uniform(-1, 1))
        return arb(random.uniform(-1, 1))

    def off(self, random: Random, value: Number, turn: bool, compared: bool) -> Number:
        """A value larger or smaller by a factor of 1.03 to 101; of zero any.

        Every second time one that signals are `compared` with is of their size instead, so that
        they lie between the two.
        """
        if not self.nonzero(value):
            return self.error(random, value)
        if compared and random.random() < 0.5:
            size = self.sign(value) * _decades(random) * self._scale
            return -size if turn else size
        factor = 1 + _decades(random)
        other = value * factor if random.random() < 0.5 else value / factor
        return -other if turn else other

    def error(self, random: Random, value: Number, limits: Sequence[Number] = ()) -> Number:
        """From 0.03 to 100 of the value or, every second time, of one: what it takes to a limit.

        With `limits` as often what takes it across one of these, or minus that, from where it is.
        """
        if limits and random.random() < 0.5:
            across = random.choice((-1, 1)) * random.choice(limits) - value
            if self.nonzero(across):
                return across * arb(1 + random.random())
        size = random.choice((-1, 1)) * _decades(random)
        return size * value if random.random() < 0.5 and self.nonzero(value) else size

    def argument(
        self, random: Random, of: str, at: int, scales: list[float], beside: list[Number]
    ) -> Number:
        """An argument at which a function does something, or near the numbers beside it."""
        if of.startswith("table:"):
            name = of.removeprefix("table:")
            numbers = knots(self._tables[name])[at]
            first, last = float(numbers[0]), float(numbers[-1])
            # beyond the ends, too, at times far: what else is there may have its branches there;
            # but not where a relation reads the table backwards, which has no value there
            beyond = random.choice((0.2, 0.2, 0.2, 3.0)) * (last - first)
            margin = 0.0 if name + "'" * (at + 1) in self._tables else beyond
            return arb(random.uniform(first - margin, last + margin))
        size = random.lognormvariate(0, 0.7)
        if of in ("asin", "acos", "atanh"):
            return arb(random.uniform(-0.95, 0.95))
        if of in ("decision", "min", "max"):
            # on either side of what it is compared with
            near = [x for x in beside if self.nonzero(x)]
            if near and random.random() < 0.5:
                return random.choice(near) * size
        if of in ("decision", "product", "value", "min", "max", "abs", "sign"):
            near = [s for s in scales if s]
            if near and random.random() < 0.7:
                size *= random.choice(near)
        if of in ("log", "sqrt", "pow", "acosh"):
            return arb(size + (of == "acosh"))
        return arb(random.choice((-1, 1)) * size * self._scale)


def _decades(random: Random) -> Number:
    return arb(10.0 ** random.uniform(-1.5, 2))


def _sqrt(f: Reals, x: Number) -> Number:
    return f.power(x, Fraction(1, 2))


def _signed(power: Callable[[Reals, Number], Number]) -> Callable[[Reals, Number], Number]:
    """The odd function that a function of positive numbers becomes."""

    def value(f: Reals, x: Number) -> Number:
        side = f.sign(x)
        return side * power(f, side * x) if side else arb(0)

    return value


def _within(name: str, least: int | None, most: int | None) -> Callable[[Reals, Number], Number]:
    """A function that is defined between two numbers."""

    def value(f: Reals, x: Number) -> Number:
        if (least is not None and not x > least) or (most is not None and not x < most):
            raise Undefined(f"{name} of a number where it has no value")
        return getattr(x, name)()

    return value


_FUNCTIONS: dict[str, Callable[[Reals, Number], Number]] = {
    "abs": lambda f, x: f.sign(x) * x,
    "sign": lambda f, x: arb(f.sign(x)),
    "sqrt": _sqrt,
    "ssqrt": _signed(_sqrt),
    "cbrt": _signed(lambda f, x: f.power(x, Fraction(1, 3))),
    "ssq": _signed(lambda f, x: x * x),
    "exp": Reals.exp,
    "log": Reals.log,
    "sin": lambda f, x: x.sin(),
    "cos": lambda f, x: x.cos(),
    "tan": lambda f, x: f.circle(x)[1] * f.inverse(f.circle(x)[0]),
    "asin": _within("asin", -1, 1),
    "acos": _within("acos", -1, 1),
    "atan": lambda f, x: x.atan(),
    "sinh": lambda f, x: f.hyperbola(x)[1],
    "cosh": lambda f, x: f.hyperbola(x)[0],
    "tanh": lambda f, x: x.tanh(),
    "asinh": lambda f, x: x.asinh(),
    "acosh": _within("acosh", 1, None),
    "atanh": _within("atanh", -1, 1),
}


# ------------------------------------------------------------------------------ where f vanishes

_STEPS = 20  # halvings of a bracket before straight lines take over
_LINES = 80
_SMALL = arb(2) ** -100  # what a function is at most beside its zero, next to its size before


def zero_between(f: Callable[[Number], Number], low: Number, high: Number) -> Number:
    """A ball that holds a zero of a continuous function whose signs differ at two numbers.

    Halves first, then straight lines by the Illinois rule, which converge at an order of 1.44
    (Dowell and Jarratt, 1971). Raises `Undefined` where the function has no value, or jumps.
    """
    at_low, at_high = f(low), f(high)
    size = 1 + abs(at_low) + abs(at_high)
    side = 0  # of the last new end: one that stays twice counts half
    for step in range(_STEPS + _LINES):
        if at_low == 0:
            return low
        middle = ((low + high) / 2).mid()
        fall = at_high - at_low
        if step >= _STEPS and fall != 0:
            middle = (low - at_low * (high - low) / fall).mid()
        value = f(middle)
        if value.contains(0):
            return _enclosed(f, middle, size)
        if (value > 0) == (at_low > 0):
            low, at_low = middle, value
            at_high = at_high / 2 if side < 0 else at_high
            side = -1
        else:
            high, at_high = middle, value
            at_low = at_low / 2 if side > 0 else at_low
            side = 1
    return _enclosed(f, ((low + high) / 2).mid(), size)


def _enclosed(f: Callable[[Number], Number], at: Number, size: Number) -> Number:
    """A ball around a number, as small as it takes to see the function change its sign in it.

    Raises `Undefined` where the function, elsewhere of some `size`, jumps there.
    """
    radius = (1 + abs(at)) * arb(2) ** (32 - ctx.prec)
    limit = (1 + abs(at)) * NOTHING
    while radius < limit:
        left, right = f((at - radius).mid()), f((at + radius).mid())
        if left != 0 and right != 0 and (left > 0) != (right > 0):
            if not abs(left) + abs(right) < size * _SMALL:
                break
            return arb(at, radius.upper())
        radius = radius * 1024
    raise Undefined("an equation whose two sides jump past each other")


def zero_of(f: Callable[[Number], Number], start: Number, random: Random | None = None) -> Number:
    """A zero of a function that may have no value everywhere: the nearest one to `start`.

    With `random` any of those within its reach. Raises `Undefined` where none is found.
    """
    known: list[tuple[Number, Number]] = []
    for at in _grid(start):
        try:
            value = f(at)
        except Undefined:
            continue
        if value != 0 or value == 0:  # not where a ball holds zero among others
            known.append((at, value))
    known.sort(key=lambda item: float(item[0]))
    found = [
        (a, b)
        for (a, left), (b, right) in pairwise(known)
        if left == 0 or (right != 0 and (left > 0) != (right > 0))
    ]
    if known and known[-1][1] == 0:
        found.append((known[-1][0], known[-1][0]))
    if random is not None:
        random.shuffle(found)
    else:
        found.sort(key=lambda item: abs(float(item[0] + item[1]) / 2 - float(start)))
    for low, high in found:
        try:
            return zero_between(f, low, high)
        except Undefined:
            continue
    raise Undefined("no solution of an equation was found")


def _grid(start: Number) -> list[Number]:
    """Numbers around `start`, denser where they are near it, and zero and one among them."""
    middle = start.mid()
    size = max(abs(float(middle)), 1.0)
    steps = [size * 10.0 ** (k / 4) for k in range(-48, 49)]
    out = [middle, arb(0)]
    for s in steps:
        out += [middle + arb(s), middle - arb(s)]
    return out
