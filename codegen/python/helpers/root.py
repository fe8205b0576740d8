class _Search:
    """The search for a root: x, and on which sides it lies, if they are known."""

    def __init__(self, guess: float, rising: bool) -> None:
        self.x = self.guess = guess
        self.rising = rising
        self.low, self.high = -math.inf, math.inf
        self.wide = 1.0
        self.last = math.inf

    def found(self, value: float, slope: float) -> bool:
        """One step from the value and slope at x; true when x is the root.

        Newton's step where it stays between the sides and halves the value, else half way, else a
        wider step to the open side.
        """
        if value == 0.0:
            return True
        up = self.x > self.guess if math.isnan(value) else (value > 0.0) == self.rising
        if up:
            self.high = self.x
        else:
            self.low = self.x
        after = self.x - value / slope if slope and math.isfinite(slope) else math.nan
        slow = not abs(value) <= 0.5 * self.last
        closed = math.isfinite(self.low) and math.isfinite(self.high)
        if not self.low < after < self.high or (slow and closed):
            if closed:
                after = self.low + 0.5 * (self.high - self.low)
            else:
                after = self.x - self.wide if up else self.x + self.wide
                self.wide *= 2.0
        self.last = abs(value) if math.isfinite(value) else math.inf
        near = self.x + 0.125 * (after - self.x) == self.x
        near = near or self.high - self.low <= 1e-36 * self.wide
        self.x = after
        return near
