"""A drawing as plain shapes, read from its SVG: for writers of other formats.

One drawing has one source, the SVG; what else is written is what stands in it.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from xml.etree import ElementTree

from bondgraph.backends.drawing.canvas import Point
from bondgraph.backends.drawing.style import BIG, FONT, NOTE, SMALL, palette
from bondgraph.text.tuples import NamedTuple

_SVG = "{http://www.w3.org/2000/svg}"
_WIDTHS = {"thick": 2.8, "stroke": 2.2, "core": 1.6, "bond": 1.3}
_SIZES = {"junction": BIG, "head": 14.0, "note": NOTE, "told": 11.0, "small": SMALL, "label": FONT}
_BOLD = {"junction", "kind", "head", "badge"}
_NUMBER = re.compile(r"-?\d+(?:\.\d+)?")


class Stroke(NamedTuple):
    """A line through points; `curves` are the indices of points that are controls of quadratics."""

    points: tuple[Point, ...]
    curves: tuple[int, ...]
    breaks: tuple[int, ...]  # indices of points at which the pen moves
    colour: str
    width: float
    dash: tuple[float, ...]


class Area(NamedTuple):
    """A filled polygon, or a rectangle with round corners: fill and edge are colours or ""."""

    points: tuple[Point, ...]
    radius: float
    fill: str
    edge: str
    width: float
    dash: tuple[float, ...]


class Piece(NamedTuple):
    """A stretch of text of one look."""

    text: str
    colour: str
    bold: bool


class Words(NamedTuple):
    """A line of text at a point of its baseline; `middle` says that it is centred there."""

    at: Point
    pieces: tuple[Piece, ...]
    size: float
    middle: bool
    italic: bool


Shape = Stroke | Area | Words


def shapes(svg: str) -> tuple[Point, list[Shape]]:
    """Width and height of a drawing in px, and what is on it from below to above."""
    root = ElementTree.fromstring(svg)
    size = float(root.attrib["width"]), float(root.attrib["height"])
    return size, list(_inside(root, (0.0, 0.0), size))


def _inside(group: ElementTree.Element, by: Point, size: Point) -> Iterator[Shape]:
    for e in group:
        looks = e.get("class", "").split()
        match e.tag.removeprefix(_SVG):
            case "g":
                dx, dy = map(float, _NUMBER.findall(e.get("transform", ""))[:2] or (0, 0))
                yield from _inside(e, (by[0] + dx, by[1] + dy), size)
            case "rect":
                yield _rectangle(e, looks, by, size)
            case "polygon":
                yield Area(_points(e.attrib["points"], by), 0.0, _fill(looks), "", 0.0, ())
            case "polyline" if "hit" not in looks:
                points = _points(e.attrib["points"], by)
                yield Stroke(points, (), (0,), _line(looks), _width(looks), ())
            case "path":
                yield _path(e, looks, by)
            case "text":
                yield _words(e, looks, by)
            case _:
                pass


def _points(text: str, by: Point) -> tuple[Point, ...]:
    numbers = [float(x) for x in _NUMBER.findall(text)]
    return tuple((x + by[0], y + by[1]) for x, y in zip(numbers[::2], numbers[1::2], strict=True))


def _rectangle(e: ElementTree.Element, looks: list[str], by: Point, size: Point) -> Area:
    if e.get("width") == "100%":
        box = 0.0, 0.0, size[0], size[1]
    else:
        x, y, w, h = (float(e.attrib[k]) for k in ("x", "y", "width", "height"))
        box = x + by[0], y + by[1], w, h
    x, y, w, h = box
    corners = ((x, y), (x + w, y), (x + w, y + h), (x, y + h))
    dash = (3.0, 2.0) if "derived" in looks else ()
    fill = _fill(looks) if "paper" in looks else ""
    return Area(corners, float(e.get("rx", 0)), fill, _line(looks), _width(looks), dash)


def _path(e: ElementTree.Element, looks: list[str], by: Point) -> Stroke:
    points: list[Point] = []
    curves: list[int] = []
    breaks: list[int] = []
    for command, rest in re.findall(r"([MLQ])([^MLQ]*)", e.attrib["d"]):
        if command == "M":
            breaks.append(len(points))
        if command == "Q":
            curves.append(len(points))
        points += _points(rest, by)
    dash = tuple(float(x) for x in e.get("stroke-dasharray", "").split())
    width = _width(looks)
    return Stroke(tuple(points), tuple(curves), tuple(breaks), _line(looks), width, dash)


def _words(e: ElementTree.Element, looks: list[str], by: Point) -> Words:
    pieces = []
    if (e.text or "").strip():
        pieces.append(Piece(str(e.text), _fill(looks), bool(_BOLD & set(looks))))
    for part in e:
        own = part.get("class", "").split()
        if part.tag == f"{_SVG}tspan":
            pieces.append(Piece(part.text or "", _fill(own), bool(_BOLD & set(own))))
        elif (part.tail or "").strip():  # behind the tooltip
            pieces.append(Piece(str(part.tail), _fill(looks), bool(_BOLD & set(looks))))
    at = float(e.get("x", 0)) + by[0], float(e.get("y", 0)) + by[1]
    size = next((s for name, s in _SIZES.items() if name in looks), FONT)
    return Words(at, tuple(pieces), size, "start" not in looks, "told" in looks)


def _width(looks: list[str]) -> float:
    return next((w for name, w in _WIDTHS.items() if name in looks), 1.0)


def _fill(looks: list[str]) -> str:
    colours = palette()
    return next((colours[name] for name in looks if name in colours), "")


def _line(looks: list[str]) -> str:
    colours = palette()
    named = (name.removeprefix("line-") for name in looks if name.startswith("line-"))
    return next((colours[name] for name in named if name in colours), "")
