"""Pairs that take noise away: signs that alternate, so that all sizes are known by hand."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from scipy import stats

from bondgraph.runtime.diagnosis.attenuation import beside_their_noise
from bondgraph.runtime.diagnosis.isolation import ExplainedPair, Rows
from bondgraph.runtime.log import Array

_COUNT = 200
_SIGNS = np.where(np.arange(_COUNT) % 2, 1.0, -1.0)[:, None]
#: Neighbours differ by two: the deviation of white noise that does, in the median.
_ROUGH = 2.0 / math.sqrt(2.0) / float(stats.norm.ppf(0.75))
#: How unsure the deviation of so many rows is.
_UNSURE = 1.0 + 2.0 * 1.2 / math.sqrt(_COUNT)
_PAIR: Any = ExplainedPair((None, None), 1000.0, (1.0, 1.0), 0.1, _COUNT, 1100.0)  # type: ignore[arg-type]


def _lost(value: Array, one: Array, moved: Array, noise: float, weight: Array) -> float:
    """How much evidence a pair loses that does so much."""
    nothing = np.empty((_COUNT, 0, value.shape[1]))
    rows = Rows(value, weight, nothing, nothing)
    known = np.full(value.shape, noise)
    (found,) = beside_their_noise(known, rows, one, [_PAIR], [moved])
    lost = _PAIR.evidence - found.evidence
    assert found.whole == pytest.approx(_PAIR.whole - lost)
    assert found.left == pytest.approx(_PAIR.left + 2.0 * lost / _PAIR.values)
    assert found.changes == _PAIR.changes
    return float(lost)


@pytest.mark.parametrize("left", [0.1, 0.42, 0.435, 0.9])
def test_what_leaves_less_than_half_of_the_noise_loses_what_it_explains_of_it(left: float) -> None:
    """Half of it, for sure: with two hundred rows 0.4275 of it."""
    ones = np.ones((_COUNT, 1))
    lost = _lost(_SIGNS, _SIGNS, (1.0 - left) * _SIGNS, 99.0, ones)
    taken = _COUNT * _ROUGH**2 * (1.0 - left**2) / 2.0
    assert 0.42 < 0.5 / _UNSURE < 0.435
    assert lost == pytest.approx(taken if left < 0.43 else 0.0, rel=1e-4)


def test_noise_is_no_more_than_is_known_of_it_nor_than_one_fault_leaves() -> None:
    ones = np.ones((_COUNT, 1))
    for noise, one in ((0.5, _SIGNS), (99.0, math.sqrt(0.5) / _ROUGH * _SIGNS)):
        there = math.sqrt(0.5)  # twice the variance of independent rows
        for left in (0.1, 0.16):
            lost = _lost(_SIGNS, one, (1.0 - left) * _SIGNS, noise, ones)
            quiet = _ROUGH * left
            better = _COUNT * (float(one[0, 0]) ** 2 - left**2)
            more = max(_COUNT * (there**2 - quiet**2), better)
            assert lost == pytest.approx(
                more / 2.0 if quiet * _UNSURE < there / 2.0 else 0.0, rel=1e-4
            )
            assert (lost > 0.0) == (left == 0.1)


def test_what_is_explained_better_than_by_one_counts_where_it_is_more() -> None:
    """A level of 10 that one fault does not explain, and both do with the noise."""
    ones = np.ones((_COUNT, 1))
    value = 10.0 + _SIGNS
    lost = _lost(value, value, value - 0.1 * _SIGNS, 99.0, ones)
    assert lost == pytest.approx(_COUNT * (101.0 - 0.01) / 2.0)


def test_each_residual_counts_by_its_weight_and_unknown_rows_do_not() -> None:
    value = np.hstack([_SIGNS, 3.0 * _SIGNS])
    weight = np.tile([1.0, 0.25], (_COUNT, 1))
    moved = value * [0.9, 0.2]  # of the second most is left
    assert _lost(value, value, moved, 99.0, weight) == pytest.approx(
        _COUNT * _ROUGH**2 * 0.99 / 2.0, rel=1e-4
    )
    moved = value * [0.2, 0.9]
    assert _lost(value, value, moved, 99.0, weight) == pytest.approx(
        0.25 * _COUNT * (3.0 * _ROUGH) ** 2 * 0.99 / 2.0, rel=1e-4
    )
    weight[::2, 1] = 0.0  # no two neighbours are known: nothing is told of its noise
    assert _lost(value, value, moved, 99.0, weight) == 0.0
