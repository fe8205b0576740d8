"""From syntax to the flat bond graph: instances opened, bonds joined, laws and units checked."""

from __future__ import annotations

import gc

from bondgraph.ir.expr import Expr, Kind, Op, Pool, topological
from bondgraph.ir.graph import Bond, BondGraph, Integral, Law, Node, Port
from bondgraph.ir.syntax import File
from bondgraph.library.elements import PASSIVE
from bondgraph.passes.elaboration.bonds import (
    FlatBond,
    FlatEnd,
    Flattener,
    check_scope,
    sign,
)
from bondgraph.passes.elaboration.connect import Wiring
from bondgraph.passes.elaboration.delayed import delayed
from bondgraph.passes.elaboration.expressions import Place
from bondgraph.passes.elaboration.files import Definition, Files, Load, pick, recursion
from bondgraph.passes.elaboration.implausible import (
    report_signs,
    report_sources,
    report_temperatures,
)
from bondgraph.passes.elaboration.instantiate import Opener
from bondgraph.passes.elaboration.laws import Laws
from bondgraph.passes.elaboration.lookup import Lookup
from bondgraph.passes.elaboration.number_checks import check_numbers
from bondgraph.passes.elaboration.oversights import (
    report_nameless,
    report_parts,
    report_unused,
)
from bondgraph.passes.elaboration.problems import Abort, Skip, fail
from bondgraph.passes.elaboration.quantities import Quantities
from bondgraph.passes.elaboration.received import Received
from bondgraph.passes.elaboration.records import Records
from bondgraph.passes.elaboration.scope import Array, NodeEntry, Scope, ValueEntry, flattened
from bondgraph.passes.elaboration.values import Values
from bondgraph.passes.elaboration.variables import create, initial_values
from bondgraph.text.diagnostic import Report
from bondgraph.text.source import Source

_MODAL = (Kind.MODE, Kind.PARAM, Kind.CONST, Kind.INPUT)


def elaborate(
    file: File, source: Source, model: str | None, load: Load, report: Report, open_ports: bool
) -> BondGraph | None:
    """The flat bond graph of the model `model` (None: the one that no other in the file uses).

    `load` finds the file of an `import`. With `open_ports` a port of the top model may have
    nothing outside: an element without a law (kind R, keyword `port`) then stands for the world.
    All values are in SI. Errors go to `report`, and the result is None. Linear in the size of
    the flat model.
    """
    collecting = gc.isenabled()
    gc.disable()  # what is made here is kept: looking for garbage would take as long again
    try:
        files = Files(load, report)
        definition = pick(file, files.definitions(file, source), model, report, source)
        recursion(definition, report)
        return _Elaboration(definition, report, open_ports).run()
    except (Skip, Abort):
        return None
    except RecursionError:
        report.error("expression-too-deep", "The model is nested too deeply.", file.origin,
                     help="Split long expressions into several `let`s.")  # fmt: skip
        return None
    finally:
        if collecting:
            gc.enable()


