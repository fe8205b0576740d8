/* hydraulic_actuator_residuals.c: the residuals of HydraulicActuator; generated, see the header. */
#include "hydraulic_actuator_residuals.h"

#include <math.h>

#if defined __FINITE_MATH_ONLY__ && __FINITE_MATH_ONLY__
#error "this code tells numbers from NaN: compile it without -ffinite-math-only (-ffast-math)"
#endif

typedef hydraulic_actuator_real real;

#define REAL(x) HYDRAULIC_ACTUATOR_CONSTANT(x)
#if defined HYDRAULIC_ACTUATOR_FLOAT && !defined HYDRAULIC_ACTUATOR_REAL
#define SLOWEST REAL(0.0001)
#define MATH(name) name##f
#else
#define SLOWEST REAL(1.0e-09)
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

/* The coefficients of exact and of the filter, from the parameters. */
static void compute_coefficients(hydraulic_actuator_monitor *monitor,
        const hydraulic_actuator_parameters *p, real sample_time, real bandwidth)
{
    hydraulic_actuator_coefficients *c = &monitor->c;

    /* bandwidth*sample_time */
    const real x_ = bandwidth * sample_time;

    /* of a stage: what is left of its memory */
    const real pole = greatest(REAL(2.0) - x_, REAL(0.0)) / (x_ + REAL(2.0));

    /* w*sample_time, x or 2 */
    const real turn = REAL(2.0) * (REAL(1.0) - pole) / (pole + REAL(1.0));

    /* w of the filter 1/(1 + D/w) */
    const real w = turn / sample_time;

    /* 1 - pole */
    const real t = REAL(1.0) - pole;

    /* hydraulic_actuator.bg:18: r1: factor of p: leak */
    c->r1_p = p->leak;

    /* hydraulic_actuator.bg:18: r1: factor of p': V/B */
    c->r1_p_1 = p->V / p->B;

    /* hydraulic_actuator.bg:18: r1: factor of v: A */
    c->r1_v = p->A;

    /* hydraulic_actuator.bg:18: r1: factor of spool*ssqrt(ps - p): kv */
    c->r1_product = p->kv;

    /* hydraulic_actuator.bg:18: r1: factor of p' */
    c->r1_w1_p = p->V * w / p->B;

    /* filter: 1 * (w*sample_time)^2/12 */
    c->bend1 = turn * turn / REAL(12.0);

    /* filter: what is left of a memory a sample later */
    c->a = pole;

    /* filter: weight of a sample, new and a sample later */
    c->b = REAL(0.5) * t;

    /* filter: 1 - b, the memory of a constant 1 */
    c->rest = REAL(1.0) - REAL(0.5) * t;

    /* hydraulic_actuator.bg:18: r2: factor of v: b */
    c->r2_v = p->b;

    /* hydraulic_actuator.bg:18: r2: factor of v': m */
    c->r2_v_1 = p->m;

    /* hydraulic_actuator.bg:18: r2: factor of v' */
    c->r2_w1_v = p->m * w;
}

static bool parameters_are_finite(const hydraulic_actuator_parameters *p)
{
    return finite_number(p->kv + p->leak + p->V + p->B + p->A + p->m + p->b);
}

static bool coefficients_are_finite(const hydraulic_actuator_monitor *monitor)
{
    return finite_number(monitor->c.r1_p + monitor->c.r1_p_1 + monitor->c.r1_v
            + monitor->c.r1_product + monitor->c.r1_w1_p + monitor->c.bend1 + monitor->c.a
            + monitor->c.b + monitor->c.rest + monitor->c.r2_v + monitor->c.r2_v_1
            + monitor->c.r2_w1_v);
}

/* Samples until `constants` time constants of the filter are over. */
static uint32_t samples(real constants, real sample_time, real bandwidth)
{
    const real wait = constants / (bandwidth * sample_time);
    const uint32_t whole = wait < REAL(4.0e9) ? (uint32_t)wait : UINT32_MAX - 1u;

    return (real)whole < wait ? whole + 1u : whole;
}

