/* microphone.c: the residuals of Microphone; generated, see the header. */
#include "microphone.h"

#ifndef MICROPHONE_NO_THRESHOLDS
#include <math.h>
#endif
#include <stddef.h>

#if defined __FINITE_MATH_ONLY__ && __FINITE_MATH_ONLY__
#error "this code tells numbers from NaN: compile it without -ffinite-math-only (-ffast-math)"
#endif

typedef microphone_real real;

#define REAL(x) MICROPHONE_CONSTANT(x)
#if defined MICROPHONE_FLOAT && !defined MICROPHONE_REAL
#define MATH(name) name##f
#else
#define MATH(name) name
#endif

/* Neither NaN nor infinite: infinity minus infinity is NaN, and NaN is not 0. */
static bool finite_number(real value)
{
    return value - value <= REAL(0.0);
}

/* The larger of two numbers. */
static real greatest(real left, real right)
{
    return right > left ? right : left;
}

/* The least bandwidth * sample_time at which a filter still moves. */
#if defined MICROPHONE_FLOAT && !defined MICROPHONE_REAL
#define SLOWEST REAL(0.0001)
#else
#define SLOWEST REAL(1.0e-09)
#endif

uint32_t microphone_abi(void)
{
    return MICROPHONE_ABI;
}

const char *microphone_digest(void)
{
    return MICROPHONE_DIGEST;
}

void microphone_nominal(microphone_parameters *parameters)
{
    parameters->eps = REAL(8.8541878128e-12);  /* F/m */
    parameters->A = REAL(0.0001);              /* m^2 */
    parameters->R = REAL(10000000.0);          /* Ohm */
    parameters->m = REAL(1.0e-06);             /* kg */
    parameters->b = REAL(0.002);               /* N.s/m */
    parameters->k = REAL(5000.0);              /* N/m */
    parameters->x0 = REAL(2.0e-05);            /* m */
}

/* Whether configure may go on with what it is given. */
static microphone_status checked(const microphone_parameters *p, real sample_time, real bandwidth)
{
    const bool finite = finite_number(p->eps + p->A + p->R + p->m + p->b + p->k + p->x0);

    if (!finite) {
        return MICROPHONE_BAD_PARAMETER;
    }
    if (!(sample_time >= REAL(0.000999999)) || !finite_number(sample_time)) {
        return MICROPHONE_BAD_SAMPLE_TIME;
    }
    if (!(bandwidth * sample_time >= SLOWEST && bandwidth * sample_time <= REAL(3.0))) {
        return MICROPHONE_BAD_BANDWIDTH;
    }
    return MICROPHONE_OK;
}

/* Samples until `constants` time constants of the filter are over. */
static uint32_t samples(real constants, real sample_time, real bandwidth)
{
    const real wait = constants / (bandwidth * sample_time);
    const uint32_t whole = wait < REAL(4.0e9) ? (uint32_t)wait : UINT32_MAX - 1u;

    return (real)whole < wait ? whole + 1u : whole;
}

const microphone_coefficients microphone_nominal_coefficients = {
    REAL(2.0e-05),                 /* mic__mech__q0 */
    REAL(1.0e-07),                 /* r1_U0 */
    REAL(4.1666666666666665e-05),  /* scaled_sample_time */
    REAL(1.7708375625600016e-14),  /* r1_w1_product */
    REAL(3.3333333333333396e-05),  /* bend1 */
    REAL(0.9801980198019802),      /* a */
    REAL(0.00990099009900991),     /* b */
    REAL(0.0001),                  /* r2_pressure */
    REAL(5000.0),                  /* r2_v_int */
    REAL(0.002),                   /* r2_v */
    REAL(4.4270939064000005e-16),  /* r2_product */
    REAL(0.0005),                  /* half_time */
    REAL(1.666666666666668e-06),   /* bend_int */
    {462u, 346u},                  /* samples until each is valid */
    462u                           /* the longest of these */
};

