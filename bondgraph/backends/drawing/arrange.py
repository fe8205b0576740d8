"""From a scene to a figure: column widths, lines of the paper, parts one below the other."""

from __future__ import annotations

import itertools
from collections.abc import Callable, Iterable

from bondgraph.backends.drawing.canvas import Box, Canvas, Point, around
from bondgraph.backends.drawing.layout import Layers, Route, parts
from bondgraph.backends.drawing.place import Frame, Leg, Part, Wire, clip
from bondgraph.backends.drawing.scene import Path, Scene
from bondgraph.backends.drawing.style import SMALL, width
from bondgraph.text.tuples import NamedTuple

_BOND = 56.0  # visible length of a bond of the skeleton at least, px
_WALL = 2 * 9.0
_LINE = 1700.0  # parts wider than this are broken into lines, px
_SHELF = 1150.0  # small parts stand side by side up to this width, px
_APART = 46.0
_LANE = 9.0
_SPREADS = (1.0, 1.25, 1.6, 2.1, 2.8)  # tried in turn until every one-port finds room
_MANY = 400  # vertices and bends beyond which a crowded part is left as it is


class Figure(NamedTuple):
    """Everything with its place, px, y downwards, the upper left corner at the origin."""

    centre: dict[int, Point]
    wires: tuple[Wire, ...]
    tags: dict[int, Point]
    labels: dict[int, Point]
    frames: tuple[Frame, ...]
    size: Point


def arrange(scene: Scene) -> tuple[Figure, frozenset[Path]]:
    """The figure, and the submodels whose frames would enclose what is not theirs."""
    layered = parts(list(scene.skeleton), list(scene.links), scene.hangs)
    blocks = [_block(scene, layers) for layers in layered]
    places = _shelves([box for _, _, box in blocks])
    centre: dict[int, Point] = {}
    tags: dict[int, Point] = {}
    wires: list[Wire] = []
    frames: list[Frame] = []
    unframed: set[Path] = set()
    for (lines, routes, box), (x, y) in zip(blocks, places, strict=True):
        dx, dy = x - box.x0, y - box.y0
        for line, down in lines:
            unframed |= line.unframed
            for n in line.box:
                centre[n] = _moved(line.centre[n], dx, dy + down)
            tags.update({n: _moved(at, dx, dy + down) for n, at in line.tags.items()})
            frames += [Frame(f.path, f.box.move(dx, dy + down)) for f in line.frames]
            wires += [_shift(w, dx, dy + down) for w in line.wires]
        wires += [_shift(w, dx, dy) for w in routes]
    wires.sort(key=lambda w: w.bond)
    right = max([x + box.x1 - box.x0 for (_, _, box), (x, _) in zip(blocks, places, strict=True)],
                default=0.0)  # fmt: skip
    down = max([y + box.y1 - box.y0 for (_, _, box), (_, y) in zip(blocks, places, strict=True)],
               default=0.0)  # fmt: skip
    labels = _labels(scene, centre, tags, wires, frames)
    size = (right, down)
    return Figure(centre, tuple(wires), tags, labels, tuple(frames), size), frozenset(unframed)


def framed(make: Callable[[frozenset[Path]], Scene]) -> tuple[Scene, Figure]:
    """The figure with the frames that can be drawn; names say what the others would have said.

    `make` gives the scene without the frames of some submodels.
    """
    unframed: frozenset[Path] = frozenset()
    for _ in range(3):
        view = make(unframed)
        figure, more = arrange(view)
        if more <= unframed:
            return view, figure
        unframed |= more
    view = make(unframed | frozenset(view.frames))
    return view, arrange(view)[0]


def _moved(p: Point, dx: float, dy: float) -> Point:
    return p[0] + dx, p[1] + dy


def _shift(wire: Wire, dx: float, dy: float) -> Wire:
    return Wire(wire.bond, tuple(_moved(p, dx, dy) for p in wire.points))


