"""A handful of the robots of the campaign, so that it cannot rot."""

from __future__ import annotations

from functools import cache

import pytest

from bondgraph.runtime.diagnosis.tune import Tuned
from tests.robots import campaign
from tests.robots.campaign import KINDS, ONSET, Seen


@cache
def _tuned() -> Tuned:
    return campaign.tuned(range(900_000, 900_002), 12.0, 2.0)


def _seen(seed: int, number: int | None, factor: float = 3.0) -> Seen:
    faults = ()
    if number is not None:
        kind = KINDS[number]
        sizes = {(s.hypothesis.fault, s.hypothesis.kind): s.size for s in _tuned().shown}
        size = sizes[kind.target, kind.hypothesis]
        assert size is not None
        faults = (campaign.fault(kind, factor * size),)
    said = campaign.watched(campaign.errands(seed, ONSET + 4.0, *faults), _tuned().tuning)
    return campaign.seen(said, None if number is None else ONSET)


def test_a_healthy_robot_is_left_alone() -> None:
    assert _seen(1, None) == Seen(0, None, None, (), (), "")


@pytest.mark.parametrize("number", [0, 6], ids=lambda k: KINDS[k].name)
def test_a_fault_of_three_times_the_smallest_size_is_found_and_named(number: int) -> None:
    found = _seen(10_001, number)
    groups = {f: g for g in campaign.compiled().facts.groups for f in g}
    assert found.alarms == 0
    assert found.delay is not None and found.delay < 1.0
    assert found.last == groups[KINDS[number].target]
