"""Relations made free of a fault, against combinations made by hand."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
import sympy as sp

from bondgraph.cli.main import main
from bondgraph.compilation import Compilation
from bondgraph.compile_options import Options
from bondgraph.passes.elimination.decouple import free_of
from bondgraph.text.source import Source
from bondgraph.views import Relation
from tests.real.draw import of_seed
from tests.unit.passes.relations import is_multiple, t

Q = sp.Rational


def D(x: sp.Expr, n: int = 1) -> sp.Expr:
    return sp.diff(x, t, n)


def ssqrt(x: sp.Expr) -> sp.Expr:
    return sp.sign(x) * sp.sqrt(sp.Abs(x))


MOTOR = """model M { param L=1; param R=2; param k=3; param J=4; param f=5
    Se:U -> 1:a; a { -> I:L; -> R:R; -> Df:i; -> GY:k -> b }
    1:b { -> I:J; -> R:f; -> Df:w } }"""
MOTOR_NUMBERS = {"L": Q(2), "R": Q(3), "k": Q(5), "J": Q(7), "f": Q(11)}
TANKS = """model M { param A1=1; param k=2; param A2=3; param out=4
    Sf:Q -> 0:t; t { -> C:A1; -> De:h1; -> 1:pipe -> u }
    pipe { -> R:v { f = k*ssqrt(e) } }
    0:u { -> C:A2; -> R:o { f = out*ssqrt(e) }; -> De:h2 } }"""
GEAR = """model M { param N=3; param J=2; param b=1
    Se:T -> 1:m; m { -> I:J; -> Df:w1; -> TF:N { f1 = N*f2 } -> l }
    1:l { -> R:b; -> Df:w2 } }"""
CHAIN = """model M { param R1=1; param C1=2; param R2=3; param C2=4; param R3=5; param C3=6
    Se:U -> 1:a; a { -> R:R1; -> n1 }
    0:n1 { -> C:C1; -> De:v1; -> 1:b -> n2 }
    b -> R:R2
    0:n2 { -> C:C2; -> De:v2; -> 1:c -> n3 }
    c -> R:R3
    0:n3 { -> C:C3; -> De:v3 } }"""
CHAIN_NUMBERS = {
    n: Q(k) for n, k in zip(("R1", "C1", "R2", "C2", "R3", "C3"), range(2, 8), strict=True)
}
CART = """model M { param m=2; param c=3; param K=4
    Se:F -> 1:v; v { -> I:m; -> R:c; -> Df:s; -> 0:x }
    x { -> C:sp = 1/K; -> De:y; -> w }
    1:w { -> I:m2 = m; -> Df:z } }"""
OVEN = """model M { param G=2; param Ch=3; param Co=4; param Ga=5; input Ta
    input on : bool
    0:h { <- Sf:P = if(on, 100, 0); -> C:Ch; -> De:Th; -> 1:g -> o }
    g -> R:w { f = G*e }
    0:o { -> C:Co; -> De:To; -> 1:a }
    a { -> R:x { f = Ga*e }; -> Se:air = Ta } }"""


def of(text: str, fault: str) -> tuple[Compilation, list[Relation]]:
    """The compilation, verified exactly, and its relations that are free of the fault."""
    c = Compilation(Source("model.bg", "bg 1\n" + text), options=Options(decouple=(fault,)))
    assert c.verification.method.startswith("exact")
    return c, [r for r in c.residuals if r.residual.free_of == fault]


def motor_k(L, R, k, J, f, U, i, w):
    return w * (f * w + J * D(w)) - i * (U - R * i - L * D(i))


def motor_i(L, R, k, J, f, U, w):
    i = (J * D(w) + f * w) / k
    return U - R * i - L * D(i) - k * w


def motor_w(L, R, k, J, f, U, i):
    w = (U - R * i - L * D(i)) / k
    return k * i - J * D(w) - f * w


def tanks_k(A1, A2, out, Q, h1, h2, k):
    return Q - A1 * D(h1) - A2 * D(h2) - out * ssqrt(h2)


def tanks_h1(A1, A2, out, k, Q, h2):
    flow = (A2 * D(h2) + out * ssqrt(h2)) / k
    h1 = h2 + flow * sp.Abs(flow)
    return Q - A1 * D(h1) - k * flow


def gear_n(N, J, b, T, w1, w2):
    """Power: T w1 = J w1' w1 + b w2^2."""
    return (T - J * D(w1)) * w1 - b * w2**2


