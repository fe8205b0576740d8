"""How often equations are differentiated and what becomes a state, for systems done by hand."""

from __future__ import annotations

import pytest

from bondgraph.ir.expr import Expr, Kind, Pool
from bondgraph.structural.reduce_index import Reduced, reduce_index


def symbols(*names: str) -> list[Expr]:
    pool = Pool()
    return [pool.symbol(name, Kind.PARAM) for name in names]


@pytest.mark.parametrize("first", [0, 1])
def test_the_pendulum_of_pryce(first: int) -> None:
    """x'' + x l = 0, y'' + y l = g, x^2 + y^2 = L^2: Pryce (2001) has c = 0 0 2 and d = 2 2 0.

    The length and its derivative determine one of x and y and its velocity, whichever is wished.
    """
    x, y, tension = symbols("x", "y", "l")
    rows = [{x: 2, tension: 0}, {y: 2, tension: 0}, {x: 0, y: 0}]
    computed = (x, y)[first]
    found = reduce_index(rows, lambda v: v is not computed)
    other = (x, y)[1 - first]
    assert found == Reduced((0, 0, 2), {x: 2, y: 2, tension: 0}, ((other, 0), (other, 1)))


def test_two_inertias_on_one_shaft_have_one_state() -> None:
    """p' = F - R, q' = R and p/a = q/b: the last one is differentiated once, q is computed."""
    p, q, between = symbols("p", "q", "R")
    rows = [{p: 1, between: 0}, {q: 1, between: 0}, {p: 0, q: 0}]
    found = reduce_index(rows, lambda v: v is not q)
    assert found == Reduced((0, 0, 1), {p: 1, q: 1, between: 0}, ((p, 0),))


def test_without_a_constraint_nothing_is_differentiated() -> None:
    q, p = symbols("q", "p")
    found = reduce_index([{q: 1, p: 0}, {p: 1, q: 0}], lambda v: 0)
    assert found == Reduced((0, 0), {q: 1, p: 1}, ((q, 0), (p, 0)))
    assert reduce_index([], lambda v: 0) == Reduced((), {}, ())


@pytest.mark.parametrize("size", [13, 14])
def test_what_is_differentiated_a_dozen_times_is_the_last_that_is(size: int) -> None:
    """v0 is given, each v the derivative of the one before: row k once less often than row k - 1.

    All is then determined. With one more the first row is differentiated 13 times, and all but the
    last one at least once: they are told as what contradicts.
    """
    v = symbols(*(f"v{k}" for k in range(size)))
    rows = [{v[0]: 0}, *({v[k - 1]: 1, v[k]: 0} for k in range(1, size))]
    found = reduce_index(rows, lambda v: 0)
    if size == 13:
        orders = {variable: 12 - k for k, variable in enumerate(v)}
        assert found == Reduced(tuple(range(12, -1, -1)), orders, ())
    else:
        assert found == list(range(13))
