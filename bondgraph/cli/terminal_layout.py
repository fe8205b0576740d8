"""Long formulas and tables laid out for a terminal."""

from __future__ import annotations

import shutil
import textwrap
from itertools import compress
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterable

    from bondgraph.ir.signature_matrix import SignatureMatrix

_NARROW, _WIDE = 60, 100


def width() -> int:
    """Characters in a line of output: those of the terminal, between 60 and 100."""
    return max(_NARROW, min(_WIDE, shutil.get_terminal_size((_WIDE, 24)).columns))


def formula(text: str, columns: int, first: str = "", rest: str = "") -> list[str]:
    """A formula broken before its outermost plus and minus signs.

    `first` leads the first line and `rest` the others, which are indented by how deep in
    parentheses the break is. A part that cannot be broken stays longer than `columns`.

    >>> formula("a*(b + c) - (d + e)", 12)
    ['a*(b + c)', '- (d + e)']
    """
    lines: list[str] = []
    lead, depth = first, 0
    while len(lead) + len(text) > columns:
        at, deeper = _break(text, max(columns - len(lead), 1))
        if at <= 0:
            break
        lines.append((lead + text[:at]).rstrip())
        text = text[at:].lstrip()
        depth += deeper
        lead = rest + "  " * max(depth, 0)
    return [*lines, lead + text]


def _break(text: str, room: int) -> tuple[int, int]:
    """Where to break a text so that the first piece fits, and how deep in parentheses that is."""
    depth, best, best_depth = 0, -1, 10**9
    for i, character in enumerate(text):
        if i > room and best > 0:
            break
        if character in "([":
            depth += 1
        elif character in ")]":
            depth -= 1
        elif character == " " and text[i + 1 : i + 3] in ("+ ", "- ") and i > 0:
            # The outermost place wins, and of two equal ones the later, unless it is very early.
            rank = depth + (4 if i < room // 4 else 0)
            if rank <= best_depth:
                best, best_depth = i, rank
                deeper = depth
    return (best, deeper) if best > 0 else (-1, 0)


def names(items: Iterable[str], columns: int, lead: str = "  ") -> list[str]:
    """Names with commas, as many to a line as fit; later lines are indented like the first."""
    lines: list[str] = []
    line = lead
    empty = True
    for item in items:
        piece = item if empty else f", {item}"
        if not empty and len(line) + len(piece) + 1 > columns:
            lines.append(line + ",")
            line, piece = " " * len(lead), item
        line += piece
        empty = False
    return [*lines, line]


def prose(text: str, columns: int, lead: str) -> list[str]:
    """A sentence broken between words, every line behind the same lead.

    >>> prose("as long as it is", 10, "  ")
    ['  as long', '  as it is']
    """
    lines = textwrap.wrap(text, columns, break_long_words=False, break_on_hyphens=False,
                          initial_indent=lead, subsequent_indent=lead)  # fmt: skip
    return lines or [lead]


def signature_table(matrix: SignatureMatrix, columns: int) -> list[str]:
    """The detectable faults with the residuals that see them; equal signatures stand together.

    Mb says that a fault can be detected, Ib that it can be told apart from all others. A table
    wider than two lines of output cannot be read; its signatures are listed by name instead.
    """
    longest = max([5, *(len(f) for f in matrix.faults)])
    cells = [max(3, len(r)) for r in matrix.residuals]
    blocks = [list(group) for group in matrix.groups]
    if longest + sum(cells) + 2 * len(cells) > 2 * columns:
        return _listed_signatures(matrix, blocks, columns)
    head = "  ".join(r.rjust(w) for r, w in zip(matrix.residuals, cells, strict=True))
    lines = [f"  {'':{longest}}  {head}   Mb  Ib"]
    if matrix.undetectable:
        blocks.append(list(matrix.undetectable))
    for block in blocks:
        for fault in block:
            row = matrix.row(fault)
            marks = "  ".join(
                ("1" if hit else ".").rjust(w) for hit, w in zip(row, cells, strict=True)
            )
            detected, alone = int(any(row)), int(any(row) and len(block) == 1)
            lines.append(f"  {fault:{longest}}  {marks}   {detected:2}  {alone:2}")
        if block is not blocks[-1]:
            lines.append("")
    return lines


def _listed_signatures(
    matrix: SignatureMatrix, groups: list[list[str]], columns: int
) -> list[str]:
    """The faults of each group above the residuals that see them."""
    rows = dict(zip(matrix.faults, matrix.rows, strict=True))
    lines = []
    for group in groups:
        lines += names(group, columns)
        lines += names(compress(matrix.residuals, rows[group[0]]), columns, "      seen by ")
    return lines
