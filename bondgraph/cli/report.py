"""`bondgraph report`: all that is known of a model as one HTML page."""

from __future__ import annotations

from typing import TYPE_CHECKING

from bondgraph import Compilation
from bondgraph.cli import console
from bondgraph.cli.detect import situation_of
from bondgraph.cli.options import check_units, further, opened, realised, sampling, signals
from bondgraph.text.diagnostic import Trouble

if TYPE_CHECKING:
    from argparse import ArgumentParser, Namespace

    from bondgraph.backends.report.episode import Episode
    from bondgraph.cli.reporting.seen import Assumed
    from bondgraph.ir.program import Program
    from bondgraph.runtime.simulation.run import Run


def arguments(parser: ArgumentParser) -> None:
    """The arguments of `report`."""
    parser.add_argument("model", metavar="MODEL", help="file.bg or file.bg:Name")
    parser.add_argument(
        "-o",
        "--output",
        metavar="FILE.html",
        help="where to write the page, - for stdout (default: beside you, named like the file)",
    )
    parser.add_argument(
        "--scenario",
        metavar="FILE.toml",
        action="append",
        default=[],
        help="simulate this, watch it, and show both (docs/simulation.md); may be repeated",
    )
    parser.add_argument(
        "--derive",
        action="store_true",
        help="show how each residual follows from the equations, each step done by SymPy",
    )
    sampling(parser)
    signals(parser)
    further(parser)
    realised(parser)


def run(args: Namespace) -> int:
    """Collect, write the page; status 1 where it tells why there are no relations."""
    from bondgraph.backends.report.page import page
    from bondgraph.cli.reporting.collect import STAGES, collect
    from bondgraph.cli.reporting.seen import assumed, observed

    compilation = opened(args)
    check_units(compilation.graph, (*args.at, *args.swing, *args.noise))
    runs: list[Run] = []

    def assume(program: Program) -> Assumed:
        given = situation_of(args, compilation.graph, program)
        if args.scenario and not (args.at or args.swing):
            runs.extend(_simulated(compilation, args.scenario))
            return observed(args, given, compilation, program, runs)
        return assumed(args, given, program)

    with console.progress(STAGES) as advance:
        content = collect(compilation, assume, advance, args.derive)
    if content.status in ("ok", "no_arr"):
        runs = runs or _simulated(compilation, args.scenario)
        content = content._replace(episodes=_episodes(compilation, runs))
    console.show(content.findings)
    output = args.output or f"{console.stem(compilation.source.path)}.html"
    console.deliver(output, page(content), f"{content.title}: {content.message}")
    return 0 if content.status in ("ok", "no_arr") else 1


def _simulated(compilation: Compilation, paths: list[str]) -> list[Run]:
    """The scenarios as they go."""
    from importlib.util import find_spec

    if paths and find_spec("matplotlib") is None:
        raise Trouble(
            "plots of scenarios need matplotlib: pip install 'bondgraph-arr[robot]'"
        )
    from bondgraph.cli.reporting.scenarios import simulated

    return [simulated(compilation, path) for path in paths]


def _episodes(compilation: Compilation, runs: list[Run]) -> tuple[Episode, ...]:
    """What there is to show of them."""
    if not runs:
        return ()
    from bondgraph.cli.reporting.scenarios import played

    found = []
    with console.progress(len(runs)) as advance:
        for run in runs:
            advance("watching")
            found.append(played(compilation, run))
    return tuple(found)
