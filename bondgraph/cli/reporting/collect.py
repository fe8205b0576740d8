"""All that a report says of a model, as far as the model can be compiled."""

from __future__ import annotations

from collections.abc import Callable, Iterator

from bondgraph.algebra.nominal import Nominal
from bondgraph.backends.report.content import (
    Content,
    Drawing,
    Group,
    MatrixRow,
    Mode,
    Quantity,
    Signatures,
)
from bondgraph.backends.report.formulas import Typesetter
from bondgraph.cli.console import status
from bondgraph.cli.reasons import message, missing, reasons
from bondgraph.cli.reporting.relations import relations
from bondgraph.cli.reporting.seen import Assumed, seen
from bondgraph.cli.stuck import stuck_switches
from bondgraph.compilation import Compilation
from bondgraph.ir.expr import symbols
from bondgraph.ir.graph import BondGraph
from bondgraph.ir.program import Program
from bondgraph.ir.signature_matrix import ModeSignature, SignatureMatrix
from bondgraph.text.diagnostic import CompileError, Diagnostic
from bondgraph.text.moment import often
from bondgraph.text.numerals import plural, readable

_NODES = 1500  # of a drawing that still fits a page
_QUANTITIES = 500  # of a list that is still one


STAGES = 8  # what takes time; `collect` says when each begins


def collect(
    compilation: Compilation,
    assume: Callable[[Program], Assumed],
    advance: Callable[[str], None] = lambda _: None,
    derive: bool = False,
) -> Content:
    """The content of the report; `assume` says what the signals of the residual program are.

    A model without strokes, or one whose relations cannot be derived, gives the content up to
    there with the findings. Raises CompileError where there is not even a bond graph.
    """
    graph = compilation.graph
    known = _bare(compilation)
    try:
        advance("causality")
        _ = compilation.derivative
        if compilation.conflicts:
            said = tuple(c.finding for c in compilation.conflicts)
            return known._replace(status="error", message=said[0].message, findings=said)
        known = known._replace(drawings=tuple(_drawings(compilation)))
        advance("relations")
        _ = compilation.signatures
        advance("verifying")
        _ = compilation.verification
    except CompileError as error:
        if not known.drawings:
            known = known._replace(drawings=tuple(_drawings(compilation)))
        return known._replace(
            status=status(error), message=str(error), findings=tuple(error.diagnostics)
        )
    advance("lowering")
    program, trouble = _program(compilation)
    names = [*_names(graph), *[v.symbol.name for e in compilation.equations.equations
                               for v in e.variables]]  # fmt: skip
    typesetter = Typesetter(names, graph.initial_values())
    found = compilation.signatures
    advance("signals")
    situation = assume(program) if program is not None and found.residuals else None
    advance("formulas")
    told = relations(compilation, typesetter, program, derive)
    advance("signatures")
    marked = matrix(compilation, program)
    advance("sizes")
    return known._replace(
        status="ok" if found.residuals else "no_arr",
        message=message(compilation),
        facts=tuple(_facts(compilation, program)),
        relations=told,
        missing=tuple(missing(compilation)),
        signatures=marked,
        seen=seen(compilation, typesetter, program, situation) if found.residuals else None,
        quantities=tuple(_quantities(graph, typesetter)),
        findings=(*compilation.report.diagnostics, *trouble),
    )


def _bare(compilation: Compilation) -> Content:
    graph = compilation.graph
    source = graph.source.path.replace("\\", "/").rpartition("/")[2]
    return Content(graph.name, graph.doc, source, "ok", "", (), (), _links(graph), (), None, None,
                   (), ())  # fmt: skip


def _program(compilation: Compilation) -> tuple[Program | None, tuple[Diagnostic, ...]]:
    """The residual program; None with the findings where there is none."""
    if not compilation.residuals:
        return None, ()
    try:
        return compilation.program, ()
    except CompileError as error:
        return None, tuple(d for d in error.diagnostics if d not in compilation.report.diagnostics)


def _drawings(compilation: Compilation) -> Iterator[Drawing]:
    nodes = len(compilation.graph.nodes)
    if nodes > _NODES:
        return
    if compilation.conflicts:
        yield Drawing(
            "Why no strokes can be placed",
            "Boxed: the conflict; without any one of its members the rest agrees.",
            compilation.drawing(bare=True),
        )
        return
    yield Drawing(
        "In preferred integral causality",
        "As a simulation computes it. The half arrow is the direction of positive power, the bar"
        " is at the end that receives the effort."
        + (" Dashed: a storage in derivative causality." if compilation.integral.dependent else ""),
        compilation.drawing(bare=True),
    )
    yield Drawing(
        "In preferred derivative causality, the sensors dualised",
        "As the relations are computed: what is measured is imposed (SSe, SSf), and the storages"
        " differentiate.",
        compilation.drawing(derivative=True, bare=True),
    )


def _links(graph: BondGraph) -> dict[str, tuple[str, ...]]:
    """The faults of each element: the parameters and signals of its laws, what it measures."""
    faults = {symbol: name for name, symbol in graph.fault_symbols().items()}
    found = {}
    for node in graph.nodes:
        inside = symbols(*[law.zero for law in node.laws])
        own = [faults[s] for s in inside if s in faults]
        own += [s.name for s in graph.sensors if s.node is not None
                and graph.nodes[s.node] is node and s.name in faults.values()]  # fmt: skip
        if own:
            found[node.path] = tuple(dict.fromkeys(own))
    return found


