"""What is no candidate, whatever the evidence says."""

from __future__ import annotations

import math

from bondgraph.ir.signature_matrix import DoubleFaults
from bondgraph.runtime.diagnosis.hypotheses import Hypothesis
from bondgraph.runtime.diagnosis.isolation import Explained, ExplainedPair
from bondgraph.runtime.diagnosis.naming import candidates, fits, pairs_left, update

_SEES = {"r1": ("R", "k"), "r2": ("f", "k")}


def _explained(fault: str, evidence: float, change: float = 0.1) -> Explained:
    hypothesis = Hypothesis(fault, "value", "", 1.0, True)
    return Explained(fault, evidence, hypothesis, change, 0.01, 0.5, 40)


def _left(fired: list[str], *found: Explained) -> list[str]:
    known = {"R": 1.0, "f": 1.0, "k": 1.0}
    return [e.fault for e in candidates(found, known, _SEES, fired) if e.evidence > -math.inf]


def test_a_fault_has_to_be_seen_by_all_that_has_fired() -> None:
    found = [_explained("R", 90.0), _explained("f", 20.0), _explained("k", 10.0)]
    assert _left(["r1"], *found) == ["R", "k"]
    assert _left(["r2"], *found) == ["f", "k"]
    assert _left(["r1", "r2"], *found) == ["k"]


def test_where_no_single_fault_is_evidence_alone_decides() -> None:
    found = [_explained("R", 90.0), _explained("f", 20.0)]
    assert _left(["r1", "r2"], *found) == ["R", "f"]


def test_no_parameter_becomes_its_opposite() -> None:
    # the machine has 1 - change left of it
    assert _left(["r1"], _explained("R", 90.0, 1.5), _explained("k", 10.0, -1.5)) == ["k"]
    assert _left(["r1"], _explained("R", 90.0, 0.9), _explained("k", 10.0)) == ["R", "k"]


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


def test_two_at_once_have_to_cover_what_has_fired_and_keep_their_signs() -> None:
    known = {"R": 1.0, "f": 1.0, "k": 1.0}
    good = _pair("R", "f", 0.6, -0.5, -0.2)
    found = [good, _pair("R", "k", 9.0, 0.1, 0.1), _pair("f", "k", 0.6, 1.5, 0.1)]
    assert pairs_left(found, [], known, _SEES, ["r1", "r2"]) == [good]
    blind = {"r1": ("R", "k"), "r2": ("k",)}
    assert pairs_left([good], [], known, blind, ["r1", "r2"]) == []


def test_two_at_once_are_a_thousand_times_as_rare_as_one() -> None:
    known = {"R": 1.0, "f": 1.0, "k": 1.0}
    pair = _pair("R", "f", 0.6, -0.5, -0.2)
    for evidence, left in ((pair.evidence - 6.8, []), (pair.evidence - 7.0, [pair])):
        assert pairs_left([pair], [_explained("k", evidence)], known, _SEES, ["r1", "r2"]) == left


def test_what_looks_like_two_at_once_is_told_by_rank() -> None:
    single = [_explained("R", 9.0)._replace(left=30.0)]
    pairs = [_pair("R", "f", 0.6, -0.5, -0.2)]
    groups = (("R", "U"), ("f",), ("k",), ("c",))
    doubles = DoubleFaults(groups, ((), (), ((0, 1),), ()), "")
    verdict = update(5.0, 4.0, {"r1": 2.0}, (), single, pairs, doubles)
    assert verdict.pairs[0].faults == ("R", "f") and verdict.pairs[0].sizes == (0.5, 0.2)
    assert "R with f (100 %, +0.5 Ohm and +0.2 Ohm)" in verdict.message
    assert verdict.message.endswith("any two of R or U, f and k could look like that")
    alone = doubles._replace(alike=((), (), (), ()))
    assert "any two" not in update(5.0, 4.0, {}, (), single, pairs, alone).message
    every = DoubleFaults(groups[:3], (((1, 2),), ((0, 2),), ((0, 1),)), "")
    assert update(5.0, 4.0, {}, (), single, pairs, every).message.endswith(
        "any two faults could look like that"
    )


def test_a_class_says_whether_it_may_be_two_others() -> None:
    doubles = DoubleFaults((("R", "U"), ("f",), ("k",)), ((), (), ((0, 1),)), "")
    said = {
        fault: update(5.0, 4.0, {"r1": 2.0}, group, [_explained(fault, 90.0)], (), doubles).message
        for fault, group in (("k", ("k",)), ("U", ("R", "U")), ("x", ("x",)))
    }
    ends = {fault: text.endswith("; or two others at once") for fault, text in said.items()}
    assert ends == {"k": True, "U": False, "x": False}
    more = update(5.0, 4.0, {"r1": 2.0}, (), [_explained("k", 90.0)], (), doubles, False)
    assert more.message.startswith("no single fault explains this since 4.000 s: several at once")
