/*
 * golden.h: signals and the thresholds that drive_as_drawn_threshold.c must give for them.
 *
 * Computed with 40 digits when the code was generated. Every result stands beside the sum of the
 * absolute values of its terms, which is what an error is measured by.
 */
#ifndef DRIVE_AS_DRAWN_THRESHOLD_GOLDEN_H
#define DRIVE_AS_DRAWN_THRESHOLD_GOLDEN_H

#include "drive_as_drawn_threshold.h"

#define N(x) DRIVE_AS_DRAWN_THRESHOLD_CONSTANT(x)

typedef struct golden_result {
    drive_as_drawn_threshold_real value, size;
} golden_result;

enum { GOLDEN_EXACT = 4, GOLDEN_STEP = 16 };

/* The parameters that the results belong to. */
static void golden_parameters(drive_as_drawn_threshold_parameters *parameters)
{
    drive_as_drawn_threshold_nominal(parameters);
}

static const drive_as_drawn_threshold_derivatives golden_derivatives[] = {
    {N(0.625), N(0.9375), N(0.34375)},
    {N(-0.875), N(0.90625), N(0.0625)},
    {N(0.03125), N(-0.15625), N(-0.3125)},
    {N(-0.90625), N(-0.09375), N(0.5)},
};

static const golden_result golden_exact[][2] = {
    {{(drive_as_drawn_threshold_real)NAN, N(0.0)}, {(drive_as_drawn_threshold_real)NAN, N(0.0)}},
    {{(drive_as_drawn_threshold_real)NAN, N(0.0)}, {(drive_as_drawn_threshold_real)NAN, N(0.0)}},
    {{(drive_as_drawn_threshold_real)NAN, N(0.0)}, {(drive_as_drawn_threshold_real)NAN, N(0.0)}},
    {{(drive_as_drawn_threshold_real)NAN, N(0.0)}, {(drive_as_drawn_threshold_real)NAN, N(0.0)}},
};

static const drive_as_drawn_threshold_samples golden_samples[] = {
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
    {{N(0.025058208857719432), N(0.5944984001772861)}, {N(0.0), N(0.0)}},
    {{N(0.02883476329011956), N(0.08779605801604733)}, {N(0.0), N(0.0)}},
    {{N(0.034471576778140924), N(0.0735384800513769)}, {N(0.0), N(0.0)}},
    {{N(0.042907515726416434), N(0.08966942721737932)}, {N(0.0), N(0.0)}},
    {{N(0.05302964245933749), N(0.11049160172973799)}, {N(0.0), N(0.0)}},
    {{N(0.0589035782991074), N(0.12807141079967876)}, {N(0.0), N(0.0)}},
    {{N(0.056788129668903), N(0.12310351455420702)}, {N(0.0), N(0.0)}},
    {{N(0.047497161952447804), N(0.1103164058557145)}, {N(0.0), N(0.0)}},
    {{N(0.03285421028505166), N(0.08718065147763406)}, {N(0.0), N(0.0)}},
    {{N(0.013418387211901599), N(0.05255347666348016)}, {N(0.0), N(0.0)}},
    {{N(0.02022647298902803), N(0.046754757131861696)}, {N(0.0), N(0.0)}},
    {{N(0.04363426032826745), N(0.0926798147964367)}, {N(0.0), N(0.0)}},
    {{N(0.06612949583029024), N(0.13637177919605512)}, {N(0.0), N(0.0)}},
    {{N(0.09466093490777758), N(0.1944550756631444)}, {N(0.0), N(0.0)}},
    {{N(0.13004914093790704), N(0.26867715847249424)}, {N(0.0), N(0.0)}},
};

#undef N

#endif
