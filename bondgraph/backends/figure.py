"""A bond graph as a picture: half arrows, causal strokes, one-ports around their junctions."""

from __future__ import annotations

from bondgraph.backends.drawing.arrange import framed
from bondgraph.backends.drawing.paint import (
    arrow,
    bar,
    barb,
    bond_name,
    escape,
    frames,
    node_label,
    page,
    px,
    rounded,
    small,
    spoken,
)
from bondgraph.backends.drawing.place import Wire
from bondgraph.backends.drawing.scene import scene
from bondgraph.backends.drawing.style import legend
from bondgraph.ir.causal import CausalGraph, Reason, Stroke
from bondgraph.ir.graph import BondGraph

TOO_MANY = 20_000


def draw(causal: CausalGraph, title: str, bare: bool = False) -> str:
    """The SVG of a bond graph with its causality, as one self-contained text.

    Junctions and two-ports run from left to right along the power, one-ports stand around them,
    submodels have frames; the reason of every stroke is its tooltip. The same graph gives the
    same bytes. `bare`: for inside of a page that has a title and the colours (`style.inside`).
    A graph of more than 20000 nodes gives a picture that says so.
    """
    nodes = causal.graph.nodes
    sensors = any(_reads(causal, n) for n in range(len(nodes)))
    signs = legend(causal.preference, bool(causal.dependent), sensors)
    if len(nodes) > TOO_MANY:
        return page(title, [excuse(len(nodes))], (560, 40), [], signs, bare)
    view, figure = framed(lambda unframed: scene(causal, unframed))
    body = [
        *frames(view, figure),
        *[_wire(causal, wire) for wire in figure.wires],
        *[node_label(nodes[n], view.items[n], at) for n, at in sorted(figure.centre.items())],
        *[small(x, y, view.items[n].tag) for n, (x, y) in sorted(figure.tags.items())],
        *[
            small(x, y, view.graph.bonds[b].label or "")
            for b, (x, y) in sorted(figure.labels.items())
        ],
    ]
    return page(title, body, figure.size, [], signs, bare)


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
    hit = f'<polyline class="hit" points="{line}"/>'
    sensor = next(
        (n for n in (bond.tail.node, bond.head.node) if _reads(causal, n)),
        None,
    )
    if sensor is not None:
        points = wire.points if sensor == bond.head.node else wire.points[::-1]
        tip = arrow(points[-2], points[-1])
        return (
            f'<g>{hint}{hit}<polyline class="bond line-detector" points="{line}"/>'
            f'<polygon class="detector" points="{tip}"/></g>'
        )
    way = rounded(wire.points) + barb(wire.points[-2], wire.points[-1])
    if stroke.reason.cause == "ring":
        dashed = f'<path class="bond line-faint" stroke-dasharray="4 3" d="{way}"/>'
        return f"<g>{hint}{hit}{dashed}</g>"
    ends = wire.points if stroke.at == "head" else wire.points[::-1]
    return (
        f'<g>{hint}{hit}<path class="bond line-ink" d="{way}"/>'
        f'<path class="stroke line-ink" d="{bar(ends[-2], ends[-1])}"/></g>'
    )


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
