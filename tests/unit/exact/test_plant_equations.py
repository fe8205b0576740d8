"""A plant's equations as forms written down by hand, in numbers of a prime field."""

from __future__ import annotations

from collections.abc import Iterable
from fractions import Fraction
from random import Random
from typing import Any

import pytest

from bondgraph.exact.assembly import Assembly, Balance, Rate
from bondgraph.exact.forms import ORDERS, Form
from bondgraph.exact.plant_equations import (
    Equation,
    FormSample,
    Setting,
    Writer,
    coefficient_row,
    constant,
    has_sides,
    made_linear,
    reach,
    signature,
    written,
)
from bondgraph.exact.signal_algebra import Mixed
from bondgraph.field.numbers import Number, Undefined
from bondgraph.field.prime import PrimeField
from bondgraph.field.series import Series
from bondgraph.field.sparse import CONSTANT
from bondgraph.ir.expr import Expr, Kind, Pool

_F = PrimeField(1)
_POOL = Pool()
_X, _Y, _Z = (_POOL.symbol(n, Kind.EFFORT) for n in "xyz")
_R, _C, _M = (_POOL.symbol(n, Kind.PARAM) for n in "RCM")
_U, _V = (_POOL.symbol(n, Kind.INPUT) for n in "uv")
_ON = _POOL.symbol("on", Kind.MODE)
_START = _POOL.symbol("x.0", Kind.FREE)
_PLACE = {_X: (0, 1), _Y: (1, -1), _Z: (2, 1), _U: (3, 1), _V: (4, 1)}
_x, _y, _z, _u = (variable * ORDERS for variable in range(4))


def _plant(**fields: Any) -> Assembly:
    """R is 7, C is 3; y is the variable 1 with the other sign, u and v are open."""
    every: dict[str, Any] = dict.fromkeys(Assembly._fields, ())
    every.update(count_of=5, place=_PLACE, free=(3,), unknown=(4,), pool=_POOL)
    return Assembly(**{**every, **fields})


def _setting(n: int = 2, **values: Series) -> Setting:
    """M is 4 + 5 t."""
    series = {_R: [_F.number(7)], _C: [_F.number(3)], _M: [_F.number(4), _F.number(5)]}
    named = {"R": _R, "on": _ON}
    return Setting(series | {named[k]: v for k, v in values.items()}, _F, n)


def _equations(
    plant: Assembly, readings: dict[str, Series] | None = None, **values: Series
) -> list[Equation]:
    return Writer(plant, _setting(**values)).all(readings or {})


def _law(law: Expr, **values: Series) -> Equation:
    """The equation of a node 9 with this law."""
    (found,) = _equations(_plant(laws=((9, law),)), **values)
    assert found.node == 9
    return found


def _sum(*terms: tuple[Fraction | int, Expr]) -> Expr:
    return _POOL.add(*terms)


def _times(*factors: tuple[Expr, int]) -> Expr:
    return _POOL.mul(*[_POOL.power(base, exponent) for base, exponent in factors])


def _number(of: int, over: int = 1) -> Number:
    return _F.fraction(Fraction(of, over))


# ------------------------------------------------------------------------------- linear laws


@pytest.mark.parametrize(
    ("law", "wanted"),
    [
        (_sum((2, _X), (-5, _POOL.one)), {_x: 2, CONSTANT: -5}),
        (_sum((Fraction(1, 2), _X), (1, _Y)), {_x: Fraction(1, 2), _y: -1}),
        (_sum((3, _POOL.der(_Z)), (1, _POOL.der(_POOL.der(_Y)))), {_z + 1: 3, _y + 2: -1}),
        (_sum((1, _X), (1, _times((_R, 1), (_X, 1)))), {_x: 8}),
        (_sum((7, _X), (-1, _times((_R, 1), (_X, 1))), (1, _Y)), {_y: -1}),
        (_times((_R, 2), (_C, -1), (_Y, 1)), {_y: Fraction(-49, 3)}),
        (_times((_R, -2), (_C, 3), (_X, 1)), {_x: Fraction(27, 49)}),
        (_sum((2, _times((_R, 1), (_C, 1))), (1, _X)), {CONSTANT: 42, _x: 1}),
    ],
)
def test_a_linear_law_is_a_number_for_each_derivative(
    law: Expr, wanted: dict[int, Fraction | int]
) -> None:
    expected = {key: [_F.fraction(weight)] for key, weight in wanted.items()}
    assert Writer(_plant(), _setting()).flat(law) == expected
    assert _law(law) == Equation(9, expected, None)


