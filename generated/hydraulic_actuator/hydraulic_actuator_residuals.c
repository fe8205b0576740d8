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
