"""What would mend a conflict: changes of the model, each tried before it is proposed."""

from __future__ import annotations

from collections.abc import Iterator

from bondgraph.frontend.statement_end import statement_end
from bondgraph.ir.graph import BondGraph, End, Node
from bondgraph.ir.groups import Groups
from bondgraph.library.elements import PASSIVE
from bondgraph.passes.causality.cores import refute
from bondgraph.passes.causality.explanation import Explanation
from bondgraph.passes.causality.node_words import name
from bondgraph.passes.causality.rules import Wish, must, rules
from bondgraph.text.diagnostic import Edit
from bondgraph.text.source import Span
from bondgraph.text.tuples import NamedTuple

_PROPOSED = 5
_OF_A_KIND = 2
_TRIED = 60
_WORK = 300_000  # bonds looked at in trials of the whole model
_JUNCTIONS = ("0", "1")
_STRUCTURE = ("0", "1", "TF", "GY")
_OTHER = {"0": "1", "1": "0", "Se": "Sf", "Sf": "Se"}
_ELEMENTS = {"0": "a C or an R", "1": "an I or an R"}


class Change(NamedTuple):
    """A change of the drawing; nodes and bonds are numbers of the graph.

    `drop` leaves a node out with its bonds, `cut` a bond; `turn` makes a node one of another
    kind; `splice` puts a junction of a kind with an R into a bond; `grow` puts an R at a junction.
    """

    drop: int = -1
    cut: int = -1
    turn: int = -1
    splice: tuple[int, str] | None = None
    grow: int = -1


class Mend(NamedTuple):
    """A change that was tried and mends a conflict, how to say it, and how to write it if plain."""

    change: Change
    text: str
    edit: Edit | None = None


def mends(
    graph: BondGraph, core: list[int], told: Explanation, others: set[int], alike: list[int]
) -> list[Mend]:
    """Up to five changes with each of which the conflict is gone.

    `core` are the nodes that contradict each other. The nodes of `others`, which are in conflicts
    of their own, are left out of the trial. A change is made at all places that are `alike`,
    which come from the same line of the text.
    """
    workshop = _Workshop(graph, others, alike)
    found: list[Mend] = []
    kinds: dict[str, int] = {}
    budget = _WORK
    seen: set[Change] = set()
    for change, kind in _candidates(graph, core, told):
        if len(seen) >= _TRIED or len(found) >= _PROPOSED or budget < 0:
            break
        if change in seen or kinds.get(kind, 0) >= _OF_A_KIND:
            continue
        seen.add(change)
        if workshop.suits(change, core):
            budget -= len(graph.bonds)
            if workshop.suits(change, None):
                kinds[kind] = kinds.get(kind, 0) + 1
                words = _words(graph, change, workshop.places(change))
                found.append(Mend(change, words, _edit(graph, change, words)))
    return found


def _candidates(
    graph: BondGraph, core: list[int], told: Explanation
) -> Iterator[tuple[Change, str]]:
    """Changes worth a trial, the likeliest first."""
    nodes = graph.nodes
    at: dict[int, list[int]] = {n: [] for n in core}
    for b, bond in enumerate(graph.bonds):
        for n in (bond.tail.node, bond.head.node):
            if n in at:
                at[n].append(b)
    # the place where it shows comes first, then what is nearest to the elements
    order = [told.meet, *[n for n in reversed(core) if n != told.meet]]
    sources = [n for n in order if nodes[n].kind in ("Se", "Sf")]
    elements = [n for n in order if nodes[n].kind not in _STRUCTURE]
    junctions = [n for n in order if nodes[n].kind in _JUNCTIONS]
    inner = sorted({b for n in core for b in at[n] if _inside(graph, b, set(core))})
    growing = [(Change(grow=n), "grow") for n in junctions]
    lossy = [
        (Change(splice=(b, "1" if nodes[n].kind == "Se" else "0")), "splice")
        for n in sources
        for b in at[n]
    ]
    if told.ring:
        yield from [(Change(cut=b), "cut") for b in inner if _closes(graph, b)]
        if told.over:
            close = [b for b in at[told.meet] if b in inner]
            yield from [(Change(splice=(b, k)), "splice") for b in close for k in "10"]
    yield from lossy if told.over else growing
    yield from [(Change(turn=n), "junction") for n in junctions[:1] if n == told.meet]
    yield from lossy
    yield from [(Change(splice=(b, k)), "splice") for b in inner for k in "10"]
    yield from [(Change(drop=n), "drop") for n in elements]
    yield from [(Change(turn=n), "source") for n in sources]
    yield from growing


