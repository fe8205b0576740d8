"""A bond graph as a picture: half arrows, causal strokes, one-ports around their junctions."""

from __future__ import annotations

import math

from bondgraph.backends.drawing.arrange import Figure, arrange
from bondgraph.backends.drawing.canvas import Point
from bondgraph.backends.drawing.place import Wire
from bondgraph.backends.drawing.scene import Item, Path, Scene, scene
from bondgraph.backends.drawing.style import SEPARATOR, SMALL, legend, style, width
from bondgraph.ir.causal import CausalGraph, Reason, Stroke
from bondgraph.ir.graph import BondGraph, Node

_MARGIN = 26.0
_HEAD = 34.0
_FOOT = 34.0
_BARB = (9.0, 5.5)
_BAR = 6.5
_TOO_MANY = 20_000


def draw(causal: CausalGraph, title: str) -> str:
    """The SVG of a bond graph with its causality, as one self-contained text.

    Junctions and two-ports run from left to right along the power, one-ports stand around them,
    submodels have frames; the reason of every stroke is its tooltip. The same graph gives the
    same bytes. A graph of more than 20000 nodes gives a picture that says so.
    """
    if len(causal.graph.nodes) > _TOO_MANY:
        return _excuse(causal, title)
    view, figure = _framed(causal)
    body = [
        *_frames(view, figure),
        *[_wire(causal, view, wire) for wire in figure.wires],
        *[_node(view.graph.nodes[n], view.items[n], at) for n, at in sorted(figure.centre.items())],
        *[_small(x, y, view.items[n].tag) for n, (x, y) in sorted(figure.tags.items())],
        *[
            _small(x, y, view.graph.bonds[b].label or "")
            for b, (x, y) in sorted(figure.labels.items())
        ],
    ]
    return _page(causal, title, body, figure.size)


def _framed(causal: CausalGraph) -> tuple[Scene, Figure]:
    """The figure with the frames that can be drawn; names say what the others would have said."""
    unframed: frozenset[Path] = frozenset()
    for _ in range(3):
        view = scene(causal, unframed)
        figure, more = arrange(view)
        if more <= unframed:
            return view, figure
        unframed |= more
    view = scene(causal, unframed | frozenset(view.frames))
    return view, arrange(view)[0]


def _page(causal: CausalGraph, title: str, body: list[str], size: Point) -> str:
    sensors = any(_reads(causal, n) for n in range(len(causal.graph.nodes)))
    signs = legend(causal.preference, bool(causal.dependent), sensors)
    words = _wrapped(signs, max(size[0], 460.0))
    wide = max(size[0], width(title, 14, True), *[width(w, SMALL) for w in words])
    total_w = wide + 2 * _MARGIN
    total_h = size[1] + _HEAD + _FOOT + 14 * len(words) + _MARGIN
    foot = size[1] + _HEAD + _FOOT + 10
    lines = [
        f'<svg xmlns="http://www.w3.org/2000/svg" width="{_n(total_w)}" height="{_n(total_h)}" '
        f'viewBox="0 0 {_n(total_w)} {_n(total_h)}" role="img">',
        f"<title>{_escape(title)}</title>",
        f"<style>{style()}</style>",
        '<rect class="paper" width="100%" height="100%"/>',
        f'<text class="start head ink" x="{_n(_MARGIN)}" y="24">{_escape(title)}</text>',
        f'<g transform="translate({_n(_MARGIN)} {_n(_HEAD + 6)})">',
        *body,
        "</g>",
        *[
            f'<text class="start small faint" x="{_n(_MARGIN)}" y="{_n(foot + 14 * i)}">'
            f"{_escape(w)}</text>"
            for i, w in enumerate(words)
        ],
        "</svg>",
    ]
    return "\n".join(lines) + "\n"


