"""Points of a plant: the arguments that give a function a value, all of them."""

from __future__ import annotations

import math
from fractions import Fraction
from random import Random

import pytest
from flint import arb

from bondgraph.exact.forms import ORDERS
from bondgraph.exact.plant_equations import Equation, Setting
from bondgraph.exact.point import STRIDE, Point, _inverted, _undone, zero_on_line
from bondgraph.field.balls import NOTHING, Reals
from bondgraph.field.numbers import INVERSES, Number, Undefined
from bondgraph.field.prime import PrimeField
from bondgraph.field.sparse import CONSTANT, Contradiction, Row
from bondgraph.ir.expr import Expr, Kind, Pool

_VALUES = [Fraction(-5, 3), Fraction(-2, 5), Fraction(1, 3), Fraction(7, 4)]


@pytest.mark.parametrize("name", [*INVERSES, "abs"])
def test_every_argument_that_is_found_has_the_value(name: str) -> None:
    f, random = Reals({}), Random(5)
    done = 0
    for value in [f.fraction(v) for v in _VALUES for _ in range(8)]:
        try:
            found = _inverted(f, name, value, random)
        except Undefined:  # a sine of 7/4
            continue
        assert found is not None
        assert not f.nonzero(f.value(name, found) - value)
        done += 1
    assert done >= 8


_TURN = 2 * math.pi
_TURNS = (-_TURN, 0.0, _TURN)
_SIDES = {
    "abs": (1 / 3, [1 / 3, -1 / 3]),
    "cosh": (7 / 4, [math.acosh(7 / 4), -math.acosh(7 / 4)]),
    "sin": (1 / 3, [x + k for x in (math.asin(1 / 3), math.pi - math.asin(1 / 3)) for k in _TURNS]),
    "cos": (1 / 3, [x + k for x in (math.acos(1 / 3), -math.acos(1 / 3)) for k in _TURNS]),
    "tan": (1 / 3, [math.atan(1 / 3) + k / 2 for k in _TURNS]),
}


@pytest.mark.parametrize("name", _SIDES)
def test_no_argument_within_a_turn_is_left_out_where_several_have_the_value(name: str) -> None:
    f, random = Reals({}), Random(7)
    value, expected = _SIDES[name]
    found = {float(_inverted(f, name, f.number(value), random)) for _ in range(100)}
    assert sorted(found) == pytest.approx(sorted(expected), rel=1e-9)


_POOL = Pool()
_X, _Y = (_POOL.symbol(n, Kind.UNKNOWN) for n in "xy")


@pytest.mark.parametrize(
    ("node", "value", "wanted"),
    [
        # with y = 4: 3 x - 2 y = 7, x y^2 = 8, y^2/x = 32, x^3/y = 2, exp x = 1, tanh x = 0
        (_POOL.add((3, _X), (-2, _Y)), 7, 5.0),
        (_POOL.mul(_X, _POOL.power(_Y, 2)), 8, 0.5),
        (_POOL.mul(_POOL.power(_X, -1), _POOL.power(_Y, 2)), 32, 0.5),
        (_POOL.mul(_POOL.power(_X, 3), _POOL.power(_Y, -1)), 2, 2.0),
        (_POOL.fn("exp", _X), 1, 0.0),
        (_POOL.fn("tanh", _X), 0, 0.0),
        (_POOL.fn("max", _X, _Y), 9, None),  # of two arguments nothing is said
        (_POOL.choose(_POOL.compare("<", _Y, _POOL.one), _X, _Y), 9, None),
    ],
)
def test_an_argument_by_hand(node: Expr, value: int, wanted: float | None) -> None:
    f = Reals({})
    found = _undone(f, node, f.number(value), _X, {_Y: f.number(4)}, Random(1))
    assert (found is None) == (wanted is None)
    if wanted is not None:
        assert float(found) == pytest.approx(wanted, abs=1e-12)


# ------------------------------------------------------------------ what linear rows determine


_FIELD = PrimeField(3)
_COLUMNS = [0, 1, STRIDE, STRIDE + 1, 2 * STRIDE, 3 * STRIDE]


def _point(seed: int = 1) -> Point:
    return Point({}, Setting({}, _FIELD, 1), Random(seed))


def _row(constant: int, *entries: int) -> Row:
    """constant + entries * columns."""
    found = {c: _FIELD.number(x) for c, x in zip(_COLUMNS, entries, strict=False) if x}
    return found | ({CONSTANT: _FIELD.number(constant)} if constant else {})