def _inside(graph: BondGraph, bond: int, core: set[int]) -> bool:
    """Whether a bond joins two junctions or two-ports of the core."""
    ends = graph.bonds[bond]
    pair = (ends.tail.node, ends.head.node)
    return all(n in core and graph.nodes[n].kind in _STRUCTURE for n in pair)


def _closes(graph: BondGraph, bond: int) -> bool:
    """Whether a bond of two like junctions closes a ring, so that nothing falls apart without."""
    ends = graph.bonds[bond]
    start, goal = ends.tail.node, ends.head.node
    kind = graph.nodes[start].kind
    if kind not in _JUNCTIONS or graph.nodes[goal].kind != kind:
        return False
    groups = Groups[int]()
    for b, other in enumerate(graph.bonds):
        if b != bond:
            groups.join(other.tail.node, other.head.node)
    return groups.find(start) == groups.find(goal)


class _Workshop:
    """Makes a change at all its places and asks whether strokes can be placed then."""

    def __init__(self, graph: BondGraph, others: set[int], alike: list[int]) -> None:
        self.graph = graph
        self.others = others
        self.alike = alike
        self.kinds = [node.kind for node in graph.nodes]
        self.bonds = [(bond.tail.node, bond.head.node) for bond in graph.bonds]

    def nodes(self, node: int) -> list[int]:
        return [n for n, kind in enumerate(self.alike) if kind == self.alike[node]]

    def lines(self, bond: int) -> list[int]:
        def key(b: int) -> tuple[int, int, int]:
            tail, head = self.bonds[b]
            return self.alike[tail], self.alike[head], self.graph.bonds[b].origin.start

        return [b for b in range(len(self.bonds)) if key(b) == key(bond)]

    def places(self, change: Change) -> int:
        """At how many places of the drawing a change of the text shows."""
        node = max(change.drop, change.turn, change.grow)
        bond = change.cut if change.splice is None else change.splice[0]
        return len(self.nodes(node) if node >= 0 else self.lines(bond))

    def suits(self, change: Change, only: list[int] | None) -> bool:
        """Whether strokes exist after the change, around the nodes of `only` or everywhere."""
        kinds, bonds = list(self.kinds), list(self.bonds)
        gone: set[int] = set()
        fresh: list[int] = []
        left: set[int] = set()  # the nodes that lose a bond
        if change.drop >= 0:
            dropped = set(self.nodes(change.drop))
            gone = {b for b, ends in enumerate(bonds) if not dropped.isdisjoint(ends)}
            left = {n for b in gone for n in bonds[b]} - dropped
        if change.cut >= 0:
            gone = set(self.lines(change.cut))
            left = {n for b in gone for n in bonds[b]}
        if change.turn >= 0:
            for n in self.nodes(change.turn):
                kinds[n] = _OTHER[kinds[n]]
        if change.splice is not None:
            bond, kind = change.splice
            gone = set(self.lines(bond))
            for b in sorted(gone):
                fresh.append(len(kinds))
                bonds += [(bonds[b][0], len(kinds)), (len(kinds), bonds[b][1])]
                bonds.append((len(kinds), len(kinds) + 1))
                kinds += [kind, "R"]
        if change.grow >= 0:
            for n in self.nodes(change.grow):
                bonds.append((n, len(kinds)))
                kinds.append("R")
        bonds = [ends for b, ends in enumerate(bonds) if b not in gone]
        if only is not None:
            near = {*only, *fresh}
            bonds = [ends for ends in bonds if not near.isdisjoint(ends)]
            kinds = [kind if n in near else "" for n, kind in enumerate(kinds)]
        for n in self.others:
            kinds[n] = ""
        return _sound(kinds, bonds, left)


def _sound(kinds: list[str], bonds: list[tuple[int, int]], left: set[int]) -> bool:
    """Whether strokes exist, and the nodes in `left` still have the bonds that they need."""
    net, at = rules(kinds, bonds)
    if any(len(at[n]) < (2 if kinds[n] in _STRUCTURE else 1) for n in left):
        return False
    wishes: list[Wish] = []
    for n, kind in enumerate(kinds):
        for end in at[n]:
            value = must(kind, end, True)
            if value is not None:
                wishes.append(Wish(end >> 1, value, n, 0, "source"))
    return refute(net, wishes) is None


# ------------------------------------------------------------------------ words


