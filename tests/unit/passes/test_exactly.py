"""The exact procedure of a residual: what it is given, its terms, their scales and their names."""

from __future__ import annotations

import math
from fractions import Fraction
from types import SimpleNamespace
from typing import Any

import pytest

from bondgraph.ir.expr import ZERO_START, Expr, Kind, Pool, Root
from bondgraph.ir.program import Const, Expression, Program, Ref, Sum
from bondgraph.passes.lowering.exactly import label, suffix, total
from tests.sampled import Sampled
from tests.unit.passes.lowering_models import Bench

A, B = Ref("local", "a"), Ref("local", "b")


@pytest.mark.parametrize(
    ("terms", "expected"),
    [
        ([], Const(0.0)),
        ([(True, A)], A),
        ([(False, A)], Sum(((False, A),))),
        ([(False, A), (True, B)], Sum(((True, B), (False, A)))),
        ([(True, A), (False, B), (True, B)], Sum(((True, A), (True, B), (False, B)))),
    ],
)
def test_positive_terms_come_first(
    terms: list[tuple[bool, Expression]], expected: Expression
) -> None:
    assert total(terms) == expected


def test_coefficients_are_named_by_what_they_stand_before() -> None:
    p = Pool()
    x, y, u = p.symbol("x", Kind.SENSOR), p.symbol("y", Kind.SENSOR), p.symbol("u", Kind.TEAR)
    zero = p.symbol(ZERO_START, Kind.INITIAL)
    own: Any = SimpleNamespace(signals={x: SimpleNamespace(name="speed")})
    on = p.symbol("on", Kind.MODE)
    root = p.root(Root("valve.f", p.sub(u, y), u, (y,), u, True, Fraction(0)), x)
    for atom, name in (
        (x, "speed"), (p.one, "constant"), (p.mul(x, y), "product"), (p.fn("tanh", x), "tanh"),
        (p.fn("table:pump.csv", x), "table"), (p.choose(on, x, y), "choice"), (y, "term"),
        (p.integral(y, zero), "integral"), (p.add((1, x), (1, y)), "term"), (root, "valve__f"),
    ):  # fmt: skip
        assert label(own, atom) == name
    assert [suffix(k) for k in (-2, -1, 0, 1, 3)] == ["_int_int", "_int", "", "_1", "_3"]


def _program(bench: Bench, expr: Expr) -> Program:
    return bench.program(expr)


def test_derivatives_and_integrals_are_given() -> None:
    """2 y + a y'' + 3 y' sin(y') + Int(y) + Int(Int(u)) of numbers by hand."""
    bench = Bench()
    p, y, u, a = bench.pool, bench.sensor("y"), bench.input("u"), bench.param("a", "0.5")
    zero = p.symbol(ZERO_START, Kind.INITIAL)
    expr = p.add(
        (2, y), (1, p.mul(a, p.der(y, 2))), (3, p.mul(p.der(y), p.fn("sin", p.der(y)))),
        (1, p.integral(y, zero)), (1, p.integral(p.integral(u, zero), zero)),
    )  # fmt: skip
    machine = Sampled(_program(bench, expr))
    known = {"y": {0: 1.25, 1: -0.75, 2: 4.0, -1: 0.5}, "u": {-2: 7.0}}
    expected = 2.5 + 2.0 + 3.0 * 0.75 * math.sin(0.75) + 0.5 + 7.0
    assert machine.exact(known)["r1"] == pytest.approx(expected, rel=1e-13)


def test_what_is_counted_from_the_start() -> None:
    """sin(Int(y')) is of the change of y, (Int(1))^2 of the time, and q of where it began."""
    bench = Bench()
    p, y = bench.pool, bench.sensor("y")
    zero = p.symbol(ZERO_START, Kind.INITIAL)
    begun = bench.initial("q0", p.num(Fraction(3, 2)))
    time = p.integral(p.one, zero)
    twist = p.integral(y, begun)
    change = p.integral(p.der(y), zero)
    expr = p.add((1, p.fn("sin", change)), (5, p.power(time, 2)), (1, p.fn("cosh", twist)))
    program = _program(bench, expr)
    assert program.residuals[0].order == 0
    machine = Sampled(program)
    found = machine.exact({"y": {0: 2.0, -1: 0.25}}, start={"y": 1.5}, time=3.0)["r1"]
    assert found == pytest.approx(math.sin(0.5) + 45.0 + math.cosh(1.75), rel=1e-13)


def test_an_integral_of_what_is_not_linear_is_given_once() -> None:
    bench = Bench()
    p, y = bench.pool, bench.sensor("y")
    zero = p.symbol(ZERO_START, Kind.INITIAL)
    square = p.integral(p.fn("abs", y), zero)
    expr = p.add((2, p.fn("sin", square)), (3, p.fn("cosh", square)), (-1, y))
    program = _program(bench, expr)
    assert [field.name for field in program.integrals] == ["integral_1"]
    found = Sampled(program).exact({"y": {0: 0.5}}, integrals={"integral_1": 0.75})["r1"]
    expected = 2 * math.sin(0.75) + 3 * math.cosh(0.75) - 0.5
    assert found == pytest.approx(expected, rel=1e-13)


def test_a_mode_chooses_between_derivatives() -> None:
    bench = Bench()
    p, y, u = bench.pool, bench.sensor("y"), bench.input("u")
    on = bench.input("on", mode=True)
    expr = p.choose(on, p.mul(y, p.fn("exp", p.der(y))), p.power(u, 2))
    machine = Sampled(_program(bench, expr))
    known = {"y": {0: 2.0, 1: 0.5}, "u": {0: 3.0}}
    for holds, value in ((True, 2.0 * math.exp(0.5)), (False, 9.0)):
        assert machine.exact(known, modes={"on": holds})["r1"] == pytest.approx(value, rel=1e-13)