class _Elaboration:
    """One run for one model."""

    def __init__(self, definition: Definition, report: Report, open_ports: bool) -> None:
        self.definition = definition
        self.report = report
        self.pool = Pool()
        self.opener = Opener(report)
        self.lookup = Lookup(report)
        self.flattener = Flattener(report, open_ports)
        self.quantities = Quantities(report)
        self.nodes: list[NodeEntry] = []
        self.entries: list[ValueEntry] = []
        self.scopes: list[Scope] = []

    def run(self) -> BondGraph | None:
        """The graph, or None after errors."""
        model = self.definition.model
        for item in flattened(self.opener.open(self.definition)):
            if isinstance(item, NodeEntry):
                self.nodes.append(item)
            elif isinstance(item, ValueEntry):
                self.entries.append(item)
            else:
                self.scopes.append(item)
        self.connect()
        if not self.nodes and not self.report.failed:
            fail(self.report, "empty-model", f"`{model.name}` has no junction and no element.",
                 model.name_origin, help="Declare some: `Se:U -> R:load = 2 Ohm`.")  # fmt: skip
        bonds = self.flattener.bonds
        values = Values(self.pool, self.report, self.quantities, self.lookup, bonds)
        laws = Laws(values)
        records = Records(values, self.attached(bonds))
        for entry in self.entries:
            records.entry(entry)
        nodes = [self.node(n, laws) for n in self.nodes]
        integrands = values.integrands
        received = Received(self.pool, self.report, self.quantities, integrands, self.entries)
        nodes = [received.node(e, n) for e, n in zip(self.nodes, nodes, strict=True)]
        self.opener.check_arguments()
        for delivery in received.deliveries.values():
            records.delivery(delivery)
        for event in self.opener.events:
            records.event(event)
        for coefficient in laws.coefficients:
            records.coefficient(coefficient)
        records.check_values()
        if self.report.failed:
            return None
        integrals = records.integrals()
        reads = [s.reads for s, _, _ in records.sensors]
        used = _used([law.zero for n in nodes for law in n.laws] + reads, integrals)
        listed, inputs, sensors, lets = records.finished(used)
        graph = BondGraph(
            name=model.name, source=self.definition.source, doc=model.doc, pool=self.pool,
            nodes=tuple([n._replace(domain=self.domain(e))
                         for n, e in zip(nodes, self.nodes, strict=True)]),
            bonds=tuple([_bond(i, b) for i, b in enumerate(bonds)]),
            values=listed, inputs=inputs, sensors=sensors, integrals=tuple(integrals), lets=lets,
            events=tuple(records.events.values()),
        )  # fmt: skip
        if values.past or records.ages:
            graph = delayed(graph, values.past, records.ages, records.number, self.report)
        check_numbers(graph, self.report)
        if not self.report.failed:
            report_parts(graph, self.report)
            report_unused(self.entries, values.used, self.report)
            report_nameless(laws.nameless, self.report)
            report_temperatures(self.nodes, self.report)
            report_sources(self.nodes, self.quantities, self.report)
            report_signs(laws.linear_ones, records.number, records.tolerated, self.report)
        return None if self.report.failed else graph

    def connect(self) -> None:
        """Bonds, ports and the variables of all nodes."""
        wiring = Wiring(self.report, self.lookup)
        for scope in self.scopes:
            wiring.connect(scope)
        for scope in self.scopes:
            check_scope(scope, self.flattener)
        self.flattener.flatten(wiring.bonds)
        self.nodes += self.flattener.added
        for number, node in enumerate(self.nodes):
            node.number = number
            create(self.pool, node)
        self.quantities.group(self.flattener.bonds)
        for scope in self.scopes:
            for port in scope.ports.values():
                self.quantities.seed(port)

    def attached(self, bonds: list[FlatBond]) -> dict[int, FlatEnd]:
        """What each detector hangs on."""
        found: dict[int, FlatEnd] = {}
        for bond in bonds:
            for own, other in ((bond.tail, bond.head), (bond.head, bond.tail)):
                if own.node.element is not None and own.node.element.kind in ("De", "Df"):
                    found[own.node.number] = other
        return found

    def node(self, entry: NodeEntry, laws: Laws) -> Node:
        """One node of the graph; its laws are empty if they are wrong."""
        element = entry.element
        sensor: Expr | None = None
        found: tuple[Law, ...] = ()
        keyword = entry.type
        if element is not None:
            kind = element.kind
            try:
                found = laws.laws(entry)
                if kind in PASSIVE:
                    laws.hold(entry, found)
                if kind in ("De", "Df"):
                    value = entry.scope.values[entry.name]
                    sensor = self.sensor(value, entry, laws.values)
            except Skip:
                pass
            initial_values(entry, laws.values)
        else:
            kind = entry.type
            keyword = "port" if entry.ports else kind
        when = None if entry.when is None else self.when(entry, laws.values)
        ports = tuple(
            [
                Port(p.name, p.effort, p.flow, p.stores, p.state, p.initial, p.initial_value)
                for p in entry.ports
            ]
        )
        return Node(entry.path, kind, keyword, ports, found, entry.common, sensor, when, None,
                    entry.doc, entry.origin)  # fmt: skip

    @staticmethod
    def sensor(value: object, entry: NodeEntry, values: Values) -> Expr | None:
        """The symbol that a detector gives."""
        if isinstance(value, Array):
            value = value.entries.get(entry.place or 0)
        return values.value(value)[0] if isinstance(value, ValueEntry) else None

    def when(self, entry: NodeEntry, values: Values) -> Expr | None:
        """The mode of a switched junction; None if it is always on."""
        assert entry.when is not None
        try:
            place = Place(entry.when.scope, entry.when.env, entry.path)
            node = values.condition(entry.when.value, place)
            for symbol in topological([node]):
                if symbol.op is Op.SYM and symbol.symbol.kind not in _MODAL:
                    fail(self.report, "not-a-mode", f"`{symbol.symbol.name}` is no input, so it "
                         "cannot switch a junction.", entry.when.origin,
                         help="Declare the mode, `input on : bool`, and write `when on`."
                         )  # fmt: skip
        except Skip:
            return None
        if node is self.pool.one:
            return None
        if node is self.pool.zero:
            return self.pool.compare("<", self.pool.one, self.pool.zero)
        return node

    def domain(self, entry: NodeEntry) -> str | None:
        """The domain of a node, where all its ports are of one."""
        slots = [p.slot for p in entry.ports] or [entry.slot]
        names = [self.quantities.domain_of(s) for s in slots]
        return names[0] if all(n == names[0] for n in names) else None


def _bond(number: int, bond: FlatBond) -> Bond:
    tail = sign(bond.tail, bond.head, False)
    head = sign(bond.head, bond.tail, True)
    return Bond(number, bond.label, tail, head, bond.origin)


def _used(roots: list[Expr], integrals: list[Integral]) -> frozenset[Expr]:
    """All symbols that laws and sensors depend on, through integrals too."""
    integrands = {i.symbol: i.integrand for i in integrals}
    found: set[Expr] = set()
    while roots:
        fresh = [n for n in topological(roots, stop=found.__contains__) if n not in found]
        found.update(fresh)
        roots = [integrands[n] for n in fresh if n in integrands]
    return frozenset(n for n in found if n.op is Op.SYM)
