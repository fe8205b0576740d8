/* khepera_plausible_threshold.c: the thresholds of KheperaPlausible_threshold; generated, see the header. */
#include "khepera_plausible_threshold.h"

#include <math.h>

#if defined __FINITE_MATH_ONLY__ && __FINITE_MATH_ONLY__
#error "this code tells numbers from NaN: compile it without -ffinite-math-only (-ffast-math)"
#endif

typedef khepera_plausible_threshold_real real;

#define REAL(x) KHEPERA_PLAUSIBLE_THRESHOLD_CONSTANT(x)
#if defined KHEPERA_PLAUSIBLE_THRESHOLD_FLOAT && !defined KHEPERA_PLAUSIBLE_THRESHOLD_REAL
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

uint32_t khepera_plausible_threshold_abi(void)
{
    return KHEPERA_PLAUSIBLE_THRESHOLD_ABI;
}

const char *khepera_plausible_threshold_digest(void)
{
    return KHEPERA_PLAUSIBLE_THRESHOLD_DIGEST;
}

void khepera_plausible_threshold_nominal(khepera_plausible_threshold_parameters *parameters)
{
    parameters->Js__1 = REAL(1.0e-05);                /* kg.m^2 */
    parameters->Js__2 = REAL(1.0e-05);                /* kg.m^2 */
    parameters->fe__1 = REAL(1.0e-07);                /* N.m.s/rad */
    parameters->fe__2 = REAL(1.0e-07);                /* N.m.s/rad */
    parameters->R__1 = REAL(0.008);                   /* m */
    parameters->R__2 = REAL(0.008);                   /* m */
    parameters->robot__m__1__el__L = REAL(0.0003);    /* H */
    parameters->robot__m__1__el__Re = REAL(17.6);     /* Ohm */
    parameters->robot__m__1__el__k = REAL(0.00351);   /* N.m/A */
    parameters->robot__m__1__me__Je = REAL(1.4e-08);  /* kg.m^2 */
    parameters->robot__m__1__me__K = REAL(0.1);       /* N.m/rad */
    parameters->robot__m__1__ge__N = REAL(25.0);      /* 1 */
    parameters->robot__m__1__wh__fs = REAL(0.0003);   /* N.m.s/rad */
    parameters->robot__m__2__el__L = REAL(0.0003);    /* H */
    parameters->robot__m__2__el__Re = REAL(17.6);     /* Ohm */
    parameters->robot__m__2__el__k = REAL(0.00351);   /* N.m/A */
    parameters->robot__m__2__me__Je = REAL(1.4e-08);  /* kg.m^2 */
    parameters->robot__m__2__me__K = REAL(0.1);       /* N.m/rad */
    parameters->robot__m__2__ge__N = REAL(25.0);      /* 1 */
    parameters->robot__m__2__wh__fs = REAL(0.0003);   /* N.m.s/rad */
}

/* The coefficients of exact and of the filter, from the parameters. */
static void compute_coefficients(khepera_plausible_threshold_monitor *monitor,
        const khepera_plausible_threshold_parameters *p, real sample_time, real bandwidth)
{
    khepera_plausible_threshold_coefficients *c = &monitor->c;

    /* bandwidth*sample_time */
    const real x_ = bandwidth * sample_time;

    /* of a stage: what is left of its memory */
    const real pole = greatest(REAL(2.0) - x_, REAL(0.0)) / (x_ + REAL(2.0));

    /* w*sample_time, x or 2 */
    const real turn = REAL(2.0) * (REAL(1.0) - pole) / (pole + REAL(1.0));

    /* w of the filter 1/(1 + D/w) */
    const real w = turn / sample_time;

    /* khepera.bg:17: fe[1]*robot.m[1].el.Re/robot.m[1].el.k */
    const real t = p->fe__1 * p->robot__m__1__el__Re / p->robot__m__1__el__k;

    /* khepera.bg:17: robot.m[1].el.Re*robot.m[1].wh.fs/(robot.m[1].ge.N*robot.m[1].el.k) */
    const real t_2 = p->robot__m__1__el__Re * p->robot__m__1__wh__fs / p->robot__m__1__ge__N
            / p->robot__m__1__el__k;

    /* khepera.bg:17: R[1]*robot.m[1].el.Re/(robot.m[1].ge.N*robot.m[1].el.k) */
    const real t_3 = p->R__1 * p->robot__m__1__el__Re / p->robot__m__1__ge__N
            / p->robot__m__1__el__k;

    /* khepera.bg:17: fe[2]*robot.m[2].el.Re/robot.m[2].el.k */
    const real t_4 = p->fe__2 * p->robot__m__2__el__Re / p->robot__m__2__el__k;

    /* khepera.bg:17: robot.m[2].el.Re*robot.m[2].wh.fs/(robot.m[2].ge.N*robot.m[2].el.k) */
    const real t_5 = p->robot__m__2__el__Re * p->robot__m__2__wh__fs / p->robot__m__2__ge__N
            / p->robot__m__2__el__k;

    /* khepera.bg:17: R[2]*robot.m[2].el.Re/(robot.m[2].ge.N*robot.m[2].el.k) */
    const real t_6 = p->R__2 * p->robot__m__2__el__Re / p->robot__m__2__ge__N
            / p->robot__m__2__el__k;

    /* 1 - pole */
    const real t_7 = REAL(1.0) - pole;

    /* turn^2 */
    const real t_8 = turn * turn;

    /* khepera.bg:17: robot.m[1].el.L*robot.m[1].me.Je*w^2/robot.m[1].el.k */
    const real t_9 = p->robot__m__1__el__L * p->robot__m__1__me__Je * w * w / p->robot__m__1__el__k;

    /* khepera.bg:17: Js[1]*robot.m[1].el.L*w^2/(robot.m[1].ge.N*robot.m[1].el.k) */
    const real t_10 = p->Js__1 * p->robot__m__1__el__L * w * w / p->robot__m__1__ge__N
            / p->robot__m__1__el__k;

    /* khepera.bg:17: R[1]*robot.m[1].el.L*w/(robot.m[1].ge.N*robot.m[1].el.k) */
    const real t_11 = p->R__1 * p->robot__m__1__el__L * w / p->robot__m__1__ge__N
            / p->robot__m__1__el__k;

    /* khepera.bg:17: robot.m[2].el.L*robot.m[2].me.Je*w^2/robot.m[2].el.k */
    const real t_12 = p->robot__m__2__el__L * p->robot__m__2__me__Je * w * w
            / p->robot__m__2__el__k;

    /* khepera.bg:17: Js[2]*robot.m[2].el.L*w^2/(robot.m[2].ge.N*robot.m[2].el.k) */
    const real t_13 = p->Js__2 * p->robot__m__2__el__L * w * w / p->robot__m__2__ge__N
            / p->robot__m__2__el__k;

    /* khepera.bg:17: R[2]*robot.m[2].el.L*w/(robot.m[2].ge.N*robot.m[2].el.k) */
    const real t_14 = p->R__2 * p->robot__m__2__el__L * w / p->robot__m__2__ge__N
            / p->robot__m__2__el__k;

    /* khepera.bg:17: fe[1]*robot.m[1].el.L*w/robot.m[1].el.k */
    const real t_15 = p->fe__1 * p->robot__m__1__el__L * w / p->robot__m__1__el__k;

    /* khepera.bg:17: Js[1]*robot.m[1].el.Re*w/(robot.m[1].ge.N*robot.m[1].el.k) */
    const real t_16 = p->Js__1 * p->robot__m__1__el__Re * w / p->robot__m__1__ge__N
            / p->robot__m__1__el__k;

    /* khepera.bg:17: robot.m[1].el.Re*robot.m[1].me.Je*w/robot.m[1].el.k */
    const real t_17 = p->robot__m__1__el__Re * p->robot__m__1__me__Je * w / p->robot__m__1__el__k;

    /* khepera.bg:17: robot.m[1].el.L*robot.m[1].wh.fs*w/(robot.m[1].ge.N*robot.m[1].el.k) */
    const real t_18 = p->robot__m__1__el__L * p->robot__m__1__wh__fs * w / p->robot__m__1__ge__N
            / p->robot__m__1__el__k;

    /* khepera.bg:17: fe[2]*robot.m[2].el.L*w/robot.m[2].el.k */
    const real t_19 = p->fe__2 * p->robot__m__2__el__L * w / p->robot__m__2__el__k;

    /* khepera.bg:17: Js[2]*robot.m[2].el.Re*w/(robot.m[2].ge.N*robot.m[2].el.k) */
    const real t_20 = p->Js__2 * p->robot__m__2__el__Re * w / p->robot__m__2__ge__N
            / p->robot__m__2__el__k;

    /* khepera.bg:17: robot.m[2].el.Re*robot.m[2].me.Je*w/robot.m[2].el.k */
    const real t_21 = p->robot__m__2__el__Re * p->robot__m__2__me__Je * w / p->robot__m__2__el__k;

    /* khepera.bg:17: robot.m[2].el.L*robot.m[2].wh.fs*w/(robot.m[2].ge.N*robot.m[2].el.k) */
    const real t_22 = p->robot__m__2__el__L * p->robot__m__2__wh__fs * w / p->robot__m__2__ge__N
            / p->robot__m__2__el__k;

    /* khepera.bg:17: r1_w1: factor of robot.m[1].me.we */
    c->r1_w1_robot__m__1__me__we = t / REAL(10.0);

    /* khepera.bg:17: r1_w1: factor of robot.m[1].me.we' */
    c->r1_w1_w1_robot__m__1__me__we = t_15 / REAL(10.0);

    /* filter: 1 * (w*sample_time)^2/12 */
    c->bend1 = t_8 / REAL(12.0);

    /* filter: what is left of a memory a sample later */
    c->a = pole;

    /* filter: weight of a sample, new and a sample later */
    c->b = REAL(0.5) * t_7;

    /* filter: 1 - b, the memory of a constant 1 */
    c->rest = REAL(1.0) - REAL(0.5) * t_7;

    /* khepera.bg:17: r1_w2: factor of robot.Fx[1] */
    c->r1_w2_robot__Fx__1 = t_3 / REAL(20.0);

    /* khepera.bg:17: r1_w2: factor of robot.m[1].wh.ws */
    c->r1_w2_robot__m__1__wh__ws = t_2 / REAL(20.0);

    /* khepera.bg:17: r1_w2: factor of robot.m[1].wh.ws' */
    c->r1_w2_w1_robot__m__1__wh__ws = t_16 / REAL(20.0);

    /* khepera.bg:17: r1_w2: factor of robot.m[1].me.we */
    c->r1_w2_robot__m__1__me__we = t / REAL(20.0);

    /* khepera.bg:17: r1_w2: factor of robot.m[1].me.we' */
    c->r1_w2_w1_robot__m__1__me__we = t_17 / REAL(20.0);

    /* khepera.bg:17: r1_w3: factor of robot.m[1].me.we */
    c->r1_w3_robot__m__1__me__we = p->robot__m__1__el__k
            * (p->fe__1 * p->robot__m__1__el__Re / p->robot__m__1__el__k / p->robot__m__1__el__k
            - REAL(1.0)) / REAL(50.0);

    /* khepera.bg:17: r1_w3: factor of robot.m[1].me.we' */
    c->r1_w3_w1_robot__m__1__me__we = p->robot__m__1__el__k * w
            * (p->robot__m__1__el__Re * p->robot__m__1__me__Je / p->robot__m__1__el__k
                / p->robot__m__1__el__k
            + p->fe__1 * p->robot__m__1__el__L / p->robot__m__1__el__k / p->robot__m__1__el__k)
            / REAL(50.0);

    /* khepera.bg:17: r1_w3: factor of robot.m[1].me.we'' */
    c->r1_w3_w2_robot__m__1__me__we = t_9 / REAL(50.0);

    /* khepera.bg:17: r1_w3: factor of robot.Fx[1] */
    c->r1_w3_robot__Fx__1 = t_3 / REAL(50.0);

    /* khepera.bg:17: r1_w3: factor of robot.Fx[1]' */
    c->r1_w3_w1_robot__Fx__1 = t_11 / REAL(50.0);

    /* khepera.bg:17: r1_w3: factor of robot.m[1].wh.ws */
    c->r1_w3_robot__m__1__wh__ws = t_2 / REAL(50.0);

    /* khepera.bg:17: r1_w3: factor of robot.m[1].wh.ws' */
    c->r1_w3_w1_robot__m__1__wh__ws = p->robot__m__1__el__k * w
            * (p->Js__1 * p->robot__m__1__el__Re / p->robot__m__1__ge__N / p->robot__m__1__el__k
                / p->robot__m__1__el__k
            + p->robot__m__1__el__L * p->robot__m__1__wh__fs / p->robot__m__1__ge__N
                / p->robot__m__1__el__k / p->robot__m__1__el__k)
            / REAL(50.0);

    /* khepera.bg:17: r1_w3: factor of robot.m[1].wh.ws'' */
    c->r1_w3_w2_robot__m__1__wh__ws = t_10 / REAL(50.0);

    /* filter: 2 * (w*sample_time)^2/12 */
    c->bend2 = t_8 / REAL(6.0);

    /* khepera.bg:17: r1_w4: factor of robot.m[1].wh.ws */
    c->r1_w4_robot__m__1__wh__ws = t_2 / REAL(10.0);

    /* khepera.bg:17: r1_w4: factor of robot.m[1].wh.ws' */
    c->r1_w4_w1_robot__m__1__wh__ws = t_18 / REAL(10.0);

    /* khepera.bg:17: r1_w5: factor of robot.m[1].me.we */
    c->r1_w5_robot__m__1__me__we = t / REAL(146.0);

    /* khepera.bg:17: r1_w6: factor of robot.m[1].me.we */
    c->r1_w6_robot__m__1__me__we = t / REAL(365.0);

    /* khepera.bg:17: r1_w6: factor of robot.m[1].me.we' */
    c->r1_w6_w1_robot__m__1__me__we = t_15 / REAL(365.0);

    /* khepera.bg:17: r1_w7: factor of robot.m[1].me.we */
    c->r1_w7_robot__m__1__me__we = t / REAL(730.0);

    /* khepera.bg:17: r1_w7: factor of robot.m[1].me.we' */
    c->r1_w7_w1_robot__m__1__me__we = t_17 / REAL(730.0);

    /* khepera.bg:17: r1_w7: factor of robot.m[1].wh.ws */
    c->r1_w7_robot__m__1__wh__ws = t_2 / REAL(730.0);

    /* khepera.bg:17: r1_w7: factor of robot.m[1].wh.ws' */
    c->r1_w7_w1_robot__m__1__wh__ws = t_16 / REAL(730.0);

    /* khepera.bg:17: r1_w7: factor of robot.Fx[1] */
    c->r1_w7_robot__Fx__1 = t_3 / REAL(730.0);

    /* khepera.bg:17: r1_w8: factor of robot.m[1].wh.ws */
    c->r1_w8_robot__m__1__wh__ws = t_2 / REAL(146.0);

    /* khepera.bg:17: r1_w9: factor of robot.m[1].me.we */
    c->r1_w9_robot__m__1__me__we = t / REAL(1825.0);

    /* khepera.bg:17: r1_w9: factor of robot.m[1].me.we' */
    c->r1_w9_w1_robot__m__1__me__we = p->robot__m__1__el__k * p->robot__m__1__el__k * w
            * (-REAL(2.0) * p->fe__1 * p->robot__m__1__el__L / p->robot__m__1__el__k
                / p->robot__m__1__el__k / p->robot__m__1__el__k
            - REAL(2.0) * p->robot__m__1__el__Re * p->robot__m__1__me__Je / p->robot__m__1__el__k
                / p->robot__m__1__el__k / p->robot__m__1__el__k)
            / REAL(3650.0);

    /* khepera.bg:17: r1_w9: factor of robot.m[1].me.we'' */
    c->r1_w9_w2_robot__m__1__me__we = t_9 / REAL(1825.0);

    /* khepera.bg:17: r1_w9: factor of robot.m[1].wh.ws */
    c->r1_w9_robot__m__1__wh__ws = t_2 / REAL(1825.0);

    /* khepera.bg:17: r1_w9: factor of robot.m[1].wh.ws' */
    c->r1_w9_w1_robot__m__1__wh__ws = p->robot__m__1__el__k * p->robot__m__1__el__k * w
            * (-REAL(2.0) * p->robot__m__1__el__L * p->robot__m__1__wh__fs / p->robot__m__1__ge__N
                / p->robot__m__1__el__k / p->robot__m__1__el__k / p->robot__m__1__el__k
            - REAL(2.0) * p->Js__1 * p->robot__m__1__el__Re / p->robot__m__1__ge__N
                / p->robot__m__1__el__k / p->robot__m__1__el__k / p->robot__m__1__el__k)
            / REAL(3650.0);

    /* khepera.bg:17: r1_w9: factor of robot.m[1].wh.ws'' */
    c->r1_w9_w2_robot__m__1__wh__ws = t_10 / REAL(1825.0);

    /* khepera.bg:17: r1_w9: factor of robot.Fx[1] */
    c->r1_w9_robot__Fx__1 = t_3 / REAL(1825.0);

    /* khepera.bg:17: r1_w9: factor of robot.Fx[1]' */
    c->r1_w9_w1_robot__Fx__1 = t_11 / REAL(1825.0);

    /* khepera.bg:17: r1_w10: factor of robot.m[1].wh.ws */
    c->r1_w10_robot__m__1__wh__ws = t_2 / REAL(365.0);

    /* khepera.bg:17: r1_w10: factor of robot.m[1].wh.ws' */
    c->r1_w10_w1_robot__m__1__wh__ws = t_18 / REAL(365.0);

    /* khepera.bg:41: r2_w1: factor of robot.m[1].wh.ws' */
    c->r2_w1_w1_robot__m__1__wh__ws = p->robot__m__1__wh__fs * w / REAL(10.0)
            / p->robot__m__1__ge__N / p->robot__m__1__me__K;

    /* khepera.bg:17: r3_w1: factor of robot.m[2].me.we */
    c->r3_w1_robot__m__2__me__we = t_4 / REAL(10.0);

    /* khepera.bg:17: r3_w1: factor of robot.m[2].me.we' */
    c->r3_w1_w1_robot__m__2__me__we = t_19 / REAL(10.0);

    /* khepera.bg:17: r3_w2: factor of robot.Fx[2] */
    c->r3_w2_robot__Fx__2 = t_6 / REAL(20.0);

    /* khepera.bg:17: r3_w2: factor of robot.m[2].wh.ws */
    c->r3_w2_robot__m__2__wh__ws = t_5 / REAL(20.0);

    /* khepera.bg:17: r3_w2: factor of robot.m[2].wh.ws' */
    c->r3_w2_w1_robot__m__2__wh__ws = t_20 / REAL(20.0);

    /* khepera.bg:17: r3_w2: factor of robot.m[2].me.we */
    c->r3_w2_robot__m__2__me__we = t_4 / REAL(20.0);

    /* khepera.bg:17: r3_w2: factor of robot.m[2].me.we' */
    c->r3_w2_w1_robot__m__2__me__we = t_21 / REAL(20.0);

    /* khepera.bg:17: r3_w3: factor of robot.m[2].me.we */
    c->r3_w3_robot__m__2__me__we = p->robot__m__2__el__k
            * (p->fe__2 * p->robot__m__2__el__Re / p->robot__m__2__el__k / p->robot__m__2__el__k
            - REAL(1.0)) / REAL(50.0);

    /* khepera.bg:17: r3_w3: factor of robot.m[2].me.we' */
    c->r3_w3_w1_robot__m__2__me__we = p->robot__m__2__el__k * w
            * (p->robot__m__2__el__Re * p->robot__m__2__me__Je / p->robot__m__2__el__k
                / p->robot__m__2__el__k
            + p->fe__2 * p->robot__m__2__el__L / p->robot__m__2__el__k / p->robot__m__2__el__k)
            / REAL(50.0);

    /* khepera.bg:17: r3_w3: factor of robot.m[2].me.we'' */
    c->r3_w3_w2_robot__m__2__me__we = t_12 / REAL(50.0);

    /* khepera.bg:17: r3_w3: factor of robot.Fx[2] */
    c->r3_w3_robot__Fx__2 = t_6 / REAL(50.0);

    /* khepera.bg:17: r3_w3: factor of robot.Fx[2]' */
    c->r3_w3_w1_robot__Fx__2 = t_14 / REAL(50.0);

    /* khepera.bg:17: r3_w3: factor of robot.m[2].wh.ws */
    c->r3_w3_robot__m__2__wh__ws = t_5 / REAL(50.0);

    /* khepera.bg:17: r3_w3: factor of robot.m[2].wh.ws' */
    c->r3_w3_w1_robot__m__2__wh__ws = p->robot__m__2__el__k * w
            * (p->Js__2 * p->robot__m__2__el__Re / p->robot__m__2__ge__N / p->robot__m__2__el__k
                / p->robot__m__2__el__k
            + p->robot__m__2__el__L * p->robot__m__2__wh__fs / p->robot__m__2__ge__N
                / p->robot__m__2__el__k / p->robot__m__2__el__k)
            / REAL(50.0);

    /* khepera.bg:17: r3_w3: factor of robot.m[2].wh.ws'' */
    c->r3_w3_w2_robot__m__2__wh__ws = t_13 / REAL(50.0);

    /* khepera.bg:17: r3_w4: factor of robot.m[2].wh.ws */
    c->r3_w4_robot__m__2__wh__ws = t_5 / REAL(10.0);

    /* khepera.bg:17: r3_w4: factor of robot.m[2].wh.ws' */
    c->r3_w4_w1_robot__m__2__wh__ws = t_22 / REAL(10.0);

    /* khepera.bg:17: r3_w5: factor of robot.m[2].me.we */
    c->r3_w5_robot__m__2__me__we = t_4 / REAL(146.0);

    /* khepera.bg:17: r3_w6: factor of robot.m[2].me.we */
    c->r3_w6_robot__m__2__me__we = t_4 / REAL(365.0);

    /* khepera.bg:17: r3_w6: factor of robot.m[2].me.we' */
    c->r3_w6_w1_robot__m__2__me__we = t_19 / REAL(365.0);

    /* khepera.bg:17: r3_w7: factor of robot.m[2].me.we */
    c->r3_w7_robot__m__2__me__we = t_4 / REAL(730.0);

    /* khepera.bg:17: r3_w7: factor of robot.m[2].me.we' */
    c->r3_w7_w1_robot__m__2__me__we = t_21 / REAL(730.0);

    /* khepera.bg:17: r3_w7: factor of robot.m[2].wh.ws */
    c->r3_w7_robot__m__2__wh__ws = t_5 / REAL(730.0);

    /* khepera.bg:17: r3_w7: factor of robot.m[2].wh.ws' */
    c->r3_w7_w1_robot__m__2__wh__ws = t_20 / REAL(730.0);

    /* khepera.bg:17: r3_w7: factor of robot.Fx[2] */
    c->r3_w7_robot__Fx__2 = t_6 / REAL(730.0);

    /* khepera.bg:17: r3_w8: factor of robot.m[2].wh.ws */
    c->r3_w8_robot__m__2__wh__ws = t_5 / REAL(146.0);

    /* khepera.bg:17: r3_w9: factor of robot.m[2].me.we */
    c->r3_w9_robot__m__2__me__we = t_4 / REAL(1825.0);

    /* khepera.bg:17: r3_w9: factor of robot.m[2].me.we' */
    c->r3_w9_w1_robot__m__2__me__we = p->robot__m__2__el__k * p->robot__m__2__el__k * w
            * (-REAL(2.0) * p->fe__2 * p->robot__m__2__el__L / p->robot__m__2__el__k
                / p->robot__m__2__el__k / p->robot__m__2__el__k
            - REAL(2.0) * p->robot__m__2__el__Re * p->robot__m__2__me__Je / p->robot__m__2__el__k
                / p->robot__m__2__el__k / p->robot__m__2__el__k)
            / REAL(3650.0);

    /* khepera.bg:17: r3_w9: factor of robot.m[2].me.we'' */
    c->r3_w9_w2_robot__m__2__me__we = t_12 / REAL(1825.0);

    /* khepera.bg:17: r3_w9: factor of robot.m[2].wh.ws */
    c->r3_w9_robot__m__2__wh__ws = t_5 / REAL(1825.0);

    /* khepera.bg:17: r3_w9: factor of robot.m[2].wh.ws' */
    c->r3_w9_w1_robot__m__2__wh__ws = p->robot__m__2__el__k * p->robot__m__2__el__k * w
            * (-REAL(2.0) * p->robot__m__2__el__L * p->robot__m__2__wh__fs / p->robot__m__2__ge__N
                / p->robot__m__2__el__k / p->robot__m__2__el__k / p->robot__m__2__el__k
            - REAL(2.0) * p->Js__2 * p->robot__m__2__el__Re / p->robot__m__2__ge__N
                / p->robot__m__2__el__k / p->robot__m__2__el__k / p->robot__m__2__el__k)
            / REAL(3650.0);

    /* khepera.bg:17: r3_w9: factor of robot.m[2].wh.ws'' */
    c->r3_w9_w2_robot__m__2__wh__ws = t_13 / REAL(1825.0);

    /* khepera.bg:17: r3_w9: factor of robot.Fx[2] */
    c->r3_w9_robot__Fx__2 = t_6 / REAL(1825.0);

    /* khepera.bg:17: r3_w9: factor of robot.Fx[2]' */
    c->r3_w9_w1_robot__Fx__2 = t_14 / REAL(1825.0);

    /* khepera.bg:17: r3_w10: factor of robot.m[2].wh.ws */
    c->r3_w10_robot__m__2__wh__ws = t_5 / REAL(365.0);

    /* khepera.bg:17: r3_w10: factor of robot.m[2].wh.ws' */
    c->r3_w10_w1_robot__m__2__wh__ws = t_22 / REAL(365.0);

    /* khepera.bg:41: r4_w1: factor of robot.m[2].wh.ws' */
    c->r4_w1_w1_robot__m__2__wh__ws = p->robot__m__2__wh__fs * w / REAL(10.0)
            / p->robot__m__2__ge__N / p->robot__m__2__me__K;
}