def _excuse(causal: CausalGraph, title: str) -> str:
    nodes = len(causal.graph.nodes)
    text = f"{nodes} nodes are too many for one picture; draw a submodel of this model instead."
    return _page(causal, title, [f'<text class="start label ink" y="20">{text}</text>'], (560, 40))


def _wrapped(text: str, limit: float) -> list[str]:
    lines = [""]
    for part in text.split(SEPARATOR):
        longer = f"{lines[-1]}{SEPARATOR}{part}" if lines[-1] else part
        if lines[-1] and width(longer, SMALL) > limit:
            lines.append(part)
        else:
            lines[-1] = longer
    return lines


# -------------------------------------------------------------------- pieces


def _node(node: Node, item: Item, at: Point) -> str:
    x, y = at
    told = f"{node.keyword or node.kind}:{node.path}" + (f"\n{node.doc}" if node.doc else "")
    hint = f"<title>{_escape(told)}</title>"
    if not item.name:
        return f'<text class="junction ink" x="{_n(x)}" y="{_n(y + 6)}">{hint}{item.kind}</text>'
    text = (
        f'<text class="label" x="{_n(x)}" y="{_n(y + 4.6)}">{hint}'
        f'<tspan class="kind {item.colour}">{item.kind}</tspan>'
        f'<tspan class="ink">:{_escape(item.name)}</tspan></text>'
    )
    if not item.derived:
        return text
    return (
        f'<rect class="derived line-{item.colour}" x="{_n(x - item.w / 2)}" '
        f'y="{_n(y - item.h / 2)}" width="{_n(item.w)}" height="{_n(item.h)}" rx="5"/>{text}'
    )


def _small(x: float, y: float, text: str) -> str:
    return f'<text class="small faint" x="{_n(x)}" y="{_n(y + 3.5)}">{_escape(text)}</text>'


def _frames(view: Scene, figure: Figure) -> list[str]:
    drawn = []
    for path, box in figure.frames:
        above = max([k for k in range(1, len(path)) if path[:k] in view.frames], default=0)
        drawn.append(
            f'<rect class="frame line-box" x="{_n(box.x0)}" y="{_n(box.y0)}" '
            f'width="{_n(box.x1 - box.x0)}" height="{_n(box.y1 - box.y0)}" rx="7"/>'
            f'<text class="start small faint" x="{_n(box.x0 + 7)}" y="{_n(box.y0 + 12)}">'
            f"{_escape('.'.join(path[above:]))}</text>"
        )
    return drawn


def _wire(causal: CausalGraph, view: Scene, wire: Wire) -> str:
    """One bond: line, half arrow and stroke; a sensor that is not dualised is a grey arrow."""
    bond = causal.graph.bonds[wire.bond]
    stroke = causal.strokes[wire.bond]
    line = " ".join(f"{_n(x)},{_n(y)}" for x, y in wire.points)
    hint = f"<title>{_escape(_told(causal.graph, wire.bond, stroke))}</title>"
    hit = f'<polyline class="hit" points="{line}"/>'
    sensor = next(
        (n for n in (bond.tail.node, bond.head.node) if _reads(causal, n)),
        None,
    )
    if sensor is not None:
        points = wire.points if sensor == bond.head.node else wire.points[::-1]
        tip = _arrow(points[-2], points[-1])
        return (
            f'<g>{hint}{hit}<polyline class="bond line-detector" points="{line}"/>'
            f'<polygon class="detector" points="{tip}"/></g>'
        )
    way = _rounded(wire.points) + _barb(wire.points[-2], wire.points[-1])
    ends = wire.points if stroke.at == "head" else wire.points[::-1]
    return (
        f'<g>{hint}{hit}<path class="bond line-ink" d="{way}"/>'
        f'<path class="stroke line-ink" d="{_bar(ends[-2], ends[-1])}"/></g>'
    )


def _reads(causal: CausalGraph, node: int) -> bool:
    return causal.graph.nodes[node].kind in ("De", "Df") and node not in causal.dualised


