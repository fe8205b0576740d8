"""What is told of evidence: pairs, classes, sizes in units that can be read."""

from __future__ import annotations

import numpy as np
import pytest

import bondgraph
from bondgraph.ir.signature_matrix import DoubleFaults
from bondgraph.runtime.diagnosis.hypotheses import Hypothesis, hypotheses
from bondgraph.runtime.diagnosis.isolation import Explained
from bondgraph.runtime.diagnosis.naming import candidate, update
from bondgraph.runtime.diagnosis.two_at_once import OneOrTwo
from tests.unit.runtime.diagnosis.explanations import explained, pair_of


def test_what_looks_like_two_at_once_is_told_by_rank() -> None:
    single = [explained("R", 9.0)._replace(left=30.0)]
    pairs = [pair_of("R", "f", 0.6, -0.5, -0.2)]
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


@pytest.mark.parametrize("ahead", [0.0, 3.0, 5.0, 2000.0])
def test_pairs_are_told_with_their_share_of_the_probability(ahead: float) -> None:
    """As e to the evidence; those below a fiftieth are not told."""
    one, other = pair_of("R", "f", 0.6, -0.5, -0.2), pair_of("R", "k", 0.6, 0.3, 0.1)
    pairs = [one._replace(whole=ahead + 40.0), other._replace(whole=40.0)]
    single = [explained("R", 9.0)._replace(left=30.0)]
    verdict = update(5.0, 4.0, {"r1": 2.0}, (), single, OneOrTwo(False, pairs))
    less = np.exp(-ahead) / (1.0 + np.exp(-ahead))
    assert [pair.faults[1] for pair in verdict.pairs] == (["f", "k"] if less > 0.02 else ["f"])
    for pair, chance in zip(verdict.pairs, (1.0 - less, less), strict=False):
        assert pair.probability == pytest.approx(chance, abs=1e-4)
    assert verdict.pairs[0].sizes == (0.5, 0.2)


def test_a_class_says_whether_it_may_be_two_others() -> None:
    doubles = DoubleFaults((("R", "U"), ("f",), ("k",)), ((), (), ((0, 1),)), "")
    said = {
        fault: update(
            5.0, 4.0, {"r1": 2.0}, group, [explained(fault, 90.0)], OneOrTwo(), doubles
        ).message
        for fault, group in (("k", ("k",)), ("U", ("R", "U")), ("x", ("x",)))
    }
    ends = {fault: text.endswith("; or two others at once") for fault, text in said.items()}
    assert ends == {"k": True, "U": False, "x": False}
    perhaps = update(5.0, 4.0, {}, ("x",), [explained("x", 90.0)], OneOrTwo(perhaps=True), doubles)
    assert perhaps.message.endswith("; or two others at once")
    more = update(5.0, 4.0, {"r1": 2.0}, (), [explained("k", 90.0)], OneOrTwo(False), doubles)
    assert more.message.startswith("no single fault explains this since 4.000 s: several at once")


@pytest.mark.parametrize(
    ("change", "deviation", "size"),
    [
        (0.5, 0.1, 100.0),  # twice what is there: five deviations from nothing that would be right
        (0.95, 0.02, None),  # twenty times, or minus a hundred times, or anything
        (1.05, 0.02, None),
        (0.95, 0.01, 1900.0),
        (1.5, 0.1, -300.0),  # wired the wrong way round
    ],
)
def test_how_many_times_too_large_a_reading_is_is_told_where_something_of_it_is_right(
    change: float, deviation: float, size: float | None
) -> None:
    """What is there is 1 - change of what is told."""
    sensor = Hypothesis("a", "gain", "", 0.3, turned=False)
    found = candidate(Explained("a", 9.0, sensor, change, deviation), 1.0)
    assert found.unit == "%"
    assert found.size == (None if size is None else pytest.approx(size))
    supply = Hypothesis("U", "gain", "", 0.3, turned=True)  # an input: the machine's own share
    assert candidate(Explained("U", 9.0, supply, change, deviation), 1.0).size is not None


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


_THRICE = """bg 1
model Thrice {
    param R = 2 Ohm +- 2%
    param Q = 3 Ohm +- 2%
    Se:U -> 1:a
    a -> R:r = R
    a -> R:q = Q
    a -> Df:i
    sensor j : A = a.f
    sensor v : V = q.e
}
"""


@pytest.mark.parametrize("seed", [1, 2])
def test_a_share_that_looked_like_an_offset_is_told_once_the_reading_is_elsewhere(
    seed: int,
) -> None:
    """A meter that shows 28 % too little of -10.7 A, and then of 24.8 A: there it is no +3 A."""
    made = bondgraph.compile(text=_THRICE, rate=50.0, bandwidth=5.0)
    draw, t = np.random.default_rng(seed), np.arange(6000) / 50.0
    current = np.where(t < 70.0, -10.7, 24.8) + 0.03 * np.sin(0.7 * t)
    noise = draw.standard_normal((3, len(t)))
    columns = {
        "U": 5.0 * current,
        "i": current * np.where(t > 60.0, 0.72, 1.0) + 0.05 * noise[0],
        "j": current + 0.05 * noise[1],
        "v": 3.0 * current + 0.1 * noise[2],
    }
    engine = made.engine()
    samples = np.column_stack([columns[k.path] for k in engine.signals])
    watch = made.diagnosis(engine)
    said = [one for k in range(0, len(t), 500)
            for one in watch.update(t[k : k + 500], engine.run(samples[k : k + 500]),
                                    samples[k : k + 500])]  # fmt: skip
    first, second = (v.candidates[0] for v in said if v.event == "update")
    assert (first.fault, first.unit) == ("i", "A") and first.size == pytest.approx(3.0, abs=0.1)
    assert (second.fault, second.unit) == ("i", "%")
    assert second.size == pytest.approx(-28.0, abs=0.5)


def test_what_could_look_like_two_is_told_of_the_best_pair() -> None:
    """R with f looks like k with w; k and w, which come second, look like nothing else."""
    found = [explained("R", 1.0)._replace(left=9.0)]
    best, second = pair_of("R", "f", 0.6, -0.5, -0.2), pair_of("k", "w", 0.6, 0.1, 0.1)
    groups = (("R",), ("f",), ("k",), ("w",))
    alike = DoubleFaults(groups, ((), (), ((0, 1),), ()), "")
    said = "any two of R, f and k could look like that"
    for pairs, told in (([best, second], True), ([second, best], False)):
        ranked = [pair._replace(whole=10.0 - k) for k, pair in enumerate(pairs)]
        verdict = update(2.0, 1.0, {}, (), found, OneOrTwo(False, ranked), alike)
        assert (said in verdict.message) is told
        assert ("could look like that" in verdict.message) is told
