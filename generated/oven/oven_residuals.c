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

    /* of a stage: what is left of its memory */
    const real pole = greatest(REAL(2.0) - x_, REAL(0.0)) / (x_ + REAL(2.0));

    /* w*sample_time, x or 2 */
    const real turn = REAL(2.0) * (REAL(1.0) - pole) / (pole + REAL(1.0));

    /* w of the filter 1/(1 + D/w) */
    const real w = turn / sample_time;

    /* min(x/2, 0.025) */
    const real t = least(REAL(0.5) * x_, REAL(1.0) / REAL(40.0));

    /* oven.bg:15: r1: factor of Th: Gh */
    c->r1_Th = p->Gh;

    /* oven.bg:15: r1: factor of Th': Ch */
    c->r1_Th_1 = p->Ch;

    /* part of the start that a sample is */
    c->r1_pace = t;

    /* 1/w of the filter as part of the start, to the power 1 */
    c->r1_slope1 = t / turn;

    /* oven.bg:15: r1: factor of Th times derivative 1 of the window */
    c->r1_w0_Th_1 = p->Ch * w;

    /* filter: 1 * (w*sample_time)^2/12 */
    c->bend1 = turn * turn / REAL(12.0);

    /* filter: what is left of a memory a sample later */
    c->a = pole;

    /* filter: weight of a sample, new and a sample later */
    c->b = REAL(0.5) * (REAL(1.0) - pole);

    /* oven.bg:15: r2: factor of Ta: Go */
    c->r2_Ta = p->Go;

    /* oven.bg:15: r2: factor of To: Gh + Go */
    c->r2_To = p->Gh + p->Go;

    /* oven.bg:15: r2: factor of To': Co */
    c->r2_To_1 = p->Co;

    /* oven.bg:15: r2: factor of To times derivative 1 of the window */
    c->r2_w0_To_1 = p->Co * w;
}

static bool parameters_are_finite(const oven_parameters *p)
{
    return finite_number(p->Ch + p->Co + p->Gh + p->Go);
}

