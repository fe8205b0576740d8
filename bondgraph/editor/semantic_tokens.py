"""What each name is, for colours: what a grammar of words cannot know."""

from __future__ import annotations

from collections.abc import Iterator

from bondgraph.editor.occurrences import FileNames
from bondgraph.text.source import Span
from bondgraph.text.tuples import NamedTuple

#: The types of the protocol that are used, in the order of their numbers.
TYPES = (
    "namespace", "class", "struct", "interface", "parameter", "variable", "property", "event",
    "typeParameter", "enumMember",
)  # fmt: skip
MODIFIERS = ("declaration", "readonly")

_TYPE_OF = {
    "model": "class", "instance": "struct", "port": "interface", "param": "parameter",
    "const": "parameter", "input": "event", "let": "variable", "sensor": "property",
    "argument": "typeParameter", "loop": "typeParameter", "fault": "event",
    "signal": "enumMember", "0": "namespace", "1": "namespace",
}  # fmt: skip


class Token(NamedTuple):
    """A name, what it is, and whether it is declared there and cannot change."""

    span: Span
    type: str
    modifiers: tuple[str, ...]


def tokens(names: FileNames) -> Iterator[Token]:
    """The names of a file in the order of the text, none of them over another."""
    end = 0
    for found in names.occurrences:
        if found.span.start < end:
            continue
        end = found.span.end
        modifiers: tuple[str, ...] = ("declaration",) if found.declares else ()
        if found.kind == "const":
            modifiers += ("readonly",)
        yield Token(found.span, _TYPE_OF.get(found.kind, "struct"), modifiers)
