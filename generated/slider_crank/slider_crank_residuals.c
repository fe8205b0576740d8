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

const char slider_crank_fault_name[SLIDER_CRANK_FAULTS][6] = {
    "J", "f", "m", "c", "r", "l", "T", "load", "speed",
};

const uint16_t slider_crank_fault_class[SLIDER_CRANK_FAULTS] = {
    0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u,
};

const char slider_crank_residual_name[SLIDER_CRANK_RESIDUALS][3] = {
    "r1",
};

/* Signatures: 1 where a residual may be moved by the faults of a class, 3 where it is for sure. */
static const uint8_t signature[SLIDER_CRANK_CLASSES][SLIDER_CRANK_RESIDUALS] = {
    {3u},
};

#define NEVER REAL(1e30) /* a limit that nothing exceeds */
#define RELEASE REAL(0.5) /* of its level: what is nearer is quiet */
#define OVERSHOOT REAL(1.166) /* of the mean of sums over their height */
#define SHARE REAL(0.3333333333333333) /* of the height, that a row adds at most */

/* A sum, kept between zero and twice its height. */
static real kept(real sum, real height)
{
    const real most = height + height;

    return sum < REAL(0.0) ? REAL(0.0) : sum > most ? most : sum;
}

/* One row more of residual k; whether a sum is too high. off: from the mean, out: beyond bound. */
static bool add_row(
    slider_crank_diagnosis *d, const slider_crank_limit *limit, int k, real off, real out, real bound)
{
    const real top = limit->height + OVERSHOOT;
    const real beyond = out > REAL(0.0) ? out : REAL(0.0);
    const real loud = beyond * beyond * limit->loud - limit->drift;
    const real most = SHARE * top;

    d->above[k] = kept(d->above[k] + ((off - bound) * limit->unit - REAL(0.5)), limit->height);
    d->below[k] = kept(d->below[k] + ((-off - bound) * limit->unit - REAL(0.5)), limit->height);
    d->louder[k] = kept(d->louder[k] + (loud > most ? most : loud), top);
    return d->above[k] > limit->height || d->below[k] > limit->height || d->louder[k] > top;
}

static bool sums_are_zero(const slider_crank_diagnosis *d, int k)
{
    const real sum = d->above[k] + d->below[k] + d->louder[k];

    return !(sum > REAL(0.0));
}

static void forget_sums(slider_crank_diagnosis *d, int k)
{
    d->above[k] = REAL(0.0);
    d->below[k] = REAL(0.0);
    d->louder[k] = REAL(0.0);
    d->streak[k] = 0u;
}

/* Residual k in one sample; whether it goes into alarm. */
static bool watch(
    slider_crank_diagnosis *d, const slider_crank_limit *limit, int k, real value, real bound, bool row)
{
    const real off = value - limit->mean;
    const real out = (off < REAL(0.0) ? -off : off) - bound;
    bool high = false;

    if (row) {
        high = add_row(d, limit, k, off, out, bound);
    }
    if (d->state[k] == SLIDER_CRANK_ALARM) {
        d->since[k] += d->since[k] < UINT32_MAX ? 1u : 0u;
        if (!(out < RELEASE * limit->level) || !sums_are_zero(d, k)) {
            d->quiet = 0u;
        }
        return false;
    }
    d->state[k] = SLIDER_CRANK_HEALTHY;
    d->streak[k] = out > limit->level ? d->streak[k] + 1u : 0u;
    if (d->streak[k] < d->least && !high) {
        return false;
    }
    d->state[k] = SLIDER_CRANK_ALARM;
    d->since[k] = 0u;
    return true;
}

/* What is left of a class of faults. */
static slider_crank_candidate left_of(const slider_crank_diagnosis *d, const uint8_t *own)
{
    slider_crank_candidate found = SLIDER_CRANK_LIKELY;
    int k;

    for (k = 0; k < SLIDER_CRANK_RESIDUALS; ++k) {
        if (d->state[k] == SLIDER_CRANK_ALARM && own[k] == 0u) {
            return SLIDER_CRANK_RULED_OUT;
        }
        if (d->state[k] == SLIDER_CRANK_HEALTHY && own[k] == 3u) {
            found = SLIDER_CRANK_SMALL;
        }
    }
    return found;
}

