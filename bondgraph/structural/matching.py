"""Which equations determine which variables: Dulmage and Mendelsohn (1958), by augmenting paths."""

from __future__ import annotations

from collections import deque
from collections.abc import Iterable

from bondgraph.ir.groups import Groups
from bondgraph.text.tuples import NamedTuple


class Parts(NamedTuple):
    """The coarse decomposition of a bipartite graph of equations (rows) and variables (columns).

    `over` holds the rows and columns of the overdetermined part, `square` the just-determined
    ones; what remains is underdetermined. `row_of[column]` is the matched row or -1.
    """

    over_rows: tuple[int, ...]
    over_columns: tuple[int, ...]
    square_rows: tuple[int, ...]
    square_columns: tuple[int, ...]
    row_of: list[int]
    column_of: list[int]


def match(
    rows: list[list[int]],
    columns: int,
    pairs: Iterable[tuple[int, int]] = (),
    in_order: bool = False,
) -> tuple[list[int], list[int]]:
    """A maximum matching as (row of each column, column of each row), -1 where there is none.

    Greedy first, after the given (row, column) `pairs`; then one breadth-first augmenting search
    a free row. With `in_order` there is no greedy pass, and a row is matched if it can be beside
    the matched ones before it: the rows of an optimum where earlier ones count more.
    """
    row_of = [-1] * columns
    column_of = [-1] * len(rows)
    for r, c in pairs:
        row_of[c], column_of[r] = r, c
    for r, members in enumerate(rows):
        if in_order or column_of[r] >= 0:
            continue
        for c in members:
            if row_of[c] < 0:
                row_of[c], column_of[r] = r, c
                break
    dead = [False] * columns  # columns from which no free column can be reached any more
    for start in range(len(rows)):
        if column_of[start] < 0:
            _augment(start, rows, row_of, column_of, dead)
    return row_of, column_of


def _augment(
    start: int, rows: list[list[int]], row_of: list[int], column_of: list[int], dead: list[bool]
) -> None:
    came: dict[int, int] = {}  # column to the row it was reached from
    queue = deque([start])
    while queue:
        r = queue.popleft()
        for c in rows[r]:
            if c in came or dead[c]:
                continue
            came[c] = r
            if row_of[c] < 0:
                while True:  # flip the path back to the start
                    r = came[c]
                    row_of[c], column_of[r], c = r, c, column_of[r]
                    if r == start:
                        return
            queue.append(row_of[c])
    for c in came:
        dead[c] = True


def decompose(rows: list[list[int]], columns: int) -> Parts:
    """The overdetermined and just-determined parts; `rows[r]` lists the columns of row r."""
    row_of, column_of = match(rows, columns)
    holders: list[list[int]] = [[] for _ in range(columns)]
    for r, members in enumerate(rows):
        for c in members:
            holders[c].append(r)
    # overdetermined: reached from free rows over any edge to a column, back over its match
    over_rows = [column_of[r] < 0 for r in range(len(rows))]
    over_columns = [False] * columns
    stack = [r for r, free in enumerate(over_rows) if free]
    while stack:
        for c in rows[stack.pop()]:
            if not over_columns[c]:
                over_columns[c] = True
                if not over_rows[row_of[c]]:
                    over_rows[row_of[c]] = True
                    stack.append(row_of[c])
    # underdetermined: reached from free columns over any edge to a row, back over its match
    under_columns = [row_of[c] < 0 for c in range(columns)]
    under_rows = [False] * len(rows)
    stack = [c for c, free in enumerate(under_columns) if free]
    while stack:
        for r in holders[stack.pop()]:
            if not under_rows[r]:
                under_rows[r] = True
                c = column_of[r]
                if not under_columns[c]:
                    under_columns[c] = True
                    stack.append(c)
    return Parts(
        tuple(r for r, hit in enumerate(over_rows) if hit),
        tuple(c for c, hit in enumerate(over_columns) if hit),
        tuple(r for r in range(len(rows)) if not over_rows[r] and not under_rows[r]),
        tuple(c for c in range(columns) if not over_columns[c] and not under_columns[c]),
        row_of,
        column_of,
    )


def components(graph: list[list[int]], rows: list[int], columns: set[int]) -> list[list[int]]:
    """Connected components of the given rows and columns, as sorted lists of columns."""
    joined = Groups[int]()
    for r in rows:
        inside = [c for c in graph[r] if c in columns]
        for c in inside[1:]:
            joined.join(inside[0], c)
    return joined.among(sorted(columns))
