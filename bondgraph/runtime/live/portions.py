"""Samples between the watch of a machine and its virtual twin: a short queue.

A watch of something that can wait (a simulation, a file) is held up by a full queue. One of a real
machine is not: what the twin was too slow for is handed back, and the twin is told that samples
are missing.
"""

from __future__ import annotations

import math
import time as clocks
from collections import deque
from collections.abc import Mapping
from threading import Condition, Event
from typing import Any

from bondgraph.runtime.log import Array
from bondgraph.text.tuples import NamedTuple

_MOST = 64  # portions
_LATE = 1.0  # s on the wall that one of them may wait
_AHEAD = 4  # portions, where the watch can wait
_FINISH = 1.0  # s that the twin may take for the last ones of a real machine


class Portion(NamedTuple):
    """Samples of one round: times in s, (n,), signals by name, (n,), and the frame of them.

    A `frame` of None begins the round; `skipped` samples before these have been left out.
    """

    round: int
    frame: dict[str, Any] | None
    time: Array
    told: Mapping[str, Array]
    skipped: int = 0
    since: float = 0.0  # on the wall, when it was put here


class Portions:
    """What the twin has still to follow; `waits` as above."""

    def __init__(self, waits: bool) -> None:
        self._waits = waits
        self._items: deque[Portion] = deque()
        self._changed = Condition()
        self._skipped = 0
        self._busy = False  # the twin is at one of them

    def begin(self, item: Portion) -> None:
        """A round begins: what was before it is no matter any more."""
        with self._changed:
            self._items.clear()
            self._items.append(item._replace(since=clocks.monotonic()))
            self._skipped = 0
            self._changed.notify_all()

    def put(self, item: Portion, stop: Event) -> list[Portion]:
        """Add samples; those that the twin is too slow for, oldest first."""
        late: list[Portion] = []
        with self._changed:
            while self._waits and len(self._items) >= _AHEAD and not stop.is_set():
                self._changed.wait(0.05)
            now = clocks.monotonic()
            waited = now - self._items[0].since if self._items and not self._waits else 0.0
            if len(self._items) >= _MOST or waited > _LATE:
                late = self._late()
            self._items.append(item._replace(skipped=self._skipped, since=now))
            self._skipped = 0
            self._changed.notify_all()
        return late

    def take(self, patience: float) -> Portion | None:
        """The next ones, None if there are none for so many s."""
        with self._changed:
            self._busy = False
            self._changed.notify_all()
            if not self._items:
                self._changed.wait(patience)
            if not self._items:
                return None
            self._busy = True
            return self._items.popleft()

    def finish(self, stop: Event) -> list[Portion]:
        """Wait until the twin has followed all; what a real machine cannot wait for, as `put`."""
        until = clocks.monotonic() + (math.inf if self._waits else _FINISH)
        with self._changed:
            while (self._items or self._busy) and not stop.is_set() and clocks.monotonic() < until:
                self._changed.wait(0.05)
            return self._late()

    def _late(self) -> list[Portion]:
        """Take out all samples that wait."""
        late = [old for old in self._items if old.frame is not None]
        self._items = deque(old for old in self._items if old.frame is None)
        self._skipped += sum(len(old.time) for old in late)
        return late