def _shelves(boxes: list[Box]) -> list[Point]:
    """Parts in order, side by side while they fit, then below."""
    limit = max([_SHELF, *[b.x1 - b.x0 for b in boxes]])
    places = []
    x = y = low = 0.0
    for box in boxes:
        w, h = box.x1 - box.x0, box.y1 - box.y0
        if x and x + w > limit:
            x, y = 0.0, low + _APART
        places.append((x, y))
        x += w + _APART
        low = max(low, y + h)
    return places


# ------------------------------------------------------------------ one part


def _block(scene: Scene, layers: Layers) -> tuple[list[tuple[Part, float]], list[Wire], Box]:
    """One connected part: its lines with their heights, its skeleton bonds, its bounds."""
    shifts = _shifts(layers)
    for spread in _SPREADS if len(layers.column) < _MANY else _SPREADS[:1]:
        lines = _lines(scene, layers, shifts, spread)
        if not any(line.crowded for line, _ in lines):
            break
    bounds = lines[0][0].bounds
    for line, down in lines:
        bounds = bounds.join(line.bounds.move(0, down))
    routes, extra = _draw_routes(scene, layers, shifts, lines, bounds)
    return lines, routes, bounds.join(extra)


def _shifts(layers: Layers) -> dict[int, float]:
    """Sideways shifts of bonds that join the same two nodes."""
    together: dict[tuple[int, ...], list[int]] = {}
    for route in layers.routes:
        if len(route.vertices) == 2:
            together.setdefault(tuple(sorted(route.vertices)), []).append(route.bond)
    return {
        bond: (i - (len(bonds) - 1) / 2) * 17.0
        for bonds in together.values()
        for i, bond in enumerate(bonds)
    }


def _steps(scene: Scene, layers: Layers) -> list[float]:
    """The distance from each column to the next, so that labels and bonds have room."""
    columns = max(layers.column.values()) + 1
    half = [0.0] * columns
    for n in layers.vertices:
        wide = [scene.items[leaf.node].w for leaf in scene.leaves.get(n, ())]
        half[layers.column[n]] = max([half[layers.column[n]], *[w / 2 for w in wide]])
    steps = [half[c] + half[c + 1] + 16 for c in range(columns - 1)]
    for left, right, _ in _pairs(layers):
        c = layers.column[left]
        a, b = scene.items[left] if left >= 0 else None, scene.items[right] if right >= 0 else None
        need = _BOND + (a.w / 2 if a else 0) + (b.w / 2 if b else 0)
        if a and b:
            need += _WALL * scene.walls(left, right)
        steps[c] = max(steps[c], need)
    return steps


def _pairs(layers: Layers) -> list[tuple[int, int, int]]:
    """The straight pieces from column to column, left vertex first, with their bonds."""
    found = []
    for route in layers.routes:
        for a, b in zip(route.vertices, route.vertices[1:], strict=False):
            if layers.column[a] != layers.column[b]:
                forward = layers.column[a] < layers.column[b]
                found.append((a, b, route.bond) if forward else (b, a, route.bond))
    return found


def _positions(steps: list[float]) -> dict[int, float]:
    x = {0: 0.0}
    for c, step in enumerate(steps):
        x[c + 1] = x[c] + step
    return x


def _legs(layers: Layers, shifts: dict[int, float], columns: range) -> list[Leg]:
    """The straight pieces that are seen on the line of these columns."""
    legs = []
    for route in layers.routes:
        a, b = route.vertices[0], route.vertices[-1]
        if a != b and layers.column[a] == layers.column[b] and layers.column[a] in columns:
            legs.append(Leg(route.bond, a, b, shifts.get(route.bond, 0.0), 0))
    for a, b, bond in _pairs(layers):
        c = layers.column[a]
        if c in columns or c + 1 in columns:
            away = 0 if c in columns and c + 1 in columns else 1 if c in columns else -1
            legs.append(Leg(bond, a, b, shifts.get(bond, 0.0), away))
    return legs


