/* slider_crank.c: the residuals of SliderCrank; generated, see the header. */
#include "slider_crank.h"

#include <math.h>
#include <stddef.h>

#if defined __FINITE_MATH_ONLY__ && __FINITE_MATH_ONLY__
#error "this code tells numbers from NaN: compile it without -ffinite-math-only (-ffast-math)"
#endif

typedef slider_crank_real real;

#define REAL(x) SLIDER_CRANK_CONSTANT(x)
#if defined SLIDER_CRANK_FLOAT && !defined SLIDER_CRANK_REAL
#define MATH(name) name##f
#else
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

/* The least bandwidth * sample_time at which a filter still moves. */
#if defined SLIDER_CRANK_FLOAT && !defined SLIDER_CRANK_REAL
#define SLOWEST REAL(0.0001)
#else
#define SLOWEST REAL(1.0e-09)
#endif

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

/* Whether configure may go on with what it is given. */
static slider_crank_status checked(const slider_crank_parameters *p, real sample_time, real bandwidth)
{
    const bool finite = finite_number(p->J + p->f + p->m + p->c + p->r + p->l);

    if (!finite) {
        return SLIDER_CRANK_BAD_PARAMETER;
    }
    if (!(sample_time > REAL(0.0)) || !finite_number(sample_time)) {
        return SLIDER_CRANK_BAD_SAMPLE_TIME;
    }
    if (!(bandwidth * sample_time >= SLOWEST && bandwidth * sample_time <= REAL(3.0))) {
        return SLIDER_CRANK_BAD_BANDWIDTH;
    }
    return SLIDER_CRANK_OK;
}

/* Samples until `constants` time constants of the filter are over. */
static uint32_t samples(real constants, real sample_time, real bandwidth)
{
    const real wait = constants / (bandwidth * sample_time);
    const uint32_t whole = wait < REAL(4.0e9) ? (uint32_t)wait : UINT32_MAX - 1u;

    return (real)whole < wait ? whole + 1u : whole;
}

const slider_crank_coefficients slider_crank_nominal_coefficients = {
    REAL(0.0016),                  /* r */
    REAL(0.0225),                  /* l */
    REAL(0.04),                    /* r_2 */
    REAL(0.001),                   /* r1_speed */
    REAL(0.00032),                 /* r1_product */
    REAL(2.5600000000000002e-05),  /* r1_product_1 */
    REAL(0.008),                   /* r1_product_2 */
    REAL(0.00064),                 /* r1_product_1_2 */
    REAL(4.1666666666666665e-05),  /* scaled_sample_time */
    REAL(0.040000000000000036),    /* r1_w1_speed */
    REAL(0.0005120000000000005),   /* r1_w1_product */
    REAL(0.012800000000000013),    /* r1_w1_product_2 */
    REAL(3.3333333333333396e-05),  /* bend1 */
    REAL(0.9801980198019802),      /* a */
    REAL(0.00990099009900991),     /* b */
    {462u},                        /* samples until each is valid */
    462u                           /* the longest of these */
};

/* r1: coefficients */
static void compute_r1(slider_crank_coefficients *c, const slider_crank_parameters *p,
        real sample_time, real turn)
{
    /* w of the filter 1/(1 + D/w) */
    const real w = turn / sample_time;

    /* slider_crank.bg:18: r1: factor of speed: f */
    c->r1_speed = p->f;

    /* r1: factor of speed*sin(Int(speed))^2*cos(Int(speed))*(r*cos(Int(speed))/sqrt(l^2 -
     * r^2*sin(Int(speed))^2) + 1)/sqrt(l^2 - r^2*sin(Int(speed))^2): c*r^3 */
    c->r1_product = p->c * p->r * p->r * p->r;

    /* r1: factor of D(speed*sin(Int(speed))^2*cos(Int(speed))*(r*cos(Int(speed))/sqrt(l^2 -
     * r^2*sin(Int(speed))^2) + 1)/sqrt(l^2 - r^2*sin(Int(speed))^2)): m*r^3 */
    c->r1_product_1 = p->m * p->r * p->r * p->r;

    /* r1: factor of speed*sin(Int(speed))^2*(r*cos(Int(speed))/sqrt(l^2 - r^2*sin(Int(speed))^2)
     * + 1): c*r^2 */
    c->r1_product_2 = p->c * p->r * p->r;

    /* r1: factor of D(speed*sin(Int(speed))^2*(r*cos(Int(speed))/sqrt(l^2 -
     * r^2*sin(Int(speed))^2) + 1)): m*r^2 */
    c->r1_product_1_2 = p->m * p->r * p->r;

    /* r1: factor of speed' */
    c->r1_w1_speed = p->J * w;

    /* r1: factor of D(speed*sin(Int(speed))^2*cos(Int(speed))*(r*cos(Int(speed))/sqrt(l^2 -
     * r^2*sin(Int(speed))^2) + 1)/sqrt(l^2 - r^2*sin(Int(speed))^2)) */
    c->r1_w1_product = p->m * p->r * p->r * p->r * w;

    /* r1: factor of D(speed*sin(Int(speed))^2*(r*cos(Int(speed))/sqrt(l^2 -
     * r^2*sin(Int(speed))^2) + 1)) */
    c->r1_w1_product_2 = p->m * p->r * p->r * w;
}

