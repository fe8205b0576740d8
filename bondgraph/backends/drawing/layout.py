"""Where the junctions and two-ports of a drawing stand: layers from left to right along power."""

from __future__ import annotations

import itertools

from bondgraph.text.tuples import NamedTuple

_ITERATIONS = 100
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
    near: dict[int, list[int]] = {n: [] for n in nodes}
    for i, (tail, head, _) in enumerate(edges):
        near[tail].append(i)
        near[head].append(i)
    seen: set[int] = set()
    found: list[Layers] = []
    bends = -1
    for root in nodes:
        if root in seen:
            continue
        seen.add(root)
        members = [root]
        for n in members:
            for i in near[n]:
                for other in edges[i][:2]:
                    if other not in seen:
                        seen.add(other)
                        members.append(other)
        members.sort()
        inside = sorted({i for n in members for i in near[n]})
        part = _part(members, [edges[i] for i in inside], bends)
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
    import igraph

    number = {v: i for i, v in enumerate(order)}
    pairs = {
        (number[a], number[b]) if column[a] < column[b] else (number[b], number[a])
        for a, b in links
    }
    drawn = igraph.Graph(n=len(order), edges=sorted(pairs), directed=True)
    layout = drawn.layout_sugiyama(
        layers=[column[v] for v in order], maxiter=_ITERATIONS if len(order) < 1000 else 10
    )
    return {v: float(layout[i][0]) for v, i in number.items()}


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