def _at(row: Row, values: dict[int, Number]) -> Number:
    return sum((x * values[c] for c, x in row.items() if c != CONSTANT), row.get(CONSTANT, 0))


def _drawn(seed: int) -> tuple[Point, list[Row], dict[int, Number]]:
    """A point with rows that all hold at some values, the last of them a sum of the others."""
    random = Random(seed)
    values = {c: _FIELD.any(random) for c in _COLUMNS}
    point, rows = _point(seed), list[Row]()
    for _ in range(3):
        row = _row(0, *(random.randint(-2, 2) for _ in _COLUMNS))
        rows.append(row | {CONSTANT: _FIELD.number(0) - _at(row, values)})
    both = {c: rows[0].get(c, 0) + 5 * rows[1].get(c, 0) for c in {*rows[0], *rows[1]}}
    rows.append({c: x for c, x in both.items() if x})
    for row in rows:
        point.add(dict(row))
    return point, rows, values


@pytest.mark.parametrize("seed", range(10))
def test_a_row_is_reduced_to_what_is_open_of_it_and_keeps_its_value(seed: int) -> None:
    point, rows, values = _drawn(seed)
    assert len(point.pivots) == len(point.rank) == 3
    assert all(point.reduce(dict(row)) == {} for row in rows)
    random = Random(seed + 100)
    for _ in range(5):
        other = _row(4, *(random.randint(-3, 3) for _ in _COLUMNS))
        reduced = point.reduce(other)
        assert not set(reduced) & set(point.rank)
        assert _at(reduced, values) == _at(other, values)


@pytest.mark.parametrize("seed", range(5))
def test_a_whole_point_satisfies_every_row_whatever_is_open(seed: int) -> None:
    point, rows, _ = _drawn(seed)
    found = point.complete(_COLUMNS)
    assert set(found) == set(_COLUMNS)
    assert not any(_at(row, found) for row in rows)
    point.random = Random(seed + 50)
    assert point.complete(_COLUMNS) != found


def test_what_is_fixed_stays_and_what_is_determined_is_not_asked_for() -> None:
    """x - y = 1, and y is 4 by choice: x is 5, whatever it is told to be."""
    point = _point()
    point.add(_row(-1, 1, -1))
    x, y = _row(0, 1), _row(0, 0, 1)
    assert point.fix(dict(y), _FIELD.number(4)) == 4
    assert point.fix(dict(x), _FIELD.number(9)) == 5 and point.fix(dict(y)) == 4
    other = _row(0, 0, 0, 1)
    drawn = point.fix(dict(other))
    assert point.fix(dict(other)) == drawn and drawn not in (0, 4, 5)
    assert point.fix(_row(7)) == 7
    assert point.fix({}) == 0


def test_a_row_that_cannot_hold_is_told_by_its_number() -> None:
    point = _point()
    point.add(_row(-1, 1, -1))
    point.add(_row(-2, 2, -2), 5)  # the same again
    with pytest.raises(Contradiction) as told:
        point.add(_row(-3, 2, -2), 6)
    assert told.value.row == 6


def test_equations_hold_with_their_derivatives_and_are_told_by_their_numbers() -> None:
    """x' = y and x = 3 t: y is 3; with y = 4 the last equation is the one that does not hold."""
    minus = _FIELD.number(-1)
    one = [_FIELD.number(1)]
    line = [_FIELD.number(0), _FIELD.number(-3)]
    equations = [
        Equation(-1, {1: one, ORDERS: [minus]}, None),
        Equation(-1, {0: one, CONSTANT: line}, None),
    ]
    point = _point()
    point.linear(equations, [0, 1])
    assert point.fix({STRIDE: _FIELD.number(1)}, _FIELD.number(8)) == 3
    assert point.fix({1: _FIELD.number(1)}) == 3 and point.fix({0: _FIELD.number(1)}) == 0
    wrong = Equation(-1, {ORDERS: one, CONSTANT: [_FIELD.number(-4)]}, None)
    with pytest.raises(Contradiction) as told:
        _point().linear([*equations, wrong], [0, 1, 0])
    assert told.value.row in (0, 1, 2)  # of an equation: rows there are four
    _point().linear([equations[0], wrong], [0, 0])


