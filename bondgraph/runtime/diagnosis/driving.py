"""How a machine was driven while the noise of its residuals was learned, and when it is driven as
never before."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from bondgraph.runtime.log import Array, Mask
from bondgraph.runtime.monitoring.plain import array, numbers

_WIDER = 2.0  # times the range of an input that noise is known for
_LEFT_OUT = 0.05  # of what an input adds to a residual: about what a model is wrong by
_PART = 0.5  # of what an input adds, which no model is wrong by that anybody watches with


class Away:
    """A residual which `stood` somewhere with inputs in their ranges (2, inputs), and rows since.

    A row is misread where the residual is away by what one input adds to it from where this can
    have been: by all of what it is beyond its range, and by this range at most. A model that is
    wrong is so by a part of what inputs add.
    """

    def __init__(self, at: Sequence[int], ranges: Array, reads: Mask, stood: float) -> None:
        self._at, self._reads, self._stood = at, reads, stood
        self._low, self._high = ranges
        self.misread = 0  #: rows

    def row(self, samples: Array, unit: Array, value: float) -> None:
        """A row more, (n, signals); what a unit of each input adds, and the residual behind it."""
        means = samples[:, self._at].mean(axis=0)
        with np.errstate(invalid="ignore"):
            beyond = np.fmax(means - self._high, 0.0) - np.fmax(self._low - means, 0.0)
            most = beyond + np.copysign(self._high - self._low, beyond)
        known = self._reads & np.isfinite(most) & np.isfinite(unit) & (beyond != 0.0)
        least, most = (np.where(known, unit * side, 0.0) for side in (beyond, most))
        moved = value - self._stood
        fits = (np.sign(least) == np.sign(moved)) & (abs(moved) < (1.0 + _PART) * np.abs(most))
        self.misread += bool(fits.any() and _PART * np.abs(least).sum() < abs(moved))


class Driving:
    """The ranges of inputs, the columns `at` of the samples, in rows that were learned from.

    What a model leaves out grows with the motion, and inputs tell the motion that is wanted; a
    sensor may be what is wrong. `reads` says which residual reads which input, (inputs,
    residuals).

    An input that is measured may be read wrongly. Then the residual stays away by all that this
    adds to it, and nothing has moved but a reading.
    """

    def __init__(self, at: Sequence[int], reads: Mask) -> None:
        self._at, self._reads = list(at), reads
        self._range = _nothing(reads.shape)  # of each input in rows that counted for a residual
        self._means = _nothing(reads.shape)  # of the means of its rows, as slow as the filter is
        self._terms = _nothing(reads.shape)  # of what it adds to that residual
        self._effect = np.full(reads.shape, math.inf)  # of a unit of the input on the residual
        self.restart()

    def __bool__(self) -> bool:
        return bool(self._at)

    def restart(self) -> None:
        """A row begins."""
        self._row = _nothing((len(self._at), 1))

    def anew(self, samples: Array, limit: Array) -> Mask:
        """Which residuals are driven as never before with further (n, signals) samples of a row.

        That is where an input that they read goes over twice the range that it had, and a twentieth
        of what this adds to them is above their `limit`.
        """
        own = np.where(np.isfinite(samples[:, self._at]), samples[:, self._at], math.nan)
        for table, most in ((self._row[0], np.fmin), (self._row[1], np.fmax)):
            table[:] = most(table, most.reduce(own)[:, None])
        before = self._range[1] - self._range[0]
        now = np.fmax(self._range[1], self._row[1]) - np.fmin(self._range[0], self._row[0])
        with np.errstate(invalid="ignore"):
            strange = self._reads & (_LEFT_OUT * self._effect * now > limit)
        strange &= (now > _WIDER * before) & (before >= 0.0)
        return np.asarray(strange.any(axis=0))

    def away(self, k: int, stood: float) -> Away:
        """Residual `k` is driven as never before; it `stood` there so far."""
        return Away(self._at, self._range[:, :, k].copy(), self._reads[:, k], stood)

    def learned(self, samples: Array, valid: Mask, added: Array) -> None:
        """A row (n, signals) is over that counts for the residuals which are `valid`.

        `added` is what the inputs add to them, (inputs, residuals), NaN where nobody knows.
        """
        if not valid.any():
            self.restart()
            return
        mean = samples[:, self._at].mean(axis=0)[:, None]
        for table, (low, high) in (
            (self._range, self._row), (self._means, (mean, mean)), (self._terms, (added, added))
        ):  # fmt: skip
            table[0] = np.where(valid, np.fmin(table[0], low), table[0])
            table[1] = np.where(valid, np.fmax(table[1], high), table[1])
        if np.isfinite(added).any():
            with np.errstate(divide="ignore", invalid="ignore"):
                unit = np.subtract(*self._terms[::-1]) / np.subtract(*self._means[::-1])
            self._effect = np.where(unit >= 0.0, unit, math.inf)
        self.restart()

    def state(self) -> dict[str, Any]:
        """All that `resume` needs, as plain JSON."""
        return {"range": numbers(self._range), "effect": numbers(self._effect)}

    def resume(self, state: Mapping[str, Any]) -> None:
        """Go on from a state; raises KeyError, TypeError or ValueError for one of another kind."""
        self._range = array(state["range"], self._range.shape)
        self._range[1][np.isinf(self._range[0])] = -math.inf
        self._effect = array(state["effect"], self._effect.shape)


def _nothing(shape: tuple[int, ...]) -> Array:
    """Of no numbers: the least and the largest, (2, ...)."""
    return np.stack([np.full(shape, math.inf), np.full(shape, -math.inf)])
