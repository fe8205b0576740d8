"""What SymPy is asked for, against solutions, slopes and divisors that are known by hand."""

from __future__ import annotations

from fractions import Fraction

import pytest

from bondgraph.algebra.numeric import evaluate
from bondgraph.algebra.solve_symbolic import (
    simplified_slope,
    solve_symbolic,
    without_common_factor,
)
from bondgraph.algebra.zero import is_zero
from bondgraph.ir.expr import Expr, Kind, Pool, topological

p = Pool()
a, b, c = (p.symbol(name, Kind.PARAM) for name in "abc")
f, g = p.symbol("f", Kind.FLOW), p.symbol("g", Kind.SENSOR)


def plus(*terms: Expr) -> Expr:
    return p.add(*[(1, term) for term in terms])


def same(left: Expr | None, right: Expr) -> bool:
    return left is not None and is_zero(p.sub(left, right))


# --------------------------------------------------------------------------- one variable


@pytest.mark.parametrize(
    ("zero", "expected"),
    [
        # g = a f/(b + f) at f = b g/(a - g)
        (p.sub(p.div(p.mul(a, f), plus(b, f)), g), p.div(p.mul(b, g), p.sub(a, g))),
        # a f + b (f + c) = g
        (p.sub(plus(p.mul(a, f), p.mul(b, plus(f, c))), g),
         p.div(p.sub(g, p.mul(b, c)), plus(a, b))),
        # f (f + a) - f^2 = g is linear once it is multiplied out
        (p.sub(p.sub(p.mul(f, plus(f, a)), p.power(f, 2)), g), p.div(g, a)),
        # functions of other things are numbers here
        (p.sub(p.div(f, plus(f, p.fn("exp", a))), b),
         p.div(p.mul(b, p.fn("exp", a)), p.sub(p.one, b))),
        (p.sub(p.mul(p.num(Fraction(2, 3)), f), g), p.scale(Fraction(3, 2), g)),
    ],
)  # fmt: skip
def test_an_equation_that_is_linear_without_fractions_is_solved(
    zero: Expr, expected: Expr
) -> None:
    assert same(solve_symbolic(p, zero, f), expected)


@pytest.mark.parametrize(
    "zero",
    [
        p.sub(p.power(f, 2), g),
        p.sub(p.mul(f, plus(f, a)), g),
        p.sub(p.div(a, f), p.div(b, f)),  # (a - b)/f is zero nowhere
        p.sub(p.fn("exp", f), g),
        p.sub(p.mul(f, p.fn("sqrt", f)), g),
        p.sub(p.choose(p.compare("<", f, g), f, f), p.choose(p.symbol("on", Kind.MODE), f, g)),
    ],
)
def test_all_others_have_no_solution_that_holds_for_all_parameters(zero: Expr) -> None:
    assert solve_symbolic(p, zero, f) is None


@pytest.mark.parametrize(("terms", "shortened"), [(500, True), (501, False)])
def test_long_equations_are_solved_without_being_multiplied_out(
    terms: int, shortened: bool
) -> None:
    """sum of k a^k f = a g: the factor a is seen where the equation is short enough for SymPy."""
    zero = p.add(*[(k, p.mul(p.power(a, k), f)) for k in range(1, terms)], (-1, p.mul(a, g)))
    found = solve_symbolic(p, zero, f)
    assert found is not None
    at = {"a": Fraction(1, 2), "g": Fraction(3)}
    slope = sum(k * Fraction(1, 2**k) for k in range(1, terms))
    assert evaluate(found, at) == Fraction(3, 2) / slope
    powers = {e for n in topological([found]) for arg, e in n.factors if arg is a}
    assert max(powers) == (terms - 2 if shortened else terms - 1)


