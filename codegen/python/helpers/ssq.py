def _signed_square(value: float) -> float:
    """value * |value|"""
    return -(value * value) if value < 0.0 else value * value
