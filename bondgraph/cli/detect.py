"""`bondgraph detect`: the smallest change of each fault that the residuals show."""

from __future__ import annotations

from itertools import pairwise
from typing import TYPE_CHECKING, NamedTuple

from bondgraph.cli import console
from bondgraph.cli.options import (
    check_read,
    check_units,
    isolating,
    opened,
    realised,
    sampling,
    signals,
)
from bondgraph.cli.terminal_layout import names as listed
from bondgraph.cli.terminal_layout import width
from bondgraph.text.diagnostic import Trouble
from bondgraph.text.moment import often
from bondgraph.text.numerals import plural

if TYPE_CHECKING:
    from argparse import ArgumentParser, Namespace
    from collections.abc import Iterator

    from bondgraph.compilation import Compilation
    from bondgraph.ir.graph import BondGraph
    from bondgraph.ir.program import Program
    from bondgraph.ir.residuals import Form
    from bondgraph.runtime.separation import Separation
    from bondgraph.runtime.smallest import Answers, Detection, Order, Situation, Smallest


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
    realised(parser, None)


def situation_of(args: Namespace, graph: BondGraph, program: Program) -> Situation:
    """What the arguments say; raises Unknown or Trouble for what is no signal of the residuals."""
    from bondgraph.runtime.smallest import Situation

    told = [name for name, _ in (*args.at, *args.swing, *args.noise) if name]
    check_read(graph, told, [k.path for k in program.knowns])
    every = dict(args.noise).get("")
    deviations = {}
    if every is not None:
        deviations = {k.path: every for k in program.knowns if k.kind == "sensor"}
    deviations |= {name: value for name, value in args.noise if name}
    return Situation(dict(args.at), dict(args.swing), deviations, args.frequency, args.kappa)


class Row(NamedTuple):
    """A fault in one form of a residual, the `second` of two or the only one.

    `delay` in s is how long a change of `size` takes to be sure to be seen.
    """

    form: str
    found: Smallest
    second: bool
    size: float | None = None
    delay: float | None = None


def run(args: Namespace) -> int:
    """Compile, look for the smallest changes, print."""
    from bondgraph.runtime.separation import separation

    compilation = opened(args)
    check_units(compilation.graph, (*args.at, *args.swing, *args.noise))
    if not compilation.residuals:
        return _nothing(args, compilation)
    situation = situation_of(args, compilation.graph, compilation.program)
    tolerances = {v.name: float(v.tolerance) for v in compilation.graph.values if v.tolerance}
    forms = {_form(args.form): compilation}
    if args.form is None and not all(isinstance(o, str) for o in compilation.observers.values()):
        forms["observer"] = compilation.in_form("observer")
    try:
        answers = {form: _answers(c, tolerances, situation) for form, c in forms.items()}
        apart = None
        if args.pairs:
            apart = separation(compilation.program_with_readings, tolerances, situation)
    except ValueError as error:
        raise Trouble(f"{error}, and without it nothing has a size") from error
    found = {form: one.detection for form, one in answers.items()}
    rows = _rows(forms, answers, found)
    first = next(iter(answers.values()))
    order = [o for f in dict.fromkeys(r.found.fault for r in rows) if (o := first.order(f))]
    return console.told(
        args.json,
        compilation.report.diagnostics,
        _message(compilation, rows),
        lambda: {
            **_result(forms, found, rows),
            "order": [_in_order(o, _units(compilation)) for o in order],
            **_told_apart(compilation, apart),
        },
        lambda: [
            *_lines(forms, found, rows, situation),
            *_answers_told(order, _units(compilation)),
            *_pairs(compilation, apart, situation),
        ],
    )


def _nothing(args: Namespace, compilation: Compilation) -> int:
    """What is said of a model without a residual: why there is none, not that signals are zero."""
    from bondgraph.cli.reasons import message

    pairs: dict[str, object] = {"pairs": []} if args.pairs else {}
    program = compilation.program
    return console.told(
        args.json,
        compilation.report.diagnostics,
        message(compilation),
        lambda: {
            "model": compilation.graph.name,
            "rate": program.rate,
            "bandwidth": program.bandwidth,
            "noise": [],
            "faults": [],
            "order": [],
            **pairs,
        },
        lambda: [f"{compilation.graph.name}: {message(compilation)}"],
    )


