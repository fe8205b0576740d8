"""Sums and products that simplify themselves, against the same with numbers."""

from __future__ import annotations

import itertools
from collections.abc import Callable
from fractions import Fraction

import numpy as np
import pytest

import bondgraph
from bondgraph.algebra.numeric import evaluate
from bondgraph.ir.expr import Expr, Kind, Op, Pool, topological

POOL = Pool()
A, B, X, Y = (POOL.symbol(name, Kind.SENSOR) for name in "abxy")
NUMBERS = {A: Fraction(3), B: Fraction(-5), X: Fraction(7), Y: Fraction(11, 2)}
NAMED = {symbol.symbol.name: value for symbol, value in NUMBERS.items()}


def _below(expr: Expr) -> set[Expr]:
    """What stands below a fraction."""
    products = [n for n in topological([expr]) if n.op is Op.MUL]
    return {base for n in products for base, exponent in n.factors if exponent < 0}


@pytest.mark.parametrize(
    ("over", "under", "left"),
    [
        (lambda p: p.add((1, p.mul(X, A)), (2, p.mul(X, B))), [X], set()),
        (lambda p: p.add((1, p.mul(X, A)), (-3, X)), [X], set()),
        (lambda p: p.add((1, p.mul(X, A)), (2, B)), [X], {X}),
        (lambda p: p.add((1, p.mul(X, A)), (2, p.one)), [X], {X}),
        (lambda p: p.add((1, p.mul(X, X, A)), (2, p.mul(X, B))), [X, X], {X}),
        (lambda p: p.add((1, p.mul(X, X, A)), (2, p.mul(X, X, Y))), [X, X, Y], {Y}),
        (lambda p: p.add((2, p.mul(X, Y, A)), (5, p.mul(X, Y, p.add((1, A), (1, B))))), [Y, X, B],
         {B}),
        (lambda p: p.add((2, p.mul(X, A)), (-2, p.div(p.mul(X, B), Y))), [X], {Y}),
        (lambda p: p.add((2, p.div(A, X)), (3, p.div(B, X))), [X], {X}),
    ],
)  # fmt: skip
def test_what_stands_in_each_term_of_a_sum_and_below_it_cancels(
    over: Callable[[Pool], Expr], under: list[Expr], left: set[Expr]
) -> None:
    total = over(POOL)
    for order in itertools.permutations(under):
        found = total
        for one in order:
            found = POOL.div(found, one)
        wanted = evaluate(total, NAMED)
        assert wanted is not None
        for one in under:
            wanted /= NUMBERS[one]
        assert evaluate(found, NAMED) == wanted
        assert _below(found) == left
    assert POOL.div(total, POOL.mul(*under)) is found


def test_water_that_stands_still_has_a_temperature_all_the_same() -> None:
    """What a valve feeds stands in each term of what warms the water, and in what it takes along.

    So none of the relations divides by it, and they hold while it is shut.
    """
    text = """bg 1
    model Coil {
        input v; input T0 : K; input T1 : K
        param k = 2 W/K; param C = 60 J/K; param share = 0.6
        Se:warm = T1
        1:air { <- warm; -> R:wall = 0.01 K/W; -> metal }
        0:metal { -> C:C; -> 1:water { -> R:film { f = share*k*v*e }; -> Se:cold = T0 } }
        Sf:heated = k*v*(T0 + share*(metal.e - T0))
        0:back { <- heated; -> R:leaves { f = k*v*e }; -> De:T2 }
    }"""
    engine = bondgraph.compile(text=text, rate=10.0, bandwidth=1.0).engine()
    assert [known.path for known in engine.signals] == ["v", "T0", "T1", "T2"]
    samples = np.tile([0.5, 280.0, 300.0, 290.0], (400, 1))
    samples[200:, 0] = 0.0
    assert engine.run(samples).valid[200:].all()
