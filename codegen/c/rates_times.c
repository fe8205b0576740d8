/* A matrix times a vector. */
static void times(int size, const real *matrix, const real *vector, real *out)
{
    int i, k;

    for (i = 0; i < size; ++i) {
        out[i] = REAL(0.0);
        for (k = 0; k < size; ++k) {
            out[i] += matrix[i * size + k] * vector[k];
        }
    }
}
