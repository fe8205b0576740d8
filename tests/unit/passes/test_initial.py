"""Relations without undeclared initial values: what cancels is taken out, and nothing with it."""

from __future__ import annotations

from bondgraph.ir.expr import Kind, Op, Pool, topological
from bondgraph.passes.initial import without_free_integrals


def test_a_function_of_a_hidden_charge_that_cancels() -> None:
    """y + log(q) ((a + b)^2 - a^2 - 2 a b - b^2) is y: q = 0 would leave log(0) times zero."""
    pool = Pool()
    y, i = pool.symbol("y", Kind.SENSOR), pool.symbol("i", Kind.SENSOR)
    a, b = pool.symbol("a", Kind.PARAM), pool.symbol("b", Kind.PARAM)
    q = pool.integral(i, pool.symbol("C.q.0", Kind.FREE))
    square = pool.power(pool.add((1, a), (1, b)), 2)
    terms = (1, pool.power(a, 2)), (2, pool.mul(a, b)), (1, pool.power(b, 2))
    nothing = pool.sub(square, pool.add(*terms))
    found = without_free_integrals(
        pool, pool.add((1, y), (1, pool.mul(pool.fn("log", q), nothing)))
    )
    assert found is not None
    assert found.expr is y


def test_a_hidden_charge_that_does_not_cancel_stays() -> None:
    """log(q i) - log(q) is log(i), but no rule of sums and products says so."""
    pool = Pool()
    i = pool.symbol("i", Kind.SENSOR)
    q = pool.integral(i, pool.symbol("C.q.0", Kind.FREE))
    logs = pool.sub(pool.fn("log", pool.mul(q, i)), pool.fn("log", q))
    found = without_free_integrals(pool, logs)
    assert found is None or not any(
        n.op is Op.INT and n.symbol.kind is Kind.FREE for n in topological([found.expr])
    )
