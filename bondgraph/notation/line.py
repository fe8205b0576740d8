"""Expressions as one line of text, the way a person would type them."""

from __future__ import annotations

from collections.abc import Mapping
from fractions import Fraction
from types import MappingProxyType

from bondgraph.ir.expr import Expr, Symbol
from bondgraph.notation.formula import Formula, Reader, Shape
from bondgraph.notation.speller import ATOM, PRODUCT, Spelled, Speller

_BELOW = frozenset({2, 3, 4, 5, 6, 8, 12})  # by what a product is divided rather than multiplied


def number(value: Fraction) -> str:
    """A rational as a decimal where that is exact and short, else as a quotient.

    >>> number(Fraction(3, 2)), number(Fraction(1, 3)), number(Fraction(3, 10**4))
    ('1.5', '1/3', '0.0003')
    """
    if value.denominator == 1:
        return str(value.numerator)
    text = repr(float(value))
    return text if Fraction(text) == value else str(value)


def show(
    node: Expr,
    named: Mapping[Expr, str] = MappingProxyType({}),
    starts: Mapping[Symbol, Expr] = MappingProxyType({}),
) -> str:
    """The expression as text; `named` and `starts` as for a `Reader`.

    >>> from bondgraph.ir.expr import Pool, Kind
    >>> p = Pool(); x = p.symbol("x", Kind.SENSOR); R = p.symbol("R", Kind.PARAM)
    >>> show(p.add((1, x), (-2, p.div(p.der(x), R))))
    'x - 2*D(x)/R'
    """
    return Line().spell(Reader(named, starts).of(node)).text


class Line(Speller):
    """Text for people: decimals, and numbers inside of quotients."""

    def number(self, value: Fraction) -> Spelled:
        """A decimal where that is exact and short."""
        text = number(value)
        return Spelled(text, PRODUCT if "/" in text else ATOM)

    def term(self, size: Fraction, part: Formula) -> Spelled:
        """The number goes above or below the bar of the quotient."""
        if size == 1:
            return self.within(part, PRODUCT)
        above, below = [self.within(part, PRODUCT).text], list[str]()
        any_number = part.shape is not Shape.PRODUCT
        if part.shape is Shape.PRODUCT:
            above, below = self._sides(part)
        if size.numerator == 1 and (any_number or size.denominator in _BELOW):
            below.insert(0, str(size.denominator))
        else:
            text, level, _ = self.number(size)
            above.insert(0, text if level == ATOM else f"({text})")
        return self._quotient(above, below)


Expr.written = show  # nodes show themselves to whoever looks at them in Python
