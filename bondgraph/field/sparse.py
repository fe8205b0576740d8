"""Sparse linear equations over any kind of number, eliminated with the fewest new entries first.

The pivot is taken in a shortest row, in its column with the fewest entries (Markowitz, 1957), so
that chains and grids keep their sparsity. Rows are dicts column -> coefficient; the column
`CONSTANT` holds what is known: the row says that the sum over columns and the constant is zero.
"""

from __future__ import annotations

from collections.abc import Iterable
from heapq import heapify, heappop, heappush
from typing import TypeAlias

from bondgraph.field.numbers import Number, Numbers
from bondgraph.text.tuples import NamedTuple

Row: TypeAlias = dict[int, Number]

CONSTANT = -1


class Contradiction(ArithmeticError):
    """The equations cannot all hold; `row` is the number of one that does not.

    `node` is the node of a nonlinear law that no number could be found for, -1 for none.
    """

    def __init__(self, row: int, node: int = -1) -> None:
        super().__init__(f"equation {row} contradicts the others")
        self.row = row
        self.node = node


class Singular(ArithmeticError):
    """A square system without a unique solution."""


class Pivot(NamedTuple):
    """column = -(sum of row): `row` has no columns that were eliminated before, coefficient 1."""

    column: int
    row: Row


def add_multiple(numbers: Numbers, target: Row, factor: Number, source: Row) -> None:
    """target += factor * source, entries that vanish taken out."""
    nonzero = numbers.nonzero
    for column, x in source.items():
        value = target.get(column, 0) + factor * x
        if nonzero(value):
            target[column] = value
        else:
            target.pop(column, None)


def eliminate(numbers: Numbers, rows: list[Row], left: dict[int, Row] | None = None) -> list[Pivot]:
    """The pivots in the order of elimination; the rows are used up.

    Dependent rows vanish; columns without a pivot are free. Negative columns are never eliminated:
    rows that have no others raise `Contradiction`, or are kept in `left` by their number.
    """
    nonzero = numbers.nonzero
    where: dict[int, set[int]] = {}
    for number, row in enumerate(rows):
        for column in row:
            if column >= 0:
                where.setdefault(column, set()).add(number)
    queue = [(len(row), number) for number, row in enumerate(rows)]
    heapify(queue)
    done = [False] * len(rows)
    pivots = []
    while queue:
        size, number = heappop(queue)
        row = rows[number]
        if done[number] or size != len(row):
            continue
        done[number] = True
        columns = [c for c in row if c >= 0]
        if not columns:
            if row and left is None:
                raise Contradiction(number)
            if row and left is not None:
                left[number] = row
            continue
        column = min(columns, key=lambda c: (len(where[c]), c))
        scale = numbers.inverse(row.pop(column))
        row = {c: x * scale for c, x in row.items()}
        pivots.append(Pivot(column, row))
        for c in columns:
            where[c].discard(number)
        for other in sorted(where.pop(column)):
            target = rows[other]
            factor = -target.pop(column)
            for c, x in row.items():
                known = target.get(c)
                if known is None:
                    target[c] = factor * x
                    if c >= 0:
                        where[c].add(other)
                else:
                    value = known + factor * x
                    if nonzero(value):
                        target[c] = value
                    else:
                        del target[c]
                        if c >= 0:
                            where[c].discard(other)
            heappush(queue, (len(target), other))
    return pivots


def back_substitute(pivots: Iterable[Pivot], values: dict[int, Number]) -> None:
    """Complete `values`, which holds the free columns, with all pivots."""
    for column, row in reversed(list(pivots)):
        total: Number = 0
        for c, x in row.items():
            total += x if c == CONSTANT else x * values[c]
        values[column] = -total


class Factors:
    """A square matrix factored once, for many right-hand sides."""

    def __init__(self, numbers: Numbers, rows: list[Row]) -> None:
        """Columns are 0 ... n-1; raises `Singular`."""
        self._numbers = numbers
        self._columns: list[int] = []
        self._source: list[int] = []
        self._scale: list[Number] = []
        self._down: list[list[tuple[int, Number]]] = []
        self._up: list[list[tuple[int, Number]]] = []
        self._factor(rows, len(rows))

    def _factor(self, rows: list[Row], size: int) -> None:
        nonzero = self._numbers.nonzero
        work = [dict(r) for r in rows]
        where: dict[int, set[int]] = {}
        for number, row in enumerate(work):
            for column in row:
                where.setdefault(column, set()).add(number)
        queue = [(len(row), number) for number, row in enumerate(work)]
        heapify(queue)
        done = [False] * size
        while queue:
            length, number = heappop(queue)
            row = work[number]
            if done[number] or length != len(row):
                continue
            if not row:
                raise Singular
            done[number] = True
            column = min(row, key=lambda c: (len(where[c]), c))
            for c in row:
                where[c].discard(number)
            scale = self._numbers.inverse(row.pop(column))
            down = []
            for other in sorted(where.pop(column)):
                target = work[other]
                factor = -target.pop(column) * scale
                down.append((other, factor))
                for c, x in row.items():
                    known = target.get(c)
                    value = factor * x if known is None else known + factor * x
                    if known is None or nonzero(value):
                        target[c] = value
                        if known is None:
                            where[c].add(other)
                    else:
                        del target[c]
                        where[c].discard(other)
                heappush(queue, (len(target), other))
            self._columns.append(column)
            self._source.append(number)
            self._scale.append(scale)
            self._down.append(down)
            self._up.append(list(row.items()))
        if len(self._columns) != size:
            raise Singular

    def solve(self, right: list[Number]) -> list[Number]:
        """x with matrix * x = right."""
        b = right.copy()
        for number, down in zip(self._source, self._down, strict=True):
            value = b[number]
            if value:
                for other, factor in down:
                    b[other] += factor * value
        x: list[Number] = [0] * len(b)
        for at in range(len(b) - 1, -1, -1):
            total = b[self._source[at]]
            for c, coefficient in self._up[at]:
                total -= coefficient * x[c]
            x[self._columns[at]] = total * self._scale[at]
        return x
