"""Noise that residuals share: how it is learned, and what evidence makes of it."""

from __future__ import annotations

import math
from itertools import product

import numpy as np
import pytest
from scipy.linalg import cholesky, solve_triangular

import bondgraph
from bondgraph.runtime.diagnosis.history import History
from bondgraph.runtime.diagnosis.hypotheses import Hypothesis
from bondgraph.runtime.diagnosis.isolation import Rows, explain, probabilities
from bondgraph.runtime.diagnosis.rows import Average, Row
from bondgraph.runtime.diagnosis.shared_noise import Shared, SharedNoise
from bondgraph.runtime.diagnosis.tuning import Limit
from tests.unit.runtime.diagnosis.test_isolation import _course, _flat, _grows, _off

_SCALES = [1e-4 * 10.0 ** (k / 4.0) for k in range(33)]


def _learned(last: np.ndarray, means: np.ndarray, apart: float = 0.1) -> SharedNoise:
    """Of rows (n, residuals), with the averages of their samples, which are white."""
    count = last.shape[1]
    limits = np.array([Limit(1.0 + k, 1.0, 4.0, 9.0, unit=2.0 + k) for k in range(count)])
    none, known = np.zeros(count), np.ones(count, dtype=bool)
    found = SharedNoise(count, 0.1)
    for k, (value, mean) in enumerate(zip(last, means, strict=True)):
        average = Average(mean, known, none, none, none)
        found.add(
            Row(k * apart, none, None, value, known, none, none, none, 0.0, average),  # type: ignore[arg-type]
            limits,
        )
    return found


def _drawn(rows: int, seed: int = 1) -> tuple[np.ndarray, np.ndarray]:
    """Three residuals that wander far, of which two share noise: -0.8 in last samples, 0.6 in
    averages."""
    draw = np.random.default_rng(seed)
    own = draw.normal(size=(2, 3, rows))
    far = 50.0 * np.sin(np.arange(rows) / 300.0)
    last = [own[0, 0], -0.8 * own[0, 0] + 0.6 * own[0, 1], own[0, 2]]
    means = [own[1, 0], 0.6 * own[1, 0] + 0.8 * own[1, 1], own[1, 2]]
    return np.array(last).T + far[:, None], np.array(means).T + far[:, None]


def test_what_residuals_share_is_learned_of_their_noise_and_not_of_where_they_stand() -> None:
    last, sums = _learned(*_drawn(1000)).correlations()
    assert last[0, 1] == last[1, 0] == pytest.approx(-0.8, abs=0.08)
    assert sums[0, 1] == sums[1, 0] == pytest.approx(0.6, abs=0.12)
    for found in (last, sums):
        assert np.abs(found[2, :2]).max() < 0.1 and (np.diagonal(found) == 1.0).all()


def test_few_rows_tell_of_nothing_that_is_shared_and_more_of_less_than_they_show() -> None:
    few = _learned(*_drawn(6)).correlations()
    assert (few == np.eye(3)).all()
    shares = [-np.mean([_learned(*_drawn(rows, seed)).correlations()[0, 0, 1]
                        for seed in range(40)]) for rows in (12, 25, 50, 200)]  # fmt: skip
    assert shares == sorted(shares) and shares[0] < 0.5 and 0.65 < shares[-1] < 0.8


def test_rows_that_do_not_follow_each_other_are_not_compared() -> None:
    assert (_learned(*_drawn(400), apart=0.3).correlations() == np.eye(3)).all()


def test_noise_that_is_the_same_leaves_some_of_its_own() -> None:
    draw = np.random.default_rng(4).normal(size=(3000, 1))
    same = _learned(*[np.hstack([draw, draw, -draw])] * 2).correlations()
    least = np.linalg.eigvalsh(same)[:, 0]
    assert least == pytest.approx([0.01, 0.01]), "a tenth of the deviation"


def test_many_residuals_share_what_they_share_most_of() -> None:
    """A chain of 60 in which each shares noise with the next ones, every third pair less."""
    draw = np.random.default_rng(7)
    noise = draw.normal(size=(2000, 61))
    much = np.array([0.35 if k % 3 == 2 else 1.0 for k in range(60)])
    chain = noise[:, :-1] + much * noise[:, 1:]
    (last, _) = _learned(chain, chain).correlations()
    shared = np.abs(np.diagonal(last, 1)) > 0.0
    assert shared.sum() < 59 and np.linalg.eigvalsh(last)[0] > 0.0
    assert np.abs(np.diagonal(last, 1))[shared].min() > 0.2


def test_what_was_learned_is_there_after_a_restart() -> None:
    before = _learned(*_drawn(300))
    after = SharedNoise(3, 0.1)
    after.resume(before.state())
    assert after.correlations() == pytest.approx(before.correlations(), abs=2e-3)
    assert after.state()["pairs"] == before.state()["pairs"]
    for wrong in ({"rows": [1.0, 2.0], "pairs": [[0, 0, 3, 0.5]]},
                  {"rows": [1.0, 2.0], "pairs": [[0, -1, 1, 0.5]]},
                  {"rows": [1.0, 2.0], "pairs": [[0, 0, 1, 1.5]]}):  # fmt: skip
        with pytest.raises(ValueError, match="no such residuals"):
            after.resume(wrong)


