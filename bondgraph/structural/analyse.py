"""The diagnostic power of a structure: MSO sets, isolability, and residuals chosen for it."""

from __future__ import annotations

import numpy as np

from bondgraph.ir.structural_model import StructuralModel
from bondgraph.structural.choose import Bools, choose
from bondgraph.structural.mso import MsoSets, Progress, mso_sets
from bondgraph.structural.realise import Realisation, integral_residuals, realisations
from bondgraph.structural.structural_isolability import Isolability, isolability
from bondgraph.structural.witness import witness
from bondgraph.text.tuples import NamedTuple

_HIGH_INDEX = 100.0  # a residual of a high index costs as much as so many of a low one
_TRIED = 8  # sets of one signature that are tried for one without a differential loop


class Chosen(NamedTuple):
    """One residual of the choice: an MSO set, the faults it sees, how it is best computed."""

    equations: tuple[int, ...]
    faults: tuple[int, ...]
    realisation: Realisation


class Analysis(NamedTuple):
    """What a structure can tell.

    `best` is the isolability of any residuals, `reached` that of the MSO sets alone: less where
    a fault in several equations must be eliminated between them. `integral` are the sets with a
    residual of low index, which needs no differentiation. `least` says that the residuals of
    `chosen` have as few of a high index as can be, and are then as few as can be.
    """

    model: StructuralModel
    sets: MsoSets
    integral: tuple[int, ...]
    best: Isolability
    reached: Isolability
    chosen: tuple[Chosen, ...]
    least: bool


def analyse(
    model: StructuralModel, limit: int | None = None, progress: Progress | None = None
) -> Analysis:
    """Find the MSO sets (at most `limit`), what they tell apart, and a small choice of them.

    Where the limit cuts the search off, sets that are still needed to tell two faults apart are
    built one by one, so that the choice is as good as with all sets, if not as small.
    """
    tell = progress or (lambda _, __: None)

    def searched(done: float, count: int) -> None:
        tell(max(done, count / limit if limit else 0.0) / 2, count)

    sets = mso_sets(model, limit, searched)
    best = isolability(model)
    found = sets.all()
    low_index = []
    for k, mso in enumerate(found):
        if integral_residuals(model, mso):
            low_index.append(k)
        if k % 100 == 0:
            tell(0.5 + k / len(found) / 2, len(found))
    integral = tuple(low_index)
    if not sets.complete:
        found += _missing(model, best, _signatures(model, found))
    signatures = _signatures(model, found)
    low = set(integral)
    costs = [1.0 if k in low else _HIGH_INDEX for k in range(len(found))]
    choice = choose(signatures, costs)
    chosen = tuple(_best(model, found, signatures, k, low) for k in choice.chosen)
    reached = _by_signature(signatures)
    return Analysis(model, sets, integral, best, reached, chosen, choice.least and sets.complete)


def _best(
    model: StructuralModel, found: list[tuple[int, ...]], signatures: Bools, k: int, low: set[int]
) -> Chosen:
    """The chosen set, or another of the same signature that is easier to compute."""
    alike = [k]
    if k not in low:
        same = np.flatnonzero((signatures == signatures[k]).all(axis=1))
        alike = [int(i) for i in same[:_TRIED]]
    ways = [(min(realisations(model, found[i]), key=lambda r: r.cost), i) for i in alike]
    way, at = min(ways, key=lambda w: (w[0].cost, w[1]))
    faults = tuple(int(f) for f in np.flatnonzero(signatures[k]))
    return Chosen(found[at], faults, way)


def _signatures(model: StructuralModel, sets: list[tuple[int, ...]]) -> Bools:
    """Which set holds which fault: an array of shape (sets, faults)."""
    holds = np.zeros((len(model.equations), len(model.faults)), dtype=np.bool_)
    for e, equation in enumerate(model.equations):
        holds[e, list(equation.faults)] = True
    rows = [holds[list(mso)].any(axis=0) for mso in sets]
    return np.array(rows, dtype=np.bool_).reshape(len(sets), len(model.faults))


def _missing(model: StructuralModel, best: Isolability, signatures: Bools) -> list[tuple[int, ...]]:
    """Sets for the faults that those found do not see, or do not tell apart."""
    added: list[tuple[int, ...]] = []
    heads = [g[0] for g in best.groups]
    equations = [set(model.holders(f)) for f in heads]
    #: for each fault the sets that hold it, one bit a set
    seen = [int.from_bytes(np.packbits(signatures[:, f]).tobytes()) for f in heads]
    for i, own in enumerate(equations):
        for j, other in enumerate(equations):
            if seen[i] & ~(0 if i == j else seen[j]):
                continue
            apart = witness(model, own, set() if i == j else other)
            if apart is not None:
                added.append(apart)
                for k, held in enumerate(equations):
                    seen[k] = seen[k] << 1 | (not held.isdisjoint(apart))
    return added


def _by_signature(signatures: Bools) -> Isolability:
    groups: dict[bytes, list[int]] = {}
    for fault in range(signatures.shape[1]):
        groups.setdefault(signatures[:, fault].tobytes(), []).append(fault)
    none = tuple(groups.pop(bytes(len(signatures)), ()))
    return Isolability(tuple(tuple(g) for g in groups.values()), none)
