"""Renaming: every place of a name in all files, tried before it is offered."""

from __future__ import annotations

from collections.abc import Iterator

from bondgraph.editor.occurrences import Occurrence, Symbol
from bondgraph.editor.soundness import check_text
from bondgraph.editor.workspace import Workspace
from bondgraph.frontend.odd import odd_name
from bondgraph.frontend.words import RESERVED
from bondgraph.text.diagnostic import Diagnostic
from bondgraph.text.limits import NAME_LETTERS
from bondgraph.text.source import Source, Span


class CannotRename(Exception):
    """Why a name cannot be that."""


def renamed(workspace: Workspace, symbol: Symbol, new: str) -> dict[str, list[Span]]:
    """The places that become `new`, by path; raises `CannotRename` where that makes a mistake.

    An element that takes the value of its own name is renamed with it. What `check` says of each
    file with the new name decides.
    """
    _name(new)
    uses = list(workspace.uses(symbol))
    found: dict[str, list[Span]] = {}
    for use in uses:
        found.setdefault(use.span.source.path, []).append(use.span)
    _declared_once(workspace, uses, new)
    before = dict(workspace.texts)
    sources = {path: spans[0].source for path, spans in found.items()}
    after = before | {
        path: _with(sources[path], spans, new) for path, spans in found.items()
    }
    for path, source in sources.items():
        mistakes = _errors(path, source.text, before)
        for diagnostic in _errors(path, after[path], after):
            if diagnostic.code not in {d.code for d in mistakes}:
                raise CannotRename(f"as `{new}` there is a mistake: {diagnostic.message}")
    if set(_places(found, new)) != _meant(workspace, after, symbol._replace(name=new)):
        raise CannotRename(f"`{new}` means something else at one of these places")
    return found


def _places(found: dict[str, list[Span]], new: str) -> Iterator[tuple[str, int]]:
    """Where the new name stands, once every old one is replaced."""
    for path, spans in found.items():
        for number, span in enumerate(sorted(spans, key=lambda s: s.start)):
            yield path, span.start + number * (len(new) - (span.end - span.start))


def _meant(
    workspace: Workspace, texts: dict[str, str], symbol: Symbol
) -> set[tuple[str, int]]:
    """Where a symbol is meant in other texts than those that are open."""
    trial = Workspace(workspace.folders)
    for path, text in texts.items():
        trial.open(path, text)
    return {(use.span.source.path, use.span.start) for use in trial.uses(symbol)}


def _name(new: str) -> None:
    if not new.isidentifier() or new in RESERVED:
        raise CannotRename(f"`{new}` is no name")
    if not new.isascii() or "__" in new or new[0] == "_" or len(new) > NAME_LETTERS:
        found = odd_name(new)
        raise CannotRename(f"{found.message} {found.help}")


def _declared_once(workspace: Workspace, uses: list[Occurrence], new: str) -> None:
    """Refuse a name that something else in the same place has already."""
    for use in uses:
        names = workspace.names(use.span.source.path)
        model = None if names is None else names.enclosing(use.span.start)
        if names is None or model is None or not use.declares:
            continue
        tables = [model.nodes] if use.kind not in _VALUES else [model.values]
        if use.symbol is not None and use.symbol.space == "value":
            tables = [model.nodes, model.values] if _tied(uses) else [model.values]
        if any(new in table for table in tables):
            raise CannotRename(f"`{model.model.name}` has a `{new}` already")


_VALUES = frozenset(["param", "const", "input", "let", "sensor", "argument"])


def _tied(uses: list[Occurrence]) -> bool:
    """Whether a value and an element share the name."""
    declared = {use.kind in _VALUES for use in uses if use.declares}
    return len(declared) > 1


def _with(source: Source, spans: list[Span], new: str) -> str:
    text = source.text
    for span in sorted(spans, key=lambda s: s.start, reverse=True):
        text = text[: span.start] + new + text[span.end :]
    return text


def _errors(path: str, text: str, texts: dict[str, str]) -> list[Diagnostic]:
    _, found = check_text(path, text, texts)
    return [d for d in found.diagnostics if d.severity == "error"]
