"""Reads an incidence table: a row an equation, a column an unknown, a known signal or a fault."""

from __future__ import annotations

import os

from bondgraph.ir.structural_model import Mark, StructuralEquation, StructuralModel
from bondgraph.text.diagnostic import Label, Report
from bondgraph.text.limits import INCIDENCE_CELLS, INCIDENCE_MARKS
from bondgraph.text.source import Source, Span
from bondgraph.text.tuples import NamedTuple

_KINDS = {"x": "unknown", "z": "known signal", "f": "fault"}
_ABSENT = frozenset({"", "0", "."})
_PRESENT = frozenset({"1", "x", "X"})


class _Cell(NamedTuple):
    text: str
    origin: Span


class _Column(NamedTuple):
    kind: str  # x, z or f
    number: int  # among those of its kind
    name: _Cell


def read_table(source: Source, report: Report) -> StructuralModel | None:
    """The structural model in the text of a table; None if the head of the table is wrong.

    The first line that is not empty and no `#` comment names the columns: one for the names of
    the equations, then `x:name` (unknown), `z:name` (known) or `f:name` (fault), separated by
    tabs, semicolons or commas. Each further line is an equation: its name, then for every column
    `1` or `x` where it occurs, nothing, `0` or `.` where it does not. A differential constraint
    has `I` at the variable that is integrated and `D` at its derivative (Frisk, Krysander, Jung,
    2017).

    >>> text = "equation,x:q,x:dq,z:y\\nlaw,,1,1\\nder,I,D,\\nsensor,1,,1\\n"
    >>> model = read_table(Source("tank.csv", text), Report())
    >>> [e.name for e in model.equations], model.equations[1].marks
    (['law', 'der', 'sensor'], ('I', 'D'))
    """
    lines = _lines(source)
    if not lines:
        report.error(
            "table-empty",
            f"The table `{source.path}` is empty.",
            Span(source, 0, 0),
            help="Begin with a line that names the columns: `equation,x:p1,x:q1,z:y1,f:leak`.",
        )
        return None
    separator = next((s for s in "\t;" if s in lines[0].text), ",")
    columns = _columns(_cells(lines[0], separator), report)
    if (len(columns) + 1) * len(lines) > INCIDENCE_CELLS:
        report.error(
            "table-column",
            f"The table has {len(lines) - 1} rows and {len(columns)} columns: more than"
            f" {INCIDENCE_CELLS:,} cells.",
            lines[0].origin,
            help="Leave out what cannot matter for a fault, or analyse parts of the machine.",
        )
        return None
    equations: list[StructuralEquation] = []
    names: dict[str, _Cell] = {}
    marks = 0
    for line in lines[1:]:
        cells = _cells(line, separator)
        while len(cells) > len(columns) + 1 and not cells[-1].text:
            cells.pop()
        if len(cells) > len(columns) + 1:
            extra = cells[len(columns) + 1]
            report.error(
                "table-row",
                f"The equation `{cells[0].text}` has more cells than the table has columns.",
                Label(extra.origin, "belongs to no column"),
                help=f"Give each row at most {len(columns) + 1} cells, its name counted.",
            )
            continue
        marks += sum(cell.text not in _ABSENT for cell in cells[1:])
        if marks > INCIDENCE_MARKS:
            report.error(
                "table-row", f"The table has more than {INCIDENCE_MARKS:,} marks.", line.origin,
                help="An equation has few unknowns: mark only what occurs in it.",
            )  # fmt: skip
            return None
        _unique(cells[0], names, "equations", report)
        equations.append(_equation(cells, columns, report))
    if len(lines) == 1:
        report.error(
            "table-empty",
            f"The table `{source.path}` has no equation.",
            lines[0].origin,
            help="Write one line for each equation below the names of the columns.",
        )
    if report.failed:
        return None
    by_kind = {k: tuple(c.name.text for c in columns if c.kind == k) for k in _KINDS}
    title = os.path.splitext(os.path.basename(source.path))[0]
    return StructuralModel(title, by_kind["x"], by_kind["z"], by_kind["f"], tuple(equations))


