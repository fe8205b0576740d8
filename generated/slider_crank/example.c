/*
 * example.c: SliderCrank watched by its residuals; a program to start from.
 *
 * Put your sensors into read_samples and what to do about a fault into tell. Compile and run:
 *     cc -std=c99 -O2 example.c slider_crank_residuals.c -o example -lm
 *     ./example            a machine at rest
 *     ./example log.csv    a log: a line with the names of its columns, and one for each sample
 */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "slider_crank_residuals.h"

#define TICKS 5000
#define LONGEST 65536

/* One sample of every signal, all taken at the same moment. Here: a machine at rest. */
static void read_samples(slider_crank_samples *samples)
{
    samples->T = 0;      /* N.m */
    samples->load = 0;   /* N */
    samples->speed = 0;  /* rad/s */
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
static bool read_log(FILE *log, const char *names, slider_crank_samples *samples)
{
    static char line[LONGEST];

    if (fgets(line, sizeof line, log) == NULL) {
        return false;
    }
    samples->T = (slider_crank_real)column(names, line, "T");
    samples->load = (slider_crank_real)column(names, line, "load");
    samples->speed = (slider_crank_real)column(names, line, "speed");
    return true;
}

/* Whether a residual went into alarm with this sample. */
static bool is_news(const slider_crank_diagnosis *found)
{
    int k;

    for (k = 0; k < SLIDER_CRANK_RESIDUALS; ++k) {
        if (found->state[k] == SLIDER_CRANK_ALARM && found->since[k] == 0u) {
            return true;
        }
    }
    return false;
}

/* The names of all faults of which that is left. */
static void list(const slider_crank_diagnosis *found, slider_crank_candidate left, const char *between)
{
    int k;

    for (k = 0; k < SLIDER_CRANK_FAULTS; ++k) {
        if (found->candidate[slider_crank_fault_class[k]] == (uint8_t)left) {
            printf("%s%s", between, slider_crank_fault_name[k]);
            between = ", ";
        }
    }
}

/* What is wrong now, in words. */
static void tell(const slider_crank_diagnosis *found, long tick)
{
    const bool sure = found->fault_class != SLIDER_CRANK_UNKNOWN;
    const char *between = ": ";
    int k;

    printf("sample %ld", tick);
    for (k = 0; k < SLIDER_CRANK_RESIDUALS; ++k) {
        if (found->state[k] == SLIDER_CRANK_ALARM) {
            printf("%s%s", between, slider_crank_residual_name[k]);
            between = ", ";
        }
    }
    printf(" in alarm");
    list(found, SLIDER_CRANK_LIKELY, sure ? "; one of " : "; perhaps ");
    list(found, SLIDER_CRANK_SMALL, "; or, if it is small, ");
    printf("\n");
}

int main(int count, char **words)
{
    static char names[LONGEST];
    FILE *log = count > 1 ? fopen(words[1], "r") : NULL;
    slider_crank_parameters parameters;
    slider_crank_monitor monitor;
    slider_crank_diagnosis found;
    slider_crank_samples samples;
    slider_crank_residuals residuals;
    slider_crank_limit limits[SLIDER_CRANK_RESIDUALS];
    int told = SLIDER_CRANK_UNKNOWN;
    bool alarmed = false;
    int alarms = 0;
    long tick;

    if (slider_crank_abi() != SLIDER_CRANK_ABI) {
        return 2; /* the library was compiled from another version, or with another real */
    }
    if (count > 1 && !read_names(log, names)) {
        return 2;
    }
    for (tick = 0; tick < SLIDER_CRANK_RESIDUALS; ++tick) {
        /* how far it may be from 0: measure that, or compile with a tuning, which knows more */
        limits[tick] = slider_crank_limit_of(SLIDER_CRANK_CONSTANT(0.001));
    }
    slider_crank_nominal(&parameters);
    if (slider_crank_configure(&monitor, &parameters, SLIDER_CRANK_SAMPLE_TIME, SLIDER_CRANK_BANDWIDTH,
            SLIDER_CRANK_TIME_UNIT) != SLIDER_CRANK_OK) {
        return 2;
    }
    slider_crank_diagnosis_reset(&found);
    for (tick = 0; log != NULL || tick < TICKS; ++tick) { /* every sample_time, from a timer */
        bool alarm;

        read_samples(&samples);
        if (log != NULL && !read_log(log, names, &samples)) {
            break;
        }
        slider_crank_step(&monitor, &samples, &residuals);
        alarm = slider_crank_diagnose(&found, limits, NULL, &residuals);
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
