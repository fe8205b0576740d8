"""Open every model instance: unroll `for`, decide `if`, declare nodes and values, keep chains.

`Arguments` are what the round brackets of a node bind; how large a model may become is counted.
"""

from __future__ import annotations

from typing import assert_never

from bondgraph.ir.syntax import (
    Argument,
    Chain,
    Fault,
    For,
    If,
    Input,
    Junction,
    Let,
    Node,
    Param,
    Part,
    Port,
    Ref,
    Sensor,
    Statement,
)
from bondgraph.library.elements import JUNCTIONS, KINDS
from bondgraph.library.units import DOMAINS
from bondgraph.passes.elaboration.build_time import decided, index, mentions, truth, whole_number
from bondgraph.passes.elaboration.declared_again import DeclaredAgain
from bondgraph.passes.elaboration.files import Definition, Missing
from bondgraph.passes.elaboration.problems import Abort, Skip, fail, listed, meant, rough
from bondgraph.passes.elaboration.scope import (
    Array,
    Bound,
    Env,
    Given,
    Link,
    Named,
    NodeEntry,
    PortEntry,
    Scope,
    ValueEntry,
    ValueKind,
)
from bondgraph.text.diagnostic import Label, Remedy, Report, replacing
from bondgraph.text.limits import PARTS, UNROLLED
from bondgraph.text.source import Span
from bondgraph.text.tuples import NamedTuple

_KEYWORDS: dict[str, ValueKind] = {"param": "param", "const": "const"}
#: What elements are called in circuits and in mechanics, and which kind they are.
_KIND_OF = {
    word: kind
    for kind, words in {
        "R": "resistor damper friction d b", "C": "capacitor cap spring k",
        "I": "l inductor coil mass m inertia j",
    }.items()
    for word in words.split()
}  # fmt: skip
_VALUE_OF = {
    "R": "resistance, effort over flow", "C": "capacitance or compliance, 1/k of a spring",
    "I": "inertia or inductance",
}  # fmt: skip
#: A statement of so many characters counts once, a longer one more.
_USUAL = 40


class Event(NamedTuple):
    """A `fault` statement of one instance."""

    declaration: Fault
    local: str
    scope: Scope
    env: Env


