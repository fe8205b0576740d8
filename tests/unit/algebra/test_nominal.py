"""Whether an expression has a value, and whether that is zero at the nominal parameters."""

from __future__ import annotations

from collections.abc import Callable
from fractions import Fraction

import pytest

from bondgraph.algebra.nominal import Nominal, defined
from bondgraph.compilation import Compilation
from bondgraph.ir.expr import Expr, Kind, Pool
from bondgraph.text.source import Source


@pytest.mark.parametrize(
    ("build", "at", "expected"),
    [
        (lambda p, x, a: p.add((1, x), (1, a)), 0.0, True),
        (lambda p, x, a: p.div(a, x), 0.0, False),
        (lambda p, x, a: p.div(a, x), 2.0, True),
        (lambda p, x, a: p.fn("log", x), -1.0, False),
        (lambda p, x, a: p.fn("log", p.sub(x, a)), 1.0, False),  # a is 1: log(0)
        (lambda p, x, a: p.fn("log", a), -1.0, True),
        (lambda p, x, a: p.fn("table", x), -1.0, True),  # nobody knows it here: taken to be 1
        (lambda p, x, a: p.fn("log", p.sub(p.fn("table", x), a)), 0.0, False),
        (lambda p, x, a: p.fn("sqrt", p.der(x)), -1.0, True),
    ],
)
def test_defined(build: Callable[[Pool, Expr, Expr], Expr], at: float, expected: bool) -> None:
    pool = Pool()
    x, a = pool.symbol("x", Kind.EFFORT), pool.symbol("a", Kind.PARAM)
    assert defined(build(pool, x, a), x, at) is expected


@pytest.mark.parametrize("steps", [5, 20])
def test_zero_is_told_where_doubles_have_lost_all_their_digits(steps: int) -> None:
    # Muller's recurrence v'' = 111 - 1130/v' + 3000/(v' v) from 11/2 and 61/11: in doubles it goes
    # to 100, the numbers themselves are (6^(k+1) + 5^(k+1)) / (6^k + 5^k) and go to 6
    graph = Compilation(
        Source("m.bg", "bg 1\nmodel M { param a = 5.5; Se:U -> R:a\n sensor y = U }")
    ).graph
    pool, before = graph.pool, next(v.symbol for v in graph.values if v.name == "a")
    now = pool.num(Fraction(61, 11))
    for _ in range(1, steps):
        third = pool.div(pool.num(3000), pool.mul(now, before))
        before, now = now, pool.add(
            (1, pool.num(111)), (-1130, pool.power(now, -1)), (1, third)
        )
    exact = Fraction(6 ** (steps + 1) + 5 ** (steps + 1), 6**steps + 5**steps)
    nominal = Nominal(graph)
    # a failed assert would write the expressions out, which are long
    off, limit = (pool.sub(now, pool.num(x)) for x in (exact, Fraction(6)))
    assert [nominal.vanishes(x) for x in (off, limit, now)] == [True, False, False]


def test_a_difference_of_which_less_than_a_quarter_of_its_terms_is_left_cancels() -> None:
    """2*3 - 5: one of eleven is left. 2*3 - 3: three of nine."""
    text = "bg 1\nmodel M { param a = 3; Se:U -> R:a\n sensor y = U }"
    graph = Compilation(Source("m.bg", text)).graph
    pool, a = graph.pool, next(v.symbol for v in graph.values if v.name == "a")
    x, nominal = pool.symbol("x", Kind.SENSOR), Nominal(graph)
    sums = [pool.add((2, a), (1, pool.num(-k))) for k in (5, 3)]
    others = [pool.add((2, a), (-1, x)), pool.mul(a, x), pool.num(0), a]
    assert [nominal.cancels(e) for e in (*sums, *others)] == [True, *[False] * 5]


def test_sizes_are_nominal_values_and_one_where_there_is_none() -> None:
    text = "bg 1\nmodel M { param a = 3; param b = 6; param s : Ohm; Se:U -> R:a\n sensor y = U }"
    graph = Compilation(Source("m.bg", text)).graph
    pool, s = graph.pool, {v.name: v.symbol for v in graph.values}
    a, b, free = s["a"], s["b"], s["s"]
    signal = graph.inputs[0].symbol
    nominal = Nominal(graph)
    balance = pool.add((2, a), (-1, b))
    for expr, size in (
        (a, 3.0), (pool.neg(b), -6.0), (balance, 0.0), (pool.mul(a, b), 18.0), (free, 1.0),
        (pool.mul(free, balance), 0.0), (pool.mul(free, pool.power(a, -1)), 1.0), (signal, 1.0),
        (pool.add((1, pool.mul(signal, balance)), (3, balance)), 0.0),
        (pool.add((1, pool.mul(signal, balance)), (3, a)), 1.0), (pool.num(Fraction(1, 2)), 0.5),
        (pool.der(a), 0.0), (pool.der(signal), 1.0), (pool.der(pool.mul(signal, balance)), 0.0),
        (pool.div(a, balance), 1.0),
    ):  # fmt: skip
        assert nominal.size(expr) == size, expr
        assert nominal.vanishes(expr) == (size == 0.0)


def test_the_value_that_a_machine_has_replaces_that_of_the_model() -> None:
    text = "bg 1\nmodel M { param a = 3; param b = 2*a; Se:U -> R:a\n sensor y = U }"
    graph = Compilation(Source("m.bg", text)).graph
    pool, s = graph.pool, {v.name: v.symbol for v in graph.values}
    a, b = s["a"], s["b"]
    own, other = Nominal(graph), Nominal(graph, {"a": 5.0})
    assert (own.value(a), own.value(b), other.value(a), other.value(b)) == (3.0, 6.0, 5.0, 10.0)
    balance = pool.sub(b, pool.num(6))
    assert own.vanishes(balance) and not other.vanishes(balance)
    assert Nominal(graph, {"b": 7.0}).value(b) == 7.0


def test_a_term_that_is_nothing_makes_no_sum_cancel() -> None:
    """2*3 - 3 + 100*0: three of nine are left, whatever stands before the zero."""
    text = "bg 1\nmodel M { param a = 3; param z = 0; Se:U -> R:a\n sensor y = U }"
    graph = Compilation(Source("m.bg", text)).graph
    pool, s = graph.pool, {v.name: v.symbol for v in graph.values}
    expr = pool.add((2, s["a"]), (-3, pool.one), (100, s["z"]))
    assert not Nominal(graph).cancels(expr)
    assert Nominal(graph, {"z": -0.02}).cancels(expr)  # of 11 one
