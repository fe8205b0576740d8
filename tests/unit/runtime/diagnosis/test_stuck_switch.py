"""Switches that are not where they are told to be, and what must not be taken for one."""

from __future__ import annotations

import math
from functools import cache
from pathlib import Path

import numpy as np
import pytest

import bondgraph
from bondgraph.compilation import Compilation
from bondgraph.runtime.diagnosis.history import History
from bondgraph.runtime.diagnosis.hypotheses import Hypothesis, Stuck
from bondgraph.runtime.diagnosis.isolation import Explained, Rows, explain
from bondgraph.runtime.diagnosis.naming import candidate
from bondgraph.runtime.log import Log
from bondgraph.runtime.monitoring.verdict import (
    Verdict,
    described,
    from_json,
    to_json,
    to_text,
)
from bondgraph.runtime.monitoring.whole_logs import on_grid
from bondgraph.runtime.simulation.read_scenario import read_scenario
from bondgraph.text.diagnostic import Report
from bondgraph.text.source import Source
from tests.switched.plants import COIL, Mode, log

ROOT = Path(__file__).parents[4]

CIRCUIT = """bg 1
model Circuit {
    param R = 2 Ohm +- 5%
    param C = 0.1 F +- 5%
    param G = 0.2 S +- 5%
    input on : bool
    input U : V
    Se:U -> 1:a when on { -> R:R; -> Df:i; -> 0:o }
    o { -> C:C; -> R:load = 1/G; -> De:v }
}
"""
CHARGED = """
inputs.U = "12 + 3*sin(0.7*t)"
inputs.on = "sin(2*pi*t/6) > 0"
sensors.i.noise = 0.01
sensors.v.noise = 0.02
"""
BUCK = """bg 1
model Buck {
    param L = 0.5 H +- 5%
    param R = 1 Ohm +- 5%
    param C = 0.05 F +- 5%
    param G = 0.1 S +- 5%
    input on : bool
    input E : V
    Se:E -> 1:transistor when on { -> 0:node }
    Se:ground = 0 V -> 1:diode when not on { -> node }
    node -> 1:coil { -> I:L; -> R:R; -> Df:i; -> 0:out }
    out { -> C:C; -> R:load = 1/G; -> De:v }
}
"""
CONVERTED = """
inputs.E = "24 + 4*sin(0.7*t)"
inputs.on = "sin(2*pi*t/6) > 0"
sensors.all.noise = 0.05
"""
GEARS = """bg 1
model Gears {
    param J = 0.2 +- 5%
    param a = 2 +- 1%
    param b = 3 +- 1%
    param f = 0.5 +- 5%
    input low : bool
    input T
    Se:T -> 1:shaft { -> I:J; -> Df:w1 }
    shaft -> TF:gear { f1 = if(low, a, b)*f2 } -> 1:wheel { -> R:f; -> Df:w2 }
}
"""
DRIVEN = """
inputs.T = "2 + sin(0.9*t)"
inputs.low = "sin(2*pi*t/6) > 0"
sensors.all.noise = 0.01
"""
LIFT = """bg 1
model Lift {
    param km = 60 +- 4%
    param J = 200 +- 10%
    param b = 40 +- 20%
    param G = 500 +- 3%
    input run : bool
    input i
    1:shaft when run { <- Se:motor = km*i; -> Se:load = G; -> I:J; -> R:b; -> Df:w }
}
"""
LIFTED = """
inputs.i = "8.5 + 2*sin(0.9*t)"
inputs.run = "sin(2*pi*t/6) > 0"
sensors.w.noise = 0.002
"""
MODELS = {
    "circuit": (CIRCUIT, CHARGED),
    "buck": (BUCK, CONVERTED),
    "gears": (GEARS, DRIVEN),
    "lift": (LIFT, LIFTED),
}


@cache
def compiled(name: str) -> Compilation:
    return Compilation(Source(f"{name}.bg", MODELS[name][0]))


def watched(c: Compilation, run: Log) -> list[Verdict]:
    engine = c.engine()
    diagnosis, said = c.diagnosis(engine), []
    for piece in on_grid(engine, run):
        said += diagnosis.update(piece.time, engine.run(piece.samples), piece.samples)
    return said


