"""The sensitivities of a model for its report, and the smallest changes that show."""

from __future__ import annotations

from typing import TYPE_CHECKING

from bondgraph.algebra.present import parts, shared
from bondgraph.backends.report.content import Effect, Seen
from bondgraph.backends.report.formulas import operations
from bondgraph.cli.reporting.relations import LONGEST
from bondgraph.runtime.simulation.parameters import units
from bondgraph.text.numerals import readable
from bondgraph.text.tuples import NamedTuple

if TYPE_CHECKING:
    from bondgraph.backends.report.formulas import Typesetter
    from bondgraph.ir.expr import Expr
    from bondgraph.ir.program import Program
    from bondgraph.pipeline import Compilation
    from bondgraph.runtime.log import Array
    from bondgraph.runtime.smallest import Detection, Situation, Smallest
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
    detection, missing = _detection(compilation, program, assumed)
    smallest = {} if detection is None else {(s.fault, s.residual): s for s in detection.smallest}
    units = _units(compilation)
    effects: list[Effect] = []
    spent = 0
    by_fault = {f: i for i, f in enumerate(compilation.graph.faults)}
    for relation in compilation.residuals:
        values = parts(compilation.graph, relation.residual).variables
        for fault in relation.faults:
            html, too_long = "", "not written out here"
            if spent < _ROOM:
                html, too_long = _formula(typesetter, relation, fault, values)
                spent += len(html)
            found = smallest.get((fault, relation.name))
            told = _told(found, units.get(fault, ""))
            effects.append(Effect(fault, relation.name, html, too_long, *told))
    effects.sort(key=lambda e: by_fault[e.fault])
    words = assumed.words if detection is not None and assumed is not None else ()
    noise = () if detection is None else tuple(_noise(detection))
    return Seen(tuple(effects), words, noise, missing)


def _detection(
    compilation: Compilation, program: Program | None, assumed: Assumed | None
) -> tuple[Detection | None, str]:
    from bondgraph.runtime.shown import shown
    from bondgraph.runtime.smallest import smallest

    if program is None or assumed is None:
        return None, "there is no code for it"
    tolerances = {v.name: float(v.tolerance) for v in compilation.graph.values if v.tolerance}
    try:
        if assumed.samples:
            engine = compilation.engine()
            received = compilation.program_with_readings
            return shown(received, engine, tolerances, assumed.situation, assumed.samples), ""
        found = smallest(compilation.program_with_readings, compilation.thresholds, tolerances,
                         assumed.situation)  # fmt: skip
        return found, ""
    except ValueError as error:
        return None, str(error)


def _formula(
    typesetter: Typesetter, relation: Relation, fault: str, values: dict[Expr, str]
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
    return "".join(typesetter.equations(head, shared(slope, values), _WIDE)), ""


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
