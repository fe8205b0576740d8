/* One line of the recipe of a polynomial: row[target][k + shift] += scale * row[source][k]. */
typedef struct tape_op {
    uint32_t target, source, shift, scale, length;
    bool fresh; /* the target starts at zero */
} tape_op;

/* Runs a recipe on rows of `width` coefficients; row 0 starts as the polynomial 1. */
static void run_tape(
    const tape_op *ops, size_t count, const real *scales, real *rows, size_t height, size_t width)
{
    size_t i;
    size_t k;

    for (k = 0; k < height * width; ++k) {
        rows[k] = REAL(0.0);
    }
    rows[0] = REAL(1.0);
    for (i = 0; i < count; ++i) {
        const tape_op *op = &ops[i];
        const real *from = rows + op->source * width;
        real *to = rows + op->target * width;

        for (k = 0; op->fresh && k < width; ++k) {
            to[k] = REAL(0.0);
        }
        for (k = 0; k < op->length; ++k) {
            to[k + op->shift] += scales[op->scale] * from[k];
        }
    }
}

/* Copies the first coefficients of a row. */
static void keep(real *coefficients, const real *row, size_t length)
{
    size_t k;

    for (k = 0; k < length; ++k) {
        coefficients[k] = row[k];
    }
}
