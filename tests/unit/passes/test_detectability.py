"""Strong and weak detectability against what each relation, written by hand, says at rest."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import pytest

from bondgraph.compilation import Compilation
from bondgraph.ir.expr import Kind, Pool
from bondgraph.passes.analysis.detectability import _Wrong
from bondgraph.text.source import Source
from tests.unit.passes.relations import compiled

#: Model; for each fault the residuals' verdicts joined: "strong", "weak" or "unknown".
CASES: dict[str, tuple[str, set[str], set[str]]] = {
    # U - R i - L i' - k w = 0 and k i - J w' - f w = 0; derivatives vanish in steady operation
    "motor": (
        """model M { param L=1; param R=2; param k=3; param J=4; param f=5
        Se:U -> 1:a; a { -> I:L; -> R:R; -> Df:i; -> GY:k -> b }
        1:b { -> I:J; -> R:f; -> Df:w } }""",
        {"R", "k", "f", "U", "i", "w"},
        {"L", "J"},
    ),
    # v1 - v2 - C F' = 0: at rest F' = 0 whatever the error of F, so it and C are lost
    "differentiated": (
        """model M { param C=2
        Sf:v1 -> 0:x; x { -> De:F; -> C:C; -> b }
        1:b { -> Df:v2; -> Sf:v3 } }""",
        {"v1", "v2", "v3"},
        {"C", "F"},
    ),
    # with a damper behind it there is F = r v2 as well, an equation of constants
    "damper": (
        """model M { param C=2; param r=7
        Sf:v1 -> 0:x; x { -> De:F; -> C:C; -> b }
        1:b { -> Df:v2; -> R:r } }""",
        {"v1", "v2", "r", "F"},
        {"C"},
    ),
    # Q - c y' - k u y = 0: an input that opens a valve is constant too, and dr/dk = -u y is not 0
    "valve": (
        """model M { param c=2; param k=3
        input u
        0:t { <- Sf:Q; -> C:c; -> R:k { f = k*u*e }; -> De:y } }""",
        {"k", "Q", "u", "y"},
        {"c"},
    ),
    # h' A = Q - q, q = k sqrt(h): the area only while the level moves
    "tank": (
        """model M { param A=2; param k=3
        Sf:Q -> 0:t; t { -> C:A; -> De:h; -> R:out { f = k*ssqrt(e) } } }""",
        {"k", "Q", "h"},
        {"A"},
    ),
    # s = x'/g: a constant error of the position is gone, its scale is wrong as long as it moves
    "position": (
        """model M { param m=2; param g=1
        Se:F -> 1:v; v { -> I:m; -> Df:s; -> R:b = 3 }
        sensor x = int(v.f, 4)*g }""",
        {"g", "s", "F"},
        {"m", "x"},
    ),
    # s = (F - b s - m s')'/K: all but the sensor of speed act through derivatives
    "spring": (
        """model M { param m=2; param K=5; param b=3
        Se:F -> 1:v; v { -> I:m; -> Df:s; -> R:b; -> C:c(q0 = 0) = 1/K } }""",
        {"s"},
        {"m", "b", "K", "F"},
    ),
    # with the force y in the spring measured: F = b s + m s' + y, s = y'/K; it cannot move and
    # keep its force, so that s = 0 and the damping b does not count either
    "spring and gauge": (
        """model M { param m=2; param K=5; param b=3
        Se:F -> 1:v; v { -> I:m; -> Df:s; -> R:b; -> 0:x -> C:c = 1/K; x -> De:y; } }""",
        {"s", "F", "y"},
        {"m", "K", "b"},
    ),
    # y + m s' - m g = 0, s = y'/K: the weight counts at rest, the stiffness does not
    "weight": (
        """model M { param m=2; const g=9.81; param K=3
        1:v { <- Se:W = m*g; -> I:m; -> C:c(q0 = 0) = 1/K; -> Df:s }
        sensor load = c.e }""",
        {"m", "load", "s"},
        {"K"},
    ),
    # a closed angle without friction: w = T = 0 in steady operation, the sine of a resting angle
    "pendulum": (
        """model M { param J=2; param mgl=3; param d=4
        Se:T -> 1:w; w { -> I:J; -> Df:s; -> R:d; -> Se:G = mgl*sin(int(w.f)) } }""",
        {"T", "mgl", "s"},
        {"J", "d"},
    ),
    # a rod that swings has no steady motion: at rest only its weight counts, T = m g l sin(angle);
    # the wheel beside it has one, F = b s
    "rod": (
        """model M { param m=2; param l=3; const g=9.81
        let a = int(w.f, 1/2)
        1:w { <- Se:T; -> Df:y }
        1:x { -> I:mx = m }
        1:z { -> I:mz = m; <- Se:G = -m*g }
        w -> MTF:tx { f2 = l*cos(a)*f1 } -> x
        w -> MTF:tz { f2 = l*sin(a)*f1 } -> z
        1:c { <- Se:F; -> I:J; -> R:b; -> Df:s }
        param J = 4; param b = 5 }""",
        {"m", "l", "T", "y", "F", "b", "s"},
        {"J"},
    ),
    # turning, the torque k i sin(angle) changes; held where it is, the current goes on: U - R i,
    # T = k i sin(angle), and neither inertia nor friction counts
    "held motor": (
        """model M { param R=1; param L=2; param k=3; param J=4; param d=5
        let a = int(w.f, 1/2)
        Se:U -> 1:c; c { -> I:L; -> R:R; -> Df:i; -> MGY:g { e1 = k*sin(a)*f2 } -> w }
        1:w { <- Se:T; -> I:J; -> R:d; -> Df:s } }""",
        {"R", "U", "i", "k", "T", "s"},
        {"L", "J", "d"},
    ),
    # off, the residual is i itself; on, U - R i - L i'
    "switch": (
        """model M { param R=1; param L=2
        input on : bool
        Se:U -> 1:a; a { -> I:L; -> R:R; -> R:s { 0 = if(on, e, f) }; -> Df:i } }""",
        {"R", "U", "i"},
        {"L"},
    ),
}


@pytest.mark.parametrize("name", CASES)
def test_by_hand(name: str) -> None:
    text, strong, weak = CASES[name]
    c = compiled(text)
    found = c.detectability
    assert set(found.only_weak) == weak
    told = {f for r in found.residuals for f in c.signatures.signature(r)}
    lasting = {
        f
        for r in found.residuals
        for f in c.signatures.signature(r)
        if f not in (found.weak(r) or ())
    }
    assert lasting == strong
    assert told == strong | weak


def test_a_machine_that_cannot_stand_still() -> None:
    """A source that is a growing integral allows no steady operation: the answer is open."""
    c = compiled(
        """model M { param R=1; param C=2; param a=3
        1:x { <- Se:U = a*int(int(1)); -> R:R; -> C:C; -> Df:i } }"""
    )
    (r,) = c.detectability.residuals
    assert c.detectability.weak(r) is None
    assert c.detectability.only_weak == ()


def test_a_machine_that_can_stand_but_has_no_value_in_motion_gets_an_answer() -> None:
    # f = k1 e^1.5 needs e > 0 and so n2.e < 0, where the logarithm that y3 reads has no value
    c = Compilation(
        Source(
            "test.bg",
            "bg 1\nmodel M { param k1 = 3; param k2 = 1.5; param k3 = 0.5\n  input u1\n  1:n1\n"
            "  n1 -> R:r1 { f = k1*e^1.5 }\n  0:n2\n  n2 -> C:c1(q0 = 0) { e = k2*sin(q) }\n"
            "  n2 -> R:r2 { e = k3*f }\n  n1 -> n2\n  n2 <- Sf:pump1 = u1\n  n1 -> Df:y1\n"
            "  n2 -> De:y2\n  sensor y3 = log(n2.e/n1.f)\n}\n",
        )
    )
    assert set(c.signatures.unconfirmed) == {"r1", "r2", "r3"}
    assert c.detectability.residuals == ("r1", "r2", "r3")


def test_a_constant_error_is_a_share_of_what_is_there_and_a_quarter_of_it_each_turn() -> None:
    """Where nothing is there it is what is drawn; nothing else is told wrong, nor any rate."""
    pool = Pool()
    y, z, rest = (pool.symbol(name, Kind.SENSOR) for name in ("y", "z", "rest"))
    begun, other = (pool.symbol(name, Kind.INITIAL).symbol for name in ("q0", "p0"))
    numbers = SimpleNamespace(any=lambda draw: 0.5, nonzero=bool, inverse=lambda x: 1.0 / x)
    values = {y: [8.0, 3.0], z: [5.0, 1.0], rest: [0.0, 2.0]}
    point: Any = SimpleNamespace(
        algebra=SimpleNamespace(numbers=numbers), value=values.__getitem__, start=lambda _: 7.0
    )
    for turn, share in ((0, 1.0), (1, 0.25), (3, 1.0 / 64.0)):
        wrong = _Wrong(point, y, turn, {begun})
        assert wrong.value(y) == [8.0 + 4.0 * share, 3.0] and wrong.value(z) == [5.0, 1.0]
        assert _Wrong(point, rest, turn, ()).value(rest) == [0.5 * share, 2.0]
        assert wrong.start(begun) == 7.5 and wrong.start(other) == 7.0
