"""Causality against exhaustive search and against matching by networkx, on random graphs."""

from __future__ import annotations

import networkx as nx
from hypothesis import given, settings
from hypothesis import strategies as st

from bondgraph.ir.causal import CausalGraph
from bondgraph.ir.expr import Pool
from bondgraph.ir.graph import BondGraph
from bondgraph.passes.causality.assign import assign
from bondgraph.passes.causality.cores import cores, refute, restrict
from bondgraph.passes.causality.rules import demands, network
from bondgraph.text.diagnostic import Report
from bondgraph.text.source import Source, Span
from tests.unit.passes.causality_graphs import (
    all_assignments,
    assemble,
    broken_rules,
    build,
    integral_storages,
    superfluous,
    turned,
)

ELEMENTS = ["R", "C", "I", "Se", "Sf", "De", "Df", "R!"]


@st.composite
def graphs(draw: st.DrawFn, junctions: int = 6, leaves: int = 6, loops: int = 3) -> BondGraph:
    """Junctions and two-ports in a random tree, closed to loops, with elements at them."""
    source = Source("random.bg", "x" * 99)
    kinds: list[tuple[str, str, bool, Span]] = []
    bonds: list[tuple[int, int, Span]] = []

    def node(kind: str) -> int:
        n = len(kinds)
        kinds.append((kind.strip("!"), f"n{n}", kind == "R!", Span(source, n, n + 1)))
        return n

    def bond(a: int, b: int) -> None:
        pair = (a, b) if draw(st.booleans()) else (b, a)
        bonds.append((*pair, Span(source, 0, 1)))

    def link(a: int, b: int) -> None:
        between = draw(st.sampled_from(["", "", "TF", "GY"]))
        if between:
            middle = node(between)
            bond(a, middle)
            bond(middle, b)
        else:
            bond(a, b)

    count = draw(st.integers(1, junctions))
    spots = [node(draw(st.sampled_from(["0", "1"])))]
    for _ in range(count - 1):
        other = draw(st.sampled_from(spots))
        spots.append(node(draw(st.sampled_from(["0", "1"]))))
        link(other, spots[-1])
    for _ in range(draw(st.integers(0, loops))):
        link(draw(st.sampled_from(spots)), draw(st.sampled_from(spots)))
    for _ in range(draw(st.integers(0, leaves))):
        link_to = draw(st.sampled_from(spots))
        bond(link_to, node(draw(st.sampled_from(ELEMENTS))))
    return assemble(source, Pool(), kinds, bonds)


def small(graph: BondGraph) -> bool:
    return len(graph.bonds) <= 11


def strokes(causal: CausalGraph) -> tuple[int, ...]:
    return tuple(int(s.at == "head") for s in causal.strokes)


@settings(max_examples=250, deadline=None)
@given(graphs(4, 5, 2).filter(small))
def test_feasible_and_optimal_like_exhaustive_search(graph: BondGraph) -> None:
    possible = all_assignments(graph)
    report = Report()
    causal = assign(graph, "integral", report)
    if causal is None:
        assert not possible
        assert report.failed
        return
    assert not report.failed
    mine = strokes(causal)
    assert mine in possible
    best = max(integral_storages(graph, s) for s in possible)
    assert integral_storages(graph, mine) == best
    assert best == sum(s.integral for s in causal.storages)


@settings(max_examples=150, deadline=None)
@given(graphs(4, 5, 2).filter(small))
def test_one_way_laws_come_third(graph: BondGraph) -> None:
    possible = all_assignments(graph)
    if not possible:
        return
    one_way = {
        n
        for n, node in enumerate(graph.nodes)
        if node.laws and node.laws[0].direction is node.ports[0].flow
    }

    def score(s: tuple[int, ...]) -> tuple[int, int]:
        obeyed = sum(
            (b.head.node in one_way and at == 1) or (b.tail.node in one_way and at == 0)
            for b, at in zip(graph.bonds, s, strict=True)
        )
        return integral_storages(graph, s), obeyed

    causal = assign(graph, "integral", Report())
    assert causal is not None
    assert score(strokes(causal)) == max(map(score, possible))


