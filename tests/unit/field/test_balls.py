"""Zeros of functions over the reals: which one is taken, and what is none."""

from __future__ import annotations

from collections.abc import Iterator

import pytest
from flint import arb, ctx

from bondgraph.field.balls import Precision, zero_of
from bondgraph.field.numbers import Number, Undefined


@pytest.fixture(autouse=True)
def bits() -> Iterator[None]:
    """As many as the reals of a model begin with, whatever ran before."""
    with ctx.workprec(Precision().bits):
        yield


def test_a_jump_over_zero_is_no_solution() -> None:
    def step(z: Number) -> Number:
        return arb(1) if z > arb(1) / 3 else arb(-1)

    with pytest.raises(Undefined):
        zero_of(step, arb(0))


@pytest.mark.parametrize("zeros", [(-2.0, 0.5), (1.0, 1.1, 7.0), (-30.0, 4.0)])
def test_the_zero_nearest_to_a_known_one_is_taken(zeros: tuple[float, ...]) -> None:
    def product(z: Number) -> Number:
        out = arb(1)
        for zero in zeros:
            out = out * (z - zero)
        return out

    for zero in zeros:
        assert abs(float(zero_of(product, arb(zero + 0.01))) - zero) < 1e-12
