"""`bondgraph check`: whether models are sound, answered without algebra."""

from __future__ import annotations

from typing import TYPE_CHECKING

from bondgraph import compile
from bondgraph.cli import console
from bondgraph.text.diagnostic import CompileError, Diagnostic
from bondgraph.text.numerals import plural

if TYPE_CHECKING:
    from argparse import ArgumentParser, Namespace


def arguments(parser: ArgumentParser) -> None:
    """The arguments of `check`."""
    parser.add_argument("models", nargs="+", metavar="MODEL", help="file.bg or file.bg:Name")
    parser.add_argument("--json", action="store_true", help="print one JSON object")


def run(args: Namespace) -> int:
    """Check every model; the exit status is 1 if one is wrong."""
    found: list[Diagnostic] = []
    lines: list[str] = []
    failures: list[CompileError] = []
    for name in args.models:
        try:
            line, diagnostics = _check(name)
            lines.append(line)
        except CompileError as error:
            failures.append(error)
            diagnostics = error.diagnostics
        found += [d for d in diagnostics if d not in found] if found else diagnostics
    if args.json:
        from bondgraph.text.render import as_json

        message = str(failures[0]) if failures else "; ".join(lines)
        status = console.status(failures[0]) if failures else "ok"
        diagnosed = as_json(tuple(found))
        console.print_json({"status": status, "message": message, "diagnostics": diagnosed})
    else:
        console.show(found)
        for line in lines:
            print(line)
    return 1 if failures else 0


def _check(name: str) -> tuple[str, tuple[Diagnostic, ...]]:
    compilation = compile(name, open_ports=True)  # a part is sound without its surroundings
    graph = compilation.integral.graph
    elements = sum(node.common is None for node in graph.nodes)
    sizes = (
        plural(elements, "element"),
        plural(len(graph.nodes) - elements, "junction"),
        plural(len(graph.bonds), "bond"),
        plural(len(graph.sensors), "sensor"),
    )
    line = f"{compilation.source.path}: {graph.name} is sound ({', '.join(sizes)})"
    return line, tuple(compilation.report.diagnostics)
