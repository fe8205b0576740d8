"""Elimination in SymPy by hand: which row gives an unknown, what is left, what is a multiple."""

from __future__ import annotations

from typing import Any

import pytest
import sympy as sp

from bondgraph.algebra.symbolic import t
from bondgraph.algebra.sympy_elimination import (
    Loop,
    Unshown,
    factor_of,
    linear,
    order,
    solve_for,
)

e, f, u, y, z = (sp.Function(n, real=True)(t) for n in "efuyz")
a, b = sp.symbols("a b", positive=True)


def changes(rows: list[Any], unknowns: list[Any]) -> tuple[list[tuple[int, int, Any]], list[Any]]:
    """What happened to which row by which, and the rows that are left."""
    loop = Loop(rows, unknowns)
    found = [(c.row, c.by, c.expr) for c in loop.changes()]
    return found, list(loop.rows.values())


def test_the_plainest_row_gives_the_unknown() -> None:
    """2 e = y before u e = 1, by which it would be divided by a signal, and before e e = z."""
    found, left = changes([u * e - 1, e**2 - z, 2 * e - y], [e])
    assert found[0] == (2, 2, y / 2)
    assert factor_of(left[0], u * y - 2) is not None
    assert factor_of(left[1], y**2 - 4 * z) is not None


def test_two_unknowns_of_three_rows_leave_one() -> None:
    """e + f = u, e - f = y and a e = z: 2 z = a (u + y)."""
    _, (left,) = changes([e + f - u, e - f - y, a * e - z], [e, f])
    assert factor_of(left, 2 * z - a * (u + y)) is not None


def test_a_derivative_goes_by_another_row() -> None:
    """e' = u and e'' + 3 e' = y: y = u' + 3 u."""
    found, (left,) = changes([e.diff(t, 2) + 3 * e.diff(t) - y, e.diff(t) - u], [e])
    assert found[0][:2] == (0, 1)
    assert factor_of(left, u.diff(t) + 3 * u - y) is not None


def test_an_integral_of_an_unknown_is_differentiated_away_first() -> None:
    """e + int e = y and e = u: u + int u = y, differentiated."""
    found, (left,) = changes([e + sp.Integral(e, t) - y, e - u], [e])
    assert found[0][:2] == (0, 0)
    assert factor_of(left, u.diff(t) + u - y.diff(t)) is not None


@pytest.mark.parametrize(
    ("zero", "value"),
    [
        (a * f - u, u / a),
        (sp.exp(a * f) - u, sp.log(u) / a),
        (1 / (f + y) - u, 1 / u - y),
        (sp.sqrt(f) - u, u**2),
        (u / (1 + f) - y / (2 + f), (y - 2 * u) / (u - y)),
        (sp.Piecewise((2 * f - u, u < y), (f - u, True)), sp.Piecewise((u / 2, u < y), (u, True))),
    ],
)
def test_the_value_of_an_unknown_by_hand(zero: Any, value: Any) -> None:
    assert sp.simplify(solve_for(zero, f) - value) == 0


@pytest.mark.parametrize(
    "zero",
    [f**2 - u, f - f + u, sp.sin(f) + f - u, f + f.diff(t) - u],
)
def test_what_has_not_one_value(zero: Any) -> None:
    with pytest.raises(Unshown):
        solve_for(zero, f)


def test_orders_and_what_is_linear() -> None:
    assert [order(x, f) for x in (u, f + u, u * f.diff(t, 3) + f.diff(t))] == [-1, 0, 3]
    assert linear(u * f + sp.sin(u), f)
    assert not linear(f**2, f) and not linear(sp.Piecewise((f, u < y), (2 * f, True)), f)


@pytest.mark.parametrize(
    ("derived", "wanted", "factor"),
    [
        (2 * y - 2 * u, y - u, 2),
        (a * y - u, y - u / a, a),
        (y / u - 1, y - u, 1 / u),  # it was divided by u
        (u * (y - z), y - z, None),  # that u may vanish says nothing of y - z
        (y - u, y + u, None),
        (sp.Integer(0), y, None),
        (sp.Piecewise((2 * y, u < z), (y, True)), y, sp.Piecewise((2, u < z), (1, True))),
    ],
)
def test_a_multiple_is_one_by_what_does_not_vanish(derived: Any, wanted: Any, factor: Any) -> None:
    assert factor_of(derived, wanted) == factor


def test_what_was_multiplied_with_on_the_way_may_stand_before_it() -> None:
    assert factor_of(u * (y - z), y - z, [u]) == u
    assert factor_of(u * (y - z), y - z, [z]) is None
