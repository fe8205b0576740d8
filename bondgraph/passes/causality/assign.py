"""Causality: which end of each bond receives the effort, and why.

Sequential assignment by worklist (SCAP; Karnopp, Margolis and Rosenberg): sources and sensors,
then what storages prefer, then laws that are better evaluated one way, then free choices, each
with all that follows from it. Where that meets a dead end it is done again with an exact test
before each step, so that the result is always feasible if anything is, and grants as many
preferences as any assignment could.
"""

from __future__ import annotations

from bondgraph.ir.causal import CausalGraph, Preference, Reason, Storage, Stroke
from bondgraph.ir.graph import BondGraph
from bondgraph.passes.causality.causal_paths import Paths
from bondgraph.passes.causality.cores import oblige
from bondgraph.passes.causality.findings import report_findings
from bondgraph.passes.causality.repair import Matching
from bondgraph.passes.causality.rules import Network, Wish, demands, network
from bondgraph.passes.causality.strokes import Strokes
from bondgraph.text.diagnostic import Report


def assign(graph: BondGraph, preference: Preference, report: Report) -> CausalGraph | None:
    """Place the causal strokes of a bond graph; None (with errors in the report) if impossible.

    The number of storages in the preferred causality is the largest possible, and among these
    assignments as many laws as possible are used in the direction in which they are written. In
    derivative preference the detectors are dualised first, in the order of the model. Errors:
    `causality-conflict`. With integral preference, dependent storages and algebraic loops are
    reported as information.
    """
    net, at = network(graph)
    musts, wishes = demands(graph, at, preference)
    free = _free_choices(graph, at)
    strokes = _placed(net, musts, wishes, free)
    switched = any(node.when is not None for node in graph.nodes)
    together = strokes is not None  # an assignment serves all switched junctions at once
    if switched and not (together and _ever_together(graph)):
        strokes = _in_a_mode(graph, net, musts, wishes, free) or strokes
    if strokes is None:
        _refuse(graph, report)
        return None
    for b, bond in enumerate(graph.bonds):
        if strokes.value[b] < 0:  # a bond that no rule and no wish speaks of
            later = max(bond.head.node, bond.tail.node)
            ring = graph.nodes[later].kind in ("0", "1")
            value = int(bond.head.node > bond.tail.node)
            strokes.put(b, value, Reason("ring" if ring else "chosen", later))
    paths = Paths(graph, at, strokes)
    result = _result(graph, preference, strokes, wishes, tuple(paths.loops()))
    if preference == "integral":
        report_findings(result, paths, report)
        if switched:
            from bondgraph.passes.causality.switches import report_settings, report_switches

            (report_switches if together else report_settings)(graph, net, musts, report)
    return result


def _placed(
    net: Network, musts: list[Wish], wishes: list[Wish], free: list[Wish]
) -> Strokes | None:
    """The best assignment under the demands `musts`, None where there is no assignment."""
    strokes = Strokes(net)
    if oblige(strokes, musts) is not None:
        return None
    if _greedy(strokes, wishes + free):
        return strokes
    return _exact(net, musts, wishes, free, hint=strokes.value)


def _in_a_mode(
    graph: BondGraph, net: Network, musts: list[Wish], wishes: list[Wish], free: list[Wish]
) -> Strokes | None:
    """An assignment for the first setting of the switches that allows one.

    Ideal switches take turns: the transistor and the diode of a converter are never on together,
    and no assignment serves both.
    """
    from bondgraph.passes.causality.switches import held, settings

    for _, off in settings(graph):
        part, imposed = held(net, off)
        strokes = _placed(part, [*imposed, *musts], wishes, free)
        if strokes is not None:
            return strokes
    return None


def _ever_together(graph: BondGraph) -> bool:
    """Whether some setting of the switches has all switched junctions on."""
    from bondgraph.passes.causality.switches import settings

    return any(not off for _, off in settings(graph))


