/* oven_threshold.c: the thresholds of Oven_threshold; generated, see the header. */
#include "oven_threshold.h"

#include <math.h>

#if defined __FINITE_MATH_ONLY__ && __FINITE_MATH_ONLY__
#error "this code tells numbers from NaN: compile it without -ffinite-math-only (-ffast-math)"
#endif

typedef oven_threshold_real real;

#define REAL(x) OVEN_THRESHOLD_CONSTANT(x)
#if defined OVEN_THRESHOLD_FLOAT && !defined OVEN_THRESHOLD_REAL
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

/* The same number; the model asks for it. */
static bool equal(real left, real right)
{
    return left <= right && left >= right;
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

uint32_t oven_threshold_abi(void)
{
    return OVEN_THRESHOLD_ABI;
}

const char *oven_threshold_digest(void)
{
    return OVEN_THRESHOLD_DIGEST;
}

void oven_threshold_nominal(oven_threshold_parameters *parameters)
{
    parameters->Gh = REAL(4.0);  /* W/K */
    parameters->Go = REAL(0.8);  /* W/K */
}

/* The coefficients of exact and of the filter, from the parameters. */
static void compute_coefficients(oven_threshold_monitor *monitor,
        const oven_threshold_parameters *p, real sample_time, real bandwidth)
{
    oven_threshold_coefficients *c = &monitor->c;

    /* bandwidth*sample_time */
    const real x_ = bandwidth * sample_time;

    /* of a stage: what is left of its memory */
    const real pole = greatest(REAL(2.0) - x_, REAL(0.0)) / (x_ + REAL(2.0));

    /* min(x/2, 0.025) */
    const real t = least(REAL(0.5) * x_, REAL(1.0) / REAL(40.0));

    /* part of the start that a sample is */
    c->r1_pace = t;

    /* oven.bg:15: r1_w1: factor of Th */
    c->r1_w1_Th = p->Gh / REAL(20.0);

    /* filter: what is left of a memory a sample later */
    c->a = pole;

    /* filter: weight of a sample, new and a sample later */
    c->b = REAL(0.5) * (REAL(1.0) - pole);

    /* oven.bg:15: r2_w2: factor of Ta */
    c->r2_w2_Ta = p->Go / REAL(10.0);
}

static bool parameters_are_finite(const oven_threshold_parameters *p)
{
    return finite_number(p->Gh + p->Go);
}

static bool coefficients_are_finite(const oven_threshold_monitor *monitor)
{
    return finite_number(monitor->c.r1_pace + monitor->c.r1_w1_Th + monitor->c.a + monitor->c.b
            + monitor->c.r2_w2_Ta);
}

/* Samples until `constants` time constants of the filter are over. */
static uint32_t samples(real constants, real sample_time, real bandwidth)
{
    const real wait = constants / (bandwidth * sample_time);
    const uint32_t whole = wait < REAL(4.0e9) ? (uint32_t)wait : UINT32_MAX - 1u;

    return (real)whole < wait ? whole + 1u : whole;
}

oven_threshold_status oven_threshold_configure(
    oven_threshold_monitor *monitor,
    const oven_threshold_parameters *parameters,
    oven_threshold_real sample_time,
    oven_threshold_real bandwidth,
    oven_threshold_real time_unit)
{
    int k;

    for (k = 0; k < OVEN_THRESHOLD_RESIDUALS; ++k) {
        monitor->settle[k] = UINT32_MAX;
    }
    oven_threshold_reset(monitor);
    if (!parameters_are_finite(parameters)) {
        return OVEN_THRESHOLD_BAD_PARAMETER;
    }
    if (!(sample_time > REAL(0.0)) || !finite_number(sample_time)) {
        return OVEN_THRESHOLD_BAD_SAMPLE_TIME;
    }
    if (!(bandwidth * sample_time >= SLOWEST && bandwidth * sample_time <= REAL(3.0))) {
        return OVEN_THRESHOLD_BAD_BANDWIDTH;
    }
    if (!(time_unit > REAL(0.0)) || !finite_number(time_unit)) {
        return OVEN_THRESHOLD_BAD_TIME_UNIT;
    }
    compute_coefficients(monitor, parameters, sample_time, bandwidth);
    if (!coefficients_are_finite(monitor)) {
        return OVEN_THRESHOLD_BAD_COEFFICIENT;
    }
    monitor->settle[OVEN_THRESHOLD_R1] = samples(REAL(2.0), sample_time, bandwidth);
    monitor->settle[OVEN_THRESHOLD_R2] = samples(REAL(2.0), sample_time, bandwidth);
    return OVEN_THRESHOLD_OK;
}

void oven_threshold_exact(
    const oven_threshold_monitor *monitor,
    const oven_threshold_derivatives *derivatives,
    oven_threshold_real residuals[OVEN_THRESHOLD_RESIDUALS])
{
    real *r = residuals;

    (void)monitor;
    (void)derivatives;

    /* oven.bg:15: r1: a threshold is made of filtered signals, only step has it */
    r[OVEN_THRESHOLD_R1] = (real)NAN;

    /* oven.bg:15: r2: a threshold is made of filtered signals, only step has it */
    r[OVEN_THRESHOLD_R2] = (real)NAN;
}

/* r1 on its first sample: the filter as if it had always been so. */
static void start_r1(
    oven_threshold_monitor *monitor, const oven_threshold_samples *s, real *r)
{
    oven_threshold_memory *x = &monitor->x;

    /* oven.bg:15: r1: on for the next sample */
    x->r1_on = s->on ? REAL(1.0) : REAL(0.0);

    /* oven.bg:15: r1: the same, for the next sample */
    x->r1_open = REAL(0.0);

    /* oven.bg:15: r1_w1: stage 2: memory */
    x->r1_w1_s2 = REAL(0.0);

    /* oven.bg:15: r1_w1: stage 1: memory */
    x->r1_w1_s1 = REAL(0.0);

    /* oven.bg:15: r1: what the tolerance of Gh can do */
    const real r1_w1 = REAL(0.0);

    /* oven.bg:15: r1: how far r1 can be from zero if no parameter is out of tolerance */
    r[OVEN_THRESHOLD_R1] = MATH(fabs)(r1_w1);
}

/* r1 on every further sample. */
static void next_r1(
    oven_threshold_monitor *monitor, const oven_threshold_samples *s, real *r)
{
    const oven_threshold_coefficients *c = &monitor->c;
    oven_threshold_memory *x = &monitor->x;

    /* oven.bg:15: r1: 0 where on changes */
    const real r1_kept = equal(x->r1_on, (s->on ? REAL(1.0) : REAL(0.0))) ? REAL(1.0) : REAL(0.0);

    /* oven.bg:15: r1: on for the next sample */
    x->r1_on = s->on ? REAL(1.0) : REAL(0.0);

    /* oven.bg:15: r1: how much of the start is over */
    const real r1_u = r1_kept * least(REAL(1.0), x->r1_open + c->r1_pace);

    /* oven.bg:15: r1: the same, for the next sample */
    x->r1_open = r1_u;

    /* oven.bg:15: r1: how much is to come */
    const real r1_rest = REAL(1.0) - r1_u;

    /* oven.bg:15: r1: the window */
    const real r1_phi0 = r1_u * r1_u * r1_u * (REAL(1.0)
            + r1_rest * (REAL(3.0) + r1_rest * REAL(6.0)));

    /* oven.bg:15: r1_w1: input of stage 2 */
    const real r1_w1_u2 = r1_phi0 * (c->r1_w1_Th * s->To - c->r1_w1_Th * s->Th);

    /* oven.bg:15: r1_w1: stage 2 */
    const real r1_w1_y2 = r1_kept * x->r1_w1_s2 + c->b * r1_w1_u2;

    /* oven.bg:15: r1_w1: stage 2: memory */
    x->r1_w1_s2 = c->a * r1_w1_y2 + c->b * r1_w1_u2;

    /* oven.bg:15: r1_w1: input of stage 1 */
    const real r1_w1_u1 = r1_w1_y2;

    /* oven.bg:15: r1_w1: stage 1 */
    const real r1_w1_y1 = r1_kept * x->r1_w1_s1 + c->b * r1_w1_u1;

    /* oven.bg:15: r1_w1: stage 1: memory */
    x->r1_w1_s1 = c->a * r1_w1_y1 + c->b * r1_w1_u1;

    /* oven.bg:15: r1: what the tolerance of Gh can do */
    const real r1_w1 = r1_w1_y1;

    /* oven.bg:15: r1: how far r1 can be from zero if no parameter is out of tolerance */
    r[OVEN_THRESHOLD_R1] = MATH(fabs)(r1_w1);
}

/* One sample for r1; a number that is not finite makes the next sample the first. */
static void run_r1(
    oven_threshold_monitor *monitor, const oven_threshold_samples *s, oven_threshold_residuals *residuals)
{
    real *r = residuals->value;
    uint32_t age = monitor->age[0];

    if (age == 0u) {
        start_r1(monitor, s, r);
    } else {
        next_r1(monitor, s, r);
    }
    /* a sum is finite only if all its terms are */
    if (finite_number(s->Th + s->To + r[OVEN_THRESHOLD_R1])) {
        age += age < UINT32_MAX ? 1u : 0u;
    } else {
        age = 0u;
        r[OVEN_THRESHOLD_R1] = REAL(0.0);
    }
    monitor->age[0] = age;
    residuals->valid[OVEN_THRESHOLD_R1] = age > monitor->settle[OVEN_THRESHOLD_R1] && monitor->x.r1_open >= REAL(1.0);
}

/* r2 on its first sample: the filter as if it had always been so. */
static void start_r2(
    oven_threshold_monitor *monitor, const oven_threshold_samples *s, real *r)
{
    oven_threshold_memory *x = &monitor->x;

    (void)s;

    /* oven.bg:15: r2: the same, for the next sample */
    x->r2_open = REAL(0.0);

    /* oven.bg:15: r2_w1: stage 2: memory */
    x->r2_w1_s2 = REAL(0.0);

    /* oven.bg:15: r2_w1: stage 1: memory */
    x->r2_w1_s1 = REAL(0.0);

    /* oven.bg:15: r2: what the tolerance of Gh can do */
    const real r2_w1 = REAL(0.0);

    /* oven.bg:15: r2_w2: stage 2: memory */
    x->r2_w2_s2 = REAL(0.0);

    /* oven.bg:15: r2_w2: stage 1: memory */
    x->r2_w2_s1 = REAL(0.0);

    /* oven.bg:15: r2: what the tolerance of Go can do */
    const real r2_w2 = REAL(0.0);

    /* oven.bg:15: r2: how far r2 can be from zero if no parameter is out of tolerance */
    r[OVEN_THRESHOLD_R2] = MATH(fabs)(r2_w1) + MATH(fabs)(r2_w2);
}

/* r2 on every further sample. */
static void next_r2(
    oven_threshold_monitor *monitor, const oven_threshold_samples *s, real *r)
{
    const oven_threshold_coefficients *c = &monitor->c;
    oven_threshold_memory *x = &monitor->x;

    /* oven.bg:15: r2: how much of the start is over */
    const real r2_u = least(REAL(1.0), x->r2_open + c->r1_pace);

    /* oven.bg:15: r2: the same, for the next sample */
    x->r2_open = r2_u;

    /* oven.bg:15: r2: how much is to come */
    const real r2_rest = REAL(1.0) - r2_u;

    /* oven.bg:15: r2: the window */
    const real r2_phi0 = r2_u * r2_u * r2_u * (REAL(1.0)
            + r2_rest * (REAL(3.0) + r2_rest * REAL(6.0)));

    /* oven.bg:15: r2_w1: input of stage 2 */
    const real r2_w1_u2 = r2_phi0 * (c->r1_w1_Th * s->Th - c->r1_w1_Th * s->To);

    /* oven.bg:15: r2_w1: stage 2 */
    const real r2_w1_y2 = x->r2_w1_s2 + c->b * r2_w1_u2;

    /* oven.bg:15: r2_w1: stage 2: memory */
    x->r2_w1_s2 = c->a * r2_w1_y2 + c->b * r2_w1_u2;

    /* oven.bg:15: r2_w1: input of stage 1 */
    const real r2_w1_u1 = r2_w1_y2;

    /* oven.bg:15: r2_w1: stage 1 */
    const real r2_w1_y1 = x->r2_w1_s1 + c->b * r2_w1_u1;

    /* oven.bg:15: r2_w1: stage 1: memory */
    x->r2_w1_s1 = c->a * r2_w1_y1 + c->b * r2_w1_u1;

    /* oven.bg:15: r2: what the tolerance of Gh can do */
    const real r2_w1 = r2_w1_y1;

    /* oven.bg:15: r2_w2: input of stage 2 */
    const real r2_w2_u2 = r2_phi0 * (c->r2_w2_Ta * s->Ta - c->r2_w2_Ta * s->To);

    /* oven.bg:15: r2_w2: stage 2 */
    const real r2_w2_y2 = x->r2_w2_s2 + c->b * r2_w2_u2;

    /* oven.bg:15: r2_w2: stage 2: memory */
    x->r2_w2_s2 = c->a * r2_w2_y2 + c->b * r2_w2_u2;

    /* oven.bg:15: r2_w2: input of stage 1 */
    const real r2_w2_u1 = r2_w2_y2;

    /* oven.bg:15: r2_w2: stage 1 */
    const real r2_w2_y1 = x->r2_w2_s1 + c->b * r2_w2_u1;

    /* oven.bg:15: r2_w2: stage 1: memory */
    x->r2_w2_s1 = c->a * r2_w2_y1 + c->b * r2_w2_u1;

    /* oven.bg:15: r2: what the tolerance of Go can do */
    const real r2_w2 = r2_w2_y1;

    /* oven.bg:15: r2: how far r2 can be from zero if no parameter is out of tolerance */
    r[OVEN_THRESHOLD_R2] = MATH(fabs)(r2_w1) + MATH(fabs)(r2_w2);
}

/* One sample for r2; a number that is not finite makes the next sample the first. */
static void run_r2(
    oven_threshold_monitor *monitor, const oven_threshold_samples *s, oven_threshold_residuals *residuals)
{
    real *r = residuals->value;
    uint32_t age = monitor->age[1];

    if (age == 0u) {
        start_r2(monitor, s, r);
    } else {
        next_r2(monitor, s, r);
    }
    /* a sum is finite only if all its terms are */
    if (finite_number(s->Ta + s->Th + s->To + r[OVEN_THRESHOLD_R2])) {
        age += age < UINT32_MAX ? 1u : 0u;
    } else {
        age = 0u;
        r[OVEN_THRESHOLD_R2] = REAL(0.0);
    }
    monitor->age[1] = age;
    residuals->valid[OVEN_THRESHOLD_R2] = age > monitor->settle[OVEN_THRESHOLD_R2] && monitor->x.r2_open >= REAL(1.0);
}

void oven_threshold_reset(oven_threshold_monitor *monitor)
{
    int k;

    for (k = 0; k < 2; ++k) {
        monitor->age[k] = 0u;
    }
}

void oven_threshold_step(
    oven_threshold_monitor *monitor,
    const oven_threshold_samples *samples,
    oven_threshold_residuals *residuals)
{
    run_r1(monitor, samples, residuals);
    run_r2(monitor, samples, residuals);
}
