"""Steady operation: what stays, what may grow, and what stands, with equations by hand."""

from __future__ import annotations

import pytest

from bondgraph.exact.plant import Plant
from bondgraph.exact.steady_operation import held, rest, steady
from bondgraph.exact.taylor import Solver
from bondgraph.exact.trajectory import Trajectory
from bondgraph.field.series import Series
from bondgraph.ir.expr import Expr
from tests.unit.exact.models import graph, symbols

#: A motor that turns a spring or a free load; `a` reads the angle, `g` what it has swept.
_TURNS = """
model M {{
    param L = 3; param Re = 2; param k = 5; param J = 7; param b = 4
    let phi = int(rotor.f)
    let swept = int(phi)
    Se:U -> 1:el
    el {{ -> I:L; -> R:Re; -> Df:i; -> GY:k -> 1:rotor }}
    rotor {{ -> I:J; -> R:b; {load} -> Df:w }}
    sensor a = phi
    sensor g = swept
}}
"""


def _at(text: str, solver: Solver, seed: int = 1) -> tuple[Trajectory, dict[str, Expr]]:
    model = graph(text)
    return Plant(model).trajectory(seed, 3, solver=solver), symbols(model)


def _told(text: str, solver: Solver, *names: str, seed: int = 1) -> list[Series]:
    t, s = _at(text, solver, seed)
    return [t.value(s[name]) for name in names]


@pytest.mark.parametrize("seed", [1, 2, 3])
def test_a_motor_in_steady_motion_turns_on_and_on(seed: int) -> None:
    """5 i = 4 w and U = 2 i + 5 w; the angle grows with w, and what it sweeps with the angle."""
    U, i, w, a, g = _told(_TURNS.format(load=""), steady, "U", "i", "w", "a", "g", seed=seed)
    assert (len(U), len(i), len(w)) == (1, 1, 1)
    assert 5 * i[0] == 4 * w[0] and U[0] == 2 * i[0] + 5 * w[0] and w[0] != 0
    assert a[1:] == w and g[1] == a[0] and 2 * g[2] == w[0] and len(g) == 3


@pytest.mark.parametrize("seed", [1, 2, 3])
def test_a_motor_that_is_held_has_a_current_and_no_motion(seed: int) -> None:
    """Against a spring of 1/6 at an angle q: 5 i = 6 q, U = 2 i, and no angle grows."""
    text = _TURNS.format(load="-> C:spring = 1/6;")
    t, s = _at(text, held, seed)
    U, i, w, a = (t.value(s[name]) for name in ("U", "i", "w", "a"))
    twist = next(n for n in t.part.place if n.symbol.name == "spring.q")
    assert w == [0] and i[0] != 0 and [2 * i[0]] == U
    assert len(a) == 1 and [6 * q for q in t.truth(twist)] == [5 * i[0]]


@pytest.mark.parametrize("seed", [1, 2])
def test_a_machine_at_rest_has_efforts_and_no_flow(seed: int) -> None:
    """A capacitor at a voltage: nothing flows, and all of the voltage is across it."""
    text = "model M { 1:s { <- Se:U; -> R:R = 3; -> C:c = 4; -> Df:i }\n sensor y = c.e }"
    t, s = _at(text, rest, seed)
    assert t.value(s["i"]) == [0]
    assert t.value(s["U"]) == t.value(s["y"]) != [0] and len(t.value(s["U"])) == 1
    for flow, (variable, _) in t.part.place.items():
        if flow.symbol.kind.name == "FLOW":
            assert t.truths._variables[variable] == [0]


def test_a_store_that_a_constant_current_fills_is_in_no_steady_operation_but_an_empty_one() -> None:
    """C u' = i - u/R holds u at R i; without the leak nothing may flow."""
    leaky = "model M { 0:n { <- Sf:i; -> C:c = 2; -> R:R = 3; -> De:u } }"
    i, u = _told(leaky, steady, "i", "u")
    assert u == [3 * i[0]] != [0]
    (i,) = _told("model M { 0:n { <- Sf:i; -> C:c = 2; -> De:u } }", steady, "i")
    assert i == [0]
