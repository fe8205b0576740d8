/* khepera_built_threshold.c: the thresholds of KheperaBuilt_threshold; generated, see the header. */
#include "khepera_built_threshold.h"

#include <math.h>

#if defined __FINITE_MATH_ONLY__ && __FINITE_MATH_ONLY__
#error "this code tells numbers from NaN: compile it without -ffinite-math-only (-ffast-math)"
#endif

typedef khepera_built_threshold_real real;

#define REAL(x) KHEPERA_BUILT_THRESHOLD_CONSTANT(x)
#if defined KHEPERA_BUILT_THRESHOLD_FLOAT && !defined KHEPERA_BUILT_THRESHOLD_REAL
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

/* Takes a count; the difference to the one before is right also when the counter runs over. */
static void count_on(khepera_built_threshold_encoder *encoder, int32_t count)
{
    const uint32_t step = (uint32_t)count - encoder->count;

    encoder->increment = step <= INT32_MAX ? (int32_t)step : -(int32_t)(UINT32_MAX - step) - 1;
    encoder->total += encoder->increment;
    encoder->count = (uint32_t)count;
}

/* Takes the first count. */
static void count_from(khepera_built_threshold_encoder *encoder, int32_t count)
{
    encoder->count = (uint32_t)count;
    encoder->increment = 0;
    encoder->total = 0;
}

uint32_t khepera_built_threshold_abi(void)
{
    return KHEPERA_BUILT_THRESHOLD_ABI;
}

const char *khepera_built_threshold_digest(void)
{
    return KHEPERA_BUILT_THRESHOLD_DIGEST;
}

void khepera_built_threshold_nominal(khepera_built_threshold_parameters *parameters)
{
    parameters->m__1__Je = REAL(1.4e-08);     /* kg.m^2 */
    parameters->m__1__fe = REAL(1.0e-07);     /* N.m.s/rad */
    parameters->m__1__Js = REAL(1.0e-05);     /* kg.m^2 */
    parameters->m__1__fs = REAL(0.0003);      /* N.m.s/rad */
    parameters->m__1__R = REAL(0.008);        /* m */
    parameters->m__1__el__L = REAL(0.0003);   /* H */
    parameters->m__1__el__Re = REAL(17.6);    /* Ohm */
    parameters->m__1__el__k = REAL(0.00351);  /* N.m/A */
    parameters->m__1__ge__N = REAL(25.0);     /* 1 */
    parameters->m__2__Je = REAL(1.4e-08);     /* kg.m^2 */
    parameters->m__2__fe = REAL(1.0e-07);     /* N.m.s/rad */
    parameters->m__2__Js = REAL(1.0e-05);     /* kg.m^2 */
    parameters->m__2__fs = REAL(0.0003);      /* N.m.s/rad */
    parameters->m__2__R = REAL(0.008);        /* m */
    parameters->m__2__el__L = REAL(0.0003);   /* H */
    parameters->m__2__el__Re = REAL(17.6);    /* Ohm */
    parameters->m__2__el__k = REAL(0.00351);  /* N.m/A */
    parameters->m__2__ge__N = REAL(25.0);     /* 1 */
}

/* The coefficients of exact and of the filter, from the parameters. */
static void compute_coefficients(khepera_built_threshold_monitor *monitor,
        const khepera_built_threshold_parameters *p, real sample_time, real bandwidth)
{
    khepera_built_threshold_coefficients *c = &monitor->c;

    /* bandwidth*sample_time */
    const real x_ = bandwidth * sample_time;

    /* of a stage: what is left of its memory */
    const real pole = greatest(REAL(2.0) - x_, REAL(0.0)) / (x_ + REAL(2.0));

    /* w*sample_time, x or 2 */
    const real turn = REAL(2.0) * (REAL(1.0) - pole) / (pole + REAL(1.0));

    /* w of the filter 1/(1 + D/w) */
    const real w = turn / sample_time;

    /* khepera.bg:17: m[1].fe + m[1].fs/m[1].ge.N^2 */
    const real t = p->m__1__fe + p->m__1__fs / p->m__1__ge__N / p->m__1__ge__N;

    /* khepera.bg:17: m[1].Je + m[1].Js/m[1].ge.N^2 */
    const real t_2 = p->m__1__Je + p->m__1__Js / p->m__1__ge__N / p->m__1__ge__N;

    /* khepera.bg:17: m[1].el.Re*(m[1].fe + m[1].fs/m[1].ge.N^2)/m[1].el.k */
    const real t_3 = p->m__1__el__Re * t / p->m__1__el__k;

    /* khepera.bg:17: m[1].R*m[1].el.Re/(m[1].el.k*m[1].ge.N) */
    const real t_4 = p->m__1__R * p->m__1__el__Re / p->m__1__el__k / p->m__1__ge__N;

    /* khepera.bg:17: m[2].fe + m[2].fs/m[2].ge.N^2 */
    const real t_5 = p->m__2__fe + p->m__2__fs / p->m__2__ge__N / p->m__2__ge__N;

    /* khepera.bg:17: m[2].Je + m[2].Js/m[2].ge.N^2 */
    const real t_6 = p->m__2__Je + p->m__2__Js / p->m__2__ge__N / p->m__2__ge__N;

    /* khepera.bg:17: m[2].el.Re*(m[2].fe + m[2].fs/m[2].ge.N^2)/m[2].el.k */
    const real t_7 = p->m__2__el__Re * t_5 / p->m__2__el__k;

    /* khepera.bg:17: m[2].R*m[2].el.Re/(m[2].el.k*m[2].ge.N) */
    const real t_8 = p->m__2__R * p->m__2__el__Re / p->m__2__el__k / p->m__2__ge__N;

    /* 1 - pole */
    const real t_9 = REAL(1.0) - pole;

    /* 1 - (1 - pole)/2 */
    const real t_10 = REAL(1.0) - REAL(0.5) * t_9;

    /* turn^2 */
    const real t_11 = turn * turn;

    /* khepera.bg:17: m[1].el.L*(m[1].Je + m[1].Js/m[1].ge.N^2)*w^2/m[1].el.k */
    const real t_12 = p->m__1__el__L * t_2 * w * w / p->m__1__el__k;

    /* khepera.bg:17: m[1].R*m[1].el.L*w/(m[1].el.k*m[1].ge.N) */
    const real t_13 = p->m__1__R * p->m__1__el__L * w / p->m__1__el__k / p->m__1__ge__N;

    /* khepera.bg:17: m[2].el.L*(m[2].Je + m[2].Js/m[2].ge.N^2)*w^2/m[2].el.k */
    const real t_14 = p->m__2__el__L * t_6 * w * w / p->m__2__el__k;

    /* khepera.bg:17: m[2].R*m[2].el.L*w/(m[2].el.k*m[2].ge.N) */
    const real t_15 = p->m__2__R * p->m__2__el__L * w / p->m__2__el__k / p->m__2__ge__N;

    /* khepera.bg:17: m[1].fe*m[1].el.Re/m[1].el.k */
    const real t_16 = p->m__1__fe * p->m__1__el__Re / p->m__1__el__k;

    /* khepera.bg:17: m[1].fe*m[1].el.L*w/m[1].el.k */
    const real t_17 = p->m__1__fe * p->m__1__el__L * w / p->m__1__el__k;

    /* khepera.bg:17: m[1].Js*m[1].el.Re*w/(m[1].el.k*m[1].ge.N^2) */
    const real t_18 = p->m__1__Js * p->m__1__el__Re * w / p->m__1__el__k / p->m__1__ge__N
            / p->m__1__ge__N;

    /* khepera.bg:17: m[1].Js*m[1].el.L*w^2/(m[1].el.k*m[1].ge.N^2) */
    const real t_19 = p->m__1__Js * p->m__1__el__L * w * w / p->m__1__el__k / p->m__1__ge__N
            / p->m__1__ge__N;

    /* khepera.bg:17: m[1].fs*m[1].el.Re/(m[1].el.k*m[1].ge.N^2) */
    const real t_20 = p->m__1__fs * p->m__1__el__Re / p->m__1__el__k / p->m__1__ge__N
            / p->m__1__ge__N;

    /* khepera.bg:17: m[1].fs*m[1].el.L*w/(m[1].el.k*m[1].ge.N^2) */
    const real t_21 = p->m__1__fs * p->m__1__el__L * w / p->m__1__el__k / p->m__1__ge__N
            / p->m__1__ge__N;

    /* khepera.bg:17: m[1].el.Re*(m[1].Je + m[1].Js/m[1].ge.N^2)*w/m[1].el.k */
    const real t_22 = p->m__1__el__Re * t_2 * w / p->m__1__el__k;

    /* khepera.bg:17: m[2].fe*m[2].el.Re/m[2].el.k */
    const real t_23 = p->m__2__fe * p->m__2__el__Re / p->m__2__el__k;

    /* khepera.bg:17: m[2].fe*m[2].el.L*w/m[2].el.k */
    const real t_24 = p->m__2__fe * p->m__2__el__L * w / p->m__2__el__k;

    /* khepera.bg:17: m[2].Js*m[2].el.Re*w/(m[2].el.k*m[2].ge.N^2) */
    const real t_25 = p->m__2__Js * p->m__2__el__Re * w / p->m__2__el__k / p->m__2__ge__N
            / p->m__2__ge__N;

    /* khepera.bg:17: m[2].Js*m[2].el.L*w^2/(m[2].el.k*m[2].ge.N^2) */
    const real t_26 = p->m__2__Js * p->m__2__el__L * w * w / p->m__2__el__k / p->m__2__ge__N
            / p->m__2__ge__N;

    /* khepera.bg:17: m[2].fs*m[2].el.Re/(m[2].el.k*m[2].ge.N^2) */
    const real t_27 = p->m__2__fs * p->m__2__el__Re / p->m__2__el__k / p->m__2__ge__N
            / p->m__2__ge__N;

    /* khepera.bg:17: m[2].fs*m[2].el.L*w/(m[2].el.k*m[2].ge.N^2) */
    const real t_28 = p->m__2__fs * p->m__2__el__L * w / p->m__2__el__k / p->m__2__ge__N
            / p->m__2__ge__N;

    /* khepera.bg:17: m[2].el.Re*(m[2].Je + m[2].Js/m[2].ge.N^2)*w/m[2].el.k */
    const real t_29 = p->m__2__el__Re * t_6 * w / p->m__2__el__k;

    /* khepera.bg:17: r1_w1: factor of m[1].motor' */
    c->r1_w1_w1_m__1__motor = t_16 / REAL(10.0);

    /* speed of m[1].motor for one count */
    c->m__1__motor_gain = REAL(884279719003555.0) * t_10 * w / REAL(3377699720527872.0);

    /* filter: what is left of a memory a sample later */
    c->a = pole;

    /* khepera.bg:17: r1_w1: factor of m[1].motor'' */
    c->r1_w1_w2_m__1__motor = t_17 / REAL(10.0);

    /* filter: 1 * (w*sample_time)^2/12 */
    c->bend1 = t_11 / REAL(12.0);

    /* filter: weight of a sample, new and a sample later */
    c->b = REAL(0.5) * t_9;

    /* filter: 1 - b, the memory of a constant 1 */
    c->rest = t_10;

    /* khepera.bg:17: r1_w2: factor of m[1].motor'' */
    c->r1_w2_w2_m__1__motor = t_18 / REAL(50.0);

    /* khepera.bg:17: r1_w2: factor of m[1].motor''' */
    c->r1_w2_w3_m__1__motor = t_19 / REAL(50.0);

    /* khepera.bg:17: r1_w3: factor of m[1].motor' */
    c->r1_w3_w1_m__1__motor = t_20 / REAL(10.0);

    /* khepera.bg:17: r1_w3: factor of m[1].motor'' */
    c->r1_w3_w2_m__1__motor = t_21 / REAL(10.0);

    /* khepera.bg:17: r1_w4: factor of Fx[1] */
    c->r1_w4_Fx__1 = t_4 / REAL(20.0);

    /* khepera.bg:17: r1_w4: factor of m[1].motor' */
    c->r1_w4_w1_m__1__motor = t_3 / REAL(20.0);

    /* khepera.bg:17: r1_w4: factor of m[1].motor'' */
    c->r1_w4_w2_m__1__motor = t_22 / REAL(20.0);

    /* filter: 2 * (w*sample_time)^2/12 */
    c->bend2 = t_11 / REAL(6.0);

    /* khepera.bg:17: r1_w5: factor of m[1].motor' */
    c->r1_w5_w1_m__1__motor = p->m__1__el__k
            * (p->m__1__el__Re * t / p->m__1__el__k / p->m__1__el__k
            - REAL(1.0)) / REAL(50.0);

    /* khepera.bg:17: r1_w5: factor of m[1].motor'' */
    c->r1_w5_w2_m__1__motor = p->m__1__el__k * w
            * (p->m__1__el__Re * t_2 / p->m__1__el__k / p->m__1__el__k
            + p->m__1__el__L * t / p->m__1__el__k / p->m__1__el__k) / REAL(50.0);

    /* khepera.bg:17: r1_w5: factor of m[1].motor''' */
    c->r1_w5_w3_m__1__motor = t_12 / REAL(50.0);

    /* khepera.bg:17: r1_w5: factor of Fx[1] */
    c->r1_w5_Fx__1 = t_4 / REAL(50.0);

    /* khepera.bg:17: r1_w5: factor of Fx[1]' */
    c->r1_w5_w1_Fx__1 = t_13 / REAL(50.0);

    /* filter: 3 * (w*sample_time)^2/12 */
    c->bend3 = REAL(0.25) * t_11;

    /* khepera.bg:17: r1_w6: factor of m[1].motor' */
    c->r1_w6_w1_m__1__motor = t_16 / REAL(142.0);

    /* khepera.bg:17: r1_w7: factor of m[1].motor' */
    c->r1_w7_w1_m__1__motor = t_16 / REAL(355.0);

    /* khepera.bg:17: r1_w7: factor of m[1].motor'' */
    c->r1_w7_w2_m__1__motor = t_17 / REAL(355.0);

    /* khepera.bg:17: r1_w8: factor of m[1].motor'' */
    c->r1_w8_w2_m__1__motor = t_18 / REAL(710.0);

    /* khepera.bg:17: r1_w9: factor of m[1].motor'' */
    c->r1_w9_w2_m__1__motor = t_18 / REAL(1775.0);

    /* khepera.bg:17: r1_w9: factor of m[1].motor''' */
    c->r1_w9_w3_m__1__motor = t_19 / REAL(1775.0);

    /* khepera.bg:17: r1_w10: factor of m[1].motor' */
    c->r1_w10_w1_m__1__motor = t_20 / REAL(142.0);

    /* khepera.bg:17: r1_w11: factor of m[1].motor' */
    c->r1_w11_w1_m__1__motor = t_20 / REAL(355.0);

    /* khepera.bg:17: r1_w11: factor of m[1].motor'' */
    c->r1_w11_w2_m__1__motor = t_21 / REAL(355.0);

    /* khepera.bg:17: r1_w12: factor of m[1].motor' */
    c->r1_w12_w1_m__1__motor = t_3 / REAL(710.0);

    /* khepera.bg:17: r1_w12: factor of m[1].motor'' */
    c->r1_w12_w2_m__1__motor = t_22 / REAL(710.0);

    /* khepera.bg:17: r1_w12: factor of Fx[1] */
    c->r1_w12_Fx__1 = t_4 / REAL(710.0);

    /* khepera.bg:17: r1_w13: factor of m[1].motor' */
    c->r1_w13_w1_m__1__motor = t_3 / REAL(1775.0);

    /* khepera.bg:17: r1_w13: factor of m[1].motor'' */
    c->r1_w13_w2_m__1__motor = p->m__1__el__k * p->m__1__el__k * w
            * (-REAL(2.0) * p->m__1__el__L * t / p->m__1__el__k / p->m__1__el__k / p->m__1__el__k
            - REAL(2.0) * p->m__1__el__Re * t_2 / p->m__1__el__k / p->m__1__el__k / p->m__1__el__k)
            / REAL(3550.0);

    /* khepera.bg:17: r1_w13: factor of m[1].motor''' */
    c->r1_w13_w3_m__1__motor = t_12 / REAL(1775.0);

    /* khepera.bg:17: r1_w13: factor of Fx[1] */
    c->r1_w13_Fx__1 = t_4 / REAL(1775.0);

    /* khepera.bg:17: r1_w13: factor of Fx[1]' */
    c->r1_w13_w1_Fx__1 = t_13 / REAL(1775.0);

    /* khepera.bg:17: r2_w1: factor of m[2].motor' */
    c->r2_w1_w1_m__2__motor = t_23 / REAL(10.0);

    /* khepera.bg:17: r2_w1: factor of m[2].motor'' */
    c->r2_w1_w2_m__2__motor = t_24 / REAL(10.0);

    /* khepera.bg:17: r2_w2: factor of m[2].motor'' */
    c->r2_w2_w2_m__2__motor = t_25 / REAL(50.0);

    /* khepera.bg:17: r2_w2: factor of m[2].motor''' */
    c->r2_w2_w3_m__2__motor = t_26 / REAL(50.0);

    /* khepera.bg:17: r2_w3: factor of m[2].motor' */
    c->r2_w3_w1_m__2__motor = t_27 / REAL(10.0);

    /* khepera.bg:17: r2_w3: factor of m[2].motor'' */
    c->r2_w3_w2_m__2__motor = t_28 / REAL(10.0);

    /* khepera.bg:17: r2_w4: factor of Fx[2] */
    c->r2_w4_Fx__2 = t_8 / REAL(20.0);

    /* khepera.bg:17: r2_w4: factor of m[2].motor' */
    c->r2_w4_w1_m__2__motor = t_7 / REAL(20.0);

    /* khepera.bg:17: r2_w4: factor of m[2].motor'' */
    c->r2_w4_w2_m__2__motor = t_29 / REAL(20.0);

    /* khepera.bg:17: r2_w5: factor of m[2].motor' */
    c->r2_w5_w1_m__2__motor = p->m__2__el__k
            * (p->m__2__el__Re * t_5 / p->m__2__el__k / p->m__2__el__k
            - REAL(1.0)) / REAL(50.0);

    /* khepera.bg:17: r2_w5: factor of m[2].motor'' */
    c->r2_w5_w2_m__2__motor = p->m__2__el__k * w
            * (p->m__2__el__Re * t_6 / p->m__2__el__k / p->m__2__el__k
            + p->m__2__el__L * t_5 / p->m__2__el__k / p->m__2__el__k) / REAL(50.0);

    /* khepera.bg:17: r2_w5: factor of m[2].motor''' */
    c->r2_w5_w3_m__2__motor = t_14 / REAL(50.0);

    /* khepera.bg:17: r2_w5: factor of Fx[2] */
    c->r2_w5_Fx__2 = t_8 / REAL(50.0);

    /* khepera.bg:17: r2_w5: factor of Fx[2]' */
    c->r2_w5_w1_Fx__2 = t_15 / REAL(50.0);

    /* khepera.bg:17: r2_w6: factor of m[2].motor' */
    c->r2_w6_w1_m__2__motor = t_23 / REAL(142.0);

    /* khepera.bg:17: r2_w7: factor of m[2].motor' */
    c->r2_w7_w1_m__2__motor = t_23 / REAL(355.0);

    /* khepera.bg:17: r2_w7: factor of m[2].motor'' */
    c->r2_w7_w2_m__2__motor = t_24 / REAL(355.0);

    /* khepera.bg:17: r2_w8: factor of m[2].motor'' */
    c->r2_w8_w2_m__2__motor = t_25 / REAL(710.0);

    /* khepera.bg:17: r2_w9: factor of m[2].motor'' */
    c->r2_w9_w2_m__2__motor = t_25 / REAL(1775.0);

    /* khepera.bg:17: r2_w9: factor of m[2].motor''' */
    c->r2_w9_w3_m__2__motor = t_26 / REAL(1775.0);

    /* khepera.bg:17: r2_w10: factor of m[2].motor' */
    c->r2_w10_w1_m__2__motor = t_27 / REAL(142.0);

    /* khepera.bg:17: r2_w11: factor of m[2].motor' */
    c->r2_w11_w1_m__2__motor = t_27 / REAL(355.0);

    /* khepera.bg:17: r2_w11: factor of m[2].motor'' */
    c->r2_w11_w2_m__2__motor = t_28 / REAL(355.0);

    /* khepera.bg:17: r2_w12: factor of m[2].motor' */
    c->r2_w12_w1_m__2__motor = t_7 / REAL(710.0);

    /* khepera.bg:17: r2_w12: factor of m[2].motor'' */
    c->r2_w12_w2_m__2__motor = t_29 / REAL(710.0);

    /* khepera.bg:17: r2_w12: factor of Fx[2] */
    c->r2_w12_Fx__2 = t_8 / REAL(710.0);

    /* khepera.bg:17: r2_w13: factor of m[2].motor' */
    c->r2_w13_w1_m__2__motor = t_7 / REAL(1775.0);

    /* khepera.bg:17: r2_w13: factor of m[2].motor'' */
    c->r2_w13_w2_m__2__motor = p->m__2__el__k * p->m__2__el__k * w
            * (-REAL(2.0) * p->m__2__el__L * t_5 / p->m__2__el__k / p->m__2__el__k / p->m__2__el__k
            - REAL(2.0) * p->m__2__el__Re * t_6 / p->m__2__el__k / p->m__2__el__k / p->m__2__el__k)
            / REAL(3550.0);

    /* khepera.bg:17: r2_w13: factor of m[2].motor''' */
    c->r2_w13_w3_m__2__motor = t_14 / REAL(1775.0);

    /* khepera.bg:17: r2_w13: factor of Fx[2] */
    c->r2_w13_Fx__2 = t_8 / REAL(1775.0);

    /* khepera.bg:17: r2_w13: factor of Fx[2]' */
    c->r2_w13_w1_Fx__2 = t_15 / REAL(1775.0);
}

static bool parameters_are_finite(const khepera_built_threshold_parameters *p)
{
    return finite_number(p->m__1__Je + p->m__1__fe + p->m__1__Js + p->m__1__fs + p->m__1__R
            + p->m__1__el__L + p->m__1__el__Re + p->m__1__el__k + p->m__1__ge__N + p->m__2__Je
            + p->m__2__fe + p->m__2__Js + p->m__2__fs + p->m__2__R + p->m__2__el__L
            + p->m__2__el__Re + p->m__2__el__k + p->m__2__ge__N);
}

static bool coefficients_are_finite(const khepera_built_threshold_monitor *monitor)
{
    return finite_number(monitor->c.r1_w1_w1_m__1__motor + monitor->c.m__1__motor_gain
            + monitor->c.a + monitor->c.r1_w1_w2_m__1__motor + monitor->c.bend1 + monitor->c.b
            + monitor->c.rest + monitor->c.r1_w2_w2_m__1__motor + monitor->c.r1_w2_w3_m__1__motor
            + monitor->c.r1_w3_w1_m__1__motor + monitor->c.r1_w3_w2_m__1__motor
            + monitor->c.r1_w4_Fx__1 + monitor->c.r1_w4_w1_m__1__motor
            + monitor->c.r1_w4_w2_m__1__motor + monitor->c.bend2 + monitor->c.r1_w5_w1_m__1__motor
            + monitor->c.r1_w5_w2_m__1__motor + monitor->c.r1_w5_w3_m__1__motor
            + monitor->c.r1_w5_Fx__1 + monitor->c.r1_w5_w1_Fx__1 + monitor->c.bend3
            + monitor->c.r1_w6_w1_m__1__motor + monitor->c.r1_w7_w1_m__1__motor
            + monitor->c.r1_w7_w2_m__1__motor + monitor->c.r1_w8_w2_m__1__motor
            + monitor->c.r1_w9_w2_m__1__motor + monitor->c.r1_w9_w3_m__1__motor
            + monitor->c.r1_w10_w1_m__1__motor + monitor->c.r1_w11_w1_m__1__motor
            + monitor->c.r1_w11_w2_m__1__motor + monitor->c.r1_w12_w1_m__1__motor
            + monitor->c.r1_w12_w2_m__1__motor + monitor->c.r1_w12_Fx__1
            + monitor->c.r1_w13_w1_m__1__motor + monitor->c.r1_w13_w2_m__1__motor
            + monitor->c.r1_w13_w3_m__1__motor + monitor->c.r1_w13_Fx__1
            + monitor->c.r1_w13_w1_Fx__1 + monitor->c.r2_w1_w1_m__2__motor
            + monitor->c.r2_w1_w2_m__2__motor + monitor->c.r2_w2_w2_m__2__motor
            + monitor->c.r2_w2_w3_m__2__motor + monitor->c.r2_w3_w1_m__2__motor
            + monitor->c.r2_w3_w2_m__2__motor + monitor->c.r2_w4_Fx__2
            + monitor->c.r2_w4_w1_m__2__motor + monitor->c.r2_w4_w2_m__2__motor
            + monitor->c.r2_w5_w1_m__2__motor + monitor->c.r2_w5_w2_m__2__motor
            + monitor->c.r2_w5_w3_m__2__motor + monitor->c.r2_w5_Fx__2 + monitor->c.r2_w5_w1_Fx__2
            + monitor->c.r2_w6_w1_m__2__motor + monitor->c.r2_w7_w1_m__2__motor
            + monitor->c.r2_w7_w2_m__2__motor + monitor->c.r2_w8_w2_m__2__motor
            + monitor->c.r2_w9_w2_m__2__motor + monitor->c.r2_w9_w3_m__2__motor
            + monitor->c.r2_w10_w1_m__2__motor + monitor->c.r2_w11_w1_m__2__motor
            + monitor->c.r2_w11_w2_m__2__motor + monitor->c.r2_w12_w1_m__2__motor
            + monitor->c.r2_w12_w2_m__2__motor + monitor->c.r2_w12_Fx__2
            + monitor->c.r2_w13_w1_m__2__motor + monitor->c.r2_w13_w2_m__2__motor
            + monitor->c.r2_w13_w3_m__2__motor + monitor->c.r2_w13_Fx__2
            + monitor->c.r2_w13_w1_Fx__2);
}

