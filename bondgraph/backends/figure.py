"""A bond graph as a picture: half arrows, causal strokes, one-ports around their junctions.

One that admits no causality is drawn too: what contradicts itself stands out.
"""

from __future__ import annotations

from bondgraph.backends.drawing.arrange import framed
from bondgraph.backends.drawing.arrows import Arrow, with_arrows
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
    spoken,
)
from bondgraph.backends.drawing.place import Wire
from bondgraph.backends.drawing.scene import PLAIN, Look, Path, Scene, scene
from bondgraph.backends.drawing.signals import signals
from bondgraph.backends.drawing.style import FONT, HEIGHT, SEPARATOR, SMALL, legend, width
from bondgraph.ir.causal import CausalGraph, Conflict, Reason, Stroke
from bondgraph.ir.graph import BondGraph

TOO_MANY = 20_000
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


def draw(causal: CausalGraph, title: str, bare: bool = False, look: Look = PLAIN) -> str:
    """The SVG of a bond graph with its causality, as one self-contained text.

    Junctions and two-ports run from left to right along the power, one-ports stand around them,
    submodels have frames; signals that act on laws are thin arrows; the reason of every stroke is
    its tooltip. The same graph gives the same bytes. `bare`: for inside of a page that has a title
    and the colours (`style.inside`). A graph of more than 20000 nodes gives a picture that says so.
    """
    nodes = causal.graph.nodes
    sensors = any(_reads(causal, n) for n in range(len(nodes)))
    acting = signals(causal.graph)
    signs = legend(causal.preference, bool(causal.dependent), sensors, bool(acting))
    if len(nodes) > TOO_MANY:
        return page(title, [excuse(len(nodes))], (560, 40), [], signs, bare, look)
    view, plain = framed(lambda unframed: scene(causal, unframed, look))
    figure, arrows = with_arrows(view, plain, acting)
    body = [
        *frames(view, figure),
        *[_wire(causal, wire) for wire in figure.wires],
        *[_arrow(causal.graph, a) for a in arrows],
        *[node_label(nodes[n], view.items[n], at) for n, at in sorted(figure.centre.items())],
        *[small(x, y, view.items[n].tag) for n, (x, y) in sorted(figure.tags.items())],
        *[small(x, y, view.bond_names[b]) for b, (x, y) in sorted(figure.labels.items())],
    ]
    return page(title, body, figure.size, [], signs, bare, look)


def excuse(nodes: int) -> str:
    """What is drawn in place of a graph that is too large."""
    text = f"{nodes} nodes are too many for one picture; draw a submodel of this model instead."
    return f'<text class="start label ink" y="20">{text}</text>'


# -------------------------------------------------------------------- pieces


def _wire(causal: CausalGraph, wire: Wire) -> str:
    """One bond: line, half arrow and stroke; a sensor that is not dualised is a grey arrow."""
    bond = causal.graph.bonds[wire.bond]
    stroke = causal.strokes[wire.bond]
    line = " ".join(f"{px(x)},{px(y)}" for x, y in wire.points)
    hint = f"<title>{escape(_told(causal.graph, wire.bond, stroke))}</title>"
    of = f'data-bond="{wire.bond}"'
    hit = f'<polyline class="hit" points="{line}"/>'
    sensor = next(
        (n for n in (bond.tail.node, bond.head.node) if _reads(causal, n)),
        None,
    )
    if sensor is not None:
        points = wire.points if sensor == bond.head.node else wire.points[::-1]
        tip = arrow(points[-2], points[-1])
        return (
            f'<g {of}>{hint}{hit}<polyline class="bond line-detector" points="{line}"/>'
            f'<polygon class="detector" points="{tip}"/></g>'
        )
    way = rounded(wire.points) + barb(wire.points[-2], wire.points[-1])
    if stroke.reason.cause == "ring":
        dashed = f'<path class="bond line-faint" stroke-dasharray="4 3" d="{way}"/>'
        return f"<g {of}>{hint}{hit}{dashed}</g>"
    ends = wire.points if stroke.at == "head" else wire.points[::-1]
    return (
        f'<g {of}>{hint}{hit}<path class="bond line-ink" d="{way}"/>'
        f'<path class="stroke line-ink" d="{bar(ends[-2], ends[-1])}"/></g>'
    )


