"""That something is wrong: a residual far out for some samples, or a little for many rows."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from typing import Any

import numpy as np

from bondgraph.runtime.diagnosis.cusum import OVER, Cusum
from bondgraph.runtime.diagnosis.history import History
from bondgraph.runtime.diagnosis.model_error import SHARE
from bondgraph.runtime.diagnosis.row_averages import added
from bondgraph.runtime.diagnosis.row_sums import Moves
from bondgraph.runtime.diagnosis.rows import PAUSE, Part, Row, away
from bondgraph.runtime.diagnosis.score_sums import ScoreSums
from bondgraph.runtime.diagnosis.tuning import UNKNOWN
from bondgraph.runtime.log import Array, Mask
from bondgraph.runtime.monitoring.plain import array, numbers

_QUIET = 2  # rows, at least: what moves through zero is quiet in one
_STILL = 8  # rows at least that no alarm would be given in, until it is over for that alone
_OUT = 3.0  # deviations that noise by itself hardly reaches
_CHANCE = 2.33  # deviations below an even chance, of a test of signs: one in a hundred
#: Rows from which it is known what a residual is beside a fault: its deviation to a fifth then.
_KNOWN = 16
_LEAST = 0.5  # deviations, of averages or rows: a fault that does less is not seen


class Detection:
    """Two tests of each residual; one that has fired stays so until the fault is over.

    `scores` are sums along what faults do. `fired` says which have, `most` by how much of its
    threshold each was out at most, of the last samples while none has fired; `alarms` counts them.
    The sample test fires after `least` samples in a row. `limits` have the columns of `Limit`.

    A fault is over once it is twenty times as probable that the residuals which have fired, all
    together, are those of a healthy machine as that each goes on as it has been while it was out,
    normal with that mean and deviation (Wald, 1945), and none speaks against it: two rows for a
    large fault, some more for a small one. Where it is known what fault it is, it goes on as that
    fault does in each row, as well as laws are known, unless it is surely not what most of the rows
    were out by so far. So a row tells nothing in which it would not show, as where it acts in a
    part of a motion only. When no alarm would be given for long, it is over nevertheless: what a
    fault does may be as noisy as its residual, and explain noise. A row in which one is as far out
    as an alarm takes speaks against an end, however it was before: it may swing. A fault that comes
    and goes is not told each time: what comes back soon has to be away for twice as long the next
    time, for so many rows at most as a `pause` has.
    """

    def __init__(
        self,
        residuals: Sequence[str],
        least: int,
        learns: bool = True,
        pause: int = PAUSE,
        scores: ScoreSums | None = None,
    ) -> None:
        """How high sums climb while all is well is learned where it `learns`.

        Without `scores` no fault has a direction of its own.
        """
        self._names, self._least, self._pause = tuple(residuals), least, pause
        self._cusum = Cusum(len(residuals), learns)
        self.scores = scores or ScoreSums(np.zeros(0), len(residuals), learns)
        self.fired: Mask = np.zeros(len(residuals), dtype=np.bool_)
        self.most = np.zeros(len(residuals))
        self._age = np.zeros(len(residuals))  # rows since each has fired
        self.alarms = 0
        self._needed = _QUIET  # rows that have to be quiet
        self._away = pause + 1  # rows since a fault was over
        self._gone = _QUIET  # rows that it had to be quiet for then
        self.restart()

    def restart(self) -> None:
        """The residuals begin anew; what has fired still has."""
        self._streak = np.zeros(len(self._names), dtype=int)
        self._cusum.restart()
        self.scores.restart()
        # of rows of this alarm, and of their averages: 1, excess, squares; and of those that were
        # out how many, and how many more are explained by the fault that is known than are not; of
        # what is beside that fault: 1, values, squares
        self._sum = np.zeros((11, len(self._names)))
        self._held = np.zeros((11, len(self._names)))  # the same of rows since they are quiet
        self._healthy = np.zeros(len(self._names))  # logarithm of how probable it is to be over
        self._quiet = 0  # rows that nothing speaks against an end in
        self._still = 0  # rows that no alarm would be given in

    @property
    def alarmed(self) -> bool:
        """Whether any residual has fired."""
        return bool(self.fired.any())

    def levels(self) -> dict[str, float]:
        """By how much of its threshold each fired residual was out at most."""
        found = zip(self._names, self.most, self.fired, strict=True)
        return {name: round(float(most), 3) for name, most, fired in found if fired}

    def samples(self, part: Part, line: Array) -> Iterator[tuple[int, Mask]]:
        """Numbers of samples at which residuals fire, and which; `line` are whole thresholds.

        Whoever takes them has to `latch` them before the next.
        """
        known = part.valid & np.isfinite(line)
        level = np.where(known, np.abs(part.value) / line, 0.0)
        past = self.most if self.alarmed else 0.0
        self.most = np.maximum(past, level.max(axis=0))
        over = (level > 1.0) & ~self.fired
        if not over.any():
            self._streak[:] = 0
            return
        for k in range(len(over)):
            self._streak = np.where(over[k], self._streak + 1, 0)
            fresh = (self._streak >= self._least) & ~self.fired
            if fresh.any():
                yield k, fresh

    def row(self, row: Row, limits: Array, history: History) -> Mask:
        """Which fire by what is too much in rows (see `Cusum` and `ScoreSums`).

        The `history` is what is known of the machine before.
        """
        self._age += 1.0
        if not self.alarmed:
            self._away = min(self._away + 1, self._pause + 1)
        over = self._cusum.add(row, limits)
        over |= self.scores.add(row, limits, history, healthy=not self.alarmed)
        return np.asarray(over & ~self.fired)

    def onset(self, limits: Array) -> int:
        """Rows since something is wrong that a sum of rows tells now, 0 if none does."""
        return max(self._cusum.onset(limits), self.scores.onset(limits))

    @property
    def held(self) -> Array:
        """Rows since the sums of each residual were zero: a fault may act since then."""
        return np.maximum(self._cusum.held, self.scores.held)

    def latch(self, fresh: Mask) -> bool:
        """These have fired; whether they are the first of an alarm."""
        first = not self.alarmed
        if first:
            gap = self._away + self._gone  # rows without it
            self._needed = away(gap, self._gone, _QUIET, self._pause)
        self.fired = self.fired | fresh
        self._age[fresh] = 0.0
        self._still = 0
        self.reconsider()
        self.alarms += first
        return first

    def withdraw(self, which: Mask, rows: int) -> None:
        """Some of those that have fired in so many rows did it for nothing, if others go on."""
        own = self.fired & which & (self._age < rows)
        if not (self.fired & ~own).any():
            return
        self.fired = self.fired & ~own
        self.most[own] = self._healthy[own] = 0.0
        self._sum[:, own] = self._held[:, own] = 0.0

    def ending(self, row: Row, limits: Array) -> bool:
        """Whether a fault seems to end: nothing that has fired is out in a row, or was lately."""
        loud = np.abs(row.value) - row.bound > limits[:, 0]
        quiet = bool((self._healthy[self.fired] > 0.0).all())
        return quiet or not (row.valid & self.fired & loud).any()

    def suspects(self, row: Row, limits: Array) -> bool:
        """Whether something is further out than it usually is, though nothing has fired yet."""
        loud = np.abs(row.value) - row.bound > 0.5 * limits[:, 2] * limits[:, 0]
        return bool((self._streak > 0).any() or loud.any())

    def reconsider(self) -> None:
        """What quiet rows have told of the end of a fault was told without knowing the fault."""
        self._healthy[:] = self._sum[6:] = self._held[6:] = 0.0
        self._quiet = 0

    def over(
        self, row: Row, limits: Array, moves: Callable[[], Moves | None] = lambda: None
    ) -> bool:
        """Whether the fault is over, with one row more.

        `moves` says by how much the fault would move each residual now if it was still there, where
        that is known (NaN where not), and the averages of this row and of LAGS before: where it
        would not, a residual is quiet for no reason.
        """
        seen = row.valid & self.fired & np.isfinite(limits[:, 0])  # others tell nothing
        excess = np.where(seen, _excess(row.value, row.bound, limits[:, 0]), 0.0)
        loud = np.abs(excess) > 1.0
        more = np.where(seen & (self._sum[0] > 0), self._more(excess, limits[:, 5]), 0.0)
        moved, one = moves() if seen.any() else None, np.ones_like(excess)
        if moved is not None:
            count, balance = self._sum[6:8]
            named = np.isfinite(moved.last) & (balance >= -_CHANCE * np.sqrt(count))
            self._held[6:8] += _explained(moved.last, row, excess, limits[:, 0])
            without, tells = self._without(moved, row, limits)
            rest = row.value - moved.last
            self._held[8:] += np.where(seen & np.isfinite(rest), [one, rest, rest**2], 0.0)
            seen &= tells | loud | ~named
            more = np.where(seen, np.where(named, without, more), 0.0)
        # few rows do not tell how it goes on: what was out by 5 is no more healthy at -80
        more = np.where(np.abs(excess) > limits[:, 2], -np.inf, more)
        self._healthy = np.maximum(self._healthy + more, 0.0)
        # what is quiet now is no part of how far out it was, until it is out again
        lasting = self._cusum.excess
        known = np.where(np.isfinite(lasting), [one, lasting, lasting**2], 0.0)
        self._held[:6] += np.where(seen, [one, excess, excess**2, *known], 0.0)
        out = self._healthy <= 0.0
        self._sum += np.where(out, self._held, 0.0)
        self._held[:, out] = 0.0
        quiet = bool((row.valid & self.fired)[self.fired].all())
        own = self._healthy[self.fired]
        self._quiet = 0 if (seen & out).any() else self._quiet + quiet
        high = self._cusum.high(limits) | self.scores.high(limits)
        high |= np.abs(excess) > limits[:, 2]
        self._still = 0 if (row.valid & self.fired & high).any() else self._still + quiet
        enough = bool(own.sum() > OVER)
        return (enough and self._quiet >= self._needed) or self._still >= max(self._pause, _STILL)

    def _without(self, moved: Moves, row: Row, limits: Array) -> tuple[Array, Mask]:
        """By how much more probable a row is without a fault that moves residuals so, which tell.

        By its last sample, or where that cannot tell by its average beside the rows before. What a
        residual was beside the fault in most rows it is on: it goes nowhere else within its
        threshold just when the fault would be over.
        """
        sigma, memory, unit = limits[:, 0], limits[:, 5], limits[:, 6]
        count, total, squares = self._sum[8:]
        rest = total / np.maximum(count, 1.0)
        scatter = np.sqrt(np.maximum(squares / np.maximum(count, 1.0) - rest**2, 0.0))
        bound = np.where(count >= _KNOWN, np.minimum(row.bound, UNKNOWN * scatter), row.bound)
        value = row.value - np.where(bound < row.bound, rest, 0.0)
        more, tells = _without(moved.last, value, bound, sigma)
        whole = added(moved.means[-1:], moved.means[-2::-1, None], limits)[0]
        average, shows = _without(whole, self._cusum.lasting[0], self._cusum.lasting[1], unit)
        use = ~tells & shows & np.isfinite(average)
        return np.where(use, average, more / memory), tells | use

    def _more(self, excess: Array, memory: Array) -> Array:
        """By how much a row makes it more probable that the fault of each residual is gone.

        That tells either the row, or its average beside the rows before: what shows the fault best.
        """
        lasting = self._cusum.excess
        rows, shows = _gone(self._sum[:3], excess, 1.0)
        averages, better = _gone(self._sum[3:6], lasting, _LEAST)
        use = np.isfinite(lasting) & (self._sum[3] > 0) & (better > shows / memory)
        return np.asarray(np.where(use, averages / 2.0, rows / (2.0 * memory)))

    def clear(self) -> None:
        """The fault is over."""
        self.fired = np.zeros_like(self.fired)
        self.most[:] = 0.0
        self._cusum.restart()
        self.scores.restart()
        self._sum[:] = self._held[:] = self._healthy[:] = 0.0
        self._away, self._gone = 0, self._needed

    def state(self) -> dict[str, Any]:
        """All that `resumed` needs, as plain JSON."""
        return {
            "fired": self.fired.tolist(),
            "most": numbers(self.most),
            **self._cusum.state(),
            "scores": self.scores.state(),
            "alarms": self.alarms,
            "pause": [self._needed, self._away, self._gone],
        }

    def resumed(self, state: dict[str, Any]) -> Detection:
        """The same in a state; raises KeyError, TypeError or ValueError for one of another kind."""
        other = Detection(self._names, self._least, pause=self._pause, scores=self.scores)
        other.fired = array(state["fired"], self.fired.shape) != 0.0
        other.most = array(state["most"], self.most.shape)
        other._age[:] = math.inf  # long ago
        other._cusum = self._cusum.resumed(state)
        if "scores" in state:  # none before 2026-11-30
            other.scores = self.scores.resumed(state["scores"])
        other.alarms = int(state["alarms"])
        other._needed, other._away, other._gone = (int(x) for x in state["pause"])
        return other


def _excess(value: Array, bound: Array, sigma: Array) -> Array:
    """By how many deviations values are beyond what is to be expected, on their side."""
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.asarray(np.sign(value) * np.maximum(np.abs(value) - bound, 0.0) / sigma)


def _explained(moved: Array, row: Row, excess: Array, sigma: Array) -> Array:
    """Which residuals are out, 1 or 0, and of these 1 where a fault that moves them so explains
    most of it, or -1: both (2, residuals)."""
    left = _excess(row.value - moved, row.bound, sigma)
    said = np.where(np.abs(left) <= 0.5 * np.abs(excess), 1.0, -1.0)
    return np.where((np.abs(excess) > _OUT) & np.isfinite(left), [np.ones_like(said), said], 0.0)


def _without(moved: Array, value: Array, bound: Array, sigma: Array) -> tuple[Array, Mask]:
    """By how much more probable values are without a fault that moves them so, and which tell.

    What is said of a move is wrong by a share of it. A fault that moves one by hardly more than is
    expected of a healthy machine tells nothing, nor does a row that is to be expected either way.
    NaN where nobody knows what the fault does, which is for others to tell.
    """
    left, excess = _excess(value - moved, bound, sigma), _excess(value, bound, sigma)
    with np.errstate(divide="ignore", invalid="ignore"):
        variance = 1.0 + (SHARE * moved / sigma) ** 2
        more = (np.log(variance) + left**2 / variance - excess**2) / 2.0
    clear = np.abs(moved) > bound + _LEAST * sigma
    return more, clear & ((left != 0.0) | (excess != 0.0))


def _gone(sums: Array, excess: Array, least: float) -> tuple[Array, Array]:
    """Twice by how much a row makes it more probable that a fault is gone, and that in the mean.

    It would go on with the mean and the variance that it has in the `sums`, of ones, values and
    squares, its mean no less than the `least`.
    """
    _, mean, square = sums / np.maximum(sums[0], 1.0)
    variance = np.maximum(square - mean**2, 1.0)
    mean = np.where(np.abs(mean) < least, np.copysign(least, mean), mean)
    more = np.log(variance) + (excess - mean) ** 2 / variance - excess**2
    return more, np.log(variance) + (1.0 + mean**2) / variance - 1.0
