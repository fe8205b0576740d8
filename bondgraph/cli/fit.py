"""`bondgraph fit`: parameters of a machine from logs of it while it was healthy."""

from __future__ import annotations

import math
from importlib.util import find_spec
from typing import TYPE_CHECKING

from bondgraph import Options
from bondgraph.cli import console
from bondgraph.cli.log_options import behind_gaps, logged, read_logs, times_of
from bondgraph.cli.options import (
    bandwidth,
    check_read,
    check_units,
    isolating,
    noise,
    realised,
    realising,
    sample_rate,
)
from bondgraph.text.diagnostic import Trouble
from bondgraph.text.moment import lasting, moment
from bondgraph.text.numerals import joined, listed, plural
from bondgraph.text.whole_file import write_whole

if TYPE_CHECKING:
    from argparse import ArgumentParser, Namespace
    from collections.abc import Iterable, Mapping

    from bondgraph.compilation import Compilation
    from bondgraph.runtime.diagnosis.fitted import Fitted, Fitting, Left, Start

_LATE = 3.0  # standard errors above which it is told that a signal comes early or late
_SUSPECTS = 3  # offsets that are told at most
_MEMORY = 0.3  # correlation of what is left, above which it is no noise of sensors


def arguments(parser: ArgumentParser) -> None:
    """The arguments of `fit`."""
    add = parser.add_argument
    add("model", metavar="MODEL", help="file.bg or file.bg:Name")
    add("logs", metavar="LOG", nargs="+",
        help="logs of one healthy machine: files, folders, patterns")  # fmt: skip
    add("--free", metavar="NAMES", action="append", default=[],
        help="parameters to fit, and sensors or inputs whose offset is, separated by commas; may be"
        " repeated (default: the parameters with a tolerance, or else all)")  # fmt: skip
    add("-o", "--output", metavar="FILE.toml", default="parameters.toml",
        help="where to write them (default: parameters.toml)")  # fmt: skip
    add("--plot", metavar="FILE.svg", default=None,
        help="draw the first log as it was measured, and as the parameters predict it")  # fmt: skip
    add("--noise", metavar="[NAME=]DEVIATION", type=noise, action="append", default=[],
        help="standard deviation of the samples of a signal, without a name of every sensor; may be"
        " repeated (default: as the logs show it; inputs are exact)")  # fmt: skip
    add("--rate", metavar="HZ", type=sample_rate, default=None,
        help="samples a second (default: that of the first log)")  # fmt: skip
    add("--bandwidth", metavar="RAD/S", type=bandwidth, default=None,
        help="bandwidth of the filter (default: by rate and length of the logs, or a faster one if"
        " that tells more)")  # fmt: skip
    logged(add)
    isolating(parser)
    realised(parser)
    add("--json", action="store_true", help="print one JSON object (docs/json.md)")


def run(args: Namespace) -> int:
    """Read the logs, fit, write the parameters, say how sure they are."""
    from bondgraph.runtime.monitoring.columns import read_map
    from bondgraph.runtime.monitoring.sources.sample_source import rate_of
    from bondgraph.runtime.monitoring.watch_settings import engine_of, something_to_watch

    if args.plot and find_spec("matplotlib") is None:
        raise Trouble("--plot needs matplotlib: pip install 'bondgraph-arr[robot]'")
    logs = read_logs(args)
    rate = args.rate or rate_of(logs[0][1].fastest()) or Options().rate
    compilation = realising(args, rate=rate, bandwidth=args.bandwidth)
    something_to_watch(compilation)
    engine = engine_of(compilation)
    mapping = read_map(args.map, engine.signals) if args.map else None
    free = [name.strip() for names in args.free for name in names.split(",") if name.strip()]
    graph = compilation.graph
    names = [v.name for v in graph.values]
    names += [s.name for s in graph.sensors] + [i.name for i in graph.inputs]
    for name in free:
        if name not in names:
            raise console.Unknown(name, "no parameter, sensor or input of the model", names)
    times = times_of(logs)
    try:
        with console.progress_bar("fitting") as progress:
            found = compilation.fit(
                dict(logs),
                free or None,
                _noise(args, compilation),
                mapping,
                progress,
                operating=args.operating,
            )
    except ValueError as error:
        raise Trouble(str(error)) from error
    write_whole(args.output, _file(compilation, found))
    files = [args.output]
    if args.plot:
        write_whole(args.plot, _plot(compilation, found, logs[0][0]))
        files.append(args.plot)
    return console.told(
        args.json,
        compilation.report.diagnostics,
        _message(compilation, found),
        lambda: {"files": files, **_result(compilation, found), "times": times},
        lambda: _lines(compilation, found, files),
    )


