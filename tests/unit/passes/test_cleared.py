"""Denominators that may be zero: SymPy's quotient rule, and duty cycles and bodies by hand."""

from __future__ import annotations

import pytest
import sympy as sp

from bondgraph.algebra.cleared import cleared
from bondgraph.algebra.symbolic import to_sympy
from bondgraph.ir.expr import Expr, Kind, Op, Pool, topological
from bondgraph.ir.nodes import constant
from tests.unit.passes.relations import compiled, is_multiple, t

Q = sp.Rational
POOL = Pool()
U, y, a, b = (POOL.symbol(n, Kind.INPUT) for n in ("U", "y", "a", "b"))


def D(x, n=1):
    return sp.diff(x, t, n)


@pytest.mark.parametrize(
    ("expr", "power_a", "power_b"),
    [
        (POOL.div(U, a), 1, 0),
        (POOL.sub(POOL.div(U, a), POOL.div(y, POOL.mul(a, a, b))), 2, 1),
        (POOL.der(POOL.div(U, POOL.mul(a, b))), 2, 2),
        (POOL.der(POOL.der(POOL.div(U, a))), 3, 0),
        (POOL.der(POOL.mul(a, POOL.der(POOL.div(U, a)))), 2, 0),
        (POOL.power(POOL.add((1, U), (-2, POOL.div(y, a))), 3), 3, 0),
        (POOL.mul(b, POOL.add((1, U), (-2, POOL.div(y, b)))), 0, 0),
        (POOL.div(U, POOL.add((1, y), (1, POOL.div(y, a)))), None, None),
    ],
)
def test_numerator_is_the_relation_times_its_denominators(
    expr: Expr, power_a: int | None, power_b: int | None
) -> None:
    whole = to_sympy(cleared(POOL, expr, [a, b]))
    ratio = sp.simplify((whole / to_sympy(expr)).doit())
    if power_a is None:  # a quotient of quotients: 1/(y + y/a) = a/(a y + y)
        assert sp.simplify(ratio) == 1
        return
    named = {f.func.__name__: f for f in ratio.atoms(sp.core.function.AppliedUndef)}
    want = named.get("a", sp.Integer(1)) ** power_a * named.get("b", sp.Integer(1)) ** power_b
    assert sp.simplify(ratio - want) == 0


@pytest.mark.parametrize("power", [1, 2])
def test_what_is_divided_by_may_be_a_fraction_itself(power: int) -> None:
    base = POOL.sub(y, POOL.div(U, b))
    expr = POOL.div(U, base) if power == 1 else POOL.der(POOL.div(U, base))
    whole = to_sympy(cleared(POOL, expr, [base, b]))
    below = to_sympy(POOL.sub(POOL.mul(y, b), U))
    assert sp.simplify((whole - to_sympy(expr) * below**power).doit()) == 0


def test_inside_a_function_a_quotient_stays() -> None:
    inside = POOL.fn("exp", POOL.div(U, a))
    assert cleared(POOL, POOL.sub(inside, y), [a]) is POOL.sub(inside, y)


BOOST = """model B {
    param L = 1; param C = 0.8; param R = 1.3
    input U; input a
    Se:U -> 1:coil -> MTF:sw { e1 = (1 - a)*e2 } -> 0:out
    coil -> I:L
    out { -> C:C; -> R:R; -> De:u }
}"""


def divisors(expr: Expr) -> list[Expr]:
    """What an expression divides by."""
    nodes = [n for n in topological([expr]) if n.op is Op.MUL]
    return [x for n in nodes for x, e in zip(n.args, n.exponents, strict=True) if e < 0]


def test_boost_converter_by_its_duty_cycle() -> None:
    """U - m u = L i' and m i = u/R + C u' =: w give, with i = w/m, m^2 U - m^3 u = L (m w' - m' w).

    With the switch always closed (a = 1) the coil is alone and the relation is 0 = 0.
    """
    (relation,) = compiled(BOOST).residuals

    def by_hand(L, C, R, U, a, u):
        m, w = 1 - a, u / R + C * D(u)
        return m**2 * U - m**3 * u - L * (m * D(w) - D(m) * w)

    params = {"L": Q(1), "C": Q(4, 5), "R": Q(13, 10)}
    assert is_multiple(relation, by_hand, params, ("U", "a", "u"))
    below = divisors(relation.residual.expr)
    assert {d.symbol.name for d in below if d.op is Op.SYM} == {"R"} == {str(d) for d in below}