/* The coefficients, from the parameters. */
static void compute_coefficients(microphone_coefficients *c, const microphone_parameters *p,
        real sample_time, real bandwidth)
{
    /* bandwidth*sample_time */
    const real x_ = bandwidth * sample_time;

    /* of a stage: what is left of its memory */
    const real pole = greatest(REAL(2.0) - x_, REAL(0.0)) / (x_ + REAL(2.0));

    /* w*sample_time, x or 2 */
    const real turn = REAL(2.0) * (REAL(1.0) - pole) / (pole + REAL(1.0));

    /* w of the filter 1/(1 + D/w) */
    const real w = turn / sample_time;

    /* microphone.bg:17: mic.mech.q0 */
    c->mic__mech__q0 = p->x0;

    /* r1: factor of U0: 1/R */
    c->r1_U0 = REAL(1.0) / p->R;

    /* sample_time/24 */
    c->scaled_sample_time = sample_time / REAL(24.0);

    /* r1: factor of D(u/(mic.mech.q0 + Int(v))) */
    c->r1_w1_product = p->eps * p->A * w;

    /* filter: 1 * (w*sample_time)^2/12 */
    c->bend1 = turn * turn / REAL(12.0);

    /* filter: what is left of a memory a sample later */
    c->a = pole;

    /* filter: weight of a sample, new and a sample later */
    c->b = REAL(0.5) * (REAL(1.0) - pole);

    /* microphone.bg:29: r2: factor of pressure: A */
    c->r2_pressure = p->A;

    /* r2: factor of Int(v): k */
    c->r2_v_int = p->k;

    /* r2: factor of v: b */
    c->r2_v = p->b;

    /* r2: factor of u^2/(mic.mech.q0 + Int(v))^2: eps*A/2 */
    c->r2_product = REAL(0.5) * p->eps * p->A;

    /* half the sample time */
    c->half_time = REAL(0.5) * sample_time;

    /* filter: w*sample_time^2/12 */
    c->bend_int = sample_time * sample_time * w / REAL(12.0);
}

static bool coefficients_are_finite(const microphone_coefficients *c)
{
    return finite_number(c->mic__mech__q0 + c->r1_U0 + c->scaled_sample_time + c->r1_w1_product
            + c->bend1 + c->a + c->b + c->r2_pressure + c->r2_v_int + c->r2_v + c->r2_product
            + c->half_time + c->bend_int);
}

microphone_status microphone_configure(
    microphone_coefficients *coefficients,
    const microphone_parameters *parameters,
    microphone_real sample_time,
    microphone_real bandwidth)
{
    microphone_coefficients *c = coefficients;
    const microphone_status status = checked(parameters, sample_time, bandwidth);
    int k;

    for (k = 0; k < MICROPHONE_RESIDUALS; ++k) {
        c->settle[k] = UINT32_MAX;
    }
    c->longest = UINT32_MAX;
    if (status != MICROPHONE_OK) {
        return status;
    }
    compute_coefficients(c, parameters, sample_time, bandwidth);
    if (!coefficients_are_finite(c)) {
        return MICROPHONE_BAD_COEFFICIENT;
    }
    c->settle[MICROPHONE_R1] = samples(REAL(9.233413476451586), sample_time, bandwidth);
    c->settle[MICROPHONE_R2] = samples(REAL(6.907755278982138), sample_time, bandwidth);
    c->longest = c->settle[MICROPHONE_R1];
    return MICROPHONE_OK;
}

/* r1 on one sample.
 * microphone.bg:17: r1 = (U0 - u)/R - eps*A*D(u/Int(v, x0)) */
static void run_r1(
    const microphone_coefficients *c, microphone_memory *x, const microphone_samples *s, real *r)
{
    const bool first = x->youngest == 0u && x->age[0] == 0u;

    if (first) {
        /* nothing is remembered yet */
        x->r1_s2 = REAL(0.0);
        x->r1_s1 = REAL(0.0);
    }

    /* a stage of the filter; on the first sample it is at rest */
    const real a = first ? -c->b : c->a;
    const real b = first ? REAL(1.0) : c->b;

    /* sample_time/24 times v, what is integrated */
    const real rate = c->scaled_sample_time * s->v;

    if (first) {
        /* r1: the integral is 0 at the start */
        x->r1_q = -REAL(12.0) * rate;
        x->r1_rate1 = rate;
        x->r1_rate2 = rate;
    }

    /* its integral since the start, by the rule of Adams */
    const real integral = x->r1_q + REAL(9.0) * rate + REAL(4.0) * x->r1_rate1 - x->r1_rate2;
    x->r1_q = x->r1_q + REAL(24.0) * rate;
    x->r1_rate2 = x->r1_rate1;
    x->r1_rate1 = rate;

    /* u/(mic.mech.q0 + Int(v)) */
    const real product = s->u / (integral + c->mic__mech__q0);

    /* terms of order 0 */
    const real g0 = c->r1_U0 * s->U0 - c->r1_U0 * s->u;

    /* degree 1 */
    const real d1 = c->r1_w1_product * product;

    /* error of order 0 */
    const real e0 = c->bend1 * g0;

    /* the filter multiplied out */
    const real p1_1 = e0 - d1;

    /* stage 2 */
    const real u2 = g0 - p1_1;
    const real y2 = x->r1_s2 + b * u2;
    x->r1_s2 = a * y2 + b * u2;

    /* stage 1 */
    const real u1 = y2 + p1_1 + e0;
    const real y1 = x->r1_s1 + b * u1;
    x->r1_s1 = a * y1 + b * u1;

    r[MICROPHONE_R1] = y1 - e0;
}

