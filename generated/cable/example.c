/*
 * example.c: CableBench watched by its residuals; a program to start from.
 *
 * Put your sensors into read_samples and what to do about a fault into tell. Compile and run:
 *     cc -std=c99 -O2 example.c cable_bench_residuals.c -o example
 *     ./example            a machine at rest
 *     ./example log.csv    a log: a line with the names of its columns, and one for each sample
 */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cable_bench_residuals.h"

#define TICKS 5000
#define LONGEST 65536

/* One sample of every signal, all taken at the same moment. Here: a machine at rest. */
static void read_samples(cable_bench_samples *samples)
{
    samples->Uin = 0;  /* V */
    samples->Us = 0;   /* V */
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
static bool read_log(FILE *log, const char *names, cable_bench_samples *samples)
{
    static char line[LONGEST];

    if (fgets(line, sizeof line, log) == NULL) {
        return false;
    }
    samples->Uin = (cable_bench_real)column(names, line, "Uin");
    samples->Us = (cable_bench_real)column(names, line, "Us");
    return true;
}

/* Whether a residual went into alarm with this sample. */
static bool is_news(const cable_bench_diagnosis *found)
{
    int k;

    for (k = 0; k < CABLE_BENCH_RESIDUALS; ++k) {
        if (found->state[k] == CABLE_BENCH_ALARM && found->since[k] == 0u) {
            return true;
        }
    }
    return false;
}

/* The names of all faults of which that is left. */
static void list(const cable_bench_diagnosis *found, cable_bench_candidate left, const char *between)
{
    int k;

    for (k = 0; k < CABLE_BENCH_FAULTS; ++k) {
        if (found->candidate[cable_bench_fault_class[k]] == (uint8_t)left) {
            printf("%s%s", between, cable_bench_fault_name[k]);
            between = ", ";
        }
    }
}

/* What is wrong now, in words. */
static void tell(const cable_bench_diagnosis *found, long tick)
{
    const bool sure = found->fault_class != CABLE_BENCH_UNKNOWN;
    const char *between = ": ";
    int k;

    printf("sample %ld", tick);
    for (k = 0; k < CABLE_BENCH_RESIDUALS; ++k) {
        if (found->state[k] == CABLE_BENCH_ALARM) {
            printf("%s%s", between, cable_bench_residual_name[k]);
            between = ", ";
        }
    }
    printf(" in alarm");
    list(found, CABLE_BENCH_LIKELY, sure ? "; one of " : "; perhaps ");
    list(found, CABLE_BENCH_SMALL, "; or, if it is small, ");
    printf("\n");
}

int main(int count, char **words)
{
    static char names[LONGEST];
    FILE *log = count > 1 ? fopen(words[1], "r") : NULL;
    cable_bench_parameters parameters;
    cable_bench_monitor monitor;
    cable_bench_diagnosis found;
    cable_bench_samples samples;
    cable_bench_residuals residuals;
    cable_bench_limit limits[CABLE_BENCH_RESIDUALS];
    int told = CABLE_BENCH_UNKNOWN;
    bool alarmed = false;
    int alarms = 0;
    long tick;

    if (cable_bench_abi() != CABLE_BENCH_ABI) {
        return 2; /* the library was compiled from another version, or with another real */
    }
    if (count > 1 && !read_names(log, names)) {
        return 2;
    }
    for (tick = 0; tick < CABLE_BENCH_RESIDUALS; ++tick) {
        /* how far it may be from 0: measure that, or compile with a tuning, which knows more */
        limits[tick] = cable_bench_limit_of(CABLE_BENCH_CONSTANT(0.001));
    }
    cable_bench_nominal(&parameters);
    if (cable_bench_configure(&monitor, &parameters, CABLE_BENCH_SAMPLE_TIME, CABLE_BENCH_BANDWIDTH,
            CABLE_BENCH_TIME_UNIT) != CABLE_BENCH_OK) {
        return 2;
    }
    cable_bench_diagnosis_reset(&found);
    for (tick = 0; log != NULL || tick < TICKS; ++tick) { /* every sample_time, from a timer */
        bool alarm;

        read_samples(&samples);
        if (log != NULL && !read_log(log, names, &samples)) {
            break;
        }
        cable_bench_step(&monitor, &samples, &residuals);
        alarm = cable_bench_diagnose(&found, limits, NULL, &residuals);
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
