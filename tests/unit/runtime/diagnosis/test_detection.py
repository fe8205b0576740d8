"""When residuals fire, what is latched, and when a fault is over."""

from __future__ import annotations

import json
import math

import numpy as np
import pytest
from scipy import stats

from bondgraph.runtime.diagnosis.detection import (
    _LEAST,
    Detection,
    _excess,
    _explained,
    _gone,
    _without,
)
from bondgraph.runtime.diagnosis.history import History
from bondgraph.runtime.diagnosis.model_error import SHARE
from bondgraph.runtime.diagnosis.row_averages import LAGS
from bondgraph.runtime.diagnosis.row_sums import Moves
from bondgraph.runtime.diagnosis.rows import Average, Part, Row, pause
from bondgraph.runtime.diagnosis.tuning import Limit
from bondgraph.runtime.log import Array

#: Noise 1, a level of 4 sigma for samples, a sum of 3 for rows; of two residuals.
_LIMITS = np.array([Limit(1.0, 10.0, 4.0, 3.0, 0.0, 1.0)] * 2)
_NEW = History(np.zeros(0))  # nothing is tolerated


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
    fired = [detection.row(_row(1.5, -1.5), _LIMITS, _NEW).tolist() for _ in range(4)]
    assert fired == [[False, False]] * 3 + [[True, True]]  # 1.5 - 0.5 a row, above 3 in the fourth
    noise = Detection(["r1", "r2"], 3)
    assert not any(noise.row(_row(0.5, -0.5), _LIMITS, _NEW).any() for _ in range(1000))


def _alarm(detection: Detection, size: float, rows: int = 6) -> None:
    assert detection.latch(np.array([True, False]))
    assert not detection.latch(np.array([False, True])), "the same alarm"
    assert not any(detection.over(_row(size, size), _LIMITS) for _ in range(rows))


def _moves(last: Array | None) -> Moves | None:
    """What a fault does to last samples; nothing is known of averages."""
    return None if last is None else Moves(last, np.full((LAGS + 1, 2), math.nan))


def _quiet(detection: Detection, value: float = 0.0, moves: Array | None = None) -> int:
    """Rows after which it is over."""
    for rows in range(1, 200):
        if detection.over(_row(value, value), _LIMITS, lambda: _moves(moves)):
            detection.clear()
            assert not detection.alarmed and detection.levels() == {}
            return rows
    return 200


def test_a_large_fault_is_over_with_two_quiet_rows_and_a_small_one_later() -> None:
    rows = {}
    for size in (20.0, 4.0, 1.5):
        detection = Detection(["r1", "r2"], 3)
        _alarm(detection, size)
        assert not any(detection.over(_row(0.0, 0.0, valid=(False, False)), _LIMITS)
                       for _ in range(30)), "what cannot be seen tells nothing"  # fmt: skip
        rows[size] = _quiet(detection, 0.3)
        other = Detection(["r1", "r2"], 3)
        _alarm(other, size)
        assert not any(other.over(_row(0.0, 0.0, valid=(False, True)), _LIMITS)
                       for _ in range(30)), "not while one is not seen"  # fmt: skip
    assert rows[20.0] == 2
    assert rows[20.0] <= rows[4.0] < rows[1.5] <= 25


def test_a_residual_that_swings_is_not_over_while_it_is_out() -> None:
    """Below and above zero in turn, unlike before each time, and always far out."""
    detection = Detection(["r1", "r2"], 3)
    assert detection.latch(np.array([True, True]))
    swings = [15.0, -80.0, 210.0, -300.0, 380.0, -420.0, 415.0, -360.0, 280.0, -180.0, 60.0]
    for value in 3 * swings:
        detection.row(_row(value, -value / 10), _LIMITS, _NEW)
        assert not detection.over(_row(value, -value / 3), _LIMITS)
    assert _quiet(detection) <= 3