/* Samples until `constants` time constants of the filter are over. */
static uint32_t samples(real constants, real sample_time, real bandwidth)
{
    const real wait = constants / (bandwidth * sample_time);
    const uint32_t whole = wait < REAL(4.0e9) ? (uint32_t)wait : UINT32_MAX - 1u;

    return (real)whole < wait ? whole + 1u : whole;
}

khepera_built_threshold_status khepera_built_threshold_configure(
    khepera_built_threshold_monitor *monitor,
    const khepera_built_threshold_parameters *parameters,
    khepera_built_threshold_real sample_time,
    khepera_built_threshold_real bandwidth,
    khepera_built_threshold_real time_unit)
{
    int k;

    for (k = 0; k < KHEPERA_BUILT_THRESHOLD_RESIDUALS; ++k) {
        monitor->settle[k] = UINT32_MAX;
    }
    khepera_built_threshold_reset(monitor);
    if (!parameters_are_finite(parameters)) {
        return KHEPERA_BUILT_THRESHOLD_BAD_PARAMETER;
    }
    if (!(sample_time >= REAL(0.000999999)) || !finite_number(sample_time)) {
        return KHEPERA_BUILT_THRESHOLD_BAD_SAMPLE_TIME;
    }
    if (!(bandwidth * sample_time >= SLOWEST && bandwidth * sample_time <= REAL(3.0))) {
        return KHEPERA_BUILT_THRESHOLD_BAD_BANDWIDTH;
    }
    if (!(time_unit > REAL(0.0)) || !finite_number(time_unit)) {
        return KHEPERA_BUILT_THRESHOLD_BAD_TIME_UNIT;
    }
    compute_coefficients(monitor, parameters, sample_time, bandwidth);
    if (!coefficients_are_finite(monitor)) {
        return KHEPERA_BUILT_THRESHOLD_BAD_COEFFICIENT;
    }
    monitor->settle[KHEPERA_BUILT_THRESHOLD_R1] =
        samples(REAL(13.062240779188071), sample_time, bandwidth);
    monitor->settle[KHEPERA_BUILT_THRESHOLD_R2] =
        samples(REAL(13.062240779188071), sample_time, bandwidth);
    monitor->settle[KHEPERA_BUILT_THRESHOLD_R3] =
        samples(REAL(6.907755278982138), sample_time, bandwidth);
    return KHEPERA_BUILT_THRESHOLD_OK;
}

void khepera_built_threshold_exact(
    const khepera_built_threshold_monitor *monitor,
    const khepera_built_threshold_derivatives *derivatives,
    khepera_built_threshold_real residuals[KHEPERA_BUILT_THRESHOLD_RESIDUALS])
{
    real *r = residuals;

    (void)monitor;
    (void)derivatives;

    /* khepera.bg:17: r1: a threshold is made of filtered signals, only step has it */
    r[KHEPERA_BUILT_THRESHOLD_R1] = (real)NAN;

    /* khepera.bg:17: r2: a threshold is made of filtered signals, only step has it */
    r[KHEPERA_BUILT_THRESHOLD_R2] = (real)NAN;

    /* khepera.bg:114: r3: a threshold is made of filtered signals, only step has it */
    r[KHEPERA_BUILT_THRESHOLD_R3] = (real)NAN;
}

/* r1 on its first sample: the filter as if it had always been so. */
static void start_r1(
    khepera_built_threshold_monitor *monitor, const khepera_built_threshold_samples *s, real *r)
{
    const khepera_built_threshold_coefficients *c = &monitor->c;
    khepera_built_threshold_memory *x = &monitor->x;

    count_from(&monitor->e.m__1__motor, s->m__1__motor);

    /* khepera.bg:17: filtered speed of m[1].motor, at rest */
    const real r1_w1_m__1__motor_speed_2 = REAL(0.0);

    /* khepera.bg:17: filtered speed of m[1].motor */
    x->r1_w1_m__1__motor_speed = r1_w1_m__1__motor_speed_2;

    /* khepera.bg:17: r1_w1: encoders, order 1 */
    const real r1_w1_n1 = -c->r1_w1_w1_m__1__motor * r1_w1_m__1__motor_speed_2;

    /* khepera.bg:17: r1_w1: error of order 1 */
    const real r1_w1_e1 = c->bend1 * r1_w1_n1;

    /* khepera.bg:17: r1_w1: encoders, order 2 */
    const real r1_w1_n2 = -c->r1_w1_w2_m__1__motor * r1_w1_m__1__motor_speed_2;

    /* khepera.bg:17: r1_w1: degree 1 */
    const real r1_w1_d1 = r1_w1_n1 + r1_w1_n2;

    /* khepera.bg:17: r1_w1: degree 2 */
    const real r1_w1_d2 = r1_w1_n2 - r1_w1_e1;

    /* khepera.bg:17: r1_w1: input of stage 4 */
    const real r1_w1_u4 = r1_w1_n1 + r1_w1_d2 + r1_w1_e1 - r1_w1_d1;

    /* khepera.bg:17: r1_w1: stage 4, at rest */
    const real r1_w1_y4 = r1_w1_u4;

    /* khepera.bg:17: r1_w1: stage 4: memory */
    x->r1_w1_s4 = c->rest * r1_w1_u4;

    /* khepera.bg:17: r1_w1: input of stage 3 */
    const real r1_w1_u3 = r1_w1_y4 + r1_w1_d1 - REAL(2.0) * r1_w1_d2 - REAL(3.0) * r1_w1_e1;

    /* khepera.bg:17: r1_w1: stage 3, at rest */
    const real r1_w1_y3 = r1_w1_u3;

    /* khepera.bg:17: r1_w1: stage 3: memory */
    x->r1_w1_s3 = c->rest * r1_w1_u3;

    /* khepera.bg:17: r1_w1: input of stage 2 */
    const real r1_w1_u2 = r1_w1_y3 + r1_w1_d2 + REAL(3.0) * r1_w1_e1;

    /* khepera.bg:17: r1_w1: stage 2, at rest */
    const real r1_w1_y2 = r1_w1_u2;

    /* khepera.bg:17: r1_w1: stage 2: memory */
    x->r1_w1_s2 = c->rest * r1_w1_u2;

    /* khepera.bg:17: r1_w1: input of stage 1 */
    const real r1_w1_u1 = r1_w1_y2 - r1_w1_e1;

    /* khepera.bg:17: r1_w1: stage 1, at rest */
    const real r1_w1_y1 = r1_w1_u1;

    /* khepera.bg:17: r1_w1: stage 1: memory */
    x->r1_w1_s1 = c->rest * r1_w1_u1;

    /* khepera.bg:17: r1: what the tolerance of m[1].fe can do */
    const real r1_w1 = r1_w1_y1;

    /* khepera.bg:17: filtered speed of m[1].motor, at rest */
    const real r1_w2_m__1__motor_speed_2 = REAL(0.0);

    /* khepera.bg:17: filtered speed of m[1].motor */
    x->r1_w2_m__1__motor_speed = r1_w2_m__1__motor_speed_2;

    /* khepera.bg:17: r1_w2: encoders, order 2 */
    const real r1_w2_n2 = -c->r1_w2_w2_m__1__motor * r1_w2_m__1__motor_speed_2;

    /* khepera.bg:17: r1_w2: error of order 2 */
    const real r1_w2_e2 = c->bend1 * r1_w2_n2;

    /* khepera.bg:17: r1_w2: encoders, order 3 */
    const real r1_w2_n3 = -c->r1_w2_w3_m__1__motor * r1_w2_m__1__motor_speed_2;

    /* khepera.bg:17: r1_w2: degree 2 */
    const real r1_w2_d2 = r1_w2_n2 + r1_w2_n3;

    /* khepera.bg:17: r1_w2: degree 3 */
    const real r1_w2_d3 = r1_w2_n3 - r1_w2_e2;

    /* khepera.bg:17: r1_w2: input of stage 4 */
    const real r1_w2_u4 = r1_w2_d2 - r1_w2_n2 - r1_w2_d3 - r1_w2_e2;

    /* khepera.bg:17: r1_w2: stage 4, at rest */
    const real r1_w2_y4 = r1_w2_u4;

    /* khepera.bg:17: r1_w2: stage 4: memory */
    x->r1_w2_s4 = c->rest * r1_w2_u4;

    /* khepera.bg:17: r1_w2: input of stage 3 */
    const real r1_w2_u3 = r1_w2_y4 + r1_w2_n2 + REAL(3.0) * r1_w2_d3 + REAL(4.0) * r1_w2_e2
        - REAL(2.0) * r1_w2_d2;

    /* khepera.bg:17: r1_w2: stage 3, at rest */
    const real r1_w2_y3 = r1_w2_u3;

    /* khepera.bg:17: r1_w2: stage 3: memory */
    x->r1_w2_s3 = c->rest * r1_w2_u3;

    /* khepera.bg:17: r1_w2: input of stage 2 */
    const real r1_w2_u2 = r1_w2_y3 + r1_w2_d2 - REAL(3.0) * r1_w2_d3 - REAL(6.0) * r1_w2_e2;

    /* khepera.bg:17: r1_w2: stage 2, at rest */
    const real r1_w2_y2 = r1_w2_u2;

    /* khepera.bg:17: r1_w2: stage 2: memory */
    x->r1_w2_s2 = c->rest * r1_w2_u2;

    /* khepera.bg:17: r1_w2: input of stage 1 */
    const real r1_w2_u1 = r1_w2_y2 + r1_w2_d3 + REAL(4.0) * r1_w2_e2;

    /* khepera.bg:17: r1_w2: stage 1, at rest */
    const real r1_w2_y1 = r1_w2_u1;

    /* khepera.bg:17: r1_w2: stage 1: memory */
    x->r1_w2_s1 = c->rest * r1_w2_u1;

    /* khepera.bg:17: r1: what the tolerance of m[1].Js can do */
    const real r1_w2 = r1_w2_y1 - r1_w2_e2;

    /* khepera.bg:17: filtered speed of m[1].motor, at rest */
    const real r1_w3_m__1__motor_speed_2 = REAL(0.0);

    /* khepera.bg:17: filtered speed of m[1].motor */
    x->r1_w3_m__1__motor_speed = r1_w3_m__1__motor_speed_2;

    /* khepera.bg:17: r1_w3: encoders, order 1 */
    const real r1_w3_n1 = -c->r1_w3_w1_m__1__motor * r1_w3_m__1__motor_speed_2;

    /* khepera.bg:17: r1_w3: error of order 1 */
    const real r1_w3_e1 = c->bend1 * r1_w3_n1;

    /* khepera.bg:17: r1_w3: encoders, order 2 */
    const real r1_w3_n2 = -c->r1_w3_w2_m__1__motor * r1_w3_m__1__motor_speed_2;

    /* khepera.bg:17: r1_w3: degree 1 */
    const real r1_w3_d1 = r1_w3_n1 + r1_w3_n2;

    /* khepera.bg:17: r1_w3: degree 2 */
    const real r1_w3_d2 = r1_w3_n2 - r1_w3_e1;

    /* khepera.bg:17: r1_w3: input of stage 4 */
    const real r1_w3_u4 = r1_w3_n1 + r1_w3_d2 + r1_w3_e1 - r1_w3_d1;

    /* khepera.bg:17: r1_w3: stage 4, at rest */
    const real r1_w3_y4 = r1_w3_u4;

    /* khepera.bg:17: r1_w3: stage 4: memory */
    x->r1_w3_s4 = c->rest * r1_w3_u4;

    /* khepera.bg:17: r1_w3: input of stage 3 */
    const real r1_w3_u3 = r1_w3_y4 + r1_w3_d1 - REAL(2.0) * r1_w3_d2 - REAL(3.0) * r1_w3_e1;

    /* khepera.bg:17: r1_w3: stage 3, at rest */
    const real r1_w3_y3 = r1_w3_u3;

    /* khepera.bg:17: r1_w3: stage 3: memory */
    x->r1_w3_s3 = c->rest * r1_w3_u3;

    /* khepera.bg:17: r1_w3: input of stage 2 */
    const real r1_w3_u2 = r1_w3_y3 + r1_w3_d2 + REAL(3.0) * r1_w3_e1;

    /* khepera.bg:17: r1_w3: stage 2, at rest */
    const real r1_w3_y2 = r1_w3_u2;

    /* khepera.bg:17: r1_w3: stage 2: memory */
    x->r1_w3_s2 = c->rest * r1_w3_u2;

    /* khepera.bg:17: r1_w3: input of stage 1 */
    const real r1_w3_u1 = r1_w3_y2 - r1_w3_e1;

    /* khepera.bg:17: r1_w3: stage 1, at rest */
    const real r1_w3_y1 = r1_w3_u1;

    /* khepera.bg:17: r1_w3: stage 1: memory */
    x->r1_w3_s1 = c->rest * r1_w3_u1;

    /* khepera.bg:17: r1: what the tolerance of m[1].fs can do */
    const real r1_w3 = r1_w3_y1;

    /* khepera.bg:17: filtered speed of m[1].motor, at rest */
    const real r1_w4_m__1__motor_speed_2 = REAL(0.0);

    /* khepera.bg:17: filtered speed of m[1].motor */
    x->r1_w4_m__1__motor_speed = r1_w4_m__1__motor_speed_2;

    /* khepera.bg:17: r1_w4: encoders, order 1 */
    const real r1_w4_n1 = -c->r1_w4_w1_m__1__motor * r1_w4_m__1__motor_speed_2;

    /* khepera.bg:17: r1_w4: error of order 1 */
    const real r1_w4_e1 = c->bend1 * r1_w4_n1;

    /* khepera.bg:17: r1_w4: encoders, order 2 */
    const real r1_w4_n2 = -c->r1_w4_w2_m__1__motor * r1_w4_m__1__motor_speed_2;

    /* khepera.bg:17: r1_w4: terms of order 0 */
    const real r1_w4_g0 = -c->r1_w4_Fx__1 * s->Fx__1;

    /* khepera.bg:17: r1_w4: degree 1 */
    const real r1_w4_d1 = r1_w4_n1 + r1_w4_n2;

    /* khepera.bg:17: r1_w4: error of order 0 */
    const real r1_w4_e0 = c->bend2 * r1_w4_g0;

    /* khepera.bg:17: r1_w4: degree 2 */
    const real r1_w4_d2 = r1_w4_n2 - r1_w4_e1 - r1_w4_e0;

    /* khepera.bg:17: r1_w4: input of stage 4 */
    const real r1_w4_u4 = r1_w4_g0 + r1_w4_n1 + r1_w4_d2 + r1_w4_e1 - r1_w4_d1;

    /* khepera.bg:17: r1_w4: stage 4, at rest */
    const real r1_w4_y4 = r1_w4_u4;

    /* khepera.bg:17: r1_w4: stage 4: memory */
    x->r1_w4_s4 = c->rest * r1_w4_u4;

    /* khepera.bg:17: r1_w4: input of stage 3 */
    const real r1_w4_u3 = r1_w4_y4 + r1_w4_d1 - REAL(2.0) * r1_w4_d2 - REAL(3.0) * r1_w4_e1;

    /* khepera.bg:17: r1_w4: stage 3, at rest */
    const real r1_w4_y3 = r1_w4_u3;

    /* khepera.bg:17: r1_w4: stage 3: memory */
    x->r1_w4_s3 = c->rest * r1_w4_u3;

    /* khepera.bg:17: r1_w4: input of stage 2 */
    const real r1_w4_u2 = r1_w4_y3 + r1_w4_d2 + REAL(3.0) * r1_w4_e1;

    /* khepera.bg:17: r1_w4: stage 2, at rest */
    const real r1_w4_y2 = r1_w4_u2;

    /* khepera.bg:17: r1_w4: stage 2: memory */
    x->r1_w4_s2 = c->rest * r1_w4_u2;

    /* khepera.bg:17: r1_w4: input of stage 1 */
    const real r1_w4_u1 = r1_w4_y2 - r1_w4_e1;

    /* khepera.bg:17: r1_w4: stage 1, at rest */
    const real r1_w4_y1 = r1_w4_u1;

    /* khepera.bg:17: r1_w4: stage 1: memory */
    x->r1_w4_s1 = c->rest * r1_w4_u1;

    /* khepera.bg:17: r1: what the tolerance of m[1].el.Re can do */
    const real r1_w4 = r1_w4_y1;

    /* khepera.bg:17: filtered speed of m[1].motor, at rest */
    const real r1_w5_m__1__motor_speed_2 = REAL(0.0);

    /* khepera.bg:17: filtered speed of m[1].motor */
    x->r1_w5_m__1__motor_speed = r1_w5_m__1__motor_speed_2;

    /* khepera.bg:17: r1_w5: encoders, order 1 */
    const real r1_w5_n1 = c->r1_w5_w1_m__1__motor * r1_w5_m__1__motor_speed_2;

    /* khepera.bg:17: r1_w5: error of order 1 */
    const real r1_w5_e1 = c->bend2 * r1_w5_n1;

    /* khepera.bg:17: r1_w5: encoders, order 2 */
    const real r1_w5_n2 = c->r1_w5_w2_m__1__motor * r1_w5_m__1__motor_speed_2;

    /* khepera.bg:17: r1_w5: error of order 2 */
    const real r1_w5_e2 = c->bend1 * r1_w5_n2;

    /* khepera.bg:17: r1_w5: encoders, order 3 */
    const real r1_w5_n3 = c->r1_w5_w3_m__1__motor * r1_w5_m__1__motor_speed_2;

    /* khepera.bg:17: r1_w5: terms of order 0 */
    const real r1_w5_g0 = c->r1_w5_Fx__1 * s->Fx__1;

    /* khepera.bg:17: r1_w5: terms of order 1 */
    const real r1_w5_g1 = c->r1_w5_w1_Fx__1 * s->Fx__1;

    /* khepera.bg:17: r1_w5: degree 1 */
    const real r1_w5_d1 = r1_w5_g1 + r1_w5_n1 + r1_w5_n2;

    /* khepera.bg:17: r1_w5: error of order 0 */
    const real r1_w5_e0 = c->bend3 * r1_w5_g0;

    /* khepera.bg:17: r1_w5: degree 2 */
    const real r1_w5_d2 = r1_w5_n2 + r1_w5_n3 - r1_w5_e1 - r1_w5_e0;

    /* khepera.bg:17: r1_w5: error of order 1 */
    const real r1_w5_e1_2 = c->bend2 * r1_w5_g1;

    /* khepera.bg:17: r1_w5: degree 3 */
    const real r1_w5_d3 = r1_w5_n3 - r1_w5_e1 - r1_w5_e2 - r1_w5_e1_2;

    /* khepera.bg:17: r1_w5: input of stage 4 */
    const real r1_w5_u4 = r1_w5_g0 + r1_w5_n1 + r1_w5_d2 - r1_w5_d1 - r1_w5_d3 - r1_w5_e2;

    /* khepera.bg:17: r1_w5: stage 4, at rest */
    const real r1_w5_y4 = r1_w5_u4;

    /* khepera.bg:17: r1_w5: stage 4: memory */
    x->r1_w5_s4 = c->rest * r1_w5_u4;

    /* khepera.bg:17: r1_w5: input of stage 3 */
    const real r1_w5_u3 = r1_w5_y4 + r1_w5_d1 + REAL(3.0) * r1_w5_d3 + REAL(4.0) * r1_w5_e2
        - REAL(2.0) * r1_w5_d2;

    /* khepera.bg:17: r1_w5: stage 3, at rest */
    const real r1_w5_y3 = r1_w5_u3;

    /* khepera.bg:17: r1_w5: stage 3: memory */
    x->r1_w5_s3 = c->rest * r1_w5_u3;

    /* khepera.bg:17: r1_w5: input of stage 2 */
    const real r1_w5_u2 = r1_w5_y3 + r1_w5_d2 - REAL(3.0) * r1_w5_d3 - REAL(6.0) * r1_w5_e2;

    /* khepera.bg:17: r1_w5: stage 2, at rest */
    const real r1_w5_y2 = r1_w5_u2;

    /* khepera.bg:17: r1_w5: stage 2: memory */
    x->r1_w5_s2 = c->rest * r1_w5_u2;

    /* khepera.bg:17: r1_w5: input of stage 1 */
    const real r1_w5_u1 = r1_w5_y2 + r1_w5_d3 + REAL(4.0) * r1_w5_e2;

    /* khepera.bg:17: r1_w5: stage 1, at rest */
    const real r1_w5_y1 = r1_w5_u1;

    /* khepera.bg:17: r1_w5: stage 1: memory */
    x->r1_w5_s1 = c->rest * r1_w5_u1;

    /* khepera.bg:17: r1: what the tolerance of m[1].el.k can do */
    const real r1_w5 = r1_w5_y1 - r1_w5_e2;

    /* khepera.bg:17: filtered speed of m[1].motor, at rest */
    const real r1_w6_m__1__motor_speed_2 = REAL(0.0);

    /* khepera.bg:17: filtered speed of m[1].motor */
    x->r1_w6_m__1__motor_speed = r1_w6_m__1__motor_speed_2;

    /* khepera.bg:17: r1_w6: encoders, order 1 */
    const real r1_w6_n1 = -c->r1_w6_w1_m__1__motor * r1_w6_m__1__motor_speed_2;

    /* khepera.bg:17: r1_w6: input of stage 4 */
    const real r1_w6_u4 = r1_w6_n1 - r1_w6_n1;

    /* khepera.bg:17: r1_w6: stage 4, at rest */
    const real r1_w6_y4 = r1_w6_u4;

    /* khepera.bg:17: r1_w6: stage 4: memory */
    x->r1_w6_s4 = c->rest * r1_w6_u4;

    /* khepera.bg:17: r1_w6: input of stage 3 */
    const real r1_w6_u3 = r1_w6_y4 + r1_w6_n1;

    /* khepera.bg:17: r1_w6: stage 3, at rest */
    const real r1_w6_y3 = r1_w6_u3;

    /* khepera.bg:17: r1_w6: stage 3: memory */
    x->r1_w6_s3 = c->rest * r1_w6_u3;

    /* khepera.bg:17: r1_w6: input of stage 2 */
    const real r1_w6_u2 = r1_w6_y3;

    /* khepera.bg:17: r1_w6: stage 2, at rest */
    const real r1_w6_y2 = r1_w6_u2;

    /* khepera.bg:17: r1_w6: stage 2: memory */
    x->r1_w6_s2 = c->rest * r1_w6_u2;

    /* khepera.bg:17: r1_w6: input of stage 1 */
    const real r1_w6_u1 = r1_w6_y2;

    /* khepera.bg:17: r1_w6: stage 1, at rest */
    const real r1_w6_y1 = r1_w6_u1;

    /* khepera.bg:17: r1_w6: stage 1: memory */
    x->r1_w6_s1 = c->rest * r1_w6_u1;

    /* khepera.bg:17: r1: what the tolerances of m[1].fe and m[1].el.Re can do together */
    const real r1_w6 = r1_w6_y1;

    /* khepera.bg:17: filtered speed of m[1].motor, at rest */
    const real r1_w7_m__1__motor_speed_2 = REAL(0.0);

    /* khepera.bg:17: filtered speed of m[1].motor */
    x->r1_w7_m__1__motor_speed = r1_w7_m__1__motor_speed_2;

    /* khepera.bg:17: r1_w7: encoders, order 1 */
    const real r1_w7_n1 = c->r1_w7_w1_m__1__motor * r1_w7_m__1__motor_speed_2;

    /* khepera.bg:17: r1_w7: error of order 1 */
    const real r1_w7_e1 = c->bend1 * r1_w7_n1;

    /* khepera.bg:17: r1_w7: encoders, order 2 */
    const real r1_w7_n2 = c->r1_w7_w2_m__1__motor * r1_w7_m__1__motor_speed_2;

    /* khepera.bg:17: r1_w7: degree 1 */
    const real r1_w7_d1 = r1_w7_n1 + r1_w7_n2;

    /* khepera.bg:17: r1_w7: degree 2 */
    const real r1_w7_d2 = r1_w7_n2 - r1_w7_e1;

    /* khepera.bg:17: r1_w7: input of stage 4 */
    const real r1_w7_u4 = r1_w7_n1 + r1_w7_d2 + r1_w7_e1 - r1_w7_d1;

    /* khepera.bg:17: r1_w7: stage 4, at rest */
    const real r1_w7_y4 = r1_w7_u4;

    /* khepera.bg:17: r1_w7: stage 4: memory */
    x->r1_w7_s4 = c->rest * r1_w7_u4;

    /* khepera.bg:17: r1_w7: input of stage 3 */
    const real r1_w7_u3 = r1_w7_y4 + r1_w7_d1 - REAL(2.0) * r1_w7_d2 - REAL(3.0) * r1_w7_e1;

    /* khepera.bg:17: r1_w7: stage 3, at rest */
    const real r1_w7_y3 = r1_w7_u3;

    /* khepera.bg:17: r1_w7: stage 3: memory */
    x->r1_w7_s3 = c->rest * r1_w7_u3;

    /* khepera.bg:17: r1_w7: input of stage 2 */
    const real r1_w7_u2 = r1_w7_y3 + r1_w7_d2 + REAL(3.0) * r1_w7_e1;

    /* khepera.bg:17: r1_w7: stage 2, at rest */
    const real r1_w7_y2 = r1_w7_u2;

    /* khepera.bg:17: r1_w7: stage 2: memory */
    x->r1_w7_s2 = c->rest * r1_w7_u2;

    /* khepera.bg:17: r1_w7: input of stage 1 */
    const real r1_w7_u1 = r1_w7_y2 - r1_w7_e1;

    /* khepera.bg:17: r1_w7: stage 1, at rest */
    const real r1_w7_y1 = r1_w7_u1;

    /* khepera.bg:17: r1_w7: stage 1: memory */
    x->r1_w7_s1 = c->rest * r1_w7_u1;

    /* khepera.bg:17: r1: what the tolerances of m[1].fe and m[1].el.k can do together */
    const real r1_w7 = r1_w7_y1;

    /* khepera.bg:17: filtered speed of m[1].motor, at rest */
    const real r1_w8_m__1__motor_speed_2 = REAL(0.0);

    /* khepera.bg:17: filtered speed of m[1].motor */
    x->r1_w8_m__1__motor_speed = r1_w8_m__1__motor_speed_2;

    /* khepera.bg:17: r1_w8: encoders, order 2 */
    const real r1_w8_n2 = -c->r1_w8_w2_m__1__motor * r1_w8_m__1__motor_speed_2;

    /* khepera.bg:17: r1_w8: input of stage 4 */
    const real r1_w8_u4 = r1_w8_n2 - r1_w8_n2;

    /* khepera.bg:17: r1_w8: stage 4, at rest */
    const real r1_w8_y4 = r1_w8_u4;

    /* khepera.bg:17: r1_w8: stage 4: memory */
    x->r1_w8_s4 = c->rest * r1_w8_u4;

    /* khepera.bg:17: r1_w8: input of stage 3 */
    const real r1_w8_u3 = r1_w8_y4 + r1_w8_n2 - REAL(2.0) * r1_w8_n2;

    /* khepera.bg:17: r1_w8: stage 3, at rest */
    const real r1_w8_y3 = r1_w8_u3;

    /* khepera.bg:17: r1_w8: stage 3: memory */
    x->r1_w8_s3 = c->rest * r1_w8_u3;

    /* khepera.bg:17: r1_w8: input of stage 2 */
    const real r1_w8_u2 = r1_w8_y3 + r1_w8_n2;

    /* khepera.bg:17: r1_w8: stage 2, at rest */
    const real r1_w8_y2 = r1_w8_u2;

    /* khepera.bg:17: r1_w8: stage 2: memory */
    x->r1_w8_s2 = c->rest * r1_w8_u2;

    /* khepera.bg:17: r1_w8: input of stage 1 */
    const real r1_w8_u1 = r1_w8_y2;

    /* khepera.bg:17: r1_w8: stage 1, at rest */
    const real r1_w8_y1 = r1_w8_u1;

    /* khepera.bg:17: r1_w8: stage 1: memory */
    x->r1_w8_s1 = c->rest * r1_w8_u1;

    /* khepera.bg:17: r1: what the tolerances of m[1].Js and m[1].el.Re can do together */
    const real r1_w8 = r1_w8_y1;

    /* khepera.bg:17: filtered speed of m[1].motor, at rest */
    const real r1_w9_m__1__motor_speed_2 = REAL(0.0);

    /* khepera.bg:17: filtered speed of m[1].motor */
    x->r1_w9_m__1__motor_speed = r1_w9_m__1__motor_speed_2;

    /* khepera.bg:17: r1_w9: encoders, order 2 */
    const real r1_w9_n2 = c->r1_w9_w2_m__1__motor * r1_w9_m__1__motor_speed_2;

    /* khepera.bg:17: r1_w9: error of order 2 */
    const real r1_w9_e2 = c->bend1 * r1_w9_n2;

    /* khepera.bg:17: r1_w9: encoders, order 3 */
    const real r1_w9_n3 = c->r1_w9_w3_m__1__motor * r1_w9_m__1__motor_speed_2;

    /* khepera.bg:17: r1_w9: degree 2 */
    const real r1_w9_d2 = r1_w9_n2 + r1_w9_n3;

    /* khepera.bg:17: r1_w9: degree 3 */
    const real r1_w9_d3 = r1_w9_n3 - r1_w9_e2;

    /* khepera.bg:17: r1_w9: input of stage 4 */
    const real r1_w9_u4 = r1_w9_d2 - r1_w9_n2 - r1_w9_d3 - r1_w9_e2;

    /* khepera.bg:17: r1_w9: stage 4, at rest */
    const real r1_w9_y4 = r1_w9_u4;

    /* khepera.bg:17: r1_w9: stage 4: memory */
    x->r1_w9_s4 = c->rest * r1_w9_u4;

    /* khepera.bg:17: r1_w9: input of stage 3 */
    const real r1_w9_u3 = r1_w9_y4 + r1_w9_n2 + REAL(3.0) * r1_w9_d3 + REAL(4.0) * r1_w9_e2
        - REAL(2.0) * r1_w9_d2;

    /* khepera.bg:17: r1_w9: stage 3, at rest */
    const real r1_w9_y3 = r1_w9_u3;

    /* khepera.bg:17: r1_w9: stage 3: memory */
    x->r1_w9_s3 = c->rest * r1_w9_u3;

    /* khepera.bg:17: r1_w9: input of stage 2 */
    const real r1_w9_u2 = r1_w9_y3 + r1_w9_d2 - REAL(3.0) * r1_w9_d3 - REAL(6.0) * r1_w9_e2;

    /* khepera.bg:17: r1_w9: stage 2, at rest */
    const real r1_w9_y2 = r1_w9_u2;

    /* khepera.bg:17: r1_w9: stage 2: memory */
    x->r1_w9_s2 = c->rest * r1_w9_u2;

    /* khepera.bg:17: r1_w9: input of stage 1 */
    const real r1_w9_u1 = r1_w9_y2 + r1_w9_d3 + REAL(4.0) * r1_w9_e2;

    /* khepera.bg:17: r1_w9: stage 1, at rest */
    const real r1_w9_y1 = r1_w9_u1;

    /* khepera.bg:17: r1_w9: stage 1: memory */
    x->r1_w9_s1 = c->rest * r1_w9_u1;

    /* khepera.bg:17: r1: what the tolerances of m[1].Js and m[1].el.k can do together */
    const real r1_w9 = r1_w9_y1 - r1_w9_e2;

    /* khepera.bg:17: filtered speed of m[1].motor, at rest */
    const real r1_w10_m__1__motor_speed_2 = REAL(0.0);

    /* khepera.bg:17: filtered speed of m[1].motor */
    x->r1_w10_m__1__motor_speed = r1_w10_m__1__motor_speed_2;

    /* khepera.bg:17: r1_w10: encoders, order 1 */
    const real r1_w10_n1 = -c->r1_w10_w1_m__1__motor * r1_w10_m__1__motor_speed_2;

    /* khepera.bg:17: r1_w10: input of stage 4 */
    const real r1_w10_u4 = r1_w10_n1 - r1_w10_n1;

    /* khepera.bg:17: r1_w10: stage 4, at rest */
    const real r1_w10_y4 = r1_w10_u4;

    /* khepera.bg:17: r1_w10: stage 4: memory */
    x->r1_w10_s4 = c->rest * r1_w10_u4;

    /* khepera.bg:17: r1_w10: input of stage 3 */
    const real r1_w10_u3 = r1_w10_y4 + r1_w10_n1;

    /* khepera.bg:17: r1_w10: stage 3, at rest */
    const real r1_w10_y3 = r1_w10_u3;

    /* khepera.bg:17: r1_w10: stage 3: memory */
    x->r1_w10_s3 = c->rest * r1_w10_u3;

    /* khepera.bg:17: r1_w10: input of stage 2 */
    const real r1_w10_u2 = r1_w10_y3;

    /* khepera.bg:17: r1_w10: stage 2, at rest */
    const real r1_w10_y2 = r1_w10_u2;

    /* khepera.bg:17: r1_w10: stage 2: memory */
    x->r1_w10_s2 = c->rest * r1_w10_u2;

    /* khepera.bg:17: r1_w10: input of stage 1 */
    const real r1_w10_u1 = r1_w10_y2;

    /* khepera.bg:17: r1_w10: stage 1, at rest */
    const real r1_w10_y1 = r1_w10_u1;

    /* khepera.bg:17: r1_w10: stage 1: memory */
    x->r1_w10_s1 = c->rest * r1_w10_u1;

    /* khepera.bg:17: r1: what the tolerances of m[1].fs and m[1].el.Re can do together */
    const real r1_w10 = r1_w10_y1;

    /* khepera.bg:17: filtered speed of m[1].motor, at rest */
    const real r1_w11_m__1__motor_speed_2 = REAL(0.0);

    /* khepera.bg:17: filtered speed of m[1].motor */
    x->r1_w11_m__1__motor_speed = r1_w11_m__1__motor_speed_2;

    /* khepera.bg:17: r1_w11: encoders, order 1 */
    const real r1_w11_n1 = c->r1_w11_w1_m__1__motor * r1_w11_m__1__motor_speed_2;

    /* khepera.bg:17: r1_w11: error of order 1 */
    const real r1_w11_e1 = c->bend1 * r1_w11_n1;

    /* khepera.bg:17: r1_w11: encoders, order 2 */
    const real r1_w11_n2 = c->r1_w11_w2_m__1__motor * r1_w11_m__1__motor_speed_2;

    /* khepera.bg:17: r1_w11: degree 1 */
    const real r1_w11_d1 = r1_w11_n1 + r1_w11_n2;

    /* khepera.bg:17: r1_w11: degree 2 */
    const real r1_w11_d2 = r1_w11_n2 - r1_w11_e1;

    /* khepera.bg:17: r1_w11: input of stage 4 */
    const real r1_w11_u4 = r1_w11_n1 + r1_w11_d2 + r1_w11_e1 - r1_w11_d1;

    /* khepera.bg:17: r1_w11: stage 4, at rest */
    const real r1_w11_y4 = r1_w11_u4;

    /* khepera.bg:17: r1_w11: stage 4: memory */
    x->r1_w11_s4 = c->rest * r1_w11_u4;

    /* khepera.bg:17: r1_w11: input of stage 3 */
    const real r1_w11_u3 = r1_w11_y4 + r1_w11_d1 - REAL(2.0) * r1_w11_d2 - REAL(3.0) * r1_w11_e1;

    /* khepera.bg:17: r1_w11: stage 3, at rest */
    const real r1_w11_y3 = r1_w11_u3;

    /* khepera.bg:17: r1_w11: stage 3: memory */
    x->r1_w11_s3 = c->rest * r1_w11_u3;

    /* khepera.bg:17: r1_w11: input of stage 2 */
    const real r1_w11_u2 = r1_w11_y3 + r1_w11_d2 + REAL(3.0) * r1_w11_e1;

    /* khepera.bg:17: r1_w11: stage 2, at rest */
    const real r1_w11_y2 = r1_w11_u2;

    /* khepera.bg:17: r1_w11: stage 2: memory */
    x->r1_w11_s2 = c->rest * r1_w11_u2;

    /* khepera.bg:17: r1_w11: input of stage 1 */
    const real r1_w11_u1 = r1_w11_y2 - r1_w11_e1;

    /* khepera.bg:17: r1_w11: stage 1, at rest */
    const real r1_w11_y1 = r1_w11_u1;

    /* khepera.bg:17: r1_w11: stage 1: memory */
    x->r1_w11_s1 = c->rest * r1_w11_u1;

    /* khepera.bg:17: r1: what the tolerances of m[1].fs and m[1].el.k can do together */
    const real r1_w11 = r1_w11_y1;

    /* khepera.bg:17: filtered speed of m[1].motor, at rest */
    const real r1_w12_m__1__motor_speed_2 = REAL(0.0);

    /* khepera.bg:17: filtered speed of m[1].motor */
    x->r1_w12_m__1__motor_speed = r1_w12_m__1__motor_speed_2;

    /* khepera.bg:17: r1_w12: encoders, order 1 */
    const real r1_w12_n1 = c->r1_w12_w1_m__1__motor * r1_w12_m__1__motor_speed_2;

    /* khepera.bg:17: r1_w12: error of order 1 */
    const real r1_w12_e1 = c->bend1 * r1_w12_n1;

    /* khepera.bg:17: r1_w12: encoders, order 2 */
    const real r1_w12_n2 = c->r1_w12_w2_m__1__motor * r1_w12_m__1__motor_speed_2;

    /* khepera.bg:17: r1_w12: terms of order 0 */
    const real r1_w12_g0 = c->r1_w12_Fx__1 * s->Fx__1;

    /* khepera.bg:17: r1_w12: degree 1 */
    const real r1_w12_d1 = r1_w12_n1 + r1_w12_n2;

    /* khepera.bg:17: r1_w12: error of order 0 */
    const real r1_w12_e0 = c->bend2 * r1_w12_g0;

    /* khepera.bg:17: r1_w12: degree 2 */
    const real r1_w12_d2 = r1_w12_n2 - r1_w12_e1 - r1_w12_e0;

    /* khepera.bg:17: r1_w12: input of stage 4 */
    const real r1_w12_u4 = r1_w12_g0 + r1_w12_n1 + r1_w12_d2 + r1_w12_e1 - r1_w12_d1;

    /* khepera.bg:17: r1_w12: stage 4, at rest */
    const real r1_w12_y4 = r1_w12_u4;

    /* khepera.bg:17: r1_w12: stage 4: memory */
    x->r1_w12_s4 = c->rest * r1_w12_u4;

    /* khepera.bg:17: r1_w12: input of stage 3 */
    const real r1_w12_u3 = r1_w12_y4 + r1_w12_d1 - REAL(2.0) * r1_w12_d2 - REAL(3.0) * r1_w12_e1;

    /* khepera.bg:17: r1_w12: stage 3, at rest */
    const real r1_w12_y3 = r1_w12_u3;

    /* khepera.bg:17: r1_w12: stage 3: memory */
    x->r1_w12_s3 = c->rest * r1_w12_u3;

    /* khepera.bg:17: r1_w12: input of stage 2 */
    const real r1_w12_u2 = r1_w12_y3 + r1_w12_d2 + REAL(3.0) * r1_w12_e1;

    /* khepera.bg:17: r1_w12: stage 2, at rest */
    const real r1_w12_y2 = r1_w12_u2;

    /* khepera.bg:17: r1_w12: stage 2: memory */
    x->r1_w12_s2 = c->rest * r1_w12_u2;

    /* khepera.bg:17: r1_w12: input of stage 1 */
    const real r1_w12_u1 = r1_w12_y2 - r1_w12_e1;

    /* khepera.bg:17: r1_w12: stage 1, at rest */
    const real r1_w12_y1 = r1_w12_u1;

    /* khepera.bg:17: r1_w12: stage 1: memory */
    x->r1_w12_s1 = c->rest * r1_w12_u1;

    /* khepera.bg:17: r1: what the tolerances of m[1].el.Re and m[1].el.k can do together */
    const real r1_w12 = r1_w12_y1;

    /* khepera.bg:17: filtered speed of m[1].motor, at rest */
    const real r1_w13_m__1__motor_speed_2 = REAL(0.0);

    /* khepera.bg:17: filtered speed of m[1].motor */
    x->r1_w13_m__1__motor_speed = r1_w13_m__1__motor_speed_2;

    /* khepera.bg:17: r1_w13: encoders, order 1 */
    const real r1_w13_n1 = -c->r1_w13_w1_m__1__motor * r1_w13_m__1__motor_speed_2;

    /* khepera.bg:17: r1_w13: error of order 1 */
    const real r1_w13_e1 = c->bend2 * r1_w13_n1;

    /* khepera.bg:17: r1_w13: encoders, order 2 */
    const real r1_w13_n2 = c->r1_w13_w2_m__1__motor * r1_w13_m__1__motor_speed_2;

    /* khepera.bg:17: r1_w13: error of order 2 */
    const real r1_w13_e2 = c->bend1 * r1_w13_n2;

    /* khepera.bg:17: r1_w13: encoders, order 3 */
    const real r1_w13_n3 = -c->r1_w13_w3_m__1__motor * r1_w13_m__1__motor_speed_2;

    /* khepera.bg:17: r1_w13: terms of order 0 */
    const real r1_w13_g0 = -c->r1_w13_Fx__1 * s->Fx__1;

    /* khepera.bg:17: r1_w13: terms of order 1 */
    const real r1_w13_g1 = -c->r1_w13_w1_Fx__1 * s->Fx__1;

    /* khepera.bg:17: r1_w13: degree 1 */
    const real r1_w13_d1 = r1_w13_g1 + r1_w13_n1 + r1_w13_n2;

    /* khepera.bg:17: r1_w13: error of order 0 */
    const real r1_w13_e0 = c->bend3 * r1_w13_g0;

    /* khepera.bg:17: r1_w13: degree 2 */
    const real r1_w13_d2 = r1_w13_n2 + r1_w13_n3 - r1_w13_e1 - r1_w13_e0;

    /* khepera.bg:17: r1_w13: error of order 1 */
    const real r1_w13_e1_2 = c->bend2 * r1_w13_g1;

    /* khepera.bg:17: r1_w13: degree 3 */
    const real r1_w13_d3 = r1_w13_n3 - r1_w13_e1 - r1_w13_e2 - r1_w13_e1_2;

    /* khepera.bg:17: r1_w13: input of stage 4 */
    const real r1_w13_u4 = r1_w13_g0 + r1_w13_n1 + r1_w13_d2 - r1_w13_d1 - r1_w13_d3 - r1_w13_e2;

    /* khepera.bg:17: r1_w13: stage 4, at rest */
    const real r1_w13_y4 = r1_w13_u4;

    /* khepera.bg:17: r1_w13: stage 4: memory */
    x->r1_w13_s4 = c->rest * r1_w13_u4;

    /* khepera.bg:17: r1_w13: input of stage 3 */
    const real r1_w13_u3 = r1_w13_y4 + r1_w13_d1 + REAL(3.0) * r1_w13_d3 + REAL(4.0) * r1_w13_e2
        - REAL(2.0) * r1_w13_d2;

    /* khepera.bg:17: r1_w13: stage 3, at rest */
    const real r1_w13_y3 = r1_w13_u3;

    /* khepera.bg:17: r1_w13: stage 3: memory */
    x->r1_w13_s3 = c->rest * r1_w13_u3;

    /* khepera.bg:17: r1_w13: input of stage 2 */
    const real r1_w13_u2 = r1_w13_y3 + r1_w13_d2 - REAL(3.0) * r1_w13_d3 - REAL(6.0) * r1_w13_e2;

    /* khepera.bg:17: r1_w13: stage 2, at rest */
    const real r1_w13_y2 = r1_w13_u2;

    /* khepera.bg:17: r1_w13: stage 2: memory */
    x->r1_w13_s2 = c->rest * r1_w13_u2;

    /* khepera.bg:17: r1_w13: input of stage 1 */
    const real r1_w13_u1 = r1_w13_y2 + r1_w13_d3 + REAL(4.0) * r1_w13_e2;

    /* khepera.bg:17: r1_w13: stage 1, at rest */
    const real r1_w13_y1 = r1_w13_u1;

    /* khepera.bg:17: r1_w13: stage 1: memory */
    x->r1_w13_s1 = c->rest * r1_w13_u1;

    /* khepera.bg:17: r1: second order of what the tolerance of m[1].el.k can do */
    const real r1_w13 = r1_w13_y1 - r1_w13_e2;

    /* khepera.bg:17: r1: how far r1 can be from zero if no parameter is out of tolerance */
    r[KHEPERA_BUILT_THRESHOLD_R1] = MATH(fabs)(r1_w1) + MATH(fabs)(r1_w2) + MATH(fabs)(r1_w3)
        + MATH(fabs)(r1_w4) + MATH(fabs)(r1_w5) + MATH(fabs)(r1_w6) + MATH(fabs)(r1_w7)
        + MATH(fabs)(r1_w8) + MATH(fabs)(r1_w9) + MATH(fabs)(r1_w10) + MATH(fabs)(r1_w11)
        + MATH(fabs)(r1_w12) + MATH(fabs)(r1_w13);
}

