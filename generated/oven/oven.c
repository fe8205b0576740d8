/* oven.c: the residuals of Oven; generated, see the header. */
#include "oven.h"

#ifndef OVEN_NO_THRESHOLDS
#include <math.h>
#endif
#include <stddef.h>

#if defined __FINITE_MATH_ONLY__ && __FINITE_MATH_ONLY__
#error "this code tells numbers from NaN: compile it without -ffinite-math-only (-ffast-math)"
#endif

typedef oven_real real;

#define REAL(x) OVEN_CONSTANT(x)
#if defined OVEN_FLOAT && !defined OVEN_REAL
#define MATH(name) name##f
#else
#define MATH(name) name
#endif

/* Neither NaN nor infinite: infinity minus infinity is NaN, and NaN is not 0. */
static bool finite_number(real value)
{
    return value - value <= REAL(0.0);
}

/* The smaller of two numbers. */
static real least(real left, real right)
{
    return right < left ? right : left;
}

/* The larger of two numbers. */
static real greatest(real left, real right)
{
    return right > left ? right : left;
}

/* The least bandwidth * sample_time at which a filter still moves. */
#if defined OVEN_FLOAT && !defined OVEN_REAL
#define SLOWEST REAL(0.0001)
#else
#define SLOWEST REAL(1.0e-09)
#endif

uint32_t oven_abi(void)
{
    return OVEN_ABI;
}

const char *oven_digest(void)
{
    return OVEN_DIGEST;
}

void oven_nominal(oven_parameters *parameters)
{
    parameters->Ch = REAL(120.0);  /* J/K */
    parameters->Co = REAL(900.0);  /* J/K */
    parameters->Gh = REAL(4.0);    /* W/K */
    parameters->Go = REAL(0.8);    /* W/K */
}

/* Whether configure may go on with what it is given. */
static oven_status checked(const oven_parameters *p, real sample_time, real bandwidth)
{
    const bool finite = finite_number(p->Ch + p->Co + p->Gh + p->Go);

    if (!finite) {
        return OVEN_BAD_PARAMETER;
    }
    if (!(sample_time > REAL(0.0)) || !finite_number(sample_time)) {
        return OVEN_BAD_SAMPLE_TIME;
    }
    if (!(bandwidth * sample_time >= SLOWEST && bandwidth * sample_time <= REAL(3.0))) {
        return OVEN_BAD_BANDWIDTH;
    }
    return OVEN_OK;
}

/* Samples until `constants` time constants of the filter are over. */
static uint32_t samples(real constants, real sample_time, real bandwidth)
{
    const real wait = constants / (bandwidth * sample_time);
    const uint32_t whole = wait < REAL(4.0e9) ? (uint32_t)wait : UINT32_MAX - 1u;

    return (real)whole < wait ? whole + 1u : whole;
}

const oven_coefficients oven_nominal_coefficients = {
    REAL(4.0),                     /* r1_Th */
    REAL(0.01),                    /* r1_pace */
    REAL(0.49999999999999956),     /* r1_slope1 */
    REAL(2400.0000000000023),      /* r1_w0_Th_1 */
    REAL(3.3333333333333396e-05),  /* bend1 */
    REAL(0.9801980198019802),      /* a */
    REAL(0.00990099009900991),     /* b */
    REAL(0.8),                     /* r2_Ta */
    REAL(4.8),                     /* r2_To */
    REAL(18000.000000000015),      /* r2_w0_To_1 */
    {100u, 100u},                  /* samples until each is valid */
    100u                           /* the longest of these */
};

