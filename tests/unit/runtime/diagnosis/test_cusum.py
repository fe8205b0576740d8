"""Sums of rows: how often noise climbs to a height, what climbs there, what peaks teach."""

from __future__ import annotations

import json
import math

import numpy as np
import pytest
from scipy.signal import lfilter

from bondgraph.runtime.diagnosis.cusum import Cusum
from bondgraph.runtime.diagnosis.rows import Row
from bondgraph.runtime.diagnosis.tuning import Limit, height
from bondgraph.runtime.log import Array

_BETWEEN = 300.0  # rows between false alarms of each kind
_TOP = height(1.0, 1.0 / _BETWEEN)


def _limits(memory: float = 1.0, residuals: int = 1) -> Array:
    return np.array([Limit(1.0, 1.0, 4.0, _TOP, 0.0, memory)] * residuals)


def _row(*value: float, bound: float = 0.0, valid: bool = True) -> Row:
    own, none = np.array(value), np.zeros(len(value))
    valids = np.full(len(value), valid)
    return Row(0.0, none, None, own, valids, np.full(len(value), bound), none, none)


def _alarms(cusum: Cusum, values: Array, limits: Array) -> list[int]:
    """The rows in which sums come to their heights, of mean and of loudness; they begin anew.

    `values` have a column for each residual, and a row counts once for each that is too far in it.
    """
    found: list[int] = []
    for k, value in enumerate(values):
        over = cusum.add(_row(*value), limits)
        found += [k] * int(over.sum())
        _restart(cusum, over)
    return found


def _restart(cusum: Cusum, over: np.ndarray) -> None:
    """As `Cusum.restart`, of some residuals: the others are machines of their own here."""
    for part in (cusum.sums, cusum._peaks.open, cusum._since):
        part[:, over] = 0.0


def _noisy(seed: int) -> Array:
    """60 000 rows of noise, as twenty residuals that are watched side by side."""
    return np.random.default_rng(seed).standard_normal((3000, 20))


def test_noise_comes_to_the_height_of_a_mean_as_often_as_wanted() -> None:
    # a variance that is divided by four is never loud: what is left are the sums of the mean
    cusum, alarms = Cusum(20, learns=False), 0
    for value in _noisy(1):
        cusum.add(_row(*value), _limits(residuals=20))
        over = cusum.sums[:2].max(axis=0) > _TOP
        _restart(cusum, over)
        alarms += int(over.sum())
    assert alarms == pytest.approx(60_000 / _BETWEEN, rel=0.25)


def test_noise_comes_to_the_height_of_loudness_no_more_often_than_wanted() -> None:
    cusum, alarms = Cusum(20, learns=False), 0
    for value in _noisy(2):
        cusum.add(_row(*value), _limits(residuals=20))
        over = cusum.sums[2] > _TOP + 1.166
        _restart(cusum, over)
        alarms += int(over.sum())
    # a ratio of likelihoods is above exp(x) no more often than exp(-x) (Ville, 1939)
    assert alarms <= 60_000 / _BETWEEN


@pytest.mark.parametrize(
    ("mean", "deviation", "soon"), [(1.5, 1.0, 12), (-1.5, 1.0, 12), (0.0, 3.0, 12), (0.0, 2.0, 40)]
)
def test_another_mean_and_another_deviation_are_seen(
    mean: float, deviation: float, soon: int
) -> None:
    draws = [np.random.default_rng(seed).standard_normal(400) for seed in range(40)]
    cusum, limits = Cusum(40), _limits(residuals=40)
    rows = mean + deviation * np.array(draws).T
    alarms = np.array([cusum.add(_row(*row), limits) for row in rows])
    assert alarms.any(axis=0).all()
    assert np.median(alarms.argmax(axis=0)) < soon


def test_an_oscillation_is_loud_and_has_no_mean() -> None:
    values = 3.0 * np.cos(2.8 * np.arange(60))
    cusum = Cusum(1)
    assert any(cusum.add(_row(value), _limits())[0] for value in values[:12].tolist())
    assert cusum.sums[2, 0] > _TOP + 1.0 > cusum.sums[:2].max()