@pytest.mark.parametrize("known", [True, False])
def test_where_a_sample_tells_nothing_of_an_end_averages_do(known: bool) -> None:
    """A fault moves a residual by five, where a sample of a healthy machine may be off by twenty,
    and an average by a fifth; it is gone."""
    limits = np.array([Limit(1.0, 10.0, 4.0, 3.0, 0.0, 1.0, unit=0.1)] * 2)
    detection, five = Detection(["r1", "r2"], 3, pause=500), np.full(2, 5.0)
    detection.latch(np.array([True, True]))
    nothing, valid = np.zeros(2), np.ones(2, dtype=bool)
    mean = Average(nothing, valid, nothing + 0.2, nothing, np.zeros((0, 2)))
    row = _row(0.0, 0.0)._replace(bound=nothing + 20.0, average=mean)
    moved = Moves(five, np.tile(five if known else five + math.nan, (LAGS + 1, 1)))
    over = []
    for _ in range(20):
        detection.row(row, limits, _NEW)
        over.append(detection.over(row, limits, lambda: moved))
    assert any(over) == known
    if known:
        assert over.index(True) == 1


def test_what_comes_back_soon_has_to_be_away_for_longer_the_next_time() -> None:
    detection = Detection(["r1", "r2"], 3)
    needed = []
    for _ in range(4):
        _alarm(detection, 20.0)
        needed.append(_quiet(detection))
        for _ in range(3):  # away for three rows more
            detection.row(_row(0.0, 0.0), _LIMITS, _NEW)
    assert needed[0] == 2 and needed == sorted(needed) and needed[1] >= 8, needed
    for _ in range(40):
        detection.row(_row(0.0, 0.0), _LIMITS, _NEW)
    _alarm(detection, 20.0)
    assert _quiet(detection) == 2, "away for long: another fault"


def test_what_comes_back_soon_is_held_for_no_more_rows_than_a_pause_has() -> None:
    detection = Detection(["r1", "r2"], 3, pause=5)
    needed = []
    for _ in range(6):
        _alarm(detection, 20.0)
        needed.append(_quiet(detection))
        for _ in range(2):
            detection.row(_row(0.0, 0.0), _LIMITS, _NEW)
        detection = detection.resumed(json.loads(json.dumps(detection.state())))
    assert max(needed) == 5 and needed[0] == 2, needed


def test_what_is_quiet_for_a_stroke_is_not_over_behind_a_fast_filter() -> None:
    """Rows of 0.02 s: after 32 of them an alarm of a friction was over in each dwell of an axis."""
    detection = Detection(["r1", "r2"], 3, pause=pause(0.02))
    _alarm(detection, 20.0)
    over = [detection.over(_row(0.0, 0.0), _LIMITS, lambda: _moves(np.zeros(2)))
            for _ in range(500)]  # fmt: skip
    assert over.index(True) == 499


def test_rows_in_which_the_fault_would_not_show_do_not_tell_that_it_is_over() -> None:
    detection = Detection(["r1", "r2"], 3)
    _alarm(detection, 20.0)
    for least in (0.0, 0.4):  # nothing, and hardly more than what gives no alarm
        unmoved = np.array([least, -least])
        assert not any(detection.over(_row(0.0, 0.0), _LIMITS, lambda u=unmoved: _moves(u))
                       for _ in range(10))  # fmt: skip
    moved = np.array([20.0, 20.0])
    rows = [detection.over(_row(0.0, 0.0), _LIMITS, lambda: _moves(moved)) for _ in range(2)]
    assert rows[-1]
    other = Detection(["r1", "r2"], 3)
    _alarm(other, 20.0)
    assert 20 < _quiet(other, moves=np.zeros(2)) < 60, "but it does not last for ever"


@pytest.mark.parametrize("right", [True, False])
def test_a_fault_is_asked_only_if_it_tells_the_rows_of_the_alarm(right: bool) -> None:
    """Out by 20 to either side in each second row: what is named makes that, or nothing at all.

    Then all is quiet, and what is named would show nothing of itself: it is at rest, or wrong.
    """
    detection = Detection(["r1", "r2"], 3)
    _alarm(detection, 20.0)
    for k in range(60):
        size = (20.0, 0.0, -20.0, 0.0)[k % 4]
        fault = np.full(2, size if right else 0.1)
        assert not detection.over(_row(size, size), _LIMITS, lambda f=fault: _moves(f))
    quiet = _quiet(detection, moves=np.full(2, 0.1))
    assert quiet > 20 if right else quiet < 20, quiet


