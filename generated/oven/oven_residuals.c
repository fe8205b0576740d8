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

    /* exp(x) from x^35 on */
    const real series36 = x_ * (x_ * (x_ / REAL(38.0) + REAL(1.0)) / REAL(37.0)
            + REAL(1.0)) / REAL(36.0)
        + REAL(1.0);

    /* exp(x) from x^29 on */
    const real series30 = x_
            * (x_
                * (REAL(0.03125) * x_
                    * (x_ * (x_ * (x_ * series36 / REAL(35.0) + REAL(1.0)) / REAL(34.0)
                        + REAL(1.0)) / REAL(33.0)
                    + REAL(1.0))
                + REAL(1.0)) / REAL(31.0)
            + REAL(1.0)) / REAL(30.0)
        + REAL(1.0);

    /* exp(x) from x^23 on */
    const real series24 = x_
            * (x_
                * (x_
                    * (x_ * (x_ * (x_ * series30 / REAL(29.0) + REAL(1.0)) / REAL(28.0)
                        + REAL(1.0)) / REAL(27.0)
                    + REAL(1.0)) / REAL(26.0)
                + REAL(1.0)) / REAL(25.0)
            + REAL(1.0)) / REAL(24.0)
        + REAL(1.0);

    /* exp(x) from x^17 on */
    const real series18 = x_
            * (x_
                * (x_
                    * (x_ * (x_ * (x_ * series24 / REAL(23.0) + REAL(1.0)) / REAL(22.0)
                        + REAL(1.0)) / REAL(21.0)
                    + REAL(1.0)) / REAL(20.0)
                + REAL(1.0)) / REAL(19.0)
            + REAL(1.0)) / REAL(18.0)
        + REAL(1.0);

    /* exp(x) from x^11 on */
    const real series12 = x_
            * (x_
                * (x_
                    * (x_ * (REAL(0.0625) * x_ * (x_ * series18 / REAL(17.0) + REAL(1.0))
                        + REAL(1.0)) / REAL(15.0)
                    + REAL(1.0)) / REAL(14.0)
                + REAL(1.0)) / REAL(13.0)
            + REAL(1.0)) / REAL(12.0)
        + REAL(1.0);

    /* exp(x) from x^5 on */
    const real series6 = x_
            * (x_
                * (REAL(0.125) * x_
                    * (x_ * (x_ * (x_ * series12 / REAL(11.0) + REAL(1.0)) / REAL(10.0)
                        + REAL(1.0)) / REAL(9.0)
                    + REAL(1.0))
                + REAL(1.0)) / REAL(7.0)
            + REAL(1.0)) / REAL(6.0)
        + REAL(1.0);

    /* exp(-x) */
    const real t = exponential(-x_);

    /* min(x/2, 0.025) */
    const real t_2 = least(REAL(0.5) * x_, REAL(1.0) / REAL(40.0));

    /* x*(x*series6/5 + 1)/4 + 1 */
    const real t_3 = REAL(0.25) * x_ * (x_ * series6 / REAL(5.0) + REAL(1.0)) + REAL(1.0);

    /* x*(x*(x*series6/5 + 1)/4 + 1)/3 + 1 */
    const real t_4 = x_ * t_3 / REAL(3.0) + REAL(1.0);

    /* x*exp(-x)*(x*(x*(x*series6/5 + 1)/4 + 1)/3 + 1) */
    const real t_5 = x_ * t * t_4;

    /* x^2*exp(-x)*(x*(x*series6/5 + 1)/4 + 1) */
    const real t_6 = x_ * x_ * t * t_3;

    /* oven.bg:15: r1: factor of Th: Gh */
    c->r1_Th = p->Gh;

    /* oven.bg:15: r1: factor of Th': Ch */
    c->r1_Th_1 = p->Ch;

    /* part of the start that a sample is */
    c->r1_pace = t_2;

    /* a time constant of the filter as part of the start, to the power 1 */
    c->r1_slope1 = t_2 / x_;

    /* oven.bg:15: r1: factor of Th in stage 1 */
    c->r1_v1_Th = p->Ch * bandwidth;

    /* oven.bg:15: r1: factor of Th in stage 2 */
    c->r1_v2_Th = p->Ch * bandwidth - p->Gh;

    /* filter: weight of the new sample 0 stages further */
    c->n0 = x_ * t * (REAL(0.5) * x_ * t_4 + REAL(1.0)) - REAL(0.5) * t_5;

    /* filter: weight of the new sample 1 stages further */
    c->n1 = REAL(0.5) * x_ * x_ * t * t_4 - t_6 / REAL(3.0);

    /* filter: what is left of a memory 0 stages further */
    c->m0 = t;

    /* filter: weight of the sample before 0 stages further */
    c->o0 = REAL(0.5) * t_5;

    /* filter: what is left of a memory 1 stages further */
    c->m1 = x_ * t;

    /* filter: weight of the sample before 1 stages further */
    c->o1 = t_6 / REAL(3.0);

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
    return finite_number(monitor->c.r1_Th + monitor->c.r1_Th_1 + monitor->c.r1_pace
            + monitor->c.r1_slope1 + monitor->c.r1_v1_Th + monitor->c.r1_v2_Th + monitor->c.n0
            + monitor->c.n1 + monitor->c.m0 + monitor->c.o0 + monitor->c.m1 + monitor->c.o1
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

    /* oven.bg:15: r1: memory of stage 2 */
    x->r1_s2 = REAL(0.0);

    /* oven.bg:15: r1: memory of stage 1 */
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

    /* oven.bg:15: r1: input of stage 2 */
    const real r1_v2 = r1_phi0 * (r1_choice + c->r1_v2_Th * s->Th + c->r1_Th * s->To)
        + r1_phi1 * (c->r1_v1_Th * s->Th);

    /* oven.bg:15: r1: input of stage 1 */
    const real r1_v1 = -r1_phi0 * (c->r1_v1_Th * s->Th);

    /* oven.bg:15: r1: stage 2 */
    const real r1_y2 = r1_kept * x->r1_s2 + c->n0 * r1_v2;

    /* oven.bg:15: r1: stage 1 */
    const real r1_y1 = r1_kept * x->r1_s1 + c->n1 * r1_v2 + c->n0 * r1_v1;

    /* oven.bg:15: r1: memory of stage 2 */
    x->r1_s2 = c->m0 * r1_y2 + c->o0 * r1_v2;

    /* oven.bg:15: r1: memory of stage 1 */
    x->r1_s1 = c->m1 * r1_y2 + c->o1 * r1_v2 + c->m0 * r1_y1 + c->o0 * r1_v1;

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

    /* oven.bg:15: r2: memory of stage 2 */
    x->r2_s2 = REAL(0.0);

    /* oven.bg:15: r2: memory of stage 1 */
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

    /* oven.bg:15: r2: input of stage 2 */
    const real r2_v2 = r2_phi0 * (c->r2_Ta * s->Ta + c->r2_v2_To * s->To + c->r1_Th * s->Th)
        + r2_phi1 * (c->r2_v1_To * s->To);

    /* oven.bg:15: r2: input of stage 1 */
    const real r2_v1 = -r2_phi0 * (c->r2_v1_To * s->To);

    /* oven.bg:15: r2: stage 2 */
    const real r2_y2 = x->r2_s2 + c->n0 * r2_v2;

    /* oven.bg:15: r2: stage 1 */
    const real r2_y1 = x->r2_s1 + c->n1 * r2_v2 + c->n0 * r2_v1;

    /* oven.bg:15: r2: memory of stage 2 */
    x->r2_s2 = c->m0 * r2_y2 + c->o0 * r2_v2;

    /* oven.bg:15: r2: memory of stage 1 */
    x->r2_s1 = c->m1 * r2_y2 + c->o1 * r2_v2 + c->m0 * r2_y1 + c->o0 * r2_v1;

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
