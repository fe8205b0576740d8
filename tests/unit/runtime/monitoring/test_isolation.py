"""Evidence against the plain density of all samples together, which needs no clever algebra."""

from __future__ import annotations

import math
from itertools import product

import numpy as np
import pytest
from scipy.stats import multivariate_normal

from bondgraph.runtime.monitoring.hypotheses import Hypothesis
from bondgraph.runtime.monitoring.isolation import (
    Explained,
    History,
    Rows,
    explain,
    probabilities,
)
from bondgraph.runtime.monitoring.naming import named, update

_SCALES = (0.1, 1.0, 10.0, 100.0)
_CHUNK, _KEEP = 4, 0.95


def _flat(slopes: np.ndarray) -> np.ndarray:
    """(rows, k, residuals) to (rows * residuals, k)."""
    return slopes.transpose(0, 2, 1).reshape(-1, slopes.shape[1])


def _density(value: np.ndarray, covariance: np.ndarray) -> float:
    return float(multivariate_normal.logpdf(value.ravel(), cov=covariance))


def test_evidence_is_the_ratio_of_the_densities_of_everything_seen() -> None:
    draw = np.random.default_rng(3)
    before, after, residuals, parameters = 6, 10, 2, 2
    spread = np.array([0.5, 2.0])
    hypotheses = (
        Hypothesis("a", "value", "", 0.7, True),
        Hypothesis("b", "offset", "", 1.3, False),
        Hypothesis("b", "gain", "", 0.4, False),
    )
    rest = draw.normal(size=(before + after, parameters, residuals))
    slopes = draw.normal(size=(after, len(hypotheses), residuals))
    value = draw.normal(size=(before + after, residuals)) * 2.0
    weight = draw.uniform(0.5, 2.0, size=(before + after, residuals))
    history = History(spread)
    for k in range(before):
        history.add(value[k], weight[k], rest[k], 1.0)
    rows = Rows(value[before:], weight[before:], rest[before:], slopes)
    found = {e.fault: e for e in explain(rows, hypotheses, history)}

    shared = _flat(rest)
    healthy = np.diag(1.0 / weight.ravel()) + shared @ np.diag(spread**2) @ shared.T
    steps = np.arange(after) // _CHUNK
    kept = _KEEP ** np.abs(np.subtract.outer(steps, steps))
    same = np.kron(kept, np.ones((residuals, residuals)))
    for fault, ways in (("a", [[0]]), ("b", [[1], [2], [1, 2]])):
        one = _flat(slopes)
        densities = []
        for own, scale in product(ways, _SCALES):
            moved = np.zeros_like(healthy)
            part = sum(
                np.outer(one[:, j], one[:, j]) * same * (scale * hypotheses[j].usual) ** 2
                for j in own
            )
            moved[before * residuals :, before * residuals :] = part
            densities.append(_density(value, healthy + moved))
        ratio = np.logaddexp.reduce(densities) - math.log(len(densities)) - _density(value, healthy)
        assert found[fault].evidence == pytest.approx(ratio, rel=1e-9, abs=1e-9)


def test_what_was_there_is_found_with_its_size() -> None:
    draw = np.random.default_rng(5)
    hypotheses = tuple(Hypothesis(n, "value", "", 1.0, True) for n in "abc")
    slopes = draw.normal(size=(40, 3, 2))
    value = slopes[:, 1] * 0.8 + draw.normal(size=(40, 2)) * 0.05
    nothing = np.zeros((40, 0, 2))
    rows = Rows(value, np.full((40, 2), 1 / 0.05**2), nothing, slopes)
    found = explain(rows, hypotheses, History(np.zeros(0)))
    best = max(found, key=lambda e: e.evidence)
    assert best.fault == "b" and best.change == pytest.approx(0.8, abs=0.1)
    assert best.share > 0.95
    assert probabilities(found)["b"] > 0.999


def test_a_silent_residual_speaks_against_a_fault_by_what_it_should_have_shown() -> None:
    # both faults move r1 alike; `b` should move r2 too: a lot, or too little to be seen
    for size, certain in ((1.0, True), (1e-4, False)):
        slopes = np.zeros((20, 2, 2))
        slopes[:, 0, 0] = slopes[:, 1, 0] = 1.0
        slopes[:, 1, 1] = size
        value = np.zeros((20, 2))
        value[:, 0] = 0.5
        rows = Rows(value, np.full((20, 2), 1e4), np.zeros((20, 0, 2)), slopes)
        hypotheses = tuple(Hypothesis(n, "value", "", 1.0, True) for n in "ab")
        chance = probabilities(explain(rows, hypotheses, History(np.zeros(0))))
        assert (chance["a"] > 0.99) is certain
        assert certain or chance["a"] == pytest.approx(0.5, abs=0.01)


def test_where_each_fault_is_impossible_none_is_probable() -> None:
    one = Hypothesis("a", "value", "", 1.0, True)
    found = [Explained(f, -math.inf, 0.0, one._replace(fault=f), 0.0, 0.0) for f in "ab"]
    assert probabilities(found) == {"a": 0.0, "b": 0.0}
    verdict = update(1.0, 0.5, {"r1": 2.0}, (), found)
    assert verdict.candidates == () and verdict.message.startswith("no single fault")
    assert named(found, [("a",), ("b",)])[0] == ()
    sure = [found[0]._replace(evidence=30.0, share=0.9), found[1]]
    assert probabilities(sure) == pytest.approx({"a": 1.0, "b": 0.0})
