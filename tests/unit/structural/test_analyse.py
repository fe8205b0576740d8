"""What sets of equations tell apart, with all of them and with few, for a system from print."""

from __future__ import annotations

import numpy as np
import pytest

from bondgraph.frontend.incidence import read_table
from bondgraph.structural.analyse import _by_signature, _missing, _signatures, analyse
from bondgraph.structural.structural_isolability import isolability
from bondgraph.text.diagnostic import Report
from bondgraph.text.source import Source

# three equations too many in x1 to x3, of which f1 and f2 are in the same one
_TABLE = """
equation,x:x1,x:x2,x:x3,z:u,z:y1,z:y2,z:y3,f:f1,f:f2,f:f3,f:f4
one,     1,   1,   ,    1,  ,    ,    ,    1,   1
two,     ,    1,   1,   ,   ,    ,    ,    ,    ,    1
three,   1,   ,    ,    ,   1,   ,    ,    ,    ,    ,    1
four,    ,    1,   ,    ,   ,    1
five,    ,    ,    1,   ,   ,    ,    1
six,     1,   ,    ,    ,   1
"""


def test_faults_of_equal_columns_are_one_group_and_those_in_no_set_are_not_seen() -> None:
    table = np.array([[1, 1, 0, 0, 1], [0, 0, 0, 1, 1]], dtype=bool)
    found = _by_signature(table)
    assert found.groups == ((0, 1), (3,), (4,))
    assert found[1] == (2,)  # no set holds it
    assert _by_signature(np.zeros((0, 2), dtype=bool))[1] == (0, 1)


@pytest.mark.parametrize("limit", [None, 1])
def test_few_sets_tell_as_much_as_all(limit: int | None) -> None:
    model = read_table(Source("table.csv", _TABLE), Report())
    assert model is not None
    shares: list[float] = []
    found = analyse(model, limit, lambda done, count: shares.append(done))
    best = isolability(model)
    assert found.best == best and found.sets.complete is (limit is None)
    assert {frozenset(g) for g in found.reached.groups} == {frozenset(g) for g in best.groups}
    assert found.reached[1] == best[1] == ()
    assert {frozenset(g) for g in best.groups} == {frozenset(g) for g in ((0, 1), (2,), (3,))}
    # what the chosen sets hold tells the groups apart
    held = {f: {k for k, c in enumerate(found.chosen) if f in c.faults} for f in range(4)}
    assert held[0] == held[1] and all(held.values())
    for one in (0, 2, 3):
        for other in (0, 2, 3):
            assert one == other or held[one] - held[other]
    assert found.least is (limit is None)
    if limit is None:
        assert shares == sorted(shares) and shares[0] >= 0.0 and shares[-1] <= 1.0
    for chosen in found.chosen:  # the faults of a set are those of its equations
        of = {f for e in chosen.equations for f in model.equations[e].faults}
        assert set(chosen.faults) == of


def test_missing_sets_are_built_for_what_is_not_seen_or_not_told_apart() -> None:
    model = read_table(Source("table.csv", _TABLE), Report())
    assert model is not None
    best = isolability(model)
    nothing = _signatures(model, [])
    assert nothing.shape == (0, 4)
    added = _missing(model, best, nothing)
    table = _signatures(model, added)
    assert _by_signature(table) == best
    assert _missing(model, best, table) == []
