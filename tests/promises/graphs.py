"""What a bond graph, its causality and its equations promise."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator

from bondgraph.ir.causal import CausalGraph, Reason
from bondgraph.ir.equation_system import EquationSystem
from bondgraph.ir.expr import CONSTANTS, KNOWN_SIGNALS, Expr, Kind, Op, below, symbols, variables
from bondgraph.ir.graph import BondGraph, Node
from bondgraph.passes.causality.rules import closing
from bondgraph.structural.floating import references
from bondgraph.text.source import Span
from tests.promises.check import promise


def twice(names: Iterable[object]) -> list[object]:
    """What occurs more than once."""
    return [name for name, count in Counter(names).items() if count > 1]


def strangers(expr: Expr, known: Iterable[Expr]) -> list[str]:
    """The symbols of an expression that are not among the known ones."""
    own = set(known)
    return [s.symbol.name for s in symbols(expr) if s not in own]


def is_place(origin: object) -> bool:
    """Whether this is a span within its source."""
    return isinstance(origin, Span) and 0 <= origin.start <= origin.end <= len(origin.source.text)


# ----------------------------------------------------------------------- bond graph


@promise("BondGraph")
def bonds_are_numbered_in_order(graph: BondGraph) -> Iterator[str]:
    """`graph.bonds[i].number` is i."""
    yield from (f"bond {b.number} is at {i}" for i, b in enumerate(graph.bonds) if b.number != i)


@promise("BondGraph")
def bonds_end_at_ports(graph: BondGraph) -> Iterator[str]:
    """A bond ends at two different nodes, at a port of an element or at a junction, with signs."""
    for bond in graph.bonds:
        if bond.tail.node == bond.head.node:
            yield f"bond {bond.number} goes from a node to itself"
        for end in (bond.tail, bond.head):
            if not 0 <= end.node < len(graph.nodes):
                yield f"bond {bond.number} ends at node {end.node}"
                continue
            node = graph.nodes[end.node]
            junction = node.kind in ("0", "1")
            if end.port != -1 if junction else not 0 <= end.port < len(node.ports):
                yield f"bond {bond.number} ends at port {end.port} of {node.path}"
            if {abs(end.effort), abs(end.flow)} != {1}:
                yield f"bond {bond.number} has a sign that is no sign"


@promise("BondGraph")
def ports_have_one_bond(graph: BondGraph) -> Iterator[str]:
    """Every port of an element has one bond."""
    ends = Counter((e.node, e.port) for b in graph.bonds for e in (b.tail, b.head))
    for number, node in enumerate(graph.nodes):
        for port in range(len(node.ports)):
            if ends[number, port] != 1 and node.keyword != "port":
                yield f"port {port} of {node.path} has {ends[number, port]} bonds"


@promise("BondGraph")
def names_are_unique(graph: BondGraph) -> Iterator[str]:
    """Nodes have names of their own; so have parameters, inputs, sensors and lets."""
    yield from (f"two nodes {name}" for name in twice(n.path for n in graph.nodes))
    groups = (graph.values, graph.inputs, graph.sensors, graph.lets)
    for name in twice(item.name for group in groups for item in group):
        yield f"two values {name}"


@promise("BondGraph")
def nodes_have_what_their_kind_has(graph: BondGraph) -> Iterator[str]:
    """A junction has its common variable, a detector what it reads, a storage a state at each port.

    An element has a law for each port; a detector has none.
    """
    for node in graph.nodes:
        yield from (f"{node.path}: {what}" for what in _unlike_its_kind(node))


def _unlike_its_kind(node: Node) -> Iterator[str]:
    if (node.common is not None) != (node.kind in ("0", "1")):
        yield "common variable"
    if (node.sensor is not None) != (node.kind in ("De", "Df")):
        yield "sensor"
    if node.when is not None and node.kind not in ("0", "1"):
        yield "`when` at an element"
    if any((p.state is not None) != (node.kind in ("C", "I", "IC")) for p in node.ports):
        yield "states"
    if any((p.initial is None) != (p.initial_value is None) for p in node.ports):
        yield "initial value"
    laws = 0 if node.kind in ("0", "1", "De", "Df") else len(node.ports)
    if len(node.laws) != laws and node.keyword != "port":
        yield f"{len(node.laws)} laws for {laws} ports"


@promise("BondGraph")
def laws_hold_declared_symbols(graph: BondGraph) -> Iterator[str]:
    """Laws, sensors, modes and integrals hold variables of nodes and declared names only."""
    known = [*_variables(graph), *_declared(graph)]
    exprs = [(n.path, law.zero) for n in graph.nodes for law in n.laws]
    exprs += [(n.path, e) for n in graph.nodes for e in (n.when, n.sensor) if e is not None]
    exprs += [(s.name, s.reads) for s in graph.sensors]
    exprs += [(i.symbol.symbol.name, i.integrand) for i in graph.integrals]
    for name, expr in exprs:
        yield from (f"{name} holds {symbol}" for symbol in strangers(expr, known))


def _variables(graph: BondGraph) -> Iterator[Expr]:
    for node in graph.nodes:
        for port in node.ports:
            yield from (v for v in (port.effort, port.flow, port.state) if v is not None)
        if node.common is not None:
            yield node.common
    yield from (i.symbol for i in graph.integrals)


def _declared(graph: BondGraph) -> Iterator[Expr]:
    for group in (graph.values, graph.inputs, graph.sensors):
        yield from (item.symbol for item in group)
    yield from graph.readings


@promise("BondGraph")
def values_are_constants_without_a_circle(graph: BondGraph) -> Iterator[str]:
    """A declared value or initial value follows from other values, and never from itself."""
    values = {v.symbol: v.value for v in graph.values}
    for name, value in [
        *[(v.name, v.value) for v in graph.values],
        *[(s.name, e) for s, e in graph.initial_values().items()],
    ]:
        if value is not None:
            yield from (f"{name} holds {s}" for s in strangers(value, values))
    done = {s for s, value in values.items() if value is None}
    while True:
        more = {s for s, v in values.items() if s not in done and v and done >= {*symbols(v)}}
        if not more:
            break
        done |= more
    yield from (f"{s.symbol.name} follows from itself" for s in values if s not in done)


@promise("BondGraph")
def second_instruments_exist(graph: BondGraph) -> Iterator[str]:
    """`same_as` names a sensor that is no second name itself, and has its symbol."""
    first = {s.name: s.symbol for s in graph.sensors if s.same_as is None}
    for sensor in graph.sensors:
        if sensor.same_as is not None and first.get(sensor.same_as) is not sensor.symbol:
            yield sensor.name


@promise("BondGraph")
def all_is_from_somewhere(graph: BondGraph) -> Iterator[str]:
    """Everything has a place in a source."""
    groups: tuple[Iterable[object], ...] = (
        graph.nodes, graph.bonds, graph.values, graph.inputs, graph.sensors, graph.integrals,
        graph.lets, graph.events, [law for n in graph.nodes for law in n.laws],
    )  # fmt: skip
    for group in groups:
        for item in group:
            if not is_place(getattr(item, "origin", None)):
                yield f"{type(item).__name__} without a place"


# ------------------------------------------------------------------------- causality


def _strong_bonds(causal: CausalGraph, ends: list[int], kind: str) -> int:
    """How many ends give the junction its common variable: effort comes in at the stroke."""
    heads = [causal.strokes[e >> 1].at == "head" for e in ends]
    received = [head == bool(e & 1) for head, e in zip(heads, ends, strict=True)]
    return sum(effort == (kind == "0") for effort in received)


def _ends(graph: BondGraph) -> list[list[int]]:
    at: list[list[int]] = [[] for _ in graph.nodes]
    for number, bond in enumerate(graph.bonds):
        at[bond.tail.node].append(2 * number)
        at[bond.head.node].append(2 * number + 1)
    return at


def _receives_effort(causal: CausalGraph, end: int) -> bool:
    return (causal.strokes[end >> 1].at == "head") == bool(end & 1)


@promise("CausalGraph")
def every_bond_has_a_stroke(causal: CausalGraph) -> Iterator[str]:
    """There is one stroke a bond."""
    if len(causal.strokes) != len(causal.graph.bonds):
        yield f"{len(causal.strokes)} strokes for {len(causal.graph.bonds)} bonds"


@promise("CausalGraph")
def junctions_have_one_strong_bond(causal: CausalGraph) -> Iterator[str]:
    """One bond gives a junction its common variable; a bond that closes a ring of them does not.

    Of a plant that is never on as a whole, a switched junction may have none, or be the source.
    """
    graph = causal.graph
    pairs = [(b.tail.node, b.head.node) for b in graph.bonds]
    idle = set(closing([n.kind for n in graph.nodes], pairs))
    for node, ends in zip(graph.nodes, _ends(graph), strict=True):
        own = [e for e in ends if e >> 1 not in idle]
        if node.kind in ("0", "1") and node.when is None:
            strong = _strong_bonds(causal, own, node.kind)
            if strong != 1:
                yield f"{node.path} has {strong}"


@promise("CausalGraph")
def two_ports_turn_or_pass_the_stroke(causal: CausalGraph) -> Iterator[str]:
    """A transformer receives one effort, a gyrator two or none."""
    for node, ends in zip(causal.graph.nodes, _ends(causal.graph), strict=True):
        if node.kind in ("TF", "GY") and len(ends) == 2:
            received = sum(_receives_effort(causal, e) for e in ends)
            if (received == 1) != (node.kind == "TF"):
                yield f"{node.path} receives {received} efforts"


@promise("CausalGraph")
def sources_and_sensors_have_their_way(causal: CausalGraph) -> Iterator[str]:
    """A source gives what it is; a detector takes what it measures, and gives it if dualised."""
    gives = {"Se": True, "Sf": False, "De": False, "Df": True}
    for number, ends in enumerate(_ends(causal.graph)):
        node = causal.graph.nodes[number]
        if node.kind in gives:
            effort = gives[node.kind] != (number in causal.dualised)
            if any(_receives_effort(causal, e) == effort for e in ends):
                yield f"{node.path} has the stroke at the wrong end"


@promise("CausalGraph")
def detectors_are_dualised_in_derivative_preference(causal: CausalGraph) -> Iterator[str]:
    """In derivative preference each detector is dualised or said not to be; else none is asked."""
    told = [*causal.dualised, *causal.not_dualised]
    kinds = [n.kind for n in causal.graph.nodes]
    detectors = [n for n, kind in enumerate(kinds) if kind in ("De", "Df")]
    if sorted(told) != (detectors if causal.preference == "derivative" else []):
        yield f"{told} of {detectors}"


@promise("CausalGraph")
def storages_are_told_as_their_strokes_stand(causal: CausalGraph) -> Iterator[str]:
    """Each storage port is told once: a C that gives effort and an I that gives flow integrate."""
    graph = causal.graph
    told = {(s.node, s.port): s.integral for s in causal.storages}
    if len(told) != len(causal.storages):
        yield "a storage is told twice"
    stands: dict[tuple[int, int], bool] = {}
    for number, ends in enumerate(_ends(graph)):
        node = graph.nodes[number]
        for e in ends if node.kind in ("C", "I", "IC") else ():
            bond = graph.bonds[e >> 1]
            port = (bond.head if e & 1 else bond.tail).port
            stands[number, port] = _receives_effort(causal, e) == (node.ports[port].stores == "p")
    for at in sorted(told.keys() | stands.keys()):
        if told.get(at) != stands.get(at):
            yield f"port {at[1]} of {graph.nodes[at[0]].path}"


_CAUSES: dict[str, tuple[str, ...]] = {
    "source": ("Se", "Sf"),
    "sensor": ("De", "Df"),
    "preferred": ("C", "I", "IC"),
    "ring": ("0", "1"),
    "switched": ("0", "1"),
    "propagated": ("0", "1", "TF", "GY"),
}
_ANY = ("R", "TF", "GY", "0", "1")  # of a law, or of a free choice


@promise("CausalGraph")
def reasons_fit_their_nodes(causal: CausalGraph) -> Iterator[str]:
    """A source is fixed by a source, a preference is that of a storage, what is forced is so there.

    The node of a reason other than a refusal is at the bond.
    """
    graph = causal.graph
    for bond, stroke in zip(graph.bonds, causal.strokes, strict=False):
        reason: Reason = stroke.reason
        if not 0 <= reason.node < len(graph.nodes):
            yield f"bond {bond.number}: no node {reason.node}"
        elif graph.nodes[reason.node].kind not in _CAUSES.get(reason.cause, _ANY):
            yield f"bond {bond.number}: {reason.cause} at {graph.nodes[reason.node].path}"
        elif reason.node not in (bond.tail.node, bond.head.node):
            yield f"bond {bond.number}: {graph.nodes[reason.node].path} is elsewhere"
        if bond.number in reason.because or any(b >= len(graph.bonds) for b in reason.because):
            yield f"bond {bond.number}: because of {reason.because}"


@promise("CausalGraph")
def loops_have_nodes(causal: CausalGraph) -> Iterator[str]:
    """An algebraic loop names nodes of the graph, each once."""
    for loop in causal.loops:
        if not loop or twice(loop) or not all(0 <= n < len(causal.graph.nodes) for n in loop):
            yield f"{loop}"


# ------------------------------------------------------------------------- equations


@promise("EquationSystem")
def unknowns_are_what_the_equations_hold(system: EquationSystem) -> Iterator[str]:
    """Every unknown occurs, everything that occurs is one, each once."""
    held = {v for e in system.equations for v in e.variables}
    yield from (f"{v} twice" for v in twice(system.unknowns))
    for variable in sorted(held.symmetric_difference(system.unknowns), key=lambda v: v.id):
        yield variable.symbol.name


@promise("EquationSystem")
def variables_are_those_of_the_expression(system: EquationSystem) -> Iterator[str]:
    """`variables` are those below `zero`, the state first."""
    for equation in system.equations:
        own = [v for v in variables(equation.zero) if v is not equation.state]
        if equation.state is not None:
            own.insert(0, equation.state)
        if own != [*equation.variables]:
            yield f"{equation.kind} of {equation.name}"


@promise("EquationSystem")
def equations_are_counted(system: EquationSystem) -> Iterator[str]:
    """One balance a junction, the laws and states of each element, one a sensor and an integral.

    The junction that grounds a floating network has none: it follows from the others.
    """
    graph = system.graph
    grounds = references(graph)
    own = Counter((e.kind, e.node) for e in system.equations)
    for number, node in enumerate(graph.nodes):
        for kind, wanted in (
            ("balance", int(node.kind in ("0", "1") and number not in grounds)),
            ("law", len(node.laws)),
            ("state", sum(p.state is not None for p in node.ports)),
        ):
            if own[kind, number] != wanted:
                yield f"{own[kind, number]} {kind} equations of {node.path}, not {wanted}"
    kinds = Counter(e.kind for e in system.equations)
    if kinds["sensor"] != sum(s.same_as is None for s in graph.sensors):
        yield f"{kinds['sensor']} sensor equations"
    if kinds["integral"] != len(graph.integrals):
        yield f"{kinds['integral']} integral equations"


@promise("EquationSystem")
def shared_variables_are_gone(system: EquationSystem) -> Iterator[str]:
    """What stands for another variable is written in those that remain, in one step."""
    for variable in system.unknowns:
        if variable in system.shared:
            yield f"{variable.symbol.name} is still in an equation"
    for variable, value in system.shared.items():
        if any(v in system.shared for v in variables(value)):
            yield f"{variable.symbol.name} stands for one that stands for another"


@promise("EquationSystem")
def bonds_have_their_two_variables(system: EquationSystem) -> Iterator[str]:
    """An effort and a flow a bond, each a variable with a sign, or zero around a ring."""
    for what, column in (("efforts", system.efforts), ("flows", system.flows)):
        if len(column) != len(system.graph.bonds):
            yield f"{len(column)} {what}"
        for expr in column:
            signed = expr.args[0] if expr.op is Op.ADD and len(expr.args) == 1 else expr
            if signed.op is not Op.SYM and signed is not system.graph.pool.zero:
                yield f"{what}: {expr}"


@promise("EquationSystem")
def states_integrate_their_rates(system: EquationSystem) -> Iterator[str]:
    """The equation of a state is D(state) - rate; its start, if any, is a declared one."""
    pool = system.graph.pool
    for equation in system.equations:
        if (equation.state is not None) != (equation.kind in ("state", "integral")):
            yield f"{equation.kind} of {equation.name} has a state or none"
        elif equation.state is None or equation.rate is None:
            continue
        elif equation.zero is not pool.sub(pool.der(equation.state), equation.rate):
            yield f"{equation.name}: the rate is another"
        start = equation.initial
        if start is not None and start.kind is not Kind.INITIAL:
            yield f"{equation.name} starts at {start}"


@promise("EquationSystem")
def equations_hold_signals_constants_and_unknowns(system: EquationSystem) -> Iterator[str]:
    """No torn variable and no undeclared initial value is in an equation; nodes are of the pool."""
    allowed = KNOWN_SIGNALS | CONSTANTS - {Kind.FREE}
    for equation in system.equations:
        for node in below([equation.zero]):
            if node.op is Op.SYM and node not in equation.variables and node.kind not in allowed:
                yield f"{equation.name} holds {node}"
