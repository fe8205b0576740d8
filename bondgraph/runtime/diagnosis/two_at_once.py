"""Whether what two faults at once explain takes both of them."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np

from bondgraph.runtime.diagnosis.isolation import RARER, ExplainedPair, Rows
from bondgraph.runtime.diagnosis.model_error import SHARE
from bondgraph.runtime.diagnosis.noise import left_for_drift
from bondgraph.runtime.diagnosis.row_sums import Told
from bondgraph.runtime.diagnosis.rows import CORRELATED
from bondgraph.runtime.diagnosis.tuning import UNKNOWN
from bondgraph.runtime.log import Array


def showing(
    seen: Told, rows: Rows, pairs: Sequence[ExplainedPair], moved: Sequence[Array]
) -> Iterator[int]:
    """Which pairs are two faults: each of both would show by itself, and beside the other one.

    In some residual it makes what was seen a thousand times more probable than a machine with what
    gives no alarm, and with a law that is wrong by two deviations of what is said of the residual;
    and so does what is left of it where the other one takes its part. What is less mends the model,
    or follows a supply that wanders. `moved` is what one of each does, (rows, 2, residuals).
    """
    room, sigma = left_for_drift(seen.bound, seen.doubt)[:, None], seen.noise[:, None]
    room = room + UNKNOWN * SHARE * np.abs(rows.value)[:, None]
    known = (rows.weight > 0)[:, None] & np.isfinite(sigma)

    def shows(moves: Array) -> bool:
        out = np.maximum(np.abs(moves) - room, 0.0)
        squares = np.divide(out, sigma, where=known, out=np.zeros_like(out)) ** 2
        return bool((squares.sum(axis=0).max(axis=1) >= 2.0 * CORRELATED * RARER).all())

    for k, (two, slopes) in enumerate(zip(pairs, moved, strict=True)):
        own = slopes * np.array(two.changes)[:, None]
        if shows(own) and shows(own - along(own, own[:, ::-1], rows.weight)):
            yield k


def along(moves: Array, others: Array, weight: Array) -> Array:
    """The part of each of `moves` that some size of the one beside it in `others` does.

    All (rows, n, residuals), the weight of residuals (rows, residuals).

    >>> moves, others = np.array([[[3.0, 1.0]]]), np.array([[[1.0, 0.0]]])
    >>> along(moves, others, np.ones((1, 2))).tolist()
    [[[3.0, 0.0]]]
    """
    weight = weight[:, None]
    sizes = (weight * others**2).sum(axis=(0, 2))
    share = (weight * moves * others).sum(axis=(0, 2)) / np.where(sizes > 0.0, sizes, 1.0)
    return np.asarray(share[:, None] * others)
