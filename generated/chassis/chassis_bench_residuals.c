/* chassis_bench_residuals.c: the residuals of ChassisBench; generated, see the header. */
#include "chassis_bench_residuals.h"


#if defined __FINITE_MATH_ONLY__ && __FINITE_MATH_ONLY__
#error "this code tells numbers from NaN: compile it without -ffinite-math-only (-ffast-math)"
#endif

typedef chassis_bench_real real;

#define REAL(x) CHASSIS_BENCH_CONSTANT(x)
#if defined CHASSIS_BENCH_FLOAT && !defined CHASSIS_BENCH_REAL
#define SLOWEST REAL(0.0001)
#else
#define SLOWEST REAL(1.0e-09)
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

uint32_t chassis_bench_abi(void)
{
    return CHASSIS_BENCH_ABI;
}

const char *chassis_bench_digest(void)
{
    return CHASSIS_BENCH_DIGEST;
}

void chassis_bench_nominal(chassis_bench_parameters *parameters)
{
    parameters->body__m = REAL(0.25);     /* kg */
    parameters->body__fm = REAL(0.0001);  /* N.s/m */
    parameters->body__d = REAL(0.04);     /* m */
    parameters->body__Iz = REAL(0.0058);  /* kg.m^2 */
    parameters->body__fz = REAL(0.0005);  /* N.m.s/rad */
}

/* The coefficients of exact and of the filter, from the parameters. */
static void compute_coefficients(chassis_bench_monitor *monitor, const chassis_bench_parameters *p,
        real sample_time, real bandwidth)
{
    chassis_bench_coefficients *c = &monitor->c;

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

    /* khepera.bg:93: r1: factor of u: body.fm */
    c->r1_u = p->body__fm;

    /* khepera.bg:93: r1: factor of u': body.m */
    c->r1_u_1 = p->body__m;

    /* khepera.bg:93: r1: factor of u' */
    c->r1_w1_u = p->body__m * w;

    /* filter: 1 * (w*sample_time)^2/12 */
    c->bend1 = turn * turn / REAL(12.0);

    /* filter: what is left of a memory a sample later */
    c->a = pole;

    /* filter: weight of a sample, new and a sample later */
    c->b = REAL(0.5) * t;

    /* filter: 1 - b, the memory of a constant 1 */
    c->rest = REAL(1.0) - REAL(0.5) * t;

    /* khepera.bg:101: r2: factor of yaw: body.fz */
    c->r2_yaw = p->body__fz;

    /* khepera.bg:101: r2: factor of yaw': body.Iz */
    c->r2_yaw_1 = p->body__Iz;

    /* khepera.bg:101: r2: factor of body.Fx[1]: body.d/2 */
    c->r2_body__Fx__1 = REAL(0.5) * p->body__d;

    /* khepera.bg:101: r2: factor of yaw' */
    c->r2_w1_yaw = p->body__Iz * w;
}

static bool parameters_are_finite(const chassis_bench_parameters *p)
{
    return finite_number(p->body__m + p->body__fm + p->body__d + p->body__Iz + p->body__fz);
}

static bool coefficients_are_finite(const chassis_bench_monitor *monitor)
{
    return finite_number(monitor->c.r1_u + monitor->c.r1_u_1 + monitor->c.r1_w1_u + monitor->c.bend1
            + monitor->c.a + monitor->c.b + monitor->c.rest + monitor->c.r2_yaw
            + monitor->c.r2_yaw_1 + monitor->c.r2_body__Fx__1 + monitor->c.r2_w1_yaw);
}

/* Samples until `constants` time constants of the filter are over. */
static uint32_t samples(real constants, real sample_time, real bandwidth)
{
    const real wait = constants / (bandwidth * sample_time);
    const uint32_t whole = wait < REAL(4.0e9) ? (uint32_t)wait : UINT32_MAX - 1u;

    return (real)whole < wait ? whole + 1u : whole;
}

