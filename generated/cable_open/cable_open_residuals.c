/* cable_open_residuals.c: the residuals of CableOpen; generated, see the header. */
#include "cable_open_residuals.h"


#if defined __FINITE_MATH_ONLY__ && __FINITE_MATH_ONLY__
#error "this code tells numbers from NaN: compile it without -ffinite-math-only (-ffast-math)"
#endif

typedef cable_open_real real;

#define REAL(x) CABLE_OPEN_CONSTANT(x)
#if defined CABLE_OPEN_FLOAT && !defined CABLE_OPEN_REAL
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

uint32_t cable_open_abi(void)
{
    return CABLE_OPEN_ABI;
}

const char *cable_open_digest(void)
{
    return CABLE_OPEN_DIGEST;
}

void cable_open_nominal(cable_open_parameters *parameters)
{
    parameters->line__R = REAL(3.2);      /* Ohm */
    parameters->line__L = REAL(2.5e-07);  /* H */
    parameters->line__C = REAL(1.1e-10);  /* F */
}

/* The coefficients of exact and of the filter, from the parameters. */
static void compute_coefficients(cable_open_monitor *monitor, const cable_open_parameters *p,
        real sample_time, real bandwidth)
{
    cable_open_coefficients *c = &monitor->c;

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

    /* khepera.bg:114: r1: factor of Us': line.R*line.C/2 */
    c->r1_Us_1 = REAL(0.5) * p->line__R * p->line__C;

    /* khepera.bg:114: r1: factor of Us'': line.L*line.C/2 */
    c->r1_Us_2 = REAL(0.5) * p->line__L * p->line__C;

    /* filter: exp(-bandwidth*sample_time) */
    c->a = t;

    /* filter: weight of the new sample */
    c->b0 = t_2;

    /* filter: weight of the sample before */
    c->b1 = REAL(1.0) - t - t_2;

    /* filter: 1 - b0, the memory of a constant 1 */
    c->rest = REAL(1.0) - t_2;
}

static bool parameters_are_finite(const cable_open_parameters *p)
{
    return finite_number(p->line__R + p->line__L + p->line__C);
}

static bool coefficients_are_finite(const cable_open_monitor *monitor)
{
    return finite_number(monitor->c.r1_Us_1 + monitor->c.r1_Us_2 + monitor->c.a + monitor->c.b0
            + monitor->c.b1 + monitor->c.rest);
}

/* Samples until `constants` time constants of the filter are over. */
static uint32_t samples(real constants, real sample_time, real bandwidth)
{
    const real wait = constants / (bandwidth * sample_time);
    const uint32_t whole = wait < REAL(4.0e9) ? (uint32_t)wait : UINT32_MAX - 1u;

    return (real)whole < wait ? whole + 1u : whole;
}

cable_open_status cable_open_configure(
    cable_open_monitor *monitor,
    const cable_open_parameters *parameters,
    cable_open_real sample_time,
    cable_open_real bandwidth,
    cable_open_real time_unit)
{
    int k;

    for (k = 0; k < CABLE_OPEN_RESIDUALS; ++k) {
        monitor->settle[k] = UINT32_MAX;
    }
    cable_open_reset(monitor);
    if (!parameters_are_finite(parameters)) {
        return CABLE_OPEN_BAD_PARAMETER;
    }
    if (!(sample_time >= REAL(0.000999999)) || !finite_number(sample_time)) {
        return CABLE_OPEN_BAD_SAMPLE_TIME;
    }
    if (!(bandwidth * sample_time >= SLOWEST && bandwidth * sample_time <= REAL(3.0))) {
        return CABLE_OPEN_BAD_BANDWIDTH;
    }
    if (!(time_unit > REAL(0.0)) || !finite_number(time_unit)) {
        return CABLE_OPEN_BAD_TIME_UNIT;
    }
    compute_coefficients(monitor, parameters, sample_time, bandwidth);
    if (!coefficients_are_finite(monitor)) {
        return CABLE_OPEN_BAD_COEFFICIENT;
    }
    monitor->settle[CABLE_OPEN_R1] = samples(REAL(6.907755278982138), sample_time, bandwidth);
    return CABLE_OPEN_OK;
}

void cable_open_exact(
    const cable_open_monitor *monitor,
    const cable_open_derivatives *derivatives,
    cable_open_real residuals[CABLE_OPEN_RESIDUALS])
{
    const cable_open_coefficients *c = &monitor->c;
    const cable_open_derivatives *d = derivatives;
    real *r = residuals;

    /* khepera.bg:114: r1 = Uin - Us - line.R*line.C*D(Us)/2 - line.L*line.C*D(Us, 2)/2 */
    r[CABLE_OPEN_R1] = d->Uin - d->Us[0] - c->r1_Us_1 * d->Us[1] - c->r1_Us_2 * d->Us[2];
}

/* r1 on its first sample: the filter as if it had always been so. */
static void start_r1(
    cable_open_monitor *monitor, const cable_open_samples *s, real *r)
{
    const cable_open_coefficients *c = &monitor->c;
    cable_open_memory *x = &monitor->x;

    /* khepera.bg:114: r1: input of stage 1 */
    const real r1_u1 = s->Uin - s->Us;

    /* khepera.bg:114: r1: stage 1, at rest */
    const real r1_y1 = r1_u1;

    /* khepera.bg:114: r1: stage 1: memory */
    x->r1_s1 = c->rest * r1_u1;

    /* khepera.bg:114: r1 = Uin - Us - line.R*line.C*D(Us)/2 - line.L*line.C*D(Us, 2)/2 */
    r[CABLE_OPEN_R1] = r1_y1;
}

/* r1 on every further sample. */
static void next_r1(
    cable_open_monitor *monitor, const cable_open_samples *s, real *r)
{
    const cable_open_coefficients *c = &monitor->c;
    cable_open_memory *x = &monitor->x;

    /* khepera.bg:114: r1: input of stage 1 */
    const real r1_u1 = s->Uin - s->Us;

    /* khepera.bg:114: r1: stage 1 */
    const real r1_y1 = x->r1_s1 + c->b0 * r1_u1;

    /* khepera.bg:114: r1: stage 1: memory */
    x->r1_s1 = c->a * r1_y1 + c->b1 * r1_u1;

    /* khepera.bg:114: r1 = Uin - Us - line.R*line.C*D(Us)/2 - line.L*line.C*D(Us, 2)/2 */
    r[CABLE_OPEN_R1] = r1_y1;
}

/* One sample for r1; a number that is not finite makes the next sample the first. */
static void run_r1(
    cable_open_monitor *monitor, const cable_open_samples *s, cable_open_residuals *residuals)
{
    real *r = residuals->value;
    uint32_t age = monitor->age[0];

    if (age == 0u) {
        start_r1(monitor, s, r);
    } else {
        next_r1(monitor, s, r);
    }
    /* a sum is finite only if all its terms are */
    if (finite_number(s->Uin + s->Us + r[CABLE_OPEN_R1])) {
        age += age < UINT32_MAX ? 1u : 0u;
    } else {
        age = 0u;
        r[CABLE_OPEN_R1] = REAL(0.0);
    }
    monitor->age[0] = age;
    residuals->valid[CABLE_OPEN_R1] = age > monitor->settle[CABLE_OPEN_R1];
}

void cable_open_reset(cable_open_monitor *monitor)
{
    int k;

    for (k = 0; k < 1; ++k) {
        monitor->age[k] = 0u;
    }
}

void cable_open_step(
    cable_open_monitor *monitor,
    const cable_open_samples *samples,
    cable_open_residuals *residuals)
{
    run_r1(monitor, samples, residuals);
}
