/*
 * example.c: RcLoop watched by its residuals; a program to start from.
 *
 * Put your sensors into read_samples and what to do about a fault into raise_alarm. Compile:
 *     cc -std=c99 -O2 example.c rc_loop_residuals.c -o example
 */
#include <stdio.h>

#include "rc_loop_residuals.h"

#define TICKS 5000

/* How far a residual may be from 0 while all is well: measure this on your healthy machine. */
static const rc_loop_real threshold[RC_LOOP_RESIDUALS] = {
    RC_LOOP_CONSTANT(0.001), /* r1 */
    RC_LOOP_CONSTANT(0.001), /* r2 */
};

static const char *const name[RC_LOOP_RESIDUALS] = {
    "r1", "r2",
};

/* One sample of every signal, all taken at the same moment. Here: a machine at rest. */
static void read_samples(rc_loop_samples *samples)
{
    samples->U = 0;   /* - */
    samples->ua = 0;  /* - */
    samples->uc = 0;  /* - */
}

static void raise_alarm(int residual, rc_loop_real value)
{
    printf("%s = %g: look for a fault that it sees\n", name[residual], (double)value);
}

int main(void)
{
    rc_loop_parameters parameters;
    rc_loop_monitor monitor;
    rc_loop_status status;
    rc_loop_samples samples;
    rc_loop_residuals residuals;
    int alarms = 0;
    int tick;
    int k;

    if (rc_loop_abi() != RC_LOOP_ABI) {
        return 2; /* the library was compiled from another version, or with another real */
    }
    rc_loop_nominal(&parameters);
    status = rc_loop_configure(
        &monitor,
        &parameters,
        RC_LOOP_SAMPLE_TIME,
        RC_LOOP_BANDWIDTH,
        RC_LOOP_TIME_UNIT);
    if (status != RC_LOOP_OK) {
        return 2;
    }
    for (tick = 0; tick < TICKS; ++tick) { /* every sample_time, from a timer */
        read_samples(&samples);
        rc_loop_step(&monitor, &samples, &residuals);
        for (k = 0; k < RC_LOOP_RESIDUALS; ++k) {
            const rc_loop_real r = residuals.value[k];

            if (residuals.valid[k] && (r > threshold[k] || r < -threshold[k])) {
                raise_alarm(k, r);
                ++alarms;
            }
        }
    }
    printf("%d samples, %d alarms\n", TICKS, alarms);
    return 0;
}
