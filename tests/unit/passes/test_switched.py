"""What a switch makes jump, and the filter that starts anew, against physics and closed forms."""

from __future__ import annotations

from math import inf

import numpy as np
import pytest
from numpy.polynomial import Polynomial

import bondgraph
from bondgraph.compilation import Compilation
from bondgraph.ir.expr import Expr, Kind, Pool, topological
from bondgraph.ir.program import Const, Expression, Function, Product, Ref, Sum
from bondgraph.passes.lowering.jumps import Jumps, _linear
from bondgraph.passes.lowering.opening import _shape
from bondgraph.text.source import Source
from tests.sampled import Sampled
from tests.switched.plants import BOOST, CAPACITORS, CARRIAGE, COIL


def _levels(text: str, mode: str) -> dict[str, float]:
    """The lowest derivative of each sensor that may jump."""
    system = Compilation(Source("m.bg", text)).equations
    jumps = Jumps(system)
    (symbol,) = [m for m in jumps.modes if m.symbol.name == mode]
    return {s.name: jumps.level(symbol, s.symbol) for s in system.graph.sensors}


def test_a_coil_that_is_cut_off_loses_its_current_and_the_voltage_its_slope() -> None:
    assert _levels(COIL.text, "closed") == {"v": 1, "i": 0}


def test_joined_capacitors_jump() -> None:
    assert _levels(CAPACITORS.text, "joined") == {"v1": 0, "v2": 0}


def test_a_brake_changes_the_acceleration_and_so_the_second_derivative_of_a_spring() -> None:
    assert _levels(CARRIAGE.text, "braked") == {"s": 2}


def test_the_current_of_a_converter_may_be_cut_off() -> None:
    assert _levels(BOOST.text, "diode")["i"] == 0


def test_heat_goes_through_one_storage_after_the_other() -> None:
    system = bondgraph.compile("models/oven.bg").equations
    jumps = Jumps(system)
    (on,) = jumps.modes
    assert [jumps.level(on, s.symbol) for s in system.graph.sensors] == [1, 2]
    assert jumps.level(on, system.graph.pool.der(system.graph.sensors[0].symbol)) == 0
    assert jumps.level(on, on) == 0


def test_what_is_not_connected_never_jumps() -> None:
    text = """bg 1
model M {
    input on : bool
    Sf:I -> 0:a
    a -> C:C1 = 1 F
    a -> R:R1 { f = if(on, 2, 1)*e }
    a -> De:y
    Sf:J -> 0:b
    b -> C:C2 = 1 F
    b -> De:z
}
"""
    assert _levels(text, "on") == {"y": 1, "z": inf}


def test_three_capacitors_move_together_where_a_switch_joins_two() -> None:
    """C3 has always had the voltage of C2, through a lever of two; C4 is behind a resistor."""
    text = """bg 1
model M {
    input on : bool
    Sf:I -> 0:a
    a -> C:C1 = 1 F
    a -> 1:sw when on { -> 0:b }
    b -> C:C2 = 1 F
    b -> TF:n { f1 = 2*f2 } -> 0:c
    c -> C:C3 = 1 F
    c -> 1:r -> 0:d
    r -> R:R = 1 Ohm
    d -> C:C4 = 1 F
    a -> De:y1
    b -> De:y2
    c -> De:y3
    d -> De:y4
}
"""
    assert _levels(text, "on") == {"y1": 0, "y2": 0, "y3": 0, "y4": 1}


def test_what_is_added_up_of_a_slope_jumps_as_what_has_the_slope() -> None:
    system = Compilation(Source("m.bg", COIL.text)).equations
    pool, jumps = system.graph.pool, Jumps(system)
    start = pool.symbol("start", Kind.INITIAL)
    voltage, current = sorted((s.symbol for s in system.graph.sensors), key=lambda s: s.symbol.name,
                              reverse=True)  # fmt: skip
    (closed,) = jumps.modes
    for symbol, level in ((current, 0), (voltage, 1)):
        assert jumps.level(closed, pool.integral(pool.der(symbol), start)) == level
        assert jumps.level(closed, pool.integral(symbol, start)) == level + 1


_BODY = "Sf:P -> 0:body { -> C:C; -> De:T; -> R:fins { f = if(on, 3, 1)*e }; -> p }"
_BEHIND = _BODY + "\n    1:p { -> R:R; -> n }\n    0:n "


@pytest.mark.parametrize(
    ("lines", "anew"),
    [
        # only what is filtered jumps: a flow of heat, a voltage, an acceleration in a linear law
        ("Sf:P -> 0:body { -> C:C; -> De:T; -> R:fins { f = if(on, 3, 1)*e } }", False),
        ("Se:E = if(on, P, 0) -> 1:coil { -> I:C; -> R:R; -> Df:i }", False),
        ("Se:F = if(on, P, 0) -> 1:mass { -> I:C; -> R:R; -> spring }\n"
         "    0:spring { -> C:K = 2; -> De:s }", False),
        (_BEHIND + "{ -> R:r { f = flow*e } }", False),
        # the mode itself, in a law with a slope that jumps
        (_BEHIND + "{ -> R:r { f = if(on, 2, 1)*flow*e } }", True),
        # the root of a slope that jumps
        (_BEHIND + "{ -> R:r { e = f*abs(f) } }", True),
        # the slope of what jumps: D(D(T))
        (_BEHIND + "{ -> C:c = 1 }", True),
        # a momentum that goes on, with a current that does not
        ("Se:P -> 1:coil { -> I:L { f = if(on, 2, 1)*p }; -> R:R; -> Df:i }", True),
        # a reading that jumps: no threshold has room for it
        ("Se:P -> 1:feed { -> R:R; -> bus }\n"
         "    0:bus { -> R:lamp { f = if(on, 2, 1)*e }; -> De:v; -> coil }\n"
         "    1:coil { -> I:C; -> R:wire = 1; -> Df:i }", True),
    ],
)  # fmt: skip
def test_a_filter_goes_on_where_only_its_input_jumps(lines: str, anew: bool) -> None:
    text = f"""bg 1
model M {{
    input on : bool
    input P
    input flow
    param C = 2
    param R = 4
    {lines}
}}
"""
    program = Compilation(Source("m.bg", text)).program
    assert any(o.modes for o in program.openings) == anew


