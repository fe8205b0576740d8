/* motor_threshold.c: the thresholds of Motor_threshold; generated, see the header. */
#include "motor_threshold.h"

#include <math.h>

#if defined __FINITE_MATH_ONLY__ && __FINITE_MATH_ONLY__
#error "this code tells numbers from NaN: compile it without -ffinite-math-only (-ffast-math)"
#endif

typedef motor_threshold_real real;

#define REAL(x) MOTOR_THRESHOLD_CONSTANT(x)
#if defined MOTOR_THRESHOLD_FLOAT && !defined MOTOR_THRESHOLD_REAL
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

uint32_t motor_threshold_abi(void)
{
    return MOTOR_THRESHOLD_ABI;
}

const char *motor_threshold_digest(void)
{
    return MOTOR_THRESHOLD_DIGEST;
}

void motor_threshold_nominal(motor_threshold_parameters *parameters)
{
    parameters->R = REAL(17.6);      /* Ohm */
    parameters->k = REAL(0.00351);   /* N.m/A */
    parameters->f = REAL(1.19e-05);  /* N.m.s/rad */
}

/* The coefficients of exact and of the filter, from the parameters. */
static void compute_coefficients(motor_threshold_monitor *monitor,
        const motor_threshold_parameters *p, real sample_time, real bandwidth)
{
    motor_threshold_coefficients *c = &monitor->c;

    /* bandwidth*sample_time */
    const real x_ = bandwidth * sample_time;

    /* of a stage: what is left of its memory */
    const real pole = greatest(REAL(2.0) - x_, REAL(0.0)) / (x_ + REAL(2.0));

    /* 1 - pole */
    const real t = REAL(1.0) - pole;

    /* dc_motor.bg:13: r1_w1: factor of current */
    c->r1_w1_current = p->R / REAL(20.0);

    /* filter: what is left of a memory a sample later */
    c->a = pole;

    /* filter: weight of a sample, new and a sample later */
    c->b = REAL(0.5) * t;

    /* filter: 1 - b, the memory of a constant 1 */
    c->rest = REAL(1.0) - REAL(0.5) * t;

    /* dc_motor.bg:13: r1_w2: factor of speed */
    c->r1_w2_speed = p->k / REAL(50.0);

    /* dc_motor.bg:20: r2_w2: factor of speed */
    c->r2_w2_speed = p->f / REAL(10.0);
}

static bool parameters_are_finite(const motor_threshold_parameters *p)
{
    return finite_number(p->R + p->k + p->f);
}

static bool coefficients_are_finite(const motor_threshold_monitor *monitor)
{
    return finite_number(monitor->c.r1_w1_current + monitor->c.a + monitor->c.b + monitor->c.rest
            + monitor->c.r1_w2_speed + monitor->c.r2_w2_speed);
}

/* Samples until `constants` time constants of the filter are over. */
static uint32_t samples(real constants, real sample_time, real bandwidth)
{
    const real wait = constants / (bandwidth * sample_time);
    const uint32_t whole = wait < REAL(4.0e9) ? (uint32_t)wait : UINT32_MAX - 1u;

    return (real)whole < wait ? whole + 1u : whole;
}

motor_threshold_status motor_threshold_configure(
    motor_threshold_monitor *monitor,
    const motor_threshold_parameters *parameters,
    motor_threshold_real sample_time,
    motor_threshold_real bandwidth,
    motor_threshold_real time_unit)
{
    int k;

    for (k = 0; k < MOTOR_THRESHOLD_RESIDUALS; ++k) {
        monitor->settle[k] = UINT32_MAX;
    }
    motor_threshold_reset(monitor);
    if (!parameters_are_finite(parameters)) {
        return MOTOR_THRESHOLD_BAD_PARAMETER;
    }
    if (!(sample_time > REAL(0.0)) || !finite_number(sample_time)) {
        return MOTOR_THRESHOLD_BAD_SAMPLE_TIME;
    }
    if (!(bandwidth * sample_time >= SLOWEST && bandwidth * sample_time <= REAL(3.0))) {
        return MOTOR_THRESHOLD_BAD_BANDWIDTH;
    }
    if (!(time_unit > REAL(0.0)) || !finite_number(time_unit)) {
        return MOTOR_THRESHOLD_BAD_TIME_UNIT;
    }
    compute_coefficients(monitor, parameters, sample_time, bandwidth);
    if (!coefficients_are_finite(monitor)) {
        return MOTOR_THRESHOLD_BAD_COEFFICIENT;
    }
    monitor->settle[MOTOR_THRESHOLD_R1] = samples(REAL(9.233413476451586), sample_time, bandwidth);
    monitor->settle[MOTOR_THRESHOLD_R2] = samples(REAL(9.233413476451586), sample_time, bandwidth);
    return MOTOR_THRESHOLD_OK;
}

