"""How the unknowns of an MSO set are computed when one of its equations is the residual.

The other equations determine all unknowns: block by block of their strongly connected parts
(Dulmage and Mendelsohn, 1958), each differential constraint used one way. Solved for its state it
is integrated, solved for a derivative it is differentiated (Frisk et al., 2012).
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Literal

from bondgraph.ir.structural_model import StructuralModel
from bondgraph.structural.matching import decompose, match
from bondgraph.text.tuples import NamedTuple

Causality = Literal["algebraic", "integral", "derivative", "mixed"]
Loop = Literal["none", "algebraic", "differential"]

_CAUSALITIES: tuple[Causality, ...] = ("algebraic", "integral", "derivative", "mixed")
_LOOPS: tuple[Loop, ...] = ("none", "algebraic", "differential")


class Realisation(NamedTuple):
    """A residual equation with what its unknowns cost.

    `causality` says whether differential constraints are integrated, differentiated, both, or
    not needed. `loop` is algebraic where equations must be solved together, and differential
    where a derivative is fed back into what it is the derivative of (a high index).
    """

    residual: int
    causality: Causality
    loop: Loop

    @property
    def cost(self) -> tuple[int, int]:
        """An order of preference: no loop, then no differentiation."""
        return _LOOPS.index(self.loop), _CAUSALITIES.index(self.causality)


def realisations(model: StructuralModel, mso: Sequence[int]) -> tuple[Realisation, ...]:
    """What each equation of an MSO set is as its residual, in the order of the set."""
    return tuple(realise(model, mso, r) for r in mso)


def realise(model: StructuralModel, mso: Sequence[int], residual: int) -> Realisation:
    """The cost of computing the unknowns of an MSO set from all its equations but `residual`."""
    rest = [e for e in mso if e != residual]
    own = _Part(model, rest, sorted({v for e in rest for v in model.equations[e].unknowns}))
    if own.unmatched:
        raise ValueError("the equations without the residual do not determine the unknowns")
    integrated = differentiated = False
    loop: Loop = "none"
    for block in own.blocks():
        found = _block(model, own, block)
        integrated |= found.causality in ("integral", "mixed")
        differentiated |= found.causality in ("derivative", "mixed")
        loop = max(loop, found.loop, key=_LOOPS.index)
    if model.equations[residual].states and not differentiated:
        integrated = True
    return Realisation(residual, _causality(integrated, differentiated), loop)


def integral_residuals(model: StructuralModel, mso: Sequence[int]) -> tuple[int, ...]:
    """The equations of an MSO set that leave a system to be integrated, of low index.

    With all states known from their integrals, the other equations must determine the rest but
    for one redundancy; the residual is in the part that has it, or integrates a state of it.

    Time is that of one decomposition for the whole set.
    """
    dynamic = {e: model.equations[e].states for e in mso if model.equations[e].states}
    states = {v for own in dynamic.values() for v in own}
    if any(len(own) > 1 for own in dynamic.values()) or len(states) < len(dynamic):
        return ()
    static = [e for e in mso if e not in dynamic]
    unknowns = {v for e in mso for v in model.equations[e].unknowns}
    column = {v: i for i, v in enumerate(sorted(unknowns - states))}
    rows = [[column[v] for v in model.equations[e].unknowns if v in column] for e in static]
    parts = decompose(rows, len(column))
    if min(parts.row_of, default=0) < 0:
        return ()
    over = [static[i] for i in parts.over_rows]
    reached = {v for e in over for v in model.equations[e].unknowns}
    ends = [e for e, own in dynamic.items() if own[0] in reached]
    return tuple(sorted([*over, *ends]))


class _Part:
    """A just-determined system: its matching, and its strongly connected blocks."""

    def __init__(
        self, model: StructuralModel, equations: Sequence[int], unknowns: Sequence[int]
    ) -> None:
        self.equations = list(equations)
        self.unknowns = list(unknowns)
        column = {v: i for i, v in enumerate(unknowns)}
        self.rows = [
            [column[v] for v in model.equations[e].unknowns if v in column] for e in equations
        ]
        self.row_of, self.column_of = match(self.rows, len(column))

    @property
    def unmatched(self) -> bool:
        return min([*self.row_of, *self.column_of], default=0) < 0

    def matched(self, row: int) -> int:
        """The unknown that an equation is solved for."""
        return self.unknowns[self.column_of[row]]

    def blocks(self) -> list[list[int]]:
        """The rows that must be solved together, in the order they can be (Tarjan, 1972)."""
        index: dict[int, int] = {}
        low: dict[int, int] = {}
        open_rows: list[int] = []
        waiting: set[int] = set()
        found: list[list[int]] = []
        for root in range(len(self.rows)):
            if root in index:
                continue
            stack = [(root, iter(self.rows[root]))]
            index[root] = low[root] = len(index)
            open_rows.append(root)
            waiting.add(root)
            while stack:
                row, columns = stack[-1]
                for column in columns:
                    other = self.row_of[column]
                    if other not in index:
                        index[other] = low[other] = len(index)
                        open_rows.append(other)
                        waiting.add(other)
                        stack.append((other, iter(self.rows[other])))
                        break
                    if other in waiting:
                        low[row] = min(low[row], index[other])
                else:
                    stack.pop()
                    if stack:
                        low[stack[-1][0]] = min(low[stack[-1][0]], low[row])
                    if low[row] == index[row]:
                        at = open_rows.index(row)
                        found.append(sorted(open_rows[at:]))
                        waiting.difference_update(open_rows[at:])
                        del open_rows[at:]
        return found


def _block(model: StructuralModel, part: _Part, block: list[int]) -> Realisation:
    """What it takes to solve the equations of one block."""
    equations = [part.equations[r] for r in block]
    unknowns = sorted(part.matched(r) for r in block)
    if len(block) == 1:
        states = model.equations[equations[0]].states
        integrated = unknowns[0] in states
        differentiated = any(v != unknowns[0] for v in states)
        return Realisation(-1, _causality(integrated, differentiated), "none")
    differentiated = False
    rest, left = [], set(unknowns)
    for e in equations:
        states = model.equations[e].states
        inside = [v for v in states if v in left]
        differentiated |= len(inside) < len(states)
        if inside:
            left.discard(inside[0])
        else:
            rest.append(e)
    integrated = len(rest) < len(equations)
    inner = _Part(model, rest, sorted(left))
    if inner.unmatched:
        return Realisation(-1, "mixed", "differential")
    loop: Loop = "algebraic" if any(len(b) > 1 for b in inner.blocks()) else "none"
    return Realisation(-1, _causality(integrated, differentiated), loop)


def _causality(integrated: bool, differentiated: bool) -> Causality:
    if integrated and differentiated:
        return "mixed"
    if integrated:
        return "integral"
    return "derivative" if differentiated else "algebraic"
