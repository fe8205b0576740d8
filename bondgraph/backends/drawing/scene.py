"""What there is to draw: which nodes carry the figure, which hang on them, names and submodels."""

from __future__ import annotations

from bondgraph.backends.drawing.coefficients import coefficients
from bondgraph.backends.drawing.style import BIG, FONT, HEIGHT, KINDS, SMALL, width
from bondgraph.ir.causal import CausalGraph
from bondgraph.ir.graph import BondGraph, Node
from bondgraph.notation.line import show
from bondgraph.text.tuples import NamedTuple

Path = tuple[str, ...]
_LIGHT = 3  # one-ports at a junction that stands above or below another one


class Look(NamedTuple):
    """What a drawing shows besides the graph.

    `values` are the numbers of the laws, `numbers` those of the bonds, as `explain` cites them.
    With `boxes` a submodel is one box. Without `title` or `legend` the figure stands alone.
    """

    values: bool = False
    numbers: bool = False
    boxes: bool = False
    title: bool = True
    legend: bool = True


#: As a drawing is without any wish.
PLAIN = Look()


class Item(NamedTuple):
    """A node as drawn: `kind` in bold, then `name`; `tag` is the small name of a junction.

    `note` is a small line below the name.

    Without a kind it is a box: a submodel of which no inside is shown.
    """

    kind: str
    name: str
    tag: str
    colour: str
    w: float
    h: float
    path: Path
    derived: bool
    note: str = ""


class Leaf(NamedTuple):
    """A one-port and the bond on which it hangs at `host`."""

    node: int
    host: int
    bond: int


class Scene(NamedTuple):
    """Items by node, the skeleton in order, the leaves, and the submodels that get a frame.

    `framed` are the same submodels as a set. `bond_names` are the labels of the bonds, "" for none.
    """

    graph: BondGraph
    items: tuple[Item, ...]
    skeleton: tuple[int, ...]
    links: tuple[tuple[int, int, int], ...]  # bonds of the skeleton: tail, head, bond
    leaves: dict[int, tuple[Leaf, ...]]
    frames: tuple[Path, ...]
    framed: frozenset[Path]
    bond_names: tuple[str, ...]

    def frames_of(self, node: int) -> tuple[Path, ...]:
        """The frames around a node, the outermost first."""
        path = self.items[node].path
        return tuple(path[:k] for k in range(1, len(path)) if path[:k] in self.framed)

    def hangs(self, node: int, host: int) -> bool:
        """Whether a node of the skeleton may stand above or below another one.

        It needs room for what hangs on itself, and the same frames around it.
        """
        return self.walls(node, host) == 0 and len(self.leaves.get(node, ())) <= _LIGHT

    def walls(self, a: int, b: int) -> int:
        """How many frames a bond from a to b crosses."""
        one, two = self.frames_of(a), self.frames_of(b)
        shared = sum(x == y for x, y in zip(one, two, strict=False))
        return len(one) + len(two) - 2 * shared


def scene(causal: CausalGraph, unframed: frozenset[Path], look: Look = PLAIN) -> Scene:
    """Sort the nodes of a graph into skeleton and leaves; `unframed` submodels get no frame."""
    graph = causal.graph
    paths = [tuple(node.path.split(".")) for node in graph.nodes]
    frames = () if look.boxes else _frames(paths, unframed)
    framed = frozenset(frames)
    derived = {s.node for s in causal.storages if not s.integral}
    dualised = set(causal.dualised)
    valued = coefficients(graph) if look.values else {}
    box = _boxes(paths) if look.boxes else {}
    items = []
    for n, node in enumerate(graph.nodes):
        path = paths[n]
        depth = max([k for k in range(1, len(path)) if path[:k] in framed], default=0)
        item = _item(node, ".".join(path[depth:]), path, n in derived, n in dualised)
        if n in valued:
            wide = max(item.w, width(valued[n], SMALL) + 10)
            item = item._replace(note=valued[n], w=wide, h=item.h + SMALL + 2)
        items.append(item)
        if box.get(n) == n:
            items[n] = Item("", path[0], "", "ink", width(path[0]) + 22, 34.0, path[:1], False)
    host = {n: box.get(h, h) for n, h in _hosts(graph).items() if n not in box}
    leaves: dict[int, list[Leaf]] = {}
    links = []
    for b, bond in enumerate(graph.bonds):
        tail, head = (box.get(n, n) for n in (bond.tail.node, bond.head.node))
        leaf = tail if tail in host else head
        if leaf in host:
            leaves.setdefault(host[leaf], []).append(Leaf(leaf, host[leaf], b))
        elif tail != head or tail not in box:
            links.append((tail, head, b))
    skeleton = tuple(n for n in range(len(graph.nodes)) if n not in host and box.get(n, n) == n)
    hanging = {n: tuple(group) for n, group in leaves.items()}
    names = tuple(b.label or (str(b.number) if look.numbers else "") for b in graph.bonds)
    return Scene(graph, tuple(items), skeleton, tuple(links), hanging, frames, framed, names)


def _boxes(paths: list[Path]) -> dict[int, int]:
    """For each node inside of a submodel the first node of the same one, which stands for it."""
    first: dict[str, int] = {}
    return {n: first.setdefault(path[0], n) for n, path in enumerate(paths) if len(path) > 1}


def _frames(paths: list[Path], unframed: frozenset[Path]) -> tuple[Path, ...]:
    """Submodel instances of at least two nodes; of equal ones inside each other the innermost."""
    size: dict[Path, int] = {}
    for path in paths:
        for k in range(1, len(path)):
            size[path[:k]] = size.get(path[:k], 0) + 1
    whole = {p[:-1] for p, count in size.items() if len(p) > 1 and size[p[:-1]] == count}
    return tuple(p for p, n in size.items() if n > 1 and p not in whole and p not in unframed)


def _item(node: Node, name: str, path: Path, derived: bool, dualised: bool) -> Item:
    kind, colour = node.keyword or node.kind, KINDS[node.kind]
    if node.kind in ("0", "1"):
        tag = name if node.when is None else f"{name} when {show(node.when)}"
        return Item(kind, "", tag, colour, width(kind, BIG, True) + 8, 24.0, path, False)
    if dualised:
        kind, colour = f"SS{node.kind[1]}", "source"
    w = width(kind, FONT, True) + width(f":{name}") + 2
    room = 5.0 if derived else 0.0  # for the outline
    return Item(kind, name, "", colour, w + room, HEIGHT + room, path, derived)


def _hosts(graph: BondGraph) -> dict[int, int]:
    """The node on which each one-port hangs; of two joined one-ports the first carries."""
    bonds_at: dict[int, list[int]] = {}
    for bond in graph.bonds:
        bonds_at.setdefault(bond.tail.node, []).append(bond.head.node)
        bonds_at.setdefault(bond.head.node, []).append(bond.tail.node)
    host: dict[int, int] = {}
    for n, node in enumerate(graph.nodes):
        others = bonds_at.get(n, [])
        if node.kind not in ("0", "1", "TF", "GY") and len(others) == 1 and others[0] != n:
            alone = graph.nodes[others[0]].kind not in ("0", "1", "TF", "GY")
            if not (alone and len(bonds_at[others[0]]) == 1 and n < others[0]):
                host[n] = others[0]
    return host
