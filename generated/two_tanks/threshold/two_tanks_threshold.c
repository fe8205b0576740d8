/* two_tanks_threshold.c: the thresholds of TwoTanks_threshold; generated, see the header. */
#include "two_tanks_threshold.h"

#include <math.h>

#if defined __FINITE_MATH_ONLY__ && __FINITE_MATH_ONLY__
#error "this code tells numbers from NaN: compile it without -ffinite-math-only (-ffast-math)"
#endif

typedef two_tanks_threshold_real real;

#define REAL(x) TWO_TANKS_THRESHOLD_CONSTANT(x)
#if defined TWO_TANKS_THRESHOLD_FLOAT && !defined TWO_TANKS_THRESHOLD_REAL
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

uint32_t two_tanks_threshold_abi(void)
{
    return TWO_TANKS_THRESHOLD_ABI;
}

const char *two_tanks_threshold_digest(void)
{
    return TWO_TANKS_THRESHOLD_DIGEST;
}

void two_tanks_threshold_nominal(two_tanks_threshold_parameters *parameters)
{
    parameters->k12 = REAL(1.2e-06);   /* m^3/s.Pa^-0.5 */
    parameters->kout = REAL(1.0e-06);  /* m^3/s.Pa^-0.5 */
}

/* The coefficients of exact and of the filter, from the parameters. */
static void compute_coefficients(two_tanks_threshold_monitor *monitor,
        const two_tanks_threshold_parameters *p, real sample_time, real bandwidth)
{
    two_tanks_threshold_coefficients *c = &monitor->c;

    /* bandwidth*sample_time */
    const real x_ = bandwidth * sample_time;

    /* of a stage: what is left of its memory */
    const real pole = greatest(REAL(2.0) - x_, REAL(0.0)) / (x_ + REAL(2.0));

    /* 1 - pole */
    const real t = REAL(1.0) - pole;

    /* two_tanks.bg:16: r1_w1: factor of ssqrt(p1 - p2) */
    c->r1_w1_ssqrt = p->k12 / REAL(20.0);

    /* filter: what is left of a memory a sample later */
    c->a = pole;

    /* filter: weight of a sample, new and a sample later */
    c->b = REAL(0.5) * t;

    /* filter: 1 - b, the memory of a constant 1 */
    c->rest = REAL(1.0) - REAL(0.5) * t;

    /* two_tanks.bg:16: r2_w2: factor of ssqrt(p2) */
    c->r2_w2_ssqrt = p->kout / REAL(20.0);
}

static bool parameters_are_finite(const two_tanks_threshold_parameters *p)
{
    return finite_number(p->k12 + p->kout);
}

static bool coefficients_are_finite(const two_tanks_threshold_monitor *monitor)
{
    return finite_number(monitor->c.r1_w1_ssqrt + monitor->c.a + monitor->c.b + monitor->c.rest
            + monitor->c.r2_w2_ssqrt);
}

/* Samples until `constants` time constants of the filter are over. */
static uint32_t samples(real constants, real sample_time, real bandwidth)
{
    const real wait = constants / (bandwidth * sample_time);
    const uint32_t whole = wait < REAL(4.0e9) ? (uint32_t)wait : UINT32_MAX - 1u;

    return (real)whole < wait ? whole + 1u : whole;
}

two_tanks_threshold_status two_tanks_threshold_configure(
    two_tanks_threshold_monitor *monitor,
    const two_tanks_threshold_parameters *parameters,
    two_tanks_threshold_real sample_time,
    two_tanks_threshold_real bandwidth,
    two_tanks_threshold_real time_unit)
{
    int k;

    for (k = 0; k < TWO_TANKS_THRESHOLD_RESIDUALS; ++k) {
        monitor->settle[k] = UINT32_MAX;
    }
    two_tanks_threshold_reset(monitor);
    if (!parameters_are_finite(parameters)) {
        return TWO_TANKS_THRESHOLD_BAD_PARAMETER;
    }
    if (!(sample_time > REAL(0.0)) || !finite_number(sample_time)) {
        return TWO_TANKS_THRESHOLD_BAD_SAMPLE_TIME;
    }
    if (!(bandwidth * sample_time >= SLOWEST && bandwidth * sample_time <= REAL(3.0))) {
        return TWO_TANKS_THRESHOLD_BAD_BANDWIDTH;
    }
    if (!(time_unit > REAL(0.0)) || !finite_number(time_unit)) {
        return TWO_TANKS_THRESHOLD_BAD_TIME_UNIT;
    }
    compute_coefficients(monitor, parameters, sample_time, bandwidth);
    if (!coefficients_are_finite(monitor)) {
        return TWO_TANKS_THRESHOLD_BAD_COEFFICIENT;
    }
    monitor->settle[TWO_TANKS_THRESHOLD_R1] =
        samples(REAL(9.233413476451586), sample_time, bandwidth);
    monitor->settle[TWO_TANKS_THRESHOLD_R2] =
        samples(REAL(9.233413476451586), sample_time, bandwidth);
    return TWO_TANKS_THRESHOLD_OK;
}

