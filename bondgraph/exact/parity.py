"""What faults do to everything that can be concluded from the known signals: parity rows.

The equations of the plant and their derivatives are linearised on a healthy trajectory, coefficient
by coefficient, and all unknowns are eliminated. What is left are rows in the faults alone, each a
small deviation that is an arbitrary function of time. Nothing is shared with the elimination that
makes the residuals.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from bondgraph.exact.adjoints import pull
from bondgraph.exact.evaluate import evaluate, values_of
from bondgraph.exact.outline import demands
from bondgraph.exact.plant import Plant
from bondgraph.exact.point import STRIDE
from bondgraph.exact.trajectory import Trajectory
from bondgraph.field.numbers import Number, Numbers, Undefined
from bondgraph.field.sparse import Row, eliminate
from bondgraph.ir.expr import Expr, Op, Symbol, topological


def parity(
    plant: Plant,
    faults: Sequence[str],
    roots: Sequence[Expr],
    times: int,
    number: int,
    modes: Mapping[Expr, int] | None = None,
) -> tuple[Numbers, dict[str, list[Row]]]:
    """The kind of numbers, and for each fault its columns in the rows that are free of unknowns.

    The equations of the part of the plant that the `roots` are about are differentiated up to
    `times` times. Raises `ExactUnavailable` or `Undefined` like a trajectory does.
    """
    part = plant.structure.part_for(roots)
    trajectory = plant.trajectory(number, times + 2, modes=modes, part=part, roots=roots)
    rows = _Rows(plant, trajectory, faults, times).all()
    left: dict[int, Row] = {}
    numbers = trajectory.algebra.numbers
    eliminate(numbers, rows, left)
    columns: dict[int, Row] = {}
    for at, row in enumerate(left.values()):
        for column, x in row.items():
            columns.setdefault(column, {})[at] = x
    found: dict[str, list[Row]] = {fault: [] for fault in faults}
    for column in sorted(columns, reverse=True):
        found[faults[(-column - 1) // STRIDE]].append(columns[column])
    return numbers, found


class _Truth:
    """A trajectory as it truly is."""

    def __init__(self, trajectory: Trajectory) -> None:
        self.algebra = trajectory.algebra
        self.value = trajectory.truth

    def start(self, initial: Symbol) -> int:
        """Laws have their integrals as variables."""
        raise Undefined(f"an integral from {initial.name} in a law")


class _Rows:
    """The linearised equations; column variable * STRIDE + k, faults below zero."""

    def __init__(
        self, plant: Plant, trajectory: Trajectory, faults: Sequence[str], times: int
    ) -> None:
        self.plant = plant.graph
        self.part = trajectory.part
        self.truth = _Truth(trajectory)
        self.times = times
        symbols = plant.graph.fault_symbols()
        self.fault = {symbols[f]: at for at, f in enumerate(faults)}
        self.rows: list[Row] = []

    def all(self) -> list[Row]:
        """Every equation with its derivatives."""
        part, graph = self.part, self.plant
        for variable in part.silent:
            self.plain({variable: 1})
        for _, terms, when, common in part.balances:
            off = when is not None and not self.truth.algebra.numbers.nonzero(
                *self.truth.algebra.leads(evaluate([when], self.truth)[0])
            )
            self.plain({common: 1} if off else dict(terms))
        for _, law in part.laws:
            self.expression(law)
        for _, variable, value in part.rates:
            self.expression(value, variable, derivative=True)
        read = {name: at for name, at, _ in part.readings}
        for name, symbol, reads in part.shown:
            if name in read:
                at = read[name]
                self.expression(reads, at, fault=symbol)
                self.plain({at: 1})  # the reading itself is known
            else:
                self.expression(reads, fault=symbol)
        for source in graph.inputs:
            where = part.place.get(source.symbol)
            if source.known and not source.mode and where is not None:
                self.known(source.symbol, where[0])
        return self.rows

    def plain(self, terms: dict[int, int]) -> None:
        """A sum of variables that is zero."""
        for k in range(self.times + 1):
            self.rows.append({v * STRIDE + k: c for v, c in terms.items() if c})

    def known(self, symbol: Expr, variable: int) -> None:
        """A known input: what truly acts differs from what is told by the fault."""
        for k in range(self.times + 3):
            row: Row = {variable * STRIDE + k: 1}
            if symbol in self.fault:
                row[self.column(symbol, k)] = -1
            self.rows.append(row)

    def column(self, symbol: Expr, k: int) -> int:
        return -1 - self.fault[symbol] * STRIDE - k

    def expression(
        self,
        expr: Expr,
        minus: int | None = None,
        fault: Expr | None = None,
        derivative: bool = False,
    ) -> None:
        """expr (+ fault) (- variable or its derivative) = 0."""
        nodes = topological([expr])
        need = demands(nodes, [expr], self.times + 1)
        values, failures = values_of(nodes, need, self.truth)
        if expr in failures:
            raise failures[expr]
        for k, adjoints in enumerate(self.adjoints(expr, nodes, need, values)):
            row: Row = {}
            for node, adjoint in adjoints.items():
                if node.op is Op.SYM:
                    self.enter(row, node, adjoint)
            if minus is not None:
                at, weight = (k + 1, -k - 1) if derivative else (k, -1)
                self.add(row, minus * STRIDE + at, weight)
            if fault is not None and fault in self.fault:
                self.add(row, self.column(fault, k), 1)
            self.rows.append(row)

    def adjoints(
        self, expr: Expr, nodes: list[Expr], need: dict[Expr, int], values: dict[Expr, Any]
    ) -> Iterator[dict[Expr, Any]]:
        """For each coefficient of an expression in turn, how those of every node enter it.

        Without derivatives and integrals coefficient k is a convolution: how coefficient j enters
        depends on k - j alone, so that the last tells all.
        """
        algebra, last = self.truth.algebra, self.times
        shifted = not any(n.op in (Op.DER, Op.INT) for n in nodes)
        for k in range(last + 1):
            if not (shifted and k):
                adjoints: dict[Expr, Any] = {expr: [*[0] * (last if shifted else k), 1]}
                pull(nodes, need, values, algebra, adjoints)
            yield {n: own[last - k :] for n, own in adjoints.items()} if shifted else adjoints

    def enter(self, row: Row, symbol: Expr, adjoint: list[Number]) -> None:
        """The share of one symbol, a variable or a faulty parameter."""
        where = self.part.place.get(symbol)
        for k, x in enumerate(adjoint):
            if where is not None:
                self.add(row, where[0] * STRIDE + k, where[1] * x)
            elif symbol in self.fault:
                self.add(row, self.column(symbol, k), x)

    def add(self, row: Row, column: int, x: Number) -> None:
        """Add to an entry of a row."""
        value = row.get(column, 0) + x
        if self.truth.algebra.numbers.nonzero(value):
            row[column] = value
        else:
            row.pop(column, None)
