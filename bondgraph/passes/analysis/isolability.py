"""Which faults any combination of the residuals and their derivatives could tell apart.

A residual generator is a combination of the relations and their time derivatives. Two faults that
enter all relations through proportional operators cannot be separated by any of them. Over the
field of fractions of differential operators (Ore, 1933) that is an equivalence, so that the answer
is a partition of the detectable faults. The operators are taken from the plant, not from the
residuals, in which parameters may have been moved past derivatives as if they were constant.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from functools import partial

from bondgraph.exact.outline import highest_order, integral_depth
from bondgraph.exact.parity import parity
from bondgraph.exact.plant import Plant
from bondgraph.exact.reactions import Reactions, in_modes
from bondgraph.exact.trajectory import ExactUnavailable
from bondgraph.field.numbers import Numbers
from bondgraph.field.sparse import Row, eliminate
from bondgraph.ir.expr import Expr, Kind, symbols
from bondgraph.ir.residuals import ResidualSet
from bondgraph.ir.signature_matrix import SignatureMatrix

_MOST = 16  # times that a relation is differentiated


def isolability(
    residuals: ResidualSet, matrix: SignatureMatrix, plant: Plant, seed: int = 1
) -> tuple[tuple[str, ...], ...] | None:
    """The detectable faults in groups that no set of residuals could divide any further.

    Fault i can be told from fault j if rank [J F_j F_i] > rank [J F_j], with J the Jacobian of the
    plant and its derivatives with respect to all unknowns and F the columns of a fault that is an
    arbitrary function of time, on healthy trajectories at the declared numbers. It is asked for
    faults of equal signatures only: others are told apart. Residuals that were made to be free of a
    fault say nothing new, and are passed over. Of a machine with modes it is enough that one mode
    divides them. None where the plant has no trajectory.
    """
    exprs = [r.expr for r in residuals.residuals]
    combined = [r.free_of is not None for r in residuals.residuals]
    fixed: list[list[str]] = []
    open_: list[tuple[list[str], tuple[int, ...]]] = []
    for group in matrix.groups:
        hits = zip(matrix.row(group[0]), combined, strict=True)
        rows = tuple(at for at, (hit, made) in enumerate(hits) if hit and not made)
        if len(group) > 1 and (len(rows) > 1 or any(_switched(exprs[at]) for at in rows)):
            open_.append((list(group), rows))
        else:
            fixed.append(list(group))
    divided = _divided(exprs, open_, Reactions(plant, seed))
    if divided is None:
        return None
    order = {fault: at for at, fault in enumerate(matrix.faults)}
    return tuple(tuple(g) for g in sorted([*fixed, *divided], key=lambda g: order[g[0]]))


def _switched(expr: Expr) -> bool:
    """Whether a relation is another one in another mode: it may see a fault in one of them only."""
    return any(s.symbol.kind is Kind.MODE for s in symbols(expr))


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
        if all(len(g) == 1 for g in found):
            break
        attempt = partial(_at_a_point, own, found, plant, modes)
        try:
            found = reactions.draw(attempt, 1000 * seed + number, in_modes(own, modes))
        except ExactUnavailable:
            continue
        met = True
    if met or not groups:
        return found
    if len(groups) == 1:
        return None
    parts = [_divided(exprs, [group], reactions) for group in groups]
    return None if None in parts else [g for part in parts if part for g in part]


def _at_a_point(
    exprs: list[Expr],
    groups: list[list[str]],
    plant: Plant,
    modes: Mapping[Expr, int] | None,
    number: int,
) -> list[list[str]]:
    """The groups divided by what each fault does to the prolonged plant, at one healthy point.

    Two relations of order n need up to n derivatives each to be combined.
    """
    times = min(2 * highest_order(exprs) + 1, _MOST) + integral_depth(exprs)
    faults = [f for g in groups if len(g) > 1 for f in g]
    numbers, columns = parity(plant, faults, exprs, times, number, modes)
    return [part for g in groups for part in _parallel(numbers, g, columns)]


def _parallel(
    numbers: Numbers, group: list[str], columns: dict[str, list[Row]]
) -> list[list[str]]:
    """The group divided into faults with proportional columns."""
    parts: list[list[str]] = []
    for fault in group:
        own = columns.get(fault, [])
        for part in parts:
            first = columns.get(part[0], [])
            sizes = _rank(numbers, first), _rank(numbers, own)
            # where one of them acts alone, as in a position of a switch, that tells them apart
            if all(sizes) == any(sizes) and _rank(numbers, [*first, *own]) == max(sizes):
                part.append(fault)
                break
        else:
            parts.append([fault])
    return parts


def _rank(numbers: Numbers, columns: Iterable[Row]) -> int:
    return len(eliminate(numbers, [dict(c) for c in columns]))