void two_tanks_threshold_exact(
    const two_tanks_threshold_monitor *monitor,
    const two_tanks_threshold_derivatives *derivatives,
    two_tanks_threshold_real residuals[TWO_TANKS_THRESHOLD_RESIDUALS])
{
    real *r = residuals;

    (void)monitor;
    (void)derivatives;

    /* two_tanks.bg:16: r1: a threshold is made of filtered signals, only step has it */
    r[TWO_TANKS_THRESHOLD_R1] = (real)NAN;

    /* two_tanks.bg:16: r2: a threshold is made of filtered signals, only step has it */
    r[TWO_TANKS_THRESHOLD_R2] = (real)NAN;
}

/* r1 on its first sample: the filter as if it had always been so. */
static void start_r1(
    two_tanks_threshold_monitor *monitor, const two_tanks_threshold_samples *s, real *r)
{
    const two_tanks_threshold_coefficients *c = &monitor->c;
    two_tanks_threshold_memory *x = &monitor->x;

    /* two_tanks.bg:16: ssqrt(p1 - p2) */
    const real r1_w1_ssqrt = signed_root(s->p1 - s->p2);

    /* two_tanks.bg:16: r1_w1: input of stage 2 */
    const real r1_w1_u2 = -c->r1_w1_ssqrt * r1_w1_ssqrt;

    /* two_tanks.bg:16: r1_w1: stage 2, at rest */
    const real r1_w1_y2 = r1_w1_u2;

    /* two_tanks.bg:16: r1_w1: stage 2: memory */
    x->r1_w1_s2 = c->rest * r1_w1_u2;

    /* two_tanks.bg:16: r1_w1: input of stage 1 */
    const real r1_w1_u1 = r1_w1_y2;

    /* two_tanks.bg:16: r1_w1: stage 1, at rest */
    const real r1_w1_y1 = r1_w1_u1;

    /* two_tanks.bg:16: r1_w1: stage 1: memory */
    x->r1_w1_s1 = c->rest * r1_w1_u1;

    /* two_tanks.bg:16: r1: what the tolerance of k12 can do */
    const real r1_w1 = r1_w1_y1;

    /* two_tanks.bg:16: r1: how far r1 can be from zero if no parameter is out of tolerance */
    r[TWO_TANKS_THRESHOLD_R1] = MATH(fabs)(r1_w1);
}

/* r1 on every further sample. */
static void next_r1(
    two_tanks_threshold_monitor *monitor, const two_tanks_threshold_samples *s, real *r)
{
    const two_tanks_threshold_coefficients *c = &monitor->c;
    two_tanks_threshold_memory *x = &monitor->x;

    /* two_tanks.bg:16: ssqrt(p1 - p2) */
    const real r1_w1_ssqrt = signed_root(s->p1 - s->p2);

    /* two_tanks.bg:16: r1_w1: input of stage 2 */
    const real r1_w1_u2 = -c->r1_w1_ssqrt * r1_w1_ssqrt;

    /* two_tanks.bg:16: r1_w1: stage 2 */
    const real r1_w1_y2 = x->r1_w1_s2 + c->b * r1_w1_u2;

    /* two_tanks.bg:16: r1_w1: stage 2: memory */
    x->r1_w1_s2 = c->a * r1_w1_y2 + c->b * r1_w1_u2;

    /* two_tanks.bg:16: r1_w1: input of stage 1 */
    const real r1_w1_u1 = r1_w1_y2;

    /* two_tanks.bg:16: r1_w1: stage 1 */
    const real r1_w1_y1 = x->r1_w1_s1 + c->b * r1_w1_u1;

    /* two_tanks.bg:16: r1_w1: stage 1: memory */
    x->r1_w1_s1 = c->a * r1_w1_y1 + c->b * r1_w1_u1;

    /* two_tanks.bg:16: r1: what the tolerance of k12 can do */
    const real r1_w1 = r1_w1_y1;

    /* two_tanks.bg:16: r1: how far r1 can be from zero if no parameter is out of tolerance */
    r[TWO_TANKS_THRESHOLD_R1] = MATH(fabs)(r1_w1);
}

