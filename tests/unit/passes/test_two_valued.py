"""Hidden variables that enter squared or under an unknown sign, against relations by hand."""

from __future__ import annotations

import pytest
import sympy as sp

from bondgraph.views import Relation
from tests.unit.passes.relations import compiled, is_multiple, t

Q = sp.Rational


def D(x: sp.Expr, n: int = 1) -> sp.Expr:
    return sp.diff(x, t, n)


def only(text: str) -> Relation:
    """The relation of a model that has one, verified exactly."""
    c = compiled(text)
    assert c.verification.method.startswith("exact")
    (relation,) = c.residuals
    return relation


SERIES_MOTOR = """model M { param L=1; param R=2; param k=3; param J=4; param f=5
    1:a { <- Se:U; -> I:L; -> R:R; -> GY:g { e1 = k*a.f*f2; e2 = k*a.f*f1 } -> b }
    1:b { -> I:J; -> R:f; -> Df:w } }"""


def series_motor(L, R, k, J, f, U, w):
    """The torque k i^2 = J w' + f w is known, and U i = R i^2 + L (i^2)'/2 + k w i^2 is squared."""
    z = (J * D(w) + f * w) / k
    return U**2 * z - (R * z + L * D(z) / 2 + k * w * z) ** 2


def square(L, R, U, y):
    """U i = R y + L y'/2 with y = i^2."""
    return U**2 * y - (R * y + L * D(y) / 2) ** 2


def parabola(L, R, U, y):
    """i = -1/2 + r, r^2 = y + 1/4 =: d; U = R i + L i' and r' = d'/(2 r)."""
    d = y + Q(1, 4)
    return (U + R / 2) ** 2 * d - (R * d + L * D(d) / 2) ** 2


def arm(J, b, T, y):
    """y' = -s w with s^2 = 1 - y^2, so s^3 T = -(J (y'' s^2 + y y'^2) + b y' s^2)."""
    s2 = 1 - y**2
    return T**2 * s2**3 - (J * (D(y, 2) * s2 + y * D(y) ** 2) + b * D(y) * s2) ** 2


def spring(m, k, F, y):
    """S = k q^2 with q' = y, so S' = 2 k q y and S'^2 = 4 k S y^2, wherever q began."""
    force = F - m * D(y)
    return 4 * k * force * y**2 - D(force) ** 2


def swing(m, k, F, y):
    """S = k sin q, so S' = k y cos q and S'^2 = y^2 (k^2 - S^2)."""
    force = F - m * D(y)
    return y**2 * (k**2 - force**2) - D(force) ** 2


SPRING = """model M {{ param m=1; param k=2
    1:v {{ <- Se:F; -> I:m; -> C:s {{ e = k*{} }}; -> Df:y }} }}"""
COIL = """model M {{ param L=1; param R=2
    1:a {{ <- Se:U; -> I:L; -> R:R }}
    sensor y = {} }}"""
ARM = """model M {{ param J=1; param b=2
    1:a {{ <- Se:T; -> I:J; -> R:b }}
    let th = int(a.f)
    sensor y = {}(th) }}"""
COIL_NUMBERS = {"L": Q(3), "R": Q(5)}
ARM_NUMBERS = {"J": Q(3), "b": Q(5)}
HAND = {
    "a series motor by its speed alone": (
        SERIES_MOTOR, series_motor, {"L": 2, "R": 3, "k": 5, "J": 7, "f": 11}, ("U", "w"),
    ),
    "a force that is even in the path": (
        SPRING.format("q^2"), spring, {"m": 3, "k": 5}, ("F", "y"),
    ),
    "a swing whose angle at the start is unknown": (
        SPRING.format("sin(q)"), swing, {"m": 3, "k": 5}, ("F", "y"),
    ),
    "a current squared": (COIL.format("a.f^2"), square, COIL_NUMBERS, ("U", "y")),
    "a parabola": (COIL.format("a.f^2 + a.f"), parabola, COIL_NUMBERS, ("U", "y")),
    "a cosine": (ARM.format("cos"), arm, ARM_NUMBERS, ("T", "y")),
    # sin(th) = cos(pi/2 - th): the same with the angle counted the other way round
    "a sine": (ARM.format("sin"), arm, ARM_NUMBERS, ("T", "y")),
}  # fmt: skip


@pytest.mark.parametrize("name", HAND)
def test_by_hand(name: str) -> None:
    """Of least degree: with a factor in known signals alone it would be no constant multiple."""
    text, formula, numbers, signals = HAND[name]
    relation = only(text)
    assert is_multiple(relation, formula, {k: Q(v) for k, v in numbers.items()}, signals)


def test_a_second_sensor_makes_the_choice() -> None:
    """What is known by a sensor is not squared: the plain relations, as without the square."""
    c = compiled(COIL.format("a.f^2\n    sensor i = a.f"))
    assert [str(r.text) for r in c.residuals] == ["U - R*i - L*D(i)", "y - i^2"]


def test_two_squares_one_inside_the_other() -> None:
    """x^2 = y and (x + z)^2 = v, with x and z hidden: both choices drop out, for all four signs."""
    c = compiled(
        """model M { param R=2; param L=3
        1:a { <- Se:U; -> R:R; -> I:L }
        1:b { <- Se:V; -> R:r = R }
        sensor y = a.f^2
        sensor v = (b.f + a.f)^2 }"""
    )
    assert c.verification.method.startswith("exact")
    assert len(c.residuals) == 2
    assert not c.residuals.missing


def test_a_cube_beside_a_sine_is_still_refused() -> None:
    """Neither gives the variable up to a sign."""
    c = compiled(
        """model M { param L=1; param R=2
        1:a { <- Se:U; -> I:L; -> R:R }
        1:b { <- Se:V; -> R:q = 2; -> Df:w }
        sensor y = a.f^3 + sin(a.f) - 2*a.f }"""
    )
    assert [m.finding.code for m in c.residuals.missing] == ["loop-unsolvable"]


def test_what_the_missing_relation_would_rest_on_is_named() -> None:
    """exp(i) with i known up to its sign has no norm: the whole loop is told, not its last law."""
    c = compiled(
        """model M { param L=1
        1:a { <- Se:U; -> I:L; -> R:d { e = exp(f) - 1 } }
        1:b { <- Se:V; -> R:r = 2; -> Df:w }
        sensor y = a.f^2 }"""
    )
    (missing,) = c.residuals.missing
    assert {"d", "L"} <= set(missing.elements)
