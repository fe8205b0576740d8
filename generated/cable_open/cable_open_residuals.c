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

/* The larger of two numbers. */
static real greatest(real left, real right)
{
    return right > left ? right : left;
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

    /* of a stage: what is left of its memory */
    const real pole = greatest(REAL(2.0) - x_, REAL(0.0)) / (x_ + REAL(2.0));

    /* 1 - pole */
    const real t = REAL(1.0) - pole;

    /* khepera.bg:114: r1: factor of Us': line.R*line.C/2 */
    c->r1_Us_1 = REAL(0.5) * p->line__R * p->line__C;

    /* khepera.bg:114: r1: factor of Us'': line.L*line.C/2 */
    c->r1_Us_2 = REAL(0.5) * p->line__L * p->line__C;

    /* filter: what is left of a memory a sample later */
    c->a = pole;

    /* filter: weight of a sample, new and a sample later */
    c->b = REAL(0.5) * t;

    /* filter: 1 - b, the memory of a constant 1 */
    c->rest = REAL(1.0) - REAL(0.5) * t;
}

static bool parameters_are_finite(const cable_open_parameters *p)
{
    return finite_number(p->line__R + p->line__L + p->line__C);
}

static bool coefficients_are_finite(const cable_open_monitor *monitor)
{
    return finite_number(monitor->c.r1_Us_1 + monitor->c.r1_Us_2 + monitor->c.a + monitor->c.b
            + monitor->c.rest);
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
    const real r1_y1 = x->r1_s1 + c->b * r1_u1;

    /* khepera.bg:114: r1: stage 1: memory */
    x->r1_s1 = c->a * r1_y1 + c->b * r1_u1;

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
