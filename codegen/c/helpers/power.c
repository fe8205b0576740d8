/* base to a whole exponent, by squaring. */
static real power(real base, int exponent)
{
    real result = REAL(1.0);
    int left = exponent < 0 ? -exponent : exponent;

    for (; left > 0; left /= 2) {
        if (left % 2 == 1) {
            result *= base;
        }
        base *= base;
    }
    return exponent < 0 ? REAL(1.0) / result : result;
}
