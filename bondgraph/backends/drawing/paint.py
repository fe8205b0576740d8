"""The pieces of a drawing as SVG: labels, half arrows, strokes, frames, the page around them."""

from __future__ import annotations

import math

from bondgraph.backends.drawing.arrange import Figure
from bondgraph.backends.drawing.canvas import Point
from bondgraph.backends.drawing.scene import PLAIN, Item, Look, Scene
from bondgraph.backends.drawing.style import NOTE, SEPARATOR, SMALL, style, width
from bondgraph.ir.graph import BondGraph, Node

_MARGIN = 26.0
_EDGE = 12.0  # around a bare figure
_HEAD = 34.0
_FOOT = 34.0
_BARB = (9.0, 5.5)
_BAR = 6.5


def page(
    title: str,
    body: list[str],
    size: Point,
    notes: list[str],
    signs: str,
    bare: bool = False,
    look: Look = PLAIN,
) -> str:
    """The SVG around a figure: the title above, below it `notes` and what the signs mean.

    A `bare` one has neither title nor colours of its own: the page that it stands in has both.
    """
    if bare:
        return _bare(title, body, size, signs)
    words = _lines(signs, SEPARATOR, SMALL, max(size[0], 460.0)) if look.legend else []
    named = width(title, 14, True) if look.title else 0.0
    wide = max([size[0], named, *[width(w, SMALL) for w in words]])
    said = [line for note in notes for line in _lines(note, " ", NOTE, max(wide, 460.0))]
    wide = max([wide, *[width(line, NOTE) for line in said]])
    head = _HEAD if look.title else _MARGIN - 6
    foot = size[1] + head + _FOOT + 10
    below = foot + (17 * len(said) + 6 if said else 0)
    total_w = wide + 2 * _MARGIN
    total_h = below - 10 + 14 * len(words) + _MARGIN
    if not words and not said:
        total_h = size[1] + head + _MARGIN + 6
    lines = [
        f'<svg xmlns="http://www.w3.org/2000/svg" width="{px(total_w)}" height="{px(total_h)}" '
        f'viewBox="0 0 {px(total_w)} {px(total_h)}" role="img">',
        f"<title>{escape(title)}</title>",
        f"<style>{style(bool(notes))}</style>",
        '<rect class="paper" width="100%" height="100%"/>',
        *[
            f'<text class="start head ink" x="{px(_MARGIN)}" y="24">{escape(line)}</text>'
            for line in [title] if look.title
        ],
        f'<g transform="translate({px(_MARGIN)} {px(head + 6)})">',
        *body,
        "</g>",
        *[
            f'<text class="start note clash" x="{px(_MARGIN)}" y="{px(foot + 17 * i)}">'
            f"{escape(line)}</text>"
            for i, line in enumerate(said)
        ],
        *[
            f'<text class="start small faint" x="{px(_MARGIN)}" y="{px(below + 14 * i)}">'
            f"{escape(w)}</text>"
            for i, w in enumerate(words)
        ],
        "</svg>",
    ]
    return "\n".join(lines) + "\n"


def _bare(title: str, body: list[str], size: Point, signs: str) -> str:
    wide, high = px(size[0] + 2 * _EDGE), px(size[1] + 2 * _EDGE)
    lines = [
        f'<svg class="bondgraph" width="{wide}" height="{high}" viewBox="0 0 {wide} {high}" '
        'role="img">',
        f"<title>{escape(title)}</title>",
        f"<desc>{escape(signs)}</desc>",
        f'<g transform="translate({px(_EDGE)} {px(_EDGE)})">',
        *body,
        "</g>",
        "</svg>",
    ]
    return "\n".join(lines) + "\n"


def _lines(text: str, separator: str, size: float, limit: float) -> list[str]:
    """A text in lines no wider than `limit` px where it has a separator to break at."""
    lines = [""]
    for part in text.split(separator):
        longer = f"{lines[-1]}{separator}{part}" if lines[-1] else part
        if lines[-1] and width(longer, size) > limit:
            lines.append(part)
        else:
            lines[-1] = longer
    return lines


def node_label(node: Node, item: Item, at: Point, faint: bool = False, more: str = "") -> str:
    """The label of a node; `faint` takes its colour away, `more` is added to its tooltip."""
    x, y = at
    about = spoken(node) if item.kind else f"the submodel {item.name}"
    told = "\n".join([about, *[line for line in (item.kind and node.doc, more) if line]])
    hint = f"<title>{escape(told)}</title>"
    ink = "faint" if faint else "ink"
    of = f'data-node="{escape(node.path)}"'
    if not item.kind:
        return (
            f'<rect class="block paper line-{ink}" x="{px(x - item.w / 2)}" '
            f'y="{px(y - item.h / 2)}" width="{px(item.w)}" height="{px(item.h)}" rx="4"/>'
            f'<text class="label kind {ink}" {of} x="{px(x)}" y="{px(y + 4.6)}">'
            f"{hint}{escape(item.name)}</text>"
        )
    if not item.name:
        return (
            f'<text class="junction {ink}" {of} x="{px(x)}" y="{px(y + 6)}">{hint}{item.kind}'
            "</text>"
        )
    up = SMALL / 2 + 1 if item.note else 0.0
    text = (
        f'<text class="label" {of} x="{px(x)}" y="{px(y + 4.6 - up)}">{hint}'
        f'<tspan class="kind {"faint" if faint else item.colour}">{item.kind}</tspan>'
        f'<tspan class="{ink}">:{escape(item.name)}</tspan></text>'
    )
    text += small(x, y + up + 1.5, item.note) if item.note else ""
    return outline(item, at, f"derived line-{item.colour}") + text if item.derived else text