def _form(asked: Form | None) -> str:
    return asked if isinstance(asked, str) else "observer" if asked else "derivative"


def _answers(
    compilation: Compilation, tolerances: dict[str, float], situation: Situation
) -> Answers:
    from bondgraph.runtime.smallest import Answers

    return Answers(compilation.program_with_readings, compilation.thresholds, tolerances, situation)


def _rows(
    forms: dict[str, Compilation], answers: dict[str, Answers], found: dict[str, Detection]
) -> list[Row]:
    """Every fault in every residual; where a residual has two forms both, and a size for both.

    That is twice the smallest change, of the form that needs the larger one.
    """
    given, *other = forms.items()
    follows = {i.path for i in given[1].program.residuals if i.follows}
    second: dict[tuple[str, str], Smallest] = {}
    for form, compilation in other:
        observers = {i.path for i in compilation.program.residuals if i.follows}
        second = {s[:2]: s for s in found[form].smallest if s.residual in observers}
    rows = []
    for one in found[given[0]].smallest:
        own = "observer" if one.residual in follows else "derivative"
        both = [(own, one)]
        if one[:2] in second:
            both.append(("observer", second[one[:2]]))
        size = max([2 * s.change for _, s in both if s.change is not None], default=None)
        for at, (form, shown) in enumerate(both):
            row = Row(form, shown, at == 1)
            if size is not None and shown.change is not None:
                made = list(answers.values())[at]
                row = row._replace(size=size, delay=made.delay(*one[:2], size))
            rows.append(row)
    return rows


def _message(compilation: Compilation, rows: list[Row]) -> str:
    shown = {r.found.fault for r in rows if r.found.change is not None}
    every = dict.fromkeys(r.found.fault for r in rows)
    return f"{len(shown)} of {len(every)} faults show with these signals"


def _result(
    forms: dict[str, Compilation], found: dict[str, Detection], rows: list[Row]
) -> dict[str, object]:
    """What is found of the residuals as they are, and below `observers` of those that could be."""
    compilation = next(iter(forms.values()))
    units = _units(compilation)

    def part(second: bool) -> dict[str, object]:
        return {
            "noise": [
                {
                    "residual": name,
                    "form": form,
                    "sigma": sigma,
                    "no_threshold": unbounded.get(name),
                    "undefined": name in found[key].undefined,
                }
                for key, name, form, sigma, unbounded in _noises(forms, found)
                if (key != next(iter(forms))) == second
            ],
            "faults": [_row(r, units) for r in rows if r.second == second],
        }

    more = {"observers": part(True)} if len(forms) > 1 else {}
    return {
        "model": compilation.graph.name,
        "rate": compilation.program.rate,
        "bandwidth": compilation.program.bandwidth,
        **part(False),
        **more,
    }


def _in_order(order: Order, units: dict[str, str]) -> dict[str, object]:
    answers = [[{"residual": r, "sign": sign} for r, sign in part] for part in order.answers]
    unit = units.get(order.fault, "")
    return {"fault": order.fault, "size": order.size, "unit": unit, "answers": answers}


def _answers_told(orders: list[Order], units: dict[str, str]) -> list[str]:
    """A line a fault that more than one residual answers, or one that surely rises or falls."""
    sizes = [f"{o.size:.3g} {units.get(o.fault, '')}".rstrip() for o in orders]
    names = max((len(o.fault) for o in orders), default=0)
    wide = max(map(len, sizes), default=0)
    lines = []
    for order, size in zip(orders, sizes, strict=True):
        head = f"  {order.fault.ljust(names)}  + {size.ljust(wide)}  "
        lines += listed([order.told()], width(), head)
    return ["", "Where a fault grows", *lines] if lines else []


def _noises(
    forms: dict[str, Compilation], found: dict[str, Detection]
) -> Iterator[tuple[str, str, str, float | None, dict[str, str]]]:
    """The key of the form, residual, its form, its noise, and why residuals have no threshold."""
    for at, (key, compilation) in enumerate(forms.items()):
        unbounded = _unbounded(compilation)
        follows = {i.path for i in compilation.program.residuals if i.follows}
        for name, sigma in found[key].sigma.items():
            if at == 0 or name in follows:
                form = "observer" if name in follows else "derivative"
                yield key, name, form, sigma, unbounded


