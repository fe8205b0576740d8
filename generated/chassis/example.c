/*
 * example.c: ChassisBench watched by its residuals; a program to start from.
 *
 * Put your sensors into read_samples and what to do about a fault into raise_alarm. Compile:
 *     cc -std=c99 -O2 example.c chassis_bench_residuals.c -o example
 */
#include <stdio.h>

#include "chassis_bench_residuals.h"

#define TICKS 5000

/* How far a residual may be from 0 while all is well: measure this on your healthy machine. */
static const chassis_bench_real threshold[CHASSIS_BENCH_RESIDUALS] = {
    CHASSIS_BENCH_CONSTANT(0.001), /* r1 */
    CHASSIS_BENCH_CONSTANT(0.001), /* r2 */
};

static const char *const name[CHASSIS_BENCH_RESIDUALS] = {
    "r1", "r2",
};

/* One sample of every signal, all taken at the same moment. Here: a machine at rest. */
static void read_samples(chassis_bench_samples *samples)
{
    samples->body__Fx__1 = 0;  /* N: body.Fx[1] */
    samples->body__Fx__2 = 0;  /* N: body.Fx[2] */
    samples->u = 0;            /* m/s */
    samples->yaw = 0;          /* rad/s */
}

static void raise_alarm(int residual, chassis_bench_real value)
{
    printf("%s = %g: look for a fault that it sees\n", name[residual], (double)value);
}

int main(void)
{
    chassis_bench_parameters parameters;
    chassis_bench_monitor monitor;
    chassis_bench_status status;
    chassis_bench_samples samples;
    chassis_bench_residuals residuals;
    int alarms = 0;
    int tick;
    int k;

    if (chassis_bench_abi() != CHASSIS_BENCH_ABI) {
        return 2; /* the library was compiled from another version, or with another real */
    }
    chassis_bench_nominal(&parameters);
    status = chassis_bench_configure(
        &monitor,
        &parameters,
        CHASSIS_BENCH_SAMPLE_TIME,
        CHASSIS_BENCH_BANDWIDTH,
        CHASSIS_BENCH_TIME_UNIT);
    if (status != CHASSIS_BENCH_OK) {
        return 2;
    }
    for (tick = 0; tick < TICKS; ++tick) { /* every sample_time, from a timer */
        read_samples(&samples);
        chassis_bench_step(&monitor, &samples, &residuals);
        for (k = 0; k < CHASSIS_BENCH_RESIDUALS; ++k) {
            const chassis_bench_real r = residuals.value[k];

            if (residuals.valid[k] && (r > threshold[k] || r < -threshold[k])) {
                raise_alarm(k, r);
                ++alarms;
            }
        }
    }
    printf("%d samples, %d alarms\n", TICKS, alarms);
    return 0;
}
