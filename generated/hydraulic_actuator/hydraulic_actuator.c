/* hydraulic_actuator.c: the residuals of HydraulicActuator; generated, see the header. */
#include "hydraulic_actuator.h"

#include <math.h>
#include <stddef.h>

#if defined __FINITE_MATH_ONLY__ && __FINITE_MATH_ONLY__
#error "this code tells numbers from NaN: compile it without -ffinite-math-only (-ffast-math)"
#endif

typedef hydraulic_actuator_real real;

#define REAL(x) HYDRAULIC_ACTUATOR_CONSTANT(x)
#if defined HYDRAULIC_ACTUATOR_FLOAT && !defined HYDRAULIC_ACTUATOR_REAL
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
#if defined HYDRAULIC_ACTUATOR_FLOAT && !defined HYDRAULIC_ACTUATOR_REAL
#define SLOWEST REAL(0.0001)
#else
#define SLOWEST REAL(1.0e-09)
#endif

uint32_t hydraulic_actuator_abi(void)
{
    return HYDRAULIC_ACTUATOR_ABI;
}

const char *hydraulic_actuator_digest(void)
{
    return HYDRAULIC_ACTUATOR_DIGEST;
}

void hydraulic_actuator_nominal(hydraulic_actuator_parameters *parameters)
{
    parameters->kv = REAL(3.0e-08);      /* m^3/s.Pa^-0.5 */
    parameters->leak = REAL(1.0e-13);    /* m^3/s/Pa */
    parameters->V = REAL(0.0002);        /* m^3 */
    parameters->B = REAL(1200000000.0);  /* Pa */
    parameters->A = REAL(0.0008);        /* m^2 */
    parameters->m = REAL(25.0);          /* kg */
    parameters->b = REAL(400.0);         /* N.s/m */
}

/* Whether configure may go on with what it is given. */
static hydraulic_actuator_status checked(const hydraulic_actuator_parameters *p, real sample_time, real bandwidth)
{
    const bool finite = finite_number(p->kv + p->leak + p->V + p->B + p->A + p->m + p->b);

    if (!finite) {
        return HYDRAULIC_ACTUATOR_BAD_PARAMETER;
    }
    if (!(sample_time > REAL(0.0)) || !finite_number(sample_time)) {
        return HYDRAULIC_ACTUATOR_BAD_SAMPLE_TIME;
    }
    if (!(bandwidth * sample_time >= SLOWEST && bandwidth * sample_time <= REAL(3.0))) {
        return HYDRAULIC_ACTUATOR_BAD_BANDWIDTH;
    }
    return HYDRAULIC_ACTUATOR_OK;
}

/* Samples until `constants` time constants of the filter are over. */
static uint32_t samples(real constants, real sample_time, real bandwidth)
{
    const real wait = constants / (bandwidth * sample_time);
    const uint32_t whole = wait < REAL(4.0e9) ? (uint32_t)wait : UINT32_MAX - 1u;

    return (real)whole < wait ? whole + 1u : whole;
}

const hydraulic_actuator_coefficients hydraulic_actuator_nominal_coefficients = {
    REAL(1.0e-13),                 /* r1_p */
    REAL(0.0008),                  /* r1_v */
    REAL(3.0e-08),                 /* r1_product */
    REAL(3.3333333333333364e-12),  /* r1_w1_p */
    REAL(3.3333333333333396e-05),  /* bend1 */
    REAL(0.9801980198019802),      /* a */
    REAL(0.00990099009900991),     /* b */
    REAL(400.0),                   /* r2_v */
    REAL(500.00000000000045),      /* r2_w1_v */
    {462u, 462u},                  /* samples until each is valid */
    462u                           /* the longest of these */
};

