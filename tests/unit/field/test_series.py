"""Series functions against their differential equations and against rational series of SymPy."""

from fractions import Fraction
from random import Random

import pytest
import sympy

from bondgraph.field import series
from bondgraph.field.balls import Reals
from bondgraph.field.numbers import Numbers, Undefined
from bondgraph.field.prime import PrimeField
from bondgraph.field.series import Series
from bondgraph.ir.functions import FUNCTIONS
from bondgraph.ir.tables import turned

N = 6
TABLE = tuple((Fraction(k), Fraction(k * k)) for k in range(-3, 4))
_Y = (-2, 1, 3)  # a map that rises with both of its inputs
MAP = tuple(
    tuple(map(Fraction, row))
    for row in ((0, *_Y), *[(x, *[(x + 2) ** 2 * (y + 3) for y in _Y]) for x in (-1, 2, 4)])
)
KINDS: list[Numbers] = [
    PrimeField(3), Reals({"t": TABLE, "m": MAP, "m'": MAP, "m''": turned(MAP)})
]  # fmt: skip
kinds = pytest.mark.parametrize("f", KINDS, ids=["field", "reals"])


def random_series(f: Numbers, seed: int, n: int = N) -> Series:
    draw = Random(seed)
    return [f.any(draw) for _ in range(n)]


def same(f: Numbers, a: Series, b: Series, n: int = N) -> bool:
    a, b = ((x + [0] * n)[:n] for x in (a, b))
    return not any(f.nonzero(x - y) for x, y in zip(a, b, strict=True))


_ONE = sorted(set(FUNCTIONS) - {"pow", "min", "max", "atan2"})


@kinds
@pytest.mark.parametrize("name", [*_ONE, "table:t"])
def test_functions_obey_the_chain_rule(f: Numbers, name: str) -> None:
    done = 0
    for seed in range(30):
        a = random_series(f, seed)
        try:
            value = series.function(f, name, a, N)
            slope = series.slope_of(f, name, a, value, N)
        except Undefined:
            continue
        expected = series.mul(slope, series.derivative(a), N - 1)
        assert same(f, series.derivative(value), expected, N - 1)
        if name in FUNCTIONS:
            assert not f.nonzero(value[0] - f.value(name, a[0]))
        done += 1
    assert done > 3


@kinds
@pytest.mark.parametrize("name", ["pow", "min", "max", "atan2", "table:m", "table:m'", "table:m''"])
def test_functions_of_two_arguments_obey_the_chain_rule(f: Numbers, name: str) -> None:
    done = 0
    for seed in range(30):
        a, b = random_series(f, seed), random_series(f, seed + 100)
        try:
            value = series.function_of_two(f, name, a, b, N)
            da, db = series.slopes_of_two(f, name, a, b, value, N)
        except Undefined:
            continue
        expected = series.add(
            series.mul(da, series.derivative(a), N - 1), series.mul(db, series.derivative(b), N - 1)
        )
        assert same(f, series.derivative(value), expected, N - 1)
        done += 1
    assert done > 3


@pytest.mark.parametrize("name", sorted(set(FUNCTIONS) - {"pow", "min", "max", "atan2", "sign"}))
def test_slopes_are_limits_of_difference_quotients(name: str) -> None:
    f = Reals({})
    h = f.fraction(Fraction(1, 2**40))
    done = 0
    for at in (Fraction(-7, 3), Fraction(-2, 5), Fraction(1, 3), Fraction(5, 2)):
        x = f.fraction(at)
        try:
            value, low, high = f.value(name, x), f.value(name, x - h), f.value(name, x + h)
        except Undefined:
            continue
        (slope,) = series.slope_of(f, name, [x], [value], 1)
        assert abs(float(slope - (high - low) / (2 * h))) < 1e-15, at
        done += 1
    assert done > 0


