"""MSO sets, their realisations and isolability: published counts, and brute force on small ones."""

from __future__ import annotations

from itertools import combinations

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from bondgraph.ir.structural_model import StructuralModel
from bondgraph.structural.analyse import analyse
from bondgraph.structural.mso import mso_sets
from bondgraph.structural.realise import integral_residuals, realisations, realise
from bondgraph.structural.structural_isolability import isolability
from bondgraph.structural.witness import witness
from tests.unit.structural.structures import (
    is_mso,
    model_of,
    over,
    published,
    rank,
    structures,
    subsets,
)

# Counts published with the Fault Diagnosis Toolbox: use case (Frisk, Krysander, Jung, 2017) for
# the engine, the induction motor tutorial, and the toolbox's own tests for the other motor and
# the water tank. Equations, unknowns, MSO sets, of them with a low index.
COUNTS = {
    "vep4_engine": (94, 90, 4496, 206),
    "induction_motor": (15, 13, 9, 4),
    "electric_motor": (9, 7, 3, 3),
    "water_tank": (11, 7, 17, 15),
}


@pytest.mark.parametrize("name", COUNTS)
def test_published_counts(name: str) -> None:
    model = published(name)
    sets = mso_sets(model)
    low = [m for m in sets.all() if integral_residuals(model, m)]
    assert (len(model.equations), len(model.unknowns), sets.number, len(low)) == COUNTS[name]
    assert sets.complete
    assert len(set(sets.all())) == sets.number


def test_published_residual_generators_of_the_engine() -> None:
    model = published("vep4_engine")
    found = [integral_residuals(model, m) for m in mso_sets(model).all()]
    assert sum(map(len, found)) == 728
    assert len(isolability(model).groups) == len(model.faults) == 11
    assert sum(len(e.states) for e in model.equations) == 14


def test_published_sizes_of_the_electric_motor() -> None:
    assert [len(m) for m in mso_sets(published("electric_motor")).all()] == [4, 4, 6]


def test_three_tanks_by_brute_force() -> None:
    model = published("three_tank")
    rows = [frozenset(e.unknowns) for e in model.equations]
    # a set has one equation more than unknowns, so those of other sizes need no look
    sized = (
        c
        for c in subsets(range(len(rows)))
        if len(c) == len(frozenset().union(*(rows[e] for e in c))) + 1
    )
    assert sorted(c for c in sized if is_mso(rows, c)) == sorted(mso_sets(model).all())
    groups = [tuple(model.faults[f] for f in g) for g in isolability(model).groups]
    assert groups == [("fV1",), ("fV2", "fV3", "fT3"), ("fT1",), ("fT2",)]


@settings(max_examples=60, deadline=None)
@given(structures())
def test_all_sets_and_no_others(rows: list[frozenset[int]]) -> None:
    expected = sorted(c for c in subsets(range(len(rows))) if is_mso(rows, c))
    sets = mso_sets(model_of(rows))
    assert sorted(sets.all()) == expected
    assert sets.redundancy == len(rows) - rank(rows, range(len(rows)))


@settings(max_examples=30, deadline=None)
@given(structures(), st.integers(1, 6))
def test_a_limit_gives_true_sets(rows: list[frozenset[int]], limit: int) -> None:
    model = model_of(rows)
    everything, some = mso_sets(model), mso_sets(model, limit)
    assert some.number == min(limit, everything.number)
    assert set(some.all()) <= set(everything.all())
    assert some.complete or everything.number >= limit


faults_of = st.lists(st.frozensets(st.integers(0, 3), max_size=2), min_size=7, max_size=7)


@settings(max_examples=60, deadline=None)
@given(structures(), faults_of)
def test_isolability_is_that_of_an_unknown_fault_signal(
    rows: list[frozenset[int]], faults: list[frozenset[int]]
) -> None:
    own = faults[: len(rows)]
    found = isolability(model_of(rows, own, 4))
    everything = range(len(rows))
    holding = [{e for e in everything if f in own[e]} for f in range(4)]
    detected = over(rows, everything)
    for i in range(4):
        assert (i in found.undetectable) == (not holding[i] & detected)
        for j in range(4):
            hidden = [r | {99} if e in holding[j] else r for e, r in enumerate(rows)]
            apart = bool(holding[i] & over(hidden, everything))
            assert found.isolable(i, j) == (apart and i != j), (i, j)


