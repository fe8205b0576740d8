/*
 * example.c: RigidGear watched by its residuals; a program to start from.
 *
 * Put your sensors into read_samples and what to do about a fault into tell. Compile and run:
 *     cc -std=c99 -O2 example.c rigid_gear_residuals.c -o example
 *     ./example            a machine at rest
 *     ./example log.csv    a log: a line with the names of its columns, and one for each sample
 */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "rigid_gear_residuals.h"

#define TICKS 5000
#define LONGEST 65536

/* One sample of every signal, all taken at the same moment. Here: a machine at rest. */
static void read_samples(rigid_gear_samples *samples)
{
    samples->T = 0;   /* N.m */
    samples->w1 = 0;  /* rad/s */
    samples->w2 = 0;  /* rad/s */
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
static bool read_log(FILE *log, const char *names, rigid_gear_samples *samples)
{
    static char line[LONGEST];

    if (fgets(line, sizeof line, log) == NULL) {
        return false;
    }
    samples->T = (rigid_gear_real)column(names, line, "T");
    samples->w1 = (rigid_gear_real)column(names, line, "w1");
    samples->w2 = (rigid_gear_real)column(names, line, "w2");
    return true;
}

/* Whether a residual went into alarm with this sample. */
static bool is_news(const rigid_gear_diagnosis *found)
{
    int k;

    for (k = 0; k < RIGID_GEAR_RESIDUALS; ++k) {
        if (found->state[k] == RIGID_GEAR_ALARM && found->since[k] == 0u) {
            return true;
        }
    }
    return false;
}

/* The names of all faults of which that is left. */
static void list(const rigid_gear_diagnosis *found, rigid_gear_candidate left, const char *between)
{
    int k;

    for (k = 0; k < RIGID_GEAR_FAULTS; ++k) {
        if (found->candidate[rigid_gear_fault_class[k]] == (uint8_t)left) {
            printf("%s%s", between, rigid_gear_fault_name[k]);
            between = ", ";
        }
    }
}

/* What is wrong now, in words. */
static void tell(const rigid_gear_diagnosis *found, long tick)
{
    const bool sure = found->fault_class != RIGID_GEAR_UNKNOWN;
    const char *between = ": ";
    int k;

    printf("sample %ld", tick);
    for (k = 0; k < RIGID_GEAR_RESIDUALS; ++k) {
        if (found->state[k] == RIGID_GEAR_ALARM) {
            printf("%s%s", between, rigid_gear_residual_name[k]);
            between = ", ";
        }
    }
    printf(" in alarm");
    list(found, RIGID_GEAR_LIKELY, sure ? "; one of " : "; perhaps ");
    list(found, RIGID_GEAR_SMALL, "; or, if it is small, ");
    printf("\n");
}

int main(int count, char **words)
{
    static char names[LONGEST];
    FILE *log = count > 1 ? fopen(words[1], "r") : NULL;
    rigid_gear_parameters parameters;
    rigid_gear_monitor monitor;
    rigid_gear_diagnosis found;
    rigid_gear_samples samples;
    rigid_gear_residuals residuals;
    rigid_gear_limit limits[RIGID_GEAR_RESIDUALS];
    int told = RIGID_GEAR_UNKNOWN;
    bool alarmed = false;
    int alarms = 0;
    long tick;

    if (rigid_gear_abi() != RIGID_GEAR_ABI) {
        return 2; /* the library was compiled from another version, or with another real */
    }
    if (count > 1 && !read_names(log, names)) {
        return 2;
    }
    for (tick = 0; tick < RIGID_GEAR_RESIDUALS; ++tick) {
        /* how far it may be from 0: measure that, or compile with a tuning, which knows more */
        limits[tick] = rigid_gear_limit_of(RIGID_GEAR_CONSTANT(0.001));
    }
    rigid_gear_nominal(&parameters);
    if (rigid_gear_configure(&monitor, &parameters, RIGID_GEAR_SAMPLE_TIME, RIGID_GEAR_BANDWIDTH,
            RIGID_GEAR_TIME_UNIT) != RIGID_GEAR_OK) {
        return 2;
    }
    rigid_gear_diagnosis_reset(&found);
    for (tick = 0; log != NULL || tick < TICKS; ++tick) { /* every sample_time, from a timer */
        bool alarm;

        read_samples(&samples);
        if (log != NULL && !read_log(log, names, &samples)) {
            break;
        }
        rigid_gear_step(&monitor, &samples, &residuals);
        alarm = rigid_gear_diagnose(&found, limits, NULL, &residuals);
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
