"""Functions of the inputs, and how much of what is left they explain, against least squares."""

from __future__ import annotations

from itertools import combinations_with_replacement

import numpy as np
import pytest

from bondgraph.runtime.diagnosis.left_over import follows, instruments
from bondgraph.runtime.diagnosis.whitening import LAGS
from bondgraph.runtime.log import Array

_NOW = np.eye(1, LAGS + 1)[0]  # a filter that changes nothing
_LAGS = 2 * LAGS + 1  # a function now, and in so many rows before


def _inputs(rows: int, count: int = 1, seed: int = 1) -> Array:
    return np.random.default_rng(seed).standard_normal((rows, count))


def _everywhere(rows: int) -> Array:
    return np.ones(rows, dtype=bool)


@pytest.mark.parametrize(
    ("rows", "inputs", "functions"),
    [
        (10 * _LAGS, 1, None),
        (10 * _LAGS + 1, 1, _LAGS),
        (20 * _LAGS, 1, _LAGS),
        (20 * _LAGS + 1, 1, 2 * _LAGS),  # squares, too
        (30 * _LAGS + 1, 1, 3 * _LAGS),  # and third powers
        (50 * _LAGS, 2, 2 * _LAGS),
        (50 * _LAGS + 1, 2, 5 * _LAGS),  # a, b, aa, ab, bb
        (90 * _LAGS + 1, 2, 9 * _LAGS),
    ],
)
def test_there_are_ten_rows_for_each_function_at_least(
    rows: int, inputs: int, functions: int | None
) -> None:
    found = instruments(_inputs(rows, inputs), _NOW, _everywhere(rows))
    assert (None if found is None else found.shape) == (
        None if functions is None else (rows, functions)
    )


def test_rows_that_do_not_count_are_no_rows() -> None:
    rows = 20 * _LAGS
    mask = _everywhere(2 * rows)
    mask[:rows] = False
    found = instruments(_inputs(2 * rows), _NOW, mask)
    assert found is not None and found.shape == (rows, _LAGS)
    assert found.T @ found == pytest.approx(np.eye(_LAGS), abs=1e-9)
    assert found.mean(axis=0) == pytest.approx(0.0, abs=1e-12)


def test_an_input_that_stands_moves_nothing() -> None:
    rows = 1000
    draw = _inputs(rows)
    for still in (0.0 * draw, 0.0 * draw + 3.0, 5.0 + 1e-7 * draw, np.full_like(draw, np.nan)):
        assert instruments(still, _NOW, _everywhere(rows)) is None
        assert follows(draw[:, 0], still, _NOW, _everywhere(rows)) is None
        both = instruments(np.hstack([still, draw]), _NOW, _everywhere(rows))
        assert both is not None and both.shape == (rows, 3 * _LAGS)
    assert instruments(5.0 + 1e-3 * draw, _NOW, _everywhere(rows)) is not None


def test_an_input_counts_in_deviations_of_its_own() -> None:
    """Its size and its level make no difference, though powers of it are taken."""
    draw, left = _inputs(1000), _inputs(1000, seed=2)[:, 0]
    one = follows(left, draw, _NOW, _everywhere(1000))
    other = follows(left, 400.0 - 1e3 * draw, _NOW, _everywhere(1000))
    assert one == pytest.approx(other)


def _by_least_squares(left: Array, inputs: Array) -> float:
    """The adjusted share that powers up to the third and products explain, now and before."""
    usual = (inputs - inputs.mean(axis=0)) / inputs.std(axis=0)
    columns = []
    for power in (1, 2, 3):
        for one in combinations_with_replacement(usual.T, power):
            for lag in range(_LAGS):
                column = np.roll(np.prod(one, axis=0), lag)
                column[:LAGS] = 0.0  # where a filter has not begun
                columns.append(column - column.mean())
    own = left - left.mean()
    table = np.array(columns).T
    rest = own - table @ np.linalg.lstsq(table, own, rcond=None)[0]
    n, p = table.shape
    return 1.0 - float(rest @ rest) / float(own @ own) * n / (n - p)


@pytest.mark.parametrize(("inputs", "rows"), [(1, 600), (2, 1600)])
@pytest.mark.parametrize("share", [0.0, 0.5, 1.0])
def test_the_share_is_that_of_least_squares_for_as_many_rows_more(
    inputs: int, rows: int, share: float
) -> None:
    draw, noise = _inputs(rows, inputs), _inputs(rows, seed=3)[:, 0]
    bent = np.roll(draw[:, 0] * draw[:, -1], 2)
    left = share * bent + (1.0 - share) * noise
    left[:LAGS] = 0.0
    found = follows(left, draw, _NOW, _everywhere(rows))
    assert found == pytest.approx(_by_least_squares(left, draw), abs=1e-6)
    assert (found > 0.9) == (share == 1.0) and (found < 0.2) == (share == 0.0)


def test_of_nothing_nothing_follows() -> None:
    assert follows(np.full(1000, 7.0), _inputs(1000), _NOW, _everywhere(1000)) == 0.0


def test_what_moved_only_where_rows_do_not_count_explains_nothing() -> None:
    rows = 1000
    mask = np.arange(2 * rows) >= rows
    before = np.zeros((2 * rows, 1))
    before[: rows - 2 * _LAGS, 0] = np.resize([1.0, -1.0], rows - 2 * _LAGS)
    found = instruments(np.hstack([before, _inputs(2 * rows)]), _NOW, mask)
    assert found is not None and np.isfinite(found).all()
    assert follows(_inputs(2 * rows, seed=2)[:, 0], before, _NOW, mask) == 0.0


def test_functions_count_alike_however_small_they_are_in_the_rows_that_count() -> None:
    """Powers of what moves by a thousandth of what it moved by before."""
    rows = 1000
    draw, mask = _inputs(2 * rows), np.arange(2 * rows) >= rows
    draw[:rows, 0] = np.resize([1e3, -1e3], rows)
    draw[rows - _LAGS : rows] = 0.0
    found = instruments(draw, _NOW, mask)
    assert found is not None and found.shape == (rows, 3 * _LAGS)


def test_an_input_that_is_told_twice_counts_once() -> None:
    draw = _inputs(3000)
    found = instruments(np.hstack([draw, 5.0 - 2.0 * draw]), _NOW, _everywhere(3000))
    assert found is not None and found.shape == (3000, 3 * _LAGS)
    assert found.T @ found == pytest.approx(np.eye(3 * _LAGS), abs=1e-6)
