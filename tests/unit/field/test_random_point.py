"""Values and slopes at a random point, by arithmetic modulo the prime written out."""

from __future__ import annotations

from fractions import Fraction

import pytest

from bondgraph.field.prime import P
from bondgraph.field.random_point import RandomPoint, residue
from bondgraph.ir.expr import Expr, Kind, Pool

p = Pool()
x, y, z = (p.symbol(n, Kind.SENSOR) for n in "xyz")
a = p.symbol("a", Kind.PARAM)


def everything(_: Expr) -> bool:
    return True


@pytest.mark.parametrize(
    "value", [Fraction(3), Fraction(-7), Fraction(1, 2), Fraction(2, 3), Fraction(-5, 4)]
)
def test_a_residue_times_its_denominator_is_the_numerator(value: Fraction) -> None:
    assert residue(value) * value.denominator % P == value.numerator % P
    assert 0 <= residue(value) < P


def test_what_has_no_value_has_none() -> None:
    point = RandomPoint(1)
    nothing = p.sub(p.power(p.add((1, x), (1, y)), 2), p.mul(x, x))
    gone = p.sub(nothing, p.add((2, p.mul(x, y)), (1, p.mul(y, y))))  # zero, unseen by the pool
    assert point.value(gone) == 0
    assert point.value(p.power(gone, -1)) is None
    assert point.value(p.add((1, x), (1, p.power(gone, -1)))) is None
    with pytest.raises(ValueError):
        residue(Fraction(1, P))
    assert set(point.gradient(p.mul(x, p.power(gone, -1)), lambda s: s is x)) == {x}


def test_the_slopes_of_a_rational_expression() -> None:
    """d(3 x^2/y + a x) = (6 x/y + a) dx - 3 x^2/y^2 dy + x da, at the point."""
    point = RandomPoint(5)
    X, Y, A = (point.value(s) for s in (x, y, a))
    assert X is not None and Y is not None and A is not None and len({X, Y, A}) == 3
    law = p.add((3, p.mul(p.power(x, 2), p.power(y, -1))), (1, p.mul(a, x)))
    one = pow(Y, -1, P)
    expected = {x: (6 * X * one + A) % P, y: -3 * X * X * one * one % P, a: X}
    assert point.gradient(law, everything) == expected
    assert point.gradient(law, lambda s: s is y) == {y: expected[y]}
    assert point.gradient(p.add((1, law), (1, z), (-1, z)), lambda s: s is z) == {}


def test_slopes_that_cancel_are_left_out() -> None:
    law = p.sub(p.power(p.add((1, x), (1, y)), 2), p.mul(y, p.add((2, x), (1, y))))  # x^2
    assert set(RandomPoint(1).gradient(law, everything)) == {x}


def test_a_derivative_multiplies_by_the_rate_and_an_integral_divides() -> None:
    rate, start = 12345, p.symbol("s.q0", Kind.CONST)
    law = p.add((5, p.der(x, 2)), (1, x), (2, p.integral(y, start)))
    found = RandomPoint(1).gradient(law, lambda s: s in (x, y), rate)
    assert found == {x: (5 * rate**2 + 1) % P, y: 2 * pow(rate, -1, P) % P}
    assert RandomPoint(1).gradient(law, lambda s: s in (x, y)) == {x: 1}


def test_the_slope_of_a_function_is_a_number_of_its_own() -> None:
    """The same for the same function of the same, so that equal terms cancel; else another."""
    point = RandomPoint(1)
    sine, other = p.fn("sin", p.mul(a, x)), p.fn("tanh", p.mul(a, x))
    A, X = point.value(a), point.value(x)
    assert A is not None and X is not None
    (dx, da) = (point.gradient(sine, everything)[s] for s in (x, a))
    assert dx * X % P == da * A % P  # s a and s x
    assert point.gradient(p.sub(p.mul(y, sine), p.mul(y, sine)), everything) == {}
    assert point.gradient(other, everything)[x] != dx


def test_a_sine_and_a_cosine_are_on_one_circle_and_no_other_two() -> None:
    point = RandomPoint(3)
    for angle in (x, p.add((2, x), (1, a)), y):
        sine, cosine = (point.value(p.fn(name, angle)) for name in ("sin", "cos"))
        assert sine is not None and cosine is not None
        assert (sine * sine + cosine * cosine) % P == 1 and sine not in (0, 1)
    one, other = point.value(p.fn("sin", x)), point.value(p.fn("cos", y))
    assert one is not None and other is not None and (one * one + other * other) % P != 1


def test_what_is_given_for_a_symbol_stands_for_it() -> None:
    point = RandomPoint(1, {x: p.add((2, y), (1, p.one))})
    Y = point.value(y)
    assert Y is not None and point.value(x) == (2 * Y + 1) % P
    assert RandomPoint(1).value(x) != point.value(x)


def test_other_seeds_are_other_points_and_the_same_seed_is_the_same() -> None:
    assert RandomPoint(1).value(x) == RandomPoint(1).value(x) != RandomPoint(2).value(x)
