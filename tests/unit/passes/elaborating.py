"""Helpers of the elaboration tests: a text to a graph or to its errors."""

from __future__ import annotations

from pathlib import PurePosixPath

from bondgraph.frontend.parser import parse
from bondgraph.ir.graph import BondGraph, Node
from bondgraph.ir.syntax import File
from bondgraph.passes.elaboration.elaborate import elaborate
from bondgraph.text.diagnostic import Diagnostic, Report
from bondgraph.text.source import Source, Span


def run(
    text: str,
    model: str | None = None,
    *,
    open_ports: bool = False,
    path: str = "model.bg",
    others: dict[str, str] | None = None,
) -> tuple[BondGraph | None, list[Diagnostic]]:
    """The graph of a text (the line `bg 1` is added) and what was reported."""
    report = Report()
    source = Source(path, "bg 1\n" + text)

    def load(name: str, span: Span) -> File | None:
        found = (others or {}).get(name)
        place = str(PurePosixPath(path).parent / name)
        if found is None:
            report.error("file-not-found", f"{place} does not exist.", span, help="There is none.")
            return None
        return parse(Source(place, "bg 1\n" + found), report)

    file = parse(source, report)
    assert file is not None and not report.failed, report.diagnostics
    return elaborate(file, source, model, load, report, open_ports), report.diagnostics


def graph(text: str, model: str | None = None, *, open_ports: bool = False) -> BondGraph:
    """The graph of a sound text."""
    found, said = run(text, model, open_ports=open_ports)
    assert found is not None, [(d.code, d.message) for d in said]
    return found


def body(text: str) -> BondGraph:
    """The graph of one model with this body."""
    return graph("model M {\n" + text + "\n}")


def errors(text: str, model: str | None = None) -> list[str]:
    """The codes of the errors of a text."""
    _, said = run(text, model)
    return [d.code for d in said if d.severity == "error"]


def body_errors(text: str) -> list[str]:
    """The codes of the errors of one model with this body."""
    return errors("model M {\n" + text + "\n}")


def node(of: BondGraph, path: str) -> Node:
    """The node with this path."""
    return next(n for n in of.nodes if n.path == path)


def laws(of: BondGraph, path: str) -> list[str]:
    """The laws of a node as text."""
    return [repr(law.zero) for law in node(of, path).laws]


def bonds(of: BondGraph) -> list[tuple[str, str]]:
    """The bonds as pairs of paths."""
    return [(of.nodes[b.tail.node].path, of.nodes[b.head.node].path) for b in of.bonds]


def signs(of: BondGraph, path: str, port: int = 0) -> tuple[int, int]:
    """The signs of effort and flow at a port of an element."""
    at = [n.path for n in of.nodes].index(path)
    for bond in of.bonds:
        for end in (bond.tail, bond.head):
            if end.node == at and end.port == port:
                return end.effort, end.flow
    raise KeyError(path)
