"""When to tell of something that happens again and again: as it happens, and never as a flood."""

from __future__ import annotations

_QUIET = 30.0  # s without it, after which it is new, and as many warm-ups as
_AGAIN = 10.0  # so that residuals are blind for a tenth of the time by what goes on
_PAUSE = 60.0  # s until it is told again, however few there were
_LONGEST = 3600.0  # s between two words on what goes on


class Recurrence:
    """Counts what recurs, and says when there is something to tell.

    That is the first time, whenever the number has doubled, and at the latest a minute later, then
    two, four, ... up to an hour, while it goes on. After half a minute without it, or ten times the
    `warm_up` (s) of slower residuals, the count begins anew. Times are in s, of any clock; where it
    goes back, all is new.

    >>> one = Recurrence()
    >>> [one.due(t) for t in range(6) if one.add(1, t) is None]
    [1, 2, 0, 4, 0, 0]
    >>> one.due(70.0), one.due(71.0)
    (6, 0)
    """

    def __init__(self, warm_up: float = 0.0) -> None:
        self._quiet = max(_QUIET, _AGAIN * warm_up)
        self._last = self._said = float("-inf")
        self.count = self._told = 0
        self._pause = _PAUSE

    def add(self, number: int, now: float) -> None:
        """It has happened so many times more."""
        untold = self.count - self._told
        if not untold and (now - self._last > self._quiet or now < self._last):
            self.count = self._told = 0
            self._pause = _PAUSE
        self.count += number
        self._last = now

    def due(self, now: float) -> int:
        """The count, if it is to be told now, and then it counts as told; else 0."""
        if self.count == self._told:
            return 0
        late = now - self._said >= self._pause or now < self._said
        if self._told and self.count < 2 * self._told and not late:
            return 0
        if self._told and late:
            self._pause = min(2.0 * self._pause, _LONGEST)
        self._told, self._said = self.count, now
        return self.count
