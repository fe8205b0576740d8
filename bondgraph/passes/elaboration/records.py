"""From checked entries to the records of the flat graph: values, inputs, sensors, lets, events."""

from __future__ import annotations

from fractions import Fraction
from typing import TypeVar

from bondgraph.ir.expr import Expr, Kind, Op, symbols
from bondgraph.ir.graph import Event, Input, Integral, Let, Sensor, Value
from bondgraph.ir.nodes import occurs
from bondgraph.ir.syntax import Call, Fault, Node, Number, Param, Ref, Tolerance
from bondgraph.ir.syntax import Input as InputStatement
from bondgraph.ir.syntax import Let as LetStatement
from bondgraph.ir.syntax import Sensor as SensorStatement
from bondgraph.library.dimensions import Term
from bondgraph.passes.elaboration import instantiate
from bondgraph.passes.elaboration.bonds import FlatEnd
from bondgraph.passes.elaboration.build_time import index
from bondgraph.passes.elaboration.calls import Past
from bondgraph.passes.elaboration.expressions import Place
from bondgraph.passes.elaboration.laws import Coefficient
from bondgraph.passes.elaboration.problems import Skip, fail
from bondgraph.passes.elaboration.quantities import PURE
from bondgraph.passes.elaboration.received import Delivery
from bondgraph.passes.elaboration.scope import Bound, NodeEntry, Scope, ValueEntry
from bondgraph.passes.elaboration.values import Values
from bondgraph.text.diagnostic import Label
from bondgraph.text.source import Span
from bondgraph.text.tuples import NamedTuple

Record = TypeVar("Record", Value, Input, Sensor, Let)

#: Longer exact numbers are not worked out.
_MOST_BITS = 4096


class Tolerated(NamedTuple):
    """A tolerance as a fraction of its value, and where it is written."""

    relative: Fraction
    origin: Span


