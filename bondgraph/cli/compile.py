"""`bondgraph compile`: residuals, fault signatures and code from a model."""

from __future__ import annotations

import os
import sys
from argparse import ArgumentParser, ArgumentTypeError, Namespace
from collections import Counter

from bondgraph import Compilation, Options
from bondgraph.cli import console
from bondgraph.cli.log_options import note
from bondgraph.cli.options import (
    bandwidth,
    bits,
    further,
    opened,
    realised,
    sample_rate,
    tuning_of,
)
from bondgraph.cli.signal_ranges import ranging, with_ranges
from bondgraph.text.diagnostic import Trouble
from bondgraph.text.numerals import plural


def arguments(parser: ArgumentParser) -> None:
    """The arguments of `compile`."""
    parser.add_argument("model", metavar="MODEL", help="file.bg or file.bg:Name")
    parser.add_argument("--json", action="store_true", help="print one JSON object (docs/json.md)")
    parser.add_argument(
        "-o", "--output", metavar="DIR", help="where to write (default: generated/<name of file>)"
    )
    parser.add_argument(
        "--dry-run",
        action="store_true",
        help="look without writing: which files would be new, changed, or removed",
    )
    defaults = Options()
    parser.add_argument(
        "--rate",
        metavar="HZ",
        type=sample_rate,
        default=None,
        help=f"samples a second that step is made for (default: {defaults.rate:g})",
    )
    parser.add_argument(
        "--bandwidth",
        metavar="RAD/S",
        type=bandwidth,
        default=None,
        help="bandwidth of the residual filter (default: chosen from the rate)",
    )
    parser.add_argument(
        "--bits",
        metavar="N",
        type=bits,
        default=12,
        help="resolution of the samples: step leaves out what is smaller (default: 12)",
    )
    parser.add_argument(
        "--tuning",
        metavar="FILE.json",
        help="limits for `diagnose`, from `bondgraph tune`, with its rate and bandwidth",
    )
    parser.add_argument(
        "--target",
        metavar="LANGUAGE",
        action="append",
        help="emit this language, or `fmu` for FMUs (docs/fmu.md); may be repeated (default:"
        f" {', '.join(defaults.targets)})",
    )
    parser.add_argument(
        "--with",
        dest="extras",
        metavar="WHAT",
        type=_extras,
        action="extend",
        default=[],
        help="write more, separated by commas: tests, exact, example, qemu (a board to run it on),"
        " zephyr, espidf, arduino, ros2 (what these build systems need), misra (deviations from its"
        " rules); may be repeated",
    )
    parser.add_argument(
        "--libm",
        action="store_true",
        help="call tanh of the mathematical library, not one that is 1e-8 near it",
    )
    parser.add_argument(
        "--costs",
        action="store_true",
        help="measure what the C costs on each core whose compiler and qemu are installed: a table"
        " in the README",
    )
    parser.add_argument(
        "--check",
        action="store_true",
        help="write nothing; exit with 1 if the files that are there are not what would be written",
    )
    parser.add_argument("--quiet", action="store_true", help="print findings, but no result")
    ranging(parser)
    further(parser)
    realised(parser)


def _extras(text: str) -> tuple[str, ...]:
    from bondgraph.backends.emit import EXTRAS

    found = tuple(dict.fromkeys(filter(None, (word.strip() for word in text.split(",")))))
    for name in found:
        if name not in EXTRAS:
            listed = ", ".join(EXTRAS)
            raise ArgumentTypeError(f"nothing is called {name}; there are {listed}")
    return found


def run(args: Namespace) -> int:
    """Compile, write the files, print the result."""
    if args.target:
        from bondgraph.backends.target import targets

        every = (*targets(), "fmu")
        unknown = [name for name in args.target if name not in every]
        if unknown:
            listed = ", ".join(every)
            print(f"error: no target is called {unknown[0]}; there are {listed}", file=sys.stderr)
            return 2
    compilation = with_ranges(_opened(args), args)
    _compute(compilation)
    if compilation.options.offsets:
        names = ", ".join(dict(compilation.options.offsets))
        note(f"the code takes samples without the offsets of {names}: take them off before")
    if args.dry_run:
        return _look(compilation, args)
    if args.check:
        return _check(compilation, args)
    files = _write(compilation, args.output)
    if args.json:
        from bondgraph.cli.result import result

        console.print_json(result(compilation, files))
        return 0
    from bondgraph.cli.summary import report

    console.show(compilation.report.diagnostics)
    if not args.quiet:
        print("\n".join(report(compilation, files)))
    return 0


