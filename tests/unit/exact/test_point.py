"""Points of a plant: the arguments that give a function a value, all of them."""

from __future__ import annotations

import math
from fractions import Fraction
from random import Random

import pytest

from bondgraph.exact.point import _inverted, _undone
from bondgraph.field.balls import Reals
from bondgraph.field.numbers import INVERSES, Undefined
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
