/* selftest.c: does slider_crank_threshold.c, compiled here, give what it must? */
#include <math.h>
#include <stdio.h>

#include "golden.h"

#ifdef SLIDER_CRANK_THRESHOLD_FLOAT
#define TOLERANCE 1e-4f
#else
#define TOLERANCE 5e-13 /* so that C and Python are within 1e-12 of each other */
#endif

static const char *const name[SLIDER_CRANK_THRESHOLD_RESIDUALS] = {
    "r1",
};

/* The error of a result by the sum of its terms; NaN and infinity are larger than anything. */
static slider_crank_threshold_real relative_error(
    slider_crank_threshold_real value, const golden_result *golden)
{
    /* what exact does not have must be NaN */
    const bool none = !(golden->value <= 0 || golden->value >= 0);
    const bool nothing = !(value <= 0 || value >= 0);
    const slider_crank_threshold_real size = golden->size > 0 ? golden->size : 1;
    const slider_crank_threshold_real off = (value - golden->value) / size;

    if (none || nothing) {
        return none && nothing ? 0 : 1000;
    }
    return off >= -1000 && off <= 1000 ? (off < 0 ? -off : off) : 1000;
}

static int judge(const char *what, const slider_crank_threshold_real *worst)
{
    int failures = 0;
    int k;

    for (k = 0; k < SLIDER_CRANK_THRESHOLD_RESIDUALS; ++k) {
        const bool pass = worst[k] <= TOLERANCE;

        printf("%s %s %s: error %.1e of the terms\n", pass ? "PASS" : "FAIL", what, name[k],
            (double)worst[k]);
        failures += pass ? 0 : 1;
    }
    return failures;
}

/* The residuals that read a sample which can be NaN. */
static const bool spoilt[SLIDER_CRANK_THRESHOLD_RESIDUALS] = {
    true,
};

static int check_exact(const slider_crank_threshold_monitor *monitor)
{
    slider_crank_threshold_real worst[SLIDER_CRANK_THRESHOLD_RESIDUALS] = {0};
    slider_crank_threshold_real r[SLIDER_CRANK_THRESHOLD_RESIDUALS] = {0};
    int at;
    int k;

    for (at = 0; at < GOLDEN_EXACT; ++at) {
        slider_crank_threshold_exact(monitor, &golden_derivatives[at], r);
        for (k = 0; k < SLIDER_CRANK_THRESHOLD_RESIDUALS; ++k) {
            const slider_crank_threshold_real off = relative_error(r[k], &golden_exact[at][k]);

            worst[k] = off > worst[k] ? off : worst[k];
        }
    }
    return judge("exact", worst);
}

static int check_step(slider_crank_threshold_monitor *monitor)
{
    slider_crank_threshold_real worst[SLIDER_CRANK_THRESHOLD_RESIDUALS] = {0};
    slider_crank_threshold_residuals r;
    int at;
    int k;

    slider_crank_threshold_reset(monitor);
    for (at = 0; at < GOLDEN_STEP; ++at) {
        slider_crank_threshold_step(monitor, &golden_samples[at], &r);
        for (k = 0; k < SLIDER_CRANK_THRESHOLD_RESIDUALS; ++k) {
            const slider_crank_threshold_real off = relative_error(r.value[k], &golden_step[at][k]);

            worst[k] = off > worst[k] ? off : worst[k];
        }
    }
    return judge("step", worst);
}

/* A sample that is not a number is told, and after it everything starts anew. */
static int check_restart(slider_crank_threshold_monitor *monitor)
{
    slider_crank_threshold_samples bad = golden_samples[0];
    slider_crank_threshold_residuals r;
    int failures = 0;
    int k;

    bad.speed = (slider_crank_threshold_real)NAN;
    slider_crank_threshold_step(monitor, &bad, &r);
    for (k = 0; k < SLIDER_CRANK_THRESHOLD_RESIDUALS; ++k) {
        failures += spoilt[k] && r.valid[k] ? 1 : 0;
    }
    printf("%s a sample that is not a number\n", failures ? "FAIL" : "PASS");
    return failures + check_step(monitor);
}

int main(void)
{
    slider_crank_threshold_parameters parameters;
    slider_crank_threshold_monitor monitor;
    slider_crank_threshold_status status;
    int failures = 0;

    golden_parameters(&parameters);
    status = slider_crank_threshold_configure(
        &monitor,
        &parameters,
        SLIDER_CRANK_THRESHOLD_SAMPLE_TIME,
        SLIDER_CRANK_THRESHOLD_BANDWIDTH,
        SLIDER_CRANK_THRESHOLD_TIME_UNIT);
    if (status != SLIDER_CRANK_THRESHOLD_OK) {
        printf("FAIL configure\n");
        return 1;
    }
    failures += check_exact(&monitor);
    failures += check_step(&monitor);
    failures += check_restart(&monitor);
    printf("%s\n", failures ? "FAIL" : "PASS");
    return failures ? 1 : 0;
}
