"""A handful of the robots of the campaign, so that it cannot rot."""

from __future__ import annotations

import math
from functools import cache

import pytest

from bondgraph.runtime.diagnosis.calibration import Tuned
from bondgraph.runtime.simulation.scenario import Fault
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


def test_an_encoder_that_misses_counts_behind_a_dead_zone_has_its_true_size() -> None:
    # one count of 5 714: wherever the size is looked for from, the play of the gear hides a part;
    # the other encoder with as many counts too much moves the torsion between them as much
    lost = Fault("m[1].motor", "*=", 1.0 - 1.75e-4, ONSET, math.inf, 0.0, 0.0, 1.0, "encoder")
    said = campaign.watched(campaign.errands(4, ONSET + 12.0, lost), _tuned().tuning)
    last = [v for v in said if v.event == "update"][-1].candidates[0]
    expected = {"m[1].motor": -0.0175, "m[1].wheel": 0.0175}[last.fault]
    assert last.unit == "%" and last.size == pytest.approx(expected, rel=0.05)


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
