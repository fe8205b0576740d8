"""A small choice of residuals that tells apart whatever any of them can."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TypeAlias

import numpy as np
import numpy.typing as npt

from bondgraph.text.tuples import NamedTuple

Bools: TypeAlias = npt.NDArray[np.bool_]

#: Above so many candidates times demands the choice is greedy only.
_EXACT = 50_000
_NODES = 2000  # of the search tree of the integer program


class Choice(NamedTuple):
    """Which rows were chosen, ascending; `least` says that no cheaper choice does as much."""

    chosen: tuple[int, ...]
    least: bool


def demands(signatures: Bools) -> Bools:
    """What each residual meets: `[residual, demand]`, one demand a column.

    `signatures[residual, fault]` says which fault a residual sees. The demands are that every
    fault that any residual sees is seen, and that for two faults, wherever any residual sees the
    one and not the other, the choice has such a residual too.
    """
    columns: dict[bytes, npt.NDArray[np.bool_]] = {}
    faults = {c.tobytes(): c for c in signatures.T if c.any()}
    for own in faults.values():
        columns.setdefault(own.tobytes(), own)
        for other in faults.values():
            apart = own & ~other
            if apart.any():
                columns.setdefault(apart.tobytes(), apart)
    if not columns:
        return np.zeros((signatures.shape[0], 0), dtype=np.bool_)
    return np.stack(list(columns.values()), axis=1)


def choose(signatures: Bools, costs: Sequence[float] | None = None) -> Choice:
    """Residuals that detect and isolate as much as all of them together, at the least cost.

    `costs` of the residuals are 1 by default, so that the fewest are chosen; of equals the
    earlier one. Greedy by the demands that are still open for the cost; where the problem is
    small, the least cost is found exactly by an integer program.

    >>> choose(np.array([[1, 0], [0, 1], [1, 1]], dtype=bool))
    Choice(chosen=(0, 1), least=True)
    """
    price = [1.0] * len(signatures) if costs is None else list(costs)
    seen: dict[bytes, int] = {}
    for row in sorted(range(len(signatures)), key=lambda k: (price[k], k)):
        seen.setdefault(signatures[row].tobytes(), row)
    rows = list(seen.values())
    met = demands(signatures[rows])
    own = np.array([price[r] for r in rows])
    picked = _greedy(met, own)
    least = False
    if met.size <= _EXACT:
        best = _exact(met, own) if len(picked) > 1 else picked
        if best is not None:
            picked, least = best, True
    return Choice(tuple(sorted(rows[p] for p in picked)), least)


def _greedy(met: Bools, costs: npt.NDArray[np.float64]) -> list[int]:
    """Cover all demands, the most still open first; then drop what the others make needless."""
    open_demands = np.ones(met.shape[1], dtype=np.bool_)
    picked: list[int] = []
    while open_demands.any():
        best = int(np.argmax(met[:, open_demands].sum(axis=1) / costs))
        picked.append(best)
        open_demands &= ~met[best]
    for row in sorted(picked, key=lambda p: (-costs[p], -p)):
        others = [p for p in picked if p != row]
        if met[others].any(axis=0).all():
            picked = others
    return picked


def _exact(met: Bools, costs: npt.NDArray[np.float64]) -> list[int] | None:
    """The cheapest cover by integer programming; None if it was not proved to be that."""
    from scipy.optimize import Bounds, LinearConstraint, milp

    solved = milp(
        costs,
        constraints=LinearConstraint(met.T.astype(float), lb=1.0),
        integrality=np.ones(len(costs)),
        bounds=Bounds(0, 1),
        options={"node_limit": _NODES, "mip_rel_gap": 0.0},
    )
    return None if solved.status != 0 else [int(i) for i in np.flatnonzero(solved.x > 0.5)]
