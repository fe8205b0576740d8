"""Which models a file can name: its own, the imported ones; which of them is compiled."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Iterator

from bondgraph.ir.syntax import (
    Chain,
    File,
    For,
    If,
    Junction,
    Model,
    Node,
    Statement,
)
from bondgraph.library.elements import KINDS
from bondgraph.passes.elaboration.problems import Skip, fail, listed, meant
from bondgraph.text.diagnostic import Label, Report
from bondgraph.text.source import Source, Span

Load = Callable[[str, Span], File | None]


class Definition:
    """A model together with the names that hold in its file."""

    __slots__ = ("known", "model", "source")

    def __init__(self, model: Model, known: dict[str, Definition], source: Source) -> None:
        self.model = model
        self.known = known
        self.source = source


class Files:
    """Loads imports once each and refuses cycles of them."""

    def __init__(self, load: Load, report: Report) -> None:
        self.load = load
        self.report = report
        self.loaded: dict[str, dict[str, Definition]] = {}
        self.own: dict[str, set[str]] = {}
        self.loading: dict[str, Span | None] = {}  # with the import that is being followed

    def definitions(self, file: File, source: Source) -> dict[str, Definition]:
        """Every model that `file` declares or imports, by name."""
        known: dict[str, Definition] = {}
        self.loaded[_key(source)] = known
        self.loading[_key(source)] = None
        for model in file.models:
            self.declare(model, known, source)
        self.own[_key(source)] = set(known)
        for item in file.imports:
            try:
                self.import_from(item.path, item.names, item.origin, known)
            except Skip:
                # the names are taken as declared, or every use of them would be reported too
                for name in item.names:
                    known.setdefault(name, _missing(name, item.origin, source))
        del self.loading[_key(source)]
        return known

    def declare(self, model: Model, known: dict[str, Definition], source: Source) -> None:
        """Enter one model of the file."""
        if model.name in KINDS:
            self.report.error(
                "reserved-name", f"`{model.name}` is an element kind and cannot name a model.",
                model.name_origin, help="Give the model another name.",
            )  # fmt: skip
        elif model.name in known:
            first = known[model.name].model.name_origin
            self.report.error(
                "duplicate-name", f"There are two models `{model.name}`.",
                Label(model.name_origin, "declared again"), Label(first, "first declared here"),
                help="Rename one of them.",
            )  # fmt: skip
        else:
            known[model.name] = Definition(model, known, source)

    def import_from(
        self, path: str, names: tuple[str, ...], origin: Span, known: dict[str, Definition]
    ) -> None:
        """Enter the models that one `import` names."""
        before = len(self.report.diagnostics)
        file = self.load(path, origin)
        said = any(d.severity == "error" for d in self.report.diagnostics[before:])
        if file is None or said:
            raise Skip
        source = file.origin.source
        self.loading[_key(origin.source)] = origin
        if _key(source) in self.loading:
            files = list(self.loading)
            steps = [self.loading[f] for f in files[files.index(_key(source)) :]]
            fail(self.report, "import-cycle", "These imports go round in a circle.",
                 *[Label(s, "imports the next file") for s in steps if s is not None],
                 help="Move what both files need into a third one.")  # fmt: skip
        theirs = self.loaded.get(_key(source))
        if theirs is None:
            theirs = self.definitions(file, source)
        own = self.own[_key(source)]
        for name in names:
            if name not in own:
                help = meant(name, own, f"It declares {listed(sorted(own)) or 'no model'}.", origin)
                self.report.error(
                    "unknown-model", f'"{path}" declares no model `{name}`.', origin, help=help
                )
                known.setdefault(name, _missing(name, origin, source))
            elif name in known:
                self.report.error(
                    "duplicate-name", f"`{name}` is imported, but the name is taken.",
                    Label(origin, "imported here"),
                    Label(known[name].model.name_origin, "declared here"),
                    help="Rename the one of this file.",
                )  # fmt: skip
            else:
                known[name] = theirs[name]


def _key(source: Source) -> str:
    """One name for one file, however the path to it is written."""
    return os.path.realpath(source.path)


#: Stands for a model whose import failed: using it is no second error.
class Missing(Definition):
    """A model that could not be imported."""

    __slots__ = ()


def _missing(name: str, origin: Span, source: Source) -> Missing:
    return Missing(Model(name, (), (), "", origin, origin), {}, source)


def statements_of(body: tuple[Statement, ...]) -> Iterator[Statement]:
    """Every statement of a body, those in `for`, `if` and junctions behind each of these."""
    stack = [iter(body)]
    while stack:
        statement = next(stack[-1], None)
        if statement is None:
            stack.pop()
            continue
        yield statement
        if isinstance(statement, (For, Junction)):
            stack.append(iter(statement.body))
        elif isinstance(statement, If):
            stack.append(iter(statement.body + statement.otherwise))


def nodes_of(body: tuple[Statement, ...]) -> Iterator[Node]:
    """Every node declared in a body, also inside `for`, `if` and junctions."""
    for statement in statements_of(body):
        if isinstance(statement, Chain):
            for item in statement.nodes:
                if isinstance(item, Node):
                    yield item


def pick(
    file: File, known: dict[str, Definition], name: str | None, report: Report, source: Source
) -> Definition:
    """The model to compile: the one named, else the one that no other in the file uses."""
    own = [known[m.name] for m in file.models if m.name in known and known[m.name].model is m]
    if name is not None:
        if name not in known:
            names = [d.model.name for d in own]
            fail(report, "unknown-model", f"The file has no model `{name}`.", _edition(source),
                 help=meant(name, names, f"It declares {listed(names) or 'none'}.",
                        _edition(source)))  # fmt: skip
        return known[name]
    if not own and report.failed:
        raise Skip
    if not own:
        fail(report, "no-model", "The file declares no model.", _edition(source),
             help="Write `model Name { ... }` after the line `bg 1`.")  # fmt: skip
    tops = unused([d.model for d in own])
    free = [d for d in own if d.model.name in tops]
    if not free:
        for definition in own:  # all are used by another: somewhere that is a cycle
            recursion(definition, report)
        raise Skip
    if len(free) > 1 and report.failed:
        raise Skip  # an import failed: what it uses is not known
    if len(free) > 1:
        fail(report, "several-models", f"No other model uses {listed(d.model.name for d in free)}: "
             "which one is meant?", *[d.model.name_origin for d in free[:4]],
             help=f"Name it after the file: `{source.path}:{free[-1].model.name}`.")  # fmt: skip
    return free[0]


def unused(models: Iterable[Model]) -> list[str]:
    """The names of the models that no other one of them uses."""
    models = list(models)
    used = {n.type for m in models for n in nodes_of(m.body) if n.type != m.name}
    return list(dict.fromkeys([m.name for m in models if m.name not in used]))


def _edition(source: Source) -> Span:
    """The line `bg 1`, below which models belong."""
    start = 0
    for line in source.text.splitlines(keepends=True):
        if line.lstrip("\ufeff ").startswith("bg"):
            return Span(source, start, start + len(line.rstrip()))
        start += len(line)
    return Span(source, 0, 0)


def recursion(top: Definition, report: Report) -> None:
    """Report a model that contains itself; raises Skip if there is one."""
    state: dict[int, bool] = {}  # id of a definition: open or done
    path: list[tuple[Definition, Iterator[Node]]] = []
    entered: list[Node] = []  # how each definition of the path but the first was reached

    def enter(definition: Definition) -> None:
        state[id(definition)] = True
        path.append((definition, nodes_of(definition.model.body)))

    enter(top)
    while path:
        definition, uses = path[-1]
        del entered[len(path) - 1 :]
        node = next(uses, None)
        if node is None:
            state[id(definition)] = False
            path.pop()
            continue
        inner = definition.known.get(node.type)
        if inner is None or node.type in KINDS:
            continue
        if id(inner) not in state:
            entered.append(node)
            enter(inner)
        elif state[id(inner)]:
            first = [id(d) for d, _ in path].index(id(inner))
            names = [*[d.model.name for d, _ in path[first:]], inner.model.name]
            steps = [*entered[first:], node]
            fail(report, "recursive-model", "A model cannot contain itself: "
                 f"{' contains '.join(names)}.",
                 *[Label(n.origin, f"contains `{n.type}`") for n in steps[:4]],
                 help="Use an array, `Cell:cell[n]`, for something that repeats.")  # fmt: skip