def _arrow(graph: BondGraph, drawn: Arrow) -> str:
    """A signal: thin ways to its name or block, and an arrow from there to its element."""
    signal = drawn.signal
    told = f"{', '.join(signal.names)} acts on the law of {spoken(graph.nodes[signal.node])}"
    parts = [f"<title>{escape(told)}</title>"]
    for way in (*drawn.ways, drawn.tip):
        line = " ".join(f"{px(x)},{px(y)}" for x, y in way)
        parts.append(f'<polyline class="signal line-detector" points="{line}"/>')
        parts.append(f'<polygon class="detector" points="{arrow(way[-2], way[-1])}"/>')
    if drawn.box is not None:
        box = drawn.box
        x, y = (box.x0 + box.x1) / 2, (box.y0 + box.y1) / 2
        if signal.block:
            parts.append(
                f'<rect class="block paper line-detector" x="{px(box.x0)}" y="{px(box.y0)}" '
                f'width="{px(box.x1 - box.x0)}" height="{px(box.y1 - box.y0)}" rx="2"/>'
            )
        parts.append(
            f'<text class="told ink" x="{px(x)}" y="{px(y + 3.8)}">{escape(signal.label)}</text>'
        )
    return f"<g>{''.join(parts)}</g>"


def _reads(causal: CausalGraph, node: int) -> bool:
    return causal.graph.nodes[node].kind in ("De", "Df") and node not in causal.dualised


# ------------------------------------------------------------------ tooltips


def _told(graph: BondGraph, number: int, stroke: Stroke) -> str:
    bond = graph.bonds[number]
    tail, head = graph.nodes[bond.tail.node], graph.nodes[bond.head.node]
    if stroke.reason.cause == "ring":
        return f"{bond_name(graph, number)}\n{_why(graph, stroke.reason)}"
    receives, answers = (head, tail) if stroke.at == "head" else (tail, head)
    return (
        f"{bond_name(graph, number)}\n{spoken(receives)} receives the effort, "
        f"{spoken(answers)} the flow\n{_why(graph, stroke.reason)}"
    )


def _why(graph: BondGraph, reason: Reason) -> str:
    node = spoken(graph.nodes[reason.node])
    match reason.cause:
        case "source":
            return f"fixed by the source {node}"
        case "sensor":
            return f"fixed by the sensor {node}"
        case "law":
            return f"so that the law of {node} is used as it is written"
        case "preferred":
            return f"preferred by {node}"
        case "ring":
            return f"closes a ring of like junctions at {node}: leave this bond out"
        case "chosen":
            return f"a free choice at {node}"
        case "switched":
            return f"for the mode in which {node} is off"
        case _:
            bonds = [str(graph.bonds[b].label or graph.bonds[b].number) for b in reason.because]
            if len(bonds) > 6:
                bonds = [*bonds[:5], f"{len(bonds) - 5} more"]
            by = f" by bond{'s' * (len(bonds) > 1)} {', '.join(bonds)}" if bonds else ""
            return f"forced at {node}{by}"


def draw_conflicts(
    graph: BondGraph,
    conflicts: tuple[Conflict, ...],
    title: str,
    bare: bool = False,
    look: Look = PLAIN,
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
        return page(title, [excuse(len(graph.nodes))], (560, 40), notes, _SIGNS, bare, look)
    sheet = _Sheet(graph, conflicts)
    view, figure = framed(sheet.scene)
    body = [
        *frames(view, figure),
        *[sheet.wire(wire) for wire in figure.wires],
        *[sheet.node(view, n, at) for n, at in sorted(figure.centre.items())],
        *[small(*at, view.items[n].tag) for n, at in sorted(figure.tags.items())],
        *[small(x, y, graph.bonds[b].label or "") for b, (x, y) in sorted(figure.labels.items())],
    ]
    return page(title, body, figure.size, notes, _SIGNS, bare, look)


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
        return f'<g data-bond="{wire.bond}">{"".join(drawn)}</g>'
