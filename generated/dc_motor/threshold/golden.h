/*
 * golden.h: signals and the thresholds that motor_threshold.c must give for them.
 *
 * Computed with 40 digits when the code was generated. Every result stands beside the sum of the
 * absolute values of its terms, which is what an error is measured by.
 */
#ifndef MOTOR_THRESHOLD_GOLDEN_H
#define MOTOR_THRESHOLD_GOLDEN_H

#include "motor_threshold.h"

#define N(x) MOTOR_THRESHOLD_CONSTANT(x)

typedef struct golden_result {
    motor_threshold_real value, size;
} golden_result;

enum { GOLDEN_EXACT = 4, GOLDEN_STEP = 16 };

/* The parameters that the results belong to. */
static void golden_parameters(motor_threshold_parameters *parameters)
{
    motor_threshold_nominal(parameters);
}

static const motor_threshold_derivatives golden_derivatives[] = {
    {N(0.625), N(0.9375)},
    {N(0.34375), N(-0.875)},
    {N(0.90625), N(0.0625)},
    {N(0.03125), N(-0.15625)},
};

static const golden_result golden_exact[][2] = {
    {{(motor_threshold_real)NAN, N(0.0)}, {(motor_threshold_real)NAN, N(0.0)}},
    {{(motor_threshold_real)NAN, N(0.0)}, {(motor_threshold_real)NAN, N(0.0)}},
    {{(motor_threshold_real)NAN, N(0.0)}, {(motor_threshold_real)NAN, N(0.0)}},
    {{(motor_threshold_real)NAN, N(0.0)}, {(motor_threshold_real)NAN, N(0.0)}},
};

static const motor_threshold_samples golden_samples[] = {
    {N(-0.3125), N(-0.90625)},
    {N(-0.09375), N(0.5)},
    {N(0.28125), N(-0.5625)},
    {N(0.1875), N(-0.71875)},
    {N(-0.96875), N(0.6875)},
    {N(-0.59375), N(0.09375)},
    {N(0.0625), N(-0.15625)},
    {N(-0.03125), N(0.6875)},
    {N(-0.78125), N(0.34375)},
    {N(0.4375), N(0.8125)},
    {N(-0.125), N(0.0)},
    {N(-0.25), N(-0.375)},
    {N(-0.9375), N(0.625)},
    {N(-0.1875), N(-0.0625)},
    {N(-0.34375), N(0.75)},
    {N(-0.75), N(-0.5625)},
};

static const golden_result golden_step[][2] = {
    {{N(0.27506361875), N(0.5504023011354882)}, {N(2.30159375e-05), N(4.605489094731618e-05)}},
    {{N(0.2750446135500544), N(0.5638717567430851)}, {N(2.3014257049485847e-05),
    N(4.718188365449416e-05)}},
    {{N(0.2749370416825358), N(0.5644062646492477)}, {N(2.300515120413633e-05),
    N(4.722609704239632e-05)}},
    {{N(0.2746691266599538), N(0.563884707319855)}, {N(2.2983011277990992e-05),
    N(4.718302695965289e-05)}},
    {{N(0.2743317062065154), N(0.5631526327622338)}, {N(2.2955087936232182e-05),
    N(4.712273468791916e-05)}},
    {{N(0.27410256810252265), N(0.5626768045097348)}, {N(2.2935334442041233e-05),
    N(4.70816399614529e-05)}},
    {{N(0.2739549504731963), N(0.5623877797743859)}, {N(2.2921639768470425e-05),
    N(4.7054591294660953e-05)}},
    {{N(0.27374850949286816), N(0.5619549722269653)}, {N(2.2902854390078924e-05),
    N(4.7015465163312555e-05)}},
    {{N(0.27351069440168224), N(0.5614607760684158)}, {N(2.2881057622632584e-05),
    N(4.697019036416279e-05)}},
    {{N(0.2732744147033823), N(0.5610572482783838)}, {N(2.285882352306565e-05),
    N(4.693114555321036e-05)}},
    {{N(0.2729425572308386), N(0.5603136869180344)}, {N(2.2828454149300322e-05),
    N(4.6863655252757986e-05)}},
    {{N(0.27252247659004125), N(0.5594350349788986)}, {N(2.279073618054718e-05),
    N(4.67848826092558e-05)}},
    {{N(0.27214726393824806), N(0.558660081316278)}, {N(2.2756364398666817e-05),
    N(4.6714095180554336e-05)}},
    {{N(0.27187949082791235), N(0.5581141916845659)}, {N(2.27302325895601e-05),
    N(4.666063369882095e-05)}},
    {{N(0.27165813486665985), N(0.5576597130335955)}, {N(2.2707437018813208e-05),
    N(4.6613982431908024e-05)}},
    {{N(0.2714794340674572), N(0.5572910758421765)}, {N(2.2687737996160854e-05),
    N(4.657325011157318e-05)}},
};

#undef N

#endif
