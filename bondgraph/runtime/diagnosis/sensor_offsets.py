"""How far off a healthy sensor is: by a constant about as large as its noise, which no model says.

An instrument is adjusted to no better than it reads. Where nothing is said of that, a parameter
within its tolerance takes what the offset of a sensor does while the machine stays as it is, and
the offset alone remains when that changes: as the friction of a drum takes what a load cell says
too much, until the drum stands still.
"""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Mapping, Sequence

import numpy as np

from bondgraph.runtime.diagnosis.healthy import DiagnosisModel
from bondgraph.runtime.diagnosis.history import HEALTHY, History
from bondgraph.runtime.diagnosis.hypotheses import COUNT, Hypothesis
from bondgraph.runtime.diagnosis.rows import Part, Row
from bondgraph.runtime.diagnosis.tuning import UNKNOWN
from bondgraph.runtime.log import Array, Mask

_ROWS = 10  # that tell the noise of a sensor: their median, as some may be rough
_STEEP = 4.0  # times what offsets did while they were learned: a slope says little of that
_ORDER = 3  # of the differences in which what a machine does is small beside noise


class SensorOffsets:
    """Learns how large the offsets of sensors may be, `known` from when on parameters are learned.

    `first` is the number of the first of them among what is tolerated; `place` has the columns of
    the signals. Until they are known their deviation is 0: there are none.
    """

    def __init__(
        self, offsets: Sequence[Hypothesis], first: int, place: Mapping[str, int]
    ) -> None:
        self._numbers = list(range(first, first + len(offsets)))
        self._columns = [place[h.fault] for h in offsets]
        self._rows: list[tuple[Array, Array]] = []
        self._usual: Array | None = None  # what offsets did at most to residuals as they are known
        self._last: deque[Array] = deque(maxlen=HEALTHY)  # the same of the last rows
        self.known = not offsets

    def row(self, row: Row, history: History) -> None:
        """One more row of a healthy machine; the last one that is needed tells."""
        if self.known or len(row.samples) <= _ORDER:
            return
        whole = row.slopes[: self._numbers[-1] + 1]  # starts that were found stand behind them
        self._rows.append((roughness(row.samples[:, self._columns]), whole))
        if len(self._rows) >= _ROWS:
            rough, slopes = (np.array(x) for x in zip(*self._rows, strict=True))
            history.widen(self._numbers, np.median(rough, axis=0))
            self._usual = np.median(self._most(slopes, history), axis=0)
            self.known, self._rows = True, []

    def steep(self, row: Row, history: History) -> Mask:
        """In which residuals offsets would do much more than ever while they were learned.

        What they do there is not what its slope says, as with a root of a difference of pressures
        that comes near to zero: they may do all that they do at most, and nothing is learned.
        """
        if self._usual is None:
            return np.zeros(len(row.value), dtype=np.bool_)
        return np.asarray(self.most(row, history) > _STEEP * self._usual)

    def learned(self, row: Row, history: History) -> None:
        """Parameters and offsets have been learned from a row.

        What is steep in some rows that follow each other is how the machine is driven now.
        """
        most = np.where(row.valid, self.most(row, history), 0.0)
        if self._usual is None:
            self._usual = most
        self._last.append(most)
        lasting = np.min(self._last, axis=0) if len(self._last) == HEALTHY else np.zeros_like(most)
        usual = np.where(most <= _STEEP * self._usual, most, lasting)
        self._usual = np.maximum(self._usual, usual)

    def most(self, row: Row, history: History) -> Array:
        """What offsets do to residuals at most, in a row or in its average."""
        found = self._most(row.slopes, history)
        return found if row.average is None else np.maximum(
            found, self._most(row.average.slopes, history)
        )  # fmt: skip

    def _most(self, slopes: Array, history: History) -> Array:
        """The same by slopes of the shape (..., known, residuals)."""
        own = np.abs(slopes[..., self._numbers, :]) * history.prior[self._numbers, None]
        return np.asarray(math.sqrt(3.0) * own.sum(axis=-2))

    def room(self, part: Part, line: Array, history: History) -> Array:
        """What offsets may add to thresholds (n, residuals), where residuals are above their line.

        Where the machine is as it was while they were learned, that is next to nothing: what they
        do is in the mean of a residual, or in what is expected of it. It is no more than offsets do
        at most.
        """
        room, out = np.zeros_like(line), np.abs(part.value) > line
        at = np.flatnonzero(out.any(axis=1))
        if not len(at) or not self._numbers:
            return room
        slopes = part.slopes[at].transpose(1, 0, 2)
        expected, variance = history.expected(slopes.reshape(len(slopes), -1))
        far = (np.abs(expected) + UNKNOWN * np.sqrt(variance)).reshape(len(at), -1)
        most = self._most(part.slopes[at], history)
        room[at] = np.where(out[at], np.clip(far - part.bound[at], 0.0, most), 0.0)
        return room

    def resume(self, history: History) -> None:
        """Go on with what is known: deviations that are not 0."""
        self.known = not self._numbers or bool(history.prior[self._numbers].any())


def sensor_offsets(
    known: Sequence[Hypothesis], model: DiagnosisModel
) -> tuple[Hypothesis, ...]:
    """The offsets of sensors, but of encoders, which have no noise, and of what was accepted."""
    return tuple(
        h for h in known
        if h.kind == "offset" and not h.turned and h.unit != COUNT
        and (h.fault, h.kind) not in model.accepted
    )  # fmt: skip


def roughness(samples: Array) -> Array:
    """The deviation of white noise with third differences such as those of (n, signals) samples.

    A difference of third order has the coefficients 1, -3, 3, -1, and so 20 times the variance.
    0 where a signal has no value.

    >>> t = np.arange(2000) * 0.01
    >>> noisy = np.sin(t) + np.random.default_rng(1).normal(0.0, 0.05, 2000)
    >>> roughness(np.column_stack([np.sin(t), noisy])).round(3).tolist()
    [0.0, 0.05]
    """
    squares = np.square(np.diff(samples, _ORDER, axis=0))
    found = np.isfinite(squares)
    total = np.where(found, squares, 0.0).sum(axis=0)
    return np.asarray(np.sqrt(total / np.maximum(found.sum(axis=0), 1) / math.comb(6, 3)))
