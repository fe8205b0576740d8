"""Switched junctions that cannot be off, because a source imposes what they then hold at zero."""

from __future__ import annotations

from bondgraph.ir.expr import Expr, Op, symbols
from bondgraph.ir.graph import BondGraph
from bondgraph.ir.show import show
from bondgraph.passes.causal.conflict import Core, cores
from bondgraph.passes.causal.network import Network, Wish
from bondgraph.passes.causal.story import story
from bondgraph.passes.causal.words import name, sentence
from bondgraph.text.diagnostic import Report

_MOST = 40  # junctions tried


def report_switches(graph: BondGraph, net: Network, musts: list[Wish], report: Report) -> None:
    """A warning for each junction whose being off contradicts the sources, whatever else is on.

    Off, a 1-junction gives the flow zero to all its bonds, a 0-junction the effort zero. The other
    switched junctions are left open: they may be on or off.
    """
    switched = {n: node.when for n, node in enumerate(graph.nodes) if node.when is not None}
    rules = [rule for rule, n in enumerate(net.name) if n not in switched]
    part, _ = net.part(rules, list(range(net.bonds)))
    for rule, n in enumerate(net.name):
        when = switched.get(n)
        if when is None or len(switched) > _MOST:
            continue
        off = [Wish(end >> 1, 1 - net.strong[end], n, -1, "source") for end in net.ends[rule]]
        for core in cores(part, [*off, *musts], most=1):
            sources = [must.node for must in core.musts]
            if n in sources and not _follows(graph, when, sources):
                whole = Core([rules[r] for r in core.rules], core.musts)
                _tell(graph, net, whole, n, when, report)


def _follows(graph: BondGraph, when: Expr, sources: list[int]) -> bool:
    """Whether one of the sources is made to depend on the mode."""
    modes = set(symbols(when))
    laws = [law.zero for n in sources for law in graph.nodes[n].laws]
    return any(symbol in modes for law in laws for symbol in symbols(law))


def _tell(
    graph: BondGraph, net: Network, core: Core, junction: int, when: Expr, report: Report
) -> None:
    told = story(graph, net, core)
    node = graph.nodes[junction]
    negated = when.op is Op.LOGIC and when.data == "not"
    mode = f"`{show(when.args[0])}` holds" if negated else f"`{show(when)}` does not hold"
    held = "lets no flow through" if node.kind == "1" else "has no effort"
    message = f"while {mode}, {name(node)} {held}, but then {told.message}"
    report.warning(
        "switch-conflict",
        sentence(message),
        *told.labels,
        help="In that mode there is no machine like this one, and the relations say nothing about "
        "it. Put the R or C into the model that takes up what the source gives, or let the source "
        f"follow the mode: `if({show(when)}, ..., 0)`.",
    )
