"""What may be written at the cursor: keywords, types, names in scope, ports, units that fit."""

from __future__ import annotations

import re
from collections.abc import Iterator

from bondgraph.editor.flat_facts import dimension_of
from bondgraph.editor.hover import WORDS
from bondgraph.editor.occurrences import Declaration, FileNames, ModelNames
from bondgraph.editor.workspace import Document
from bondgraph.frontend.lexer import split
from bondgraph.frontend.words import KEYWORDS, is_arrow
from bondgraph.ir.syntax import Node, Param
from bondgraph.ir.unit import Dimension
from bondgraph.library.elements import KINDS
from bondgraph.library.units import DOMAINS, describe, parse_unit
from bondgraph.passes.elaboration.calls import names
from bondgraph.text.tuples import NamedTuple

_OPENS = frozenset(["{", "}", ";", ""])
_VALUES = frozenset(
    "= + - * / ^ ( , < > <= >= == != += *= and or not [ .. if when in counts".split()
)
_WORD = re.compile(r"(?:[^\W\d]\w*)?\Z")
#: A number, one space, and what there is of its unit.
_UNIT = re.compile(r"(?<![\w.])[0-9]+(?:\.[0-9]+)?(?:[eE][+-]?[0-9]+)? ([^\W\d][\w./^-]*)?\Z")
_DECLARED = re.compile(r"(?:param|const|input|sensor)\s+(\w+)(?:\[[^\]\n]*\])?\s*:\s*([\w./^-]*)\Z")
_VALUE_OF = re.compile(r"(?:param|const)\s+(\w+)(?:\[[^\]\n]*\])?\s*=[^=\n]*\Z")
_PREFIXED = {
    "A": "mA", "V": "mV kV", "W": "mW kW", "Ohm": "mOhm kOhm", "F": "uF nF pF", "H": "mH uH",
    "N": "kN", "Pa": "kPa bar", "m": "mm", "s": "ms", "kg": "g", "rad": "deg", "rad/s": "rpm",
    "m^3": "l", "m^3/s": "lpm", "K": "degC", "1": "%",
}  # fmt: skip
_USUAL = (
    "V A Ohm H F N m m/s kg N/m N.s/m N.m rad rad/s kg.m^2 N.m/rad N.m.s/rad Pa m^3 m^3/s K W J"
    " s Hz"
)


class Proposal(NamedTuple):
    """One word that may be written; `kind` is as of a declaration, or keyword, unit, function."""

    label: str
    kind: str
    detail: str = ""
    doc: str = ""
    insert: str = ""


def complete(document: Document, offset: int) -> tuple[int, list[Proposal]]:
    """Where the word at the cursor begins, and what it may become."""
    text = document.source.text
    before = text[max(0, offset - 4000) : offset]
    line = before[before.rfind("\n") + 1 :]
    if _in_comment(line):
        return offset, []
    unit = _unit(document, offset, line)
    if unit is not None:
        return unit
    start = offset - len(_match(_WORD, line))
    found = _words(document, start, before[: len(before) - (offset - start)])
    return start, list({p.label: p for p in reversed(list(found))}.values())[::-1]


def _match(pattern: re.Pattern[str], line: str) -> str:
    found = pattern.search(line)
    return found[0] if found else ""


def _in_comment(line: str) -> bool:
    quoted = False
    for character in line:
        if character == '"':
            quoted = not quoted
        elif character == "#" and not quoted:
            return True
    return quoted


