/* two_tanks.c: the residuals of TwoTanks; generated, see the header. */
#include "two_tanks.h"

#include <math.h>
#include <stddef.h>

#if defined __FINITE_MATH_ONLY__ && __FINITE_MATH_ONLY__
#error "this code tells numbers from NaN: compile it without -ffinite-math-only (-ffast-math)"
#endif

typedef two_tanks_real real;

#define REAL(x) TWO_TANKS_CONSTANT(x)
#if defined TWO_TANKS_FLOAT && !defined TWO_TANKS_REAL
#define MATH(name) name##f
#else
#define MATH(name) name
#endif

/* Neither NaN nor infinite: infinity minus infinity is NaN, and NaN is not 0. */
static bool finite_number(real value)
{
    return value - value <= REAL(0.0);
}

/* sign(value) * sqrt(|value|) */
static real signed_root(real value)
{
    return value < REAL(0.0) ? -MATH(sqrt)(-value) : MATH(sqrt)(value);
}

/* The larger of two numbers. */
static real greatest(real left, real right)
{
    return right > left ? right : left;
}

/* The least bandwidth * sample_time at which a filter still moves. */
#if defined TWO_TANKS_FLOAT && !defined TWO_TANKS_REAL
#define SLOWEST REAL(0.0001)
#else
#define SLOWEST REAL(1.0e-09)
#endif

uint32_t two_tanks_abi(void)
{
    return TWO_TANKS_ABI;
}

const char *two_tanks_digest(void)
{
    return TWO_TANKS_DIGEST;
}

void two_tanks_nominal(two_tanks_parameters *parameters)
{
    parameters->rho = REAL(998.0);     /* kg/m^3 */
    parameters->g = REAL(9.81);        /* m/s^2 */
    parameters->A1 = REAL(0.0154);     /* m^2 */
    parameters->A2 = REAL(0.0154);     /* m^2 */
    parameters->k12 = REAL(1.2e-06);   /* m^3/s.Pa^-0.5 */
    parameters->kout = REAL(1.0e-06);  /* m^3/s.Pa^-0.5 */
    parameters->leak = REAL(0.0);      /* m^3/s.Pa^-0.5 */
}

/* Whether configure may go on with what it is given. */
static two_tanks_status checked(const two_tanks_parameters *p, real sample_time, real bandwidth)
{
    const bool finite = finite_number(p->rho + p->g + p->A1 + p->A2 + p->k12 + p->kout + p->leak);

    if (!finite) {
        return TWO_TANKS_BAD_PARAMETER;
    }
    if (!(sample_time > REAL(0.0)) || !finite_number(sample_time)) {
        return TWO_TANKS_BAD_SAMPLE_TIME;
    }
    if (!(bandwidth * sample_time >= SLOWEST && bandwidth * sample_time <= REAL(3.0))) {
        return TWO_TANKS_BAD_BANDWIDTH;
    }
    return TWO_TANKS_OK;
}

/* Samples until `constants` time constants of the filter are over. */
static uint32_t samples(real constants, real sample_time, real bandwidth)
{
    const real wait = constants / (bandwidth * sample_time);
    const uint32_t whole = wait < REAL(4.0e9) ? (uint32_t)wait : UINT32_MAX - 1u;

    return (real)whole < wait ? whole + 1u : whole;
}

const two_tanks_coefficients two_tanks_nominal_coefficients = {
    REAL(0.0),                     /* r1_ssqrt */
    REAL(1.2e-06),                 /* r1_ssqrt_2 */
    REAL(3.1459453054937626e-05),  /* r1_w1_p1 */
    REAL(3.3333333333333396e-05),  /* bend1 */
    REAL(0.9801980198019802),      /* a */
    REAL(0.00990099009900991),     /* b */
    REAL(1.0e-06),                 /* r2_ssqrt */
    REAL(3.1459453054937626e-05),  /* r2_w1_p2 */
    {462u, 462u},                  /* samples until each is valid */
    462u                           /* the longest of these */
};