chassis_bench_status chassis_bench_configure(
    chassis_bench_monitor *monitor,
    const chassis_bench_parameters *parameters,
    chassis_bench_real sample_time,
    chassis_bench_real bandwidth,
    chassis_bench_real time_unit)
{
    int k;

    for (k = 0; k < CHASSIS_BENCH_RESIDUALS; ++k) {
        monitor->settle[k] = UINT32_MAX;
    }
    chassis_bench_reset(monitor);
    if (!parameters_are_finite(parameters)) {
        return CHASSIS_BENCH_BAD_PARAMETER;
    }
    if (!(sample_time > REAL(0.0)) || !finite_number(sample_time)) {
        return CHASSIS_BENCH_BAD_SAMPLE_TIME;
    }
    if (!(bandwidth * sample_time >= SLOWEST && bandwidth * sample_time <= REAL(3.0))) {
        return CHASSIS_BENCH_BAD_BANDWIDTH;
    }
    if (!(time_unit > REAL(0.0)) || !finite_number(time_unit)) {
        return CHASSIS_BENCH_BAD_TIME_UNIT;
    }
    compute_coefficients(monitor, parameters, sample_time, bandwidth);
    if (!coefficients_are_finite(monitor)) {
        return CHASSIS_BENCH_BAD_COEFFICIENT;
    }
    monitor->settle[CHASSIS_BENCH_R1] = samples(REAL(9.233413476451586), sample_time, bandwidth);
    monitor->settle[CHASSIS_BENCH_R2] = samples(REAL(9.233413476451586), sample_time, bandwidth);
    return CHASSIS_BENCH_OK;
}

void chassis_bench_exact(
    const chassis_bench_monitor *monitor,
    const chassis_bench_derivatives *derivatives,
    chassis_bench_real residuals[CHASSIS_BENCH_RESIDUALS])
{
    const chassis_bench_coefficients *c = &monitor->c;
    const chassis_bench_derivatives *d = derivatives;
    real *r = residuals;

    /* khepera.bg:93: r1 = body.Fx[1] + body.Fx[2] - body.fm*u - body.m*D(u) */
    r[CHASSIS_BENCH_R1] = d->body__Fx__1 + d->body__Fx__2 - c->r1_u * d->u[0] - c->r1_u_1 * d->u[1];

    /* khepera.bg:101: r2 = body.Fx[1]*body.d/2 - body.fz*yaw - body.Fx[2]*body.d/2 -
     * body.Iz*D(yaw) */
    r[CHASSIS_BENCH_R2] = c->r2_body__Fx__1 * d->body__Fx__1 - c->r2_yaw * d->yaw[0]
        - c->r2_yaw_1 * d->yaw[1] - c->r2_body__Fx__1 * d->body__Fx__2;
}

/* r1 on its first sample: the filter as if it had always been so. */
static void start_r1(
    chassis_bench_monitor *monitor, const chassis_bench_samples *s, real *r)
{
    const chassis_bench_coefficients *c = &monitor->c;
    chassis_bench_memory *x = &monitor->x;

    /* khepera.bg:93: r1: terms of order 0 */
    const real r1_g0 = s->body__Fx__1 + s->body__Fx__2 - c->r1_u * s->u;

    /* khepera.bg:93: r1: degree 1 */
    const real r1_d1 = c->r1_w1_u * s->u;

    /* khepera.bg:93: r1: error of order 0 */
    const real r1_e0 = c->bend1 * r1_g0;

    /* khepera.bg:93: r1: input of stage 2 */
    const real r1_u2 = r1_g0 + r1_d1 - r1_e0;

    /* khepera.bg:93: r1: stage 2, at rest */
    const real r1_y2 = r1_u2;

    /* khepera.bg:93: r1: stage 2: memory */
    x->r1_s2 = c->rest * r1_u2;

    /* khepera.bg:93: r1: input of stage 1 */
    const real r1_u1 = r1_y2 + REAL(2.0) * r1_e0 - r1_d1;

    /* khepera.bg:93: r1: stage 1, at rest */
    const real r1_y1 = r1_u1;

    /* khepera.bg:93: r1: stage 1: memory */
    x->r1_s1 = c->rest * r1_u1;

    /* khepera.bg:93: r1 = body.Fx[1] + body.Fx[2] - body.fm*u - body.m*D(u) */
    r[CHASSIS_BENCH_R1] = r1_y1 - r1_e0;
}

