"""Sparse elimination against products with known solutions."""

from random import Random

import pytest

from bondgraph.field.balls import Reals
from bondgraph.field.numbers import Number, Numbers
from bondgraph.field.prime import PrimeField
from bondgraph.field.sparse import (
    CONSTANT,
    Contradiction,
    Factors,
    Row,
    Singular,
    back_substitute,
    eliminate,
)

KINDS: list[Numbers] = [PrimeField(1), Reals({})]


def sparse(f: Numbers, size: int, seed: int, entries: int = 3) -> list[Row]:
    draw = Random(seed)
    rows: list[Row] = []
    for i in range(size):
        row = {i: f.any(draw)}
        for _ in range(entries - 1):
            row[draw.randrange(size)] = f.any(draw)
        rows.append(row)
    return rows


def times(rows: list[Row], x: list[Number]) -> list[Number]:
    return [sum(c * x[j] for j, c in row.items()) for row in rows]


@pytest.mark.parametrize("f", KINDS, ids=["field", "reals"])
@pytest.mark.parametrize("seed", range(8))
def test_factors_solve_what_they_factored(f: Numbers, seed: int) -> None:
    rows = sparse(f, 30, seed)
    x = [f.any(Random(seed + 50)) for _ in rows]
    found = Factors(f, rows).solve(times(rows, x))
    assert not any(f.nonzero(a - b) for a, b in zip(found, x, strict=True))


@pytest.mark.parametrize("f", KINDS, ids=["field", "reals"])
def test_a_singular_matrix_is_refused(f: Numbers) -> None:
    third = f.inverse(3)
    with pytest.raises(Singular):
        Factors(f, [{0: f.number(1), 1: third}, {0: f.number(3), 1: 3 * third}])


@pytest.mark.parametrize("f", KINDS, ids=["field", "reals"])
@pytest.mark.parametrize("seed", range(8))
def test_elimination_keeps_free_columns_free(f: Numbers, seed: int) -> None:
    rows = sparse(f, 20, seed)[:15]  # five columns more than rows
    draw = Random(seed)
    for row in rows:
        row[CONSTANT] = f.any(draw)
    pivots = eliminate(f, [dict(r) for r in rows])
    determined = {p.column for p in pivots}
    values = {j: f.any(draw) for j in range(20) if j not in determined}
    back_substitute(pivots, values)
    for row in rows:
        assert not f.nonzero(sum(c * (1 if j == CONSTANT else values[j]) for j, c in row.items()))


@pytest.mark.parametrize("f", KINDS, ids=["field", "reals"])
def test_a_dependent_row_vanishes_and_a_contradiction_does_not(f: Numbers) -> None:
    third = f.inverse(3)
    rows: list[Row] = [{0: third, 1: 2 * third, CONSTANT: 3}, {0: 2 * third, 1: 4 * third}]
    rows[1][CONSTANT] = 6
    assert len(eliminate(f, [dict(r) for r in rows])) == 1
    rows[1][CONSTANT] = 7
    with pytest.raises(Contradiction):
        eliminate(f, rows)


def test_a_long_chain_stays_sparse() -> None:
    size = 3000
    rows: list[Row] = [{i: 1, i + 1: 5, i + 2: 7} for i in range(size)]
    pivots = eliminate(KINDS[0], rows)
    assert len(pivots) == size
    assert sum(len(p.row) for p in pivots) < 8 * size
