"""A fault that grows is told again with its size, and as one fault."""

from __future__ import annotations

from pathlib import Path

import numpy as np

import bondgraph

_ROOT = Path(__file__).parents[4]
_SCENARIO = """
duration = "56 s"
[inputs]
U = "12*(1 + 0.2*sin(2*pi*t))"
load = 0
[sampling]
rate = "1 kHz"
[sensors.current]
noise = "2 mA"
[sensors.speed]
noise = "1 rad/s"
[[fault]]
of = "current"
change = "*= 1.3"
at = "20 s"
ramp = "30 s"
"""


def test_a_sensor_that_drifts_away_is_followed(tmp_path: Path) -> None:
    (tmp_path / "drift.toml").write_text(_SCENARIO)
    c = bondgraph.compile(_ROOT / "models" / "dc_motor.bg")
    log = c.simulate(c.scenario(tmp_path / "drift.toml")).log
    engine = c.engine()
    samples = np.column_stack([log.columns[k.path] for k in engine.signals])
    watch, base, said = c.diagnosis(engine), engine.configured(), []
    for k in range(0, len(samples), 500):
        part = samples[k : k + 500]
        said += watch.update(log.time[k : k + 500], base.run(part), part)
    told = [v for v in said if v.event == "update"]
    assert not any(v.pairs for v in told)
    assert {v.candidates[0].fault for v in told} == {"current"}
    sizes = [(v.time, v.candidates[0].size or 0.0) for v in told]
    assert len(sizes) >= 3
    for time, size in sizes:  # one per cent a second, from 20 s on
        assert abs(size - (time - 20.0)) < 4.0, sizes
    assert sizes[-1][1] > 2.0 * sizes[0][1]
