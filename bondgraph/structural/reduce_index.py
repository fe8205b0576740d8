"""How often each equation has to be differentiated, and which variables are then states."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any

from bondgraph.ir.expr import Expr
from bondgraph.structural.matching import match
from bondgraph.text.tuples import NamedTuple

_MOST = 12  # derivatives of one equation: physics needs two or three

Column = tuple[Expr, int]  # a variable and the order of its derivative
Orders = Mapping[Expr, int]  # the highest derivative of each unknown in an equation


class Reduced(NamedTuple):
    """Equation k is to be `differentiated` so many times, variable v then appears up to `orders`.

    `states` are the variables and derivatives that no equation determines: integration carries
    them.
    """

    differentiated: tuple[int, ...]
    orders: dict[Expr, int]
    states: tuple[Column, ...]


def reduce_index(rows: Sequence[Orders], wish: Callable[[Expr], Any]) -> Reduced | list[int]:
    """Structural index reduction of a square system that has a transversal.

    Offsets by Pryce's Sigma method ("A simple structural analysis method for DAEs", 2001), then
    dummy derivatives (Mattsson and Soderlind, 1993): of the variables that could be states those
    are computed that `wish` puts first. If equations contradict each other, the numbers of the
    rows that could be differentiated for ever.
    """
    place: dict[Expr, int] = {}
    for orders in rows:
        for variable in orders:
            place.setdefault(variable, len(place))
    c, d = _offsets(rows, place)
    if max(c, default=0) > _MOST:
        return [k for k, n in enumerate(c) if n]
    return Reduced(tuple(c), d, _states(rows, c, d, wish))


def _offsets(
    rows: Sequence[Orders], place: Mapping[Expr, int]
) -> tuple[list[int], dict[Expr, int]]:
    """The smallest c, d with d_j - c_i >= order_ij, equal on a transversal of highest value."""
    from scipy.sparse import csr_array
    from scipy.sparse.csgraph import min_weight_full_bipartite_matching

    if not place:
        return [], {}
    top = max(o for orders in rows for o in orders.values())
    at, to, cost = [], [], []
    for k, orders in enumerate(rows):
        for variable, order in orders.items():
            at.append(k)
            to.append(place[variable])
            cost.append(float(top + 1 - order))
    size = len(rows)
    weights = csr_array((cost, (at, to)), shape=(size, size))
    matched_rows, matched = min_weight_full_bipartite_matching(weights)
    column_of = dict(zip(matched_rows.tolist(), matched.tolist(), strict=True))
    columns = list(place)
    own = [orders[columns[column_of[k]]] for k, orders in enumerate(rows)]
    c = [0] * size
    while True:
        d = [0] * size
        for k, orders in enumerate(rows):
            for variable, order in orders.items():
                d[place[variable]] = max(d[place[variable]], order + c[k])
        after = [d[column_of[k]] - own[k] for k in range(size)]
        if after == c or max(after) > _MOST:
            return after, {v: d[k] for v, k in place.items()}
        c = after


def _states(
    rows: Sequence[Orders], c: list[int], d: Orders, wish: Callable[[Expr], Any]
) -> tuple[Column, ...]:
    """The derivatives that no equation determines."""
    computed: list[Expr] = []
    found: set[Column] = set()
    for stage in range(1, max(c, default=0) + 1):
        members = [k for k, n in enumerate(c) if n >= stage]
        among = [v for v, n in d.items() if n >= stage] if stage == 1 else computed
        among = sorted((v for v in among if d[v] >= stage), key=wish)
        holds = [
            [at for at, k in enumerate(members) if rows[k].get(v) == d[v] - c[k]] for v in among
        ]
        _, row_of = match(holds, len(members), in_order=True)
        computed = [v for v, k in zip(among, row_of, strict=True) if k >= 0]
        found |= {(v, d[v] - stage) for v in computed}
    return tuple((v, m) for v, n in d.items() for m in range(n) if (v, m) not in found)
