/* selftest.c: does khepera_built_threshold.c, compiled here, give what it must? */
#include <math.h>
#include <stdio.h>

#include "golden.h"

#ifdef KHEPERA_BUILT_THRESHOLD_FLOAT
#define TOLERANCE 1e-4f
#else
#define TOLERANCE 5e-13 /* so that C and Python are within 1e-12 of each other */
#endif

static const char *const name[KHEPERA_BUILT_THRESHOLD_RESIDUALS] = {
    "r1", "r2", "r3",
};

/* The error of a result by the sum of its terms; NaN and infinity are larger than anything. */
static khepera_built_threshold_real relative_error(
    khepera_built_threshold_real value, const golden_result *golden)
{
    /* what exact does not have must be NaN */
    const bool none = !(golden->value <= 0 || golden->value >= 0);
    const bool nothing = !(value <= 0 || value >= 0);
    const khepera_built_threshold_real size = golden->size > 0 ? golden->size : 1;
    const khepera_built_threshold_real off = (value - golden->value) / size;

    if (none || nothing) {
        return none && nothing ? 0 : 1000;
    }
    return off >= -1000 && off <= 1000 ? (off < 0 ? -off : off) : 1000;
}

static int judge(const char *what, const khepera_built_threshold_real *worst)
{
    int failures = 0;
    int k;

    for (k = 0; k < KHEPERA_BUILT_THRESHOLD_RESIDUALS; ++k) {
        const bool pass = worst[k] <= TOLERANCE;

        printf("%s %s %s: error %.1e of the terms\n", pass ? "PASS" : "FAIL", what, name[k],
            (double)worst[k]);
        failures += pass ? 0 : 1;
    }
    return failures;
}

/* The residuals that read a sample which can be NaN. */
static const bool spoilt[KHEPERA_BUILT_THRESHOLD_RESIDUALS] = {
    true, true, false,
};

static int check_exact(const khepera_built_threshold_monitor *monitor)
{
    khepera_built_threshold_real worst[KHEPERA_BUILT_THRESHOLD_RESIDUALS] = {0};
    khepera_built_threshold_real r[KHEPERA_BUILT_THRESHOLD_RESIDUALS] = {0};
    int at;
    int k;

    for (at = 0; at < GOLDEN_EXACT; ++at) {
        khepera_built_threshold_exact(monitor, &golden_derivatives[at], r);
        for (k = 0; k < KHEPERA_BUILT_THRESHOLD_RESIDUALS; ++k) {
            const khepera_built_threshold_real off = relative_error(r[k], &golden_exact[at][k]);

            worst[k] = off > worst[k] ? off : worst[k];
        }
    }
    return judge("exact", worst);
}

static int check_step(khepera_built_threshold_monitor *monitor)
{
    khepera_built_threshold_real worst[KHEPERA_BUILT_THRESHOLD_RESIDUALS] = {0};
    khepera_built_threshold_residuals r;
    int at;
    int k;

    khepera_built_threshold_reset(monitor);
    for (at = 0; at < GOLDEN_STEP; ++at) {
        khepera_built_threshold_step(monitor, &golden_samples[at], &r);
        for (k = 0; k < KHEPERA_BUILT_THRESHOLD_RESIDUALS; ++k) {
            const khepera_built_threshold_real off = relative_error(r.value[k], &golden_step[at][k]);

            worst[k] = off > worst[k] ? off : worst[k];
        }
    }
    return judge("step", worst);
}

/* A sample that is not a number is told, and after it everything starts anew. */
static int check_restart(khepera_built_threshold_monitor *monitor)
{
    khepera_built_threshold_samples bad = golden_samples[0];
    khepera_built_threshold_residuals r;
    int failures = 0;
    int k;

    bad.Fx__1 = (khepera_built_threshold_real)NAN;
    bad.Fx__2 = (khepera_built_threshold_real)NAN;
    khepera_built_threshold_step(monitor, &bad, &r);
    for (k = 0; k < KHEPERA_BUILT_THRESHOLD_RESIDUALS; ++k) {
        failures += spoilt[k] && r.valid[k] ? 1 : 0;
    }
    printf("%s a sample that is not a number\n", failures ? "FAIL" : "PASS");
    return failures + check_step(monitor);
}

int main(void)
{
    khepera_built_threshold_parameters parameters;
    khepera_built_threshold_monitor monitor;
    khepera_built_threshold_status status;
    int failures = 0;

    golden_parameters(&parameters);
    status = khepera_built_threshold_configure(
        &monitor,
        &parameters,
        KHEPERA_BUILT_THRESHOLD_SAMPLE_TIME,
        KHEPERA_BUILT_THRESHOLD_BANDWIDTH,
        KHEPERA_BUILT_THRESHOLD_TIME_UNIT);
    if (status != KHEPERA_BUILT_THRESHOLD_OK) {
        printf("FAIL configure\n");
        return 1;
    }
    failures += check_exact(&monitor);
    failures += check_step(&monitor);
    failures += check_restart(&monitor);
    printf("%s\n", failures ? "FAIL" : "PASS");
    return failures ? 1 : 0;
}
