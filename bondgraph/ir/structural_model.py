"""A structural model: which unknowns, known signals and faults occur in which equation, no more."""

from __future__ import annotations

from typing import Literal

from bondgraph.text.source import Span
from bondgraph.text.tuples import NamedTuple

#: How an unknown occurs in an equation: plainly, or in a differential constraint as the variable
#: that is integrated ("I", the state) or as one that holds its derivative ("D").
Mark = Literal["", "I", "D"]


class StructuralEquation(NamedTuple):
    """One row of the incidence table.

    `unknowns` holds the columns of the unknowns in ascending order and `marks` how each of them
    occurs; `knowns` and `faults` the columns of the known signals and of the faults.
    """

    name: str
    unknowns: tuple[int, ...]
    marks: tuple[Mark, ...]
    knowns: tuple[int, ...]
    faults: tuple[int, ...]
    origin: Span

    @property
    def states(self) -> tuple[int, ...]:
        """The unknowns whose derivative the equation holds."""
        return tuple(v for v, m in zip(self.unknowns, self.marks, strict=True) if m == "I")


class StructuralModel(NamedTuple):
    """Names of unknowns, known signals and faults, and the equations that they occur in."""

    name: str
    unknowns: tuple[str, ...]
    knowns: tuple[str, ...]
    faults: tuple[str, ...]
    equations: tuple[StructuralEquation, ...]

    @property
    def rows(self) -> list[list[int]]:
        """The columns of the unknowns of each equation."""
        return [list(e.unknowns) for e in self.equations]

    def holders(self, fault: int) -> tuple[int, ...]:
        """The equations that a fault occurs in."""
        return tuple(i for i, e in enumerate(self.equations) if fault in e.faults)
