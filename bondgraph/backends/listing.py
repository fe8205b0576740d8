"""Statements and members as lines of code, each with where it comes from, none too long."""

from __future__ import annotations

import re
import textwrap
from collections.abc import Iterable
from pathlib import PurePosixPath

from bondgraph.backends.target import Target
from bondgraph.text.source import Span

_BREAK = re.compile(r" (?=[+\-*/?:&|<=]|and |or |if |else )|(?<=,) ")
_COMMENT_LINES = 8


def place(origin: Span | None) -> str:
    """`khepera.bg:26`: the line of the model, without the folder that the model was read from."""
    if origin is None:
        return ""
    return f"{PurePosixPath(origin.source.path.replace(chr(92), '/')).name}:{origin.line}"


def words(*parts: str) -> str:
    """The parts that are not empty, joined by `: `."""
    return ": ".join(p for p in parts if p)


def harmless(text: str, target: Target) -> str:
    """Text of the model made fit for a comment: one line, nothing that ends or extends it."""
    text = "".join(c if c.isprintable() else " " for c in " ".join(text.split()))
    for bad, good in target.statements.unforeseen:
        while bad in text:
            text = text.replace(bad, good)
    return text


def comment(text: str, target: Target, indent: int) -> list[str]:
    """The lines of a comment; one that goes on for ever is cut short."""
    space = " " * indent
    frame = target.statements.comment
    width = target.width - indent - len(frame) + 3
    lines = textwrap.wrap(harmless(text, target), width, break_on_hyphens=False) or [""]
    if len(lines) > _COMMENT_LINES:
        lines[_COMMENT_LINES:] = ["..."]
    return [space + frame.format(line) for line in lines]


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
        inner = _fill(value, deeper, deeper, target.width)
        return [space + before + opening, *inner, space + closing + after]
    return _fill(whole, space, deeper, target.width)


def _fill(text: str, first: str, rest: str, width: int) -> list[str]:
    """Lines of at most `width` where that is possible, broken as far out in the text as can be."""
    lines: list[str] = []
    lead = first
    while len(lead + text) > width:
        room = width - len(lead)
        best, depth_of_best = -1, 10**9
        for at, depth in _places(text):
            if at > room and best >= 0:
                break
            if depth < depth_of_best or (depth == depth_of_best and at <= room):
                best, depth_of_best = at, depth
        if best < 0:
            break
        lines.append(lead + text[:best].rstrip())
        text, lead = text[best:].lstrip(), rest
    return [*lines, lead + text]


def _places(text: str) -> Iterable[tuple[int, int]]:
    """Where a line may end, and how deep in brackets that is; a product counts as deeper."""
    starts = {m.start() for m in _BREAK.finditer(text)}
    depth = 0
    for at, letter in enumerate(text):
        if letter in "([{":
            depth += 1
        elif letter in ")]}":
            depth -= 1
        elif letter == " " and at in starts and at > 0:
            yield at, 2 * depth + (text[at + 1] in "*/")


def table(items: Iterable[str], target: Target, indent: int) -> list[str]:
    """Short items separated by commas, as many a line as fit."""
    return textwrap.wrap(
        ", ".join(items),
        target.width,
        initial_indent=" " * indent,
        subsequent_indent=" " * indent,
        break_long_words=False,
        break_on_hyphens=False,
    )


def members(
    declarations: Iterable[tuple[str, str]], target: Target, indent: int
) -> list[str]:
    """Declarations with their comments beside them, or above where that is too long."""
    pairs = [(d, harmless(c, target)) for d, c in declarations]
    column = max([len(d) for d, _ in pairs if len(d) <= 40], default=0) + 2
    lines: list[str] = []
    for declaration, text in pairs:
        beside = " " * indent + declaration.ljust(column - 2) + "  "
        beside += target.statements.comment.format(text)
        if text and len(beside) <= target.width:
            lines.append(beside)
        else:
            lines += comment(text, target, indent) if text else []
            lines.append(" " * indent + declaration)
    return lines
