"""Random bond graphs by shape: trees, loops, grids, gyrator rings, ladders, parallel bonds."""

from __future__ import annotations

from itertools import pairwise
from random import Random

from bondgraph.ir.expr import Pool
from bondgraph.ir.graph import BondGraph
from bondgraph.text.source import Source, Span
from tests.unit.passes.causality_graphs import assemble

SHAPES = ["tree", "loops", "grid", "ring", "ladder", "parallel"]
_ELEMENTS = ["R", "C", "C", "I", "I", "R!", "De", "Df"]


class Drawing:
    """A graph that grows: junctions, what links them, elements and fields on them."""

    def __init__(self, random: Random) -> None:
        self.random = random
        self.kinds: list[tuple[str, str, bool, Span]] = []
        self.bonds: list[tuple[int, int, Span]] = []
        self.source = Source("random.bg", "x" * 999)

    def node(self, kind: str) -> int:
        n = len(self.kinds)
        self.kinds.append((kind.strip("!"), f"n{n}", kind == "R!", Span(self.source, n, n + 1)))
        return n

    def bond(self, a: int, b: int) -> None:
        pair = (a, b) if self.random.random() < 0.5 else (b, a)
        at = len(self.bonds)
        self.bonds.append((*pair, Span(self.source, at, at + 1)))

    def link(self, a: int, b: int, what: str = "") -> None:
        what = what or self.random.choice(["bond", "bond", "bond", "TF", "GY"])
        if what == "bond":
            self.bond(a, b)
            return
        middle = self.node(what)
        self.bond(a, middle)
        self.bond(middle, b)

    def junctions(self, count: int) -> list[int]:
        return [self.node(self.random.choice("01")) for _ in range(count)]


def random_graph(seed: int, shape: str) -> BondGraph:
    """A graph of up to about 60 bonds; the same seed gives the same graph."""
    draw = Drawing(Random(f"{shape} {seed}"))
    random = draw.random
    spots = _structure(draw, shape)
    conflicts = random.choice([0.02, 0.1, 0.3])  # sources where they do not belong
    for spot in spots:
        kind = draw.kinds[spot][0]
        for _ in range(random.choice([0, 0, 1, 1, 2])):
            element = random.choice(_ELEMENTS)
            if element in ("De", "Df"):
                element = "De" if kind == "0" else "Df"
            if random.random() < conflicts:
                element = random.choice(["Se", "Sf"])
            elif random.random() < 0.08:
                element = "Sf" if kind == "0" else "Se"
            draw.bond(spot, draw.node(element))
    for _ in range(random.choice([0, 0, 1, 2])):  # fields: one port at each of several junctions
        field = draw.node(random.choice("RCI"))
        for spot in random.sample(spots, min(len(spots), random.choice([2, 3, 4]))):
            draw.bond(spot, field)
    return assemble(draw.source, Pool(), draw.kinds, draw.bonds)


def _structure(draw: Drawing, shape: str) -> list[int]:
    random = draw.random
    match shape:
        case "ladder":
            spots = [draw.node("01"[k % 2]) for k in range(random.randint(2, 22))]
            for a, b in pairwise(spots):
                draw.link(a, b, random.choice(["bond", "bond", "bond", "TF", "GY"]))
        case "ring":
            spots = draw.junctions(random.randint(2, 14))
            for a, b in zip(spots, [*spots[1:], spots[0]], strict=True):
                draw.link(a, b, random.choice(["GY", "GY", "bond", "TF"]))
            for a, b in [random.sample(spots, 2) for _ in range(random.randint(0, 3))]:
                draw.link(a, b)
        case "grid":
            wide, high = random.choice([(2, 2), (3, 2), (3, 3), (4, 2), (4, 3)])
            spots = [draw.node("0") for _ in range(wide * high)]
            pairs = [(k, k + 1) for k in range(wide * high) if (k + 1) % wide]
            for a, b in [*pairs, *[(k, k + wide) for k in range(wide * (high - 1))]]:
                middle = draw.node("1")
                draw.link(spots[a], middle, random.choice(["bond", "bond", "bond", "TF"]))
                draw.bond(middle, spots[b])
                spots.append(middle)
        case "parallel":
            spots = draw.junctions(random.randint(2, 9))
            for a, b in pairwise(spots):
                for _ in range(random.randint(1, 3)):
                    draw.link(a, b)
        case _:
            spots = draw.junctions(random.randint(2, 18))
            for k in range(1, len(spots)):
                draw.link(spots[random.randrange(k)], spots[k])
            if shape == "loops":
                for a, b in [random.sample(spots, 2) for _ in range(random.randint(1, 6))]:
                    draw.link(a, b)
    return spots
