/* khepera_plausible.c: the residuals of KheperaPlausible; generated, see the header. */
#include "khepera_plausible.h"

#ifndef KHEPERA_PLAUSIBLE_NO_THRESHOLDS
#include <math.h>
#endif
#include <stddef.h>

#if defined __FINITE_MATH_ONLY__ && __FINITE_MATH_ONLY__
#error "this code tells numbers from NaN: compile it without -ffinite-math-only (-ffast-math)"
#endif

typedef khepera_plausible_real real;

#define REAL(x) KHEPERA_PLAUSIBLE_CONSTANT(x)
#if defined KHEPERA_PLAUSIBLE_FLOAT && !defined KHEPERA_PLAUSIBLE_REAL
#define MATH(name) name##f
#else
#define MATH(name) name
#endif

/* Neither NaN nor infinite: infinity minus infinity is NaN, and NaN is not 0. */
static bool finite_number(real value)
{
    return value - value <= REAL(0.0);
}

/* tanh to 1e-08, without a library: a quotient of polynomials in the square of x. */
static real near_tanh(real x)
{
    const real square = x * x;
    real above = REAL(0.0121918445997);
    real below = square + REAL(909.519092296);

    if (square > REAL(92.16)) {
        return x < REAL(0.0) ? REAL(-1.0) : REAL(1.0);
    }
    above = above * square + REAL(38.3188174726);
    above = above * square + REAL(14915.8926299);
    above = above * square + REAL(1581360.68088);
    above = above * square + REAL(50661031.066);
    above = above * square + REAL(359943924.938);
    below = below * square + REAL(178021.202073);
    below = below * square + REAL(10469617.8247);
    below = below * square + REAL(170642338.756);
    below = below * square + REAL(359943925.083);
    return x * above / below;
}

/* The larger of two numbers. */
static real greatest(real left, real right)
{
    return right > left ? right : left;
}

/* The least bandwidth * sample_time at which a filter still moves. */
#if defined KHEPERA_PLAUSIBLE_FLOAT && !defined KHEPERA_PLAUSIBLE_REAL
#define SLOWEST REAL(0.0001)
#else
#define SLOWEST REAL(1.0e-09)
#endif

uint32_t khepera_plausible_abi(void)
{
    return KHEPERA_PLAUSIBLE_ABI;
}

const char *khepera_plausible_digest(void)
{
    return KHEPERA_PLAUSIBLE_DIGEST;
}

void khepera_plausible_nominal(khepera_plausible_parameters *parameters)
{
    parameters->Js__1 = REAL(1.0e-05);                /* kg.m^2 */
    parameters->Js__2 = REAL(1.0e-05);                /* kg.m^2 */
    parameters->fe__1 = REAL(1.0e-07);                /* N.m.s/rad */
    parameters->fe__2 = REAL(1.0e-07);                /* N.m.s/rad */
    parameters->R__1 = REAL(0.008);                   /* m */
    parameters->R__2 = REAL(0.008);                   /* m */
    parameters->RL = REAL(0.85);                      /* Ohm */
    parameters->LL = REAL(5.0e-07);                   /* H */
    parameters->CL = REAL(2.2e-10);                   /* F */
    parameters->robot__m__1__tau0 = REAL(0.01);       /* rad */
    parameters->robot__m__1__A = -REAL(4.0);          /* 1 */
    parameters->robot__m__1__el__L = REAL(0.0003);    /* H */
    parameters->robot__m__1__el__Re = REAL(17.6);     /* Ohm */
    parameters->robot__m__1__el__k = REAL(0.00351);   /* N.m/A */
    parameters->robot__m__1__me__Je = REAL(1.4e-08);  /* kg.m^2 */
    parameters->robot__m__1__me__K = REAL(0.1);       /* N.m/rad */
    parameters->robot__m__1__ge__N = REAL(25.0);      /* 1 */
    parameters->robot__m__1__wh__fs = REAL(0.0003);   /* N.m.s/rad */
    parameters->robot__m__2__tau0 = REAL(0.01);       /* rad */
    parameters->robot__m__2__A = -REAL(4.0);          /* 1 */
    parameters->robot__m__2__el__L = REAL(0.0003);    /* H */
    parameters->robot__m__2__el__Re = REAL(17.6);     /* Ohm */
    parameters->robot__m__2__el__k = REAL(0.00351);   /* N.m/A */
    parameters->robot__m__2__me__Je = REAL(1.4e-08);  /* kg.m^2 */
    parameters->robot__m__2__me__K = REAL(0.1);       /* N.m/rad */
    parameters->robot__m__2__ge__N = REAL(25.0);      /* 1 */
    parameters->robot__m__2__wh__fs = REAL(0.0003);   /* N.m.s/rad */
}

/* Whether configure may go on with what it is given. */
static khepera_plausible_status checked(const khepera_plausible_parameters *p, real sample_time, real bandwidth)
{
    const bool finite = finite_number(p->Js__1 + p->Js__2 + p->fe__1 + p->fe__2 + p->R__1 + p->R__2
            + p->RL + p->LL + p->CL + p->robot__m__1__tau0 + p->robot__m__1__A
            + p->robot__m__1__el__L + p->robot__m__1__el__Re + p->robot__m__1__el__k
            + p->robot__m__1__me__Je + p->robot__m__1__me__K + p->robot__m__1__ge__N
            + p->robot__m__1__wh__fs + p->robot__m__2__tau0 + p->robot__m__2__A
            + p->robot__m__2__el__L + p->robot__m__2__el__Re + p->robot__m__2__el__k
            + p->robot__m__2__me__Je + p->robot__m__2__me__K + p->robot__m__2__ge__N
            + p->robot__m__2__wh__fs);

    if (!finite) {
        return KHEPERA_PLAUSIBLE_BAD_PARAMETER;
    }
    if (!(sample_time >= REAL(0.000999999)) || !finite_number(sample_time)) {
        return KHEPERA_PLAUSIBLE_BAD_SAMPLE_TIME;
    }
    if (!(bandwidth * sample_time >= SLOWEST && bandwidth * sample_time <= REAL(3.0))) {
        return KHEPERA_PLAUSIBLE_BAD_BANDWIDTH;
    }
    return KHEPERA_PLAUSIBLE_OK;
}

/* Samples until `constants` time constants of the filter are over. */
static uint32_t samples(real constants, real sample_time, real bandwidth)
{
    const real wait = constants / (bandwidth * sample_time);
    const uint32_t whole = wait < REAL(4.0e9) ? (uint32_t)wait : UINT32_MAX - 1u;

    return (real)whole < wait ? whole + 1u : whole;
}

const khepera_plausible_coefficients khepera_plausible_nominal_coefficients = {
    REAL(0.004011424501424501),      /* r1_robot__m__1__me__we */
    REAL(0.06017094017094017),       /* r1_robot__m__1__wh__ws */
    REAL(1.6045584045584047),        /* r1_robot__Fx__1 */
    -REAL(0.0014041595441595456),    /* r1_w1_robot__m__1__me__we */
    REAL(4.786324786324794e-07),     /* r1_w2_robot__m__1__me__we */
    -REAL(0.040134472934472976),     /* r1_w1_robot__m__1__wh__ws */
    REAL(1.36752136752137e-05),      /* r1_w2_robot__m__1__wh__ws */
    REAL(0.0005470085470085474),     /* r1_w1_robot__Fx__1 */
    REAL(6.666666666666679e-05),     /* bend2 */
    REAL(3.3333333333333396e-05),    /* bend1 */
    REAL(0.9801980198019802),        /* a */
    REAL(0.00990099009900991),       /* b */
    REAL(25.0),                      /* r2_robot__m__1__wh__ws */
    REAL(0.0010416666666666667),     /* scaled_sample_time_over_tau0 */
    REAL(0.026041666666666664),      /* scaled_N_times_sample_time_over_tau0 */
    REAL(0.0024000000000000015),     /* r2_w1_robot__m__1__wh__ws */
    REAL(0.0016000000000000031),     /* r2_w2_robot__m__1__wh__ws */
    REAL(0.06400000000000006),       /* r2_w1_robot__Fx__1 */
    -REAL(0.8000000000000007),       /* r2_w1_tanh */
    REAL(0.004011424501424501),      /* r3_robot__m__2__me__we */
    REAL(0.06017094017094017),       /* r3_robot__m__2__wh__ws */
    REAL(1.6045584045584047),        /* r3_robot__Fx__2 */
    -REAL(0.0014041595441595456),    /* r3_w1_robot__m__2__me__we */
    REAL(4.786324786324794e-07),     /* r3_w2_robot__m__2__me__we */
    -REAL(0.040134472934472976),     /* r3_w1_robot__m__2__wh__ws */
    REAL(1.36752136752137e-05),      /* r3_w2_robot__m__2__wh__ws */
    REAL(0.0005470085470085474),     /* r3_w1_robot__Fx__2 */
    REAL(25.0),                      /* r4_robot__m__2__wh__ws */
    REAL(0.0010416666666666667),     /* scaled_sample_time_over_tau0_2 */
    REAL(0.026041666666666664),      /* scaled_N_times_sample_time_over_tau0_2 */
    REAL(0.0024000000000000015),     /* r4_w1_robot__m__2__wh__ws */
    REAL(0.0016000000000000031),     /* r4_w2_robot__m__2__wh__ws */
    REAL(0.06400000000000006),       /* r4_w1_robot__Fx__2 */
    -REAL(0.8000000000000007),       /* r4_w1_tanh */
    {562u, 562u, 562u, 562u, 346u},  /* samples until each is valid */
    562u                             /* the longest of these */
};

/* r1: coefficients */
static void compute_r1(khepera_plausible_coefficients *c, const khepera_plausible_parameters *p,
        real w)
{
    /* khepera.bg:17: fe[1]*robot.m[1].el.L/robot.m[1].el.k */
    const real fe_times_L_over_k = p->fe__1 * p->robot__m__1__el__L / p->robot__m__1__el__k;

    /* robot.m[1].el.L*robot.m[1].wh.fs/(robot.m[1].ge.N*robot.m[1].el.k) */
    const real product = p->robot__m__1__el__L * p->robot__m__1__wh__fs / p->robot__m__1__ge__N
            / p->robot__m__1__el__k;

    /* robot.m[1].el.Re*robot.m[1].me.Je/robot.m[1].el.k */
    const real Re_times_Je_over_k = p->robot__m__1__el__Re * p->robot__m__1__me__Je
            / p->robot__m__1__el__k;

    /* Js[1]*robot.m[1].el.Re/(robot.m[1].ge.N*robot.m[1].el.k) */
    const real product_2 = p->Js__1 * p->robot__m__1__el__Re / p->robot__m__1__ge__N
            / p->robot__m__1__el__k;

    /* r1: factor of robot.m[1].me.we: robot.m[1].el.k + fe[1]*robot.m[1].el.Re/robot.m[1].el.k */
    c->r1_robot__m__1__me__we = p->robot__m__1__el__k
        + p->fe__1 * p->robot__m__1__el__Re / p->robot__m__1__el__k;

    /* r1: factor of robot.m[1].wh.ws:
     * robot.m[1].el.Re*robot.m[1].wh.fs/(robot.m[1].ge.N*robot.m[1].el.k) */
    c->r1_robot__m__1__wh__ws = p->robot__m__1__el__Re * p->robot__m__1__wh__fs
            / p->robot__m__1__ge__N / p->robot__m__1__el__k;

    /* r1: factor of robot.Fx[1]: R[1]*robot.m[1].el.Re/(robot.m[1].ge.N*robot.m[1].el.k) */
    c->r1_robot__Fx__1 = p->R__1 * p->robot__m__1__el__Re / p->robot__m__1__ge__N
            / p->robot__m__1__el__k;

    /* r1: factor of robot.m[1].me.we' */
    c->r1_w1_robot__m__1__me__we = (-fe_times_L_over_k - Re_times_Je_over_k) * w;

    /* r1: factor of robot.m[1].me.we'' */
    c->r1_w2_robot__m__1__me__we = p->robot__m__1__el__L * p->robot__m__1__me__Je * w * w
            / p->robot__m__1__el__k;

    /* r1: factor of robot.m[1].wh.ws' */
    c->r1_w1_robot__m__1__wh__ws = (-product - product_2) * w;

    /* r1: factor of robot.m[1].wh.ws'' */
    c->r1_w2_robot__m__1__wh__ws = p->Js__1 * p->robot__m__1__el__L * w * w / p->robot__m__1__ge__N
            / p->robot__m__1__el__k;

    /* r1: factor of robot.Fx[1]' */
    c->r1_w1_robot__Fx__1 = p->R__1 * p->robot__m__1__el__L * w / p->robot__m__1__ge__N
            / p->robot__m__1__el__k;
}

/* filter: coefficients */
static void compute_filter(khepera_plausible_coefficients *c, real pole, real turn)
{
    /* turn^2 */
    const real turn_2 = turn * turn;

    /* filter: 2 * (w*sample_time)^2/12 */
    c->bend2 = turn_2 / REAL(6.0);

    /* filter: 1 * (w*sample_time)^2/12 */
    c->bend1 = turn_2 / REAL(12.0);

    /* filter: what is left of a memory a sample later */
    c->a = pole;

    /* filter: weight of a sample, new and a sample later */
    c->b = REAL(0.5) * (REAL(1.0) - pole);
}

/* r2: coefficients */
static void compute_r2(khepera_plausible_coefficients *c, const khepera_plausible_parameters *p,
        real w)
{
    /* khepera.bg:41: r2: factor of robot.m[1].wh.ws: robot.m[1].ge.N */
    c->r2_robot__m__1__wh__ws = p->robot__m__1__ge__N;

    /* r2: factor of robot.m[1].wh.ws' */
    c->r2_w1_robot__m__1__wh__ws = p->robot__m__1__wh__fs * w / p->robot__m__1__ge__N
            / p->robot__m__1__me__K;

    /* r2: factor of robot.m[1].wh.ws'' */
    c->r2_w2_robot__m__1__wh__ws = p->Js__1 * w * w / p->robot__m__1__ge__N / p->robot__m__1__me__K;

    /* r2: factor of robot.Fx[1]' */
    c->r2_w1_robot__Fx__1 = p->R__1 * w / p->robot__m__1__ge__N / p->robot__m__1__me__K;

    /* r2: factor of D(tanh(Int(robot.m[1].me.we)/(4*robot.m[1].tau0) -
     * robot.m[1].ge.N*Int(robot.m[1].wh.ws)/(4*robot.m[1].tau0))) */
    c->r2_w1_tanh = p->robot__m__1__tau0 * p->robot__m__1__A * w;
}

/* r3: coefficients */
static void compute_r3(khepera_plausible_coefficients *c, const khepera_plausible_parameters *p,
        real w)
{
    /* khepera.bg:17: fe[2]*robot.m[2].el.L/robot.m[2].el.k */
    const real fe_times_L_over_k_2 = p->fe__2 * p->robot__m__2__el__L / p->robot__m__2__el__k;

    /* robot.m[2].el.L*robot.m[2].wh.fs/(robot.m[2].ge.N*robot.m[2].el.k) */
    const real product_3 = p->robot__m__2__el__L * p->robot__m__2__wh__fs / p->robot__m__2__ge__N
            / p->robot__m__2__el__k;

    /* robot.m[2].el.Re*robot.m[2].me.Je/robot.m[2].el.k */
    const real Re_times_Je_over_k_2 = p->robot__m__2__el__Re * p->robot__m__2__me__Je
            / p->robot__m__2__el__k;

    /* Js[2]*robot.m[2].el.Re/(robot.m[2].ge.N*robot.m[2].el.k) */
    const real product_4 = p->Js__2 * p->robot__m__2__el__Re / p->robot__m__2__ge__N
            / p->robot__m__2__el__k;

    /* r3: factor of robot.m[2].me.we: robot.m[2].el.k + fe[2]*robot.m[2].el.Re/robot.m[2].el.k */
    c->r3_robot__m__2__me__we = p->robot__m__2__el__k
        + p->fe__2 * p->robot__m__2__el__Re / p->robot__m__2__el__k;

    /* r3: factor of robot.m[2].wh.ws:
     * robot.m[2].el.Re*robot.m[2].wh.fs/(robot.m[2].ge.N*robot.m[2].el.k) */
    c->r3_robot__m__2__wh__ws = p->robot__m__2__el__Re * p->robot__m__2__wh__fs
            / p->robot__m__2__ge__N / p->robot__m__2__el__k;

    /* r3: factor of robot.Fx[2]: R[2]*robot.m[2].el.Re/(robot.m[2].ge.N*robot.m[2].el.k) */
    c->r3_robot__Fx__2 = p->R__2 * p->robot__m__2__el__Re / p->robot__m__2__ge__N
            / p->robot__m__2__el__k;

    /* r3: factor of robot.m[2].me.we' */
    c->r3_w1_robot__m__2__me__we = (-fe_times_L_over_k_2 - Re_times_Je_over_k_2) * w;

    /* r3: factor of robot.m[2].me.we'' */
    c->r3_w2_robot__m__2__me__we = p->robot__m__2__el__L * p->robot__m__2__me__Je * w * w
            / p->robot__m__2__el__k;

    /* r3: factor of robot.m[2].wh.ws' */
    c->r3_w1_robot__m__2__wh__ws = (-product_3 - product_4) * w;

    /* r3: factor of robot.m[2].wh.ws'' */
    c->r3_w2_robot__m__2__wh__ws = p->Js__2 * p->robot__m__2__el__L * w * w / p->robot__m__2__ge__N
            / p->robot__m__2__el__k;

    /* r3: factor of robot.Fx[2]' */
    c->r3_w1_robot__Fx__2 = p->R__2 * p->robot__m__2__el__L * w / p->robot__m__2__ge__N
            / p->robot__m__2__el__k;
}

/* r4: coefficients */
static void compute_r4(khepera_plausible_coefficients *c, const khepera_plausible_parameters *p,
        real w)
{
    /* khepera.bg:41: r4: factor of robot.m[2].wh.ws: robot.m[2].ge.N */
    c->r4_robot__m__2__wh__ws = p->robot__m__2__ge__N;

    /* r4: factor of robot.m[2].wh.ws' */
    c->r4_w1_robot__m__2__wh__ws = p->robot__m__2__wh__fs * w / p->robot__m__2__ge__N
            / p->robot__m__2__me__K;

    /* r4: factor of robot.m[2].wh.ws'' */
    c->r4_w2_robot__m__2__wh__ws = p->Js__2 * w * w / p->robot__m__2__ge__N / p->robot__m__2__me__K;

    /* r4: factor of robot.Fx[2]' */
    c->r4_w1_robot__Fx__2 = p->R__2 * w / p->robot__m__2__ge__N / p->robot__m__2__me__K;

    /* r4: factor of D(tanh(Int(robot.m[2].me.we)/(4*robot.m[2].tau0) -
     * robot.m[2].ge.N*Int(robot.m[2].wh.ws)/(4*robot.m[2].tau0))) */
    c->r4_w1_tanh = p->robot__m__2__tau0 * p->robot__m__2__A * w;
}

