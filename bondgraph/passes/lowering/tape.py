"""Large residuals: the coefficients of hundreds of derivatives from one small table.

A `Tape` says how the polynomial of each signal is computed; here it becomes a table with a few
reused rows for configure, and its low orders are evaluated to see what a step can show.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

from bondgraph.ir.expr import Expr, below
from bondgraph.ir.normal import Tape, Term
from bondgraph.ir.program import Assignment, PolynomialTape, TapeOp, TapeOutput
from bondgraph.ir.residuals import Residual
from bondgraph.passes.lowering.builder import Builder
from bondgraph.passes.lowering.exactly import label
from bondgraph.passes.lowering.polynomials import Effects, Orders, low_orders
from bondgraph.passes.lowering.procedure import Procedure
from bondgraph.passes.lowering.program_names import identifier, short
from bondgraph.passes.lowering.visible import Seen, frequency, split
from bondgraph.text.source import Span
from bondgraph.text.tuples import NamedTuple

_ENOUGH = 64  # orders that the time unit is judged by


class Large(NamedTuple):
    """A large residual: the table for configure and the coefficient arrays by atom.

    `scales` are the factors of the table, whose values `statement` has yet to be given. `low` are
    the first coefficients at the model's numbers, a row a node of the tape, in units of the highest
    frequency.
    """

    tape: Tape
    statement: PolynomialTape
    arrays: dict[Expr, tuple[str, int]]
    scales: list[Expr]
    time_unit: float
    low: Orders | None

    def seen(self, builder: Builder, rate: float, resolution: float) -> Seen | str:
        """The visible terms; their coefficients are elements of the arrays."""
        low = self.low
        if low is None:
            return f"it has derivatives up to order {self.statement.length - 1} and no numbers"
        pool, bandwidth = builder.pool, builder.option("bandwidth")
        terms: list[Term] = []
        sizes: list[float] = []
        far: list[tuple[Term, float]] = []
        for leaf in self.tape.leaves:
            array, length = self.arrays[leaf.atom]
            row = low[leaf.node].tolist()
            for k in range(length):
                if k < len(row):
                    # time_unit**k, so written that bandwidth**k of the filter cancels
                    factor = pool.power(pool.div(builder.pace, bandwidth), k)
                    value = pool.mul(builder.element(array, k), factor)
                    terms.append(Term(leaf.atom, k, value, leaf.static))
                    sizes.append(abs(row[k]))
                else:
                    far.append((Term(leaf.atom, k, pool.one, leaf.static), 0.0))
        effect = Effects(builder, self.tape, rate, low)
        found = split(tuple(terms), sizes, rate, resolution, effect, builder.absent)
        return found._replace(dropped=(*found.dropped, *far))


def large(
    builder: Builder, residual: Residual, tape: Tape, rate: float, highest: int
) -> Large:
    """The table of a large residual, and the arrays for its coefficients."""
    name, origin = identifier(residual.name), residual.closing.origin
    length = max(leaf.degree for leaf in tape.leaves) + 1
    arrays: dict[Expr, tuple[str, int]] = {}
    for leaf in tape.leaves:
        doc = f"{residual.name}: factors of the derivatives of {short(leaf.atom)}"
        array = builder.array(f"{name}_{label(builder, leaf.atom)}", leaf.degree + 1, doc, origin)
        arrays[leaf.atom] = array, leaf.degree + 1
    ops, rows, where = _allocate(tape)
    unit = builder.option("time_unit")
    scales: dict[Expr, int] = {}
    shifted: dict[tuple[Expr, int], Expr] = {}
    table: list[TapeOp] = []
    for (target, source, length_, fresh), edge in zip(ops, tape.edges, strict=True):
        value = edge.scale
        if edge.shift:
            value = shifted.get((edge.scale, edge.shift), value)
            if value is edge.scale:
                value = builder.pool.mul(value, builder.pool.power(unit, -edge.shift))
                shifted[edge.scale, edge.shift] = value
        at = scales.setdefault(value, len(scales))
        table.append(TapeOp(target, source, edge.shift, at, length_, fresh))
    outputs = [TapeOutput(arrays[f.atom][0], where[f.node], f.degree + 1) for f in tape.leaves]
    statement = PolynomialTape(
        name,
        length,
        rows,
        (),
        tuple(table),
        tuple(outputs),
        f"{residual.name}: factors of all derivatives",
        origin,
    )
    start = 1 / frequency(rate)
    low = low_orders(builder, tape, start, _ENOUGH)
    time_unit = 1.0 if low is None else _time_unit(low, start)
    kept = None if low is None else low[:, : highest + 2].copy()
    return Large(tape, statement, arrays, list(scales), time_unit, kept)


def filled(builder: Builder, tapes: Sequence[Large]) -> list[Assignment | PolynomialTape]:
    """The tables with the values of their factors, behind the statements that these have need of.

    What several residuals have in common, as those of one network have, is computed once.
    """
    found: list[Assignment | PolynomialTape] = []
    work = Procedure(builder.pool, builder.leaf, found.append, builder.names, "")
    roots = builder.resolve([scale for one in tapes for scale in one.scales])
    places: dict[Expr, Span | None] = {}
    left = iter(roots)
    for one in tapes:
        own = [next(left) for _ in one.scales]
        for node in below(own, stop=places.__contains__):
            places.setdefault(node, one.statement.origin)
    values = iter(work.values(roots, places))
    for one in tapes:
        scales = tuple([next(values) for _ in one.scales])
        found.append(one.statement._replace(scales=scales))
    return found


def _allocate(
    tape: Tape,
) -> tuple[list[tuple[int, int, int, bool]], int, dict[int, int]]:
    """Rows for the nodes, each given back after the last edge out of its node.

    Per edge: target row, source row, length of the source, whether the target is new.
    """
    last: dict[int, int] = {}
    for at, edge in enumerate(tape.edges):
        last[edge.source] = at
    kept = {leaf.node for leaf in tape.leaves}
    length = {0: 1}
    where = {0: 0}
    free: list[int] = []
    rows = 1
    out: list[tuple[int, int, int, bool]] = []
    for at, edge in enumerate(tape.edges):
        fresh = edge.target not in where
        if fresh:
            if free:
                where[edge.target] = free.pop()
            else:
                where[edge.target] = rows
                rows += 1
            length[edge.target] = 0
        size = length[edge.source]
        length[edge.target] = max(length[edge.target], size + edge.shift)
        out.append((where[edge.target], where[edge.source], size, fresh))
        if last[edge.source] == at and edge.source not in kept:
            free.append(where[edge.source])
    return out, rows, where


def _time_unit(low: Orders, start: float) -> float:
    """A power of two seconds in which no coefficient is larger than the first by far.

    `low` are the first coefficients, counted in units of `start` seconds.
    """
    import numpy as np

    sizes = np.abs(low)
    first = sizes[:, :1]
    scale = np.where(first > 0, first, sizes.max(axis=1, keepdims=True))
    most = np.divide(sizes, scale, out=np.zeros_like(sizes), where=scale > 0).max(axis=0).tolist()
    unit = max(start * m ** (1 / k) for k, m in enumerate(most) if k)
    return 2.0 ** math.ceil(math.log2(unit)) if unit else 1.0
