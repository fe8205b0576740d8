"""Series without memory: the filter that takes it off, and the sum of what keeps some."""

from __future__ import annotations

import math

import numpy as np

from bondgraph.runtime.log import Array

LAGS = 8  #: rows that a row of noise is predicted from, so that what is left has no memory


def rms(values: Array) -> Array:
    """The root mean square of each column, 0 where there is nothing."""
    there = np.isfinite(values)
    total = np.where(there, values, 0.0) ** 2
    return np.asarray(np.sqrt(total.sum(axis=-2) / np.maximum(there.sum(axis=-2), 1)))


def whitening(values: Array) -> Array:
    """The filter (1, -a1, -a2, ...) that leaves of a series (n,) what its past does not predict.

    An autoregression by least squares; NaN may be anywhere.

    >>> draw, x = np.random.default_rng(1).standard_normal(5000), np.zeros(5000)
    >>> for k in range(1, 5000):
    ...     x[k] = 0.8 * x[k - 1] + draw[k]
    >>> [bool(abs(a - b) < 0.05) for a, b in zip(whitening(x)[:3], (1.0, -0.8, 0.0))]
    [True, True, True]
    """
    lags = np.stack([values[LAGS - k : len(values) - k] for k in range(LAGS + 1)])
    lags = lags[:, np.isfinite(lags).all(axis=0)]
    found = np.zeros(LAGS + 1)
    found[0] = 1.0
    if lags.shape[1] > 4 * LAGS and lags.any():
        found[1:] = -np.linalg.lstsq(lags[1:].T, lags[0], rcond=1e-7)[0]
    return found


def filtered(values: Array, filters: Array) -> Array:
    """Series (..., rows, residuals) through a filter (lags, residuals) each; NaN at the start.

    And in each row that reads one without a number, whatever its share.

    >>> one = filtered(np.arange(10.0)[:, None], np.eye(LAGS + 1)[:, :1])
    >>> one[:, 0].tolist()[-2:]
    [8.0, 9.0]
    """
    rows = values.shape[-2]
    found: Array = values * filters[0]
    for k in range(1, LAGS + 1):
        if filters[k].any():
            found[..., k:, :] += filters[k] * values[..., : rows - k, :]
    lost = np.isnan(values)
    if lost.any():
        for k in range(1, LAGS + 1):
            found[..., k:, :][lost[..., : rows - k, :]] = np.nan
    found[..., :LAGS, :] = np.nan
    return found


def few_rows(rows: int) -> float:
    """By how much an interval of 95 % has to be wider since `newey_west` is itself of few rows.

    Critical values for Bartlett's weights over a share b of the rows (Kiefer and Vogelsang 2005).

    >>> round(few_rows(100), 3), round(few_rows(10_000), 3)
    (1.092, 1.008)
    """
    b = _most(rows) / rows
    return (1.96 + 2.9694 * b + 0.416 * b**2 - 0.5324 * b**3) / 1.96


def _most(rows: int) -> int:
    """The lags beyond which correlations are taken for none."""
    return math.ceil(math.sqrt(rows) / 2) + 1


def newey_west(scores: Array) -> Array:
    """The covariance (p, p) of the sum of correlated rows (n, p) (Newey and West 1987)."""
    own = scores - scores.mean(axis=0)
    found = own.T @ own
    most = _most(len(own))
    for lag in range(1, min(most, len(own))):
        part = own[lag:].T @ own[:-lag]
        found += (1.0 - lag / most) * (part + part.T)
    return np.asarray(found)


def newey_west_variances(scores: Array) -> Array:
    """The diagonal (p,) of `newey_west`, without all else."""
    own = scores - scores.mean(axis=0)
    found = (own**2).sum(axis=0)
    most = _most(len(own))
    for lag in range(1, min(most, len(own))):
        found += 2.0 * (1.0 - lag / most) * (own[lag:] * own[:-lag]).sum(axis=0)
    return np.asarray(found)