/* filter: coefficients */
static void compute_filter(slider_crank_coefficients *c, real pole, real turn)
{
    /* filter: 1 * (w*sample_time)^2/12 */
    c->bend1 = turn * turn / REAL(12.0);

    /* filter: what is left of a memory a sample later */
    c->a = pole;

    /* filter: weight of a sample, new and a sample later */
    c->b = REAL(0.5) * (REAL(1.0) - pole);
}

/* The coefficients, from the parameters. */
static void compute_coefficients(slider_crank_coefficients *c, const slider_crank_parameters *p,
        real sample_time, real bandwidth)
{
    /* bandwidth*sample_time */
    const real x_ = bandwidth * sample_time;

    /* of a stage: what is left of its memory */
    const real pole = greatest(REAL(2.0) - x_, REAL(0.0)) / (x_ + REAL(2.0));

    /* w*sample_time, x or 2 */
    const real turn = REAL(2.0) * (REAL(1.0) - pole) / (pole + REAL(1.0));

    /* slider_crank.bg:18: r^2 */
    c->r = p->r * p->r;

    /* l^2 */
    c->l = p->l * p->l;

    /* r */
    c->r_2 = p->r;

    /* sample_time/24 */
    c->scaled_sample_time = sample_time / REAL(24.0);

    compute_r1(c, p, sample_time, turn);
    compute_filter(c, pole, turn);
}

static bool coefficients_are_finite(const slider_crank_coefficients *c)
{
    return finite_number(c->r + c->l + c->r_2 + c->r1_speed + c->r1_product + c->r1_product_1
            + c->r1_product_2 + c->r1_product_1_2 + c->scaled_sample_time + c->r1_w1_speed
            + c->r1_w1_product + c->r1_w1_product_2 + c->bend1 + c->a + c->b);
}

slider_crank_status slider_crank_configure(
    slider_crank_coefficients *coefficients,
    const slider_crank_parameters *parameters,
    slider_crank_real sample_time,
    slider_crank_real bandwidth)
{
    slider_crank_coefficients *c = coefficients;
    const slider_crank_status status = checked(parameters, sample_time, bandwidth);
    int k;

    for (k = 0; k < SLIDER_CRANK_RESIDUALS; ++k) {
        c->settle[k] = UINT32_MAX;
    }
    c->longest = UINT32_MAX;
    if (status != SLIDER_CRANK_OK) {
        return status;
    }
    compute_coefficients(c, parameters, sample_time, bandwidth);
    if (!coefficients_are_finite(c)) {
        return SLIDER_CRANK_BAD_COEFFICIENT;
    }
    c->settle[SLIDER_CRANK_R1] = samples(REAL(9.233413476451586), sample_time, bandwidth);
    c->longest = c->settle[SLIDER_CRANK_R1];
    return SLIDER_CRANK_OK;
}

