"""The equations of a bond graph as this oracle reads them, straight from its bonds.

Each bond has its own effort and flow. A junction makes one of them common to all its bonds and
balances the other (Karnopp, Margolis, Rosenberg, 1990); a port sees them with the signs of its
bond end. Nothing here is shared with the elimination that this oracle checks.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import NamedTuple

from bondgraph.ir.expr import Expr, Kind, Op, Pool, topological
from bondgraph.ir.graph import BondGraph, Node
from bondgraph.ir.groups import Groups


class Balance(NamedTuple):
    """The sum of sign * variable over `terms` is zero; of a switched junction only while `when`
    holds, otherwise its `common` variable is zero."""

    node: int
    terms: tuple[tuple[int, int], ...]
    when: Expr | None
    common: int


class Rate(NamedTuple):
    """variable' = `value`."""

    node: int
    variable: int
    value: Expr


class Assembly(NamedTuple):
    """All equations of a plant in numbered variables.

    `active` are the variables that the equations are about, all of them or those of a part.
    `place[symbol]` is (variable, sign) for every symbol that is not constant. `free` are the
    variables that the plant leaves open: known inputs first, then unknown ones. `silent` are
    variables that are zero because an ideal detector takes no power. `readings` are sensors
    whose reading a law or another sensor uses: a variable with the expression that it reads.
    `pool` has made all expressions.
    """

    count_of: int
    active: tuple[int, ...]
    place: dict[Expr, tuple[int, int]]
    free: tuple[int, ...]
    unknown: tuple[int, ...]
    silent: tuple[int, ...]
    balances: tuple[Balance, ...]
    laws: tuple[tuple[int, Expr], ...]
    rates: tuple[Rate, ...]
    readings: tuple[tuple[str, int, Expr], ...]
    pool: Pool


