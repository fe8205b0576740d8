"""Diagnostics as a person reads them in a terminal, and as a program reads them."""

from __future__ import annotations

from bisect import bisect_left
from collections.abc import Iterable, Iterator, Sequence
from functools import lru_cache

from bondgraph.text.diagnostic import Diagnostic, Label
from bondgraph.text.source import Source, Span
from bondgraph.text.tuples import NamedTuple

_WIDTH = 100  # of a source line and of running text
_TAB = 4
_COLOURS = {"error": "1;31", "warning": "1;33", "info": "1;36", "frame": "1;34", "bold": "1"}


class _Mark(NamedTuple):
    """A label inside one line: characters `start` to `end` of it."""

    start: int
    end: int
    primary: bool
    text: str


class _Line(NamedTuple):
    """A source line made fit to print: one cell a character, and where each cell begins."""

    cells: list[str]
    columns: list[int]


def render(diagnostics: Iterable[Diagnostic], color: bool) -> str:
    """Diagnostics with their source lines, one after the other, for a terminal.

    Nothing of the source reaches the terminal unprinted: control characters come out as U+FFFD.
    Ends with a newline unless there is nothing to say.
    """
    painter = _Painter(color)
    return "\n".join([painter.diagnostic(d) for d in diagnostics])


def as_json(diagnostics: Iterable[Diagnostic]) -> list[dict[str, object]]:
    """Diagnostics as plain data: {code, severity, message, labels, help, edits}.

    A label is {path, line, column, end_line, end_column, text}. Lines and columns count from 1,
    columns in characters; the end is the place behind the last character. The first label is the
    primary place. An edit is {title, changes}, a change a place with the text to put there.
    """
    return [
        {
            "code": d.code,
            "severity": d.severity,
            "message": d.message,
            "labels": [{**place(label.span), "text": label.text} for label in d.labels],
            "help": d.help,
            "edits": [
                {
                    "title": edit.title,
                    "changes": [{**place(span), "text": text} for span, text in edit.changes],
                }
                for edit in d.edits
            ],
        }
        for d in diagnostics
    ]


def place(span: Span) -> dict[str, object]:
    """Where a span is, as plain data: path, line, column, end_line, end_column."""
    source, start, end = _clamped(span)
    line, column = source.position(start)
    end_line, end_column = source.position(end)
    return {
        "path": source.path,
        "line": line,
        "column": column,
        "end_line": end_line,
        "end_column": end_column,
    }


def _clamped(span: Span) -> Span:
    size = len(span.source.text)
    start = min(max(span.start, 0), size)
    return Span(span.source, start, min(max(span.end, start), size))


