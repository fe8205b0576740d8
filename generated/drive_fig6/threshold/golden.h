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
    {{N(0.02363616821654373), N(13.457910250541083)}, {N(0.0), N(0.0)}},
    {{N(0.024916060782262595), N(0.7404650897362178)}, {N(0.0), N(0.0)}},
    {{N(0.02886261824106712), N(0.09695199429463583)}, {N(0.0), N(0.0)}},
    {{N(0.03432698703791052), N(0.0894147492340198)}, {N(0.0), N(0.0)}},
    {{N(0.0428281681576532), N(0.10058524508964466)}, {N(0.0), N(0.0)}},
    {{N(0.053075641415785954), N(0.11213812444403913)}, {N(0.0), N(0.0)}},
    {{N(0.059226546933268245), N(0.1499283562143213)}, {N(0.0), N(0.0)}},
    {{N(0.05688820810706892), N(0.12577157451614296)}, {N(0.0), N(0.0)}},
    {{N(0.0477997930523501), N(0.12782824393512587)}, {N(0.0), N(0.0)}},
    {{N(0.0328906944041943), N(0.094610997422338)}, {N(0.0), N(0.0)}},
    {{N(0.013799847127218285), N(0.07566461736044894)}, {N(0.0), N(0.0)}},
    {{N(0.02024272579751874), N(0.06041995386808254)}, {N(0.0), N(0.0)}},
    {{N(0.04362395962690807), N(0.1031025534215425)}, {N(0.0), N(0.0)}},
    {{N(0.06583823692645775), N(0.15163650126294978)}, {N(0.0), N(0.0)}},
    {{N(0.09425646554717647), N(0.21777724302403573)}, {N(0.0), N(0.0)}},
    {{N(0.12997367866317025), N(0.2778473829647421)}, {N(0.0), N(0.0)}},
};

#undef N

#endif