/* r1 on every further sample. */
static void next_r1(
    chassis_bench_monitor *monitor, const chassis_bench_samples *s, real *r)
{
    const chassis_bench_coefficients *c = &monitor->c;
    chassis_bench_memory *x = &monitor->x;

    /* khepera.bg:93: r1: terms of order 0 */
    const real r1_g0 = s->body__Fx__1 + s->body__Fx__2 - c->r1_u * s->u;

    /* khepera.bg:93: r1: degree 1 */
    const real r1_d1 = c->r1_w1_u * s->u;

    /* khepera.bg:93: r1: error of order 0 */
    const real r1_e0 = c->bend1 * r1_g0;

    /* khepera.bg:93: r1: input of stage 2 */
    const real r1_u2 = r1_g0 + r1_d1 - r1_e0;

    /* khepera.bg:93: r1: stage 2 */
    const real r1_y2 = x->r1_s2 + c->b * r1_u2;

    /* khepera.bg:93: r1: stage 2: memory */
    x->r1_s2 = c->a * r1_y2 + c->b * r1_u2;

    /* khepera.bg:93: r1: input of stage 1 */
    const real r1_u1 = r1_y2 + REAL(2.0) * r1_e0 - r1_d1;

    /* khepera.bg:93: r1: stage 1 */
    const real r1_y1 = x->r1_s1 + c->b * r1_u1;

    /* khepera.bg:93: r1: stage 1: memory */
    x->r1_s1 = c->a * r1_y1 + c->b * r1_u1;

    /* khepera.bg:93: r1 = body.Fx[1] + body.Fx[2] - body.fm*u - body.m*D(u) */
    r[CHASSIS_BENCH_R1] = r1_y1 - r1_e0;
}

/* One sample for r1; a number that is not finite makes the next sample the first. */
static void run_r1(
    chassis_bench_monitor *monitor, const chassis_bench_samples *s, chassis_bench_residuals *residuals)
{
    real *r = residuals->value;
    uint32_t age = monitor->age[0];

    if (age == 0u) {
        start_r1(monitor, s, r);
    } else {
        next_r1(monitor, s, r);
    }
    /* a sum is finite only if all its terms are */
    if (finite_number(s->body__Fx__1 + s->body__Fx__2 + s->u + r[CHASSIS_BENCH_R1])) {
        age += age < UINT32_MAX ? 1u : 0u;
    } else {
        age = 0u;
        r[CHASSIS_BENCH_R1] = REAL(0.0);
    }
    monitor->age[0] = age;
    residuals->valid[CHASSIS_BENCH_R1] = age > monitor->settle[CHASSIS_BENCH_R1];
}

/* r2 on its first sample: the filter as if it had always been so. */
static void start_r2(
    chassis_bench_monitor *monitor, const chassis_bench_samples *s, real *r)
{
    const chassis_bench_coefficients *c = &monitor->c;
    chassis_bench_memory *x = &monitor->x;

    /* khepera.bg:101: r2: terms of order 0 */
    const real r2_g0 = c->r2_body__Fx__1 * s->body__Fx__1 - c->r2_yaw * s->yaw
        - c->r2_body__Fx__1 * s->body__Fx__2;

    /* khepera.bg:101: r2: degree 1 */
    const real r2_d1 = c->r2_w1_yaw * s->yaw;

    /* khepera.bg:101: r2: error of order 0 */
    const real r2_e0 = c->bend1 * r2_g0;

    /* khepera.bg:101: r2: input of stage 2 */
    const real r2_u2 = r2_g0 + r2_d1 - r2_e0;

    /* khepera.bg:101: r2: stage 2, at rest */
    const real r2_y2 = r2_u2;

    /* khepera.bg:101: r2: stage 2: memory */
    x->r2_s2 = c->rest * r2_u2;

    /* khepera.bg:101: r2: input of stage 1 */
    const real r2_u1 = r2_y2 + REAL(2.0) * r2_e0 - r2_d1;

    /* khepera.bg:101: r2: stage 1, at rest */
    const real r2_y1 = r2_u1;

    /* khepera.bg:101: r2: stage 1: memory */
    x->r2_s1 = c->rest * r2_u1;

    /* khepera.bg:101: r2 = body.Fx[1]*body.d/2 - body.fz*yaw - body.Fx[2]*body.d/2 -
     * body.Iz*D(yaw) */
    r[CHASSIS_BENCH_R2] = r2_y1 - r2_e0;
}

