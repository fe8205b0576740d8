"""Arrows of signals: where their names and blocks stand, and on which way they run.

A signal that finds no way without crossing labels has its name beside the arrow instead: a diagram
of many signals names them, too.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator

from bondgraph.backends.drawing.arrange import Figure, covered
from bondgraph.backends.drawing.canvas import Box, Canvas, Point, around, between, inside
from bondgraph.backends.drawing.detour import detour, quadratic
from bondgraph.backends.drawing.place import Frame, Wire
from bondgraph.backends.drawing.scene import Scene
from bondgraph.backends.drawing.signals import Signal
from bondgraph.backends.drawing.style import SMALL, width
from bondgraph.text.tuples import NamedTuple

_REACHES = (24.0, 30.0, 38.0, 50.0, 66.0, 90.0, 120.0)  # px from the element to its signal
_ANGLES = tuple(22.5 * k for k in range(16))
_BENDS = tuple(s * b for b in (0.0, 0.15, 0.22, 0.3, 0.38, 0.46, 0.55, 0.7, 0.9) for s in (1, -1))
_PIECES = 11  # of a curve while it is tried, twice as many when it is drawn
_SPOTS = 6  # free places that are compared
_FEW = 4  # where each is tried with a detour
_CROSSINGS = 2  # with bonds, of a way that is still clearer than a name
_BESIDE = math.cos(math.radians(24))  # of a signal and a bond that leave a junction
_CONFUSED = 150.0  # px that such a way counts more
_FAR_OUT = 1.35  # of the length of a curve and the distance of its ends
_LOOKED = 7500  # points of the grid in one drawing: half a second
_FAR = 900.0  # px: a longer way is harder to follow than a name is to find

Way = tuple[Point, ...]


class Arrow(NamedTuple):
    """A signal as drawn: its text in `box`, the arrow to its element, ways from where it is from.

    Without a box the only way is the arrow.
    """

    signal: Signal
    box: Box | None
    tip: Way
    ways: tuple[Way, ...]


def with_arrows(
    scene: Scene, figure: Figure, signals: tuple[Signal, ...]
) -> tuple[Figure, tuple[Arrow, ...]]:
    """The figure with room for its arrows, and these."""
    drawn = [s for s in signals if s.node in figure.centre]
    if not drawn:
        return figure, ()
    placer = _Placer(scene, figure)
    arrows = [placer.arrow(signal) for signal in drawn]
    arrows = [placer.untangled(arrow) for arrow in arrows]
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
        self.labels, self.lines = Canvas(), Canvas()  # what a way may not hit, and should not cross
        self.clear = Canvas()  # the labels with room around them
        self.left = _LOOKED
        self.drawn: dict[Way, tuple[Box, Box]] = {}  # the ways, and from where to where
        for bond, at in figure.labels.items():
            name = around(*at, width(scene.bond_names[bond], SMALL), SMALL)
            self.canvas.box(name)
            self._block(name)
        for frame in figure.frames:
            x0, y0, x1, _ = frame.box
            self.canvas.line((x0, y0), (x1, y0))
            wide = width(".".join(frame.path), SMALL)
            self._block(Box(x0 + 4, y0 + 2, x0 + 9 + min(wide, x1 - x0), y0 + 16))
        self.computed: dict[tuple[str, ...], Box] = {}  # blocks, by what they compute
        self.boxes = {
            n: around(*at, scene.items[n].w, scene.items[n].h) for n, at in figure.centre.items()
        }
        for box in self.boxes.values():
            self._block(box.grow(2))
        for n, at in figure.tags.items():
            self._block(around(*at, width(scene.items[n].tag, SMALL), SMALL))
        for wire in figure.wires:
            for p, q in itertools.pairwise(wire.points):
                self.lines.line(p, q)
        self.ends = [end for wire in figure.wires for end in _ends(wire)]

    def _block(self, box: Box) -> None:
        self.labels.box(box)
        self.clear.box(box.grow(3))

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
            way = self._best(here, target, self._way(here, target))
            if way is not None:
                self._take(None, {way: (here, target)})
                return Arrow(signal, None, way, ())
        origins = [self.boxes[o] for o in signal.origins if o in self.boxes]
        best: tuple[tuple[float, float, float], Box, Way, list[Way | None]] | None = None
        for box, tip in self._spots(signal, target, origins):
            tried = [self._way(origin, box) for origin in origins]
            good = [way for way in tried if way is not None]
            length = sum(map(self._cost, good)) + 3 * _length(tip)
            crossings = sum(map(self._crossings, good))
            rank = float(len(origins) - len(good)), float(crossings), length
            if best is None or rank < best[0]:
                best = rank, box, tip, tried
        assert best is not None
        _, box, tip, tried = best
        self._take(box, {tip: (box, target)})
        ways: list[Way] = []
        for here, curve in zip(origins, tried, strict=True):
            way = self._best(here, box, curve)
            if way is not None:
                self._take(None, {way: (here, box)})
                ways.append(way)
        if signal.block:
            self.computed[signal.names] = box
        return Arrow(signal, box, tip, tuple(ways))

    def untangled(self, arrow: Arrow) -> Arrow:
        """The arrow with a detour for each of its ways that crosses more than it has to."""
        ways = []
        for way in (arrow.tip, *arrow.ways):
            if not self._crossings(way):
                ways.append(way)
                continue
            others = Canvas()
            points = [w.points for w in self.figure.wires] + [w for w in self.drawn if w != way]
            for p, q in itertools.chain.from_iterable(map(itertools.pairwise, points)):
                others.line(p, q)
            crossed = _crossed(way, others)
            better = self._detour(*self.drawn[way], others) if crossed else None
            if better is not None and _crossed(better, others) < crossed:
                self.drawn[better] = self.drawn.pop(way)
                way = better
            ways.append(way)
        return arrow._replace(tip=ways[0], ways=tuple(ways[1:]))

    def _take(self, box: Box | None, ways: dict[Way, tuple[Box, Box]]) -> None:
        if box is not None:
            self.canvas.box(box)
            self._block(box)
        self.drawn.update(ways)
        for way in ways:
            for p, q in itertools.pairwise(way):
                self.canvas.line(p, q)
                self.lines.line(p, q)

    def _best(self, here: Box, to: Box, way: Way | None) -> Way | None:
        """A curve, or where it crosses something or goes far out a detour that is better."""
        near = way is not None and _length(way) < _FAR_OUT * math.dist(way[0], way[-1])
        if way is not None and near and not self._crossings(way):
            return way
        found = [w for w in (way, self._detour(here, to, self.lines)) if w is not None]
        return min(found, key=lambda w: (self._crossings(w), _length(w)), default=None)

    def _detour(self, here: Box, to: Box, lines: Canvas) -> Way | None:
        """A way round what is drawn; None where it would be too long to follow."""
        if math.dist((here.x0, here.y0), (to.x0, to.y0)) > _FAR:
            return None
        paper = Box(0.0, 0.0, *self.figure.size)
        way, seen = detour(here, to, paper, self.clear, lines, min(self.left, _LOOKED // 3))
        self.left -= seen
        if way is None or _crossed(way, lines) > _CROSSINGS:
            return None
        return way

    def _spots(self, signal: Signal, target: Box, origins: list[Box]) -> list[tuple[Box, Way]]:
        """Free places for the text of a signal, with the arrow to its element.

        They are beside the element; where all is taken, beside what the signal is from.
        """
        wide = width(signal.label, SMALL + 1) + (12 if signal.block else 4)
        high = SMALL + (9 if signal.block else 3)
        found: list[tuple[Box, Way]] = []
        own = self.scene.frames_of(signal.node)
        foreign = [frame.box for frame in self.figure.frames if frame.path not in own]
        for box, tip in self._beside(target, wide, high):
            if any(box.meets(frame) for frame in foreign):
                continue
            if self.labels.room_for_line(*tip) and not self._crossings(tip):
                found.append((box, tip))
                if len(found) == _SPOTS:
                    return found
        for origin in [] if found else origins:
            for box, _ in itertools.islice(self._beside(origin, wide, high), _FEW):
                way = self._detour(box, target, self.lines)
                if way is not None:
                    found.append((box, way))
        if found:
            return found
        x, y = _middle(target)
        far = around(x, y - _REACHES[-1], wide, high)
        line = between(_middle(far), (x, y), far.grow(1), target.grow(3))
        assert line is not None
        return [(far, line)]

    def _beside(self, box: Box, wide: float, high: float) -> Iterator[tuple[Box, Way]]:
        """Free places of this size around a box, near ones first, with the line from there."""
        x, y = _middle(box)
        for reach in _REACHES:
            for angle in _ANGLES:
                dx, dy = math.cos(math.radians(angle)), math.sin(math.radians(angle))
                aside = abs(dx) * ((box.x1 - box.x0) + wide) / 2
                above = abs(dy) * ((box.y1 - box.y0) + high) / 2
                out = reach + min(math.hypot(aside * dx, above * dy) + abs(dx) * aside * 0.5, 160)
                spot = around(x + out * dx, y + out * dy, wide, high)
                line = between(_middle(spot), (x, y), spot.grow(1), box.grow(3))
                if line is None or math.dist(*line) < 12:
                    continue
                if self.canvas.room_for_box(spot.grow(3)):
                    yield spot, line

    def _way(self, here: Box, to: Box) -> Way | None:
        """The clearest way from a box to another: straight or bent; None where it hits labels."""
        far = math.dist(_middle(here), _middle(to))
        if far > _FAR or far < 1:
            return None
        best: tuple[tuple[float, float], float] | None = None
        for bend in _BENDS:
            way = _bent(here, to, bend, _PIECES)
            pairs = list(itertools.pairwise(way))
            if not pairs or not all(self.labels.room_for_line(a, b) for a, b in pairs):
                continue
            crossings = self._crossings(way)
            cost = self._cost(way)
            if not crossings and cost < _CONFUSED + _length(way):
                return _bent(here, to, bend, 2 * _PIECES - 1)  # further bends are longer
            rank = float(crossings), cost
            if crossings <= _CROSSINGS and (best is None or rank < best[0]):
                best = rank, bend
        return None if best is None else _bent(here, to, best[1], 2 * _PIECES - 1)

    def _cost(self, way: Way) -> float:
        """How long a way is, and longer where it leaves beside a bond: they look like one line."""
        own = math.atan2(way[1][1] - way[0][1], way[1][0] - way[0][0])
        beside = any(
            math.dist(way[0], p) < 40 and math.cos(own - angle) > _BESIDE for p, angle in self.ends
        )
        return _length(way) + (_CONFUSED if beside else 0.0)

    def _crossings(self, way: Way) -> int:
        return _crossed(way, self.lines)


def _middle(box: Box) -> Point:
    return (box.x0 + box.x1) / 2, (box.y0 + box.y1) / 2


def _bent(here: Box, to: Box, bend: float, pieces: int) -> Way:
    """What is seen of a curve between two boxes, which is bent aside by a share of its length."""
    p, q = _middle(here), _middle(to)
    control = ((p[0] + q[0]) / 2 - bend * (q[1] - p[1]), (p[1] + q[1]) / 2 + bend * (q[0] - p[0]))
    curve = quadratic(p, control, q, pieces if bend else 2)
    return _seen(curve, here.grow(4), to.grow(3))


def _crossed(way: Way, lines: Canvas) -> int:
    """How many lines a way crosses."""
    return sum(lines.crossings(a, b) for a, b in itertools.pairwise(way))


def _ends(wire: Wire) -> list[tuple[Point, float]]:
    """Both ends of a bond, with the direction in which it leaves."""
    (a, b), (y, z) = wire.points[:2], wire.points[-2:]
    return [(a, math.atan2(b[1] - a[1], b[0] - a[0])), (z, math.atan2(y[1] - z[1], y[0] - z[0]))]


def _seen(way: list[Point], here: Box, to: Box) -> Way:
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


def _length(way: Way) -> float:
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
