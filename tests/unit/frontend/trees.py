"""Trees without their places, to be compared and to be written down in a test."""

from __future__ import annotations

from typing import Any

from bondgraph.frontend.parser import parse
from bondgraph.ir import syntax
from bondgraph.text.diagnostic import Report
from bondgraph.text.source import Source


def bare(tree: Any) -> Any:
    """The tree as nested tuples: class names and fields, no origins."""
    fields = getattr(tree, "_fields", None)
    if fields is not None:
        kept = [n for n in fields if n not in ("origin", "name_origin")]
        return (type(tree).__name__, *[bare(getattr(tree, n)) for n in kept])
    if isinstance(tree, tuple):
        return tuple(bare(part) for part in tree)
    return tree


def read(text: str) -> tuple[syntax.File | None, Report]:
    """The tree of a text and what was said about it."""
    report = Report()
    return parse(Source("test.bg", text), report), report


def good(text: str) -> syntax.File:
    """The tree of a text that must be right."""
    tree, report = read(text)
    assert report.diagnostics == [], [(d.code, d.message) for d in report.diagnostics]
    assert tree is not None
    return tree


def inside(statements: str) -> tuple[syntax.Statement, ...]:
    """The statements of a model with this body."""
    return good("bg 1\nmodel M {\n" + statements + "\n}\n").models[0].body


def value(expression: str) -> syntax.Expression:
    """One expression."""
    (statement,) = inside("let x = " + expression)
    assert isinstance(statement, syntax.Let)
    return statement.value


def show(e: syntax.Expression | None) -> str:
    """An expression with all its brackets."""
    match e:
        case syntax.Number(unit=None):
            return str(e.value)
        case syntax.Number():
            return f"{e.value}_{e.unit}"
        case syntax.Ref():
            return ".".join(map(_part, e.parts))
        case syntax.Unary():
            return f"({e.op} {show(e.operand)})"
        case syntax.Binary():
            return f"({show(e.left)} {e.op} {show(e.right)})"
        case syntax.Call():
            return f"{e.name}({', '.join(map(show, e.arguments))})"
        case syntax.Text():
            return f'"{e.value}"'
        case syntax.Truth():
            return str(e.value)
        case None:
            return "-"


def _part(part: syntax.Part) -> str:
    if part.first is None:
        return part.name
    last = "" if part.last is None else ".." + show(part.last)
    return f"{part.name}[{show(part.first)}{last}]"
