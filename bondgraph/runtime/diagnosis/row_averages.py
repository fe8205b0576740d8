"""How averages of rows add up while all is well: what one row owes the rows before, and the rest.

A derivative of noise, as most residuals have one, is loud from row to row and gone in the long run:
what it adds in one row it takes off in the next. The average of a row holds every sample of it, and
what a row shows is seen better beside the rows before it.
"""

from __future__ import annotations

import math
from itertools import chain, combinations

import numpy as np

from bondgraph.runtime.diagnosis.noise import noise, within
from bondgraph.runtime.log import Array
from bondgraph.text.tuples import NamedTuple

LAGS = 4  #: rows before one that are added to it at most
_EACH = 6  # rows that there have to be for each of its weights
#: Of white noise behind a filter of third order: the sum of the correlations between averages of
#: three time constants. What a residual differentiates has less.
WHITE = 2.135
_SURE = 2.0  # deviations of a correlation that few rows show


class Lasting(NamedTuple):
    """Of the averages of one residual: they stand at `mean`, in its unit.

    An average with so much of those before it as the `weights` say (LAGS,) has no memory in which
    one row takes off what another has added. `unit` is the deviation with which such sums add up: n
    of them have the variance n unit^2.
    """

    mean: float
    weights: Array
    unit: float


class Before:
    """The averages of the last rows, of which some is added to the next (see `Lasting`)."""

    def __init__(self, columns: int, residuals: int) -> None:
        self._last = np.full((LAGS, columns, residuals), math.nan)  # the last first

    def added(self, own: Array, limits: Array) -> Array:
        """Averages (columns, residuals) with so much of those before as the columns of `Limit` say.

        NaN where one of them is not known.
        """
        found = added(own, self._last, limits)
        self._last = np.concatenate([own[None], self._last[:-1]])
        return found


def added(own: Array, last: Array, limits: Array) -> Array:
    """Averages (columns, residuals) with so much of the `last` before them, (LAGS, columns,
    residuals) and the last first, as the columns of `Limit` say."""
    weights = limits[:, None, 8 : 8 + LAGS].T
    return np.asarray(own + np.where(weights > 0.0, weights * last, 0.0).sum(axis=0))


def lasting(values: Array, owed: float, centred: bool, kappa: float) -> Lasting:
    """What averages (n,) of rows of a healthy residual tell, NaN where it had no value.

    Weights are positive: memory that is positive counts as in `noise`, and has room as there.
    They are as many as Schwarz's criterion prefers; fewer than 24 rows tell no unit. `owed` and
    `centred` as there, `kappa` is how many deviations matter: few rows tell them badly.

    >>> draw = np.random.default_rng(1).standard_normal(2001)
    >>> white = lasting(draw, 0.0, True, 4.0)
    >>> f"{white.unit:.1f}"
    '1.1'
    >>> stepped = lasting(np.diff(draw), 0.0, True, 4.0)
    >>> f"{stepped.unit / (1.0 + stepped.weights.sum()):.1f}"
    '0.4'
    """
    known = within(values[:, None])[:, 0]
    count = int(known.sum())
    mean = float(values[known].mean()) if centred and count else 0.0
    if count < LAGS * _EACH:
        return Lasting(mean, np.zeros(LAGS), math.inf)
    rest = np.where(known, values - mean, math.nan)
    weights = _weights(rest)
    added = with_before(rest, weights)
    both = np.isfinite(added[1:]) & np.isfinite(added[:-1])
    pairs, size = int(both.sum()), float(np.nansum(np.square(added)))
    if not (pairs and size > 0.0):
        return Lasting(mean, weights, math.inf)
    next_ = float(added[1:][both] @ added[:-1][both]) / size
    most = min(next_ + _SURE / math.sqrt(pairs), 0.9)
    least = min(max((1.0 + most) / (1.0 - most), 1.0), WHITE)
    found = noise(added, owed, centred, least)
    return Lasting(mean, weights, found.foreseen(kappa) * math.sqrt(found.memory))


def with_before(values: Array, weights: Array) -> Array:
    """Each of values (n,) with the ones before it by weight; NaN where one of these is missing."""
    found = values.copy()
    for k, weight in enumerate(weights.tolist(), 1):
        if weight:
            found[k:] += weight * values[:-k]
            found[:k] = math.nan
    return found


def _weights(rest: Array) -> Array:
    """By how much the rows before make the next one smaller the other way round, (LAGS,)."""
    best = np.zeros(LAGS)
    lags = np.stack([rest[LAGS - k : len(rest) - k] for k in range(LAGS + 1)]) if (
        len(rest) > LAGS) else np.empty((LAGS + 1, 0))  # fmt: skip
    lags = lags[:, np.isfinite(lags).all(axis=0)]
    count = lags.shape[1]
    lags = lags / max(np.abs(lags).max(initial=0.0), 1e-300)  # no square of it is infinite
    products = lags @ lags.T
    if not products[0, 0] > 0.0:
        return best
    least = 0.0
    for order in range(1, min(LAGS, count // _EACH) + 1):
        found, left = _positive(products[: order + 1, : order + 1] / products[0, 0])
        cost = count * math.log(max(left, 1e-12)) + order * math.log(count)
        if cost < least:
            best, least = np.append(found, np.zeros(LAGS - order)), cost
    return best


def _positive(products: Array) -> tuple[Array, float]:
    """The weights of columns 1.. that take most off column 0, none negative, and what they leave.

    Of the `products` of the columns with each other. It is the best of all choices of columns whose
    weights by least squares are positive: those that are not zero at the optimum are such a choice
    (Lawson and Hanson, 1974, chapter 23). For four columns this is quicker than to load a solver.
    """
    most = len(products) - 1
    best, least = np.zeros(most), float(products[0, 0])
    for chosen in chain.from_iterable(combinations(range(1, most + 1), n + 1) for n in range(most)):
        own = list(chosen)
        weights = -np.linalg.lstsq(products[np.ix_(own, own)], products[own, 0], rcond=None)[0]
        left = float(products[0, 0] + products[0, own] @ weights)
        if left < least and (weights > 0.0).all():
            best, least = np.zeros(most), left
            best[np.array(own) - 1] = weights
    return best, least