def _noise(args: Namespace, compilation: Compilation) -> dict[str, float]:
    signals = [k.path for k in compilation.program.knowns if k.kind != "mode"]
    sensors = [k.path for k in compilation.program.knowns if k.kind == "sensor"]
    found: dict[str, float] = {}
    check_units(compilation.graph, args.noise)
    check_read(compilation.graph, [name for name, _ in args.noise if name], signals)
    for name, deviation in args.noise:
        found |= dict.fromkeys([name] if name else sensors, deviation)
    return found


def _message(compilation: Compilation, found: Fitted) -> str:
    told = sum(p.error is not None for p in found.parameters)
    many = plural(len(found.parameters), "parameter")
    if found.offsets:
        known = sum(p.error is not None for p in found.offsets)
        many += f" and {known} of {plural(len(found.offsets), 'offset')}"
    doubted = sum(p.doubted for p in (*found.parameters, *found.offsets))
    return (
        f"{compilation.graph.name}: {told} of {many} told by {lasting(found.seconds, '.3g')} of"
        f" healthy operation{f', {doubted} fitted without an interval' if doubted else ''}"
    )


def _result(compilation: Compilation, found: Fitted) -> dict[str, object]:
    return {
        "model": compilation.graph.name,
        "seconds": found.seconds,
        "logs": found.logs,
        "bandwidth": found.bandwidth,
        "spread": found.spread,
        "parameters": [{**p._asdict(), "interval": p.interval} for p in found.parameters],
        "starts": [s._asdict() for s in found.starts],
        "offsets": [{**p._asdict(), "interval": p.interval} for p in found.offsets],
        "suspects": [s._asdict() for s in found.suspects],
        "correlation": found.correlation.tolist(),
        "combinations": [{**c._asdict(), "text": c.text()} for c in found.combinations],
        "residuals": [
            {**x._asdict(), "explained": x.explained, "wrong": x.wrong,
             "spans": [s._asdict() for s in x.spans]}
            for x in found.left
        ],
        "delays": [d._asdict() for d in found.delays],
        "noise": found.noise,
    }


def _file(compilation: Compilation, found: Fitted) -> str:
    """The parameters as a TOML text that `--parameters` takes, in SI."""
    lines = [
        f"# Parameters of {compilation.graph.name}, fitted to {found.seconds:.3g} s of healthy"
        " operation.",
        "# Numbers are in SI units. --parameters FILE takes them in place of those of the model.",
        "",
        "[parameters]",
    ]
    options, fitted = compilation.options, (*found.parameters, *found.offsets)
    lines += [_line(p) for p in found.parameters]
    lines += _given(options.parameters, found.parameters)
    offsets = [_line(p) for p in found.offsets] + _given(options.offsets, found.offsets)
    if offsets:
        lines += ["", "# What samples of a signal are too large by: it is taken off first."]
        lines += ["[offsets]", *offsets]
    tolerances = [f'"{p.name}" = {p.tolerance!r}' for p in fitted if p.tolerance is not None]
    tolerances += _given(options.tolerances, (p for p in fitted if p.tolerance is not None))
    if tolerances:
        lines += ["", "# Relative, in place of those of the model: further logs of this machine are"
                  " within", "# them in 95 of 100. Without this section those of the model stay."]
        lines += ["[tolerances]", *tolerances]
    if found.faster:
        lines += ["", "# rad/s, as logs tell them much better with it than with the usual filter.",
                  "# `tune` and `monitor` take it where no other is asked for."]
        lines += ["[filter]", f"bandwidth = {found.bandwidth!r}"]
    lines += ["", "[standard_errors]"]
    lines += [f'"{p.name}" = {p.error!r}' for p in fitted if p.error is not None]
    return "\n".join(lines) + "\n"


def _given(
    numbers: Mapping[str, float] | Iterable[tuple[str, float]], fitted: Iterable[Fitting]
) -> list[str]:
    """What `--parameters` and `--set` said and was not fitted: the fit holds together with it."""
    known = {p.name for p in fitted}
    own = dict(numbers).items()
    return [f'"{name}" = {value!r}  # as given' for name, value in own if name not in known]


def _line(p: Fitting) -> str:
    note = "not told by the logs" if p.interval is None else f"+- {p.interval:.2g} (95 %)"
    note = "no interval: the model leaves something out" if p.doubted else note
    return f'"{p.name}" = {p.value!r}  # {_about(p, note)}'


def _about(p: Fitting, note: str) -> str:
    return f"{p.unit}, {note}" if p.unit else note