@pytest.mark.parametrize(
    ("name", "a", "b", "value"),
    [
        ("atan2", 1, -1, 2.356194490192345),  # 3 pi/4: the angle of the point at x = -1, y = 1
        ("atan2", -1, -1, -2.356194490192345),
        ("atan2", 3, 0, 1.5707963267948966),
        ("pow", 2, 10, 1024.0),
        ("min", 2, -5, -5.0),
        ("max", 2, -5, 2.0),
    ],
)
def test_functions_of_two_arguments_begin_at_their_value(
    name: str, a: int, b: int, value: float
) -> None:
    f = Reals({})
    found = series.function_of_two(f, name, [f.number(a), f.number(7)], [f.number(b)], 2)
    assert float(found[0]) == pytest.approx(value, rel=1e-15)


def rational(f: Numbers, expression: sympy.Expr, t: sympy.Symbol) -> Series:
    poly = sympy.series(expression, t, 0, N).removeO()
    found = [sympy.Rational(poly.coeff(t, k)) for k in range(N)]
    return [f.fraction(Fraction(int(c.p), int(c.q))) for c in found]


@kinds
def test_rational_operations_agree_with_sympy(f: Numbers) -> None:
    t = sympy.Symbol("t")
    x = 2 + 3 * t - t**2 / 5 + t**4
    y = sympy.Rational(1, 7) - t + 2 * t**3
    a, b = rational(f, x, t), rational(f, y, t)
    assert same(f, series.mul(a, b, N), rational(f, x * y, t))
    assert same(f, series.reciprocal(f, a, N), rational(f, 1 / x, t))
    assert same(f, series.power(f, b, -3, N), rational(f, y**-3, t))
    assert same(f, series.power(f, a, 5, N), rational(f, x**5, t))
    square = series.mul(a, a, N)
    root = series.rational_power(f, square, Fraction(1, 2), N)
    assert same(f, root, a) or same(f, root, series.scale(-1, a))  # the positive one of the two
    assert not f.nonzero(f.fraction(Fraction(1, 3)) * 3 - 1)


@kinds
def test_integral_undoes_the_derivative(f: Numbers) -> None:
    a = random_series(f, 1)
    assert same(f, series.integral(f, series.derivative(a), a[0]), a)


@kinds
def test_a_short_series_stands_for_zeros(f: Numbers) -> None:
    a = random_series(f, 2)
    assert series.add([5], a)[1:] == a[1:]
    assert same(f, series.mul([3], a, N), series.scale(3, a))
    assert same(f, series.reciprocal(f, [4], N), [f.inverse(4)])
    with pytest.raises(Undefined):
        series.reciprocal(f, [0, 1], N)


@pytest.mark.parametrize("x", [-4, -1, 0, 2, 3, 9])
@pytest.mark.parametrize("y", [-5, -2, 0, 1, 2, 7])
def test_a_map_is_bilinear_between_its_numbers_and_flat_beyond(x: int, y: int) -> None:
    # (x + 2)**2 (y + 3) is linear in y; in x its chords from -1 to 2 and to 4 are 5 x + 6, 10 x - 4
    a, b = min(max(x, -1), 4), min(max(y, -2), 3)
    chord = 5 * a + 6 if a < 2 else 10 * a - 4
    f = Reals({"m": MAP, "m'": MAP, "m''": turned(MAP)})
    args = [f.number(x), f.number(y)]
    patch = f.table("table:m", args)
    assert not f.nonzero(patch.f - chord * (b + 3))
    if -1 < x < 4:
        slope = (5 if x < 2 else 10) * (b + 3)
        assert not f.nonzero(patch.a - slope)
        back = f.table("table:m'", [patch.f, args[1]])
        assert not f.nonzero(back.f - x) and not f.nonzero(back.a * slope - 1)
    if -2 < y < 3:
        assert not f.nonzero(patch.b - chord)
        assert not f.nonzero(f.table("table:m''", [patch.f, args[0]]).f - y)


def test_a_table_read_backwards_has_no_value_from_either_end_on() -> None:
    # a table that is 3 from x = 2 on: a reading of 3 is that of many arguments
    back = "t'"
    f = Reals({back: ((Fraction(0), Fraction(0)), (Fraction(3), Fraction(2)))})
    for end in (-1, 0, 3, 4):
        with pytest.raises(Undefined):
            f.table(f"table:{back}", [f.number(end)])
    value, slope, *_ = f.table(f"table:{back}", [f.number(2)])
    assert not f.nonzero(3 * value - 4) and not f.nonzero(3 * slope - 2)
