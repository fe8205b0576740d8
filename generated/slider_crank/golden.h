/*
 * golden.h: signals and the residuals that slider_crank_residuals.c must give for them.
 *
 * Computed with 40 digits when the code was generated. Every result stands beside the sum of the
 * absolute values of its terms, which is what an error is measured by.
 */
#ifndef SLIDER_CRANK_GOLDEN_H
#define SLIDER_CRANK_GOLDEN_H

#include "slider_crank_residuals.h"

#define N(x) SLIDER_CRANK_CONSTANT(x)

typedef struct golden_result {
    slider_crank_real value, size;
} golden_result;

enum { GOLDEN_EXACT = 4, GOLDEN_STEP = 16 };

/* The parameters that the results belong to. */
static void golden_parameters(slider_crank_parameters *parameters)
{
    slider_crank_nominal(parameters);
}

static const slider_crank_derivatives golden_derivatives[] = {
    {N(0.625), N(0.9375), {N(0.34375), N(-448.0)}, N(0.90625)},
    {N(0.0625), N(0.03125), {N(-0.15625), N(-160.0)}, N(-0.90625)},
    {N(-0.09375), N(0.5), {N(0.28125), N(-288.0)}, N(0.1875)},
    {N(-0.71875), N(-0.96875), {N(0.6875), N(-304.0)}, N(0.09375)},
};

static const golden_result golden_exact[][1] = {
    {{N(1.7262779549820835), N(2.9099455634437077)}},
    {{N(0.47146767699389597), N(0.8537606089810156)}},
    {{N(0.4873285888664079), N(0.7321449301990381)}},
    {{N(-0.1042380278757128), N(1.3523256108159378)}},
};

static const slider_crank_samples golden_samples[] = {
    {N(0.0625), N(-0.15625), N(-0.03125)},
    {N(0.6875), N(-0.78125), N(0.34375)},
    {N(0.4375), N(0.8125), N(-0.125)},
    {N(0.0), N(-0.25), N(-0.375)},
    {N(-0.9375), N(0.625), N(-0.1875)},
    {N(-0.0625), N(-0.34375), N(0.75)},
    {N(-0.75), N(-0.5625), N(-0.1875)},
    {N(0.25), N(0.96875), N(-0.53125)},
    {N(-0.96875), N(-0.96875), N(-0.28125)},
    {N(0.5), N(-0.34375), N(0.3125)},
    {N(0.375), N(-0.125), N(0.9375)},
    {N(-0.625), N(0.4375), N(0.375)},
    {N(-0.96875), N(0.71875), N(-0.03125)},
    {N(0.25), N(-0.125), N(-0.6875)},
    {N(-0.9375), N(0.53125), N(-0.25)},
    {N(0.6875), N(0.0), N(-0.21875)},
};

static const golden_result golden_step[][1] = {
    {{N(0.06253125), N(0.06603361716986102)}},
    {{N(0.06242502703689034), N(0.06742366844766992)}},
    {{N(0.06254757042323027), N(0.06683594701352998)}},
    {{N(0.06308194719608497), N(0.06661196353080968)}},
    {{N(0.06356258359381185), N(0.06894454069059057)}},
    {{N(0.06330918438676375), N(0.067663371670256)}},
    {{N(0.06291410463469296), N(0.06792709828263717)}},
    {{N(0.06282848130159982), N(0.06680427922242388)}},
    {{N(0.06271153725185329), N(0.06807338274701276)}},
    {{N(0.062039590970589344), N(0.06664088133591703)}},
    {{N(0.06098354594414903), N(0.06590667977579023)}},
    {{N(0.06001005893618075), N(0.06494746100406806)}},
    {{N(0.05922872679777433), N(0.06440229262013214)}},
    {{N(0.058593700660334314), N(0.062325545515255716)}},
    {{N(0.057987345834581275), N(0.06298257840760524)}},
    {{N(0.057014542567914675), N(0.06150410345437696)}},
};

#undef N

#endif