/* The coefficients, from the parameters. */
static void compute_coefficients(khepera_plausible_coefficients *c,
        const khepera_plausible_parameters *p, real sample_time, real bandwidth)
{
    /* bandwidth*sample_time */
    const real x_ = bandwidth * sample_time;

    /* of a stage: what is left of its memory */
    const real pole = greatest(REAL(2.0) - x_, REAL(0.0)) / (x_ + REAL(2.0));

    /* w*sample_time, x or 2 */
    const real turn = REAL(2.0) * (REAL(1.0) - pole) / (pole + REAL(1.0));

    /* w of the filter 1/(1 + D/w) */
    const real w = turn / sample_time;

    /* khepera.bg:41: (1/96)*sample_time/robot.m[1].tau0 */
    c->scaled_sample_time_over_tau0 = sample_time / REAL(96.0) / p->robot__m__1__tau0;

    /* (1/96)*robot.m[1].ge.N*sample_time/robot.m[1].tau0 */
    c->scaled_N_times_sample_time_over_tau0 = p->robot__m__1__ge__N * sample_time / REAL(96.0)
            / p->robot__m__1__tau0;

    /* (1/96)*sample_time/robot.m[2].tau0 */
    c->scaled_sample_time_over_tau0_2 = sample_time / REAL(96.0) / p->robot__m__2__tau0;

    /* (1/96)*robot.m[2].ge.N*sample_time/robot.m[2].tau0 */
    c->scaled_N_times_sample_time_over_tau0_2 = p->robot__m__2__ge__N * sample_time / REAL(96.0)
            / p->robot__m__2__tau0;

    compute_r1(c, p, w);
    compute_filter(c, pole, turn);
    compute_r2(c, p, w);
    compute_r3(c, p, w);
    compute_r4(c, p, w);
}

static bool coefficients_are_finite(const khepera_plausible_coefficients *c)
{
    return finite_number(c->r1_robot__m__1__me__we + c->r1_robot__m__1__wh__ws + c->r1_robot__Fx__1
            + c->r1_w1_robot__m__1__me__we + c->r1_w2_robot__m__1__me__we
            + c->r1_w1_robot__m__1__wh__ws + c->r1_w2_robot__m__1__wh__ws + c->r1_w1_robot__Fx__1
            + c->bend2 + c->bend1 + c->a + c->b + c->r2_robot__m__1__wh__ws
            + c->scaled_sample_time_over_tau0 + c->scaled_N_times_sample_time_over_tau0
            + c->r2_w1_robot__m__1__wh__ws + c->r2_w2_robot__m__1__wh__ws + c->r2_w1_robot__Fx__1
            + c->r2_w1_tanh + c->r3_robot__m__2__me__we + c->r3_robot__m__2__wh__ws
            + c->r3_robot__Fx__2 + c->r3_w1_robot__m__2__me__we + c->r3_w2_robot__m__2__me__we
            + c->r3_w1_robot__m__2__wh__ws + c->r3_w2_robot__m__2__wh__ws + c->r3_w1_robot__Fx__2
            + c->r4_robot__m__2__wh__ws + c->scaled_sample_time_over_tau0_2
            + c->scaled_N_times_sample_time_over_tau0_2 + c->r4_w1_robot__m__2__wh__ws
            + c->r4_w2_robot__m__2__wh__ws + c->r4_w1_robot__Fx__2 + c->r4_w1_tanh);
}

khepera_plausible_status khepera_plausible_configure(
    khepera_plausible_coefficients *coefficients,
    const khepera_plausible_parameters *parameters,
    khepera_plausible_real sample_time,
    khepera_plausible_real bandwidth)
{
    khepera_plausible_coefficients *c = coefficients;
    const khepera_plausible_status status = checked(parameters, sample_time, bandwidth);
    int k;

    for (k = 0; k < KHEPERA_PLAUSIBLE_RESIDUALS; ++k) {
        c->settle[k] = UINT32_MAX;
    }
    c->longest = UINT32_MAX;
    if (status != KHEPERA_PLAUSIBLE_OK) {
        return status;
    }
    compute_coefficients(c, parameters, sample_time, bandwidth);
    if (!coefficients_are_finite(c)) {
        return KHEPERA_PLAUSIBLE_BAD_COEFFICIENT;
    }
    c->settle[KHEPERA_PLAUSIBLE_R1] = samples(REAL(11.228872242412663), sample_time, bandwidth);
    c->settle[KHEPERA_PLAUSIBLE_R2] = samples(REAL(11.228872242412663), sample_time, bandwidth);
    c->settle[KHEPERA_PLAUSIBLE_R3] = samples(REAL(11.228872242412663), sample_time, bandwidth);
    c->settle[KHEPERA_PLAUSIBLE_R4] = samples(REAL(11.228872242412663), sample_time, bandwidth);
    c->settle[KHEPERA_PLAUSIBLE_R5] = samples(REAL(6.907755278982138), sample_time, bandwidth);
    c->longest = c->settle[KHEPERA_PLAUSIBLE_R1];
    return KHEPERA_PLAUSIBLE_OK;
}

/* r1 on one sample.
 * khepera.bg:17: r1 = robot.U0[1] - robot.m[1].el.k*robot.m[1].me.we -
 * robot.m[1].el.Re*robot.m[1].el.k.e2/robot.m[1].el.k -
 * robot.m[1].el.L*D(robot.m[1].el.k.e2)/robot.m[1].el.k
 * where robot.m[1].el.k.e2 = fe[1]*robot.m[1].me.we + robot.m[1].me.Je*D(robot.m[1].me.we) +
 * (robot.m[1].wh.fs*robot.m[1].wh.ws + R[1]*robot.Fx[1] +
 * Js[1]*D(robot.m[1].wh.ws))/robot.m[1].ge.N */
static void run_r1(
    const khepera_plausible_coefficients *c, khepera_plausible_memory *x, const khepera_plausible_samples *s, real *r)
{
    const bool first = x->youngest == 0u && x->age[0] == 0u;

    if (first) {
        /* nothing is remembered yet */
        x->r1_s3 = REAL(0.0);
        x->r1_s2 = REAL(0.0);
        x->r1_s1 = REAL(0.0);
    }

    /* a stage of the filter; on the first sample it is at rest */
    const real a = first ? -c->b : c->a;
    const real b = first ? REAL(1.0) : c->b;

    /* terms of order 0 */
    const real g0 = s->robot__U0__1 - c->r1_robot__m__1__me__we * s->robot__m__1__me__we
        - c->r1_robot__m__1__wh__ws * s->robot__m__1__wh__ws - c->r1_robot__Fx__1 * s->robot__Fx__1;

    /* terms of order 1 */
    const real g1 = c->r1_w1_robot__m__1__me__we * s->robot__m__1__me__we
        + c->r1_w1_robot__m__1__wh__ws * s->robot__m__1__wh__ws
        - c->r1_w1_robot__Fx__1 * s->robot__Fx__1;

    /* error of order 0 */
    const real e0 = c->bend2 * g0;

    /* degree 2 */
    const real d2 = c->r1_w2_robot__m__1__me__we * s->robot__m__1__me__we
        + c->r1_w2_robot__m__1__wh__ws * s->robot__m__1__wh__ws + e0;

    /* error of order 1 */
    const real e1 = c->bend1 * g1;

    /* the filter multiplied out */
    const real p2_1 = e1 - d2;
    const real p1_1 = p2_1 + e1;
    const real p1_2 = g1 - p2_1;

    /* stage 3 */
    const real u3 = g0 - p1_2;
    const real y3 = x->r1_s3 + b * u3;
    x->r1_s3 = a * y3 + b * u3;

    /* stage 2 */
    const real u2 = y3 + p1_2 - p1_1;
    const real y2 = x->r1_s2 + b * u2;
    x->r1_s2 = a * y2 + b * u2;

    /* stage 1 */
    const real u1 = y2 + p1_1 + e1;
    const real y1 = x->r1_s1 + b * u1;
    x->r1_s1 = a * y1 + b * u1;

    r[KHEPERA_PLAUSIBLE_R1] = y1 - e1;
}

/* tanh(Int(robot.m[1].me.we)/(4*robot.m[1].tau0) -
 * robot.m[1].ge.N*Int(robot.m[1].wh.ws)/(4*robot.m[1].tau0)) */
static real run_r2_tanh(const khepera_plausible_coefficients *c, khepera_plausible_memory *x,
        const khepera_plausible_samples *s, bool first)
{
    /* sample_time/24 times robot.m[1].me.we/(4*robot.m[1].tau0) -
     * robot.m[1].ge.N*robot.m[1].wh.ws/(4*robot.m[1].tau0), what is integrated */
    const real rate = c->scaled_sample_time_over_tau0 * s->robot__m__1__me__we
        - c->scaled_N_times_sample_time_over_tau0 * s->robot__m__1__wh__ws;

    if (first) {
        /* r2: the integral is 0 at the start */
        x->r2_q = -REAL(12.0) * rate;
        x->r2_rate1 = rate;
        x->r2_rate2 = rate;
    }

    /* its integral since the start, by the rule of Adams */
    const real integral = x->r2_q + REAL(9.0) * rate + REAL(4.0) * x->r2_rate1 - x->r2_rate2;
    x->r2_q = x->r2_q + REAL(24.0) * rate;
    x->r2_rate2 = x->r2_rate1;
    x->r2_rate1 = rate;

    /* tanh(Int(robot.m[1].me.we)/(4*robot.m[1].tau0) -
     * robot.m[1].ge.N*Int(robot.m[1].wh.ws)/(4*robot.m[1].tau0)) */
    const real tanh_ = near_tanh(integral);

    return tanh_;
}

/* r2 on one sample.
 * khepera.bg:41: r2 = robot.m[1].me.we - robot.m[1].ge.N*robot.m[1].wh.ws -
 * D(robot.m[1].wh.fs*robot.m[1].wh.ws + R[1]*robot.Fx[1] + Js[1]*D(robot.m[1].wh.ws) -
 * robot.m[1].tau0*robot.m[1].A*robot.m[1].ge.N*robot.m[1].me.K*tanh((Int(robot.m[1].me.we) -
 * robot.m[1].ge.N*Int(robot.m[1].wh.ws))/(4*robot.m[1].tau0)))/(robot.m[1].ge.N*robot.m[1].me.K) */
static void run_r2(
    const khepera_plausible_coefficients *c, khepera_plausible_memory *x, const khepera_plausible_samples *s, real *r)
{
    const bool first = x->youngest == 0u && x->age[1] == 0u;

    if (first) {
        /* nothing is remembered yet */
        x->r2_s3 = REAL(0.0);
        x->r2_s2 = REAL(0.0);
        x->r2_s1 = REAL(0.0);
    }

    /* a stage of the filter; on the first sample it is at rest */
    const real a = first ? -c->b : c->a;
    const real b = first ? REAL(1.0) : c->b;

    const real tanh_ = run_r2_tanh(c, x, s, first);

    /* terms of order 0 */
    const real g0 = s->robot__m__1__me__we - c->r2_robot__m__1__wh__ws * s->robot__m__1__wh__ws;

    /* terms of order 1 */
    const real g1 = c->r2_w1_tanh * tanh_ - c->r2_w1_robot__m__1__wh__ws * s->robot__m__1__wh__ws
        - c->r2_w1_robot__Fx__1 * s->robot__Fx__1;

    /* error of order 0 */
    const real e0 = c->bend2 * g0;

    /* degree 2 */
    const real d2 = c->r2_w2_robot__m__1__wh__ws * s->robot__m__1__wh__ws + e0;

    /* error of order 1 */
    const real e1 = c->bend1 * g1;

    /* the filter multiplied out */
    const real p2_1 = e1 - d2;
    const real p1_1 = p2_1 + e1;
    const real p1_2 = g1 - p2_1;

    /* stage 3 */
    const real u3 = g0 - p1_2;
    const real y3 = x->r2_s3 + b * u3;
    x->r2_s3 = a * y3 + b * u3;

    /* stage 2 */
    const real u2 = y3 + p1_2 - p1_1;
    const real y2 = x->r2_s2 + b * u2;
    x->r2_s2 = a * y2 + b * u2;

    /* stage 1 */
    const real u1 = y2 + p1_1 + e1;
    const real y1 = x->r2_s1 + b * u1;
    x->r2_s1 = a * y1 + b * u1;

    r[KHEPERA_PLAUSIBLE_R2] = y1 - e1;
}

/* r3 on one sample.
 * khepera.bg:17: r3 = robot.U0[2] - robot.m[2].el.k*robot.m[2].me.we -
 * robot.m[2].el.Re*robot.m[2].el.k.e2/robot.m[2].el.k -
 * robot.m[2].el.L*D(robot.m[2].el.k.e2)/robot.m[2].el.k
 * where robot.m[2].el.k.e2 = fe[2]*robot.m[2].me.we + robot.m[2].me.Je*D(robot.m[2].me.we) +
 * (robot.m[2].wh.fs*robot.m[2].wh.ws + R[2]*robot.Fx[2] +
 * Js[2]*D(robot.m[2].wh.ws))/robot.m[2].ge.N */
static void run_r3(
    const khepera_plausible_coefficients *c, khepera_plausible_memory *x, const khepera_plausible_samples *s, real *r)
{
    const bool first = x->youngest == 0u && x->age[2] == 0u;

    if (first) {
        /* nothing is remembered yet */
        x->r3_s3 = REAL(0.0);
        x->r3_s2 = REAL(0.0);
        x->r3_s1 = REAL(0.0);
    }

    /* a stage of the filter; on the first sample it is at rest */
    const real a = first ? -c->b : c->a;
    const real b = first ? REAL(1.0) : c->b;

    /* terms of order 0 */
    const real g0 = s->robot__U0__2 - c->r3_robot__m__2__me__we * s->robot__m__2__me__we
        - c->r3_robot__m__2__wh__ws * s->robot__m__2__wh__ws - c->r3_robot__Fx__2 * s->robot__Fx__2;

    /* terms of order 1 */
    const real g1 = c->r3_w1_robot__m__2__me__we * s->robot__m__2__me__we
        + c->r3_w1_robot__m__2__wh__ws * s->robot__m__2__wh__ws
        - c->r3_w1_robot__Fx__2 * s->robot__Fx__2;

    /* error of order 0 */
    const real e0 = c->bend2 * g0;

    /* degree 2 */
    const real d2 = c->r3_w2_robot__m__2__me__we * s->robot__m__2__me__we
        + c->r3_w2_robot__m__2__wh__ws * s->robot__m__2__wh__ws + e0;

    /* error of order 1 */
    const real e1 = c->bend1 * g1;

    /* the filter multiplied out */
    const real p2_1 = e1 - d2;
    const real p1_1 = p2_1 + e1;
    const real p1_2 = g1 - p2_1;

    /* stage 3 */
    const real u3 = g0 - p1_2;
    const real y3 = x->r3_s3 + b * u3;
    x->r3_s3 = a * y3 + b * u3;

    /* stage 2 */
    const real u2 = y3 + p1_2 - p1_1;
    const real y2 = x->r3_s2 + b * u2;
    x->r3_s2 = a * y2 + b * u2;

    /* stage 1 */
    const real u1 = y2 + p1_1 + e1;
    const real y1 = x->r3_s1 + b * u1;
    x->r3_s1 = a * y1 + b * u1;

    r[KHEPERA_PLAUSIBLE_R3] = y1 - e1;
}

/* tanh(Int(robot.m[2].me.we)/(4*robot.m[2].tau0) -
 * robot.m[2].ge.N*Int(robot.m[2].wh.ws)/(4*robot.m[2].tau0)) */
static real run_r4_tanh(const khepera_plausible_coefficients *c, khepera_plausible_memory *x,
        const khepera_plausible_samples *s, bool first)
{
    /* sample_time/24 times robot.m[2].me.we/(4*robot.m[2].tau0) -
     * robot.m[2].ge.N*robot.m[2].wh.ws/(4*robot.m[2].tau0), what is integrated */
    const real rate = c->scaled_sample_time_over_tau0_2 * s->robot__m__2__me__we
        - c->scaled_N_times_sample_time_over_tau0_2 * s->robot__m__2__wh__ws;

    if (first) {
        /* r4: the integral is 0 at the start */
        x->r4_q = -REAL(12.0) * rate;
        x->r4_rate1 = rate;
        x->r4_rate2 = rate;
    }

    /* its integral since the start, by the rule of Adams */
    const real integral = x->r4_q + REAL(9.0) * rate + REAL(4.0) * x->r4_rate1 - x->r4_rate2;
    x->r4_q = x->r4_q + REAL(24.0) * rate;
    x->r4_rate2 = x->r4_rate1;
    x->r4_rate1 = rate;

    /* tanh(Int(robot.m[2].me.we)/(4*robot.m[2].tau0) -
     * robot.m[2].ge.N*Int(robot.m[2].wh.ws)/(4*robot.m[2].tau0)) */
    const real tanh_ = near_tanh(integral);

    return tanh_;
}

/* r4 on one sample.
 * khepera.bg:41: r4 = robot.m[2].me.we - robot.m[2].ge.N*robot.m[2].wh.ws -
 * D(robot.m[2].wh.fs*robot.m[2].wh.ws + R[2]*robot.Fx[2] + Js[2]*D(robot.m[2].wh.ws) -
 * robot.m[2].tau0*robot.m[2].A*robot.m[2].ge.N*robot.m[2].me.K*tanh((Int(robot.m[2].me.we) -
 * robot.m[2].ge.N*Int(robot.m[2].wh.ws))/(4*robot.m[2].tau0)))/(robot.m[2].ge.N*robot.m[2].me.K) */
