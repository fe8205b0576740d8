"""The search for the zero of a monotone function, where its zero is known by hand."""

from __future__ import annotations

import math
from collections.abc import Callable

import pytest

from bondgraph.algebra.interpreter import newton
from bondgraph.passes.lowering.newton import MOST

Look = Callable[[float], tuple[float, float]]


def flat(x: float) -> tuple[float, float]:
    """-1 until shortly before a million: its slope of zero leads nowhere."""
    return (x - 1e6, 1.0) if x > 1e6 - 1.0 else (-1.0, 0.0)


@pytest.mark.parametrize(
    ("look", "rising", "guess", "zero"),
    [
        (lambda x: (x**3 - 27.0, 3.0 * x * x), True, 1.0, 3.0),
        (lambda x: (27.0 - x**3, -3.0 * x * x), False, 100.0, 3.0),
        (flat, True, 0.0, 1e6),  # by steps that are twice as wide each time
        (flat, True, 3e6, 1e6),
        (lambda x: (-flat(-x)[0], flat(-x)[1]), True, 0.0, -1e6),
        (lambda x: (math.atan(x - 2.0), 1.0 / (1.0 + (x - 2.0) ** 2)), True, 50.0, 2.0),
        # dry friction of 2 under a drive of 1, and of 5: it stands still, or it moves
        (lambda x: (x + math.copysign(2.0, x) - 1.0, 1.0), True, 7.0, 0.0),
        (lambda x: (x + math.copysign(2.0, x) - 5.0, 1.0), True, -7.0, 3.0),
        # the logarithm has no value on the left of the guess's side
        (lambda x: (math.log(x), 1.0 / x) if x > 0 else (math.nan, math.nan), True, 40.0, 1.0),
    ],
)
def test_zeros(look: Look, rising: bool, guess: float, zero: float) -> None:
    assert newton(look, rising, guess, MOST) == pytest.approx(zero, abs=1e-9)


def test_without_a_zero_or_without_patience_there_is_no_number() -> None:
    assert math.isnan(newton(lambda x: (math.exp(x), math.exp(x)), True, 0.0, MOST))
    assert math.isnan(newton(lambda x: (x**3 - 27.0, 3.0 * x * x), True, 1.0, 2))
