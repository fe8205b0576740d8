/* slider_crank_residuals.c: the residuals of SliderCrank; generated, see the header. */
#include "slider_crank_residuals.h"

#include <math.h>

#if defined __FINITE_MATH_ONLY__ && __FINITE_MATH_ONLY__
#error "this code tells numbers from NaN: compile it without -ffinite-math-only (-ffast-math)"
#endif

typedef slider_crank_real real;

#define REAL(x) SLIDER_CRANK_CONSTANT(x)
#if defined SLIDER_CRANK_FLOAT && !defined SLIDER_CRANK_REAL
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

uint32_t slider_crank_abi(void)
{
    return SLIDER_CRANK_ABI;
}

const char *slider_crank_digest(void)
{
    return SLIDER_CRANK_DIGEST;
}

void slider_crank_nominal(slider_crank_parameters *parameters)
{
    parameters->J = REAL(0.002);  /* kg.m^2 */
    parameters->f = REAL(0.001);  /* N.m.s/rad */
    parameters->m = REAL(0.4);    /* kg */
    parameters->c = REAL(5.0);    /* N.s/m */
    parameters->r = REAL(0.04);   /* m */
    parameters->l = REAL(0.15);   /* m */
}

/* The coefficients of exact and of the filter, from the parameters. */
static void compute_coefficients(slider_crank_monitor *monitor, const slider_crank_parameters *p,
        real sample_time, real bandwidth)
{
    slider_crank_coefficients *c = &monitor->c;

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

    /* slider_crank.bg:18: r^2 */
    c->g = p->r * p->r;

    /* slider_crank.bg:18: l^2 */
    c->g_2 = p->l * p->l;

    /* slider_crank.bg:18: r */
    c->r = p->r;

    /* slider_crank.bg:18: r^3 */
    c->g_3 = p->r * p->r * p->r;

    /* slider_crank.bg:18: r1: factor of speed: f */
    c->r1_speed = p->f;

    /* slider_crank.bg:18: r1: factor of speed': J */
    c->r1_speed_1 = p->J;

    /* slider_crank.bg:18: r1: factor of speed*sin(Int(speed))^2*cos(Int(speed))*(r*cos(Int(speed
     * ...: c*r^3 */
    c->r1_product = p->c * p->r * p->r * p->r;

    /* slider_crank.bg:18: r1: factor of
     * D(speed*sin(Int(speed))^2*cos(Int(speed))*(r*cos(Int(speed ...): m*r^3 */
    c->r1_product_1 = p->m * p->r * p->r * p->r;

    /* slider_crank.bg:18: r1: factor of speed*sin(Int(speed))^2*(r*cos(Int(speed))/sqrt(l^2 - r^
     * ...: c*r^2 */
    c->r1_product_2 = p->c * p->r * p->r;

    /* slider_crank.bg:18: r1: factor of D(speed*sin(Int(speed))^2*(r*cos(Int(speed))/sqrt(l^2 -
     * r^ ...): m*r^2 */
    c->r1_product_1_2 = p->m * p->r * p->r;

    /* half the sample time */
    c->half_time = REAL(0.5) * sample_time;

    /* sample_time/24 */
    c->half_twelfth = sample_time / REAL(24.0);

    /* slider_crank.bg:18: r1: factor of speed' */
    c->r1_w1_speed = p->J * w;

    /* slider_crank.bg:18: r1: factor of
     * D(speed*sin(Int(speed))^2*cos(Int(speed))*(r*cos(Int(speed ...) */
    c->r1_w1_product = p->m * p->r * p->r * p->r * w;

    /* slider_crank.bg:18: r1: factor of D(speed*sin(Int(speed))^2*(r*cos(Int(speed))/sqrt(l^2 -
     * r^ ...) */
    c->r1_w1_product_2 = p->m * p->r * p->r * w;

    /* filter: 1 * (w*sample_time)^2/12 */
    c->bend1 = turn * turn / REAL(12.0);

    /* filter: what is left of a memory a sample later */
    c->a = pole;

    /* filter: weight of a sample, new and a sample later */
    c->b = REAL(0.5) * t;

    /* filter: 1 - b, the memory of a constant 1 */
    c->rest = REAL(1.0) - REAL(0.5) * t;
}

static bool parameters_are_finite(const slider_crank_parameters *p)
{
    return finite_number(p->J + p->f + p->m + p->c + p->r + p->l);
}

