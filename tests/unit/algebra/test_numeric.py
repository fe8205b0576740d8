"""Nominal values and sensitivities of constant expressions, against SymPy."""

from __future__ import annotations

import math
import random
from fractions import Fraction

import pytest
import sympy as sp

from bondgraph.algebra.numeric import Valued, declared_zero, evaluate, nominal
from bondgraph.compilation import Compilation
from bondgraph.ir.expr import Expr, Kind, Pool
from bondgraph.text.source import Source

NAMES = ("a", "b", "c", "d")


def draw(seed: int) -> tuple[Expr, sp.Expr, dict[str, float]]:
    """A random expression in four parameters, one of them zero, and the same in SymPy."""
    choose = random.Random(seed)
    pool = Pool()
    values = {n: choose.uniform(0.5, 2.0) for n in NAMES} | {"d": 0.0}
    parts = [(pool.symbol(n, Kind.PARAM), sp.Symbol(n)) for n in NAMES]
    for _ in range(12):
        (x, x_), (y, y_) = choose.choice(parts), choose.choice(parts)
        match choose.randrange(5):
            case 0:
                parts.append((pool.add((2, x), (-3, y)), 2 * x_ - 3 * y_))
            case 1:
                parts.append((pool.mul(x, y), x_ * y_))
            case 2:
                one = pool.add((1, pool.one), (1, pool.power(y, 2)))
                parts.append((pool.div(x, one), x_ / (1 + y_**2)))
            case 3:
                parts.append((pool.fn("sin", x), sp.sin(x_)))
            case _:
                parts.append((pool.fn("tanh", pool.add((1, x), (1, y))), sp.tanh(x_ + y_)))
    total = pool.add(*[(1, e) for e, _ in parts])
    return total, sum((s for _, s in parts), sp.Integer(0)), values


def test_values_that_are_written_by_others_have_numbers_in_whatever_order_they_stand() -> None:
    """Exact while they are rational; of one without a value nothing has a number."""
    text = """bg 1
model M {
    param R = 2*k
    param k = c/3
    const c = 4
    param w = sqrt(c + 1)
    param given : 1
    param lost = given*2
    1:s { <- Se:U; -> R:one = R; -> R:two = w; -> R:three = lost; -> I:L(p0 = 3*c) = k }
    s -> Df:i
}
"""
    found = nominal(Compilation(Source("m.bg", text)).graph)
    exact = {"c": Fraction(4), "k": Fraction(4, 3), "R": Fraction(8, 3)}
    assert {name: found[name] for name in exact} == exact
    assert all(isinstance(found[name], Fraction) for name in exact)
    assert found["w"] == pytest.approx(math.sqrt(5.0))
    assert not {"given", "lost"} & set(found)
    assert 12 in found.values()  # where the momentum begins


@pytest.mark.parametrize("seed", range(8))
def test_sensitivities_are_derivatives(seed: int) -> None:
    expr, same, values = draw(seed)
    found = Valued(values).sensitivities({expr: 2.0})
    assert found is not None
    assert evaluate(expr, values) == pytest.approx(float(same.subs(values)))
    for name in NAMES:
        slope = 2 * float(sp.diff(same, name).subs(values)) * (values[name] or 1.0)
        assert found.get(name, 0.0) == pytest.approx(slope, rel=1e-8, abs=1e-8)


def test_a_sum_of_several_roots_weighs_each() -> None:
    p = Pool()
    a, b = p.symbol("a", Kind.PARAM), p.symbol("b", Kind.PARAM)
    found = Valued({"a": 3.0, "b": 0.0}).sensitivities({p.mul(a, b): 10.0, a: 1.0})
    assert found == {"a": 3.0, "b": 30.0}


@pytest.mark.parametrize(
    ("op", "expected"),
    [("<", (1, 0, 0)), ("<=", (1, 1, 0)), ("==", (0, 1, 0)), (">=", (0, 1, 1)), (">", (0, 0, 1))],
)
def test_comparisons_below_at_and_above_a_limit(op: str, expected: tuple[int, ...]) -> None:
    p = Pool()
    a, b = p.symbol("a", Kind.PARAM), p.symbol("b", Kind.PARAM)
    chosen = p.choose(p.compare(op, a, b), p.one, p.zero)
    found = tuple(evaluate(chosen, {"a": value, "b": 2.0}) for value in (1.0, 2.0, 3.0))
    assert found == expected


def test_no_value_and_no_slope() -> None:
    p = Pool()
    a = p.symbol("a", Kind.PARAM)
    assert Valued({"a": 0.0}).sensitivities({p.div(p.one, a): 1.0}) is None
    assert Valued({}).sensitivities({a: 1.0}) is None
    found = Valued({"a": 0.0}).sensitivities({p.fn("sqrt", a): 1.0})
    assert found is not None and math.isnan(found["a"])  # below zero there is no root


def test_rational_values_stay_exact() -> None:
    p = Pool()
    a = p.symbol("a", Kind.PARAM)
    third = p.div(p.add((1, a), (1, p.one)), p.num(3))
    assert evaluate(third, {"a": Fraction(1, 7)}) == Fraction(8, 21)


@pytest.mark.parametrize(("one", "other"), [(1, 2), (2, 2), (3, 2)])
def test_conditions_of_numbers_hold_or_not(one: int, other: int) -> None:
    p = Pool()
    a, b = p.symbol("a", Kind.PARAM), p.symbol("b", Kind.PARAM)
    less, most = p.compare("<", a, b), p.compare("<=", a, b)
    for condition, holds in (
        (less, one < other),
        (p.logic("not", less), one >= other),
        (p.logic("and", most, p.logic("not", less)), one == other),
        (p.logic("or", less, p.compare("<", b, a)), one != other),
    ):
        values = {"a": Fraction(one), "b": Fraction(other)}
        assert evaluate(p.choose(condition, p.num(7), p.num(5)), values) == (7 if holds else 5)


def test_faults_are_declared_zero_by_their_value_or_as_such() -> None:
    """A constant is no fault; what has no number is not known to be zero."""
    text = """bg 1
model M {
    param leak = 0
    param also = 2*leak
    param R = 3
    param given : 1
    const none = 0
    1:s { <- Se:U; -> R:one = R; -> R:two = leak + none; -> R:three = given + also; -> Df:i }
}
"""
    graph = Compilation(Source("m.bg", text)).graph
    assert set(declared_zero(graph, nominal(graph))) == {"leak", "also"}
    assert "R" in declared_zero(graph, {"R": 0})
