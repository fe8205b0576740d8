/* oven_residuals.c: the residuals of Oven; generated, see the header. */
#include "oven_residuals.h"


#if defined __FINITE_MATH_ONLY__ && __FINITE_MATH_ONLY__
#error "this code tells numbers from NaN: compile it without -ffinite-math-only (-ffast-math)"
#endif

typedef oven_real real;

#define REAL(x) OVEN_CONSTANT(x)
#if defined OVEN_FLOAT && !defined OVEN_REAL
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

uint32_t oven_abi(void)
{
    return OVEN_ABI;
}

const char *oven_digest(void)
{
    return OVEN_DIGEST;
}

void oven_nominal(oven_parameters *parameters)
{
    parameters->Ch = REAL(120.0);  /* J/K */
    parameters->Co = REAL(900.0);  /* J/K */
    parameters->Gh = REAL(4.0);    /* W/K */
    parameters->Go = REAL(0.8);    /* W/K */
}

/* The coefficients of exact and of the filter, from the parameters. */
static void compute_coefficients(oven_monitor *monitor, const oven_parameters *p, real sample_time,
        real bandwidth)
{
    oven_coefficients *c = &monitor->c;

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

    /* oven.bg:15: r1: factor of Th: Gh */
    c->r1_Th = p->Gh;

    /* oven.bg:15: r1: factor of Th': Ch */
    c->r1_Th_1 = p->Ch;

    /* oven.bg:15: r1: factor of Th in stage 1 */
    c->r1_v1_Th = p->Ch * bandwidth;

    /* oven.bg:15: r1: factor of Th in stage 2 */
    c->r1_v2_Th = p->Ch * bandwidth - p->Gh;

    /* filter: exp(-bandwidth*sample_time) */
    c->a = t;

    /* filter: weight of the new sample */
    c->b0 = t_2;

    /* filter: weight of the sample before */
    c->b1 = REAL(1.0) - t - t_2;

    /* filter: 1 - b0, the memory of a constant 1 */
    c->rest = REAL(1.0) - t_2;

    /* oven.bg:15: r2: factor of Ta: Go */
    c->r2_Ta = p->Go;

    /* oven.bg:15: r2: factor of To: Gh + Go */
    c->r2_To = p->Gh + p->Go;

    /* oven.bg:15: r2: factor of To': Co */
    c->r2_To_1 = p->Co;

    /* oven.bg:15: r2: factor of To in stage 1 */
    c->r2_v1_To = p->Co * bandwidth;

    /* oven.bg:15: r2: factor of To in stage 2 */
    c->r2_v2_To = -p->Gh - p->Go + p->Co * bandwidth;
}

static bool parameters_are_finite(const oven_parameters *p)
{
    return finite_number(p->Ch + p->Co + p->Gh + p->Go);
}

static bool coefficients_are_finite(const oven_monitor *monitor)
{
    return finite_number(monitor->c.r1_Th + monitor->c.r1_Th_1 + monitor->c.r1_v1_Th
            + monitor->c.r1_v2_Th + monitor->c.a + monitor->c.b0 + monitor->c.b1 + monitor->c.rest
            + monitor->c.r2_Ta + monitor->c.r2_To + monitor->c.r2_To_1 + monitor->c.r2_v1_To
            + monitor->c.r2_v2_To);
}

/* Samples until `constants` time constants of the filter are over. */
static uint32_t samples(real constants, real sample_time, real bandwidth)
{
    const real wait = constants / (bandwidth * sample_time);
    const uint32_t whole = wait < REAL(4.0e9) ? (uint32_t)wait : UINT32_MAX - 1u;

    return (real)whole < wait ? whole + 1u : whole;
}

