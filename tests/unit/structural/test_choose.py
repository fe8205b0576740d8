"""Chosen residuals, diagnoses of several faults, and placed sensors, against brute force."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import combinations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from bondgraph.frontend.incidence import read_table
from bondgraph.structural.choose import choose, demands
from bondgraph.structural.hitting import diagnoses, minimal_hitting_sets
from bondgraph.structural.placement import Candidate, Placing, place
from bondgraph.structural.structural_isolability import isolability
from bondgraph.text.diagnostic import Report
from bondgraph.text.source import Source
from tests.unit.structural.structures import model_of, structures, subsets

# ------------------------------------------------------------------------------------ diagnoses

conflicts = st.lists(st.frozensets(st.sampled_from("abcdef"), max_size=4), max_size=6)


@settings(max_examples=150, deadline=None)
@given(conflicts, st.integers(1, 6))
def test_minimal_hitting_sets(wanted: list[frozenset[str]], at_most: int) -> None:
    letters = sorted({e for c in wanted for e in c})
    hitting = [set(s) for n in range(7) for s in combinations(letters, n)]
    hitting = [s for s in hitting if all(s & c for c in wanted)]
    minimal = [s for s in hitting if not any(t < s for t in hitting)]
    found = minimal_hitting_sets([sorted(c) for c in wanted])
    assert sorted(map(sorted, found)) == sorted(map(sorted, minimal))
    assert [len(s) for s in found] == sorted(len(s) for s in found)
    few = minimal_hitting_sets([sorted(c) for c in wanted], at_most)
    assert list(few) == [s for s in found if len(s) <= at_most]


def test_the_circuit_of_reiter() -> None:
    # The full adder of Reiter (1987): conflicts {X1, X2} and {X1, A2, O1}
    found = minimal_hitting_sets([("X1", "X2"), ("X1", "A2", "O1")])
    assert found == (("X1",), ("X2", "A2"), ("X2", "O1"))


def test_silent_residuals_clear_what_they_see() -> None:
    sees = {"r1": ["L", "R"], "r2": ["R", "J"], "r3": ["J", "f"]}
    assert diagnoses(sees, ["r1", "r3"]) == (
        ("L", "J"), ("L", "f"), ("R", "J"), ("R", "f"),
    )  # fmt: skip
    assert diagnoses(sees, ["r1", "r3"], silent=["r2"]) == (("L", "f"),)
    assert diagnoses(sees, ["r2"], silent=["r1", "r3"]) == ()
    assert diagnoses(sees, []) == ((),)
    assert diagnoses(sees, ["r1", "r3"], at_most=1) == ()
    with pytest.raises(KeyError):
        diagnoses(sees, ["r9"])


# --------------------------------------------------------------------------------------- choices

matrices = st.integers(1, 5).flatmap(
    lambda faults: st.lists(
        st.lists(st.booleans(), min_size=faults, max_size=faults), min_size=1, max_size=7
    )
)


def _told(rows: Sequence[Sequence[bool]]) -> set[tuple[int, int]]:
    """Faults seen (as pairs with themselves), and seen while the other is not."""
    faults = range(len(rows[0])) if rows else ()
    return {
        (i, j) for row in rows for i in faults for j in faults if row[i] and (i == j or not row[j])
    }


@settings(max_examples=100, deadline=None)
@given(matrices, st.data())
def test_the_cheapest_choice_tells_as_much(rows: list[list[bool]], data: st.DataObject) -> None:
    prices = data.draw(
        st.lists(st.integers(1, 4), min_size=len(rows), max_size=len(rows)), label="prices"
    )
    found = choose(np.array(rows, dtype=bool), prices)
    everything = _told(rows)
    enough = [
        sum(prices[k] for k in c)
        for c in subsets(range(len(rows)))
        if _told([rows[k] for k in c]) == everything
    ]
    assert _told([rows[k] for k in found.chosen]) == everything
    assert found.least
    assert sum(prices[k] for k in found.chosen) == min(enough)


@pytest.mark.parametrize(("most", "least"), [(12, True), (11, False)])
def test_a_choice_is_the_least_where_the_problem_is_small(
    most: int, least: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Three residuals and four demands: that each fault is seen, and each without the other."""
    monkeypatch.setattr("bondgraph.structural.choose._EXACT", most)
    assert choose(np.array([[1, 0], [0, 1], [1, 1]], dtype=bool)) == ((0, 1), least)


