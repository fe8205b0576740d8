/*
 * golden.h: signals and the thresholds that slider_crank_threshold.c must give for them.
 *
 * Computed with 40 digits when the code was generated. Every result stands beside the sum of the
 * absolute values of its terms, which is what an error is measured by.
 */
#ifndef SLIDER_CRANK_THRESHOLD_GOLDEN_H
#define SLIDER_CRANK_THRESHOLD_GOLDEN_H

#include "slider_crank_threshold.h"

#define N(x) SLIDER_CRANK_THRESHOLD_CONSTANT(x)

typedef struct golden_result {
    slider_crank_threshold_real value, size;
} golden_result;

enum { GOLDEN_EXACT = 4, GOLDEN_STEP = 16 };

/* The parameters that the results belong to. */
static void golden_parameters(slider_crank_threshold_parameters *parameters)
{
    slider_crank_threshold_nominal(parameters);
}

static const slider_crank_threshold_derivatives golden_derivatives[] = {
    {N(0.625)},
    {N(0.9375)},
    {N(0.34375)},
    {N(-0.875)},
};

static const golden_result golden_exact[][1] = {
    {{(slider_crank_threshold_real)NAN, N(0.0)}},
    {{(slider_crank_threshold_real)NAN, N(0.0)}},
    {{(slider_crank_threshold_real)NAN, N(0.0)}},
    {{(slider_crank_threshold_real)NAN, N(0.0)}},
};

static const slider_crank_threshold_samples golden_samples[] = {
    {N(0.90625)},
    {N(0.0625)},
    {N(0.03125)},
    {N(-0.15625)},
    {N(-0.3125)},
    {N(-0.90625)},
    {N(-0.09375)},
    {N(0.5)},
    {N(0.28125)},
    {N(-0.5625)},
    {N(0.1875)},
    {N(-0.71875)},
    {N(-0.96875)},
    {N(0.6875)},
    {N(-0.59375)},
    {N(0.09375)},
};

static const golden_result golden_step[][1] = {
    {{N(9.062500000000001e-05), N(0.00018134062498039718)}},
    {{N(9.061672875755525e-05), N(0.0001859208114874454)}},
    {{N(9.058366501571294e-05), N(0.00018608545011879367)}},
    {{N(9.051607189792232e-05), N(0.00018595914850094087)}},
    {{N(9.040981568216928e-05), N(0.00018574256254550668)}},
    {{N(9.025573209689492e-05), N(0.00018543705131779468)}},
    {{N(9.0050549299726e-05), N(0.00018499413702796665)}},
    {{N(8.981228111610567e-05), N(0.0001844973168996946)}},
    {{N(8.955977972496675e-05), N(0.00018397663477859674)}},
    {{N(8.928696276315864e-05), N(0.00018342722607191908)}},
    {{N(8.898339920194082e-05), N(0.00018278982170419206)}},
    {{N(8.864796302436221e-05), N(0.0001821130597544979)}},
    {{N(8.826916999234731e-05), N(0.0001813398186170631)}},
    {{N(8.785131938848777e-05), N(0.0001804572843472503)}},
    {{N(8.741356690861774e-05), N(0.0001795660126234294)}},
    {{N(8.695472047595286e-05), N(0.00017860878629897173)}},
};

#undef N

#endif