/* r2 on one sample.
 * microphone.bg:29: r2 = pressure*A - b*v - k*Int(v) - eps*A*u^2/(2*Int(v, x0)^2) - m*D(v) */
static void run_r2(
    const microphone_coefficients *c, microphone_memory *x, const microphone_samples *s, real *r)
{
    const bool first = x->youngest == 0u && x->age[1] == 0u;

    if (first) {
        /* nothing is remembered yet */
        x->r2_s1 = REAL(0.0);
    }

    /* a stage of the filter; on the first sample it is at rest */
    const real a = first ? -c->b : c->a;
    const real b = first ? REAL(1.0) : c->b;

    /* sample_time/24 times v, what is integrated */
    const real rate = c->scaled_sample_time * s->v;

    if (first) {
        /* r2: the integral is 0 at the start */
        x->r2_q = -REAL(12.0) * rate;
        x->r2_rate1 = rate;
        x->r2_rate2 = rate;
    }

    /* its integral since the start, by the rule of Adams */
    const real integral = x->r2_q + REAL(9.0) * rate + REAL(4.0) * x->r2_rate1 - x->r2_rate2;
    x->r2_q = x->r2_q + REAL(24.0) * rate;
    x->r2_rate2 = x->r2_rate1;
    x->r2_rate1 = rate;

    /* mic.mech.q0 + Int(v) */
    const real sum = integral + c->mic__mech__q0;

    /* u^2/(mic.mech.q0 + Int(v))^2 */
    const real product = s->u * s->u / sum / sum;

    /* integral, what is integrated */
    const real rate_2 = -c->r2_v_int * s->v;

    /* its integral since the start, by the trapezoid rule */
    const real area = first ? REAL(0.0) : x->r2_q_2 + c->half_time * rate_2;
    x->r2_q_2 = area + c->half_time * rate_2;

    /* error of order -1 */
    const real i_ = c->bend_int * rate_2;

    /* stage 1 */
    const real u1 = c->r2_pressure * s->pressure + area + i_ - c->r2_v * s->v
        - c->r2_product * product;
    const real y1 = x->r2_s1 + b * u1;
    x->r2_s1 = a * y1 + b * u1;

    r[MICROPHONE_R2] = y1 - i_;
}

/* Ages and validity one by one: a number that is not finite makes the next sample the first. */
static void count_samples(
    const microphone_coefficients *c,
    microphone_memory *x,
    const microphone_samples *s,
    microphone_residuals *out)
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

    finite[0] = finite_number(s->v);
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
}

void microphone_reset(microphone_memory *memory)
{
    int k;

    for (k = 0; k < 2; ++k) {
        memory->age[k] = 0u;
    }
    memory->youngest = 0u;
}

void microphone_step(
    const microphone_coefficients *coefficients,
    microphone_memory *memory,
    const microphone_samples *samples,
    microphone_residuals *residuals)
{
    const microphone_coefficients *c = coefficients;
    microphone_memory *x = memory;
    const microphone_samples *s = samples;
    real *r = residuals->value;
    int k;

    run_r1(c, x, s, r);
    run_r2(c, x, s, r);
    /* a sum is finite only if all its terms are */
    if (x->youngest > c->longest && finite_number(r[MICROPHONE_R1] + r[MICROPHONE_R2] + s->v)) {
        for (k = 0; k < MICROPHONE_RESIDUALS; ++k) {
            residuals->valid[k] = true;
        }
    } else {
        count_samples(c, x, s, residuals);
    }
}

