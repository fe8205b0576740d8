"""How a machine was driven while the noise of its residuals was learned, and when it is driven as
never before."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from bondgraph.runtime.diagnosis.rows import Part, Row
from bondgraph.runtime.log import Array, Mask
from bondgraph.runtime.monitoring.plain import array, numbers

_WIDER = 2.0  # times the range of an input that noise is known for
_FASTER = 1.2  # times how fast it was; so far above what steps have shown a limit stays, too
_LEFT_OUT = 0.05  # of what an input adds to a residual: about what a model is wrong by
SETTLES = 2  # rows in which a step of an input shows: its own, and one behind it
_PART = 0.5  # of what an input adds: no model that is watched with is so wrong, a lag passes below


class Misread:
    """Rows since a residual `stood` somewhere with inputs in their ranges (2, inputs).

    An input is read wrongly in those where the residual is away by what it adds from where it can
    have been: by all of what it is beyond its range, and by this range at most. A model that is
    wrong is so by a part of what inputs add.
    """

    def __init__(self, at: Sequence[int], ranges: Array, reads: Mask, stood: float) -> None:
        self._at, self._reads, self._stood = at, reads, stood
        self._low, self._high = ranges
        self.rows = 0  #: in which an input is read wrongly

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
        self.rows += bool(fits.any() and _PART * np.abs(least).sum() < abs(moved))


class Driving:
    """The ranges of inputs, the columns `at` of the samples, in rows that were learned from.

    What a model leaves out grows with the motion, and inputs tell the motion that is wanted; a
    sensor may be what is wrong. `reads` says which residual reads which input, (inputs,
    residuals), `pace` how many samples a time constant of the filter has, and `every` how many a
    row.

    A lag that the model leaves out shows in how fast inputs are, not in how far they go: in how far
    each goes within a time constant. Behind a step that is faster than ever residuals are
    `settling`, for two rows, unless they are further away than such a step can bring them. Where
    they come back, they have shown what the machine does behind steps, and have `room` for it from
    then on, in proportion.

    An input that is measured may be read wrongly. Then the residual stays away by all that this
    adds to it, and nothing has moved but a reading.
    """

    def __init__(self, at: Sequence[int], reads: Mask, pace: float, every: int) -> None:
        self._at = list(at)
        self._keep, self._holds = math.exp(-1.0 / pace), math.exp(-1.0 / every)
        self._reads = np.vstack([reads, reads])  # inputs, and how fast they are
        shape = self._reads.shape
        self._range = _nothing(shape)  # of each input in rows that counted for a residual
        self._means = _nothing(shape)  # of the means of its rows, as slow as the filter is
        self._terms = _nothing(shape)  # of what it adds to that residual
        self._effect = np.full(shape, math.inf)  # of a unit of the input on the residual
        self._lags = np.zeros(reads.shape)  # room of the residual for a unit that an input steps by
        self.restart()

    def __bool__(self) -> bool:
        return bool(self._at)

    def restart(self) -> None:
        """The residuals begin anew."""
        self._slow: Array | None = None  # inputs behind a filter of first order
        self._steps = np.zeros((1, len(self._at)))  # how far inputs have stepped lately
        self._settles = np.zeros(self._reads.shape[1], dtype=int)  # rows until they are judged
        self._fast = np.zeros(self._lags.shape, dtype=bool)  # what they settle behind
        self._shown = np.zeros(self._lags.shape)  # how far they were for a unit of that
        self._most = np.zeros(len(self._settles))  # how far at all
        self._reach = np.zeros(len(self._settles))  # how far these inputs can have brought them
        self._begin()

    @property
    def settling(self) -> Mask:
        """Which residuals are not judged, as they show an input that is faster than ever."""
        return self._settles > 0

    @property
    def unsettled(self) -> Array:
        """How many of the last rows nobody knows of whether they show a lag, of each residual."""
        return np.where(self.settling, SETTLES - self._settles, 0)

    def _begin(self) -> None:
        """A row begins."""
        self._row = _nothing((2 * len(self._at), 1))

    def _moved(self, samples: Array) -> Array:
        """The inputs, and how far each is from where it was about a time constant ago.

        (n, twice as many). A slow drift goes no way in that time, however far it comes; a step goes
        all of its height. Noise of a measured input is smoothed. Without a value an input stays.
        """
        from scipy.signal import lfilter

        own = np.where(np.isfinite(samples[:, self._at]), samples[:, self._at], math.nan)
        slow = own[0] if self._slow is None else self._slow
        slow = np.where(np.isfinite(slow), slow, own[0])
        known = np.where(np.isfinite(own), np.arange(len(own))[:, None], -1)
        last = np.maximum.accumulate(known, axis=0)
        held = np.where(last >= 0, np.take_along_axis(own, np.maximum(last, 0), axis=0), slow)
        share, start = 1.0 - self._keep, self._keep * slow[None]
        smooth, _ = lfilter([share], [1.0, -self._keep], held, axis=0, zi=start)
        self._slow = smooth[-1]
        return np.hstack([own, own - smooth])

    def room(self, samples: Array) -> Array:
        """What a lag may do to residuals, (n, residuals), at further (n, signals) of a row."""
        own = self._moved(samples)
        for table, most in ((self._row[0], np.fmin), (self._row[1], np.fmax)):
            table[:] = most(table, most.reduce(own)[:, None])
        faded = self._holds ** np.arange(1.0, len(own) + 1.0)[:, None]
        steps = np.maximum.accumulate(np.abs(np.nan_to_num(own[:, len(self._at) :])) / faded)
        self._steps = faded * np.maximum(steps, self._steps[-1])
        return np.asarray(self._steps @ self._lags)

    def anew(self, limit: Array, sure: Mask) -> Mask:
        """Which residuals are driven as never before with the samples of the row so far.

        That is where an input that they read goes over twice the range that it had, and a twentieth
        of what this adds to them is above their `limit`. Where one steps as never before, those
        that are `sure` begin to settle.
        """
        before = self._range[1] - self._range[0]
        now = np.fmax(self._range[1], self._row[1]) - np.fmin(self._range[0], self._row[0])
        wider = np.repeat([_WIDER, _FASTER], len(self._at))[:, None]
        share = np.repeat([_LEFT_OUT, 1.0], len(self._at))[:, None]  # for a while a lag is all
        with np.errstate(invalid="ignore"):
            strange = self._reads & (share * self._effect * now > limit)
        strange &= (now > wider * before) & (before >= 0.0)
        further, faster = strange.reshape(2, len(self._at), -1)
        self._fast |= faster & sure
        self._settles[(faster & sure).any(axis=0)] = SETTLES
        return np.asarray(further.any(axis=0))

    def show(self, part: Part, limit: Array) -> None:
        """How residuals that settle show a step, where that is above the `limit` of their noise.

        A lag takes from a residual what its inputs step by, and no more: what is further away does
        not settle. Where a controller makes the input of a reading, a wrong reading is answered
        with a step.
        """
        if not self.settling.any():
            return
        with np.errstate(invalid="ignore"):
            steps = self._effect[len(self._at) :] * self._steps.max(axis=0)[:, None]
        reach = (1.0 + _PART) * np.where(self._fast, steps, 0.0).sum(axis=0)
        self._reach = np.maximum(self._reach, reach)
        away = part.valid & (np.abs(part.value) > self._reach + limit + part.bound)
        self._settles[away.any(axis=0)] = 0
        self._fast &= self.settling
        size = np.where(part.valid & self.settling, np.abs(part.value), 0.0)
        size *= size > limit
        self._most = np.maximum(self._most, size.max(axis=0))
        with np.errstate(divide="ignore", invalid="ignore"):
            own = np.where(self._fast, size[:, None, :] / self._steps[:, :, None], 0.0)
        self._shown = np.fmax(self._shown, own.max(axis=0))

    def _settled(self, row: Row, valid: Mask, limit: Array) -> Mask:
        """A row is over, of those that are `valid`; who has come back in it has shown a lag.

        Returns who should have, and is above its limits.
        """
        size, over = np.abs(row.value), self._settles == 1
        away = size > row.bound + limit
        lag = over & valid & ~away & (size <= np.maximum(limit, _PART * self._most))
        lag &= np.isfinite(self._shown).all(axis=0)
        self._lags = np.maximum(self._lags, np.where(lag, _FASTER * self._shown, 0.0))
        self._settles = np.maximum(self._settles - 1, 0)
        self._fast &= self.settling
        self._shown = np.where(self.settling, self._shown, 0.0)
        self._most = np.where(self.settling, self._most, 0.0)
        self._reach = np.where(self.settling, self._reach, 0.0)
        return np.asarray(over & away)

    def misread(self, k: int, stood: float) -> Misread:
        """Residual `k` is driven as never before; it `stood` there so far."""
        own = slice(len(self._at))
        return Misread(self._at, self._range[:, own, k].copy(), self._reads[own, k], stood)

    def learned(self, row: Row, valid: Mask, added: Array, limit: Array) -> Mask:
        """A row is over that counts for residuals which are `valid`; `limit` is of their noise.

        `added` is what the inputs add to them, (inputs, residuals), NaN where nobody knows. Returns
        who is above its limits still, once the rows behind a step are over.
        """
        stayed = self._settled(row, valid, limit)
        if not valid.any():
            self._begin()
            return stayed
        mean = np.tile(row.samples[:, self._at].mean(axis=0)[:, None], (2, 1))
        added = np.vstack([added, added])  # what a unit does is the same, however fast it came
        for table, (low, high) in (
            (self._range, self._row), (self._means, (mean, mean)), (self._terms, (added, added))
        ):  # fmt: skip
            table[0] = np.where(valid, np.fmin(table[0], low), table[0])
            table[1] = np.where(valid, np.fmax(table[1], high), table[1])
        if np.isfinite(added).any():
            with np.errstate(divide="ignore", invalid="ignore"):
                unit = np.subtract(*self._terms[::-1]) / np.subtract(*self._means[::-1])
            self._effect = np.where(unit >= 0.0, unit, math.inf)
        self._begin()
        return stayed

    def state(self) -> dict[str, Any]:
        """All that `resume` needs, as plain JSON."""
        tables = {"range": self._range, "effect": self._effect, "lags": self._lags}
        return {name: numbers(table) for name, table in tables.items()}

    def resume(self, state: Mapping[str, Any]) -> None:
        """Go on from a state; raises KeyError, TypeError or ValueError for one of another kind."""
        self._range = array(state["range"], self._range.shape)
        self._range[1][np.isinf(self._range[0])] = -math.inf
        self._effect = array(state["effect"], self._effect.shape)
        self._lags = array(state["lags"], self._lags.shape)


def _nothing(shape: tuple[int, ...]) -> Array:
    """Of no numbers: the least and the largest, (2, ...)."""
    return np.stack([np.full(shape, math.inf), np.full(shape, -math.inf)])
