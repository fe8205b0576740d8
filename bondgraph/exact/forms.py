"""Linear forms in unknowns as an algebra, so that evaluating a law shows whether it is linear."""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from typing import TypeAlias

from bondgraph.exact.signal_algebra import Mixed, Taylor
from bondgraph.field import series
from bondgraph.field.numbers import Number, Numbers
from bondgraph.field.series import Series
from bondgraph.field.sparse import CONSTANT

#: Coefficients (series in time) of the unknowns; a key is variable * ORDERS + derivative.
Form: TypeAlias = dict[int, Series]

ORDERS = 16


class NotLinear(Mixed):
    """A form is needed as a number: `form` says which, `of` what for (a function's name).

    `at` is the number of the argument that it is, `beside` are all arguments.
    """

    def __init__(
        self, form: Form, of: str = "value", at: int = 0, beside: Sequence[Form] = ()
    ) -> None:
        super().__init__("not linear")
        self.form = form
        self.of = of
        self.at = at
        self.beside = beside


class Forms:
    """The algebra of linear forms whose coefficients are functions of time."""

    def __init__(self, numbers: Numbers) -> None:
        self.numbers = numbers
        self._taylor = Taylor(numbers)

    def try_known(self, form: Form) -> Series | None:
        """A form without unknowns as a series, None for another."""
        if not form:
            return [0]
        return form[CONSTANT] if len(form) == 1 and CONSTANT in form else None

    def known(self, form: Form, of: str, at: int = 0, beside: Sequence[Form] = ()) -> Series:
        """A form without unknowns as a series; raises `NotLinear` for another."""
        value = self.try_known(form)
        if value is None:
            raise NotLinear(form, of, at, beside)
        return value

    def number(self, x: Number) -> Form:
        """A constant."""
        return {CONSTANT: self._taylor.number(x)}

    def leads(self, *values: Form) -> list[Number]:
        """The values at the point."""
        return [self.known(a, "decision", at, values)[0] for at, a in enumerate(values)]

    def combine(self, terms: Sequence[tuple[Number, Form]], n: int) -> Form:
        """The sum of number times value."""
        out: Form = {}
        for c, form in terms:
            for key, a in form.items():
                scaled = series.scale(c, a)
                old = out.get(key)
                out[key] = scaled if old is None else series.add(old, scaled)
        return {key: a for key, a in out.items() if series.moves(self.numbers, a)}

    def product(self, factors: Sequence[tuple[Form, int]], n: int) -> Form:
        """The product of integer powers."""
        constants: list[tuple[Series, int]] = []
        linear: Form | None = None
        for form, exponent in factors:
            value = self.try_known(form)
            if value is not None:
                constants.append((value, exponent))
            elif linear is None and exponent == 1:
                linear = form
            elif exponent:
                raise NotLinear(form, "product")
        coefficient = self._taylor.product(constants, n)
        if linear is None:
            return {CONSTANT: coefficient}
        out = {key: series.mul(coefficient, a, n) for key, a in linear.items()}
        return {key: a for key, a in out.items() if series.moves(self.numbers, a)}

    def rational(self, a: Form, exponent: Fraction, n: int) -> Form:
        """A rational power."""
        return {CONSTANT: self._taylor.rational(self.known(a, "pow"), exponent, n)}

    def function(self, name: str, args: Sequence[Form], n: int) -> Form:
        """A function of one or two arguments."""
        known = [self.known(a, name, at, args) for at, a in enumerate(args)]
        return {CONSTANT: self._taylor.function(name, known, n)}

    def der(self, a: Form) -> Form:
        """The time derivative."""
        out: Form = {}
        for key, x in a.items():
            parts = [(key, series.derivative(x))]
            if key != CONSTANT:
                parts.append((key + 1, x))
            for at, part in parts:
                if series.moves(self.numbers, part):
                    out[at] = series.add(out[at], part) if at in out else part
        return out

    def integral(self, a: Form, start: Number) -> Form:
        """The integral that begins at `start`."""
        raise NotLinear(a)
