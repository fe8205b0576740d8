"""Where the junctions and two-ports of a drawing stand: layers from left to right along power."""

from __future__ import annotations

import itertools
from bisect import bisect_right, insort
from collections.abc import Iterator
from statistics import median

from bondgraph.ir.groups import Groups
from bondgraph.text.tuples import NamedTuple

_SWEEPS = 24  # over all columns, to the right and to the left
_FEW = 300  # vertices up to which several orders are tried
_MANY = 4000  # vertices beyond which crossings are not minimised


class Route(NamedTuple):
    """A bond of the skeleton: the vertices on its way, bends included, from tail to head."""

    bond: int
    vertices: tuple[int, ...]


class Layers(NamedTuple):
    """One connected part: `column` and `row` of every vertex, bends included, and the routes."""

    vertices: tuple[int, ...]
    column: dict[int, int]
    row: dict[int, float]
    routes: tuple[Route, ...]


def parts(nodes: list[int], edges: list[tuple[int, int, int]]) -> list[Layers]:
    """The connected parts in the order of their first nodes; an edge is (tail, head, bond).

    Vertices that are not nodes are bends, numbered from -2 downwards.
    """
    groups = Groups[int]()
    for tail, head, _ in edges:
        groups.join(tail, head)
    own: dict[int, list[tuple[int, int, int]]] = {}
    for edge in edges:
        own.setdefault(groups.find(edge[0]), []).append(edge)
    found: list[Layers] = []
    bends = -1  # bends have negative numbers, no two of them in all parts the same
    for members in groups.among(nodes):
        part = _part(sorted(members), own.get(groups.find(members[0]), []), bends)
        bends = min([bends, *part.column])
        found.append(part)
    return found


def _part(members: list[int], edges: list[tuple[int, int, int]], bends: int) -> Layers:
    column = _columns(members, edges)
    vertices = list(members)
    routes = []
    links: list[tuple[int, int]] = []
    for tail, head, bond in edges:
        way = [tail]
        step = 1 if column[head] > column[tail] else -1
        for c in range(column[tail] + step, column[head], step):
            bends -= 1
            column[bends] = c
            vertices.append(bends)
            way.append(bends)
        way.append(head)
        routes.append(Route(bond, tuple(way)))
        if tail != head:
            links += itertools.pairwise(way)
    return Layers(tuple(members), column, _rows(vertices, links, column), tuple(routes))


def _columns(members: list[int], edges: list[tuple[int, int, int]]) -> dict[int, int]:
    """Longest paths along the half arrows; an arrow that would close a circle runs backwards."""
    out: dict[int, list[int]] = {n: [] for n in members}
    for tail, head, _ in edges:
        if tail != head:
            out[tail].append(head)
    order = _depth_first(members, out)
    place = {n: i for i, n in enumerate(order)}
    ahead: dict[int, list[int]] = {n: [] for n in members}
    behind: dict[int, list[int]] = {n: [] for n in members}
    for tail, head, _ in edges:
        if tail != head:
            first, last = (tail, head) if place[tail] < place[head] else (head, tail)
            ahead[first].append(last)
            behind[last].append(first)
    column: dict[int, int] = {}
    for n in order:
        column[n] = max([column[b] + 1 for b in behind[n]], default=0)
    for n in reversed(order):  # shorten what leads into a later column
        if len(ahead[n]) > len(behind[n]):
            column[n] = max(column[n], min(column[a] for a in ahead[n]) - 1)
    first_column = min(column.values())
    return {n: column[n] - first_column for n in members}


def _depth_first(members: list[int], out: dict[int, list[int]]) -> list[int]:
    """A topological order, but for the arrows that close circles."""
    entered = {head for heads in out.values() for head in heads}
    roots = [n for n in members if n not in entered] + members
    done: set[int] = set()
    order: list[int] = []
    for root in roots:
        if root in done:
            continue
        done.add(root)
        work = [(root, iter(out[root]))]
        while work:
            node, heads = work[-1]
            for head in heads:
                if head not in done:
                    done.add(head)
                    work.append((head, iter(out[head])))
                    break
            else:
                order.append(node)
                work.pop()
    return order[::-1]


def _rows(
    vertices: list[int], links: list[tuple[int, int]], column: dict[int, int]
) -> dict[int, float]:
    """Rows with few crossings and straight bonds (Sugiyama 1981; Brandes and Koepf 2002)."""
    layers: dict[int, int] = {}
    for v in vertices:
        layers[column[v]] = layers.get(column[v], 0) + 1
    if max(layers.values()) == 1:
        return dict.fromkeys(vertices, 0.0)
    if len(vertices) > _MANY:
        used: dict[int, int] = {}
        rows = {}
        for v in vertices:
            rows[v] = float(used.setdefault(column[v], 0))
            used[column[v]] += 1
        return rows
    best: tuple[float, dict[int, float]] | None = None
    for order in _orders(vertices):
        rows = _sugiyama(order, links, column)
        cost = _cost(rows, links, column) if len(vertices) <= _FEW else 0.0
        if best is None or cost < best[0] - 1e-9:
            best = cost, rows
    assert best is not None
    low = min(best[1].values())
    return {v: row - low for v, row in best[1].items()}


