"""Loops, dependent storages and odd structures, against equations written by hand for scipy."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.linalg import expm
from scipy.optimize import brentq

from bondgraph.runtime.simulation.integrate import SimulationError
from bondgraph.text.diagnostic import CompileError
from tests.simulation.machines import Array, near, run

LOOP = "Se:U -> 1:i\ni -> Df:y\ni -> R:R0 = 1"
TENTH = "duration = 2\nsampling.rate = 20\n"


def linear(a: Array, b: Array, x0: Array, times: Array) -> Array:
    """x' = a x + b from x0, by the matrix exponential; a row for each time."""
    whole = np.zeros((len(a) + 1, len(a) + 1))
    whole[:-1, :-1], whole[:-1, -1] = a, b
    return np.array([(expm(whole * t) @ np.append(x0, 1.0))[:-1] for t in times])


def test_two_ladders_with_a_resistive_loop_between() -> None:
    """Three nodes joined by resistors alone, as nodal analysis gives them."""
    found = run(
        "Se:U -> 1:f\nf -> R:R0 = 1\nf -> 0:a\na -> 1:ab -> 0:b\nab -> R:Rab = 2\n"
        "a -> 1:ac -> 0:c\nac -> R:Rac = 3\nb -> 1:bc -> c\nbc -> R:Rbc = 4\n"
        "b -> I:L = 0.5\nc -> C:Cc = 0.25",
        TENTH + 'inputs.U = 6\nrecord = ["a.e", "b.e"]',
    ).truth
    # currents into a and b vanish, that into b feeds the coil; uc is a state
    g = np.array([[1 + 1 / 2 + 1 / 3, -1 / 2], [-1 / 2, 1 / 2 + 1 / 4]])
    inverse = np.linalg.inv(g)
    of_i, of_u = inverse @ [0, -1], inverse @ [1 / 3, 1 / 4]
    at_rest = inverse @ [6, 0]
    # L i' = ub ; C uc' = (ua - uc)/3 + (ub - uc)/4
    weights = np.array([1 / 3, 1 / 4])
    a = np.array([
        [of_i[1] / 0.5, of_u[1] / 0.5],
        [weights @ of_i / 0.25, (weights @ of_u - 7 / 12) / 0.25],
    ])  # fmt: skip
    b = np.array([at_rest[1] / 0.5, weights @ at_rest / 0.25])
    x = linear(a, b, np.zeros(2), found.time)
    assert near(found.columns["L.p"], 0.5 * x[:, 0])
    assert near(found.columns["Cc.q"], 0.25 * x[:, 1])
    ub = at_rest[1] + of_i[1] * x[:, 0] + of_u[1] * x[:, 1]
    assert near(found.columns["b.e"], ub)


@pytest.mark.parametrize("drift", [False, True])
def test_a_loop_of_many_resistors_is_a_banded_matrix(drift: bool) -> None:
    """A resistive ladder of 120 nodes: one loop, constant or with a resistor that drifts."""
    n = 120
    lines = ["param Rs = 2", "Se:U -> 1:s0", "s0 -> R:r0 = Rs"]
    for k in range(n):
        lines += [f"s{k} -> 0:n{k}", f"n{k} -> R:g{k} = 30"]
        if k < n - 1:
            lines += [f"n{k} -> 1:s{k + 1}", f"s{k + 1} -> R:r{k + 1} = 1"]
    lines += [f"n{n - 1} -> C:Cx = 0.1", f"n{n - 1} -> De:u"]
    scenario = (
        'tolerance = 1e-10\nduration = 20\nsampling.rate = 1\ninputs.U = 1e6\nrecord = ["n50.e"]\n'
    )
    if drift:
        scenario += '[[fault]]\nof = "Rs"\nchange = "+= 4"\nramp = 20\n'
    found = run("\n".join(lines), scenario).truth

    def nodes(t: float) -> tuple[Array, Array]:
        g = np.diag(np.full(n, 1 / 30 + 2.0)) - np.eye(n, k=1) - np.eye(n, k=-1)
        g[-1, -1] -= 1
        rs = 2 + 4 * t / 20 * drift
        g[0, 0] += 1 / rs - 1
        right = np.zeros(n)
        right[0] = 1e6 / rs
        return g, right

    def slope(t: float, u: Array) -> list[float]:
        g, right = nodes(t)
        inner = np.linalg.solve(g[:-1, :-1], right[:-1] - g[:-1, -1] * u[0])
        return [float((inner[-1] - u[0] - u[0] / 30) / 0.1)]

    by_hand = solve_ivp(slope, (0, 20), [0.0], "Radau", found.time, rtol=1e-9, atol=1e-12).y[0]
    assert near(found.columns["u"], by_hand)


