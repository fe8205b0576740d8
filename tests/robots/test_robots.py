"""A handful of the robots of the campaign, so that it cannot rot."""

from __future__ import annotations

from functools import cache

import pytest

from bondgraph.runtime.diagnosis.calibration import Tuned
from tests.measured import measured
from tests.robots import campaign
from tests.robots.campaign import KINDS, ONSET, Seen
from tests.robots.run import PAGE, command, parsed, ran


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
    groups = {f: g for g in campaign.compiled().diagnosis_model.groups for f in g}
    assert found.alarms == 0
    assert found.delay is not None and found.delay < 1.0
    assert found.last == groups[KINDS[number].target]


def test_the_sample_on_the_page_is_what_is_measured_now() -> None:
    (sample,) = [m for m in measured(PAGE) if "--tuning 2 " in m.command]
    options = parsed([*sample.command.split()[3:], "--jobs", "1"])
    assert command(options.only, options) == sample.command
    assert ran(options.only, options) == sample.text


def test_a_command_says_all_that_matters_to_its_part() -> None:
    words = "--seeds 3 --minutes 1 --alarms 1.5 --start 7 --share 0.5".split()
    assert command("healthy", parsed(words)) == (
        "python -m tests.robots.run --only healthy --healthy 100 --minutes 1 --start 7 --alarms 1.5"
    )
    assert command("below", parsed(words)) == (
        "python -m tests.robots.run --only below --share 0.5 --seeds 3 --start 7 --alarms 1.5"
    )