@cache
def said(name: str, of: str, change: str, seed: int = 3) -> list[Verdict]:
    """Both positions are learned for 18 s, then something is wrong; parameters within tolerance."""
    c, report = compiled(name), Report()
    text = f'duration = 29\nseed = {seed}\nspread = "uniform"\n{MODELS[name][1]}'
    text += f'[[fault]]\nof = "{of}"\nchange = "{change}"\nat = 18.5\n'
    scenario = read_scenario(Source("s.toml", text), c.graph, report)
    assert scenario is not None, report.diagnostics
    return watched(c, c.simulate(scenario).log)


def updates(verdicts: list[Verdict]) -> list[Verdict]:
    assert not [v for v in verdicts if v.event == "fault" and v.time < 18.5]
    found = [v for v in verdicts if v.event == "update"]
    assert found
    return found


@pytest.mark.parametrize("seed", [3, 4])
@pytest.mark.parametrize(
    ("name", "change", "named"),
    [
        ("circuit", "= false", "on stuck off"),
        ("circuit", "= true", "on stuck on"),
        ("circuit", "stuck", "on stuck on"),
        ("buck", "= true", "on stuck on"),
        ("gears", "= false", "low stuck off"),
        ("gears", "= true", "low stuck on"),
        ("lift", "= false", "run stuck off"),
    ],
)
def test_a_switch_that_does_not_obey_is_named(
    name: str, change: str, named: str, seed: int
) -> None:
    first = updates(said(name, named.split()[0], change, seed))[0]
    assert first.candidates[0].fault == named and first.candidates[0].probability > 0.9
    assert named in first.group
    assert first.candidates[0].size is None and named in described(first)
    assert from_json(to_json(first, 1)) == (1, first)


@pytest.mark.parametrize(
    ("name", "of", "change"),
    [
        ("circuit", "R", "*= 1.4"),
        ("circuit", "R", "*= 4"),
        ("circuit", "G", "*= 2"),
        ("circuit", "U", "*= 0.1"),
        ("circuit", "U", "= 3 V"),
        ("circuit", "U", "stuck"),
        ("circuit", "i", "*= 0"),
        ("circuit", "v", "+= 1 V"),
        ("buck", "R", "*= 3"),
        ("buck", "E", "*= 0.5"),
        ("buck", "i", "*= 1.3"),
        ("gears", "w2", "*= 0.8"),
        ("gears", "f", "*= 2"),
    ],
)
def test_what_is_no_stuck_switch_is_not_called_one(name: str, of: str, change: str) -> None:
    told = updates(said(name, of, change))
    for verdict in told:
        assert of in [c.fault for c in verdict.candidates]
        assert verdict.candidates[0].fault == of or verdict.candidates[0].probability < 0.7
        assert not any("stuck" in c.fault for c in verdict.candidates), described(verdict)
    assert told[-1].candidates[0].fault == of


@pytest.mark.parametrize("change", ["*= 0.88", "*= 1.1", "*= 0.7"])
def test_a_speed_is_not_weighed_as_a_torque(change: str) -> None:
    """With the brake open the relation is a balance of torques, with the brake shut it is a speed:
    a tenth of a rad/s is nothing beside the noise of the one, and far from that of the other."""
    told = updates(said("lift", "km", change))
    assert not any("stuck" in c.fault for verdict in told for c in verdict.candidates)
    assert told[-1].candidates[0].fault in ("km", "i"), described(told[-1])


def test_a_command_that_does_not_arrive_has_its_size() -> None:
    """The supply at 0 V discharges C through R, which an open switch does not."""
    first = updates(said("circuit", "U", "*= 0"))[0]
    assert first.candidates[0][:3] == ("U", -100.0, "%") and first.candidates[0].probability > 0.95


@pytest.mark.parametrize(("of", "change"), [("E", "*= 0"), ("on", "= false")])
@pytest.mark.parametrize("seed", [3, 4])
def test_what_is_the_same_machine_is_not_told_apart(of: str, change: str, seed: int) -> None:
    """A converter without supply and one whose transistor stays off: 0 V at the node in both."""
    for verdict in updates(said("buck", of, change, seed)):
        chance = {c.fault: c.probability for c in verdict.candidates}
        assert set(chance) == {"E", "on stuck off"} and max(chance.values()) < 0.9
        assert not verdict.group or {"E", "on stuck off"} <= set(verdict.group)