/* The coefficients, from the parameters. */
static void compute_coefficients(oven_coefficients *c, const oven_parameters *p, real sample_time,
        real bandwidth)
{
    /* bandwidth*sample_time */
    const real x_ = bandwidth * sample_time;

    /* of a stage: what is left of its memory */
    const real pole = greatest(REAL(2.0) - x_, REAL(0.0)) / (x_ + REAL(2.0));

    /* w*sample_time, x or 2 */
    const real turn = REAL(2.0) * (REAL(1.0) - pole) / (pole + REAL(1.0));

    /* w of the filter 1/(1 + D/w) */
    const real w = turn / sample_time;

    /* min(x/2, 0.025) */
    const real min_x = least(REAL(0.5) * x_, REAL(1.0) / REAL(40.0));

    /* oven.bg:15: r1: factor of Th: Gh */
    c->r1_Th = p->Gh;

    /* part of the start that a sample is */
    c->r1_pace = min_x;

    /* 1/w of the filter as part of the start, to the power 1 */
    c->r1_slope1 = min_x / turn;

    /* oven.bg:15: r1: factor of Th times derivative 1 of the window */
    c->r1_w0_Th_1 = p->Ch * w;

    /* filter: 1 * (w*sample_time)^2/12 */
    c->bend1 = turn * turn / REAL(12.0);

    /* filter: what is left of a memory a sample later */
    c->a = pole;

    /* filter: weight of a sample, new and a sample later */
    c->b = REAL(0.5) * (REAL(1.0) - pole);

    /* oven.bg:15: r2: factor of Ta: Go */
    c->r2_Ta = p->Go;

    /* r2: factor of To: Gh + Go */
    c->r2_To = p->Gh + p->Go;

    /* r2: factor of To times derivative 1 of the window */
    c->r2_w0_To_1 = p->Co * w;
}

static bool coefficients_are_finite(const oven_coefficients *c)
{
    return finite_number(c->r1_Th + c->r1_pace + c->r1_slope1 + c->r1_w0_Th_1 + c->bend1 + c->a
            + c->b + c->r2_Ta + c->r2_To + c->r2_w0_To_1);
}

oven_status oven_configure(
    oven_coefficients *coefficients,
    const oven_parameters *parameters,
    oven_real sample_time,
    oven_real bandwidth)
{
    oven_coefficients *c = coefficients;
    const oven_status status = checked(parameters, sample_time, bandwidth);
    int k;

    for (k = 0; k < OVEN_RESIDUALS; ++k) {
        c->settle[k] = UINT32_MAX;
    }
    c->longest = UINT32_MAX;
    if (status != OVEN_OK) {
        return status;
    }
    compute_coefficients(c, parameters, sample_time, bandwidth);
    if (!coefficients_are_finite(c)) {
        return OVEN_BAD_COEFFICIENT;
    }
    c->settle[OVEN_R1] = samples(REAL(2.0), sample_time, bandwidth);
    c->settle[OVEN_R2] = samples(REAL(2.0), sample_time, bandwidth);
    c->longest = c->settle[OVEN_R1];
    return OVEN_OK;
}

/* r1 on one sample.
 * oven.bg:15: r1 = if(on, P, 0) - Gh*(Th - To) - Ch*D(Th) */
static void run_r1(
    const oven_coefficients *c, oven_memory *x, const oven_samples *s, real *r)
{
    const bool first = x->youngest == 0u && x->age[0] == 0u;

    /* how much of the start is over */
    const real u = first ? REAL(0.0) : least(REAL(1.0), x->r1_open + c->r1_pace);

    /* the same, for the next sample */
    x->r1_open = u;

    /* how much is to come */
    const real rest = REAL(1.0) - u;

    /* the window */
    const real phi0 = u * u * u * (REAL(1.0) + rest * (REAL(3.0) + rest * REAL(6.0)));

    /* derivative 1 of the window */
    const real phi1 = c->r1_slope1 * (REAL(30.0) * (u * u) * (rest * rest));

    if (first) {
        /* nothing is remembered yet */
        x->r1_s2 = REAL(0.0);
        x->r1_s1 = REAL(0.0);
    }

    /* if(on, P, 0) */
    const real choice = s->on ? s->P : REAL(0.0);

    /* terms of order 0 */
    const real g0 = phi0 * (choice + c->r1_Th * s->To - c->r1_Th * s->Th)
        + phi1 * (c->r1_w0_Th_1 * s->Th);

    /* degree 1 */
    const real d1 = phi0 * (c->r1_w0_Th_1 * s->Th);

    /* error of order 0 */
    const real e0 = c->bend1 * g0;

    /* the filter multiplied out */
    const real p1_1 = e0 - d1;

    /* stage 2 */
    const real u2 = g0 - p1_1;
    const real y2 = x->r1_s2 + c->b * u2;

    /* stage 2: memory */
    x->r1_s2 = c->a * y2 + c->b * u2;

    /* stage 1 */
    const real u1 = y2 + p1_1 + e0;
    const real y1 = x->r1_s1 + c->b * u1;

    /* stage 1: memory */
    x->r1_s1 = c->a * y1 + c->b * u1;

    r[OVEN_R1] = y1 - e0;
}