hydraulic_actuator_status hydraulic_actuator_configure(
    hydraulic_actuator_monitor *monitor,
    const hydraulic_actuator_parameters *parameters,
    hydraulic_actuator_real sample_time,
    hydraulic_actuator_real bandwidth,
    hydraulic_actuator_real time_unit)
{
    int k;

    for (k = 0; k < HYDRAULIC_ACTUATOR_RESIDUALS; ++k) {
        monitor->settle[k] = UINT32_MAX;
    }
    hydraulic_actuator_reset(monitor);
    if (!parameters_are_finite(parameters)) {
        return HYDRAULIC_ACTUATOR_BAD_PARAMETER;
    }
    if (!(sample_time > REAL(0.0)) || !finite_number(sample_time)) {
        return HYDRAULIC_ACTUATOR_BAD_SAMPLE_TIME;
    }
    if (!(bandwidth * sample_time >= SLOWEST && bandwidth * sample_time <= REAL(3.0))) {
        return HYDRAULIC_ACTUATOR_BAD_BANDWIDTH;
    }
    if (!(time_unit > REAL(0.0)) || !finite_number(time_unit)) {
        return HYDRAULIC_ACTUATOR_BAD_TIME_UNIT;
    }
    compute_coefficients(monitor, parameters, sample_time, bandwidth);
    if (!coefficients_are_finite(monitor)) {
        return HYDRAULIC_ACTUATOR_BAD_COEFFICIENT;
    }
    monitor->settle[HYDRAULIC_ACTUATOR_R1] =
        samples(REAL(9.233413476451586), sample_time, bandwidth);
    monitor->settle[HYDRAULIC_ACTUATOR_R2] =
        samples(REAL(9.233413476451586), sample_time, bandwidth);
    return HYDRAULIC_ACTUATOR_OK;
}

void hydraulic_actuator_exact(
    const hydraulic_actuator_monitor *monitor,
    const hydraulic_actuator_derivatives *derivatives,
    hydraulic_actuator_real residuals[HYDRAULIC_ACTUATOR_RESIDUALS])
{
    const hydraulic_actuator_coefficients *c = &monitor->c;
    const hydraulic_actuator_derivatives *d = derivatives;
    real *r = residuals;

    /* hydraulic_actuator.bg:18: r1 = spool*kv*ssqrt(ps - p) - leak*p - A*v - V*D(p)/B */
    r[HYDRAULIC_ACTUATOR_R1] = c->r1_product * (d->spool * signed_root(d->ps - d->p[0]))
        - c->r1_p * d->p[0] - c->r1_p_1 * d->p[1] - c->r1_v * d->v[0];

    /* hydraulic_actuator.bg:18: r2 = load + b*v + m*D(v) - A*p */
    r[HYDRAULIC_ACTUATOR_R2] = d->load + c->r2_v * d->v[0] + c->r2_v_1 * d->v[1]
        - c->r1_v * d->p[0];
}

/* r1 on its first sample: the filter as if it had always been so. */
static void start_r1(
    hydraulic_actuator_monitor *monitor, const hydraulic_actuator_samples *s, real *r)
{
    const hydraulic_actuator_coefficients *c = &monitor->c;
    hydraulic_actuator_memory *x = &monitor->x;

    /* hydraulic_actuator.bg:18: spool*ssqrt(ps - p) */
    const real r1_product = s->spool * signed_root(s->ps - s->p);

    /* hydraulic_actuator.bg:18: r1: terms of order 0 */
    const real r1_g0 = c->r1_product * r1_product - c->r1_p * s->p - c->r1_v * s->v;

    /* hydraulic_actuator.bg:18: r1: degree 1 */
    const real r1_d1 = c->r1_w1_p * s->p;

    /* hydraulic_actuator.bg:18: r1: error of order 0 */
    const real r1_e0 = c->bend1 * r1_g0;

    /* hydraulic_actuator.bg:18: r1: input of stage 2 */
    const real r1_u2 = r1_g0 + r1_d1 - r1_e0;

    /* hydraulic_actuator.bg:18: r1: stage 2, at rest */
    const real r1_y2 = r1_u2;

    /* hydraulic_actuator.bg:18: r1: stage 2: memory */
    x->r1_s2 = c->rest * r1_u2;

    /* hydraulic_actuator.bg:18: r1: input of stage 1 */
    const real r1_u1 = r1_y2 + REAL(2.0) * r1_e0 - r1_d1;

    /* hydraulic_actuator.bg:18: r1: stage 1, at rest */
    const real r1_y1 = r1_u1;

    /* hydraulic_actuator.bg:18: r1: stage 1: memory */
    x->r1_s1 = c->rest * r1_u1;

    /* hydraulic_actuator.bg:18: r1 = spool*kv*ssqrt(ps - p) - leak*p - A*v - V*D(p)/B */
    r[HYDRAULIC_ACTUATOR_R1] = r1_y1 - r1_e0;
}

