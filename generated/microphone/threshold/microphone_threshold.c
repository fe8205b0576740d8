/* microphone_threshold.c: the thresholds of Microphone_threshold; generated, see the header. */
#include "microphone_threshold.h"

#include <math.h>

#if defined __FINITE_MATH_ONLY__ && __FINITE_MATH_ONLY__
#error "this code tells numbers from NaN: compile it without -ffinite-math-only (-ffast-math)"
#endif

typedef microphone_threshold_real real;

#define REAL(x) MICROPHONE_THRESHOLD_CONSTANT(x)
#if defined MICROPHONE_THRESHOLD_FLOAT && !defined MICROPHONE_THRESHOLD_REAL
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

/* The larger of two numbers. */
static real greatest(real left, real right)
{
    return right > left ? right : left;
}

uint32_t microphone_threshold_abi(void)
{
    return MICROPHONE_THRESHOLD_ABI;
}

const char *microphone_threshold_digest(void)
{
    return MICROPHONE_THRESHOLD_DIGEST;
}

void microphone_threshold_nominal(microphone_threshold_parameters *parameters)
{
    parameters->R = REAL(10000000.0);  /* Ohm */
    parameters->b = REAL(0.002);       /* N.s/m */
}

/* The coefficients of exact and of the filter, from the parameters. */
static void compute_coefficients(microphone_threshold_monitor *monitor,
        const microphone_threshold_parameters *p, real sample_time, real bandwidth)
{
    microphone_threshold_coefficients *c = &monitor->c;

    /* bandwidth*sample_time */
    const real x_ = bandwidth * sample_time;

    /* of a stage: what is left of its memory */
    const real pole = greatest(REAL(2.0) - x_, REAL(0.0)) / (x_ + REAL(2.0));

    /* microphone.bg:17: 1/R */
    const real t = REAL(1.0) / p->R;

    /* 1 - pole */
    const real t_2 = REAL(1.0) - pole;

    /* microphone.bg:17: r1_w1: factor of U0 */
    c->r1_w1_U0 = t / REAL(20.0);

    /* filter: what is left of a memory a sample later */
    c->a = pole;

    /* filter: weight of a sample, new and a sample later */
    c->b = REAL(0.5) * t_2;

    /* filter: 1 - b, the memory of a constant 1 */
    c->rest = REAL(1.0) - REAL(0.5) * t_2;

    /* microphone.bg:17: r1_w2: factor of u */
    c->r1_w2_u = t / REAL(380.0);

    /* microphone.bg:29: r2_w1: factor of v */
    c->r2_w1_v = p->b / REAL(5.0);
}

static bool parameters_are_finite(const microphone_threshold_parameters *p)
{
    return finite_number(p->R + p->b);
}

static bool coefficients_are_finite(const microphone_threshold_monitor *monitor)
{
    return finite_number(monitor->c.r1_w1_U0 + monitor->c.a + monitor->c.b + monitor->c.rest
            + monitor->c.r1_w2_u + monitor->c.r2_w1_v);
}

/* Samples until `constants` time constants of the filter are over. */
static uint32_t samples(real constants, real sample_time, real bandwidth)
{
    const real wait = constants / (bandwidth * sample_time);
    const uint32_t whole = wait < REAL(4.0e9) ? (uint32_t)wait : UINT32_MAX - 1u;

    return (real)whole < wait ? whole + 1u : whole;
}

microphone_threshold_status microphone_threshold_configure(
    microphone_threshold_monitor *monitor,
    const microphone_threshold_parameters *parameters,
    microphone_threshold_real sample_time,
    microphone_threshold_real bandwidth,
    microphone_threshold_real time_unit)
{
    int k;

    for (k = 0; k < MICROPHONE_THRESHOLD_RESIDUALS; ++k) {
        monitor->settle[k] = UINT32_MAX;
    }
    microphone_threshold_reset(monitor);
    if (!parameters_are_finite(parameters)) {
        return MICROPHONE_THRESHOLD_BAD_PARAMETER;
    }
    if (!(sample_time >= REAL(0.000999999)) || !finite_number(sample_time)) {
        return MICROPHONE_THRESHOLD_BAD_SAMPLE_TIME;
    }
    if (!(bandwidth * sample_time >= SLOWEST && bandwidth * sample_time <= REAL(3.0))) {
        return MICROPHONE_THRESHOLD_BAD_BANDWIDTH;
    }
    if (!(time_unit > REAL(0.0)) || !finite_number(time_unit)) {
        return MICROPHONE_THRESHOLD_BAD_TIME_UNIT;
    }
    compute_coefficients(monitor, parameters, sample_time, bandwidth);
    if (!coefficients_are_finite(monitor)) {
        return MICROPHONE_THRESHOLD_BAD_COEFFICIENT;
    }
    monitor->settle[MICROPHONE_THRESHOLD_R1] =
        samples(REAL(9.233413476451586), sample_time, bandwidth);
    monitor->settle[MICROPHONE_THRESHOLD_R2] =
        samples(REAL(6.907755278982138), sample_time, bandwidth);
    return MICROPHONE_THRESHOLD_OK;
}

