"""State equations as a file of C: for the simulator, which compiles and loads it."""

from __future__ import annotations

import math
import re

from bondgraph.backends import listing
from bondgraph.backends.c import PURE
from bondgraph.backends.target import load
from bondgraph.backends.templates import codegen, fill
from bondgraph.ir.artifact import Artifact
from bondgraph.ir.rate_source import RateSource
from bondgraph.notation.dialect import Language, digits

_HELPERS = [name for name in PURE if name != "root"]  # what iterates is left to Python
_LINEAR = ("c/rates_times.c", "c/rates_solve.c.j2")
_COMMENT = re.compile(r"/\*.*?\*/", re.DOTALL)
_FUNCTION = re.compile(r"^static \w+ (\w+)\(", re.MULTILINE)


def rate_language() -> Language:
    """C, as the lines of a `RateSource` are to be written."""
    target = load("c")
    style = target.statements
    return Language(target.dialect, style.local, style.assign, style.declared, style.branch)


def rate_file(source: RateSource, beyond: float, singular: float) -> Artifact:
    """The file of C; it refuses rates from `beyond` on, and matrices of a `singular` condition."""
    return Artifact("rates.c", fill("c/rates.c.j2", rate_holes(source, beyond, singular)))


def rate_holes(source: RateSource, beyond: float, singular: float) -> dict[str, object]:
    """What fills the holes of rates.c.j2 and rates_functions.c.j2."""
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
    return {
        **{name: getattr(source, name) for name in RateSource._fields},
        "tables": tables,
        **_called("\n".join((*source.inputs, *source.rates, *source.outputs))),
        "roots": [],
        "beyond": digits(beyond),
        "singular": digits(singular),
    }


def _called(text: str) -> dict[str, object]:
    """The helpers and the templates of linear equations that some lines call, and these call."""
    found: list[str] = []
    helpers = [f"c/helpers/{name}.c" for name in _HELPERS]
    for template in reversed([*helpers, *_LINEAR]):  # each stands before those that call it
        own = _COMMENT.sub("", (codegen() / template).read_text(encoding="utf-8"))
        if any(re.search(rf"\b{name}\(", text) for name in _FUNCTION.findall(own)):
            found.append(template)
            text += own
    return {
        "helpers": [n for n, path in zip(_HELPERS, helpers, strict=True) if path in found],
        "linear": [path for path in _LINEAR if path in found],
    }


def _number(value: float) -> str:
    return "(real)NAN" if math.isnan(value) else f"REAL({digits(value)})"