/* r1 on every further sample. */
static void next_r1(
    khepera_built_threshold_monitor *monitor, const khepera_built_threshold_samples *s, real *r)
{
    const khepera_built_threshold_coefficients *c = &monitor->c;
    khepera_built_threshold_memory *x = &monitor->x;
    const khepera_built_threshold_encoders *e = &monitor->e;

    count_on(&monitor->e.m__1__motor, s->m__1__motor);

    /* khepera.bg:17: filtered speed of m[1].motor */
    const real r1_w1_m__1__motor_speed_2 = c->a * x->r1_w1_m__1__motor_speed
        + c->m__1__motor_gain * (real)e->m__1__motor.increment;
    x->r1_w1_m__1__motor_speed = r1_w1_m__1__motor_speed_2;

    /* khepera.bg:17: r1_w1: encoders, order 1 */
    const real r1_w1_n1 = -c->r1_w1_w1_m__1__motor * r1_w1_m__1__motor_speed_2;

    /* khepera.bg:17: r1_w1: error of order 1 */
    const real r1_w1_e1 = c->bend1 * r1_w1_n1;

    /* khepera.bg:17: r1_w1: encoders, order 2 */
    const real r1_w1_n2 = -c->r1_w1_w2_m__1__motor * r1_w1_m__1__motor_speed_2;

    /* khepera.bg:17: r1_w1: degree 1 */
    const real r1_w1_d1 = r1_w1_n1 + r1_w1_n2;

    /* khepera.bg:17: r1_w1: degree 2 */
    const real r1_w1_d2 = r1_w1_n2 - r1_w1_e1;

    /* khepera.bg:17: r1_w1: input of stage 4 */
    const real r1_w1_u4 = r1_w1_n1 + r1_w1_d2 + r1_w1_e1 - r1_w1_d1;

    /* khepera.bg:17: r1_w1: stage 4 */
    const real r1_w1_y4 = x->r1_w1_s4 + c->b * r1_w1_u4;

    /* khepera.bg:17: r1_w1: stage 4: memory */
    x->r1_w1_s4 = c->a * r1_w1_y4 + c->b * r1_w1_u4;

    /* khepera.bg:17: r1_w1: input of stage 3 */
    const real r1_w1_u3 = r1_w1_y4 + r1_w1_d1 - REAL(2.0) * r1_w1_d2 - REAL(3.0) * r1_w1_e1;

    /* khepera.bg:17: r1_w1: stage 3 */
    const real r1_w1_y3 = x->r1_w1_s3 + c->b * r1_w1_u3;

    /* khepera.bg:17: r1_w1: stage 3: memory */
    x->r1_w1_s3 = c->a * r1_w1_y3 + c->b * r1_w1_u3;

    /* khepera.bg:17: r1_w1: input of stage 2 */
    const real r1_w1_u2 = r1_w1_y3 + r1_w1_d2 + REAL(3.0) * r1_w1_e1;

    /* khepera.bg:17: r1_w1: stage 2 */
    const real r1_w1_y2 = x->r1_w1_s2 + c->b * r1_w1_u2;

    /* khepera.bg:17: r1_w1: stage 2: memory */
    x->r1_w1_s2 = c->a * r1_w1_y2 + c->b * r1_w1_u2;

    /* khepera.bg:17: r1_w1: input of stage 1 */
    const real r1_w1_u1 = r1_w1_y2 - r1_w1_e1;

    /* khepera.bg:17: r1_w1: stage 1 */
    const real r1_w1_y1 = x->r1_w1_s1 + c->b * r1_w1_u1;

    /* khepera.bg:17: r1_w1: stage 1: memory */
    x->r1_w1_s1 = c->a * r1_w1_y1 + c->b * r1_w1_u1;

    /* khepera.bg:17: r1: what the tolerance of m[1].fe can do */
    const real r1_w1 = r1_w1_y1;

    /* khepera.bg:17: filtered speed of m[1].motor */
    const real r1_w2_m__1__motor_speed_2 = c->a * x->r1_w2_m__1__motor_speed
        + c->m__1__motor_gain * (real)e->m__1__motor.increment;
    x->r1_w2_m__1__motor_speed = r1_w2_m__1__motor_speed_2;

    /* khepera.bg:17: r1_w2: encoders, order 2 */
    const real r1_w2_n2 = -c->r1_w2_w2_m__1__motor * r1_w2_m__1__motor_speed_2;

    /* khepera.bg:17: r1_w2: error of order 2 */
    const real r1_w2_e2 = c->bend1 * r1_w2_n2;

    /* khepera.bg:17: r1_w2: encoders, order 3 */
    const real r1_w2_n3 = -c->r1_w2_w3_m__1__motor * r1_w2_m__1__motor_speed_2;

    /* khepera.bg:17: r1_w2: degree 2 */
    const real r1_w2_d2 = r1_w2_n2 + r1_w2_n3;

    /* khepera.bg:17: r1_w2: degree 3 */
    const real r1_w2_d3 = r1_w2_n3 - r1_w2_e2;

    /* khepera.bg:17: r1_w2: input of stage 4 */
    const real r1_w2_u4 = r1_w2_d2 - r1_w2_n2 - r1_w2_d3 - r1_w2_e2;

    /* khepera.bg:17: r1_w2: stage 4 */
    const real r1_w2_y4 = x->r1_w2_s4 + c->b * r1_w2_u4;

    /* khepera.bg:17: r1_w2: stage 4: memory */
    x->r1_w2_s4 = c->a * r1_w2_y4 + c->b * r1_w2_u4;

    /* khepera.bg:17: r1_w2: input of stage 3 */
    const real r1_w2_u3 = r1_w2_y4 + r1_w2_n2 + REAL(3.0) * r1_w2_d3 + REAL(4.0) * r1_w2_e2
        - REAL(2.0) * r1_w2_d2;

    /* khepera.bg:17: r1_w2: stage 3 */
    const real r1_w2_y3 = x->r1_w2_s3 + c->b * r1_w2_u3;

    /* khepera.bg:17: r1_w2: stage 3: memory */
    x->r1_w2_s3 = c->a * r1_w2_y3 + c->b * r1_w2_u3;

    /* khepera.bg:17: r1_w2: input of stage 2 */
    const real r1_w2_u2 = r1_w2_y3 + r1_w2_d2 - REAL(3.0) * r1_w2_d3 - REAL(6.0) * r1_w2_e2;

    /* khepera.bg:17: r1_w2: stage 2 */
    const real r1_w2_y2 = x->r1_w2_s2 + c->b * r1_w2_u2;

    /* khepera.bg:17: r1_w2: stage 2: memory */
    x->r1_w2_s2 = c->a * r1_w2_y2 + c->b * r1_w2_u2;

    /* khepera.bg:17: r1_w2: input of stage 1 */
    const real r1_w2_u1 = r1_w2_y2 + r1_w2_d3 + REAL(4.0) * r1_w2_e2;

    /* khepera.bg:17: r1_w2: stage 1 */
    const real r1_w2_y1 = x->r1_w2_s1 + c->b * r1_w2_u1;

    /* khepera.bg:17: r1_w2: stage 1: memory */
    x->r1_w2_s1 = c->a * r1_w2_y1 + c->b * r1_w2_u1;

    /* khepera.bg:17: r1: what the tolerance of m[1].Js can do */
    const real r1_w2 = r1_w2_y1 - r1_w2_e2;

    /* khepera.bg:17: filtered speed of m[1].motor */
    const real r1_w3_m__1__motor_speed_2 = c->a * x->r1_w3_m__1__motor_speed
        + c->m__1__motor_gain * (real)e->m__1__motor.increment;
    x->r1_w3_m__1__motor_speed = r1_w3_m__1__motor_speed_2;

    /* khepera.bg:17: r1_w3: encoders, order 1 */
    const real r1_w3_n1 = -c->r1_w3_w1_m__1__motor * r1_w3_m__1__motor_speed_2;

    /* khepera.bg:17: r1_w3: error of order 1 */
    const real r1_w3_e1 = c->bend1 * r1_w3_n1;

    /* khepera.bg:17: r1_w3: encoders, order 2 */
    const real r1_w3_n2 = -c->r1_w3_w2_m__1__motor * r1_w3_m__1__motor_speed_2;

    /* khepera.bg:17: r1_w3: degree 1 */
    const real r1_w3_d1 = r1_w3_n1 + r1_w3_n2;

    /* khepera.bg:17: r1_w3: degree 2 */
    const real r1_w3_d2 = r1_w3_n2 - r1_w3_e1;

    /* khepera.bg:17: r1_w3: input of stage 4 */
    const real r1_w3_u4 = r1_w3_n1 + r1_w3_d2 + r1_w3_e1 - r1_w3_d1;

    /* khepera.bg:17: r1_w3: stage 4 */
    const real r1_w3_y4 = x->r1_w3_s4 + c->b * r1_w3_u4;

    /* khepera.bg:17: r1_w3: stage 4: memory */
    x->r1_w3_s4 = c->a * r1_w3_y4 + c->b * r1_w3_u4;

    /* khepera.bg:17: r1_w3: input of stage 3 */
    const real r1_w3_u3 = r1_w3_y4 + r1_w3_d1 - REAL(2.0) * r1_w3_d2 - REAL(3.0) * r1_w3_e1;

    /* khepera.bg:17: r1_w3: stage 3 */
    const real r1_w3_y3 = x->r1_w3_s3 + c->b * r1_w3_u3;

    /* khepera.bg:17: r1_w3: stage 3: memory */
    x->r1_w3_s3 = c->a * r1_w3_y3 + c->b * r1_w3_u3;

    /* khepera.bg:17: r1_w3: input of stage 2 */
    const real r1_w3_u2 = r1_w3_y3 + r1_w3_d2 + REAL(3.0) * r1_w3_e1;

    /* khepera.bg:17: r1_w3: stage 2 */
    const real r1_w3_y2 = x->r1_w3_s2 + c->b * r1_w3_u2;

    /* khepera.bg:17: r1_w3: stage 2: memory */
    x->r1_w3_s2 = c->a * r1_w3_y2 + c->b * r1_w3_u2;

    /* khepera.bg:17: r1_w3: input of stage 1 */
    const real r1_w3_u1 = r1_w3_y2 - r1_w3_e1;

    /* khepera.bg:17: r1_w3: stage 1 */
    const real r1_w3_y1 = x->r1_w3_s1 + c->b * r1_w3_u1;

    /* khepera.bg:17: r1_w3: stage 1: memory */
    x->r1_w3_s1 = c->a * r1_w3_y1 + c->b * r1_w3_u1;

    /* khepera.bg:17: r1: what the tolerance of m[1].fs can do */
    const real r1_w3 = r1_w3_y1;

    /* khepera.bg:17: filtered speed of m[1].motor */
    const real r1_w4_m__1__motor_speed_2 = c->a * x->r1_w4_m__1__motor_speed
        + c->m__1__motor_gain * (real)e->m__1__motor.increment;
    x->r1_w4_m__1__motor_speed = r1_w4_m__1__motor_speed_2;

    /* khepera.bg:17: r1_w4: encoders, order 1 */
    const real r1_w4_n1 = -c->r1_w4_w1_m__1__motor * r1_w4_m__1__motor_speed_2;

    /* khepera.bg:17: r1_w4: error of order 1 */
    const real r1_w4_e1 = c->bend1 * r1_w4_n1;

    /* khepera.bg:17: r1_w4: encoders, order 2 */
    const real r1_w4_n2 = -c->r1_w4_w2_m__1__motor * r1_w4_m__1__motor_speed_2;

    /* khepera.bg:17: r1_w4: terms of order 0 */
    const real r1_w4_g0 = -c->r1_w4_Fx__1 * s->Fx__1;

    /* khepera.bg:17: r1_w4: degree 1 */
    const real r1_w4_d1 = r1_w4_n1 + r1_w4_n2;

    /* khepera.bg:17: r1_w4: error of order 0 */
    const real r1_w4_e0 = c->bend2 * r1_w4_g0;

    /* khepera.bg:17: r1_w4: degree 2 */
    const real r1_w4_d2 = r1_w4_n2 - r1_w4_e1 - r1_w4_e0;

    /* khepera.bg:17: r1_w4: input of stage 4 */
    const real r1_w4_u4 = r1_w4_g0 + r1_w4_n1 + r1_w4_d2 + r1_w4_e1 - r1_w4_d1;

    /* khepera.bg:17: r1_w4: stage 4 */
    const real r1_w4_y4 = x->r1_w4_s4 + c->b * r1_w4_u4;

    /* khepera.bg:17: r1_w4: stage 4: memory */
    x->r1_w4_s4 = c->a * r1_w4_y4 + c->b * r1_w4_u4;

    /* khepera.bg:17: r1_w4: input of stage 3 */
    const real r1_w4_u3 = r1_w4_y4 + r1_w4_d1 - REAL(2.0) * r1_w4_d2 - REAL(3.0) * r1_w4_e1;

    /* khepera.bg:17: r1_w4: stage 3 */
    const real r1_w4_y3 = x->r1_w4_s3 + c->b * r1_w4_u3;

    /* khepera.bg:17: r1_w4: stage 3: memory */
    x->r1_w4_s3 = c->a * r1_w4_y3 + c->b * r1_w4_u3;

    /* khepera.bg:17: r1_w4: input of stage 2 */
    const real r1_w4_u2 = r1_w4_y3 + r1_w4_d2 + REAL(3.0) * r1_w4_e1;

    /* khepera.bg:17: r1_w4: stage 2 */
    const real r1_w4_y2 = x->r1_w4_s2 + c->b * r1_w4_u2;

    /* khepera.bg:17: r1_w4: stage 2: memory */
    x->r1_w4_s2 = c->a * r1_w4_y2 + c->b * r1_w4_u2;

    /* khepera.bg:17: r1_w4: input of stage 1 */
    const real r1_w4_u1 = r1_w4_y2 - r1_w4_e1;

    /* khepera.bg:17: r1_w4: stage 1 */
    const real r1_w4_y1 = x->r1_w4_s1 + c->b * r1_w4_u1;

    /* khepera.bg:17: r1_w4: stage 1: memory */
    x->r1_w4_s1 = c->a * r1_w4_y1 + c->b * r1_w4_u1;

    /* khepera.bg:17: r1: what the tolerance of m[1].el.Re can do */
    const real r1_w4 = r1_w4_y1;

    /* khepera.bg:17: filtered speed of m[1].motor */
    const real r1_w5_m__1__motor_speed_2 = c->a * x->r1_w5_m__1__motor_speed
        + c->m__1__motor_gain * (real)e->m__1__motor.increment;
    x->r1_w5_m__1__motor_speed = r1_w5_m__1__motor_speed_2;

    /* khepera.bg:17: r1_w5: encoders, order 1 */
    const real r1_w5_n1 = c->r1_w5_w1_m__1__motor * r1_w5_m__1__motor_speed_2;

    /* khepera.bg:17: r1_w5: error of order 1 */
    const real r1_w5_e1 = c->bend2 * r1_w5_n1;

    /* khepera.bg:17: r1_w5: encoders, order 2 */
    const real r1_w5_n2 = c->r1_w5_w2_m__1__motor * r1_w5_m__1__motor_speed_2;

    /* khepera.bg:17: r1_w5: error of order 2 */
    const real r1_w5_e2 = c->bend1 * r1_w5_n2;

    /* khepera.bg:17: r1_w5: encoders, order 3 */
    const real r1_w5_n3 = c->r1_w5_w3_m__1__motor * r1_w5_m__1__motor_speed_2;

    /* khepera.bg:17: r1_w5: terms of order 0 */
    const real r1_w5_g0 = c->r1_w5_Fx__1 * s->Fx__1;

    /* khepera.bg:17: r1_w5: terms of order 1 */
    const real r1_w5_g1 = c->r1_w5_w1_Fx__1 * s->Fx__1;

    /* khepera.bg:17: r1_w5: degree 1 */
    const real r1_w5_d1 = r1_w5_g1 + r1_w5_n1 + r1_w5_n2;

    /* khepera.bg:17: r1_w5: error of order 0 */
    const real r1_w5_e0 = c->bend3 * r1_w5_g0;

    /* khepera.bg:17: r1_w5: degree 2 */
    const real r1_w5_d2 = r1_w5_n2 + r1_w5_n3 - r1_w5_e1 - r1_w5_e0;

    /* khepera.bg:17: r1_w5: error of order 1 */
    const real r1_w5_e1_2 = c->bend2 * r1_w5_g1;

    /* khepera.bg:17: r1_w5: degree 3 */
    const real r1_w5_d3 = r1_w5_n3 - r1_w5_e1 - r1_w5_e2 - r1_w5_e1_2;

    /* khepera.bg:17: r1_w5: input of stage 4 */
    const real r1_w5_u4 = r1_w5_g0 + r1_w5_n1 + r1_w5_d2 - r1_w5_d1 - r1_w5_d3 - r1_w5_e2;

    /* khepera.bg:17: r1_w5: stage 4 */
    const real r1_w5_y4 = x->r1_w5_s4 + c->b * r1_w5_u4;

    /* khepera.bg:17: r1_w5: stage 4: memory */
    x->r1_w5_s4 = c->a * r1_w5_y4 + c->b * r1_w5_u4;

    /* khepera.bg:17: r1_w5: input of stage 3 */
    const real r1_w5_u3 = r1_w5_y4 + r1_w5_d1 + REAL(3.0) * r1_w5_d3 + REAL(4.0) * r1_w5_e2
        - REAL(2.0) * r1_w5_d2;

    /* khepera.bg:17: r1_w5: stage 3 */
    const real r1_w5_y3 = x->r1_w5_s3 + c->b * r1_w5_u3;

    /* khepera.bg:17: r1_w5: stage 3: memory */
    x->r1_w5_s3 = c->a * r1_w5_y3 + c->b * r1_w5_u3;

    /* khepera.bg:17: r1_w5: input of stage 2 */
    const real r1_w5_u2 = r1_w5_y3 + r1_w5_d2 - REAL(3.0) * r1_w5_d3 - REAL(6.0) * r1_w5_e2;

    /* khepera.bg:17: r1_w5: stage 2 */
    const real r1_w5_y2 = x->r1_w5_s2 + c->b * r1_w5_u2;

    /* khepera.bg:17: r1_w5: stage 2: memory */
    x->r1_w5_s2 = c->a * r1_w5_y2 + c->b * r1_w5_u2;

    /* khepera.bg:17: r1_w5: input of stage 1 */
    const real r1_w5_u1 = r1_w5_y2 + r1_w5_d3 + REAL(4.0) * r1_w5_e2;

    /* khepera.bg:17: r1_w5: stage 1 */
    const real r1_w5_y1 = x->r1_w5_s1 + c->b * r1_w5_u1;

    /* khepera.bg:17: r1_w5: stage 1: memory */
    x->r1_w5_s1 = c->a * r1_w5_y1 + c->b * r1_w5_u1;

    /* khepera.bg:17: r1: what the tolerance of m[1].el.k can do */
    const real r1_w5 = r1_w5_y1 - r1_w5_e2;

    /* khepera.bg:17: filtered speed of m[1].motor */
    const real r1_w6_m__1__motor_speed_2 = c->a * x->r1_w6_m__1__motor_speed
        + c->m__1__motor_gain * (real)e->m__1__motor.increment;
    x->r1_w6_m__1__motor_speed = r1_w6_m__1__motor_speed_2;

    /* khepera.bg:17: r1_w6: encoders, order 1 */
    const real r1_w6_n1 = -c->r1_w6_w1_m__1__motor * r1_w6_m__1__motor_speed_2;

    /* khepera.bg:17: r1_w6: input of stage 4 */
    const real r1_w6_u4 = r1_w6_n1 - r1_w6_n1;

    /* khepera.bg:17: r1_w6: stage 4 */
    const real r1_w6_y4 = x->r1_w6_s4 + c->b * r1_w6_u4;

    /* khepera.bg:17: r1_w6: stage 4: memory */
    x->r1_w6_s4 = c->a * r1_w6_y4 + c->b * r1_w6_u4;

    /* khepera.bg:17: r1_w6: input of stage 3 */
    const real r1_w6_u3 = r1_w6_y4 + r1_w6_n1;

    /* khepera.bg:17: r1_w6: stage 3 */
    const real r1_w6_y3 = x->r1_w6_s3 + c->b * r1_w6_u3;

    /* khepera.bg:17: r1_w6: stage 3: memory */
    x->r1_w6_s3 = c->a * r1_w6_y3 + c->b * r1_w6_u3;

    /* khepera.bg:17: r1_w6: input of stage 2 */
    const real r1_w6_u2 = r1_w6_y3;

    /* khepera.bg:17: r1_w6: stage 2 */
    const real r1_w6_y2 = x->r1_w6_s2 + c->b * r1_w6_u2;

    /* khepera.bg:17: r1_w6: stage 2: memory */
    x->r1_w6_s2 = c->a * r1_w6_y2 + c->b * r1_w6_u2;

    /* khepera.bg:17: r1_w6: input of stage 1 */
    const real r1_w6_u1 = r1_w6_y2;

    /* khepera.bg:17: r1_w6: stage 1 */
    const real r1_w6_y1 = x->r1_w6_s1 + c->b * r1_w6_u1;

    /* khepera.bg:17: r1_w6: stage 1: memory */
    x->r1_w6_s1 = c->a * r1_w6_y1 + c->b * r1_w6_u1;

    /* khepera.bg:17: r1: what the tolerances of m[1].fe and m[1].el.Re can do together */
    const real r1_w6 = r1_w6_y1;

    /* khepera.bg:17: filtered speed of m[1].motor */
    const real r1_w7_m__1__motor_speed_2 = c->a * x->r1_w7_m__1__motor_speed
        + c->m__1__motor_gain * (real)e->m__1__motor.increment;
    x->r1_w7_m__1__motor_speed = r1_w7_m__1__motor_speed_2;

    /* khepera.bg:17: r1_w7: encoders, order 1 */
    const real r1_w7_n1 = c->r1_w7_w1_m__1__motor * r1_w7_m__1__motor_speed_2;

    /* khepera.bg:17: r1_w7: error of order 1 */
    const real r1_w7_e1 = c->bend1 * r1_w7_n1;

    /* khepera.bg:17: r1_w7: encoders, order 2 */
    const real r1_w7_n2 = c->r1_w7_w2_m__1__motor * r1_w7_m__1__motor_speed_2;

    /* khepera.bg:17: r1_w7: degree 1 */
    const real r1_w7_d1 = r1_w7_n1 + r1_w7_n2;

    /* khepera.bg:17: r1_w7: degree 2 */
    const real r1_w7_d2 = r1_w7_n2 - r1_w7_e1;

    /* khepera.bg:17: r1_w7: input of stage 4 */
    const real r1_w7_u4 = r1_w7_n1 + r1_w7_d2 + r1_w7_e1 - r1_w7_d1;

    /* khepera.bg:17: r1_w7: stage 4 */
    const real r1_w7_y4 = x->r1_w7_s4 + c->b * r1_w7_u4;

    /* khepera.bg:17: r1_w7: stage 4: memory */
    x->r1_w7_s4 = c->a * r1_w7_y4 + c->b * r1_w7_u4;

    /* khepera.bg:17: r1_w7: input of stage 3 */
    const real r1_w7_u3 = r1_w7_y4 + r1_w7_d1 - REAL(2.0) * r1_w7_d2 - REAL(3.0) * r1_w7_e1;

    /* khepera.bg:17: r1_w7: stage 3 */
    const real r1_w7_y3 = x->r1_w7_s3 + c->b * r1_w7_u3;

    /* khepera.bg:17: r1_w7: stage 3: memory */
    x->r1_w7_s3 = c->a * r1_w7_y3 + c->b * r1_w7_u3;

    /* khepera.bg:17: r1_w7: input of stage 2 */
    const real r1_w7_u2 = r1_w7_y3 + r1_w7_d2 + REAL(3.0) * r1_w7_e1;

    /* khepera.bg:17: r1_w7: stage 2 */
    const real r1_w7_y2 = x->r1_w7_s2 + c->b * r1_w7_u2;

    /* khepera.bg:17: r1_w7: stage 2: memory */
    x->r1_w7_s2 = c->a * r1_w7_y2 + c->b * r1_w7_u2;

    /* khepera.bg:17: r1_w7: input of stage 1 */
    const real r1_w7_u1 = r1_w7_y2 - r1_w7_e1;

    /* khepera.bg:17: r1_w7: stage 1 */
    const real r1_w7_y1 = x->r1_w7_s1 + c->b * r1_w7_u1;

    /* khepera.bg:17: r1_w7: stage 1: memory */
    x->r1_w7_s1 = c->a * r1_w7_y1 + c->b * r1_w7_u1;

    /* khepera.bg:17: r1: what the tolerances of m[1].fe and m[1].el.k can do together */
    const real r1_w7 = r1_w7_y1;

    /* khepera.bg:17: filtered speed of m[1].motor */
    const real r1_w8_m__1__motor_speed_2 = c->a * x->r1_w8_m__1__motor_speed
        + c->m__1__motor_gain * (real)e->m__1__motor.increment;
    x->r1_w8_m__1__motor_speed = r1_w8_m__1__motor_speed_2;

    /* khepera.bg:17: r1_w8: encoders, order 2 */
    const real r1_w8_n2 = -c->r1_w8_w2_m__1__motor * r1_w8_m__1__motor_speed_2;

    /* khepera.bg:17: r1_w8: input of stage 4 */
    const real r1_w8_u4 = r1_w8_n2 - r1_w8_n2;

    /* khepera.bg:17: r1_w8: stage 4 */
    const real r1_w8_y4 = x->r1_w8_s4 + c->b * r1_w8_u4;

    /* khepera.bg:17: r1_w8: stage 4: memory */
    x->r1_w8_s4 = c->a * r1_w8_y4 + c->b * r1_w8_u4;

    /* khepera.bg:17: r1_w8: input of stage 3 */
    const real r1_w8_u3 = r1_w8_y4 + r1_w8_n2 - REAL(2.0) * r1_w8_n2;

    /* khepera.bg:17: r1_w8: stage 3 */
    const real r1_w8_y3 = x->r1_w8_s3 + c->b * r1_w8_u3;

    /* khepera.bg:17: r1_w8: stage 3: memory */
    x->r1_w8_s3 = c->a * r1_w8_y3 + c->b * r1_w8_u3;

    /* khepera.bg:17: r1_w8: input of stage 2 */
    const real r1_w8_u2 = r1_w8_y3 + r1_w8_n2;

    /* khepera.bg:17: r1_w8: stage 2 */
    const real r1_w8_y2 = x->r1_w8_s2 + c->b * r1_w8_u2;

    /* khepera.bg:17: r1_w8: stage 2: memory */
    x->r1_w8_s2 = c->a * r1_w8_y2 + c->b * r1_w8_u2;

    /* khepera.bg:17: r1_w8: input of stage 1 */
    const real r1_w8_u1 = r1_w8_y2;

    /* khepera.bg:17: r1_w8: stage 1 */
    const real r1_w8_y1 = x->r1_w8_s1 + c->b * r1_w8_u1;

    /* khepera.bg:17: r1_w8: stage 1: memory */
    x->r1_w8_s1 = c->a * r1_w8_y1 + c->b * r1_w8_u1;

    /* khepera.bg:17: r1: what the tolerances of m[1].Js and m[1].el.Re can do together */
    const real r1_w8 = r1_w8_y1;

    /* khepera.bg:17: filtered speed of m[1].motor */
    const real r1_w9_m__1__motor_speed_2 = c->a * x->r1_w9_m__1__motor_speed
        + c->m__1__motor_gain * (real)e->m__1__motor.increment;
    x->r1_w9_m__1__motor_speed = r1_w9_m__1__motor_speed_2;

    /* khepera.bg:17: r1_w9: encoders, order 2 */
    const real r1_w9_n2 = c->r1_w9_w2_m__1__motor * r1_w9_m__1__motor_speed_2;

    /* khepera.bg:17: r1_w9: error of order 2 */
    const real r1_w9_e2 = c->bend1 * r1_w9_n2;

    /* khepera.bg:17: r1_w9: encoders, order 3 */
    const real r1_w9_n3 = c->r1_w9_w3_m__1__motor * r1_w9_m__1__motor_speed_2;

    /* khepera.bg:17: r1_w9: degree 2 */
    const real r1_w9_d2 = r1_w9_n2 + r1_w9_n3;

    /* khepera.bg:17: r1_w9: degree 3 */
    const real r1_w9_d3 = r1_w9_n3 - r1_w9_e2;

    /* khepera.bg:17: r1_w9: input of stage 4 */
    const real r1_w9_u4 = r1_w9_d2 - r1_w9_n2 - r1_w9_d3 - r1_w9_e2;

    /* khepera.bg:17: r1_w9: stage 4 */
    const real r1_w9_y4 = x->r1_w9_s4 + c->b * r1_w9_u4;

    /* khepera.bg:17: r1_w9: stage 4: memory */
    x->r1_w9_s4 = c->a * r1_w9_y4 + c->b * r1_w9_u4;

    /* khepera.bg:17: r1_w9: input of stage 3 */
    const real r1_w9_u3 = r1_w9_y4 + r1_w9_n2 + REAL(3.0) * r1_w9_d3 + REAL(4.0) * r1_w9_e2
        - REAL(2.0) * r1_w9_d2;

    /* khepera.bg:17: r1_w9: stage 3 */
    const real r1_w9_y3 = x->r1_w9_s3 + c->b * r1_w9_u3;

    /* khepera.bg:17: r1_w9: stage 3: memory */
    x->r1_w9_s3 = c->a * r1_w9_y3 + c->b * r1_w9_u3;

    /* khepera.bg:17: r1_w9: input of stage 2 */
    const real r1_w9_u2 = r1_w9_y3 + r1_w9_d2 - REAL(3.0) * r1_w9_d3 - REAL(6.0) * r1_w9_e2;

    /* khepera.bg:17: r1_w9: stage 2 */
    const real r1_w9_y2 = x->r1_w9_s2 + c->b * r1_w9_u2;

    /* khepera.bg:17: r1_w9: stage 2: memory */
    x->r1_w9_s2 = c->a * r1_w9_y2 + c->b * r1_w9_u2;

    /* khepera.bg:17: r1_w9: input of stage 1 */
    const real r1_w9_u1 = r1_w9_y2 + r1_w9_d3 + REAL(4.0) * r1_w9_e2;

    /* khepera.bg:17: r1_w9: stage 1 */
    const real r1_w9_y1 = x->r1_w9_s1 + c->b * r1_w9_u1;

    /* khepera.bg:17: r1_w9: stage 1: memory */
    x->r1_w9_s1 = c->a * r1_w9_y1 + c->b * r1_w9_u1;

    /* khepera.bg:17: r1: what the tolerances of m[1].Js and m[1].el.k can do together */
    const real r1_w9 = r1_w9_y1 - r1_w9_e2;

    /* khepera.bg:17: filtered speed of m[1].motor */
    const real r1_w10_m__1__motor_speed_2 = c->a * x->r1_w10_m__1__motor_speed
        + c->m__1__motor_gain * (real)e->m__1__motor.increment;
    x->r1_w10_m__1__motor_speed = r1_w10_m__1__motor_speed_2;

    /* khepera.bg:17: r1_w10: encoders, order 1 */
    const real r1_w10_n1 = -c->r1_w10_w1_m__1__motor * r1_w10_m__1__motor_speed_2;

    /* khepera.bg:17: r1_w10: input of stage 4 */
    const real r1_w10_u4 = r1_w10_n1 - r1_w10_n1;

    /* khepera.bg:17: r1_w10: stage 4 */
    const real r1_w10_y4 = x->r1_w10_s4 + c->b * r1_w10_u4;

    /* khepera.bg:17: r1_w10: stage 4: memory */
    x->r1_w10_s4 = c->a * r1_w10_y4 + c->b * r1_w10_u4;

    /* khepera.bg:17: r1_w10: input of stage 3 */
    const real r1_w10_u3 = r1_w10_y4 + r1_w10_n1;

    /* khepera.bg:17: r1_w10: stage 3 */
    const real r1_w10_y3 = x->r1_w10_s3 + c->b * r1_w10_u3;

    /* khepera.bg:17: r1_w10: stage 3: memory */
    x->r1_w10_s3 = c->a * r1_w10_y3 + c->b * r1_w10_u3;

    /* khepera.bg:17: r1_w10: input of stage 2 */
    const real r1_w10_u2 = r1_w10_y3;

    /* khepera.bg:17: r1_w10: stage 2 */
    const real r1_w10_y2 = x->r1_w10_s2 + c->b * r1_w10_u2;

    /* khepera.bg:17: r1_w10: stage 2: memory */
    x->r1_w10_s2 = c->a * r1_w10_y2 + c->b * r1_w10_u2;

    /* khepera.bg:17: r1_w10: input of stage 1 */
    const real r1_w10_u1 = r1_w10_y2;

    /* khepera.bg:17: r1_w10: stage 1 */
    const real r1_w10_y1 = x->r1_w10_s1 + c->b * r1_w10_u1;

    /* khepera.bg:17: r1_w10: stage 1: memory */
    x->r1_w10_s1 = c->a * r1_w10_y1 + c->b * r1_w10_u1;

    /* khepera.bg:17: r1: what the tolerances of m[1].fs and m[1].el.Re can do together */
    const real r1_w10 = r1_w10_y1;

    /* khepera.bg:17: filtered speed of m[1].motor */
    const real r1_w11_m__1__motor_speed_2 = c->a * x->r1_w11_m__1__motor_speed
        + c->m__1__motor_gain * (real)e->m__1__motor.increment;
    x->r1_w11_m__1__motor_speed = r1_w11_m__1__motor_speed_2;

    /* khepera.bg:17: r1_w11: encoders, order 1 */
    const real r1_w11_n1 = c->r1_w11_w1_m__1__motor * r1_w11_m__1__motor_speed_2;

    /* khepera.bg:17: r1_w11: error of order 1 */
    const real r1_w11_e1 = c->bend1 * r1_w11_n1;

    /* khepera.bg:17: r1_w11: encoders, order 2 */
    const real r1_w11_n2 = c->r1_w11_w2_m__1__motor * r1_w11_m__1__motor_speed_2;

    /* khepera.bg:17: r1_w11: degree 1 */
    const real r1_w11_d1 = r1_w11_n1 + r1_w11_n2;

    /* khepera.bg:17: r1_w11: degree 2 */
    const real r1_w11_d2 = r1_w11_n2 - r1_w11_e1;

    /* khepera.bg:17: r1_w11: input of stage 4 */
    const real r1_w11_u4 = r1_w11_n1 + r1_w11_d2 + r1_w11_e1 - r1_w11_d1;

    /* khepera.bg:17: r1_w11: stage 4 */
    const real r1_w11_y4 = x->r1_w11_s4 + c->b * r1_w11_u4;

    /* khepera.bg:17: r1_w11: stage 4: memory */
    x->r1_w11_s4 = c->a * r1_w11_y4 + c->b * r1_w11_u4;

    /* khepera.bg:17: r1_w11: input of stage 3 */
    const real r1_w11_u3 = r1_w11_y4 + r1_w11_d1 - REAL(2.0) * r1_w11_d2 - REAL(3.0) * r1_w11_e1;

    /* khepera.bg:17: r1_w11: stage 3 */
    const real r1_w11_y3 = x->r1_w11_s3 + c->b * r1_w11_u3;

    /* khepera.bg:17: r1_w11: stage 3: memory */
    x->r1_w11_s3 = c->a * r1_w11_y3 + c->b * r1_w11_u3;

    /* khepera.bg:17: r1_w11: input of stage 2 */
    const real r1_w11_u2 = r1_w11_y3 + r1_w11_d2 + REAL(3.0) * r1_w11_e1;

    /* khepera.bg:17: r1_w11: stage 2 */
    const real r1_w11_y2 = x->r1_w11_s2 + c->b * r1_w11_u2;

    /* khepera.bg:17: r1_w11: stage 2: memory */
    x->r1_w11_s2 = c->a * r1_w11_y2 + c->b * r1_w11_u2;

    /* khepera.bg:17: r1_w11: input of stage 1 */
    const real r1_w11_u1 = r1_w11_y2 - r1_w11_e1;

    /* khepera.bg:17: r1_w11: stage 1 */
    const real r1_w11_y1 = x->r1_w11_s1 + c->b * r1_w11_u1;

    /* khepera.bg:17: r1_w11: stage 1: memory */
    x->r1_w11_s1 = c->a * r1_w11_y1 + c->b * r1_w11_u1;

    /* khepera.bg:17: r1: what the tolerances of m[1].fs and m[1].el.k can do together */
    const real r1_w11 = r1_w11_y1;

    /* khepera.bg:17: filtered speed of m[1].motor */
    const real r1_w12_m__1__motor_speed_2 = c->a * x->r1_w12_m__1__motor_speed
        + c->m__1__motor_gain * (real)e->m__1__motor.increment;
    x->r1_w12_m__1__motor_speed = r1_w12_m__1__motor_speed_2;

    /* khepera.bg:17: r1_w12: encoders, order 1 */
    const real r1_w12_n1 = c->r1_w12_w1_m__1__motor * r1_w12_m__1__motor_speed_2;

    /* khepera.bg:17: r1_w12: error of order 1 */
    const real r1_w12_e1 = c->bend1 * r1_w12_n1;

    /* khepera.bg:17: r1_w12: encoders, order 2 */
    const real r1_w12_n2 = c->r1_w12_w2_m__1__motor * r1_w12_m__1__motor_speed_2;

    /* khepera.bg:17: r1_w12: terms of order 0 */
    const real r1_w12_g0 = c->r1_w12_Fx__1 * s->Fx__1;

    /* khepera.bg:17: r1_w12: degree 1 */
    const real r1_w12_d1 = r1_w12_n1 + r1_w12_n2;

    /* khepera.bg:17: r1_w12: error of order 0 */
    const real r1_w12_e0 = c->bend2 * r1_w12_g0;

    /* khepera.bg:17: r1_w12: degree 2 */
    const real r1_w12_d2 = r1_w12_n2 - r1_w12_e1 - r1_w12_e0;

    /* khepera.bg:17: r1_w12: input of stage 4 */
    const real r1_w12_u4 = r1_w12_g0 + r1_w12_n1 + r1_w12_d2 + r1_w12_e1 - r1_w12_d1;

    /* khepera.bg:17: r1_w12: stage 4 */
    const real r1_w12_y4 = x->r1_w12_s4 + c->b * r1_w12_u4;

    /* khepera.bg:17: r1_w12: stage 4: memory */
    x->r1_w12_s4 = c->a * r1_w12_y4 + c->b * r1_w12_u4;

    /* khepera.bg:17: r1_w12: input of stage 3 */
    const real r1_w12_u3 = r1_w12_y4 + r1_w12_d1 - REAL(2.0) * r1_w12_d2 - REAL(3.0) * r1_w12_e1;

    /* khepera.bg:17: r1_w12: stage 3 */
    const real r1_w12_y3 = x->r1_w12_s3 + c->b * r1_w12_u3;

    /* khepera.bg:17: r1_w12: stage 3: memory */
    x->r1_w12_s3 = c->a * r1_w12_y3 + c->b * r1_w12_u3;

    /* khepera.bg:17: r1_w12: input of stage 2 */
    const real r1_w12_u2 = r1_w12_y3 + r1_w12_d2 + REAL(3.0) * r1_w12_e1;

    /* khepera.bg:17: r1_w12: stage 2 */
    const real r1_w12_y2 = x->r1_w12_s2 + c->b * r1_w12_u2;

    /* khepera.bg:17: r1_w12: stage 2: memory */
    x->r1_w12_s2 = c->a * r1_w12_y2 + c->b * r1_w12_u2;

    /* khepera.bg:17: r1_w12: input of stage 1 */
    const real r1_w12_u1 = r1_w12_y2 - r1_w12_e1;

    /* khepera.bg:17: r1_w12: stage 1 */
    const real r1_w12_y1 = x->r1_w12_s1 + c->b * r1_w12_u1;

    /* khepera.bg:17: r1_w12: stage 1: memory */
    x->r1_w12_s1 = c->a * r1_w12_y1 + c->b * r1_w12_u1;

    /* khepera.bg:17: r1: what the tolerances of m[1].el.Re and m[1].el.k can do together */
    const real r1_w12 = r1_w12_y1;

    /* khepera.bg:17: filtered speed of m[1].motor */
    const real r1_w13_m__1__motor_speed_2 = c->a * x->r1_w13_m__1__motor_speed
        + c->m__1__motor_gain * (real)e->m__1__motor.increment;
    x->r1_w13_m__1__motor_speed = r1_w13_m__1__motor_speed_2;

    /* khepera.bg:17: r1_w13: encoders, order 1 */
    const real r1_w13_n1 = -c->r1_w13_w1_m__1__motor * r1_w13_m__1__motor_speed_2;

    /* khepera.bg:17: r1_w13: error of order 1 */
    const real r1_w13_e1 = c->bend2 * r1_w13_n1;

    /* khepera.bg:17: r1_w13: encoders, order 2 */
    const real r1_w13_n2 = c->r1_w13_w2_m__1__motor * r1_w13_m__1__motor_speed_2;

    /* khepera.bg:17: r1_w13: error of order 2 */
    const real r1_w13_e2 = c->bend1 * r1_w13_n2;

    /* khepera.bg:17: r1_w13: encoders, order 3 */
    const real r1_w13_n3 = -c->r1_w13_w3_m__1__motor * r1_w13_m__1__motor_speed_2;

    /* khepera.bg:17: r1_w13: terms of order 0 */
    const real r1_w13_g0 = -c->r1_w13_Fx__1 * s->Fx__1;

    /* khepera.bg:17: r1_w13: terms of order 1 */
    const real r1_w13_g1 = -c->r1_w13_w1_Fx__1 * s->Fx__1;

    /* khepera.bg:17: r1_w13: degree 1 */
    const real r1_w13_d1 = r1_w13_g1 + r1_w13_n1 + r1_w13_n2;

    /* khepera.bg:17: r1_w13: error of order 0 */
    const real r1_w13_e0 = c->bend3 * r1_w13_g0;

    /* khepera.bg:17: r1_w13: degree 2 */
    const real r1_w13_d2 = r1_w13_n2 + r1_w13_n3 - r1_w13_e1 - r1_w13_e0;

    /* khepera.bg:17: r1_w13: error of order 1 */
    const real r1_w13_e1_2 = c->bend2 * r1_w13_g1;

    /* khepera.bg:17: r1_w13: degree 3 */
    const real r1_w13_d3 = r1_w13_n3 - r1_w13_e1 - r1_w13_e2 - r1_w13_e1_2;

    /* khepera.bg:17: r1_w13: input of stage 4 */
    const real r1_w13_u4 = r1_w13_g0 + r1_w13_n1 + r1_w13_d2 - r1_w13_d1 - r1_w13_d3 - r1_w13_e2;

    /* khepera.bg:17: r1_w13: stage 4 */
    const real r1_w13_y4 = x->r1_w13_s4 + c->b * r1_w13_u4;

    /* khepera.bg:17: r1_w13: stage 4: memory */
    x->r1_w13_s4 = c->a * r1_w13_y4 + c->b * r1_w13_u4;

    /* khepera.bg:17: r1_w13: input of stage 3 */
    const real r1_w13_u3 = r1_w13_y4 + r1_w13_d1 + REAL(3.0) * r1_w13_d3 + REAL(4.0) * r1_w13_e2
        - REAL(2.0) * r1_w13_d2;

    /* khepera.bg:17: r1_w13: stage 3 */
    const real r1_w13_y3 = x->r1_w13_s3 + c->b * r1_w13_u3;

    /* khepera.bg:17: r1_w13: stage 3: memory */
    x->r1_w13_s3 = c->a * r1_w13_y3 + c->b * r1_w13_u3;

    /* khepera.bg:17: r1_w13: input of stage 2 */
    const real r1_w13_u2 = r1_w13_y3 + r1_w13_d2 - REAL(3.0) * r1_w13_d3 - REAL(6.0) * r1_w13_e2;

    /* khepera.bg:17: r1_w13: stage 2 */
    const real r1_w13_y2 = x->r1_w13_s2 + c->b * r1_w13_u2;

    /* khepera.bg:17: r1_w13: stage 2: memory */
    x->r1_w13_s2 = c->a * r1_w13_y2 + c->b * r1_w13_u2;

    /* khepera.bg:17: r1_w13: input of stage 1 */
    const real r1_w13_u1 = r1_w13_y2 + r1_w13_d3 + REAL(4.0) * r1_w13_e2;

    /* khepera.bg:17: r1_w13: stage 1 */
    const real r1_w13_y1 = x->r1_w13_s1 + c->b * r1_w13_u1;

    /* khepera.bg:17: r1_w13: stage 1: memory */
    x->r1_w13_s1 = c->a * r1_w13_y1 + c->b * r1_w13_u1;

    /* khepera.bg:17: r1: second order of what the tolerance of m[1].el.k can do */
    const real r1_w13 = r1_w13_y1 - r1_w13_e2;

    /* khepera.bg:17: r1: how far r1 can be from zero if no parameter is out of tolerance */
    r[KHEPERA_BUILT_THRESHOLD_R1] = MATH(fabs)(r1_w1) + MATH(fabs)(r1_w2) + MATH(fabs)(r1_w3)
        + MATH(fabs)(r1_w4) + MATH(fabs)(r1_w5) + MATH(fabs)(r1_w6) + MATH(fabs)(r1_w7)
        + MATH(fabs)(r1_w8) + MATH(fabs)(r1_w9) + MATH(fabs)(r1_w10) + MATH(fabs)(r1_w11)
        + MATH(fabs)(r1_w12) + MATH(fabs)(r1_w13);
}

