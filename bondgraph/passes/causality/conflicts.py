"""Why strokes cannot be placed: the irreducible contradictions of a bond graph, told and mended."""

from __future__ import annotations

from bondgraph.ir.causal import Conflict
from bondgraph.ir.graph import BondGraph
from bondgraph.passes.causality.cores import cores
from bondgraph.passes.causality.explanation import Explanation, explanation
from bondgraph.passes.causality.mends import Mend, mends
from bondgraph.passes.causality.node_words import sentence
from bondgraph.passes.causality.rules import demands, network
from bondgraph.passes.causality.switches import sound_in_a_mode
from bondgraph.text.diagnostic import Diagnostic


def conflicts(graph: BondGraph) -> tuple[Conflict, ...]:
    """The contradictions, none of which shares a member with another; none for a sound graph.

    A contradiction that instances of one submodel repeat is told once. What would mend it is
    tried on the whole graph before it is proposed.
    """
    net, at = network(graph)
    musts, _ = demands(graph, at, "integral")
    if sound_in_a_mode(graph, net, musts):
        return ()
    classes: dict[tuple[str, int, int, str], int] = {}
    alike = [
        classes.setdefault((o.source.path, o.start, o.end, node.kind), n)
        for n, node in enumerate(graph.nodes)
        for o in (node.origin,)
    ]
    found = cores(net, musts, alike)
    members = [core.nodes(net) for core in found]
    told = []
    for core, nodes in zip(found, members, strict=True):
        away = {alike[n] for other in members if other is not nodes for n in other}
        others = {n for n, kind in enumerate(alike) if kind in away}
        what = explanation(graph, net, core)
        told.append(_conflict(graph, nodes, what, mends(graph, nodes, what, others, alike)))
    return tuple(told)


def _conflict(
    graph: BondGraph, nodes: list[int], what: Explanation, changes: list[Mend]
) -> Conflict:
    inside = set(nodes)
    bonds = tuple(
        b
        for b, bond in enumerate(graph.bonds)
        if bond.tail.node in inside and bond.head.node in inside
    )
    help = f"{what.physics} {_remedies(changes)}"
    edits = tuple([change.edit for change in changes if change.edit is not None])
    message = sentence(what.message)
    finding = Diagnostic("causality-conflict", message, what.labels, help, edits=edits)
    return Conflict(
        tuple(nodes),
        bonds,
        what.meet,
        tuple((bond, "head" if value else "tail") for bond, value in what.strokes),
        what.roles,
        finding,
    )


def _remedies(changes: list[Mend]) -> str:
    if not changes:
        return (
            "Something that lies between these elements in the machine is missing in the model: "
            "add the R, C or I, or leave out one of them."
        )
    head = "Each of these mends it:" if len(changes) > 1 else "This mends it:"
    return "\n".join([head, *[f"- {change.text}" for change in changes]])
