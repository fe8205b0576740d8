"""What names mean in expressions: params, inputs, lets, sensors, arguments and signals of nodes."""

from __future__ import annotations

import re
from collections.abc import Iterator

from bondgraph.ir.expr import Expr, Kind, Op, Pool
from bondgraph.ir.syntax import (
    Input,
    Let,
    Node,
    Number,
    Param,
    Part,
    Ref,
    Sensor,
)
from bondgraph.library.dimensions import Term
from bondgraph.library.elements import SIGNALS
from bondgraph.library.units import PI
from bondgraph.passes.elaboration.bonds import FlatBond, sign
from bondgraph.passes.elaboration.build_time import references
from bondgraph.passes.elaboration.calls import Calls, form, names
from bondgraph.passes.elaboration.expressions import Place
from bondgraph.passes.elaboration.lookup import Lookup
from bondgraph.passes.elaboration.problems import Skip, fail, listed
from bondgraph.passes.elaboration.quantities import PURE, Quantities
from bondgraph.passes.elaboration.scope import (
    Bound,
    Env,
    NodeEntry,
    PortEntry,
    PortVariables,
    Scope,
    Typed,
    ValueEntry,
)
from bondgraph.text.diagnostic import Label, Report, replacing
from bondgraph.text.source import Span

_KINDS = {"param": Kind.PARAM, "const": Kind.CONST}


