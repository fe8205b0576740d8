/*
 * golden.h: signals and the thresholds that quarter_car_threshold.c must give for them.
 *
 * Computed with 40 digits when the code was generated. Every result stands beside the sum of the
 * absolute values of its terms, which is what an error is measured by.
 */
#ifndef QUARTER_CAR_THRESHOLD_GOLDEN_H
#define QUARTER_CAR_THRESHOLD_GOLDEN_H

#include "quarter_car_threshold.h"

#define N(x) QUARTER_CAR_THRESHOLD_CONSTANT(x)

typedef struct golden_result {
    quarter_car_threshold_real value, size;
} golden_result;

enum { GOLDEN_EXACT = 4, GOLDEN_STEP = 16 };

/* The parameters that the results belong to. */
static void golden_parameters(quarter_car_threshold_parameters *parameters)
{
    quarter_car_threshold_nominal(parameters);
}

static const quarter_car_threshold_derivatives golden_derivatives[] = {
    {N(0.625), N(0.9375)},
    {N(0.34375), N(-0.875)},
    {N(0.90625), N(0.0625)},
    {N(0.03125), N(-0.15625)},
};

static const golden_result golden_exact[][2] = {
    {{(quarter_car_threshold_real)NAN, N(0.0)}, {(quarter_car_threshold_real)NAN, N(0.0)}},
    {{(quarter_car_threshold_real)NAN, N(0.0)}, {(quarter_car_threshold_real)NAN, N(0.0)}},
    {{(quarter_car_threshold_real)NAN, N(0.0)}, {(quarter_car_threshold_real)NAN, N(0.0)}},
    {{(quarter_car_threshold_real)NAN, N(0.0)}, {(quarter_car_threshold_real)NAN, N(0.0)}},
};

static const quarter_car_threshold_samples golden_samples[] = {
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
    {{N(59.375), N(181.37187496661227)}, {N(0.0), N(0.0)}},
    {{N(59.36328202228868), N(124.84441670569811)}, {N(0.0), N(0.0)}},
    {{N(59.33121481443983), N(121.94664118719835)}, {N(0.0), N(0.0)}},
    {{N(59.2968441528144), N(121.73218503238854)}, {N(0.0), N(0.0)}},
    {{N(59.250209990711845), N(121.66323904678612)}, {N(0.0), N(0.0)}},
    {{N(59.151743143414), N(121.44799457192036)}, {N(0.0), N(0.0)}},
    {{N(59.00649779393851), N(121.13192913548053)}, {N(0.0), N(0.0)}},
    {{N(58.834313354432005), N(120.78965319953093)}, {N(0.0), N(0.0)}},
    {{N(58.622749941933314), N(120.36619670617301)}, {N(0.0), N(0.0)}},
    {{N(58.363742610386375), N(119.82968584336086)}, {N(0.0), N(0.0)}},
    {{N(58.07246778048195), N(119.21662205353371)}, {N(0.0), N(0.0)}},
    {{N(57.76497573611697), N(118.58453596863376)}, {N(0.0), N(0.0)}},
    {{N(57.432706436432966), N(117.92941814769944)}, {N(0.0), N(0.0)}},
    {{N(57.060298440343125), N(117.14246687190646)}, {N(0.0), N(0.0)}},
    {{N(56.651662249793276), N(116.31644629652453)}, {N(0.0), N(0.0)}},
    {{N(56.212326555644374), N(115.4104740241088)}, {N(0.0), N(0.0)}},
};

#undef N

#endif
