"""The equations of a bond graph as this oracle reads them, straight from its bonds.

Each bond has its own effort and flow. A junction makes one of them common to all its bonds and
balances the other (Karnopp, Margolis, Rosenberg, 1990); a port sees them with the signs of its
bond end. Nothing here is shared with the elimination that this oracle checks.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any, NamedTuple

from bondgraph.exact.offsets import Redundancy
from bondgraph.exact.outline import outline
from bondgraph.ir.expr import Expr, Kind, Op, Pool, topological
from bondgraph.ir.graph import BondGraph, Node
from bondgraph.ir.groups import Groups
from bondgraph.structural.floating import references


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

    `place[symbol]` is (variable, sign) for every symbol that is not constant. `free` are the
    variables that the plant leaves open: known inputs first, then unknown ones. `silent` are
    variables that are zero because an ideal detector takes no power. `readings` are sensors
    whose reading a law or another sensor uses: a variable with the expression that it reads.
    `shown` are the sensors: name, symbol and what each reads. `pool` has made all expressions.
    """

    count_of: int
    place: dict[Expr, tuple[int, int]]
    free: tuple[int, ...]
    unknown: tuple[int, ...]
    silent: tuple[int, ...]
    balances: tuple[Balance, ...]
    laws: tuple[tuple[int, Expr], ...]
    rates: tuple[Rate, ...]
    readings: tuple[tuple[str, int, Expr], ...]
    shown: tuple[tuple[str, Expr, Expr], ...]
    pool: Pool


