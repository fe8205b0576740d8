"""When residuals fire, what is latched, and when a fault is over."""

from __future__ import annotations

import json
import math

import numpy as np
import pytest

from bondgraph.runtime.diagnosis.detection import Detection
from bondgraph.runtime.diagnosis.rows import Part, Row
from bondgraph.runtime.log import Array

#: Noise 1, a level of 4 sigma for samples, a sum of 3 for rows; of two residuals.
_LIMITS = np.array([[1.0, 10.0, 4.0, 3.0]] * 2)


def _part(value: Array) -> Part:
    none, valid = np.zeros_like(value), np.ones_like(value, dtype=bool)
    return Part(np.arange(len(value)) / 10, none, value, valid, none, none, none)


def _row(*value: float, valid: tuple[bool, bool] = (True, True)) -> Row:
    own = np.array(value)
    none = np.zeros(2)
    return Row(0.0, none, None, own, np.array(valid), none, none, none)


def _fired(detection: Detection, value: Array) -> list[tuple[int, list[bool]]]:
    found = []
    for k, fresh in detection.samples(_part(value), np.full_like(value, 4.0)):
        found.append((k, fresh.tolist()))
        detection.latch(fresh)
    return found


def test_a_residual_fires_after_enough_samples_in_a_row() -> None:
    detection = Detection(["r1", "r2"], 3)
    value = np.zeros((10, 2))
    value[2:4, 0] = 5.0  # two samples are not enough
    value[5:, 1] = -6.0
    assert _fired(detection, value) == [(7, [False, True])]
    assert detection.levels() == {"r2": 1.5}
    assert detection.alarms == 1


def test_samples_in_a_row_may_be_of_two_parts_but_not_of_two_starts() -> None:
    long = np.array([[5.0, 0.0]] * 2)
    detection = Detection(["r1", "r2"], 3)
    assert _fired(detection, long) == []
    assert _fired(detection, long) == [(0, [True, False])]
    other = Detection(["r1", "r2"], 3)
    assert _fired(other, long) == []
    other.restart()
    assert _fired(other, long) == []


def test_a_threshold_that_nobody_knows_is_exceeded_by_nothing() -> None:
    detection = Detection(["r1", "r2"], 1)
    value = np.full((5, 2), 1e9)
    assert not list(detection.samples(_part(value), np.full_like(value, math.nan)))


def test_a_little_for_many_rows_fires_to_either_side() -> None:
    detection = Detection(["r1", "r2"], 3)
    fired = [detection.row(_row(1.5, -1.5), _LIMITS).tolist() for _ in range(4)]
    assert fired == [[False, False]] * 3 + [[True, True]]  # 1.5 - 0.5 a row, above 3 in the fourth
    noise = Detection(["r1", "r2"], 3)
    assert not any(noise.row(_row(0.5, -0.5), _LIMITS).any() for _ in range(1000))


def test_a_fault_is_over_after_twice_as_many_quiet_rows_each_time() -> None:
    detection = Detection(["r1", "r2"], 3)
    for alarm in range(3):
        assert detection.latch(np.array([True, False]))
        assert not detection.latch(np.array([False, True])), "the same alarm"
        assert not detection.over(_row(9.0, 0.0), _LIMITS)
        unseen = _row(0.0, 0.0, valid=(False, True))
        assert not any(detection.over(unseen, _LIMITS) for _ in range(99)), "cannot be seen"
        quiet = 1
        while not detection.over(_row(0.0, 0.0), _LIMITS):
            quiet += 1
        assert quiet == 10 * 2**alarm
        detection.clear()
        assert not detection.alarmed and detection.levels() == {}


def test_a_state_goes_through_json_and_another_kind_is_refused() -> None:
    detection = Detection(["r1", "r2"], 3)
    detection.row(_row(2.0, 0.0), _LIMITS)
    detection.latch(np.array([True, False]))
    state = json.loads(json.dumps(detection.state()))
    other = detection.resumed(state)
    assert other.state() == state
    assert detection.row(_row(2.0, 0.0), _LIMITS).tolist() == [False, False]
    for key, value in (("fired", [True]), ("sums", 3), ("alarms", "many"), ("most", None)):
        with pytest.raises((TypeError, ValueError)):
            detection.resumed({**state, key: value})
    del state["sums"]
    with pytest.raises(KeyError):
        detection.resumed(state)
