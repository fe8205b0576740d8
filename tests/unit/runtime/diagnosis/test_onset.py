"""Where a fault sets in, for rows and samples that are counted by hand."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from bondgraph.runtime.diagnosis import onset as module
from bondgraph.runtime.diagnosis.history import History
from bondgraph.runtime.diagnosis.onset import _far, _samples_before, onset_again
from bondgraph.runtime.diagnosis.rows import Row

_LIMITS = np.array([[0.5, 0.0, 4.0, 9.0, 0.0]])
_ENGINE: Any = SimpleNamespace(sample_time=0.1, signals=("a", "b"))


def _row(time: float, valid: bool = True) -> Row:
    """Five samples, the last of them at this time."""
    samples = time - 0.1 * np.arange(4.0, -1.0, -1.0)[:, None] * [1.0, 2.0]
    none = np.zeros(1)
    return Row(time, samples, _ENGINE, none, np.array([valid]), none, none, np.zeros((0, 1)))


@pytest.mark.parametrize(
    ("since", "healthy"),
    [(9.75, 2), (9.85, 3), (9.95, 4), (9.65, 1), (9.55, 0), (9.0, 0)],
)
def test_what_is_healthy_of_the_first_row_that_there_is_again(since: float, healthy: int) -> None:
    rows = [_row(9.5 if since > 9.5 else 8.9), _row(10.0), _row(10.5)]
    found = onset_again(12.0, since, _LIMITS, rows)
    assert found is not None
    assert found.time == since and found.own == healthy
    assert found.healthy.tolist() == rows[1].samples[:healthy].tolist()
    assert [row.time for row in found.rows] == [10.0, 10.5] and found.before == ()
    assert found.engine is _ENGINE


def test_rows_without_a_value_are_no_residuals_and_a_new_clock_knows_no_before() -> None:
    rows = [_row(9.5), _row(10.0, valid=False), _row(10.5)]
    found = onset_again(12.0, 9.75, _LIMITS, rows)
    assert found is not None and [row.time for row in found.rows] == [10.5] and found.own == 0
    assert onset_again(12.0, 10.5, _LIMITS, rows) is None
    assert onset_again(12.0, 9.75, _LIMITS, []) is None
    for time in (11.0, 12.0):  # the clock has begun again: all rows are behind the fault
        again = onset_again(time, 12.0, _LIMITS, rows)
        assert again is not None and [row.time for row in again.rows] == [9.5, 10.5]
        assert again.own == 0 and not len(again.healthy)


def test_what_is_far_is_three_deviations_of_noise_and_of_what_is_not_known() -> None:
    """A parameter of deviation 2 moves the residual by 1.5 each: 9 of variance, and 16 of noise."""
    history = History(np.array([2.0]))
    slopes, noise = np.array([[1.5]]), np.array([16.0])
    for value, far in ((14.9, False), (-14.9, False), (15.1, True), (-15.1, True)):
        assert _far(history, np.array([value]), slopes, noise).tolist() == [far]


@pytest.mark.parametrize(
    ("values", "valid", "fired", "count"),
    [
        ([0, 0, 9, 9, 9], True, True, 2),
        ([0, 9, 0, 9, 9], True, True, 3),  # behind the last one that was as before
        ([9, 9, 9, 9, 9], True, True, 0),
        ([0, 0, 0, 0, 0], True, True, 4),  # it begins in the last sample at the latest
        ([0, 9, 9, 9, 9], False, True, 4),  # of what has no value nothing is told
        ([0, 9, 9, 9, 9], True, False, 4),  # nor of what did not fire
        ([], True, True, 0),
    ],
)
def test_samples_before_the_fault(
    values: list[float], valid: bool, fired: bool, count: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Residuals stand at 5 while all is well; 9 deviations are far from that."""
    own = np.array(values, dtype=float)[:, None] + 5.0
    batch = SimpleNamespace(value=own, valid=np.full(own.shape, valid))
    monkeypatch.setattr(module, "copied", lambda engine: engine)
    engine: Any = SimpleNamespace(run=lambda samples: batch)
    found = _samples_before(
        engine, np.zeros((len(values), 2)), np.array([5.0]), History(np.zeros(0)),
        np.zeros((0, 1)), np.ones(1), np.array([fired]),
    )  # fmt: skip
    assert found == count