def test_a_row_beside_another_is_a_number_and_a_multiple_of_it() -> None:
    """3 + 4 x - 2 y is 3 - 2 z along z = -2 x + y, and no function of x + y or of x."""
    point, row = _point(), _row(3, 4, -2)
    assert point.along(row, _row(9, -2, 1)) == (3, -2 + _FIELD.number(0))
    assert point.along(row, _row(0, 1, 1)) is None
    assert point.along(row, _row(0, 1)) is None
    assert point.along(row, _row(0, -2, 1, 1)) is None
    assert point.along(_row(6), _row(0, 1)) == (6, 0)


# ------------------------------------------------------------------ one open place of a law


def test_an_even_power_has_two_roots_and_an_odd_one_the_sign_of_its_value() -> None:
    f, random = Reals({}), Random(2)

    def roots(exponent: int, value: int) -> set[float]:
        power = _POOL.power(_X, exponent)
        found = (_undone(f, power, f.number(value), _X, {}, random) for _ in range(40))
        return {round(float(x), 9) for x in found}  # type: ignore[arg-type]

    assert roots(2, 9) == {3.0, -3.0} and roots(-2, 4) == {0.5, -0.5}
    assert roots(3, 8) == {2.0} and roots(3, -8) == {-2.0}
    with pytest.raises(Undefined):
        roots(2, -9)


@pytest.mark.parametrize("x_is_known", [False, True])
def test_a_value_goes_down_to_the_only_place_that_is_open(x_is_known: bool) -> None:
    """x^2 exp(sinh y) = 12 with x = 2: sinh y is log 3. While x is open too nothing is imposed."""
    f, pool = Reals({}), Pool()
    x, y = (pool.symbol(n, Kind.UNKNOWN) for n in "xy")
    inner = pool.fn("exp", pool.fn("sinh", y))
    law = pool.mul(inner, pool.power(x, 2))
    point = Point({x: (0, 1), y: (1, 1)}, Setting({}, f, 1), Random(1))
    forms = {x: {0: [f.number(1)]}, y: {ORDERS: [f.number(1)]}}
    if x_is_known:
        point.add({0: f.number(1), CONSTANT: f.number(-2)})
    found = point.impose(law, f.number(12), dict(forms), {}, 4)
    assert found is x_is_known
    assert point.is_open(forms[y]) is not x_is_known
    if found:
        assert float(point.fix(point.row(forms[y]))) == pytest.approx(math.asinh(math.log(3)))


_REALS = Reals({})
p = Pool()
x = p.symbol("x", Kind.FLOW)
a = p.symbol("a", Kind.PARAM)


def _zero(
    law: Expr, outside: tuple[int, int] = (0, 0), seed: int = 1, **fixed: Number
) -> Number:
    """What x is where a law, with what stands outside of it, is zero."""
    told = {p.symbol(name, Kind.PARAM): [value] for name, value in fixed.items()}
    beside = (arb(outside[0]), arb(outside[1]))
    return zero_on_line(_REALS, law, told, {x: (arb(0), arb(1))}, beside, Random(seed))


@pytest.mark.parametrize(
    "name", ["tanh", "sinh", "exp", "atan", "ssq", "abs", "ssqrt", "cbrt", "asinh"]
)
def test_a_solution_makes_the_equation_true(name: str) -> None:
    """a f(x) + x - 5 = 0 for a = 0.7, within a ball that no quantity of a machine resolves."""
    factor = arb(7) / 10
    found = _zero(p.add((1, p.mul(a, p.fn(name, x))), (1, x), (-5, p.one)), a=factor)
    value = factor * _REALS.value(name, found) + found - 5
    assert value.contains(0) and value.rad() < NOTHING


def test_what_stands_outside_counts() -> None:
    # x^2 + (3 - 4 x) = 0 has the solutions 1 and 3, and both are found by some draw
    found = {round(float(_zero(p.power(x, 2), (3, -4), seed)), 9) for seed in range(20)}
    assert found == {1.0, 3.0}


def test_an_equation_without_a_real_solution_is_refused() -> None:
    with pytest.raises(Undefined):
        _zero(p.add((1, p.power(x, 2)), (1, p.one)))