class _Builder:
    def __init__(self, graph: BondGraph) -> None:
        self.graph = graph
        self.ends: list[list[tuple[int, int]]] = [[] for _ in graph.nodes]  # bond, +1 head -1 tail
        for number, bond in enumerate(graph.bonds):
            self.ends[bond.tail.node].append((number, -1))
            self.ends[bond.head.node].append((number, 1))
        self.numbers = Groups[int]()  # what junctions make common: effort 2b, flow 2b + 1
        self.place: dict[Expr, tuple[int, int]] = {}
        self.size = 0
        self.inner: dict[Expr, Expr] = {}  # what is differentiated, to the symbol made for it
        self.extra: list[tuple[int, Expr]] = []

    def share(self) -> list[int]:
        """The final number of each bond variable."""
        for node, ends in zip(self.graph.nodes, self.ends, strict=True):
            if node.kind in ("0", "1") and ends:
                shift = int(node.kind == "1")
                for bond, _ in ends[1:]:
                    self.numbers.join(2 * ends[0][0] + shift, 2 * bond + shift)
        final: dict[int, int] = {}
        out = []
        for at in range(2 * len(self.graph.bonds)):
            out.append(final.setdefault(self.numbers.find(at), len(final)))
        self.size = len(final)
        return out

    def fresh(self, symbol: Expr) -> int:
        """The variable of a symbol that no bond carries."""
        found = self.place.get(symbol)
        if found is None:
            found = self.place[symbol] = (self.size, 1)
            self.size += 1
        return found[0]

    def connect(self, final: list[int]) -> None:
        """Say where the symbols of ports, junctions and the bonds between them are."""
        nodes, pool = self.graph.nodes, self.graph.pool
        for number, bond in enumerate(self.graph.bonds):
            if bond.tail.port < 0 and bond.head.port < 0:  # the names that the equations use
                between = f"{nodes[bond.tail.node].path}->{nodes[bond.head.node].path}"
                effort = pool.symbol(f"{between}.e#{bond.number}", Kind.EFFORT)
                flow = pool.symbol(f"{between}.f#{bond.number}", Kind.FLOW)
                self.place[effort] = (final[2 * number], 1)
                self.place[flow] = (final[2 * number + 1], 1)
            for end in (bond.tail, bond.head):
                node = self.graph.nodes[end.node]
                if end.port >= 0 and node.ports:
                    port = node.ports[end.port]
                    self.place[port.effort] = (final[2 * number], end.effort)
                    self.place[port.flow] = (final[2 * number + 1], end.flow)
        for node, ends in zip(self.graph.nodes, self.ends, strict=True):
            if node.common is not None and ends:
                self.place[node.common] = (final[2 * ends[0][0] + (node.kind == "1")], 1)

    def balance(self, number: int, node: Node, final: list[int]) -> Balance:
        shift = int(node.kind == "0")  # a 0-junction balances flows
        terms: dict[int, int] = {}
        for bond, sign in self.ends[number]:
            at = final[2 * bond + shift]
            terms[at] = terms.get(at, 0) + sign
        assert node.common is not None
        common = self.fresh(node.common)
        return Balance(number, tuple((v, c) for v, c in terms.items() if c), node.when, common)

    def flat(self, number: int, expr: Expr) -> Expr:
        """The expression with derivatives of variables only: others get a variable of their own."""
        pool = self.graph.pool
        nodes = topological([expr])
        if all(n.op is not Op.DER or n.args[0].op is Op.SYM for n in nodes):
            return expr
        new: dict[Expr, Expr] = {}
        for node in nodes:
            args = tuple(new[a] for a in node.args)
            if node.op is Op.DER and args[0].op not in (Op.SYM, Op.DER):
                inner = self.inner.get(args[0])
                if inner is None:
                    inner = pool.symbol(f"der#{len(self.inner)}", Kind.INTEGRAL)
                    self.inner[args[0]] = inner
                    self.extra.append((number, pool.sub(inner, args[0])))
                args = (inner,)
            new[node] = pool.rebuild(node, args)
        return new[expr]

    def build(self) -> Assembly:
        graph = self.graph
        final = self.share()
        self.connect(final)
        balances, laws, rates, silent = [], [], [], []
        for number, node in enumerate(graph.nodes):
            if node.kind in ("0", "1"):
                balances.append(self.balance(number, node, final))
            elif node.kind in ("De", "Df"):
                shift = int(node.kind == "De")
                silent += [final[2 * bond + shift] for bond, _ in self.ends[number]]
            laws += [(number, self.flat(number, law.zero)) for law in node.laws]
            for port in node.ports:
                if port.state is not None:
                    value = port.flow if node.kind == "C" else port.effort
                    rates.append(Rate(number, self.fresh(port.state), value))
        for item in graph.integrals:
            rates.append(Rate(-1, self.fresh(item.symbol), self.flat(-1, item.integrand)))
        reads = [s.reads for s in graph.sensors]
        readings = self.readings([law for _, law in laws] + [r.value for r in rates] + reads)
        readings = tuple((name, v, self.flat(-1, expr)) for name, v, expr in readings)
        laws += self.extra
        free: list[int] = []
        unknown: list[int] = []
        for source in graph.inputs:
            if not source.mode:
                (free if source.known else unknown).append(self.fresh(source.symbol))
        self.rest([law for _, law in laws] + [r.value for r in rates])
        return Assembly(
            self.size,
            tuple(range(self.size)),
            self.place,
            tuple(free),
            tuple(unknown),
            tuple(silent),
            tuple(balances),
            tuple(laws),
            tuple(rates),
            readings,
            graph.pool,
        )

    def readings(self, expressions: list[Expr]) -> tuple[tuple[str, int, Expr], ...]:
        """The sensors whose readings occur in the expressions, with what these read."""
        own = self.graph.readings
        used: dict[Expr, None] = {}
        while expressions:
            found = [n for n in topological(expressions) if n in own and n not in used]
            used.update(dict.fromkeys(found))
            expressions = [own[n].reads for n in found]
        ordered = sorted(used, key=lambda s: s.id)
        return tuple((own[s].name, self.fresh(s), own[s].reads) for s in ordered)

    def rest(self, expressions: list[Expr]) -> None:
        """Give every other symbol that may vary a variable of its own."""
        varying = (Kind.EFFORT, Kind.FLOW, Kind.STATE, Kind.INTEGRAL, Kind.UNKNOWN, Kind.INPUT)
        reads = [s.reads for s in self.graph.sensors]
        for node in topological([*expressions, *reads]):
            if node.op is Op.SYM and node.symbol.kind in varying:
                self.fresh(node)


def assemble(graph: BondGraph) -> Assembly:
    """The equations of the plant, one variable for whatever a junction makes common."""
    return _Builder(graph).build()