static bool coefficients_are_finite(const slider_crank_monitor *monitor)
{
    return finite_number(monitor->c.g + monitor->c.g_2 + monitor->c.r + monitor->c.g_3
            + monitor->c.r1_speed + monitor->c.r1_speed_1 + monitor->c.r1_product
            + monitor->c.r1_product_1 + monitor->c.r1_product_2 + monitor->c.r1_product_1_2
            + monitor->c.half_time + monitor->c.half_twelfth + monitor->c.r1_w1_speed
            + monitor->c.r1_w1_product + monitor->c.r1_w1_product_2 + monitor->c.bend1
            + monitor->c.a + monitor->c.b + monitor->c.rest);
}

/* Samples until `constants` time constants of the filter are over. */
static uint32_t samples(real constants, real sample_time, real bandwidth)
{
    const real wait = constants / (bandwidth * sample_time);
    const uint32_t whole = wait < REAL(4.0e9) ? (uint32_t)wait : UINT32_MAX - 1u;

    return (real)whole < wait ? whole + 1u : whole;
}

slider_crank_status slider_crank_configure(
    slider_crank_monitor *monitor,
    const slider_crank_parameters *parameters,
    slider_crank_real sample_time,
    slider_crank_real bandwidth,
    slider_crank_real time_unit)
{
    int k;

    for (k = 0; k < SLIDER_CRANK_RESIDUALS; ++k) {
        monitor->settle[k] = UINT32_MAX;
    }
    slider_crank_reset(monitor);
    if (!parameters_are_finite(parameters)) {
        return SLIDER_CRANK_BAD_PARAMETER;
    }
    if (!(sample_time > REAL(0.0)) || !finite_number(sample_time)) {
        return SLIDER_CRANK_BAD_SAMPLE_TIME;
    }
    if (!(bandwidth * sample_time >= SLOWEST && bandwidth * sample_time <= REAL(3.0))) {
        return SLIDER_CRANK_BAD_BANDWIDTH;
    }
    if (!(time_unit > REAL(0.0)) || !finite_number(time_unit)) {
        return SLIDER_CRANK_BAD_TIME_UNIT;
    }
    compute_coefficients(monitor, parameters, sample_time, bandwidth);
    if (!coefficients_are_finite(monitor)) {
        return SLIDER_CRANK_BAD_COEFFICIENT;
    }
    monitor->settle[SLIDER_CRANK_R1] = samples(REAL(9.233413476451586), sample_time, bandwidth);
    return SLIDER_CRANK_OK;
}

void slider_crank_exact(
    const slider_crank_monitor *monitor,
    const slider_crank_derivatives *derivatives,
    slider_crank_real residuals[SLIDER_CRANK_RESIDUALS])
{
    const slider_crank_coefficients *c = &monitor->c;
    const slider_crank_derivatives *d = derivatives;
    real *r = residuals;

    /* slider_crank.bg:18: sin(Int(speed)) */
    const real t = MATH(sin)(d->speed_integral);

    /* slider_crank.bg:18: cos(Int(speed)) */
    const real t_2 = MATH(cos)(d->speed_integral);

    /* slider_crank.bg:18: sqrt(l^2 - r^2*sin(Int(speed))^2) */
    const real t_3 = MATH(sqrt)(c->g_2 - c->g * t * t);

    /* slider_crank.bg:18: r*cos(Int(speed))/sqrt(l^2 - r^2*sin(Int(speed))^2) + 1 */
    const real t_4 = c->r * t_2 / t_3 + REAL(1.0);

    /* slider_crank.bg:18: r^3*speed*sin(Int(speed))*cos(Int(speed))^2/sqrt(l^2 -
     * r^2*sin(Int(speed))^2)^3 - r*sp ... */
    const real t_5 = c->g_3 * d->speed[0] * t * t_2 * t_2 / t_3 / t_3 / t_3
        - c->r * d->speed[0] * t / t_3;

    /* slider_crank.bg:18: r1 = T - f*speed - J*D(speed) - r*sin(Int(speed))*x1*(load +
     * c*r*speed*sin(Int(speed))*x1 + m*r*D(speed*sin(Int(speed))*x1))
     * where x1 = r*cos(Int(speed))/sqrt(l^2 - r^2*sin(Int(speed))^2) + 1 */
    r[SLIDER_CRANK_R1] = d->T
        + c->r1_product_1
            * (d->speed[0] * t * t_4 * (d->speed[0] * t_2 * t_2 / t_3
                + c->g * d->speed[0] * t * t * t_2 * t_2 / t_3 / t_3 / t_3
                - d->speed[0] * t * t / t_3))
        + c->r1_product_1_2 * (d->speed[0] * d->speed[0] * t * t_2 * t_4)
        - c->r1_speed * d->speed[0] - c->r1_speed_1 * d->speed[1] - c->g * (d->load * t * t_2 / t_3)
        - c->r1_product * (d->speed[0] * t * t * t_2 * t_4 / t_3)
        - c->r1_product_1 * (t * t * t_2 * t_4 * d->speed[1] / t_3
            + REAL(2.0) * d->speed[0] * d->speed[0] * t * t_2 * t_2 * t_4 / t_3
            + c->g * d->speed[0] * d->speed[0] * t * t * t * t_2 * t_2 * t_4 / t_3 / t_3 / t_3
            + d->speed[0] * t * t * t_2 * t_5 / t_3
            - d->speed[0] * d->speed[0] * t * t * t * t_4 / t_3)
        - c->r * (d->load * t) - c->r1_product_2 * (d->speed[0] * t * t * t_4)
        - c->r1_product_1_2 * (REAL(2.0) * d->speed[0] * d->speed[0] * t * t_2 * t_4
            + t * t * t_4 * d->speed[1] + d->speed[0] * t * t * t_5);
}

