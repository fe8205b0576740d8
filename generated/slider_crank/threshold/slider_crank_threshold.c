/* slider_crank_threshold.c: the thresholds of SliderCrank_threshold; generated, see the header. */
#include "slider_crank_threshold.h"

#include <math.h>

#if defined __FINITE_MATH_ONLY__ && __FINITE_MATH_ONLY__
#error "this code tells numbers from NaN: compile it without -ffinite-math-only (-ffast-math)"
#endif

typedef slider_crank_threshold_real real;

#define REAL(x) SLIDER_CRANK_THRESHOLD_CONSTANT(x)
#if defined SLIDER_CRANK_THRESHOLD_FLOAT && !defined SLIDER_CRANK_THRESHOLD_REAL
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

uint32_t slider_crank_threshold_abi(void)
{
    return SLIDER_CRANK_THRESHOLD_ABI;
}

const char *slider_crank_threshold_digest(void)
{
    return SLIDER_CRANK_THRESHOLD_DIGEST;
}

void slider_crank_threshold_nominal(slider_crank_threshold_parameters *parameters)
{
    parameters->f = REAL(0.001);  /* N.m.s/rad */
    parameters->c = REAL(5.0);    /* N.s/m */
    parameters->r = REAL(0.04);   /* m */
    parameters->l = REAL(0.15);   /* m */
}

/* The coefficients of exact and of the filter, from the parameters. */
static void compute_coefficients(slider_crank_threshold_monitor *monitor,
        const slider_crank_threshold_parameters *p, real sample_time, real bandwidth)
{
    slider_crank_threshold_coefficients *c = &monitor->c;

    /* bandwidth*sample_time */
    const real x_ = bandwidth * sample_time;

    /* of a stage: what is left of its memory */
    const real pole = greatest(REAL(2.0) - x_, REAL(0.0)) / (x_ + REAL(2.0));

    /* 1 - pole */
    const real t = REAL(1.0) - pole;

    /* slider_crank.bg:18: r1_w1: factor of speed */
    c->r1_w1_speed = p->f / REAL(10.0);

    /* filter: what is left of a memory a sample later */
    c->a = pole;

    /* filter: weight of a sample, new and a sample later */
    c->b = REAL(0.5) * t;

    /* filter: 1 - b, the memory of a constant 1 */
    c->rest = REAL(1.0) - REAL(0.5) * t;

    /* half the sample time */
    c->half_time = REAL(0.5) * sample_time;

    /* sample_time/24 */
    c->half_twelfth = sample_time / REAL(24.0);

    /* slider_crank.bg:18: r^2 */
    c->g = p->r * p->r;

    /* slider_crank.bg:18: l^2 */
    c->g_2 = p->l * p->l;

    /* slider_crank.bg:18: r */
    c->r = p->r;

    /* slider_crank.bg:18: r1_w2: factor of
     * speed*sin(Int(speed))^2*cos(Int(speed))*(r*cos(Int(speed ... */
    c->r1_w2_product = p->c * p->r * p->r * p->r / REAL(5.0);

    /* slider_crank.bg:18: r1_w2: factor of speed*sin(Int(speed))^2*(r*cos(Int(speed))/sqrt(l^2 -
     * r^ ... */
    c->r1_w2_product_2 = p->c * p->r * p->r / REAL(5.0);
}

static bool parameters_are_finite(const slider_crank_threshold_parameters *p)
{
    return finite_number(p->f + p->c + p->r + p->l);
}

static bool coefficients_are_finite(const slider_crank_threshold_monitor *monitor)
{
    return finite_number(monitor->c.r1_w1_speed + monitor->c.a + monitor->c.b + monitor->c.rest
            + monitor->c.half_time + monitor->c.half_twelfth + monitor->c.g + monitor->c.g_2
            + monitor->c.r + monitor->c.r1_w2_product + monitor->c.r1_w2_product_2);
}

/* Samples until `constants` time constants of the filter are over. */
static uint32_t samples(real constants, real sample_time, real bandwidth)
{
    const real wait = constants / (bandwidth * sample_time);
    const uint32_t whole = wait < REAL(4.0e9) ? (uint32_t)wait : UINT32_MAX - 1u;

    return (real)whole < wait ? whole + 1u : whole;
}