oven_status oven_configure(
    oven_monitor *monitor,
    const oven_parameters *parameters,
    oven_real sample_time,
    oven_real bandwidth,
    oven_real time_unit)
{
    int k;

    for (k = 0; k < OVEN_RESIDUALS; ++k) {
        monitor->settle[k] = UINT32_MAX;
    }
    oven_reset(monitor);
    if (!parameters_are_finite(parameters)) {
        return OVEN_BAD_PARAMETER;
    }
    if (!(sample_time > REAL(0.0)) || !finite_number(sample_time)) {
        return OVEN_BAD_SAMPLE_TIME;
    }
    if (!(bandwidth * sample_time >= SLOWEST && bandwidth * sample_time <= REAL(3.0))) {
        return OVEN_BAD_BANDWIDTH;
    }
    if (!(time_unit > REAL(0.0)) || !finite_number(time_unit)) {
        return OVEN_BAD_TIME_UNIT;
    }
    compute_coefficients(monitor, parameters, sample_time, bandwidth);
    if (!coefficients_are_finite(monitor)) {
        return OVEN_BAD_COEFFICIENT;
    }
    monitor->settle[OVEN_R1] = samples(REAL(9.233413476451586), sample_time, bandwidth);
    monitor->settle[OVEN_R2] = samples(REAL(9.233413476451586), sample_time, bandwidth);
    return OVEN_OK;
}

void oven_exact(
    const oven_monitor *monitor,
    const oven_derivatives *derivatives,
    oven_real residuals[OVEN_RESIDUALS])
{
    const oven_coefficients *c = &monitor->c;
    const oven_derivatives *d = derivatives;
    real *r = residuals;

    /* oven.bg:15: r1 = if(on, P, 0) - Gh*(Th - To) - Ch*D(Th) */
    r[OVEN_R1] = (d->on ? d->P : REAL(0.0)) + c->r1_Th * d->To[0] - c->r1_Th * d->Th[0]
        - c->r1_Th_1 * d->Th[1];

    /* oven.bg:15: r2 = Gh*(Th - To) - Go*(To - Ta) - Co*D(To) */
    r[OVEN_R2] = c->r2_Ta * d->Ta + c->r1_Th * d->Th[0] - c->r2_To * d->To[0]
        - c->r2_To_1 * d->To[1];
}

/* r1 on its first sample: the filter as if it had always been so. */
static void start_r1(
    oven_monitor *monitor, const oven_samples *s, real *r)
{
    const oven_coefficients *c = &monitor->c;
    oven_memory *x = &monitor->x;

    /* oven.bg:15: if(on, P, 0) */
    const real r1_choice = s->on ? s->P : REAL(0.0);

    /* oven.bg:15: r1: input of stage 2 */
    const real r1_u2 = r1_choice + c->r1_v2_Th * s->Th + c->r1_Th * s->To;

    /* oven.bg:15: r1: stage 2, at rest */
    const real r1_y2 = r1_u2;

    /* oven.bg:15: r1: stage 2: memory */
    x->r1_s2 = c->rest * r1_u2;

    /* oven.bg:15: r1: input of stage 1 */
    const real r1_u1 = r1_y2 - c->r1_v1_Th * s->Th;

    /* oven.bg:15: r1: stage 1, at rest */
    const real r1_y1 = r1_u1;

    /* oven.bg:15: r1: stage 1: memory */
    x->r1_s1 = c->rest * r1_u1;

    /* oven.bg:15: r1 = if(on, P, 0) - Gh*(Th - To) - Ch*D(Th) */
    r[OVEN_R1] = r1_y1;
}

/* r1 on every further sample. */
static void next_r1(
    oven_monitor *monitor, const oven_samples *s, real *r)
{
    const oven_coefficients *c = &monitor->c;
    oven_memory *x = &monitor->x;

    /* oven.bg:15: if(on, P, 0) */
    const real r1_choice = s->on ? s->P : REAL(0.0);

    /* oven.bg:15: r1: input of stage 2 */
    const real r1_u2 = r1_choice + c->r1_v2_Th * s->Th + c->r1_Th * s->To;

    /* oven.bg:15: r1: stage 2 */
    const real r1_y2 = x->r1_s2 + c->b0 * r1_u2;

    /* oven.bg:15: r1: stage 2: memory */
    x->r1_s2 = c->a * r1_y2 + c->b1 * r1_u2;

    /* oven.bg:15: r1: input of stage 1 */
    const real r1_u1 = r1_y2 - c->r1_v1_Th * s->Th;

    /* oven.bg:15: r1: stage 1 */
    const real r1_y1 = x->r1_s1 + c->b0 * r1_u1;

    /* oven.bg:15: r1: stage 1: memory */
    x->r1_s1 = c->a * r1_y1 + c->b1 * r1_u1;

    /* oven.bg:15: r1 = if(on, P, 0) - Gh*(Th - To) - Ch*D(Th) */
    r[OVEN_R1] = r1_y1;
}