class Arguments:
    """Keeps the arguments of a model and sees that each binds something, once."""

    def __init__(self, report: Report) -> None:
        self.report = report
        self.givens: list[tuple[Given, Scope | NodeEntry]] = []

    def structure(self, scope: Scope) -> None:
        """The structural arguments of an instance."""
        for generic in scope.model.generics:
            if generic.name in scope.generics:
                self.report.error(
                    "duplicate-name", f"There are two structural arguments `{generic.name}`.",
                    generic.origin, help="Rename one of them.",
                )  # fmt: skip
            bound: Bound | None = None
            for given in self.matching(scope.givens, generic.name, None):
                if len(given.parts) == 1:
                    given.root.used = True
                    self.once(bound, given)
                    bound = given.bound
            if bound is None:
                if generic.default is None:
                    where = scope.origin if scope.parent else generic.origin
                    fail(self.report, "missing-argument", f"`{scope.model.name}` needs a value of "
                         f"`{generic.name}`.", Label(where, "used here" if scope.parent else ""),
                         Label(generic.origin, "declared without a default"),
                         help=f"Give it where the model is used, `({generic.name} = ...)`, or "
                         f"declare a default: `{generic.name} : {generic.type} = ...`."
                         )  # fmt: skip
                bound = Bound(generic.default, scope, {}, generic.origin)
            value = decided(bound.value, bound.scope, bound.env, self.report)
            if isinstance(value, bool) != (generic.type == "bool"):
                fail(self.report, "wrong-type", f"`{generic.name}` is declared {generic.type}.",
                     Label(bound.origin, "this is not"), Label(generic.origin, "declared here"),
                     help="Give an int or a bool, as declared.")  # fmt: skip
            if not isinstance(value, bool):
                if value.denominator != 1:
                    fail(self.report, "not-an-integer", f"`{generic.name}` is declared int, but "
                         f"given {rough(value)}.", bound.origin,
                         help="Use a whole number.")  # fmt: skip
                scope.generics[generic.name] = value.numerator
            else:
                scope.generics[generic.name] = value

    def arguments(self, node: Node, scope: Scope, env: Env) -> list[Given]:
        """The arguments in round brackets, each with where its value is to be read."""
        return [self.argument(a, scope, env) for a in node.arguments]

    def argument(self, argument: Argument, scope: Scope, env: Env) -> Given:
        """One argument, its target split into names with their indices."""
        parts = tuple([(p.name, index(p, scope, env, self.report)) for p in argument.target.parts])
        return Given(parts, Bound(argument.value, scope, env, argument.origin), argument)

    @staticmethod
    def matching(givens: list[Given], name: str, place: int | None) -> list[Given]:
        """The arguments whose target begins with `name` (of that index, or of none)."""
        return [g for g in givens if g.parts[0][0] == name and g.parts[0][1] in (None, place)]

    def once(self, before: Bound | None, given: Given) -> None:
        """Refuse a second argument for one thing."""
        if before is not None:
            fail(self.report, "duplicate-argument",
                 f"`{given.argument.target.origin.text}` is given twice.",
                 Label(given.argument.origin, "given again"), Label(before.origin, "given here"),
                 help="Keep one of them.")  # fmt: skip

    def refuse_givens(self, entry: NodeEntry, givens: list[Given]) -> None:
        """Only a storage takes arguments (its initial state)."""
        for given in givens:
            given.root.used = True
            self.report.error(
                "unknown-argument",
                f"`{entry.type}:{entry.name}` takes no argument "
                f"`{given.argument.target.origin.text}`.", given.argument.origin,
                help="Round brackets give the initial state of a C (q0) or an I (p0), or bind the "
                "params of a submodel; a coefficient is written after `=`.",
            )  # fmt: skip

    def check_arguments(self) -> None:
        """Report arguments that bind nothing."""
        for given, entry in self.givens:
            if given.used:
                continue
            text = given.argument.target.origin.text
            help: str | Remedy
            if isinstance(entry, Scope):
                names = [n for n, v in entry.values.items() if _bindable(v)]
                names += entry.generics
                otherwise = f"It takes {listed(names) or 'none'}."
                origin = given.argument.target.origin
                help = meant(given.parts[0][0], names, otherwise, origin)
                message = f"`{entry.model.name}` takes no argument `{text}`."
            else:
                ports = [(f"{p.name}." if p.name else "", p.stores) for p in entry.ports]
                names = [f"`{before}{stores}0`" for before, stores in ports if stores]
                kinds = {stores for _, stores in ports if stores}
                what = {"q": "displacement or charge", "p": "momentum or flux"}
                own = f": its {what[kinds.pop()]}" if len(kinds) == 1 else ""
                help = f"It takes {' or '.join(names)}, its initial state{own}."
                message = f"`{entry.type}:{entry.name}` takes no argument `{text}`."
            self.report.error("unknown-argument", message, given.argument.origin, help=help)


def _last(origin: Span, word: str) -> Span:
    """The last place of a word in a stretch of the text."""
    start = origin.start + max(origin.text.rfind(word), 0)
    return Span(origin.source, start, start + len(word))


def _bindable(value: Named) -> bool:
    if isinstance(value, Array):
        return any(_bindable(v) for v in value.entries.values())
    return isinstance(value, ValueEntry) and value.kind in ("param", "const", "input")


