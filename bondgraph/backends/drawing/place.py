"""Where everything of a drawing goes: one-ports on the free sides, frames, parts on the paper."""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator

from bondgraph.backends.drawing.canvas import Box, Canvas, Point, around, between
from bondgraph.backends.drawing.layout import Layers
from bondgraph.backends.drawing.scene import Leaf, Path, Scene
from bondgraph.backends.drawing.style import GAP, SMALL, width
from bondgraph.text.tuples import NamedTuple

_ARM = 32.0  # visible length of a short bond, px
_WALL = 14.0  # room for a frame that a bond crosses, px
_ROW = 134.0
_PAD = 8.0
_TITLE = 13.0

_E, _SE, _S, _SW, _W, _NW, _N, _NE = (45.0 * i for i in range(8))
_COMPASS = (_N, _S, _NE, _SE, _NW, _SW, _E, _W)
_SIDES = {
    "in": (_W, _N, _S, _NW, _SW, _NE, _SE, _E),
    "out": (_E, _S, _N, _SE, _NE, _SW, _NW, _W),
    "I": (_N, _S, _E, _NW, _NE, _SW, _SE, _W),
    "R": (_S, _N, _E, _SW, _SE, _NW, _NE, _W),
    "C": (_S, _N, _E, _SE, _SW, _NE, _NW, _W),
    "D": (_NE, _N, _SE, _S, _NW, _SW, _E, _W),
}
#: Where the name of a junction may stand: sides (in halves of its width) and px below.
_NAMES = (
    *((1, 15.0), (1, -15.0), (-1, -15.0), (-1, 15.0), (0, 24.0), (0, -24.0)),
    *((1, 24.0), (1, -24.0), (-1, -24.0), (-1, 24.0), (1, 0.0), (-1, 0.0)),
)
_FAR_NAMES = (26.0, 34.0, 44.0, 56.0, 70.0)  # px, where a junction has many bonds
_STROKE = 7.0  # px to each side of a bond
_BETWEEN = tuple(22.5 + a for a in _COMPASS)
_FINE = tuple(11.25 + a for a in sorted(_COMPASS + _BETWEEN))
_RANK = {"Se": 0, "Sf": 0, "I": 1, "IC": 1, "R": 3, "C": 2, "De": 4, "Df": 4}


class Wire(NamedTuple):
    """A bond as drawn: its visible points from tail to head."""

    bond: int
    points: tuple[Point, ...]


class Frame(NamedTuple):
    """The frame of a submodel."""

    path: Path
    box: Box