/* One sample for r1; a number that is not finite makes the next sample the first. */
static void run_r1(
    two_tanks_threshold_monitor *monitor, const two_tanks_threshold_samples *s, two_tanks_threshold_residuals *residuals)
{
    real *r = residuals->value;
    uint32_t age = monitor->age[0];

    if (age == 0u) {
        start_r1(monitor, s, r);
    } else {
        next_r1(monitor, s, r);
    }
    /* a sum is finite only if all its terms are */
    if (finite_number(s->p1 + s->p2 + r[TWO_TANKS_THRESHOLD_R1])) {
        age += age < UINT32_MAX ? 1u : 0u;
    } else {
        age = 0u;
        r[TWO_TANKS_THRESHOLD_R1] = REAL(0.0);
    }
    monitor->age[0] = age;
    residuals->valid[TWO_TANKS_THRESHOLD_R1] = age > monitor->settle[TWO_TANKS_THRESHOLD_R1];
}

/* r2 on its first sample: the filter as if it had always been so. */
static void start_r2(
    two_tanks_threshold_monitor *monitor, const two_tanks_threshold_samples *s, real *r)
{
    const two_tanks_threshold_coefficients *c = &monitor->c;
    two_tanks_threshold_memory *x = &monitor->x;

    /* two_tanks.bg:16: ssqrt(p1 - p2) */
    const real r2_w1_ssqrt = signed_root(s->p1 - s->p2);

    /* two_tanks.bg:16: r2_w1: input of stage 2 */
    const real r2_w1_u2 = c->r1_w1_ssqrt * r2_w1_ssqrt;

    /* two_tanks.bg:16: r2_w1: stage 2, at rest */
    const real r2_w1_y2 = r2_w1_u2;

    /* two_tanks.bg:16: r2_w1: stage 2: memory */
    x->r2_w1_s2 = c->rest * r2_w1_u2;

    /* two_tanks.bg:16: r2_w1: input of stage 1 */
    const real r2_w1_u1 = r2_w1_y2;

    /* two_tanks.bg:16: r2_w1: stage 1, at rest */
    const real r2_w1_y1 = r2_w1_u1;

    /* two_tanks.bg:16: r2_w1: stage 1: memory */
    x->r2_w1_s1 = c->rest * r2_w1_u1;

    /* two_tanks.bg:16: r2: what the tolerance of k12 can do */
    const real r2_w1 = r2_w1_y1;

    /* two_tanks.bg:16: ssqrt(p2) */
    const real r2_w2_ssqrt = signed_root(s->p2);

    /* two_tanks.bg:16: r2_w2: input of stage 2 */
    const real r2_w2_u2 = -c->r2_w2_ssqrt * r2_w2_ssqrt;

    /* two_tanks.bg:16: r2_w2: stage 2, at rest */
    const real r2_w2_y2 = r2_w2_u2;

    /* two_tanks.bg:16: r2_w2: stage 2: memory */
    x->r2_w2_s2 = c->rest * r2_w2_u2;

    /* two_tanks.bg:16: r2_w2: input of stage 1 */
    const real r2_w2_u1 = r2_w2_y2;

    /* two_tanks.bg:16: r2_w2: stage 1, at rest */
    const real r2_w2_y1 = r2_w2_u1;

    /* two_tanks.bg:16: r2_w2: stage 1: memory */
    x->r2_w2_s1 = c->rest * r2_w2_u1;

    /* two_tanks.bg:16: r2: what the tolerance of kout can do */
    const real r2_w2 = r2_w2_y1;

    /* two_tanks.bg:16: r2: how far r2 can be from zero if no parameter is out of tolerance */
    r[TWO_TANKS_THRESHOLD_R2] = MATH(fabs)(r2_w1) + MATH(fabs)(r2_w2);
}

