/* loop.c: step in a loop over samples in memory; `loop FILE ROWS RUNS`, prints seconds and results. */
#define _POSIX_C_SOURCE 199309L
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

#include "khepera_residuals.h"
#include "khepera_threshold.h"

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
    khepera_threshold_samples *q = calloc(rows, sizeof *q);
    khepera_residuals *r = calloc(rows, sizeof *r);
    khepera_threshold_residuals *a = calloc(rows, sizeof *a);
    khepera_parameters p;
    khepera_threshold_parameters b;
    khepera_monitor monitor;
    khepera_threshold_monitor bounds;
    size_t k;
    int run;

    if (sizeof *s != 10 * sizeof(double) || !file || !s || !q || !r || !a) {
        return 1;
    }
    if (fread(s, sizeof *s, rows, file) != rows) {
        return 1;
    }
    for (k = 0; k < rows; ++k) {
        q[k].Fx__1 = s[k].Fx__1, q[k].Fx__2 = s[k].Fx__2;
        q[k].m__1__me__we = s[k].m__1__me__we, q[k].m__2__me__we = s[k].m__2__me__we;
        q[k].m__1__wh__ws = s[k].m__1__wh__ws, q[k].m__2__wh__ws = s[k].m__2__wh__ws;
    }
    khepera_nominal(&p);
    khepera_threshold_nominal(&b);
    for (run = 0; run < runs; ++run) {
        double start, middle, end;

        khepera_configure(&monitor, &p, 0.001, KHEPERA_BANDWIDTH, 1.0);
        khepera_threshold_configure(&bounds, &b, 0.001, KHEPERA_THRESHOLD_BANDWIDTH, 1.0);
        start = now();
        for (k = 0; k < rows; ++k) {
            khepera_step(&monitor, &s[k], &r[k]);
        }
        middle = now();
        for (k = 0; k < rows; ++k) {
            khepera_threshold_step(&bounds, &q[k], &a[k]);
        }
        end = now();
        printf("%.9f %.9f\n", middle - start, end - middle);
    }
    for (k = 0; k < KHEPERA_RESIDUALS; ++k) {
        printf("%.17g %.17g\n", r[rows - 1].value[k], a[rows - 1].value[k]);
    }
    return 0;
}
