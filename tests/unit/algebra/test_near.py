"""Functions near those of the library are as near as is said."""

from __future__ import annotations

import math

import numpy as np

from bondgraph.algebra.interpreter import DOUBLE
from bondgraph.algebra.near import BOUND, FAR, near_tanh


def test_tanh_is_near_everywhere() -> None:
    edge = math.sqrt(FAR)
    dense = np.concatenate([
        np.linspace(-12.0, 12.0, 60_001), np.linspace(edge - 1e-3, edge + 1e-3, 1001),
        np.logspace(-300.0, 300.0, 2001), [0.0],
    ])  # fmt: skip
    for x in dense.tolist():
        assert abs(near_tanh(x, float, DOUBLE.choose) - math.tanh(x)) <= BOUND
        assert near_tanh(-x) == -near_tanh(x)


def test_small_arguments_keep_their_digits_and_nan_is_told() -> None:
    for x in np.logspace(-12.0, -1.0, 100).tolist():
        assert abs(near_tanh(x) / math.tanh(x) - 1.0) < 1e-9
    assert math.isnan(near_tanh(math.nan))
    assert near_tanh(math.inf) == 1.0 and near_tanh(-math.inf) == -1.0
