def _run_tape(
    ops: tuple[tuple[int, int, int, int, int, bool], ...],
    scales: tuple[float, ...],
    height: int,
    width: int,
) -> list[list[float]]:
    """Run a recipe on rows of `width` coefficients; row 0 starts as the polynomial 1.

    One line of it says row[target][k + shift] += scales[scale] * row[source][k].
    """
    rows = [[0.0] * width for _ in range(height)]
    rows[0][0] = 1.0
    for target, source, shift, scale, length, fresh in ops:
        if fresh:
            rows[target] = [0.0] * width
        row, other, factor = rows[target], rows[source], scales[scale]
        for k in range(length):
            row[k + shift] += factor * other[k]
    return rows