/* terms of order 0; degree 1 */
static void run_r1_g0_to_d1(const slider_crank_coefficients *c, slider_crank_memory *x,
        const slider_crank_samples *s, real rate, real *g0_out, real *d1_out)
{
    /* its integral since the start, by the rule of Adams */
    const real integral = x->r1_q + REAL(9.0) * rate + REAL(4.0) * x->r1_rate1 - x->r1_rate2;
    x->r1_q = x->r1_q + REAL(24.0) * rate;
    x->r1_rate2 = x->r1_rate1;
    x->r1_rate1 = rate;

    /* sin(Int(speed)) */
    const real sin_x = MATH(sin)(integral);

    /* cos(Int(speed)) */
    const real cos_x = MATH(cos)(integral);

    /* sqrt(l^2 - r^2*sin(Int(speed))^2) */
    const real sqrt_x = MATH(sqrt)(c->l - c->r * sin_x * sin_x);

    /* r*cos(Int(speed))/sqrt(l^2 - r^2*sin(Int(speed))^2) + 1 */
    const real sum = c->r_2 * cos_x / sqrt_x + REAL(1.0);

    /* load*sin(Int(speed))*cos(Int(speed))/sqrt(l^2 - r^2*sin(Int(speed))^2) */
    const real product = s->load * sin_x * cos_x / sqrt_x;

    /* speed*sin(Int(speed))^2*cos(Int(speed))*(r*cos(Int(speed))/sqrt(l^2 -
     * r^2*sin(Int(speed))^2) + 1)/sqrt(l^2 - r^2*sin(Int(speed))^2) */
    const real product_2 = s->speed * sin_x * sin_x * cos_x * sum / sqrt_x;

    /* a product */
    const real product_3 = s->speed * sin_x * sum * (s->speed * cos_x * cos_x / sqrt_x
            + c->r * s->speed * sin_x * sin_x * cos_x * cos_x / sqrt_x / sqrt_x / sqrt_x
            - s->speed * sin_x * sin_x / sqrt_x);

    /* load*sin(Int(speed)) */
    const real product_4 = s->load * sin_x;

    /* speed*sin(Int(speed))^2*(r*cos(Int(speed))/sqrt(l^2 - r^2*sin(Int(speed))^2) + 1) */
    const real product_5 = s->speed * sin_x * sin_x * sum;

    /* speed^2*sin(Int(speed))*cos(Int(speed))*(r*cos(Int(speed))/sqrt(l^2 -
     * r^2*sin(Int(speed))^2) + 1) */
    const real product_6 = s->speed * s->speed * sin_x * cos_x * sum;

    /* terms of order 0 */
    const real g0 = s->T + c->r1_product_1 * product_3 + c->r1_product_1_2 * product_6
        - c->r1_speed * s->speed - c->r * product - c->r1_product * product_2 - c->r_2 * product_4
        - c->r1_product_2 * product_5;

    /* degree 1 */
    const real d1 = c->r1_w1_speed * s->speed + c->r1_w1_product * product_2
        + c->r1_w1_product_2 * product_5;

    *g0_out = g0;
    *d1_out = d1;
}

/* r1 on one sample.
 * slider_crank.bg:18: r1 = T - f*speed - J*D(speed) - r*sin(Int(speed))*x1*(load +
 * c*r*speed*sin(Int(speed))*x1 + m*r*D(speed*sin(Int(speed))*x1))
 * where x1 = r*cos(Int(speed))/sqrt(l^2 - r^2*sin(Int(speed))^2) + 1 */
static void run_r1(
    const slider_crank_coefficients *c, slider_crank_memory *x, const slider_crank_samples *s, real *r)
{
    const bool first = x->youngest == 0u && x->age[0] == 0u;

    if (first) {
        /* nothing is remembered yet */
        x->r1_s2 = REAL(0.0);
        x->r1_s1 = REAL(0.0);
    }

    /* a stage of the filter; on the first sample it is at rest */
    const real a = first ? -c->b : c->a;
    const real b = first ? REAL(1.0) : c->b;

    /* sample_time/24 times speed, what is integrated */
    const real rate = c->scaled_sample_time * s->speed;

    if (first) {
        /* r1: the integral is 0 at the start */
        x->r1_q = -REAL(12.0) * rate;
        x->r1_rate1 = rate;
        x->r1_rate2 = rate;
    }

    real g0;
    real d1;

    run_r1_g0_to_d1(c, x, s, rate, &g0, &d1);

    /* error of order 0 */
    const real e0 = c->bend1 * g0;

    /* the filter multiplied out */
    const real p1_1 = e0 - d1;

    /* stage 2 */
    const real u2 = g0 - p1_1;
    const real y2 = x->r1_s2 + b * u2;
    x->r1_s2 = a * y2 + b * u2;

    /* stage 1 */
    const real u1 = y2 + p1_1 + e0;
    const real y1 = x->r1_s1 + b * u1;
    x->r1_s1 = a * y1 + b * u1;

    r[SLIDER_CRANK_R1] = y1 - e0;
}