static bool parameters_are_finite(const khepera_plausible_threshold_parameters *p)
{
    return finite_number(p->Js__1 + p->Js__2 + p->fe__1 + p->fe__2 + p->R__1 + p->R__2
            + p->robot__m__1__el__L + p->robot__m__1__el__Re + p->robot__m__1__el__k
            + p->robot__m__1__me__Je + p->robot__m__1__me__K + p->robot__m__1__ge__N
            + p->robot__m__1__wh__fs + p->robot__m__2__el__L + p->robot__m__2__el__Re
            + p->robot__m__2__el__k + p->robot__m__2__me__Je + p->robot__m__2__me__K
            + p->robot__m__2__ge__N + p->robot__m__2__wh__fs);
}

static bool coefficients_are_finite(const khepera_plausible_threshold_monitor *monitor)
{
    return finite_number(monitor->c.r1_w1_robot__m__1__me__we
            + monitor->c.r1_w1_w1_robot__m__1__me__we + monitor->c.bend1 + monitor->c.a
            + monitor->c.b + monitor->c.rest + monitor->c.r1_w2_robot__Fx__1
            + monitor->c.r1_w2_robot__m__1__wh__ws + monitor->c.r1_w2_w1_robot__m__1__wh__ws
            + monitor->c.r1_w2_robot__m__1__me__we + monitor->c.r1_w2_w1_robot__m__1__me__we
            + monitor->c.r1_w3_robot__m__1__me__we + monitor->c.r1_w3_w1_robot__m__1__me__we
            + monitor->c.r1_w3_w2_robot__m__1__me__we + monitor->c.r1_w3_robot__Fx__1
            + monitor->c.r1_w3_w1_robot__Fx__1 + monitor->c.r1_w3_robot__m__1__wh__ws
            + monitor->c.r1_w3_w1_robot__m__1__wh__ws + monitor->c.r1_w3_w2_robot__m__1__wh__ws
            + monitor->c.bend2 + monitor->c.r1_w4_robot__m__1__wh__ws
            + monitor->c.r1_w4_w1_robot__m__1__wh__ws + monitor->c.r1_w5_robot__m__1__me__we
            + monitor->c.r1_w6_robot__m__1__me__we + monitor->c.r1_w6_w1_robot__m__1__me__we
            + monitor->c.r1_w7_robot__m__1__me__we + monitor->c.r1_w7_w1_robot__m__1__me__we
            + monitor->c.r1_w7_robot__m__1__wh__ws + monitor->c.r1_w7_w1_robot__m__1__wh__ws
            + monitor->c.r1_w7_robot__Fx__1 + monitor->c.r1_w8_robot__m__1__wh__ws
            + monitor->c.r1_w9_robot__m__1__me__we + monitor->c.r1_w9_w1_robot__m__1__me__we
            + monitor->c.r1_w9_w2_robot__m__1__me__we + monitor->c.r1_w9_robot__m__1__wh__ws
            + monitor->c.r1_w9_w1_robot__m__1__wh__ws + monitor->c.r1_w9_w2_robot__m__1__wh__ws
            + monitor->c.r1_w9_robot__Fx__1 + monitor->c.r1_w9_w1_robot__Fx__1
            + monitor->c.r1_w10_robot__m__1__wh__ws + monitor->c.r1_w10_w1_robot__m__1__wh__ws
            + monitor->c.r2_w1_w1_robot__m__1__wh__ws + monitor->c.r3_w1_robot__m__2__me__we
            + monitor->c.r3_w1_w1_robot__m__2__me__we + monitor->c.r3_w2_robot__Fx__2
            + monitor->c.r3_w2_robot__m__2__wh__ws + monitor->c.r3_w2_w1_robot__m__2__wh__ws
            + monitor->c.r3_w2_robot__m__2__me__we + monitor->c.r3_w2_w1_robot__m__2__me__we
            + monitor->c.r3_w3_robot__m__2__me__we + monitor->c.r3_w3_w1_robot__m__2__me__we
            + monitor->c.r3_w3_w2_robot__m__2__me__we + monitor->c.r3_w3_robot__Fx__2
            + monitor->c.r3_w3_w1_robot__Fx__2 + monitor->c.r3_w3_robot__m__2__wh__ws
            + monitor->c.r3_w3_w1_robot__m__2__wh__ws + monitor->c.r3_w3_w2_robot__m__2__wh__ws
            + monitor->c.r3_w4_robot__m__2__wh__ws + monitor->c.r3_w4_w1_robot__m__2__wh__ws
            + monitor->c.r3_w5_robot__m__2__me__we + monitor->c.r3_w6_robot__m__2__me__we
            + monitor->c.r3_w6_w1_robot__m__2__me__we + monitor->c.r3_w7_robot__m__2__me__we
            + monitor->c.r3_w7_w1_robot__m__2__me__we + monitor->c.r3_w7_robot__m__2__wh__ws
            + monitor->c.r3_w7_w1_robot__m__2__wh__ws + monitor->c.r3_w7_robot__Fx__2
            + monitor->c.r3_w8_robot__m__2__wh__ws + monitor->c.r3_w9_robot__m__2__me__we
            + monitor->c.r3_w9_w1_robot__m__2__me__we + monitor->c.r3_w9_w2_robot__m__2__me__we
            + monitor->c.r3_w9_robot__m__2__wh__ws + monitor->c.r3_w9_w1_robot__m__2__wh__ws
            + monitor->c.r3_w9_w2_robot__m__2__wh__ws + monitor->c.r3_w9_robot__Fx__2
            + monitor->c.r3_w9_w1_robot__Fx__2 + monitor->c.r3_w10_robot__m__2__wh__ws
            + monitor->c.r3_w10_w1_robot__m__2__wh__ws + monitor->c.r4_w1_w1_robot__m__2__wh__ws);
}

/* Samples until `constants` time constants of the filter are over. */
static uint32_t samples(real constants, real sample_time, real bandwidth)
{
    const real wait = constants / (bandwidth * sample_time);
    const uint32_t whole = wait < REAL(4.0e9) ? (uint32_t)wait : UINT32_MAX - 1u;

    return (real)whole < wait ? whole + 1u : whole;
}

khepera_plausible_threshold_status khepera_plausible_threshold_configure(
    khepera_plausible_threshold_monitor *monitor,
    const khepera_plausible_threshold_parameters *parameters,
    khepera_plausible_threshold_real sample_time,
    khepera_plausible_threshold_real bandwidth,
    khepera_plausible_threshold_real time_unit)
{
    int k;

    for (k = 0; k < KHEPERA_PLAUSIBLE_THRESHOLD_RESIDUALS; ++k) {
        monitor->settle[k] = UINT32_MAX;
    }
    khepera_plausible_threshold_reset(monitor);
    if (!parameters_are_finite(parameters)) {
        return KHEPERA_PLAUSIBLE_THRESHOLD_BAD_PARAMETER;
    }
    if (!(sample_time >= REAL(0.000999999)) || !finite_number(sample_time)) {
        return KHEPERA_PLAUSIBLE_THRESHOLD_BAD_SAMPLE_TIME;
    }
    if (!(bandwidth * sample_time >= SLOWEST && bandwidth * sample_time <= REAL(3.0))) {
        return KHEPERA_PLAUSIBLE_THRESHOLD_BAD_BANDWIDTH;
    }
    if (!(time_unit > REAL(0.0)) || !finite_number(time_unit)) {
        return KHEPERA_PLAUSIBLE_THRESHOLD_BAD_TIME_UNIT;
    }
    compute_coefficients(monitor, parameters, sample_time, bandwidth);
    if (!coefficients_are_finite(monitor)) {
        return KHEPERA_PLAUSIBLE_THRESHOLD_BAD_COEFFICIENT;
    }
    monitor->settle[KHEPERA_PLAUSIBLE_THRESHOLD_R1] =
        samples(REAL(11.228872242412663), sample_time, bandwidth);
    monitor->settle[KHEPERA_PLAUSIBLE_THRESHOLD_R2] =
        samples(REAL(11.228872242412663), sample_time, bandwidth);
    monitor->settle[KHEPERA_PLAUSIBLE_THRESHOLD_R3] =
        samples(REAL(11.228872242412663), sample_time, bandwidth);
    monitor->settle[KHEPERA_PLAUSIBLE_THRESHOLD_R4] =
        samples(REAL(11.228872242412663), sample_time, bandwidth);
    monitor->settle[KHEPERA_PLAUSIBLE_THRESHOLD_R5] =
        samples(REAL(6.907755278982138), sample_time, bandwidth);
    return KHEPERA_PLAUSIBLE_THRESHOLD_OK;
}