/* The coefficients, from the parameters. */
static void compute_coefficients(hydraulic_actuator_coefficients *c,
        const hydraulic_actuator_parameters *p, real sample_time, real bandwidth)
{
    /* bandwidth*sample_time */
    const real x_ = bandwidth * sample_time;

    /* of a stage: what is left of its memory */
    const real pole = greatest(REAL(2.0) - x_, REAL(0.0)) / (x_ + REAL(2.0));

    /* w*sample_time, x or 2 */
    const real turn = REAL(2.0) * (REAL(1.0) - pole) / (pole + REAL(1.0));

    /* w of the filter 1/(1 + D/w) */
    const real w = turn / sample_time;

    /* hydraulic_actuator.bg:18: r1: factor of p: leak */
    c->r1_p = p->leak;

    /* r1: factor of v: A */
    c->r1_v = p->A;

    /* r1: factor of spool*ssqrt(ps - p): kv */
    c->r1_product = p->kv;

    /* r1: factor of p' */
    c->r1_w1_p = p->V * w / p->B;

    /* filter: 1 * (w*sample_time)^2/12 */
    c->bend1 = turn * turn / REAL(12.0);

    /* filter: what is left of a memory a sample later */
    c->a = pole;

    /* filter: weight of a sample, new and a sample later */
    c->b = REAL(0.5) * (REAL(1.0) - pole);

    /* hydraulic_actuator.bg:18: r2: factor of v: b */
    c->r2_v = p->b;

    /* r2: factor of v' */
    c->r2_w1_v = p->m * w;
}

static bool coefficients_are_finite(const hydraulic_actuator_coefficients *c)
{
    return finite_number(c->r1_p + c->r1_v + c->r1_product + c->r1_w1_p + c->bend1 + c->a + c->b
            + c->r2_v + c->r2_w1_v);
}

hydraulic_actuator_status hydraulic_actuator_configure(
    hydraulic_actuator_coefficients *coefficients,
    const hydraulic_actuator_parameters *parameters,
    hydraulic_actuator_real sample_time,
    hydraulic_actuator_real bandwidth)
{
    hydraulic_actuator_coefficients *c = coefficients;
    const hydraulic_actuator_status status = checked(parameters, sample_time, bandwidth);
    int k;

    for (k = 0; k < HYDRAULIC_ACTUATOR_RESIDUALS; ++k) {
        c->settle[k] = UINT32_MAX;
    }
    c->longest = UINT32_MAX;
    if (status != HYDRAULIC_ACTUATOR_OK) {
        return status;
    }
    compute_coefficients(c, parameters, sample_time, bandwidth);
    if (!coefficients_are_finite(c)) {
        return HYDRAULIC_ACTUATOR_BAD_COEFFICIENT;
    }
    c->settle[HYDRAULIC_ACTUATOR_R1] = samples(REAL(9.233413476451586), sample_time, bandwidth);
    c->settle[HYDRAULIC_ACTUATOR_R2] = samples(REAL(9.233413476451586), sample_time, bandwidth);
    c->longest = c->settle[HYDRAULIC_ACTUATOR_R1];
    return HYDRAULIC_ACTUATOR_OK;
}

/* r1 on one sample.
 * hydraulic_actuator.bg:18: r1 = spool*kv*ssqrt(ps - p) - leak*p - A*v - V*D(p)/B */
static void run_r1(
    const hydraulic_actuator_coefficients *c, hydraulic_actuator_memory *x, const hydraulic_actuator_samples *s, real *r)
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

    /* spool*ssqrt(ps - p) */
    const real product = s->spool * signed_root(s->ps - s->p);

    /* terms of order 0 */
    const real g0 = c->r1_product * product - c->r1_p * s->p - c->r1_v * s->v;

    /* degree 1 */
    const real d1 = c->r1_w1_p * s->p;

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

    r[HYDRAULIC_ACTUATOR_R1] = y1 - e0;
}

/* r2 on one sample.
 * hydraulic_actuator.bg:18: r2 = load + b*v + m*D(v) - A*p */
