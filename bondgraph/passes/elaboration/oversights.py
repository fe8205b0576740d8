"""Say what a model is silent about: parts that nothing joins, values that nothing uses."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from itertools import chain

from bondgraph.frontend.lexer import split
from bondgraph.ir.expr import CONSTANTS, ZERO_START, Expr, Kind, Op, Pool, symbols, topological
from bondgraph.ir.graph import BondGraph, Node, Sensor
from bondgraph.ir.groups import Groups
from bondgraph.ir.syntax import For, If, Input, Model, Param, Part
from bondgraph.passes.elaboration.problems import listed
from bondgraph.passes.elaboration.scope import NodeEntry, ValueEntry
from bondgraph.text.diagnostic import Edit, Label, Remedy, Report, removing
from bondgraph.text.source import Span

_SHOWN = 4  # places of one finding
_HEADER = 2000  # letters of a model up to its brace
_NAMED = 24  # elements of one note that are named, the others counted

# ------------------------------------------------------------------------------- values


def report_unused(entries: Iterable[ValueEntry], used: set[ValueEntry], report: Report) -> None:
    """Declared params, consts and inputs that no instance of their model uses, nor could."""
    unused: dict[Span, ValueEntry] = {}
    somewhere: set[Span] = set()
    for entry in entries:
        if isinstance(entry.declaration, (Param, Input)):
            if entry in used:
                somewhere.add(entry.origin)
            else:
                unused.setdefault(entry.origin, entry)
    optional: dict[Span, set[str]] = {}
    for origin, entry in unused.items():
        model = entry.scope.model
        if origin in somewhere:
            continue
        if model.origin not in optional:
            optional[model.origin] = _optional(model)
        if entry.declaration.name.name in optional[model.origin]:
            continue
        what, example = _use(entry)
        report.warning(
            "value-not-used",
            f"Nothing uses the {what} `{entry.local}`: it does not matter what it is.",
            origin,
            help=Remedy(
                f"Use it where it belongs, as in {example} or in a law, or leave it out.",
                removing(_line(entry.declaration.origin), "").edits,
            ),
        )


def _line(statement: Span) -> Span:
    """A statement with its line, where nothing else stands in it."""
    source, start, end = statement
    begin = source.text.rfind("\n", 0, start)
    alone = begin >= 0 and not source.text[begin:start].strip()
    return Span(source, begin, end) if alone and source.text[end : end + 1] == "\n" else statement


def _optional(model: Model) -> set[str]:
    """All names in what a model builds for some arguments only: in the bodies of `if` and `for`."""
    found: set[str] = set()
    stack: list[tuple[object, bool]] = [(model.body, False)]
    while stack:
        item, inside = stack.pop()
        if isinstance(item, Part) and inside:
            found.add(item.name)
        if isinstance(item, tuple):
            inside = inside or isinstance(item, (If, For))
            stack += [(part, inside) for part in item]
    return found


def _use(entry: ValueEntry) -> tuple[str, str]:
    """What a value is, and a use of it."""
    declaration = entry.declaration
    if isinstance(declaration, Param):
        return declaration.keyword, f"`R:{declaration.name.name}`"
    assert isinstance(declaration, Input)
    name = declaration.name.name
    return "input", f"`when {name}`" if declaration.boolean else f"`Se:{name}`"


def report_nameless(nodes: Iterable[NodeEntry], report: Report) -> None:
    """Elements whose coefficient is a plain number, once for all."""
    first: dict[Span, NodeEntry] = {}
    for node in nodes:
        first.setdefault(node.origin, node)
    if not first:
        return
    names = [node.path for node in first.values()]
    many = len(names) > 1
    example = next(iter(first.values()))
    assert example.declaration is not None and example.declaration.value is not None
    number = example.declaration.value.origin.text
    report.info(
        "value-without-name",
        f"{listed(names, _NAMED)} {'have' if many else 'has'} a number for a value: "
        f"{'they are' if many else 'it is'} no fault {'candidates' if many else 'candidate'}.",
        *[Label(origin, "a number") for origin in list(first)[:_SHOWN]],
        help=Remedy(
            f"What may fail is a param: `param {example.name} = {number}` and "
            f"`{example.type}:{example.name}`. What cannot is a const.",
            tuple([edit for n in list(first.values())[:_SHOWN] for edit in _named(n)]),
        ),
    )


def _named(node: NodeEntry) -> list[Edit]:
    """The value of an element as a param of its model that is called like it."""
    written, model = node.declaration, node.scope.model
    if written is None or written.value is None or node.place is not None:
        return []
    source, start, _ = model.origin
    header = split(source.text[start : start + _HEADER])
    if node.name in node.scope.values or "{" not in header.words:
        return []
    value = Span(source, written.name.origin.end, (written.tolerance or written.value).origin.end)
    if written.arguments or source is not value.source:
        return []
    text = value.text.lstrip(" =")
    opened = start + header.starts[header.words.index("{")] + 1
    behind = "" if source.text[opened : opened + 1] == "\n" else "\n"
    declared = f"\n    param {node.name} = {text}{behind}"
    changes = ((Span(source, opened, opened), declared), (value, ""))
    return [Edit(f"declare `param {node.name} = {text}`", changes)]


# ------------------------------------------------------------------------------- parts


def report_parts(graph: BondGraph, report: Report) -> None:
    """Parts of a machine that nothing joins with the rest, unless they are machines themselves.

    A part that is measured and driven is a machine of its own, and two of them in one model are
    as good as one. Nothing can be said of a part without a sensor; one that nothing drives rests
    for ever, or moves only by what its storages hold at the start. Linear in the size of the model.
    """
    parts = _parts(graph)
    measured = _measured(graph, parts)
    rest = _Rest(graph)
    driven = [_is_driven(graph, part, rest) for part in parts]
    seen: set[tuple[Span, ...]] = set()
    for part, sensors, moving in zip(parts, measured, driven, strict=True):
        places = tuple([graph.nodes[i].origin for i in part])
        if places in seen:
            continue  # the same part of another instance of a model
        seen.add(places)
        outside = any(graph.nodes[i].keyword == "port" for i in part)  # the world may measure it
        if sensors and not moving:
            _undriven(graph, part, sensors, any(driven), report)
        elif not sensors and any(measured) and not outside:
            _unmeasured(graph, part, report)


def _unmeasured(graph: BondGraph, part: list[int], report: Report) -> None:
    report.warning(
        "part-not-measured",
        f"No bond and no signal joins {_names(graph, part)} with the rest of the model, and no "
        "sensor reads anything there: no fault of this part can be detected.",
        Label(graph.nodes[part[0]].origin, "stands apart with what it is bonded to"),
        help="Add the bond that is missing, or measure something there. A part that is not of "
        "interest can be left out.",
    )


def _undriven(
    graph: BondGraph, part: list[int], sensors: list[Sensor], others: bool, report: Report
) -> None:
    """A part in which rest is a solution of all laws: it needs a push from the start to move."""
    whole = len(part) == len(graph.nodes)
    begin = "Nothing drives this model" if whole else f"Nothing drives {_names(graph, part)}"
    what = "it" if whole else "this part"
    read = listed([s.name for s in sensors])
    labels = [
        Label(graph.nodes[part[0]].origin, "the model" if whole else "nothing drives this part"),
        *[Label(s.origin, "measured here") for s in sensors[:_SHOWN]],
    ]
    missing = "Add the source that moves it, as in `Se:F -> ...`"
    if others:
        begin += ", which no bond and no signal joins with the rest"
        missing = "Add the bond that is missing, or the source that moves it, as in `Se:F -> ...`"
    if not _may_start(graph, part):
        report.warning(
            "part-not-driven",
            f"{begin}: {what} rests for ever, and what {read} should read is always the same.",
            *labels,
            help=f"{missing}, or a storage with a value to start from, `C:C(q0 = 1)`.",
        )
        return
    say = report.warning if others else report.info
    say(
        "part-not-driven",
        f"{begin}: {what} moves by nothing but what its storages hold at the start, and while "
        f"it rests {read} can show no fault of it.",
        *labels,
        help=f"{missing}. Nothing is wrong if it is to swing or to run down by itself.",
    )


def _names(graph: BondGraph, part: list[int]) -> str:
    return listed([f"{graph.nodes[i].keyword}:{graph.nodes[i].path}" for i in part], 5)


class _Signals:
    """What the symbols of a graph belong to, and what is behind those that stand for others."""

    def __init__(self, graph: BondGraph) -> None:
        self.owner = {s: i for i, node in enumerate(graph.nodes) for s in _own(node)}
        self.behind = {i.symbol: i.integrand for i in graph.integrals}
        self.behind |= {s.symbol: s.reads for s in graph.sensors}
        self._read = {s.name: s.reads for s in graph.sensors}

    def of(self, *roots: Expr) -> list[Expr]:
        """The signals that expressions depend on, through sensors and integrals too."""
        found: dict[Expr, None] = {}
        while roots:
            fresh = [s for s in symbols(*roots) if s not in found]
            found.update(dict.fromkeys(fresh))
            received = [self._read[s.symbol.name] for s in fresh if s.symbol.kind is Kind.READING]
            roots = (*received, *[self.behind[s] for s in fresh if s in self.behind])
        return [s for s in found if s.symbol.kind not in CONSTANTS]


def _own(node: Node) -> list[Expr]:
    """The variables of a node."""
    found = [v for p in node.ports for v in (p.effort, p.flow, p.state) if v is not None]
    return found if node.common is None else [*found, node.common]


def _parts(graph: BondGraph) -> list[list[int]]:
    """The nodes in groups that no bond and no signal joins; all that is outside is one."""
    joined, every = Groups[int](), range(len(graph.nodes))
    for bond in graph.bonds:
        joined.join(bond.tail.node, bond.head.node)
    outside = [i for i, node in enumerate(graph.nodes) if node.keyword == "port"]
    for node in outside:
        joined.join(outside[0], node)
    groups = joined.among(every)
    if len(groups) == 1:
        return groups
    signals = _Signals(graph)
    owner = dict(signals.owner)
    for i, element in enumerate(graph.nodes):
        read = [law.zero for law in element.laws]
        for symbol in signals.of(*read, *([] if element.when is None else [element.when])):
            joined.join(i, owner.setdefault(symbol, i))
    for sensor in graph.sensors:
        met = [owner[s] for s in signals.of(sensor.reads) if s in owner]
        for other in met:
            joined.join(met[0], other)
    return joined.among(every)


def _measured(graph: BondGraph, parts: list[list[int]]) -> list[list[Sensor]]:
    """The sensors that read each part."""
    if len(parts) == 1:
        return [list(graph.sensors)]
    signals = _Signals(graph)
    part_of = {node: i for i, part in enumerate(parts) for node in part}
    found: list[list[Sensor]] = [[] for _ in parts]
    for sensor in graph.sensors:
        owners = [signals.owner[s] for s in signals.of(sensor.reads) if s in signals.owner]
        for owner in owners[:1]:  # all are of one part
            found[part_of[owner]].append(sensor)
    return found


def _is_driven(graph: BondGraph, part: list[int], rest: _Rest) -> bool:
    """Whether rest is no solution: an input or a number in a law keeps something in motion."""
    nodes = [graph.nodes[i] for i in part]
    if any(node.keyword == "port" for node in nodes):
        return True  # the world may drive it
    sources = [node for node in nodes if node.kind in ("Se", "Sf")]
    return any(
        rest.of(law.zero) is not rest.pool.zero
        for node in chain(sources, nodes)  # mostly a source settles it
        for law in node.laws
    )


#: Signals that a part itself makes: those of other parts are not in its laws.
_RESTING = frozenset(
    {Kind.EFFORT, Kind.FLOW, Kind.STATE, Kind.INTEGRAL, Kind.SENSOR, Kind.READING}
)


class _Rest:
    """What expressions are at rest: zero for all signals but inputs, and for what is declared zero.

    A reading is what its sensor makes of the signals. An integral of what does not vanish leaves
    its start whatever that is, so it stands for itself, as an input does.
    """

    def __init__(self, graph: BondGraph) -> None:
        self.pool = Pool()  # what is worked out here leaves no trace in the order of the graph's
        self._nothing = {v.symbol for v in graph.values if v.value is graph.pool.zero}
        integrals = {i.symbol: i.integrand for i in graph.integrals}
        behind = {r: sensor.reads for r, sensor in graph.readings.items()} | integrals
        self._known: dict[Expr, Expr | None] = {}
        order, start = _innermost_first(behind), self.pool.symbol(ZERO_START, Kind.INITIAL)
        for symbol in order * 2:  # in a loop, the first only now has what the last one is
            value = self.of(behind[symbol])
            if symbol in integrals and value is not None and value is not self.pool.zero:
                value = self.pool.integral(value, start)
            self._known[symbol] = value

    def of(self, expr: Expr) -> Expr | None:
        """The expression at rest; None where it has no value there."""
        new: dict[Expr, Expr] = {}
        try:
            for node in topological([expr]):
                if node.op is Op.SYM:
                    value = self._symbol(node)
                    if value is None:
                        return None
                    new[node] = value
                elif node.op is Op.NUM:
                    new[node] = self.pool.num(node.number)
                else:
                    new[node] = self.pool.rebuild(node, tuple([new[a] for a in node.args]))
        except ZeroDivisionError:
            return None
        return new[expr]

    def _symbol(self, node: Expr) -> Expr | None:
        if node in self._known:
            return self._known[node]
        rests = node.symbol.kind in _RESTING or node in self._nothing
        return self.pool.zero if rests else self.pool.symbol(*node.symbol)


def _innermost_first(behind: Mapping[Expr, Expr]) -> list[Expr]:
    """The symbols, each after those that what is behind it is made of, but for loops."""
    found: dict[Expr, None] = {}
    met: set[Expr] = set()
    stack = [(symbol, False) for symbol in behind]
    while stack:
        symbol, finished = stack.pop()
        if finished:
            found[symbol] = None
        elif symbol not in met:
            met.add(symbol)
            stack.append((symbol, True))
            stack += [(s, False) for s in symbols(behind[symbol]) if s in behind]
    return list(found)


def _may_start(graph: BondGraph, part: list[int]) -> bool:
    """Whether anything holds a value at the start, or holds one that nobody declared."""
    starts = [
        port.initial_value for i in part for port in graph.nodes[i].ports if port.state is not None
    ]
    used = set(symbols(*[law.zero for i in part for law in graph.nodes[i].laws]))
    starts += [i.initial_value for i in graph.integrals if i.symbol in used]
    return any(start is not graph.pool.zero for start in starts)
