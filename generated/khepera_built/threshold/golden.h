/*
 * golden.h: signals and the thresholds that khepera_built_threshold.c must give for them.
 *
 * Computed with 40 digits when the code was generated. Every result stands beside the sum of the
 * absolute values of its terms, which is what an error is measured by.
 */
#ifndef KHEPERA_BUILT_THRESHOLD_GOLDEN_H
#define KHEPERA_BUILT_THRESHOLD_GOLDEN_H

#include "khepera_built_threshold.h"

#define N(x) KHEPERA_BUILT_THRESHOLD_CONSTANT(x)

typedef struct golden_result {
    khepera_built_threshold_real value, size;
} golden_result;

enum { GOLDEN_EXACT = 4, GOLDEN_STEP = 16 };

/* The parameters that the results belong to. */
static void golden_parameters(khepera_built_threshold_parameters *parameters)
{
    khepera_built_threshold_nominal(parameters);
}

static const khepera_built_threshold_derivatives golden_derivatives[] = {
    {N(0.625), N(0.9375), N(0.34375), N(-0.875)},
    {N(0.90625), N(0.0625), N(0.03125), N(-0.15625)},
    {N(-0.3125), N(-0.90625), N(-0.09375), N(0.5)},
    {N(0.28125), N(-0.5625), N(0.1875), N(-0.71875)},
};

static const golden_result golden_exact[][3] = {
    {{(khepera_built_threshold_real)NAN, N(0.0)}, {(khepera_built_threshold_real)NAN, N(0.0)},
    {(khepera_built_threshold_real)NAN, N(0.0)}},
    {{(khepera_built_threshold_real)NAN, N(0.0)}, {(khepera_built_threshold_real)NAN, N(0.0)},
    {(khepera_built_threshold_real)NAN, N(0.0)}},
    {{(khepera_built_threshold_real)NAN, N(0.0)}, {(khepera_built_threshold_real)NAN, N(0.0)},
    {(khepera_built_threshold_real)NAN, N(0.0)}},
    {{(khepera_built_threshold_real)NAN, N(0.0)}, {(khepera_built_threshold_real)NAN, N(0.0)},
    {(khepera_built_threshold_real)NAN, N(0.0)}},
};

static const khepera_built_threshold_samples golden_samples[] = {
    {N(-0.96875), N(0.6875), 2147483608, 2147483608},
    {N(-0.59375), N(0.09375), 2147483613, 2147483611},
    {N(-0.03125), N(0.6875), 2147483631, 2147483616},
    {N(0.4375), N(0.8125), 2147483641, 2147483612},
    {N(-0.25), N(-0.375), 2147483639, 2147483631},
    {N(-0.1875), N(-0.0625), 2147483637, 2147483628},
    {N(-0.75), N(-0.5625), -2147483642, 2147483636},
    {N(0.96875), N(-0.53125), -2147483645, -2147483640},
    {N(-0.28125), N(0.5), -2147483625, -2147483621},
    {N(0.375), N(-0.125), -2147483617, -2147483612},
    {N(0.4375), N(0.375), -2147483608, -2147483599},
    {N(-0.03125), N(0.25), -2147483600, -2147483591},
    {N(-0.9375), N(0.53125), -2147483591, -2147483575},
    {N(0.0), N(-0.21875), -2147483571, -2147483574},
    {N(-0.1875), N(0.21875), -2147483574, -2147483573},
    {N(0.03125), N(-0.78125), -2147483576, -2147483559},
};

static const golden_result golden_step[][3] = {
    {{N(0.1118741623530356), N(0.2238602205986294)}, {N(0.07939456683118655),
    N(0.1588685436827116)}, {N(0.0), N(0.0)}},
    {{N(0.11187370518758777), N(0.22935474313345316)}, {N(0.07939496079058163),
    N(0.16276852719011828)}, {N(0.0), N(0.0)}},
    {{N(0.11187028630774688), N(0.22963896825987443)}, {N(0.07939716008546473),
    N(0.1629766232291537)}, {N(0.0), N(0.0)}},
    {{N(0.11185958197183686), N(0.22963458327076366)}, {N(0.0794022224628177),
    N(0.162998375700764)}, {N(0.0), N(0.0)}},
    {{N(0.11183907659711523), N(0.22959376070215068)}, {N(0.07941211157698376),
    N(0.16301831083549198)}, {N(0.0), N(0.0)}},
    {{N(0.11180939733197082), N(0.2295323170055528)}, {N(0.07943060047076445),
    N(0.1630570433141092)}, {N(0.0), N(0.0)}},
    {{N(0.11177047067086204), N(0.22945549368341708)}, {N(0.0794599637814194),
    N(0.16311675195713016)}, {N(0.0), N(0.0)}},
    {{N(0.1117206559042277), N(0.22935387489157394)}, {N(0.07950398845080191),
    N(0.16320697723971628)}, {N(0.0), N(0.0)}},
    {{N(0.11165831733688814), N(0.22922957013422926)}, {N(0.07957062762303302),
    N(0.16334394546108813)}, {N(0.0), N(0.0)}},
    {{N(0.11158074060310554), N(0.2290727148650218)}, {N(0.07966740774726999),
    N(0.16354295162652618)}, {N(0.0), N(0.0)}},
    {{N(0.1114855422235153), N(0.2288794924112617)}, {N(0.07979932018138626),
    N(0.16381403252068422)}, {N(0.0), N(0.0)}},
    {{N(0.11137160612272741), N(0.22864753899463408)}, {N(0.07997021796485172),
    N(0.16416521247699356)}, {N(0.0), N(0.0)}},
    {{N(0.11123798997657335), N(0.22837532359482096)}, {N(0.08018402187871057),
    N(0.16460442473881187)}, {N(0.0), N(0.0)}},
    {{N(0.11108282362026756), N(0.22806140092105778)}, {N(0.08044390583586399),
    N(0.1651383928174862)}, {N(0.0), N(0.0)}},
    {{N(0.11090453390857283), N(0.2276960521198373)}, {N(0.08075000838570773),
    N(0.16576715851133308)}, {N(0.0), N(0.0)}},
    {{N(0.11070487758523616), N(0.22728502212101478)}, {N(0.08110222975076664),
    N(0.1664904919794133)}, {N(0.0), N(0.0)}},
};

#undef N

#endif
