"""Readings that a switch holds are not stuck, and those that stand by themselves are."""

from __future__ import annotations

import numpy as np
import pytest

from bondgraph.runtime.diagnosis.held_readings import HeldReadings
from bondgraph.runtime.diagnosis.signal_checks import SignalChecks, Unusual
from bondgraph.runtime.log import Array

_STEP, _ROW = 0.01, 25


def _elevator(late: int = 0) -> Array:
    """A load that is weighed while the brake is shut, a speed, and whether the brake is open.

    Trips are of 90 to 300 samples. What is weighed is held from the sample on at which the brake
    opens, and weighed again some samples late.
    """
    draw, rows = np.random.default_rng(4), 6000
    lengths = draw.integers(90, 300, 60)
    on = np.repeat(np.arange(len(lengths)) % 2, lengths)[:rows].astype(float)
    load = np.repeat(draw.uniform(0.0, 500.0, len(lengths)), lengths)[:rows]
    load += draw.normal(size=rows)
    for k in range(1, rows):
        if on[max(k - late, 0) : k + 1].any():
            load[k] = load[k - 1]
    speed = on + 0.01 * draw.normal(size=rows)
    return np.column_stack([load, speed, on])


def _told(samples: Array, modes: tuple[int, ...] = (2,)) -> list[Unusual]:
    checks = SignalChecks(["load", "speed"], [0, 1], _STEP, inputs=["load"], modes=modes)
    found = []
    for k in range(0, len(samples) - _ROW + 1, _ROW):
        row = checks.row((k + _ROW - 1) * _STEP, samples[k : k + _ROW], not checks.active)
        found += [one for one in row if one.kind == "stuck"]
    return found


@pytest.mark.parametrize("late", [0, 2])
def test_a_reading_that_a_switch_holds_is_not_stuck(late: int) -> None:
    samples = _elevator(late)
    assert _told(samples) == []
    # nobody knows of the switch: then it is
    assert _told(samples, ())


@pytest.mark.parametrize("open_", [False, True])
def test_what_stands_by_itself_is_told_however_long_a_switch_holds(open_: bool) -> None:
    """A speed that stands, and a load that is not weighed any more, from the middle of a stretch
    on: it is told within some rows, though the load was held for 300 samples before."""
    samples = _elevator()
    on = samples[:, 2]
    turns = np.flatnonzero(np.diff(on)) + 1
    begin = next(int(t) for t in turns if t > 3000 and on[t] == open_) + 40
    column = 1 if open_ else 0
    samples[begin:, column] = samples[begin, column]
    first = _told(samples)[0]
    assert first.signal == ("speed" if open_ else "load")
    assert first.since == pytest.approx(begin * _STEP, abs=2.0 * _STEP)


def test_a_turn_some_samples_before_or_behind_is_one() -> None:
    """Runs that are counted by hand: a turn four samples before the end, and none since."""
    for run, late, held in ((4, 0, True), (5, 0, False), (6, 2, True), (2, 2, True), (7, 2, False)):
        own = HeldReadings(1, 2, late)
        modes = np.array([[0.0, 1.0]] * 3 + [[1.0, 1.0]] * 4)
        assert own.row(modes, np.array([float(run)])).tolist() == [held]
        # ten samples later it stands still, and the switch has not turned
        assert own.row(modes[-1:].repeat(10, axis=0), np.array([run + 10.0])).tolist() == [held]


def test_a_start_is_no_turn_nor_is_a_position_that_is_not_known() -> None:
    own = HeldReadings(1, 1, 2)
    assert own.row(np.ones((5, 1)), np.array([5.0])).tolist() == [False]
    assert own.row(np.array([[1.0], [np.nan], [np.nan]]), np.array([2.0])).tolist() == [False]
    own.restart()
    assert own.row(np.zeros((5, 1)), np.array([5.0])).tolist() == [False]
