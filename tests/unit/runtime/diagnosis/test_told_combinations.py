"""Directions in which nothing is told, with as few parameters each as there can be."""

from __future__ import annotations

import numpy as np
import pytest

from bondgraph.runtime.diagnosis.told_combinations import untold
from bondgraph.runtime.log import Array


def _covariance(*directions: tuple[float, Array]) -> Array:
    """Of a thousandth, and of so much more in some directions at right angles."""
    found = 1e-3 * np.eye(len(directions[0][1]))
    for variance, along in directions:
        own = along / np.linalg.norm(along)
        found += variance * np.outer(own, own)
    return found


_ONE, _OTHER = np.array([1.0, -1.0, 0.0, 0.0, 0.0]), np.array([0.0, 0.0, 1.0, -2.0, 0.0])


@pytest.mark.parametrize("turned", [0.3, 0.7, 2.0])
def test_two_directions_that_are_mixed_are_told_apart(turned: float) -> None:
    """Whatever turn of both is the largest one: elimination leaves a pair of parameters each."""
    unit = [x / np.linalg.norm(x) for x in (_ONE, _OTHER)]
    first = np.cos(turned) * unit[0] + np.sin(turned) * unit[1]
    second = np.cos(turned) * unit[1] - np.sin(turned) * unit[0]
    found = untold(_covariance((60.0, first), (50.0, second)), 1.0)
    by_first = {int(np.flatnonzero(row)[0]): row for row in found}
    assert sorted(by_first) == [0, 2]
    assert by_first[0] / by_first[0][0] == pytest.approx(_ONE, abs=1e-9)
    assert by_first[2] / by_first[2][2] == pytest.approx(_OTHER, abs=1e-9)
    for row in found:  # the largest of each is one
        assert np.abs(row).max() == pytest.approx(1.0)


def test_three_directions_share_what_they_have_to() -> None:
    """Of all changes whose sum is zero each leaves two parameters in each row."""
    found = untold(np.eye(4) - 0.25, 0.5)
    assert found.shape == (3, 4)
    assert (found != 0).sum(axis=1).tolist() == [2, 2, 2]
    assert found.sum(axis=1) == pytest.approx(0.0, abs=1e-9)
    assert np.linalg.matrix_rank(found) == 3


def test_what_is_as_much_as_is_asked_for_counts() -> None:
    covariance = np.diag([4.0, 1.0, 9.0])
    assert untold(covariance, 4.0).shape == (2, 3)
    assert untold(covariance, 4.1).shape == (1, 3)
    assert untold(covariance, 9.1).shape == (0, 3)