def gear_w1(N, J, b, T, w2):
    w1 = N * w2
    return T - J * D(w1) - b * w2 / N


def oven_g(G, Ch, Co, Ga, Ta, on, Th, To):
    return 100 * on - Ch * D(Th) - Co * D(To) - Ga * (To - Ta)


HAND = {
    "machine constant": (MOTOR, "k", motor_k, MOTOR_NUMBERS, ("U", "i", "w")),
    "current gauge": (MOTOR, "i", motor_i, MOTOR_NUMBERS, ("U", "w")),
    "speed gauge": (MOTOR, "w", motor_w, MOTOR_NUMBERS, ("U", "i")),
    "pipe": (TANKS, "k", tanks_k, {"A1": 2, "k": 3, "A2": 5, "out": 7}, ("Q", "h1", "h2")),
    "level gauge": (TANKS, "h1", tanks_h1, {"A1": 2, "k": 3, "A2": 5, "out": 7}, ("Q", "h2")),
    "ratio": (GEAR, "N", gear_n, {"N": 2, "J": 3, "b": 5}, ("T", "w1", "w2")),
    "tachometer": (GEAR, "w1", gear_w1, {"N": 2, "J": 3, "b": 5}, ("T", "w2")),
}


@pytest.mark.parametrize("name", HAND)
def test_by_hand(name: str) -> None:
    text, fault, formula, numbers, signals = HAND[name]
    c, (relation,) = of(text, fault)
    assert is_multiple(relation, formula, {k: Q(v) for k, v in numbers.items()}, signals)
    assert fault not in relation.faults
    others = set(c.signatures.faults) - {fault}
    assert set(relation.faults) == others  # what is left in the formulas above


def test_a_factor_that_both_relations_have_is_divided_out() -> None:
    """p = k x z and q = k x w leave p w = q z, in which x is no more needed."""
    text = """model M { param k = 2; param A = 3; param B = 4; param C = 5
        1:a { <- Se:ua; -> I:A; -> Df:x }
        1:b { <- Se:ub; -> I:B; -> Df:z }
        1:c { <- Se:uc; -> I:C; -> Df:w }
        sensor p = k*a.f*b.f
        sensor q = k*a.f*c.f }"""
    _, (relation,) = of(text, "k")
    assert set(relation.faults) == {"p", "q", "z", "w"}

    def by_hand(z, w, p, q):
        return p * w - q * z

    assert is_multiple(relation, by_hand, {}, ("z", "w", "p", "q"))


def test_a_signal_in_three_relations() -> None:
    """The middle voltage of a chain: two combinations, by the current balances of its nodes."""
    _, found = of(CHAIN, "v2")
    assert len(found) == 2
    assert all("v2" not in r.faults and "v2" not in r.orders for r in found)

    def v2(R1, C1, R2, C2, R3, C3, U, v1, v3):
        return v3 + R3 * C3 * D(v3)

    def first(U, v1, v3, **n):
        middle = v2(U=U, v1=v1, v3=v3, **n)
        return (U - v1) / n["R1"] - n["C1"] * D(v1) - (v1 - middle) / n["R2"]

    def second(U, v1, v3, **n):
        middle = v2(U=U, v1=v1, v3=v3, **n)
        return (v1 - middle) / n["R2"] - n["C2"] * D(middle) - n["C3"] * D(v3)

    signals = ("U", "v1", "v3")
    for formula in (first, second):
        assert any(is_multiple(r, formula, CHAIN_NUMBERS, signals) for r in found) or any(
            is_multiple(r, lambda U, v1, v3, **n: first(U, v1, v3, **n) + second(U, v1, v3, **n),
                        CHAIN_NUMBERS, signals)
            for r in found
        )  # fmt: skip


def test_a_mass_that_is_used_twice() -> None:
    """m in two momenta, (m s)' = a and (m z)' = y, a = F - c s - y; m may change meanwhile.

    The first times z less the second times s holds m alone: m (z s' - s z') = z a - s y. With that
    m the second momentum still has to grow with y. Times the square of the bracket all that is a
    multiple of z, which no relation needs to be.
    """
    _, (relation,) = of(CART, "m")

    def by_hand(m, c, K, F, s, y, z):
        a = F - c * s - y
        below = z * D(s) - s * D(z)
        mass = (z * a - s * y) / below
        return below**2 * (D(mass * z) - y) / z

    assert is_multiple(relation, by_hand, {"m": Q(2), "c": Q(3), "K": Q(5)}, ("F", "s", "y", "z"))


