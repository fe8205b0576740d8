"""`bondgraph draw`: the bond graph as a figure, with half arrows and causal strokes."""

from __future__ import annotations

import os
from argparse import ArgumentParser, Namespace
from importlib.util import find_spec
from pathlib import PurePath

from bondgraph import compile
from bondgraph.cli import console
from bondgraph.cli.watching import sources_of, watched, watching
from bondgraph.text.diagnostic import Trouble

_KINDS = (".svg", ".png", ".pdf", ".tikz")


def arguments(parser: ArgumentParser) -> None:
    """The arguments of `draw`."""
    add = parser.add_argument
    add("model", metavar="MODEL", help="file.bg or file.bg:Name")
    add("--derivative", action="store_true",
        help="preferred derivative causality with the sensors dualised, not integral")  # fmt: skip
    add("--values", action="store_true", help="show the numbers of the laws: moduli, resistances")
    add("--numbers", action="store_true", help="show the number of every bond, for `explain`")
    add("--boxes", action="store_true", help="show each submodel as one box")
    add("--no-title", action="store_true", help="leave the title out")
    add("--no-legend", action="store_true", help="leave out what the signs mean")
    add("-o", "--output", metavar="FILE",
        help="where to write the figure, by its ending as .svg, .png, .pdf or .tikz; - for SVG on"
        " stdout (default: an .svg beside you, named like the model file)")  # fmt: skip
    watching(parser)


def run(args: Namespace) -> int:
    """Write the figure, with --watch after each change."""
    kind = _kind(args.output)
    if not args.watch:
        return _drawn(args, kind, set())
    used: set[str] = set()
    return watched(lambda: _drawn(args, kind, used), [args.model], lambda: used)


def _drawn(args: Namespace, kind: str, used: set[str]) -> int:
    """Write the figure; where strokes cannot be placed, one that shows why, with the status 1.

    The files that it was read from become `used`.
    """
    from bondgraph.backends.drawing.scene import Look

    compilation = compile(args.model, open_ports=True)
    used |= sources_of(compilation.graph)
    conflicts = compilation.conflicts
    look = Look(args.values, args.numbers, args.boxes, not args.no_title, not args.no_legend)
    svg = compilation.drawing(args.derivative, look=look)
    found = [*compilation.report.diagnostics, *[conflict.finding for conflict in conflicts]]
    console.show(found)
    what = f"in preferred {'derivative' if args.derivative else 'integral'} causality"
    if conflicts:
        many = "conflict" if len(conflicts) == 1 else f"{len(conflicts)} conflicts"
        what = f"with its {many} marked"
    output = args.output or f"{console.stem(compilation.source.path)}.svg"
    console.deliver(output, _made(svg, kind), f"{compilation.graph.name} {what}")
    return 1 if conflicts else 0


def _made(svg: str, kind: str) -> str | bytes:
    """The figure as a file of this kind."""
    if kind == ".svg":
        return svg
    if kind == ".tikz":
        from bondgraph.backends.drawing.tikz import tikz

        return tikz(svg)
    from bondgraph.backends.drawing.pixels import pixels

    return pixels(svg, "png" if kind == ".png" else "pdf")


def _kind(output: str | None) -> str:
    """Of what kind the figure is to be; raises Trouble where nobody can say, or make it.

    What is no regular file, as a device or a pipe, gets SVG.
    """
    if output is None or output == "-" or (os.path.exists(output) and not os.path.isfile(output)):
        return ".svg"
    kind = PurePath(output).suffix.lower()
    if kind not in _KINDS:
        raise Trouble(f"{output}: a figure is written as {', '.join(_KINDS[:-1])} or {_KINDS[-1]}")
    if kind in (".png", ".pdf") and find_spec("matplotlib") is None:
        raise Trouble(
            f"a {kind} needs matplotlib: pip install 'bondgraph-arr[robot]'; .svg and .tikz do not"
        )
    return kind
