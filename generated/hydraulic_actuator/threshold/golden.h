/*
 * golden.h: signals and the thresholds that hydraulic_actuator_threshold.c must give for them.
 *
 * Computed with 40 digits when the code was generated. Every result stands beside the sum of the
 * absolute values of its terms, which is what an error is measured by.
 */
#ifndef HYDRAULIC_ACTUATOR_THRESHOLD_GOLDEN_H
#define HYDRAULIC_ACTUATOR_THRESHOLD_GOLDEN_H

#include "hydraulic_actuator_threshold.h"

#define N(x) HYDRAULIC_ACTUATOR_THRESHOLD_CONSTANT(x)

typedef struct golden_result {
    hydraulic_actuator_threshold_real value, size;
} golden_result;

enum { GOLDEN_EXACT = 4, GOLDEN_STEP = 16 };

/* The parameters that the results belong to. */
static void golden_parameters(hydraulic_actuator_threshold_parameters *parameters)
{
    hydraulic_actuator_threshold_nominal(parameters);
}

static const hydraulic_actuator_threshold_derivatives golden_derivatives[] = {
    {N(0.625), N(0.9375), N(0.34375), N(-0.875)},
    {N(0.90625), N(0.0625), N(0.03125), N(-0.15625)},
    {N(-0.3125), N(-0.90625), N(-0.09375), N(0.5)},
    {N(0.28125), N(-0.5625), N(0.1875), N(-0.71875)},
};

static const golden_result golden_exact[][2] = {
    {{(hydraulic_actuator_threshold_real)NAN, N(0.0)}, {(hydraulic_actuator_threshold_real)NAN,
    N(0.0)}},
    {{(hydraulic_actuator_threshold_real)NAN, N(0.0)}, {(hydraulic_actuator_threshold_real)NAN,
    N(0.0)}},
    {{(hydraulic_actuator_threshold_real)NAN, N(0.0)}, {(hydraulic_actuator_threshold_real)NAN,
    N(0.0)}},
    {{(hydraulic_actuator_threshold_real)NAN, N(0.0)}, {(hydraulic_actuator_threshold_real)NAN,
    N(0.0)}},
};

static const hydraulic_actuator_threshold_samples golden_samples[] = {
    {N(-0.96875), N(0.6875), N(-0.59375), N(0.09375)},
    {N(0.0625), N(-0.15625), N(-0.03125), N(0.6875)},
    {N(-0.78125), N(0.34375), N(0.4375), N(0.8125)},
    {N(-0.125), N(0.0), N(-0.25), N(-0.375)},
    {N(-0.9375), N(0.625), N(-0.1875), N(-0.0625)},
    {N(-0.34375), N(0.75), N(-0.75), N(-0.5625)},
    {N(-0.1875), N(0.25), N(0.96875), N(-0.53125)},
    {N(-0.96875), N(-0.96875), N(-0.28125), N(0.5)},
    {N(-0.34375), N(0.3125), N(0.375), N(-0.125)},
    {N(0.9375), N(-0.625), N(0.4375), N(0.375)},
    {N(-0.96875), N(0.71875), N(-0.03125), N(0.25)},
    {N(-0.125), N(-0.6875), N(-0.9375), N(0.53125)},
    {N(-0.25), N(0.6875), N(0.0), N(-0.21875)},
    {N(0.28125), N(-0.34375), N(-0.1875), N(0.21875)},
    {N(0.90625), N(0.21875), N(0.03125), N(-0.78125)},
    {N(0.21875), N(0.625), N(0.25), N(-0.90625)},
};

static const golden_result golden_step[][2] = {
    {{N(6.31509074311288e-10), N(2.5806093431359925e-09)}, {N(7.5), N(15.007499999448441)}},
    {{N(6.314538397924299e-10), N(1.360463329622781e-09)}, {N(7.504687191084529),
    N(15.385190205674618)}},
    {{N(6.312849125744167e-10), N(1.2991521004531375e-09)}, {N(7.524174819449452),
    N(15.444422086373205)}},
    {{N(6.309936696180835e-10), N(1.2954761564393775e-09)}, {N(7.555086079616665),
    N(15.515365715071646)}},
    {{N(6.30601981658369e-10), N(1.2945688423429008e-09)}, {N(7.581777385925507),
    N(15.56644368295949)}},
    {{N(6.300668088245076e-10), N(1.29365935787415e-09)}, {N(7.596107513308832),
    N(15.602968936080126)}},
    {{N(6.292838479772851e-10), N(1.291867284242498e-09)}, {N(7.593394730926548),
    N(15.598433123082486)}},
    {{N(6.281751883803574e-10), N(1.2898813344654845e-09)}, {N(7.579044555924597),
    N(15.56009789413757)}},
    {{N(6.267059678956746e-10), N(1.286594533477227e-09)}, {N(7.565002102609717),
    N(15.531649462190465)}},
    {{N(6.250746338245113e-10), N(1.2832486649272973e-09)}, {N(7.55343880080936),
    N(15.505998460494581)}},
    {{N(6.235338422939279e-10), N(1.2800573854448262e-09)}, {N(7.546248425030565),
    N(15.490895596273557)}},
    {{N(6.221699063355584e-10), N(1.2772574432635493e-09)}, {N(7.547416966806258),
    N(15.493184814933874)}},
    {{N(6.209502619302804e-10), N(1.2747227264409192e-09)}, {N(7.554132832336439),
    N(15.510783228659978)}},
    {{N(6.197614029393992e-10), N(1.2722680381285268e-09)}, {N(7.560057790646705),
    N(15.52007392132813)}},
    {{N(6.184652836433451e-10), N(1.2696674736180404e-09)}, {N(7.5583456127098),
    N(15.5286291747408)}},
    {{N(6.169680458324105e-10), N(1.2666492098928888e-09)}, {N(7.536034097813461),
    N(15.487405055028892)}},
};

#undef N

#endif
