"""Real numbers in balls: what they are, where they have no value, and how they are drawn."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from fractions import Fraction
from itertools import pairwise
from random import Random

import mpmath
import pytest
from flint import arb, ctx

from bondgraph.field.balls import NOTHING, Imprecise, Precision, Reals
from bondgraph.field.numbers import DividedByZero, Number, Undefined
from bondgraph.ir.functions import FUNCTIONS
from bondgraph.ir.tables import turned


@pytest.fixture(autouse=True)
def bits() -> Iterator[None]:
    """As many as the reals of a model begin with, whatever ran before."""
    with ctx.workprec(Precision().bits):
        yield


F = Reals({})


def about(x: Number) -> bool:
    """Whether a number differs from zero by no more than rounding."""
    return abs(float(x)) < 1e-40


# --------------------------------------------------------------------------- what a number is


def test_a_small_ball_around_zero_is_zero_and_a_larger_one_asks_for_more_digits() -> None:
    precision = Precision()
    f = Reals({}, precision)
    small, large = (arb(0, NOTHING * share) for share in (arb(0.5), arb(2)))
    assert not f.nonzero(small) and f.sign(small) == 0
    assert f.nonzero(arb(3, 1)) and f.sign(arb(-3, 1)) == -1
    assert not f.nonzero(0) and not f.nonzero(arb(0))
    before = precision.bits
    with pytest.raises(Imprecise):
        f.nonzero(large)
    assert precision.bits == ctx.prec == 2 * before


def test_digits_are_doubled_until_no_number_of_them_would_help() -> None:
    """From 512 bits to 8192, each time twice as many: four times that is told to be for more."""
    precision = Precision()
    told = [precision.more() for _ in range(6)]
    assert [isinstance(reason, Imprecise) for reason in told] == [True] * 4 + [False] * 2
    assert isinstance(told[-1], Undefined) and precision.bits == ctx.prec == 8192


def test_a_plant_with_few_digits_takes_none_from_one_with_many() -> None:
    with ctx.workprec(2048):
        assert Precision().more() and ctx.prec == 2048
        Reals({})
        assert ctx.prec == 2048


def test_fractions_and_reciprocals_are_those_of_their_numbers() -> None:
    assert about(F.fraction(Fraction(-22, 7)) * 7 + 22) and F.fraction(5) == 5
    assert all(about(F.reciprocal_of(k) * k - 1) for k in (7, 1, 2, 12))


@pytest.mark.parametrize(
    ("base", "exponent", "value"),
    [
        (3, Fraction(4), Fraction(81)),
        (3, Fraction(0), Fraction(1)),
        (-2, Fraction(3), Fraction(-8)),
        (-2, Fraction(-3), Fraction(-1, 8)),
        (9, Fraction(1, 2), Fraction(3)),
        (9, Fraction(3, 2), Fraction(27)),
        (9, Fraction(-3, 2), Fraction(1, 27)),
        (8, Fraction(2, 3), Fraction(4)),
        (8, Fraction(-1, 3), Fraction(1, 2)),
        (0, Fraction(2), Fraction(0)),
        (0, Fraction(1, 2), Fraction(0)),
        (0, Fraction(5, 3), Fraction(0)),
    ],
)
def test_rational_powers(base: int, exponent: Fraction, value: Fraction) -> None:
    assert about(F.power(arb(base), exponent) - F.fraction(value))


@pytest.mark.parametrize(
    ("base", "exponent", "error"),
    [
        (0, Fraction(-1), DividedByZero),
        (0, Fraction(-1, 2), Undefined),
        (-9, Fraction(1, 2), Undefined),
        (-8, Fraction(1, 3), Undefined),
    ],
)
def test_powers_without_a_value(base: int, exponent: Fraction, error: type[Exception]) -> None:
    with pytest.raises(error):
        F.power(arb(base), exponent)


def _odd(power: Callable[[mpmath.mpf], mpmath.mpf]) -> Callable[[mpmath.mpf], mpmath.mpf]:
    return lambda x: mpmath.sign(x) * power(abs(x))


_EXPECTED: dict[str, Callable[[mpmath.mpf], mpmath.mpf]] = {
    "abs": abs, "sign": mpmath.sign, "sqrt": mpmath.sqrt, "exp": mpmath.exp, "log": mpmath.log,
    "ssqrt": _odd(mpmath.sqrt), "cbrt": _odd(mpmath.cbrt), "ssq": _odd(lambda x: x * x),
    **{n: getattr(mpmath, n) for n in ("sin", "cos", "tan", "asin", "acos", "atan")},
    **{n: getattr(mpmath, n) for n in ("sinh", "cosh", "tanh", "asinh", "acosh", "atanh")},
}  # fmt: skip
_ENDS = {"sqrt": (0, None), "asin": (-1, 1), "acos": (-1, 1), "atanh": (-1, 1)}
_ENDS |= {"log": (0, None), "acosh": (1, None)}


@pytest.mark.parametrize("name", sorted(set(FUNCTIONS) - {"pow", "min", "max", "atan2"}))
def test_functions_have_the_values_of_another_library_and_none_beyond_their_ends(name: str) -> None:
    low, high = _ENDS.get(name, (None, None))
    with mpmath.workdps(60):
        for at in map(Fraction, "-5 -3/2 -1/3 1/7 2/3 7/5 9/2".split()):
            if (low is not None and at < low) or (high is not None and at > high):
                with pytest.raises(Undefined):
                    F.value(name, F.fraction(at))
                continue
            expected = _EXPECTED[name](mpmath.mpf(at.numerator) / at.denominator)
            found = F.value(name, F.fraction(at))
            assert abs(mpmath.mpf(found.mid().str(50, radius=False)) - expected) < 1e-45


def test_functions_at_zero_and_at_the_ends_of_what_they_are_defined_for() -> None:
    zero = arb(0)
    for name in ("abs", "sign", "sqrt", "ssqrt", "cbrt", "ssq", "sin", "atan", "sinh"):
        assert F.value(name, zero) == 0
    for name, end in (("asin", 1), ("acos", -1), ("atanh", 1), ("acosh", 1), ("log", 0)):
        with pytest.raises(Undefined):
            F.value(name, arb(end))


def test_no_exponential_is_larger_than_any_machine_could_mean() -> None:
    for function in (F.exp, F.hyperbola):
        function(arb(99_999))
        function(arb(-99_999))
        for x in (100_000, -100_000):
            with pytest.raises(Undefined):
                function(arb(x))


def test_circles_and_hyperbolas_give_the_even_function_first_and_an_angle_undoes_them() -> None:
    cosine, sine = F.circle(arb(2))
    assert about(cosine - F.value("cos", arb(2))) and about(sine - F.value("sin", arb(2)))
    assert about(F.angle(cosine, sine) - 2)
    cosh, sinh = F.hyperbola(arb(2))
    assert about(cosh - F.value("cosh", arb(2))) and about(sinh - F.value("sinh", arb(2)))


# ------------------------------------------------------------------------------------- tables

_LINE = tuple((Fraction(x), Fraction(y)) for x, y in ((-1, 3), (1, 7), (2, 4)))


@pytest.mark.parametrize(
    ("x", "value", "slope"),
    [
        (-4, 3, 0),  # constant before the first point
        (0, 5, 2),
        (Fraction(3, 2), Fraction(11, 2), -3),
        (2, 4, 0),  # at the last point what is beyond counts
        (9, 4, 0),
        (1, 7, -3),
        (-1, 3, 2),
    ],
)
def test_a_table_is_straight_between_its_points(
    x: Fraction | int, value: Fraction | int, slope: int
) -> None:
    patch = Reals({"t": _LINE}).table("table:t", [F.fraction(x)])
    assert about(patch.f - F.fraction(value)) and about(patch.a - slope)
    assert (patch.b, patch.c, patch.d) == (0, 0, 0)


_FALLING = tuple(tuple(map(Fraction, row)) for row in ((0, 1, 2), (0, 9, 12), (2, 5, 4), (3, 1, 3)))


def test_a_map_that_falls_is_read_backwards_from_its_last_line_to_its_first() -> None:
    """At y = 1.5 its heights are 10.5, 4.5 and 2 for x = 0, 2, 3; 7.5 is in the middle of two."""
    f = Reals({"m'": _FALLING, "m''": turned(_FALLING)})
    y = F.fraction(Fraction(3, 2))
    patch = f.table("table:m'", [F.fraction(Fraction(15, 2)), y])
    assert about(patch.f - 1) and about(patch.a * -3 - 1)
    # x moves with y so that z stays: dz/dy between the lines is 3 and -1 in the middle of which 1
    assert about(patch.b * -3 + 1)
    for z in (2, 1, F.fraction(Fraction(21, 2)), 11):
        with pytest.raises(Undefined):
            f.table("table:m'", [arb(z), y])


# ------------------------------------------------------------------------------ random numbers


def _drawn(draw: Callable[[Random], Number], count: int = 400) -> list[float]:
    random = Random(1)
    return sorted(float(draw(random)) for _ in range(count))


def test_signals_have_either_sign_and_about_the_scale() -> None:
    for scale in (1.0, 1e-3):
        sizes = [x / scale for x in _drawn(Reals({}, scale=scale).any)]
        assert 150 < sum(x < 0 for x in sizes) < 250
        middle = sorted(map(abs, sizes))[200]
        assert 0.7 < middle < 1.4 and max(sizes) > 3 and min(map(abs, sizes)) < 0.3


def test_a_parameter_elsewhere_is_within_a_factor_of_two_and_none_is_around_zero() -> None:
    found = _drawn(lambda r: F.around(r, arb(-6)))
    assert -12 <= found[0] < -11 and -3.3 < found[-1] <= -3
    found = _drawn(lambda r: F.around(r, arb(0)))
    assert -1 <= found[0] < -0.9 and 0.9 < found[-1] <= 1


@pytest.mark.parametrize("turn", [False, True])
def test_a_fault_makes_a_parameter_larger_or_smaller_by_a_factor_of_any_size(turn: bool) -> None:
    found = _drawn(lambda r: F.off(r, arb(5), turn, False))
    factors = sorted(x / (-5 if turn else 5) for x in found)
    assert 1 / 101 <= factors[0] < 1 / 50 and 50 < factors[-1] <= 101
    nearest = min(abs(x - 1) for x in factors)
    assert 0.03 < nearest < 0.1
    assert 150 < sum(x < 1 for x in factors) < 250


def test_errors_are_of_either_sign_some_of_one_and_some_of_the_reading() -> None:
    for value in (1000, 0):
        sizes = [abs(x) for x in _drawn(lambda r, v=value: F.error(r, arb(v)))]
        assert 0.03 <= min(sizes) < 0.1 and max(sizes) <= 100 * max(value, 1)
        assert (sum(x > 100 for x in sizes) > 100) == (value > 0)
    signs = [x < 0 for x in _drawn(lambda r: F.error(r, arb(1)))]
    assert 150 < sum(signs) < 250
    zero = [abs(x) for x in _drawn(lambda r: F.off(r, arb(0), False, False))]
    assert min(zero) >= 0.03 and 50 < max(zero) <= 100


@pytest.mark.parametrize("turn", [False, True])
def test_what_is_compared_changes_to_the_size_of_signals_every_second_time(turn: bool) -> None:
    """A limit of 10**-6 times at most 101 is under 0.0002, and every signal is above 0.003."""
    side = -1 if turn else 1
    limit, scale = arb(10) ** -6, Reals({}, scale=0.1)
    found = sorted(side * x for x in _drawn(lambda r: scale.off(r, limit, turn, True)))
    assert found[0] > 0 and 150 < sum(x >= 0.003 for x in found) < 250
    assert 5 < found[-1] <= 10


def test_an_error_of_what_is_compared_takes_it_across_a_limit_from_where_it_is() -> None:
    """From 3 to beyond 1000 or -1000: no other error of 3 is as large."""
    told = [3 + x for x in _drawn(lambda r: F.error(r, arb(3), [arb(1000)]))]
    beyond = [x for x in told if abs(x) >= 1000]
    assert 150 < len(beyond) < 250 and max(map(abs, told)) < 2010
    assert 60 < sum(x < 0 for x in beyond) < 140
    at_it = _drawn(lambda r: F.error(r, arb(0), [arb(0)]))  # no way across: as any other
    assert min(map(abs, at_it)) >= 0.03


def _arguments(
    of: str,
    at: int = 0,
    scales: tuple[float, ...] = (),
    beside: tuple[int, ...] = (),
    f: Reals = F,
) -> list[float]:
    others = [arb(x) for x in beside]
    return _drawn(lambda r: f.argument(r, of, at, list(scales), others))


@pytest.mark.parametrize("of", ["asin", "acos", "atanh"])
def test_an_argument_is_one_that_the_function_has_a_value_at(of: str) -> None:
    found = _arguments(of)
    assert -0.95 <= found[0] < -0.9 and 0.9 < found[-1] <= 0.95


def test_a_logarithm_is_asked_of_positive_numbers_and_an_acosh_of_those_above_one() -> None:
    for of in ("log", "sqrt", "pow"):
        found = _arguments(of)
        assert 0 < found[0] < 0.3 and 0.7 < found[200] < 1.4 and found[-1] > 3
    found = _arguments("acosh")
    assert 1 < found[0] < 1.3 and 1.7 < found[200] < 2.4


def test_a_table_is_asked_within_its_points_and_beyond_unless_it_is_read_backwards() -> None:
    """From -1 to 2 by a fifth of its width each way, and by three of them at times."""
    found = _arguments("table:t", f=Reals({"t": _LINE}))
    assert -10 <= found[0] < -5 and 6 < found[-1] <= 11
    inside = sum(-1.6 <= x <= 2.6 for x in found)
    assert 250 < inside < 380 and any(-1.6 < x < -1 for x in found)
    only = _arguments("table:t", f=Reals({"t": _LINE, "t'": _LINE}))
    assert -1 <= only[0] < -0.9 and 1.9 < only[-1] <= 2
    f = Reals({"m": _FALLING, "m''": turned(_FALLING)})
    across = _arguments("table:m", at=1, f=f)
    assert across[0] >= 1 and across[-1] <= 2
    assert _arguments("table:m", f=f)[0] < 0 < 3 < _arguments("table:m", f=f)[-1]


def test_a_decision_falls_near_what_it_is_compared_with_or_the_numbers_of_its_law() -> None:
    def about_size(found: list[float], size: float) -> int:
        return sum(size / 5 < abs(x) < size * 5 for x in found)

    for of in ("decision", "min", "max"):
        found = _arguments(of, scales=(1e6,), beside=(0, -1000))
        near, far = about_size(found, 1000), about_size(found, 1e6)
        assert 150 < near < 250 and 80 < far < 200 and near + far < 390
        assert sum(x < 0 for x in found if 200 < abs(x) < 5000) == near  # of its sign
    for of in ("product", "value", "abs", "sign"):
        found = _arguments(of, scales=(0, 1e6), beside=(1000,))
        assert about_size(found, 1000) < 10 and 230 < about_size(found, 1e6) < 320
        assert 150 < sum(x < 0 for x in found) < 250
    assert about_size(_arguments("sin", scales=(1e6,), beside=(1000,)), 1.0) > 370
    small = _arguments("sin", f=Reals({}, scale=1e-3))
    assert about_size(small, 1e-3) > 370


def test_the_same_seed_draws_the_same_numbers() -> None:
    assert _arguments("decision", scales=(2.0,)) == _arguments("decision", scales=(2.0,))
    assert all(a < b for a, b in pairwise(_drawn(F.any)))  # and no number twice


@pytest.mark.parametrize("falls", [False, True])
def test_a_map_of_two_lines_is_read_backwards_as_it_rises_or_falls(falls: bool) -> None:
    """Heights 4 and 10 at x = 1 and 3, or the other way round: 7 is that of x = 2."""
    low, high = (10, 4) if falls else (4, 10)
    told = ((0, 1, 2), (1, low, low), (3, high, high))
    f = Reals({"m'": tuple(tuple(map(Fraction, row)) for row in told)})
    patch = f.table("table:m'", [arb(7), f.fraction(Fraction(3, 2))])
    assert about(patch.f - 2) and about(patch.a * (-3 if falls else 3) - 1)
