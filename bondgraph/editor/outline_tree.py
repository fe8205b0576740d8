"""The outline of a file: its models, what each declares, and where."""

from __future__ import annotations

from bondgraph.editor.hover import WORDS
from bondgraph.editor.occurrences import Declaration, FileNames
from bondgraph.text.source import Span
from bondgraph.text.tuples import NamedTuple


class Entry(NamedTuple):
    """Something declared: its name, what it is, all of its text, its name in it, its parts."""

    name: str
    kind: str
    detail: str
    whole: Span
    own: Span
    inner: tuple[Entry, ...] = ()


def outline(names: FileNames) -> tuple[Entry, ...]:
    """The models of a file, each with its ports, nodes and values in the order of the text."""
    found = []
    for model in names.models.values():
        tables = (model.nodes, model.values, model.faults)
        declared = {d.span.start: d for table in tables for d in table.values()}
        parts = tuple([_entry(declared[start]) for start in sorted(declared)])
        own = model.declaration
        found.append(Entry(own.symbol.name, "model", _first(own.doc), model.model.origin,
                           own.span, parts))  # fmt: skip
    return tuple(found)


def _entry(declared: Declaration) -> Entry:
    detail = declared.type or WORDS[declared.kind].split(":")[0]
    whole = declared.statement.origin
    if not whole.start <= declared.span.start <= declared.span.end <= whole.end:
        whole = declared.span
    return Entry(declared.span.text, declared.kind, detail, whole, declared.span)


def _first(doc: str) -> str:
    return doc.split("\n", 1)[0]