void motor_threshold_exact(
    const motor_threshold_monitor *monitor,
    const motor_threshold_derivatives *derivatives,
    motor_threshold_real residuals[MOTOR_THRESHOLD_RESIDUALS])
{
    real *r = residuals;

    (void)monitor;
    (void)derivatives;

    /* dc_motor.bg:13: r1: a threshold is made of filtered signals, only step has it */
    r[MOTOR_THRESHOLD_R1] = (real)NAN;

    /* dc_motor.bg:20: r2: a threshold is made of filtered signals, only step has it */
    r[MOTOR_THRESHOLD_R2] = (real)NAN;
}

/* r1 on its first sample: the filter as if it had always been so. */
static void start_r1(
    motor_threshold_monitor *monitor, const motor_threshold_samples *s, real *r)
{
    const motor_threshold_coefficients *c = &monitor->c;
    motor_threshold_memory *x = &monitor->x;

    /* dc_motor.bg:13: r1_w1: input of stage 2 */
    const real r1_w1_u2 = -c->r1_w1_current * s->current;

    /* dc_motor.bg:13: r1_w1: stage 2, at rest */
    const real r1_w1_y2 = r1_w1_u2;

    /* dc_motor.bg:13: r1_w1: stage 2: memory */
    x->r1_w1_s2 = c->rest * r1_w1_u2;

    /* dc_motor.bg:13: r1_w1: input of stage 1 */
    const real r1_w1_u1 = r1_w1_y2;

    /* dc_motor.bg:13: r1_w1: stage 1, at rest */
    const real r1_w1_y1 = r1_w1_u1;

    /* dc_motor.bg:13: r1_w1: stage 1: memory */
    x->r1_w1_s1 = c->rest * r1_w1_u1;

    /* dc_motor.bg:13: r1: what the tolerance of R can do */
    const real r1_w1 = r1_w1_y1;

    /* dc_motor.bg:13: r1_w2: input of stage 2 */
    const real r1_w2_u2 = -c->r1_w2_speed * s->speed;

    /* dc_motor.bg:13: r1_w2: stage 2, at rest */
    const real r1_w2_y2 = r1_w2_u2;

    /* dc_motor.bg:13: r1_w2: stage 2: memory */
    x->r1_w2_s2 = c->rest * r1_w2_u2;

    /* dc_motor.bg:13: r1_w2: input of stage 1 */
    const real r1_w2_u1 = r1_w2_y2;

    /* dc_motor.bg:13: r1_w2: stage 1, at rest */
    const real r1_w2_y1 = r1_w2_u1;

    /* dc_motor.bg:13: r1_w2: stage 1: memory */
    x->r1_w2_s1 = c->rest * r1_w2_u1;

    /* dc_motor.bg:13: r1: what the tolerance of k can do */
    const real r1_w2 = r1_w2_y1;

    /* dc_motor.bg:13: r1: how far r1 can be from zero if no parameter is out of tolerance */
    r[MOTOR_THRESHOLD_R1] = MATH(fabs)(r1_w1) + MATH(fabs)(r1_w2);
}

