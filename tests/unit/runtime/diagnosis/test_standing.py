"""Healthy logs that stand apart: how far, and what a watch makes of it."""

from __future__ import annotations

import json
import math
from functools import cache

import numpy as np
import pytest

from bondgraph.runtime.diagnosis.calibration import tune
from bondgraph.runtime.diagnosis.cusum import on_board
from bondgraph.runtime.diagnosis.standing import FIRST, Levels, apart, followed
from bondgraph.runtime.diagnosis.tuning import UNKNOWN, Limit, Tuning
from bondgraph.runtime.diagnosis.wander import Wander
from bondgraph.runtime.log import Array
from bondgraph.runtime.monitoring.verdict import Verdict
from tests.unit.runtime.diagnosis.tank import tank


def _logs(draw: np.random.Generator, count: int, between: float) -> list[Array]:
    return [draw.normal(between * draw.normal(), 1.0, 80) for _ in range(count)]


@pytest.mark.parametrize("count", [3, 5, 12])
def test_one_more_log_stands_within_the_room_for_it(count: int) -> None:
    """Drawn with a deviation of 2 between logs: 999 of 1000 should be, whatever their number."""
    draw, outside = np.random.default_rng(4), 0
    for _ in range(400):
        *logs, other = _logs(draw, count + 1, 2.0)
        found, stands = apart(logs)
        assert abs(stands.sum()) < 1e-9
        mean = np.mean([one.mean() for one in logs])
        outside += found > 0.0 and abs(other.mean() - mean) > UNKNOWN * found
    assert outside <= 3


def test_logs_of_one_mean_stand_apart_by_what_their_means_are_off() -> None:
    """Where they are many, by the deviation of a mean; one log alone tells nothing."""
    found, _ = apart(_logs(np.random.default_rng(5), 200, 0.0))
    assert found == pytest.approx(3.29 / UNKNOWN / np.sqrt(80.0), rel=0.2)
    assert apart(_logs(np.random.default_rng(5), 1, 3.0))[0] == 0.0
    assert apart([np.full(50, np.nan), np.ones(50)])[0] == 0.0


def test_where_a_machine_stands_is_known_after_some_rows_as_their_mean() -> None:
    """By a prior that is wide beside the noise; it is as wide as that where logs tell nothing."""
    limits = np.array([Limit(1.0, 1.0, 4.0, 9.0, apart=50.0), Limit(1.0, 1.0, 4.0, 9.0)])
    levels, at = Levels.tuned(limits.astype(float)), np.zeros(2)
    values = np.random.default_rng(1).normal(7.0, 1.0, 40)
    known = np.ones(2, dtype=bool)
    for k, value in enumerate(values):
        first = UNKNOWN * np.sqrt([2501.0, 1.0])
        rest = UNKNOWN / np.sqrt([k + 1 / 2501.0, k + 1.0])
        assert levels.unsure.tolist() == pytest.approx((first if k < FIRST else rest).tolist())
        levels.ahead(alarmed=False)
        at += levels.learn(float(k), np.full(2, value) - at, levels.unsure, known)
    assert at.tolist() == pytest.approx([values.mean(), values.sum() / 41.0], abs=1e-3)
    other = Levels.tuned(limits.astype(float))
    other.resume(json.loads(json.dumps(levels.state())))
    assert other.state() == levels.state()


def test_no_row_tells_twice_and_later_ones_only_when_they_are_known_to_be_healthy() -> None:
    limits = np.array([Limit(1.0, 1.0, 4.0, 9.0, step=0.1, most=0.2)], dtype=float)
    levels, known, at = Levels.tuned(limits), np.ones(1, dtype=bool), []
    for k in range(2 * FIRST):
        levels.ahead(alarmed=False)
        own = [levels.learn(k, np.ones(1), levels.unsure, known, first=True) for _ in range(2)]
        at.append([bool(moved[0]) for moved in own])
    assert at == [[True, False]] * FIRST + [[False, False]] * FIRST
    moved = [levels.learn(k, np.ones(1), levels.unsure, known)[0] for k in range(2 * FIRST)]
    assert not any(moved[:FIRST]) and all(moved[FIRST:])


def test_what_a_bound_has_room_for_otherwise_tells_nothing_of_a_level() -> None:
    """A residual that a parameter may move by 20 deviations is no level of its own."""
    limits = np.array([Limit(1.0, 1.0, 4.0, 9.0)], dtype=float)
    levels, known = Levels.tuned(limits), np.ones(1, dtype=bool)
    (moved,) = levels.learn(0.0, np.array([10.0]), levels.unsure + UNKNOWN * 20.0, known)
    assert moved == pytest.approx(10.0 / (1.0 + 1.0 + 400.0))


