"""Slopes against closed forms, and verdicts on a motor that is simulated by hand."""

from __future__ import annotations

import json
from functools import cache

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import bondgraph
from bondgraph.compilation import Compilation
from bondgraph.runtime.diagnosis.calibration import Tuned, tune
from bondgraph.runtime.diagnosis.diagnosis import Diagnosis
from bondgraph.runtime.diagnosis.hypotheses import Bank, hypotheses
from bondgraph.runtime.monitoring.engine import Engine
from bondgraph.runtime.monitoring.verdict import Verdict
from bondgraph.text.source import Source

_L, _R, _K, _J, _F = 300e-6, 17.6, 3.51e-3, 1.4e-8, 1.19e-5
_ONSET = 4.0
_NOISE = {"current": 2e-4, "speed": 0.1}


@cache
def _motor() -> Compilation:
    return bondgraph.compile("models/dc_motor.bg")


@cache
def _engine() -> Engine:
    return _motor().engine()


def test_a_residual_that_reads_what_never_comes_is_told() -> None:
    text = """bg 1
model M {
    1:a { <- Se:U; -> R:r = 2; -> Df:i }
    1:b { <- Se:V; -> R:s = 3; -> Df:j }
}
"""
    model = Compilation(Source("m.bg", text))
    engine = model.engine()
    here = {"U": 6.0, "i": 3.0, "V": 6.0, "j": np.nan}
    count = round(10.0 * engine.warm_up / engine.sample_time)
    samples = np.tile([here[k.path] for k in engine.signals], (count, 1))
    (silent,) = [r.name for r in model.residuals if "j" in r.faults]
    diagnosis = model.diagnosis(engine)
    said: list[Verdict] = []
    for start in range(0, count, 100):
        part = samples[start : start + 100]
        time = (start + np.arange(len(part))) * engine.sample_time
        said += diagnosis.update(time, engine.run(part), part)
    (told,) = [v for v in said if v.event == "invalid"]
    assert told.message.startswith(f"{silent} had no value so far")


def _samples(
    seed: int, seconds: float = 8.0, wrong: dict[str, float] | None = None, gain: float = 1.0
) -> tuple[np.ndarray, np.ndarray]:
    """Time, and U, load, current, speed in the order of the engine; `wrong` from the onset on."""
    draw = np.random.default_rng(seed)
    nominal = {"L": _L, "R": _R, "k": _K, "J": _J, "f": _F}
    share = {"R": 0.05, "k": 0.02, "f": 0.1}
    own = {n: v * (1 + share.get(n, 0.0) * draw.uniform(-1, 1)) for n, v in nominal.items()}

    def volts(t: float) -> float:
        return 9.0 + 3.0 * np.sin(3.0 * t)

    def rates(t: float, x: list[float], p: dict[str, float]) -> list[float]:
        return [
            (volts(t) - p["R"] * x[0] - p["k"] * x[1]) / p["L"],
            (p["k"] * x[0] - p["f"] * x[1]) / p["J"],
        ]

    t = np.arange(round(seconds * 1000)) / 1000
    state = np.linalg.solve([[own["R"], own["k"]], [own["k"], -own["f"]]], [volts(0.0), 0.0])
    rows = []
    for p, part in ((own, t[t < _ONSET]), (own | (wrong or {}), t[t >= _ONSET])):
        if len(part):
            end = part[-1] + 1e-3
            grid = np.append(part, end)
            found = solve_ivp(rates, (part[0], end), state, "LSODA", grid, args=(p,), rtol=1e-8)
            rows.append(found.y[:, :-1])
            state = found.y[:, -1]
    current, speed = np.concatenate(rows, axis=1)
    current = np.where(t >= _ONSET, gain, 1.0) * current
    columns = {
        "U": volts(t),
        "load": np.zeros(len(t)),
        "current": current + draw.normal(size=len(t)) * _NOISE["current"],
        "speed": speed + draw.normal(size=len(t)) * _NOISE["speed"],
    }
    return t, np.column_stack([columns[k.path] for k in _engine().signals])