def outline(item: Item, at: Point, look: str) -> str:
    """A box around the label of a node."""
    return (
        f'<rect class="{look}" x="{px(at[0] - item.w / 2)}" y="{px(at[1] - item.h / 2)}" '
        f'width="{px(item.w)}" height="{px(item.h)}" rx="5"/>'
    )


def small(x: float, y: float, text: str, look: str = "faint") -> str:
    """A small text around a point."""
    return f'<text class="small {look}" x="{px(x)}" y="{px(y + 3.5)}">{escape(text)}</text>'


def frames(view: Scene, figure: Figure) -> list[str]:
    """The frames of submodels with their names."""
    drawn = []
    for path, box in figure.frames:
        above = max([k for k in range(1, len(path)) if path[:k] in view.frames], default=0)
        drawn.append(
            f'<rect class="frame line-box" x="{px(box.x0)}" y="{px(box.y0)}" '
            f'width="{px(box.x1 - box.x0)}" height="{px(box.y1 - box.y0)}" rx="7"/>'
            f'<text class="start small faint" x="{px(box.x0 + 7)}" y="{px(box.y0 + 12)}">'
            f"{escape('.'.join(path[above:]))}</text>"
        )
    return drawn


def _unit(p: Point, q: Point) -> Point:
    length = math.hypot(q[0] - p[0], q[1] - p[1]) or 1.0
    return (q[0] - p[0]) / length, (q[1] - p[1]) / length


def rounded(points: tuple[Point, ...]) -> str:
    """A path through the points with its corners rounded."""
    text = f"M{px(points[0][0])},{px(points[0][1])}"
    for before, at, after in zip(points, points[1:], points[2:], strict=False):
        radius = min(10.0, math.dist(before, at) / 2, math.dist(at, after) / 2)
        (ax, ay), (bx, by) = _unit(at, before), _unit(at, after)
        text += (
            f" L{px(at[0] + radius * ax)},{px(at[1] + radius * ay)} Q{px(at[0])},{px(at[1])} "
            f"{px(at[0] + radius * bx)},{px(at[1] + radius * by)}"
        )
    return f"{text} L{px(points[-1][0])},{px(points[-1][1])}"


def barb(p: Point, q: Point) -> str:
    """The half of an arrow head at q, on the right hand side of the bond."""
    (dx, dy), (back, aside) = _unit(p, q), _BARB
    return f" L{px(q[0] - back * dx - aside * dy)},{px(q[1] - back * dy + aside * dx)}"


def bar(p: Point, q: Point) -> str:
    """The causal stroke across a bond from p at its end q."""
    dx, dy = _unit(p, q)
    return (
        f"M{px(q[0] - _BAR * dy)},{px(q[1] + _BAR * dx)} "
        f"L{px(q[0] + _BAR * dy)},{px(q[1] - _BAR * dx)}"
    )


def arrow(p: Point, q: Point) -> str:
    """The full arrow head of a signal from p at its end q."""
    dx, dy = _unit(p, q)
    x, y = q[0] - 8 * dx, q[1] - 8 * dy
    corners = (q, (x - 3.4 * dy, y + 3.4 * dx), (x + 3.4 * dy, y - 3.4 * dx))
    return " ".join(f"{px(a)},{px(b)}" for a, b in corners)


def bond_name(graph: BondGraph, number: int) -> str:
    """A bond as it is spoken of: `bond 7: a -> b`."""
    bond = graph.bonds[number]
    ends = f"{graph.nodes[bond.tail.node].path} -> {graph.nodes[bond.head.node].path}"
    return f"bond {bond.label or bond.number}: {ends}"


def spoken(node: Node) -> str:
    """A node as it is spoken of: `R:fe`."""
    return f"{node.keyword or node.kind}:{node.path}"


def px(value: float) -> str:
    """A length, to a tenth of a pixel."""
    text = f"{value:.1f}"
    return text[:-2] if text.endswith(".0") else text


def escape(text: str) -> str:
    """Text that is safe between tags."""
    return text.replace("&", "&amp;").replace("<", "&lt;").replace(">", "&gt;")
