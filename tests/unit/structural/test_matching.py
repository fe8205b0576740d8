"""The decomposition against networkx and against its definition."""

from __future__ import annotations

import networkx as nx
from hypothesis import given
from hypothesis import strategies as st

from bondgraph.structural.matching import decompose, match


@st.composite
def bipartite(draw: st.DrawFn) -> tuple[list[list[int]], int]:
    columns = draw(st.integers(0, 8))
    member = st.integers(0, columns - 1) if columns else st.nothing()
    row = st.lists(member, max_size=4, unique=True) if columns else st.just([])
    return draw(st.lists(row, max_size=9)), columns


def size_by_networkx(rows: list[list[int]]) -> int:
    graph = nx.Graph()
    graph.add_nodes_from(("r", i) for i in range(len(rows)))
    graph.add_edges_from((("r", i), ("c", c)) for i, row in enumerate(rows) for c in row)
    top = [("r", i) for i in range(len(rows))]
    return len(nx.bipartite.maximum_matching(graph, top)) // 2


@given(bipartite())
def test_matching_is_maximum_and_consistent(case) -> None:
    rows, columns = case
    row_of, column_of = match(rows, columns)
    pairs = [(r, c) for r, c in enumerate(column_of) if c >= 0]
    assert all(c in rows[r] and row_of[c] == r for r, c in pairs)
    assert len({c for _, c in pairs}) == len(pairs) == size_by_networkx(rows)


@given(bipartite())
def test_parts_follow_their_definition(case) -> None:
    """A row is overdetermined iff some maximum matching leaves it free; a column is
    underdetermined iff some maximum matching leaves it free."""
    rows, columns = case
    parts = decompose(rows, columns)
    best = size_by_networkx(rows)
    for r in range(len(rows)):
        without = size_by_networkx(rows[:r] + rows[r + 1 :])
        assert (r in parts.over_rows) == (without == best)
    for c in range(columns):
        without = size_by_networkx([[x for x in row if x != c] for row in rows])
        determined = c in parts.over_columns or c in parts.square_columns
        assert determined == (without < best)
    assert len(parts.square_rows) == len(parts.square_columns)
