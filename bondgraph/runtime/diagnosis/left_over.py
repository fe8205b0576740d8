"""Whether what is left of a residual follows the inputs, or is a disturbance of its own.

A law that is another leaves something that depends on what drives the machine: on its inputs,
their squares and products (RESET, Ramsey 1969), now and a while ago (Ljung 1999, 16.6). A
disturbance that the model knows nothing of depends on none of these. What sensors say would not do:
disturbances are in it.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import combinations_with_replacement

import numpy as np

from bondgraph.runtime.diagnosis.whitening import LAGS, filtered
from bondgraph.runtime.log import Array, Mask

_PAST = 2 * LAGS  # rows
_ROWS = 10  # for each number that is fitted: with less there are fewer functions
_STILL = 1e-6  # of its size: what changes less is a constant
_APART = 1e-6  # of the largest: a smaller direction is none


def follows(left: Array, inputs: Array, filter: Array, mask: Mask) -> float | None:
    """The share of what is `left` (rows,) that functions of the `inputs` (rows, inputs) explain.

    Left has passed a filter, inputs have not. Rows that do not count are out of the `mask`. The
    share is what is expected of as many rows more: 0, or a little below, where nothing follows.
    None where that cannot be told: no input changes, or the rows are too few.

    >>> draw = np.random.default_rng(1)
    >>> u, e, mask = *draw.standard_normal((2, 5000)), np.ones(5000, dtype=bool)
    >>> one = np.eye(1, LAGS + 1)[0]
    >>> abs(round(follows(e, u[:, None], one, mask), 2))
    0.0
    >>> bent = np.roll(u, 2) ** 2 + 0.01 * e
    >>> round(follows(bent, u[:, None], one, mask), 2)
    1.0
    """
    basis = instruments(inputs, filter, mask)
    if basis is None:
        return None
    rows, size = basis.shape
    own = left[mask] - left[mask].mean()
    whole = float(np.sum(own**2))
    if not whole:
        return 0.0
    explained = float(np.sum((basis.T @ own) ** 2)) / whole
    return float(1.0 - (1.0 - explained) * rows / (rows - size))


def instruments(inputs: Array, filter: Array, mask: Mask) -> Array | None:
    """Orthonormal functions of the inputs in the rows that count, (these, functions), of mean 0.

    What correlates with these is no disturbance. None as `follows` says.
    """
    usual = [_usual(u) for u in inputs.T]
    moving = [u for u in usual if u is not None]
    rows = int(mask.sum())
    for degree in (3, 2, 1):
        table = [] if not moving else _functions(moving, degree)
        if table and rows > _ROWS * len(table):
            break
    else:
        return None
    columns = [filtered(one[:, None], filter[:, None])[:, 0] for one in table]
    there = np.array([np.where(np.isfinite(c), c, 0.0)[mask] for c in columns]).T
    moved = there - there.mean(axis=0)
    still = np.linalg.norm(moved, axis=0) <= _STILL * np.linalg.norm(there, axis=0)
    return _basis(np.where(still, 0.0, moved))  # what stands still in these rows is rounding


def _usual(values: Array) -> Array | None:
    """An input with mean 0 and deviation 1, 0 where there is none; None for one that stands."""
    if not np.isfinite(values).any():
        return None
    mean, deviation = float(np.nanmean(values)), float(np.nanstd(values))
    if not deviation > _STILL * abs(mean):
        return None
    return np.nan_to_num((values - mean) / deviation)


def _functions(inputs: Sequence[Array], degree: int) -> list[Array]:
    """Powers and products up to a degree, now and before."""
    found = []
    for power in range(1, degree + 1):
        for one in combinations_with_replacement(range(len(inputs)), power):
            value = np.prod([inputs[k] for k in one], axis=0)
            found += [np.roll(value, lag) for lag in range(_PAST + 1)]
    return found


def _basis(table: Array) -> Array:
    """Orthonormal columns for those of a table, each of which counts alike."""
    size = np.linalg.norm(table, axis=0)
    alike = table / np.where(size > 0, size, 1.0)
    squares, turn = np.linalg.eigh(alike.T @ alike)  # of few columns: far cheaper than of the table
    there = squares > _APART**2 * squares.max(initial=0.0)
    return np.asarray(alike @ (turn[:, there] / np.sqrt(squares[there])))