@settings(max_examples=200, deadline=None)
@given(graphs(4, 5, 2).filter(small))
def test_detectors_are_dualised_in_order(graph: BondGraph) -> None:
    detectors = [n for n, node in enumerate(graph.nodes) if node.kind in ("De", "Df")]
    causal = assign(graph, "derivative", Report())
    free = graph._replace(
        nodes=tuple(
            n._replace(kind="R", keyword="R") if n.kind in ("De", "Df") else n for n in graph.nodes
        )
    )
    possible = all_assignments(free)
    if causal is None:
        assert not possible
        return
    assert not broken_rules(graph, strokes(causal), set(causal.dualised))
    assert sorted(causal.dualised + causal.not_dualised) == detectors

    def score(s: tuple[int, ...]) -> tuple[list[bool], int]:
        dual = []
        for bond, at in zip(graph.bonds, s, strict=True):
            for end, here in ((bond.tail, at == 0), (bond.head, at == 1)):
                if end.node in detectors:
                    dual.append((end.node, here == (graph.nodes[end.node].kind == "Df")))
        count = sum(n.kind in ("C", "I") for n in graph.nodes)
        return [d for _, d in sorted(dual)], count - integral_storages(graph, s)

    assert score(strokes(causal)) == max(map(score, possible))


@settings(max_examples=100, deadline=None)
@given(graphs(14, 14, 6))
def test_optimal_like_maximum_weight_matching(graph: BondGraph) -> None:
    best = _matching_optimum(graph)
    causal = assign(graph, "integral", Report())
    if causal is None:
        assert best is None
        return
    assert not broken_rules(graph, strokes(causal), set())
    assert integral_storages(graph, strokes(causal)) == best


@settings(max_examples=150, deadline=None)
@given(graphs(10, 10, 4), st.randoms(use_true_random=False))
def test_reversed_bonds_change_nothing(graph: BondGraph, random: object) -> None:
    which = {b for b in range(len(graph.bonds)) if random.random() < 0.5}  # type: ignore[attr-defined]
    loops = {b for b, bond in enumerate(graph.bonds) if bond.tail.node == bond.head.node}
    one, two = Report(), Report()
    first = assign(graph, "integral", one)
    second = assign(turned(graph, which - loops), "integral", two)
    assert [d.message for d in one.diagnostics] == [d.message for d in two.diagnostics]
    assert (first is None) == (second is None)
    if first is None or second is None:
        return
    assert first.storages == second.storages
    assert first.loops == second.loops
    for b, (s, t) in enumerate(zip(first.strokes, second.strokes, strict=True)):
        assert s.reason == t.reason
        assert (s.at == t.at) == (b not in which - loops)


@settings(max_examples=200, deadline=None)
@given(graphs(8, 8, 3))
def test_conflict_cores_are_irreducible(graph: BondGraph) -> None:
    net, at = network(graph)
    musts, _ = demands(graph, at, "integral")
    for rules, wanted in cores(net, musts):
        assert refute(*restrict(net, rules, wanted)) is not None
        for gone in rules:
            assert refute(*restrict(net, [r for r in rules if r != gone], wanted)) is None
        for gone_too in wanted:
            fewer = [w for w in wanted if w != gone_too]
            assert refute(*restrict(net, rules, fewer)) is None


