"""Models at the edge of what a signature means, each with the answer that was derived by hand."""

from __future__ import annotations

import pytest
import sympy as sp

from bondgraph.algebra.nominal import Nominal
from bondgraph.algebra.zero import is_zero
from bondgraph.compilation import Compilation
from bondgraph.exact.plant import Plant
from bondgraph.exact.reactions import Reactions
from bondgraph.ir.expr import Expr, Kind, Pool, symbols
from bondgraph.passes.elimination.initial import without_free_integrals
from bondgraph.passes.relation.moduli import vanishing_divisors
from bondgraph.text.diagnostic import CompileError
from bondgraph.text.source import Source


def compiled(body: str) -> Compilation:
    return Compilation(Source("test.bg", f"bg 1\nmodel M {{\n{body}\n}}\n"))


def code(body: str) -> str:
    with pytest.raises(CompileError) as caught:
        assert compiled(body).verification
    (error,) = [d for d in caught.value.diagnostics if d.severity == "error"]
    assert error.labels
    assert error.help
    return error.code


def test_a_parameter_that_only_a_wrong_tale_of_it_would_show() -> None:
    # R i + L i' = 0 by itself, so that G R i + L (G i)' = L G' i: zero as long as G is told as a
    # constant, whatever G is in the plant
    c = compiled(
        "param G = 1; param R = 2; param L = 3\n"
        "1:j { -> R:R; -> I:L; -> Df:i }\n"
        "0:other { <- Sf:Q; -> R:R2 = G; -> De:y }"
    )
    pool = c.graph.pool
    G, R, L = (next(v.symbol for v in c.graph.values if v.name == n) for n in "GRL")
    i = next(s.symbol for s in c.graph.sensors if s.name == "i")
    relation = pool.add((1, pool.mul(G, R, i)), (1, pool.mul(L, pool.der(pool.mul(G, i)))))
    (seen,) = Reactions(Plant(c.graph), 1).sensed([relation])
    assert seen == {R, L, i}


def test_a_parameter_that_cancels_only_while_it_is_constant() -> None:
    # q' = f; the current f through C and the gyrator: f1 = a f/R + b a f', e = a f1 + q/k = 0.
    # So a b a q'' + a a/R q' + q/k = 0, and f1 + 2 g f, a combination of q'' and q' with constant
    # coefficients, satisfies the same. With g(t) it does not: 2 (g q')'' and so on is left.
    c = compiled(
        "param a = 3; param g = 2; param k = 0.25; param R = 1.7; param b = 1\n"
        "0:open -> GY:g -> 1:j2 { <- C:x3 = k }\n"
        "1:j0 -> GY:a -> 1:j1; j2 -> j0; 0:j3 -> j1\n"
        "j3 { <- R:R; -> C:x5 = b }\n"
        "sensor y = j1.f + 2*open.e"
    )
    (r,) = c.residuals
    held = {s.symbol.name for s in symbols(_expr(c))}
    assert "g" not in held
    assert c.signatures.signature(r.name) == ("a", "g", "k", "R", "b", "y")
    assert c.verification.faults == 6


def _expr(c: Compilation) -> Expr:
    (residual,) = c._analysis[0].residuals
    return residual.expr


def test_sources_that_cancelling_bonds_constrain() -> None:
    # what flows out of the node flows back into it: Q = 0 is left
    ring = "0:node -> 1:ring -> node\nring { -> R:R1 = 2; -> Df:y }\n"
    assert code(ring + "Sf:Q -> node") == "sources-contradict"
    # the efforts of the ring cancel: U + w = 0, so that the unknown w is none
    ring = "0:node { <- 1:ring; -> ring; -> C:c = 1 }\ninput w unknown\n"
    ring += "ring { -> Df:i1; -> Df:i2 }\n"
    assert code(ring + "Se:U -> ring\n Se:w -> ring") == "sources-contradict"


def test_a_residual_that_never_has_a_value() -> None:
    # no current flows through R1, so that e = 0 and product/e never exists
    body = "0:node -> R:R1 { f = 2*(exp(e) - 1) }; 1:shaft -> I:J(p0 = 0) = 3\n"
    assert code(body + "sensor product = node.e*shaft.f") == "residual-undefined"
    c = compiled(body + "sensor product = node.e*shaft.f\nSf:I -> node")
    assert c.verification.residuals == len(c.residuals) == 1


def test_a_law_of_two_branches_keeps_both_in_its_closed_form() -> None:
    # f = y measured, so that 0 = U - k y on one side and U - m y on the other
    c = compiled(
        "param k = 2; param m = 3\n1:j { <- Se:U; -> R:valve { e = if(f < 0, k*f, m*f) }; -> Df:y }"
    )
    (r,) = c.residuals
    t, U, y = sp.Symbol("t", real=True), sp.Function("U", real=True), sp.Function("y", real=True)
    k, m = sp.symbols("k m", real=True)
    for speed, slope in ((-5, k), (5, m)):
        found = r.expr.subs({y(t): speed, U(t): 7})
        assert sp.simplify(found**2 - (7 - slope * speed) ** 2) == 0


def test_an_unknown_flux_that_the_speed_multiplies() -> None:
    # y = w p, p' = u: the start of p drops out of (y/w)' = u, that is w y' - w' y - w^2 u = 0
    pool = Pool()
    w, y, u = (pool.symbol(name, Kind.SENSOR) for name in "wyu")
    flux = pool.integral(u, pool.symbol("p.0", Kind.FREE))
    found = without_free_integrals(pool, pool.sub(y, pool.mul(w, flux)))
    assert found is not None
    by_hand = pool.sub(pool.mul(w, pool.der(y)), pool.mul(y, pool.der(w)))
    by_hand = pool.sub(by_hand, pool.mul(w, w, u))
    assert is_zero(pool.add((1, found.expr), (1, by_hand)))  # the factor of the flux is -w
    assert found.order == 1


