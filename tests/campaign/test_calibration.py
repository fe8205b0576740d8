"""What a campaign says of probabilities, of statements whose truth is drawn with a known one."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from bondgraph.runtime.monitoring.verdict import Candidate, Verdict
from tests.campaign.calibration import Stated, bins, draw, error, stated, table


def _drawn(boast: float) -> list[Stated]:
    """Statements of which a share is right that is `boast` less certain than they say."""
    random = np.random.default_rng(3)
    chance = random.uniform(0.0, 1.0, 20000)
    right = random.uniform(0.0, 1.0, 20000) < chance ** (1.0 + boast)
    return [Stated(*one) for one in zip(chance.tolist(), right.tolist(), strict=True)]


def test_the_error_of_honest_statements_is_small_and_of_boasts_is_their_boast() -> None:
    assert error(_drawn(0.0)) < 0.01
    # the mean of p - p^2 over all p is 1/6
    assert error(_drawn(1.0)) == pytest.approx(1.0 / 6.0, abs=0.01)
    assert sum(one.number for one in bins(_drawn(0.0))) == 20000


def test_what_a_verdict_says_of_classes() -> None:
    own = (Candidate("a", 1.0, "", 0.6), Candidate("b", 1.0, "", 0.3), Candidate("c", 1.0, "", 0.1))
    verdict = Verdict("update", 1.0, 0.5, {}, (), own)
    found = stated(verdict, [("a", "c"), ("b",), ("d",)], "c")
    assert [(round(one.probability, 3), one.right) for one in found] == [(0.7, True), (0.3, False)]


def test_the_table_counts_what_is_sure_and_wrong(tmp_path: Path) -> None:
    said = [Stated(0.95, True)] * 3 + [Stated(0.95, False), Stated(0.2, False)]
    assert "of 4 statements above 0.9, 1 were wrong" in table(said)[-1]
    draw(said, tmp_path / "picture.svg")
    assert "share that was right" in (tmp_path / "picture.svg").read_text()
