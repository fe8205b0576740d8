"""What is no candidate, whatever the evidence says."""

from __future__ import annotations

import math

from bondgraph.runtime.diagnosis.isolation import Explained
from bondgraph.runtime.diagnosis.possible import candidates, fits
from tests.unit.runtime.diagnosis.explanations import SEES, explained


def _left(fired: list[str], *found: Explained, level: float = 2.0) -> list[str]:
    known, levels = {"R": 1.0, "f": 1.0, "k": 1.0}, {**dict.fromkeys(fired, 2.0), fired[-1]: level}
    return [e.fault for e in candidates(found, known, SEES, levels) if e.evidence > -math.inf]


def test_a_fault_has_to_be_seen_by_all_that_has_fired() -> None:
    found = [explained("R", 90.0), explained("f", 20.0), explained("k", 10.0)]
    assert _left(["r1"], *found) == ["R", "k"]
    assert _left(["r2"], *found) == ["f", "k"]
    assert _left(["r1", "r2"], *found) == ["k"]


def test_what_is_above_a_threshold_by_no_more_than_noise_rules_nothing_out_that_fits() -> None:
    # noise of twice the variance makes of a threshold 1.414 times as much
    found = [explained("R", 90.0), explained("f", 20.0), explained("k", 10.0)]
    assert _left(["r1", "r2"], *found, level=1.4) == ["R", "k"]
    assert _left(["r1", "r2"], *found, level=1.43) == ["k"]
    spoiled = [e._replace(left=30.0) for e in found]
    assert _left(["r1", "r2"], *spoiled, level=1.4) == ["k"]


def test_of_faults_that_see_not_all_none_leaves_what_is_loud() -> None:
    spoiled = [e._replace(left=30.0) for e in (explained("f", 90.0), explained("R", 20.0))]
    assert _left(["r1", "r2"], *spoiled, level=1.4) == ["R"]
    assert _left(["r1", "r2"], *spoiled, level=1.43) == ["f", "R"]


def test_where_no_single_fault_is_evidence_alone_decides() -> None:
    found = [explained("R", 90.0), explained("f", 20.0)]
    assert _left(["r1", "r2"], *found) == ["R", "f"]


def test_no_parameter_becomes_its_opposite() -> None:
    # the machine has 1 - change left of it
    assert _left(["r1"], explained("R", 90.0, 1.5), explained("k", 10.0, -1.5)) == ["k"]
    assert _left(["r1"], explained("R", 90.0, 0.9), explained("k", 10.0)) == ["R", "k"]


def test_a_leak_that_is_not_there_yet_does_not_feed() -> None:
    """The machine has -change of what is nominally zero; 0.01 is the deviation of that."""
    known, sees = {"leak": 0.0, "k": 1.0}, {"r1": ("leak", "k")}
    fired, signs = {"r1": 2.0}, {"leak": 1}

    def left(change: float) -> list[str]:
        found = candidates([explained("leak", 90.0, change), explained("k", 10.0)], known, sees,
                           fired, signs)  # fmt: skip
        return [e.fault for e in found if e.evidence > -math.inf]

    assert left(-0.5) == ["leak", "k"]
    assert left(0.029) == ["leak", "k"], "a leak of nothing, as far as that is known"
    assert left(0.031) == ["k"]


def test_what_is_left_over_has_to_be_noise() -> None:
    # forty values of which neighbours share half: twenty times 0.5, or twice that at most
    # where noise has twice the variance; chi-square of 20 exceeds 45.3 once in a thousand (tables)
    most = 2.0 * 0.5 * 45.31 / 20.0
    one = explained("R", 9.0)
    assert fits(one._replace(left=0.99 * most)) and not fits(one._replace(left=1.01 * most))
    assert not fits(one._replace(evidence=1.0)), "a healthy machine is about as probable"


def test_what_is_declared_zero_may_turn_round_whatever_it_is_now() -> None:
    """A load of -1.85 N in healthy logs becomes one of 38 N: no number that turned round, but a
    leak of 0.1 becomes none of -5, with which its R would deliver power."""
    load = explained("R", 90.0)._replace(change=-40.0, deviation=1.0)
    known, seen = {"R": -1.85}, {"r1": 2.0}
    (sided,) = candidates([load], known, SEES, seen)
    (either,) = candidates([load], known, SEES, seen, {"R": 0})
    assert sided.evidence == -math.inf and either == load
    leak = load._replace(change=5.1)
    (delivers,) = candidates([leak], {"R": 0.1}, SEES, seen, {"R": 1})
    assert delivers.evidence == -math.inf
