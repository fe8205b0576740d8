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
    {{N(59.363358984413296), N(124.95145656858158)}, {N(0.0), N(0.0)}},
    {{N(59.331347708096956), N(122.04482634938225)}, {N(0.0), N(0.0)}},
    {{N(59.29693265957143), N(121.83051601996272)}, {N(0.0), N(0.0)}},
    {{N(59.25041862945312), N(121.76495482599825)}, {N(0.0), N(0.0)}},
    {{N(59.1521674105817), N(121.54110764682822)}, {N(0.0), N(0.0)}},
    {{N(59.00700332217849), N(121.21936132514503)}, {N(0.0), N(0.0)}},
    {{N(58.834897034194114), N(120.87731964695661)}, {N(0.0), N(0.0)}},
    {{N(58.62349341526738), N(120.4519479492194)}, {N(0.0), N(0.0)}},
    {{N(58.36461332088821), N(119.91134561819)}, {N(0.0), N(0.0)}},
    {{N(58.07339263092704), N(119.2921926158127)}, {N(0.0), N(0.0)}},
    {{N(57.76591811344512), N(118.65937464837239)}, {N(0.0), N(0.0)}},
    {{N(57.43375740191741), N(118.00640822595969)}, {N(0.0), N(0.0)}},
    {{N(57.06146623798342), N(117.21028990199139)}, {N(0.0), N(0.0)}},
    {{N(56.65290859043229), N(116.38450468638997)}, {N(0.0), N(0.0)}},
    {{N(56.21364919056852), N(115.47532017436971)}, {N(0.0), N(0.0)}},
};

#undef N

#endif