def _words(graph: BondGraph, change: Change, places: int) -> str:
    also = f" (and the {places - 1} like it)" if places > 1 else ""
    nodes = graph.nodes
    if change.splice is not None:
        bond, kind = change.splice
        a, b = graph.bonds[bond].tail, graph.bonds[bond].head
        what = "an R or an I" if kind == "1" else "an R or a C"
        where = f"between {name(nodes[a.node])} and {name(nodes[b.node])}{also}"
        return f"put a {kind}-junction with {what} {where}{_spliced(graph, a, b, kind)}"
    if change.grow >= 0:
        node = nodes[change.grow]
        return f"put {_ELEMENTS[node.kind]} at {name(node)}{also}"
    if change.cut >= 0:
        a, b = graph.bonds[change.cut].tail, graph.bonds[change.cut].head
        pair = {a.node, b.node}
        same = sum({bond.tail.node, bond.head.node} == pair for bond in graph.bonds)
        which = "the bond" if same == 1 else f"one of the {same} bonds"
        return f"leave out {which} between {name(nodes[a.node])} and {name(nodes[b.node])}{also}"
    if change.drop >= 0:
        return f"leave out {name(nodes[change.drop])}{also}"
    node = nodes[change.turn]
    other = _OTHER[node.kind]
    if node.kind in _JUNCTIONS:
        share = "flow and not the effort" if other == "1" else "effort and not the flow"
        return f"make {name(node)}{also} a {other}-junction, if its bonds share the {share}"
    given = "flow" if other == "Sf" else "effort"
    return f"make {name(node)}{also} an {other}, if it holds a {given}".replace(
        "a effort", "an effort"
    )


def _edit(graph: BondGraph, change: Change, words: str) -> Edit | None:
    """The change as one of the text, where that is plain: a node turned, an R put in or at."""
    changes: list[tuple[Span, str] | None] = []
    if change.splice is not None:
        number, kind = change.splice
        bond = graph.bonds[number]
        names = _link(graph, bond.tail, bond.head)
        if names is None:
            return None
        *_, link, loss = names
        text = bond.origin.text
        plain = "->" if text.endswith(">") else "<-"
        changes.append((bond.origin, f"{text} {kind}:{link} {plain}"))
        changes.append(_behind(bond.origin, f"; {link} -> R:{loss} = 1"))
    elif change.grow >= 0:
        node = graph.nodes[change.grow]
        model, _, own = node.path.rpartition(".")
        if "[" in own:
            return None
        loss = _free("loss", model, {n.path for n in graph.nodes})
        changes.append(_behind(node.origin, f"; {own} -> R:{loss} = 1"))
    elif change.turn >= 0:
        node = graph.nodes[change.turn]
        place = _type(node)
        if place is None:
            return None
        prefix = node.keyword.removesuffix(node.kind)
        changes.append((place, prefix + _OTHER[node.kind]))
    known = tuple([c for c in changes if c is not None])
    whole = known and len(known) == len(changes)
    return Edit(words.split("\n", 1)[0], known) if whole else None


def _behind(place: Span, text: str) -> tuple[Span, str] | None:
    """A text behind the statement in which a place is."""
    end = statement_end(place.source.text, place.start)
    return None if end is None else (Span(place.source, end, end), text)


def _type(node: Node) -> Span | None:
    """Where the type of a node is written."""
    source, start, _ = node.origin
    size = len(node.keyword)
    for begin in (start, start - size - 1):  # a node, or the name of a junction with braces
        if begin >= 0 and source.text[begin : begin + size + 1] == f"{node.keyword}:":
            return Span(source, begin, begin + size)
    return None


def _spliced(graph: BondGraph, tail: End, head: End, kind: str) -> str:
    """How to write it, where both ends are of one model and have plain names."""
    names = _link(graph, tail, head)
    if names is None:
        return ""
    a, b, link, loss = names
    return f"\n    {a} -> {kind}:{link} -> {b}; {link} -> R:{loss} = 1"


def _link(graph: BondGraph, tail: End, head: End) -> tuple[str, str, str, str] | None:
    """Both ends as their model calls them, and two names that it does not have yet."""
    ends = []
    for end in (tail, head):
        node = graph.nodes[end.node]
        model, _, own = node.path.rpartition(".")
        fields = node.kind in PASSIVE and len(node.ports) > 1
        ends.append((model, f"{own}.{node.ports[end.port].name}" if fields else own))
    (model, a), (other, b) = ends
    if model != other or "[" in a + b:
        return None
    taken = {node.path for node in graph.nodes}
    link, loss = (_free(word, model, taken) for word in ("link", "loss"))
    return a, b, link, loss


def _free(word: str, model: str, taken: set[str]) -> str:
    number = 1
    while True:
        found = word if number == 1 else f"{word}{number}"
        if (f"{model}.{found}" if model else found) not in taken:
            return found
        number += 1
