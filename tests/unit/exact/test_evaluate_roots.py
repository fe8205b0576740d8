"""Numbers that solve an equation: what they say is true, and what has no solution is refused."""

from __future__ import annotations

from random import Random

import pytest
from flint import arb

from bondgraph.exact.evaluate import solve
from bondgraph.field.balls import NOTHING, Reals, zero_of
from bondgraph.field.numbers import Number, Undefined
from bondgraph.ir.expr import Kind, Pool

p = Pool()
x = p.symbol("x", Kind.FLOW)
a = p.symbol("a", Kind.PARAM)
R = Reals({})


@pytest.mark.parametrize(
    "name", ["tanh", "sinh", "exp", "atan", "ssq", "abs", "ssqrt", "cbrt", "asinh"]
)
def test_a_solution_makes_the_equation_true(name: str) -> None:
    """a f(x) + x - 5 = 0 for a = 0.7, within a ball that no quantity of a machine resolves."""
    zero = p.add((1, p.mul(a, p.fn(name, x))), (1, x), (-5, p.one))
    factor = arb(7) / 10
    found = solve(R, zero, {a: [factor]}, {x: (arb(0), arb(1))}, (arb(0), arb(0)), Random(1))
    value = factor * R.value(name, found) + found - 5
    assert value.contains(0) and value.rad() < NOTHING


def test_what_stands_outside_counts() -> None:
    # x^2 + (3 - 4 x) = 0 has the solutions 1 and 3, and both are found by some draw
    zero = p.power(x, 2)
    found = {
        round(float(solve(R, zero, {}, {x: (arb(0), arb(1))}, (arb(3), arb(-4)), Random(seed))), 9)
        for seed in range(20)
    }
    assert found == {1.0, 3.0}


def test_an_equation_without_a_real_solution_is_refused() -> None:
    zero = p.add((1, p.power(x, 2)), (1, p.one))
    with pytest.raises(Undefined):
        solve(R, zero, {}, {x: (arb(0), arb(1))}, (arb(0), arb(0)), Random(1))


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
