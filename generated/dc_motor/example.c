/*
 * example.c: Motor watched by its residuals; a program to start from.
 *
 * Put your sensors into read_samples and what to do about a fault into raise_alarm. Compile:
 *     cc -std=c99 -O2 example.c motor_residuals.c -o example
 */
#include <stdio.h>

#include "motor_residuals.h"

#define TICKS 5000

/* How far a residual may be from 0 while all is well: measure this on your healthy machine. */
static const motor_real threshold[MOTOR_RESIDUALS] = {
    MOTOR_CONSTANT(0.001), /* r1 */
    MOTOR_CONSTANT(0.001), /* r2 */
};

static const char *const name[MOTOR_RESIDUALS] = {
    "r1", "r2",
};

/* One sample of every signal, all taken at the same moment. Here: a machine at rest. */
static void read_samples(motor_samples *samples)
{
    samples->load = 0;     /* N.m */
    samples->U = 0;        /* V */
    samples->current = 0;  /* A */
    samples->speed = 0;    /* rad/s */
}

static void raise_alarm(int residual, motor_real value)
{
    printf("%s = %g: look for a fault that it sees\n", name[residual], (double)value);
}

int main(void)
{
    motor_parameters parameters;
    motor_monitor monitor;
    motor_status status;
    motor_samples samples;
    motor_residuals residuals;
    int alarms = 0;
    int tick;
    int k;

    if (motor_abi() != MOTOR_ABI) {
        return 2; /* the library was compiled from another version, or with another real */
    }
    motor_nominal(&parameters);
    status = motor_configure(
        &monitor,
        &parameters,
        MOTOR_SAMPLE_TIME,
        MOTOR_BANDWIDTH,
        MOTOR_TIME_UNIT);
    if (status != MOTOR_OK) {
        return 2;
    }
    for (tick = 0; tick < TICKS; ++tick) { /* every sample_time, from a timer */
        read_samples(&samples);
        motor_step(&monitor, &samples, &residuals);
        for (k = 0; k < MOTOR_RESIDUALS; ++k) {
            const motor_real r = residuals.value[k];

            if (residuals.valid[k] && (r > threshold[k] || r < -threshold[k])) {
                raise_alarm(k, r);
                ++alarms;
            }
        }
    }
    printf("%d samples, %d alarms\n", TICKS, alarms);
    return 0;
}
