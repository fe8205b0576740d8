"""After a break encoders count from wherever they stand: no alarm for that, and no blindness."""

from __future__ import annotations

import json
import math
from collections.abc import Iterator, Mapping
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import bondgraph
from bondgraph.compilation import Compilation
from bondgraph.runtime.diagnosis.diagnosis import Diagnosis
from bondgraph.runtime.diagnosis.history import History
from bondgraph.runtime.diagnosis.origins import Readings
from bondgraph.runtime.log import Array, Log
from bondgraph.runtime.monitoring.clock import clock_of
from bondgraph.runtime.monitoring.engine import Engine
from bondgraph.runtime.monitoring.verdict import Verdict
from tests.unit.runtime.monitoring import stops
from tests.unit.runtime.monitoring.watch import ROOT

_ROBOT = str(ROOT / "models" / "khepera_encoders.bg")


class _Machine:
    """A model with its engine, and the counters among its columns."""

    def __init__(self, path: str) -> None:
        self.compilation: Compilation = bondgraph.compile(path)
        self.engine: Engine = self.compilation.engine()
        self.signals = [k.path for k in self.engine.signals]
        self.counters = [k for k, s in enumerate(self.engine.signals) if s.counts is not None]

    def diagnosis(self) -> Diagnosis:
        return self.compilation.diagnosis(self.engine)

    def samples(self, columns: Mapping[str, Array]) -> Array:
        return np.column_stack([columns[path] for path in self.signals])

    def watch(self, time: Array, samples: Array) -> tuple[list[Verdict], Diagnosis]:
        """What a new diagnosis says of samples as they come, gaps and all."""
        base, own, said = self.engine.configured(), self.diagnosis(), []
        clock = clock_of(self.engine)
        for piece in [*clock.feed(time, samples), *clock.finish()]:
            if piece.anew:
                base.reset()
                own.restart()
            for k in range(0, len(piece.time), 400):
                part = slice(k, k + 400)
                batch = base.run(piece.samples[part])
                said += own.update(piece.time[part], batch, piece.samples[part])
        return said, own

    def anew(self, time: Array, samples: Array, at: int, lost: int = 0) -> tuple[Array, Array]:
        """Time and counters begin again at a sample, after some have been lost."""
        samples, keep = samples.copy(), np.r_[0:at, at + lost : len(time)]
        samples[at + lost :, self.counters] -= samples[at + lost, self.counters]
        time = np.append(time[:at], time[at:] - time[at + lost])
        return time[keep], samples[keep]


@cache
def _robot() -> _Machine:
    return _Machine(_ROBOT)


@pytest.fixture(scope="module")
def press(tmp_path_factory: pytest.TempPathFactory) -> Iterator[_Machine]:
    """The oil press."""
    path = tmp_path_factory.mktemp("press") / "press.bg"
    path.write_text(stops.PRESS)
    yield _Machine(str(path))


def _alarms(said: list[Verdict]) -> list[Verdict]:
    return [v for v in said if v.event in ("fault", "update")]


# ------------------------------------------------------------------------- who remembers what


@pytest.mark.parametrize(
    ("model", "memory"),
    [
        ("dc_motor", {}),
        ("khepera_encoders", {("r2",): ("m[1].motor", "m[1].wheel"),
                              ("r4",): ("m[2].motor", "m[2].wheel")}),
        ("slider_crank", {("r1",): ("speed",)}),
    ],
)  # fmt: skip
def test_only_laws_of_position_remember_where_it_began(
    model: str, memory: dict[tuple[str, ...], tuple[str, ...]]
) -> None:
    path = ROOT / "models" / f"{model}.bg"
    compilation = _robot().compilation if str(path) == _ROBOT else bondgraph.compile(path)
    found = compilation.diagnosis_model.memories
    assert {m.residuals: m.signals for m in found} == memory
    assert all(set(m.signals) <= set(m.reads) for m in found)
    assert all(m.integral == (model == "slider_crank") for m in found)


def test_what_is_known_of_others_stays_when_a_parameter_begins_anew() -> None:
    """Against the covariance of everything, in which integrating out is leaving out."""
    draw = np.random.default_rng(5)
    prior = np.array([0.5, 1.0, 2.0, 0.7])
    history = History(prior)
    rows = [(draw.normal(size=3), draw.uniform(1, 9, 3), draw.normal(size=(4, 3)))
            for _ in range(6)]  # fmt: skip
    for value, weight, slopes in rows:
        history.add(value, weight, slopes, 1.0)
    found = history.anew([1, 3], [0, 1, 2], [5.0])  # 1 is anew, 3 gone, one comes behind
    matrix = np.diag(prior**-2) + sum(s @ np.diag(w) @ s.T for _, w, s in rows)
    mean = np.linalg.solve(matrix, sum(s @ (w * v) for v, w, s in rows))
    left = np.linalg.inv(matrix)
    spread = np.zeros((4, 4))
    spread[np.ix_([0, 2], [0, 2])] = left[np.ix_([0, 2], [0, 2])]
    spread[1, 1], spread[3, 3] = prior[1] ** 2, 25.0
    slopes = draw.normal(size=(4, 2))
    value, variance = found.expected(slopes)
    assert value == pytest.approx(slopes.T @ [mean[0], 0.0, mean[2], 0.0])
    assert variance == pytest.approx(np.diag(slopes.T @ spread @ slopes))