void khepera_plausible_threshold_exact(
    const khepera_plausible_threshold_monitor *monitor,
    const khepera_plausible_threshold_derivatives *derivatives,
    khepera_plausible_threshold_real residuals[KHEPERA_PLAUSIBLE_THRESHOLD_RESIDUALS])
{
    real *r = residuals;

    (void)monitor;
    (void)derivatives;

    /* khepera.bg:17: r1: a threshold is made of filtered signals, only step has it */
    r[KHEPERA_PLAUSIBLE_THRESHOLD_R1] = (real)NAN;

    /* khepera.bg:41: r2: a threshold is made of filtered signals, only step has it */
    r[KHEPERA_PLAUSIBLE_THRESHOLD_R2] = (real)NAN;

    /* khepera.bg:17: r3: a threshold is made of filtered signals, only step has it */
    r[KHEPERA_PLAUSIBLE_THRESHOLD_R3] = (real)NAN;

    /* khepera.bg:41: r4: a threshold is made of filtered signals, only step has it */
    r[KHEPERA_PLAUSIBLE_THRESHOLD_R4] = (real)NAN;

    /* khepera.bg:114: r5: a threshold is made of filtered signals, only step has it */
    r[KHEPERA_PLAUSIBLE_THRESHOLD_R5] = (real)NAN;
}

/* r1 on its first sample: the filter as if it had always been so. */
static void start_r1(
    khepera_plausible_threshold_monitor *monitor, const khepera_plausible_threshold_samples *s, real *r)
{
    const khepera_plausible_threshold_coefficients *c = &monitor->c;
    khepera_plausible_threshold_memory *x = &monitor->x;

    /* khepera.bg:17: r1_w1: terms of order 0 */
    const real r1_w1_g0 = -c->r1_w1_robot__m__1__me__we * s->robot__m__1__me__we;

    /* khepera.bg:17: r1_w1: degree 1 */
    const real r1_w1_d1 = c->r1_w1_w1_robot__m__1__me__we * s->robot__m__1__me__we;

    /* khepera.bg:17: r1_w1: error of order 0 */
    const real r1_w1_e0 = c->bend1 * r1_w1_g0;

    /* khepera.bg:17: r1_w1: input of stage 3 */
    const real r1_w1_u3 = r1_w1_g0 + r1_w1_d1 - r1_w1_e0;

    /* khepera.bg:17: r1_w1: stage 3, at rest */
    const real r1_w1_y3 = r1_w1_u3;

    /* khepera.bg:17: r1_w1: stage 3: memory */
    x->r1_w1_s3 = c->rest * r1_w1_u3;

    /* khepera.bg:17: r1_w1: input of stage 2 */
    const real r1_w1_u2 = r1_w1_y3 + REAL(2.0) * r1_w1_e0 - r1_w1_d1;

    /* khepera.bg:17: r1_w1: stage 2, at rest */
    const real r1_w1_y2 = r1_w1_u2;

    /* khepera.bg:17: r1_w1: stage 2: memory */
    x->r1_w1_s2 = c->rest * r1_w1_u2;

    /* khepera.bg:17: r1_w1: input of stage 1 */
    const real r1_w1_u1 = r1_w1_y2 - r1_w1_e0;

    /* khepera.bg:17: r1_w1: stage 1, at rest */
    const real r1_w1_y1 = r1_w1_u1;

    /* khepera.bg:17: r1_w1: stage 1: memory */
    x->r1_w1_s1 = c->rest * r1_w1_u1;

    /* khepera.bg:17: r1: what the tolerance of fe[1] can do */
    const real r1_w1 = r1_w1_y1;

    /* khepera.bg:17: r1_w2: terms of order 0 */
    const real r1_w2_g0 = -c->r1_w2_robot__Fx__1 * s->robot__Fx__1
        - c->r1_w2_robot__m__1__wh__ws * s->robot__m__1__wh__ws
        - c->r1_w2_robot__m__1__me__we * s->robot__m__1__me__we;

    /* khepera.bg:17: r1_w2: degree 1 */
    const real r1_w2_d1 = -c->r1_w2_w1_robot__m__1__wh__ws * s->robot__m__1__wh__ws
        - c->r1_w2_w1_robot__m__1__me__we * s->robot__m__1__me__we;

    /* khepera.bg:17: r1_w2: error of order 0 */
    const real r1_w2_e0 = c->bend1 * r1_w2_g0;

    /* khepera.bg:17: r1_w2: input of stage 3 */
    const real r1_w2_u3 = r1_w2_g0 - r1_w2_d1 - r1_w2_e0;

    /* khepera.bg:17: r1_w2: stage 3, at rest */
    const real r1_w2_y3 = r1_w2_u3;

    /* khepera.bg:17: r1_w2: stage 3: memory */
    x->r1_w2_s3 = c->rest * r1_w2_u3;

    /* khepera.bg:17: r1_w2: input of stage 2 */
    const real r1_w2_u2 = r1_w2_y3 + r1_w2_d1 + REAL(2.0) * r1_w2_e0;

    /* khepera.bg:17: r1_w2: stage 2, at rest */
    const real r1_w2_y2 = r1_w2_u2;

    /* khepera.bg:17: r1_w2: stage 2: memory */
    x->r1_w2_s2 = c->rest * r1_w2_u2;

    /* khepera.bg:17: r1_w2: input of stage 1 */
    const real r1_w2_u1 = r1_w2_y2 - r1_w2_e0;

    /* khepera.bg:17: r1_w2: stage 1, at rest */
    const real r1_w2_y1 = r1_w2_u1;

    /* khepera.bg:17: r1_w2: stage 1: memory */
    x->r1_w2_s1 = c->rest * r1_w2_u1;

    /* khepera.bg:17: r1: what the tolerance of robot.m[1].el.Re can do */
    const real r1_w2 = r1_w2_y1;

    /* khepera.bg:17: r1_w3: terms of order 0 */
    const real r1_w3_g0 = c->r1_w3_robot__m__1__me__we * s->robot__m__1__me__we
        + c->r1_w3_robot__Fx__1 * s->robot__Fx__1
        + c->r1_w3_robot__m__1__wh__ws * s->robot__m__1__wh__ws;

    /* khepera.bg:17: r1_w3: terms of order 1 */
    const real r1_w3_g1 = c->r1_w3_w1_robot__m__1__me__we * s->robot__m__1__me__we
        + c->r1_w3_w1_robot__Fx__1 * s->robot__Fx__1
        + c->r1_w3_w1_robot__m__1__wh__ws * s->robot__m__1__wh__ws;

    /* khepera.bg:17: r1_w3: error of order 0 */
    const real r1_w3_e0 = c->bend2 * r1_w3_g0;

    /* khepera.bg:17: r1_w3: degree 2 */
    const real r1_w3_d2 = c->r1_w3_w2_robot__m__1__me__we * s->robot__m__1__me__we
        + c->r1_w3_w2_robot__m__1__wh__ws * s->robot__m__1__wh__ws - r1_w3_e0;

    /* khepera.bg:17: r1_w3: error of order 1 */
    const real r1_w3_e1 = c->bend1 * r1_w3_g1;

    /* khepera.bg:17: r1_w3: input of stage 3 */
    const real r1_w3_u3 = r1_w3_g0 + r1_w3_d2 + r1_w3_e1 - r1_w3_g1;

    /* khepera.bg:17: r1_w3: stage 3, at rest */
    const real r1_w3_y3 = r1_w3_u3;

    /* khepera.bg:17: r1_w3: stage 3: memory */
    x->r1_w3_s3 = c->rest * r1_w3_u3;

    /* khepera.bg:17: r1_w3: input of stage 2 */
    const real r1_w3_u2 = r1_w3_y3 + r1_w3_g1 - REAL(2.0) * r1_w3_d2 - REAL(3.0) * r1_w3_e1;

    /* khepera.bg:17: r1_w3: stage 2, at rest */
    const real r1_w3_y2 = r1_w3_u2;

    /* khepera.bg:17: r1_w3: stage 2: memory */
    x->r1_w3_s2 = c->rest * r1_w3_u2;

    /* khepera.bg:17: r1_w3: input of stage 1 */
    const real r1_w3_u1 = r1_w3_y2 + r1_w3_d2 + REAL(3.0) * r1_w3_e1;

    /* khepera.bg:17: r1_w3: stage 1, at rest */
    const real r1_w3_y1 = r1_w3_u1;

    /* khepera.bg:17: r1_w3: stage 1: memory */
    x->r1_w3_s1 = c->rest * r1_w3_u1;

    /* khepera.bg:17: r1: what the tolerance of robot.m[1].el.k can do */
    const real r1_w3 = r1_w3_y1 - r1_w3_e1;

    /* khepera.bg:17: r1_w4: terms of order 0 */
    const real r1_w4_g0 = -c->r1_w4_robot__m__1__wh__ws * s->robot__m__1__wh__ws;

    /* khepera.bg:17: r1_w4: degree 1 */
    const real r1_w4_d1 = c->r1_w4_w1_robot__m__1__wh__ws * s->robot__m__1__wh__ws;

    /* khepera.bg:17: r1_w4: error of order 0 */
    const real r1_w4_e0 = c->bend1 * r1_w4_g0;

    /* khepera.bg:17: r1_w4: input of stage 3 */
    const real r1_w4_u3 = r1_w4_g0 + r1_w4_d1 - r1_w4_e0;

    /* khepera.bg:17: r1_w4: stage 3, at rest */
    const real r1_w4_y3 = r1_w4_u3;

    /* khepera.bg:17: r1_w4: stage 3: memory */
    x->r1_w4_s3 = c->rest * r1_w4_u3;

    /* khepera.bg:17: r1_w4: input of stage 2 */
    const real r1_w4_u2 = r1_w4_y3 + REAL(2.0) * r1_w4_e0 - r1_w4_d1;

    /* khepera.bg:17: r1_w4: stage 2, at rest */
    const real r1_w4_y2 = r1_w4_u2;

    /* khepera.bg:17: r1_w4: stage 2: memory */
    x->r1_w4_s2 = c->rest * r1_w4_u2;

    /* khepera.bg:17: r1_w4: input of stage 1 */
    const real r1_w4_u1 = r1_w4_y2 - r1_w4_e0;

    /* khepera.bg:17: r1_w4: stage 1, at rest */
    const real r1_w4_y1 = r1_w4_u1;

    /* khepera.bg:17: r1_w4: stage 1: memory */
    x->r1_w4_s1 = c->rest * r1_w4_u1;

    /* khepera.bg:17: r1: what the tolerance of robot.m[1].wh.fs can do */
    const real r1_w4 = r1_w4_y1;

    /* khepera.bg:17: r1_w5: input of stage 3 */
    const real r1_w5_u3 = -c->r1_w5_robot__m__1__me__we * s->robot__m__1__me__we;

    /* khepera.bg:17: r1_w5: stage 3, at rest */
    const real r1_w5_y3 = r1_w5_u3;

    /* khepera.bg:17: r1_w5: stage 3: memory */
    x->r1_w5_s3 = c->rest * r1_w5_u3;

    /* khepera.bg:17: r1_w5: input of stage 2 */
    const real r1_w5_u2 = r1_w5_y3;

    /* khepera.bg:17: r1_w5: stage 2, at rest */
    const real r1_w5_y2 = r1_w5_u2;

    /* khepera.bg:17: r1_w5: stage 2: memory */
    x->r1_w5_s2 = c->rest * r1_w5_u2;

    /* khepera.bg:17: r1_w5: input of stage 1 */
    const real r1_w5_u1 = r1_w5_y2;

    /* khepera.bg:17: r1_w5: stage 1, at rest */
    const real r1_w5_y1 = r1_w5_u1;

    /* khepera.bg:17: r1_w5: stage 1: memory */
    x->r1_w5_s1 = c->rest * r1_w5_u1;

    /* khepera.bg:17: r1: what the tolerances of fe[1] and robot.m[1].el.Re can do together */
    const real r1_w5 = r1_w5_y1;

    /* khepera.bg:17: r1_w6: terms of order 0 */
    const real r1_w6_g0 = c->r1_w6_robot__m__1__me__we * s->robot__m__1__me__we;

    /* khepera.bg:17: r1_w6: degree 1 */
    const real r1_w6_d1 = c->r1_w6_w1_robot__m__1__me__we * s->robot__m__1__me__we;

    /* khepera.bg:17: r1_w6: error of order 0 */
    const real r1_w6_e0 = c->bend1 * r1_w6_g0;

    /* khepera.bg:17: r1_w6: input of stage 3 */
    const real r1_w6_u3 = r1_w6_g0 - r1_w6_d1 - r1_w6_e0;

    /* khepera.bg:17: r1_w6: stage 3, at rest */
    const real r1_w6_y3 = r1_w6_u3;

    /* khepera.bg:17: r1_w6: stage 3: memory */
    x->r1_w6_s3 = c->rest * r1_w6_u3;

    /* khepera.bg:17: r1_w6: input of stage 2 */
    const real r1_w6_u2 = r1_w6_y3 + r1_w6_d1 + REAL(2.0) * r1_w6_e0;

    /* khepera.bg:17: r1_w6: stage 2, at rest */
    const real r1_w6_y2 = r1_w6_u2;

    /* khepera.bg:17: r1_w6: stage 2: memory */
    x->r1_w6_s2 = c->rest * r1_w6_u2;

    /* khepera.bg:17: r1_w6: input of stage 1 */
    const real r1_w6_u1 = r1_w6_y2 - r1_w6_e0;

    /* khepera.bg:17: r1_w6: stage 1, at rest */
    const real r1_w6_y1 = r1_w6_u1;

    /* khepera.bg:17: r1_w6: stage 1: memory */
    x->r1_w6_s1 = c->rest * r1_w6_u1;

    /* khepera.bg:17: r1: what the tolerances of fe[1] and robot.m[1].el.k can do together */
    const real r1_w6 = r1_w6_y1;

    /* khepera.bg:17: r1_w7: terms of order 0 */
    const real r1_w7_g0 = c->r1_w7_robot__m__1__me__we * s->robot__m__1__me__we
        + c->r1_w7_robot__m__1__wh__ws * s->robot__m__1__wh__ws
        + c->r1_w7_robot__Fx__1 * s->robot__Fx__1;

    /* khepera.bg:17: r1_w7: degree 1 */
    const real r1_w7_d1 = c->r1_w7_w1_robot__m__1__me__we * s->robot__m__1__me__we
        + c->r1_w7_w1_robot__m__1__wh__ws * s->robot__m__1__wh__ws;

    /* khepera.bg:17: r1_w7: error of order 0 */
    const real r1_w7_e0 = c->bend1 * r1_w7_g0;

    /* khepera.bg:17: r1_w7: input of stage 3 */
    const real r1_w7_u3 = r1_w7_g0 - r1_w7_d1 - r1_w7_e0;

    /* khepera.bg:17: r1_w7: stage 3, at rest */
    const real r1_w7_y3 = r1_w7_u3;

    /* khepera.bg:17: r1_w7: stage 3: memory */
    x->r1_w7_s3 = c->rest * r1_w7_u3;

    /* khepera.bg:17: r1_w7: input of stage 2 */
    const real r1_w7_u2 = r1_w7_y3 + r1_w7_d1 + REAL(2.0) * r1_w7_e0;

    /* khepera.bg:17: r1_w7: stage 2, at rest */
    const real r1_w7_y2 = r1_w7_u2;

    /* khepera.bg:17: r1_w7: stage 2: memory */
    x->r1_w7_s2 = c->rest * r1_w7_u2;

    /* khepera.bg:17: r1_w7: input of stage 1 */
    const real r1_w7_u1 = r1_w7_y2 - r1_w7_e0;

    /* khepera.bg:17: r1_w7: stage 1, at rest */
    const real r1_w7_y1 = r1_w7_u1;

    /* khepera.bg:17: r1_w7: stage 1: memory */
    x->r1_w7_s1 = c->rest * r1_w7_u1;

    /* khepera.bg:17: r1: what the tolerances of robot.m[1].el.Re and robot.m[1].el.k can do
     * together */
    const real r1_w7 = r1_w7_y1;

    /* khepera.bg:17: r1_w8: input of stage 3 */
    const real r1_w8_u3 = -c->r1_w8_robot__m__1__wh__ws * s->robot__m__1__wh__ws;

    /* khepera.bg:17: r1_w8: stage 3, at rest */
    const real r1_w8_y3 = r1_w8_u3;

    /* khepera.bg:17: r1_w8: stage 3: memory */
    x->r1_w8_s3 = c->rest * r1_w8_u3;

    /* khepera.bg:17: r1_w8: input of stage 2 */
    const real r1_w8_u2 = r1_w8_y3;

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

    /* khepera.bg:17: r1: what the tolerances of robot.m[1].el.Re and robot.m[1].wh.fs can do
     * together */
    const real r1_w8 = r1_w8_y1;

    /* khepera.bg:17: r1_w9: terms of order 0 */
    const real r1_w9_g0 = -c->r1_w9_robot__m__1__me__we * s->robot__m__1__me__we
        - c->r1_w9_robot__m__1__wh__ws * s->robot__m__1__wh__ws
        - c->r1_w9_robot__Fx__1 * s->robot__Fx__1;

    /* khepera.bg:17: r1_w9: terms of order 1 */
    const real r1_w9_g1 = c->r1_w9_w1_robot__m__1__me__we * s->robot__m__1__me__we
        + c->r1_w9_w1_robot__m__1__wh__ws * s->robot__m__1__wh__ws
        - c->r1_w9_w1_robot__Fx__1 * s->robot__Fx__1;

    /* khepera.bg:17: r1_w9: error of order 0 */
    const real r1_w9_e0 = c->bend2 * r1_w9_g0;

    /* khepera.bg:17: r1_w9: degree 2 */
    const real r1_w9_d2 = -c->r1_w9_w2_robot__m__1__me__we * s->robot__m__1__me__we
        - c->r1_w9_w2_robot__m__1__wh__ws * s->robot__m__1__wh__ws - r1_w9_e0;

    /* khepera.bg:17: r1_w9: error of order 1 */
    const real r1_w9_e1 = c->bend1 * r1_w9_g1;

    /* khepera.bg:17: r1_w9: input of stage 3 */
    const real r1_w9_u3 = r1_w9_g0 + r1_w9_d2 + r1_w9_e1 - r1_w9_g1;

    /* khepera.bg:17: r1_w9: stage 3, at rest */
    const real r1_w9_y3 = r1_w9_u3;

    /* khepera.bg:17: r1_w9: stage 3: memory */
    x->r1_w9_s3 = c->rest * r1_w9_u3;

    /* khepera.bg:17: r1_w9: input of stage 2 */
    const real r1_w9_u2 = r1_w9_y3 + r1_w9_g1 - REAL(2.0) * r1_w9_d2 - REAL(3.0) * r1_w9_e1;

    /* khepera.bg:17: r1_w9: stage 2, at rest */
    const real r1_w9_y2 = r1_w9_u2;

    /* khepera.bg:17: r1_w9: stage 2: memory */
    x->r1_w9_s2 = c->rest * r1_w9_u2;

    /* khepera.bg:17: r1_w9: input of stage 1 */
    const real r1_w9_u1 = r1_w9_y2 + r1_w9_d2 + REAL(3.0) * r1_w9_e1;

    /* khepera.bg:17: r1_w9: stage 1, at rest */
    const real r1_w9_y1 = r1_w9_u1;

    /* khepera.bg:17: r1_w9: stage 1: memory */
    x->r1_w9_s1 = c->rest * r1_w9_u1;

    /* khepera.bg:17: r1: second order of what the tolerance of robot.m[1].el.k can do */
    const real r1_w9 = r1_w9_y1 - r1_w9_e1;

    /* khepera.bg:17: r1_w10: terms of order 0 */
    const real r1_w10_g0 = c->r1_w10_robot__m__1__wh__ws * s->robot__m__1__wh__ws;

    /* khepera.bg:17: r1_w10: degree 1 */
    const real r1_w10_d1 = c->r1_w10_w1_robot__m__1__wh__ws * s->robot__m__1__wh__ws;

    /* khepera.bg:17: r1_w10: error of order 0 */
    const real r1_w10_e0 = c->bend1 * r1_w10_g0;

    /* khepera.bg:17: r1_w10: input of stage 3 */
    const real r1_w10_u3 = r1_w10_g0 - r1_w10_d1 - r1_w10_e0;

    /* khepera.bg:17: r1_w10: stage 3, at rest */
    const real r1_w10_y3 = r1_w10_u3;

    /* khepera.bg:17: r1_w10: stage 3: memory */
    x->r1_w10_s3 = c->rest * r1_w10_u3;

    /* khepera.bg:17: r1_w10: input of stage 2 */
    const real r1_w10_u2 = r1_w10_y3 + r1_w10_d1 + REAL(2.0) * r1_w10_e0;

    /* khepera.bg:17: r1_w10: stage 2, at rest */
    const real r1_w10_y2 = r1_w10_u2;

    /* khepera.bg:17: r1_w10: stage 2: memory */
    x->r1_w10_s2 = c->rest * r1_w10_u2;

    /* khepera.bg:17: r1_w10: input of stage 1 */
    const real r1_w10_u1 = r1_w10_y2 - r1_w10_e0;

    /* khepera.bg:17: r1_w10: stage 1, at rest */
    const real r1_w10_y1 = r1_w10_u1;

    /* khepera.bg:17: r1_w10: stage 1: memory */
    x->r1_w10_s1 = c->rest * r1_w10_u1;

    /* khepera.bg:17: r1: what the tolerances of robot.m[1].el.k and robot.m[1].wh.fs can do
     * together */
    const real r1_w10 = r1_w10_y1;

    /* khepera.bg:17: r1: how far r1 can be from zero if no parameter is out of tolerance */
    r[KHEPERA_PLAUSIBLE_THRESHOLD_R1] = MATH(fabs)(r1_w1) + MATH(fabs)(r1_w2) + MATH(fabs)(r1_w3)
        + MATH(fabs)(r1_w4) + MATH(fabs)(r1_w5) + MATH(fabs)(r1_w6) + MATH(fabs)(r1_w7)
        + MATH(fabs)(r1_w8) + MATH(fabs)(r1_w9) + MATH(fabs)(r1_w10);
}

