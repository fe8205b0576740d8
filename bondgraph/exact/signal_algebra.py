"""The two kinds of signal that residuals are evaluated on: power series, and exponentials.

Both are differential algebras: they add, multiply, differentiate, and say how a small change of
an argument changes a result, forwards and transposed. `n` is the number of Taylor coefficients
wanted; exponentials ignore it.
"""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from operator import mul as _times
from typing import Protocol, TypeAlias, TypeVar

from bondgraph.field import series
from bondgraph.field.numbers import Number, Numbers
from bondgraph.field.prime import root
from bondgraph.field.series import Series

V = TypeVar("V")
A = TypeVar("A")


class Mixed(Exception):
    """An operation leads out of the algebra, such as a function of a linear form."""


class Values(Protocol[V]):
    """A differential algebra; operations raise `Undefined` where there is no value."""

    numbers: Numbers

    def number(self, x: Number) -> V:
        """A constant."""
        ...

    def leads(self, *values: V) -> list[Number]:
        """The values at the point that a decision rests on."""
        ...

    def combine(self, terms: Sequence[tuple[Number, V]], n: int) -> V:
        """The sum of number times value."""
        ...

    def product(self, factors: Sequence[tuple[V, int]], n: int) -> V:
        """The product of integer powers."""
        ...

    def rational(self, a: V, exponent: Fraction, n: int) -> V:
        """A rational power."""
        ...

    def function(self, name: str, args: Sequence[V], n: int) -> V:
        """A function of one or two arguments."""
        ...

    def der(self, a: V) -> V:
        """The time derivative."""
        ...

    def integral(self, a: V, start: Number) -> V:
        """The integral that begins at `start`."""
        ...


class Algebra(Values[V], Protocol[V, A]):
    """Values V with adjoints A for reverse differentiation."""

    @property
    def kind(self) -> str:
        """What the values are, for people."""
        ...

    def slopes(self, name: str, args: Sequence[V], value: V, n: int) -> Sequence[V]:
        """The partial derivatives of a function whose value is known."""
        ...

    def moves(self, a: V) -> bool:
        """Whether a value is not zero at all times."""
        ...

    def seed(self, x: Number) -> A:
        """The adjoint of the result itself, times a number."""
        ...

    def join(self, a: A, b: A) -> A:
        """The sum of two adjoints."""
        ...

    def vanishes(self, a: A) -> bool:
        """Whether an adjoint is zero."""
        ...

    def back(self, adjoint: A, slope: V, n: int) -> A:
        """The adjoint of an argument with this partial derivative; n its coefficients."""
        ...

    def times(self, adjoint: A, c: Number) -> A:
        """The adjoint of an argument that the value has `c` times."""
        ...

    def back_der(self, adjoint: A, argument: V) -> A:
        """The adjoint of what was differentiated."""
        ...

    def back_integral(self, adjoint: A) -> A:
        """The adjoint of what was integrated, as far as the present reaches it."""
        ...

    def start_of(self, adjoint: A) -> Number:
        """The part of an adjoint that belongs to the value itself, not to its derivatives."""
        ...

    def order(self, adjoint: A) -> int:
        """The highest derivative that an adjoint which is not zero belongs to."""
        ...

    def lasting(self, adjoint: A) -> bool:
        """Whether a constant change of a parameter with this adjoint shows."""
        ...


