"""`bondgraph draw`: the bond graph as a figure, with half arrows and causal strokes."""

from __future__ import annotations

import os
import sys
from typing import TYPE_CHECKING

from bondgraph import compile
from bondgraph.cli import console

if TYPE_CHECKING:
    from argparse import ArgumentParser, Namespace


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


def run(args: Namespace) -> int:
    """Write the figure; where strokes cannot be placed, one that shows why, with the status 1."""
    compilation = compile(args.model, open_ports=True)
    conflicts = compilation.conflicts
    svg = compilation.drawing(args.derivative)
    found = [*compilation.report.diagnostics, *[conflict.finding for conflict in conflicts]]
    stem = os.path.splitext(os.path.basename(compilation.source.path))[0]
    output = args.output or f"{stem}.svg"
    console.show(found)
    if output == "-":
        sys.stdout.write(svg)
        return 1 if conflicts else 0
    folder = os.path.dirname(output)
    if folder:
        os.makedirs(folder, exist_ok=True)
    console.write_whole(output, svg)
    name = compilation.graph.name
    if conflicts:
        many = "conflict" if len(conflicts) == 1 else f"{len(conflicts)} conflicts"
        print(f"{output}: {name} with its {many} marked")
        return 1
    preference = "derivative" if args.derivative else "integral"
    print(f"{output}: {name} in preferred {preference} causality")
    return 0
