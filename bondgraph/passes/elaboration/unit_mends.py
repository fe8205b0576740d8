"""What would mend units that disagree: changes of the text, each tried before it is proposed.

A stiffness where a compliance belongs, and two quantities that were exchanged, show as units that
disagree somewhere else. Where they come from is found by trying.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator

from bondgraph.ir.syntax import File, Model, Number, Param, Ref
from bondgraph.library.units import describe, parse_unit
from bondgraph.passes.elaboration.files import nodes_of, statements_of
from bondgraph.text.diagnostic import Diagnostic, Edit
from bondgraph.text.source import Span

CODE = "unit-mismatch"
#: Changes that are tried; each costs another elaboration.
_TRIED = 3
#: Letters of a text that is tried with changes: a larger one would take too long.
_LETTERS = 100_000


def unit_mends(
    file: File, diagnostics: list[Diagnostic], holds: Callable[[str], bool]
) -> list[Diagnostic]:
    """The diagnostics, those about units with the change that mends them all, where there is one.

    `holds` says whether the units of a text agree.
    """
    wrong = [d for d in diagnostics if d.code == CODE]
    source = file.origin.source
    if not wrong or len(source.text) > _LETTERS:
        return diagnostics
    places = {s for d in wrong for s, _ in d.labels if s.source is source}
    sides = [set(d.message.rpartition(": ")[2].rstrip(".").split(" against ")) for d in wrong]
    for number, (words, edit) in enumerate(_candidates(file, places, sides)):
        if number >= _TRIED:
            break
        if holds(changed(source.text, edit)):
            return [_with(d, words, edit) if d.code == CODE else d for d in diagnostics]
    return diagnostics


def changed(text: str, edit: Edit) -> str:
    """A text with a change made.

    >>> from bondgraph.text.source import Source
    >>> changed("a b", Edit("", ((Span(Source("a", "a b"), 0, 1), "x"),)))
    'x b'
    """
    for (_, start, end), new in sorted(edit.changes, key=lambda c: c[0][1], reverse=True):
        text = text[:start] + new + text[end:]
    return text


def _with(diagnostic: Diagnostic, words: str, edit: Edit) -> Diagnostic:
    return diagnostic._replace(help=words, edits=(*diagnostic.edits, edit))


def _candidates(
    file: File, places: set[Span], sides: list[set[str]]
) -> Iterator[tuple[str, Edit]]:
    """Changes of what the findings name, the likeliest first; `sides` are the units that differ."""
    params: list[tuple[Param, Number]] = []
    for model in file.models:
        own = {s.name.name: (s, n) for s, n in _quantities(model) if n.origin in places}
        for node in nodes_of(model.body):
            value = node.value
            plain = isinstance(value, Ref) and len(value.parts) == 1
            name = value.parts[0].name if isinstance(value, Ref) else node.name.name
            if node.type == "C" and name in own and (plain or (value is None and not node.law)):
                yield _stiffness(node.origin, node.name.origin, value and value.origin, name)
        params += own.values()
    for i, (one, first) in enumerate(params):
        for other, second in params[i + 1 :]:
            if _measures(first) != _measures(second):
                yield _exchanged(one, first, other, second)
    for model in file.models:
        every = _quantities(model)
        named = [p for p in every if p[1].origin in places]
        for other, second in [p for p in every if p[1].origin not in places]:
            for one, first in named:
                if {_measures(first), _measures(second)} in sides:
                    yield _exchanged(one, first, other, second)


def _quantities(model: Model) -> list[tuple[Param, Number]]:
    """The params of a model that are numbers with a unit."""
    return [
        (s, s.value)
        for s in statements_of(model.body)
        if isinstance(s, Param) and isinstance(s.value, Number) and s.value.unit is not None
    ]


def _measures(number: Number) -> str:
    """What the unit of a quantity measures, as findings say it."""
    unit = parse_unit(number.unit or "")
    return "" if unit is None else describe(unit.dimension)


def _stiffness(node: Span, name: Span, value: Span | None, param: str) -> tuple[str, Edit]:
    """1/k for the k of a C."""
    new = f"1/{param}"
    change = (Span(name.source, name.end, name.end), f" = {new}") if value is None else (value, new)
    written = f"{node.source.text[node.start : name.end]} = {new}"
    words = (
        f"`{param}` has the unit of a stiffness, and the value of a C is a compliance: write "
        f"`{written}`."
    )
    return words, Edit(f"write `{written}`", (change,))


def _exchanged(one: Param, first: Number, other: Param, second: Number) -> tuple[str, Edit]:
    """Two quantities in each other's place."""
    a, b = first.origin.text, second.origin.text
    edit = Edit(
        f"exchange {a} and {b}", ((first.origin, b), (second.origin, a))
    )
    words = (
        f"The units agree if `{one.name.name}` and `{other.name.name}` are exchanged: "
        f"`{one.name.name} = {b}` and `{other.name.name} = {a}`."
    )
    return words, edit
