"""What a person reads after a compilation: residuals, signatures, what cannot be seen, files."""

from __future__ import annotations

import os
from typing import TYPE_CHECKING

from bondgraph.cli.console import plural
from bondgraph.cli.layout import formula, names, signature_table, width
from bondgraph.cli.result import message
from bondgraph.ir.dump import equation_name
from bondgraph.ir.expr import Expr, symbols, topological

if TYPE_CHECKING:
    from collections.abc import Sequence

    from bondgraph.ir.equations import Equation
    from bondgraph.pipeline import Compilation
    from bondgraph.views import Relation

_LONGEST = 24  # lines of one residual in a report; more than that nobody reads


def report(compilation: Compilation, files: Sequence[str]) -> list[str]:
    """The lines of the report."""
    matrix = compilation.signatures
    columns = width()
    lines = [f"{compilation.graph.name}: {message(matrix)}"]
    if matrix.residuals:
        lines.append(_checked(compilation))
    for relation in compilation.residuals:
        lines += ["", *closed_form(compilation, relation, columns)]
    if matrix.faults and matrix.residuals:
        lines += ["", "Fault signatures", *signature_table(matrix)]
    lines += _modes(compilation, columns)
    if matrix.undetectable:
        lines += ["", "Undetectable"]
        for reason, faults in reasons(compilation).items():
            lines += names(faults, columns, "  ")
            lines.append(f"    {reason}")
    if matrix.residuals:
        lines += _numerics(compilation, columns)
    if files:
        folder = os.path.commonpath([os.path.dirname(path) for path in files])
        inside = [os.path.relpath(path, folder) for path in files]
        lines += ["", f"Written to {folder}", *names(inside, columns, "  ")]
    return lines


def _checked(compilation: Compilation) -> str:
    done = compilation.verification
    return (
        f"checked exactly: {plural(done.residuals, 'residual')} on the healthy model,"
        f" {plural(done.faults, 'fault')} one at a time"
    )


def closed_form(
    compilation: Compilation, relation: Relation, columns: int, longest: int | None = _LONGEST
) -> list[str]:
    """One residual as nested formulas under a line that says where it comes from.

    At most `longest` lines (None: all).
    """
    source = compilation.source
    lines = [f"{relation.name}  {equation_name(relation.residual.closing, source)}"]
    indent = " " * (len(relation.name) + 2)
    nodes = len(topological([relation.residual.expr]))
    if longest is not None and nodes > 40 * longest:  # not worth the time it takes to write
        more = f"bondgraph explain {source.path} {relation.name}"
        return [*lines, f"{indent}too long to be read here ({nodes} operations): {more}"]
    form = relation.closed_form
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


def _modes(compilation: Compilation, columns: int) -> list[str]:
    """What can be detected in each mode of a switched machine, one mode a line."""
    matrix, found = compilation.signatures, compilation.modes
    if not found.modes or not matrix.residuals:
        return []
    lines = ["", "While the machine stays in one mode"]
    for mode in found.modes:
        lead = "  " + ", ".join(f"{n} {'on' if on else 'off'}" for n, on in mode.modes.items())
        if mode.matrix is None:
            lines.append(f"{lead}: no behaviour, {mode.reason}")
        elif mode.matrix.rows == matrix.rows:
            lines.append(f"{lead}: the same signatures")
        else:
            lost = [f for f in mode.matrix.undetectable if f not in matrix.undetectable]
            blind = [r for r in matrix.residuals if not mode.matrix.signature(r)]
            lines.append(f"{lead}: {plural(len(mode.matrix.groups), 'group')}")
            if lost:
                lines += names(lost, columns, "    undetectable here: ")
            if blind:
                lines += names(blind, columns, "    sees nothing: ")
    if len(found.modes) < found.total:
        lines.append(f"  and {found.total - len(found.modes)} modes more")
    return lines


def reasons(compilation: Compilation) -> dict[str, list[str]]:
    """Why each undetectable fault is undetectable, with the faults of equal reason together."""
    found: dict[str, list[str]] = {}
    for fault in compilation.signatures.undetectable:
        found.setdefault(reason(compilation, fault), []).append(fault)
    return found


def reason(compilation: Compilation, fault: str) -> str:
    """Why no residual sees a fault, in words of the model."""
    symbol = compilation.graph.fault_symbol(fault)
    found = compilation.residuals.stage
    holding = [e for e in found.system.equations if symbol in symbols(e.zero)]
    if not holding:
        return "no law uses it"
    used = {
        id(equation)
        for residual in found.residuals
        for equation in (residual.closing, *(step.equation for step in residual.steps))
    }
    if any(id(e) in used for e in holding):
        return "it cancels out of every residual"
    rest = [e for e in found.system.equations if id(e) not in used]
    part = _connected(holding, rest)
    junctions = [e.name for e in part if e.kind == "balance"]
    where = f" around {', '.join(_few(junctions))}" if junctions else ""
    hidden = [i.name for i in compilation.graph.inputs if not i.known]
    unknown = [n for n in hidden if any(n == v.symbol.name for e in part for v in e.variables)]
    if unknown:
        return f"what is measured{where} is needed to tell the unknown {', '.join(unknown)}"
    return f"no sensor{where} could contradict the model there"


def _connected(seeds: list[Equation], among: list[Equation]) -> list[Equation]:
    """The equations that hang together with some of them by their unknowns."""
    holders: dict[Expr, list[Equation]] = {}
    for equation in among:
        for variable in equation.variables:
            holders.setdefault(variable, []).append(equation)
    reached = {id(e) for e in seeds}
    stack = list(seeds)
    while stack:
        for variable in stack.pop().variables:
            for equation in holders.pop(variable, []):
                if id(equation) not in reached:
                    reached.add(id(equation))
                    stack.append(equation)
    return [e for e in among if id(e) in reached]


def _few(items: list[str]) -> list[str]:
    return items if len(items) <= 3 else [*items[:3], "others"]


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
        if info.unwritten:
            notes.append([f"  {info.name}  has no exact form in the code: {info.unwritten}"])
        for note in notes:
            lines += note
    if not lines:
        return []
    rate = f"{program.rate:g} samples a second, bandwidth {program.bandwidth:g} rad/s"
    return ["", f"In step ({rate})", *lines]
