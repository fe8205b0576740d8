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
    {{N(4.440481105849702e-09), N(9.104224234323683e-09)}, {N(7.698673306755302e-05),
    N(0.0001576992221686496)}},
    {{N(4.438777047999524e-09), N(9.112258181948276e-09)}, {N(7.84242421212378e-05),
    N(0.00016097221245223097)}},
    {{N(4.434753225636213e-09), N(9.103997192296129e-09)}, {N(7.984978758409744e-05),
    N(0.00016376973702418823)}},
    {{N(4.428082765342762e-09), N(9.091233101293102e-09)}, {N(8.272065416062433e-05),
    N(0.0001697253959506616)}},
    {{N(4.4191996888262455e-09), N(9.071964180234859e-09)}, {N(8.280951620051983e-05),
    N(0.0001699915106800797)}},
    {{N(4.409387892578707e-09), N(9.0518610820537e-09)}, {N(7.744465341526189e-05),
    N(0.00016662420189962398)}},
    {{N(4.399263335417349e-09), N(9.030829416977978e-09)}, {N(7.196243189059218e-05),
    N(0.0001490201155837205)}},
    {{N(4.3881452096197665e-09), N(9.009139983698045e-09)}, {N(6.731068913186967e-05),
    N(0.00014438288649737998)}},
    {{N(4.374835558889785e-09), N(8.981478549265957e-09)}, {N(6.401091631355469e-05),
    N(0.00013198333098412115)}},
    {{N(4.360164029694887e-09), N(8.950614515229248e-09)}, {N(5.9880886064860036e-05),
    N(0.0001308622854661849)}},
    {{N(4.345356671527269e-09), N(8.921145633252708e-09)}, {N(5.685817936951342e-05),
    N(0.00011743306018777885)}},
    {{N(4.329144654948858e-09), N(8.887742931532321e-09)}, {N(5.9195894056395275e-05),
    N(0.00012148548282656861)}},
    {{N(4.3102896248789085e-09), N(8.849406909851565e-09)}, {N(5.702046968816657e-05),
    N(0.00012215786779477833)}},
    {{N(4.2890837258755775e-09), N(8.805199634710149e-09)}, {N(4.957517808241504e-05),
    N(0.0001102009543322129)}},
    {{N(4.266937102359572e-09), N(8.75917008644678e-09)}, {N(4.5763171543857483e-05),
    N(9.473299740529167e-05)}},
};

#undef N

#endif
