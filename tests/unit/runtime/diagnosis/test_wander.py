"""Levels that wander: what rows tell of them, the filter that follows, a machine that drifts."""

from __future__ import annotations

import json
import math
from pathlib import Path

import numpy as np
import pytest

import bondgraph
from bondgraph.runtime.diagnosis.standing import Levels
from bondgraph.runtime.diagnosis.wander import NONE, Wander, wander
from bondgraph.runtime.log import Array
from bondgraph.runtime.monitoring.verdict import Verdict
from tests.unit.runtime.diagnosis.tank import tank

_MODELS = Path(__file__).parents[4] / "models"


def _drawn(seed: int, rows: int, step: float, kept: float = 0.0) -> Array:
    """A walk beside noise of variance 1 with a correlation from row to row."""
    draw = np.random.default_rng(seed)
    noise, own = np.empty(rows), draw.normal()
    for k in range(rows):
        noise[k] = own = kept * own + np.sqrt(1.0 - kept**2) * draw.normal()
    return noise + np.cumsum(step * draw.normal(size=rows))


def _steps(rows: int, step: float, kept: float = 0.0) -> Array:
    return np.array([wander(_drawn(seed, rows, step, kept)).step for seed in range(40)])


@pytest.mark.parametrize("step", [0.1, 0.3, 1.0])
def test_the_step_of_a_walk_is_found(step: float) -> None:
    found = _steps(200, step)
    assert 0.75 * step < np.sqrt(np.mean(found**2)) < 1.3 * step


def test_noise_that_stands_still_has_room_while_few_rows_tell() -> None:
    """It shrinks faster than one over the rows: by a walk of step s they were off by s sqrt(n)."""
    few, some, many = (float(np.sqrt(np.mean(_steps(n, 0.0) ** 2))) for n in (20, 80, 320))
    assert many < some / 4.0 < few / 12.0
    assert some * np.sqrt(80.0) < 0.5


def test_noise_with_a_memory_is_no_walk_once_rows_show_that_it_ends() -> None:
    assert float(np.median(_steps(400, 0.0, kept=0.7))) < 0.03


@pytest.mark.parametrize(("scale", "shift"), [(1e-6, 0.0), (3.0, 1e4), (-2.0, -5.0)])
def test_units_and_zeros_are_no_matter(scale: float, shift: float) -> None:
    values = _drawn(3, 60, 0.2)
    one, other = wander(values), wander(scale * values + shift)
    assert other.level == pytest.approx(scale * one.level + shift, rel=1e-6)
    assert other.less == pytest.approx(one.less, rel=1e-6)
    for name in ("step", "most", "noise"):
        assert getattr(other, name) == pytest.approx(abs(scale) * getattr(one, name), rel=1e-5)


def test_what_a_walk_remembers_about_a_mean_is_no_noise_beside_its_level() -> None:
    """Steps of one deviation a row: about a mean 400 rows are off by 10, for a hundred rows."""
    walks, white = wander(_drawn(3, 400, 1.0)), wander(_drawn(3, 400, 0.0))
    assert walks.lasting(100.0, 2.0) == max(walks.noise, math.sqrt(2.0) * walks.alone) < 2.0
    assert white.lasting(1.2, 2.0) == white.less * 1.2 > 1.1
    assert NONE.lasting(100.0, 2.0) == 100.0


def test_rows_without_a_value_let_it_wander_on() -> None:
    values = _drawn(3, 60, 0.3)
    gap = wander(np.append(values, np.full(20, np.nan)))
    whole = wander(values)
    assert gap.step == pytest.approx(whole.step, rel=1e-9) and gap.level == whole.level
    # not exactly: the mean of a product is not that of its factors
    assert gap.variance - whole.variance == pytest.approx(20.0 * whole.step**2, rel=1e-6)


def test_rows_that_tell_nothing() -> None:
    assert wander(np.ones(50)) == wander(np.full(50, np.nan)) == wander(np.arange(4.0)) == NONE


def test_a_level_follows_as_the_best_linear_estimate() -> None:
    """By the covariances of the levels and of the rows, all at once (Gauss and Markov)."""
    before, step, noise, values = 0.5, 0.3, 1.2, np.array([1.0, 2.5, -0.3, 1.7])
    levels, stands = Levels(1), 0.0
    levels.begin(0, Wander(step, step, 0.0, before, noise, 1.0, noise), 0.0, 0.0, 10)
    for time, value in enumerate(values):
        levels.ahead(alarmed=False)
        value -= stands
        stands += _moved(levels, time, value)
    at = np.arange(1, 5)
    own = before + step**2 * np.minimum.outer(at, at)
    found = own[-1] @ np.linalg.solve(own + noise**2 * np.eye(4), values)
    left = own[-1, -1] - own[-1] @ np.linalg.solve(own + noise**2 * np.eye(4), own[-1])
    assert stands == pytest.approx(found) and levels.state()[3] == pytest.approx([left])
    other = Levels(1)
    other.resume(json.loads(json.dumps(levels.state())))
    assert other.state() == levels.state()