/* r1 on its first sample: the filter as if it had always been so. */
static void start_r1(
    slider_crank_monitor *monitor, const slider_crank_samples *s, real *r)
{
    const slider_crank_coefficients *c = &monitor->c;
    slider_crank_memory *x = &monitor->x;

    /* slider_crank.bg:18: integral of speed, at the start */
    const real r1_int = REAL(0.0);

    /* slider_crank.bg:18: integral of speed: memory */
    x->r1_q = c->half_time * s->speed;

    /* slider_crank.bg:18: integral of speed */
    const real r1_integral = r1_int;

    /* slider_crank.bg:18: integral of speed: memory */
    x->r1_rate2 = s->speed;
    x->r1_rate1 = s->speed;

    /* slider_crank.bg:18: sin(Int(speed)) */
    const real r1_t = MATH(sin)(r1_integral);

    /* slider_crank.bg:18: cos(Int(speed)) */
    const real r1_t_2 = MATH(cos)(r1_integral);

    /* slider_crank.bg:18: sqrt(l^2 - r^2*sin(Int(speed))^2) */
    const real r1_t_3 = MATH(sqrt)(c->g_2 - c->g * r1_t * r1_t);

    /* slider_crank.bg:18: r*cos(Int(speed))/sqrt(l^2 - r^2*sin(Int(speed))^2) + 1 */
    const real r1_t_4 = c->r * r1_t_2 / r1_t_3 + REAL(1.0);

    /* slider_crank.bg:18: load*sin(Int(speed))*cos(Int(speed))/sqrt(l^2 - r^2*sin( ... */
    const real r1_product = s->load * r1_t * r1_t_2 / r1_t_3;

    /* slider_crank.bg:18: speed*sin(Int(speed))^2*cos(Int(speed))*(r*cos(Int(speed ... */
    const real r1_product_2 = s->speed * r1_t * r1_t * r1_t_2 * r1_t_4 / r1_t_3;

    /* slider_crank.bg:18: speed*sin(Int(speed))*(r*cos(Int(speed))/sqrt(l^2 - r^2* ... */
    const real r1_product_3 = s->speed * r1_t * r1_t_4 * (s->speed * r1_t_2 * r1_t_2 / r1_t_3
            + c->g * s->speed * r1_t * r1_t * r1_t_2 * r1_t_2 / r1_t_3 / r1_t_3 / r1_t_3
            - s->speed * r1_t * r1_t / r1_t_3);

    /* slider_crank.bg:18: load*sin(Int(speed)) */
    const real r1_product_4 = s->load * r1_t;

    /* slider_crank.bg:18: speed*sin(Int(speed))^2*(r*cos(Int(speed))/sqrt(l^2 - r^ ... */
    const real r1_product_5 = s->speed * r1_t * r1_t * r1_t_4;

    /* slider_crank.bg:18: speed^2*sin(Int(speed))*cos(Int(speed))*(r*cos(Int(speed ... */
    const real r1_product_6 = s->speed * s->speed * r1_t * r1_t_2 * r1_t_4;

    /* slider_crank.bg:18: r1: terms of order 0 */
    const real r1_g0 = s->T + c->r1_product_1 * r1_product_3 + c->r1_product_1_2 * r1_product_6
        - c->r1_speed * s->speed - c->g * r1_product - c->r1_product * r1_product_2
        - c->r * r1_product_4 - c->r1_product_2 * r1_product_5;

    /* slider_crank.bg:18: r1: degree 1 */
    const real r1_d1 = -c->r1_w1_speed * s->speed - c->r1_w1_product * r1_product_2
        - c->r1_w1_product_2 * r1_product_5;

    /* slider_crank.bg:18: r1: error of order 0 */
    const real r1_e0 = c->bend1 * r1_g0;

    /* slider_crank.bg:18: r1: input of stage 2 */
    const real r1_u2 = r1_g0 - r1_d1 - r1_e0;

    /* slider_crank.bg:18: r1: stage 2, at rest */
    const real r1_y2 = r1_u2;

    /* slider_crank.bg:18: r1: stage 2: memory */
    x->r1_s2 = c->rest * r1_u2;

    /* slider_crank.bg:18: r1: input of stage 1 */
    const real r1_u1 = r1_y2 + r1_d1 + REAL(2.0) * r1_e0;

    /* slider_crank.bg:18: r1: stage 1, at rest */
    const real r1_y1 = r1_u1;

    /* slider_crank.bg:18: r1: stage 1: memory */
    x->r1_s1 = c->rest * r1_u1;

    /* slider_crank.bg:18: r1 = T - f*speed - J*D(speed) - r*sin(Int(speed))*x1*(load +
     * c*r*speed*sin(Int(speed))*x1 + m*r*D(speed*sin(Int(speed))*x1))
     * where x1 = r*cos(Int(speed))/sqrt(l^2 - r^2*sin(Int(speed))^2) + 1 */
    r[SLIDER_CRANK_R1] = r1_y1 - r1_e0;
}

