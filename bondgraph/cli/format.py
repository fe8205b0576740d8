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


def run(args: Namespace) -> int:
    """Format every file; a file with a syntax error stays as it is."""
    status = 0
    for name in args.files:
        try:
            changed = _format(name, args.check)
        except CompileError as error:
            console.show(error.diagnostics)
            status = 1
            continue
        if changed and args.check:
            print(f"{name} would change", file=sys.stderr)
            status = 1
        elif changed and name != "-":
            print(f"formatted {name}")
    return status


def _format(name: str, check: bool) -> bool:
    """Format one file; whether that changes it. Raises `CompileError` on a syntax error."""
    report = Report()
    source = Source("-", sys.stdin.read()) if name == "-" else read(name, report)
    text = None if source is None else format_text(source, report)
    report.stop_on_error()
    if source is None or text is None:
        raise CompileError(tuple(report.diagnostics))
    if not check:
        if name == "-":
            exactly(sys.stdout, text)
        elif text != source.text:
            write_bytes(name, text.encode())  # comments stay as they are
    return text != source.text