def _plot(compilation: Compilation, found: Fitted, log: str) -> str:
    """The terms of the residuals over one log."""
    from bondgraph.backends.report.fit_figure import Compared, figure

    compared = [Compared(*one) for one in found.terms if one.log == log]
    if not compared:
        raise Trouble(f"nothing to plot: no residual with a parameter is valid in {log}")
    return figure(f"the fit of {compilation.graph.name} to {log}", compared)


def _lines(compilation: Compilation, found: Fitted, files: list[str]) -> list[str]:
    declared = compilation.diagnosis_model.tolerances
    narrower = any(p.tolerance is not None for p in found.parameters)
    head = ("parameter", "nominal", "fitted", "+- (95 %)", "unit")
    rows: list[tuple[str, ...]] = [(*head, *(["tolerance"] if narrower else []))]
    for p in (*found.parameters, *found.offsets):
        sure = "not told" if p.interval is None else f"{p.interval:.2g}"
        sure = "at its bound" if p.bound else "no interval" if p.doubted else sure
        name = f"offset of {p.name}" if p in found.offsets else p.name
        tolerance = declared.get(p.name) if p.tolerance is None else p.tolerance
        within = [f"{100 * tolerance:.3g} %" if tolerance else ""] if narrower else []
        rows.append((name, f"{p.nominal:.6g}", f"{p.value:.6g}", sure, p.unit, *within))
    lines = [_message(compilation, found), "", *console.columns(rows)]
    lines += _starts(found)
    lines += _tolerances(found, declared)
    lines += _outside(found, declared)
    if any(p.bound for p in found.parameters):
        names = ", ".join(p.name for p in found.parameters if p.bound)
        lines += ["", f"With another sign {names} would fit better: see to the signs of the"
                  " signals, and to the model, unless the logs hardly tell of it."]  # fmt: skip
    if any(p.doubted for p in (*found.parameters, *found.offsets)):
        lines += ["", "Without an interval: they fit best, but the residuals that tell them hold"
                  " more than noise (see below)"]  # fmt: skip
    if found.combinations:
        lines += ["", "What the logs cannot tell (such parameters are no better known than as"
                  " declared, or too small to be told)"]  # fmt: skip
        for c in found.combinations:
            lines += [f"  {c.text()}", f"    {c.which()}"]
    lines += ["", f"How well it fits (filter of {found.bandwidth:.4g} rad/s)"]
    for left in found.left:
        lines += [f"  {text}" for text in _fits(left, bool(found.suspects))]
    lost = {left.residual: left.lost for left in found.left if left.lost}
    lines += [f"  {text}" for text in behind_gaps(lost)]
    lines += _suspected(found)
    lines += _misread(compilation, found)
    for delay in found.delays:
        if abs(delay.value) > _LATE * delay.error:
            off = abs(delay.value)
            when = f"{off:.3g} s" if off >= 1.0 else f"{1000 * off:.3g} ms"
            when += " early" if delay.value > 0.0 else " late"
            more = " or more: no more is fitted, declare it in the model by `delay`"
            more = more if delay.bound else ""
            if any(left.wrong for left in found.left):
                more += "; a lag that the model leaves out looks the same"
            lines.append(f"  {delay.signal} comes {when} in the log{more}")
    return [*lines, "", f"Written to {joined(files, 'and')}"]


def _starts(found: Fitted) -> list[str]:
    """Where each log begins, of what nobody knew it."""
    names = list(dict.fromkeys(s.name for s in found.starts))
    if not names:
        return []
    rows: list[tuple[str, ...]] = [("", *(x for name in names for x in (name, "+- (95 %)")))]
    for log, time, later in dict.fromkeys((s.log, s.time, s.later) for s in found.starts):
        row = [f"{log} from {moment(time)}" if later else log]
        for name in names:
            own = [s for s in found.starts if (s.name, s.log, s.time) == (name, log, time)]
            row += _start(own[0]) if own else ["", ""]
        rows.append(tuple(row))
    return ["", "Where logs begin, and what is behind their gaps: no part of the file, a watch"
            " finds it anew", *console.columns(rows)]  # fmt: skip


def _start(one: Start) -> list[str]:
    return [f"{one.value:.6g}", "not told" if one.interval is None else f"{one.interval:.2g}"]


def _tolerances(found: Fitted, declared: Mapping[str, float]) -> list[str]:
    """What became of the tolerances of the model, in words."""
    narrower = [p for p in found.parameters if p.tolerance is not None]
    told = [p for p in found.parameters if p.error is not None and declared.get(p.name)]
    if narrower:
        before = listed([f"{p.name} {100 * declared[p.name]:.3g} %" for p in narrower], "and")
        return ["", f"The file has these tolerances instead of {before}: further logs of this"
                " machine are within them in 95 of 100"]  # fmt: skip
    if told and found.logs == 1:
        return ["", "Tolerances stay as declared: one log does not tell how far parameters"
                " stand apart from one to the next, three do"]  # fmt: skip
    return []


