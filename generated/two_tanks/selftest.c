/* selftest.c: does two_tanks_residuals.c, compiled here, give what it must? */
#include <math.h>
#include <stdio.h>

#include "golden.h"

#ifdef TWO_TANKS_FLOAT
#define TOLERANCE 1e-4f
#else
#define TOLERANCE 5e-13 /* so that C and Python are within 1e-12 of each other */
#endif

static const char *const name[TWO_TANKS_RESIDUALS] = {
    "r1", "r2",
};

/* The error of a result by the sum of its terms; NaN and infinity are larger than anything. */
static two_tanks_real relative_error(
    two_tanks_real value, const golden_result *golden)
{
    const two_tanks_real size = golden->size > 0 ? golden->size : 1;
    const two_tanks_real off = (value - golden->value) / size;

    return off >= -1000 && off <= 1000 ? (off < 0 ? -off : off) : 1000;
}

static int judge(const char *what, const two_tanks_real *worst)
{
    int failures = 0;
    int k;

    for (k = 0; k < TWO_TANKS_RESIDUALS; ++k) {
        const bool pass = worst[k] <= TOLERANCE;

        printf("%s %s %s: error %.1e of the terms\n", pass ? "PASS" : "FAIL", what, name[k],
            (double)worst[k]);
        failures += pass ? 0 : 1;
    }
    return failures;
}

/* The residuals that read a sample which can be NaN. */
static const bool spoilt[TWO_TANKS_RESIDUALS] = {
    true, true,
};

static int check_exact(const two_tanks_monitor *monitor)
{
    two_tanks_real worst[TWO_TANKS_RESIDUALS] = {0};
    two_tanks_real r[TWO_TANKS_RESIDUALS] = {0};
    int at;
    int k;

    for (at = 0; at < GOLDEN_EXACT; ++at) {
        two_tanks_exact(monitor, &golden_derivatives[at], r);
        for (k = 0; k < TWO_TANKS_RESIDUALS; ++k) {
            const two_tanks_real off = relative_error(r[k], &golden_exact[at][k]);

            worst[k] = off > worst[k] ? off : worst[k];
        }
    }
    return judge("exact", worst);
}

static int check_step(two_tanks_monitor *monitor)
{
    two_tanks_real worst[TWO_TANKS_RESIDUALS] = {0};
    two_tanks_residuals r;
    int at;
    int k;

    two_tanks_reset(monitor);
    for (at = 0; at < GOLDEN_STEP; ++at) {
        two_tanks_step(monitor, &golden_samples[at], &r);
        for (k = 0; k < TWO_TANKS_RESIDUALS; ++k) {
            const two_tanks_real off = relative_error(r.value[k], &golden_step[at][k]);

            worst[k] = off > worst[k] ? off : worst[k];
        }
    }
    return judge("step", worst);
}

/* A sample that is not a number is told, and after it everything starts anew. */
static int check_restart(two_tanks_monitor *monitor)
{
    two_tanks_samples bad = golden_samples[0];
    two_tanks_residuals r;
    int failures = 0;
    int k;

    bad.Q = (two_tanks_real)NAN;
    bad.p1 = (two_tanks_real)NAN;
    bad.p2 = (two_tanks_real)NAN;
    two_tanks_step(monitor, &bad, &r);
    for (k = 0; k < TWO_TANKS_RESIDUALS; ++k) {
        failures += spoilt[k] && r.valid[k] ? 1 : 0;
    }
    printf("%s a sample that is not a number\n", failures ? "FAIL" : "PASS");
    return failures + check_step(monitor);
}

int main(void)
{
    two_tanks_parameters parameters;
    two_tanks_monitor monitor;
    two_tanks_status status;
    int failures = 0;

    golden_parameters(&parameters);
    status = two_tanks_configure(
        &monitor,
        &parameters,
        TWO_TANKS_SAMPLE_TIME,
        TWO_TANKS_BANDWIDTH,
        TWO_TANKS_TIME_UNIT);
    if (status != TWO_TANKS_OK) {
        printf("FAIL configure\n");
        return 1;
    }
    failures += check_exact(&monitor);
    failures += check_step(&monitor);
    failures += check_restart(&monitor);
    printf("%s\n", failures ? "FAIL" : "PASS");
    return failures ? 1 : 0;
}