/* The coefficients, from the parameters. */
static void compute_coefficients(two_tanks_coefficients *c, const two_tanks_parameters *p,
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

    /* two_tanks.bg:16: r1: factor of ssqrt(p1): leak */
    c->r1_ssqrt = p->leak;

    /* r1: factor of ssqrt(p1 - p2): k12 */
    c->r1_ssqrt_2 = p->k12;

    /* r1: factor of p1' */
    c->r1_w1_p1 = p->A1 * w / p->rho / p->g;

    /* filter: 1 * (w*sample_time)^2/12 */
    c->bend1 = turn * turn / REAL(12.0);

    /* filter: what is left of a memory a sample later */
    c->a = pole;

    /* filter: weight of a sample, new and a sample later */
    c->b = REAL(0.5) * (REAL(1.0) - pole);

    /* two_tanks.bg:16: r2: factor of ssqrt(p2): kout */
    c->r2_ssqrt = p->kout;

    /* r2: factor of p2' */
    c->r2_w1_p2 = p->A2 * w / p->rho / p->g;
}

static bool coefficients_are_finite(const two_tanks_coefficients *c)
{
    return finite_number(c->r1_ssqrt + c->r1_ssqrt_2 + c->r1_w1_p1 + c->bend1 + c->a + c->b
            + c->r2_ssqrt + c->r2_w1_p2);
}

two_tanks_status two_tanks_configure(
    two_tanks_coefficients *coefficients,
    const two_tanks_parameters *parameters,
    two_tanks_real sample_time,
    two_tanks_real bandwidth)
{
    two_tanks_coefficients *c = coefficients;
    const two_tanks_status status = checked(parameters, sample_time, bandwidth);
    int k;

    for (k = 0; k < TWO_TANKS_RESIDUALS; ++k) {
        c->settle[k] = UINT32_MAX;
    }
    c->longest = UINT32_MAX;
    if (status != TWO_TANKS_OK) {
        return status;
    }
    compute_coefficients(c, parameters, sample_time, bandwidth);
    if (!coefficients_are_finite(c)) {
        return TWO_TANKS_BAD_COEFFICIENT;
    }
    c->settle[TWO_TANKS_R1] = samples(REAL(9.233413476451586), sample_time, bandwidth);
    c->settle[TWO_TANKS_R2] = samples(REAL(9.233413476451586), sample_time, bandwidth);
    c->longest = c->settle[TWO_TANKS_R1];
    return TWO_TANKS_OK;
}

/* r1 on one sample.
 * two_tanks.bg:16: r1 = Q - leak*ssqrt(p1) - k12*ssqrt(p1 - p2) - A1*D(p1)/(rho*g) */
static void run_r1(
    const two_tanks_coefficients *c, two_tanks_memory *x, const two_tanks_samples *s, real *r)
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

    /* ssqrt(p1) */
    const real ssqrt = signed_root(s->p1);

    /* ssqrt(p1 - p2) */
    const real ssqrt_2 = signed_root(s->p1 - s->p2);

    /* terms of order 0 */
    const real g0 = s->Q - c->r1_ssqrt * ssqrt - c->r1_ssqrt_2 * ssqrt_2;

    /* degree 1 */
    const real d1 = c->r1_w1_p1 * s->p1;

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

    r[TWO_TANKS_R1] = y1 - e0;
}

/* r2 on one sample.
 * two_tanks.bg:16: r2 = k12*ssqrt(p1 - p2) - kout*ssqrt(p2) - A2*D(p2)/(rho*g) */
