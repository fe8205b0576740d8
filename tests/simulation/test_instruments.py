"""Controllers, instruments and faults of a scenario, against simulations written by hand."""

from __future__ import annotations

import math
import os
import subprocess
import sys
from collections.abc import Callable
from itertools import islice
from pathlib import Path

import numpy as np
import pytest
from scipy.signal import lsim

from bondgraph.runtime.log import Log
from bondgraph.runtime.log_file import write_log
from bondgraph.runtime.simulation.run import Robot
from tests.simulation.machines import Array, example, near, opened, read, run

ROTOR = "Se:T -> 1:w\nw -> I:J = 0.5\nw -> R:f = 0.2\nw -> Df:y\nsensor th : rad = int(w.f)"
ENCODER = ROTOR + " counts 24/turn"


def rotor(w: float, th: float, torque: float, dt: float) -> tuple[float, float]:
    """Half a unit of inertia with friction, over a time in which the torque is constant."""
    end, fall = torque / 0.2, math.exp(-0.4 * dt)
    return end + (w - end) * fall, th + end * dt + (w - end) * (1 - fall) / 0.4


@pytest.mark.parametrize("speed", [False, True])
def test_a_controller_with_limits_is_the_one_written_by_hand(speed: bool) -> None:
    """PID by the trapezoidal rule, integral held at the limits; setpoint jumps at 1 s."""
    kp, ki, kd, period, low, high = 0.8, 3.0, 0.01, 0.02, -0.7, 0.9
    sensor = "th" if speed else "y"
    found = run(
        ROTOR,
        f'duration = 3\nsampling.rate = 100\n[[controller]]\ninput = "T"\nmeasures = "{sensor}"\n'
        f'setpoint = "if(t >= 1, -1, 3)"\nkp = {kp}\nki = {ki}\nkd = {kd}\nperiod = {period}\n'
        f"limits = [{low}, {high}]\nspeed = {str(speed).lower()}",
    ).truth
    w = th = integral = 0.0
    torque = before = None
    seen = None
    told, speeds = [], []
    for k in range(301):
        if k % 2 == 0:
            measured = w
            if speed:
                measured = 0.0 if seen is None else (th - seen) / period
                seen = th
            error = (-1 if k >= 100 else 3) - measured
            last = error if before is None else before
            before = error
            more = integral + ki * period * (error + last) / 2
            wanted = kp * error + more + kd * (error - last) / period
            if (
                low <= wanted <= high
                or (wanted > high and error < 0)
                or (wanted < low and error > 0)
            ):
                integral = more
            torque = min(max(wanted, low), high)
        assert torque is not None
        told.append(torque)
        speeds.append(w)
        w, th = rotor(w, th, torque, 0.01)
    assert min(told) == low and max(told) == high
    assert near(found.columns["y"], np.array(speeds))


def test_an_encoder_gives_the_whole_counts_of_the_angle() -> None:
    found = run(ENCODER, 'duration = 20\nsampling.rate = 50\ninputs.T = "sin(t)"')
    exact = found.truth.columns["th"] * 24 / (2 * math.pi)
    counts = found.log.columns["th"]
    assert (counts == np.floor(counts)).all() and found.log.units["th"] == "count"
    phase = counts - exact  # floor(exact + phase), one phase for all
    assert phase.max() - phase.min() < 1
    assert len(set(counts.tolist())) > 10


def test_faults_of_one_target_are_applied_in_their_order() -> None:
    found = run(
        ROTOR,
        "duration = 1\nsampling.rate = 10\ninputs.T = 2\n[[fault]]\nof = 'T'\nchange = '*= 3'\n"
        "at = 0.2\nuntil = 0.5\n[[fault]]\nof = 'T'\nchange = '+= 4'\nat = 0.3\n[[fault]]\n"
        "of = 'T'\nchange = '= 1'\nat = 0.6\nuntil = 0.9\nramp = 0.2",
    )
    assert found.log.columns["T"].tolist() == [2.0] * 11  # told, not as it acts
    t = found.truth.time
    w = 0.0
    speeds = []
    fine = np.linspace(0, 1, 10_001)
    for k in range(10_000):
        if k % 1000 == 0:
            speeds.append(w)
        s = (fine[k] + fine[k + 1]) / 2
        act = 2.0 * (3 if 0.2 <= s < 0.5 else 1) + (4 if s >= 0.3 else 0)
        share = min(1.0, (s - 0.6) / 0.2) if 0.6 <= s < 0.9 else 0.0
        act = (1 - share) * act + share * 1
        w, _ = rotor(w, 0.0, act, fine[k + 1] - fine[k])
    assert near(found.truth.columns["y"], np.array([*speeds, w]), 1e-6)
    assert len(t) == 11


