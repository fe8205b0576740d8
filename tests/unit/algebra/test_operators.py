"""Torn variables drop out of rows: by hand, by SymPy's division, by Kalman's rule."""

from __future__ import annotations

import sympy

from bondgraph.algebra.derivative import differentiate
from bondgraph.algebra.nominal import Nominal
from bondgraph.algebra.normalise import normalise
from bondgraph.algebra.operators import Operators
from bondgraph.algebra.zero import is_zero
from bondgraph.compilation import Compilation
from bondgraph.ir.expr import Expr, Kind, Op, Pool, topological
from bondgraph.passes.elimination.tearing import Loops
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
    found = Operators(pool).lowered([other, giving])
    assert found is not None
    assert (found.row, found.by) == (0, 1)
    share = pool.div(y, a)
    by_hand = pool.add((1, x), (-3, share), (-1, pool.div(pool.der(y), a)))
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
    by_first = Operators(pool).lowered(rows)
    assert by_first is not None and by_first.by == 0
    by_second = Operators(pool, lambda c: c is a).lowered(rows)
    assert by_second is not None and by_second.by == 1
    assert is_zero(pool.sub(by_second.expr, pool.sub(y, pool.mul(a, y, x))))
    assert Operators(pool, lambda _: True).lowered(rows) is None


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


def test_the_remainder_is_the_one_of_a_division_of_polynomials() -> None:
    """(2 D^2 + 3 D + 5) t + y and (D + 7) t + z give 82 t + y - 2 z' + 11 z.

    By hand: 2 D^2 + 3 D + 5 = (2 D - 11)(D + 7) + 82.
    """
    pool = Pool()
    t, y, z = (
        pool.symbol(n, k) for n, k in (("t", Kind.TEAR), ("y", Kind.SENSOR), ("z", Kind.SENSOR))
    )
    first = pool.add((2, pool.der(pool.der(t))), (3, pool.der(t)), (5, t), (1, y))
    second = pool.add((1, pool.der(t)), (7, t), (1, z))
    found = Operators(pool).lowered([first, second])
    assert found is not None and (found.row, found.by) == (0, 1)
    D = sympy.Symbol("D")
    left = int(sympy.rem(2 * D**2 + 3 * D + 5, D + 7, D))
    by_hand = pool.add((left, t), (1, y), (-2, pool.der(z)), (11, z))
    assert is_zero(pool.sub(found.expr, by_hand))


def test_two_torn_variables_drop_out_of_three_rows() -> None:
    """t' + 2 s + y, 3 t + s' + z and t + s + w give y' - 3 y + z' - 2 z - w'' + 6 w.

    By hand: t = -s - w. The sum of the first two is then s = y + z - w' - 3 w, which is put into
    the second one, s' - 3 s - 3 w + z.
    """
    pool = Pool()
    t, s = pool.symbol("t", Kind.TEAR), pool.symbol("s", Kind.TEAR)
    y, z, w = (pool.symbol(n, Kind.SENSOR) for n in "yzw")
    work = Operators(pool)
    equations = [
        pool.add((1, pool.der(t)), (2, s), (1, y)),
        pool.add((3, t), (1, pool.der(s)), (1, z)),
        pool.add((1, t), (1, s), (1, w)),
    ]
    rows = [work.linear((k,), equation) for k, equation in enumerate(equations)]
    assert None not in rows
    ((numbers, found),) = work.relations([row for row in rows if row is not None])
    assert sorted(set(numbers)) == [0, 1, 2]
    assert set(work.spent) == {t, s}
    by_hand = pool.add(
        (1, pool.der(y)), (-3, y), (1, pool.der(z)), (-2, z), (-1, pool.der(w, 2)), (6, w)
    )
    left = [normalise(pool, pool.add((1, found), (sign, by_hand))).terms for sign in (1, -1)]
    assert () in left


