"""The noise of a healthy residual: where it stands, how large, how long its memory, how sure."""

from __future__ import annotations

import math

import numpy as np

from bondgraph.runtime.log import Array, Mask
from bondgraph.text.tuples import NamedTuple

_LONGEST = 8  # rows that an autoregression looks back
_EACH = 6  # rows that there have to be for each of its numbers
#: Of white noise behind a filter of third order, three time constants apart (Matern): the sum of
#: its correlations and that of their squares. No noise of a residual has less of a memory.
FILTERED, _SQUARED = 2.0, 1.25
_SLOW = 5  # rows in the mean of which noise is small
COVERED = 0.1  #: of what parameters may do: what is left for drift once a machine is known
_FAR = 6.0 * 1.4826  # times the median distance from the median: six normal deviations
_NORMAL = 1.4826  # deviation of normal numbers, over the median of their sizes
CAREFUL = 2.0  #: times the deviation that steps show, where they are no noise
_LEAST = 5.0  # degrees of freedom, of however few rows


def left_for_drift(bound: Array, doubt: Array) -> Array:
    """What residuals of a known machine may be off by, in their units, (n, residuals) or so.

    `bound` are adaptive thresholds, `doubt` is the part of them that no parameter explains.

    >>> left_for_drift(np.array([1.0]), np.array([0.2])).round(2).tolist()
    [0.28]
    """
    return COVERED * (bound - doubt) + doubt


class Noise(NamedTuple):
    """Of one residual, from so many healthy rows that `freedom` of them are independent.

    `mean` and `sigma`, its standard deviation, in the unit of the residual. `memory` is the sum of
    the correlations between a row and all others: the mean of n rows has a variance of
    sigma^2 memory / n.
    """

    mean: float
    sigma: float
    memory: float
    freedom: float
    rows: int

    def foreseen(self, kappa: float) -> float:
        """The deviation to be taken for a level that normal noise is above kappa sigma.

        With few rows neither mean nor deviation is known, and the next row is Student's t times
        the deviation: for the same probability of being above, it takes more of it.

        >>> round(Noise(0.0, 1.0, 2.0, 6.0, 10).foreseen(4.0), 2)
        2.7
        >>> round(Noise(0.0, 1.0, 2.0, 400.0, 500).foreseen(4.0), 2)
        1.01
        """
        from scipy.special import ndtr, stdtrit

        tail = max(float(ndtr(-kappa)), 1e-300)
        wider = -float(stdtrit(self.freedom, tail)) / kappa
        return self.sigma * wider * math.sqrt(1.0 + self.memory / max(self.rows, 1))


def noise(
    values: Array, owed: float = 0.0, centred: bool = True, least: float = FILTERED
) -> Noise:
    """What rows (n,) of a healthy residual tell, NaN where it had no value.

    Their memory is that of an autoregression, of an order by the criterion of Schwarz (1978) with
    coefficients by Yule and Walker: white rows are a special case. What few rows show of a slow
    motion is too little: the deviation is corrected for the mean that was taken from them. Rows
    that are `within` no limits, as of a filter that settles, do not count. `owed` are degrees of
    freedom that were spent on the values before; where they are not `centred`, zero is the mean.
    Their memory is `least` that of white noise behind the filter.

    >>> white = np.random.default_rng(1).normal(3.0, 1.0, 2000)
    >>> found = noise(white)
    >>> f"{found.mean:.1f} {found.sigma:.1f} {found.memory:.1f}"
    '3.0 1.0 2.0'
    """
    known = within(values[:, None])[:, 0]
    count = int(known.sum())
    if not count:
        return Noise(0.0, math.inf, FILTERED, _LEAST, 0)
    mean = float(values[known].mean()) if centred else 0.0
    rest = np.where(known, values - mean, 0.0)
    variance = float(np.square(rest).sum()) / count
    if not variance > 0.0:
        return Noise(mean, 0.0, FILTERED, _LEAST, count)
    coefficients = _autoregression(rest, known, variance)
    memory, squared = _memories(coefficients, least)
    lost = owed + (memory if centred else 0.0)
    spent = min(lost / count, 0.75)  # what mean and parameters take of the variance
    freedom = max(count / squared - owed - centred, _LEAST)
    return Noise(mean, math.sqrt(variance / (1.0 - spent)), memory, freedom, count)


def within(values: Array) -> Mask:
    """Which of values (n, residuals) are no more than six robust deviations off their median.

    >>> within(np.array([[0.0], [1.0], [-1.0], [0.5], [99.0], [math.nan]]))[:, 0].tolist()
    [True, True, True, True, False, False]
    """
    found = np.isfinite(values)
    for k, column in enumerate(values.T):
        known = column[found[:, k]]
        if len(known):
            off = np.abs(column - np.median(known))
            most = _FAR * float(np.median(off[found[:, k]]))
            found[:, k] &= off <= most if most > 0.0 else True
    return found


def stepped(values: Array) -> float:
    """The deviation of white noise whose neighbours differ as these do, in the median."""
    steps = np.abs(np.diff(values))
    steps = steps[np.isfinite(steps)]
    return _NORMAL * float(np.median(steps)) / math.sqrt(2.0) if len(steps) else 0.0


def uncovered(rest: Array, bound: Array) -> Array:
    """Rows (n, residuals) less what is slow in them and small beside what tolerances allow.

    Parameters that drift, and what is not linear in them, move a healthy residual slowly by some
    share of its adaptive threshold, which has room for that. A residual without one loses nothing.
    """
    known = np.isfinite(rest)
    total, count = (
        np.lib.stride_tricks.sliding_window_view(
            np.pad(table, ((_SLOW // 2, _SLOW // 2), (0, 0))), _SLOW, axis=0
        ).sum(axis=2)
        for table in (np.where(known, rest, 0.0), known.astype(float))
    )
    most = COVERED * bound
    return np.asarray(rest - np.clip(total / np.maximum(count, 1.0), -most, most))


def _autoregression(rest: Array, known: Mask, variance: float) -> Array:
    """The coefficients of the order that Schwarz's criterion prefers (Levinson's recursion)."""
    count = int(known.sum())
    most = min(_LONGEST, count // _EACH, len(rest) - 1)
    correlations = np.array([float(rest[k:] @ rest[: len(rest) - k]) for k in range(most + 1)])
    correlations /= count * variance
    best = found = np.empty(0)
    left, least = 1.0, 0.0
    for order in range(1, most + 1):
        step = (correlations[order] - found @ correlations[order - 1 : 0 : -1]) / left
        found = np.append(found - step * found[::-1], step)
        left *= 1.0 - step * step
        if left <= 0.0:
            break
        cost = count * math.log(left) + order * math.log(count)
        if cost < least:
            best, least = found, cost
    return best


def _memories(coefficients: Array, least: float) -> tuple[float, float]:
    """The sums of the correlations of an autoregression, and of their squares, over all lags."""
    if not len(coefficients):
        return least, _SQUARED
    order = len(coefficients)
    lags = 64 * order
    impulse = np.zeros(lags)
    impulse[0] = 1.0
    for k in range(1, lags):
        past = impulse[max(0, k - order) : k][::-1]
        impulse[k] = coefficients[: len(past)] @ past
    spectrum = np.abs(np.fft.rfft(impulse, 2 * lags)) ** 2
    covariance = np.fft.irfft(spectrum)[:lags]
    own = covariance / covariance[0]
    both = float(1.0 + 2.0 * own[1:].sum()), float(1.0 + 2.0 * np.square(own[1:]).sum())
    return max(both[0], least), max(both[1], _SQUARED)
