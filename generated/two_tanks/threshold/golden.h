/*
 * golden.h: signals and the thresholds that two_tanks_threshold.c must give for them.
 *
 * Computed with 40 digits when the code was generated. Every result stands beside the sum of the
 * absolute values of its terms, which is what an error is measured by.
 */
#ifndef TWO_TANKS_THRESHOLD_GOLDEN_H
#define TWO_TANKS_THRESHOLD_GOLDEN_H

#include "two_tanks_threshold.h"

#define N(x) TWO_TANKS_THRESHOLD_CONSTANT(x)

typedef struct golden_result {
    two_tanks_threshold_real value, size;
} golden_result;

enum { GOLDEN_EXACT = 4, GOLDEN_STEP = 16 };

/* The parameters that the results belong to. */
static void golden_parameters(two_tanks_threshold_parameters *parameters)
{
    two_tanks_threshold_nominal(parameters);
}

static const two_tanks_threshold_derivatives golden_derivatives[] = {
    {N(0.625), N(0.9375)},
    {N(0.34375), N(-0.875)},
    {N(0.90625), N(0.0625)},
    {N(0.03125), N(-0.15625)},
};

static const golden_result golden_exact[][2] = {
    {{(two_tanks_threshold_real)NAN, N(0.0)}, {(two_tanks_threshold_real)NAN, N(0.0)}},
    {{(two_tanks_threshold_real)NAN, N(0.0)}, {(two_tanks_threshold_real)NAN, N(0.0)}},
    {{(two_tanks_threshold_real)NAN, N(0.0)}, {(two_tanks_threshold_real)NAN, N(0.0)}},
    {{(two_tanks_threshold_real)NAN, N(0.0)}, {(two_tanks_threshold_real)NAN, N(0.0)}},
};

static const two_tanks_threshold_samples golden_samples[] = {
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
    {{N(4.6233105022267316e-08), N(1.4000966097020692e-07)}, {N(9.383168693391674e-08),
    N(2.5907751422849873e-07)}},
    {{N(4.622404059622629e-08), N(9.723692522438229e-08)}, {N(9.381449056777464e-08),
    N(1.960857886689372e-07)}},
    {{N(4.6198076848767934e-08), N(9.503046017797715e-08)}, {N(9.376346309705154e-08),
    N(1.9280814469560398e-07)}},
    {{N(4.616688865500875e-08), N(9.485735015806762e-08)}, {N(9.369758449319767e-08),
    N(1.9251160545445072e-07)}},
    {{N(4.612785227113358e-08), N(9.478985326864136e-08)}, {N(9.361450319433565e-08),
    N(1.9235941301688655e-07)}},
    {{N(4.605784221985221e-08), N(9.463769107999257e-08)}, {N(9.347808140070197e-08),
    N(1.9206211723343107e-07)}},
    {{N(4.595794481559229e-08), N(9.441586758431459e-08)}, {N(9.329065388764816e-08),
    N(1.9165436963482818e-07)}},
    {{N(4.5839582084061956e-08), N(9.418211481169433e-08)}, {N(9.306794333898255e-08),
    N(1.9121531542325414e-07)}},
    {{N(4.569442537494345e-08), N(9.388744355249563e-08)}, {N(9.279494691967443e-08),
    N(1.906540588689188e-07)}},
    {{N(4.551597741403775e-08), N(9.351628408173545e-08)}, {N(9.246097337465268e-08),
    N(1.899654080781611e-07)}},
    {{N(4.531115731007551e-08), N(9.308263650506014e-08)}, {N(9.207660811686735e-08),
    N(1.8914784601747603e-07)}},
    {{N(4.5090919880632164e-08), N(9.262761603484223e-08)}, {N(9.166411163193868e-08),
    N(1.88296906485505e-07)}},
    {{N(4.4856364687801935e-08), N(9.216040928023987e-08)}, {N(9.122870211139555e-08),
    N(1.8742629408364057e-07)}},
    {{N(4.4598713388548895e-08), N(9.161657387077378e-08)}, {N(9.075636588563254e-08),
    N(1.8643067486587262e-07)}},
    {{N(4.4316014521144276e-08), N(9.10426372166601e-08)}, {N(9.024363199071555e-08),
    N(1.8539336704779948e-07)}},
    {{N(4.4010094647892006e-08), N(9.041275278442038e-08)}, {N(8.969509998973997e-08),
    N(1.842557229040896e-07)}},
};

#undef N

#endif
