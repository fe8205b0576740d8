/* Keeps a sample in a ring; from `length` on, `next` says that the ring is full. */
static void remember(real *past, uint32_t length, uint32_t *next, real value)
{
    past[*next % length] = value;
    ++*next;
    if (*next == 2u * length) {
        *next = length;
    }
}

/* What was kept so many samples ago, on a straight line between two; NaN while none is so old. */
static real recalled(const real *past, uint32_t length, uint32_t next, real back)
{
    const uint32_t whole = (uint32_t)(back + REAL(1.0e-6));
    const real part = back - (real)whole;
    const bool between = part > REAL(1.0e-6);
    real value;

    if (next < whole + (between ? 2u : 1u)) {
        return (real)NAN;
    }
    value = past[(next + length - 1u - whole) % length];
    return between ? value + part * (past[(next + length - 2u - whole) % length] - value) : value;
}
