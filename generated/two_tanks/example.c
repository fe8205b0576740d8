/*
 * example.c: TwoTanks watched by its residuals; a program to start from.
 *
 * Put your sensors into read_samples and what to do about a fault into tell. Compile and run:
 *     cc -std=c99 -O2 example.c two_tanks_residuals.c -o example -lm
 *     ./example            a machine at rest
 *     ./example log.csv    a log: a line with the names of its columns, and one for each sample
 */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "two_tanks_residuals.h"

#define TICKS 5000
#define LONGEST 65536

/* One sample of every signal, all taken at the same moment. Here: a machine at rest. */
static void read_samples(two_tanks_samples *samples)
{
    samples->Q = 0;   /* m^3/s */
    samples->p1 = 0;  /* Pa */
    samples->p2 = 0;  /* Pa */
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
static bool read_log(FILE *log, const char *names, two_tanks_samples *samples)
{
    static char line[LONGEST];

    if (fgets(line, sizeof line, log) == NULL) {
        return false;
    }
    samples->Q = (two_tanks_real)column(names, line, "Q");
    samples->p1 = (two_tanks_real)column(names, line, "p1");
    samples->p2 = (two_tanks_real)column(names, line, "p2");
    return true;
}

/* Whether a residual went into alarm with this sample. */
static bool is_news(const two_tanks_diagnosis *found)
{
    int k;

    for (k = 0; k < TWO_TANKS_RESIDUALS; ++k) {
        if (found->state[k] == TWO_TANKS_ALARM && found->since[k] == 0u) {
            return true;
        }
    }
    return false;
}

/* The names of all faults of which that is left. */
static void list(const two_tanks_diagnosis *found, two_tanks_candidate left, const char *between)
{
    int k;

    for (k = 0; k < TWO_TANKS_FAULTS; ++k) {
        if (found->candidate[two_tanks_fault_class[k]] == (uint8_t)left) {
            printf("%s%s", between, two_tanks_fault_name[k]);
            between = ", ";
        }
    }
}

/* What is wrong now, in words. */
static void tell(const two_tanks_diagnosis *found, long tick)
{
    const bool sure = found->fault_class != TWO_TANKS_UNKNOWN;
    const char *between = ": ";
    int k;

    printf("sample %ld", tick);
    for (k = 0; k < TWO_TANKS_RESIDUALS; ++k) {
        if (found->state[k] == TWO_TANKS_ALARM) {
            printf("%s%s", between, two_tanks_residual_name[k]);
            between = ", ";
        }
    }
    printf(" in alarm");
    list(found, TWO_TANKS_LIKELY, sure ? "; one of " : "; perhaps ");
    list(found, TWO_TANKS_SMALL, "; or, if it is small, ");
    printf("\n");
}

int main(int count, char **words)
{
    static char names[LONGEST];
    FILE *log = count > 1 ? fopen(words[1], "r") : NULL;
    two_tanks_parameters parameters;
    two_tanks_monitor monitor;
    two_tanks_diagnosis found;
    two_tanks_samples samples;
    two_tanks_residuals residuals;
    two_tanks_limit limits[TWO_TANKS_RESIDUALS];
    int told = TWO_TANKS_UNKNOWN;
    bool alarmed = false;
    int alarms = 0;
    long tick;

    if (two_tanks_abi() != TWO_TANKS_ABI) {
        return 2; /* the library was compiled from another version, or with another real */
    }
    if (count > 1 && !read_names(log, names)) {
        return 2;
    }
    for (tick = 0; tick < TWO_TANKS_RESIDUALS; ++tick) {
        /* how far it may be from 0: measure that, or compile with a tuning, which knows more */
        limits[tick] = two_tanks_limit_of(TWO_TANKS_CONSTANT(0.001));
    }
    two_tanks_nominal(&parameters);
    if (two_tanks_configure(&monitor, &parameters, TWO_TANKS_SAMPLE_TIME, TWO_TANKS_BANDWIDTH,
            TWO_TANKS_TIME_UNIT) != TWO_TANKS_OK) {
        return 2;
    }
    two_tanks_diagnosis_reset(&found);
    for (tick = 0; log != NULL || tick < TICKS; ++tick) { /* every sample_time, from a timer */
        bool alarm;

        read_samples(&samples);
        if (log != NULL && !read_log(log, names, &samples)) {
            break;
        }
        two_tanks_step(&monitor, &samples, &residuals);
        alarm = two_tanks_diagnose(&found, limits, NULL, &residuals);
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
