/* A map of x and y: the table of x that it is at y, straight between knots, constant beyond. */
static real interpolate_map(const real *map, size_t rows, size_t columns, real x, real y)
{
    const real *row = map + columns, *last = map + (rows - 1) * columns;
    real value;

    if (x <= row[0]) {
        return along(map, row, columns, y);
    }
    if (x >= last[0]) {
        return along(map, last, columns, y);
    }
    do {
        row += columns;
    } while (row < last && x > row[0]);
    value = along(map, row - columns, columns, y);
    return value + (along(map, row, columns, y) - value) * (x - (row - columns)[0])
        / (row[0] - (row - columns)[0]);
}
