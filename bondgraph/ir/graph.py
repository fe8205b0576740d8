"""The flat bond graph: every submodel opened, every array unrolled, every law an expression.

Variables are symbols of the pool. A port of an element has an effort and a flow whose product is
the power INTO the element (of a two-port: into port 1, out of port 2); a 1-junction has one
common flow, a 0-junction one common effort. How a port's variables follow from those of its bond
is said by the signs in `End`.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from fractions import Fraction
from itertools import chain
from typing import TYPE_CHECKING, Literal

from bondgraph.ir.expr import Expr, Kind, Pool, Symbol
from bondgraph.ir.unit import Dimension
from bondgraph.text.source import Source, Span
from bondgraph.text.tuples import NamedTuple

if TYPE_CHECKING:
    import networkx as nx


class Port(NamedTuple):
    """One port of an element.

    `name` is "" for a one-port, "1"/"2" for a two-port, the declared name for a field. `stores`
    says what the port accumulates: "q" of a C (q' = f), "p" of an I (p' = e), "" for nothing; each
    port of an IC has its own. `state` is its symbol, `initial` the SYM of its declared initial
    value and `initial_value` its expression.
    """

    name: str
    effort: Expr
    flow: Expr
    stores: Literal["q", "p", ""] = ""
    state: Expr | None = None
    initial: Expr | None = None
    initial_value: Expr | None = None

    @property
    def rate(self) -> Expr:
        """What the state of a storage port is the integral of."""
        return self.flow if self.stores == "q" else self.effort

    @property
    def output(self) -> Expr:
        """What a storage port gives in integral causality."""
        return self.effort if self.stores == "q" else self.flow


class Law(NamedTuple):
    """One constitutive equation, `zero` = 0; `direction` is the port variable it was solved for
    in the source (`e = R*f` gives e), None for an implicit one."""

    zero: Expr
    direction: Expr | None
    origin: Span


class Node(NamedTuple):
    """A junction or an element.

    `kind` is one of 0 1 R C I IC TF GY Se Sf De Df; `keyword` as written (MSe, MTF, ...). A
    junction has no ports but `common`: its common effort (0) or flow (1). A source has a law `e -
    value` (or f), a detector none: its `sensor` is what it reads. `when` is the mode of a switched
    junction. `direct` marks the laws that are linear with constant coefficients.
    """

    path: str
    kind: str
    keyword: str
    ports: tuple[Port, ...]
    laws: tuple[Law, ...]
    common: Expr | None
    sensor: Expr | None
    when: Expr | None
    domain: str | None
    doc: str
    origin: Span


class End(NamedTuple):
    """Where a bond meets a node.

    `port` indexes `Node.ports` (-1 at a junction). For an element, port.effort = effort * e of
    the bond and port.flow = flow * f of the bond, with each sign +1 or -1.
    """

    node: int
    port: int
    effort: int
    flow: int


class Bond(NamedTuple):
    """A power bond; the half arrow (positive e*f) points from `tail` to `head`."""

    number: int
    label: str | None
    tail: End
    head: End
    origin: Span


class Value(NamedTuple):
    """A `param` or `const`: a symbol with an expression of other values (None: given at configure).

    `fault` says that it is an unbound param that a law uses, and so a fault candidate.
    `tolerance` is relative (1/20 for 5%). `delivery` marks what a controller gives beyond its
    command, `zero` what is declared to be zero where another number stands in its place.
    """

    name: str
    symbol: Expr
    value: Expr | None
    tolerance: Fraction | None
    dimension: Dimension | None
    unit: str | None
    fault: bool
    doc: str
    origin: Span
    delivery: bool = False
    zero: bool = False


class Input(NamedTuple):
    """A known or unknown input; `mode` marks a boolean known at run time.

    At time t the plant obeys what it said at t - `delay`, in s. `of` names the input or sensor
    that this one is a past value of: it is no fault of its own. Samples of it are `offset` too
    large, in its unit.
    """

    name: str
    symbol: Expr
    known: bool
    mode: bool
    dimension: Dimension | None
    unit: str | None
    doc: str
    origin: Span
    delay: Fraction = Fraction(0)
    of: str | None = None
    offset: float = 0.0


class Sensor(NamedTuple):
    """A measured signal: `symbol` (known) reads `reads` (an unknown variable or an expression).

    `kind` is De, Df or signal. `counts` is the number of counts a turn of an encoder; the known
    signal is then in rad and the generated code takes integer counts. `same_as` names the sensor
    whose physical instrument this one reads (then `symbol` is that sensor's symbol). At time t it
    says what was at t - `delay`, in s: the symbol stands for what it will say of now. `of` names
    the sensor that this one is a past value of. Samples of it are `offset` too large, in its unit.
    """

    name: str
    symbol: Expr
    reads: Expr
    kind: str
    node: int | None
    counts: Expr | None
    same_as: str | None
    dimension: Dimension | None
    unit: str | None
    doc: str
    origin: Span
    delay: Fraction = Fraction(0)
    of: str | None = None
    offset: float = 0.0


class Integral(NamedTuple):
    """An `int(x, x0)` of the model: `symbol` with symbol' = integrand, from `initial`."""

    symbol: Expr
    integrand: Expr
    initial: Expr
    initial_value: Expr
    origin: Span


class Let(NamedTuple):
    """A named expression, for display; its uses are already replaced."""

    name: str
    value: Expr
    dimension: Dimension | None
    unit: str | None
    origin: Span


class Event(NamedTuple):
    """A concrete fault for simulation and grouping: `target op value`."""

    name: str
    target: str
    op: str
    value: Expr
    doc: str
    origin: Span


class BondGraph(NamedTuple):
    """A model ready for physics."""

    name: str
    source: Source
    doc: str
    pool: Pool
    nodes: tuple[Node, ...]
    bonds: tuple[Bond, ...]
    values: tuple[Value, ...]
    inputs: tuple[Input, ...]
    sensors: tuple[Sensor, ...]
    integrals: tuple[Integral, ...]
    lets: tuple[Let, ...]
    events: tuple[Event, ...]

    @property
    def faults(self) -> tuple[str, ...]:
        """The fault candidates in the order of the model: params, known inputs, sensors."""
        return tuple(self.fault_symbols())

    def fault_symbols(self) -> dict[str, Expr]:
        """The symbol of each fault candidate, in the order of `faults`."""
        found = {v.name: v.symbol for v in self.values if v.fault}
        found |= {i.name: i.symbol for i in self.inputs if i.known and not i.mode and not i.of}
        return found | {
            s.name: s.symbol for s in self.sensors if s.same_as is None and not s.of
        }

    def lags(self) -> dict[Expr, Fraction]:
        """How long before the plant's own time a log has each signal that is delayed, in s."""
        found = {i.symbol: i.delay for i in self.inputs if i.delay}
        return found | {s.symbol: -s.delay for s in self.sensors if s.delay}

    def past(self, name: str) -> list[Expr]:
        """A fault candidate as relations have it: its symbol, and those of its past values.

        Raises KeyError for another name.
        """
        inputs = [i.symbol for i in self.inputs if i.of == name]
        return [self.fault_symbol(name), *inputs, *[s.symbol for s in self.sensors if s.of == name]]

    @property
    def readings(self) -> dict[Expr, Sensor]:
        """The sensor of each reading that laws or other sensors may use."""
        own = [s for s in self.sensors if s.same_as is None]
        return {self.pool.symbol(s.name, Kind.READING): s for s in own}

    def to_networkx(self) -> nx.MultiDiGraph:
        """The graph for networkx: nodes by path (`kind`, `keyword`, `doc`), one edge a bond from
        the tail of its half arrow to the head (`number`, `label`, and the ports it meets)."""
        import networkx as nx

        graph = nx.MultiDiGraph(name=self.name)
        for node in self.nodes:
            graph.add_node(node.path, kind=node.kind, keyword=node.keyword, doc=node.doc)
        for bond in self.bonds:
            tail, head = self.nodes[bond.tail.node], self.nodes[bond.head.node]
            graph.add_edge(
                tail.path,
                head.path,
                number=bond.number,
                label=bond.label,
                tail_port=tail.ports[bond.tail.port].name if bond.tail.port >= 0 else None,
                head_port=head.ports[bond.head.port].name if bond.head.port >= 0 else None,
            )
        return graph

    def with_values(self, numbers: Mapping[str, float]) -> BondGraph:
        """The same model with other numbers of values, in SI; raises KeyError for another name.

        As if they were written in the file: the shortest decimal of each, exactly. But what is
        declared to be zero, as a leak that is not there yet, stays one that is.
        """
        for name in numbers:
            if all(v.name != name for v in self.values):
                raise KeyError(name)
        written = {n: self.pool.num(Fraction(repr(float(x)))) for n, x in numbers.items()}
        values = tuple(
            v._replace(value=written[v.name], zero=v.zero or v.value is self.pool.zero)
            if v.name in written else v
            for v in self.values
        )  # fmt: skip
        return self._replace(values=values)

    def with_tolerances(self, tolerances: Mapping[str, float]) -> BondGraph:
        """The same model with other relative tolerances; raises KeyError for another name."""
        for name in tolerances:
            if all(v.name != name for v in self.values):
                raise KeyError(name)
        own = {n: Fraction(repr(float(x))) for n, x in tolerances.items()}
        values = tuple(v._replace(tolerance=own.get(v.name, v.tolerance)) for v in self.values)
        return self._replace(values=values)

    def with_offsets(self, offsets: Mapping[str, float]) -> BondGraph:
        """The same model with offsets of sensors and inputs; raises KeyError for another name."""
        signals = {s.name for s in self.sensors} | {i.name for i in self.inputs}
        for name in offsets:
            if name not in signals:
                raise KeyError(name)
        sensors = tuple(s._replace(offset=offsets.get(s.name, s.offset)) for s in self.sensors)
        inputs = tuple(i._replace(offset=offsets.get(i.name, i.offset)) for i in self.inputs)
        return self._replace(sensors=sensors, inputs=inputs)

    @property
    def names(self) -> tuple[str, ...]:
        """The names that may occur in a residual: of parameters, inputs and sensors."""
        symbols = [v.symbol for v in self.values]
        symbols += [i.symbol for i in self.inputs]
        symbols += [s.symbol for s in self.sensors]
        return tuple(dict.fromkeys([s.symbol.name for s in symbols]))

    def initial_values(self) -> dict[Symbol, Expr]:
        """The declared value of each symbol that an integral starts from."""
        ports = [(p.initial, p.initial_value) for node in self.nodes for p in node.ports]
        written = [(i.initial, i.initial_value) for i in self.integrals]
        return {s.symbol: v for s, v in [*ports, *written] if s is not None and v is not None}

    def fault_symbol(self, name: str) -> Expr:
        """The symbol of a fault candidate; raises KeyError for another name."""
        return self._declared(name).symbol

    def fault_origin(self, name: str) -> Span:
        """Where a fault candidate is declared; raises KeyError for another name."""
        return self._declared(name).origin

    def _declared(self, name: str) -> Value | Input | Sensor:
        declared: Iterator[Value | Input | Sensor] = chain(self.values, self.inputs, self.sensors)
        for item in declared:
            if item.name == name:
                return item
        raise KeyError(name)
