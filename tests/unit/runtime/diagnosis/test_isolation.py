"""Evidence against the plain density of all samples together, which needs no clever algebra."""

from __future__ import annotations

import math
from collections.abc import Sequence
from itertools import product

import mpmath
import numpy as np
import pytest
from mpmath import mpf
from scipy.stats import multivariate_normal

from bondgraph.runtime.diagnosis.healthy import as_it_is
from bondgraph.runtime.diagnosis.history import History
from bondgraph.runtime.diagnosis.hypotheses import Hypothesis, Stuck
from bondgraph.runtime.diagnosis.isolation import (
    Case,
    Evidence,
    Explained,
    Rows,
    explain,
    probabilities,
)
from bondgraph.runtime.diagnosis.naming import named, update
from bondgraph.runtime.diagnosis.rows import Row
from bondgraph.runtime.diagnosis.two_at_once import OneOrTwo, searched

_SCALES = [1e-4 * 10.0 ** (k / 4.0) for k in range(33)]
_CHUNK, _PARTS, _KEEP = 4, 15, 0.95


def _flat(slopes: np.ndarray) -> np.ndarray:
    """(rows, k, residuals) to (rows * residuals, k)."""
    return slopes.transpose(0, 2, 1).reshape(-1, slopes.shape[1])


def _density(value: np.ndarray, covariance: np.ndarray) -> float:
    return float(multivariate_normal.logpdf(value.ravel(), cov=covariance))