def test_a_stuck_sensor_keeps_its_reading_with_its_noise() -> None:
    found = run(
        ROTOR,
        'duration = 1\nsampling.rate = 100\ninputs.T = "sin(9*t)"\nsensors.y.noise = 0.01\n'
        '[[fault]]\nof = "y"\nchange = "stuck"\nat = 0.3\nuntil = 0.6\n'
        '[[fault]]\nof = "th"\nchange = "missing"\nat = 0.5\nperiod = 0.2\nduty = 0.5',
    )
    read, t = found.log.columns["y"], found.log.time
    stuck = (t >= 0.3) & (t < 0.6)
    assert len(set(read[stuck].tolist())) == 1
    assert abs(read[stuck][0] - found.truth.columns["y"][29]) < 0.05
    assert len(set(read[~stuck].tolist())) == int((~stuck).sum())
    gone = np.isnan(found.log.columns["th"])
    assert gone.tolist() == [50 <= k < 60 or 70 <= k < 80 or 90 <= k < 100 for k in range(101)]


SERVO = (
    "input r\nparam Kp = 2\nparam Ki = 5\nlet e = r - y\nSe:T = Kp*e + Ki*int(e)\n"
    "T -> 1:w\nw -> I:J = 0.5\nw -> R:f = 0.2\nw -> Df:y\nsensor u = Kp*e + Ki*int(e)"
)


@pytest.mark.parametrize("rate", [40, 1000])  # points that are bends, and a long recording
def test_a_controller_of_the_model_gets_noise_and_bias(rate: int) -> None:
    """What the log says of the sensor, less what it truly is, is what acts on the loop."""
    found = run(
        SERVO,
        f"duration = 4\nsampling.rate = {rate}\ninputs.r = 3\n"
        "[sensors.y]\nnoise = 0.3\nbias = 0.1\n[sensors.u]\nnoise = 0.01",
    )
    log, w, t = found.log.columns, found.truth.columns["y"], found.log.time
    added = log["y"] - w
    assert abs(added.mean() - 0.1) < 5 * 0.3 / math.sqrt(len(t))
    assert abs(added.std() - 0.3) < 5 * 0.3 / math.sqrt(2 * len(t))
    # x = (integral of e, w); lsim takes its input in straight lines between the samples
    loop = [[0, -1], [5 / 0.5, -(2 + 0.2) / 0.5]], [[1], [2 / 0.5]], [[0, 1]], [[0]]
    _, moved, states = lsim(loop, 3 - added, t)
    assert near(w, moved, 1e-4)
    told = 2 * (3 - log["y"]) + 5 * states[:, 0]
    assert near(found.truth.columns["u"], told, 1e-4)
    assert 0.005 < (log["u"] - told).std() < 0.02  # whose own noise acts on nothing


def test_noise_and_a_fault_reach_a_controller_together() -> None:
    found = run(
        SERVO,
        "duration = 4\nsampling.rate = 500\ninputs.r = 3\nsensors.y.noise = 0.3\n"
        "[[fault]]\nof = 'y'\nchange = '*= 1.5'\nat = 1\nuntil = 2\nramp = 0.5\n"
        "[[fault]]\nof = 'y'\nchange = 'stuck'\nat = 3",
    )
    e, t = 3 - found.log.columns["y"], found.log.time
    step = np.diff(t)
    held = np.concatenate([[0.0], np.cumsum((e[1:] + e[:-1]) / 2 * step)])
    # a stuck reading jumps, so that its first interval is half of one and half of the other
    assert abs(found.truth.columns["u"] - 2 * e - 5 * held).max() < 5 * 0.3 * 5 * step[0]
    stuck = t >= 3
    assert len(set(found.log.columns["y"][stuck].tolist())) == 1
    assert e[~stuck].std() > 0.2


def test_a_machine_without_an_end_gets_the_noise_of_its_sensors() -> None:
    c = opened(SERVO)
    scenario = read(c, "sampling.rate = 1000\ninputs.r = 3\n[sensors.y]\nnoise = 0.3\nbias = 0.1")
    logs = list(islice(Robot(c.equations, c.integral, scenario).logs(), 150))
    y, u, t = (
        np.concatenate(parts)
        for parts in zip(*((x.columns["y"], x.columns["u"], x.time) for x in logs), strict=True)
    )
    assert t[-1] > 2.5  # more than one window
    e = 3 - y
    held = np.concatenate([[0.0], np.cumsum((e[1:] + e[:-1]) / 2 * np.diff(t))])
    # from window to window the noise jumps
    assert abs(u - 2 * e - 5 * held).max() < 5 * 0.3 * 5 * 0.001
    assert y.std() > 0.25

