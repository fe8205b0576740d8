"""Roots in the field: polynomials against their factors, equations against what they say."""

from __future__ import annotations

from random import Random

import pytest
from hypothesis import given
from hypothesis import strategies as st

from bondgraph.exact.field import Functions, P, Undefined
from bondgraph.exact.implicit import solve
from bondgraph.exact.polynomials import mul, roots_of
from bondgraph.ir.expr import Kind, Pool

p = Pool()
x = p.symbol("x", Kind.FLOW)
a = p.symbol("a", Kind.PARAM)


@given(st.lists(st.integers(0, P - 1), min_size=1, max_size=6))
def test_roots_are_those_of_the_factors(zeros: list[int]) -> None:
    product = [3]
    for z in zeros:
        product = mul(product, [-z % P, 1])
    assert roots_of(product, Random(1)) == sorted(set(zeros))


def test_a_square_that_is_none_has_no_root() -> None:
    assert roots_of([1, 0, 1], Random(1)) == []  # -1 is no square, as P = 3 mod 4


@pytest.mark.parametrize("name", ["exp", "log", "sinh", "asinh", "tanh", "atanh", "tan", "atan"])
def test_a_function_is_given_a_value_and_keeps_it(name: str) -> None:
    for seed in range(40):
        functions = Functions(seed)
        at, value = functions.draw(), functions.draw()
        try:
            functions.force(name, at, value)
        except Undefined:
            continue
        assert functions.value(name, at) == value
        with pytest.raises(Undefined):
            functions.force(name, at, value + 1)
        return
    raise AssertionError("no value could be given")


@pytest.mark.parametrize("name", ["tanh", "sinh", "exp", "atan", "ssq", "abs", "ssqrt", "cbrt"])
def test_a_solution_makes_the_equation_true(name: str) -> None:
    """a f(x) + x - 5 = 0, the functions being what the field says they are."""
    zero = p.add((1, p.mul(a, p.fn(name, x))), (1, x), (-5, p.one))
    for seed in range(30):
        functions = Functions(seed)
        factor = functions.draw()  # for some the equation has no root in the field
        try:
            found = solve(zero, {x: [0, 1], a: [factor]}, [], functions)
        except Undefined:
            continue
        assert (factor * functions.value(name, found) + found - 5) % P == 0
        return
    raise AssertionError("no solution was found")