static void run_r2(
    const two_tanks_coefficients *c, two_tanks_memory *x, const two_tanks_samples *s, real *r)
{
    const bool first = x->youngest == 0u && x->age[1] == 0u;

    if (first) {
        /* nothing is remembered yet */
        x->r2_s2 = REAL(0.0);
        x->r2_s1 = REAL(0.0);
    }

    /* a stage of the filter; on the first sample it is at rest */
    const real a = first ? -c->b : c->a;
    const real b = first ? REAL(1.0) : c->b;

    /* ssqrt(p2) */
    const real ssqrt = signed_root(s->p2);

    /* ssqrt(p1 - p2) */
    const real ssqrt_2 = signed_root(s->p1 - s->p2);

    /* terms of order 0 */
    const real g0 = c->r1_ssqrt_2 * ssqrt_2 - c->r2_ssqrt * ssqrt;

    /* degree 1 */
    const real d1 = c->r2_w1_p2 * s->p2;

    /* error of order 0 */
    const real e0 = c->bend1 * g0;

    /* the filter multiplied out */
    const real p1_1 = e0 - d1;

    /* stage 2 */
    const real u2 = g0 - p1_1;
    const real y2 = x->r2_s2 + b * u2;
    x->r2_s2 = a * y2 + b * u2;

    /* stage 1 */
    const real u1 = y2 + p1_1 + e0;
    const real y1 = x->r2_s1 + b * u1;
    x->r2_s1 = a * y1 + b * u1;

    r[TWO_TANKS_R2] = y1 - e0;
}

/* Ages and validity one by one: a number that is not finite makes the next sample the first. */
static void count_samples(
    const two_tanks_coefficients *c,
    two_tanks_memory *x,
    const two_tanks_samples *s,
    two_tanks_residuals *out)
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

    finite[0] = finite_number(s->p2);
    finite[1] = finite_number(s->p1);
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

void two_tanks_reset(two_tanks_memory *memory)
{
    int k;

    for (k = 0; k < 2; ++k) {
        memory->age[k] = 0u;
    }
    memory->youngest = 0u;
}

void two_tanks_step(
    const two_tanks_coefficients *coefficients,
    two_tanks_memory *memory,
    const two_tanks_samples *samples,
    two_tanks_residuals *residuals)
{
    const two_tanks_coefficients *c = coefficients;
    two_tanks_memory *x = memory;
    const two_tanks_samples *s = samples;
    real *r = residuals->value;
    int k;

    run_r1(c, x, s, r);
    run_r2(c, x, s, r);
    /* a sum is finite only if all its terms are */
    if (x->youngest > c->longest
            && finite_number(r[TWO_TANKS_R1] + r[TWO_TANKS_R2] + s->p2 + s->p1)) {
        for (k = 0; k < TWO_TANKS_RESIDUALS; ++k) {
            residuals->valid[k] = true;
        }
    } else {
        count_samples(c, x, s, residuals);
    }
}

#ifndef TWO_TANKS_NO_THRESHOLDS

const two_tanks_threshold_coefficients two_tanks_threshold_nominal_coefficients = {
    REAL(6.0e-08),              /* r1_w1_ssqrt */
    REAL(0.9801980198019802),   /* a */
    REAL(0.00990099009900991),  /* b */
    REAL(5.0e-08),              /* r2_w2_ssqrt */
    {462u, 462u},               /* samples until each is valid */
    462u                        /* the longest of these */
};

/* The coefficients, from the parameters. */
static void bound_compute_coefficients(two_tanks_threshold_coefficients *c,
        const two_tanks_parameters *p, real sample_time, real bandwidth)
{
    /* bandwidth*sample_time */
    const real x_ = bandwidth * sample_time;

    /* of a stage: what is left of its memory */
    const real pole = greatest(REAL(2.0) - x_, REAL(0.0)) / (x_ + REAL(2.0));

    /* two_tanks.bg:16: r1_w1: factor of ssqrt(p1 - p2) */
    c->r1_w1_ssqrt = p->k12 / REAL(20.0);

    /* filter: what is left of a memory a sample later */
    c->a = pole;

    /* filter: weight of a sample, new and a sample later */
    c->b = REAL(0.5) * (REAL(1.0) - pole);

    /* two_tanks.bg:16: r2_w2: factor of ssqrt(p2) */
    c->r2_w2_ssqrt = p->kout / REAL(20.0);
}

