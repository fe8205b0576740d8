"""The causal path of a relation: what follows from what, and where it leaves the strokes."""

from __future__ import annotations

from bondgraph.passes.relation.path import PathStep, path
from tests.unit.passes.circuits import MOTOR, RC, compiled


def _path(text: str, name: str) -> list[PathStep]:
    c = compiled(text)
    (own,) = [r for r in c.residuals.residual_set.residuals if r.name == name]
    return path(own, c.equations, c.derivative)


def test_each_step_says_what_it_computes_by_what_and_where_that_stands() -> None:
    found = {(s.variable, s.value, s.why, s.origin.line) for s in _path(RC, "r2")}
    assert found == {
        ("n.e", "y", "measured by y", 5),
        ("s.f", "i", "measured by i", 4),
        ("C.q", "3*n.e", "law of C", 5),
        ("C.f", "D(C.q)", "state of C, differentiated", 5),
    }


def test_a_step_is_behind_all_that_it_rests_on() -> None:
    for text, name in ((RC, "r1"), (RC, "r2"), (MOTOR, "r1")):
        known: set[str] = set()
        steps = _path(text, name)
        own = {s.variable for s in steps}
        for s in steps:
            rests = {v for v in own if v in s.value.replace("(", " ").replace(")", " ").split("*")
                     or f" {v} " in f" {s.value} "}  # fmt: skip
            assert rests <= known, (s.variable, s.value)
            known.add(s.variable)


def test_the_way_back_through_a_gyrator_runs_against_the_strokes() -> None:
    """There the inductance gives the effort and the resistance the flow of the coil; from the
    speed back it is the gyrator that gives the flow and the resistance that gets an effort."""
    steps = _path(MOTOR, "r1")
    assert {s.variable for s in steps if s.leaves} == {"k.e2", "el.f", "R.e"}
    assert {s.variable: s.why for s in steps if s.leaves} == {
        "k.e2": "balance of junction rotor", "el.f": "law of k", "R.e": "law of R",
    }  # fmt: skip
    for text, name in ((RC, "r1"), (RC, "r2")):  # here all goes along the strokes
        assert not any(s.leaves for s in _path(text, name))