def _moved(levels: Levels, time: float, value: float) -> float:
    return float(levels.learn(time, np.array([value]), levels.unsure, np.array([True]))[0])


def test_found_once_more_a_level_stands_where_rows_have_told() -> None:
    """What is found then is of rows with parameters that fit them best, which may stand far off."""
    levels = Levels(1)
    stood = levels.begin(0, Wander(0.3, 0.3, 5.5, 0.5, 1.2, 1.0, 1.2), 0.0, 5.0, 10)
    assert stood == 5.5
    for time, value in enumerate((0.2, 0.4)):
        levels.ahead(alarmed=False)
        stood += _moved(levels, time, value)
    (sure,) = levels.state()[3]
    assert levels.begin(0, Wander(0.1, 0.2, -9.0, 0.0, 1.0, 1.0, 1.0), stood, 5.1, 20) == stood
    assert levels.state()[3] == [sure]
    assert levels.begin(0, Wander(0.1, 0.2, -9.0, 7.0, 1.0, 1.0, 1.0), stood, 5.1, 40) == stood
    assert levels.state()[3] == [7.0]  # as little as is known of so many rows
    assert levels.begin(0, NONE, stood, 5.2, 60) == 5.2  # no walk: the mean


def _verdicts(
    seed: int, drift: float, leak: float = 0.0, block: int = 100
) -> list[Verdict]:
    """Of 20 minutes of a tank of which something drains that nobody measures, and wanders by the
    `drift` in a root of a second; a `leak` of m^3/s from 700 s to 1000 s."""
    draw, level, rows = np.random.default_rng(seed), 2.0, []
    drained = np.cumsum(draw.normal(0.0, drift, 1200))
    drained[700:1000] += leak
    for lost in drained.tolist():
        rows.append((1.0, level))
        rest = 2.0 * (1.0 - lost)
        level = rest + (level - rest) * np.exp(-1.0 / 40.0)
    samples = np.array(rows) + draw.normal(size=(1200, 2)) * [0.02, 0.002]
    engine = tank().engine()
    watch, said = tank().diagnosis(engine), []
    for k in range(0, 1200, block):
        part = samples[k : k + block]
        said += watch.update(np.arange(k, k + len(part)) * 1.0, engine.run(part), part)
    return said


def test_a_healthy_machine_that_wanders_is_no_fault() -> None:
    """Where a level was taken for fixed, 8 of these 12 had an alarm."""
    alarms = [any(v.event == "fault" for v in _verdicts(seed, 3e-4)) for seed in range(12)]
    assert sum(alarms) <= 1


def test_how_samples_come_together_is_no_matter() -> None:
    one, other = (_verdicts(1, 3e-4, leak=0.06, block=block) for block in (100, 37))
    assert [v[:3] for v in one] == [v[:3] for v in other]
    assert any(v.event == "cleared" for v in one)


def test_beside_that_a_fault_is_seen_and_is_over_when_it_is_gone() -> None:
    for seed in range(6):
        said = _verdicts(seed, 3e-4, leak=0.06)
        first = next(v.time for v in said if v.event == "fault")
        over = next(v.time for v in said if v.event == "cleared" and v.time > 1000.0)
        assert 700.0 < first < 790.0 and over < 1100.0


def test_a_machine_with_tolerances_whose_parameters_move_with_its_switch_has_no_alarm() -> None:
    """What tolerances do to an oven comes and goes with its heater: neither noise nor a walk."""
    for seed in (2, 3, 4):
        c = bondgraph.compile(_MODELS / "oven.bg", rate=10.0)
        scenario = c.scenario(_MODELS / "scenarios" / "oven_relay.toml")
        log = c.simulate(scenario._replace(faults=(), seed=seed)).log
        engine = c.engine()
        samples = np.column_stack([log.columns[k.path] for k in engine.signals])
        watch, said = c.diagnosis(engine), []
        for k in range(0, len(samples), 1000):
            part = samples[k : k + 1000]
            said += watch.update(log.time[k : k + 1000], engine.run(part), part)
        assert not [v for v in said if v.event == "fault"], seed