def _density(value: np.ndarray, covariance: np.ndarray) -> float:
    """Of a normal distribution, its logarithm but for what does not depend on these."""
    root = cholesky(covariance, lower=True)  # faults are up to 1e4 deviations
    white = solve_triangular(root, value.ravel(), lower=True)
    return float(-0.5 * white @ white - np.log(np.diagonal(root)).sum())


def test_evidence_is_the_ratio_of_densities_with_the_noise_that_is_shared() -> None:
    """Four rows of three residuals, by sums and by last samples, each with an error of its own.

    Residuals are small, so that what the model is off by in proportion to them is nothing.
    """
    draw = np.random.default_rng(11)
    count, residuals = 4, 3
    value = 1e-4 * draw.normal(size=(count, residuals))
    noise = 1e-8 * draw.uniform(0.5, 2.0, size=(count, residuals))
    more = 1e-8 * draw.uniform(0.0, 1.0, size=(count, residuals))
    weight = 1.0 / (noise + more)
    weight[1, 2] = 0.0  # it has no value there
    value[1, 2] = 0.0
    sums = np.array([[True, False, True], [True, True, True], [False] * 3, [True, True, False]])
    kin = np.array([[[1.0, 0.9, 0.3], [0.9, 1.0, 0.2], [0.3, 0.2, 1.0]],
                    [[1.0, -0.7, 0.4], [-0.7, 1.0, 0.0], [0.4, 0.0, 1.0]]])  # fmt: skip
    slopes = 1e-4 * draw.normal(size=(count, 2, residuals))
    hypotheses = (Hypothesis("a", "value", "", 1.0, True), Hypothesis("b", "value", "", 1.0, True))
    rows = Rows(value, weight, np.zeros((count, 0, residuals)), slopes, sums,
                Shared(noise, sums, kin))  # fmt: skip
    found = {e.fault: e.evidence for e in explain(rows, hypotheses, History(np.empty(0)))}

    healthy = np.diag((noise + more).ravel())
    for t, i, j in product(range(count), range(residuals), range(residuals)):
        if i != j and sums[t, i] == sums[t, j]:
            own = math.sqrt(noise[t, i] * noise[t, j])
            healthy[t * residuals + i, t * residuals + j] = own * kin[int(sums[t, i]), i, j]
    known = np.flatnonzero(weight.ravel() > 0)
    healthy, seen = healthy[np.ix_(known, known)], value.ravel()[known]
    line = 0.95 ** np.abs(np.subtract.outer([0, 1], [0, 1]))
    ends = np.stack([1.0 - np.arange(1, 5) / 4.0, np.arange(1, 5) / 4.0], axis=1)
    courses = [ends @ line @ ends.T, np.ones((4, 4)), np.outer(np.arange(4), np.arange(4)) / 9.0]
    for j, fault in enumerate("ab"):
        one = slopes[:, j].ravel()
        densities = []
        for scale, course in product(_SCALES, courses):
            part = np.outer(one, one) * np.kron(course, np.ones((3, 3))) * scale**2
            densities.append(_density(seen, healthy + part[np.ix_(known, known)]))
        ratio = np.logaddexp.reduce(densities) - math.log(len(densities)) - _density(seen, healthy)
        assert found[fault] == pytest.approx(ratio, rel=1e-2, abs=1e-2)


def _odds(rows: Rows, known: np.ndarray) -> float:
    """The logarithm of the odds of two faults, by densities with all that is known of rows.

    Their noise is `known` (residuals, residuals) in each; what the model is off by has a memory.
    """
    count = len(rows.value)
    healthy = np.kron(np.eye(count), known) + _off(rows.value)
    line, kept = _course(count)
    grows = _grows(count)
    courses = [line @ kept @ line.T, np.ones((count, count)), np.outer(grows, grows)]
    told = []
    for one in _flat(rows.slopes).T:
        parts = [np.outer(one, one) * np.kron(course, np.ones((2, 2))) for course in courses]
        every = [_density(rows.value, healthy + part * scale**2)
                 for part, scale in product(parts, _SCALES)]  # fmt: skip
        told.append(np.logaddexp.reduce(every))
    return float(told[0] - told[1])


