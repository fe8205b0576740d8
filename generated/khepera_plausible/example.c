/*
 * example.c: KheperaPlausible watched by its residuals; a program to start from.
 *
 * Put your sensors into read_samples and what to do about a fault into raise_alarm. Compile:
 *     cc -std=c99 -O2 example.c khepera_plausible_residuals.c -o example -lm
 */
#include <stdio.h>

#include "khepera_plausible_residuals.h"

#define TICKS 5000

/* How far a residual may be from 0 while all is well: measure this on your healthy machine. */
static const khepera_plausible_real threshold[KHEPERA_PLAUSIBLE_RESIDUALS] = {
    KHEPERA_PLAUSIBLE_CONSTANT(0.001), /* r1 */
    KHEPERA_PLAUSIBLE_CONSTANT(0.001), /* r2 */
    KHEPERA_PLAUSIBLE_CONSTANT(0.001), /* r3 */
    KHEPERA_PLAUSIBLE_CONSTANT(0.001), /* r4 */
    KHEPERA_PLAUSIBLE_CONSTANT(0.001), /* r5 */
};

static const char *const name[KHEPERA_PLAUSIBLE_RESIDUALS] = {
    "r1", "r2", "r3", "r4", "r5",
};

/* One sample of every signal, all taken at the same moment. Here: a machine at rest. */
static void read_samples(khepera_plausible_samples *samples)
{
    /* N: Contact forces, known as in the paper; each loads its wheel and moves the body,
     * robot.Fx[1] */
    samples->robot__Fx__1 = 0;
    /* N: Contact forces, known as in the paper; each loads its wheel and moves the body,
     * robot.Fx[2] */
    samples->robot__Fx__2 = 0;
    samples->robot__U0__1 = 0;         /* V: robot.U0[1] */
    samples->robot__U0__2 = 0;         /* V: robot.U0[2] */
    samples->robot__Uin = 0;           /* V: robot.Uin */
    samples->robot__m__1__me__we = 0;  /* rad/s: robot.m[1].me.we */
    samples->robot__m__1__wh__ws = 0;  /* rad/s: robot.m[1].wh.ws */
    samples->robot__m__2__me__we = 0;  /* rad/s: robot.m[2].me.we */
    samples->robot__m__2__wh__ws = 0;  /* rad/s: robot.m[2].wh.ws */
    samples->robot__Us = 0;            /* V: robot.Us */
}

static void raise_alarm(int residual, khepera_plausible_real value)
{
    printf("%s = %g: look for a fault that it sees\n", name[residual], (double)value);
}

int main(void)
{
    khepera_plausible_parameters parameters;
    khepera_plausible_monitor monitor;
    khepera_plausible_status status;
    khepera_plausible_samples samples;
    khepera_plausible_residuals residuals;
    int alarms = 0;
    int tick;
    int k;

    if (khepera_plausible_abi() != KHEPERA_PLAUSIBLE_ABI) {
        return 2; /* the library was compiled from another version, or with another real */
    }
    khepera_plausible_nominal(&parameters);
    status = khepera_plausible_configure(
        &monitor,
        &parameters,
        KHEPERA_PLAUSIBLE_SAMPLE_TIME,
        KHEPERA_PLAUSIBLE_BANDWIDTH,
        KHEPERA_PLAUSIBLE_TIME_UNIT);
    if (status != KHEPERA_PLAUSIBLE_OK) {
        return 2;
    }
    for (tick = 0; tick < TICKS; ++tick) { /* every sample_time, from a timer */
        read_samples(&samples);
        khepera_plausible_step(&monitor, &samples, &residuals);
        for (k = 0; k < KHEPERA_PLAUSIBLE_RESIDUALS; ++k) {
            const khepera_plausible_real r = residuals.value[k];

            if (residuals.valid[k] && (r > threshold[k] || r < -threshold[k])) {
                raise_alarm(k, r);
                ++alarms;
            }
        }
    }
    printf("%d samples, %d alarms\n", TICKS, alarms);
    return 0;
}
