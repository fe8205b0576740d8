"""What is said about a model whose residuals no exact simulation could check, and why."""

from __future__ import annotations

from collections.abc import Sequence

from bondgraph.exact.evaluate import Sample, demands, values_of
from bondgraph.exact.plant import ExactUnavailable
from bondgraph.ir.expr import Expr, Op, topological
from bondgraph.ir.graph import BondGraph
from bondgraph.ir.residuals import Residual
from bondgraph.ir.show import show
from bondgraph.passes.nominal import Nominal
from bondgraph.passes.solve import constant
from bondgraph.text.diagnostic import Report
from bondgraph.text.source import Span


class Resting(ExactUnavailable):
    """A residual, by its position, that divides by what is always zero on the healthy plant."""

    def __init__(self, residual: int, divisor: Expr) -> None:
        super().__init__(f"a residual divides by {show(divisor)}, which is zero")
        self.residual = residual
        self.divisor = divisor


def blame(exprs: Sequence[Expr], point: Sample, terms: int) -> None:
    """Raise `Resting` if an expression divides by what is zero to so many terms at a point."""
    nodes = topological(exprs)
    values, _ = values_of(nodes, demands(nodes, exprs, terms), point)
    for at, expr in enumerate(exprs):
        for node in topological([expr]):
            if node.op is Op.MUL:
                for base, power in zip(node.args, node.exponents, strict=True):
                    value = values.get(base)
                    if power < 0 and isinstance(value, list) and not any(value):
                        raise Resting(at, base)


def divides_by_nothing(graph: BondGraph, exprs: Sequence[Expr]) -> None:
    """Raise `Resting` if an expression divides by a constant that the model says is zero.

    As an integral from zero of what never moves is, though not for any other initial value.
    """
    nominal = Nominal(graph)
    for at, expr in enumerate(exprs):
        known: dict[Expr, bool] = {}
        for node in topological([expr]):
            if node.op is Op.MUL:
                for base, power in zip(node.args, node.exponents, strict=True):
                    if power < 0 and constant(base, known) and nominal.vanishes(base):
                        raise Resting(at, base)


def contradictory(report: Report, name: str, origin: Span) -> None:
    """Say that the model allows no behaviour at all; `name` is where that shows."""
    where = f" at `{name}`" if name else ""
    report.error(
        "sources-contradict",
        f"The sources contradict each other: even without sensors, the equations{where} are "
        "more than the variables they could determine.",
        origin,
        help="A loop of bonds, or transformers between the same junctions, fix already what a "
        "source is to fix: remove one of them, or put the resistance or the storage between "
        "them that every real connection has.",
    )


def resting(report: Report, residual: Residual, divisor: Expr) -> None:
    """Say that a residual never has a value."""
    report.error(
        "residual-undefined",
        f"Residual {residual.name} divides by {show(divisor)}, which is zero as long as the "
        "machine is healthy: it never has a value.",
        residual.closing.origin,
        help="Nothing drives this part of the machine, or its bonds hold it at rest. Add the "
        "source that moves it, or measure a variable by itself instead of its product with one "
        "that rests.",
    )


def unavailable(report: Report, reason: str, *places: Span) -> None:
    """Say that nothing confirms the residuals."""
    report.warning(
        "verification-unavailable",
        f"the residuals could not be checked by exact simulation: {reason}",
        *places,
        help="The residuals were derived, but nothing independent confirms them, and the "
        "signatures may list faults that cannot be seen. Try them on simulated data before use, "
        "or write the law named here in another form.",
    )