/* r1 on every further sample. */
static void next_r1(
    hydraulic_actuator_monitor *monitor, const hydraulic_actuator_samples *s, real *r)
{
    const hydraulic_actuator_coefficients *c = &monitor->c;
    hydraulic_actuator_memory *x = &monitor->x;

    /* hydraulic_actuator.bg:18: spool*ssqrt(ps - p) */
    const real r1_product = s->spool * signed_root(s->ps - s->p);

    /* hydraulic_actuator.bg:18: r1: terms of order 0 */
    const real r1_g0 = c->r1_product * r1_product - c->r1_p * s->p - c->r1_v * s->v;

    /* hydraulic_actuator.bg:18: r1: degree 1 */
    const real r1_d1 = c->r1_w1_p * s->p;

    /* hydraulic_actuator.bg:18: r1: error of order 0 */
    const real r1_e0 = c->bend1 * r1_g0;

    /* hydraulic_actuator.bg:18: r1: input of stage 2 */
    const real r1_u2 = r1_g0 + r1_d1 - r1_e0;

    /* hydraulic_actuator.bg:18: r1: stage 2 */
    const real r1_y2 = x->r1_s2 + c->b * r1_u2;

    /* hydraulic_actuator.bg:18: r1: stage 2: memory */
    x->r1_s2 = c->a * r1_y2 + c->b * r1_u2;

    /* hydraulic_actuator.bg:18: r1: input of stage 1 */
    const real r1_u1 = r1_y2 + REAL(2.0) * r1_e0 - r1_d1;

    /* hydraulic_actuator.bg:18: r1: stage 1 */
    const real r1_y1 = x->r1_s1 + c->b * r1_u1;

    /* hydraulic_actuator.bg:18: r1: stage 1: memory */
    x->r1_s1 = c->a * r1_y1 + c->b * r1_u1;

    /* hydraulic_actuator.bg:18: r1 = spool*kv*ssqrt(ps - p) - leak*p - A*v - V*D(p)/B */
    r[HYDRAULIC_ACTUATOR_R1] = r1_y1 - r1_e0;
}

/* One sample for r1; a number that is not finite makes the next sample the first. */
static void run_r1(
    hydraulic_actuator_monitor *monitor, const hydraulic_actuator_samples *s, hydraulic_actuator_residuals *residuals)
{
    real *r = residuals->value;
    uint32_t age = monitor->age[0];

    if (age == 0u) {
        start_r1(monitor, s, r);
    } else {
        next_r1(monitor, s, r);
    }
    /* a sum is finite only if all its terms are */
    if (finite_number(s->ps + s->spool + s->p + s->v + r[HYDRAULIC_ACTUATOR_R1])) {
        age += age < UINT32_MAX ? 1u : 0u;
    } else {
        age = 0u;
        r[HYDRAULIC_ACTUATOR_R1] = REAL(0.0);
    }
    monitor->age[0] = age;
    residuals->valid[HYDRAULIC_ACTUATOR_R1] = age > monitor->settle[HYDRAULIC_ACTUATOR_R1];
}

