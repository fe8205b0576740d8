"""The noise of one residual from its first rows: when it is known, and how large it is."""

from __future__ import annotations

import math

import numpy as np
import pytest

from bondgraph.pipeline import Compilation
from bondgraph.runtime.diagnosis.hypotheses import Hypothesis
from bondgraph.runtime.diagnosis.learning import STEPS, Learning
from bondgraph.runtime.diagnosis.rows import Row
from bondgraph.runtime.monitoring.engine import Engine
from bondgraph.text.source import Source

_TEXT = """bg 1
model M {
    param R = 2 Ohm
    1:s { <- Se:U; -> R:r = R; -> Df:i }
}
"""


def learner(*known: Hypothesis) -> tuple[Learning, Engine]:
    model = Compilation(Source("m.bg", _TEXT))
    engine = model.engine(native=False)
    return Learning(engine, known, np.ones(1, dtype=bool), model.diagnosis_model), engine


def row(engine: Engine, value: float, valid: bool = True) -> Row:
    """A row of a hundred equal samples, U = 6 V and i = 3 A."""
    nothing = np.zeros(1)
    samples = np.tile([6.0, 3.0], (100, 1))
    ends = np.array([value]), np.array([valid]), nothing, nothing, np.zeros((0, 1))
    return Row(0.0, samples, engine, *ends)


def test_the_noise_is_known_after_ten_steps_and_is_twice_what_they_show() -> None:
    learning, engine = learner()
    values = [0.0, 1.0, 3.0, 6.0, 10.0, 15.0, 21.0, 28.0, 36.0, 45.0, 55.0]  # steps of 1 to 10
    told = [bool(learning.row(row(engine, v), True)[0]) for v in values]
    assert told == [False] * STEPS + [True]
    # steps of two independent numbers are sqrt(2) larger; half of normal numbers are below 0.6745
    median = 5.5 / math.sqrt(2.0)
    assert learning.limits[0, 0] == pytest.approx(2.0 * median / 0.6745, rel=1e-3)
    assert learning.over


def test_rows_that_do_not_count_are_no_neighbours() -> None:
    learning, engine = learner()
    for value in (0.0, 1.0, 0.0, 1.0, 0.0, 1.0):
        assert not learning.row(row(engine, value), True)[0]  # five steps
    assert not learning.row(row(engine, 1e6), False)[0]
    assert not learning.row(row(engine, 1e6, valid=False), True)[0]
    for value in (0.0, 1.0, 0.0, 1.0, 0.0):
        assert not learning.row(row(engine, value), True)[0]  # four more
    assert learning.row(row(engine, 1.0), True)[0]
    assert learning.limits[0, 0] == pytest.approx(2.0 / math.sqrt(2.0) / 0.6745, rel=1e-3)


def test_a_residual_that_does_not_move_at_all_has_no_noise_yet() -> None:
    learning, engine = learner()
    for _ in range(2 * STEPS):
        assert not learning.row(row(engine, 0.0), True)[0]
    assert learning.limits[0, 0] == math.inf
    values = [float(k % 2) for k in range(STEPS + 1)]  # and then it does
    assert any(learning.row(row(engine, v), True)[0] for v in values)
    assert 0.0 < learning.limits[0, 0] < 2.0


def test_no_sensor_is_better_than_a_ten_thousandth_of_what_it_does() -> None:
    learning, engine = learner(Hypothesis("i", "gain", "", 0.3, False))
    for _ in range(STEPS):
        learning.row(row(engine, 0.5), True)
    assert learning.row(row(engine, 0.5), True)[0]
    # R i is 6 V behind a filter that has long settled after eleven rows of a tenth of a second
    assert learning.limits[0, 0] == pytest.approx(6e-4, rel=1e-3)
