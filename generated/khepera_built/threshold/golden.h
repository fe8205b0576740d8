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
    {{N(0.1118741623530356), N(0.22567236784837857)}, {N(0.07939456683118655),
    N(0.16015458363996404)}, {N(0.0), N(0.0)}},
    {{N(0.1118737312597563), N(0.2296410449584647)}, {N(0.07939490883928449),
    N(0.1629704107631304)}, {N(0.0), N(0.0)}},
    {{N(0.11187040760072971), N(0.2298790513096069)}, {N(0.0793970169144678),
    N(0.16312906618662124)}, {N(0.0), N(0.0)}},
    {{N(0.11185976257861363), N(0.22987924090293094)}, {N(0.07940213745804969),
    N(0.16315337063313445)}, {N(0.0), N(0.0)}},
    {{N(0.11183925747557821), N(0.2298330807963664)}, {N(0.07941169140917913),
    N(0.16320083851297626)}, {N(0.0), N(0.0)}},
    {{N(0.11180957765922443), N(0.2297669245838718)}, {N(0.07943019920903964),
    N(0.1632327221054816)}, {N(0.0), N(0.0)}},
    {{N(0.11177074687785675), N(0.22971888222712636)}, {N(0.07945940092399024),
    N(0.1632986892202949)}, {N(0.0), N(0.0)}},
    {{N(0.11172092746476327), N(0.22960983866860646)}, {N(0.07950304640988426),
    N(0.16342663938359486)}, {N(0.0), N(0.0)}},
    {{N(0.1116587018000181), N(0.22951634793819697)}, {N(0.07956929545242425),
    N(0.16359174011888394)}, {N(0.0), N(0.0)}},
    {{N(0.1115811792135194), N(0.22936005768642861)}, {N(0.0796658352377534),
    N(0.16379709501331283)}, {N(0.0), N(0.0)}},
    {{N(0.11148603949316559), N(0.229176748060034)}, {N(0.0797974322780602),
    N(0.16408998068481664)}, {N(0.0), N(0.0)}},
    {{N(0.11137215616582266), N(0.2289521828089671)}, {N(0.07996809066420889),
    N(0.1644501345644978)}, {N(0.0), N(0.0)}},
    {{N(0.11123859493429687), N(0.22869001669472608)}, {N(0.08018151369951107),
    N(0.16491898483847958)}, {N(0.0), N(0.0)}},
    {{N(0.11108353578857219), N(0.22840940091107403)}, {N(0.08044126438688415),
    N(0.16544493691109594)}, {N(0.0), N(0.0)}},
    {{N(0.11090523250470401), N(0.22803165904474004)}, {N(0.08074724795002536),
    N(0.1660751251926148)}, {N(0.0), N(0.0)}},
    {{N(0.11070556106098266), N(0.2276087120192601)}, {N(0.0810991374178459),
    N(0.16682922247731383)}, {N(0.0), N(0.0)}},
};

#undef N

#endif