def test_a_diode_and_a_resistor_are_solved_where_they_meet() -> None:
    found = run(
        "Se:U -> 1:i\ni -> R:R0 = 100\ni -> R:diode { f = 1e-12*(exp(e/0.026) - 1) }\ni -> Df:y",
        'duration = 1\nsampling.rate = 200\ninputs.U = "10*sin(2*pi*t)"',
    ).truth

    def current(u: float) -> float:
        def balance(e: float) -> float:
            return (u - e) / 100 - 1e-12 * math.expm1(e / 0.026)

        e = float(brentq(balance, min(u, 0) - 1, min(max(u, 0), 1.0) + 1e-9, xtol=1e-14))
        return (u - e) / 100

    wanted = [current(10 * math.sin(2 * math.pi * t)) for t in found.time]
    assert near(found.columns["y"], np.array(wanted), 1e-9)


def test_a_law_whose_slope_is_constant_where_it_has_no_value_at_zero() -> None:
    """2 f + log(2 f) - log(3 f) is 2 f + log(2/3), and so is the other one."""
    found = run(
        "Se:U -> 1:i\ni -> R:a { e = 2*f + log(2*f) - log(3*f) }\ni -> 0:n\nn -> R:c = 5\n"
        "n -> R:b { e = 3*f + 4*log(f*2) - 4*log(f*3) }\nn -> De:y",
        "duration = 0.01\nsampling.rate = 100\ninputs.U = 10",
    ).truth
    # 10 - 2 i - c = u, i = u/5 + (u - 4 c)/3 with c = log(2/3)
    c = math.log(2 / 3)
    u = (10 - c + 8 / 3 * c) / (1 + 2 / 5 + 2 / 3)
    assert near(found.columns["y"], np.full(len(found.time), u), 1e-9)


@pytest.mark.parametrize(
    ("law", "inverse"),
    [
        ("e = 2*f + f^3", None),
        ("e = 3*tanh(f/0.1) + f", None),
        ("e = f + 5*f*abs(f)", None),
        ("e = sinh(f)", None),
    ],
)
def test_nonlinear_resistors_in_parallel(law: str, inverse: None) -> None:
    """A current divides between two of them, while a coil slows it down."""
    found = run(
        f"Se:U -> 1:s\ns -> I:L = 1\ns -> 0:n\nn -> R:ra {{ {law} }}\nn -> R:rb {{ e = f + f^3 }}",
        TENTH + 'inputs.U = "3*cos(2*t)"\nrecord = ["n.e"]',
    ).truth
    forms = {"^": "**", "tanh": "math.tanh", "sinh": "math.sinh"}
    text = law.removeprefix("e = ")
    for old, new in forms.items():
        text = text.replace(old, new)

    def effort(i: float) -> float:
        def balance(e: float) -> float:
            fa = float(brentq(lambda f: eval(text, {"f": f, "math": math}) - e, -40, 40))
            fb = float(brentq(lambda f: f + f**3 - e, -40, 40))
            return fa + fb - i

        return float(brentq(balance, -20, 20, xtol=1e-12))

    p = solve_ivp(
        lambda t, p: [3 * math.cos(2 * t) - effort(p[0])],
        (0, 2), [0.0], "DOP853", found.time, rtol=1e-8, atol=1e-10,
    ).y[0]  # fmt: skip
    assert near(found.columns["L.p"], p, 1e-5)


def test_of_several_solutions_the_one_near_the_last_goes_on() -> None:
    """A tunnel diode behind a resistor: three points of work, the lowest until it ends."""
    law = "f = 4*e^3 - 6*e^2 + 2.4*e"
    found = run(
        f"Se:U -> 1:i\ni -> R:R0 = 1\ni -> R:tunnel {{ {law} }}",
        'duration = 1\nsampling.rate = 100\ninputs.U = "2*t"\nrecord = ["tunnel.e"]',
    ).truth

    def balance(e: Array) -> Array:
        return np.asarray(e + 4 * e**3 - 6 * e**2 + 2.4 * e)

    e = found.columns["tunnel.e"]
    assert np.allclose(balance(e), 2 * found.time, atol=1e-9)
    assert e[0] == 0 and (np.diff(e) > 0).all()


def test_what_has_no_mass_sticks_until_the_spring_pulls_more_than_friction() -> None:
    """f/2 + q = t - 2 from 2 s on, with q' = f; until then the law jumps where f is zero."""
    found = run(
        "Se:F -> 1:v\nv -> R:slide { e = 2*sign(f) + f/2 }\nv -> C:spring = 1\nv -> Df:y",
        'duration = 4\nsampling.rate = 50\ninputs.F = "t"',
    ).truth
    wanted = [1 - math.exp(-2 * max(t - 2, 0)) for t in found.time]
    assert near(found.columns["y"], np.array(wanted))