void microphone_threshold_exact(
    const microphone_threshold_monitor *monitor,
    const microphone_threshold_derivatives *derivatives,
    microphone_threshold_real residuals[MICROPHONE_THRESHOLD_RESIDUALS])
{
    real *r = residuals;

    (void)monitor;
    (void)derivatives;

    /* microphone.bg:17: r1: a threshold is made of filtered signals, only step has it */
    r[MICROPHONE_THRESHOLD_R1] = (real)NAN;

    /* microphone.bg:29: r2: a threshold is made of filtered signals, only step has it */
    r[MICROPHONE_THRESHOLD_R2] = (real)NAN;
}

/* r1 on its first sample: the filter as if it had always been so. */
static void start_r1(
    microphone_threshold_monitor *monitor, const microphone_threshold_samples *s, real *r)
{
    const microphone_threshold_coefficients *c = &monitor->c;
    microphone_threshold_memory *x = &monitor->x;

    /* microphone.bg:17: r1_w1: input of stage 2 */
    const real r1_w1_u2 = c->r1_w1_U0 * s->u - c->r1_w1_U0 * s->U0;

    /* microphone.bg:17: r1_w1: stage 2, at rest */
    const real r1_w1_y2 = r1_w1_u2;

    /* microphone.bg:17: r1_w1: stage 2: memory */
    x->r1_w1_s2 = c->rest * r1_w1_u2;

    /* microphone.bg:17: r1_w1: input of stage 1 */
    const real r1_w1_u1 = r1_w1_y2;

    /* microphone.bg:17: r1_w1: stage 1, at rest */
    const real r1_w1_y1 = r1_w1_u1;

    /* microphone.bg:17: r1_w1: stage 1: memory */
    x->r1_w1_s1 = c->rest * r1_w1_u1;

    /* microphone.bg:17: r1: what the tolerance of R can do */
    const real r1_w1 = r1_w1_y1;

    /* microphone.bg:17: r1_w2: input of stage 2 */
    const real r1_w2_u2 = c->r1_w2_u * s->U0 - c->r1_w2_u * s->u;

    /* microphone.bg:17: r1_w2: stage 2, at rest */
    const real r1_w2_y2 = r1_w2_u2;

    /* microphone.bg:17: r1_w2: stage 2: memory */
    x->r1_w2_s2 = c->rest * r1_w2_u2;

    /* microphone.bg:17: r1_w2: input of stage 1 */
    const real r1_w2_u1 = r1_w2_y2;

    /* microphone.bg:17: r1_w2: stage 1, at rest */
    const real r1_w2_y1 = r1_w2_u1;

    /* microphone.bg:17: r1_w2: stage 1: memory */
    x->r1_w2_s1 = c->rest * r1_w2_u1;

    /* microphone.bg:17: r1: second order of what the tolerance of R can do */
    const real r1_w2 = r1_w2_y1;

    /* microphone.bg:17: r1: how far r1 can be from zero if no parameter is out of tolerance */
    r[MICROPHONE_THRESHOLD_R1] = MATH(fabs)(r1_w1) + MATH(fabs)(r1_w2);
}

/* r1 on every further sample. */
static void next_r1(
    microphone_threshold_monitor *monitor, const microphone_threshold_samples *s, real *r)
{
    const microphone_threshold_coefficients *c = &monitor->c;
    microphone_threshold_memory *x = &monitor->x;

    /* microphone.bg:17: r1_w1: input of stage 2 */
    const real r1_w1_u2 = c->r1_w1_U0 * s->u - c->r1_w1_U0 * s->U0;

    /* microphone.bg:17: r1_w1: stage 2 */
    const real r1_w1_y2 = x->r1_w1_s2 + c->b * r1_w1_u2;

    /* microphone.bg:17: r1_w1: stage 2: memory */
    x->r1_w1_s2 = c->a * r1_w1_y2 + c->b * r1_w1_u2;

    /* microphone.bg:17: r1_w1: input of stage 1 */
    const real r1_w1_u1 = r1_w1_y2;

    /* microphone.bg:17: r1_w1: stage 1 */
    const real r1_w1_y1 = x->r1_w1_s1 + c->b * r1_w1_u1;

    /* microphone.bg:17: r1_w1: stage 1: memory */
    x->r1_w1_s1 = c->a * r1_w1_y1 + c->b * r1_w1_u1;

    /* microphone.bg:17: r1: what the tolerance of R can do */
    const real r1_w1 = r1_w1_y1;

    /* microphone.bg:17: r1_w2: input of stage 2 */
    const real r1_w2_u2 = c->r1_w2_u * s->U0 - c->r1_w2_u * s->u;

    /* microphone.bg:17: r1_w2: stage 2 */
    const real r1_w2_y2 = x->r1_w2_s2 + c->b * r1_w2_u2;

    /* microphone.bg:17: r1_w2: stage 2: memory */
    x->r1_w2_s2 = c->a * r1_w2_y2 + c->b * r1_w2_u2;

    /* microphone.bg:17: r1_w2: input of stage 1 */
    const real r1_w2_u1 = r1_w2_y2;

    /* microphone.bg:17: r1_w2: stage 1 */
    const real r1_w2_y1 = x->r1_w2_s1 + c->b * r1_w2_u1;

    /* microphone.bg:17: r1_w2: stage 1: memory */
    x->r1_w2_s1 = c->a * r1_w2_y1 + c->b * r1_w2_u1;

    /* microphone.bg:17: r1: second order of what the tolerance of R can do */
    const real r1_w2 = r1_w2_y1;

    /* microphone.bg:17: r1: how far r1 can be from zero if no parameter is out of tolerance */
    r[MICROPHONE_THRESHOLD_R1] = MATH(fabs)(r1_w1) + MATH(fabs)(r1_w2);
}

