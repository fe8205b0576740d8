"""A recipe with what repeats written once is the same recipe."""

from __future__ import annotations

from hypothesis import given
from hypothesis import strategies as st

from bondgraph.backends.repeated import repeated
from bondgraph.ir.program import TapeOp

_OP = st.builds(
    TapeOp,
    st.integers(0, 2), st.integers(0, 2), st.integers(0, 1), st.integers(0, 2),
    st.integers(0, 3), st.booleans(),
)  # fmt: skip
_CELLS = st.tuples(
    st.lists(_OP, max_size=5), st.lists(_OP, min_size=1, max_size=5),
    st.integers(0, 30), st.integers(0, 3), st.lists(_OP, max_size=5),
)  # fmt: skip


def _unrolled(lines: list[TapeOp], runs: list[tuple[int, int, int, int]]) -> list[TapeOp]:
    return [
        op._replace(length=op.length + j * grow)
        for first, many, times, grow in runs
        for j in range(times)
        for op in lines[first : first + many]
    ]


@given(_CELLS)
def test_unrolled_it_is_what_it_was(
    cells: tuple[list[TapeOp], list[TapeOp], int, int, list[TapeOp]],
) -> None:
    before, cell, times, grow, behind = cells
    ops = [*before]
    for k in range(times):
        ops += [op._replace(length=op.length + k * grow) for op in cell]
    ops += behind
    lines, runs = repeated(ops)
    assert _unrolled(lines, [tuple(r) for r in runs]) == ops  # type: ignore[misc]


def test_a_thousand_cells_are_one() -> None:
    cell = [TapeOp(k % 3, (k + 1) % 3, 0, k % 2, 1 + k, k == 0) for k in range(7)]
    ops = [op._replace(length=op.length + 2 * k) for k in range(1000) for op in cell]
    lines, runs = repeated(ops)
    assert lines == cell and [tuple(r) for r in runs] == [(0, 7, 1000, 2)]
