"""What healthy operation has told of a machine, and what is expected of it by that."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from bondgraph.runtime.diagnosis.noise import COVERED, left_for_drift
from bondgraph.runtime.diagnosis.rows import Row
from bondgraph.runtime.diagnosis.shared_noise import SharedNoise
from bondgraph.runtime.diagnosis.tuning import UNKNOWN
from bondgraph.runtime.log import Array, Mask

HEALTHY = 5  # rows that have to be as usual behind one before it counts as healthy
_KEPT = 1.0 - 1.0 / 1000.0  # of what is known, with each further row
_DRIFTS = 100  # rows in which a healthy parameter drifts by `COVERED` of its deviation
_SMALL = 8192  # numbers in a matrix that BLAS does not share out among threads


class History:
    """What healthy operation has told of parameters that are off within their tolerances.

    `prior` are the standard deviations of the parameters, and `shared` is what residuals share of
    their noise, if that is learned. What is known is kept as a triangle and what it should give,
    `root` = (R, q), for parameters z in deviations: the misfit of all rows that were added is
    |R z - q|^2, forgotten slowly. Sums of squares would lose half of the digits, and encoders
    beside tolerances of a millionth need all of them (Bierman, 1977).
    """

    def __init__(self, prior: Array, shared: SharedNoise | None = None) -> None:
        self.prior, self.shared = prior, shared
        self.root = np.zeros((len(prior), len(prior) + 1))
        self._known: tuple[Array, Array] | None = None  # of which root, and what is known by it

    def add(self, value: Array, weight: Array, slopes: Array, keep: float = _KEPT) -> None:
        """One row: residuals, their weights, slopes of the shape (parameters, residuals)."""
        root = np.sqrt(weight)
        row = np.column_stack([(slopes * root).T * self.prior, root * value])
        self.root = triangle(np.vstack([math.sqrt(keep) * self.root, row]))[: len(self.root)]

    def anew(self, gone: Sequence[int], keep: Sequence[int], more: Sequence[float]) -> History:
        """The same once the parameters `gone` have another value, unknown within their prior.

        What the others owe them is integrated out. Then only the parameters `keep` are kept, and
        such with the deviations `more` come behind them.
        """
        own, kept = list(gone), list(keep)
        rest = [k for k in range(len(self.prior)) if k not in own]
        order = [*own, *rest, -1]
        owed = np.vstack([self.root[:, order], np.eye(len(own), len(order))])
        left = triangle(owed)[len(own) : len(self.prior), len(own) :]
        prior = np.concatenate([self.prior[kept], np.array(more, dtype=float)])
        found = History(prior, self.shared)
        for at, k in enumerate(kept):
            if k in rest:
                found.root[: len(left), at] = left[:, rest.index(k)]
        found.root[: len(left), -1] = left[:, -1]
        return found

    def ordered(self, order: Sequence[int]) -> History:
        """The same with the parameters in another order."""
        found = History(self.prior[list(order)], self.shared)
        found.root = self.root[:, [*order, -1]]
        return found

    def narrow(self, deviations: Array) -> None:
        """Take the last parameters for known so well before, around what they are taken for."""
        start = len(self.prior) - len(deviations)
        scale = np.append(np.ones(start), deviations / self.prior[start:])
        self.prior = self.prior * scale
        self.root = self.root * np.append(scale, 1.0)

    def widen(self, numbers: Sequence[int], deviations: Array) -> None:
        """Take some parameters of which nothing was to be known, for off by these deviations."""
        prior = self.prior.copy()
        prior[list(numbers)] = deviations
        self.prior = prior

    def drifted(self, numbers: Sequence[int], rows: float = _DRIFTS) -> History:
        """The same so many rows later: some parameters have drifted as a healthy machine's may.

        They walk at random (the prediction of a square-root filter; Bierman, 1977), in a hundred
        rows by a tenth of their deviation, as sums leave room for; none out of its tolerance.

        >>> history = History(np.array([3.0]))
        >>> history.add(np.array([1.0]), np.array([1e6]), np.array([[1.0]]))
        >>> later = history.drifted([0], rows=25)  # by half of a tenth of 3
        >>> [round(float(one.expected(np.eye(1))[1][0]) ** 0.5, 3) for one in (history, later)]
        [0.001, 0.15]
        """
        own = list(numbers)
        moves = COVERED * math.sqrt(rows / _DRIFTS)
        first = np.eye(len(own), len(own) + self.root.shape[1]) / moves
        moved = np.vstack([first, np.hstack([-self.root[:, own], self.root])])
        found = History(self.prior, self.shared)
        found.root = triangle(moved)[len(own) :, len(own) :]
        return found

    def last(self, count: int) -> tuple[Array, Array]:
        """By how much the last parameters are off, most probably, and the covariance of that."""
        start = len(self.prior) - count
        known = self.known()[start:, start:]
        moved = self.prior[start:, None] * np.linalg.inv(known[:, :-1])
        return moved @ known[:, -1], moved @ moved.T

    def known(self) -> Array:
        """Prior and history together, in the form of `root`; the same while nothing is added."""
        if self._known is None or self._known[0] is not self.root:
            count = len(self.root)
            known = triangle(np.vstack([np.eye(count, count + 1), self.root]))[:count]
            self._known = self.root, known
        return self._known[1]

    def fit_within(self) -> Array:
        """By how much the parameters are off, most probably, none by more than its tolerance."""
        known = self.known()
        return np.asarray(self.prior * within_tolerance(known[:, :-1], known[:, -1]))

    def expected(self, slopes: Array) -> tuple[Array, Array]:
        """The residuals of the healthy machine as far as it is known, and their variances."""
        known = self.known()
        moved = np.linalg.solve(known[:, :-1].T, slopes * self.prior[:, None])
        return moved.T @ known[:, -1], np.square(moved).sum(axis=0)

    def innovation(self, row: Row, sure: Mask) -> Row:
        """A row less what is expected; its bound is how far off a healthy machine may be from that.

        That is what is not known of its parameters yet, what they may drift by, and what no
        parameter does. A residual that is not `sure` may be anywhere within its tolerances.
        """
        own, count = row.average, len(row.value)
        slopes = row.slopes if own is None else np.concatenate([row.slopes, own.slopes], axis=1)
        expected, variance = self.expected(slopes)
        sure = sure & np.isfinite(expected[:count]) & np.isfinite(variance[:count])
        unknown = UNKNOWN * np.sqrt(np.where(np.isfinite(variance), variance, 0.0))
        bound = left_for_drift(row.bound, row.doubt) + unknown[:count]
        if own is not None:
            less = np.where(sure & own.valid, expected[count:], 0.0)
            most = left_for_drift(own.bound, own.doubt) + unknown[count:]
            own = own._replace(value=own.value - less, bound=np.where(sure, most, own.bound))
        return row._replace(
            value=np.where(sure, row.value - expected[:count], row.value),
            bound=np.where(sure, bound, row.bound),
            average=own,
        )


def within_tolerance(root: Array, wanted: Array) -> Array:
    """The parameters, in deviations, that fit best without one being out of its tolerance.

    The least |root z - wanted| in that box. Where two parameters make up for each other, one that
    is held at its tolerance may take the other back from its own, to either side.

    >>> root, wanted = np.array([[1.0, 0.5], [0.0, 1.0]]), np.array([4.0, 1.0])
    >>> within_tolerance(root, wanted).round(2).tolist()
    [1.73, 1.71]
    """
    found = np.linalg.solve(root, wanted)
    most = math.sqrt(3.0)
    if (np.abs(found) <= most).all():
        return np.asarray(found)
    from scipy.optimize import lsq_linear

    many = 10 * len(found)  # each may be held and let go again some times
    return np.asarray(lsq_linear(root, wanted, (-most, most), method="bvls", max_iter=many).x)


def triangle(rows: Array) -> Array:
    """A triangle of the same sums of squares and products as these rows; of each of a stack.

    Of many rows in pieces (Demmel et al., 2012): small ones are not shared out among threads, which
    would wait for each other longer than they work.
    """
    *stack, count, columns = rows.shape
    piece = max(2 * columns, _SMALL // columns)
    if count > piece:
        more = np.zeros((*stack, -count % piece, columns))
        pieces = np.concatenate([rows, more], axis=-2).reshape(*stack, -1, piece, columns)
        return triangle(triangle(pieces).reshape(*stack, -1, columns))
    return np.asarray(np.linalg.qr(rows, mode="r"))