def test_slider_crank_through_its_dead_centres() -> None:
    """Lagrange's equation in the angle of the crank, for some turns."""
    J, m, r, length, f, c = 2e-3, 0.4, 0.04, 0.15, 1e-3, 5.0

    def lever(th: float) -> tuple[float, float]:
        s, co = math.sin(th), math.cos(th)
        root = math.sqrt(length**2 - (r * s) ** 2)
        k = r * s * (1 + r * co / root)
        dk = r * co * (1 + r * co / root) + r * s * (-r * s / root + r**3 * co**2 * s / root**3)
        return k, dk

    def slope(t: float, x: Array) -> list[float]:
        th, w = x
        k, dk = lever(th)
        torque = 0.5 - f * w - c * k**2 * w - m * k * dk * w**2 - 2 * k
        return [w, torque / (J + m * k**2)]

    from tests.simulation.machines import example

    found = run(
        example("slider_crank"),
        "duration = 1\nsampling.rate = 200\ninputs.T = 0.5\ninputs.load = 2\n[initial]\n"
        '"J.p" = 0.1',
    ).truth
    x = solve_ivp(slope, (0, 1), [0, 50.0], "DOP853", found.time, rtol=1e-10, atol=1e-12).y
    assert x[0, -1] > 4 * math.pi
    assert near(found.columns["speed"], x[1])
    assert near(found.columns["th"], x[0])


def test_a_chain_where_most_inertias_depend() -> None:
    gears = [2.0, 0.5, 3.0, 1.5]
    lines = ["Se:T -> 1:w0", "w0 -> I:J0 = 1"]
    for k, n in enumerate(gears, 1):
        lines += [f"w{k - 1} -> TF:n{k} {{ f1 = {n}*f2 }} -> 1:w{k}", f"w{k} -> I:J{k} = {k + 1}"]
    lines += ["w4 -> R:f = 0.3", "w4 -> Df:w"]
    found = run("\n".join(lines), TENTH + "inputs.T = 2")
    assert len(found.dependent) == 4
    ratios = np.cumprod([1.0, *[1 / n for n in gears]])
    total = sum((k + 1) * x**2 for k, x in enumerate(ratios))
    drag = 0.3 * ratios[-1] ** 2
    w0 = 2 / drag * (1 - np.exp(-drag / total * found.truth.time))
    assert near(found.truth.columns["w"], w0 * ratios[-1])


def test_a_capacitor_across_a_moving_source_needs_its_derivative() -> None:
    found = run(
        "Se:U -> 1:i\ni -> R:R0 = 0.5\nSe:V -> 0:n\nn -> C:Cx = 3\nn -> 1:j\n"
        "j -> I:L = 2\ni -> I:L2 = 1",
        TENTH + 'inputs.V = "sin(5*t)"\ninputs.U = 0\nrecord = ["Cx.f", "V.f"]',
    ).truth
    t = found.time
    assert near(found.columns["Cx.f"], 15 * np.cos(5 * t))
    current = (1 - np.cos(5 * t)) / 5 / 2
    assert near(np.abs(found.columns["V.f"]), np.abs(15 * np.cos(5 * t) + current))


def test_a_parameter_that_is_zero_stores_nothing() -> None:
    text = "param J = 0\nSe:T -> 1:w\nw -> I:J\nw -> R:f = 2\nw -> Df:y"
    found = run(text, TENTH + 'inputs.T = "sin(t)"')
    assert near(found.truth.columns["y"], np.sin(found.truth.time) / 2)
    assert not [n for n in found.truth.columns if n == "J.p" and found.truth.columns[n].any()]


def test_a_controller_in_the_model_reads_what_its_sensor_shows() -> None:
    """u = 5 (3 - y) with y = 0.5 x + 0.2 from 1 s on: the level settles where that holds."""
    found = run(
        "Sf:q = 5*(3 - y) -> 0:n\nn -> C:Cx = 1\nn -> R:R = 1\nn -> De:y",
        'duration = 6\nsampling.rate = 10\nrecord = ["n.e"]\n'
        '[[fault]]\nof = "y"\nchange = "*= 0.5"\nat = 3\n[[fault]]\nof = "y"\nchange = "+= 0.2"\n'
        "at = 3",
    ).truth
    t = found.time
    late = np.clip(t - 3, 0, None)
    first = 2.5 * (1 - np.exp(-6 * np.minimum(t, 3)))
    level = np.where(t < 3, first, 4 + (first - 4) * np.exp(-3.5 * late))
    assert near(found.columns["n.e"], level)
    assert near(found.columns["y"], np.where(t < 3, level, 0.5 * level + 0.2))