class Taylor:
    """Power series around the point; an adjoint has one number a coefficient."""

    def __init__(self, numbers: Numbers) -> None:
        self.numbers = numbers

    @property
    def kind(self) -> str:
        """The kind of numbers."""
        digits = "in real balls" if self.numbers.real else "modulo a 61-bit prime"
        return f"Taylor series {digits}"

    def number(self, x: Number) -> Series:
        """A constant."""
        return [x]

    def leads(self, *values: Series) -> list[Number]:
        """The values at the point."""
        return [a[0] for a in values]

    def combine(self, terms: Sequence[tuple[Number, Series]], n: int) -> Series:
        """The sum of number times value."""
        if n == 1:
            total: Number = 0
            for c, a in terms:
                total += c * a[0]
            return [total]
        out: Series = [0] * max(min(n, len(a)) for _, a in terms)
        for c, a in terms:
            for i, x in enumerate(a[:n]):
                out[i] += c * x
        return out

    def product(self, factors: Sequence[tuple[Series, int]], n: int) -> Series:
        """The product of integer powers."""
        out: Series | None = None
        for a, exponent in factors:
            if exponent:
                value = series.power(self.numbers, a, exponent, n)
                out = value if out is None else series.mul(out, value, n)
        return [1] if out is None else out[:n]

    def rational(self, a: Series, exponent: Fraction, n: int) -> Series:
        """A rational power."""
        return series.rational_power(self.numbers, a, exponent, n)

    def function(self, name: str, args: Sequence[Series], n: int) -> Series:
        """A function of one or two arguments."""
        if len(args) == 1:
            return series.function(self.numbers, name, args[0][:n], n)
        return series.function_of_two(self.numbers, name, args[0][:n], args[1][:n], n)

    def slopes(self, name: str, args: Sequence[Series], value: Series, n: int) -> Sequence[Series]:
        """The partial derivatives of a function."""
        if len(args) == 1:
            return [series.slope_of(self.numbers, name, args[0][:n], value, n)]
        return series.slopes_of_two(self.numbers, name, args[0][:n], args[1][:n], value, n)

    def der(self, a: Series) -> Series:
        """The time derivative."""
        return series.derivative(a)

    def integral(self, a: Series, start: Number) -> Series:
        """The integral that begins at `start`."""
        return series.integral(self.numbers, a, start)

    def moves(self, a: Series) -> bool:
        """Whether any coefficient is not zero."""
        return series.moves(self.numbers, a)

    def seed(self, x: Number) -> Series:
        """The adjoint of the result, times a number."""
        return [x]

    def join(self, a: Series, b: Series) -> Series:
        """The sum of two adjoints."""
        return series.add(a, b)

    def vanishes(self, a: Series) -> bool:
        """Whether an adjoint is zero."""
        return not series.moves(self.numbers, a)

    def back(self, adjoint: Series, slope: Series, n: int) -> Series:
        """The adjoint of an argument."""
        if len(slope) == 1:
            return self.times(adjoint, slope[0])
        size = len(adjoint)
        return [sum(map(_times, adjoint[m:], slope)) for m in range(size)]

    def times(self, adjoint: Series, c: Number) -> Series:
        """The adjoint of an argument that the value has a number of times."""
        return [c * x for x in adjoint]

    def back_der(self, adjoint: Series, argument: Series) -> Series:
        """The adjoint of what was differentiated."""
        return [0, *[k * x for k, x in enumerate(adjoint, 1)]]

    def back_integral(self, adjoint: Series) -> Series:
        """The adjoint of what was integrated."""
        return [x * self.numbers.reciprocal_of(k) for k, x in enumerate(adjoint[1:], 1)]

    def start_of(self, adjoint: Series) -> Number:
        """The part that belongs to the value itself."""
        return adjoint[0]

    def order(self, adjoint: Series) -> int:
        """The highest derivative with an influence."""
        return max(k for k, x in enumerate(adjoint) if self.numbers.nonzero(x))

    def lasting(self, adjoint: Series) -> bool:
        """Whether the value itself has an influence, not only its derivatives."""
        return self.numbers.nonzero(adjoint[0])


#: (amplitude, degree): amplitude * e^(degree s t); a constant has degree 0.
Exponential: TypeAlias = tuple[Number, int]

#: (value, still, degree, floor, leading): an adjoint of an exponential, its number `value` for
#: changes that grow like e^(sigma t), `still` for changes that are constant, sigma = 0. As a
#: polynomial in sigma its coefficients from `degree` down to `floor` are `leading`; those below
#: `floor` are not kept. Plain tuples: there is one a node.
Impulse: TypeAlias = tuple[Number, Number, int, int, Series]


_NONE: Series = []


