"""The number of relations of linear equations, by ranks over a prime field and nothing else."""

from __future__ import annotations

from collections.abc import Iterable, Mapping

P = (1 << 127) - 1  # not the prime of the compiler

Row = Mapping[str, int]


def relations(rows: Iterable[Row], known: frozenset[str]) -> int:
    """How many independent equations in the known columns alone the rows imply.

    rank [unknown known] - rank [unknown]: what is left of the rows where the unknowns are
    eliminated. Rows of numbers are a pencil s E - A at a random s, whose rank is that over Q(s)
    but for a chance of about their number / 2**127.
    """
    rows = list(rows)
    unknown = [{c: x for c, x in row.items() if c not in known} for row in rows]
    return rank(rows) - rank(unknown)


def rank(rows: Iterable[Row]) -> int:
    """The rank, by Gaussian elimination: each row is reduced by those before it."""
    pivots: dict[str, dict[str, int]] = {}
    for given in rows:
        row = {c: x % P for c, x in given.items() if x % P}
        while row:
            column = next((c for c in row if c in pivots), None)
            if column is None:
                column = min(row)
                factor = pow(row[column], -1, P)
                own = {c: x * factor % P for c, x in row.items()}
                for other in pivots.values():
                    _subtract(other, other.get(column, 0), own)
                pivots[column] = own
                break
            _subtract(row, row[column], pivots[column])
    return len(pivots)


def _subtract(row: dict[str, int], factor: int, other: Mapping[str, int]) -> None:
    if factor:
        for c, x in other.items():
            value = (row.get(c, 0) - factor * x) % P
            if value:
                row[c] = value
            else:
                row.pop(c, None)
