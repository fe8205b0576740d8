/*
 * example.c: RigidGear watched by its residuals; a program to start from.
 *
 * Put your sensors into read_samples and what to do about a fault into raise_alarm. Compile:
 *     cc -std=c99 -O2 example.c rigid_gear_residuals.c -o example
 */
#include <stdio.h>

#include "rigid_gear_residuals.h"

#define TICKS 5000

/* How far a residual may be from 0 while all is well: measure this on your healthy machine. */
static const rigid_gear_real threshold[RIGID_GEAR_RESIDUALS] = {
    RIGID_GEAR_CONSTANT(0.001), /* r1 */
    RIGID_GEAR_CONSTANT(0.001), /* r2 */
};

static const char *const name[RIGID_GEAR_RESIDUALS] = {
    "r1", "r2",
};

/* One sample of every signal, all taken at the same moment. Here: a machine at rest. */
static void read_samples(rigid_gear_samples *samples)
{
    samples->T = 0;   /* N.m */
    samples->w1 = 0;  /* rad/s */
    samples->w2 = 0;  /* rad/s */
}

static void raise_alarm(int residual, rigid_gear_real value)
{
    printf("%s = %g: look for a fault that it sees\n", name[residual], (double)value);
}

int main(void)
{
    rigid_gear_parameters parameters;
    rigid_gear_monitor monitor;
    rigid_gear_status status;
    rigid_gear_samples samples;
    rigid_gear_residuals residuals;
    int alarms = 0;
    int tick;
    int k;

    if (rigid_gear_abi() != RIGID_GEAR_ABI) {
        return 2; /* the library was compiled from another version, or with another real */
    }
    rigid_gear_nominal(&parameters);
    status = rigid_gear_configure(
        &monitor,
        &parameters,
        RIGID_GEAR_SAMPLE_TIME,
        RIGID_GEAR_BANDWIDTH,
        RIGID_GEAR_TIME_UNIT);
    if (status != RIGID_GEAR_OK) {
        return 2;
    }
    for (tick = 0; tick < TICKS; ++tick) { /* every sample_time, from a timer */
        read_samples(&samples);
        rigid_gear_step(&monitor, &samples, &residuals);
        for (k = 0; k < RIGID_GEAR_RESIDUALS; ++k) {
            const rigid_gear_real r = residuals.value[k];

            if (residuals.valid[k] && (r > threshold[k] || r < -threshold[k])) {
                raise_alarm(k, r);
                ++alarms;
            }
        }
    }
    printf("%d samples, %d alarms\n", TICKS, alarms);
    return 0;
}
