"""The bond graph with causality: where each stroke stands, and why."""

from __future__ import annotations

from typing import Literal

from bondgraph.ir.graph import BondGraph
from bondgraph.text.diagnostic import Diagnostic
from bondgraph.text.tuples import NamedTuple

Preference = Literal["integral", "derivative"]
Cause = Literal["source", "sensor", "law", "propagated", "preferred", "chosen", "ring", "switched"]


class Reason(NamedTuple):
    """Why a stroke stands where it stands.

    `source`/`sensor`/`law` fixed by that node; `propagated` forced at `node` by the strokes of
    the bonds `because`; `preferred` by a storage; `chosen` freely (an algebraic loop variable);
    `ring` for a bond that closes a ring of like junctions, whose stroke means nothing; `switched`
    by a switched junction that is off in the mode that the strokes are for.
    """

    cause: Cause
    node: int
    because: tuple[int, ...] = ()


class Stroke(NamedTuple):
    """The stroke of one bond: at its "head" or at its "tail". The node there receives effort."""

    at: Literal["head", "tail"]
    reason: Reason


class Storage(NamedTuple):
    """The causality that a storage port got; `integral` False means a dependent storage."""

    node: int
    port: int
    integral: bool


class Conflict(NamedTuple):
    """Nodes that contradict each other; without any one of them the rest would agree.

    `nodes` are the junctions and two-ports, then the sources and detectors, `bonds` those between
    them; `meet` is the node at which it shows. `strokes` are the (bond, stroke) that follow from
    the sources and detectors alone: where two of them belong to one bond, or one junction has two
    strong ones, they clash. `roles` say in a few words what happens at a node, `finding` is what
    to say about it all.
    """

    nodes: tuple[int, ...]
    bonds: tuple[int, ...]
    meet: int
    strokes: tuple[tuple[int, Literal["head", "tail"]], ...]
    roles: tuple[tuple[int, str], ...]
    finding: Diagnostic


class CausalGraph(NamedTuple):
    """A causal assignment: `strokes[i]` belongs to `graph.bonds[i]`.

    In preferred derivative causality the detectors are dualised (`dualised`: node indices; a
    detector that could not be is in `not_dualised`). `loops` are the algebraic loops as tuples of
    node indices; `dependent` are the storages in the other causality than preferred integral.
    """

    graph: BondGraph
    preference: Preference
    strokes: tuple[Stroke, ...]
    storages: tuple[Storage, ...]
    dualised: tuple[int, ...]
    not_dualised: tuple[int, ...]
    loops: tuple[tuple[int, ...], ...]

    @property
    def dependent(self) -> tuple[Storage, ...]:
        """Storages in derivative causality."""
        return tuple(s for s in self.storages if not s.integral)
