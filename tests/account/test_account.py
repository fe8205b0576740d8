"""A short replay: see `python -m tests.account` for the hour."""

from __future__ import annotations

import copy
from pathlib import Path

import pytest

from tests.account.disturbed import _DISTURBANCES
from tests.account.replay import Outcome, differences, replayed, tuned


@pytest.fixture(scope="module")
def found(tmp_path_factory: pytest.TempPathFactory) -> Outcome:
    folder = tmp_path_factory.mktemp("account")
    return replayed(folder, tuned(folder), 8, 5)


def test_the_account_is_what_was_done_to_the_samples(found: Outcome) -> None:
    assert found.wrong == []
    assert len(found.expected.causes) >= len(_DISTURBANCES) // 2


def test_whatever_is_wrong_with_an_account_is_seen(found: Outcome) -> None:
    for part in ("samples", "lines", "verdicts"):
        for name in found.said[-1]["account"][part]:
            other = copy.deepcopy(found.said)
            other[-1]["account"][part][name] += 1
            assert differences(other, found.expected), (part, name)
    for name, states in found.said[-1]["account"]["residuals"].items():
        for state in states:
            other = copy.deepcopy(found.said)
            other[-1]["account"]["residuals"][name][state] += 1
            assert differences(other, found.expected), (name, state)


def test_each_disturbance_is_told_within_a_block_and_nothing_floods(
    found: Outcome, tmp_path: Path
) -> None:
    events = [v["event"] for v in found.said]
    told = sum(events.count(e) for e in ("gap", "late", "invalid"))
    assert sum(found.expected.causes.values()) <= told <= 3 * 8