def _outside(found: Fitted, declared: Mapping[str, float]) -> list[str]:
    """The parameters that are farther from their nominal values than the model says, in words."""
    out = [
        p for p in found.parameters
        if abs(p.value - p.nominal) - (p.interval or 0.0)
        > declared.get(p.name, math.inf) * abs(p.nominal)
    ]  # fmt: skip
    if not out:
        return []
    each = [
        f"{p.name} {100 * (p.value - p.nominal) / abs(p.nominal):+.3g} %"
        f" (+- {100 * declared[p.name]:.3g} %)"
        for p in out
    ]
    lines = ["", f"Outside of declared tolerances: {listed(each, 'and')}"]
    loose = [p.name for p in out if p.error is None]
    kept = [p.name for p in (*found.parameters, *found.offsets) if p.name not in loose]
    if loose and kept:
        only = "only makes" if len(loose) == 1 else "only make"
        lines.append(f"  {listed(loose, 'and')} {only} the residuals small: leave out of the fit"
                     f" what is known better (--free {','.join(kept)})")  # fmt: skip
    return lines


def _suspected(found: Fitted) -> list[str]:
    """The offsets that would explain what is left, in words; each would do it by itself."""
    fitted = [p.name for p in (*found.parameters, *found.offsets)]
    lines: list[str] = []
    for one in found.suspects[:_SUSPECTS]:
        value = f"{one.value:.3g}" + (f" {one.unit}" if one.unit not in ("", "1") else "")
        lines.append(
            f"  {'or' if lines else 'What is left does not stand at zero:'} an offset of"
            f" {one.signal} of {value} would explain {100 * one.share:.3g} % of it"
            f" (--free {','.join([*fitted, one.signal])})"
        )
    return lines


def _misread(compilation: Compilation, found: Fitted) -> list[str]:
    """The inputs whose noise would look like another model, in words: they are taken as exact.

    Of those that the residuals read which say that the model is another.
    """
    sees = compilation.diagnosis_model.sees
    read = {name for left in found.left if left.wrong and left.follows is not None
            for name in sees.get(left.residual, ())}  # fmt: skip
    inputs = [k.path for k in compilation.program.knowns if k.kind == "input" and k.path in read]
    exact = [name for name in inputs if not found.noise.get(name)]
    if not exact:
        return []
    each = " ".join(f"--noise {name}=DEVIATION" for name in exact[:_SUSPECTS])
    return [f"  An input that is read with noise looks the same: say with how much ({each})"]


def _fits(left: Left, offset: bool) -> list[str]:
    """What is left of one residual, in words; an `offset` may be what is wrong."""
    if not left.after and not left.before:
        return [f"{left.residual}: {'zero' if left.rows else 'never valid'} in these logs"]
    if left.nothing:
        share = f"{100 * left.after / left.term:.1g} % of its largest term"
        return [f"{left.residual}: what is left is {share}, as of samples without noise"]
    if left.before and abs(left.explained) < 5e-4:
        text = "as large as at the nominal values"
    elif left.explained < 0.0:  # other residuals tell its parameters better, and move them
        text = f"{left.after / left.before:.3g} times what it is at the nominal values"
        if left.louder * left.before > left.after:  # its terms grew together: that is no misfit
            text += f", and its noise {left.louder:.3g} times: beside that it is less"
    else:
        text = f"{100 * left.explained:.1f} % of it at the nominal values is explained"
    text = f"{left.residual}: {text}"
    text += f"; what is left is {left.times:.2g} times the noise of the sensors"
    if left.wrong and left.follows is not None:
        text += f", and {100 * left.follows:.0f} % of it follows the inputs: the model is another"
        text += ", or there is an offset" if offset else ""
    elif left.much and not left.wrong:
        text += ", and does not follow the inputs: a disturbance, which the intervals reckon with"
    elif left.memory > _MEMORY:
        text += ", and no white noise: the model leaves something out"
    lines = [text]
    for span in left.spans[:3]:
        lines.append(
            f"  {span.log}: from {moment(span.start, '.4g')} to {moment(span.end, '.4g')}"
            f" it is {span.times:.2g} times as large as usual"
        )
    if len(left.spans) > 3:
        lines.append(f"  and so at {plural(len(left.spans) - 3, 'other time')}")
    return lines
