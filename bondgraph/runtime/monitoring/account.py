"""What became of all samples of a watch: numbers that add up, over restarts with a journal too."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Mapping
from typing import Any

import numpy as np
import numpy.typing as npt

from bondgraph.runtime.monitoring.clock import THROWN, Clock, Piece
from bondgraph.runtime.monitoring.residual_states import BLIND, STATES, WARMING, ResidualStates
from bondgraph.text.moment import lasting
from bondgraph.text.numerals import listed

#: Why a sample that was read is not used, besides those that the clock throws away: the machine
#: was off; the log does not have the columns.
_ELSE = ("off", "unmatched")

#: What else is counted: lines that are no samples, lines dropped before they were read, gaps, and
#: samples of the grid that are missing in them.
_LINES = ("garbage", "overflow", "gaps", "lost")
_OFTEN = 0.01  # share of the samples used without a number of a signal, above which it is said


class Account:
    """Counts of a watch.

    `read` samples are those `used`, and those that are not by each cause. Of those used come
    samples on the grid: of each residual as many in all its states together. `lost` are those that
    are missing on the grid between the first one and the last one. `missing` are those used that
    have no number of a signal, for each. `verdicts` are counted by event.
    """

    def __init__(self, states: ResidualStates, step: float, signals: Iterable[str]) -> None:
        self.samples = dict.fromkeys(("read", "used", *THROWN, *_ELSE), 0)
        self.lines = dict.fromkeys(_LINES, 0)
        self.missing = dict.fromkeys(signals, 0)
        self.verdicts: Counter[str] = Counter()
        self._states, self._step = states, step
        self.away = 0.0  # s, of all gaps

    def take(self, clock: Clock, before: Mapping[str, int], missing: npt.NDArray[np.int64]) -> None:
        """Add what the clock has done since it had these numbers; see `numbers`."""
        for name, now in numbers(clock).items():
            self.samples[name] += now - before[name]
        more = (clock.missing - missing).tolist()
        self.missing = {n: k + m for (n, k), m in zip(self.missing.items(), more, strict=True)}

    def gap(self, piece: Piece) -> None:
        """Samples are missing before a piece."""
        self.lines["gaps"] += 1
        if piece.gap is not None:
            self.lines["lost"] += piece.gap.lost
            self.away += max(0.0, piece.gap.end - piece.gap.start)

    @property
    def thrown(self) -> int:
        """Samples that were read and are not used, but for those while the machine was off."""
        return self.samples["read"] - self.samples["used"] - self.samples["off"]

    def unwatched(self) -> dict[str, float]:
        """For how many s each residual was warming up or blind, gaps among them."""
        found = self._states.samples
        idle = found[:, STATES.index(WARMING)] + found[:, STATES.index(BLIND)]
        names = self._states.residuals
        return {n: float(k) * self._step + self.away for n, k in zip(names, idle, strict=True)}

    def words(self) -> str:
        """For people: which signals often had no number, which residuals were not watched for how
        long; "" if nothing was missing and all always were."""
        alike: dict[float, list[str]] = {}
        for name, seconds in self.unwatched().items():
            if seconds > 0.0:
                alike.setdefault(seconds, []).append(name)
        parts = [f"{listed(n, 'and', 5)} for {lasting(t)}" for t, n in alike.items()]
        used = max(self.samples["used"], 1)
        often = {n: k / used for n, k in self.missing.items() if k > _OFTEN * used}
        bare = [f"{n} had no number in {100.0 * share:.3g} % of them" for n, share in often.items()]
        told = [f"blind or warming up: {listed(parts, 'and', 5)}"] if parts else []
        return "; ".join([*([listed(bare, "and", 5)] if bare else []), *told])

    def to_record(self) -> dict[str, Any]:
        """All of it as plain JSON."""
        grid = self._states.samples
        return {
            "samples": dict(self.samples),
            "lines": dict(self.lines),
            "missing": dict(self.missing),
            "away": round(self.away, 9),
            "step": self._step,
            "residuals": {
                name: dict(zip(STATES, grid[k].tolist(), strict=True))
                for k, name in enumerate(self._states.residuals)
            },
            "verdicts": dict(self.verdicts),
        }

    def resume(self, record: Mapping[str, Any]) -> None:
        """Go on from such a record; raises KeyError, TypeError or ValueError for another one."""
        samples = {n: int(record["samples"][n]) for n in self.samples}
        lines = {n: int(record["lines"][n]) for n in self.lines}
        grid = [[int(record["residuals"][n][s]) for s in STATES] for n in self._states.residuals]
        missing = {n: int(record["missing"][n]) for n in self.missing}
        self.samples, self.lines, self.away = samples, lines, float(record["away"])
        self.missing = missing
        self._states.samples[:] = np.array(grid, dtype=np.int64).reshape(len(grid), len(STATES))


def numbers(clock: Clock) -> dict[str, int]:
    """What a clock has counted, as the account names it."""
    return {"used": clock.used, "off": clock.left_out, **clock.thrown}