@cache
def _tuned() -> Tuned:
    logs = [_samples(100 + k, 6.0)[1] for k in range(4)]
    return tune(_engine(), _motor().diagnosis_model, logs, _motor().program.digest, 1.0)


def _said(t: np.ndarray, rows: np.ndarray, block: int = 700, **how: object) -> list[Verdict]:
    base = _engine().configured()
    diagnosis = how.get("diagnosis") or _motor().diagnosis(_engine(), _tuned().tuning)
    assert isinstance(diagnosis, Diagnosis)
    out: list[Verdict] = []
    for k in range(0, len(rows), block):
        part = rows[k : k + block]
        out += diagnosis.update(t[k : k + block], base.run(part), part)
    return out


def test_slopes_are_those_of_the_closed_form() -> None:
    # steady: r1 = U - R i - k w, r2 = k i - f w - load (up to a factor that stays the same)
    facts = _motor().diagnosis_model
    known = hypotheses(_engine(), facts.faults, facts.units, {})
    nominal = facts.nominal
    rows = np.tile([[0.0, 9.0, 0.3, 90.0]], (3000, 1))
    at = {(h.fault, h.kind): k for k, h in enumerate(known)}
    slopes = Bank(_engine().configured(), known, nominal).run(rows)[-1]
    r1 = slopes[:, 0] / slopes[at["U", "offset"], 0]
    assert r1[at["R", "value"]] == pytest.approx(-0.3, rel=1e-6)
    assert r1[at["k", "value"]] == pytest.approx(-90.0, rel=1e-6)
    assert r1[at["U", "gain"]] == pytest.approx(9.0, rel=1e-6)
    assert r1[at["current", "gain"]] == pytest.approx(-_R * 0.3, rel=1e-6)
    assert r1[at["speed", "offset"]] == pytest.approx(-_K, rel=1e-6)
    r2 = slopes[:, 1] / slopes[at["load", "offset"], 1]
    assert r2[at["f", "value"]] == pytest.approx(90.0, rel=1e-6)
    assert r2[at["current", "offset"]] == pytest.approx(-_K, rel=1e-6)
    assert abs(r1[at["f", "value"]]) + abs(r2[at["R", "value"]]) < 1e-9


def test_a_bank_that_begins_later_goes_on_from_what_was() -> None:
    # a change at the moment t0 moves the filtered residual like a step through its own filter
    facts = _motor().diagnosis_model
    known = [h for h in hypotheses(_engine(), facts.faults, facts.units, {}) if h.fault == "U"]
    rows = np.tile([[0.0, 9.0, 0.3, 90.0]], (2000, 1))
    engine = _engine().configured(bounds=False)
    engine.run(rows[:1000])
    late = Bank(engine, known, {}).run(rows[1000:])[:, 0, 0]
    steps = np.tile([[0.0, 9.0, 0.3, 90.0]], (2000, 1))
    steps[1000:, 1] += 1.0
    one, other = _engine().configured(), _engine().configured()
    true = one.run(steps).value[1000:, 0] - other.run(rows).value[1000:, 0]
    assert late == pytest.approx(true, rel=1e-6, abs=1e-9)
    assert abs(late[0]) < 0.1 * abs(late[-1])


def test_healthy_motors_are_quiet() -> None:
    for seed in range(3):
        assert [v.event for v in _said(*_samples(seed))] == ["warm-up"]


@pytest.mark.parametrize(
    ("wrong", "gain", "fault", "size"),
    [
        ({"R": _R * 1.6}, 1.0, "R", 0.6 * _R),
        ({"f": _F * 2.0}, 1.0, "f", _F),
        ({"k": _K * 0.7}, 1.0, "k", -0.3 * _K),
        ({}, 0.6, "current", -40.0),  # per cent
    ],
)
def test_a_fault_is_named_with_its_size(
    wrong: dict[str, float], gain: float, fault: str, size: float
) -> None:
    said = _said(*_samples(11, 8.0, wrong, gain))
    alarm = next(v for v in said if v.event == "fault")
    assert 0.0 < alarm.time - _ONSET < 0.5
    last = said[-1]
    groups = {f: g for g in _motor().diagnosis_model.groups for f in g}
    assert last.group == groups[fault]
    own = next(c for c in last.candidates if c.fault == fault)
    assert own.size == pytest.approx(size, rel=0.3)
    assert last.since is not None and last.since == pytest.approx(_ONSET, abs=0.1)


