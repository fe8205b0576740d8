def _at(rows: tuple[tuple[float, ...], ...], y: float) -> tuple[tuple[float, float], ...]:
    """The table of x that a map is at y: its first row has the knots of y behind its corner."""
    knots = rows[0][1:]
    return tuple((x, _interpolate(tuple(zip(knots, line)), y)) for x, *line in rows[1:])
