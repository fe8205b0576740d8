"""Where a fault sets in: its time, and the samples before and behind that."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from bondgraph.runtime.diagnosis.detection import Detection
from bondgraph.runtime.diagnosis.history import History
from bondgraph.runtime.diagnosis.isolation import inverse
from bondgraph.runtime.diagnosis.row_averages import LAGS
from bondgraph.runtime.diagnosis.rows import Row, weight
from bondgraph.runtime.log import Array, Mask
from bondgraph.runtime.monitoring.engine import Engine, copied
from bondgraph.text.tuples import NamedTuple

_ODD = 3.0  # standard deviations that a residual has to be away from what is expected


class Onset(NamedTuple):
    """A fault sets in at a `time`, behind samples that are `healthy`, (n, signals).

    The `engine` stands before these. `own` of them are of the first of the `rows` in which the
    fault acts, the others are those of the rows `before`, if these are known.
    """

    time: float
    engine: Engine
    healthy: Array
    own: int
    rows: Sequence[Row]
    before: Sequence[Row] = ()


def onset(
    time: float,
    engine: Engine,
    piece: Sequence[Array],
    past: Sequence[Row],
    detection: Detection,
    limits: Array,
    history: History,
) -> Onset:
    """The onset of what the `detection` tells, behind the last sample that was as before.

    The `engine` stands before the `piece`, samples behind the rows of the `past`. Where there are
    none a sum of rows has fired, and tells when it was zero. Without a past it is `time`.
    """
    if not past:
        return Onset(time, engine, np.empty((0, len(engine.signals))), 0, ())
    begin = len(past) - 1
    while begin > 0 and (_odd(past[begin], limits, history) & detection.fired).any():
        begin -= 1
    if not piece:
        begin = max(0, min(begin, len(past) - 1 - detection.onset(limits)))
    last, rows = past[begin], past[begin + 1 :]  # the fault begins behind this one
    if rows:
        engine, piece = rows[0].engine, [rows[0].samples]
    samples = np.concatenate([last.samples[:0], *piece])
    noise = inverse(weight(last, limits[:, 0]))
    count = _samples_before(
        engine, samples, limits[:, 4], history, last.slopes, noise, detection.fired
    )
    # what is read late may have gone wrong before it showed; and what a machine would do that
    # has always been wrong is known once its filters have settled
    late = math.ceil((engine.lags[-1] + engine.warm_up) / engine.sample_time)
    first = begin
    while first > 0 and (
        begin + 1 - first < LAGS or sum(len(row.samples) for row in past[first:begin]) < late
    ):
        first -= 1
    before = past[first : begin + 1]
    healthy = np.concatenate([*(row.samples for row in before), samples[:count]])
    at = last.time + count * engine.sample_time
    return Onset(at, past[first].engine, healthy, count, rows, before)


def onset_again(time: float, since: float, limits: Array, past: Sequence[Row]) -> Onset | None:
    """The onset of a fault that is there `since` long, from where there are residuals again.

    None while there are none. A `time` before that is of a clock that has begun again.
    """
    anew = time <= since
    rows = [r for r in past if weight(r, limits[:, 0]).any() and (anew or r.time > since)]
    if not rows:
        return None
    first, count = rows[0], len(rows[0].samples)
    ago = math.ceil((first.time - since) / first.engine.sample_time)
    healthy = 0 if anew or ago >= count else count - max(1, ago)
    return Onset(since, first.engine, first.samples[:healthy], healthy, rows)


def _odd(row: Row, limits: Array, history: History) -> Mask:
    """Which residuals are not what the history lets expect in a row."""
    return _far(history, row.value, row.slopes, inverse(weight(row, limits[:, 0])))


def _far(history: History, value: Array, slopes: Array, noise: Array) -> Mask:
    """Which residuals are not what the history lets expect; `noise` are their variances."""
    expected, variance = history.expected(slopes)
    return np.asarray(np.abs(value - expected) > _ODD * np.sqrt(variance + noise))


def _samples_before(
    engine: Engine,
    samples: Array,
    mean: Array,
    history: History,
    slopes: Array,
    noise: Array,
    fired: Mask,
) -> int:
    """How many of the samples come before the fault; `engine` stands before them.

    Residuals stand at their `mean` while all is well. `slopes` of the tolerated parameters are
    those of the last healthy row, (tolerated, residuals).
    """
    if not len(samples):
        return 0
    found = copied(engine).run(samples)
    away = _far(history, found.value - mean, slopes, noise) & found.valid & fired
    usual = np.flatnonzero(~away.any(axis=1))
    return min(int(usual[-1]) + 1, len(samples) - 1) if len(usual) else 0