class _Builder:
    def __init__(self, graph: BondGraph) -> None:
        self.graph = graph
        self.ends: list[list[tuple[int, int]]] = [[] for _ in graph.nodes]  # bond, +1 head -1 tail
        for number, bond in enumerate(graph.bonds):
            self.ends[bond.tail.node].append((number, -1))
            self.ends[bond.head.node].append((number, 1))
        self.numbers = Groups[int]()  # effort 2b, flow 2b + 1
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
        grounded = references(graph)
        for number, node in enumerate(graph.nodes):
            if number in grounded and node.common is not None:
                laws.append((number, node.common))
            elif node.kind in ("0", "1"):
                balances.append(self.balance(number, node, final))
            elif node.kind in ("De", "Df"):
                shift = int(node.kind == "De")
                silent += [final[2 * bond + shift] for bond, _ in self.ends[number]]
            laws += [(number, self.flat(number, law.zero)) for law in node.laws]
            for port in node.ports:
                if port.state is not None:
                    rates.append(Rate(number, self.fresh(port.state), port.rate))
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
            self.place,
            tuple(free),
            tuple(unknown),
            tuple(silent),
            tuple(balances),
            tuple(laws),
            tuple(rates),
            readings,
            tuple((s.name, s.symbol, s.reads) for s in graph.sensors if s.same_as is None),
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
    """Sub-plants: some of the equations about some of the variables, all else left open.

    What a plant does its sub-plants can do: a relation that holds on one, whatever faults act
    there, holds on the plant with these faults and with all that are elsewhere. The variables of
    a sub-plant have numbers of their own, so that its size is all that it costs.
    """

    def __init__(self, plant: Assembly) -> None:
        self._plant = plant
        self._entries: list[tuple[str, Any]] = []  # of which field of the assembly, and what
        self._rows: list[list[int]] = []  # the variables of each equation
        numbers = Groups[int]()
        for field in _EQUATIONS:
            for entry in getattr(plant, field):
                row = self._about(field, entry)
                self._entries.append((field, entry))
                self._rows.append(row)
                for v in row[1:]:
                    numbers.join(row[0], v)
        self._component = [numbers.find(v) for v in range(plant.count_of)]
        self._inside: dict[int, tuple[list[int], list[int]]] = {-1: ([], [])}
        for variable, component in enumerate(self._component):
            self._inside.setdefault(component, ([], []))[1].append(variable)
        for number, row in enumerate(self._rows):
            self._inside[self._component[row[0]] if row else -1][0].append(number)
        self._symbols: dict[int, list[Expr]] = {}
        for symbol, (variable, _) in plant.place.items():
            self._symbols.setdefault(variable, []).append(symbol)
        self._sensors: dict[Expr | None, list[tuple[str, Expr, Expr]]] = {}  # by a symbol in each
        for sensor in plant.shown:
            first = next((s for s in outline(sensor[2]).symbols if s in plant.place), None)
            self._sensors.setdefault(first, []).append(sensor)
        self._open = (frozenset(plant.free), frozenset(plant.unknown))
        self._redundancy: Redundancy | None = None
        self._known: dict[frozenset[int], Assembly] = {}

    def _about(self, field: str, entry: Any) -> list[int]:
        """The variables of an equation."""
        inside = self._variables(_expression(field, entry))
        if field == "silent":
            return [entry]
        if field == "balances":
            return [entry.common, *[v for v, _ in entry.terms], *inside]
        return inside if field == "laws" else [entry[1], *inside]

    def _variables(self, expr: Expr | None) -> list[int]:
        place = self._plant.place
        return [place[s][0] for s in outline(expr).symbols if s in place] if expr else []

    def about(self, symbols: Iterable[Expr]) -> Assembly:
        """What hangs together with some symbols: it can be simulated without the rest."""
        place = self._plant.place
        wanted = frozenset(self._component[place[s][0]] for s in symbols if s in place)
        found = self._known.get(wanted)
        if found is None:
            parts = [self._inside[root] for root in (-1, *sorted(wanted))]
            found = self._known[wanted] = self._part(
                [number for equations, _ in parts for number in equations],
                [variable for _, variables in parts for variable in variables],
                [s for _, variables in parts for v in variables for s in self._symbols.get(v, ())],
            )
        return found

    def resting_on(self, told: Iterable[Expr]) -> Assembly:
        """The equations that say more than their variables can take once some values are told.

        A relation among these values rests on no others, where numbers do not happen to agree
        (Dulmage and Mendelsohn, 1958).
        """
        if self._redundancy is None:
            rows = [
                [v for v, _ in entry.terms] if field == "balances" and entry.when is None else row
                for (field, entry), row in zip(self._entries, self._rows, strict=True)
            ]
            self._redundancy = Redundancy(rows, self._plant.count_of)
        told = list(told)
        rows = [self._variables(value) for value in told]
        found = self._redundancy.about(rows)
        named = {s: None for value in told for s in outline(value).symbols}
        for field, entry in (self._entries[number] for number in found):
            expr = _expression(field, entry)
            named.update((s, None) for s in (outline(expr).symbols if expr else ()))
            if field in ("rates", "readings"):
                named.update((s, None) for s in self._symbols.get(entry[1], ()))
        return self._part(found, [v for row in rows for v in row], named)

    def _part(
        self, equations: Iterable[int], shown: Iterable[int], named: Iterable[Expr]
    ) -> Assembly:
        """Some equations, about their variables and those `shown`; `named` are symbols of them."""
        plant, ordered = self._plant, sorted(equations)
        inside = sorted({*shown, *[v for number in ordered for v in self._rows[number]]})
        new = {variable: at for at, variable in enumerate(inside)}
        fields: dict[str, Any] = {field: [] for field in _EQUATIONS}
        for number in ordered:
            field, entry = self._entries[number]
            fields[field].append(_renumbered(field, entry, new))
        for field in _EQUATIONS:
            fields[field] = tuple(fields[field])
        where = [(s, plant.place[s]) for s in named if s in plant.place]
        place = {s: (new[variable], sign) for s, (variable, sign) in where}
        return plant._replace(
            count_of=len(inside),
            place=place,
            free=tuple(new[v] for v in inside if v in self._open[0]),
            unknown=tuple(new[v] for v in inside if v in self._open[1]),
            shown=tuple(
                sensor
                for symbol in (None, *place)
                for sensor in self._sensors.get(symbol, ())
                if all(s in place for s in outline(sensor[2]).symbols if s in plant.place)
            ),
            **fields,
        )


_EQUATIONS = ("silent", "balances", "laws", "rates", "readings")  # fields of an assembly


def _expression(field: str, entry: Any) -> Expr | None:
    """What an equation says of symbols, if it says anything of them."""
    found: Expr | None = None
    if field != "silent":
        found = entry[1] if field == "laws" else entry[2]  # of a balance, while what it holds
    return found


def _renumbered(field: str, entry: Any, new: Mapping[int, int]) -> Any:
    """An equation in other numbers of its variables."""
    if field == "silent":
        return new[entry]
    if field == "balances":
        terms = tuple((new[v], c) for v, c in entry.terms)
        return entry._replace(terms=terms, common=new[entry.common])
    if field == "rates":
        return entry._replace(variable=new[entry.variable])
    return (entry[0], new[entry[1]], entry[2]) if field == "readings" else entry
