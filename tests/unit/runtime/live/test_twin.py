"""Machines that go on step by step, against solutions in closed form."""

from __future__ import annotations

import math
from itertools import islice, pairwise
from pathlib import Path

import numpy as np
import pytest

from bondgraph.compilation import Compilation
from bondgraph.runtime.live.twin import Twin
from bondgraph.runtime.log import joined
from bondgraph.runtime.simulation.run import Robot
from bondgraph.runtime.simulation.scenario import Fault, Instrument, Scenario
from bondgraph.text.source import Source
from tests.unit.runtime.live.rover import FRICTION, MASS, TURN, rover, written

T = np.arange(401) / 200.0


def _fault(target: str, op: str, value: float = 0.0, **more: float) -> Fault:
    told = {"at": 0.0, "until": math.inf, "ramp": 0.0, "period": 0.0, "duty": 1.0, **more}
    return Fault(target, op, value, **told, label="x")  # type: ignore[arg-type]


def _speed(t: np.ndarray, force: float, friction: float, start: float = 0.0) -> np.ndarray:
    """m v' = F - f v."""
    end = force / friction
    return end + (start - end) * np.exp(-friction / MASS * t)


def _run(twin: Twin, a: int, b: int, force: float = 1.0) -> tuple[np.ndarray, np.ndarray]:
    """True and read speed of the first wheel under a constant force."""
    time = T[a:b]
    told = {"F[1]": np.full(b - a, force), "F[2]": np.full(b - a, force)}
    rows, read = twin.advance(time, told)
    return np.array([r["v[1]"] for r in rows]), read["v[1]"]


def test_a_twin_follows_its_commands_in_any_portions() -> None:
    c = rover()
    twin = Twin(c.equations, c.integral, Scenario("s"))
    cuts = [0, 1, 7, 50, 51, 300, 401]
    found = np.concatenate([_run(twin, a, b)[0] for a, b in pairwise(cuts)])
    np.testing.assert_allclose(found, _speed(T, 1.0, FRICTION), atol=1e-5)


def test_a_fault_that_is_injected_and_taken_back() -> None:
    c = rover()
    twin = Twin(c.equations, c.integral, Scenario("s"))
    before = _run(twin, 0, 101)[0]
    twin.inject(_fault("f[1]", "*=", 4.0))
    during = _run(twin, 101, 201)[0]
    twin.clear()
    after = _run(twin, 201, 401)[0]
    first = _speed(T[:101], 1.0, FRICTION)
    second = _speed(T[101:201] - T[100], 1.0, 4 * FRICTION, first[-1])
    third = _speed(T[201:] - T[200], 1.0, FRICTION, second[-1])
    np.testing.assert_allclose(before, first, atol=1e-5)
    np.testing.assert_allclose(during, second, atol=1e-5)
    np.testing.assert_allclose(after, third, atol=1e-5)


def test_sensors_that_stick_drift_and_fall_out() -> None:
    c = rover()
    twin = Twin(c.equations, c.integral, Scenario("s"))
    _run(twin, 0, 101)
    twin.inject(_fault("v[1]", "stuck"))
    _, read = _run(twin, 101, 201)
    assert np.ptp(read) == 0.0
    np.testing.assert_allclose(read[0], _speed(T[100:101], 1.0, FRICTION), atol=1e-4)
    twin.clear()
    twin.inject(_fault("v[1]", "+=", 0.1))
    _, read = _run(twin, 201, 301)
    np.testing.assert_allclose(read - _speed(T[201:301], 1.0, FRICTION), 0.1, atol=1e-5)
    twin.inject(_fault("v[1]", "missing"))
    assert np.isnan(_run(twin, 301, 401)[1]).all()


