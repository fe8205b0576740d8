/* motor_residuals.c: the residuals of Motor; generated, see the header. */
#include "motor_residuals.h"


#if defined __FINITE_MATH_ONLY__ && __FINITE_MATH_ONLY__
#error "this code tells numbers from NaN: compile it without -ffinite-math-only (-ffast-math)"
#endif

typedef motor_real real;

#define REAL(x) MOTOR_CONSTANT(x)
#if defined MOTOR_FLOAT && !defined MOTOR_REAL
#define SLOWEST REAL(0.0001)
#else
#define SLOWEST REAL(1.0e-09)
#endif

/* Neither NaN nor infinite: infinity minus infinity is NaN, and NaN is not 0. */
static bool finite_number(real value)
{
    return value - value <= REAL(0.0);
}

/* exp(value) to the last digit or two, without a library: 2^n times the series of the rest. */
static real exponential(real value)
{
    const real ln2_high = REAL(0.693145751953125); /* few bits: n * ln2_high is exact */
    const real ln2_low = REAL(1.4286068203094173e-06);
    real rest;
    real scale = REAL(1.0);
    real sum = REAL(1.0);
    int n = 0;
    int k;

    if (value > REAL(1000.0)) {
        value = REAL(1000.0); /* more than enough for infinity */
    }
    if (value < REAL(-1000.0)) {
        value = REAL(-1000.0); /* more than enough for zero */
    }
    rest = value;
    while (rest > REAL(0.35)) {
        ++n;
        scale *= REAL(2.0);
        rest = value - (real)n * ln2_high;
    }
    while (rest < REAL(-0.35)) {
        --n;
        scale *= REAL(0.5);
        rest = value - (real)n * ln2_high;
    }
    rest -= (real)n * ln2_low;
    for (k = 14; k > 0; --k) {
        sum = REAL(1.0) + sum * rest / (real)k;
    }
    return sum * scale;
}

uint32_t motor_abi(void)
{
    return MOTOR_ABI;
}

const char *motor_digest(void)
{
    return MOTOR_DIGEST;
}

void motor_nominal(motor_parameters *parameters)
{
    parameters->L = REAL(0.0003);    /* H */
    parameters->R = REAL(17.6);      /* Ohm */
    parameters->k = REAL(0.00351);   /* N.m/A */
    parameters->J = REAL(1.4e-08);   /* kg.m^2 */
    parameters->f = REAL(1.19e-05);  /* N.m.s/rad */
}

/* The coefficients of exact and of the filter, from the parameters. */
static void compute_coefficients(motor_monitor *monitor, const motor_parameters *p,
        real sample_time, real bandwidth)
{
    motor_coefficients *c = &monitor->c;

    /* bandwidth*sample_time */
    const real x_ = bandwidth * sample_time;

    /* exp(-x) */
    const real t = exponential(-x_);

    /* if(x < 0.125, x*(0.5 - x*(1/6 - x*(1/24 - x*(1/120 - x*(1/720 - x/5040))))), 1 - (1 - ... */
    const real t_2 = x_ < REAL(0.125)
        ? x_ * (REAL(0.5)
            - x_ * (REAL(1.0) / REAL(6.0)
                - x_ * (REAL(1.0) / REAL(24.0)
                    - x_ * (REAL(1.0) / REAL(120.0)
                        - x_ * (REAL(1.0) / REAL(720.0) - x_ / REAL(5040.0))))))
        : REAL(1.0) - (REAL(1.0) - t) / x_;

    /* dc_motor.bg:13: r1: factor of speed: k */
    c->r1_speed = p->k;

    /* dc_motor.bg:13: r1: factor of current: R */
    c->r1_current = p->R;

    /* dc_motor.bg:13: r1: factor of current': L */
    c->r1_current_1 = p->L;

    /* dc_motor.bg:13: r1: factor of current in stage 1 */
    c->r1_v1_current = p->L * bandwidth;

    /* dc_motor.bg:13: r1: factor of current in stage 2 */
    c->r1_v2_current = p->L * bandwidth - p->R;

    /* filter: exp(-bandwidth*sample_time) */
    c->a = t;

    /* filter: weight of the new sample */
    c->b0 = t_2;

    /* filter: weight of the sample before */
    c->b1 = REAL(1.0) - t - t_2;

    /* filter: 1 - b0, the memory of a constant 1 */
    c->rest = REAL(1.0) - t_2;

    /* dc_motor.bg:20: r2: factor of speed: f */
    c->r2_speed = p->f;

    /* dc_motor.bg:20: r2: factor of speed': J */
    c->r2_speed_1 = p->J;

    /* dc_motor.bg:20: r2: factor of speed in stage 1 */
    c->r2_v1_speed = p->J * bandwidth;

    /* dc_motor.bg:20: r2: factor of speed in stage 2 */
    c->r2_v2_speed = p->f - p->J * bandwidth;
}

static bool parameters_are_finite(const motor_parameters *p)
{
    return finite_number(p->L + p->R + p->k + p->J + p->f);
}

