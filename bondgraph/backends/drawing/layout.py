"""Where the junctions and two-ports of a drawing stand: layers from left to right along power.

Two kinds of side branches stand upright in the column of what they hang on, as textbooks draw
them: the end of a branch beside a row that goes on (the suspension of a car), and what joins two
junctions of one column (the middle of a Wheatstone bridge).
"""

from __future__ import annotations

import itertools
from bisect import bisect_right, insort
from collections.abc import Callable, Container, Iterator
from statistics import median

from bondgraph.ir.groups import Groups
from bondgraph.text.tuples import NamedTuple

_SWEEPS = 24  # over all columns, to the right and to the left
_FEW = 300  # vertices up to which several orders are tried
_WORK = 300  # vertices and bonds that are laid out once more, from other vertices, for no crossing
_MANY = 4000  # vertices beyond which crossings are not minimised


class Route(NamedTuple):
    """A bond of the skeleton: the vertices on its way, bends included, from tail to head."""

    bond: int
    vertices: tuple[int, ...]


class Layers(NamedTuple):
    """One connected part: `column` and `row` of every vertex, bends included, and the routes.

    Vertices that stand `upright` have their columns from those that they hang on.
    """

    vertices: tuple[int, ...]
    column: dict[int, int]
    row: dict[int, float]
    routes: tuple[Route, ...]
    upright: frozenset[int] = frozenset()