def _words(document: Document, start: int, before: str) -> Iterator[Proposal]:
    """Proposals for a word after the words before it."""
    file = document.names
    words = split(before).words[:-3]
    last = words[-1] if words else ""
    model = file.enclosing(start)
    if model is None:
        yield from _outside(file, words, before)
        return
    if last == "." and len(words) > 1:
        yield from _members(file, model, words)
        return
    if last == ":":
        if len(words) > 2 and words[-3] == "port":
            yield from [Proposal(d, "keyword") for d in ("in", "out")]
        return
    if len(words) > 3 and words[-4] == "port" and words[-2] == ":" and last in ("in", "out"):
        yield from _domains()
        return
    if is_arrow(last):
        yield from _nodes(model)
        yield from _types(file)
        return
    if last in _VALUES and not (last == "in" and "port" in words[-4:]):
        yield from _arguments(file, words)
        yield from _values(model)
        yield from _functions()
        yield from _nodes(model)
        return
    fresh = "\n" in before[before.rfind(last) + len(last) :] if last else True
    if last in _OPENS or fresh:
        yield from [Proposal(k, "keyword") for k in sorted(KEYWORDS - {"model", "import"})]
        yield from _types(file)
        yield from _nodes(model)
        return
    yield from [Proposal(k, "keyword") for k in ("when", "counts", "unknown", "and", "or", "else")]


def _outside(file: FileNames, words: list[str], before: str) -> Iterator[Proposal]:
    if not words:
        yield Proposal("bg 1", "keyword", "the edition of the language")
    yield Proposal("model", "keyword", insert="model ")
    yield Proposal("import", "keyword", insert="import ")
    for name in file.known_models:
        yield Proposal(name, "model")


def _types(file: FileNames) -> Iterator[Proposal]:
    for name, words in (("0", WORDS["0"]), ("1", WORDS["1"])):
        yield Proposal(name, "type", words, insert=f"{name}:")
    for keyword, kind in KINDS.items():
        doc = f"`{kind.law}`" if kind.law else ""
        yield Proposal(keyword, "type", WORDS[keyword], doc, f"{keyword}:")
    for name in file.known_models:
        model = file.model(name)
        yield Proposal(name, "model", "model", model.declaration.doc if model else "", f"{name}:")


def _nodes(model: ModelNames) -> Iterator[Proposal]:
    for name, declared in model.nodes.items():
        yield Proposal(name, declared.kind, _detail(declared), declared.doc)


def _detail(declared: Declaration) -> str:
    if declared.kind == "instance":
        return f"submodel {declared.type}"
    return WORDS[declared.kind]


def _values(model: ModelNames) -> Iterator[Proposal]:
    for name, declared in model.values.items():
        yield Proposal(name, declared.kind, _detail(declared), declared.doc)
    for word in ("true", "false"):
        yield Proposal(word, "keyword")


def _functions() -> Iterator[Proposal]:
    for name in (*names(), "if"):
        yield Proposal(name, "function", "function")


def _domains() -> Iterator[Proposal]:
    for name, domain in DOMAINS.items():
        effort = f"{domain.effort_name} {domain.effort_unit}".strip()
        flow = f"{domain.flow_name} {domain.flow_unit}".strip()
        yield Proposal(name, "keyword", f"effort: {effort}, flow: {flow}")


def _path(words: list[str]) -> list[str]:
    """The names of the dotted path that ends with the point at the end of the words."""
    parts: list[str] = []
    at = len(words) - 1
    while at > 0 and words[at] == ".":
        at -= 1
        if words[at] == "]":
            while at > 0 and words[at] != "[":
                at -= 1
            at -= 1
        if at < 0 or not words[at].isidentifier():
            break
        parts.insert(0, words[at])
        at -= 1
    return parts


def _members(file: FileNames, model: ModelNames, words: list[str]) -> Iterator[Proposal]:
    """What can stand after the point: ports, nodes and values of a submodel, signals of a node."""
    inner: ModelNames | None = model
    declared: Declaration | None = None
    for part in _path(words):
        declared = inner.nodes.get(part) if inner is not None else None
        inner = file.opened(declared) if declared is not None else None
    if inner is not None:
        yield from sorted(_nodes(inner), key=lambda p: p.kind != "port")
        yield from [p for p in _values(inner) if p.kind != "keyword"]
    elif declared is not None:
        yield from _signals(declared)


