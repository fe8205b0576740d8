/*
 * example.c: KheperaBuilt watched by its residuals; a program to start from.
 *
 * Put your sensors into read_samples and what to do about a fault into raise_alarm. Compile:
 *     cc -std=c99 -O2 example.c khepera_built_residuals.c -o example
 */
#include <stdio.h>

#include "khepera_built_residuals.h"

#define TICKS 5000

/* How far a residual may be from 0 while all is well: measure this on your healthy machine. */
static const khepera_built_real threshold[KHEPERA_BUILT_RESIDUALS] = {
    KHEPERA_BUILT_CONSTANT(0.001), /* r1 */
    KHEPERA_BUILT_CONSTANT(0.001), /* r2 */
    KHEPERA_BUILT_CONSTANT(0.001), /* r3 */
};

static const char *const name[KHEPERA_BUILT_RESIDUALS] = {
    "r1", "r2", "r3",
};

/* One sample of every signal, all taken at the same moment. Here: a machine at rest. */
static void read_samples(khepera_built_samples *samples)
{
    /* N: Contact forces: rolling friction, known from the weight, Fx[1] */
    samples->Fx__1 = 0;
    /* N: Contact forces: rolling friction, known from the weight, Fx[2] */
    samples->Fx__2 = 0;
    samples->U0__1 = 0;        /* V: U0[1] */
    samples->U0__2 = 0;        /* V: U0[2] */
    samples->Uin = 0;          /* V */
    samples->m__1__motor = 0;  /* 24 counts a turn; rad: m[1].motor */
    samples->m__2__motor = 0;  /* 24 counts a turn; rad: m[2].motor */
    samples->Us = 0;           /* V */
}

static void raise_alarm(int residual, khepera_built_real value)
{
    printf("%s = %g: look for a fault that it sees\n", name[residual], (double)value);
}

int main(void)
{
    khepera_built_parameters parameters;
    khepera_built_monitor monitor;
    khepera_built_status status;
    khepera_built_samples samples;
    khepera_built_residuals residuals;
    int alarms = 0;
    int tick;
    int k;

    if (khepera_built_abi() != KHEPERA_BUILT_ABI) {
        return 2; /* the library was compiled from another version, or with another real */
    }
    khepera_built_nominal(&parameters);
    status = khepera_built_configure(
        &monitor,
        &parameters,
        KHEPERA_BUILT_SAMPLE_TIME,
        KHEPERA_BUILT_BANDWIDTH,
        KHEPERA_BUILT_TIME_UNIT);
    if (status != KHEPERA_BUILT_OK) {
        return 2;
    }
    for (tick = 0; tick < TICKS; ++tick) { /* every sample_time, from a timer */
        read_samples(&samples);
        khepera_built_step(&monitor, &samples, &residuals);
        for (k = 0; k < KHEPERA_BUILT_RESIDUALS; ++k) {
            const khepera_built_real r = residuals.value[k];

            if (residuals.valid[k] && (r > threshold[k] || r < -threshold[k])) {
                raise_alarm(k, r);
                ++alarms;
            }
        }
    }
    printf("%d samples, %d alarms\n", TICKS, alarms);
    return 0;
}
