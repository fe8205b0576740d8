/* The sum of coefficients times derivatives. */
static real dot(const real *coefficients, const real *derivatives, size_t length)
{
    real sum = REAL(0.0);
    size_t k;

    for (k = 0; k < length; ++k) {
        sum += coefficients[k] * derivatives[k];
    }
    return sum;
}
