"""What an added sensor would bring, and the cheapest sensors that bring all that can be had.

A sensor that measures an unknown adds one equation (Krysander and Frisk, 2008). All candidates
are eliminated at once, together: what a choice of them can tell apart then follows from the
directions of the faults, restricted to the redundancies of that choice.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Sequence

from bondgraph.ir.structural_model import StructuralEquation, StructuralModel
from bondgraph.structural.generic import PRIME, direction, redundancy
from bondgraph.structural.structural_isolability import Isolability, fault_directions
from bondgraph.text.tuples import NamedTuple

_Vector = dict[int, int]


class Candidate(NamedTuple):
    """A sensor that could be added: it measures the unknown of column `unknown` at a cost."""

    name: str
    unknown: int
    cost: float = 1.0


class Placement(NamedTuple):
    """Sensors that reach all that any choice of candidates can, as candidate numbers.

    `least` says that none is cheaper.
    """

    sensors: tuple[int, ...]
    cost: float
    least: bool


class Placing:
    """The faults of a model as seen with any choice of candidate sensors.

    With `faulty`, each added sensor is a fault too, numbered behind those of the model in the
    order of the candidates; it counts only where it is chosen.
    """

    def __init__(
        self, model: StructuralModel, candidates: Sequence[Candidate], faulty: bool = False
    ) -> None:
        self.model = model
        self.candidates = tuple(candidates)
        self.faulty = faulty
        origin = model.equations[0].origin
        names = list(model.faults)
        added = []
        for candidate in candidates:
            faults: tuple[int, ...] = ()
            if faulty:
                faults = (len(names),)
                names.append(candidate.name)
            column = (candidate.unknown,)
            added.append(StructuralEquation(candidate.name, column, ("",), (), faults, origin))
        whole = model._replace(faults=tuple(names), equations=(*model.equations, *added))
        found = redundancy(whole.rows, last=len(added))
        self.directions = fault_directions(whole, found.vectors)
        first = len(model.equations)
        place = {equation: d for d, equation in enumerate(found.free)}
        #: the redundancy that each candidate opens, None where it is used up for an unknown
        self.opens = [place.get(first + k) for k in range(len(added))]
        self.vectors = found.vectors[first:]
        self.base = {d for d, equation in enumerate(found.free) if equation < first}

    def isolability(self, chosen: Collection[int] = ()) -> Isolability:
        """What residuals can do with the sensors of the model and the chosen ones."""
        kept = self.base | {d for k in chosen if (d := self.opens[k]) is not None}
        absent = [
            {d: x for d, x in self.vectors[k].items() if d in kept}
            for k, d in enumerate(self.opens)
            if d is None and k not in chosen
        ]
        clear = _quotient(absent)
        groups: dict[tuple[tuple[int, int], ...], list[int]] = {}
        for fault in self.faults(chosen):
            vector = {d: x for d, x in self.directions[fault].items() if d in kept}
            groups.setdefault(direction(clear(vector)), []).append(fault)
        undetectable = tuple(groups.pop((), ()))
        return Isolability(tuple(tuple(g) for g in groups.values()), undetectable)

    def faults(self, chosen: Collection[int]) -> list[int]:
        """The faults that count with a choice of sensors."""
        own = len(self.model.faults)
        return [*range(own), *(own + k for k in sorted(chosen) if self.faulty)]

    def reaches(self, chosen: Collection[int], best: Isolability) -> bool:
        """Whether a choice detects and isolates the faults that count as well as `best`."""
        reached = self.isolability(chosen)
        counted = set(self.faults(chosen))
        groups = [tuple(f for f in g if f in counted) for g in best.groups]
        return list(reached.groups) == [g for g in groups if g]


def _quotient(vectors: list[_Vector]) -> Callable[[_Vector], _Vector]:
    """A function that takes out of a vector what the given ones span."""
    pivots: list[tuple[int, _Vector]] = []

    def clear(vector: _Vector) -> _Vector:
        for at, pivot in pivots:
            factor = vector.get(at, 0)
            if factor:
                total = dict(vector)
                for d, x in pivot.items():
                    total[d] = (total.get(d, 0) - factor * x) % PRIME
                vector = {d: x for d, x in total.items() if x}
        return vector

    for vector in vectors:
        own = clear(vector)
        if own:
            at = min(own)
            inverse = pow(own[at], -1, PRIME)
            pivots.append((at, {d: x * inverse % PRIME for d, x in own.items()}))
    return clear


def place(placing: Placing, rounds: int = 400) -> Placement:
    """The cheapest sensors with the isolability that all candidates together have.

    More sensors never tell less apart, so each choice that fails can be grown until one more
    would make it succeed; whatever succeeds has a sensor outside of it. The cheapest choice that
    meets all these demands is either enough or shows another one (implicit hitting sets, Reiter
    1987). After `rounds` of them what is found greedily stands, `least` false.

    Raises ValueError for sensors that are faults themselves: one more may then tell less apart.
    """
    if placing.faulty:
        raise ValueError("the cheapest placement is sought for the faults of the model only")
    everything = range(len(placing.candidates))
    best = placing.isolability(everything)
    demands: list[list[int]] = []
    for _ in range(rounds):
        chosen = _cheapest(placing, demands)
        if chosen is None:
            break
        if placing.reaches(chosen, best):
            return _placement(placing, chosen, True)
        failing = list(chosen)
        for k in everything:
            if k not in failing and not placing.reaches([*failing, k], best):
                failing.append(k)
        demands.append([k for k in everything if k not in failing])
    chosen = list(everything)
    for k in sorted(everything, key=lambda k: (-placing.candidates[k].cost, -k)):
        fewer = [c for c in chosen if c != k]
        if placing.reaches(fewer, best):
            chosen = fewer
    return _placement(placing, chosen, False)


def _placement(placing: Placing, chosen: Sequence[int], least: bool) -> Placement:
    cost = sum(placing.candidates[k].cost for k in chosen)
    return Placement(tuple(sorted(chosen)), cost, least)


def _cheapest(placing: Placing, demands: list[list[int]]) -> list[int] | None:
    """The cheapest candidates with one out of each demand; None where that was not proved."""
    if not demands:
        return []
    import numpy as np
    from scipy.optimize import Bounds, LinearConstraint, milp

    size = len(placing.candidates)
    met = np.zeros((len(demands), size))
    for row, demand in zip(met, demands, strict=True):
        row[demand] = 1
    costs = np.array([c.cost for c in placing.candidates])
    solved = milp(
        costs,
        constraints=LinearConstraint(met, lb=1.0),
        integrality=np.ones(size),
        bounds=Bounds(0, 1),
        options={"node_limit": 10_000, "mip_rel_gap": 0.0},
    )
    return None if solved.status != 0 else [int(i) for i in np.flatnonzero(solved.x > 0.5)]