static void run_r4(
    const khepera_plausible_coefficients *c, khepera_plausible_memory *x, const khepera_plausible_samples *s, real *r)
{
    const bool first = x->youngest == 0u && x->age[3] == 0u;

    if (first) {
        /* nothing is remembered yet */
        x->r4_s3 = REAL(0.0);
        x->r4_s2 = REAL(0.0);
        x->r4_s1 = REAL(0.0);
    }

    /* a stage of the filter; on the first sample it is at rest */
    const real a = first ? -c->b : c->a;
    const real b = first ? REAL(1.0) : c->b;

    const real tanh_ = run_r4_tanh(c, x, s, first);

    /* terms of order 0 */
    const real g0 = s->robot__m__2__me__we - c->r4_robot__m__2__wh__ws * s->robot__m__2__wh__ws;

    /* terms of order 1 */
    const real g1 = c->r4_w1_tanh * tanh_ - c->r4_w1_robot__m__2__wh__ws * s->robot__m__2__wh__ws
        - c->r4_w1_robot__Fx__2 * s->robot__Fx__2;

    /* error of order 0 */
    const real e0 = c->bend2 * g0;

    /* degree 2 */
    const real d2 = c->r4_w2_robot__m__2__wh__ws * s->robot__m__2__wh__ws + e0;

    /* error of order 1 */
    const real e1 = c->bend1 * g1;

    /* the filter multiplied out */
    const real p2_1 = e1 - d2;
    const real p1_1 = p2_1 + e1;
    const real p1_2 = g1 - p2_1;

    /* stage 3 */
    const real u3 = g0 - p1_2;
    const real y3 = x->r4_s3 + b * u3;
    x->r4_s3 = a * y3 + b * u3;

    /* stage 2 */
    const real u2 = y3 + p1_2 - p1_1;
    const real y2 = x->r4_s2 + b * u2;
    x->r4_s2 = a * y2 + b * u2;

    /* stage 1 */
    const real u1 = y2 + p1_1 + e1;
    const real y1 = x->r4_s1 + b * u1;
    x->r4_s1 = a * y1 + b * u1;

    r[KHEPERA_PLAUSIBLE_R4] = y1 - e1;
}

/* r5 on one sample.
 * khepera.bg:114: r5 = robot.Uin - robot.line.cell[1].mid.e - RL*robot.line.cell[1].left.f/2 -
 * LL*D(robot.line.cell[1].left.f)/2
 * where robot.line.cell[1].left.f = CL*D(robot.Us) + CL*D(robot.line.cell[1].mid.e)
 * robot.line.cell[1].mid.e = robot.Us + RL*CL*D(robot.Us)/2 + LL*CL*D(robot.Us, 2)/2 */
static void run_r5(
    const khepera_plausible_coefficients *c, khepera_plausible_memory *x, const khepera_plausible_samples *s, real *r)
{
    const bool first = x->youngest == 0u && x->age[4] == 0u;

    if (first) {
        /* nothing is remembered yet */
        x->r5_s1 = REAL(0.0);
    }

    /* a stage of the filter; on the first sample it is at rest */
    const real a = first ? -c->b : c->a;
    const real b = first ? REAL(1.0) : c->b;

    /* stage 1 */
    const real u1 = s->robot__Uin - s->robot__Us;
    const real y1 = x->r5_s1 + b * u1;
    x->r5_s1 = a * y1 + b * u1;

    r[KHEPERA_PLAUSIBLE_R5] = y1;
}

/* Ages and validity one by one: a number that is not finite makes the next sample the first. */
static void count_samples(
    const khepera_plausible_coefficients *c,
    khepera_plausible_memory *x,
    khepera_plausible_residuals *out)
{
    /* the residuals that are computed, and what each one goes with */
    static const uint8_t number[] = {
        0, 1, 2, 3, 4
    };
    static const uint8_t part[] = {
        0, 1, 2, 3, 4
    };
    bool finite[5];
    int k;

    finite[0] = true;
    finite[1] = true;
    finite[2] = true;
    finite[3] = true;
    finite[4] = true;
    for (k = 0; k < 5; ++k) {
        finite[part[k]] = finite[part[k]] && finite_number(out->value[number[k]]);
    }
    x->youngest = UINT32_MAX;
    for (k = 0; k < 5; ++k) {
        x->age[k] = finite[k] ? x->age[k] + (x->age[k] < UINT32_MAX ? 1u : 0u) : 0u;
        x->youngest = x->age[k] < x->youngest ? x->age[k] : x->youngest;
    }
    for (k = 0; k < 5; ++k) {
        out->value[number[k]] = finite[part[k]] ? out->value[number[k]] : REAL(0.0);
        out->valid[number[k]] = x->age[part[k]] > c->settle[number[k]];
    }
}

void khepera_plausible_reset(khepera_plausible_memory *memory)
{
    int k;

    for (k = 0; k < 5; ++k) {
        memory->age[k] = 0u;
    }
    memory->youngest = 0u;
}

void khepera_plausible_step(
    const khepera_plausible_coefficients *coefficients,
    khepera_plausible_memory *memory,
    const khepera_plausible_samples *samples,
    khepera_plausible_residuals *residuals)
{
    const khepera_plausible_coefficients *c = coefficients;
    khepera_plausible_memory *x = memory;
    const khepera_plausible_samples *s = samples;
    real *r = residuals->value;
    int k;

    run_r1(c, x, s, r);
    run_r2(c, x, s, r);
    run_r3(c, x, s, r);
    run_r4(c, x, s, r);
    run_r5(c, x, s, r);
    /* a sum is finite only if all its terms are */
    if (x->youngest > c->longest
            && finite_number(r[KHEPERA_PLAUSIBLE_R1] + r[KHEPERA_PLAUSIBLE_R2]
                + r[KHEPERA_PLAUSIBLE_R3] + r[KHEPERA_PLAUSIBLE_R4] + r[KHEPERA_PLAUSIBLE_R5])) {
        for (k = 0; k < KHEPERA_PLAUSIBLE_RESIDUALS; ++k) {
            residuals->valid[k] = true;
        }
    } else {
        count_samples(c, x, residuals);
    }
}

#ifndef KHEPERA_PLAUSIBLE_NO_THRESHOLDS

const khepera_plausible_threshold_coefficients khepera_plausible_threshold_nominal_coefficients = {
    REAL(5.014245014245014e-05),     /* r1_w1_robot__m__1__me__we */
    REAL(1.7094017094017106e-08),    /* r1_w1_w1_robot__m__1__me__we */
    REAL(3.3333333333333396e-05),    /* bend1 */
    REAL(0.9801980198019802),        /* a */
    REAL(0.00990099009900991),       /* b */
    REAL(0.08022792022792023),       /* r1_w2_robot__Fx__1 */
    REAL(0.0030085470085470085),     /* r1_w2_robot__m__1__wh__ws */
    REAL(0.0020056980056980074),     /* r1_w2_w1_robot__m__1__wh__ws */
    REAL(2.507122507122507e-05),     /* r1_w2_robot__m__1__me__we */
    REAL(7.019943019943026e-05),     /* r1_w2_w1_robot__m__1__me__we */
    -REAL(6.017150997150998e-05),    /* r1_w3_robot__m__1__me__we */
    REAL(2.8083190883190912e-05),    /* r1_w3_w1_robot__m__1__me__we */
    REAL(9.572649572649589e-09),     /* r1_w3_w2_robot__m__1__me__we */
    REAL(0.0320911680911681),        /* r1_w3_robot__Fx__1 */
    REAL(1.0940170940170947e-05),    /* r1_w3_w1_robot__Fx__1 */
    REAL(0.0012034188034188034),     /* r1_w3_robot__m__1__wh__ws */
    REAL(0.0008026894586894596),     /* r1_w3_w1_robot__m__1__wh__ws */
    REAL(2.7350427350427397e-07),    /* r1_w3_w2_robot__m__1__wh__ws */
    REAL(6.666666666666679e-05),     /* bend2 */
    REAL(0.006017094017094017),      /* r1_w4_robot__m__1__wh__ws */
    REAL(2.051282051282053e-06),     /* r1_w4_w1_robot__m__1__wh__ws */
    REAL(2.6086482779396166e-06),    /* r1_w5_robot__m__1__me__we */
    REAL(1.0434593111758465e-06),    /* r1_w6_robot__m__1__me__we */
    REAL(3.557247651735843e-10),     /* r1_w6_w1_robot__m__1__me__we */
    REAL(5.217296555879233e-07),     /* r1_w7_robot__m__1__me__we */
    REAL(1.4608430356461866e-06),    /* r1_w7_w1_robot__m__1__me__we */
    REAL(6.260755867055079e-05),     /* r1_w7_robot__m__1__wh__ws */
    REAL(4.17383724470339e-05),      /* r1_w7_w1_robot__m__1__wh__ws */
    REAL(0.0016695348978813548),     /* r1_w7_robot__Fx__1 */
    REAL(0.00031303779335275394),    /* r1_w8_robot__m__1__wh__ws */
    REAL(2.0869186223516933e-07),    /* r1_w9_robot__m__1__me__we */
    -REAL(5.844083592115093e-07),    /* r1_w9_w1_robot__m__1__me__we */
    REAL(1.992058684972074e-10),     /* r1_w9_w2_robot__m__1__me__we */
    REAL(2.5043023468220318e-05),    /* r1_w9_robot__m__1__wh__ws */
    -REAL(1.670388637317773e-05),    /* r1_w9_w1_robot__m__1__wh__ws */
    REAL(5.691596242777355e-09),     /* r1_w9_w2_robot__m__1__wh__ws */
    REAL(0.000667813959152542),      /* r1_w9_robot__Fx__1 */
    REAL(2.2766384971109398e-07),    /* r1_w9_w1_robot__Fx__1 */
    REAL(0.00012521511734110157),    /* r1_w10_robot__m__1__wh__ws */
    REAL(4.2686971820830126e-08),    /* r1_w10_w1_robot__m__1__wh__ws */
    REAL(0.0002400000000000002),     /* r2_w1_w1_robot__m__1__wh__ws */
    REAL(5.014245014245014e-05),     /* r3_w1_robot__m__2__me__we */
    REAL(1.7094017094017106e-08),    /* r3_w1_w1_robot__m__2__me__we */
    REAL(0.08022792022792023),       /* r3_w2_robot__Fx__2 */
    REAL(0.0030085470085470085),     /* r3_w2_robot__m__2__wh__ws */
    REAL(0.0020056980056980074),     /* r3_w2_w1_robot__m__2__wh__ws */
    REAL(2.507122507122507e-05),     /* r3_w2_robot__m__2__me__we */
    REAL(7.019943019943026e-05),     /* r3_w2_w1_robot__m__2__me__we */
    -REAL(6.017150997150998e-05),    /* r3_w3_robot__m__2__me__we */
    REAL(2.8083190883190912e-05),    /* r3_w3_w1_robot__m__2__me__we */
    REAL(9.572649572649589e-09),     /* r3_w3_w2_robot__m__2__me__we */
    REAL(0.0320911680911681),        /* r3_w3_robot__Fx__2 */
    REAL(1.0940170940170947e-05),    /* r3_w3_w1_robot__Fx__2 */
    REAL(0.0012034188034188034),     /* r3_w3_robot__m__2__wh__ws */
    REAL(0.0008026894586894596),     /* r3_w3_w1_robot__m__2__wh__ws */
    REAL(2.7350427350427397e-07),    /* r3_w3_w2_robot__m__2__wh__ws */
    REAL(0.006017094017094017),      /* r3_w4_robot__m__2__wh__ws */
    REAL(2.051282051282053e-06),     /* r3_w4_w1_robot__m__2__wh__ws */
    REAL(2.6086482779396166e-06),    /* r3_w5_robot__m__2__me__we */
    REAL(1.0434593111758465e-06),    /* r3_w6_robot__m__2__me__we */
    REAL(3.557247651735843e-10),     /* r3_w6_w1_robot__m__2__me__we */
    REAL(5.217296555879233e-07),     /* r3_w7_robot__m__2__me__we */
    REAL(1.4608430356461866e-06),    /* r3_w7_w1_robot__m__2__me__we */
    REAL(6.260755867055079e-05),     /* r3_w7_robot__m__2__wh__ws */
    REAL(4.17383724470339e-05),      /* r3_w7_w1_robot__m__2__wh__ws */
    REAL(0.0016695348978813548),     /* r3_w7_robot__Fx__2 */
    REAL(0.00031303779335275394),    /* r3_w8_robot__m__2__wh__ws */
    REAL(2.0869186223516933e-07),    /* r3_w9_robot__m__2__me__we */
    -REAL(5.844083592115093e-07),    /* r3_w9_w1_robot__m__2__me__we */
    REAL(1.992058684972074e-10),     /* r3_w9_w2_robot__m__2__me__we */
    REAL(2.5043023468220318e-05),    /* r3_w9_robot__m__2__wh__ws */
    -REAL(1.670388637317773e-05),    /* r3_w9_w1_robot__m__2__wh__ws */
    REAL(5.691596242777355e-09),     /* r3_w9_w2_robot__m__2__wh__ws */
    REAL(0.000667813959152542),      /* r3_w9_robot__Fx__2 */
    REAL(2.2766384971109398e-07),    /* r3_w9_w1_robot__Fx__2 */
    REAL(0.00012521511734110157),    /* r3_w10_robot__m__2__wh__ws */
    REAL(4.2686971820830126e-08),    /* r3_w10_w1_robot__m__2__wh__ws */
    REAL(0.0002400000000000002),     /* r4_w1_w1_robot__m__2__wh__ws */
    {562u, 562u, 562u, 562u, 346u},  /* samples until each is valid */
    562u                             /* the longest of these */
};

/* robot.m[1].el.L*robot.m[1].me.Je*w^2/robot.m[1].el.k; ...;
 * robot.m[1].el.L*robot.m[1].wh.fs*w/(robot.m[1].ge.N*robot.m[1].el.k) */
static void bound_compute_product_5_to_product_14(khepera_plausible_threshold_coefficients *c,
        const khepera_plausible_parameters *p, real w, real fe_times_Re_over_k, real *product_5_out,
        real *product_6_out, real *product_7_out, real *product_11_out, real *product_12_out,
        real *product_13_out, real *product_14_out)
{
    /* khepera.bg:17: robot.m[1].el.L*robot.m[1].me.Je*w^2/robot.m[1].el.k */
    const real product_5 = p->robot__m__1__el__L * p->robot__m__1__me__Je * w * w
            / p->robot__m__1__el__k;

    /* Js[1]*robot.m[1].el.L*w^2/(robot.m[1].ge.N*robot.m[1].el.k) */
    const real product_6 = p->Js__1 * p->robot__m__1__el__L * w * w / p->robot__m__1__ge__N
            / p->robot__m__1__el__k;

    /* R[1]*robot.m[1].el.L*w/(robot.m[1].ge.N*robot.m[1].el.k) */
    const real product_7 = p->R__1 * p->robot__m__1__el__L * w / p->robot__m__1__ge__N
            / p->robot__m__1__el__k;

    /* fe[1]*robot.m[1].el.L*w/robot.m[1].el.k */
    const real product_11 = p->fe__1 * p->robot__m__1__el__L * w / p->robot__m__1__el__k;

    /* Js[1]*robot.m[1].el.Re*w/(robot.m[1].ge.N*robot.m[1].el.k) */
    const real product_12 = p->Js__1 * p->robot__m__1__el__Re * w / p->robot__m__1__ge__N
            / p->robot__m__1__el__k;

    /* robot.m[1].el.Re*robot.m[1].me.Je*w/robot.m[1].el.k */
    const real product_13 = p->robot__m__1__el__Re * p->robot__m__1__me__Je * w
            / p->robot__m__1__el__k;

    /* robot.m[1].el.L*robot.m[1].wh.fs*w/(robot.m[1].ge.N*robot.m[1].el.k) */
    const real product_14 = p->robot__m__1__el__L * p->robot__m__1__wh__fs * w
            / p->robot__m__1__ge__N / p->robot__m__1__el__k;

    /* r1_w1: factor of robot.m[1].me.we */
    c->r1_w1_robot__m__1__me__we = fe_times_Re_over_k / REAL(10.0);

    /* r1_w1: factor of robot.m[1].me.we' */
    c->r1_w1_w1_robot__m__1__me__we = product_11 / REAL(10.0);

    *product_5_out = product_5;
    *product_6_out = product_6;
    *product_7_out = product_7;
    *product_11_out = product_11;
    *product_12_out = product_12;
    *product_13_out = product_13;
    *product_14_out = product_14;
}

/* r1_w2: coefficients */
static void bound_compute_r1_w2(khepera_plausible_threshold_coefficients *c,
        real fe_times_Re_over_k, real product, real product_2, real product_12, real product_13)
{
    /* khepera.bg:17: r1_w2: factor of robot.Fx[1] */
    c->r1_w2_robot__Fx__1 = product_2 / REAL(20.0);

    /* r1_w2: factor of robot.m[1].wh.ws */
    c->r1_w2_robot__m__1__wh__ws = product / REAL(20.0);

    /* r1_w2: factor of robot.m[1].wh.ws' */
    c->r1_w2_w1_robot__m__1__wh__ws = product_12 / REAL(20.0);

    /* r1_w2: factor of robot.m[1].me.we */
    c->r1_w2_robot__m__1__me__we = fe_times_Re_over_k / REAL(20.0);

    /* r1_w2: factor of robot.m[1].me.we' */
    c->r1_w2_w1_robot__m__1__me__we = product_13 / REAL(20.0);
}

/* r1_w3: coefficients */
static void bound_compute_r1_w3(khepera_plausible_threshold_coefficients *c,
        const khepera_plausible_parameters *p, real w, real product, real product_2, real product_5,
        real product_6, real product_7)
{
    /* khepera.bg:17: r1_w3: factor of robot.m[1].me.we */
    c->r1_w3_robot__m__1__me__we = p->robot__m__1__el__k
            * (p->fe__1 * p->robot__m__1__el__Re / p->robot__m__1__el__k / p->robot__m__1__el__k
            - REAL(1.0)) / REAL(50.0);

    /* r1_w3: factor of robot.m[1].me.we' */
    c->r1_w3_w1_robot__m__1__me__we = p->robot__m__1__el__k * w
            * (p->robot__m__1__el__Re * p->robot__m__1__me__Je / p->robot__m__1__el__k
                / p->robot__m__1__el__k
            + p->fe__1 * p->robot__m__1__el__L / p->robot__m__1__el__k / p->robot__m__1__el__k)
            / REAL(50.0);

    /* r1_w3: factor of robot.m[1].me.we'' */
    c->r1_w3_w2_robot__m__1__me__we = product_5 / REAL(50.0);

    /* r1_w3: factor of robot.Fx[1] */
    c->r1_w3_robot__Fx__1 = product_2 / REAL(50.0);

    /* r1_w3: factor of robot.Fx[1]' */
    c->r1_w3_w1_robot__Fx__1 = product_7 / REAL(50.0);

    /* r1_w3: factor of robot.m[1].wh.ws */
    c->r1_w3_robot__m__1__wh__ws = product / REAL(50.0);

    /* r1_w3: factor of robot.m[1].wh.ws' */
    c->r1_w3_w1_robot__m__1__wh__ws = p->robot__m__1__el__k * w
            * (p->Js__1 * p->robot__m__1__el__Re / p->robot__m__1__ge__N / p->robot__m__1__el__k
                / p->robot__m__1__el__k
            + p->robot__m__1__el__L * p->robot__m__1__wh__fs / p->robot__m__1__ge__N
                / p->robot__m__1__el__k / p->robot__m__1__el__k)
            / REAL(50.0);

    /* r1_w3: factor of robot.m[1].wh.ws'' */
    c->r1_w3_w2_robot__m__1__wh__ws = product_6 / REAL(50.0);
}