class Part:
    """A stretch of columns of one connected part, in its own coordinates."""

    def __init__(self, scene: Scene, layers: Layers, columns: range) -> None:
        self.scene = scene
        self.layers = layers
        self.columns = columns
        self.centre: dict[int, Point] = {}
        self.box: dict[int, Box] = {}
        self.wires: list[Wire] = []
        self.tags: dict[int, Point] = {}
        self.frames: list[Frame] = []
        self.unframed: set[Path] = set()
        self.crowded = False
        self.bounds = Box(0, 0, 0, 0)

    def place(self, x: dict[int, float], legs: list[Leg], spread: float) -> None:
        """Put the skeleton at these columns, then bonds, one-ports, names and frames.

        `spread` stretches the rows. Where a one-port finds no room `crowded` is set.
        """
        self.crowded = False
        self.canvas = Canvas()
        self.box.clear()
        self.wires.clear()
        self.angles: dict[int, list[float]] = {}
        deep = max([len(self.scene.frames_of(n)) for n in self.layers.vertices], default=0)
        pitch = spread * _ROW + 2 * (_PAD + _TITLE) * deep * (
            len(set(self.layers.row.values())) > 1
        )
        for v, c in self.layers.column.items():
            if c in self.columns:
                self.centre[v] = (x[c], self.layers.row[v] * pitch)
        for n in self.layers.vertices:
            if n in self.centre:
                self._put(n, self.centre[n])
        self.legs = legs
        for leg in legs:
            self._leg(leg)
        for n in self.layers.vertices:
            if n in self.centre:
                for leaf in sorted(self.scene.leaves.get(n, ()), key=self._rank):
                    self._hang(leaf)
        self._name_junctions()
        self._frame()

    def _put(self, node: int, at: Point) -> None:
        item = self.scene.items[node]
        self.centre[node] = at
        self.box[node] = around(*at, item.w, item.h)
        self.canvas.box(self.box[node].grow(2))

    def _leg(self, leg: Leg) -> None:
        """Note the line of a skeleton bond, so that nothing is put upon it."""
        p, q = leg.ends(self.centre)
        self.canvas.line(p, q)
        self.angles.setdefault(leg.a, []).append(_angle(p, q))
        self.angles.setdefault(leg.b, []).append(_angle(q, p))

    # ------------------------------------------------------------- one-ports

    def _rank(self, leaf: Leaf) -> tuple[int, int]:
        return _RANK[self.scene.graph.nodes[leaf.node].kind], leaf.bond

    def _hang(self, leaf: Leaf) -> None:
        """Put a one-port where there is room, near before far, the usual side first."""
        kind = self.scene.graph.nodes[leaf.node].kind
        if kind in ("Se", "Sf"):
            kind = "in" if self.scene.graph.bonds[leaf.bond].tail.node == leaf.node else "out"
        sides: tuple[float, ...] = _SIDES[kind if kind in _SIDES else "D"]
        if leaf.host in self.layers.upright and kind in ("I", "R", "C"):
            sides = self._beside(leaf.host, sides)
        walls = self.scene.walls(leaf.node, leaf.host)
        if walls and kind not in ("in", "out"):
            sides = tuple(sorted(sides, key=lambda a: a not in (_N, _S)))
        arm = _ARM + _WALL * walls
        tries = [(arm, sides, 40.0), (arm * 1.4, sides, 40.0)]
        tries += [(arm * k, sides + _BETWEEN, 30.0) for k in (1.2, 1.7, 2.4)]
        tries += [(arm * k, _BETWEEN + _FINE, 10.0) for k in (1.7, 2.4, 3.2, 4.4, 6.0, 8.0, 11.0)]
        best: tuple[Point, Box, Point, Point, float] | None = None
        for length, angles, apart in tries:
            for angle in angles:
                if best and self._apart(leaf.host, angle) < apart:
                    continue
                spot = self._spot(leaf, angle, length)
                if best is None:
                    best = (*spot, angle)
                if self._apart(leaf.host, angle) >= apart and self._fits(spot):
                    self._fasten(leaf, *spot, angle)
                    return
        assert best is not None
        self.crowded = True
        self._fasten(leaf, *best)

    def _beside(self, host: int, sides: tuple[float, ...]) -> tuple[float, ...]:
        """The sides of what stands upright: a single one-port goes on in its line, two balance."""
        hung = [self.scene.graph.nodes[leaf.node].kind for leaf in self.scene.leaves[host]]
        alone = sum(kind not in ("De", "Df") for kind in hung) == 1
        first = (_S, _N, _E, _W) if alone else (_W, _E, _S, _N)
        return first + tuple(angle for angle in sides if angle not in first)

    def _spot(self, leaf: Leaf, angle: float, length: float) -> tuple[Point, Box, Point, Point]:
        """The centre, the box and the visible line of a one-port in this direction."""
        item = self.scene.items[leaf.node]
        here = self.centre[leaf.host]
        dx, dy = math.cos(math.radians(angle)), math.sin(math.radians(angle))
        a, b = self.scene.items[leaf.host], item
        # the distance at which exactly `length` of the bond is visible between the two boxes
        reach = [
            min(
                (i.w / 2 + GAP) / abs(dx) if abs(dx) > 1e-9 else math.inf,
                (i.h / 2 + GAP) / abs(dy) if abs(dy) > 1e-9 else math.inf,
            )
            for i in (a, b)
        ]
        total = reach[0] + length + reach[1]
        there = (here[0] + dx * total, here[1] + dy * total)
        start = (here[0] + dx * reach[0], here[1] + dy * reach[0])
        stop = (there[0] - dx * reach[1], there[1] - dy * reach[1])
        return there, around(*there, item.w, item.h), start, stop

    def _apart(self, node: int, angle: float) -> float:
        """The smallest angle to another bond at the node, degrees."""
        turns = [abs((angle - other + 180) % 360 - 180) for other in self.angles.get(node, ())]
        return min(turns, default=360.0)

    def _fits(self, spot: tuple[Point, Box, Point, Point]) -> bool:
        _, box, start, stop = spot
        return self.canvas.room_for_box(box.grow(4)) and self.canvas.room_for_line(start, stop)

    def _fasten(
        self, leaf: Leaf, at: Point, box: Box, start: Point, stop: Point, angle: float
    ) -> None:
        self._put(leaf.node, at)
        self.canvas.line(start, stop)
        self.angles.setdefault(leaf.host, []).append(angle)
        if self.scene.graph.bonds[leaf.bond].tail.node == leaf.node:
            start, stop = stop, start
        self.wires.append(Wire(leaf.bond, (start, stop)))

    def _name_junctions(self) -> None:
        """Small names beside the junctions, where there is room beside strokes and arrow heads."""
        self.tags.clear()
        for p, q in self._bars():
            self.canvas.line(p, q)
        for n in self.layers.vertices:
            tag = self.scene.items[n].tag
            if n not in self.centre or not tag:
                continue
            x, y = self.centre[n]
            w = width(tag, SMALL)
            for at in _name_spots(x, y, w):
                box = around(*at, w, SMALL + 1)
                if self.canvas.room_for_box(box.grow(1.5)):
                    self.tags[n] = at
                    self.canvas.box(box)
                    break

    def _bars(self) -> Iterator[tuple[Point, Point]]:
        """Across both ends of every bond, where a stroke or half an arrow head may stand."""
        seen = [wire.points for wire in self.wires]
        for leg in self.legs:
            ends = (self.box.get(v) for v in (leg.a, leg.b))
            seen.append(clip(*leg.ends(self.centre), *ends))
        for p, q in seen:
            length = math.dist(p, q) or 1.0
            dx, dy = _STROKE * (q[0] - p[0]) / length, _STROKE * (q[1] - p[1]) / length
            for x, y in (p, q):
                yield (x - dy, y + dx), (x + dy, y - dx)

    # ---------------------------------------------------------------- frames

    def _frame(self) -> None:
        """Frames around submodels, the inner ones first; one that would lie is left out."""
        scene = self.scene
        self.frames.clear()
        here = sorted(self.box)
        members: dict[Path, list[int]] = {}
        for n in here:
            for path in scene.frames_of(n):
                members.setdefault(path, []).append(n)
        done: dict[Path, Box] = {}
        for path in sorted(members, key=lambda p: (-len(p), p)):
            box = self.box[members[path][0]]
            for n in members[path]:
                box = box.join(self.box[n])
                if n in self.tags:
                    w = width(scene.items[n].tag, SMALL)
                    box = box.join(around(*self.tags[n], w, SMALL))
            for inner, inner_box in done.items():
                if inner[: len(path)] == path:
                    box = box.join(inner_box)
            box = box.grow(_PAD)._replace(y0=box.y0 - _PAD - _TITLE)
            own = set(members[path])
            lies = any(n not in own and box.meets(self.box[n].grow(1)) for n in here)
            lies = lies or any(
                box.meets(other) and inner[: len(path)] != path for inner, other in done.items()
            )
            if lies:
                self.unframed.add(path)
            else:
                done[path] = box
        self.frames = [Frame(path, box) for path, box in sorted(done.items())]
        boxes = [*self.box.values(), *done.values()]
        boxes += [around(x, y, 8, 8) for x, y in self.centre.values()]
        for n, at in self.tags.items():
            boxes.append(around(*at, width(scene.items[n].tag, SMALL), SMALL))
        total = boxes[0]
        for box in boxes:
            total = total.join(box)
        self.bounds = total

    def reach(self, node: int) -> tuple[float, float]:
        """How far the node and its own one-ports reach to the left and to the right."""
        box = self.box[node]
        frames = self.scene.frames_of(node)
        for leaf in self.scene.leaves.get(node, ()):
            if self.scene.frames_of(leaf.node) == frames:
                box = box.join(self.box[leaf.node])
        x = self.centre[node][0]
        return x - box.x0, box.x1 - x


