"""`bondgraph check`: whether models are sound, answered without algebra."""

from __future__ import annotations

import os
import sys
from typing import TYPE_CHECKING

from bondgraph import compile
from bondgraph.cli import console
from bondgraph.cli.watching import sources_of, watched, watching
from bondgraph.editor.soundness import soundness
from bondgraph.text.diagnostic import CompileError, Report
from bondgraph.text.numerals import plural

if TYPE_CHECKING:
    from argparse import ArgumentParser, Namespace

    from bondgraph.compilation import Compilation


def arguments(parser: ArgumentParser) -> None:
    """The arguments of `check`."""
    parser.add_argument(
        "models",
        nargs="+",
        metavar="MODEL",
        help="file.bg, file.bg:Name, a pattern such as 'models/*.bg', or - for the input",
    )
    parser.add_argument("--json", action="store_true", help="print one JSON object")
    parser.add_argument(
        "--format",
        choices=("text", "json", "sarif"),
        default="text",
        help="text, the JSON object, or a SARIF 2.1.0 log (default: text)",
    )
    parser.add_argument(
        "--strict", action="store_true", help="warnings count as errors: exit with 1"
    )
    parser.add_argument("--quiet", action="store_true", help="say nothing of what is sound")
    watching(parser)


def run(args: Namespace) -> int:
    """Check every model; the exit status is 1 if one is wrong. With --watch after each change."""
    used: set[str] = set()
    if not args.watch:
        return _checked(args, used)
    return watched(lambda: _checked(args, used), args.models, lambda: used)


def _checked(args: Namespace, used: set[str]) -> int:
    """Check every model; the files that they were read from become `used`."""
    report = Report()
    lines: list[str] = []
    failures: list[CompileError] = []
    for name in _named(args.models):
        try:
            found = soundness(_opened(name))
        except CompileError as error:
            failures.append(error)
            diagnostics = error.diagnostics
        else:
            lines += [_line(c) for c in found.sound]
            used.update(*[sources_of(c.graph) for c in found.sound])
            failures += found.failures
            diagnostics = found.diagnostics
        for diagnostic in diagnostics:
            report.add(diagnostic)
    strict = _strict(report) if args.strict and not failures else ""
    if args.json or args.format == "json":
        _print_json(report, failures, strict or "; ".join(lines), bool(strict))
    elif args.format == "sarif":
        from bondgraph.cli.sarif import sarif

        console.print_json(sarif(report.diagnostics))
    else:
        console.show([d for d in report.diagnostics if d.severity != "info" or not args.quiet])
        if strict:
            print(strict, file=sys.stderr)
        for line in () if args.quiet else lines:
            print(line)
    return 1 if failures or strict else 0


def _named(names: list[str]) -> list[str]:
    """The files that are meant: a pattern that no shell has opened stands for what fits it."""
    found: dict[str, None] = {}
    for name in names:
        fitting: list[str] = []
        if any(c in name for c in "*?[") and not os.path.exists(name):
            from glob import glob

            fitting = sorted(glob(name, recursive=True))
        found.update(dict.fromkeys(fitting or [name]))
    return list(found)


def _opened(name: str) -> Compilation:
    """A model to be checked: a part is sound without its surroundings."""
    if name == "-":
        return compile("<input>", text=sys.stdin.read(), open_ports=True)
    return compile(name, open_ports=True)


def _strict(report: Report) -> str:
    """What --strict says of warnings; "" where there are none."""
    number = sum(d.severity == "warning" for d in report.diagnostics)
    return f"{plural(number, 'warning')}, which --strict does not let pass" if number else ""


def _print_json(report: Report, failures: list[CompileError], message: str, strict: bool) -> None:
    from bondgraph.text.render import as_json

    console.print_json(
        {
            "status": console.status(failures[0]) if failures else "error" if strict else "ok",
            "message": str(failures[0]) if failures else message,
            "diagnostics": as_json(report.diagnostics),
        }
    )


def _line(compilation: Compilation) -> str:
    graph = compilation.integral.graph
    elements = sum(node.common is None for node in graph.nodes)
    sizes = (
        plural(elements, "element"),
        plural(len(graph.nodes) - elements, "junction"),
        plural(len(graph.bonds), "bond"),
        plural(len(graph.sensors), "sensor"),
    )
    return f"{compilation.source.path}: {graph.name} is sound ({', '.join(sizes)})"