@pytest.mark.parametrize("correlation", [0.5, 0.985])
@pytest.mark.parametrize("size", [0.5, 5.0, 15.0])
def test_odds_are_near_those_of_densities_where_the_model_is_off_as_well(
    size: float, correlation: float
) -> None:
    """A fault of so many deviations: beside it 5 % are more, or much less, than noise is."""
    count, kin = 24, np.array([[1.0, correlation], [correlation, 1.0]])
    hypotheses = (Hypothesis("a", "value", "", 1.0, True), Hypothesis("b", "value", "", 1.0, True))
    told: dict[str, list[float]] = {"exact": [], "shared": [], "apart": []}
    for seed in range(8):
        draw = np.random.default_rng(seed)
        drive = 1.0 + 0.5 * np.sin(np.arange(count) / 3.0 + draw.uniform(0.0, 6.0))
        slopes = drive[:, None, None] * np.array([[1.0, 0.0], [1.0, 0.5]])
        clean = size * slopes[:, seed % 2]
        root = np.linalg.cholesky(_off(clean) + 1e-12 * np.eye(2 * count))
        value = clean + (root @ draw.normal(size=2 * count)).reshape(count, 2)
        value += draw.normal(size=(count, 2)) @ np.linalg.cholesky(kin).T
        ones, right = np.ones((count, 2)), 1.0 if seed % 2 == 0 else -1.0
        rows = Rows(value, ones, np.zeros((count, 0, 2)), slopes)
        shared = rows._replace(shared=Shared(ones, ones > 0, np.stack([kin, kin])))
        told["exact"].append(right * _odds(rows, kin))
        for name, own in (("shared", shared), ("apart", rows)):
            a, b = explain(own, hypotheses, History(np.empty(0)))
            told[name].append(right * (a.evidence - b.evidence))
    exact, near, apart = (float(np.mean(told[name])) for name in ("exact", "shared", "apart"))
    assert abs(near - exact) < 0.02 + 0.1 * exact
    assert abs(apart - exact) > 0.1 + 0.07 * exact, "noise counts, wherever the model is off"


def test_a_fault_in_what_two_residuals_do_not_share_is_told_by_it() -> None:
    """One fault moves a residual, the other both, by 0.5 deviations of noise that is nearly one.

    What moves one only is seen beside the noise that is left of it, and how sure a verdict is of
    the fault is how often that is right: without it a third of what is known is told.
    """
    count, kin = 30, np.array([[1.0, 0.95], [0.95, 1.0]])
    hypotheses = (Hypothesis("a", "value", "", 1.0, True), Hypothesis("b", "value", "", 1.0, True))
    slopes = np.zeros((count, 2, 2))
    slopes[:, 0, 0] = slopes[:, 1] = 1.0
    root, ones = np.linalg.cholesky(kin), np.ones((count, 2))
    told: dict[bool, list[float]] = {True: [], False: []}
    for seed in range(100):
        draw = np.random.default_rng(seed)
        value = draw.normal(size=(count, 2)) @ root.T + 0.5 * slopes[:, seed % 2]
        for shares in told:
            shared = Shared(ones, ones > 0, np.stack([kin, kin])) if shares else None
            rows = Rows(value, ones, np.zeros((count, 0, 2)), slopes, None, shared)
            found = probabilities(explain(rows, hypotheses, History(np.empty(0))))
            told[shares].append(found["ab"[seed % 2]])
    assert np.mean(told[True]) > 0.85 and np.mean(told[False]) < 0.75
    assert np.min(told[True]) > 0.5, "none is told wrongly"


_TEXT = """bg 1
model Node {
    input u : V
    param R[2] = 2 Ohm
    Se:u -> 0:node -> R:a = R[1]
    node -> De:y1
    node -> De:y2
    node -> 1:b -> R:c = R[2]
    b -> Df:i
}
"""


def _samples(draw: np.random.Generator, seconds: float) -> tuple[np.ndarray, np.ndarray]:
    """Times, and u, y1, y2 and i of a node whose command is as noisy as its sensors."""
    t = np.arange(round(100.0 * seconds)) / 100.0
    volts = 10.0 + np.sin(0.7 * t)
    samples = np.stack([volts, volts, volts, volts / 2.0], axis=1)
    return t, samples + 0.02 * draw.normal(size=samples.shape) * [1.0, 1.0, 1.0, 0.25]


def test_a_watch_learns_what_its_residuals_share_and_keeps_it() -> None:
    """Each residual is a reading beside the command: a third to a half of its variance is of that.

    What they share is asked of the residuals of an hour.
    """
    c = bondgraph.compile(text=_TEXT, rate=100.0, bandwidth=5.0)
    engine = c.engine()
    assert [k.path for k in engine.signals] == ["u", "y1", "y2", "i"]
    _, long = _samples(np.random.default_rng(6), 3600.0)
    expected = np.corrcoef(engine.run(long).value[200:].T)
    assert 0.45 < np.abs(expected).min() < np.abs(expected[0, 1:]).max() < 0.7
    engine.reset()
    t, samples = _samples(np.random.default_rng(5), 240.0)
    watch = c.diagnosis(engine)
    for k in range(0, len(t), 500):
        part = slice(k, k + 500)
        watch.update(t[part], engine.run(samples[part]), samples[part])
    state = watch.state()
    shown = {tuple(pair[:3]): pair[3] for pair in state["shared"]["pairs"]}
    assert set(shown) == {(form, *two) for form in (0, 1) for two in ((0, 1), (0, 2), (1, 2))}
    for (_, one, other), value in shown.items():
        assert value == pytest.approx(expected[one, other], abs=0.13)
    after = c.diagnosis(engine)
    after.resume(state)
    assert after.state()["shared"] == state["shared"]
    del state["shared"]  # as a journal of before 2026-11-29
    after.resume(state)
