"""Arrows of signals: where their names and blocks stand, and on which way they run.

A signal that finds no way without crossing labels has its name beside the arrow instead: a diagram
of many signals names them, too.
"""

from __future__ import annotations

import itertools
import math

from bondgraph.backends.drawing.arrange import Figure, covered
from bondgraph.backends.drawing.canvas import Box, Canvas, Point, around, between, inside
from bondgraph.backends.drawing.place import Frame, Wire
from bondgraph.backends.drawing.scene import Scene
from bondgraph.backends.drawing.signals import Signal
from bondgraph.backends.drawing.style import SMALL, width
from bondgraph.text.tuples import NamedTuple

_REACHES = (24.0, 30.0, 38.0, 50.0, 66.0, 90.0, 120.0)  # px from the element to its signal
_ANGLES = tuple(22.5 * k for k in range(16))
_BENDS = tuple(s * b for b in (0.0, 0.15, 0.22, 0.3, 0.38, 0.46, 0.55, 0.7, 0.9) for s in (1, -1))
_PIECES = 20  # of a curve; bends are shares of its length, aside
_SPOTS = 10  # free places that are compared
_CROSSINGS = 2  # with bonds, of a way that is still clearer than a name
_BESIDE = math.cos(math.radians(24))  # of a signal and a bond that leave a junction
_CONFUSED = 150.0  # px that such a way counts more
_FAR = 900.0  # px: a longer way is harder to follow than a name is to find


class Arrow(NamedTuple):
    """A signal as drawn: its text in `box`, the arrow to its element, ways from where it is from.

    Without a box the only way is the arrow.
    """

    signal: Signal
    box: Box | None
    tip: tuple[Point, ...]
    ways: tuple[tuple[Point, ...], ...]


def with_arrows(
    scene: Scene, figure: Figure, signals: tuple[Signal, ...]
) -> tuple[Figure, tuple[Arrow, ...]]:
    """The figure with room for its arrows, and these."""
    drawn = [s for s in signals if s.node in figure.centre]
    if not drawn:
        return figure, ()
    placer = _Placer(scene, figure)
    arrows = [placer.arrow(signal) for signal in drawn]
    bounds = Box(0.0, 0.0, *figure.size)
    for arrow in arrows:
        bounds = bounds if arrow.box is None else bounds.join(arrow.box)
        for x, y in [p for way in (arrow.tip, *arrow.ways) for p in way]:
            bounds = bounds.join(Box(x, y, x, y))
    dx, dy = -bounds.x0, -bounds.y0
    size = (bounds.x1 - bounds.x0, bounds.y1 - bounds.y0)
    return _moved(figure, dx, dy)._replace(size=size), tuple(_carried(a, dx, dy) for a in arrows)


