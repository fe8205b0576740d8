"""A fault of an oscillator moves the mean of no residual, and is seen by how loud rows are."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest

import bondgraph
from bondgraph import Course, Scenario
from bondgraph.runtime.diagnosis.cusum import Cusum
from bondgraph.runtime.diagnosis.rows import Row
from bondgraph.runtime.log import Array, Mask
from bondgraph.runtime.simulation.scenario import Fault, Sampling

_MODEL = """bg 1
model Shaker {
    input F : N
    param m = 2 kg +- 3%
    param k = 2 kN/m +- 3%
    param c = 6 N.s/m +- 3%

    1:mass {
        <- Se:F
        -> I:m
        -> C:spring = 1/k
        -> R:c
        -> Df:v
    }
    sensor x : m = spring.q
}
"""
_RATE, _ONSET, _END = 500.0, 20.0, 32.0


def test_a_mass_that_is_wrong_makes_an_oscillation_louder_and_no_mean(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    c = bondgraph.compile(Path("shaker.bg"), text=_MODEL, rate=_RATE)
    time = np.arange(round(_END * _RATE) + 2) / _RATE
    turned = 2.0 * math.pi * 5.0 * time + np.sin(0.7 * time)
    force = (7.0 + 2.0 * np.sin(0.9 * time)) * np.sin(turned)
    heavier = Fault("m", "*=", 1.07, _ONSET)
    log = c.simulate(
        Scenario(
            "shaken", duration=_END, seed=1, start="initial", sampling=Sampling(_RATE),
            inputs={"F": Course(None, tuple(zip(time.tolist(), force.tolist(), strict=True)))},
            faults=(heavier,), tolerance=1e-6,
        )
    ).log  # fmt: skip
    draw = np.random.default_rng(1)
    engine = c.engine()
    columns = []
    for known in engine.signals:
        column = log.columns[known.path]
        size = 0.0075 * float(np.sqrt(np.mean(column**2))) * (known.kind == "sensor")
        columns.append(column + size * draw.standard_normal(len(column)))
    samples = np.column_stack(columns)[: len(log.time)]

    sums: list[Array] = []  # beside their heights, of r1

    def added(self: Cusum, row: Row, limits: Array) -> Mask:
        over = add(self, row, limits)
        if row.time > _ONSET:
            sums.append(self.sums[:, 0] / self._tops(limits)[:, 0])
        return over

    add = Cusum.add
    monkeypatch.setattr(Cusum, "add", added)
    watch, base = c.diagnosis(engine), engine.configured()
    said = watch.update(np.asarray(log.time), base.run(samples), samples)
    alarm = next(v for v in said if v.event == "fault")
    assert _ONSET < alarm.time < _ONSET + 10.0 and "r1" in alarm.residuals
    named = [v.group for v in said if v.group]
    assert named and "m" in named[-1]
    above, below, loud, *averages = np.max(sums, axis=0)
    assert loud > 1.0 > max(above, below, *averages)
