"""The causal rules of a bond graph as numbers: which stroke is strong at which node.

Every junction, transformer and gyrator obeys one rule, "exactly one of my bonds is strong": the
strong bond of a 0-junction brings the effort in, that of a 1-junction the flow. A transformer is
a 0-junction with two bonds; a gyrator is the same with the sense of its second bond reversed.
The stroke of bond `b` is the number 0 (at the tail) or 1 (at the head); the ends of the bond are
2b and 2b + 1. Assigning causality is choosing these numbers: a matching of nodes by bonds.
"""

from __future__ import annotations

from bondgraph.ir.causal import Cause, Preference
from bondgraph.ir.graph import BondGraph, Node
from bondgraph.ir.groups import Groups
from bondgraph.ir.nodes import first_degree
from bondgraph.text.tuples import NamedTuple


class Wish(NamedTuple):
    """What an element wants of its bond: the stroke at `value` (0 tail, 1 head), and why."""

    bond: int
    value: int
    node: int
    port: int
    cause: Cause


class Network:
    """The rules alone, without the bond graph: `ends[n]` are the bond ends at rule `n`.

    `rule[end]` is the rule at that end (-1 at an element) and `strong[end]` the stroke that makes
    the bond strong there. `name[n]` is the node of the bond graph that rule `n` came from.
    """

    __slots__ = ("bonds", "ends", "name", "rule", "strong")

    def __init__(self, bonds: int) -> None:
        self.bonds = bonds
        self.rule = [-1] * (2 * bonds)
        self.strong = [-1] * (2 * bonds)
        self.ends: list[list[int]] = []
        self.name: list[int] = []

    def add(self, name: int, ends: list[int], senses: list[bool]) -> None:
        """Add the rule of node `name`; a sense is True where a stroke at the node is strong."""
        rule = len(self.ends)
        self.ends.append(ends)
        self.name.append(name)
        for end, sense in zip(ends, senses, strict=True):
            self.rule[end] = rule
            self.strong[end] = end & 1 if sense else 1 - (end & 1)

    def part(self, rules: list[int], bonds: list[int]) -> tuple[Network, dict[int, int]]:
        """The network of these rules and bonds only, and where each bond went."""
        place: dict[int, int] = {}
        for bond in bonds:
            place.setdefault(bond, len(place))
        for rule in rules:
            for end in self.ends[rule]:
                place.setdefault(end >> 1, len(place))
        small = Network(len(place))
        for rule in rules:
            ends = [2 * place[end >> 1] + (end & 1) for end in self.ends[rule]]
            small.add(
                self.name[rule],
                ends,
                [self.strong[old] == (old & 1) for old in self.ends[rule]],
            )
        return small, place


def network(graph: BondGraph) -> tuple[Network, list[list[int]]]:
    """The rules of the graph, and for every node the bond ends that stand at it."""
    kinds = [node.kind for node in graph.nodes]
    return rules(kinds, [(bond.tail.node, bond.head.node) for bond in graph.bonds])


def rules(kinds: list[str], bonds: list[tuple[int, int]]) -> tuple[Network, list[list[int]]]:
    """The same for nodes of these kinds and bonds from a tail to a head.

    A bond that closes a ring of like junctions obeys no rule: they are one junction already, and
    what flows around the ring is not determined and matters to nothing.
    """
    idle = set(closing(kinds, bonds))
    at: list[list[int]] = [[] for _ in kinds]
    for b, (tail, head) in enumerate(bonds):
        at[tail].append(2 * b)
        at[head].append(2 * b + 1)
    net = Network(len(bonds))
    for n, kind in enumerate(kinds):
        ends = at[n]
        if kind in ("0", "1"):
            ends = [end for end in ends if end >> 1 not in idle]
            net.add(n, ends, [kind == "0"] * len(ends))
        elif kind == "TF" and len(ends) == 2:
            net.add(n, ends, [True, True])
        elif kind == "GY" and len(ends) == 2:
            net.add(n, ends, [True, False])
    return net, at


def closing(kinds: list[str], bonds: list[tuple[int, int]]) -> list[int]:
    """The bonds between junctions of one kind that earlier such bonds have made one junction."""
    like = Groups[int]()
    return [
        b
        for b, (tail, head) in enumerate(bonds)
        if kinds[tail] == kinds[head] and kinds[tail] in ("0", "1") and not like.join(tail, head)
    ]


def must(kind: str, end: int, integral: bool) -> int | None:
    """The stroke that a source or a detector demands of its bond; None for other kinds.

    A detector is an ideal one with `integral` preference, else it is dualised to a source.
    """
    takes = end & 1  # the stroke with which the element receives effort
    match kind:
        case "Se" | "Sf":
            return 1 - takes if kind == "Se" else takes
        case "De" | "Df":
            return takes if (kind == "De") == integral else 1 - takes
        case _:
            return None


def demands(
    graph: BondGraph, at: list[list[int]], preference: Preference
) -> tuple[list[Wish], list[Wish]]:
    """What must be (sources, sensors) and what is wanted, in order of importance.

    In derivative preference a detector is wanted dualised (SSe, SSf) before any storage is
    considered, and is a plain detector only where that is impossible.
    """
    musts: list[Wish] = []
    detectors: list[Wish] = []
    storages: list[Wish] = []
    laws: list[Wish] = []
    integral = preference == "integral"
    for n, node in enumerate(graph.nodes):
        if node.kind in ("0", "1", "TF", "GY"):
            continue
        for end in at[n]:
            bond = graph.bonds[end >> 1]
            port = (bond.head if end & 1 else bond.tail).port
            takes = end & 1  # the stroke with which the element receives effort
            gives = 1 - takes
            value = must(node.kind, end, integral)
            if value is not None:
                source = node.kind in ("Se", "Sf")
                group = musts if source or integral else detectors
                group.append(Wish(end >> 1, value, n, port, "source" if source else "sensor"))
                continue
            match node.kind:
                case "C" | "I" | "IC":
                    value = gives if (node.ports[port].stores == "q") == integral else takes
                    storages.append(Wish(end >> 1, value, n, port, "preferred"))
                case _:
                    gives_effort = one_way(node, port)
                    if gives_effort is not None:
                        value = gives if gives_effort else takes
                        laws.append(Wish(end >> 1, value, n, port, "law"))
    return musts, detectors + storages + laws


def one_way(node: Node, port: int) -> bool | None:
    """Whether the law of this port is better evaluated to give effort (True) or flow (False).

    A law that is linear in the port variables can be turned round at no cost: None. So can an
    implicit one as well as it can be evaluated at all.
    """
    own = node.ports[port]
    variables = [v for p in node.ports for v in (p.effort, p.flow)]
    for law in node.laws:
        if law.direction is own.effort or law.direction is own.flow:
            others = [v for v in variables if v is not law.direction]
            if not first_degree(law.zero, others, choices=True):
                return law.direction is own.effort
    return None
