"""Formulas on a line: Python reads them back, and their brackets are those of a person."""

from __future__ import annotations

from fractions import Fraction

import pytest
from hypothesis import given, settings

from bondgraph.ir.expr import ZERO_START, Expr, Kind, Pool, Root, topological
from bondgraph.notation.line import show
from tests.unit.notation.drawn import ONE, VALUES, expressions, value
from tests.unit.notation.mathml_reader import AREA, RATE


def _rate(x: float, order: int = 1) -> float:
    return x * RATE**order


@settings(max_examples=120)
@given(expressions())
def test_python_reads_what_is_meant(expr: Expr) -> None:
    try:
        wanted = value(expr)
        scale = max((abs(value(n)) for n in topological([expr])), default=1.0)
    except (ArithmeticError, ValueError, TypeError):
        return  # a root of something negative, a division by zero
    if not 1e-6 < scale < 1e9 or isinstance(wanted, complex):
        return
    names = {**ONE, **VALUES, "D": _rate, "Int": lambda x: AREA * x}
    read = eval(show(expr).replace("^", "**"), names)
    assert read == pytest.approx(wanted, rel=1e-5, abs=1e-6 * scale)


def test_signs_numbers_and_brackets() -> None:
    p = Pool()
    x, y, R = (p.symbol(n, Kind.PARAM) for n in "xyR")
    cases = {
        p.add((-1, x), (1, y)): "y - x",
        p.add((1, x), (-1, p.add((1, y), (1, p.one)))): "x - (y + 1)",
        p.scale(Fraction(1, 2), p.mul(x, y)): "x*y/2",
        p.scale(Fraction(1, 7), p.mul(x, y)): "(1/7)*x*y",
        p.scale(Fraction(1, 7), p.fn("sin", x)): "sin(x)/7",
        p.scale(Fraction(3, 2), x): "1.5*x",
        p.div(x, p.mul(y, R)): "x/(y*R)",
        p.power(p.add((1, x), (1, y)), -2): "1/(x + y)^2",
        p.num(Fraction(-1, 3)): "-1/3",
        p.fn("pow", x, p.num(Fraction(-1, 3))): "pow(x, -1/3)",
        p.der(p.der(p.mul(x, y))): "D(x*y, 2)",
        p.choose(p.logic("not", p.compare("<", x, y)), x, y): "if(not (x < y), x, y)",
    }
    assert {show(e): text for e, text in cases.items()} == {t: t for t in cases.values()}


def test_an_integral_says_where_it_begins_unless_that_is_zero() -> None:
    p = Pool()
    x, start = p.symbol("x", Kind.SENSOR), p.symbol("q0", Kind.INITIAL)
    area = p.integral(x, start)
    assert show(area) == "Int(x, q0)"
    assert show(area, {}, {start.symbol: p.num(3)}) == "Int(x, 3)"
    assert show(area, {}, {start.symbol: p.zero}) == "Int(x)"
    assert show(p.integral(x, p.symbol(ZERO_START, Kind.INITIAL))) == "Int(x)"


def test_names_stand_for_what_they_name_also_inside_of_roots() -> None:
    p = Pool()
    x, u, c = p.symbol("x", Kind.SENSOR), p.symbol("u", Kind.UNKNOWN), p.symbol("c", Kind.UNKNOWN)
    part = p.add((1, x), (2, p.one))
    zero = p.sub(p.add((1, u), (1, p.power(u, 3))), p.mul(c, c))
    node = p.root(Root("i", zero, u, (c,), u, True, Fraction(0)), part)
    assert show(node) == "root(i, (i + i^3) - (x + 2)^2)"
    assert show(p.der(node), {part: "s", node: "r"}) == "D(r)"
    assert show(node, {part: "s"}) == "root(i, (i + i^3) - s^2)"


def test_a_deep_expression_is_written() -> None:
    p = Pool()
    node = p.symbol("x", Kind.SENSOR)
    for _ in range(3000):
        node = p.fn("tanh", node)
    assert show(node).count("tanh(") == 3000
