"""Rows in torn variables: Euclid's algorithm against SymPy's, integrals against derivatives."""

from __future__ import annotations

import sympy

from bondgraph.ir.expr import Expr, Kind, Pool
from bondgraph.passes.crosswise import Crosswise
from bondgraph.passes.nominal import Nominal
from bondgraph.passes.normalise import normalise
from bondgraph.passes.zero import is_zero
from tests.unit.passes.elaborating import graph

FRAME = graph("model M { Se:U -> R:r = 1; sensor y = r.f }")


def crosswise() -> tuple[Pool, Crosswise]:
    """The rows of a model that has nothing to do with them."""
    return FRAME.pool, Crosswise(FRAME.pool, Nominal(FRAME))


def test_euclid_ends_with_the_constant_that_sympy_finds() -> None:
    """(2 D^2 + 3 D + 5) t + y and (D + 7) t + z give 82 t + y - 2 z' + 11 z.

    By hand: 2 D^2 + 3 D + 5 = (2 D - 11)(D + 7) + 82.
    """
    pool, rows = crosswise()
    t, y, z = (
        pool.symbol(n, k) for n, k in (("t?", Kind.TEAR), ("y", Kind.SENSOR), ("z", Kind.SENSOR))
    )
    first = pool.add((2, pool.der(pool.der(t))), (3, pool.der(t)), (5, t), (1, y))
    second = pool.add((1, pool.der(t)), (7, t), (1, z))
    pending = [rows.linear((0,), first), rows.linear((1,), second)]
    for _ in range(2):
        found = rows.remainder(pending)
        assert found is not None
        pending[found[0]] = found[1]
    (row,) = [r for r in pending if r is not None and len(r.entries[t]) == 1]
    D = sympy.Symbol("D")
    left = sympy.rem(2 * D**2 + 3 * D + 5, D + 7, D)
    scale = pool.div(row.entries[t][0], pool.num(int(left)))
    by_hand = pool.add((1, y), (-2, pool.der(z)), (11, z))
    assert is_zero(pool.sub(row.rest, pool.mul(scale, by_hand)))
    assert not is_zero(row.rest)
    assert sorted(row.rows) == [0, 1]


def test_an_integral_of_a_torn_variable_is_differentiated_away() -> None:
    """t + 3 int(t + y) + z, differentiated, is t' + 3 t + 3 y + z'."""
    pool, rows = crosswise()
    t, y, z = (
        pool.symbol(n, k) for n, k in (("s?", Kind.TEAR), ("y", Kind.SENSOR), ("z", Kind.SENSOR))
    )
    start: Expr = pool.symbol("x.q0", Kind.CONST)
    whole = pool.integral(pool.add((1, t), (1, y)), start)
    row = rows.linear((0,), pool.add((1, t), (3, whole), (1, z)))
    assert row is not None
    assert row.entries == {t: [pool.num(3), pool.one]}
    rest = normalise(pool, row.rest)
    assert {(term.atom, term.order) for term in rest.terms} == {(y, 0), (z, 1)}
