"""From written bonds to the flat ones: through the ports of models, with ports and signs."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable

from bondgraph.ir.graph import End
from bondgraph.passes.elaboration.problems import Skip, fail, listed
from bondgraph.passes.elaboration.scope import (
    NodeEntry,
    PortEntry,
    PortVariables,
    RawBond,
    RawEnd,
    Scope,
)
from bondgraph.text.diagnostic import Label, Report
from bondgraph.text.source import Span
from bondgraph.text.tuples import NamedTuple


class FlatEnd(NamedTuple):
    """A node and which of its ports (-1 at a junction)."""

    node: NodeEntry
    port: int


class FlatBond(NamedTuple):
    """A bond between two nodes."""

    tail: FlatEnd
    head: FlatEnd
    label: str | None
    origin: Span


class Flattener:
    """Joins the bonds on both sides of each model port.

    Where the half arrows of the two disagree a 0-junction stands for the port: it shares the
    effort and negates the flow. A port of the top model that nothing outside meets becomes, where
    that is allowed, an element without a law (keyword `port`): anything may be connected there.
    """

    def __init__(self, report: Report, open_ports: bool) -> None:
        self.report = report
        self.open_ports = open_ports
        self.bonds: list[FlatBond] = []
        self.added: list[NodeEntry] = []
        self.free: dict[tuple[Span, str, str], list[NodeEntry]] = {}

    # ------------------------------------------------------------------ ports

    def number_ports(self, node: NodeEntry) -> None:
        """Which port of the node each of its bonds meets; reports too many or too few."""
        element = node.element
        if element is None:
            if not node.bonds and not node.scope.unlinked:
                self.unconnected(node, "has no bond", "Connect it with `->`, or remove it.")
            return
        named = node.named_ports
        names = named or element.ports
        node.ports = [PortVariables(n) for n in names]
        if named:
            self.named_ports(node, named)
        elif len(names) == 2:
            self.two_port(node)
        else:
            for end in node.bonds[:1]:
                end.port = 0
            if len(node.bonds) > 1:
                help = "Put a 0- or 1-junction there and let each element have its own bond."
                self.too_many(node, node.bonds[:2], "has one port, but two bonds",
                              _in_row(node) or _between(node) or help)  # fmt: skip
        if node.scope.unlinked:
            return
        met = {e.port for e in node.bonds}
        for at, name in enumerate(names):
            if at not in met:
                if named:
                    self.unconnected(node, f"has no bond at port `{name}`",
                                     f"Draw a bond to `{node.local}.{name}`.")  # fmt: skip
                elif len(names) == 2 and node.bonds:
                    self.unconnected(node, "has two ports, but one bond",
                                     "Connect its other side too.")  # fmt: skip
                    return
                else:
                    self.unconnected(node, "has no bond", "Connect it with `->`, or remove it.")
                    return

    def named_ports(self, node: NodeEntry, names: tuple[str, ...]) -> None:
        """The ports of a field."""
        first: dict[str, RawEnd] = {}
        for end in node.bonds:
            if end.key in first:
                self.too_many(node, [first[end.key], end], f"has two bonds at port `{end.key}`",
                              "Put a junction there.")  # fmt: skip
            first.setdefault(end.key, end)
            end.port = names.index(end.key)

    def two_port(self, node: NodeEntry) -> None:
        """Port 1 is where a bond enters; if both enter or both leave, the one written first."""
        ends = node.bonds
        if len(ends) > 2:
            self.too_many(node, ends[:3], "has two ports, but three bonds",
                          "Put a 0- or 1-junction where bonds meet.")  # fmt: skip
        inward = [e.bond.head is e for e in ends]
        swapped = len(ends) > 1 and inward[1] and not inward[0]
        if len(ends) == 1 and not inward[0]:
            swapped = True
        for at, end in enumerate(ends[:2]):
            end.port = 1 - at if swapped else at

    def too_many(self, node: NodeEntry, ends: list[RawEnd], what: str, help: str) -> None:
        """Report a port that is used twice."""
        node.scope.unlinked = True
        self.report.error(
            "too-many-bonds", f"`{node.type}:{node.local}` {what}.",
            *[Label(e.bond.origin, "a bond here") for e in reversed(ends)],
            Label(node.origin, "declared here"), help=help,
        )  # fmt: skip

    def unconnected(self, node: NodeEntry, what: str, help: str) -> None:
        """Note a port that has no bond, which `tell_unconnected` reports."""
        self.free.setdefault((node.origin, what, help), []).append(node)

    def tell_unconnected(self, scope: Scope) -> None:
        """Report the ports of a scope without a bond, elements of one row in one error."""
        row = Counter(n.name for n in scope.items if isinstance(n, NodeEntry))
        for (origin, what, help), nodes in self.free.items():
            first = nodes[0]
            names = [f"{first.type}:{n.local}" for n in nodes]
            if len(nodes) == row[first.name]:
                names = [f"{first.type}:{first.name}"]
            told = what if len(names) == 1 else f"have{what.removeprefix('has')}"
            self.report.error("unconnected", f"{listed(names)} {told}.", origin, help=help)
        self.free.clear()

    def check_port(self, port: PortEntry) -> None:
        """A port of a model has one bond inside and one outside."""
        scope = port.scope
        for side, ends, owner in (
            ("inside", port.inside, scope),
            ("outside", port.outside, scope.parent),
        ):
            if len(ends) > 1:
                where = f"{side} `{scope.model.name}`"
                self.report.error(
                    "too-many-bonds", f"Port `{port.name}` has two bonds {where}.",
                    *[Label(e.bond.origin, "a bond here") for e in ends[1::-1]],
                    Label(port.origin, "the port"),
                    help="A port carries one bond: let the bonds meet at a 0- or 1-junction.",
                )  # fmt: skip
            elif not ends and (owner is None or not owner.unlinked):
                self.missing_bond(port, side)
                return

    def missing_bond(self, port: PortEntry, side: str) -> None:
        """Report a port without a bond on one side, unless it may stay open."""
        scope = port.scope
        if side == "inside":
            self.report.error(
                "unconnected", f"Port `{port.name}` is not used inside `{scope.model.name}`.",
                port.origin, help=f"Draw a bond to it, `{port.name} -> ...`, or remove it.",
            )  # fmt: skip
        elif scope.parent is None:
            if not self.open_ports:
                self.report.error(
                    "open-port", f"`{scope.model.name}` has an open port, `{port.name}`: it cannot "
                    "be compiled alone.", port.origin, help="Compile a model that connects it, for "
                    "example to a source `Se` or a load `R`.",
                )  # fmt: skip
        else:
            self.report.error(
                "open-port", f"Port `{port.name}` of `{scope.local}` has no bond.",
                Label(scope.origin, f"`{scope.local}`"), Label(port.origin, "the port"),
                help=f"Connect it: `{scope.local}.{port.name}`.",
            )  # fmt: skip

    # ------------------------------------------------------------------ bonds

    def flatten(self, raws: Iterable[RawBond]) -> None:
        """The flat bonds, in the order they are written."""
        for raw in raws:
            if not raw.done:
                try:
                    self.follow(raw)
                except Skip:
                    continue

    def follow(self, raw: RawBond) -> None:
        """The flat bond (or bonds) that a written one belongs to."""
        raw.done = True
        if isinstance(raw.tail.at, NodeEntry) and isinstance(raw.head.at, NodeEntry):
            self.add(raw.tail, raw.head, raw.label, raw.origin)
            return
        before, start = self.walk(raw.tail)
        after, finish = self.walk(raw.head)
        # along the path every bond is seen with its far end second
        path = [(e.other, e) for e in reversed(before)]
        path.append((raw.tail, raw.head))
        path += [(e, e.other) for e in after]
        if start is None or finish is None:
            return
        segment: list[tuple[RawEnd, RawEnd]] = []
        left: RawEnd | NodeEntry = start
        for first, second in path:
            if segment and (segment[-1][0].bond.tail is segment[-1][0]) != (
                first.bond.tail is first
            ):
                port = first.at
                assert isinstance(port, PortEntry)
                middle = self.extra(port, "0", None)
                self.join(left, middle, segment)
                left, segment = middle, []
            segment.append((first, second))
        self.join(left, finish, segment)

    def walk(self, end: RawEnd) -> tuple[list[RawEnd], RawEnd | NodeEntry | None]:
        """From an end through model ports to a node: the ends where each next bond begins."""
        passed: list[RawEnd] = []
        while isinstance(end.at, PortEntry):
            port = end.at
            beyond = port.ends("outside" if end.key == "inside" else "inside")
            if len(beyond) != 1 or len(port.ends(end.key)) != 1:
                if not beyond and port.scope.parent is None and end.key == "inside":
                    return passed, self.open_end(port)
                return passed, None
            nearer = beyond[0]
            if nearer.bond.done:
                fail(self.report, "port-loop", "These bonds go round through ports and never reach "
                     "a junction or an element.", nearer.bond.origin,
                     help="Put a junction into the loop.")  # fmt: skip
            nearer.bond.done = True
            passed.append(nearer)
            end = nearer.other
        return passed, end

    def open_end(self, port: PortEntry) -> NodeEntry | None:
        """What stands for the world outside of an open port."""
        if not self.open_ports:
            return None
        return self.extra(port, "R", PortVariables(""))

    def extra(self, port: PortEntry, type: str, variables: PortVariables | None) -> NodeEntry:
        """A node that stands for a model port."""
        node = NodeEntry(type, None, port.name, None, port.scope, {}, port.origin, "")
        if variables is not None:
            node.ports = [variables]
        self.added.append(node)
        return node

    def join(
        self, left: RawEnd | NodeEntry, right: RawEnd | NodeEntry,
        segment: list[tuple[RawEnd, RawEnd]],
    ) -> None:  # fmt: skip
        """One flat bond for written bonds that all point the same way."""
        forward = segment[0][0].bond.tail is segment[0][0]
        labels = [f.bond.label for f, _ in segment if f.bond.label is not None]
        label = labels[0] if labels else None
        tail, head = (left, right) if forward else (right, left)
        bond = self.add(tail, head, label, segment[0][0].bond.origin)
        for first, second in segment:
            for end in (first, second):
                if isinstance(end.at, PortEntry) and end.key == "inside":
                    end.at.bond = bond

    def add(
        self, tail: RawEnd | NodeEntry, head: RawEnd | NodeEntry, label: str | None, origin: Span
    ) -> int:
        """Enter a flat bond; its number."""
        self.bonds.append(FlatBond(_flat(tail), _flat(head), label, origin))
        return len(self.bonds) - 1


def _flat(end: RawEnd | NodeEntry) -> FlatEnd:
    if isinstance(end, NodeEntry):
        return FlatEnd(end, 0 if end.ports else -1)
    assert isinstance(end.at, NodeEntry)
    return FlatEnd(end.at, end.port)


def sign(own: FlatEnd, other: FlatEnd, into: bool) -> End:
    """How the port's variables follow from those of the bond (`into`: its arrow enters)."""
    node, number = own.node, own.node.number
    element = node.element
    if own.port < 0 or element is None or element.kind in ("Se", "Sf", "De", "Df"):
        return End(number, own.port, 1, 1)
    if element.passive:
        if into:
            return End(number, own.port, 1, 1)
        if other.node.element is None and other.node.type == "1":
            return End(number, own.port, -1, 1)
        return End(number, own.port, 1, -1)
    positive = into if own.port == 0 else not into
    return End(number, own.port, 1, 1 if positive else -1)


