/* rc_loop_residuals.c: the residuals of RcLoop; generated, see the header. */
#include "rc_loop_residuals.h"


#if defined __FINITE_MATH_ONLY__ && __FINITE_MATH_ONLY__
#error "this code tells numbers from NaN: compile it without -ffinite-math-only (-ffast-math)"
#endif

typedef rc_loop_real real;

#define REAL(x) RC_LOOP_CONSTANT(x)
#if defined RC_LOOP_FLOAT && !defined RC_LOOP_REAL
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

uint32_t rc_loop_abi(void)
{
    return RC_LOOP_ABI;
}

const char *rc_loop_digest(void)
{
    return RC_LOOP_DIGEST;
}

void rc_loop_nominal(rc_loop_parameters *parameters)
{
    parameters->R0 = REAL(1000.0);   /* Ohm */
    parameters->Rab = REAL(2200.0);  /* Ohm */
    parameters->Rbc = REAL(4700.0);  /* Ohm */
    parameters->Rca = REAL(3300.0);  /* Ohm */
    parameters->Ca = REAL(1.0e-06);  /* F */
    parameters->Cc = REAL(4.7e-07);  /* F */
}

/* The coefficients of exact and of the filter, from the parameters. */
static void compute_coefficients(rc_loop_monitor *monitor, const rc_loop_parameters *p,
        real sample_time, real bandwidth)
{
    rc_loop_coefficients *c = &monitor->c;

    /* bandwidth*sample_time */
    const real x_ = bandwidth * sample_time;

    /* of a stage: what is left of its memory */
    const real pole = greatest(REAL(2.0) - x_, REAL(0.0)) / (x_ + REAL(2.0));

    /* w*sample_time, x or 2 */
    const real turn = REAL(2.0) * (REAL(1.0) - pole) / (pole + REAL(1.0));

    /* w of the filter 1/(1 + D/w) */
    const real w = turn / sample_time;

    /* rc_loop.bg:14: Rab/Rca */
    const real t = p->Rab / p->Rca;

    /* rc_loop.bg:14: Rab*Ca */
    const real t_2 = p->Rab * p->Ca;

    /* rc_loop.bg:14: R0*Ca */
    const real t_3 = p->R0 * p->Ca;

    /* 1 - pole */
    const real t_4 = REAL(1.0) - pole;

    /* rc_loop.bg:14: r1: factor of ua: Rab/Rca + 1 */
    c->r1_ua = t + REAL(1.0);

    /* rc_loop.bg:14: r1: factor of ua': Rab*Ca + R0*Ca */
    c->r1_ua_1 = t_2 + t_3;

    /* rc_loop.bg:14: r1: factor of uc: Rab/Rca */
    c->r1_uc = t;

    /* rc_loop.bg:14: r1: factor of uc': R0*Cc */
    c->r1_uc_1 = p->R0 * p->Cc;

    /* rc_loop.bg:14: r1: factor of ua' */
    c->r1_w1_ua = (-t_2 - t_3) * w;

    /* rc_loop.bg:14: r1: factor of uc' */
    c->r1_w1_uc = p->R0 * p->Cc * w;

    /* filter: 1 * (w*sample_time)^2/12 */
    c->bend1 = turn * turn / REAL(12.0);

    /* filter: what is left of a memory a sample later */
    c->a = pole;

    /* filter: weight of a sample, new and a sample later */
    c->b = REAL(0.5) * t_4;

    /* filter: 1 - b, the memory of a constant 1 */
    c->rest = REAL(1.0) - REAL(0.5) * t_4;

    /* rc_loop.bg:18: r2: factor of ua: Rab/Rca + Rbc/Rca + 1 */
    c->r2_ua = t + p->Rbc / p->Rca + REAL(1.0);

    /* rc_loop.bg:18: r2: factor of ua': Rab*Ca */
    c->r2_ua_1 = t_2;

    /* rc_loop.bg:18: r2: factor of uc': Rbc*Cc */
    c->r2_uc_1 = p->Rbc * p->Cc;

    /* rc_loop.bg:18: r2: factor of ua' */
    c->r2_w1_ua = p->Rab * p->Ca * w;

    /* rc_loop.bg:18: r2: factor of uc' */
    c->r2_w1_uc = p->Rbc * p->Cc * w;
}

static bool parameters_are_finite(const rc_loop_parameters *p)
{
    return finite_number(p->R0 + p->Rab + p->Rbc + p->Rca + p->Ca + p->Cc);
}