def _widen(scene: Scene, layers: Layers, part: Part, steps: list[float]) -> list[float]:
    """More room between neighbours of different submodels, so that frames do not overlap."""
    wider = list(steps)
    for a, b, _ in _pairs(layers):
        if a >= 0 and b >= 0 and scene.walls(a, b):
            c = layers.column[a]
            need = part.reach(a)[1] + part.reach(b)[0] + _WALL * scene.walls(a, b) + 4
            wider[c] = max(wider[c], need)
    return wider


def _lines(
    scene: Scene, layers: Layers, shifts: dict[int, float], spread: float
) -> list[tuple[Part, float]]:
    """The part on one line, or broken into lines of about equal width."""
    steps = [spread * step for step in _steps(scene, layers)]
    x = _positions(steps)
    columns = len(steps) + 1
    total = x[columns - 1]
    if total <= _LINE:
        whole = Part(scene, layers, range(columns))
        legs = _legs(layers, shifts, whole.columns)
        whole.place(x, legs, spread)
        widened = _widen(scene, layers, whole, steps)
        if widened != steps:
            whole = Part(scene, layers, range(columns))
            whole.place(_positions(widened), legs, spread)
        return [(whole, 0.0)]
    walls = [0] * columns  # frames crossed after each column: good places to break the line
    crossing = [0] * columns
    for a, b, _ in _pairs(layers):
        crossing[layers.column[a]] += 1
        if a >= 0 and b >= 0:
            walls[layers.column[a]] = max(walls[layers.column[a]], scene.walls(a, b))
    lines: list[tuple[Part, float]] = []
    down = 0.0
    for columns_here in _breaks(x, walls, total / (total // _LINE + 1)):
        local = {c: x[c] - x[columns_here[0]] for c in columns_here}
        part = Part(scene, layers, columns_here)
        part.place(local, _legs(layers, shifts, columns_here), spread)
        if lines:
            room = _APART + crossing[columns_here[0] - 1] * _LANE
            down += lines[-1][0].bounds.y1 - part.bounds.y0 + room
        lines.append((part, down))
    return lines


def _breaks(x: dict[int, float], walls: list[int], about: float) -> list[range]:
    """The columns of each line: lines of nearly equal width, broken between submodels."""
    found = []
    start = 0
    while start < len(walls):
        ends = [c for c in range(start, len(walls)) if x[c] - x[start] <= 1.08 * about] or [start]
        end = ends[-1]
        if end < len(walls) - 1:
            window = [c for c in ends if x[c] - x[start] >= 0.7 * about] or ends[-1:]
            end = max(window, key=lambda c: (walls[c], c))
        found.append(range(start, end + 1))
        start = end + 1
    return found


def _draw_routes(
    scene: Scene,
    layers: Layers,
    shifts: dict[int, float],
    lines: list[tuple[Part, float]],
    bounds: Box,
) -> tuple[list[Wire], Box]:
    """The bonds of the skeleton; from one line to the next they run round the margin."""
    where = {v: (part, down) for part, down in lines for v in part.centre}
    lanes: dict[int, int] = {}
    wires = []
    extra = bounds

    def at(v: int) -> Point:
        part, down = where[v]
        return _moved(part.centre[v], 0, down)

    for route in layers.routes:
        way = route.vertices
        if way[0] == way[1]:
            points = _ear(at(way[0]))
        else:
            points = []
            for a, b in itertools.pairwise(way):
                left, right = (a, b) if layers.column[a] < layers.column[b] else (b, a)
                if where[left][0] is where[right][0]:
                    leg = Leg(route.bond, left, right, shifts.get(route.bond, 0.0), 0)
                    p, q = leg.ends({left: at(left), right: at(right)})
                    piece = [p, q]
                else:
                    lane = lanes.setdefault(layers.column[left], 0)
                    lanes[layers.column[left]] += 1
                    piece = _round(at(left), at(right), where[right], bounds, lane)
                points += piece if left == a else piece[::-1]
        wires.append(_clipped(scene, route, points))
        for px, py in wires[-1].points:
            extra = extra.join(Box(px, py, px, py))
    return wires, extra


def _ear(p: Point) -> list[Point]:
    """A bond from a junction to itself."""
    x, y = p
    return [(x - 5, y), (x - 22, y - 52), (x + 22, y - 52), (x + 5, y)]


def _round(p: Point, q: Point, below: tuple[Part, float], bounds: Box, lane: int) -> list[Point]:
    """From the end of one line round the margins to the start of the next."""
    part, down = below
    aside = 14 + _LANE * lane
    level = part.bounds.y0 + down - 20 - _LANE * lane
    right, left = bounds.x1 + aside, bounds.x0 - aside
    return [p, (right, p[1]), (right, level), (left, level), (left, q[1]), q]


def _clipped(scene: Scene, route: Route, points: list[Point]) -> Wire:
    tail, head = scene.items[route.vertices[0]], scene.items[route.vertices[-1]]
    # bonds shifted aside start beside the centre: the label's box stays where it is
    points = [p for i, p in enumerate(points) if not i or p != points[i - 1]]
    first, last = points[0], points[-1]
    a, b = around(*first, tail.w, tail.h), around(*last, head.w, head.h)
    if len(points) == 2:
        return Wire(route.bond, clip(first, last, a, b))
    start, _ = clip(first, points[1], a, None)
    _, stop = clip(points[-2], last, None, b)
    return Wire(route.bond, (start, *points[1:-1], stop))


def _labels(
    scene: Scene,
    centre: dict[int, Point],
    tags: dict[int, Point],
    wires: list[Wire],
    frames: list[Frame],
) -> dict[int, Point]:
    """Numbers of the figure beside their bonds, where there is room."""
    if not any(scene.bond_names):
        return {}
    canvas = covered(scene, centre, tags, wires, frames)
    placed: dict[int, Point] = {}
    for wire in wires:
        label = scene.bond_names[wire.bond]
        if not label:
            continue
        wide = width(label, SMALL)
        spots = _beside(wire, wide)
        free = (at for at in spots if canvas.room_for_box(around(*at, wide, SMALL)))
        placed[wire.bond] = next(free, spots[0])
        canvas.box(around(*placed[wire.bond], wide, SMALL))
    return placed


def covered(
    scene: Scene,
    centre: dict[int, Point],
    tags: dict[int, Point],
    wires: Iterable[Wire],
    frames: Iterable[Frame],
) -> Canvas:
    """What is on the paper already: labels, names, bonds, and the sides of frames."""
    canvas = Canvas()
    for n, at in centre.items():
        canvas.box(around(*at, scene.items[n].w, scene.items[n].h))
    for n, at in tags.items():
        canvas.box(around(*at, width(scene.items[n].tag, SMALL) + 4, SMALL))
    for frame in frames:
        x0, y0, x1, y1 = frame.box
        for p, q in (((x0, y0), (x0, y1)), ((x1, y0), (x1, y1)), ((x0, y1), (x1, y1))):
            canvas.line(p, q)
    for wire in wires:
        for p, q in zip(wire.points, wire.points[1:], strict=False):
            canvas.line(p, q)
    return canvas


def _beside(wire: Wire, w: float) -> list[Point]:
    """Places for a label, on the side without the barb first."""
    pieces = list(zip(wire.points, wire.points[1:], strict=False))
    p, q = max(pieces, key=lambda s: abs(s[0][0] - s[1][0]) + abs(s[0][1] - s[1][1]))
    dx, dy = q[0] - p[0], q[1] - p[1]
    length = (dx * dx + dy * dy) ** 0.5 or 1.0
    nx, ny = -dy / length, dx / length
    off = abs(nx) * w / 2 + abs(ny) * SMALL / 2 + 4
    return [
        (p[0] + t * dx - s * nx * (off + far), p[1] + t * dy - s * ny * (off + far))
        for far in (0, 6, 14)
        for t in (0.5, 0.42, 0.58, 0.34, 0.66, 0.74, 0.26, 0.82, 0.18)
        for s in (1, -1)
    ]