/* r2 on one sample.
 * oven.bg:15: r2 = Gh*(Th - To) - Go*(To - Ta) - Co*D(To) */
static void run_r2(
    const oven_coefficients *c, oven_memory *x, const oven_samples *s, real *r)
{
    const bool first = x->youngest == 0u && x->age[1] == 0u;

    /* how much of the start is over */
    const real u = first ? REAL(0.0) : least(REAL(1.0), x->r2_open + c->r1_pace);

    /* the same, for the next sample */
    x->r2_open = u;

    /* how much is to come */
    const real rest = REAL(1.0) - u;

    /* the window */
    const real phi0 = u * u * u * (REAL(1.0) + rest * (REAL(3.0) + rest * REAL(6.0)));

    /* derivative 1 of the window */
    const real phi1 = c->r1_slope1 * (REAL(30.0) * (u * u) * (rest * rest));

    if (first) {
        /* nothing is remembered yet */
        x->r2_s2 = REAL(0.0);
        x->r2_s1 = REAL(0.0);
    }

    /* terms of order 0 */
    const real g0 = phi0 * (c->r2_Ta * s->Ta + c->r1_Th * s->Th - c->r2_To * s->To)
        + phi1 * (c->r2_w0_To_1 * s->To);

    /* degree 1 */
    const real d1 = phi0 * (c->r2_w0_To_1 * s->To);

    /* error of order 0 */
    const real e0 = c->bend1 * g0;

    /* the filter multiplied out */
    const real p1_1 = e0 - d1;

    /* stage 2 */
    const real u2 = g0 - p1_1;
    const real y2 = x->r2_s2 + c->b * u2;

    /* stage 2: memory */
    x->r2_s2 = c->a * y2 + c->b * u2;

    /* stage 1 */
    const real u1 = y2 + p1_1 + e0;
    const real y1 = x->r2_s1 + c->b * u1;

    /* stage 1: memory */
    x->r2_s1 = c->a * y1 + c->b * u1;

    r[OVEN_R2] = y1 - e0;
}

/* Ages and validity one by one: a number that is not finite makes the next sample the first. */
static void count_samples(
    const oven_coefficients *c,
    oven_memory *x,
    const oven_samples *s,
    oven_residuals *out)
{
    /* the residuals that are computed, and what each one goes with */
    static const uint8_t number[] = {
        0, 1
    };
    static const uint8_t part[] = {
        0, 1
    };
    bool finite[2];
    int k;

    finite[0] = finite_number(s->P);
    finite[1] = true;
    for (k = 0; k < 2; ++k) {
        finite[part[k]] = finite[part[k]] && finite_number(out->value[number[k]]);
    }
    x->youngest = UINT32_MAX;
    for (k = 0; k < 2; ++k) {
        x->age[k] = finite[k] ? x->age[k] + (x->age[k] < UINT32_MAX ? 1u : 0u) : 0u;
        x->youngest = x->age[k] < x->youngest ? x->age[k] : x->youngest;
    }
    for (k = 0; k < 2; ++k) {
        out->value[number[k]] = finite[part[k]] ? out->value[number[k]] : REAL(0.0);
        out->valid[number[k]] = x->age[part[k]] > c->settle[number[k]];
    }
    out->valid[OVEN_R1] = out->valid[OVEN_R1] && x->r1_open >= REAL(1.0);
    out->valid[OVEN_R2] = out->valid[OVEN_R2] && x->r2_open >= REAL(1.0);
}

void oven_reset(oven_memory *memory)
{
    int k;

    for (k = 0; k < 2; ++k) {
        memory->age[k] = 0u;
    }
    memory->youngest = 0u;
}

void oven_step(
    const oven_coefficients *coefficients,
    oven_memory *memory,
    const oven_samples *samples,
    oven_residuals *residuals)
{
    const oven_coefficients *c = coefficients;
    oven_memory *x = memory;
    const oven_samples *s = samples;
    real *r = residuals->value;

    run_r1(c, x, s, r);
    run_r2(c, x, s, r);
    count_samples(c, x, s, residuals);
}

#ifndef OVEN_NO_THRESHOLDS

