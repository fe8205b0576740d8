"""Rates of hidden states put into other rows, against Kalman's rule for x' = a x + b, y = c x."""

from __future__ import annotations

from bondgraph.ir.expr import Expr, Kind, Op, Pool, topological
from bondgraph.passes.rates import Rates
from bondgraph.passes.zero import is_zero


def symbols(pool: Pool) -> tuple[Expr, ...]:
    """A torn variable and three signals."""
    return (
        pool.symbol("x?", Kind.TEAR),
        *(pool.symbol(name, Kind.SENSOR) for name in ("u", "y", "w")),
    )


def test_a_rate_goes_through_products_and_functions() -> None:
    """x' = u - 2 x in D(y x) + sin(w) x' gives (y' - 2 y) x + y u + sin(w) (u - 2 x)."""
    pool = Pool()
    x, u, y, w = symbols(pool)
    giving = pool.add((1, pool.der(x)), (2, x), (-1, u))
    sine = pool.fn("sin", w)
    other = pool.add((1, pool.der(pool.mul(y, x))), (1, pool.mul(sine, pool.der(x))))
    found = Rates(pool).lowered([other, giving])
    assert found is not None and (found.row, found.by) == (0, 1)
    rate = pool.add((1, u), (-2, x))
    by_hand = pool.add(
        (1, pool.mul(pool.der(y), x)), (1, pool.mul(y, rate)), (1, pool.mul(sine, rate))
    )
    assert is_zero(pool.sub(found.expr, by_hand))
    assert not any(n.op is Op.DER and n.args[0] is x for n in topological([found.expr]))


def test_a_second_derivative_takes_the_rate_twice() -> None:
    """x'' = u' - 2 u + 4 x."""
    pool = Pool()
    x, u, y, _ = symbols(pool)
    giving = pool.add((1, pool.der(x)), (2, x), (-1, u))
    found = Rates(pool).lowered([giving, pool.sub(pool.der(pool.der(x)), y)])
    assert found is not None
    by_hand = pool.add((1, pool.der(u)), (-2, u), (4, x), (-1, y))
    assert is_zero(pool.sub(found.expr, by_hand))


def test_what_divides_a_term_multiplies_the_row() -> None:
    """No relation is divided by a modulus: D(x/y) becomes y x' - y' x, less w y^2."""
    pool = Pool()
    x, u, y, w = symbols(pool)
    giving = pool.sub(pool.der(x), u)
    found = Rates(pool).lowered([giving, pool.sub(pool.der(pool.div(x, y)), w)])
    assert found is not None
    by_hand = pool.add((1, pool.mul(y, u)), (-1, pool.mul(pool.der(y), x)), (-1, pool.mul(w, y, y)))
    assert is_zero(pool.sub(found.expr, by_hand))


def test_nothing_is_lowered_without_a_rate_that_stands_alone() -> None:
    """Two rates in each row, or one squared, say nothing of one of them."""
    pool = Pool()
    x, u, y, w = symbols(pool)
    z = pool.symbol("z?", Kind.TEAR)
    both = pool.add((1, pool.der(x)), (1, pool.der(z)), (-1, u))
    assert Rates(pool).lowered([both, pool.sub(pool.der(pool.mul(x, z)), y)]) is None
    squares = [pool.sub(pool.power(pool.der(x), 2), u), pool.sub(pool.power(pool.der(x), 3), w)]
    assert Rates(pool).lowered(squares) is None
