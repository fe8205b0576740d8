"""The observer form: its equations by hand, its answers beside solved differential equations."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import bondgraph
from bondgraph import Course, Sampling, Scenario
from bondgraph.compilation import Compilation
from bondgraph.ir.residuals import Observer
from bondgraph.passes.analysis.verify import follows
from bondgraph.runtime.batch import Lanes
from bondgraph.text.diagnostic import Report

ROOT = Path(__file__).parents[3]

TANKS = """bg 1
model Tanks {
    input Q : m^3/s
    const rho = 1000 kg/m^3
    const g = 10 m/s^2
    param A1 = 0.02 m^2
    param A2 = 0.03 m^2
    param k1 = 1.2e-5 m^3/s.Pa^-0.5 +- 3%
    param k2 = 1.0e-5 m^3/s.Pa^-0.5 +- 2%
    param leak = 0 m^3/s
    Sf:Q -> 0:upper -> 1:valve -> 0:lower
    upper { -> C:C1 = A1/(rho*g); -> R:hole { f = leak } }
    valve -> R:k1 { f = k1*ssqrt(e) }
    lower { -> C:C2 = A2/(rho*g); -> R:k2 { f = k2*ssqrt(e) }; -> De:p }
}
"""


def model(text: str, **options: Any) -> Compilation:
    """A compilation whose steps are observers."""
    return bondgraph.compile(text=text, form="observer", **options)


def observed(text: str, name: str = "r1") -> Observer | str:
    return model(text).observers[name]


def run(c: Compilation, signals: dict[str, np.ndarray], **params: float) -> np.ndarray:
    """The first residual at all samples."""
    lanes, states, out = Lanes(c.program, params), None, []
    for row in zip(*signals.values(), strict=True):
        found, states = lanes.sample(dict(zip(signals, row, strict=True)), {}, {}, {}, states)
        out.append(float(np.asarray(found[c.program.residuals[0].name])))
    return np.array(out)


def tanks(
    rate: float,
    span: float,
    leak: float = 0.0,
    k1: float = 1.2e-5,
    k2: float = 1.0e-5,
    sway: float = 0.3,
) -> dict[str, np.ndarray]:
    """Inflow and lower pressure of the two tanks, solved to twelve digits; the leak from span/2."""

    def inflow(t: float) -> float:
        return 3e-4 * (1 + sway * np.sin(0.02 * t))

    def rates(t: float, h: np.ndarray) -> list[float]:
        through = k1 * np.sqrt((h[0] - h[1]) * 1e4)
        lost = leak if t > span / 2 else 0.0
        return [(inflow(t) - lost - through) / 0.02, (through - k2 * np.sqrt(h[1] * 1e4)) / 0.03]

    low = (3e-4 / k2) ** 2 / 1e4
    start = [low + (3e-4 / k1) ** 2 / 1e4, low]
    t = np.arange(round(span * rate)) / rate
    found = solve_ivp(rates, (0, span), start, t_eval=t, rtol=1e-10, atol=1e-12, max_step=1.0)
    return {"Q": inflow(t), "p": found.y[1] * 1e4}


# ------------------------------------------------------------------- equations


def test_a_motor_follows_its_current() -> None:
    found = observed((ROOT / "models/dc_motor.bg").read_text())
    assert isinstance(found, Observer)
    # L i' = U - R i - k w, with the flux p = L i for a state
    assert (found.sensor, [str(x) for x in found.states]) == ("current", ["L.p"])
    assert [str(f) for f in found.rates] == ["U - k*speed - L.p*R/L"]
    assert str(found.output) == "L.p/L"
    assert [str(x) for x in found.starts] == ["L*current"]


def test_hidden_tank() -> None:
    found = observed(TANKS)
    assert isinstance(found, Observer)
    upper, lower = "C1.q*rho*g/A1", "C2.q*rho*g/A2"
    assert [str(f) for f in found.rates] == [
        f"Q - leak - k1*ssqrt({upper} - {lower})",
        f"k1*ssqrt({upper} - {lower}) - k2*ssqrt({lower})",
    ]
    # the balance of the upper tank is off by w: C1.q' = ... - w, as 0 = Q - leak - k1.f - C1.q'
    assert [str(b) for b in found.entry] == ["-1", "0"]


@pytest.mark.parametrize(
    ("why", "text"),
    [
        ("holds no storage", "1:j { <- Se:U; -> R:r = 2; -> Df:i }"),
        # the inertia takes its speed from w2, through the gear
        ("differentiated", "1:a { <- Se:U; -> I:m = 2; -> R:d = 1; -> Df:w1 }\n"
                           "a -> TF:k { f1 = 3*f2 } -> 1:b\nb { -> I:n = 1; -> R:q = 1; -> Df:w }"),
        ("position of a switch", "input on : bool\n1:j { <- Se:U; -> I:m = 1; -> Df:v }\n"
                                 "j -> R:r { e = if(on, f, 2*f) }"),
        ("no closed form", "1:j { <- Se:U; -> I:m = 1; -> Df:v }\nj -> 0:n\n"
                           "n { -> R:s { f = e + e^3 }; -> R:t { f = sinh(e) } }"),
        # force and position of a spring: 0 = C*D(F) - D(x), and so 0 = C*F - x from declared starts
        ("declared initial values", "1:v { <- Se:U; -> I:m = 1; -> C:s(q0 = 0) = 2 }\n"
                                    "sensor F = s.e\nsensor x = int(v.f)"),
    ],
)  # fmt: skip
def test_why_there_is_none(why: str, text: str) -> None:
    found = [o for o in model(f"bg 1\nmodel M {{ {text} }}").observers.values()]
    assert any(isinstance(o, str) and why in o for o in found), found


def test_a_wrong_observer_is_found_out() -> None:
    c = model(TANKS)
    found = c.observers["r1"]
    assert isinstance(found, Observer)
    residual, report = c._analysis[0].residuals[0], Report()
    assert follows(residual, found, c._plant, report) and not report.diagnostics
    turned = found._replace(rates=tuple(c.graph.pool.neg(f) for f in found.rates))
    assert not follows(residual, turned, c._plant, report)
    assert [d.code for d in report.diagnostics] == ["verification-failed"]


# --------------------------------------------------------------------- answers


def test_one_state_answers_like_the_solution() -> None:
    """A bias of the voltage goes through 1/(1 + p/v), v^2 = wc^2 + (R/L)^2, and no L is in it."""
    c = model("bg 1\nmodel M { param R = 2 Ohm\nparam L = 10 mH\n1:i { <- Se:U; -> R:R; -> I:L;"
              " -> Df:y } }", rate=1e4)  # fmt: skip
    n = 400
    t, wrong = np.arange(n) / 1e4, np.where(np.arange(n) < 10, 0.0, 1.0)
    r = run(c, {"U": 4.0 + wrong, "y": np.full(n, 2.0)})
    v = np.hypot(200.0, 200.0)  # rate/50 and R/L
    since = t[10:] - t[9]
    # the voltage rises over one sample, which is on average half a sample late
    expected = 1 - np.exp(-v * (since - 0.5e-4))
    assert np.abs(r[:10]).max() < 1e-12
    assert np.abs(r[11:] - expected[1:]).max() < 1e-4


def test_a_lasting_imbalance_is_shown_whole() -> None:
    """Two hidden cells: what is lost in the first shows as it is, whatever the poles."""
    c = model("""bg 1