static bool coefficients_are_finite(const oven_monitor *monitor)
{
    return finite_number(monitor->c.r1_Th + monitor->c.r1_Th_1 + monitor->c.r1_pace
            + monitor->c.r1_slope1 + monitor->c.r1_w0_Th_1 + monitor->c.bend1 + monitor->c.a
            + monitor->c.b + monitor->c.r2_Ta + monitor->c.r2_To + monitor->c.r2_To_1
            + monitor->c.r2_w0_To_1);
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
    monitor->settle[OVEN_R1] = samples(REAL(2.0), sample_time, bandwidth);
    monitor->settle[OVEN_R2] = samples(REAL(2.0), sample_time, bandwidth);
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

/* r1 on its first sample: nothing is known yet. */
static void start_r1(
    oven_monitor *monitor, const oven_samples *s, real *r)
{
    oven_memory *x = &monitor->x;

    /* oven.bg:15: r1: on for the next sample */
    x->r1_on = s->on ? REAL(1.0) : REAL(0.0);

    /* oven.bg:15: r1: the same, for the next sample */
    x->r1_open = REAL(0.0);

    /* oven.bg:15: r1: stage 2: memory */
    x->r1_s2 = REAL(0.0);

    /* oven.bg:15: r1: stage 1: memory */
    x->r1_s1 = REAL(0.0);

    /* oven.bg:15: r1 = if(on, P, 0) - Gh*(Th - To) - Ch*D(Th) */
    r[OVEN_R1] = REAL(0.0);
}

/* r1 on every further sample. */
static void next_r1(
    oven_monitor *monitor, const oven_samples *s, real *r)
{
    const oven_coefficients *c = &monitor->c;
    oven_memory *x = &monitor->x;

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

    /* oven.bg:15: r1: derivative 1 of the window */
    const real r1_phi1 = c->r1_slope1 * (REAL(30.0) * (r1_u * r1_u) * (r1_rest * r1_rest));

    /* oven.bg:15: if(on, P, 0) */
    const real r1_choice = s->on ? s->P : REAL(0.0);

    /* oven.bg:15: r1: terms of order 0 */
    const real r1_g0 = r1_phi0 * (r1_choice + c->r1_Th * s->To - c->r1_Th * s->Th)
        + r1_phi1 * (c->r1_w0_Th_1 * s->Th);

    /* oven.bg:15: r1: degree 1 */
    const real r1_d1 = r1_phi0 * (c->r1_w0_Th_1 * s->Th);

    /* oven.bg:15: r1: error of order 0 */
    const real r1_e0 = c->bend1 * r1_g0;

    /* oven.bg:15: r1: input of stage 2 */
    const real r1_u2 = r1_g0 + r1_d1 - r1_e0;

    /* oven.bg:15: r1: stage 2 */
    const real r1_y2 = r1_kept * x->r1_s2 + c->b * r1_u2;

    /* oven.bg:15: r1: stage 2: memory */
    x->r1_s2 = c->a * r1_y2 + c->b * r1_u2;

    /* oven.bg:15: r1: input of stage 1 */
    const real r1_u1 = r1_y2 + REAL(2.0) * r1_e0 - r1_d1;

    /* oven.bg:15: r1: stage 1 */
    const real r1_y1 = r1_kept * x->r1_s1 + c->b * r1_u1;

    /* oven.bg:15: r1: stage 1: memory */
    x->r1_s1 = c->a * r1_y1 + c->b * r1_u1;

    /* oven.bg:15: r1 = if(on, P, 0) - Gh*(Th - To) - Ch*D(Th) */
    r[OVEN_R1] = r1_y1 - r1_e0;
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
    residuals->valid[OVEN_R1] = age > monitor->settle[OVEN_R1] && monitor->x.r1_open >= REAL(1.0);
}

/* r2 on its first sample: nothing is known yet. */
static void start_r2(
    oven_monitor *monitor, const oven_samples *s, real *r)
{
    oven_memory *x = &monitor->x;

    (void)s;

    /* oven.bg:15: r2: the same, for the next sample */
    x->r2_open = REAL(0.0);

    /* oven.bg:15: r2: stage 2: memory */
    x->r2_s2 = REAL(0.0);

    /* oven.bg:15: r2: stage 1: memory */
    x->r2_s1 = REAL(0.0);

    /* oven.bg:15: r2 = Gh*(Th - To) - Go*(To - Ta) - Co*D(To) */
    r[OVEN_R2] = REAL(0.0);
}

/* r2 on every further sample. */
static void next_r2(
    oven_monitor *monitor, const oven_samples *s, real *r)
{
    const oven_coefficients *c = &monitor->c;
    oven_memory *x = &monitor->x;

    /* oven.bg:15: r2: how much of the start is over */
    const real r2_u = least(REAL(1.0), x->r2_open + c->r1_pace);

    /* oven.bg:15: r2: the same, for the next sample */
    x->r2_open = r2_u;

    /* oven.bg:15: r2: how much is to come */
    const real r2_rest = REAL(1.0) - r2_u;

    /* oven.bg:15: r2: the window */
    const real r2_phi0 = r2_u * r2_u * r2_u * (REAL(1.0)
            + r2_rest * (REAL(3.0) + r2_rest * REAL(6.0)));

    /* oven.bg:15: r2: derivative 1 of the window */
    const real r2_phi1 = c->r1_slope1 * (REAL(30.0) * (r2_u * r2_u) * (r2_rest * r2_rest));

    /* oven.bg:15: r2: terms of order 0 */
    const real r2_g0 = r2_phi0 * (c->r2_Ta * s->Ta + c->r1_Th * s->Th - c->r2_To * s->To)
        + r2_phi1 * (c->r2_w0_To_1 * s->To);

    /* oven.bg:15: r2: degree 1 */
    const real r2_d1 = r2_phi0 * (c->r2_w0_To_1 * s->To);

    /* oven.bg:15: r2: error of order 0 */
    const real r2_e0 = c->bend1 * r2_g0;

    /* oven.bg:15: r2: input of stage 2 */
    const real r2_u2 = r2_g0 + r2_d1 - r2_e0;

    /* oven.bg:15: r2: stage 2 */
    const real r2_y2 = x->r2_s2 + c->b * r2_u2;

    /* oven.bg:15: r2: stage 2: memory */
    x->r2_s2 = c->a * r2_y2 + c->b * r2_u2;

    /* oven.bg:15: r2: input of stage 1 */
    const real r2_u1 = r2_y2 + REAL(2.0) * r2_e0 - r2_d1;

    /* oven.bg:15: r2: stage 1 */
    const real r2_y1 = x->r2_s1 + c->b * r2_u1;

    /* oven.bg:15: r2: stage 1: memory */
    x->r2_s1 = c->a * r2_y1 + c->b * r2_u1;

    /* oven.bg:15: r2 = Gh*(Th - To) - Go*(To - Ta) - Co*D(To) */
    r[OVEN_R2] = r2_y1 - r2_e0;
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
    residuals->valid[OVEN_R2] = age > monitor->settle[OVEN_R2] && monitor->x.r2_open >= REAL(1.0);
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