/* r1 on every further sample. */
static void next_r1(
    motor_threshold_monitor *monitor, const motor_threshold_samples *s, real *r)
{
    const motor_threshold_coefficients *c = &monitor->c;
    motor_threshold_memory *x = &monitor->x;

    /* dc_motor.bg:13: r1_w1: input of stage 2 */
    const real r1_w1_u2 = -c->r1_w1_current * s->current;

    /* dc_motor.bg:13: r1_w1: stage 2 */
    const real r1_w1_y2 = x->r1_w1_s2 + c->b * r1_w1_u2;

    /* dc_motor.bg:13: r1_w1: stage 2: memory */
    x->r1_w1_s2 = c->a * r1_w1_y2 + c->b * r1_w1_u2;

    /* dc_motor.bg:13: r1_w1: input of stage 1 */
    const real r1_w1_u1 = r1_w1_y2;

    /* dc_motor.bg:13: r1_w1: stage 1 */
    const real r1_w1_y1 = x->r1_w1_s1 + c->b * r1_w1_u1;

    /* dc_motor.bg:13: r1_w1: stage 1: memory */
    x->r1_w1_s1 = c->a * r1_w1_y1 + c->b * r1_w1_u1;

    /* dc_motor.bg:13: r1: what the tolerance of R can do */
    const real r1_w1 = r1_w1_y1;

    /* dc_motor.bg:13: r1_w2: input of stage 2 */
    const real r1_w2_u2 = -c->r1_w2_speed * s->speed;

    /* dc_motor.bg:13: r1_w2: stage 2 */
    const real r1_w2_y2 = x->r1_w2_s2 + c->b * r1_w2_u2;

    /* dc_motor.bg:13: r1_w2: stage 2: memory */
    x->r1_w2_s2 = c->a * r1_w2_y2 + c->b * r1_w2_u2;

    /* dc_motor.bg:13: r1_w2: input of stage 1 */
    const real r1_w2_u1 = r1_w2_y2;

    /* dc_motor.bg:13: r1_w2: stage 1 */
    const real r1_w2_y1 = x->r1_w2_s1 + c->b * r1_w2_u1;

    /* dc_motor.bg:13: r1_w2: stage 1: memory */
    x->r1_w2_s1 = c->a * r1_w2_y1 + c->b * r1_w2_u1;

    /* dc_motor.bg:13: r1: what the tolerance of k can do */
    const real r1_w2 = r1_w2_y1;

    /* dc_motor.bg:13: r1: how far r1 can be from zero if no parameter is out of tolerance */
    r[MOTOR_THRESHOLD_R1] = MATH(fabs)(r1_w1) + MATH(fabs)(r1_w2);
}

/* One sample for r1; a number that is not finite makes the next sample the first. */
static void run_r1(
    motor_threshold_monitor *monitor, const motor_threshold_samples *s, motor_threshold_residuals *residuals)
{
    real *r = residuals->value;
    uint32_t age = monitor->age[0];

    if (age == 0u) {
        start_r1(monitor, s, r);
    } else {
        next_r1(monitor, s, r);
    }
    /* a sum is finite only if all its terms are */
    if (finite_number(s->current + s->speed + r[MOTOR_THRESHOLD_R1])) {
        age += age < UINT32_MAX ? 1u : 0u;
    } else {
        age = 0u;
        r[MOTOR_THRESHOLD_R1] = REAL(0.0);
    }
    monitor->age[0] = age;
    residuals->valid[MOTOR_THRESHOLD_R1] = age > monitor->settle[MOTOR_THRESHOLD_R1];
}

/* r2 on its first sample: the filter as if it had always been so. */
static void start_r2(
    motor_threshold_monitor *monitor, const motor_threshold_samples *s, real *r)
{
    const motor_threshold_coefficients *c = &monitor->c;
    motor_threshold_memory *x = &monitor->x;

    /* dc_motor.bg:20: r2_w1: input of stage 2 */
    const real r2_w1_u2 = -c->r1_w2_speed * s->current;

    /* dc_motor.bg:20: r2_w1: stage 2, at rest */
    const real r2_w1_y2 = r2_w1_u2;

    /* dc_motor.bg:20: r2_w1: stage 2: memory */
    x->r2_w1_s2 = c->rest * r2_w1_u2;

    /* dc_motor.bg:20: r2_w1: input of stage 1 */
    const real r2_w1_u1 = r2_w1_y2;

    /* dc_motor.bg:20: r2_w1: stage 1, at rest */
    const real r2_w1_y1 = r2_w1_u1;

    /* dc_motor.bg:20: r2_w1: stage 1: memory */
    x->r2_w1_s1 = c->rest * r2_w1_u1;

    /* dc_motor.bg:20: r2: what the tolerance of k can do */
    const real r2_w1 = r2_w1_y1;

    /* dc_motor.bg:20: r2_w2: input of stage 2 */
    const real r2_w2_u2 = c->r2_w2_speed * s->speed;

    /* dc_motor.bg:20: r2_w2: stage 2, at rest */
    const real r2_w2_y2 = r2_w2_u2;

    /* dc_motor.bg:20: r2_w2: stage 2: memory */
    x->r2_w2_s2 = c->rest * r2_w2_u2;

    /* dc_motor.bg:20: r2_w2: input of stage 1 */
    const real r2_w2_u1 = r2_w2_y2;

    /* dc_motor.bg:20: r2_w2: stage 1, at rest */
    const real r2_w2_y1 = r2_w2_u1;

    /* dc_motor.bg:20: r2_w2: stage 1: memory */
    x->r2_w2_s1 = c->rest * r2_w2_u1;

    /* dc_motor.bg:20: r2: what the tolerance of f can do */
    const real r2_w2 = r2_w2_y1;

    /* dc_motor.bg:20: r2: how far r2 can be from zero if no parameter is out of tolerance */
    r[MOTOR_THRESHOLD_R2] = MATH(fabs)(r2_w1) + MATH(fabs)(r2_w2);
}