@settings(max_examples=150, deadline=None)
@given(graphs(8, 8, 3))
def test_every_stroke_has_a_reason_that_holds(graph: BondGraph) -> None:
    causal = assign(graph, "integral", Report())
    if causal is None:
        return
    for b, stroke in enumerate(causal.strokes):
        ends = (graph.bonds[b].tail.node, graph.bonds[b].head.node)
        node, because = graph.nodes[stroke.reason.node], stroke.reason.because
        match stroke.reason.cause:
            case "source":
                assert node.kind in ("Se", "Sf")
            case "sensor":
                assert node.kind in ("De", "Df")
            case "preferred":
                assert node.kind in ("C", "I")
            case "law":
                assert node.kind == "R"
            case "propagated":
                assert node.kind in ("0", "1", "TF", "GY")
                assert b not in because
            case _:
                assert not because
        if stroke.reason.cause != "propagated":
            assert stroke.reason.node in ends or node.kind in ("0", "1", "TF", "GY")


def test_a_triangle_of_gyrators_needs_a_blossom() -> None:
    # three 1-junctions in a ring of gyrators: an odd cycle, so one flow must come from elsewhere
    ring = "1:a -> GY:x -> 1:b -> GY:y -> 1:c -> GY:z -> a"
    assert assign(build(ring), "integral", Report()) is None
    assert assign(build(ring + "; a -> R:r"), "integral", Report()) is not None
    causal = assign(build(ring + "; a -> I:r; b -> I:s; c -> I:t"), "integral", Report())
    assert causal is not None
    assert all(s.integral for s in causal.storages)


def _matching_optimum(graph: BondGraph) -> int | None:
    """The largest number of integral storages, as a maximum weight matching (None: infeasible).

    One vertex per junction or two-port; a bond whose ends disagree gets a middle vertex, another
    one two (so that either choice covers them); an element end is an optional vertex. Covering a
    vertex that must be weighs more than all demands, a demand more than all preferences.
    """
    demand, cover = 10**3, 10**6
    work: nx.Graph = nx.Graph()
    needed: set[object] = {
        ("rule", n) for n, node in enumerate(graph.nodes) if node.kind in ("0", "1", "TF", "GY")
    }
    edges: list[tuple[object, object, int]] = []
    gyrators: set[int] = set()
    idle = superfluous(graph)
    for b, bond in enumerate(graph.bonds):
        if b in idle:
            continue
        sides: list[tuple[object, int]] = []
        gain = [0, 0]
        for end, here in ((bond.tail, 0), (bond.head, 1)):
            kind = graph.nodes[end.node].kind
            gain[here] += {
                "Se": -demand,
                "Sf": demand,
                "De": demand,
                "Df": -demand,
                "I": 1,
                "C": -1,
            }.get(kind, 0)
            if kind in ("0", "1", "TF", "GY"):
                stroke_is_strong = kind in ("0", "TF") or (kind == "GY" and end.node in gyrators)
                gyrators |= {end.node} if kind == "GY" else set()
                sides.append((("rule", end.node), here if stroke_is_strong else 1 - here))
        first, second = ("mid", b, 0), ("mid", b, 1)
        needed.add(first)
        if len(sides) == 1:
            ((x, strong),) = sides
            edges += [(x, first, gain[strong]), (first, second, gain[1 - strong])]
            continue
        (x, strong_x), (y, strong_y) = sides
        if strong_x == strong_y:
            needed.add(second)
            edges += [(x, first, 0), (first, second, 0), (second, y, 0)]
        elif x != y:
            edges += [(x, first, 0), (first, y, 0)]
        else:  # a bond from a junction to itself is always its one strong bond
            edges += [(x, first, 0)]
    work.add_nodes_from(sorted(needed))
    for x, y, value in edges:
        work.add_edge(x, y, weight=cover * ((x in needed) + (y in needed)) + value)
    found = nx.max_weight_matching(work)
    value = sum(work.edges[e]["weight"] for e in found) - cover * len(needed)
    kinds = [n.kind for n in graph.nodes]
    value -= demand * sum(k in ("Sf", "De") for k in kinds)  # what a kept demand gives
    best = value + kinds.count("C")
    return best if 0 <= best <= kinds.count("C") + kinds.count("I") else None
