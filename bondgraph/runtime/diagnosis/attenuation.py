"""What two faults explain of noise tells nothing of them (attenuation; Fuller, 1987).

A supply at a half and a reading that is twice too large take all of a residual to a quarter, its
noise as well. That is no evidence: with such faults there would be as much noise as before.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from bondgraph.runtime.diagnosis.isolation import ExplainedPair, Rows
from bondgraph.runtime.diagnosis.noise import stepped
from bondgraph.runtime.diagnosis.rows import CORRELATED
from bondgraph.runtime.diagnosis.tuning import UNKNOWN
from bondgraph.runtime.log import Array, Mask

_QUIET = 0.5  # of the noise: a reading that is twice what it was is no worse a measurement
_MEDIAN = 1.2  # deviation of a deviation by the median of n sizes, times the root of n


def beside_their_noise(
    noise: Array, rows: Rows, one: Array, found: Sequence[ExplainedPair], moved: Sequence[Array]
) -> list[ExplainedPair]:
    """Pairs without what they explain where they take noise away.

    The noise that there is is what neighbouring rows differ by, of what was seen and of what a
    single fault leaves of it, `one`, and no more than is known of it, `noise`, as in `Told`. In a
    residual with less than half of that beside a pair nothing counts that the pair explains better
    than that fault, or if this is more, the noise. `moved` is what each pair does; all are (rows,
    residuals).

    >>> value = np.random.default_rng(1).standard_normal((200, 1))
    >>> rows = Rows(value, np.ones((200, 1)), np.empty((200, 0, 1)), np.empty((200, 0, 1)))
    >>> pair = ExplainedPair((None, None), 130.0, (1.0, 1.0), 0.1, 200, 130.0)
    >>> moved = [0.0 * value, 0.9 * value]  # nothing of the noise is explained, or most of it
    >>> [round(one.evidence) for one in
    ...  beside_their_noise(np.ones((200, 1)), rows, value, [pair, pair], moved)]
    [130, 45]
    """
    known = rows.weight > 0
    usual = math.sqrt(CORRELATED) * np.median(np.where(known, noise, 0.0), axis=0)
    there = np.minimum(np.minimum(_rough(rows.value, known), _rough(one, known)), usual)
    unsure = 1.0 + UNKNOWN * _MEDIAN / np.sqrt(np.maximum(known.sum(axis=0), 1))
    told = []
    for two, moves in zip(found, moved, strict=True):
        left = rows.value - moves
        quiet = _rough(left, known)
        better = (rows.weight * (one**2 - left**2)).sum(axis=0)
        noise_taken = rows.weight.sum(axis=0) * (there**2 - quiet**2)
        more = float(np.maximum(better, noise_taken)[quiet * unsure < _QUIET * there].sum())
        told.append(two._replace(
            evidence=two.evidence - more / 2.0,
            whole=two.whole - more / 2.0,
            left=two.left + more / two.values,
        ))  # fmt: skip
    return told


def _rough(values: Array, known: Mask) -> Array:
    """The deviation of white noise whose neighbours differ as known values (n, residuals) do."""
    return np.array([stepped(column) for column in np.where(known, values, math.nan).T])
