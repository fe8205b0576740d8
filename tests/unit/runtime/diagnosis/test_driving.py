"""A machine that idles while its noise is learned and works later, driven as never before."""

from __future__ import annotations

import json
import math
from typing import Any

import numpy as np
import pytest

from bondgraph.pipeline import Compilation
from bondgraph.runtime.diagnosis.driving import Driving
from bondgraph.runtime.log import Array
from bondgraph.runtime.monitoring.verdict import Verdict
from bondgraph.text.source import Source

_TEXT = """bg 1
model Tank {
    input q : m^3/s
    param C = 20 {tolerance}
    param R = 2 {tolerance}
    0:liquid { <- Sf:q; -> C:C; -> R:R; -> De:p }
}
"""


def _machine(tolerance: str = "") -> Compilation:
    text = _TEXT.replace("{tolerance}", tolerance)
    return Compilation(Source("tank.bg", text)).with_options(rate=1.0, bandwidth=0.2)


def _samples(seed: int, weak: float = 1.0, idle: int = 600, fault: int = 10**6) -> Array:
    """Of (q, p) a second apart: a tank with a resistance 6 % off that idles, then works.

    Its level by the exact solution between samples; `weak` times the resistance from `fault` on.
    """
    draw = np.random.default_rng(seed)
    count = 2400
    steps = np.repeat(draw.uniform(0.2, 1.8, count // 40), 40)
    flow = np.where(np.arange(count) < idle, 1.0, steps)
    level, rows = 2.12, []
    for k, q in enumerate(flow.tolist()):
        rows.append((q, level))
        resistance = 2.12 * (weak if k >= fault else 1.0)
        level = q * resistance + (level - q * resistance) * math.exp(-1.0 / (20.0 * resistance))
    told = np.array(rows)
    told[1:, 0] = 0.5 * (told[1:, 0] + told[:-1, 0])  # as a line between samples adds up to
    return told + draw.normal(size=told.shape) * [0.001, 0.002]


def _watched(machine: Compilation, samples: Array) -> list[Verdict]:
    engine = machine.engine()
    assert [k.path for k in engine.signals] == ["q", "p"]
    watch = machine.diagnosis(engine)
    base, said = engine.configured(), []
    for k in range(0, len(samples), 15):
        part = samples[k : k + 15]
        said += watch.update(np.arange(k, k + len(part)) * 1.0, base.run(part), part)
    return said


@pytest.mark.parametrize("seed", range(5))
def test_a_machine_that_idled_is_learned_anew_when_it_works(seed: int) -> None:
    said = _watched(_machine(), _samples(seed))
    (anew,) = [v for v in said if "driven as never before" in v.message]
    assert 585.0 <= anew.time <= 630.0


def test_a_machine_that_idled_is_in_alarm_less_than_once_an_hour() -> None:
    said = [v for seed in range(12) for v in _watched(_machine(), _samples(seed))]
    # in 8 hours: with five it might be one an hour or more, at 95 %
    assert sum(v.event == "fault" for v in said) <= 4


@pytest.mark.parametrize("added", [0.5, 3.0, -3.0])
@pytest.mark.parametrize("seed", range(3))
def test_an_input_that_is_read_wrongly_is_no_motion(seed: int, added: float) -> None:
    """The machine idles on, and the zero of its flow meter jumps far beyond what it ever told."""
    samples = _samples(seed, idle=2400)
    samples[1500:, 0] += added
    said = _watched(_machine(), samples)
    (fault,) = [v for v in said if v.event == "fault"]
    assert fault.time > 1500.0 and fault.since is not None
    assert abs(fault.since - 1500.0) <= 30.0
    told = [{c.fault: c for c in v.candidates} for v in said if v.candidates]
    # at rest a resistance that is lower looks the same; flow that is not there is told by its sign
    assert told and all(own["q"].probability > 0.4 for own in told)
    flow = [own["q"].size for own in told if own["q"].unit == "m^3/s"]
    assert flow and flow[-1] == pytest.approx(-added, rel=0.1)


def test_a_fault_of_a_machine_that_works_is_seen() -> None:
    said = _watched(_machine(), _samples(1, weak=0.6, fault=1500))
    (fault,) = [v.time for v in said if v.event == "fault"]
    assert 1500.0 < fault < 1620.0


def test_with_tolerances_nothing_is_learned_anew() -> None:
    """The adaptive threshold grows with the motion."""
    said = _watched(_machine("+- 10%"), _samples(2))
    assert [v for v in said if v.event == "fault" or "never before" in v.message] == []


def test_with_tolerances_it_is_unsure_until_it_is_learned_how_it_works() -> None:
    machine = _machine("+- 10%")
    engine = machine.engine()
    watch, base = machine.diagnosis(engine), engine.configured()
    unsure, samples = [], _samples(2)
    for k in range(0, len(samples), 15):
        part = samples[k : k + 15]
        watch.update(np.arange(k, k + len(part)) * 1.0, base.run(part), part)
        state = watch.state()["driving"]
        if state and state["unsure"] == [True]:
            unsure.append(k)
    assert 585 <= unsure[0] <= 630
    assert unsure == list(range(unsure[0], unsure[-1] + 1, 15))
    assert 8 * 15 <= unsure[-1] - unsure[0] <= 16 * 15, "ten rows, and such as are held back"


@pytest.mark.parametrize("seed", range(3))
def test_a_change_within_its_tolerance_is_seen(seed: int) -> None:
    """What counts is what this machine did: it was 6 % off before, and 10 % are tolerated."""
    said = _watched(_machine("+- 10%"), _samples(seed, weak=0.94, fault=1500))
    (fault,) = [v.time for v in said if v.event == "fault"]
    assert 1500.0 < fault < 1700.0


def _learned(samples: Array, driving: Driving) -> None:
    """Rows of ten samples of an input that adds three times itself to the one residual."""
    for k in range(0, len(samples), 10):
        row = samples[k : k + 10]
        driving.anew(row, np.array([math.inf]))
        driving.learned(row, np.array([True]), 3.0 * row.mean(axis=0)[:, None])


def test_twice_the_range_that_matters_is_driven_as_never_before() -> None:
    learned = np.random.default_rng(1).uniform(4.0, 5.0, (400, 1))
    limit = np.array([0.2])
    for value, anew in ((5.9, False), (6.2, True), (2.5, True)):
        driving = Driving([0], np.ones((1, 1), dtype=bool))
        _learned(learned, driving)
        other = Driving([0], np.ones((1, 1), dtype=bool))
        other.resume(json.loads(json.dumps(driving.state())))
        for one in (driving, other):
            assert one.anew(np.array([[value]]), limit).tolist() == [anew]
        # a twentieth of three times what it moves by does not matter for a wider limit
        assert not driving.anew(np.array([[value]]), np.array([1.0])).any()


def test_what_a_residual_does_not_read_does_not_matter() -> None:
    driving = Driving([0], np.zeros((1, 1), dtype=bool))
    _learned(np.ones((100, 1)), driving)
    assert not driving.anew(np.array([[99.0]]), np.array([0.0])).any()


def test_a_sample_without_a_value_tells_nothing() -> None:
    driving = Driving([0], np.ones((1, 1), dtype=bool))
    _learned(np.random.default_rng(1).uniform(4.0, 5.0, (100, 1)), driving)
    assert not driving.anew(np.array([[math.nan], [math.inf]]), np.array([0.1])).any()


@pytest.mark.parametrize("state", [{}, {"range": [1.0], "effect": [[1.0]]}, {"range": None}])
def test_a_state_of_another_kind_is_refused(state: Any) -> None:
    with pytest.raises((KeyError, TypeError, ValueError)):
        Driving([0], np.ones((1, 1), dtype=bool)).resume(state)