static bool bound_coefficients_are_finite(const two_tanks_threshold_coefficients *c)
{
    return finite_number(c->r1_w1_ssqrt + c->a + c->b + c->r2_w2_ssqrt);
}

two_tanks_status two_tanks_threshold_configure(
    two_tanks_threshold_coefficients *coefficients,
    const two_tanks_parameters *parameters,
    two_tanks_real sample_time,
    two_tanks_real bandwidth)
{
    two_tanks_threshold_coefficients *c = coefficients;
    const two_tanks_status status = checked(parameters, sample_time, bandwidth);
    int k;

    for (k = 0; k < TWO_TANKS_RESIDUALS; ++k) {
        c->settle[k] = UINT32_MAX;
    }
    c->longest = UINT32_MAX;
    if (status != TWO_TANKS_OK) {
        return status;
    }
    bound_compute_coefficients(c, parameters, sample_time, bandwidth);
    if (!bound_coefficients_are_finite(c)) {
        return TWO_TANKS_BAD_COEFFICIENT;
    }
    c->settle[TWO_TANKS_R1] = samples(REAL(9.233413476451586), sample_time, bandwidth);
    c->settle[TWO_TANKS_R2] = samples(REAL(9.233413476451586), sample_time, bandwidth);
    c->longest = c->settle[TWO_TANKS_R1];
    return TWO_TANKS_OK;
}

/* r1 on one sample.
 * two_tanks.bg:16: r1: how far r1 can be from zero if no parameter is out of tolerance */
static void bound_r1(
    const two_tanks_threshold_coefficients *c, two_tanks_threshold_memory *x, const two_tanks_samples *s, real *r)
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

    /* ssqrt(p1 - p2) */
    const real w1_ssqrt = signed_root(s->p1 - s->p2);

    /* r1_w1: stage 2 */
    const real w1_u2 = -c->r1_w1_ssqrt * w1_ssqrt;
    const real w1_y2 = x->r1_w1_s2 + w1_b * w1_u2;
    x->r1_w1_s2 = w1_a * w1_y2 + w1_b * w1_u2;

    /* r1_w1: stage 1 */
    const real w1_u1 = w1_y2;
    const real w1_y1 = x->r1_w1_s1 + w1_b * w1_u1;
    x->r1_w1_s1 = w1_a * w1_y1 + w1_b * w1_u1;

    /* what the tolerance of k12 can do */
    const real w1 = w1_y1;

    r[TWO_TANKS_R1] = MATH(fabs)(w1);
}

/* r2 on one sample.
 * two_tanks.bg:16: r2: how far r2 can be from zero if no parameter is out of tolerance */
static void bound_r2(
    const two_tanks_threshold_coefficients *c, two_tanks_threshold_memory *x, const two_tanks_samples *s, real *r)
{
    const bool first = x->youngest == 0u && x->age[1] == 0u;

    if (first) {
        /* nothing is remembered yet */
        x->r2_w1_s2 = REAL(0.0);
        x->r2_w1_s1 = REAL(0.0);
    }

    /* r2_w1: a stage of the filter; on the first sample it is at rest */
    const real w1_a = first ? -c->b : c->a;
    const real w1_b = first ? REAL(1.0) : c->b;

    /* ssqrt(p1 - p2) */
    const real w1_ssqrt = signed_root(s->p1 - s->p2);

    /* r2_w1: stage 2 */
    const real w1_u2 = c->r1_w1_ssqrt * w1_ssqrt;
    const real w1_y2 = x->r2_w1_s2 + w1_b * w1_u2;
    x->r2_w1_s2 = w1_a * w1_y2 + w1_b * w1_u2;

    /* r2_w1: stage 1 */
    const real w1_u1 = w1_y2;
    const real w1_y1 = x->r2_w1_s1 + w1_b * w1_u1;
    x->r2_w1_s1 = w1_a * w1_y1 + w1_b * w1_u1;

    /* what the tolerance of k12 can do */
    const real w1 = w1_y1;

    if (first) {
        /* nothing is remembered yet */
        x->r2_w2_s2 = REAL(0.0);
        x->r2_w2_s1 = REAL(0.0);
    }

    /* ssqrt(p2) */
    const real w2_ssqrt = signed_root(s->p2);

    /* r2_w2: stage 2 */
    const real w2_u2 = -c->r2_w2_ssqrt * w2_ssqrt;
    const real w2_y2 = x->r2_w2_s2 + w1_b * w2_u2;
    x->r2_w2_s2 = w1_a * w2_y2 + w1_b * w2_u2;

    /* r2_w2: stage 1 */
    const real w2_u1 = w2_y2;
    const real w2_y1 = x->r2_w2_s1 + w1_b * w2_u1;
    x->r2_w2_s1 = w1_a * w2_y1 + w1_b * w2_u1;

    /* what the tolerance of kout can do */
    const real w2 = w2_y1;

    r[TWO_TANKS_R2] = MATH(fabs)(w1) + MATH(fabs)(w2);
}

