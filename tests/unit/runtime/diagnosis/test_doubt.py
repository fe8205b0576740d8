"""A converter holds a command for a sample: a charging capacitor, whose samples are then exact.

With U held from k to k+1, v[k+1] = U[k] + (v[k] - U[k]) exp(-T/RC).
"""

from __future__ import annotations

import math

import numpy as np

from bondgraph.compile_options import Options
from bondgraph.pipeline import Compilation
from bondgraph.runtime.diagnosis.calibration import tune
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
