"""`bondgraph simulate`: run a model as a virtual machine, with faults if the scenario has some."""

from __future__ import annotations

import os
import sys
from functools import partial
from typing import TYPE_CHECKING

from bondgraph.cli import console
from bondgraph.cli.options import check_units, commanded, model_of, numbered, pace, seconds
from bondgraph.cli.sweeps import Setting, draw, settings, sweep
from bondgraph.picture import suffix_of
from bondgraph.text.diagnostic import Trouble

if TYPE_CHECKING:
    from argparse import ArgumentParser, Namespace
    from collections.abc import Callable

    from bondgraph.compilation import Compilation
    from bondgraph.runtime.log import Log
    from bondgraph.runtime.simulation.run import Run
    from bondgraph.runtime.simulation.scenario import Scenario


def arguments(parser: ArgumentParser) -> None:
    """The arguments of `simulate`."""
    parser.add_argument("model", metavar="MODEL", help="file.bg or file.bg:Name")
    parser.add_argument("scenario", metavar="SCENARIO", nargs="?",
                        help="a .toml file that says what happens (docs/simulation.md); without one"
                        " all inputs are zero")  # fmt: skip
    parser.add_argument("-o", "--output", metavar="FILE",
                        help="the log, .csv or .parquet (default: scenario.csv)")  # fmt: skip
    parser.add_argument("--truth", metavar="FILE",
                        help="also write states and true values, without noise")  # fmt: skip
    parser.add_argument("--duration", metavar="S", type=seconds, default=None,
                        help="seconds, or with a unit (default: as the scenario says, or"
                        " 10)")  # fmt: skip
    parser.add_argument("--seed", metavar="N", type=int, default=None,
                        help="seed of all that is drawn at random")  # fmt: skip
    parser.add_argument("--sweep", metavar="NAME=FROM..TO/COUNT", type=sweep, action="append",
                        default=[], help="a run for each of so many values of a parameter or a"
                        " constant input, or for each of a list (R=1,2,5); may be"
                        " repeated")  # fmt: skip
    parser.add_argument("--plot", metavar="FILE",
                        help="all runs in one picture: .png, .svg, .pdf or .html")  # fmt: skip
    parser.add_argument("--show", metavar="NAMES", default="",
                        help="the signals of the picture, separated by commas (default: all that"
                        " the log has)")  # fmt: skip
    numbered(parser)
    parser.add_argument("--input", metavar="NAME=VALUE", type=commanded, action="append",
                        default=[], help="a constant input, in SI or with a unit, or true"
                        " or false; may be repeated")  # fmt: skip
    parser.add_argument("--stream", action="store_true",
                        help="run without an end, and print the samples as lines of CSV while they"
                        " are taken")  # fmt: skip
    parser.add_argument("--speed", metavar="X", type=pace, default=1.0,
                        help="of a stream: so many seconds in one (default: 1; inf: as fast as"
                        " they are read)")  # fmt: skip
    parser.add_argument("--json", action="store_true", help="print one JSON object (docs/json.md)")


def run(args: Namespace) -> int:
    """Simulate, write the log, say how it ended."""
    compilation = model_of(args)
    chosen = _scenario(args, compilation)
    if args.stream:
        return stream(compilation, chosen, args.speed)
    if args.plot:
        suffix_of(args.plot)  # before the work
    runs = _runs(compilation, settings(compilation, chosen, args.sweep))
    files = [] if args.plot and not args.output else _logs(args, chosen.name, runs)
    if args.truth:
        files += _named(args.truth, [found.truth for _, found in runs])
    if args.plot:
        wanted = [n.strip() for n in args.show.split(",") if n.strip()]
        draw(compilation, args.plot, runs, wanted)
        files.append(args.plot)
    first = runs[0][1]
    results = [{"label": label, **_result(found)} for label, found in runs]
    return console.told(
        args.json,
        compilation.report.diagnostics,
        _message(compilation, runs),
        lambda: {"files": files, **_result(first)} | ({"runs": results} if args.sweep else {}),
        lambda: _lines(compilation, runs, files),
    )


def _runs(compilation: Compilation, wanted: list[Setting]) -> list[tuple[str, Run]]:
    """The runs, one after the other; notes go to the error stream, each once."""
    notes: dict[str, None] = {}
    found = []
    with console.progress_bar("simulating") as progress:
        for at, (label, scenario) in enumerate(wanted):
            share = partial(_share, progress, at, len(wanted))
            try:
                run = compilation.simulate(scenario, share, tell=notes.setdefault)
            except KeyError as error:
                raise _without_value(error) from error
            found.append((label, run))
    for note in notes:
        print(f"note: {note}", file=sys.stderr)
    return found


def _share(progress: Callable[[float], None], at: int, runs: int, done: float) -> None:
    """How far one of several runs is, as a share of all of them."""
    progress((at + done) / runs)


def _logs(args: Namespace, name: str, runs: list[tuple[str, Run]]) -> list[str]:
    return _named(args.output or f"{_stem(name)}.csv", [found.log for _, found in runs])


