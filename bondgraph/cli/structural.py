"""What the commands on structure share: a model or an incidence table, opened."""

from __future__ import annotations

from typing import TYPE_CHECKING

from bondgraph.text.diagnostic import CompileError, Report

if TYPE_CHECKING:
    from bondgraph.compilation import Compilation
    from bondgraph.ir.structural_model import StructuralModel
    from bondgraph.text.diagnostic import Diagnostic

MODEL_HELP = "file.bg, file.bg:Name, or an incidence table (.csv, .tsv)"


def is_table(name: str) -> bool:
    """Whether a file is an incidence table, by its name."""
    return name.lower().endswith((".csv", ".tsv"))


def open_table(name: str) -> tuple[StructuralModel, tuple[Diagnostic, ...]]:
    """The structure in a table, and what there is to say about it; raises `CompileError`."""
    from bondgraph.frontend.incidence import read_table
    from bondgraph.frontend.read import read

    report = Report()
    source = read(name, report)
    model = read_table(source, report) if source else None
    report.stop_on_error()
    if model is None:
        raise CompileError(tuple(report.diagnostics))
    return model, tuple(report.diagnostics)


def open_structure(
    name: str,
) -> tuple[StructuralModel, tuple[Diagnostic, ...], Compilation | None]:
    """The structure of a model or of a table, with the compilation where there is one."""
    if is_table(name):
        return *open_table(name), None
    from bondgraph import compile

    compilation = compile(name)
    structure = compilation.structure
    return structure, tuple(compilation.report.diagnostics), compilation


def named(model: StructuralModel, faults: tuple[int, ...]) -> list[str]:
    """The names of faults."""
    return [model.faults[f] for f in faults]