def test_a_speed_that_divides() -> None:
    """The plane motion of a car: forces Cf((v + a r)/u - delta) and Cr (v - b r)/u at its axles.

    With the side speed v from ay = v' + u r the balances of force and moment are, times u,
    (ay - v') A = r ((Cf + Cr) v + E r) and (ay - v') B = r (E v + G r), and give v.
    """
    text = """model M { param m=1.2; param Jz=0.9; param a=0.8; param b=1.1; param Cf=2.3
        param Cr=2.7; input delta; input u
        1:side { -> I:m; <- Se:turn = -m*u*yaw.f; -> front; -> rear }
        1:yaw { -> I:Jz; -> TF:fa { f2 = a*f1 } -> front; -> TF:ra { f2 = -b*f1 } -> rear; -> Df:r }
        0:front { -> R:tf { e = Cf*(f/u - delta) } }
        0:rear { -> R:tr { e = Cr*f/u } }
        sensor ay = der(side.f) + u*yaw.f }"""
    _, (relation,) = of(text, "u")
    numbers = {"m": Q(2), "Jz": Q(3), "a": Q(5), "b": Q(7), "Cf": Q(11), "Cr": Q(13)}

    def by_hand(m, Jz, a, b, Cf, Cr, delta, r, ay):
        A, B = Cf * delta - m * ay, a * Cf * delta - Jz * D(r)
        both, E, G = Cf + Cr, a * Cf - b * Cr, a**2 * Cf + b**2 * Cr
        below = B * both - A * E
        v = r * (A * G - B * E) / below
        # of the factors of known signals those stay that m would need if it moved
        return (r * below) ** 3 * ((ay - D(v)) * A - r * (both * v + E * r))

    assert is_multiple(relation, by_hand, numbers, ("delta", "r", "ay"))


def test_with_a_mode() -> None:
    """The wall of an oven: heat balance of both sides together, whether the heater is on or not."""
    c, (relation,) = of(OVEN, "G")
    assert set(relation.faults) == {"Ch", "Co", "Ga", "Ta", "Th", "To"}
    for mode in c.mode_signatures.modes:
        assert mode.matrix is not None
        assert set(mode.matrix.signature(relation.name)) == {*relation.faults, *mode.modes}


def test_it_helps_to_isolate() -> None:
    """k and the gauges of the motor share both residuals; free of one, the others stand apart."""
    alone = Compilation(Source("model.bg", "bg 1\n" + MOTOR))
    assert ("k", "i", "w") in alone.signatures.groups
    c = Compilation(Source("model.bg", "bg 1\n" + MOTOR), options=Options(decouple=("k", "i", "w")))
    assert {("k",), ("i",), ("w",)} <= set(c.signatures.groups)
    assert c.maximum_isolability is not None and alone.maximum_isolability is not None
    assert set(c.maximum_isolability) == set(alone.maximum_isolability)


@pytest.mark.parametrize(
    ("text", "fault", "why"),
    [
        (MOTOR, "R", "only r1 sees it"),
        (MOTOR.replace("Df:w }", "Df:w; -> Se:z = 0*idle }; param idle=1"), "idle", "no relation"),
    ],
)
def test_where_there_is_nothing_to_combine(text: str, fault: str, why: str) -> None:
    c, found = of(text, fault)
    assert found == []
    (told,) = [d for d in c.report.diagnostics if d.code == "not-decoupled"]
    assert why in told.message and told.severity == "info"


def test_the_command(tmp_path: object, capsys: pytest.CaptureFixture[str]) -> None:
    """New relations are in the report, in the JSON and in the code like the others."""
    path = f"{tmp_path}/motor.bg"
    with open(path, "w") as file:
        file.write("bg 1\n" + MOTOR)
    out = ["-o", f"{tmp_path}/out"]
    assert main(["compile", path, "--decouple", "k", "--json", *out]) == 0
    result = json.loads(capsys.readouterr().out)
    assert [a.get("free_of") for a in result["arrs"]] == [None, None, "k"]
    assert result["n_arr"] == 3
    with open(f"{tmp_path}/out/m.h") as file:
        assert "r3" in file.read()
    assert main(["compile", path, "--decouple", "k", *out]) == 0
    assert "free of k" in capsys.readouterr().out
    assert main(["compile", path, "--decouple", "kk", *out]) == 2
    assert "did you mean `k`?" in capsys.readouterr().err