static bool coefficients_are_finite(const rc_loop_monitor *monitor)
{
    return finite_number(monitor->c.r1_ua + monitor->c.r1_ua_1 + monitor->c.r1_uc
            + monitor->c.r1_uc_1 + monitor->c.r1_w1_ua + monitor->c.r1_w1_uc + monitor->c.bend1
            + monitor->c.a + monitor->c.b + monitor->c.rest + monitor->c.r2_ua + monitor->c.r2_ua_1
            + monitor->c.r2_uc_1 + monitor->c.r2_w1_ua + monitor->c.r2_w1_uc);
}

/* Samples until `constants` time constants of the filter are over. */
static uint32_t samples(real constants, real sample_time, real bandwidth)
{
    const real wait = constants / (bandwidth * sample_time);
    const uint32_t whole = wait < REAL(4.0e9) ? (uint32_t)wait : UINT32_MAX - 1u;

    return (real)whole < wait ? whole + 1u : whole;
}

rc_loop_status rc_loop_configure(
    rc_loop_monitor *monitor,
    const rc_loop_parameters *parameters,
    rc_loop_real sample_time,
    rc_loop_real bandwidth,
    rc_loop_real time_unit)
{
    int k;

    for (k = 0; k < RC_LOOP_RESIDUALS; ++k) {
        monitor->settle[k] = UINT32_MAX;
    }
    rc_loop_reset(monitor);
    if (!parameters_are_finite(parameters)) {
        return RC_LOOP_BAD_PARAMETER;
    }
    if (!(sample_time > REAL(0.0)) || !finite_number(sample_time)) {
        return RC_LOOP_BAD_SAMPLE_TIME;
    }
    if (!(bandwidth * sample_time >= SLOWEST && bandwidth * sample_time <= REAL(3.0))) {
        return RC_LOOP_BAD_BANDWIDTH;
    }
    if (!(time_unit > REAL(0.0)) || !finite_number(time_unit)) {
        return RC_LOOP_BAD_TIME_UNIT;
    }
    compute_coefficients(monitor, parameters, sample_time, bandwidth);
    if (!coefficients_are_finite(monitor)) {
        return RC_LOOP_BAD_COEFFICIENT;
    }
    monitor->settle[RC_LOOP_R1] = samples(REAL(9.233413476451586), sample_time, bandwidth);
    monitor->settle[RC_LOOP_R2] = samples(REAL(9.233413476451586), sample_time, bandwidth);
    return RC_LOOP_OK;
}

void rc_loop_exact(
    const rc_loop_monitor *monitor,
    const rc_loop_derivatives *derivatives,
    rc_loop_real residuals[RC_LOOP_RESIDUALS])
{
    const rc_loop_coefficients *c = &monitor->c;
    const rc_loop_derivatives *d = derivatives;
    real *r = residuals;

    /* rc_loop.bg:14: r1 = U - ua - Rab*ba.f - R0*(ba.f + (Cc*D(uc) - ac.f))
     * where ba.f = ac.f + Ca*D(ua)
     * ac.f = (ua - uc)/Rca */
    r[RC_LOOP_R1] = d->U + c->r1_uc * d->uc[0] - c->r1_ua * d->ua[0] - c->r1_ua_1 * d->ua[1]
        - c->r1_uc_1 * d->uc[1];

    /* rc_loop.bg:18: r2 = ua + Rab*(ac.f + Ca*D(ua)) - uc - Rbc*(Cc*D(uc) - ac.f)
     * where ac.f = (ua - uc)/Rca */
    r[RC_LOOP_R2] = c->r2_ua * d->ua[0] + c->r2_ua_1 * d->ua[1] - c->r2_ua * d->uc[0]
        - c->r2_uc_1 * d->uc[1];
}