slider_crank_threshold_status slider_crank_threshold_configure(
    slider_crank_threshold_monitor *monitor,
    const slider_crank_threshold_parameters *parameters,
    slider_crank_threshold_real sample_time,
    slider_crank_threshold_real bandwidth,
    slider_crank_threshold_real time_unit)
{
    int k;

    for (k = 0; k < SLIDER_CRANK_THRESHOLD_RESIDUALS; ++k) {
        monitor->settle[k] = UINT32_MAX;
    }
    slider_crank_threshold_reset(monitor);
    if (!parameters_are_finite(parameters)) {
        return SLIDER_CRANK_THRESHOLD_BAD_PARAMETER;
    }
    if (!(sample_time > REAL(0.0)) || !finite_number(sample_time)) {
        return SLIDER_CRANK_THRESHOLD_BAD_SAMPLE_TIME;
    }
    if (!(bandwidth * sample_time >= SLOWEST && bandwidth * sample_time <= REAL(3.0))) {
        return SLIDER_CRANK_THRESHOLD_BAD_BANDWIDTH;
    }
    if (!(time_unit > REAL(0.0)) || !finite_number(time_unit)) {
        return SLIDER_CRANK_THRESHOLD_BAD_TIME_UNIT;
    }
    compute_coefficients(monitor, parameters, sample_time, bandwidth);
    if (!coefficients_are_finite(monitor)) {
        return SLIDER_CRANK_THRESHOLD_BAD_COEFFICIENT;
    }
    monitor->settle[SLIDER_CRANK_THRESHOLD_R1] =
        samples(REAL(9.233413476451586), sample_time, bandwidth);
    return SLIDER_CRANK_THRESHOLD_OK;
}

void slider_crank_threshold_exact(
    const slider_crank_threshold_monitor *monitor,
    const slider_crank_threshold_derivatives *derivatives,
    slider_crank_threshold_real residuals[SLIDER_CRANK_THRESHOLD_RESIDUALS])
{
    real *r = residuals;

    (void)monitor;
    (void)derivatives;

    /* slider_crank.bg:18: r1: a threshold is made of filtered signals, only step has it */
    r[SLIDER_CRANK_THRESHOLD_R1] = (real)NAN;
}

