/*
 * example.c: HydraulicActuator watched by its residuals; a program to start from.
 *
 * Put your sensors into read_samples and what to do about a fault into raise_alarm. Compile:
 *     cc -std=c99 -O2 example.c hydraulic_actuator_residuals.c -o example -lm
 */
#include <stdio.h>

#include "hydraulic_actuator_residuals.h"

#define TICKS 5000

/* How far a residual may be from 0 while all is well: measure this on your healthy machine. */
static const hydraulic_actuator_real threshold[HYDRAULIC_ACTUATOR_RESIDUALS] = {
    HYDRAULIC_ACTUATOR_CONSTANT(0.001), /* r1 */
    HYDRAULIC_ACTUATOR_CONSTANT(0.001), /* r2 */
};

static const char *const name[HYDRAULIC_ACTUATOR_RESIDUALS] = {
    "r1", "r2",
};

/* One sample of every signal, all taken at the same moment. Here: a machine at rest. */
static void read_samples(hydraulic_actuator_samples *samples)
{
    samples->ps = 0;     /* Pa */
    samples->spool = 0;  /* 1 */
    samples->load = 0;   /* N */
    samples->p = 0;      /* Pa */
    samples->v = 0;      /* m/s */
}

static void raise_alarm(int residual, hydraulic_actuator_real value)
{
    printf("%s = %g: look for a fault that it sees\n", name[residual], (double)value);
}

int main(void)
{
    hydraulic_actuator_parameters parameters;
    hydraulic_actuator_monitor monitor;
    hydraulic_actuator_status status;
    hydraulic_actuator_samples samples;
    hydraulic_actuator_residuals residuals;
    int alarms = 0;
    int tick;
    int k;

    if (hydraulic_actuator_abi() != HYDRAULIC_ACTUATOR_ABI) {
        return 2; /* the library was compiled from another version, or with another real */
    }
    hydraulic_actuator_nominal(&parameters);
    status = hydraulic_actuator_configure(
        &monitor,
        &parameters,
        HYDRAULIC_ACTUATOR_SAMPLE_TIME,
        HYDRAULIC_ACTUATOR_BANDWIDTH,
        HYDRAULIC_ACTUATOR_TIME_UNIT);
    if (status != HYDRAULIC_ACTUATOR_OK) {
        return 2;
    }
    for (tick = 0; tick < TICKS; ++tick) { /* every sample_time, from a timer */
        read_samples(&samples);
        hydraulic_actuator_step(&monitor, &samples, &residuals);
        for (k = 0; k < HYDRAULIC_ACTUATOR_RESIDUALS; ++k) {
            const hydraulic_actuator_real r = residuals.value[k];

            if (residuals.valid[k] && (r > threshold[k] || r < -threshold[k])) {
                raise_alarm(k, r);
                ++alarms;
            }
        }
    }
    printf("%d samples, %d alarms\n", TICKS, alarms);
    return 0;
}