def test_blocks_do_not_matter() -> None:
    t, rows = _samples(12, 6.0, {"f": _F * 2.0})
    one = _said(t, rows, 6000)
    assert [v.event for v in one] == ["warm-up", "fault", *[v.event for v in one[2:]]]
    for block in (37, 1000):
        other = _said(t, rows, block)
        assert [(v.event, v.time, v.group) for v in other] == [
            (v.event, v.time, v.group) for v in one
        ]


def test_nothing_poisons_it() -> None:
    t, rows = _samples(13, 8.0)
    rows[3000, 2] = np.nan
    rows[3500, 3] = np.inf
    rows[4000:4200] = np.nan
    assert [v.event for v in _said(t, rows)] == ["warm-up"]


def test_a_state_is_plain_json_and_keeps_the_fault() -> None:
    t, rows = _samples(14, 8.0, {"R": _R * 1.6})
    first = _motor().diagnosis(_engine(), _tuned().tuning)
    said = _said(t[:6000], rows[:6000], diagnosis=first)
    assert said[-1].group
    state = json.loads(json.dumps(first.state()))
    second = _motor().diagnosis(_engine(), _tuned().tuning)
    second.resume(state)
    later = _said(t[6000:], rows[6000:], diagnosis=second)
    assert not [v for v in later if v.event == "fault"]  # it has been said
    assert [v.group for v in later if v.group][-1:] in ([], [said[-1].group])


def test_without_a_tuning_noise_is_learned() -> None:
    diagnosis = _motor().diagnosis(_engine())
    t, rows = _samples(15, 14.0)
    settled, watched = _said(t, rows, diagnosis=diagnosis)
    assert settled.event == watched.event == "warm-up"
    assert settled.time < 0.5
    assert f"until {watched.time:.3f} s" in settled.message
    assert watched.message == "r1 and r2 are watched from now on"
    faulty = rows.copy()
    diagnosis = _motor().diagnosis(_engine())
    late = t >= 9.0
    faulty[late, 2] *= 0.5
    said = _said(t, faulty, diagnosis=diagnosis)
    assert [v.event for v in said][:3] == ["warm-up", "warm-up", "fault"]
    assert "current" in said[-1].group


def test_what_is_sure_to_show_does() -> None:
    shown = {(s.hypothesis.fault, s.hypothesis.kind): s for s in _tuned().shown}
    for fault, nominal in (("R", _R), ("f", _F)):
        size = shown[fault, "value"].size
        assert size is not None
        for seed in (21, 22):
            said = _said(*_samples(seed, 8.0, {fault: nominal + 1.2 * size}))
            alarm = next(v for v in said if v.event == "fault")
            assert alarm.time - _ONSET < 2.5


def test_a_tuning_of_another_model_is_refused() -> None:
    tuning = _tuned().tuning
    with pytest.raises(ValueError, match="another model"):
        _motor().diagnosis(_engine(), tuning._replace(model="other"))
    with pytest.raises(ValueError, match="rad/s"):
        _motor().diagnosis(_engine(), tuning._replace(bandwidth=3.0))
    with pytest.raises(ValueError, match="it is for 50 samples a second, and these come at"):
        _motor().diagnosis(_engine(), tuning._replace(rate=50.0))
    with pytest.raises(ValueError, match="warm-up"):
        tune(_engine(), _motor().diagnosis_model, [np.zeros((5, 4))], "x", 1.0)


def test_what_is_remembered_are_rows_and_not_the_samples_that_they_were_cut_from() -> None:
    t, rows = _samples(16, 6.0, {"f": _F * 2.0})
    diagnosis = _motor().diagnosis(_engine(), _tuned().tuning)
    assert [v for v in _said(t, rows, 6000, diagnosis=diagnosis) if v.event == "fault"]
    kept = [x for row in diagnosis._past for x in row]
    arrays = [x for x in kept if isinstance(x, np.ndarray)]
    assert len(arrays) > 20
    assert all(x.base is None for x in arrays)
