"""A fault that is accepted is no fault any more, and the next one is told as the first was."""

from __future__ import annotations

import json
from functools import cache
from pathlib import Path

import numpy as np
import pytest

import bondgraph
from bondgraph.cli.main import main
from bondgraph.compilation import Compilation
from bondgraph.runtime.diagnosis.accepted_faults import AcceptedFaults
from bondgraph.runtime.log import Array
from bondgraph.runtime.monitoring.verdict import Verdict
from bondgraph.runtime.monitoring.whole_logs import on_grid
from bondgraph.text.source import Source

_ROOT = Path(__file__).parents[4]
_SCENARIO = """
duration = "24 s"
inputs.U = "12*(1 + 0.2*sin(2*pi*t))"
inputs.load = 0
sampling.rate = "1 kHz"
sensors.current.noise = "2 mA"
sensors.speed.noise = "1 rad/s"
"""
_OVEN = """bg 1
model Bath {
    param C = 500 J/K +- 5%
    param G = 2 W/K +- 5%
    input on : bool
    input P : W
    input air : W
    Sf:P -> 0:heater when on { -> 0:bath }
    bath { -> C:C; -> R:loss = 1/G; -> De:T; <- Sf:air }
}
"""
_BATH = """
duration = "33 min"
inputs.P = "100 + 10*sin(t/17)"
inputs.air = "20*sin(t/23)"
inputs.on = "sin(2*pi*t/60) > 0"
sampling.rate = "10 Hz"
sensors.T.noise = 0.02
[[fault]]
of = "on"
change = "= true"
at = "805 s"
[[fault]]
of = "G"
change = "*= 1.5"
at = "1400 s"
"""

_TURNED = """bg 1
model Motor {
    param R = 2 Ohm +- 5%
    param L = 10 mH +- 5%
    param k = 0.5 N.m/A +- 5%
    param J = 0.02 kg.m^2 +- 5%
    param f = 0.02 N.m.s/rad +- 5%
    1:coil { <- Se:U; -> R:R; -> I:L; -> Df:i; -> GY:k -> 1:rotor }
    rotor { -> R:f; -> I:J; -> Df:w }
    sensor turned : rad = int(rotor.f) counts 4096/turn
}
"""
_TURNING = """
duration = "30 s"
inputs.U = "12*(1 + 0.3*sin(2*t))"
sampling.rate = "200 Hz"
sensors.i.noise = "5 mA"
sensors.w.noise = "0.05 rad/s"
[[fault]]
of = "turned"
change = "*= 1.05"
at = "14 s"
"""
_LOOP = """bg 1
model Tank {
    input r : m
    param A = 0.05 m^2 +- 5%
    param K = 0.02 m^2/s
    param g = 0.004 m^2/s +- 5%
    0:t { <- Sf:pump = K*(r - y); -> C:C = A; -> R:out = 1/g; -> De:y; -> De:y2 }
    sensor u = K*(r - y)
}
"""
_FILLING = """
duration = "600 s"
inputs.r = "1 + 0.3*sin(t/7)"
sampling.rate = "10 Hz"
sensors.y.noise = 0.002
sensors.y2.noise = 0.002
sensors.u.noise = 0.00002
[[fault]]
of = "y"
change = "+= 0.1"
at = "300 s"
"""

_LEAKS = """
duration = "3000 s"
inputs.Q = "7e-5*(1 + 0.3*sin(t/40))"
sampling.rate = "1 Hz"
sensors.p1.noise = 20
sensors.p2.noise = 20
[[fault]]
of = "leak"
change = "+= 2e-7"
at = "1000 s"
"""


@cache
def _motor() -> Compilation:
    return bondgraph.compile(_ROOT / "models" / "dc_motor.bg")


def _samples(folder: Path, *faults: tuple[str, str, float]) -> tuple[Array, Array]:
    """Time and samples of the motor with faults from their times on, by the simulator."""
    text = _SCENARIO
    for of, change, at in faults:
        text += f'[[fault]]\nof = "{of}"\nchange = "{change}"\nat = "{at} s"\n'
    (folder / "s.toml").write_text(text)
    log = _motor().simulate(_motor().scenario(folder / "s.toml")).log
    pieces = on_grid(_motor().engine(), log)
    return np.concatenate([p.time for p in pieces]), np.concatenate([p.samples for p in pieces])


def _watched(
    time: Array, samples: Array, block: int = 1000, watch: AcceptedFaults | None = None
) -> tuple[list[Verdict], AcceptedFaults]:
    """What is said, but for the warm-up; faults are accepted after 3 s."""
    engine = _motor().engine()
    watch, said = watch or _motor().accepting(engine, after=3.0), []
    for k in range(0, len(time), block):
        own = slice(k, k + block)
        said += watch.update(time[own], engine.run(samples[own]), samples[own])
    return [v for v in said if v.event != "warm-up"], watch


