"""What a reader of a drawing stumbles over: overlaps, crossings, arrows that miss."""

from __future__ import annotations

import itertools
from typing import NamedTuple

import networkx

from bondgraph.backends.drawing.arrange import Figure, framed
from bondgraph.backends.drawing.arrows import Arrow, with_arrows
from bondgraph.backends.drawing.canvas import Box, Point, around, cross, inside
from bondgraph.backends.drawing.scene import PLAIN, Look, Scene, scene
from bondgraph.backends.drawing.signals import signals
from bondgraph.backends.drawing.style import SMALL, width
from bondgraph.ir.causal import CausalGraph

#: What stands on the paper, by number: a node, the name of a junction or bond, a signal's text.
Mark = tuple[str, int]


class Line(NamedTuple):
    """A bond or a way of a signal, with what it may touch."""

    name: str
    points: tuple[Point, ...]
    ends: frozenset[Mark]


class Drawn(NamedTuple):
    """A drawing before it is painted."""

    view: Scene
    figure: Figure
    arrows: tuple[Arrow, ...]

    def name(self, node: int) -> str:
        """A node as pages write it: `1:rotor`, `MTF:rod`."""
        found = self.view.graph.nodes[node]
        return f"{found.keyword or found.kind}:{found.path}"

    def marks(self) -> dict[Mark, Box]:
        """All texts of the drawing but the names of frames, px."""
        view, figure = self.view, self.figure
        found: dict[Mark, Box] = {}
        for n, at in figure.centre.items():
            found["node", n] = around(*at, view.items[n].w, view.items[n].h)
        for n, at in figure.tags.items():
            found["name", n] = around(*at, width(view.items[n].tag, SMALL), SMALL)
        for b, at in figure.labels.items():
            found["bond", b] = around(*at, width(view.bond_names[b], SMALL), SMALL)
        for k, arrow in enumerate(self.arrows):
            if arrow.box is not None:
                found["signal", k] = arrow.box
        return found

    def spoken(self, mark: Mark) -> str:
        """A mark in a message."""
        what, number = mark
        if what == "bond":
            return f"bond name {self.view.bond_names[number]}"
        if what == "signal":
            return f"signal {self.arrows[number].signal.label}"
        return self.name(number) if what == "node" else f"the name of {self.name(number)}"

    def bonds(self) -> list[Line]:
        """The bonds."""
        found = []
        for wire in self.figure.wires:
            bond = self.view.graph.bonds[wire.bond]
            ends = bond.tail.node, bond.head.node
            name = " - ".join(map(self.name, ends))
            found.append(Line(name, wire.points, frozenset(("node", n) for n in ends)))
        return found

    def ways(self) -> list[Line]:
        """The ways of the signals."""
        found = []
        for k, arrow in enumerate(self.arrows):
            to = f"{arrow.signal.label} to {self.name(arrow.signal.node)}"
            ends = {("node", n) for n in (arrow.signal.node, *arrow.signal.origins)}
            for way in (arrow.tip, *arrow.ways):
                here = frozenset(ends | {("signal", k)} | self._blocks(way[0]))
                found.append(Line(f"way of {to}", way, here))
        return found

    def _blocks(self, at: Point) -> set[Mark]:
        """The block in which a way begins."""
        return {
            ("signal", k)
            for k, arrow in enumerate(self.arrows)
            if arrow.box is not None and arrow.box.grow(5).holds(around(*at, 0, 0))
        }


def drawn(causal: CausalGraph, look: Look = PLAIN) -> Drawn:
    """A bond graph, laid out."""
    view, plain = framed(lambda unframed: scene(causal, unframed, look))
    figure, arrows = with_arrows(view, plain, signals(causal.graph))
    return Drawn(view, figure, arrows)