class _Painter:
    """Draws diagnostics; keeps the colours and the width of the line numbers."""

    def __init__(self, color: bool) -> None:
        self.color = color
        self.gutter = ""

    def paint(self, text: str, colour: str) -> str:
        return f"\033[{_COLOURS[colour]}m{text}\033[0m" if self.color and text else text

    def diagnostic(self, diagnostic: Diagnostic) -> str:
        """One diagnostic: headline, places, remedy."""
        severity = diagnostic.severity
        head = {"info": "note"}.get(severity, severity) + f"[{diagnostic.code}]"
        message = _wrapped(diagnostic.message, 4, len(head) + 2)
        out = [self.paint(head, severity) + self.paint(f": {message[0]}", "bold")]
        out += [self.paint(line, "bold") for line in message[1:]]
        labels = [Label(_clamped(s), text) for s, text in diagnostic.labels]
        lines = [label.span.source.position(label.span.end)[0] for label in labels]
        self.gutter = " " * len(str(max(lines, default=1)))
        for number, (source, group) in enumerate(_by_source(labels)):
            arrow = ":::" if number else "-->"
            place = f"{_clean(source.path)}:{group[0].span.line}:{group[0].span.column}"
            out.append(f"{self.gutter}{self.paint(arrow, 'frame')} {place}")
            out.append(self.row())
            primary = labels[0] if not number else None
            out += self.snippet(source, group, primary, severity)
        if diagnostic.help:
            if labels:
                out.append(self.row())
            sign = f"{self.gutter} {self.paint('=', 'frame')} " if labels else "  = "
            indent = len(self.gutter) + 9
            for line in _wrapped(diagnostic.help, indent, indent):
                out.append(sign + self.paint("help", "bold") + ": " + line if sign else line)
                sign = ""
        return "\n".join(line.rstrip() for line in out) + "\n"

    def row(self, text: str = "", number: int | str = "") -> str:
        """A line of the snippet: number, bar, text."""
        digits = f"{number:>{len(self.gutter)}}"
        return f"{self.paint(f'{digits} |', 'frame')} {text}"

    def snippet(
        self, source: Source, labels: Sequence[Label], primary: Label | None, severity: str
    ) -> Iterator[str]:
        """The lines that the labels of one source stand on, with marks below them."""
        single: dict[int, list[_Mark]] = {}
        long: dict[int, list[Label]] = {}
        for label in labels:
            first, column = source.position(label.span.start)
            last = source.position(max(label.span.end - 1, label.span.start))[0]
            if first == last:
                size = max(label.span.end - label.span.start, 1)
                mark = _Mark(column - 1, column - 1 + size, label is primary, label.text)
                single.setdefault(first, []).append(mark)
            else:
                long.setdefault(first, []).append(label)
        before: int | None = None
        for number in sorted({*single, *long}):
            if before is not None and number > before + 1:
                if number == before + 2:
                    yield self.row(self.plain(source, before + 1), before + 1)
                else:
                    yield self.paint("...", "frame")
            if number in single:
                yield from self.marked(source, number, single[number], severity)
                before = number
            for label in long.get(number, ()):
                yield from self.barred(source, label, label is primary, severity)
                before = source.position(label.span.end)[0]

    def plain(self, source: Source, number: int) -> str:
        line = _fit(source.line(number))
        return _cut(line, 0)[0]

    def marked(
        self, source: Source, number: int, marks: list[_Mark], severity: str
    ) -> Iterator[str]:
        """A source line with marks; shown once for all marks if they fit, else once for each."""
        line = _fit(source.line(number))
        size = len(line.cells)
        marks = [m._replace(start=min(m.start, size), end=min(m.end, size + 1)) for m in marks]
        start = min(m.start for m in marks)
        shown, shift, end = _cut(line, start)
        if len(marks) > 1 and any(m.start >= end for m in marks):
            for mark in sorted(marks, key=lambda m: not m.primary):
                yield from self.marked(source, number, [mark], severity)
            return
        yield self.row(shown, number)
        placed = []
        for mark in marks:
            left = line.columns[mark.start] + shift
            right = max(line.columns[min(mark.end, end)] + shift, left + 1)
            placed.append(mark._replace(start=left, end=right))
        yield from map(self.row, self.underlined(placed, severity))

    def underlined(self, marks: list[_Mark], severity: str) -> Iterator[str]:
        """The rows below a source line: the marks, then their texts from right to left."""
        pen: dict[int, tuple[str, str]] = {}
        for mark in sorted(marks, key=lambda m: m.primary):
            style = ("^", severity) if mark.primary else ("-", "frame")
            for column in range(mark.start, mark.end):
                pen[column] = style
        row = self.drawn(pen)
        texts = sorted((m for m in marks if m.text), key=lambda m: (m.start, not m.primary))
        if texts and texts[-1].end >= max(m.end for m in marks):
            last = texts.pop()
            row += " " + self.paint(_clean(last.text), self.style(last, severity))
        yield row
        if texts:
            yield self.drawn({m.start: ("|", self.style(m, severity)) for m in texts})
        while texts:
            last = texts.pop()
            left = {m.start: ("|", self.style(m, severity)) for m in texts if m.start < last.start}
            text = self.paint(_clean(last.text), self.style(last, severity))
            yield self.drawn(left, last.start) + text

    def barred(self, source: Source, label: Label, primary: bool, severity: str) -> Iterator[str]:
        """A span of several lines: its first and last ones along a bar."""
        style = severity if primary else "frame"
        first = label.span.line
        last, column = source.position(label.span.end - 1)
        bar = self.paint("|", style)
        for number in range(first, last + 1):
            if first + 1 < number < last - 1:
                if number == first + 2:
                    yield self.paint("...", "frame") + " " * len(self.gutter) + bar
                continue
            sign = self.paint("/", style) if number == first else bar
            yield self.row(f"{sign} {self.plain(source, number)}", number)
        line = _fit(source.line(last))
        width = min(line.columns[min(column - 1, len(line.cells))], _WIDTH)
        mark = "|_" + "_" * width + ("^" if primary else "-")
        yield self.row(self.paint(f"{mark} {_clean(label.text)}".rstrip(), style))

    def style(self, mark: _Mark, severity: str) -> str:
        return severity if mark.primary else "frame"

    def drawn(self, pen: dict[int, tuple[str, str]], width: int = 0) -> str:
        """Characters with colours at columns, padded to `width`."""
        out, at = "", 0
        columns = sorted(pen)
        for place, column in enumerate(columns):
            if place and column == columns[place - 1] + 1 and pen[column] == pen[column - 1]:
                continue  # drawn with the one before
            end = column
            while pen.get(end) == pen[column]:
                end += 1
            character, style = pen[column]
            out += " " * (column - at) + self.paint(character * (end - column), style)
            at = end
        return out + " " * (width - at)


