"""A line above each model and sensor: how many residuals there are, and which see it."""

from __future__ import annotations

from collections.abc import Iterator

from bondgraph.editor.residual_facts import ResidualFacts
from bondgraph.editor.workspace import Document
from bondgraph.text.numerals import listed
from bondgraph.text.source import Span
from bondgraph.text.tuples import NamedTuple


class Lens(NamedTuple):
    """A line of text above a place."""

    span: Span
    text: str


def lenses(document: Document, residuals: ResidualFacts | None) -> Iterator[Lens]:
    """What the residuals are, above what they are about; nothing until they are known."""
    if residuals is None:
        return
    facts = document.facts
    for model in document.names.models.values():
        summary = residuals.summary(model.model.name)
        if summary:
            yield Lens(model.declaration.span, summary)
        for declared in model.values.values():
            if declared.kind != "sensor":
                continue
            names = [q.name for q in facts.quantities.get(declared.symbol, ())]
            seen = [residuals.seen_by(name) for name in names]
            known = [r for found in seen if found is not None for r in found]
            if known:
                told = listed(list(dict.fromkeys(known)), "and", 6)
                yield Lens(declared.span, f"a fault of this sensor moves {told}")
            elif any(found is not None for found in seen):
                yield Lens(declared.span, "no residual sees a fault of this sensor")
