"""Units of relations from those of what they are made of."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import pytest

from bondgraph.ir.expr import Expr, Kind
from bondgraph.passes.relation.residual_units import residual_units
from tests.unit.passes.circuits import compiled

_TEXT = """bg 1
model M {
    input a : V
    input b : A
    1:s { <- Se:U = a; -> R:R = 2 Ohm; -> Df:i }
}
"""
_GRAPH = compiled(_TEXT).graph
p = _GRAPH.pool
a, b = (next(i.symbol for i in _GRAPH.inputs if i.name == name) for name in "ab")
odd, start = p.symbol("odd", Kind.PARAM), p.symbol("x0", Kind.INITIAL)
reading = next(s.symbol for s in _GRAPH.sensors)
less = p.compare("<", a, b)


@pytest.mark.parametrize(
    ("expr", "unit"),
    [
        (a, "V"),
        (p.mul(a, b), "W"),
        (p.power(b, 2), "A^2"),
        (p.div(a, b), "Ohm"),
        (p.mul(p.num(3), a), "V"),
        (p.scale(2, reading), "A"),
        (p.num(3), "1"),
        (p.der(a), "V/s"),
        (p.integral(b, start), "C"),
        (p.add((2, a), (-1, p.mul(b, p.div(a, b)))), "V"),
        (p.fn("abs", a), "V"),
        (p.fn("max", a, odd), "V"),
        (p.choose(less, a, p.scale(2, a)), "V"),
        # of what nobody knows the unit of, what stands beside it tells
        (p.add((2, a), (1, odd)), "V"),
        (p.add((1, odd), (1, p.der(odd))), ""),
        (p.choose(less, a, odd), "V"),
        (p.choose(less, odd, a), "V"),
        (odd, ""),
        (p.mul(odd, a), ""),
        (p.der(odd), ""),
        (p.integral(odd, start), ""),
        (p.fn("sin", a), ""),
        (p.fn("table:t", a), ""),
    ],
)
def test_the_unit_of_a_relation(expr: Expr, unit: str) -> None:
    one: Any = SimpleNamespace(name="r", expr=expr)
    assert residual_units(_GRAPH, [one]) == {"r": unit}


def test_each_relation_has_a_unit_of_its_own() -> None:
    made: Any = [SimpleNamespace(name=f"r{k}", expr=e) for k, e in enumerate((a, b, p.der(a)))]
    assert residual_units(_GRAPH, made) == {"r0": "V", "r1": "A", "r2": "V/s"}


def test_a_relation_of_a_model_is_in_the_unit_of_its_terms() -> None:
    c = compiled(_TEXT.replace("R:R = 2 Ohm;", "R:R;").replace("1:s", "param R = 2 Ohm\n    1:s"))
    assert residual_units(c.graph, [r.residual for r in c.residuals]) == {"r1": "V"}  # a - R i
