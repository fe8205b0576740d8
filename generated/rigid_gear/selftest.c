/* selftest.c: does rigid_gear_residuals.c, compiled here, give what it must? */
#include <math.h>
#include <stdio.h>

#include "golden.h"

#ifdef RIGID_GEAR_FLOAT
#define TOLERANCE 1e-4f
#else
#define TOLERANCE 5e-13 /* so that C and Python are within 1e-12 of each other */
#endif

static const char *const name[RIGID_GEAR_RESIDUALS] = {
    "r1", "r2",
};

/* The error of a result by the sum of its terms; NaN and infinity are larger than anything. */
static rigid_gear_real relative_error(
    rigid_gear_real value, const golden_result *golden)
{
    const rigid_gear_real size = golden->size > 0 ? golden->size : 1;
    const rigid_gear_real off = (value - golden->value) / size;

    return off >= -1000 && off <= 1000 ? (off < 0 ? -off : off) : 1000;
}

static int judge(const char *what, const rigid_gear_real *worst)
{
    int failures = 0;
    int k;

    for (k = 0; k < RIGID_GEAR_RESIDUALS; ++k) {
        const bool pass = worst[k] <= TOLERANCE;

        printf("%s %s %s: error %.1e of the terms\n", pass ? "PASS" : "FAIL", what, name[k],
            (double)worst[k]);
        failures += pass ? 0 : 1;
    }
    return failures;
}

/* The residuals that read a sample which can be NaN. */
static const bool spoilt[RIGID_GEAR_RESIDUALS] = {
    true, true,
};

static int check_exact(const rigid_gear_monitor *monitor)
{
    rigid_gear_real worst[RIGID_GEAR_RESIDUALS] = {0};
    rigid_gear_real r[RIGID_GEAR_RESIDUALS] = {0};
    int at;
    int k;

    for (at = 0; at < GOLDEN_EXACT; ++at) {
        rigid_gear_exact(monitor, &golden_derivatives[at], r);
        for (k = 0; k < RIGID_GEAR_RESIDUALS; ++k) {
            const rigid_gear_real off = relative_error(r[k], &golden_exact[at][k]);

            worst[k] = off > worst[k] ? off : worst[k];
        }
    }
    return judge("exact", worst);
}

static int check_step(rigid_gear_monitor *monitor)
{
    rigid_gear_real worst[RIGID_GEAR_RESIDUALS] = {0};
    rigid_gear_residuals r;
    int at;
    int k;

    rigid_gear_reset(monitor);
    for (at = 0; at < GOLDEN_STEP; ++at) {
        rigid_gear_step(monitor, &golden_samples[at], &r);
        for (k = 0; k < RIGID_GEAR_RESIDUALS; ++k) {
            const rigid_gear_real off = relative_error(r.value[k], &golden_step[at][k]);

            worst[k] = off > worst[k] ? off : worst[k];
        }
    }
    return judge("step", worst);
}

/* A sample that is not a number is told, and after it everything starts anew. */
static int check_restart(rigid_gear_monitor *monitor)
{
    rigid_gear_samples bad = golden_samples[0];
    rigid_gear_residuals r;
    int failures = 0;
    int k;

    bad.T = (rigid_gear_real)NAN;
    bad.w1 = (rigid_gear_real)NAN;
    bad.w2 = (rigid_gear_real)NAN;
    rigid_gear_step(monitor, &bad, &r);
    for (k = 0; k < RIGID_GEAR_RESIDUALS; ++k) {
        failures += spoilt[k] && r.valid[k] ? 1 : 0;
    }
    printf("%s a sample that is not a number\n", failures ? "FAIL" : "PASS");
    return failures + check_step(monitor);
}

int main(void)
{
    rigid_gear_parameters parameters;
    rigid_gear_monitor monitor;
    rigid_gear_status status;
    int failures = 0;

    golden_parameters(&parameters);
    status = rigid_gear_configure(
        &monitor,
        &parameters,
        RIGID_GEAR_SAMPLE_TIME,
        RIGID_GEAR_BANDWIDTH,
        RIGID_GEAR_TIME_UNIT);
    if (status != RIGID_GEAR_OK) {
        printf("FAIL configure\n");
        return 1;
    }
    failures += check_exact(&monitor);
    failures += check_step(&monitor);
    failures += check_restart(&monitor);
    printf("%s\n", failures ? "FAIL" : "PASS");
    return failures ? 1 : 0;
}
