"""How wide typeset formulas are, by what they are put together from."""

from __future__ import annotations

from fractions import Fraction

import pytest

from bondgraph.ir.expr import ZERO_START, Expr, Kind, Pool, Root
from bondgraph.notation.formula import Reader
from bondgraph.notation.mathml import MathML
from bondgraph.notation.speller import Spelled

p = Pool()
a, b, c, d, e = (p.symbol(name, Kind.PARAM) for name in "abcde")


def wide(expr: Expr, letter: float = 0.0) -> float:
    """The width of a formula whose letters are so wide: signs alone where they have none."""
    return MathML(lambda name, dots: Spelled(name, width=letter)).spell(Reader().of(expr)).width


@pytest.mark.parametrize("word", ["or", "and"])
def test_each_condition_that_is_joined_takes_as_much_room_as_the_one_before(word: str) -> None:
    less = [p.compare("<", a, x) for x in (b, c, d, e)]
    widths = [wide(p.logic(word, *less[:n])) for n in (2, 3, 4)]
    sign = wide(less[0])
    assert sign > 0.0
    assert widths[2] - widths[1] == pytest.approx(widths[1] - widths[0])
    # of n conditions there are n pairs of brackets and n - 1 signs
    assert widths[0] == pytest.approx(2 * (widths[1] - widths[0]) - sign)


def test_the_letters_of_a_line_add_up() -> None:
    for expr, letters in (
        (p.add((1, a), (1, b), (-1, c)), 3),
        (p.mul(a, b, c), 3),
        (p.div(p.mul(a, b), c), 2),  # the wider side of a bar counts
        (p.div(a, p.mul(b, c, d)), 3),
        (p.compare("<", a, b), 2),
        (p.logic("not", p.compare("<", a, b)), 2),
        (p.fn("atan2", a, b), 2),
        (p.fn("sin", p.add((1, a), (1, b))), 2),
        (p.fn("sqrt", a), 1),
        (p.der(a), 1),
        (p.der(a, 3), 1),
        (p.der(p.mul(a, b)), 2),
        (p.integral(p.mul(a, b), p.symbol("x0", Kind.INITIAL)), 3),
        (p.fn("ssq", a), 2),  # a |a|
        (p.fn("ssqrt", a), 2),  # sign(a) and the root of |a|
        (p.choose(p.compare("<", a, b), a, p.mul(b, c)), 4),  # the wider case and the condition
        (p.fn("delay", a, p.num(2)), 1),
    ):
        grown = wide(expr, 3.0) - wide(expr, 2.0)
        assert grown == pytest.approx(letters), expr


def test_a_long_argument_is_written_once() -> None:
    """`x |x|` where x is short; a function of its own where it is not."""
    short, long = p.fn("ssq", a), p.fn("ssq", p.add((1, a), (1, b), (1, c), (1, d)))
    assert wide(short, 1.0) - wide(short) == pytest.approx(2.0)
    assert wide(long, 1.0) - wide(long) == pytest.approx(4.0)


def test_signs_make_formulas_wider() -> None:
    on, zero = p.symbol("on", Kind.MODE), p.symbol(ZERO_START, Kind.INITIAL)
    for larger, smaller in (
        (p.add((1, a), (1, b), (1, c)), p.add((1, a), (1, b))),
        (p.add((2, a), (1, b)), p.add((1, a), (1, b))),
        (p.scale(-1, a), a),
        (p.mul(a, b), a),
        (p.power(a, 2), a),
        (p.fn("abs", a), a),
        (p.fn("sqrt", a), a),
        (p.fn("cbrt", a), p.fn("sqrt", a)),
        (p.fn("sqrt", a), p.fn("abs", a)),
        (p.fn("atan2", a, b), p.fn("sin", a)),
        (p.fn("asin", a), p.fn("sin", a)),
        (p.logic("not", p.compare("<", a, b)), p.compare("<", a, b)),
        (p.der(p.mul(a, b)), p.mul(a, b)),
        (p.der(a, 3), p.der(a, 2)),
        (p.div(a, b), a),
        (p.integral(a, p.symbol("x0", Kind.INITIAL)), p.integral(a, zero)),
        (p.integral(a, zero), a),
        (p.fn("table:t", a, b), p.fn("table:t", a)),
        (p.logic("not", on), on),
        (p.choose(p.compare("<", a, b), c, d), p.compare("<", a, b)),
    ):
        assert wide(larger) > wide(smaller), (larger, smaller)


def test_an_exponent_is_smaller_than_its_base() -> None:
    power = p.fn("pow", a, p.add((1, b), (1, c)))
    assert 1.0 < wide(power, 3.0) - wide(power, 2.0) < 3.0


def test_a_function_is_as_wide_as_its_name_and_brackets() -> None:
    """Half an em a letter at least."""
    total = p.add((1, b), (1, c))
    brackets = wide(p.mul(a, total)) - wide(p.mul(a, b)) - wide(total)
    for name in ("sin", "tanh", "sign"):
        assert wide(p.fn(name, a)) >= 0.5 * len(name) + brackets > 0.5 * len(name)


def test_the_room_of_a_choice_is_that_of_the_wider_case_beside_the_condition() -> None:
    less = p.compare("<", a, b)
    for yes, no in ((c, p.mul(c, d)), (p.mul(c, d), c)):
        found = wide(p.choose(less, yes, no), 3.0)
        assert found > wide(p.mul(c, d), 3.0) + wide(less, 3.0) + 2.0  # the brace and "if"


def test_an_inner_unknown_is_as_wide_as_its_letter() -> None:
    u, y = p.symbol("u", Kind.UNKNOWN), p.symbol("y", Kind.UNKNOWN)
    zero = p.sub(p.add((1, u), (1, p.power(u, 3))), y)
    node = p.root(Root("R", zero, u, (y,), u, True, Fraction(0)), a)
    assert wide(node, 3.0) == 3.0
