"""Redundancies of structures: what annihilates a generic matrix, which equations stay free."""

from __future__ import annotations

import random

import pytest
from hypothesis import given, settings

from bondgraph.structural.generic import PRIME, direction, redundancy
from tests.unit.structural.structures import over, rank, structures


def _generic(rows: list[list[int]], seed: int = 1) -> list[dict[int, int]]:
    """The numbers that stand for the unknowns: drawn row by row, in the order of the columns."""
    draw = random.Random(seed)
    return [{c: draw.randrange(1, PRIME) for c in row} for row in rows]


@settings(max_examples=80, deadline=None)
@given(structures())
def test_the_combinations_annihilate_and_are_as_many_as_the_rank_leaves(
    structure: list[frozenset[int]],
) -> None:
    rows = [sorted(row) for row in structure]
    found = redundancy(rows)
    assert len(found.free) == len(rows) - rank(structure, range(len(rows)))
    matrix = _generic(rows)
    for dimension in range(len(found.free)):
        total: dict[int, int] = {}
        for vector, row in zip(found.vectors, matrix, strict=True):
            for column, x in row.items():
                total[column] = (total.get(column, 0) + vector.get(dimension, 0) * x) % PRIME
        assert not any(total.values())
    # each free equation is in its own dimension alone, with the number one
    for dimension, equation in enumerate(found.free):
        assert found.vectors[equation] == {dimension: 1}
    # what is in some combination is the overdetermined part
    inside = {k for k, vector in enumerate(found.vectors) if vector}
    assert inside == over(structure, range(len(rows)))


@settings(max_examples=60, deadline=None)
@given(structures(6, 4))
def test_the_last_equations_are_used_up_only_where_the_others_determine_nothing(
    structure: list[frozenset[int]],
) -> None:
    """As many are free as the rank of the others leaves of them."""
    rows = [sorted(row) for row in structure]
    for last in range(len(rows) + 1):
        first = len(rows) - last
        found = redundancy(rows, last)
        free_of_others = sum(k < first for k in found.free)
        assert free_of_others == first - rank(structure, range(first))


@pytest.mark.parametrize("factor", [1, 5, PRIME - 1, 1234567891011])
def test_parallel_vectors_have_one_direction(factor: int) -> None:
    vector = {7: 3, 2: 10, 4: PRIME - 4}
    scaled = {d: x * factor % PRIME for d, x in vector.items()}
    found = direction(scaled)
    assert found == direction(vector)
    assert [d for d, _ in found] == [2, 4, 7] and found[0][1] == 1
    assert found[2][1] * 10 % PRIME == 3
    assert direction({**scaled, 9: 1}) != found and direction({}) == ()