/* One sample for r1; a number that is not finite makes the next sample the first. */
static void run_r1(
    khepera_built_threshold_monitor *monitor, const khepera_built_threshold_samples *s, khepera_built_threshold_residuals *residuals)
{
    real *r = residuals->value;
    uint32_t age = monitor->age[0];

    if (age == 0u) {
        start_r1(monitor, s, r);
    } else {
        next_r1(monitor, s, r);
    }
    /* a sum is finite only if all its terms are */
    if (finite_number(s->Fx__1 + r[KHEPERA_BUILT_THRESHOLD_R1])) {
        age += age < UINT32_MAX ? 1u : 0u;
    } else {
        age = 0u;
        r[KHEPERA_BUILT_THRESHOLD_R1] = REAL(0.0);
    }
    monitor->age[0] = age;
    residuals->valid[KHEPERA_BUILT_THRESHOLD_R1] = age > monitor->settle[KHEPERA_BUILT_THRESHOLD_R1];
}

/* r2 on its first sample: the filter as if it had always been so. */
static void start_r2(
    khepera_built_threshold_monitor *monitor, const khepera_built_threshold_samples *s, real *r)
{
    const khepera_built_threshold_coefficients *c = &monitor->c;
    khepera_built_threshold_memory *x = &monitor->x;

    count_from(&monitor->e.m__2__motor, s->m__2__motor);

    /* khepera.bg:17: filtered speed of m[2].motor, at rest */
    const real r2_w1_m__2__motor_speed_2 = REAL(0.0);

    /* khepera.bg:17: filtered speed of m[2].motor */
    x->r2_w1_m__2__motor_speed = r2_w1_m__2__motor_speed_2;

    /* khepera.bg:17: r2_w1: encoders, order 1 */
    const real r2_w1_n1 = -c->r2_w1_w1_m__2__motor * r2_w1_m__2__motor_speed_2;

    /* khepera.bg:17: r2_w1: error of order 1 */
    const real r2_w1_e1 = c->bend1 * r2_w1_n1;

    /* khepera.bg:17: r2_w1: encoders, order 2 */
    const real r2_w1_n2 = -c->r2_w1_w2_m__2__motor * r2_w1_m__2__motor_speed_2;

    /* khepera.bg:17: r2_w1: degree 1 */
    const real r2_w1_d1 = r2_w1_n1 + r2_w1_n2;

    /* khepera.bg:17: r2_w1: degree 2 */
    const real r2_w1_d2 = r2_w1_n2 - r2_w1_e1;

    /* khepera.bg:17: r2_w1: input of stage 4 */
    const real r2_w1_u4 = r2_w1_n1 + r2_w1_d2 + r2_w1_e1 - r2_w1_d1;

    /* khepera.bg:17: r2_w1: stage 4, at rest */
    const real r2_w1_y4 = r2_w1_u4;

    /* khepera.bg:17: r2_w1: stage 4: memory */
    x->r2_w1_s4 = c->rest * r2_w1_u4;

    /* khepera.bg:17: r2_w1: input of stage 3 */
    const real r2_w1_u3 = r2_w1_y4 + r2_w1_d1 - REAL(2.0) * r2_w1_d2 - REAL(3.0) * r2_w1_e1;

    /* khepera.bg:17: r2_w1: stage 3, at rest */
    const real r2_w1_y3 = r2_w1_u3;

    /* khepera.bg:17: r2_w1: stage 3: memory */
    x->r2_w1_s3 = c->rest * r2_w1_u3;

    /* khepera.bg:17: r2_w1: input of stage 2 */
    const real r2_w1_u2 = r2_w1_y3 + r2_w1_d2 + REAL(3.0) * r2_w1_e1;

    /* khepera.bg:17: r2_w1: stage 2, at rest */
    const real r2_w1_y2 = r2_w1_u2;

    /* khepera.bg:17: r2_w1: stage 2: memory */
    x->r2_w1_s2 = c->rest * r2_w1_u2;

    /* khepera.bg:17: r2_w1: input of stage 1 */
    const real r2_w1_u1 = r2_w1_y2 - r2_w1_e1;

    /* khepera.bg:17: r2_w1: stage 1, at rest */
    const real r2_w1_y1 = r2_w1_u1;

    /* khepera.bg:17: r2_w1: stage 1: memory */
    x->r2_w1_s1 = c->rest * r2_w1_u1;

    /* khepera.bg:17: r2: what the tolerance of m[2].fe can do */
    const real r2_w1 = r2_w1_y1;

    /* khepera.bg:17: filtered speed of m[2].motor, at rest */
    const real r2_w2_m__2__motor_speed_2 = REAL(0.0);

    /* khepera.bg:17: filtered speed of m[2].motor */
    x->r2_w2_m__2__motor_speed = r2_w2_m__2__motor_speed_2;

    /* khepera.bg:17: r2_w2: encoders, order 2 */
    const real r2_w2_n2 = -c->r2_w2_w2_m__2__motor * r2_w2_m__2__motor_speed_2;

    /* khepera.bg:17: r2_w2: error of order 2 */
    const real r2_w2_e2 = c->bend1 * r2_w2_n2;

    /* khepera.bg:17: r2_w2: encoders, order 3 */
    const real r2_w2_n3 = -c->r2_w2_w3_m__2__motor * r2_w2_m__2__motor_speed_2;

    /* khepera.bg:17: r2_w2: degree 2 */
    const real r2_w2_d2 = r2_w2_n2 + r2_w2_n3;

    /* khepera.bg:17: r2_w2: degree 3 */
    const real r2_w2_d3 = r2_w2_n3 - r2_w2_e2;

    /* khepera.bg:17: r2_w2: input of stage 4 */
    const real r2_w2_u4 = r2_w2_d2 - r2_w2_n2 - r2_w2_d3 - r2_w2_e2;

    /* khepera.bg:17: r2_w2: stage 4, at rest */
    const real r2_w2_y4 = r2_w2_u4;

    /* khepera.bg:17: r2_w2: stage 4: memory */
    x->r2_w2_s4 = c->rest * r2_w2_u4;

    /* khepera.bg:17: r2_w2: input of stage 3 */
    const real r2_w2_u3 = r2_w2_y4 + r2_w2_n2 + REAL(3.0) * r2_w2_d3 + REAL(4.0) * r2_w2_e2
        - REAL(2.0) * r2_w2_d2;

    /* khepera.bg:17: r2_w2: stage 3, at rest */
    const real r2_w2_y3 = r2_w2_u3;

    /* khepera.bg:17: r2_w2: stage 3: memory */
    x->r2_w2_s3 = c->rest * r2_w2_u3;

    /* khepera.bg:17: r2_w2: input of stage 2 */
    const real r2_w2_u2 = r2_w2_y3 + r2_w2_d2 - REAL(3.0) * r2_w2_d3 - REAL(6.0) * r2_w2_e2;

    /* khepera.bg:17: r2_w2: stage 2, at rest */
    const real r2_w2_y2 = r2_w2_u2;

    /* khepera.bg:17: r2_w2: stage 2: memory */
    x->r2_w2_s2 = c->rest * r2_w2_u2;

    /* khepera.bg:17: r2_w2: input of stage 1 */
    const real r2_w2_u1 = r2_w2_y2 + r2_w2_d3 + REAL(4.0) * r2_w2_e2;

    /* khepera.bg:17: r2_w2: stage 1, at rest */
    const real r2_w2_y1 = r2_w2_u1;

    /* khepera.bg:17: r2_w2: stage 1: memory */
    x->r2_w2_s1 = c->rest * r2_w2_u1;

    /* khepera.bg:17: r2: what the tolerance of m[2].Js can do */
    const real r2_w2 = r2_w2_y1 - r2_w2_e2;

    /* khepera.bg:17: filtered speed of m[2].motor, at rest */
    const real r2_w3_m__2__motor_speed_2 = REAL(0.0);

    /* khepera.bg:17: filtered speed of m[2].motor */
    x->r2_w3_m__2__motor_speed = r2_w3_m__2__motor_speed_2;

    /* khepera.bg:17: r2_w3: encoders, order 1 */
    const real r2_w3_n1 = -c->r2_w3_w1_m__2__motor * r2_w3_m__2__motor_speed_2;

    /* khepera.bg:17: r2_w3: error of order 1 */
    const real r2_w3_e1 = c->bend1 * r2_w3_n1;

    /* khepera.bg:17: r2_w3: encoders, order 2 */
    const real r2_w3_n2 = -c->r2_w3_w2_m__2__motor * r2_w3_m__2__motor_speed_2;

    /* khepera.bg:17: r2_w3: degree 1 */
    const real r2_w3_d1 = r2_w3_n1 + r2_w3_n2;

    /* khepera.bg:17: r2_w3: degree 2 */
    const real r2_w3_d2 = r2_w3_n2 - r2_w3_e1;

    /* khepera.bg:17: r2_w3: input of stage 4 */
    const real r2_w3_u4 = r2_w3_n1 + r2_w3_d2 + r2_w3_e1 - r2_w3_d1;

    /* khepera.bg:17: r2_w3: stage 4, at rest */
    const real r2_w3_y4 = r2_w3_u4;

    /* khepera.bg:17: r2_w3: stage 4: memory */
    x->r2_w3_s4 = c->rest * r2_w3_u4;

    /* khepera.bg:17: r2_w3: input of stage 3 */
    const real r2_w3_u3 = r2_w3_y4 + r2_w3_d1 - REAL(2.0) * r2_w3_d2 - REAL(3.0) * r2_w3_e1;

    /* khepera.bg:17: r2_w3: stage 3, at rest */
    const real r2_w3_y3 = r2_w3_u3;

    /* khepera.bg:17: r2_w3: stage 3: memory */
    x->r2_w3_s3 = c->rest * r2_w3_u3;

    /* khepera.bg:17: r2_w3: input of stage 2 */
    const real r2_w3_u2 = r2_w3_y3 + r2_w3_d2 + REAL(3.0) * r2_w3_e1;

    /* khepera.bg:17: r2_w3: stage 2, at rest */
    const real r2_w3_y2 = r2_w3_u2;

    /* khepera.bg:17: r2_w3: stage 2: memory */
    x->r2_w3_s2 = c->rest * r2_w3_u2;

    /* khepera.bg:17: r2_w3: input of stage 1 */
    const real r2_w3_u1 = r2_w3_y2 - r2_w3_e1;

    /* khepera.bg:17: r2_w3: stage 1, at rest */
    const real r2_w3_y1 = r2_w3_u1;

    /* khepera.bg:17: r2_w3: stage 1: memory */
    x->r2_w3_s1 = c->rest * r2_w3_u1;

    /* khepera.bg:17: r2: what the tolerance of m[2].fs can do */
    const real r2_w3 = r2_w3_y1;

    /* khepera.bg:17: filtered speed of m[2].motor, at rest */
    const real r2_w4_m__2__motor_speed_2 = REAL(0.0);

    /* khepera.bg:17: filtered speed of m[2].motor */
    x->r2_w4_m__2__motor_speed = r2_w4_m__2__motor_speed_2;

    /* khepera.bg:17: r2_w4: encoders, order 1 */
    const real r2_w4_n1 = -c->r2_w4_w1_m__2__motor * r2_w4_m__2__motor_speed_2;

    /* khepera.bg:17: r2_w4: error of order 1 */
    const real r2_w4_e1 = c->bend1 * r2_w4_n1;

    /* khepera.bg:17: r2_w4: encoders, order 2 */
    const real r2_w4_n2 = -c->r2_w4_w2_m__2__motor * r2_w4_m__2__motor_speed_2;

    /* khepera.bg:17: r2_w4: terms of order 0 */
    const real r2_w4_g0 = -c->r2_w4_Fx__2 * s->Fx__2;

    /* khepera.bg:17: r2_w4: degree 1 */
    const real r2_w4_d1 = r2_w4_n1 + r2_w4_n2;

    /* khepera.bg:17: r2_w4: error of order 0 */
    const real r2_w4_e0 = c->bend2 * r2_w4_g0;

    /* khepera.bg:17: r2_w4: degree 2 */
    const real r2_w4_d2 = r2_w4_n2 - r2_w4_e1 - r2_w4_e0;

    /* khepera.bg:17: r2_w4: input of stage 4 */
    const real r2_w4_u4 = r2_w4_g0 + r2_w4_n1 + r2_w4_d2 + r2_w4_e1 - r2_w4_d1;

    /* khepera.bg:17: r2_w4: stage 4, at rest */
    const real r2_w4_y4 = r2_w4_u4;

    /* khepera.bg:17: r2_w4: stage 4: memory */
    x->r2_w4_s4 = c->rest * r2_w4_u4;

    /* khepera.bg:17: r2_w4: input of stage 3 */
    const real r2_w4_u3 = r2_w4_y4 + r2_w4_d1 - REAL(2.0) * r2_w4_d2 - REAL(3.0) * r2_w4_e1;

    /* khepera.bg:17: r2_w4: stage 3, at rest */
    const real r2_w4_y3 = r2_w4_u3;

    /* khepera.bg:17: r2_w4: stage 3: memory */
    x->r2_w4_s3 = c->rest * r2_w4_u3;

    /* khepera.bg:17: r2_w4: input of stage 2 */
    const real r2_w4_u2 = r2_w4_y3 + r2_w4_d2 + REAL(3.0) * r2_w4_e1;

    /* khepera.bg:17: r2_w4: stage 2, at rest */
    const real r2_w4_y2 = r2_w4_u2;

    /* khepera.bg:17: r2_w4: stage 2: memory */
    x->r2_w4_s2 = c->rest * r2_w4_u2;

    /* khepera.bg:17: r2_w4: input of stage 1 */
    const real r2_w4_u1 = r2_w4_y2 - r2_w4_e1;

    /* khepera.bg:17: r2_w4: stage 1, at rest */
    const real r2_w4_y1 = r2_w4_u1;

    /* khepera.bg:17: r2_w4: stage 1: memory */
    x->r2_w4_s1 = c->rest * r2_w4_u1;

    /* khepera.bg:17: r2: what the tolerance of m[2].el.Re can do */
    const real r2_w4 = r2_w4_y1;

    /* khepera.bg:17: filtered speed of m[2].motor, at rest */
    const real r2_w5_m__2__motor_speed_2 = REAL(0.0);

    /* khepera.bg:17: filtered speed of m[2].motor */
    x->r2_w5_m__2__motor_speed = r2_w5_m__2__motor_speed_2;

    /* khepera.bg:17: r2_w5: encoders, order 1 */
    const real r2_w5_n1 = c->r2_w5_w1_m__2__motor * r2_w5_m__2__motor_speed_2;

    /* khepera.bg:17: r2_w5: error of order 1 */
    const real r2_w5_e1 = c->bend2 * r2_w5_n1;

    /* khepera.bg:17: r2_w5: encoders, order 2 */
    const real r2_w5_n2 = c->r2_w5_w2_m__2__motor * r2_w5_m__2__motor_speed_2;

    /* khepera.bg:17: r2_w5: error of order 2 */
    const real r2_w5_e2 = c->bend1 * r2_w5_n2;

    /* khepera.bg:17: r2_w5: encoders, order 3 */
    const real r2_w5_n3 = c->r2_w5_w3_m__2__motor * r2_w5_m__2__motor_speed_2;

    /* khepera.bg:17: r2_w5: terms of order 0 */
    const real r2_w5_g0 = c->r2_w5_Fx__2 * s->Fx__2;

    /* khepera.bg:17: r2_w5: terms of order 1 */
    const real r2_w5_g1 = c->r2_w5_w1_Fx__2 * s->Fx__2;

    /* khepera.bg:17: r2_w5: degree 1 */
    const real r2_w5_d1 = r2_w5_g1 + r2_w5_n1 + r2_w5_n2;

    /* khepera.bg:17: r2_w5: error of order 0 */
    const real r2_w5_e0 = c->bend3 * r2_w5_g0;

    /* khepera.bg:17: r2_w5: degree 2 */
    const real r2_w5_d2 = r2_w5_n2 + r2_w5_n3 - r2_w5_e1 - r2_w5_e0;

    /* khepera.bg:17: r2_w5: error of order 1 */
    const real r2_w5_e1_2 = c->bend2 * r2_w5_g1;

    /* khepera.bg:17: r2_w5: degree 3 */
    const real r2_w5_d3 = r2_w5_n3 - r2_w5_e1 - r2_w5_e2 - r2_w5_e1_2;

    /* khepera.bg:17: r2_w5: input of stage 4 */
    const real r2_w5_u4 = r2_w5_g0 + r2_w5_n1 + r2_w5_d2 - r2_w5_d1 - r2_w5_d3 - r2_w5_e2;

    /* khepera.bg:17: r2_w5: stage 4, at rest */
    const real r2_w5_y4 = r2_w5_u4;

    /* khepera.bg:17: r2_w5: stage 4: memory */
    x->r2_w5_s4 = c->rest * r2_w5_u4;

    /* khepera.bg:17: r2_w5: input of stage 3 */
    const real r2_w5_u3 = r2_w5_y4 + r2_w5_d1 + REAL(3.0) * r2_w5_d3 + REAL(4.0) * r2_w5_e2
        - REAL(2.0) * r2_w5_d2;

    /* khepera.bg:17: r2_w5: stage 3, at rest */
    const real r2_w5_y3 = r2_w5_u3;

    /* khepera.bg:17: r2_w5: stage 3: memory */
    x->r2_w5_s3 = c->rest * r2_w5_u3;

    /* khepera.bg:17: r2_w5: input of stage 2 */
    const real r2_w5_u2 = r2_w5_y3 + r2_w5_d2 - REAL(3.0) * r2_w5_d3 - REAL(6.0) * r2_w5_e2;

    /* khepera.bg:17: r2_w5: stage 2, at rest */
    const real r2_w5_y2 = r2_w5_u2;

    /* khepera.bg:17: r2_w5: stage 2: memory */
    x->r2_w5_s2 = c->rest * r2_w5_u2;

    /* khepera.bg:17: r2_w5: input of stage 1 */
    const real r2_w5_u1 = r2_w5_y2 + r2_w5_d3 + REAL(4.0) * r2_w5_e2;

    /* khepera.bg:17: r2_w5: stage 1, at rest */
    const real r2_w5_y1 = r2_w5_u1;

    /* khepera.bg:17: r2_w5: stage 1: memory */
    x->r2_w5_s1 = c->rest * r2_w5_u1;

    /* khepera.bg:17: r2: what the tolerance of m[2].el.k can do */
    const real r2_w5 = r2_w5_y1 - r2_w5_e2;

    /* khepera.bg:17: filtered speed of m[2].motor, at rest */
    const real r2_w6_m__2__motor_speed_2 = REAL(0.0);

    /* khepera.bg:17: filtered speed of m[2].motor */
    x->r2_w6_m__2__motor_speed = r2_w6_m__2__motor_speed_2;

    /* khepera.bg:17: r2_w6: encoders, order 1 */
    const real r2_w6_n1 = -c->r2_w6_w1_m__2__motor * r2_w6_m__2__motor_speed_2;

    /* khepera.bg:17: r2_w6: input of stage 4 */
    const real r2_w6_u4 = r2_w6_n1 - r2_w6_n1;

    /* khepera.bg:17: r2_w6: stage 4, at rest */
    const real r2_w6_y4 = r2_w6_u4;

    /* khepera.bg:17: r2_w6: stage 4: memory */
    x->r2_w6_s4 = c->rest * r2_w6_u4;

    /* khepera.bg:17: r2_w6: input of stage 3 */
    const real r2_w6_u3 = r2_w6_y4 + r2_w6_n1;

    /* khepera.bg:17: r2_w6: stage 3, at rest */
    const real r2_w6_y3 = r2_w6_u3;

    /* khepera.bg:17: r2_w6: stage 3: memory */
    x->r2_w6_s3 = c->rest * r2_w6_u3;

    /* khepera.bg:17: r2_w6: input of stage 2 */
    const real r2_w6_u2 = r2_w6_y3;

    /* khepera.bg:17: r2_w6: stage 2, at rest */
    const real r2_w6_y2 = r2_w6_u2;

    /* khepera.bg:17: r2_w6: stage 2: memory */
    x->r2_w6_s2 = c->rest * r2_w6_u2;

    /* khepera.bg:17: r2_w6: input of stage 1 */
    const real r2_w6_u1 = r2_w6_y2;

    /* khepera.bg:17: r2_w6: stage 1, at rest */
    const real r2_w6_y1 = r2_w6_u1;

    /* khepera.bg:17: r2_w6: stage 1: memory */
    x->r2_w6_s1 = c->rest * r2_w6_u1;

    /* khepera.bg:17: r2: what the tolerances of m[2].fe and m[2].el.Re can do together */
    const real r2_w6 = r2_w6_y1;

    /* khepera.bg:17: filtered speed of m[2].motor, at rest */
    const real r2_w7_m__2__motor_speed_2 = REAL(0.0);

    /* khepera.bg:17: filtered speed of m[2].motor */
    x->r2_w7_m__2__motor_speed = r2_w7_m__2__motor_speed_2;

    /* khepera.bg:17: r2_w7: encoders, order 1 */
    const real r2_w7_n1 = c->r2_w7_w1_m__2__motor * r2_w7_m__2__motor_speed_2;

    /* khepera.bg:17: r2_w7: error of order 1 */
    const real r2_w7_e1 = c->bend1 * r2_w7_n1;

    /* khepera.bg:17: r2_w7: encoders, order 2 */
    const real r2_w7_n2 = c->r2_w7_w2_m__2__motor * r2_w7_m__2__motor_speed_2;

    /* khepera.bg:17: r2_w7: degree 1 */
    const real r2_w7_d1 = r2_w7_n1 + r2_w7_n2;

    /* khepera.bg:17: r2_w7: degree 2 */
    const real r2_w7_d2 = r2_w7_n2 - r2_w7_e1;

    /* khepera.bg:17: r2_w7: input of stage 4 */
    const real r2_w7_u4 = r2_w7_n1 + r2_w7_d2 + r2_w7_e1 - r2_w7_d1;

    /* khepera.bg:17: r2_w7: stage 4, at rest */
    const real r2_w7_y4 = r2_w7_u4;

    /* khepera.bg:17: r2_w7: stage 4: memory */
    x->r2_w7_s4 = c->rest * r2_w7_u4;

    /* khepera.bg:17: r2_w7: input of stage 3 */
    const real r2_w7_u3 = r2_w7_y4 + r2_w7_d1 - REAL(2.0) * r2_w7_d2 - REAL(3.0) * r2_w7_e1;

    /* khepera.bg:17: r2_w7: stage 3, at rest */
    const real r2_w7_y3 = r2_w7_u3;

    /* khepera.bg:17: r2_w7: stage 3: memory */
    x->r2_w7_s3 = c->rest * r2_w7_u3;

    /* khepera.bg:17: r2_w7: input of stage 2 */
    const real r2_w7_u2 = r2_w7_y3 + r2_w7_d2 + REAL(3.0) * r2_w7_e1;

    /* khepera.bg:17: r2_w7: stage 2, at rest */
    const real r2_w7_y2 = r2_w7_u2;

    /* khepera.bg:17: r2_w7: stage 2: memory */
    x->r2_w7_s2 = c->rest * r2_w7_u2;

    /* khepera.bg:17: r2_w7: input of stage 1 */
    const real r2_w7_u1 = r2_w7_y2 - r2_w7_e1;

    /* khepera.bg:17: r2_w7: stage 1, at rest */
    const real r2_w7_y1 = r2_w7_u1;

    /* khepera.bg:17: r2_w7: stage 1: memory */
    x->r2_w7_s1 = c->rest * r2_w7_u1;

    /* khepera.bg:17: r2: what the tolerances of m[2].fe and m[2].el.k can do together */
    const real r2_w7 = r2_w7_y1;

    /* khepera.bg:17: filtered speed of m[2].motor, at rest */
    const real r2_w8_m__2__motor_speed_2 = REAL(0.0);

    /* khepera.bg:17: filtered speed of m[2].motor */
    x->r2_w8_m__2__motor_speed = r2_w8_m__2__motor_speed_2;

    /* khepera.bg:17: r2_w8: encoders, order 2 */
    const real r2_w8_n2 = -c->r2_w8_w2_m__2__motor * r2_w8_m__2__motor_speed_2;

    /* khepera.bg:17: r2_w8: input of stage 4 */
    const real r2_w8_u4 = r2_w8_n2 - r2_w8_n2;

    /* khepera.bg:17: r2_w8: stage 4, at rest */
    const real r2_w8_y4 = r2_w8_u4;

    /* khepera.bg:17: r2_w8: stage 4: memory */
    x->r2_w8_s4 = c->rest * r2_w8_u4;

    /* khepera.bg:17: r2_w8: input of stage 3 */
    const real r2_w8_u3 = r2_w8_y4 + r2_w8_n2 - REAL(2.0) * r2_w8_n2;

    /* khepera.bg:17: r2_w8: stage 3, at rest */
    const real r2_w8_y3 = r2_w8_u3;

    /* khepera.bg:17: r2_w8: stage 3: memory */
    x->r2_w8_s3 = c->rest * r2_w8_u3;

    /* khepera.bg:17: r2_w8: input of stage 2 */
    const real r2_w8_u2 = r2_w8_y3 + r2_w8_n2;

    /* khepera.bg:17: r2_w8: stage 2, at rest */
    const real r2_w8_y2 = r2_w8_u2;

    /* khepera.bg:17: r2_w8: stage 2: memory */
    x->r2_w8_s2 = c->rest * r2_w8_u2;

    /* khepera.bg:17: r2_w8: input of stage 1 */
    const real r2_w8_u1 = r2_w8_y2;

    /* khepera.bg:17: r2_w8: stage 1, at rest */
    const real r2_w8_y1 = r2_w8_u1;

    /* khepera.bg:17: r2_w8: stage 1: memory */
    x->r2_w8_s1 = c->rest * r2_w8_u1;

    /* khepera.bg:17: r2: what the tolerances of m[2].Js and m[2].el.Re can do together */
    const real r2_w8 = r2_w8_y1;

    /* khepera.bg:17: filtered speed of m[2].motor, at rest */
    const real r2_w9_m__2__motor_speed_2 = REAL(0.0);

    /* khepera.bg:17: filtered speed of m[2].motor */
    x->r2_w9_m__2__motor_speed = r2_w9_m__2__motor_speed_2;

    /* khepera.bg:17: r2_w9: encoders, order 2 */
    const real r2_w9_n2 = c->r2_w9_w2_m__2__motor * r2_w9_m__2__motor_speed_2;

    /* khepera.bg:17: r2_w9: error of order 2 */
    const real r2_w9_e2 = c->bend1 * r2_w9_n2;

    /* khepera.bg:17: r2_w9: encoders, order 3 */
    const real r2_w9_n3 = c->r2_w9_w3_m__2__motor * r2_w9_m__2__motor_speed_2;

    /* khepera.bg:17: r2_w9: degree 2 */
    const real r2_w9_d2 = r2_w9_n2 + r2_w9_n3;

    /* khepera.bg:17: r2_w9: degree 3 */
    const real r2_w9_d3 = r2_w9_n3 - r2_w9_e2;

    /* khepera.bg:17: r2_w9: input of stage 4 */
    const real r2_w9_u4 = r2_w9_d2 - r2_w9_n2 - r2_w9_d3 - r2_w9_e2;

    /* khepera.bg:17: r2_w9: stage 4, at rest */
    const real r2_w9_y4 = r2_w9_u4;

    /* khepera.bg:17: r2_w9: stage 4: memory */
    x->r2_w9_s4 = c->rest * r2_w9_u4;

    /* khepera.bg:17: r2_w9: input of stage 3 */
    const real r2_w9_u3 = r2_w9_y4 + r2_w9_n2 + REAL(3.0) * r2_w9_d3 + REAL(4.0) * r2_w9_e2
        - REAL(2.0) * r2_w9_d2;

    /* khepera.bg:17: r2_w9: stage 3, at rest */
    const real r2_w9_y3 = r2_w9_u3;

    /* khepera.bg:17: r2_w9: stage 3: memory */
    x->r2_w9_s3 = c->rest * r2_w9_u3;

    /* khepera.bg:17: r2_w9: input of stage 2 */
    const real r2_w9_u2 = r2_w9_y3 + r2_w9_d2 - REAL(3.0) * r2_w9_d3 - REAL(6.0) * r2_w9_e2;

    /* khepera.bg:17: r2_w9: stage 2, at rest */
    const real r2_w9_y2 = r2_w9_u2;

    /* khepera.bg:17: r2_w9: stage 2: memory */
    x->r2_w9_s2 = c->rest * r2_w9_u2;

    /* khepera.bg:17: r2_w9: input of stage 1 */
    const real r2_w9_u1 = r2_w9_y2 + r2_w9_d3 + REAL(4.0) * r2_w9_e2;

    /* khepera.bg:17: r2_w9: stage 1, at rest */
    const real r2_w9_y1 = r2_w9_u1;

    /* khepera.bg:17: r2_w9: stage 1: memory */
    x->r2_w9_s1 = c->rest * r2_w9_u1;

    /* khepera.bg:17: r2: what the tolerances of m[2].Js and m[2].el.k can do together */
    const real r2_w9 = r2_w9_y1 - r2_w9_e2;

    /* khepera.bg:17: filtered speed of m[2].motor, at rest */
    const real r2_w10_m__2__motor_speed_2 = REAL(0.0);

    /* khepera.bg:17: filtered speed of m[2].motor */
    x->r2_w10_m__2__motor_speed = r2_w10_m__2__motor_speed_2;

    /* khepera.bg:17: r2_w10: encoders, order 1 */
    const real r2_w10_n1 = -c->r2_w10_w1_m__2__motor * r2_w10_m__2__motor_speed_2;

    /* khepera.bg:17: r2_w10: input of stage 4 */
    const real r2_w10_u4 = r2_w10_n1 - r2_w10_n1;

    /* khepera.bg:17: r2_w10: stage 4, at rest */
    const real r2_w10_y4 = r2_w10_u4;

    /* khepera.bg:17: r2_w10: stage 4: memory */
    x->r2_w10_s4 = c->rest * r2_w10_u4;

    /* khepera.bg:17: r2_w10: input of stage 3 */
    const real r2_w10_u3 = r2_w10_y4 + r2_w10_n1;

    /* khepera.bg:17: r2_w10: stage 3, at rest */
    const real r2_w10_y3 = r2_w10_u3;

    /* khepera.bg:17: r2_w10: stage 3: memory */
    x->r2_w10_s3 = c->rest * r2_w10_u3;

    /* khepera.bg:17: r2_w10: input of stage 2 */
    const real r2_w10_u2 = r2_w10_y3;

    /* khepera.bg:17: r2_w10: stage 2, at rest */
    const real r2_w10_y2 = r2_w10_u2;

    /* khepera.bg:17: r2_w10: stage 2: memory */
    x->r2_w10_s2 = c->rest * r2_w10_u2;

    /* khepera.bg:17: r2_w10: input of stage 1 */
    const real r2_w10_u1 = r2_w10_y2;

    /* khepera.bg:17: r2_w10: stage 1, at rest */
    const real r2_w10_y1 = r2_w10_u1;

    /* khepera.bg:17: r2_w10: stage 1: memory */
    x->r2_w10_s1 = c->rest * r2_w10_u1;

    /* khepera.bg:17: r2: what the tolerances of m[2].fs and m[2].el.Re can do together */
    const real r2_w10 = r2_w10_y1;

    /* khepera.bg:17: filtered speed of m[2].motor, at rest */
    const real r2_w11_m__2__motor_speed_2 = REAL(0.0);

    /* khepera.bg:17: filtered speed of m[2].motor */
    x->r2_w11_m__2__motor_speed = r2_w11_m__2__motor_speed_2;

    /* khepera.bg:17: r2_w11: encoders, order 1 */
    const real r2_w11_n1 = c->r2_w11_w1_m__2__motor * r2_w11_m__2__motor_speed_2;

    /* khepera.bg:17: r2_w11: error of order 1 */
    const real r2_w11_e1 = c->bend1 * r2_w11_n1;

    /* khepera.bg:17: r2_w11: encoders, order 2 */
    const real r2_w11_n2 = c->r2_w11_w2_m__2__motor * r2_w11_m__2__motor_speed_2;

    /* khepera.bg:17: r2_w11: degree 1 */
    const real r2_w11_d1 = r2_w11_n1 + r2_w11_n2;

    /* khepera.bg:17: r2_w11: degree 2 */
    const real r2_w11_d2 = r2_w11_n2 - r2_w11_e1;

    /* khepera.bg:17: r2_w11: input of stage 4 */
    const real r2_w11_u4 = r2_w11_n1 + r2_w11_d2 + r2_w11_e1 - r2_w11_d1;

    /* khepera.bg:17: r2_w11: stage 4, at rest */
    const real r2_w11_y4 = r2_w11_u4;

    /* khepera.bg:17: r2_w11: stage 4: memory */
    x->r2_w11_s4 = c->rest * r2_w11_u4;

    /* khepera.bg:17: r2_w11: input of stage 3 */
    const real r2_w11_u3 = r2_w11_y4 + r2_w11_d1 - REAL(2.0) * r2_w11_d2 - REAL(3.0) * r2_w11_e1;

    /* khepera.bg:17: r2_w11: stage 3, at rest */
    const real r2_w11_y3 = r2_w11_u3;

    /* khepera.bg:17: r2_w11: stage 3: memory */
    x->r2_w11_s3 = c->rest * r2_w11_u3;

    /* khepera.bg:17: r2_w11: input of stage 2 */
    const real r2_w11_u2 = r2_w11_y3 + r2_w11_d2 + REAL(3.0) * r2_w11_e1;

    /* khepera.bg:17: r2_w11: stage 2, at rest */
    const real r2_w11_y2 = r2_w11_u2;

    /* khepera.bg:17: r2_w11: stage 2: memory */
    x->r2_w11_s2 = c->rest * r2_w11_u2;

    /* khepera.bg:17: r2_w11: input of stage 1 */
    const real r2_w11_u1 = r2_w11_y2 - r2_w11_e1;

    /* khepera.bg:17: r2_w11: stage 1, at rest */
    const real r2_w11_y1 = r2_w11_u1;

    /* khepera.bg:17: r2_w11: stage 1: memory */
    x->r2_w11_s1 = c->rest * r2_w11_u1;

    /* khepera.bg:17: r2: what the tolerances of m[2].fs and m[2].el.k can do together */
    const real r2_w11 = r2_w11_y1;

    /* khepera.bg:17: filtered speed of m[2].motor, at rest */
    const real r2_w12_m__2__motor_speed_2 = REAL(0.0);

    /* khepera.bg:17: filtered speed of m[2].motor */
    x->r2_w12_m__2__motor_speed = r2_w12_m__2__motor_speed_2;

    /* khepera.bg:17: r2_w12: encoders, order 1 */
    const real r2_w12_n1 = c->r2_w12_w1_m__2__motor * r2_w12_m__2__motor_speed_2;

    /* khepera.bg:17: r2_w12: error of order 1 */
    const real r2_w12_e1 = c->bend1 * r2_w12_n1;

    /* khepera.bg:17: r2_w12: encoders, order 2 */
    const real r2_w12_n2 = c->r2_w12_w2_m__2__motor * r2_w12_m__2__motor_speed_2;

    /* khepera.bg:17: r2_w12: terms of order 0 */
    const real r2_w12_g0 = c->r2_w12_Fx__2 * s->Fx__2;

    /* khepera.bg:17: r2_w12: degree 1 */
    const real r2_w12_d1 = r2_w12_n1 + r2_w12_n2;

    /* khepera.bg:17: r2_w12: error of order 0 */
    const real r2_w12_e0 = c->bend2 * r2_w12_g0;

    /* khepera.bg:17: r2_w12: degree 2 */
    const real r2_w12_d2 = r2_w12_n2 - r2_w12_e1 - r2_w12_e0;

    /* khepera.bg:17: r2_w12: input of stage 4 */
    const real r2_w12_u4 = r2_w12_g0 + r2_w12_n1 + r2_w12_d2 + r2_w12_e1 - r2_w12_d1;

    /* khepera.bg:17: r2_w12: stage 4, at rest */
    const real r2_w12_y4 = r2_w12_u4;

    /* khepera.bg:17: r2_w12: stage 4: memory */
    x->r2_w12_s4 = c->rest * r2_w12_u4;

    /* khepera.bg:17: r2_w12: input of stage 3 */
    const real r2_w12_u3 = r2_w12_y4 + r2_w12_d1 - REAL(2.0) * r2_w12_d2 - REAL(3.0) * r2_w12_e1;

    /* khepera.bg:17: r2_w12: stage 3, at rest */
    const real r2_w12_y3 = r2_w12_u3;

    /* khepera.bg:17: r2_w12: stage 3: memory */
    x->r2_w12_s3 = c->rest * r2_w12_u3;

    /* khepera.bg:17: r2_w12: input of stage 2 */
    const real r2_w12_u2 = r2_w12_y3 + r2_w12_d2 + REAL(3.0) * r2_w12_e1;

    /* khepera.bg:17: r2_w12: stage 2, at rest */
    const real r2_w12_y2 = r2_w12_u2;

    /* khepera.bg:17: r2_w12: stage 2: memory */
    x->r2_w12_s2 = c->rest * r2_w12_u2;

    /* khepera.bg:17: r2_w12: input of stage 1 */
    const real r2_w12_u1 = r2_w12_y2 - r2_w12_e1;

    /* khepera.bg:17: r2_w12: stage 1, at rest */
    const real r2_w12_y1 = r2_w12_u1;

    /* khepera.bg:17: r2_w12: stage 1: memory */
    x->r2_w12_s1 = c->rest * r2_w12_u1;

    /* khepera.bg:17: r2: what the tolerances of m[2].el.Re and m[2].el.k can do together */
    const real r2_w12 = r2_w12_y1;

    /* khepera.bg:17: filtered speed of m[2].motor, at rest */
    const real r2_w13_m__2__motor_speed_2 = REAL(0.0);

    /* khepera.bg:17: filtered speed of m[2].motor */
    x->r2_w13_m__2__motor_speed = r2_w13_m__2__motor_speed_2;

    /* khepera.bg:17: r2_w13: encoders, order 1 */
    const real r2_w13_n1 = -c->r2_w13_w1_m__2__motor * r2_w13_m__2__motor_speed_2;

    /* khepera.bg:17: r2_w13: error of order 1 */
    const real r2_w13_e1 = c->bend2 * r2_w13_n1;

    /* khepera.bg:17: r2_w13: encoders, order 2 */
    const real r2_w13_n2 = c->r2_w13_w2_m__2__motor * r2_w13_m__2__motor_speed_2;

    /* khepera.bg:17: r2_w13: error of order 2 */
    const real r2_w13_e2 = c->bend1 * r2_w13_n2;

    /* khepera.bg:17: r2_w13: encoders, order 3 */
    const real r2_w13_n3 = -c->r2_w13_w3_m__2__motor * r2_w13_m__2__motor_speed_2;

    /* khepera.bg:17: r2_w13: terms of order 0 */
    const real r2_w13_g0 = -c->r2_w13_Fx__2 * s->Fx__2;

    /* khepera.bg:17: r2_w13: terms of order 1 */
    const real r2_w13_g1 = -c->r2_w13_w1_Fx__2 * s->Fx__2;

    /* khepera.bg:17: r2_w13: degree 1 */
    const real r2_w13_d1 = r2_w13_g1 + r2_w13_n1 + r2_w13_n2;

    /* khepera.bg:17: r2_w13: error of order 0 */
    const real r2_w13_e0 = c->bend3 * r2_w13_g0;

    /* khepera.bg:17: r2_w13: degree 2 */
    const real r2_w13_d2 = r2_w13_n2 + r2_w13_n3 - r2_w13_e1 - r2_w13_e0;

    /* khepera.bg:17: r2_w13: error of order 1 */
    const real r2_w13_e1_2 = c->bend2 * r2_w13_g1;

    /* khepera.bg:17: r2_w13: degree 3 */
    const real r2_w13_d3 = r2_w13_n3 - r2_w13_e1 - r2_w13_e2 - r2_w13_e1_2;

    /* khepera.bg:17: r2_w13: input of stage 4 */
    const real r2_w13_u4 = r2_w13_g0 + r2_w13_n1 + r2_w13_d2 - r2_w13_d1 - r2_w13_d3 - r2_w13_e2;

    /* khepera.bg:17: r2_w13: stage 4, at rest */
    const real r2_w13_y4 = r2_w13_u4;

    /* khepera.bg:17: r2_w13: stage 4: memory */
    x->r2_w13_s4 = c->rest * r2_w13_u4;

    /* khepera.bg:17: r2_w13: input of stage 3 */
    const real r2_w13_u3 = r2_w13_y4 + r2_w13_d1 + REAL(3.0) * r2_w13_d3 + REAL(4.0) * r2_w13_e2
        - REAL(2.0) * r2_w13_d2;

    /* khepera.bg:17: r2_w13: stage 3, at rest */
    const real r2_w13_y3 = r2_w13_u3;

    /* khepera.bg:17: r2_w13: stage 3: memory */
    x->r2_w13_s3 = c->rest * r2_w13_u3;

    /* khepera.bg:17: r2_w13: input of stage 2 */
    const real r2_w13_u2 = r2_w13_y3 + r2_w13_d2 - REAL(3.0) * r2_w13_d3 - REAL(6.0) * r2_w13_e2;

    /* khepera.bg:17: r2_w13: stage 2, at rest */
    const real r2_w13_y2 = r2_w13_u2;

    /* khepera.bg:17: r2_w13: stage 2: memory */
    x->r2_w13_s2 = c->rest * r2_w13_u2;

    /* khepera.bg:17: r2_w13: input of stage 1 */
    const real r2_w13_u1 = r2_w13_y2 + r2_w13_d3 + REAL(4.0) * r2_w13_e2;

    /* khepera.bg:17: r2_w13: stage 1, at rest */
    const real r2_w13_y1 = r2_w13_u1;

    /* khepera.bg:17: r2_w13: stage 1: memory */
    x->r2_w13_s1 = c->rest * r2_w13_u1;

    /* khepera.bg:17: r2: second order of what the tolerance of m[2].el.k can do */
    const real r2_w13 = r2_w13_y1 - r2_w13_e2;

    /* khepera.bg:17: r2: how far r2 can be from zero if no parameter is out of tolerance */
    r[KHEPERA_BUILT_THRESHOLD_R2] = MATH(fabs)(r2_w1) + MATH(fabs)(r2_w2) + MATH(fabs)(r2_w3)
        + MATH(fabs)(r2_w4) + MATH(fabs)(r2_w5) + MATH(fabs)(r2_w6) + MATH(fabs)(r2_w7)
        + MATH(fabs)(r2_w8) + MATH(fabs)(r2_w9) + MATH(fabs)(r2_w10) + MATH(fabs)(r2_w11)
        + MATH(fabs)(r2_w12) + MATH(fabs)(r2_w13);
}

