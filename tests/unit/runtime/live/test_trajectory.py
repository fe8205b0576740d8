"""Dead reckoning against arcs that are known in closed form."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from bondgraph.runtime.simulation.dead_reckoning import Desired, Reckoning
from bondgraph.runtime.simulation.parameters import Values
from tests.unit.runtime.live.rover import TRACK, TURN, rover, written

T = np.linspace(0.0, 4.0, 801)
RIGHT, LEFT, WHEEL = 0.5, 0.3, 0.1  # m/s, m/s, m
YAW = (RIGHT - LEFT) / TRACK  # rad/s
RADIUS = (RIGHT + LEFT) / 2 / YAW


def _arc(t: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    return RADIUS * np.sin(YAW * t), RADIUS * (1 - np.cos(YAW * t))


def _signals(first: float = 0.0) -> dict[str, np.ndarray]:
    """What the sensors of a rover on an arc show; counters that began at `first`."""
    counts = {
        f"turn[{j}]": np.floor(first + v / WHEEL * T * TURN / (2 * np.pi) + 0.3)
        for j, v in ((1, RIGHT), (2, LEFT))
    }
    return counts | {"v[1]": np.full(len(T), RIGHT), "v[2]": np.full(len(T), LEFT)}


@pytest.mark.parametrize("first", [0.0, 1e6, 2.0**31 - 500])
def test_an_arc_is_reckoned_to_the_resolution_of_the_encoders(first: float) -> None:
    signals = _signals(first)
    for name in ("turn[1]", "turn[2]"):  # a counter of 32 bits runs over
        signals[name] = (signals[name] + 2.0**31) % 2.0**32 - 2.0**31
    c = rover()
    found = Reckoning(c.equations, ["x", "y", "heading"], Values(c.graph)).feed(T, signals)
    count = 2 * np.pi / TURN * WHEEL  # m of way
    x, y = _arc(T)
    np.testing.assert_allclose(found["heading"], YAW * T, atol=3 * count / TRACK)
    far = 3 * count + 3 * count / TRACK * float(T[-1]) * RIGHT
    np.testing.assert_allclose(found["x"], x, atol=far)
    np.testing.assert_allclose(found["y"], y, atol=far)


def test_samples_in_any_portions_with_some_missing() -> None:
    c = rover()
    signals = _signals()
    signals["v[1]"] = np.where(np.arange(len(T)) % 7 == 3, np.nan, signals["v[1]"])
    whole = Reckoning(c.equations, ["x", "y"], Values(c.graph)).feed(T, signals)
    reckoning = Reckoning(c.equations, ["x", "y"], Values(c.graph))
    parts = [
        reckoning.feed(T[a:b], {n: v[a:b] for n, v in signals.items()})
        for a, b in ((0, 1), (1, 1), (1, 300), (300, 801))
    ]
    for name in ("x", "y"):
        joined = np.concatenate([p[name] for p in parts])
        np.testing.assert_array_equal(joined, whole[name])
    x, _ = _arc(T)
    assert abs(whole["x"][-1] - x[-1]) < 2e-3


def test_the_error_of_the_sum_falls_with_the_square_of_the_step() -> None:
    c = rover()
    errors = []
    for n in (41, 81):
        t = np.linspace(0.0, 4.0, n)
        signals = {"turn[1]": RIGHT / WHEEL * t, "turn[2]": LEFT / WHEEL * t}
        signals |= {"v[1]": np.full(n, RIGHT), "v[2]": np.full(n, LEFT)}
        found = Reckoning(c.equations, ["x"], Values(c.graph), counts=False).feed(t, signals)
        errors.append(abs(found["x"][-1] - _arc(t)[0][-1]))
    assert errors[0] / errors[1] == pytest.approx(4.0, rel=0.05)


def test_the_desired_path_of_a_scenario(tmp_path: Path) -> None:
    c = rover()
    scenario = c.scenario(written(tmp_path)[1])
    values = Values(c.graph)
    wanted = Reckoning(c.equations, ["x", "y", "heading"], values, counts=False)
    found = wanted.feed(T, Desired(c.equations, scenario, values).at(T))
    yaw = WHEEL * (5 - 4) / TRACK
    np.testing.assert_allclose(found["heading"], yaw * T, atol=1e-12)
    np.testing.assert_allclose(found["x"], 0.45 / yaw * np.sin(yaw * T), atol=1e-5)


def test_what_no_sensor_tells_is_said() -> None:
    import bondgraph
    from bondgraph.text.source import Source

    model = """bg 1
model Coasting {
    input F : N
    1:a { <- Se:F; -> I:m = 1 kg; -> C:s = 1 m/N; -> De:e }
    1:b { <- Se:G = 1 N; -> I:n = 2 kg; -> R:r = 1 N.s/m }
    let x = int(b.f)
}
"""
    model = model.replace("; -> De:e", "; -> Df:v")
    c = bondgraph.Compilation(Source("c.bg", model))
    reckoning = Reckoning(c.equations, ["x"], Values(c.graph))
    assert reckoning.names == () and "x" in reckoning.lacking
