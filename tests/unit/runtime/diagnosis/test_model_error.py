"""Errors that last, shared out among memories, against covariances that are written out here."""

from __future__ import annotations

import math

import numpy as np
import pytest

from bondgraph.runtime.diagnosis.model_error import Shares, shares, unroot


@pytest.mark.parametrize(("rows", "length"), [(64, 4), (64, 64), (1000, 8), (3, 1), (4, 8)])
def test_shares_are_one_together_and_alike_for_each_octave(rows: int, length: int) -> None:
    own = shares(rows, length)
    assert sum(own.fading) + own.chunk + own.ever == pytest.approx(1.0)
    octaves = int(math.log2(length)) + 1  # memories of 1, 2, 4, ... rows
    assert len(own.fading) == octaves and len(set(own.fading)) == 1
    # what lasts longer than all rows is an octave more, what is between is both by half
    assert own.ever - own.chunk == pytest.approx(own.fading[0])
    between = max(math.log2(rows / length), 0.0)
    assert own.chunk == pytest.approx(own.fading[0] * between / 2.0)


def test_what_is_unrooted_has_no_memory_any_more() -> None:
    draw, own = np.random.default_rng(2), Shares((0.3, 0.2), 0.1, 0.4)
    error = draw.standard_normal((3, 4, 2))
    found = unroot(error, own)
    assert found.shape == (3, 2, 4, 4)
    for chunk in range(3):
        for residual in range(2):
            covariance = np.eye(4)
            for i in range(4):
                for j in range(4):
                    fades = 0.3 * math.exp(-abs(i - j)) + 0.2 * math.exp(-abs(i - j) / 2.0)
                    size = error[chunk, i, residual] * error[chunk, j, residual]
                    covariance[i, j] += size * (0.1 + fades)
            white = found[chunk, residual]
            assert white @ covariance @ white.T == pytest.approx(np.eye(4), abs=1e-9)
            assert np.triu(white, 1) == pytest.approx(0.0)
