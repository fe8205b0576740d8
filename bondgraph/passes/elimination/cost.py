"""What it takes to compute a variable from known signals, and so which way an elimination takes."""

from __future__ import annotations

from collections.abc import Sequence

from bondgraph.text.tuples import NamedTuple


class Cost(NamedTuple):
    """What is to be avoided, the worst first.

    `late` counts what is taken only where nothing else goes on: integrations of a storage, and
    iterations, each as much as `ITERATION` integrations. `hard` counts divisions by a signal and
    inversions of a law, `excess` derivatives beyond those that are free, `depth` the steps of the
    longest path from the known signals, `order` all derivatives on a path.
    """

    late: int
    hard: int
    excess: int
    depth: int
    order: int


#: What an iteration, and an integration from an undeclared start, count in integrations.
ITERATION, FREE_START = 10, 1000

#: A variable that a loop gives.
LOOP = Cost(0, 1, 0, 1, 0)


def after(others: Sequence[Cost], late: int, hard: int, derived: bool, free: int) -> Cost:
    """The cost of one more step on top of the variables that it needs.

    `derived` says that it differentiates; `free` derivatives cost nothing.

    >>> after([Cost(0, 0, 0, 1, 0), Cost(0, 1, 0, 3, 0)], late=0, hard=0, derived=True, free=0)
    Cost(late=0, hard=1, excess=1, depth=4, order=1)
    """
    late_below = hard_below = depth = order = 0
    for below in others:
        late_below, hard_below = max(late_below, below.late), max(hard_below, below.hard)
        depth, order = max(depth, below.depth), max(order, below.order)
    order += derived
    return Cost(late_below + late, hard_below + hard, max(order - free, 0), depth + 1, order)
