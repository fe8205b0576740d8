/*
 * example.c: QuarterCar watched by its residuals; a program to start from.
 *
 * Put your sensors into read_samples and what to do about a fault into raise_alarm. Compile:
 *     cc -std=c99 -O2 example.c quarter_car_residuals.c -o example
 */
#include <stdio.h>

#include "quarter_car_residuals.h"

#define TICKS 5000

/* How far a residual may be from 0 while all is well: measure this on your healthy machine. */
static const quarter_car_real threshold[QUARTER_CAR_RESIDUALS] = {
    QUARTER_CAR_CONSTANT(0.001), /* r1 */
    QUARTER_CAR_CONSTANT(0.001), /* r2 */
};

static const char *const name[QUARTER_CAR_RESIDUALS] = {
    "r1", "r2",
};

/* One sample of every signal, all taken at the same moment. Here: a machine at rest. */
static void read_samples(quarter_car_samples *samples)
{
    samples->vw = 0;      /* m/s */
    samples->vb = 0;      /* m/s */
    samples->stroke = 0;  /* m: Length that the strut is compressed by, from a potentiometer */
}

static void raise_alarm(int residual, quarter_car_real value)
{
    printf("%s = %g: look for a fault that it sees\n", name[residual], (double)value);
}

int main(void)
{
    quarter_car_parameters parameters;
    quarter_car_monitor monitor;
    quarter_car_status status;
    quarter_car_samples samples;
    quarter_car_residuals residuals;
    int alarms = 0;
    int tick;
    int k;

    if (quarter_car_abi() != QUARTER_CAR_ABI) {
        return 2; /* the library was compiled from another version, or with another real */
    }
    quarter_car_nominal(&parameters);
    status = quarter_car_configure(
        &monitor,
        &parameters,
        QUARTER_CAR_SAMPLE_TIME,
        QUARTER_CAR_BANDWIDTH,
        QUARTER_CAR_TIME_UNIT);
    if (status != QUARTER_CAR_OK) {
        return 2;
    }
    for (tick = 0; tick < TICKS; ++tick) { /* every sample_time, from a timer */
        read_samples(&samples);
        quarter_car_step(&monitor, &samples, &residuals);
        for (k = 0; k < QUARTER_CAR_RESIDUALS; ++k) {
            const quarter_car_real r = residuals.value[k];

            if (residuals.valid[k] && (r > threshold[k] || r < -threshold[k])) {
                raise_alarm(k, r);
                ++alarms;
            }
        }
    }
    printf("%d samples, %d alarms\n", TICKS, alarms);
    return 0;
}
