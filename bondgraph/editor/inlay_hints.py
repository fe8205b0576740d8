"""What the text does not say and the compiler knows: units that follow, and causal strokes."""

from __future__ import annotations

from collections.abc import Iterator

from bondgraph.editor.flat_facts import FlatFacts, unit_of
from bondgraph.editor.hover import stroke_told
from bondgraph.editor.workspace import Document
from bondgraph.ir.syntax import Input, Let, Number, Param, Sensor
from bondgraph.text.tuples import NamedTuple


class Hint(NamedTuple):
    """A few letters that are shown at a place of the text, and why."""

    offset: int
    text: str
    why: str


def hints(document: Document, start: int, end: int) -> list[Hint]:
    """The hints between two places; none while the text has mistakes."""
    facts = document.facts
    if facts.names is not document.names:
        return []
    found = [*_units(document, facts), *_strokes(facts, document)]
    return sorted(h for h in found if start <= h.offset <= end)


def _units(document: Document, facts: FlatFacts) -> Iterator[Hint]:
    for model in document.names.models.values():
        for declared in model.values.values():
            statement = declared.statement
            if isinstance(statement, Param):
                value = statement.value
                open_ = statement.unit is None and (
                    not isinstance(value, Number) or value.unit is None
                )
            else:
                open_ = isinstance(statement, (Let, Sensor, Input)) and (
                    getattr(statement, "unit", None) is None
                )
            if isinstance(statement, Input) and statement.boolean:
                continue
            units = {unit_of(q) for q in facts.quantities.get(declared.symbol, ())} - {None, "1"}
            if open_ and len(units) == 1:
                unit = units.pop()
                yield Hint(declared.span.end, f" : {unit}", "the unit that follows from its use")


def _strokes(facts: FlatFacts, document: Document) -> Iterator[Hint]:
    """A bar at the end of each arrow that has the causal stroke, where all parts agree."""
    for (start, end), bonds in facts.arrows.items():
        ends = {causal.strokes[bond.number].at for causal, bond in bonds}
        if len(ends) != 1:
            continue
        forward = not document.source.text.startswith("<", start)
        right = (ends.pop() == "head") == forward
        why = stroke_told(*bonds[0])
        yield Hint(end if right else start, "|", why)