def test_a_stuck_input_stays_as_it_was_and_a_stuck_parameter_stops_drifting() -> None:
    found = run(
        "param Rf = 2\nSe:T -> 1:w\nw -> R:Rf\nw -> Df:y",
        "duration = 1\nsampling.rate = 10\ninputs.T = '1 + t'\n[[fault]]\nof = 'Rf'\nchange ="
        " '+= 1'\nramp = 1\n[[fault]]\nof = 'Rf'\nchange = 'stuck'\nat = 0.5\n[[fault]]\nof = 'T'\n"
        "change = 'stuck'\nat = 0.8",
    )
    t = found.truth.time
    wanted = (1 + np.minimum(t, 0.8)) / (2 + np.minimum(t, 0.5))
    assert near(found.truth.columns["y"], wanted, 1e-9)


def _charging(t: Array, closed: Callable[[float], bool]) -> Array:
    """v of C = 0.1 F with G = 0.2 S, fed with 12 V through 2 Ohm while the switch is closed.

    0.1 v' = (12 - v)/2 - 0.2 v closed, 0.1 v' = -0.2 v open: an exponential from sample to sample.
    """
    v = [0.0]
    for a, b in zip(t[:-1].tolist(), t[1:].tolist(), strict=True):
        rate, end = (7.0, 6.0 / 0.7) if closed((a + b) / 2) else (2.0, 0.0)
        v.append(end + (v[-1] - end) * math.exp(-rate * (b - a)))
    return np.array(v)


@pytest.mark.parametrize(
    ("change", "closed"),
    [
        ("of = 'on'\nchange = '= false'\nat = 1.3\nuntil = 2.2",
         lambda t: t % 1 < 0.5 and not 1.3 < t < 2.2),
        ("of = 'on'\nchange = '= true'\nat = 1.3", lambda t: t % 1 < 0.5 or t > 1.3),
        ("event = 'welded'\nat = 1.3", lambda t: t % 1 < 0.5 or t > 1.3),
        ("of = 'on'\nchange = 'stuck'\nat = 1.3", lambda t: t % 1 < 0.5 or t > 1.3),
        ("of = 'on'\nchange = 'stuck'\nat = 1.7", lambda t: t % 1 < 0.5 and t < 1.7),
        ("of = 'on'\nchange = '= true'\nat = 1.5\nperiod = 0.4\nduty = 0.25",
         lambda t: t % 1 < 0.5 or (t > 1.5 and (t - 1.5) % 0.4 < 0.1)),
    ],
)  # fmt: skip
def test_a_stuck_switch_is_told_as_if_it_were_not(
    change: str, closed: Callable[[float], bool]
) -> None:
    told = " or ".join(f"({k} <= t and t < {k + 0.5})" for k in range(5))
    found = run(
        "param C = 0.1\nparam G = 0.2\ninput on : bool\nSe:U -> 1:a when on { -> R:R = 2; -> Df:i;"
        " -> 0:o }\no { -> C:C; -> R:load = 1/G; -> De:v }\nfault welded : on = true",
        "duration = 4\nsampling.rate = 10\ninputs.U = 12\n"
        f"inputs.on = '{told}'\n[[fault]]\n{change}",
    )
    t = found.log.time
    v = _charging(t, closed)
    assert near(found.truth.columns["v"], v, 1e-5)
    true = np.array([closed(moment + 1e-6) for moment in t.tolist()])
    assert near(found.log.columns["i"], np.where(true, (12 - v) / 2, 0.0), 1e-4)
    assert found.log.columns["on"].tolist() == [(k % 10) < 5 for k in range(len(t))]


def test_a_command_that_does_not_arrive_is_in_the_log_all_the_same() -> None:
    found = run(
        "Se:T -> 1:w\nw -> R:R = 2\nw -> Df:y",
        "duration = 1\nsampling.rate = 10\ninputs.T = '1 + t'\n[[fault]]\nof = 'T'\n"
        "change = '*= 0'\nat = 0.5",
    )
    t = found.log.time
    assert np.allclose(found.log.columns["T"], 1 + t)
    assert np.allclose(found.log.columns["y"], np.where(t < 0.5, (1 + t) / 2, 0.0))