_LISTED = 8  # files that are named


def _check(compilation: Compilation, args: Namespace) -> int:
    """Say which files are not what would be written; the exit status is 1 if there are any."""
    from bondgraph.backends.write import outdated

    folder = args.output or _default(compilation.source.path)
    artifacts = compilation.artifacts if compilation.residuals else ()
    old = outdated(artifacts, folder)
    if args.json:
        state = {"status": "error" if old else "ok", "outdated": list(old)}
        console.print_json({**state, "message": _currency(folder, old)})
    elif old or not args.quiet:
        print(_currency(folder, old), file=sys.stderr if old else sys.stdout)
    return 1 if old else 0


def _currency(folder: str, old: tuple[str, ...]) -> str:
    if not old:
        return f"{folder} is current"
    more = f" and {len(old) - _LISTED} more" if len(old) > _LISTED else ""
    return f"{folder} is not current: {', '.join(old[:_LISTED])}{more}; compile the model again"


def _opened(args: Namespace) -> Compilation:
    """The model with all options; a tuning says how it is sampled and filtered."""
    tuning = tuning_of(args)
    if tuning is not None:
        for option, own, known in (
            ("--rate", args.rate, tuning.rate),
            ("--bandwidth", args.bandwidth, tuning.bandwidth),
        ):
            if own is not None and abs(own / known - 1.0) > 1e-9:
                raise Trouble(f"{args.tuning}: it is for {option} {known:g}, not for {own:g}")
        args.bandwidth = None
    args.rate = args.rate or (Options().rate if tuning is None else tuning.rate)
    compilation = opened(args, tuple(dict.fromkeys(args.target or Options().targets)))
    compilation = compilation.with_options(
        extras=tuple(dict.fromkeys(args.extras)), libm=args.libm, costs=args.costs
    )
    if tuning is None:
        return compilation
    try:
        return compilation.tuned(tuning)
    except ValueError as error:
        raise Trouble(f"{args.tuning}: {error}; make it anew with `bondgraph tune`") from error


#: What takes time, in order; each is a stage of the compilation.
_STAGES = (
    ("reading", "graph"),
    ("causality", "integral"),
    ("eliminating", "reduced"),
    ("signatures", "signatures"),
    ("verifying", "verification"),
    ("lowering", "program"),
    ("writing code", "artifacts"),
)


def _compute(compilation: Compilation) -> None:
    """Run all stages, with a bar on a terminal if that takes more than a second."""
    with console.progress(len(_STAGES)) as advance:
        for word, stage in _STAGES:
            advance(word)
            if stage == "program" and not compilation.residuals:
                return  # no redundancy: a right answer, but nothing to run
            getattr(compilation, stage)


def _write(compilation: Compilation, output: str | None) -> list[str]:
    """Write all files or none; the paths that were written."""
    if not compilation.residuals:
        return []
    return list(compilation.write(output or _default(compilation.source.path)))


def _look(compilation: Compilation, args: Namespace) -> int:
    """Say what would be written; the status is 1 where a file is in the way."""
    folder = args.output or _default(compilation.source.path)
    found = compilation.changes(folder)
    if args.json:
        from bondgraph.cli.result import result

        listed = [{"path": os.path.join(folder, c.path), "change": c.what} for c in found]
        console.print_json({**result(compilation, []), "changes": listed})
    else:
        console.show(compilation.report.diagnostics)
        print(f"{compilation.graph.name}: nothing is written")
        many: Counter[str] = Counter(change.what for change in found)
        for what, word in _CHANGES.items():
            if many[what] and what == "same":
                print(f"  {word:10} {plural(many[what], 'file')} in {folder}")
            else:
                for change in found:
                    if change.what == what:
                        print(f"  {word:10} {os.path.join(folder, change.path)}")
    return 1 if any(change.what == "foreign" for change in found) else 0


_CHANGES = {
    "new": "new", "changed": "changed", "removed": "removed", "same": "the same",
    "foreign": "in the way",
}  # fmt: skip


def _default(model: str) -> str:
    """Where to write if nobody said it; a link there could lead anywhere, so it is refused."""
    folder = os.path.join("generated", console.stem(model))
    for place in ("generated", folder):
        if os.path.islink(place):
            raise Trouble(
                f"{place} is a link to {os.readlink(place)}; say with -o where to write"
            )
    return folder
