/* selftest.c: does cable_open_residuals.c, compiled here, give what it must? */
#include <math.h>
#include <stdio.h>

#include "golden.h"

#ifdef CABLE_OPEN_FLOAT
#define TOLERANCE 1e-4f
#else
#define TOLERANCE 5e-13 /* so that C and Python are within 1e-12 of each other */
#endif

static const char *const name[CABLE_OPEN_RESIDUALS] = {
    "r1",
};

/* The error of a result by the sum of its terms; NaN and infinity are larger than anything. */
static cable_open_real relative_error(
    cable_open_real value, const golden_result *golden)
{
    const cable_open_real size = golden->size > 0 ? golden->size : 1;
    const cable_open_real off = (value - golden->value) / size;

    return off >= -1000 && off <= 1000 ? (off < 0 ? -off : off) : 1000;
}

static int judge(const char *what, const cable_open_real *worst)
{
    int failures = 0;
    int k;

    for (k = 0; k < CABLE_OPEN_RESIDUALS; ++k) {
        const bool pass = worst[k] <= TOLERANCE;

        printf("%s %s %s: error %.1e of the terms\n", pass ? "PASS" : "FAIL", what, name[k],
            (double)worst[k]);
        failures += pass ? 0 : 1;
    }
    return failures;
}

/* The residuals that read a sample which can be NaN. */
static const bool spoilt[CABLE_OPEN_RESIDUALS] = {
    true,
};

static int check_exact(const cable_open_monitor *monitor)
{
    cable_open_real worst[CABLE_OPEN_RESIDUALS] = {0};
    cable_open_real r[CABLE_OPEN_RESIDUALS] = {0};
    int at;
    int k;

    for (at = 0; at < GOLDEN_EXACT; ++at) {
        cable_open_exact(monitor, &golden_derivatives[at], r);
        for (k = 0; k < CABLE_OPEN_RESIDUALS; ++k) {
            const cable_open_real off = relative_error(r[k], &golden_exact[at][k]);

            worst[k] = off > worst[k] ? off : worst[k];
        }
    }
    return judge("exact", worst);
}

static int check_step(cable_open_monitor *monitor)
{
    cable_open_real worst[CABLE_OPEN_RESIDUALS] = {0};
    cable_open_residuals r;
    int at;
    int k;

    cable_open_reset(monitor);
    for (at = 0; at < GOLDEN_STEP; ++at) {
        cable_open_step(monitor, &golden_samples[at], &r);
        for (k = 0; k < CABLE_OPEN_RESIDUALS; ++k) {
            const cable_open_real off = relative_error(r.value[k], &golden_step[at][k]);

            worst[k] = off > worst[k] ? off : worst[k];
        }
    }
    return judge("step", worst);
}

/* A sample that is not a number is told, and after it everything starts anew. */
static int check_restart(cable_open_monitor *monitor)
{
    cable_open_samples bad = golden_samples[0];
    cable_open_residuals r;
    int failures = 0;
    int k;

    bad.Uin = (cable_open_real)NAN;
    bad.Us = (cable_open_real)NAN;
    cable_open_step(monitor, &bad, &r);
    for (k = 0; k < CABLE_OPEN_RESIDUALS; ++k) {
        failures += spoilt[k] && r.valid[k] ? 1 : 0;
    }
    printf("%s a sample that is not a number\n", failures ? "FAIL" : "PASS");
    return failures + check_step(monitor);
}

int main(void)
{
    cable_open_parameters parameters;
    cable_open_monitor monitor;
    cable_open_status status;
    int failures = 0;

    golden_parameters(&parameters);
    status = cable_open_configure(
        &monitor,
        &parameters,
        CABLE_OPEN_SAMPLE_TIME,
        CABLE_OPEN_BANDWIDTH,
        CABLE_OPEN_TIME_UNIT);
    if (status != CABLE_OPEN_OK) {
        printf("FAIL configure\n");
        return 1;
    }
    failures += check_exact(&monitor);
    failures += check_step(&monitor);
    failures += check_restart(&monitor);
    printf("%s\n", failures ? "FAIL" : "PASS");
    return failures ? 1 : 0;
}
