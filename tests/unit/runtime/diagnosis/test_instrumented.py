"""What instruments tell of a disturbance in a fit, against closed forms."""

from __future__ import annotations

import math

import numpy as np
import pytest

from bondgraph.runtime.diagnosis.instrumented import leaned
from bondgraph.runtime.diagnosis.whitening import newey_west, newey_west_variances
from bondgraph.runtime.log import Array

N = 4000


def _leaned(x: Array, y: Array, inputs: Array) -> tuple[Array, Array]:
    """Of y (rows,) fitted by columns x (rows, p), with inputs (rows, m) as instruments."""
    basis = np.linalg.qr(np.column_stack([inputs, np.ones(len(y))]))[0]
    alike = np.linalg.inv(np.linalg.cholesky(x.T @ x)).T
    left = y - x @ np.linalg.lstsq(x, y, rcond=None)[0]
    known = {0: (np.ones(len(y), dtype=np.bool_), basis)}
    return leaned(left[:, None], x.T[:, :, None], known, alike)


def test_a_combination_that_follows_the_input_is_told_beside_one_that_does_not() -> None:
    """y = p + d with p = u + d, fitted as a x1 + b x2 with p = x1 + x2 and q = x1 - x2.

    Least squares give p half too much, so a and b are 0.5 too large each. q knows of no input:
    their difference may be anything, and is not said to have moved.
    """
    u, d, q = np.random.default_rng(2).standard_normal((3, N))
    p = u + d
    may, has = _leaned(np.stack([p + q, p - q], axis=1) / 2.0, p + d, u[:, None])
    assert has == pytest.approx(0.25 * np.ones((2, 2)), rel=0.1)
    apart = np.array([1.0, -1.0])
    assert apart @ has @ apart < 1e-3
    assert apart @ may @ apart > 0.01


def test_it_is_the_same_in_all_units_and_for_all_combinations() -> None:
    draw = np.random.default_rng(3)
    u, v, d, e = draw.standard_normal((4, N))
    x = np.stack([u + d, v + 2.0 * e + d, 0.1 * u + e], axis=1)
    y = x.sum(axis=1) + d - e + 0.3 * draw.standard_normal(N)
    may, has = _leaned(x, y, np.stack([u, v], axis=1))
    turn = np.array([[1.0, -2.0, 0.0], [0.0, -300.0, 1.0], [0.5, 0.0, 1e-4]])
    back = np.linalg.inv(turn)
    other = _leaned(x @ turn, y, np.stack([u, v], axis=1))
    for one, two in zip((may, has), other, strict=True):
        assert back @ one @ back.T == pytest.approx(two, rel=1e-4)
    assert np.trace(has) > 0.1


def test_without_a_lean_it_is_what_both_fits_differ_by() -> None:
    """Their difference has the variance of the one less that of the other (Hausman 1978): of x
    of which an input explains the share s that is (1/s - 1)/x'x.

    With Z the difference by its deviation, E max(Z^2, 1) = 1 + 2 phi(1), and what is more than
    scatter is 2 phi(1) in the mean. An offset of y is none.
    """
    more = 2.0 * math.exp(-0.5) / math.sqrt(2.0 * math.pi)
    draw, rows, found = np.random.default_rng(4), 400, []
    for _ in range(3000):
        u, v, noise = draw.standard_normal((3, rows))
        x = u + v
        may, has = _leaned(x[:, None], x + noise + 0.5, u[:, None])
        found.append([may[0, 0], has[0, 0]])
    mean = np.mean(found, axis=0) * 2.0 * rows  # s = 1/2, x'x = 2 rows
    assert mean == pytest.approx([1.0 + more, more], rel=0.1)


@pytest.mark.parametrize("memory", [0.0, 0.9])
def test_inputs_that_know_nothing_of_a_slope_tell_nothing(memory: float) -> None:
    """However many there are, and correlated or not: the fit through them is no better by that."""
    draw = np.random.default_rng(5)
    for _ in range(50):
        x, noise, *inputs = draw.standard_normal((32, N))
        series = (x, noise, *inputs)
        for one in series if memory else ():
            for k in range(1, N):
                one[k] += memory * one[k - 1]
        may, has = _leaned(x[:, None], x + noise, np.stack(inputs, axis=1))
        assert has[0, 0] == 0.0
        assert may[0, 0] > 0.0


def test_variances_are_the_diagonal_of_the_covariance() -> None:
    scores = np.random.default_rng(6).standard_normal((500, 3)).cumsum(axis=0)
    assert newey_west_variances(scores) == pytest.approx(np.diag(newey_west(scores)))
