"""Limits of residuals that wander: noise beside a level, against formulas written out here."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from scipy import stats

from bondgraph.runtime.diagnosis.calibration import (
    _beside_its_level,
    _farthest,
    _mean,
    _Noise,
    _path,
    _where_it_stands,
)
from bondgraph.runtime.diagnosis.learning import Learning
from bondgraph.runtime.diagnosis.noise import FILTERED, Noise
from bondgraph.runtime.diagnosis.row_averages import WHITE, lasting
from bondgraph.runtime.diagnosis.rows import Average, Row
from bondgraph.runtime.diagnosis.tuning import Limit
from bondgraph.runtime.diagnosis.wander import NONE, Wander, wander
from bondgraph.runtime.log import Array

_NONE = np.zeros(2)


def _log(rest: Array, averages: Array) -> _Noise:
    """Of a log in which residual 1 has these rows; residual 0 has none."""

    def both(own: Array) -> Array:
        return np.column_stack([np.full(len(own), np.nan), own])

    return _Noise(len(rest), _NONE, _NONE, _NONE, (), (), both(rest), both(averages), _NONE)


def _wandering(seed: int, count: int, step: float) -> Array:
    draw = np.random.default_rng(seed)
    steps, noise = draw.standard_normal((2, count))
    return np.asarray(np.cumsum(step * steps) + noise)


_REST, _AVERAGES = _wandering(1, 300, 0.2), _wandering(2, 300, 0.6)
_OWN = Noise(0.5, 3.0, 8.0, 40.0, 300)
_LIMIT = Limit(3.2, 0.1, 4.5, 9.0, 0.5, 8.0, 5.0, 0.0, 0.5, 0.25, 0.125, 0.0625)


def _normal(kappa: float, freedom: float) -> float:
    """How much farther than the normal distribution that of Student goes, as often."""
    return float(stats.t.isf(stats.norm.sf(kappa), freedom)) / kappa


def _lasts(path: Wander, deviation: float, white: float) -> float:
    return min(path.less * deviation, max(path.noise, math.sqrt(white) * path.alone))


def test_noise_beside_a_level_is_that_of_a_row_alone() -> None:
    rows, path = wander(_REST), wander(_AVERAGES)
    assert 0.0 < rows.step < path.step
    found = _beside_its_level(_LIMIT, _OWN, [_log(_REST, _AVERAGES)], 1, 1e-6)
    told = _OWN.sigma * _normal(4.5, _OWN.freedom) * math.sqrt(1.0 + _OWN.memory / _OWN.rows)
    wider = _LIMIT.sigma / told
    assert found.sigma == pytest.approx(wider * rows.alone * _normal(4.5, 298.0), rel=1e-6)
    lasting = _lasts(rows, _OWN.sigma * math.sqrt(_OWN.memory), FILTERED)
    assert found.memory == pytest.approx(max((lasting / rows.alone) ** 2, 1.0))
    added = 1.0 + 0.5 + 0.25 + 0.125 + 0.0625
    assert found.unit == pytest.approx(
        added * wider * _lasts(path, _LIMIT.unit / (added * wider), WHITE)
    )
    assert (found.step, found.most) == pytest.approx((path.step, path.most))
    assert found._replace(sigma=0, memory=0, unit=0, step=0, most=0) == _LIMIT._replace(
        sigma=0, memory=0, unit=0, step=0, most=0
    )


def test_where_averages_tell_nothing_the_rows_say_how_the_level_moves() -> None:
    plain = _LIMIT._replace(unit=0.0)
    one, other = (
        _beside_its_level(plain, _OWN, [_log(_REST, averages)], 1, 1e-6)
        for averages in (_AVERAGES, -5.0 * _AVERAGES)
    )
    assert one == other and one.unit == 0.0
    assert (one.step, one.most) == pytest.approx(wander(_REST)[:2])


def test_limits_of_noise_beside_a_level_have_bounds() -> None:
    """No less than what is least, and no more than that about a mean."""
    logs = [_log(_REST, _AVERAGES)]
    assert _beside_its_level(_LIMIT, _OWN, logs, 1, 2.0).sigma == 2.0
    assert _beside_its_level(_LIMIT, _OWN, logs, 1, 2.0).unit == pytest.approx(
        max(2.0 * 1.9375, _beside_its_level(_LIMIT, _OWN, logs, 1, 0.0).unit)
    )
    assert _beside_its_level(_LIMIT, _OWN, logs, 1, 99.0).sigma == _LIMIT.sigma
    assert _beside_its_level(_LIMIT, _OWN, logs, 1, 99.0).unit == _LIMIT.unit
    quiet = _OWN._replace(memory=0.25)
    assert _beside_its_level(_LIMIT, quiet, logs, 1, 0.0).memory >= 0.25


def test_where_rows_tell_no_level_the_limit_stays() -> None:
    still = np.ones(300)
    assert _beside_its_level(_LIMIT, _OWN, [_log(still, still)], 1, 0.0) is _LIMIT
    assert _beside_its_level(_LIMIT, _OWN, [_log(_REST[:3], _AVERAGES)], 1, 0.0) is _LIMIT


@pytest.mark.parametrize("lasts", [False, True])
def test_several_logs_count_by_their_rows_and_those_that_tell_nothing_do_not(lasts: bool) -> None:
    own = [_wandering(seed, count, 0.3) for seed, count in ((3, 80), (4, 240))]
    rest, averages = (own, [2.0 * x for x in own]) if not lasts else ([2.0 * x for x in own], own)
    logs = [_log(r, a) for r, a in zip(rest, averages, strict=True)]
    logs.append(_log(np.ones(500), np.ones(500)))
    found = _path(logs, 1, lasts)
    told = [wander(x) for x in own]
    for at, value in enumerate(found):
        squares = (80 * told[0][at] ** 2 + 240 * told[1][at] ** 2) / 320
        assert value == pytest.approx(math.sqrt(squares))
    assert _path(logs[2:], 1, lasts) == NONE and _path(logs, 0, lasts) == NONE


def test_the_farthest_is_what_a_level_surely_went_from_its_mean() -> None:
    """Means 2 and 0: off by 2, 1 and 3, the last of which is not sure."""
    path = [(np.array(level), np.array(unsure)) for level, unsure in (
        ([0.0, 0.0], [1.0, 0.0]), ([1.0, 0.0], [0.5, 0.0]), ([5.0, 0.0], [3.0, 0.0]),
    )]  # fmt: skip
    assert _farthest(path).tolist() == [2.0, 0.0]
    assert _farthest(path[:1]).tolist() == [0.0, 0.0]


def test_the_mean_is_that_of_rows_that_have_a_value() -> None:
    assert _mean(np.array([1.0, np.nan, 4.0, np.inf])) == 2.5
    assert _mean(np.array([np.nan])) == 0.0


def test_a_row_beside_a_mean_has_room_for_what_is_not_known_of_it() -> None:
    nothing: Any = None
    own = Average(*[np.array([float(k), 10.0 * k]) for k in range(1, len(Average._fields) + 1)])
    valid = np.array([True, False])
    own = own._replace(valid=valid.copy())
    value, bound, doubt = np.array([7.0, np.nan]), np.array([1.0, 2.0]), np.array([0.5, 0.25])
    row = Row(9.0, _NONE, nothing, value, valid, bound, doubt, _NONE, 0.0, own)
    before = own.value.copy()
    mean, unsure = np.array([3.0, 4.0]), np.array([0.125, 0.0625])
    found = _where_it_stands(row, 5, mean, unsure)
    assert found.time == 5 and found.value.tolist() == [4.0, 0.0]
    assert found.bound.tolist() == [1.125, 2.0625] and found.doubt.tolist() == [0.625, 0.3125]
    assert found.average is not None
    assert found.average.value.tolist() == [before[0] - 3.0, before[1]]
    assert found.average.bound.tolist() == (own.bound + unsure).tolist()
    assert found.average.doubt.tolist() == (own.doubt + unsure).tolist()
    # the row itself is as it was
    assert row.value[0] == 7.0 and own.value.tolist() == before.tolist() and row.time == 9.0


def _learning(centred: bool, least: float) -> Any:
    own: Any = object.__new__(Learning)
    own.limits, own._centred = np.zeros((2, 12)), [True, centred]
    own.limits[:, 2] = 4.0
    own._least = lambda unit: np.full(2, least)
    return own


@pytest.mark.parametrize(("centred", "stands"), [(True, 2.0), (False, 0.0)])
def test_averages_stand_above_the_mean_of_rows_where_there_is_one(
    centred: bool, stands: float
) -> None:
    """Their own mean is 5, that of rows 3; noise is taken for twice what it shows."""
    values = np.random.default_rng(3).standard_normal(400)
    values += 5.0 - values.mean()
    told = lasting(values, 0.0, centred, 4.0)
    found = _learning(centred, 0.0)._averages(1, values, 0.0, 3.0, 2.0)
    assert found[0] == pytest.approx(2.0 * told.unit)
    assert found[1] == pytest.approx(stands)
    assert found[2:].tolist() == pytest.approx(told.weights.tolist())
    most = _learning(centred, 9e3)._averages(1, values, 0.0, 3.0, 2.0)
    assert most[0] == pytest.approx(9e3 * (1.0 + told.weights.sum()))


def test_of_averages_that_tell_nothing_no_unit_is_known() -> None:
    found = _learning(True, 0.0)._averages(1, np.full(3, np.nan), 0.0, 3.0, 2.0)
    assert found[0] == 0.0
    own = _learning(True, 0.0)
    own.limits[1, 6:8] = 0.0, 7.0
    assert own._further(1) == 0.0
    own.limits[1, 6] = 0.5
    assert own._further(1) == 7.0