static bool coefficients_are_finite(const motor_monitor *monitor)
{
    return finite_number(monitor->c.r1_speed + monitor->c.r1_current + monitor->c.r1_current_1
            + monitor->c.r1_v1_current + monitor->c.r1_v2_current + monitor->c.a + monitor->c.b0
            + monitor->c.b1 + monitor->c.rest + monitor->c.r2_speed + monitor->c.r2_speed_1
            + monitor->c.r2_v1_speed + monitor->c.r2_v2_speed);
}

/* Samples until `constants` time constants of the filter are over. */
static uint32_t samples(real constants, real sample_time, real bandwidth)
{
    const real wait = constants / (bandwidth * sample_time);
    const uint32_t whole = wait < REAL(4.0e9) ? (uint32_t)wait : UINT32_MAX - 1u;

    return (real)whole < wait ? whole + 1u : whole;
}

motor_status motor_configure(
    motor_monitor *monitor,
    const motor_parameters *parameters,
    motor_real sample_time,
    motor_real bandwidth,
    motor_real time_unit)
{
    int k;

    for (k = 0; k < MOTOR_RESIDUALS; ++k) {
        monitor->settle[k] = UINT32_MAX;
    }
    motor_reset(monitor);
    if (!parameters_are_finite(parameters)) {
        return MOTOR_BAD_PARAMETER;
    }
    if (!(sample_time > REAL(0.0)) || !finite_number(sample_time)) {
        return MOTOR_BAD_SAMPLE_TIME;
    }
    if (!(bandwidth * sample_time >= SLOWEST && bandwidth * sample_time <= REAL(3.0))) {
        return MOTOR_BAD_BANDWIDTH;
    }
    if (!(time_unit > REAL(0.0)) || !finite_number(time_unit)) {
        return MOTOR_BAD_TIME_UNIT;
    }
    compute_coefficients(monitor, parameters, sample_time, bandwidth);
    if (!coefficients_are_finite(monitor)) {
        return MOTOR_BAD_COEFFICIENT;
    }
    monitor->settle[MOTOR_R1] = samples(REAL(9.233413476451586), sample_time, bandwidth);
    monitor->settle[MOTOR_R2] = samples(REAL(9.233413476451586), sample_time, bandwidth);
    return MOTOR_OK;
}

void motor_exact(
    const motor_monitor *monitor,
    const motor_derivatives *derivatives,
    motor_real residuals[MOTOR_RESIDUALS])
{
    const motor_coefficients *c = &monitor->c;
    const motor_derivatives *d = derivatives;
    real *r = residuals;

    /* dc_motor.bg:13: r1 = U - k*speed - R*current - L*D(current) */
    r[MOTOR_R1] = d->U - c->r1_speed * d->speed[0] - c->r1_current * d->current[0]
        - c->r1_current_1 * d->current[1];

    /* dc_motor.bg:20: r2 = load + f*speed + J*D(speed) - k*current */
    r[MOTOR_R2] = d->load + c->r2_speed * d->speed[0] + c->r2_speed_1 * d->speed[1]
        - c->r1_speed * d->current[0];
}

/* r1 on its first sample: the filter as if it had always been so. */
static void start_r1(
    motor_monitor *monitor, const motor_samples *s, real *r)
{
    const motor_coefficients *c = &monitor->c;
    motor_memory *x = &monitor->x;

    /* dc_motor.bg:13: r1: input of stage 2 */
    const real r1_u2 = s->U + c->r1_v2_current * s->current - c->r1_speed * s->speed;

    /* dc_motor.bg:13: r1: stage 2, at rest */
    const real r1_y2 = r1_u2;

    /* dc_motor.bg:13: r1: stage 2: memory */
    x->r1_s2 = c->rest * r1_u2;

    /* dc_motor.bg:13: r1: input of stage 1 */
    const real r1_u1 = r1_y2 - c->r1_v1_current * s->current;

    /* dc_motor.bg:13: r1: stage 1, at rest */
    const real r1_y1 = r1_u1;

    /* dc_motor.bg:13: r1: stage 1: memory */
    x->r1_s1 = c->rest * r1_u1;

    /* dc_motor.bg:13: r1 = U - k*speed - R*current - L*D(current) */
    r[MOTOR_R1] = r1_y1;
}

/* r1 on every further sample. */
static void next_r1(
    motor_monitor *monitor, const motor_samples *s, real *r)
{
    const motor_coefficients *c = &monitor->c;
    motor_memory *x = &monitor->x;

    /* dc_motor.bg:13: r1: input of stage 2 */
    const real r1_u2 = s->U + c->r1_v2_current * s->current - c->r1_speed * s->speed;

    /* dc_motor.bg:13: r1: stage 2 */
    const real r1_y2 = x->r1_s2 + c->b0 * r1_u2;

    /* dc_motor.bg:13: r1: stage 2: memory */
    x->r1_s2 = c->a * r1_y2 + c->b1 * r1_u2;

    /* dc_motor.bg:13: r1: input of stage 1 */
    const real r1_u1 = r1_y2 - c->r1_v1_current * s->current;

    /* dc_motor.bg:13: r1: stage 1 */
    const real r1_y1 = x->r1_s1 + c->b0 * r1_u1;

    /* dc_motor.bg:13: r1: stage 1: memory */
    x->r1_s1 = c->a * r1_y1 + c->b1 * r1_u1;

    /* dc_motor.bg:13: r1 = U - k*speed - R*current - L*D(current) */
    r[MOTOR_R1] = r1_y1;
}

