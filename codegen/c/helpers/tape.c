/* One line of the recipe of a polynomial: row[target][k + shift] += scale * row[source][k]. */
typedef struct tape_op {
    uint32_t target, source, shift, scale, length;
    bool fresh; /* the target starts at zero */
} tape_op;

/* Lines that are run so many times, each time on so many coefficients more. */
typedef struct tape_run {
    uint32_t first, count, times, grow;
} tape_run;

static void run_tape_op(
    const tape_op *op, size_t length, const real *scales, real *rows, size_t width)
{
    const real *from = rows + op->source * width;
    real *to = rows + op->target * width;
    size_t k;

    for (k = 0; op->fresh && k < width; ++k) {
        to[k] = REAL(0.0);
    }
    for (k = 0; k < length; ++k) {
        to[k + op->shift] += scales[op->scale] * from[k];
    }
}

/* Runs a recipe on rows of `width` coefficients; row 0 starts as the polynomial 1. */
static void run_tape(const tape_op *ops, const tape_run *runs, size_t count, const real *scales,
    real *rows, size_t height, size_t width)
{
    size_t i;
    size_t j;
    size_t k;

    for (k = 0; k < height * width; ++k) {
        rows[k] = REAL(0.0);
    }
    rows[0] = REAL(1.0);
    for (i = 0; i < count; ++i) {
        for (j = 0; j < runs[i].times; ++j) {
            for (k = 0; k < runs[i].count; ++k) {
                const tape_op *op = &ops[runs[i].first + k];

                run_tape_op(op, op->length + j * runs[i].grow, scales, rows, width);
            }
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