/* r1 on every further sample. */
static void next_r1(
    slider_crank_monitor *monitor, const slider_crank_samples *s, real *r)
{
    const slider_crank_coefficients *c = &monitor->c;
    slider_crank_memory *x = &monitor->x;

    /* slider_crank.bg:18: integral of speed */
    const real r1_int = x->r1_q + c->half_time * s->speed;

    /* slider_crank.bg:18: integral of speed: memory */
    x->r1_q = r1_int + c->half_time * s->speed;

    /* slider_crank.bg:18: integral of speed */
    const real r1_integral = r1_int
        - c->half_twelfth * (REAL(3.0) * s->speed - REAL(4.0) * x->r1_rate1 + x->r1_rate2);

    /* slider_crank.bg:18: integral of speed: memory */
    x->r1_rate2 = x->r1_rate1;
    x->r1_rate1 = s->speed;

    /* slider_crank.bg:18: sin(Int(speed)) */
    const real r1_t = MATH(sin)(r1_integral);

    /* slider_crank.bg:18: cos(Int(speed)) */
    const real r1_t_2 = MATH(cos)(r1_integral);

    /* slider_crank.bg:18: sqrt(l^2 - r^2*sin(Int(speed))^2) */
    const real r1_t_3 = MATH(sqrt)(c->g_2 - c->g * r1_t * r1_t);

    /* slider_crank.bg:18: r*cos(Int(speed))/sqrt(l^2 - r^2*sin(Int(speed))^2) + 1 */
    const real r1_t_4 = c->r * r1_t_2 / r1_t_3 + REAL(1.0);

    /* slider_crank.bg:18: load*sin(Int(speed))*cos(Int(speed))/sqrt(l^2 - r^2*sin( ... */
    const real r1_product = s->load * r1_t * r1_t_2 / r1_t_3;

    /* slider_crank.bg:18: speed*sin(Int(speed))^2*cos(Int(speed))*(r*cos(Int(speed ... */
    const real r1_product_2 = s->speed * r1_t * r1_t * r1_t_2 * r1_t_4 / r1_t_3;

    /* slider_crank.bg:18: speed*sin(Int(speed))*(r*cos(Int(speed))/sqrt(l^2 - r^2* ... */
    const real r1_product_3 = s->speed * r1_t * r1_t_4 * (s->speed * r1_t_2 * r1_t_2 / r1_t_3
            + c->g * s->speed * r1_t * r1_t * r1_t_2 * r1_t_2 / r1_t_3 / r1_t_3 / r1_t_3
            - s->speed * r1_t * r1_t / r1_t_3);

    /* slider_crank.bg:18: load*sin(Int(speed)) */
    const real r1_product_4 = s->load * r1_t;

    /* slider_crank.bg:18: speed*sin(Int(speed))^2*(r*cos(Int(speed))/sqrt(l^2 - r^ ... */
    const real r1_product_5 = s->speed * r1_t * r1_t * r1_t_4;

    /* slider_crank.bg:18: speed^2*sin(Int(speed))*cos(Int(speed))*(r*cos(Int(speed ... */
    const real r1_product_6 = s->speed * s->speed * r1_t * r1_t_2 * r1_t_4;

    /* slider_crank.bg:18: r1: terms of order 0 */
    const real r1_g0 = s->T + c->r1_product_1 * r1_product_3 + c->r1_product_1_2 * r1_product_6
        - c->r1_speed * s->speed - c->g * r1_product - c->r1_product * r1_product_2
        - c->r * r1_product_4 - c->r1_product_2 * r1_product_5;

    /* slider_crank.bg:18: r1: degree 1 */
    const real r1_d1 = -c->r1_w1_speed * s->speed - c->r1_w1_product * r1_product_2
        - c->r1_w1_product_2 * r1_product_5;

    /* slider_crank.bg:18: r1: error of order 0 */
    const real r1_e0 = c->bend1 * r1_g0;

    /* slider_crank.bg:18: r1: input of stage 2 */
    const real r1_u2 = r1_g0 - r1_d1 - r1_e0;

    /* slider_crank.bg:18: r1: stage 2 */
    const real r1_y2 = x->r1_s2 + c->b * r1_u2;

    /* slider_crank.bg:18: r1: stage 2: memory */
    x->r1_s2 = c->a * r1_y2 + c->b * r1_u2;

    /* slider_crank.bg:18: r1: input of stage 1 */
    const real r1_u1 = r1_y2 + r1_d1 + REAL(2.0) * r1_e0;

    /* slider_crank.bg:18: r1: stage 1 */
    const real r1_y1 = x->r1_s1 + c->b * r1_u1;

    /* slider_crank.bg:18: r1: stage 1: memory */
    x->r1_s1 = c->a * r1_y1 + c->b * r1_u1;

    /* slider_crank.bg:18: r1 = T - f*speed - J*D(speed) - r*sin(Int(speed))*x1*(load +
     * c*r*speed*sin(Int(speed))*x1 + m*r*D(speed*sin(Int(speed))*x1))
     * where x1 = r*cos(Int(speed))/sqrt(l^2 - r^2*sin(Int(speed))^2) + 1 */
    r[SLIDER_CRANK_R1] = r1_y1 - r1_e0;
}

/* One sample for r1; a number that is not finite makes the next sample the first. */
static void run_r1(
    slider_crank_monitor *monitor, const slider_crank_samples *s, slider_crank_residuals *residuals)
{
    real *r = residuals->value;
    uint32_t age = monitor->age[0];

    if (age == 0u) {
        start_r1(monitor, s, r);
    } else {
        next_r1(monitor, s, r);
    }
    /* a sum is finite only if all its terms are */
    if (finite_number(s->T + s->load + s->speed + r[SLIDER_CRANK_R1])) {
        age += age < UINT32_MAX ? 1u : 0u;
    } else {
        age = 0u;
        r[SLIDER_CRANK_R1] = REAL(0.0);
    }
    monitor->age[0] = age;
    residuals->valid[SLIDER_CRANK_R1] = age > monitor->settle[SLIDER_CRANK_R1];
}

void slider_crank_reset(slider_crank_monitor *monitor)
{
    int k;

    for (k = 0; k < 1; ++k) {
        monitor->age[k] = 0u;
    }
}

void slider_crank_step(
    slider_crank_monitor *monitor,
    const slider_crank_samples *samples,
    slider_crank_residuals *residuals)
{
    run_r1(monitor, samples, residuals);
}
