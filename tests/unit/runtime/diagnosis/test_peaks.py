"""How high sums may climb, from peaks that are counted by hand."""

from __future__ import annotations

import json

import numpy as np
import pytest

from bondgraph.runtime.diagnosis.peaks import Peaks

_NORMAL = np.array([10.0, 100.0])


def _learned(*sums: tuple[float, float]) -> Peaks:
    peaks = Peaks(2)
    for one in sums:
        peaks.learn(np.array(one))
    return peaks


def test_without_peaks_heights_are_those_of_normal_rows() -> None:
    assert Peaks(2).heights(_NORMAL).tolist() == [10.0, 100.0]
    low = _learned((1.0, 0.5), (0.0, 0.0))  # no more than one is no peak
    assert low.heights(_NORMAL).tolist() == [10.0, 100.0]


def test_peaks_stretch_heights_by_their_mean_excess_over_one() -> None:
    """With twenty of normal rows, of excess one each, that are reckoned with before."""
    peaks = _learned((2.0, 0.0), (5.0, 0.0), (3.0, 0.0), (0.0, 0.0), (3.0, 0.0), (0.0, 0.0),
                     (1.0, 0.0), (0.0, 0.0))  # fmt: skip
    stretch = (20.0 + (5.0 - 1.0) + (3.0 - 1.0)) / (20.0 + 2.0)
    assert peaks.heights(_NORMAL) == pytest.approx([stretch * 10.0, 100.0])


def test_low_peaks_never_shrink_heights() -> None:
    peaks = _learned(*[(1.5, 0.0), (0.0, 0.0)] * 50)
    assert peaks.heights(_NORMAL).tolist() == [10.0, 100.0]


def test_heights_are_above_the_highest_peak() -> None:
    peaks = _learned((50.0, 3.0), (0.0, 0.0), (2.0, 0.0), (0.0, 0.0))
    assert peaks.heights(np.array([0.001, 0.001])) == pytest.approx([1.2 * 50.0, 1.2 * 3.0])


def test_a_sum_that_is_still_climbing_is_no_peak_yet() -> None:
    peaks = _learned((50.0, 0.0))
    assert peaks.heights(_NORMAL).tolist() == [10.0, 100.0]
    assert peaks.open.tolist() == [50.0, 0.0]
    peaks.restart()
    assert peaks.open.tolist() == [0.0, 0.0]
    peaks.learn(np.zeros(2))
    assert peaks.heights(_NORMAL).tolist() == [10.0, 100.0]


def test_peaks_of_several_sums_of_one_residual_count_together() -> None:
    """Each sum has a highest peak of its own."""
    peaks = Peaks(3, 1)
    for one in ([[4.0], [2.0], [0.5]], [[0.0], [0.0], [0.0]]):
        peaks.learn(np.array(one))
    stretch = (20.0 + 3.0 + 1.0) / 22.0
    assert peaks.heights(np.full((3, 1), 10.0)) == pytest.approx(np.full((3, 1), stretch * 10.0))
    low = peaks.heights(np.full((3, 1), 1e-6))
    assert low[:2] == pytest.approx(np.array([[4.8], [2.4]])) and low[2] < 1e-3


def test_what_is_known_is_plain_json_and_known_again() -> None:
    peaks = Peaks(3, 2)
    peaks.learn(np.array([[50.0, 3.0], [2.0, 4.0], [7.0, 0.0]]))
    peaks.learn(np.zeros((3, 2)))
    again = Peaks(3, 2)
    again.resume(json.loads(json.dumps(peaks.state())))
    for normal in (np.full((3, 2), 1e-3), np.full((3, 2), 30.0)):
        assert again.heights(normal).tolist() == peaks.heights(normal).tolist()
    with pytest.raises(ValueError, match="reshape"):
        Peaks(2, 2).resume(peaks.state())
