"""Statements and members as lines of code, each with where it comes from, none too long."""

from __future__ import annotations

import re
import textwrap
from bisect import bisect_right
from collections.abc import Iterable

from bondgraph.backends.target import Target
from bondgraph.text.source import Span

#: A bracket, or a blank where a line may end.
_MARK = re.compile(r"[()\[\]{}]| (?=[+\-*/?:&|<]|and |or |if |else )|(?<=,) ")
_COMMENT_LINES = 8


def place(origin: Span | None) -> str:
    """`khepera.bg:26`: the line of the model, without the folder that the model was read from."""
    if origin is None:
        return ""
    name = origin.source.path.replace("\\", "/").rsplit("/", 1)[-1]
    return f"{name}:{origin.line}"


def words(*parts: str) -> str:
    """The parts that are not empty, joined by `: `."""
    return ": ".join(p for p in parts if p)


def harmless(text: str, target: Target) -> str:
    """Text of the model made fit for a comment: one line, nothing that ends or extends it."""
    text = " ".join(text.split())
    if not text.isprintable():
        text = "".join(c if c.isprintable() else " " for c in text)
    for bad, good in target.statements.unforeseen:
        while bad in text:
            text = text.replace(bad, good)
    return text


def comment(text: str, target: Target, indent: int) -> list[str]:
    """The lines of a comment, paragraph by paragraph; one that goes on for ever is cut short."""
    opening, middle, closing = target.statements.comment
    space = " " * indent
    width = target.width - indent - max(len(opening), len(middle)) - len(closing) - 2
    found: list[str] = []
    for paragraph in text.split("\n"):
        line = harmless(paragraph, target)
        fits = len(line) <= width  # as nearly all do
        lines = [line] * bool(line) if fits else textwrap.wrap(line, width, break_on_hyphens=False)
        if len(lines) > _COMMENT_LINES:
            lines[_COMMENT_LINES:] = ["..."]
        found += lines
    marks = [opening, *[middle] * (len(found) - 1)]
    lines = [f"{space}{mark} {line}" for mark, line in zip(marks, found, strict=True)]
    if closing and lines:
        lines[-1] += f" {closing}"
    return lines


def beside(text: str, target: Target) -> str:
    """A comment on the line of what it is about."""
    opening, _, closing = target.statements.comment
    return f"{opening} {harmless(text, target)} {closing}".rstrip()


def statement(prefix: str, value: str, target: Target, indent: int) -> list[str]:
    """`prefix` with its hole filled by `value`, broken at its outermost operators if too long."""
    space = " " * indent
    whole = prefix.format(value)
    if len(space + whole) <= target.width:
        return [space + whole]
    opening, closing = target.statements.brackets
    deeper = space + " " * target.tab
    before, after = prefix.format("\0").split("\0")
    if opening:
        inner = _fill(value, deeper, deeper, target)
        return [space + before + opening, *inner, space + closing + after]
    return _fill(whole, space, deeper, target)


def _fill(text: str, first: str, rest: str, target: Target) -> list[str]:
    """Lines that fit where that is possible, each broken as far out in the text as can be.

    A line that begins deeper in brackets, or in the middle of a product, stands further right.
    """
    places = _places(text)
    ends = [at for at, _, _ in places]
    lines: list[str] = []
    lead, start, began = first, 0, -2
    while True:
        room = start + target.width - len(lead)
        ahead = bisect_right(ends, start)
        within = places[ahead : bisect_right(ends, room)]
        # a line that began deep in brackets ends where they do
        outer = next((p for p in within if p[1] < began), None)
        if outer is None and len(text) <= room:
            break
        fitting = within or places[ahead : ahead + 1]
        if not fitting:
            break
        least = min(cost for _, cost, _ in fitting)
        at, began, depth = outer or max(p for p in fitting if p[1] == least)
        lines.append(lead + text[start:at].rstrip())
        lead, start = rest + " " * target.tab * min(depth, 5), at + 1
    return [*lines, lead + text[start:]]


def _places(text: str) -> list[tuple[int, int, int]]:
    """Where a line may end, what it costs the reader, and how deep the next line is."""
    found: list[tuple[int, int, int]] = []
    depth = 0
    for mark in _MARK.finditer(text):
        at, letter = mark.start(), mark.group()
        if letter in "([{":
            depth += 1
        elif letter in ")]}":
            depth -= 1
        elif at > 0:
            product, choice = text[at + 1] in "*/", text[at + 1] in "?:"
            found.append((at, 2 * depth + 3 * product - choice, depth + product))
    return found


def table(items: Iterable[str], target: Target, indent: int) -> list[str]:
    """Short items separated by commas, as many a line as fit."""
    return table_lines([", ".join(items)], target, indent)


def table_lines(items: Iterable[str], target: Target, indent: int) -> list[str]:
    """The same for items that bring their comma."""
    lines: list[str] = []
    line: list[str] = []
    room = width = target.width - indent
    for word in " ".join(items).split():
        if len(word) > room and line:
            lines.append(" " * indent + " ".join(line))
            line, room = [], width
        line.append(word)
        room -= len(word) + 1
    return [*lines, " " * indent + " ".join(line)] if line else lines


def members(declarations: Iterable[tuple[str, str]], target: Target, indent: int) -> list[str]:
    """Declarations with their comments beside them, or above where that is too long."""
    pairs = list(declarations)
    short = [d for d, text in pairs if _fits(d, text, target, indent)]
    column = max(map(len, short), default=0) + 2
    lines: list[str] = []
    for declaration, text in pairs:
        line = " " * indent + declaration.ljust(column) + beside(text, target)
        if text and "\n" not in text and len(line) <= target.width:
            lines.append(line)
        else:
            lines += comment(text, target, indent) if text else []
            lines.append(" " * indent + declaration)
    return lines


def _fits(declaration: str, text: str, target: Target, indent: int) -> bool:
    line = f"{declaration}  {beside(text, target)}"
    return "\n" not in text and len(line) + indent <= target.width
