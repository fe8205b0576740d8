"""The stages up to the signatures as text: what `dump` prints and what tests compare."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from fractions import Fraction

from bondgraph.ir.causal import CausalGraph, Reason
from bondgraph.ir.equation_system import Equation, EquationSystem
from bondgraph.ir.expr import Expr
from bondgraph.ir.graph import Bond, BondGraph, Input, Node, Sensor, Value
from bondgraph.ir.past import past_name
from bondgraph.ir.residuals import Residual, ResidualSet, Step
from bondgraph.ir.signature_matrix import SignatureMatrix
from bondgraph.ir.syntax import File
from bondgraph.notation.line import number, show
from bondgraph.text.source import Source, Span


def table(rows: Iterable[Sequence[str]], indent: str = "  ") -> list[str]:
    """Rows with their columns aligned to the left, without blanks at the ends.

    >>> table([("a", "bc", "d"), ("abc", "d", "e")])
    ['  a    bc  d', '  abc  d   e']
    """
    cells = [tuple(row) for row in rows]
    columns = max(map(len, cells), default=0)
    widths = [
        max((len(row[c]) for row in cells if c < len(row) - 1), default=0) for c in range(columns)
    ]
    lines = []
    for row in cells:
        texts = [text.ljust(widths[c]) for c, text in enumerate(row)]
        lines.append((indent + "  ".join(texts)).rstrip())
    return lines


def place(origin: Span, source: Source | None = None) -> str:
    """`line 12`, or `cable.bg line 12` where the file is not `source`."""
    if source is None or origin.source.path == source.path:
        return f"line {origin.line}"
    return f"{origin.source.path.rpartition('/')[2]} line {origin.line}"


def node_name(node: Node) -> str:
    """A node as it is declared: `1:rotor`, `MSe:w`."""
    return f"{node.keyword}:{node.path}"


def bond_name(graph: BondGraph, bond: Bond) -> str:
    """A bond as an arrow: `rotor -> J`, with its number in the figure if it has one."""
    arrow = f"-[{bond.label}]->" if bond.label else "->"
    return f"{_end(graph, bond, 'tail')} {arrow} {_end(graph, bond, 'head')}"


def _end(graph: BondGraph, bond: Bond, which: str) -> str:
    end = bond.tail if which == "tail" else bond.head
    node = graph.nodes[end.node]
    port = node.ports[end.port].name if end.port >= 0 else ""
    # The ports of a two-port follow from the arrows; those of a field are names of the model.
    return node.path if port in ("", "1", "2") else f"{node.path}.{port}"


# ---------------------------------------------------------------------- syntax


def dump_syntax(file: File) -> str:
    """The tree, one node a line, with the place where each was written."""
    lines: list[str] = []
    _tree(file, "", lines, 0)
    return "\n".join(lines)


def _tree(value: object, label: str, lines: list[str], depth: int) -> None:
    lead = "  " * depth + (f"{label}: " if label else "")
    if isinstance(value, tuple) and hasattr(value, "_fields"):
        plain: list[tuple[str, object]] = []
        nested: list[tuple[str, object]] = []
        for name in value._fields:
            item = getattr(value, name)
            if name == "origin" or name.endswith("_origin") or item in (None, "", ()):
                continue
            (nested if isinstance(item, tuple) else plain).append((name, item))
        at = getattr(value, "origin", None)
        where = f"  @{at.line}:{at.column}" if isinstance(at, Span) else ""
        words = [f"{name}={_plain(item)}" for name, item in plain]
        lines.append(f"{lead}{' '.join([type(value).__name__, *words])}{where}")
        for name, item in nested:
            _tree(item, name, lines, depth + 1)
    elif isinstance(value, tuple):
        lines.append(f"{lead}{len(value)}")
        for item in value:
            _tree(item, "", lines, depth + 1)
    else:
        lines.append(f"{lead}{_plain(value)}")


def _plain(value: object) -> str:
    return number(value) if isinstance(value, Fraction) else repr(value)


# ----------------------------------------------------------------------- graph


def dump_graph(graph: BondGraph) -> str:
    """Nodes with their laws, bonds, values, inputs, sensors: the flat model."""
    lines = [f"model {graph.name}", "", "nodes"]
    lines += table(row for node in graph.nodes for row in _node_rows(node))
    lines += ["", "bonds"]
    lines += table((str(b.number), bond_name(graph, b)) for b in graph.bonds)
    for title, rows in _sections(graph):
        if rows:
            lines += ["", title, *table(rows)]
    return "\n".join(lines)


def _sections(graph: BondGraph) -> list[tuple[str, list[tuple[str, ...]]]]:
    return [
        (
            "values",
            [
                (v.symbol.symbol.kind.value, v.name, _value(v.value), _about(v))
                for v in graph.values
            ],
        ),
        ("inputs", [(i.name, _input(i), i.unit or "") for i in graph.inputs]),
        ("sensors", [(s.name, s.kind, _reads(s), s.unit or "") for s in graph.sensors]),
        (
            "integrals",
            [
                (i.symbol.symbol.name, show(i.integrand), f"from {show(i.initial_value)}")
                for i in graph.integrals
            ],
        ),
        ("lets", [(item.name, show(item.value)) for item in graph.lets]),
        ("events", [(e.name, e.target, e.op, show(e.value)) for e in graph.events]),
    ]


def _node_rows(node: Node) -> list[tuple[str, str, str]]:
    rows = []
    for law in node.laws:
        rows.append(("", "0 =", show(law.zero)))
    for port in node.ports:
        if port.state is not None:
            start = "" if port.initial_value is None else f", from {show(port.initial_value)}"
            rows.append(("", f"D({show(port.state)}) =", show(port.rate) + start))
    if node.sensor is not None:
        rows.append(("", "reads", show(node.sensor)))
    if node.when is not None:
        rows.append(("", "when", show(node.when)))
    if not rows:
        return [(node_name(node), "", "")]
    return [(node_name(node), *rows[0][1:]), *rows[1:]]


def _value(value: Expr | None) -> str:
    return "(given at configure)" if value is None else show(value)


def _about(value: Value) -> str:
    words = [value.unit or ""]
    if value.tolerance is not None:
        words.append(f"+- {number(value.tolerance * 100)}%")
    if value.fault:
        words.append("fault")
    return "  ".join(w for w in words if w)


def _input(item: Input) -> str:
    kind = "mode" if item.mode else "known" if item.known else "unknown"
    return f"{kind}, {float(item.delay):g} s late" if item.delay and not item.of else kind


def _reads(sensor: Sensor) -> str:
    reads = show(sensor.reads)
    return past_name(reads, sensor.delay) if sensor.delay else reads


# ---------------------------------------------------------------------- causal


def dump_causal(causal: CausalGraph) -> str:
    """Every bond with its stroke and the reason for it, then what is dependent or looped."""
    graph = causal.graph
    lines = [f"preferred {causal.preference} causality of {graph.name}", ""]
    rows = []
    for bond, stroke in zip(graph.bonds, causal.strokes, strict=True):
        arrow = f"-[{bond.label}]->" if bond.label else "->"
        drawn = f"|{arrow}" if stroke.at == "tail" else f"{arrow}|"
        rows.append(
            (
                str(bond.number),
                _end(graph, bond, "tail"),
                drawn,
                _end(graph, bond, "head"),
                reason(causal, stroke.reason),
            )
        )
    lines += table(rows)
    lines += ["", "storages"]
    for storage in causal.storages:
        node = graph.nodes[storage.node]
        name = node.ports[storage.port].name
        port = f".{name}" if name else ""
        word = "integral" if storage.integral else "derivative"
        lines.append(f"  {node_name(node)}{port}: {word}")
    for title, numbers in (
        ("dualised", causal.dualised),
        ("not dualised", causal.not_dualised),
    ):
        if numbers:
            lines += ["", title, *[f"  {node_name(graph.nodes[n])}" for n in numbers]]
    if causal.loops:
        lines += ["", "algebraic loops"]
        lines += [f"  {' - '.join(graph.nodes[n].path for n in loop)}" for loop in causal.loops]
    return "\n".join(lines)


def reason(causal: CausalGraph, why: Reason) -> str:
    """Why a stroke of a causal assignment stands where it stands, in a few words."""
    node = causal.graph.nodes[why.node]
    match why.cause:
        case "source":
            return f"fixed by source {node.path}"
        case "sensor":
            dualised = ", dualised" if why.node in causal.dualised else ""
            return f"fixed by sensor {node.path}{dualised}"
        case "law":
            return f"fixed by the law of {node.path}"
        case "preferred":
            return f"preferred by {node.path}"
        case "chosen":
            return f"chosen at {node.path}"
        case "switched":
            return f"while {node.path} is off"
        case "ring":
            return f"closes a ring at {node.path}"
        case "propagated":
            through = ", ".join(str(b) for b in why.because)
            return f"forced at {node.path}" + (f" by {through}" if through else "")


# --------------------------------------------------------- equations, residuals


def dump_equations(system: EquationSystem) -> str:
    """All equations, each with the place that it comes from."""
    source = system.graph.source
    lines = [f"{len(system.equations)} equations in {len(system.unknowns)} unknowns", ""]
    lines += table(
        (e.kind, e.name, f"0 = {show(e.zero)}", f"# {place(e.origin, source)}")
        for e in system.equations
    )
    return "\n".join(lines)


def dump_residuals(found: ResidualSet) -> str:
    """Each residual with the steps that lead to it, and what is not monitored."""
    source = found.system.graph.source
    blocks = [residual_path(r, source) for r in found.residuals]
    if found.missing:
        lines = [f"missing: {equation_name(m.about, source)}" for m in found.missing]
        blocks.append("\n".join(lines))
    if found.unmonitored:
        names = dict.fromkeys(e.name for e in found.unmonitored)
        blocks.append("not monitored: " + ", ".join(names))
    return "\n\n".join(blocks) or "no residual"


def residual_path(residual: Residual, source: Source) -> str:
    """The elimination path of one residual, from the known signals to the closing equation."""
    lines = [f"{residual.name}: left over is {residual_origin(residual, source)}"]
    lines += table(step_row(step, source) for step in residual.steps)
    lines += order_line(residual.differentiated)
    lines.append(f"  0 = {show(residual.closing.zero)}")
    return "\n".join(lines)


def order_line(differentiated: int) -> list[str]:
    """What became of a relation because of initial values, in a line or none."""
    if differentiated < 0:
        return ["  since the start, as declared: what was left over are rates alone"]
    if not differentiated:
        return []
    times = "once" if differentiated == 1 else f"{differentiated} times"
    return [f"  differentiated {times}: an initial value is not declared"]


def step_row(step: Step, source: Source) -> tuple[str, str, str]:
    """One step of an elimination: what is computed, from what, by which equation and how."""
    left = f"{show(step.variable)} ="
    return left, show(step.value), f"# {step.how}: {equation_name(step.equation, source)}"


def equation_name(equation: Equation, source: Source) -> str:
    """What an equation is, and where it was written."""
    noun = {
        "balance": "balance of",
        "law": "law of",
        "state": "storage",
        "integral": "integral",
        "sensor": "sensor",
    }[equation.kind]
    return f"{noun} {equation.name}, {place(equation.origin, source)}"


def residual_origin(residual: Residual, source: Source) -> str:
    """Where a residual stands in the model, and what it was made to be free of."""
    made = "" if residual.free_of is None else f", free of {residual.free_of}"
    return equation_name(residual.closing, source) + made


def dump_signatures(matrix: SignatureMatrix) -> str:
    """The matrix, the groups of faults with equal signatures, the orders of derivatives."""
    lines = [str(matrix), "", "orders"]
    for residual, orders in zip(matrix.residuals, matrix.orders, strict=True):
        lines.append(f"  {residual}: " + ", ".join(f"{s} {n}" for s, n in orders.items()))
    lines += ["", "groups", *[f"  {', '.join(group)}" for group in matrix.groups]]
    if matrix.undetectable:
        lines += ["", f"undetectable: {', '.join(matrix.undetectable)}"]
    return "\n".join(lines)
