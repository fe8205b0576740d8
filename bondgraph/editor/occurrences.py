"""What every name of a file means: its declarations, and each place at which one is used."""

from __future__ import annotations

import os
import re
from collections.abc import Callable, Iterator
from typing import Literal, TypeAlias

from bondgraph.frontend.lexer import split
from bondgraph.ir import syntax
from bondgraph.library.elements import KINDS, SIGNALS
from bondgraph.passes.elaboration.files import statements_of
from bondgraph.text.source import Source, Span
from bondgraph.text.tuples import NamedTuple

Space = Literal["model", "node", "value", "argument", "loop", "fault"]

#: What a declaration can be, beside the keywords of elements and the types of junctions.
Kind: TypeAlias = str


class Symbol(NamedTuple):
    """Something that has a name: in the model of a file, or at a `for` of it."""

    path: str
    model: str
    space: Space
    name: str


class Declaration(NamedTuple):
    """Where a symbol is declared.

    `kind` is model, port, instance, param, const, input, let, sensor, argument, loop, fault, or
    the type of a junction or element. `anchor` is where the flat graph says that it is from.
    """

    symbol: Symbol
    kind: Kind
    span: Span
    anchor: int
    statement: syntax.Statement | syntax.Node | syntax.Model | syntax.Generic
    doc: str = ""
    #: of an instance, the name of its model
    type: str = ""


class Occurrence(NamedTuple):
    """A name in the text, and what it means; `kind` as of a declaration, or `signal`."""

    span: Span
    symbol: Symbol | None
    kind: Kind
    declares: bool = False


class ModelNames:
    """The names of one model: two namespaces, and its structural arguments among the values."""

    def __init__(self, path: str, model: syntax.Model) -> None:
        self.model = model
        self.nodes: dict[str, Declaration] = {}
        self.values: dict[str, Declaration] = {}
        self.faults: dict[str, Declaration] = {}
        self.path = path
        symbol = Symbol(path, "", "model", model.name)
        own = model.name_origin
        self.declaration = Declaration(symbol, "model", own, own.start, model, model.doc)
        for generic in model.generics:
            self._declare(self.values, "argument", generic.name, "argument", generic, "",
                          Span(own.source, generic.origin.start,
                               generic.origin.start + len(generic.name)))  # fmt: skip
        for statement in statements_of(model.body):
            self._statement(statement)
        self._tie()

    def _declare(
        self, table: dict[str, Declaration], space: Space, name: str, kind: Kind,
        statement: syntax.Statement | syntax.Node | syntax.Generic, doc: str, span: Span,
        anchor: int | None = None, type: str = "",
    ) -> None:  # fmt: skip
        symbol = Symbol(self.path, self.model.name, space, name)
        found = Declaration(symbol, kind, span, span.start if anchor is None else anchor,
                            statement, doc, type)  # fmt: skip
        table.setdefault(name, found)

    def _statement(self, statement: syntax.Statement) -> None:
        match statement:
            case syntax.Param():
                name = statement.name
                self._declare(self.values, "value", name.name, statement.keyword, statement,
                              statement.doc, _own(name))  # fmt: skip
            case syntax.Input() | syntax.Let() | syntax.Sensor():
                kind = type(statement).__name__.lower()
                self._declare(self.values, "value", statement.name.name, kind, statement,
                              statement.doc, _own(statement.name))  # fmt: skip
            case syntax.Fault():
                self._declare(self.faults, "fault", statement.name.name, "fault", statement,
                              statement.doc, _own(statement.name))  # fmt: skip
            case syntax.Port():
                span = _after_keyword(statement.origin, "port", statement.name)
                self._declare(self.nodes, "node", statement.name, "port", statement,
                              statement.doc, span, statement.origin.start)  # fmt: skip
            case syntax.Junction() if statement.type:
                part = statement.name.parts[0]
                self._declare(self.nodes, "node", part.name, statement.type, statement,
                              statement.doc, _own(part), statement.name.origin.start)  # fmt: skip
            case syntax.Chain():
                doc = statement.doc
                for node in statement.nodes:
                    if isinstance(node, syntax.Node):
                        self._node(node, doc)
                        doc = ""
            case _:
                pass

    def _node(self, node: syntax.Node, doc: str) -> None:
        name, span = node.name.name, _own(node.name)
        plain = node.type in KINDS or node.type in ("0", "1")
        self._declare(self.nodes, "node", name, node.type if plain else "instance", node, doc,
                      span, node.origin.start, "" if plain else node.type)  # fmt: skip

    def _tie(self) -> None:
        """An element that takes the value of its own name is one symbol with it."""
        for name, node in self.nodes.items():
            written = node.statement
            if not isinstance(written, syntax.Node) or node.kind not in KINDS:
                continue
            kind = KINDS[node.kind]
            if kind.kind in ("De", "Df"):
                self.values.setdefault(name, node._replace(kind="sensor"))
            elif written.value is None and written.law is None and kind.coefficient:
                value = self.values.get(name)
                if value is not None:
                    self.nodes[name] = node._replace(symbol=value.symbol)
                elif kind.kind in ("Se", "Sf"):
                    self.values[name] = node._replace(kind="input")


