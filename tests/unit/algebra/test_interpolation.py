"""Tables and the cubics of tanh, against what they stand for."""

from __future__ import annotations

import math
from fractions import Fraction

import pytest

from bondgraph.algebra.cubic_tanh import (
    BITS,
    BOUND,
    CUBICS,
    END,
    LEAST_BITS,
    MOST_BITS,
    cubic_tanh,
    cubics,
)
from bondgraph.algebra.interpolation import interpolation

#: At the knots z = x + 10 y + x y, which is bilinear, but for the last row, where it is 100 more.
_MAP = tuple(
    tuple(Fraction(v) for v in row)
    for row in ((0, -1, 0, 2), (0, -10, 0, 20), (1, -10, 1, 23), (3, 90, 103, 129))
)


@pytest.mark.parametrize(
    ("at", "value"),
    [(-9, 7), (0, 7), (1, 8), (2, 9), (3, 4), (4, -1), (6, 0), (8, 1), (10, 2), (11, 2)],
)
def test_a_table_is_straight_between_its_points_and_constant_beyond(at: int, value: int) -> None:
    """From 7 it goes up by one a unit, down by five, up by a half."""
    points = [(Fraction(x), Fraction(y)) for x, y in ((0, 7), (2, 9), (4, -1), (10, 2))]
    assert interpolation(points)(Fraction(at)) == value


@pytest.mark.parametrize("x", [Fraction(0), Fraction(1, 3), Fraction(1)])
def test_a_map_of_a_bilinear_function_is_that_function(x: Fraction) -> None:
    for y in (Fraction(-1), Fraction(-1, 4), Fraction(0), Fraction(3, 2), Fraction(2)):
        assert interpolation(_MAP)(x, y) == x + 10 * y + x * y


def test_a_map_between_its_last_knots_and_beyond_all() -> None:
    value = interpolation(_MAP)
    assert value(Fraction(2), Fraction(1)) == 2 + 10 + 2 + 50  # half of the hundred
    assert value(Fraction(9), Fraction(9)) == 129
    assert value(Fraction(-9), Fraction(-9)) == -10
    assert value(Fraction(1), Fraction(9)) == 23


@pytest.mark.parametrize("x", [0.25, 0.75, 1.0, 2.5])
@pytest.mark.parametrize("y", [0.0, 0.5, 2.0])
def test_a_map_that_is_read_backwards_undoes_itself(x: float, y: float) -> None:
    rows = tuple(tuple(map(float, row)) for row in _MAP)
    z = interpolation(rows)(x, y)
    assert interpolation(rows, True)(z, y) == pytest.approx(x, abs=1e-6)


def test_a_map_that_is_read_backwards_has_no_value_beyond_its_ends() -> None:
    rows = tuple(tuple(map(float, row)) for row in _MAP)
    assert math.isnan(interpolation(rows, True)(-5.0, 0.0))
    assert math.isnan(interpolation(rows, True)(200.0, 0.0))


@pytest.mark.parametrize("bits", [LEAST_BITS, 10, 20, MOST_BITS])
def test_tanh_is_as_near_as_the_bound_says(bits: int) -> None:
    """From below to beyond the table, and beside the ends of its cubics; it is odd."""
    scale = 1 << bits
    places = {k * scale // CUBICS + d for k in range(END * CUBICS + 2) for d in (-1, 0, 1)}
    places |= {k * scale // 37 for k in range(40 * 8)}
    for value in sorted(v for v in places if 0 <= v < 1 << 31):
        found = cubic_tanh(value, bits)
        assert abs(found / 2.0**BITS - math.tanh(value / scale)) <= BOUND
        assert value == 0 or cubic_tanh(-value, bits) == -found


def test_a_cubic_is_tanh_at_the_points_of_chebyshev() -> None:
    """Interpolation: at its four points each of them has the value of tanh, up to rounding."""
    points = [0.5 + 0.5 * math.cos(math.pi * (2 * k + 1) / 8.0) for k in range(4)]
    assert len(cubics()) == END * CUBICS
    for number, own in enumerate(cubics()):
        c = [v / 2.0 ** (BITS + k) for k, v in enumerate(own)]
        for t in points:
            value = c[0] + c[1] * t + c[2] * t**2 + c[3] * t**3
            assert value == pytest.approx(math.tanh((number + t) / CUBICS), abs=2.0**-28)
