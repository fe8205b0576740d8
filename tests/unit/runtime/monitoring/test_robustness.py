"""What happens to samples on their way is no fault of the machine, and hides none."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

import bondgraph
from bondgraph.cli.main import main
from bondgraph.runtime.log import Log
from bondgraph.runtime.monitoring.verdict import Verdict, from_json
from tests.unit.runtime.monitoring import motor
from tests.unit.runtime.monitoring.watch import MOTOR, ROOT, csv

_AT = 2600  # the sample to which it happens, once noise is learned and before the fault
_STUCK = 4200  # the sample from which on an encoder of the robot stands still
_SPAN = 2**32 / 1e6  # s, of a clock of 32 bits in microseconds

ROBOT = str(ROOT / "models" / "khepera_encoders.bg")

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


@pytest.fixture(scope="session")
def robot() -> Log:
    """The robot with two encoders a drive, on its errands."""
    compilation = bondgraph.compile(ROBOT)
    scenario = compilation.scenario(ROOT / "models" / "scenarios" / "errands.toml")
    return compilation.simulate(scenario._replace(duration=6.0)).log


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