/* Ages and validity one by one: a number that is not finite makes the next sample the first. */
static void count_samples(
    const slider_crank_coefficients *c,
    slider_crank_memory *x,
    slider_crank_residuals *out)
{
    /* the residuals that are computed, and what each one goes with */
    static const uint8_t number[] = {
        0
    };
    static const uint8_t part[] = {
        0
    };
    bool finite[1];
    int k;

    finite[0] = true;
    for (k = 0; k < 1; ++k) {
        finite[part[k]] = finite[part[k]] && finite_number(out->value[number[k]]);
    }
    x->youngest = UINT32_MAX;
    for (k = 0; k < 1; ++k) {
        x->age[k] = finite[k] ? x->age[k] + (x->age[k] < UINT32_MAX ? 1u : 0u) : 0u;
        x->youngest = x->age[k] < x->youngest ? x->age[k] : x->youngest;
    }
    for (k = 0; k < 1; ++k) {
        out->value[number[k]] = finite[part[k]] ? out->value[number[k]] : REAL(0.0);
        out->valid[number[k]] = x->age[part[k]] > c->settle[number[k]];
    }
}

void slider_crank_reset(slider_crank_memory *memory)
{
    int k;

    for (k = 0; k < 1; ++k) {
        memory->age[k] = 0u;
    }
    memory->youngest = 0u;
}

void slider_crank_step(
    const slider_crank_coefficients *coefficients,
    slider_crank_memory *memory,
    const slider_crank_samples *samples,
    slider_crank_residuals *residuals)
{
    const slider_crank_coefficients *c = coefficients;
    slider_crank_memory *x = memory;
    const slider_crank_samples *s = samples;
    real *r = residuals->value;
    int k;

    run_r1(c, x, s, r);
    /* a sum is finite only if all its terms are */
    if (x->youngest > c->longest && finite_number(r[SLIDER_CRANK_R1])) {
        for (k = 0; k < SLIDER_CRANK_RESIDUALS; ++k) {
            residuals->valid[k] = true;
        }
    } else {
        count_samples(c, x, residuals);
    }
}

#ifndef SLIDER_CRANK_NO_THRESHOLDS

const slider_crank_threshold_coefficients slider_crank_threshold_nominal_coefficients = {
    REAL(0.0001),                  /* r1_w1_speed */
    REAL(0.9801980198019802),      /* a */
    REAL(0.00990099009900991),     /* b */
    REAL(4.1666666666666665e-05),  /* scaled_sample_time */
    REAL(0.0016),                  /* r */
    REAL(0.0225),                  /* l */
    REAL(0.04),                    /* r_2 */
    REAL(6.400000000000001e-05),   /* r1_w2_product */
    REAL(0.0016),                  /* r1_w2_product_2 */
    {462u},                        /* samples until each is valid */
    462u                           /* the longest of these */
};

/* The coefficients, from the parameters. */
static void bound_compute_coefficients(slider_crank_threshold_coefficients *c,
        const slider_crank_parameters *p, real sample_time, real bandwidth)
{
    /* bandwidth*sample_time */
    const real x_ = bandwidth * sample_time;

    /* of a stage: what is left of its memory */
    const real pole = greatest(REAL(2.0) - x_, REAL(0.0)) / (x_ + REAL(2.0));

    /* slider_crank.bg:18: r1_w1: factor of speed */
    c->r1_w1_speed = p->f / REAL(10.0);

    /* filter: what is left of a memory a sample later */
    c->a = pole;

    /* filter: weight of a sample, new and a sample later */
    c->b = REAL(0.5) * (REAL(1.0) - pole);

    /* slider_crank.bg:18: sample_time/24 */
    c->scaled_sample_time = sample_time / REAL(24.0);

    /* r^2 */
    c->r = p->r * p->r;

    /* l^2 */
    c->l = p->l * p->l;

    /* r */
    c->r_2 = p->r;

    /* r1_w2: factor of speed*sin(Int(speed))^2*cos(Int(speed))*(r*cos(Int(speed))/sqrt(l^2 -
     * r^2*sin(Int(speed))^2) + 1)/sqrt(l^2 - r^2*sin(Int(speed))^2) */
    c->r1_w2_product = p->c * p->r * p->r * p->r / REAL(5.0);

    /* r1_w2: factor of speed*sin(Int(speed))^2*(r*cos(Int(speed))/sqrt(l^2 -
     * r^2*sin(Int(speed))^2) + 1) */
    c->r1_w2_product_2 = p->c * p->r * p->r / REAL(5.0);
}

