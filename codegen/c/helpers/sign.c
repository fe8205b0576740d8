/* -1, 0 or 1; NaN stays. */
static real sign(real value)
{
    return value > REAL(0.0) ? REAL(1.0) : value < REAL(0.0) ? REAL(-1.0) : value;
}