@settings(max_examples=60, deadline=None)
@given(structures(), st.data())
def test_a_witness_sees_one_and_not_the_other(
    rows: list[frozenset[int]], data: st.DataObject
) -> None:
    inside = data.draw(st.sets(st.integers(0, len(rows) - 1)))
    outside = data.draw(st.sets(st.integers(0, len(rows) - 1)))
    found = witness(model_of(rows), inside, outside)
    able = [
        c
        for c in subsets(range(len(rows)))
        if set(c) & inside and not set(c) & outside and is_mso(rows, c)
    ]
    assert (found is None) == (not able)
    assert found is None or found in able


def _marked(model: StructuralModel, marks: dict[int, dict[int, str]]) -> StructuralModel:
    equations = [
        e._replace(marks=tuple(marks.get(i, {}).get(v, "") for v in e.unknowns))
        for i, e in enumerate(model.equations)
    ]
    return model._replace(equations=tuple(equations))


@settings(max_examples=80, deadline=None)
@given(structures(8, 6), st.sets(st.integers(0, 7), max_size=3))
def test_integral_residuals_leave_a_system_to_integrate(
    rows: list[frozenset[int]], dynamic: set[int]
) -> None:
    states = {e: min(r) for e, r in enumerate(rows) if e in dynamic and r}
    marks = {e: {v: "I" if v == s else "D" for v in rows[e]} for e, s in states.items()}
    model = _marked(model_of(rows), marks)
    for mso in mso_sets(model).all():
        own = {e: s for e, s in states.items() if e in mso}
        if len(set(own.values())) < len(own):
            continue  # one state of two constraints: one of them must be differentiated
        expected = []
        for residual in mso:
            integrated = {s for e, s in own.items() if e != residual}
            static = [e for e in mso if e != residual and e not in own]
            left = [r - integrated for r in rows]
            unknowns = frozenset().union(*(rows[e] for e in mso)) - integrated
            if len(static) == len(unknowns) == rank(left, static):
                expected.append(residual)
        assert list(integral_residuals(model, mso)) == expected
        ways = realisations(model, mso)
        integral = [w.residual for w in ways if w.causality in ("algebraic", "integral")]
        assert integral == expected


def test_a_tank_with_three_sensors_both_ways() -> None:
    # level h with h' = q, both measured: compare levels (integrate q) or flows (differentiate h)
    model = _marked(model_of([{0, 1}, {0}, {1}]), {0: {0: "I", 1: "D"}})
    assert realise(model, (0, 1, 2), 1).causality == "integral"
    assert realise(model, (0, 1, 2), 2).causality == "derivative"
    assert realise(model, (0, 1, 2), 0).causality == "integral"


def test_loops_are_told() -> None:
    square = [{0, 1}, {0, 1}, {0}]
    assert realise(model_of(square), (0, 1, 2), 2).loop == "algebraic"
    assert realise(model_of(square), (0, 1, 2), 0).loop == "none"
    with pytest.raises(ValueError):
        realise(model_of([{0}, {0}, {1}]), (0, 1, 2), 2)


def test_a_cut_search_still_chooses_for_all() -> None:
    model = published("vep4_engine")
    cut = analyse(model, limit=50)
    assert not cut.sets.complete
    assert cut.sets.number == 50
    seen = [set(c.faults) for c in cut.chosen]
    for i, j in combinations(range(len(model.faults)), 2):
        assert any(i in s and j not in s for s in seen)
        assert any(j in s and i not in s for s in seen)


def test_a_long_search_tells_how_far_it_is() -> None:
    """Nine equations in three unknowns: all sets of four, 126, and the whole of the search."""
    heard: list[tuple[float, int]] = []
    found = mso_sets(model_of([{0, 1, 2}] * 9), progress=lambda done, n: heard.append((done, n)))
    assert found.complete and len(found.members) == 126
    shares, counts = zip(*heard, strict=True)
    assert list(shares) == sorted(set(shares)) and shares[0] > 0.0
    assert shares[-1] == pytest.approx(1.0)
    assert list(counts) == sorted(counts) and counts[-1] == 126


def test_an_analysis_tells_how_far_it_is_half_of_it_by_its_search() -> None:
    """And by how many sets are wanted, where that is nearer; behind it every hundredth set."""
    model, heard = model_of([{0, 1, 2}] * 9), list[tuple[float, int]]()
    analyse(model, progress=lambda done, n: heard.append((done, n)))
    assert heard[-3:] == [(pytest.approx(0.5), 126), (0.5, 126), (0.5 + 100 / 126 / 2, 126)]
    assert heard == sorted(heard)
    cut = list[tuple[float, int]]()
    analyse(model, 40, progress=lambda done, n: cut.append((done, n)))
    assert cut[-1] == (0.5, 40) and len(cut) > 1
    assert all(share >= count / 40 / 2 for share, count in cut[:-1])
