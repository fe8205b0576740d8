"""The sensitivities of a model for its report, and the smallest changes that show.

What signals and their noise are taken to be is read from scenarios, told, or assumed.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from bondgraph.algebra.present import Parts, parts, shared
from bondgraph.backends.report.content import Effect, Pairs, Seen
from bondgraph.backends.report.formulas import operations
from bondgraph.cli.reporting.relations import LONGEST
from bondgraph.runtime.simulation.parameters import units
from bondgraph.text.moment import often
from bondgraph.text.numerals import listed, readable
from bondgraph.text.tuples import NamedTuple

if TYPE_CHECKING:
    from argparse import Namespace
    from collections.abc import Mapping, Sequence

    from bondgraph.backends.report.formulas import Typesetter
    from bondgraph.compilation import Compilation
    from bondgraph.ir.program import Program
    from bondgraph.runtime.log import Array
    from bondgraph.runtime.simulation.run import Run
    from bondgraph.runtime.smallest import Answers, Detection, Situation, Smallest
    from bondgraph.views import Relation

_WIDE = 22.0  # em, of a piece of a formula: they stand in a column
_ROOM = 400_000  # characters of all formulas


class Assumed(NamedTuple):
    """The situation that smallest changes are told for, and sentences that say what it is.

    With `samples`, (n, signals of the engine), these are what the machine does.
    """

    situation: Situation
    words: tuple[str, ...]
    samples: tuple[Array, ...] = ()


def seen(
    compilation: Compilation,
    typesetter: Typesetter,
    program: Program | None,
    assumed: Assumed | None,
) -> Seen:
    """Every residual with every fault that it sees; no numbers without program or situation."""
    detection, missing, answers = _detection(compilation, program, assumed)
    smallest = {} if detection is None else {(s.fault, s.residual): s for s in detection.smallest}
    units = _units(compilation)
    effects: list[Effect] = []
    spent = 0
    by_fault = {f: i for i, f in enumerate(compilation.graph.faults)}
    for relation in compilation.residuals:
        form = parts(compilation.graph, relation.residual)
        for fault in relation.faults:
            html, too_long = "", "not written out here"
            if spent < _ROOM:
                html, too_long = _formula(typesetter, relation, fault, form)
                spent += len(html)
            found = smallest.get((fault, relation.name))
            told = _told(found, units.get(fault, ""))
            effects.append(Effect(fault, relation.name, html, too_long, *told))
    effects.sort(key=lambda e: by_fault[e.fault])
    words = assumed.words if detection is not None and assumed is not None else ()
    noise = () if detection is None else tuple(_noise(detection))
    pairs: Pairs | None = None
    orders: tuple[tuple[str, str], ...] = ()
    if answers is not None and assumed is not None:
        pairs = _pairs(compilation, assumed.situation, units)
        orders = _answers(answers, detection, units)
    return Seen(tuple(effects), words, noise, missing, pairs, orders)


def _detection(
    compilation: Compilation, program: Program | None, assumed: Assumed | None
) -> tuple[Detection | None, str, Answers | None]:
    from bondgraph.runtime.shown import shown
    from bondgraph.runtime.smallest import Answers

    if program is None or assumed is None:
        return None, "there is no code for it", None
    tolerances = {v.name: float(v.tolerance) for v in compilation.graph.values if v.tolerance}
    try:
        if assumed.samples:
            engine = compilation.engine()
            received = compilation.program_with_readings
            own = shown(received, engine, tolerances, assumed.situation, assumed.samples)
            return own, "", None
        answers = Answers(compilation.program_with_readings, compilation.thresholds, tolerances,
                          assumed.situation)  # fmt: skip
        return answers.detection, "", answers
    except ValueError as error:
        return None, str(error), None


def _pairs(
    compilation: Compilation, situation: Situation, units: Mapping[str, str]
) -> Pairs | None:
    """How large a fault has to be to be told from others; None where no two are told apart."""
    from bondgraph.runtime.separation import separation

    tolerances = {v.name: float(v.tolerance) for v in compilation.graph.values if v.tolerance}
    found = separation(compilation.program_with_readings, tolerances, situation)
    if len(found.groups) < 2:
        return None
    rows = []
    for fault, row in zip(found.faults, found.changes, strict=True):
        sizes = [row[g[0]] for g in found.groups]
        cells = ["" if x is None else f"{readable(x)} {units.get(fault, '')}".rstrip()
                 for x in sizes]  # fmt: skip
        rows.append((fault, tuple(cells)))
    return Pairs(tuple(tuple(found.faults[k] for k in g) for g in found.groups), tuple(rows))


def _answers(
    answers: Answers, detection: Detection | None, units: Mapping[str, str]
) -> tuple[tuple[str, str], ...]:
    """How residuals answer each fault as it grows, in words."""
    faults = dict.fromkeys(s.fault for s in detection.smallest) if detection else ()
    found = []
    for fault in faults:
        order = answers.order(fault)
        if order is not None:
            size = f"{readable(order.size)} {units.get(fault, '')}".rstrip()
            found.append((fault, f"+{size}: {order.told()}"))
    return tuple(found)


def _formula(
    typesetter: Typesetter, relation: Relation, fault: str, form: Parts
) -> tuple[str, str]:
    """The derivative as HTML, or why it is not written."""
    slope = relation.sensitivity_node(fault)
    size = operations(slope)
    if size > LONGEST // 4:
        return "", f"{size} operations, not written out here"
    head = (
        f"<mfrac><mrow><mo>∂</mo>{typesetter.name(relation.name).text}</mrow>"
        f"<mrow><mo>∂</mo>{typesetter.name(fault).text}</mrow></mfrac>"
    )
    named = shared(slope, form.variables, form.taken)
    return "".join(typesetter.equations(head, named, _WIDE)), ""


def _told(found: Smallest | None, unit: str) -> tuple[str, str, str]:
    if found is None:
        return "", "", ""
    if found.change is None:
        return "", "", found.reason
    share = "" if found.relative is None else f"{readable(100 * found.relative)} %"
    return f"{readable(found.change)} {unit}".rstrip(), share, ""


def _noise(found: Detection) -> list[tuple[str, str]]:
    rows = []
    for name, sigma in found.sigma.items():
        text = "grows for ever: the residual integrates it" if sigma is None else readable(sigma)
        rows.append((name, "no value at these signals" if name in found.undefined else text))
    return rows


def _units(compilation: Compilation) -> dict[str, str]:
    found = units(compilation.graph)
    return {name: unit for name, unit in found.items() if unit and unit != "1"}


def assumed(args: Namespace, given: Situation, program: Program) -> Assumed:
    """The situation of the arguments, completed, and all of it in words.

    Without signals each swings by 1 around 1, in its unit; without noise it is that of samples of
    `--bits` over the range of each signal, a step over the square root of 12. A program that
    iterates gets constant signals: a second of samples would take it a minute.
    """
    words = []
    signals = [k for k in program.knowns if k.kind != "mode"]
    if not (args.at or args.swing):
        ones = {k.path: 1.0 for k in signals}
        swing = {} if program.roots else ones
        given = given._replace(at=ones, swing=swing)
        moves = "be 1" if program.roots else "swing by 1 around 1"
        rhythm = "" if program.roots else f" at {given.frequency:g} Hz"
        words.append(
            f"Nothing was said of what the machine does: every signal is taken to {moves}, in its"
            f" own unit{rhythm} (`--at`, `--swing`). The sizes below compare faults and residuals;"
            " they are not those of a real run."
        )
    else:
        told = [f"{n} at {v:g}" for n, v in given.at.items()]
        told += [f"{n} swings by {v:g}" for n, v in given.swing.items()]
        words.append(f"Signals, as given: {', '.join(told)}, at {given.frequency:g} Hz; others 0.")
    ranges = {k.path: _range(given.at.get(k.path, 0.0), given.swing.get(k.path, 0.0))
              for k in signals}  # fmt: skip
    return _measured(args, program, given, words, ranges)


def observed(
    args: Namespace,
    given: Situation,
    compilation: Compilation,
    program: Program,
    runs: Sequence[Run],
) -> Assumed:
    """The situation of scenarios: their signals until something goes wrong, and their noise.

    As if there were none where their samples are too few or too far apart.
    """
    from bondgraph.runtime.monitoring.watch_settings import engine_of
    from bondgraph.runtime.monitoring.whole_logs import on_grid

    engine = engine_of(compilation)
    samples, stretches = [], []
    for run in runs:
        end = min((f.at for f in run.scenario.faults), default=math.inf)
        if end < 3.0 * engine.warm_up:  # nothing would be left
            end = math.inf
        log = run.log.part(0, int((run.log.time < end).sum()))
        pieces = on_grid(engine, log)
        enough = engine.warm_up / engine.sample_time
        samples += [p.samples for p in pieces if len(p.samples) > enough]
        until = "" if math.isinf(end) else f" (until its fault at {end:g} s)"
        stretches.append(f"`{run.scenario.name}`{until}")
    if not samples:
        return assumed(args, given, program)
    every = np.concatenate(samples)
    at, ranges = {}, {}
    for k, known in enumerate(engine.signals):
        column = every[:, k]
        column = column[np.isfinite(column)]
        if known.counts is not None and len(column) > 1:
            turns = np.diff(column) / known.counts
            column = 2.0 * math.pi * turns / engine.sample_time
        at[known.path] = float(column.mean()) if len(column) else 0.0
        ranges[known.path] = float(np.ptp(np.append(column, 0.0))) or 1.0
    given = given._replace(at=at, swing={})
    words = [
        f"Signals are those of the scenario{'s' * (len(runs) > 1)} {listed(stretches, 'and')}."
    ]
    found = {
        name: math.hypot(one.noise, one.step / math.sqrt(12))
        for run in runs
        for name, one in run.scenario.instruments.items()
    }
    found = {name: size for name, size in found.items() if size}
    if found and not args.noise:
        given = given._replace(noise=found)
        told = [f"{name} {size:.3g}" for name, size in found.items()]
        words.append(f"Noise, as in there: standard deviation of {', '.join(told)}; white.")
    rest = _measured(args, program, given, words, ranges)
    return rest._replace(samples=tuple(samples))


def _measured(
    args: Namespace,
    program: Program,
    given: Situation,
    words: list[str],
    ranges: Mapping[str, float],
) -> Assumed:
    """With noise where nobody has told any, and all of it in words."""
    signals = [k for k in program.knowns if k.kind != "mode"]
    bare = [k for k in signals
            if k.kind == "sensor" and k.counts is None and k.path not in given.noise]  # fmt: skip
    if args.noise:
        told = [f"{n} {v:g}" for n, v in given.noise.items()]
        words.append(f"Noise, as given: standard deviation of {', '.join(told)}; white.")
    elif bare:
        size = 2.0**-args.bits / math.sqrt(12)
        more = {k.path: size * ranges[k.path] for k in bare}
        what, whose = ("more noise", "every other") if given.noise else ("noise", "every")
        given = given._replace(noise={**given.noise, **more})
        words.append(
            f"Nothing was said of {what} (`--noise`): {whose} sensor has that of"
            f" {args.bits}-bit samples over its range here, white, a step over the square root of"
            " 12."
        )
    if any(k.counts is not None for k in signals):
        words.append("An encoder has the noise of its counts, evenly spread over one.")
    words.append(
        f"A change counts as seen where it moves the residual past its adaptive threshold and"
        f" {given.kappa:g} standard deviations of the filtered noise:"
        f" {often(program.rate)}, a filter of {program.bandwidth:g} rad/s."
    )
    return Assumed(given, tuple(words))


def _range(at: float, swing: float) -> float:
    """From the least to the largest that a signal is, zero included; 1 where it is always zero."""
    least, most = min(0.0, at - abs(swing)), max(0.0, at + abs(swing))
    return most - least or 1.0
