"""Which faults any combination of the residuals and their derivatives could tell apart.

A residual generator is a combination of the relations and their time derivatives. Two faults that
enter all relations through proportional operators cannot be separated by any of them. Over the
field of fractions of differential operators that is an equivalence, so that the answer is a
partition of the detectable faults (Krysander and Frisk, 2008; for operators Ore, 1933).
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from functools import partial
from typing import Any

from bondgraph.exact.algebra import Mixed, Waves
from bondgraph.exact.evaluate import (
    demands,
    highest_order,
    integral_depth,
    pull,
    values_of,
)
from bondgraph.exact.field import P
from bondgraph.exact.linear import Row, eliminate
from bondgraph.exact.plant import ExactUnavailable, Plant
from bondgraph.ir.expr import Expr, Op, topological
from bondgraph.ir.signatures import SignatureMatrix
from bondgraph.passes.reactions import Reactions

_MOST = 16  # times that a relation is differentiated

#: What a fault does to the prolonged relations: one column of the Jacobian an entry.
_Columns = list[dict[int, int]]


def isolability(
    exprs: list[Expr],
    combined: list[bool],
    matrix: SignatureMatrix,
    plant: Plant,
    seed: int = 1,
) -> tuple[tuple[str, ...], ...] | None:
    """The detectable faults in groups that no set of residuals could divide any further.

    `exprs` are the residuals in the form in which parameters may move; those that are `combined`
    from others are passed over. Fault i can be told from
    fault j if rank [F_j F_i] > rank F_j, with F the columns of a fault, arbitrary in time, in the
    Jacobian of the relations and their derivatives; it is taken on healthy trajectories modulo a
    61-bit prime. Faults of different signatures are always told apart. Of a machine with modes
    it is enough that one mode divides them. None where the plant has no trajectory.
    """
    fixed: list[list[str]] = []
    open_: list[tuple[list[str], tuple[int, ...]]] = []
    for group in matrix.groups:
        hits = zip(matrix.row(group[0]), combined, strict=True)
        rows = tuple(at for at, (hit, made) in enumerate(hits) if hit and not made)
        if len(group) > 1 and len(rows) > 1:
            open_.append((list(group), rows))
        else:
            fixed.append(list(group))
    divided = _divided(exprs, open_, Reactions(plant, seed))
    if divided is None:
        return None
    order = {fault: at for at, fault in enumerate(matrix.faults)}
    return tuple(tuple(g) for g in sorted([*fixed, *divided], key=lambda g: order[g[0]]))


def _divided(
    exprs: list[Expr], groups: list[tuple[list[str], tuple[int, ...]]], reactions: Reactions
) -> list[list[str]] | None:
    """The groups, each with the relations that see it, divided as far as some point allows.

    One point serves all groups; where the plant as a whole has none, each is tried by itself.
    """
    plant, seed = reactions.plant, reactions.seed
    own = [exprs[at] for at in sorted({at for _, rows in groups for at in rows})]
    found = [group for group, _ in groups]
    met = False
    for number, modes in enumerate(reactions.settings(own)):
        symbols = [plant.graph.fault_symbol(f) for g in found if len(g) > 1 for f in g]
        if not symbols:
            break
        attempt = partial(_columns, own, symbols, plant, modes)
        try:
            columns = reactions.draw(attempt, 1000 * seed + number)
        except (ExactUnavailable, Mixed):
            continue
        met = True
        found = [part for g in found for part in _parallel(g, columns, plant)]
    if met or not groups:
        return found
    if len(groups) == 1:
        return None
    parts = [_divided(exprs, [group], reactions) for group in groups]
    return None if None in parts else [g for part in parts if part for g in part]


def _parallel(group: list[str], columns: dict[Expr, _Columns], plant: Plant) -> list[list[str]]:
    """The group divided into faults with proportional columns."""
    parts: list[list[str]] = []
    for fault in group:
        own = columns.get(plant.graph.fault_symbol(fault), [])
        for part in parts:
            first = columns.get(plant.graph.fault_symbol(part[0]), [])
            if _rank([*first, *own]) == _rank(first) == _rank(own):
                part.append(fault)
                break
        else:
            parts.append([fault])
    return parts


def _rank(columns: Iterable[Row]) -> int:
    return len(eliminate([dict(c) for c in columns]))


def _columns(
    exprs: list[Expr],
    symbols: list[Expr],
    plant: Plant,
    modes: Mapping[Expr, int] | None,
    number: int,
) -> dict[Expr, _Columns]:
    """What each symbol does to the prolonged relations, at one healthy point."""
    try:
        wave = plant.wave(number, (), modes, plant.part_for(exprs))
        return _pulled(exprs, symbols, wave, 0)
    except (Mixed, ExactUnavailable):
        times = min(highest_order(exprs), _MOST) + integral_depth(exprs)
        sample = plant.sample(exprs, number, times + 1, modes=modes)
        return _pulled(exprs, symbols, sample, times)


def _pulled(
    exprs: list[Expr], symbols: list[Expr], sample: Any, times: int
) -> dict[Expr, _Columns]:
    """The Jacobian by reverse mode: one pass a relation and derivative.

    What an integral has taken up of a fault in the past is one column more.
    """
    algebra = sample.algebra
    table: dict[Expr, dict[tuple[str, int], dict[int, int]]] = {s: {} for s in symbols}
    waves = isinstance(algebra, Waves)
    row = 0
    for expr in exprs:
        nodes = topological([expr])
        need = demands(nodes, [expr], times + 1)
        values, failures = values_of(nodes, need, sample)
        if expr in failures:
            raise failures[expr]
        below = {n: [s for s in topological(n.args) if s in table] for n in nodes if n.op is Op.INT}
        own = [n for n in nodes if n in table]
        for k in range(times + 1):
            adjoints: dict[Expr, Any] = {expr: algebra.seed(1) if waves else [*[0] * k, 1]}
            pull(nodes, need, values, algebra, adjoints)
            for symbol in own:
                found = adjoints.get(symbol)
                if found is None or algebra.vanishes(found):
                    continue
                for at, x in enumerate([found.value] if waves else found):
                    if x % P:
                        table[symbol].setdefault(("", at), {})[row] = x % P
            for node, holding in below.items():
                found = adjoints.get(node)
                start = 0 if found is None else algebra.start_of(found) % P
                for symbol in holding if start else ():
                    table[symbol].setdefault((node.symbol.name, node.id), {})[row] = start
            row += 1
    return {s: list(columns.values()) for s, columns in table.items()}