def test_after_a_long_silence_it_goes_on_where_it_was() -> None:
    c = rover()
    twin = Twin(c.equations, c.integral, Scenario("s"))
    speed = _run(twin, 0, 101)[0][-1]
    rows, _ = twin.advance(np.array([1000.0]), {"F[1]": np.ones(1), "F[2]": np.ones(1)})
    assert rows[0]["v[1]"] == pytest.approx(speed)
    rows, _ = twin.advance(np.array([3.0, 3.1]), {"F[1]": np.ones(2), "F[2]": np.ones(2)})
    assert rows[1]["v[1]"] == pytest.approx(
        _speed(np.array([0.1]), 1.0, FRICTION, speed)[0], rel=1e-4
    )


def test_a_switch_turns_when_the_samples_say_so() -> None:
    """A capacitor that is charged through a switch, and empties itself while that is off."""
    c = Compilation(
        Source(
            "chopper.bg",
            """bg 1
model Chopper {
    input U : V
    input on : bool
    0:out { -> C:C1 = 1 mF; -> R:R1 = 100 Ohm; -> De:v }
    1:sw when on { <- Se:U; -> R:Rs = 10 Ohm; -> out }
}
""",
        )
    )
    twin = Twin(c.equations, c.integral, Scenario("s"))
    on = ((T < 0.5) | (T >= 1.0)).astype(float)
    found = [
        twin.advance(T[a:b], {"U": np.full(b - a, 10.0), "on": on[a:b]})[0]
        for a, b in ((0, 30), (30, 250), (250, 401))
    ]
    v = np.array([row["v"] for rows in found for row in rows])
    end, charging, emptying = 100 / 11, 1e-3 / (1 / 10 + 1 / 100), 0.1
    first = end * (1 - np.exp(-T / charging))
    at = end * (1 - math.exp(-0.5 / charging))
    second = at * np.exp(-(T - 0.5) / emptying)
    third = end + (at * math.exp(-0.5 / emptying) - end) * np.exp(-(T - 1.0) / charging)
    truth = np.where(T < 0.5, first, np.where(T < 1.0, second, third))
    np.testing.assert_allclose(v, truth, atol=2e-5)


def test_a_robot_never_stops_and_its_counts_go_on(tmp_path: Path) -> None:
    c = rover()
    scenario = c.scenario(written(tmp_path)[1])
    quiet = scenario._replace(instruments={}, inputs={**scenario.inputs})
    robot = Robot(c.equations, c.integral, quiet)
    log = joined(islice(robot.logs(), 1100))  # over the end of a window
    np.testing.assert_allclose(log.time, np.arange(log.rows) / 200.0, atol=1e-9)
    assert log.rows > 2 * robot.readings.size
    # F[1] = 1 + sin(2 t)/2: the forced solution of a first-order lag
    t = log.time
    lag = FRICTION / MASS
    swing = 0.5 / MASS * (lag * np.sin(2 * t) - 2 * np.cos(2 * t)) / (lag**2 + 4)
    start = 1 / FRICTION + swing[0]
    truth = 1 / FRICTION + swing - start * np.exp(-lag * t)
    np.testing.assert_allclose(log.columns["v[1]"], truth, atol=2e-5)
    angle = np.concatenate([[0], np.cumsum((truth[1:] + truth[:-1]) / 2 / 200.0)]) / 0.1
    counts = angle * TURN / (2 * np.pi)
    assert np.abs(log.columns["turn[1]"] - counts).max() < 2.0


def test_slow_noisy_instruments_over_windows() -> None:
    c = rover()
    scenario = Scenario("s", instruments={"v[1]": Instrument(noise=0.01, rate=50.0)})
    scenario = scenario._replace(sampling=scenario.sampling._replace(rate=200.0, lost=0.1))
    log = joined(islice(Robot(c.equations, c.integral, scenario).logs(), 1100))
    assert 0.88 < log.rows / (log.time[-1] * 200.0) < 0.92
    changes = np.flatnonzero(np.diff(log.columns["v[1]"]))
    assert len(changes) <= log.time[-1] * 50.0  # every fourth sample is a new one
    assert np.std(log.columns["v[1]"]) == pytest.approx(0.01, rel=0.1)