def _by_source(labels: list[Label]) -> list[tuple[Source, list[Label]]]:
    groups: dict[str, tuple[Source, list[Label]]] = {}
    for label in labels:
        groups.setdefault(label.span.source.path, (label.span.source, []))[1].append(label)
    return list(groups.values())


@lru_cache(maxsize=2)  # a long line may have hundreds of labels
def _fit(text: str) -> _Line:
    """The cells of a line: tabs as spaces, what cannot be printed as U+FFFD."""
    if text.isascii() and text.isprintable():
        return _Line(list(text), list(range(len(text) + 2)))
    cells: list[str] = []
    columns = [0]
    for character in text:
        at = columns[-1]
        if character == "\t":
            cells.append(" " * (_TAB - at % _TAB))
            columns.append(at + len(cells[-1]))
        else:
            cells.append(_clean(character))
            columns.append(at + _cell_width(cells[-1]))
    columns.append(columns[-1] + 1)
    return _Line(cells, columns)


def _cell_width(character: str) -> int:
    if character.isascii():
        return 1
    from unicodedata import combining, east_asian_width  # only for text beyond ASCII

    if combining(character) or character in "\u200b\u200c\u200d\ufe0e\ufe0f":
        return 0
    return 2 if east_asian_width(character) in "WF" else 1


def _cut(line: _Line, start: int) -> tuple[str, int, int]:
    """At most `_WIDTH` columns of a line that show character `start`.

    Returns the text, by how much columns move in it, and the first character that is not shown.
    """
    cells, columns = line
    size = len(cells)
    if columns[size] <= _WIDTH:
        return "".join(cells), 0, size + 1
    first = 0
    if columns[min(start, size)] > _WIDTH * 3 // 4:
        first = bisect_left(columns, columns[min(start, size)] - _WIDTH // 4)
    end = first
    while end < size and columns[end + 1] - columns[first] <= _WIDTH - 8:
        end += 1
    left, right = "... " if first else "", " ..." if end < size else ""
    shown = left + "".join(cells[first:end]) + right
    return shown, len(left) - columns[first], end if end < size else size + 1


def _clean(text: str) -> str:
    """Text that cannot move the cursor, colour the screen or turn the reading direction."""
    if text.isprintable():
        return text
    return "".join([c if c.isprintable() else "\N{REPLACEMENT CHARACTER}" for c in text])


def _wrapped(text: str, indent: int, first: int) -> list[str]:
    """Running text in lines of `_WIDTH`; the first begins at column `first`, others at `indent`.

    A line that begins with a space is code and stays as it is.
    """
    pad = " " * indent
    out: list[str] = []
    used = first
    for line in map(_clean, text.split("\n")):
        if line[:1] == " ":
            out.append(pad + line)
            used = indent
            continue
        current = ""
        for word in line.split(" "):
            if current and used + len(current) + 1 + len(word) > _WIDTH:
                out.append(pad + current)
                current, used = word, indent
            else:
                current = f"{current} {word}" if current else word
        out.append(pad + current)
        used = indent
    out[0] = out[0].removeprefix(pad)
    return out
