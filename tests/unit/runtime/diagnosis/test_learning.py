"""The noise of one residual from its first rows: when it is known, and how large it is."""

from __future__ import annotations

import math
from collections import deque
from itertools import count

import numpy as np
import pytest

import bondgraph
from bondgraph.compilation import Compilation
from bondgraph.runtime.diagnosis.detection import Detection
from bondgraph.runtime.diagnosis.history import HEALTHY, History
from bondgraph.runtime.diagnosis.hypotheses import Hypothesis
from bondgraph.runtime.diagnosis.learning import FIRST, LATE, Learning
from bondgraph.runtime.diagnosis.rows import Row
from bondgraph.runtime.monitoring.engine import Engine
from bondgraph.text.source import Source

_NEW = History(np.zeros(0))  # nothing is tolerated
_TIMES = count(1.0)  # of rows that follow each other

_TEXT = """bg 1
model M {
    param R = 2 Ohm
    1:s { <- Se:U; -> R:r = R; -> Df:i }
}
"""


def learner(*known: Hypothesis) -> tuple[Learning, Engine]:
    model = Compilation(Source("m.bg", _TEXT))
    engine = model.engine()
    return Learning(engine, known, np.ones(1, dtype=bool), model.diagnosis_model), engine


def row(engine: Engine, value: float, valid: bool = True) -> Row:
    """A row of a hundred equal samples, U = 6 V and i = 3 A."""
    nothing = np.zeros(1)
    samples = np.tile([6.0, 3.0], (100, 1))
    ends = np.array([value]), np.array([valid]), nothing, nothing, np.zeros((0, 1))
    return Row(0.0, samples, engine, *ends)


def told(
    learning: Learning, raw: Row, healthy: bool = True, held: np.ndarray | None = None
) -> bool:
    """Whether the noise is known with this row, that no parameter moves, as the watch has it."""
    nothing = np.zeros(1) if held is None else held
    known = learning.row(beside(learning, raw), healthy, nothing)
    learning.levels.ahead(alarmed=not healthy)
    if healthy:
        follow(learning, raw)
    return bool(known[0])


def follow(learning: Learning, raw: Row) -> None:
    """Where the residual stands, with a row of a healthy machine more."""
    one, room = beside(learning, raw), learning.levels.unsure
    learning.limits[:, 4] += learning.levels.learn(next(_TIMES), one.value, room, one.valid)
    learning.limits[:, 4] += learning.levels.drifted(learning.limits)


def beside(learning: Learning, raw: Row) -> Row:
    """A row beside where its residual stands."""
    room = learning.levels.unsure
    return raw._replace(value=raw.value - learning.limits[:, 4], bound=room, doubt=room)


def drawn(count: int, sigma: float = 1.0) -> list[float]:
    return [float(x) for x in sigma * np.random.default_rng(7).standard_normal(count)]


def test_the_noise_is_known_after_ten_rows_and_better_with_every_further_one() -> None:
    learning, engine = learner()
    values = drawn(1000)
    known = [told(learning, row(engine, v)) for v in values[:FIRST]]
    assert known == [False] * (FIRST - 1) + [True]
    first = float(learning.limits[0, 0])
    own = float(np.std(values[:FIRST]))
    assert 1.5 * own < first < 6.0 * own, "few rows: Student's t for a level of five deviations"
    for v in values[FIRST:]:
        assert not told(learning, row(engine, v)), "news only once"
    # white rows of a filter: deviation 1 and hardly more for the mean and the deviation
    assert learning.limits[0, 0] == pytest.approx(1.0, rel=0.12)
    assert abs(float(learning.limits[0, 4])) < 0.2
    assert learning.over


def test_rows_that_do_not_count_teach_nothing() -> None:
    learning, engine = learner()
    values = drawn(FIRST)
    for value in values[:5]:
        assert not told(learning, row(engine, value))
    assert not told(learning, row(engine, 1e6), healthy=False)
    assert not told(learning, row(engine, 1e6, valid=False))
    assert [told(learning, row(engine, value)) for value in values[5:]] == [*[False] * 4, True]
    assert learning.limits[0, 0] < 10.0