def test_on_exact_samples_of_a_coil_that_is_not_cut_off() -> None:
    """Told open every other two seconds; from the 13th on it stays closed."""
    plan: list[Mode] = [(k % 2 == 0,) for k in range(10)]
    true = [*plan[:6], *[(True,)] * 4]
    found = log(COIL._replace(plan=true), 2.0, 1000.0)
    draw = np.random.default_rng(7)
    columns = {n: x + draw.normal(size=len(x)) * 0.01 for n, x in found.signals.items()}
    columns["closed"] = np.repeat([float(on) for (on,) in plan], 2000)
    time = np.arange(len(columns["v"])) / 1000.0
    c = Compilation(Source("coil.bg", COIL.text))
    verdicts = watched(c, Log(time, columns, {}, {}))
    first = next(v for v in verdicts if v.event == "fault")
    assert first.since == pytest.approx(14.0, abs=0.15) and set(first.residuals) == {"r2"}
    update = next(v for v in verdicts if v.event == "update")
    assert update.group == ("closed stuck on",) and update.candidates[0].probability > 0.95


def test_the_oven_of_the_documentation() -> None:
    """Its relay stays closed from 1200 s to 1440 s, told off from 1320 s on, open from 1920 s.

    It is told off from 2040 s to 2160 s, as it is: an end that nothing tells.
    """
    c = bondgraph.compile(ROOT / "models" / "oven.bg", rate=10.0)
    run = c.simulate(ROOT / "models" / "scenarios" / "oven_relay.toml")
    told = [v for v in watched(c, run.log) if v.event in ("fault", "update", "cleared")]
    assert [v.event for v in told] == ["fault", "update", "cleared", "fault", "update"]
    assert [told[k].since for k in (0, 3)] == pytest.approx([1320.0, 1920.0], abs=1.0)
    assert told[1].group == ("on stuck on",)
    assert {c.fault for c in told[4].candidates} == {"on stuck off", "P"}
    page = (ROOT / "docs" / "monitoring.md").read_text()
    assert "\n".join(to_text(v) for v in told) in page


def test_which_modes_it_shows_in() -> None:
    """Current flows if both are on: one alone shows only where the other is told on."""
    text = """bg 1
model M { param R=2
input s1 : bool; input s2 : bool
Se:U -> 1:a when s1 and s2 { -> R:R; -> Df:i } }"""
    model = Compilation(Source("m.bg", text)).diagnosis_model
    seen, not_seen = frozenset({"r1"}), frozenset[str]()
    settings = [(False, False), (False, True), (True, False), (True, True)]
    moves = {f: [s.moves[m] for m in settings] for f, s in model.switches.items()}
    assert moves == {
        "s1 stuck off": [not_seen, not_seen, not_seen, seen],
        "s1 stuck on": [not_seen, seen, not_seen, not_seen],
        "s2 stuck off": [not_seen, not_seen, not_seen, seen],
        "s2 stuck on": [not_seen, not_seen, seen, not_seen],
    }
    # open is open, and so is a broken wire; one relation tells no fault of it from another
    assert [set(group) for group in model.groups] == [
        {"R", "U", "i", "s1 stuck off", "s2 stuck off"}, {"s1 stuck on"}, {"s2 stuck on"}
    ]  # fmt: skip
    assert set(model.sees["r1"]) == {"R", "U", "i", *model.switches}
    switch, told = model.switches["s1 stuck on"], np.array([[0.0, 0.0], [0.0, 1.0], [1.0, 1.0]])
    assert switch.moved(told, ["r1"]).tolist() == [[False], [True], [False]]
    assert Stuck("U", 0.0).moved(told[:, :0], ["r1"]).all()


