/* hydraulic_actuator_threshold.c: the thresholds of HydraulicActuator_threshold; generated, see the header. */
#include "hydraulic_actuator_threshold.h"

#include <math.h>

#if defined __FINITE_MATH_ONLY__ && __FINITE_MATH_ONLY__
#error "this code tells numbers from NaN: compile it without -ffinite-math-only (-ffast-math)"
#endif

typedef hydraulic_actuator_threshold_real real;

#define REAL(x) HYDRAULIC_ACTUATOR_THRESHOLD_CONSTANT(x)
#if defined HYDRAULIC_ACTUATOR_THRESHOLD_FLOAT && !defined HYDRAULIC_ACTUATOR_THRESHOLD_REAL
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

uint32_t hydraulic_actuator_threshold_abi(void)
{
    return HYDRAULIC_ACTUATOR_THRESHOLD_ABI;
}

const char *hydraulic_actuator_threshold_digest(void)
{
    return HYDRAULIC_ACTUATOR_THRESHOLD_DIGEST;
}

void hydraulic_actuator_threshold_nominal(hydraulic_actuator_threshold_parameters *parameters)
{
    parameters->kv = REAL(3.0e-08);  /* m^3/s.Pa^-0.5 */
    parameters->b = REAL(400.0);     /* N.s/m */
}

/* The coefficients of exact and of the filter, from the parameters. */
static void compute_coefficients(hydraulic_actuator_threshold_monitor *monitor,
        const hydraulic_actuator_threshold_parameters *p, real sample_time, real bandwidth)
{
    hydraulic_actuator_threshold_coefficients *c = &monitor->c;

    /* bandwidth*sample_time */
    const real x_ = bandwidth * sample_time;

    /* of a stage: what is left of its memory */
    const real pole = greatest(REAL(2.0) - x_, REAL(0.0)) / (x_ + REAL(2.0));

    /* 1 - pole */
    const real t = REAL(1.0) - pole;

    /* hydraulic_actuator.bg:18: r1_w1: factor of spool*ssqrt(ps - p) */
    c->r1_w1_product = p->kv / REAL(20.0);

    /* filter: what is left of a memory a sample later */
    c->a = pole;

    /* filter: weight of a sample, new and a sample later */
    c->b = REAL(0.5) * t;

    /* filter: 1 - b, the memory of a constant 1 */
    c->rest = REAL(1.0) - REAL(0.5) * t;

    /* hydraulic_actuator.bg:18: r2_w1: factor of v */
    c->r2_w1_v = p->b / REAL(5.0);
}

static bool parameters_are_finite(const hydraulic_actuator_threshold_parameters *p)
{
    return finite_number(p->kv + p->b);
}

static bool coefficients_are_finite(const hydraulic_actuator_threshold_monitor *monitor)
{
    return finite_number(monitor->c.r1_w1_product + monitor->c.a + monitor->c.b + monitor->c.rest
            + monitor->c.r2_w1_v);
}

/* Samples until `constants` time constants of the filter are over. */
static uint32_t samples(real constants, real sample_time, real bandwidth)
{
    const real wait = constants / (bandwidth * sample_time);
    const uint32_t whole = wait < REAL(4.0e9) ? (uint32_t)wait : UINT32_MAX - 1u;

    return (real)whole < wait ? whole + 1u : whole;
}

