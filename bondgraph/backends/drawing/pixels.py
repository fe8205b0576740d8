"""A drawing as PNG or PDF, by matplotlib: the shapes of its SVG, in DejaVu Sans."""

from __future__ import annotations

import io
from typing import TYPE_CHECKING, Any, Literal

from bondgraph.backends.drawing.shapes import Area, Stroke, Words, shapes

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_INCH = 96.0  # px of CSS
_SHARP = 192.0  # dots an inch of a PNG: twice those of a plain screen
_SETTINGS = {
    "font.family": "sans-serif", "font.sans-serif": ["DejaVu Sans"], "text.parse_math": False,
    "pdf.fonttype": 42, "svg.hashsalt": "bondgraph",
}  # fmt: skip


def pixels(svg: str, kind: Literal["png", "pdf"]) -> bytes:
    """The drawing as a file of this kind, the same bytes for the same drawing."""
    from matplotlib import rc_context

    with rc_context(_SETTINGS):
        figure = _figure(svg)
        found = io.BytesIO()
        dated: dict[str, Any] = {"CreationDate": None} if kind == "pdf" else {"Software": None}
        figure.savefig(found, format=kind, dpi=_SHARP, metadata=dated)
    return found.getvalue()


def _figure(svg: str) -> Figure:
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    (wide, high), found = shapes(svg)
    figure = Figure(figsize=(wide / _INCH, high / _INCH))
    axis = figure.add_axes((0, 0, 1, 1))
    axis.set_xlim(0, wide)
    axis.set_ylim(high, 0)
    axis.set_axis_off()
    renderer = FigureCanvasAgg(figure).get_renderer()
    for order, shape in enumerate(found):
        if isinstance(shape, Stroke):
            _stroke(axis, shape, order)
        elif isinstance(shape, Area):
            _area(axis, shape, order)
        else:
            _words(axis, renderer, shape, order)
    return figure


def _points(px: float) -> float:
    """Of px in points."""
    return 72 / _INCH * px


def _stroke(axis: Any, shape: Stroke, order: int) -> None:
    from matplotlib.patches import PathPatch
    from matplotlib.path import Path

    codes = [
        Path.MOVETO if k in shape.breaks
        else Path.CURVE3 if k in shape.curves or k - 1 in shape.curves
        else Path.LINETO
        for k in range(len(shape.points))
    ]  # fmt: skip
    style: Any = (0, tuple(d / shape.width for d in shape.dash)) if shape.dash else "-"
    axis.add_patch(PathPatch(
        Path(shape.points, codes), fill=False, edgecolor=shape.colour, linestyle=style,
        linewidth=_points(shape.width), capstyle="butt", joinstyle="round", zorder=order,
    ))  # fmt: skip


def _area(axis: Any, shape: Area, order: int) -> None:
    from matplotlib.patches import FancyBboxPatch, Polygon

    look: dict[str, Any] = {
        "facecolor": shape.fill or "none", "edgecolor": shape.edge or "none", "zorder": order,
        "linewidth": _points(shape.width) if shape.edge else 0.0,
    }  # fmt: skip
    if shape.dash:
        look["linestyle"] = (0, shape.dash)
    if not shape.radius:
        axis.add_patch(Polygon(shape.points, closed=True, **look))
        return
    (x, y), (_, _), (x1, y1), _ = shape.points
    box = f"round,pad=0,rounding_size={shape.radius}"
    axis.add_patch(FancyBboxPatch((x, y), x1 - x, y1 - y, boxstyle=box, **look))


def _words(axis: Any, renderer: Any, shape: Words, order: int) -> None:
    """Stretches of text beside each other, as wide as each of them is."""
    made = [
        axis.text(
            0, shape.at[1], piece.text, fontsize=_points(shape.size), color=piece.colour,
            fontweight="bold" if piece.bold else "normal", zorder=order,
            fontstyle="italic" if shape.italic else "normal", va="baseline", ha="left",
        )
        for piece in shape.pieces
    ]  # fmt: skip
    to_px = _INCH / axis.figure.dpi
    widths = [text.get_window_extent(renderer).width * to_px for text in made]
    x = shape.at[0] - (sum(widths) / 2 if shape.middle else 0.0)
    for text, wide in zip(made, widths, strict=True):
        text.set_x(x)
        x += wide
