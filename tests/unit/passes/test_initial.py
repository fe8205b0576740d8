"""Relations without undeclared initial values: what cancels is taken out, and nothing with it."""

from __future__ import annotations

from bondgraph.algebra.zero import is_zero
from bondgraph.ir.expr import Kind, Op, Pool, topological
from bondgraph.passes.elimination.initial import without_free_integrals


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


def test_a_hidden_flux_in_a_product_that_is_differentiated() -> None:
    """v = (w p)' = w' p + w u with p' = u: from c p + b = 0 follows c b' - c' b + c^2 p' = 0.

    Here c = w' and b = w u - v, so that w' (w u - v)' - w'' (w u - v) + w'^2 u = 0.
    """
    pool = Pool()
    v, w, u = (pool.symbol(name, Kind.SENSOR) for name in "vwu")
    p = pool.integral(u, pool.symbol("p.0", Kind.FREE))
    found = without_free_integrals(pool, pool.sub(pool.der(pool.mul(w, p)), v))
    assert found is not None
    slope, left = pool.der(w), pool.sub(pool.mul(w, u), v)
    by_hand = pool.add(
        (1, pool.mul(slope, pool.der(left))),
        (-1, pool.mul(pool.der(slope), left)),
        (1, pool.mul(slope, slope, u)),
    )
    assert is_zero(pool.sub(found.expr, by_hand))
    assert found.order == 1


def test_the_current_of_a_hidden_charge_is_known_where_it_divides() -> None:
    """(U/((q/C)' + w))' - z with q' = i: the charge is below, and only its change is in it."""
    pool = Pool()
    U, w, z, i = (pool.symbol(name, Kind.SENSOR) for name in "Uwzi")
    C = pool.symbol("C", Kind.PARAM)
    q = pool.integral(i, pool.symbol("C.q.0", Kind.FREE))
    below = pool.add((1, pool.der(pool.div(q, C))), (1, w))
    held = pool.sub(pool.der(pool.div(U, below)), z)
    found = without_free_integrals(pool, held)
    assert found is not None
    by_hand = pool.sub(pool.der(pool.div(U, pool.add((1, pool.div(i, C)), (1, w)))), z)
    assert is_zero(pool.sub(found.expr, by_hand))
    assert found.order == 0 and found.raw is held


def test_a_hidden_charge_is_taken_out_of_a_product_that_is_all() -> None:
    """From w q = 0 follows w^2 q' = 0, and nothing is divided by w."""
    pool = Pool()
    w, i = (pool.symbol(name, Kind.SENSOR) for name in "wi")
    q = pool.integral(i, pool.symbol("C.q.0", Kind.FREE))
    found = without_free_integrals(pool, pool.mul(w, q))
    assert found is not None and found.order == 1
    assert is_zero(pool.sub(found.expr, pool.mul(w, w, i)))


def test_a_hidden_charge_before_which_nothing_stands_is_none() -> None:
    """Two of them, one times (a + b)^2 - a^2 - 2 a b - b^2: only the other is taken out."""
    pool = Pool()
    y, w, i, j = (pool.symbol(name, Kind.SENSOR) for name in "ywij")
    a, b = pool.symbol("a", Kind.PARAM), pool.symbol("b", Kind.PARAM)
    square = pool.power(pool.add((1, a), (1, b)), 2)
    terms = (1, pool.power(a, 2)), (2, pool.mul(a, b)), (1, pool.power(b, 2))
    nothing = pool.sub(square, pool.add(*terms))
    first, second = (
        pool.integral(rate, pool.symbol(f"{name}.q.0", Kind.FREE))
        for rate, name in ((i, "A"), (j, "B"))
    )
    for one, other, rate in ((first, second, j), (second, first, i)):
        expr = pool.add((1, y), (1, pool.mul(nothing, one)), (1, pool.mul(w, other)))
        found = without_free_integrals(pool, expr)
        assert found is not None
        by_hand = pool.add(
            (1, pool.mul(w, pool.der(y))), (-1, pool.mul(pool.der(w), y)), (1, pool.mul(w, w, rate))
        )
        assert is_zero(pool.sub(found.expr, by_hand))
