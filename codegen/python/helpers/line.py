class _Line:
    """The last samples of a signal, in a ring."""

    def __init__(self, length: int) -> None:
        self._past = [math.nan] * length
        self._next = 0

    def keep(self, value: float) -> None:
        """Take the sample after the last one."""
        self._past[self._next % len(self._past)] = value
        self._next += 1

    def recalled(self, back: float) -> float:
        """What was kept so many samples ago, on a straight line between two; NaN while none is."""
        whole = int(back + 1e-6)
        part = back - whole
        if self._next < whole + (2 if part > 1e-6 else 1):
            return math.nan
        value = self._past[(self._next - 1 - whole) % len(self._past)]
        if part > 1e-6:
            value += part * (self._past[(self._next - 2 - whole) % len(self._past)] - value)
        return value