/* r1 on every further sample. */
static void next_r1(
    khepera_plausible_threshold_monitor *monitor, const khepera_plausible_threshold_samples *s, real *r)
{
    const khepera_plausible_threshold_coefficients *c = &monitor->c;
    khepera_plausible_threshold_memory *x = &monitor->x;

    /* khepera.bg:17: r1_w1: terms of order 0 */
    const real r1_w1_g0 = -c->r1_w1_robot__m__1__me__we * s->robot__m__1__me__we;

    /* khepera.bg:17: r1_w1: degree 1 */
    const real r1_w1_d1 = c->r1_w1_w1_robot__m__1__me__we * s->robot__m__1__me__we;

    /* khepera.bg:17: r1_w1: error of order 0 */
    const real r1_w1_e0 = c->bend1 * r1_w1_g0;

    /* khepera.bg:17: r1_w1: input of stage 3 */
    const real r1_w1_u3 = r1_w1_g0 + r1_w1_d1 - r1_w1_e0;

    /* khepera.bg:17: r1_w1: stage 3 */
    const real r1_w1_y3 = x->r1_w1_s3 + c->b * r1_w1_u3;

    /* khepera.bg:17: r1_w1: stage 3: memory */
    x->r1_w1_s3 = c->a * r1_w1_y3 + c->b * r1_w1_u3;

    /* khepera.bg:17: r1_w1: input of stage 2 */
    const real r1_w1_u2 = r1_w1_y3 + REAL(2.0) * r1_w1_e0 - r1_w1_d1;

    /* khepera.bg:17: r1_w1: stage 2 */
    const real r1_w1_y2 = x->r1_w1_s2 + c->b * r1_w1_u2;

    /* khepera.bg:17: r1_w1: stage 2: memory */
    x->r1_w1_s2 = c->a * r1_w1_y2 + c->b * r1_w1_u2;

    /* khepera.bg:17: r1_w1: input of stage 1 */
    const real r1_w1_u1 = r1_w1_y2 - r1_w1_e0;

    /* khepera.bg:17: r1_w1: stage 1 */
    const real r1_w1_y1 = x->r1_w1_s1 + c->b * r1_w1_u1;

    /* khepera.bg:17: r1_w1: stage 1: memory */
    x->r1_w1_s1 = c->a * r1_w1_y1 + c->b * r1_w1_u1;

    /* khepera.bg:17: r1: what the tolerance of fe[1] can do */
    const real r1_w1 = r1_w1_y1;

    /* khepera.bg:17: r1_w2: terms of order 0 */
    const real r1_w2_g0 = -c->r1_w2_robot__Fx__1 * s->robot__Fx__1
        - c->r1_w2_robot__m__1__wh__ws * s->robot__m__1__wh__ws
        - c->r1_w2_robot__m__1__me__we * s->robot__m__1__me__we;

    /* khepera.bg:17: r1_w2: degree 1 */
    const real r1_w2_d1 = -c->r1_w2_w1_robot__m__1__wh__ws * s->robot__m__1__wh__ws
        - c->r1_w2_w1_robot__m__1__me__we * s->robot__m__1__me__we;

    /* khepera.bg:17: r1_w2: error of order 0 */
    const real r1_w2_e0 = c->bend1 * r1_w2_g0;

    /* khepera.bg:17: r1_w2: input of stage 3 */
    const real r1_w2_u3 = r1_w2_g0 - r1_w2_d1 - r1_w2_e0;

    /* khepera.bg:17: r1_w2: stage 3 */
    const real r1_w2_y3 = x->r1_w2_s3 + c->b * r1_w2_u3;

    /* khepera.bg:17: r1_w2: stage 3: memory */
    x->r1_w2_s3 = c->a * r1_w2_y3 + c->b * r1_w2_u3;

    /* khepera.bg:17: r1_w2: input of stage 2 */
    const real r1_w2_u2 = r1_w2_y3 + r1_w2_d1 + REAL(2.0) * r1_w2_e0;

    /* khepera.bg:17: r1_w2: stage 2 */
    const real r1_w2_y2 = x->r1_w2_s2 + c->b * r1_w2_u2;

    /* khepera.bg:17: r1_w2: stage 2: memory */
    x->r1_w2_s2 = c->a * r1_w2_y2 + c->b * r1_w2_u2;

    /* khepera.bg:17: r1_w2: input of stage 1 */
    const real r1_w2_u1 = r1_w2_y2 - r1_w2_e0;

    /* khepera.bg:17: r1_w2: stage 1 */
    const real r1_w2_y1 = x->r1_w2_s1 + c->b * r1_w2_u1;

    /* khepera.bg:17: r1_w2: stage 1: memory */
    x->r1_w2_s1 = c->a * r1_w2_y1 + c->b * r1_w2_u1;

    /* khepera.bg:17: r1: what the tolerance of robot.m[1].el.Re can do */
    const real r1_w2 = r1_w2_y1;

    /* khepera.bg:17: r1_w3: terms of order 0 */
    const real r1_w3_g0 = c->r1_w3_robot__m__1__me__we * s->robot__m__1__me__we
        + c->r1_w3_robot__Fx__1 * s->robot__Fx__1
        + c->r1_w3_robot__m__1__wh__ws * s->robot__m__1__wh__ws;

    /* khepera.bg:17: r1_w3: terms of order 1 */
    const real r1_w3_g1 = c->r1_w3_w1_robot__m__1__me__we * s->robot__m__1__me__we
        + c->r1_w3_w1_robot__Fx__1 * s->robot__Fx__1
        + c->r1_w3_w1_robot__m__1__wh__ws * s->robot__m__1__wh__ws;

    /* khepera.bg:17: r1_w3: error of order 0 */
    const real r1_w3_e0 = c->bend2 * r1_w3_g0;

    /* khepera.bg:17: r1_w3: degree 2 */
    const real r1_w3_d2 = c->r1_w3_w2_robot__m__1__me__we * s->robot__m__1__me__we
        + c->r1_w3_w2_robot__m__1__wh__ws * s->robot__m__1__wh__ws - r1_w3_e0;

    /* khepera.bg:17: r1_w3: error of order 1 */
    const real r1_w3_e1 = c->bend1 * r1_w3_g1;

    /* khepera.bg:17: r1_w3: input of stage 3 */
    const real r1_w3_u3 = r1_w3_g0 + r1_w3_d2 + r1_w3_e1 - r1_w3_g1;

    /* khepera.bg:17: r1_w3: stage 3 */
    const real r1_w3_y3 = x->r1_w3_s3 + c->b * r1_w3_u3;

    /* khepera.bg:17: r1_w3: stage 3: memory */
    x->r1_w3_s3 = c->a * r1_w3_y3 + c->b * r1_w3_u3;

    /* khepera.bg:17: r1_w3: input of stage 2 */
    const real r1_w3_u2 = r1_w3_y3 + r1_w3_g1 - REAL(2.0) * r1_w3_d2 - REAL(3.0) * r1_w3_e1;

    /* khepera.bg:17: r1_w3: stage 2 */
    const real r1_w3_y2 = x->r1_w3_s2 + c->b * r1_w3_u2;

    /* khepera.bg:17: r1_w3: stage 2: memory */
    x->r1_w3_s2 = c->a * r1_w3_y2 + c->b * r1_w3_u2;

    /* khepera.bg:17: r1_w3: input of stage 1 */
    const real r1_w3_u1 = r1_w3_y2 + r1_w3_d2 + REAL(3.0) * r1_w3_e1;

    /* khepera.bg:17: r1_w3: stage 1 */
    const real r1_w3_y1 = x->r1_w3_s1 + c->b * r1_w3_u1;

    /* khepera.bg:17: r1_w3: stage 1: memory */
    x->r1_w3_s1 = c->a * r1_w3_y1 + c->b * r1_w3_u1;

    /* khepera.bg:17: r1: what the tolerance of robot.m[1].el.k can do */
    const real r1_w3 = r1_w3_y1 - r1_w3_e1;

    /* khepera.bg:17: r1_w4: terms of order 0 */
    const real r1_w4_g0 = -c->r1_w4_robot__m__1__wh__ws * s->robot__m__1__wh__ws;

    /* khepera.bg:17: r1_w4: degree 1 */
    const real r1_w4_d1 = c->r1_w4_w1_robot__m__1__wh__ws * s->robot__m__1__wh__ws;

    /* khepera.bg:17: r1_w4: error of order 0 */
    const real r1_w4_e0 = c->bend1 * r1_w4_g0;

    /* khepera.bg:17: r1_w4: input of stage 3 */
    const real r1_w4_u3 = r1_w4_g0 + r1_w4_d1 - r1_w4_e0;

    /* khepera.bg:17: r1_w4: stage 3 */
    const real r1_w4_y3 = x->r1_w4_s3 + c->b * r1_w4_u3;

    /* khepera.bg:17: r1_w4: stage 3: memory */
    x->r1_w4_s3 = c->a * r1_w4_y3 + c->b * r1_w4_u3;

    /* khepera.bg:17: r1_w4: input of stage 2 */
    const real r1_w4_u2 = r1_w4_y3 + REAL(2.0) * r1_w4_e0 - r1_w4_d1;

    /* khepera.bg:17: r1_w4: stage 2 */
    const real r1_w4_y2 = x->r1_w4_s2 + c->b * r1_w4_u2;

    /* khepera.bg:17: r1_w4: stage 2: memory */
    x->r1_w4_s2 = c->a * r1_w4_y2 + c->b * r1_w4_u2;

    /* khepera.bg:17: r1_w4: input of stage 1 */
    const real r1_w4_u1 = r1_w4_y2 - r1_w4_e0;

    /* khepera.bg:17: r1_w4: stage 1 */
    const real r1_w4_y1 = x->r1_w4_s1 + c->b * r1_w4_u1;

    /* khepera.bg:17: r1_w4: stage 1: memory */
    x->r1_w4_s1 = c->a * r1_w4_y1 + c->b * r1_w4_u1;

    /* khepera.bg:17: r1: what the tolerance of robot.m[1].wh.fs can do */
    const real r1_w4 = r1_w4_y1;

    /* khepera.bg:17: r1_w5: input of stage 3 */
    const real r1_w5_u3 = -c->r1_w5_robot__m__1__me__we * s->robot__m__1__me__we;

    /* khepera.bg:17: r1_w5: stage 3 */
    const real r1_w5_y3 = x->r1_w5_s3 + c->b * r1_w5_u3;

    /* khepera.bg:17: r1_w5: stage 3: memory */
    x->r1_w5_s3 = c->a * r1_w5_y3 + c->b * r1_w5_u3;

    /* khepera.bg:17: r1_w5: input of stage 2 */
    const real r1_w5_u2 = r1_w5_y3;

    /* khepera.bg:17: r1_w5: stage 2 */
    const real r1_w5_y2 = x->r1_w5_s2 + c->b * r1_w5_u2;

    /* khepera.bg:17: r1_w5: stage 2: memory */
    x->r1_w5_s2 = c->a * r1_w5_y2 + c->b * r1_w5_u2;

    /* khepera.bg:17: r1_w5: input of stage 1 */
    const real r1_w5_u1 = r1_w5_y2;

    /* khepera.bg:17: r1_w5: stage 1 */
    const real r1_w5_y1 = x->r1_w5_s1 + c->b * r1_w5_u1;

    /* khepera.bg:17: r1_w5: stage 1: memory */
    x->r1_w5_s1 = c->a * r1_w5_y1 + c->b * r1_w5_u1;

    /* khepera.bg:17: r1: what the tolerances of fe[1] and robot.m[1].el.Re can do together */
    const real r1_w5 = r1_w5_y1;

    /* khepera.bg:17: r1_w6: terms of order 0 */
    const real r1_w6_g0 = c->r1_w6_robot__m__1__me__we * s->robot__m__1__me__we;

    /* khepera.bg:17: r1_w6: degree 1 */
    const real r1_w6_d1 = c->r1_w6_w1_robot__m__1__me__we * s->robot__m__1__me__we;

    /* khepera.bg:17: r1_w6: error of order 0 */
    const real r1_w6_e0 = c->bend1 * r1_w6_g0;

    /* khepera.bg:17: r1_w6: input of stage 3 */
    const real r1_w6_u3 = r1_w6_g0 - r1_w6_d1 - r1_w6_e0;

    /* khepera.bg:17: r1_w6: stage 3 */
    const real r1_w6_y3 = x->r1_w6_s3 + c->b * r1_w6_u3;

    /* khepera.bg:17: r1_w6: stage 3: memory */
    x->r1_w6_s3 = c->a * r1_w6_y3 + c->b * r1_w6_u3;

    /* khepera.bg:17: r1_w6: input of stage 2 */
    const real r1_w6_u2 = r1_w6_y3 + r1_w6_d1 + REAL(2.0) * r1_w6_e0;

    /* khepera.bg:17: r1_w6: stage 2 */
    const real r1_w6_y2 = x->r1_w6_s2 + c->b * r1_w6_u2;

    /* khepera.bg:17: r1_w6: stage 2: memory */
    x->r1_w6_s2 = c->a * r1_w6_y2 + c->b * r1_w6_u2;

    /* khepera.bg:17: r1_w6: input of stage 1 */
    const real r1_w6_u1 = r1_w6_y2 - r1_w6_e0;

    /* khepera.bg:17: r1_w6: stage 1 */
    const real r1_w6_y1 = x->r1_w6_s1 + c->b * r1_w6_u1;

    /* khepera.bg:17: r1_w6: stage 1: memory */
    x->r1_w6_s1 = c->a * r1_w6_y1 + c->b * r1_w6_u1;

    /* khepera.bg:17: r1: what the tolerances of fe[1] and robot.m[1].el.k can do together */
    const real r1_w6 = r1_w6_y1;

    /* khepera.bg:17: r1_w7: terms of order 0 */
    const real r1_w7_g0 = c->r1_w7_robot__m__1__me__we * s->robot__m__1__me__we
        + c->r1_w7_robot__m__1__wh__ws * s->robot__m__1__wh__ws
        + c->r1_w7_robot__Fx__1 * s->robot__Fx__1;

    /* khepera.bg:17: r1_w7: degree 1 */
    const real r1_w7_d1 = c->r1_w7_w1_robot__m__1__me__we * s->robot__m__1__me__we
        + c->r1_w7_w1_robot__m__1__wh__ws * s->robot__m__1__wh__ws;

    /* khepera.bg:17: r1_w7: error of order 0 */
    const real r1_w7_e0 = c->bend1 * r1_w7_g0;

    /* khepera.bg:17: r1_w7: input of stage 3 */
    const real r1_w7_u3 = r1_w7_g0 - r1_w7_d1 - r1_w7_e0;

    /* khepera.bg:17: r1_w7: stage 3 */
    const real r1_w7_y3 = x->r1_w7_s3 + c->b * r1_w7_u3;

    /* khepera.bg:17: r1_w7: stage 3: memory */
    x->r1_w7_s3 = c->a * r1_w7_y3 + c->b * r1_w7_u3;

    /* khepera.bg:17: r1_w7: input of stage 2 */
    const real r1_w7_u2 = r1_w7_y3 + r1_w7_d1 + REAL(2.0) * r1_w7_e0;

    /* khepera.bg:17: r1_w7: stage 2 */
    const real r1_w7_y2 = x->r1_w7_s2 + c->b * r1_w7_u2;

    /* khepera.bg:17: r1_w7: stage 2: memory */
    x->r1_w7_s2 = c->a * r1_w7_y2 + c->b * r1_w7_u2;

    /* khepera.bg:17: r1_w7: input of stage 1 */
    const real r1_w7_u1 = r1_w7_y2 - r1_w7_e0;

    /* khepera.bg:17: r1_w7: stage 1 */
    const real r1_w7_y1 = x->r1_w7_s1 + c->b * r1_w7_u1;

    /* khepera.bg:17: r1_w7: stage 1: memory */
    x->r1_w7_s1 = c->a * r1_w7_y1 + c->b * r1_w7_u1;

    /* khepera.bg:17: r1: what the tolerances of robot.m[1].el.Re and robot.m[1].el.k can do
     * together */
    const real r1_w7 = r1_w7_y1;

    /* khepera.bg:17: r1_w8: input of stage 3 */
    const real r1_w8_u3 = -c->r1_w8_robot__m__1__wh__ws * s->robot__m__1__wh__ws;

    /* khepera.bg:17: r1_w8: stage 3 */
    const real r1_w8_y3 = x->r1_w8_s3 + c->b * r1_w8_u3;

    /* khepera.bg:17: r1_w8: stage 3: memory */
    x->r1_w8_s3 = c->a * r1_w8_y3 + c->b * r1_w8_u3;

    /* khepera.bg:17: r1_w8: input of stage 2 */
    const real r1_w8_u2 = r1_w8_y3;

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

    /* khepera.bg:17: r1: what the tolerances of robot.m[1].el.Re and robot.m[1].wh.fs can do
     * together */
    const real r1_w8 = r1_w8_y1;

    /* khepera.bg:17: r1_w9: terms of order 0 */
    const real r1_w9_g0 = -c->r1_w9_robot__m__1__me__we * s->robot__m__1__me__we
        - c->r1_w9_robot__m__1__wh__ws * s->robot__m__1__wh__ws
        - c->r1_w9_robot__Fx__1 * s->robot__Fx__1;

    /* khepera.bg:17: r1_w9: terms of order 1 */
    const real r1_w9_g1 = c->r1_w9_w1_robot__m__1__me__we * s->robot__m__1__me__we
        + c->r1_w9_w1_robot__m__1__wh__ws * s->robot__m__1__wh__ws
        - c->r1_w9_w1_robot__Fx__1 * s->robot__Fx__1;

    /* khepera.bg:17: r1_w9: error of order 0 */
    const real r1_w9_e0 = c->bend2 * r1_w9_g0;

    /* khepera.bg:17: r1_w9: degree 2 */
    const real r1_w9_d2 = -c->r1_w9_w2_robot__m__1__me__we * s->robot__m__1__me__we
        - c->r1_w9_w2_robot__m__1__wh__ws * s->robot__m__1__wh__ws - r1_w9_e0;

    /* khepera.bg:17: r1_w9: error of order 1 */
    const real r1_w9_e1 = c->bend1 * r1_w9_g1;

    /* khepera.bg:17: r1_w9: input of stage 3 */
    const real r1_w9_u3 = r1_w9_g0 + r1_w9_d2 + r1_w9_e1 - r1_w9_g1;

    /* khepera.bg:17: r1_w9: stage 3 */
    const real r1_w9_y3 = x->r1_w9_s3 + c->b * r1_w9_u3;

    /* khepera.bg:17: r1_w9: stage 3: memory */
    x->r1_w9_s3 = c->a * r1_w9_y3 + c->b * r1_w9_u3;

    /* khepera.bg:17: r1_w9: input of stage 2 */
    const real r1_w9_u2 = r1_w9_y3 + r1_w9_g1 - REAL(2.0) * r1_w9_d2 - REAL(3.0) * r1_w9_e1;

    /* khepera.bg:17: r1_w9: stage 2 */
    const real r1_w9_y2 = x->r1_w9_s2 + c->b * r1_w9_u2;

    /* khepera.bg:17: r1_w9: stage 2: memory */
    x->r1_w9_s2 = c->a * r1_w9_y2 + c->b * r1_w9_u2;

    /* khepera.bg:17: r1_w9: input of stage 1 */
    const real r1_w9_u1 = r1_w9_y2 + r1_w9_d2 + REAL(3.0) * r1_w9_e1;

    /* khepera.bg:17: r1_w9: stage 1 */
    const real r1_w9_y1 = x->r1_w9_s1 + c->b * r1_w9_u1;

    /* khepera.bg:17: r1_w9: stage 1: memory */
    x->r1_w9_s1 = c->a * r1_w9_y1 + c->b * r1_w9_u1;

    /* khepera.bg:17: r1: second order of what the tolerance of robot.m[1].el.k can do */
    const real r1_w9 = r1_w9_y1 - r1_w9_e1;

    /* khepera.bg:17: r1_w10: terms of order 0 */
    const real r1_w10_g0 = c->r1_w10_robot__m__1__wh__ws * s->robot__m__1__wh__ws;

    /* khepera.bg:17: r1_w10: degree 1 */
    const real r1_w10_d1 = c->r1_w10_w1_robot__m__1__wh__ws * s->robot__m__1__wh__ws;

    /* khepera.bg:17: r1_w10: error of order 0 */
    const real r1_w10_e0 = c->bend1 * r1_w10_g0;

    /* khepera.bg:17: r1_w10: input of stage 3 */
    const real r1_w10_u3 = r1_w10_g0 - r1_w10_d1 - r1_w10_e0;

    /* khepera.bg:17: r1_w10: stage 3 */
    const real r1_w10_y3 = x->r1_w10_s3 + c->b * r1_w10_u3;

    /* khepera.bg:17: r1_w10: stage 3: memory */
    x->r1_w10_s3 = c->a * r1_w10_y3 + c->b * r1_w10_u3;

    /* khepera.bg:17: r1_w10: input of stage 2 */
    const real r1_w10_u2 = r1_w10_y3 + r1_w10_d1 + REAL(2.0) * r1_w10_e0;

    /* khepera.bg:17: r1_w10: stage 2 */
    const real r1_w10_y2 = x->r1_w10_s2 + c->b * r1_w10_u2;

    /* khepera.bg:17: r1_w10: stage 2: memory */
    x->r1_w10_s2 = c->a * r1_w10_y2 + c->b * r1_w10_u2;

    /* khepera.bg:17: r1_w10: input of stage 1 */
    const real r1_w10_u1 = r1_w10_y2 - r1_w10_e0;

    /* khepera.bg:17: r1_w10: stage 1 */
    const real r1_w10_y1 = x->r1_w10_s1 + c->b * r1_w10_u1;

    /* khepera.bg:17: r1_w10: stage 1: memory */
    x->r1_w10_s1 = c->a * r1_w10_y1 + c->b * r1_w10_u1;

    /* khepera.bg:17: r1: what the tolerances of robot.m[1].el.k and robot.m[1].wh.fs can do
     * together */
    const real r1_w10 = r1_w10_y1;

    /* khepera.bg:17: r1: how far r1 can be from zero if no parameter is out of tolerance */
    r[KHEPERA_PLAUSIBLE_THRESHOLD_R1] = MATH(fabs)(r1_w1) + MATH(fabs)(r1_w2) + MATH(fabs)(r1_w3)
        + MATH(fabs)(r1_w4) + MATH(fabs)(r1_w5) + MATH(fabs)(r1_w6) + MATH(fabs)(r1_w7)
        + MATH(fabs)(r1_w8) + MATH(fabs)(r1_w9) + MATH(fabs)(r1_w10);
}

