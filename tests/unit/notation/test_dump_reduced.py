"""The derivatives of known signals that the steps of an elimination take."""

from __future__ import annotations

import pytest

from bondgraph.ir.expr import Expr, Kind, Pool
from bondgraph.notation.dump_reduced import derivative_orders

p = Pool()
y = p.symbol("y", Kind.SENSOR)
u = p.symbol("u", Kind.INPUT)
k = p.symbol("k", Kind.PARAM)
start = p.symbol("x0", Kind.INITIAL)


@pytest.mark.parametrize(
    ("expr", "order"),
    [
        (y, 0),
        (p.add((1, y), (1, k)), 0),
        (p.mul(k, p.der(y)), 1),
        (p.add((1, p.der(u, 2)), (1, p.mul(k, p.der(y)))), 2),
        (p.der(p.mul(k, p.der(y))), 2),
        (p.integral(y, start), -1),
        (p.integral(p.mul(k, p.integral(u, start)), start), -2),
        (p.add((1, p.integral(y, start)), (1, u)), 0),
        (k, None),
        (p.der(k), None),  # of a parameter that moves: no known signal
        (p.fn("sin", p.add((1, k), (1, p.der(k)))), None),
        (p.integral(k, start), None),
        (p.one, None),
        (p.add((1, p.der(k, 3)), (1, y)), 0),
    ],
)
def test_the_highest_derivative_of_a_known_signal(expr: Expr, order: int | None) -> None:
    assert derivative_orders([p.one, expr])[expr] == order
