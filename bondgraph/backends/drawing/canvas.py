"""What is already on the paper: boxes and lines in a grid, to find free places quickly."""

from __future__ import annotations

from bondgraph.text.tuples import NamedTuple

_CELL = 90.0

Point = tuple[float, float]


class Box(NamedTuple):
    """An upright rectangle, px; y grows downwards."""

    x0: float
    y0: float
    x1: float
    y1: float

    def grow(self, by: float) -> Box:
        """The box with a margin around it."""
        return Box(self.x0 - by, self.y0 - by, self.x1 + by, self.y1 + by)

    def join(self, other: Box) -> Box:
        """The smallest box around both."""
        return Box(
            min(self.x0, other.x0),
            min(self.y0, other.y0),
            max(self.x1, other.x1),
            max(self.y1, other.y1),
        )

    def meets(self, other: Box) -> bool:
        """Whether the two have an inner point in common."""
        return (
            self.x0 < other.x1 and other.x0 < self.x1 and self.y0 < other.y1 and other.y0 < self.y1
        )

    def holds(self, other: Box) -> bool:
        """Whether the other lies within."""
        return (
            self.x0 <= other.x0
            and self.y0 <= other.y0
            and self.x1 >= other.x1
            and self.y1 >= other.y1
        )

    def move(self, dx: float, dy: float) -> Box:
        """The box elsewhere."""
        return Box(self.x0 + dx, self.y0 + dy, self.x1 + dx, self.y1 + dy)


def around(x: float, y: float, w: float, h: float) -> Box:
    """The box of this size with its centre there."""
    return Box(x - w / 2, y - h / 2, x + w / 2, y + h / 2)


def inside(p: Point, q: Point, box: Box) -> tuple[float, float] | None:
    """The part of the line p-q (0 to 1) that lies in the box, or None (Liang and Barsky 1984)."""
    first, last = 0.0, 1.0
    for at, to, low, high in ((p[0], q[0], box.x0, box.x1), (p[1], q[1], box.y0, box.y1)):
        step = to - at
        if abs(step) < 1e-9:
            if not low < at < high:
                return None
            continue
        enter, leave = sorted(((low - at) / step, (high - at) / step))
        first, last = max(first, enter), min(last, leave)
    return (first, last) if first < last else None


def between(p: Point, q: Point, a: Box, b: Box) -> tuple[Point, Point] | None:
    """The visible part of a line from within box a to within box b; None if they touch."""
    out, back = inside(p, q, a), inside(p, q, b)
    start = out[1] if out else 0.0
    stop = back[0] if back else 1.0
    if stop <= start:
        return None

    def at(t: float) -> Point:
        return (p[0] + t * (q[0] - p[0]), p[1] + t * (q[1] - p[1]))

    return at(start), at(stop)


def cross(p: Point, q: Point, r: Point, s: Point) -> bool:
    """Whether two lines cross at an inner point of both."""

    def side(a: Point, b: Point, c: Point) -> float:
        return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])

    return side(p, q, r) * side(p, q, s) < -1e-6 and side(r, s, p) * side(r, s, q) < -1e-6


class Canvas:
    """Boxes and lines put so far."""

    def __init__(self) -> None:
        self._boxes: dict[tuple[int, int], list[Box]] = {}
        self._lines: dict[tuple[int, int], list[tuple[Point, Point]]] = {}

    def box(self, box: Box) -> None:
        """Put a box."""
        for cell in _cells(box):
            self._boxes.setdefault(cell, []).append(box)

    def line(self, p: Point, q: Point) -> None:
        """Put a line."""
        for cell in _cells_of_line(p, q):
            self._lines.setdefault(cell, []).append((p, q))

    def room_for_box(self, box: Box) -> bool:
        """Whether the box meets nothing."""
        for cell in _cells(box):
            if any(box.meets(other) for other in self._boxes.get(cell, ())):
                return False
            if any(inside(p, q, box) for p, q in self._lines.get(cell, ())):
                return False
        return True

    def room_for_line(self, p: Point, q: Point) -> bool:
        """Whether the line meets nothing."""
        for cell in _cells_of_line(p, q):
            if any(inside(p, q, box) for box in self._boxes.get(cell, ())):
                return False
            if any(cross(p, q, r, s) for r, s in self._lines.get(cell, ())):
                return False
        return True

    def crossings(self, p: Point, q: Point) -> int:
        """How many lines the line crosses."""
        near = {pair for cell in _cells_of_line(p, q) for pair in self._lines.get(cell, ())}
        return sum(cross(p, q, r, s) for r, s in near)


def _cells(box: Box) -> list[tuple[int, int]]:
    return [
        (i, j)
        for i in range(int(box.x0 // _CELL), int(box.x1 // _CELL) + 1)
        for j in range(int(box.y0 // _CELL), int(box.y1 // _CELL) + 1)
    ]


def _cells_of_line(p: Point, q: Point) -> list[tuple[int, int]]:
    """The cells that the line may touch, column by column."""
    if p[0] > q[0]:
        p, q = q, p
    slope = (q[1] - p[1]) / (q[0] - p[0]) if q[0] - p[0] > 1e-9 else 0.0
    cells = []
    for i in range(int(p[0] // _CELL), int(q[0] // _CELL) + 1):
        if slope or q[0] - p[0] > 1e-9:
            left, right = max(p[0], i * _CELL), min(q[0], (i + 1) * _CELL)
            y0, y1 = p[1] + slope * (left - p[0]), p[1] + slope * (right - p[0])
        else:
            y0, y1 = p[1], q[1]
        low, high = min(y0, y1) - 0.5, max(y0, y1) + 0.5
        cells += [(i, j) for j in range(int(low // _CELL), int(high // _CELL) + 1)]
    return cells
