"""How averages of rows add up: what differentiated noise leaves, and what is seen beside it."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.optimize import nnls
from scipy.signal import lfilter

from bondgraph.runtime.diagnosis.cusum import Cusum
from bondgraph.runtime.diagnosis.noise import noise
from bondgraph.runtime.diagnosis.row_averages import (
    LAGS,
    _positive,
    _weights,
    lasting,
    with_before,
)
from bondgraph.runtime.diagnosis.rows import Average, Row, all_of, averaged
from bondgraph.runtime.diagnosis.tuning import Limit, height
from bondgraph.runtime.log import Array

_EVERY = 15  # samples a row
_FILTER = 5.0  # samples: its time constant, a third of a row
_BETWEEN = 500.0  # rows between false alarms of one residual


def _residual(seed: int, rows: int, derivative: float) -> tuple[Array, Array]:
    """The last sample of each row and its average, of e + `derivative` de/dt behind the filter.

    e is white, so that its sum over many rows grows as that of white noise, whatever the second.
    """
    draw = np.random.default_rng(seed).standard_normal((rows + 20) * _EVERY)
    pole = math.exp(-1.0 / _FILTER)
    slow = draw
    for _ in range(3):
        slow = lfilter([1.0 - pole], [1.0, -pole], slow)
    whole = slow + derivative * np.gradient(slow)
    pieces = whole[20 * _EVERY :].reshape(rows, _EVERY)
    return pieces[:, -1], pieces.mean(axis=1)


@pytest.mark.parametrize(("derivative", "most"), [(0.0, 1.3), (20.0, 1.6)])
def test_the_unit_is_near_what_sums_of_averages_grow_by(derivative: float, most: float) -> None:
    true = 1.0 / math.sqrt(_EVERY)  # of a row of white samples, through a filter that keeps a mean
    for seed in range(5):
        rows, averages = _residual(seed, 400, derivative)
        found = lasting(averages, 0.0, True, 4.0)
        unit = found.unit / (1.0 + found.weights.sum())  # as a shift of the residual counts
        assert 0.8 * true < unit < most * true
        plain = noise(rows)
        if derivative:  # by rows the derivative of the noise counts as noise that stays
            assert unit < 0.6 * plain.sigma * math.sqrt(plain.memory)


def test_few_rows_tell_no_unit_and_missing_ones_do_no_harm() -> None:
    _, averages = _residual(1, 400, 20.0)
    assert math.isinf(lasting(averages[:20], 0.0, True, 4.0).unit)
    assert math.isinf(lasting(np.full(100, math.nan), 0.0, True, 4.0).unit)
    assert math.isinf(lasting(np.zeros(100), 0.0, True, 4.0).unit)
    holes = averages.copy()
    holes[::7] = math.nan
    whole, some = (lasting(x, 0.0, True, 4.0) for x in (averages, holes))
    assert some.unit == pytest.approx(whole.unit, rel=0.5)


def test_what_stands_before_is_added_by_weight() -> None:
    found = with_before(np.array([1.0, 2.0, 3.0, 5.0]), np.array([0.5, 0.0, 1.0, 0.0]))
    assert np.isnan(found[:3]).all() and found[3] == 5.0 + 0.5 * 3.0 + 1.0


def _limits(rows: Array, averages: Array) -> Array:
    """What healthy rows teach, as a watch without a tuning has it."""
    plain, own = noise(rows), lasting(averages, 0.0, True, 4.0)
    top = height(1.0, 1.0 / _BETWEEN)
    first = Limit(plain.foreseen(4.0), 1.0, 4.0, top, plain.mean, plain.memory)
    return np.array([Limit(*first[:6], own.unit, own.mean - plain.mean, *own.weights.tolist())])


def _row(value: float, average: float, bound: float = 0.0) -> Row:
    none, valid = np.zeros(1), np.ones(1, dtype=bool)
    own = Average(np.array([average]), valid, np.array([bound]), np.zeros(1), np.zeros((0, 1)))
    first = Row(0.0, none, None, np.array([value]), valid, np.array([bound]), none, none)
    return first._replace(average=own)


def _alarms(seed: int, shift: float, derivative: float, rows: int) -> tuple[int, list[int]]:
    """False alarms of a residual in so many rows after a hundred, and rows until a shift is seen.

    By sums of rows, and by those of averages.
    """
    values, averages = _residual(seed, 100 + rows, derivative)
    limits = _limits(values[:100], averages[:100])
    cusum, false, seen = Cusum(1, learns=False), 0, [rows, rows]
    for value, average in zip(values[100:], averages[100:], strict=True):
        one = _row(float(value) - limits[0, 4], float(average) - limits[0, 4])
        if cusum.add(one, limits)[0]:
            false += 1
            cusum.restart()
    cusum.restart()
    for k in range(rows):
        place = 100 + k
        one = _row(values[place] + shift - limits[0, 4], averages[place] + shift - limits[0, 4])
        cusum.add(one, limits)
        over = cusum.sums[:, 0] > limits[0, 3]
        for kind, own in enumerate((over[:2], over[3:])):
            if own.any():
                seen[kind] = min(seen[kind], k)
    return false, seen


@pytest.mark.parametrize("derivative", [0.0, 20.0])
def test_healthy_rows_come_to_the_heights_no_more_often_than_wanted(derivative: float) -> None:
    rows, seeds = 500, 16
    false = sum(_alarms(seed, 0.0, derivative, rows)[0] for seed in range(seeds))
    # sums to two sides, of rows and of averages, and how loud rows are: a quarter more is noise
    assert false <= 1.25 * 3.0 * rows * seeds / _BETWEEN


def test_what_stays_is_seen_far_sooner_beside_noise_that_is_differentiated() -> None:
    shift = 1.5 / math.sqrt(_EVERY)
    seen = np.array([_alarms(seed, shift, 20.0, 100)[1] for seed in range(10)])
    by_rows, by_averages = np.median(seen, axis=0)
    assert by_rows > 60 and by_averages < 30


def test_a_bound_counts_for_each_row_that_is_added() -> None:
    limits = np.array([Limit(1.0, 1.0, 4.0, 5.0, 0.0, 1.0, 1.0, 0.0, 0.5, 0.5, 0.0, 0.0)])
    cusum = Cusum(1)
    for sign in (1.0, -1.0, 1.0, 1.0, -1.0, -1.0, 1.0):
        cusum.add(_row(sign * 3.0, sign * 3.0, bound=3.0), limits)
        assert not cusum.sums.any()
    for _ in range(8):
        cusum.add(_row(3.4, 3.4, bound=3.0), limits)
    # 3.4 twice, less the bound twice and a half: the first rows have others before them
    assert cusum.sums[3, 0] == pytest.approx(6 * 0.3 + 0.1)


def test_the_onset_is_when_the_sum_was_zero_that_is_too_high() -> None:
    limits = np.array([Limit(1.0, 1.0, 4.0, 4.0, 0.0, 1.0)])
    cusum = Cusum(1)
    for value in (0.0, -1.2, 0.0, 0.0, 1.5, 1.5, 1.5, 1.5):
        cusum.add(_row(value, value), limits)
        assert cusum.onset(limits) == 0
    assert cusum.add(_row(1.5, 1.5), limits)[0] and cusum.onset(limits) == 5


def test_pieces_of_a_row_have_its_average() -> None:
    draw = np.random.default_rng(2)
    value, slopes = draw.standard_normal((9, 2)), draw.standard_normal((9, 3, 2))
    valid = np.ones((9, 2), dtype=bool)
    valid[7, 1] = False
    bound, doubt = draw.random((9, 2)), draw.random((9, 2))
    whole = averaged(value, valid, bound, doubt, slopes)
    cuts = (slice(0, 2), slice(2, 3), slice(3, 9))
    every = value, valid, bound, doubt, slopes
    joined = all_of([(len(value[c]), averaged(*(x[c] for x in every))) for c in cuts])
    assert whole.valid.tolist() == joined.valid.tolist() == [True, False]
    assert joined.value == pytest.approx(whole.value)
    assert joined.slopes == pytest.approx(whole.slopes)
    assert joined.bound == pytest.approx(bound.mean(axis=0))
    assert joined.doubt == pytest.approx(doubt.mean(axis=0))
    assert len([name for name in Limit._fields if name.startswith("before")]) == LAGS
    assert Limit._fields.index("before1") == 8


@pytest.mark.parametrize(("rows", "last"), [(27, 0.0), (28, 1.0), (60, 1.0)])
def test_a_weight_needs_six_rows_for_itself_and_each_before_it(rows: int, last: float) -> None:
    """Four rows up and four down: each takes off what the fourth before it has added.

    The first four rows have none: of 28 there are 24 left, which is six for each of four weights.
    """
    values = np.resize([1.0] * 4 + [-1.0] * 4, rows)
    assert _weights(values)[3] == pytest.approx(last, abs=1e-9)


@pytest.mark.parametrize("seed", range(20))
def test_weights_are_those_of_least_squares_that_allow_none_below_zero(seed: int) -> None:
    draw = np.random.default_rng(seed)
    columns = draw.standard_normal((LAGS + 1, 60)) + 0.7 * draw.standard_normal(60)
    columns *= draw.choice([-1.0, 1.0], (LAGS + 1, 1))
    weights, left = _positive(columns @ columns.T)
    expected, distance = nnls(columns[1:].T, -columns[0])
    assert weights == pytest.approx(expected, abs=1e-9)
    assert left == pytest.approx(distance**2)


@pytest.mark.parametrize("size", [1e-290, 1e290])
def test_weights_are_the_same_at_any_size(size: float) -> None:
    values = np.diff(np.random.default_rng(5).standard_normal(200))
    assert _weights(size * values) == pytest.approx(_weights(values))
    assert _weights(values).sum() > 0.5


def test_columns_that_are_one_another_share_their_weight() -> None:
    products = np.array([[1.0, -0.5, -0.5], [-0.5, 1.0, 1.0], [-0.5, 1.0, 1.0]])
    weights, left = _positive(products)
    assert weights.sum() == pytest.approx(0.5) and left == pytest.approx(0.75)
