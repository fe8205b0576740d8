"""Places of a text as editors count them: lines from 0, and columns in units of an encoding."""

from __future__ import annotations

from typing import Literal

from bondgraph.text.source import Source, Span
from bondgraph.text.tuples import NamedTuple

Encoding = Literal["utf-8", "utf-16", "utf-32"]


class Place(NamedTuple):
    """A line and a column, both from 0; the column in units of the encoding."""

    line: int
    column: int


def place_of(source: Source, offset: int, encoding: Encoding = "utf-16") -> Place:
    """Where a character stands.

    >>> place_of(Source("a.bg", "a\\n𝛺𝛺x"), 4)
    Place(line=1, column=4)
    """
    offset = min(max(offset, 0), len(source.text))
    line, column = source.position(offset)
    before = source.text[offset - column + 1 : offset]
    return Place(line - 1, len(before) if before.isascii() else _units(before, encoding))


def offset_of(source: Source, place: Place, encoding: Encoding = "utf-16") -> int:
    """The character at a place; the nearest there is where the text has no such place.

    >>> offset_of(Source("a.bg", "a\\n𝛺𝛺x"), Place(1, 4))
    4
    >>> offset_of(Source("a.bg", "a"), Place(7, 0))
    1
    """
    text = source.text
    if place.line < 0:
        return 0
    if place.line >= source.lines:
        return len(text)
    line = source.line(place.line + 1)
    start = source.start(place.line + 1)
    if line.isascii():
        return start + min(max(place.column, 0), len(line))
    left = place.column
    for number, character in enumerate(line):
        if left <= 0:
            return start + number
        left -= _units(character, encoding)
    return start + len(line)


def _units(text: str, encoding: Encoding) -> int:
    if encoding == "utf-32":
        return len(text)
    if encoding == "utf-16":
        return len(text) + sum(c > "\uffff" for c in text)
    return len(text.encode(errors="surrogatepass"))


def extent(span: Span, encoding: Encoding = "utf-16") -> tuple[Place, Place]:
    """Where a span begins and where it ends."""
    end = max(span.start, span.end)
    return place_of(span.source, span.start, encoding), place_of(span.source, end, encoding)
