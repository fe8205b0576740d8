/* selftest.c: does motor_residuals.c, compiled here, give what it must? */
#include <math.h>
#include <stdio.h>

#include "golden.h"

#ifdef MOTOR_FLOAT
#define TOLERANCE 1e-4f
#else
#define TOLERANCE 5e-13 /* so that C and Python are within 1e-12 of each other */
#endif

static const char *const name[MOTOR_RESIDUALS] = {
    "r1", "r2",
};

/* The error of a result by the sum of its terms; NaN and infinity are larger than anything. */
static motor_real relative_error(
    motor_real value, const golden_result *golden)
{
    const motor_real size = golden->size > 0 ? golden->size : 1;
    const motor_real off = (value - golden->value) / size;

    return off >= -1000 && off <= 1000 ? (off < 0 ? -off : off) : 1000;
}

static int judge(const char *what, const motor_real *worst)
{
    int failures = 0;
    int k;

    for (k = 0; k < MOTOR_RESIDUALS; ++k) {
        const bool pass = worst[k] <= TOLERANCE;

        printf("%s %s %s: error %.1e of the terms\n", pass ? "PASS" : "FAIL", what, name[k],
            (double)worst[k]);
        failures += pass ? 0 : 1;
    }
    return failures;
}

/* The residuals that read a sample which can be NaN. */
static const bool spoilt[MOTOR_RESIDUALS] = {
    true, true,
};

static int check_exact(const motor_monitor *monitor)
{
    motor_real worst[MOTOR_RESIDUALS] = {0};
    motor_real r[MOTOR_RESIDUALS] = {0};
    int at;
    int k;

    for (at = 0; at < GOLDEN_EXACT; ++at) {
        motor_exact(monitor, &golden_derivatives[at], r);
        for (k = 0; k < MOTOR_RESIDUALS; ++k) {
            const motor_real off = relative_error(r[k], &golden_exact[at][k]);

            worst[k] = off > worst[k] ? off : worst[k];
        }
    }
    return judge("exact", worst);
}

static int check_step(motor_monitor *monitor)
{
    motor_real worst[MOTOR_RESIDUALS] = {0};
    motor_residuals r;
    int at;
    int k;

    motor_reset(monitor);
    for (at = 0; at < GOLDEN_STEP; ++at) {
        motor_step(monitor, &golden_samples[at], &r);
        for (k = 0; k < MOTOR_RESIDUALS; ++k) {
            const motor_real off = relative_error(r.value[k], &golden_step[at][k]);

            worst[k] = off > worst[k] ? off : worst[k];
        }
    }
    return judge("step", worst);
}

/* A sample that is not a number is told, and after it everything starts anew. */
static int check_restart(motor_monitor *monitor)
{
    motor_samples bad = golden_samples[0];
    motor_residuals r;
    int failures = 0;
    int k;

    bad.load = (motor_real)NAN;
    bad.U = (motor_real)NAN;
    bad.current = (motor_real)NAN;
    bad.speed = (motor_real)NAN;
    motor_step(monitor, &bad, &r);
    for (k = 0; k < MOTOR_RESIDUALS; ++k) {
        failures += spoilt[k] && r.valid[k] ? 1 : 0;
    }
    printf("%s a sample that is not a number\n", failures ? "FAIL" : "PASS");
    return failures + check_step(monitor);
}

int main(void)
{
    motor_parameters parameters;
    motor_monitor monitor;
    motor_status status;
    int failures = 0;

    golden_parameters(&parameters);
    status = motor_configure(
        &monitor,
        &parameters,
        MOTOR_SAMPLE_TIME,
        MOTOR_BANDWIDTH,
        MOTOR_TIME_UNIT);
    if (status != MOTOR_OK) {
        printf("FAIL configure\n");
        return 1;
    }
    failures += check_exact(&monitor);
    failures += check_step(&monitor);
    failures += check_restart(&monitor);
    printf("%s\n", failures ? "FAIL" : "PASS");
    return failures ? 1 : 0;
}
