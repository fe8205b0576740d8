"""Guesses from the indentation which brace was left open."""

from __future__ import annotations

from bondgraph.frontend.cursor import Cursor


def suspect(cursor: Cursor, opening: int, end: int) -> int | None:
    """The brace between `opening` and `end` whose `}` stands further left than its line begins.

    The author closed an outer brace there: the inner one was forgotten. None if no brace looks so.
    """
    pending: list[int] = []
    for at in range(opening + 1, end):
        word = cursor.words[at]
        if word == "{":
            pending.append(at)
        elif word == "}":
            if not pending:
                return None
            opened = pending.pop()
            if cursor.fresh[at] and cursor.indent(at) < cursor.indent(opened):
                return opened
    return None