@pytest.mark.parametrize(
    ("gap", "count", "goes"),
    [
        (0.2, 1_000_000 + 180, True),  # as fast as before
        (0.2, 1_000_000, True),  # it may have stopped
        (0.2, 1_000_000 + 900, False),  # too far
        (0.2, 0, False),  # from zero
        (-1.0, 1_000_000, False),  # the clock went back
        (2000.0, 1_000_000, False),  # by then it may have come from zero as well
        (0.2, 1_000_180 - 2**32, True),  # it has run over
    ],
)
def test_counters_have_gone_on_where_they_can_have_come_to(
    gap: float, count: float, goes: bool
) -> None:
    readings = Readings(1, 1e-3)
    time = np.arange(1000) * 1e-3
    readings.note(time, 999_000.0 + np.arange(1001)[1:, None], [0], 75)
    again = Readings(1, 1e-3)
    again.resume(json.loads(json.dumps(readings.state())))
    for one in (readings, again):
        assert one.go_on(time[-1:] + gap, np.array([[count]]), 0, [0]) == goes


def test_what_is_not_read_is_not_the_newest_value() -> None:
    readings = Readings(3, 1e-3)
    time = np.arange(4) * 1e-3
    lost = math.nan
    rows = np.array([[5.0, lost, 1.0], [6.0, lost, lost], [lost, lost, lost], [8.0, lost, lost]])
    readings.note(time, rows, [0, 1, 2], 2)
    assert [readings.last(at) for at in (0, 2)] == [8.0, 1.0]
    assert math.isnan(readings.last(1))
    readings.note(time + 1.0, np.full((4, 3), lost), [0, 1, 2], 2)
    assert [readings.last(at) for at in (0, 2)] == [8.0, 1.0]


# ------------------------------------------------------------------------------- another domain


def test_a_press_that_restarts_in_mid_motion_is_healthy(press: _Machine) -> None:
    columns = stops.press()
    samples = press.samples(columns)
    for at in range(2500, 6200, 400):
        said, own = press.watch(*press.anew(columns["t"], samples, at))
        assert not _alarms(said), at
        ends = [v.message for v in said if v.event == "warm-up"][-2:]
        assert "r2 waits until" in ends[0] and "r2 is watched" in ends[1]
        told = json.loads(json.dumps(own.state()))["origins"]["told"]
        where = told[press.signals.index("angle")]
        assert where == pytest.approx(columns["angle"][0] - columns["angle"][at], abs=60)


@pytest.mark.parametrize("at", [2600, 4300])
def test_a_soft_bladder_is_found_after_a_restart(press: _Machine, at: int) -> None:
    columns = stops.press(8.0, (at + 1500) / 1000, 0.7)
    said, _ = press.watch(*press.anew(columns["t"], press.samples(columns), at))
    assert [v.event for v in said].count("fault") == 1
    assert set([v for v in said if v.event == "update"][-1].group) == {"B", "h"}


def test_an_encoder_that_stands_still_while_its_start_is_looked_for_is_found(
    press: _Machine,
) -> None:
    columns = stops.press()
    samples = press.samples(columns)
    angle = press.signals.index("angle")
    samples[3400:, angle] = samples[3400, angle]
    said, _ = press.watch(*press.anew(columns["t"], samples, 3000))
    assert [v.event for v in said].count("fault") in (1, 2)  # r1 is quiet for a while
    last = [v for v in said if v.event == "update"][-1]
    assert last.candidates[0].fault == "angle" and "r2" in last.residuals


def test_an_arm_waits_until_it_has_met_its_bumper(tmp_path: Path) -> None:
    (tmp_path / "bumper.bg").write_text(stops.BUMPER)
    machine = _Machine(str(tmp_path / "bumper.bg"))
    columns = stops.bumper(0.05)
    said, own = machine.watch(*machine.anew(columns["t"], machine.samples(columns), 3000))
    assert not _alarms(said)
    assert sum("waits until" in v.message for v in said) == 1
    met = columns["t"][3000:][columns["angle"][3000:] * 2.0 * math.pi / 20000 > 0.5][0]
    assert "known" in said[-1].message
    assert 0.0 < said[-1].time - (met - columns["t"][3000]) < 0.2
    (told,) = [t for t in own.state()["origins"]["told"] if t is not None]
    assert told == pytest.approx(columns["angle"][0] - columns["angle"][3000], abs=5)


