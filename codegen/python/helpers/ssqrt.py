def _signed_root(value: float) -> float:
    """sign(value) * sqrt(|value|)"""
    return -math.sqrt(-value) if value < 0.0 else math.sqrt(value)