def test_the_second_of_two_faults_is_named_with_its_size(tmp_path: Path) -> None:
    time, samples = _samples(tmp_path, ("R", "*= 1.3", 8.0), ("speed", "*= 1.1", 16.0))
    said, watch = _watched(time, samples)
    assert [v.event for v in said] == ["fault", "update", "accepted"] * 2
    for verdict, fault, size in ((said[2], "R", 0.3 * 17.6), (said[5], "speed", 10.0)):
        (one,) = verdict.candidates
        assert fault in verdict.group and one.fault == fault
        assert one.size == pytest.approx(size, rel=0.02)
    assert said[3].since == pytest.approx(16.0, abs=0.05)
    assert [a.fault for a in watch.accepted] == ["R", "speed"]
    # how samples come does not matter, but for how far out a residual was in them until it fired
    again = _watched(time, samples, block=77)[0]
    assert [v[:3] + v[4:5] for v in again] == [v[:3] + v[4:5] for v in said]
    sizes = [[c.size for v in found for c in v.candidates] for found in (again, said)]
    assert sizes[0] == pytest.approx(sizes[1], rel=1e-9)
    # without acceptance the second one is not named
    engine, plain = _motor().engine(), []
    other = _motor().diagnosis(engine)
    for k in range(0, len(time), 1000):
        own = slice(k, k + 1000)
        plain += other.update(time[own], engine.run(samples[own]), samples[own])
    assert any("R" in v.group for v in plain) and not any("speed" in v.group for v in plain)


def test_a_repair_is_told_and_is_a_new_baseline(tmp_path: Path) -> None:
    time, samples = _samples(tmp_path, ("R", "*= 1.3", 8.0), ("R", "*= 0.7692308", 16.0))
    said, _ = _watched(time, samples)
    assert [v.event for v in said] == ["fault", "update", "accepted"] * 2
    assert "which is what was declared" not in said[2].message
    assert said[5].message.startswith(("R is taken for 17.5", "R is taken for 17.6"))
    assert "which is what was declared" in said[5].message


def test_a_leak_where_none_was_declared_is_accepted(tmp_path: Path) -> None:
    """What was nothing has a size now, and may have another one: the watch goes on with that."""
    (tmp_path / "s.toml").write_text(_LEAKS)
    c = bondgraph.compile(_ROOT / "models" / "two_tanks.bg", rate=1.0)
    engine = c.engine()
    (piece,) = on_grid(engine, c.simulate(c.scenario(tmp_path / "s.toml")).log)
    watch = c.accepting(engine, after=100.0)
    said = watch.update(piece.time, engine.run(piece.samples), piece.samples)
    told = [v for v in said if v.event != "warm-up"]
    assert [v.event for v in told].count("accepted") == 1
    (leak,) = watch.accepted
    assert leak.fault == "leak" and told[-1].event == "accepted", "with it the tanks are well"
    (one, *_) = told[-1].candidates
    assert one.size == pytest.approx(2e-7, rel=0.2)


def test_a_faulty_command_and_an_offset_of_a_sensor_are_corrected(tmp_path: Path) -> None:
    faults = ("current", "+= 0.1 A", 8.0), ("load", "+= 0.0005 N.m", 16.0)
    time, samples = _samples(tmp_path, *faults)
    said, watch = _watched(time, samples)
    assert [v.event for v in said] == ["fault", "update", "accepted"] * 2
    # a sensor tells 0.1 A more than there is; a load is 0.5 mN.m more than is told
    assert [a.kind for a in watch.accepted] == ["offset", "offset"]
    assert [a.change for a in watch.accepted] == pytest.approx([0.1, -0.0005], rel=0.02)


def test_a_dead_sensor_is_not_listened_to_any_more(tmp_path: Path) -> None:
    time, samples = _samples(tmp_path, ("current", "stuck", 8.0))
    said, watch = _watched(time, samples)
    accepted = next(v for v in said if v.event == "accepted")
    assert accepted.message == "current is not listened to any more; the watch goes on with that"
    last = watch.decided()
    assert not last.valid[-1].any()  # both residuals read it: blind, and said to be
    assert [v.event for v in said if v.time > accepted.time] == ["invalid"]


def test_a_stuck_switch_is_taken_so(tmp_path: Path) -> None:
    """A bath whose heater stays on; later it loses half as much again."""
    (tmp_path / "s.toml").write_text(_BATH)
    c = Compilation(Source("bath.bg", _OVEN)).with_options(rate=10.0)
    log = c.simulate(c.scenario(tmp_path / "s.toml")).log
    engine = c.engine()
    watch, said = c.accepting(engine, after=100.0), []
    for piece in on_grid(engine, log):
        said += watch.update(piece.time, engine.run(piece.samples), piece.samples)
    first, *others = [v for v in said if v.event != "warm-up"]
    assert first.event == "fault" and first.since == pytest.approx(805.0, abs=30.0)
    accepted = next(v for v in others if v.event == "accepted")
    assert accepted.candidates[0].fault == "on stuck on" and accepted.time < 1400.0
    assert accepted.message.startswith("on stuck on is taken so, whatever is told; the watch")
    after = [v for v in others if v.time > accepted.time]
    assert after[0].event == "fault" and after[0].time > 1400.0  # and nothing in between
    assert any("G" in v.group for v in after)