/* r2 on every further sample. */
static void next_r2(
    two_tanks_threshold_monitor *monitor, const two_tanks_threshold_samples *s, real *r)
{
    const two_tanks_threshold_coefficients *c = &monitor->c;
    two_tanks_threshold_memory *x = &monitor->x;

    /* two_tanks.bg:16: ssqrt(p1 - p2) */
    const real r2_w1_ssqrt = signed_root(s->p1 - s->p2);

    /* two_tanks.bg:16: r2_w1: input of stage 2 */
    const real r2_w1_u2 = c->r1_w1_ssqrt * r2_w1_ssqrt;

    /* two_tanks.bg:16: r2_w1: stage 2 */
    const real r2_w1_y2 = x->r2_w1_s2 + c->b * r2_w1_u2;

    /* two_tanks.bg:16: r2_w1: stage 2: memory */
    x->r2_w1_s2 = c->a * r2_w1_y2 + c->b * r2_w1_u2;

    /* two_tanks.bg:16: r2_w1: input of stage 1 */
    const real r2_w1_u1 = r2_w1_y2;

    /* two_tanks.bg:16: r2_w1: stage 1 */
    const real r2_w1_y1 = x->r2_w1_s1 + c->b * r2_w1_u1;

    /* two_tanks.bg:16: r2_w1: stage 1: memory */
    x->r2_w1_s1 = c->a * r2_w1_y1 + c->b * r2_w1_u1;

    /* two_tanks.bg:16: r2: what the tolerance of k12 can do */
    const real r2_w1 = r2_w1_y1;

    /* two_tanks.bg:16: ssqrt(p2) */
    const real r2_w2_ssqrt = signed_root(s->p2);

    /* two_tanks.bg:16: r2_w2: input of stage 2 */
    const real r2_w2_u2 = -c->r2_w2_ssqrt * r2_w2_ssqrt;

    /* two_tanks.bg:16: r2_w2: stage 2 */
    const real r2_w2_y2 = x->r2_w2_s2 + c->b * r2_w2_u2;

    /* two_tanks.bg:16: r2_w2: stage 2: memory */
    x->r2_w2_s2 = c->a * r2_w2_y2 + c->b * r2_w2_u2;

    /* two_tanks.bg:16: r2_w2: input of stage 1 */
    const real r2_w2_u1 = r2_w2_y2;

    /* two_tanks.bg:16: r2_w2: stage 1 */
    const real r2_w2_y1 = x->r2_w2_s1 + c->b * r2_w2_u1;

    /* two_tanks.bg:16: r2_w2: stage 1: memory */
    x->r2_w2_s1 = c->a * r2_w2_y1 + c->b * r2_w2_u1;

    /* two_tanks.bg:16: r2: what the tolerance of kout can do */
    const real r2_w2 = r2_w2_y1;

    /* two_tanks.bg:16: r2: how far r2 can be from zero if no parameter is out of tolerance */
    r[TWO_TANKS_THRESHOLD_R2] = MATH(fabs)(r2_w1) + MATH(fabs)(r2_w2);
}

/* One sample for r2; a number that is not finite makes the next sample the first. */
static void run_r2(
    two_tanks_threshold_monitor *monitor, const two_tanks_threshold_samples *s, two_tanks_threshold_residuals *residuals)
{
    real *r = residuals->value;
    uint32_t age = monitor->age[1];

    if (age == 0u) {
        start_r2(monitor, s, r);
    } else {
        next_r2(monitor, s, r);
    }
    /* a sum is finite only if all its terms are */
    if (finite_number(s->p1 + s->p2 + r[TWO_TANKS_THRESHOLD_R2])) {
        age += age < UINT32_MAX ? 1u : 0u;
    } else {
        age = 0u;
        r[TWO_TANKS_THRESHOLD_R2] = REAL(0.0);
    }
    monitor->age[1] = age;
    residuals->valid[TWO_TANKS_THRESHOLD_R2] = age > monitor->settle[TWO_TANKS_THRESHOLD_R2];
}

void two_tanks_threshold_reset(two_tanks_threshold_monitor *monitor)
{
    int k;

    for (k = 0; k < 2; ++k) {
        monitor->age[k] = 0u;
    }
}

void two_tanks_threshold_step(
    two_tanks_threshold_monitor *monitor,
    const two_tanks_threshold_samples *samples,
    two_tanks_threshold_residuals *residuals)
{
    run_r1(monitor, samples, residuals);
    run_r2(monitor, samples, residuals);
}