static bool bound_coefficients_are_finite(const slider_crank_threshold_coefficients *c)
{
    return finite_number(c->r1_w1_speed + c->a + c->b + c->scaled_sample_time + c->r + c->l + c->r_2
            + c->r1_w2_product + c->r1_w2_product_2);
}

slider_crank_status slider_crank_threshold_configure(
    slider_crank_threshold_coefficients *coefficients,
    const slider_crank_parameters *parameters,
    slider_crank_real sample_time,
    slider_crank_real bandwidth)
{
    slider_crank_threshold_coefficients *c = coefficients;
    const slider_crank_status status = checked(parameters, sample_time, bandwidth);
    int k;

    for (k = 0; k < SLIDER_CRANK_RESIDUALS; ++k) {
        c->settle[k] = UINT32_MAX;
    }
    c->longest = UINT32_MAX;
    if (status != SLIDER_CRANK_OK) {
        return status;
    }
    bound_compute_coefficients(c, parameters, sample_time, bandwidth);
    if (!bound_coefficients_are_finite(c)) {
        return SLIDER_CRANK_BAD_COEFFICIENT;
    }
    c->settle[SLIDER_CRANK_R1] = samples(REAL(9.233413476451586), sample_time, bandwidth);
    c->longest = c->settle[SLIDER_CRANK_R1];
    return SLIDER_CRANK_OK;
}

/* what the tolerance of f can do */
static real bound_r1_w1(const slider_crank_threshold_coefficients *c,
        slider_crank_threshold_memory *x, const slider_crank_samples *s, real w1_a, real w1_b)
{
    /* r1_w1: stage 2 */
    const real w1_u2 = -c->r1_w1_speed * s->speed;
    const real w1_y2 = x->r1_w1_s2 + w1_b * w1_u2;
    x->r1_w1_s2 = w1_a * w1_y2 + w1_b * w1_u2;

    /* r1_w1: stage 1 */
    const real w1_u1 = w1_y2;
    const real w1_y1 = x->r1_w1_s1 + w1_b * w1_u1;
    x->r1_w1_s1 = w1_a * w1_y1 + w1_b * w1_u1;

    /* what the tolerance of f can do */
    const real w1 = w1_y1;

    return w1;
}

/* its integral since the start, by the rule of Adams */
static real bound_r1_w2_integral(slider_crank_threshold_memory *x, bool first, real w2_rate)
{
    if (first) {
        /* r1_w2: the integral is 0 at the start */
        x->r1_w2_q = -REAL(12.0) * w2_rate;
        x->r1_w2_rate1 = w2_rate;
        x->r1_w2_rate2 = w2_rate;
    }

    /* r1_w2: its integral since the start, by the rule of Adams */
    const real w2_integral = x->r1_w2_q + REAL(9.0) * w2_rate + REAL(4.0) * x->r1_w2_rate1
        - x->r1_w2_rate2;
    x->r1_w2_q = x->r1_w2_q + REAL(24.0) * w2_rate;
    x->r1_w2_rate2 = x->r1_w2_rate1;
    x->r1_w2_rate1 = w2_rate;

    return w2_integral;
}

/* r1 on one sample.
 * slider_crank.bg:18: r1: how far r1 can be from zero if no parameter is out of tolerance */
