"""Machines that run on wrong readings: slopes, smallest changes and verdicts.

The loops are those of `tests/unit/passes/test_received.py`, integrated by hand.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from functools import cache
from pathlib import Path

import numpy as np
import pytest

import bondgraph
from bondgraph.cli.main import main
from bondgraph.compilation import Compilation
from bondgraph.runtime.diagnosis.calibration import tune
from bondgraph.runtime.diagnosis.healthy import directions
from bondgraph.runtime.diagnosis.hypotheses import Bank, hypotheses, sized
from bondgraph.runtime.log import Array
from bondgraph.runtime.monitoring.verdict import Verdict
from bondgraph.runtime.simulation.scenario import Course, Fault, Scenario
from bondgraph.runtime.smallest import Situation, smallest
from tests.unit.passes.relations import compiled
from tests.unit.passes.test_received import LOOPS, Loop

_STEP, _ONSET, _SECONDS = 1e-3, 12.0, 24.0
_G, _C, _K = 0.5, 2.0, 1.5  # of the tank

HIDDEN, LOGGED, CASCADE = (
    "P, its command hidden", "PI, its command logged", "two controllers in a cascade",
)  # fmt: skip
SMALL = "a tank in SI units"


def _small(t: float, x: Array, wrong: Mapping[str, float]) -> tuple[list[float], dict[str, float]]:
    r = 1e4 + 3e3 * math.sin(1.3 * t) + 2e3 * math.sin(0.4 * t)
    y = x[0] + wrong.get("y", 0.0)
    cmd = 2e-9 * (r - y)
    rates = [(cmd + wrong.get("pump", 0.0) - 1e-9 * x[0]) / 1e-8]
    return rates, {"r": r, "y": y, "u": cmd + wrong.get("u", 0.0)}


_LOOPS = {**LOOPS, SMALL: Loop(
    """
    input r : Pa
    param K = 2e-9 m^3/s.Pa^-1
    param c = 1e-8 m^3/Pa
    param R = 1e9 Pa.s/m^3
    Sf:pump = K*(r - y)
    0:t { <- pump; -> C:c; -> R:R; -> De:y }
    sensor u = K*(r - y)
    """,
    (), (5000.0,), _small, {}, {},
)}  # fmt: skip


@cache
def _compiled(name: str) -> Compilation:
    return compiled(f"model M {{\n{_LOOPS[name].text}\n}}")


def _log(loop: Loop, wrong: Mapping[str, float], noise: Mapping[str, float], seed: int) -> Array:
    """Samples of all that is logged, noise fed back as everything that a sensor says."""
    draw, x, h, rows = np.random.default_rng(seed), np.array(loop.start), _STEP, []
    for n in range(round(_SECONDS / h)):
        t = n * h
        now = {name: sigma * draw.normal() for name, sigma in noise.items()}
        for name, size in wrong.items() if t >= _ONSET else ():
            now[name] = now.get(name, 0.0) + size
        rows.append(list(loop.run(t, x, now)[1].values()))
        k1 = np.array(loop.run(t, x, now)[0])
        k2 = np.array(loop.run(t + h / 2, x + h / 2 * k1, now)[0])
        x = x + h * k2
    return np.array(rows)


def _samples(name: str, wrong: Mapping[str, float], noise: Mapping[str, float], seed: int) -> Array:
    loop = _LOOPS[name]
    names = list(loop.run(0.0, np.array(loop.start), {})[1])
    table = _log(loop, wrong, noise, seed)
    return table[:, [names.index(k.path) for k in _compiled(name).engine().signals]]


def _said(name: str, samples: Array) -> list[Verdict]:
    engine = _compiled(name).engine()
    base, diagnosis = engine.configured(), _compiled(name).diagnosis(engine)
    time, out = np.arange(len(samples)) * _STEP, []
    for k in range(0, len(samples), 700):
        part = samples[k : k + 700]
        out += diagnosis.update(time[k : k + 700], base.run(part), part)
    return out


# ------------------------------------------------------------------------- slopes


@pytest.mark.parametrize("native", [None, False], ids=["as it can", "python"])
def test_a_wrong_sensor_changes_what_it_measures_and_not_what_was_commanded(
    native: bool | None,
) -> None:
    # at rest: r1 = K(r - y) + pump - g y and r2 = u - K(r - y) - Ki int(r - y), y = 1, r = 3
    c = _compiled(LOGGED)
    engine = c.engine(native)
    known = hypotheses(engine, c.diagnosis_model.faults, c.diagnosis_model.units, {})
    nominal = c.diagnosis_model.nominal
    at = {(h.fault, h.kind): k for k, h in enumerate(known)}
    row = {"r": 3.0, "y": 1.0, "u": 2.0}
    rows = np.tile([[row[k.path] for k in engine.signals]], (2000, 1))
    slopes = Bank(engine.configured(bounds=False), known, nominal).run(rows)[-1]
    assert slopes[at["y", "offset"]] == pytest.approx([-_G, 0.0], rel=1e-6, abs=1e-9)
    assert slopes[at["y", "gain"]] == pytest.approx([-_G * 1.0, 0.0], rel=1e-6, abs=1e-9)
    assert slopes[at["pump", "value"]] == pytest.approx([1.0, 0.0], rel=1e-6, abs=1e-9)
    assert slopes[at["u", "offset"]] == pytest.approx([0.0, 1.0], rel=1e-6, abs=1e-9)
    assert abs(slopes[at["r", "offset"]][1]) > _K  # the integral adds to it


def test_a_usual_wrong_delivery_is_a_share_of_the_largest_signal() -> None:
    # r1 = K(r - y) + pump - g y - c y' at rest: K r = 4.5 is the largest, beside g y = 0.5
    c = _compiled(HIDDEN)
    engine = c.engine()
    known = hypotheses(engine, c.diagnosis_model.faults, c.diagnosis_model.units, {})
    nominal = c.diagnosis_model.nominal
    rows = np.tile([[3.0, 1.0]], (3000, 1))  # r, y
    found = sized(engine.configured(), known, nominal, rows)
    changed = {h.fault: h.usual for h, old in zip(found, known, strict=True) if h != old}
    assert changed == {"pump": pytest.approx(0.3 * _K * 3.0, rel=1e-3)}


def test_a_usual_leak_is_a_share_of_the_largest_flow() -> None:
    # at rest Q = k sqrt(p): a leak of 0.3 k lets through 0.3 Q, which is the largest of the balance
    k, p = 2e-6, 4e4
    c = compiled(
        f"model M {{ param C = 1e-5; param k = {k}; param leak = 0; Sf:Q -> 0:t; t -> C:C"
        "; t -> De:p; t -> R:out { f = k*ssqrt(e) }; t -> R:hole { f = leak*ssqrt(e) } }"
    )
    assert _usual(c, {"Q": k * math.sqrt(p), "p": p})["leak"] == pytest.approx(0.3 * k, rel=1e-3)


def test_a_leak_that_was_fitted_is_still_one_that_is_declared_zero() -> None:
    """With 1e-4 k of it in healthy logs, as `--parameters` has it, 1.3e-4 k was usual of it."""
    k, p = 2e-6, 4e4
    text = (
        f"bg 1\nmodel M {{ param C = 1e-5; param k = {k}; param leak = 0; Sf:Q -> 0:t; t -> C:C"
        "; t -> De:p; t -> R:out { f = k*ssqrt(e) }; t -> R:hole { f = leak*ssqrt(e) } }"
    )
    c = bondgraph.compile(text=text, parameters={"leak": 1e-4 * k})
    model = c.diagnosis_model
    assert model.faults["leak"] == 1e-4 * k and model.signs == {"leak": 1}
    known = hypotheses(c.engine(), model.faults, model.units, {}, zeros=model.signs)
    assert [h.fault for h in known if h.zero] == ["leak"]
    along, _ = directions(known, model)
    assert "leak" not in [h.fault for h in along] and "k" in [h.fault for h in along]
    assert _usual(c, {"Q": k * math.sqrt(p), "p": p})["leak"] == pytest.approx(0.3 * k, rel=1e-3)


def test_what_is_usual_of_a_bent_law_is_of_its_slope_at_nothing() -> None:
    # r = i - U/(R + more): a step of 1e-5 Ohm is ten times R, and the slope at 0 is U/R^2
    c = compiled(
        "model M { param R = 1e-6; param more = 0; Se:U -> 1:w; w -> R:all { f = e/(R + more) }"
        "; w -> Df:i }"
    )
    usual = _usual(c, {"U": 1.0, "i": 1e6})
    assert usual["more"] == pytest.approx(0.3 * 1e-6, rel=1e-2)


def _usual(c: Compilation, at: Mapping[str, float]) -> dict[str, float]:
    """Usual sizes of the parameters of a machine at rest."""
    engine, nominal, model = c.engine(), c.diagnosis_model.nominal, c.diagnosis_model
    known = hypotheses(engine, model.faults, model.units, {}, zeros=model.signs)
    rows = np.tile([[at[k.path] for k in engine.signals]], (3000, 1))
    found = sized(engine.configured(), known, nominal, rows)
    return {h.fault: h.usual for h in found if h.kind == "value"}


def test_an_engine_is_told_what_laws_received_where_that_is_not_what_it_is_told() -> None:
    engine = _compiled(HIDDEN).engine().configured(bounds=False)
    assert [engine.signals[k].path for k in engine.readings] == ["y"]
    rows = np.tile([[3.0, 1.0]], (1500, 1))  # r, y
    other = engine.configured().run(rows, np.full((1500, 1), 0.5))
    assert engine.run(rows).value[-1] == pytest.approx([_K * 2.0 - _G], rel=1e-6)
    assert other.value[-1] == pytest.approx([_K * 2.5 - _G], rel=1e-6)
    with pytest.raises(ValueError, match="needed"):
        engine.run(rows, np.zeros((1500, 2)))


# ---------------------------------------------------------------- smallest changes


def test_the_noise_of_a_reading_that_a_controller_follows_is_that_of_its_measurement() -> None:
    # K(r - y) was received and is known like a command: the same machine with that as an input
    other = compiled(
        f"model M {{ param c = {_C}; param g = {_G}; Sf:Q -> 0:t; t -> C:c; t -> De:y"
        "; t -> R:out { f = g*e } }"
    )
    noisy = Situation(at={"r": 3.0, "y": 1.0, "Q": 3.0}, noise={"y": 0.01})
    c = _compiled(HIDDEN)
    found = smallest(c.program_with_readings, c.thresholds, {}, noisy)
    same = smallest(other.program_with_readings, other.thresholds, {}, noisy)
    sigma = found.sigma["r1"]
    assert sigma is not None and sigma > 0.0
    assert sigma == pytest.approx(same.sigma["r1"], rel=1e-9)
    change = {s.fault: s.change for s in found.smallest}
    assert change["y"] == pytest.approx(5.0 * sigma / _G, rel=1e-6)
    assert change["pump"] == pytest.approx(5.0 * sigma, rel=1e-6)


def test_detect_lists_what_is_seen(capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    path = tmp_path / "tank.bg"
    path.write_text(f"bg 1\nmodel M {{\n{LOOPS[LOGGED].text}\n}}\n", encoding="utf-8")
    assert main(["detect", str(path), "--at", "y=1", "--at", "r=3", "--noise", "y=0.01"]) == 0
    rows = [line.split()[:2] for line in capsys.readouterr().out.splitlines()]
    assert ["y", "r1"] in rows and ["pump", "r1"] in rows and ["u", "r2"] in rows
    assert ["y", "r2"] not in rows and ["pump", "r2"] not in rows


def test_tuning_tells_the_smallest_wrong_delivery() -> None:
    c = _compiled(LOGGED)
    noise = {"y": 2e-3, "u": 2e-3}
    logs = [_samples(LOGGED, {}, noise, 50 + k)[: round(8.0 / _STEP)] for k in range(2)]
    found = tune(c.engine(), c.diagnosis_model, logs, c.program.digest, 1.0)
    shown = {(s.hypothesis.fault, s.hypothesis.kind): s for s in found.shown}
    pump, y = shown["pump", "value"], shown["y", "offset"]
    assert pump.residual == y.residual == "r1"
    assert pump.size is not None and y.size is not None
    # r1 holds pump and g y + c y': both rise like a step through the filter, y faster at first
    assert y.size <= pump.size / _G
    assert {s.residual for k, s in shown.items() if k[0] == "u"} == {"r2"}


# ------------------------------------------------------------------------ verdicts


@pytest.mark.parametrize("name", [CASCADE, LOGGED])
def test_a_healthy_loop_is_quiet(name: str) -> None:
    noise = {"w": 2e-3, "i": 2e-3, "y": 2e-3, "u": 2e-3}
    assert {v.event for v in _said(name, _samples(name, {}, noise, 3))} == {"warm-up"}


@pytest.mark.parametrize(
    ("name", "fault", "size", "group"),
    [
        (CASCADE, "w", 0.1, {"k", "i", "w"}),
        (CASCADE, "i", 0.1, {"k", "i", "w"}),
        (CASCADE, "drive", 0.3, {"L", "R", "Kc", "Kw", "drive", "r"}),
        (LOGGED, "u", 0.1, {"u"}),
        (LOGGED, "y", 0.1, {"c", "g", "pump", "y"}),
    ],
)
def test_what_is_wrong_in_a_loop_is_named(
    name: str, fault: str, size: float, group: set[str]
) -> None:
    noise = {"w": 2e-3, "i": 2e-3, "y": 2e-3, "u": 2e-3}
    said = _said(name, _samples(name, {fault: size}, noise, 4))
    first = next(v for v in said if v.event == "fault")
    assert first.since == pytest.approx(_ONSET, abs=0.2)
    updates = [v for v in said if v.event == "update"]
    assert updates and all(set(v.group) == group for v in updates)
    assert fault in [c.fault for c in updates[-1].candidates]
    if fault != "y":  # by itself, an error of this level is much like a smaller tank
        first_one = updates[-1].candidates[0]
        assert first_one.fault == fault
        assert first_one.size == pytest.approx(size, rel=0.1)


def test_a_pump_of_a_millionth_of_a_unit_is_among_what_it_can_be() -> None:
    said = _said(SMALL, _samples(SMALL, {"pump": 3e-6}, {"y": 10.0, "u": 2e-8}, 1))
    first, *_ = [v for v in said if v.event == "update"]
    assert set(first.group) == {"c", "R", "pump", "y"}
    sizes = {c.fault: c.size for c in first.candidates}
    assert sizes["pump"] == pytest.approx(3e-6, rel=0.05)


# ---------------------------------------------------------------------- simulation


@pytest.mark.parametrize(
    ("of", "size", "shown"),
    [("y", 0.4, (-_G * 0.4, 0.0)), ("pump", 0.3, (-0.3, 0.0)), ("u", 0.2, (0.0, 0.2))],
)
def test_the_virtual_machine_runs_on_the_reading(
    of: str, size: float, shown: tuple[float, float]
) -> None:
    c = _compiled("P, its command logged")
    wrong = Fault(of, "+=", size, 2.0, math.inf, 0.0, 0.0, 1.0, of)
    scenario = Scenario("wrong", duration=8.0, inputs={"r": Course.constant(3.0)},
                        faults=(wrong,))  # fmt: skip
    log = c.simulate(scenario).log
    engine = c.engine()
    table = np.column_stack([log.columns[k.path] for k in engine.signals])
    assert engine.run(table).value[-1] == pytest.approx(shown, rel=1e-3, abs=1e-4)