/* One sample for r1; a number that is not finite makes the next sample the first. */
static void run_r1(
    oven_monitor *monitor, const oven_samples *s, oven_residuals *residuals)
{
    real *r = residuals->value;
    uint32_t age = monitor->age[0];

    if (age == 0u) {
        start_r1(monitor, s, r);
    } else {
        next_r1(monitor, s, r);
    }
    /* a sum is finite only if all its terms are */
    if (finite_number(s->P + s->Th + s->To + r[OVEN_R1])) {
        age += age < UINT32_MAX ? 1u : 0u;
    } else {
        age = 0u;
        r[OVEN_R1] = REAL(0.0);
    }
    monitor->age[0] = age;
    residuals->valid[OVEN_R1] = age > monitor->settle[OVEN_R1];
}

/* r2 on its first sample: the filter as if it had always been so. */
static void start_r2(
    oven_monitor *monitor, const oven_samples *s, real *r)
{
    const oven_coefficients *c = &monitor->c;
    oven_memory *x = &monitor->x;

    /* oven.bg:15: r2: input of stage 2 */
    const real r2_u2 = c->r2_Ta * s->Ta + c->r2_v2_To * s->To + c->r1_Th * s->Th;

    /* oven.bg:15: r2: stage 2, at rest */
    const real r2_y2 = r2_u2;

    /* oven.bg:15: r2: stage 2: memory */
    x->r2_s2 = c->rest * r2_u2;

    /* oven.bg:15: r2: input of stage 1 */
    const real r2_u1 = r2_y2 - c->r2_v1_To * s->To;

    /* oven.bg:15: r2: stage 1, at rest */
    const real r2_y1 = r2_u1;

    /* oven.bg:15: r2: stage 1: memory */
    x->r2_s1 = c->rest * r2_u1;

    /* oven.bg:15: r2 = Gh*(Th - To) - Go*(To - Ta) - Co*D(To) */
    r[OVEN_R2] = r2_y1;
}

/* r2 on every further sample. */
static void next_r2(
    oven_monitor *monitor, const oven_samples *s, real *r)
{
    const oven_coefficients *c = &monitor->c;
    oven_memory *x = &monitor->x;

    /* oven.bg:15: r2: input of stage 2 */
    const real r2_u2 = c->r2_Ta * s->Ta + c->r2_v2_To * s->To + c->r1_Th * s->Th;

    /* oven.bg:15: r2: stage 2 */
    const real r2_y2 = x->r2_s2 + c->b0 * r2_u2;

    /* oven.bg:15: r2: stage 2: memory */
    x->r2_s2 = c->a * r2_y2 + c->b1 * r2_u2;

    /* oven.bg:15: r2: input of stage 1 */
    const real r2_u1 = r2_y2 - c->r2_v1_To * s->To;

    /* oven.bg:15: r2: stage 1 */
    const real r2_y1 = x->r2_s1 + c->b0 * r2_u1;

    /* oven.bg:15: r2: stage 1: memory */
    x->r2_s1 = c->a * r2_y1 + c->b1 * r2_u1;

    /* oven.bg:15: r2 = Gh*(Th - To) - Go*(To - Ta) - Co*D(To) */
    r[OVEN_R2] = r2_y1;
}

/* One sample for r2; a number that is not finite makes the next sample the first. */
static void run_r2(
    oven_monitor *monitor, const oven_samples *s, oven_residuals *residuals)
{
    real *r = residuals->value;
    uint32_t age = monitor->age[1];

    if (age == 0u) {
        start_r2(monitor, s, r);
    } else {
        next_r2(monitor, s, r);
    }
    /* a sum is finite only if all its terms are */
    if (finite_number(s->Ta + s->Th + s->To + r[OVEN_R2])) {
        age += age < UINT32_MAX ? 1u : 0u;
    } else {
        age = 0u;
        r[OVEN_R2] = REAL(0.0);
    }
    monitor->age[1] = age;
    residuals->valid[OVEN_R2] = age > monitor->settle[OVEN_R2];
}

void oven_reset(oven_monitor *monitor)
{
    int k;

    for (k = 0; k < 2; ++k) {
        monitor->age[k] = 0u;
    }
}

void oven_step(
    oven_monitor *monitor,
    const oven_samples *samples,
    oven_residuals *residuals)
{
    run_r1(monitor, samples, residuals);
    run_r2(monitor, samples, residuals);
}
