#define ROWS(points) (sizeof(points) / sizeof((points)[0]))

/* A table of x and y, straight between its points and constant beyond its ends. */
static real interpolate(const real (*points)[2], size_t rows, real value)
{
    size_t k = 1;

    if (value <= points[0][0]) {
        return points[0][1];
    }
    if (value >= points[rows - 1][0]) {
        return points[rows - 1][1];
    }
    while (k + 1 < rows && value > points[k][0]) {
        ++k;
    }
    return points[k - 1][1] + (points[k][1] - points[k - 1][1]) * (value - points[k - 1][0])
        / (points[k][0] - points[k - 1][0]);
}