def test_without_a_proof_what_the_others_make_needless_is_dropped(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """The first sees most for its cost, and is not needed beside the two that must be there."""
    monkeypatch.setattr("bondgraph.structural.choose._EXACT", 0)
    sees = np.array([[1, 1, 1, 1, 0, 0], [1, 1, 0, 0, 1, 0], [0, 0, 1, 1, 0, 1]], dtype=bool)
    met = demands(sees)
    assert met.shape[0] == 3
    found = choose(sees)
    told = _told(sees.tolist())
    for row in found.chosen:  # each of them is needed
        rest = [sees[k].tolist() for k in found.chosen if k != row]
        assert _told(rest) != told
    assert _told([sees[k].tolist() for k in found.chosen]) == told and not found.least


def test_of_equal_residuals_the_cheapest_and_of_these_the_first_is_chosen() -> None:
    same = np.array([[1, 0], [1, 0], [0, 1], [0, 1]], dtype=bool)
    assert choose(same).chosen == (0, 2)
    assert choose(same, [2.0, 1.0, 1.0, 1.0]).chosen == (1, 2)
    assert choose(same, [2.0, 1.0, 3.0, 2.0]).chosen == (1, 3)
    assert choose(np.zeros((2, 3), dtype=bool)) == ((), True)


# --------------------------------------------------------------------------------------- sensors

# The small linear system of the toolbox's tests; f1 and f2 are in one equation.
LINEAR = """
equation,x:x1,x:x2,x:x3,x:x4,x:x5,x:d1,x:d2,x:d3,x:d4,x:d5,z:u,f:f1,f:f2,f:f3,f:f4
state_1, 1,   1,   ,    ,    1,   1
state_2, ,    1,   1,   1,   ,    ,    1
state_3, ,    ,    1,   ,    1,   ,    ,    1,   ,    ,    ,   1,   1
state_4, ,    ,    ,    1,   1,   ,    ,    ,    1,   ,    ,   ,    ,    1
state_5, ,    ,    ,    ,    1,   ,    ,    ,    ,    1,   1,  ,    ,    ,    1
der_1,   I,   ,    ,    ,    ,    D
der_2,   ,    I,   ,    ,    ,    ,    D
der_3,   ,    ,    I,   ,    ,    ,    ,    D
der_4,   ,    ,    ,    I,   ,    ,    ,    ,    D
der_5,   ,    ,    ,    ,    I,   ,    ,    ,    ,    D
"""


def _minimal(placing: Placing) -> list[tuple[int, ...]]:
    """Choices that reach what all candidates do, none of them with a needless sensor."""
    best = placing.isolability(range(len(placing.candidates)))
    enough = [set(c) for c in subsets(range(len(placing.candidates))) if placing.reaches(c, best)]
    return sorted(tuple(sorted(c)) for c in enough if not any(d < c for d in enough))


def test_published_placements() -> None:
    """The toolbox's own test of this example: 5 minimal choices, 9 if added sensors may fail."""
    model = read_table(Source("linear.csv", LINEAR), Report())
    assert model is not None
    places = [Candidate(f"x{i + 1}", i) for i in range(5)]
    expected = [(0, 2), (0, 3), (1, 2), (1, 3), (2, 3)]
    assert _minimal(Placing(model, places)) == expected
    found = place(Placing(model, places))
    assert found.sensors in expected and found.least and found.cost == 2
    # a sensor may be there twice; which of two alike is taken makes no difference
    twice = Placing(model, [p for p in places[:4] for _ in range(2)], faulty=True)
    assert len({tuple(sorted(k // 2 for k in c)) for c in _minimal(twice)}) == 9


def test_costs_decide() -> None:
    model = read_table(Source("linear.csv", LINEAR), Report())
    assert model is not None
    costs = [5.0, 1.0, 2.0, 1.5, 0.1]
    places = [Candidate(f"x{i + 1}", i, c) for i, c in enumerate(costs)]
    assert place(Placing(model, places)).sensors == (1, 3)
    with pytest.raises(ValueError):
        place(Placing(model, places, faulty=True))


@pytest.mark.parametrize(
    ("costs", "sensors"),
    [
        # of x1 to x4 any two but x1 with x2 are enough: x1, x3 and x5 are left out
        ([5.0, 1.0, 2.0, 1.5, 0.1], (1, 3)),
        # x4 is left out first; x1 and x2 alone would not do, so that x3 has to stay
        ([1.0, 2.0, 3.0, 4.0, 0.1], (0, 2)),
        ([1.0, 1.0, 1.0, 1.0, 1.0], (0, 2)),  # of equally dear ones the last
    ],
)
def test_without_a_proof_the_dearest_that_are_not_needed_are_left_out(
    costs: list[float], sensors: tuple[int, ...]
) -> None:
    model = read_table(Source("linear.csv", LINEAR), Report())
    assert model is not None
    placing = Placing(model, [Candidate(f"x{i + 1}", i, c) for i, c in enumerate(costs)])
    found = place(placing, rounds=0)
    assert (found.sensors, found.least) == (sensors, False)
    assert found.cost == sum(costs[k] for k in sensors)


@settings(max_examples=50, deadline=None)
@given(structures(5, 4), st.data())
def test_placing_is_adding_equations(rows: list[frozenset[int]], data: st.DataObject) -> None:
    faults = data.draw(
        st.lists(
            st.frozensets(st.integers(0, 2), max_size=2), min_size=len(rows), max_size=len(rows)
        )
    )
    unknowns = sorted(frozenset().union(*rows))
    model = model_of(rows, faults, 3)
    places = [Candidate(f"x{v}", v, data.draw(st.integers(1, 3))) for v in unknowns]
    placing = Placing(model, places)
    told = {}
    for chosen in subsets(range(len(places))):
        added = [frozenset({places[k].unknown}) for k in chosen]
        bigger = model_of([*rows, *added], [*faults, *[frozenset[int]()] * len(added)], 3)
        told[chosen] = isolability(bigger)
        assert placing.isolability(chosen) == told[chosen]
    best = told[tuple(range(len(places)))]
    cost = {c: sum(places[k].cost for k in c) for c in told}
    found = place(placing)
    assert told[found.sensors] == best and found.least
    assert found.cost == min(cost[c] for c in told if told[c] == best)
