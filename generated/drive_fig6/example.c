/*
 * example.c: DriveAsDrawn watched by its residuals; a program to start from.
 *
 * Put your sensors into read_samples and what to do about a fault into tell. Compile and run:
 *     cc -std=c99 -O2 example.c drive_as_drawn_residuals.c -o example -lm
 *     ./example            a machine at rest
 *     ./example log.csv    a log: a line with the names of its columns, and one for each sample
 */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "drive_as_drawn_residuals.h"

#define TICKS 5000
#define LONGEST 65536

/* One sample of every signal, all taken at the same moment. Here: a machine at rest. */
static void read_samples(drive_as_drawn_samples *samples)
{
    samples->U0 = 0;      /* V */
    samples->Fx = 0;      /* N */
    samples->me__we = 0;  /* rad/s: me.we */
    samples->wh__ws = 0;  /* rad/s: wh.ws */
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
static bool read_log(FILE *log, const char *names, drive_as_drawn_samples *samples)
{
    static char line[LONGEST];

    if (fgets(line, sizeof line, log) == NULL) {
        return false;
    }
    samples->U0 = (drive_as_drawn_real)column(names, line, "U0");
    samples->Fx = (drive_as_drawn_real)column(names, line, "Fx");
    samples->me__we = (drive_as_drawn_real)column(names, line, "me.we");
    samples->wh__ws = (drive_as_drawn_real)column(names, line, "wh.ws");
    return true;
}

/* Whether a residual went into alarm with this sample. */
static bool is_news(const drive_as_drawn_diagnosis *found)
{
    int k;

    for (k = 0; k < DRIVE_AS_DRAWN_RESIDUALS; ++k) {
        if (found->state[k] == DRIVE_AS_DRAWN_ALARM && found->since[k] == 0u) {
            return true;
        }
    }
    return false;
}

/* The names of all faults of which that is left. */
static void list(const drive_as_drawn_diagnosis *found, drive_as_drawn_candidate left, const char *between)
{
    int k;

    for (k = 0; k < DRIVE_AS_DRAWN_FAULTS; ++k) {
        if (found->candidate[drive_as_drawn_fault_class[k]] == (uint8_t)left) {
            printf("%s%s", between, drive_as_drawn_fault_name[k]);
            between = ", ";
        }
    }
}

/* What is wrong now, in words. */
static void tell(const drive_as_drawn_diagnosis *found, long tick)
{
    const bool sure = found->fault_class != DRIVE_AS_DRAWN_UNKNOWN;
    const char *between = ": ";
    int k;

    printf("sample %ld", tick);
    for (k = 0; k < DRIVE_AS_DRAWN_RESIDUALS; ++k) {
        if (found->state[k] == DRIVE_AS_DRAWN_ALARM) {
            printf("%s%s", between, drive_as_drawn_residual_name[k]);
            between = ", ";
        }
    }
    printf(" in alarm");
    list(found, DRIVE_AS_DRAWN_LIKELY, sure ? "; one of " : "; perhaps ");
    list(found, DRIVE_AS_DRAWN_SMALL, "; or, if it is small, ");
    printf("\n");
}

int main(int count, char **words)
{
    static char names[LONGEST];
    FILE *log = count > 1 ? fopen(words[1], "r") : NULL;
    drive_as_drawn_parameters parameters;
    drive_as_drawn_monitor monitor;
    drive_as_drawn_diagnosis found;
    drive_as_drawn_samples samples;
    drive_as_drawn_residuals residuals;
    drive_as_drawn_limit limits[DRIVE_AS_DRAWN_RESIDUALS];
    int told = DRIVE_AS_DRAWN_UNKNOWN;
    bool alarmed = false;
    int alarms = 0;
    long tick;

    if (drive_as_drawn_abi() != DRIVE_AS_DRAWN_ABI) {
        return 2; /* the library was compiled from another version, or with another real */
    }
    if (count > 1 && !read_names(log, names)) {
        return 2;
    }
    for (tick = 0; tick < DRIVE_AS_DRAWN_RESIDUALS; ++tick) {
        /* how far it may be from 0: measure that, or compile with a tuning, which knows more */
        limits[tick] = drive_as_drawn_limit_of(DRIVE_AS_DRAWN_CONSTANT(0.001));
    }
    drive_as_drawn_nominal(&parameters);
    if (drive_as_drawn_configure(&monitor, &parameters, DRIVE_AS_DRAWN_SAMPLE_TIME, DRIVE_AS_DRAWN_BANDWIDTH,
            DRIVE_AS_DRAWN_TIME_UNIT) != DRIVE_AS_DRAWN_OK) {
        return 2;
    }
    drive_as_drawn_diagnosis_reset(&found);
    for (tick = 0; log != NULL || tick < TICKS; ++tick) { /* every sample_time, from a timer */
        bool alarm;

        read_samples(&samples);
        if (log != NULL && !read_log(log, names, &samples)) {
            break;
        }
        drive_as_drawn_step(&monitor, &samples, &residuals);
        alarm = drive_as_drawn_diagnose(&found, limits, NULL, &residuals);
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
