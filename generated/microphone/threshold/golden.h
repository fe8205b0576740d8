/*
 * golden.h: signals and the thresholds that microphone_threshold.c must give for them.
 *
 * Computed with 40 digits when the code was generated. Every result stands beside the sum of the
 * absolute values of its terms, which is what an error is measured by.
 */
#ifndef MICROPHONE_THRESHOLD_GOLDEN_H
#define MICROPHONE_THRESHOLD_GOLDEN_H

#include "microphone_threshold.h"

#define N(x) MICROPHONE_THRESHOLD_CONSTANT(x)

typedef struct golden_result {
    microphone_threshold_real value, size;
} golden_result;

enum { GOLDEN_EXACT = 4, GOLDEN_STEP = 16 };

/* The parameters that the results belong to. */
static void golden_parameters(microphone_threshold_parameters *parameters)
{
    microphone_threshold_nominal(parameters);
}

static const microphone_threshold_derivatives golden_derivatives[] = {
    {N(0.625), N(0.9375), N(0.34375)},
    {N(-0.875), N(0.90625), N(0.0625)},
    {N(0.03125), N(-0.15625), N(-0.3125)},
    {N(-0.90625), N(-0.09375), N(0.5)},
};

static const golden_result golden_exact[][2] = {
    {{(microphone_threshold_real)NAN, N(0.0)}, {(microphone_threshold_real)NAN, N(0.0)}},
    {{(microphone_threshold_real)NAN, N(0.0)}, {(microphone_threshold_real)NAN, N(0.0)}},
    {{(microphone_threshold_real)NAN, N(0.0)}, {(microphone_threshold_real)NAN, N(0.0)}},
    {{(microphone_threshold_real)NAN, N(0.0)}, {(microphone_threshold_real)NAN, N(0.0)}},
};

static const microphone_threshold_samples golden_samples[] = {
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
    {{N(4.440789473684211e-09), N(8.886019739001947e-09)}, {N(7.500000000000001e-05),
    N(0.00015007500006322284)}},
    {{N(4.440483131168771e-09), N(9.111669970862657e-09)}, {N(7.698019801980198e-05),
    N(0.00015809923718577903)}},
    {{N(4.438786194775272e-09), N(9.119639293141029e-09)}, {N(7.842613469267719e-05),
    N(0.00016103025842916353)}},
    {{N(4.434770336943667e-09), N(9.111063772013247e-09)}, {N(7.984343895618854e-05),
    N(0.0001641706393978643)}},
    {{N(4.428108855999326e-09), N(9.098294006337793e-09)}, {N(8.271782630359074e-05),
    N(0.00016999641438757642)}},
    {{N(4.419230569592781e-09), N(9.078726761516395e-09)}, {N(8.281252281243053e-05),
    N(0.0001700109737191402)}},
    {{N(4.409419007570328e-09), N(9.058572707488118e-09)}, {N(7.745979958842201e-05),
    N(0.00016719062150940606)}},
    {{N(4.399295051132444e-09), N(9.037472639212181e-09)}, {N(7.196554613122552e-05),
    N(0.00014908405844514007)}},
    {{N(4.388181618147069e-09), N(9.015838870647775e-09)}, {N(6.73226640296171e-05),
    N(0.00014483782845572894)}},
    {{N(4.374880372241957e-09), N(8.987867202021315e-09)}, {N(6.40093439498227e-05),
    N(0.00013214655938348602)}},
    {{N(4.360207865318001e-09), N(8.956935084452874e-09)}, {N(5.989529753497472e-05),
    N(0.00013144884668575275)}},
    {{N(4.345400620596708e-09), N(8.927544001365367e-09)}, {N(5.685281639566829e-05),
    N(0.00011774077075563426)}},
    {{N(4.329195987656077e-09), N(8.893851768869836e-09)}, {N(5.9192364585853076e-05),
    N(0.00012171411858165579)}},
    {{N(4.310349128284019e-09), N(8.855363749612494e-09)}, {N(5.7030139544549054e-05),
    N(0.00012254204052941376)}},
    {{N(4.28914839543969e-09), N(8.81085920582054e-09)}, {N(4.958894866247877e-05),
    N(0.00011079274114415987)}},
    {{N(4.267000388548768e-09), N(8.764707505812825e-09)}, {N(4.57604546295584e-05),
    N(9.489763292390241e-05)}},
};

#undef N

#endif