/* Which classes of faults the residuals leave, and the one if it is one. */
static void judge(slider_crank_diagnosis *d)
{
    int likely = 0;
    int c;

    d->fault_class = SLIDER_CRANK_UNKNOWN;
    for (c = 0; c < SLIDER_CRANK_CLASSES; ++c) {
        const slider_crank_candidate left = left_of(d, signature[c]);

        d->candidate[c] = (uint8_t)left;
        if (left == SLIDER_CRANK_LIKELY) {
            d->fault_class = (int16_t)c;
            ++likely;
        }
    }
    if (likely != 1 || d->settled < 2u * d->row) {
        d->fault_class = SLIDER_CRANK_UNKNOWN;
    }
}

slider_crank_limit slider_crank_limit_of(slider_crank_real level)
{
    slider_crank_limit limit;

    limit.mean = REAL(0.0);
    limit.level = level;
    limit.unit = REAL(0.0);
    limit.loud = REAL(0.0);
    limit.drift = REAL(0.5);
    limit.height = NEVER;
    limit.bound = REAL(0.0);
    return limit;
}

void slider_crank_clear(slider_crank_diagnosis *diagnosis)
{
    int k;

    for (k = 0; k < SLIDER_CRANK_RESIDUALS; ++k) {
        if (diagnosis->state[k] == SLIDER_CRANK_ALARM) {
            diagnosis->state[k] = SLIDER_CRANK_HEALTHY;
        }
        diagnosis->since[k] = 0u;
        forget_sums(diagnosis, k);
    }
    for (k = 0; k < SLIDER_CRANK_CLASSES; ++k) {
        diagnosis->candidate[k] = SLIDER_CRANK_RULED_OUT;
    }
    diagnosis->fault_class = SLIDER_CRANK_UNKNOWN;
    diagnosis->quiet = 0u;
    diagnosis->settled = 0u;
}

void slider_crank_diagnosis_reset(slider_crank_diagnosis *diagnosis)
{
    int k;

    diagnosis->row = SLIDER_CRANK_ROW;
    diagnosis->least = 15u;
    diagnosis->hold = 10u * SLIDER_CRANK_ROW;
    diagnosis->latch = false;
    diagnosis->tick = 0u;
    for (k = 0; k < SLIDER_CRANK_RESIDUALS; ++k) {
        diagnosis->state[k] = SLIDER_CRANK_BLIND;
    }
    slider_crank_clear(diagnosis);
}

bool slider_crank_diagnose(
    slider_crank_diagnosis *diagnosis,
    const slider_crank_limit *limits,
    const slider_crank_real *bounds,
    const slider_crank_residuals *residuals)
{
    slider_crank_diagnosis *d = diagnosis;
    bool alarm = false;
    bool fresh = false;
    bool row;
    int k;

    d->tick += 1u;
    row = d->tick >= d->row;
    if (row) {
        d->tick = 0u;
    }
    d->quiet += d->quiet < UINT32_MAX ? 1u : 0u;
    d->settled += d->settled < UINT32_MAX ? 1u : 0u;
    for (k = 0; k < SLIDER_CRANK_RESIDUALS; ++k) {
        if (residuals->valid[k]) {
            const real bound = bounds ? bounds[k] : limits[k].bound;

            fresh = watch(d, &limits[k], k, residuals->value[k], bound, row) || fresh;
        } else {
            forget_sums(d, k);
            if (d->state[k] == SLIDER_CRANK_ALARM) {
                d->quiet = 0u; /* nobody knows that it is over */
            } else {
                d->state[k] = SLIDER_CRANK_BLIND;
            }
        }
        alarm = alarm || d->state[k] == SLIDER_CRANK_ALARM;
    }
    if (fresh) {
        d->quiet = 0u;
        d->settled = 0u;
    }
    if (alarm && !d->latch && d->quiet >= d->hold) {
        slider_crank_clear(d);
        return false;
    }
    if (fresh || (alarm && row)) {
        judge(d);
    }
    return alarm;
}