def test_what_goes_further_than_it_wanders_is_taken_back() -> None:
    """After n rows a walk of step s is s sqrt(n) away: 4 times that, and the noise of a row."""
    limits = np.array([Limit(1.0, 1.0, 4.0, 9.0)], dtype=float)
    for rate, drifts in ((0.002, False), (0.05, True)):
        levels, known = Levels(1), np.ones(1, dtype=bool)
        at = levels.begin(0, Wander(0.1, 0.1, 3.0, 0.01, 1.0, 1.0, 1.0), 0.0, 2.5, 100)
        assert at == 3.0
        for k in range(1000):
            levels.ahead(alarmed=False)
            value = 3.0 + rate * k - at
            at += float(levels.learn(k, np.array([value]), levels.unsure, known)[0])
            (back,) = levels.drifted(limits)
            if back:
                assert at + back == pytest.approx(3.0)
                assert -back > 4.0 * np.hypot(1.0, 0.1 * np.sqrt(k)) - 0.2
                break
        assert (k < 500) == drifts


@pytest.mark.parametrize("step", [0.05, 0.3, 2.0])
def test_of_a_fault_that_lasts_less_and_less_is_beside_the_level_that_is_followed(
    step: float,
) -> None:
    """The gain K in the end is by the equation of Riccati: 1 - K with each row that tells."""
    noise = 1.5
    variance = step**2 / 2.0 + math.sqrt(step**4 / 4.0 + (step * noise) ** 2)
    kept = 1.0 - variance / (variance + noise**2)
    limit = Limit(noise, 1.0, 4.0, 9.0, step=step)
    deviation, share = followed(np.array([limit], dtype=float), 12, wait=4)
    assert deviation[:, 0] == pytest.approx([math.sqrt(variance)] * 12, rel=1e-5)
    assert share[:, 0] == pytest.approx([kept ** max(0, row - 4) for row in range(12)], rel=1e-5)


def test_code_that_learns_nothing_has_room_for_all_places() -> None:
    plain, stray = Limit(1.0, 1.0, 4.0, 9.0), Limit(1.0, 1.0, 4.0, 9.0, apart=3.0, goes=0.7)
    assert on_board(stray, 0.5) == on_board(plain, 0.5)._replace(bound=0.5 + UNKNOWN * 3.0 + 0.7)


def _run(seed: int, leak: float = 0.0, rows: int = 1500) -> Array:
    """A tank whose gauge is off by another 0.1 Pa each run, ten times its noise; a `leak` of
    m^3/s from 900 s on."""
    draw, level, found = np.random.default_rng(seed), 2.0, []
    off = 0.1 * draw.normal()
    for k in range(rows):
        found.append((1.0 + 0.2 * np.sin(0.02 * k), level))
        rest = 2.0 * (found[-1][0] - (leak if k >= 900 else 0.0))
        level = rest + (level - rest) * np.exp(-1.0 / 40.0)
    return np.array(found) + [0.0, off] + draw.normal(size=(rows, 2)) * [0.001, 0.01]


@cache
def _tuning() -> Tuning:
    engine = tank().engine()
    logs = [_run(100 + k) for k in range(5)]
    tuned = tune(engine, tank().diagnosis_model, logs, tank().program.digest, 1.0, window=100.0)
    return tuned.tuning


def _watched(samples: Array) -> list[Verdict]:
    engine, said = tank().engine(), []
    watch = tank().diagnosis(engine, _tuning())
    for k in range(0, len(samples), 100):
        part = samples[k : k + 100]
        said += watch.update(np.arange(k, k + len(part)) * 1.0, engine.run(part), part)
    return said


def test_a_run_that_stands_elsewhere_is_well() -> None:
    """By up to 2 deviations of the places that the logs of the tuning stood at."""
    (limit,) = _tuning().limits.values()
    assert limit.apart > 3.0 * limit.sigma
    for seed in range(10):
        assert not [v for v in _watched(_run(seed)) if v.event == "fault"], seed


def test_what_goes_wrong_later_is_seen_beside_where_it_stands() -> None:
    """Where the logs were taken for noise about one mean, none of these four was."""
    for seed in range(4):
        said = _watched(_run(seed, leak=0.03))
        first = next(v.time for v in said if v.event == "fault")
        assert 900.0 < first < 1000.0, seed