def overlaps(picture: Drawn) -> list[str]:
    """Texts upon texts, lines through texts, what is off the paper, junctions without names."""
    marks = picture.marks()
    found = [
        f"{picture.spoken(a)} lies upon {picture.spoken(b)}"
        for a, b in itertools.combinations(marks, 2)
        if marks[a].meets(marks[b])
    ]
    for line in picture.bonds() + picture.ways():
        for mark, box in marks.items():
            pairs = itertools.pairwise(line.points)
            if mark not in line.ends and any(inside(p, q, box) for p, q in pairs):
                found.append(f"{line.name} runs through {picture.spoken(mark)}")
    paper = Box(-1.0, -1.0, picture.figure.size[0] + 1, picture.figure.size[1] + 1)
    outside = [mark for mark, box in marks.items() if not paper.holds(box)]
    found += [f"{picture.spoken(mark)} is off the paper" for mark in outside]
    for line in picture.bonds() + picture.ways():
        if not all(paper.holds(around(*p, 0, 0)) for p in line.points):
            found.append(f"{line.name} is off the paper")
    for n in picture.figure.centre:
        if picture.view.items[n].tag and n not in picture.figure.tags:
            found.append(f"{picture.name(n)} has no name")
    return found


def crossings(picture: Drawn) -> list[str]:
    """Every crossing of two lines, once."""
    found = []
    for one, two in itertools.combinations(picture.bonds() + picture.ways(), 2):
        for p, q in itertools.pairwise(one.points):
            for r, s in itertools.pairwise(two.points):
                if cross(p, q, r, s):
                    found.append(f"{one.name} crosses {two.name}")
    return found


def fewest_crossings(picture: Drawn) -> int:
    """What no drawing of the same nodes, bonds and signals could do without.

    Graphs of Kuratowski (1930) without a common edge: each has a crossing of its own.
    """
    graph = networkx.Graph()
    for bond in picture.view.graph.bonds:
        graph.add_edge(("node", bond.tail.node), ("node", bond.head.node))
    for k, arrow in enumerate(picture.arrows):
        here: Mark = ("node", arrow.signal.node)
        if arrow.box is not None:
            graph.add_edge(("signal", k), here)
            here = ("signal", k)
        sources = arrow.ways if arrow.box is not None else (arrow.tip,)
        for way in sources:
            graph.add_edge(_from(picture, way[0]), here)
    count = 0
    while True:
        planar, against = networkx.check_planarity(graph, counterexample=True)
        if planar:
            return count
        graph.remove_edges_from(list(against.edges))
        count += 1


def _from(picture: Drawn, at: Point) -> Mark:
    """The node or block in which a way begins."""
    marks = {m: box for m, box in picture.marks().items() if m[0] in ("node", "signal")}
    return min(marks, key=lambda mark: _far(marks[mark], at))


def _far(box: Box, p: Point) -> float:
    return max(box.x0 - p[0], p[0] - box.x1, box.y0 - p[1], p[1] - box.y1)


def missed(picture: Drawn) -> list[str]:
    """Modulated elements without an arrow, and arrows that do not lead from signal to element."""
    graph = picture.view.graph
    acting = {s.node: s for s in signals(graph) if s.node in picture.figure.centre}
    seen = {arrow.signal.node for arrow in picture.arrows}
    modulated = {
        n for n in picture.figure.centre
        if graph.nodes[n].keyword not in ("", graph.nodes[n].kind)
    }  # fmt: skip
    found = [f"{picture.name(n)} has no arrow" for n in sorted((modulated | set(acting)) - seen)]
    marks = picture.marks()
    for k, arrow in enumerate(picture.arrows):
        name = picture.name(arrow.signal.node)
        if _far(marks["node", arrow.signal.node], arrow.tip[-1]) > 9:
            found.append(f"the arrow to {name} does not reach it")
        if arrow.box is not None and _far(arrow.box, arrow.tip[0]) > 6:
            found.append(f"the arrow to {name} does not begin at its text")
        for way in arrow.ways if arrow.box is not None else (arrow.tip,):
            allowed: set[Mark] = {("node", n) for n in acting[arrow.signal.node].origins}
            allowed |= {
                ("signal", j)
                for j, other in enumerate(picture.arrows)
                if j != k and other.signal.block and other.signal.names == arrow.signal.names
            }
            if min((_far(marks[mark], way[0]) for mark in allowed), default=99.0) > 7:
                found.append(f"a way to {name} does not begin at its signal")
    return found
