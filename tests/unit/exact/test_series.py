"""Series functions against their differential equations and against rational series of SymPy."""

from random import Random

import pytest
import sympy

from bondgraph.exact import series
from bondgraph.exact.field import Functions, P, Undefined, of_fraction
from bondgraph.ir.expr import FUNCTIONS

N = 6


def random_series(seed: int, n: int = N) -> list[int]:
    draw = Random(seed)
    return [draw.randrange(1, P) for _ in range(n)]


def pad(a: list[int], n: int) -> list[int]:
    return (a + [0] * n)[:n]


@pytest.mark.parametrize("name", sorted(FUNCTIONS - {"pow", "min", "max", "atan2"}) + ["table:t"])
def test_functions_obey_the_chain_rule(name: str) -> None:
    f = Functions(3)
    done = 0
    for seed in range(30):
        a = random_series(seed)
        try:
            value = series.function(f, name, a, N)
            slope = series.slope_of(f, name, a, value, N)
        except Undefined:
            continue
        expected = series.mul(slope, series.derivative(a), N - 1)
        assert pad(series.derivative(value), N - 1) == pad(expected, N - 1)
        assert value[0] == f.value(name, a[0]) % P
        done += 1
    assert done > 3


@pytest.mark.parametrize("name", ["pow", "min", "max", "atan2"])
def test_functions_of_two_arguments_obey_the_chain_rule(name: str) -> None:
    f = Functions(3)
    done = 0
    for seed in range(30):
        a, b = random_series(seed), random_series(seed + 100)
        try:
            value = series.function_of_two(f, name, a, b, N)
            da, db = series.slopes_of_two(f, name, a, b, value, N)
        except Undefined:
            continue
        expected = series.add(
            series.mul(da, series.derivative(a), N - 1), series.mul(db, series.derivative(b), N - 1)
        )
        assert pad(series.derivative(value), N - 1) == pad(expected, N - 1)
        done += 1
    assert done > 3


def rational(expression: sympy.Expr, t: sympy.Symbol) -> list[int]:
    poly = sympy.series(expression, t, 0, N).removeO()
    out = []
    for k in range(N):
        c = sympy.Rational(poly.coeff(t, k))
        out.append(c.p * pow(int(c.q), -1, P) % P)
    return out


def test_rational_operations_agree_with_sympy() -> None:
    t = sympy.Symbol("t")
    x = 2 + 3 * t - t**2 / 5 + t**4
    y = sympy.Rational(1, 7) - t + 2 * t**3
    a, b = rational(x, t), rational(y, t)
    assert series.mul(a, b, N) == rational(x * y, t)
    assert series.reciprocal(a, N) == rational(1 / x, t)
    assert series.power(b, -3, N) == rational(y**-3, t)
    assert series.power(a, 5, N) == rational(x**5, t)
    square = series.mul(a, a, N)
    root = series.rational_power(square, sympy.Rational(1, 2), N)
    assert root in (a, series.scale(-1, a))  # the positive one of the two
    assert of_fraction(sympy.Rational(1, 3)) * 3 % P == 1


def test_integral_undoes_the_derivative() -> None:
    a = random_series(1)
    assert series.integral(series.derivative(a), a[0]) == a


def test_a_short_series_stands_for_zeros() -> None:
    a = random_series(2)
    assert series.add([5], a)[1:] == a[1:]
    assert series.mul([3], a, N) == series.scale(3, a)
    assert series.reciprocal([4], N) == [pow(4, -1, P)]
    with pytest.raises(Undefined):
        series.reciprocal([0, 1], N)
