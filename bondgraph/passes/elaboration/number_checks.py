"""Whether the values of params and the counts of encoders are numbers to compute with."""

from __future__ import annotations

from collections.abc import Callable

from bondgraph.ir.expr import RATIONAL, Expr, Op, topological
from bondgraph.ir.functions import FUNCTIONS
from bondgraph.ir.graph import BondGraph
from bondgraph.text.diagnostic import Report

_LARGEST = 1e300


def check_numbers(graph: BondGraph, report: Report) -> None:
    """Report a param whose expression gives no number, and counts that are not positive.

    What depends on a symbolic param or a table is not looked at. Errors: `undefined-value`,
    `wrong-counts`.
    """
    composed = [v for v in graph.values if v.value is not None and v.value.op is not Op.NUM]
    counted = [s for s in graph.sensors if s.counts is not None]
    if not composed and not counted:
        return
    from bondgraph.algebra.nominal import Nominal  # only models with such values need it

    nominal = Nominal(graph)
    for value in composed:
        assert value.value is not None
        number = nominal.value(value.symbol)
        undefined = number is None and _plain(value.value, nominal.value)
        if undefined or (number is not None and not abs(number) < _LARGEST):
            report.error(
                "undefined-value", f"The value of `{value.name}` is no number that can be computed "
                "with.", value.origin, help="With the numbers of this model it divides by zero, is "
                "not real or is far too large: correct one of them.",
            )  # fmt: skip
    for sensor in counted:
        assert sensor.counts is not None
        number = nominal.value(sensor.counts)
        if number is not None and not number > 0:
            report.error(
                "wrong-counts", f"Sensor `{sensor.name}` gives {number:g} counts a turn.",
                sensor.origin, help="Give the number of counts of one turn, as in "
                "`counts 24/turn`.",
            )  # fmt: skip


def _plain(expr: Expr, number: Callable[[Expr], float | None]) -> bool:
    """Whether all that occurs is arithmetic of known numbers."""
    for node in topological([expr]):
        if node.op is Op.SYM:
            known = number(node)
            if known is None or not abs(known) < _LARGEST:
                return False
        elif node.op not in RATIONAL and (node.op is not Op.FN or node.name not in FUNCTIONS):
            return False
    return True