const oven_threshold_coefficients oven_threshold_nominal_coefficients = {
    REAL(0.01),                 /* r1_pace */
    REAL(0.2),                  /* r1_w1_Th */
    REAL(0.9801980198019802),   /* a */
    REAL(0.00990099009900991),  /* b */
    REAL(0.08),                 /* r2_w2_Ta */
    {100u, 100u},               /* samples until each is valid */
    100u                        /* the longest of these */
};

/* The coefficients, from the parameters. */
static void bound_compute_coefficients(oven_threshold_coefficients *c, const oven_parameters *p,
        real sample_time, real bandwidth)
{
    /* bandwidth*sample_time */
    const real x_ = bandwidth * sample_time;

    /* of a stage: what is left of its memory */
    const real pole = greatest(REAL(2.0) - x_, REAL(0.0)) / (x_ + REAL(2.0));

    /* min(x/2, 0.025) */
    const real min_x = least(REAL(0.5) * x_, REAL(1.0) / REAL(40.0));

    /* part of the start that a sample is */
    c->r1_pace = min_x;

    /* oven.bg:15: r1_w1: factor of Th */
    c->r1_w1_Th = p->Gh / REAL(20.0);

    /* filter: what is left of a memory a sample later */
    c->a = pole;

    /* filter: weight of a sample, new and a sample later */
    c->b = REAL(0.5) * (REAL(1.0) - pole);

    /* oven.bg:15: r2_w2: factor of Ta */
    c->r2_w2_Ta = p->Go / REAL(10.0);
}

static bool bound_coefficients_are_finite(const oven_threshold_coefficients *c)
{
    return finite_number(c->r1_pace + c->r1_w1_Th + c->a + c->b + c->r2_w2_Ta);
}

oven_status oven_threshold_configure(
    oven_threshold_coefficients *coefficients,
    const oven_parameters *parameters,
    oven_real sample_time,
    oven_real bandwidth)
{
    oven_threshold_coefficients *c = coefficients;
    const oven_status status = checked(parameters, sample_time, bandwidth);
    int k;

    for (k = 0; k < OVEN_RESIDUALS; ++k) {
        c->settle[k] = UINT32_MAX;
    }
    c->longest = UINT32_MAX;
    if (status != OVEN_OK) {
        return status;
    }
    bound_compute_coefficients(c, parameters, sample_time, bandwidth);
    if (!bound_coefficients_are_finite(c)) {
        return OVEN_BAD_COEFFICIENT;
    }
    c->settle[OVEN_R1] = samples(REAL(2.0), sample_time, bandwidth);
    c->settle[OVEN_R2] = samples(REAL(2.0), sample_time, bandwidth);
    c->longest = c->settle[OVEN_R1];
    return OVEN_OK;
}

/* r1 on one sample.
 * oven.bg:15: r1: how far r1 can be from zero if no parameter is out of tolerance */
static void bound_r1(
    const oven_threshold_coefficients *c, oven_threshold_memory *x, const oven_samples *s, real *r)
{
    const bool first = x->youngest == 0u && x->age[0] == 0u;

    /* how much of the start is over */
    const real u = first ? REAL(0.0) : least(REAL(1.0), x->r1_open + c->r1_pace);

    /* the same, for the next sample */
    x->r1_open = u;

    /* how much is to come */
    const real rest = REAL(1.0) - u;

    /* the window */
    const real phi0 = u * u * u * (REAL(1.0) + rest * (REAL(3.0) + rest * REAL(6.0)));

    if (first) {
        /* nothing is remembered yet */
        x->r1_w1_s2 = REAL(0.0);
        x->r1_w1_s1 = REAL(0.0);
    }

    /* r1_w1: stage 2 */
    const real w1_u2 = phi0 * (c->r1_w1_Th * s->To - c->r1_w1_Th * s->Th);
    const real w1_y2 = x->r1_w1_s2 + c->b * w1_u2;

    /* r1_w1: stage 2: memory */
    x->r1_w1_s2 = c->a * w1_y2 + c->b * w1_u2;

    /* r1_w1: stage 1 */
    const real w1_u1 = w1_y2;
    const real w1_y1 = x->r1_w1_s1 + c->b * w1_u1;

    /* r1_w1: stage 1: memory */
    x->r1_w1_s1 = c->a * w1_y1 + c->b * w1_u1;

    /* what the tolerance of Gh can do */
    const real w1 = w1_y1;

    r[OVEN_R1] = MATH(fabs)(w1);
}

