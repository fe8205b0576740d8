"""All minimal structurally overdetermined (MSO) sets of equations.

An MSO set has one equation more than unknowns, and no part of it has (Krysander, Aslund, Nyberg,
2008): it is a circuit of the transversal matroid that the unknowns make of the equations. With
the redundancies of `generic` as a matrix of one column an equation, circuits are the complements
of the hyperplanes that columns span (Oxley, Matroid Theory, 2011, section 2.1). Equations that
are in each other's line are always in an MSO set together and count as one. Hyperplanes are
enumerated by their lexicographically first basis, many at once; each set found is then checked
against the incidence itself. If every circuit of the numbers is one of the structure, the two
have the same circuits: numbers that meet by chance are always noticed, and drawn again.
"""

from __future__ import annotations

import random
from collections.abc import Callable, Iterator
from itertools import pairwise
from typing import TypeAlias

import numpy as np
import numpy.typing as npt

from bondgraph.ir.structural_model import StructuralModel
from bondgraph.structural.generic import direction, redundancy
from bondgraph.structural.matching import decompose
from bondgraph.text.tuples import NamedTuple

Bools: TypeAlias = npt.NDArray[np.bool_]
Numbers: TypeAlias = npt.NDArray[np.int64]
#: Told how far the search is (0 to 1) and how many sets it has.
Progress: TypeAlias = Callable[[float, int], None]

PRIME = (1 << 31) - 1  # products of two numbers below it fit a signed 64-bit integer
_AT_ONCE = 1 << 19  # numbers in one step of the search
_ON_ONE_CORE = 200_000  # multiplications of matrices that are not worth a second thread
_TRIES = 40


class MsoSets(NamedTuple):
    """The MSO sets, the smallest first.

    `classes` are equations that are always together, `members[set, class]` says which are in a
    set. `redundancy` is the number of equations of the overdetermined part less its unknowns;
    `complete` is false where the search stopped at its limit.
    """

    classes: tuple[tuple[int, ...], ...]
    members: Bools
    redundancy: int
    complete: bool

    @property
    def number(self) -> int:
        """How many sets there are."""
        return int(self.members.shape[0])

    def arrays(self) -> list[Numbers]:
        """The equations of every set, ascending, as arrays."""
        pairs = sorted((e, k) for k, own in enumerate(self.classes) for e in own)
        equations = np.array([e for e, _ in pairs], dtype=np.int64)
        held = self.members.take([k for _, k in pairs], axis=1)
        names = equations[np.flatnonzero(held) % max(1, len(equations))]
        ends = np.cumsum(held.sum(axis=1)).tolist()
        return [names[a:b] for a, b in pairwise([0, *ends])]

    def all(self) -> list[tuple[int, ...]]:
        """The equations of every set, ascending."""
        return [tuple(found.tolist()) for found in self.arrays()]


class _UnluckyError(ArithmeticError):
    """Random numbers met by chance."""


def mso_sets(
    model: StructuralModel, limit: int | None = None, progress: Progress | None = None
) -> MsoSets:
    """All MSO sets of a model, or the first `limit` that are found.

    Exact: every set returned is minimal, and without a limit none is missing.
    """
    parts = decompose(model.rows, len(model.unknowns))
    over = parts.over_rows
    excess = len(over) - len(parts.over_columns)
    if not over:
        return MsoSets((), np.zeros((0, 0), dtype=np.bool_), 0, True)
    rows = [list(model.equations[r].unknowns) for r in over]
    for seed in range(1, _TRIES):
        try:
            classes, columns = _columns(rows, excess, seed)
            members, complete = _search(columns, limit, progress or (lambda _, __: None))
            _check(rows, classes, members)
        except _UnluckyError:
            continue
        lengths = np.array([len(c) for c in classes], dtype=np.float32)
        order = np.argsort(members.astype(np.float32) @ lengths, kind="stable")
        named = tuple(tuple(over[e] for e in c) for c in classes)
        return MsoSets(named, members[order], excess, complete)
    raise ArithmeticError("no random numbers were found that do not meet by chance")


def _columns(
    rows: list[list[int]], excess: int, seed: int
) -> tuple[list[tuple[int, ...]], Numbers]:
    """The classes of parallel equations, and one random column of `excess` numbers for each."""
    found = redundancy(rows, prime=PRIME, seed=seed)
    if len(found.free) != excess:
        raise _UnluckyError
    classes: dict[tuple[tuple[int, int], ...], list[int]] = {}
    for equation, vector in enumerate(found.vectors):
        classes.setdefault(direction(vector, PRIME), []).append(equation)
    if () in classes:
        raise _UnluckyError
    draw = random.Random(-seed)
    mix = [[draw.randrange(1, PRIME) for _ in range(excess)] for _ in range(excess)]
    columns = [[sum(weights[d] * x for d, x in key) % PRIME for key in classes] for weights in mix]
    return [tuple(c) for c in classes.values()], np.array(columns, dtype=np.int64)


class _Batch(NamedTuple):
    """Flats of one rank: what is left of the columns when each is contracted.

    `numbers[flat, row, class]`; `inside` marks the classes in the flat, `barred` those that must
    stay out of it, because a flat that has them is found elsewhere; `share` is the part of the
    whole search that is below.
    """

    numbers: Numbers
    inside: Bools
    barred: Bools
    share: float


