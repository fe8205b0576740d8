/*
 * example.c: Khepera watched by its residuals; a program to start from.
 *
 * Put your sensors into read_samples and what to do about a fault into raise_alarm. Compile:
 *     cc -std=c99 -O2 example.c khepera_residuals.c -o example -lm
 */
#include <stdio.h>

#include "khepera_residuals.h"

#define TICKS 5000

/* How far a residual may be from 0 while all is well: measure this on your healthy machine. */
static const khepera_real threshold[KHEPERA_RESIDUALS] = {
    KHEPERA_CONSTANT(0.001), /* r1 */
    KHEPERA_CONSTANT(0.001), /* r2 */
    KHEPERA_CONSTANT(0.001), /* r3 */
    KHEPERA_CONSTANT(0.001), /* r4 */
    KHEPERA_CONSTANT(0.001), /* r5 */
};

static const char *const name[KHEPERA_RESIDUALS] = {
    "r1", "r2", "r3", "r4", "r5",
};

/* One sample of every signal, all taken at the same moment. Here: a machine at rest. */
static void read_samples(khepera_samples *samples)
{
    /* N: Contact forces, known as in the paper; each loads its wheel and moves the body, Fx[1] */
    samples->Fx__1 = 0;
    /* N: Contact forces, known as in the paper; each loads its wheel and moves the body, Fx[2] */
    samples->Fx__2 = 0;
    samples->U0__1 = 0;         /* V: U0[1] */
    samples->U0__2 = 0;         /* V: U0[2] */
    samples->Uin = 0;           /* V */
    samples->m__1__me__we = 0;  /* rad/s: m[1].me.we */
    samples->m__1__wh__ws = 0;  /* rad/s: m[1].wh.ws */
    samples->m__2__me__we = 0;  /* rad/s: m[2].me.we */
    samples->m__2__wh__ws = 0;  /* rad/s: m[2].wh.ws */
    samples->Us = 0;            /* V */
}

static void raise_alarm(int residual, khepera_real value)
{
    printf("%s = %g: look for a fault that it sees\n", name[residual], (double)value);
}

int main(void)
{
    khepera_parameters parameters;
    khepera_monitor monitor;
    khepera_status status;
    khepera_samples samples;
    khepera_residuals residuals;
    int alarms = 0;
    int tick;
    int k;

    if (khepera_abi() != KHEPERA_ABI) {
        return 2; /* the library was compiled from another version, or with another real */
    }
    khepera_nominal(&parameters);
    status = khepera_configure(
        &monitor,
        &parameters,
        KHEPERA_SAMPLE_TIME,
        KHEPERA_BANDWIDTH,
        KHEPERA_TIME_UNIT);
    if (status != KHEPERA_OK) {
        return 2;
    }
    for (tick = 0; tick < TICKS; ++tick) { /* every sample_time, from a timer */
        read_samples(&samples);
        khepera_step(&monitor, &samples, &residuals);
        for (k = 0; k < KHEPERA_RESIDUALS; ++k) {
            const khepera_real r = residuals.value[k];

            if (residuals.valid[k] && (r > threshold[k] || r < -threshold[k])) {
                raise_alarm(k, r);
                ++alarms;
            }
        }
    }
    printf("%d samples, %d alarms\n", TICKS, alarms);
    return 0;
}
