"""Follow chains to their nodes and draw the bonds as written, between nodes and model ports."""

from __future__ import annotations

from typing import TypeAlias

from bondgraph.ir.syntax import Part, Ref
from bondgraph.passes.elaboration.build_time import whole_number
from bondgraph.passes.elaboration.lookup import Lookup
from bondgraph.passes.elaboration.problems import Skip, fail, listed, meant
from bondgraph.passes.elaboration.scope import (
    Array,
    Link,
    Named,
    NodeEntry,
    PortEntry,
    RawBond,
    RawEnd,
    Scope,
    ValueEntry,
)
from bondgraph.text.diagnostic import Label, Report
from bondgraph.text.source import Span

#: One stop of a chain: a node with the named port ("" for none), a port from inside or outside,
#: or a submodel whose port is still to be chosen.
Stop: TypeAlias = "tuple[NodeEntry | PortEntry | Scope, str, Span]"


class Wiring:
    """The written bonds of all instances."""

    def __init__(self, report: Report, lookup: Lookup) -> None:
        self.report = report
        self.lookup = lookup
        self.bonds: list[RawBond] = []

    def connect(self, scope: Scope) -> None:
        """All chains of one instance."""
        for link in scope.links:
            try:
                self.chain(link, scope)
            except Skip:
                scope.unlinked = True

    def chain(self, link: Link, scope: Scope) -> None:
        """One chain: a bond for every arrow, and inside a range of submodels."""
        if not link.arrows:
            return
        groups = [self.stops(link, at, scope) for at in range(len(link.items))]
        previous: Stop | None = None
        for at, group in enumerate(groups):
            for position, stop in enumerate(group):
                inner = position > 0
                arrow = link.arrows[max(at - 1, 0)]
                if previous is not None:
                    label = None if inner else arrow.label
                    if arrow.forward:
                        self.bond(previous, stop, label, arrow.origin)
                    else:
                        self.bond(stop, previous, label, arrow.origin)
                previous = stop

    def bond(self, tail: Stop, head: Stop, label: str | None, origin: Span) -> None:
        """One bond; a submodel is entered by its only `in` port and left by its only `out`."""
        raw = RawBond(label, origin)
        raw.tail = self.end(raw, tail, "out")
        raw.head = self.end(raw, head, "in")
        node = raw.tail.at
        if node is raw.head.at and raw.tail.key == raw.head.key and isinstance(node, NodeEntry):
            fail(self.report, "self-bond", f"This bond joins `{node.local}` to itself.",
                 Label(origin), Label(node.origin, "declared here"),
                 help="Draw it to another node, or remove it.")  # fmt: skip
        for end in (raw.tail, raw.head):
            if isinstance(end.at, NodeEntry):
                end.at.bonds.append(end)
            else:
                end.at.ends(end.key).append(end)
        self.bonds.append(raw)

    def end(self, bond: RawBond, stop: Stop, direction: str) -> RawEnd:
        """Where exactly the bond ends."""
        at, key, origin = stop
        if isinstance(at, Scope):
            at, key = self.only_port(at, direction, origin), "outside"
        return RawEnd(bond, at, key, origin)

    def only_port(self, scope: Scope, direction: str, origin: Span) -> PortEntry:
        """The port of a submodel that is meant when none is named."""
        ports = list(scope.ports.values())
        fitting = [p for p in ports if p.declaration.direction == direction]
        if len(fitting) == 1:
            return fitting[0]
        if scope.incomplete or scope.wrong:
            raise Skip
        if not ports:
            fail(self.report, "missing-port", f"`{scope.model.name}` has no port.", origin,
                 Label(scope.model.name_origin, "declared here"),
                 help="Declare one in it: `port name : in electrical`.")  # fmt: skip
        names = listed(f"{scope.local}.{p.name}" for p in fitting or ports)
        if not fitting:
            fail(self.report, "missing-port", f"`{scope.local}` has no `{direction}` port for this "
                 "arrow.", Label(origin), *[Label(p.origin) for p in ports[:3]],
                 help=f"Name the port that is meant, {names}, or turn the arrow."
                 )  # fmt: skip
        places = [Label(p.origin) for p in fitting[:3]]
        fail(self.report, "ambiguous-port", f"Which port of `{scope.local}` is meant? It has "
             f"several `{direction}` ports.", Label(origin), *places,
             help=f"Name the port: {names}.")  # fmt: skip

    # ------------------------------------------------------------------ stops

    def stops(self, link: Link, at: int, scope: Scope) -> list[Stop]:
        """What one item of a chain stands for: one node, or several in series."""
        item, origin = link.items[at], link.origins[at]
        if item is None:
            return [self.junction(link, scope)]
        if isinstance(item, Ref):
            last = item.parts[-1]
            if last.first is not None and last.last is not None:
                return self.series(item, last, scope, link)
            return [self.single(item, scope, link)]
        return [self.whole(node, origin, node.local) for node in item]

    def junction(self, link: Link, scope: Scope) -> Stop:
        """The junction in whose body the chain stands."""
        at = link.junction
        assert at is not None
        if isinstance(at, NodeEntry):
            return at, "", at.origin
        stop = self.single(at, scope, link)
        if not isinstance(stop[0], NodeEntry) or stop[0].element is not None:
            fail(self.report, "not-a-junction", f"`{at.origin.text}` is no junction.", at.origin,
                 help="Only the bonds of a junction can be written in braces after its name."
                 )  # fmt: skip
        return stop

    def single(self, ref: Ref, scope: Scope, link: Link) -> Stop:
        """The node or port that a reference names."""
        entry, rest = self.lookup.node(ref, scope, link.env)
        if isinstance(entry, PortEntry):
            if rest:
                self.no_port(ref, rest[0], entry.name, ())
            return entry, "inside" if entry.scope is scope else "outside", ref.origin
        if isinstance(entry, Scope):
            if rest:
                self.no_port(ref, rest[0], entry.local, tuple(entry.ports), entry)
            return entry, "", ref.origin
        assert isinstance(entry, NodeEntry)
        names = entry.named_ports
        if rest and (len(rest) > 1 or rest[0].name not in names):
            self.no_port(ref, rest[0], entry.name, names)
        if entry.scope is not scope:
            self.hidden(ref, entry)
        if rest:
            return entry, rest[0].name, ref.origin
        return self.whole(entry, ref.origin, ref.origin.text)

    def whole(self, entry: NodeEntry | Scope, origin: Span, text: str) -> Stop:
        """A node without the name of a port; a field must have one only."""
        if isinstance(entry, Scope):
            return entry, "", origin
        names = entry.named_ports
        if len(names) > 1:
            fail(self.report, "ambiguous-port", f"Which port of `{entry.name}` is meant?",
                 Label(origin), Label(entry.origin, f"has {listed(names)}"),
                 help=f"Name the port, `{text}.{names[0]}`; declare the element on a line of its "
                 "own.")  # fmt: skip
        return entry, names[0] if names else "", origin

    def hidden(self, ref: Ref, entry: NodeEntry) -> None:
        """The nodes of a submodel belong to it; only its ports are there for others."""
        fail(self.report, "hidden-node", f"`{ref.origin.text}` is inside a submodel.",
             Label(ref.origin), Label(entry.origin, "declared here"),
             help="Give the submodel a `port` for this bond.")  # fmt: skip

    def no_port(
        self, ref: Ref, part: Part, owner: str, ports: tuple[str, ...], scope: Scope | None = None
    ) -> None:
        """Report a port that does not exist."""
        if scope is not None and (scope.incomplete or part.name in scope.wrong):
            raise Skip
        otherwise = f"`{owner}` has the ports {listed(ports)}." if ports else (
            f"`{owner}` has no named ports: write `{owner}` alone."
        )  # fmt: skip
        value = None if scope is None else scope.values.get(part.name)
        if scope and isinstance(value, ValueEntry) and value.kind in ("input", "param"):
            fail(self.report, "unknown-port", f"`{part.name}` of `{owner}` is no port.",
                 Label(part.origin), Label(value.origin, "a value"),
                 help=f"No bond gives it: `{part.name} = ...` in the round brackets behind the name"
                 f" of the instance does, as in `{scope.model.name}:{scope.name}({part.name} ="
                 " ...)`.")  # fmt: skip
        fail(self.report, "unknown-port", f"`{owner}` has no port `{part.name}`.", part.origin,
             help=meant(part.name, ports, otherwise, part.origin))  # fmt: skip

    def series(self, ref: Ref, last: Part, scope: Scope, link: Link) -> list[Stop]:
        """`cell[1..n]`: the elements of an array one after the other; an empty range is none."""
        assert last.first is not None and last.last is not None
        inside: Named = scope
        if len(ref.parts) > 1:
            inside, rest = self.lookup.node(Ref(ref.parts[:-1], ref.origin), scope, link.env)
            if not isinstance(inside, Scope) or rest:
                self.no_port(ref, last, ref.parts[0].name, ())
        assert isinstance(inside, Scope)
        array = inside.nodes.get(last.name)
        if array is None:
            self.lookup.no_node(last, inside)
        if not isinstance(array, Array):
            fail(self.report, "index-not-allowed", f"`{last.name}` is not an array.",
                 Label(last.origin), Label(array.origin, "declared here"),
                 help=f"Write `{last.name}` without an index.")  # fmt: skip
        low = whole_number(last.first, scope, link.env, self.report)
        high = whole_number(last.last, scope, link.env, self.report)
        stops: list[Stop] = []
        if high >= low:
            for place in (low, high):
                if place not in array.entries:
                    self.lookup.out_of_range(last, array, place)
        for place in range(low, high + 1):
            entry = array.entries.get(place)
            if entry is None:
                self.lookup.out_of_range(last, array, place)
            if isinstance(entry, NodeEntry) and inside is not scope:
                self.hidden(ref, entry)
            assert isinstance(entry, (NodeEntry, Scope))
            stops.append(self.whole(entry, ref.origin, entry.local))
        return stops
