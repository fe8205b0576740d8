def _power(base: float, exponent: int) -> float:
    """base to a whole exponent, by squaring."""
    result = 1.0
    left = abs(exponent)
    while left > 0:
        if left % 2 == 1:
            result *= base
        base *= base
        left //= 2
    return 1.0 / result if exponent < 0 else result