@pytest.mark.parametrize(
    "law",
    [
        _times((_X, 1), (_Y, 1)),
        _times((_X, 2)),
        _times((_X, -1)),
        _sum((1, _Y), (1, _POOL.fn("sin", _X))),
        _times((_POOL.der(_X), 1), (_Y, 1)),
    ],
)
def test_a_law_that_is_not_linear_stays_an_expression(law: Expr) -> None:
    assert Writer(_plant(), _setting()).flat(law) is None
    assert _law(law) == Equation(9, {}, law)


def test_a_coefficient_that_moves_is_a_series() -> None:
    """With M = 4 + 5 t: M x - M', and M' is 5."""
    law = _sum((1, _times((_M, 1), (_X, 1))), (-1, _POOL.der(_M)))
    assert Writer(_plant(), _setting()).flat(_times((_M, 1), (_X, 1))) is None
    assert Writer(_plant(), _setting()).flat(_POOL.der(_R)) is None
    form = _law(law).form
    assert form[_x] == [4, 5] and form[CONSTANT][0] == -5 + _number(0)


def test_linear_laws_need_not_be_written_as_sums() -> None:
    """(R + C) (x - y/2): 10 x + 5 y, as y has the other sign."""
    both = _sum((1, _R), (1, _C))
    law = _POOL.mul(both, _sum((1, _X), (Fraction(-1, 2), _Y)))
    found = _law(law)
    assert found.rest is None
    assert {key: weights[0] for key, weights in found.form.items()} == {_x: 10, _y: 5}


def test_what_is_zero_at_this_point_has_no_place_in_a_form() -> None:
    law = _sum((1, _times((_R, 1), (_X, 1))), (1, _Z))
    assert _law(law, R=[_number(0)]) == Equation(9, {_z: [_number(1)]}, None)


def test_a_constant_without_a_value_is_undefined() -> None:
    """x + 1/(R - 7) with R = 7, and x/R with R = 0."""
    with pytest.raises(Undefined):
        _law(_sum((1, _X), (1, _POOL.power(_sum((1, _R), (-7, _POOL.one)), -1))))
    with pytest.raises(Undefined):
        _law(_times((_R, -1), (_X, 1)), R=[_number(0)])


def test_initial_values_and_integrals_are_none_of_the_plant() -> None:
    setting = _setting()
    with pytest.raises(Mixed, match=r"x\.0"):
        constant(setting.values, _START)
    assert constant(setting.values, _M) == [4, 5]
    for law in (_sum((1, _START), (1, _X)), _POOL.integral(_X, _POOL.zero)):
        assert _law(law) == Equation(9, {}, law)
    with pytest.raises(Mixed):
        FormSample(_PLACE, setting).start(_START.symbol)


# ------------------------------------------------------------------------ the other equations


def test_a_switched_junction_balances_or_has_no_common_variable() -> None:
    """x - y = 0 while it is on, z = 0 while it is off; what has no terms says nothing."""
    terms = ((0, 1), (1, -1))
    plant = _plant(balances=(Balance(5, terms, _ON, 2), Balance(6, (), None, 2)))
    balance = Equation(5, {_x: [1], _y: [-1]}, None)
    assert _equations(plant, on=[_number(1)]) == [balance]
    assert _equations(plant, on=[_number(0)]) == [Equation(5, {_z: [1]}, None)]
    plant = _plant(balances=(Balance(5, terms, None, 2), Balance(6, (), _ON, 2)))
    assert _equations(plant, on=[_number(0)]) == [balance, Equation(6, {_z: [1]}, None)]