def _own(part: syntax.Part) -> Span:
    """The name of a part, without its index."""
    return Span(part.origin.source, part.origin.start, part.origin.start + len(part.name))


_GAP = re.compile(r"(?:\s|#[^\n]*)*")


def _after_keyword(origin: Span, keyword: str, name: str) -> Span:
    """The name that follows the first word of a statement, with comments between them or not."""
    gap = _GAP.match(origin.source.text, origin.start + len(keyword))
    start = gap.end() if gap else origin.start
    return Span(origin.source, start, start + len(name))


#: The names of the file at a real path, or None.
Imported = Callable[[str], "FileNames | None"]


class FileNames:
    """The names of one file; those of imported files are found when they are needed.

    `path` is the real path of the file, `imports` says from which file each imported model is.
    """

    def __init__(
        self, file: syntax.File | None, source: Source, path: str, imported: Imported
    ) -> None:
        whole = Span(source, 0, len(source.text))
        self.file = file or syntax.File(1, (), (), "", whole)
        self.path = path
        self.source = source
        self.models: dict[str, ModelNames] = {}
        for model in self.file.models:
            self.models.setdefault(model.name, ModelNames(path, model))
        folder = os.path.dirname(path)
        self.imports = {
            name: os.path.realpath(os.path.join(folder, item.path))
            for item in self.file.imports
            for name in item.names
        }
        self._imported = imported
        self._occurrences: tuple[Occurrence, ...] | None = None

    def model(self, name: str) -> ModelNames | None:
        """The model of that name, declared here or imported."""
        found = self.models.get(name)
        if found is None and name in self.imports:
            other = self._imported(self.imports[name])
            return None if other is None else other.models.get(name)
        return found

    def opened(self, declared: Declaration) -> ModelNames | None:
        """The model of an instance, as the file that declares it knows it."""
        if declared.kind != "instance":
            return None
        here = self.owner(declared.symbol.path)
        return None if here is None else here.model(declared.type)

    def owner(self, path: str) -> FileNames | None:
        """The names of the file at a path, if this one has something to do with it."""
        return self if path == self.path else self._imported(path)

    @property
    def known_models(self) -> tuple[str, ...]:
        """The names of all models that can be used here."""
        return tuple(dict.fromkeys([*self.models, *self.imports]))

    @property
    def occurrences(self) -> tuple[Occurrence, ...]:
        """Every name that has a meaning, in the order of the text."""
        if self._occurrences is None:
            found: list[Occurrence] = []
            for item in self.file.imports:
                found += self._import(item)
            for model in self.file.models:
                names = self._names(model)
                found.append(
                    Occurrence(names.declaration.span, names.declaration.symbol, "model", True)
                )
                found += _Reader(self, names).read()
            found.sort(key=lambda o: o.span.start)
            self._occurrences = tuple(found)
        return self._occurrences

    def _import(self, item: syntax.Import) -> Iterator[Occurrence]:
        words, starts, *_ = split(item.origin.text)
        for word, start in zip(words, starts, strict=True):
            if word in item.names:
                at = item.origin.start + start
                names = self.model(word)
                if names is not None:
                    span = Span(self.source, at, at + len(word))
                    yield Occurrence(span, names.declaration.symbol, "model")

    def at(self, offset: int) -> Occurrence | None:
        """The name at or just before a place in the text."""
        for found in self.occurrences:
            if found.span.start <= offset <= found.span.end:
                return found
            if found.span.start > offset:
                return None
        return None

    def enclosing(self, offset: int) -> ModelNames | None:
        """The model in whose text a place is."""
        for model in self.file.models:
            if model.origin.start <= offset <= model.origin.end:
                return self._names(model)
        return None

    def _names(self, model: syntax.Model) -> ModelNames:
        """Those of one model, also where two have one name."""
        found = self.models[model.name]
        return found if found.model is model else ModelNames(self.path, model)

    def declaration(self, symbol: Symbol) -> Declaration | None:
        """Where a symbol of this file is declared; None for one of another file, or of a `for`."""
        if symbol.path != self.path:
            return None
        if symbol.space == "model":
            own = self.models.get(symbol.name)
            return None if own is None else own.declaration
        names = self.models.get(symbol.model)
        if names is None:
            return None
        table = {"node": names.nodes, "fault": names.faults}.get(symbol.space, names.values)
        return table.get(symbol.name)


