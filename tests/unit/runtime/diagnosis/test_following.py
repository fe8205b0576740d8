"""Whether a command follows a sensor, in series that are shifted by hand."""

from __future__ import annotations

import math

import numpy as np
import pytest

from bondgraph.runtime.diagnosis.following import Following
from bondgraph.runtime.log import Array

_DRAW = np.random.default_rng(5).standard_normal(300)


def _shifted(by: int, sign: float = 1.0) -> Array:
    """A sensor, and a command that does the same so many samples later."""
    return np.column_stack([_DRAW, sign * np.roll(_DRAW, by)])[10:-10]


def _of(error: Array, passed: float | None = None) -> Following:
    def passed_on(sample: Array, sizes: Array) -> Array:
        assert sample.tolist() == [3.0, 4.0] and sizes.tolist() == [1.0, 2.0]
        return np.array([[0.0, passed], [0.0, 0.0]])

    found = Following(2, None if passed is None else passed_on)
    found.row(error, np.array([3.0, 4.0]), np.array([1.0, 2.0]))
    return found


@pytest.mark.parametrize("sign", [1.0, -1.0])
@pytest.mark.parametrize("by", [-2, -1, 0, 1, 2])
def test_a_command_is_as_many_samples_later_as_it_was_shifted(by: int, sign: float) -> None:
    found = _of(_shifted(by, sign))
    assert found.later(0, 1) == by and found.later(1, 0) == -by
    assert found.leads(0, 1) == (by > 0)  # at once it may be the motion that it makes


@pytest.mark.parametrize("by", [-3, 3, 20])
def test_what_is_further_away_or_something_else_follows_nothing(by: int) -> None:
    found = _of(_shifted(by))
    assert math.isnan(found.later(0, 1)) and not found.leads(0, 1)


@pytest.mark.parametrize(("share", "follows"), [(0.45, False), (0.55, True)])
def test_two_do_the_same_from_a_correlation_of_a_half_on(share: float, follows: bool) -> None:
    """A sensor is off once; a command by that share of itself in the same sample."""
    error = np.zeros((40, 2))
    error[10, 0] = 2.0
    error[10, 1], error[25, 1] = 3.0 * share, 3.0 * math.sqrt(1.0 - share**2)
    found = _of(error).later(0, 1)
    assert found == 0 if follows else math.isnan(found)


@pytest.mark.parametrize(
    ("passed", "leads"), [(0.0, True), (0.24, True), (0.25, False), (1.0, False), (None, False)]
)
def test_at_once_a_command_answers_what_it_cannot_have_made(
    passed: float | None, leads: bool
) -> None:
    """It is twice as large as what the sensor shows: it may make half of that at most."""
    error = np.column_stack([_DRAW, 2.0 * _DRAW])
    assert _of(error, passed).leads(0, 1) == leads


def test_each_row_is_of_its_own() -> None:
    found = _of(_shifted(1), 0.0)
    assert found.leads(0, 1) and found.passes.shape == (2, 2)
    found.row(_shifted(-1), np.array([3.0, 4.0]), np.array([1.0, 2.0]))
    assert not found.leads(0, 1)
    passed = iter([0.0, 1.0])
    made = Following(2, lambda sample, sizes: np.full((2, 2), next(passed)))
    for leads in (True, False):
        made.row(_shifted(0), np.zeros(2), np.zeros(2))
        assert made.leads(0, 1) == leads and made.leads(1, 0) == leads
    assert math.isnan(Following(2, None).later(0, 1))