def test_what_the_fault_makes_of_a_row_is_no_end_of_it() -> None:
    """It moves a residual by 20, then by less and to the other side, as a motion goes."""
    for now in (2.0, -2.0, -20.0):
        asked = Detection(["r1", "r2"], 3)
        _alarm(asked, 20.0)
        fault = np.array([now, now])
        for _ in range(100):
            asked.row(_row(now, now), _LIMITS, _NEW)
            assert not asked.over(_row(now, now), _LIMITS, lambda f=fault: _moves(f))
        assert _quiet(asked, moves=fault) <= 4, "and without it, it is over"
    blind = Detection(["r1", "r2"], 3)
    _alarm(blind, 20.0)
    assert _quiet(blind, 2.0) == 2, "as far as nobody knows what the fault does"
    unknown = Detection(["r1", "r2"], 3)
    _alarm(unknown, 20.0)
    assert _quiet(unknown, 2.0, np.full(2, math.nan)) == 2


@pytest.mark.parametrize(("pause", "least"), [(32, 32), (4, 8)])
def test_what_no_alarm_would_be_given_for_does_not_keep_one_for_ever(
    pause: int, least: int
) -> None:
    """Noise that goes as the fault says, as where a signal's noise is in what the fault does."""
    detection = Detection(["r1", "r2"], 3, pause=pause)
    _alarm(detection, 20.0)
    draw = np.random.default_rng(1)
    rows, over = 0, False
    while not over and rows < 200:
        rows, noise = rows + 1, float(draw.standard_normal())
        detection.row(_row(noise, noise), _LIMITS, _NEW)
        fault = np.array([noise, noise])
        over = detection.over(_row(noise, noise), _LIMITS, lambda f=fault: _moves(f))
    assert least <= rows <= least + 40


def test_a_state_goes_through_json_and_another_kind_is_refused() -> None:
    detection = Detection(["r1", "r2"], 3)
    detection.row(_row(2.0, 0.0), _LIMITS, _NEW)
    detection.latch(np.array([True, False]))
    state = json.loads(json.dumps(detection.state()))
    other = detection.resumed(state)
    assert other.state() == state
    assert detection.row(_row(2.0, 0.0), _LIMITS, _NEW).tolist() == [False, False]
    for key, value in (("fired", [True]), ("sums", 3), ("alarms", "many"), ("most", None)):
        with pytest.raises((TypeError, ValueError)):
            detection.resumed({**state, key: value})
    del state["sums"]
    with pytest.raises(KeyError):
        detection.resumed(state)


@pytest.mark.parametrize(("rows", "known"), [(4, False), (40, True)])
def test_what_a_residual_is_beside_the_fault_does_not_go_away_with_it(
    rows: int, known: bool
) -> None:
    """A threshold of 20 for what parameters may do, a fault of 12, and 9 beside it.

    A healthy machine may be at 9, and the machine with the fault at -12: from 21 to 9 is 12 less,
    at once, which is the fault. It is over once there are rows enough to know the 9 by.
    """
    draw, fault = np.random.default_rng(3), np.full(2, 12.0)
    none, wide = np.zeros(2), np.full(2, 20.0)

    def over(detection: Detection, level: float) -> bool:
        value = level + draw.normal(size=2)
        row = Row(0.0, none, None, value, np.ones(2, dtype=bool), wide, none, none)
        return detection.over(row, _LIMITS, lambda: _moves(fault))

    detection = Detection(["r1", "r2"], 3, pause=1000)
    _alarm(detection, 30.0)
    assert not any(over(detection, 21.0) for _ in range(rows))
    assert any(over(detection, 9.0) for _ in range(6)) == known
    other = Detection(["r1", "r2"], 3, pause=1000)
    _alarm(other, 30.0)
    assert not any(over(other, 21.0) for _ in range(rows))
    assert not any(over(other, level) for level in 12.0 + 9.0 * np.cos(np.arange(0.0, 0.6, 0.05)))


# ----------------------------------------------------------- how probable it is without a fault


def _array(*numbers: float) -> Array:
    return np.array(numbers)


def test_what_is_to_be_expected_is_no_excess() -> None:
    found = _excess(_array(5.0, -5.0, 2.0, -1.5, 0.0), _array(2.0), _array(0.5))
    assert found.tolist() == [6.0, -6.0, 0.0, 0.0, 0.0]