def test_a_law_is_satisfied_by_the_one_quantity_that_is_open_in_it() -> None:
    """y = x - 1 is tied to x: x^3 + y - 2 z = 9 with z = 0 has x = 2 alone, where y is 1."""
    f, pool = Reals({}), Pool()
    u, v, w = (pool.symbol(n, Kind.UNKNOWN) for n in "uvw")
    place = {u: (0, 1), v: (1, -1), w: (2, 1)}  # v is the negative of its variable
    law = Equation(
        -1, {2 * ORDERS: [f.number(-2)], CONSTANT: [f.number(-9)]},
        pool.add((1, pool.power(u, 3)), (1, v)),
    )  # fmt: skip

    def point(*rows: Row) -> Point:
        made = Point(place, Setting({}, f, 1), Random(1))
        for row in rows:
            made.add({c: f.number(x) for c, x in row.items()})
        return made

    tied, known = {0: 1, STRIDE: 1, CONSTANT: -1}, {2 * STRIDE: 1}
    solved = point(tied, known)
    assert solved.by_itself(law)
    assert abs(float(solved.fix({0: f.number(1)})) - 2) < 1e-12
    assert abs(float(solved.fix({STRIDE: f.number(1)})) + 1) < 1e-12
    assert not point(tied).by_itself(law)  # w is open beside
    assert not point(known).by_itself(law)  # u and v are two
    assert not point(tied, known, {0: 1}).by_itself(law)  # nothing is
    moving = law._replace(rest=pool.add((1, pool.der(u)), (1, pool.power(u, 3))))
    assert not point(tied, known).by_itself(moving)


@pytest.mark.parametrize("known", [True, False])
def test_a_derivative_of_a_law_is_linear_in_what_is_newest(known: bool) -> None:
    """(x y)' = x y' + 3 y where x is 2 + 3 t, and x y = 6: y' is -9/2; with x' open, 3 x'."""
    f = PrimeField(3)
    pool = Pool()
    u, v = (pool.symbol(n, Kind.UNKNOWN) for n in "uv")
    point = Point({u: (0, 1), v: (1, 1)}, Setting({}, f, 2), Random(1))
    law = Equation(-1, {CONSTANT: [f.number(-6)]}, pool.mul(u, v))
    point.add({0: f.number(1), CONSTANT: f.number(-2)})
    point.add({STRIDE: f.number(1), CONSTANT: f.number(-3)})
    if known:
        point.add({1: f.number(1), CONSTANT: f.number(-3)})
    row = point.linearised(law, 1)
    expected = {STRIDE + 1: 2, CONSTANT: 9} if known else {STRIDE + 1: 2, 1: 3}
    assert row == {c: f.number(x) for c, x in expected.items()}


def test_a_value_goes_through_the_branch_that_is_taken_and_waits_for_an_open_condition() -> None:
    """if(a < 0, x, exp x) = 1 at a = 2: x is 0. While a is open nothing is said."""
    f, pool = Reals({}), Pool()
    u, v = (pool.symbol(n, Kind.UNKNOWN) for n in "uv")
    law = pool.choose(pool.compare("<", u, pool.zero), v, pool.fn("exp", v))
    place = {u: (0, 1), v: (1, 1)}
    point = Point(place, Setting({}, f, 1), Random(1))
    equation = Equation(-1, {CONSTANT: [f.number(-1)]}, law)
    assert point.satisfied(0, equation) is not None
    point.add({0: f.number(1), CONSTANT: f.number(-2)})
    assert point.satisfied(0, equation) is None
    assert abs(float(point.fix({STRIDE: f.number(1)}))) < 1e-12


@pytest.mark.parametrize(
    ("exponent", "known", "value", "imposed"),
    [(1, 0, 0, True), (2, 0, 0, True), (1, 2, 0, False), (-1, 2, 0, False), (1, 0, 3, False)],
)
def test_a_product_is_zero_where_one_factor_is_whatever_the_others_are(
    exponent: int, known: int, value: int, imposed: bool
) -> None:
    """u^n exp(v) sinh(w): with u told to be zero nothing is asked of v and w."""
    f, pool = Reals({}), Pool()
    u, v, w = (pool.symbol(n, Kind.UNKNOWN) for n in "uvw")
    law = pool.mul(pool.power(u, exponent), pool.fn("exp", v), pool.fn("sinh", w))
    point = Point({u: (0, 1), v: (1, 1), w: (2, 1)}, Setting({}, f, 1), Random(1))
    forms = {n: {at * ORDERS: [f.number(1)]} for at, n in enumerate((u, v, w))}
    point.add({0: f.number(1), CONSTANT: f.number(-known)})
    assert point.impose(law, f.number(value), dict(forms), {}, 4) is imposed
    assert point.is_open(forms[v]) and point.is_open(forms[w]) and not point.is_open(forms[u])