/* what the tolerance of Gh can do */
static real bound_r2_w1(const oven_threshold_coefficients *c, oven_threshold_memory *x,
        const oven_samples *s, bool first, real phi0)
{
    if (first) {
        /* nothing is remembered yet */
        x->r2_w1_s2 = REAL(0.0);
        x->r2_w1_s1 = REAL(0.0);
    }

    /* r2_w1: stage 2 */
    const real w1_u2 = phi0 * (c->r1_w1_Th * s->Th - c->r1_w1_Th * s->To);
    const real w1_y2 = x->r2_w1_s2 + c->b * w1_u2;

    /* r2_w1: stage 2: memory */
    x->r2_w1_s2 = c->a * w1_y2 + c->b * w1_u2;

    /* r2_w1: stage 1 */
    const real w1_u1 = w1_y2;
    const real w1_y1 = x->r2_w1_s1 + c->b * w1_u1;

    /* r2_w1: stage 1: memory */
    x->r2_w1_s1 = c->a * w1_y1 + c->b * w1_u1;

    /* what the tolerance of Gh can do */
    const real w1 = w1_y1;

    return w1;
}

/* what the tolerance of Go can do */
static real bound_r2_w2(const oven_threshold_coefficients *c, oven_threshold_memory *x,
        const oven_samples *s, bool first, real phi0)
{
    if (first) {
        /* nothing is remembered yet */
        x->r2_w2_s2 = REAL(0.0);
        x->r2_w2_s1 = REAL(0.0);
    }

    /* r2_w2: stage 2 */
    const real w2_u2 = phi0 * (c->r2_w2_Ta * s->Ta - c->r2_w2_Ta * s->To);
    const real w2_y2 = x->r2_w2_s2 + c->b * w2_u2;

    /* r2_w2: stage 2: memory */
    x->r2_w2_s2 = c->a * w2_y2 + c->b * w2_u2;

    /* r2_w2: stage 1 */
    const real w2_u1 = w2_y2;
    const real w2_y1 = x->r2_w2_s1 + c->b * w2_u1;

    /* r2_w2: stage 1: memory */
    x->r2_w2_s1 = c->a * w2_y1 + c->b * w2_u1;

    /* what the tolerance of Go can do */
    const real w2 = w2_y1;

    return w2;
}

/* r2 on one sample.
 * oven.bg:15: r2: how far r2 can be from zero if no parameter is out of tolerance */
static void bound_r2(
    const oven_threshold_coefficients *c, oven_threshold_memory *x, const oven_samples *s, real *r)
{
    const bool first = x->youngest == 0u && x->age[1] == 0u;

    /* how much of the start is over */
    const real u = first ? REAL(0.0) : least(REAL(1.0), x->r2_open + c->r1_pace);

    /* the same, for the next sample */
    x->r2_open = u;

    /* how much is to come */
    const real rest = REAL(1.0) - u;

    /* the window */
    const real phi0 = u * u * u * (REAL(1.0) + rest * (REAL(3.0) + rest * REAL(6.0)));

    const real w1 = bound_r2_w1(c, x, s, first, phi0);
    const real w2 = bound_r2_w2(c, x, s, first, phi0);

    r[OVEN_R2] = MATH(fabs)(w1) + MATH(fabs)(w2);
}

/* Ages and validity one by one: a number that is not finite makes the next sample the first. */
static void bound_count_samples(
    const oven_threshold_coefficients *c,
    oven_threshold_memory *x,
    oven_residuals *out)
{
    /* the thresholds that are computed, and what each one goes with */
    static const uint8_t number[] = {
        0, 1
    };
    static const uint8_t part[] = {
        0, 1
    };
    bool finite[2];
    int k;

    finite[0] = true;
    finite[1] = true;
    for (k = 0; k < 2; ++k) {
        finite[part[k]] = finite[part[k]] && finite_number(out->value[number[k]]);
    }
    x->youngest = UINT32_MAX;
    for (k = 0; k < 2; ++k) {
        x->age[k] = finite[k] ? x->age[k] + (x->age[k] < UINT32_MAX ? 1u : 0u) : 0u;
        x->youngest = x->age[k] < x->youngest ? x->age[k] : x->youngest;
    }
    for (k = 0; k < 2; ++k) {
        out->value[number[k]] = finite[part[k]] ? out->value[number[k]] : REAL(0.0);
        out->valid[number[k]] = x->age[part[k]] > c->settle[number[k]];
    }
    out->valid[OVEN_R1] = out->valid[OVEN_R1] && x->r1_open >= REAL(1.0);
    out->valid[OVEN_R2] = out->valid[OVEN_R2] && x->r2_open >= REAL(1.0);
}