def test_its_evidence_is_that_of_a_healthy_machine_told_otherwise(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Against the density of the normal distribution, parameters within tolerance included.

    Of a model that is right: what it is off by counts in units of what is seen, so that whoever
    explains it by other readings is neither better nor worse off for these being smaller.
    """
    monkeypatch.setattr("bondgraph.runtime.diagnosis.isolation.SHARE", 0.0)
    draw = np.random.default_rng(1)
    n, prior = 6, np.array([0.3, 0.1])
    told, other = draw.normal(size=(2, n, 1)) + np.array([5.0, 0.0])[:, None, None]
    rest, rest_other = draw.normal(size=(2, n, 2, 1))
    weight = draw.uniform(0.5, 2.0, size=(n, 1))
    lost = Hypothesis("on stuck off", "stuck", "", 1.0, True, Stuck("on", False))
    rows = Rows(told, weight, rest, np.zeros((n, 1, 1)))
    others = {0: Rows(other, weight, rest_other, np.zeros((n, 0, 1)))}
    (found,) = explain(rows, [lost], History(prior), others)

    def density(value: np.ndarray, slopes: np.ndarray) -> float:
        s = slopes[:, :, 0] * prior
        spread = s @ s.T + np.diag(1.0 / weight[:, 0])
        y = value[:, 0]
        return float(-0.5 * y @ np.linalg.solve(spread, y) - 0.5 * np.linalg.slogdet(spread)[1])

    assert found.evidence == pytest.approx(density(other, rest_other) - density(told, rest))
    assert (found.change, found.deviation) == (1.0, 0.0)


VALVE = """bg 1
model Valve {
    param P = 2e5 Pa +- 3%
    param k = 2e-6 m^3/s.Pa^-0.5 +- 3%
    input u
    Se:supply = P
    1:line { <- supply; -> R:valve { f = k*u*ssqrt(e) }; -> Df:q; -> Se:back = 5e4 }
}
"""


def _valve(seed: int, steps: bool, stuck: float) -> list[Verdict]:
    """A valve that is not moved any more from 300 s on, in steps or in a course; q in the log."""
    c = bondgraph.compile(text=VALVE, rate=2.0, bandwidth=0.5)
    t, draw = np.arange(1600) / 2.0, np.random.default_rng(seed)
    told = 0.5 + 0.2 * np.sin(2 * np.pi * t / 97.0)
    if steps:
        told = np.repeat(draw.permutation(np.linspace(0.3, 0.9, 40)), 40)
    late = np.flatnonzero(t >= stuck)
    true = told.copy()
    true[late] = told[late[0]]
    q = 0.99 * 2e-6 * true * np.sqrt(2e5 * 1.01 - 5e4)
    columns = {"u": told, "q": q + 2e-6 * draw.standard_normal(len(t))}
    engine = c.engine()
    samples = np.column_stack([columns[k.path] for k in engine.signals])
    diagnosis, said = c.diagnosis(engine), []
    for k in range(0, len(t), 250):
        said += diagnosis.update(t[k : k + 250], engine.run(samples[k : k + 250]),
                                 samples[k : k + 250])  # fmt: skip
    return said


@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize("steps", [True, False])
def test_an_actuator_that_stays_where_it_was_is_told_with_its_place(
    seed: int, steps: bool
) -> None:
    """300 s is within a step of the command; it was said to be a parameter, or off by some size."""
    said = _valve(seed, steps, 300.0)
    assert not [v for v in said if v.event == "fault" and v.time < 300.0]
    last = [v for v in said if v.event == "update"][-1]
    best = last.candidates[0]
    draw = np.random.default_rng(seed)
    told = draw.permutation(np.linspace(0.3, 0.9, 40))[15] if steps else 0.5 + 0.2 * np.sin(
        2 * np.pi * 300.0 / 97.0
    )  # fmt: skip
    assert best.fault == "u" and best.probability > 0.6 and best.size is None
    assert best.stands == pytest.approx(told, abs=0.02)
    assert f"stands at {best.stands:.3g}" in described(last)
    assert from_json(to_json(last, 1)) == (1, last)
    # where the command passes by this place nothing shows, and the alarm is not over
    assert not [v for v in said if v.event == "cleared"]


def test_an_input_that_never_had_a_number_stands_nowhere() -> None:
    """JSON has no number for that, and the watch would end."""
    stays = Hypothesis("u", "stuck", "V", 1.0, True, Stuck("u", math.nan))
    places = [6.7, math.nan]
    found = [candidate(Explained("u", 1.0, stays, place, 0.0), 0.5) for place in places]
    assert [one.stands for one in found] == [6.7, None]
    assert '"stands"' not in to_json(Verdict("update", 1.0, candidates=(found[1],)), 1)


def test_an_actuator_that_is_off_by_a_share_is_not_said_to_stand() -> None:
    c = bondgraph.compile(text=VALVE, rate=2.0, bandwidth=0.5)
    t, draw = np.arange(1600) / 2.0, np.random.default_rng(9)
    told = 0.5 + 0.2 * np.sin(2 * np.pi * t / 97.0)
    q = 2e-6 * told * np.where(t < 300.0, 1.0, 0.8) * np.sqrt(1.5e5)
    engine = c.engine()
    columns = {"u": told, "q": q + 2e-6 * draw.standard_normal(len(t))}
    samples = np.column_stack([columns[k.path] for k in engine.signals])
    said = c.diagnosis(engine).update(t, engine.run(samples), samples)
    last = [v for v in said if v.event == "update"][-1]
    assert all(one.stands is None for one in last.candidates)
    (own,) = [one for one in last.candidates if one.fault == "u"]
    assert own.size == pytest.approx(-20.0, abs=2.0) and own.unit == "%"
