"""`bondgraph detect`: the smallest change of each fault that the residuals show."""

from __future__ import annotations

from typing import TYPE_CHECKING

from bondgraph.cli import console
from bondgraph.cli.options import isolating, opened, realised, sampling, signals
from bondgraph.cli.terminal_layout import names as listed
from bondgraph.cli.terminal_layout import width
from bondgraph.text.diagnostic import Trouble

if TYPE_CHECKING:
    from argparse import ArgumentParser, Namespace

    from bondgraph.ir.program import Program
    from bondgraph.pipeline import Compilation
    from bondgraph.runtime.separation import Separation
    from bondgraph.runtime.smallest import Detection, Situation, Smallest


def arguments(parser: ArgumentParser) -> None:
    """The arguments of `detect`."""
    parser.add_argument("model", metavar="MODEL", help="file.bg or file.bg:Name")
    parser.add_argument("--json", action="store_true", help="print one JSON object (docs/json.md)")
    parser.add_argument("--pairs", action="store_true",
                        help="also how large each fault has to be to be told from each other"
                        " one")  # fmt: skip
    sampling(parser)
    signals(parser)
    isolating(parser)
    realised(parser)


def situation_of(args: Namespace, program: Program) -> Situation:
    """What the arguments say; raises Unknown for a name that no known signal has."""
    from bondgraph.runtime.smallest import Situation

    paths = [k.path for k in program.knowns]
    for name, _ in (*args.at, *args.swing, *args.noise):
        if name and name not in paths:
            raise console.Unknown(name, "no known signal of the residuals", paths)
    every = dict(args.noise).get("")
    deviations = {}
    if every is not None:
        deviations = {k.path: every for k in program.knowns if k.kind == "sensor"}
    deviations |= {name: value for name, value in args.noise if name}
    return Situation(dict(args.at), dict(args.swing), deviations, args.frequency, args.kappa)


def run(args: Namespace) -> int:
    """Compile, look for the smallest changes, print."""
    from bondgraph.runtime.separation import separation
    from bondgraph.runtime.smallest import smallest

    compilation = opened(args)
    situation = situation_of(args, compilation.program)
    tolerances = {v.name: float(v.tolerance) for v in compilation.graph.values if v.tolerance}
    try:
        received = compilation.program_with_readings
        found = smallest(received, compilation.thresholds, tolerances, situation)
        apart = separation(received, tolerances, situation) if args.pairs else None
    except ValueError as error:
        raise Trouble(f"{error}, and without it nothing has a size") from error
    return console.told(
        args.json,
        compilation.report.diagnostics,
        _message(compilation, found),
        lambda: {**_result(compilation, found), **_told_apart(compilation, apart)},
        lambda: _lines(compilation, found, situation) + _pairs(compilation, apart, situation),
    )


def _message(compilation: Compilation, found: Detection) -> str:
    shown = {s.fault for s in found.smallest if s.change is not None}
    every = dict.fromkeys(s.fault for s in found.smallest)
    return f"{len(shown)} of {len(every)} faults show with these signals"


def _result(compilation: Compilation, found: Detection) -> dict[str, object]:
    units, unbounded = _units(compilation), _unbounded(compilation)
    return {
        "model": compilation.graph.name,
        "rate": compilation.program.rate,
        "bandwidth": compilation.program.bandwidth,
        "noise": [
            {
                "residual": name,
                "sigma": sigma,
                "no_threshold": unbounded.get(name),
                "undefined": name in found.undefined,
            }
            for name, sigma in found.sigma.items()
        ],
        "faults": [_row(s, units) for s in found.smallest],
    }


def _told_apart(compilation: Compilation, found: Separation | None) -> dict[str, object]:
    """For each fault what it takes to tell it from each other one; nothing if not asked for."""
    if found is None:
        return {}
    units = _units(compilation)
    rows = zip(found.faults, found.changes, strict=True)
    return {"pairs": [{"fault": a, "unit": units.get(a, ""),
                       "from": {b: x for b, x in zip(found.faults, row, strict=True) if a != b}}
                      for a, row in rows]}  # fmt: skip


