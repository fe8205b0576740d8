"""What happens to samples on their way is no fault of the machine, and hides none."""

from __future__ import annotations

import math
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

import bondgraph
from bondgraph.cli.main import main
from bondgraph.runtime.diagnosis.diagnosis import Diagnosis
from bondgraph.runtime.diagnosis.hypotheses import rows_apart
from bondgraph.runtime.diagnosis.tuning import Limit, Tuning
from bondgraph.runtime.log import Log
from bondgraph.runtime.monitoring.engine import Batch, Engine
from bondgraph.runtime.monitoring.verdict import Verdict, from_json
from tests.unit.runtime.monitoring import motor
from tests.unit.runtime.monitoring.watch import MOTOR, ROOT, csv

_AT = 2600  # the sample to which it happens, once noise is learned and before the fault
_STUCK = 4200  # the sample from which on an encoder of the robot stands still
_SPAN = 2**32 / 1e6  # s, of a clock of 32 bits in microseconds

ROBOT = str(ROOT / "models" / "khepera_encoders.bg")

pytestmark = pytest.mark.usefixtures("kept_models")

Disturbance = Callable[[Log], Log]


def _without(*gone: int) -> Disturbance:
    def lost(log: Log) -> Log:
        keep = np.setdiff1d(np.arange(log.rows), gone)
        columns = {n: c[keep] for n, c in log.columns.items()}
        return log._replace(time=log.time[keep], columns=columns)

    return lost


def _jittered(log: Log) -> Log:
    late = np.random.default_rng(3).uniform(-0.05e-3, 0.05e-3, log.rows)
    return log._replace(time=log.time + late - late[0])


def _not_a_number(log: Log) -> Log:
    columns = {n: c.copy() for n, c in log.columns.items()}
    list(columns.values())[-1][_AT] = np.nan
    return log._replace(columns=columns)


def _restarted(log: Log) -> Log:
    """Time and counters begin again."""
    columns = {n: c.copy() for n, c in log.columns.items()}
    for name, column in columns.items():
        if log.units.get(name) == "count":
            column[_AT:] -= column[_AT]
    time = np.concatenate([log.time[:_AT], log.time[_AT:] - log.time[_AT]])
    return log._replace(time=time, columns=columns)


def _wrapped(log: Log) -> Log:
    return log._replace(time=(log.time + _SPAN - log.time[_AT]) % _SPAN)


DISTURBANCES = {
    "nothing": _without(),
    "a lost sample": _without(_AT),
    "gaps of 10 ms": _without(*range(_AT, _AT + 10), *range(_AT + 200, _AT + 210)),
    "jitter": _jittered,
    "not a number": _not_a_number,
    "a restart": _restarted,
    "a clock that runs over": _wrapped,
}


def _said(model: str, log: Log, folder: Path, capsys: pytest.CaptureFixture[str]) -> list[Verdict]:
    """The verdicts on a log whose clock counts microseconds."""
    ticks = log._replace(time=np.round(log.time * 1e6, 3))
    path = folder / "log.csv"
    path.write_bytes(csv(ticks, header=True).replace(b"t,", b"t_us,", 1))
    words = ["--time", "t_us", "--time-unit", "us", "--rate", "1000", "--json"]
    assert main(["monitor", model, str(path), *words]) == 0
    return [from_json(line)[1] for line in capsys.readouterr().out.splitlines()]


