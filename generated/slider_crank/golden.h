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
    {{N(0.06253125), N(0.06497128125)}},
    {{N(0.06244536235877715), N(0.0659705398620372)}},
    {{N(0.06256020509547564), N(0.06588750576986149)}},
    {{N(0.06308028420294039), N(0.06641046555667011)}},
    {{N(0.06352936473754754), N(0.06707562233411572)}},
    {{N(0.06330388511785096), N(0.06731364967052612)}},
    {{N(0.06288722159210039), N(0.06642786290730295)}},
    {{N(0.06283539945000716), N(0.06618097741433572)}},
    {{N(0.06267749291113599), N(0.06618358633893939)}},
    {{N(0.06205376008607927), N(0.06562317052056528)}},
    {{N(0.060992817930948566), N(0.06500418040884948)}},
    {{N(0.059986882068450174), N(0.06366584633631657)}},
    {{N(0.059194728227992634), N(0.06257651552211846)}},
    {{N(0.05860127451542493), N(0.06172784519371002)}},
    {{N(0.057954786192356264), N(0.06120381921888715)}},
    {{N(0.05703619025391865), N(0.060194477748515045)}},
};

#undef N

#endif