/* r2 on every further sample. */
static void next_r2(
    chassis_bench_monitor *monitor, const chassis_bench_samples *s, real *r)
{
    const chassis_bench_coefficients *c = &monitor->c;
    chassis_bench_memory *x = &monitor->x;

    /* khepera.bg:101: r2: terms of order 0 */
    const real r2_g0 = c->r2_body__Fx__1 * s->body__Fx__1 - c->r2_yaw * s->yaw
        - c->r2_body__Fx__1 * s->body__Fx__2;

    /* khepera.bg:101: r2: degree 1 */
    const real r2_d1 = c->r2_w1_yaw * s->yaw;

    /* khepera.bg:101: r2: error of order 0 */
    const real r2_e0 = c->bend1 * r2_g0;

    /* khepera.bg:101: r2: input of stage 2 */
    const real r2_u2 = r2_g0 + r2_d1 - r2_e0;

    /* khepera.bg:101: r2: stage 2 */
    const real r2_y2 = x->r2_s2 + c->b * r2_u2;

    /* khepera.bg:101: r2: stage 2: memory */
    x->r2_s2 = c->a * r2_y2 + c->b * r2_u2;

    /* khepera.bg:101: r2: input of stage 1 */
    const real r2_u1 = r2_y2 + REAL(2.0) * r2_e0 - r2_d1;

    /* khepera.bg:101: r2: stage 1 */
    const real r2_y1 = x->r2_s1 + c->b * r2_u1;

    /* khepera.bg:101: r2: stage 1: memory */
    x->r2_s1 = c->a * r2_y1 + c->b * r2_u1;

    /* khepera.bg:101: r2 = body.Fx[1]*body.d/2 - body.fz*yaw - body.Fx[2]*body.d/2 -
     * body.Iz*D(yaw) */
    r[CHASSIS_BENCH_R2] = r2_y1 - r2_e0;
}

/* One sample for r2; a number that is not finite makes the next sample the first. */
static void run_r2(
    chassis_bench_monitor *monitor, const chassis_bench_samples *s, chassis_bench_residuals *residuals)
{
    real *r = residuals->value;
    uint32_t age = monitor->age[1];

    if (age == 0u) {
        start_r2(monitor, s, r);
    } else {
        next_r2(monitor, s, r);
    }
    /* a sum is finite only if all its terms are */
    if (finite_number(s->body__Fx__1 + s->body__Fx__2 + s->yaw + r[CHASSIS_BENCH_R2])) {
        age += age < UINT32_MAX ? 1u : 0u;
    } else {
        age = 0u;
        r[CHASSIS_BENCH_R2] = REAL(0.0);
    }
    monitor->age[1] = age;
    residuals->valid[CHASSIS_BENCH_R2] = age > monitor->settle[CHASSIS_BENCH_R2];
}

void chassis_bench_reset(chassis_bench_monitor *monitor)
{
    int k;

    for (k = 0; k < 2; ++k) {
        monitor->age[k] = 0u;
    }
}

void chassis_bench_step(
    chassis_bench_monitor *monitor,
    const chassis_bench_samples *samples,
    chassis_bench_residuals *residuals)
{
    run_r1(monitor, samples, residuals);
    run_r2(monitor, samples, residuals);
}
