/*
 * example.c: CableBench watched by its residuals; a program to start from.
 *
 * Put your sensors into read_samples and what to do about a fault into raise_alarm. Compile:
 *     cc -std=c99 -O2 example.c cable_bench_residuals.c -o example
 */
#include <stdio.h>

#include "cable_bench_residuals.h"

#define TICKS 5000

/* How far a residual may be from 0 while all is well: measure this on your healthy machine. */
static const cable_bench_real threshold[CABLE_BENCH_RESIDUALS] = {
    CABLE_BENCH_CONSTANT(0.001), /* r1 */
};

static const char *const name[CABLE_BENCH_RESIDUALS] = {
    "r1",
};

/* One sample of every signal, all taken at the same moment. Here: a machine at rest. */
static void read_samples(cable_bench_samples *samples)
{
    samples->Uin = 0;  /* V */
    samples->Us = 0;   /* V */
}

static void raise_alarm(int residual, cable_bench_real value)
{
    printf("%s = %g: look for a fault that it sees\n", name[residual], (double)value);
}

int main(void)
{
    cable_bench_parameters parameters;
    cable_bench_monitor monitor;
    cable_bench_status status;
    cable_bench_samples samples;
    cable_bench_residuals residuals;
    int alarms = 0;
    int tick;
    int k;

    if (cable_bench_abi() != CABLE_BENCH_ABI) {
        return 2; /* the library was compiled from another version, or with another real */
    }
    cable_bench_nominal(&parameters);
    status = cable_bench_configure(
        &monitor,
        &parameters,
        CABLE_BENCH_SAMPLE_TIME,
        CABLE_BENCH_BANDWIDTH,
        CABLE_BENCH_TIME_UNIT);
    if (status != CABLE_BENCH_OK) {
        return 2;
    }
    for (tick = 0; tick < TICKS; ++tick) { /* every sample_time, from a timer */
        read_samples(&samples);
        cable_bench_step(&monitor, &samples, &residuals);
        for (k = 0; k < CABLE_BENCH_RESIDUALS; ++k) {
            const cable_bench_real r = residuals.value[k];

            if (residuals.valid[k] && (r > threshold[k] || r < -threshold[k])) {
                raise_alarm(k, r);
                ++alarms;
            }
        }
    }
    printf("%d samples, %d alarms\n", TICKS, alarms);
    return 0;
}
