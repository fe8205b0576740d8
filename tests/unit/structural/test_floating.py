"""Networks that nothing grounds: which, and that nothing depends on the choice of a ground."""

from __future__ import annotations

import random

import numpy as np
import pytest

import bondgraph
from bondgraph.structural.floating import references

DIODE = "f = s*(exp(e/t) - 1)"


def grounded(body: str) -> list[str]:
    """The junctions that are taken as zero."""
    graph = bondgraph.compile(text=f"bg 1\nmodel M {{\n{body}\n}}").graph
    return [graph.nodes[n].path for n in sorted(references(graph))]


SOURCE = "param R = 2; param G = 3; 1:s { <- Se:U; -> R:R; -> Df:i; <- 0:b; -> 0:a }\n"


def test_what_is_between_two_nodes_floats() -> None:
    assert len(grounded(SOURCE + "a -> 1:load -> b; load -> R:r = 1/G")) == 1


@pytest.mark.parametrize(
    "ground",
    [
        "a -> R:leak = R",  # a law takes the effort itself
        "a -> De:y",  # so does a sensor
        "sensor y = a.e + i",
        "a -> 1:far -> R:leak = R",  # a balance with one of them
        "0:x when on { -> 1:far }; far -> a; input on : bool",
    ],
)
def test_one_path_to_ground_is_enough(ground: str) -> None:
    ground = ground.replace("-> 1:far -> R:leak = R", "-> 1:far { -> R:leak = R }")
    assert grounded(f"{SOURCE}a -> 1:load -> b; load -> R:r = 1/G\n{ground}") == []


def test_two_networks_float_by_themselves() -> None:
    """A transformer's windings have no common ground."""
    body = SOURCE + "a -> 1:w -> b; w -> TF:n { e1 = G*e2 } -> 1:v; 0:c -> v -> 0:d\nc <- 1:q -> d"
    assert len(grounded(body.replace("c <- 1:q -> d", "d -> 1:q -> c; q -> R:r = 2*R"))) == 2


@pytest.mark.parametrize("seed", range(12))
def test_they_are_what_a_rank_says(seed: int) -> None:
    """Random networks: as many as efforts that the balances leave open, and these are determined
    once they are zero."""
    draw = random.Random(seed)
    size = draw.randint(3, 7)
    edges = [(k, draw.randrange(k)) for k in range(1, size) if draw.random() < 0.85]
    edges += [tuple(draw.sample(range(size), 2)) for _ in range(draw.randint(1, 4))]
    lines = [f"0:n{k}" for k in range(size)]
    lines += [f"n{a} -> 1:x{k} -> n{b}; x{k} -> R:r{k} = R" for k, (a, b) in enumerate(edges)]
    lines += [f"n{k} -> R:g{k} = R" for k in range(size) if draw.random() < 0.2]
    used = {k for pair in edges for k in pair}
    lines += [f"n{k} -> R:e{k} = R" for k in range(size) if k not in used]
    text = "\n".join(["bg 1", "model M {", "param R = 2", *lines, "}"])
    graph = bondgraph.compile(text=text).graph
    found = {graph.nodes[n].path for n in references(graph)}
    rows = [[float((k == a) - (k == b)) for k in range(size)] for a, b in edges]
    for k in range(size):
        if f"n{k} -> R" in "\n".join(lines):
            rows.append([float(k == c) for c in range(size)])
    assert len(found) == size - np.linalg.matrix_rank(rows)
    rows += [[float(f"n{c}" == name) for c in range(size)] for name in sorted(found)]
    assert np.linalg.matrix_rank(rows) == size


def bridge(ground: str) -> str:
    diodes = [("a", "p"), ("b", "p"), ("n", "a"), ("n", "b")]
    lines = [
        f"{x} -> 1:d{k} -> {y}; d{k} -> R:D{k} {{ {DIODE} }}" for k, (x, y) in enumerate(diodes)
    ]
    return "\n".join([
        "bg 1", "model M {", "param L = 1; param R = 1; param C = 1; param G = 1; param s = 0.2",
        "const t = 0.8", "Se:U -> 1:coil { -> I:L; -> R:R; -> Df:i; <- 0:b; -> 0:a }",
        "0:p; 0:n", *lines, "p -> 1:load -> n; load -> 0:dc { -> C:C; -> R:Rl = 1/G; -> De:u }",
        ground, "}",
    ])  # fmt: skip


@pytest.mark.parametrize("where", ["a", "b", "p", "n"])
def test_a_ground_anywhere_changes_no_signature(where: str) -> None:
    """Two sensors, two relations; and they are verified on a trajectory of the diodes."""
    free = bondgraph.compile(text=bridge(""))
    told = bondgraph.compile(text=bridge(f"{where} <- Se:ground = 0"))
    for c in (free, told):
        assert c.verification.residuals == 2
        assert c.signatures.residuals
    seen = [sorted(sorted(r.faults) for r in c.residuals) for c in (free, told)]
    assert seen[0] == seen[1]
