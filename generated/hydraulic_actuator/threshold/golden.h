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
    {{N(6.314542025654295e-10), N(1.3616817230855954e-09)}, {N(7.504656406234683),
    N(15.398967424454153)}},
    {{N(6.312856557229232e-10), N(1.3002196139766956e-09)}, {N(7.524077915094715),
    N(15.46022954429008)}},
    {{N(6.309948177014241e-10), N(1.296504300951991e-09)}, {N(7.554982130041955),
    N(15.531838807458277)}},
    {{N(6.306033512455488e-10), N(1.2956193385426667e-09)}, {N(7.581712086142115),
    N(15.581086493461353)}},
    {{N(6.300688518703877e-10), N(1.29472844529866e-09)}, {N(7.59608846604537),
    N(15.618319585443185)}},
    {{N(6.292867844055615e-10), N(1.2928689078775586e-09)}, {N(7.593443484726638),
    N(15.612415024851291)}},
    {{N(6.281792812602503e-10), N(1.2909238667844493e-09)}, {N(7.579102024492955),
    N(15.572500465423786)}},
    {{N(6.267111453415033e-10), N(1.2875418975580992e-09)}, {N(7.565046827958469),
    N(15.54390540624209)}},
    {{N(6.250796194696901e-10), N(1.2842108515696132e-09)}, {N(7.553477847608862),
    N(15.518330838091858)}},
    {{N(6.235382229259382e-10), N(1.281025792348003e-09)}, {N(7.546262722837082),
    N(15.503576179878063)}},
    {{N(6.221735399010991e-10), N(1.2782373102181463e-09)}, {N(7.547399818339527),
    N(15.506896577808249)}},
    {{N(6.20953529601412e-10), N(1.2756896771032631e-09)}, {N(7.554110442175043),
    N(15.52481334876512)}},
    {{N(6.197646947251456e-10), N(1.2732236577836267e-09)}, {N(7.560046564363377),
    N(15.533388311210873)}},
    {{N(6.184691267784335e-10), N(1.270614533228035e-09)}, {N(7.558374154532028),
    N(15.543587009920142)}},
    {{N(6.169725233903956e-10), N(1.2676008392375443e-09)}, {N(7.53615821635193),
    N(15.501022770917949)}},
};

#undef N

#endif
