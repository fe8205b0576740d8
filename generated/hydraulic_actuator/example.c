/*
 * example.c: HydraulicActuator watched by its residuals; a program to start from.
 *
 * Put your sensors into read_samples and what to do about a fault into tell. Compile and run:
 *     cc -std=c99 -O2 example.c hydraulic_actuator_residuals.c -o example -lm
 *     ./example            a machine at rest
 *     ./example log.csv    a log: a line with the names of its columns, and one for each sample
 */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "hydraulic_actuator_residuals.h"

#define TICKS 5000
#define LONGEST 65536

/* One sample of every signal, all taken at the same moment. Here: a machine at rest. */
static void read_samples(hydraulic_actuator_samples *samples)
{
    samples->ps = 0;     /* Pa */
    samples->spool = 0;  /* 1 */
    samples->load = 0;   /* N */
    samples->p = 0;      /* Pa */
    samples->v = 0;      /* m/s */
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
static bool read_log(FILE *log, const char *names, hydraulic_actuator_samples *samples)
{
    static char line[LONGEST];

    if (fgets(line, sizeof line, log) == NULL) {
        return false;
    }
    samples->ps = (hydraulic_actuator_real)column(names, line, "ps");
    samples->spool = (hydraulic_actuator_real)column(names, line, "spool");
    samples->load = (hydraulic_actuator_real)column(names, line, "load");
    samples->p = (hydraulic_actuator_real)column(names, line, "p");
    samples->v = (hydraulic_actuator_real)column(names, line, "v");
    return true;
}

/* Whether a residual went into alarm with this sample. */
static bool is_news(const hydraulic_actuator_diagnosis *found)
{
    int k;

    for (k = 0; k < HYDRAULIC_ACTUATOR_RESIDUALS; ++k) {
        if (found->state[k] == HYDRAULIC_ACTUATOR_ALARM && found->since[k] == 0u) {
            return true;
        }
    }
    return false;
}

/* The names of all faults of which that is left. */
static void list(const hydraulic_actuator_diagnosis *found, hydraulic_actuator_candidate left, const char *between)
{
    int k;

    for (k = 0; k < HYDRAULIC_ACTUATOR_FAULTS; ++k) {
        if (found->candidate[hydraulic_actuator_fault_class[k]] == (uint8_t)left) {
            printf("%s%s", between, hydraulic_actuator_fault_name[k]);
            between = ", ";
        }
    }
}

/* What is wrong now, in words. */
static void tell(const hydraulic_actuator_diagnosis *found, long tick)
{
    const bool sure = found->fault_class != HYDRAULIC_ACTUATOR_UNKNOWN;
    const char *between = ": ";
    int k;

    printf("sample %ld", tick);
    for (k = 0; k < HYDRAULIC_ACTUATOR_RESIDUALS; ++k) {
        if (found->state[k] == HYDRAULIC_ACTUATOR_ALARM) {
            printf("%s%s", between, hydraulic_actuator_residual_name[k]);
            between = ", ";
        }
    }
    printf(" in alarm");
    list(found, HYDRAULIC_ACTUATOR_LIKELY, sure ? "; one of " : "; perhaps ");
    list(found, HYDRAULIC_ACTUATOR_SMALL, "; or, if it is small, ");
    printf("\n");
}

int main(int count, char **words)
{
    static char names[LONGEST];
    FILE *log = count > 1 ? fopen(words[1], "r") : NULL;
    hydraulic_actuator_parameters parameters;
    hydraulic_actuator_monitor monitor;
    hydraulic_actuator_diagnosis found;
    hydraulic_actuator_samples samples;
    hydraulic_actuator_residuals residuals;
    hydraulic_actuator_limit limits[HYDRAULIC_ACTUATOR_RESIDUALS];
    int told = HYDRAULIC_ACTUATOR_UNKNOWN;
    bool alarmed = false;
    int alarms = 0;
    long tick;

    if (hydraulic_actuator_abi() != HYDRAULIC_ACTUATOR_ABI) {
        return 2; /* the library was compiled from another version, or with another real */
    }
    if (count > 1 && !read_names(log, names)) {
        return 2;
    }
    for (tick = 0; tick < HYDRAULIC_ACTUATOR_RESIDUALS; ++tick) {
        /* how far it may be from 0: measure that, or compile with a tuning, which knows more */
        limits[tick] = hydraulic_actuator_limit_of(HYDRAULIC_ACTUATOR_CONSTANT(0.001));
    }
    hydraulic_actuator_nominal(&parameters);
    if (hydraulic_actuator_configure(&monitor, &parameters, HYDRAULIC_ACTUATOR_SAMPLE_TIME, HYDRAULIC_ACTUATOR_BANDWIDTH,
            HYDRAULIC_ACTUATOR_TIME_UNIT) != HYDRAULIC_ACTUATOR_OK) {
        return 2;
    }
    hydraulic_actuator_diagnosis_reset(&found);
    for (tick = 0; log != NULL || tick < TICKS; ++tick) { /* every sample_time, from a timer */
        bool alarm;

        read_samples(&samples);
        if (log != NULL && !read_log(log, names, &samples)) {
            break;
        }
        hydraulic_actuator_step(&monitor, &samples, &residuals);
        alarm = hydraulic_actuator_diagnose(&found, limits, NULL, &residuals);
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