def test_detectors_rates_and_readings_are_equations() -> None:
    """z is silent; x' = R y; the sensor of z reads x + 2, and 1 - t more if it is faulty."""
    plant = _plant(
        silent=(2,),
        rates=(Rate(8, 0, _times((_R, 1), (_Y, 1))),),
        readings=(("s", 2, _sum((1, _X), (2, _POOL.one))),),
    )
    silent, rate, reading = _equations(plant)
    assert silent == Equation(-1, {_z: [1]}, None)
    assert rate == Equation(8, {_x + 1: [_number(-1)], _y: [_number(-7)]}, None)
    assert (reading.node < 0, reading.rest) == (True, None)
    assert reading.form == {_x: [1], _z: [_number(-1)], CONSTANT: [2]}
    error = [_number(1), _number(-1)]
    faulty = _equations(plant, {"s": error, "other": [_number(9)]})[-1]
    assert faulty.form[CONSTANT] == [3, _number(-1)]


def test_a_rate_that_is_not_linear_keeps_its_derivative_as_a_form() -> None:
    square = _times((_Y, 2))
    (rate,) = _equations(_plant(rates=(Rate(8, 2, square),)))
    assert rate == Equation(8, {_z + 1: [-1]}, square)


# --------------------------------------------------------------------- what equations are about


def test_a_signature_has_the_highest_derivative_of_each_variable() -> None:
    """y'' + y + 1 of the form; x y' and x''' of the rest, which is differentiated as a whole."""
    rest = _sum(
        (1, _times((_X, 1), (_POOL.der(_Y), 1))),
        (1, _POOL.der(_POOL.der(_POOL.der(_X)))),
        (1, _times((_R, 1), (_Z, 2))),
    )
    one = [_number(1)]
    form: Form = {_y: one, _y + 2: one, CONSTANT: one, _u + 1: one, _u: one}
    assert reach(_PLACE, rest) == {0: 3, 1: 1, 2: 0}
    assert signature(_PLACE, (), Equation(0, form, rest)) == {0: 3, 1: 2, 2: 0, 3: 1}
    assert signature(_PLACE, (3, 0), Equation(0, form, rest)) == {1: 2, 2: 0}
    assert signature(_PLACE, (), Equation(0, {_y + 1: one, CONSTANT: one}, None)) == {1: 1}
    assert signature(_PLACE, (), Equation(0, {_y: one}, _POOL.der(_Y))) == {1: 1}


def test_a_symbol_of_a_variable_that_has_two_counts_for_both() -> None:
    place = {_X: (0, 1), _Y: (0, -1)}
    assert reach(place, _times((_POOL.der(_X), 1), (_Y, 2))) == {0: 1}
    assert reach(place, _times((_X, 2), (_POOL.der(_Y), 1))) == {0: 1}


def test_an_equation_becomes_linear_once_its_input_is_a_constant() -> None:
    """2 y + u x with u = 4 + 5 t; while u is open it stays as it was."""
    product = _times((_U, 1), (_X, 1))
    equation = Equation(3, {_y: [_number(2)]}, product)
    setting = _setting()
    assert made_linear(equation, FormSample(_PLACE, setting), 2) == equation
    setting.values[_U] = [_number(4), _number(5)]
    given = {s: at for s, at in _PLACE.items() if s is not _U}
    found = made_linear(equation, FormSample(given, setting), 2)
    assert found == Equation(3, {_x: [4, 5], _y: [2]}, None)
    assert made_linear(found, FormSample(given, setting), 2) == found


def test_functions_of_several_branches_have_sides() -> None:
    sided = [_POOL.fn(n, _X) for n in ("sign", "abs", "table:pump")]
    sided += [_POOL.fn(n, _X, _Y) for n in ("min", "max", "atan2")]
    assert all(has_sides(node) for node in sided)
    smooth = [_POOL.fn(n, _X) for n in ("sin", "exp")]
    assert not any(has_sides(node) for node in (*smooth, _X, _times((_X, 2))))


# ---------------------------------------------------------------------------- inputs that are drawn


def _drawn(law: Expr, seed: int, moving: bool = True) -> tuple[Assembly, list[Equation], Setting]:
    setting = _setting(n=3)
    plant, equations = written(_plant(laws=((9, law),)), setting, {}, Random(seed), moving)
    return plant, equations, setting


def _open(law: Expr, seeds: Iterable[int]) -> set[frozenset[str]]:
    """The inputs that are still open, over some seeds."""
    places = [_drawn(law, seed)[0].place for seed in seeds]
    return {frozenset(s.symbol.name for s in (_U, _V) if s in place) for place in places}


