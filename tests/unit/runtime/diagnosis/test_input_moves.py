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


def _gain(text: str, sample: float, **sizes: float) -> dict[tuple[str, str], float]:
    """How far sensors go for a unit of each input, by their names."""
    engine = _compiled(text).engine()
    names = [k.path for k in engine.signals if k.counts is None]
    size = np.array([sizes.get(name, 1.0) for name in names])
    found = passed_on(engine, names, np.full(len(engine.signals), sample), size)
    return {(y, u): float(found[j, k]) for j, y in enumerate(names) for k, u in enumerate(names)}


def test_what_passes_in_a_sample_keeps_all_relations() -> None:
    text = _SHAFT.replace("    1:shaft", "    input i : A\n    0:wire { <- Sf:i; -> R:Rs = 3; "
                                         "-> De:v }\n    1:shaft")  # fmt: skip
    gain = _gain(text, 2.0, i=0.0)  # it stands still
    assert gain["v", "i"] == pytest.approx(3.0, rel=1e-6)
    # kf/J times a sample for what is held; less for what goes in straight lines between samples
    assert 0.3 * 115.0 / 1.2 * _STEP < gain["w", "u"] < 115.0 / 1.2 * _STEP
    assert gain["w", "i"] == gain["v", "u"] == 0.0
    assert all(map(math.isinf, _gain(text, math.nan, i=0.0).values()))


def test_an_input_does_not_reach_a_position_behind_two_storages_in_a_sample() -> None:
    """One relation has the force and both: a position that answered alone would go 16 mm."""
    gain = _gain(
        """bg 1
model Carts {
    input F : N
    param m = 2 kg
    param k = 60 N/m
    1:first { <- Se:F; -> I:a = m; -> tie; -> Df:v }
    0:tie { -> C:spring = 1/k; -> second }
    1:second { -> I:b = m }
    sensor x : m = spring.q
}
""",
        0.0,
    )
    assert 0.3 * _STEP / 2.0 < gain["v", "F"] < _STEP / 2.0
    # x'' = (F - 2 k x)/m for the force alone: less than half of the square of a sample
    assert gain["x", "F"] < 0.5 * _STEP**2 / 2.0 < 0.02 / 60.0


def test_where_relations_do_not_tell_all_sensors_each_may_answer_alone() -> None:
    gain = _gain(
        """bg 1
model Tied {
    input u : N
    input i : A
    input load : N unknown
    param k = 60 N/m
    param m = 2 kg
    1:near { <- Se:u; -> I:m; -> tie; -> Df:v }
    0:tie { -> C:spring = 1/k; -> far }
    1:far { <- Se:load; -> I:M = m }
    sensor f : N = spring.e
    0:wire { <- Sf:i; -> R:Rs = 3 Ohm; -> De:e }
}
""",
        0.0,
    )
    # u = m v' + f: either of both would do
    assert gain["f", "u"] == pytest.approx(1.0, rel=1e-6)
    assert 0.3 * _STEP / 2.0 < gain["v", "u"] < _STEP / 2.0
    assert gain["f", "i"] == gain["v", "i"] == math.inf and gain["e", "i"] == pytest.approx(3.0)


def test_an_encoder_answers_as_other_sensors_do() -> None:
    """U = R i + k w and k i = J w' + b w: of dU the winding turns k dw into speed.

    dw is between 0.3 and 0.5 of k di T/J, as of any storage in a sample.
    """
    gain = _gain(
        """bg 1
model Motor {
    input U : V
    param R = 2 Ohm
    param k = 3 N.m/A
    1:coil { <- Se:U; -> R:R; -> GY:k -> shaft; -> Df:i }
    1:shaft { -> I:J = 0.5; -> R:b = 1 }
    sensor angle : rad = int(shaft.f) counts 1000/turn
}
""",
        0.0,
    )
    speed = 3.0**2 * _STEP / 0.5  # k^2 T/J
    assert 1.0 / (2.0 + 0.5 * speed) < gain["i", "U"] < 1.0 / (2.0 + 0.3 * speed)


def test_an_input_reaches_no_sensor_behind_an_encoder_in_a_sample() -> None:
    """No relation has both: a brake on a roll, its encoder, and the web beyond its inertia."""
    gain = _gain(
        """bg 1
model Web {
    input u : N.m
    input v : m/s
    param J = 0.4
    param b = 0.05
    param EA = 2000 N/m
    1:roll { <- Se:brake = -u; -> I:J; -> R:b; -> TF:rim { f2 = 0.2*f1 } -> web }
    0:web { -> stretch; <- pull }
    1:stretch { -> C:C = 1/EA; -> R:loss = 40 }
    1:pull { <- Sf:nip = v }
    sensor th : rad = int(roll.f) counts 4000/turn
    sensor F : N = web.e
}
""",
        0.0,
    )
    # F = EA x + 40 x' with x' = v - 0.2 w and w' = -u/J, all of which acts for a sample at most
    most = (40.0 + 2000.0 * _STEP) * 0.2 * _STEP / 0.4
    assert 0.0 < gain["F", "u"] < most


def _governed(spikes: list[int], noisy: range = range(0)) -> Array:
    """Of (u, w): a governor sets u by the reading of the same sample, which has spikes.

    Or is noisy for a while.
    """
    draw, speed, integral, rows = np.random.default_rng(6), 150.0, 0.3, []
    for k in range(6000):
        wanted = 150.0 + 8.0 * math.sin(k * _STEP / 3.0)
        reading = speed + 0.1 * draw.normal() * (8.0 if k in noisy else 1.0)
        reading += 6.0 * (k in spikes)
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


def _told(c: Compilation, samples: Array, what: str) -> list[Verdict]:
    engine = c.engine()
    base, watch = engine.configured(), c.diagnosis(engine)
    said: list[Verdict] = []
    for start in range(0, len(samples), 100):
        part = samples[start : start + 100]
        time = np.arange(start, start + len(part)) * _STEP
        said += watch.update(time, base.run(part), part)
    return [v for v in said if v.event == "fault" and what in v.message]


def _spikes(c: Compilation, samples: Array) -> list[Verdict]:
    return _told(c, samples, "a spike of")


def test_a_governor_that_acts_in_the_same_sample_hides_no_spike() -> None:
    c, at = _compiled(_SHAFT), [3010, 4020, 5030]
    assert [k.path for k in c.engine().signals] == ["u", "w"]
    assert _spikes(c, _governed([])) == []
    told = _spikes(c, _governed(at))
    assert [round((v.since or 0.0) / _STEP) for v in told] == at
    assert all("a spike of w" in v.message for v in told)


def test_noise_that_a_governor_answers_in_the_same_sample_is_that_of_the_sensor() -> None:
    (told,) = _told(_compiled(_SHAFT), _governed([], range(4000, 4600)), "a burst of noise of")
    assert "of w" in told.message and 4000 * _STEP < told.time < 4300 * _STEP


def test_a_voltage_has_the_peaks_of_its_current() -> None:
    c = _compiled(_SHUNT)
    assert [k.path for k in c.engine().signals] == ["i", "v"]
    assert _spikes(c, _shunted([3010, 4020, 5030])) == []