INDUCTION = """
    param G = 5; param H = -4; param K = 6; param Rs = 1; param Rr = 0.8
    param J = 0.05; param n = 2
    input load unknown
    1:sa { <- Se:ua; -> R:Rsa = Rs; -> Df:ia; -> A.s }
    1:sb { <- Se:ub; -> R:Rsb = Rs; -> Df:ib; -> B.s }
    1:ra { -> R:Rra = Rr; -> A.r }
    1:rb { -> R:Rrb = Rr; -> B.r }
    I:A { port s; port r; s.f = G*s.p + H*r.p; r.f = H*s.p + K*r.p }
    I:B { port s; port r; s.f = G*s.p + H*r.p; r.f = H*s.p + K*r.p }
    1:rot { -> I:J; <- Se:shaft = load; -> Df:w }
    ra -> MGY:ga = n*B.r.p -> rot
    rb -> MGY:gb = -n*A.r.p -> rot
"""


def test_an_induction_machine_of_unknown_fluxes() -> None:
    # three sensors less one unknown torque, which hides all that is on the shaft alone
    c = compiled(INDUCTION)
    assert len(c.residuals) == 2
    assert c.verification.method.startswith("exact")
    unseen = [f for f in c.signatures.faults if not any(c.signatures.row(f))]
    assert unseen == ["J"]


def test_what_never_moves_from_zero_is_no_divisor() -> None:
    # no flow leaves `open`, so that the angle stays 0 and y = 0 tells nothing of the effort, which
    # is to be known for the ratio to be
    body = "0:open -> 1:still; still -> MGY:g = 3*cos(int(open.e)) -> 1:shaft\n"
    body += "shaft { -> I:J = 2; -> Df:w }\nsensor y = open.e*int(still.f)"
    assert code(body) == "residual-undefined"


def test_a_switch_is_not_differentiated() -> None:
    # on: U - R i - (q(0) + int i)/C = 0 with q(0) unknown, differentiated; off: i = 0, as it is
    body = "param R = 2; param C = 3; input U; input on : bool\n"
    body += "1:a { <- Se:u = U; -> R:R; -> C:C; -> Df:i; -> R:s { 0 = if(on, e, f) } }"
    c = compiled(body)
    (r,) = c.residuals
    t = sp.Symbol("t", real=True)
    on, U, i = (sp.Function(name, real=True)(t) for name in ("on", "U", "i"))
    R, C = sp.symbols("R C", real=True)
    closed = U.diff(t) - R * i.diff(t) - i / C
    assert sp.simplify(r.expr.subs(on, 1).doit() - closed) == 0
    assert sp.simplify(r.expr.subs(on, 0).doit() - i) == 0
    assert c.verification.method.startswith("exact")
    off, closed_ = [[any(row) for row in m.matrix.rows] for m in c.mode_signatures.modes]
    assert c.signatures.faults == ("R", "C", "U", "i")
    assert off == [False, False, False, True, True]  # the last one: on, while told off
    assert all(closed_)


def test_what_is_nothing_whatever_the_signals() -> None:
    graph = compiled("param a = 0; param b = 2; param c = 2; 1:j { <- Se:u; -> R:r = 1 }").graph
    pool, nominal = graph.pool, Nominal(graph)
    a, b, c = (v.symbol for v in graph.values)
    u = graph.inputs[0].symbol
    leak, balanced = pool.mul(a, u), pool.mul(u, pool.sub(b, c))
    assert nominal.vanishes(leak)
    assert nominal.vanishes(pool.add((1, leak), (2, pool.der(balanced))))
    assert not nominal.vanishes(pool.add((1, leak), (1, pool.mul(b, u))))
    assert not nominal.vanishes(pool.div(u, pool.add((1, a), (1, b))))


def test_two_equal_moments_of_inertia_are_no_divisor() -> None:
    # (J1 - J2) w1 w2 = J3 w3' + torque: with J1 = J2 the torque alone says what w3 does
    axes = "1:x { -> I:Jx; -> Df:wx; <- Se:tx }; 1:y { -> I:Jy; <- Se:ty }; 1:z { -> I:Jz; <- Se:tz"
    rings = "x -> MGY:c = Jz*z.f -> y; y -> MGY:a = Jx*x.f -> z; z -> MGY:b = Jy*y.f -> x"
    text = f"param Jx = 1; param Jy = 2; param Jz = 2\n{axes}; -> Df:wz }}\n{rings}"
    c = compiled(text)
    assert len(c.residuals) == 2
    assert c.verification.method.startswith("exact")
    nominal = Nominal(c.graph)
    assert not [d for r in c.residuals for d in vanishing_divisors(nominal, r.residual.expr)]


def test_a_product_with_a_factor_at_rest_is_one_relation_more() -> None:
    # nothing drives `still`: its flow is zero, so that the product is, though both are unknown
    c = compiled("1:still { -> R:a = 2 }; 0:n { -> R:b = 3; <- Sf:z = q }; input q unknown\n"
                 "sensor y = still.f*n.e")  # fmt: skip
    assert len(c.residuals) == 1
    assert c.verification.method.startswith("exact")
    assert not [d for d in c.report.diagnostics if d.code == "relations-missing"]
