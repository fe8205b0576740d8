"""How large a fault has to be to be told from another: by hand, and in noise that was drawn."""

from __future__ import annotations

import math
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import bondgraph
from bondgraph.cli.main import main
from bondgraph.compilation import Compilation
from bondgraph.ir.program import Program
from bondgraph.runtime.batch import Lanes
from bondgraph.runtime.log import Array
from bondgraph.runtime.separation import Separation, _apart, _white, separation
from bondgraph.runtime.smallest import Situation, noise

_MODELS = Path(__file__).resolve().parents[3] / "models"
_MOTOR = {"U": 6.0, "current": 0.03, "speed": 1000.0}


@pytest.fixture(scope="module")
def motor() -> Compilation:
    return bondgraph.compile(_MODELS / "dc_motor.bg")


def _change(found: Separation, a: str, b: str) -> float:
    change = found.changes[found.faults.index(a)][found.faults.index(b)]
    assert change is not None
    return change


def _sigmas(motor: Compilation, situation: Situation) -> tuple[float, float]:
    one, two = noise(motor.program, situation).values()
    assert one is not None and two is not None
    return one, two


def test_two_residuals_at_rest(motor: Compilation) -> None:
    """r1 = U - R i - k w and r2 = k i - f w - load, each with noise of its own source."""
    i, w = _MOTOR["current"], _MOTOR["speed"]
    situation = Situation(at=_MOTOR, noise={"U": 0.05, "load": 1e-4}, kappa=4.0)
    one, two = _sigmas(motor, situation)
    found = separation(motor.program, {}, situation)
    # R leaves r2 alone; of R a multiple of k takes away what is along (w/one, -i/two)
    assert _change(found, "k", "R") == pytest.approx(4.0 * two / i)
    across = (i / one) * (i / two) / math.hypot(w / one, i / two)
    assert _change(found, "R", "k") == pytest.approx(4.0 / across)
    assert _change(found, "R", "load") == pytest.approx(4.0 * one / i)
    groups = [{found.faults[k] for k in group} for group in found.groups]
    assert {"R", "U"} in groups and {"f", "load"} in groups and {"k"} in groups
    assert "L" not in found.faults and "J" not in found.faults  # nothing moves


def test_tolerances_are_noise_spread_evenly(motor: Compilation) -> None:
    """k is told from R by r2 alone, where f may be off by a tenth; its own is no noise."""
    i, w, f = _MOTOR["current"], _MOTOR["speed"], 1.19e-5
    situation = Situation(at=_MOTOR, noise={"U": 0.05, "load": 1e-4}, kappa=4.0)
    found = separation(motor.program, {"f": 0.1, "k": 0.02}, situation)
    two = math.hypot(_sigmas(motor, situation)[1], 0.1 * f * w / math.sqrt(3))
    assert _change(found, "k", "R") == pytest.approx(4.0 * two / i)


def test_signals_that_move_tell_a_group_apart(motor: Compilation) -> None:
    """R i and L i' enter one residual alone, a quarter of a period apart: neither explains any of
    the other, and noise leaves of each as much as their sizes say, omega to one. The period is
    long beside the memory of the filter, so that its ends matter little."""
    hz = 0.2
    situation = Situation(swing={"current": 0.03}, noise={"U": 0.05}, frequency=hz)
    found = separation(motor.program, {}, situation)
    assert ("L", "R", "U") in motor.signatures.groups
    ratio = _change(found, "R", "L") / _change(found, "L", "R")
    assert ratio == pytest.approx(2 * math.pi * hz, rel=0.03)


def _standing(found: Array, effect: Array, healthy: Array) -> Array:
    """For each run what no size of a fault of that effect explains, in standard deviations.

    Along the direction in which the mean of the runs leaves the effect, in the metric of healthy
    runs: what is known of the noise is what was measured.
    """
    metric = np.linalg.inv(np.cov(healthy.T))
    mean = found.mean(axis=0)
    direction = metric @ (mean - effect * (effect @ metric @ mean) / (effect @ metric @ effect))
    return np.asarray((found @ direction) / np.std(healthy @ direction))


def _holds(standing: Array, kappa: float) -> None:
    """Kappa in the mean, and above half of it as often as a normal distribution is."""
    share = 0.5 * (1 + math.erf(kappa / 2 / math.sqrt(2)))
    runs = len(standing)
    assert abs(standing.mean() - kappa) < 4 / math.sqrt(runs)
    assert abs(np.mean(standing > kappa / 2) - share) < 3 * math.sqrt(share * (1 - share) / runs)


def _measured(
    program: Program,
    signals: Callable[[float], dict[str, float]],
    moments: range,
    runs: int,
    params: dict[str, Any],
    deviations: dict[str, float],
) -> Array:
    """The residuals of each run at some samples, in a row; noise that was drawn is in all."""
    random = np.random.default_rng(runs)
    lanes, states, rows = Lanes(program, params), None, []
    for k in range(moments[-1] + 1):
        usual = signals(k / program.rate)
        drawn = {n: random.normal(x, deviations.get(n, 0.0), runs) for n, x in usual.items()}
        out, states = lanes.sample(drawn, {}, {}, {}, states)
        if k in moments:
            rows += [np.broadcast_to(out[r.name], runs) for r in program.residuals]
    return np.array(rows).T


