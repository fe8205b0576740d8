"""Which faults any set of residuals could detect, and which it could tell apart."""

from __future__ import annotations

import random

from bondgraph.ir.structural_model import StructuralModel
from bondgraph.structural.generic import PRIME, direction, redundancy
from bondgraph.text.tuples import NamedTuple


class Isolability(NamedTuple):
    """The best that residuals can do, by the structure.

    `groups` are the detectable faults, those that nothing tells apart together, in the order of
    the model; `undetectable` are the others.
    """

    groups: tuple[tuple[int, ...], ...]
    undetectable: tuple[int, ...]

    def isolable(self, fault: int, other: int) -> bool:
        """Whether some residual reacts to `fault` and not to `other`."""
        own = next((g for g in self.groups if fault in g), ())
        return bool(own) and other not in own


def isolability(model: StructuralModel) -> Isolability:
    """Structural detectability and isolability of all faults.

    A fault can be told from another if a redundancy reacts to it while the other is an unknown
    signal in all equations that hold it: if e is in the overdetermined part of the equations
    with that column added (Krysander and Frisk, 2008). In terms of the redundancies, each fault
    has a direction, and two can be told apart unless their directions are parallel. Time grows
    with equations times redundancy, not with pairs of faults.
    """
    found = redundancy(model.rows)
    return grouped(fault_directions(model, found.vectors))


def fault_directions(
    model: StructuralModel, vectors: tuple[dict[int, int], ...]
) -> list[dict[int, int]]:
    """How each fault enters the redundancies, a generic number in each equation that holds it."""
    draw = random.Random(2)
    found: list[dict[int, int]] = [{} for _ in model.faults]
    for equation, vector in zip(model.equations, vectors, strict=True):
        for fault in equation.faults:
            weight = draw.randrange(1, PRIME)
            own = found[fault]
            for dimension, x in vector.items():
                own[dimension] = (own.get(dimension, 0) + weight * x) % PRIME
    return [{d: x for d, x in own.items() if x} for own in found]


def grouped(directions: list[dict[int, int]]) -> Isolability:
    """Faults with parallel directions together."""
    groups: dict[tuple[tuple[int, int], ...], list[int]] = {}
    for fault, vector in enumerate(directions):
        groups.setdefault(direction(vector), []).append(fault)
    undetectable = tuple(groups.pop((), ()))
    return Isolability(tuple(tuple(g) for g in groups.values()), undetectable)