/* One sample for r1; a number that is not finite makes the next sample the first. */
static void run_r1(
    khepera_plausible_threshold_monitor *monitor, const khepera_plausible_threshold_samples *s, khepera_plausible_threshold_residuals *residuals)
{
    real *r = residuals->value;
    uint32_t age = monitor->age[0];

    if (age == 0u) {
        start_r1(monitor, s, r);
    } else {
        next_r1(monitor, s, r);
    }
    /* a sum is finite only if all its terms are */
    if (finite_number(s->robot__Fx__1 + s->robot__m__1__me__we + s->robot__m__1__wh__ws
                + r[KHEPERA_PLAUSIBLE_THRESHOLD_R1])) {
        age += age < UINT32_MAX ? 1u : 0u;
    } else {
        age = 0u;
        r[KHEPERA_PLAUSIBLE_THRESHOLD_R1] = REAL(0.0);
    }
    monitor->age[0] = age;
    residuals->valid[KHEPERA_PLAUSIBLE_THRESHOLD_R1] = age > monitor->settle[KHEPERA_PLAUSIBLE_THRESHOLD_R1];
}

/* r2 on its first sample: the filter as if it had always been so. */
static void start_r2(
    khepera_plausible_threshold_monitor *monitor, const khepera_plausible_threshold_samples *s, real *r)
{
    const khepera_plausible_threshold_coefficients *c = &monitor->c;
    khepera_plausible_threshold_memory *x = &monitor->x;

    /* khepera.bg:41: r2_w1: degree 1 */
    const real r2_w1_d1 = c->r2_w1_w1_robot__m__1__wh__ws * s->robot__m__1__wh__ws;

    /* khepera.bg:41: r2_w1: input of stage 3 */
    const real r2_w1_u3 = r2_w1_d1;

    /* khepera.bg:41: r2_w1: stage 3, at rest */
    const real r2_w1_y3 = r2_w1_u3;

    /* khepera.bg:41: r2_w1: stage 3: memory */
    x->r2_w1_s3 = c->rest * r2_w1_u3;

    /* khepera.bg:41: r2_w1: input of stage 2 */
    const real r2_w1_u2 = r2_w1_y3 - r2_w1_d1;

    /* khepera.bg:41: r2_w1: stage 2, at rest */
    const real r2_w1_y2 = r2_w1_u2;

    /* khepera.bg:41: r2_w1: stage 2: memory */
    x->r2_w1_s2 = c->rest * r2_w1_u2;

    /* khepera.bg:41: r2_w1: input of stage 1 */
    const real r2_w1_u1 = r2_w1_y2;

    /* khepera.bg:41: r2_w1: stage 1, at rest */
    const real r2_w1_y1 = r2_w1_u1;

    /* khepera.bg:41: r2_w1: stage 1: memory */
    x->r2_w1_s1 = c->rest * r2_w1_u1;

    /* khepera.bg:41: r2: what the tolerance of robot.m[1].wh.fs can do */
    const real r2_w1 = r2_w1_y1;

    /* khepera.bg:41: r2: how far r2 can be from zero if no parameter is out of tolerance */
    r[KHEPERA_PLAUSIBLE_THRESHOLD_R2] = MATH(fabs)(r2_w1);
}

/* r2 on every further sample. */
static void next_r2(
    khepera_plausible_threshold_monitor *monitor, const khepera_plausible_threshold_samples *s, real *r)
{
    const khepera_plausible_threshold_coefficients *c = &monitor->c;
    khepera_plausible_threshold_memory *x = &monitor->x;

    /* khepera.bg:41: r2_w1: degree 1 */
    const real r2_w1_d1 = c->r2_w1_w1_robot__m__1__wh__ws * s->robot__m__1__wh__ws;

    /* khepera.bg:41: r2_w1: input of stage 3 */
    const real r2_w1_u3 = r2_w1_d1;

    /* khepera.bg:41: r2_w1: stage 3 */
    const real r2_w1_y3 = x->r2_w1_s3 + c->b * r2_w1_u3;

    /* khepera.bg:41: r2_w1: stage 3: memory */
    x->r2_w1_s3 = c->a * r2_w1_y3 + c->b * r2_w1_u3;

    /* khepera.bg:41: r2_w1: input of stage 2 */
    const real r2_w1_u2 = r2_w1_y3 - r2_w1_d1;

    /* khepera.bg:41: r2_w1: stage 2 */
    const real r2_w1_y2 = x->r2_w1_s2 + c->b * r2_w1_u2;

    /* khepera.bg:41: r2_w1: stage 2: memory */
    x->r2_w1_s2 = c->a * r2_w1_y2 + c->b * r2_w1_u2;

    /* khepera.bg:41: r2_w1: input of stage 1 */
    const real r2_w1_u1 = r2_w1_y2;

    /* khepera.bg:41: r2_w1: stage 1 */
    const real r2_w1_y1 = x->r2_w1_s1 + c->b * r2_w1_u1;

    /* khepera.bg:41: r2_w1: stage 1: memory */
    x->r2_w1_s1 = c->a * r2_w1_y1 + c->b * r2_w1_u1;

    /* khepera.bg:41: r2: what the tolerance of robot.m[1].wh.fs can do */
    const real r2_w1 = r2_w1_y1;

    /* khepera.bg:41: r2: how far r2 can be from zero if no parameter is out of tolerance */
    r[KHEPERA_PLAUSIBLE_THRESHOLD_R2] = MATH(fabs)(r2_w1);
}

/* One sample for r2; a number that is not finite makes the next sample the first. */
static void run_r2(
    khepera_plausible_threshold_monitor *monitor, const khepera_plausible_threshold_samples *s, khepera_plausible_threshold_residuals *residuals)
{
    real *r = residuals->value;
    uint32_t age = monitor->age[1];

    if (age == 0u) {
        start_r2(monitor, s, r);
    } else {
        next_r2(monitor, s, r);
    }
    /* a sum is finite only if all its terms are */
    if (finite_number(s->robot__m__1__wh__ws + r[KHEPERA_PLAUSIBLE_THRESHOLD_R2])) {
        age += age < UINT32_MAX ? 1u : 0u;
    } else {
        age = 0u;
        r[KHEPERA_PLAUSIBLE_THRESHOLD_R2] = REAL(0.0);
    }
    monitor->age[1] = age;
    residuals->valid[KHEPERA_PLAUSIBLE_THRESHOLD_R2] = age > monitor->settle[KHEPERA_PLAUSIBLE_THRESHOLD_R2];
}