/* r2 on every further sample. */
static void next_r2(
    motor_threshold_monitor *monitor, const motor_threshold_samples *s, real *r)
{
    const motor_threshold_coefficients *c = &monitor->c;
    motor_threshold_memory *x = &monitor->x;

    /* dc_motor.bg:20: r2_w1: input of stage 2 */
    const real r2_w1_u2 = -c->r1_w2_speed * s->current;

    /* dc_motor.bg:20: r2_w1: stage 2 */
    const real r2_w1_y2 = x->r2_w1_s2 + c->b * r2_w1_u2;

    /* dc_motor.bg:20: r2_w1: stage 2: memory */
    x->r2_w1_s2 = c->a * r2_w1_y2 + c->b * r2_w1_u2;

    /* dc_motor.bg:20: r2_w1: input of stage 1 */
    const real r2_w1_u1 = r2_w1_y2;

    /* dc_motor.bg:20: r2_w1: stage 1 */
    const real r2_w1_y1 = x->r2_w1_s1 + c->b * r2_w1_u1;

    /* dc_motor.bg:20: r2_w1: stage 1: memory */
    x->r2_w1_s1 = c->a * r2_w1_y1 + c->b * r2_w1_u1;

    /* dc_motor.bg:20: r2: what the tolerance of k can do */
    const real r2_w1 = r2_w1_y1;

    /* dc_motor.bg:20: r2_w2: input of stage 2 */
    const real r2_w2_u2 = c->r2_w2_speed * s->speed;

    /* dc_motor.bg:20: r2_w2: stage 2 */
    const real r2_w2_y2 = x->r2_w2_s2 + c->b * r2_w2_u2;

    /* dc_motor.bg:20: r2_w2: stage 2: memory */
    x->r2_w2_s2 = c->a * r2_w2_y2 + c->b * r2_w2_u2;

    /* dc_motor.bg:20: r2_w2: input of stage 1 */
    const real r2_w2_u1 = r2_w2_y2;

    /* dc_motor.bg:20: r2_w2: stage 1 */
    const real r2_w2_y1 = x->r2_w2_s1 + c->b * r2_w2_u1;

    /* dc_motor.bg:20: r2_w2: stage 1: memory */
    x->r2_w2_s1 = c->a * r2_w2_y1 + c->b * r2_w2_u1;

    /* dc_motor.bg:20: r2: what the tolerance of f can do */
    const real r2_w2 = r2_w2_y1;

    /* dc_motor.bg:20: r2: how far r2 can be from zero if no parameter is out of tolerance */
    r[MOTOR_THRESHOLD_R2] = MATH(fabs)(r2_w1) + MATH(fabs)(r2_w2);
}

/* One sample for r2; a number that is not finite makes the next sample the first. */
static void run_r2(
    motor_threshold_monitor *monitor, const motor_threshold_samples *s, motor_threshold_residuals *residuals)
{
    real *r = residuals->value;
    uint32_t age = monitor->age[1];

    if (age == 0u) {
        start_r2(monitor, s, r);
    } else {
        next_r2(monitor, s, r);
    }
    /* a sum is finite only if all its terms are */
    if (finite_number(s->current + s->speed + r[MOTOR_THRESHOLD_R2])) {
        age += age < UINT32_MAX ? 1u : 0u;
    } else {
        age = 0u;
        r[MOTOR_THRESHOLD_R2] = REAL(0.0);
    }
    monitor->age[1] = age;
    residuals->valid[MOTOR_THRESHOLD_R2] = age > monitor->settle[MOTOR_THRESHOLD_R2];
}

void motor_threshold_reset(motor_threshold_monitor *monitor)
{
    int k;

    for (k = 0; k < 2; ++k) {
        monitor->age[k] = 0u;
    }
}

void motor_threshold_step(
    motor_threshold_monitor *monitor,
    const motor_threshold_samples *samples,
    motor_threshold_residuals *residuals)
{
    run_r1(monitor, samples, residuals);
    run_r2(monitor, samples, residuals);
}
