/*
 * golden.h: signals and the thresholds that two_tanks_threshold.c must give for them.
 *
 * Computed with 40 digits when the code was generated. Every result stands beside the sum of the
 * absolute values of its terms, which is what an error is measured by.
 */
#ifndef TWO_TANKS_THRESHOLD_GOLDEN_H
#define TWO_TANKS_THRESHOLD_GOLDEN_H

#include "two_tanks_threshold.h"

#define N(x) TWO_TANKS_THRESHOLD_CONSTANT(x)

typedef struct golden_result {
    two_tanks_threshold_real value, size;
} golden_result;

enum { GOLDEN_EXACT = 4, GOLDEN_STEP = 16 };

/* The parameters that the results belong to. */
static void golden_parameters(two_tanks_threshold_parameters *parameters)
{
    two_tanks_threshold_nominal(parameters);
}

static const two_tanks_threshold_derivatives golden_derivatives[] = {
    {N(0.625), N(0.9375)},
    {N(0.34375), N(-0.875)},
    {N(0.90625), N(0.0625)},
    {N(0.03125), N(-0.15625)},
};

static const golden_result golden_exact[][2] = {
    {{(two_tanks_threshold_real)NAN, N(0.0)}, {(two_tanks_threshold_real)NAN, N(0.0)}},
    {{(two_tanks_threshold_real)NAN, N(0.0)}, {(two_tanks_threshold_real)NAN, N(0.0)}},
    {{(two_tanks_threshold_real)NAN, N(0.0)}, {(two_tanks_threshold_real)NAN, N(0.0)}},
    {{(two_tanks_threshold_real)NAN, N(0.0)}, {(two_tanks_threshold_real)NAN, N(0.0)}},
};

static const two_tanks_threshold_samples golden_samples[] = {
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
    {{N(4.6233105022267316e-08), N(1.4000966097020692e-07)}, {N(9.383168693391674e-08),
    N(2.5907751422849873e-07)}},
    {{N(4.622398066868119e-08), N(9.71530433134236e-08)}, {N(9.3814376877619e-08),
    N(1.9591983982434344e-07)}},
    {{N(4.619796650850775e-08), N(9.495339305634086e-08)}, {N(9.376324205933018e-08),
    N(1.9265267165072488e-07)}},
    {{N(4.61667977309805e-08), N(9.47805105713054e-08)}, {N(9.36973796118193e-08),
    N(1.9235671812939716e-07)}},
    {{N(4.6127693972019255e-08), N(9.471167833817569e-08)}, {N(9.361417681900061e-08),
    N(1.922032943861921e-07)}},
    {{N(4.605755168490274e-08), N(9.456389595232266e-08)}, {N(9.347753480698961e-08),
    N(1.919139441128431e-07)}},
    {{N(4.5957598261236917e-08), N(9.434603633649243e-08)}, {N(9.329000834020156e-08),
    N(1.9151193586744377e-07)}},
    {{N(4.583918229068807e-08), N(9.41119212901768e-08)}, {N(9.306718745083392e-08),
    N(1.9107224734588048e-07)}},
    {{N(4.569391665632574e-08), N(9.381901410733891e-08)}, {N(9.27939970775049e-08),
    N(1.905155029658141e-07)}},
    {{N(4.55153759014344e-08), N(9.345066908466119e-08)}, {N(9.245984882064661e-08),
    N(1.8983108468152352e-07)}},
    {{N(4.531049656426566e-08), N(9.302130669353096e-08)}, {N(9.207536684072683e-08),
    N(1.8902229054640177e-07)}},
    {{N(4.509024167081078e-08), N(9.256702096426334e-08)}, {N(9.166284840357374e-08),
    N(1.8817222360840798e-07)}},
    {{N(4.485563589775531e-08), N(9.209896033779928e-08)}, {N(9.12273590976092e-08),
    N(1.8730045304230116e-07)}},
    {{N(4.459791055670002e-08), N(9.156014241481177e-08)}, {N(9.075491047905202e-08),
    N(1.863131719750513e-07)}},
    {{N(4.431515075712704e-08), N(9.098659402068958e-08)}, {N(9.024207777144354e-08),
    N(1.852758003505702e-07)}},
    {{N(4.400917155146276e-08), N(9.035852769133053e-08)}, {N(8.96934679302031e-08),
    N(1.841423163106586e-07)}},
};

#undef N

#endif
