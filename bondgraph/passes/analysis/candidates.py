"""The places of a model where a sensor could be added."""

from __future__ import annotations

from bondgraph.ir.equation_system import EquationSystem
from bondgraph.ir.structural_model import StructuralModel
from bondgraph.library.elements import PASSIVE
from bondgraph.structural.placement import Candidate

_ONE_PORTS = frozenset({*PASSIVE, "Se", "Sf"})


def bond_graph_places(
    system: EquationSystem, costs: dict[str, float], elements: bool = False
) -> tuple[Candidate, ...]:
    """De at each 0-junction, Df at each 1-junction; with `elements`, in and across them too.

    Junctions that share their variable are one place, named after the first. `costs` are by
    path; 1 where none is given. An element of a 1-junction can have its effort measured, one of a
    0-junction its flow.
    """
    graph = system.graph
    column = {v: i for i, v in enumerate(system.unknowns)}
    found: dict[int, tuple[str, str]] = {}
    for bond in graph.bonds:
        for end, other in ((bond.tail, bond.head), (bond.head, bond.tail)):
            node, beside = graph.nodes[end.node], graph.nodes[other.node]
            pair = (system.efforts[bond.number], system.flows[bond.number])
            if node.kind in ("0", "1"):
                kind = "De" if node.kind == "0" else "Df"
                variable = pair[node.kind == "1"]
            elif elements and node.kind in _ONE_PORTS and beside.kind in ("0", "1"):
                kind = "Df" if beside.kind == "0" else "De"
                variable = pair[beside.kind == "0"]
            else:
                continue
            at = column.get(variable.scaled[1], -1)
            if at >= 0:
                found.setdefault(at, (kind, node.path))
    return tuple(
        Candidate(f"{kind} at {path}", at, costs.get(path, 1.0))
        for at, (kind, path) in found.items()
    )


def table_places(model: StructuralModel, costs: dict[str, float]) -> tuple[Candidate, ...]:
    """Every unknown that is not the derivative of a state."""
    derived = {
        v
        for e in model.equations
        for v, mark in zip(e.unknowns, e.marks, strict=True)
        if mark == "D"
    }
    return tuple(
        Candidate(name, at, costs.get(name, 1.0))
        for at, name in enumerate(model.unknowns)
        if at not in derived
    )
