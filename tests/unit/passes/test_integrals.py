"""Sums of integrals as one integral: exactly those that begin at zero, beside constants."""

from __future__ import annotations

from bondgraph.ir.expr import ZERO_START, Expr, Kind, Pool
from bondgraph.passes.lowering.integrals import gathered

p = Pool()
x, y, z = (p.symbol(name, Kind.SENSOR) for name in "xyz")
a, b = p.symbol("a", Kind.PARAM), p.symbol("b", Kind.PARAM)
zero, other = p.symbol(ZERO_START, Kind.INITIAL), p.symbol("q0", Kind.INITIAL)


def total(of: Expr, start: Expr = zero) -> Expr:
    return p.integral(of, start)


def test_integrals_beside_constants_are_joined_with_these() -> None:
    expr = p.add((2, total(x)), (-1, p.mul(a, total(y))), (1, p.div(total(z), b)), (3, x))
    joined = p.add((2, x), (-1, p.mul(a, y)), (1, p.div(z, b)))
    assert gathered(p, expr, zero) is p.add((3, x), (1, total(joined)))


def test_what_is_inside_of_others_is_joined_as_well() -> None:
    expr = p.fn("sin", p.add((1, total(x)), (1, total(y))))
    assert gathered(p, expr, zero) is p.fn("sin", total(p.add((1, x), (1, y))))


def test_others_stay_as_they_are() -> None:
    for expr in (
        p.add((1, total(x)), (1, y)),  # one alone
        p.add((1, total(x)), (1, total(y, other))),  # that begins elsewhere
        p.add((1, total(x)), (1, p.mul(y, total(z)))),  # beside what moves
        p.add((1, total(x)), (1, p.mul(total(y), total(z)))),
        p.add((1, total(x)), (1, total(p.der(p.fn("tanh", y))))),  # the change of something
        p.mul(total(x), total(y)),
        p.add((1, x), (1, y)),
    ):
        assert gathered(p, expr, zero) is expr
    two = p.add((1, total(x)), (1, total(y)), (1, total(z, other)))
    assert gathered(p, two, zero) is p.add(
        (1, total(z, other)), (1, total(p.add((1, x), (1, y))))
    )