/* r1 on its first sample: the filter as if it had always been so. */
static void start_r1(
    rc_loop_monitor *monitor, const rc_loop_samples *s, real *r)
{
    const rc_loop_coefficients *c = &monitor->c;
    rc_loop_memory *x = &monitor->x;

    /* rc_loop.bg:14: r1: terms of order 0 */
    const real r1_g0 = s->U + c->r1_uc * s->uc - c->r1_ua * s->ua;

    /* rc_loop.bg:14: r1: degree 1 */
    const real r1_d1 = c->r1_w1_ua * s->ua - c->r1_w1_uc * s->uc;

    /* rc_loop.bg:14: r1: error of order 0 */
    const real r1_e0 = c->bend1 * r1_g0;

    /* rc_loop.bg:14: r1: input of stage 2 */
    const real r1_u2 = r1_g0 - r1_d1 - r1_e0;

    /* rc_loop.bg:14: r1: stage 2, at rest */
    const real r1_y2 = r1_u2;

    /* rc_loop.bg:14: r1: stage 2: memory */
    x->r1_s2 = c->rest * r1_u2;

    /* rc_loop.bg:14: r1: input of stage 1 */
    const real r1_u1 = r1_y2 + r1_d1 + REAL(2.0) * r1_e0;

    /* rc_loop.bg:14: r1: stage 1, at rest */
    const real r1_y1 = r1_u1;

    /* rc_loop.bg:14: r1: stage 1: memory */
    x->r1_s1 = c->rest * r1_u1;

    /* rc_loop.bg:14: r1 = U - ua - Rab*ba.f - R0*(ba.f + (Cc*D(uc) - ac.f))
     * where ba.f = ac.f + Ca*D(ua)
     * ac.f = (ua - uc)/Rca */
    r[RC_LOOP_R1] = r1_y1 - r1_e0;
}

/* r1 on every further sample. */
static void next_r1(
    rc_loop_monitor *monitor, const rc_loop_samples *s, real *r)
{
    const rc_loop_coefficients *c = &monitor->c;
    rc_loop_memory *x = &monitor->x;

    /* rc_loop.bg:14: r1: terms of order 0 */
    const real r1_g0 = s->U + c->r1_uc * s->uc - c->r1_ua * s->ua;

    /* rc_loop.bg:14: r1: degree 1 */
    const real r1_d1 = c->r1_w1_ua * s->ua - c->r1_w1_uc * s->uc;

    /* rc_loop.bg:14: r1: error of order 0 */
    const real r1_e0 = c->bend1 * r1_g0;

    /* rc_loop.bg:14: r1: input of stage 2 */
    const real r1_u2 = r1_g0 - r1_d1 - r1_e0;

    /* rc_loop.bg:14: r1: stage 2 */
    const real r1_y2 = x->r1_s2 + c->b * r1_u2;

    /* rc_loop.bg:14: r1: stage 2: memory */
    x->r1_s2 = c->a * r1_y2 + c->b * r1_u2;

    /* rc_loop.bg:14: r1: input of stage 1 */
    const real r1_u1 = r1_y2 + r1_d1 + REAL(2.0) * r1_e0;

    /* rc_loop.bg:14: r1: stage 1 */
    const real r1_y1 = x->r1_s1 + c->b * r1_u1;

    /* rc_loop.bg:14: r1: stage 1: memory */
    x->r1_s1 = c->a * r1_y1 + c->b * r1_u1;

    /* rc_loop.bg:14: r1 = U - ua - Rab*ba.f - R0*(ba.f + (Cc*D(uc) - ac.f))
     * where ba.f = ac.f + Ca*D(ua)
     * ac.f = (ua - uc)/Rca */
    r[RC_LOOP_R1] = r1_y1 - r1_e0;
}

/* One sample for r1; a number that is not finite makes the next sample the first. */
static void run_r1(
    rc_loop_monitor *monitor, const rc_loop_samples *s, rc_loop_residuals *residuals)
{
    real *r = residuals->value;
    uint32_t age = monitor->age[0];

    if (age == 0u) {
        start_r1(monitor, s, r);
    } else {
        next_r1(monitor, s, r);
    }
    /* a sum is finite only if all its terms are */
    if (finite_number(s->U + s->ua + s->uc + r[RC_LOOP_R1])) {
        age += age < UINT32_MAX ? 1u : 0u;
    } else {
        age = 0u;
        r[RC_LOOP_R1] = REAL(0.0);
    }
    monitor->age[0] = age;
    residuals->valid[RC_LOOP_R1] = age > monitor->settle[RC_LOOP_R1];
}

