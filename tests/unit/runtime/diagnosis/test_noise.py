"""What healthy rows tell of noise: checked on processes whose numbers are known."""

from __future__ import annotations

import math

import numpy as np
import pytest

from bondgraph.runtime.diagnosis.noise import noise
from bondgraph.runtime.log import Array


def remembering(keep: float, count: int, draw: np.random.Generator) -> Array:
    """Noise of deviation 1 that keeps so much of itself from row to row."""
    values = np.empty(count)
    value = draw.normal()
    for k, step in enumerate(draw.normal(0.0, math.sqrt(1.0 - keep**2), count)):
        values[k] = value
        value = keep * value + step
    return values


@pytest.mark.parametrize("keep", [0.6, 0.8, 0.9])
def test_the_memory_is_that_of_the_process(keep: float) -> None:
    """The correlations keep^|k| add up to (1 + keep) / (1 - keep), their squares likewise."""
    found = noise(remembering(keep, 40_000, np.random.default_rng(3)))
    assert found.sigma == pytest.approx(1.0, rel=0.05)
    assert found.memory == pytest.approx((1.0 + keep) / (1.0 - keep), rel=0.15)
    squared = (1.0 + keep**2) / (1.0 - keep**2)
    assert found.freedom == pytest.approx(40_000 / squared, rel=0.15)


@pytest.mark.parametrize("count", [10, 20, 40, 200])
def test_the_next_rows_are_above_a_level_as_rarely_as_it_says(count: int) -> None:
    """White rows behind a filter of third order: a correlation of 0.35 from row to row."""
    draw = np.random.default_rng(count)
    level, above, rows = 3.0, 0, 0
    for _ in range(800):
        values = remembering(0.35, count + 60, draw)
        found = noise(values[:count])
        off = np.abs(values[count:] - found.mean)
        above += int((off > level * found.foreseen(level)).sum())
        rows += 60
    assert above / rows < 1.3 * math.erfc(level / math.sqrt(2.0))


def test_rows_without_a_value_and_rows_of_a_filter_that_settles_do_not_count() -> None:
    values = np.random.default_rng(5).normal(2.0, 0.1, 300)
    plain = noise(values)
    values[[7, 70, 71]] = math.nan
    values[0] = 1e3
    found = noise(values)
    assert found.rows == 296
    assert found.mean == pytest.approx(plain.mean, abs=0.01)
    assert found.sigma == pytest.approx(plain.sigma, rel=0.05)


def test_numbers_that_parameters_have_taken_are_given_back() -> None:
    """Twenty parameters fitted to a hundred white rows leave eighty degrees of freedom."""
    draw = np.random.default_rng(8)
    sizes, plain = [], []
    for _ in range(200):
        values, slopes = draw.normal(size=100), draw.normal(size=(100, 20))
        rest = values - slopes @ np.linalg.lstsq(slopes, values, rcond=None)[0]
        sizes.append(noise(rest, 20.0, centred=False).sigma ** 2)
        plain.append(noise(rest, 0.0, centred=False).sigma ** 2)
    assert np.mean(sizes) == pytest.approx(1.0, rel=0.03)
    assert np.mean(plain) == pytest.approx(0.8, rel=0.03)


@pytest.mark.parametrize("count", [50, 4000])
def test_rows_that_are_not_centred_deviate_from_zero(count: int) -> None:
    """By their mean and by their noise; no degree of freedom goes for a mean."""
    values = np.random.default_rng(9).normal(0.5, 1.0, count)
    found = noise(values, centred=False)
    assert found.mean == 0.0 and noise(values).mean == pytest.approx(values.mean())
    assert found.sigma == pytest.approx(math.sqrt(np.mean(values**2)))


def test_of_nothing_nothing_is_known() -> None:
    assert noise(np.full(5, math.nan)).sigma == math.inf
    assert noise(np.full(20, 3.0)).sigma == 0.0