/* One sample for r1; a number that is not finite makes the next sample the first. */
static void run_r1(
    motor_monitor *monitor, const motor_samples *s, motor_residuals *residuals)
{
    real *r = residuals->value;
    uint32_t age = monitor->age[0];

    if (age == 0u) {
        start_r1(monitor, s, r);
    } else {
        next_r1(monitor, s, r);
    }
    /* a sum is finite only if all its terms are */
    if (finite_number(s->U + s->current + s->speed + r[MOTOR_R1])) {
        age += age < UINT32_MAX ? 1u : 0u;
    } else {
        age = 0u;
        r[MOTOR_R1] = REAL(0.0);
    }
    monitor->age[0] = age;
    residuals->valid[MOTOR_R1] = age > monitor->settle[MOTOR_R1];
}

/* r2 on its first sample: the filter as if it had always been so. */
static void start_r2(
    motor_monitor *monitor, const motor_samples *s, real *r)
{
    const motor_coefficients *c = &monitor->c;
    motor_memory *x = &monitor->x;

    /* dc_motor.bg:20: r2: input of stage 2 */
    const real r2_u2 = s->load + c->r2_v2_speed * s->speed - c->r1_speed * s->current;

    /* dc_motor.bg:20: r2: stage 2, at rest */
    const real r2_y2 = r2_u2;

    /* dc_motor.bg:20: r2: stage 2: memory */
    x->r2_s2 = c->rest * r2_u2;

    /* dc_motor.bg:20: r2: input of stage 1 */
    const real r2_u1 = r2_y2 + c->r2_v1_speed * s->speed;

    /* dc_motor.bg:20: r2: stage 1, at rest */
    const real r2_y1 = r2_u1;

    /* dc_motor.bg:20: r2: stage 1: memory */
    x->r2_s1 = c->rest * r2_u1;

    /* dc_motor.bg:20: r2 = load + f*speed + J*D(speed) - k*current */
    r[MOTOR_R2] = r2_y1;
}

/* r2 on every further sample. */
static void next_r2(
    motor_monitor *monitor, const motor_samples *s, real *r)
{
    const motor_coefficients *c = &monitor->c;
    motor_memory *x = &monitor->x;

    /* dc_motor.bg:20: r2: input of stage 2 */
    const real r2_u2 = s->load + c->r2_v2_speed * s->speed - c->r1_speed * s->current;

    /* dc_motor.bg:20: r2: stage 2 */
    const real r2_y2 = x->r2_s2 + c->b0 * r2_u2;

    /* dc_motor.bg:20: r2: stage 2: memory */
    x->r2_s2 = c->a * r2_y2 + c->b1 * r2_u2;

    /* dc_motor.bg:20: r2: input of stage 1 */
    const real r2_u1 = r2_y2 + c->r2_v1_speed * s->speed;

    /* dc_motor.bg:20: r2: stage 1 */
    const real r2_y1 = x->r2_s1 + c->b0 * r2_u1;

    /* dc_motor.bg:20: r2: stage 1: memory */
    x->r2_s1 = c->a * r2_y1 + c->b1 * r2_u1;

    /* dc_motor.bg:20: r2 = load + f*speed + J*D(speed) - k*current */
    r[MOTOR_R2] = r2_y1;
}

/* One sample for r2; a number that is not finite makes the next sample the first. */
static void run_r2(
    motor_monitor *monitor, const motor_samples *s, motor_residuals *residuals)
{
    real *r = residuals->value;
    uint32_t age = monitor->age[1];

    if (age == 0u) {
        start_r2(monitor, s, r);
    } else {
        next_r2(monitor, s, r);
    }
    /* a sum is finite only if all its terms are */
    if (finite_number(s->load + s->current + s->speed + r[MOTOR_R2])) {
        age += age < UINT32_MAX ? 1u : 0u;
    } else {
        age = 0u;
        r[MOTOR_R2] = REAL(0.0);
    }
    monitor->age[1] = age;
    residuals->valid[MOTOR_R2] = age > monitor->settle[MOTOR_R2];
}

void motor_reset(motor_monitor *monitor)
{
    int k;

    for (k = 0; k < 2; ++k) {
        monitor->age[k] = 0u;
    }
}

void motor_step(
    motor_monitor *monitor,
    const motor_samples *samples,
    motor_residuals *residuals)
{
    run_r1(monitor, samples, residuals);
    run_r2(monitor, samples, residuals);
}