/* r2 on its first sample: the filter as if it had always been so. */
static void start_r2(
    rc_loop_monitor *monitor, const rc_loop_samples *s, real *r)
{
    const rc_loop_coefficients *c = &monitor->c;
    rc_loop_memory *x = &monitor->x;

    /* rc_loop.bg:18: r2: terms of order 0 */
    const real r2_g0 = c->r2_ua * s->ua - c->r2_ua * s->uc;

    /* rc_loop.bg:18: r2: degree 1 */
    const real r2_d1 = c->r2_w1_ua * s->ua - c->r2_w1_uc * s->uc;

    /* rc_loop.bg:18: r2: error of order 0 */
    const real r2_e0 = c->bend1 * r2_g0;

    /* rc_loop.bg:18: r2: input of stage 2 */
    const real r2_u2 = r2_g0 - r2_d1 - r2_e0;

    /* rc_loop.bg:18: r2: stage 2, at rest */
    const real r2_y2 = r2_u2;

    /* rc_loop.bg:18: r2: stage 2: memory */
    x->r2_s2 = c->rest * r2_u2;

    /* rc_loop.bg:18: r2: input of stage 1 */
    const real r2_u1 = r2_y2 + r2_d1 + REAL(2.0) * r2_e0;

    /* rc_loop.bg:18: r2: stage 1, at rest */
    const real r2_y1 = r2_u1;

    /* rc_loop.bg:18: r2: stage 1: memory */
    x->r2_s1 = c->rest * r2_u1;

    /* rc_loop.bg:18: r2 = ua + Rab*(ac.f + Ca*D(ua)) - uc - Rbc*(Cc*D(uc) - ac.f)
     * where ac.f = (ua - uc)/Rca */
    r[RC_LOOP_R2] = r2_y1 - r2_e0;
}

/* r2 on every further sample. */
static void next_r2(
    rc_loop_monitor *monitor, const rc_loop_samples *s, real *r)
{
    const rc_loop_coefficients *c = &monitor->c;
    rc_loop_memory *x = &monitor->x;

    /* rc_loop.bg:18: r2: terms of order 0 */
    const real r2_g0 = c->r2_ua * s->ua - c->r2_ua * s->uc;

    /* rc_loop.bg:18: r2: degree 1 */
    const real r2_d1 = c->r2_w1_ua * s->ua - c->r2_w1_uc * s->uc;

    /* rc_loop.bg:18: r2: error of order 0 */
    const real r2_e0 = c->bend1 * r2_g0;

    /* rc_loop.bg:18: r2: input of stage 2 */
    const real r2_u2 = r2_g0 - r2_d1 - r2_e0;

    /* rc_loop.bg:18: r2: stage 2 */
    const real r2_y2 = x->r2_s2 + c->b * r2_u2;

    /* rc_loop.bg:18: r2: stage 2: memory */
    x->r2_s2 = c->a * r2_y2 + c->b * r2_u2;

    /* rc_loop.bg:18: r2: input of stage 1 */
    const real r2_u1 = r2_y2 + r2_d1 + REAL(2.0) * r2_e0;

    /* rc_loop.bg:18: r2: stage 1 */
    const real r2_y1 = x->r2_s1 + c->b * r2_u1;

    /* rc_loop.bg:18: r2: stage 1: memory */
    x->r2_s1 = c->a * r2_y1 + c->b * r2_u1;

    /* rc_loop.bg:18: r2 = ua + Rab*(ac.f + Ca*D(ua)) - uc - Rbc*(Cc*D(uc) - ac.f)
     * where ac.f = (ua - uc)/Rca */
    r[RC_LOOP_R2] = r2_y1 - r2_e0;
}

/* One sample for r2; a number that is not finite makes the next sample the first. */
static void run_r2(
    rc_loop_monitor *monitor, const rc_loop_samples *s, rc_loop_residuals *residuals)
{
    real *r = residuals->value;
    uint32_t age = monitor->age[1];

    if (age == 0u) {
        start_r2(monitor, s, r);
    } else {
        next_r2(monitor, s, r);
    }
    /* a sum is finite only if all its terms are */
    if (finite_number(s->ua + s->uc + r[RC_LOOP_R2])) {
        age += age < UINT32_MAX ? 1u : 0u;
    } else {
        age = 0u;
        r[RC_LOOP_R2] = REAL(0.0);
    }
    monitor->age[1] = age;
    residuals->valid[RC_LOOP_R2] = age > monitor->settle[RC_LOOP_R2];
}

void rc_loop_reset(rc_loop_monitor *monitor)
{
    int k;

    for (k = 0; k < 2; ++k) {
        monitor->age[k] = 0u;
    }
}

void rc_loop_step(
    rc_loop_monitor *monitor,
    const rc_loop_samples *samples,
    rc_loop_residuals *residuals)
{
    run_r1(monitor, samples, residuals);
    run_r2(monitor, samples, residuals);
}
