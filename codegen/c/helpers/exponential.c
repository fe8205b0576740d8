/* exp(value) to the last digit or two, without a library: 2^n times the series of the rest. */
static real exponential(real value)
{
    const real ln2_high = REAL(0.693145751953125); /* few bits: n * ln2_high is exact */
    const real ln2_low = REAL(1.4286068203094173e-06);
    real rest;
    real scale = REAL(1.0);
    real sum = REAL(1.0);
    int n = 0;
    int k;

    if (value > REAL(1000.0)) {
        value = REAL(1000.0); /* more than enough for infinity */
    }
    if (value < REAL(-1000.0)) {
        value = REAL(-1000.0); /* more than enough for zero */
    }
    rest = value;
    while (rest > REAL(0.35)) {
        ++n;
        scale *= REAL(2.0);
        rest = value - (real)n * ln2_high;
    }
    while (rest < REAL(-0.35)) {
        --n;
        scale *= REAL(0.5);
        rest = value - (real)n * ln2_high;
    }
    rest -= (real)n * ln2_low;
    for (k = 14; k > 0; --k) {
        sum = REAL(1.0) + sum * rest / (real)k;
    }
    return sum * scale;
}
