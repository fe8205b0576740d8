"""Where formulas may be broken, and what stays on the lines of the first and the last piece."""

from __future__ import annotations

import re
from fractions import Fraction

import pytest

from bondgraph.ir.expr import ZERO_START, Expr, Kind, Pool
from bondgraph.notation.formula import Formula, Reader, Shape
from bondgraph.notation.line_breaks import pieces
from bondgraph.notation.mathml import MathML
from bondgraph.notation.speller import Spelled

_LETTER = 10.0  # em: next to it signs and brackets are narrow
p = Pool()
x, y, z, w = (p.symbol(name, Kind.PARAM) for name in "xyzw")
s = p.add((1, x), (1, y))
at_start, zero = p.symbol("x0", Kind.INITIAL), p.symbol(ZERO_START, Kind.INITIAL)


def _speller() -> MathML:
    return MathML(lambda name, dots: Spelled(f"<mi>{name}</mi>", width=_LETTER))


def _set(expr: Expr, room: float) -> str:
    """The pieces as plain text, with a bar between two."""
    found = " | ".join(pieces(_speller(), Reader().of(expr), room))
    text = re.sub("<[^>]*>", "", found).replace("&#x2061;", "").replace("&lt;", "<")
    text = text.replace("\N{LOGICAL OR}", "or").replace("\N{LOGICAL AND}", "and")
    return text.replace("&#xa0;", " ").replace("  |", " |")


@pytest.mark.parametrize(
    ("expr", "room", "text"),
    [
        (p.add((1, x), (-1, y), (2, z), (-1, p.num(3))), 5, "x | +2z | −y | −3"),
        (p.add((-1, x), (-1, y)), 5, "−x | −y"),
        (p.add((1, x), (-2, p.mul(y, z))), 5, "x | −2y | z"),
        (p.add((1, x), (-1, p.mul(y, z))), 5, "x | −y | z"),
        (p.add((1, p.fn("sin", s)), (1, p.num(300))), 1, "sin(x | +y) | +300"),
        (p.compare("<", s, z), 12, "(x | +y) | <z"),
        (p.compare("<=", x, y), 12, "x | ≤y"),
        (p.logic("or", p.compare("<", x, y), p.compare("<", y, z)), 24, "(x<y) | or(y<z)"),
        (p.logic("and", p.compare("<", x, y), p.compare("<", y, z)), 5, "(x | <y) | and(y | <z)"),
        (p.logic("not", p.compare("<", z, w)), 5, "¬(z<w)"),
        (p.der(p.mul(x, y)), 5, "ddt(x | y)"),
        (p.der(p.fn("sin", s), 2), 5, "d2dt2(sin(x | +y))"),
        (p.integral(s, zero), 5, "∫0t(x | +y)dt"),
        (p.integral(s, at_start), 5, "(x0 | +∫0t(x | +y)dt)"),
        (p.fn("atan2", s, z), 5, "atan2(x | +y, | z)"),
        (p.fn("abs", s), 5, "|x | +y|"),
        (p.fn("sqrt", s), 5, "(x | +y)1/2"),
        (p.fn("cbrt", s), 5, "(x | +y)1/3"),
        (p.fn("asin", s), 5, "arcsin(x | +y)"),
        (p.fn("table:t", s), 5, "t(x | +y)"),
        (p.choose(p.compare("<", x, y), z, s), 5, "if x | <y | then z | else x | +y"),
        (p.add((1, p.choose(p.compare("<", x, y), z, s)), (1, w)), 12,
         "w | +(if x | <y | then z | else x | +y)"),
        (p.mul(p.choose(p.compare("<", x, y), z, s), w), 12,
         "w | (if x | <y | then z | else x | +y)"),
        (p.mul(x, p.power(s, 2), p.power(p.add((1, z), (1, w)), -1)), 12,
         "x | (x | +y)2 | (z | +w)−1"),
        (p.mul(x, p.power(s, 2)), 23, "x | (x+y)2"),
        (p.mul(x, y, p.power(s, 2)), 31, "xy | (x+y)2"),  # a third of the room is narrow
        (p.div(s, z), 21.3, "1z | (x+y)"),
    ],
)  # fmt: skip
def test_formulas_are_opened_at_their_signs(expr: Expr, room: float, text: str) -> None:
    assert _set(expr, room) == text


@pytest.mark.parametrize(
    "expr",
    [s, p.mul(s, z), p.fn("atan2", s, z), p.compare("<", s, z),
     p.integral(s, at_start), p.mul(x, s), p.choose(p.compare("<", x, y), z, s)],
)  # fmt: skip
def test_what_fits_is_one_piece(expr: Expr) -> None:
    """A room as wide as the formula is enough, and one that is less wide is not."""
    speller, formula = _speller(), Reader().of(expr)
    width = speller.spell(formula).width
    assert pieces(speller, formula, width) == [speller.spell(formula).text]
    assert len(pieces(speller, formula, width - 0.01)) > 1


def test_brackets_around_what_fits_are_those_of_the_formula() -> None:
    """They are as high as what they are around; those around pieces are as high as a letter."""
    speller = _speller()
    inner = Reader().of(p.compare("<", s, z)).parts[0]
    width = speller.spell(inner).width
    whole = p.compare("<", s, z)
    assert pieces(speller, Reader().of(whole), width)[0] == speller.within(inner, 7).text
    assert len(pieces(speller, Reader().of(whole), width - 0.01)) == 3


def test_a_factor_is_narrow_up_to_a_third_of_the_room() -> None:
    product = p.mul(x, y, p.fn("sin", s))
    assert _set(product, 3 * _LETTER).startswith("xy | ")
    assert _set(product, 3 * _LETTER - 0.1).startswith("x | y | ")


@pytest.mark.parametrize(("deep", "opened"), [(0, True), (40, True), (41, False), (90, False)])
def test_forty_formulas_inside_each_other_are_opened(deep: int, opened: bool) -> None:
    inner = s
    for _ in range(deep):
        inner = p.fn("tanh", inner)
    assert len(pieces(_speller(), Reader().of(inner), 5)) == (2 if opened else 1)
    # in the other notations of a formula within a formula as well
    for wrapped in (p.der(inner), p.integral(inner, zero), p.scale(Fraction(2), inner)):
        found = pieces(_speller(), Reader().of(wrapped), 5)
        assert len(found) == (2 if deep < 40 else 1)


def test_a_delay_that_is_broken_keeps_its_unit() -> None:
    late = Formula(Shape.CALL, (Reader().of(s), Formula(Shape.NUMBER, (), Fraction(2))), "delay")
    found = [re.sub("<[^>]*>", "", piece) for piece in pieces(_speller(), late, 5.0)]
    assert found == ["delay(x", "+y,", "2s)"]