def test_speed_of_a_body_is_not_divided_by() -> None:
    """Euler's equations without a sensor of wz = (T - Jx wx' - c wx)/((Jz - Jy) wy)."""
    c = compiled(
        """model M {
        param Jx = 1; param Jy = 1.6; param Jz = 2.1; param c = 0.3
        input Tx
        1:x { <- Se:Tx; -> I:Jx; -> R:c }
        1:y { -> I:Jy }
        1:z { -> I:Jz }
        x -> MGY:gz { e1 = Jz*z.f*f2 } -> y
        y -> MGY:gx { e1 = Jx*x.f*f2 } -> z
        z -> MGY:gy { e1 = Jy*y.f*f2 } -> x
        x -> Df:wx; y -> Df:wy
        }"""
    )

    def by_hand(Jx, Jy, Jz, c, Tx, wx, wy):
        wz_times = Tx - Jx * D(wx) - c * wx  # (Jz - Jy) wy wz
        return Jy * D(wy) * (Jz - Jy) * wy - (Jz - Jx) * wx * wz_times

    params = {"Jx": Q(1), "Jy": Q(8, 5), "Jz": Q(21, 10), "c": Q(3, 10)}
    assert is_multiple(c.residuals[0], by_hand, params, ("Tx", "wx", "wy"))
    assert not any(divisors(r.residual.expr) for r in c.residuals)


def test_force_of_a_chamber_is_its_pressure_times_its_area() -> None:
    """Of p = n/(V + A x) both storages are unknown at first: n and V cancel in the force A p."""
    c = compiled(
        """model M {
        param A = 2; param V = 3; param m = 5; param b = 0.5
        Sf:u -> 0:gas { -> ch.gas; -> De:p }
        C:ch { port gas; port x
            gas.e = gas.q/(V + A*x.q)
            x.e = -A*gas.q/(V + A*x.q) }
        1:rod { -> I:m; -> R:b; -> Df:v; -> ch.x }
        }"""
    )

    def by_hand(A, m, b, p, v):
        return A * p - b * v - m * D(v)

    relation = next(r for r in c.residuals if "V" not in r.faults)
    params = {"A": Q(2), "m": Q(5), "b": Q(1, 2)}
    assert is_multiple(relation, by_hand, params, ("p", "v"))
    assert divisors(relation.residual.expr) == []


def test_a_saturated_machine_is_not_divided_by_its_currents() -> None:
    """Of a synchronous motor the flux is between two gyrators; its currents pass through zero."""
    system = compiled("""model P {
        param Rs = 0.5; param Ld = 0.1; param Lq = 0.2; param sat = 3; param psi = 0.1; param pp = 4
        param J = 2; param B = 0.1
        input ud; input uq; input Tl
        Se:ud -> 1:d { -> R:Rd = Rs; -> fl.d; -> Df:id }
        Se:uq -> 1:q { -> R:Rq = Rs; -> fl.q; -> Df:iq }
        I:fl {
            port d
            port q
            d.f = d.p/Ld*(1 + sat*(d.p^2 + q.p^2))
            q.f = q.p/Lq + sat*q.p*(d.p^2 + q.p^2)/Ld
        }
        1:rot { -> I:J; -> R:B; -> Se:Tl; -> Df:w }
        q -> MGY:gq { e1 = pp*(fl.d.p + psi)*f2 } -> rot
        rot -> MGY:gd { e2 = pp*fl.q.p*f1 } -> d
    }""")
    residuals = system.residuals.residual_set.residuals
    assert len(residuals) == 3
    for residual in residuals:
        below = divisors(residual.expr)
        assert below and all(constant(base) for base in below)
