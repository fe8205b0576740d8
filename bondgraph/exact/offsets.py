"""How often each equation has to be differentiated before every variable is determined.

The algorithm of Pantelides (1988) on the signature (highest derivative of each variable in each
equation); its result are the canonical offsets of Pryce (2001).
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple


class Offsets(NamedTuple):
    """Equation i is needed to its derivative `equations[i]`, variable j to `variables[j]`.

    `free` are variables that no equation determines, `unmatched` equations that determine none.
    """

    equations: list[int]
    variables: list[int]
    free: list[int]
    unmatched: list[int]


class _Matching:
    """Equations matched to variables along admissible edges, by augmenting paths."""

    def __init__(self, signature: Sequence[dict[int, int]], variables: int) -> None:
        self.signature = signature
        self.equation_of = [-1] * variables
        self.variable_of = [-1] * len(signature)

    def augment(self, start: int, c: list[int], d: list[int] | None) -> set[int] | None:
        """Match equation `start`; on failure the variables that were reached.

        With `d` only variables at their highest derivative are admissible.
        """
        came: dict[int, int] = {}
        stack = [start]
        seen = {start}
        while stack:
            i = stack.pop()
            for j, sigma in self.signature[i].items():
                if j in came or (d is not None and sigma + c[i] != d[j]):
                    continue
                came[j] = i
                owner = self.equation_of[j]
                if owner < 0:
                    self._flip(j, came)
                    return None
                if owner not in seen:
                    seen.add(owner)
                    stack.append(owner)
        return set(came)

    def _flip(self, j: int, came: dict[int, int]) -> None:
        while True:
            i = came[j]
            previous = self.variable_of[i]
            self.variable_of[i], self.equation_of[j] = j, i
            if previous < 0:
                return
            j = previous


class Redundancy:
    """Which equations are more than enough once some of their variables are told."""

    def __init__(self, rows: Sequence[Sequence[int]], variables: int) -> None:
        """`rows` are the variables of each equation."""
        self._rows = [dict.fromkeys(row, 0) for row in rows]
        self._matching = _Matching(self._rows, variables)
        for i in range(len(rows)):
            self._matching.augment(i, [], None)

    def about(self, told: Sequence[Sequence[int]]) -> list[int]:
        """The equations in the over-determined part about values that are told.

        Each is told in the variables that it is made of: one equation more.
        """
        more = _Matching([*self._rows, *[dict.fromkeys(row, 0) for row in told]], 0)
        more.equation_of = self._matching.equation_of.copy()
        more.variable_of = [*self._matching.variable_of, *[-1] * len(told)]
        count = len(self._rows)
        reached = [more.augment(count + k, [], None) for k in range(len(told))]
        owners = {more.equation_of[j] for variables in reached for j in variables or ()}
        return sorted(i for i in owners if i < count)


def square_part(signature: Sequence[dict[int, int]], variables: int) -> list[tuple[int, int]]:
    """The equations that leave their variables no freedom, each with a variable of its own.

    The part of the decomposition of Dulmage and Mendelsohn (1958) that no variable without an
    equation can be reached from; -1 stands for the variable of an equation that is one too many.
    """
    count = len(signature)
    matching = _Matching(signature, variables)
    for i in range(count):
        matching.augment(i, [0] * count, None)
    holders: list[list[int]] = [[] for _ in range(variables)]
    for i, row in enumerate(signature):
        for j in row:
            holders[j].append(i)
    loose = {j for j in range(variables) if matching.equation_of[j] < 0}
    stack = sorted(loose)
    while stack:
        for i in holders[stack.pop()]:
            j = matching.variable_of[i]
            if j not in loose:
                loose.add(j)
                stack.append(j)
    return [(i, j) for i, j in enumerate(matching.variable_of) if j not in loose]


def offsets(signature: Sequence[dict[int, int]], variables: int) -> Offsets:
    """The offsets of a system; `signature[i][j]` is the highest derivative of j in equation i.

    Equations that cannot be matched to a variable of their own are left out (`unmatched`).
    """
    count = len(signature)
    c = [0] * count
    any_order = _Matching(signature, variables)
    unmatched = [i for i in range(count) if any_order.augment(i, c, None) is not None]
    free = [j for j in range(variables) if any_order.equation_of[j] < 0]
    left_out, idle = set(unmatched), set(free)
    inner = [
        {j: s for j, s in row.items() if j not in idle} if i not in left_out else {}
        for i, row in enumerate(signature)
    ]
    d = [0] * variables
    for row in inner:
        for j, sigma in row.items():
            d[j] = max(d[j], sigma)
    matching = _Matching(inner, variables)
    for i in range(count):
        if i in left_out:
            continue
        while (reached := matching.augment(i, c, d)) is not None:
            for k in {i, *[matching.equation_of[j] for j in reached]}:
                c[k] += 1
            for j in reached:
                d[j] += 1
    return Offsets(c, d, free, unmatched)
