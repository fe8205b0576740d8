/* selftest.c: does khepera_plausible_residuals.c, compiled here, give what it must? */
#include <math.h>
#include <stdio.h>

#include "golden.h"

#ifdef KHEPERA_PLAUSIBLE_FLOAT
#define TOLERANCE 1e-4f
#else
#define TOLERANCE 5e-13 /* so that C and Python are within 1e-12 of each other */
#endif

static const char *const name[KHEPERA_PLAUSIBLE_RESIDUALS] = {
    "r1", "r2", "r3", "r4", "r5",
};

/* The error of a result by the sum of its terms; NaN and infinity are larger than anything. */
static khepera_plausible_real relative_error(
    khepera_plausible_real value, const golden_result *golden)
{
    const khepera_plausible_real size = golden->size > 0 ? golden->size : 1;
    const khepera_plausible_real off = (value - golden->value) / size;

    return off >= -1000 && off <= 1000 ? (off < 0 ? -off : off) : 1000;
}

static int judge(const char *what, const khepera_plausible_real *worst)
{
    int failures = 0;
    int k;

    for (k = 0; k < KHEPERA_PLAUSIBLE_RESIDUALS; ++k) {
        const bool pass = worst[k] <= TOLERANCE;

        printf("%s %s %s: error %.1e of the terms\n", pass ? "PASS" : "FAIL", what, name[k],
            (double)worst[k]);
        failures += pass ? 0 : 1;
    }
    return failures;
}

/* The residuals that read a sample which can be NaN. */
static const bool spoilt[KHEPERA_PLAUSIBLE_RESIDUALS] = {
    true, true, true, true, true,
};

static int check_exact(const khepera_plausible_monitor *monitor)
{
    khepera_plausible_real worst[KHEPERA_PLAUSIBLE_RESIDUALS] = {0};
    khepera_plausible_real r[KHEPERA_PLAUSIBLE_RESIDUALS] = {0};
    int at;
    int k;

    for (at = 0; at < GOLDEN_EXACT; ++at) {
        khepera_plausible_exact(monitor, &golden_derivatives[at], r);
        for (k = 0; k < KHEPERA_PLAUSIBLE_RESIDUALS; ++k) {
            const khepera_plausible_real off = relative_error(r[k], &golden_exact[at][k]);

            worst[k] = off > worst[k] ? off : worst[k];
        }
    }
    return judge("exact", worst);
}

static int check_step(khepera_plausible_monitor *monitor)
{
    khepera_plausible_real worst[KHEPERA_PLAUSIBLE_RESIDUALS] = {0};
    khepera_plausible_residuals r;
    int at;
    int k;

    khepera_plausible_reset(monitor);
    for (at = 0; at < GOLDEN_STEP; ++at) {
        khepera_plausible_step(monitor, &golden_samples[at], &r);
        for (k = 0; k < KHEPERA_PLAUSIBLE_RESIDUALS; ++k) {
            const khepera_plausible_real off = relative_error(r.value[k], &golden_step[at][k]);

            worst[k] = off > worst[k] ? off : worst[k];
        }
    }
    return judge("step", worst);
}

/* A sample that is not a number is told, and after it everything starts anew. */
static int check_restart(khepera_plausible_monitor *monitor)
{
    khepera_plausible_samples bad = golden_samples[0];
    khepera_plausible_residuals r;
    int failures = 0;
    int k;

    bad.robot__Fx__1 = (khepera_plausible_real)NAN;
    bad.robot__Fx__2 = (khepera_plausible_real)NAN;
    bad.robot__U0__1 = (khepera_plausible_real)NAN;
    bad.robot__U0__2 = (khepera_plausible_real)NAN;
    bad.robot__Uin = (khepera_plausible_real)NAN;
    bad.robot__m__1__me__we = (khepera_plausible_real)NAN;
    bad.robot__m__1__wh__ws = (khepera_plausible_real)NAN;
    bad.robot__m__2__me__we = (khepera_plausible_real)NAN;
    bad.robot__m__2__wh__ws = (khepera_plausible_real)NAN;
    bad.robot__Us = (khepera_plausible_real)NAN;
    khepera_plausible_step(monitor, &bad, &r);
    for (k = 0; k < KHEPERA_PLAUSIBLE_RESIDUALS; ++k) {
        failures += spoilt[k] && r.valid[k] ? 1 : 0;
    }
    printf("%s a sample that is not a number\n", failures ? "FAIL" : "PASS");
    return failures + check_step(monitor);
}

int main(void)
{
    khepera_plausible_parameters parameters;
    khepera_plausible_monitor monitor;
    khepera_plausible_status status;
    int failures = 0;

    golden_parameters(&parameters);
    status = khepera_plausible_configure(
        &monitor,
        &parameters,
        KHEPERA_PLAUSIBLE_SAMPLE_TIME,
        KHEPERA_PLAUSIBLE_BANDWIDTH,
        KHEPERA_PLAUSIBLE_TIME_UNIT);
    if (status != KHEPERA_PLAUSIBLE_OK) {
        printf("FAIL configure\n");
        return 1;
    }
    failures += check_exact(&monitor);
    failures += check_step(&monitor);
    failures += check_restart(&monitor);
    printf("%s\n", failures ? "FAIL" : "PASS");
    return failures ? 1 : 0;
}