static void bound_r1(
    const slider_crank_threshold_coefficients *c, slider_crank_threshold_memory *x, const slider_crank_samples *s, real *r)
{
    const bool first = x->youngest == 0u && x->age[0] == 0u;

    if (first) {
        /* nothing is remembered yet */
        x->r1_w1_s2 = REAL(0.0);
        x->r1_w1_s1 = REAL(0.0);
    }

    /* r1_w1: a stage of the filter; on the first sample it is at rest */
    const real w1_a = first ? -c->b : c->a;
    const real w1_b = first ? REAL(1.0) : c->b;

    const real w1 = bound_r1_w1(c, x, s, w1_a, w1_b);

    if (first) {
        /* nothing is remembered yet */
        x->r1_w2_s2 = REAL(0.0);
        x->r1_w2_s1 = REAL(0.0);
    }

    /* sample_time/24 times speed, what is integrated */
    const real w2_rate = c->scaled_sample_time * s->speed;

    const real w2_integral = bound_r1_w2_integral(x, first, w2_rate);

    /* sin(Int(speed)) */
    const real w2_sin_x = MATH(sin)(w2_integral);

    /* cos(Int(speed)) */
    const real w2_cos_x = MATH(cos)(w2_integral);

    /* sqrt(l^2 - r^2*sin(Int(speed))^2) */
    const real w2_sqrt_x = MATH(sqrt)(c->l - c->r * w2_sin_x * w2_sin_x);

    /* r*cos(Int(speed))/sqrt(l^2 - r^2*sin(Int(speed))^2) + 1 */
    const real w2_sum = c->r_2 * w2_cos_x / w2_sqrt_x + REAL(1.0);

    /* speed*sin(Int(speed))^2*cos(Int(speed))*(r*cos(Int(speed))/sqrt(l^2 -
     * r^2*sin(Int(speed))^2) + 1)/sqrt(l^2 - r^2*sin(Int(speed))^2) */
    const real w2_product = s->speed * w2_sin_x * w2_sin_x * w2_cos_x * w2_sum / w2_sqrt_x;

    /* speed*sin(Int(speed))^2*(r*cos(Int(speed))/sqrt(l^2 - r^2*sin(Int(speed))^2) + 1) */
    const real w2_product_2 = s->speed * w2_sin_x * w2_sin_x * w2_sum;

    /* r1_w2: stage 2 */
    const real w2_u2 = -c->r1_w2_product * w2_product - c->r1_w2_product_2 * w2_product_2;
    const real w2_y2 = x->r1_w2_s2 + w1_b * w2_u2;
    x->r1_w2_s2 = w1_a * w2_y2 + w1_b * w2_u2;

    /* r1_w2: stage 1 */
    const real w2_u1 = w2_y2;
    const real w2_y1 = x->r1_w2_s1 + w1_b * w2_u1;
    x->r1_w2_s1 = w1_a * w2_y1 + w1_b * w2_u1;

    /* what the tolerance of c can do */
    const real w2 = w2_y1;

    r[SLIDER_CRANK_R1] = MATH(fabs)(w1) + MATH(fabs)(w2);
}

/* Ages and validity one by one: a number that is not finite makes the next sample the first. */
static void bound_count_samples(
    const slider_crank_threshold_coefficients *c,
    slider_crank_threshold_memory *x,
    slider_crank_residuals *out)
{
    /* the thresholds that are computed, and what each one goes with */
    static const uint8_t number[] = {
        0
    };
    static const uint8_t part[] = {
        0
    };
    bool finite[1];
    int k;

    finite[0] = true;
    for (k = 0; k < 1; ++k) {
        finite[part[k]] = finite[part[k]] && finite_number(out->value[number[k]]);
    }
    x->youngest = UINT32_MAX;
    for (k = 0; k < 1; ++k) {
        x->age[k] = finite[k] ? x->age[k] + (x->age[k] < UINT32_MAX ? 1u : 0u) : 0u;
        x->youngest = x->age[k] < x->youngest ? x->age[k] : x->youngest;
    }
    for (k = 0; k < 1; ++k) {
        out->value[number[k]] = finite[part[k]] ? out->value[number[k]] : REAL(0.0);
        out->valid[number[k]] = x->age[part[k]] > c->settle[number[k]];
    }
}

void slider_crank_threshold_reset(slider_crank_threshold_memory *memory)
{
    int k;

    for (k = 0; k < 1; ++k) {
        memory->age[k] = 0u;
    }
    memory->youngest = 0u;
}

