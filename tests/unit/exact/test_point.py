"""Points of a plant: the arguments that give a function a value, all of them."""

from __future__ import annotations

import math
from fractions import Fraction
from random import Random

import pytest

from bondgraph.exact.point import _inverted
from bondgraph.field.balls import Reals
from bondgraph.field.numbers import INVERSES, Undefined

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
