"""Read a characteristic from a comma separated file beside the model."""

from __future__ import annotations

import os
from fractions import Fraction

from bondgraph.ir.syntax import Text
from bondgraph.passes.elaboration.problems import fail
from bondgraph.text.diagnostic import Report
from bondgraph.text.source import Source

Points = tuple[tuple[Fraction, Fraction], ...]

_HELP = "A table has two columns, x and y, in SI units, with x ascending, and two rows or more."
_LARGEST = 10**300


def read_table(file: Text, source: Source, report: Report) -> Points:
    """The points of a piecewise linear function; raises Skip where the file has none.

    The file is looked for beside the model. A first line without numbers is taken for a heading;
    empty lines and lines that begin with `#` are left out; commas, semicolons, tabs and blanks
    separate.
    """
    path = os.path.join(os.path.dirname(source.path), file.value)
    try:
        with open(path, encoding="utf-8-sig") as stream:
            lines = stream.read().splitlines()
    except (OSError, ValueError) as error:
        reason = error.strerror if isinstance(error, OSError) else "it is no text"
        fail(report, "unreadable-table", f'The table "{file.value}" cannot be read: {reason}.',
             file.origin, help="The path is taken from the folder of the model file."
             )  # fmt: skip
    points: list[tuple[Fraction, Fraction]] = []
    headed = False
    for number, line in enumerate(lines, 1):
        cells = line.split("#")[0].replace(",", " ").replace(";", " ").split()
        if not cells:
            continue
        values = [_number(c) for c in cells]
        if None in values and not points and not headed:
            headed = True
            continue
        x, y = (values[0], values[1]) if len(values) == 2 else (None, None)
        if x is None or y is None:
            fail(report, "wrong-table", f'Line {number} of "{file.value}" is no pair of numbers.',
                 file.origin, help=_HELP)  # fmt: skip
        if points and x <= points[-1][0]:
            fail(report, "wrong-table", f'Line {number} of "{file.value}": x does not ascend.',
                 file.origin, help=_HELP)  # fmt: skip
        points.append((x, y))
    if len(points) < 2:
        fail(report, "wrong-table", f'"{file.value}" has fewer than two points.', file.origin,
             help=_HELP)  # fmt: skip
    return tuple(points)


def _number(text: str) -> Fraction | None:
    """An exact number within the range of a double, or None."""
    try:
        rough = float(text)
        if len(text) > 400 or not abs(rough) < _LARGEST:
            return None
        return Fraction(text) if rough else Fraction(0)
    except (ValueError, ZeroDivisionError):
        return None