def _search(columns: Numbers, limit: int | None, progress: Progress) -> tuple[Bools, bool]:
    """The complements of the hyperplanes, and whether these are all."""
    rank, size = columns.shape
    if rank == 1:
        return np.ones((1, size), dtype=np.bool_), True
    none = np.zeros((1, size), dtype=np.bool_)
    stack = [iter([_Batch(columns[np.newaxis], none, none, 1.0)])]
    found: list[Bools] = []
    count, done = 0, 0.0
    while stack:
        batch = next(stack[-1], None)
        if batch is None:
            stack.pop()
        elif batch.numbers.shape[1] > 2:
            stack.append(_larger(batch))
        else:
            found.append(~_hyperplanes(batch))
            count += len(found[-1])
            done += batch.share
            progress(done, count)
            if limit is not None and count > limit:
                return np.concatenate(found)[:limit], False
    return np.concatenate(found), True


def _larger(batch: _Batch) -> Iterator[_Batch]:
    """The flats of the next rank, in pieces of bounded size."""
    rank, size = batch.numbers.shape[1:]
    flats, chosen = np.nonzero(~batch.inside & ~batch.barred)
    step = max(1, _AT_ONCE // (rank * size))
    for start in range(0, len(flats), step):
        flat, by = flats[start : start + step], chosen[start : start + step]
        numbers = batch.numbers[flat]
        each = np.arange(len(flat))
        lead, rest = numbers[:, 0], numbers[:, 1:]
        pivot, factor = lead[each, by], rest[each, :, by]
        if not pivot.all():
            raise _UnluckyError
        numbers = pivot[:, None, None] * rest - factor[:, :, None] * lead[:, None, :]
        numbers %= PRIME
        inside: Bools = np.logical_not(numbers.any(axis=1))
        barred = batch.barred[flat] | (np.arange(size) < by[:, None])
        barred &= ~batch.inside[flat]
        keep = np.flatnonzero(~(inside & barred).any(axis=1))
        share = batch.share * len(flat) / len(flats)
        yield _Batch(numbers[keep], inside[keep], barred[keep], share)


def _hyperplanes(batch: _Batch) -> Bools:
    """Which classes are in each hyperplane that is one rank above the flats."""
    flats, _, size = batch.numbers.shape
    first, second = batch.numbers[:, 0], batch.numbers[:, 1]
    if ((first == 0) & ~batch.inside).any():
        raise _UnluckyError
    # classes are on one line where the quotient of their two numbers is the same
    line = np.where(batch.inside, -1, second * _inverse(first) % PRIME)
    order = np.argsort(line, axis=1, kind="stable")
    flat = np.repeat(np.arange(flats), size)
    at = order.ravel()
    lines = line[flat, at]
    new = np.ones(len(at), dtype=np.bool_)
    new[1:] = (lines[1:] != lines[:-1]) | (flat[1:] != flat[:-1])
    heads = np.flatnonzero(new)
    if not len(heads):
        return np.zeros((0, size), dtype=np.bool_)
    barred = np.logical_or.reduceat(batch.barred[flat, at], heads)
    heads = heads[~barred & (lines[heads] >= 0)]
    found: Bools = (line[flat[heads]] == lines[heads, None]) | batch.inside[flat[heads]]
    return found


def _inverse(numbers: Numbers) -> Numbers:
    """The inverse of each number of the field, of 0 some number.

    One inversion serves all: pairs are multiplied to one number, and its inverse is taken apart
    again by the other factor of each pair (Montgomery, 1987).
    """
    levels = [np.where(numbers == 0, 1, numbers).ravel()]
    while len(levels[-1]) > 1:
        if len(levels[-1]) % 2:
            levels[-1] = np.append(levels[-1], 1)
        levels.append(levels[-1][::2] * levels[-1][1::2] % PRIME)
    inverse: Numbers = np.array([pow(int(levels.pop()[0]), -1, PRIME)])
    for factors in reversed(levels):
        others = factors.reshape(-1, 2)[:, ::-1]
        inverse = (inverse[: len(others), None] * others % PRIME).ravel()
    return inverse[: numbers.size].reshape(numbers.shape)


def _check(rows: list[list[int]], classes: list[tuple[int, ...]], members: Bools) -> None:
    """Each set must have one equation more than unknowns, by the incidence itself."""
    holders: dict[int, list[int]] = {}
    for k, equations in enumerate(classes):
        for c in sorted({c for e in equations for c in rows[e]}):
            holders.setdefault(c, []).append(k)
    shared = [h for h in holders.values() if len(h) > 1]
    incidence = np.zeros((len(classes), len(shared)), dtype=np.float32)
    for column, held in enumerate(shared):
        incidence[held, column] = 1
    # equations less the unknowns that only one class has: these are there whenever it is
    excess = np.array([len(c) for c in classes], dtype=np.float32)
    for held in holders.values():
        if len(held) == 1:
            excess[held] -= 1
    step = max(1, _ON_ONE_CORE // max(1, incidence.size))
    for start in range(0, len(members), step):
        part = members[start : start + step].astype(np.float32)
        unknowns = np.count_nonzero(part @ incidence, axis=1)
        if (part @ excess != unknowns + 1).any():
            raise _UnluckyError
