"""What is no candidate, whatever the evidence says."""

from __future__ import annotations

import math

import pytest

import bondgraph
from bondgraph.ir.signature_matrix import DoubleFaults
from bondgraph.runtime.diagnosis.hypotheses import Hypothesis, hypotheses
from bondgraph.runtime.diagnosis.isolation import Explained, ExplainedPair
from bondgraph.runtime.diagnosis.naming import (
    OneOrTwo,
    candidate,
    candidates,
    fits,
    one_or_two,
    pairs_that_can,
    update,
)

_SEES = {"r1": ("R", "k"), "r2": ("f", "k")}


def _explained(fault: str, evidence: float, change: float = 0.1) -> Explained:
    hypothesis = Hypothesis(fault, "value", "", 1.0, True)
    return Explained(fault, evidence, hypothesis, change, 0.01, 0.5, 40)


def _left(fired: list[str], *found: Explained, level: float = 2.0) -> list[str]:
    known, levels = {"R": 1.0, "f": 1.0, "k": 1.0}, {**dict.fromkeys(fired, 2.0), fired[-1]: level}
    return [e.fault for e in candidates(found, known, _SEES, levels) if e.evidence > -math.inf]


def test_a_fault_has_to_be_seen_by_all_that_has_fired() -> None:
    found = [_explained("R", 90.0), _explained("f", 20.0), _explained("k", 10.0)]
    assert _left(["r1"], *found) == ["R", "k"]
    assert _left(["r2"], *found) == ["f", "k"]
    assert _left(["r1", "r2"], *found) == ["k"]


def test_what_is_above_a_threshold_by_no_more_than_noise_rules_nothing_out_that_fits() -> None:
    # noise of twice the variance makes of a threshold 1.414 times as much
    found = [_explained("R", 90.0), _explained("f", 20.0), _explained("k", 10.0)]
    assert _left(["r1", "r2"], *found, level=1.4) == ["R", "k"]
    assert _left(["r1", "r2"], *found, level=1.43) == ["k"]
    spoiled = [e._replace(left=30.0) for e in found]
    assert _left(["r1", "r2"], *spoiled, level=1.4) == ["k"]


def test_of_faults_that_see_not_all_none_leaves_what_is_loud() -> None:
    spoiled = [e._replace(left=30.0) for e in (_explained("f", 90.0), _explained("R", 20.0))]
    assert _left(["r1", "r2"], *spoiled, level=1.4) == ["R"]
    assert _left(["r1", "r2"], *spoiled, level=1.43) == ["f", "R"]


def test_where_no_single_fault_is_evidence_alone_decides() -> None:
    found = [_explained("R", 90.0), _explained("f", 20.0)]
    assert _left(["r1", "r2"], *found) == ["R", "f"]


def test_no_parameter_becomes_its_opposite() -> None:
    # the machine has 1 - change left of it
    assert _left(["r1"], _explained("R", 90.0, 1.5), _explained("k", 10.0, -1.5)) == ["k"]
    assert _left(["r1"], _explained("R", 90.0, 0.9), _explained("k", 10.0)) == ["R", "k"]


def test_a_leak_that_is_not_there_yet_does_not_feed() -> None:
    """The machine has -change of what is nominally zero; 0.01 is the deviation of that."""
    known, sees = {"leak": 0.0, "k": 1.0}, {"r1": ("leak", "k")}
    fired, signs = {"r1": 2.0}, {"leak": 1}

    def left(change: float) -> list[str]:
        found = candidates([_explained("leak", 90.0, change), _explained("k", 10.0)], known, sees,
                           fired, signs)  # fmt: skip
        return [e.fault for e in found if e.evidence > -math.inf]

    assert left(-0.5) == ["leak", "k"]
    assert left(0.029) == ["leak", "k"], "a leak of nothing, as far as that is known"
    assert left(0.031) == ["k"]
    pair, feeding = _pair("leak", "k", 0.6, -0.5, -0.2), _pair("leak", "k", 0.6, 0.5, -0.2)
    assert pairs_that_can([pair, feeding], known, sees, ["r1"], signs) == [pair]


def test_what_is_left_over_has_to_be_noise() -> None:
    # forty values of which neighbours share half: twenty times 0.5, or twice that at most
    # where noise has twice the variance; chi-square of 20 exceeds 45.3 once in a thousand (tables)
    most = 2.0 * 0.5 * 45.31 / 20.0
    one = _explained("R", 9.0)
    assert fits(one._replace(left=0.99 * most)) and not fits(one._replace(left=1.01 * most))
    assert not fits(one._replace(evidence=1.0)), "a healthy machine is about as probable"


def _pair(a: str, b: str, left: float, *changes: float) -> ExplainedPair:
    ways = [Hypothesis(name, "value", "Ohm", 1.0, True) for name in (a, b)]
    return ExplainedPair((ways[0], ways[1]), 50.0, (changes[0], changes[1]), left, 40)


def _doubles(*alike: tuple[tuple[int, ...], ...]) -> DoubleFaults:
    return DoubleFaults((("R",), ("f",), ("k",)), alike, "")


def test_two_at_once_have_to_cover_what_has_fired_and_keep_their_signs() -> None:
    known = {"R": 1.0, "f": 1.0, "k": 1.0}
    good = _pair("R", "f", 0.6, -0.5, -0.2)
    found = [good, _pair("f", "k", 0.6, 1.5, 0.1)]
    assert pairs_that_can(found, known, _SEES, ["r1", "r2"]) == [good]
    blind = {"r1": ("R", "k"), "r2": ("k",)}
    assert pairs_that_can([good], known, blind, ["r1", "r2"]) == []


