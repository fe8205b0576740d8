"""Say what of a sound model cannot be so: negative coefficients, sources of the other kind."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from fractions import Fraction

from bondgraph.ir.expr import Expr, Op, symbols
from bondgraph.ir.syntax import Number, Param, Ref
from bondgraph.ir.unit import Dimension, times
from bondgraph.library.units import DOMAINS, describe, parse_unit, scale
from bondgraph.passes.elaboration.problems import rough
from bondgraph.passes.elaboration.quantities import Quantities
from bondgraph.passes.elaboration.records import Tolerated
from bondgraph.passes.elaboration.scope import NodeEntry, ValueEntry
from bondgraph.text.diagnostic import Label, Report, replacing
from bondgraph.text.source import Span


def report_signs(
    coefficients: Iterable[tuple[NodeEntry, Expr]], number: Callable[[Expr], Fraction | None],
    tolerated: Mapping[Expr, Tolerated], report: Report,
) -> None:  # fmt: skip
    """Report negative coefficients of R, C and I, and those that a tolerance lets be zero.

    A storage with one has energy without a bound: a warning. A resistor with one delivers power,
    as some machines do about a point of operation: a note. `number` gives nominal values.
    """
    for node, coefficient in coefficients:
        value = number(coefficient)
        assert node.element is not None
        kind, name = node.element.kind, f"{node.type}:{node.local}"
        what = node.element.coefficient
        if value is not None and value < 0:
            text = f"The {what} of `{name}` is negative, {rough(value)} in SI units"
            if kind == "R":
                report.info(
                    "negative-coefficient", f"{text}: it delivers power.", node.origin,
                    help="An R dissipates whichever way its half arrow points; a sign is not "
                    "needed for that.",
                )  # fmt: skip
            else:
                report.warning(
                    "negative-coefficient", f"{text}: the more it stores the less energy it has.",
                    node.origin, help="Leave the sign out: a storage is the same whichever way "
                    "its half arrow points.",
                )  # fmt: skip
        if coefficient.op is Op.NUM or len([*coefficient.terms]) != 1:
            continue  # a sum keeps its sign where one term loses it
        for symbol in symbols(coefficient):
            given = tolerated.get(symbol)
            if given is not None and given.relative >= 1:
                report.warning(
                    "wide-tolerance", f"A tolerance of {rough(100 * given.relative)} % lets the "
                    f"{what} of `{name}` be zero"
                    f"{' or negative' if given.relative > 1 else ''}.",
                    Label(given.origin, "this tolerance"),
                    help="Give one below 100 %, as in `+- 5%`: what may be anything is a fault, "
                    "and a fault needs no tolerance.",
                )  # fmt: skip


def report_sources(
    nodes: Iterable[NodeEntry], quantities: Quantities, report: Report
) -> None:
    """Report an Se whose effort has the unit of a flow, an Sf whose flow has that of an effort.

    Books of some domains exchange the two, as magnetic circuits do with their A and V. Where the
    effort times the flow is a power that is meant, and elsewhere it is not.
    """
    domains = [d for d in DOMAINS.values() if d.effort is not None and d.flow is not None]
    efforts, flows = {d.effort for d in domains}, {d.flow for d in domains}
    for node in nodes:
        element = node.element
        if element is None or element.kind not in ("Se", "Sf") or node.ports[0].slot < 0:
            continue
        effort, flow = map(quantities.dimensions.resolve, quantities.pair(node.ports[0].slot))
        if effort is None or flow is None or times(effort, flow) == _POWER:
            continue
        own, other, these, others = (
            (effort, "Sf", efforts, flows) if element.kind == "Se" else (flow, "Se", flows, efforts)
        )
        if own in others and own not in these:
            fixes, meant = ("an effort", "flow") if other == "Sf" else ("a flow", "effort")
            origin = node.origin
            start = origin.start + origin.text.index(element.kind)
            report.warning(
                "source-kind", f"`{node.type}:{node.local}` fixes {fixes}, and {describe(own)} "
                f"is the unit of {'a' if meant == 'flow' else 'an'} {meant}.", origin,
                help=replacing(Span(origin.source, start, start + 2), other,
                               f"A source of {meant} is `{node.type.replace(element.kind, other)}:"
                               f"{node.local}`."),
            )  # fmt: skip


def report_temperatures(nodes: Iterable[NodeEntry], report: Report) -> None:
    """Note a source of effort on a scale with its own zero, where a unit is of differences."""
    kelvin = parse_unit("K")
    assert kelvin is not None
    for node in nodes:
        number = _written(node)
        unit = parse_unit(number.unit) if number is not None and number.unit else None
        if number is None or unit is None or unit.dimension != kelvin.dimension:
            continue
        factor, zero = scale(unit, kelvin)
        if zero:
            text, difference = number.origin.text, float(number.value * factor)
            absolute = f"{float(number.value * factor + zero):g} K"
            report.info(
                "temperature-scale", f"`{text}` is a difference of temperatures, {difference:g} K.",
                number.origin, help=replacing(number.origin, absolute,
                f"If the temperature is meant, and not how far it is from another one, write "
                f"`{absolute}`."),
            )  # fmt: skip


def _written(node: NodeEntry) -> Number | None:
    """The number that a source of effort is given, itself or as a param."""
    if node.element is None or node.element.kind != "Se" or node.declaration is None:
        return None
    value = node.declaration.value
    if isinstance(value, Number):
        return value
    name = node.name
    if value is not None:
        if not isinstance(value, Ref) or len(value.parts) != 1:
            return None
        name = value.parts[0].name
    entry = node.scope.values.get(name)
    own = entry.declaration if isinstance(entry, ValueEntry) and entry.given is None else None
    return own.value if isinstance(own, Param) and isinstance(own.value, Number) else None


def _power() -> Dimension:
    electrical = DOMAINS["electrical"]
    assert electrical.effort is not None and electrical.flow is not None
    return times(electrical.effort, electrical.flow)


_POWER = _power()