#ifndef MICROPHONE_NO_THRESHOLDS

const microphone_threshold_coefficients microphone_threshold_nominal_coefficients = {
    REAL(5.0e-09),                /* r1_w1_U0 */
    REAL(0.9801980198019802),     /* a */
    REAL(0.00990099009900991),    /* b */
    REAL(2.631578947368421e-10),  /* r1_w2_u */
    REAL(0.0004),                 /* r2_w1_v */
    {462u, 346u},                 /* samples until each is valid */
    462u                          /* the longest of these */
};

/* The coefficients, from the parameters. */
static void bound_compute_coefficients(microphone_threshold_coefficients *c,
        const microphone_parameters *p, real sample_time, real bandwidth)
{
    /* bandwidth*sample_time */
    const real x_ = bandwidth * sample_time;

    /* of a stage: what is left of its memory */
    const real pole = greatest(REAL(2.0) - x_, REAL(0.0)) / (x_ + REAL(2.0));

    /* microphone.bg:17: 1/R */
    const real one_over_R = REAL(1.0) / p->R;

    /* r1_w1: factor of U0 */
    c->r1_w1_U0 = one_over_R / REAL(20.0);

    /* filter: what is left of a memory a sample later */
    c->a = pole;

    /* filter: weight of a sample, new and a sample later */
    c->b = REAL(0.5) * (REAL(1.0) - pole);

    /* microphone.bg:17: r1_w2: factor of u */
    c->r1_w2_u = one_over_R / REAL(380.0);

    /* microphone.bg:29: r2_w1: factor of v */
    c->r2_w1_v = p->b / REAL(5.0);
}

static bool bound_coefficients_are_finite(const microphone_threshold_coefficients *c)
{
    return finite_number(c->r1_w1_U0 + c->a + c->b + c->r1_w2_u + c->r2_w1_v);
}

microphone_status microphone_threshold_configure(
    microphone_threshold_coefficients *coefficients,
    const microphone_parameters *parameters,
    microphone_real sample_time,
    microphone_real bandwidth)
{
    microphone_threshold_coefficients *c = coefficients;
    const microphone_status status = checked(parameters, sample_time, bandwidth);
    int k;

    for (k = 0; k < MICROPHONE_RESIDUALS; ++k) {
        c->settle[k] = UINT32_MAX;
    }
    c->longest = UINT32_MAX;
    if (status != MICROPHONE_OK) {
        return status;
    }
    bound_compute_coefficients(c, parameters, sample_time, bandwidth);
    if (!bound_coefficients_are_finite(c)) {
        return MICROPHONE_BAD_COEFFICIENT;
    }
    c->settle[MICROPHONE_R1] = samples(REAL(9.233413476451586), sample_time, bandwidth);
    c->settle[MICROPHONE_R2] = samples(REAL(6.907755278982138), sample_time, bandwidth);
    c->longest = c->settle[MICROPHONE_R1];
    return MICROPHONE_OK;
}

/* r1 on one sample.
 * microphone.bg:17: r1: how far r1 can be from zero if no parameter is out of tolerance */
