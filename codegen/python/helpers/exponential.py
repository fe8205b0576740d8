def _exponential(value: float) -> float:
    """exp(value), digit for digit as the C code does it: 2^n times the series of the rest."""
    ln2_high = 0.693145751953125  # few bits: n * ln2_high is exact
    ln2_low = 1.4286068203094173e-06
    value = max(-1000.0, min(1000.0, value)) if value == value else value
    n, scale, rest, sum_ = 0, 1.0, value, 1.0
    while rest > 0.35:
        n += 1
        scale *= 2.0
        rest = value - n * ln2_high
    while rest < -0.35:
        n -= 1
        scale *= 0.5
        rest = value - n * ln2_high
    rest -= n * ln2_low
    for k in range(14, 0, -1):
        sum_ = 1.0 + sum_ * rest / k
    return sum_ * scale
