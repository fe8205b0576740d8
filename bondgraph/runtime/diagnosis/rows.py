"""Rows of the past: samples far enough apart, what came out there, and how much that is worth."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence

import numpy as np

from bondgraph.runtime.log import Array, Mask
from bondgraph.runtime.monitoring.engine import Batch, Engine
from bondgraph.text.tuples import NamedTuple

_MODEL_ERROR = 0.02  # of the adaptive threshold: what the linearised model is off by
_SLOPE_ERROR = 0.02  # of the residual: what its sensitivities are off by
_DOUBTED = 0.5  # of the doubt: its deviation
CORRELATED = 2.0  # variance of the mean of rows, to that of independent ones
PAUSE = 32  #: rows: what has never been there has been away for longer
_LEAST, _CALM = 4, 10.0  # rows at least, or s: a line every ten seconds can be read
_SOON = 4  # times the rows that had to be quiet: what comes back within them has not been away


def pause(seconds: float) -> int:
    """How many rows of so many seconds what comes and goes has to be away at most to be over.

    It is not told each time where that would be every few seconds, as where a fault shows in each
    stroke of a machine; nor is it held for minutes.

    >>> pause(0.02), pause(1.0), pause(15.0)
    (500, 10, 4)
    """
    return max(_LEAST, math.ceil(_CALM / seconds))


def away(gap: int, needed: int, quiet: int, most: int) -> int:
    """How many rows something has to be away that is back after a `gap`, when it `needed` so many.

    Twice as many as it was away now, or only a few that are `quiet` if it had been away for long,
    or not at all.

    >>> away(3, 2, 2, most=32), away(20, 2, 2, most=32), away(20, 6, 2, most=32)
    (6, 2, 32)
    >>> away(0, 2, 2, most=32)
    2
    """
    return max(quiet, min(2 * gap, most)) if gap <= min(_SOON * needed, most) else quiet


class Part(NamedTuple):
    """Samples up to the end of a row, with residuals and whole thresholds, (n, residuals) each."""

    time: Array
    samples: Array
    value: Array
    valid: Mask
    bound: Array
    doubt: Array
    slopes: Array  # (n, parameters, residuals)


class Average(NamedTuple):
    """Of all samples of a row: residuals, whether each sample has a value, thresholds, slopes.

    An average is no farther off than the average of the thresholds: these come and go in a row, as
    what a machine does and a step of a command do.
    """

    value: Array
    valid: Mask
    bound: Array
    doubt: Array  # the part of it that no parameter explains
    slopes: Array


class Row(NamedTuple):
    """One row of the past, with the samples that led to it and the engine before these."""

    time: float
    samples: Array
    engine: Engine
    value: Array
    valid: Mask
    bound: Array
    doubt: Array  # the part of it that no parameter explains
    slopes: Array  # of the tolerated parameters, wrong for ever
    mean: Array | float = 0.0  # of the residuals while all is well, that was taken off the value
    average: Average | None = None  # of its samples, if it is known
    directions: Array | None = None  # averages of slopes by faults, (directions, residuals)

    def leave_out(self, which: Mask) -> None:
        """Nothing is known of some residuals."""
        self.valid[which] = False
        if self.average is not None:
            self.average.valid[which] = False

    def lower(self, by: Array) -> None:
        """Take something more off the values: residuals stand elsewhere while all is well."""
        np.subtract(self.value, by, out=self.value, where=self.valid)
        if isinstance(self.mean, np.ndarray):
            np.add(self.mean, by, out=self.mean)
        if self.average is not None:
            own = self.average
            np.subtract(own.value, by, out=own.value, where=own.valid)


def beside(row: Row, limits: Array) -> tuple[Array, Array, Mask]:
    """How far residuals with these `limits` are from where they stand, the bounds of that, and of
    which it is known.

    By the averages of rows where noise is known of these.
    """
    known = np.isfinite(limits[:, 0])
    if row.average is None:
        return row.value, row.bound, row.valid & known
    lasting = limits[:, 6] > 0.0
    value = np.where(lasting, row.average.value - limits[:, 7], row.value)
    bound = np.where(lasting, row.average.bound, row.bound)
    return value, bound, np.where(lasting, row.average.valid, row.valid) & known


def to_row_ends(time: Array, sample_time: float, every: int) -> Iterator[slice]:
    """Samples, by their times (n,), up to the end of each row of so many.

    Rows end at the same times whenever one begins to look.

    >>> list(to_row_ends(np.arange(3, 9) * 0.1, 0.1, 4))
    [slice(0, 1, None), slice(1, 5, None), slice(5, 6, None)]
    """
    start = 0
    while start < len(time):
        number = round(float(time[start]) / sample_time)
        stop = min(len(time), start + every - number % every)
        yield slice(start, stop)
        start = stop


def averaged(value: Array, valid: Mask, bound: Array, doubt: Array, slopes: Array) -> Average:
    """Of samples, (n, residuals) and (n, parameters, residuals)."""
    sound: Mask = np.asarray(valid.all(axis=0))
    whole = np.where(sound, value.mean(axis=0), 0.0)
    return Average(whole, sound, *(x.mean(axis=0) for x in (bound, doubt, slopes)))


def all_of(pieces: Sequence[tuple[int, Average]]) -> Average:
    """Of pieces of so many samples each, one after the other."""
    if len(pieces) == 1:
        return pieces[0][1]
    counts = np.array([count for count, _ in pieces]) / sum(count for count, _ in pieces)
    value, valid, *rest = (np.stack(x) for x in zip(*[own for _, own in pieces], strict=True))
    sound: Mask = np.asarray(valid.all(axis=0))
    whole = np.where(sound, np.tensordot(counts, value, 1), 0.0)
    return Average(whole, sound, *(np.tensordot(counts, x, 1) for x in rest))


def steady(row: Row, weights: Array) -> tuple[Array, Array, Array]:
    """What a row tells of parameters: residuals, their weights and slopes, averages of its samples.

    A sensor's noise is in slopes as in residuals, and a parameter is drawn to where it makes least
    of it: to a spring without compliance, where force is differentiated. In averages little is left
    of noise that is differentiated, and most of what a machine does. Where there is none, as of the
    row in which a residual begins to be valid, its last sample tells.
    """
    if row.average is None:
        return row.value, weights, row.slopes
    value, sound, *_, slopes = row.average
    return np.where(sound, value, row.value), weights, np.where(sound, slopes, row.slopes)


def together(parts: Sequence[Batch], residuals: int) -> Batch:
    """The residuals of samples that follow each other."""
    nothing = np.zeros((0, residuals))
    value, valid, bound = zip(Batch(nothing, nothing > 0, nothing), *parts, strict=True)
    return Batch(np.concatenate(value), np.concatenate(valid), np.concatenate(bound))


def weight(row: Row, sigma: Array) -> Array:
    """One over the variance of its residuals, by what is known of their noise (deviation sigma)."""
    return weights(row.value, row.valid, row.bound, row.doubt, sigma)


def weights(value: Array, valid: Mask, bound: Array, doubt: Array, sigma: Array) -> Array:
    """The same of residuals, of any shape."""
    with np.errstate(over="ignore"):  # what is that large has no weight
        variance = variances(value, bound, sigma) + (_DOUBTED * doubt) ** 2
    return np.where(valid & (variance > 0), 1.0 / np.maximum(variance, 1e-300), 0.0)


def variances(value: Array, bound: Array, sigma: Array) -> Array:
    """Of residuals about what linear slopes say of them, with noise of deviation `sigma`."""
    return CORRELATED * sigma**2 + model_error(value, bound)


def model_error(value: Array, bound: Array) -> Array:
    """The variance of what linear slopes say wrongly of residuals."""
    return np.asarray((_MODEL_ERROR * bound) ** 2 + (_SLOPE_ERROR * value) ** 2)


def usual(rows: Sequence[Row]) -> list[Row]:
    """The rows with no more doubt than twice the median: a fault that sets in shakes that too."""
    if not rows:
        return []
    most = 2.0 * np.median([row.doubt for row in rows], axis=0)
    return [row._replace(doubt=np.minimum(row.doubt, most)) for row in rows]