static void run_r2(
    const hydraulic_actuator_coefficients *c, hydraulic_actuator_memory *x, const hydraulic_actuator_samples *s, real *r)
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

    /* terms of order 0 */
    const real g0 = s->load + c->r2_v * s->v - c->r1_v * s->p;

    /* degree 1 */
    const real d1 = c->r2_w1_v * s->v;

    /* error of order 0 */
    const real e0 = c->bend1 * g0;

    /* the filter multiplied out */
    const real p1_1 = d1 + e0;

    /* stage 2 */
    const real u2 = g0 - p1_1;
    const real y2 = x->r2_s2 + b * u2;
    x->r2_s2 = a * y2 + b * u2;

    /* stage 1 */
    const real u1 = y2 + p1_1 + e0;
    const real y1 = x->r2_s1 + b * u1;
    x->r2_s1 = a * y1 + b * u1;

    r[HYDRAULIC_ACTUATOR_R2] = y1 - e0;
}

/* Ages and validity one by one: a number that is not finite makes the next sample the first. */
static void count_samples(
    const hydraulic_actuator_coefficients *c,
    hydraulic_actuator_memory *x,
    const hydraulic_actuator_samples *s,
    hydraulic_actuator_residuals *out)
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

    finite[0] = finite_number(s->ps);
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

void hydraulic_actuator_reset(hydraulic_actuator_memory *memory)
{
    int k;

    for (k = 0; k < 2; ++k) {
        memory->age[k] = 0u;
    }
    memory->youngest = 0u;
}

void hydraulic_actuator_step(
    const hydraulic_actuator_coefficients *coefficients,
    hydraulic_actuator_memory *memory,
    const hydraulic_actuator_samples *samples,
    hydraulic_actuator_residuals *residuals)
{
    const hydraulic_actuator_coefficients *c = coefficients;
    hydraulic_actuator_memory *x = memory;
    const hydraulic_actuator_samples *s = samples;
    real *r = residuals->value;
    int k;

    run_r1(c, x, s, r);
    run_r2(c, x, s, r);
    /* a sum is finite only if all its terms are */
    if (x->youngest > c->longest
            && finite_number(r[HYDRAULIC_ACTUATOR_R1] + r[HYDRAULIC_ACTUATOR_R2] + s->ps)) {
        for (k = 0; k < HYDRAULIC_ACTUATOR_RESIDUALS; ++k) {
            residuals->valid[k] = true;
        }
    } else {
        count_samples(c, x, s, residuals);
    }
}

#ifndef HYDRAULIC_ACTUATOR_NO_THRESHOLDS

const hydraulic_actuator_threshold_coefficients hydraulic_actuator_threshold_nominal_coefficients = {
    REAL(1.4999999999999998e-09),  /* r1_w1_product */
    REAL(0.9801980198019802),      /* a */
    REAL(0.00990099009900991),     /* b */
    REAL(80.0),                    /* r2_w1_v */
    {462u, 462u},                  /* samples until each is valid */
    462u                           /* the longest of these */
};

/* The coefficients, from the parameters. */
static void bound_compute_coefficients(hydraulic_actuator_threshold_coefficients *c,
        const hydraulic_actuator_parameters *p, real sample_time, real bandwidth)
{
    /* bandwidth*sample_time */
    const real x_ = bandwidth * sample_time;

    /* of a stage: what is left of its memory */
    const real pole = greatest(REAL(2.0) - x_, REAL(0.0)) / (x_ + REAL(2.0));

    /* hydraulic_actuator.bg:18: r1_w1: factor of spool*ssqrt(ps - p) */
    c->r1_w1_product = p->kv / REAL(20.0);

    /* filter: what is left of a memory a sample later */
    c->a = pole;

    /* filter: weight of a sample, new and a sample later */
    c->b = REAL(0.5) * (REAL(1.0) - pole);

    /* hydraulic_actuator.bg:18: r2_w1: factor of v */
    c->r2_w1_v = p->b / REAL(5.0);
}

