def _interpolate_map(rows: tuple[tuple[float, ...], ...], x: float, y: float) -> float:
    """A map of x and y: the table of x that it is at y."""
    return _interpolate(_at(rows, y), x)
