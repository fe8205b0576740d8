"""Where a fault sets in, for rows and samples that are counted by hand."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from bondgraph.runtime.diagnosis import onset as module
from bondgraph.runtime.diagnosis.history import History
from bondgraph.runtime.diagnosis.onset import _far, _samples_before, onset, onset_again
from bondgraph.runtime.diagnosis.row_averages import LAGS
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


def _past(odd: int, warm_up: float, count: int = 15) -> list[Row]:
    """Rows of five samples, of which the last ones are odd; each with an engine of its own."""
    found = []
    for k in range(count):
        engine: Any = SimpleNamespace(
            sample_time=0.1, signals=("a", "b"), lags=[0.0, 0.25], warm_up=warm_up, number=k
        )
        value = np.array([9.0 if k >= count - odd else 0.0, 9.0])
        row = _row(0.5 * (k + 1))
        own = {"engine": engine, "value": value, "bound": np.zeros(2), "doubt": np.zeros(2)}
        found.append(row._replace(valid=np.ones(2, dtype=bool), slopes=np.zeros((0, 2)), **own))
    return found


_BOTH = np.array([[0.5, 0.0, 4.0, 9.0, 0.0]] * 2)


def _onset(
    past: list[Row], monkeypatch: pytest.MonkeyPatch, before: int = 3, rows: int | None = None
) -> Any:
    """Where a fault of the first residual sets in; with `rows` a sum of so many has fired."""
    monkeypatch.setattr(module, "_samples_before", lambda *_: before)
    detection: Any = SimpleNamespace(fired=np.array([True, False]), onset=lambda limits: rows)
    piece = [] if rows is not None else [np.zeros((2, 2))]
    now: Any = SimpleNamespace(sample_time=0.1, signals=("a", "b"), lags=[0.25], warm_up=0.25)
    return onset(99.0, now, piece, past, detection, _BOTH, History(np.zeros(0)))


def test_a_fault_begins_behind_the_last_row_that_was_as_expected(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Three are odd; what is out in a residual that has not fired does not count."""
    past = _past(3, 0.25)
    found = _onset(past, monkeypatch)
    last = past[11]
    assert found.time == pytest.approx(last.time + 0.3) and found.own == 3
    assert [row.time for row in found.rows] == [row.time for row in past[12:]]
    # as many rows before it as averages hang together
    assert [row.time for row in found.before] == [row.time for row in past[12 - LAGS : 12]]
    assert found.engine.number == 12 - LAGS
    assert found.healthy.tolist() == [
        *[sample for row in found.before for sample in row.samples.tolist()],
        *past[12].samples[:3].tolist(),
    ]


@pytest.mark.parametrize(
    ("warm_up", "rows"), [(0.25, LAGS), (3.75, 9), (3.76, 10), (4.25, 10), (60.0, 12)]
)
def test_as_many_samples_come_before_as_filters_need_to_settle(
    warm_up: float, rows: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Beside the last of them; five samples a row, and a quarter of a second to read."""
    past = _past(3, warm_up)
    monkeypatch.setattr(module, "_samples_before", lambda *_: 0)
    detection: Any = SimpleNamespace(fired=np.array([True, False]), onset=lambda limits: 0)
    found = onset(99.0, past[0].engine, [np.zeros((2, 2))], past, detection, _BOTH,
                  History(np.zeros(0)))  # fmt: skip
    assert len(found.before) == rows


def test_a_sum_of_rows_tells_itself_when_it_was_zero(monkeypatch: pytest.MonkeyPatch) -> None:
    for odd, since, begin in ((3, 5, 9), (3, 1, 11), (0, 4, 10), (0, 99, 0), (15, 2, 0)):
        past = _past(odd, 0.25)
        found = _onset(past, monkeypatch, 0, since)
        assert found.time == pytest.approx(past[begin].time)
        assert len(found.rows) == 14 - begin


def test_without_a_past_a_fault_begins_now(monkeypatch: pytest.MonkeyPatch) -> None:
    found = _onset([], monkeypatch)
    assert found.time == 99.0 and found.own == 0 and found.rows == () and found.before == ()
    assert found.healthy.shape == (0, 2)
