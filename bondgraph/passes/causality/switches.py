"""Switched junctions: which can be off together, and what the sources forbid."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import product

from bondgraph.ir.expr import Expr, Op, symbols
from bondgraph.ir.graph import BondGraph
from bondgraph.notation.line import show
from bondgraph.passes.causality.cores import Core, cores, refute
from bondgraph.passes.causality.explanation import explanation
from bondgraph.passes.causality.node_words import name, sentence
from bondgraph.passes.causality.rules import Network, Wish
from bondgraph.text.diagnostic import Report

_MOST = 40  # junctions tried
_SETTINGS = 8  # conditions of which every setting is tried

#: What switches, with its value: (on, True) for the mode `on`.
Setting = tuple[tuple[Expr, bool], ...]


def settings(graph: BondGraph) -> Iterator[tuple[Setting, frozenset[int]]]:
    """Every setting of what switches junctions, those with most conditions true first.

    With each the junctions that are off then. Two junctions of the conditions `on` and `not on`
    are never off together, nor on.
    """
    switched = [(n, node.when) for n, node in enumerate(graph.nodes) if node.when is not None]
    atoms = list(dict.fromkeys(a for _, when in switched for a in _atoms(when)))[:_SETTINGS]
    for values in product((True, False), repeat=len(atoms)):
        setting = tuple(zip(atoms, values, strict=True))
        truth = dict(setting)
        yield setting, frozenset(n for n, when in switched if not _holds(when, truth))


def _atoms(when: Expr) -> Iterator[Expr]:
    if when.op is Op.LOGIC:
        for arg in when.args:
            yield from _atoms(arg)
    else:
        yield when


def _holds(when: Expr, truth: dict[Expr, bool]) -> bool:
    if when.op is not Op.LOGIC:
        return truth.get(when, True)
    held = [_holds(arg, truth) for arg in when.args]
    if when.data == "not":
        return not held[0]
    return all(held) if when.data == "and" else any(held)


def held(net: Network, off: frozenset[int]) -> tuple[Network, list[Wish]]:
    """The rules while some switched junctions are off, and what these then impose on their bonds.

    Off, a 1-junction gives the flow zero to all its bonds, a 0-junction the effort zero.
    """
    rules = [rule for rule, n in enumerate(net.name) if n not in off]
    part, _ = net.part(rules, list(range(net.bonds)))
    imposed = [
        Wish(end >> 1, 1 - net.strong[end], n, -1, "switched")
        for rule, n in enumerate(net.name)
        if n in off
        for end in net.ends[rule]
    ]
    return part, imposed


def sound_in_a_mode(graph: BondGraph, net: Network, musts: list[Wish]) -> bool:
    """Whether a graph with switched junctions has an assignment for some setting of them."""
    if all(node.when is None for node in graph.nodes):
        return False
    for _, off in settings(graph):
        part, imposed = held(net, off)
        if refute(part, [*imposed, *musts]) is None:
            return True
    return False


def report_settings(graph: BondGraph, net: Network, musts: list[Wish], report: Report) -> None:
    """A warning for the first setting of the switches that the sources forbid.

    For a plant whose junctions cannot all be on at once; in most such plants they never are, and
    every setting is sound.
    """
    for setting, off in settings(graph):
        part, imposed = held(net, off)
        for core in cores(part, [*imposed, *musts], most=1):
            told = explanation(graph, part, core)
            inside = set(core.nodes(part))
            whens = [graph.nodes[n].when for n in sorted(inside)]
            own = {a for when in whens if when is not None for a in _atoms(when)}
            modes = " and ".join(
                f"`{show(a)}` {'holds' if value else 'does not hold'}"
                for a, value in setting
                if a in own
            )
            report.warning(
                "switch-conflict",
                sentence(f"while {modes}, {told.message}"),
                *told.labels,
                help="In that mode there is no machine like this one, and the relations say "
                "nothing about it. Where the machine never is in it, nothing is wrong.",
            )
            return


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
    told = explanation(graph, net, core)
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