def test_what_waits_for_its_start_is_told_as_that_to_the_end(tmp_path: Path) -> None:
    """Its equations have a solution, and no switch turns: it was said to be blind for these."""
    (tmp_path / "bumper.bg").write_text(stops.BUMPER)
    machine = _Machine(str(tmp_path / "bumper.bg"))
    columns = {name: column[:5100] for name, column in stops.bumper(0.05).items()}  # before it
    time, samples = machine.anew(columns["t"], machine.samples(columns), 3000, lost=400)
    time[3000:] += 3.4
    frame = {"time": time, **dict(zip(machine.signals, samples.T, strict=True))}
    log = pytest.importorskip("pandas").DataFrame(frame)
    (said,) = bondgraph.monitor(machine.compilation, log).verdicts
    assert [v.event for v in said[-3:]] == ["gap", "warm-up", "stop"]
    why = "waits until the machine has shown by its motion where angle began"
    assert said[-2].message == f"r1 {why}"
    assert said[-1].message.endswith(f"r1 is not watched: it {why}")


def test_what_waits_again_and_again_is_no_flood(press: _Machine) -> None:
    """Stopped each second: told of the first break, the second, fourth and so on."""
    columns = stops.press()
    samples = np.tile(press.samples(columns), (3, 1))
    number = np.arange(len(samples))
    time = number * 1e-3 + number // 1000
    for at in range(1000, len(time), 1000):
        samples[at:, press.counters] -= samples[at, press.counters]
    said, _ = press.watch(time, samples)
    told = [v.time for v in said if "waits until" in v.message]
    doubled = [float(time[1000 * n]) for n in (1, 2, 4, 8, 16)]
    assert told == pytest.approx(doubled, abs=0.7)  # warm by then


# ------------------------------------------------------------------------------------ the robot

_STUCK, _END = 4200, 5300


def _stuck(robot: Log) -> tuple[Array, Array]:
    """Its samples, with an encoder that stands still in the end."""
    samples = _robot().samples(robot.columns)
    wheel = _robot().signals.index("m[1].wheel")
    samples[_STUCK:, wheel] = samples[_STUCK, wheel]
    return robot.time[:_END].copy(), samples[:_END]


def _found(said: list[Verdict], after: float) -> None:
    assert [v.time > after for v in said if v.event == "fault"] == [True]
    last = [v for v in said if v.event == "update"][-1]
    assert last.candidates[0].fault == "m[1].wheel"


def test_counters_that_go_on_over_a_gap_are_believed(robot: Log) -> None:
    time, samples = _stuck(robot)
    keep = np.r_[0:2400, 2600 : len(time)]
    said, _ = _robot().watch(time[keep], samples[keep])
    _found(said, _STUCK / 1000)
    assert not any("until the machine" in v.message for v in said)


def test_over_a_long_gap_nobody_knows_whether_they_have(robot: Log) -> None:
    samples = _robot().samples(robot.columns)
    keep = np.r_[0:2400, 4400 : len(samples)]
    said, _ = _robot().watch(robot.time[keep], samples[keep])
    assert not _alarms(said)
    assert sum("r2 and r4 wait until" in v.message for v in said) == 1


def test_counters_that_begin_anew_after_a_gap_are_not(robot: Log) -> None:
    time, samples = _stuck(robot)
    counters = _robot().counters
    samples[2600:, counters] -= samples[2600, counters]
    keep = np.r_[0:2400, 2600 : len(time)]
    said, _ = _robot().watch(time[keep], samples[keep])
    _found(said, _STUCK / 1000)
    assert sum("r2 and r4 wait until" in v.message for v in said) == 1


@pytest.mark.parametrize("anew", [False, True])
def test_an_encoder_is_silent_for_a_while(anew: bool, robot: Log) -> None:
    time, samples = _stuck(robot)
    wheel = _robot().signals.index("m[1].wheel")
    if anew:
        samples[2700:, wheel] -= samples[2700, wheel]
    samples[2400:2700, wheel] = np.nan
    said, _ = _robot().watch(time, samples)
    _found(said, _STUCK / 1000)
    waits = [v for v in said if "r2 waits until" in v.message]
    assert [v.event for v in waits] == ["invalid"] * anew


@pytest.mark.parametrize("back", [0, 1800])
def test_the_start_is_known_after_a_kill(back: int, robot: Log) -> None:
    """From a file the last samples come again, from a pipe some are missed."""
    time, samples = _stuck(robot)
    machine = _robot()
    said, first = machine.watch(time[:3000], samples[:3000])
    state: dict[str, Any] = json.loads(json.dumps(first.state(), allow_nan=False))
    second, base = machine.diagnosis(), machine.engine.configured()
    second.resume(state)
    begin = 3000 - back if back else 3300
    for k in range(begin, 3000, 300):
        part = slice(k, k + 300)
        second.look(time[part], base.run(samples[part]), samples[part])
    for k in range(max(begin, 3000), len(time), 300):
        part = slice(k, k + 300)
        said += second.update(time[part], base.run(samples[part]), samples[part])
    _found(said, _STUCK / 1000)
    assert not any("until the machine" in v.message for v in said)