void slider_crank_threshold_step(
    const slider_crank_threshold_coefficients *coefficients,
    slider_crank_threshold_memory *memory,
    const slider_crank_samples *samples,
    slider_crank_residuals *thresholds)
{
    const slider_crank_threshold_coefficients *c = coefficients;
    slider_crank_threshold_memory *x = memory;
    const slider_crank_samples *s = samples;
    real *r = thresholds->value;
    int k;

    bound_r1(c, x, s, r);
    /* a sum is finite only if all its terms are */
    if (x->youngest > c->longest && finite_number(r[SLIDER_CRANK_R1])) {
        for (k = 0; k < SLIDER_CRANK_RESIDUALS; ++k) {
            thresholds->valid[k] = true;
        }
    } else {
        bound_count_samples(c, x, thresholds);
    }
}

#endif

const char slider_crank_fault_name[SLIDER_CRANK_FAULTS][6] = {
    "J", "f", "m", "c", "r", "l", "T", "load", "speed",
};

const uint16_t slider_crank_fault_class[SLIDER_CRANK_FAULTS] = {
    0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u,
};

const char slider_crank_residual_name[SLIDER_CRANK_RESIDUALS][3] = {
    "r1",
};

/*
 * Signatures: the faults of class c are seen by the residuals of entries first_entry[c] and up to
 * first_entry[c + 1].
 */
static const uint32_t first_entry[SLIDER_CRANK_CLASSES + 1] = {
    0u, 1u,
};

static const uint16_t seen_by[1] = {
    0u,
};

/*
 * Sizes of faults in eighths of an octave: a residual in alarm makes a fault so much larger than
 * what is least here as it is out.
 */
static const uint8_t least_size[1] = {
    1u,
};

/* A residual is sure to show a fault of this size; 255: of no size. */
static const uint8_t sure_size[1] = {
    0u,
};

/* The peak of residual k since it went into alarm, beside what is sure to be one. */
static void remember_peak(
    slider_crank_diagnosis *d, const slider_crank_limit *limit, int k, real out, real bound)
{
    const real over = out - limit->level;
    const real sure = limit->level + bound + bound;

    if (over > d->peak[k] * sure && sure > REAL(0.0)) {
        d->peak[k] = over / sure;
    }
}

/* A peak in eighths of an octave above a sixteenth of what is sure to be an alarm. */
static int eighths(real peak)
{
    real top = REAL(0.0625);
    int n;

    for (n = 0; n < 255; ++n) {
        if (peak < top) {
            return n;
        }
        top *= REAL(1.0905077326652577);
    }
    return 255;
}

/*
 * How large a fault of class c is at least, as the residuals in alarm are out; -1: ruled out, as it
 * is not seen by all of the alarms.
 */
static int size_of(const slider_crank_diagnosis *d, int c, int alarms)
{
    const uint32_t begin = first_entry[c];
    const uint32_t end = first_entry[c + 1];
    int size = 0;
    int seen = 0;
    uint32_t i;

    for (i = begin; i < end; ++i) {
        const int k = (int)seen_by[i];

        if (d->state[k] == SLIDER_CRANK_ALARM) {
            const int n = eighths(d->peak[k]);

            if (n > 0 && n + (int)least_size[i] > size) {
                size = n + (int)least_size[i];
            }
            ++seen;
        }
    }
    return seen == alarms ? size : -1;
}

/* What is left of the faults of class c. */
static slider_crank_candidate left_of(const slider_crank_diagnosis *d, int c, int alarms)
{
    const uint32_t begin = first_entry[c];
    const uint32_t end = first_entry[c + 1];
    const int size = size_of(d, c, alarms);
    uint32_t i;

    if (size < 0) {
        return SLIDER_CRANK_RULED_OUT;
    }
    if (d->settled < d->window) {
        return SLIDER_CRANK_LIKELY; /* too soon for what is quiet to say anything */
    }
    for (i = begin; i < end; ++i) {
        const int k = (int)seen_by[i];
        const int sure = (int)sure_size[i];

        if (d->state[k] == SLIDER_CRANK_HEALTHY && sure != 255 && sure <= size) {
            return SLIDER_CRANK_SMALL;
        }
    }
    return SLIDER_CRANK_LIKELY;
}

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