static bool bound_coefficients_are_finite(const hydraulic_actuator_threshold_coefficients *c)
{
    return finite_number(c->r1_w1_product + c->a + c->b + c->r2_w1_v);
}

hydraulic_actuator_status hydraulic_actuator_threshold_configure(
    hydraulic_actuator_threshold_coefficients *coefficients,
    const hydraulic_actuator_parameters *parameters,
    hydraulic_actuator_real sample_time,
    hydraulic_actuator_real bandwidth)
{
    hydraulic_actuator_threshold_coefficients *c = coefficients;
    const hydraulic_actuator_status status = checked(parameters, sample_time, bandwidth);
    int k;

    for (k = 0; k < HYDRAULIC_ACTUATOR_RESIDUALS; ++k) {
        c->settle[k] = UINT32_MAX;
    }
    c->longest = UINT32_MAX;
    if (status != HYDRAULIC_ACTUATOR_OK) {
        return status;
    }
    bound_compute_coefficients(c, parameters, sample_time, bandwidth);
    if (!bound_coefficients_are_finite(c)) {
        return HYDRAULIC_ACTUATOR_BAD_COEFFICIENT;
    }
    c->settle[HYDRAULIC_ACTUATOR_R1] = samples(REAL(9.233413476451586), sample_time, bandwidth);
    c->settle[HYDRAULIC_ACTUATOR_R2] = samples(REAL(9.233413476451586), sample_time, bandwidth);
    c->longest = c->settle[HYDRAULIC_ACTUATOR_R1];
    return HYDRAULIC_ACTUATOR_OK;
}

/* r1 on one sample.
 * hydraulic_actuator.bg:18: r1: how far r1 can be from zero if no parameter is out of tolerance */
static void bound_r1(
    const hydraulic_actuator_threshold_coefficients *c, hydraulic_actuator_threshold_memory *x, const hydraulic_actuator_samples *s, real *r)
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

    /* spool*ssqrt(ps - p) */
    const real w1_product = s->spool * signed_root(s->ps - s->p);

    /* r1_w1: stage 2 */
    const real w1_u2 = c->r1_w1_product * w1_product;
    const real w1_y2 = x->r1_w1_s2 + w1_b * w1_u2;
    x->r1_w1_s2 = w1_a * w1_y2 + w1_b * w1_u2;

    /* r1_w1: stage 1 */
    const real w1_u1 = w1_y2;
    const real w1_y1 = x->r1_w1_s1 + w1_b * w1_u1;
    x->r1_w1_s1 = w1_a * w1_y1 + w1_b * w1_u1;

    /* what the tolerance of kv can do */
    const real w1 = w1_y1;

    r[HYDRAULIC_ACTUATOR_R1] = MATH(fabs)(w1);
}

/* r2 on one sample.
 * hydraulic_actuator.bg:18: r2: how far r2 can be from zero if no parameter is out of tolerance */
static void bound_r2(
    const hydraulic_actuator_threshold_coefficients *c, hydraulic_actuator_threshold_memory *x, const hydraulic_actuator_samples *s, real *r)
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

    /* r2_w1: stage 2 */
    const real w1_u2 = c->r2_w1_v * s->v;
    const real w1_y2 = x->r2_w1_s2 + w1_b * w1_u2;
    x->r2_w1_s2 = w1_a * w1_y2 + w1_b * w1_u2;

    /* r2_w1: stage 1 */
    const real w1_u1 = w1_y2;
    const real w1_y1 = x->r2_w1_s1 + w1_b * w1_u1;
    x->r2_w1_s1 = w1_a * w1_y1 + w1_b * w1_u1;

    /* what the tolerance of b can do */
    const real w1 = w1_y1;

    r[HYDRAULIC_ACTUATOR_R2] = MATH(fabs)(w1);
}