/* r2 on its first sample: the filter as if it had always been so. */
static void start_r2(
    hydraulic_actuator_monitor *monitor, const hydraulic_actuator_samples *s, real *r)
{
    const hydraulic_actuator_coefficients *c = &monitor->c;
    hydraulic_actuator_memory *x = &monitor->x;

    /* hydraulic_actuator.bg:18: r2: terms of order 0 */
    const real r2_g0 = s->load + c->r2_v * s->v - c->r1_v * s->p;

    /* hydraulic_actuator.bg:18: r2: degree 1 */
    const real r2_d1 = c->r2_w1_v * s->v;

    /* hydraulic_actuator.bg:18: r2: error of order 0 */
    const real r2_e0 = c->bend1 * r2_g0;

    /* hydraulic_actuator.bg:18: r2: input of stage 2 */
    const real r2_u2 = r2_g0 - r2_d1 - r2_e0;

    /* hydraulic_actuator.bg:18: r2: stage 2, at rest */
    const real r2_y2 = r2_u2;

    /* hydraulic_actuator.bg:18: r2: stage 2: memory */
    x->r2_s2 = c->rest * r2_u2;

    /* hydraulic_actuator.bg:18: r2: input of stage 1 */
    const real r2_u1 = r2_y2 + r2_d1 + REAL(2.0) * r2_e0;

    /* hydraulic_actuator.bg:18: r2: stage 1, at rest */
    const real r2_y1 = r2_u1;

    /* hydraulic_actuator.bg:18: r2: stage 1: memory */
    x->r2_s1 = c->rest * r2_u1;

    /* hydraulic_actuator.bg:18: r2 = load + b*v + m*D(v) - A*p */
    r[HYDRAULIC_ACTUATOR_R2] = r2_y1 - r2_e0;
}

/* r2 on every further sample. */
static void next_r2(
    hydraulic_actuator_monitor *monitor, const hydraulic_actuator_samples *s, real *r)
{
    const hydraulic_actuator_coefficients *c = &monitor->c;
    hydraulic_actuator_memory *x = &monitor->x;

    /* hydraulic_actuator.bg:18: r2: terms of order 0 */
    const real r2_g0 = s->load + c->r2_v * s->v - c->r1_v * s->p;

    /* hydraulic_actuator.bg:18: r2: degree 1 */
    const real r2_d1 = c->r2_w1_v * s->v;

    /* hydraulic_actuator.bg:18: r2: error of order 0 */
    const real r2_e0 = c->bend1 * r2_g0;

    /* hydraulic_actuator.bg:18: r2: input of stage 2 */
    const real r2_u2 = r2_g0 - r2_d1 - r2_e0;

    /* hydraulic_actuator.bg:18: r2: stage 2 */
    const real r2_y2 = x->r2_s2 + c->b * r2_u2;

    /* hydraulic_actuator.bg:18: r2: stage 2: memory */
    x->r2_s2 = c->a * r2_y2 + c->b * r2_u2;

    /* hydraulic_actuator.bg:18: r2: input of stage 1 */
    const real r2_u1 = r2_y2 + r2_d1 + REAL(2.0) * r2_e0;

    /* hydraulic_actuator.bg:18: r2: stage 1 */
    const real r2_y1 = x->r2_s1 + c->b * r2_u1;

    /* hydraulic_actuator.bg:18: r2: stage 1: memory */
    x->r2_s1 = c->a * r2_y1 + c->b * r2_u1;

    /* hydraulic_actuator.bg:18: r2 = load + b*v + m*D(v) - A*p */
    r[HYDRAULIC_ACTUATOR_R2] = r2_y1 - r2_e0;
}

/* One sample for r2; a number that is not finite makes the next sample the first. */
static void run_r2(
    hydraulic_actuator_monitor *monitor, const hydraulic_actuator_samples *s, hydraulic_actuator_residuals *residuals)
{
    real *r = residuals->value;
    uint32_t age = monitor->age[1];

    if (age == 0u) {
        start_r2(monitor, s, r);
    } else {
        next_r2(monitor, s, r);
    }
    /* a sum is finite only if all its terms are */
    if (finite_number(s->load + s->p + s->v + r[HYDRAULIC_ACTUATOR_R2])) {
        age += age < UINT32_MAX ? 1u : 0u;
    } else {
        age = 0u;
        r[HYDRAULIC_ACTUATOR_R2] = REAL(0.0);
    }
    monitor->age[1] = age;
    residuals->valid[HYDRAULIC_ACTUATOR_R2] = age > monitor->settle[HYDRAULIC_ACTUATOR_R2];
}

void hydraulic_actuator_reset(hydraulic_actuator_monitor *monitor)
{
    int k;

    for (k = 0; k < 2; ++k) {
        monitor->age[k] = 0u;
    }
}

void hydraulic_actuator_step(
    hydraulic_actuator_monitor *monitor,
    const hydraulic_actuator_samples *samples,
    hydraulic_actuator_residuals *residuals)
{
    run_r1(monitor, samples, residuals);
    run_r2(monitor, samples, residuals);
}