static void bound_r1(
    const microphone_threshold_coefficients *c, microphone_threshold_memory *x, const microphone_samples *s, real *r)
{
    const bool first = x->youngest == 0u && x->age[0] == 0u;

    if (first) {
        /* nothing is remembered yet */
        x->r1_w1_s2 = REAL(0.0);
        x->r1_w1_s1 = REAL(0.0);
    }

    /* r1_w1: a stage of the filter; on the first sample it is at rest */
    const real w1_a = first ? -c->b : c->a;
    const real w1_b = first ? REAL(1.0) : c->b;

    /* r1_w1: stage 2 */
    const real w1_u2 = c->r1_w1_U0 * s->u - c->r1_w1_U0 * s->U0;
    const real w1_y2 = x->r1_w1_s2 + w1_b * w1_u2;
    x->r1_w1_s2 = w1_a * w1_y2 + w1_b * w1_u2;

    /* r1_w1: stage 1 */
    const real w1_u1 = w1_y2;
    const real w1_y1 = x->r1_w1_s1 + w1_b * w1_u1;
    x->r1_w1_s1 = w1_a * w1_y1 + w1_b * w1_u1;

    /* what the tolerance of R can do */
    const real w1 = w1_y1;

    if (first) {
        /* nothing is remembered yet */
        x->r1_w2_s2 = REAL(0.0);
        x->r1_w2_s1 = REAL(0.0);
    }

    /* r1_w2: stage 2 */
    const real w2_u2 = c->r1_w2_u * s->U0 - c->r1_w2_u * s->u;
    const real w2_y2 = x->r1_w2_s2 + w1_b * w2_u2;
    x->r1_w2_s2 = w1_a * w2_y2 + w1_b * w2_u2;

    /* r1_w2: stage 1 */
    const real w2_u1 = w2_y2;
    const real w2_y1 = x->r1_w2_s1 + w1_b * w2_u1;
    x->r1_w2_s1 = w1_a * w2_y1 + w1_b * w2_u1;

    /* second order of what the tolerance of R can do */
    const real w2 = w2_y1;

    r[MICROPHONE_R1] = MATH(fabs)(w1) + MATH(fabs)(w2);
}

/* r2 on one sample.
 * microphone.bg:29: r2: how far r2 can be from zero if no parameter is out of tolerance */
static void bound_r2(
    const microphone_threshold_coefficients *c, microphone_threshold_memory *x, const microphone_samples *s, real *r)
{
    const bool first = x->youngest == 0u && x->age[1] == 0u;

    if (first) {
        /* nothing is remembered yet */
        x->r2_w1_s1 = REAL(0.0);
    }

    /* r2_w1: a stage of the filter; on the first sample it is at rest */
    const real w1_a = first ? -c->b : c->a;
    const real w1_b = first ? REAL(1.0) : c->b;

    /* r2_w1: stage 1 */
    const real w1_u1 = -c->r2_w1_v * s->v;
    const real w1_y1 = x->r2_w1_s1 + w1_b * w1_u1;
    x->r2_w1_s1 = w1_a * w1_y1 + w1_b * w1_u1;

    /* what the tolerance of b can do */
    const real w1 = w1_y1;

    r[MICROPHONE_R2] = MATH(fabs)(w1);
}

/* Ages and validity one by one: a number that is not finite makes the next sample the first. */
static void bound_count_samples(
    const microphone_threshold_coefficients *c,
    microphone_threshold_memory *x,
    microphone_residuals *out)
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
}

void microphone_threshold_reset(microphone_threshold_memory *memory)
{
    int k;

    for (k = 0; k < 2; ++k) {
        memory->age[k] = 0u;
    }
    memory->youngest = 0u;
}

void microphone_threshold_step(
    const microphone_threshold_coefficients *coefficients,
    microphone_threshold_memory *memory,
    const microphone_samples *samples,
    microphone_residuals *thresholds)
{
    const microphone_threshold_coefficients *c = coefficients;
    microphone_threshold_memory *x = memory;
    const microphone_samples *s = samples;
    real *r = thresholds->value;
    int k;

    bound_r1(c, x, s, r);
    bound_r2(c, x, s, r);
    /* a sum is finite only if all its terms are */
    if (x->youngest > c->longest && finite_number(r[MICROPHONE_R1] + r[MICROPHONE_R2])) {
        for (k = 0; k < MICROPHONE_RESIDUALS; ++k) {
            thresholds->valid[k] = true;
        }
    } else {
        bound_count_samples(c, x, thresholds);
    }
}

#endif

const char microphone_fault_name[MICROPHONE_FAULTS][9] = {
    "A", "u", "v", "R", "U0", "m", "b", "k", "pressure",
};

const uint16_t microphone_fault_class[MICROPHONE_FAULTS] = {
    0u, 0u, 0u, 1u, 1u, 2u, 3u, 3u, 3u,
};

const char microphone_residual_name[MICROPHONE_RESIDUALS][3] = {
    "r1", "r2",
};

/*
 * Signatures: the faults of class c are seen by the residuals of entries first_entry[c] and up to
 * first_entry[c + 1].
 */
static const uint32_t first_entry[MICROPHONE_CLASSES + 1] = {
    0u, 2u, 3u, 4u, 5u,
};

static const uint16_t seen_by[5] = {
    0u, 1u, 0u, 1u, 1u,
};

