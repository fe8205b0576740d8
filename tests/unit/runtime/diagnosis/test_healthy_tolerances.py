"""Tolerances that are rounded up to two digits."""

from __future__ import annotations

import pytest

from bondgraph.runtime.diagnosis.healthy_tolerances import narrower


@pytest.mark.parametrize(
    ("tolerance", "rounded"),
    [(0.012, 0.012), (0.0121, 0.013), (0.1999, 0.2), (0.099, 0.099), (0.0991, 0.1), (3e-7, 3e-7),
     (1.01e-3, 1.1e-3), (0.05, 0.05)],
)  # fmt: skip
def test_a_tolerance_is_rounded_up_to_two_digits(tolerance: float, rounded: float) -> None:
    assert narrower(tolerance, 0.5) == rounded


@pytest.mark.parametrize(
    ("tolerance", "declared"), [(0.2, 0.2), (0.3, 0.2), (0.0, 0.2), (-0.1, 0.2), (1.0, 3.0)]
)
def test_what_is_no_narrower_than_declared_is_none(tolerance: float, declared: float) -> None:
    assert narrower(tolerance, declared) is None