def test_two_at_once_are_a_thousand_times_as_rare_as_one() -> None:
    pair, other = _pair("R", "f", 0.6, -0.5, -0.2), _pair("R", "k", 9.0, 0.1, 0.1)
    for evidence, left in ((pair.evidence - 6.8, []), (pair.evidence - 7.0, [pair])):
        alone = [_explained("k", evidence)._replace(left=9.0)]
        said = one_or_two(alone, [pair, other], False, lambda: _doubles((), (), ()))
        assert said == OneOrTwo(False, left)


def test_beside_one_that_fits_are_two_that_look_like_no_single_one() -> None:
    pair = _pair("R", "f", 0.6, -0.5, -0.2)
    told, mistaken = _doubles((), (), ()), _doubles((), (), ((0, 1),))
    # as probable as one in a thousand of two makes it: beyond that it is two, and from a fiftieth
    # of all on it may be
    for more, alone, perhaps in ((7.0, False, True), (6.8, True, True), (2.9, True, False)):
        single = [_explained("k", pair.evidence - more)]
        said = one_or_two(single, [pair], True, lambda: told)
        assert said == OneOrTwo(alone, () if alone else [pair], perhaps)
        assert one_or_two(single, [pair], True, lambda: mistaken) == OneOrTwo()
    nothing = DoubleFaults((("R",), ("f",), ("k",)), (), "no trajectory")
    assert one_or_two([_explained("k", 3.0)], [pair], True, lambda: nothing) == OneOrTwo()


def test_what_looks_like_two_at_once_is_told_by_rank() -> None:
    single = [_explained("R", 9.0)._replace(left=30.0)]
    pairs = [_pair("R", "f", 0.6, -0.5, -0.2)]
    groups = (("R", "U"), ("f",), ("k",), ("c",))
    doubles = DoubleFaults(groups, ((), (), ((0, 1),), ()), "")
    verdict = update(5.0, 4.0, {"r1": 2.0}, (), single, OneOrTwo(False, pairs), doubles)
    assert verdict.pairs[0].faults == ("R", "f") and verdict.pairs[0].sizes == (0.5, 0.2)
    assert "R with f (100 %, +0.5 Ohm and +0.2 Ohm)" in verdict.message
    assert verdict.message.endswith("any two of R or U, f and k could look like that")
    nearly = update(5.0, 4.0, {}, (), single, OneOrTwo(False, pairs, True), doubles).message
    assert nearly.startswith("no single fault explains this as well; two at once do since 4.000 s")
    alone = doubles._replace(alike=((), (), (), ()))
    assert "any two" not in update(5.0, 4.0, {}, (), single, OneOrTwo(False, pairs), alone).message
    every = DoubleFaults(groups[:3], (((1, 2),), ((0, 2),), ((0, 1),)), "")
    assert update(5.0, 4.0, {}, (), single, OneOrTwo(False, pairs), every).message.endswith(
        "any two faults could look like that"
    )


def test_a_class_says_whether_it_may_be_two_others() -> None:
    doubles = DoubleFaults((("R", "U"), ("f",), ("k",)), ((), (), ((0, 1),)), "")
    said = {
        fault: update(
            5.0, 4.0, {"r1": 2.0}, group, [_explained(fault, 90.0)], OneOrTwo(), doubles
        ).message
        for fault, group in (("k", ("k",)), ("U", ("R", "U")), ("x", ("x",)))
    }
    ends = {fault: text.endswith("; or two others at once") for fault, text in said.items()}
    assert ends == {"k": True, "U": False, "x": False}
    perhaps = update(5.0, 4.0, {}, ("x",), [_explained("x", 90.0)], OneOrTwo(perhaps=True), doubles)
    assert perhaps.message.endswith("; or two others at once")
    more = update(5.0, 4.0, {"r1": 2.0}, (), [_explained("k", 90.0)], OneOrTwo(False), doubles)
    assert more.message.startswith("no single fault explains this since 4.000 s: several at once")


def test_the_gain_of_a_thermometer_is_told_in_kelvin_and_of_a_current_in_percent() -> None:
    """What reads 300 K where there are 297 K is wrong by 3 K to whoever reads degrees Celsius."""
    text = """bg 1
    model Oven { input P : W; param G = 2 W/K; param C = 50 J/K
      Sf:P -> 0:wall; wall -> C:C; wall -> R:loss { f = G*e }; wall -> De:T }"""
    engine = bondgraph.compile(text=text).engine(native=False)
    known = {"T": None, "P": None}
    all_of = hypotheses(engine, known, {"T": "K", "P": "W"}, {"T": 300.0, "P": 20.0})
    gains = {h.fault: h for h in all_of if h.kind == "gain"}
    told = {
        fault: candidate(Explained(fault, 9.0, gains[fault], change, 0.001), 1.0)
        for fault, change in (("T", 0.01), ("P", -0.1))
    }
    true, read = 297.0, 300.0
    assert told["T"].unit == "K"
    assert told["T"].size == pytest.approx((read - true) / true * 300.0)
    assert (told["P"].size, told["P"].unit) == (pytest.approx(10.0), "%")
