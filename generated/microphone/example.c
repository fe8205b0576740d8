/*
 * example.c: Microphone watched by its residuals; a program to start from.
 *
 * Put your sensors into read_samples and what to do about a fault into raise_alarm. Compile:
 *     cc -std=c99 -O2 example.c microphone_residuals.c -o example
 */
#include <stdio.h>

#include "microphone_residuals.h"

#define TICKS 5000

/* How far a residual may be from 0 while all is well: measure this on your healthy machine. */
static const microphone_real threshold[MICROPHONE_RESIDUALS] = {
    MICROPHONE_CONSTANT(0.001), /* r1 */
    MICROPHONE_CONSTANT(0.001), /* r2 */
};

static const char *const name[MICROPHONE_RESIDUALS] = {
    "r1", "r2",
};

/* One sample of every signal, all taken at the same moment. Here: a machine at rest. */
static void read_samples(microphone_samples *samples)
{
    samples->U0 = 0;        /* V */
    samples->pressure = 0;  /* Pa */
    samples->u = 0;         /* V */
    samples->v = 0;         /* m/s */
}

static void raise_alarm(int residual, microphone_real value)
{
    printf("%s = %g: look for a fault that it sees\n", name[residual], (double)value);
}

int main(void)
{
    microphone_parameters parameters;
    microphone_monitor monitor;
    microphone_status status;
    microphone_samples samples;
    microphone_residuals residuals;
    int alarms = 0;
    int tick;
    int k;

    if (microphone_abi() != MICROPHONE_ABI) {
        return 2; /* the library was compiled from another version, or with another real */
    }
    microphone_nominal(&parameters);
    status = microphone_configure(
        &monitor,
        &parameters,
        MICROPHONE_SAMPLE_TIME,
        MICROPHONE_BANDWIDTH,
        MICROPHONE_TIME_UNIT);
    if (status != MICROPHONE_OK) {
        return 2;
    }
    for (tick = 0; tick < TICKS; ++tick) { /* every sample_time, from a timer */
        read_samples(&samples);
        microphone_step(&monitor, &samples, &residuals);
        for (k = 0; k < MICROPHONE_RESIDUALS; ++k) {
            const microphone_real r = residuals.value[k];

            if (residuals.valid[k] && (r > threshold[k] || r < -threshold[k])) {
                raise_alarm(k, r);
                ++alarms;
            }
        }
    }
    printf("%d samples, %d alarms\n", TICKS, alarms);
    return 0;
}