def _name_spots(x: float, y: float, wide: float) -> Iterator[Point]:
    """Where the name of a junction may stand, the usual places first."""
    for dx, dy in _NAMES:
        yield x + dx * (wide / 2 + 14), y + dy
    for out, angle in itertools.product(_FAR_NAMES, _COMPASS + _BETWEEN + _FINE):
        turn = math.radians(angle)
        yield x + math.cos(turn) * (out + wide / 2), y + math.sin(turn) * out


class Leg(NamedTuple):
    """A straight piece of a skeleton bond between two vertices, shifted aside by `shift` px.

    `a` is on the left. `away` is -1 or 1 where the other vertex is on another line of the paper,
    to the left or to the right.
    """

    bond: int
    a: int
    b: int
    shift: float
    away: int

    def ends(self, centre: dict[int, Point]) -> tuple[Point, Point]:
        """The two ends, from centre to centre."""
        if self.away:
            x, y = centre[self.a if self.away > 0 else self.b]
            far = (x + 400.0 * self.away, y)
            return ((x, y), far) if self.away > 0 else (far, (x, y))
        p, q = centre[self.a], centre[self.b]
        if not self.shift:
            return p, q
        length = math.hypot(q[0] - p[0], q[1] - p[1]) or 1.0
        nx, ny = (p[1] - q[1]) / length * self.shift, (q[0] - p[0]) / length * self.shift
        return (p[0] + nx, p[1] + ny), (q[0] + nx, q[1] + ny)


def _angle(p: Point, q: Point) -> float:
    return math.degrees(math.atan2(q[1] - p[1], q[0] - p[0])) % 360


def clip(p: Point, q: Point, a: Box | None, b: Box | None) -> tuple[Point, Point]:
    """The line without what is hidden by the labels at its ends."""
    nothing = Box(0, 0, 0, 0)
    seen = between(p, q, a.grow(GAP) if a else nothing, b.grow(GAP) if b else nothing)
    return seen or (p, q)
