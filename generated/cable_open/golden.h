/*
 * golden.h: signals and the residuals that cable_open_residuals.c must give for them.
 *
 * Computed with 40 digits when the code was generated. Every result stands beside the sum of the
 * absolute values of its terms, which is what an error is measured by.
 */
#ifndef CABLE_OPEN_GOLDEN_H
#define CABLE_OPEN_GOLDEN_H

#include "cable_open_residuals.h"

#define N(x) CABLE_OPEN_CONSTANT(x)

typedef struct golden_result {
    cable_open_real value, size;
} golden_result;

enum { GOLDEN_EXACT = 4, GOLDEN_STEP = 16 };

/* The parameters that the results belong to. */
static void golden_parameters(cable_open_parameters *parameters)
{
    cable_open_nominal(parameters);
}

static const cable_open_derivatives golden_derivatives[] = {
    {N(0.625), {N(0.9375), N(1476395008.0), N(-6.305039478318694e+16)}},
    {N(0.90625), {N(0.0625), N(134217728.0), N(-1.125899906842624e+16)}},
    {N(-0.3125), {N(-0.90625), N(-402653184.0), N(3.602879701896397e+16)}},
    {N(0.28125), {N(-0.5625), N(805306368.0), N(-5.17913957147607e+16)}},
};

static const golden_result golden_exact[][1] = {
    {{N(0.2945974068608204), N(2.690415238126497)}},
    {{N(0.9749389170628607), N(1.1473619908761796)}},
    {{N(0.16922100137324547), N(1.7855791823141491)}},
    {{N(1.4141477703099596), N(1.6984694774578055)}},
};

static const cable_open_samples golden_samples[] = {
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
    {N(-0.1875), N(0.25)},
    {N(0.96875), N(-0.53125)},
    {N(-0.96875), N(-0.96875)},
    {N(-0.28125), N(0.5)},
};

static const golden_result golden_step[][1] = {
    {{N(-1.65625), N(1.65625)}},
    {{N(-1.6466584158415842), N(1.729881644492689)}},
    {{N(-1.6186924076070974), N(1.7086942221535346)}},
    {{N(-1.5915895876544814), N(1.6766972986509676)}},
    {{N(-1.5783279126514225), N(1.662754419533391)}},
    {{N(-1.561925379727632), N(1.6547481772118673)}},
    {{N(-1.5359466593369857), N(1.6181077455644726)}},
    {{N(-1.5055318740035801), N(1.5934236318551813)}},
    {{N(-1.4899520349144002), N(1.5708875853008168)}},
    {{N(-1.4771559550151052), N(1.5568006108131187)}},
    {{N(-1.4599721737276774), N(1.5381971406054207)}},
    {{N(-1.4437474772182184), N(1.5330039825268895)}},
    {{N(-1.4213465370752834), N(1.498030151588583)}},
    {{N(-1.3826812591133966), N(1.4884351872263129)}},
    {{N(-1.340449947051745), N(1.4364699448604088)}},
    {{N(-1.3216415322586412), N(1.3944526583875818)}},
};

#undef N

#endif
