"""A law of filtered derivatives: what is small beside the noise of a sample is seen in sums.

And is over with them, whatever a signal shows.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import bondgraph
from bondgraph import Course, Scenario
from bondgraph.runtime.diagnosis.detection import Detection
from bondgraph.runtime.diagnosis.learning import Learning
from bondgraph.runtime.diagnosis.rows import Row
from bondgraph.runtime.diagnosis.signal_checks import SignalChecks
from bondgraph.runtime.log import Array, Mask
from bondgraph.runtime.monitoring.verdict import Verdict
from bondgraph.runtime.simulation.scenario import Fault, Sampling

_AXIS = """bg 1
model Axis {
    input i : A
    param g = 35 N/A
    param M = 97 kg +- 3%
    param Fv = 210 N.s/m +- 6%
    param Fc = 20 N +- 10%
    param cut = 0 N
    const v0 = 2 mm/s

    1:car {
        <- Se:drive = g*i
        -> I:M
        -> R:Fv
        -> R:guide { e = Fc*tanh(f/v0) + cut }
    }
    sensor q : m = int(car.f)
}
"""
_RATE, _ONSET, _OVER, _END = 1000.0, 3.0, 4.2, 5.0
_NOISE = 3e-6  # m, of the sensor
_LOAD = 12.0  # N, of a tool that cuts


def test_a_load_less_than_a_sample_shows_is_told_while_it_lasts_where_a_guide_rubs() -> None:
    assert not any(v.event == "fault" for v in _watched())

    said = _watched(Fault("cut", "+=", _LOAD, _ONSET, _OVER))
    told = [v for v in said if v.event in ("fault", "update", "cleared")]
    assert [v.event for v in (told[0], told[-1])] == ["fault", "cleared"]
    assert _ONSET < told[0].time < _ONSET + 0.1
    assert _OVER < told[-1].time < _OVER + 0.1
    last = next(v for v in reversed(told) if v.candidates)
    assert all(level < 1.0 for level in last.residuals.values()), "no sample was beyond its limit"
    best = max(last.candidates, key=lambda c: c.probability)
    assert best.fault == "cut"
    assert best.size is not None and abs(best.size - _LOAD) < 0.1 * _LOAD


def test_what_is_over_but_for_a_signal_is_not_explained_when_that_is_as_ever(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    # a signal has spikes until 3.5 s, and the residual that these moved is back before
    def row(checks: SignalChecks, time: float, *_: object) -> list[object]:
        checks.active = {"q": 0} if _ONSET + 0.04 < time < 3.5 else {}
        return []

    monkeypatch.setattr(SignalChecks, "row", row)
    monkeypatch.setattr(SignalChecks, "lately", lambda checks, _: bool(checks.active))
    monkeypatch.setattr(Detection, "over", lambda _, row, *__: row.time > 3.3)
    said = _watched(Fault("cut", "+=", _LOAD, _ONSET, _OVER))
    told = [v for v in said if v.event in ("fault", "update", "cleared")][:2]
    assert [v.event for v in told] == ["fault", "cleared"]
    assert 3.5 <= told[1].time < 3.52


def test_rows_in_which_a_signal_is_unusual_tell_nothing_of_noise(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    seen: dict[float, bool] = {}
    learns = Learning.row

    def learned(self: Learning, row: Row, healthy: bool, held: Array) -> Mask:
        seen[row.time] = healthy
        return learns(self, row, healthy, held)

    def row(checks: SignalChecks, time: float, *_: object) -> list[object]:
        checks.active = {"q": 0} if 2.0 < time < 2.5 else {}
        return []

    monkeypatch.setattr(Learning, "row", learned)
    monkeypatch.setattr(SignalChecks, "row", row)
    _watched()
    assert len(seen) > 100
    assert all(healthy != (2.0 < time < 2.5) for time, healthy in seen.items())


def _watched(*faults: Fault) -> list[Verdict]:
    """What a watch without a tuning says of an axis that goes to and fro."""
    c = bondgraph.compile(Path("axis.bg"), text=_AXIS, rate=_RATE, bandwidth=300.0)
    time = np.arange(round(_END * _RATE) + 2) / _RATE
    current = 1.2 * np.sin(9.0 * time) + 0.6 * np.sin(23.0 * time + 1.0)
    log = c.simulate(
        Scenario(
            "to and fro", duration=_END, seed=1, start="initial", sampling=Sampling(_RATE),
            inputs={"i": Course(None, tuple(zip(time.tolist(), current.tolist(), strict=True)))},
            faults=faults, tolerance=1e-8,
        )
    ).log  # fmt: skip
    engine = c.engine()
    samples = np.column_stack([log.columns[signal.path] for signal in engine.signals])
    sensor = [signal.kind for signal in engine.signals].index("sensor")
    samples[:, sensor] += _NOISE * np.random.default_rng(1).standard_normal(len(samples))
    base, watch = engine.configured(), c.diagnosis(engine)
    said: list[Verdict] = []
    for start in range(0, len(samples), 1000):
        part = samples[start : start + 1000]
        said += watch.update(log.time[start : start + 1000], base.run(part), part)
    return said