/* Ages and validity one by one: a number that is not finite makes the next sample the first. */
static void bound_count_samples(
    const two_tanks_threshold_coefficients *c,
    two_tanks_threshold_memory *x,
    const two_tanks_samples *s,
    two_tanks_residuals *out)
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

    finite[0] = finite_number(s->p1 + s->p2);
    finite[1] = finite_number(s->p1 + s->p2);
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

void two_tanks_threshold_reset(two_tanks_threshold_memory *memory)
{
    int k;

    for (k = 0; k < 2; ++k) {
        memory->age[k] = 0u;
    }
    memory->youngest = 0u;
}

void two_tanks_threshold_step(
    const two_tanks_threshold_coefficients *coefficients,
    two_tanks_threshold_memory *memory,
    const two_tanks_samples *samples,
    two_tanks_residuals *thresholds)
{
    const two_tanks_threshold_coefficients *c = coefficients;
    two_tanks_threshold_memory *x = memory;
    const two_tanks_samples *s = samples;
    real *r = thresholds->value;
    int k;

    bound_r1(c, x, s, r);
    bound_r2(c, x, s, r);
    /* a sum is finite only if all its terms are */
    if (x->youngest > c->longest
            && finite_number(r[TWO_TANKS_R1] + r[TWO_TANKS_R2] + s->p1 + s->p2 + s->p1 + s->p2)) {
        for (k = 0; k < TWO_TANKS_RESIDUALS; ++k) {
            thresholds->valid[k] = true;
        }
    } else {
        bound_count_samples(c, x, s, thresholds);
    }
}

#endif

const char two_tanks_fault_name[TWO_TANKS_FAULTS][5] = {
    "A1", "leak", "Q", "k12", "p1", "p2", "A2", "kout",
};

const uint16_t two_tanks_fault_class[TWO_TANKS_FAULTS] = {
    0u, 0u, 0u, 1u, 1u, 1u, 2u, 2u,
};

const char two_tanks_residual_name[TWO_TANKS_RESIDUALS][3] = {
    "r1", "r2",
};

/*
 * Signatures: the faults of class c are seen by the residuals of entries first_entry[c] and up to
 * first_entry[c + 1].
 */
static const uint32_t first_entry[TWO_TANKS_CLASSES + 1] = {
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
    0u, 0u, 0u, 0u,
};