/* r2 on every further sample. */
static void next_r2(
    khepera_built_threshold_monitor *monitor, const khepera_built_threshold_samples *s, real *r)
{
    const khepera_built_threshold_coefficients *c = &monitor->c;
    khepera_built_threshold_memory *x = &monitor->x;
    const khepera_built_threshold_encoders *e = &monitor->e;

    count_on(&monitor->e.m__2__motor, s->m__2__motor);

    /* khepera.bg:17: filtered speed of m[2].motor */
    const real r2_w1_m__2__motor_speed_2 = c->a * x->r2_w1_m__2__motor_speed
        + c->m__1__motor_gain * (real)e->m__2__motor.increment;
    x->r2_w1_m__2__motor_speed = r2_w1_m__2__motor_speed_2;

    /* khepera.bg:17: r2_w1: encoders, order 1 */
    const real r2_w1_n1 = -c->r2_w1_w1_m__2__motor * r2_w1_m__2__motor_speed_2;

    /* khepera.bg:17: r2_w1: error of order 1 */
    const real r2_w1_e1 = c->bend1 * r2_w1_n1;

    /* khepera.bg:17: r2_w1: encoders, order 2 */
    const real r2_w1_n2 = -c->r2_w1_w2_m__2__motor * r2_w1_m__2__motor_speed_2;

    /* khepera.bg:17: r2_w1: degree 1 */
    const real r2_w1_d1 = r2_w1_n1 + r2_w1_n2;

    /* khepera.bg:17: r2_w1: degree 2 */
    const real r2_w1_d2 = r2_w1_n2 - r2_w1_e1;

    /* khepera.bg:17: r2_w1: input of stage 4 */
    const real r2_w1_u4 = r2_w1_n1 + r2_w1_d2 + r2_w1_e1 - r2_w1_d1;

    /* khepera.bg:17: r2_w1: stage 4 */
    const real r2_w1_y4 = x->r2_w1_s4 + c->b * r2_w1_u4;

    /* khepera.bg:17: r2_w1: stage 4: memory */
    x->r2_w1_s4 = c->a * r2_w1_y4 + c->b * r2_w1_u4;

    /* khepera.bg:17: r2_w1: input of stage 3 */
    const real r2_w1_u3 = r2_w1_y4 + r2_w1_d1 - REAL(2.0) * r2_w1_d2 - REAL(3.0) * r2_w1_e1;

    /* khepera.bg:17: r2_w1: stage 3 */
    const real r2_w1_y3 = x->r2_w1_s3 + c->b * r2_w1_u3;

    /* khepera.bg:17: r2_w1: stage 3: memory */
    x->r2_w1_s3 = c->a * r2_w1_y3 + c->b * r2_w1_u3;

    /* khepera.bg:17: r2_w1: input of stage 2 */
    const real r2_w1_u2 = r2_w1_y3 + r2_w1_d2 + REAL(3.0) * r2_w1_e1;

    /* khepera.bg:17: r2_w1: stage 2 */
    const real r2_w1_y2 = x->r2_w1_s2 + c->b * r2_w1_u2;

    /* khepera.bg:17: r2_w1: stage 2: memory */
    x->r2_w1_s2 = c->a * r2_w1_y2 + c->b * r2_w1_u2;

    /* khepera.bg:17: r2_w1: input of stage 1 */
    const real r2_w1_u1 = r2_w1_y2 - r2_w1_e1;

    /* khepera.bg:17: r2_w1: stage 1 */
    const real r2_w1_y1 = x->r2_w1_s1 + c->b * r2_w1_u1;

    /* khepera.bg:17: r2_w1: stage 1: memory */
    x->r2_w1_s1 = c->a * r2_w1_y1 + c->b * r2_w1_u1;

    /* khepera.bg:17: r2: what the tolerance of m[2].fe can do */
    const real r2_w1 = r2_w1_y1;

    /* khepera.bg:17: filtered speed of m[2].motor */
    const real r2_w2_m__2__motor_speed_2 = c->a * x->r2_w2_m__2__motor_speed
        + c->m__1__motor_gain * (real)e->m__2__motor.increment;
    x->r2_w2_m__2__motor_speed = r2_w2_m__2__motor_speed_2;

    /* khepera.bg:17: r2_w2: encoders, order 2 */
    const real r2_w2_n2 = -c->r2_w2_w2_m__2__motor * r2_w2_m__2__motor_speed_2;

    /* khepera.bg:17: r2_w2: error of order 2 */
    const real r2_w2_e2 = c->bend1 * r2_w2_n2;

    /* khepera.bg:17: r2_w2: encoders, order 3 */
    const real r2_w2_n3 = -c->r2_w2_w3_m__2__motor * r2_w2_m__2__motor_speed_2;

    /* khepera.bg:17: r2_w2: degree 2 */
    const real r2_w2_d2 = r2_w2_n2 + r2_w2_n3;

    /* khepera.bg:17: r2_w2: degree 3 */
    const real r2_w2_d3 = r2_w2_n3 - r2_w2_e2;

    /* khepera.bg:17: r2_w2: input of stage 4 */
    const real r2_w2_u4 = r2_w2_d2 - r2_w2_n2 - r2_w2_d3 - r2_w2_e2;

    /* khepera.bg:17: r2_w2: stage 4 */
    const real r2_w2_y4 = x->r2_w2_s4 + c->b * r2_w2_u4;

    /* khepera.bg:17: r2_w2: stage 4: memory */
    x->r2_w2_s4 = c->a * r2_w2_y4 + c->b * r2_w2_u4;

    /* khepera.bg:17: r2_w2: input of stage 3 */
    const real r2_w2_u3 = r2_w2_y4 + r2_w2_n2 + REAL(3.0) * r2_w2_d3 + REAL(4.0) * r2_w2_e2
        - REAL(2.0) * r2_w2_d2;

    /* khepera.bg:17: r2_w2: stage 3 */
    const real r2_w2_y3 = x->r2_w2_s3 + c->b * r2_w2_u3;

    /* khepera.bg:17: r2_w2: stage 3: memory */
    x->r2_w2_s3 = c->a * r2_w2_y3 + c->b * r2_w2_u3;

    /* khepera.bg:17: r2_w2: input of stage 2 */
    const real r2_w2_u2 = r2_w2_y3 + r2_w2_d2 - REAL(3.0) * r2_w2_d3 - REAL(6.0) * r2_w2_e2;

    /* khepera.bg:17: r2_w2: stage 2 */
    const real r2_w2_y2 = x->r2_w2_s2 + c->b * r2_w2_u2;

    /* khepera.bg:17: r2_w2: stage 2: memory */
    x->r2_w2_s2 = c->a * r2_w2_y2 + c->b * r2_w2_u2;

    /* khepera.bg:17: r2_w2: input of stage 1 */
    const real r2_w2_u1 = r2_w2_y2 + r2_w2_d3 + REAL(4.0) * r2_w2_e2;

    /* khepera.bg:17: r2_w2: stage 1 */
    const real r2_w2_y1 = x->r2_w2_s1 + c->b * r2_w2_u1;

    /* khepera.bg:17: r2_w2: stage 1: memory */
    x->r2_w2_s1 = c->a * r2_w2_y1 + c->b * r2_w2_u1;

    /* khepera.bg:17: r2: what the tolerance of m[2].Js can do */
    const real r2_w2 = r2_w2_y1 - r2_w2_e2;

    /* khepera.bg:17: filtered speed of m[2].motor */
    const real r2_w3_m__2__motor_speed_2 = c->a * x->r2_w3_m__2__motor_speed
        + c->m__1__motor_gain * (real)e->m__2__motor.increment;
    x->r2_w3_m__2__motor_speed = r2_w3_m__2__motor_speed_2;

    /* khepera.bg:17: r2_w3: encoders, order 1 */
    const real r2_w3_n1 = -c->r2_w3_w1_m__2__motor * r2_w3_m__2__motor_speed_2;

    /* khepera.bg:17: r2_w3: error of order 1 */
    const real r2_w3_e1 = c->bend1 * r2_w3_n1;

    /* khepera.bg:17: r2_w3: encoders, order 2 */
    const real r2_w3_n2 = -c->r2_w3_w2_m__2__motor * r2_w3_m__2__motor_speed_2;

    /* khepera.bg:17: r2_w3: degree 1 */
    const real r2_w3_d1 = r2_w3_n1 + r2_w3_n2;

    /* khepera.bg:17: r2_w3: degree 2 */
    const real r2_w3_d2 = r2_w3_n2 - r2_w3_e1;

    /* khepera.bg:17: r2_w3: input of stage 4 */
    const real r2_w3_u4 = r2_w3_n1 + r2_w3_d2 + r2_w3_e1 - r2_w3_d1;

    /* khepera.bg:17: r2_w3: stage 4 */
    const real r2_w3_y4 = x->r2_w3_s4 + c->b * r2_w3_u4;

    /* khepera.bg:17: r2_w3: stage 4: memory */
    x->r2_w3_s4 = c->a * r2_w3_y4 + c->b * r2_w3_u4;

    /* khepera.bg:17: r2_w3: input of stage 3 */
    const real r2_w3_u3 = r2_w3_y4 + r2_w3_d1 - REAL(2.0) * r2_w3_d2 - REAL(3.0) * r2_w3_e1;

    /* khepera.bg:17: r2_w3: stage 3 */
    const real r2_w3_y3 = x->r2_w3_s3 + c->b * r2_w3_u3;

    /* khepera.bg:17: r2_w3: stage 3: memory */
    x->r2_w3_s3 = c->a * r2_w3_y3 + c->b * r2_w3_u3;

    /* khepera.bg:17: r2_w3: input of stage 2 */
    const real r2_w3_u2 = r2_w3_y3 + r2_w3_d2 + REAL(3.0) * r2_w3_e1;

    /* khepera.bg:17: r2_w3: stage 2 */
    const real r2_w3_y2 = x->r2_w3_s2 + c->b * r2_w3_u2;

    /* khepera.bg:17: r2_w3: stage 2: memory */
    x->r2_w3_s2 = c->a * r2_w3_y2 + c->b * r2_w3_u2;

    /* khepera.bg:17: r2_w3: input of stage 1 */
    const real r2_w3_u1 = r2_w3_y2 - r2_w3_e1;

    /* khepera.bg:17: r2_w3: stage 1 */
    const real r2_w3_y1 = x->r2_w3_s1 + c->b * r2_w3_u1;

    /* khepera.bg:17: r2_w3: stage 1: memory */
    x->r2_w3_s1 = c->a * r2_w3_y1 + c->b * r2_w3_u1;

    /* khepera.bg:17: r2: what the tolerance of m[2].fs can do */
    const real r2_w3 = r2_w3_y1;

    /* khepera.bg:17: filtered speed of m[2].motor */
    const real r2_w4_m__2__motor_speed_2 = c->a * x->r2_w4_m__2__motor_speed
        + c->m__1__motor_gain * (real)e->m__2__motor.increment;
    x->r2_w4_m__2__motor_speed = r2_w4_m__2__motor_speed_2;

    /* khepera.bg:17: r2_w4: encoders, order 1 */
    const real r2_w4_n1 = -c->r2_w4_w1_m__2__motor * r2_w4_m__2__motor_speed_2;

    /* khepera.bg:17: r2_w4: error of order 1 */
    const real r2_w4_e1 = c->bend1 * r2_w4_n1;

    /* khepera.bg:17: r2_w4: encoders, order 2 */
    const real r2_w4_n2 = -c->r2_w4_w2_m__2__motor * r2_w4_m__2__motor_speed_2;

    /* khepera.bg:17: r2_w4: terms of order 0 */
    const real r2_w4_g0 = -c->r2_w4_Fx__2 * s->Fx__2;

    /* khepera.bg:17: r2_w4: degree 1 */
    const real r2_w4_d1 = r2_w4_n1 + r2_w4_n2;

    /* khepera.bg:17: r2_w4: error of order 0 */
    const real r2_w4_e0 = c->bend2 * r2_w4_g0;

    /* khepera.bg:17: r2_w4: degree 2 */
    const real r2_w4_d2 = r2_w4_n2 - r2_w4_e1 - r2_w4_e0;

    /* khepera.bg:17: r2_w4: input of stage 4 */
    const real r2_w4_u4 = r2_w4_g0 + r2_w4_n1 + r2_w4_d2 + r2_w4_e1 - r2_w4_d1;

    /* khepera.bg:17: r2_w4: stage 4 */
    const real r2_w4_y4 = x->r2_w4_s4 + c->b * r2_w4_u4;

    /* khepera.bg:17: r2_w4: stage 4: memory */
    x->r2_w4_s4 = c->a * r2_w4_y4 + c->b * r2_w4_u4;

    /* khepera.bg:17: r2_w4: input of stage 3 */
    const real r2_w4_u3 = r2_w4_y4 + r2_w4_d1 - REAL(2.0) * r2_w4_d2 - REAL(3.0) * r2_w4_e1;

    /* khepera.bg:17: r2_w4: stage 3 */
    const real r2_w4_y3 = x->r2_w4_s3 + c->b * r2_w4_u3;

    /* khepera.bg:17: r2_w4: stage 3: memory */
    x->r2_w4_s3 = c->a * r2_w4_y3 + c->b * r2_w4_u3;

    /* khepera.bg:17: r2_w4: input of stage 2 */
    const real r2_w4_u2 = r2_w4_y3 + r2_w4_d2 + REAL(3.0) * r2_w4_e1;

    /* khepera.bg:17: r2_w4: stage 2 */
    const real r2_w4_y2 = x->r2_w4_s2 + c->b * r2_w4_u2;

    /* khepera.bg:17: r2_w4: stage 2: memory */
    x->r2_w4_s2 = c->a * r2_w4_y2 + c->b * r2_w4_u2;

    /* khepera.bg:17: r2_w4: input of stage 1 */
    const real r2_w4_u1 = r2_w4_y2 - r2_w4_e1;

    /* khepera.bg:17: r2_w4: stage 1 */
    const real r2_w4_y1 = x->r2_w4_s1 + c->b * r2_w4_u1;

    /* khepera.bg:17: r2_w4: stage 1: memory */
    x->r2_w4_s1 = c->a * r2_w4_y1 + c->b * r2_w4_u1;

    /* khepera.bg:17: r2: what the tolerance of m[2].el.Re can do */
    const real r2_w4 = r2_w4_y1;

    /* khepera.bg:17: filtered speed of m[2].motor */
    const real r2_w5_m__2__motor_speed_2 = c->a * x->r2_w5_m__2__motor_speed
        + c->m__1__motor_gain * (real)e->m__2__motor.increment;
    x->r2_w5_m__2__motor_speed = r2_w5_m__2__motor_speed_2;

    /* khepera.bg:17: r2_w5: encoders, order 1 */
    const real r2_w5_n1 = c->r2_w5_w1_m__2__motor * r2_w5_m__2__motor_speed_2;

    /* khepera.bg:17: r2_w5: error of order 1 */
    const real r2_w5_e1 = c->bend2 * r2_w5_n1;

    /* khepera.bg:17: r2_w5: encoders, order 2 */
    const real r2_w5_n2 = c->r2_w5_w2_m__2__motor * r2_w5_m__2__motor_speed_2;

    /* khepera.bg:17: r2_w5: error of order 2 */
    const real r2_w5_e2 = c->bend1 * r2_w5_n2;

    /* khepera.bg:17: r2_w5: encoders, order 3 */
    const real r2_w5_n3 = c->r2_w5_w3_m__2__motor * r2_w5_m__2__motor_speed_2;

    /* khepera.bg:17: r2_w5: terms of order 0 */
    const real r2_w5_g0 = c->r2_w5_Fx__2 * s->Fx__2;

    /* khepera.bg:17: r2_w5: terms of order 1 */
    const real r2_w5_g1 = c->r2_w5_w1_Fx__2 * s->Fx__2;

    /* khepera.bg:17: r2_w5: degree 1 */
    const real r2_w5_d1 = r2_w5_g1 + r2_w5_n1 + r2_w5_n2;

    /* khepera.bg:17: r2_w5: error of order 0 */
    const real r2_w5_e0 = c->bend3 * r2_w5_g0;

    /* khepera.bg:17: r2_w5: degree 2 */
    const real r2_w5_d2 = r2_w5_n2 + r2_w5_n3 - r2_w5_e1 - r2_w5_e0;

    /* khepera.bg:17: r2_w5: error of order 1 */
    const real r2_w5_e1_2 = c->bend2 * r2_w5_g1;

    /* khepera.bg:17: r2_w5: degree 3 */
    const real r2_w5_d3 = r2_w5_n3 - r2_w5_e1 - r2_w5_e2 - r2_w5_e1_2;

    /* khepera.bg:17: r2_w5: input of stage 4 */
    const real r2_w5_u4 = r2_w5_g0 + r2_w5_n1 + r2_w5_d2 - r2_w5_d1 - r2_w5_d3 - r2_w5_e2;

    /* khepera.bg:17: r2_w5: stage 4 */
    const real r2_w5_y4 = x->r2_w5_s4 + c->b * r2_w5_u4;

    /* khepera.bg:17: r2_w5: stage 4: memory */
    x->r2_w5_s4 = c->a * r2_w5_y4 + c->b * r2_w5_u4;

    /* khepera.bg:17: r2_w5: input of stage 3 */
    const real r2_w5_u3 = r2_w5_y4 + r2_w5_d1 + REAL(3.0) * r2_w5_d3 + REAL(4.0) * r2_w5_e2
        - REAL(2.0) * r2_w5_d2;

    /* khepera.bg:17: r2_w5: stage 3 */
    const real r2_w5_y3 = x->r2_w5_s3 + c->b * r2_w5_u3;

    /* khepera.bg:17: r2_w5: stage 3: memory */
    x->r2_w5_s3 = c->a * r2_w5_y3 + c->b * r2_w5_u3;

    /* khepera.bg:17: r2_w5: input of stage 2 */
    const real r2_w5_u2 = r2_w5_y3 + r2_w5_d2 - REAL(3.0) * r2_w5_d3 - REAL(6.0) * r2_w5_e2;

    /* khepera.bg:17: r2_w5: stage 2 */
    const real r2_w5_y2 = x->r2_w5_s2 + c->b * r2_w5_u2;

    /* khepera.bg:17: r2_w5: stage 2: memory */
    x->r2_w5_s2 = c->a * r2_w5_y2 + c->b * r2_w5_u2;

    /* khepera.bg:17: r2_w5: input of stage 1 */
    const real r2_w5_u1 = r2_w5_y2 + r2_w5_d3 + REAL(4.0) * r2_w5_e2;

    /* khepera.bg:17: r2_w5: stage 1 */
    const real r2_w5_y1 = x->r2_w5_s1 + c->b * r2_w5_u1;

    /* khepera.bg:17: r2_w5: stage 1: memory */
    x->r2_w5_s1 = c->a * r2_w5_y1 + c->b * r2_w5_u1;

    /* khepera.bg:17: r2: what the tolerance of m[2].el.k can do */
    const real r2_w5 = r2_w5_y1 - r2_w5_e2;

    /* khepera.bg:17: filtered speed of m[2].motor */
    const real r2_w6_m__2__motor_speed_2 = c->a * x->r2_w6_m__2__motor_speed
        + c->m__1__motor_gain * (real)e->m__2__motor.increment;
    x->r2_w6_m__2__motor_speed = r2_w6_m__2__motor_speed_2;

    /* khepera.bg:17: r2_w6: encoders, order 1 */
    const real r2_w6_n1 = -c->r2_w6_w1_m__2__motor * r2_w6_m__2__motor_speed_2;

    /* khepera.bg:17: r2_w6: input of stage 4 */
    const real r2_w6_u4 = r2_w6_n1 - r2_w6_n1;

    /* khepera.bg:17: r2_w6: stage 4 */
    const real r2_w6_y4 = x->r2_w6_s4 + c->b * r2_w6_u4;

    /* khepera.bg:17: r2_w6: stage 4: memory */
    x->r2_w6_s4 = c->a * r2_w6_y4 + c->b * r2_w6_u4;

    /* khepera.bg:17: r2_w6: input of stage 3 */
    const real r2_w6_u3 = r2_w6_y4 + r2_w6_n1;

    /* khepera.bg:17: r2_w6: stage 3 */
    const real r2_w6_y3 = x->r2_w6_s3 + c->b * r2_w6_u3;

    /* khepera.bg:17: r2_w6: stage 3: memory */
    x->r2_w6_s3 = c->a * r2_w6_y3 + c->b * r2_w6_u3;

    /* khepera.bg:17: r2_w6: input of stage 2 */
    const real r2_w6_u2 = r2_w6_y3;

    /* khepera.bg:17: r2_w6: stage 2 */
    const real r2_w6_y2 = x->r2_w6_s2 + c->b * r2_w6_u2;

    /* khepera.bg:17: r2_w6: stage 2: memory */
    x->r2_w6_s2 = c->a * r2_w6_y2 + c->b * r2_w6_u2;

    /* khepera.bg:17: r2_w6: input of stage 1 */
    const real r2_w6_u1 = r2_w6_y2;

    /* khepera.bg:17: r2_w6: stage 1 */
    const real r2_w6_y1 = x->r2_w6_s1 + c->b * r2_w6_u1;

    /* khepera.bg:17: r2_w6: stage 1: memory */
    x->r2_w6_s1 = c->a * r2_w6_y1 + c->b * r2_w6_u1;

    /* khepera.bg:17: r2: what the tolerances of m[2].fe and m[2].el.Re can do together */
    const real r2_w6 = r2_w6_y1;

    /* khepera.bg:17: filtered speed of m[2].motor */
    const real r2_w7_m__2__motor_speed_2 = c->a * x->r2_w7_m__2__motor_speed
        + c->m__1__motor_gain * (real)e->m__2__motor.increment;
    x->r2_w7_m__2__motor_speed = r2_w7_m__2__motor_speed_2;

    /* khepera.bg:17: r2_w7: encoders, order 1 */
    const real r2_w7_n1 = c->r2_w7_w1_m__2__motor * r2_w7_m__2__motor_speed_2;

    /* khepera.bg:17: r2_w7: error of order 1 */
    const real r2_w7_e1 = c->bend1 * r2_w7_n1;

    /* khepera.bg:17: r2_w7: encoders, order 2 */
    const real r2_w7_n2 = c->r2_w7_w2_m__2__motor * r2_w7_m__2__motor_speed_2;

    /* khepera.bg:17: r2_w7: degree 1 */
    const real r2_w7_d1 = r2_w7_n1 + r2_w7_n2;

    /* khepera.bg:17: r2_w7: degree 2 */
    const real r2_w7_d2 = r2_w7_n2 - r2_w7_e1;

    /* khepera.bg:17: r2_w7: input of stage 4 */
    const real r2_w7_u4 = r2_w7_n1 + r2_w7_d2 + r2_w7_e1 - r2_w7_d1;

    /* khepera.bg:17: r2_w7: stage 4 */
    const real r2_w7_y4 = x->r2_w7_s4 + c->b * r2_w7_u4;

    /* khepera.bg:17: r2_w7: stage 4: memory */
    x->r2_w7_s4 = c->a * r2_w7_y4 + c->b * r2_w7_u4;

    /* khepera.bg:17: r2_w7: input of stage 3 */
    const real r2_w7_u3 = r2_w7_y4 + r2_w7_d1 - REAL(2.0) * r2_w7_d2 - REAL(3.0) * r2_w7_e1;

    /* khepera.bg:17: r2_w7: stage 3 */
    const real r2_w7_y3 = x->r2_w7_s3 + c->b * r2_w7_u3;

    /* khepera.bg:17: r2_w7: stage 3: memory */
    x->r2_w7_s3 = c->a * r2_w7_y3 + c->b * r2_w7_u3;

    /* khepera.bg:17: r2_w7: input of stage 2 */
    const real r2_w7_u2 = r2_w7_y3 + r2_w7_d2 + REAL(3.0) * r2_w7_e1;

    /* khepera.bg:17: r2_w7: stage 2 */
    const real r2_w7_y2 = x->r2_w7_s2 + c->b * r2_w7_u2;

    /* khepera.bg:17: r2_w7: stage 2: memory */
    x->r2_w7_s2 = c->a * r2_w7_y2 + c->b * r2_w7_u2;

    /* khepera.bg:17: r2_w7: input of stage 1 */
    const real r2_w7_u1 = r2_w7_y2 - r2_w7_e1;

    /* khepera.bg:17: r2_w7: stage 1 */
    const real r2_w7_y1 = x->r2_w7_s1 + c->b * r2_w7_u1;

    /* khepera.bg:17: r2_w7: stage 1: memory */
    x->r2_w7_s1 = c->a * r2_w7_y1 + c->b * r2_w7_u1;

    /* khepera.bg:17: r2: what the tolerances of m[2].fe and m[2].el.k can do together */
    const real r2_w7 = r2_w7_y1;

    /* khepera.bg:17: filtered speed of m[2].motor */
    const real r2_w8_m__2__motor_speed_2 = c->a * x->r2_w8_m__2__motor_speed
        + c->m__1__motor_gain * (real)e->m__2__motor.increment;
    x->r2_w8_m__2__motor_speed = r2_w8_m__2__motor_speed_2;

    /* khepera.bg:17: r2_w8: encoders, order 2 */
    const real r2_w8_n2 = -c->r2_w8_w2_m__2__motor * r2_w8_m__2__motor_speed_2;

    /* khepera.bg:17: r2_w8: input of stage 4 */
    const real r2_w8_u4 = r2_w8_n2 - r2_w8_n2;

    /* khepera.bg:17: r2_w8: stage 4 */
    const real r2_w8_y4 = x->r2_w8_s4 + c->b * r2_w8_u4;

    /* khepera.bg:17: r2_w8: stage 4: memory */
    x->r2_w8_s4 = c->a * r2_w8_y4 + c->b * r2_w8_u4;

    /* khepera.bg:17: r2_w8: input of stage 3 */
    const real r2_w8_u3 = r2_w8_y4 + r2_w8_n2 - REAL(2.0) * r2_w8_n2;

    /* khepera.bg:17: r2_w8: stage 3 */
    const real r2_w8_y3 = x->r2_w8_s3 + c->b * r2_w8_u3;

    /* khepera.bg:17: r2_w8: stage 3: memory */
    x->r2_w8_s3 = c->a * r2_w8_y3 + c->b * r2_w8_u3;

    /* khepera.bg:17: r2_w8: input of stage 2 */
    const real r2_w8_u2 = r2_w8_y3 + r2_w8_n2;

    /* khepera.bg:17: r2_w8: stage 2 */
    const real r2_w8_y2 = x->r2_w8_s2 + c->b * r2_w8_u2;

    /* khepera.bg:17: r2_w8: stage 2: memory */
    x->r2_w8_s2 = c->a * r2_w8_y2 + c->b * r2_w8_u2;

    /* khepera.bg:17: r2_w8: input of stage 1 */
    const real r2_w8_u1 = r2_w8_y2;

    /* khepera.bg:17: r2_w8: stage 1 */
    const real r2_w8_y1 = x->r2_w8_s1 + c->b * r2_w8_u1;

    /* khepera.bg:17: r2_w8: stage 1: memory */
    x->r2_w8_s1 = c->a * r2_w8_y1 + c->b * r2_w8_u1;

    /* khepera.bg:17: r2: what the tolerances of m[2].Js and m[2].el.Re can do together */
    const real r2_w8 = r2_w8_y1;

    /* khepera.bg:17: filtered speed of m[2].motor */
    const real r2_w9_m__2__motor_speed_2 = c->a * x->r2_w9_m__2__motor_speed
        + c->m__1__motor_gain * (real)e->m__2__motor.increment;
    x->r2_w9_m__2__motor_speed = r2_w9_m__2__motor_speed_2;

    /* khepera.bg:17: r2_w9: encoders, order 2 */
    const real r2_w9_n2 = c->r2_w9_w2_m__2__motor * r2_w9_m__2__motor_speed_2;

    /* khepera.bg:17: r2_w9: error of order 2 */
    const real r2_w9_e2 = c->bend1 * r2_w9_n2;

    /* khepera.bg:17: r2_w9: encoders, order 3 */
    const real r2_w9_n3 = c->r2_w9_w3_m__2__motor * r2_w9_m__2__motor_speed_2;

    /* khepera.bg:17: r2_w9: degree 2 */
    const real r2_w9_d2 = r2_w9_n2 + r2_w9_n3;

    /* khepera.bg:17: r2_w9: degree 3 */
    const real r2_w9_d3 = r2_w9_n3 - r2_w9_e2;

    /* khepera.bg:17: r2_w9: input of stage 4 */
    const real r2_w9_u4 = r2_w9_d2 - r2_w9_n2 - r2_w9_d3 - r2_w9_e2;

    /* khepera.bg:17: r2_w9: stage 4 */
    const real r2_w9_y4 = x->r2_w9_s4 + c->b * r2_w9_u4;

    /* khepera.bg:17: r2_w9: stage 4: memory */
    x->r2_w9_s4 = c->a * r2_w9_y4 + c->b * r2_w9_u4;

    /* khepera.bg:17: r2_w9: input of stage 3 */
    const real r2_w9_u3 = r2_w9_y4 + r2_w9_n2 + REAL(3.0) * r2_w9_d3 + REAL(4.0) * r2_w9_e2
        - REAL(2.0) * r2_w9_d2;

    /* khepera.bg:17: r2_w9: stage 3 */
    const real r2_w9_y3 = x->r2_w9_s3 + c->b * r2_w9_u3;

    /* khepera.bg:17: r2_w9: stage 3: memory */
    x->r2_w9_s3 = c->a * r2_w9_y3 + c->b * r2_w9_u3;

    /* khepera.bg:17: r2_w9: input of stage 2 */
    const real r2_w9_u2 = r2_w9_y3 + r2_w9_d2 - REAL(3.0) * r2_w9_d3 - REAL(6.0) * r2_w9_e2;

    /* khepera.bg:17: r2_w9: stage 2 */
    const real r2_w9_y2 = x->r2_w9_s2 + c->b * r2_w9_u2;

    /* khepera.bg:17: r2_w9: stage 2: memory */
    x->r2_w9_s2 = c->a * r2_w9_y2 + c->b * r2_w9_u2;

    /* khepera.bg:17: r2_w9: input of stage 1 */
    const real r2_w9_u1 = r2_w9_y2 + r2_w9_d3 + REAL(4.0) * r2_w9_e2;

    /* khepera.bg:17: r2_w9: stage 1 */
    const real r2_w9_y1 = x->r2_w9_s1 + c->b * r2_w9_u1;

    /* khepera.bg:17: r2_w9: stage 1: memory */
    x->r2_w9_s1 = c->a * r2_w9_y1 + c->b * r2_w9_u1;

    /* khepera.bg:17: r2: what the tolerances of m[2].Js and m[2].el.k can do together */
    const real r2_w9 = r2_w9_y1 - r2_w9_e2;

    /* khepera.bg:17: filtered speed of m[2].motor */
    const real r2_w10_m__2__motor_speed_2 = c->a * x->r2_w10_m__2__motor_speed
        + c->m__1__motor_gain * (real)e->m__2__motor.increment;
    x->r2_w10_m__2__motor_speed = r2_w10_m__2__motor_speed_2;

    /* khepera.bg:17: r2_w10: encoders, order 1 */
    const real r2_w10_n1 = -c->r2_w10_w1_m__2__motor * r2_w10_m__2__motor_speed_2;

    /* khepera.bg:17: r2_w10: input of stage 4 */
    const real r2_w10_u4 = r2_w10_n1 - r2_w10_n1;

    /* khepera.bg:17: r2_w10: stage 4 */
    const real r2_w10_y4 = x->r2_w10_s4 + c->b * r2_w10_u4;

    /* khepera.bg:17: r2_w10: stage 4: memory */
    x->r2_w10_s4 = c->a * r2_w10_y4 + c->b * r2_w10_u4;

    /* khepera.bg:17: r2_w10: input of stage 3 */
    const real r2_w10_u3 = r2_w10_y4 + r2_w10_n1;

    /* khepera.bg:17: r2_w10: stage 3 */
    const real r2_w10_y3 = x->r2_w10_s3 + c->b * r2_w10_u3;

    /* khepera.bg:17: r2_w10: stage 3: memory */
    x->r2_w10_s3 = c->a * r2_w10_y3 + c->b * r2_w10_u3;

    /* khepera.bg:17: r2_w10: input of stage 2 */
    const real r2_w10_u2 = r2_w10_y3;

    /* khepera.bg:17: r2_w10: stage 2 */
    const real r2_w10_y2 = x->r2_w10_s2 + c->b * r2_w10_u2;

    /* khepera.bg:17: r2_w10: stage 2: memory */
    x->r2_w10_s2 = c->a * r2_w10_y2 + c->b * r2_w10_u2;

    /* khepera.bg:17: r2_w10: input of stage 1 */
    const real r2_w10_u1 = r2_w10_y2;

    /* khepera.bg:17: r2_w10: stage 1 */
    const real r2_w10_y1 = x->r2_w10_s1 + c->b * r2_w10_u1;

    /* khepera.bg:17: r2_w10: stage 1: memory */
    x->r2_w10_s1 = c->a * r2_w10_y1 + c->b * r2_w10_u1;

    /* khepera.bg:17: r2: what the tolerances of m[2].fs and m[2].el.Re can do together */
    const real r2_w10 = r2_w10_y1;

    /* khepera.bg:17: filtered speed of m[2].motor */
    const real r2_w11_m__2__motor_speed_2 = c->a * x->r2_w11_m__2__motor_speed
        + c->m__1__motor_gain * (real)e->m__2__motor.increment;
    x->r2_w11_m__2__motor_speed = r2_w11_m__2__motor_speed_2;

    /* khepera.bg:17: r2_w11: encoders, order 1 */
    const real r2_w11_n1 = c->r2_w11_w1_m__2__motor * r2_w11_m__2__motor_speed_2;

    /* khepera.bg:17: r2_w11: error of order 1 */
    const real r2_w11_e1 = c->bend1 * r2_w11_n1;

    /* khepera.bg:17: r2_w11: encoders, order 2 */
    const real r2_w11_n2 = c->r2_w11_w2_m__2__motor * r2_w11_m__2__motor_speed_2;

    /* khepera.bg:17: r2_w11: degree 1 */
    const real r2_w11_d1 = r2_w11_n1 + r2_w11_n2;

    /* khepera.bg:17: r2_w11: degree 2 */
    const real r2_w11_d2 = r2_w11_n2 - r2_w11_e1;

    /* khepera.bg:17: r2_w11: input of stage 4 */
    const real r2_w11_u4 = r2_w11_n1 + r2_w11_d2 + r2_w11_e1 - r2_w11_d1;

    /* khepera.bg:17: r2_w11: stage 4 */
    const real r2_w11_y4 = x->r2_w11_s4 + c->b * r2_w11_u4;

    /* khepera.bg:17: r2_w11: stage 4: memory */
    x->r2_w11_s4 = c->a * r2_w11_y4 + c->b * r2_w11_u4;

    /* khepera.bg:17: r2_w11: input of stage 3 */
    const real r2_w11_u3 = r2_w11_y4 + r2_w11_d1 - REAL(2.0) * r2_w11_d2 - REAL(3.0) * r2_w11_e1;

    /* khepera.bg:17: r2_w11: stage 3 */
    const real r2_w11_y3 = x->r2_w11_s3 + c->b * r2_w11_u3;

    /* khepera.bg:17: r2_w11: stage 3: memory */
    x->r2_w11_s3 = c->a * r2_w11_y3 + c->b * r2_w11_u3;

    /* khepera.bg:17: r2_w11: input of stage 2 */
    const real r2_w11_u2 = r2_w11_y3 + r2_w11_d2 + REAL(3.0) * r2_w11_e1;

    /* khepera.bg:17: r2_w11: stage 2 */
    const real r2_w11_y2 = x->r2_w11_s2 + c->b * r2_w11_u2;

    /* khepera.bg:17: r2_w11: stage 2: memory */
    x->r2_w11_s2 = c->a * r2_w11_y2 + c->b * r2_w11_u2;

    /* khepera.bg:17: r2_w11: input of stage 1 */
    const real r2_w11_u1 = r2_w11_y2 - r2_w11_e1;

    /* khepera.bg:17: r2_w11: stage 1 */
    const real r2_w11_y1 = x->r2_w11_s1 + c->b * r2_w11_u1;

    /* khepera.bg:17: r2_w11: stage 1: memory */
    x->r2_w11_s1 = c->a * r2_w11_y1 + c->b * r2_w11_u1;

    /* khepera.bg:17: r2: what the tolerances of m[2].fs and m[2].el.k can do together */
    const real r2_w11 = r2_w11_y1;

    /* khepera.bg:17: filtered speed of m[2].motor */
    const real r2_w12_m__2__motor_speed_2 = c->a * x->r2_w12_m__2__motor_speed
        + c->m__1__motor_gain * (real)e->m__2__motor.increment;
    x->r2_w12_m__2__motor_speed = r2_w12_m__2__motor_speed_2;

    /* khepera.bg:17: r2_w12: encoders, order 1 */
    const real r2_w12_n1 = c->r2_w12_w1_m__2__motor * r2_w12_m__2__motor_speed_2;

    /* khepera.bg:17: r2_w12: error of order 1 */
    const real r2_w12_e1 = c->bend1 * r2_w12_n1;

    /* khepera.bg:17: r2_w12: encoders, order 2 */
    const real r2_w12_n2 = c->r2_w12_w2_m__2__motor * r2_w12_m__2__motor_speed_2;

    /* khepera.bg:17: r2_w12: terms of order 0 */
    const real r2_w12_g0 = c->r2_w12_Fx__2 * s->Fx__2;

    /* khepera.bg:17: r2_w12: degree 1 */
    const real r2_w12_d1 = r2_w12_n1 + r2_w12_n2;

    /* khepera.bg:17: r2_w12: error of order 0 */
    const real r2_w12_e0 = c->bend2 * r2_w12_g0;

    /* khepera.bg:17: r2_w12: degree 2 */
    const real r2_w12_d2 = r2_w12_n2 - r2_w12_e1 - r2_w12_e0;

    /* khepera.bg:17: r2_w12: input of stage 4 */
    const real r2_w12_u4 = r2_w12_g0 + r2_w12_n1 + r2_w12_d2 + r2_w12_e1 - r2_w12_d1;

    /* khepera.bg:17: r2_w12: stage 4 */
    const real r2_w12_y4 = x->r2_w12_s4 + c->b * r2_w12_u4;

    /* khepera.bg:17: r2_w12: stage 4: memory */
    x->r2_w12_s4 = c->a * r2_w12_y4 + c->b * r2_w12_u4;

    /* khepera.bg:17: r2_w12: input of stage 3 */
    const real r2_w12_u3 = r2_w12_y4 + r2_w12_d1 - REAL(2.0) * r2_w12_d2 - REAL(3.0) * r2_w12_e1;

    /* khepera.bg:17: r2_w12: stage 3 */
    const real r2_w12_y3 = x->r2_w12_s3 + c->b * r2_w12_u3;

    /* khepera.bg:17: r2_w12: stage 3: memory */
    x->r2_w12_s3 = c->a * r2_w12_y3 + c->b * r2_w12_u3;

    /* khepera.bg:17: r2_w12: input of stage 2 */
    const real r2_w12_u2 = r2_w12_y3 + r2_w12_d2 + REAL(3.0) * r2_w12_e1;

    /* khepera.bg:17: r2_w12: stage 2 */
    const real r2_w12_y2 = x->r2_w12_s2 + c->b * r2_w12_u2;

    /* khepera.bg:17: r2_w12: stage 2: memory */
    x->r2_w12_s2 = c->a * r2_w12_y2 + c->b * r2_w12_u2;

    /* khepera.bg:17: r2_w12: input of stage 1 */
    const real r2_w12_u1 = r2_w12_y2 - r2_w12_e1;

    /* khepera.bg:17: r2_w12: stage 1 */
    const real r2_w12_y1 = x->r2_w12_s1 + c->b * r2_w12_u1;

    /* khepera.bg:17: r2_w12: stage 1: memory */
    x->r2_w12_s1 = c->a * r2_w12_y1 + c->b * r2_w12_u1;

    /* khepera.bg:17: r2: what the tolerances of m[2].el.Re and m[2].el.k can do together */
    const real r2_w12 = r2_w12_y1;

    /* khepera.bg:17: filtered speed of m[2].motor */
    const real r2_w13_m__2__motor_speed_2 = c->a * x->r2_w13_m__2__motor_speed
        + c->m__1__motor_gain * (real)e->m__2__motor.increment;
    x->r2_w13_m__2__motor_speed = r2_w13_m__2__motor_speed_2;

    /* khepera.bg:17: r2_w13: encoders, order 1 */
    const real r2_w13_n1 = -c->r2_w13_w1_m__2__motor * r2_w13_m__2__motor_speed_2;

    /* khepera.bg:17: r2_w13: error of order 1 */
    const real r2_w13_e1 = c->bend2 * r2_w13_n1;

    /* khepera.bg:17: r2_w13: encoders, order 2 */
    const real r2_w13_n2 = c->r2_w13_w2_m__2__motor * r2_w13_m__2__motor_speed_2;

    /* khepera.bg:17: r2_w13: error of order 2 */
    const real r2_w13_e2 = c->bend1 * r2_w13_n2;

    /* khepera.bg:17: r2_w13: encoders, order 3 */
    const real r2_w13_n3 = -c->r2_w13_w3_m__2__motor * r2_w13_m__2__motor_speed_2;

    /* khepera.bg:17: r2_w13: terms of order 0 */
    const real r2_w13_g0 = -c->r2_w13_Fx__2 * s->Fx__2;

    /* khepera.bg:17: r2_w13: terms of order 1 */
    const real r2_w13_g1 = -c->r2_w13_w1_Fx__2 * s->Fx__2;

    /* khepera.bg:17: r2_w13: degree 1 */
    const real r2_w13_d1 = r2_w13_g1 + r2_w13_n1 + r2_w13_n2;

    /* khepera.bg:17: r2_w13: error of order 0 */
    const real r2_w13_e0 = c->bend3 * r2_w13_g0;

    /* khepera.bg:17: r2_w13: degree 2 */
    const real r2_w13_d2 = r2_w13_n2 + r2_w13_n3 - r2_w13_e1 - r2_w13_e0;

    /* khepera.bg:17: r2_w13: error of order 1 */
    const real r2_w13_e1_2 = c->bend2 * r2_w13_g1;

    /* khepera.bg:17: r2_w13: degree 3 */
    const real r2_w13_d3 = r2_w13_n3 - r2_w13_e1 - r2_w13_e2 - r2_w13_e1_2;

    /* khepera.bg:17: r2_w13: input of stage 4 */
    const real r2_w13_u4 = r2_w13_g0 + r2_w13_n1 + r2_w13_d2 - r2_w13_d1 - r2_w13_d3 - r2_w13_e2;

    /* khepera.bg:17: r2_w13: stage 4 */
    const real r2_w13_y4 = x->r2_w13_s4 + c->b * r2_w13_u4;

    /* khepera.bg:17: r2_w13: stage 4: memory */
    x->r2_w13_s4 = c->a * r2_w13_y4 + c->b * r2_w13_u4;

    /* khepera.bg:17: r2_w13: input of stage 3 */
    const real r2_w13_u3 = r2_w13_y4 + r2_w13_d1 + REAL(3.0) * r2_w13_d3 + REAL(4.0) * r2_w13_e2
        - REAL(2.0) * r2_w13_d2;

    /* khepera.bg:17: r2_w13: stage 3 */
    const real r2_w13_y3 = x->r2_w13_s3 + c->b * r2_w13_u3;

    /* khepera.bg:17: r2_w13: stage 3: memory */
    x->r2_w13_s3 = c->a * r2_w13_y3 + c->b * r2_w13_u3;

    /* khepera.bg:17: r2_w13: input of stage 2 */
    const real r2_w13_u2 = r2_w13_y3 + r2_w13_d2 - REAL(3.0) * r2_w13_d3 - REAL(6.0) * r2_w13_e2;

    /* khepera.bg:17: r2_w13: stage 2 */
    const real r2_w13_y2 = x->r2_w13_s2 + c->b * r2_w13_u2;

    /* khepera.bg:17: r2_w13: stage 2: memory */
    x->r2_w13_s2 = c->a * r2_w13_y2 + c->b * r2_w13_u2;

    /* khepera.bg:17: r2_w13: input of stage 1 */
    const real r2_w13_u1 = r2_w13_y2 + r2_w13_d3 + REAL(4.0) * r2_w13_e2;

    /* khepera.bg:17: r2_w13: stage 1 */
    const real r2_w13_y1 = x->r2_w13_s1 + c->b * r2_w13_u1;

    /* khepera.bg:17: r2_w13: stage 1: memory */
    x->r2_w13_s1 = c->a * r2_w13_y1 + c->b * r2_w13_u1;

    /* khepera.bg:17: r2: second order of what the tolerance of m[2].el.k can do */
    const real r2_w13 = r2_w13_y1 - r2_w13_e2;

    /* khepera.bg:17: r2: how far r2 can be from zero if no parameter is out of tolerance */
    r[KHEPERA_BUILT_THRESHOLD_R2] = MATH(fabs)(r2_w1) + MATH(fabs)(r2_w2) + MATH(fabs)(r2_w3)
        + MATH(fabs)(r2_w4) + MATH(fabs)(r2_w5) + MATH(fabs)(r2_w6) + MATH(fabs)(r2_w7)
        + MATH(fabs)(r2_w8) + MATH(fabs)(r2_w9) + MATH(fabs)(r2_w10) + MATH(fabs)(r2_w11)
        + MATH(fabs)(r2_w12) + MATH(fabs)(r2_w13);
}