class _Placer:
    def __init__(self, scene: Scene, figure: Figure) -> None:
        self.scene, self.figure = scene, figure
        own = scene, figure.centre, figure.tags, figure.wires, figure.frames
        self.canvas: Canvas = covered(*own)
        for bond, at in figure.labels.items():
            text = scene.bond_names[bond]
            self.canvas.box(around(*at, width(text, SMALL), SMALL))
        self.labels, self.lines = Canvas(), Canvas()  # what a way may not hit, and should not cross
        for frame in figure.frames:
            x0, y0, x1, _ = frame.box
            self.canvas.line((x0, y0), (x1, y0))
            wide = width(".".join(frame.path), SMALL)
            self.labels.box(Box(x0 + 4, y0 + 2, x0 + 9 + min(wide, x1 - x0), y0 + 16))
        self.computed: dict[tuple[str, ...], Box] = {}  # blocks, by what they compute
        self.boxes = {
            n: around(*at, scene.items[n].w, scene.items[n].h) for n, at in figure.centre.items()
        }
        for box in self.boxes.values():
            self.labels.box(box.grow(2))
        for n, at in figure.tags.items():
            self.labels.box(around(*at, width(scene.items[n].tag, SMALL), SMALL))
        for wire in figure.wires:
            for p, q in itertools.pairwise(wire.points):
                self.lines.line(p, q)
        self.ends = [end for wire in figure.wires for end in _ends(wire)]

    def arrow(self, signal: Signal) -> Arrow:
        """Where a signal goes: from its origin if there is a way, else from its name."""
        target = self.boxes[signal.node]
        here = None
        if signal.block and signal.names in self.computed:
            here = self.computed[signal.names]
            signal = signal._replace(block=False, origins=())  # its name, if there is no way
        elif not signal.block and len(signal.origins) == 1 and len(signal.names) == 1:
            here = self.boxes.get(signal.origins[0])
        if here is not None:
            way = self._way(here, target)
            if way is not None:
                self._take(None, (way,))
                return Arrow(signal, None, way, ())
        best: tuple[tuple[float, float, float], Arrow] | None = None
        for box, tip in self._spots(signal, target):
            ways = [self._way(self.boxes[o], box) for o in signal.origins if o in self.boxes]
            good = tuple(way for way in ways if way is not None)
            length = sum(map(self._cost, good)) + 3 * _length(tip)
            rank = float(len(ways) - len(good)), sum(map(self._crossings, good)) * 1.0, length
            if best is None or rank < best[0]:
                best = rank, Arrow(signal, box, tip, good)
        assert best is not None
        placed = best[1]
        self._take(placed.box, (placed.tip, *placed.ways))
        if signal.block and placed.box is not None:
            self.computed[signal.names] = placed.box
        return placed

    def _take(self, box: Box | None, ways: tuple[tuple[Point, ...], ...]) -> None:
        if box is not None:
            self.canvas.box(box)
            self.labels.box(box)
        for way in ways:
            for p, q in itertools.pairwise(way):
                self.canvas.line(p, q)
                self.lines.line(p, q)

    def _spots(self, signal: Signal, target: Box) -> list[tuple[Box, tuple[Point, ...]]]:
        """Free places for the text of a signal, near ones first, with the arrow to the element."""
        wide = width(signal.label, SMALL + 1) + (12 if signal.block else 4)
        high = SMALL + (9 if signal.block else 3)
        x, y = (target.x0 + target.x1) / 2, (target.y0 + target.y1) / 2
        found: list[tuple[Box, tuple[Point, ...]]] = []
        far: tuple[Box, tuple[Point, ...]] | None = None
        for reach in _REACHES:
            for angle in _ANGLES:
                dx, dy = math.cos(math.radians(angle)), math.sin(math.radians(angle))
                aside = abs(dx) * ((target.x1 - target.x0) + wide) / 2
                above = abs(dy) * ((target.y1 - target.y0) + high) / 2
                out = reach + min(math.hypot(aside * dx, above * dy) + abs(dx) * aside * 0.5, 160)
                box = around(x + out * dx, y + out * dy, wide, high)
                line = between((x, y), (x + out * dx, y + out * dy), target.grow(3), box.grow(1))
                if line is None or math.dist(*line) < 12:
                    continue
                tip = (line[1], line[0])
                far = (box, tip)
                if self.canvas.room_for_box(box.grow(3)) and self.canvas.room_for_line(*tip):
                    found.append((box, tip))
                    if len(found) == _SPOTS:
                        return found
        assert far is not None
        return found or [far]

    def _way(self, here: Box, to: Box) -> tuple[Point, ...] | None:
        """The clearest way from a box to another: straight or bent; None where it hits labels."""
        p = ((here.x0 + here.x1) / 2, (here.y0 + here.y1) / 2)
        q = ((to.x0 + to.x1) / 2, (to.y0 + to.y1) / 2)
        far = math.dist(p, q)
        if far > _FAR or far < 1:
            return None
        best: tuple[tuple[float, float], tuple[Point, ...]] | None = None
        for bend in _BENDS:
            control = ((p[0] + q[0]) / 2 - bend * (q[1] - p[1]),
                       (p[1] + q[1]) / 2 + bend * (q[0] - p[0]))  # fmt: skip
            way = _seen(_curve(p, control, q, 2 if not bend else _PIECES), here.grow(4), to.grow(3))
            pairs = list(itertools.pairwise(way))
            if not pairs or not all(self.labels.room_for_line(a, b) for a, b in pairs):
                continue
            crossings = self._crossings(way)
            cost = self._cost(way)
            if not crossings and cost < _CONFUSED + _length(way):
                return way  # further bends are longer
            rank = float(crossings), cost
            if crossings <= _CROSSINGS and (best is None or rank < best[0]):
                best = rank, way
        return None if best is None else best[1]

    def _cost(self, way: tuple[Point, ...]) -> float:
        """How long a way is, and longer where it leaves beside a bond: they look like one line."""
        own = math.atan2(way[1][1] - way[0][1], way[1][0] - way[0][0])
        beside = any(
            math.dist(way[0], p) < 40 and math.cos(own - angle) > _BESIDE for p, angle in self.ends
        )
        return _length(way) + (_CONFUSED if beside else 0.0)

    def _crossings(self, way: tuple[Point, ...]) -> int:
        return sum(self.lines.crossings(a, b) for a, b in itertools.pairwise(way))


