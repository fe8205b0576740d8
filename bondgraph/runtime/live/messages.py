"""What a page is told of both machines, from the thread of each, in the order of time."""

from __future__ import annotations

import math
import time as clocks
from collections.abc import Callable
from threading import RLock
from typing import Any

import numpy as np

from bondgraph.runtime.monitoring.engine import Batch
from bondgraph.runtime.monitoring.verdict import Verdict, described

Say = Callable[[dict[str, Any]], None]

FRAMES = 20.0  # a second
_APART = 0.8 / FRAMES  # s on the wall, at least; samples that come oftener share a frame
_PACED = 2.0  # s on the wall between two words on how fast it goes


class Messages:
    """Tells `say`; what belongs to a round that is over is not told any more.

    Frames that come oftener than a page can show them share one; none is told after a newer one.
    """

    def __init__(self, say: Say) -> None:
        self._say = say
        self._lock = RLock()
        self._round = self._number = 0
        self._state: dict[str, Any] = {}
        self._waiting: dict[str, Any] | None = None  # a frame that is not full
        self._newest = -math.inf  # s, of the newest frame
        self._framed = 0.0  # on the wall, when the last one was told
        self._paced = 0.0  # on the wall, when the pace was told

    def begin(self) -> int:
        """All begins anew; the number of the round."""
        with self._lock:
            self._round += 1
            self._waiting, self._newest = None, -math.inf
            self._say({"type": "reset"})
            return self._round

    def faults(self, number: int, active: list[str]) -> None:
        """What is injected now."""
        with self._lock:
            if number == self._round:
                self._say({"type": "faults", "active": active})

    def refused(self, why: str) -> None:
        """Something that was wished cannot be done, and who wished it is not known."""
        self._say({"type": "refused", "message": why})

    # ---------------------------------------------------------------------------- frames

    def frame(self, number: int, frame: dict[str, Any]) -> None:
        """Samples have been decided on."""
        with self._lock:
            if number != self._round or frame["t"] < self._newest:
                return
            self._newest = frame["t"]
            self._waiting = frame if self._waiting is None else _merged(self._waiting, frame)
            self.flush()

    def flush(self, at_once: bool = False) -> None:
        """Tell what has gathered since the last frame, if that was long enough ago."""
        with self._lock:
            if self._waiting is None:
                return
            if at_once or clocks.monotonic() - self._framed > _APART:
                self._framed = clocks.monotonic()
                self._say(self._waiting)
                self._waiting = None

    # ----------------------------------------------------------------------------- words

    def state(self, state: str, text: str, pace: float | None = None) -> None:
        """Whether samples come, and how fast."""
        with self._lock:
            self.flush(at_once=True)
            message = {"type": "state", "state": state, "text": text, "pace": pace}
            if message != self._state:
                self._state = message
                self._say(message)

    def pace(self, pace: float | None, speed: float | None) -> None:
        """Tell whether samples keep up with the time on the wall, at most every 2 s."""
        with self._lock:
            now = clocks.monotonic()
            slow = speed is not None and pace is not None and pace < 0.85 * speed
            if slow == (self._state["state"] == "slow") and now - self._paced < _PACED:
                return
            self._paced = now
            if slow and pace is not None:
                text = f"slower than it should be: × {pace:.1f} instead of × {speed:g}"
                self.state("slow", text, round(pace, 1))
            else:
                self.state("running", "", speed)

    def verdict(self, number: int, whose: str, verdict: Verdict) -> None:
        """Something was found out about a machine, `real` or `virtual`."""
        with self._lock:
            if number != self._round:
                return
            self._number += 1
            self._say({
                "type": "verdict",
                "number": self._number,
                "whose": whose,
                "event": verdict.event,
                "time": short(verdict.time),
                "since": None if verdict.since is None else short(verdict.since),
                "fired": list(verdict.residuals),
                "group": list(verdict.group),
                "candidates": [
                    [c.fault, None if c.size is None else short(c.size), c.unit,
                     round(c.probability, 4), None if c.stands is None else short(c.stands)]
                    for c in verdict.candidates
                ],
                "message": verdict.message or described(verdict),
            })  # fmt: skip


def _merged(before: dict[str, Any], after: dict[str, Any]) -> dict[str, Any]:
    """One frame of two that follow each other: what is at the end, and the range of residuals."""
    for whose in ("real", "virtual"):
        pairs = zip(before[whose].get("r", ()), after[whose].get("r", ()), strict=False)
        for old, new in pairs:
            if None not in (old[0], new[0]):
                new[:2] = [min(old[0], new[0]), max(old[1], new[1])]
                new[2] = max((x[2] for x in (old, new) if x[2] is not None), default=None)
                new[3] = old[3] or new[3]
    return after


def strips(batch: Batch) -> list[list[float | bool | None]]:
    """Of each residual in these samples the least and the largest value, the whole threshold, and
    whether one of them is further out."""
    found: list[list[float | bool | None]] = []
    for k in range(batch.value.shape[1]):
        good = batch.valid[:, k]
        if not good.any():
            found.append([None, None, None, False])
            continue
        value, bound = batch.value[good, k], batch.bound[good, k]
        out = bool((np.abs(value) > bound).any())
        limit = short(float(bound.max()))
        found.append([short(float(value.min())), short(float(value.max())), limit, out])
    return found


def short(value: float) -> float | None:
    """A number as a page needs it: five digits, None for what is none."""
    return float(f"{value:.5g}") if math.isfinite(value) else None
