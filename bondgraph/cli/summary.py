"""What a person reads after a compilation: residuals, signatures, what cannot be seen, files."""

from __future__ import annotations

import os
from collections.abc import Sequence

from bondgraph.cli.reasons import message, missing, reasons, told_apart_at_best
from bondgraph.cli.stuck import overall
from bondgraph.cli.terminal_layout import formula, names, prose, signature_table, width
from bondgraph.compilation import Compilation
from bondgraph.ir.expr import topological
from bondgraph.ir.signature_matrix import SignatureMatrix
from bondgraph.notation.dump_stages import residual_origin
from bondgraph.text.moment import often
from bondgraph.text.numerals import joined, plural
from bondgraph.views import Relation

_LONGEST = 24  # lines of one residual in a report; more than that nobody reads


def report(compilation: Compilation, files: Sequence[str]) -> list[str]:
    """The lines of the report."""
    matrix = compilation.signatures
    columns = width()
    lines = [f"{compilation.graph.name}: {message(compilation)}"]
    if matrix.residuals:
        lines.append(_checked(compilation))
    for relation in compilation.residuals:
        lines += ["", *closed_form(compilation, relation, columns)]
    if compilation.residuals.missing:
        lines += ["", "Missing"]
        for name, why in missing(compilation):
            lines += [f"  {name}", *prose(why, columns, "    ")]
    if matrix.faults and matrix.residuals:
        lines += ["", "Fault signatures", *signature_table(matrix, columns)]
        verb = "tune" if compilation.options.tuning else "compile"  # a tuning is of its residuals
        more = told_apart_at_best(compilation, f"{verb} --isolate adds residuals for them")
        lines += ["", more] if more else []
    lines += _elsewhere(matrix, columns)
    lines += [f"  {r}  is not confirmed: {why}" for r, why in matrix.unconfirmed.items()]
    lines += _modes(compilation, columns)
    if matrix.undetectable:
        lines += ["", "Undetectable"]
        for reason, faults in reasons(compilation).items():
            lines += names(faults, columns)
            lines.append(f"    {reason}")
    if matrix.residuals:
        lines += _numerics(compilation, columns)
    if files:
        folder = os.path.commonpath([os.path.dirname(path) for path in files])
        inside = [os.path.relpath(path, folder) for path in files]
        lines += ["", f"Written to {folder}", *names(inside, columns)]
    return lines


def _checked(compilation: Compilation) -> str:
    done = compilation.verification
    open_ = [v.name for v in compilation.graph.values if v.value is None and v.fault]
    at = " at random values of what has none" if open_ else ""
    return (
        f"checked exactly{at}: {plural(done.residuals, 'residual')} on the healthy model,"
        f" {plural(done.faults, 'fault')} one at a time"
    )


def _elsewhere(matrix: SignatureMatrix, columns: int) -> list[str]:
    """What a residual would see if declared numbers were others, those of one reason together."""
    lines: list[str] = []
    for residual in matrix.residuals:
        by_values: dict[tuple[str, ...], list[str]] = {}
        for fault, values in matrix.only_off_nominal(residual).items():
            by_values.setdefault(values, []).append(fault)
        for values, faults in by_values.items():
            lines += names(faults, columns, f"  {residual}  does not see ")
            shown = [*values[:4], "another"] if len(values) > 5 else values
            where = f"{joined(shown, 'or')} differs" if values else "several of them differ"
            lines.append(f"      as it would where {where}")
    return ["", "At the declared numbers", *lines] if lines else []


def closed_form(
    compilation: Compilation, relation: Relation, columns: int, longest: int | None = _LONGEST
) -> list[str]:
    """One residual as nested formulas under a line that says where it comes from.

    At most `longest` lines (None: all).
    """
    source = compilation.source
    lines = [f"{relation.name}  {residual_origin(relation.residual, source)}"]
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
    matrix, found = compilation.signatures, compilation.mode_signatures
    if not found.modes or not matrix.residuals:
        return []
    lines = ["", "While the machine stays in one mode"]
    for mode in found.modes:
        lead = f"  {mode.name}"
        if mode.matrix is None:
            lines.append(f"{lead}: no behaviour, {mode.reason}")
        elif mode.like(matrix):
            lines.append(f"{lead}: the same signatures")
        else:
            known = {*matrix.undetectable, *mode.modes}
            lost = [f for f in mode.matrix.undetectable if f not in known]
            blind = [r for r in matrix.residuals if not mode.matrix.signature(r)]
            lines.append(f"{lead}: {plural(len(mode.matrix.groups), 'group')}")
            if lost:
                lines += names(lost, columns, "    undetectable here: ")
            if blind:
                lines += names(blind, columns, "    sees nothing: ")
    if len(found.modes) < found.total:
        lines.append(f"  and {found.total - len(found.modes)} modes more")
    lines += ["", "A switch that is not where it is told"]
    for line in overall(found):
        lines += prose(line, columns, "  ")
    return lines


def _numerics(compilation: Compilation, columns: int) -> list[str]:
    """What the sampled code cannot see, although the equations do."""
    program, bounds = compilation.program, compilation.thresholds
    unbounded = {} if bounds is None else {r.name: r.unavailable for r in bounds.residuals}
    path = {k.name: k.path for k in program.knowns}
    anew = {o.residual: [path[m] for m in o.modes] for o in program.openings if o.modes}
    lines: list[str] = []
    form = compilation.options.form
    for info in program.residuals:
        notes = []
        if info.follows:
            notes.append([f"  {info.name}  is an observer that follows {info.follows}"])
        elif form == "observer" or info.path in form:
            notes.append([f"  {info.name}  is no observer: {compilation.observers[info.path]}"])
        if info.invisible:
            notes.append(names(info.invisible, columns, f"  {info.name}  cannot see "))
        if info.approximate:
            notes.append([f"  {info.name}  is approximate: {info.approximate}"])
        if info.name in anew:
            modes = " or ".join(anew[info.name])
            pace = program.bandwidth / program.rate
            wait = program.waits(pace)[info.name] / program.bandwidth
            what = f"  {info.name}  starts anew where {modes} changes: what it differentiates"
            notes.append([f"{what} may jump there; valid {wait:.2g} s later"])
        if info.unavailable:
            notes.append([f"  {info.name}  is never valid: {info.unavailable}"])
        if info.unwritten:
            notes.append([f"  {info.name}  has no exact form in the code: {info.unwritten}"])
        why = unbounded.get(info.name, "")
        if why and why != info.unavailable:
            notes.append([f"  {info.name}  has no adaptive threshold: {why}"])
        for note in notes:
            lines += note
    if not lines:
        return []
    rate = f"{often(program.rate)}, bandwidth {program.bandwidth:g} rad/s"
    return ["", f"In step ({rate})", *lines]
