"""Sizes that `detect --pairs` tells, tried in noise that was drawn: a sample of the campaign."""

from __future__ import annotations

from itertools import islice

from scipy.stats import binom

from tests.pairs.__main__ import KAPPA, MACHINES, pairs

_SEEDS, _PAIRS = 40, 14


def test_a_fault_of_the_size_that_is_told_is_not_taken_for_another() -> None:
    some = islice(pairs(MACHINES["redundant"], _SEEDS), _PAIRS)
    found = [p for p in some if p.share < 0.1]
    assert len(found) >= _PAIRS // 2
    # one standard deviation of a mean, and that of what 4 000 healthy runs tell of the noise
    assert all(abs(p.mean - KAPPA) < 4.5 * (1 / _SEEDS + 2 * (KAPPA / 80) ** 2) ** 0.5
               for p in found)  # fmt: skip
    runs, wrong = 2 * _SEEDS * len(found), sum(p.wrong for p in found)
    assert binom.sf(wrong, runs, 0.0093) > 1e-4 and binom.cdf(wrong, runs, 0.0093) > 1e-4
