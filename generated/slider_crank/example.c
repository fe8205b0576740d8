/*
 * example.c: SliderCrank watched by its residuals; a program to start from.
 *
 * Put your sensors into read_samples and what to do about a fault into raise_alarm. Compile:
 *     cc -std=c99 -O2 example.c slider_crank_residuals.c -o example -lm
 */
#include <stdio.h>

#include "slider_crank_residuals.h"

#define TICKS 5000

/* How far a residual may be from 0 while all is well: measure this on your healthy machine. */
static const slider_crank_real threshold[SLIDER_CRANK_RESIDUALS] = {
    SLIDER_CRANK_CONSTANT(0.001), /* r1 */
};

static const char *const name[SLIDER_CRANK_RESIDUALS] = {
    "r1",
};

/* One sample of every signal, all taken at the same moment. Here: a machine at rest. */
static void read_samples(slider_crank_samples *samples)
{
    samples->T = 0;      /* N.m */
    samples->load = 0;   /* N */
    samples->speed = 0;  /* rad/s */
}

static void raise_alarm(int residual, slider_crank_real value)
{
    printf("%s = %g: look for a fault that it sees\n", name[residual], (double)value);
}

int main(void)
{
    slider_crank_parameters parameters;
    slider_crank_monitor monitor;
    slider_crank_status status;
    slider_crank_samples samples;
    slider_crank_residuals residuals;
    int alarms = 0;
    int tick;
    int k;

    if (slider_crank_abi() != SLIDER_CRANK_ABI) {
        return 2; /* the library was compiled from another version, or with another real */
    }
    slider_crank_nominal(&parameters);
    status = slider_crank_configure(
        &monitor,
        &parameters,
        SLIDER_CRANK_SAMPLE_TIME,
        SLIDER_CRANK_BANDWIDTH,
        SLIDER_CRANK_TIME_UNIT);
    if (status != SLIDER_CRANK_OK) {
        return 2;
    }
    for (tick = 0; tick < TICKS; ++tick) { /* every sample_time, from a timer */
        read_samples(&samples);
        slider_crank_step(&monitor, &samples, &residuals);
        for (k = 0; k < SLIDER_CRANK_RESIDUALS; ++k) {
            const slider_crank_real r = residuals.value[k];

            if (residuals.valid[k] && (r > threshold[k] || r < -threshold[k])) {
                raise_alarm(k, r);
                ++alarms;
            }
        }
    }
    printf("%d samples, %d alarms\n", TICKS, alarms);
    return 0;
}