/* r1 on its first sample: the filter as if it had always been so. */
static void start_r1(
    slider_crank_threshold_monitor *monitor, const slider_crank_threshold_samples *s, real *r)
{
    const slider_crank_threshold_coefficients *c = &monitor->c;
    slider_crank_threshold_memory *x = &monitor->x;

    /* slider_crank.bg:18: r1_w1: input of stage 2 */
    const real r1_w1_u2 = -c->r1_w1_speed * s->speed;

    /* slider_crank.bg:18: r1_w1: stage 2, at rest */
    const real r1_w1_y2 = r1_w1_u2;

    /* slider_crank.bg:18: r1_w1: stage 2: memory */
    x->r1_w1_s2 = c->rest * r1_w1_u2;

    /* slider_crank.bg:18: r1_w1: input of stage 1 */
    const real r1_w1_u1 = r1_w1_y2;

    /* slider_crank.bg:18: r1_w1: stage 1, at rest */
    const real r1_w1_y1 = r1_w1_u1;

    /* slider_crank.bg:18: r1_w1: stage 1: memory */
    x->r1_w1_s1 = c->rest * r1_w1_u1;

    /* slider_crank.bg:18: r1: what the tolerance of f can do */
    const real r1_w1 = r1_w1_y1;

    /* slider_crank.bg:18: integral of speed, at the start */
    const real r1_w2_int = REAL(0.0);

    /* slider_crank.bg:18: integral of speed: memory */
    x->r1_w2_q = c->half_time * s->speed;

    /* slider_crank.bg:18: integral of speed */
    const real r1_w2_integral = r1_w2_int;

    /* slider_crank.bg:18: integral of speed: memory */
    x->r1_w2_rate2 = s->speed;
    x->r1_w2_rate1 = s->speed;

    /* slider_crank.bg:18: sin(Int(speed)) */
    const real r1_w2_t = MATH(sin)(r1_w2_integral);

    /* slider_crank.bg:18: cos(Int(speed)) */
    const real r1_w2_t_2 = MATH(cos)(r1_w2_integral);

    /* slider_crank.bg:18: sqrt(l^2 - r^2*sin(Int(speed))^2) */
    const real r1_w2_t_3 = MATH(sqrt)(c->g_2 - c->g * r1_w2_t * r1_w2_t);

    /* slider_crank.bg:18: r*cos(Int(speed))/sqrt(l^2 - r^2*sin(Int(speed))^2) + 1 */
    const real r1_w2_t_4 = c->r * r1_w2_t_2 / r1_w2_t_3 + REAL(1.0);

    /* slider_crank.bg:18: speed*sin(Int(speed))^2*cos(Int(speed))*(r*cos(Int(speed ... */
    const real r1_w2_product = s->speed * r1_w2_t * r1_w2_t * r1_w2_t_2 * r1_w2_t_4 / r1_w2_t_3;

    /* slider_crank.bg:18: speed*sin(Int(speed))^2*(r*cos(Int(speed))/sqrt(l^2 - r^ ... */
    const real r1_w2_product_2 = s->speed * r1_w2_t * r1_w2_t * r1_w2_t_4;

    /* slider_crank.bg:18: r1_w2: input of stage 2 */
    const real r1_w2_u2 = -c->r1_w2_product * r1_w2_product - c->r1_w2_product_2 * r1_w2_product_2;

    /* slider_crank.bg:18: r1_w2: stage 2, at rest */
    const real r1_w2_y2 = r1_w2_u2;

    /* slider_crank.bg:18: r1_w2: stage 2: memory */
    x->r1_w2_s2 = c->rest * r1_w2_u2;

    /* slider_crank.bg:18: r1_w2: input of stage 1 */
    const real r1_w2_u1 = r1_w2_y2;

    /* slider_crank.bg:18: r1_w2: stage 1, at rest */
    const real r1_w2_y1 = r1_w2_u1;

    /* slider_crank.bg:18: r1_w2: stage 1: memory */
    x->r1_w2_s1 = c->rest * r1_w2_u1;

    /* slider_crank.bg:18: r1: what the tolerance of c can do */
    const real r1_w2 = r1_w2_y1;

    /* slider_crank.bg:18: r1: how far r1 can be from zero if no parameter is out of tolerance */
    r[SLIDER_CRANK_THRESHOLD_R1] = MATH(fabs)(r1_w1) + MATH(fabs)(r1_w2);
}