def test_rows_before_an_alarm_are_forgotten() -> None:
    wise, engine = learner()
    hasty, _ = learner()
    for value in drawn(200):
        told(wise, row(engine, value))
        told(hasty, row(engine, value))
    for learning in (wise, hasty):
        for _ in range(LATE):
            told(learning, row(engine, 4.0))
    wise.alarm(np.zeros(1))
    for value in drawn(100):
        told(wise, row(engine, value))
        told(hasty, row(engine, value))
    assert wise.limits[0, 0] < hasty.limits[0, 0]
    assert wise.limits[0, 0] == pytest.approx(1.0, rel=0.2)


def test_rows_of_a_small_fault_are_held_back_until_it_is_told() -> None:
    """Three deviations off: a residual that is followed at once stands there before a sum tells."""
    for keeps in (True, False):
        learning, engine = learner()
        detection = Detection(engine.residuals, 3)
        for value in drawn(45):
            one = row(engine, value)
            assert not detection.row(beside(learning, one), learning.limits, _NEW).any()
            told(learning, one, held=detection.held)
        before = float(learning.limits[0, 0])
        rows = 0
        for value in drawn(30, 0.5):
            one = row(engine, 3.0 + value)
            if detection.row(beside(learning, one), learning.limits, _NEW).any():
                break
            if keeps:
                learning.row(beside(learning, one), True, detection.held)
            else:
                told(learning, one)
            rows += 1
        assert (rows < 10) == keeps
        if keeps:
            assert float(learning.limits[0, 0]) < 1.01 * before


def test_a_residual_that_does_not_stand_at_zero_is_told_and_watched_where_it_stands() -> None:
    learning, engine = learner()
    for value in drawn(100):
        told(learning, row(engine, 5.0 + value))
        assert learning.limits[0, 0] == math.inf or learning.off[0]
    assert learning.limits[0, 4] == pytest.approx(5.0, abs=0.4)
    assert learning.limits[0, 0] == pytest.approx(1.0, rel=0.3)


def test_a_residual_with_a_switch_that_does_not_stand_at_zero_is_told_too() -> None:
    text = _TEXT.replace("param R", "input on : bool; param R")
    text = text.replace("R:r = R", "R:r { e = if(on, R, 2*R)*f }")
    model = Compilation(Source("m.bg", text))
    engine = model.engine()
    for stands in (0.0, 5.0):
        learning = Learning(engine, (), np.ones(1, dtype=bool), model.diagnosis_model)
        for value in drawn(30):
            one = row(engine, stands + value)
            one = one._replace(samples=np.ones((100, len(engine.signals))))
            told(learning, one)
        assert learning.off[0] == (stands > 0.0)
        assert learning.limits[0, 4] == 0.0  # it may stand elsewhere with the switch turned


@pytest.mark.parametrize(("ohm", "off"), [(0.08, False), (0.5, True), (-0.5, True)])
def test_a_parameter_that_is_out_of_its_tolerance_from_the_start_is_told(
    ohm: float, off: bool
) -> None:
    # r = U - R i, i = 3 A, and R = 2 Ohm within 0.1: what is off by 0.5 Ohm is no noise of 0.02 V
    text = _TEXT.replace("2 Ohm", "2 Ohm +- 5%")
    model = Compilation(Source("m.bg", text)).diagnosis_model
    engine = Compilation(Source("m.bg", text)).engine()
    known = Hypothesis("R", "value", "Ohm", 0.6, True)
    learning = Learning(engine, (known,), np.ones(1, dtype=bool), model)
    for value in drawn(30, 0.02):
        slopes = np.full((1, 1), 3.0)
        one = row(engine, 3.0 * ohm + value)._replace(slopes=slopes, bound=np.full(1, 0.3))
        told(learning, one)
    assert learning.off[0] == off


def test_a_residual_that_does_not_move_at_all_has_no_noise_yet() -> None:
    learning, engine = learner()
    for _ in range(2 * FIRST):
        assert not told(learning, row(engine, 0.0))
    assert learning.limits[0, 0] == math.inf
    assert any(told(learning, row(engine, v)) for v in drawn(FIRST))  # and then it does
    assert 0.0 < learning.limits[0, 0] < 10.0