def parts(
    nodes: list[int],
    edges: list[tuple[int, int, int]],
    hangs: Callable[[int, int], bool] = lambda node, host: True,
) -> list[Layers]:
    """The connected parts in the order of their first nodes; an edge is (tail, head, bond).

    Vertices that are not nodes are bends, numbered from -2 downwards. `hangs` says of a node
    whether it may stand above or below another one.
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
        part = _part(sorted(members), own.get(groups.find(members[0]), []), bends, hangs)
        bends = min([bends, *part.column])
        found.append(part)
    return found


def _part(
    members: list[int],
    edges: list[tuple[int, int, int]],
    bends: int,
    hangs: Callable[[int, int], bool],
) -> Layers:
    """The layers with as much upright as costs no crossing.

    Where bonds would cross the power may run to the left, from another vertex as the first: those
    are tried that power comes from, then the rest.
    """
    branches = _branches(members, edges, hangs)
    between = _crosspieces(members, edges, branches, hangs)
    best: tuple[int, Layers] | None = None
    tries = [({**branches, **between}, -1)] if between else []
    tries += [(branches, -1), ({}, -1)]
    entered = {head for _, head, _ in edges}
    others = sorted((n for n in members if n not in branches), key=lambda n: n in entered)
    tries += [(branches, n) for n in others[: _WORK // (len(members) + len(edges))]]
    for upright, first in tries:
        if best is None or best[0]:
            found = _layered(members, edges, bends, upright, first)
            if found is not None and (best is None or found[0] < best[0]):
                best = found
    assert best is not None
    return best[1]


def _layered(
    members: list[int],
    edges: list[tuple[int, int, int]],
    bends: int,
    upright: dict[int, tuple[int, ...]],
    first: int,
) -> tuple[int, Layers] | None:
    """The part with these vertices upright, and how many of its bonds cross.

    None where something stands between the ends of what is upright. `first`: as for `_columns`.
    """
    column = _columns(*_without(members, edges, upright), first)
    column.update({n: column[hosts[0]] for n, hosts in upright.items()})
    vertices = [n for n in members if n not in upright]
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
        if column[tail] != column[head]:
            links += itertools.pairwise(way)
    found = _rows(vertices, links, column, upright)
    if found is None:
        return None
    crossings, row = found
    return crossings, Layers(tuple(members), column, row, tuple(routes), frozenset(upright))


# ------------------------------------------------------------------- upright


def _without(
    members: list[int], edges: list[tuple[int, int, int]], left_out: Container[int]
) -> tuple[list[int], list[tuple[int, int, int]]]:
    """The part without some of its vertices."""
    return (
        [n for n in members if n not in left_out],
        [e for e in edges if e[0] not in left_out and e[1] not in left_out],
    )


def _neighbours(edges: list[tuple[int, int, int]]) -> dict[int, list[tuple[int, bool]]]:
    """Of each vertex those at the other ends of its bonds, and whether power goes there."""
    near: dict[int, list[tuple[int, bool]]] = {}
    for tail, head, _ in edges:
        near.setdefault(tail, []).append((head, True))
        near.setdefault(head, []).append((tail, False))
    return near


def _branches(
    members: list[int], edges: list[tuple[int, int, int]], hangs: Callable[[int, int], bool]
) -> dict[int, tuple[int, ...]]:
    """Ends of branches beside a row that goes on, with what they hang on.

    Where all that comes in or goes out could hang, the row goes on with the bond written first.
    """
    near = _neighbours(edges)
    found: dict[int, tuple[int, ...]] = {}
    for host in members:
        beside = near.get(host, [])
        if len(beside) < 3:
            continue
        ends = [n for n, _ in beside if len(near[n]) == 1]
        for onwards in (True, False):
            side = [n for n, direction in beside if direction == onwards]
            if side and all(n in ends for n in side):
                ends.remove(side[0])
        hung = [n for n in ends if hangs(n, host)]
        found.update({n: (host,) for n in hung[:2]})  # one below, one above
    return found


def _crosspieces(
    members: list[int],
    edges: list[tuple[int, int, int]],
    hung: dict[int, tuple[int, ...]],
    hangs: Callable[[int, int], bool],
) -> dict[int, tuple[int, ...]]:
    """Vertices that join two of one column, when they are not asked where the columns are.

    Power has to come to both ends, and to leave them, without these too.
    """
    if len(members) > _FEW:
        return {}
    near = _neighbours(edges)
    found: dict[int, tuple[int, ...]] = {}
    for n in members:
        ends = tuple(dict.fromkeys(other for other, _ in near.get(n, [])))
        if len(near.get(n, [])) != 2 or len(ends) != 2 or n in ends:
            continue
        if any(e in hung or e in found or not hangs(n, e) for e in ends):
            continue
        left_out = {n, *hung, *found}
        if not all({way for v, way in near[e] if v not in left_out} == {True, False} for e in ends):
            continue
        rest, bonds = _without(members, edges, left_out)
        groups = Groups[int]()
        for tail, head, _ in bonds:
            groups.join(tail, head)
        if len(groups.among(rest)) == 1:
            column = _columns(rest, bonds)
            if column[ends[0]] == column[ends[1]]:
                found[n] = ends
    return found


def _insert(columns: list[list[int]], upright: dict[int, tuple[int, ...]]) -> bool:
    """Put what stands upright into the columns; False where others stand between its ends."""
    place = {v: layer for layer in columns for v in layer}
    between = {n: hosts for n, hosts in upright.items() if len(hosts) == 2}
    for n, hosts in between.items():
        layer = place[hosts[0]]
        first, last = sorted(map(layer.index, hosts))
        if last != first + 1:
            return False
        layer.insert(last, n)
    for n, (host, *_) in upright.items():
        if n not in between:
            layer = place[host]
            at = layer.index(host)
            taken = layer[at + 1 : at + 2]
            below = not taken or taken[0] not in upright
            if not below and at and layer[at - 1] in upright:
                return False
            layer.insert(at + below, n)
    return True


# ------------------------------------------------------------------- columns


def _columns(
    members: list[int], edges: list[tuple[int, int, int]], first: int = -1
) -> dict[int, int]:
    """Longest paths along the half arrows; an arrow that would close a circle runs backwards.

    From a `first` vertex, if there is one, the paths lead away, whatever the arrows say.
    """
    out: dict[int, list[int]] = {n: [] for n in members}
    for tail, head, _ in edges:
        if tail != head:
            out[tail].append(head)
    order = _depth_first(members, out) if first < 0 else _breadth_first(first, edges)
    place = {n: i for i, n in enumerate(order)}
    ahead: dict[int, list[int]] = {n: [] for n in members}
    behind: dict[int, list[int]] = {n: [] for n in members}
    for tail, head, _ in edges:
        if tail != head:
            left, right = (tail, head) if place[tail] < place[head] else (head, tail)
            ahead[left].append(right)
            behind[right].append(left)
    column: dict[int, int] = {}
    for n in order:
        column[n] = max([column[b] + 1 for b in behind[n]], default=0)
    for n in reversed(order):  # shorten what leads into a later column
        if len(ahead[n]) > len(behind[n]):
            column[n] = max(column[n], min(column[a] for a in ahead[n]) - 1)
    first_column = min(column.values())
    return {n: column[n] - first_column for n in members}


def _breadth_first(first: int, edges: list[tuple[int, int, int]]) -> list[int]:
    """The vertices by how many bonds lead to them."""
    near = _neighbours(edges)
    order = [first]
    seen = {first}
    for n in order:
        for other, _ in near.get(n, []):
            if other not in seen:
                seen.add(other)
                order.append(other)
    return order


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


# ---------------------------------------------------------------------- rows


def _rows(
    vertices: list[int],
    links: list[tuple[int, int]],
    column: dict[int, int],
    upright: dict[int, tuple[int, ...]],
) -> tuple[int, dict[int, float]] | None:
    """Rows with few crossings and straight bonds (Sugiyama 1981; Brandes and Koepf 2002).

    With how many crossings that are, as far as they are counted. None where something stands
    between the ends of what is upright.
    """
    layers: dict[int, int] = {}
    for v in vertices:
        layers[column[v]] = layers.get(column[v], 0) + 1
    if max(layers.values()) == 1 and not upright:
        return 0, dict.fromkeys(vertices, 0.0)
    if len(vertices) > _MANY:
        used: dict[int, int] = {}
        rows = {}
        for v in [*vertices, *upright]:
            rows[v] = float(used.setdefault(column[v], 0))
            used[column[v]] += 1
        return 0, rows
    best: tuple[tuple[int, float], dict[int, float]] | None = None
    for order in _orders(vertices):
        found = _sugiyama(order, links, column, upright)
        if found is None:
            continue
        cost = _cost(found, links, column) if len(vertices) <= _FEW else (0, 0.0)
        if best is None or cost < (best[0][0], best[0][1] - 1e-9):
            best = cost, found
    if best is None:
        return None
    low = min(best[1].values())
    return best[0][0], {v: row - low for v, row in best[1].items()}


def _orders(vertices: list[int]) -> list[list[int]]:
    """Orders to start from: the search for few crossings ends in the nearest valley."""
    if len(vertices) > _FEW:
        return [vertices]
    orders = [vertices, vertices[::-1]]
    for stride in (7, 11, 13, 17):
        orders.append(sorted(vertices, key=lambda v: ((v * stride) % 19, v)))
    return orders


def _sugiyama(
    order: list[int],
    links: list[tuple[int, int]],
    column: dict[int, int],
    upright: dict[int, tuple[int, ...]],
) -> dict[int, float] | None:
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
    columns = [sorted(c, key=best[1].__getitem__) for c in columns]
    if not _insert(columns, upright):
        return None
    return _straightened(columns, near, best[1], upright)


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
    columns: list[list[int]],
    near: tuple[dict[int, list[int]], ...],
    row: dict[int, float],
    upright: dict[int, tuple[int, ...]],
) -> dict[int, float]:
    """The rows, in the order that they have, where the bonds climb least.

    A vertex goes to the median of its neighbours; those that would come too close go together, to
    the median of them all (isotonic regression: Barlow and others, 1972). What stands upright wants
    to go where those that it hangs on want to.
    """
    best = None
    row = {v: row.get(v, float(i)) for layer in columns for i, v in enumerate(layer)}
    for sweep in range(_SWEEPS):
        sides = near if sweep >= _SWEEPS - 2 else near[sweep % 2 :][:1]
        for layer in columns[:: 1 - 2 * (sweep % 2)]:
            blocks: list[tuple[list[int], list[float]]] = []
            wishes = {
                v: [row[n] - i for side in sides for n in side[v]] or [row[v] - i]
                for i, v in enumerate(layer)
                if v not in upright
            }
            for v in layer:
                wanted = [w for host in upright.get(v, (v,)) for w in wishes[host]]
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


def _cost(
    rows: dict[int, float], links: list[tuple[int, int]], column: dict[int, int]
) -> tuple[int, float]:
    """Crossings, and the heights that bonds climb and that the figure takes."""
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
    return crossings, climb + max(rows.values()) - min(rows.values())
