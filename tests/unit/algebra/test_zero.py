"""What is zero, equal or a number whatever the parameters are, and what only looks like it."""

from __future__ import annotations

from fractions import Fraction

import pytest

from bondgraph.algebra.zero import Constants, agree, is_zero, share_factor
from bondgraph.ir.expr import Expr, Kind, Pool

p = Pool()
a, b, c = (p.symbol(name, Kind.PARAM) for name in "abc")
square = p.power(p.add((1, a), (1, b)), 2)
spelled = p.add((1, p.power(a, 2)), (2, p.mul(a, b)), (1, p.power(b, 2)))
nowhere = p.power(p.sub(square, spelled), -1)


def test_what_vanishes_for_all_numbers() -> None:
    assert is_zero(p.sub(square, spelled)) and is_zero(p.zero)
    assert not is_zero(p.sub(square, p.scale(2, spelled))) and not is_zero(nowhere)
    assert not is_zero(p.sub(a, b))


def test_what_is_equal_for_all_numbers() -> None:
    pairs = [(square, spelled), (a, b), (nowhere, nowhere), (nowhere, a), (a, nowhere),
             (spelled, square), (a, a)]  # fmt: skip
    assert agree(pairs) == [True, False, True, False, False, True, True]
    assert agree([]) == []


@pytest.mark.parametrize(
    ("one", "other", "shared"),
    [
        ([a, p.one], [b, p.one], False),
        ([a, p.one], [p.mul(a, b), p.add((1, a), (1, b)), p.one], True),  # (a + D)(b + D)
        ([a, p.one], [p.mul(a, b), p.add((2, a), (1, b)), p.one], False),
        ([p.zero, a], [p.zero, p.zero, b], True),  # D
        ([a], [a], False),  # which is no polynomial in D
        ([a, nowhere], [b, p.one], True),  # nobody knows
        ([b, p.one], [a, nowhere], True),
    ],
)
def test_a_factor_in_common(one: list[Expr], other: list[Expr], shared: bool) -> None:
    assert share_factor(one, other) is shared


@pytest.mark.parametrize(
    "number",
    [Fraction(0), Fraction(-3, 7), Fraction(2**28), Fraction(-(2**28)), Fraction(1, 2**28),
     Fraction(2**28, 2**28 - 1)],
)  # fmt: skip
def test_a_number_is_told_if_it_is_neither_large_nor_fine(number: Fraction) -> None:
    hidden = p.div(p.mul(p.num(number), spelled), square)
    assert Constants().number(hidden) == number
    assert Constants().vanishes(hidden) == (not number)


@pytest.mark.parametrize("number", [Fraction(2**28 + 1), Fraction(1, 2**28 + 1)])
def test_other_numbers_are_told_as_none_or_right(number: Fraction) -> None:
    """There may be a second fraction for a value, but not a wrong one for a small one."""
    assert Constants().number(p.num(number)) is None


def test_what_is_given_counts() -> None:
    own = Constants({a: p.num(3), b: p.zero})
    assert own.number(square) == 9 and own.number(c) is None and own.number(nowhere) is None
    assert own.vanishes(p.mul(b, c)) and not own.vanishes(p.mul(a, c)) and own.vanishes(b)
    assert Constants().number(square) is None and not Constants().vanishes(b)
