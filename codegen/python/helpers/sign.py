def _sign(value: float) -> float:
    """-1, 0 or 1; NaN stays."""
    return 1.0 if value > 0.0 else -1.0 if value < 0.0 else value
