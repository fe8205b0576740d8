"""What is in doubt of a residual for no parameter: commands that are held, laws of rates.

A converter holds a command for a sample: a charging capacitor, whose samples are then exact.

With U held from k to k+1, v[k+1] = U[k] + (v[k] - U[k]) exp(-T/RC).
"""

from __future__ import annotations

import math

import numpy as np
import pytest

from bondgraph.compilation import Compilation
from bondgraph.compile_options import Options
from bondgraph.runtime.diagnosis.calibration import tune
from bondgraph.runtime.diagnosis.doubt import Doubt
from bondgraph.runtime.log import Array
from bondgraph.text.source import Source

_STEP, _COUNT, _NOISE = 0.01, 12_000, 1e-4
_TEXT = """bg 1
model Charging {
    param R = 2 kOhm
    1:s { <- Se:U; -> R:r = R; -> 0:n }
    n { -> C:c = 500 uF; -> De:v }
}
"""


def _log(seed: int, volts: float, other: float = 1.0) -> Array:
    """Steps of up to so many `volts` to either side; late R is `other` times as large."""
    draw = np.random.default_rng(seed)
    command = np.repeat(draw.uniform(-volts, volts, _COUNT // 200), 200)
    voltage = np.zeros(_COUNT)
    for k in range(1, _COUNT):
        constant = 2e3 * 500e-6 * (other if k >= 2 * _COUNT // 3 else 1.0)
        kept = math.exp(-_STEP / constant)
        voltage[k] = command[k - 1] + (voltage[k - 1] - command[k - 1]) * kept
    return np.column_stack([command, voltage + draw.normal(0.0, _NOISE, _COUNT)])


def test_steps_of_a_held_command_are_no_fault_however_large() -> None:
    """A tuning of small steps, then steps fifty times as large; a tenth more of R shows."""
    made = Compilation(Source("m.bg", _TEXT), None, Options(rate=1.0 / _STEP))
    engine = made.engine()
    assert [k.path for k in engine.signals] == ["U", "v"]
    logs = [_log(1, 0.1)]
    tuning = tune(engine, made.diagnosis_model, logs, made.program.digest, 1.0).tuning
    made = made.tuned(tuning)
    for other in (1.0, 1.1):
        log = _log(2, 5.0, other)
        own = made.engine()
        said = made.diagnosis(own, tuning).update(np.arange(_COUNT) * _STEP, own.run(log), log)
        fired = [v.time for v in said if v.event == "fault"]
        assert bool(fired) == (other > 1.0)
        assert all(time >= 2 * _COUNT // 3 * _STEP for time in fired)


_CAR = """bg 1
model Car {
    input pull : N unknown
    1:car { <- Se:pull; -> I:m = 750 kg }
    sensor x : m = int(car.f)
    sensor a : m/s^2 = der(car.f)
}
"""


def _let_go(seed: int, share: float, bias: float) -> Array:
    """Of (x, a): a car that moves with sin(t) and is let go by 5 m/s^2 at 60 and 100 s.

    That share of a sample earlier. The accelerometer has a `bias` from 80 s on.
    """
    t = np.arange(_COUNT) * _STEP
    place, rate = t - np.sin(t), np.sin(t) + bias * (t >= 80.0)
    for at in (60.0, 100.0):
        since = np.maximum(t - at + share * _STEP, 0.0)
        place -= 5.0 * (since - 1.0 + np.exp(-since))
        rate -= 5.0 * np.exp(-since) * (since > 0.0)
    noise = np.random.default_rng(seed).normal(size=(2, _COUNT))
    return np.column_stack([place + 1e-5 * noise[0], rate + 0.005 * noise[1]])


@pytest.mark.parametrize("share", [0.1, 0.5, 0.9])
@pytest.mark.parametrize("bias", [0.0, 0.3])
def test_a_reading_that_jumps_between_two_samples_is_no_fault(share: float, bias: float) -> None:
    """Of a = x'' both are right; straight lines to the reading behind the jump are not."""
    made = Compilation(Source("m.bg", _CAR), None, Options(rate=1.0 / _STEP))
    engine = made.engine()
    assert [k.path for k in engine.signals] == ["x", "a"]
    log = _let_go(1, share, bias)
    said = made.diagnosis(engine).update(np.arange(_COUNT) * _STEP, engine.run(log), log)
    named = [v.candidates[0].fault for v in said if v.event == "update"]
    assert [v.event for v in said].count("fault") == bool(bias)
    assert named == (["a"] if bias else [])
    assert all(v.time > 80.0 for v in said if v.event == "fault")


_DRAG = """bg 1
model Drag {
    input F : N
    param m = 2 kg
    param c = 3 N.s^2/m^2
    1:body { <- Se:F; -> I:m; -> C:spring = 0.1 m/N; -> R:drag { e = c*f*abs(f) } }
    sensor x : m = spring.q
}
"""


def _approximate(fast: float, step: float, bandwidth: float = 5.0) -> tuple[Array, Array]:
    """The residual of a body in a known motion of `fast` rad/s, and its doubt: of each row.

    The force is read `step` too large from 30 s on.
    """
    made = Compilation(Source("m.bg", _DRAG), None, Options(rate=100.0, bandwidth=bandwidth))
    engine = made.engine()
    t = np.arange(6000) / 100.0
    x, speed = -np.cos(fast * t) / fast, np.sin(fast * t)
    drag = 3.0 * speed * np.abs(speed)
    force = 2.0 * fast * np.cos(fast * t) + 10.0 * x + drag + step * (t >= 30.0)
    columns = {"F": force, "x": x}
    samples = np.column_stack([columns[k.path] for k in engine.signals])
    doubt, found = Doubt(engine, made.diagnosis_model), []
    nothing = np.zeros(1)
    for start in range(0, len(t), 777):
        part = samples[start : start + 777]
        batch = engine.run(part)
        # commands that are held are not looked at here
        own, valid = doubt.run(part, batch, start, nothing, nothing + np.inf)
        found.append(np.column_stack([batch.value[:, 0], own[:, 0], valid[:, 0]]))
    value, off, valid = np.concatenate(found).T
    settled = (t > 10.0) & (valid > 0)
    assert settled.sum() > 4500
    return value[settled], off[settled]


@pytest.mark.parametrize("fast", [0.5, 1.0, 2.0])
def test_a_law_of_a_filtered_rate_is_off_by_less_than_its_doubt(fast: float) -> None:
    value, doubt = _approximate(fast, 0.0)
    assert (np.abs(value) <= doubt).all() and np.abs(value).max() > 1e-4
    assert np.median(doubt) < 4.0 * np.abs(value).max()


@pytest.mark.parametrize("bandwidth", [60.0, 90.0, 140.0])
def test_a_filter_as_fast_as_the_samples_is_held_against_none_that_is_faster(
    bandwidth: float,
) -> None:
    """Of 100 samples a second none is faster than 200 rad/s: the mean of two samples."""
    value, doubt = _approximate(1.0, 0.0, bandwidth)
    assert np.abs(value).max() < 1e-3 and np.isfinite(doubt).all() and doubt.max() < 1e-2


def test_a_step_of_what_is_linear_is_in_no_doubt_however_fast() -> None:
    """The filter shows a step of 20 N sooner or later by some way; both ways are the same."""
    healthy, doubt = _approximate(1.0, 0.0)
    value, other = _approximate(1.0, 20.0)
    assert np.abs(value - healthy).max() == pytest.approx(20.0, rel=1e-6)
    assert other == pytest.approx(doubt, abs=1e-9)
