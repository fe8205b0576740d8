"""Add the few relations that tell apart what the sensors allow to be told apart.

Two faults of equal signatures can be told apart if they do not enter the relations through
proportional operators (`isolability`); then what holds without the one reacts to the other. So for
each fault that should stand alone the relations free of it are had by elimination (`decouple`),
and of all of these as few are kept as divide the faults as far (Staroswiecki and Comtet-Varga,
2001; a residual for each fault that must not move it: the structured residuals of Gertler, 1991).
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from bondgraph.algebra.in_mode import in_mode
from bondgraph.algebra.normalise import normalise
from bondgraph.exact.outline import highest_order
from bondgraph.exact.plant import Plant
from bondgraph.exact.switch_modes import MOST
from bondgraph.ir.expr import Expr, Kind, Op, Pool, symbols, topological
from bondgraph.ir.graph import BondGraph
from bondgraph.ir.residuals import Closing, Residual, ResidualSet
from bondgraph.ir.signature_matrix import SignatureMatrix
from bondgraph.passes.analysis.signatures import signatures
from bondgraph.passes.elimination.decouple import free_of
from bondgraph.passes.relation.form import with_further
from bondgraph.text.diagnostic import Report
from bondgraph.text.tuples import NamedTuple


class _Cost(NamedTuple):
    """What is to be avoided in a further relation, the worst first.

    Its signature may not be confirmed, it may say something in some modes only, or its samples not
    give it exactly; then the highest derivative, and how many operations it takes.
    """

    unconfirmed: bool
    idle: bool
    inexact: bool
    order: int
    operations: int


def isolating_set(
    residuals: ResidualSet,
    matrix: SignatureMatrix,
    best: Sequence[Sequence[str]],
    plant: Plant,
    report: Report,
    seed: int = 1,
) -> tuple[ResidualSet, SignatureMatrix]:
    """The relations and their matrix, and behind them further ones that divide the groups.

    `best` are the groups that no set of relations could divide. A further relation is not kept
    where the others divide the faults as far without it, the dearest left out first. Reports
    `not-isolated` where a group stays whole that could be divided.
    """
    closings: list[Closing] = []
    for group in matrix.groups:
        for fault in _to_be_divided(group, best):
            seen = _that_see(fault, residuals, matrix)
            closings += [*free_of(fault, seen, residuals), *_in_some_modes(fault, seen, residuals)]
    whole = with_further(residuals, closings, plant, seed)
    further = whole.residuals[len(residuals.residuals) :]
    found = signatures(whole._replace(residuals=further), plant, seed)
    pool = residuals.system.graph.pool
    costs = {r.name: _cost(pool, r, r.name in found.unconfirmed) for r in further}
    kept = _needed(matrix, found, sorted(costs, key=costs.__getitem__, reverse=True))
    names = {
        name: f"r{len(residuals.residuals) + at}"
        for at, name in enumerate((n for n in found.residuals if n in kept), 1)
    }
    chosen = tuple(r._replace(name=names[r.name]) for r in further if r.name in names)
    sharpened = matrix.beside(found.renamed(names))
    for group in sharpened.groups:
        _tell(report, residuals.system.graph, _to_be_divided(group, best))
    return whole._replace(residuals=(*residuals.residuals, *chosen)), sharpened


def _to_be_divided(group: Sequence[str], best: Sequence[Sequence[str]]) -> list[str]:
    """A fault of each part that a group of equal signatures could be divided into."""
    part = {fault: number for number, own in enumerate(best) for fault in own}
    first: dict[int, str] = {}
    for fault in group:
        first.setdefault(part[fault], fault)
    return list(first.values()) if len(first) > 1 else []


def _in_some_modes(
    fault: str, seen: Sequence[Residual], residuals: ResidualSet
) -> Iterator[Closing]:
    """The relations in those modes in which they do without a fault, zero in the others.

    So a source behind a switch is told from what is before it: while it is off.
    """
    graph = residuals.system.graph
    for residual in seen:
        relation = [residual.expr, residual.raw]
        modes = [s for s in symbols(residual.expr) if s.symbol.kind is Kind.MODE][:MOST]
        expr, raw = _without(graph.fault_symbol(fault), relation, modes, graph.pool)
        if expr is not graph.pool.zero:
            steps = residual.steps, residual.differentiated
            way = residual.loop, residual.each
            yield Closing(residual.closing, expr, *steps, raw, fault, *way)


def _without(fault: Expr, relation: list[Expr], modes: list[Expr], pool: Pool) -> list[Expr]:
    """Two forms of a relation; zero in the modes in which the first one holds the fault."""
    if fault not in symbols(relation[0]):
        return relation
    if not modes:
        return [pool.zero] * len(relation)
    first, *rest = modes
    on, off = (_without(fault, in_mode(pool, relation, {first: x}), rest, pool)
               for x in (True, False))  # fmt: skip
    return [pool.choose(first, x, y) for x, y in zip(on, off, strict=True)]


def _idle(expr: Expr, pool: Pool) -> bool:
    """Whether a relation says nothing in some mode."""
    return expr.op is Op.IF and any(b is pool.zero or _idle(b, pool) for b in expr.args[1:])


def _tell(report: Report, graph: BondGraph, together: list[str]) -> None:
    """Say which faults stay in one group that could be told apart."""
    if together:
        *most, last = [f"`{fault}`" for fault in together]
        report.info(
            "not-isolated",
            f"{', '.join(most)} and {last} could be told apart, but no relation that is free of one"
            " of them was found in closed form.",
            *[graph.fault_origin(fault) for fault in together],
            help="A sensor that tells what stands in a law without inverse gives such a relation.",
        )


def _that_see(fault: str, residuals: ResidualSet, matrix: SignatureMatrix) -> list[Residual]:
    """The residuals that see a fault, but for those that were made of others already."""
    hits = zip(residuals.residuals, matrix.row(fault), strict=True)
    return [r for r, hit in hits if hit and r.free_of is None]


def _cost(pool: Pool, residual: Residual, unconfirmed: bool) -> _Cost:
    inexact = not normalise(pool, residual.expr).exact
    operations = len(topological([residual.expr]))
    order = highest_order([residual.expr])
    return _Cost(unconfirmed, _idle(residual.expr, pool), inexact, order, operations)


def _needed(matrix: SignatureMatrix, further: SignatureMatrix, dearest: list[str]) -> set[str]:
    """The further residuals without which fewer groups of faults would be told apart."""
    groups = {fault: at for at, group in enumerate(matrix.groups) for fault in group}
    bit = {name: 1 << at for at, name in enumerate(further.residuals)}
    masks = {
        (groups[fault], sum(b for b, hit in zip(bit.values(), row, strict=True) if hit))
        for fault, row in zip(further.faults, further.rows, strict=True)
        if fault in groups
    }
    kept = set(bit)
    for name in dearest:
        fewer = {(group, mask & ~bit[name]) for group, mask in masks}
        if len(fewer) == len(masks):
            masks = fewer
            kept.remove(name)
    return kept
