"""A live source that gives nothing, by the clock of this computer."""

from __future__ import annotations

from collections import deque

_PAUSES, _FEW, _USUAL = 16, 4, 2  # of so many of the last pauses the second longest is a usual one
_TIMES = 3.0  # so many usual pauses, or steps of the samples, are no silence
_AGAIN = 10.0  # times as long, until it is told again


class Silence:
    """Says when a source has been silent for too long: `most` s, or three of its usual pauses.

    Whoever sends a minute of samples together is silent between. So of the last sixteen pauses, and
    four at least, the second longest is a usual one: a single long one is none. `step` is the time
    between two samples; all times in s, on one monotonic clock.
    """

    def __init__(self, most: float, step: float, now: float) -> None:
        self._most = max(most, _TIMES * step)
        self._pauses: deque[float] = deque(maxlen=_PAUSES)
        self._heard = now
        self._told = 0.0  # for how long it was silent when that was told last

    @property
    def limit(self) -> float:
        """For how long it may be silent."""
        longest = sorted(self._pauses)[-_USUAL:]
        usual = longest[0] if len(self._pauses) >= _FEW else 0.0
        return max(self._most, _TIMES * usual)

    @property
    def told(self) -> bool:
        """Whether it is silent, and that was said."""
        return self._told > 0.0

    def lasts(self, now: float) -> float:
        """For how long nothing has come."""
        return max(0.0, now - self._heard)

    def due(self, now: float) -> float:
        """For how long it has been silent, if that is to be told now; else 0.

        It is told again whenever that is ten times as long.
        """
        lasts = self.lasts(now)
        if lasts <= self.limit or lasts < _AGAIN * self._told:
            return 0.0
        self._told = lasts
        return lasts

    def heard(self, now: float) -> float:
        """Samples have come; after how long, if it was told that none came, else 0."""
        lasts, told = self.lasts(now), self.told
        self._pauses.append(lasts)
        self._heard, self._told = now, 0.0
        return lasts if told else 0.0

    def awake(self, now: float) -> None:
        """What has come was computed until now: that took its time, and nobody listened."""
        self._heard = now
