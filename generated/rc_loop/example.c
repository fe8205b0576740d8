/*
 * example.c: RcLoop watched by its residuals; a program to start from.
 *
 * Put your sensors into read_samples and what to do about a fault into tell. Compile and run:
 *     cc -std=c99 -O2 example.c rc_loop_residuals.c -o example
 *     ./example            a machine at rest
 *     ./example log.csv    a log: a line with the names of its columns, and one for each sample
 */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "rc_loop_residuals.h"

#define TICKS 5000
#define LONGEST 65536

/* One sample of every signal, all taken at the same moment. Here: a machine at rest. */
static void read_samples(rc_loop_samples *samples)
{
    samples->U = 0;   /* - */
    samples->ua = 0;  /* - */
    samples->uc = 0;  /* - */
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
static bool read_log(FILE *log, const char *names, rc_loop_samples *samples)
{
    static char line[LONGEST];

    if (fgets(line, sizeof line, log) == NULL) {
        return false;
    }
    samples->U = (rc_loop_real)column(names, line, "U");
    samples->ua = (rc_loop_real)column(names, line, "ua");
    samples->uc = (rc_loop_real)column(names, line, "uc");
    return true;
}

/* Whether a residual went into alarm with this sample. */
static bool is_news(const rc_loop_diagnosis *found)
{
    int k;

    for (k = 0; k < RC_LOOP_RESIDUALS; ++k) {
        if (found->state[k] == RC_LOOP_ALARM && found->since[k] == 0u) {
            return true;
        }
    }
    return false;
}

/* The names of all faults of which that is left. */
static void list(const rc_loop_diagnosis *found, rc_loop_candidate left, const char *between)
{
    int k;

    for (k = 0; k < RC_LOOP_FAULTS; ++k) {
        if (found->candidate[rc_loop_fault_class[k]] == (uint8_t)left) {
            printf("%s%s", between, rc_loop_fault_name[k]);
            between = ", ";
        }
    }
}

/* What is wrong now, in words. */
static void tell(const rc_loop_diagnosis *found, long tick)
{
    const bool sure = found->fault_class != RC_LOOP_UNKNOWN;
    const char *between = ": ";
    int k;

    printf("sample %ld", tick);
    for (k = 0; k < RC_LOOP_RESIDUALS; ++k) {
        if (found->state[k] == RC_LOOP_ALARM) {
            printf("%s%s", between, rc_loop_residual_name[k]);
            between = ", ";
        }
    }
    printf(" in alarm");
    list(found, RC_LOOP_LIKELY, sure ? "; one of " : "; perhaps ");
    list(found, RC_LOOP_SMALL, "; or, if it is small, ");
    printf("\n");
}

int main(int count, char **words)
{
    static char names[LONGEST];
    FILE *log = count > 1 ? fopen(words[1], "r") : NULL;
    rc_loop_parameters parameters;
    rc_loop_monitor monitor;
    rc_loop_diagnosis found;
    rc_loop_samples samples;
    rc_loop_residuals residuals;
    rc_loop_limit limits[RC_LOOP_RESIDUALS];
    int told = RC_LOOP_UNKNOWN;
    bool alarmed = false;
    int alarms = 0;
    long tick;

    if (rc_loop_abi() != RC_LOOP_ABI) {
        return 2; /* the library was compiled from another version, or with another real */
    }
    if (count > 1 && !read_names(log, names)) {
        return 2;
    }
    for (tick = 0; tick < RC_LOOP_RESIDUALS; ++tick) {
        /* how far it may be from 0: measure that, or compile with a tuning, which knows more */
        limits[tick] = rc_loop_limit_of(RC_LOOP_CONSTANT(0.001));
    }
    rc_loop_nominal(&parameters);
    if (rc_loop_configure(&monitor, &parameters, RC_LOOP_SAMPLE_TIME, RC_LOOP_BANDWIDTH,
            RC_LOOP_TIME_UNIT) != RC_LOOP_OK) {
        return 2;
    }
    rc_loop_diagnosis_reset(&found);
    for (tick = 0; log != NULL || tick < TICKS; ++tick) { /* every sample_time, from a timer */
        bool alarm;

        read_samples(&samples);
        if (log != NULL && !read_log(log, names, &samples)) {
            break;
        }
        rc_loop_step(&monitor, &samples, &residuals);
        alarm = rc_loop_diagnose(&found, limits, NULL, &residuals);
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
