def _invert_map(rows: tuple[tuple[float, ...], ...], z: float, y: float) -> float:
    """The x at which a map is z for this y; it rises or falls with x, and from its ends on has none."""
    points = tuple(sorted((value, x) for x, value in _at(rows, y)))
    low, high = points[0][0], points[-1][0]
    margin = 1e-9 * (high - low)
    return _interpolate(points, z) if low + margin < z < high - margin else math.nan
