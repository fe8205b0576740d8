"""Sparse elimination against products with known solutions."""

from random import Random

import pytest

from bondgraph.exact.field import P
from bondgraph.exact.linear import (
    CONSTANT,
    Contradiction,
    Factors,
    Row,
    Singular,
    back_substitute,
    eliminate,
)
from bondgraph.exact.structure import offsets


def sparse(size: int, seed: int, entries: int = 3) -> list[Row]:
    draw = Random(seed)
    rows: list[Row] = []
    for i in range(size):
        row = {i: draw.randrange(1, P)}
        for _ in range(entries - 1):
            row[draw.randrange(size)] = draw.randrange(1, P)
        rows.append(row)
    return rows


def times(rows: list[Row], x: list[int]) -> list[int]:
    return [sum(c * x[j] for j, c in row.items()) % P for row in rows]


@pytest.mark.parametrize("seed", range(8))
def test_factors_solve_what_they_factored(seed: int) -> None:
    rows = sparse(30, seed)
    x = [Random(seed + 50).randrange(P) for _ in rows]
    assert Factors(rows).solve(times(rows, x)) == x


def test_a_singular_matrix_is_refused() -> None:
    with pytest.raises(Singular):
        Factors([{0: 1, 1: 2}, {0: 2, 1: 4}])


@pytest.mark.parametrize("seed", range(8))
def test_elimination_keeps_free_columns_free(seed: int) -> None:
    rows = sparse(20, seed)[:15]  # five columns more than rows
    draw = Random(seed)
    for row in rows:
        row[CONSTANT] = draw.randrange(P)
    pivots = eliminate([dict(r) for r in rows])
    determined = {p.column for p in pivots}
    values = {j: draw.randrange(P) for j in range(20) if j not in determined}
    back_substitute(pivots, values)
    for row in rows:
        assert sum(c * (1 if j == CONSTANT else values[j]) for j, c in row.items()) % P == 0


def test_a_dependent_row_vanishes_and_a_contradiction_does_not() -> None:
    rows: list[Row] = [{0: 1, 1: 2, CONSTANT: 3}, {0: 2, 1: 4, CONSTANT: 6}]
    assert len(eliminate([dict(r) for r in rows])) == 1
    rows[1][CONSTANT] = 7
    with pytest.raises(Contradiction):
        eliminate(rows)


def test_a_long_chain_stays_sparse() -> None:
    size = 3000
    rows: list[Row] = [{i: 1, i + 1: 5, i + 2: 7} for i in range(size)]
    pivots = eliminate(rows)
    assert len(pivots) == size
    assert sum(len(p.row) for p in pivots) < 8 * size


def test_offsets_of_the_pendulum() -> None:
    # Pryce (2001), example: x'' = -x T, y'' = -y T + g, x^2 + y^2 = l^2
    found = offsets([{0: 2, 2: 0}, {1: 2, 2: 0}, {0: 0, 1: 0}], 3)
    assert found.equations == [0, 0, 2]
    assert found.variables == [2, 2, 0]
    assert found.free == found.unmatched == []


def test_offsets_tell_what_is_free_and_what_is_too_much() -> None:
    assert offsets([{0: 0, 1: 1}], 2).free in ([0], [1])
    assert offsets([{0: 0}, {0: 1}], 1).unmatched == [1]