def _orders(vertices: list[int]) -> list[list[int]]:
    """Orders to start from: the search for few crossings ends in the nearest valley."""
    if len(vertices) > _FEW:
        return [vertices]
    orders = [vertices, vertices[::-1]]
    for stride in (7, 11, 13, 17):
        orders.append(sorted(vertices, key=lambda v: ((v * stride) % 19, v)))
    return orders


def _sugiyama(
    order: list[int], links: list[tuple[int, int]], column: dict[int, int]
) -> dict[int, float]:
    """Columns sorted by the mean row of their neighbours, back and forth (Sugiyama 1981)."""
    layers: dict[int, list[int]] = {c: [] for c in sorted({column[v] for v in order})}
    for v in order:
        layers[column[v]].append(v)
    near: tuple[dict[int, list[int]], ...] = ({v: [] for v in order}, {v: [] for v in order})
    for a, b in dict.fromkeys((a, b) if column[a] < column[b] else (b, a) for a, b in links):
        near[0][b].append(a)
        near[1][a].append(b)
    columns = list(layers.values())
    row = {v: at for layer in columns for v, at in _centred(layer)}
    best = len(links) ** 2, row
    for sweep in range(_SWEEPS if len(order) < 1000 else 6):
        side = near[sweep % 2]
        for layer in columns[:: 1 - 2 * (sweep % 2)]:
            layer.sort(key=lambda v: sum(row[n] for n in side[v]) / len(side[v])
                       if side[v] else row[v])  # fmt: skip
            row.update(_centred(layer))
        crossings = _crossings(columns, near[1], row)
        if crossings < best[0]:
            best = crossings, dict(row)
    return _straightened([sorted(c, key=best[1].__getitem__) for c in columns], near, best[1])


def _centred(layer: list[int]) -> Iterator[tuple[int, float]]:
    """Rows of a column around the middle of the figure."""
    return ((v, i - (len(layer) - 1) / 2) for i, v in enumerate(layer))


def _crossings(columns: list[list[int]], after: dict[int, list[int]], row: dict[int, float]) -> int:
    """The bonds that cross: pairs in the other order at their right ends."""
    found = 0
    for layer in columns:
        ends: list[float] = []
        for v in layer:
            own = [row[n] for n in after[v]]
            found += sum(len(ends) - bisect_right(ends, end) for end in own)
            for end in own:
                insort(ends, end)
    return found


def _straightened(
    columns: list[list[int]], near: tuple[dict[int, list[int]], ...], row: dict[int, float]
) -> dict[int, float]:
    """The rows, in the order that they have, where the bonds climb least.

    A vertex goes to the median of its neighbours; those that would come too close go together, to
    the median of them all (isotonic regression: Barlow and others, 1972).
    """
    best = None
    row = dict(row)
    for sweep in range(_SWEEPS):
        sides = near if sweep >= _SWEEPS - 2 else near[sweep % 2 :][:1]
        for layer in columns[:: 1 - 2 * (sweep % 2)]:
            blocks: list[tuple[list[int], list[float]]] = []
            for i, v in enumerate(layer):
                wanted = [row[n] - i for side in sides for n in side[v]] or [row[v] - i]
                block = [v], sorted(wanted)
                while blocks and median(blocks[-1][1]) >= median(block[1]):
                    before = blocks.pop()
                    block = before[0] + block[0], sorted(before[1] + block[1])
                blocks.append(block)
            at = [median(wanted) for members, wanted in blocks for _ in members]
            row.update({v: at[i] + i for i, v in enumerate(layer)})
        climb = sum(abs(row[a] - row[b]) for a, heads in near[1].items() for b in heads)
        climb += max(row.values()) - min(row.values())
        if best is None or climb < best[0]:
            best = climb, dict(row)
    assert best is not None
    return best[1]


def _cost(rows: dict[int, float], links: list[tuple[int, int]], column: dict[int, int]) -> float:
    """Crossings above all, then the heights that bonds climb and that the figure takes."""
    by_column: dict[int, list[tuple[float, float]]] = {}
    for a, b in links:
        left, right = (a, b) if column[a] < column[b] else (b, a)
        by_column.setdefault(column[left], []).append((rows[left], rows[right]))
    crossings = sum(
        (a - c) * (b - d) < 0
        for pairs in by_column.values()
        for i, (a, b) in enumerate(pairs)
        for c, d in pairs[:i]
    )
    climb = sum(abs(a - b) for pairs in by_column.values() for a, b in pairs)
    return 20.0 * crossings + climb + max(rows.values()) - min(rows.values())