/* r1_w7: coefficients */
static void bound_compute_r1_w7(khepera_plausible_threshold_coefficients *c,
        real fe_times_Re_over_k, real product, real product_2, real product_12, real product_13)
{
    /* khepera.bg:17: r1_w7: factor of robot.m[1].me.we */
    c->r1_w7_robot__m__1__me__we = REAL(37.0) * fe_times_Re_over_k / REAL(35560.0);

    /* r1_w7: factor of robot.m[1].me.we' */
    c->r1_w7_w1_robot__m__1__me__we = REAL(37.0) * product_13 / REAL(35560.0);

    /* r1_w7: factor of robot.m[1].wh.ws */
    c->r1_w7_robot__m__1__wh__ws = REAL(37.0) * product / REAL(35560.0);

    /* r1_w7: factor of robot.m[1].wh.ws' */
    c->r1_w7_w1_robot__m__1__wh__ws = REAL(37.0) * product_12 / REAL(35560.0);

    /* r1_w7: factor of robot.Fx[1] */
    c->r1_w7_robot__Fx__1 = REAL(37.0) * product_2 / REAL(35560.0);
}

/* r1_w9: coefficients */
static void bound_compute_r1_w9(khepera_plausible_threshold_coefficients *c,
        const khepera_plausible_parameters *p, real w, real fe_times_Re_over_k, real product,
        real product_2, real product_5, real product_6, real product_7)
{
    /* khepera.bg:17: r1_w9: factor of robot.m[1].me.we */
    c->r1_w9_robot__m__1__me__we = REAL(37.0) * fe_times_Re_over_k / REAL(88900.0);

    /* r1_w9: factor of robot.m[1].me.we' */
    c->r1_w9_w1_robot__m__1__me__we = REAL(37.0) * p->robot__m__1__el__k * p->robot__m__1__el__k * w
            * (-REAL(2.0) * p->fe__1 * p->robot__m__1__el__L / p->robot__m__1__el__k
                / p->robot__m__1__el__k / p->robot__m__1__el__k
            - REAL(2.0) * p->robot__m__1__el__Re * p->robot__m__1__me__Je / p->robot__m__1__el__k
                / p->robot__m__1__el__k / p->robot__m__1__el__k)
            / REAL(177800.0);

    /* r1_w9: factor of robot.m[1].me.we'' */
    c->r1_w9_w2_robot__m__1__me__we = REAL(37.0) * product_5 / REAL(88900.0);

    /* r1_w9: factor of robot.m[1].wh.ws */
    c->r1_w9_robot__m__1__wh__ws = REAL(37.0) * product / REAL(88900.0);

    /* r1_w9: factor of robot.m[1].wh.ws' */
    c->r1_w9_w1_robot__m__1__wh__ws = REAL(37.0) * p->robot__m__1__el__k * p->robot__m__1__el__k * w
            * (-REAL(2.0) * p->robot__m__1__el__L * p->robot__m__1__wh__fs / p->robot__m__1__ge__N
                / p->robot__m__1__el__k / p->robot__m__1__el__k / p->robot__m__1__el__k
            - REAL(2.0) * p->Js__1 * p->robot__m__1__el__Re / p->robot__m__1__ge__N
                / p->robot__m__1__el__k / p->robot__m__1__el__k / p->robot__m__1__el__k)
            / REAL(177800.0);

    /* r1_w9: factor of robot.m[1].wh.ws'' */
    c->r1_w9_w2_robot__m__1__wh__ws = REAL(37.0) * product_6 / REAL(88900.0);

    /* r1_w9: factor of robot.Fx[1] */
    c->r1_w9_robot__Fx__1 = REAL(37.0) * product_2 / REAL(88900.0);

    /* r1_w9: factor of robot.Fx[1]' */
    c->r1_w9_w1_robot__Fx__1 = REAL(37.0) * product_7 / REAL(88900.0);
}

/* r1: coefficients */
static void bound_compute_r1(khepera_plausible_threshold_coefficients *c,
        const khepera_plausible_parameters *p, real w)
{
    /* khepera.bg:17: fe[1]*robot.m[1].el.Re/robot.m[1].el.k */
    const real fe_times_Re_over_k = p->fe__1 * p->robot__m__1__el__Re / p->robot__m__1__el__k;

    /* robot.m[1].el.Re*robot.m[1].wh.fs/(robot.m[1].ge.N*robot.m[1].el.k) */
    const real product = p->robot__m__1__el__Re * p->robot__m__1__wh__fs / p->robot__m__1__ge__N
            / p->robot__m__1__el__k;

    /* R[1]*robot.m[1].el.Re/(robot.m[1].ge.N*robot.m[1].el.k) */
    const real product_2 = p->R__1 * p->robot__m__1__el__Re / p->robot__m__1__ge__N
            / p->robot__m__1__el__k;

    real product_5;
    real product_6;
    real product_7;
    real product_11;
    real product_12;
    real product_13;
    real product_14;

    bound_compute_product_5_to_product_14(c, p, w, fe_times_Re_over_k, &product_5, &product_6,
            &product_7, &product_11, &product_12, &product_13, &product_14);
    bound_compute_r1_w2(c, fe_times_Re_over_k, product, product_2, product_12, product_13);
    bound_compute_r1_w3(c, p, w, product, product_2, product_5, product_6, product_7);

    /* khepera.bg:17: r1_w4: factor of robot.m[1].wh.ws */
    c->r1_w4_robot__m__1__wh__ws = product / REAL(10.0);

    /* r1_w4: factor of robot.m[1].wh.ws' */
    c->r1_w4_w1_robot__m__1__wh__ws = product_14 / REAL(10.0);

    /* r1_w5: factor of robot.m[1].me.we */
    c->r1_w5_robot__m__1__me__we = REAL(37.0) * fe_times_Re_over_k / REAL(7112.0);

    /* r1_w6: factor of robot.m[1].me.we */
    c->r1_w6_robot__m__1__me__we = REAL(37.0) * fe_times_Re_over_k / REAL(17780.0);

    /* r1_w6: factor of robot.m[1].me.we' */
    c->r1_w6_w1_robot__m__1__me__we = REAL(37.0) * product_11 / REAL(17780.0);

    bound_compute_r1_w7(c, fe_times_Re_over_k, product, product_2, product_12, product_13);

    /* khepera.bg:17: r1_w8: factor of robot.m[1].wh.ws */
    c->r1_w8_robot__m__1__wh__ws = REAL(37.0) * product / REAL(7112.0);

    bound_compute_r1_w9(c, p, w, fe_times_Re_over_k, product, product_2, product_5, product_6,
            product_7);

    /* khepera.bg:17: r1_w10: factor of robot.m[1].wh.ws */
    c->r1_w10_robot__m__1__wh__ws = REAL(37.0) * product / REAL(17780.0);

    /* r1_w10: factor of robot.m[1].wh.ws' */
    c->r1_w10_w1_robot__m__1__wh__ws = REAL(37.0) * product_14 / REAL(17780.0);
}

/* filter: coefficients */
static void bound_compute_filter(khepera_plausible_threshold_coefficients *c, real pole, real turn)
{
    /* turn^2 */
    const real turn_2 = turn * turn;

    /* filter: 1 * (w*sample_time)^2/12 */
    c->bend1 = turn_2 / REAL(12.0);

    /* filter: what is left of a memory a sample later */
    c->a = pole;

    /* filter: weight of a sample, new and a sample later */
    c->b = REAL(0.5) * (REAL(1.0) - pole);

    /* filter: 2 * (w*sample_time)^2/12 */
    c->bend2 = turn_2 / REAL(6.0);
}

/* robot.m[2].el.L*robot.m[2].me.Je*w^2/robot.m[2].el.k; ...;
 * robot.m[2].el.L*robot.m[2].wh.fs*w/(robot.m[2].ge.N*robot.m[2].el.k) */
static void bound_compute_product_8_to_product_18(khepera_plausible_threshold_coefficients *c,
        const khepera_plausible_parameters *p, real w, real fe_times_Re_over_k_2,
        real *product_8_out, real *product_9_out, real *product_10_out, real *product_15_out,
        real *product_16_out, real *product_17_out, real *product_18_out)
{
    /* khepera.bg:17: robot.m[2].el.L*robot.m[2].me.Je*w^2/robot.m[2].el.k */
    const real product_8 = p->robot__m__2__el__L * p->robot__m__2__me__Je * w * w
            / p->robot__m__2__el__k;

    /* Js[2]*robot.m[2].el.L*w^2/(robot.m[2].ge.N*robot.m[2].el.k) */
    const real product_9 = p->Js__2 * p->robot__m__2__el__L * w * w / p->robot__m__2__ge__N
            / p->robot__m__2__el__k;

    /* R[2]*robot.m[2].el.L*w/(robot.m[2].ge.N*robot.m[2].el.k) */
    const real product_10 = p->R__2 * p->robot__m__2__el__L * w / p->robot__m__2__ge__N
            / p->robot__m__2__el__k;

    /* fe[2]*robot.m[2].el.L*w/robot.m[2].el.k */
    const real product_15 = p->fe__2 * p->robot__m__2__el__L * w / p->robot__m__2__el__k;

    /* Js[2]*robot.m[2].el.Re*w/(robot.m[2].ge.N*robot.m[2].el.k) */
    const real product_16 = p->Js__2 * p->robot__m__2__el__Re * w / p->robot__m__2__ge__N
            / p->robot__m__2__el__k;

    /* robot.m[2].el.Re*robot.m[2].me.Je*w/robot.m[2].el.k */
    const real product_17 = p->robot__m__2__el__Re * p->robot__m__2__me__Je * w
            / p->robot__m__2__el__k;

    /* robot.m[2].el.L*robot.m[2].wh.fs*w/(robot.m[2].ge.N*robot.m[2].el.k) */
    const real product_18 = p->robot__m__2__el__L * p->robot__m__2__wh__fs * w
            / p->robot__m__2__ge__N / p->robot__m__2__el__k;

    /* r3_w1: factor of robot.m[2].me.we */
    c->r3_w1_robot__m__2__me__we = fe_times_Re_over_k_2 / REAL(10.0);

    /* r3_w1: factor of robot.m[2].me.we' */
    c->r3_w1_w1_robot__m__2__me__we = product_15 / REAL(10.0);

    *product_8_out = product_8;
    *product_9_out = product_9;
    *product_10_out = product_10;
    *product_15_out = product_15;
    *product_16_out = product_16;
    *product_17_out = product_17;
    *product_18_out = product_18;
}

/* r3_w2: coefficients */
static void bound_compute_r3_w2(khepera_plausible_threshold_coefficients *c,
        real fe_times_Re_over_k_2, real product_3, real product_4, real product_16, real product_17)
{
    /* khepera.bg:17: r3_w2: factor of robot.Fx[2] */
    c->r3_w2_robot__Fx__2 = product_4 / REAL(20.0);

    /* r3_w2: factor of robot.m[2].wh.ws */
    c->r3_w2_robot__m__2__wh__ws = product_3 / REAL(20.0);

    /* r3_w2: factor of robot.m[2].wh.ws' */
    c->r3_w2_w1_robot__m__2__wh__ws = product_16 / REAL(20.0);

    /* r3_w2: factor of robot.m[2].me.we */
    c->r3_w2_robot__m__2__me__we = fe_times_Re_over_k_2 / REAL(20.0);

    /* r3_w2: factor of robot.m[2].me.we' */
    c->r3_w2_w1_robot__m__2__me__we = product_17 / REAL(20.0);
}

/* r3_w3: coefficients */
static void bound_compute_r3_w3(khepera_plausible_threshold_coefficients *c,
        const khepera_plausible_parameters *p, real w, real product_3, real product_4,
        real product_8, real product_9, real product_10)
{
    /* khepera.bg:17: r3_w3: factor of robot.m[2].me.we */
    c->r3_w3_robot__m__2__me__we = p->robot__m__2__el__k
            * (p->fe__2 * p->robot__m__2__el__Re / p->robot__m__2__el__k / p->robot__m__2__el__k
            - REAL(1.0)) / REAL(50.0);

    /* r3_w3: factor of robot.m[2].me.we' */
    c->r3_w3_w1_robot__m__2__me__we = p->robot__m__2__el__k * w
            * (p->robot__m__2__el__Re * p->robot__m__2__me__Je / p->robot__m__2__el__k
                / p->robot__m__2__el__k
            + p->fe__2 * p->robot__m__2__el__L / p->robot__m__2__el__k / p->robot__m__2__el__k)
            / REAL(50.0);

    /* r3_w3: factor of robot.m[2].me.we'' */
    c->r3_w3_w2_robot__m__2__me__we = product_8 / REAL(50.0);

    /* r3_w3: factor of robot.Fx[2] */
    c->r3_w3_robot__Fx__2 = product_4 / REAL(50.0);

    /* r3_w3: factor of robot.Fx[2]' */
    c->r3_w3_w1_robot__Fx__2 = product_10 / REAL(50.0);

    /* r3_w3: factor of robot.m[2].wh.ws */
    c->r3_w3_robot__m__2__wh__ws = product_3 / REAL(50.0);

    /* r3_w3: factor of robot.m[2].wh.ws' */
    c->r3_w3_w1_robot__m__2__wh__ws = p->robot__m__2__el__k * w
            * (p->Js__2 * p->robot__m__2__el__Re / p->robot__m__2__ge__N / p->robot__m__2__el__k
                / p->robot__m__2__el__k
            + p->robot__m__2__el__L * p->robot__m__2__wh__fs / p->robot__m__2__ge__N
                / p->robot__m__2__el__k / p->robot__m__2__el__k)
            / REAL(50.0);

    /* r3_w3: factor of robot.m[2].wh.ws'' */
    c->r3_w3_w2_robot__m__2__wh__ws = product_9 / REAL(50.0);
}

/* r3_w7: coefficients */
static void bound_compute_r3_w7(khepera_plausible_threshold_coefficients *c,
        real fe_times_Re_over_k_2, real product_3, real product_4, real product_16, real product_17)
{
    /* khepera.bg:17: r3_w7: factor of robot.m[2].me.we */
    c->r3_w7_robot__m__2__me__we = REAL(37.0) * fe_times_Re_over_k_2 / REAL(35560.0);

    /* r3_w7: factor of robot.m[2].me.we' */
    c->r3_w7_w1_robot__m__2__me__we = REAL(37.0) * product_17 / REAL(35560.0);

    /* r3_w7: factor of robot.m[2].wh.ws */
    c->r3_w7_robot__m__2__wh__ws = REAL(37.0) * product_3 / REAL(35560.0);

    /* r3_w7: factor of robot.m[2].wh.ws' */
    c->r3_w7_w1_robot__m__2__wh__ws = REAL(37.0) * product_16 / REAL(35560.0);

    /* r3_w7: factor of robot.Fx[2] */
    c->r3_w7_robot__Fx__2 = REAL(37.0) * product_4 / REAL(35560.0);
}

/* r3_w9: coefficients */
static void bound_compute_r3_w9(khepera_plausible_threshold_coefficients *c,
        const khepera_plausible_parameters *p, real w, real fe_times_Re_over_k_2, real product_3,
        real product_4, real product_8, real product_9, real product_10)
{
    /* khepera.bg:17: r3_w9: factor of robot.m[2].me.we */
    c->r3_w9_robot__m__2__me__we = REAL(37.0) * fe_times_Re_over_k_2 / REAL(88900.0);

    /* r3_w9: factor of robot.m[2].me.we' */
    c->r3_w9_w1_robot__m__2__me__we = REAL(37.0) * p->robot__m__2__el__k * p->robot__m__2__el__k * w
            * (-REAL(2.0) * p->fe__2 * p->robot__m__2__el__L / p->robot__m__2__el__k
                / p->robot__m__2__el__k / p->robot__m__2__el__k
            - REAL(2.0) * p->robot__m__2__el__Re * p->robot__m__2__me__Je / p->robot__m__2__el__k
                / p->robot__m__2__el__k / p->robot__m__2__el__k)
            / REAL(177800.0);

    /* r3_w9: factor of robot.m[2].me.we'' */
    c->r3_w9_w2_robot__m__2__me__we = REAL(37.0) * product_8 / REAL(88900.0);

    /* r3_w9: factor of robot.m[2].wh.ws */
    c->r3_w9_robot__m__2__wh__ws = REAL(37.0) * product_3 / REAL(88900.0);

    /* r3_w9: factor of robot.m[2].wh.ws' */
    c->r3_w9_w1_robot__m__2__wh__ws = REAL(37.0) * p->robot__m__2__el__k * p->robot__m__2__el__k * w
            * (-REAL(2.0) * p->robot__m__2__el__L * p->robot__m__2__wh__fs / p->robot__m__2__ge__N
                / p->robot__m__2__el__k / p->robot__m__2__el__k / p->robot__m__2__el__k
            - REAL(2.0) * p->Js__2 * p->robot__m__2__el__Re / p->robot__m__2__ge__N
                / p->robot__m__2__el__k / p->robot__m__2__el__k / p->robot__m__2__el__k)
            / REAL(177800.0);

    /* r3_w9: factor of robot.m[2].wh.ws'' */
    c->r3_w9_w2_robot__m__2__wh__ws = REAL(37.0) * product_9 / REAL(88900.0);

    /* r3_w9: factor of robot.Fx[2] */
    c->r3_w9_robot__Fx__2 = REAL(37.0) * product_4 / REAL(88900.0);

    /* r3_w9: factor of robot.Fx[2]' */
    c->r3_w9_w1_robot__Fx__2 = REAL(37.0) * product_10 / REAL(88900.0);
}

