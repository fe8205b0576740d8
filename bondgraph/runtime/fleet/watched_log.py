"""What came of one log of a fleet: its verdicts, its span, how far residuals were out."""

from __future__ import annotations

import json
from collections.abc import Iterable, Sequence
from typing import Any

import numpy as np

from bondgraph.runtime.log import Array, Mask
from bondgraph.runtime.monitoring.engine import Batch
from bondgraph.runtime.monitoring.residual_states import Told
from bondgraph.runtime.monitoring.verdict import Verdict, from_record, to_json
from bondgraph.text.numerals import listed
from bondgraph.text.tuples import NamedTuple

FAULT, CLEARED, HEALTHY, UNWATCHED, BAD = "fault", "cleared", "healthy", "not watched", "bad"


class WatchedLog(NamedTuple):
    """What was said of one log.

    `start` and `end` are the first and the last time that was decided on, in s. `residual` was
    furthest out, at `level` times its threshold; None where no sample was watched. `notes` are
    short words on what is missing; a log that is bad has an `error` behind the verdicts until
    then. `told` is what a single watch says on the error stream. By its `key` it is known again.
    """

    log: str
    verdicts: tuple[Verdict, ...] = ()
    start: float | None = None
    end: float | None = None
    residual: str = ""
    level: float | None = None
    notes: tuple[str, ...] = ()
    error: str = ""
    told: tuple[str, ...] = ()
    key: str = ""

    @property
    def state(self) -> str:
        """At its end: `fault` while one is latched, `cleared`, `healthy`, `not watched` or `bad`.

        >>> WatchedLog("a.csv", (Verdict("fault", 3.0), Verdict("cleared", 5.0))).state
        'cleared'
        """
        if self.error:
            return BAD
        turns = [v.event for v in self.verdicts if v.event in ("fault", "cleared")]
        if turns:
            return CLEARED if turns[-1] == "cleared" else FAULT
        return UNWATCHED if self.level is None else HEALTHY

    @property
    def alarms(self) -> int:
        """How many faults were told."""
        return sum(v.event == "fault" for v in self.verdicts)

    @property
    def last_alarm(self) -> Verdict | None:
        """The newest verdict about the last alarm that says what it is, else its first one.

        >>> first, named = Verdict("fault", 3.0, 2.9), Verdict("update", 3.9, 2.9, {}, ("J", "f"))
        >>> WatchedLog("a.csv", (first, named, Verdict("update", 4.9, 2.9))).last_alarm == named
        True
        """
        found = None
        for verdict in self.verdicts:
            named = verdict.event == "update" and (verdict.group or verdict.pairs)
            if verdict.event == "fault" or named:
                found = verdict
        return found

    def to_record(self) -> dict[str, Any]:
        """The same as plain JSON."""
        said = [json.loads(to_json(v, k)) for k, v in enumerate(self.verdicts, start=1)]
        return {**self._asdict(), "verdicts": said}


def from_json_record(record: dict[str, Any]) -> WatchedLog:
    """What was written so; raises KeyError, TypeError or ValueError for anything else.

    >>> one = WatchedLog("a.csv", (Verdict("stop", 12.5),), 0.0, 12.5, "r1", 0.4, ("1 gap",))
    >>> from_json_record(one.to_record()) == one
    True
    """
    said = tuple(from_record(v)[1] for v in record["verdicts"])
    lists = {name: tuple(map(str, record[name])) for name in ("notes", "told")}
    return WatchedLog(**{**record, "verdicts": said, **lists})


class Extent:
    """Hears every sample of a watch: from when to when it was, and how far residuals were out.

    `used` says of which residuals that counts.
    """

    def __init__(self, residuals: Sequence[str], used: Iterable[str]) -> None:
        self._residuals, wanted = tuple(residuals), frozenset(used)
        self._used: Mask = np.array([name in wanted for name in residuals], dtype=np.bool_)
        self._most: Array = np.full(len(self._residuals), -1.0)  # below what any watched one is at
        self._blind: Mask = np.zeros(len(self._residuals), dtype=np.bool_)  # at the end
        self.start: float | None = None
        self.end: float | None = None

    def add(self, time: Array, decided: Batch, told: Told) -> None:
        """Further samples."""
        known = decided.valid & np.isfinite(decided.bound)
        with np.errstate(divide="ignore", invalid="ignore"):
            level = np.abs(decided.value) / decided.bound
        level = np.where(known, np.where(np.isnan(level), 0.0, level), -1.0)  # 0/0 is no alarm
        self._most = np.maximum(self._most, level.max(axis=0, initial=-1.0))
        self._blind = np.isnan(decided.bound[-1])
        self.start = min(float(time[0]), float("inf") if self.start is None else self.start)
        self.end = max(float(time[-1]), float("-inf") if self.end is None else self.end)

    @property
    def worst(self) -> tuple[str, float | None]:
        """The residual that was furthest out, and at how many times its threshold."""
        most = np.where(self._used, self._most, -1.0)
        if not len(most) or most.max() < 0.0:
            return "", None
        at = int(most.argmax())
        return self._residuals[at], float(f"{most[at]:.4g}")

    @property
    def unwatched(self) -> str:
        """The residuals that were not watched at all, or whose noise is unknown at the end."""
        lost = self._used & ((self._most < 0.0) | self._blind)
        return listed([n for n, own in zip(self._residuals, lost, strict=True) if own], "and")