/* r3 on its first sample: the filter as if it had always been so. */
static void start_r3(
    khepera_plausible_threshold_monitor *monitor, const khepera_plausible_threshold_samples *s, real *r)
{
    const khepera_plausible_threshold_coefficients *c = &monitor->c;
    khepera_plausible_threshold_memory *x = &monitor->x;

    /* khepera.bg:17: r3_w1: terms of order 0 */
    const real r3_w1_g0 = -c->r3_w1_robot__m__2__me__we * s->robot__m__2__me__we;

    /* khepera.bg:17: r3_w1: degree 1 */
    const real r3_w1_d1 = c->r3_w1_w1_robot__m__2__me__we * s->robot__m__2__me__we;

    /* khepera.bg:17: r3_w1: error of order 0 */
    const real r3_w1_e0 = c->bend1 * r3_w1_g0;

    /* khepera.bg:17: r3_w1: input of stage 3 */
    const real r3_w1_u3 = r3_w1_g0 + r3_w1_d1 - r3_w1_e0;

    /* khepera.bg:17: r3_w1: stage 3, at rest */
    const real r3_w1_y3 = r3_w1_u3;

    /* khepera.bg:17: r3_w1: stage 3: memory */
    x->r3_w1_s3 = c->rest * r3_w1_u3;

    /* khepera.bg:17: r3_w1: input of stage 2 */
    const real r3_w1_u2 = r3_w1_y3 + REAL(2.0) * r3_w1_e0 - r3_w1_d1;

    /* khepera.bg:17: r3_w1: stage 2, at rest */
    const real r3_w1_y2 = r3_w1_u2;

    /* khepera.bg:17: r3_w1: stage 2: memory */
    x->r3_w1_s2 = c->rest * r3_w1_u2;

    /* khepera.bg:17: r3_w1: input of stage 1 */
    const real r3_w1_u1 = r3_w1_y2 - r3_w1_e0;

    /* khepera.bg:17: r3_w1: stage 1, at rest */
    const real r3_w1_y1 = r3_w1_u1;

    /* khepera.bg:17: r3_w1: stage 1: memory */
    x->r3_w1_s1 = c->rest * r3_w1_u1;

    /* khepera.bg:17: r3: what the tolerance of fe[2] can do */
    const real r3_w1 = r3_w1_y1;

    /* khepera.bg:17: r3_w2: terms of order 0 */
    const real r3_w2_g0 = -c->r3_w2_robot__Fx__2 * s->robot__Fx__2
        - c->r3_w2_robot__m__2__wh__ws * s->robot__m__2__wh__ws
        - c->r3_w2_robot__m__2__me__we * s->robot__m__2__me__we;

    /* khepera.bg:17: r3_w2: degree 1 */
    const real r3_w2_d1 = -c->r3_w2_w1_robot__m__2__wh__ws * s->robot__m__2__wh__ws
        - c->r3_w2_w1_robot__m__2__me__we * s->robot__m__2__me__we;

    /* khepera.bg:17: r3_w2: error of order 0 */
    const real r3_w2_e0 = c->bend1 * r3_w2_g0;

    /* khepera.bg:17: r3_w2: input of stage 3 */
    const real r3_w2_u3 = r3_w2_g0 - r3_w2_d1 - r3_w2_e0;

    /* khepera.bg:17: r3_w2: stage 3, at rest */
    const real r3_w2_y3 = r3_w2_u3;

    /* khepera.bg:17: r3_w2: stage 3: memory */
    x->r3_w2_s3 = c->rest * r3_w2_u3;

    /* khepera.bg:17: r3_w2: input of stage 2 */
    const real r3_w2_u2 = r3_w2_y3 + r3_w2_d1 + REAL(2.0) * r3_w2_e0;

    /* khepera.bg:17: r3_w2: stage 2, at rest */
    const real r3_w2_y2 = r3_w2_u2;

    /* khepera.bg:17: r3_w2: stage 2: memory */
    x->r3_w2_s2 = c->rest * r3_w2_u2;

    /* khepera.bg:17: r3_w2: input of stage 1 */
    const real r3_w2_u1 = r3_w2_y2 - r3_w2_e0;

    /* khepera.bg:17: r3_w2: stage 1, at rest */
    const real r3_w2_y1 = r3_w2_u1;

    /* khepera.bg:17: r3_w2: stage 1: memory */
    x->r3_w2_s1 = c->rest * r3_w2_u1;

    /* khepera.bg:17: r3: what the tolerance of robot.m[2].el.Re can do */
    const real r3_w2 = r3_w2_y1;

    /* khepera.bg:17: r3_w3: terms of order 0 */
    const real r3_w3_g0 = c->r3_w3_robot__m__2__me__we * s->robot__m__2__me__we
        + c->r3_w3_robot__Fx__2 * s->robot__Fx__2
        + c->r3_w3_robot__m__2__wh__ws * s->robot__m__2__wh__ws;

    /* khepera.bg:17: r3_w3: terms of order 1 */
    const real r3_w3_g1 = c->r3_w3_w1_robot__m__2__me__we * s->robot__m__2__me__we
        + c->r3_w3_w1_robot__Fx__2 * s->robot__Fx__2
        + c->r3_w3_w1_robot__m__2__wh__ws * s->robot__m__2__wh__ws;

    /* khepera.bg:17: r3_w3: error of order 0 */
    const real r3_w3_e0 = c->bend2 * r3_w3_g0;

    /* khepera.bg:17: r3_w3: degree 2 */
    const real r3_w3_d2 = c->r3_w3_w2_robot__m__2__me__we * s->robot__m__2__me__we
        + c->r3_w3_w2_robot__m__2__wh__ws * s->robot__m__2__wh__ws - r3_w3_e0;

    /* khepera.bg:17: r3_w3: error of order 1 */
    const real r3_w3_e1 = c->bend1 * r3_w3_g1;

    /* khepera.bg:17: r3_w3: input of stage 3 */
    const real r3_w3_u3 = r3_w3_g0 + r3_w3_d2 + r3_w3_e1 - r3_w3_g1;

    /* khepera.bg:17: r3_w3: stage 3, at rest */
    const real r3_w3_y3 = r3_w3_u3;

    /* khepera.bg:17: r3_w3: stage 3: memory */
    x->r3_w3_s3 = c->rest * r3_w3_u3;

    /* khepera.bg:17: r3_w3: input of stage 2 */
    const real r3_w3_u2 = r3_w3_y3 + r3_w3_g1 - REAL(2.0) * r3_w3_d2 - REAL(3.0) * r3_w3_e1;

    /* khepera.bg:17: r3_w3: stage 2, at rest */
    const real r3_w3_y2 = r3_w3_u2;

    /* khepera.bg:17: r3_w3: stage 2: memory */
    x->r3_w3_s2 = c->rest * r3_w3_u2;

    /* khepera.bg:17: r3_w3: input of stage 1 */
    const real r3_w3_u1 = r3_w3_y2 + r3_w3_d2 + REAL(3.0) * r3_w3_e1;

    /* khepera.bg:17: r3_w3: stage 1, at rest */
    const real r3_w3_y1 = r3_w3_u1;

    /* khepera.bg:17: r3_w3: stage 1: memory */
    x->r3_w3_s1 = c->rest * r3_w3_u1;

    /* khepera.bg:17: r3: what the tolerance of robot.m[2].el.k can do */
    const real r3_w3 = r3_w3_y1 - r3_w3_e1;

    /* khepera.bg:17: r3_w4: terms of order 0 */
    const real r3_w4_g0 = -c->r3_w4_robot__m__2__wh__ws * s->robot__m__2__wh__ws;

    /* khepera.bg:17: r3_w4: degree 1 */
    const real r3_w4_d1 = c->r3_w4_w1_robot__m__2__wh__ws * s->robot__m__2__wh__ws;

    /* khepera.bg:17: r3_w4: error of order 0 */
    const real r3_w4_e0 = c->bend1 * r3_w4_g0;

    /* khepera.bg:17: r3_w4: input of stage 3 */
    const real r3_w4_u3 = r3_w4_g0 + r3_w4_d1 - r3_w4_e0;

    /* khepera.bg:17: r3_w4: stage 3, at rest */
    const real r3_w4_y3 = r3_w4_u3;

    /* khepera.bg:17: r3_w4: stage 3: memory */
    x->r3_w4_s3 = c->rest * r3_w4_u3;

    /* khepera.bg:17: r3_w4: input of stage 2 */
    const real r3_w4_u2 = r3_w4_y3 + REAL(2.0) * r3_w4_e0 - r3_w4_d1;

    /* khepera.bg:17: r3_w4: stage 2, at rest */
    const real r3_w4_y2 = r3_w4_u2;

    /* khepera.bg:17: r3_w4: stage 2: memory */
    x->r3_w4_s2 = c->rest * r3_w4_u2;

    /* khepera.bg:17: r3_w4: input of stage 1 */
    const real r3_w4_u1 = r3_w4_y2 - r3_w4_e0;

    /* khepera.bg:17: r3_w4: stage 1, at rest */
    const real r3_w4_y1 = r3_w4_u1;

    /* khepera.bg:17: r3_w4: stage 1: memory */
    x->r3_w4_s1 = c->rest * r3_w4_u1;

    /* khepera.bg:17: r3: what the tolerance of robot.m[2].wh.fs can do */
    const real r3_w4 = r3_w4_y1;

    /* khepera.bg:17: r3_w5: input of stage 3 */
    const real r3_w5_u3 = -c->r3_w5_robot__m__2__me__we * s->robot__m__2__me__we;

    /* khepera.bg:17: r3_w5: stage 3, at rest */
    const real r3_w5_y3 = r3_w5_u3;

    /* khepera.bg:17: r3_w5: stage 3: memory */
    x->r3_w5_s3 = c->rest * r3_w5_u3;

    /* khepera.bg:17: r3_w5: input of stage 2 */
    const real r3_w5_u2 = r3_w5_y3;

    /* khepera.bg:17: r3_w5: stage 2, at rest */
    const real r3_w5_y2 = r3_w5_u2;

    /* khepera.bg:17: r3_w5: stage 2: memory */
    x->r3_w5_s2 = c->rest * r3_w5_u2;

    /* khepera.bg:17: r3_w5: input of stage 1 */
    const real r3_w5_u1 = r3_w5_y2;

    /* khepera.bg:17: r3_w5: stage 1, at rest */
    const real r3_w5_y1 = r3_w5_u1;

    /* khepera.bg:17: r3_w5: stage 1: memory */
    x->r3_w5_s1 = c->rest * r3_w5_u1;

    /* khepera.bg:17: r3: what the tolerances of fe[2] and robot.m[2].el.Re can do together */
    const real r3_w5 = r3_w5_y1;

    /* khepera.bg:17: r3_w6: terms of order 0 */
    const real r3_w6_g0 = c->r3_w6_robot__m__2__me__we * s->robot__m__2__me__we;

    /* khepera.bg:17: r3_w6: degree 1 */
    const real r3_w6_d1 = c->r3_w6_w1_robot__m__2__me__we * s->robot__m__2__me__we;

    /* khepera.bg:17: r3_w6: error of order 0 */
    const real r3_w6_e0 = c->bend1 * r3_w6_g0;

    /* khepera.bg:17: r3_w6: input of stage 3 */
    const real r3_w6_u3 = r3_w6_g0 - r3_w6_d1 - r3_w6_e0;

    /* khepera.bg:17: r3_w6: stage 3, at rest */
    const real r3_w6_y3 = r3_w6_u3;

    /* khepera.bg:17: r3_w6: stage 3: memory */
    x->r3_w6_s3 = c->rest * r3_w6_u3;

    /* khepera.bg:17: r3_w6: input of stage 2 */
    const real r3_w6_u2 = r3_w6_y3 + r3_w6_d1 + REAL(2.0) * r3_w6_e0;

    /* khepera.bg:17: r3_w6: stage 2, at rest */
    const real r3_w6_y2 = r3_w6_u2;

    /* khepera.bg:17: r3_w6: stage 2: memory */
    x->r3_w6_s2 = c->rest * r3_w6_u2;

    /* khepera.bg:17: r3_w6: input of stage 1 */
    const real r3_w6_u1 = r3_w6_y2 - r3_w6_e0;

    /* khepera.bg:17: r3_w6: stage 1, at rest */
    const real r3_w6_y1 = r3_w6_u1;

    /* khepera.bg:17: r3_w6: stage 1: memory */
    x->r3_w6_s1 = c->rest * r3_w6_u1;

    /* khepera.bg:17: r3: what the tolerances of fe[2] and robot.m[2].el.k can do together */
    const real r3_w6 = r3_w6_y1;

    /* khepera.bg:17: r3_w7: terms of order 0 */
    const real r3_w7_g0 = c->r3_w7_robot__m__2__me__we * s->robot__m__2__me__we
        + c->r3_w7_robot__m__2__wh__ws * s->robot__m__2__wh__ws
        + c->r3_w7_robot__Fx__2 * s->robot__Fx__2;

    /* khepera.bg:17: r3_w7: degree 1 */
    const real r3_w7_d1 = c->r3_w7_w1_robot__m__2__me__we * s->robot__m__2__me__we
        + c->r3_w7_w1_robot__m__2__wh__ws * s->robot__m__2__wh__ws;

    /* khepera.bg:17: r3_w7: error of order 0 */
    const real r3_w7_e0 = c->bend1 * r3_w7_g0;

    /* khepera.bg:17: r3_w7: input of stage 3 */
    const real r3_w7_u3 = r3_w7_g0 - r3_w7_d1 - r3_w7_e0;

    /* khepera.bg:17: r3_w7: stage 3, at rest */
    const real r3_w7_y3 = r3_w7_u3;

    /* khepera.bg:17: r3_w7: stage 3: memory */
    x->r3_w7_s3 = c->rest * r3_w7_u3;

    /* khepera.bg:17: r3_w7: input of stage 2 */
    const real r3_w7_u2 = r3_w7_y3 + r3_w7_d1 + REAL(2.0) * r3_w7_e0;

    /* khepera.bg:17: r3_w7: stage 2, at rest */
    const real r3_w7_y2 = r3_w7_u2;

    /* khepera.bg:17: r3_w7: stage 2: memory */
    x->r3_w7_s2 = c->rest * r3_w7_u2;

    /* khepera.bg:17: r3_w7: input of stage 1 */
    const real r3_w7_u1 = r3_w7_y2 - r3_w7_e0;

    /* khepera.bg:17: r3_w7: stage 1, at rest */
    const real r3_w7_y1 = r3_w7_u1;

    /* khepera.bg:17: r3_w7: stage 1: memory */
    x->r3_w7_s1 = c->rest * r3_w7_u1;

    /* khepera.bg:17: r3: what the tolerances of robot.m[2].el.Re and robot.m[2].el.k can do
     * together */
    const real r3_w7 = r3_w7_y1;

    /* khepera.bg:17: r3_w8: input of stage 3 */
    const real r3_w8_u3 = -c->r3_w8_robot__m__2__wh__ws * s->robot__m__2__wh__ws;

    /* khepera.bg:17: r3_w8: stage 3, at rest */
    const real r3_w8_y3 = r3_w8_u3;

    /* khepera.bg:17: r3_w8: stage 3: memory */
    x->r3_w8_s3 = c->rest * r3_w8_u3;

    /* khepera.bg:17: r3_w8: input of stage 2 */
    const real r3_w8_u2 = r3_w8_y3;

    /* khepera.bg:17: r3_w8: stage 2, at rest */
    const real r3_w8_y2 = r3_w8_u2;

    /* khepera.bg:17: r3_w8: stage 2: memory */
    x->r3_w8_s2 = c->rest * r3_w8_u2;

    /* khepera.bg:17: r3_w8: input of stage 1 */
    const real r3_w8_u1 = r3_w8_y2;

    /* khepera.bg:17: r3_w8: stage 1, at rest */
    const real r3_w8_y1 = r3_w8_u1;

    /* khepera.bg:17: r3_w8: stage 1: memory */
    x->r3_w8_s1 = c->rest * r3_w8_u1;

    /* khepera.bg:17: r3: what the tolerances of robot.m[2].el.Re and robot.m[2].wh.fs can do
     * together */
    const real r3_w8 = r3_w8_y1;

    /* khepera.bg:17: r3_w9: terms of order 0 */
    const real r3_w9_g0 = -c->r3_w9_robot__m__2__me__we * s->robot__m__2__me__we
        - c->r3_w9_robot__m__2__wh__ws * s->robot__m__2__wh__ws
        - c->r3_w9_robot__Fx__2 * s->robot__Fx__2;

    /* khepera.bg:17: r3_w9: terms of order 1 */
    const real r3_w9_g1 = c->r3_w9_w1_robot__m__2__me__we * s->robot__m__2__me__we
        + c->r3_w9_w1_robot__m__2__wh__ws * s->robot__m__2__wh__ws
        - c->r3_w9_w1_robot__Fx__2 * s->robot__Fx__2;

    /* khepera.bg:17: r3_w9: error of order 0 */
    const real r3_w9_e0 = c->bend2 * r3_w9_g0;

    /* khepera.bg:17: r3_w9: degree 2 */
    const real r3_w9_d2 = -c->r3_w9_w2_robot__m__2__me__we * s->robot__m__2__me__we
        - c->r3_w9_w2_robot__m__2__wh__ws * s->robot__m__2__wh__ws - r3_w9_e0;

    /* khepera.bg:17: r3_w9: error of order 1 */
    const real r3_w9_e1 = c->bend1 * r3_w9_g1;

    /* khepera.bg:17: r3_w9: input of stage 3 */
    const real r3_w9_u3 = r3_w9_g0 + r3_w9_d2 + r3_w9_e1 - r3_w9_g1;

    /* khepera.bg:17: r3_w9: stage 3, at rest */
    const real r3_w9_y3 = r3_w9_u3;

    /* khepera.bg:17: r3_w9: stage 3: memory */
    x->r3_w9_s3 = c->rest * r3_w9_u3;

    /* khepera.bg:17: r3_w9: input of stage 2 */
    const real r3_w9_u2 = r3_w9_y3 + r3_w9_g1 - REAL(2.0) * r3_w9_d2 - REAL(3.0) * r3_w9_e1;

    /* khepera.bg:17: r3_w9: stage 2, at rest */
    const real r3_w9_y2 = r3_w9_u2;

    /* khepera.bg:17: r3_w9: stage 2: memory */
    x->r3_w9_s2 = c->rest * r3_w9_u2;

    /* khepera.bg:17: r3_w9: input of stage 1 */
    const real r3_w9_u1 = r3_w9_y2 + r3_w9_d2 + REAL(3.0) * r3_w9_e1;

    /* khepera.bg:17: r3_w9: stage 1, at rest */
    const real r3_w9_y1 = r3_w9_u1;

    /* khepera.bg:17: r3_w9: stage 1: memory */
    x->r3_w9_s1 = c->rest * r3_w9_u1;

    /* khepera.bg:17: r3: second order of what the tolerance of robot.m[2].el.k can do */
    const real r3_w9 = r3_w9_y1 - r3_w9_e1;

    /* khepera.bg:17: r3_w10: terms of order 0 */
    const real r3_w10_g0 = c->r3_w10_robot__m__2__wh__ws * s->robot__m__2__wh__ws;

    /* khepera.bg:17: r3_w10: degree 1 */
    const real r3_w10_d1 = c->r3_w10_w1_robot__m__2__wh__ws * s->robot__m__2__wh__ws;

    /* khepera.bg:17: r3_w10: error of order 0 */
    const real r3_w10_e0 = c->bend1 * r3_w10_g0;

    /* khepera.bg:17: r3_w10: input of stage 3 */
    const real r3_w10_u3 = r3_w10_g0 - r3_w10_d1 - r3_w10_e0;

    /* khepera.bg:17: r3_w10: stage 3, at rest */
    const real r3_w10_y3 = r3_w10_u3;

    /* khepera.bg:17: r3_w10: stage 3: memory */
    x->r3_w10_s3 = c->rest * r3_w10_u3;

    /* khepera.bg:17: r3_w10: input of stage 2 */
    const real r3_w10_u2 = r3_w10_y3 + r3_w10_d1 + REAL(2.0) * r3_w10_e0;

    /* khepera.bg:17: r3_w10: stage 2, at rest */
    const real r3_w10_y2 = r3_w10_u2;

    /* khepera.bg:17: r3_w10: stage 2: memory */
    x->r3_w10_s2 = c->rest * r3_w10_u2;

    /* khepera.bg:17: r3_w10: input of stage 1 */
    const real r3_w10_u1 = r3_w10_y2 - r3_w10_e0;

    /* khepera.bg:17: r3_w10: stage 1, at rest */
    const real r3_w10_y1 = r3_w10_u1;

    /* khepera.bg:17: r3_w10: stage 1: memory */
    x->r3_w10_s1 = c->rest * r3_w10_u1;

    /* khepera.bg:17: r3: what the tolerances of robot.m[2].el.k and robot.m[2].wh.fs can do
     * together */
    const real r3_w10 = r3_w10_y1;

    /* khepera.bg:17: r3: how far r3 can be from zero if no parameter is out of tolerance */
    r[KHEPERA_PLAUSIBLE_THRESHOLD_R3] = MATH(fabs)(r3_w1) + MATH(fabs)(r3_w2) + MATH(fabs)(r3_w3)
        + MATH(fabs)(r3_w4) + MATH(fabs)(r3_w5) + MATH(fabs)(r3_w6) + MATH(fabs)(r3_w7)
        + MATH(fabs)(r3_w8) + MATH(fabs)(r3_w9) + MATH(fabs)(r3_w10);
}

