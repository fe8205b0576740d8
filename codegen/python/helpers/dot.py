def _dot(coefficients: Sequence[float], derivatives: Sequence[float], length: int) -> float:
    """The sum of coefficients times derivatives, in this order."""
    total = 0.0
    for k in range(length):
        total += coefficients[k] * derivatives[k]
    return total
