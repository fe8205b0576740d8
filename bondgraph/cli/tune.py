"""`bondgraph tune`: limits of the residuals from healthy samples, and what shows with them."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from bondgraph import Options
from bondgraph.cli import console
from bondgraph.cli.log_options import behind_gaps, logged, read_logs, times_of
from bondgraph.cli.options import (
    bandwidth,
    fitted_bandwidth,
    isolating,
    positive,
    realised,
    realising,
    sample_rate,
    seconds,
)
from bondgraph.cli.reasons import told_apart_at_best
from bondgraph.ir.residual_limit import NEVER
from bondgraph.text.diagnostic import Trouble
from bondgraph.text.moment import lasting
from bondgraph.text.numerals import listed, plural
from bondgraph.text.whole_file import write_whole

if TYPE_CHECKING:
    from argparse import ArgumentParser, Namespace
    from collections.abc import Callable, Iterable

    from bondgraph.compilation import Compilation
    from bondgraph.runtime.diagnosis.calibration import Tuned
    from bondgraph.runtime.diagnosis.shown_sizes import Shown
    from bondgraph.runtime.diagnosis.tuning import Tuning
    from bondgraph.runtime.log import Array
    from bondgraph.runtime.monitoring.clock import Piece
    from bondgraph.runtime.monitoring.engine import Engine

_FACTORS = (0.25, 0.5, 1.0, 2.0, 4.0)  # of the default bandwidth, where none is wanted
_CLIMB = 2.0  # times the fastest of these, for as long as that is clearly the best
_CLEARLY = 0.2  # of the logarithm of what shows: for less none leaves the usual filter
_MORE = 1.2  # times the change that shows, above which that without a jump is told beside it
_LEAST = 30.0  # rows of three time constants, besides the warm-up, to learn from
WINDOW = 40.0  # time constants of the default filter in which a fault has to show


def arguments(parser: ArgumentParser) -> None:
    """The arguments of `tune`."""
    parser.add_argument("model", metavar="MODEL", help="file.bg or file.bg:Name")
    parser.add_argument("logs", metavar="LOG", nargs="*",
                        help="logs of healthy machines: files, folders, patterns")  # fmt: skip
    parser.add_argument("--simulate", metavar="SCENARIO",
                        help="use virtual machines instead, with parameters drawn inside their"
                        " tolerances")  # fmt: skip
    parser.add_argument("--runs", metavar="N", type=int, default=10,
                        help="how many of them (default: 10)")  # fmt: skip
    parser.add_argument("--seed", metavar="N", type=int, default=900_000,
                        help="seed of the first of them (default: 900000)")  # fmt: skip
    parser.add_argument("-o", "--output", metavar="FILE.json", default="tuning.json",
                        help="where to write the limits (default: tuning.json)")  # fmt: skip
    parser.add_argument("--false-alarms", metavar="N", type=positive, default=1.0,
                        help="false alarms an hour, of all residuals (default: 1)")  # fmt: skip
    parser.add_argument("--bandwidth", metavar="RAD/S", type=bandwidth, action="append", default=[],
                        help="of the filter; of several the best one is taken (default: five"
                        " are tried, about the one of `bondgraph fit` if it took a faster one for"
                        " the numbers of --parameters)")  # fmt: skip
    parser.add_argument("--window", metavar="S", type=seconds, default=None,
                        help="seconds in which a fault has to show (default: 40 time constants of"
                        " the default filter)")  # fmt: skip
    parser.add_argument("--rate", metavar="HZ", type=sample_rate, default=None,
                        help="samples a second (default: that of the first log)")  # fmt: skip
    logged(parser.add_argument)
    isolating(parser)
    realised(parser)
    parser.add_argument("--json", action="store_true", help="print one JSON object (docs/json.md)")


def run(args: Namespace) -> int:
    """Learn, choose a bandwidth, write the limits, say what follows."""
    from bondgraph.runtime.diagnosis.calibration import tune

    if bool(args.logs) == bool(args.simulate):
        raise Trouble("healthy samples come from LOG files or from --simulate SCENARIO")
    try:
        compilation, engine, pieces, times = _logs(args)
        logs, later = [p.samples for _, p in pieces], [bool(p.anew) for _, p in pieces]
        rate, fitted = 1.0 / engine.sample_time, fitted_bandwidth(args, compilation)
        usual = _usual(rate, max(map(len, logs), default=0), args.window, fitted)
        wanted = args.bandwidth or _wanted(engine, usual, logs, _FACTORS)
        window = args.window or WINDOW / usual
        found: list[Tuned] = []
        with console.progress_bar("tuning") as progress:
            while len(found) < len(wanted):
                k = len(found)
                found.append(
                    tune(
                        engine.configured(bandwidth=wanted[k]),
                        compilation.diagnosis_model,
                        logs,
                        compilation.program.digest,
                        args.false_alarms,
                        window,
                        _part(progress, k, len(wanted)),
                        later,
                    )
                )
                if not args.bandwidth and len(found) == len(wanted) and _climbs(found):
                    faster = _wanted(engine, wanted[-1], logs, (_CLIMB,))
                    wanted += [w for w in faster if w > wanted[-1]]
    except ValueError as error:
        raise Trouble(str(error)) from error
    alone = bool(args.logs) and len({name for name, _ in pieces}) == 1
    best = _best(found, usual)
    form = compilation.options.form
    tuning = best.tuning._replace(isolate=args.isolate, form=form)
    write_whole(args.output, tuning.to_json())
    return console.told(
        args.json,
        compilation.report.diagnostics,
        _message(compilation, best),
        lambda: {"files": [args.output], **_result(compilation, best, found), "times": times},
        lambda: _lines(compilation, best, found, args.output, alone=alone),
    )


def _usual(
    rate: float, longest: int, window: float | None = None, fitted: float | None = None
) -> float:
    """The filter that others are held against: that with which parameters were `fitted`, or else
    `tuned_bandwidth`, no slower than a fault allows that has to show within a `window` of seconds.
    """
    from bondgraph.runtime.diagnosis.tuning import FASTEST, tuned_bandwidth

    usual = min(fitted, FASTEST * rate) if fitted else tuned_bandwidth(rate, longest)
    return max(usual, min(WINDOW / window, FASTEST * rate)) if window else usual


def _wanted(
    engine: Engine, usual: float, logs: list[Array], factors: Iterable[float]
) -> list[float]:
    """The bandwidths to try: samples can follow them, and the logs are long enough for them."""
    from bondgraph.runtime.diagnosis.tuning import FASTEST

    longest = max((len(log) for log in logs), default=0) * engine.sample_time
    tried = [f * usual for f in factors]
    fits = [w for w in tried
            if w * engine.sample_time <= FASTEST
            and longest >= engine.configured(bandwidth=w).warm_up + 3.0 * _LEAST / w]  # fmt: skip
    return fits or [usual]


def _part(progress: Callable[[float], None], k: int, parts: int) -> Callable[[float], None]:
    return lambda share: progress((k + share) / parts)


def _logs(
    args: Namespace,
) -> tuple[Compilation, Engine, list[tuple[str, Piece]], dict[str, str]]:
    """The model, an engine of it, what it reads from each log, on its grid, and by what time."""
    from bondgraph.runtime.monitoring.columns import read_map
    from bondgraph.runtime.monitoring.sources.sample_source import rate_of
    from bondgraph.runtime.monitoring.watch_settings import engine_of, something_to_watch
    from bondgraph.runtime.monitoring.whole_logs import stretches

    read = []
    if args.simulate:
        compilation = realising(args, rate=args.rate or Options().rate)
        scenario = compilation.scenario(args.simulate)
        if scenario.faults:
            raise Trouble(f"{args.simulate} has a fault: tune on what is healthy")
        if scenario.sampling.rate != compilation.options.rate:
            compilation = compilation.with_options(rate=scenario.sampling.rate)
            scenario = compilation.scenario(args.simulate)
        with console.progress_bar("simulating") as progress:
            for k in range(args.runs):
                own = scenario._replace(seed=args.seed + k, spread="uniform")
                read.append((args.simulate, compilation.simulate(own).log))
                progress((k + 1) / args.runs)
    else:
        read = read_logs(args)
        rate = args.rate or rate_of(read[0][1].fastest()) or Options().rate
        compilation = realising(args, rate=rate)
    something_to_watch(compilation)
    engine = engine_of(compilation)
    mapping = read_map(args.map, engine.signals) if args.map else None
    times = times_of(read)
    found = stretches(engine, read, mapping, args.operating, args.rate is not None)
    return compilation, engine, found, times


def _climbs(found: list[Tuned]) -> bool:
    """Whether the last filter, the fastest, is clearly better: the machine may be faster still."""
    *slower, fastest = (_score(t, found) for t in found)
    return bool(slower) and fastest < min(slower) - _CLEARLY


def _best(found: list[Tuned], usual: float) -> Tuned:
    """Of the filters that show nearly as much as the best one, the one nearest to the usual.

    Sums of rows make most of them see the same. What a healthy machine does that its logs have no
    example of makes false alarms with a fast one, and with a slow one every alarm ends late.
    """
    enough = min(_score(t, found) for t in found) + _CLEARLY
    near = [t for t in found if _score(t, found) <= enough]
    return min(near, key=lambda t: abs(math.log(t.tuning.bandwidth / usual)))


def _score(tuned: Tuned, found: list[Tuned]) -> float:
    """The geometric mean of what shows, next to what is usual, of all that shows with any filter.

    That is over the times since a fault began, too: what shows late counts less. What is below a
    tenth is small enough, and above ten times it is of no use: no filter gets credit for more.
    """
    logs = []
    for k, shown in enumerate(tuned.shown):
        if any(t.shown[k].size is not None for t in found):
            shares = [min(max(size / shown.hypothesis.usual, 0.1), 10.0) for size in shown.course]
            logs.append(sum(map(math.log, shares)) / len(shares))
    return sum(logs) / len(logs) if logs else 0.0


def _message(compilation: Compilation, best: Tuned) -> str:
    t = best.tuning
    return (
        f"{compilation.graph.name}: {plural(len(t.limits), 'residual')}, tuned on"
        f" {lasting(t.seconds, '.0f')} for {t.false_alarms:g} false alarms an hour, filter of"
        f" {t.bandwidth:g} rad/s"
    )


def _supported(tuning: Tuning) -> float:
    """False alarms an hour that so long a log without any supports, with 95 % confidence.

    That is 3/T: with more than three expected, none at all is seen once in twenty times (Hanley and
    Lippman-Hand, 1983).
    """
    return -math.log(0.05) * 3600.0 / tuning.seconds


def _result(compilation: Compilation, best: Tuned, found: list[Tuned]) -> dict[str, object]:
    return {
        "model": compilation.graph.name,
        "bandwidth": best.tuning.bandwidth,
        "supported": _supported(best.tuning),
        "tried": [{"bandwidth": t.tuning.bandwidth, "score": _score(t, found)} for t in found],
        "window": best.window,
        "limits": [{"residual": n, **x._asdict()} for n, x in best.tuning.limits.items()],
        "lost": dict(best.lost),
        "faults": [
            {
                "fault": s.hypothesis.fault,
                "kind": s.hypothesis.kind,
                "change": None if s.size is None else _change(s, s.size),
                "unit": s.hypothesis.unit,
                "relative": _relative(compilation, s),
                "smooth": None if s.smooth is None else _change(s, s.smooth),
                "many_rows": _change(s, s.course[-1]) if math.isfinite(s.course[-1]) else None,
                "delay": s.delay,
                "residual": s.residual or None,
                "share": s.share,
            }
            for s in best.shown
        ],
    }


def _change(shown: Shown, size: float) -> float:
    """In the unit of the hypothesis; a gain without one is a share."""
    return shown.hypothesis.told(size)[0] if shown.hypothesis.unit else size


def _relative(compilation: Compilation, shown: Shown) -> float | None:
    nominal = compilation.diagnosis_model.faults.get(shown.hypothesis.fault)
    if shown.size is None:
        return None
    if shown.hypothesis.kind == "gain":
        return shown.size
    return shown.size / abs(nominal) if nominal else None


def _lines(
    compilation: Compilation, best: Tuned, found: list[Tuned], output: str, alone: bool
) -> list[str]:
    lines = [_message(compilation, best), ""]
    supported = _supported(best.tuning)
    if supported > best.tuning.false_alarms:
        lines += [
            f"The logs are too short to show that: they support {supported:.2g} an hour, and beyond"
            " that the limits trust the shape of the noise",
            "",
        ]
    if len(found) > 1:
        tried = [f"{t.tuning.bandwidth:g} ({math.exp(_score(t, found)):.2g})" for t in found]
        what = "Filters tried, rad/s (what shows while a fault lasts, next to a usual change)"
        lines += [f"{what}: {', '.join(tried)}", ""]
    limits: list[tuple[str, ...]] = [("residual", "noise", "fires above", "sums above")]
    for name, x in best.tuning.limits.items():
        level = f"a + {x.kappa * x.sigma:.3g}"
        sums = f"{x.height:.1f} sigma" if x.height < NEVER.height else "never: it adds up noise"
        limits.append((name, f"{x.sigma:.3g}", level, sums))
    stray = {n: x.apart for n, x in best.tuning.limits.items() if x.apart > x.sigma}
    rows: list[tuple[str, ...]] = [("fault", "change", "", "after", "many rows", "in")]
    hidden = []
    for shown in best.shown:
        row = _row(compilation, shown)
        if row is None:
            hidden.append(shown)
        else:
            rows.append(row)
    lines += [*console.columns(limits), ""]
    if best.lost:
        lines += [*behind_gaps(best.lost), ""]
    if alone:
        lines += ["One log does not tell how far others stand apart: of another day or machine, one"
                  " that stands elsewhere is in alarm for as long as it does. Give several logs, or"
                  " watch without a tuning", ""]  # fmt: skip
    if stray:
        told = [f"{n} by {far:.3g} ({far / best.tuning.limits[n].sigma:.2g} times the noise)"
                for n, far in stray.items()]  # fmt: skip
        lines += [f"The logs stand apart: {listed(told, 'and')}. A watch learns from its first rows"
                  " where its machine stands; what is wrong from the start by no more than that is"
                  " not seen", ""]  # fmt: skip
    lines += [f"The smallest change that is sure to show within {best.window:g} s, in nine windows"
              " of ten: in a sample, and at the end in the sum of many rows, if that is less",
              *console.columns(rows)]  # fmt: skip
    never = [_name(shown) for shown in hidden if not shown.share]
    if never:
        lines += ["", "Cannot be seen: " + ", ".join(never)]
    at_times = [f"{_name(s)} ({100 * s.share:.2g} % of them)" for s in hidden if s.share]
    if at_times:
        lines += ["", f"Shows in fewer windows, with some motion only: {', '.join(at_times)}"]
    more = told_apart_at_best(compilation, "tune --isolate adds residuals for them")
    if more:
        own = plural(len(compilation.signatures.groups), "group")
        lines += ["", f"These residuals tell faults apart in {own}; {more}"]
    return [*lines, "", f"Written to {output}"]


def _name(shown: Shown) -> str:
    return f"{shown.hypothesis.fault} {shown.hypothesis.kind}".removesuffix(" value")


def _row(compilation: Compilation, shown: Shown) -> tuple[str, ...] | None:
    """What is told of one hypothesis; None for what cannot be seen."""
    many = shown.course[-1]
    in_rows = shown._replace(size=many if many < (shown.size or math.inf) / _MORE else None)
    if shown.size is None or shown.delay is None:
        if in_rows.size is None:
            return None
        return _name(shown), "", "", "", _plain(compilation, in_rows)
    relative = _relative(compilation, shown)
    share = "" if relative is None else f"{100 * relative:.3g} %"
    change, unit = shown.hypothesis.told(shown.size)
    size = "" if unit == "%" else f"{change:.3g} {unit}".rstrip()
    share = "" if shown.hypothesis.kind == "gain" and size else share
    notes = [shown.residual]
    if relative is not None and relative > 1:
        notes.append("only as an increase")  # no parameter loses more than it has
    if shown.smooth is None:
        notes.append("never if nothing jumps")
    elif shown.smooth > _MORE * shown.size:
        other = _plain(compilation, shown._replace(size=shown.smooth))
        notes.append(f"{other} if nothing jumps")
    many_rows = _plain(compilation, in_rows)
    return _name(shown), size, share, f"{shown.delay:.2f} s", many_rows, "  ".join(notes)


def _plain(compilation: Compilation, shown: Shown) -> str:
    """The size relative where there is something that it is a part of, "" for none."""
    relative = _relative(compilation, shown)
    if shown.size is None:
        return ""
    if relative is not None and not (shown.hypothesis.kind == "gain" and shown.hypothesis.unit):
        return f"{100 * relative:.3g} %"
    change, unit = shown.hypothesis.told(shown.size)
    return f"{change:.3g} {unit}".rstrip()