@pytest.mark.parametrize(
    ("law", "still_open"),
    [
        (_sum((1, _U), (1, _X), (1, _V)), {"u", "v"}),  # of a sum of numbers times variables
        (_sum((1, _U), (1, _times((_X, 2)))), {"u", "v"}),  # of a sum it only shifts
        (_times((_U, 1), (_X, 1)), {"v"}),
        (_sum((1, _Y), (1, _times((_U, 1), (_V, 1), (_X, 1)))), set()),
        (_POOL.fn("exp", _sum((1, _U), (1, _X))), {"v"}),
        (_POOL.mul(_X, _POOL.fn("exp", _V)), {"u"}),
    ],
)
def test_an_input_is_drawn_where_a_law_has_it_in_a_product_or_a_function(
    law: Expr, still_open: set[str]
) -> None:
    assert _open(law, range(6)) == {frozenset(still_open)}


def test_an_input_behind_a_function_with_sides_is_drawn_at_about_every_second_point() -> None:
    """x v max(u, y): v in any case, u not always."""
    law = _POOL.mul(_X, _V, _POOL.fn("max", _U, _Y))
    assert _open(law, range(20)) == {frozenset("u"), frozenset()}
    nested = _POOL.mul(_X, _POOL.fn("exp", _POOL.fn("sign", _U)))
    assert _open(nested, range(20)) == {frozenset("uv"), frozenset("v")}
    both = _POOL.fn("max", _U, _times((_V, 2)))  # the function's own argument, and one below it
    assert _open(_POOL.mul(_X, both), range(20)) == {frozenset("uv"), frozenset()}
    left = sum(_U in _drawn(law, seed)[0].place for seed in range(200))
    assert 60 <= left <= 140  # 100 and six standard deviations of 7


@pytest.mark.parametrize("moving", [True, False])
def test_what_is_drawn_is_a_coefficient_of_the_law(moving: bool) -> None:
    """u x + y: y of the other sign, and x with what was drawn, which moves or does not."""
    law = _sum((1, _times((_U, 1), (_X, 1))), (1, _Y))
    plant, (equation,), setting = _drawn(law, 4, moving)
    drawn = setting.values[_U]
    assert len(drawn) == (3 if moving else 1) and len(set(map(int, drawn))) == len(drawn)
    assert equation == Equation(9, {_x: drawn, _y: [-1 + _number(0)]}, None)
    assert plant.place == {s: at for s, at in _PLACE.items() if s is not _U}


# -------------------------------------------------------------------------- rows of coefficients


def _derivative(of: list[int], times: int) -> list[int]:
    for _ in range(times):
        of = [k * x for k, x in enumerate(of)][1:]
    return of


@pytest.mark.parametrize("seed", range(8))
def test_a_row_is_a_coefficient_of_what_the_form_is_at_any_motion(seed: int) -> None:
    """The sum of a(t) times the derivative of a polynomial, by multiplying polynomials out."""
    random, length, stride = Random(seed), 9, 64
    motions = [[random.randint(-9, 9) for _ in range(length)] for _ in range(2)]
    keys = [0, 1, ORDERS, ORDERS + 3, CONSTANT]
    plain = {k: [random.randint(1, 9) for _ in range(random.choice((1, 2, 3)))] for k in keys}
    form = {k: [_number(x) for x in weights] for k, weights in plain.items()}
    for order in range(5):
        wanted = sum(plain[CONSTANT][order : order + 1])
        for key in keys[:-1]:
            motion = _derivative(motions[key // ORDERS], key % ORDERS)
            weights = plain[key][: order + 1]
            wanted += sum(a * motion[order - m] for m, a in enumerate(weights))
        row = coefficient_row(_F, form, order, stride)
        got = row.pop(CONSTANT, 0)
        got += sum(x * motions[c // stride][c % stride] for c, x in row.items())
        assert got == wanted + _number(0)


def test_a_row_has_no_place_for_what_cancels_or_is_beyond_a_series() -> None:
    """x and -t x' cancel in the coefficient of t; a constant has none there."""
    form = {_x: [_number(1)], _x + 1: [_number(0), _number(-1)], CONSTANT: [_number(3)]}
    assert coefficient_row(_F, form, 1, 8) == {}
    assert coefficient_row(_F, form, 0, 8) == {0: 1, CONSTANT: 3}
    assert coefficient_row(_F, {_y + 1: [_number(2)]}, 2, 8) == {8 + 3: 6}