def _refuse(graph: BondGraph, report: Report) -> None:
    from bondgraph.passes.causality.conflicts import conflicts  # sound models do not wait for it

    for conflict in conflicts(graph):
        report.add(conflict.finding)


def _free_choices(graph: BondGraph, at: list[list[int]]) -> list[Wish]:
    """An R may answer with effort or flow: as its law is written, else with effort."""
    free = []
    for n, node in enumerate(graph.nodes):
        if node.kind != "R":
            continue
        for end in at[n]:
            bond = graph.bonds[end >> 1]
            port = (bond.head if end & 1 else bond.tail).port
            flow = any(law.direction is node.ports[port].flow for law in node.laws)
            free.append(Wish(end >> 1, end & 1 if flow else 1 - (end & 1), n, port, "chosen"))
    return free


def _greedy(strokes: Strokes, wishes: list[Wish]) -> bool:
    """Grant what is still open, one wish after the other; False at a dead end."""
    for wish in wishes:
        if strokes.value[wish.bond] < 0 and strokes.wish(wish) is not None:
            return False
    for rule, ends in enumerate(strokes.net.ends):
        if strokes.taken[rule] < 0:
            end = next(e for e in ends if strokes.value[e >> 1] < 0)
            reason = Reason("chosen", strokes.net.name[rule])
            if strokes.put(end >> 1, strokes.net.strong[end], reason) is not None:
                return False
    return True


def _exact(
    net: Network, musts: list[Wish], wishes: list[Wish], free: list[Wish], hint: list[int]
) -> Strokes | None:
    """The same with a complete assignment at hand that is turned before each step if it can be."""
    strokes = Strokes(net)
    oblige(strokes, musts)
    witness = Matching(strokes, hint)
    if not witness.complete():
        return None
    for wish in wishes:
        if strokes.value[wish.bond] >= 0:
            continue
        if witness.turn(wish.bond, wish.value):
            strokes.wish(wish)
        else:
            strokes.put(wish.bond, 1 - wish.value, _refusal(strokes, witness, wish))
        witness.fix(strokes)
    for wish in free:
        if strokes.value[wish.bond] < 0:
            loose = wish.bond in witness.loose
            strokes.wish(wish if loose else wish._replace(value=witness.value(wish.bond)))
    for rule, ends in enumerate(net.ends):
        for end in ends:
            if strokes.value[end >> 1] < 0:
                value = witness.value(end >> 1)
                strokes.put(end >> 1, value, Reason("chosen", net.name[rule]))
    return strokes


def _refusal(strokes: Strokes, witness: Matching, wish: Wish) -> Reason:
    """Why a wish was refused: the settled strokes around the rules that it would leave open."""
    net = strokes.net
    around = {
        end >> 1
        for rule in witness.tree
        if rule < witness.rules
        for end in net.ends[rule]
        if strokes.value[end >> 1] >= 0
    }
    rule = max(net.rule[2 * wish.bond], net.rule[2 * wish.bond + 1])
    return Reason("propagated", net.name[rule], tuple(sorted(around)))


def _result(
    graph: BondGraph,
    preference: Preference,
    strokes: Strokes,
    wishes: list[Wish],
    loops: tuple[tuple[int, ...], ...],
) -> CausalGraph:
    placed = [
        Stroke("head" if value else "tail", reason)
        for value, reason in zip(strokes.value, strokes.reason, strict=True)
        if reason is not None
    ]
    storages = []
    granted: list[int] = []
    refused: list[int] = []
    for wish in wishes:
        given = strokes.value[wish.bond] == wish.value
        if wish.cause == "preferred":
            storages.append(Storage(wish.node, wish.port, given == (preference == "integral")))
        elif wish.cause == "sensor":
            (granted if given else refused).append(wish.node)
    return CausalGraph(
        graph,
        preference,
        tuple(placed),
        tuple(storages),
        tuple(granted),
        tuple(refused),
        loops,
    )
