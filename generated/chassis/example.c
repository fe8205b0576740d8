/*
 * example.c: ChassisBench watched by its residuals; a program to start from.
 *
 * Put your sensors into read_samples and what to do about a fault into tell. Compile and run:
 *     cc -std=c99 -O2 example.c chassis_bench_residuals.c -o example
 *     ./example            a machine at rest
 *     ./example log.csv    a log: a line with the names of its columns, and one for each sample
 */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "chassis_bench_residuals.h"

#define TICKS 5000
#define LONGEST 65536

/* One sample of every signal, all taken at the same moment. Here: a machine at rest. */
static void read_samples(chassis_bench_samples *samples)
{
    samples->body__Fx__1 = 0;  /* N: body.Fx[1] */
    samples->body__Fx__2 = 0;  /* N: body.Fx[2] */
    samples->u = 0;            /* m/s */
    samples->yaw = 0;          /* rad/s */
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
static bool read_log(FILE *log, const char *names, chassis_bench_samples *samples)
{
    static char line[LONGEST];

    if (fgets(line, sizeof line, log) == NULL) {
        return false;
    }
    samples->body__Fx__1 = (chassis_bench_real)column(names, line, "body.Fx[1]");
    samples->body__Fx__2 = (chassis_bench_real)column(names, line, "body.Fx[2]");
    samples->u = (chassis_bench_real)column(names, line, "u");
    samples->yaw = (chassis_bench_real)column(names, line, "yaw");
    return true;
}

/* Whether a residual went into alarm with this sample. */
static bool is_news(const chassis_bench_diagnosis *found)
{
    int k;

    for (k = 0; k < CHASSIS_BENCH_RESIDUALS; ++k) {
        if (found->state[k] == CHASSIS_BENCH_ALARM && found->since[k] == 0u) {
            return true;
        }
    }
    return false;
}

/* The names of all faults of which that is left. */
static void list(const chassis_bench_diagnosis *found, chassis_bench_candidate left, const char *between)
{
    int k;

    for (k = 0; k < CHASSIS_BENCH_FAULTS; ++k) {
        if (found->candidate[chassis_bench_fault_class[k]] == (uint8_t)left) {
            printf("%s%s", between, chassis_bench_fault_name[k]);
            between = ", ";
        }
    }
}

/* What is wrong now, in words. */
static void tell(const chassis_bench_diagnosis *found, long tick)
{
    const bool sure = found->fault_class != CHASSIS_BENCH_UNKNOWN;
    const char *between = ": ";
    int k;

    printf("sample %ld", tick);
    for (k = 0; k < CHASSIS_BENCH_RESIDUALS; ++k) {
        if (found->state[k] == CHASSIS_BENCH_ALARM) {
            printf("%s%s", between, chassis_bench_residual_name[k]);
            between = ", ";
        }
    }
    printf(" in alarm");
    list(found, CHASSIS_BENCH_LIKELY, sure ? "; one of " : "; perhaps ");
    list(found, CHASSIS_BENCH_SMALL, "; or, if it is small, ");
    printf("\n");
}

int main(int count, char **words)
{
    static char names[LONGEST];
    FILE *log = count > 1 ? fopen(words[1], "r") : NULL;
    chassis_bench_parameters parameters;
    chassis_bench_monitor monitor;
    chassis_bench_diagnosis found;
    chassis_bench_samples samples;
    chassis_bench_residuals residuals;
    chassis_bench_limit limits[CHASSIS_BENCH_RESIDUALS];
    int told = CHASSIS_BENCH_UNKNOWN;
    bool alarmed = false;
    int alarms = 0;
    long tick;

    if (chassis_bench_abi() != CHASSIS_BENCH_ABI) {
        return 2; /* the library was compiled from another version, or with another real */
    }
    if (count > 1 && !read_names(log, names)) {
        return 2;
    }
    for (tick = 0; tick < CHASSIS_BENCH_RESIDUALS; ++tick) {
        /* how far it may be from 0: measure that, or compile with a tuning, which knows more */
        limits[tick] = chassis_bench_limit_of(CHASSIS_BENCH_CONSTANT(0.001));
    }
    chassis_bench_nominal(&parameters);
    if (chassis_bench_configure(&monitor, &parameters, CHASSIS_BENCH_SAMPLE_TIME, CHASSIS_BENCH_BANDWIDTH,
            CHASSIS_BENCH_TIME_UNIT) != CHASSIS_BENCH_OK) {
        return 2;
    }
    chassis_bench_diagnosis_reset(&found);
    for (tick = 0; log != NULL || tick < TICKS; ++tick) { /* every sample_time, from a timer */
        bool alarm;

        read_samples(&samples);
        if (log != NULL && !read_log(log, names, &samples)) {
            break;
        }
        chassis_bench_step(&monitor, &samples, &residuals);
        alarm = chassis_bench_diagnose(&found, limits, NULL, &residuals);
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
