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
    add_multiple,
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


@pytest.mark.parametrize("f", KINDS, ids=["field", "reals"])
def test_a_multiple_of_a_row_is_added_and_what_cancels_has_no_place(f: Numbers) -> None:
    row: Row = {0: f.number(2), 1: f.number(6), CONSTANT: f.number(1)}
    add_multiple(f, row, f.number(-3), {1: f.number(2), 4: f.number(5), CONSTANT: f.number(1)})
    assert row == {0: 2, 4: -15 * f.number(1), CONSTANT: -2 * f.number(1)}


@pytest.mark.parametrize("f", KINDS, ids=["field", "reals"])
def test_a_column_that_has_cancelled_in_a_row_is_not_looked_for_there(f: Numbers) -> None:
    """v1 + v0 = 0 takes v0 out of the second row, before v0 = 5 is used: v2 + v3 = 7 is left."""
    one = f.number(1)
    rows: list[Row] = [
        {1: one, 0: one},
        {1: one, 0: one, 2: one, 3: one, CONSTANT: f.number(-7)},
        {0: one, CONSTANT: f.number(-5)},
    ]
    pivots = eliminate(f, rows)
    determined = {p.column for p in pivots}
    (free,) = {0, 1, 2, 3} - determined
    assert free in (2, 3)
    values = {free: f.number(3)}
    back_substitute(pivots, values)
    assert [values[j] for j in (0, 1, 5 - free)] == [5, -5 * one, 4]


def test_what_has_negative_columns_alone_is_kept_by_its_number_where_it_is_asked_for() -> None:
    """v0 = -8, told twice: the difference of what is known, 1 to 2, is all that is left."""
    f = KINDS[0]
    one = f.number(1)
    rows: list[Row] = [{0: one, -1: one}, {0: one, -2: one}, {0: 2 * one, -1: 2 * one}]
    left: dict[int, Row] = {}
    assert [p.column for p in eliminate(f, rows, left)] == [0]
    ((number, row),) = left.items()
    assert number in (0, 1) and row[-1] == -row[-2] and set(row) == {-1, -2}
