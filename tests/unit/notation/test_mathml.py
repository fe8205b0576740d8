"""Formulas in MathML mean what the expressions mean, wherever they are broken."""

from __future__ import annotations

from fractions import Fraction
from xml.etree import ElementTree

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from bondgraph.ir.expr import Expr, Kind, Pool, Root, topological
from bondgraph.notation.formula import Reader
from bondgraph.notation.lettering import letters
from bondgraph.notation.line_breaks import pieces
from bondgraph.notation.mathml import MathML
from bondgraph.notation.speller import Spelled
from tests.unit.notation.drawn import VALUES, expressions, value
from tests.unit.notation.mathml_reader import RATE, evaluate


def letter(name: str, dots: int = 0) -> Spelled:
    xml = f'<mi data-name="{name}">{name}</mi>'
    over = {1: "˙", 2: "¨"}
    return Spelled(f"<mover>{xml}<mo>{over[dots]}</mo></mover>" if dots else xml, width=0.6)


def set_in(expr: Expr, room: float) -> list[str]:
    return pieces(MathML(letter), Reader().of(expr), room)


@settings(max_examples=120)
@given(expressions(), st.sampled_from([1.0, 4.0, 9.0, 1000.0]))
def test_what_is_read_is_what_is_meant(expr: Expr, room: float) -> None:
    try:
        wanted = value(expr)
        scale = max((abs(value(n)) for n in topological([expr])), default=1.0)
    except (ArithmeticError, ValueError, TypeError):
        return  # a root of something negative, a division by zero
    if not 1e-6 < scale < 1e9 or isinstance(wanted, complex):
        return
    read = evaluate(set_in(expr, room), VALUES)
    assert read == pytest.approx(wanted, rel=1e-5, abs=1e-6 * scale)


def test_a_long_sum_is_broken_and_a_short_one_is_not() -> None:
    p = Pool()
    terms = [p.mul(p.symbol(f"a{k}", Kind.PARAM), p.symbol("x", Kind.SENSOR)) for k in range(9)]
    total = p.add(*[(1, t) for t in terms])
    assert len(set_in(total, 100)) == 1
    broken = set_in(total, 4)
    assert len(broken) == 9
    below = p.div(total, p.symbol("R", Kind.PARAM))
    assert "mfrac" in set_in(below, 4)[0]  # 1/R ( ... )


@pytest.mark.parametrize("below", [1, 2, 3])
def test_a_factor_below_that_nothing_opens_is_a_fraction_of_its_own(below: int) -> None:
    """In a line that holds one letter each factor is a piece, and those below are divided by."""
    p = Pool()
    x, y, R = p.symbol("x", Kind.SENSOR), p.symbol("y", Kind.SENSOR), p.symbol("R", Kind.PARAM)
    product = p.mul(x, R, p.power(y, -below))
    found = set_in(product, 0.7)
    assert len(found) == 3
    wanted = VALUES["x"] * VALUES["R"] / VALUES["y"] ** below
    assert evaluate(found, VALUES) == pytest.approx(wanted)


def test_named_parts_stand_for_themselves_and_are_set_on_their_own_line() -> None:
    p = Pool()
    x, y = p.symbol("x", Kind.SENSOR), p.symbol("y", Kind.SENSOR)
    part = p.add((1, x), (2, y))
    whole = p.mul(part, p.der(part))
    reader, speller = Reader({part: "s"}), MathML(letter)
    read = evaluate([speller.spell(reader.of(whole)).text], {"s": 3.0})
    assert read == pytest.approx(3 * RATE * 3)
    own = speller.spell(reader.definition(part)).text
    assert evaluate([own], VALUES) == pytest.approx(value(part))


def test_a_number_without_a_formula_is_told_by_its_equation() -> None:
    p = Pool()
    u, c = p.symbol("u", Kind.UNKNOWN), p.symbol("c", Kind.UNKNOWN)
    root = Root("R", p.sub(p.add((1, u), (1, p.power(u, 3))), c), u, (c,), u, True, Fraction(0))
    node = p.root(root, p.symbol("x", Kind.SENSOR))
    formula, speller = Reader().of(node), MathML(letter)
    assert evaluate([speller.spell(formula).text], VALUES) == VALUES["R"]
    inner = pieces(speller, formula.parts[1], 100)
    assert evaluate(inner, VALUES) == pytest.approx(2.5 + 2.5**3 - 0.7)


def test_cases_conditions_and_odd_names_are_well_formed() -> None:
    p = Pool()
    x, odd = p.symbol("x", Kind.SENSOR), p.symbol("a<b&c", Kind.PARAM)
    either = p.logic("or", p.compare("<", x, p.one), p.logic("not", p.compare("==", x, p.zero)))
    expr = p.choose(either, p.fn("table:t1", x), p.add((1, p.der(p.der(p.der(x)))), (1, odd)))

    def escaped(name: str, dots: int) -> Spelled:
        return letter(name.replace("&", "&amp;").replace("<", "&lt;"), dots)

    for room in (1.0, 100.0):
        text = "".join(pieces(MathML(escaped), Reader().of(expr), room))
        ElementTree.fromstring(f"<math>{text.replace('&#x2061;', '')}</math>")


NAMES = st.lists(
    st.lists(st.sampled_from(["a", "b[1]", "b[2]", "el", "R"]), min_size=1, max_size=4),
    min_size=1,
    max_size=12,
)


@given(NAMES)
def test_no_two_names_get_the_same_letter(paths: list[list[str]]) -> None:
    names = dict.fromkeys(".".join(p) for p in paths)
    assert len(set(letters(names).values())) == len(names)