def test_a_move_explains_most_of_what_is_out_or_it_does_not() -> None:
    """Out are more than some deviations; explained is what leaves no more than half of it."""
    value = _array(10.0, 10.0, 10.0, -10.0, 0.1, 10.0)
    moved = _array(9.0, 5.0, 4.9, -5.5, 0.1, math.nan)
    row = _row(0.0, 0.0)._replace(value=value, bound=np.zeros(6))
    out, said = _explained(moved, row, _excess(value, row.bound, np.ones(6)), np.ones(6))
    assert out.tolist() == [1.0, 1.0, 1.0, 1.0, 0.0, 0.0]
    assert said.tolist() == [1.0, 1.0, -1.0, 1.0, 0.0, 0.0]


@pytest.mark.parametrize("seed", range(4))
def test_how_much_more_probable_values_are_without_a_fault_is_a_ratio_of_densities(
    seed: int,
) -> None:
    """Of one deviation about zero, and wider about the move by a share of it."""
    draw = np.random.default_rng(seed)
    value, moved = 5.0 * draw.standard_normal(8), 5.0 * draw.standard_normal(8)
    bound, sigma = draw.uniform(0.0, 1.0, 8), draw.uniform(0.5, 2.0, 8)
    more, _ = _without(moved, value, bound, sigma)
    for k in range(8):
        healthy, faulty = (
            math.copysign(max(abs(x) - bound[k], 0.0), x) / sigma[k]
            for x in (value[k], value[k] - moved[k])
        )
        wide = math.hypot(1.0, SHARE * moved[k] / sigma[k])
        # the factor 1/wide of a density would favour faults that move more: it is left in
        expected = stats.norm.logpdf(healthy) - stats.norm.logpdf(faulty, scale=wide)
        assert more[k] == pytest.approx(expected, rel=1e-9, abs=1e-12)


def test_a_row_tells_where_the_move_is_clear_and_something_is_out_with_it_or_without() -> None:
    bound, sigma = np.full(6, 1.0), np.full(6, 0.5)
    least = 1.0 + 0.5 * _LEAST
    moved = _array(least, 1.001 * least, -1.001 * least, 9.0, 9.0, math.nan)
    value = _array(5.0, 5.0, 5.0, 0.0, 9.0, 5.0)
    more, tells = _without(moved, value, bound, sigma)
    assert tells.tolist() == [False, True, True, True, True, False]
    assert np.isnan(more).tolist() == [False] * 5 + [True]
    # out neither with the fault nor without it: nothing is told
    wide = np.full(1, 4.0)
    assert not _without(_array(4.0 + 0.6 * _LEAST), _array(2.5), wide, sigma[:1])[1].any()


def test_that_a_fault_is_gone_is_a_ratio_of_densities_with_its_mean() -> None:
    """Twice the logarithm; the mean is that of rows without it, by quadrature."""
    counts = _array(10.0, 4.0, 20.0)
    means, squares = _array(6.0, -5.0, 0.5), _array(40.0, 25.5, 9.0)
    excess = _array(1.0, -4.0, 0.0)
    more, mean = _gone(np.array([counts, counts * means, counts * squares]), excess, 2.0)
    nodes, weights = np.polynomial.hermite_e.hermegauss(40)
    weights = weights / weights.sum()
    for k, center in enumerate((6.0, -5.0, 2.0)):  # the last by what is least
        spread = math.sqrt(max(squares[k] - means[k] ** 2, 1.0))
        told = [
            2.0 * (stats.norm.logpdf(x) - stats.norm.logpdf(x, center, spread))
            for x in (excess[k], nodes)
        ]
        assert more[k] == pytest.approx(told[0], rel=1e-9)
        assert mean[k] == pytest.approx(float(weights @ told[1]), rel=1e-9)


def test_a_fault_of_which_no_row_has_told_has_the_least_mean() -> None:
    more, mean = _gone(np.zeros((3, 1)), _array(0.0), 2.0)
    assert more.tolist() == [4.0]  # (0 - 2)^2, of the variance 1
    assert mean.tolist() == [4.0]  # 1 + 4 - 1