def _facts(compilation: Compilation, program: Program | None) -> Iterator[tuple[str, str]]:
    graph = compilation.graph
    kinds = [f"{plural(len(graph.nodes), 'node')}", f"{plural(len(graph.bonds), 'bond')}",
             plural(sum(s.same_as is None for s in graph.sensors), "sensor")]  # fmt: skip
    yield "Model", ", ".join(kinds)
    if len(graph.nodes) > _NODES:
        yield "Drawing", "too large for a page; bondgraph draw writes it"
    if not compilation.residuals:
        return
    done = compilation.verification
    yield (
        "Verified",
        f"exactly, against a simulation that shares no code with the derivation: "
        f"{plural(done.residuals, 'residual')} on the healthy model, "
        f"{plural(done.faults, 'fault')} one at a time",
    )
    if program is not None:
        wait = program.wait(program.bandwidth / program.rate) / program.bandwidth
        yield (
            "Code",
            f"{often(program.rate)}, filter of {program.bandwidth:g} rad/s,"
            f" valid {wait:.2g} s after the first sample",
        )


def _names(graph: BondGraph) -> Iterator[str]:
    for items in (graph.values, graph.inputs, graph.sensors):
        for item in items:
            yield item.name


def _quantities(graph: BondGraph, typesetter: Typesetter) -> Iterator[Quantity]:
    nominal = Nominal(graph)
    rows: list[Quantity] = []
    for v in graph.values:
        number = nominal.value(v.symbol)
        value = "free" if number is None else readable(number, 6)
        if v.tolerance is not None:
            value += f" ± {100 * float(v.tolerance):g} %"
        kind = "parameter" if v.fault else "constant"
        rows.append(_quantity(typesetter, v.name, kind, value, v.unit, v.doc))
    for i in graph.inputs:
        kind = "mode" if i.mode else "input" if i.known else "unknown input"
        rows.append(_quantity(typesetter, i.name, kind, "", i.unit, i.doc))
    for s in graph.sensors:
        doc = s.doc if s.same_as is None else f"the same instrument as {s.same_as}"
        rows.append(_quantity(typesetter, s.name, "sensor", "", s.unit, doc))
    yield from rows[:_QUANTITIES]


def _quantity(
    typesetter: Typesetter, name: str, kind: str, value: str, unit: str | None, doc: str
) -> Quantity:
    return Quantity(typesetter.inline(name), name, kind, value, unit or "", doc)


def matrix(compilation: Compilation, program: Program | None) -> Signatures:
    """The matrix with how long each fault shows, the groups, the best there could be, modes."""
    found, best = compilation.signatures, compilation.maximum_isolability
    cells = _cells(compilation, program)
    groups = []
    for number, faults in enumerate(found.groups, 1):
        hits = found.row(faults[0])
        seen = tuple(r for r, hit in zip(found.residuals, hits, strict=True) if hit)
        rows = tuple(MatrixRow(f, cells[f], True, len(faults) == 1) for f in faults)
        parts = tuple(part for part in best or (faults,) if part[0] in faults)
        groups.append(Group(number, seen, rows, parts))
    why = reasons(compilation) if found.undetectable else {}
    modes = compilation.mode_signatures if found.residuals else None
    return Signatures(
        found.residuals,
        tuple(groups),
        tuple((reason, tuple(faults)) for reason, faults in why.items()),
        best,
        () if modes is None else tuple(_mode(m, found) for m in modes.modes),
        0 if modes is None else modes.total - len(modes.modes),
    )


def _cells(compilation: Compilation, program: Program | None) -> dict[str, tuple[str, ...]]:
    """For each fault how each residual sees it."""
    found, lasting = compilation.signatures, compilation.detectability
    blind = {r.path: r.invisible for r in program.residuals} if program else {}
    words = {True: "strong", False: "weak", None: "unsaid"}
    cells: dict[str, tuple[str, ...]] = {}
    for fault, hits, strong in zip(found.faults, found.rows, lasting.strong, strict=True):
        row = []
        for residual, hit, lasts in zip(found.residuals, hits, strong, strict=True):
            unseen = " unseen" if fault in blind.get(residual, ()) else ""
            row.append(words[lasts] + unseen if hit else "")
        cells[fault] = tuple(row)
    return cells


def _mode(mode: ModeSignature, whole: SignatureMatrix) -> Mode:
    if mode.matrix is None:
        return Mode(mode.name, mode.reason, (), (), (), False, ())
    own, words = mode.matrix, mode.stuck
    groups = [
        (own.seen_by(faults[0]), tuple(words.get(f, f) for f in faults)) for faults in own.groups
    ]
    lost = tuple(f for f in own.undetectable if f not in {*whole.undetectable, *words})
    blind = tuple(r for r in own.residuals if not own.signature(r))
    switches = tuple(stuck_switches(mode))
    return Mode(mode.name, "", tuple(groups), lost, blind, mode.like(whole), switches)