class Exponentials:
    """Exponentials e^(d s t) with one random s: the derivative is a multiplication by d s.

    For plants and residuals linear in their signals, in time independent of the order. Changes
    are taken as e^(sigma t) with a second random number, so that a parameter is a function of
    time for the adjoints. `terms` leading coefficients are carried to find the order; without any
    the order found is as high as it can be.
    """

    def __init__(self, numbers: Numbers, s: Number, sigma: Number, terms: int = 3) -> None:
        self.numbers = numbers
        self.s = s
        self.sigma = sigma
        self.terms = terms
        self.kind = "exponentials modulo a 61-bit prime"

    def number(self, x: Number) -> Exponential:
        """A constant."""
        return (x, 0)

    def leads(self, *values: Exponential) -> list[Number]:
        """The values at the point."""
        if any(degree and amplitude for amplitude, degree in values):
            raise Mixed("a decision on a signal")
        return [amplitude for amplitude, _ in values]

    def combine(self, terms: Sequence[tuple[Number, Exponential]], n: int) -> Exponential:
        """The sum of number times value."""
        degree = None
        total = 0
        for c, (x, d) in terms:
            if x:
                if degree is not None and d != degree:
                    raise Mixed("a sum of a signal and a constant")
                degree = d
                total += c * x
        return (total, degree or 0)

    def product(self, factors: Sequence[tuple[Exponential, int]], n: int) -> Exponential:
        """The product of integer powers."""
        value, degree = 1, 0
        for (x, d), exponent in factors:
            if exponent == 1:
                value = value * x
            elif exponent:
                value = value * (x**exponent if x else root(x, Fraction(exponent)))
            degree += d * exponent
        return (value, degree)

    def _constants(self, args: Sequence[Exponential]) -> list[Series]:
        if any(degree and amplitude for amplitude, degree in args):
            raise Mixed("a function of a signal")
        return [[amplitude] for amplitude, _ in args]

    def rational(self, a: Exponential, exponent: Fraction, n: int) -> Exponential:
        """A rational power."""
        return (root(self._constants([a])[0][0], exponent), 0)

    def function(self, name: str, args: Sequence[Exponential], n: int) -> Exponential:
        """A function of one or two arguments."""
        if name in ("sign", "abs") and args[0][1]:
            raise Mixed("a function of a signal")
        constants = self._constants(args)
        if len(args) == 1:
            return (series.function(self.numbers, name, constants[0], 1)[0], 0)
        a, b = constants
        return (series.function_of_two(self.numbers, name, a, b, 1)[0], 0)

    def slopes(
        self, name: str, args: Sequence[Exponential], value: Exponential, n: int
    ) -> Sequence[Exponential]:
        """The partial derivatives of a function."""
        constants = self._constants(args)
        f, of = self.numbers, [value[0]]
        if len(args) == 1:
            return [(series.slope_of(f, name, constants[0], of, 1)[0], 0)]
        both = series.slopes_of_two(f, name, constants[0], constants[1], of, 1)
        return [(x[0], 0) for x in both]

    def der(self, a: Exponential) -> Exponential:
        """The time derivative."""
        amplitude, degree = a
        return (amplitude * degree * self.s, degree)

    def integral(self, a: Exponential, start: Number) -> Exponential:
        """The integral that begins at `start`."""
        raise Mixed("an integral from an initial value")

    def moves(self, a: Exponential) -> bool:
        """Whether the amplitude is not zero."""
        return self.numbers.nonzero(a[0])

    def seed(self, x: Number) -> Impulse:
        """The adjoint of the result, times a number."""
        return (x, x, 0, 0, [x] if self.terms else _NONE)

    def join(self, a: Impulse, b: Impulse) -> Impulse:
        """The sum of two adjoints."""
        if a[2] < b[2]:
            a, b = b, a
        value, still, degree, floor, leading = a
        value, still, floor = value + b[0], still + b[1], max(floor, b[3])
        if not self.terms:
            return (value, still, degree, 0, _NONE)
        leading = series.add(leading, [0] * (degree - b[2]) + b[4])
        while leading and not leading[0]:
            leading = leading[1:]
            degree -= 1
        floor = max(floor, degree - self.terms + 1)
        leading = leading[: max(0, degree - floor + 1)]
        return (value, still, degree, floor, leading)

    def vanishes(self, a: Impulse) -> bool:
        """Whether an adjoint is zero."""
        return not a[0]

    def back(self, adjoint: Impulse, slope: Exponential, n: int) -> Impulse:
        """The adjoint of an argument."""
        return self.times(adjoint, slope[0])

    def times(self, adjoint: Impulse, c: Number) -> Impulse:
        """The adjoint of an argument that the value has a number of times."""
        value, still, degree, floor, leading = adjoint
        if leading:
            leading = series.scale(c, leading)
        return (value * c, still * c, degree, floor, leading)

    def back_der(self, adjoint: Impulse, argument: Exponential) -> Impulse:
        """The adjoint of what was differentiated."""
        own = argument[1] * self.s
        value, still, degree, floor, leading = adjoint
        if not self.terms:
            return (value * (self.sigma + own), still * own, degree + 1, 0, _NONE)
        # times (sigma + own); the lowest coefficient is complete only if nothing was cut off
        leading = series.add([*leading, 0], [0, *series.scale(own, leading)])
        floor = max(floor + 1 if floor else 0, degree + 2 - self.terms)
        leading = leading[: max(0, degree + 2 - floor)]
        value = value * (self.sigma + own)
        return (value, still * own, degree + 1, floor, leading)

    def back_integral(self, adjoint: Impulse) -> Impulse:
        """The adjoint of what was integrated."""
        raise Mixed("an integral from an initial value")

    def start_of(self, adjoint: Impulse) -> Number:
        """The part that belongs to the value itself."""
        return adjoint[0]

    def order(self, adjoint: Impulse) -> int:
        """Raises `Mixed` when more leading coefficients cancel than are carried."""
        degree, leading = adjoint[2], adjoint[4]
        if not self.terms:
            return degree
        for k, x in enumerate(leading):
            if x:
                return degree - k
        raise Mixed("leading coefficients cancel")

    def lasting(self, adjoint: Impulse) -> bool:
        """Whether a constant change has an influence."""
        return bool(adjoint[1])


def compare(numbers: Numbers, op: str, left: Number, right: Number) -> bool:
    """`<`, `<=` or `==` of two numbers by the sign of their difference."""
    if op == "==":
        return not numbers.nonzero(right - left)
    s = numbers.sign(right - left)
    return s == 1 or (op == "<=" and s == 0)