hydraulic_actuator_threshold_status hydraulic_actuator_threshold_configure(
    hydraulic_actuator_threshold_monitor *monitor,
    const hydraulic_actuator_threshold_parameters *parameters,
    hydraulic_actuator_threshold_real sample_time,
    hydraulic_actuator_threshold_real bandwidth,
    hydraulic_actuator_threshold_real time_unit)
{
    int k;

    for (k = 0; k < HYDRAULIC_ACTUATOR_THRESHOLD_RESIDUALS; ++k) {
        monitor->settle[k] = UINT32_MAX;
    }
    hydraulic_actuator_threshold_reset(monitor);
    if (!parameters_are_finite(parameters)) {
        return HYDRAULIC_ACTUATOR_THRESHOLD_BAD_PARAMETER;
    }
    if (!(sample_time > REAL(0.0)) || !finite_number(sample_time)) {
        return HYDRAULIC_ACTUATOR_THRESHOLD_BAD_SAMPLE_TIME;
    }
    if (!(bandwidth * sample_time >= SLOWEST && bandwidth * sample_time <= REAL(3.0))) {
        return HYDRAULIC_ACTUATOR_THRESHOLD_BAD_BANDWIDTH;
    }
    if (!(time_unit > REAL(0.0)) || !finite_number(time_unit)) {
        return HYDRAULIC_ACTUATOR_THRESHOLD_BAD_TIME_UNIT;
    }
    compute_coefficients(monitor, parameters, sample_time, bandwidth);
    if (!coefficients_are_finite(monitor)) {
        return HYDRAULIC_ACTUATOR_THRESHOLD_BAD_COEFFICIENT;
    }
    monitor->settle[HYDRAULIC_ACTUATOR_THRESHOLD_R1] =
        samples(REAL(9.233413476451586), sample_time, bandwidth);
    monitor->settle[HYDRAULIC_ACTUATOR_THRESHOLD_R2] =
        samples(REAL(9.233413476451586), sample_time, bandwidth);
    return HYDRAULIC_ACTUATOR_THRESHOLD_OK;
}

void hydraulic_actuator_threshold_exact(
    const hydraulic_actuator_threshold_monitor *monitor,
    const hydraulic_actuator_threshold_derivatives *derivatives,
    hydraulic_actuator_threshold_real residuals[HYDRAULIC_ACTUATOR_THRESHOLD_RESIDUALS])
{
    real *r = residuals;

    (void)monitor;
    (void)derivatives;

    /* hydraulic_actuator.bg:18: r1: a threshold is made of filtered signals, only step has it */
    r[HYDRAULIC_ACTUATOR_THRESHOLD_R1] = (real)NAN;

    /* hydraulic_actuator.bg:18: r2: a threshold is made of filtered signals, only step has it */
    r[HYDRAULIC_ACTUATOR_THRESHOLD_R2] = (real)NAN;
}

/* r1 on its first sample: the filter as if it had always been so. */
static void start_r1(
    hydraulic_actuator_threshold_monitor *monitor, const hydraulic_actuator_threshold_samples *s, real *r)
{
    const hydraulic_actuator_threshold_coefficients *c = &monitor->c;
    hydraulic_actuator_threshold_memory *x = &monitor->x;

    /* hydraulic_actuator.bg:18: spool*ssqrt(ps - p) */
    const real r1_w1_product = s->spool * signed_root(s->ps - s->p);

    /* hydraulic_actuator.bg:18: r1_w1: input of stage 2 */
    const real r1_w1_u2 = c->r1_w1_product * r1_w1_product;

    /* hydraulic_actuator.bg:18: r1_w1: stage 2, at rest */
    const real r1_w1_y2 = r1_w1_u2;

    /* hydraulic_actuator.bg:18: r1_w1: stage 2: memory */
    x->r1_w1_s2 = c->rest * r1_w1_u2;

    /* hydraulic_actuator.bg:18: r1_w1: input of stage 1 */
    const real r1_w1_u1 = r1_w1_y2;

    /* hydraulic_actuator.bg:18: r1_w1: stage 1, at rest */
    const real r1_w1_y1 = r1_w1_u1;

    /* hydraulic_actuator.bg:18: r1_w1: stage 1: memory */
    x->r1_w1_s1 = c->rest * r1_w1_u1;

    /* hydraulic_actuator.bg:18: r1: what the tolerance of kv can do */
    const real r1_w1 = r1_w1_y1;

    /* hydraulic_actuator.bg:18: r1: how far r1 can be from zero if no parameter is out of
     * tolerance */
    r[HYDRAULIC_ACTUATOR_THRESHOLD_R1] = MATH(fabs)(r1_w1);
}