def _settled(program: Program) -> int:
    return math.ceil(program.warmup / program.bandwidth * program.rate) + 1


@pytest.mark.parametrize(("a", "b"), [("k", "current"), ("R", "f"), ("speed", "k")])
def test_a_simulated_machine_with_the_fault(a: str, b: str, motor: Compilation) -> None:
    """200 measurements of one that stands at its speed; what b does is simulated too."""
    deviations = {"current": 2e-4, "speed": 0.5}
    twelve = {"U": bondgraph.Course.constant(12.0), "load": bondgraph.Course.constant(0.0)}
    nominal = {"k": 3.51e-3, "R": 17.6, "f": 1.19e-5, "current": 0.0, "speed": 0.0}

    def residuals(runs: int, faulty: str = "", change: float = 0.0) -> Array:
        fault = bondgraph.Fault(faulty or "R", "=" if nominal[faulty or "R"] else "+=",
                                nominal[faulty or "R"] + change, 0.0)  # fmt: skip
        scenario = bondgraph.Scenario("run", duration=2.0, inputs=twelve, faults=(fault,))
        columns = motor.simulate(scenario).log.columns
        last = {name: float(column[-1]) for name, column in columns.items()}
        own = range(_settled(motor.program), _settled(motor.program) + 1)
        return _measured(motor.program, lambda _: last, own, runs, {}, deviations)

    at = {"U": 12.0, **_operation(nominal)}
    found = separation(motor.program, {}, Situation(at=at, noise=deviations, kappa=3.0))
    healthy = residuals(4000)
    rest = healthy.mean(axis=0)
    little = {"current": 1e-3, "f": 1e-7, "k": 1e-4}[b]
    effect = residuals(4000, b, little).mean(axis=0) - rest
    _holds(_standing(residuals(200, a, _change(found, a, b)) - rest, effect, healthy), 3.0)


def _operation(values: dict[str, float]) -> dict[str, float]:
    """U = R i + k w, k i = f w."""
    w = 12.0 / (values["R"] * values["f"] / values["k"] + values["k"])
    return {"speed": w, "current": values["f"] * w / values["k"]}


@pytest.mark.parametrize(("a", "b"), [("k12", "p2"), ("A2", "kout"), ("p1", "A1")])
def test_signals_that_swing(a: str, b: str) -> None:
    """200 runs of the code with other numbers, over a period: two tanks whose levels are moved."""
    program = bondgraph.compile(_MODELS / "two_tanks.bg", rate=10.0).program
    at, swing = {"Q": 1.5e-4, "p1": 4e4, "p2": 2e4}, {"p1": 2e3, "p2": 1.5e3}
    deviations = {"p1": 20.0, "p2": 20.0}
    situation = Situation(at=at, swing=swing, noise=deviations, frequency=0.05, kappa=3.0)
    found = separation(program, {}, situation)
    nominal = {"k12": 1.2e-6, "kout": 1e-6, "A1": 0.0154, "A2": 0.0154}
    start = _settled(program)

    def residuals(runs: int, wrong: str = "", change: float = 0.0) -> Array:
        def signals(time: float) -> dict[str, float]:
            sine = math.sin(2 * math.pi * 0.05 * time)
            off = {wrong: change} if wrong in at else {}
            return {n: x + swing.get(n, 0.0) * sine + off.get(n, 0.0) for n, x in at.items()}

        params = {wrong: nominal[wrong] + change} if wrong in nominal else {}
        return _measured(program, signals, range(start, start + 200, 4), runs, params, deviations)

    healthy = residuals(4000)
    rest = healthy.mean(axis=0)
    effect = residuals(4000, b, 1e-2 * {**nominal, **at}[b]).mean(axis=0) - rest
    _holds(_standing(residuals(200, a, _change(found, a, b)) - rest, effect, healthy), 3.0)


def test_a_residual_without_a_value_tells_nothing() -> None:
    """P - k log(T) has none at T = 0; U - R i has."""
    program = bondgraph.compile(
        text="bg 1\nmodel M {\nparam k = 1; param R = 1\n"
        "Sf:P -> 0:n\nn -> R:loss { f = k*log(e) }\nn -> De:T\n"
        "Se:U -> 1:a\na -> R:R\na -> Df:i\n}\n"
    ).program
    found = separation(program, {}, Situation(at={"i": 2.0}, noise={"T": 0.01, "i": 0.01}))
    assert set(found.faults) == {"R", "U", "i"}
    assert len(found.groups) == 1


def test_noise_that_is_the_same_at_all_moments() -> None:
    """An offset of one sensor, a row of ten equal numbers: nothing is left of one that it fits."""
    v = np.ones((10, 10))
    s = np.column_stack([np.ones(10), np.arange(10.0)])
    white = _white(v, s)
    assert white[:, 0] @ white[:, 0] == pytest.approx(1.0)  # 1' V^-1 1, as of one sample
    assert np.linalg.norm(white[:, 1]) > 1e6
    assert np.isfinite(_apart(1, white, np.zeros((10, 0)))[0])


def test_a_converter_whose_covariance_is_singular(tmp_path: Path) -> None:
    """64 moments of a residual that two signals and their slopes make have less than 64 noises."""
    model = _MODELS.parent / "tests" / "adversary" / "models" / "boost_duty.bg"
    assert main(["report", str(model), "-o", str(tmp_path / "report.html")]) == 0
