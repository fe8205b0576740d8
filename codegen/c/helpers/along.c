{% if "table" not in helpers %}
#define ROWS(points) (sizeof(points) / sizeof((points)[0]))

{% endif %}
/* What a row of a map is at y: the first row has the knots of y behind its corner. */
static real along(const real *map, const real *row, size_t columns, real y)
{
    size_t k = 2;

    if (y <= map[1]) {
        return row[1];
    }
    if (y >= map[columns - 1]) {
        return row[columns - 1];
    }
    while (k + 1 < columns && y > map[k]) {
        ++k;
    }
    return row[k - 1] + (row[k] - row[k - 1]) * (y - map[k - 1]) / (map[k] - map[k - 1]);
}
