"""What is said about a model whose residuals no exact simulation could check, and why."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from bondgraph.algebra.affine import affine
from bondgraph.algebra.cleared import divisors
from bondgraph.algebra.nominal import Nominal
from bondgraph.exact.evaluate import Sample, values_of
from bondgraph.exact.outline import demands
from bondgraph.exact.signal_algebra import Mixed
from bondgraph.exact.trajectory import ExactUnavailable, Trajectory
from bondgraph.ir.expr import Expr, Pool, topological
from bondgraph.ir.graph import BondGraph
from bondgraph.ir.residuals import Residual, Step
from bondgraph.notation.line import show
from bondgraph.passes.relation.moduli import vanishing_divisors
from bondgraph.text.diagnostic import Report
from bondgraph.text.source import Span

_READ = 60  # operations that a message writes out
_TERMS = 2  # coefficients of a divisor that are looked at


def _short(expr: Expr) -> str:
    """An expression as it is read; one that nobody would read by its size."""
    size = len(topological([expr]))
    return show(expr) if size <= _READ else f"an expression of {size} operations"


class Resting(ExactUnavailable):
    """A residual, by its position, that divides by what is always zero on the healthy plant."""

    def __init__(self, residual: int, divisor: Expr) -> None:
        super().__init__(f"a residual divides by {_short(divisor)}, which is zero")
        self.residual = residual
        self.divisor = divisor


class _Truth:
    """What truly happens on a trajectory, known or not."""

    def __init__(self, point: Trajectory) -> None:
        self.algebra = point.algebra
        self._point = point

    def value(self, symbol: Expr) -> Any:
        try:
            return self._point.truth(symbol)
        except Mixed:
            return self._point.value(symbol)

    def start(self, _: Any) -> int:
        raise Mixed("an integral in a step")


def divided_away(pool: Pool, points: Sequence[Sample], residual: Residual) -> Expr | None:
    """What a step behind a residual divides by, if it rests at all of the points; else None.

    What is left of the relation may have a value all the same: it then tells of a machine in which
    that variable does not rest, and there is none.
    """
    known = [p for p in points if isinstance(p, Trajectory)]
    truths = [_Truth(p) for p in known]
    for step in residual.steps:
        found = _resting(step.value, truths) or _resting(step.closed, known)
        if found is None and step.equation.state is None:
            found = _resting(_slope(pool, step), truths)  # what has been cancelled in the value
        if found is not None:
            return found
    return None


def _slope(pool: Pool, step: Step) -> Expr:
    """One over what stands before the variable of a step in its equation, where it is linear."""
    parts = affine(pool, step.equation.zero, step.variable)
    return pool.one if parts is None or parts[0] is pool.zero else pool.power(parts[0], -1)


def _resting(expr: Expr, points: Sequence[Sample | _Truth]) -> Expr | None:
    """A divisor in an expression that is zero at all points."""
    nodes = topological([expr])
    bases = divisors(nodes)
    if not bases or not points:
        return None
    need = demands(nodes, [expr, *bases], _TERMS)
    try:
        values = [values_of(nodes, need, point)[0] for point in points]
    except KeyError:  # a torn variable, which the plant does not know
        return None
    for base in bases:
        own = [v.get(base) for v in values]
        if all(
            isinstance(value, list) and not p.algebra.moves(value[:_TERMS])
            for value, p in zip(own, points, strict=True)
        ):
            return base
    return None


def blame(exprs: Sequence[Expr], point: Sample, terms: int) -> None:
    """Raise `Resting` if an expression divides by what is zero to so many terms at a point."""
    nodes = topological(exprs)
    values, _ = values_of(nodes, demands(nodes, exprs, terms), point)
    for at, expr in enumerate(exprs):
        for base in divisors(topological([expr])):
            value = values.get(base)
            if isinstance(value, list) and not point.algebra.moves(value):
                raise Resting(at, base)


def divides_by_nothing(graph: BondGraph, exprs: Sequence[Expr]) -> None:
    """Raise `Resting` if an expression divides by a constant that the model says is zero.

    As an integral from zero of what never moves is, though not for any other initial value.
    """
    nominal = Nominal(graph)
    for at, expr in enumerate(exprs):
        for base in vanishing_divisors(nominal, expr):
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
        f"Residual {residual.name} divides by {_short(divisor)}, which is zero as long as the "
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