def check_scope(scope: Scope, flattener: Flattener) -> None:
    """The ports of an instance and of its nodes."""
    for port in scope.ports.values():
        flattener.check_port(port)
    for item in scope.items:
        if isinstance(item, NodeEntry):
            flattener.number_ports(item)
    flattener.tell_unconnected(scope)


def _in_row(node: NodeEntry) -> str:
    """How a row of one-ports is drawn whose bond would pass through one to the next."""
    one, other = (end.bond.origin for end in node.bonds[:2])
    if node.place is None or one != other:
        return ""
    return (
        f"A bond passes through a row, from one to the next. Declare it by itself, `{node.type}:"
        f"{node.name}[...]`, and draw a bond to each, `... -> {node.local}`."
    )


def _between(node: NodeEntry) -> str:
    """Where a passive one-port belongs that was drawn between two others, as in a circuit."""
    tails = [e.other for e in node.bonds if e.bond.head is e]
    heads = [e.other for e in node.bonds if e.bond.tail is e]
    if len(tails) != 1 or len(heads) != 1 or node.element is None or not node.element.passive:
        return ""
    one, other = (end.origin.text.split(" ")[0] for end in (tails[0], heads[0]))
    return (
        f"What lies between two others has the flow of a 1-junction: `{one} -> 1:through -> "
        f"{other}`, and `through -> {node.type}:{node.name}` with its value."
    )