class Opener(Arguments):
    """Opens the top model and, one after the other, all that it contains."""

    def __init__(self, report: Report) -> None:
        super().__init__(report)
        self.waiting: list[Scope] = []
        self.events: list[Event] = []
        self.size = Size(report)
        self.again = DeclaredAgain(report)

    def open(self, definition: Definition) -> Scope:
        """The top instance with everything inside it."""
        origin = definition.model.name_origin
        top = Scope(definition, None, definition.model.name, None, origin)
        self.structure(top)
        self.waiting.append(top)
        while self.waiting:
            self.fill(self.waiting.pop())
        return top

    def fill(self, scope: Scope) -> None:
        """Everything that the body of the model says."""
        self.again = DeclaredAgain(self.report)
        self.body(scope.model.body, scope, {}, None)
        for item in tuple(scope.items):
            # a source without a value is a known input, declared or not
            if isinstance(item, NodeEntry) and item.element is not None:
                node = item.declaration
                bare = node is not None and node.value is None and node.law is None
                if item.element.kind in ("Se", "Sf") and bare and item.name not in scope.values:
                    self.implied(item, scope)
        self.again.tell(scope)

    def implied(self, first: NodeEntry, scope: Scope) -> None:
        """Inputs for the source (or sources, of an array) that nothing declares."""
        same = scope.nodes[first.name]
        group = list(same.entries.values()) if isinstance(same, Array) else [same]
        for entry in group:
            if isinstance(entry, NodeEntry) and entry.declaration is not None:
                value = ValueEntry("input", entry.name, entry.place, scope, entry.env,
                                   entry.declaration, entry.origin)  # fmt: skip
                self.enter(scope.values, entry.name, entry.place, value, entry.origin)
                scope.items.append(value)
                self.bind(value, entry.name, entry.place)

    # ------------------------------------------------------------------ statements

    def body(
        self, body: tuple[Statement, ...], scope: Scope, env: Env, at: NodeEntry | Ref | None
    ) -> None:
        """Statements, inside the junction `at` if there is one."""
        for statement in body:
            try:
                self.statement(statement, scope, env, at)
            except Skip:
                # what it would have declared is not known: do not report its uses as well
                if isinstance(statement, (For, If)):
                    scope.incomplete = True
                elif isinstance(statement, Junction):
                    scope.wrong.add(statement.name.parts[0].name)
                    scope.unlinked = True
                elif not isinstance(statement, Chain):
                    name = statement.name
                    scope.wrong.add(name if isinstance(name, str) else name.name)

    def statement(
        self, statement: Statement, scope: Scope, env: Env, at: NodeEntry | Ref | None
    ) -> None:
        """One statement of a body."""
        match statement:
            case Chain():
                self.chain(statement, scope, env, at)
            case Junction():
                self.junction(statement, scope, env)
            case Param():
                self.value(_KEYWORDS[statement.keyword], statement, scope, env)
            case Input():
                self.value("input", statement, scope, env)
            case Let():
                self.value("let", statement, scope, env)
            case Sensor():
                self.value("sensor", statement, scope, env)
            case Port():
                self.port(statement, scope)
            case Fault():
                place = index(statement.name, scope, env, self.report)
                name = statement.name.name
                local = name if place is None else f"{name}[{place}]"
                self.events.append(Event(statement, local, scope, env))
            case For():
                self.loop(statement, scope, env, at)
            case If():
                holds = truth(statement.condition, scope, env, self.report)
                self.body(statement.body if holds else statement.otherwise, scope, env, at)
            case _:
                assert_never(statement)

    def loop(self, loop: For, scope: Scope, env: Env, at: NodeEntry | Ref | None) -> None:
        """`for`: the body once for each value of the variable."""
        first = whole_number(loop.first, scope, env, self.report)
        last = whole_number(loop.last, scope, env, self.report)
        self.size.unroll(max(0, last - first + 1) * weight(loop.body), scope, loop.origin)
        for i in range(first, last + 1):
            self.body(loop.body, scope, {**env, loop.variable: i}, at)

    def port(self, port: Port, scope: Scope) -> None:
        """A port of the model."""
        if port.domain not in DOMAINS:
            self.report.error(
                "unknown-domain", f"There is no domain `{port.domain}`.", port.origin,
                help=meant(port.domain, DOMAINS, f"The domains are {listed(DOMAINS)}.",
                           _last(port.origin, port.domain)),
            )  # fmt: skip
        entry = PortEntry(port, scope)
        self.enter(scope.nodes, port.name, None, entry, port.origin)
        scope.ports[port.name] = entry

    def junction(self, statement: Junction, scope: Scope, env: Env) -> None:
        """A junction with its bonds, declared here or opened again."""
        if not statement.type:
            self.body(statement.body, scope, env, statement.name)
            return
        parts = statement.name.parts
        for place in self.places(parts[0], scope, env, scope.nodes):
            entry = NodeEntry(statement.type, None, parts[0].name, place, scope, env,
                              statement.name.origin, statement.doc)  # fmt: skip
            if statement.when is not None:
                entry.when = Bound(statement.when, scope, env, statement.when.origin)
            before = self.again.junction(scope.nodes.get(entry.name), entry)
            if before is not None:
                self.body(statement.body, scope, env, before)
                continue
            self.enter(scope.nodes, parts[0].name, place, entry, entry.origin)
            scope.items.append(entry)
            self.refuse_givens(entry, self.matching(scope.givens, entry.name, place))
            self.body(statement.body, scope, env, entry)

    def chain(self, chain: Chain, scope: Scope, env: Env, at: NodeEntry | Ref | None) -> None:
        """Nodes and the bonds between them; a node with a type is declared."""
        items: list[tuple[NodeEntry | Scope, ...] | Ref | None] = []
        wrong = False
        doc = chain.doc
        for item in chain.nodes:
            if isinstance(item, Node):
                try:
                    before = self.again.node(item, scope, len(chain.nodes) == 1)
                    made = (before,) if before else self.node(item, scope, env, doc)
                    items.append(made)
                    doc = ""
                    if len(chain.nodes) == 1:
                        self.again.alone.update(made)
                except Skip:
                    wrong = scope.unlinked = True
                    scope.wrong.add(item.name.name)
            else:
                items.append(item)
        origins = tuple(chain.origin if n is None else n.origin for n in chain.nodes)
        if not wrong:
            link = Link(tuple(items), chain.arrows, env, at, chain.origin, origins)
            scope.links.append(link)

    def value(
        self, kind: ValueKind, statement: Param | Input | Let | Sensor, scope: Scope, env: Env
    ) -> None:
        """A param, const, input, let or sensor, or an array of them."""
        name = statement.name.name
        for generic in scope.model.generics:
            if generic.name == name:
                fail(self.report, "duplicate-name", f"The value `{name}` is declared twice.",
                     Label(statement.name.origin, "declared again"),
                     Label(generic.origin, "a structural argument"),
                     help="Give one of them another name.")  # fmt: skip
        for place in self.places(statement.name, scope, env, scope.values):
            entry = ValueEntry(kind, name, place, scope, env, statement, statement.name.origin)
            self.enter(scope.values, name, place, entry, entry.origin)
            scope.items.append(entry)
            if kind in ("param", "const", "input"):
                self.bind(entry, name, place)

    def bind(self, entry: ValueEntry, name: str, place: int | None) -> None:
        """Take the value that the instance was given, if any."""
        for given in self.matching(entry.scope.givens, name, place):
            if len(given.parts) == 1:
                given.root.used = True
                self.once(entry.given, given)
                entry.given = given.bound

    # ------------------------------------------------------------------ nodes

    def node(self, node: Node, scope: Scope, env: Env, doc: str) -> tuple[NodeEntry | Scope, ...]:
        """Declare `TYPE:name`: a junction, an element or an instance, or an array of them."""
        if node.type in JUNCTIONS or node.type in KINDS:
            return self.element(node, scope, env, doc)
        definition = scope.definition.known.get(node.type)
        if definition is None:
            names = (*KINDS, *scope.definition.known)
            help = meant(node.type, names, "Element kinds are R C I IC TF GY Se Sf De Df; a model "
                         "must be declared in this file or imported.", node.origin)  # fmt: skip
            kind = _KIND_OF.get(node.type.lower())
            if kind is not None and kind not in scope.definition.known:
                place = Span(node.origin.source, node.origin.start,
                             node.origin.start + len(node.type))  # fmt: skip
                help = replacing(place, kind, f"What is called so is `{kind}:{node.name.name}` in "
                                 f"a bond graph, and its value the {_VALUE_OF[kind]}.")
            fail(self.report, "unknown-type", f"There is no element kind or model `{node.type}`.",
                 node.origin, help=help)  # fmt: skip
        if isinstance(definition, Missing):
            raise Skip
        return self.instances(definition, node, scope, env)

    def element(self, node: Node, scope: Scope, env: Env, doc: str) -> tuple[NodeEntry, ...]:
        """A junction or element of the library."""
        made: list[NodeEntry] = []
        name = node.name.name
        kind = KINDS.get(node.type)
        own = self.arguments(node, scope, env)
        for place in self.places(node.name, scope, env, scope.nodes):
            entry = NodeEntry(node.type, kind, name, place, scope, env, node.origin, doc)
            entry.declaration = node
            self.enter(scope.nodes, name, place, entry, node.origin)
            scope.items.append(entry)
            made.append(entry)
            givens = own
            if scope.givens:
                givens = own + [
                    g.inner() for g in self.matching(scope.givens, name, place) if len(g.parts) > 1
                ]
            if kind is None or not kind.states:
                self.refuse_givens(entry, givens)
            else:
                entry.givens = givens
            if kind is not None and kind.kind in ("De", "Df"):
                value = ValueEntry("detector", name, place, scope, env, node, node.origin)
                value.node = entry
                self.enter(scope.values, name, place, value, node.origin)
                scope.items.append(value)
        if own and made:
            self.givens += [(g, made[0]) for g in own]
        return tuple(made)

    def instances(
        self, definition: Definition, node: Node, scope: Scope, env: Env
    ) -> tuple[Scope, ...]:
        """One instance of a model, or an array of them."""
        for what, extra in (("value", node.value), ("law", node.law)):
            if extra is not None:
                self.report.error(
                    "not-an-element", f"`{node.type}` is a model and takes no {what}.",
                    extra.origin, help=f"Bind its params: `{node.type}:{node.name.name}(param = "
                    "...)`.",
                )  # fmt: skip
        name = node.name.name
        own = self.arguments(node, scope, env)
        made: list[Scope] = []
        alike: list[Scope] = []
        deeper: list[Given] = []
        for place in self.places(node.name, scope, env, scope.nodes, definition):
            inner = Scope(definition, scope, name, place, node.origin)
            inner.givens = own
            inner.times = scope.times
            if scope.givens:
                deeper = [g for g in self.matching(scope.givens, name, place) if len(g.parts) > 1]
                inner.givens = own + [g.inner() for g in deeper]
            if not any(g.parts[0][1] is not None for g in deeper):
                alike.append(inner)
            self.enter(scope.nodes, name, place, inner, node.origin)
            self.structure(inner)
            scope.items.append(inner)
            made.append(inner)
        for inner in alike:
            inner.times = scope.times * len(alike) if inner is alike[0] else 0
        if made:
            self.givens += [(g, made[0]) for g in own]
        self.waiting += reversed(made)
        return tuple(made)

    def places(
        self, part: Part, scope: Scope, env: Env, table: dict[str, Named],
        definition: Definition | None = None,
    ) -> list[int | None]:  # fmt: skip
        """The indices that a declaration stands for; a `for` variable in it means one element.

        With a `definition` they are those of instances of it.
        """
        if part.first is None:
            if definition is not None:
                self.size.count(1 + weight(definition.model.body), scope, part.origin)
            return [None]
        if part.last is not None:
            low = whole_number(part.first, scope, env, self.report)
            high = whole_number(part.last, scope, env, self.report)
        else:
            high = whole_number(part.first, scope, env, self.report)
            one = mentions(part.first, env)
            low = high if one else 1
            before, nodes = table.get(part.name), table is scope.nodes
            if not one and self.again.another_size(part, nodes, before, high):
                return [high]  # as it was meant
            if high < 0 and low == 1:
                fail(self.report, "index-out-of-range", f"`{part.origin.text}` declares a negative "
                     "number of elements.", part.origin, help="Give a size from 0 up."
                     )  # fmt: skip
        size = max(0, high - low + 1)
        if definition is not None:
            self.size.count(size * (1 + weight(definition.model.body)), scope, part.origin)
        elif size > 1:
            self.size.unroll(size, scope, part.origin)
        if high < low:
            table.setdefault(part.name, Array(part.origin))
        return list(range(low, high + 1))

    def enter(
        self, table: dict[str, Named], name: str, place: int | None,
        entry: NodeEntry | Scope | PortEntry | ValueEntry, origin: Span,
    ) -> None:  # fmt: skip
        """Declare a name once."""
        before = table.get(name)
        if before is None and place is None:
            table[name] = entry
            return
        if place is not None and not isinstance(entry, PortEntry):
            if before is None:
                before = table[name] = Array(origin)
            if isinstance(before, Array):
                if place not in before.entries:
                    before.entries[place] = entry
                    return
                before = before.entries[place]
        assert before is not None
        local = name if place is None else f"{name}[{place}]"
        what = "value" if isinstance(entry, ValueEntry) else "node"
        help = "Give one of them another name."
        if origin == before.origin:
            help = "It stands in a loop: declare it before, or with the index of the loop."
        elif (
            isinstance(entry, NodeEntry) and isinstance(before, NodeEntry) and place is None
            and entry.type == before.type and entry.element is not None
        ):  # fmt: skip
            help = (f"Each has one bond: a second one has a name of its own, `{entry.type}:{name}2 "
                    f"= {name}` where both have one value.")  # fmt: skip
        fail(self.report, "duplicate-name", f"The {what} `{local}` is declared twice.",
             Label(origin, "declared again"), Label(before.origin, "declared here"),
             help=help)  # fmt: skip


