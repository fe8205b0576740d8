"""What is drawn of a text at every key, and from where in the text it comes."""

from __future__ import annotations

from typing import Any

from bondgraph import Compilation, compile
from bondgraph.text.diagnostic import CompileError
from bondgraph.text.numerals import plural
from bondgraph.text.source import Span
from bondgraph.text.tuples import NamedTuple

#: Nodes that a page redraws at every key; more are drawn by `bondgraph draw`.
MOST = 1500


class Job(NamedTuple):
    """A text to look at; `model` names one of its models, "" for the one that is meant anyway."""

    version: int
    path: str
    text: str
    model: str = ""
    derivative: bool = False


def sketch(job: Job) -> dict[str, Any]:
    """The message for the page. Without an `svg` there is nothing that could be drawn.

    `nodes` have the places in the text where they come from: (line, column, end line, end column),
    from 1, in characters; of what is in another file its name instead. `bonds` are [tail, head,
    place] in the order of their numbers.
    """
    found: dict[str, Any] = {
        "type": "sketch", "version": job.version, "sound": False, "message": "", "models": [],
        "svg": None, "nodes": {}, "bonds": [],
    }  # fmt: skip
    try:
        compilation = opened(job, open_ports=True)
    except CompileError as error:
        return found | {"message": str(error)}
    try:
        found["models"] = [model.name for model in compilation.syntax.models]
        graph = compilation.graph
        found["nodes"] = {node.path: _place(node.origin, job.path) for node in graph.nodes}
        found["bonds"] = [
            [graph.nodes[b.tail.node].path, graph.nodes[b.head.node].path,
             _place(b.origin, job.path)] for b in graph.bonds
        ]  # fmt: skip
        found["model"] = graph.name
        if len(graph.nodes) <= MOST:
            found["svg"] = compilation.drawing(job.derivative, bare=True)
        _ = compilation.integral
        found |= {"sound": True, "message": _sizes(compilation)}
    except CompileError as error:
        found["message"] = str(error)
    return found


def opened(job: Job, **options: Any) -> Compilation:
    """The compilation of a text; raises CompileError where it is none."""
    return compile(job.path, job.model or None, text=job.text, **options)


def _sizes(compilation: Compilation) -> str:
    graph = compilation.graph
    elements = sum(node.common is None for node in graph.nodes)
    said = (
        plural(elements, "element"),
        plural(len(graph.nodes) - elements, "junction"),
        plural(len(graph.bonds), "bond"),
        plural(sum(s.same_as is None for s in graph.sensors), "sensor"),
    )
    drawn = "" if len(graph.nodes) <= MOST else "; too large to be drawn at every key"
    return ", ".join(said) + drawn


def _place(span: Span, path: str) -> list[int] | str:
    source = span.source
    if source.path != path:
        return f"{source.path}, line {span.line}"
    return [*source.position(span.start), *source.position(max(span.end, span.start))]