def _named(path: str, logs: list[Log]) -> list[str]:
    """Write logs, several under numbered names; the names."""
    from bondgraph.runtime.log_file import write_log

    stem, suffix = os.path.splitext(path)
    many = len(logs) > 1
    paths = [f"{stem}-{k}{suffix}" if many else path for k in range(1, len(logs) + 1)]
    for own, log in zip(paths, logs, strict=True):
        write_log(log, own)
    return paths


def _without_value(error: KeyError) -> Trouble:
    name = error.args[0]
    return Trouble(
        f"`{name}` has no value: give it under [parameters], or --set {name}=..."
    )


def stream(compilation: Compilation, scenario: Scenario, speed: float) -> int:
    """Print the samples of a machine that never stops, each when it is taken, until nobody reads.

    Who falls behind does not catch up: time stretches.
    """
    import time

    from bondgraph.runtime.simulation.run import Robot

    try:
        biased = compilation.with_biases(scenario)
        robot = Robot(compilation.equations, compilation.integral, biased)
        names = list(robot.units)
        sys.stdout.write(",".join(["t", *[f'"{n}"' if "," in n else n for n in names]]) + "\n")
        anchor = time.monotonic()
        for log in robot.logs():
            rows = zip(log.time.tolist(), *[log.columns[n].tolist() for n in names], strict=True)
            wait = anchor + float(log.time[-1]) / speed - time.monotonic()
            if wait > 0:
                time.sleep(wait)
            else:
                anchor -= wait
            text = (",".join("" if v != v else repr(v) for v in row) for row in rows)
            sys.stdout.write("\n".join(text) + "\n")
            sys.stdout.flush()
    except KeyError as error:
        raise _without_value(error) from error
    except KeyboardInterrupt:
        return 0
    return 0


def _scenario(args: Namespace, compilation: Compilation) -> Scenario:
    from bondgraph.runtime.simulation.scenario import Course, Scenario

    chosen = Scenario(console.stem(compilation.source.path))
    if args.scenario:
        chosen = compilation.scenario(args.scenario)
    graph = compilation.graph
    numbers, inputs = dict(compilation.options.parameters), dict(chosen.inputs)
    named = [name for name, _ in args.set]
    parameters = {**chosen.parameters, **{name: numbers[name] for name in named}}
    modes = dict(chosen.modes)
    check_units(graph, [(n, v) for n, v in args.input if not isinstance(v, bool)])
    for name, value in args.input:
        _known(name, "input", [i.name for i in graph.inputs if not i.of])
        mode = any(i.name == name and i.mode for i in graph.inputs)
        if isinstance(value, bool) and not mode:
            raise Trouble(f"`{name}` is a number, not true or false")
        (modes if mode else inputs)[name] = Course.constant(float(value))
    driven = {c.input for c in chosen.controllers} & {name for name, _ in args.input}
    if driven:
        raise Trouble(f"`{min(driven)}` is driven by a controller of the scenario")
    return chosen._replace(
        duration=args.duration or chosen.duration,
        seed=chosen.seed if args.seed is None else args.seed,
        parameters=parameters,
        inputs=inputs,
        modes=modes,
    )


def _known(name: str, what: str, names: list[str]) -> None:
    if name not in names:
        hint = console.hint(name, names)
        raise Trouble(f"the model has no {what} `{name}`{hint}")


def _stem(name: str) -> str:
    """A scenario's name as the name of a file."""
    return "".join(c if c.isalnum() or c in "-_." else "_" for c in name) or "run"


def _message(compilation: Compilation, runs: list[tuple[str, Run]]) -> str:
    log = runs[0][1].log
    many = f"{len(runs)} runs of " if len(runs) > 1 else ""
    return (
        f"{compilation.graph.name}: {many}{log.time[-1]:g} s, {len(log.time)} samples of"
        f" {len(log.columns)} signals"
    )


def _result(found: Run) -> dict[str, object]:
    last = {n: float(c[-1]) for n, c in found.truth.columns.items()}
    return {
        "scenario": found.scenario.name,
        "seed": found.scenario.seed,
        "duration": float(found.log.time[-1]),
        "samples": len(found.log.time),
        "signals": list(found.log.columns),
        "parameters": found.parameters,
        "quasi_static": list(found.static),
        "dependent": list(found.dependent),
        "from_zero": list(found.undeclared),
        "end": {n: v if v == v else None for n, v in last.items()},
    }


def _lines(compilation: Compilation, runs: list[tuple[str, Run]], files: list[str]) -> list[str]:
    found = runs[0][1]
    scenario = found.scenario
    lines = [_message(compilation, runs)]
    lines += [f"run {k}: {label}" for k, (label, _) in enumerate(runs, 1) if label]
    for fault in scenario.faults:
        until = "" if fault.until > scenario.duration else f" to {fault.until:g} s"
        lines.append(f"fault from {fault.at:g} s{until}: {fault.label}")
    if found.static:
        lines.append(f"at rest (quasi-static): {_listed(found.static)}")
    if found.dependent:
        lines.append(f"dependent storages: {_listed(found.dependent)}")
    if found.undeclared:
        lines.append(f"started from zero, as nothing is declared: {_listed(found.undeclared)}")
    return [*lines, *[f"wrote {name}" for name in files]]


def _listed(names: tuple[str, ...], most: int = 4) -> str:
    shown = ", ".join(names[:most])
    return shown if len(names) <= most else f"{shown} and {len(names) - most} more"
