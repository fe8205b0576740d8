def _run_tape(
    ops: tuple[tuple[int, int, int, int, int, bool], ...],
    runs: tuple[tuple[int, int, int, int], ...],
    scales: tuple[float, ...],
    height: int,
    width: int,
) -> list[list[float]]:
    """Run a recipe on rows of `width` coefficients; row 0 starts as the polynomial 1.

    One line of it says row[target][k + shift] += scales[scale] * row[source][k]. A run is `count`
    lines from `first` on, `times` times, each time on `grow` coefficients more.
    """
    rows = [[0.0] * width for _ in range(height)]
    rows[0][0] = 1.0
    for first, count, times, grow in runs:
        for j in range(times):
            for target, source, shift, scale, length, fresh in ops[first : first + count]:
                if fresh:
                    rows[target] = [0.0] * width
                row, other, factor = rows[target], rows[source], scales[scale]
                for k in range(length + j * grow):
                    row[k + shift] += factor * other[k]
    return rows