def _lines(source: Source) -> list[_Cell]:
    """The lines with content, without comments."""
    found, start = [], 0
    for text in source.text.split("\n"):
        if text.strip() and not text.lstrip().startswith("#"):
            found.append(_Cell(text, Span(source, start, start + len(text))))
        start += len(text) + 1
    return found


def _cells(line: _Cell, separator: str) -> list[_Cell]:
    """The cells of a line, without spaces and quotation marks around them."""
    found, start = [], line.origin.start
    for text in line.text.split(separator):
        inner = text.strip().strip('"').strip()
        at = start + max(text.find(inner), 0)
        found.append(_Cell(inner, Span(line.origin.source, at, at + len(inner))))
        start += len(text) + 1
    return found


def _columns(cells: list[_Cell], report: Report) -> list[_Column]:
    """What each column behind the first one is."""
    columns: list[_Column] = []
    counts = dict.fromkeys(_KINDS, 0)
    names: dict[str, _Cell] = {}
    while len(cells) > 1 and not cells[-1].text:
        cells.pop()
    for cell in cells[1:]:
        kind, colon, name = cell.text.partition(":")
        kind, name = kind.strip().lower(), name.strip()
        if not colon or not name or kind not in _KINDS:
            report.error(
                "table-column",
                f"The column `{cell.text}` does not say what it is.",
                cell.origin,
                help="Write `x:name` for an unknown, `z:name` for a known signal, `f:name` for a "
                "fault.",
            )
            kind = "x"
        else:
            _unique(_Cell(name, cell.origin), names, "columns", report)
        named = _Cell(name, cell.origin)
        columns.append(_Column(kind, counts[kind], named))
        counts[kind] += 1
    if not columns:
        report.error(
            "table-column",
            "The first line of the table names no column.",
            cells[0].origin,
            help="Name the columns in the first line: `equation,x:p1,x:q1,z:y1,f:leak`; they are "
            "separated by commas, semicolons or tabs.",
        )
    return columns


def _unique(cell: _Cell, names: dict[str, _Cell], what: str, report: Report) -> None:
    older = names.setdefault(cell.text, cell)
    if older is not cell:
        report.error(
            "duplicate-name",
            f"Two {what} are called `{cell.text}`.",
            cell.origin,
            Label(older.origin, "the other one"),
            help="Give one of them another name.",
        )


def _equation(cells: list[_Cell], columns: list[_Column], report: Report) -> StructuralEquation:
    unknowns: list[tuple[int, Mark]] = []
    others: dict[str, list[int]] = {"z": [], "f": []}
    derivative: _Cell | None = None
    for cell, column in zip(cells[1:], columns, strict=False):
        if cell.text in _ABSENT:
            continue
        if column.kind == "x" and cell.text in ("I", "D"):
            unknowns.append((column.number, "I" if cell.text == "I" else "D"))
            if cell.text == "D":
                derivative = cell
        elif cell.text not in _PRESENT:
            _bad_mark(cell, column, report)
        elif column.kind == "x":
            unknowns.append((column.number, ""))
        else:
            others[column.kind].append(column.number)
    if derivative is not None and not any(mark == "I" for _, mark in unknowns):
        report.error(
            "table-mark",
            f"The differential constraint `{cells[0].text}` has a derivative (D) of nothing.",
            derivative.origin,
            help="Mark the variable that is integrated in this row with I.",
        )
    return StructuralEquation(
        cells[0].text,
        tuple(c for c, _ in unknowns),
        tuple(m for _, m in unknowns),
        tuple(others["z"]),
        tuple(others["f"]),
        cells[0].origin,
    )


def _bad_mark(cell: _Cell, column: _Column, report: Report) -> None:
    if cell.text in ("I", "D"):
        message = f"`{cell.text}` marks an unknown, but `{column.name.text}` is a "
        message += f"{_KINDS[column.kind]}."
        help = "Use `1`; I and D belong to a state and its derivative, which are unknowns."
    else:
        message = f"`{cell.text}` is no mark of an incidence table."
        help = "Use `1` or `x` where it occurs and nothing, `0` or `.` where it does not; `I` and "
        help += "`D` in a differential constraint."
    report.error("table-mark", message, cell.origin, help=help)
