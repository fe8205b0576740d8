/*
 * example.c: Oven watched by its residuals; a program to start from.
 *
 * Put your sensors into read_samples and what to do about a fault into raise_alarm. Compile:
 *     cc -std=c99 -O2 example.c oven_residuals.c -o example
 */
#include <stdio.h>

#include "oven_residuals.h"

#define TICKS 5000

/* How far a residual may be from 0 while all is well: measure this on your healthy machine. */
static const oven_real threshold[OVEN_RESIDUALS] = {
    OVEN_CONSTANT(0.001), /* r1 */
    OVEN_CONSTANT(0.001), /* r2 */
};

static const char *const name[OVEN_RESIDUALS] = {
    "r1", "r2",
};

/* One sample of every signal, all taken at the same moment. Here: a machine at rest. */
static void read_samples(oven_samples *samples)
{
    samples->on = false;  /* - */
    samples->P = 0;       /* W */
    samples->Ta = 0;      /* K */
    samples->Th = 0;      /* K */
    samples->To = 0;      /* K */
}

static void raise_alarm(int residual, oven_real value)
{
    printf("%s = %g: look for a fault that it sees\n", name[residual], (double)value);
}

int main(void)
{
    oven_parameters parameters;
    oven_monitor monitor;
    oven_status status;
    oven_samples samples;
    oven_residuals residuals;
    int alarms = 0;
    int tick;
    int k;

    if (oven_abi() != OVEN_ABI) {
        return 2; /* the library was compiled from another version, or with another real */
    }
    oven_nominal(&parameters);
    status = oven_configure(
        &monitor,
        &parameters,
        OVEN_SAMPLE_TIME,
        OVEN_BANDWIDTH,
        OVEN_TIME_UNIT);
    if (status != OVEN_OK) {
        return 2;
    }
    for (tick = 0; tick < TICKS; ++tick) { /* every sample_time, from a timer */
        read_samples(&samples);
        oven_step(&monitor, &samples, &residuals);
        for (k = 0; k < OVEN_RESIDUALS; ++k) {
            const oven_real r = residuals.value[k];

            if (residuals.valid[k] && (r > threshold[k] || r < -threshold[k])) {
                raise_alarm(k, r);
                ++alarms;
            }
        }
    }
    printf("%d samples, %d alarms\n", TICKS, alarms);
    return 0;
}