def test_what_a_long_coefficient_is_made_of_is_not_counted() -> None:
    """Of an equation in f the sum of 600 powers of a is one number."""
    long = p.add(*[(k, p.power(a, k)) for k in range(1, 601)])
    found = solve_symbolic(p, p.sub(p.mul(a, f, long), p.mul(a, g)), f)
    assert found is not None and found is p.div(g, long)


# ------------------------------------------------------------------------------ slopes


def test_a_slope_that_shows_its_sign() -> None:
    """Of f/sqrt(1 + f^2) it is (1 + f^2)^(-3/2), where b is positive b (b + f^2)^(-3/2)."""
    for positive in (p.one, b):
        square = plus(positive, p.power(f, 2))
        found = simplified_slope(p, p.div(f, p.fn("sqrt", square)), f, lambda n: n is b)
        assert found is not None
        assert not any(n.op.value == "add" and n is not square for n in topological([found]))
        value = evaluate(found, {"b": 2.0, "f": 1.5})
        base = 1.0 if positive is p.one else 2.0
        assert value == pytest.approx(base * (base + 2.25) ** -1.5, rel=1e-12)


def test_slopes_of_sums_of_functions_are_not_looked_at() -> None:
    assert simplified_slope(p, p.fn("exp", f), f, lambda _: True) is None
    found = simplified_slope(p, p.mul(b, p.fn("pow", f, p.num(Fraction(7, 5)))), f, lambda _: False)
    assert found is not None  # but a power is: 7/5 b f^(2/5)
    assert evaluate(found, {"b": 3.0, "f": 1.7}) == pytest.approx(4.2 * 1.7**0.4, rel=1e-12)


@pytest.mark.parametrize(("terms", "factored"), [(60, True), (61, False)])
def test_a_long_slope_is_not_factored(terms: int, factored: bool) -> None:
    zero = p.add(*[(1, p.mul(p.power(a, k), f)) for k in range(1, terms + 1)])
    found = simplified_slope(p, zero, f, lambda _: False)
    assert (found is not None) == factored
    if found is not None:
        assert evaluate(found, {"a": 2}) == 2 ** (terms + 1) - 2


# ------------------------------------------------------------------- common factors


Polynomial = list[Expr]  # in D, from D**0 up


def product(left: Polynomial, right: Polynomial) -> Polynomial:
    found = [p.zero] * (len(left) + len(right) - 1)
    for i, x in enumerate(left):
        for j, y in enumerate(right):
            found[i + j] = p.add((1, found[i + j]), (1, p.mul(x, y)))
    return found


def alike(left: Polynomial, right: Polynomial) -> bool:
    return len(left) == len(right) and all(map(same, left, right))


@pytest.mark.parametrize(
    ("one", "other", "common"),
    [
        ([a, p.one], [b, p.one], [c, p.one]),
        ([a, p.one], [b, p.zero, p.one], [plus(a, c), b]),
        ([a, p.one], [p.one], [p.num(Fraction(2, 3)), c]),
        ([p.one], [b, a], [p.one, p.zero, c]),
        ([p.div(a, b), p.one], [b, p.num(3)], [c, p.power(a, 2)]),
        # a constant of another kind is a symbol as well as any other
        ([p.symbol("q0", Kind.INITIAL), p.one], [b, p.one], [c, p.one]),
    ],
)
def test_what_two_polynomials_have_in_common_is_divided_out(
    one: Polynomial, other: Polynomial, common: Polynomial
) -> None:
    """The quotients are those that went in, but for a factor without D that is the same in both."""
    left, right = without_common_factor(p, product(one, common), product(other, common))
    assert (len(left), len(right)) == (len(one), len(other))
    assert alike(product(left, other), product(right, one))


def test_what_has_no_factor_in_common_stays_as_it_is() -> None:
    one, other = [a, p.one], [b, p.one]
    assert without_common_factor(p, one, other) == (one, other)
    with_number = product(one, [c]), product(other, [c])  # c is no polynomial in D
    assert without_common_factor(p, *with_number) == with_number
