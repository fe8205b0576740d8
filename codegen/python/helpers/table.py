def _interpolate(points: tuple[tuple[float, float], ...], value: float) -> float:
    """A table of x and y, straight between its points and constant beyond its ends."""
    if value <= points[0][0]:
        return points[0][1]
    if value >= points[-1][0]:
        return points[-1][1]
    k = 1
    while k + 1 < len(points) and value > points[k][0]:
        k += 1
    (x0, y0), (x1, y1) = points[k - 1], points[k]
    return y0 + (y1 - y0) * (value - x0) / (x1 - x0)