/* r3 on every further sample. */
static void next_r3(
    khepera_plausible_threshold_monitor *monitor, const khepera_plausible_threshold_samples *s, real *r)
{
    const khepera_plausible_threshold_coefficients *c = &monitor->c;
    khepera_plausible_threshold_memory *x = &monitor->x;

    /* khepera.bg:17: r3_w1: terms of order 0 */
    const real r3_w1_g0 = -c->r3_w1_robot__m__2__me__we * s->robot__m__2__me__we;

    /* khepera.bg:17: r3_w1: degree 1 */
    const real r3_w1_d1 = c->r3_w1_w1_robot__m__2__me__we * s->robot__m__2__me__we;

    /* khepera.bg:17: r3_w1: error of order 0 */
    const real r3_w1_e0 = c->bend1 * r3_w1_g0;

    /* khepera.bg:17: r3_w1: input of stage 3 */
    const real r3_w1_u3 = r3_w1_g0 + r3_w1_d1 - r3_w1_e0;

    /* khepera.bg:17: r3_w1: stage 3 */
    const real r3_w1_y3 = x->r3_w1_s3 + c->b * r3_w1_u3;

    /* khepera.bg:17: r3_w1: stage 3: memory */
    x->r3_w1_s3 = c->a * r3_w1_y3 + c->b * r3_w1_u3;

    /* khepera.bg:17: r3_w1: input of stage 2 */
    const real r3_w1_u2 = r3_w1_y3 + REAL(2.0) * r3_w1_e0 - r3_w1_d1;

    /* khepera.bg:17: r3_w1: stage 2 */
    const real r3_w1_y2 = x->r3_w1_s2 + c->b * r3_w1_u2;

    /* khepera.bg:17: r3_w1: stage 2: memory */
    x->r3_w1_s2 = c->a * r3_w1_y2 + c->b * r3_w1_u2;

    /* khepera.bg:17: r3_w1: input of stage 1 */
    const real r3_w1_u1 = r3_w1_y2 - r3_w1_e0;

    /* khepera.bg:17: r3_w1: stage 1 */
    const real r3_w1_y1 = x->r3_w1_s1 + c->b * r3_w1_u1;

    /* khepera.bg:17: r3_w1: stage 1: memory */
    x->r3_w1_s1 = c->a * r3_w1_y1 + c->b * r3_w1_u1;

    /* khepera.bg:17: r3: what the tolerance of fe[2] can do */
    const real r3_w1 = r3_w1_y1;

    /* khepera.bg:17: r3_w2: terms of order 0 */
    const real r3_w2_g0 = -c->r3_w2_robot__Fx__2 * s->robot__Fx__2
        - c->r3_w2_robot__m__2__wh__ws * s->robot__m__2__wh__ws
        - c->r3_w2_robot__m__2__me__we * s->robot__m__2__me__we;

    /* khepera.bg:17: r3_w2: degree 1 */
    const real r3_w2_d1 = -c->r3_w2_w1_robot__m__2__wh__ws * s->robot__m__2__wh__ws
        - c->r3_w2_w1_robot__m__2__me__we * s->robot__m__2__me__we;

    /* khepera.bg:17: r3_w2: error of order 0 */
    const real r3_w2_e0 = c->bend1 * r3_w2_g0;

    /* khepera.bg:17: r3_w2: input of stage 3 */
    const real r3_w2_u3 = r3_w2_g0 - r3_w2_d1 - r3_w2_e0;

    /* khepera.bg:17: r3_w2: stage 3 */
    const real r3_w2_y3 = x->r3_w2_s3 + c->b * r3_w2_u3;

    /* khepera.bg:17: r3_w2: stage 3: memory */
    x->r3_w2_s3 = c->a * r3_w2_y3 + c->b * r3_w2_u3;

    /* khepera.bg:17: r3_w2: input of stage 2 */
    const real r3_w2_u2 = r3_w2_y3 + r3_w2_d1 + REAL(2.0) * r3_w2_e0;

    /* khepera.bg:17: r3_w2: stage 2 */
    const real r3_w2_y2 = x->r3_w2_s2 + c->b * r3_w2_u2;

    /* khepera.bg:17: r3_w2: stage 2: memory */
    x->r3_w2_s2 = c->a * r3_w2_y2 + c->b * r3_w2_u2;

    /* khepera.bg:17: r3_w2: input of stage 1 */
    const real r3_w2_u1 = r3_w2_y2 - r3_w2_e0;

    /* khepera.bg:17: r3_w2: stage 1 */
    const real r3_w2_y1 = x->r3_w2_s1 + c->b * r3_w2_u1;

    /* khepera.bg:17: r3_w2: stage 1: memory */
    x->r3_w2_s1 = c->a * r3_w2_y1 + c->b * r3_w2_u1;

    /* khepera.bg:17: r3: what the tolerance of robot.m[2].el.Re can do */
    const real r3_w2 = r3_w2_y1;

    /* khepera.bg:17: r3_w3: terms of order 0 */
    const real r3_w3_g0 = c->r3_w3_robot__m__2__me__we * s->robot__m__2__me__we
        + c->r3_w3_robot__Fx__2 * s->robot__Fx__2
        + c->r3_w3_robot__m__2__wh__ws * s->robot__m__2__wh__ws;

    /* khepera.bg:17: r3_w3: terms of order 1 */
    const real r3_w3_g1 = c->r3_w3_w1_robot__m__2__me__we * s->robot__m__2__me__we
        + c->r3_w3_w1_robot__Fx__2 * s->robot__Fx__2
        + c->r3_w3_w1_robot__m__2__wh__ws * s->robot__m__2__wh__ws;

    /* khepera.bg:17: r3_w3: error of order 0 */
    const real r3_w3_e0 = c->bend2 * r3_w3_g0;

    /* khepera.bg:17: r3_w3: degree 2 */
    const real r3_w3_d2 = c->r3_w3_w2_robot__m__2__me__we * s->robot__m__2__me__we
        + c->r3_w3_w2_robot__m__2__wh__ws * s->robot__m__2__wh__ws - r3_w3_e0;

    /* khepera.bg:17: r3_w3: error of order 1 */
    const real r3_w3_e1 = c->bend1 * r3_w3_g1;

    /* khepera.bg:17: r3_w3: input of stage 3 */
    const real r3_w3_u3 = r3_w3_g0 + r3_w3_d2 + r3_w3_e1 - r3_w3_g1;

    /* khepera.bg:17: r3_w3: stage 3 */
    const real r3_w3_y3 = x->r3_w3_s3 + c->b * r3_w3_u3;

    /* khepera.bg:17: r3_w3: stage 3: memory */
    x->r3_w3_s3 = c->a * r3_w3_y3 + c->b * r3_w3_u3;

    /* khepera.bg:17: r3_w3: input of stage 2 */
    const real r3_w3_u2 = r3_w3_y3 + r3_w3_g1 - REAL(2.0) * r3_w3_d2 - REAL(3.0) * r3_w3_e1;

    /* khepera.bg:17: r3_w3: stage 2 */
    const real r3_w3_y2 = x->r3_w3_s2 + c->b * r3_w3_u2;

    /* khepera.bg:17: r3_w3: stage 2: memory */
    x->r3_w3_s2 = c->a * r3_w3_y2 + c->b * r3_w3_u2;

    /* khepera.bg:17: r3_w3: input of stage 1 */
    const real r3_w3_u1 = r3_w3_y2 + r3_w3_d2 + REAL(3.0) * r3_w3_e1;

    /* khepera.bg:17: r3_w3: stage 1 */
    const real r3_w3_y1 = x->r3_w3_s1 + c->b * r3_w3_u1;

    /* khepera.bg:17: r3_w3: stage 1: memory */
    x->r3_w3_s1 = c->a * r3_w3_y1 + c->b * r3_w3_u1;

    /* khepera.bg:17: r3: what the tolerance of robot.m[2].el.k can do */
    const real r3_w3 = r3_w3_y1 - r3_w3_e1;

    /* khepera.bg:17: r3_w4: terms of order 0 */
    const real r3_w4_g0 = -c->r3_w4_robot__m__2__wh__ws * s->robot__m__2__wh__ws;

    /* khepera.bg:17: r3_w4: degree 1 */
    const real r3_w4_d1 = c->r3_w4_w1_robot__m__2__wh__ws * s->robot__m__2__wh__ws;

    /* khepera.bg:17: r3_w4: error of order 0 */
    const real r3_w4_e0 = c->bend1 * r3_w4_g0;

    /* khepera.bg:17: r3_w4: input of stage 3 */
    const real r3_w4_u3 = r3_w4_g0 + r3_w4_d1 - r3_w4_e0;

    /* khepera.bg:17: r3_w4: stage 3 */
    const real r3_w4_y3 = x->r3_w4_s3 + c->b * r3_w4_u3;

    /* khepera.bg:17: r3_w4: stage 3: memory */
    x->r3_w4_s3 = c->a * r3_w4_y3 + c->b * r3_w4_u3;

    /* khepera.bg:17: r3_w4: input of stage 2 */
    const real r3_w4_u2 = r3_w4_y3 + REAL(2.0) * r3_w4_e0 - r3_w4_d1;

    /* khepera.bg:17: r3_w4: stage 2 */
    const real r3_w4_y2 = x->r3_w4_s2 + c->b * r3_w4_u2;

    /* khepera.bg:17: r3_w4: stage 2: memory */
    x->r3_w4_s2 = c->a * r3_w4_y2 + c->b * r3_w4_u2;

    /* khepera.bg:17: r3_w4: input of stage 1 */
    const real r3_w4_u1 = r3_w4_y2 - r3_w4_e0;

    /* khepera.bg:17: r3_w4: stage 1 */
    const real r3_w4_y1 = x->r3_w4_s1 + c->b * r3_w4_u1;

    /* khepera.bg:17: r3_w4: stage 1: memory */
    x->r3_w4_s1 = c->a * r3_w4_y1 + c->b * r3_w4_u1;

    /* khepera.bg:17: r3: what the tolerance of robot.m[2].wh.fs can do */
    const real r3_w4 = r3_w4_y1;

    /* khepera.bg:17: r3_w5: input of stage 3 */
    const real r3_w5_u3 = -c->r3_w5_robot__m__2__me__we * s->robot__m__2__me__we;

    /* khepera.bg:17: r3_w5: stage 3 */
    const real r3_w5_y3 = x->r3_w5_s3 + c->b * r3_w5_u3;

    /* khepera.bg:17: r3_w5: stage 3: memory */
    x->r3_w5_s3 = c->a * r3_w5_y3 + c->b * r3_w5_u3;

    /* khepera.bg:17: r3_w5: input of stage 2 */
    const real r3_w5_u2 = r3_w5_y3;

    /* khepera.bg:17: r3_w5: stage 2 */
    const real r3_w5_y2 = x->r3_w5_s2 + c->b * r3_w5_u2;

    /* khepera.bg:17: r3_w5: stage 2: memory */
    x->r3_w5_s2 = c->a * r3_w5_y2 + c->b * r3_w5_u2;

    /* khepera.bg:17: r3_w5: input of stage 1 */
    const real r3_w5_u1 = r3_w5_y2;

    /* khepera.bg:17: r3_w5: stage 1 */
    const real r3_w5_y1 = x->r3_w5_s1 + c->b * r3_w5_u1;

    /* khepera.bg:17: r3_w5: stage 1: memory */
    x->r3_w5_s1 = c->a * r3_w5_y1 + c->b * r3_w5_u1;

    /* khepera.bg:17: r3: what the tolerances of fe[2] and robot.m[2].el.Re can do together */
    const real r3_w5 = r3_w5_y1;

    /* khepera.bg:17: r3_w6: terms of order 0 */
    const real r3_w6_g0 = c->r3_w6_robot__m__2__me__we * s->robot__m__2__me__we;

    /* khepera.bg:17: r3_w6: degree 1 */
    const real r3_w6_d1 = c->r3_w6_w1_robot__m__2__me__we * s->robot__m__2__me__we;

    /* khepera.bg:17: r3_w6: error of order 0 */
    const real r3_w6_e0 = c->bend1 * r3_w6_g0;

    /* khepera.bg:17: r3_w6: input of stage 3 */
    const real r3_w6_u3 = r3_w6_g0 - r3_w6_d1 - r3_w6_e0;

    /* khepera.bg:17: r3_w6: stage 3 */
    const real r3_w6_y3 = x->r3_w6_s3 + c->b * r3_w6_u3;

    /* khepera.bg:17: r3_w6: stage 3: memory */
    x->r3_w6_s3 = c->a * r3_w6_y3 + c->b * r3_w6_u3;

    /* khepera.bg:17: r3_w6: input of stage 2 */
    const real r3_w6_u2 = r3_w6_y3 + r3_w6_d1 + REAL(2.0) * r3_w6_e0;

    /* khepera.bg:17: r3_w6: stage 2 */
    const real r3_w6_y2 = x->r3_w6_s2 + c->b * r3_w6_u2;

    /* khepera.bg:17: r3_w6: stage 2: memory */
    x->r3_w6_s2 = c->a * r3_w6_y2 + c->b * r3_w6_u2;

    /* khepera.bg:17: r3_w6: input of stage 1 */
    const real r3_w6_u1 = r3_w6_y2 - r3_w6_e0;

    /* khepera.bg:17: r3_w6: stage 1 */
    const real r3_w6_y1 = x->r3_w6_s1 + c->b * r3_w6_u1;

    /* khepera.bg:17: r3_w6: stage 1: memory */
    x->r3_w6_s1 = c->a * r3_w6_y1 + c->b * r3_w6_u1;

    /* khepera.bg:17: r3: what the tolerances of fe[2] and robot.m[2].el.k can do together */
    const real r3_w6 = r3_w6_y1;

    /* khepera.bg:17: r3_w7: terms of order 0 */
    const real r3_w7_g0 = c->r3_w7_robot__m__2__me__we * s->robot__m__2__me__we
        + c->r3_w7_robot__m__2__wh__ws * s->robot__m__2__wh__ws
        + c->r3_w7_robot__Fx__2 * s->robot__Fx__2;

    /* khepera.bg:17: r3_w7: degree 1 */
    const real r3_w7_d1 = c->r3_w7_w1_robot__m__2__me__we * s->robot__m__2__me__we
        + c->r3_w7_w1_robot__m__2__wh__ws * s->robot__m__2__wh__ws;

    /* khepera.bg:17: r3_w7: error of order 0 */
    const real r3_w7_e0 = c->bend1 * r3_w7_g0;

    /* khepera.bg:17: r3_w7: input of stage 3 */
    const real r3_w7_u3 = r3_w7_g0 - r3_w7_d1 - r3_w7_e0;

    /* khepera.bg:17: r3_w7: stage 3 */
    const real r3_w7_y3 = x->r3_w7_s3 + c->b * r3_w7_u3;

    /* khepera.bg:17: r3_w7: stage 3: memory */
    x->r3_w7_s3 = c->a * r3_w7_y3 + c->b * r3_w7_u3;

    /* khepera.bg:17: r3_w7: input of stage 2 */
    const real r3_w7_u2 = r3_w7_y3 + r3_w7_d1 + REAL(2.0) * r3_w7_e0;

    /* khepera.bg:17: r3_w7: stage 2 */
    const real r3_w7_y2 = x->r3_w7_s2 + c->b * r3_w7_u2;

    /* khepera.bg:17: r3_w7: stage 2: memory */
    x->r3_w7_s2 = c->a * r3_w7_y2 + c->b * r3_w7_u2;

    /* khepera.bg:17: r3_w7: input of stage 1 */
    const real r3_w7_u1 = r3_w7_y2 - r3_w7_e0;

    /* khepera.bg:17: r3_w7: stage 1 */
    const real r3_w7_y1 = x->r3_w7_s1 + c->b * r3_w7_u1;

    /* khepera.bg:17: r3_w7: stage 1: memory */
    x->r3_w7_s1 = c->a * r3_w7_y1 + c->b * r3_w7_u1;

    /* khepera.bg:17: r3: what the tolerances of robot.m[2].el.Re and robot.m[2].el.k can do
     * together */
    const real r3_w7 = r3_w7_y1;

    /* khepera.bg:17: r3_w8: input of stage 3 */
    const real r3_w8_u3 = -c->r3_w8_robot__m__2__wh__ws * s->robot__m__2__wh__ws;

    /* khepera.bg:17: r3_w8: stage 3 */
    const real r3_w8_y3 = x->r3_w8_s3 + c->b * r3_w8_u3;

    /* khepera.bg:17: r3_w8: stage 3: memory */
    x->r3_w8_s3 = c->a * r3_w8_y3 + c->b * r3_w8_u3;

    /* khepera.bg:17: r3_w8: input of stage 2 */
    const real r3_w8_u2 = r3_w8_y3;

    /* khepera.bg:17: r3_w8: stage 2 */
    const real r3_w8_y2 = x->r3_w8_s2 + c->b * r3_w8_u2;

    /* khepera.bg:17: r3_w8: stage 2: memory */
    x->r3_w8_s2 = c->a * r3_w8_y2 + c->b * r3_w8_u2;

    /* khepera.bg:17: r3_w8: input of stage 1 */
    const real r3_w8_u1 = r3_w8_y2;

    /* khepera.bg:17: r3_w8: stage 1 */
    const real r3_w8_y1 = x->r3_w8_s1 + c->b * r3_w8_u1;

    /* khepera.bg:17: r3_w8: stage 1: memory */
    x->r3_w8_s1 = c->a * r3_w8_y1 + c->b * r3_w8_u1;

    /* khepera.bg:17: r3: what the tolerances of robot.m[2].el.Re and robot.m[2].wh.fs can do
     * together */
    const real r3_w8 = r3_w8_y1;

    /* khepera.bg:17: r3_w9: terms of order 0 */
    const real r3_w9_g0 = -c->r3_w9_robot__m__2__me__we * s->robot__m__2__me__we
        - c->r3_w9_robot__m__2__wh__ws * s->robot__m__2__wh__ws
        - c->r3_w9_robot__Fx__2 * s->robot__Fx__2;

    /* khepera.bg:17: r3_w9: terms of order 1 */
    const real r3_w9_g1 = c->r3_w9_w1_robot__m__2__me__we * s->robot__m__2__me__we
        + c->r3_w9_w1_robot__m__2__wh__ws * s->robot__m__2__wh__ws
        - c->r3_w9_w1_robot__Fx__2 * s->robot__Fx__2;

    /* khepera.bg:17: r3_w9: error of order 0 */
    const real r3_w9_e0 = c->bend2 * r3_w9_g0;

    /* khepera.bg:17: r3_w9: degree 2 */
    const real r3_w9_d2 = -c->r3_w9_w2_robot__m__2__me__we * s->robot__m__2__me__we
        - c->r3_w9_w2_robot__m__2__wh__ws * s->robot__m__2__wh__ws - r3_w9_e0;

    /* khepera.bg:17: r3_w9: error of order 1 */
    const real r3_w9_e1 = c->bend1 * r3_w9_g1;

    /* khepera.bg:17: r3_w9: input of stage 3 */
    const real r3_w9_u3 = r3_w9_g0 + r3_w9_d2 + r3_w9_e1 - r3_w9_g1;

    /* khepera.bg:17: r3_w9: stage 3 */
    const real r3_w9_y3 = x->r3_w9_s3 + c->b * r3_w9_u3;

    /* khepera.bg:17: r3_w9: stage 3: memory */
    x->r3_w9_s3 = c->a * r3_w9_y3 + c->b * r3_w9_u3;

    /* khepera.bg:17: r3_w9: input of stage 2 */
    const real r3_w9_u2 = r3_w9_y3 + r3_w9_g1 - REAL(2.0) * r3_w9_d2 - REAL(3.0) * r3_w9_e1;

    /* khepera.bg:17: r3_w9: stage 2 */
    const real r3_w9_y2 = x->r3_w9_s2 + c->b * r3_w9_u2;

    /* khepera.bg:17: r3_w9: stage 2: memory */
    x->r3_w9_s2 = c->a * r3_w9_y2 + c->b * r3_w9_u2;

    /* khepera.bg:17: r3_w9: input of stage 1 */
    const real r3_w9_u1 = r3_w9_y2 + r3_w9_d2 + REAL(3.0) * r3_w9_e1;

    /* khepera.bg:17: r3_w9: stage 1 */
    const real r3_w9_y1 = x->r3_w9_s1 + c->b * r3_w9_u1;

    /* khepera.bg:17: r3_w9: stage 1: memory */
    x->r3_w9_s1 = c->a * r3_w9_y1 + c->b * r3_w9_u1;

    /* khepera.bg:17: r3: second order of what the tolerance of robot.m[2].el.k can do */
    const real r3_w9 = r3_w9_y1 - r3_w9_e1;

    /* khepera.bg:17: r3_w10: terms of order 0 */
    const real r3_w10_g0 = c->r3_w10_robot__m__2__wh__ws * s->robot__m__2__wh__ws;

    /* khepera.bg:17: r3_w10: degree 1 */
    const real r3_w10_d1 = c->r3_w10_w1_robot__m__2__wh__ws * s->robot__m__2__wh__ws;

    /* khepera.bg:17: r3_w10: error of order 0 */
    const real r3_w10_e0 = c->bend1 * r3_w10_g0;

    /* khepera.bg:17: r3_w10: input of stage 3 */
    const real r3_w10_u3 = r3_w10_g0 - r3_w10_d1 - r3_w10_e0;

    /* khepera.bg:17: r3_w10: stage 3 */
    const real r3_w10_y3 = x->r3_w10_s3 + c->b * r3_w10_u3;

    /* khepera.bg:17: r3_w10: stage 3: memory */
    x->r3_w10_s3 = c->a * r3_w10_y3 + c->b * r3_w10_u3;

    /* khepera.bg:17: r3_w10: input of stage 2 */
    const real r3_w10_u2 = r3_w10_y3 + r3_w10_d1 + REAL(2.0) * r3_w10_e0;

    /* khepera.bg:17: r3_w10: stage 2 */
    const real r3_w10_y2 = x->r3_w10_s2 + c->b * r3_w10_u2;

    /* khepera.bg:17: r3_w10: stage 2: memory */
    x->r3_w10_s2 = c->a * r3_w10_y2 + c->b * r3_w10_u2;

    /* khepera.bg:17: r3_w10: input of stage 1 */
    const real r3_w10_u1 = r3_w10_y2 - r3_w10_e0;

    /* khepera.bg:17: r3_w10: stage 1 */
    const real r3_w10_y1 = x->r3_w10_s1 + c->b * r3_w10_u1;

    /* khepera.bg:17: r3_w10: stage 1: memory */
    x->r3_w10_s1 = c->a * r3_w10_y1 + c->b * r3_w10_u1;

    /* khepera.bg:17: r3: what the tolerances of robot.m[2].el.k and robot.m[2].wh.fs can do
     * together */
    const real r3_w10 = r3_w10_y1;

    /* khepera.bg:17: r3: how far r3 can be from zero if no parameter is out of tolerance */
    r[KHEPERA_PLAUSIBLE_THRESHOLD_R3] = MATH(fabs)(r3_w1) + MATH(fabs)(r3_w2) + MATH(fabs)(r3_w3)
        + MATH(fabs)(r3_w4) + MATH(fabs)(r3_w5) + MATH(fabs)(r3_w6) + MATH(fabs)(r3_w7)
        + MATH(fabs)(r3_w8) + MATH(fabs)(r3_w9) + MATH(fabs)(r3_w10);
}