class Parts:
    """The parts of a plant that share no variable: each can be simulated without the others."""

    def __init__(self, plant: Assembly) -> None:
        self._plant = plant
        self._numbers = Groups[int]()
        for _, terms, when, common in plant.balances:
            self._join([common, *[v for v, _ in terms], *self._variables([when] if when else [])])
        for _, law in plant.laws:
            self._join(self._variables([law]))
        for _, variable, value in plant.rates:
            self._join([variable, *self._variables([value])])
        for _, variable, reads in plant.readings:
            self._join([variable, *self._variables([reads])])
        self._known: dict[frozenset[int], Assembly] = {}

    def _variables(self, roots: list[Expr]) -> list[int]:
        place = self._plant.place
        return [place[n][0] for n in topological(roots) if n in place]

    def _join(self, variables: list[int]) -> None:
        for v in variables[1:]:
            self._numbers.join(variables[0], v)

    def about(self, roots: list[Expr]) -> Assembly:
        """The part of the plant that the variables in the expressions belong to."""
        find = self._numbers.find
        wanted = frozenset(find(v) for v in self._variables(roots))
        found = self._known.get(wanted)
        if found is None:
            found = self._known[wanted] = self._part(wanted)
        return found

    def _part(self, wanted: frozenset[int]) -> Assembly:
        plant = self._plant
        active = tuple(v for v in range(plant.count_of) if self._numbers.find(v) in wanted)
        inside = frozenset(active)

        def holds(expr: Expr) -> bool:
            return inside.issuperset(self._variables([expr]))

        return plant._replace(
            active=active,
            free=tuple(v for v in plant.free if v in inside),
            unknown=tuple(v for v in plant.unknown if v in inside),
            silent=tuple(v for v in plant.silent if v in inside),
            balances=tuple(b for b in plant.balances if b.common in inside),
            laws=tuple(law for law in plant.laws if holds(law[1])),
            rates=tuple(r for r in plant.rates if r.variable in inside),
            readings=tuple(r for r in plant.readings if r[1] in inside),
        )


class Surroundings:
    """Sub-plants: the equations of what is near in the bond graph, all else left open.

    What a plant does its sub-plants can do: a relation that holds on one, whatever faults act
    there, holds on the plant with these faults and with all that are further away.
    """

    def __init__(self, plant: Assembly, graph: BondGraph) -> None:
        self._plant = plant
        self._near: list[list[int]] = [[] for _ in graph.nodes]
        for bond in graph.bonds:
            a, b = bond.tail.node, bond.head.node
            self._near[a].append(b)
            self._near[b].append(a)
        self._laws: list[list[Expr]] = [[] for _ in graph.nodes]
        self._rates: list[list[Rate]] = [[] for _ in graph.nodes]
        self._balances = {b.node: b for b in plant.balances}
        for number, law in plant.laws:
            if number >= 0:
                self._laws[number].append(law)
        for rate in plant.rates:
            if rate.node >= 0:
                self._rates[rate.node].append(rate)
        self._silent = frozenset(plant.silent)
        self._known: dict[tuple[frozenset[int], frozenset[int]], Assembly] = {}
        self._about = [self._symbols(number) for number in range(len(graph.nodes))]
        self._variables = [frozenset(x for x in s if isinstance(x, int)) for s in self._about]
        self._homes: dict[Expr | int, list[int]] = {}
        for number, inside in enumerate(self._about):
            for what in inside:
                self._homes.setdefault(what, []).append(number)

    def _symbols(self, node: int) -> set[Expr | int]:
        """The variables and the constants in the equations of a node."""
        place = self._plant.place
        found: set[Expr | int] = set()
        values = [rate.value for rate in self._rates[node]]
        for n in topological([*self._laws[node], *values]):
            if n.op is Op.SYM:
                found.add(place[n][0] if n in place else n)
        found.update(rate.variable for rate in self._rates[node])
        if node in self._balances:
            balance = self._balances[node]
            found.update((balance.common, *[v for v, _ in balance.terms]))
        return found

    def of(self, symbols: Iterable[Expr]) -> frozenset[int]:
        """The nodes with a variable among the symbols, or a constant that no other node has."""
        place = self._plant.place
        found: set[int] = set()
        for symbol in symbols:
            variable = symbol in place
            homes = self._homes.get(place[symbol][0] if variable else symbol, [])
            if variable or len(homes) == 1:
                found.update(homes)
        return frozenset(found)

    def wider(self, nodes: frozenset[int]) -> frozenset[int]:
        """The nodes, and those next to them."""
        return nodes.union(*[self._near[node] for node in nodes])

    def part(self, nodes: frozenset[int], shown: Iterable[Expr]) -> Assembly:
        """The equations of some nodes, about their variables and the ones `shown`."""
        plant, place = self._plant, self._plant.place
        outside = frozenset(place[s][0] for s in shown if s in place)
        if (nodes, outside) in self._known:
            return self._known[nodes, outside]
        inside = outside.union(*[self._variables[node] for node in nodes])
        ordered = sorted(nodes)
        found = self._known[nodes, outside] = plant._replace(
            active=tuple(sorted(inside)),
            free=tuple(v for v in plant.free if v in inside),
            unknown=tuple(v for v in plant.unknown if v in inside),
            silent=tuple(sorted(self._silent & inside)),
            balances=tuple(self._balances[n] for n in ordered if n in self._balances),
            laws=tuple((n, law) for n in ordered for law in self._laws[n]),
            rates=tuple(rate for n in ordered for rate in self._rates[n]),
            readings=(),
        )
        return found
