"""A bond graph that admits no causality as a picture: what contradicts itself stands out."""

from __future__ import annotations

from bondgraph.backends.drawing.arrange import framed
from bondgraph.backends.drawing.canvas import Point
from bondgraph.backends.drawing.paint import (
    arrow,
    bar,
    barb,
    bond_name,
    escape,
    frames,
    node_label,
    outline,
    page,
    px,
    rounded,
    small,
)
from bondgraph.backends.drawing.place import Wire
from bondgraph.backends.drawing.scene import Path, Scene, scene
from bondgraph.backends.drawing.style import FONT, HEIGHT, SEPARATOR, SMALL, width
from bondgraph.backends.figure import TOO_MANY, excuse
from bondgraph.ir.causal import CausalGraph, Conflict
from bondgraph.ir.graph import BondGraph

_ROOM = 6.0  # px, for the box around a label
_SECOND = 5.0  # px, for the second box where it shows
_SIGNS = SEPARATOR.join(
    [
        "boxed: the conflict; without any one of these the rest agrees",
        "double box: where it shows",
        "thick bar: forced there, this end receives the effort",
        "grey: not part of it",
    ]
)


def draw_conflicts(
    graph: BondGraph, conflicts: tuple[Conflict, ...], title: str, bare: bool = False
) -> str:
    """The SVG of a bond graph in which the strokes cannot be placed.

    The members of each conflict are boxed and numbered, its bonds are thick and have the strokes
    that are forced; everything else is grey. What is wrong is said below the figure. The shapes
    say what the colour says. `bare`: as for `draw`, without the words below the figure.
    """
    notes = [
        f"Conflict{f' {number}' if len(conflicts) > 1 else ''}: {conflict.finding.message}"
        for number, conflict in enumerate(conflicts, 1)
    ]
    if len(graph.nodes) > TOO_MANY:
        return page(title, [excuse(len(graph.nodes))], (560, 40), notes, _SIGNS, bare)
    sheet = _Sheet(graph, conflicts)
    view, figure = framed(sheet.scene)
    body = [
        *frames(view, figure),
        *[sheet.wire(wire) for wire in figure.wires],
        *[sheet.node(view, n, at) for n, at in sorted(figure.centre.items())],
        *[small(*at, view.items[n].tag) for n, at in sorted(figure.tags.items())],
        *[small(x, y, graph.bonds[b].label or "") for b, (x, y) in sorted(figure.labels.items())],
    ]
    return page(title, body, figure.size, notes, _SIGNS, bare)


class _Sheet:
    """Which conflict every node and bond belongs to, and how that looks."""

    def __init__(self, graph: BondGraph, conflicts: tuple[Conflict, ...]) -> None:
        self.graph = graph
        self.member = {n: k for k, c in enumerate(conflicts, 1) for n in c.nodes}
        self.bonds = {b for c in conflicts for b in c.bonds}
        self.meets = {c.meet for c in conflicts}
        self.roles = {n: text for c in conflicts for n, text in c.roles}
        self.strokes: dict[int, list[str]] = {}
        for conflict in conflicts:
            for bond, at in conflict.strokes:
                self.strokes.setdefault(bond, []).append(at)
        self.several = len(conflicts) > 1

    def scene(self, unframed: frozenset[Path]) -> Scene:
        """What there is to draw, with room for the boxes and for what happens where it shows."""
        view = scene(CausalGraph(self.graph, "integral", (), (), (), (), ()), unframed)
        items = []
        for n, item in enumerate(view.items):
            if n in self.member:
                if not item.name:  # in its box a junction has its name, too
                    w = width(item.kind, FONT, True) + width(f":{item.tag}") + 2
                    item = item._replace(name=item.tag, tag="", w=w, h=HEIGHT)
                item = item._replace(w=item.w + _ROOM, h=item.h + _ROOM / 2)
            if n in self.meets:
                item = item._replace(w=item.w + _SECOND, h=item.h + _SECOND)
            items.append(item)
        return view._replace(items=tuple(items))

    def node(self, view: Scene, n: int, at: Point) -> str:
        item = view.items[n]
        text = node_label(
            self.graph.nodes[n], item, at, n not in self.member, self.roles.get(n, "")
        )
        if n not in self.member:
            return text
        box = outline(item, at, "core line-clash")
        badge = f"{self.member[n]}" if self.several else ""
        if n in self.meets:
            inner = item._replace(w=item.w - _SECOND, h=item.h - _SECOND)
            box += outline(inner, at, "core line-clash")
            badge = f"conflict {badge}".strip()
        if not badge:
            return box + text
        x, y = at[0] - item.w / 2 - width(badge, SMALL, True) / 2, at[1] - item.h / 2 - SMALL / 2
        return box + text + small(x, y, badge, "badge clash")

    def wire(self, wire: Wire) -> str:
        """A bond: thick with its forced strokes, or grey."""
        bond = self.graph.bonds[wire.bond]
        inside = wire.bond in self.bonds
        look = "bond thick line-clash" if inside else "bond line-faint"
        line = " ".join(f"{px(x)},{px(y)}" for x, y in wire.points)
        hint = f"<title>{escape(bond_name(self.graph, wire.bond))}</title>"
        drawn = [f'{hint}<polyline class="hit" points="{line}"/>']
        kinds = (self.graph.nodes[bond.tail.node].kind, self.graph.nodes[bond.head.node].kind)
        if kinds[0] in ("De", "Df") or kinds[1] in ("De", "Df"):
            points = wire.points if kinds[1] in ("De", "Df") else wire.points[::-1]
            drawn.append(f'<polyline class="{look}" points="{line}"/>')
            tip = arrow(points[-2], points[-1])
            drawn.append(f'<polygon class="{"clash" if inside else "faint"}" points="{tip}"/>')
        else:
            way = rounded(wire.points) + barb(wire.points[-2], wire.points[-1])
            drawn.append(f'<path class="{look}" d="{way}"/>')
        for at in self.strokes.get(wire.bond, ()) if inside else ():
            ends = wire.points if at == "head" else wire.points[::-1]
            drawn.append(f'<path class="thick line-clash" d="{bar(ends[-2], ends[-1])}"/>')
        return f"<g>{''.join(drawn)}</g>"
