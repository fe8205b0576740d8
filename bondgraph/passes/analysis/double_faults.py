"""Which two faults at once could look like a third one alone, whatever residuals are used.

A fault enters all that can be concluded from the known signals through a column of differential
operators. Two faults at once, each of any course, reach the space that their columns span over the
field of fractions (Ore, 1933): a third one whose column lies in it can be mistaken for them.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import partial
from itertools import combinations
from random import Random

from bondgraph.exact.outline import highest_order, integral_depth
from bondgraph.exact.parity import parity
from bondgraph.exact.plant import Plant
from bondgraph.exact.reactions import Reactions, in_modes
from bondgraph.exact.trajectory import ExactUnavailable
from bondgraph.field.numbers import Numbers
from bondgraph.field.sparse import Row, add_multiple, eliminate
from bondgraph.ir.expr import Expr
from bondgraph.ir.residuals import ResidualSet
from bondgraph.ir.signature_matrix import DoubleFaults, SignatureMatrix

_MOST = 24  # times that a relation is differentiated
_PAIRS = 2000  # pairs of groups that are looked at

#: Pairs of groups by number, each with the groups of which it might look like one.
_Suspects = dict[tuple[int, int], list[int]]


def double_faults(
    residuals: ResidualSet,
    matrix: SignatureMatrix,
    groups: Sequence[tuple[str, ...]] | None,
    plant: Plant,
    seed: int = 1,
) -> DoubleFaults:
    """For every group of faults the pairs of others that could look like it.

    Faults a and b at once can look like c if rank [J F_a F_b F_c] = rank [J F_a F_b], in the words
    of `isolability`, which gives the `groups`; one fault stands for its group. A residual that sees
    just one of the three decides without a rank. Of a machine with modes it is enough that one mode
    tells them apart.
    """
    if groups is None:
        return DoubleFaults((), (), "the machine has no exact trajectory")
    own = [r for r in residuals.residuals if r.free_of is None]
    sees = matrix.sees
    seen = [frozenset(r.name for r in own if g[0] in sees[r.name]) for g in groups]
    suspects: _Suspects = {}
    for a, b in combinations(range(len(groups)), 2):
        one, both = seen[a] ^ seen[b], seen[a] | seen[b]
        singles = [c for c, rows in enumerate(seen) if one <= rows <= both and c not in (a, b)]
        if singles:
            suspects[a, b] = singles
    if len(suspects) > _PAIRS:
        return DoubleFaults(tuple(groups), (), f"{len(suspects)} pairs of groups are too many")
    asked = _asked(suspects)
    exprs = [r.expr for r in own if any(r.name in seen[f] for f in asked)]
    try:
        alike = _left(exprs, [g[0] for g in groups], suspects, Reactions(plant, seed))
    except ExactUnavailable as reason:
        return DoubleFaults(tuple(groups), (), str(reason))
    return DoubleFaults(tuple(groups), tuple(_any_two(alike, c) for c in range(len(groups))), "")


def _asked(suspects: _Suspects) -> list[int]:
    """The groups that a suspicion is about."""
    return sorted({f for pair, singles in suspects.items() for f in (*pair, *singles)})


def _left(
    exprs: list[Expr], faults: list[str], suspects: _Suspects, reactions: Reactions
) -> _Suspects:
    """The suspects that no point of the plant tells apart; raises where it has no point."""
    failure: ExactUnavailable | None = None
    met = False
    for number, modes in enumerate(reactions.settings(exprs)):
        if not suspects:
            break
        attempt = partial(_at_a_point, exprs, faults, suspects, reactions.plant, modes)
        try:
            point = 1000 * reactions.seed + number
            suspects = reactions.draw(attempt, point, in_modes(exprs, modes))
            met = True
        except ExactUnavailable as reason:
            failure = reason
    if failure is not None and not met:
        raise failure
    return suspects


def _at_a_point(
    exprs: list[Expr],
    faults: list[str],
    suspects: _Suspects,
    plant: Plant,
    modes: Mapping[Expr, int] | None,
    number: int,
) -> _Suspects:
    """The suspects that one healthy point leaves.

    A relation of order n is combined with two others: up to 2n more derivatives of it. In place of
    all columns of a single fault stands one random combination of them.
    """
    times = min(3 * highest_order(exprs) + 1, _MOST) + integral_depth(exprs)
    asked = _asked(suspects)
    numbers, columns = parity(plant, [faults[f] for f in asked], exprs, times, number, modes)
    random = Random(number)
    mixed: dict[int, Row] = {fault: {} for fault in asked}
    for fault, own in mixed.items():
        for column in columns[faults[fault]]:
            add_multiple(numbers, own, numbers.any(random), column)
    left: _Suspects = {}
    for (a, b), singles in suspects.items():
        spanning = [*columns[faults[a]], *columns[faults[b]]]
        outside = _outside(numbers, spanning, {c: mixed[c] for c in singles})
        if inside := [c for c in singles if c not in outside]:
            left[a, b] = inside
    return left


def _outside(numbers: Numbers, columns: list[Row], others: Mapping[int, Row]) -> set[int]:
    """Those of the other columns that are no combination of the columns.

    >>> from bondgraph.field.prime import PrimeField
    >>> _outside(PrimeField(1), [{0: 1, 1: 1}, {2: 1}], {7: {0: 2, 1: 2, 2: 5}, 8: {0: 1}})
    {8}
    """
    rows: dict[int, Row] = {}
    for name, column in [*enumerate(columns), *((-1 - c, own) for c, own in others.items())]:
        for at, x in column.items():
            rows.setdefault(at, {})[name] = x
    free: dict[int, Row] = {}
    eliminate(numbers, list(rows.values()), free)
    return {-1 - name for row in free.values() for name in row}


def _any_two(alike: _Suspects, single: int) -> tuple[tuple[int, ...], ...]:
    """The largest sets of groups any two of which look like a single one."""
    import networkx as nx

    graph = nx.Graph(pair for pair, singles in alike.items() if single in singles)
    return tuple(sorted(tuple(sorted(clique)) for clique in nx.find_cliques(graph)))