/* Ages and validity one by one: a number that is not finite makes the next sample the first. */
static void bound_count_samples(
    const hydraulic_actuator_threshold_coefficients *c,
    hydraulic_actuator_threshold_memory *x,
    const hydraulic_actuator_samples *s,
    hydraulic_actuator_residuals *out)
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

    finite[0] = finite_number(s->ps + s->p);
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

void hydraulic_actuator_threshold_reset(hydraulic_actuator_threshold_memory *memory)
{
    int k;

    for (k = 0; k < 2; ++k) {
        memory->age[k] = 0u;
    }
    memory->youngest = 0u;
}

void hydraulic_actuator_threshold_step(
    const hydraulic_actuator_threshold_coefficients *coefficients,
    hydraulic_actuator_threshold_memory *memory,
    const hydraulic_actuator_samples *samples,
    hydraulic_actuator_residuals *thresholds)
{
    const hydraulic_actuator_threshold_coefficients *c = coefficients;
    hydraulic_actuator_threshold_memory *x = memory;
    const hydraulic_actuator_samples *s = samples;
    real *r = thresholds->value;
    int k;

    bound_r1(c, x, s, r);
    bound_r2(c, x, s, r);
    /* a sum is finite only if all its terms are */
    if (x->youngest > c->longest
            && finite_number(r[HYDRAULIC_ACTUATOR_R1] + r[HYDRAULIC_ACTUATOR_R2] + s->ps + s->p)) {
        for (k = 0; k < HYDRAULIC_ACTUATOR_RESIDUALS; ++k) {
            thresholds->valid[k] = true;
        }
    } else {
        bound_count_samples(c, x, s, thresholds);
    }
}

#endif

const char hydraulic_actuator_fault_name[HYDRAULIC_ACTUATOR_FAULTS][6] = {
    "kv", "leak", "V", "B", "ps", "spool", "A", "p", "v", "m", "b", "load",
};

const uint16_t hydraulic_actuator_fault_class[HYDRAULIC_ACTUATOR_FAULTS] = {
    0u, 0u, 0u, 0u, 0u, 0u, 1u, 1u, 1u, 2u, 2u, 2u,
};

const char hydraulic_actuator_residual_name[HYDRAULIC_ACTUATOR_RESIDUALS][3] = {
    "r1", "r2",
};

/*
 * Signatures: the faults of class c are seen by the residuals of entries first_entry[c] and up to
 * first_entry[c + 1].
 */