def test_through_the_flow_that_a_fault_changes() -> None:
    """A2 enters only by the flow into tank 2, inside the law of the pipe behind it as well."""
    _, (relation,) = of(
        """model M { param A1=1; param l3=0; param k12=1; param A2=2; param k23=3; param A3=4
        param ko=5
        0:t1 { <- Sf:Q; -> C:A1; -> De:p1 }
        0:t2 { -> C:A2; -> De:p2 }
        0:t3 { -> C:A3; -> R:o { f = ko*ssqrt(e) }; -> R:l3 { f = l3*ssqrt(e) }; -> De:p3 }
        t1 -> 1:v12 -> t2 -> 1:v23 -> t3
        v12 -> R:r12 { f = k12*ssqrt(e) }
        v23 -> R:r23 { 0 = e - k23*f*abs(f) } }""",
        "A2",
    )

    def by_hand(A1, l3, k12, k23, A3, ko, p2, p3):
        flow = A3 * D(p3) + (ko + l3) * ssqrt(p3)
        return p2 - p3 - k23 * flow * sp.Abs(flow)

    numbers = {"A1": Q(11), "l3": Q(13), "k12": Q(2), "k23": Q(3), "A3": Q(5), "ko": Q(7)}
    assert is_multiple(relation, by_hand, numbers, ("p2", "p3"))
    assert set(relation.faults) == {"k23", "A3", "ko", "l3", "p2", "p3"}


def test_a_gain_before_a_limit() -> None:
    """K acts through a limited command alone; what the command is, its sensor says."""
    _, (relation,) = of(
        """model M { param m=2; param b=3; param K=4; input u
        let s = min(max(K*(u - w), -2), 2)
        1:v { -> I:m; -> R:b; -> Df:w; <- Se:drive = s }
        sensor z = s }""",
        "K",
    )

    def by_hand(m, b, drive, w, z):
        return z + drive - m * D(w) - b * w

    assert is_multiple(relation, by_hand, {"m": Q(2), "b": Q(3), "drive": Q(1, 5)}, ("w", "z"))
    assert set(relation.faults) == {"m", "b", "drive", "w", "z"}


def test_a_level_that_moves_an_outflow_and_a_content_in_the_same_two_relations() -> None:
    """A pump's flow is split by s: what tank 2 takes is (1 - s) F, whatever the level of tank 1."""
    _, (relation,) = of(
        """model M { input pump unknown; param s=0.4; param A1=1; param A2=1.5; param k1=0.7
        param k2=0.6
        0:t1 { <- Sf:p1 = s*pump; -> C:A1; -> R:k1 { f = k1*ssqrt(e) }; -> De:h1 }
        0:t2 { <- Sf:p2 = (1 - s)*pump; -> C:A2; -> R:k2 { f = k2*ssqrt(e) }; -> De:h2 }
        sensor F = p1.f + p2.f }""",
        "h1",
    )

    def by_hand(s, A2, k2, F, h2):
        return A2 * D(h2) + k2 * ssqrt(h2) - (1 - s) * F

    numbers = {"s": Q(2, 5), "A2": Q(5), "k2": Q(11)}
    assert is_multiple(relation, by_hand, numbers, ("F", "h2"))
    assert set(relation.faults) == {"s", "A2", "k2", "F", "h2"}


def test_a_loop_that_divides_by_what_is_constant() -> None:
    """Without p0 a row of a loop divides by the derivative of a constant: no traceback."""
    text = (Path(__file__).parents[2] / "random" / "once" / "cancelled_divisor.bg").read_text()
    c = Compilation(Source("model.bg", text))
    seen = [r for r in c.residuals.residual_set.residuals if "p0" in c.signatures.signature(r.name)]
    assert len(free_of("p0", seen, c.residuals.residual_set)) <= len(seen)


@pytest.mark.parametrize("seed", [3, 13, 31, 39, 47, 58])
def test_what_is_free_of_a_fault_does_not_react_to_it(seed: int) -> None:
    """Random plants, with controllers on readings: the oracle, which eliminates nothing, judges."""
    plain = Compilation(Source("model.bg", of_seed(seed).text))
    faults = tuple(group[0] for group in plain.signatures.groups)
    c = plain.with_options(decouple=faults)
    assert not [r.name for r in c.residuals if r.residual.free_of in r.faults]
    assert len(c.residuals) > len(plain.residuals)