def _ends(wire: Wire) -> list[tuple[Point, float]]:
    """Both ends of a bond, with the direction in which it leaves."""
    (a, b), (y, z) = wire.points[:2], wire.points[-2:]
    return [(a, math.atan2(b[1] - a[1], b[0] - a[0])), (z, math.atan2(y[1] - z[1], y[0] - z[0]))]


def _curve(p: Point, control: Point, q: Point, pieces: int) -> list[Point]:
    """A quadratic curve as so many points."""
    found = []
    for k in range(pieces):
        t = k / (pieces - 1)
        a, b, c = (1 - t) ** 2, 2 * t * (1 - t), t**2
        found.append((a * p[0] + b * control[0] + c * q[0], a * p[1] + b * control[1] + c * q[1]))
    return found


def _seen(way: list[Point], here: Box, to: Box) -> tuple[Point, ...]:
    """The part of a way that is outside of the boxes at its ends."""
    points = list(way)
    while len(points) > 2 and inside(points[1], points[1], here.grow(0.01)):
        points.pop(0)
    while len(points) > 2 and inside(points[-2], points[-2], to.grow(0.01)):
        points.pop()
    nothing = Box(0, 0, 0, 0)
    if len(points) == 2:
        line = between(points[0], points[1], here, to)
        return () if line is None else line
    first = between(points[0], points[1], here, nothing)
    last = between(points[-2], points[-1], nothing, to)
    if first is None or last is None:
        return ()
    return (first[0], *points[1:-1], last[1])


def _length(way: tuple[Point, ...]) -> float:
    return sum(math.dist(p, q) for p, q in itertools.pairwise(way))


def _shifted(points: tuple[Point, ...], dx: float, dy: float) -> tuple[Point, ...]:
    return tuple((x + dx, y + dy) for x, y in points)


def _carried(arrow: Arrow, dx: float, dy: float) -> Arrow:
    return arrow._replace(
        box=None if arrow.box is None else arrow.box.move(dx, dy),
        tip=_shifted(arrow.tip, dx, dy),
        ways=tuple(_shifted(way, dx, dy) for way in arrow.ways),
    )


def _moved(figure: Figure, dx: float, dy: float) -> Figure:
    """The figure elsewhere on the paper."""
    if not dx and not dy:
        return figure
    return figure._replace(
        centre={n: (x + dx, y + dy) for n, (x, y) in figure.centre.items()},
        wires=tuple(Wire(w.bond, _shifted(w.points, dx, dy)) for w in figure.wires),
        tags={n: (x + dx, y + dy) for n, (x, y) in figure.tags.items()},
        labels={b: (x + dx, y + dy) for b, (x, y) in figure.labels.items()},
        frames=tuple(Frame(f.path, f.box.move(dx, dy)) for f in figure.frames),
    )
