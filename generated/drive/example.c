/*
 * example.c: DriveBench watched by its residuals; a program to start from.
 *
 * Put your sensors into read_samples and what to do about a fault into raise_alarm. Compile:
 *     cc -std=c99 -O2 example.c drive_bench_residuals.c -o example -lm
 */
#include <stdio.h>

#include "drive_bench_residuals.h"

#define TICKS 5000

/* How far a residual may be from 0 while all is well: measure this on your healthy machine. */
static const drive_bench_real threshold[DRIVE_BENCH_RESIDUALS] = {
    DRIVE_BENCH_CONSTANT(0.001), /* r1 */
    DRIVE_BENCH_CONSTANT(0.001), /* r2 */
};

static const char *const name[DRIVE_BENCH_RESIDUALS] = {
    "r1", "r2",
};

/* One sample of every signal, all taken at the same moment. Here: a machine at rest. */
static void read_samples(drive_bench_samples *samples)
{
    samples->U0 = 0;         /* V */
    samples->Fx = 0;         /* N */
    samples->m__me__we = 0;  /* rad/s: m.me.we */
    samples->m__wh__ws = 0;  /* rad/s: m.wh.ws */
}

static void raise_alarm(int residual, drive_bench_real value)
{
    printf("%s = %g: look for a fault that it sees\n", name[residual], (double)value);
}

int main(void)
{
    drive_bench_parameters parameters;
    drive_bench_monitor monitor;
    drive_bench_status status;
    drive_bench_samples samples;
    drive_bench_residuals residuals;
    int alarms = 0;
    int tick;
    int k;

    if (drive_bench_abi() != DRIVE_BENCH_ABI) {
        return 2; /* the library was compiled from another version, or with another real */
    }
    drive_bench_nominal(&parameters);
    status = drive_bench_configure(
        &monitor,
        &parameters,
        DRIVE_BENCH_SAMPLE_TIME,
        DRIVE_BENCH_BANDWIDTH,
        DRIVE_BENCH_TIME_UNIT);
    if (status != DRIVE_BENCH_OK) {
        return 2;
    }
    for (tick = 0; tick < TICKS; ++tick) { /* every sample_time, from a timer */
        read_samples(&samples);
        drive_bench_step(&monitor, &samples, &residuals);
        for (k = 0; k < DRIVE_BENCH_RESIDUALS; ++k) {
            const drive_bench_real r = residuals.value[k];

            if (residuals.valid[k] && (r > threshold[k] || r < -threshold[k])) {
                raise_alarm(k, r);
                ++alarms;
            }
        }
    }
    printf("%d samples, %d alarms\n", TICKS, alarms);
    return 0;
}
