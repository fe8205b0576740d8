/*
 * example.c: QuarterCar watched by its residuals; a program to start from.
 *
 * Put your sensors into read_samples and what to do about a fault into tell. Compile and run:
 *     cc -std=c99 -O2 example.c quarter_car_residuals.c -o example
 *     ./example            a machine at rest
 *     ./example log.csv    a log: a line with the names of its columns, and one for each sample
 */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "quarter_car_residuals.h"

#define TICKS 5000
#define LONGEST 65536

/* One sample of every signal, all taken at the same moment. Here: a machine at rest. */
static void read_samples(quarter_car_samples *samples)
{
    samples->vw = 0;      /* m/s */
    samples->vb = 0;      /* m/s */
    samples->stroke = 0;  /* m: Length that the strut is compressed by, from a potentiometer */
}

/* The value in a column of the log; all columns are looked for in its first line. */
static double column(const char *names, const char *values, const char *name)
{
    const size_t length = strlen(name);
    const char *at = names;
    const char *value = values;

    while (strncmp(at, name, length) != 0 || strchr(",\r\n", at[length]) == NULL) {
        at = strchr(at, ',');
        value = strchr(value, ',');
        if (at == NULL || value == NULL) {
            fprintf(stderr, "no value of %s in: %s", name, values);
            exit(2);
        }
        ++at;
        ++value;
    }
    return atof(value);
}

/* The names of the columns, behind lines that tell about the log; false where there are none. */
static bool read_names(FILE *log, char *names)
{
    if (log == NULL) {
        return false;
    }
    do {
        if (fgets(names, LONGEST, log) == NULL) {
            return false;
        }
    } while (names[0] == '#');
    return true;
}

/* The next sample of the log; false at its end. */
static bool read_log(FILE *log, const char *names, quarter_car_samples *samples)
{
    static char line[LONGEST];

    if (fgets(line, sizeof line, log) == NULL) {
        return false;
    }
    samples->vw = (quarter_car_real)column(names, line, "vw");
    samples->vb = (quarter_car_real)column(names, line, "vb");
    samples->stroke = (quarter_car_real)column(names, line, "stroke");
    return true;
}

/* Whether a residual went into alarm with this sample. */
static bool is_news(const quarter_car_diagnosis *found)
{
    int k;

    for (k = 0; k < QUARTER_CAR_RESIDUALS; ++k) {
        if (found->state[k] == QUARTER_CAR_ALARM && found->since[k] == 0u) {
            return true;
        }
    }
    return false;
}

/* The names of all faults of which that is left. */
static void list(const quarter_car_diagnosis *found, quarter_car_candidate left, const char *between)
{
    int k;

    for (k = 0; k < QUARTER_CAR_FAULTS; ++k) {
        if (found->candidate[quarter_car_fault_class[k]] == (uint8_t)left) {
            printf("%s%s", between, quarter_car_fault_name[k]);
            between = ", ";
        }
    }
}

/* What is wrong now, in words. */
static void tell(const quarter_car_diagnosis *found, long tick)
{
    const bool sure = found->fault_class != QUARTER_CAR_UNKNOWN;
    const char *between = ": ";
    int k;

    printf("sample %ld", tick);
    for (k = 0; k < QUARTER_CAR_RESIDUALS; ++k) {
        if (found->state[k] == QUARTER_CAR_ALARM) {
            printf("%s%s", between, quarter_car_residual_name[k]);
            between = ", ";
        }
    }
    printf(" in alarm");
    list(found, QUARTER_CAR_LIKELY, sure ? "; one of " : "; perhaps ");
    list(found, QUARTER_CAR_SMALL, "; or, if it is small, ");
    printf("\n");
}

int main(int count, char **words)
{
    static char names[LONGEST];
    FILE *log = count > 1 ? fopen(words[1], "r") : NULL;
    quarter_car_parameters parameters;
    quarter_car_monitor monitor;
    quarter_car_diagnosis found;
    quarter_car_samples samples;
    quarter_car_residuals residuals;
    quarter_car_limit limits[QUARTER_CAR_RESIDUALS];
    int told = QUARTER_CAR_UNKNOWN;
    bool alarmed = false;
    int alarms = 0;
    long tick;

    if (quarter_car_abi() != QUARTER_CAR_ABI) {
        return 2; /* the library was compiled from another version, or with another real */
    }
    if (count > 1 && !read_names(log, names)) {
        return 2;
    }
    for (tick = 0; tick < QUARTER_CAR_RESIDUALS; ++tick) {
        /* how far it may be from 0: measure that, or compile with a tuning, which knows more */
        limits[tick] = quarter_car_limit_of(QUARTER_CAR_CONSTANT(0.001));
    }
    quarter_car_nominal(&parameters);
    if (quarter_car_configure(&monitor, &parameters, QUARTER_CAR_SAMPLE_TIME, QUARTER_CAR_BANDWIDTH,
            QUARTER_CAR_TIME_UNIT) != QUARTER_CAR_OK) {
        return 2;
    }
    quarter_car_diagnosis_reset(&found);
    for (tick = 0; log != NULL || tick < TICKS; ++tick) { /* every sample_time, from a timer */
        bool alarm;

        read_samples(&samples);
        if (log != NULL && !read_log(log, names, &samples)) {
            break;
        }
        quarter_car_step(&monitor, &samples, &residuals);
        alarm = quarter_car_diagnose(&found, limits, NULL, &residuals);
        if (alarm && (is_news(&found) || found.fault_class != told)) {
            tell(&found, tick);
            alarms += alarmed ? 0 : 1;
            told = found.fault_class;
        }
        alarmed = alarm;
    }
    printf("%ld samples, %d alarms\n", tick, alarms);
    return 0;
}