/* The peak of residual k since it went into alarm, beside what is sure to be one. */
static void remember_peak(
    two_tanks_diagnosis *d, const two_tanks_limit *limit, int k, real out, real bound)
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
static int size_of(const two_tanks_diagnosis *d, int c, int alarms)
{
    const uint32_t begin = first_entry[c];
    const uint32_t end = first_entry[c + 1];
    int size = 0;
    int seen = 0;
    uint32_t i;

    for (i = begin; i < end; ++i) {
        const int k = (int)seen_by[i];

        if (d->state[k] == TWO_TANKS_ALARM) {
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
static two_tanks_candidate left_of(const two_tanks_diagnosis *d, int c, int alarms)
{
    const uint32_t begin = first_entry[c];
    const uint32_t end = first_entry[c + 1];
    const int size = size_of(d, c, alarms);
    uint32_t i;

    if (size < 0) {
        return TWO_TANKS_RULED_OUT;
    }
    if (d->settled < d->window) {
        return TWO_TANKS_LIKELY; /* too soon for what is quiet to say anything */
    }
    for (i = begin; i < end; ++i) {
        const int k = (int)seen_by[i];
        const int sure = (int)sure_size[i];

        if (d->state[k] == TWO_TANKS_HEALTHY && sure != 255 && sure <= size) {
            return TWO_TANKS_SMALL;
        }
    }
    return TWO_TANKS_LIKELY;
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
    two_tanks_diagnosis *d, const two_tanks_limit *limit, int k, real off, real out, real bound)
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

static bool sums_are_zero(const two_tanks_diagnosis *d, int k)
{
    const real sum = d->above[k] + d->below[k] + d->louder[k];

    return !(sum > REAL(0.0));
}

static void forget_sums(two_tanks_diagnosis *d, int k)
{
    d->above[k] = REAL(0.0);
    d->below[k] = REAL(0.0);
    d->louder[k] = REAL(0.0);
    d->streak[k] = 0u;
}

/* How far a residual is beyond its bound; off: from its mean. */
static real excess(real off, real bound)
{
#if defined __GNUC__ && !defined TWO_TANKS_REAL
    return MATH(__builtin_fabs)(off) - bound; /* one instruction, no library */
#else
    return (off < REAL(0.0) ? -off : off) - bound;
#endif
}

static bool is_within(const two_tanks_limit *limit, real value, real bound)
{
    return excess(value - limit->mean, bound) <= limit->level;
}

/* Residual k in one sample; whether it goes into alarm. */
static bool watch(
    two_tanks_diagnosis *d, const two_tanks_limit *limit, int k, real value, real bound, bool row)
{
    const real off = value - limit->mean;
    const real out = excess(off, bound);
    bool high = false;

    if (row) {
        high = add_row(d, limit, k, off, out, bound);
    }
    if (d->state[k] == TWO_TANKS_ALARM) {
        d->since[k] += d->since[k] < UINT32_MAX ? 1u : 0u;
        remember_peak(d, limit, k, out, bound);
        if (!(out < RELEASE * limit->level) || !sums_are_zero(d, k)) {
            d->quiet = 0u;
        }
        return false;
    }
    d->state[k] = TWO_TANKS_HEALTHY;
    d->streak[k] = out > limit->level ? d->streak[k] + 1u : 0u;
    if (d->streak[k] < d->least && !high) {
        return false;
    }
    d->state[k] = TWO_TANKS_ALARM;
    d->since[k] = 0u;
    d->peak[k] = REAL(0.0);
    remember_peak(d, limit, k, out, bound);
    return true;
}

/* Which classes of faults the residuals leave, and the one if it is one. */
static void judge(two_tanks_diagnosis *d)
{
    int likely = 0;
    int alarms = 0;
    int c;
    int k;

    for (k = 0; k < TWO_TANKS_RESIDUALS; ++k) {
        alarms += d->state[k] == TWO_TANKS_ALARM ? 1 : 0;
    }
    d->fault_class = TWO_TANKS_UNKNOWN;
    for (c = 0; c < TWO_TANKS_CLASSES; ++c) {
        const two_tanks_candidate left = left_of(d, c, alarms);

        d->candidate[c] = (uint8_t)left;
        if (left == TWO_TANKS_LIKELY) {
            d->fault_class = (int16_t)c;
            ++likely;
        }
    }
    if (likely != 1 || d->settled < 2u * d->row) {
        d->fault_class = TWO_TANKS_UNKNOWN;
    }
}

two_tanks_limit two_tanks_limit_of(two_tanks_real level)
{
    two_tanks_limit limit;

    limit.mean = REAL(0.0);
    limit.level = level;
    limit.unit = REAL(0.0);
    limit.loud = REAL(0.0);
    limit.drift = REAL(0.5);
    limit.height = NEVER;
    limit.bound = REAL(0.0);
    return limit;
}

void two_tanks_clear(two_tanks_diagnosis *diagnosis)
{
    int k;

    for (k = 0; k < TWO_TANKS_RESIDUALS; ++k) {
        if (diagnosis->state[k] == TWO_TANKS_ALARM) {
            diagnosis->state[k] = TWO_TANKS_HEALTHY;
        }
        diagnosis->since[k] = 0u;
        diagnosis->peak[k] = REAL(0.0);
        forget_sums(diagnosis, k);
    }
    for (k = 0; k < TWO_TANKS_CLASSES; ++k) {
        diagnosis->candidate[k] = TWO_TANKS_RULED_OUT;
    }
    diagnosis->fault_class = TWO_TANKS_UNKNOWN;
    diagnosis->quiet = 0u;
    diagnosis->settled = 0u;
    diagnosis->calm = false;
}

void two_tanks_diagnosis_reset(two_tanks_diagnosis *diagnosis)
{
    int k;

    diagnosis->row = TWO_TANKS_ROW;
    diagnosis->least = 15u;
    diagnosis->hold = 10u * TWO_TANKS_ROW;
    diagnosis->window = 300u;
    diagnosis->latch = false;
    diagnosis->tick = 0u;
    for (k = 0; k < TWO_TANKS_RESIDUALS; ++k) {
        diagnosis->state[k] = TWO_TANKS_BLIND;
    }
    two_tanks_clear(diagnosis);
}

/* Whether each residual has a value within its level: nearly all samples are so. */
static bool all_within(
    const two_tanks_limit *limits, const real *bounds, const two_tanks_residuals *residuals)
{
    const real *value = residuals->value;
    int k;

    if (bounds != NULL) {
        for (k = 0; k < TWO_TANKS_RESIDUALS; ++k) {
            if (!residuals->valid[k] || !is_within(&limits[k], value[k], bounds[k])) {
                return false;
            }
        }
    } else {
        for (k = 0; k < TWO_TANKS_RESIDUALS; ++k) {
            if (!residuals->valid[k] || !is_within(&limits[k], value[k], limits[k].bound)) {
                return false;
            }
        }
    }
    return true;
}

/* Residual k without a value. */
static void blind(two_tanks_diagnosis *d, int k)
{
    forget_sums(d, k);
    if (d->state[k] == TWO_TANKS_ALARM) {
        d->quiet = 0u; /* nobody knows that it is over */
    } else {
        d->state[k] = TWO_TANKS_BLIND;
    }
}

bool two_tanks_diagnose(
    two_tanks_diagnosis *diagnosis,
    const two_tanks_limit *limits,
    const two_tanks_real *bounds,
    const two_tanks_residuals *residuals)
{
    two_tanks_diagnosis *d = diagnosis;
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
    for (k = 0; k < TWO_TANKS_RESIDUALS; ++k) {
        if (residuals->valid[k]) {
            const real bound = bounds ? bounds[k] : limits[k].bound;

            fresh = watch(d, &limits[k], k, residuals->value[k], bound, row) || fresh;
        } else {
            blind(d, k);
        }
        d->calm = d->calm && d->state[k] == TWO_TANKS_HEALTHY && d->streak[k] == 0u;
        alarm = alarm || d->state[k] == TWO_TANKS_ALARM;
    }
    if (fresh) {
        d->quiet = 0u;
        d->settled = 0u;
    }
    if (alarm && !d->latch && d->quiet >= d->hold) {
        two_tanks_clear(d);
        return false;
    }
    if (fresh || (alarm && row)) {
        judge(d);
    }
    return alarm;
}