def test_an_integral_of_a_torn_variable_is_differentiated_away() -> None:
    """t + 3 int(t + y) + z, differentiated, is t' + 3 t + 3 y + z'."""
    pool = Pool()
    t, y, z = (
        pool.symbol(n, k) for n, k in (("t", Kind.TEAR), ("y", Kind.SENSOR), ("z", Kind.SENSOR))
    )
    start: Expr = pool.symbol("x.q0", Kind.CONST)
    whole = pool.integral(pool.add((1, t), (1, y)), start)
    row = Operators(pool).linear((0,), pool.add((1, t), (3, whole), (1, z)))
    assert row is not None
    assert row.entries == {t: [pool.num(3), pool.one]}
    rest = normalise(pool, row.rest)
    assert {(term.atom, term.order) for term in rest.terms} == {(y, 0), (z, 1)}


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
    work = Operators(pool)
    whole = work.lowered([other, giving])  # D(y x) stays as it is at first
    assert whole is not None and (whole.row, whole.by) == (0, 1)
    found = work.lowered([whole.expr, giving])
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
    found = Operators(pool).lowered([giving, pool.sub(pool.der(pool.der(x)), y)])
    assert found is not None
    by_hand = pool.add((1, pool.der(u)), (-2, u), (4, x), (-1, y))
    assert is_zero(pool.sub(found.expr, by_hand))


def test_what_divides_a_term_multiplies_the_row() -> None:
    """No relation is divided by a modulus: D(x/y) becomes y x' - y' x, less w y^2."""
    pool = Pool()
    x, u, y, w = symbols(pool)
    giving = pool.sub(pool.der(x), u)
    found = Operators(pool).lowered([giving, pool.sub(pool.der(pool.div(x, y)), w)])
    assert found is not None
    by_hand = pool.add((1, pool.mul(y, u)), (-1, pool.mul(pool.der(y), x)), (-1, pool.mul(w, y, y)))
    assert is_zero(pool.sub(found.expr, by_hand))


def test_nothing_is_lowered_without_a_rate_that_stands_alone() -> None:
    """Two rates in each row, or one squared, say nothing of one of them."""
    pool = Pool()
    x, u, y, w = symbols(pool)
    z = pool.symbol("z?", Kind.TEAR)
    both = pool.add((1, pool.der(x)), (1, pool.der(z)), (-1, u))
    assert Operators(pool).lowered([both, pool.sub(pool.der(pool.mul(x, z)), y)]) is None
    squares = [pool.sub(pool.power(pool.der(x), 2), u), pool.sub(pool.power(pool.der(x), 3), w)]
    assert Operators(pool).lowered(squares) is None


def test_a_rate_that_a_product_with_an_integral_holds_costs_no_relation() -> None:
    # two readings and no unknown input: two relations
    c = compiled(
        "model M { param p0 = 2; param p1 = 1; param p2 = 5; param p3 = 0.5\n"
        "0:j0; 1:j1; 0:j2; 1:j3\n"
        "TF:t1 { f1 = p0*f2 }; TF:t2 { f2 = p1*f1 }\n"
        "j1 -> j0; j0 <- I:x1 { f = p + p2*tanh(p) }; j1 -> t1; j2 -> t1; j2 <- t2; j3 <- t2\n"
        "j2 <- I:x3 = p2; j2 -> R:x2 { f = p3*e/(1 + abs(e)) }\n"
        "j3 -> Df:y1twice = y1; j3 <- Df:y1\n"
        "let h1 = int(j3.f)\nsensor y0 = j0.e*h1 }"
    )
    assert len(c.residuals) == 2
    assert not c.reduced.missing
    assert c.verification.method.startswith("exact")


def test_an_integral_with_a_signal_or_a_rate_is_not_linear() -> None:
    """No derivative takes u int(x) to x and its derivatives; int(x') knows where x began."""
    pool = Pool()
    x, u, y, _ = symbols(pool)
    start = pool.symbol("x.q0", Kind.CONST)
    work = Operators(pool)
    for row in (
        pool.mul(u, pool.integral(x, start)),
        pool.integral(pool.mul(u, x), start),
        pool.integral(pool.der(x), start),
    ):
        assert work.linear((0,), pool.sub(row, y)) is None
