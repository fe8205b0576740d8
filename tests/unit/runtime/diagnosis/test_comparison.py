"""Faults that are large where laws are bent, and the sample at which they set in."""

from __future__ import annotations

import numpy as np
import pytest

import bondgraph
from bondgraph.pipeline import Compilation
from bondgraph.runtime.diagnosis.comparison import Comparison
from bondgraph.runtime.diagnosis.hypotheses import Bank, hypotheses
from bondgraph.runtime.diagnosis.isolation import History
from bondgraph.runtime.diagnosis.rows import Row
from bondgraph.runtime.monitoring.verdict import Verdict
from bondgraph.text.source import Source

_J, _C, _W0 = 0.02, 1.5, 2.0
_MODEL = f"""bg 1
model Brake {{
    input T : N.m
    param J = {_J} kg.m^2
    param c = {_C} N.m
    param w0 = {_W0} rad/s
    1:rotor {{
        <- Se:T
        -> I:J
        -> R:drag {{ e = c*tanh(f/w0) }}
    }}
    sensor w : rad/s = rotor.f
}}
"""
_RATE = 500.0
_ONSET = 9.137  # s, in the middle of a row


def _said(c: float = _C, w0: float = _W0) -> list[Verdict]:
    """The speed is given, and the torque that it takes: J w' + c tanh(w/w0), c or w0 changed."""
    brake = Compilation(Source("brake.bg", _MODEL), options=bondgraph.Options(rate=_RATE))
    engine = brake.engine()
    t = np.arange(round(16.0 * _RATE)) / _RATE
    w = 1.5 + np.sin(2.0 * t) + 0.7 * np.sin(5.1 * t)
    rate = 2.0 * np.cos(2.0 * t) + 0.7 * 5.1 * np.cos(5.1 * t)
    late = t >= _ONSET
    drag = np.where(late, c, _C) * np.tanh(w / np.where(late, w0, _W0))
    draw = np.random.default_rng(5)
    columns = {"T": _J * rate + drag, "w": w + 1e-3 * draw.normal(size=len(t))}
    rows = np.column_stack([columns[k.path] for k in engine.signals])
    diagnosis, base = brake.diagnosis(engine), engine.configured()
    said: list[Verdict] = []
    for k in range(0, len(t), 333):
        part = rows[k : k + 333]
        said += diagnosis.update(t[k : k + 333], base.run(part), part)
    return said


@pytest.mark.parametrize(
    ("fault", "value", "change"),
    [("w0", 4.0 * _W0, 3.0 * _W0), ("w0", 0.3 * _W0, -0.7 * _W0), ("c", 2.0 * _C, _C)],
)
def test_a_large_fault_of_a_bent_law_has_its_true_size(
    fault: str, value: float, change: float
) -> None:
    last = [v for v in _said(**{fault: value}) if v.event == "update"][-1]
    assert last.candidates[0].fault == fault
    assert last.candidates[0].size == pytest.approx(change, rel=0.06)
    assert last.candidates[0].probability > 0.7


def test_a_fault_is_dated_within_the_time_that_the_filter_takes() -> None:
    for value in (4.0 * _W0, 1.5 * _W0):
        alarm = next(v for v in _said(w0=value) if v.event == "fault")
        assert alarm.since == pytest.approx(_ONSET, abs=0.1)


def test_what_is_found_late_goes_on_from_where_the_samples_are() -> None:
    # more rows than samples are kept of, before anybody asks: slopes go on as in one run
    brake = Compilation(Source("brake.bg", _MODEL), options=bondgraph.Options(rate=_RATE))
    engine, facts = brake.engine(), brake.diagnosis_model
    known = hypotheses(engine, facts.faults, facts.units, {})
    nominal = facts.nominal
    t = np.arange(70 * 20) / _RATE
    columns = {"T": np.sin(9.0 * t), "w": 2.0 + np.cos(7.0 * t)}
    samples = np.column_stack([columns[k.path] for k in engine.signals])
    slopes = Bank(engine.configured(), known, nominal).run(samples)[19::20]
    compared = Comparison(engine.configured(), samples[:0], 0, known, nominal)
    one, nothing = np.ones(1), np.zeros((0, 1))
    for k in range(70):
        part = samples[20 * k : 20 * k + 20]
        compared.step(Row(0.0, part, engine, 0.1 * k * one, one > 0, one, one, nothing), one)
        if k > 64:
            compared.explained(History(np.zeros(0)))
    assert compared._rows[-1].slopes == pytest.approx(slopes[-1], rel=1e-9, abs=1e-12)
