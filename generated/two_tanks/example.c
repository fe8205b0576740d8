/*
 * example.c: TwoTanks watched by its residuals; a program to start from.
 *
 * Put your sensors into read_samples and what to do about a fault into raise_alarm. Compile:
 *     cc -std=c99 -O2 example.c two_tanks_residuals.c -o example -lm
 */
#include <stdio.h>

#include "two_tanks_residuals.h"

#define TICKS 5000

/* How far a residual may be from 0 while all is well: measure this on your healthy machine. */
static const two_tanks_real threshold[TWO_TANKS_RESIDUALS] = {
    TWO_TANKS_CONSTANT(0.001), /* r1 */
    TWO_TANKS_CONSTANT(0.001), /* r2 */
};

static const char *const name[TWO_TANKS_RESIDUALS] = {
    "r1", "r2",
};

/* One sample of every signal, all taken at the same moment. Here: a machine at rest. */
static void read_samples(two_tanks_samples *samples)
{
    samples->Q = 0;   /* m^3/s */
    samples->p1 = 0;  /* Pa */
    samples->p2 = 0;  /* Pa */
}

static void raise_alarm(int residual, two_tanks_real value)
{
    printf("%s = %g: look for a fault that it sees\n", name[residual], (double)value);
}

int main(void)
{
    two_tanks_parameters parameters;
    two_tanks_monitor monitor;
    two_tanks_status status;
    two_tanks_samples samples;
    two_tanks_residuals residuals;
    int alarms = 0;
    int tick;
    int k;

    if (two_tanks_abi() != TWO_TANKS_ABI) {
        return 2; /* the library was compiled from another version, or with another real */
    }
    two_tanks_nominal(&parameters);
    status = two_tanks_configure(
        &monitor,
        &parameters,
        TWO_TANKS_SAMPLE_TIME,
        TWO_TANKS_BANDWIDTH,
        TWO_TANKS_TIME_UNIT);
    if (status != TWO_TANKS_OK) {
        return 2;
    }
    for (tick = 0; tick < TICKS; ++tick) { /* every sample_time, from a timer */
        read_samples(&samples);
        two_tanks_step(&monitor, &samples, &residuals);
        for (k = 0; k < TWO_TANKS_RESIDUALS; ++k) {
            const two_tanks_real r = residuals.value[k];

            if (residuals.valid[k] && (r > threshold[k] || r < -threshold[k])) {
                raise_alarm(k, r);
                ++alarms;
            }
        }
    }
    printf("%d samples, %d alarms\n", TICKS, alarms);
    return 0;
}
