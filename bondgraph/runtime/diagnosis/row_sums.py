"""What rows since an onset tell of faults: last samples, or sums of averages where these are surer.

A sensor's noise is in slopes as in residuals, and a change is drawn to where it makes least of it
(attenuation; Fuller, 1987): a tank without an area explains the noise of its level, and a leak
beside it. In averages little is left of noise that is differentiated, and each with so much of
those before it as leaves no memory (see `Lasting`) is what shows that something small stays. What
shows a fault tells it from others, too.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from bondgraph.runtime.diagnosis.model_error import SHARE
from bondgraph.runtime.diagnosis.row_averages import LAGS
from bondgraph.runtime.diagnosis.rows import CORRELATED, Average, Row, weights
from bondgraph.runtime.diagnosis.tuning import Limit
from bondgraph.runtime.log import Array, Mask
from bondgraph.text.tuples import NamedTuple

#: Times the variance of a sum, for the same change, that the one of a last sample has to be: of
#: fast motions, which tell faults apart, an average keeps less.
_SURER = 2.0


class Moves(NamedTuple):
    """Numbers of rows by their last samples, and averages of these rows with LAGS before them.

    Both (rows, ..., residuals): of what is seen, or of what moves it.
    """

    last: Array
    means: Array

    def then(self, other: Moves) -> Moves:
        """The same with further rows behind; what came before these is known."""
        every = zip(self, (other.last, other.means[LAGS:]), strict=True)
        return Moves(*[np.concatenate(both) for both in every])

    @classmethod
    def behind(cls, last: Array, means: Array, rows: int) -> Moves:
        """The last of rows, with the averages before them; where there are none, nothing moved."""
        means = np.concatenate([np.zeros((LAGS, *means.shape[1:])), means])
        return cls(last[len(last) - rows :], means[len(means) - rows - LAGS :])


class Forms(NamedTuple):
    """Which rows tell by sums, (rows, residuals), and with how much of each of the LAGS averages
    before, (rows, LAGS, residuals). The others tell by their last samples."""

    sums: Mask
    before: Array

    def of(self, moves: Moves) -> Array:
        """What rows tell of (rows, n, residuals).

        >>> forms = Forms(np.array([[True], [False]]), np.full((2, LAGS, 1), 0.5))
        >>> moves = Moves(np.full((2, 1, 1), 9.0), np.arange(6.0).reshape(6, 1, 1))
        >>> forms.of(moves).ravel().tolist()  # 4 + (3 + 2 + 1 + 0) / 2, and as it is
        [7.0, 9.0]
        """
        means = moves.means
        found = means[LAGS:].copy()
        for lag in range(LAGS):
            found += self.before[:, None, lag] * means[LAGS - 1 - lag : len(means) - 1 - lag]
        return np.where(self.sums[:, None], found, moves.last)


class Told(NamedTuple):
    """What rows tell in their `forms`: see `Row`, with as many rows first.

    `noise` is a deviation such that `CORRELATED` times its square is the variance of independent
    rows. The `value` is beside the `level` at which residuals stand.
    """

    forms: Forms
    value: Array
    valid: Mask
    bound: Array
    doubt: Array
    rest: Array
    noise: Array
    level: Array

    @property
    def variance(self) -> Array:
        """That of the noise, (rows, residuals), zero where nobody knows it."""
        return np.where(np.isfinite(self.noise), CORRELATED * self.noise**2, 0.0)

    def weights(self, value: Array) -> Array:
        """One over the variance of residuals that have these values, (rows, residuals)."""
        return weights(value, self.valid, self.bound, self.doubt, self.noise)


def told(before: Sequence[Row], rows: Sequence[Row], limits: Sequence[Array]) -> Told:
    """What rows tell that follow those `before`, each with the limits of its residuals.

    These are (residuals, columns of `Limit`).
    """
    limit = Limit(*np.moveaxis(np.array(limits), 2, 0))
    last = Average(*[np.array([getattr(row, name) for row in rows]) for name in Average._fields])
    means = _averages(before[-LAGS:], rows)
    forms = _forms(means, limit)
    value, bound, doubt = (
        forms.of(Moves(getattr(last, name)[:, None], getattr(means, name)[:, None]))[:, 0]
        for name in ("value", "bound", "doubt")
    )
    times = 1.0 + forms.before.sum(axis=1)
    mean = np.array([np.broadcast_to(row.mean, row.value.shape) for row in rows])
    value -= np.where(forms.sums, limit.stands * times, 0.0)
    level = np.where(forms.sums, (mean + limit.stands) * times, mean)
    noise = np.where(forms.sums, limit.unit / math.sqrt(CORRELATED), limit.sigma)
    value = np.where(last.valid, value, 0.0)
    rest = forms.of(Moves(last.slopes, means.slopes))
    return Told(forms, value, last.valid, bound, doubt, rest, noise, level)


def _averages(before: Sequence[Row], rows: Sequence[Row]) -> Average:
    """The averages of LAGS rows before and of these, with as many rows first; not valid where there
    are none."""
    first = rows[0]
    none = Average(*[np.zeros_like(getattr(first, name)) for name in Average._fields])
    found = [none if row.average is None else row.average for row in (*before, *rows)]
    found = [none] * (LAGS - len(before)) + found
    return Average(*[np.array(x) for x in zip(*found, strict=True)])


def _forms(means: Average, limit: Limit) -> Forms:
    """A sum where its averages and their noise are known, of a residual where sums are surer.

    That is beside what a model is off by: where a fault does more than noise, an average tells no
    more, and less of fast motions.
    """
    before = np.stack([limit.before1, limit.before2, limit.before3, limit.before4], axis=1)
    count, valid = len(before), means.valid
    lags = np.stack([valid[LAGS - 1 - k :][:count] for k in range(LAGS)], axis=1)
    known = valid[LAGS:] & (limit.unit > 0.0) & (lags | (before == 0.0)).all(axis=1)
    square = np.where(known, means.value[LAGS:], 0.0) ** 2
    error = SHARE**2 * square.sum(axis=0) / np.maximum(known.sum(axis=0), 1)
    sums = (limit.unit / (1.0 + before.sum(axis=1))) ** 2
    known &= _SURER * (sums + error) < CORRELATED * limit.sigma**2 + error
    return Forms(known, np.where(known[:, None], before, 0.0))