/* r3: coefficients */
static void bound_compute_r3(khepera_plausible_threshold_coefficients *c,
        const khepera_plausible_parameters *p, real w)
{
    /* khepera.bg:17: fe[2]*robot.m[2].el.Re/robot.m[2].el.k */
    const real fe_times_Re_over_k_2 = p->fe__2 * p->robot__m__2__el__Re / p->robot__m__2__el__k;

    /* robot.m[2].el.Re*robot.m[2].wh.fs/(robot.m[2].ge.N*robot.m[2].el.k) */
    const real product_3 = p->robot__m__2__el__Re * p->robot__m__2__wh__fs / p->robot__m__2__ge__N
            / p->robot__m__2__el__k;

    /* R[2]*robot.m[2].el.Re/(robot.m[2].ge.N*robot.m[2].el.k) */
    const real product_4 = p->R__2 * p->robot__m__2__el__Re / p->robot__m__2__ge__N
            / p->robot__m__2__el__k;

    real product_8;
    real product_9;
    real product_10;
    real product_15;
    real product_16;
    real product_17;
    real product_18;

    bound_compute_product_8_to_product_18(c, p, w, fe_times_Re_over_k_2, &product_8, &product_9,
            &product_10, &product_15, &product_16, &product_17, &product_18);
    bound_compute_r3_w2(c, fe_times_Re_over_k_2, product_3, product_4, product_16, product_17);
    bound_compute_r3_w3(c, p, w, product_3, product_4, product_8, product_9, product_10);

    /* khepera.bg:17: r3_w4: factor of robot.m[2].wh.ws */
    c->r3_w4_robot__m__2__wh__ws = product_3 / REAL(10.0);

    /* r3_w4: factor of robot.m[2].wh.ws' */
    c->r3_w4_w1_robot__m__2__wh__ws = product_18 / REAL(10.0);

    /* r3_w5: factor of robot.m[2].me.we */
    c->r3_w5_robot__m__2__me__we = REAL(37.0) * fe_times_Re_over_k_2 / REAL(7112.0);

    /* r3_w6: factor of robot.m[2].me.we */
    c->r3_w6_robot__m__2__me__we = REAL(37.0) * fe_times_Re_over_k_2 / REAL(17780.0);

    /* r3_w6: factor of robot.m[2].me.we' */
    c->r3_w6_w1_robot__m__2__me__we = REAL(37.0) * product_15 / REAL(17780.0);

    bound_compute_r3_w7(c, fe_times_Re_over_k_2, product_3, product_4, product_16, product_17);

    /* khepera.bg:17: r3_w8: factor of robot.m[2].wh.ws */
    c->r3_w8_robot__m__2__wh__ws = REAL(37.0) * product_3 / REAL(7112.0);

    bound_compute_r3_w9(c, p, w, fe_times_Re_over_k_2, product_3, product_4, product_8, product_9,
            product_10);

    /* khepera.bg:17: r3_w10: factor of robot.m[2].wh.ws */
    c->r3_w10_robot__m__2__wh__ws = REAL(37.0) * product_3 / REAL(17780.0);

    /* r3_w10: factor of robot.m[2].wh.ws' */
    c->r3_w10_w1_robot__m__2__wh__ws = REAL(37.0) * product_18 / REAL(17780.0);
}

/* The coefficients, from the parameters. */
static void bound_compute_coefficients(khepera_plausible_threshold_coefficients *c,
        const khepera_plausible_parameters *p, real sample_time, real bandwidth)
{
    /* bandwidth*sample_time */
    const real x_ = bandwidth * sample_time;

    /* of a stage: what is left of its memory */
    const real pole = greatest(REAL(2.0) - x_, REAL(0.0)) / (x_ + REAL(2.0));

    /* w*sample_time, x or 2 */
    const real turn = REAL(2.0) * (REAL(1.0) - pole) / (pole + REAL(1.0));

    /* w of the filter 1/(1 + D/w) */
    const real w = turn / sample_time;

    bound_compute_r1(c, p, w);
    bound_compute_filter(c, pole, turn);

    /* khepera.bg:41: r2_w1: factor of robot.m[1].wh.ws' */
    c->r2_w1_w1_robot__m__1__wh__ws = p->robot__m__1__wh__fs * w / REAL(10.0)
            / p->robot__m__1__ge__N / p->robot__m__1__me__K;

    bound_compute_r3(c, p, w);

    /* khepera.bg:41: r4_w1: factor of robot.m[2].wh.ws' */
    c->r4_w1_w1_robot__m__2__wh__ws = p->robot__m__2__wh__fs * w / REAL(10.0)
            / p->robot__m__2__ge__N / p->robot__m__2__me__K;
}

static bool bound_coefficients_are_finite(const khepera_plausible_threshold_coefficients *c)
{
    return finite_number(c->r1_w1_robot__m__1__me__we + c->r1_w1_w1_robot__m__1__me__we + c->bend1
            + c->a + c->b + c->r1_w2_robot__Fx__1 + c->r1_w2_robot__m__1__wh__ws
            + c->r1_w2_w1_robot__m__1__wh__ws + c->r1_w2_robot__m__1__me__we
            + c->r1_w2_w1_robot__m__1__me__we + c->r1_w3_robot__m__1__me__we
            + c->r1_w3_w1_robot__m__1__me__we + c->r1_w3_w2_robot__m__1__me__we
            + c->r1_w3_robot__Fx__1 + c->r1_w3_w1_robot__Fx__1 + c->r1_w3_robot__m__1__wh__ws
            + c->r1_w3_w1_robot__m__1__wh__ws + c->r1_w3_w2_robot__m__1__wh__ws + c->bend2
            + c->r1_w4_robot__m__1__wh__ws + c->r1_w4_w1_robot__m__1__wh__ws
            + c->r1_w5_robot__m__1__me__we + c->r1_w6_robot__m__1__me__we
            + c->r1_w6_w1_robot__m__1__me__we + c->r1_w7_robot__m__1__me__we
            + c->r1_w7_w1_robot__m__1__me__we + c->r1_w7_robot__m__1__wh__ws
            + c->r1_w7_w1_robot__m__1__wh__ws + c->r1_w7_robot__Fx__1 + c->r1_w8_robot__m__1__wh__ws
            + c->r1_w9_robot__m__1__me__we + c->r1_w9_w1_robot__m__1__me__we
            + c->r1_w9_w2_robot__m__1__me__we + c->r1_w9_robot__m__1__wh__ws
            + c->r1_w9_w1_robot__m__1__wh__ws + c->r1_w9_w2_robot__m__1__wh__ws
            + c->r1_w9_robot__Fx__1 + c->r1_w9_w1_robot__Fx__1 + c->r1_w10_robot__m__1__wh__ws
            + c->r1_w10_w1_robot__m__1__wh__ws + c->r2_w1_w1_robot__m__1__wh__ws
            + c->r3_w1_robot__m__2__me__we + c->r3_w1_w1_robot__m__2__me__we + c->r3_w2_robot__Fx__2
            + c->r3_w2_robot__m__2__wh__ws + c->r3_w2_w1_robot__m__2__wh__ws
            + c->r3_w2_robot__m__2__me__we + c->r3_w2_w1_robot__m__2__me__we
            + c->r3_w3_robot__m__2__me__we + c->r3_w3_w1_robot__m__2__me__we
            + c->r3_w3_w2_robot__m__2__me__we + c->r3_w3_robot__Fx__2 + c->r3_w3_w1_robot__Fx__2
            + c->r3_w3_robot__m__2__wh__ws + c->r3_w3_w1_robot__m__2__wh__ws
            + c->r3_w3_w2_robot__m__2__wh__ws + c->r3_w4_robot__m__2__wh__ws
            + c->r3_w4_w1_robot__m__2__wh__ws + c->r3_w5_robot__m__2__me__we
            + c->r3_w6_robot__m__2__me__we + c->r3_w6_w1_robot__m__2__me__we
            + c->r3_w7_robot__m__2__me__we + c->r3_w7_w1_robot__m__2__me__we
            + c->r3_w7_robot__m__2__wh__ws + c->r3_w7_w1_robot__m__2__wh__ws + c->r3_w7_robot__Fx__2
            + c->r3_w8_robot__m__2__wh__ws + c->r3_w9_robot__m__2__me__we
            + c->r3_w9_w1_robot__m__2__me__we + c->r3_w9_w2_robot__m__2__me__we
            + c->r3_w9_robot__m__2__wh__ws + c->r3_w9_w1_robot__m__2__wh__ws
            + c->r3_w9_w2_robot__m__2__wh__ws + c->r3_w9_robot__Fx__2 + c->r3_w9_w1_robot__Fx__2
            + c->r3_w10_robot__m__2__wh__ws + c->r3_w10_w1_robot__m__2__wh__ws
            + c->r4_w1_w1_robot__m__2__wh__ws);
}

khepera_plausible_status khepera_plausible_threshold_configure(
    khepera_plausible_threshold_coefficients *coefficients,
    const khepera_plausible_parameters *parameters,
    khepera_plausible_real sample_time,
    khepera_plausible_real bandwidth)
{
    khepera_plausible_threshold_coefficients *c = coefficients;
    const khepera_plausible_status status = checked(parameters, sample_time, bandwidth);
    int k;

    for (k = 0; k < KHEPERA_PLAUSIBLE_RESIDUALS; ++k) {
        c->settle[k] = UINT32_MAX;
    }
    c->longest = UINT32_MAX;
    if (status != KHEPERA_PLAUSIBLE_OK) {
        return status;
    }
    bound_compute_coefficients(c, parameters, sample_time, bandwidth);
    if (!bound_coefficients_are_finite(c)) {
        return KHEPERA_PLAUSIBLE_BAD_COEFFICIENT;
    }
    c->settle[KHEPERA_PLAUSIBLE_R1] = samples(REAL(11.228872242412663), sample_time, bandwidth);
    c->settle[KHEPERA_PLAUSIBLE_R2] = samples(REAL(11.228872242412663), sample_time, bandwidth);
    c->settle[KHEPERA_PLAUSIBLE_R3] = samples(REAL(11.228872242412663), sample_time, bandwidth);
    c->settle[KHEPERA_PLAUSIBLE_R4] = samples(REAL(11.228872242412663), sample_time, bandwidth);
    c->settle[KHEPERA_PLAUSIBLE_R5] = samples(REAL(6.907755278982138), sample_time, bandwidth);
    c->longest = c->settle[KHEPERA_PLAUSIBLE_R1];
    return KHEPERA_PLAUSIBLE_OK;
}

/* what the tolerance of fe[1] can do */
static real bound_r1_w1(const khepera_plausible_threshold_coefficients *c,
        khepera_plausible_threshold_memory *x, const khepera_plausible_samples *s, real w1_a,
        real w1_b)
{
    /* r1_w1: terms of order 0 */
    const real w1_g0 = c->r1_w1_robot__m__1__me__we * s->robot__m__1__me__we;

    /* r1_w1: degree 1 */
    const real w1_d1 = c->r1_w1_w1_robot__m__1__me__we * s->robot__m__1__me__we;

    /* r1_w1: error of order 0 */
    const real w1_e0 = c->bend1 * w1_g0;

    /* r1_w1: the filter multiplied out */
    const real w1_p1_1 = -w1_d1 - w1_e0;

    /* r1_w1: stage 3 */
    const real w1_u3 = -w1_g0 - w1_p1_1;
    const real w1_y3 = x->r1_w1_s3 + w1_b * w1_u3;
    x->r1_w1_s3 = w1_a * w1_y3 + w1_b * w1_u3;

    /* r1_w1: stage 2 */
    const real w1_u2 = w1_y3 + w1_p1_1 - w1_e0;
    const real w1_y2 = x->r1_w1_s2 + w1_b * w1_u2;
    x->r1_w1_s2 = w1_a * w1_y2 + w1_b * w1_u2;

    /* r1_w1: stage 1 */
    const real w1_u1 = w1_y2 + w1_e0;
    const real w1_y1 = x->r1_w1_s1 + w1_b * w1_u1;
    x->r1_w1_s1 = w1_a * w1_y1 + w1_b * w1_u1;

    /* what the tolerance of fe[1] can do */
    const real w1 = w1_y1;

    return w1;
}

/* what the tolerance of robot.m[1].el.Re can do */
static real bound_r1_w2(const khepera_plausible_threshold_coefficients *c,
        khepera_plausible_threshold_memory *x, const khepera_plausible_samples *s, bool first,
        real w1_a, real w1_b)
{
    if (first) {
        /* nothing is remembered yet */
        x->r1_w2_s3 = REAL(0.0);
        x->r1_w2_s2 = REAL(0.0);
        x->r1_w2_s1 = REAL(0.0);
    }

    /* r1_w2: terms of order 0 */
    const real w2_g0 = c->r1_w2_robot__Fx__1 * s->robot__Fx__1
        + c->r1_w2_robot__m__1__wh__ws * s->robot__m__1__wh__ws
        + c->r1_w2_robot__m__1__me__we * s->robot__m__1__me__we;

    /* r1_w2: degree 1 */
    const real w2_d1 = c->r1_w2_w1_robot__m__1__wh__ws * s->robot__m__1__wh__ws
        + c->r1_w2_w1_robot__m__1__me__we * s->robot__m__1__me__we;

    /* r1_w2: error of order 0 */
    const real w2_e0 = c->bend1 * w2_g0;

    /* r1_w2: the filter multiplied out */
    const real w2_p1_1 = -w2_d1 - w2_e0;

    /* r1_w2: stage 3 */
    const real w2_u3 = -w2_g0 - w2_p1_1;
    const real w2_y3 = x->r1_w2_s3 + w1_b * w2_u3;
    x->r1_w2_s3 = w1_a * w2_y3 + w1_b * w2_u3;

    /* r1_w2: stage 2 */
    const real w2_u2 = w2_y3 + w2_p1_1 - w2_e0;
    const real w2_y2 = x->r1_w2_s2 + w1_b * w2_u2;
    x->r1_w2_s2 = w1_a * w2_y2 + w1_b * w2_u2;

    /* r1_w2: stage 1 */
    const real w2_u1 = w2_y2 + w2_e0;
    const real w2_y1 = x->r1_w2_s1 + w1_b * w2_u1;
    x->r1_w2_s1 = w1_a * w2_y1 + w1_b * w2_u1;

    /* what the tolerance of robot.m[1].el.Re can do */
    const real w2 = w2_y1;

    return w2;
}

/* what the tolerance of robot.m[1].el.k can do */
static real bound_r1_w3(const khepera_plausible_threshold_coefficients *c,
        khepera_plausible_threshold_memory *x, const khepera_plausible_samples *s, bool first,
        real w1_a, real w1_b)
{
    if (first) {
        /* nothing is remembered yet */
        x->r1_w3_s3 = REAL(0.0);
        x->r1_w3_s2 = REAL(0.0);
        x->r1_w3_s1 = REAL(0.0);
    }

    /* r1_w3: terms of order 0 */
    const real w3_g0 = c->r1_w3_robot__m__1__me__we * s->robot__m__1__me__we
        + c->r1_w3_robot__Fx__1 * s->robot__Fx__1
        + c->r1_w3_robot__m__1__wh__ws * s->robot__m__1__wh__ws;

    /* r1_w3: terms of order 1 */
    const real w3_g1 = c->r1_w3_w1_robot__m__1__me__we * s->robot__m__1__me__we
        + c->r1_w3_w1_robot__Fx__1 * s->robot__Fx__1
        + c->r1_w3_w1_robot__m__1__wh__ws * s->robot__m__1__wh__ws;

    /* r1_w3: error of order 0 */
    const real w3_e0 = c->bend2 * w3_g0;

    /* r1_w3: degree 2 */
    const real w3_d2 = c->r1_w3_w2_robot__m__1__me__we * s->robot__m__1__me__we
        + c->r1_w3_w2_robot__m__1__wh__ws * s->robot__m__1__wh__ws - w3_e0;

    /* r1_w3: error of order 1 */
    const real w3_e1 = c->bend1 * w3_g1;

    /* r1_w3: the filter multiplied out */
    const real w3_p2_1 = w3_d2 + w3_e1;
    const real w3_p1_1 = w3_p2_1 + w3_e1;
    const real w3_p1_2 = w3_g1 - w3_p2_1;

    /* r1_w3: stage 3 */
    const real w3_u3 = w3_g0 - w3_p1_2;
    const real w3_y3 = x->r1_w3_s3 + w1_b * w3_u3;
    x->r1_w3_s3 = w1_a * w3_y3 + w1_b * w3_u3;

    /* r1_w3: stage 2 */
    const real w3_u2 = w3_y3 + w3_p1_2 - w3_p1_1;
    const real w3_y2 = x->r1_w3_s2 + w1_b * w3_u2;
    x->r1_w3_s2 = w1_a * w3_y2 + w1_b * w3_u2;

    /* r1_w3: stage 1 */
    const real w3_u1 = w3_y2 + w3_p1_1 + w3_e1;
    const real w3_y1 = x->r1_w3_s1 + w1_b * w3_u1;
    x->r1_w3_s1 = w1_a * w3_y1 + w1_b * w3_u1;

    /* what the tolerance of robot.m[1].el.k can do */
    const real w3 = w3_y1 - w3_e1;

    return w3;
}

/* what the tolerance of robot.m[1].wh.fs can do */
static real bound_r1_w4(const khepera_plausible_threshold_coefficients *c,
        khepera_plausible_threshold_memory *x, const khepera_plausible_samples *s, bool first,
        real w1_a, real w1_b)
{
    if (first) {
        /* nothing is remembered yet */
        x->r1_w4_s3 = REAL(0.0);
        x->r1_w4_s2 = REAL(0.0);
        x->r1_w4_s1 = REAL(0.0);
    }

    /* r1_w4: terms of order 0 */
    const real w4_g0 = c->r1_w4_robot__m__1__wh__ws * s->robot__m__1__wh__ws;

    /* r1_w4: degree 1 */
    const real w4_d1 = c->r1_w4_w1_robot__m__1__wh__ws * s->robot__m__1__wh__ws;

    /* r1_w4: error of order 0 */
    const real w4_e0 = c->bend1 * w4_g0;

    /* r1_w4: the filter multiplied out */
    const real w4_p1_1 = -w4_d1 - w4_e0;

    /* r1_w4: stage 3 */
    const real w4_u3 = -w4_g0 - w4_p1_1;
    const real w4_y3 = x->r1_w4_s3 + w1_b * w4_u3;
    x->r1_w4_s3 = w1_a * w4_y3 + w1_b * w4_u3;

    /* r1_w4: stage 2 */
    const real w4_u2 = w4_y3 + w4_p1_1 - w4_e0;
    const real w4_y2 = x->r1_w4_s2 + w1_b * w4_u2;
    x->r1_w4_s2 = w1_a * w4_y2 + w1_b * w4_u2;

    /* r1_w4: stage 1 */
    const real w4_u1 = w4_y2 + w4_e0;
    const real w4_y1 = x->r1_w4_s1 + w1_b * w4_u1;
    x->r1_w4_s1 = w1_a * w4_y1 + w1_b * w4_u1;

    /* what the tolerance of robot.m[1].wh.fs can do */
    const real w4 = w4_y1;

    return w4;
}

