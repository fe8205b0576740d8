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
    {{N(-1.64662676170404), N(1.7287071972802246)}},
    {{N(-1.6186323951429549), N(1.7081991093801452)}},
    {{N(-1.5915625973304675), N(1.6755038616205309)}},
    {{N(-1.5783153014922144), N(1.6609535674130407)}},
    {{N(-1.5618888081089966), N(1.6527477155990022)}},
    {{N(-1.5359034187366332), N(1.617730699783673)}},
    {{N(-1.505482242875172), N(1.5923787631796997)}},
    {{N(-1.4899595915739448), N(1.5684684748860906)}},
    {{N(-1.4771163439766133), N(1.5562374448608767)}},
    {{N(-1.4599658848182167), N(1.536474255194488)}},
    {{N(-1.4437119402303258), N(1.5309293890283295)}},
    {{N(-1.4213206935403115), N(1.4972118399909364)}},
    {{N(-1.3825932619880252), N(1.4861222782730164)}},
    {{N(-1.340414589090302), N(1.433480431048766)}},
    {{N(-1.3216332779524624), N(1.3931182193260332)}},
};

#undef N

#endif
