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
    {{N(9.061667407218282e-05), N(0.00018577425910929913)}},
    {{N(9.058350236325655e-05), N(0.00018593833970100416)}},
    {{N(9.051579358537363e-05), N(0.00018581397330101723)}},
    {{N(9.040940653620933e-05), N(0.00018559979163481846)}},
    {{N(9.025515168864793e-05), N(0.0001852957064560898)}},
    {{N(9.004982258089067e-05), N(0.0001848600315684561)}},
    {{N(8.981150843848296e-05), N(0.0001843651560151099)}},
    {{N(8.955898886798775e-05), N(0.0001838460325162593)}},
    {{N(8.928608693397712e-05), N(0.00018329723779990142)}},
    {{N(8.89824385354944e-05), N(0.00018266463896431993)}},
    {{N(8.864691340251887e-05), N(0.00018198818569785874)}},
    {{N(8.826796321879517e-05), N(0.00018121801550608486)}},
    {{N(8.785005744925218e-05), N(0.0001803412049372028)}},
    {{N(8.741227891240924e-05), N(0.0001794507260213044)}},
    {{N(8.695337172567222e-05), N(0.00017849862531305865)}},
};

#undef N

#endif