/* what the tolerances of fe[1] and robot.m[1].el.Re can do together */
static real bound_r1_w5(const khepera_plausible_threshold_coefficients *c,
        khepera_plausible_threshold_memory *x, const khepera_plausible_samples *s, bool first,
        real w1_a, real w1_b)
{
    if (first) {
        /* nothing is remembered yet */
        x->r1_w5_s3 = REAL(0.0);
        x->r1_w5_s2 = REAL(0.0);
        x->r1_w5_s1 = REAL(0.0);
    }

    /* r1_w5: stage 3 */
    const real w5_u3 = -c->r1_w5_robot__m__1__me__we * s->robot__m__1__me__we;
    const real w5_y3 = x->r1_w5_s3 + w1_b * w5_u3;
    x->r1_w5_s3 = w1_a * w5_y3 + w1_b * w5_u3;

    /* r1_w5: stage 2 */
    const real w5_u2 = w5_y3;
    const real w5_y2 = x->r1_w5_s2 + w1_b * w5_u2;
    x->r1_w5_s2 = w1_a * w5_y2 + w1_b * w5_u2;

    /* r1_w5: stage 1 */
    const real w5_u1 = w5_y2;
    const real w5_y1 = x->r1_w5_s1 + w1_b * w5_u1;
    x->r1_w5_s1 = w1_a * w5_y1 + w1_b * w5_u1;

    /* what the tolerances of fe[1] and robot.m[1].el.Re can do together */
    const real w5 = w5_y1;

    return w5;
}

/* what the tolerances of fe[1] and robot.m[1].el.k can do together */
static real bound_r1_w6(const khepera_plausible_threshold_coefficients *c,
        khepera_plausible_threshold_memory *x, const khepera_plausible_samples *s, bool first,
        real w1_a, real w1_b)
{
    if (first) {
        /* nothing is remembered yet */
        x->r1_w6_s3 = REAL(0.0);
        x->r1_w6_s2 = REAL(0.0);
        x->r1_w6_s1 = REAL(0.0);
    }

    /* r1_w6: terms of order 0 */
    const real w6_g0 = c->r1_w6_robot__m__1__me__we * s->robot__m__1__me__we;

    /* r1_w6: degree 1 */
    const real w6_d1 = c->r1_w6_w1_robot__m__1__me__we * s->robot__m__1__me__we;

    /* r1_w6: error of order 0 */
    const real w6_e0 = c->bend1 * w6_g0;

    /* r1_w6: the filter multiplied out */
    const real w6_p1_1 = w6_d1 + w6_e0;

    /* r1_w6: stage 3 */
    const real w6_u3 = w6_g0 - w6_p1_1;
    const real w6_y3 = x->r1_w6_s3 + w1_b * w6_u3;
    x->r1_w6_s3 = w1_a * w6_y3 + w1_b * w6_u3;

    /* r1_w6: stage 2 */
    const real w6_u2 = w6_y3 + w6_p1_1 + w6_e0;
    const real w6_y2 = x->r1_w6_s2 + w1_b * w6_u2;
    x->r1_w6_s2 = w1_a * w6_y2 + w1_b * w6_u2;

    /* r1_w6: stage 1 */
    const real w6_u1 = w6_y2 - w6_e0;
    const real w6_y1 = x->r1_w6_s1 + w1_b * w6_u1;
    x->r1_w6_s1 = w1_a * w6_y1 + w1_b * w6_u1;

    /* what the tolerances of fe[1] and robot.m[1].el.k can do together */
    const real w6 = w6_y1;

    return w6;
}

/* what the tolerances of robot.m[1].el.Re and robot.m[1].el.k can do together */
static real bound_r1_w7(const khepera_plausible_threshold_coefficients *c,
        khepera_plausible_threshold_memory *x, const khepera_plausible_samples *s, bool first,
        real w1_a, real w1_b)
{
    if (first) {
        /* nothing is remembered yet */
        x->r1_w7_s3 = REAL(0.0);
        x->r1_w7_s2 = REAL(0.0);
        x->r1_w7_s1 = REAL(0.0);
    }

    /* r1_w7: terms of order 0 */
    const real w7_g0 = c->r1_w7_robot__m__1__me__we * s->robot__m__1__me__we
        + c->r1_w7_robot__m__1__wh__ws * s->robot__m__1__wh__ws
        + c->r1_w7_robot__Fx__1 * s->robot__Fx__1;

    /* r1_w7: degree 1 */
    const real w7_d1 = c->r1_w7_w1_robot__m__1__me__we * s->robot__m__1__me__we
        + c->r1_w7_w1_robot__m__1__wh__ws * s->robot__m__1__wh__ws;

    /* r1_w7: error of order 0 */
    const real w7_e0 = c->bend1 * w7_g0;

    /* r1_w7: the filter multiplied out */
    const real w7_p1_1 = w7_d1 + w7_e0;

    /* r1_w7: stage 3 */
    const real w7_u3 = w7_g0 - w7_p1_1;
    const real w7_y3 = x->r1_w7_s3 + w1_b * w7_u3;
    x->r1_w7_s3 = w1_a * w7_y3 + w1_b * w7_u3;

    /* r1_w7: stage 2 */
    const real w7_u2 = w7_y3 + w7_p1_1 + w7_e0;
    const real w7_y2 = x->r1_w7_s2 + w1_b * w7_u2;
    x->r1_w7_s2 = w1_a * w7_y2 + w1_b * w7_u2;

    /* r1_w7: stage 1 */
    const real w7_u1 = w7_y2 - w7_e0;
    const real w7_y1 = x->r1_w7_s1 + w1_b * w7_u1;
    x->r1_w7_s1 = w1_a * w7_y1 + w1_b * w7_u1;

    /* what the tolerances of robot.m[1].el.Re and robot.m[1].el.k can do together */
    const real w7 = w7_y1;

    return w7;
}

/* what the tolerances of robot.m[1].el.Re and robot.m[1].wh.fs can do together */
static real bound_r1_w8(const khepera_plausible_threshold_coefficients *c,
        khepera_plausible_threshold_memory *x, const khepera_plausible_samples *s, bool first,
        real w1_a, real w1_b)
{
    if (first) {
        /* nothing is remembered yet */
        x->r1_w8_s3 = REAL(0.0);
        x->r1_w8_s2 = REAL(0.0);
        x->r1_w8_s1 = REAL(0.0);
    }

    /* r1_w8: stage 3 */
    const real w8_u3 = -c->r1_w8_robot__m__1__wh__ws * s->robot__m__1__wh__ws;
    const real w8_y3 = x->r1_w8_s3 + w1_b * w8_u3;
    x->r1_w8_s3 = w1_a * w8_y3 + w1_b * w8_u3;

    /* r1_w8: stage 2 */
    const real w8_u2 = w8_y3;
    const real w8_y2 = x->r1_w8_s2 + w1_b * w8_u2;
    x->r1_w8_s2 = w1_a * w8_y2 + w1_b * w8_u2;

    /* r1_w8: stage 1 */
    const real w8_u1 = w8_y2;
    const real w8_y1 = x->r1_w8_s1 + w1_b * w8_u1;
    x->r1_w8_s1 = w1_a * w8_y1 + w1_b * w8_u1;

    /* what the tolerances of robot.m[1].el.Re and robot.m[1].wh.fs can do together */
    const real w8 = w8_y1;

    return w8;
}

/* second order of what the tolerance of robot.m[1].el.k can do */
static real bound_r1_w9(const khepera_plausible_threshold_coefficients *c,
        khepera_plausible_threshold_memory *x, const khepera_plausible_samples *s, bool first,
        real w1_a, real w1_b)
{
    if (first) {
        /* nothing is remembered yet */
        x->r1_w9_s3 = REAL(0.0);
        x->r1_w9_s2 = REAL(0.0);
        x->r1_w9_s1 = REAL(0.0);
    }

    /* r1_w9: terms of order 0 */
    const real w9_g0 = c->r1_w9_robot__m__1__me__we * s->robot__m__1__me__we
        + c->r1_w9_robot__m__1__wh__ws * s->robot__m__1__wh__ws
        + c->r1_w9_robot__Fx__1 * s->robot__Fx__1;

    /* r1_w9: terms of order 1 */
    const real w9_g1 = c->r1_w9_w1_robot__m__1__me__we * s->robot__m__1__me__we
        + c->r1_w9_w1_robot__m__1__wh__ws * s->robot__m__1__wh__ws
        - c->r1_w9_w1_robot__Fx__1 * s->robot__Fx__1;

    /* r1_w9: error of order 0 */
    const real w9_e0 = c->bend2 * w9_g0;

    /* r1_w9: degree 2 */
    const real w9_d2 = w9_e0 - c->r1_w9_w2_robot__m__1__me__we * s->robot__m__1__me__we
        - c->r1_w9_w2_robot__m__1__wh__ws * s->robot__m__1__wh__ws;

    /* r1_w9: error of order 1 */
    const real w9_e1 = c->bend1 * w9_g1;

    /* r1_w9: the filter multiplied out */
    const real w9_p2_1 = w9_d2 + w9_e1;
    const real w9_p1_1 = w9_p2_1 + w9_e1;
    const real w9_p1_2 = w9_g1 - w9_p2_1;

    /* r1_w9: stage 3 */
    const real w9_u3 = -w9_g0 - w9_p1_2;
    const real w9_y3 = x->r1_w9_s3 + w1_b * w9_u3;
    x->r1_w9_s3 = w1_a * w9_y3 + w1_b * w9_u3;

    /* r1_w9: stage 2 */
    const real w9_u2 = w9_y3 + w9_p1_2 - w9_p1_1;
    const real w9_y2 = x->r1_w9_s2 + w1_b * w9_u2;
    x->r1_w9_s2 = w1_a * w9_y2 + w1_b * w9_u2;

    /* r1_w9: stage 1 */
    const real w9_u1 = w9_y2 + w9_p1_1 + w9_e1;
    const real w9_y1 = x->r1_w9_s1 + w1_b * w9_u1;
    x->r1_w9_s1 = w1_a * w9_y1 + w1_b * w9_u1;

    /* second order of what the tolerance of robot.m[1].el.k can do */
    const real w9 = w9_y1 - w9_e1;

    return w9;
}

/* what the tolerances of robot.m[1].el.k and robot.m[1].wh.fs can do together */
static real bound_r1_w10(const khepera_plausible_threshold_coefficients *c,
        khepera_plausible_threshold_memory *x, const khepera_plausible_samples *s, bool first,
        real w1_a, real w1_b)
{
    if (first) {
        /* nothing is remembered yet */
        x->r1_w10_s3 = REAL(0.0);
        x->r1_w10_s2 = REAL(0.0);
        x->r1_w10_s1 = REAL(0.0);
    }

    /* r1_w10: terms of order 0 */
    const real w10_g0 = c->r1_w10_robot__m__1__wh__ws * s->robot__m__1__wh__ws;

    /* r1_w10: degree 1 */
    const real w10_d1 = c->r1_w10_w1_robot__m__1__wh__ws * s->robot__m__1__wh__ws;

    /* r1_w10: error of order 0 */
    const real w10_e0 = c->bend1 * w10_g0;

    /* r1_w10: the filter multiplied out */
    const real w10_p1_1 = w10_d1 + w10_e0;

    /* r1_w10: stage 3 */
    const real w10_u3 = w10_g0 - w10_p1_1;
    const real w10_y3 = x->r1_w10_s3 + w1_b * w10_u3;
    x->r1_w10_s3 = w1_a * w10_y3 + w1_b * w10_u3;

    /* r1_w10: stage 2 */
    const real w10_u2 = w10_y3 + w10_p1_1 + w10_e0;
    const real w10_y2 = x->r1_w10_s2 + w1_b * w10_u2;
    x->r1_w10_s2 = w1_a * w10_y2 + w1_b * w10_u2;

    /* r1_w10: stage 1 */
    const real w10_u1 = w10_y2 - w10_e0;
    const real w10_y1 = x->r1_w10_s1 + w1_b * w10_u1;
    x->r1_w10_s1 = w1_a * w10_y1 + w1_b * w10_u1;

    /* what the tolerances of robot.m[1].el.k and robot.m[1].wh.fs can do together */
    const real w10 = w10_y1;

    return w10;
}

/* r1 on one sample.
 * khepera.bg:17: r1: how far r1 can be from zero if no parameter is out of tolerance */
static void bound_r1(
    const khepera_plausible_threshold_coefficients *c, khepera_plausible_threshold_memory *x, const khepera_plausible_samples *s, real *r)
{
    const bool first = x->youngest == 0u && x->age[0] == 0u;

    if (first) {
        /* nothing is remembered yet */
        x->r1_w1_s3 = REAL(0.0);
        x->r1_w1_s2 = REAL(0.0);
        x->r1_w1_s1 = REAL(0.0);
    }

    /* r1_w1: a stage of the filter; on the first sample it is at rest */
    const real w1_a = first ? -c->b : c->a;
    const real w1_b = first ? REAL(1.0) : c->b;

    const real w1 = bound_r1_w1(c, x, s, w1_a, w1_b);
    const real w2 = bound_r1_w2(c, x, s, first, w1_a, w1_b);
    const real w3 = bound_r1_w3(c, x, s, first, w1_a, w1_b);
    const real w4 = bound_r1_w4(c, x, s, first, w1_a, w1_b);
    const real w5 = bound_r1_w5(c, x, s, first, w1_a, w1_b);
    const real w6 = bound_r1_w6(c, x, s, first, w1_a, w1_b);
    const real w7 = bound_r1_w7(c, x, s, first, w1_a, w1_b);
    const real w8 = bound_r1_w8(c, x, s, first, w1_a, w1_b);
    const real w9 = bound_r1_w9(c, x, s, first, w1_a, w1_b);
    const real w10 = bound_r1_w10(c, x, s, first, w1_a, w1_b);

    r[KHEPERA_PLAUSIBLE_R1] = MATH(fabs)(w1) + MATH(fabs)(w2) + MATH(fabs)(w3) + MATH(fabs)(w4)
        + MATH(fabs)(w5) + MATH(fabs)(w6) + MATH(fabs)(w7) + MATH(fabs)(w8) + MATH(fabs)(w9)
        + MATH(fabs)(w10);
}

/* r2 on one sample.
 * khepera.bg:41: r2: how far r2 can be from zero if no parameter is out of tolerance */
static void bound_r2(
    const khepera_plausible_threshold_coefficients *c, khepera_plausible_threshold_memory *x, const khepera_plausible_samples *s, real *r)
{
    const bool first = x->youngest == 0u && x->age[1] == 0u;

    if (first) {
        /* nothing is remembered yet */
        x->r2_w1_s3 = REAL(0.0);
        x->r2_w1_s2 = REAL(0.0);
        x->r2_w1_s1 = REAL(0.0);
    }

    /* r2_w1: a stage of the filter; on the first sample it is at rest */
    const real w1_a = first ? -c->b : c->a;
    const real w1_b = first ? REAL(1.0) : c->b;

    /* r2_w1: degree 1 */
    const real w1_d1 = c->r2_w1_w1_robot__m__1__wh__ws * s->robot__m__1__wh__ws;

    /* r2_w1: stage 3 */
    const real w1_u3 = w1_d1;
    const real w1_y3 = x->r2_w1_s3 + w1_b * w1_u3;
    x->r2_w1_s3 = w1_a * w1_y3 + w1_b * w1_u3;

    /* r2_w1: stage 2 */
    const real w1_u2 = w1_y3 - w1_d1;
    const real w1_y2 = x->r2_w1_s2 + w1_b * w1_u2;
    x->r2_w1_s2 = w1_a * w1_y2 + w1_b * w1_u2;

    /* r2_w1: stage 1 */
    const real w1_u1 = w1_y2;
    const real w1_y1 = x->r2_w1_s1 + w1_b * w1_u1;
    x->r2_w1_s1 = w1_a * w1_y1 + w1_b * w1_u1;

    /* what the tolerance of robot.m[1].wh.fs can do */
    const real w1 = w1_y1;

    r[KHEPERA_PLAUSIBLE_R2] = MATH(fabs)(w1);
}

/* what the tolerance of fe[2] can do */
static real bound_r3_w1(const khepera_plausible_threshold_coefficients *c,
        khepera_plausible_threshold_memory *x, const khepera_plausible_samples *s, real w1_a,
        real w1_b)
{
    /* r3_w1: terms of order 0 */
    const real w1_g0 = c->r3_w1_robot__m__2__me__we * s->robot__m__2__me__we;

    /* r3_w1: degree 1 */
    const real w1_d1 = c->r3_w1_w1_robot__m__2__me__we * s->robot__m__2__me__we;

    /* r3_w1: error of order 0 */
    const real w1_e0 = c->bend1 * w1_g0;

    /* r3_w1: the filter multiplied out */
    const real w1_p1_1 = -w1_d1 - w1_e0;

    /* r3_w1: stage 3 */
    const real w1_u3 = -w1_g0 - w1_p1_1;
    const real w1_y3 = x->r3_w1_s3 + w1_b * w1_u3;
    x->r3_w1_s3 = w1_a * w1_y3 + w1_b * w1_u3;

    /* r3_w1: stage 2 */
    const real w1_u2 = w1_y3 + w1_p1_1 - w1_e0;
    const real w1_y2 = x->r3_w1_s2 + w1_b * w1_u2;
    x->r3_w1_s2 = w1_a * w1_y2 + w1_b * w1_u2;

    /* r3_w1: stage 1 */
    const real w1_u1 = w1_y2 + w1_e0;
    const real w1_y1 = x->r3_w1_s1 + w1_b * w1_u1;
    x->r3_w1_s1 = w1_a * w1_y1 + w1_b * w1_u1;

    /* what the tolerance of fe[2] can do */
    const real w1 = w1_y1;

    return w1;
}

