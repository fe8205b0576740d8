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
    {{N(0.00018226654658040062), N(0.00037398056998034834)}, {N(0.0), N(0.0)}},
    {{N(0.000182180744389261), N(0.00037426299083295343)}, {N(0.0), N(0.0)}},
    {{N(0.00018204239158859607), N(0.0003739950970823814)}, {N(0.0), N(0.0)}},
    {{N(0.00018186258908240338), N(0.00037364571254927385)}, {N(0.0), N(0.0)}},
    {{N(0.0001816292472806659), N(0.00037314102875731853)}, {N(0.0), N(0.0)}},
    {{N(0.00018134261688613416), N(0.0003725406940864723)}, {N(0.0), N(0.0)}},
    {{N(0.00018099336093433042), N(0.00037184243135470385)}, {N(0.0), N(0.0)}},
    {{N(0.00018056895914097363), N(0.0003709559425954337)}, {N(0.0), N(0.0)}},
    {{N(0.00018006598922169244), N(0.00036994274218710843)}, {N(0.0), N(0.0)}},
    {{N(0.0001794802748666526), N(0.00036869353554036153)}, {N(0.0), N(0.0)}},
    {{N(0.00017884061462159045), N(0.00036736926050910527)}, {N(0.0), N(0.0)}},
    {{N(0.00017817326934298965), N(0.0003660209948632131)}, {N(0.0), N(0.0)}},
    {{N(0.000177471621384985), N(0.00036455464678015467)}, {N(0.0), N(0.0)}},
    {{N(0.00017672370976305808), N(0.000363039963935974)}, {N(0.0), N(0.0)}},
    {{N(0.00017593746233840444), N(0.00036139849051929914)}, {N(0.0), N(0.0)}},
};

#undef N

#endif
