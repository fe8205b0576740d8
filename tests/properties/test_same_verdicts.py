"""What a user may choose freely changes no verdict: the zero of temperature, units, signs."""

from __future__ import annotations

import math
from functools import cache

import numpy as np
import pytest
from scipy.linalg import expm

import bondgraph
from bondgraph.runtime.diagnosis.calibration import tune
from bondgraph.runtime.diagnosis.hypotheses import Hypothesis
from bondgraph.runtime.monitoring.verdict import Verdict

_RATE, _SPAN, _ONSET = 1.0, 2000, 1200
_TRUE = {"G1": 900.0, "G2": 1400.0, "a": 2500.0}
_VARIANTS = (
    (0.0, 1.0, 1.0), (273.15, 1.0, 1.0), (-500.0, 1.0, 1.0), (0.0, 1e-3, 1.0), (0.0, 60.0, 1.0),
    (0.0, 1.0, -1.0), (273.15, 1e-3, -1.0),
)  # fmt: skip


def _model(zero: float, unit: float, sign: float) -> str:
    """Steam heats a wall that heats a liquid; heat in units of `unit` W, temperatures from `zero`.

    The thermometer of the wall shows `sign` times its temperature.
    """
    g1, g2, a = (unit * _TRUE[name] for name in ("G1", "G2", "a"))
    return f"""bg 1
model Exchanger {{
    input q : 1
    param C1 = {unit * 3e4!r} J/K +- 3%
    param C2 = {unit * 5e4!r} J/K +- 3%
    param G1 = {g1!r} W/K +- 3%
    param G2 = {g2!r} W/K +- 3%
    param a = {a!r} W/K +- 3%
    param Ts = {110.0 + zero!r} K
    param Tin = {20.0 + zero!r} K
    Se:steam = Ts -> 1:inside -> 0:wall -> 1:outside -> 0:liquid
    inside -> R:r1 = 1/G1
    wall -> C:C1
    outside -> R:r2 = 1/G2
    liquid {{
        -> C:C2
        -> R:flow {{ f = a*q*(e - Tin) }}
        -> De:th
    }}
    sensor tw : K = {"-" if sign < 0 else ""}wall.e
}}
"""


@cache
def _samples(fault: str) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """The flow and both temperatures in degrees above a zero, exact between samples."""
    draw = np.random.default_rng(3)
    q = np.repeat(draw.uniform(0.2, 0.8, _SPAN // 40), 40)
    x, rows = np.array([80.0, 60.0]), []
    for k in range(_SPAN):
        rows.append(x)
        p = {n: v * (0.7 if n == fault and k >= _ONSET else 1.0) for n, v in _TRUE.items()}
        flow = p["a"] * q[k]
        whole = np.zeros((3, 3))
        whole[0] = np.array([-p["G1"] - p["G2"], p["G2"], p["G1"] * 110.0]) / 3e4
        whole[1] = np.array([p["G2"], -p["G2"] - flow, flow * 20.0]) / 5e4
        x = (expm(whole / _RATE) @ [*x, 1.0])[:2]
    shown = np.array(rows) + 0.05 * draw.standard_normal((_SPAN, 2))
    return q, shown[:, 0], shown[:, 1]


def _told(fault: str, zero: float, unit: float, sign: float) -> list[Verdict]:
    c = bondgraph.compile(text=_model(zero, unit, sign), rate=_RATE, bandwidth=0.1)
    q, wall, liquid = _samples(fault)
    columns = {"q": q, "tw": sign * (wall + zero), "th": liquid + zero}
    engine = c.engine()
    rows = np.column_stack([columns[k.path] for k in engine.signals])
    base, watch = engine.configured(), c.diagnosis(engine)
    time = np.arange(_SPAN) / _RATE
    return [
        v
        for k in range(0, _SPAN, 100)
        for v in watch.update(time[k : k + 100], base.run(rows[k : k + 100]), rows[k : k + 100])
    ]


@pytest.mark.parametrize("fault", ["", "G1", "G2", "a"])
def test_verdicts_are_the_same_in_other_numbers(fault: str) -> None:
    told = [_told(fault, *variant) for variant in _VARIANTS]
    heard = [[(v.event, v.group) for v in said] for said in told]
    assert all(one == heard[0] for one in heard[1:])
    for said in told[1:]:  # a ten-thousandth of a temperature is more of kelvins than of degrees
        assert [v.time for v in said] == pytest.approx([v.time for v in told[0]], abs=2.0 / _RATE)
    alarms = [v for v in told[0] if v.event == "fault"]
    if not fault:
        assert not alarms
        return
    assert len(alarms) == 1 and _ONSET <= alarms[0].time < _ONSET + 200
    for said, (_, unit, _) in zip(told, _VARIANTS, strict=True):
        last = [v for v in said if v.event == "update"][-1]
        assert fault in last.group
        size = next(c.size for c in last.candidates if c.fault == fault)
        assert size == pytest.approx(-0.3 * _TRUE[fault] * unit, rel=0.15)


def test_the_smallest_fault_does_not_depend_on_where_zero_is() -> None:
    """Of what a change of zero does not redefine: a capacity holds more, a gain is of more."""
    found = []
    for zero in (0.0, 273.15, -500.0):
        c = bondgraph.compile(text=_model(zero, 1.0, 1.0), rate=_RATE, bandwidth=0.1)
        q, wall, liquid = _samples("")
        columns = {"q": q, "tw": wall + zero, "th": liquid + zero}
        engine = c.engine()
        rows = np.column_stack([columns[k.path] for k in engine.signals])
        shown = tune(engine, c.diagnosis_model, [rows], "digest", 1.0, 400.0).shown
        found.append({_name(s.hypothesis): s.size or math.inf for s in shown})
    free = {("q", "gain"), ("tw", "offset"), ("th", "offset"), ("Ts", "value"), ("Tin", "value"),
            *((name, "value") for name in _TRUE)}  # fmt: skip
    for other in found[1:]:
        wanted = {k: found[0][k] for k in free}
        assert {k: other[k] for k in free} == pytest.approx(wanted, rel=1e-6)


def _name(hypothesis: Hypothesis) -> tuple[str, str]:
    return hypothesis.fault, hypothesis.kind
