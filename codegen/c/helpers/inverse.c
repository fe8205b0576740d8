/* The x at which a map is z for this y; it rises or falls with x, and from its ends on has none. */
static real invert_map(const real *map, size_t rows, size_t columns, real z, real y)
{
    const real *row = map + columns, *end = map + (rows - 1) * columns, *after;
    real low = along(map, row, columns, y), high = along(map, end, columns, y), margin;
    const bool falls = high < low;

    if (falls) {
        after = row;
        row = end;
        end = after;
        margin = low;
        low = high;
        high = margin;
    }
    margin = REAL(1.0e-9) * (high - low);
    if (!(z > low + margin && z < high - margin)) {
        return (real)NAN;
    }
    for (;;) {
        after = falls ? row - columns : row + columns;
        high = along(map, after, columns, y);
        if (after == end || z <= high) {
            return row[0] + (after[0] - row[0]) * (z - low) / (high - low);
        }
        row = after;
        low = high;
    }
}
