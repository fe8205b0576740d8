"""`bondgraph draw`: the bond graph as a figure, with half arrows and causal strokes."""

from __future__ import annotations

from argparse import ArgumentParser, Namespace

from bondgraph import compile
from bondgraph.cli import console
from bondgraph.cli.watching import sources_of, watched, watching


def arguments(parser: ArgumentParser) -> None:
    """The arguments of `draw`."""
    parser.add_argument("model", metavar="MODEL", help="file.bg or file.bg:Name")
    parser.add_argument(
        "--derivative",
        action="store_true",
        help="preferred derivative causality with the sensors dualised, not integral",
    )
    parser.add_argument(
        "-o",
        "--output",
        metavar="FILE.svg",
        help="where to write the figure, - for stdout (default: beside you, named like the file)",
    )
    watching(parser)


def run(args: Namespace) -> int:
    """Write the figure, with --watch after each change."""
    if not args.watch:
        return _drawn(args, set())
    used: set[str] = set()
    return watched(lambda: _drawn(args, used), [args.model], lambda: used)


def _drawn(args: Namespace, used: set[str]) -> int:
    """Write the figure; where strokes cannot be placed, one that shows why, with the status 1.

    The files that it was read from become `used`.
    """
    compilation = compile(args.model, open_ports=True)
    used |= sources_of(compilation.graph)
    conflicts = compilation.conflicts
    svg = compilation.drawing(args.derivative)
    found = [*compilation.report.diagnostics, *[conflict.finding for conflict in conflicts]]
    console.show(found)
    what = f"in preferred {'derivative' if args.derivative else 'integral'} causality"
    if conflicts:
        many = "conflict" if len(conflicts) == 1 else f"{len(conflicts)} conflicts"
        what = f"with its {many} marked"
    output = args.output or f"{console.stem(compilation.source.path)}.svg"
    console.deliver(output, svg, f"{compilation.graph.name} {what}")
    return 1 if conflicts else 0