def test_resolution_bias_noise_and_a_slow_instrument() -> None:
    found = run(
        ROTOR,
        "duration = 50\nsampling.rate = 100\ninputs.T = 'sin(t)'\n[sensors.y]\nstep = 0.25\n"
        "bias = 1\nrate = 10\n[sensors.th]\nnoise = 0.2",
    )
    y, true = found.log.columns["y"], found.truth.columns["y"]
    own = np.arange(5001) // 10 * 10
    assert np.allclose(y, np.round((true[own] + 1) / 0.25) * 0.25)
    noise = found.log.columns["th"] - found.truth.columns["th"]
    assert abs(noise.mean()) < 5 * 0.2 / math.sqrt(5001)
    assert abs(noise.std() - 0.2) < 5 * 0.2 / math.sqrt(2 * 5001)
    assert abs(np.corrcoef(noise[:-1], noise[1:])[0, 1]) < 0.08


def test_an_instrument_that_is_slower_than_the_run_shows_its_first_reading() -> None:
    found = run(ROTOR, "duration = 1\nsampling.rate = 10\ninputs.T = 1\nsensors.y.rate = 1e-300")
    assert found.log.columns["y"].tolist() == [0.0] * 11


def test_jitter_is_in_the_time_stamps_and_lost_samples_are_not_there() -> None:
    text = "duration = 20\nsampling.rate = 100\ninputs.T = 'sin(t)'\n"
    plain = run(ROTOR, text).truth
    found = run(ROTOR, text + "sampling.jitter = 0.4\nsampling.lost = 0.1")
    time = found.log.time
    shift = found.truth.time - plain.time
    assert np.abs(shift).max() <= 0.002 and np.abs(shift).max() > 0.0019
    assert (np.diff(time) > 0).all()
    assert 1700 < len(time) < 1900
    exact = np.interp(time, plain.time, plain.columns["y"])
    assert near(found.log.columns["y"], exact, 1e-4)


def test_inputs_from_a_file(tmp_path: Path) -> None:
    t = np.arange(0, 3, 0.001)
    write_log(Log(t, {"pump": np.sin(t)}, {}, {}), tmp_path / "run.csv")
    (tmp_path / "s.toml").write_text(
        'duration = 2.5\nsampling.rate = 20\ninputs.T = { file = "run.csv", column = "pump" }\n'
    )
    found = opened(ROTOR).simulate(tmp_path / "s.toml").truth
    # 0.5 w' = sin t - 0.2 w
    a, s = 0.4, found.time
    w = 2 * (a * np.sin(s) - np.cos(s) + np.exp(-a * s)) / (1 + a * a)
    assert near(found.columns["y"], w)


def test_one_seed_one_machine_whatever_the_hash_seed(tmp_path: Path) -> None:
    (tmp_path / "s.toml").write_text(
        'duration = 0.05\nseed = 7\nspread = "uniform"\nsensors.all.noise = 0.1\n'
        "sampling.jitter = 0.1\nsampling.lost = 0.1\ninputs.U = 3\n"
        "[[fault]]\nof = 'R'\nchange = '*= 2'\nat = 0.01\n"
    )
    model = Path(__file__).parents[2] / "models" / "dc_motor.bg"
    texts = []
    for seed in ("0", "1"):
        out = tmp_path / f"{seed}.csv"
        words = [
            sys.executable,
            "-m",
            "bondgraph",
            "simulate",
            str(model),
            "s.toml",
            "-o",
            str(out),
        ]
        env = {**os.environ, "PYTHONHASHSEED": seed}
        subprocess.run(words, cwd=tmp_path, env=env, check=True, capture_output=True)
        texts.append(out.read_bytes())
    assert texts[0] == texts[1] and len(texts[0]) > 1000


def test_machines_differ_inside_their_tolerances() -> None:
    machine = example("dc_motor")
    drawn: list[dict[str, float]] = []
    for seed in range(40):
        scenario = read(
            machine, f'duration = 0.001\nseed = {seed}\nspread = "uniform"\ninputs.U = 1'
        )
        drawn.append(machine.simulate(scenario).parameters)
    for value in machine.graph.values:
        numbers = np.array([d[value.name] for d in drawn])
        share = float(value.tolerance or 0)
        nominal = numbers.mean() if share == 0 else float(value.value.number)  # type: ignore[union-attr]
        assert (np.abs(numbers - nominal) <= (share + 1e-12) * nominal).all()
        if share:
            assert numbers.std() > 0.4 * share * nominal


def test_all_methods_agree() -> None:
    machine = example("dc_motor")
    ends: list[Array] = []
    for method in ("LSODA", "Radau", "BDF", "DOP853", "RK45"):
        text = f'duration = 0.2\nsampling.rate = 50\nmethod = "{method}"\ntolerance = 1e-9\n'
        found = machine.simulate(read(machine, text + 'inputs.U = "12*sin(20*t)"')).truth
        ends.append(found.columns["speed"])
    assert all(near(one, ends[0], 1e-6) for one in ends[1:])