def test_a_watch_that_is_resumed_says_the_same(tmp_path: Path) -> None:
    time, samples = _samples(tmp_path, ("R", "*= 1.3", 8.0), ("speed", "*= 1.1", 16.0))
    whole, _ = _watched(time, samples)
    for cut in (9.0, 13.0):  # named and not accepted yet, and behind it
        at = round(1000 * cut)
        said, watch = _watched(time[:at], samples[:at])
        state = json.loads(json.dumps(watch.state()))
        again = _motor().accepting(_motor().engine(), after=3.0)
        again.resume(state)
        warm = slice(at - 3000, at)
        again.look(time[warm], _motor().engine().run(samples[warm]), samples[warm])
        said += _watched(time[at:], samples[at:], watch=again)[0]
        told = [(v.event, v.group, v.candidates and v.candidates[0].fault) for v in said]
        assert [t for t in told if t[0] != "invalid"] == [
            (v.event, v.group, v.candidates and v.candidates[0].fault) for v in whole
        ]


@pytest.mark.parametrize(
    "wrong",
    [
        ["R", "value", float("inf"), 0.1],
        ["speed", "value", 1.0, 0.1],
        ["R", "offset", 1.0, 0.1],
        ["speed", "else", 1.0, 0.1],
    ],
)
def test_a_state_that_cannot_be_is_refused(wrong: list[object]) -> None:
    watch = _motor().accepting(_motor().engine(), after=3.0)
    state = watch.state()
    with pytest.raises((KeyError, TypeError, ValueError)):
        watch.resume({**state, "accepted": [wrong]})


@pytest.mark.parametrize(
    ("text", "scenario", "rate", "why"),
    [
        (_TURNED, _TURNING, 200.0, "turned is an encoder, whose counts are not corrected"),
        (_LOOP, _FILLING, 10.0, "laws of the model use what y reads"),
    ],
)
def test_what_cannot_be_accepted_is_said_once(
    tmp_path: Path, text: str, scenario: str, rate: float, why: str
) -> None:
    (tmp_path / "s.toml").write_text(scenario)
    c = Compilation(Source("m.bg", text)).with_options(rate=rate)
    log = c.simulate(c.scenario(tmp_path / "s.toml")).log
    engine = c.engine()
    watch, said = c.accepting(engine, after=600.0 / rate), []
    for piece in on_grid(engine, log):
        for k in range(0, len(piece.time), 1000):
            own = slice(k, k + 1000)
            samples = piece.samples[own]
            said += watch.update(piece.time[own], engine.run(samples), samples)
            state = json.loads(json.dumps(watch.state()))
            watch.resume(state) if state["refused"] else None  # a restart does not say it again
    events = [v.event for v in said if v.event not in ("warm-up", "update")]
    assert events == ["fault", "refused"] and watch.accepted == ()
    (refused,) = (v for v in said if v.event == "refused")
    (fault,) = refused.group
    assert refused.message == f"{fault} cannot be accepted, and stays in alarm: {why}"


def test_nothing_is_accepted_that_was_not_named(tmp_path: Path) -> None:
    time, samples = _samples(tmp_path)
    said, watch = _watched(time, samples)
    assert said == [] and watch.accept(24.0) == [] and watch.accepted == ()


def test_the_command_accepts(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    time, samples = _samples(tmp_path, ("R", "*= 1.3", 8.0), ("speed", "*= 1.1", 16.0))
    names = [k.path for k in _motor().engine().signals]
    table = np.column_stack([time, samples])
    header = ",".join(["t", *names])
    np.savetxt(tmp_path / "log.csv", table, "%.9g", ",", header=header, comments="")
    words = [str(_ROOT / "models" / "dc_motor.bg"), str(tmp_path / "log.csv"), "--accept", "3"]
    states, journal = str(tmp_path / "states.csv"), str(tmp_path / "journal")
    assert main(["monitor", *words, "--states", states, "--journal", journal]) == 0
    lines = capsys.readouterr().out.splitlines()
    events = [line.split()[2] for line in lines]
    assert events.count("accepted") == 2
    head, *_, last = Path(states).read_text().splitlines()
    assert dict(zip(head.split(","), last.split(","), strict=True))["state"] == "healthy"
    # a watch that accepts nothing cannot go on where faults were accepted
    assert main(["monitor", *words[:2], "--journal", journal]) == 1
    assert "belongs to another model or other options" in capsys.readouterr().err
