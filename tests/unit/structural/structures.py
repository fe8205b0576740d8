"""Small structures and what brute force says about them, by a route of its own.

The structural rank of equations is the least of |unknowns of T| + |equations without T| over all
subsets T (Koenig, 1931; Ore, 1955): no matching, no numbers.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from itertools import combinations
from pathlib import Path

from hypothesis import strategies as st

from bondgraph.frontend.incidence import read_table
from bondgraph.frontend.read import read
from bondgraph.ir.structural_model import StructuralEquation, StructuralModel
from bondgraph.text.diagnostic import Report
from bondgraph.text.source import Source, Span

PUBLISHED = Path(__file__).parents[3] / "models" / "structure"
_HERE = Span(Source("made.csv", ""), 0, 0)

Rows = Sequence[frozenset[int]]


def published(name: str) -> StructuralModel:
    report = Report()
    source = read(str(PUBLISHED / f"{name}.csv"), report)
    assert source is not None
    model = read_table(source, report)
    assert model is not None, report.diagnostics
    return model


def model_of(
    rows: Iterable[Iterable[int]], faults: Iterable[Iterable[int]] = (), count: int = 0
) -> StructuralModel:
    """A static model of equations with these unknowns; `faults[equation]` lists its faults."""
    rows = [tuple(sorted(r)) for r in rows]
    of = [tuple(sorted(f)) for f in faults] or [() for _ in rows]
    unknowns = max((v for r in rows for v in r), default=-1) + 1
    return StructuralModel(
        "made",
        tuple(f"x{i}" for i in range(unknowns)),
        (),
        tuple(f"f{i}" for i in range(count)),
        tuple(
            StructuralEquation(f"e{i}", r, ("",) * len(r), (), f, _HERE)
            for i, (r, f) in enumerate(zip(rows, of, strict=True))
        ),
    )


def subsets(items: Sequence[int]) -> Iterable[tuple[int, ...]]:
    return (c for n in range(len(items) + 1) for c in combinations(items, n))


def rank(rows: Rows, chosen: Sequence[int]) -> int:
    return min(
        len(frozenset().union(*(rows[e] for e in part))) + len(chosen) - len(part)
        for part in subsets(chosen)
    )


def is_mso(rows: Rows, chosen: Sequence[int]) -> bool:
    """Dependent, while no part of it is."""
    return rank(rows, chosen) < len(chosen) and all(
        rank(rows, rest) == len(rest) for rest in combinations(chosen, len(chosen) - 1)
    )


def over(rows: Rows, chosen: Sequence[int]) -> set[int]:
    """The overdetermined part: what can be left out without losing rank."""
    whole = rank(rows, chosen)
    return {e for e in chosen if rank(rows, [c for c in chosen if c != e]) == whole}


@st.composite
def structures(draw: st.DrawFn, equations: int = 7, unknowns: int = 4) -> list[frozenset[int]]:
    count = draw(st.integers(1, equations))
    columns = st.frozensets(st.integers(0, unknowns - 1), max_size=3)
    return draw(st.lists(columns, min_size=count, max_size=count))
