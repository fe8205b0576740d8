"""Bond graphs from a line of text each, without the front end, and the causal rules spelled out."""

from __future__ import annotations

import itertools
import re
from typing import Literal

import networkx as nx

from bondgraph.ir.causal import CausalGraph
from bondgraph.ir.expr import Kind, Pool
from bondgraph.ir.graph import Bond, BondGraph, End, Law, Node, Port
from bondgraph.text.source import Source, Span

_NODE = re.compile(r"(\w+):(\w+)(!?)")
_ARROW = re.compile(r"\s*(->|<-)\s*")


_STORES: dict[str, Literal["q", "p"]] = {"C": "q", "I": "p"}


def build(text: str) -> BondGraph:
    """A graph from chains `Se:u -> 1:a -> R:r; a -> I:l`.

    A name is declared where it first comes with its type. `R:r!` has the law f = k ssq(e), which
    is better evaluated to give flow. Two-ports get port 1 where a bond enters, 2 where one leaves.
    """
    source = Source("test.bg", text)
    pool = Pool()
    where: dict[str, int] = {}
    kinds: list[tuple[str, str, bool, Span]] = []
    bonds: list[tuple[int, int, Span]] = []
    for chain in re.finditer(r"[^;\n]+", text):
        parts = _ARROW.split(chain.group().strip())
        spots = []
        for part in parts[::2]:
            match = _NODE.fullmatch(part)
            name = match[2] if match else part
            if match:
                assert name not in where, name
                start = text.index(part, chain.start())
                where[name] = len(kinds)
                span = Span(source, start, start + len(part))
                kinds.append((match[1], name, match[3] == "!", span))
            spots.append(where[name])
        for left, arrow, right in zip(spots, parts[1::2], spots[1:], strict=False):
            tail, head = (left, right) if arrow == "->" else (right, left)
            bonds.append((tail, head, Span(source, chain.start(), chain.end())))
    return assemble(source, pool, kinds, bonds)


def assemble(
    source: Source,
    pool: Pool,
    kinds: list[tuple[str, str, bool, Span]],
    bonds: list[tuple[int, int, Span]],
) -> BondGraph:
    """The graph of these nodes (kind, name, one-way law) and bonds (tail, head)."""
    used: dict[int, dict[int, tuple[int, bool]]] = {}
    for b, (tail, head, _) in enumerate(bonds):
        used.setdefault(head, {})[2 * b + 1] = (0, True)
        used.setdefault(tail, {})[2 * b] = (1, True)
    port_of: dict[int, int] = {}
    for n, (kind, *_rest) in enumerate(kinds):
        ends = list(used.get(n, {}))
        if kind in ("TF", "GY"):
            order = sorted(ends, key=lambda e: (e % 2 == 0, e))
            port_of.update({e: i for i, e in enumerate(order)})
        elif kind not in ("0", "1"):
            port_of.update({e: i for i, e in enumerate(sorted(ends))})
    nodes = []
    for n, (kind, name, one_way, span) in enumerate(kinds):
        sizes = max([port_of[e] + 1 for e in used.get(n, {}) if e in port_of], default=0)
        ports = tuple(
            Port(
                str(i + 1) if sizes > 1 else "",
                pool.symbol(f"{name}.e{i}", Kind.EFFORT),
                pool.symbol(f"{name}.f{i}", Kind.FLOW),
                _STORES.get(kind, ""),
            )
            for i in range(sizes)
        )
        laws: tuple[Law, ...] = ()
        if kind == "R" and ports:
            k = pool.symbol(f"{name}.k", Kind.PARAM)
            if one_way:
                right = pool.mul(k, pool.fn("ssq", ports[0].effort))
                laws = (Law(pool.sub(ports[0].flow, right), ports[0].flow, span),)
            else:
                right = pool.mul(k, ports[0].flow)
                laws = (Law(pool.sub(ports[0].effort, right), ports[0].effort, span),)
        nodes.append(Node(name, kind, kind, ports, laws, None, None, None, None, "", span))
    made = tuple(
        Bond(
            b + 1,
            None,
            End(tail, port_of.get(2 * b, -1), 1, 1),
            End(head, port_of.get(2 * b + 1, -1), 1, 1),
            span,
        )
        for b, (tail, head, span) in enumerate(bonds)
    )
    return BondGraph("Test", source, "", pool, tuple(nodes), made, (), (), (), (), (), ())


def turned(graph: BondGraph, which: set[int]) -> BondGraph:
    """The same graph with some bonds drawn the other way round."""
    bonds = tuple(
        b._replace(tail=b.head, head=b.tail) if i in which else b for i, b in enumerate(graph.bonds)
    )
    return graph._replace(bonds=bonds)


def receivers(causal: CausalGraph) -> list[int]:
    """The node that receives the effort of each bond."""
    return [
        (b.head if s.at == "head" else b.tail).node
        for b, s in zip(causal.graph.bonds, causal.strokes, strict=True)
    ]


def superfluous(graph: BondGraph) -> set[int]:
    """The bonds between like junctions that earlier bonds have made one: they obey no rule."""
    one: nx.Graph = nx.Graph()
    found = set()
    for b, bond in enumerate(graph.bonds):
        tail, head = bond.tail.node, bond.head.node
        one.add_nodes_from((tail, head))
        kinds = {graph.nodes[tail].kind, graph.nodes[head].kind}
        if kinds in ({"0"}, {"1"}):
            if nx.has_path(one, tail, head):
                found.add(b)
            one.add_edge(tail, head)
    return found


def broken_rules(graph: BondGraph, strokes: tuple[int, ...], dualised: set[int]) -> list[int]:
    """The nodes whose rule the strokes (0 at the tail, 1 at the head) break, as the books say."""
    takes_effort: list[list[bool]] = [[] for _ in graph.nodes]
    idle = superfluous(graph)
    for b, (bond, at) in enumerate(zip(graph.bonds, strokes, strict=True)):
        if b in idle:
            continue
        takes_effort[bond.tail.node].append(at == 0)
        takes_effort[bond.head.node].append(at == 1)
    broken = []
    for n, node in enumerate(graph.nodes):
        efforts_in = sum(takes_effort[n])
        flows_in = len(takes_effort[n]) - efforts_in
        good = {
            "0": efforts_in == 1,
            "1": flows_in == 1,
            "TF": efforts_in == 1 and flows_in == 1,
            "GY": efforts_in in (0, 2) and flows_in in (0, 2),
            "Se": efforts_in == 0,
            "Sf": flows_in == 0,
            "De": (efforts_in == 0) if n in dualised else (flows_in == 0),
            "Df": (flows_in == 0) if n in dualised else (efforts_in == 0),
        }.get(node.kind, True)
        if not good:
            broken.append(n)
    return broken


def integral_storages(graph: BondGraph, strokes: tuple[int, ...]) -> int:
    """How many storage ports are in integral causality."""
    good = 0
    for bond, at in zip(graph.bonds, strokes, strict=True):
        for end, here in ((bond.tail, at == 0), (bond.head, at == 1)):
            kind = graph.nodes[end.node].kind
            good += (kind == "I" and here) or (kind == "C" and not here)
    return good


def all_assignments(graph: BondGraph) -> list[tuple[int, ...]]:
    """Every assignment that keeps all rules, by trying all of them."""
    return [
        strokes
        for strokes in itertools.product((0, 1), repeat=len(graph.bonds))
        if not broken_rules(graph, strokes, set())
    ]
