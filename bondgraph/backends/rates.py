"""State equations as a file of C: for the simulator, which compiles and loads it."""

from __future__ import annotations

import math

from bondgraph.backends import listing
from bondgraph.backends.c import PURE
from bondgraph.backends.target import load
from bondgraph.backends.templates import fill
from bondgraph.ir.artifact import Artifact
from bondgraph.ir.rate_source import RateSource
from bondgraph.notation.dialect import Language, digits

_HELPERS = [name for name in PURE if name != "root"]  # what iterates is left to Python


def rate_language() -> Language:
    """C, as the lines of a `RateSource` are to be written."""
    target = load("c")
    style = target.statements
    return Language(target.dialect, style.local, style.assign, style.declared, style.branch)


def rate_file(source: RateSource, beyond: float, singular: float) -> Artifact:
    """The file of C; it refuses rates from `beyond` on, and matrices of a `singular` condition."""
    target = load("c")
    tables = []
    for table in source.tables:
        rows = table.rows if len(table.rows) > 1 else table.rows * 2  # a single point is a constant
        lines = [f"{{{', '.join(_number(float(x)) for x in row)}}}" for row in rows]
        tables.append(
            {
                "comment": listing.harmless(f"The table {table.name}.", target),
                "name": table.called,
                "columns": len(rows[0]),
                "lines": listing.table(lines, target, 4),
            }
        )
    holes = {
        **{name: getattr(source, name) for name in RateSource._fields},
        "tables": tables,
        "helpers": _HELPERS,
        "roots": [],
        "beyond": digits(beyond),
        "singular": digits(singular),
    }
    return Artifact("rates.c", fill("c/rates.c.j2", holes))


def _number(value: float) -> str:
    return "(real)NAN" if math.isnan(value) else f"REAL({digits(value)})"
