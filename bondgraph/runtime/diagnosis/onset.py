"""When a fault began: the last sample at which residuals were what health lets expect."""

from __future__ import annotations

import numpy as np

from bondgraph.runtime.diagnosis.isolation import History
from bondgraph.runtime.log import Array, Mask
from bondgraph.runtime.monitoring.engine import Engine

_ODD = 3.0  # standard deviations that a residual has to be away from what is expected
_ERROR = 0.1  # of the residual, in the first row: a filter shows late when the fault began
_FADES = 0.4  # what is left of that in every row after
_GROWS = 3  # rows within which a residual has become as large as the fault makes it


def odd(history: History, value: Array, slopes: Array, noise: Array) -> Mask:
    """Which residuals are not what the history lets expect; `noise` are their variances."""
    expected, variance = history.expected(slopes)
    return np.asarray(np.abs(value - expected) > _ODD * np.sqrt(variance + noise))


def samples_before(
    engine: Engine, samples: Array, history: History, slopes: Array, noise: Array, fired: Mask
) -> int:
    """How many of the samples come before the fault; `engine` stands before them.

    `slopes` of the tolerated parameters are those of the last healthy row, (tolerated, residuals).
    """
    if not len(samples):
        return 0
    copy = engine.configured(bounds=False)
    copy.follow(engine)
    found = copy.run(samples)
    away = odd(history, found.value, slopes, noise) & found.valid & fired
    usual = np.flatnonzero(~away.any(axis=1))
    return min(int(usual[-1]) + 1, len(samples) - 1) if len(usual) else 0


def early(values: Array) -> Array:
    """Variances for not knowing the onset to the sample, of residuals (rows, residuals) since."""
    size = np.abs(values[:_GROWS]).max(axis=0, initial=0.0)
    return np.asarray((np.outer(_ERROR * _FADES ** np.arange(len(values)), size)) ** 2)
