"""What is computed from what, by the rules of the books; loops and partners by networkx."""

from __future__ import annotations

import networkx as nx
import pytest

from bondgraph.ir.causal import Storage
from bondgraph.ir.graph import BondGraph
from bondgraph.passes.causality.assign import _free_choices, _placed
from bondgraph.passes.causality.causal_paths import Paths
from bondgraph.passes.causality.rules import demands, network
from tests.unit.passes.causality_graphs import build
from tests.unit.passes.causality_random import SHAPES, random_graph

_STORAGES, _SOURCES = ("C", "I", "IC"), ("Se", "Sf", "De", "Df")


def _paths(graph: BondGraph) -> tuple[Paths, list[int]] | None:
    """The paths of an assignment that has a stroke for every bond, and these strokes."""
    net, at = network(graph)
    musts, wishes = demands(graph, at, "integral")
    strokes = _placed(net, musts, wishes, _free_choices(graph, at))
    if strokes is None or -1 in strokes.value:
        return None
    return Paths(graph, at, strokes), strokes.value


def _computed(graph: BondGraph, strokes: list[int]) -> dict[int, tuple[int, list[int]]]:
    """For each effort 2b and flow 2b + 1 the node that computes it, and from what."""
    ends: list[list[int]] = [[] for _ in graph.nodes]  # bonds at each node
    for b, bond in enumerate(graph.bonds):
        ends[bond.tail.node].append(b)
        ends[bond.head.node].append(b)
    found: dict[int, tuple[int, list[int]]] = {}
    for n, node in enumerate(graph.nodes):
        # the node at the stroke receives the effort and answers with the flow
        receives = {b: (graph.bonds[b].head.node == n) == bool(strokes[b]) for b in ends[n]}
        inputs = {b: 2 * b if receives[b] else 2 * b + 1 for b in ends[n]}
        for b in ends[n]:
            out = 2 * b + 1 if receives[b] else 2 * b
            others = [x for x in ends[n] if x != b]
            if node.kind in ("0", "1"):
                # a 0-junction has its effort from the one bond that it receives it from
                strong = [x for x in ends[n] if receives[x] == (node.kind == "0")]
                made = [inputs[x] for x in (others if b in strong else strong)]
            elif node.kind in ("TF", "GY"):
                made = [inputs[x] for x in others]
            else:
                made = list(inputs.values()) if node.kind == "R" else []
            found[out] = n, sorted(made)
    return found


def _graphs(shape: str) -> list[tuple[BondGraph, Paths, list[int]]]:
    graphs = [random_graph(seed, shape) for seed in range(80)]
    return [(graph, *own) for graph in graphs if (own := _paths(graph)) is not None]


@pytest.mark.parametrize("shape", SHAPES)
def test_each_variable_is_computed_as_the_books_say(shape: str) -> None:
    found = _graphs(shape)
    assert len(found) > 5
    for graph, paths, strokes in found:
        made = _computed(graph, strokes)
        assert len(made) == 2 * len(graph.bonds)
        for variable, (node, sources) in made.items():
            assert paths.maker(variable) == node
            assert sorted(paths.sources(variable)) == sources


@pytest.mark.parametrize("shape", SHAPES)
def test_loops_are_what_goes_around(shape: str) -> None:
    loops = 0
    for graph, paths, strokes in _graphs(shape):
        made = _computed(graph, strokes)
        net = nx.DiGraph([(v, w) for v, (_, sources) in made.items() for w in sources])
        expected = []
        for part in nx.strongly_connected_components(net):
            if len(part) > 1:
                makers = sorted({made[v][0] for v in part})
                losses = tuple(n for n in makers if graph.nodes[n].kind == "R")
                expected.append(losses or tuple(makers))
        assert paths.loops() == sorted(expected)
        loops += len(expected)
    assert loops > 0 or shape == "trees"


@pytest.mark.parametrize("shape", SHAPES)
def test_partners_are_the_storages_or_else_the_sources_that_are_met(shape: str) -> None:
    told = 0
    for graph, paths, strokes in _graphs(shape):
        made = _computed(graph, strokes)
        net = nx.DiGraph([(v, w) for v, (_, sources) in made.items() for w in sources])
        net.add_nodes_from(made)
        for b, bond in enumerate(graph.bonds):
            for end, at_head in ((bond.tail, False), (bond.head, True)):
                if graph.nodes[end.node].kind not in _STORAGES:
                    continue
                received = 2 * b if bool(strokes[b]) == at_head else 2 * b + 1
                makers = [made[v][0] for v in (received, *nx.descendants(net, received))]
                kinds = {n: graph.nodes[n].kind for n in makers if n != end.node}
                others = {n for n, kind in kinds.items() if kind in _STORAGES}
                sources = {n for n, kind in kinds.items() if kind in _SOURCES}
                partners = paths.partners(Storage(end.node, end.port, False))
                assert len(set(partners)) == len(partners), "one of several ports is met again"
                if not others or len(partners) < 4:
                    assert set(partners) == (others or sources)
                else:
                    assert set(partners) <= others and len(partners) == 4
                told += len(partners) > 1
    assert told > 0


def test_the_nearest_partners_are_named_first_and_four_of_them() -> None:
    """A chain of masses on levers: the last one has to move as the first, and the others."""
    chain = "; ".join(f"v{k} -> TF:t{k} -> 1:v{k + 1}; v{k + 1} -> I:m{k + 1}" for k in range(6))
    graph = build(f"Se:u -> 1:v0; v0 -> I:m0; {chain}")
    own = _paths(graph)
    assert own is not None
    paths, strokes = own
    place = {node.path: n for n, node in enumerate(graph.nodes)}
    ports = {
        graph.nodes[end.node].path: (end.port, at_head == bool(strokes[b]))
        for b, bond in enumerate(graph.bonds)
        for end, at_head in ((bond.tail, False), (bond.head, True))
    }
    masses = [f"m{k}" for k in range(7)]
    (state,) = [name for name in masses if ports[name][1]]  # with the effort at it
    for name in masses:
        partners = paths.partners(Storage(place[name], ports[name][0], False))
        if name == state:  # its effort is what all others, and the source, leave of it
            near = sorted(masses, key=lambda m: abs(int(m[1]) - int(name[1])))[1:]
            assert {graph.nodes[n].path for n in partners} <= set(near[:5]) and len(partners) == 4
        else:
            assert [graph.nodes[n].path for n in partners] == [state]