class Size:
    """Counts the parts of a model and gives up, with an error, when they are too many."""

    def __init__(self, report: Report) -> None:
        self.report = report
        self.made = 0

    def count(self, number: int, scope: Scope, origin: Span) -> None:
        """Keep the size of the model within bounds; the first of an array counts for all."""
        self.made += number * scope.times
        if self.made > PARTS:
            self.report.error(
                "model-too-large", f"The model has more than {PARTS:,} parts.", origin,
                help="Check the sizes of arrays and `for` loops.",
            )  # fmt: skip
            raise Abort

    def unroll(self, number: int, scope: Scope, origin: Span) -> None:
        """Keep within bounds what loops and arrays of names make of one instance."""
        self.count(number, scope, origin)
        scope.unrolled += number
        if scope.unrolled > UNROLLED:
            self.report.error(
                "model-too-large", f"`{scope.model.name}` unrolls into more than "
                f"{UNROLLED:,} statements and names.", origin,
                help="Check the sizes of loops and arrays. Describe a part that repeats so often "
                "as a model, and use an array of it: `Cell:cell[n]`.",
            )  # fmt: skip
            raise Abort


def weight(body: tuple[Statement, ...]) -> int:
    """What a body costs each time it is unrolled: its statements, long ones several times."""
    return max(1, sum([1 + (s.origin.end - s.origin.start) // _USUAL for s in body]))
