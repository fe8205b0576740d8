"""What would mend units that disagree: changes of the text, each tried before it is proposed.

A stiffness where a compliance belongs, two quantities that were exchanged, and `W/m^2.K` for
`W/m^2/K`, show as units that disagree somewhere else. Where they come from is found by trying.
"""

from __future__ import annotations

import itertools
import re
from collections.abc import Callable, Iterator

from bondgraph.ir.syntax import File, Model, Number, Param, Ref
from bondgraph.library.units import describe, parse_unit
from bondgraph.passes.elaboration.files import nodes_of, statements_of
from bondgraph.text.diagnostic import Diagnostic, Edit
from bondgraph.text.source import Span

CODE = "unit-mismatch"
#: A change of the text, and what it is in words.
Mend = tuple[str, Edit]
#: Changes that are tried, and pairs of changes; each costs another elaboration.
_TRIED = 3
#: Letters of a text that is tried with changes: a larger one would take too long.
_LETTERS = 100_000
#: And with two changes at once, for which more is tried.
_LETTERS_OF_TWO = 20_000


def unit_mends(
    file: File, diagnostics: list[Diagnostic], findings: Callable[[str], list[str]]
) -> list[Diagnostic]:
    """The diagnostics, those about units with the change that mends them, where there is one.

    `findings` says in which units of a text disagree. Where no change mends them all, two are tried
    together; a finding then gets the one that takes it away.
    """
    wrong = [d for d in diagnostics if d.code == CODE]
    source = file.origin.source
    if not wrong or len(source.text) > _LETTERS:
        return diagnostics
    places = {s for d in wrong for s, _ in d.labels if s.source is source}
    sides = [set(d.message.rpartition(": ")[2].rstrip(".").split(" against ")) for d in wrong]
    first = list(itertools.islice(_candidates(file, places, sides), _TRIED))
    left = [findings(changed(source.text, edit)) for _, edit in first]
    for found, (words, edit) in zip(left, first, strict=True):
        if not found:
            return [_with(d, words, edit) if d.code == CODE else d for d in diagnostics]
    if len(source.text) > _LETTERS_OF_TWO:
        return diagnostics
    for one, other in itertools.islice(_pairs(first, list(_compliances(file))), _TRIED):
        both = Edit(f"{one[1].title} and {other[1].title}", one[1].changes + other[1].changes)
        if not findings(changed(source.text, both)):
            alone = [(m, findings(changed(source.text, m[1]))) for m in (one, other)]
            together = f"{one[0]} {other[0]}", both
            return [
                _with(d, *_own(d, alone, together)) if d.code == CODE else d for d in diagnostics
            ]
    return diagnostics


def _pairs(first: list[Mend], more: list[Mend]) -> Iterator[tuple[Mend, Mend]]:
    """Two changes of different places, one of which at least is of what the findings name."""
    for one, other in [*itertools.product(first, more), *itertools.combinations(first, 2)]:
        if not {span for span, _ in one[1].changes} & {span for span, _ in other[1].changes}:
            yield one, other


def _own(
    diagnostic: Diagnostic, alone: list[tuple[Mend, list[str]]], together: Mend
) -> Mend:
    """Of two changes that mend all together the one that takes this finding away, if it is one."""
    able = [mend for mend, left in alone if diagnostic.message not in left]
    return able[0] if len(able) == 1 else together


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
) -> Iterator[Mend]:
    """Changes of what the findings name, the likeliest first; `sides` are the units that differ."""
    params: list[tuple[Param, Number]] = []
    for model in file.models:
        own = [(s, n) for s, n in _quantities(model) if n.origin in places]
        yield from _below([n for _, n in own])
        yield from _inverted(model, {s.name.name for s, _ in own})
        yield from (m for at, m in _inverted_numbers(model) if at & places)
        params += own
    for model in file.models:
        yield from _turned(model)
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


def _below(numbers: list[Number]) -> Iterator[Mend]:
    """All that follows a `/` below the line, in units that go on with a `.` there."""
    for number in numbers:
        unit = number.unit or ""
        above, _, rest = unit.partition("/")
        if "." not in rest:
            continue
        new = f"{above}/{rest.replace('.', '/')}"
        written = number.origin.text.replace(unit, new)
        words = (
            f"A unit is read from left to right: `{unit}` multiplies by all that a `.` stands "
            f"before. What is below the line has a `/` each: `{new}`."
        )
        yield words, Edit(f"write `{new}`", ((number.origin, written),))


def _compliances(file: File) -> Iterator[Mend]:
    """The inverse for each param that is the value of a C."""
    for model in file.models:
        yield from _inverted(model, {s.name.name for s, _ in _quantities(model)})
        yield from (m for _, m in _inverted_numbers(model))


def _inverted(model: Model, params: set[str]) -> Iterator[Mend]:
    """The inverse for those of these params that are the value of a C."""
    for node in nodes_of(model.body):
        value = node.value
        plain = isinstance(value, Ref) and len(value.parts) == 1
        name = value.parts[0].name if isinstance(value, Ref) else node.name.name
        if node.type == "C" and name in params and (plain or (value is None and not node.law)):
            yield _stiffness(node.origin, node.name.origin, value and value.origin, f"1/{name}")


def _inverted_numbers(model: Model) -> Iterator[tuple[set[Span], Mend]]:
    """The inverse of each number that is the value of a C, and where it stands."""
    for node in nodes_of(model.body):
        value = node.value
        if node.type == "C" and isinstance(value, Number) and value.unit is not None:
            new = f"1/({value.origin.text})"
            places = {node.origin, value.origin}
            yield places, _stiffness(node.origin, node.name.origin, value.origin, new)


def _turned(model: Model) -> Iterator[Mend]:
    """The relation of a transformer by a param with a unit, its two sides exchanged."""
    units = {s.name.name for s, n in _quantities(model) if _measures(n) != "1"}
    for node in nodes_of(model.body):
        if node.type not in ("TF", "MTF") or node.law is None or len(node.law.equations) != 1:
            continue
        origin = node.law.equations[0].origin
        written = origin.text
        if not units & {*re.findall(r"\w+", written)}:
            continue
        other = re.sub(r"\b([ef])([12])\b", lambda f: f"{f[1]}{3 - int(f[2])}", written)
        name = f"{node.type}:{node.name.name}"
        words = f"The units agree if `{name}` is turned round: `{{ {other} }}`."
        yield words, Edit(f"write `{other}`", ((origin, other),))


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


def _stiffness(node: Span, name: Span, value: Span | None, new: str) -> Mend:
    """The inverse `new` for the value of a C."""
    change = (Span(name.source, name.end, name.end), f" = {new}") if value is None else (value, new)
    written = f"{node.source.text[node.start : name.end]} = {new}"
    what = new.removeprefix("1/").strip("()")
    words = (
        f"`{what}` has the unit of a stiffness, and the value of a C is a compliance: write "
        f"`{written}`."
    )
    return words, Edit(f"write `{written}`", (change,))


def _exchanged(one: Param, first: Number, other: Param, second: Number) -> Mend:
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
