/* loop.c: step in a loop over samples in memory; `loop FILE ROWS RUNS`, prints seconds and results. */
#define _POSIX_C_SOURCE 199309L
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

#include "khepera.h"

static double now(void)
{
    struct timespec t;

    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

int main(int count, char **words)
{
    const size_t rows = count > 2 ? (size_t)atol(words[2]) : 0;
    const int runs = count > 3 ? atoi(words[3]) : 1;
    FILE *file = count > 1 ? fopen(words[1], "rb") : NULL;
    khepera_samples *s = calloc(rows, sizeof *s);
    khepera_residuals *r = calloc(rows, sizeof *r);
    khepera_residuals *a = calloc(rows, sizeof *a);
    const khepera_coefficients *c = &khepera_nominal_coefficients;
    const khepera_threshold_coefficients *b = &khepera_threshold_nominal_coefficients;
    khepera_memory memory;
    khepera_threshold_memory bounds;
    size_t k;
    int run;

    if (sizeof *s != 10 * sizeof(double) || !file || !s || !r || !a) {
        return 1;
    }
    if (fread(s, sizeof *s, rows, file) != rows) {
        return 1;
    }
    for (run = 0; run < runs; ++run) {
        double start, middle, end;

        khepera_reset(&memory);
        khepera_threshold_reset(&bounds);
        start = now();
        for (k = 0; k < rows; ++k) {
            khepera_step(c, &memory, &s[k], &r[k]);
        }
        middle = now();
        for (k = 0; k < rows; ++k) {
            khepera_threshold_step(b, &bounds, &s[k], &a[k]);
        }
        end = now();
        printf("%.9f %.9f\n", middle - start, end - middle);
    }
    for (k = 0; k < KHEPERA_RESIDUALS; ++k) {
        printf("%.17g %.17g\n", r[rows - 1].value[k], a[rows - 1].value[k]);
    }
    return 0;
}