def _signals(declared: Declaration) -> Iterator[Proposal]:
    effort, flow = Proposal("e", "signal", "effort"), Proposal("f", "signal", "flow")
    kind = KINDS.get(declared.kind)
    if kind is None:
        common = [flow, effort] if declared.kind == "1" else [effort, flow]
        yield from common
        return
    law = declared.statement.law if isinstance(declared.statement, Node) else None
    if law is not None:
        yield from [Proposal(p.name, "port", "port of the field") for p in law.ports]
    if len(kind.ports) == 2:
        names = (("e1", "effort"), ("f1", "flow"), ("e2", "effort"), ("f2", "flow"))
        yield from [Proposal(n, "signal", what) for n, what in names]
        return
    yield from (effort, flow)
    for state in kind.states:
        what = "charge, displacement or volume" if state == "q" else "momentum or flux"
        yield Proposal(state, "signal", what)


def _arguments(file: FileNames, words: list[str]) -> Iterator[Proposal]:
    """In the round brackets of a node: what its model leaves open, or its initial state."""
    depth, at = 0, len(words) - 1
    while at >= 0:
        depth += {"(": 1, ")": -1}.get(words[at], 0)
        if depth > 0:
            break
        if words[at] in ("{", "}", ";"):
            return
        at -= 1
    head = words[max(0, at - 12) : max(0, at)]
    if words[-1] not in ("(", ",") or ":" not in head:
        return
    colon = len(head) - 1 - head[::-1].index(":")
    type = head[colon - 1] if colon else ""
    inner = file.model(type)
    if inner is not None:
        for name, declared in inner.values.items():
            if declared.kind in ("param", "const", "input", "argument"):
                yield Proposal(name, declared.kind, _detail(declared), declared.doc, f"{name} = ")
    elif type in KINDS:
        for state in KINDS[type].states:
            yield Proposal(f"{state}0", "signal", "initial state", insert=f"{state}0 = ")


# ------------------------------------------------------------------------ units


def _unit(document: Document, offset: int, line: str) -> tuple[int, list[Proposal]] | None:
    """Units after a number or a colon, those that fit first; None where none can stand."""
    after_colon = _DECLARED.search(line)
    number = _UNIT.search(line)
    if after_colon is not None:
        name, written = after_colon[1], after_colon[2]
        extra = [Proposal("bool", "keyword")] if line.lstrip().startswith("input") else []
    elif number is not None:
        written = number[1] or ""
        value = _VALUE_OF.search(line[: number.start()])
        name = value[1] if value is not None else ""
        extra = []
    else:
        return None
    fitting = _dimension(document, offset, name)
    units = _units(fitting)
    return offset - len(written), [*[Proposal(u, "unit", _measured(u)) for u in units], *extra]


def _units(dimension: Dimension | None) -> list[str]:
    """Units of a dimension; the usual ones where that is not known."""
    if dimension is None:
        return [u for name in _USUAL.split() for u in (name, *_PREFIXED.get(name, "").split())]
    plain = describe(dimension)
    found = [plain, *_PREFIXED.get(plain, "").split()]
    for name in _USUAL.split():
        unit = parse_unit(name)
        if unit is not None and unit.dimension == dimension:
            found += [name, *_PREFIXED.get(name, "").split()]
    return list(dict.fromkeys(found))


def _measured(unit: str) -> str:
    for domain in DOMAINS.values():
        if unit and unit == domain.effort_unit:
            return domain.effort_name
        if unit and unit == domain.flow_unit:
            return domain.flow_name
    return "unit"


def _dimension(document: Document, offset: int, name: str) -> Dimension | None:
    """What the value of that name has to be, from the last text that was sound."""
    model = document.names.enclosing(offset)
    if model is None or not name:
        return None
    declared = model.values.get(name)
    for symbol, items in document.facts.quantities.items():
        if symbol.model == model.model.name and symbol.name == name:
            for item in items:
                if item.dimension is not None:
                    return item.dimension
    if declared is not None and isinstance(declared.statement, Param):
        return dimension_of(declared.statement.unit)
    return None
