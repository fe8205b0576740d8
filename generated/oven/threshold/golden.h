/*
 * golden.h: signals and the thresholds that oven_threshold.c must give for them.
 *
 * Computed with 40 digits when the code was generated. Every result stands beside the sum of the
 * absolute values of its terms, which is what an error is measured by.
 */
#ifndef OVEN_THRESHOLD_GOLDEN_H
#define OVEN_THRESHOLD_GOLDEN_H

#include "oven_threshold.h"

#define N(x) OVEN_THRESHOLD_CONSTANT(x)

typedef struct golden_result {
    oven_threshold_real value, size;
} golden_result;

enum { GOLDEN_EXACT = 4, GOLDEN_STEP = 16 };

/* The parameters that the results belong to. */
static void golden_parameters(oven_threshold_parameters *parameters)
{
    oven_threshold_nominal(parameters);
}

static const oven_threshold_derivatives golden_derivatives[] = {
    {true, N(0.625), N(0.9375), N(0.34375)},
    {true, N(0.90625), N(0.0625), N(0.03125)},
    {false, N(-0.3125), N(-0.90625), N(-0.09375)},
    {false, N(0.28125), N(-0.5625), N(0.1875)},
};

static const golden_result golden_exact[][2] = {
    {{(oven_threshold_real)NAN, N(0.0)}, {(oven_threshold_real)NAN, N(0.0)}},
    {{(oven_threshold_real)NAN, N(0.0)}, {(oven_threshold_real)NAN, N(0.0)}},
    {{(oven_threshold_real)NAN, N(0.0)}, {(oven_threshold_real)NAN, N(0.0)}},
    {{(oven_threshold_real)NAN, N(0.0)}, {(oven_threshold_real)NAN, N(0.0)}},
};

static const oven_threshold_samples golden_samples[] = {
    {false, N(1.8125), N(1.484375), N(1.375)},
    {false, N(1.640625), N(1.15625), N(1.078125)},
    {false, N(1.453125), N(1.0625), N(1.40625)},
    {false, N(1.171875), N(1.4375), N(1.296875)},
    {false, N(1.5), N(1.828125), N(1.296875)},
    {false, N(1.828125), N(1.140625), N(1.921875)},
    {false, N(1.75), N(1.1875), N(1.109375)},
    {false, N(1.65625), N(1.53125), N(1.453125)},
    {false, N(1.96875), N(1.65625), N(1.125)},
    {false, N(1.6875), N(1.515625), N(1.640625)},
    {false, N(1.828125), N(1.109375), N(1.46875)},
    {false, N(1.640625), N(1.0625), N(1.921875)},
    {false, N(1.65625), N(1.140625), N(1.046875)},
    {false, N(1.78125), N(1.453125), N(1.609375)},
    {false, N(1.28125), N(1.015625), N(1.25)},
    {false, N(1.796875), N(1.09375), N(1.75)},
};

static const golden_result golden_step[][2] = {
    {{N(0.0), N(0.0)}, {N(0.0), N(0.0)}},
    {{N(1.5088287912949726e-11), N(3.6066821395235847e-09)}, {N(5.854255710224495e-11),
    N(5.398212856784799e-09)}},
    {{N(4.633617457422641e-10), N(3.478276537763814e-08)}, {N(6.639915345127305e-10),
    N(5.1055224290770114e-08)}},
    {{N(1.2426998334661917e-09), N(1.40476244968317e-07)}, {N(1.4418726815700542e-09),
    N(1.9137603124806306e-07)}},
    {{N(5.18097450743683e-09), N(3.9953515826700993e-07)}, {N(5.860694736496893e-09),
    N(5.412920463661524e-07)}},
    {{N(6.867806086905577e-09), N(8.314055882543448e-07)}, {N(8.82320502391932e-09),
    N(1.2173649824265533e-06)}},
    {{N(1.7702159349225655e-08), N(1.1650057079839445e-06)}, {N(3.003745500429705e-08),
    N(1.7343839181287306e-06)}},
    {{N(4.828756097427471e-08), N(2.3683148308145955e-06)}, {N(9.444299620400182e-08),
    N(3.4174312556495507e-06)}},
    {{N(1.8068177319065225e-08), N(3.459175064759109e-06)}, {N(1.4635434911680355e-07),
    N(5.1835724471314505e-06)}},
    {{N(9.441710439733369e-08), N(5.740694549820669e-06)}, {N(3.686878993610251e-07),
    N(8.649912646129476e-06)}},
    {{N(1.5819375057759406e-07), N(7.072557568420937e-06)}, {N(6.313482734081271e-07),
    N(1.1354292008278733e-05)}},
    {{N(1.0564226588300592e-07), N(1.0503615810634557e-05)}, {N(7.95551105249329e-07),
    N(1.6844447595477965e-05)}},
    {{N(7.708523016164448e-07), N(1.2282255305215259e-05)}, {N(1.7118467335726918e-06),
    N(1.9387519544607276e-05)}},
    {{N(1.600783420172662e-06), N(2.1194256949947014e-05)}, {N(2.918919934130283e-06),
    N(3.1917307398710313e-05)}},
    {{N(2.5820426410126572e-06), N(2.378034443379694e-05)}, {N(4.3841151691982594e-06),
    N(3.578252891532872e-05)}},
    {{N(4.123261561009594e-06), N(3.555792051399151e-05)}, {N(6.43429283768414e-06),
    N(5.381456484995614e-05)}},
};

#undef N

#endif