class _Reader:
    """Walks through one model and notes what its names mean."""

    def __init__(self, file: FileNames, names: ModelNames) -> None:
        self.file = file
        self.names = names
        self.found: list[Occurrence] = []
        self.loops: dict[str, Symbol] = {}
        self.law: frozenset[str] = frozenset()

    def read(self) -> list[Occurrence]:
        for generic in self.names.model.generics:
            declared = self.names.values[generic.name]
            self.note(declared.span, declared, True)
            if generic.default is not None:
                self.expression(generic.default)
        self.body(self.names.model.body)
        return self.found

    # ------------------------------------------------------------- statements

    def note(self, span: Span, declared: Declaration | None, declares: bool = False) -> None:
        if declared is not None:
            self.found.append(Occurrence(span, declared.symbol, declared.kind, declares))

    def declared(self, table: dict[str, Declaration], part: syntax.Part) -> None:
        self.note(_own(part), table.get(part.name), True)
        self.index(part)

    def body(self, body: tuple[syntax.Statement, ...]) -> None:
        for statement in body:
            self.statement(statement)

    def statement(self, statement: syntax.Statement) -> None:
        values = self.names.values
        match statement:
            case syntax.Chain():
                for node in statement.nodes:
                    if isinstance(node, syntax.Node):
                        self.node(node)
                    elif node is not None:
                        self.node_ref(node)
            case syntax.Junction():
                self.junction(statement)
            case syntax.Port():
                declared = self.names.nodes.get(statement.name)
                if declared is not None:
                    self.note(declared.span, declared, True)
            case syntax.Param():
                self.declared(values, statement.name)
                self.maybe(statement.value)
            case syntax.Input():
                self.declared(values, statement.name)
            case syntax.Let():
                self.declared(values, statement.name)
                self.expression(statement.value)
            case syntax.Sensor():
                self.declared(values, statement.name)
                self.expression(statement.value)
                self.maybe(statement.counts)
            case syntax.Fault():
                self.declared(self.names.faults, statement.name)
                self.ref(statement.target)
                self.expression(statement.value)
            case syntax.For():
                self.loop(statement)
            case syntax.If():
                self.expression(statement.condition)
                self.body(statement.body)
                self.body(statement.otherwise)

    def junction(self, statement: syntax.Junction) -> None:
        if statement.type:
            self.declared(self.names.nodes, statement.name.parts[0])
        else:
            self.node_ref(statement.name)
        self.maybe(statement.when)
        self.body(statement.body)

    def loop(self, loop: syntax.For) -> None:
        self.expression(loop.first)
        self.expression(loop.last)
        inside = f"{self.names.model.name}@{loop.origin.start}"
        symbol = Symbol(self.file.path, inside, "loop", loop.variable)
        span = _after_keyword(loop.origin, "for", loop.variable)
        self.found.append(Occurrence(span, symbol, "loop", True))
        before = self.loops
        self.loops = {**before, loop.variable: symbol}
        self.body(loop.body)
        self.loops = before

    def node(self, node: syntax.Node) -> None:
        plain = node.type in KINDS or node.type in ("0", "1")
        inner = None if plain else self.file.model(node.type)
        start = node.origin.start
        if inner is not None:
            span = Span(node.origin.source, start, start + len(node.type))
            self.note(span, inner.declaration)
        self.declared(self.names.nodes, node.name)
        for argument in node.arguments:
            if inner is not None:
                self.path(argument.target.parts, inner, value=True)
            elif argument.target.parts:
                self.signal(argument.target.parts[-1])
            self.expression(argument.value)
        self.maybe(node.value)
        if node.law is not None:
            self.equations(node, node.law)

    def equations(self, node: syntax.Node, law: syntax.Law) -> None:
        before = self.law
        variables = KINDS[node.type].variables if node.type in KINDS else ()
        self.law = frozenset([p.name for p in law.ports] or variables)
        for equation in law.equations:
            self.expression(equation.left)
            self.expression(equation.right)
        self.law = before

    # ------------------------------------------------------------ expressions

    def maybe(self, expression: syntax.Expression | None) -> None:
        if expression is not None:
            self.expression(expression)

    def expression(self, expression: syntax.Expression) -> None:
        stack = [expression]
        while stack:
            here = stack.pop()
            match here:
                case syntax.Ref():
                    self.ref(here)
                case syntax.Unary():
                    stack.append(here.operand)
                case syntax.Binary():
                    stack += [here.left, here.right]
                case syntax.Call():
                    stack += here.arguments
                case _:
                    pass

    def index(self, part: syntax.Part) -> None:
        self.maybe(part.first)
        self.maybe(part.last)

    def ref(self, ref: syntax.Ref) -> None:
        """A name in an expression: a variable of the law, of a loop, or a value."""
        first = ref.parts[0]
        if first.name in self.law:
            self.signal(ref.parts[-1])
        elif len(ref.parts) == 1 and first.name in self.loops:
            symbol = self.loops[first.name]
            self.found.append(Occurrence(_own(first), symbol, "loop"))
        else:
            self.path(ref.parts, self.names, value=True)

    def node_ref(self, ref: syntax.Ref) -> None:
        self.path(ref.parts, self.names, value=False)

    def signal(self, part: syntax.Part) -> None:
        if part.name in SIGNALS or part.name in ("q0", "p0"):
            self.found.append(Occurrence(_own(part), None, "signal"))

    def path(self, parts: tuple[syntax.Part, ...], inside: ModelNames, value: bool) -> None:
        """A dotted name; its last part is a value of the submodel reached, if `value` says so."""
        names: ModelNames | None = inside
        for number, part in enumerate(parts):
            self.index(part)
            last = number == len(parts) - 1
            declared = None
            if names is not None:
                declared = names.nodes.get(part.name)
                if value and (last or declared is None):
                    declared = names.values.get(part.name)
            if declared is None:
                self.signal(part)
                return
            self.note(_own(part), declared)
            names = self.file.opened(declared)