/* One sample for r3; a number that is not finite makes the next sample the first. */
static void run_r3(
    khepera_plausible_threshold_monitor *monitor, const khepera_plausible_threshold_samples *s, khepera_plausible_threshold_residuals *residuals)
{
    real *r = residuals->value;
    uint32_t age = monitor->age[2];

    if (age == 0u) {
        start_r3(monitor, s, r);
    } else {
        next_r3(monitor, s, r);
    }
    /* a sum is finite only if all its terms are */
    if (finite_number(s->robot__Fx__2 + s->robot__m__2__me__we + s->robot__m__2__wh__ws
                + r[KHEPERA_PLAUSIBLE_THRESHOLD_R3])) {
        age += age < UINT32_MAX ? 1u : 0u;
    } else {
        age = 0u;
        r[KHEPERA_PLAUSIBLE_THRESHOLD_R3] = REAL(0.0);
    }
    monitor->age[2] = age;
    residuals->valid[KHEPERA_PLAUSIBLE_THRESHOLD_R3] = age > monitor->settle[KHEPERA_PLAUSIBLE_THRESHOLD_R3];
}

/* r4 on its first sample: the filter as if it had always been so. */
static void start_r4(
    khepera_plausible_threshold_monitor *monitor, const khepera_plausible_threshold_samples *s, real *r)
{
    const khepera_plausible_threshold_coefficients *c = &monitor->c;
    khepera_plausible_threshold_memory *x = &monitor->x;

    /* khepera.bg:41: r4_w1: degree 1 */
    const real r4_w1_d1 = c->r4_w1_w1_robot__m__2__wh__ws * s->robot__m__2__wh__ws;

    /* khepera.bg:41: r4_w1: input of stage 3 */
    const real r4_w1_u3 = r4_w1_d1;

    /* khepera.bg:41: r4_w1: stage 3, at rest */
    const real r4_w1_y3 = r4_w1_u3;

    /* khepera.bg:41: r4_w1: stage 3: memory */
    x->r4_w1_s3 = c->rest * r4_w1_u3;

    /* khepera.bg:41: r4_w1: input of stage 2 */
    const real r4_w1_u2 = r4_w1_y3 - r4_w1_d1;

    /* khepera.bg:41: r4_w1: stage 2, at rest */
    const real r4_w1_y2 = r4_w1_u2;

    /* khepera.bg:41: r4_w1: stage 2: memory */
    x->r4_w1_s2 = c->rest * r4_w1_u2;

    /* khepera.bg:41: r4_w1: input of stage 1 */
    const real r4_w1_u1 = r4_w1_y2;

    /* khepera.bg:41: r4_w1: stage 1, at rest */
    const real r4_w1_y1 = r4_w1_u1;

    /* khepera.bg:41: r4_w1: stage 1: memory */
    x->r4_w1_s1 = c->rest * r4_w1_u1;

    /* khepera.bg:41: r4: what the tolerance of robot.m[2].wh.fs can do */
    const real r4_w1 = r4_w1_y1;

    /* khepera.bg:41: r4: how far r4 can be from zero if no parameter is out of tolerance */
    r[KHEPERA_PLAUSIBLE_THRESHOLD_R4] = MATH(fabs)(r4_w1);
}

/* r4 on every further sample. */
static void next_r4(
    khepera_plausible_threshold_monitor *monitor, const khepera_plausible_threshold_samples *s, real *r)
{
    const khepera_plausible_threshold_coefficients *c = &monitor->c;
    khepera_plausible_threshold_memory *x = &monitor->x;

    /* khepera.bg:41: r4_w1: degree 1 */
    const real r4_w1_d1 = c->r4_w1_w1_robot__m__2__wh__ws * s->robot__m__2__wh__ws;

    /* khepera.bg:41: r4_w1: input of stage 3 */
    const real r4_w1_u3 = r4_w1_d1;

    /* khepera.bg:41: r4_w1: stage 3 */
    const real r4_w1_y3 = x->r4_w1_s3 + c->b * r4_w1_u3;

    /* khepera.bg:41: r4_w1: stage 3: memory */
    x->r4_w1_s3 = c->a * r4_w1_y3 + c->b * r4_w1_u3;

    /* khepera.bg:41: r4_w1: input of stage 2 */
    const real r4_w1_u2 = r4_w1_y3 - r4_w1_d1;

    /* khepera.bg:41: r4_w1: stage 2 */
    const real r4_w1_y2 = x->r4_w1_s2 + c->b * r4_w1_u2;

    /* khepera.bg:41: r4_w1: stage 2: memory */
    x->r4_w1_s2 = c->a * r4_w1_y2 + c->b * r4_w1_u2;

    /* khepera.bg:41: r4_w1: input of stage 1 */
    const real r4_w1_u1 = r4_w1_y2;

    /* khepera.bg:41: r4_w1: stage 1 */
    const real r4_w1_y1 = x->r4_w1_s1 + c->b * r4_w1_u1;

    /* khepera.bg:41: r4_w1: stage 1: memory */
    x->r4_w1_s1 = c->a * r4_w1_y1 + c->b * r4_w1_u1;

    /* khepera.bg:41: r4: what the tolerance of robot.m[2].wh.fs can do */
    const real r4_w1 = r4_w1_y1;

    /* khepera.bg:41: r4: how far r4 can be from zero if no parameter is out of tolerance */
    r[KHEPERA_PLAUSIBLE_THRESHOLD_R4] = MATH(fabs)(r4_w1);
}

/* One sample for r4; a number that is not finite makes the next sample the first. */
static void run_r4(
    khepera_plausible_threshold_monitor *monitor, const khepera_plausible_threshold_samples *s, khepera_plausible_threshold_residuals *residuals)
{
    real *r = residuals->value;
    uint32_t age = monitor->age[3];

    if (age == 0u) {
        start_r4(monitor, s, r);
    } else {
        next_r4(monitor, s, r);
    }
    /* a sum is finite only if all its terms are */
    if (finite_number(s->robot__m__2__wh__ws + r[KHEPERA_PLAUSIBLE_THRESHOLD_R4])) {
        age += age < UINT32_MAX ? 1u : 0u;
    } else {
        age = 0u;
        r[KHEPERA_PLAUSIBLE_THRESHOLD_R4] = REAL(0.0);
    }
    monitor->age[3] = age;
    residuals->valid[KHEPERA_PLAUSIBLE_THRESHOLD_R4] = age > monitor->settle[KHEPERA_PLAUSIBLE_THRESHOLD_R4];
}

/* r5 on its first sample: the filter as if it had always been so. */
static void start_r5(
    khepera_plausible_threshold_monitor *monitor, const khepera_plausible_threshold_samples *s, real *r)
{
    (void)monitor;
    (void)s;

    /* khepera.bg:114: r5: how far r5 can be from zero if no parameter is out of tolerance */
    r[KHEPERA_PLAUSIBLE_THRESHOLD_R5] = REAL(0.0);
}

/* r5 on every further sample. */
static void next_r5(
    khepera_plausible_threshold_monitor *monitor, const khepera_plausible_threshold_samples *s, real *r)
{
    (void)monitor;
    (void)s;

    /* khepera.bg:114: r5: how far r5 can be from zero if no parameter is out of tolerance */
    r[KHEPERA_PLAUSIBLE_THRESHOLD_R5] = REAL(0.0);
}

/* One sample for r5; a number that is not finite makes the next sample the first. */
static void run_r5(
    khepera_plausible_threshold_monitor *monitor, const khepera_plausible_threshold_samples *s, khepera_plausible_threshold_residuals *residuals)
{
    real *r = residuals->value;
    uint32_t age = monitor->age[4];

    if (age == 0u) {
        start_r5(monitor, s, r);
    } else {
        next_r5(monitor, s, r);
    }
    /* a sum is finite only if all its terms are */
    if (finite_number(r[KHEPERA_PLAUSIBLE_THRESHOLD_R5])) {
        age += age < UINT32_MAX ? 1u : 0u;
    } else {
        age = 0u;
        r[KHEPERA_PLAUSIBLE_THRESHOLD_R5] = REAL(0.0);
    }
    monitor->age[4] = age;
    residuals->valid[KHEPERA_PLAUSIBLE_THRESHOLD_R5] = age > monitor->settle[KHEPERA_PLAUSIBLE_THRESHOLD_R5];
}

void khepera_plausible_threshold_reset(khepera_plausible_threshold_monitor *monitor)
{
    int k;

    for (k = 0; k < 5; ++k) {
        monitor->age[k] = 0u;
    }
}

void khepera_plausible_threshold_step(
    khepera_plausible_threshold_monitor *monitor,
    const khepera_plausible_threshold_samples *samples,
    khepera_plausible_threshold_residuals *residuals)
{
    run_r1(monitor, samples, residuals);
    run_r2(monitor, samples, residuals);
    run_r3(monitor, samples, residuals);
    run_r4(monitor, samples, residuals);
    run_r5(monitor, samples, residuals);
}
