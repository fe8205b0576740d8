"""`bondgraph compile`: residuals, fault signatures and code from a model."""

from __future__ import annotations

import os
import sys
from argparse import ArgumentParser, ArgumentTypeError, Namespace

from bondgraph import Compilation, Options
from bondgraph.cli import console
from bondgraph.cli.log_options import note
from bondgraph.cli.options import bits, frequency, further, opened, read_tuning, realised
from bondgraph.text.diagnostic import Trouble


def arguments(parser: ArgumentParser) -> None:
    """The arguments of `compile`."""
    parser.add_argument("model", metavar="MODEL", help="file.bg or file.bg:Name")
    parser.add_argument("--json", action="store_true", help="print one JSON object (docs/json.md)")
    parser.add_argument(
        "-o", "--output", metavar="DIR", help="where to write (default: generated/<name of file>)"
    )
    defaults = Options()
    parser.add_argument(
        "--rate",
        metavar="HZ",
        type=frequency,
        default=None,
        help=f"samples a second that step is made for (default: {defaults.rate:g})",
    )
    parser.add_argument(
        "--bandwidth",
        metavar="RAD/S",
        type=frequency,
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
        default=(),
        help="write more: tests, exact, example, separated by commas, each in a folder of its own",
    )
    parser.add_argument(
        "--libm",
        action="store_true",
        help="call tanh of the mathematical library, not one that is 1e-8 near it",
    )
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
    compilation = _opened(args)
    _compute(compilation)
    if compilation.options.offsets:
        names = ", ".join(dict(compilation.options.offsets))
        note(f"the code takes samples without the offsets of {names}: take them off before")
    files = _write(compilation, args.output)
    if args.json:
        from bondgraph.cli.result import result

        console.print_json(result(compilation, files))
        return 0
    from bondgraph.cli.summary import report

    console.show(compilation.report.diagnostics)
    print("\n".join(report(compilation, files)))
    return 0


def _opened(args: Namespace) -> Compilation:
    """The model with all options; a tuning says how it is sampled and filtered."""
    tuning = read_tuning(args.tuning) if args.tuning else None
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
    compilation = compilation.with_options(extras=args.extras, libm=args.libm)
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


def _default(model: str) -> str:
    """Where to write if nobody said it; a link there could lead anywhere, so it is refused."""
    folder = os.path.join("generated", console.stem(model))
    for place in ("generated", folder):
        if os.path.islink(place):
            raise Trouble(
                f"{place} is a link to {os.readlink(place)}; say with -o where to write"
            )
    return folder