/* How far a residual is beyond its bound; off: from its mean. */
static real excess(real off, real bound)
{
#if defined __GNUC__ && !defined SLIDER_CRANK_REAL
    return MATH(__builtin_fabs)(off) - bound; /* one instruction, no library */
#else
    return (off < REAL(0.0) ? -off : off) - bound;
#endif
}

static bool is_within(const slider_crank_limit *limit, real value, real bound)
{
    return excess(value - limit->mean, bound) <= limit->level;
}

/* Residual k in one sample; whether it goes into alarm. */
static bool watch(
    slider_crank_diagnosis *d, const slider_crank_limit *limit, int k, real value, real bound, bool row)
{
    const real off = value - limit->mean;
    const real out = excess(off, bound);
    bool high = false;

    if (row) {
        high = add_row(d, limit, k, off, out, bound);
    }
    if (d->state[k] == SLIDER_CRANK_ALARM) {
        d->since[k] += d->since[k] < UINT32_MAX ? 1u : 0u;
        remember_peak(d, limit, k, out, bound);
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
    d->peak[k] = REAL(0.0);
    remember_peak(d, limit, k, out, bound);
    return true;
}

/* Which classes of faults the residuals leave, and the one if it is one. */
static void judge(slider_crank_diagnosis *d)
{
    int likely = 0;
    int alarms = 0;
    int c;
    int k;

    for (k = 0; k < SLIDER_CRANK_RESIDUALS; ++k) {
        alarms += d->state[k] == SLIDER_CRANK_ALARM ? 1 : 0;
    }
    d->fault_class = SLIDER_CRANK_UNKNOWN;
    for (c = 0; c < SLIDER_CRANK_CLASSES; ++c) {
        const slider_crank_candidate left = left_of(d, c, alarms);

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
        diagnosis->peak[k] = REAL(0.0);
        forget_sums(diagnosis, k);
    }
    for (k = 0; k < SLIDER_CRANK_CLASSES; ++k) {
        diagnosis->candidate[k] = SLIDER_CRANK_RULED_OUT;
    }
    diagnosis->fault_class = SLIDER_CRANK_UNKNOWN;
    diagnosis->quiet = 0u;
    diagnosis->settled = 0u;
    diagnosis->calm = false;
}

void slider_crank_diagnosis_reset(slider_crank_diagnosis *diagnosis)
{
    int k;

    diagnosis->row = SLIDER_CRANK_ROW;
    diagnosis->least = 15u;
    diagnosis->hold = 10u * SLIDER_CRANK_ROW;
    diagnosis->window = 300u;
    diagnosis->latch = false;
    diagnosis->tick = 0u;
    for (k = 0; k < SLIDER_CRANK_RESIDUALS; ++k) {
        diagnosis->state[k] = SLIDER_CRANK_BLIND;
    }
    slider_crank_clear(diagnosis);
}

/* Whether each residual has a value within its level: nearly all samples are so. */
static bool all_within(
    const slider_crank_limit *limits, const real *bounds, const slider_crank_residuals *residuals)
{
    const real *value = residuals->value;
    int k;

    if (bounds != NULL) {
        for (k = 0; k < SLIDER_CRANK_RESIDUALS; ++k) {
            if (!residuals->valid[k] || !is_within(&limits[k], value[k], bounds[k])) {
                return false;
            }
        }
    } else {
        for (k = 0; k < SLIDER_CRANK_RESIDUALS; ++k) {
            if (!residuals->valid[k] || !is_within(&limits[k], value[k], limits[k].bound)) {
                return false;
            }
        }
    }
    return true;
}

/* Residual k without a value. */
static void blind(slider_crank_diagnosis *d, int k)
{
    forget_sums(d, k);
    if (d->state[k] == SLIDER_CRANK_ALARM) {
        d->quiet = 0u; /* nobody knows that it is over */
    } else {
        d->state[k] = SLIDER_CRANK_BLIND;
    }
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
    if (d->calm && !row && all_within(limits, bounds, residuals)) {
        return false;
    }
    d->calm = true;
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
            blind(d, k);
        }
        d->calm = d->calm && d->state[k] == SLIDER_CRANK_HEALTHY && d->streak[k] == 0u;
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