void oven_threshold_reset(oven_threshold_memory *memory)
{
    int k;

    for (k = 0; k < 2; ++k) {
        memory->age[k] = 0u;
    }
    memory->youngest = 0u;
}

void oven_threshold_step(
    const oven_threshold_coefficients *coefficients,
    oven_threshold_memory *memory,
    const oven_samples *samples,
    oven_residuals *thresholds)
{
    const oven_threshold_coefficients *c = coefficients;
    oven_threshold_memory *x = memory;
    const oven_samples *s = samples;
    real *r = thresholds->value;

    bound_r1(c, x, s, r);
    bound_r2(c, x, s, r);
    bound_count_samples(c, x, thresholds);
}

#endif

const char oven_fault_name[OVEN_FAULTS][3] = {
    "Ch", "P", "Gh", "Th", "To", "Co", "Go", "Ta",
};

const uint16_t oven_fault_class[OVEN_FAULTS] = {
    0u, 0u, 1u, 1u, 1u, 2u, 2u, 2u,
};

const char oven_residual_name[OVEN_RESIDUALS][3] = {
    "r1", "r2",
};

/*
 * Signatures: the faults of class c are seen by the residuals of entries first_entry[c] and up to
 * first_entry[c + 1].
 */
static const uint32_t first_entry[OVEN_CLASSES + 1] = {
    0u, 1u, 3u, 4u,
};

static const uint16_t seen_by[4] = {
    0u, 0u, 1u, 1u,
};

/*
 * Sizes of faults in eighths of an octave: a residual in alarm makes a fault so much larger than
 * what is least here as it is out.
 */
static const uint8_t least_size[4] = {
    1u, 1u, 1u, 1u,
};

/* A residual is sure to show a fault of this size; 255: of no size. */
static const uint8_t sure_size[4] = {
    255u, 255u, 255u, 255u,
};

/* The peak of residual k since it went into alarm, beside what is sure to be one. */
static void remember_peak(
    oven_diagnosis *d, const oven_limit *limit, int k, real out, real bound)
{
    const real over = out - limit->level;
    const real sure = limit->level + bound + bound;

    if (over > d->peak[k] * sure && sure > REAL(0.0)) {
        d->peak[k] = over / sure;
    }
}

/* A peak in eighths of an octave above a sixteenth of what is sure to be an alarm. */
static int eighths(real peak)
{
    real top = REAL(0.0625);
    int n;

    for (n = 0; n < 255; ++n) {
        if (peak < top) {
            return n;
        }
        top *= REAL(1.0905077326652577);
    }
    return 255;
}

/*
 * How large a fault of class c is at least, as the residuals in alarm are out; -1: ruled out, as it
 * is not seen by all of the alarms.
 */
static int size_of(const oven_diagnosis *d, int c, int alarms)
{
    const uint32_t begin = first_entry[c];
    const uint32_t end = first_entry[c + 1];
    int size = 0;
    int seen = 0;
    uint32_t i;

    for (i = begin; i < end; ++i) {
        const int k = (int)seen_by[i];

        if (d->state[k] == OVEN_ALARM) {
            const int n = eighths(d->peak[k]);

            if (n > 0 && n + (int)least_size[i] > size) {
                size = n + (int)least_size[i];
            }
            ++seen;
        }
    }
    return seen == alarms ? size : -1;
}

/* What is left of the faults of class c. */
static oven_candidate left_of(const oven_diagnosis *d, int c, int alarms)
{
    const uint32_t begin = first_entry[c];
    const uint32_t end = first_entry[c + 1];
    const int size = size_of(d, c, alarms);
    uint32_t i;

    if (size < 0) {
        return OVEN_RULED_OUT;
    }
    if (d->settled < d->window) {
        return OVEN_LIKELY; /* too soon for what is quiet to say anything */
    }
    for (i = begin; i < end; ++i) {
        const int k = (int)seen_by[i];
        const int sure = (int)sure_size[i];

        if (d->state[k] == OVEN_HEALTHY && sure != 255 && sure <= size) {
            return OVEN_SMALL;
        }
    }
    return OVEN_LIKELY;
}

