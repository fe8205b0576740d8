"""`bondgraph format`: models in the one style they are all written in."""

from __future__ import annotations

import sys
from argparse import ArgumentParser, Namespace

from bondgraph.cli import console
from bondgraph.cli.terminal import exactly
from bondgraph.frontend.formatter import format_text
from bondgraph.frontend.read import read
from bondgraph.text.diagnostic import CompileError, Report
from bondgraph.text.source import Source
from bondgraph.text.whole_file import write_bytes


def arguments(parser: ArgumentParser) -> None:
    """The arguments of `format`."""
    parser.add_argument(
        "files", nargs="+", metavar="FILE", help="files to format in place; - is stdin to stdout"
    )
    parser.add_argument(
        "--check", action="store_true", help="write nothing; exit with 1 if a file would change"
    )
    parser.add_argument(
        "--diff", action="store_true", help="the same, and print what would change"
    )
    parser.add_argument("--quiet", action="store_true", help="say nothing of what was formatted")


def run(args: Namespace) -> int:
    """Format every file; a file with a syntax error stays as it is."""
    status = 0
    for name in args.files:
        try:
            before, after = _formatted(name)
        except CompileError as error:
            console.show(error.diagnostics)
            status = 1
            continue
        if args.check or args.diff:
            if before != after:
                print(f"{name} would change", file=sys.stderr)
                status = 1
            if args.diff:
                exactly(sys.stdout, _diff(name, before, after))
        elif name == "-":
            exactly(sys.stdout, after)
        elif before != after:
            write_bytes(name, after.encode())  # comments stay as they are
            if not args.quiet:
                print(f"formatted {name}")
    return status


def _diff(name: str, before: str, after: str) -> str:
    """What would change, as a unified diff."""
    from difflib import unified_diff

    old, new = before.splitlines(keepends=True), after.splitlines(keepends=True)
    found = unified_diff(old, new, name, f"{name} (formatted)")
    return "".join(line if line.endswith("\n") else f"{line}\n" for line in found)


def _formatted(name: str) -> tuple[str, str]:
    """A file before and after formatting. Raises `CompileError` on a syntax error."""
    report = Report()
    source = Source("-", sys.stdin.read()) if name == "-" else read(name, report)
    text = None if source is None else format_text(source, report)
    report.stop_on_error()
    if source is None or text is None:
        raise CompileError(tuple(report.diagnostics))
    return source.text, text
