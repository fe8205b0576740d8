"""The way of a signal round what is drawn: the shortest on a grid (A*: Hart and others, 1968).

A way is tight: it has no more bends than what it goes round needs.
"""

from __future__ import annotations

import heapq
import itertools
import math

from bondgraph.backends.drawing.canvas import Box, Canvas, Point

_GRID = 12.0  # px
_CLEAR = 6.0  # px from the boxes at its ends, within which a way has no bends
_CROSSED = 800.0  # px that a way may be longer instead of crossing a line
_MARGIN = 5  # cells around the figure
_ROUND = 14.0  # px, of corners
_MOVES = [(i, j) for i in (-1, 0, 1) for j in (-1, 0, 1) if i or j]

Cell = tuple[int, int]
_END = (1 << 30, 0)  # within the box that a way leads to


def detour(
    here: Box, to: Box, bounds: Box, texts: Canvas, lines: Canvas, most: int
) -> tuple[tuple[Point, ...] | None, int]:
    """A way between two boxes that hits no text and crosses as few lines as a person would.

    None where texts leave no way, or `most` points were looked at; with how many that were.
    """
    starts, goals = _around(here, texts, lines), _around(to, texts, lines)
    middle = _middle(to)
    low, high = _cell((bounds.x0, bounds.y0)), _cell((bounds.x1, bounds.y1))
    cost = dict(starts)
    before: dict[Cell, Cell] = {}
    queue = [(c + math.dist(_point(cell), middle), cell) for cell, c in cost.items()]
    heapq.heapify(queue)
    done: set[Cell] = set()
    while queue and len(done) < most:
        _, cell = heapq.heappop(queue)
        if cell in done:
            continue
        if cell == _END:
            way = _back(before[cell], before)
            return _tightened(way, here, to, texts, lines), len(done)
        done.add(cell)
        if cell in goals and cost[cell] + goals[cell] < cost.get(_END, math.inf):
            cost[_END], before[_END] = cost[cell] + goals[cell], cell
            heapq.heappush(queue, (cost[_END], _END))
        for i, j in _MOVES:
            there = cell[0] + i, cell[1] + j
            if there in done or not all(
                a - _MARGIN <= x <= b + _MARGIN for a, x, b in zip(low, there, high, strict=True)
            ):
                continue
            p, q = _point(cell), _point(there)
            known = cost.get(there, math.inf)
            length = cost[cell] + math.dist(p, q)
            if length >= known or not texts.room_for_line(p, q):
                continue
            length += _CROSSED * lines.crossings(p, q)
            if length < known:
                cost[there], before[there] = length, cell
                heapq.heappush(queue, (length + math.dist(q, middle), there))
    return None, len(done)


def _cell(p: Point) -> Cell:
    return round(p[0] / _GRID), round(p[1] / _GRID)


def _point(cell: Cell) -> Point:
    """A point of the grid, a little askew: on no line that stands upright or lies level."""
    return cell[0] * _GRID + 0.031 * cell[1] + 0.37, cell[1] * _GRID + 0.029 * cell[0] + 0.41


def _middle(box: Box) -> Point:
    return (box.x0 + box.x1) / 2, (box.y0 + box.y1) / 2


def _around(box: Box, texts: Canvas, lines: Canvas) -> dict[Cell, float]:
    """The points of the grid close around a box, with what it costs to get there.

    Where a text is in between there is no way.
    """
    inner, outer = box.grow(_CLEAR), box.grow(_CLEAR + 1.5 * _GRID)
    low, high = _cell((outer.x0, outer.y0)), _cell((outer.x1, outer.y1))
    found = {}
    for cell in itertools.product(range(low[0], high[0] + 1), range(low[1], high[1] + 1)):
        x, y = p = _point(cell)
        at = Box(x, y, x, y)
        if outer.holds(at) and not inner.holds(at) and texts.room_for_line(p, _nearest(inner, p)):
            crossings = lines.crossings(p, _nearest(box.grow(3), p))
            found[cell] = math.dist(p, _middle(box)) + _CROSSED * crossings
    return found


def _back(cell: Cell, before: dict[Cell, Cell]) -> list[Point]:
    way = [cell]
    while way[-1] in before:
        way.append(before[way[-1]])
    return [_point(c) for c in reversed(way)]


def _tightened(
    way: list[Point], here: Box, to: Box, texts: Canvas, lines: Canvas
) -> tuple[Point, ...]:
    """The way pulled straight between its bends, from the border of a box to that of the other."""
    crossed = [lines.crossings(p, q) for p, q in itertools.pairwise(way)]
    kept = [way[0]]
    at = 0
    while at < len(way) - 1:
        for far in range(len(way) - 1, at, -1):
            p, q = way[at], way[far]
            straight = texts.room_for_line(p, q) and lines.crossings(p, q) <= sum(crossed[at:far])
            if straight or far == at + 1:
                break
        kept.append(way[far])
        at = far
    ends = _nearest(here.grow(4), kept[0]), _nearest(to.grow(3), kept[-1])
    return _rounded([ends[0], *kept, ends[1]])


def _nearest(box: Box, p: Point) -> Point:
    return min(max(p[0], box.x0), box.x1), min(max(p[1], box.y0), box.y1)


def _rounded(way: list[Point]) -> tuple[Point, ...]:
    """The way with its corners cut by quadratic curves."""
    found = [way[0]]
    for a, b, c in zip(way, way[1:], way[2:], strict=False):
        found += [p for p in _corner(a, b, c) if math.dist(p, found[-1]) > 0.5]
    return (*found, way[-1])


def _corner(a: Point, b: Point, c: Point) -> list[Point]:
    before, after = math.dist(a, b), math.dist(b, c)
    if before < 1 or after < 1:
        return [b]
    s, t = min(_ROUND / before, 0.5), min(_ROUND / after, 0.5)
    first = b[0] + s * (a[0] - b[0]), b[1] + s * (a[1] - b[1])
    last = b[0] + t * (c[0] - b[0]), b[1] + t * (c[1] - b[1])
    return list(quadratic(first, b, last, 5))


def quadratic(p: Point, control: Point, q: Point, pieces: int) -> list[Point]:
    """A quadratic curve as so many points."""
    found = []
    for k in range(pieces):
        t = k / (pieces - 1)
        a, b, c = (1 - t) ** 2, 2 * t * (1 - t), t**2
        found.append((a * p[0] + b * control[0] + c * q[0], a * p[1] + b * control[1] + c * q[1]))
    return found