/* what the tolerance of robot.m[2].el.Re can do */
static real bound_r3_w2(const khepera_plausible_threshold_coefficients *c,
        khepera_plausible_threshold_memory *x, const khepera_plausible_samples *s, bool first,
        real w1_a, real w1_b)
{
    if (first) {
        /* nothing is remembered yet */
        x->r3_w2_s3 = REAL(0.0);
        x->r3_w2_s2 = REAL(0.0);
        x->r3_w2_s1 = REAL(0.0);
    }

    /* r3_w2: terms of order 0 */
    const real w2_g0 = c->r3_w2_robot__Fx__2 * s->robot__Fx__2
        + c->r3_w2_robot__m__2__wh__ws * s->robot__m__2__wh__ws
        + c->r3_w2_robot__m__2__me__we * s->robot__m__2__me__we;

    /* r3_w2: degree 1 */
    const real w2_d1 = c->r3_w2_w1_robot__m__2__wh__ws * s->robot__m__2__wh__ws
        + c->r3_w2_w1_robot__m__2__me__we * s->robot__m__2__me__we;

    /* r3_w2: error of order 0 */
    const real w2_e0 = c->bend1 * w2_g0;

    /* r3_w2: the filter multiplied out */
    const real w2_p1_1 = -w2_d1 - w2_e0;

    /* r3_w2: stage 3 */
    const real w2_u3 = -w2_g0 - w2_p1_1;
    const real w2_y3 = x->r3_w2_s3 + w1_b * w2_u3;
    x->r3_w2_s3 = w1_a * w2_y3 + w1_b * w2_u3;

    /* r3_w2: stage 2 */
    const real w2_u2 = w2_y3 + w2_p1_1 - w2_e0;
    const real w2_y2 = x->r3_w2_s2 + w1_b * w2_u2;
    x->r3_w2_s2 = w1_a * w2_y2 + w1_b * w2_u2;

    /* r3_w2: stage 1 */
    const real w2_u1 = w2_y2 + w2_e0;
    const real w2_y1 = x->r3_w2_s1 + w1_b * w2_u1;
    x->r3_w2_s1 = w1_a * w2_y1 + w1_b * w2_u1;

    /* what the tolerance of robot.m[2].el.Re can do */
    const real w2 = w2_y1;

    return w2;
}

/* what the tolerance of robot.m[2].el.k can do */
static real bound_r3_w3(const khepera_plausible_threshold_coefficients *c,
        khepera_plausible_threshold_memory *x, const khepera_plausible_samples *s, bool first,
        real w1_a, real w1_b)
{
    if (first) {
        /* nothing is remembered yet */
        x->r3_w3_s3 = REAL(0.0);
        x->r3_w3_s2 = REAL(0.0);
        x->r3_w3_s1 = REAL(0.0);
    }

    /* r3_w3: terms of order 0 */
    const real w3_g0 = c->r3_w3_robot__m__2__me__we * s->robot__m__2__me__we
        + c->r3_w3_robot__Fx__2 * s->robot__Fx__2
        + c->r3_w3_robot__m__2__wh__ws * s->robot__m__2__wh__ws;

    /* r3_w3: terms of order 1 */
    const real w3_g1 = c->r3_w3_w1_robot__m__2__me__we * s->robot__m__2__me__we
        + c->r3_w3_w1_robot__Fx__2 * s->robot__Fx__2
        + c->r3_w3_w1_robot__m__2__wh__ws * s->robot__m__2__wh__ws;

    /* r3_w3: error of order 0 */
    const real w3_e0 = c->bend2 * w3_g0;

    /* r3_w3: degree 2 */
    const real w3_d2 = c->r3_w3_w2_robot__m__2__me__we * s->robot__m__2__me__we
        + c->r3_w3_w2_robot__m__2__wh__ws * s->robot__m__2__wh__ws - w3_e0;

    /* r3_w3: error of order 1 */
    const real w3_e1 = c->bend1 * w3_g1;

    /* r3_w3: the filter multiplied out */
    const real w3_p2_1 = w3_d2 + w3_e1;
    const real w3_p1_1 = w3_p2_1 + w3_e1;
    const real w3_p1_2 = w3_g1 - w3_p2_1;

    /* r3_w3: stage 3 */
    const real w3_u3 = w3_g0 - w3_p1_2;
    const real w3_y3 = x->r3_w3_s3 + w1_b * w3_u3;
    x->r3_w3_s3 = w1_a * w3_y3 + w1_b * w3_u3;

    /* r3_w3: stage 2 */
    const real w3_u2 = w3_y3 + w3_p1_2 - w3_p1_1;
    const real w3_y2 = x->r3_w3_s2 + w1_b * w3_u2;
    x->r3_w3_s2 = w1_a * w3_y2 + w1_b * w3_u2;

    /* r3_w3: stage 1 */
    const real w3_u1 = w3_y2 + w3_p1_1 + w3_e1;
    const real w3_y1 = x->r3_w3_s1 + w1_b * w3_u1;
    x->r3_w3_s1 = w1_a * w3_y1 + w1_b * w3_u1;

    /* what the tolerance of robot.m[2].el.k can do */
    const real w3 = w3_y1 - w3_e1;

    return w3;
}

/* what the tolerance of robot.m[2].wh.fs can do */
static real bound_r3_w4(const khepera_plausible_threshold_coefficients *c,
        khepera_plausible_threshold_memory *x, const khepera_plausible_samples *s, bool first,
        real w1_a, real w1_b)
{
    if (first) {
        /* nothing is remembered yet */
        x->r3_w4_s3 = REAL(0.0);
        x->r3_w4_s2 = REAL(0.0);
        x->r3_w4_s1 = REAL(0.0);
    }

    /* r3_w4: terms of order 0 */
    const real w4_g0 = c->r3_w4_robot__m__2__wh__ws * s->robot__m__2__wh__ws;

    /* r3_w4: degree 1 */
    const real w4_d1 = c->r3_w4_w1_robot__m__2__wh__ws * s->robot__m__2__wh__ws;

    /* r3_w4: error of order 0 */
    const real w4_e0 = c->bend1 * w4_g0;

    /* r3_w4: the filter multiplied out */
    const real w4_p1_1 = -w4_d1 - w4_e0;

    /* r3_w4: stage 3 */
    const real w4_u3 = -w4_g0 - w4_p1_1;
    const real w4_y3 = x->r3_w4_s3 + w1_b * w4_u3;
    x->r3_w4_s3 = w1_a * w4_y3 + w1_b * w4_u3;

    /* r3_w4: stage 2 */
    const real w4_u2 = w4_y3 + w4_p1_1 - w4_e0;
    const real w4_y2 = x->r3_w4_s2 + w1_b * w4_u2;
    x->r3_w4_s2 = w1_a * w4_y2 + w1_b * w4_u2;

    /* r3_w4: stage 1 */
    const real w4_u1 = w4_y2 + w4_e0;
    const real w4_y1 = x->r3_w4_s1 + w1_b * w4_u1;
    x->r3_w4_s1 = w1_a * w4_y1 + w1_b * w4_u1;

    /* what the tolerance of robot.m[2].wh.fs can do */
    const real w4 = w4_y1;

    return w4;
}

/* what the tolerances of fe[2] and robot.m[2].el.Re can do together */
static real bound_r3_w5(const khepera_plausible_threshold_coefficients *c,
        khepera_plausible_threshold_memory *x, const khepera_plausible_samples *s, bool first,
        real w1_a, real w1_b)
{
    if (first) {
        /* nothing is remembered yet */
        x->r3_w5_s3 = REAL(0.0);
        x->r3_w5_s2 = REAL(0.0);
        x->r3_w5_s1 = REAL(0.0);
    }

    /* r3_w5: stage 3 */
    const real w5_u3 = -c->r3_w5_robot__m__2__me__we * s->robot__m__2__me__we;
    const real w5_y3 = x->r3_w5_s3 + w1_b * w5_u3;
    x->r3_w5_s3 = w1_a * w5_y3 + w1_b * w5_u3;

    /* r3_w5: stage 2 */
    const real w5_u2 = w5_y3;
    const real w5_y2 = x->r3_w5_s2 + w1_b * w5_u2;
    x->r3_w5_s2 = w1_a * w5_y2 + w1_b * w5_u2;

    /* r3_w5: stage 1 */
    const real w5_u1 = w5_y2;
    const real w5_y1 = x->r3_w5_s1 + w1_b * w5_u1;
    x->r3_w5_s1 = w1_a * w5_y1 + w1_b * w5_u1;

    /* what the tolerances of fe[2] and robot.m[2].el.Re can do together */
    const real w5 = w5_y1;

    return w5;
}

/* what the tolerances of fe[2] and robot.m[2].el.k can do together */
static real bound_r3_w6(const khepera_plausible_threshold_coefficients *c,
        khepera_plausible_threshold_memory *x, const khepera_plausible_samples *s, bool first,
        real w1_a, real w1_b)
{
    if (first) {
        /* nothing is remembered yet */
        x->r3_w6_s3 = REAL(0.0);
        x->r3_w6_s2 = REAL(0.0);
        x->r3_w6_s1 = REAL(0.0);
    }

    /* r3_w6: terms of order 0 */
    const real w6_g0 = c->r3_w6_robot__m__2__me__we * s->robot__m__2__me__we;

    /* r3_w6: degree 1 */
    const real w6_d1 = c->r3_w6_w1_robot__m__2__me__we * s->robot__m__2__me__we;

    /* r3_w6: error of order 0 */
    const real w6_e0 = c->bend1 * w6_g0;

    /* r3_w6: the filter multiplied out */
    const real w6_p1_1 = w6_d1 + w6_e0;

    /* r3_w6: stage 3 */
    const real w6_u3 = w6_g0 - w6_p1_1;
    const real w6_y3 = x->r3_w6_s3 + w1_b * w6_u3;
    x->r3_w6_s3 = w1_a * w6_y3 + w1_b * w6_u3;

    /* r3_w6: stage 2 */
    const real w6_u2 = w6_y3 + w6_p1_1 + w6_e0;
    const real w6_y2 = x->r3_w6_s2 + w1_b * w6_u2;
    x->r3_w6_s2 = w1_a * w6_y2 + w1_b * w6_u2;

    /* r3_w6: stage 1 */
    const real w6_u1 = w6_y2 - w6_e0;
    const real w6_y1 = x->r3_w6_s1 + w1_b * w6_u1;
    x->r3_w6_s1 = w1_a * w6_y1 + w1_b * w6_u1;

    /* what the tolerances of fe[2] and robot.m[2].el.k can do together */
    const real w6 = w6_y1;

    return w6;
}

/* what the tolerances of robot.m[2].el.Re and robot.m[2].el.k can do together */
static real bound_r3_w7(const khepera_plausible_threshold_coefficients *c,
        khepera_plausible_threshold_memory *x, const khepera_plausible_samples *s, bool first,
        real w1_a, real w1_b)
{
    if (first) {
        /* nothing is remembered yet */
        x->r3_w7_s3 = REAL(0.0);
        x->r3_w7_s2 = REAL(0.0);
        x->r3_w7_s1 = REAL(0.0);
    }

    /* r3_w7: terms of order 0 */
    const real w7_g0 = c->r3_w7_robot__m__2__me__we * s->robot__m__2__me__we
        + c->r3_w7_robot__m__2__wh__ws * s->robot__m__2__wh__ws
        + c->r3_w7_robot__Fx__2 * s->robot__Fx__2;

    /* r3_w7: degree 1 */
    const real w7_d1 = c->r3_w7_w1_robot__m__2__me__we * s->robot__m__2__me__we
        + c->r3_w7_w1_robot__m__2__wh__ws * s->robot__m__2__wh__ws;

    /* r3_w7: error of order 0 */
    const real w7_e0 = c->bend1 * w7_g0;

    /* r3_w7: the filter multiplied out */
    const real w7_p1_1 = w7_d1 + w7_e0;

    /* r3_w7: stage 3 */
    const real w7_u3 = w7_g0 - w7_p1_1;
    const real w7_y3 = x->r3_w7_s3 + w1_b * w7_u3;
    x->r3_w7_s3 = w1_a * w7_y3 + w1_b * w7_u3;

    /* r3_w7: stage 2 */
    const real w7_u2 = w7_y3 + w7_p1_1 + w7_e0;
    const real w7_y2 = x->r3_w7_s2 + w1_b * w7_u2;
    x->r3_w7_s2 = w1_a * w7_y2 + w1_b * w7_u2;

    /* r3_w7: stage 1 */
    const real w7_u1 = w7_y2 - w7_e0;
    const real w7_y1 = x->r3_w7_s1 + w1_b * w7_u1;
    x->r3_w7_s1 = w1_a * w7_y1 + w1_b * w7_u1;

    /* what the tolerances of robot.m[2].el.Re and robot.m[2].el.k can do together */
    const real w7 = w7_y1;

    return w7;
}

/* what the tolerances of robot.m[2].el.Re and robot.m[2].wh.fs can do together */
static real bound_r3_w8(const khepera_plausible_threshold_coefficients *c,
        khepera_plausible_threshold_memory *x, const khepera_plausible_samples *s, bool first,
        real w1_a, real w1_b)
{
    if (first) {
        /* nothing is remembered yet */
        x->r3_w8_s3 = REAL(0.0);
        x->r3_w8_s2 = REAL(0.0);
        x->r3_w8_s1 = REAL(0.0);
    }

    /* r3_w8: stage 3 */
    const real w8_u3 = -c->r3_w8_robot__m__2__wh__ws * s->robot__m__2__wh__ws;
    const real w8_y3 = x->r3_w8_s3 + w1_b * w8_u3;
    x->r3_w8_s3 = w1_a * w8_y3 + w1_b * w8_u3;

    /* r3_w8: stage 2 */
    const real w8_u2 = w8_y3;
    const real w8_y2 = x->r3_w8_s2 + w1_b * w8_u2;
    x->r3_w8_s2 = w1_a * w8_y2 + w1_b * w8_u2;

    /* r3_w8: stage 1 */
    const real w8_u1 = w8_y2;
    const real w8_y1 = x->r3_w8_s1 + w1_b * w8_u1;
    x->r3_w8_s1 = w1_a * w8_y1 + w1_b * w8_u1;

    /* what the tolerances of robot.m[2].el.Re and robot.m[2].wh.fs can do together */
    const real w8 = w8_y1;

    return w8;
}

/* second order of what the tolerance of robot.m[2].el.k can do */
static real bound_r3_w9(const khepera_plausible_threshold_coefficients *c,
        khepera_plausible_threshold_memory *x, const khepera_plausible_samples *s, bool first,
        real w1_a, real w1_b)
{
    if (first) {
        /* nothing is remembered yet */
        x->r3_w9_s3 = REAL(0.0);
        x->r3_w9_s2 = REAL(0.0);
        x->r3_w9_s1 = REAL(0.0);
    }

    /* r3_w9: terms of order 0 */
    const real w9_g0 = c->r3_w9_robot__m__2__me__we * s->robot__m__2__me__we
        + c->r3_w9_robot__m__2__wh__ws * s->robot__m__2__wh__ws
        + c->r3_w9_robot__Fx__2 * s->robot__Fx__2;

    /* r3_w9: terms of order 1 */
    const real w9_g1 = c->r3_w9_w1_robot__m__2__me__we * s->robot__m__2__me__we
        + c->r3_w9_w1_robot__m__2__wh__ws * s->robot__m__2__wh__ws
        - c->r3_w9_w1_robot__Fx__2 * s->robot__Fx__2;

    /* r3_w9: error of order 0 */
    const real w9_e0 = c->bend2 * w9_g0;

    /* r3_w9: degree 2 */
    const real w9_d2 = w9_e0 - c->r3_w9_w2_robot__m__2__me__we * s->robot__m__2__me__we
        - c->r3_w9_w2_robot__m__2__wh__ws * s->robot__m__2__wh__ws;

    /* r3_w9: error of order 1 */
    const real w9_e1 = c->bend1 * w9_g1;

    /* r3_w9: the filter multiplied out */
    const real w9_p2_1 = w9_d2 + w9_e1;
    const real w9_p1_1 = w9_p2_1 + w9_e1;
    const real w9_p1_2 = w9_g1 - w9_p2_1;

    /* r3_w9: stage 3 */
    const real w9_u3 = -w9_g0 - w9_p1_2;
    const real w9_y3 = x->r3_w9_s3 + w1_b * w9_u3;
    x->r3_w9_s3 = w1_a * w9_y3 + w1_b * w9_u3;

    /* r3_w9: stage 2 */
    const real w9_u2 = w9_y3 + w9_p1_2 - w9_p1_1;
    const real w9_y2 = x->r3_w9_s2 + w1_b * w9_u2;
    x->r3_w9_s2 = w1_a * w9_y2 + w1_b * w9_u2;

    /* r3_w9: stage 1 */
    const real w9_u1 = w9_y2 + w9_p1_1 + w9_e1;
    const real w9_y1 = x->r3_w9_s1 + w1_b * w9_u1;
    x->r3_w9_s1 = w1_a * w9_y1 + w1_b * w9_u1;

    /* second order of what the tolerance of robot.m[2].el.k can do */
    const real w9 = w9_y1 - w9_e1;

    return w9;
}

/* what the tolerances of robot.m[2].el.k and robot.m[2].wh.fs can do together */
static real bound_r3_w10(const khepera_plausible_threshold_coefficients *c,
        khepera_plausible_threshold_memory *x, const khepera_plausible_samples *s, bool first,
        real w1_a, real w1_b)
{
    if (first) {
        /* nothing is remembered yet */
        x->r3_w10_s3 = REAL(0.0);
        x->r3_w10_s2 = REAL(0.0);
        x->r3_w10_s1 = REAL(0.0);
    }

    /* r3_w10: terms of order 0 */
    const real w10_g0 = c->r3_w10_robot__m__2__wh__ws * s->robot__m__2__wh__ws;

    /* r3_w10: degree 1 */
    const real w10_d1 = c->r3_w10_w1_robot__m__2__wh__ws * s->robot__m__2__wh__ws;

    /* r3_w10: error of order 0 */
    const real w10_e0 = c->bend1 * w10_g0;

    /* r3_w10: the filter multiplied out */
    const real w10_p1_1 = w10_d1 + w10_e0;

    /* r3_w10: stage 3 */
    const real w10_u3 = w10_g0 - w10_p1_1;
    const real w10_y3 = x->r3_w10_s3 + w1_b * w10_u3;
    x->r3_w10_s3 = w1_a * w10_y3 + w1_b * w10_u3;

    /* r3_w10: stage 2 */
    const real w10_u2 = w10_y3 + w10_p1_1 + w10_e0;
    const real w10_y2 = x->r3_w10_s2 + w1_b * w10_u2;
    x->r3_w10_s2 = w1_a * w10_y2 + w1_b * w10_u2;

    /* r3_w10: stage 1 */
    const real w10_u1 = w10_y2 - w10_e0;
    const real w10_y1 = x->r3_w10_s1 + w1_b * w10_u1;
    x->r3_w10_s1 = w1_a * w10_y1 + w1_b * w10_u1;

    /* what the tolerances of robot.m[2].el.k and robot.m[2].wh.fs can do together */
    const real w10 = w10_y1;

    return w10;
}

/* r3 on one sample.
 * khepera.bg:17: r3: how far r3 can be from zero if no parameter is out of tolerance */