/*
 * Sizes of faults in eighths of an octave: a residual in alarm makes a fault so much larger than
 * what is least here as it is out.
 */
static const uint8_t least_size[5] = {
    1u, 1u, 1u, 1u, 1u,
};

/* A residual is sure to show a fault of this size; 255: of no size. */
static const uint8_t sure_size[5] = {
    0u, 0u, 0u, 255u, 0u,
};

/* The peak of residual k since it went into alarm, beside what is sure to be one. */
static void remember_peak(
    microphone_diagnosis *d, const microphone_limit *limit, int k, real out, real bound)
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
static int size_of(const microphone_diagnosis *d, int c, int alarms)
{
    const uint32_t begin = first_entry[c];
    const uint32_t end = first_entry[c + 1];
    int size = 0;
    int seen = 0;
    uint32_t i;

    for (i = begin; i < end; ++i) {
        const int k = (int)seen_by[i];

        if (d->state[k] == MICROPHONE_ALARM) {
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
static microphone_candidate left_of(const microphone_diagnosis *d, int c, int alarms)
{
    const uint32_t begin = first_entry[c];
    const uint32_t end = first_entry[c + 1];
    const int size = size_of(d, c, alarms);
    uint32_t i;

    if (size < 0) {
        return MICROPHONE_RULED_OUT;
    }
    if (d->settled < d->window) {
        return MICROPHONE_LIKELY; /* too soon for what is quiet to say anything */
    }
    for (i = begin; i < end; ++i) {
        const int k = (int)seen_by[i];
        const int sure = (int)sure_size[i];

        if (d->state[k] == MICROPHONE_HEALTHY && sure != 255 && sure <= size) {
            return MICROPHONE_SMALL;
        }
    }
    return MICROPHONE_LIKELY;
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
    microphone_diagnosis *d, const microphone_limit *limit, int k, real off, real out, real bound)
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

static bool sums_are_zero(const microphone_diagnosis *d, int k)
{
    const real sum = d->above[k] + d->below[k] + d->louder[k];

    return !(sum > REAL(0.0));
}

static void forget_sums(microphone_diagnosis *d, int k)
{
    d->above[k] = REAL(0.0);
    d->below[k] = REAL(0.0);
    d->louder[k] = REAL(0.0);
    d->streak[k] = 0u;
}

/* How far a residual is beyond its bound; off: from its mean. */
static real excess(real off, real bound)
{
#if defined __GNUC__ && !defined MICROPHONE_REAL
    return MATH(__builtin_fabs)(off) - bound; /* one instruction, no library */
#else
    return (off < REAL(0.0) ? -off : off) - bound;
#endif
}

static bool is_within(const microphone_limit *limit, real value, real bound)
{
    return excess(value - limit->mean, bound) <= limit->level;
}

/* Residual k in one sample; whether it goes into alarm. */
static bool watch(
    microphone_diagnosis *d, const microphone_limit *limit, int k, real value, real bound, bool row)
{
    const real off = value - limit->mean;
    const real out = excess(off, bound);
    bool high = false;

    if (row) {
        high = add_row(d, limit, k, off, out, bound);
    }
    if (d->state[k] == MICROPHONE_ALARM) {
        d->since[k] += d->since[k] < UINT32_MAX ? 1u : 0u;
        remember_peak(d, limit, k, out, bound);
        if (!(out < RELEASE * limit->level) || !sums_are_zero(d, k)) {
            d->quiet = 0u;
        }
        return false;
    }
    d->state[k] = MICROPHONE_HEALTHY;
    d->streak[k] = out > limit->level ? d->streak[k] + 1u : 0u;
    if (d->streak[k] < d->least && !high) {
        return false;
    }
    d->state[k] = MICROPHONE_ALARM;
    d->since[k] = 0u;
    d->peak[k] = REAL(0.0);
    remember_peak(d, limit, k, out, bound);
    return true;
}

/* Which classes of faults the residuals leave, and the one if it is one. */
static void judge(microphone_diagnosis *d)
{
    int likely = 0;
    int alarms = 0;
    int c;
    int k;

    for (k = 0; k < MICROPHONE_RESIDUALS; ++k) {
        alarms += d->state[k] == MICROPHONE_ALARM ? 1 : 0;
    }
    d->fault_class = MICROPHONE_UNKNOWN;
    for (c = 0; c < MICROPHONE_CLASSES; ++c) {
        const microphone_candidate left = left_of(d, c, alarms);

        d->candidate[c] = (uint8_t)left;
        if (left == MICROPHONE_LIKELY) {
            d->fault_class = (int16_t)c;
            ++likely;
        }
    }
    if (likely != 1 || d->settled < 2u * d->row) {
        d->fault_class = MICROPHONE_UNKNOWN;
    }
}

microphone_limit microphone_limit_of(microphone_real level)
{
    microphone_limit limit;

    limit.mean = REAL(0.0);
    limit.level = level;
    limit.unit = REAL(0.0);
    limit.loud = REAL(0.0);
    limit.drift = REAL(0.5);
    limit.height = NEVER;
    limit.bound = REAL(0.0);
    return limit;
}

void microphone_clear(microphone_diagnosis *diagnosis)
{
    int k;

    for (k = 0; k < MICROPHONE_RESIDUALS; ++k) {
        if (diagnosis->state[k] == MICROPHONE_ALARM) {
            diagnosis->state[k] = MICROPHONE_HEALTHY;
        }
        diagnosis->since[k] = 0u;
        diagnosis->peak[k] = REAL(0.0);
        forget_sums(diagnosis, k);
    }
    for (k = 0; k < MICROPHONE_CLASSES; ++k) {
        diagnosis->candidate[k] = MICROPHONE_RULED_OUT;
    }
    diagnosis->fault_class = MICROPHONE_UNKNOWN;
    diagnosis->quiet = 0u;
    diagnosis->settled = 0u;
    diagnosis->calm = false;
}

void microphone_diagnosis_reset(microphone_diagnosis *diagnosis)
{
    int k;

    diagnosis->row = MICROPHONE_ROW;
    diagnosis->least = 15u;
    diagnosis->hold = 10u * MICROPHONE_ROW;
    diagnosis->window = 300u;
    diagnosis->latch = false;
    diagnosis->tick = 0u;
    for (k = 0; k < MICROPHONE_RESIDUALS; ++k) {
        diagnosis->state[k] = MICROPHONE_BLIND;
    }
    microphone_clear(diagnosis);
}

/* Whether each residual has a value within its level: nearly all samples are so. */
static bool all_within(
    const microphone_limit *limits, const real *bounds, const microphone_residuals *residuals)
{
    const real *value = residuals->value;
    int k;

    if (bounds != NULL) {
        for (k = 0; k < MICROPHONE_RESIDUALS; ++k) {
            if (!residuals->valid[k] || !is_within(&limits[k], value[k], bounds[k])) {
                return false;
            }
        }
    } else {
        for (k = 0; k < MICROPHONE_RESIDUALS; ++k) {
            if (!residuals->valid[k] || !is_within(&limits[k], value[k], limits[k].bound)) {
                return false;
            }
        }
    }
    return true;
}

/* Residual k without a value. */
static void blind(microphone_diagnosis *d, int k)
{
    forget_sums(d, k);
    if (d->state[k] == MICROPHONE_ALARM) {
        d->quiet = 0u; /* nobody knows that it is over */
    } else {
        d->state[k] = MICROPHONE_BLIND;
    }
}

bool microphone_diagnose(
    microphone_diagnosis *diagnosis,
    const microphone_limit *limits,
    const microphone_real *bounds,
    const microphone_residuals *residuals)
{
    microphone_diagnosis *d = diagnosis;
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
    for (k = 0; k < MICROPHONE_RESIDUALS; ++k) {
        if (residuals->valid[k]) {
            const real bound = bounds ? bounds[k] : limits[k].bound;

            fresh = watch(d, &limits[k], k, residuals->value[k], bound, row) || fresh;
        } else {
            blind(d, k);
        }
        d->calm = d->calm && d->state[k] == MICROPHONE_HEALTHY && d->streak[k] == 0u;
        alarm = alarm || d->state[k] == MICROPHONE_ALARM;
    }
    if (fresh) {
        d->quiet = 0u;
        d->settled = 0u;
    }
    if (alarm && !d->latch && d->quiet >= d->hold) {
        microphone_clear(d);
        return false;
    }
    if (fresh || (alarm && row)) {
        judge(d);
    }
    return alarm;
}
