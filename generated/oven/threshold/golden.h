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
    {{N(1.0159044185965402e-11), N(1.8463901323671078e-09)}, {N(3.9417091441545766e-11),
    N(2.7693662477115663e-09)}},
    {{N(2.920703651335276e-10), N(1.8044129247117803e-08)}, {N(4.845085324404607e-10),
    N(2.66190095817451e-08)}},
    {{N(1.488312096069171e-09), N(7.525218133903599e-08)}, {N(1.7719315013278986e-09),
    N(1.0245783265378769e-07)}},
    {{N(3.137665836196629e-09), N(2.1155467724167545e-07)}, {N(3.499146214808587e-09),
    N(2.865071461372629e-07)}},
    {{N(1.2831802636529444e-08), N(4.644521560458406e-07)}, {N(1.508570066836384e-08),
    N(6.710678905580598e-07)}},
    {{N(1.898822587758377e-08), N(6.512332858794032e-07)}, {N(2.80869739531686e-08),
    N(9.64514045020996e-07)}},
    {{N(5.0037091085293616e-08), N(1.3140787072095358e-06)}, {N(9.48445072319373e-08),
    N(1.916342040026755e-06)}},
    {{N(3.3542664962563586e-08), N(1.933421644677099e-06)}, {N(1.524174971354587e-07),
    N(2.9613209094246175e-06)}},
    {{N(1.00647287148653e-07), N(3.1942174538212217e-06)}, {N(3.7528965854290264e-07),
    N(5.01634322924795e-06)}},
    {{N(1.7859514793844728e-07), N(4.081433757692055e-06)}, {N(6.450110924763526e-07),
    N(6.828065284091491e-06)}},
    {{N(4.4837650553630973e-08), N(5.6412949537789945e-06)}, {N(7.445431126068959e-07),
    N(9.73944544613996e-06)}},
    {{N(7.852256495238741e-07), N(7.507449409614091e-06)}, {N(1.704862332681187e-06),
    N(1.2249751133801914e-05)}},
    {{N(1.5876935722428133e-06), N(1.2852384451904134e-05)}, {N(2.9006748286095353e-06),
    N(1.9854220302138592e-05)}},
    {{N(2.5550578117974606e-06), N(1.54692383992687e-05)}, {N(4.35860334760247e-06),
    N(2.3764145698545335e-05)}},
    {{N(4.019799580663048e-06), N(2.2811853980065247e-05)}, {N(6.330861728627115e-06),
    N(3.4811024491910164e-05)}},
};

#undef N

#endif
