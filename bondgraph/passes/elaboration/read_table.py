"""Reads the file of a table: two columns for one input, a map for two."""

from __future__ import annotations

import os
from fractions import Fraction
from itertools import pairwise
from typing import NoReturn

from bondgraph.ir.syntax import Text
from bondgraph.ir.tables import Rows
from bondgraph.passes.elaboration.problems import fail
from bondgraph.text.diagnostic import Report
from bondgraph.text.limits import TABLE_BYTES, TABLE_NUMBERS
from bondgraph.text.regular_file import check_regular
from bondgraph.text.source import Source

_HELP = {
    1: "A table has two columns, x and y, in SI units, with x ascending, and two rows or more. "
       'One with two inputs is a map, `table("map.csv", x, y)`.',
    2: "The first line of a map has the numbers of its second input, behind a corner that can hold "
       "anything; each further line has a number of the first input and then the values there. "
       "Both ascend, and there are two or more of each, in SI units.",
}  # fmt: skip
_LARGEST = 10**300


def read_table(file: Text, inputs: int, source: Source, report: Report) -> Rows:
    """The rows of a table, see `bondgraph.ir.tables`; raises Skip where the file has none.

    The file is looked for beside the model. A first line that does not end with a number is taken
    for a heading; empty lines and lines that begin with `#` are left out; commas, semicolons, tabs
    and blanks separate.
    """
    path = os.path.join(os.path.dirname(source.path), file.value)
    try:
        check_regular(path, TABLE_BYTES)
        with open(path, encoding="utf-8-sig") as stream:
            text = stream.read().splitlines()
    except (OSError, ValueError) as error:
        reason = error.strerror if isinstance(error, OSError) else "it is no text"
        fail(report, "unreadable-table", f'The table "{file.value}" cannot be read: {reason}.',
             file.origin, help="Give a text file; its path is taken from the folder of the model."
             )  # fmt: skip

    def wrong(message: str, at: int | None = None) -> NoReturn:
        where = f'"{file.value}"' if at is None else f'Line {at} of "{file.value}"'
        fail(report, "wrong-table", where + message, file.origin, help=_HELP[inputs])

    lines = [(at, cells) for at, line in enumerate(text, 1) if (cells := _cells(line))]
    if lines and None in (lines[0][1] if inputs == 1 else lines[0][1][-1:]):
        del lines[0]
    width = 2 if inputs == 1 else max([len(cells) for _, cells in lines[1:2]], default=0)
    rows: list[tuple[Fraction, ...]] = []
    for at, cells in lines:
        if inputs == 2 and not rows and len(cells) >= width - 1:
            cells = [Fraction(0), *cells[len(cells) - width + 1 :]]
        row = tuple([x for x in cells if x is not None])
        if not len(row) == len(cells) == width:
            wrong(" is no pair of numbers." if inputs == 1 else f" has not {width} numbers.", at)
        if len(rows) >= inputs and row[0] <= rows[-1][0]:
            wrong(": x does not ascend.", at)
        rows.append(row)
        if len(rows) * width > TABLE_NUMBERS:
            wrong(f" is one too many: a table has {TABLE_NUMBERS:,} numbers at most.", at)
    if len(rows) < inputs + 1:
        wrong(" has fewer than two points.")
    if inputs == 2 and (width < 3 or any(b <= a for a, b in pairwise(rows[0][1:]))):
        wrong(": the first line has no two numbers, or they do not ascend.", lines[0][0])
    return tuple(rows)


def _cells(line: str) -> list[Fraction | None]:
    """The numbers of a line; None for what is none."""
    return [_number(c) for c in line.split("#")[0].replace(",", " ").replace(";", " ").split()]


def _number(text: str) -> Fraction | None:
    """An exact number within the range of a double, or None."""
    try:
        rough = float(text)
        if len(text) > 400 or not abs(rough) < _LARGEST:
            return None
        return Fraction(text) if rough else Fraction(0)
    except (ValueError, ZeroDivisionError):
        return None
