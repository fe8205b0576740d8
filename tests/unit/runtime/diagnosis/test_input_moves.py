"""What an input does to a sensor in the very sample: as relations say, not as a controller does."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest

import bondgraph
from bondgraph.compilation import Compilation
from bondgraph.runtime.diagnosis.input_moves import passed_on
from bondgraph.runtime.log import Array
from bondgraph.runtime.monitoring.verdict import Verdict

_STEP = 0.02
_SHAFT = """bg 1
model Shaft {
    input u
    param kf = 115 N.m +- 5%
    param J = 1.2 kg.m^2 +- 10%
    param b = 0.6 N.m.s/rad +- 30%
    1:shaft { <- Se:engine = kf*u; -> I:J; -> R:b; -> Df:w }
}
"""
_SHUNT = """bg 1
model Shunt {
    input i : A
    param Rs = 3 Ohm +- 5%
    0:wire { <- Sf:i; -> R:Rs; -> De:v }
}
"""


def _compiled(text: str) -> Compilation:
    return bondgraph.compile(Path("m.bg"), text=text, rate=1.0 / _STEP)


def test_what_passes_in_a_sample_is_what_relations_have_of_both() -> None:
    text = _SHAFT.replace("    1:shaft", "    input i : A\n    0:wire { <- Sf:i; -> R:Rs = 3; "
                                         "-> De:v }\n    1:shaft")  # fmt: skip
    engine = _compiled(text).engine()
    names = [k.path for k in engine.signals]
    sizes = np.where([name == "i" for name in names], 0.0, 1.0)  # it stands still
    found = passed_on(engine, names, np.full(len(names), 2.0), sizes)
    gain = {(y, u): found[names.index(y), names.index(u)] for y in "wv" for u in "ui"}
    assert gain["v", "i"] == pytest.approx(3.0, rel=1e-6)
    # kf/J times a sample for what is held; less for what goes in straight lines between samples
    assert 0.3 * 115.0 / 1.2 * _STEP < gain["w", "u"] < 115.0 / 1.2 * _STEP
    assert gain["w", "i"] == gain["v", "u"] == math.inf
    assert np.isinf(passed_on(engine, names, np.full(len(names), math.nan), sizes)).all()


def _governed(spikes: list[int]) -> Array:
    """Of (u, w): a governor sets u by the reading of the same sample, which has spikes."""
    draw, speed, integral, rows = np.random.default_rng(6), 150.0, 0.3, []
    for k in range(6000):
        wanted = 150.0 + 8.0 * math.sin(k * _STEP / 3.0)
        reading = speed + 0.1 * draw.normal() + 6.0 * (k in spikes)
        integral += 0.002 * _STEP * (wanted - reading)
        command = 0.78 + integral - 0.3 + 0.02 * (wanted - reading)
        rows.append((command, reading))
        speed += _STEP / 1.2 * (115.0 * command - 0.6 * speed)
    return np.array(rows)


def _shunted(peaks: list[int]) -> Array:
    """Of (i, v): the current has peaks of a sample, and the voltage has them, too."""
    draw, k = np.random.default_rng(7), np.arange(6000)
    current = np.sin(k * _STEP / 2.0) + 0.02 * draw.normal(size=len(k))
    current[200:2000:150] += 0.5
    current[peaks] += 2.0
    return np.column_stack([current, 3.0 * current + 0.05 * draw.normal(size=len(k))])


def _spikes(c: Compilation, samples: Array) -> list[Verdict]:
    engine = c.engine()
    base, watch = engine.configured(), c.diagnosis(engine)
    said: list[Verdict] = []
    for start in range(0, len(samples), 100):
        part = samples[start : start + 100]
        time = np.arange(start, start + len(part)) * _STEP
        said += watch.update(time, base.run(part), part)
    return [v for v in said if v.event == "fault" and "a spike of" in v.message]


def test_a_governor_that_acts_in_the_same_sample_hides_no_spike() -> None:
    c, at = _compiled(_SHAFT), [3010, 4020, 5030]
    assert [k.path for k in c.engine().signals] == ["u", "w"]
    assert _spikes(c, _governed([])) == []
    told = _spikes(c, _governed(at))
    assert [round((v.since or 0.0) / _STEP) for v in told] == at
    assert all("a spike of w" in v.message for v in told)


def test_a_voltage_has_the_peaks_of_its_current() -> None:
    c = _compiled(_SHUNT)
    assert [k.path for k in c.engine().signals] == ["i", "v"]
    assert _spikes(c, _shunted([3010, 4020, 5030])) == []
