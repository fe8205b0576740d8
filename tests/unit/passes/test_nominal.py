"""Whether an expression has a value where one variable has one and all else is one."""

from __future__ import annotations

from collections.abc import Callable

import pytest

from bondgraph.ir.expr import Expr, Kind, Pool
from bondgraph.passes.nominal import defined


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
