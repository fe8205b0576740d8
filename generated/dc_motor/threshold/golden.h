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
    {{N(0.27504473837368887), N(0.5643184937432143)}, {N(2.301426808646211e-05),
    N(4.7219273298285536e-05)}},
    {{N(0.2749376221482727), N(0.5648622475900194)}, {N(2.3005199864529882e-05),
    N(4.7264217966061304e-05)}},
    {{N(0.2746702951918325), N(0.5643250675895888)}, {N(2.2983107115768397e-05),
    N(4.721989566133867e-05)}},
    {{N(0.2743327145092192), N(0.5636007205495093)}, {N(2.2955172199184294e-05),
    N(4.7160214519521134e-05)}},
    {{N(0.2741029809754157), N(0.5631324837267285)}, {N(2.2935372958302272e-05),
    N(4.711965343807556e-05)}},
    {{N(0.27395538948978093), N(0.5628362843231303)}, {N(2.2921681367848603e-05),
    N(4.70919975968084e-05)}},
    {{N(0.27374929218413296), N(0.5623925696814643)}, {N(2.290292479339435e-05),
    N(4.705199726239526e-05)}},
    {{N(0.27351131879437773), N(0.561911070739609)}, {N(2.288111707744496e-05),
    N(4.700767555258587e-05)}},
    {{N(0.27327515802281926), N(0.5615123410395981)}, {N(2.28588941319171e-05),
    N(4.6968989249061114e-05)}},
    {{N(0.2729437835928236), N(0.5607425086436502)}, {N(2.282856458303501e-05),
    N(4.689932152922726e-05)}},
    {{N(0.2725237652970429), N(0.5598605872439422)}, {N(2.279085187918974e-05),
    N(4.682026918757367e-05)}},
    {{N(0.2721481466711107), N(0.5591029276959458)}, {N(2.2756448451299906e-05),
    N(4.6750858743477096e-05)}},
    {{N(0.2718800270968585), N(0.5585546321849891)}, {N(2.2730289921199577e-05),
    N(4.6697141572921365e-05)}},
    {{N(0.2716586813654956), N(0.5581004078774485)}, {N(2.270749611047532e-05),
    N(4.665050921633068e-05)}},
    {{N(0.27147966894871783), N(0.5577439009731929)}, {N(2.268777271342108e-05),
    N(4.6610692080185196e-05)}},
};

#undef N

#endif