static const uint32_t first_entry[HYDRAULIC_ACTUATOR_CLASSES + 1] = {
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
    hydraulic_actuator_diagnosis *d, const hydraulic_actuator_limit *limit, int k, real out, real bound)
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
static int size_of(const hydraulic_actuator_diagnosis *d, int c, int alarms)
{
    const uint32_t begin = first_entry[c];
    const uint32_t end = first_entry[c + 1];
    int size = 0;
    int seen = 0;
    uint32_t i;

    for (i = begin; i < end; ++i) {
        const int k = (int)seen_by[i];

        if (d->state[k] == HYDRAULIC_ACTUATOR_ALARM) {
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
static hydraulic_actuator_candidate left_of(const hydraulic_actuator_diagnosis *d, int c, int alarms)
{
    const uint32_t begin = first_entry[c];
    const uint32_t end = first_entry[c + 1];
    const int size = size_of(d, c, alarms);
    uint32_t i;

    if (size < 0) {
        return HYDRAULIC_ACTUATOR_RULED_OUT;
    }
    if (d->settled < d->window) {
        return HYDRAULIC_ACTUATOR_LIKELY; /* too soon for what is quiet to say anything */
    }
    for (i = begin; i < end; ++i) {
        const int k = (int)seen_by[i];
        const int sure = (int)sure_size[i];

        if (d->state[k] == HYDRAULIC_ACTUATOR_HEALTHY && sure != 255 && sure <= size) {
            return HYDRAULIC_ACTUATOR_SMALL;
        }
    }
    return HYDRAULIC_ACTUATOR_LIKELY;
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
    hydraulic_actuator_diagnosis *d, const hydraulic_actuator_limit *limit, int k, real off, real out, real bound)
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

static bool sums_are_zero(const hydraulic_actuator_diagnosis *d, int k)
{
    const real sum = d->above[k] + d->below[k] + d->louder[k];

    return !(sum > REAL(0.0));
}

static void forget_sums(hydraulic_actuator_diagnosis *d, int k)
{
    d->above[k] = REAL(0.0);
    d->below[k] = REAL(0.0);
    d->louder[k] = REAL(0.0);
    d->streak[k] = 0u;
}

/* How far a residual is beyond its bound; off: from its mean. */
static real excess(real off, real bound)
{
#if defined __GNUC__ && !defined HYDRAULIC_ACTUATOR_REAL
    return MATH(__builtin_fabs)(off) - bound; /* one instruction, no library */
#else
    return (off < REAL(0.0) ? -off : off) - bound;
#endif
}

static bool is_within(const hydraulic_actuator_limit *limit, real value, real bound)
{
    return excess(value - limit->mean, bound) <= limit->level;
}

/* Residual k in one sample; whether it goes into alarm. */
static bool watch(
    hydraulic_actuator_diagnosis *d, const hydraulic_actuator_limit *limit, int k, real value, real bound, bool row)
{
    const real off = value - limit->mean;
    const real out = excess(off, bound);
    bool high = false;

    if (row) {
        high = add_row(d, limit, k, off, out, bound);
    }
    if (d->state[k] == HYDRAULIC_ACTUATOR_ALARM) {
        d->since[k] += d->since[k] < UINT32_MAX ? 1u : 0u;
        remember_peak(d, limit, k, out, bound);
        if (!(out < RELEASE * limit->level) || !sums_are_zero(d, k)) {
            d->quiet = 0u;
        }
        return false;
    }
    d->state[k] = HYDRAULIC_ACTUATOR_HEALTHY;
    d->streak[k] = out > limit->level ? d->streak[k] + 1u : 0u;
    if (d->streak[k] < d->least && !high) {
        return false;
    }
    d->state[k] = HYDRAULIC_ACTUATOR_ALARM;
    d->since[k] = 0u;
    d->peak[k] = REAL(0.0);
    remember_peak(d, limit, k, out, bound);
    return true;
}

/* Which classes of faults the residuals leave, and the one if it is one. */
static void judge(hydraulic_actuator_diagnosis *d)
{
    int likely = 0;
    int alarms = 0;
    int c;
    int k;

    for (k = 0; k < HYDRAULIC_ACTUATOR_RESIDUALS; ++k) {
        alarms += d->state[k] == HYDRAULIC_ACTUATOR_ALARM ? 1 : 0;
    }
    d->fault_class = HYDRAULIC_ACTUATOR_UNKNOWN;
    for (c = 0; c < HYDRAULIC_ACTUATOR_CLASSES; ++c) {
        const hydraulic_actuator_candidate left = left_of(d, c, alarms);

        d->candidate[c] = (uint8_t)left;
        if (left == HYDRAULIC_ACTUATOR_LIKELY) {
            d->fault_class = (int16_t)c;
            ++likely;
        }
    }
    if (likely != 1 || d->settled < 2u * d->row) {
        d->fault_class = HYDRAULIC_ACTUATOR_UNKNOWN;
    }
}

hydraulic_actuator_limit hydraulic_actuator_limit_of(hydraulic_actuator_real level)
{
    hydraulic_actuator_limit limit;

    limit.mean = REAL(0.0);
    limit.level = level;
    limit.unit = REAL(0.0);
    limit.loud = REAL(0.0);
    limit.drift = REAL(0.5);
    limit.height = NEVER;
    limit.bound = REAL(0.0);
    return limit;
}

void hydraulic_actuator_clear(hydraulic_actuator_diagnosis *diagnosis)
{
    int k;

    for (k = 0; k < HYDRAULIC_ACTUATOR_RESIDUALS; ++k) {
        if (diagnosis->state[k] == HYDRAULIC_ACTUATOR_ALARM) {
            diagnosis->state[k] = HYDRAULIC_ACTUATOR_HEALTHY;
        }
        diagnosis->since[k] = 0u;
        diagnosis->peak[k] = REAL(0.0);
        forget_sums(diagnosis, k);
    }
    for (k = 0; k < HYDRAULIC_ACTUATOR_CLASSES; ++k) {
        diagnosis->candidate[k] = HYDRAULIC_ACTUATOR_RULED_OUT;
    }
    diagnosis->fault_class = HYDRAULIC_ACTUATOR_UNKNOWN;
    diagnosis->quiet = 0u;
    diagnosis->settled = 0u;
    diagnosis->calm = false;
}

void hydraulic_actuator_diagnosis_reset(hydraulic_actuator_diagnosis *diagnosis)
{
    int k;

    diagnosis->row = HYDRAULIC_ACTUATOR_ROW;
    diagnosis->least = 15u;
    diagnosis->hold = 10u * HYDRAULIC_ACTUATOR_ROW;
    diagnosis->window = 300u;
    diagnosis->latch = false;
    diagnosis->tick = 0u;
    for (k = 0; k < HYDRAULIC_ACTUATOR_RESIDUALS; ++k) {
        diagnosis->state[k] = HYDRAULIC_ACTUATOR_BLIND;
    }
    hydraulic_actuator_clear(diagnosis);
}

/* Whether each residual has a value within its level: nearly all samples are so. */
static bool all_within(
    const hydraulic_actuator_limit *limits, const real *bounds, const hydraulic_actuator_residuals *residuals)
{
    const real *value = residuals->value;
    int k;

    if (bounds != NULL) {
        for (k = 0; k < HYDRAULIC_ACTUATOR_RESIDUALS; ++k) {
            if (!residuals->valid[k] || !is_within(&limits[k], value[k], bounds[k])) {
                return false;
            }
        }
    } else {
        for (k = 0; k < HYDRAULIC_ACTUATOR_RESIDUALS; ++k) {
            if (!residuals->valid[k] || !is_within(&limits[k], value[k], limits[k].bound)) {
                return false;
            }
        }
    }
    return true;
}

/* Residual k without a value. */
static void blind(hydraulic_actuator_diagnosis *d, int k)
{
    forget_sums(d, k);
    if (d->state[k] == HYDRAULIC_ACTUATOR_ALARM) {
        d->quiet = 0u; /* nobody knows that it is over */
    } else {
        d->state[k] = HYDRAULIC_ACTUATOR_BLIND;
    }
}

bool hydraulic_actuator_diagnose(
    hydraulic_actuator_diagnosis *diagnosis,
    const hydraulic_actuator_limit *limits,
    const hydraulic_actuator_real *bounds,
    const hydraulic_actuator_residuals *residuals)
{
    hydraulic_actuator_diagnosis *d = diagnosis;
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
    for (k = 0; k < HYDRAULIC_ACTUATOR_RESIDUALS; ++k) {
        if (residuals->valid[k]) {
            const real bound = bounds ? bounds[k] : limits[k].bound;

            fresh = watch(d, &limits[k], k, residuals->value[k], bound, row) || fresh;
        } else {
            blind(d, k);
        }
        d->calm = d->calm && d->state[k] == HYDRAULIC_ACTUATOR_HEALTHY && d->streak[k] == 0u;
        alarm = alarm || d->state[k] == HYDRAULIC_ACTUATOR_ALARM;
    }
    if (fresh) {
        d->quiet = 0u;
        d->settled = 0u;
    }
    if (alarm && !d->latch && d->quiet >= d->hold) {
        hydraulic_actuator_clear(d);
        return false;
    }
    if (fresh || (alarm && row)) {
        judge(d);
    }
    return alarm;
}