/* r1 on every further sample. */
static void next_r1(
    slider_crank_threshold_monitor *monitor, const slider_crank_threshold_samples *s, real *r)
{
    const slider_crank_threshold_coefficients *c = &monitor->c;
    slider_crank_threshold_memory *x = &monitor->x;

    /* slider_crank.bg:18: r1_w1: input of stage 2 */
    const real r1_w1_u2 = -c->r1_w1_speed * s->speed;

    /* slider_crank.bg:18: r1_w1: stage 2 */
    const real r1_w1_y2 = x->r1_w1_s2 + c->b * r1_w1_u2;

    /* slider_crank.bg:18: r1_w1: stage 2: memory */
    x->r1_w1_s2 = c->a * r1_w1_y2 + c->b * r1_w1_u2;

    /* slider_crank.bg:18: r1_w1: input of stage 1 */
    const real r1_w1_u1 = r1_w1_y2;

    /* slider_crank.bg:18: r1_w1: stage 1 */
    const real r1_w1_y1 = x->r1_w1_s1 + c->b * r1_w1_u1;

    /* slider_crank.bg:18: r1_w1: stage 1: memory */
    x->r1_w1_s1 = c->a * r1_w1_y1 + c->b * r1_w1_u1;

    /* slider_crank.bg:18: r1: what the tolerance of f can do */
    const real r1_w1 = r1_w1_y1;

    /* slider_crank.bg:18: integral of speed */
    const real r1_w2_int = x->r1_w2_q + c->half_time * s->speed;

    /* slider_crank.bg:18: integral of speed: memory */
    x->r1_w2_q = r1_w2_int + c->half_time * s->speed;

    /* slider_crank.bg:18: integral of speed */
    const real r1_w2_integral = r1_w2_int
        - c->half_twelfth * (REAL(3.0) * s->speed - REAL(4.0) * x->r1_w2_rate1 + x->r1_w2_rate2);

    /* slider_crank.bg:18: integral of speed: memory */
    x->r1_w2_rate2 = x->r1_w2_rate1;
    x->r1_w2_rate1 = s->speed;

    /* slider_crank.bg:18: sin(Int(speed)) */
    const real r1_w2_t = MATH(sin)(r1_w2_integral);

    /* slider_crank.bg:18: cos(Int(speed)) */
    const real r1_w2_t_2 = MATH(cos)(r1_w2_integral);

    /* slider_crank.bg:18: sqrt(l^2 - r^2*sin(Int(speed))^2) */
    const real r1_w2_t_3 = MATH(sqrt)(c->g_2 - c->g * r1_w2_t * r1_w2_t);

    /* slider_crank.bg:18: r*cos(Int(speed))/sqrt(l^2 - r^2*sin(Int(speed))^2) + 1 */
    const real r1_w2_t_4 = c->r * r1_w2_t_2 / r1_w2_t_3 + REAL(1.0);

    /* slider_crank.bg:18: speed*sin(Int(speed))^2*cos(Int(speed))*(r*cos(Int(speed ... */
    const real r1_w2_product = s->speed * r1_w2_t * r1_w2_t * r1_w2_t_2 * r1_w2_t_4 / r1_w2_t_3;

    /* slider_crank.bg:18: speed*sin(Int(speed))^2*(r*cos(Int(speed))/sqrt(l^2 - r^ ... */
    const real r1_w2_product_2 = s->speed * r1_w2_t * r1_w2_t * r1_w2_t_4;

    /* slider_crank.bg:18: r1_w2: input of stage 2 */
    const real r1_w2_u2 = -c->r1_w2_product * r1_w2_product - c->r1_w2_product_2 * r1_w2_product_2;

    /* slider_crank.bg:18: r1_w2: stage 2 */
    const real r1_w2_y2 = x->r1_w2_s2 + c->b * r1_w2_u2;

    /* slider_crank.bg:18: r1_w2: stage 2: memory */
    x->r1_w2_s2 = c->a * r1_w2_y2 + c->b * r1_w2_u2;

    /* slider_crank.bg:18: r1_w2: input of stage 1 */
    const real r1_w2_u1 = r1_w2_y2;

    /* slider_crank.bg:18: r1_w2: stage 1 */
    const real r1_w2_y1 = x->r1_w2_s1 + c->b * r1_w2_u1;

    /* slider_crank.bg:18: r1_w2: stage 1: memory */
    x->r1_w2_s1 = c->a * r1_w2_y1 + c->b * r1_w2_u1;

    /* slider_crank.bg:18: r1: what the tolerance of c can do */
    const real r1_w2 = r1_w2_y1;

    /* slider_crank.bg:18: r1: how far r1 can be from zero if no parameter is out of tolerance */
    r[SLIDER_CRANK_THRESHOLD_R1] = MATH(fabs)(r1_w1) + MATH(fabs)(r1_w2);
}

/* One sample for r1; a number that is not finite makes the next sample the first. */
static void run_r1(
    slider_crank_threshold_monitor *monitor, const slider_crank_threshold_samples *s, slider_crank_threshold_residuals *residuals)
{
    real *r = residuals->value;
    uint32_t age = monitor->age[0];

    if (age == 0u) {
        start_r1(monitor, s, r);
    } else {
        next_r1(monitor, s, r);
    }
    /* a sum is finite only if all its terms are */
    if (finite_number(s->speed + r[SLIDER_CRANK_THRESHOLD_R1])) {
        age += age < UINT32_MAX ? 1u : 0u;
    } else {
        age = 0u;
        r[SLIDER_CRANK_THRESHOLD_R1] = REAL(0.0);
    }
    monitor->age[0] = age;
    residuals->valid[SLIDER_CRANK_THRESHOLD_R1] = age > monitor->settle[SLIDER_CRANK_THRESHOLD_R1];
}

void slider_crank_threshold_reset(slider_crank_threshold_monitor *monitor)
{
    int k;

    for (k = 0; k < 1; ++k) {
        monitor->age[k] = 0u;
    }
}

void slider_crank_threshold_step(
    slider_crank_threshold_monitor *monitor,
    const slider_crank_threshold_samples *samples,
    slider_crank_threshold_residuals *residuals)
{
    run_r1(monitor, samples, residuals);
}