model M {
    Sf:q -> 0:a -> 1:d -> 0:b
    a { -> C:C1 = 1 mF; -> R:R1 = 3 Ohm }
    d -> R:R2 = 5 Ohm
    b { -> C:C2 = 2 mF; -> De:y }
}
""")
    # at rest y = R1 q; q that is told wrong by 0.5 A is an imbalance of 0.5 A in the first cell
    assert (c.program.residuals[0].follows, c.program.residuals[0].stages) == ("y", 2)
    q, y = np.full(3000, 2.0), np.full(3000, 6.0)
    assert np.abs(run(c, {"q": q, "y": y})).max() < 1e-12
    told = np.where(np.arange(3000) < 10, q, 2.5)
    assert run(c, {"q": told, "y": y})[-1] == pytest.approx(0.5, rel=1e-9)


def test_a_hidden_state_is_followed() -> None:
    c = model(TANKS, rate=1.0)
    healthy = run(c, tanks(1.0, 2000))[200:]
    leaking = run(c, tanks(1.0, 2000, leak=3e-7, sway=0.0))[1600:]
    assert np.abs(healthy).max() < 3e-9  # of flows of 3e-4
    # a thousandth of the inflow is lost: w = Q - leak - k1.f - C1.q' with leak = 0 is as much
    assert np.abs(leaking / 3e-7 - 1).max() < 0.005


def test_the_step_is_of_second_order() -> None:
    off = []
    for rate in (0.5, 1.0, 2.0):
        r = run(model(TANKS, rate=rate, bandwidth=0.02), tanks(rate, 1500))
        off.append(np.abs(r[-round(400 * rate) :]).max())
    assert 3 < off[0] / off[1] < 5 and 3 < off[1] / off[2] < 5


@pytest.mark.parametrize("path", [
    "models/two_tanks.bg",
    "tests/adversary/models/cylinder.bg",
    "tests/adversary/models/three_tanks_level3.bg",
])  # fmt: skip
def test_a_healthy_machine_that_starts_empty(path: str) -> None:
    """Where slopes are infinite an observer has no value, and begins when the machine has moved."""
    levels = Course(None, ((0, 1.0), (1, 1.2), (2, 0.8), (3, 1.1), (10, 1.0)))
    most = {}
    for form in ("observer", "derivative"):
        c = bondgraph.compile(ROOT / path, form=form, rate=200.0)
        inputs = {i.name: levels for i in c.graph.inputs if i.known}
        log = c.simulate(Scenario("fill", inputs=inputs, sampling=Sampling(rate=200.0))).log
        engine = c.engine(native=False)
        batch = engine.run(np.column_stack([log.columns[k.path] for k in engine.signals]))
        valid, value = np.asarray(batch.valid)[:, 0], np.asarray(batch.value)[:, 0]
        assert valid.mean() > 0.6
        most[form] = np.abs(value[valid]).max()
    assert most["observer"] < most["derivative"] / 20


def test_far_too_fast_for_the_samples() -> None:
    """A line whose waves take a microsecond, at a thousand samples a second."""
    c = bondgraph.compile(ROOT / "models/cable_open.bg", form="observer")
    u = 5 + np.sin(np.arange(3000) / 300)
    assert c.program.residuals[0].follows == "Us"
    assert np.abs(run(c, {"Uin": u, "Us": u})[100:]).max() < 1e-3


def test_tolerances_stay_below_the_threshold() -> None:
    c = model(TANKS, rate=1.0)
    assert c.thresholds is not None and c.thresholds.residuals[0].faults == ("k1", "k2")
    shares = []
    for one, other in ((1, 1), (1, -1), (-1, 1), (-1, -1)):
        told = tanks(1.0, 2000, k1=1.2e-5 * (1 + 0.03 * one), k2=1e-5 * (1 + 0.02 * other))
        lanes, states, allowed = Lanes(c.thresholds, {}), None, []
        for row in zip(*told.values(), strict=True):
            found, states = lanes.sample(dict(zip(told, row, strict=True)), {}, {}, {}, states)
            allowed.append(float(np.asarray(next(iter(found.values())))))
        shares.append(np.abs(run(c, told))[300:] / np.array(allowed)[300:])
    assert max(np.max(s) for s in shares) < 1.05  # a threshold is of first order
    assert max(np.max(s) for s in shares) > 0.8


def test_the_threshold_of_a_law_without_a_closed_inverse() -> None:
    """A spring that hardens, whose displacement at rest is a root: off by its tolerances."""
    law = "C:s { e = k*q + k3*q^3 }"
    text = f"""bg 1
model M {{
    param k = 3 +- 5%
    param k3 = 2 +- 5%
    Se:F -> 1:v {{ -> I:m = 1; -> R:b = 1; -> {law}; -> Df:y }}
}}
"""
    c = model(text, rate=200.0)
    assert c.thresholds is not None and [r.name for r in c.thresholds.roots] == ["s.q"]
    t = np.arange(0.0, 20.0, 1.0 / 200.0)

    def rates(t: float, x: np.ndarray) -> list[float]:
        spring = 1.05 * (3.0 * x[0] + 2.0 * x[0] ** 3)
        return [x[1], 2.0 * np.sin(2.0 * t) - x[1] - spring]

    speed = solve_ivp(rates, (0.0, 20.0), [0.0, 0.0], t_eval=t, rtol=1e-9, atol=1e-10).y[1]
    found = c.engine(native=False).run(np.column_stack([2.0 * np.sin(2.0 * t), speed]))
    valid = found.valid[:, 0]
    most = np.abs(found.value[valid, 0]).max()
    assert most > 0.04 and found.bound[valid, 0].max() == pytest.approx(most, rel=0.02)
