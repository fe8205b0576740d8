"""Causality against exact SAT and MaxSAT solvers: feasible or not, optimal, cores irreducible."""

from __future__ import annotations

from functools import cache
from random import Random

import pytest

from bondgraph.compilation import Compilation
from bondgraph.ir.causal import CausalGraph
from bondgraph.ir.graph import BondGraph
from bondgraph.passes.causality.assign import assign
from bondgraph.passes.causality.cores import cores
from bondgraph.passes.causality.rules import demands, network
from bondgraph.text.diagnostic import CompileError, Report
from bondgraph.text.source import Source
from tests.random.graphs import generate
from tests.unit.passes.causality_graphs import build
from tests.unit.passes.causality_random import SHAPES, random_graph
from tests.unit.passes.causality_sat import (
    answering_flow,
    dualised,
    first_fit,
    hard,
    integral,
    modes,
    most,
    satisfiable,
)

COUNT = 150
DETECTORS = frozenset({"De", "Df"})


@cache
def graphs(shape: str) -> tuple[BondGraph, ...]:
    return tuple(random_graph(seed, shape) for seed in range(COUNT))


def one_way(graph: BondGraph) -> list[int]:
    """The elements whose law is better evaluated to give flow."""
    return [
        n
        for n, node in enumerate(graph.nodes)
        if node.laws and node.laws[0].direction is node.ports[0].flow
    ]


def holds(causal: CausalGraph, literals: list[int]) -> list[bool]:
    """Which literals our strokes make true."""
    at_head = [s.at == "head" for s in causal.strokes]
    return [at_head[abs(x) - 1] == (x > 0) for x in literals]


def keeps(causal: CausalGraph, clauses: list[list[int]]) -> bool:
    return all(any(holds(causal, clause)) for clause in clauses)


@pytest.mark.parametrize("shape", SHAPES)
def test_integral_causality_is_feasible_and_optimal(shape: str) -> None:
    for graph in graphs(shape):
        clauses = hard(graph)
        groups = [integral(graph), answering_flow(graph, one_way(graph))]
        best = most(clauses, groups)
        causal = assign(graph, "integral", Report())
        assert (causal is None) == (best is None)
        if causal is not None:
            assert keeps(causal, clauses)
            assert [sum(holds(causal, group)) for group in groups] == best
            assert [s.integral for s in causal.storages].count(True) == sum(
                holds(causal, integral(graph))
            )


@pytest.mark.parametrize("shape", SHAPES)
def test_derivative_causality_dualises_and_differentiates_the_most(shape: str) -> None:
    for graph in graphs(shape):
        clauses = hard(graph, free=DETECTORS)
        derivative = [-x for x in integral(graph)]
        groups = [dualised(graph), derivative, answering_flow(graph, one_way(graph))]
        best = most(clauses, groups)
        causal = assign(graph, "derivative", Report())
        assert (causal is None) == (best is None)
        if causal is None:
            continue
        assert keeps(causal, clauses)
        assert [sum(holds(causal, group)) for group in groups] == best
        given = holds(causal, dualised(graph))
        assert given == first_fit(clauses, dualised(graph))  # in the order of the model
        assert len(causal.dualised) == sum(given)
        assert len(causal.not_dualised) == len(given) - sum(given)


def members(graph: BondGraph) -> list[list[int]]:
    """The nodes of each core that our engine finds."""
    net, at = network(graph)
    musts, _ = demands(graph, at, "integral")
    return [
        [net.name[rule] for rule in core.rules] + [must.node for must in core.musts]
        for core in cores(net, musts)
    ]


@pytest.mark.parametrize("shape", SHAPES)
def test_every_core_is_a_conflict_and_loses_it_with_each_member(shape: str) -> None:
    found = 0
    for graph in graphs(shape):
        rest = set(range(len(graph.nodes)))
        for core in members(graph):
            found += 1
            assert not satisfiable(graph, core)
            for gone in core:
                assert satisfiable(graph, [n for n in core if n != gone])
            assert rest >= set(core)  # independent of the cores before
            rest -= set(core)
        assert satisfiable(graph, sorted(rest))  # no conflict is left untold
    assert found > COUNT / 10


@pytest.mark.parametrize("block", range(4))
def test_models_from_text_have_the_most_states_and_derivatives(block: int) -> None:
    for seed in range(40 * block, 40 * (block + 1)):
        source = Source("random.bg", generate(Random(seed)).text)
        try:
            graph = Compilation(source).graph
        except CompileError as error:  # the text is refused for another reason
            assert all(d.code != "causality-conflict" for d in error.diagnostics)
            continue
        plain = assign(graph, "integral", Report())
        best = possible(graph, frozenset(), [integral(graph)])
        assert (plain is None) == (not best)
        if plain is not None:
            assert [sum(s.integral for s in plain.storages)] in best
        derivative = [-x for x in integral(graph)]
        best = possible(graph, DETECTORS, [dualised(graph), derivative])
        other = assign(graph, "derivative", Report())
        assert (other is None) == (not best)
        if other is not None:
            assert [len(other.dualised), len(other.dependent)] in best


def possible(graph: BondGraph, free: frozenset[str], groups: list[list[int]]) -> list[list[int]]:
    """The optimum with all junctions on; without any, those of the modes that have one."""
    best = most(hard(graph, free), groups)
    if best is not None:
        return [best]
    found = [most(hard(graph, free, off), groups) for off in modes(graph) if off]
    return [one for one in found if one is not None]


LONG = " -> ".join(["Se:a", *[f"0:j{k} -> TF:t{k}" for k in range(300)], "0:end", "Se:b"])


@pytest.mark.parametrize(
    "text",
    [
        "Sf:a -> 1:n <- Sf:b; n -> R:r",
        "Se:a -> TF:s -> TF:t -> GY:g -> 1:n; Sf:b -> GY:h -> n; n -> I:m",
        "1:a -> GY:x -> 1:b -> GY:y -> 1:c -> GY:z -> a; Se:u -> a; Se:v -> b",
        "0:a -> 0:b -> 0:c -> a; a -> C:x; b -> C:y",
        "0:a -> 1:b; a -> 1:b2; b -> 0:c; b2 -> c; Se:u -> a; Sf:q -> c",
        LONG,
    ],
    ids=["flows", "chain", "gyrators", "ring", "mesh", "long"],
)
def test_cores_of_models_made_for_it(text: str) -> None:
    graph = build(text)
    for core in members(graph):
        assert not satisfiable(graph, core)
        for gone in core:
            assert satisfiable(graph, [n for n in core if n != gone])
