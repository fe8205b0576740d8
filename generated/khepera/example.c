/*
 * example.c: Khepera watched by its residuals; a program to start from.
 *
 * Put your sensors into read_samples and what to do about a fault into tell. Compile and run:
 *     cc -std=c99 -O2 example.c khepera_residuals.c -o example -lm
 *     ./example            a machine at rest
 *     ./example log.csv    a log: a line with the names of its columns, and one for each sample
 */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "khepera_residuals.h"

#define TICKS 5000
#define LONGEST 65536

/* One sample of every signal, all taken at the same moment. Here: a machine at rest. */
static void read_samples(khepera_samples *samples)
{
    /* N: Contact forces, known as in the paper; each loads its wheel and moves the body, Fx[1] */
    samples->Fx__1 = 0;
    /* N: Contact forces, known as in the paper; each loads its wheel and moves the body, Fx[2] */
    samples->Fx__2 = 0;
    samples->U0__1 = 0;         /* V: U0[1] */
    samples->U0__2 = 0;         /* V: U0[2] */
    samples->Uin = 0;           /* V */
    samples->m__1__me__we = 0;  /* rad/s: m[1].me.we */
    samples->m__1__wh__ws = 0;  /* rad/s: m[1].wh.ws */
    samples->m__2__me__we = 0;  /* rad/s: m[2].me.we */
    samples->m__2__wh__ws = 0;  /* rad/s: m[2].wh.ws */
    samples->Us = 0;            /* V */
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
static bool read_log(FILE *log, const char *names, khepera_samples *samples)
{
    static char line[LONGEST];

    if (fgets(line, sizeof line, log) == NULL) {
        return false;
    }
    samples->Fx__1 = (khepera_real)column(names, line, "Fx[1]");
    samples->Fx__2 = (khepera_real)column(names, line, "Fx[2]");
    samples->U0__1 = (khepera_real)column(names, line, "U0[1]");
    samples->U0__2 = (khepera_real)column(names, line, "U0[2]");
    samples->Uin = (khepera_real)column(names, line, "Uin");
    samples->m__1__me__we = (khepera_real)column(names, line, "m[1].me.we");
    samples->m__1__wh__ws = (khepera_real)column(names, line, "m[1].wh.ws");
    samples->m__2__me__we = (khepera_real)column(names, line, "m[2].me.we");
    samples->m__2__wh__ws = (khepera_real)column(names, line, "m[2].wh.ws");
    samples->Us = (khepera_real)column(names, line, "Us");
    return true;
}

/* Whether a residual went into alarm with this sample. */
static bool is_news(const khepera_diagnosis *found)
{
    int k;

    for (k = 0; k < KHEPERA_RESIDUALS; ++k) {
        if (found->state[k] == KHEPERA_ALARM && found->since[k] == 0u) {
            return true;
        }
    }
    return false;
}

/* The names of all faults of which that is left. */
static void list(const khepera_diagnosis *found, khepera_candidate left, const char *between)
{
    int k;

    for (k = 0; k < KHEPERA_FAULTS; ++k) {
        if (found->candidate[khepera_fault_class[k]] == (uint8_t)left) {
            printf("%s%s", between, khepera_fault_name[k]);
            between = ", ";
        }
    }
}

/* What is wrong now, in words. */
static void tell(const khepera_diagnosis *found, long tick)
{
    const bool sure = found->fault_class != KHEPERA_UNKNOWN;
    const char *between = ": ";
    int k;

    printf("sample %ld", tick);
    for (k = 0; k < KHEPERA_RESIDUALS; ++k) {
        if (found->state[k] == KHEPERA_ALARM) {
            printf("%s%s", between, khepera_residual_name[k]);
            between = ", ";
        }
    }
    printf(" in alarm");
    list(found, KHEPERA_LIKELY, sure ? "; one of " : "; perhaps ");
    list(found, KHEPERA_SMALL, "; or, if it is small, ");
    printf("\n");
}

int main(int count, char **words)
{
    static char names[LONGEST];
    FILE *log = count > 1 ? fopen(words[1], "r") : NULL;
    khepera_parameters parameters;
    khepera_monitor monitor;
    khepera_diagnosis found;
    khepera_samples samples;
    khepera_residuals residuals;
    khepera_limit limits[KHEPERA_RESIDUALS];
    int told = KHEPERA_UNKNOWN;
    bool alarmed = false;
    int alarms = 0;
    long tick;

    if (khepera_abi() != KHEPERA_ABI) {
        return 2; /* the library was compiled from another version, or with another real */
    }
    if (count > 1 && !read_names(log, names)) {
        return 2;
    }
    for (tick = 0; tick < KHEPERA_RESIDUALS; ++tick) {
        /* how far it may be from 0: measure that, or compile with a tuning, which knows more */
        limits[tick] = khepera_limit_of(KHEPERA_CONSTANT(0.001));
    }
    khepera_nominal(&parameters);
    if (khepera_configure(&monitor, &parameters, KHEPERA_SAMPLE_TIME, KHEPERA_BANDWIDTH,
            KHEPERA_TIME_UNIT) != KHEPERA_OK) {
        return 2;
    }
    khepera_diagnosis_reset(&found);
    for (tick = 0; log != NULL || tick < TICKS; ++tick) { /* every sample_time, from a timer */
        bool alarm;

        read_samples(&samples);
        if (log != NULL && !read_log(log, names, &samples)) {
            break;
        }
        khepera_step(&monitor, &samples, &residuals);
        alarm = khepera_diagnose(&found, limits, NULL, &residuals);
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
