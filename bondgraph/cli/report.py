"""What a person reads after a compilation: residuals, signatures, what cannot be seen, files."""

from __future__ import annotations

from typing import TYPE_CHECKING

from bondgraph.cli.console import plural
from bondgraph.cli.layout import formula, names, signature_table, width
from bondgraph.cli.result import message
from bondgraph.ir.dump import equation_name
from bondgraph.ir.expr import Expr, symbols

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from bondgraph.pipeline import Compilation
    from bondgraph.views import Relation

_LONGEST = 24  # lines of one residual in a report; more than that nobody reads


def report(compilation: Compilation, files: Sequence[str]) -> list[str]:
    """The lines of the report."""
    matrix = compilation.signatures
    columns = width()
    lines = [f"{compilation.graph.name}: {message(matrix)}"]
    for relation in compilation.residuals:
        lines += ["", *closed_form(compilation, relation, columns)]
    if matrix.faults and matrix.residuals:
        lines += ["", "Fault signatures", *signature_table(matrix)]
    if matrix.undetectable:
        lines += ["", "Undetectable"]
        for reason, faults in reasons(compilation).items():
            lines += names(faults, columns, "  ")
            lines.append(f"    {reason}")
    if matrix.residuals:
        lines += _numerics(compilation, columns)
    if files:
        lines += ["", f"Written ({plural(len(files), 'file')})", *[f"  {path}" for path in files]]
    return lines


def closed_form(
    compilation: Compilation, relation: Relation, columns: int, longest: int | None = _LONGEST
) -> list[str]:
    """One residual as nested formulas under a line that says where it comes from.

    At most `longest` lines (None: all).
    """
    form = relation.closed_form
    source = compilation.source
    lines = [f"{relation.name}  {equation_name(relation.residual.closing, source)}"]
    indent = " " * (len(relation.name) + 2)
    lines += formula(form.text, columns, f"{indent}0 = ", f"{indent}    ")
    for name, text in form.where:
        lines += formula(text, columns, f"{indent}{name} = ", f"{indent}    ")
    if longest is not None and len(lines) > longest:
        rest = len(lines) - longest
        lines = [
            *lines[:longest],
            f"{indent}... {plural(rest, 'line')} more: bondgraph explain"
            f" {compilation.source.path} {relation.name}",
        ]
    return lines


def reasons(compilation: Compilation) -> dict[str, list[str]]:
    """Why each undetectable fault is undetectable, with the faults of equal reason together."""
    found: dict[str, list[str]] = {}
    for fault in compilation.signatures.undetectable:
        found.setdefault(reason(compilation, fault), []).append(fault)
    return found


def reason(compilation: Compilation, fault: str) -> str:
    """Why no residual sees a fault, in words of the model."""
    graph = compilation.graph
    symbol = graph.fault_symbol(fault)
    system = compilation.equations
    holding = [e for e in system.equations if symbol in symbols(e.zero)]
    blind = {id(e) for e in compilation.residuals.stage.unmonitored}
    if not holding:
        return "no law uses it"
    if all(id(e) in blind for e in holding):
        around = _junctions(compilation, [v for e in holding for v in e.variables])
        where = f" around {', '.join(around)}" if around else ""
        return f"the part{where} is not measured twice over: no sensor leaves a relation there"
    return "it cancels out of every residual"


def _junctions(compilation: Compilation, variables: Iterable[Expr]) -> list[str]:
    """The junctions of the unmonitored part that some variables belong to, at most three."""
    unmonitored = compilation.residuals.stage.unmonitored
    reached = dict.fromkeys(variables)
    grown = True
    while grown:
        grown = False
        for equation in unmonitored:
            if any(v in reached for v in equation.variables):
                new = [v for v in equation.variables if v not in reached]
                reached.update(dict.fromkeys(new))
                grown = grown or bool(new)
    found = [
        e.name
        for e in unmonitored
        if e.kind == "balance" and any(v in reached for v in e.variables)
    ]
    return found if len(found) <= 3 else [*found[:3], "others"]


def _numerics(compilation: Compilation, columns: int) -> list[str]:
    """What the sampled code cannot see, although the equations do."""
    program = compilation.program
    lines: list[str] = []
    for info in program.residuals:
        notes = []
        if info.invisible:
            notes.append(names(info.invisible, columns, f"  {info.name}  cannot see "))
        if info.approximate:
            notes.append([f"  {info.name}  is approximate: {info.approximate}"])
        if info.unavailable:
            notes.append([f"  {info.name}  is never valid: {info.unavailable}"])
        for note in notes:
            lines += note
    if not lines:
        return []
    rate = f"{program.rate:g} samples a second, bandwidth {program.bandwidth:g} rad/s"
    return ["", f"In step ({rate})", *lines]
