"""Explanations by hand: of a fault that fits, and of two at once."""

from __future__ import annotations

from bondgraph.runtime.diagnosis.hypotheses import Hypothesis
from bondgraph.runtime.diagnosis.isolation import Explained, ExplainedPair

SEES = {"r1": ("R", "k"), "r2": ("f", "k")}


def explained(fault: str, evidence: float, change: float = 0.1) -> Explained:
    """Of forty values, with half of the noise left over."""
    hypothesis = Hypothesis(fault, "value", "", 1.0, True)
    return Explained(fault, evidence, hypothesis, change, 0.01, 0.5, 40)


def pair_of(a: str, b: str, left: float, *changes: float) -> ExplainedPair:
    """Two parameters that have changed, with so much left over."""
    ways = [Hypothesis(name, "value", "Ohm", 1.0, True) for name in (a, b)]
    return ExplainedPair((ways[0], ways[1]), 50.0, (changes[0], changes[1]), left, 40)