def _row(found: Smallest, units: dict[str, str]) -> dict[str, object]:
    unit = units.get(found.fault, "")
    return {**found._asdict(), "unit": unit, "reason": found.reason or None}


def _unbounded(compilation: Compilation) -> dict[str, str]:
    """The residuals whose tolerances make no threshold, with the reason."""
    bounds = compilation.thresholds
    return {} if bounds is None else {r.path: r.unavailable for r in bounds.residuals
                                      if r.unavailable}  # fmt: skip


def _units(compilation: Compilation) -> dict[str, str]:
    from bondgraph.runtime.simulation.parameters import units

    return units(compilation.graph)


def _lines(compilation: Compilation, found: Detection, situation: Situation) -> list[str]:
    program = compilation.program
    lines = [
        f"{compilation.graph.name}: {_message(compilation, found)}",
        f"{program.rate:g} samples a second, filter of {program.bandwidth:g} rad/s,"
        f" {situation.kappa:g} sigma of noise",
        "",
        "Noise of the filtered residuals",
    ]
    for name, sigma in found.sigma.items():
        what = "grows for ever" if sigma is None else f"{sigma:.3g}"
        if name in found.undefined:
            what = "has no value at these signals: give --at what the machine does"
        lines.append(f"  {name}  {what}")
    for name, why in _unbounded(compilation).items():
        lines.append(f"  {name}  has no adaptive threshold, only noise counts: {why}")
    units = _units(compilation)
    rows = [("fault", "residual", "smallest change", "")]
    rows += [(s.fault, s.residual, *_change(s, units.get(s.fault, ""))) for s in found.smallest]
    sizes = [max(len(row[k]) for row in rows) for k in range(3)]
    lines.append("")
    for row in rows:
        text = "  ".join(cell.ljust(n) for cell, n in zip(row[:3], sizes, strict=True))
        lines.append(f"{text}  {row[3]}".rstrip()[: max(width(), sum(sizes) + 50)])
    if not any((*situation.at.values(), *situation.swing.values())):
        lines += ["", "All signals are zero: parameters need signals to be seen, give --at or"
                  " --swing."]  # fmt: skip
    return lines


def _pairs(
    compilation: Compilation, found: Separation | None, situation: Situation
) -> list[str]:
    """A row for each fault, a column for each group; too wide a table is a list by fault."""
    if found is None:
        return []
    units, groups = _units(compilation), found.groups
    if len(groups) < 2:
        return ["", "No fault is told from another with these signals."]
    head = [found.faults[g[0]] + (f" +{len(g) - 1}" if len(g) > 1 else "") for g in groups]
    kappa = f"{situation.kappa:g} sigma"
    lines = ["", f"Smallest change that no change of another fault explains ({kappa})"]
    names = [f"{f} ({units[f]})" if units.get(f) else f for f in found.faults]
    cells = [["-" if row[g[0]] is None else f"{row[g[0]]:.3g}" for g in groups]
             for row in found.changes]  # fmt: skip
    first, sizes = max(map(len, names)), [max(8, len(h)) for h in head]
    if first + sum(sizes) + 2 * len(sizes) > width():
        for name, row in zip(names, cells, strict=True):
            shown = [f"{h} {x}" for h, x in zip(head, row, strict=True) if x != "-"]
            lines += [name, *listed(shown, width(), "    from ")]
    else:
        table = [["", *head], *([n, *row] for n, row in zip(names, cells, strict=True))]
        for label, *row in table:
            shown = [x.rjust(n) for x, n in zip(row, sizes, strict=True)]
            lines.append("  ".join([label.ljust(first), *shown]))
    for group in groups:
        if len(group) > 1:
            lines += listed([found.faults[k] for k in group], width(), "  not told apart: ")
    if not any(situation.noise.values()):
        lines += ["", "Without --noise tolerances and counts of encoders alone make these sizes."]
    return lines


def _change(found: Smallest, unit: str) -> tuple[str, str]:
    """The change with its unit, and its share of the nominal value or why there is none."""
    if found.change is None:
        return "-", found.reason
    size = f"{found.change:.3g} {unit}".rstrip()
    return size, "" if found.relative is None else f"{100 * found.relative:.3g} %"