def test_no_sensor_is_better_than_a_ten_thousandth_of_what_it_does() -> None:
    learning, engine = learner(Hypothesis("i", "gain", "", 0.3, False))
    for _ in range(FIRST - 1):
        told(learning, row(engine, 0.5))
    assert told(learning, row(engine, 0.5))
    # R i is 6 V behind a filter that has long settled after ten rows of a tenth of a second
    assert learning.limits[0, 0] == pytest.approx(6e-4, rel=1e-3)


@pytest.mark.parametrize("zero", [0.0, 300.0])
def test_where_the_zero_of_a_signal_is_does_not_matter_to_the_least_noise(zero: float) -> None:
    """i swings by 0.5 A to either side, R i by 2 V in all; noise of 1 mV is more than that tells.

    As pressures and temperatures do, above a zero that is far away: 600 V would hide the noise.
    """
    learning, engine = learner(Hypothesis("i", "gain", "", 0.3, False))
    for k, value in enumerate(drawn(200, 1e-3)):
        i = zero + 0.5 * np.sin(0.3 * (k + np.arange(100) / 100.0))
        told(learning, row(engine, value)._replace(samples=np.column_stack([2.0 * i, i])))
    assert learning.limits[0, 0] == pytest.approx(1e-3, rel=0.25)


def seen_after(rate: float, start: int, seed: int) -> int:
    """Rows after which a drift of so many deviations a row is seen by level or sum."""
    learning, engine = learner()
    detection, waiting = Detection(engine.residuals, 3), deque[Row]()
    for k, value in enumerate(np.random.default_rng(seed).standard_normal(2500).tolist()):
        raw = row(engine, value + rate * max(k - start, 0))
        one = beside(learning, raw)
        high = abs(one.value[0]) > one.bound[0] + learning.levels.beyond(learning.limits)[0]
        if high or detection.row(one, learning.limits, _NEW).any():
            return k - start
        if not learning.over:
            learning.row(one, True, detection.held)
        learning.levels.ahead(alarmed=False)
        waiting.append(raw)
        while len(waiting) > max(HEALTHY, detection.held[0]):
            follow(learning, waiting.popleft())
    return 2500 - start


def test_a_drift_that_begins_after_a_hundred_healthy_rows_is_not_followed_for_ever() -> None:
    """In deviations a row: the sums see a fast one before it is followed, and a slow one has gone
    further than the level wanders after some hundred rows."""
    assert max(seen_after(0.2, 100, seed) for seed in range(20)) < 30
    some = sorted(seen_after(0.05, 100, seed) for seed in range(20))
    assert some[15] < 100 and some[-1] < 600
    assert max(seen_after(0.01, 100, seed) for seed in range(3)) < 2400


def test_a_drift_from_the_beginning_is_seen() -> None:
    """It is taken for a walk at first, which would go less far."""
    for rate in (0.05, 0.1):
        assert max(seen_after(rate, 0, seed) for seed in range(5)) < 1000


def test_white_noise_is_followed_nowhere() -> None:
    assert min(seen_after(0.0, 100, seed) for seed in range(4)) == 2400


@pytest.mark.parametrize(("begins", "told"), [(10.0, False), (9.0, True), (7.0, True)])
def test_what_is_added_up_from_a_start_that_is_not_there_does_not_stand_at_zero(
    begins: float, told: bool
) -> None:
    """A cell that holds less than is declared: e = 0.2 q + 0.01 q^2 is off by 0.4 V for each C."""
    cell = bondgraph.compile(text="""bg 1
model Cell {
    param R = 0.5 Ohm +- 5%
    0:t { <- Sf:I; -> De:V; -> 1:c }
    c { -> C:s(q0 = 10 C) { e = 0.2*q + 0.01*q^2 }; -> R:R }
}""", rate=100.0)
    time = np.arange(4000) / 100.0
    current, q = np.sin(0.9 * time), begins + (1.0 - np.cos(0.9 * time)) / 0.9
    volt = 0.5 * current + 0.2 * q + 0.01 * q**2
    volt += 0.01 * np.random.default_rng(1).normal(size=len(time))
    found = bondgraph.monitor(cell, {"t": time, "I": current, "V": volt})
    said = " ".join(v.message for v in found.verdicts[0])
    assert "r1 is watched from now on" in said
    assert ("began elsewhere than the model declares" in said) == told
