"""Which fault it is, by magnitude: every candidate explains the residuals, better or worse.

Residuals are r(t) = sum_k s_k(t) d_k + s_j(t) c_j(t) + noise, with the sensitivities s through the
same filter. The d are what parameters are off by within their tolerances, constant and normal with
the deviation of their tolerance; the change c of candidate j is a signal that moves little from one
moment to the next. With both integrated out (Gaussian evidence; MacKay, 1992), candidates are
compared by how probable they make what was seen. A residual that a fault would have to move and
that did not speaks against it by as much as it would have moved, and no more.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from types import MappingProxyType

import numpy as np

from bondgraph.runtime.diagnosis.hypotheses import Hypothesis
from bondgraph.runtime.log import Array
from bondgraph.text.tuples import NamedTuple

#: Of the usual change: how large a fault is, nobody knows. Close together, so that no fault is
#: better off than another for being just as large as one of them.
_SCALES = tuple(10.0 ** (k / 4.0) for k in range(-4, 9))
_KEEP = 0.95  # correlation of a fault's change between neighbouring chunks
_CHUNK = 4  # rows in which the change is taken as constant, at least
_PARTS = 15  # chunks at most
_LEADS = 8  # faults of which pairs with every other one are looked at
_SMALL = 8192  # numbers in a matrix that BLAS does not share out among threads


class Explained(NamedTuple):
    """How well one fault explains what was seen.

    `evidence` is the logarithm of how much more probable it makes that than a healthy machine
    does. `change` is that of the one of its hypotheses that explains most by itself, at the end,
    with its deviation. `left` is what is left of the misfit (in squares of the noise), for each of
    the `values` that were compared, `share` how much of the healthy machine's it takes away.
    """

    fault: str
    evidence: float
    hypothesis: Hypothesis
    change: float
    deviation: float
    left: float = 0.0
    values: int = 1
    share: float = 1.0


class ExplainedPair(NamedTuple):
    """How well two faults at once explain what was seen, each in one way; see `Explained`."""

    hypotheses: tuple[Hypothesis, Hypothesis]
    evidence: float
    changes: tuple[float, float]
    left: float = 0.0
    values: int = 1


class Rows(NamedTuple):
    """Residuals at moments far enough apart for their noise to be taken as independent.

    Value and weight (1/variance, 0 where not valid) have the shape (rows, residuals). `rest` are
    the slopes by the parameters with a tolerance, which have been off for ever, `slopes` those by
    the hypotheses, which hold since the onset: (rows, parameters or hypotheses, residuals).
    """

    value: Array
    weight: Array
    rest: Array
    slopes: Array

    def part(self, start: int, stop: int | None = None) -> Rows:
        """Some of the rows."""
        return Rows(*[x[start:stop] for x in self])


class History:
    """What healthy operation has told of parameters that are off within their tolerances.

    `prior` are the standard deviations of the parameters. What is known is kept as a triangle and
    what it should give, `root` = (R, q), for parameters z in deviations: the misfit of all rows
    that were added is |R z - q|^2, forgotten slowly. Sums of squares would lose half of the digits,
    and encoders beside tolerances of a millionth need all of them (Bierman, 1977).
    """

    def __init__(self, prior: Array) -> None:
        self.prior = prior
        self.root = np.zeros((len(prior), len(prior) + 1))

    def add(self, value: Array, weight: Array, slopes: Array, keep: float) -> None:
        """One row: residuals, their weights, slopes of the shape (parameters, residuals)."""
        root = np.sqrt(weight)
        row = np.column_stack([(slopes * root).T * self.prior, root * value])
        self.root = _triangle(np.vstack([math.sqrt(keep) * self.root, row]))[: len(self.root)]

    def anew(self, gone: Sequence[int], keep: Sequence[int], more: Sequence[float]) -> History:
        """The same once the parameters `gone` have another value, unknown within their prior.

        What the others owe them is integrated out. Then only the parameters `keep` are kept, and
        such with the deviations `more` come behind them.
        """
        own, kept = list(gone), list(keep)
        rest = [k for k in range(len(self.prior)) if k not in own]
        order = [*own, *rest, -1]
        owed = np.vstack([self.root[:, order], np.eye(len(own), len(order))])
        left = _triangle(owed)[len(own) : len(self.prior), len(own) :]
        found = History(np.concatenate([self.prior[kept], np.array(more, dtype=float)]))
        for at, k in enumerate(kept):
            if k in rest:
                found.root[: len(left), at] = left[:, rest.index(k)]
        found.root[: len(left), -1] = left[:, -1]
        return found

    def narrow(self, deviations: Array) -> None:
        """Take the last parameters for known so well before, around what they are taken for."""
        start = len(self.prior) - len(deviations)
        scale = np.append(np.ones(start), deviations / self.prior[start:])
        self.prior = self.prior * scale
        self.root = self.root * np.append(scale, 1.0)

    def last(self, count: int) -> tuple[Array, Array]:
        """By how much the last parameters are off, most probably, and the covariance of that."""
        start = len(self.prior) - count
        known = self.known()[start:, start:]
        moved = self.prior[start:, None] * np.linalg.inv(known[:, :-1])
        return moved @ known[:, -1], moved @ moved.T

    def known(self) -> Array:
        """Prior and history together, in the form of `root`."""
        count = len(self.root)
        return _triangle(np.vstack([np.eye(count, count + 1), self.root]))[:count]

    def fit(self) -> Array:
        """By how much the parameters are off, most probably."""
        known = self.known()
        return np.asarray(self.prior * np.linalg.solve(known[:, :-1], known[:, -1]))

    def expected(self, slopes: Array) -> tuple[Array, Array]:
        """The residuals of the healthy machine as far as it is known, and their variances."""
        known = self.known()
        moved = np.linalg.solve(known[:, :-1].T, slopes * self.prior[:, None])
        return moved.T @ known[:, -1], np.square(moved).sum(axis=0)


def _triangle(rows: Array) -> Array:
    """A triangle of the same sums of squares and products as these rows; of each of a stack.

    Of many rows in pieces (Demmel et al., 2012): small ones are not shared out among threads, which
    would wait for each other longer than they work.
    """
    *stack, count, columns = rows.shape
    piece = max(2 * columns, _SMALL // columns)
    if count > piece:
        more = np.zeros((*stack, -count % piece, columns))
        pieces = np.concatenate([rows, more], axis=-2).reshape(*stack, -1, piece, columns)
        return _triangle(_triangle(pieces).reshape(*stack, -1, columns))
    return np.asarray(np.linalg.qr(rows, mode="r"))


def inverse(weight: Array) -> Array:
    """Variances from weights, infinite where there is none."""
    return np.where(weight > 0, 1.0 / np.maximum(weight, 1e-300), math.inf)


def explain(
    rows: Rows,
    hypotheses: Sequence[Hypothesis],
    history: History,
    others: Mapping[int, Rows] = MappingProxyType({}),
) -> list[Explained]:
    """How well each fault explains the rows since the onset, in the order of the hypotheses.

    `others` are the rows as they would be if a hypothesis without a size were told to the
    residuals, by its number. Raises numpy.linalg.LinAlgError where a number is none.
    """
    known, seen = _compared_with(rows, hypotheses, history)
    values = max(1, int((rows.weight > 0).sum()))
    told = {k: _seen(other, history.prior, np.zeros(0)) for k, other in others.items()}
    if not all(np.isfinite(table).all() for table in told.values()):
        raise np.linalg.LinAlgError("a residual or a weight is not finite")
    found = []
    for fault in dict.fromkeys(h.fault for h in hypotheses):
        own = [j for j, h in enumerate(hypotheses) if h.fault == fault]
        sized = [j for j in own if j not in told]
        alone = [_fits(known, seen, [j]) for j in sized]
        every = _fits(known, seen, sized) if len(sized) > 1 else []
        ways = [_compared([hypotheses[j] for j in sized], alone, every)] if sized else []
        ways += [_instead(hypotheses[j], known, seen, told[j]) for j in own if j in told]
        one = _either(ways)
        found.append(one._replace(left=one.left / values, values=values))
    return found


def explain_pairs(
    rows: Rows, hypotheses: Sequence[Hypothesis], history: History, singles: Sequence[Explained]
) -> list[ExplainedPair]:
    """How well two faults at once explain the rows, the best pair first.

    Each fault acts in the way in which it explains most alone, if that has a size, and one of both
    is among those that explain most so: the first step of a search that adds one fault at a time.
    Two faults have the same scales, and the prior of one; raises as `explain` does.
    """
    known, seen = _compared_with(rows, hypotheses, history)
    leads = sorted((e for e in singles if e.hypothesis.held is None), key=lambda e: -e.evidence)
    place = {e.fault: hypotheses.index(e.hypothesis) for e in leads}
    values = max(1, int((rows.weight > 0).sum()))
    found = []
    for at, one in enumerate(leads[:_LEADS]):
        for other in leads[at + 1 :]:
            own = one.hypothesis, other.hypothesis
            fits = _fits(known, seen, [place[h.fault] for h in own])
            top = max(fits, key=lambda f: f.evidence)
            sizes = (top.changes * [h.usual for h in own]).tolist()
            left = top.left / values
            both = sizes[0], sizes[1]
            found.append(ExplainedPair(own, _mean(fits), both, left, values))
    return sorted(found, key=lambda pair: -pair.evidence)


def _compared_with(
    rows: Rows, hypotheses: Sequence[Hypothesis], history: History
) -> tuple[Array, Array]:
    """What is known of the healthy machine, and what was seen; raises as `explain` does."""
    seen = _seen(rows, history.prior, np.array([h.usual for h in hypotheses]))
    known = history.known()
    if not (np.isfinite(seen).all() and np.isfinite(known).all()):
        raise np.linalg.LinAlgError("a residual, a slope or a weight is not finite")
    return known, seen


def _seen(rows: Rows, prior: Array, usual: Array) -> Array:
    """What was seen and what would move it, in units of noise: (chunks, moments, columns).

    Columns are the parameters with a tolerance, in deviations, the hypotheses, in their usual
    changes, and the residuals.
    """
    noise = np.sqrt(rows.weight)[:, :, None]
    rest = rows.rest.transpose(0, 2, 1) * prior
    slopes = rows.slopes.transpose(0, 2, 1) * usual
    table = np.concatenate([rest, slopes, rows.value[:, :, None]], axis=2) * noise
    length = max(_CHUNK, -(-len(table) // _PARTS))
    more = np.zeros((-len(table) % length, *table.shape[1:]))  # of nothing nothing follows
    return np.concatenate([table, more]).reshape(-1, length * table.shape[1], table.shape[2])


class _Fit(NamedTuple):
    """One hypothesis, or several at once, where changes have about one size.

    `changes` and `deviations` are those at the end, of the shape (hypotheses,).
    """

    evidence: float
    changes: Array
    deviations: Array
    left: float
    share: float


def _compared(
    own: Sequence[Hypothesis], alone: Sequence[Sequence[_Fit]], every: Sequence[_Fit]
) -> Explained:
    """Each hypothesis of a fault by itself, and all at once: one as probable as the other."""
    tops = [max(fits, key=lambda f: f.evidence) for fits in alone]
    best = max(range(len(own)), key=lambda j: tops[j].evidence)
    fits = [f for fits in (*alone, every) for f in fits]
    top = max(fits, key=lambda f: f.evidence)
    hypothesis, chosen = own[best], tops[best]
    change, deviation = (float(x[0]) * hypothesis.usual
                         for x in (chosen.changes, chosen.deviations))  # fmt: skip
    return Explained(
        hypothesis.fault, _mean(fits), hypothesis, change, deviation, top.left, share=top.share
    )


def _mean(fits: Sequence[_Fit]) -> float:
    """The evidence of something that fits in one of several ways, all as probable before."""
    top = max(f.evidence for f in fits)
    weights = sum(math.exp(max(f.evidence - top, -700.0)) for f in fits)
    return top + math.log(weights / len(fits))


def _fits(known: Array, seen: Array, own: Sequence[int]) -> list[_Fit]:
    """Evidence for changes with a normal prior that is correlated in time, for each of the scales.

    By least squares: what changes explain is a part of what was seen, which no rounding makes
    larger than that. So no fault gains by more than half the misfit of what it moves.
    """
    rest, size, chunks = len(known), len(own), len(seen)
    part = _triangle(seen[:, :, [*range(rest), *[rest + j for j in own], -1]])
    steps = np.abs(np.subtract.outer(np.arange(chunks), np.arange(chunks)))
    spread = np.kron(np.linalg.cholesky(_KEEP**steps), np.eye(size))
    moved = part[:, :, rest:-1] @ spread.reshape(chunks, size, -1)
    table = np.concatenate([part[:, :, :rest], moved, part[:, :, -1:]], axis=2)
    before = np.insert(known, [rest] * (chunks * size), 0.0, axis=1)
    # The triangle of all, less that of the healthy machine: what only a fault explains.
    left = _triangle(np.vstack([before, table.reshape(-1, table.shape[2])]))[rest:, rest:]
    return _scaled(left, spread[-size:])


def _instead(hypothesis: Hypothesis, known: Array, told: Array, other: Array) -> Explained:
    """A hypothesis without a size: the machine is well if residuals are told what it says.

    `told` and `other` are what was seen as it was told and as it should have been told, each with
    the same parameters off within their tolerances.
    """
    rest = len(known)
    before, after = (
        _triangle(np.vstack([known, table.reshape(-1, rest + 1)]))
        for table in (told[:, :, [*range(rest), -1]], other)
    )
    misfit, left = (float(np.square(root[rest:, rest]).sum()) for root in (before, after))
    size, others = (np.log(np.abs(np.diagonal(root)[:rest])).sum() for root in (before, after))
    evidence = 0.5 * (misfit - left) + float(size - others)
    share = 1.0 - left / misfit if misfit > 0 else 0.0
    return Explained(hypothesis.fault, evidence, hypothesis, 1.0, 0.0, left, share=share)


def _either(ways: Sequence[Explained]) -> Explained:
    """A fault that is wrong by a size or held at a position: one as probable as the other."""
    top = max(ways, key=lambda one: one.evidence)
    weights = sum(math.exp(max(one.evidence - top.evidence, -700.0)) for one in ways)
    return top._replace(evidence=top.evidence + math.log(weights / len(ways)))


def _scaled(left: Array, last: Array) -> list[_Fit]:
    """From what is left to explain, by one deviation of each change, for each of the scales.

    `last` makes of the changes those of each hypothesis at the end: (hypotheses, changes).
    """
    count = left.shape[1] - 1
    scales = np.array(_SCALES)[:, None, None]
    moved, seen = scales * left[:, :-1], np.tile(left[:, -1:], (len(_SCALES), 1, 1))
    ones = np.tile(np.eye(count, count + 1), (len(_SCALES), 1, 1))
    table = np.concatenate([np.concatenate([moved, seen], axis=2), ones], axis=1)
    root = _triangle(table)[:, :count]
    root, part = root[:, :, :-1], root[:, :, -1:]
    changes = np.linalg.solve(root, part)
    ends = scales * last.T
    spread = np.linalg.solve(root.transpose(0, 2, 1), ends)
    size = np.abs(np.diagonal(root, axis1=1, axis2=2))
    misfit = float(np.square(left[:, -1]).sum())
    rest = np.square(seen - moved @ changes).sum(axis=(1, 2))
    evidence = 0.5 * np.square(part).sum(axis=(1, 2)) - np.log(size).sum(axis=1)
    change = (ends * changes).sum(axis=1)
    deviation = np.sqrt(np.square(spread).sum(axis=1))
    share = 1.0 - rest / misfit if misfit > 0 else np.zeros(len(_SCALES))
    found = zip(evidence.tolist(), change, deviation, rest.tolist(), share.tolist(), strict=True)
    return [_Fit(*numbers) for numbers in found]


def probabilities(found: Sequence[Explained]) -> dict[str, float]:
    """How probable each fault is, all equally probable before.

    They add up to 1, or are all 0 where each of them is impossible.
    """
    top = max((e.evidence for e in found), default=-math.inf)
    if top == -math.inf:
        return {e.fault: 0.0 for e in found}
    weight = {e.fault: math.exp(max(e.evidence - top, -700.0)) for e in found}
    total = sum(weight.values()) or 1.0
    return {fault: w / total for fault, w in weight.items()}