/* One sample for r1; a number that is not finite makes the next sample the first. */
static void run_r1(
    microphone_threshold_monitor *monitor, const microphone_threshold_samples *s, microphone_threshold_residuals *residuals)
{
    real *r = residuals->value;
    uint32_t age = monitor->age[0];

    if (age == 0u) {
        start_r1(monitor, s, r);
    } else {
        next_r1(monitor, s, r);
    }
    /* a sum is finite only if all its terms are */
    if (finite_number(s->U0 + s->u + r[MICROPHONE_THRESHOLD_R1])) {
        age += age < UINT32_MAX ? 1u : 0u;
    } else {
        age = 0u;
        r[MICROPHONE_THRESHOLD_R1] = REAL(0.0);
    }
    monitor->age[0] = age;
    residuals->valid[MICROPHONE_THRESHOLD_R1] = age > monitor->settle[MICROPHONE_THRESHOLD_R1];
}

/* r2 on its first sample: the filter as if it had always been so. */
static void start_r2(
    microphone_threshold_monitor *monitor, const microphone_threshold_samples *s, real *r)
{
    const microphone_threshold_coefficients *c = &monitor->c;
    microphone_threshold_memory *x = &monitor->x;

    /* microphone.bg:29: r2_w1: input of stage 1 */
    const real r2_w1_u1 = -c->r2_w1_v * s->v;

    /* microphone.bg:29: r2_w1: stage 1, at rest */
    const real r2_w1_y1 = r2_w1_u1;

    /* microphone.bg:29: r2_w1: stage 1: memory */
    x->r2_w1_s1 = c->rest * r2_w1_u1;

    /* microphone.bg:29: r2: what the tolerance of b can do */
    const real r2_w1 = r2_w1_y1;

    /* microphone.bg:29: r2: how far r2 can be from zero if no parameter is out of tolerance */
    r[MICROPHONE_THRESHOLD_R2] = MATH(fabs)(r2_w1);
}

/* r2 on every further sample. */
static void next_r2(
    microphone_threshold_monitor *monitor, const microphone_threshold_samples *s, real *r)
{
    const microphone_threshold_coefficients *c = &monitor->c;
    microphone_threshold_memory *x = &monitor->x;

    /* microphone.bg:29: r2_w1: input of stage 1 */
    const real r2_w1_u1 = -c->r2_w1_v * s->v;

    /* microphone.bg:29: r2_w1: stage 1 */
    const real r2_w1_y1 = x->r2_w1_s1 + c->b * r2_w1_u1;

    /* microphone.bg:29: r2_w1: stage 1: memory */
    x->r2_w1_s1 = c->a * r2_w1_y1 + c->b * r2_w1_u1;

    /* microphone.bg:29: r2: what the tolerance of b can do */
    const real r2_w1 = r2_w1_y1;

    /* microphone.bg:29: r2: how far r2 can be from zero if no parameter is out of tolerance */
    r[MICROPHONE_THRESHOLD_R2] = MATH(fabs)(r2_w1);
}

/* One sample for r2; a number that is not finite makes the next sample the first. */
static void run_r2(
    microphone_threshold_monitor *monitor, const microphone_threshold_samples *s, microphone_threshold_residuals *residuals)
{
    real *r = residuals->value;
    uint32_t age = monitor->age[1];

    if (age == 0u) {
        start_r2(monitor, s, r);
    } else {
        next_r2(monitor, s, r);
    }
    /* a sum is finite only if all its terms are */
    if (finite_number(s->v + r[MICROPHONE_THRESHOLD_R2])) {
        age += age < UINT32_MAX ? 1u : 0u;
    } else {
        age = 0u;
        r[MICROPHONE_THRESHOLD_R2] = REAL(0.0);
    }
    monitor->age[1] = age;
    residuals->valid[MICROPHONE_THRESHOLD_R2] = age > monitor->settle[MICROPHONE_THRESHOLD_R2];
}

void microphone_threshold_reset(microphone_threshold_monitor *monitor)
{
    int k;

    for (k = 0; k < 2; ++k) {
        monitor->age[k] = 0u;
    }
}

void microphone_threshold_step(
    microphone_threshold_monitor *monitor,
    const microphone_threshold_samples *samples,
    microphone_threshold_residuals *residuals)
{
    run_r1(monitor, samples, residuals);
    run_r2(monitor, samples, residuals);
}