class Values(Calls):
    """Expressions in the names of a model."""

    def __init__(
        self, pool: Pool, report: Report, quantities: Quantities, lookup: Lookup,
        bonds: list[FlatBond],
    ) -> None:  # fmt: skip
        super().__init__(pool, report, quantities)
        self.lookup = lookup
        self.quiet = Lookup(Report())
        self.bonds = bonds
        self.pi = pool.num(PI)
        #: What laws, sensors and other values name.
        self.used: set[ValueEntry] = set()
        # by identity: arguments and declarations outlive this object
        self._aliases: dict[tuple[int, int], Typed] = {}

    # ------------------------------------------------------------------ references

    def reference(self, ref: Ref, place: Place) -> Typed:
        """The value of a reference: of a law variable, a `for` variable, a value, a signal."""
        parts = ref.parts
        if place.local is not None:
            found = place.local.get(_dotted(ref))
            if found is not None:
                return found
        part = parts[-1]
        if len(parts) == 1:
            if part.first is None and part.name in place.env:
                return self.pool.num(place.env[part.name]), PURE
            return self.named(ref, part, place.scope, place)
        before = Ref(parts[:-1], parts[0].origin.to(parts[-2].origin))
        entry, rest = self.lookup.node(before, place.scope, place.env)
        if isinstance(entry, Scope):
            if rest:
                self.lookup.no_node(rest[0], entry)
            return self.named(ref, part, entry, place)
        if isinstance(entry, PortEntry):
            return self.port_signal(entry, ref, (*rest, part))
        assert isinstance(entry, NodeEntry)
        return self.signal(entry, ref, (*rest, part))

    def is_value(self, name: str, place: Place) -> bool:
        """Whether a value of the model or a variable of the law is called so."""
        scope = place.scope
        known = name in scope.values or name in scope.generics or name in place.env
        return known or name in (place.local or ())

    def no_mode(self, ref: Ref, place: Place) -> None:
        """Report an input that is used as a condition and not declared as one, once."""
        entry = place.scope.values.get(ref.parts[0].name)
        if len(ref.parts) > 1 or not isinstance(entry, ValueEntry):
            return
        declaration = entry.declaration
        if isinstance(declaration, Input) and declaration.unit is None:
            end = Span(entry.origin.source, entry.origin.end, entry.origin.end)
            fail(self.report, "not-a-condition", f"The input `{entry.local}` is a number, and a "
                 "condition where it is used.", entry.origin, help=replacing(end, " : bool",
                 f"Declare it so: `input {entry.local} : bool`."))  # fmt: skip

    def named(self, ref: Ref, part: Part, inside: Scope, place: Place) -> Typed:
        """The value of a name of the value namespace of an instance."""
        entry = self.lookup.value(part, inside, place.scope, place.env)
        if entry is not None:
            self.used.add(entry)
            return self.received(entry)
        if part.first is None:
            generic = inside.generics.get(part.name)
            if isinstance(generic, bool):
                return self.truth_value(generic), None
            if generic is not None:
                return self.pool.num(generic), PURE
            if part.name == "pi" and len(ref.parts) == 1:
                return self.pi, PURE
        own = place.local is not None and part.name in SIGNALS and len(ref.parts) == 1
        if own and place.local is not None and part.name not in inside.nodes:
            fail(self.report, "wrong-variable", f"This element has no variable `{part.name}`.",
                 ref.origin, help=f"Its law relates {listed(place.local)}.")  # fmt: skip
        alone = len(ref.parts) == 1 and part.first is None
        if alone and part.name in names() and part.name not in inside.nodes:
            fail(self.report, "not-a-value", f"`{part.name}` is a function, not a value.",
                 ref.origin, help=f"Write what it is taken of in brackets: `{form(part.name)}`."
                 )  # fmt: skip
        known = tuple(place.env) + tuple(inside.generics)
        self.lookup.no_value(ref, part, inside, known, tuple(place.local or ()))

    def signal(self, node: NodeEntry, ref: Ref, parts: tuple[Part, ...]) -> Typed:
        """`x.e`, `x.f`, `x.q`, `x.p`, `gear.f1`, `mic.el.q`."""
        port: PortVariables | None = None
        name = parts[-1].name
        element = node.element
        if element is None:
            fitting = "f" if node.type == "1" else "e"
            if len(parts) == 1 and name == fitting and node.common is not None and node.slot >= 0:
                return node.common, self.quantities.pair(node.slot)[name == "f"]
            what = "effort" if name == "e" else "flow"
            if len(parts) == 1 and name in "ef" and node.slot >= 0:
                fail(self.report, "no-such-signal", f"A {node.type}-junction has no common {what}.",
                     Label(ref.origin), Label(node.origin, "the junction"),
                     help=f"Its common variable is `{node.local}.{fitting}`; name an element for "
                     f"its {what}.")  # fmt: skip
        elif len(parts) == 2 or len(node.ports) == 1:
            wanted = parts[0].name if len(parts) == 2 else node.ports[0].name if node.ports else ""
            port = next((p for p in node.ports if p.name == wanted), None)
        elif name[-1:] in ("1", "2"):
            port = next((p for p in node.ports if p.name == name[-1]), None)
            name = name[:-1]
        if node.slot < 0 and (port is None or port.slot < 0) and self.report.failed:
            raise Skip
        found = self.of_port(port, name) if port is not None else None
        if found is None:
            fail(self.report, "no-such-signal", f"`{ref.origin.text}` is no signal.",
                 Label(ref.origin), Label(node.origin, f"`{node.type}:{node.local}`"),
                 help=self.signals_of(node))  # fmt: skip
        return found

    def of_port(self, port: PortVariables, name: str) -> Typed | None:
        """Effort, flow or state of a port."""
        if port.slot < 0:
            return None
        effort, flow = self.quantities.pair(port.slot)
        if name == "e":
            return port.effort, effort
        if name == "f":
            return port.flow, flow
        if port.state is None or name != port.stores:
            return None
        return port.state, self.quantities.integrated(flow if name == "q" else effort)

    def signals_of(self, node: NodeEntry) -> str:
        """What can be read of a node."""
        if len(node.ports) > 1 and node.element is not None and len(node.element.ports) == 1:
            return f"Name a port: `{node.local}.{node.ports[0].name}.e`."
        state = node.ports[0].stores if node.ports else ""
        more = f" `{node.local}.{state}` is its state." if state else ""
        return self.lookup.signals(node, node.local) + more

    def port_signal(self, port: PortEntry, ref: Ref, parts: tuple[Part, ...]) -> Typed:
        """Effort and flow of the bond through a model port, positive as the port is declared."""
        name = parts[0].name
        if len(parts) > 1 or name not in ("e", "f"):
            fail(self.report, "no-such-signal", f"`{ref.origin.text}` is no signal.", ref.origin,
                 help=self.lookup.signals(port, port.name))  # fmt: skip
        if port.bond < 0:
            if self.report.failed:
                raise Skip
            fail(self.report, "no-such-signal", f"Nothing is connected to port `{port.name}`.",
                 ref.origin, help="Connect it.")  # fmt: skip
        bond = self.bonds[port.bond]
        leaves = port.inside[0].bond.tail is port.inside[0]
        direction = 1 if leaves == (port.declaration.direction == "in") else -1
        pair = self.quantities.pair(self.quantities.bond_slot[port.bond])
        term = pair[0] if name == "e" else pair[1]
        for own, other, into in ((bond.tail, bond.head, False), (bond.head, bond.tail, True)):
            node = own.node
            if own.port < 0:
                if (node.type, name) in (("0", "e"), ("1", "f")) and node.common is not None:
                    factor = direction if name == "f" else 1
                    return self.pool.scale(factor, node.common), term
                continue
            end = sign(own, other, into)
            variables = node.ports[own.port]
            if name == "e":
                return self.pool.scale(end.effort, variables.effort), term
            return self.pool.scale(end.flow * direction, variables.flow), term
        what, kind = ("effort", "0") if name == "e" else ("flow", "1")
        fail(self.report, "no-such-signal", f"The {what} of port `{port.name}` has no name: its "
             "bond joins two junctions of the other kind.", ref.origin,
             help=f"Put a `{kind}` junction there and read its {what}.")  # fmt: skip

    # ------------------------------------------------------------------ values

    def value(self, entry: ValueEntry) -> Typed:
        """Expression and dimension of a value; raises Skip if it was found wrong before."""
        if entry.typed is None:
            if entry.wrong:
                raise Skip
            self.settle(entry)
        if entry.typed is None:
            raise Skip
        return entry.typed

    def received(self, entry: ValueEntry) -> Typed:
        """The value as an expression uses it: of a sensor its reading."""
        node, term = self.value(entry)
        if node.kind is Kind.SENSOR:
            return self.pool.symbol(node.symbol.name, Kind.READING), term
        return node, term

    def settle(self, entry: ValueEntry) -> None:
        """Find a value and, first, all that it is made of: a stack, as chains may be long."""
        stack = [entry]
        while stack:
            top = stack[-1]
            if top.typed is not None or top.wrong:
                stack.pop()
                continue
            if not top.open:
                top.open = True
                needed = [d for d in self.needs(top) if d.typed is None and not d.wrong]
                round = next((d for d in needed if d.open), None)
                if round is not None:
                    self.circular([e for e in stack[stack.index(round) :] if e.open])
                    continue
                if needed:
                    stack += reversed(needed)
                    continue
            stack.pop()
            try:
                top.typed = self.find(top)
            except Skip:
                top.wrong = True

    def circular(self, entries: list[ValueEntry]) -> None:
        """Report names that are defined by each other."""
        for entry in entries:
            entry.wrong = True
        names = " needs ".join(f"`{e.local}`" for e in (*entries, entries[0]))
        help = "Break the circle: an algebraic loop belongs into a law or a junction."
        if any(re.search(r"\bint\s*\(", e.declaration.origin.text) for e in entries):
            name = entries[0].local
            help = (
                "A signal whose rate depends on itself is a state, and a storage has states: "
                f"`Sf:rate = ... -> 0:n` with its rate and `n -> C:{name} = 1`; `n.e` is what was "
                f"meant by `{name}`."
            )
        self.report.error(
            "circular-definition", f"These names are defined by each other: {names}.",
            *[Label(e.given.origin if e.given else e.origin) for e in entries[:4]],
            help=help,
        )  # fmt: skip

    def needs(self, entry: ValueEntry) -> Iterator[ValueEntry]:
        """The values that an alias is made of directly."""
        if entry.given is not None:
            return self.mentioned(entry.given)
        node = entry.declaration
        if isinstance(node, Let) or (isinstance(node, Node) and node.value is not None):
            assert node.value is not None
            return self.mentioned(Bound(node.value, entry.scope, entry.env, entry.origin))
        return iter(())

    def mentioned(self, bound: Bound) -> Iterator[ValueEntry]:
        """The values that occur in an expression, as far as they can be found."""
        for ref in references(bound.value):
            try:
                found = self.peek(ref, bound.scope, bound.env)
            except Skip:
                continue
            if found is not None:
                yield found

    def peek(self, ref: Ref, scope: Scope, env: Env) -> ValueEntry | None:
        """The value a reference means, without saying what is wrong with it."""
        part = ref.parts[-1]
        if len(ref.parts) == 1:
            return None if part.name in env else self.quiet.value(part, scope, scope, env)
        inside, rest = self.quiet.node(Ref(ref.parts[:-1], ref.origin), scope, env)
        if isinstance(inside, Scope) and not rest:
            return self.quiet.value(part, inside, scope, env)
        return None

    def find(self, entry: ValueEntry) -> Typed:
        """One value whose parts are known."""
        declaration = entry.declaration
        if entry.given is not None:
            return self.bound(entry, entry.given)
        if isinstance(declaration, Let):
            place = Place(entry.scope, entry.env, entry.path)
            return self.convert(declaration.value, place)
        if isinstance(declaration, Param):
            return self.parameter(entry, declaration)
        if isinstance(declaration, Input):
            if declaration.boolean:
                return self.pool.symbol(entry.path, Kind.MODE), None
            kind = Kind.UNKNOWN if declaration.unknown else Kind.INPUT
            return self.pool.symbol(entry.path, kind), self.declared(entry, declaration)
        if isinstance(declaration, Sensor):
            symbol = self.pool.symbol(entry.path, Kind.SENSOR)
            return symbol, self.declared(entry, declaration)
        node = entry.node
        if node is None:  # a source without a declared input
            symbol = self.pool.symbol(entry.path, Kind.INPUT)
            return symbol, self.quantities.dimensions.fresh(entry.origin, f"input {entry.local}")
        return self.detector(entry, node, declaration)

    def declared(self, entry: ValueEntry, declaration: Param | Input | Sensor) -> Term:
        """The dimension that a declaration states, or an open one."""
        if declaration.unit is None:
            return self.quantities.dimensions.fresh(entry.origin, entry.local)
        origin, unit = declaration.origin, declaration.unit
        start = origin.source.text.index(unit, declaration.name.origin.end)
        place = Span(origin.source, start, start + len(unit))
        dimension, _ = self.quantities.unit(unit, place)
        what = f"`{entry.local}` is declared in {declaration.unit}"
        return self.quantities.known(dimension, declaration.origin, what)

    def parameter(self, entry: ValueEntry, declaration: Param) -> Typed:
        """A param or const that is not bound: a symbol."""
        symbol = self.pool.symbol(entry.path, _KINDS[declaration.keyword])
        if declaration.unit is None and declaration.value is None:
            raise Skip
        if declaration.unit is None and isinstance(declaration.value, Number):
            place = Place(entry.scope, entry.env, entry.path)
            return symbol, self.number(declaration.value, place)[1]
        if declaration.value is None and entry.scope.parent is not None:
            scope = entry.scope
            fail(self.report, "missing-argument", f"`{scope.model.name}` needs a value of "
                 f"`{entry.local}`.", Label(scope.origin, "used here"),
                 Label(entry.origin, "declared without a value"),
                 help=f"Give it where the model is used: `({entry.local} = ...)`.")  # fmt: skip
        return symbol, self.declared(entry, declaration)

    def bound(self, entry: ValueEntry, given: Bound) -> Typed:
        """A name that an argument binds: an alias; the same for all instances of an array."""
        key = (id(given), id(entry.declaration))
        found = self._aliases.get(key)
        if found is None:
            found = self._aliases[key] = self.alias(entry, given)
        return found

    def alias(self, entry: ValueEntry, given: Bound) -> Typed:
        """What an argument gives to a name, checked against how the name is declared."""
        place = Place(given.scope, given.env, entry.path)
        node, term = self.convert(given.value, place)
        declaration = entry.declaration
        boolean = isinstance(declaration, Input) and declaration.boolean
        if boolean != (term is None):
            what = "true or false" if boolean else "a number"
            fail(self.report, "wrong-type", f"`{entry.local}` must be {what}.",
                 Label(given.origin, "given here"), Label(entry.origin, "declared here"),
                 help="Give what is declared.")  # fmt: skip
        if isinstance(declaration, Param) and not self.constant(node):
            fail(self.report, "not-constant", f"`{entry.local}` is a {declaration.keyword}, but is "
                 "given something that depends on signals.", Label(given.origin, "given here"),
                 Label(entry.origin, "declared here"),
                 help=f"Declare it `input {entry.local}` in `{entry.scope.model.name}`."
                 )  # fmt: skip
        if term is not None and isinstance(declaration, (Param, Input)):
            own: Term | None = None
            if declaration.unit is not None:
                own = self.declared(entry, declaration)
            elif isinstance(declaration, Param) and isinstance(declaration.value, Number):
                own = self.number(declaration.value, Place(entry.scope, entry.env, ""))[1]
            if own is not None:
                self.alike(own, term, given.origin, f"`{entry.local}` has the unit it is declared "
                           "with")  # fmt: skip
        return node, term

    def detector(self, entry: ValueEntry, node: NodeEntry, declaration: Node) -> Typed:
        """What a De or Df measures; with a value it reads the instrument that this names."""
        if declaration.value is None:
            if not node.ports or node.ports[0].slot < 0:
                term = self.quantities.dimensions.fresh(entry.origin, entry.local)
            else:
                assert node.element is not None
                pair = self.quantities.pair(node.ports[0].slot)
                term = pair[0] if node.element.kind == "De" else pair[1]
            return self.pool.symbol(entry.path, Kind.SENSOR), term
        place = Place(entry.scope, entry.env, entry.path)
        symbol, other = self.quantity(declaration.value, place)
        if symbol.op is not Op.SYM or symbol.symbol.kind is not Kind.READING:
            fail(self.report, "not-a-sensor", f"`{declaration.value.origin.text}` is no sensor.",
                 declaration.value.origin, help="After `=` a detector names the sensor whose "
                 "instrument it reads; a measured expression is `sensor name = ...`."
                 )  # fmt: skip
        if node.ports and node.ports[0].slot >= 0 and node.element is not None:
            pair = self.quantities.pair(node.ports[0].slot)
            own = pair[0] if node.element.kind == "De" else pair[1]
            self.alike(own, other, entry.origin, "one instrument has one unit")
        return self.pool.logged([symbol])[0], other

    def constant_value(self, bound: Bound, owner: str, what: str) -> tuple[Expr, Term]:
        """An expression that may not depend on signals."""
        node, term = self.quantity(bound.value, Place(bound.scope, bound.env, owner))
        if not self.constant(node):
            fail(self.report, "not-constant", f"{what} cannot depend on signals.", bound.origin,
                 help="Use numbers and params; what changes with time is a `let` or an `input`."
                 )  # fmt: skip
        return node, term


def _dotted(ref: Ref) -> str:
    return ".".join(p.name for p in ref.parts) if all(p.first is None for p in ref.parts) else ""
