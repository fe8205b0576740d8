"""One minimal overdetermined set that sees a fault and does not see another, without a search."""

from __future__ import annotations

from collections.abc import Collection

from bondgraph.ir.structural_model import StructuralModel
from bondgraph.structural.matching import decompose


def witness(
    model: StructuralModel, inside: Collection[int], outside: Collection[int]
) -> tuple[int, ...] | None:
    """An MSO set with one of the equations `inside` and none of those `outside`; None if none is.

    Equations are taken away one by one while the one wanted stays in the overdetermined part.
    """
    kept = _over(model, [e for e in range(len(model.equations)) if e not in outside])
    wanted = next((e for e in kept if e in inside), None)
    if wanted is None:
        return None
    for equation in list(kept):
        if equation != wanted and equation in kept:
            fewer = _over(model, [e for e in kept if e != equation])
            if wanted in fewer:
                kept = fewer
    return tuple(kept)


def _over(model: StructuralModel, equations: list[int]) -> list[int]:
    """The overdetermined part of some equations."""
    rows = [list(model.equations[e].unknowns) for e in equations]
    return [equations[r] for r in decompose(rows, len(model.unknowns)).over_rows]
