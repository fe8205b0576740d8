"""Two faults at once: which two explain what was seen, whether it takes both, and which are told.

How probable two are is asked of the same evidence as one: `Evidence.both`. Here is what only two
have: the search, that each of both shows, and how much more than one they have to explain.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from itertools import product
from types import MappingProxyType

import numpy as np

from bondgraph.ir.signature_matrix import DoubleFaults
from bondgraph.runtime.diagnosis.attenuation import beside_their_noise
from bondgraph.runtime.diagnosis.history import History
from bondgraph.runtime.diagnosis.isolation import (
    BEHIND,
    FLAT,
    RARER,
    Case,
    Evidence,
    Explained,
    ExplainedPair,
    Rows,
    by_fault,
    inverse,
)
from bondgraph.runtime.diagnosis.model_error import SHARE
from bondgraph.runtime.diagnosis.noise import left_for_drift
from bondgraph.runtime.diagnosis.possible import SHOWN, changed, fits, possible
from bondgraph.runtime.diagnosis.row_sums import Told
from bondgraph.runtime.diagnosis.rows import CORRELATED
from bondgraph.runtime.diagnosis.tuning import UNKNOWN
from bondgraph.runtime.log import Array
from bondgraph.text.tuples import NamedTuple

_LEADS = 8  # faults of which pairs with every other one are looked at
_MOST = 1.1  # of a signal, by which its gain may be other beside another fault, laws being rough
_PAIRS, _ROUNDS = 8, 4  # pairs whose sizes beside each other are looked for, and rounds of it


class _Sized(NamedTuple):
    """Two at once, with what they do in these sizes."""

    two: ExplainedPair
    case: Case


def pairs(
    seen: Told,
    rows: Rows,
    case: Case,
    singles: Sequence[Explained],
    known: tuple[History, History],
    early: Array,
    bent: Callable[[Mapping[int, float]], Array | None],
) -> tuple[list[Explained], list[ExplainedPair]]:
    """How well each fault of a case explains rows and how well two do, to be compared.

    Two of the `singles`, each with its onset and size. How a fault sets in is not known: whether
    one is enough does not hang on that, which is the variance `early` of the first rows, nor on
    what parameters of a healthy machine may drift by meanwhile, as in the second of what is
    `known`. But which two it is, and how large they are, is known best with it: some show only
    then. And each of both has to show (see `showing`). `bent` are slopes of hypotheses, by their
    numbers, up to some changes, None where nobody knows them.
    """
    history, drifted = known
    whole = Evidence(rows, history)
    found = searched(whole, case, singles)
    numbers = [[case.hypotheses.index(h) for h in two.hypotheses] for two in found]
    near = sum(two.evidence >= found[0].evidence - BEHIND for two in found[:_PAIRS])
    sized = [_beside(whole, rows, *of, bent) for of in zip(found[:near], numbers, strict=False)]
    for one in (rows, *case.others.values()):
        one.weight[:] = 1.0 / (inverse(one.weight) + early)
    evidence = Evidence(rows, drifted)
    later = [two for own in sized for two in evidence.both(own.case, [(0, 1)])]
    later += evidence.both(case, [(a, b) for a, b in numbers[near:]])
    moved = [own.case.slopes for own in sized]
    moved += [rows.slopes[:, own] for own in numbers[near:]]
    found[:near] = [own.two for own in sized]
    found = [again._replace(changes=two.changes, whole=two.whole)
             for again, two in zip(later, found, strict=True)]  # fmt: skip
    alone = evidence.explained([case])[0]
    both = [np.einsum("tjr,j->tr", own, two.changes)
            for two, own in zip(found, moved, strict=True)]  # fmt: skip
    found = beside_their_noise(seen.noise, rows, _left(rows, case, alone), found, both)
    found = [found[k] for k in showing(seen, rows, found, moved)]
    return alone, sorted(found, key=lambda two: -two.whole)


def _left(rows: Rows, case: Case, alone: Sequence[Explained]) -> Array:
    """What is left of the rows beside the single fault of a size that explains most."""
    sized = [one for one in alone if one.hypothesis.held is None]
    if not sized:
        return rows.value
    best = max(sized, key=lambda one: one.evidence)
    return rows.value - rows.slopes[:, case.hypotheses.index(best.hypothesis)] * best.change


def searched(
    evidence: Evidence, case: Case, singles: Sequence[Explained]
) -> list[ExplainedPair]:
    """How well two faults at once explain the rows, the best pair first.

    Each fault acts in any way that has a size, and one of both is among those that explain most
    alone: the first step of a search that adds one fault at a time. Two faults have the same
    scales, and the prior of one.
    """
    leads = sorted(singles, key=lambda e: -e.evidence)
    ways = by_fault(case)
    sized = ([j for j in ways.get(e.fault, ()) if case.hypotheses[j].held is None] for e in leads)
    place = [own for own in sized if own]  # what is held only takes nobody's place
    pairs = [
        pair
        for at, own in enumerate(place[:_LEADS])
        for others in place[at + 1 :]
        for pair in product(own, others)
    ]
    found: dict[tuple[str, ...], ExplainedPair] = {}
    for two in sorted(evidence.both(case, pairs), key=lambda two: -two.evidence):
        found.setdefault(tuple(h.fault for h in two.hypotheses), two)
    return list(found.values())


def _beside(
    evidence: Evidence,
    rows: Rows,
    two: ExplainedPair,
    numbers: Sequence[int],
    bent: Callable[[Mapping[int, float]], Array | None],
) -> _Sized:
    """Two at once with slopes up to the sizes that they have beside each other.

    That is not the size with which one of them explains most alone.
    """
    best = _Sized(two, Case(two.hypotheses, rows.slopes[:, numbers]))
    for _ in range(_ROUNDS):
        slopes = bent(dict(zip(numbers, best.two.changes, strict=True)))
        if slopes is None:
            break
        case = Case(two.hypotheses, slopes)
        (again,) = evidence.both(case, [(0, 1)])
        if again.evidence <= best.two.evidence + FLAT:
            break
        best = _Sized(again, case)
    return best


def showing(
    seen: Told, rows: Rows, pairs: Sequence[ExplainedPair], moved: Sequence[Array]
) -> Iterator[int]:
    """Which pairs are two faults: each of both would show by itself, and beside the other one.

    In some residual it makes what was seen a thousand times more probable than a machine with what
    gives no alarm, and with a law that is wrong by two deviations of what is said of the residual;
    and so does what is left of it where the other one takes its part. What is less mends the model,
    or follows a supply that wanders. `moved` is what one of each does, (rows, 2, residuals).
    """
    room, sigma = left_for_drift(seen.bound, seen.doubt)[:, None], seen.noise[:, None]
    room = room + UNKNOWN * SHARE * np.abs(rows.value)[:, None]
    known = (rows.weight > 0)[:, None] & np.isfinite(sigma)

    def shows(moves: Array) -> bool:
        out = np.maximum(np.abs(moves) - room, 0.0)
        squares = np.divide(out, sigma, where=known, out=np.zeros_like(out)) ** 2
        return bool((squares.sum(axis=0).max(axis=1) >= 2.0 * CORRELATED * RARER).all())

    for k, (two, slopes) in enumerate(zip(pairs, moved, strict=True)):
        own = slopes * np.array(two.changes)[:, None]
        if shows(own) and shows(own - along(own, own[:, ::-1], rows.weight)):
            yield k


def along(moves: Array, others: Array, weight: Array) -> Array:
    """The part of each of `moves` that some size of the one beside it in `others` does.

    All (rows, n, residuals), the weight of residuals (rows, residuals).

    >>> moves, others = np.array([[[3.0, 1.0]]]), np.array([[[1.0, 0.0]]])
    >>> along(moves, others, np.ones((1, 2))).tolist()
    [[[3.0, 0.0]]]
    """
    weight = weight[:, None]
    sizes = (weight * others**2).sum(axis=(0, 2))
    share = (weight * moves * others).sum(axis=(0, 2)) / np.where(sizes > 0.0, sizes, 1.0)
    return np.asarray(share[:, None] * others)


class OneOrTwo(NamedTuple):
    """Whether a single fault is enough for what was seen, and `alone` may be named.

    If it is not, `pairs` are those that are, the best one first, none where these are not either.
    `perhaps` says that of the faults that look like no single one two may be it all the same, or
    that one may be it that explains what was seen, if less well than two.
    """

    alone: bool = True
    pairs: Sequence[ExplainedPair] = ()
    perhaps: bool = False


def one_or_two(
    alone: Sequence[Explained],
    pairs: Sequence[ExplainedPair],
    one: bool,
    doubles: Callable[[], DoubleFaults],
) -> OneOrTwo:
    """How probable two faults at once are beside one `alone`; of `one` it is known that it fits.

    Two at once are rarer, and how a fault sets in and goes on is not known: where a single fault
    fits, two that look like some single one are not asked for.
    """
    least = max((e.evidence for e in alone), default=-math.inf) + RARER
    left = [pair for pair in pairs if pair.evidence >= least and fits(pair)]
    if not (one or any(fits(e) for e in alone)):
        return OneOrTwo(False, left)
    near = [p for p in pairs if p.evidence >= least + math.log(SHOWN) and fits(p)]
    told = [p for p in near if doubles().like_none(h.fault for h in p.hypotheses)]
    if any(pair.evidence >= least for pair in told):
        return OneOrTwo(False, left, True)
    return OneOrTwo(True, (), bool(told))


def pairs_that_can(
    found: Sequence[ExplainedPair],
    faults: Mapping[str, float | None],
    sees: Mapping[str, Sequence[str]],
    fired: Iterable[str],
    signs: Mapping[str, int] = MappingProxyType({}),
) -> list[ExplainedPair]:
    """Without the pairs that cannot be, as `candidates`: what has fired one of both has to move.

    Nor does a signal become more than twice what it was, or turn, while something else breaks:
    two that nearly cancel each other would explain a little of anything.
    """
    seen = [set(sees.get(name, ())) for name in fired]
    left = []
    for pair in found:
        own = {h.fault for h in pair.hypotheses}
        each = [Explained(h.fault, 0.0, h, change, 0.0)
                for h, change in zip(pair.hypotheses, pair.changes, strict=True)]  # fmt: skip
        kept = [possible(e, faults.get(e.fault), signs.get(e.fault)) for e in each]
        can = all(e.evidence == 0.0 for e in kept)
        can &= all(abs(changed(e.hypothesis, e.change)) <= _MOST
                   for e in kept if e.hypothesis.kind == "gain")  # fmt: skip
        if can and not any(own.isdisjoint(s) for s in seen):
            left.append(pair._replace(changes=(kept[0].change, kept[1].change)))
    return left