static void bound_r3(
    const khepera_plausible_threshold_coefficients *c, khepera_plausible_threshold_memory *x, const khepera_plausible_samples *s, real *r)
{
    const bool first = x->youngest == 0u && x->age[2] == 0u;

    if (first) {
        /* nothing is remembered yet */
        x->r3_w1_s3 = REAL(0.0);
        x->r3_w1_s2 = REAL(0.0);
        x->r3_w1_s1 = REAL(0.0);
    }

    /* r3_w1: a stage of the filter; on the first sample it is at rest */
    const real w1_a = first ? -c->b : c->a;
    const real w1_b = first ? REAL(1.0) : c->b;

    const real w1 = bound_r3_w1(c, x, s, w1_a, w1_b);
    const real w2 = bound_r3_w2(c, x, s, first, w1_a, w1_b);
    const real w3 = bound_r3_w3(c, x, s, first, w1_a, w1_b);
    const real w4 = bound_r3_w4(c, x, s, first, w1_a, w1_b);
    const real w5 = bound_r3_w5(c, x, s, first, w1_a, w1_b);
    const real w6 = bound_r3_w6(c, x, s, first, w1_a, w1_b);
    const real w7 = bound_r3_w7(c, x, s, first, w1_a, w1_b);
    const real w8 = bound_r3_w8(c, x, s, first, w1_a, w1_b);
    const real w9 = bound_r3_w9(c, x, s, first, w1_a, w1_b);
    const real w10 = bound_r3_w10(c, x, s, first, w1_a, w1_b);

    r[KHEPERA_PLAUSIBLE_R3] = MATH(fabs)(w1) + MATH(fabs)(w2) + MATH(fabs)(w3) + MATH(fabs)(w4)
        + MATH(fabs)(w5) + MATH(fabs)(w6) + MATH(fabs)(w7) + MATH(fabs)(w8) + MATH(fabs)(w9)
        + MATH(fabs)(w10);
}

/* r4 on one sample.
 * khepera.bg:41: r4: how far r4 can be from zero if no parameter is out of tolerance */
static void bound_r4(
    const khepera_plausible_threshold_coefficients *c, khepera_plausible_threshold_memory *x, const khepera_plausible_samples *s, real *r)
{
    const bool first = x->youngest == 0u && x->age[3] == 0u;

    if (first) {
        /* nothing is remembered yet */
        x->r4_w1_s3 = REAL(0.0);
        x->r4_w1_s2 = REAL(0.0);
        x->r4_w1_s1 = REAL(0.0);
    }

    /* r4_w1: a stage of the filter; on the first sample it is at rest */
    const real w1_a = first ? -c->b : c->a;
    const real w1_b = first ? REAL(1.0) : c->b;

    /* r4_w1: degree 1 */
    const real w1_d1 = c->r4_w1_w1_robot__m__2__wh__ws * s->robot__m__2__wh__ws;

    /* r4_w1: stage 3 */
    const real w1_u3 = w1_d1;
    const real w1_y3 = x->r4_w1_s3 + w1_b * w1_u3;
    x->r4_w1_s3 = w1_a * w1_y3 + w1_b * w1_u3;

    /* r4_w1: stage 2 */
    const real w1_u2 = w1_y3 - w1_d1;
    const real w1_y2 = x->r4_w1_s2 + w1_b * w1_u2;
    x->r4_w1_s2 = w1_a * w1_y2 + w1_b * w1_u2;

    /* r4_w1: stage 1 */
    const real w1_u1 = w1_y2;
    const real w1_y1 = x->r4_w1_s1 + w1_b * w1_u1;
    x->r4_w1_s1 = w1_a * w1_y1 + w1_b * w1_u1;

    /* what the tolerance of robot.m[2].wh.fs can do */
    const real w1 = w1_y1;

    r[KHEPERA_PLAUSIBLE_R4] = MATH(fabs)(w1);
}

/* r5 on one sample.
 * khepera.bg:114: r5: how far r5 can be from zero if no parameter is out of tolerance */
static void bound_r5(
    const khepera_plausible_threshold_coefficients *c, khepera_plausible_threshold_memory *x, const khepera_plausible_samples *s, real *r)
{
    (void)c;
    (void)x;
    (void)s;

    r[KHEPERA_PLAUSIBLE_R5] = REAL(0.0);
}

/* Ages and validity one by one: a number that is not finite makes the next sample the first. */
static void bound_count_samples(
    const khepera_plausible_threshold_coefficients *c,
    khepera_plausible_threshold_memory *x,
    khepera_plausible_residuals *out)
{
    /* the thresholds that are computed, and what each one goes with */
    static const uint8_t number[] = {
        0, 1, 2, 3, 4
    };
    static const uint8_t part[] = {
        0, 1, 2, 3, 4
    };
    bool finite[5];
    int k;

    finite[0] = true;
    finite[1] = true;
    finite[2] = true;
    finite[3] = true;
    finite[4] = true;
    for (k = 0; k < 5; ++k) {
        finite[part[k]] = finite[part[k]] && finite_number(out->value[number[k]]);
    }
    x->youngest = UINT32_MAX;
    for (k = 0; k < 5; ++k) {
        x->age[k] = finite[k] ? x->age[k] + (x->age[k] < UINT32_MAX ? 1u : 0u) : 0u;
        x->youngest = x->age[k] < x->youngest ? x->age[k] : x->youngest;
    }
    for (k = 0; k < 5; ++k) {
        out->value[number[k]] = finite[part[k]] ? out->value[number[k]] : REAL(0.0);
        out->valid[number[k]] = x->age[part[k]] > c->settle[number[k]];
    }
}

void khepera_plausible_threshold_reset(khepera_plausible_threshold_memory *memory)
{
    int k;

    for (k = 0; k < 5; ++k) {
        memory->age[k] = 0u;
    }
    memory->youngest = 0u;
}

void khepera_plausible_threshold_step(
    const khepera_plausible_threshold_coefficients *coefficients,
    khepera_plausible_threshold_memory *memory,
    const khepera_plausible_samples *samples,
    khepera_plausible_residuals *thresholds)
{
    const khepera_plausible_threshold_coefficients *c = coefficients;
    khepera_plausible_threshold_memory *x = memory;
    const khepera_plausible_samples *s = samples;
    real *r = thresholds->value;
    int k;

    bound_r1(c, x, s, r);
    bound_r2(c, x, s, r);
    bound_r3(c, x, s, r);
    bound_r4(c, x, s, r);
    bound_r5(c, x, s, r);
    /* a sum is finite only if all its terms are */
    if (x->youngest > c->longest
            && finite_number(r[KHEPERA_PLAUSIBLE_R1] + r[KHEPERA_PLAUSIBLE_R2]
                + r[KHEPERA_PLAUSIBLE_R3] + r[KHEPERA_PLAUSIBLE_R4] + r[KHEPERA_PLAUSIBLE_R5])) {
        for (k = 0; k < KHEPERA_PLAUSIBLE_RESIDUALS; ++k) {
            thresholds->valid[k] = true;
        }
    } else {
        bound_count_samples(c, x, thresholds);
    }
}

#endif

const char khepera_plausible_fault_name[KHEPERA_PLAUSIBLE_FAULTS][17] = {
    "Js[1]", "R[1]", "robot.m[1].ge.N", "robot.m[1].wh.fs", "robot.Fx[1]", "robot.m[1].me.we",
    "robot.m[1].wh.ws", "fe[1]", "robot.m[1].el.L", "robot.m[1].el.Re", "robot.m[1].el.k",
    "robot.m[1].me.Je", "robot.U0[1]", "robot.m[1].tau0", "robot.m[1].A", "robot.m[1].me.K",
    "Js[2]", "R[2]", "robot.m[2].ge.N", "robot.m[2].wh.fs", "robot.Fx[2]", "robot.m[2].me.we",
    "robot.m[2].wh.ws", "fe[2]", "robot.m[2].el.L", "robot.m[2].el.Re", "robot.m[2].el.k",
    "robot.m[2].me.Je", "robot.U0[2]", "robot.m[2].tau0", "robot.m[2].A", "robot.m[2].me.K", "RL",
    "LL", "CL", "robot.Uin", "robot.Us",
};

const uint16_t khepera_plausible_fault_class[KHEPERA_PLAUSIBLE_FAULTS] = {
    0u, 0u, 0u, 0u, 0u, 0u, 0u, 1u, 1u, 1u, 1u, 1u, 1u, 2u, 2u, 2u, 3u, 3u, 3u, 3u, 3u, 3u, 3u, 4u,
    4u, 4u, 4u, 4u, 4u, 5u, 5u, 5u, 6u, 6u, 6u, 7u, 7u,
};

const char khepera_plausible_residual_name[KHEPERA_PLAUSIBLE_RESIDUALS][3] = {
    "r1", "r2", "r3", "r4", "r5",
};

/*
 * Signatures: the faults of class c are seen by the residuals of entries first_entry[c] and up to
 * first_entry[c + 1].
 */
static const uint32_t first_entry[KHEPERA_PLAUSIBLE_CLASSES + 1] = {
    0u, 2u, 3u, 4u, 6u, 7u, 8u, 9u, 10u,
};

static const uint16_t seen_by[10] = {
    0u, 1u, 0u, 1u, 2u, 3u, 2u, 3u, 4u, 4u,
};

/*
 * Sizes of faults in eighths of an octave: a residual in alarm makes a fault so much larger than
 * what is least here as it is out.
 */
static const uint8_t least_size[10] = {
    1u, 1u, 1u, 1u, 1u, 1u, 1u, 1u, 1u, 1u,
};

/* A residual is sure to show a fault of this size; 255: of no size. */
static const uint8_t sure_size[10] = {
    0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 255u, 0u,
};

/* The peak of residual k since it went into alarm, beside what is sure to be one. */
static void remember_peak(
    khepera_plausible_diagnosis *d, const khepera_plausible_limit *limit, int k, real out, real bound)
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
static int size_of(const khepera_plausible_diagnosis *d, int c, int alarms)
{
    const uint32_t begin = first_entry[c];
    const uint32_t end = first_entry[c + 1];
    int size = 0;
    int seen = 0;
    uint32_t i;

    for (i = begin; i < end; ++i) {
        const int k = (int)seen_by[i];

        if (d->state[k] == KHEPERA_PLAUSIBLE_ALARM) {
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
static khepera_plausible_candidate left_of(const khepera_plausible_diagnosis *d, int c, int alarms)
{
    const uint32_t begin = first_entry[c];
    const uint32_t end = first_entry[c + 1];
    const int size = size_of(d, c, alarms);
    uint32_t i;

    if (size < 0) {
        return KHEPERA_PLAUSIBLE_RULED_OUT;
    }
    if (d->settled < d->window) {
        return KHEPERA_PLAUSIBLE_LIKELY; /* too soon for what is quiet to say anything */
    }
    for (i = begin; i < end; ++i) {
        const int k = (int)seen_by[i];
        const int sure = (int)sure_size[i];

        if (d->state[k] == KHEPERA_PLAUSIBLE_HEALTHY && sure != 255 && sure <= size) {
            return KHEPERA_PLAUSIBLE_SMALL;
        }
    }
    return KHEPERA_PLAUSIBLE_LIKELY;
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
    khepera_plausible_diagnosis *d, const khepera_plausible_limit *limit, int k, real off, real out, real bound)
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

static bool sums_are_zero(const khepera_plausible_diagnosis *d, int k)
{
    const real sum = d->above[k] + d->below[k] + d->louder[k];

    return !(sum > REAL(0.0));
}

static void forget_sums(khepera_plausible_diagnosis *d, int k)
{
    d->above[k] = REAL(0.0);
    d->below[k] = REAL(0.0);
    d->louder[k] = REAL(0.0);
    d->streak[k] = 0u;
}

/* How far a residual is beyond its bound; off: from its mean. */
static real excess(real off, real bound)
{
#if defined __GNUC__ && !defined KHEPERA_PLAUSIBLE_REAL
    return MATH(__builtin_fabs)(off) - bound; /* one instruction, no library */
#else
    return (off < REAL(0.0) ? -off : off) - bound;
#endif
}

static bool is_within(const khepera_plausible_limit *limit, real value, real bound)
{
    return excess(value - limit->mean, bound) <= limit->level;
}

/* Residual k in one sample; whether it goes into alarm. */
static bool watch(
    khepera_plausible_diagnosis *d, const khepera_plausible_limit *limit, int k, real value, real bound, bool row)
{
    const real off = value - limit->mean;
    const real out = excess(off, bound);
    bool high = false;

    if (row) {
        high = add_row(d, limit, k, off, out, bound);
    }
    if (d->state[k] == KHEPERA_PLAUSIBLE_ALARM) {
        d->since[k] += d->since[k] < UINT32_MAX ? 1u : 0u;
        remember_peak(d, limit, k, out, bound);
        if (!(out < RELEASE * limit->level) || !sums_are_zero(d, k)) {
            d->quiet = 0u;
        }
        return false;
    }
    d->state[k] = KHEPERA_PLAUSIBLE_HEALTHY;
    d->streak[k] = out > limit->level ? d->streak[k] + 1u : 0u;
    if (d->streak[k] < d->least && !high) {
        return false;
    }
    d->state[k] = KHEPERA_PLAUSIBLE_ALARM;
    d->since[k] = 0u;
    d->peak[k] = REAL(0.0);
    remember_peak(d, limit, k, out, bound);
    return true;
}

/* Which classes of faults the residuals leave, and the one if it is one. */
static void judge(khepera_plausible_diagnosis *d)
{
    int likely = 0;
    int alarms = 0;
    int c;
    int k;

    for (k = 0; k < KHEPERA_PLAUSIBLE_RESIDUALS; ++k) {
        alarms += d->state[k] == KHEPERA_PLAUSIBLE_ALARM ? 1 : 0;
    }
    d->fault_class = KHEPERA_PLAUSIBLE_UNKNOWN;
    for (c = 0; c < KHEPERA_PLAUSIBLE_CLASSES; ++c) {
        const khepera_plausible_candidate left = left_of(d, c, alarms);

        d->candidate[c] = (uint8_t)left;
        if (left == KHEPERA_PLAUSIBLE_LIKELY) {
            d->fault_class = (int16_t)c;
            ++likely;
        }
    }
    if (likely != 1 || d->settled < 2u * d->row) {
        d->fault_class = KHEPERA_PLAUSIBLE_UNKNOWN;
    }
}

khepera_plausible_limit khepera_plausible_limit_of(khepera_plausible_real level)
{
    khepera_plausible_limit limit;

    limit.mean = REAL(0.0);
    limit.level = level;
    limit.unit = REAL(0.0);
    limit.loud = REAL(0.0);
    limit.drift = REAL(0.5);
    limit.height = NEVER;
    limit.bound = REAL(0.0);
    return limit;
}

void khepera_plausible_clear(khepera_plausible_diagnosis *diagnosis)
{
    int k;

    for (k = 0; k < KHEPERA_PLAUSIBLE_RESIDUALS; ++k) {
        if (diagnosis->state[k] == KHEPERA_PLAUSIBLE_ALARM) {
            diagnosis->state[k] = KHEPERA_PLAUSIBLE_HEALTHY;
        }
        diagnosis->since[k] = 0u;
        diagnosis->peak[k] = REAL(0.0);
        forget_sums(diagnosis, k);
    }
    for (k = 0; k < KHEPERA_PLAUSIBLE_CLASSES; ++k) {
        diagnosis->candidate[k] = KHEPERA_PLAUSIBLE_RULED_OUT;
    }
    diagnosis->fault_class = KHEPERA_PLAUSIBLE_UNKNOWN;
    diagnosis->quiet = 0u;
    diagnosis->settled = 0u;
    diagnosis->calm = false;
}

void khepera_plausible_diagnosis_reset(khepera_plausible_diagnosis *diagnosis)
{
    int k;

    diagnosis->row = KHEPERA_PLAUSIBLE_ROW;
    diagnosis->least = 15u;
    diagnosis->hold = 10u * KHEPERA_PLAUSIBLE_ROW;
    diagnosis->window = 300u;
    diagnosis->latch = false;
    diagnosis->tick = 0u;
    for (k = 0; k < KHEPERA_PLAUSIBLE_RESIDUALS; ++k) {
        diagnosis->state[k] = KHEPERA_PLAUSIBLE_BLIND;
    }
    khepera_plausible_clear(diagnosis);
}

/* Whether each residual has a value within its level: nearly all samples are so. */
static bool all_within(
    const khepera_plausible_limit *limits, const real *bounds, const khepera_plausible_residuals *residuals)
{
    const real *value = residuals->value;
    int k;

    if (bounds != NULL) {
        for (k = 0; k < KHEPERA_PLAUSIBLE_RESIDUALS; ++k) {
            if (!residuals->valid[k] || !is_within(&limits[k], value[k], bounds[k])) {
                return false;
            }
        }
    } else {
        for (k = 0; k < KHEPERA_PLAUSIBLE_RESIDUALS; ++k) {
            if (!residuals->valid[k] || !is_within(&limits[k], value[k], limits[k].bound)) {
                return false;
            }
        }
    }
    return true;
}

/* Residual k without a value. */
static void blind(khepera_plausible_diagnosis *d, int k)
{
    forget_sums(d, k);
    if (d->state[k] == KHEPERA_PLAUSIBLE_ALARM) {
        d->quiet = 0u; /* nobody knows that it is over */
    } else {
        d->state[k] = KHEPERA_PLAUSIBLE_BLIND;
    }
}

bool khepera_plausible_diagnose(
    khepera_plausible_diagnosis *diagnosis,
    const khepera_plausible_limit *limits,
    const khepera_plausible_real *bounds,
    const khepera_plausible_residuals *residuals)
{
    khepera_plausible_diagnosis *d = diagnosis;
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
    for (k = 0; k < KHEPERA_PLAUSIBLE_RESIDUALS; ++k) {
        if (residuals->valid[k]) {
            const real bound = bounds ? bounds[k] : limits[k].bound;

            fresh = watch(d, &limits[k], k, residuals->value[k], bound, row) || fresh;
        } else {
            blind(d, k);
        }
        d->calm = d->calm && d->state[k] == KHEPERA_PLAUSIBLE_HEALTHY && d->streak[k] == 0u;
        alarm = alarm || d->state[k] == KHEPERA_PLAUSIBLE_ALARM;
    }
    if (fresh) {
        d->quiet = 0u;
        d->settled = 0u;
    }
    if (alarm && !d->latch && d->quiet >= d->hold) {
        khepera_plausible_clear(d);
        return false;
    }
    if (fresh || (alarm && row)) {
        judge(d);
    }
    return alarm;
}