def _told_apart(compilation: Compilation, found: Separation | None) -> dict[str, object]:
    """For each fault what it takes to tell it from each other one; nothing if not asked for."""
    if found is None:
        return {}
    units = _units(compilation)
    rows = zip(found.faults, found.changes, strict=True)
    return {"pairs": [{"fault": a, "unit": units.get(a, ""),
                       "from": {b: x for b, x in zip(found.faults, row, strict=True) if a != b}}
                      for a, row in rows]}  # fmt: skip


def _row(row: Row, units: dict[str, str]) -> dict[str, object]:
    own = row.found._asdict() | {"unit": units.get(row.found.fault, ""), "form": row.form}
    return own | {"reason": row.found.reason or None, "delay": row.delay, "delay_size": row.size}


def _unbounded(compilation: Compilation) -> dict[str, str]:
    """The residuals whose tolerances make no threshold, with the reason."""
    bounds = compilation.thresholds
    return {} if bounds is None else {r.path: r.unavailable for r in bounds.residuals
                                      if r.unavailable}  # fmt: skip


def _units(compilation: Compilation) -> dict[str, str]:
    from bondgraph.runtime.simulation.parameters import units

    return units(compilation.graph)


def _lines(
    forms: dict[str, Compilation],
    found: dict[str, Detection],
    rows: list[Row],
    situation: Situation,
) -> list[str]:
    compilation = next(iter(forms.values()))
    program, both = compilation.program, len(forms) > 1
    lines = [
        f"{compilation.graph.name}: {_message(compilation, rows)}",
        f"{often(program.rate)}, filter of {program.bandwidth:g} rad/s,"
        f" {situation.kappa:g} sigma of noise",
        "",
        "Noise of the filtered residuals",
    ]
    for key, name, form, sigma, unbounded in _noises(forms, found):
        what = "grows for ever" if sigma is None else f"{sigma:.3g}"
        if name in found[key].undefined:
            what = "has no value at these signals: give --at what the machine does"
        own = f"{name}  {form}" if both else name
        lines.append(f"  {own}  {what}")
        if name in unbounded:
            why = unbounded[name]
            lines.append(f"  {own}  has no adaptive threshold, only noise counts: {why}")
    lines += ["", *_table(compilation, rows, both)]
    if both:
        lines += _compared(rows)
    if not any((*situation.at.values(), *situation.swing.values())):
        lines += ["", "All signals are zero: parameters need signals to be seen, give --at or"
                  " --swing."]  # fmt: skip
    return lines


def _table(compilation: Compilation, rows: list[Row], both: bool) -> list[str]:
    """A line a row, with what the last column says."""
    units = _units(compilation)
    cells = [("fault", "residual", "form", "smallest change", "share", "seen after")]
    for r in rows:
        size, more = _change(r.found, units.get(r.found.fault, ""))
        after = "" if r.size is None else "never" if r.delay is None else f"{r.delay:.3g} s"
        cells.append((r.found.fault, r.found.residual, r.form, size, more, after))
    used = [k for k in range(6) if k != 2 or both]
    sizes = {k: max(len(row[k]) for row in cells if k != 4 or row[5]) for k in used}
    lines = []
    for row in cells:
        text = "  ".join(row[k].ljust(sizes[k]) for k in used)
        lines.append(text.rstrip()[: max(width(), sum(sizes.values()) + 50)])
    if any(r.size is not None for r in rows):
        which = " (of the larger one of two)" if both else ""
        lines += ["", f"Seen after: how long a lasting change of twice the size{which} takes to"
                  " be sure."]  # fmt: skip
    return lines


def _compared(rows: list[Row]) -> list[str]:
    """Which residuals show faults earlier, and which show smaller ones, as observers."""
    pairs: dict[str, list[tuple[Row, Row]]] = {}
    for one, other in pairwise(rows):
        if one.found[:2] == other.found[:2]:
            pairs.setdefault(one.found.residual, []).append((one, other))
    lines = []
    for name, own in pairs.items():
        earlier = sum(_before(b.delay, a.delay) for a, b in own)
        smaller = sum(_before(b.found.change, a.found.change) for a, b in own)
        lines.append(f"{name} as an observer shows {earlier} of {plural(len(own), 'fault')}"
                     f" earlier, {smaller} of them smaller: --form observer:{name}")  # fmt: skip
    return lines


def _before(one: float | None, other: float | None) -> bool:
    return one is not None and (other is None or one < other)


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