def _chunks(rows: int) -> tuple[int, list[int]]:
    """The length of a chunk and the number of that of each row; only the first one may be short."""
    length = max(_CHUNK, math.ceil(rows / _PARTS))
    chunks = math.ceil(rows / length)
    return length, [chunks - 1 - behind // length for behind in reversed(range(rows))]


def _course(rows: int) -> tuple[np.ndarray, np.ndarray]:
    """A change that moves: what rows have of the ends of chunks, and how these are correlated.

    By 0.95 from one to the next; between them it is a straight line.
    """
    length, chunk = _chunks(rows)
    ends = np.arange(chunk[-1] + 2)
    when = [ends[-1] - (rows - 1 - t) / length for t in range(rows)]  # in chunks
    line = np.stack([np.interp(when, ends, one) for one in np.eye(len(ends))], axis=1)
    return line, _KEEP ** np.abs(np.subtract.outer(ends, ends))


def _grows(rows: int) -> np.ndarray:
    """A change that grows from the first row, where the filter still shows none, to the last."""
    return np.arange(rows) / max(1, rows - 1)


def _off(value: np.ndarray) -> np.ndarray:
    """The covariance of what the model is off by, of (rows, residuals): 5 % of each value.

    Of the variance each octave of memories has the same share: 1, 2, 4, ... rows up to a chunk;
    those between a chunk and all rows half within chunks and half for ever; one that lasts longer.
    """
    rows, residuals = value.shape
    length, chunk = _chunks(rows)
    between = max(math.log2(rows) - math.log2(length), 0.0)
    octaves = [2.0**k for k in range(round(math.log2(length)) + 1)]
    found = np.zeros((rows, residuals, rows, residuals))
    for s, t, k in product(range(rows), range(rows), range(residuals)):
        kept = between / 2.0 + 1.0
        if chunk[s] == chunk[t]:
            kept += between / 2.0 + sum(math.exp(-abs(s - t) / memory) for memory in octaves)
        share = kept / (len(octaves) + between + 1.0)
        found[s, k, t, k] = 0.05**2 * value[s, k] * value[t, k] * share
    return found.reshape(rows * residuals, rows * residuals)


@pytest.mark.parametrize(("after", "residuals"), [(10, 2), (4, 1), (1, 1), (70, 2)])
def test_evidence_is_the_ratio_of_the_densities_of_everything_seen(
    after: int, residuals: int
) -> None:
    draw = np.random.default_rng(3)
    before, parameters = 6, 2
    spread = np.array([0.5, 2.0])
    hypotheses = (
        Hypothesis("a", "value", "", 0.7, True),
        Hypothesis("b", "offset", "", 1.3, False),
        Hypothesis("b", "gain", "", 0.4, False),
        Hypothesis("b", "drift", "", 2.0, False),
    )
    rest = draw.normal(size=(before + after, parameters, residuals))
    slopes = 0.01 * draw.normal(size=(after, len(hypotheses), residuals))
    value = draw.normal(size=(before + after, residuals)) * 2.0
    weight = draw.uniform(0.5, 2.0, size=(before + after, residuals))
    history = History(spread)
    for k in range(before):
        history.add(value[k], weight[k], rest[k], 1.0)
    rows = Rows(value[before:], weight[before:], rest[before:], slopes)
    singles = explain(rows, hypotheses, history)
    found = {e.fault: e for e in singles}
    (pair,) = searched(Evidence(rows, history), Case(hypotheses, slopes), singles)

    shared = _flat(rest)
    healthy = np.diag(1.0 / weight.ravel()) + shared @ np.diag(spread**2) @ shared.T
    behind = slice(before * residuals, None)
    healthy[behind, behind] += _off(value[before:])
    line, kept = _course(after)
    moving = line @ kept @ line.T
    grows = _grows(after)
    courses = [np.kron(course, np.ones((residuals, residuals)))
               for course in (moving, np.ones_like(moving), np.outer(grows, grows))]  # fmt: skip
    both = [hypotheses.index(h) for h in pair.hypotheses]
    assert sorted(h.fault for h in pair.hypotheses) == ["a", "b"]
    for fault, ways in (("a", [[0]]), ("b", [[1], [2], [3], [1, 3]]), ("both", [both])):
        one = _flat(slopes)
        densities = []
        for own, scale, same in product(ways, _SCALES, courses):
            moved = np.zeros_like(healthy)
            part = sum(
                np.outer(one[:, j], one[:, j]) * same * (scale * hypotheses[j].usual) ** 2
                for j in own
            )
            moved[behind, behind] = part
            densities.append(_density(value, healthy + moved))
        ratio = np.logaddexp.reduce(densities) - math.log(len(densities)) - _density(value, healthy)
        evidence = pair.evidence if fault == "both" else found[fault].evidence
        assert evidence == pytest.approx(ratio, rel=1e-9, abs=1e-9)


@pytest.mark.parametrize(("after", "residuals"), [(10, 2), (4, 1), (70, 2)])
def test_what_has_no_size_is_the_ratio_of_two_densities(after: int, residuals: int) -> None:
    """Of the machine as it was told to be, and as it is where a switch is stuck.

    The model is off by a share of what is left of each, so that these have spreads of their own.
    """
    draw = np.random.default_rng(4)
    before, parameters = 5, 2
    spread = np.array([0.5, 2.0])
    stuck = Hypothesis("on", "stuck", "", 1.0, True, Stuck("on", 1.0))
    rest, other_rest = draw.normal(size=(2, before + after, parameters, residuals))
    other_rest[:before] = rest[:before]
    value = draw.normal(size=(before + after, residuals)) * 2.0
    value[before:] += 30.0
    left = draw.normal(size=(after, residuals))
    weight = draw.uniform(0.5, 2.0, size=(before + after, residuals))
    history = History(spread)
    for k in range(before):
        history.add(value[k], weight[k], rest[k], 1.0)
    slopes = np.zeros((after, 1, residuals))
    told = Rows(value[before:], weight[before:], rest[before:], slopes)
    other = Rows(left, weight[before:], other_rest[before:], slopes)
    (found,) = explain(told, [stuck], history, {0: other})

    def density(seen: np.ndarray, moved: np.ndarray) -> float:
        shared = _flat(moved)
        covariance = np.diag(1.0 / weight.ravel()) + shared @ np.diag(spread**2) @ shared.T
        behind = slice(before * residuals, None)
        covariance[behind, behind] += _off(seen)
        return _density(np.concatenate([value[:before], seen]), covariance)

    ratio = density(left, other_rest) - density(value[before:], rest)
    assert ratio > 10.0
    assert found.evidence == pytest.approx(ratio, rel=1e-9)


def _equations(
    draw: np.random.Generator, spread: np.ndarray, count: int, residuals: int
) -> tuple[History, np.ndarray, np.ndarray]:
    """A history of random rows, and its normal equations: matrix and right side, no prior."""
    slopes = draw.normal(size=(count, len(spread), residuals))
    size = count, residuals
    value, weight = draw.normal(size=size), draw.uniform(0.5, 2.0, size=size)
    history = History(spread)
    for k in range(count):
        history.add(value[k], weight[k], slopes[k], 1.0)
    flat = slopes.transpose(0, 2, 1).reshape(-1, len(spread))
    return history, flat.T @ (flat * weight.reshape(-1, 1)), flat.T @ (weight * value).ravel()


def test_what_is_expected_of_this_machine_is_the_mean_of_what_its_parameters_may_be() -> None:
    draw = np.random.default_rng(5)
    spread = np.array([0.5, 2.0])
    history, matrix, right = _equations(draw, spread, 7, 3)
    known = np.linalg.inv(matrix + np.diag(spread**-2.0))
    best = known @ right
    now, bound, doubt = draw.normal(size=(2, 3)), np.array([4.0, 5.0, 6.0]), np.ones(3)
    here = np.array([1.0, -2.0, 3.0])
    row = Row(0.0, here, None, here, np.ones(3, dtype=bool), bound, doubt, now)
    found = history.innovation(row, np.array([True, True, False]))
    deviation = np.sqrt(np.einsum("hr,hg,gr->r", now, known, now))
    expected = here - now.T @ best
    assert found.value == pytest.approx([*expected[:2], 3.0], rel=1e-9)
    wide = 0.1 * (bound - 1.0) + 1.0 + 2.0 * deviation
    assert found.bound == pytest.approx([*wide[:2], 6.0], rel=1e-9)


def test_what_was_known_of_a_parameter_is_known_less_well_once_it_may_have_drifted() -> None:
    spread = np.array([0.5, 2.0, 1.5])
    history, matrix, right = _equations(np.random.default_rng(8), spread, 9, 2)
    # the estimate by these rows alone; two parameters then go by a tenth of what they may be off
    rows = np.linalg.inv(matrix)
    best = rows @ right
    later = np.linalg.inv(rows + np.diag([0.0, 0.2, 0.15]) ** 2)
    # and are within their tolerances, which are known as before
    known = np.linalg.inv(later + np.diag(spread**-2.0))
    drifted = history.drifted([1, 2])
    mean, variance = drifted.expected(np.eye(3))
    assert mean == pytest.approx(known @ later @ best, rel=1e-9)
    assert variance == pytest.approx(np.diag(known), rel=1e-9)
    assert drifted.prior.tolist() == spread.tolist()
    # of nothing more is known than before
    for other in (history.drifted([]), History(spread).drifted([1, 2])):
        expected = history if other.root.any() else History(spread)
        for a, b in zip(other.expected(np.eye(3)), expected.expected(np.eye(3)), strict=True):
            assert a == pytest.approx(b, rel=1e-9, abs=1e-12)


def test_a_fault_that_moves_nothing_that_is_off_explains_nothing() -> None:
    # An encoder at constant speed: whether it misses a share of its counts or so many a second is
    # the same, and would move the residual 10^8 times more than its noise, which is all there is.
    # Sums of squares lose the noise behind that: in most of these draws the fault then seemed to
    # explain many thousand times more than there was to be explained.
    scale = 0.3
    hypotheses = tuple(
        Hypothesis("encoder", kind, unit, scale, False)
        for kind, unit in (("offset", "count"), ("gain", ""), ("drift", "count/s"))
    )
    for seed in range(12):
        draw, count = np.random.default_rng(seed), 24 if seed else 6  # few for exact numbers
        slopes = (1.0 + 1e-8 * draw.normal(size=(count, 3, 1))) * [[2.0], [1e9], [1e9]]
        rest = 1.0 + 1e-3 * draw.normal(size=(count, 1, 1))
        value = draw.normal(size=(count, 1))
        rows = Rows(value, np.ones((count, 1)), rest, slopes)
        (found,) = explain(rows, hypotheses, History(np.ones(1)))
        assert found.evidence < 0.0 <= found.left <= float(np.mean(value**2))
        if seed == 0:
            ratio = _exact_ratio(_flat(rest), _flat(slopes) * scale, value[:, 0])
            assert found.evidence == pytest.approx(ratio, rel=1e-6)


def test_a_fault_that_does_what_a_parameter_does_keeps_its_digits() -> None:
    # A parameter that moves the residual a million times more than its noise, within its tolerance,
    # and a fault that is the same parameter since the onset: what is left of it is what the prior
    # and a slope that is hardly another one leave. Products of the columns would have four digits.
    draw = np.random.default_rng(4)
    rest = 1e6 * (1.0 + 0.3 * draw.normal(size=(24, 1, 1)))
    slopes = rest * (1.0 + 1e-6 * draw.normal(size=(24, 1, 1)))
    value = 0.4 * rest[:, 0] + draw.normal(size=(24, 1))
    rows = Rows(value, np.ones((24, 1)), rest, slopes)
    (found,) = explain(rows, (Hypothesis("a", "value", "", 0.3, True),), History(np.ones(1)))
    ratio = _exact_ratio(_flat(rest), _flat(slopes) * 0.3, value[:, 0], ways=([0],))
    assert found.evidence == pytest.approx(ratio, rel=1e-7)


def _exact_ratio(
    rest: np.ndarray,
    slopes: np.ndarray,
    value: np.ndarray,
    ways: Sequence[list[int]] = ([0], [1], [2], [0, 1, 2]),
) -> float:
    """The evidence of one fault with some ways to be wrong, with as many digits as it takes."""
    mpmath.mp.dps = 60
    many = np.vectorize(mpf, otypes=[object])
    noise = np.eye(len(value)) + _off(value[:, None])
    healthy = many(noise) + many(rest) @ many(rest).T
    line, kept = map(many, _course(len(value)))
    moving = line @ kept @ line.T
    grows = many(_grows(len(value)))
    courses = [moving, many(np.ones_like(moving)), np.outer(grows, grows)]
    ratios = []
    for own, scale, course in product(ways, _SCALES, courses):
        one = many(slopes[:, own]) * mpf(scale)
        ratios.append(_log_density(healthy + (one @ one.T) * course, value))
    total = mpmath.log(mpmath.fsum(map(mpmath.exp, ratios)) / len(ratios))
    return float(total - _log_density(healthy, value))


def _log_density(covariance: np.ndarray, value: np.ndarray) -> mpf:
    """Of a normal distribution, but for its constant."""
    root = mpmath.cholesky(mpmath.matrix(covariance.tolist()))
    seen = mpmath.lu_solve(root, mpmath.matrix(value.tolist()))
    size = mpmath.fsum(mpmath.log(root[k, k]) for k in range(root.rows))
    return -mpmath.fsum(x**2 for x in seen) / 2 - size


def test_what_is_no_number_is_refused_and_gives_no_evidence() -> None:
    one = (Hypothesis("a", "value", "", 1.0, True),)
    for where in ("value", "slopes", "rest"):
        for wrong in (math.nan, math.inf):
            parts = {"value": (8, 1), "weight": (8, 1), "rest": (8, 1, 1), "slopes": (8, 1, 1)}
            rows = Rows(**{name: np.ones(shape) for name, shape in parts.items()})
            getattr(rows, where)[3] = wrong
            with pytest.raises(np.linalg.LinAlgError, match="not finite"):
                explain(rows, one, History(np.ones(1)))


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
    assert best.left == pytest.approx(1.0, abs=0.35) and best.values == 80
    assert probabilities(found)["b"] > 0.999


def test_a_sensor_is_not_wrong_by_whatever_it_reads() -> None:
    """R i is missing of a voltage that is constant otherwise: the reading less an offset, that is.

    The resistance grows first and stays then; the sensor would need a gain that takes its reading
    away and 5 V in its place.
    """
    draw = np.random.default_rng(9)
    count, noise = 24, 0.002
    current = 0.02 + 0.005 * np.sin(np.arange(count))
    reading = 5.0 - np.minimum(10.0 * np.arange(count), 100.0) * current
    value = reading - 5.0 + noise * draw.normal(size=count)
    ways = (
        Hypothesis("R", "value", "Ohm", 0.25, True),
        Hypothesis("U", "offset", "V", 1.5, False),
        Hypothesis("U", "gain", "", 0.3, False),
        Hypothesis("U", "drift", "V/s", 0.75, False),
    )
    slopes = np.stack([-current, np.ones(count), reading, np.arange(1.0, count + 1)], axis=1)
    weight = np.full((count, 1), noise**-2.0)
    rows = Rows(value[:, None], weight, np.zeros((count, 0, 1)), slopes[:, :, None])
    assert probabilities(explain(rows, ways, History(np.zeros(0))))["R"] > 0.95


def test_of_ways_that_are_the_same_the_first_is_told() -> None:
    """An offset and a gain of a signal that is constant: roundings do not decide which it is."""
    draw = np.random.default_rng(6)
    ways = tuple(Hypothesis("y", kind, "", 1.0, False) for kind in ("offset", "gain"))
    for more in (-1e-14, 0.0, 1e-14):
        slopes = np.ones((40, 2, 1))
        slopes[:, 1] *= 1.0 + more
        value = 0.8 + draw.normal(size=(40, 1)) * 0.05
        rows = Rows(value, np.full((40, 1), 1 / 0.05**2), np.zeros((40, 0, 1)), slopes)
        [found] = explain(rows, ways, History(np.zeros(0)))
        assert found.hypothesis.kind == "offset" and found.change == pytest.approx(0.8, abs=0.1)


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


def test_what_lasts_in_the_error_of_a_model_makes_no_fault_certain_and_what_changes_does() -> None:
    # `a` does what is seen; `b` as well, but for 1 % that comes and goes once while it is watched,
    # or but for 20 % that change from row to row. There is next to no noise.
    rows = 600
    course = 1.0 + 0.3 * np.sin(np.arange(rows) / 3.0)
    slow = 0.01 * np.sin(2.0 * np.pi * np.arange(rows) / rows)
    quick = 0.2 * np.random.default_rng(2).choice([-1.0, 1.0], rows)
    hypotheses = tuple(Hypothesis(n, "value", "", 1.0, True) for n in "ab")

    def ahead(count: int, off: np.ndarray) -> float:
        slopes = np.stack([course, course * (1.0 + off)], axis=1)[:count, :, None]
        weight = np.full((count, 1), 1.0 / 0.02**2)
        seen = Rows(course[:count, None], weight, np.zeros((count, 0, 1)), slopes)
        one, other = explain(seen, hypotheses, History(np.zeros(0)))
        return one.evidence - other.evidence

    assert all(abs(ahead(count, slow)) < 3.0 for count in (20, 150, 600))
    assert ahead(20, quick) > 10.0 and ahead(600, quick) > 100.0


def test_the_parameters_of_a_machine_are_those_that_healthy_rows_tell_within_tolerances() -> None:
    # residuals move by a quarter of what the first parameter is off by, and tell nothing of others
    known = (
        Hypothesis("R", "value", "Ohm", 1.0, True),
        Hypothesis("L", "value", "H", 1.0, True),
        Hypothesis("w", "offset", "count", 1.0, False),
    )
    for off, wanted in ((0.3, 9.7), (2.0, 9.0)):  # R is 10 Ohm +- 10 %
        history = History(np.array([1.0, 0.5, 1.0]) / math.sqrt(3.0))
        for _ in range(50):
            history.add(np.array([off / 4]), np.array([1e6]), np.array([[0.25], [0.0], [0.0]]))
        found = as_it_is(known, {"R": 10.0, "L": 5.0}, history)
        assert found == pytest.approx({"R": wanted, "L": 5.0}, rel=1e-4)


def _least_in_box(root: np.ndarray, wanted: np.ndarray, most: float) -> np.ndarray:
    """The least of |root z - wanted| in a box, of all choices of what is held at which side."""
    found, least = np.zeros(len(wanted)), math.inf
    for sides in product((-1.0, 0.0, 1.0), repeat=len(wanted)):
        point = most * np.array(sides)
        free = point == 0.0
        point[free] = np.linalg.lstsq(root[:, free], wanted - root @ point)[0]
        misfit = float(np.linalg.norm(root @ point - wanted))
        if (np.abs(point) <= most * (1.0 + 1e-9)).all() and misfit < least:
            found, least = point, misfit
    return found


@pytest.mark.parametrize("seed", range(20))
def test_parameters_that_make_up_for_each_other_fit_best_within_their_tolerances(seed: int) -> None:
    # all slopes are nearly the same: what fits best is far out, and no corner of the box is near it
    draw = np.random.default_rng(seed)
    history = History(np.array([1.0, 2.0, 0.5]))
    signs = draw.choice([-1.0, 1.0], 3) / history.prior
    for _ in range(30):
        slopes = signs * (1.0 + 0.05 * draw.normal(size=3))
        history.add(10.0 * draw.normal(size=1), np.ones(1), slopes[:, None], 1.0)
    known = history.known()
    wanted = history.prior * _least_in_box(known[:, :-1], known[:, -1], math.sqrt(3.0))
    assert history.fit_within() == pytest.approx(wanted, rel=1e-6, abs=1e-6)
    names = [Hypothesis(n, "value", "", 1.0, True) for n in "abc"]
    machine = as_it_is(names, dict.fromkeys("abc", 7.0), history)
    assert list(machine.values()) == pytest.approx(7.0 - wanted, rel=1e-6)


def test_where_each_fault_is_impossible_none_is_probable() -> None:
    one = Hypothesis("a", "value", "", 1.0, True)
    found = [Explained(f, -math.inf, one._replace(fault=f), 0.0, 0.0) for f in "ab"]
    assert probabilities(found) == {"a": 0.0, "b": 0.0}
    verdict = update(1.0, 0.5, {"r1": 2.0}, (), found, OneOrTwo())
    assert verdict.candidates == () and verdict.message.startswith("no single fault")
    assert named(found, [("a",), ("b",)])[0] == ()
    sure = [found[0]._replace(evidence=30.0), found[1]]
    assert probabilities(sure) == pytest.approx({"a": 1.0, "b": 0.0})


@pytest.mark.parametrize(
    ("gone", "keep"), [([1, 3], [0, 2]), ([1, 3], [0, 1, 2]), ([], [2, 0, 1, 3])]
)
def test_what_is_known_of_parameters_outlasts_a_change_of_others(
    gone: list[int], keep: list[int]
) -> None:
    # against the covariance of everything, which needs no triangles
    draw = np.random.default_rng(7)
    spread, more = np.array([0.5, 3.0, 1.0, 0.2]), [0.7]
    slopes, value = draw.normal(size=(9, 4)), draw.normal(size=9)
    history = History(spread)
    for one, seen in zip(slopes, value, strict=True):
        history.add(np.array([seen]), np.array([4.0]), one[:, None], 1.0)
    found = np.linalg.inv(4.0 * slopes.T @ slopes + np.diag(spread**-2))
    mean = 4.0 * found @ slopes.T @ value
    assert history.expected(np.eye(4))[0] == pytest.approx(mean, rel=1e-9)
    last, covariance = history.last(2)
    assert last == pytest.approx(mean[2:], rel=1e-9)
    assert covariance == pytest.approx(found[2:, 2:], rel=1e-9)
    for k in gone:
        found[k], found[:, k], mean[k] = 0.0, 0.0, 0.0
        found[k, k] = spread[k] ** 2
    anew = history.anew(gone, keep, more)
    moved = draw.normal(size=(len(keep) + 1, 2))
    got, variance = anew.expected(moved)
    own = moved[:-1]
    assert got == pytest.approx(own.T @ mean[keep], rel=1e-9)
    wanted = np.diag(own.T @ found[np.ix_(keep, keep)] @ own) + (more[0] * moved[-1]) ** 2
    assert variance == pytest.approx(wanted, rel=1e-9)
