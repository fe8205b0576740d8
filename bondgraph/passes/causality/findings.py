"""What is worth knowing about a causality and needs no action: dependent storages, loops."""

from __future__ import annotations

from bondgraph.ir.causal import CausalGraph, Storage
from bondgraph.ir.graph import Node
from bondgraph.library.elements import STORAGES
from bondgraph.passes.causality.causal_paths import Paths
from bondgraph.passes.causality.node_words import listing, name, sentence
from bondgraph.text.diagnostic import Label, Report
from bondgraph.text.source import Span


def report_findings(causal: CausalGraph, paths: Paths, report: Report) -> None:
    """Dependent storages and algebraic loops as information, equal ones counted together."""
    _rings(causal, report)
    _dependent(causal, paths, report)
    _loops(causal, report)


def _rings(causal: CausalGraph, report: Report) -> None:
    """Bonds between junctions that are one junction without them."""
    nodes = causal.graph.nodes
    for bond, stroke in zip(causal.graph.bonds, causal.strokes, strict=True):
        if stroke.reason.cause == "ring":
            # in the order of the model, so that turning the bond changes no word
            a, b = (nodes[n] for n in sorted((bond.tail.node, bond.head.node)))
            what = "flow" if a.kind == "0" else "effort"
            report.warning(
                "junction-ring",
                sentence(
                    f"{name(a)} and {name(b)} are one junction even without this bond: "
                    f"what {what} it carries is not determined"
                ),
                Label(bond.origin, "closes a ring"),
                Label(a.origin, "one end"),
                Label(b.origin, "the other end"),
                help="Leave this bond out; nothing else changes. Or put the R, C or I that lies on "
                "this way into the model.",
            )


def _dependent(causal: CausalGraph, paths: Paths, report: Report) -> None:
    nodes = causal.graph.nodes
    groups: dict[tuple[Span, ...], list[tuple[Storage, list[int]]]] = {}
    for storage in causal.dependent:
        partners = paths.partners(storage)
        key = (nodes[storage.node].origin, *[nodes[p].origin for p in partners[:1]])
        groups.setdefault(key, []).append((storage, partners))
    for group in groups.values():
        storage, partners = group[0]
        node = nodes[storage.node]
        what = "flow" if node.ports[storage.port].stores == "p" else "effort"
        text = f"{_port(node, storage)} is in derivative causality: "
        text += _tie(what, [nodes[p] for p in partners])
        if len(group) > 1:
            text += f"; so {'are' if len(group) > 2 else 'is'} {len(group) - 1} more like it"
        labels = [Label(node.origin, f"takes its {what} from the others")]
        for partner in partners:
            if all(nodes[partner].origin != label.span for label in labels):
                labels.append(Label(nodes[partner].origin, _part(nodes[partner])))
        report.info("dependent-storage", sentence(text), *labels, help=_remedy(nodes, partners))


def _port(node: Node, storage: Storage) -> str:
    port = node.ports[storage.port].name
    return f"port {port} of {name(node)}" if port else name(node)


def _tie(what: str, partners: list[Node]) -> str:
    if not partners:
        return f"its {what} is imposed from outside"
    names = listing([name(p) for p in partners])
    if partners[0].kind in STORAGES:
        verb = "has" if len(partners) == 1 else "have"
        return f"its {what} is fixed by {names}, which {verb} the state"
    return f"its {what} is imposed by {names}"


def _part(partner: Node) -> str:
    return "holds the state" if partner.kind in STORAGES else "imposes it"


def _remedy(nodes: tuple[Node, ...], partners: list[int]) -> str:
    if partners and nodes[partners[0]].kind in STORAGES:
        return (
            "This is no error: these storages share their states. To have them independent, "
            "add the compliance or resistance that lies between them."
        )
    return "This is no error: the storage has no state of its own."


def _loops(causal: CausalGraph, report: Report) -> None:
    nodes = causal.graph.nodes
    groups: dict[tuple[Span, ...], list[tuple[int, ...]]] = {}
    for loop in causal.loops:
        groups.setdefault(tuple(nodes[n].origin for n in loop), []).append(loop)
    for alike in groups.values():
        members = [nodes[n] for n in alike[0]]
        text = f"{listing([name(n) for n in members])} {_circle(members)}"
        if len(alike) > 1:
            text += f"; so {'do' if len(alike) > 2 else 'does'} {len(alike) - 1} more like it"
        labels: dict[Span, Label] = {}
        for node in members[:6]:
            labels.setdefault(node.origin, Label(node.origin, "in the loop"))
        help = "This is no error: the loop is solved as one system of equations."
        report.info("algebraic-loop", sentence(text), *labels.values(), help=help)


def _circle(loop: list[Node]) -> str:
    if loop[0].kind != "R":
        return "form a closed loop without delay: an algebraic loop"
    if len(loop) == 1:
        return "is in an algebraic loop: its answer acts back on it without delay"
    return "form an algebraic loop: each needs what the other answers, without delay"
