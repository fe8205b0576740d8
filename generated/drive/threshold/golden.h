/*
 * golden.h: signals and the thresholds that drive_bench_threshold.c must give for them.
 *
 * Computed with 40 digits when the code was generated. Every result stands beside the sum of the
 * absolute values of its terms, which is what an error is measured by.
 */
#ifndef DRIVE_BENCH_THRESHOLD_GOLDEN_H
#define DRIVE_BENCH_THRESHOLD_GOLDEN_H

#include "drive_bench_threshold.h"

#define N(x) DRIVE_BENCH_THRESHOLD_CONSTANT(x)

typedef struct golden_result {
    drive_bench_threshold_real value, size;
} golden_result;

enum { GOLDEN_EXACT = 4, GOLDEN_STEP = 16 };

/* The parameters that the results belong to. */
static void golden_parameters(drive_bench_threshold_parameters *parameters)
{
    drive_bench_threshold_nominal(parameters);
}

static const drive_bench_threshold_derivatives golden_derivatives[] = {
    {N(0.625), N(0.9375), N(0.34375)},
    {N(-0.875), N(0.90625), N(0.0625)},
    {N(0.03125), N(-0.15625), N(-0.3125)},
    {N(-0.90625), N(-0.09375), N(0.5)},
};

static const golden_result golden_exact[][2] = {
    {{(drive_bench_threshold_real)NAN, N(0.0)}, {(drive_bench_threshold_real)NAN, N(0.0)}},
    {{(drive_bench_threshold_real)NAN, N(0.0)}, {(drive_bench_threshold_real)NAN, N(0.0)}},
    {{(drive_bench_threshold_real)NAN, N(0.0)}, {(drive_bench_threshold_real)NAN, N(0.0)}},
    {{(drive_bench_threshold_real)NAN, N(0.0)}, {(drive_bench_threshold_real)NAN, N(0.0)}},
};

static const drive_bench_threshold_samples golden_samples[] = {
    {N(0.28125), N(-0.5625), N(0.1875)},
    {N(-0.71875), N(-0.96875), N(0.6875)},
    {N(-0.59375), N(0.09375), N(0.0625)},
    {N(-0.15625), N(-0.03125), N(0.6875)},
    {N(-0.78125), N(0.34375), N(0.4375)},
    {N(0.8125), N(-0.125), N(0.0)},
    {N(-0.25), N(-0.375), N(-0.9375)},
    {N(0.625), N(-0.1875), N(-0.0625)},
    {N(-0.34375), N(0.75), N(-0.75)},
    {N(-0.5625), N(-0.1875), N(0.25)},
    {N(0.96875), N(-0.53125), N(-0.96875)},
    {N(-0.96875), N(-0.28125), N(0.5)},
    {N(-0.34375), N(0.3125), N(0.375)},
    {N(-0.125), N(0.9375), N(-0.625)},
    {N(0.4375), N(0.375), N(-0.96875)},
    {N(0.71875), N(-0.03125), N(0.25)},
};

static const golden_result golden_step[][2] = {
    {{N(0.02363616821654373), N(10.878599168281248)}, {N(0.0), N(0.0)}},
    {{N(0.025059021216207355), N(0.59449761616544)}, {N(0.0), N(0.0)}},
    {{N(0.028840960501025865), N(0.08780071255606894)}, {N(0.0), N(0.0)}},
    {{N(0.0344958366602228), N(0.07357232895628542)}, {N(0.0), N(0.0)}},
    {{N(0.04297441929970559), N(0.08978112597331414)}, {N(0.0), N(0.0)}},
    {{N(0.05317829262343619), N(0.11076011228118553)}, {N(0.0), N(0.0)}},
    {{N(0.05918853085384852), N(0.12860797800746943)}, {N(0.0), N(0.0)}},
    {{N(0.05727787352944127), N(0.12384582856595369)}, {N(0.0), N(0.0)}},
    {{N(0.048270500474780854), N(0.1115181618293019)}, {N(0.0), N(0.0)}},
    {{N(0.033995779924409546), N(0.08902960190342556)}, {N(0.0), N(0.0)}},
    {{N(0.01501424367801339), N(0.055224313470337384)}, {N(0.0), N(0.0)}},
    {{N(0.01809299252559992), N(0.04250450803820953)}, {N(0.0), N(0.0)}},
    {{N(0.040885021676669284), N(0.08703769181431566)}, {N(0.0), N(0.0)}},
    {{N(0.06269104453331824), N(0.12930766919135916)}, {N(0.0), N(0.0)}},
    {{N(0.09046459453932187), N(0.18583199663806144)}, {N(0.0), N(0.0)}},
    {{N(0.12503544065106714), N(0.25837358405122246)}, {N(0.0), N(0.0)}},
};

#undef N

#endif
