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
    {{N(0.02363616821654373), N(13.457910250541083)}, {N(0.0), N(0.0)}},
    {{N(0.024916460528918535), N(0.7404168196535851)}, {N(0.0), N(0.0)}},
    {{N(0.028867051805764328), N(0.0968708297164472)}, {N(0.0), N(0.0)}},
    {{N(0.03434742216327307), N(0.08934262581825568)}, {N(0.0), N(0.0)}},
    {{N(0.04288858926054015), N(0.10057917733709462)}, {N(0.0), N(0.0)}},
    {{N(0.05321454191149029), N(0.11228435134105634)}, {N(0.0), N(0.0)}},
    {{N(0.0594983903429859), N(0.15032028261489896)}, {N(0.0), N(0.0)}},
    {{N(0.05736189634055109), N(0.1263581589583912)}, {N(0.0), N(0.0)}},
    {{N(0.0485544011923471), N(0.1288559192456692)}, {N(0.0), N(0.0)}},
    {{N(0.03401101828647996), N(0.09632896383497742)}, {N(0.0), N(0.0)}},
    {{N(0.015371920060320458), N(0.07816963420461381)}, {N(0.0), N(0.0)}},
    {{N(0.018135463092942717), N(0.05609244047434174)}, {N(0.0), N(0.0)}},
    {{N(0.040904129051155), N(0.09741226415231762)}, {N(0.0), N(0.0)}},
    {{N(0.062433708074803106), N(0.14451224675695631)}, {N(0.0), N(0.0)}},
    {{N(0.09009792093093007), N(0.20907661209460554)}, {N(0.0), N(0.0)}},
    {{N(0.12500024066133814), N(0.2674422588995249)}, {N(0.0), N(0.0)}},
};

#undef N

#endif