@pytest.mark.parametrize(("on", "level"), [(True, 6.0), (False, 3.0)])
def test_a_constant_inflow_counts_in_both_positions_of_a_valve(on: bool, level: float) -> None:
    """What flows in, 3, flows out through one pipe of 2, or through two of them."""
    text = """bg 1
model M {
    param R = 2; param A = 1; param w = 3
    input on : bool
    0:t { <- Sf:pump = w; -> C:A; -> De:y; -> R:pipe { f = if(on, 1, 2)*e/R } }
}
"""
    program = Compilation(Source("m.bg", text)).program
    machine, faulty = Sampled(program), Sampled(program)
    for _ in range(3000):
        calm = machine.step({"y": level}, {"on": on}).residuals["r1"]
        wrong = faulty.step({"y": level + 0.5}, {"on": on}).residuals["r1"]
    assert abs(calm) < 1e-9
    assert abs(wrong) == pytest.approx(0.5 / 2 * (1 if on else 2), rel=1e-6)


def _at(value: Expression, u: float) -> float:
    match value:
        case Const():
            return value.value
        case Ref():
            return u if value.name == "u" else 1.0 - u
        case Sum():
            return sum(_at(t, u) * (1 if plus else -1) for plus, t in value.terms)
        case Product():
            return float(np.prod([_at(f, u) for f in value.factors]))
        case Function(name="pow"):
            return _at(value.args[0], u) ** _at(value.args[1], u)
    raise AssertionError(value)


@pytest.mark.parametrize("smooth", [2, 3, 5])
def test_the_window_is_the_integral_of_a_bump(smooth: int) -> None:
    """S' = (u (1-u))**smooth, scaled so that S comes from 0 to 1; and the derivatives of that."""
    bump = (Polynomial([0, 1]) * Polynomial([1, -1])) ** smooth
    curve = bump.integ()
    curve = curve / curve(1.0)
    u, rest = Ref("local", "u"), Ref("local", "rest")
    for j in range(smooth):
        for at in (0.0, 0.1, 0.5, 0.83, 1.0):
            size = np.abs(curve.deriv(j)(np.linspace(0, 1, 50))).max()
            found = _at(_shape(smooth, j, u, rest), at)
            assert found == pytest.approx(curve.deriv(j)(at), abs=1e-9 * size)


@pytest.mark.parametrize(("counts", "fades"), [("", True), (" counts 1000/turn", False)])
def test_a_position_fades_in_under_a_window_but_counts_that_are_differentiated_wait(
    counts: str, fades: bool
) -> None:
    """k i = b w of a shaft without inertia: counts would have to become a position for that."""
    text = f"""bg 1
model M {{
    input on : bool
    1:coil when on {{ <- Se:U; -> R:R = 1 Ohm; -> GY:k -> shaft; -> Df:i }}
    param k = 3 N.m/A
    1:shaft {{ -> R:b = 2 N.m.s/rad }}
    sensor angle : rad = int(shaft.f){counts}
}}
"""
    program = Compilation(Source("m.bg", text)).program
    (opening,) = program.openings
    windows = [s.target.name for s in program.step if "phi" in s.target.name]
    assert opening.modes == ("on",)
    assert bool(windows) == fades


def test_a_law_of_derivatives_that_jump_is_linear_where_each_stands_alone() -> None:
    """In a sum or beside factors that go on; not twice in a product, in a power or a function."""
    p = Pool()
    x, y, k = p.symbol("x", Kind.SENSOR), p.symbol("y", Kind.SENSOR), p.symbol("k", Kind.PARAM)
    dx, dy = p.der(x), p.der(y)
    levels: dict[Expr, float] = {x: 1, y: 1, k: inf, dx: 0, dy: 0, p.der(dx): -1}

    def linear(expr: Expr) -> bool:
        for node in topological([expr]):
            levels.setdefault(node, min((levels[a] for a in node.args), default=inf))
        return _linear(expr, levels)

    assert linear(p.add((2, dx), (-1, dy), (1, x))) and linear(p.mul(k, dx, p.power(x, 2)))
    assert linear(p.fn("sin", p.mul(x, k))) and linear(p.mul(k, p.add((1, dx), (1, y))))
    for bent in (p.mul(dx, dy), p.power(dx, 2), p.power(dx, -1), p.fn("sin", dx), p.der(dx)):
        assert not linear(bent)
        assert not linear(p.add((1, dy), (1, bent))) and not linear(p.mul(k, bent))
