"""Peak gains: met by the worst input that there is, and exceeded by none."""

from __future__ import annotations

import numpy as np
import pytest

from bondgraph.algebra.peak_gain import Unstable, peak_gains


def _response(a: np.ndarray, b: np.ndarray, c: np.ndarray, d: float, samples: int) -> np.ndarray:
    found, x = [d], b
    for _ in range(samples - 1):
        found.append(float(c @ x))
        x = a @ x
    return np.array(found)


@pytest.mark.parametrize("seed", range(5))
def test_the_worst_input_comes_to_the_gain(seed: int) -> None:
    """It has the signs of the impulse response, backwards in time."""
    draw = np.random.default_rng(seed)
    a = np.tril(draw.uniform(-0.5, 0.5, (3, 3)), -1) + np.diag(draw.uniform(-0.9, 0.95, 3))
    b, c, d = draw.normal(size=3), draw.normal(size=3), float(draw.normal())
    [[gain]] = peak_gains(a, b[:, None], c[None, :], np.array([[d]]), np.zeros((3, 1)))
    reached = np.abs(_response(a, b, c, d, 2000)).sum()
    assert reached <= gain <= reached * (1.0 + 1e-6)


def test_a_slow_filter_is_bounded_without_its_whole_response() -> None:
    a, one, none = np.array([[1.0 - 1e-7]]), np.ones((1, 1)), np.zeros((1, 1))
    [[gain]] = peak_gains(a, one, one, none, none)
    assert gain == pytest.approx(1e7, rel=1e-6) and gain >= 1e7 * (1.0 - 1e-9)


def test_what_a_start_leaves_behind_counts() -> None:
    """A state that begins at 5 u is 5 at most, then 5 * 0.5 + 1 and so on: never more."""
    one = np.ones((1, 1))
    [[gain]] = peak_gains(0.5 * one, one, one, 0.0 * one, 5.0 * one)
    assert gain == pytest.approx(5.0, rel=1e-6)


@pytest.mark.parametrize("pole", [1.0, 1.01, -1.0])
def test_what_does_not_fade_has_no_gain(pole: float) -> None:
    one = np.ones((1, 1))
    with pytest.raises((Unstable, np.linalg.LinAlgError)):
        peak_gains(pole * one, one, one, one, one)