def test_what_is_at_rest_is_solved_for() -> None:
    found = run(
        "Se:U -> 1:i\ni -> R:R0 = 1\ni -> I:L = 1e-9\ni -> 0:n\nn -> C:Cx = 1",
        TENTH + 'inputs.U = 1\nquasi_static = ["L"]\nrecord = ["n.e", "i.f"]',
    )
    assert found.static == ("L",)
    assert near(found.truth.columns["i.f"], np.exp(-found.truth.time))


@pytest.mark.parametrize(
    "text", ["Se:U -> 1:i\ni -> R:R0 = 2", "Se:U -> 1:i\ni -> R:R0 = 2\ni -> Df:y"]
)
def test_nothing_to_integrate_or_to_read(text: str) -> None:
    found = run(text, TENTH + 'inputs.U = "t"\nrecord = ["i.f"]')
    assert near(found.truth.columns["i.f"], found.truth.time / 2)


def test_a_ring_of_junctions_changes_nothing_outside() -> None:
    """Two ways with nothing on them lead from a to b: what flows around is open, the rest not."""
    found = run(
        "Sf:Q -> 0:a\na -> 1:x -> 0:b\na -> 1:y -> b\nb -> C:Cx = 2\nb -> De:u\na -> R:R = 4",
        TENTH + "inputs.Q = 3",
    ).truth
    assert near(found.columns["u"], 12 * (1 - np.exp(-found.time / 8)))


@pytest.mark.parametrize("back", [0.5, 3.0])
def test_transformers_in_a_ring(back: float) -> None:
    """If their ratios cancel the ring is open and C is filled, else no effort can be there."""
    found = run(
        f"0:a\n0:b\na -> TF:x {{ f1 = 2*f2 }} -> b -> TF:y {{ f1 = {back}*f2 }} -> a\n"
        "a -> C:Cx = 1\nb -> De:d\nSf:Q -> a",
        TENTH + "inputs.Q = 3",
    ).truth
    wanted = 2 * 3 * found.time if back == 0.5 else 0 * found.time
    assert near(found.columns["d"], wanted)


@pytest.mark.parametrize(
    ("text", "scenario", "says"),
    [
        ("0:n\nn -> C:a(q0 = 1) = 1\nn -> R:out { f = sqrt(a.q)*3 }", "", ("`out`", "0.66")),
        ("0:n\nn -> C:a(q0 = 1) = 1\nn -> R:pump { f = -e^2 }", "", ("without bound", "1 s")),
        (f"{LOOP}\ni -> R:x {{ e = f + f^2 }}", 'inputs.U = "-t"', ("`x`", "1 s")),
        ("Se:U -> 1:i\ni -> C:c = 1\ni -> R:r = 1", 'inputs.U = "log(0.5 - t)"', ("`U`", "0.5")),
        ("Se:F -> 1:w\nw -> I:M = 1\nw -> R:d { e = 2*sign(f) }", "inputs.F = 1", ("`tanh`",)),
        (
            "Se:U -> 1:i\ni -> I:L = 1e-8\ni -> R:r = 1e-3\ni -> C:c = 1e-8\n"
            "Se:F -> 1:w\nw -> I:M = 1\nw -> R:d = 1",
            "inputs.U = 1",
            ("`L.p` and `c.q` ring", "1.59e+07 Hz", "quasi_static"),
        ),
        ("param R0 : Ohm\nSe:U -> 1:i\ni -> R:R0\ni -> C:c = 1", "", ("`R0`",)),
    ],
)  # fmt: skip
def test_where_a_machine_cannot_go_on_it_says_when_and_why(
    text: str, scenario: str, says: tuple[str, ...]
) -> None:
    with pytest.raises((SimulationError, KeyError)) as caught:
        run(text, f"duration = 2\nsampling.rate = 100\n{scenario}")
    message = str(caught.value)
    assert all(word.strip("`") in message for word in says), message


def test_two_switches_that_fix_one_thing_twice_are_told_in_their_mode() -> None:
    text = "input on : bool\nSe:U -> 0:a\nR:R0 = 1 <- a\n1:s when on { <- a; -> 0:b }\nSe:V -> b"
    with pytest.raises(CompileError):
        run(text, 'duration = 1\nsampling.rate = 10\ninputs.on = "t > 0.5"')


def test_a_law_that_divides_by_a_parameter_of_zero_has_no_value() -> None:
    with pytest.raises(SimulationError, match="the law of `a` has no value there"):
        run(
            "param k = 0\nSe:U -> 1:i\ni -> R:a { e = f/k }\ni -> I:L = 1\ni -> Df:y",
            "duration = 1\ninputs.U = 1",
        )
