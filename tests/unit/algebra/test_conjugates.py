"""Norms of relations in a variable that is known up to a sign, by hand and in numbers."""

from __future__ import annotations

import pytest
import sympy as sp

from bondgraph.algebra.conjugates import norm, two_valued
from bondgraph.algebra.in_mode import in_mode
from bondgraph.algebra.symbolic import to_sympy
from bondgraph.ir.expr import Expr, Kind, Pool
from tests.unit.passes.relations import t


def symbols(pool: Pool) -> tuple[Expr, Expr, Expr]:
    return pool.symbol("x", Kind.INPUT), pool.symbol("y", Kind.SENSOR), pool.symbol("on", Kind.MODE)


def at(expr: Expr, **signals: sp.Expr) -> sp.Expr:
    """The value of an expression of signals at t = 2/5."""
    found = to_sympy(expr)
    known = {f: signals[f.func.__name__] for f in found.atoms(sp.core.function.AppliedUndef)}
    return sp.N(found.subs(known).doit().subs(t, sp.Rational(2, 5)), 40)


@pytest.mark.parametrize("sign", [1, -1])
def test_the_norm_vanishes_for_both_values(sign: int) -> None:
    """x = sign*sqrt(y): D(x)/(1 + x) + 3 x^3 - D(D(x)) is put in place of what y is not free to be.

    The relation is linear in z, so that z can be had from it; with that z its norm has to vanish.
    """
    pool = Pool()
    x, y, _ = symbols(pool)
    z = pool.symbol("z", Kind.SENSOR)
    inside = pool.add(
        (1, pool.div(pool.der(x), pool.add((1, pool.one), (1, x)))),
        (3, pool.power(x, 3)),
        (-1, pool.der(x, 2)),
    )
    known = two_valued(pool, pool.sub(y, pool.power(x, 2)), x)
    assert known is not None
    found = norm(pool, pool.add((1, inside), (-1, z)), known)
    assert found is not None
    signal = 2 + t + t**2
    value = sign * sp.sqrt(signal)
    given = sp.diff(value, t) / (1 + value) + 3 * value**3 - sp.diff(value, t, 2)
    assert abs(at(found, y=signal, z=given)) < 1e-25
    assert abs(at(found, y=signal, z=given + 1)) > 1e-3


def test_what_does_not_hold_the_root_is_not_squared() -> None:
    pool = Pool()
    x, y, _ = symbols(pool)
    known = two_valued(pool, pool.sub(y, pool.power(x, 2)), x)
    assert known is not None
    assert norm(pool, pool.sub(pool.power(x, 4), pool.one), known) is pool.sub(
        pool.power(y, 2), pool.one
    )


def test_where_neither_value_can_be_told_any_more() -> None:
    """An integral of x, exp(x), and a condition on x depend on the sign in no algebraic way."""
    pool = Pool()
    x, y, _ = symbols(pool)
    known = two_valued(pool, pool.sub(y, pool.power(x, 2)), x)
    assert known is not None
    start = pool.symbol("x.0", Kind.FREE)
    for lost in (
        pool.integral(x, start),
        pool.fn("exp", x),
        pool.choose(pool.compare("<", x, y), x, y),
    ):
        assert norm(pool, pool.sub(lost, y), known) is None


def test_in_each_position_of_a_switch() -> None:
    """if(on, x, 2) = y with x^2 = y: y - y^2 while it is on, 2 - y, no square, while not."""
    pool = Pool()
    x, y, on = symbols(pool)
    known = two_valued(pool, pool.sub(y, pool.power(x, 2)), x)
    assert known is not None
    found = norm(pool, pool.sub(pool.choose(on, x, pool.num(2)), y), known)
    assert found is not None
    yes, no = (in_mode(pool, [found], {on: position})[0] for position in (True, False))
    value = sp.Rational(3)
    assert abs(abs(at(yes, y=value)) - (value**2 - value)) < 1e-25
    assert abs(abs(at(no, y=value)) - (value - 2)) < 1e-25


@pytest.mark.parametrize("wrong", ["cube", "product with its rate", "angle beside its sine"])
def test_other_equations_leave_no_two_values(wrong: str) -> None:
    pool = Pool()
    x, y, _ = symbols(pool)
    left = {
        "cube": pool.power(x, 3),
        "product with its rate": pool.mul(x, pool.der(x)),
        "angle beside its sine": pool.add((1, x), (1, pool.fn("sin", x))),
    }[wrong]
    assert two_valued(pool, pool.sub(left, y), x) is None