#define NEVER REAL(1e30) /* a limit that nothing exceeds */
#define RELEASE REAL(0.5) /* of its level: what is nearer is quiet */
#define OVERSHOOT REAL(1.166) /* of the mean of sums over their height */
#define SHARE REAL(0.3333333333333333) /* of the height, that a row adds at most */

/* A sum, kept between zero and twice its height. */
static real kept(real sum, real height)
{
    const real most = height + height;

    return sum < REAL(0.0) ? REAL(0.0) : sum > most ? most : sum;
}

/* One row more of residual k; whether a sum is too high. off: from the mean, out: beyond bound. */
static bool add_row(
    oven_diagnosis *d, const oven_limit *limit, int k, real off, real out, real bound)
{
    const real top = limit->height + OVERSHOOT;
    const real beyond = out > REAL(0.0) ? out : REAL(0.0);
    const real loud = beyond * beyond * limit->loud - limit->drift;
    const real most = SHARE * top;

    d->above[k] = kept(d->above[k] + ((off - bound) * limit->unit - REAL(0.5)), limit->height);
    d->below[k] = kept(d->below[k] + ((-off - bound) * limit->unit - REAL(0.5)), limit->height);
    d->louder[k] = kept(d->louder[k] + (loud > most ? most : loud), top);
    return d->above[k] > limit->height || d->below[k] > limit->height || d->louder[k] > top;
}

static bool sums_are_zero(const oven_diagnosis *d, int k)
{
    const real sum = d->above[k] + d->below[k] + d->louder[k];

    return !(sum > REAL(0.0));
}

static void forget_sums(oven_diagnosis *d, int k)
{
    d->above[k] = REAL(0.0);
    d->below[k] = REAL(0.0);
    d->louder[k] = REAL(0.0);
    d->streak[k] = 0u;
}

/* How far a residual is beyond its bound; off: from its mean. */
static real excess(real off, real bound)
{
#if defined __GNUC__ && !defined OVEN_REAL
    return MATH(__builtin_fabs)(off) - bound; /* one instruction, no library */
#else
    return (off < REAL(0.0) ? -off : off) - bound;
#endif
}

static bool is_within(const oven_limit *limit, real value, real bound)
{
    return excess(value - limit->mean, bound) <= limit->level;
}

/* Residual k in one sample; whether it goes into alarm. */
static bool watch(
    oven_diagnosis *d, const oven_limit *limit, int k, real value, real bound, bool row)
{
    const real off = value - limit->mean;
    const real out = excess(off, bound);
    bool high = false;

    if (row) {
        high = add_row(d, limit, k, off, out, bound);
    }
    if (d->state[k] == OVEN_ALARM) {
        d->since[k] += d->since[k] < UINT32_MAX ? 1u : 0u;
        remember_peak(d, limit, k, out, bound);
        if (!(out < RELEASE * limit->level) || !sums_are_zero(d, k)) {
            d->quiet = 0u;
        }
        return false;
    }
    d->state[k] = OVEN_HEALTHY;
    d->streak[k] = out > limit->level ? d->streak[k] + 1u : 0u;
    if (d->streak[k] < d->least && !high) {
        return false;
    }
    d->state[k] = OVEN_ALARM;
    d->since[k] = 0u;
    d->peak[k] = REAL(0.0);
    remember_peak(d, limit, k, out, bound);
    return true;
}

/* Which classes of faults the residuals leave, and the one if it is one. */
static void judge(oven_diagnosis *d)
{
    int likely = 0;
    int alarms = 0;
    int c;
    int k;

    for (k = 0; k < OVEN_RESIDUALS; ++k) {
        alarms += d->state[k] == OVEN_ALARM ? 1 : 0;
    }
    d->fault_class = OVEN_UNKNOWN;
    for (c = 0; c < OVEN_CLASSES; ++c) {
        const oven_candidate left = left_of(d, c, alarms);

        d->candidate[c] = (uint8_t)left;
        if (left == OVEN_LIKELY) {
            d->fault_class = (int16_t)c;
            ++likely;
        }
    }
    if (likely != 1 || d->settled < 2u * d->row) {
        d->fault_class = OVEN_UNKNOWN;
    }
}