def test_no_single_row_is_loud() -> None:
    cusum = Cusum(1)
    cusum.add(_row(-100.0), _limits())
    assert cusum.sums[2, 0] <= (_TOP + 1.166) / 3.0 + 1e-9


def test_what_is_within_the_bound_adds_nothing() -> None:
    cusum = Cusum(2)
    for value in (3.0, -3.0, 2.0, -1.0):
        cusum.add(_row(value, -value, bound=3.0), _limits(residuals=2))
    assert not cusum.sums.any()


def _restless(seed: int, count: int) -> Array:
    """Noise of deviation one that is three times as loud now and then, for some fifty rows."""
    draw = np.random.default_rng(seed)
    slow = lfilter([0.02], [1, -0.98], draw.standard_normal(count + 1000))[1000:]
    loud = np.where(slow > 0.9 * slow.std(), 2.0, 0.7)
    values = loud * draw.standard_normal(count)
    return np.asarray(values / values.std())


def test_peaks_of_a_restless_machine_stretch_the_heights() -> None:
    limits = _limits(residuals=3)
    limits[:, 3] = height(1.0, 1.0 / 3000.0)
    values = np.stack([_restless(seed, 12_000) for seed in range(3)], axis=1)
    plain = sum(k > 6000 for k in _alarms(Cusum(3, learns=False), values, limits))
    learned = sum(k > 6000 for k in _alarms(Cusum(3), values, limits))
    assert learned < 0.6 * plain


def test_normal_noise_hardly_stretches_the_heights() -> None:
    cusum, limits = Cusum(1), _limits()
    limits[0, 3] = height(1.0, 1e-5)
    for value in np.random.default_rng(3).standard_normal(20_000).tolist():
        assert not cusum.add(_row(value), limits)[0]
    assert cusum.heights(limits[:, 3]).max() < 1.3 * limits[0, 3]


def test_a_fault_that_is_told_teaches_nothing() -> None:
    cusum = Cusum(1)
    for value in (3.0,) * 10:
        cusum.add(_row(value), _limits())
    cusum.restart()
    assert cusum.heights(np.array([5.0])).max() == pytest.approx(5.0)


def test_an_alarm_is_high_until_rows_make_it_twenty_times_as_probable_that_it_is_over() -> None:
    # a mean that is one deviation off, or none: a row at zero makes none exp(1/2) times as probable
    for size in (2.0, 20.0):
        cusum, limits = Cusum(1, learns=False), _limits()
        for _ in range(200):
            cusum.add(_row(size), limits)
        rows = 0
        while cusum.high(limits).any():
            cusum.add(_row(0.0), limits)
            rows += 1
        assert rows == math.ceil(math.log(20.0) / 0.5)


def test_rows_are_held_until_the_sums_are_zero_again() -> None:
    cusum, held = Cusum(1), []
    for value in (0.0, 1.0, 1.0, 0.0, -0.2, -0.4, -0.4, 1.2):
        cusum.add(_row(value), _limits())
        held.append(int(cusum.held[0]))
    assert held == [0, 1, 2, 3, 0, 0, 0, 1]


@pytest.mark.parametrize("sigma", [math.inf, 1.0])
def test_without_a_noise_or_a_value_the_sums_begin_anew(sigma: float) -> None:
    cusum = Cusum(1)
    cusum.add(_row(2.0), _limits())
    limits = _limits()
    limits[0, 0] = sigma
    assert not cusum.add(_row(2.0, valid=math.isinf(sigma)), limits)[0]
    assert not cusum.sums.any()


def test_a_state_goes_through_json() -> None:
    cusum = Cusum(2)
    for value in (0.0, 2.5, -2.0, 0.3, 0.1, 0.0, 2.0):
        cusum.add(_row(value, -value), _limits(residuals=2))
    other = cusum.resumed(json.loads(json.dumps(cusum.state())))
    assert (other.sums == cusum.sums).all()
    normal = np.full(2, 1.0)
    assert (other.heights(normal) == cusum.heights(normal)).all()
    with pytest.raises(ValueError, match="reshape"):
        Cusum(3).resumed(cusum.state())
