"""Guesses from the indentation which brace was left open."""

from __future__ import annotations

from bondgraph.text.source import Source


def suspect(
    source: Source, words: list[str], starts: list[int], fresh: list[bool], opening: int, end: int
) -> int | None:
    """The brace between `opening` and `end` whose `}` stands further left than its line begins.

    The author closed an outer brace there: the inner one was forgotten. None if no brace looks so.
    """
    pending: list[int] = []
    for at in range(opening + 1, end):
        if words[at] == "{":
            pending.append(at)
        elif words[at] == "}":
            if not pending:
                return None
            opened = pending.pop()
            outer = fresh[at] and _indent(source, starts[at]) < _indent(source, starts[opened])
            if outer:
                return opened
    return None


def _indent(source: Source, offset: int) -> int:
    begin = source.text.rfind("\n", 0, offset) + 1
    line = source.text[begin:offset]
    return len(line) - len(line.lstrip(" \t"))
