"""Polynomials with expressions as coefficients, against divisions and roots done by hand."""

from __future__ import annotations

from fractions import Fraction

import pytest

from bondgraph.algebra.fractions import (
    divided,
    monomials,
    only_root,
    trimmed,
    without_common_divisor,
)
from bondgraph.algebra.zero import is_zero
from bondgraph.ir.expr import Expr, Kind, Pool

p = Pool()
a, b, x = (p.symbol(name, Kind.PARAM) for name in ("a", "b", "x"))
#: (a + b)^2 - a^2 - 2 a b - b^2, which the pool does not see to be zero
nothing = p.add(
    (1, p.power(p.add((1, a), (1, b)), 2)),
    (-1, p.power(a, 2)),
    (-2, p.mul(a, b)),
    (-1, p.power(b, 2)),
)


def numbers(*values: int) -> list[Expr]:
    """A polynomial by its coefficients, that of the highest power last."""
    return [p.num(Fraction(v)) for v in values]


def same(left: list[Expr], right: list[Expr]) -> bool:
    return len(left) == len(right) and all(
        is_zero(p.sub(one, other)) for one, other in zip(left, right, strict=True)
    )


@pytest.mark.parametrize(
    ("polynomial", "left"),
    [([a, b], 2), ([a, nothing], 1), ([nothing, a], 2), ([nothing, nothing], 0), ([], 0),
     ([a, nothing, nothing], 1), ([a, nothing, b], 3)],
)  # fmt: skip
def test_leading_coefficients_that_are_zero_go(polynomial: list[Expr], left: int) -> None:
    assert nothing is not p.zero
    assert trimmed(polynomial) == polynomial[:left]


@pytest.mark.parametrize(
    ("dividend", "divisor", "quotient", "rest"),
    [
        ((-4, 0, -2, 1), (-3, 1), (3, 1, 1), (5,)),  # x^3 - 2 x^2 - 4 = (x - 3)(x^2 + x + 3) + 5
        ((-1, 0, 0, 0, 1), (1, 0, 1), (-1, 0, 1), ()),  # x^4 - 1 = (x^2 + 1)(x^2 - 1)
        ((1, 0, 4), (1, 2), (-1, 2), (2,)),  # 4 x^2 + 1 = (2 x + 1)(2 x - 1) + 2
        ((7,), (1, 1), (), (7,)),  # of a lower degree: all is left
        ((6, 4), (2,), (3, 2), ()),  # by a number
    ],
)
def test_a_division_done_by_hand(
    dividend: tuple[int, ...],
    divisor: tuple[int, ...],
    quotient: tuple[int, ...],
    rest: tuple[int, ...],
) -> None:
    found = divided(p, numbers(*dividend), numbers(*divisor))
    assert found == (numbers(*quotient), numbers(*rest))


def test_a_division_with_parameters() -> None:
    """a x^2 + (a b + 1) x + (b + a) = (x + b)(a x + 1) + a."""
    dividend = [p.add((1, b), (1, a)), p.add((1, p.mul(a, b)), (1, p.one)), a]
    quotient, rest = divided(p, dividend, [b, p.one])
    assert same(quotient, [p.one, a]) and same(rest, [a])


def test_a_common_divisor_of_degree_two_is_taken_out_whole() -> None:
    """(x^2 + x + a)(x + 2) and (x^2 + x + a)(x - b); without it x + 2 and x - b, scaled alike."""
    one = [p.scale(2, a), p.add((2, p.one), (1, a)), p.num(Fraction(3)), p.one]
    other = [
        p.neg(p.mul(a, b)), p.add((1, a), (-1, b)), p.sub(p.one, b), p.one,
    ]  # fmt: skip
    left, right = without_common_divisor(p, one, other, lambda _: False)
    assert len(left) == len(right) == 2
    assert is_zero(p.sub(left[0], p.scale(2, left[1])))
    assert is_zero(p.add((1, right[0]), (1, p.mul(b, right[1]))))
    assert is_zero(p.sub(left[1], right[1]))


def test_what_shares_nothing_or_would_be_divided_by_zero_stays() -> None:
    one, other = numbers(2, 3, 1), numbers(3, 1)
    assert without_common_divisor(p, one, other, lambda _: False) == (one, other)
    square = [p.mul(a, a), p.scale(2, a), p.one]
    by_a = [p.mul(a, a), a]  # a (x + a)
    assert len(without_common_divisor(p, square, by_a, lambda _: False)[0]) == 2
    assert without_common_divisor(p, square, by_a, lambda c: c is a) == (square, by_a)


@pytest.mark.parametrize(
    ("zero", "root"),
    [
        (p.sub(p.mul(a, x), b), p.div(b, a)),
        # 1/x + 1/a = b: x (a b - 1) = a
        (p.add((1, p.power(x, -1)), (1, p.power(a, -1)), (-1, b)),
         p.div(a, p.sub(p.mul(a, b), p.one))),
        # (x + 1 - a)/(x - 1) = b: x (1 - b) = a - 1 - b
        (p.sub(p.mul(p.sub(p.add((1, x), (1, p.one)), a), p.power(p.sub(x, p.one), -1)), b),
         p.div(p.sub(p.sub(a, p.one), b), p.sub(p.one, b))),
        # x^2 - (x + a)^2 = b is of degree one only: x = -(a^2 + b)/(2 a)
        (p.add((1, p.power(x, 2)), (-1, p.power(p.add((1, x), (1, a)), 2)), (-1, b)),
         p.neg(p.div(p.add((1, p.mul(a, a)), (1, b)), p.scale(2, a)))),
    ],
)  # fmt: skip
def test_the_only_root_by_hand(zero: Expr, root: Expr) -> None:
    found = only_root(p, zero, x)
    assert found is not None and is_zero(p.sub(found, root))


@pytest.mark.parametrize(
    "zero",
    [
        p.sub(p.power(x, 2), a),  # two roots
        p.sub(p.mul(x, p.power(x, -1)), a),  # none: x is gone
        p.sub(p.fn("sin", x), a),  # no fraction
        # (x - 1)/(x^2 - 1) = 0: at its only root it has no value
        p.mul(p.sub(x, p.one), p.power(p.sub(p.power(x, 2), p.one), -1)),
    ],
)
def test_what_has_not_one_root(zero: Expr) -> None:
    assert only_root(p, zero, x) is None


def test_terms_of_an_expansion_are_counted_without_expanding() -> None:
    """(a + b) (a + b + x)^3 / x has 2 * 27 products; a function and a leaf count as one."""
    two, three = p.add((1, a), (1, b)), p.add((1, a), (1, b), (1, x))
    whole = p.mul(two, p.power(three, 3), p.power(x, -1))
    assert monomials([whole]) == 54
    assert monomials([whole, p.fn("sin", whole)]) == 55
    assert monomials([whole], {three}) == 2