/* r1 on every further sample. */
static void next_r1(
    hydraulic_actuator_threshold_monitor *monitor, const hydraulic_actuator_threshold_samples *s, real *r)
{
    const hydraulic_actuator_threshold_coefficients *c = &monitor->c;
    hydraulic_actuator_threshold_memory *x = &monitor->x;

    /* hydraulic_actuator.bg:18: spool*ssqrt(ps - p) */
    const real r1_w1_product = s->spool * signed_root(s->ps - s->p);

    /* hydraulic_actuator.bg:18: r1_w1: input of stage 2 */
    const real r1_w1_u2 = c->r1_w1_product * r1_w1_product;

    /* hydraulic_actuator.bg:18: r1_w1: stage 2 */
    const real r1_w1_y2 = x->r1_w1_s2 + c->b * r1_w1_u2;

    /* hydraulic_actuator.bg:18: r1_w1: stage 2: memory */
    x->r1_w1_s2 = c->a * r1_w1_y2 + c->b * r1_w1_u2;

    /* hydraulic_actuator.bg:18: r1_w1: input of stage 1 */
    const real r1_w1_u1 = r1_w1_y2;

    /* hydraulic_actuator.bg:18: r1_w1: stage 1 */
    const real r1_w1_y1 = x->r1_w1_s1 + c->b * r1_w1_u1;

    /* hydraulic_actuator.bg:18: r1_w1: stage 1: memory */
    x->r1_w1_s1 = c->a * r1_w1_y1 + c->b * r1_w1_u1;

    /* hydraulic_actuator.bg:18: r1: what the tolerance of kv can do */
    const real r1_w1 = r1_w1_y1;

    /* hydraulic_actuator.bg:18: r1: how far r1 can be from zero if no parameter is out of
     * tolerance */
    r[HYDRAULIC_ACTUATOR_THRESHOLD_R1] = MATH(fabs)(r1_w1);
}

/* One sample for r1; a number that is not finite makes the next sample the first. */
static void run_r1(
    hydraulic_actuator_threshold_monitor *monitor, const hydraulic_actuator_threshold_samples *s, hydraulic_actuator_threshold_residuals *residuals)
{
    real *r = residuals->value;
    uint32_t age = monitor->age[0];

    if (age == 0u) {
        start_r1(monitor, s, r);
    } else {
        next_r1(monitor, s, r);
    }
    /* a sum is finite only if all its terms are */
    if (finite_number(s->ps + s->spool + s->p + r[HYDRAULIC_ACTUATOR_THRESHOLD_R1])) {
        age += age < UINT32_MAX ? 1u : 0u;
    } else {
        age = 0u;
        r[HYDRAULIC_ACTUATOR_THRESHOLD_R1] = REAL(0.0);
    }
    monitor->age[0] = age;
    residuals->valid[HYDRAULIC_ACTUATOR_THRESHOLD_R1] = age > monitor->settle[HYDRAULIC_ACTUATOR_THRESHOLD_R1];
}

/* r2 on its first sample: the filter as if it had always been so. */
static void start_r2(
    hydraulic_actuator_threshold_monitor *monitor, const hydraulic_actuator_threshold_samples *s, real *r)
{
    const hydraulic_actuator_threshold_coefficients *c = &monitor->c;
    hydraulic_actuator_threshold_memory *x = &monitor->x;

    /* hydraulic_actuator.bg:18: r2_w1: input of stage 2 */
    const real r2_w1_u2 = c->r2_w1_v * s->v;

    /* hydraulic_actuator.bg:18: r2_w1: stage 2, at rest */
    const real r2_w1_y2 = r2_w1_u2;

    /* hydraulic_actuator.bg:18: r2_w1: stage 2: memory */
    x->r2_w1_s2 = c->rest * r2_w1_u2;

    /* hydraulic_actuator.bg:18: r2_w1: input of stage 1 */
    const real r2_w1_u1 = r2_w1_y2;

    /* hydraulic_actuator.bg:18: r2_w1: stage 1, at rest */
    const real r2_w1_y1 = r2_w1_u1;

    /* hydraulic_actuator.bg:18: r2_w1: stage 1: memory */
    x->r2_w1_s1 = c->rest * r2_w1_u1;

    /* hydraulic_actuator.bg:18: r2: what the tolerance of b can do */
    const real r2_w1 = r2_w1_y1;

    /* hydraulic_actuator.bg:18: r2: how far r2 can be from zero if no parameter is out of
     * tolerance */
    r[HYDRAULIC_ACTUATOR_THRESHOLD_R2] = MATH(fabs)(r2_w1);
}

