"""Structure as generic numbers: the combinations of equations in which every unknown cancels.

Random numbers of a prime field stand where an unknown occurs in an equation. The rank of any rows
is then their structural rank, but for a chance of about one in the prime (Schwartz, 1980;
Zippel, 1979), and a row of numbers that annihilates the matrix from the left is a redundancy.
"""

from __future__ import annotations

import random
from collections.abc import Sequence
from heapq import heapify, heappop, heappush

from bondgraph.text.tuples import NamedTuple

PRIME = (1 << 61) - 1


class Redundancy(NamedTuple):
    """The left null space of a generic incidence matrix.

    `free` are the equations that the elimination left over, one for each dimension;
    `vectors[equation]` maps a dimension to the number by which the equation enters there.
    """

    free: tuple[int, ...]
    vectors: tuple[dict[int, int], ...]


def redundancy(
    rows: Sequence[Sequence[int]], last: int = 0, prime: int = PRIME, seed: int = 1
) -> Redundancy:
    """The redundancy of equations; `rows[equation]` lists the columns of its unknowns.

    The last `last` equations are used up for an unknown only where no other one can be, so that
    they are free wherever the others determine it. Columns with the fewest entries are eliminated
    first (Markowitz, 1957): chains and trees cost time in proportion to their size.

    >>> found = redundancy([[0], [0, 1], [1], [2]])
    >>> found.free, [bool(v) for v in found.vectors]
    ((2,), [True, True, True, False])
    """
    draw = random.Random(seed)
    work = [{c: draw.randrange(1, prime) for c in row} for row in rows]
    holders: dict[int, set[int]] = {}
    for r, row in enumerate(work):
        for c in row:
            holders.setdefault(c, set()).add(r)
    first = len(rows) - last
    used: list[tuple[int, list[tuple[int, int]]]] = []
    for among_all in (False, True):
        queue = [(len(h), c) for c, h in holders.items()]
        heapify(queue)
        while queue:
            size, c = heappop(queue)
            if c not in holders:
                continue
            if size != len(holders[c]):
                heappush(queue, (len(holders[c]), c))
                continue
            able = [r for r in holders[c] if among_all or r < first]
            if able:
                pivot = min(able, key=lambda r: (len(work[r]), r))
                used.append((pivot, _take(pivot, c, work, holders, prime)))
    taken = {pivot for pivot, _ in used}
    free = tuple(r for r in range(len(rows)) if r not in taken)
    vectors: list[dict[int, int]] = [{} for _ in rows]
    for dimension, r in enumerate(free):
        vectors[r] = {dimension: 1}
    for pivot, factors in reversed(used):
        total: dict[int, int] = {}
        for r, factor in factors:
            for dimension, x in vectors[r].items():
                total[dimension] = (total.get(dimension, 0) - factor * x) % prime
        vectors[pivot] = {d: x for d, x in total.items() if x}
    return Redundancy(free, tuple(vectors))


def _take(
    pivot: int, column: int, work: list[dict[int, int]], holders: dict[int, set[int]], prime: int
) -> list[tuple[int, int]]:
    """Eliminate a column by a pivot row; how often that row was taken from each other one."""
    own = work[pivot]
    inverse = pow(own[column], -1, prime)
    factors = []
    for r in sorted(holders[column] - {pivot}):
        row = work[r]
        factor = row[column] * inverse % prime
        factors.append((r, factor))
        for c, x in own.items():
            value = (row.get(c, 0) - factor * x) % prime
            if value:
                row[c] = value
                holders[c].add(r)
            elif row.pop(c, None) is not None:
                holders[c].discard(r)
    for c in own:
        holders[c].discard(pivot)
    del holders[column]
    work[pivot] = {}
    return factors


def direction(vector: dict[int, int], prime: int = PRIME) -> tuple[tuple[int, int], ...]:
    """The vector up to a factor: equal for parallel vectors only, empty for the zero vector."""
    if not vector:
        return ()
    items = sorted(vector.items())
    inverse = pow(items[0][1], -1, prime)
    return tuple((d, x * inverse % prime) for d, x in items)