/* One sample for r2; a number that is not finite makes the next sample the first. */
static void run_r2(
    khepera_built_threshold_monitor *monitor, const khepera_built_threshold_samples *s, khepera_built_threshold_residuals *residuals)
{
    real *r = residuals->value;
    uint32_t age = monitor->age[1];

    if (age == 0u) {
        start_r2(monitor, s, r);
    } else {
        next_r2(monitor, s, r);
    }
    /* a sum is finite only if all its terms are */
    if (finite_number(s->Fx__2 + r[KHEPERA_BUILT_THRESHOLD_R2])) {
        age += age < UINT32_MAX ? 1u : 0u;
    } else {
        age = 0u;
        r[KHEPERA_BUILT_THRESHOLD_R2] = REAL(0.0);
    }
    monitor->age[1] = age;
    residuals->valid[KHEPERA_BUILT_THRESHOLD_R2] = age > monitor->settle[KHEPERA_BUILT_THRESHOLD_R2];
}

/* r3 on its first sample: the filter as if it had always been so. */
static void start_r3(
    khepera_built_threshold_monitor *monitor, const khepera_built_threshold_samples *s, real *r)
{
    (void)monitor;
    (void)s;

    /* khepera.bg:114: r3: how far r3 can be from zero if no parameter is out of tolerance */
    r[KHEPERA_BUILT_THRESHOLD_R3] = REAL(0.0);
}