/* r2 on every further sample. */
static void next_r2(
    hydraulic_actuator_threshold_monitor *monitor, const hydraulic_actuator_threshold_samples *s, real *r)
{
    const hydraulic_actuator_threshold_coefficients *c = &monitor->c;
    hydraulic_actuator_threshold_memory *x = &monitor->x;

    /* hydraulic_actuator.bg:18: r2_w1: input of stage 2 */
    const real r2_w1_u2 = c->r2_w1_v * s->v;

    /* hydraulic_actuator.bg:18: r2_w1: stage 2 */
    const real r2_w1_y2 = x->r2_w1_s2 + c->b * r2_w1_u2;

    /* hydraulic_actuator.bg:18: r2_w1: stage 2: memory */
    x->r2_w1_s2 = c->a * r2_w1_y2 + c->b * r2_w1_u2;

    /* hydraulic_actuator.bg:18: r2_w1: input of stage 1 */
    const real r2_w1_u1 = r2_w1_y2;

    /* hydraulic_actuator.bg:18: r2_w1: stage 1 */
    const real r2_w1_y1 = x->r2_w1_s1 + c->b * r2_w1_u1;

    /* hydraulic_actuator.bg:18: r2_w1: stage 1: memory */
    x->r2_w1_s1 = c->a * r2_w1_y1 + c->b * r2_w1_u1;

    /* hydraulic_actuator.bg:18: r2: what the tolerance of b can do */
    const real r2_w1 = r2_w1_y1;

    /* hydraulic_actuator.bg:18: r2: how far r2 can be from zero if no parameter is out of
     * tolerance */
    r[HYDRAULIC_ACTUATOR_THRESHOLD_R2] = MATH(fabs)(r2_w1);
}

/* One sample for r2; a number that is not finite makes the next sample the first. */
static void run_r2(
    hydraulic_actuator_threshold_monitor *monitor, const hydraulic_actuator_threshold_samples *s, hydraulic_actuator_threshold_residuals *residuals)
{
    real *r = residuals->value;
    uint32_t age = monitor->age[1];

    if (age == 0u) {
        start_r2(monitor, s, r);
    } else {
        next_r2(monitor, s, r);
    }
    /* a sum is finite only if all its terms are */
    if (finite_number(s->v + r[HYDRAULIC_ACTUATOR_THRESHOLD_R2])) {
        age += age < UINT32_MAX ? 1u : 0u;
    } else {
        age = 0u;
        r[HYDRAULIC_ACTUATOR_THRESHOLD_R2] = REAL(0.0);
    }
    monitor->age[1] = age;
    residuals->valid[HYDRAULIC_ACTUATOR_THRESHOLD_R2] = age > monitor->settle[HYDRAULIC_ACTUATOR_THRESHOLD_R2];
}

void hydraulic_actuator_threshold_reset(hydraulic_actuator_threshold_monitor *monitor)
{
    int k;

    for (k = 0; k < 2; ++k) {
        monitor->age[k] = 0u;
    }
}

void hydraulic_actuator_threshold_step(
    hydraulic_actuator_threshold_monitor *monitor,
    const hydraulic_actuator_threshold_samples *samples,
    hydraulic_actuator_threshold_residuals *residuals)
{
    run_r1(monitor, samples, residuals);
    run_r2(monitor, samples, residuals);
}
