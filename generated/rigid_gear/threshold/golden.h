/*
 * golden.h: signals and the thresholds that rigid_gear_threshold.c must give for them.
 *
 * Computed with 40 digits when the code was generated. Every result stands beside the sum of the
 * absolute values of its terms, which is what an error is measured by.
 */
#ifndef RIGID_GEAR_THRESHOLD_GOLDEN_H
#define RIGID_GEAR_THRESHOLD_GOLDEN_H

#include "rigid_gear_threshold.h"

#define N(x) RIGID_GEAR_THRESHOLD_CONSTANT(x)

typedef struct golden_result {
    rigid_gear_threshold_real value, size;
} golden_result;

enum { GOLDEN_EXACT = 4, GOLDEN_STEP = 16 };

/* The parameters that the results belong to. */
static void golden_parameters(rigid_gear_threshold_parameters *parameters)
{
    rigid_gear_threshold_nominal(parameters);
}

static const rigid_gear_threshold_derivatives golden_derivatives[] = {
    {N(0.625), N(0.9375)},
    {N(0.34375), N(-0.875)},
    {N(0.90625), N(0.0625)},
    {N(0.03125), N(-0.15625)},
};

static const golden_result golden_exact[][2] = {
    {{(rigid_gear_threshold_real)NAN, N(0.0)}, {(rigid_gear_threshold_real)NAN, N(0.0)}},
    {{(rigid_gear_threshold_real)NAN, N(0.0)}, {(rigid_gear_threshold_real)NAN, N(0.0)}},
    {{(rigid_gear_threshold_real)NAN, N(0.0)}, {(rigid_gear_threshold_real)NAN, N(0.0)}},
    {{(rigid_gear_threshold_real)NAN, N(0.0)}, {(rigid_gear_threshold_real)NAN, N(0.0)}},
};

static const rigid_gear_threshold_samples golden_samples[] = {
    {N(-0.3125), N(-0.90625)},
    {N(-0.09375), N(0.5)},
    {N(0.28125), N(-0.5625)},
    {N(0.1875), N(-0.71875)},
    {N(-0.96875), N(0.6875)},
    {N(-0.59375), N(0.09375)},
    {N(0.0625), N(-0.15625)},
    {N(-0.03125), N(0.6875)},
    {N(-0.78125), N(0.34375)},
    {N(0.4375), N(0.8125)},
    {N(-0.125), N(0.0)},
    {N(-0.25), N(-0.375)},
    {N(-0.9375), N(0.625)},
    {N(-0.1875), N(-0.0625)},
    {N(-0.34375), N(0.75)},
    {N(-0.75), N(-0.5625)},
};

static const golden_result golden_step[][2] = {
    {{N(0.00018229166666666667), N(0.0003647656248920275)}, {N(0.0), N(0.0)}},
    {{N(0.00018226638050423697), N(0.000373683247602341)}, {N(0.0), N(0.0)}},
    {{N(0.00018218034704342296), N(0.00037396550054333614)}, {N(0.0), N(0.0)}},
    {{N(0.0001820418900238367), N(0.00037370022507326057)}, {N(0.0), N(0.0)}},
    {{N(0.000181861935873646), N(0.0003733507131551786)}, {N(0.0), N(0.0)}},
    {{N(0.00018162841515594765), N(0.00037285528524233)}, {N(0.0), N(0.0)}},
    {{N(0.00018134164142188166), N(0.0003722606724946522)}, {N(0.0), N(0.0)}},
    {{N(0.00018099215109862937), N(0.0003715642225684247)}, {N(0.0), N(0.0)}},
    {{N(0.00018056753098207945), N(0.0003706847031365013)}, {N(0.0), N(0.0)}},
    {{N(0.00018006431299238482), N(0.0003696743718745338)}, {N(0.0), N(0.0)}},
    {{N(0.00017947836205076855), N(0.0003684396484475304)}, {N(0.0), N(0.0)}},
    {{N(0.0001788386537070405), N(0.0003671184021478485)}, {N(0.0), N(0.0)}},
    {{N(0.00017817125048393034), N(0.00036576853499236653)}, {N(0.0), N(0.0)}},
    {{N(0.00017746951281120835), N(0.00036431144125548915)}, {N(0.0), N(0.0)}},
    {{N(0.00017672146720127118), N(0.0003627969185131375)}, {N(0.0), N(0.0)}},
    {{N(0.00017593518705774015), N(0.000361161453619853)}, {N(0.0), N(0.0)}},
};

#undef N

#endif
