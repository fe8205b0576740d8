"""Derivatives of unknowns that one equation gives and another needs; expectations by hand."""

from __future__ import annotations

from bondgraph.ir.expr import Expr, Kind, Pool, topological
from bondgraph.passes.descent import Descent
from bondgraph.passes.loops import Loops
from bondgraph.passes.lowering.derivative import differentiate
from bondgraph.passes.nominal import Nominal
from bondgraph.passes.zero import is_zero
from bondgraph.pipeline import Compilation
from bondgraph.text.source import Source

# The rotor's flux turns with the shaft: its rate is known by the stator, the flux itself is not.
MACHINE = """
  model Machine {{
    param Rs = 0.7; param Rr = 0.5; param Ls = 1.4; param Lr = 1.5; param M = 1.1
    param J = 0.8; param f = 0.3
    1:sa {{ <- Se:ua; -> R:Rsa = Rs; -> al.s; -> Df:ia }}
    1:sb {{ <- Se:ub; -> R:Rsb = Rs; -> be.s; -> Df:ib }}
    I:al {{ port s; port r; s.p = Ls*s.f + M*r.f; r.p = M*s.f + Lr*r.f }}
    I:be {{ port s; port r; s.p = Ls*s.f + M*r.f; r.p = M*s.f + Lr*r.f }}
    1:ra {{ -> al.r; -> R:Rra = Rr; -> MGY:ga {{ e1 = be.r.p*f2 }} -> shaft }}
    1:rb {{ -> be.r; -> R:Rrb = Rr; -> MGY:gb {{ e1 = -al.r.p*f2 }} -> shaft }}
    1:shaft {{ -> I:J; -> R:f; -> Df:w }}
  }}
  model M {{ Machine:m[{count}] }}
"""


def compiled(text: str) -> Compilation:
    return Compilation(Source("test.bg", f"bg 1\n{text}"), "M")


def test_a_derivative_goes_and_those_above_it_go_with_it() -> None:
    # D(u x) = -y/a, so D(u x, 2) + 3 D(u x) + x = -D(y)/a - 3 y/a + x
    pool = Pool()
    x, u = pool.symbol("x", Kind.TEAR), pool.symbol("u", Kind.INPUT)
    y, a = pool.symbol("y", Kind.SENSOR), pool.symbol("a", Kind.PARAM)
    rate = pool.der(pool.mul(u, x))
    giving = pool.add((1, pool.mul(a, rate)), (1, y))
    other = pool.add((1, pool.der(rate)), (3, rate), (1, x))
    found = Descent(pool).lowered([other, giving])
    assert found is not None
    assert (found.row, found.by) == (0, 1)
    share = pool.div(y, a)
    by_hand = pool.add((1, x), (-3, share), (-1, pool.der(share)))
    assert is_zero(pool.sub(found.expr, by_hand))


def test_what_is_nominally_zero_is_not_divided_by() -> None:
    pool = Pool()
    x, y, a = (
        pool.symbol(n, k) for n, k in (("x", Kind.TEAR), ("y", Kind.SENSOR), ("a", Kind.PARAM))
    )
    rows = [
        pool.add((1, pool.mul(a, pool.der(x))), (1, y)),
        pool.add((1, pool.mul(y, x)), (1, pool.der(x))),
    ]
    assert Descent(pool).lowered(rows) is not None
    assert Descent(pool, lambda c: c is a).lowered(rows) is None


def test_a_loop_without_a_surplus_does_not_hide_what_another_loses() -> None:
    # z is given by each of two rows, so one relation is lost, whatever x and y do
    graph = compiled("model M { 1:j { <- Se:u; -> R:R = 1; -> Df:i } }").graph
    pool = graph.pool
    loops = Loops(pool, Nominal(graph))
    x, y, z = (loops.tear(pool.symbol(n, Kind.FLOW)) for n in "xyz")
    known = pool.symbol("i", Kind.SENSOR)

    def turning(v: Expr) -> Expr:
        return pool.mul(v, pool.der(v))

    loops.row(0, pool.sub(pool.add((1, turning(x)), (1, turning(y))), known))
    loops.row(1, pool.sub(pool.mul(z, turning(z)), known))
    loops.row(2, pool.add((1, pool.fn("sin", turning(z))), (1, turning(z)), (-1, known)))
    assert loops.relations() == []
    assert loops.lost == [((1, 2), (2,))]


def test_fluxes_of_unknown_start_are_not_multiplied_by_how_the_speed_changes() -> None:
    # by hand: the rotor's laws are linear in its currents, with determinant Rr^2 + (w Lr)^2, and
    # three relations follow in which w is differentiated once at most
    c = compiled(MACHINE.format(count=1))
    assert c.verification
    assert len(c.residuals) == 3
    pool = c.graph.pool
    w = next(s.symbol for s in c.graph.sensors if s.name.endswith("w"))
    twice = pool.der(pool.der(w))
    for closing in c.reduced.closings:
        assert twice not in topological([differentiate(pool, closing.expr, 0)])
    c = compiled(MACHINE.format(count=4))
    assert len(c.residuals) == 12


def test_a_rate_that_the_primary_gives_takes_the_secondary_out_of_its_law() -> None:
    # by hand: q' = (u - R1 i - L1 i')/M, and the law of the secondary then gives q by division by
    # 1 + load^2 + L2 w; the rate of q and the torque balance are the two relations
    c = compiled(
        "model M { param R1 = 0.7; param L1 = 1.4; param L2 = 1.5; param M = 1.1; param J = 1\n"
        "param f = 0.2; input load\n"
        "1:a { <- Se:u; -> R:R1; -> tr.a; -> Df:i }\n"
        "1:b { -> tr.b; -> R:br { e = (1 + load^2)*f }; -> MGY:g { e1 = tr.b.p*f2 } -> w }\n"
        "1:w { -> I:J; -> R:f; -> Df:speed }\n"
        "I:tr { port a; port b; a.p = L1*a.f + M*b.f; b.p = M*a.f + L2*b.f } }"
    )
    assert c.verification
    assert len(c.residuals) == 2
