"""Write down the acausal equations of a bond graph, with the variables that junctions share as one.

A 0-junction gives all its bonds one effort and a balance of flows, a 1-junction one flow and a
balance of efforts (Karnopp, Margolis, Rosenberg, 1990). So each bond costs two variables at
most, and only balances, laws, states and measurements remain as equations.
"""

from __future__ import annotations

from bondgraph.ir.equation_system import Equation, EquationKind, EquationSystem
from bondgraph.ir.expr import Expr, Kind, variables
from bondgraph.ir.graph import Bond, BondGraph, End, Node
from bondgraph.ir.groups import Groups
from bondgraph.structural.floating import references
from bondgraph.text.source import Span


class _Builder:
    def __init__(self, graph: BondGraph) -> None:
        self.graph = graph
        self.pool = graph.pool
        self.alias: dict[Expr, Expr] = {}  # a port or junction variable to what stands for it
        self.common = Groups[Expr]()  # common variables of like junctions bonded together
        self.idle: set[int] = set()  # bonds that close a ring of like junctions
        self.references = references(graph)  # junctions whose effort is zero, as nothing fixes it
        self.ground: frozenset[Expr] = frozenset()  # and what is common to their bonds
        self.effort: list[Expr] = []
        self.flow: list[Expr] = []
        self.equations: list[Equation] = []

    # ------------------------------------------------------- shared variables

    def merge_junctions(self) -> None:
        nodes = self.graph.nodes
        for bond in self.graph.bonds:
            a, b = nodes[bond.tail.node], nodes[bond.head.node]
            if a.common is not None and b.common is not None and a.kind == b.kind:
                ends = self.common.find(a.common), self.common.find(b.common)
                if not self.common.join(*sorted(ends, key=lambda v: v.id)):
                    self.idle.add(bond.number)

    def bond_variable(self, bond: Bond, junction: str, name: str) -> Expr:
        """The effort (junction "0") or flow (junction "1") of a bond as a signed variable.

        What goes around a ring of like junctions is not determined and matters to nothing: zero.
        """
        nodes = self.graph.nodes
        for end in (bond.tail, bond.head):
            node = nodes[end.node]
            if node.kind == junction and node.common is not None:
                common = self.common.find(node.common)
                return self.pool.zero if common in self.ground else common
        for end in (bond.head, bond.tail):
            if end.port >= 0:
                port = nodes[end.node].ports[end.port]
                if junction == "0":
                    return self.pool.scale(end.effort, port.effort)
                return self.pool.scale(end.flow, port.flow)
        if bond.number in self.idle:
            return self.pool.zero
        kind = Kind.EFFORT if name == "e" else Kind.FLOW
        between = f"{nodes[bond.tail.node].path}->{nodes[bond.head.node].path}.{name}"
        return self.pool.symbol(f"{between}#{bond.number}", kind)

    def share(self) -> None:
        """Decide the two variables of each bond and what every port variable becomes."""
        pool = self.pool
        self.merge_junctions()
        grounded = [self.graph.nodes[n].common for n in self.references]
        self.ground = frozenset([self.common.find(v) for v in grounded if v is not None])
        for node in self.graph.nodes:
            if node.common is not None:
                common = self.common.find(node.common)
                common = pool.zero if common in self.ground else common
                if common is not node.common:
                    self.alias[node.common] = common
        for bond in self.graph.bonds:
            self.effort.append(self.bond_variable(bond, "0", "e"))
            self.flow.append(self.bond_variable(bond, "1", "f"))
            for end in (bond.tail, bond.head):
                if end.port < 0:
                    continue
                port = self.graph.nodes[end.node].ports[end.port]
                for variable, value in (
                    (port.effort, pool.scale(end.effort, self.effort[-1])),
                    (port.flow, pool.scale(end.flow, self.flow[-1])),
                ):
                    if value is not variable:
                        self.alias[variable] = value

    # -------------------------------------------------------------- equations

    def write(
        self,
        kind: EquationKind,
        name: str,
        zero: Expr,
        node: int,
        origin: Span,
        state: Expr | None = None,
        rate: Expr | None = None,
        initial: Expr | None = None,
    ) -> None:
        unknown = tuple(variables(zero))
        if state is not None:
            unknown = (state, *[v for v in unknown if v is not state])
        self.equations.append(
            Equation(kind, name, zero, unknown, node, origin, state, rate, initial)
        )

    def own(self, expr: Expr) -> Expr:
        return self.pool.substitute([expr], self.alias)[0] if self.alias else expr

    def balance(self, number: int, node: Node, ends: list[tuple[Bond, End]]) -> None:
        """Sum of flows (0) or efforts (1): a bond counts positive where its half arrow enters."""
        pool = self.pool
        column = self.flow if node.kind == "0" else self.effort
        terms = []
        for bond, end in ends:
            other = bond.head if end is bond.tail else bond.tail
            if self.graph.nodes[other.node].kind in ("De", "Df"):
                continue  # an ideal detector takes no power
            terms.append((1 if end is bond.head else -1, column[bond.number]))
        zero = pool.add(*terms)
        assert node.common is not None
        if node.when is not None:
            zero = pool.choose(self.own(node.when), zero, self.common.find(node.common))
        self.write("balance", node.path, zero, number, node.origin)

    def element(self, number: int, node: Node) -> None:
        for law in node.laws:
            self.write("law", node.path, self.own(law.zero), number, law.origin)
        for port in node.ports:
            if port.state is not None:
                rate = self.own(port.rate)
                zero = self.pool.sub(self.pool.der(port.state), rate)
                self.write(
                    "state", node.path, zero, number, node.origin, port.state, rate, port.initial
                )

    def build(self) -> EquationSystem:
        graph, pool = self.graph, self.pool
        self.share()
        ends: list[list[tuple[Bond, End]]] = [[] for _ in graph.nodes]
        for bond in graph.bonds:
            ends[bond.tail.node].append((bond, bond.tail))
            ends[bond.head.node].append((bond, bond.head))
        for number, node in enumerate(graph.nodes):
            if number in self.references:
                continue  # its balance follows from the others
            if node.common is not None:
                self.balance(number, node, ends[number])
            else:
                self.element(number, node)
        for item in graph.integrals:
            rate = self.own(item.integrand)
            zero = pool.sub(pool.der(item.symbol), rate)
            name = item.symbol.symbol.name
            self.write("integral", name, zero, -1, item.origin, item.symbol, rate, item.initial)
        for sensor in graph.sensors:
            if sensor.same_as is None:
                zero = pool.sub(sensor.symbol, self.own(sensor.reads))
                at = -1 if sensor.node is None else sensor.node
                self.write("sensor", sensor.name, zero, at, sensor.origin)
        unknowns = variables(*[e.zero for e in self.equations])
        return EquationSystem(
            graph,
            tuple(self.equations),
            tuple(unknowns),
            tuple(self.effort),
            tuple(self.flow),
            self.alias,
        )


def equations(graph: BondGraph) -> EquationSystem:
    """The equations of a bond graph in the variables that remain when junctions share theirs.

    Linear in the size of the graph. A detector takes no power: its bond adds nothing to a balance.
    """
    return _Builder(graph).build()
