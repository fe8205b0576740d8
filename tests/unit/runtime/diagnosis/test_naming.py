"""What is no candidate, whatever the evidence says."""

from __future__ import annotations

import math

from bondgraph.runtime.diagnosis.hypotheses import Hypothesis
from bondgraph.runtime.diagnosis.isolation import Explained
from bondgraph.runtime.diagnosis.naming import candidates

_SEES = {"r1": ("R", "k"), "r2": ("f", "k")}


def _explained(fault: str, evidence: float, change: float = 0.1) -> Explained:
    hypothesis = Hypothesis(fault, "value", "", 1.0, True)
    return Explained(fault, evidence, 1.0, hypothesis, change, 0.01)


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