oven_limit oven_limit_of(oven_real level)
{
    oven_limit limit;

    limit.mean = REAL(0.0);
    limit.level = level;
    limit.unit = REAL(0.0);
    limit.loud = REAL(0.0);
    limit.drift = REAL(0.5);
    limit.height = NEVER;
    limit.bound = REAL(0.0);
    return limit;
}

void oven_clear(oven_diagnosis *diagnosis)
{
    int k;

    for (k = 0; k < OVEN_RESIDUALS; ++k) {
        if (diagnosis->state[k] == OVEN_ALARM) {
            diagnosis->state[k] = OVEN_HEALTHY;
        }
        diagnosis->since[k] = 0u;
        diagnosis->peak[k] = REAL(0.0);
        forget_sums(diagnosis, k);
    }
    for (k = 0; k < OVEN_CLASSES; ++k) {
        diagnosis->candidate[k] = OVEN_RULED_OUT;
    }
    diagnosis->fault_class = OVEN_UNKNOWN;
    diagnosis->quiet = 0u;
    diagnosis->settled = 0u;
    diagnosis->calm = false;
}

void oven_diagnosis_reset(oven_diagnosis *diagnosis)
{
    int k;

    diagnosis->row = OVEN_ROW;
    diagnosis->least = 15u;
    diagnosis->hold = 10u * OVEN_ROW;
    diagnosis->window = 300u;
    diagnosis->latch = false;
    diagnosis->tick = 0u;
    for (k = 0; k < OVEN_RESIDUALS; ++k) {
        diagnosis->state[k] = OVEN_BLIND;
    }
    oven_clear(diagnosis);
}

/* Whether each residual has a value within its level: nearly all samples are so. */
static bool all_within(
    const oven_limit *limits, const real *bounds, const oven_residuals *residuals)
{
    const real *value = residuals->value;
    int k;

    if (bounds != NULL) {
        for (k = 0; k < OVEN_RESIDUALS; ++k) {
            if (!residuals->valid[k] || !is_within(&limits[k], value[k], bounds[k])) {
                return false;
            }
        }
    } else {
        for (k = 0; k < OVEN_RESIDUALS; ++k) {
            if (!residuals->valid[k] || !is_within(&limits[k], value[k], limits[k].bound)) {
                return false;
            }
        }
    }
    return true;
}

/* Residual k without a value. */
static void blind(oven_diagnosis *d, int k)
{
    forget_sums(d, k);
    if (d->state[k] == OVEN_ALARM) {
        d->quiet = 0u; /* nobody knows that it is over */
    } else {
        d->state[k] = OVEN_BLIND;
    }
}

bool oven_diagnose(
    oven_diagnosis *diagnosis,
    const oven_limit *limits,
    const oven_real *bounds,
    const oven_residuals *residuals)
{
    oven_diagnosis *d = diagnosis;
    bool alarm = false;
    bool fresh = false;
    bool row;
    int k;

    d->tick += 1u;
    row = d->tick >= d->row;
    if (d->calm && !row && all_within(limits, bounds, residuals)) {
        return false;
    }
    d->calm = true;
    if (row) {
        d->tick = 0u;
    }
    d->quiet += d->quiet < UINT32_MAX ? 1u : 0u;
    d->settled += d->settled < UINT32_MAX ? 1u : 0u;
    for (k = 0; k < OVEN_RESIDUALS; ++k) {
        if (residuals->valid[k]) {
            const real bound = bounds ? bounds[k] : limits[k].bound;

            fresh = watch(d, &limits[k], k, residuals->value[k], bound, row) || fresh;
        } else {
            blind(d, k);
        }
        d->calm = d->calm && d->state[k] == OVEN_HEALTHY && d->streak[k] == 0u;
        alarm = alarm || d->state[k] == OVEN_ALARM;
    }
    if (fresh) {
        d->quiet = 0u;
        d->settled = 0u;
    }
    if (alarm && !d->latch && d->quiet >= d->hold) {
        oven_clear(d);
        return false;
    }
    if (fresh || (alarm && row)) {
        judge(d);
    }
    return alarm;
}