@pytest.mark.parametrize("name", DISTURBANCES)
def test_a_motor(name: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    disturbed = DISTURBANCES[name]
    healthy = _said(MOTOR, disturbed(motor.log(6.0, 1.0)), tmp_path, capsys)
    assert not {"fault", "update"} & {v.event for v in healthy}
    faulty = _said(MOTOR, disturbed(motor.log()), tmp_path, capsys)
    assert [v.event for v in faulty].count("fault") == 1
    last = [v for v in faulty if v.event == "update"][-1]
    assert "f" in last.group and not {"R", "L", "U"} & set(last.group)
    for candidate in last.candidates:
        if candidate.fault == "f":
            assert candidate.size == pytest.approx(motor.FAULT, rel=0.1)


@pytest.mark.parametrize("name", DISTURBANCES)
def test_a_robot(name: str, robot: Log, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    disturbed = DISTURBANCES[name]
    healthy = _said(ROBOT, disturbed(robot), tmp_path, capsys)
    assert not {"fault", "update"} & {v.event for v in healthy}
    wheel = robot.columns["m[1].wheel"].copy()
    wheel[_STUCK:] = wheel[_STUCK]  # an encoder stands still
    stuck = robot._replace(columns={**robot.columns, "m[1].wheel": wheel})
    faulty = _said(ROBOT, disturbed(stuck), tmp_path, capsys)
    assert [v.event for v in faulty].count("fault") == 1
    last = [v for v in faulty if v.event == "update"][-1]
    assert last.candidates[0].fault == "m[1].wheel"


@pytest.mark.parametrize("kind", ["motor", "robot"])
def test_an_alarm_is_given_by_who_is_outside_the_whole_threshold_for_long_enough(
    kind: str, robot: Log
) -> None:
    if kind == "motor":
        healthy, faulty = motor.log(6.0, 1.0), motor.log()
    else:
        wheel = robot.columns["m[1].wheel"] + 400.0 * (np.arange(robot.rows) >= _STUCK)
        healthy, faulty = robot, robot._replace(columns={**robot.columns, "m[1].wheel": wheel})
    compilation = bondgraph.compile(MOTOR if kind == "motor" else ROBOT)
    engine = compilation.engine()
    learner = compilation.diagnosis(engine)
    _decided(learner, engine, healthy)
    assert not np.isnan(learner.decided().bound).any()
    limits = {  # without the sums, which nobody can draw
        name: Limit(*limit)._replace(height=1e300)
        for name, limit in zip(engine.residuals, learner.state()["limits"], strict=True)
    }
    digest, rate = compilation.program.digest, 1.0 / engine.sample_time
    tuning = Tuning(digest, rate, engine.bandwidth, 1.0, 6.0, limits)
    alarms, drawn, given = _decided(compilation.diagnosis(engine, tuning), engine, faulty)
    assert alarms[0] == _crossed(engine, faulty.time, drawn) > 3.0
    noise = np.array([limit.kappa * limit.sigma for limit in limits.values()])
    more = np.where(drawn.valid, 1.0 - (noise + given.bound) / drawn.bound, 0.0)
    assert more.min() > -1e-12
    assert bool(more.max() > 0.5) is (kind == "robot")  # of the first counts of encoders


def _decided(decision: Diagnosis, engine: Engine, log: Log) -> tuple[list[float], Batch, Batch]:
    """When there was an alarm, by what was decided, and what came from the engine."""
    samples = np.column_stack([log.columns[k.path] for k in engine.signals])
    own, alarms, drawn, given = engine.configured(), [], [], []
    for k in range(0, len(samples), 333):
        time, part = log.time[k : k + 333], samples[k : k + 333]
        given.append(own.run(part))
        said = decision.update(time, given[-1], part)
        alarms += [v.time for v in said if v.event == "fault"]
        drawn.append(decision.decided())
        assert len(drawn[-1].value) == len(part)
    both = [Batch(*map(np.concatenate, zip(*parts, strict=True))) for parts in (drawn, given)]
    return alarms, *both


def _crossed(engine: Engine, time: np.ndarray, drawn: Batch) -> float:
    """When the first residual has been outside for a tenth of a row, at least three samples."""
    wanted = max(3, rows_apart(engine) // 10)
    outside = drawn.valid & (np.abs(drawn.value) > drawn.bound)
    long = np.lib.stride_tricks.sliding_window_view(outside, wanted, axis=0).all(axis=-1)
    found = np.flatnonzero(long.any(axis=1))
    return float(time[found[0] + wanted - 1]) if len(found) else math.nan
