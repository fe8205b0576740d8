"""Which fault it is, by magnitude: every candidate explains the residuals, better or worse.

Residuals are r(t) = sum_k s_k(t) d_k + s_j(t) c_j(t) + noise, with the sensitivities s through the
same filter. The d are what parameters are off by within their tolerances, constant and normal with
the deviation of their tolerance; the change c of candidate j stays as it is, grows steadily since
the onset, or is a signal that moves little from one moment to the next, in straight lines between
these (a linear spline). With both integrated out (Gaussian evidence; MacKay, 1992), candidates are
compared by how probable they make what was seen. A residual that a fault would have to move and
that did not speaks against it by as much as it would have moved, and no more.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from functools import cached_property
from itertools import accumulate, chain
from types import MappingProxyType

import numpy as np
import numpy.typing as npt

from bondgraph.runtime.diagnosis.history import History, triangle
from bondgraph.runtime.diagnosis.hypotheses import COUNT, Hypothesis
from bondgraph.runtime.diagnosis.model_error import SHARE, shares, unroot
from bondgraph.runtime.diagnosis.rows import CORRELATED
from bondgraph.runtime.diagnosis.shared_noise import Shared
from bondgraph.runtime.log import Array, Mask
from bondgraph.text.tuples import NamedTuple

#: Of the usual change: how large a fault is, nobody knows. Close together, so that no fault is
#: better off than another for being just as large as one of them. A wire that breaks is a thousand
#: times its resistance.
_SCALES = tuple(10.0 ** (k / 4.0) for k in range(-16, 17))
_KEEP = 0.95  # correlation of a fault's change between the ends of a chunk
_CHUNK = 4  # rows in which the change is taken as a straight line, at least
_PARTS = 15  # chunks at most
_SAME = 1e-6  # logarithm of a probability: a smaller difference is rounding
#: How much rarer two faults at once are than one of them, and what acts is where it was than off.
RARER = math.log(1000.0)
BEHIND = 30.0  #: evidence that a fault may lack and still be worth another onset or size
FLAT = 0.01  #: evidence that is none: a size does no more than it does as a tangent
_AT_ONCE = 2**20  # numbers that sets of hypotheses take side by side


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
    """How well two faults at once explain what was seen, each in one way; see `Explained`.

    Whether it is two, `evidence` says and what is `left`: which two, the evidence of the `whole`,
    with how they set in.
    """

    hypotheses: tuple[Hypothesis, Hypothesis]
    evidence: float
    changes: tuple[float, float]
    left: float = 0.0
    values: int = 1
    whole: float = 0.0


class Rows(NamedTuple):
    """Residuals at moments far enough apart for their noise to be taken as independent.

    Value and weight (1/variance, 0 where not valid) have the shape (rows, residuals). `rest` are
    the slopes by the parameters with a tolerance, which have been off for ever, `slopes` those by
    the hypotheses, which hold since the onset: (rows, parameters or hypotheses, residuals). `alone`
    are values that share no noise with those before them, as others do (`CORRELATED`), `shared` is
    the noise that residuals share.
    """

    value: Array
    weight: Array
    rest: Array
    slopes: Array
    alone: Mask | None = None
    shared: Shared | None = None

    @property
    def values(self) -> int:
        """How many values there are, such as share their noise with the next ones."""
        known = self.weight > 0
        alone = 0 if self.alone is None else int((known & self.alone).sum())
        return round(int(known.sum()) + (CORRELATED - 1.0) * alone)


def inverse(weight: Array) -> Array:
    """Variances from weights, infinite where there is none."""
    return np.where(weight > 0, 1.0 / np.maximum(weight, 1e-300), math.inf)


class Case(NamedTuple):
    """Hypotheses, and what they do to the rows: slopes, (rows, hypotheses, residuals).

    `others` are the rows as they would be if a hypothesis without a size were told to the
    residuals, by its number.
    """

    hypotheses: Sequence[Hypothesis]
    slopes: Array
    others: Mapping[int, Rows] = MappingProxyType({})


class Evidence:
    """What rows since an onset tell of faults: what is the same for each of them is done once.

    Raises numpy.linalg.LinAlgError where a number is none.
    """

    def __init__(self, rows: Rows, history: History) -> None:
        _finite(*rows[:3])
        self._values = max(1, rows.values)
        self._prior = history.prior
        self._known = _with_errors(history.known(), rows.value.shape[1])
        _finite(self._known)  # products of finite numbers may be too large for one
        self._seen = _Seen(rows, history.prior)
        self._healthy = _Healthy(self._known, self._seen.table)

    def explained(self, cases: Sequence[Case]) -> list[list[Explained]]:
        """How well each fault of each case explains the rows, in the order of the hypotheses."""
        first = list(accumulate([len(case.hypotheses) for case in cases], initial=0))
        faults = [[(case, numbers, start) for numbers in by_fault(case).values()]
                  for case, start in zip(cases, first, strict=False)]  # fmt: skip
        sets = [[start + j for j in own] for case, numbers, start in chain(*faults)
                for own in (*([j] for j in _sized(case, numbers)), _at_once(case, numbers))
                if own]  # fmt: skip
        fits = self._fits(cases, sets)
        return [[self._fault(*one, fits) for one in own] for own in faults]

    def both(self, case: Case, pairs: Sequence[tuple[int, int]]) -> list[ExplainedPair]:
        """How well two hypotheses at once explain the rows, by their numbers, in this order."""
        fits = self._fits([case], pairs)
        found = []
        for pair in pairs:
            own, fit = (case.hypotheses[pair[0]], case.hypotheses[pair[1]]), fits[pair]
            sizes = (fit.changes[fit.top] * [h.usual for h in own]).tolist()
            left = float(fit.left[fit.top]) / self._values
            told = _mean(fit.evidence)
            two = ExplainedPair(own, told, (sizes[0], sizes[1]), left, self._values, told)
            found.append(two)
        return found

    def _fits(
        self, cases: Sequence[Case], sets: Sequence[Sequence[int]]
    ) -> dict[tuple[int, ...], _Fits]:
        """Of sets of hypotheses at once, numbered through all cases."""
        slopes = np.concatenate([case.slopes for case in cases], axis=1)
        _finite(slopes)
        usual = np.array([h.usual for case in cases for h in case.hypotheses])
        moved = self._seen.moved(slopes, usual)
        length = self._seen.length
        return _Unexplained(self._healthy, moved, len(slopes), length).fits(sets)

    def _fault(
        self,
        case: Case,
        numbers: Sequence[int],
        start: int,
        fits: Mapping[tuple[int, ...], _Fits],
    ) -> Explained:
        """One fault, by the numbers of its hypotheses in a case that begins at a number."""
        sized, every = _sized(case, numbers), _at_once(case, numbers)
        chances = [self._instead(case.hypotheses[j], case.others[j])
                   for j in numbers if j in case.others]  # fmt: skip
        if sized:
            one = [fits[start + j,] for j in sized]
            whole = fits[tuple(start + j for j in every)] if every else None
            chances.insert(0, _compared([case.hypotheses[j] for j in sized], one, whole))
        best = _either(chances)
        return best._replace(left=best.left / self._values, values=self._values)

    def _instead(self, hypothesis: Hypothesis, other: Rows) -> Explained:
        """A hypothesis without a size: the machine is well if residuals are told what it says.

        What was seen as it was told and as it should have been told, each with the same parameters
        off within their tolerances. Of both the model is off by a share of what is left, which has
        a spread of its own. That counts for nothing where what acts stays: a reading that jumps
        leaves nothing as well.
        """
        _finite(*other[:3])
        rest = len(self._known)
        seen = _Seen(other, self._prior)
        before, after = self._told, self._whole(seen)
        misfit, left = (float(np.square(root[rest:, rest]).sum()) for root in (before, after))
        size, others = (np.log(np.abs(np.diagonal(r)[:rest])).sum() for r in (before, after))
        evidence = 0.5 * (misfit - left) + float(size - others)
        if not _stays(hypothesis):
            evidence += seen.density - self._seen.density
        share = 1.0 - left / misfit if misfit > 0 else 0.0
        return Explained(hypothesis.fault, evidence, hypothesis, 1.0, 0.0, left, share=share)

    @cached_property
    def _told(self) -> Array:
        return self._whole(self._seen)

    def _whole(self, seen: _Seen) -> Array:
        """The triangle of what was seen and what is known."""
        return triangle(np.vstack([self._known, seen.table.reshape(-1, len(self._known) + 1)]))


def explain(
    rows: Rows,
    hypotheses: Sequence[Hypothesis],
    history: History,
    others: Mapping[int, Rows] = MappingProxyType({}),
) -> list[Explained]:
    """How well each fault explains the rows since one onset: see `Evidence` and `Case`."""
    return Evidence(rows, history).explained([Case(hypotheses, rows.slopes, others)])[0]


def by_fault(case: Case) -> dict[str, list[int]]:
    """The numbers of the hypotheses of each fault."""
    found: dict[str, list[int]] = {}
    for j, hypothesis in enumerate(case.hypotheses):
        found.setdefault(hypothesis.fault, []).append(j)
    return found


def _finite(*tables: Array) -> None:
    """Raises numpy.linalg.LinAlgError where a number is none."""
    if not all(np.isfinite(table).all() for table in tables):
        raise np.linalg.LinAlgError("a residual, a slope or a weight is not finite")


def _with_errors(known: Array, residuals: int) -> Array:
    """The same with an error of each residual that stays, of which nothing is known."""
    count = len(known)
    found = np.zeros((count + residuals, count + residuals + 1))
    found[:count, :count], found[:count, -1] = known[:, :-1], known[:, -1]
    found[count:, count:-1] = np.eye(residuals)
    return found


class _Seen:
    """What was seen and what would move it, whitened: (chunks, moments, columns).

    Columns of the `table` are the parameters with a tolerance, in deviations, the errors of
    residuals that stay, and the residuals. Chunks are full, but the first. `density` is what
    whitening adds to the logarithm of their density, which errors of other sizes do otherwise.
    """

    def __init__(self, rows: Rows, prior: Array) -> None:
        count, residuals = rows.value.shape
        self._noise = np.sqrt(rows.weight)[:, :, None]
        self.length = max(_CHUNK, -(-count // _PARTS))
        own = shares(count, self.length)
        error = SHARE * rows.value[:, :, None]
        ever = math.sqrt(own.ever) * error * np.eye(residuals)
        self._unroot = unroot(self._chunks(error)[..., 0], own)
        self._kin: list[tuple[npt.NDArray[np.intp], Array]] = []
        if rows.shared is not None:
            noise = np.concatenate([np.zeros((-count % self.length, residuals)),
                                    rows.shared.noise * rows.weight])  # fmt: skip
            kept = np.square(np.diagonal(self._unroot, axis1=2, axis2=3)).transpose(0, 2, 1)
            share = noise * kept.reshape(noise.shape)
            self._kin = rows.shared.unroots(share)
        roots = [self._unroot.reshape(-1, *self._unroot.shape[-2:]), *[one for _, one in self._kin]]
        self.density = float(sum(np.log(np.diagonal(r, axis1=1, axis2=2)).sum() for r in roots))
        table = [rows.rest.transpose(0, 2, 1) * prior, ever, rows.value[:, :, None]]
        self.table = self._white(np.concatenate(table, axis=2))

    def moved(self, slopes: Array, usual: Array) -> Array:
        """The same of hypotheses, (rows, hypotheses, residuals), in their usual changes.

        First as what is left of a change that ends with the chunk, and then as one that begins with
        it.
        """
        count, length = len(slopes), self.length
        before = -count % length
        begun = ((np.arange(before, before + count) % length + 1) / length)[:, None, None]
        columns = slopes.transpose(0, 2, 1) * usual
        return self._white(np.concatenate([columns * (1.0 - begun), columns * begun], axis=2))

    def _chunks(self, table: Array) -> Array:
        """A table (rows, residuals, columns) in units of noise, (chunks, rows, residuals, ...)."""
        more = np.zeros((-len(table) % self.length, *table.shape[1:]))
        table = np.concatenate([more, table * self._noise])  # of nothing nothing follows
        return table.reshape(-1, self.length, *table.shape[1:])

    def _white(self, table: Array) -> Array:
        _finite(table)
        white = self._unroot @ self._chunks(table).transpose(0, 2, 1, 3)
        white = white.transpose(0, 2, 1, 3)
        for own, apart in self._kin:
            white[:, :, own] = apart.reshape(*white.shape[:2], *apart.shape[1:]) @ white[:, :, own]
        _finite(white)
        return white.reshape(len(white), -1, table.shape[2])


class _Fits(NamedTuple):
    """Some hypotheses at once, where changes have about one size, for each of the ways.

    These are scales of changes that move, of such that stay and of such that grow. `changes` and
    `deviations` are those at the end, (ways, hypotheses); the rest is (ways,).
    """

    evidence: Array
    changes: Array
    deviations: Array
    left: Array
    share: Array

    @property
    def top(self) -> int:
        """The way that explains most."""
        return int(np.argmax(self.evidence))


def _sized(case: Case, numbers: Sequence[int]) -> list[int]:
    """Those of some hypotheses of a case that have a size."""
    return [j for j in numbers if j not in case.others]


def _at_once(case: Case, numbers: Sequence[int]) -> list[int]:
    """Those of the hypotheses of a fault that act at once, too: an encoder that stands still.

    Not a gain of what is no count: it takes a reading away, and an offset in its place explains
    whatever that is.
    """
    counted = any(case.hypotheses[j].unit == COUNT for j in numbers)
    own = [j for j in _sized(case, numbers) if counted or case.hypotheses[j].kind != "gain"]
    return own if len(own) > 1 else []


def _compared(own: Sequence[Hypothesis], alone: Sequence[_Fits], every: _Fits | None) -> Explained:
    """Each hypothesis of a fault by itself, and some at once: one as probable as the other.

    Of hypotheses that are the same on these rows, as an offset and a gain of what is constant, the
    first one is told.
    """
    ways = [*alone] if every is None else [*alone, every]
    tops = [float(fits.evidence.max()) for fits in alone]
    best = next(j for j, top in enumerate(tops) if top >= max(tops) - _SAME)
    hypothesis, chosen = own[best], alone[best]
    change, deviation = (float(x[chosen.top, 0]) * hypothesis.usual
                         for x in (chosen.changes, chosen.deviations))  # fmt: skip
    most = max(ways, key=lambda fits: float(fits.evidence.max()))
    evidence = _mean(np.concatenate([fits.evidence for fits in ways]))
    left, share = float(most.left[most.top]), float(most.share[most.top])
    return Explained(hypothesis.fault, evidence, hypothesis, change, deviation, left, share=share)


def _mean(evidence: Array) -> float:
    """The evidence of something that fits in one of several ways, all as probable before."""
    top = float(evidence.max())
    return top + math.log(float(np.exp(np.maximum(evidence - top, -700.0)).mean()))


class _Healthy:
    """What the healthy machine explains, and what it leaves unexplained of what was seen.

    The parameters with a tolerance are the same beside each fault: they are taken out of all
    columns once, by orthonormal bases of what they span, in each chunk and then of all chunks
    (Frisch and Waugh, 1933). Of the columns themselves, not of their products: nothing is lost
    where a fault does nearly what a parameter does. What is left of a column is the same rows in
    every chunk, and those that no parameter reaches.
    """

    def __init__(self, known: Array, seen: Array) -> None:
        rest, chunks = len(known), len(seen)
        self.chunks = chunks
        self._basis, root = np.linalg.qr(seen[:, :, :rest])
        self._size = self._basis.shape[2]
        every = np.vstack([known[:, :-1], root.reshape(chunks * self._size, rest)])
        self._shared = np.linalg.qr(every)[0]
        within, moved = self.without(seen[:, :, rest:])
        self.within = within[:, :, 0]
        self.value = moved[:, :, 0].sum(axis=1)
        self.value -= self._shared @ (self._shared[:rest].T @ known[:, -1])
        self.value[:rest] += known[:, -1]

    def without(self, columns: Array) -> tuple[Array, Array]:
        """Of columns what no parameter reaches in a chunk, (chunks, moments, columns).

        And what is left of the rest, (rows, chunks, columns): each chunk moves rows of all.
        """
        chunks, size, rest = self.chunks, self._size, self._shared.shape[1]
        part = self._basis.transpose(0, 2, 1) @ columns
        own = self._shared[rest:].reshape(chunks, size, rest).transpose(0, 2, 1) @ part
        wide = own.transpose(1, 0, 2).reshape(rest, -1)
        moved = -(self._shared @ wide).reshape(len(self._shared), chunks, -1)
        for c in range(chunks):
            moved[rest + c * size :][:size, c] += part[c]
        return columns - self._basis @ part, moved


class _Unexplained:
    """What the healthy machine leaves unexplained of what faults do, beside what was seen.

    That is the rows that `_Healthy` leaves, with a column for each end of a chunk. What grows does
    so since the first of `count` rows: about that much later the filter shows what there is.
    """

    def __init__(self, healthy: _Healthy, faults: Array, count: int, length: int) -> None:
        chunks = healthy.chunks
        self._healthy = healthy
        self._within, moved = healthy.without(faults)
        steps = np.abs(np.subtract.outer(np.arange(chunks + 1), np.arange(chunks + 1)))
        self._spread = np.linalg.cholesky(_KEEP**steps)
        ends = count - length * np.arange(chunks, -1, -1)
        paths = np.stack([np.ones(chunks + 1), (ends - 1) / max(1, count - 1)], axis=1)
        self._paths = np.linalg.solve(self._spread, paths).T[:, :, None]
        ending, begun = np.split(moved.transpose(2, 0, 1), 2)
        self._moved = ending @ self._spread[:-1] + begun @ self._spread[1:]

    def fits(self, sets: Sequence[Sequence[int]]) -> dict[tuple[int, ...], _Fits]:
        """Evidence for the hypotheses of each set at once, by their numbers.

        Their changes have a normal prior, and stay as they are, grow or are correlated in time: one
        as probable as the other. By least squares: what changes explain is a part of what was seen,
        which no rounding makes larger than that. So no fault gains by more than half the misfit of
        what it moves.
        """
        found: dict[tuple[int, ...], _Fits] = {}
        by_size: dict[int, list[tuple[int, ...]]] = {}
        for own in sets:
            by_size.setdefault(len(own), []).append(tuple(own))
        for size, alike in by_size.items():
            chunks, moments, _ = self._within.shape
            rows = len(self._healthy.value)
            numbers = (2 * size + 1) * chunks * (moments + size * chunks + rows)
            at_once = max(1, _AT_ONCE // numbers)
            for start in range(0, len(alike), at_once):
                some = alike[start : start + at_once]
                left = self._left(np.array(some))
                ways = [_scaled(left, np.kron(np.eye(size), self._spread[-1:]))]
                for path in self._paths:
                    every = left[:, :, :-1] @ np.kron(np.eye(size), path)
                    along = triangle(np.concatenate([every, left[:, :, -1:]], axis=2))
                    ways.append(_scaled(along, np.eye(size)))
                all_ = [np.concatenate(own, axis=1) for own in zip(*ways, strict=True)]
                found |= zip(some, [_Fits(*one) for one in zip(*all_, strict=True)], strict=True)
        return found

    def _left(self, sets: npt.NDArray[np.intp]) -> Array:
        """Triangles of what hypotheses do and of what was seen, (sets, changes + 1, changes + 1).

        The changes of a hypothesis stand beside each other, by the ends of chunks.
        """
        (count, size), (every, rows, ends) = sets.shape, self._moved.shape
        chunks = ends - 1
        table = np.zeros((count, rows + 2 * size * chunks + 1, size * ends + 1))
        moved = self._moved[sets].transpose(0, 2, 1, 3)
        table[:, :rows, :-1] = moved.reshape(count, rows, size * ends)
        table[:, :rows, -1] = self._healthy.value
        columns = np.concatenate([sets, sets + every], axis=1)
        within = np.empty((count, *self._within.shape[:2], 2 * size + 1))
        within[..., :-1] = np.moveaxis(self._within[:, :, columns], 2, 0)
        within[..., -1] = self._healthy.within
        within = _orthogonal(within)
        ending, begun = within[..., :-1, :size, None], within[..., :-1, size:-1, None]
        own = ending * self._spread[:-1, None, None] + begun * self._spread[1:, None, None]
        table[:, rows:-1, :-1] = own.reshape(count, 2 * size * chunks, size * ends)
        table[:, rows:-1, -1] = within[..., :-1, -1].reshape(count, 2 * size * chunks)
        table[:, -1, -1] = np.linalg.norm(within[..., -1, -1], axis=1)
        return triangle(table)


def _orthogonal(rows: Array) -> Array:
    """As `_triangle`, of many rows with a few columns (modified Gram and Schmidt; Bjorck, 1967)."""
    rows, columns = rows.copy(), rows.shape[-1]
    root = np.zeros((*rows.shape[:-2], columns, columns))
    for j in range(columns):
        size = np.sqrt(np.einsum("...k,...k", rows[..., j], rows[..., j]))
        root[..., j, j] = size
        unit = rows[..., j] / np.where(size > 0.0, size, 1.0)[..., None]
        for k in range(j + 1, columns):
            along = np.einsum("...k,...k", unit, rows[..., k])
            root[..., j, k] = along
            rows[..., k] -= along[..., None] * unit
    return root


def _either(ways: Sequence[Explained]) -> Explained:
    """A fault that is wrong by a size or held at a position: one as probable as the other.

    What stays where it was has no size, so that behind a single step of a command it would be more
    probable than anything with one: it is taken for that much rarer, and has to show.
    """
    told = [one._replace(evidence=one.evidence - RARER * _stays(one.hypothesis))
            for one in ways]
    top = max(told, key=lambda one: one.evidence)
    weights = sum(math.exp(max(one.evidence - top.evidence, -700.0)) for one in told)
    others = sum(not _stays(one.hypothesis) for one in ways)
    return top._replace(evidence=top.evidence + math.log(weights / max(others, 1)))


def _stays(hypothesis: Hypothesis) -> bool:
    return hypothesis.held is not None and hypothesis.held.stays


def _scaled(left: Array, last: Array) -> tuple[Array, ...]:
    """From what is left to explain, by one deviation of each change, for each of the scales.

    `left` are the triangles of several sets; `last` makes of the changes those of each hypothesis
    at the end: (hypotheses, changes). With singular values a scale is a factor of each.
    """
    moved, seen, over = left[:, :-1, :-1], left[:, :-1, -1:], left[:, -1, -1, None] ** 2
    turned, size, ways = np.linalg.svd(moved)
    along = turned.transpose(0, 2, 1) @ seen
    along = along.transpose(0, 2, 1)  # (sets, scales, changes) from here on
    ends, scales = last @ ways.transpose(0, 2, 1), np.array(_SCALES)[:, None]
    size = size[:, None, :]
    more = np.square(scales * size)
    sure = more / (1.0 + more)
    evidence = 0.5 * (sure * np.square(along) - np.log1p(more)).sum(axis=2)
    changes = (scales**2 * size / (1.0 + more) * along) @ ends.transpose(0, 2, 1)
    variance = (scales**2 / (1.0 + more)) @ np.square(ends).transpose(0, 2, 1)
    misfit = np.square(along).sum(axis=2) + over
    rest = np.square(along / (1.0 + more)).sum(axis=2) + over
    share = 1.0 - rest / np.where(misfit > 0.0, misfit, 1.0)
    share[misfit[:, 0] <= 0.0] = 0.0
    return evidence, changes, np.sqrt(variance), rest, share


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
