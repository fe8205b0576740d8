"""Polynomials in a part of an expression, and relations multiplied through, by hand."""

from __future__ import annotations

import pytest

from bondgraph.algebra.cleared import below_terms, cleared
from bondgraph.algebra.powers import powers, undivided
from bondgraph.algebra.summands import summands
from bondgraph.algebra.zero import is_zero
from bondgraph.ir.expr import Expr, Kind, Pool

p = Pool()
x, y, u, m = (p.symbol(n, Kind.SENSOR) for n in "xyum")
one = p.one


def plus(*terms: Expr) -> Expr:
    return p.add(*[(1, term) for term in terms])


def same(left: Expr, right: Expr) -> bool:
    return is_zero(p.sub(left, right))


@pytest.mark.parametrize(
    ("expr", "coefficients"),
    [
        (p.power(plus(x, y), 3), [p.power(y, 3), p.scale(3, p.power(y, 2)), p.scale(3, y), one]),
        (p.mul(plus(x, one), p.sub(x, one), y), [p.neg(y), p.zero, y]),
        (p.sub(p.mul(plus(x, y), u), p.mul(x, u)), [p.mul(y, u)]),  # x cancels
        (p.mul(plus(x, u), p.power(y, -2)), [p.div(u, p.power(y, 2)), p.power(y, -2)]),
        (p.fn("sin", y), [p.fn("sin", y)]),
        (x, [p.zero, one]),
    ],
)
def test_the_coefficients_by_hand(expr: Expr, coefficients: list[Expr]) -> None:
    found = powers(p, expr, x)
    assert found is not None and len(found) == len(coefficients)
    assert all(same(f, c) for f, c in zip(found, coefficients, strict=True))


@pytest.mark.parametrize("expr", [p.power(x, -1), p.power(plus(x, y), -1), p.fn("sin", x)])
def test_what_is_no_polynomial(expr: Expr) -> None:
    assert powers(p, expr, x) is None


def test_a_degree_is_allowed_up_to_the_limit() -> None:
    whole = p.power(plus(x, y), 4)
    assert powers(p, whole, x, most=3) is None
    found = powers(p, whole, x, most=4)
    assert found is not None and len(found) == 5
    assert powers(p, p.mul(plus(x, y), p.power(plus(x, u), 3)), x, most=3) is None


@pytest.mark.parametrize(
    ("expr", "left"),
    [
        (plus(p.mul(x, y), p.power(x, 2)), plus(y, x)),
        (p.mul(p.power(x, 2), plus(u, y)), plus(u, y)),
        (plus(x, y), plus(x, y)),  # not all of it
        (plus(p.mul(x, p.der(x)), p.power(x, 2)), plus(p.der(x), x)),
        (p.sub(p.power(plus(x, y), 2), plus(p.mul(x, x), p.mul(y, y))), p.scale(2, y)),
    ],
)
def test_powers_that_divide_all_of_it_are_taken_out(expr: Expr, left: Expr) -> None:
    assert same(undivided(p, expr, x), left)


def test_sums_inside_of_sums_are_one_sum_without_what_cancels() -> None:
    whole = p.add((2, p.mul(x, y)), (3, p.add((1, x), (-4, y))), (-3, x))
    inner = p.add((1, x), (-1, u))
    assert summands(whole) == {p.mul(x, y): 2, y: -12}
    assert summands(p.add((2, y), (5, inner), (-5, x))) == {y: 2, u: -5}


@pytest.mark.parametrize(
    ("expr", "bases", "numerator"),
    [
        # u/m + y/m^2 - 1 times m^2
        (plus(p.div(u, m), p.mul(y, p.power(m, -2)), p.neg(one)), [m],
         plus(p.mul(u, m), y, p.neg(p.power(m, 2)))),
        # u/x + y/m over both
        (plus(p.div(u, x), p.div(y, m)), [x, m], plus(p.mul(u, m), p.mul(y, x))),
        # and over one of them: u/x + y stays a fraction in x
        (plus(p.div(u, x), p.div(y, m)), [m], plus(p.div(p.mul(u, m), x), y)),
        # (u/m) (y/m) - x
        (p.sub(p.mul(p.div(u, m), p.div(y, m)), x), [m],
         p.sub(p.mul(u, y), p.mul(x, p.power(m, 2)))),
        # (1 + u/m) x
        (p.mul(plus(one, p.div(u, m)), x), [m], p.mul(plus(m, u), x)),
        # (u/m)' - y = (u' m - u m')/m^2 - y
        (p.sub(p.der(p.div(u, m)), y), [m],
         p.sub(p.sub(p.mul(p.der(u), m), p.mul(u, p.der(m))), p.mul(y, p.power(m, 2)))),
        # (u/(x m))' = (u' x m - u x' m - u x m')/(x m)^2
        (p.der(p.div(u, p.mul(x, m))), [x, m],
         p.sub(p.mul(p.der(u), x, m),
               plus(p.mul(u, p.der(x), m), p.mul(u, x, p.der(m))))),
        # what all can be divided by is taken out again: u m/m^2 = u/m
        (p.sub(p.div(p.mul(u, m), p.power(m, 2)), p.div(y, m)), [m], p.sub(u, y)),
        # either side of a choice over the same
        (p.choose(p.compare("<", x, y), p.div(u, m), y), [m],
         p.choose(p.compare("<", x, y), u, p.mul(y, m))),
        # inside a function a quotient stays one
        (p.sub(p.fn("sin", p.div(u, m)), y), [m], p.sub(p.fn("sin", p.div(u, m)), y)),
    ],
)  # fmt: skip
def test_a_numerator_by_hand(expr: Expr, bases: list[Expr], numerator: Expr) -> None:
    assert same(cleared(p, expr, bases), numerator)


def test_only_what_whole_terms_are_divided_by_is_below_them() -> None:
    R = p.symbol("R", Kind.PARAM)
    whole = plus(p.div(u, m), p.div(y, R), p.mul(x, plus(one, p.div(y, x))), p.der(p.div(u, y)))
    assert below_terms(whole) == [m]
    lifted = cleared(p, whole, [m], inside=False)
    assert same(lifted, p.mul(m, whole))