const char hydraulic_actuator_fault_name[HYDRAULIC_ACTUATOR_FAULTS][6] = {
    "kv", "leak", "V", "B", "ps", "spool", "A", "p", "v", "m", "b", "load",
};

const uint16_t hydraulic_actuator_fault_class[HYDRAULIC_ACTUATOR_FAULTS] = {
    0u, 0u, 0u, 0u, 0u, 0u, 1u, 1u, 1u, 2u, 2u, 2u,
};

const char hydraulic_actuator_residual_name[HYDRAULIC_ACTUATOR_RESIDUALS][3] = {
    "r1", "r2",
};

/* Signatures: 1 where a residual may be moved by the faults of a class, 3 where it is for sure. */
static const uint8_t signature[HYDRAULIC_ACTUATOR_CLASSES][HYDRAULIC_ACTUATOR_RESIDUALS] = {
    {3u, 0u},
    {3u, 3u},
    {0u, 3u},
};

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

/* Residual k in one sample; whether it goes into alarm. */
static bool watch(
    hydraulic_actuator_diagnosis *d, const hydraulic_actuator_limit *limit, int k, real value, real bound, bool row)
{
    const real off = value - limit->mean;
    const real out = (off < REAL(0.0) ? -off : off) - bound;
    bool high = false;

    if (row) {
        high = add_row(d, limit, k, off, out, bound);
    }
    if (d->state[k] == HYDRAULIC_ACTUATOR_ALARM) {
        d->since[k] += d->since[k] < UINT32_MAX ? 1u : 0u;
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
    return true;
}

/* What is left of a class of faults. */
static hydraulic_actuator_candidate left_of(const hydraulic_actuator_diagnosis *d, const uint8_t *own)
{
    hydraulic_actuator_candidate found = HYDRAULIC_ACTUATOR_LIKELY;
    int k;

    for (k = 0; k < HYDRAULIC_ACTUATOR_RESIDUALS; ++k) {
        if (d->state[k] == HYDRAULIC_ACTUATOR_ALARM && own[k] == 0u) {
            return HYDRAULIC_ACTUATOR_RULED_OUT;
        }
        if (d->state[k] == HYDRAULIC_ACTUATOR_HEALTHY && own[k] == 3u) {
            found = HYDRAULIC_ACTUATOR_SMALL;
        }
    }
    return found;
}

/* Which classes of faults the residuals leave, and the one if it is one. */
static void judge(hydraulic_actuator_diagnosis *d)
{
    int likely = 0;
    int c;

    d->fault_class = HYDRAULIC_ACTUATOR_UNKNOWN;
    for (c = 0; c < HYDRAULIC_ACTUATOR_CLASSES; ++c) {
        const hydraulic_actuator_candidate left = left_of(d, signature[c]);

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
        forget_sums(diagnosis, k);
    }
    for (k = 0; k < HYDRAULIC_ACTUATOR_CLASSES; ++k) {
        diagnosis->candidate[k] = HYDRAULIC_ACTUATOR_RULED_OUT;
    }
    diagnosis->fault_class = HYDRAULIC_ACTUATOR_UNKNOWN;
    diagnosis->quiet = 0u;
    diagnosis->settled = 0u;
}

void hydraulic_actuator_diagnosis_reset(hydraulic_actuator_diagnosis *diagnosis)
{
    int k;

    diagnosis->row = HYDRAULIC_ACTUATOR_ROW;
    diagnosis->least = 15u;
    diagnosis->hold = 10u * HYDRAULIC_ACTUATOR_ROW;
    diagnosis->latch = false;
    diagnosis->tick = 0u;
    for (k = 0; k < HYDRAULIC_ACTUATOR_RESIDUALS; ++k) {
        diagnosis->state[k] = HYDRAULIC_ACTUATOR_BLIND;
    }
    hydraulic_actuator_clear(diagnosis);
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
            forget_sums(d, k);
            if (d->state[k] == HYDRAULIC_ACTUATOR_ALARM) {
                d->quiet = 0u; /* nobody knows that it is over */
            } else {
                d->state[k] = HYDRAULIC_ACTUATOR_BLIND;
            }
        }
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