/* r3 on every further sample. */
static void next_r3(
    khepera_built_threshold_monitor *monitor, const khepera_built_threshold_samples *s, real *r)
{
    (void)monitor;
    (void)s;

    /* khepera.bg:114: r3: how far r3 can be from zero if no parameter is out of tolerance */
    r[KHEPERA_BUILT_THRESHOLD_R3] = REAL(0.0);
}

/* One sample for r3; a number that is not finite makes the next sample the first. */
static void run_r3(
    khepera_built_threshold_monitor *monitor, const khepera_built_threshold_samples *s, khepera_built_threshold_residuals *residuals)
{
    real *r = residuals->value;
    uint32_t age = monitor->age[2];

    if (age == 0u) {
        start_r3(monitor, s, r);
    } else {
        next_r3(monitor, s, r);
    }
    /* a sum is finite only if all its terms are */
    if (finite_number(r[KHEPERA_BUILT_THRESHOLD_R3])) {
        age += age < UINT32_MAX ? 1u : 0u;
    } else {
        age = 0u;
        r[KHEPERA_BUILT_THRESHOLD_R3] = REAL(0.0);
    }
    monitor->age[2] = age;
    residuals->valid[KHEPERA_BUILT_THRESHOLD_R3] = age > monitor->settle[KHEPERA_BUILT_THRESHOLD_R3];
}

void khepera_built_threshold_reset(khepera_built_threshold_monitor *monitor)
{
    int k;

    for (k = 0; k < 3; ++k) {
        monitor->age[k] = 0u;
    }
}

void khepera_built_threshold_step(
    khepera_built_threshold_monitor *monitor,
    const khepera_built_threshold_samples *samples,
    khepera_built_threshold_residuals *residuals)
{
    run_r1(monitor, samples, residuals);
    run_r2(monitor, samples, residuals);
    run_r3(monitor, samples, residuals);
}
