"""What a model is off by while a fault acts: a share of each residual, for however long."""

from __future__ import annotations

import math

import numpy as np

from bondgraph.runtime.log import Array
from bondgraph.text.tuples import NamedTuple

SHARE = 0.05  #: of a residual: the deviation of what is said of it, as laws are bent


class Shares(NamedTuple):
    """How the variance of an error is shared out among its memories; together they are 1.

    `fading` are those of errors with a memory of 1, 2, 4, ... rows, each; `chunk` is that of
    errors that last for a chunk of rows, `ever` that of errors that stay for all of them.
    """

    fading: tuple[float, ...]
    chunk: float
    ever: float


def shares(rows: int, length: int) -> Shares:
    """The shares where so many rows are compared, in chunks of some length.

    How long an error lasts nobody knows: each octave of memories has the same share, from a row to
    more than all of them. What lasts for longer than a chunk, but not for ever, is taken for one of
    both, half and half.

    >>> own = shares(64, 4)
    >>> [round(x, 3) for x in (*own.fading, own.chunk, own.ever)]
    [0.125, 0.125, 0.125, 0.25, 0.375]
    """
    fading = round(math.log2(length)) + 1
    between = max(math.log2(rows / length), 0.0)
    whole = fading + between + 1.0
    return Shares((1.0 / whole,) * fading, between / 2.0 / whole, (between / 2.0 + 1.0) / whole)


def unroot(error: Array, own: Shares) -> Array:
    """What whitens rows of such an error beside their noise, (chunks, residuals, rows, rows).

    The deviation of the `error` of each value, (chunks, rows, residuals), is in units of its noise,
    with the sign of the value. Errors within a chunk only; each residual has its own.
    """
    lags = np.abs(np.subtract.outer(np.arange(error.shape[1]), np.arange(error.shape[1])))
    kept = own.chunk + sum(s * np.exp(-lags / 2.0**k) for k, s in enumerate(own.fading))
    size = error.transpose(0, 2, 1)  # (chunks, residuals, rows)
    variance = np.eye(len(lags)) + size[..., :, None] * size[..., None, :] * kept
    return np.asarray(np.linalg.inv(np.linalg.cholesky(variance)))