def _unit(p: Point, q: Point) -> Point:
    length = math.hypot(q[0] - p[0], q[1] - p[1]) or 1.0
    return (q[0] - p[0]) / length, (q[1] - p[1]) / length


def _rounded(points: tuple[Point, ...]) -> str:
    """A path through the points with its corners rounded."""
    text = f"M{_n(points[0][0])},{_n(points[0][1])}"
    for before, at, after in zip(points, points[1:], points[2:], strict=False):
        radius = min(10.0, math.dist(before, at) / 2, math.dist(at, after) / 2)
        (ax, ay), (bx, by) = _unit(at, before), _unit(at, after)
        text += (
            f" L{_n(at[0] + radius * ax)},{_n(at[1] + radius * ay)} Q{_n(at[0])},{_n(at[1])} "
            f"{_n(at[0] + radius * bx)},{_n(at[1] + radius * by)}"
        )
    return f"{text} L{_n(points[-1][0])},{_n(points[-1][1])}"


def _barb(p: Point, q: Point) -> str:
    """The half of an arrow head at q, on the right hand side of the bond."""
    (dx, dy), (back, aside) = _unit(p, q), _BARB
    return f" L{_n(q[0] - back * dx - aside * dy)},{_n(q[1] - back * dy + aside * dx)}"


def _bar(p: Point, q: Point) -> str:
    dx, dy = _unit(p, q)
    return (
        f"M{_n(q[0] - _BAR * dy)},{_n(q[1] + _BAR * dx)} "
        f"L{_n(q[0] + _BAR * dy)},{_n(q[1] - _BAR * dx)}"
    )


def _arrow(p: Point, q: Point) -> str:
    dx, dy = _unit(p, q)
    x, y = q[0] - 8 * dx, q[1] - 8 * dy
    corners = (q, (x - 3.4 * dy, y + 3.4 * dx), (x + 3.4 * dy, y - 3.4 * dx))
    return " ".join(f"{_n(a)},{_n(b)}" for a, b in corners)


# ------------------------------------------------------------------ tooltips


def _told(graph: BondGraph, number: int, stroke: Stroke) -> str:
    bond = graph.bonds[number]
    tail, head = graph.nodes[bond.tail.node], graph.nodes[bond.head.node]
    receives, answers = (head, tail) if stroke.at == "head" else (tail, head)
    return (
        f"{_bond(graph, number)}\n{_name(receives)} receives the effort, {_name(answers)} the "
        f"flow\n{_why(graph, stroke.reason)}"
    )


def _bond(graph: BondGraph, number: int) -> str:
    bond = graph.bonds[number]
    ends = f"{graph.nodes[bond.tail.node].path} -> {graph.nodes[bond.head.node].path}"
    return f"bond {bond.label or bond.number}: {ends}"


def _name(node: Node) -> str:
    return f"{node.keyword or node.kind}:{node.path}"


def _why(graph: BondGraph, reason: Reason) -> str:
    node = _name(graph.nodes[reason.node])
    match reason.cause:
        case "source":
            return f"fixed by the source {node}"
        case "sensor":
            return f"fixed by the sensor {node}"
        case "law":
            return f"so that the law of {node} is used as it is written"
        case "preferred":
            return f"preferred by {node}"
        case "chosen":
            return f"a free choice at {node}"
        case _:
            bonds = [str(graph.bonds[b].label or graph.bonds[b].number) for b in reason.because]
            if len(bonds) > 6:
                bonds = [*bonds[:5], f"{len(bonds) - 5} more"]
            by = f" by bond{'s' * (len(bonds) > 1)} {', '.join(bonds)}" if bonds else ""
            return f"forced at {node}{by}"


def _n(value: float) -> str:
    text = f"{value:.1f}"
    return text[:-2] if text.endswith(".0") else text


def _escape(text: str) -> str:
    return text.replace("&", "&amp;").replace("<", "&lt;").replace(">", "&gt;")