class Records:
    """Collects what the graph lists beside nodes and bonds."""

    def __init__(self, values: Values, attached: dict[int, FlatEnd]) -> None:
        self.values = values
        self.report = values.report
        self.attached = attached
        self.params: list[tuple[Value, Term | None, str | None]] = []
        self.inputs: list[tuple[Input, Term | None, str | None]] = []
        self.sensors: list[tuple[Sensor, Term | None, str | None]] = []
        self.lets: list[tuple[Let, Term | None, str | None]] = []
        self.events: dict[str, Event] = {}
        self.numbers: dict[Expr, Expr | None] = {}
        self.tolerated: dict[Expr, Tolerated] = {}
        self.deliveries: dict[str, Delivery] = {}  # of controllers, by path
        #: how old what a sensor says is, of those that say it late
        self.ages: dict[Expr, Past] = {}

    def entry(self, entry: ValueEntry) -> None:
        """The record of one value; nothing for an alias."""
        try:
            node, term = self.values.value(entry)
        except Skip:
            return
        declaration = entry.declaration
        try:
            if isinstance(declaration, SensorStatement):
                self.sensor(entry, declaration, node, term)
            elif entry.kind == "detector":
                assert isinstance(declaration, Node)
                self.detector(entry, declaration, node, term)
            elif isinstance(declaration, LetStatement):
                let = Let(entry.path, node, None, None, entry.origin)
                self.lets.append((let, term, None))
            elif entry.given is not None:
                return
            elif isinstance(declaration, Param):
                self.param(entry, declaration, node, term)
            else:
                self.input(entry, declaration, node, term)
        except Skip:
            return

    # ------------------------------------------------------------------ params, inputs

    def param(self, entry: ValueEntry, declaration: Param, symbol: Expr, term: Term | None
              ) -> None:  # fmt: skip
        """An unbound param or const."""
        value: Expr | None = None
        unit = declaration.unit
        if declaration.value is not None:
            bound = Bound(declaration.value, entry.scope, entry.env, declaration.value.origin)
            what = f"The {declaration.keyword} `{entry.local}`"
            value, own = self.values.constant_value(bound, entry.path, what)
            assert term is not None
            if not isinstance(declaration.value, Number):
                self.values.alike(term, own, declaration.value.origin, f"`{entry.local}` has one "
                                  "unit")  # fmt: skip
            elif unit is None:
                unit = declaration.value.unit
                # a plain number gets its unit from its use: `own` was made for this copy of it
        self.numbers[symbol] = value
        tolerance = self.tolerance(declaration.tolerance, value, term, symbol)
        record = Value(entry.path, symbol, value, tolerance, None, None, False, declaration.doc,
                       entry.origin)  # fmt: skip
        self.params.append((record, term, unit))

    def delivery(self, item: Delivery) -> None:
        """What a controller gives beyond its command: nothing, as long as it works."""
        name, node = item.symbol.symbol.name, item.node
        self.deliveries[node.path] = item
        self.numbers[item.symbol] = self.values.pool.zero
        doc = f"what {node.path} delivers beyond its command"
        record = Value(name, item.symbol, self.values.pool.zero, None, None, None, True, doc,
                       node.origin, delivery=True)  # fmt: skip
        self.params.append((record, item.term, None))

    def coefficient(self, item: Coefficient) -> None:
        """A coefficient of an element with a tolerance."""
        node = item.node
        assert node.declaration is not None
        self.numbers[item.symbol] = item.value
        tolerance = self.tolerance(node.declaration.tolerance, item.value, item.term, item.symbol)
        record = Value(item.symbol.symbol.name, item.symbol, item.value, tolerance, None, None,
                       False, node.doc, node.origin)  # fmt: skip
        value = node.declaration.value
        unit = value.unit if isinstance(value, Number) else None
        self.params.append((record, item.term, unit))

    def tolerance(
        self, written: Tolerance | None, value: Expr | None, term: Term | None, symbol: Expr
    ) -> Fraction | None:
        """A relative tolerance; an absolute one is divided by the value."""
        if written is None:
            return None
        relative = self.relative(written, value, term)
        self.tolerated[symbol] = Tolerated(relative, written.origin)
        return relative

    def relative(self, written: Tolerance, value: Expr | None, term: Term | None) -> Fraction:
        """A tolerance as a fraction of the value."""
        if written.relative:
            return self.values.held(abs(written.quantity.value), written.origin)
        quantity, unit = self.values.number(written.quantity)
        if term is not None:
            self.values.alike(term, unit, written.origin, "a tolerance has the unit of the value")
        nominal = self.number(value) if value is not None else None
        if not nominal:
            help = "Give it in percent, `+- 5%`."
            if nominal == 0:
                help = "A share of zero is nothing: give a value that it is near, or no tolerance."
            fail(self.report, "wrong-tolerance", "An absolute tolerance needs a value that is a "
                 "number other than zero.", written.origin, help=help)  # fmt: skip
        return self.values.held(abs(quantity.number / nominal), written.origin)

    def number(self, expr: Expr, depth: int = 0) -> Fraction | None:
        """The value of an expression of params, where it is rational and all are known."""
        if expr.op is Op.NUM:
            return expr.number
        if depth > 50:
            return None
        if expr.op is Op.SYM:
            value = self.numbers.get(expr)
            return self.number(value, depth + 1) if value is not None else None
        parts = [self.number(a, depth + 1) for a in expr.args]
        known = [p for p in parts if p is not None]
        if len(known) < len(parts):
            return None
        if expr.op is Op.ADD:
            return sum((c * p for c, p in zip(expr.coefficients, known, strict=True)), Fraction(0))
        if expr.op is Op.MUL:
            result = Fraction(1)
            for p, e in zip(known, expr.exponents, strict=True):
                bits = max(p.numerator.bit_length(), p.denominator.bit_length())
                if (p == 0 and e < 0) or bits * abs(e) > _MOST_BITS:
                    return None
                result *= p**e
            return result
        return None

    def input(
        self, entry: ValueEntry, declaration: InputStatement | Node, symbol: Expr,
        term: Term | None,
    ) -> None:  # fmt: skip
        """An unbound input, declared or not."""
        declared = isinstance(declaration, InputStatement)
        unit = declaration.unit if isinstance(declaration, InputStatement) else None
        known = symbol.symbol.kind is not Kind.UNKNOWN
        doc = declaration.doc if isinstance(declaration, InputStatement) else ""
        if not declared and not doc:
            node = entry.scope.nodes.get(entry.local)
            doc = getattr(node, "doc", "")
        record = Input(entry.path, symbol, known, term is None, None, None, doc, entry.origin)
        self.inputs.append((record, term, unit))

    # ------------------------------------------------------------------ sensors

    def sensor(self, entry: ValueEntry, declaration: SensorStatement, symbol: Expr,
               term: Term | None) -> None:  # fmt: skip
        """`sensor name = expression`."""
        place = Place(entry.scope, entry.env, entry.path)
        value = declaration.value
        if isinstance(value, Call) and value.name == "delay" and len(value.arguments) == 2:
            if declaration.counts is not None:
                fail(self.report, "delay-counts", "An encoder tells its counts at once.",
                     value.origin, help="Leave out the delay, or the counts.")  # fmt: skip
            value, time = value.arguments
            self.ages[symbol] = Past(symbol, self.values.age(time, place), time.origin)
        reads, own = self.values.quantity(value, place)
        assert term is not None
        self.values.alike(term, own, declaration.value.origin, f"sensor `{entry.local}` has the "
                          "unit of what it reads")  # fmt: skip
        if occurs(symbol, *self.values.pool.logged([reads])):
            fail(self.report, "circular-definition", f"Sensor `{entry.local}` reads itself.",
                 declaration.value.origin, help="A sensor reads signals of nodes, as in `rotor.f`."
                 )  # fmt: skip
        if self.values.constant(reads):
            fail(self.report, "constant-sensor", f"Sensor `{entry.local}` reads no signal.",
                 declaration.value.origin, help="A sensor reads signals of nodes, as in `rotor.f`."
                 " A level that is always there is a source, as in `Se:level = 2 -> 0:n -> De:y`."
                 )  # fmt: skip
        counts: Expr | None = None
        if declaration.counts is not None:
            bound = Bound(declaration.counts, entry.scope, entry.env, declaration.counts.origin)
            counts, unit = self.values.constant_value(bound, entry.path, "The counts a turn")
            self.values.quantities.pure(unit, declaration.counts.origin, "counts have no unit")
            self.values.quantities.same(
                term, PURE, declaration.origin, "an encoder measures an angle, in rad",
                "It counts parts of a turn. Read an angle, a length over what the machine goes in a"
                " radian, as in `sensor x : rad = int(v.f)/r counts 2048/turn`.",
            )  # fmt: skip
        record = Sensor(entry.path, symbol, reads, "signal", None, counts, None, None, None,
                        declaration.doc, entry.origin)  # fmt: skip
        self.sensors.append((record, term, declaration.unit))

    def detector(self, entry: ValueEntry, declaration: Node, symbol: Expr, term: Term | None
                 ) -> None:  # fmt: skip
        """A De or Df on its junction."""
        node = entry.node
        assert node is not None and node.element is not None
        other = self.attached.get(node.number)
        if other is None:
            return
        kind = node.element.kind
        wanted, what = ("0", "effort") if kind == "De" else ("1", "flow")
        if other.port >= 0 or other.node.type != wanted or other.node.common is None:
            found = f"a {other.node.type}-junction" if other.port < 0 else f"`{other.node.local}`"
            remedy = "Df" if kind == "De" else "De"
            fail(self.report, "misplaced-detector", f"`{kind}:{node.name}` reads the common {what} "
                 f"of a {wanted}-junction, but hangs on {found}.", Label(node.origin),
                 Label(other.node.origin, "connected to this"),
                 help=f"Put it on a {wanted}-junction" + (f", or use `{remedy}`." if
                 other.port < 0 else "."))  # fmt: skip
        same = symbol.symbol.name if declaration.value is not None else None
        if same is not None:
            self.report.info("same-instrument", f"`{node.local}` reads the instrument `{same}`: "
                             "together they are one sensor, and one fault.", node.origin,
                             help="Two detectors of one instrument always agree, so that they "
                             "check nothing. If it is an instrument of its own, leave out the "
                             f"`= {same}`.")  # fmt: skip
        record = Sensor(entry.path, symbol, other.node.common, kind, node.number, None, same, None,
                        None, node.doc, entry.origin)  # fmt: skip
        self.sensors.append((record, term, None))

    # ------------------------------------------------------------------ events

    def event(self, event: instantiate.Event) -> None:
        """A `fault` statement."""
        declaration, scope, env = event.declaration, event.scope, event.env
        try:
            symbol, term, target = self.target(declaration.target, scope, event)
            place = Place(scope, env, scope.path + event.local)
            switch = symbol.symbol.kind is Kind.MODE
            value = (self.position if switch else self.size)(declaration, place, term)
        except Skip:
            return
        name = scope.path + event.local
        before = self.events.get(name)
        if before is not None:
            self.report.error(
                "duplicate-name", f"The fault `{event.local}` is declared twice.",
                Label(declaration.name.origin, "declared again"), Label(before.origin, "here"),
                help="Give one of them another name.",
            )  # fmt: skip
            return
        self.events[name] = Event(
            name, target, declaration.op, value, declaration.doc, declaration.name.origin
        )

    def size(self, declaration: Fault, place: Place, term: Term | None) -> Expr:
        """What a fault event does to a number; `term` is the unit of its target."""
        value, own = self.values.quantity(declaration.value, place)
        if not self.values.constant(value):
            fail(self.report, "not-constant", "A fault event has a constant size.",
                 declaration.value.origin, help="Use numbers and params.")  # fmt: skip
        if declaration.op == "*=":
            self.values.quantities.pure(own, declaration.value.origin, "a factor has no unit")
        elif term is not None:
            self.values.alike(term, own, declaration.origin, "a fault has the unit of its "
                              "target")  # fmt: skip
        return value

    def position(self, declaration: Fault, place: Place, _: Term | None) -> Expr:
        """Where a fault event holds a switch."""
        value = self.values.condition(declaration.value, place) if declaration.op == "=" else None
        if value is None or value.op is not Op.NUM:
            fail(self.report, "wrong-type", f"`{declaration.target.origin.text}` is a switch: it "
                 "can be held on or off.", declaration.value.origin,
                 help="Write `= true` or `= false`.")  # fmt: skip
        return value

    def target(self, ref: Ref, scope: Scope, event: instantiate.Event
               ) -> tuple[Expr, Term | None, str]:  # fmt: skip
        """The param, input or sensor that a fault acts on."""
        for part in ref.parts:
            index(part, scope, event.env, self.report)
        delivery = self.delivered(ref, scope, event)
        if delivery is not None:
            return delivery.symbol, delivery.term, delivery.symbol.symbol.name
        place = Place(scope, event.env, scope.path + event.local)
        symbol, term = self.values.reference(ref, place)
        symbol = self.values.pool.logged([symbol])[0]
        faulty = (Kind.PARAM, Kind.INPUT, Kind.SENSOR, Kind.MODE)
        if symbol.op is not Op.SYM or symbol.symbol.kind not in faulty:
            self.no_target(ref, symbol)
        return symbol, term, symbol.symbol.name

    def delivered(self, ref: Ref, scope: Scope, event: instantiate.Event) -> Delivery | None:
        """What a controller gives beyond its command, by the name that this has as a fault."""
        try:
            entry, left = self.values.quiet.node(ref, scope, event.env)
        except Skip:
            return None
        if not isinstance(entry, NodeEntry) or entry.path not in self.deliveries:
            return None
        found = self.deliveries[entry.path]
        meant = ".".join([entry.path, *[p.name for p in left]])
        return found if found.symbol.symbol.name == meant else None

    def no_target(self, ref: Ref, symbol: Expr) -> None:
        """Report a target that cannot fail."""
        if symbol.kind is Kind.CONST:
            message, help = f"`{ref.origin.text}` is a const: it cannot fail.", (
                "Declare it `param`.")  # fmt: skip
        else:
            message = f"`{ref.origin.text}` is no fault candidate."
            help = (
                "A fault acts on a param that is not bound, a known input or a sensor: name the "
                "param that this one is made of."
            )
        fail(self.report, "not-a-fault", message, ref.origin, help=help)

    # ------------------------------------------------------------------ integrals

    def integrals(self) -> list[Integral]:
        """Every `int(...)` of the model."""
        values = self.values
        return [
            Integral(symbol, integrand, initial, start, values.origins[symbol].origin)
            for (integrand, start), (symbol, initial) in values.integrals.items()
        ]

    # ------------------------------------------------------------------ after all units are known

    def check_values(self) -> None:
        """Refuse params that are defined by each other."""
        uses = {
            r.symbol: [s for s in symbols(r.value) if s in self.numbers]
            for r, _, _ in self.params
            if r.value is not None and r.value.op is not Op.NUM
        }
        origins: dict[Expr, Span] = {r.symbol: r.origin for r, _, _ in self.params}
        done: set[Expr] = set()
        for start in uses:
            path: list[Expr] = []
            stack = [(start, 0)]
            while stack:
                symbol, depth = stack.pop()
                del path[depth:]
                if symbol in path:
                    circle = [*path[path.index(symbol) :], symbol]
                    names = " needs ".join(f"`{s.symbol.name}`" for s in circle)
                    self.report.error(
                        "circular-definition", f"These params are defined by each other: {names}.",
                        *[origins[s] for s in circle[:-1][:4]], help="Give one of them a number.",
                    )  # fmt: skip
                    return
                if symbol in done:
                    continue
                path.append(symbol)
                deeper = uses.get(symbol, [])
                if not deeper:
                    done.add(symbol)
                stack += [(s, len(path)) for s in reversed(deeper)]
            done.update(path)
            done.add(start)

    def finished(self, used: frozenset[Expr]) -> tuple[
        tuple[Value, ...], tuple[Input, ...], tuple[Sensor, ...], tuple[Let, ...]
    ]:  # fmt: skip
        """The records with dimensions and units; a param among `used` is a fault candidate."""
        values = [
            v._replace(fault=v.symbol in used and v.symbol.symbol.kind is Kind.PARAM)
            for v in self._shown(self.params)
        ]
        return (
            tuple(values),
            self._shown(self.inputs),
            self._shown(self.sensors),
            self._shown(self.lets),
        )

    def _shown(self, items: list[tuple[Record, Term | None, str | None]]) -> tuple[Record, ...]:
        found = []
        for record, term, unit in items:
            dimension, written = self.values.quantities.show(term, unit)
            found.append(record._replace(dimension=dimension, unit=written))
        return tuple(found)
