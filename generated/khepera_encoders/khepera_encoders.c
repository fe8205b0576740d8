/* khepera_encoders.c: the residuals of KheperaEncoders; generated, see the header. */
#include "khepera_encoders.h"

#ifndef KHEPERA_ENCODERS_NO_THRESHOLDS
#include <math.h>
#endif
#include <stddef.h>

#if defined __FINITE_MATH_ONLY__ && __FINITE_MATH_ONLY__
#error "this code tells numbers from NaN: compile it without -ffinite-math-only (-ffast-math)"
#endif

typedef khepera_encoders_real real;

#define REAL(x) KHEPERA_ENCODERS_CONSTANT(x)
#if defined KHEPERA_ENCODERS_FLOAT && !defined KHEPERA_ENCODERS_REAL
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

/* Takes a count; the difference to the one before is right also when the counter runs over. */
static void count_on(khepera_encoders_encoder *encoder, int32_t count, bool first)
{
    const uint32_t step = first ? 0u : (uint32_t)count - encoder->count;

    encoder->increment = step <= INT32_MAX ? (int32_t)step : -(int32_t)(UINT32_MAX - step) - 1;
    encoder->total = first ? 0 : encoder->total + encoder->increment;
    encoder->count = (uint32_t)count;
}

/* The least bandwidth * sample_time at which a filter still moves. */
#if defined KHEPERA_ENCODERS_FLOAT && !defined KHEPERA_ENCODERS_REAL
#define SLOWEST REAL(0.0001)
#else
#define SLOWEST REAL(1.0e-09)
#endif

uint32_t khepera_encoders_abi(void)
{
    return KHEPERA_ENCODERS_ABI;
}

const char *khepera_encoders_digest(void)
{
    return KHEPERA_ENCODERS_DIGEST;
}

void khepera_encoders_nominal(khepera_encoders_parameters *parameters)
{
    parameters->R_L = REAL(0.85);             /* Ohm */
    parameters->m__1__Je = REAL(1.4e-08);     /* kg.m^2 */
    parameters->m__1__fe = REAL(1.0e-07);     /* N.m.s/rad */
    parameters->m__1__K = REAL(0.1);          /* N.m/rad */
    parameters->m__1__tau0 = REAL(0.01);      /* rad */
    parameters->m__1__A = -REAL(4.0);         /* 1 */
    parameters->m__1__Js = REAL(1.0e-05);     /* kg.m^2 */
    parameters->m__1__fs = REAL(0.0003);      /* N.m.s/rad */
    parameters->m__1__R = REAL(0.008);        /* m */
    parameters->m__1__el__L = REAL(0.0003);   /* H */
    parameters->m__1__el__Re = REAL(17.6);    /* Ohm */
    parameters->m__1__el__k = REAL(0.00351);  /* N.m/A */
    parameters->m__1__ge__N = REAL(25.0);     /* 1 */
    parameters->m__2__Je = REAL(1.4e-08);     /* kg.m^2 */
    parameters->m__2__fe = REAL(1.0e-07);     /* N.m.s/rad */
    parameters->m__2__K = REAL(0.1);          /* N.m/rad */
    parameters->m__2__tau0 = REAL(0.01);      /* rad */
    parameters->m__2__A = -REAL(4.0);         /* 1 */
    parameters->m__2__Js = REAL(1.0e-05);     /* kg.m^2 */
    parameters->m__2__fs = REAL(0.0003);      /* N.m.s/rad */
    parameters->m__2__R = REAL(0.008);        /* m */
    parameters->m__2__el__L = REAL(0.0003);   /* H */
    parameters->m__2__el__Re = REAL(17.6);    /* Ohm */
    parameters->m__2__el__k = REAL(0.00351);  /* N.m/A */
    parameters->m__2__ge__N = REAL(25.0);     /* 1 */
}

/* Whether configure may go on with what it is given. */
static khepera_encoders_status checked(const khepera_encoders_parameters *p, real sample_time, real bandwidth)
{
    const bool finite = finite_number(p->R_L + p->m__1__Je + p->m__1__fe + p->m__1__K
            + p->m__1__tau0 + p->m__1__A + p->m__1__Js + p->m__1__fs + p->m__1__R + p->m__1__el__L
            + p->m__1__el__Re + p->m__1__el__k + p->m__1__ge__N + p->m__2__Je + p->m__2__fe
            + p->m__2__K + p->m__2__tau0 + p->m__2__A + p->m__2__Js + p->m__2__fs + p->m__2__R
            + p->m__2__el__L + p->m__2__el__Re + p->m__2__el__k + p->m__2__ge__N);

    if (!finite) {
        return KHEPERA_ENCODERS_BAD_PARAMETER;
    }
    if (!(sample_time >= REAL(0.000999999)) || !finite_number(sample_time)) {
        return KHEPERA_ENCODERS_BAD_SAMPLE_TIME;
    }
    if (!(bandwidth * sample_time >= SLOWEST && bandwidth * sample_time <= REAL(3.0))) {
        return KHEPERA_ENCODERS_BAD_BANDWIDTH;
    }
    return KHEPERA_ENCODERS_OK;
}

/* Samples until `constants` time constants of the filter are over. */
static uint32_t samples(real constants, real sample_time, real bandwidth)
{
    const real wait = constants / (bandwidth * sample_time);
    const uint32_t whole = wait < REAL(4.0e9) ? (uint32_t)wait : UINT32_MAX - 1u;

    return (real)whole < wait ? whole + 1u : whole;
}

const khepera_encoders_coefficients khepera_encoders_nominal_coefficients = {
    REAL(0.004011424501424501),      /* r1_m__1__motor_1 */
    REAL(1.6045584045584047),        /* r1_Fx__1 */
    REAL(0.06017094017094017),       /* r1_m__1__wheel_1 */
    REAL(0.030375857185854307),      /* m__1__motor_gain */
    REAL(0.9801980198019802),        /* a */
    REAL(0.00990099009900991),       /* b */
    -REAL(0.0014041595441595456),    /* r1_w2_m__1__motor */
    REAL(4.786324786324794e-07),     /* r1_w3_m__1__motor */
    REAL(0.0005470085470085475),     /* r1_w1_Fx__1 */
    REAL(0.0018984910741158942),     /* m__1__wheel_gain */
    -REAL(0.040134472934472976),     /* r1_w2_m__1__wheel */
    REAL(1.36752136752137e-05),      /* r1_w3_m__1__wheel */
    REAL(6.666666666666679e-05),     /* bend2 */
    REAL(3.3333333333333396e-05),    /* bend1 */
    REAL(0.00010000000000000018),    /* bend3 */
    REAL(25.0),                      /* scaled_one_over_tau0 */
    REAL(625.0),                     /* scaled_N_over_tau0 */
    REAL(0.00032),                   /* r2_Fx__1 */
    REAL(1.1999999999999999e-05),    /* r2_m__1__wheel_1 */
    REAL(0.1),                       /* r2_integral */
    REAL(2.5),                       /* r2_integral_2 */
    -REAL(0.004),                    /* r2_tanh */
    REAL(0.0),                       /* m__1__wheel__int__x0 */
    REAL(0.0),                       /* m__1__motor__int__x0 */
    REAL(8.000000000000008e-06),     /* r2_w2_m__1__wheel */
    REAL(0.004011424501424501),      /* r3_m__2__motor_1 */
    REAL(1.6045584045584047),        /* r3_Fx__2 */
    REAL(0.06017094017094017),       /* r3_m__2__wheel_1 */
    -REAL(0.0014041595441595456),    /* r3_w2_m__2__motor */
    REAL(4.786324786324794e-07),     /* r3_w3_m__2__motor */
    REAL(0.0005470085470085475),     /* r3_w1_Fx__2 */
    -REAL(0.040134472934472976),     /* r3_w2_m__2__wheel */
    REAL(1.36752136752137e-05),      /* r3_w3_m__2__wheel */
    REAL(25.0),                      /* scaled_one_over_tau0_2 */
    REAL(625.0),                     /* scaled_N_over_tau0_2 */
    REAL(0.00032),                   /* r4_Fx__2 */
    REAL(1.1999999999999999e-05),    /* r4_m__2__wheel_1 */
    REAL(0.1),                       /* r4_integral */
    REAL(2.5),                       /* r4_integral_2 */
    -REAL(0.004),                    /* r4_tanh */
    REAL(0.0),                       /* m__2__wheel__int__x0 */
    REAL(0.0),                       /* m__2__motor__int__x0 */
    REAL(8.000000000000008e-06),     /* r4_w2_m__2__wheel */
    REAL(0.85),                      /* r5_load */
    -REAL(1.0000794750000008e-05),   /* r5_w1_load */
    {654u, 562u, 654u, 562u, 462u},  /* samples until each is valid */
    654u                             /* the longest of these */
};

/* r1: coefficients */
static void compute_r1(khepera_encoders_coefficients *c, const khepera_encoders_parameters *p,
        real w)
{
    /* khepera.bg:17: m[1].fe*m[1].el.L/m[1].el.k */
    const real fe_times_L_over_k = p->m__1__fe * p->m__1__el__L / p->m__1__el__k;

    /* m[1].fs*m[1].el.L/(m[1].el.k*m[1].ge.N) */
    const real product = p->m__1__fs * p->m__1__el__L / p->m__1__el__k / p->m__1__ge__N;

    /* m[1].Je*m[1].el.Re/m[1].el.k */
    const real Je_times_Re_over_k = p->m__1__Je * p->m__1__el__Re / p->m__1__el__k;

    /* m[1].Js*m[1].el.Re/(m[1].el.k*m[1].ge.N) */
    const real product_2 = p->m__1__Js * p->m__1__el__Re / p->m__1__el__k / p->m__1__ge__N;

    /* r1: factor of m[1].motor': m[1].el.k + m[1].fe*m[1].el.Re/m[1].el.k */
    c->r1_m__1__motor_1 = p->m__1__el__k + p->m__1__fe * p->m__1__el__Re / p->m__1__el__k;

    /* r1: factor of Fx[1]: m[1].R*m[1].el.Re/(m[1].el.k*m[1].ge.N) */
    c->r1_Fx__1 = p->m__1__R * p->m__1__el__Re / p->m__1__el__k / p->m__1__ge__N;

    /* r1: factor of m[1].wheel': m[1].fs*m[1].el.Re/(m[1].el.k*m[1].ge.N) */
    c->r1_m__1__wheel_1 = p->m__1__fs * p->m__1__el__Re / p->m__1__el__k / p->m__1__ge__N;

    /* r1: factor of m[1].motor'' */
    c->r1_w2_m__1__motor = (-fe_times_L_over_k - Je_times_Re_over_k) * w;

    /* r1: factor of m[1].motor''' */
    c->r1_w3_m__1__motor = p->m__1__Je * p->m__1__el__L * w * w / p->m__1__el__k;

    /* r1: factor of Fx[1]' */
    c->r1_w1_Fx__1 = p->m__1__R * p->m__1__el__L * w / p->m__1__el__k / p->m__1__ge__N;

    /* r1: factor of m[1].wheel'' */
    c->r1_w2_m__1__wheel = (-product - product_2) * w;

    /* r1: factor of m[1].wheel''' */
    c->r1_w3_m__1__wheel = p->m__1__Js * p->m__1__el__L * w * w / p->m__1__el__k / p->m__1__ge__N;
}

/* filter: coefficients */
static void compute_filter(khepera_encoders_coefficients *c, real pole, real turn, real sum)
{
    /* turn^2 */
    const real turn_2 = turn * turn;

    /* filter: what is left of a memory a sample later */
    c->a = pole;

    /* filter: weight of a sample, new and a sample later */
    c->b = REAL(0.5) * sum;

    /* filter: 2 * (w*sample_time)^2/12 */
    c->bend2 = turn_2 / REAL(6.0);

    /* filter: 1 * (w*sample_time)^2/12 */
    c->bend1 = turn_2 / REAL(12.0);

    /* filter: 3 * (w*sample_time)^2/12 */
    c->bend3 = REAL(0.25) * turn_2;
}

/* r2: coefficients */
static void compute_r2(khepera_encoders_coefficients *c, const khepera_encoders_parameters *p,
        real w)
{
    /* khepera_encoders.bg:31: r2: factor of Fx[1]: m[1].R/m[1].ge.N */
    c->r2_Fx__1 = p->m__1__R / p->m__1__ge__N;

    /* r2: factor of m[1].wheel': m[1].fs/m[1].ge.N */
    c->r2_m__1__wheel_1 = p->m__1__fs / p->m__1__ge__N;

    /* r2: factor of Int(D(m[1].motor)): m[1].K */
    c->r2_integral = p->m__1__K;

    /* r2: factor of Int(D(m[1].wheel)): m[1].K*m[1].ge.N */
    c->r2_integral_2 = p->m__1__K * p->m__1__ge__N;

    /* r2: factor of tanh(Int(D(m[1].motor))/(4*m[1].tau0) -
     * m[1].ge.N*Int(D(m[1].wheel))/(4*m[1].tau0)): m[1].K*m[1].tau0*m[1].A */
    c->r2_tanh = p->m__1__K * p->m__1__tau0 * p->m__1__A;

    /* r2: factor of m[1].wheel'' */
    c->r2_w2_m__1__wheel = p->m__1__Js * w / p->m__1__ge__N;
}

/* r3: coefficients */
static void compute_r3(khepera_encoders_coefficients *c, const khepera_encoders_parameters *p,
        real w)
{
    /* khepera.bg:17: m[2].fe*m[2].el.L/m[2].el.k */
    const real fe_times_L_over_k_2 = p->m__2__fe * p->m__2__el__L / p->m__2__el__k;

    /* m[2].fs*m[2].el.L/(m[2].el.k*m[2].ge.N) */
    const real product_3 = p->m__2__fs * p->m__2__el__L / p->m__2__el__k / p->m__2__ge__N;

    /* m[2].Je*m[2].el.Re/m[2].el.k */
    const real Je_times_Re_over_k_2 = p->m__2__Je * p->m__2__el__Re / p->m__2__el__k;

    /* m[2].Js*m[2].el.Re/(m[2].el.k*m[2].ge.N) */
    const real product_4 = p->m__2__Js * p->m__2__el__Re / p->m__2__el__k / p->m__2__ge__N;

    /* r3: factor of m[2].motor': m[2].el.k + m[2].fe*m[2].el.Re/m[2].el.k */
    c->r3_m__2__motor_1 = p->m__2__el__k + p->m__2__fe * p->m__2__el__Re / p->m__2__el__k;

    /* r3: factor of Fx[2]: m[2].R*m[2].el.Re/(m[2].el.k*m[2].ge.N) */
    c->r3_Fx__2 = p->m__2__R * p->m__2__el__Re / p->m__2__el__k / p->m__2__ge__N;

    /* r3: factor of m[2].wheel': m[2].fs*m[2].el.Re/(m[2].el.k*m[2].ge.N) */
    c->r3_m__2__wheel_1 = p->m__2__fs * p->m__2__el__Re / p->m__2__el__k / p->m__2__ge__N;

    /* r3: factor of m[2].motor'' */
    c->r3_w2_m__2__motor = (-fe_times_L_over_k_2 - Je_times_Re_over_k_2) * w;

    /* r3: factor of m[2].motor''' */
    c->r3_w3_m__2__motor = p->m__2__Je * p->m__2__el__L * w * w / p->m__2__el__k;

    /* r3: factor of Fx[2]' */
    c->r3_w1_Fx__2 = p->m__2__R * p->m__2__el__L * w / p->m__2__el__k / p->m__2__ge__N;

    /* r3: factor of m[2].wheel'' */
    c->r3_w2_m__2__wheel = (-product_3 - product_4) * w;

    /* r3: factor of m[2].wheel''' */
    c->r3_w3_m__2__wheel = p->m__2__Js * p->m__2__el__L * w * w / p->m__2__el__k / p->m__2__ge__N;
}

/* r4: coefficients */
static void compute_r4(khepera_encoders_coefficients *c, const khepera_encoders_parameters *p,
        real w)
{
    /* khepera_encoders.bg:31: r4: factor of Fx[2]: m[2].R/m[2].ge.N */
    c->r4_Fx__2 = p->m__2__R / p->m__2__ge__N;

    /* r4: factor of m[2].wheel': m[2].fs/m[2].ge.N */
    c->r4_m__2__wheel_1 = p->m__2__fs / p->m__2__ge__N;

    /* r4: factor of Int(D(m[2].motor)): m[2].K */
    c->r4_integral = p->m__2__K;

    /* r4: factor of Int(D(m[2].wheel)): m[2].K*m[2].ge.N */
    c->r4_integral_2 = p->m__2__K * p->m__2__ge__N;

    /* r4: factor of tanh(Int(D(m[2].motor))/(4*m[2].tau0) -
     * m[2].ge.N*Int(D(m[2].wheel))/(4*m[2].tau0)): m[2].K*m[2].tau0*m[2].A */
    c->r4_tanh = p->m__2__K * p->m__2__tau0 * p->m__2__A;

    /* r4: factor of m[2].wheel'' */
    c->r4_w2_m__2__wheel = p->m__2__Js * w / p->m__2__ge__N;
}

/* r5: coefficients */
static void compute_r5(khepera_encoders_coefficients *c, const khepera_encoders_parameters *p,
        real w)
{
    /* khepera.bg:114: R_L^2 */
    const real R_L = p->R_L * p->R_L;

    /* r5: factor of load: R_L */
    c->r5_load = p->R_L;

    /* r5: factor of load' */
    c->r5_w1_load = (-REAL(11.0) * R_L / REAL(200000000000.0) - REAL(1.0) / REAL(2000000.0)) * w;
}

/* The coefficients, from the parameters. */
static void compute_coefficients(khepera_encoders_coefficients *c,
        const khepera_encoders_parameters *p, real sample_time, real bandwidth)
{
    /* bandwidth*sample_time */
    const real x_ = bandwidth * sample_time;

    /* of a stage: what is left of its memory */
    const real pole = greatest(REAL(2.0) - x_, REAL(0.0)) / (x_ + REAL(2.0));

    /* w*sample_time, x or 2 */
    const real turn = REAL(2.0) * (REAL(1.0) - pole) / (pole + REAL(1.0));

    /* w of the filter 1/(1 + D/w) */
    const real w = turn / sample_time;

    /* 1 - pole */
    const real sum = REAL(1.0) - pole;

    /* (1 - (1 - pole)/2)*w */
    const real product_5 = (REAL(1.0) - REAL(0.5) * sum) * w;

    /* speed of m[1].motor for one count */
    c->m__1__motor_gain = REAL(0.0015339807878856412) * product_5;

    /* speed of m[1].wheel for one count */
    c->m__1__wheel_gain = REAL(9.587379924285257e-05) * product_5;

    /* khepera_encoders.bg:31: 1/(4*m[1].tau0) */
    c->scaled_one_over_tau0 = REAL(0.25) / p->m__1__tau0;

    /* m[1].ge.N/(4*m[1].tau0) */
    c->scaled_N_over_tau0 = REAL(0.25) * p->m__1__ge__N / p->m__1__tau0;

    /* m[1].wheel.int.x0 */
    c->m__1__wheel__int__x0 = REAL(0.0);

    /* m[1].motor.int.x0 */
    c->m__1__motor__int__x0 = REAL(0.0);

    /* 1/(4*m[2].tau0) */
    c->scaled_one_over_tau0_2 = REAL(0.25) / p->m__2__tau0;

    /* m[2].ge.N/(4*m[2].tau0) */
    c->scaled_N_over_tau0_2 = REAL(0.25) * p->m__2__ge__N / p->m__2__tau0;

    /* m[2].wheel.int.x0 */
    c->m__2__wheel__int__x0 = REAL(0.0);

    /* m[2].motor.int.x0 */
    c->m__2__motor__int__x0 = REAL(0.0);

    compute_r1(c, p, w);
    compute_filter(c, pole, turn, sum);
    compute_r2(c, p, w);
    compute_r3(c, p, w);
    compute_r4(c, p, w);
    compute_r5(c, p, w);
}

static bool coefficients_are_finite(const khepera_encoders_coefficients *c)
{
    return finite_number(c->r1_m__1__motor_1 + c->r1_Fx__1 + c->r1_m__1__wheel_1
            + c->m__1__motor_gain + c->a + c->b + c->r1_w2_m__1__motor + c->r1_w3_m__1__motor
            + c->r1_w1_Fx__1 + c->m__1__wheel_gain + c->r1_w2_m__1__wheel + c->r1_w3_m__1__wheel
            + c->bend2 + c->bend1 + c->bend3 + c->scaled_one_over_tau0 + c->scaled_N_over_tau0
            + c->r2_Fx__1 + c->r2_m__1__wheel_1 + c->r2_integral + c->r2_integral_2 + c->r2_tanh
            + c->m__1__wheel__int__x0 + c->m__1__motor__int__x0 + c->r2_w2_m__1__wheel
            + c->r3_m__2__motor_1 + c->r3_Fx__2 + c->r3_m__2__wheel_1 + c->r3_w2_m__2__motor
            + c->r3_w3_m__2__motor + c->r3_w1_Fx__2 + c->r3_w2_m__2__wheel + c->r3_w3_m__2__wheel
            + c->scaled_one_over_tau0_2 + c->scaled_N_over_tau0_2 + c->r4_Fx__2
            + c->r4_m__2__wheel_1 + c->r4_integral + c->r4_integral_2 + c->r4_tanh
            + c->m__2__wheel__int__x0 + c->m__2__motor__int__x0 + c->r4_w2_m__2__wheel + c->r5_load
            + c->r5_w1_load);
}

khepera_encoders_status khepera_encoders_configure(
    khepera_encoders_coefficients *coefficients,
    const khepera_encoders_parameters *parameters,
    khepera_encoders_real sample_time,
    khepera_encoders_real bandwidth)
{
    khepera_encoders_coefficients *c = coefficients;
    const khepera_encoders_status status = checked(parameters, sample_time, bandwidth);
    int k;

    for (k = 0; k < KHEPERA_ENCODERS_RESIDUALS; ++k) {
        c->settle[k] = UINT32_MAX;
    }
    c->longest = UINT32_MAX;
    if (status != KHEPERA_ENCODERS_OK) {
        return status;
    }
    compute_coefficients(c, parameters, sample_time, bandwidth);
    if (!coefficients_are_finite(c)) {
        return KHEPERA_ENCODERS_BAD_COEFFICIENT;
    }
    c->settle[KHEPERA_ENCODERS_R1] = samples(REAL(13.062240779188071), sample_time, bandwidth);
    c->settle[KHEPERA_ENCODERS_R2] = samples(REAL(11.228872242412663), sample_time, bandwidth);
    c->settle[KHEPERA_ENCODERS_R3] = samples(REAL(13.062240779188071), sample_time, bandwidth);
    c->settle[KHEPERA_ENCODERS_R4] = samples(REAL(11.228872242412663), sample_time, bandwidth);
    c->settle[KHEPERA_ENCODERS_R5] = samples(REAL(9.233413476451586), sample_time, bandwidth);
    c->longest = c->settle[KHEPERA_ENCODERS_R1];
    return KHEPERA_ENCODERS_OK;
}

/* stage 1 */
static real run_r1_y1(const khepera_encoders_coefficients *c, khepera_encoders_memory *x,
        const khepera_encoders_samples *s, real a, real b, real n1, real e1, real n2, real e2,
        real n3)
{
    /* terms of order 0 */
    const real g0 = s->U0__1 - c->r1_Fx__1 * s->Fx__1;

    /* terms of order 1 */
    const real g1 = c->r1_w1_Fx__1 * s->Fx__1;

    /* degree 1 */
    const real d1 = n1 + n2 - g1;

    /* error of order 0 */
    const real e0 = c->bend3 * g0;

    /* degree 2 */
    const real d2 = n2 + n3 - e1 - e0;

    /* error of order 1 */
    const real e1_2 = c->bend2 * g1;

    /* degree 3 */
    const real d3 = n3 + e1_2 - e1 - e2;

    /* the filter multiplied out */
    const real p3_1 = d3 + e2;
    const real p2_1 = p3_1 + e2;
    const real p2_2 = d2 - p3_1;
    const real p1_1 = p2_1 + e2;
    const real p1_2 = p2_2 - p2_1;
    const real p1_3 = d1 - p2_2;

    /* stage 4 */
    const real u4 = g0 + n1 - p1_3;
    const real y4 = x->r1_s4 + b * u4;
    x->r1_s4 = a * y4 + b * u4;

    /* stage 3 */
    const real u3 = y4 + p1_3 - p1_2;
    const real y3 = x->r1_s3 + b * u3;
    x->r1_s3 = a * y3 + b * u3;

    /* stage 2 */
    const real u2 = y3 + p1_2 - p1_1;
    const real y2 = x->r1_s2 + b * u2;
    x->r1_s2 = a * y2 + b * u2;

    /* stage 1 */
    const real u1 = y2 + p1_1 + e2;
    const real y1 = x->r1_s1 + b * u1;
    x->r1_s1 = a * y1 + b * u1;

    return y1;
}

/* r1 on one sample.
 * khepera.bg:17: r1 = U0[1] - m[1].el.k*D(m[1].motor) - m[1].el.Re*m[1].el.k.e2/m[1].el.k -
 * m[1].el.L*D(m[1].el.k.e2)/m[1].el.k
 * where m[1].el.k.e2 = m[1].fe*D(m[1].motor) + m[1].Je*D(m[1].motor, 2) + (Fx[1]*m[1].R +
 * m[1].fs*D(m[1].wheel) + m[1].Js*D(m[1].wheel, 2))/m[1].ge.N */
static void run_r1(
    const khepera_encoders_coefficients *c, khepera_encoders_memory *x, const khepera_encoders_samples *s, real *r)
{
    const bool first = x->youngest == 0u && x->age[0] == 0u;
    const khepera_encoders_encoders *e = &x->e;

    count_on(&x->e.m__1__motor_r1, s->m__1__motor, first);
    count_on(&x->e.m__1__wheel_r1, s->m__1__wheel, first);

    if (first) {
        /* nothing is remembered yet */
        x->r1_m__1__motor_speed = REAL(0.0);
        x->r1_m__1__wheel_speed = REAL(0.0);
        x->r1_s4 = REAL(0.0);
        x->r1_s3 = REAL(0.0);
        x->r1_s2 = REAL(0.0);
        x->r1_s1 = REAL(0.0);
    }

    /* a stage of the filter; on the first sample it is at rest */
    const real a = first ? -c->b : c->a;
    const real b = first ? REAL(1.0) : c->b;

    /* filtered speed of m[1].motor */
    const real m__1__motor_speed_2 = c->a * x->r1_m__1__motor_speed
        + c->m__1__motor_gain * (real)e->m__1__motor_r1.increment;
    x->r1_m__1__motor_speed = m__1__motor_speed_2;

    /* filtered speed of m[1].wheel */
    const real m__1__wheel_speed_2 = c->a * x->r1_m__1__wheel_speed
        + c->m__1__wheel_gain * (real)e->m__1__wheel_r1.increment;
    x->r1_m__1__wheel_speed = m__1__wheel_speed_2;

    /* encoders, order 1 */
    const real n1 = -c->r1_m__1__motor_1 * m__1__motor_speed_2
        - c->r1_m__1__wheel_1 * m__1__wheel_speed_2;

    /* error of order 1 */
    const real e1 = c->bend2 * n1;

    /* encoders, order 2 */
    const real n2 = c->r1_w2_m__1__motor * m__1__motor_speed_2
        + c->r1_w2_m__1__wheel * m__1__wheel_speed_2;

    /* error of order 2 */
    const real e2 = c->bend1 * n2;

    /* encoders, order 3 */
    const real n3 = -c->r1_w3_m__1__motor * m__1__motor_speed_2
        - c->r1_w3_m__1__wheel * m__1__wheel_speed_2;

    const real y1 = run_r1_y1(c, x, s, a, b, n1, e1, n2, e2, n3);

    r[KHEPERA_ENCODERS_R1] = y1 - e2;
}

/* error of order 1; stage 1 */
static void run_r2_e1_to_y1(const khepera_encoders_coefficients *c, khepera_encoders_memory *x,
        const khepera_encoders_samples *s, real a, real b, real change, real change_2, real *e1_out,
        real *y1_out)
{
    const khepera_encoders_encoders *e = &x->e;

    /* tanh(Int(D(m[1].motor))/(4*m[1].tau0) - m[1].ge.N*Int(D(m[1].wheel))/(4*m[1].tau0)) */
    const real tanh_ = near_tanh(c->scaled_one_over_tau0 * change_2
            - c->scaled_N_over_tau0 * change);

    /* filtered speed of m[1].wheel */
    const real m__1__wheel_speed_2 = c->a * x->r2_m__1__wheel_speed
        + c->m__1__wheel_gain * (real)e->m__1__wheel_r2.increment;
    x->r2_m__1__wheel_speed = m__1__wheel_speed_2;

    /* encoders, order 1 */
    const real n1 = c->r2_m__1__wheel_1 * m__1__wheel_speed_2;

    /* error of order 1 */
    const real e1 = c->bend1 * n1;

    /* encoders, order 2 */
    const real n2 = c->r2_w2_m__1__wheel * m__1__wheel_speed_2;

    /* terms of order 0 */
    const real g0 = c->r2_Fx__1 * s->Fx__1 + c->r2_integral_2 * change - c->r2_integral * change_2
        - c->r2_tanh * tanh_;

    /* degree 1 */
    const real d1 = n1 + n2;

    /* error of order 0 */
    const real e0 = c->bend2 * g0;

    /* degree 2 */
    const real d2 = n2 - e1 - e0;

    /* the filter multiplied out */
    const real p2_1 = d2 + e1;
    const real p1_1 = p2_1 + e1;
    const real p1_2 = d1 - p2_1;

    /* stage 3 */
    const real u3 = g0 + n1 - p1_2;
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

    *e1_out = e1;
    *y1_out = y1;
}

/* r2 on one sample.
 * khepera_encoders.bg:31: r2 = (Fx[1]*m[1].R + m[1].fs*D(m[1].wheel) + m[1].Js*D(m[1].wheel,
 * 2))/m[1].ge.N - m[1].K*(m[1].spring.q + m[1].tau0*m[1].A*tanh(m[1].spring.q/(4*m[1].tau0)))
 * where m[1].spring.q = Int(D(m[1].motor) - m[1].ge.N*D(m[1].wheel)) */
static void run_r2(
    const khepera_encoders_coefficients *c, khepera_encoders_memory *x, const khepera_encoders_samples *s, real *r)
{
    const bool first = x->youngest == 0u && x->age[1] == 0u;
    const khepera_encoders_encoders *e = &x->e;

    count_on(&x->e.m__1__motor_r2, s->m__1__motor, first);
    count_on(&x->e.m__1__wheel_r2, s->m__1__wheel, first);

    if (first) {
        /* nothing is remembered yet */
        x->r2_m__1__wheel_speed = REAL(0.0);
        x->r2_s3 = REAL(0.0);
        x->r2_s2 = REAL(0.0);
        x->r2_s1 = REAL(0.0);
    }

    /* a stage of the filter; on the first sample it is at rest */
    const real a = first ? -c->b : c->a;
    const real b = first ? REAL(1.0) : c->b;

    /* m[1].wheel */
    const real m__1__wheel = c->m__1__wheel__int__x0
        + REAL(9.587379924285257e-05) * (real)e->m__1__wheel_r2.total;

    if (first) {
        /* change of D(m[1].wheel) */
        x->r2_start = m__1__wheel;
    }

    /* change of D(m[1].wheel) */
    const real change = m__1__wheel - x->r2_start;

    /* m[1].motor */
    const real m__1__motor = c->m__1__motor__int__x0
        + REAL(0.0015339807878856412) * (real)e->m__1__motor_r2.total;

    if (first) {
        /* change of D(m[1].motor) */
        x->r2_start_2 = m__1__motor;
    }

    /* change of D(m[1].motor) */
    const real change_2 = m__1__motor - x->r2_start_2;

    real e1;
    real y1;

    run_r2_e1_to_y1(c, x, s, a, b, change, change_2, &e1, &y1);

    r[KHEPERA_ENCODERS_R2] = y1 - e1;
}

/* stage 1 */
static real run_r3_y1(const khepera_encoders_coefficients *c, khepera_encoders_memory *x,
        const khepera_encoders_samples *s, real a, real b, real n1, real e1, real n2, real e2,
        real n3)
{
    /* terms of order 0 */
    const real g0 = s->U0__2 - c->r3_Fx__2 * s->Fx__2;

    /* terms of order 1 */
    const real g1 = c->r3_w1_Fx__2 * s->Fx__2;

    /* degree 1 */
    const real d1 = n1 + n2 - g1;

    /* error of order 0 */
    const real e0 = c->bend3 * g0;

    /* degree 2 */
    const real d2 = n2 + n3 - e1 - e0;

    /* error of order 1 */
    const real e1_2 = c->bend2 * g1;

    /* degree 3 */
    const real d3 = n3 + e1_2 - e1 - e2;

    /* the filter multiplied out */
    const real p3_1 = d3 + e2;
    const real p2_1 = p3_1 + e2;
    const real p2_2 = d2 - p3_1;
    const real p1_1 = p2_1 + e2;
    const real p1_2 = p2_2 - p2_1;
    const real p1_3 = d1 - p2_2;

    /* stage 4 */
    const real u4 = g0 + n1 - p1_3;
    const real y4 = x->r3_s4 + b * u4;
    x->r3_s4 = a * y4 + b * u4;

    /* stage 3 */
    const real u3 = y4 + p1_3 - p1_2;
    const real y3 = x->r3_s3 + b * u3;
    x->r3_s3 = a * y3 + b * u3;

    /* stage 2 */
    const real u2 = y3 + p1_2 - p1_1;
    const real y2 = x->r3_s2 + b * u2;
    x->r3_s2 = a * y2 + b * u2;

    /* stage 1 */
    const real u1 = y2 + p1_1 + e2;
    const real y1 = x->r3_s1 + b * u1;
    x->r3_s1 = a * y1 + b * u1;

    return y1;
}

/* r3 on one sample.
 * khepera.bg:17: r3 = U0[2] - m[2].el.k*D(m[2].motor) - m[2].el.Re*m[2].el.k.e2/m[2].el.k -
 * m[2].el.L*D(m[2].el.k.e2)/m[2].el.k
 * where m[2].el.k.e2 = m[2].fe*D(m[2].motor) + m[2].Je*D(m[2].motor, 2) + (Fx[2]*m[2].R +
 * m[2].fs*D(m[2].wheel) + m[2].Js*D(m[2].wheel, 2))/m[2].ge.N */
static void run_r3(
    const khepera_encoders_coefficients *c, khepera_encoders_memory *x, const khepera_encoders_samples *s, real *r)
{
    const bool first = x->youngest == 0u && x->age[2] == 0u;
    const khepera_encoders_encoders *e = &x->e;

    count_on(&x->e.m__2__motor_r3, s->m__2__motor, first);
    count_on(&x->e.m__2__wheel_r3, s->m__2__wheel, first);

    if (first) {
        /* nothing is remembered yet */
        x->r3_m__2__motor_speed = REAL(0.0);
        x->r3_m__2__wheel_speed = REAL(0.0);
        x->r3_s4 = REAL(0.0);
        x->r3_s3 = REAL(0.0);
        x->r3_s2 = REAL(0.0);
        x->r3_s1 = REAL(0.0);
    }

    /* a stage of the filter; on the first sample it is at rest */
    const real a = first ? -c->b : c->a;
    const real b = first ? REAL(1.0) : c->b;

    /* filtered speed of m[2].motor */
    const real m__2__motor_speed_2 = c->a * x->r3_m__2__motor_speed
        + c->m__1__motor_gain * (real)e->m__2__motor_r3.increment;
    x->r3_m__2__motor_speed = m__2__motor_speed_2;

    /* filtered speed of m[2].wheel */
    const real m__2__wheel_speed_2 = c->a * x->r3_m__2__wheel_speed
        + c->m__1__wheel_gain * (real)e->m__2__wheel_r3.increment;
    x->r3_m__2__wheel_speed = m__2__wheel_speed_2;

    /* encoders, order 1 */
    const real n1 = -c->r3_m__2__motor_1 * m__2__motor_speed_2
        - c->r3_m__2__wheel_1 * m__2__wheel_speed_2;

    /* error of order 1 */
    const real e1 = c->bend2 * n1;

    /* encoders, order 2 */
    const real n2 = c->r3_w2_m__2__motor * m__2__motor_speed_2
        + c->r3_w2_m__2__wheel * m__2__wheel_speed_2;

    /* error of order 2 */
    const real e2 = c->bend1 * n2;

    /* encoders, order 3 */
    const real n3 = -c->r3_w3_m__2__motor * m__2__motor_speed_2
        - c->r3_w3_m__2__wheel * m__2__wheel_speed_2;

    const real y1 = run_r3_y1(c, x, s, a, b, n1, e1, n2, e2, n3);

    r[KHEPERA_ENCODERS_R3] = y1 - e2;
}

/* error of order 1; stage 1 */
static void run_r4_e1_to_y1(const khepera_encoders_coefficients *c, khepera_encoders_memory *x,
        const khepera_encoders_samples *s, real a, real b, real change, real change_2, real *e1_out,
        real *y1_out)
{
    const khepera_encoders_encoders *e = &x->e;

    /* tanh(Int(D(m[2].motor))/(4*m[2].tau0) - m[2].ge.N*Int(D(m[2].wheel))/(4*m[2].tau0)) */
    const real tanh_ = near_tanh(c->scaled_one_over_tau0_2 * change_2
            - c->scaled_N_over_tau0_2 * change);

    /* filtered speed of m[2].wheel */
    const real m__2__wheel_speed_2 = c->a * x->r4_m__2__wheel_speed
        + c->m__1__wheel_gain * (real)e->m__2__wheel_r4.increment;
    x->r4_m__2__wheel_speed = m__2__wheel_speed_2;

    /* encoders, order 1 */
    const real n1 = c->r4_m__2__wheel_1 * m__2__wheel_speed_2;

    /* error of order 1 */
    const real e1 = c->bend1 * n1;

    /* encoders, order 2 */
    const real n2 = c->r4_w2_m__2__wheel * m__2__wheel_speed_2;

    /* terms of order 0 */
    const real g0 = c->r4_Fx__2 * s->Fx__2 + c->r4_integral_2 * change - c->r4_integral * change_2
        - c->r4_tanh * tanh_;

    /* degree 1 */
    const real d1 = n1 + n2;

    /* error of order 0 */
    const real e0 = c->bend2 * g0;

    /* degree 2 */
    const real d2 = n2 - e1 - e0;

    /* the filter multiplied out */
    const real p2_1 = d2 + e1;
    const real p1_1 = p2_1 + e1;
    const real p1_2 = d1 - p2_1;

    /* stage 3 */
    const real u3 = g0 + n1 - p1_2;
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

    *e1_out = e1;
    *y1_out = y1;
}

/* r4 on one sample.
 * khepera_encoders.bg:31: r4 = (Fx[2]*m[2].R + m[2].fs*D(m[2].wheel) + m[2].Js*D(m[2].wheel,
 * 2))/m[2].ge.N - m[2].K*(m[2].spring.q + m[2].tau0*m[2].A*tanh(m[2].spring.q/(4*m[2].tau0)))
 * where m[2].spring.q = Int(D(m[2].motor) - m[2].ge.N*D(m[2].wheel)) */
static void run_r4(
    const khepera_encoders_coefficients *c, khepera_encoders_memory *x, const khepera_encoders_samples *s, real *r)
{
    const bool first = x->youngest == 0u && x->age[3] == 0u;
    const khepera_encoders_encoders *e = &x->e;

    count_on(&x->e.m__2__motor_r4, s->m__2__motor, first);
    count_on(&x->e.m__2__wheel_r4, s->m__2__wheel, first);

    if (first) {
        /* nothing is remembered yet */
        x->r4_m__2__wheel_speed = REAL(0.0);
        x->r4_s3 = REAL(0.0);
        x->r4_s2 = REAL(0.0);
        x->r4_s1 = REAL(0.0);
    }

    /* a stage of the filter; on the first sample it is at rest */
    const real a = first ? -c->b : c->a;
    const real b = first ? REAL(1.0) : c->b;

    /* m[2].wheel */
    const real m__2__wheel = c->m__2__wheel__int__x0
        + REAL(9.587379924285257e-05) * (real)e->m__2__wheel_r4.total;

    if (first) {
        /* change of D(m[2].wheel) */
        x->r4_start = m__2__wheel;
    }

    /* change of D(m[2].wheel) */
    const real change = m__2__wheel - x->r4_start;

    /* m[2].motor */
    const real m__2__motor = c->m__2__motor__int__x0
        + REAL(0.0015339807878856412) * (real)e->m__2__motor_r4.total;

    if (first) {
        /* change of D(m[2].motor) */
        x->r4_start_2 = m__2__motor;
    }

    /* change of D(m[2].motor) */
    const real change_2 = m__2__motor - x->r4_start_2;

    real e1;
    real y1;

    run_r4_e1_to_y1(c, x, s, a, b, change, change_2, &e1, &y1);

    r[KHEPERA_ENCODERS_R4] = y1 - e1;
}

/* r5 on one sample.
 * khepera.bg:114: r5 = Uin - line.cell[1].mid.e - R_L*line.cell[1].left.f/2 -
 * D(line.cell[1].left.f)/4000000
 * where line.cell[1].left.f = line.cell[1].right.f + 2.2e-10*D(line.cell[1].mid.e)
 * line.cell[1].mid.e = Us + R_L*line.cell[1].right.f/2 + D(line.cell[1].right.f)/4000000
 * line.cell[1].right.f = load + 2.2e-10*D(Us) */
static void run_r5(
    const khepera_encoders_coefficients *c, khepera_encoders_memory *x, const khepera_encoders_samples *s, real *r)
{
    const bool first = x->youngest == 0u && x->age[4] == 0u;

    if (first) {
        /* nothing is remembered yet */
        x->r5_s2 = REAL(0.0);
        x->r5_s1 = REAL(0.0);
    }

    /* a stage of the filter; on the first sample it is at rest */
    const real a = first ? -c->b : c->a;
    const real b = first ? REAL(1.0) : c->b;

    /* terms of order 0 */
    const real g0 = s->Uin - s->Us - c->r5_load * s->load;

    /* degree 1 */
    const real d1 = c->r5_w1_load * s->load;

    /* error of order 0 */
    const real e0 = c->bend1 * g0;

    /* the filter multiplied out */
    const real p1_1 = d1 + e0;

    /* stage 2 */
    const real u2 = g0 - p1_1;
    const real y2 = x->r5_s2 + b * u2;
    x->r5_s2 = a * y2 + b * u2;

    /* stage 1 */
    const real u1 = y2 + p1_1 + e0;
    const real y1 = x->r5_s1 + b * u1;
    x->r5_s1 = a * y1 + b * u1;

    r[KHEPERA_ENCODERS_R5] = y1 - e0;
}

/* Ages and validity one by one: a number that is not finite makes the next sample the first. */
static void count_samples(
    const khepera_encoders_coefficients *c,
    khepera_encoders_memory *x,
    khepera_encoders_residuals *out)
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

void khepera_encoders_reset(khepera_encoders_memory *memory)
{
    int k;

    for (k = 0; k < 5; ++k) {
        memory->age[k] = 0u;
    }
    memory->youngest = 0u;
}

void khepera_encoders_step(
    const khepera_encoders_coefficients *coefficients,
    khepera_encoders_memory *memory,
    const khepera_encoders_samples *samples,
    khepera_encoders_residuals *residuals)
{
    const khepera_encoders_coefficients *c = coefficients;
    khepera_encoders_memory *x = memory;
    const khepera_encoders_samples *s = samples;
    real *r = residuals->value;
    int k;

    run_r1(c, x, s, r);
    run_r2(c, x, s, r);
    run_r3(c, x, s, r);
    run_r4(c, x, s, r);
    run_r5(c, x, s, r);
    /* a sum is finite only if all its terms are */
    if (x->youngest > c->longest
            && finite_number(r[KHEPERA_ENCODERS_R1] + r[KHEPERA_ENCODERS_R2]
                + r[KHEPERA_ENCODERS_R3] + r[KHEPERA_ENCODERS_R4] + r[KHEPERA_ENCODERS_R5])) {
        for (k = 0; k < KHEPERA_ENCODERS_RESIDUALS; ++k) {
            residuals->valid[k] = true;
        }
    } else {
        count_samples(c, x, residuals);
    }
}

#ifndef KHEPERA_ENCODERS_NO_THRESHOLDS

const khepera_encoders_threshold_coefficients khepera_encoders_threshold_nominal_coefficients = {
    REAL(5.014245014245014e-05),     /* r1_w1_w1_m__1__motor */
    REAL(0.030375857185854307),      /* m__1__motor_gain */
    REAL(0.9801980198019802),        /* a */
    REAL(0.00990099009900991),       /* b */
    REAL(1.7094017094017106e-08),    /* r1_w1_w2_m__1__motor */
    REAL(3.3333333333333396e-05),    /* bend1 */
    REAL(0.000802279202279203),      /* r1_w2_w2_m__1__wheel */
    REAL(0.0018984910741158942),     /* m__1__wheel_gain */
    REAL(2.7350427350427397e-07),    /* r1_w2_w3_m__1__wheel */
    REAL(0.006017094017094017),      /* r1_w3_w1_m__1__wheel */
    REAL(2.051282051282053e-06),     /* r1_w3_w2_m__1__wheel */
    REAL(0.0030085470085470085),     /* r1_w4_w1_m__1__wheel */
    REAL(0.0020056980056980074),     /* r1_w4_w2_m__1__wheel */
    REAL(0.08022792022792023),       /* r1_w4_Fx__1 */
    REAL(2.507122507122507e-05),     /* r1_w4_w1_m__1__motor */
    REAL(7.019943019943026e-05),     /* r1_w4_w2_m__1__motor */
    REAL(6.666666666666679e-05),     /* bend2 */
    -REAL(6.017150997150998e-05),    /* r1_w5_w1_m__1__motor */
    REAL(2.8083190883190912e-05),    /* r1_w5_w2_m__1__motor */
    REAL(9.572649572649589e-09),     /* r1_w5_w3_m__1__motor */
    REAL(0.0012034188034188034),     /* r1_w5_w1_m__1__wheel */
    REAL(0.0008026894586894596),     /* r1_w5_w2_m__1__wheel */
    REAL(0.0320911680911681),        /* r1_w5_Fx__1 */
    REAL(1.0940170940170949e-05),    /* r1_w5_w1_Fx__1 */
    REAL(0.00010000000000000018),    /* bend3 */
    REAL(2.6338740624454907e-06),    /* r1_w6_w1_m__1__motor */
    REAL(1.0535496249781964e-06),    /* r1_w7_w1_m__1__motor */
    REAL(3.591646448789308e-10),     /* r1_w7_w2_m__1__motor */
    REAL(4.214198499912789e-05),     /* r1_w8_w2_m__1__wheel */
    REAL(1.685679399965116e-05),     /* r1_w9_w2_m__1__wheel */
    REAL(5.746634318062899e-09),     /* r1_w9_w3_m__1__wheel */
    REAL(0.00031606488749345895),    /* r1_w10_w1_m__1__wheel */
    REAL(0.00012642595499738358),    /* r1_w11_w1_m__1__wheel */
    REAL(4.30997573854717e-08),      /* r1_w11_w2_m__1__wheel */
    REAL(5.267748124890982e-07),     /* r1_w12_w1_m__1__motor */
    REAL(1.4749694749694763e-06),    /* r1_w12_w2_m__1__motor */
    REAL(6.321297749869179e-05),     /* r1_w12_w1_m__1__wheel */
    REAL(0.0016856793999651142),     /* r1_w12_Fx__1 */
    REAL(2.1070992499563927e-07),    /* r1_w13_w1_m__1__motor */
    -REAL(5.900596229167663e-07),    /* r1_w13_w2_m__1__motor */
    REAL(2.0113220113220148e-10),    /* r1_w13_w3_m__1__motor */
    REAL(2.5285190999476715e-05),    /* r1_w13_w1_m__1__wheel */
    -REAL(1.6865413951128253e-05),   /* r1_w13_w2_m__1__wheel */
    REAL(0.0006742717599860457),     /* r1_w13_Fx__1 */
    REAL(2.2986537272251577e-07),    /* r1_w13_w1_Fx__1 */
    REAL(0.0),                       /* m__1__wheel__int__x0 */
    REAL(0.0),                       /* m__1__motor__int__x0 */
    REAL(25.0),                      /* scaled_one_over_tau0 */
    REAL(625.0),                     /* scaled_N_over_tau0 */
    REAL(0.005),                     /* r2_w1_integral */
    REAL(0.125),                     /* r2_w1_integral_2 */
    -REAL(0.0002),                   /* r2_w1_tanh */
    REAL(2500.0),                    /* scaled_one_over_tau0_2 */
    REAL(62500.0),                   /* scaled_N_over_tau0_2 */
    -REAL(2.0000000000000003e-06),   /* r2_w2_product */
    REAL(1.6000000000000016e-07),    /* r2_w3_w2_m__1__wheel */
    REAL(1.2e-06),                   /* r2_w4_w1_m__1__wheel */
    -REAL(1.0526315789473684e-05),   /* r2_w5_tanh */
    -REAL(1.0526315789473685e-07),   /* r2_w5_product */
    REAL(500000.0),                  /* scaled_one_over_tau0_3 */
    REAL(12500000.0),                /* scaled_N_over_tau0_3 */
    -REAL(5.263157894736843e-10),    /* r2_w6_product */
    -REAL(1.0526315789473685e-09),   /* r2_w6_product_2 */
    REAL(5.014245014245014e-05),     /* r3_w1_w1_m__2__motor */
    REAL(1.7094017094017106e-08),    /* r3_w1_w2_m__2__motor */
    REAL(0.000802279202279203),      /* r3_w2_w2_m__2__wheel */
    REAL(2.7350427350427397e-07),    /* r3_w2_w3_m__2__wheel */
    REAL(0.006017094017094017),      /* r3_w3_w1_m__2__wheel */
    REAL(2.051282051282053e-06),     /* r3_w3_w2_m__2__wheel */
    REAL(0.0030085470085470085),     /* r3_w4_w1_m__2__wheel */
    REAL(0.0020056980056980074),     /* r3_w4_w2_m__2__wheel */
    REAL(0.08022792022792023),       /* r3_w4_Fx__2 */
    REAL(2.507122507122507e-05),     /* r3_w4_w1_m__2__motor */
    REAL(7.019943019943026e-05),     /* r3_w4_w2_m__2__motor */
    -REAL(6.017150997150998e-05),    /* r3_w5_w1_m__2__motor */
    REAL(2.8083190883190912e-05),    /* r3_w5_w2_m__2__motor */
    REAL(9.572649572649589e-09),     /* r3_w5_w3_m__2__motor */
    REAL(0.0012034188034188034),     /* r3_w5_w1_m__2__wheel */
    REAL(0.0008026894586894596),     /* r3_w5_w2_m__2__wheel */
    REAL(0.0320911680911681),        /* r3_w5_Fx__2 */
    REAL(1.0940170940170949e-05),    /* r3_w5_w1_Fx__2 */
    REAL(2.6338740624454907e-06),    /* r3_w6_w1_m__2__motor */
    REAL(1.0535496249781964e-06),    /* r3_w7_w1_m__2__motor */
    REAL(3.591646448789308e-10),     /* r3_w7_w2_m__2__motor */
    REAL(4.214198499912789e-05),     /* r3_w8_w2_m__2__wheel */
    REAL(1.685679399965116e-05),     /* r3_w9_w2_m__2__wheel */
    REAL(5.746634318062899e-09),     /* r3_w9_w3_m__2__wheel */
    REAL(0.00031606488749345895),    /* r3_w10_w1_m__2__wheel */
    REAL(0.00012642595499738358),    /* r3_w11_w1_m__2__wheel */
    REAL(4.30997573854717e-08),      /* r3_w11_w2_m__2__wheel */
    REAL(5.267748124890982e-07),     /* r3_w12_w1_m__2__motor */
    REAL(1.4749694749694763e-06),    /* r3_w12_w2_m__2__motor */
    REAL(6.321297749869179e-05),     /* r3_w12_w1_m__2__wheel */
    REAL(0.0016856793999651142),     /* r3_w12_Fx__2 */
    REAL(2.1070992499563927e-07),    /* r3_w13_w1_m__2__motor */
    -REAL(5.900596229167663e-07),    /* r3_w13_w2_m__2__motor */
    REAL(2.0113220113220148e-10),    /* r3_w13_w3_m__2__motor */
    REAL(2.5285190999476715e-05),    /* r3_w13_w1_m__2__wheel */
    -REAL(1.6865413951128253e-05),   /* r3_w13_w2_m__2__wheel */
    REAL(0.0006742717599860457),     /* r3_w13_Fx__2 */
    REAL(2.2986537272251577e-07),    /* r3_w13_w1_Fx__2 */
    REAL(0.0),                       /* m__2__wheel__int__x0 */
    REAL(0.0),                       /* m__2__motor__int__x0 */
    REAL(25.0),                      /* scaled_one_over_tau0_4 */
    REAL(625.0),                     /* scaled_N_over_tau0_4 */
    REAL(0.005),                     /* r4_w1_integral */
    REAL(0.125),                     /* r4_w1_integral_2 */
    -REAL(0.0002),                   /* r4_w1_tanh */
    REAL(2500.0),                    /* scaled_one_over_tau0_5 */
    REAL(62500.0),                   /* scaled_N_over_tau0_5 */
    -REAL(2.0000000000000003e-06),   /* r4_w2_product */
    REAL(1.6000000000000016e-07),    /* r4_w3_w2_m__2__wheel */
    REAL(1.2e-06),                   /* r4_w4_w1_m__2__wheel */
    -REAL(1.0526315789473684e-05),   /* r4_w5_tanh */
    -REAL(1.0526315789473685e-07),   /* r4_w5_product */
    REAL(500000.0),                  /* scaled_one_over_tau0_6 */
    REAL(12500000.0),                /* scaled_N_over_tau0_6 */
    -REAL(5.263157894736843e-10),    /* r4_w6_product */
    -REAL(1.0526315789473685e-09),   /* r4_w6_product_2 */
    REAL(0.08499999999999999),       /* r5_w1_load */
    REAL(1.5895000000000013e-10),    /* r5_w1_w1_load */
    REAL(7.947500000000007e-12),     /* r5_w2_w1_load */
    {654u, 562u, 654u, 562u, 462u},  /* samples until each is valid */
    654u                             /* the longest of these */
};

/* r1_w2 to r1_w3: coefficients */
static void bound_compute_r1_w2_to_r1_w3(khepera_encoders_threshold_coefficients *c, real product_2,
        real product_8, real product_13, real product_14)
{
    /* khepera.bg:17: r1_w2: factor of m[1].wheel'' */
    c->r1_w2_w2_m__1__wheel = product_13 / REAL(50.0);

    /* r1_w2: factor of m[1].wheel''' */
    c->r1_w2_w3_m__1__wheel = product_8 / REAL(50.0);

    /* r1_w3: factor of m[1].wheel' */
    c->r1_w3_w1_m__1__wheel = product_2 / REAL(10.0);

    /* r1_w3: factor of m[1].wheel'' */
    c->r1_w3_w2_m__1__wheel = product_14 / REAL(10.0);
}

/* r1_w4: coefficients */
static void bound_compute_r1_w4(khepera_encoders_threshold_coefficients *c, real fe_times_Re_over_k,
        real product, real product_2, real product_13, real product_15)
{
    /* khepera.bg:17: r1_w4: factor of m[1].wheel' */
    c->r1_w4_w1_m__1__wheel = product_2 / REAL(20.0);

    /* r1_w4: factor of m[1].wheel'' */
    c->r1_w4_w2_m__1__wheel = product_13 / REAL(20.0);

    /* r1_w4: factor of Fx[1] */
    c->r1_w4_Fx__1 = product / REAL(20.0);

    /* r1_w4: factor of m[1].motor' */
    c->r1_w4_w1_m__1__motor = fe_times_Re_over_k / REAL(20.0);

    /* r1_w4: factor of m[1].motor'' */
    c->r1_w4_w2_m__1__motor = product_15 / REAL(20.0);
}

/* r1_w5: coefficients */
static void bound_compute_r1_w5(khepera_encoders_threshold_coefficients *c,
        const khepera_encoders_parameters *p, real w, real product, real product_2, real product_6,
        real product_7)
{
    /* khepera.bg:17: r1_w5: factor of m[1].motor' */
    c->r1_w5_w1_m__1__motor = p->m__1__el__k
            * (p->m__1__fe * p->m__1__el__Re / p->m__1__el__k / p->m__1__el__k
            - REAL(1.0)) / REAL(50.0);

    /* r1_w5: factor of m[1].motor'' */
    c->r1_w5_w2_m__1__motor = p->m__1__el__k * w
            * (p->m__1__Je * p->m__1__el__Re / p->m__1__el__k / p->m__1__el__k
            + p->m__1__fe * p->m__1__el__L / p->m__1__el__k / p->m__1__el__k) / REAL(50.0);

    /* r1_w5: factor of m[1].motor''' */
    c->r1_w5_w3_m__1__motor = product_6 / REAL(50.0);

    /* r1_w5: factor of m[1].wheel' */
    c->r1_w5_w1_m__1__wheel = product_2 / REAL(50.0);

    /* r1_w5: factor of m[1].wheel'' */
    c->r1_w5_w2_m__1__wheel = p->m__1__el__k * w
            * (p->m__1__Js * p->m__1__el__Re / p->m__1__el__k / p->m__1__el__k / p->m__1__ge__N
            + p->m__1__fs * p->m__1__el__L / p->m__1__el__k / p->m__1__el__k / p->m__1__ge__N)
            / REAL(50.0);

    /* r1_w5: factor of Fx[1] */
    c->r1_w5_Fx__1 = product / REAL(50.0);

    /* r1_w5: factor of Fx[1]' */
    c->r1_w5_w1_Fx__1 = product_7 / REAL(50.0);
}

/* r1_w8 to r1_w11: coefficients */
static void bound_compute_r1_w8_to_r1_w11(khepera_encoders_threshold_coefficients *c,
        real product_2, real product_8, real product_13, real product_14)
{
    /* khepera.bg:17: r1_w8: factor of m[1].wheel'' */
    c->r1_w8_w2_m__1__wheel = REAL(453.0) * product_13 / REAL(431200.0);

    /* r1_w9: factor of m[1].wheel'' */
    c->r1_w9_w2_m__1__wheel = REAL(453.0) * product_13 / REAL(1078000.0);

    /* r1_w9: factor of m[1].wheel''' */
    c->r1_w9_w3_m__1__wheel = REAL(453.0) * product_8 / REAL(1078000.0);

    /* r1_w10: factor of m[1].wheel' */
    c->r1_w10_w1_m__1__wheel = REAL(453.0) * product_2 / REAL(86240.0);

    /* r1_w11: factor of m[1].wheel' */
    c->r1_w11_w1_m__1__wheel = REAL(453.0) * product_2 / REAL(215600.0);

    /* r1_w11: factor of m[1].wheel'' */
    c->r1_w11_w2_m__1__wheel = REAL(453.0) * product_14 / REAL(215600.0);
}

/* r1_w12: coefficients */
static void bound_compute_r1_w12(khepera_encoders_threshold_coefficients *c,
        real fe_times_Re_over_k, real product, real product_2, real product_15)
{
    /* khepera.bg:17: r1_w12: factor of m[1].motor' */
    c->r1_w12_w1_m__1__motor = REAL(453.0) * fe_times_Re_over_k / REAL(431200.0);

    /* r1_w12: factor of m[1].motor'' */
    c->r1_w12_w2_m__1__motor = REAL(453.0) * product_15 / REAL(431200.0);

    /* r1_w12: factor of m[1].wheel' */
    c->r1_w12_w1_m__1__wheel = REAL(453.0) * product_2 / REAL(431200.0);

    /* r1_w12: factor of Fx[1] */
    c->r1_w12_Fx__1 = REAL(453.0) * product / REAL(431200.0);
}

/* r1_w13: coefficients */
static void bound_compute_r1_w13(khepera_encoders_threshold_coefficients *c,
        const khepera_encoders_parameters *p, real w, real fe_times_Re_over_k, real product,
        real product_2, real product_6, real product_7)
{
    /* khepera.bg:17: r1_w13: factor of m[1].motor' */
    c->r1_w13_w1_m__1__motor = REAL(453.0) * fe_times_Re_over_k / REAL(1078000.0);

    /* r1_w13: factor of m[1].motor'' */
    c->r1_w13_w2_m__1__motor = REAL(453.0) * p->m__1__el__k * p->m__1__el__k * w
            * (-REAL(2.0) * p->m__1__fe * p->m__1__el__L / p->m__1__el__k / p->m__1__el__k
                / p->m__1__el__k
            - REAL(2.0) * p->m__1__Je * p->m__1__el__Re / p->m__1__el__k / p->m__1__el__k
                / p->m__1__el__k)
            / REAL(2156000.0);

    /* r1_w13: factor of m[1].motor''' */
    c->r1_w13_w3_m__1__motor = REAL(453.0) * product_6 / REAL(1078000.0);

    /* r1_w13: factor of m[1].wheel' */
    c->r1_w13_w1_m__1__wheel = REAL(453.0) * product_2 / REAL(1078000.0);

    /* r1_w13: factor of m[1].wheel'' */
    c->r1_w13_w2_m__1__wheel = REAL(453.0) * p->m__1__el__k * p->m__1__el__k * w
            * (-REAL(2.0) * p->m__1__fs * p->m__1__el__L / p->m__1__el__k / p->m__1__el__k
                / p->m__1__el__k / p->m__1__ge__N
            - REAL(2.0) * p->m__1__Js * p->m__1__el__Re / p->m__1__el__k / p->m__1__el__k
                / p->m__1__el__k / p->m__1__ge__N)
            / REAL(2156000.0);

    /* r1_w13: factor of Fx[1] */
    c->r1_w13_Fx__1 = REAL(453.0) * product / REAL(1078000.0);

    /* r1_w13: factor of Fx[1]' */
    c->r1_w13_w1_Fx__1 = REAL(453.0) * product_7 / REAL(1078000.0);
}

/* r1: coefficients */
static void bound_compute_r1_2(khepera_encoders_threshold_coefficients *c,
        const khepera_encoders_parameters *p, real w)
{
    /* khepera.bg:17: m[1].fe*m[1].el.Re/m[1].el.k */
    const real fe_times_Re_over_k = p->m__1__fe * p->m__1__el__Re / p->m__1__el__k;

    /* m[1].R*m[1].el.Re/(m[1].el.k*m[1].ge.N) */
    const real product = p->m__1__R * p->m__1__el__Re / p->m__1__el__k / p->m__1__ge__N;

    /* m[1].fs*m[1].el.Re/(m[1].el.k*m[1].ge.N) */
    const real product_2 = p->m__1__fs * p->m__1__el__Re / p->m__1__el__k / p->m__1__ge__N;

    /* m[1].Je*m[1].el.L*w^2/m[1].el.k */
    const real product_6 = p->m__1__Je * p->m__1__el__L * w * w / p->m__1__el__k;

    /* m[1].R*m[1].el.L*w/(m[1].el.k*m[1].ge.N) */
    const real product_7 = p->m__1__R * p->m__1__el__L * w / p->m__1__el__k / p->m__1__ge__N;

    /* m[1].Js*m[1].el.L*w^2/(m[1].el.k*m[1].ge.N) */
    const real product_8 = p->m__1__Js * p->m__1__el__L * w * w / p->m__1__el__k / p->m__1__ge__N;

    /* m[1].fe*m[1].el.L*w/m[1].el.k */
    const real product_12 = p->m__1__fe * p->m__1__el__L * w / p->m__1__el__k;

    /* m[1].Js*m[1].el.Re*w/(m[1].el.k*m[1].ge.N) */
    const real product_13 = p->m__1__Js * p->m__1__el__Re * w / p->m__1__el__k / p->m__1__ge__N;

    /* m[1].fs*m[1].el.L*w/(m[1].el.k*m[1].ge.N) */
    const real product_14 = p->m__1__fs * p->m__1__el__L * w / p->m__1__el__k / p->m__1__ge__N;

    /* m[1].Je*m[1].el.Re*w/m[1].el.k */
    const real product_15 = p->m__1__Je * p->m__1__el__Re * w / p->m__1__el__k;

    /* r1_w1: factor of m[1].motor' */
    c->r1_w1_w1_m__1__motor = fe_times_Re_over_k / REAL(10.0);

    /* r1_w1: factor of m[1].motor'' */
    c->r1_w1_w2_m__1__motor = product_12 / REAL(10.0);

    bound_compute_r1_w2_to_r1_w3(c, product_2, product_8, product_13, product_14);
    bound_compute_r1_w4(c, fe_times_Re_over_k, product, product_2, product_13, product_15);
    bound_compute_r1_w5(c, p, w, product, product_2, product_6, product_7);

    /* khepera.bg:17: r1_w6: factor of m[1].motor' */
    c->r1_w6_w1_m__1__motor = REAL(453.0) * fe_times_Re_over_k / REAL(86240.0);

    /* r1_w7: factor of m[1].motor' */
    c->r1_w7_w1_m__1__motor = REAL(453.0) * fe_times_Re_over_k / REAL(215600.0);

    /* r1_w7: factor of m[1].motor'' */
    c->r1_w7_w2_m__1__motor = REAL(453.0) * product_12 / REAL(215600.0);

    bound_compute_r1_w8_to_r1_w11(c, product_2, product_8, product_13, product_14);
    bound_compute_r1_w12(c, fe_times_Re_over_k, product, product_2, product_15);
    bound_compute_r1_w13(c, p, w, fe_times_Re_over_k, product, product_2, product_6, product_7);
}

/* r1: coefficients */
static void bound_compute_r1(khepera_encoders_threshold_coefficients *c,
        const khepera_encoders_parameters *p, real w)
{
    /* khepera_encoders.bg:31: m[1].wheel.int.x0 */
    c->m__1__wheel__int__x0 = REAL(0.0);

    /* m[1].motor.int.x0 */
    c->m__1__motor__int__x0 = REAL(0.0);

    /* 1/(4*m[1].tau0) */
    c->scaled_one_over_tau0 = REAL(0.25) / p->m__1__tau0;

    /* m[1].ge.N/(4*m[1].tau0) */
    c->scaled_N_over_tau0 = REAL(0.25) * p->m__1__ge__N / p->m__1__tau0;

    /* 1/(4*m[1].tau0^2) */
    c->scaled_one_over_tau0_2 = REAL(0.25) / p->m__1__tau0 / p->m__1__tau0;

    /* m[1].ge.N/(4*m[1].tau0^2) */
    c->scaled_N_over_tau0_2 = REAL(0.25) * p->m__1__ge__N / p->m__1__tau0 / p->m__1__tau0;

    /* 1/(2*m[1].tau0^3) */
    c->scaled_one_over_tau0_3 = REAL(0.5) / p->m__1__tau0 / p->m__1__tau0 / p->m__1__tau0;

    /* m[1].ge.N/(2*m[1].tau0^3) */
    c->scaled_N_over_tau0_3 = REAL(0.5) * p->m__1__ge__N / p->m__1__tau0 / p->m__1__tau0
            / p->m__1__tau0;

    /* m[2].wheel.int.x0 */
    c->m__2__wheel__int__x0 = REAL(0.0);

    /* m[2].motor.int.x0 */
    c->m__2__motor__int__x0 = REAL(0.0);

    /* 1/(4*m[2].tau0) */
    c->scaled_one_over_tau0_4 = REAL(0.25) / p->m__2__tau0;

    /* m[2].ge.N/(4*m[2].tau0) */
    c->scaled_N_over_tau0_4 = REAL(0.25) * p->m__2__ge__N / p->m__2__tau0;

    /* 1/(4*m[2].tau0^2) */
    c->scaled_one_over_tau0_5 = REAL(0.25) / p->m__2__tau0 / p->m__2__tau0;

    /* m[2].ge.N/(4*m[2].tau0^2) */
    c->scaled_N_over_tau0_5 = REAL(0.25) * p->m__2__ge__N / p->m__2__tau0 / p->m__2__tau0;

    /* 1/(2*m[2].tau0^3) */
    c->scaled_one_over_tau0_6 = REAL(0.5) / p->m__2__tau0 / p->m__2__tau0 / p->m__2__tau0;

    /* m[2].ge.N/(2*m[2].tau0^3) */
    c->scaled_N_over_tau0_6 = REAL(0.5) * p->m__2__ge__N / p->m__2__tau0 / p->m__2__tau0
            / p->m__2__tau0;

    bound_compute_r1_2(c, p, w);
}

/* filter: coefficients */
static void bound_compute_filter(khepera_encoders_threshold_coefficients *c, real pole, real turn,
        real sum)
{
    /* turn^2 */
    const real turn_2 = turn * turn;

    /* filter: what is left of a memory a sample later */
    c->a = pole;

    /* filter: weight of a sample, new and a sample later */
    c->b = REAL(0.5) * sum;

    /* filter: 1 * (w*sample_time)^2/12 */
    c->bend1 = turn_2 / REAL(12.0);

    /* filter: 2 * (w*sample_time)^2/12 */
    c->bend2 = turn_2 / REAL(6.0);

    /* filter: 3 * (w*sample_time)^2/12 */
    c->bend3 = REAL(0.25) * turn_2;
}

/* r2: coefficients */
static void bound_compute_r2(khepera_encoders_threshold_coefficients *c,
        const khepera_encoders_parameters *p, real w)
{
    /* khepera_encoders.bg:31: m[1].K*m[1].tau0*m[1].A */
    const real K_times_tau0_times_A = p->m__1__K * p->m__1__tau0 * p->m__1__A;

    /* m[1].K*m[1].tau0^2*m[1].A */
    const real K_times_tau0_times_A_3 = p->m__1__K * p->m__1__tau0 * p->m__1__tau0 * p->m__1__A;

    /* r2_w1: factor of Int(D(m[1].motor)) */
    c->r2_w1_integral = p->m__1__K / REAL(20.0);

    /* r2_w1: factor of Int(D(m[1].wheel)) */
    c->r2_w1_integral_2 = p->m__1__K * p->m__1__ge__N / REAL(20.0);

    /* r2_w1: factor of tanh(Int(D(m[1].motor))/(4*m[1].tau0) -
     * m[1].ge.N*Int(D(m[1].wheel))/(4*m[1].tau0)) */
    c->r2_w1_tanh = K_times_tau0_times_A / REAL(20.0);

    /* r2_w2: factor of (m[1].ge.N*Int(D(m[1].wheel))/(4*m[1].tau0^2) -
     * Int(D(m[1].motor))/(4*m[1].tau0^2))*(1 - tanh(Int(D(m[1].motor))/(4*m[1].tau0) -
     * m[1].ge.N*Int(D(m[1].wheel))/(4*m[1].tau0))^2) */
    c->r2_w2_product = K_times_tau0_times_A_3 / REAL(20.0);

    /* r2_w3: factor of m[1].wheel'' */
    c->r2_w3_w2_m__1__wheel = p->m__1__Js * w / REAL(50.0) / p->m__1__ge__N;

    /* r2_w4: factor of m[1].wheel' */
    c->r2_w4_w1_m__1__wheel = p->m__1__fs / REAL(10.0) / p->m__1__ge__N;

    /* r2_w5: factor of tanh(Int(D(m[1].motor))/(4*m[1].tau0) -
     * m[1].ge.N*Int(D(m[1].wheel))/(4*m[1].tau0)) */
    c->r2_w5_tanh = K_times_tau0_times_A / REAL(380.0);

    /* r2_w5: factor of (m[1].ge.N*Int(D(m[1].wheel))/(4*m[1].tau0^2) -
     * Int(D(m[1].motor))/(4*m[1].tau0^2))*(1 - tanh(Int(D(m[1].motor))/(4*m[1].tau0) -
     * m[1].ge.N*Int(D(m[1].wheel))/(4*m[1].tau0))^2) */
    c->r2_w5_product = K_times_tau0_times_A_3 / REAL(380.0);

    /* m[1].K*m[1].tau0^3*m[1].A */
    const real K_times_tau0_times_A_4 = p->m__1__K * p->m__1__tau0 * p->m__1__tau0 * p->m__1__tau0
            * p->m__1__A;

    /* r2_w6: factor of (1 - tanh(Int(D(m[1].motor))/(4*m[1].tau0) -
     * m[1].ge.N*Int(D(m[1].wheel))/(4*m[1].tau0))^2)*(Int(D(m[1].motor))/(2*m[1].tau0^3) -
     * m[1].ge.N*Int(D(m[1].wheel))/(2*m[1].tau0^3)) */
    c->r2_w6_product = K_times_tau0_times_A_4 / REAL(760.0);

    /* r2_w6: factor of a product */
    c->r2_w6_product_2 = K_times_tau0_times_A_4 / REAL(380.0);
}

/* r3_w2 to r3_w3: coefficients */
static void bound_compute_r3_w2_to_r3_w3(khepera_encoders_threshold_coefficients *c, real product_4,
        real product_11, real product_17, real product_18)
{
    /* khepera.bg:17: r3_w2: factor of m[2].wheel'' */
    c->r3_w2_w2_m__2__wheel = product_17 / REAL(50.0);

    /* r3_w2: factor of m[2].wheel''' */
    c->r3_w2_w3_m__2__wheel = product_11 / REAL(50.0);

    /* r3_w3: factor of m[2].wheel' */
    c->r3_w3_w1_m__2__wheel = product_4 / REAL(10.0);

    /* r3_w3: factor of m[2].wheel'' */
    c->r3_w3_w2_m__2__wheel = product_18 / REAL(10.0);
}

/* r3_w4: coefficients */
static void bound_compute_r3_w4(khepera_encoders_threshold_coefficients *c,
        real fe_times_Re_over_k_2, real product_3, real product_4, real product_17, real product_19)
{
    /* khepera.bg:17: r3_w4: factor of m[2].wheel' */
    c->r3_w4_w1_m__2__wheel = product_4 / REAL(20.0);

    /* r3_w4: factor of m[2].wheel'' */
    c->r3_w4_w2_m__2__wheel = product_17 / REAL(20.0);

    /* r3_w4: factor of Fx[2] */
    c->r3_w4_Fx__2 = product_3 / REAL(20.0);

    /* r3_w4: factor of m[2].motor' */
    c->r3_w4_w1_m__2__motor = fe_times_Re_over_k_2 / REAL(20.0);

    /* r3_w4: factor of m[2].motor'' */
    c->r3_w4_w2_m__2__motor = product_19 / REAL(20.0);
}

/* r3_w5: coefficients */
static void bound_compute_r3_w5(khepera_encoders_threshold_coefficients *c,
        const khepera_encoders_parameters *p, real w, real product_3, real product_4,
        real product_9, real product_10)
{
    /* khepera.bg:17: r3_w5: factor of m[2].motor' */
    c->r3_w5_w1_m__2__motor = p->m__2__el__k
            * (p->m__2__fe * p->m__2__el__Re / p->m__2__el__k / p->m__2__el__k
            - REAL(1.0)) / REAL(50.0);

    /* r3_w5: factor of m[2].motor'' */
    c->r3_w5_w2_m__2__motor = p->m__2__el__k * w
            * (p->m__2__Je * p->m__2__el__Re / p->m__2__el__k / p->m__2__el__k
            + p->m__2__fe * p->m__2__el__L / p->m__2__el__k / p->m__2__el__k) / REAL(50.0);

    /* r3_w5: factor of m[2].motor''' */
    c->r3_w5_w3_m__2__motor = product_9 / REAL(50.0);

    /* r3_w5: factor of m[2].wheel' */
    c->r3_w5_w1_m__2__wheel = product_4 / REAL(50.0);

    /* r3_w5: factor of m[2].wheel'' */
    c->r3_w5_w2_m__2__wheel = p->m__2__el__k * w
            * (p->m__2__Js * p->m__2__el__Re / p->m__2__el__k / p->m__2__el__k / p->m__2__ge__N
            + p->m__2__fs * p->m__2__el__L / p->m__2__el__k / p->m__2__el__k / p->m__2__ge__N)
            / REAL(50.0);

    /* r3_w5: factor of Fx[2] */
    c->r3_w5_Fx__2 = product_3 / REAL(50.0);

    /* r3_w5: factor of Fx[2]' */
    c->r3_w5_w1_Fx__2 = product_10 / REAL(50.0);
}

/* r3_w8 to r3_w11: coefficients */
static void bound_compute_r3_w8_to_r3_w11(khepera_encoders_threshold_coefficients *c,
        real product_4, real product_11, real product_17, real product_18)
{
    /* khepera.bg:17: r3_w8: factor of m[2].wheel'' */
    c->r3_w8_w2_m__2__wheel = REAL(453.0) * product_17 / REAL(431200.0);

    /* r3_w9: factor of m[2].wheel'' */
    c->r3_w9_w2_m__2__wheel = REAL(453.0) * product_17 / REAL(1078000.0);

    /* r3_w9: factor of m[2].wheel''' */
    c->r3_w9_w3_m__2__wheel = REAL(453.0) * product_11 / REAL(1078000.0);

    /* r3_w10: factor of m[2].wheel' */
    c->r3_w10_w1_m__2__wheel = REAL(453.0) * product_4 / REAL(86240.0);

    /* r3_w11: factor of m[2].wheel' */
    c->r3_w11_w1_m__2__wheel = REAL(453.0) * product_4 / REAL(215600.0);

    /* r3_w11: factor of m[2].wheel'' */
    c->r3_w11_w2_m__2__wheel = REAL(453.0) * product_18 / REAL(215600.0);
}

/* r3_w12: coefficients */
static void bound_compute_r3_w12(khepera_encoders_threshold_coefficients *c,
        real fe_times_Re_over_k_2, real product_3, real product_4, real product_19)
{
    /* khepera.bg:17: r3_w12: factor of m[2].motor' */
    c->r3_w12_w1_m__2__motor = REAL(453.0) * fe_times_Re_over_k_2 / REAL(431200.0);

    /* r3_w12: factor of m[2].motor'' */
    c->r3_w12_w2_m__2__motor = REAL(453.0) * product_19 / REAL(431200.0);

    /* r3_w12: factor of m[2].wheel' */
    c->r3_w12_w1_m__2__wheel = REAL(453.0) * product_4 / REAL(431200.0);

    /* r3_w12: factor of Fx[2] */
    c->r3_w12_Fx__2 = REAL(453.0) * product_3 / REAL(431200.0);
}

/* r3_w13: coefficients */
static void bound_compute_r3_w13(khepera_encoders_threshold_coefficients *c,
        const khepera_encoders_parameters *p, real w, real fe_times_Re_over_k_2, real product_3,
        real product_4, real product_9, real product_10)
{
    /* khepera.bg:17: r3_w13: factor of m[2].motor' */
    c->r3_w13_w1_m__2__motor = REAL(453.0) * fe_times_Re_over_k_2 / REAL(1078000.0);

    /* r3_w13: factor of m[2].motor'' */
    c->r3_w13_w2_m__2__motor = REAL(453.0) * p->m__2__el__k * p->m__2__el__k * w
            * (-REAL(2.0) * p->m__2__fe * p->m__2__el__L / p->m__2__el__k / p->m__2__el__k
                / p->m__2__el__k
            - REAL(2.0) * p->m__2__Je * p->m__2__el__Re / p->m__2__el__k / p->m__2__el__k
                / p->m__2__el__k)
            / REAL(2156000.0);

    /* r3_w13: factor of m[2].motor''' */
    c->r3_w13_w3_m__2__motor = REAL(453.0) * product_9 / REAL(1078000.0);

    /* r3_w13: factor of m[2].wheel' */
    c->r3_w13_w1_m__2__wheel = REAL(453.0) * product_4 / REAL(1078000.0);

    /* r3_w13: factor of m[2].wheel'' */
    c->r3_w13_w2_m__2__wheel = REAL(453.0) * p->m__2__el__k * p->m__2__el__k * w
            * (-REAL(2.0) * p->m__2__fs * p->m__2__el__L / p->m__2__el__k / p->m__2__el__k
                / p->m__2__el__k / p->m__2__ge__N
            - REAL(2.0) * p->m__2__Js * p->m__2__el__Re / p->m__2__el__k / p->m__2__el__k
                / p->m__2__el__k / p->m__2__ge__N)
            / REAL(2156000.0);

    /* r3_w13: factor of Fx[2] */
    c->r3_w13_Fx__2 = REAL(453.0) * product_3 / REAL(1078000.0);

    /* r3_w13: factor of Fx[2]' */
    c->r3_w13_w1_Fx__2 = REAL(453.0) * product_10 / REAL(1078000.0);
}

/* r3: coefficients */
static void bound_compute_r3(khepera_encoders_threshold_coefficients *c,
        const khepera_encoders_parameters *p, real w)
{
    /* khepera.bg:17: m[2].fe*m[2].el.Re/m[2].el.k */
    const real fe_times_Re_over_k_2 = p->m__2__fe * p->m__2__el__Re / p->m__2__el__k;

    /* m[2].R*m[2].el.Re/(m[2].el.k*m[2].ge.N) */
    const real product_3 = p->m__2__R * p->m__2__el__Re / p->m__2__el__k / p->m__2__ge__N;

    /* m[2].fs*m[2].el.Re/(m[2].el.k*m[2].ge.N) */
    const real product_4 = p->m__2__fs * p->m__2__el__Re / p->m__2__el__k / p->m__2__ge__N;

    /* m[2].Je*m[2].el.L*w^2/m[2].el.k */
    const real product_9 = p->m__2__Je * p->m__2__el__L * w * w / p->m__2__el__k;

    /* m[2].R*m[2].el.L*w/(m[2].el.k*m[2].ge.N) */
    const real product_10 = p->m__2__R * p->m__2__el__L * w / p->m__2__el__k / p->m__2__ge__N;

    /* m[2].Js*m[2].el.L*w^2/(m[2].el.k*m[2].ge.N) */
    const real product_11 = p->m__2__Js * p->m__2__el__L * w * w / p->m__2__el__k / p->m__2__ge__N;

    /* m[2].fe*m[2].el.L*w/m[2].el.k */
    const real product_16 = p->m__2__fe * p->m__2__el__L * w / p->m__2__el__k;

    /* m[2].Js*m[2].el.Re*w/(m[2].el.k*m[2].ge.N) */
    const real product_17 = p->m__2__Js * p->m__2__el__Re * w / p->m__2__el__k / p->m__2__ge__N;

    /* m[2].fs*m[2].el.L*w/(m[2].el.k*m[2].ge.N) */
    const real product_18 = p->m__2__fs * p->m__2__el__L * w / p->m__2__el__k / p->m__2__ge__N;

    /* m[2].Je*m[2].el.Re*w/m[2].el.k */
    const real product_19 = p->m__2__Je * p->m__2__el__Re * w / p->m__2__el__k;

    /* r3_w1: factor of m[2].motor' */
    c->r3_w1_w1_m__2__motor = fe_times_Re_over_k_2 / REAL(10.0);

    /* r3_w1: factor of m[2].motor'' */
    c->r3_w1_w2_m__2__motor = product_16 / REAL(10.0);

    bound_compute_r3_w2_to_r3_w3(c, product_4, product_11, product_17, product_18);
    bound_compute_r3_w4(c, fe_times_Re_over_k_2, product_3, product_4, product_17, product_19);
    bound_compute_r3_w5(c, p, w, product_3, product_4, product_9, product_10);

    /* khepera.bg:17: r3_w6: factor of m[2].motor' */
    c->r3_w6_w1_m__2__motor = REAL(453.0) * fe_times_Re_over_k_2 / REAL(86240.0);

    /* r3_w7: factor of m[2].motor' */
    c->r3_w7_w1_m__2__motor = REAL(453.0) * fe_times_Re_over_k_2 / REAL(215600.0);

    /* r3_w7: factor of m[2].motor'' */
    c->r3_w7_w2_m__2__motor = REAL(453.0) * product_16 / REAL(215600.0);

    bound_compute_r3_w8_to_r3_w11(c, product_4, product_11, product_17, product_18);
    bound_compute_r3_w12(c, fe_times_Re_over_k_2, product_3, product_4, product_19);
    bound_compute_r3_w13(c, p, w, fe_times_Re_over_k_2, product_3, product_4, product_9,
            product_10);
}

/* r4: coefficients */
static void bound_compute_r4(khepera_encoders_threshold_coefficients *c,
        const khepera_encoders_parameters *p, real w)
{
    /* khepera_encoders.bg:31: m[2].K*m[2].tau0*m[2].A */
    const real K_times_tau0_times_A_2 = p->m__2__K * p->m__2__tau0 * p->m__2__A;

    /* m[2].K*m[2].tau0^2*m[2].A */
    const real K_times_tau0_times_A_5 = p->m__2__K * p->m__2__tau0 * p->m__2__tau0 * p->m__2__A;

    /* r4_w1: factor of Int(D(m[2].motor)) */
    c->r4_w1_integral = p->m__2__K / REAL(20.0);

    /* r4_w1: factor of Int(D(m[2].wheel)) */
    c->r4_w1_integral_2 = p->m__2__K * p->m__2__ge__N / REAL(20.0);

    /* r4_w1: factor of tanh(Int(D(m[2].motor))/(4*m[2].tau0) -
     * m[2].ge.N*Int(D(m[2].wheel))/(4*m[2].tau0)) */
    c->r4_w1_tanh = K_times_tau0_times_A_2 / REAL(20.0);

    /* r4_w2: factor of (m[2].ge.N*Int(D(m[2].wheel))/(4*m[2].tau0^2) -
     * Int(D(m[2].motor))/(4*m[2].tau0^2))*(1 - tanh(Int(D(m[2].motor))/(4*m[2].tau0) -
     * m[2].ge.N*Int(D(m[2].wheel))/(4*m[2].tau0))^2) */
    c->r4_w2_product = K_times_tau0_times_A_5 / REAL(20.0);

    /* r4_w3: factor of m[2].wheel'' */
    c->r4_w3_w2_m__2__wheel = p->m__2__Js * w / REAL(50.0) / p->m__2__ge__N;

    /* r4_w4: factor of m[2].wheel' */
    c->r4_w4_w1_m__2__wheel = p->m__2__fs / REAL(10.0) / p->m__2__ge__N;

    /* r4_w5: factor of tanh(Int(D(m[2].motor))/(4*m[2].tau0) -
     * m[2].ge.N*Int(D(m[2].wheel))/(4*m[2].tau0)) */
    c->r4_w5_tanh = K_times_tau0_times_A_2 / REAL(380.0);

    /* r4_w5: factor of (m[2].ge.N*Int(D(m[2].wheel))/(4*m[2].tau0^2) -
     * Int(D(m[2].motor))/(4*m[2].tau0^2))*(1 - tanh(Int(D(m[2].motor))/(4*m[2].tau0) -
     * m[2].ge.N*Int(D(m[2].wheel))/(4*m[2].tau0))^2) */
    c->r4_w5_product = K_times_tau0_times_A_5 / REAL(380.0);

    /* m[2].K*m[2].tau0^3*m[2].A */
    const real K_times_tau0_times_A_6 = p->m__2__K * p->m__2__tau0 * p->m__2__tau0 * p->m__2__tau0
            * p->m__2__A;

    /* r4_w6: factor of (1 - tanh(Int(D(m[2].motor))/(4*m[2].tau0) -
     * m[2].ge.N*Int(D(m[2].wheel))/(4*m[2].tau0))^2)*(Int(D(m[2].motor))/(2*m[2].tau0^3) -
     * m[2].ge.N*Int(D(m[2].wheel))/(2*m[2].tau0^3)) */
    c->r4_w6_product = K_times_tau0_times_A_6 / REAL(760.0);

    /* r4_w6: factor of a product */
    c->r4_w6_product_2 = K_times_tau0_times_A_6 / REAL(380.0);
}

/* r5: coefficients */
static void bound_compute_r5(khepera_encoders_threshold_coefficients *c,
        const khepera_encoders_parameters *p, real w)
{
    /* khepera.bg:114: R_L^2*w */
    const real R_L_times_w = p->R_L * p->R_L * w;

    /* r5_w1: factor of load */
    c->r5_w1_load = p->R_L / REAL(10.0);

    /* r5_w1: factor of load' */
    c->r5_w1_w1_load = REAL(11.0) * R_L_times_w / REAL(1000000000000.0);

    /* r5_w2: factor of load' */
    c->r5_w2_w1_load = REAL(11.0) * R_L_times_w / REAL(20000000000000.0);
}

/* The coefficients, from the parameters. */
static void bound_compute_coefficients(khepera_encoders_threshold_coefficients *c,
        const khepera_encoders_parameters *p, real sample_time, real bandwidth)
{
    /* bandwidth*sample_time */
    const real x_ = bandwidth * sample_time;

    /* of a stage: what is left of its memory */
    const real pole = greatest(REAL(2.0) - x_, REAL(0.0)) / (x_ + REAL(2.0));

    /* w*sample_time, x or 2 */
    const real turn = REAL(2.0) * (REAL(1.0) - pole) / (pole + REAL(1.0));

    /* w of the filter 1/(1 + D/w) */
    const real w = turn / sample_time;

    /* 1 - pole */
    const real sum = REAL(1.0) - pole;

    /* (1 - (1 - pole)/2)*w */
    const real product_5 = (REAL(1.0) - REAL(0.5) * sum) * w;

    /* speed of m[1].motor for one count */
    c->m__1__motor_gain = REAL(0.0015339807878856412) * product_5;

    /* speed of m[1].wheel for one count */
    c->m__1__wheel_gain = REAL(9.587379924285257e-05) * product_5;

    bound_compute_r1(c, p, w);
    bound_compute_filter(c, pole, turn, sum);
    bound_compute_r2(c, p, w);
    bound_compute_r3(c, p, w);
    bound_compute_r4(c, p, w);
    bound_compute_r5(c, p, w);
}

static bool bound_coefficients_are_finite(const khepera_encoders_threshold_coefficients *c)
{
    return finite_number(c->r1_w1_w1_m__1__motor + c->m__1__motor_gain + c->a + c->b
            + c->r1_w1_w2_m__1__motor + c->bend1 + c->r1_w2_w2_m__1__wheel + c->m__1__wheel_gain
            + c->r1_w2_w3_m__1__wheel + c->r1_w3_w1_m__1__wheel + c->r1_w3_w2_m__1__wheel
            + c->r1_w4_w1_m__1__wheel + c->r1_w4_w2_m__1__wheel + c->r1_w4_Fx__1
            + c->r1_w4_w1_m__1__motor + c->r1_w4_w2_m__1__motor + c->bend2 + c->r1_w5_w1_m__1__motor
            + c->r1_w5_w2_m__1__motor + c->r1_w5_w3_m__1__motor + c->r1_w5_w1_m__1__wheel
            + c->r1_w5_w2_m__1__wheel + c->r1_w5_Fx__1 + c->r1_w5_w1_Fx__1 + c->bend3
            + c->r1_w6_w1_m__1__motor + c->r1_w7_w1_m__1__motor + c->r1_w7_w2_m__1__motor
            + c->r1_w8_w2_m__1__wheel + c->r1_w9_w2_m__1__wheel + c->r1_w9_w3_m__1__wheel
            + c->r1_w10_w1_m__1__wheel + c->r1_w11_w1_m__1__wheel + c->r1_w11_w2_m__1__wheel
            + c->r1_w12_w1_m__1__motor + c->r1_w12_w2_m__1__motor + c->r1_w12_w1_m__1__wheel
            + c->r1_w12_Fx__1 + c->r1_w13_w1_m__1__motor + c->r1_w13_w2_m__1__motor
            + c->r1_w13_w3_m__1__motor + c->r1_w13_w1_m__1__wheel + c->r1_w13_w2_m__1__wheel
            + c->r1_w13_Fx__1 + c->r1_w13_w1_Fx__1 + c->m__1__wheel__int__x0
            + c->m__1__motor__int__x0 + c->scaled_one_over_tau0 + c->scaled_N_over_tau0
            + c->r2_w1_integral + c->r2_w1_integral_2 + c->r2_w1_tanh + c->scaled_one_over_tau0_2
            + c->scaled_N_over_tau0_2 + c->r2_w2_product + c->r2_w3_w2_m__1__wheel
            + c->r2_w4_w1_m__1__wheel + c->r2_w5_tanh + c->r2_w5_product + c->scaled_one_over_tau0_3
            + c->scaled_N_over_tau0_3 + c->r2_w6_product + c->r2_w6_product_2
            + c->r3_w1_w1_m__2__motor + c->r3_w1_w2_m__2__motor + c->r3_w2_w2_m__2__wheel
            + c->r3_w2_w3_m__2__wheel + c->r3_w3_w1_m__2__wheel + c->r3_w3_w2_m__2__wheel
            + c->r3_w4_w1_m__2__wheel + c->r3_w4_w2_m__2__wheel + c->r3_w4_Fx__2
            + c->r3_w4_w1_m__2__motor + c->r3_w4_w2_m__2__motor + c->r3_w5_w1_m__2__motor
            + c->r3_w5_w2_m__2__motor + c->r3_w5_w3_m__2__motor + c->r3_w5_w1_m__2__wheel
            + c->r3_w5_w2_m__2__wheel + c->r3_w5_Fx__2 + c->r3_w5_w1_Fx__2 + c->r3_w6_w1_m__2__motor
            + c->r3_w7_w1_m__2__motor + c->r3_w7_w2_m__2__motor + c->r3_w8_w2_m__2__wheel
            + c->r3_w9_w2_m__2__wheel + c->r3_w9_w3_m__2__wheel + c->r3_w10_w1_m__2__wheel
            + c->r3_w11_w1_m__2__wheel + c->r3_w11_w2_m__2__wheel + c->r3_w12_w1_m__2__motor
            + c->r3_w12_w2_m__2__motor + c->r3_w12_w1_m__2__wheel + c->r3_w12_Fx__2
            + c->r3_w13_w1_m__2__motor + c->r3_w13_w2_m__2__motor + c->r3_w13_w3_m__2__motor
            + c->r3_w13_w1_m__2__wheel + c->r3_w13_w2_m__2__wheel + c->r3_w13_Fx__2
            + c->r3_w13_w1_Fx__2 + c->m__2__wheel__int__x0 + c->m__2__motor__int__x0
            + c->scaled_one_over_tau0_4 + c->scaled_N_over_tau0_4 + c->r4_w1_integral
            + c->r4_w1_integral_2 + c->r4_w1_tanh + c->scaled_one_over_tau0_5
            + c->scaled_N_over_tau0_5 + c->r4_w2_product + c->r4_w3_w2_m__2__wheel
            + c->r4_w4_w1_m__2__wheel + c->r4_w5_tanh + c->r4_w5_product + c->scaled_one_over_tau0_6
            + c->scaled_N_over_tau0_6 + c->r4_w6_product + c->r4_w6_product_2 + c->r5_w1_load
            + c->r5_w1_w1_load + c->r5_w2_w1_load);
}

khepera_encoders_status khepera_encoders_threshold_configure(
    khepera_encoders_threshold_coefficients *coefficients,
    const khepera_encoders_parameters *parameters,
    khepera_encoders_real sample_time,
    khepera_encoders_real bandwidth)
{
    khepera_encoders_threshold_coefficients *c = coefficients;
    const khepera_encoders_status status = checked(parameters, sample_time, bandwidth);
    int k;

    for (k = 0; k < KHEPERA_ENCODERS_RESIDUALS; ++k) {
        c->settle[k] = UINT32_MAX;
    }
    c->longest = UINT32_MAX;
    if (status != KHEPERA_ENCODERS_OK) {
        return status;
    }
    bound_compute_coefficients(c, parameters, sample_time, bandwidth);
    if (!bound_coefficients_are_finite(c)) {
        return KHEPERA_ENCODERS_BAD_COEFFICIENT;
    }
    c->settle[KHEPERA_ENCODERS_R1] = samples(REAL(13.062240779188071), sample_time, bandwidth);
    c->settle[KHEPERA_ENCODERS_R2] = samples(REAL(11.228872242412663), sample_time, bandwidth);
    c->settle[KHEPERA_ENCODERS_R3] = samples(REAL(13.062240779188071), sample_time, bandwidth);
    c->settle[KHEPERA_ENCODERS_R4] = samples(REAL(11.228872242412663), sample_time, bandwidth);
    c->settle[KHEPERA_ENCODERS_R5] = samples(REAL(9.233413476451586), sample_time, bandwidth);
    c->longest = c->settle[KHEPERA_ENCODERS_R1];
    return KHEPERA_ENCODERS_OK;
}

/* a stage of the filter; on the first sample it is at rest; filtered speed of m[1].motor */
static void bound_r1_w1_a_to_w1_m__1__motor_speed_2(const khepera_encoders_threshold_coefficients
            *c,
        khepera_encoders_threshold_memory *x, bool first, real *w1_a_out, real *w1_b_out,
        real *w1_m__1__motor_speed_2_out)
{
    const khepera_encoders_threshold_encoders *e = &x->e;

    if (first) {
        /* nothing is remembered yet */
        x->r1_w1_m__1__motor_speed = REAL(0.0);
        x->r1_w1_s4 = REAL(0.0);
        x->r1_w1_s3 = REAL(0.0);
        x->r1_w1_s2 = REAL(0.0);
        x->r1_w1_s1 = REAL(0.0);
    }

    /* r1_w1: a stage of the filter; on the first sample it is at rest */
    const real w1_a = first ? -c->b : c->a;
    const real w1_b = first ? REAL(1.0) : c->b;

    /* filtered speed of m[1].motor */
    const real w1_m__1__motor_speed_2 = c->a * x->r1_w1_m__1__motor_speed
        + c->m__1__motor_gain * (real)e->m__1__motor_r1.increment;
    x->r1_w1_m__1__motor_speed = w1_m__1__motor_speed_2;

    *w1_a_out = w1_a;
    *w1_b_out = w1_b;
    *w1_m__1__motor_speed_2_out = w1_m__1__motor_speed_2;
}

/* what the tolerance of m[1].fe can do */
static real bound_r1_w1(const khepera_encoders_threshold_coefficients *c,
        khepera_encoders_threshold_memory *x, real w1_a, real w1_b, real w1_m__1__motor_speed_2)
{
    /* r1_w1: encoders, order 1 */
    const real w1_n1 = -c->r1_w1_w1_m__1__motor * w1_m__1__motor_speed_2;

    /* r1_w1: error of order 1 */
    const real w1_e1 = c->bend1 * w1_n1;

    /* r1_w1: encoders, order 2 */
    const real w1_n2 = -c->r1_w1_w2_m__1__motor * w1_m__1__motor_speed_2;

    /* r1_w1: degree 1 */
    const real w1_d1 = w1_n1 + w1_n2;

    /* r1_w1: degree 2 */
    const real w1_d2 = w1_n2 - w1_e1;

    /* r1_w1: the filter multiplied out */
    const real w1_p2_1 = w1_d2 + w1_e1;
    const real w1_p1_1 = w1_p2_1 + w1_e1;
    const real w1_p1_2 = w1_d1 - w1_p2_1;

    /* r1_w1: stage 4 */
    const real w1_u4 = w1_n1 - w1_p1_2;
    const real w1_y4 = x->r1_w1_s4 + w1_b * w1_u4;
    x->r1_w1_s4 = w1_a * w1_y4 + w1_b * w1_u4;

    /* r1_w1: stage 3 */
    const real w1_u3 = w1_y4 + w1_p1_2 - w1_p1_1;
    const real w1_y3 = x->r1_w1_s3 + w1_b * w1_u3;
    x->r1_w1_s3 = w1_a * w1_y3 + w1_b * w1_u3;

    /* r1_w1: stage 2 */
    const real w1_u2 = w1_y3 + w1_p1_1 + w1_e1;
    const real w1_y2 = x->r1_w1_s2 + w1_b * w1_u2;
    x->r1_w1_s2 = w1_a * w1_y2 + w1_b * w1_u2;

    /* r1_w1: stage 1 */
    const real w1_u1 = w1_y2 - w1_e1;
    const real w1_y1 = x->r1_w1_s1 + w1_b * w1_u1;
    x->r1_w1_s1 = w1_a * w1_y1 + w1_b * w1_u1;

    /* what the tolerance of m[1].fe can do */
    const real w1 = w1_y1;

    return w1;
}

/* filtered speed of m[1].wheel */
static real bound_r1_w2_m__1__wheel_speed_2(const khepera_encoders_threshold_coefficients *c,
        khepera_encoders_threshold_memory *x, bool first)
{
    const khepera_encoders_threshold_encoders *e = &x->e;

    if (first) {
        /* nothing is remembered yet */
        x->r1_w2_m__1__wheel_speed = REAL(0.0);
        x->r1_w2_s4 = REAL(0.0);
        x->r1_w2_s3 = REAL(0.0);
        x->r1_w2_s2 = REAL(0.0);
        x->r1_w2_s1 = REAL(0.0);
    }

    /* filtered speed of m[1].wheel */
    const real w2_m__1__wheel_speed_2 = c->a * x->r1_w2_m__1__wheel_speed
        + c->m__1__wheel_gain * (real)e->m__1__wheel_r1.increment;
    x->r1_w2_m__1__wheel_speed = w2_m__1__wheel_speed_2;

    return w2_m__1__wheel_speed_2;
}

/* what the tolerance of m[1].Js can do */
static real bound_r1_w2(const khepera_encoders_threshold_coefficients *c,
        khepera_encoders_threshold_memory *x, real w1_a, real w1_b, real w2_m__1__wheel_speed_2)
{
    /* r1_w2: encoders, order 2 */
    const real w2_n2 = -c->r1_w2_w2_m__1__wheel * w2_m__1__wheel_speed_2;

    /* r1_w2: error of order 2 */
    const real w2_e2 = c->bend1 * w2_n2;

    /* r1_w2: encoders, order 3 */
    const real w2_n3 = -c->r1_w2_w3_m__1__wheel * w2_m__1__wheel_speed_2;

    /* r1_w2: degree 2 */
    const real w2_d2 = w2_n2 + w2_n3;

    /* r1_w2: degree 3 */
    const real w2_d3 = w2_n3 - w2_e2;

    /* r1_w2: the filter multiplied out */
    const real w2_p3_1 = w2_d3 + w2_e2;
    const real w2_p2_1 = w2_p3_1 + w2_e2;
    const real w2_p2_2 = w2_d2 - w2_p3_1;
    const real w2_p1_1 = w2_p2_1 + w2_e2;
    const real w2_p1_2 = w2_p2_2 - w2_p2_1;
    const real w2_p1_3 = w2_n2 - w2_p2_2;

    /* r1_w2: stage 4 */
    const real w2_u4 = -w2_p1_3;
    const real w2_y4 = x->r1_w2_s4 + w1_b * w2_u4;
    x->r1_w2_s4 = w1_a * w2_y4 + w1_b * w2_u4;

    /* r1_w2: stage 3 */
    const real w2_u3 = w2_y4 + w2_p1_3 - w2_p1_2;
    const real w2_y3 = x->r1_w2_s3 + w1_b * w2_u3;
    x->r1_w2_s3 = w1_a * w2_y3 + w1_b * w2_u3;

    /* r1_w2: stage 2 */
    const real w2_u2 = w2_y3 + w2_p1_2 - w2_p1_1;
    const real w2_y2 = x->r1_w2_s2 + w1_b * w2_u2;
    x->r1_w2_s2 = w1_a * w2_y2 + w1_b * w2_u2;

    /* r1_w2: stage 1 */
    const real w2_u1 = w2_y2 + w2_p1_1 + w2_e2;
    const real w2_y1 = x->r1_w2_s1 + w1_b * w2_u1;
    x->r1_w2_s1 = w1_a * w2_y1 + w1_b * w2_u1;

    /* what the tolerance of m[1].Js can do */
    const real w2 = w2_y1 - w2_e2;

    return w2;
}

/* filtered speed of m[1].wheel */
static real bound_r1_w3_m__1__wheel_speed_2(const khepera_encoders_threshold_coefficients *c,
        khepera_encoders_threshold_memory *x, bool first)
{
    const khepera_encoders_threshold_encoders *e = &x->e;

    if (first) {
        /* nothing is remembered yet */
        x->r1_w3_m__1__wheel_speed = REAL(0.0);
        x->r1_w3_s4 = REAL(0.0);
        x->r1_w3_s3 = REAL(0.0);
        x->r1_w3_s2 = REAL(0.0);
        x->r1_w3_s1 = REAL(0.0);
    }

    /* filtered speed of m[1].wheel */
    const real w3_m__1__wheel_speed_2 = c->a * x->r1_w3_m__1__wheel_speed
        + c->m__1__wheel_gain * (real)e->m__1__wheel_r1.increment;
    x->r1_w3_m__1__wheel_speed = w3_m__1__wheel_speed_2;

    return w3_m__1__wheel_speed_2;
}

/* what the tolerance of m[1].fs can do */
static real bound_r1_w3(const khepera_encoders_threshold_coefficients *c,
        khepera_encoders_threshold_memory *x, real w1_a, real w1_b, real w3_m__1__wheel_speed_2)
{
    /* r1_w3: encoders, order 1 */
    const real w3_n1 = -c->r1_w3_w1_m__1__wheel * w3_m__1__wheel_speed_2;

    /* r1_w3: error of order 1 */
    const real w3_e1 = c->bend1 * w3_n1;

    /* r1_w3: encoders, order 2 */
    const real w3_n2 = -c->r1_w3_w2_m__1__wheel * w3_m__1__wheel_speed_2;

    /* r1_w3: degree 1 */
    const real w3_d1 = w3_n1 + w3_n2;

    /* r1_w3: degree 2 */
    const real w3_d2 = w3_n2 - w3_e1;

    /* r1_w3: the filter multiplied out */
    const real w3_p2_1 = w3_d2 + w3_e1;
    const real w3_p1_1 = w3_p2_1 + w3_e1;
    const real w3_p1_2 = w3_d1 - w3_p2_1;

    /* r1_w3: stage 4 */
    const real w3_u4 = w3_n1 - w3_p1_2;
    const real w3_y4 = x->r1_w3_s4 + w1_b * w3_u4;
    x->r1_w3_s4 = w1_a * w3_y4 + w1_b * w3_u4;

    /* r1_w3: stage 3 */
    const real w3_u3 = w3_y4 + w3_p1_2 - w3_p1_1;
    const real w3_y3 = x->r1_w3_s3 + w1_b * w3_u3;
    x->r1_w3_s3 = w1_a * w3_y3 + w1_b * w3_u3;

    /* r1_w3: stage 2 */
    const real w3_u2 = w3_y3 + w3_p1_1 + w3_e1;
    const real w3_y2 = x->r1_w3_s2 + w1_b * w3_u2;
    x->r1_w3_s2 = w1_a * w3_y2 + w1_b * w3_u2;

    /* r1_w3: stage 1 */
    const real w3_u1 = w3_y2 - w3_e1;
    const real w3_y1 = x->r1_w3_s1 + w1_b * w3_u1;
    x->r1_w3_s1 = w1_a * w3_y1 + w1_b * w3_u1;

    /* what the tolerance of m[1].fs can do */
    const real w3 = w3_y1;

    return w3;
}

/* filtered speed of m[1].wheel */
static real bound_r1_w4_m__1__wheel_speed_2(const khepera_encoders_threshold_coefficients *c,
        khepera_encoders_threshold_memory *x, bool first)
{
    const khepera_encoders_threshold_encoders *e = &x->e;

    if (first) {
        /* nothing is remembered yet */
        x->r1_w4_m__1__wheel_speed = REAL(0.0);
        x->r1_w4_m__1__motor_speed = REAL(0.0);
        x->r1_w4_s4 = REAL(0.0);
        x->r1_w4_s3 = REAL(0.0);
        x->r1_w4_s2 = REAL(0.0);
        x->r1_w4_s1 = REAL(0.0);
    }

    /* filtered speed of m[1].wheel */
    const real w4_m__1__wheel_speed_2 = c->a * x->r1_w4_m__1__wheel_speed
        + c->m__1__wheel_gain * (real)e->m__1__wheel_r1.increment;
    x->r1_w4_m__1__wheel_speed = w4_m__1__wheel_speed_2;

    return w4_m__1__wheel_speed_2;
}

/* stage 1 */
static real bound_r1_w4_y1(const khepera_encoders_threshold_coefficients *c,
        khepera_encoders_threshold_memory *x, const khepera_encoders_samples *s, real w1_a,
        real w1_b, real w4_m__1__wheel_speed_2)
{
    const khepera_encoders_threshold_encoders *e = &x->e;

    /* filtered speed of m[1].motor */
    const real w4_m__1__motor_speed_2 = c->a * x->r1_w4_m__1__motor_speed
        + c->m__1__motor_gain * (real)e->m__1__motor_r1.increment;
    x->r1_w4_m__1__motor_speed = w4_m__1__motor_speed_2;

    /* r1_w4: encoders, order 1 */
    const real w4_n1 = -c->r1_w4_w1_m__1__wheel * w4_m__1__wheel_speed_2
        - c->r1_w4_w1_m__1__motor * w4_m__1__motor_speed_2;

    /* r1_w4: error of order 1 */
    const real w4_e1 = c->bend1 * w4_n1;

    /* r1_w4: encoders, order 2 */
    const real w4_n2 = -c->r1_w4_w2_m__1__wheel * w4_m__1__wheel_speed_2
        - c->r1_w4_w2_m__1__motor * w4_m__1__motor_speed_2;

    /* r1_w4: terms of order 0 */
    const real w4_g0 = c->r1_w4_Fx__1 * s->Fx__1;

    /* r1_w4: degree 1 */
    const real w4_d1 = w4_n1 + w4_n2;

    /* r1_w4: error of order 0 */
    const real w4_e0 = c->bend2 * w4_g0;

    /* r1_w4: degree 2 */
    const real w4_d2 = w4_n2 + w4_e0 - w4_e1;

    /* r1_w4: the filter multiplied out */
    const real w4_p2_1 = w4_d2 + w4_e1;
    const real w4_p1_1 = w4_p2_1 + w4_e1;
    const real w4_p1_2 = w4_d1 - w4_p2_1;

    /* r1_w4: stage 4 */
    const real w4_u4 = w4_n1 - w4_g0 - w4_p1_2;
    const real w4_y4 = x->r1_w4_s4 + w1_b * w4_u4;
    x->r1_w4_s4 = w1_a * w4_y4 + w1_b * w4_u4;

    /* r1_w4: stage 3 */
    const real w4_u3 = w4_y4 + w4_p1_2 - w4_p1_1;
    const real w4_y3 = x->r1_w4_s3 + w1_b * w4_u3;
    x->r1_w4_s3 = w1_a * w4_y3 + w1_b * w4_u3;

    /* r1_w4: stage 2 */
    const real w4_u2 = w4_y3 + w4_p1_1 + w4_e1;
    const real w4_y2 = x->r1_w4_s2 + w1_b * w4_u2;
    x->r1_w4_s2 = w1_a * w4_y2 + w1_b * w4_u2;

    /* r1_w4: stage 1 */
    const real w4_u1 = w4_y2 - w4_e1;
    const real w4_y1 = x->r1_w4_s1 + w1_b * w4_u1;
    x->r1_w4_s1 = w1_a * w4_y1 + w1_b * w4_u1;

    return w4_y1;
}

/* encoders, order 1; ...; encoders, order 3 */
static void bound_r1_w5_n1_to_w5_n3(const khepera_encoders_threshold_coefficients *c,
        khepera_encoders_threshold_memory *x, bool first, real *w5_n1_out, real *w5_e1_out,
        real *w5_n2_out, real *w5_e2_out, real *w5_n3_out)
{
    const khepera_encoders_threshold_encoders *e = &x->e;

    if (first) {
        /* nothing is remembered yet */
        x->r1_w5_m__1__motor_speed = REAL(0.0);
        x->r1_w5_m__1__wheel_speed = REAL(0.0);
        x->r1_w5_s4 = REAL(0.0);
        x->r1_w5_s3 = REAL(0.0);
        x->r1_w5_s2 = REAL(0.0);
        x->r1_w5_s1 = REAL(0.0);
    }

    /* filtered speed of m[1].motor */
    const real w5_m__1__motor_speed_2 = c->a * x->r1_w5_m__1__motor_speed
        + c->m__1__motor_gain * (real)e->m__1__motor_r1.increment;
    x->r1_w5_m__1__motor_speed = w5_m__1__motor_speed_2;

    /* filtered speed of m[1].wheel */
    const real w5_m__1__wheel_speed_2 = c->a * x->r1_w5_m__1__wheel_speed
        + c->m__1__wheel_gain * (real)e->m__1__wheel_r1.increment;
    x->r1_w5_m__1__wheel_speed = w5_m__1__wheel_speed_2;

    /* r1_w5: encoders, order 1 */
    const real w5_n1 = c->r1_w5_w1_m__1__motor * w5_m__1__motor_speed_2
        + c->r1_w5_w1_m__1__wheel * w5_m__1__wheel_speed_2;

    /* r1_w5: error of order 1 */
    const real w5_e1 = c->bend2 * w5_n1;

    /* r1_w5: encoders, order 2 */
    const real w5_n2 = c->r1_w5_w2_m__1__motor * w5_m__1__motor_speed_2
        + c->r1_w5_w2_m__1__wheel * w5_m__1__wheel_speed_2;

    /* r1_w5: error of order 2 */
    const real w5_e2 = c->bend1 * w5_n2;

    /* r1_w5: encoders, order 3 */
    const real w5_n3 = c->r1_w5_w3_m__1__motor * w5_m__1__motor_speed_2
        + c->r1_w2_w3_m__1__wheel * w5_m__1__wheel_speed_2;

    *w5_n1_out = w5_n1;
    *w5_e1_out = w5_e1;
    *w5_n2_out = w5_n2;
    *w5_e2_out = w5_e2;
    *w5_n3_out = w5_n3;
}

/* what the tolerance of m[1].el.k can do */
static real bound_r1_w5(const khepera_encoders_threshold_coefficients *c,
        khepera_encoders_threshold_memory *x, const khepera_encoders_samples *s, real w1_a,
        real w1_b, real w5_n1, real w5_e1, real w5_n2, real w5_e2, real w5_n3)
{
    /* r1_w5: terms of order 0 */
    const real w5_g0 = c->r1_w5_Fx__1 * s->Fx__1;

    /* r1_w5: terms of order 1 */
    const real w5_g1 = c->r1_w5_w1_Fx__1 * s->Fx__1;

    /* r1_w5: degree 1 */
    const real w5_d1 = w5_g1 + w5_n1 + w5_n2;

    /* r1_w5: error of order 0 */
    const real w5_e0 = c->bend3 * w5_g0;

    /* r1_w5: degree 2 */
    const real w5_d2 = w5_n2 + w5_n3 - w5_e1 - w5_e0;

    /* r1_w5: error of order 1 */
    const real w5_e1_2 = c->bend2 * w5_g1;

    /* r1_w5: degree 3 */
    const real w5_d3 = w5_n3 - w5_e1 - w5_e2 - w5_e1_2;

    /* r1_w5: the filter multiplied out */
    const real w5_p3_1 = w5_d3 + w5_e2;
    const real w5_p2_1 = w5_p3_1 + w5_e2;
    const real w5_p2_2 = w5_d2 - w5_p3_1;
    const real w5_p1_1 = w5_p2_1 + w5_e2;
    const real w5_p1_2 = w5_p2_2 - w5_p2_1;
    const real w5_p1_3 = w5_d1 - w5_p2_2;

    /* r1_w5: stage 4 */
    const real w5_u4 = w5_g0 + w5_n1 - w5_p1_3;
    const real w5_y4 = x->r1_w5_s4 + w1_b * w5_u4;
    x->r1_w5_s4 = w1_a * w5_y4 + w1_b * w5_u4;

    /* r1_w5: stage 3 */
    const real w5_u3 = w5_y4 + w5_p1_3 - w5_p1_2;
    const real w5_y3 = x->r1_w5_s3 + w1_b * w5_u3;
    x->r1_w5_s3 = w1_a * w5_y3 + w1_b * w5_u3;

    /* r1_w5: stage 2 */
    const real w5_u2 = w5_y3 + w5_p1_2 - w5_p1_1;
    const real w5_y2 = x->r1_w5_s2 + w1_b * w5_u2;
    x->r1_w5_s2 = w1_a * w5_y2 + w1_b * w5_u2;

    /* r1_w5: stage 1 */
    const real w5_u1 = w5_y2 + w5_p1_1 + w5_e2;
    const real w5_y1 = x->r1_w5_s1 + w1_b * w5_u1;
    x->r1_w5_s1 = w1_a * w5_y1 + w1_b * w5_u1;

    /* what the tolerance of m[1].el.k can do */
    const real w5 = w5_y1 - w5_e2;

    return w5;
}

/* what the tolerances of m[1].fe and m[1].el.Re can do together */
static real bound_r1_w6(const khepera_encoders_threshold_coefficients *c,
        khepera_encoders_threshold_memory *x, bool first, real w1_a, real w1_b)
{
    const khepera_encoders_threshold_encoders *e = &x->e;

    if (first) {
        /* nothing is remembered yet */
        x->r1_w6_m__1__motor_speed = REAL(0.0);
        x->r1_w6_s4 = REAL(0.0);
        x->r1_w6_s3 = REAL(0.0);
        x->r1_w6_s2 = REAL(0.0);
        x->r1_w6_s1 = REAL(0.0);
    }

    /* filtered speed of m[1].motor */
    const real w6_m__1__motor_speed_2 = c->a * x->r1_w6_m__1__motor_speed
        + c->m__1__motor_gain * (real)e->m__1__motor_r1.increment;
    x->r1_w6_m__1__motor_speed = w6_m__1__motor_speed_2;

    /* r1_w6: encoders, order 1 */
    const real w6_n1 = -c->r1_w6_w1_m__1__motor * w6_m__1__motor_speed_2;

    /* r1_w6: stage 4 */
    const real w6_u4 = w6_n1 - w6_n1;
    const real w6_y4 = x->r1_w6_s4 + w1_b * w6_u4;
    x->r1_w6_s4 = w1_a * w6_y4 + w1_b * w6_u4;

    /* r1_w6: stage 3 */
    const real w6_u3 = w6_y4 + w6_n1;
    const real w6_y3 = x->r1_w6_s3 + w1_b * w6_u3;
    x->r1_w6_s3 = w1_a * w6_y3 + w1_b * w6_u3;

    /* r1_w6: stage 2 */
    const real w6_u2 = w6_y3;
    const real w6_y2 = x->r1_w6_s2 + w1_b * w6_u2;
    x->r1_w6_s2 = w1_a * w6_y2 + w1_b * w6_u2;

    /* r1_w6: stage 1 */
    const real w6_u1 = w6_y2;
    const real w6_y1 = x->r1_w6_s1 + w1_b * w6_u1;
    x->r1_w6_s1 = w1_a * w6_y1 + w1_b * w6_u1;

    /* what the tolerances of m[1].fe and m[1].el.Re can do together */
    const real w6 = w6_y1;

    if (first) {
        /* nothing is remembered yet */
        x->r1_w7_m__1__motor_speed = REAL(0.0);
        x->r1_w7_s4 = REAL(0.0);
        x->r1_w7_s3 = REAL(0.0);
        x->r1_w7_s2 = REAL(0.0);
        x->r1_w7_s1 = REAL(0.0);
    }

    return w6;
}

/* what the tolerances of m[1].fe and m[1].el.k can do together */
static real bound_r1_w7(const khepera_encoders_threshold_coefficients *c,
        khepera_encoders_threshold_memory *x, real w1_a, real w1_b)
{
    const khepera_encoders_threshold_encoders *e = &x->e;

    /* filtered speed of m[1].motor */
    const real w7_m__1__motor_speed_2 = c->a * x->r1_w7_m__1__motor_speed
        + c->m__1__motor_gain * (real)e->m__1__motor_r1.increment;
    x->r1_w7_m__1__motor_speed = w7_m__1__motor_speed_2;

    /* r1_w7: encoders, order 1 */
    const real w7_n1 = c->r1_w7_w1_m__1__motor * w7_m__1__motor_speed_2;

    /* r1_w7: error of order 1 */
    const real w7_e1 = c->bend1 * w7_n1;

    /* r1_w7: encoders, order 2 */
    const real w7_n2 = c->r1_w7_w2_m__1__motor * w7_m__1__motor_speed_2;

    /* r1_w7: degree 1 */
    const real w7_d1 = w7_n1 + w7_n2;

    /* r1_w7: degree 2 */
    const real w7_d2 = w7_n2 - w7_e1;

    /* r1_w7: the filter multiplied out */
    const real w7_p2_1 = w7_d2 + w7_e1;
    const real w7_p1_1 = w7_p2_1 + w7_e1;
    const real w7_p1_2 = w7_d1 - w7_p2_1;

    /* r1_w7: stage 4 */
    const real w7_u4 = w7_n1 - w7_p1_2;
    const real w7_y4 = x->r1_w7_s4 + w1_b * w7_u4;
    x->r1_w7_s4 = w1_a * w7_y4 + w1_b * w7_u4;

    /* r1_w7: stage 3 */
    const real w7_u3 = w7_y4 + w7_p1_2 - w7_p1_1;
    const real w7_y3 = x->r1_w7_s3 + w1_b * w7_u3;
    x->r1_w7_s3 = w1_a * w7_y3 + w1_b * w7_u3;

    /* r1_w7: stage 2 */
    const real w7_u2 = w7_y3 + w7_p1_1 + w7_e1;
    const real w7_y2 = x->r1_w7_s2 + w1_b * w7_u2;
    x->r1_w7_s2 = w1_a * w7_y2 + w1_b * w7_u2;

    /* r1_w7: stage 1 */
    const real w7_u1 = w7_y2 - w7_e1;
    const real w7_y1 = x->r1_w7_s1 + w1_b * w7_u1;
    x->r1_w7_s1 = w1_a * w7_y1 + w1_b * w7_u1;

    /* what the tolerances of m[1].fe and m[1].el.k can do together */
    const real w7 = w7_y1;

    return w7;
}

/* what the tolerances of m[1].Js and m[1].el.Re can do together */
static real bound_r1_w8(const khepera_encoders_threshold_coefficients *c,
        khepera_encoders_threshold_memory *x, bool first, real w1_a, real w1_b)
{
    const khepera_encoders_threshold_encoders *e = &x->e;

    if (first) {
        /* nothing is remembered yet */
        x->r1_w8_m__1__wheel_speed = REAL(0.0);
        x->r1_w8_s4 = REAL(0.0);
        x->r1_w8_s3 = REAL(0.0);
        x->r1_w8_s2 = REAL(0.0);
        x->r1_w8_s1 = REAL(0.0);
    }

    /* filtered speed of m[1].wheel */
    const real w8_m__1__wheel_speed_2 = c->a * x->r1_w8_m__1__wheel_speed
        + c->m__1__wheel_gain * (real)e->m__1__wheel_r1.increment;
    x->r1_w8_m__1__wheel_speed = w8_m__1__wheel_speed_2;

    /* r1_w8: encoders, order 2 */
    const real w8_n2 = -c->r1_w8_w2_m__1__wheel * w8_m__1__wheel_speed_2;

    /* r1_w8: the filter multiplied out */
    const real w8_p1_1 = w8_n2 - w8_n2;

    /* r1_w8: stage 4 */
    const real w8_u4 = -w8_p1_1;
    const real w8_y4 = x->r1_w8_s4 + w1_b * w8_u4;
    x->r1_w8_s4 = w1_a * w8_y4 + w1_b * w8_u4;

    /* r1_w8: stage 3 */
    const real w8_u3 = w8_y4 + w8_p1_1 - w8_n2;
    const real w8_y3 = x->r1_w8_s3 + w1_b * w8_u3;
    x->r1_w8_s3 = w1_a * w8_y3 + w1_b * w8_u3;

    /* r1_w8: stage 2 */
    const real w8_u2 = w8_y3 + w8_n2;
    const real w8_y2 = x->r1_w8_s2 + w1_b * w8_u2;
    x->r1_w8_s2 = w1_a * w8_y2 + w1_b * w8_u2;

    /* r1_w8: stage 1 */
    const real w8_u1 = w8_y2;
    const real w8_y1 = x->r1_w8_s1 + w1_b * w8_u1;
    x->r1_w8_s1 = w1_a * w8_y1 + w1_b * w8_u1;

    /* what the tolerances of m[1].Js and m[1].el.Re can do together */
    const real w8 = w8_y1;

    if (first) {
        /* nothing is remembered yet */
        x->r1_w9_m__1__wheel_speed = REAL(0.0);
        x->r1_w9_s4 = REAL(0.0);
        x->r1_w9_s3 = REAL(0.0);
        x->r1_w9_s2 = REAL(0.0);
        x->r1_w9_s1 = REAL(0.0);
    }

    return w8;
}

/* what the tolerances of m[1].Js and m[1].el.k can do together */
static real bound_r1_w9(const khepera_encoders_threshold_coefficients *c,
        khepera_encoders_threshold_memory *x, real w1_a, real w1_b)
{
    const khepera_encoders_threshold_encoders *e = &x->e;

    /* filtered speed of m[1].wheel */
    const real w9_m__1__wheel_speed_2 = c->a * x->r1_w9_m__1__wheel_speed
        + c->m__1__wheel_gain * (real)e->m__1__wheel_r1.increment;
    x->r1_w9_m__1__wheel_speed = w9_m__1__wheel_speed_2;

    /* r1_w9: encoders, order 2 */
    const real w9_n2 = c->r1_w9_w2_m__1__wheel * w9_m__1__wheel_speed_2;

    /* r1_w9: error of order 2 */
    const real w9_e2 = c->bend1 * w9_n2;

    /* r1_w9: encoders, order 3 */
    const real w9_n3 = c->r1_w9_w3_m__1__wheel * w9_m__1__wheel_speed_2;

    /* r1_w9: degree 2 */
    const real w9_d2 = w9_n2 + w9_n3;

    /* r1_w9: degree 3 */
    const real w9_d3 = w9_n3 - w9_e2;

    /* r1_w9: the filter multiplied out */
    const real w9_p3_1 = w9_d3 + w9_e2;
    const real w9_p2_1 = w9_p3_1 + w9_e2;
    const real w9_p2_2 = w9_d2 - w9_p3_1;
    const real w9_p1_1 = w9_p2_1 + w9_e2;
    const real w9_p1_2 = w9_p2_2 - w9_p2_1;
    const real w9_p1_3 = w9_n2 - w9_p2_2;

    /* r1_w9: stage 4 */
    const real w9_u4 = -w9_p1_3;
    const real w9_y4 = x->r1_w9_s4 + w1_b * w9_u4;
    x->r1_w9_s4 = w1_a * w9_y4 + w1_b * w9_u4;

    /* r1_w9: stage 3 */
    const real w9_u3 = w9_y4 + w9_p1_3 - w9_p1_2;
    const real w9_y3 = x->r1_w9_s3 + w1_b * w9_u3;
    x->r1_w9_s3 = w1_a * w9_y3 + w1_b * w9_u3;

    /* r1_w9: stage 2 */
    const real w9_u2 = w9_y3 + w9_p1_2 - w9_p1_1;
    const real w9_y2 = x->r1_w9_s2 + w1_b * w9_u2;
    x->r1_w9_s2 = w1_a * w9_y2 + w1_b * w9_u2;

    /* r1_w9: stage 1 */
    const real w9_u1 = w9_y2 + w9_p1_1 + w9_e2;
    const real w9_y1 = x->r1_w9_s1 + w1_b * w9_u1;
    x->r1_w9_s1 = w1_a * w9_y1 + w1_b * w9_u1;

    /* what the tolerances of m[1].Js and m[1].el.k can do together */
    const real w9 = w9_y1 - w9_e2;

    return w9;
}

/* what the tolerances of m[1].fs and m[1].el.Re can do together */
static real bound_r1_w10(const khepera_encoders_threshold_coefficients *c,
        khepera_encoders_threshold_memory *x, bool first, real w1_a, real w1_b)
{
    const khepera_encoders_threshold_encoders *e = &x->e;

    if (first) {
        /* nothing is remembered yet */
        x->r1_w10_m__1__wheel_speed = REAL(0.0);
        x->r1_w10_s4 = REAL(0.0);
        x->r1_w10_s3 = REAL(0.0);
        x->r1_w10_s2 = REAL(0.0);
        x->r1_w10_s1 = REAL(0.0);
    }

    /* filtered speed of m[1].wheel */
    const real w10_m__1__wheel_speed_2 = c->a * x->r1_w10_m__1__wheel_speed
        + c->m__1__wheel_gain * (real)e->m__1__wheel_r1.increment;
    x->r1_w10_m__1__wheel_speed = w10_m__1__wheel_speed_2;

    /* r1_w10: encoders, order 1 */
    const real w10_n1 = -c->r1_w10_w1_m__1__wheel * w10_m__1__wheel_speed_2;

    /* r1_w10: stage 4 */
    const real w10_u4 = w10_n1 - w10_n1;
    const real w10_y4 = x->r1_w10_s4 + w1_b * w10_u4;
    x->r1_w10_s4 = w1_a * w10_y4 + w1_b * w10_u4;

    /* r1_w10: stage 3 */
    const real w10_u3 = w10_y4 + w10_n1;
    const real w10_y3 = x->r1_w10_s3 + w1_b * w10_u3;
    x->r1_w10_s3 = w1_a * w10_y3 + w1_b * w10_u3;

    /* r1_w10: stage 2 */
    const real w10_u2 = w10_y3;
    const real w10_y2 = x->r1_w10_s2 + w1_b * w10_u2;
    x->r1_w10_s2 = w1_a * w10_y2 + w1_b * w10_u2;

    /* r1_w10: stage 1 */
    const real w10_u1 = w10_y2;
    const real w10_y1 = x->r1_w10_s1 + w1_b * w10_u1;
    x->r1_w10_s1 = w1_a * w10_y1 + w1_b * w10_u1;

    /* what the tolerances of m[1].fs and m[1].el.Re can do together */
    const real w10 = w10_y1;

    if (first) {
        /* nothing is remembered yet */
        x->r1_w11_m__1__wheel_speed = REAL(0.0);
        x->r1_w11_s4 = REAL(0.0);
        x->r1_w11_s3 = REAL(0.0);
        x->r1_w11_s2 = REAL(0.0);
        x->r1_w11_s1 = REAL(0.0);
    }

    return w10;
}

/* what the tolerances of m[1].fs and m[1].el.k can do together */
static real bound_r1_w11(const khepera_encoders_threshold_coefficients *c,
        khepera_encoders_threshold_memory *x, real w1_a, real w1_b)
{
    const khepera_encoders_threshold_encoders *e = &x->e;

    /* filtered speed of m[1].wheel */
    const real w11_m__1__wheel_speed_2 = c->a * x->r1_w11_m__1__wheel_speed
        + c->m__1__wheel_gain * (real)e->m__1__wheel_r1.increment;
    x->r1_w11_m__1__wheel_speed = w11_m__1__wheel_speed_2;

    /* r1_w11: encoders, order 1 */
    const real w11_n1 = c->r1_w11_w1_m__1__wheel * w11_m__1__wheel_speed_2;

    /* r1_w11: error of order 1 */
    const real w11_e1 = c->bend1 * w11_n1;

    /* r1_w11: encoders, order 2 */
    const real w11_n2 = c->r1_w11_w2_m__1__wheel * w11_m__1__wheel_speed_2;

    /* r1_w11: degree 1 */
    const real w11_d1 = w11_n1 + w11_n2;

    /* r1_w11: degree 2 */
    const real w11_d2 = w11_n2 - w11_e1;

    /* r1_w11: the filter multiplied out */
    const real w11_p2_1 = w11_d2 + w11_e1;
    const real w11_p1_1 = w11_p2_1 + w11_e1;
    const real w11_p1_2 = w11_d1 - w11_p2_1;

    /* r1_w11: stage 4 */
    const real w11_u4 = w11_n1 - w11_p1_2;
    const real w11_y4 = x->r1_w11_s4 + w1_b * w11_u4;
    x->r1_w11_s4 = w1_a * w11_y4 + w1_b * w11_u4;

    /* r1_w11: stage 3 */
    const real w11_u3 = w11_y4 + w11_p1_2 - w11_p1_1;
    const real w11_y3 = x->r1_w11_s3 + w1_b * w11_u3;
    x->r1_w11_s3 = w1_a * w11_y3 + w1_b * w11_u3;

    /* r1_w11: stage 2 */
    const real w11_u2 = w11_y3 + w11_p1_1 + w11_e1;
    const real w11_y2 = x->r1_w11_s2 + w1_b * w11_u2;
    x->r1_w11_s2 = w1_a * w11_y2 + w1_b * w11_u2;

    /* r1_w11: stage 1 */
    const real w11_u1 = w11_y2 - w11_e1;
    const real w11_y1 = x->r1_w11_s1 + w1_b * w11_u1;
    x->r1_w11_s1 = w1_a * w11_y1 + w1_b * w11_u1;

    /* what the tolerances of m[1].fs and m[1].el.k can do together */
    const real w11 = w11_y1;

    return w11;
}

/* filtered speed of m[1].motor */
static real bound_r1_w12_m__1__motor_speed_2(const khepera_encoders_threshold_coefficients *c,
        khepera_encoders_threshold_memory *x, bool first)
{
    const khepera_encoders_threshold_encoders *e = &x->e;

    if (first) {
        /* nothing is remembered yet */
        x->r1_w12_m__1__motor_speed = REAL(0.0);
        x->r1_w12_m__1__wheel_speed = REAL(0.0);
        x->r1_w12_s4 = REAL(0.0);
        x->r1_w12_s3 = REAL(0.0);
        x->r1_w12_s2 = REAL(0.0);
        x->r1_w12_s1 = REAL(0.0);
    }

    /* filtered speed of m[1].motor */
    const real w12_m__1__motor_speed_2 = c->a * x->r1_w12_m__1__motor_speed
        + c->m__1__motor_gain * (real)e->m__1__motor_r1.increment;
    x->r1_w12_m__1__motor_speed = w12_m__1__motor_speed_2;

    return w12_m__1__motor_speed_2;
}

/* stage 1 */
static real bound_r1_w12_y1(const khepera_encoders_threshold_coefficients *c,
        khepera_encoders_threshold_memory *x, const khepera_encoders_samples *s, real w1_a,
        real w1_b, real w12_m__1__motor_speed_2)
{
    const khepera_encoders_threshold_encoders *e = &x->e;

    /* filtered speed of m[1].wheel */
    const real w12_m__1__wheel_speed_2 = c->a * x->r1_w12_m__1__wheel_speed
        + c->m__1__wheel_gain * (real)e->m__1__wheel_r1.increment;
    x->r1_w12_m__1__wheel_speed = w12_m__1__wheel_speed_2;

    /* r1_w12: encoders, order 1 */
    const real w12_n1 = c->r1_w12_w1_m__1__motor * w12_m__1__motor_speed_2
        + c->r1_w12_w1_m__1__wheel * w12_m__1__wheel_speed_2;

    /* r1_w12: error of order 1 */
    const real w12_e1 = c->bend1 * w12_n1;

    /* r1_w12: encoders, order 2 */
    const real w12_n2 = c->r1_w12_w2_m__1__motor * w12_m__1__motor_speed_2
        + c->r1_w8_w2_m__1__wheel * w12_m__1__wheel_speed_2;

    /* r1_w12: terms of order 0 */
    const real w12_g0 = c->r1_w12_Fx__1 * s->Fx__1;

    /* r1_w12: degree 1 */
    const real w12_d1 = w12_n1 + w12_n2;

    /* r1_w12: error of order 0 */
    const real w12_e0 = c->bend2 * w12_g0;

    /* r1_w12: degree 2 */
    const real w12_d2 = w12_n2 - w12_e1 - w12_e0;

    /* r1_w12: the filter multiplied out */
    const real w12_p2_1 = w12_d2 + w12_e1;
    const real w12_p1_1 = w12_p2_1 + w12_e1;
    const real w12_p1_2 = w12_d1 - w12_p2_1;

    /* r1_w12: stage 4 */
    const real w12_u4 = w12_g0 + w12_n1 - w12_p1_2;
    const real w12_y4 = x->r1_w12_s4 + w1_b * w12_u4;
    x->r1_w12_s4 = w1_a * w12_y4 + w1_b * w12_u4;

    /* r1_w12: stage 3 */
    const real w12_u3 = w12_y4 + w12_p1_2 - w12_p1_1;
    const real w12_y3 = x->r1_w12_s3 + w1_b * w12_u3;
    x->r1_w12_s3 = w1_a * w12_y3 + w1_b * w12_u3;

    /* r1_w12: stage 2 */
    const real w12_u2 = w12_y3 + w12_p1_1 + w12_e1;
    const real w12_y2 = x->r1_w12_s2 + w1_b * w12_u2;
    x->r1_w12_s2 = w1_a * w12_y2 + w1_b * w12_u2;

    /* r1_w12: stage 1 */
    const real w12_u1 = w12_y2 - w12_e1;
    const real w12_y1 = x->r1_w12_s1 + w1_b * w12_u1;
    x->r1_w12_s1 = w1_a * w12_y1 + w1_b * w12_u1;

    return w12_y1;
}

/* encoders, order 1; ...; encoders, order 3 */
static void bound_r1_w13_n1_to_w13_n3(const khepera_encoders_threshold_coefficients *c,
        khepera_encoders_threshold_memory *x, bool first, real *w13_n1_out, real *w13_e1_out,
        real *w13_n2_out, real *w13_e2_out, real *w13_n3_out)
{
    const khepera_encoders_threshold_encoders *e = &x->e;

    if (first) {
        /* nothing is remembered yet */
        x->r1_w13_m__1__motor_speed = REAL(0.0);
        x->r1_w13_m__1__wheel_speed = REAL(0.0);
        x->r1_w13_s4 = REAL(0.0);
        x->r1_w13_s3 = REAL(0.0);
        x->r1_w13_s2 = REAL(0.0);
        x->r1_w13_s1 = REAL(0.0);
    }

    /* filtered speed of m[1].motor */
    const real w13_m__1__motor_speed_2 = c->a * x->r1_w13_m__1__motor_speed
        + c->m__1__motor_gain * (real)e->m__1__motor_r1.increment;
    x->r1_w13_m__1__motor_speed = w13_m__1__motor_speed_2;

    /* filtered speed of m[1].wheel */
    const real w13_m__1__wheel_speed_2 = c->a * x->r1_w13_m__1__wheel_speed
        + c->m__1__wheel_gain * (real)e->m__1__wheel_r1.increment;
    x->r1_w13_m__1__wheel_speed = w13_m__1__wheel_speed_2;

    /* r1_w13: encoders, order 1 */
    const real w13_n1 = -c->r1_w13_w1_m__1__motor * w13_m__1__motor_speed_2
        - c->r1_w13_w1_m__1__wheel * w13_m__1__wheel_speed_2;

    /* r1_w13: error of order 1 */
    const real w13_e1 = c->bend2 * w13_n1;

    /* r1_w13: encoders, order 2 */
    const real w13_n2 = c->r1_w13_w2_m__1__motor * w13_m__1__motor_speed_2
        + c->r1_w13_w2_m__1__wheel * w13_m__1__wheel_speed_2;

    /* r1_w13: error of order 2 */
    const real w13_e2 = c->bend1 * w13_n2;

    /* r1_w13: encoders, order 3 */
    const real w13_n3 = -c->r1_w13_w3_m__1__motor * w13_m__1__motor_speed_2
        - c->r1_w9_w3_m__1__wheel * w13_m__1__wheel_speed_2;

    *w13_n1_out = w13_n1;
    *w13_e1_out = w13_e1;
    *w13_n2_out = w13_n2;
    *w13_e2_out = w13_e2;
    *w13_n3_out = w13_n3;
}

/* second order of what the tolerance of m[1].el.k can do */
static real bound_r1_w13(const khepera_encoders_threshold_coefficients *c,
        khepera_encoders_threshold_memory *x, const khepera_encoders_samples *s, real w1_a,
        real w1_b, real w13_n1, real w13_e1, real w13_n2, real w13_e2, real w13_n3)
{
    /* r1_w13: terms of order 0 */
    const real w13_g0 = c->r1_w13_Fx__1 * s->Fx__1;

    /* r1_w13: terms of order 1 */
    const real w13_g1 = c->r1_w13_w1_Fx__1 * s->Fx__1;

    /* r1_w13: degree 1 */
    const real w13_d1 = w13_n1 + w13_n2 - w13_g1;

    /* r1_w13: error of order 0 */
    const real w13_e0 = c->bend3 * w13_g0;

    /* r1_w13: degree 2 */
    const real w13_d2 = w13_n2 + w13_n3 + w13_e0 - w13_e1;

    /* r1_w13: error of order 1 */
    const real w13_e1_2 = c->bend2 * w13_g1;

    /* r1_w13: degree 3 */
    const real w13_d3 = w13_n3 + w13_e1_2 - w13_e1 - w13_e2;

    /* r1_w13: the filter multiplied out */
    const real w13_p3_1 = w13_d3 + w13_e2;
    const real w13_p2_1 = w13_p3_1 + w13_e2;
    const real w13_p2_2 = w13_d2 - w13_p3_1;
    const real w13_p1_1 = w13_p2_1 + w13_e2;
    const real w13_p1_2 = w13_p2_2 - w13_p2_1;
    const real w13_p1_3 = w13_d1 - w13_p2_2;

    /* r1_w13: stage 4 */
    const real w13_u4 = w13_n1 - w13_g0 - w13_p1_3;
    const real w13_y4 = x->r1_w13_s4 + w1_b * w13_u4;
    x->r1_w13_s4 = w1_a * w13_y4 + w1_b * w13_u4;

    /* r1_w13: stage 3 */
    const real w13_u3 = w13_y4 + w13_p1_3 - w13_p1_2;
    const real w13_y3 = x->r1_w13_s3 + w1_b * w13_u3;
    x->r1_w13_s3 = w1_a * w13_y3 + w1_b * w13_u3;

    /* r1_w13: stage 2 */
    const real w13_u2 = w13_y3 + w13_p1_2 - w13_p1_1;
    const real w13_y2 = x->r1_w13_s2 + w1_b * w13_u2;
    x->r1_w13_s2 = w1_a * w13_y2 + w1_b * w13_u2;

    /* r1_w13: stage 1 */
    const real w13_u1 = w13_y2 + w13_p1_1 + w13_e2;
    const real w13_y1 = x->r1_w13_s1 + w1_b * w13_u1;
    x->r1_w13_s1 = w1_a * w13_y1 + w1_b * w13_u1;

    /* second order of what the tolerance of m[1].el.k can do */
    const real w13 = w13_y1 - w13_e2;

    return w13;
}

/* r1 on one sample.
 * khepera.bg:17: r1: how far r1 can be from zero if no parameter is out of tolerance */
static void bound_r1(
    const khepera_encoders_threshold_coefficients *c, khepera_encoders_threshold_memory *x, const khepera_encoders_samples *s, real *r)
{
    const bool first = x->youngest == 0u && x->age[0] == 0u;

    count_on(&x->e.m__1__motor_r1, s->m__1__motor, first);
    count_on(&x->e.m__1__wheel_r1, s->m__1__wheel, first);

    real w1_a;
    real w1_b;
    real w1_m__1__motor_speed_2;

    bound_r1_w1_a_to_w1_m__1__motor_speed_2(c, x, first, &w1_a, &w1_b, &w1_m__1__motor_speed_2);
    const real w1 = bound_r1_w1(c, x, w1_a, w1_b, w1_m__1__motor_speed_2);
    const real w2_m__1__wheel_speed_2 = bound_r1_w2_m__1__wheel_speed_2(c, x, first);
    const real w2 = bound_r1_w2(c, x, w1_a, w1_b, w2_m__1__wheel_speed_2);
    const real w3_m__1__wheel_speed_2 = bound_r1_w3_m__1__wheel_speed_2(c, x, first);
    const real w3 = bound_r1_w3(c, x, w1_a, w1_b, w3_m__1__wheel_speed_2);
    const real w4_m__1__wheel_speed_2 = bound_r1_w4_m__1__wheel_speed_2(c, x, first);
    const real w4_y1 = bound_r1_w4_y1(c, x, s, w1_a, w1_b, w4_m__1__wheel_speed_2);

    /* what the tolerance of m[1].el.Re can do */
    const real w4 = w4_y1;

    real w5_n1;
    real w5_e1;
    real w5_n2;
    real w5_e2;
    real w5_n3;

    bound_r1_w5_n1_to_w5_n3(c, x, first, &w5_n1, &w5_e1, &w5_n2, &w5_e2, &w5_n3);
    const real w5 = bound_r1_w5(c, x, s, w1_a, w1_b, w5_n1, w5_e1, w5_n2, w5_e2, w5_n3);
    const real w6 = bound_r1_w6(c, x, first, w1_a, w1_b);
    const real w7 = bound_r1_w7(c, x, w1_a, w1_b);
    const real w8 = bound_r1_w8(c, x, first, w1_a, w1_b);
    const real w9 = bound_r1_w9(c, x, w1_a, w1_b);
    const real w10 = bound_r1_w10(c, x, first, w1_a, w1_b);
    const real w11 = bound_r1_w11(c, x, w1_a, w1_b);
    const real w12_m__1__motor_speed_2 = bound_r1_w12_m__1__motor_speed_2(c, x, first);
    const real w12_y1 = bound_r1_w12_y1(c, x, s, w1_a, w1_b, w12_m__1__motor_speed_2);

    /* what the tolerances of m[1].el.Re and m[1].el.k can do together */
    const real w12 = w12_y1;

    real w13_n1;
    real w13_e1;
    real w13_n2;
    real w13_e2;
    real w13_n3;

    bound_r1_w13_n1_to_w13_n3(c, x, first, &w13_n1, &w13_e1, &w13_n2, &w13_e2, &w13_n3);
    const real w13 = bound_r1_w13(c, x, s, w1_a, w1_b, w13_n1, w13_e1, w13_n2, w13_e2, w13_n3);

    r[KHEPERA_ENCODERS_R1] = MATH(fabs)(w1) + MATH(fabs)(w2) + MATH(fabs)(w3) + MATH(fabs)(w4)
        + MATH(fabs)(w5) + MATH(fabs)(w6) + MATH(fabs)(w7) + MATH(fabs)(w8) + MATH(fabs)(w9)
        + MATH(fabs)(w10) + MATH(fabs)(w11) + MATH(fabs)(w12) + MATH(fabs)(w13);
}

/* what the tolerance of m[1].K can do */
static real bound_r2_w1(const khepera_encoders_threshold_coefficients *c,
        khepera_encoders_threshold_memory *x, bool first, real w1_a, real w1_b)
{
    const khepera_encoders_threshold_encoders *e = &x->e;

    /* m[1].wheel */
    const real w1_m__1__wheel = c->m__1__wheel__int__x0
        + REAL(9.587379924285257e-05) * (real)e->m__1__wheel_r2.total;

    if (first) {
        /* change of D(m[1].wheel) */
        x->r2_w1_start = w1_m__1__wheel;
    }

    /* change of D(m[1].wheel) */
    const real w1_change = w1_m__1__wheel - x->r2_w1_start;

    /* m[1].motor */
    const real w1_m__1__motor = c->m__1__motor__int__x0
        + REAL(0.0015339807878856412) * (real)e->m__1__motor_r2.total;

    if (first) {
        /* change of D(m[1].motor) */
        x->r2_w1_start_2 = w1_m__1__motor;
    }

    /* change of D(m[1].motor) */
    const real w1_change_2 = w1_m__1__motor - x->r2_w1_start_2;

    /* tanh(Int(D(m[1].motor))/(4*m[1].tau0) - m[1].ge.N*Int(D(m[1].wheel))/(4*m[1].tau0)) */
    const real w1_tanh = near_tanh(c->scaled_one_over_tau0 * w1_change_2
            - c->scaled_N_over_tau0 * w1_change);

    /* r2_w1: stage 3 */
    const real w1_u3 = c->r2_w1_integral_2 * w1_change - c->r2_w1_integral * w1_change_2
        - c->r2_w1_tanh * w1_tanh;
    const real w1_y3 = x->r2_w1_s3 + w1_b * w1_u3;
    x->r2_w1_s3 = w1_a * w1_y3 + w1_b * w1_u3;

    /* r2_w1: stage 2 */
    const real w1_u2 = w1_y3;
    const real w1_y2 = x->r2_w1_s2 + w1_b * w1_u2;
    x->r2_w1_s2 = w1_a * w1_y2 + w1_b * w1_u2;

    /* r2_w1: stage 1 */
    const real w1_u1 = w1_y2;
    const real w1_y1 = x->r2_w1_s1 + w1_b * w1_u1;
    x->r2_w1_s1 = w1_a * w1_y1 + w1_b * w1_u1;

    /* what the tolerance of m[1].K can do */
    const real w1 = w1_y1;

    if (first) {
        /* nothing is remembered yet */
        x->r2_w2_s3 = REAL(0.0);
        x->r2_w2_s2 = REAL(0.0);
        x->r2_w2_s1 = REAL(0.0);
    }

    return w1;
}

/* what the tolerance of m[1].tau0 can do */
static real bound_r2_w2(const khepera_encoders_threshold_coefficients *c,
        khepera_encoders_threshold_memory *x, bool first, real w1_a, real w1_b)
{
    const khepera_encoders_threshold_encoders *e = &x->e;

    /* m[1].wheel */
    const real w2_m__1__wheel = c->m__1__wheel__int__x0
        + REAL(9.587379924285257e-05) * (real)e->m__1__wheel_r2.total;

    if (first) {
        /* change of D(m[1].wheel) */
        x->r2_w2_start = w2_m__1__wheel;
    }

    /* change of D(m[1].wheel) */
    const real w2_change = w2_m__1__wheel - x->r2_w2_start;

    /* m[1].motor */
    const real w2_m__1__motor = c->m__1__motor__int__x0
        + REAL(0.0015339807878856412) * (real)e->m__1__motor_r2.total;

    if (first) {
        /* change of D(m[1].motor) */
        x->r2_w2_start_2 = w2_m__1__motor;
    }

    /* change of D(m[1].motor) */
    const real w2_change_2 = w2_m__1__motor - x->r2_w2_start_2;

    /* tanh(Int(D(m[1].motor))/(4*m[1].tau0) - m[1].ge.N*Int(D(m[1].wheel))/(4*m[1].tau0)) */
    const real w2_tanh_x = near_tanh(c->scaled_one_over_tau0 * w2_change_2
            - c->scaled_N_over_tau0 * w2_change);

    /* (m[1].ge.N*Int(D(m[1].wheel))/(4*m[1].tau0^2) - Int(D(m[1].motor))/(4*m[1].tau0^2))*(1 -
     * tanh(Int(D(m[1].motor))/(4*m[1].tau0) - m[1].ge.N*Int(D(m[1].wheel))/(4*m[1].tau0))^2) */
    const real w2_product = (c->scaled_N_over_tau0_2 * w2_change
            - c->scaled_one_over_tau0_2 * w2_change_2) * (REAL(1.0) - w2_tanh_x * w2_tanh_x);

    /* r2_w2: stage 3 */
    const real w2_u3 = -c->r2_w1_tanh * w2_tanh_x - c->r2_w2_product * w2_product;
    const real w2_y3 = x->r2_w2_s3 + w1_b * w2_u3;
    x->r2_w2_s3 = w1_a * w2_y3 + w1_b * w2_u3;

    /* r2_w2: stage 2 */
    const real w2_u2 = w2_y3;
    const real w2_y2 = x->r2_w2_s2 + w1_b * w2_u2;
    x->r2_w2_s2 = w1_a * w2_y2 + w1_b * w2_u2;

    /* r2_w2: stage 1 */
    const real w2_u1 = w2_y2;
    const real w2_y1 = x->r2_w2_s1 + w1_b * w2_u1;
    x->r2_w2_s1 = w1_a * w2_y1 + w1_b * w2_u1;

    /* what the tolerance of m[1].tau0 can do */
    const real w2 = w2_y1;

    return w2;
}

/* what the tolerance of m[1].Js can do */
static real bound_r2_w3(const khepera_encoders_threshold_coefficients *c,
        khepera_encoders_threshold_memory *x, bool first, real w1_a, real w1_b)
{
    const khepera_encoders_threshold_encoders *e = &x->e;

    if (first) {
        /* nothing is remembered yet */
        x->r2_w3_m__1__wheel_speed = REAL(0.0);
        x->r2_w3_s3 = REAL(0.0);
        x->r2_w3_s2 = REAL(0.0);
        x->r2_w3_s1 = REAL(0.0);
    }

    /* filtered speed of m[1].wheel */
    const real w3_m__1__wheel_speed_2 = c->a * x->r2_w3_m__1__wheel_speed
        + c->m__1__wheel_gain * (real)e->m__1__wheel_r2.increment;
    x->r2_w3_m__1__wheel_speed = w3_m__1__wheel_speed_2;

    /* r2_w3: encoders, order 2 */
    const real w3_n2 = c->r2_w3_w2_m__1__wheel * w3_m__1__wheel_speed_2;

    /* r2_w3: the filter multiplied out */
    const real w3_p1_1 = w3_n2 - w3_n2;

    /* r2_w3: stage 3 */
    const real w3_u3 = -w3_p1_1;
    const real w3_y3 = x->r2_w3_s3 + w1_b * w3_u3;
    x->r2_w3_s3 = w1_a * w3_y3 + w1_b * w3_u3;

    /* r2_w3: stage 2 */
    const real w3_u2 = w3_y3 + w3_p1_1 - w3_n2;
    const real w3_y2 = x->r2_w3_s2 + w1_b * w3_u2;
    x->r2_w3_s2 = w1_a * w3_y2 + w1_b * w3_u2;

    /* r2_w3: stage 1 */
    const real w3_u1 = w3_y2 + w3_n2;
    const real w3_y1 = x->r2_w3_s1 + w1_b * w3_u1;
    x->r2_w3_s1 = w1_a * w3_y1 + w1_b * w3_u1;

    /* what the tolerance of m[1].Js can do */
    const real w3 = w3_y1;

    return w3;
}

/* what the tolerance of m[1].fs can do */
static real bound_r2_w4(const khepera_encoders_threshold_coefficients *c,
        khepera_encoders_threshold_memory *x, bool first, real w1_a, real w1_b)
{
    const khepera_encoders_threshold_encoders *e = &x->e;

    if (first) {
        /* nothing is remembered yet */
        x->r2_w4_m__1__wheel_speed = REAL(0.0);
        x->r2_w4_s3 = REAL(0.0);
        x->r2_w4_s2 = REAL(0.0);
        x->r2_w4_s1 = REAL(0.0);
    }

    /* filtered speed of m[1].wheel */
    const real w4_m__1__wheel_speed_2 = c->a * x->r2_w4_m__1__wheel_speed
        + c->m__1__wheel_gain * (real)e->m__1__wheel_r2.increment;
    x->r2_w4_m__1__wheel_speed = w4_m__1__wheel_speed_2;

    /* r2_w4: encoders, order 1 */
    const real w4_n1 = c->r2_w4_w1_m__1__wheel * w4_m__1__wheel_speed_2;

    /* r2_w4: stage 3 */
    const real w4_u3 = w4_n1 - w4_n1;
    const real w4_y3 = x->r2_w4_s3 + w1_b * w4_u3;
    x->r2_w4_s3 = w1_a * w4_y3 + w1_b * w4_u3;

    /* r2_w4: stage 2 */
    const real w4_u2 = w4_y3 + w4_n1;
    const real w4_y2 = x->r2_w4_s2 + w1_b * w4_u2;
    x->r2_w4_s2 = w1_a * w4_y2 + w1_b * w4_u2;

    /* r2_w4: stage 1 */
    const real w4_u1 = w4_y2;
    const real w4_y1 = x->r2_w4_s1 + w1_b * w4_u1;
    x->r2_w4_s1 = w1_a * w4_y1 + w1_b * w4_u1;

    /* what the tolerance of m[1].fs can do */
    const real w4 = w4_y1;

    if (first) {
        /* nothing is remembered yet */
        x->r2_w5_s3 = REAL(0.0);
        x->r2_w5_s2 = REAL(0.0);
        x->r2_w5_s1 = REAL(0.0);
    }

    return w4;
}

/* what the tolerances of m[1].K and m[1].tau0 can do together */
static real bound_r2_w5(const khepera_encoders_threshold_coefficients *c,
        khepera_encoders_threshold_memory *x, bool first, real w1_a, real w1_b)
{
    const khepera_encoders_threshold_encoders *e = &x->e;

    /* m[1].wheel */
    const real w5_m__1__wheel = c->m__1__wheel__int__x0
        + REAL(9.587379924285257e-05) * (real)e->m__1__wheel_r2.total;

    if (first) {
        /* change of D(m[1].wheel) */
        x->r2_w5_start = w5_m__1__wheel;
    }

    /* change of D(m[1].wheel) */
    const real w5_change = w5_m__1__wheel - x->r2_w5_start;

    /* m[1].motor */
    const real w5_m__1__motor = c->m__1__motor__int__x0
        + REAL(0.0015339807878856412) * (real)e->m__1__motor_r2.total;

    if (first) {
        /* change of D(m[1].motor) */
        x->r2_w5_start_2 = w5_m__1__motor;
    }

    /* change of D(m[1].motor) */
    const real w5_change_2 = w5_m__1__motor - x->r2_w5_start_2;

    /* tanh(Int(D(m[1].motor))/(4*m[1].tau0) - m[1].ge.N*Int(D(m[1].wheel))/(4*m[1].tau0)) */
    const real w5_tanh_x = near_tanh(c->scaled_one_over_tau0 * w5_change_2
            - c->scaled_N_over_tau0 * w5_change);

    /* (m[1].ge.N*Int(D(m[1].wheel))/(4*m[1].tau0^2) - Int(D(m[1].motor))/(4*m[1].tau0^2))*(1 -
     * tanh(Int(D(m[1].motor))/(4*m[1].tau0) - m[1].ge.N*Int(D(m[1].wheel))/(4*m[1].tau0))^2) */
    const real w5_product = (c->scaled_N_over_tau0_2 * w5_change
            - c->scaled_one_over_tau0_2 * w5_change_2) * (REAL(1.0) - w5_tanh_x * w5_tanh_x);

    /* r2_w5: stage 3 */
    const real w5_u3 = -c->r2_w5_tanh * w5_tanh_x - c->r2_w5_product * w5_product;
    const real w5_y3 = x->r2_w5_s3 + w1_b * w5_u3;
    x->r2_w5_s3 = w1_a * w5_y3 + w1_b * w5_u3;

    /* r2_w5: stage 2 */
    const real w5_u2 = w5_y3;
    const real w5_y2 = x->r2_w5_s2 + w1_b * w5_u2;
    x->r2_w5_s2 = w1_a * w5_y2 + w1_b * w5_u2;

    /* r2_w5: stage 1 */
    const real w5_u1 = w5_y2;
    const real w5_y1 = x->r2_w5_s1 + w1_b * w5_u1;
    x->r2_w5_s1 = w1_a * w5_y1 + w1_b * w5_u1;

    /* what the tolerances of m[1].K and m[1].tau0 can do together */
    const real w5 = w5_y1;

    return w5;
}

/* second order of what the tolerance of m[1].tau0 can do */
static real bound_r2_w6(const khepera_encoders_threshold_coefficients *c,
        khepera_encoders_threshold_memory *x, bool first, real w1_a, real w1_b, real w6_change,
        real w6_m__1__motor)
{
    if (first) {
        /* change of D(m[1].motor) */
        x->r2_w6_start_2 = w6_m__1__motor;
    }

    /* change of D(m[1].motor) */
    const real w6_change_2 = w6_m__1__motor - x->r2_w6_start_2;

    /* tanh(Int(D(m[1].motor))/(4*m[1].tau0) - m[1].ge.N*Int(D(m[1].wheel))/(4*m[1].tau0)) */
    const real w6_tanh_x = near_tanh(c->scaled_one_over_tau0 * w6_change_2
            - c->scaled_N_over_tau0 * w6_change);

    /* m[1].ge.N*Int(D(m[1].wheel))/(4*m[1].tau0^2) - Int(D(m[1].motor))/(4*m[1].tau0^2) */
    const real w6_sum = c->scaled_N_over_tau0_2 * w6_change
        - c->scaled_one_over_tau0_2 * w6_change_2;

    /* 1 - tanh(Int(D(m[1].motor))/(4*m[1].tau0) - m[1].ge.N*Int(D(m[1].wheel))/(4*m[1].tau0))^2 */
    const real w6_sum_2 = REAL(1.0) - w6_tanh_x * w6_tanh_x;

    /* (m[1].ge.N*Int(D(m[1].wheel))/(4*m[1].tau0^2) - Int(D(m[1].motor))/(4*m[1].tau0^2))*(1 -
     * tanh(Int(D(m[1].motor))/(4*m[1].tau0) - m[1].ge.N*Int(D(m[1].wheel))/(4*m[1].tau0))^2) */
    const real w6_product = w6_sum * w6_sum_2;

    /* (1 - tanh(Int(D(m[1].motor))/(4*m[1].tau0) -
     * m[1].ge.N*Int(D(m[1].wheel))/(4*m[1].tau0))^2)*(Int(D(m[1].motor))/(2*m[1].tau0^3) -
     * m[1].ge.N*Int(D(m[1].wheel))/(2*m[1].tau0^3)) */
    const real w6_product_2 = w6_sum_2 * (c->scaled_one_over_tau0_3 * w6_change_2
            - c->scaled_N_over_tau0_3 * w6_change);

    /* a product */
    const real w6_product_3 = w6_tanh_x * w6_sum * w6_sum * w6_sum_2;

    /* r2_w6: stage 3 */
    const real w6_u3 = c->r2_w6_product_2 * w6_product_3 - c->r2_w5_product * w6_product
        - c->r2_w6_product * w6_product_2;
    const real w6_y3 = x->r2_w6_s3 + w1_b * w6_u3;
    x->r2_w6_s3 = w1_a * w6_y3 + w1_b * w6_u3;

    /* r2_w6: stage 2 */
    const real w6_u2 = w6_y3;
    const real w6_y2 = x->r2_w6_s2 + w1_b * w6_u2;
    x->r2_w6_s2 = w1_a * w6_y2 + w1_b * w6_u2;

    /* r2_w6: stage 1 */
    const real w6_u1 = w6_y2;
    const real w6_y1 = x->r2_w6_s1 + w1_b * w6_u1;
    x->r2_w6_s1 = w1_a * w6_y1 + w1_b * w6_u1;

    /* second order of what the tolerance of m[1].tau0 can do */
    const real w6 = w6_y1;

    return w6;
}

/* r2 on one sample.
 * khepera_encoders.bg:31: r2: how far r2 can be from zero if no parameter is out of tolerance */
static void bound_r2(
    const khepera_encoders_threshold_coefficients *c, khepera_encoders_threshold_memory *x, const khepera_encoders_samples *s, real *r)
{
    const bool first = x->youngest == 0u && x->age[1] == 0u;
    const khepera_encoders_threshold_encoders *e = &x->e;

    count_on(&x->e.m__1__motor_r2, s->m__1__motor, first);
    count_on(&x->e.m__1__wheel_r2, s->m__1__wheel, first);

    if (first) {
        /* nothing is remembered yet */
        x->r2_w1_s3 = REAL(0.0);
        x->r2_w1_s2 = REAL(0.0);
        x->r2_w1_s1 = REAL(0.0);
    }

    /* r2_w1: a stage of the filter; on the first sample it is at rest */
    const real w1_a = first ? -c->b : c->a;
    const real w1_b = first ? REAL(1.0) : c->b;

    const real w1 = bound_r2_w1(c, x, first, w1_a, w1_b);
    const real w2 = bound_r2_w2(c, x, first, w1_a, w1_b);
    const real w3 = bound_r2_w3(c, x, first, w1_a, w1_b);
    const real w4 = bound_r2_w4(c, x, first, w1_a, w1_b);
    const real w5 = bound_r2_w5(c, x, first, w1_a, w1_b);

    if (first) {
        /* nothing is remembered yet */
        x->r2_w6_s3 = REAL(0.0);
        x->r2_w6_s2 = REAL(0.0);
        x->r2_w6_s1 = REAL(0.0);
    }

    /* m[1].wheel */
    const real w6_m__1__wheel = c->m__1__wheel__int__x0
        + REAL(9.587379924285257e-05) * (real)e->m__1__wheel_r2.total;

    if (first) {
        /* change of D(m[1].wheel) */
        x->r2_w6_start = w6_m__1__wheel;
    }

    /* change of D(m[1].wheel) */
    const real w6_change = w6_m__1__wheel - x->r2_w6_start;

    /* m[1].motor */
    const real w6_m__1__motor = c->m__1__motor__int__x0
        + REAL(0.0015339807878856412) * (real)e->m__1__motor_r2.total;

    const real w6 = bound_r2_w6(c, x, first, w1_a, w1_b, w6_change, w6_m__1__motor);

    r[KHEPERA_ENCODERS_R2] = MATH(fabs)(w1) + MATH(fabs)(w2) + MATH(fabs)(w3) + MATH(fabs)(w4)
        + MATH(fabs)(w5) + MATH(fabs)(w6);
}

/* a stage of the filter; on the first sample it is at rest; filtered speed of m[2].motor */
static void bound_r3_w1_a_to_w1_m__2__motor_speed_2(const khepera_encoders_threshold_coefficients
            *c,
        khepera_encoders_threshold_memory *x, bool first, real *w1_a_out, real *w1_b_out,
        real *w1_m__2__motor_speed_2_out)
{
    const khepera_encoders_threshold_encoders *e = &x->e;

    if (first) {
        /* nothing is remembered yet */
        x->r3_w1_m__2__motor_speed = REAL(0.0);
        x->r3_w1_s4 = REAL(0.0);
        x->r3_w1_s3 = REAL(0.0);
        x->r3_w1_s2 = REAL(0.0);
        x->r3_w1_s1 = REAL(0.0);
    }

    /* r3_w1: a stage of the filter; on the first sample it is at rest */
    const real w1_a = first ? -c->b : c->a;
    const real w1_b = first ? REAL(1.0) : c->b;

    /* filtered speed of m[2].motor */
    const real w1_m__2__motor_speed_2 = c->a * x->r3_w1_m__2__motor_speed
        + c->m__1__motor_gain * (real)e->m__2__motor_r3.increment;
    x->r3_w1_m__2__motor_speed = w1_m__2__motor_speed_2;

    *w1_a_out = w1_a;
    *w1_b_out = w1_b;
    *w1_m__2__motor_speed_2_out = w1_m__2__motor_speed_2;
}

/* what the tolerance of m[2].fe can do */
static real bound_r3_w1(const khepera_encoders_threshold_coefficients *c,
        khepera_encoders_threshold_memory *x, real w1_a, real w1_b, real w1_m__2__motor_speed_2)
{
    /* r3_w1: encoders, order 1 */
    const real w1_n1 = -c->r3_w1_w1_m__2__motor * w1_m__2__motor_speed_2;

    /* r3_w1: error of order 1 */
    const real w1_e1 = c->bend1 * w1_n1;

    /* r3_w1: encoders, order 2 */
    const real w1_n2 = -c->r3_w1_w2_m__2__motor * w1_m__2__motor_speed_2;

    /* r3_w1: degree 1 */
    const real w1_d1 = w1_n1 + w1_n2;

    /* r3_w1: degree 2 */
    const real w1_d2 = w1_n2 - w1_e1;

    /* r3_w1: the filter multiplied out */
    const real w1_p2_1 = w1_d2 + w1_e1;
    const real w1_p1_1 = w1_p2_1 + w1_e1;
    const real w1_p1_2 = w1_d1 - w1_p2_1;

    /* r3_w1: stage 4 */
    const real w1_u4 = w1_n1 - w1_p1_2;
    const real w1_y4 = x->r3_w1_s4 + w1_b * w1_u4;
    x->r3_w1_s4 = w1_a * w1_y4 + w1_b * w1_u4;

    /* r3_w1: stage 3 */
    const real w1_u3 = w1_y4 + w1_p1_2 - w1_p1_1;
    const real w1_y3 = x->r3_w1_s3 + w1_b * w1_u3;
    x->r3_w1_s3 = w1_a * w1_y3 + w1_b * w1_u3;

    /* r3_w1: stage 2 */
    const real w1_u2 = w1_y3 + w1_p1_1 + w1_e1;
    const real w1_y2 = x->r3_w1_s2 + w1_b * w1_u2;
    x->r3_w1_s2 = w1_a * w1_y2 + w1_b * w1_u2;

    /* r3_w1: stage 1 */
    const real w1_u1 = w1_y2 - w1_e1;
    const real w1_y1 = x->r3_w1_s1 + w1_b * w1_u1;
    x->r3_w1_s1 = w1_a * w1_y1 + w1_b * w1_u1;

    /* what the tolerance of m[2].fe can do */
    const real w1 = w1_y1;

    return w1;
}

/* filtered speed of m[2].wheel */
static real bound_r3_w2_m__2__wheel_speed_2(const khepera_encoders_threshold_coefficients *c,
        khepera_encoders_threshold_memory *x, bool first)
{
    const khepera_encoders_threshold_encoders *e = &x->e;

    if (first) {
        /* nothing is remembered yet */
        x->r3_w2_m__2__wheel_speed = REAL(0.0);
        x->r3_w2_s4 = REAL(0.0);
        x->r3_w2_s3 = REAL(0.0);
        x->r3_w2_s2 = REAL(0.0);
        x->r3_w2_s1 = REAL(0.0);
    }

    /* filtered speed of m[2].wheel */
    const real w2_m__2__wheel_speed_2 = c->a * x->r3_w2_m__2__wheel_speed
        + c->m__1__wheel_gain * (real)e->m__2__wheel_r3.increment;
    x->r3_w2_m__2__wheel_speed = w2_m__2__wheel_speed_2;

    return w2_m__2__wheel_speed_2;
}

/* what the tolerance of m[2].Js can do */
static real bound_r3_w2(const khepera_encoders_threshold_coefficients *c,
        khepera_encoders_threshold_memory *x, real w1_a, real w1_b, real w2_m__2__wheel_speed_2)
{
    /* r3_w2: encoders, order 2 */
    const real w2_n2 = -c->r3_w2_w2_m__2__wheel * w2_m__2__wheel_speed_2;

    /* r3_w2: error of order 2 */
    const real w2_e2 = c->bend1 * w2_n2;

    /* r3_w2: encoders, order 3 */
    const real w2_n3 = -c->r3_w2_w3_m__2__wheel * w2_m__2__wheel_speed_2;

    /* r3_w2: degree 2 */
    const real w2_d2 = w2_n2 + w2_n3;

    /* r3_w2: degree 3 */
    const real w2_d3 = w2_n3 - w2_e2;

    /* r3_w2: the filter multiplied out */
    const real w2_p3_1 = w2_d3 + w2_e2;
    const real w2_p2_1 = w2_p3_1 + w2_e2;
    const real w2_p2_2 = w2_d2 - w2_p3_1;
    const real w2_p1_1 = w2_p2_1 + w2_e2;
    const real w2_p1_2 = w2_p2_2 - w2_p2_1;
    const real w2_p1_3 = w2_n2 - w2_p2_2;

    /* r3_w2: stage 4 */
    const real w2_u4 = -w2_p1_3;
    const real w2_y4 = x->r3_w2_s4 + w1_b * w2_u4;
    x->r3_w2_s4 = w1_a * w2_y4 + w1_b * w2_u4;

    /* r3_w2: stage 3 */
    const real w2_u3 = w2_y4 + w2_p1_3 - w2_p1_2;
    const real w2_y3 = x->r3_w2_s3 + w1_b * w2_u3;
    x->r3_w2_s3 = w1_a * w2_y3 + w1_b * w2_u3;

    /* r3_w2: stage 2 */
    const real w2_u2 = w2_y3 + w2_p1_2 - w2_p1_1;
    const real w2_y2 = x->r3_w2_s2 + w1_b * w2_u2;
    x->r3_w2_s2 = w1_a * w2_y2 + w1_b * w2_u2;

    /* r3_w2: stage 1 */
    const real w2_u1 = w2_y2 + w2_p1_1 + w2_e2;
    const real w2_y1 = x->r3_w2_s1 + w1_b * w2_u1;
    x->r3_w2_s1 = w1_a * w2_y1 + w1_b * w2_u1;

    /* what the tolerance of m[2].Js can do */
    const real w2 = w2_y1 - w2_e2;

    return w2;
}

/* filtered speed of m[2].wheel */
static real bound_r3_w3_m__2__wheel_speed_2(const khepera_encoders_threshold_coefficients *c,
        khepera_encoders_threshold_memory *x, bool first)
{
    const khepera_encoders_threshold_encoders *e = &x->e;

    if (first) {
        /* nothing is remembered yet */
        x->r3_w3_m__2__wheel_speed = REAL(0.0);
        x->r3_w3_s4 = REAL(0.0);
        x->r3_w3_s3 = REAL(0.0);
        x->r3_w3_s2 = REAL(0.0);
        x->r3_w3_s1 = REAL(0.0);
    }

    /* filtered speed of m[2].wheel */
    const real w3_m__2__wheel_speed_2 = c->a * x->r3_w3_m__2__wheel_speed
        + c->m__1__wheel_gain * (real)e->m__2__wheel_r3.increment;
    x->r3_w3_m__2__wheel_speed = w3_m__2__wheel_speed_2;

    return w3_m__2__wheel_speed_2;
}

/* what the tolerance of m[2].fs can do */
static real bound_r3_w3(const khepera_encoders_threshold_coefficients *c,
        khepera_encoders_threshold_memory *x, real w1_a, real w1_b, real w3_m__2__wheel_speed_2)
{
    /* r3_w3: encoders, order 1 */
    const real w3_n1 = -c->r3_w3_w1_m__2__wheel * w3_m__2__wheel_speed_2;

    /* r3_w3: error of order 1 */
    const real w3_e1 = c->bend1 * w3_n1;

    /* r3_w3: encoders, order 2 */
    const real w3_n2 = -c->r3_w3_w2_m__2__wheel * w3_m__2__wheel_speed_2;

    /* r3_w3: degree 1 */
    const real w3_d1 = w3_n1 + w3_n2;

    /* r3_w3: degree 2 */
    const real w3_d2 = w3_n2 - w3_e1;

    /* r3_w3: the filter multiplied out */
    const real w3_p2_1 = w3_d2 + w3_e1;
    const real w3_p1_1 = w3_p2_1 + w3_e1;
    const real w3_p1_2 = w3_d1 - w3_p2_1;

    /* r3_w3: stage 4 */
    const real w3_u4 = w3_n1 - w3_p1_2;
    const real w3_y4 = x->r3_w3_s4 + w1_b * w3_u4;
    x->r3_w3_s4 = w1_a * w3_y4 + w1_b * w3_u4;

    /* r3_w3: stage 3 */
    const real w3_u3 = w3_y4 + w3_p1_2 - w3_p1_1;
    const real w3_y3 = x->r3_w3_s3 + w1_b * w3_u3;
    x->r3_w3_s3 = w1_a * w3_y3 + w1_b * w3_u3;

    /* r3_w3: stage 2 */
    const real w3_u2 = w3_y3 + w3_p1_1 + w3_e1;
    const real w3_y2 = x->r3_w3_s2 + w1_b * w3_u2;
    x->r3_w3_s2 = w1_a * w3_y2 + w1_b * w3_u2;

    /* r3_w3: stage 1 */
    const real w3_u1 = w3_y2 - w3_e1;
    const real w3_y1 = x->r3_w3_s1 + w1_b * w3_u1;
    x->r3_w3_s1 = w1_a * w3_y1 + w1_b * w3_u1;

    /* what the tolerance of m[2].fs can do */
    const real w3 = w3_y1;

    return w3;
}

/* filtered speed of m[2].wheel */
static real bound_r3_w4_m__2__wheel_speed_2(const khepera_encoders_threshold_coefficients *c,
        khepera_encoders_threshold_memory *x, bool first)
{
    const khepera_encoders_threshold_encoders *e = &x->e;

    if (first) {
        /* nothing is remembered yet */
        x->r3_w4_m__2__wheel_speed = REAL(0.0);
        x->r3_w4_m__2__motor_speed = REAL(0.0);
        x->r3_w4_s4 = REAL(0.0);
        x->r3_w4_s3 = REAL(0.0);
        x->r3_w4_s2 = REAL(0.0);
        x->r3_w4_s1 = REAL(0.0);
    }

    /* filtered speed of m[2].wheel */
    const real w4_m__2__wheel_speed_2 = c->a * x->r3_w4_m__2__wheel_speed
        + c->m__1__wheel_gain * (real)e->m__2__wheel_r3.increment;
    x->r3_w4_m__2__wheel_speed = w4_m__2__wheel_speed_2;

    return w4_m__2__wheel_speed_2;
}

/* stage 1 */
static real bound_r3_w4_y1(const khepera_encoders_threshold_coefficients *c,
        khepera_encoders_threshold_memory *x, const khepera_encoders_samples *s, real w1_a,
        real w1_b, real w4_m__2__wheel_speed_2)
{
    const khepera_encoders_threshold_encoders *e = &x->e;

    /* filtered speed of m[2].motor */
    const real w4_m__2__motor_speed_2 = c->a * x->r3_w4_m__2__motor_speed
        + c->m__1__motor_gain * (real)e->m__2__motor_r3.increment;
    x->r3_w4_m__2__motor_speed = w4_m__2__motor_speed_2;

    /* r3_w4: encoders, order 1 */
    const real w4_n1 = -c->r3_w4_w1_m__2__wheel * w4_m__2__wheel_speed_2
        - c->r3_w4_w1_m__2__motor * w4_m__2__motor_speed_2;

    /* r3_w4: error of order 1 */
    const real w4_e1 = c->bend1 * w4_n1;

    /* r3_w4: encoders, order 2 */
    const real w4_n2 = -c->r3_w4_w2_m__2__wheel * w4_m__2__wheel_speed_2
        - c->r3_w4_w2_m__2__motor * w4_m__2__motor_speed_2;

    /* r3_w4: terms of order 0 */
    const real w4_g0 = c->r3_w4_Fx__2 * s->Fx__2;

    /* r3_w4: degree 1 */
    const real w4_d1 = w4_n1 + w4_n2;

    /* r3_w4: error of order 0 */
    const real w4_e0 = c->bend2 * w4_g0;

    /* r3_w4: degree 2 */
    const real w4_d2 = w4_n2 + w4_e0 - w4_e1;

    /* r3_w4: the filter multiplied out */
    const real w4_p2_1 = w4_d2 + w4_e1;
    const real w4_p1_1 = w4_p2_1 + w4_e1;
    const real w4_p1_2 = w4_d1 - w4_p2_1;

    /* r3_w4: stage 4 */
    const real w4_u4 = w4_n1 - w4_g0 - w4_p1_2;
    const real w4_y4 = x->r3_w4_s4 + w1_b * w4_u4;
    x->r3_w4_s4 = w1_a * w4_y4 + w1_b * w4_u4;

    /* r3_w4: stage 3 */
    const real w4_u3 = w4_y4 + w4_p1_2 - w4_p1_1;
    const real w4_y3 = x->r3_w4_s3 + w1_b * w4_u3;
    x->r3_w4_s3 = w1_a * w4_y3 + w1_b * w4_u3;

    /* r3_w4: stage 2 */
    const real w4_u2 = w4_y3 + w4_p1_1 + w4_e1;
    const real w4_y2 = x->r3_w4_s2 + w1_b * w4_u2;
    x->r3_w4_s2 = w1_a * w4_y2 + w1_b * w4_u2;

    /* r3_w4: stage 1 */
    const real w4_u1 = w4_y2 - w4_e1;
    const real w4_y1 = x->r3_w4_s1 + w1_b * w4_u1;
    x->r3_w4_s1 = w1_a * w4_y1 + w1_b * w4_u1;

    return w4_y1;
}

/* encoders, order 1; ...; encoders, order 3 */
static void bound_r3_w5_n1_to_w5_n3(const khepera_encoders_threshold_coefficients *c,
        khepera_encoders_threshold_memory *x, bool first, real *w5_n1_out, real *w5_e1_out,
        real *w5_n2_out, real *w5_e2_out, real *w5_n3_out)
{
    const khepera_encoders_threshold_encoders *e = &x->e;

    if (first) {
        /* nothing is remembered yet */
        x->r3_w5_m__2__motor_speed = REAL(0.0);
        x->r3_w5_m__2__wheel_speed = REAL(0.0);
        x->r3_w5_s4 = REAL(0.0);
        x->r3_w5_s3 = REAL(0.0);
        x->r3_w5_s2 = REAL(0.0);
        x->r3_w5_s1 = REAL(0.0);
    }

    /* filtered speed of m[2].motor */
    const real w5_m__2__motor_speed_2 = c->a * x->r3_w5_m__2__motor_speed
        + c->m__1__motor_gain * (real)e->m__2__motor_r3.increment;
    x->r3_w5_m__2__motor_speed = w5_m__2__motor_speed_2;

    /* filtered speed of m[2].wheel */
    const real w5_m__2__wheel_speed_2 = c->a * x->r3_w5_m__2__wheel_speed
        + c->m__1__wheel_gain * (real)e->m__2__wheel_r3.increment;
    x->r3_w5_m__2__wheel_speed = w5_m__2__wheel_speed_2;

    /* r3_w5: encoders, order 1 */
    const real w5_n1 = c->r3_w5_w1_m__2__motor * w5_m__2__motor_speed_2
        + c->r3_w5_w1_m__2__wheel * w5_m__2__wheel_speed_2;

    /* r3_w5: error of order 1 */
    const real w5_e1 = c->bend2 * w5_n1;

    /* r3_w5: encoders, order 2 */
    const real w5_n2 = c->r3_w5_w2_m__2__motor * w5_m__2__motor_speed_2
        + c->r3_w5_w2_m__2__wheel * w5_m__2__wheel_speed_2;

    /* r3_w5: error of order 2 */
    const real w5_e2 = c->bend1 * w5_n2;

    /* r3_w5: encoders, order 3 */
    const real w5_n3 = c->r3_w5_w3_m__2__motor * w5_m__2__motor_speed_2
        + c->r3_w2_w3_m__2__wheel * w5_m__2__wheel_speed_2;

    *w5_n1_out = w5_n1;
    *w5_e1_out = w5_e1;
    *w5_n2_out = w5_n2;
    *w5_e2_out = w5_e2;
    *w5_n3_out = w5_n3;
}

/* what the tolerance of m[2].el.k can do */
static real bound_r3_w5(const khepera_encoders_threshold_coefficients *c,
        khepera_encoders_threshold_memory *x, const khepera_encoders_samples *s, real w1_a,
        real w1_b, real w5_n1, real w5_e1, real w5_n2, real w5_e2, real w5_n3)
{
    /* r3_w5: terms of order 0 */
    const real w5_g0 = c->r3_w5_Fx__2 * s->Fx__2;

    /* r3_w5: terms of order 1 */
    const real w5_g1 = c->r3_w5_w1_Fx__2 * s->Fx__2;

    /* r3_w5: degree 1 */
    const real w5_d1 = w5_g1 + w5_n1 + w5_n2;

    /* r3_w5: error of order 0 */
    const real w5_e0 = c->bend3 * w5_g0;

    /* r3_w5: degree 2 */
    const real w5_d2 = w5_n2 + w5_n3 - w5_e1 - w5_e0;

    /* r3_w5: error of order 1 */
    const real w5_e1_2 = c->bend2 * w5_g1;

    /* r3_w5: degree 3 */
    const real w5_d3 = w5_n3 - w5_e1 - w5_e2 - w5_e1_2;

    /* r3_w5: the filter multiplied out */
    const real w5_p3_1 = w5_d3 + w5_e2;
    const real w5_p2_1 = w5_p3_1 + w5_e2;
    const real w5_p2_2 = w5_d2 - w5_p3_1;
    const real w5_p1_1 = w5_p2_1 + w5_e2;
    const real w5_p1_2 = w5_p2_2 - w5_p2_1;
    const real w5_p1_3 = w5_d1 - w5_p2_2;

    /* r3_w5: stage 4 */
    const real w5_u4 = w5_g0 + w5_n1 - w5_p1_3;
    const real w5_y4 = x->r3_w5_s4 + w1_b * w5_u4;
    x->r3_w5_s4 = w1_a * w5_y4 + w1_b * w5_u4;

    /* r3_w5: stage 3 */
    const real w5_u3 = w5_y4 + w5_p1_3 - w5_p1_2;
    const real w5_y3 = x->r3_w5_s3 + w1_b * w5_u3;
    x->r3_w5_s3 = w1_a * w5_y3 + w1_b * w5_u3;

    /* r3_w5: stage 2 */
    const real w5_u2 = w5_y3 + w5_p1_2 - w5_p1_1;
    const real w5_y2 = x->r3_w5_s2 + w1_b * w5_u2;
    x->r3_w5_s2 = w1_a * w5_y2 + w1_b * w5_u2;

    /* r3_w5: stage 1 */
    const real w5_u1 = w5_y2 + w5_p1_1 + w5_e2;
    const real w5_y1 = x->r3_w5_s1 + w1_b * w5_u1;
    x->r3_w5_s1 = w1_a * w5_y1 + w1_b * w5_u1;

    /* what the tolerance of m[2].el.k can do */
    const real w5 = w5_y1 - w5_e2;

    return w5;
}

/* what the tolerances of m[2].fe and m[2].el.Re can do together */
static real bound_r3_w6(const khepera_encoders_threshold_coefficients *c,
        khepera_encoders_threshold_memory *x, bool first, real w1_a, real w1_b)
{
    const khepera_encoders_threshold_encoders *e = &x->e;

    if (first) {
        /* nothing is remembered yet */
        x->r3_w6_m__2__motor_speed = REAL(0.0);
        x->r3_w6_s4 = REAL(0.0);
        x->r3_w6_s3 = REAL(0.0);
        x->r3_w6_s2 = REAL(0.0);
        x->r3_w6_s1 = REAL(0.0);
    }

    /* filtered speed of m[2].motor */
    const real w6_m__2__motor_speed_2 = c->a * x->r3_w6_m__2__motor_speed
        + c->m__1__motor_gain * (real)e->m__2__motor_r3.increment;
    x->r3_w6_m__2__motor_speed = w6_m__2__motor_speed_2;

    /* r3_w6: encoders, order 1 */
    const real w6_n1 = -c->r3_w6_w1_m__2__motor * w6_m__2__motor_speed_2;

    /* r3_w6: stage 4 */
    const real w6_u4 = w6_n1 - w6_n1;
    const real w6_y4 = x->r3_w6_s4 + w1_b * w6_u4;
    x->r3_w6_s4 = w1_a * w6_y4 + w1_b * w6_u4;

    /* r3_w6: stage 3 */
    const real w6_u3 = w6_y4 + w6_n1;
    const real w6_y3 = x->r3_w6_s3 + w1_b * w6_u3;
    x->r3_w6_s3 = w1_a * w6_y3 + w1_b * w6_u3;

    /* r3_w6: stage 2 */
    const real w6_u2 = w6_y3;
    const real w6_y2 = x->r3_w6_s2 + w1_b * w6_u2;
    x->r3_w6_s2 = w1_a * w6_y2 + w1_b * w6_u2;

    /* r3_w6: stage 1 */
    const real w6_u1 = w6_y2;
    const real w6_y1 = x->r3_w6_s1 + w1_b * w6_u1;
    x->r3_w6_s1 = w1_a * w6_y1 + w1_b * w6_u1;

    /* what the tolerances of m[2].fe and m[2].el.Re can do together */
    const real w6 = w6_y1;

    if (first) {
        /* nothing is remembered yet */
        x->r3_w7_m__2__motor_speed = REAL(0.0);
        x->r3_w7_s4 = REAL(0.0);
        x->r3_w7_s3 = REAL(0.0);
        x->r3_w7_s2 = REAL(0.0);
        x->r3_w7_s1 = REAL(0.0);
    }

    return w6;
}

/* what the tolerances of m[2].fe and m[2].el.k can do together */
static real bound_r3_w7(const khepera_encoders_threshold_coefficients *c,
        khepera_encoders_threshold_memory *x, real w1_a, real w1_b)
{
    const khepera_encoders_threshold_encoders *e = &x->e;

    /* filtered speed of m[2].motor */
    const real w7_m__2__motor_speed_2 = c->a * x->r3_w7_m__2__motor_speed
        + c->m__1__motor_gain * (real)e->m__2__motor_r3.increment;
    x->r3_w7_m__2__motor_speed = w7_m__2__motor_speed_2;

    /* r3_w7: encoders, order 1 */
    const real w7_n1 = c->r3_w7_w1_m__2__motor * w7_m__2__motor_speed_2;

    /* r3_w7: error of order 1 */
    const real w7_e1 = c->bend1 * w7_n1;

    /* r3_w7: encoders, order 2 */
    const real w7_n2 = c->r3_w7_w2_m__2__motor * w7_m__2__motor_speed_2;

    /* r3_w7: degree 1 */
    const real w7_d1 = w7_n1 + w7_n2;

    /* r3_w7: degree 2 */
    const real w7_d2 = w7_n2 - w7_e1;

    /* r3_w7: the filter multiplied out */
    const real w7_p2_1 = w7_d2 + w7_e1;
    const real w7_p1_1 = w7_p2_1 + w7_e1;
    const real w7_p1_2 = w7_d1 - w7_p2_1;

    /* r3_w7: stage 4 */
    const real w7_u4 = w7_n1 - w7_p1_2;
    const real w7_y4 = x->r3_w7_s4 + w1_b * w7_u4;
    x->r3_w7_s4 = w1_a * w7_y4 + w1_b * w7_u4;

    /* r3_w7: stage 3 */
    const real w7_u3 = w7_y4 + w7_p1_2 - w7_p1_1;
    const real w7_y3 = x->r3_w7_s3 + w1_b * w7_u3;
    x->r3_w7_s3 = w1_a * w7_y3 + w1_b * w7_u3;

    /* r3_w7: stage 2 */
    const real w7_u2 = w7_y3 + w7_p1_1 + w7_e1;
    const real w7_y2 = x->r3_w7_s2 + w1_b * w7_u2;
    x->r3_w7_s2 = w1_a * w7_y2 + w1_b * w7_u2;

    /* r3_w7: stage 1 */
    const real w7_u1 = w7_y2 - w7_e1;
    const real w7_y1 = x->r3_w7_s1 + w1_b * w7_u1;
    x->r3_w7_s1 = w1_a * w7_y1 + w1_b * w7_u1;

    /* what the tolerances of m[2].fe and m[2].el.k can do together */
    const real w7 = w7_y1;

    return w7;
}

/* what the tolerances of m[2].Js and m[2].el.Re can do together */
static real bound_r3_w8(const khepera_encoders_threshold_coefficients *c,
        khepera_encoders_threshold_memory *x, bool first, real w1_a, real w1_b)
{
    const khepera_encoders_threshold_encoders *e = &x->e;

    if (first) {
        /* nothing is remembered yet */
        x->r3_w8_m__2__wheel_speed = REAL(0.0);
        x->r3_w8_s4 = REAL(0.0);
        x->r3_w8_s3 = REAL(0.0);
        x->r3_w8_s2 = REAL(0.0);
        x->r3_w8_s1 = REAL(0.0);
    }

    /* filtered speed of m[2].wheel */
    const real w8_m__2__wheel_speed_2 = c->a * x->r3_w8_m__2__wheel_speed
        + c->m__1__wheel_gain * (real)e->m__2__wheel_r3.increment;
    x->r3_w8_m__2__wheel_speed = w8_m__2__wheel_speed_2;

    /* r3_w8: encoders, order 2 */
    const real w8_n2 = -c->r3_w8_w2_m__2__wheel * w8_m__2__wheel_speed_2;

    /* r3_w8: the filter multiplied out */
    const real w8_p1_1 = w8_n2 - w8_n2;

    /* r3_w8: stage 4 */
    const real w8_u4 = -w8_p1_1;
    const real w8_y4 = x->r3_w8_s4 + w1_b * w8_u4;
    x->r3_w8_s4 = w1_a * w8_y4 + w1_b * w8_u4;

    /* r3_w8: stage 3 */
    const real w8_u3 = w8_y4 + w8_p1_1 - w8_n2;
    const real w8_y3 = x->r3_w8_s3 + w1_b * w8_u3;
    x->r3_w8_s3 = w1_a * w8_y3 + w1_b * w8_u3;

    /* r3_w8: stage 2 */
    const real w8_u2 = w8_y3 + w8_n2;
    const real w8_y2 = x->r3_w8_s2 + w1_b * w8_u2;
    x->r3_w8_s2 = w1_a * w8_y2 + w1_b * w8_u2;

    /* r3_w8: stage 1 */
    const real w8_u1 = w8_y2;
    const real w8_y1 = x->r3_w8_s1 + w1_b * w8_u1;
    x->r3_w8_s1 = w1_a * w8_y1 + w1_b * w8_u1;

    /* what the tolerances of m[2].Js and m[2].el.Re can do together */
    const real w8 = w8_y1;

    if (first) {
        /* nothing is remembered yet */
        x->r3_w9_m__2__wheel_speed = REAL(0.0);
        x->r3_w9_s4 = REAL(0.0);
        x->r3_w9_s3 = REAL(0.0);
        x->r3_w9_s2 = REAL(0.0);
        x->r3_w9_s1 = REAL(0.0);
    }

    return w8;
}

/* what the tolerances of m[2].Js and m[2].el.k can do together */
static real bound_r3_w9(const khepera_encoders_threshold_coefficients *c,
        khepera_encoders_threshold_memory *x, real w1_a, real w1_b)
{
    const khepera_encoders_threshold_encoders *e = &x->e;

    /* filtered speed of m[2].wheel */
    const real w9_m__2__wheel_speed_2 = c->a * x->r3_w9_m__2__wheel_speed
        + c->m__1__wheel_gain * (real)e->m__2__wheel_r3.increment;
    x->r3_w9_m__2__wheel_speed = w9_m__2__wheel_speed_2;

    /* r3_w9: encoders, order 2 */
    const real w9_n2 = c->r3_w9_w2_m__2__wheel * w9_m__2__wheel_speed_2;

    /* r3_w9: error of order 2 */
    const real w9_e2 = c->bend1 * w9_n2;

    /* r3_w9: encoders, order 3 */
    const real w9_n3 = c->r3_w9_w3_m__2__wheel * w9_m__2__wheel_speed_2;

    /* r3_w9: degree 2 */
    const real w9_d2 = w9_n2 + w9_n3;

    /* r3_w9: degree 3 */
    const real w9_d3 = w9_n3 - w9_e2;

    /* r3_w9: the filter multiplied out */
    const real w9_p3_1 = w9_d3 + w9_e2;
    const real w9_p2_1 = w9_p3_1 + w9_e2;
    const real w9_p2_2 = w9_d2 - w9_p3_1;
    const real w9_p1_1 = w9_p2_1 + w9_e2;
    const real w9_p1_2 = w9_p2_2 - w9_p2_1;
    const real w9_p1_3 = w9_n2 - w9_p2_2;

    /* r3_w9: stage 4 */
    const real w9_u4 = -w9_p1_3;
    const real w9_y4 = x->r3_w9_s4 + w1_b * w9_u4;
    x->r3_w9_s4 = w1_a * w9_y4 + w1_b * w9_u4;

    /* r3_w9: stage 3 */
    const real w9_u3 = w9_y4 + w9_p1_3 - w9_p1_2;
    const real w9_y3 = x->r3_w9_s3 + w1_b * w9_u3;
    x->r3_w9_s3 = w1_a * w9_y3 + w1_b * w9_u3;

    /* r3_w9: stage 2 */
    const real w9_u2 = w9_y3 + w9_p1_2 - w9_p1_1;
    const real w9_y2 = x->r3_w9_s2 + w1_b * w9_u2;
    x->r3_w9_s2 = w1_a * w9_y2 + w1_b * w9_u2;

    /* r3_w9: stage 1 */
    const real w9_u1 = w9_y2 + w9_p1_1 + w9_e2;
    const real w9_y1 = x->r3_w9_s1 + w1_b * w9_u1;
    x->r3_w9_s1 = w1_a * w9_y1 + w1_b * w9_u1;

    /* what the tolerances of m[2].Js and m[2].el.k can do together */
    const real w9 = w9_y1 - w9_e2;

    return w9;
}

/* what the tolerances of m[2].fs and m[2].el.Re can do together */
static real bound_r3_w10(const khepera_encoders_threshold_coefficients *c,
        khepera_encoders_threshold_memory *x, bool first, real w1_a, real w1_b)
{
    const khepera_encoders_threshold_encoders *e = &x->e;

    if (first) {
        /* nothing is remembered yet */
        x->r3_w10_m__2__wheel_speed = REAL(0.0);
        x->r3_w10_s4 = REAL(0.0);
        x->r3_w10_s3 = REAL(0.0);
        x->r3_w10_s2 = REAL(0.0);
        x->r3_w10_s1 = REAL(0.0);
    }

    /* filtered speed of m[2].wheel */
    const real w10_m__2__wheel_speed_2 = c->a * x->r3_w10_m__2__wheel_speed
        + c->m__1__wheel_gain * (real)e->m__2__wheel_r3.increment;
    x->r3_w10_m__2__wheel_speed = w10_m__2__wheel_speed_2;

    /* r3_w10: encoders, order 1 */
    const real w10_n1 = -c->r3_w10_w1_m__2__wheel * w10_m__2__wheel_speed_2;

    /* r3_w10: stage 4 */
    const real w10_u4 = w10_n1 - w10_n1;
    const real w10_y4 = x->r3_w10_s4 + w1_b * w10_u4;
    x->r3_w10_s4 = w1_a * w10_y4 + w1_b * w10_u4;

    /* r3_w10: stage 3 */
    const real w10_u3 = w10_y4 + w10_n1;
    const real w10_y3 = x->r3_w10_s3 + w1_b * w10_u3;
    x->r3_w10_s3 = w1_a * w10_y3 + w1_b * w10_u3;

    /* r3_w10: stage 2 */
    const real w10_u2 = w10_y3;
    const real w10_y2 = x->r3_w10_s2 + w1_b * w10_u2;
    x->r3_w10_s2 = w1_a * w10_y2 + w1_b * w10_u2;

    /* r3_w10: stage 1 */
    const real w10_u1 = w10_y2;
    const real w10_y1 = x->r3_w10_s1 + w1_b * w10_u1;
    x->r3_w10_s1 = w1_a * w10_y1 + w1_b * w10_u1;

    /* what the tolerances of m[2].fs and m[2].el.Re can do together */
    const real w10 = w10_y1;

    if (first) {
        /* nothing is remembered yet */
        x->r3_w11_m__2__wheel_speed = REAL(0.0);
        x->r3_w11_s4 = REAL(0.0);
        x->r3_w11_s3 = REAL(0.0);
        x->r3_w11_s2 = REAL(0.0);
        x->r3_w11_s1 = REAL(0.0);
    }

    return w10;
}

/* what the tolerances of m[2].fs and m[2].el.k can do together */
static real bound_r3_w11(const khepera_encoders_threshold_coefficients *c,
        khepera_encoders_threshold_memory *x, real w1_a, real w1_b)
{
    const khepera_encoders_threshold_encoders *e = &x->e;

    /* filtered speed of m[2].wheel */
    const real w11_m__2__wheel_speed_2 = c->a * x->r3_w11_m__2__wheel_speed
        + c->m__1__wheel_gain * (real)e->m__2__wheel_r3.increment;
    x->r3_w11_m__2__wheel_speed = w11_m__2__wheel_speed_2;

    /* r3_w11: encoders, order 1 */
    const real w11_n1 = c->r3_w11_w1_m__2__wheel * w11_m__2__wheel_speed_2;

    /* r3_w11: error of order 1 */
    const real w11_e1 = c->bend1 * w11_n1;

    /* r3_w11: encoders, order 2 */
    const real w11_n2 = c->r3_w11_w2_m__2__wheel * w11_m__2__wheel_speed_2;

    /* r3_w11: degree 1 */
    const real w11_d1 = w11_n1 + w11_n2;

    /* r3_w11: degree 2 */
    const real w11_d2 = w11_n2 - w11_e1;

    /* r3_w11: the filter multiplied out */
    const real w11_p2_1 = w11_d2 + w11_e1;
    const real w11_p1_1 = w11_p2_1 + w11_e1;
    const real w11_p1_2 = w11_d1 - w11_p2_1;

    /* r3_w11: stage 4 */
    const real w11_u4 = w11_n1 - w11_p1_2;
    const real w11_y4 = x->r3_w11_s4 + w1_b * w11_u4;
    x->r3_w11_s4 = w1_a * w11_y4 + w1_b * w11_u4;

    /* r3_w11: stage 3 */
    const real w11_u3 = w11_y4 + w11_p1_2 - w11_p1_1;
    const real w11_y3 = x->r3_w11_s3 + w1_b * w11_u3;
    x->r3_w11_s3 = w1_a * w11_y3 + w1_b * w11_u3;

    /* r3_w11: stage 2 */
    const real w11_u2 = w11_y3 + w11_p1_1 + w11_e1;
    const real w11_y2 = x->r3_w11_s2 + w1_b * w11_u2;
    x->r3_w11_s2 = w1_a * w11_y2 + w1_b * w11_u2;

    /* r3_w11: stage 1 */
    const real w11_u1 = w11_y2 - w11_e1;
    const real w11_y1 = x->r3_w11_s1 + w1_b * w11_u1;
    x->r3_w11_s1 = w1_a * w11_y1 + w1_b * w11_u1;

    /* what the tolerances of m[2].fs and m[2].el.k can do together */
    const real w11 = w11_y1;

    return w11;
}

/* filtered speed of m[2].motor */
static real bound_r3_w12_m__2__motor_speed_2(const khepera_encoders_threshold_coefficients *c,
        khepera_encoders_threshold_memory *x, bool first)
{
    const khepera_encoders_threshold_encoders *e = &x->e;

    if (first) {
        /* nothing is remembered yet */
        x->r3_w12_m__2__motor_speed = REAL(0.0);
        x->r3_w12_m__2__wheel_speed = REAL(0.0);
        x->r3_w12_s4 = REAL(0.0);
        x->r3_w12_s3 = REAL(0.0);
        x->r3_w12_s2 = REAL(0.0);
        x->r3_w12_s1 = REAL(0.0);
    }

    /* filtered speed of m[2].motor */
    const real w12_m__2__motor_speed_2 = c->a * x->r3_w12_m__2__motor_speed
        + c->m__1__motor_gain * (real)e->m__2__motor_r3.increment;
    x->r3_w12_m__2__motor_speed = w12_m__2__motor_speed_2;

    return w12_m__2__motor_speed_2;
}

/* stage 1 */
static real bound_r3_w12_y1(const khepera_encoders_threshold_coefficients *c,
        khepera_encoders_threshold_memory *x, const khepera_encoders_samples *s, real w1_a,
        real w1_b, real w12_m__2__motor_speed_2)
{
    const khepera_encoders_threshold_encoders *e = &x->e;

    /* filtered speed of m[2].wheel */
    const real w12_m__2__wheel_speed_2 = c->a * x->r3_w12_m__2__wheel_speed
        + c->m__1__wheel_gain * (real)e->m__2__wheel_r3.increment;
    x->r3_w12_m__2__wheel_speed = w12_m__2__wheel_speed_2;

    /* r3_w12: encoders, order 1 */
    const real w12_n1 = c->r3_w12_w1_m__2__motor * w12_m__2__motor_speed_2
        + c->r3_w12_w1_m__2__wheel * w12_m__2__wheel_speed_2;

    /* r3_w12: error of order 1 */
    const real w12_e1 = c->bend1 * w12_n1;

    /* r3_w12: encoders, order 2 */
    const real w12_n2 = c->r3_w12_w2_m__2__motor * w12_m__2__motor_speed_2
        + c->r3_w8_w2_m__2__wheel * w12_m__2__wheel_speed_2;

    /* r3_w12: terms of order 0 */
    const real w12_g0 = c->r3_w12_Fx__2 * s->Fx__2;

    /* r3_w12: degree 1 */
    const real w12_d1 = w12_n1 + w12_n2;

    /* r3_w12: error of order 0 */
    const real w12_e0 = c->bend2 * w12_g0;

    /* r3_w12: degree 2 */
    const real w12_d2 = w12_n2 - w12_e1 - w12_e0;

    /* r3_w12: the filter multiplied out */
    const real w12_p2_1 = w12_d2 + w12_e1;
    const real w12_p1_1 = w12_p2_1 + w12_e1;
    const real w12_p1_2 = w12_d1 - w12_p2_1;

    /* r3_w12: stage 4 */
    const real w12_u4 = w12_g0 + w12_n1 - w12_p1_2;
    const real w12_y4 = x->r3_w12_s4 + w1_b * w12_u4;
    x->r3_w12_s4 = w1_a * w12_y4 + w1_b * w12_u4;

    /* r3_w12: stage 3 */
    const real w12_u3 = w12_y4 + w12_p1_2 - w12_p1_1;
    const real w12_y3 = x->r3_w12_s3 + w1_b * w12_u3;
    x->r3_w12_s3 = w1_a * w12_y3 + w1_b * w12_u3;

    /* r3_w12: stage 2 */
    const real w12_u2 = w12_y3 + w12_p1_1 + w12_e1;
    const real w12_y2 = x->r3_w12_s2 + w1_b * w12_u2;
    x->r3_w12_s2 = w1_a * w12_y2 + w1_b * w12_u2;

    /* r3_w12: stage 1 */
    const real w12_u1 = w12_y2 - w12_e1;
    const real w12_y1 = x->r3_w12_s1 + w1_b * w12_u1;
    x->r3_w12_s1 = w1_a * w12_y1 + w1_b * w12_u1;

    return w12_y1;
}

/* encoders, order 1; ...; encoders, order 3 */
static void bound_r3_w13_n1_to_w13_n3(const khepera_encoders_threshold_coefficients *c,
        khepera_encoders_threshold_memory *x, bool first, real *w13_n1_out, real *w13_e1_out,
        real *w13_n2_out, real *w13_e2_out, real *w13_n3_out)
{
    const khepera_encoders_threshold_encoders *e = &x->e;

    if (first) {
        /* nothing is remembered yet */
        x->r3_w13_m__2__motor_speed = REAL(0.0);
        x->r3_w13_m__2__wheel_speed = REAL(0.0);
        x->r3_w13_s4 = REAL(0.0);
        x->r3_w13_s3 = REAL(0.0);
        x->r3_w13_s2 = REAL(0.0);
        x->r3_w13_s1 = REAL(0.0);
    }

    /* filtered speed of m[2].motor */
    const real w13_m__2__motor_speed_2 = c->a * x->r3_w13_m__2__motor_speed
        + c->m__1__motor_gain * (real)e->m__2__motor_r3.increment;
    x->r3_w13_m__2__motor_speed = w13_m__2__motor_speed_2;

    /* filtered speed of m[2].wheel */
    const real w13_m__2__wheel_speed_2 = c->a * x->r3_w13_m__2__wheel_speed
        + c->m__1__wheel_gain * (real)e->m__2__wheel_r3.increment;
    x->r3_w13_m__2__wheel_speed = w13_m__2__wheel_speed_2;

    /* r3_w13: encoders, order 1 */
    const real w13_n1 = -c->r3_w13_w1_m__2__motor * w13_m__2__motor_speed_2
        - c->r3_w13_w1_m__2__wheel * w13_m__2__wheel_speed_2;

    /* r3_w13: error of order 1 */
    const real w13_e1 = c->bend2 * w13_n1;

    /* r3_w13: encoders, order 2 */
    const real w13_n2 = c->r3_w13_w2_m__2__motor * w13_m__2__motor_speed_2
        + c->r3_w13_w2_m__2__wheel * w13_m__2__wheel_speed_2;

    /* r3_w13: error of order 2 */
    const real w13_e2 = c->bend1 * w13_n2;

    /* r3_w13: encoders, order 3 */
    const real w13_n3 = -c->r3_w13_w3_m__2__motor * w13_m__2__motor_speed_2
        - c->r3_w9_w3_m__2__wheel * w13_m__2__wheel_speed_2;

    *w13_n1_out = w13_n1;
    *w13_e1_out = w13_e1;
    *w13_n2_out = w13_n2;
    *w13_e2_out = w13_e2;
    *w13_n3_out = w13_n3;
}

/* second order of what the tolerance of m[2].el.k can do */
static real bound_r3_w13(const khepera_encoders_threshold_coefficients *c,
        khepera_encoders_threshold_memory *x, const khepera_encoders_samples *s, real w1_a,
        real w1_b, real w13_n1, real w13_e1, real w13_n2, real w13_e2, real w13_n3)
{
    /* r3_w13: terms of order 0 */
    const real w13_g0 = c->r3_w13_Fx__2 * s->Fx__2;

    /* r3_w13: terms of order 1 */
    const real w13_g1 = c->r3_w13_w1_Fx__2 * s->Fx__2;

    /* r3_w13: degree 1 */
    const real w13_d1 = w13_n1 + w13_n2 - w13_g1;

    /* r3_w13: error of order 0 */
    const real w13_e0 = c->bend3 * w13_g0;

    /* r3_w13: degree 2 */
    const real w13_d2 = w13_n2 + w13_n3 + w13_e0 - w13_e1;

    /* r3_w13: error of order 1 */
    const real w13_e1_2 = c->bend2 * w13_g1;

    /* r3_w13: degree 3 */
    const real w13_d3 = w13_n3 + w13_e1_2 - w13_e1 - w13_e2;

    /* r3_w13: the filter multiplied out */
    const real w13_p3_1 = w13_d3 + w13_e2;
    const real w13_p2_1 = w13_p3_1 + w13_e2;
    const real w13_p2_2 = w13_d2 - w13_p3_1;
    const real w13_p1_1 = w13_p2_1 + w13_e2;
    const real w13_p1_2 = w13_p2_2 - w13_p2_1;
    const real w13_p1_3 = w13_d1 - w13_p2_2;

    /* r3_w13: stage 4 */
    const real w13_u4 = w13_n1 - w13_g0 - w13_p1_3;
    const real w13_y4 = x->r3_w13_s4 + w1_b * w13_u4;
    x->r3_w13_s4 = w1_a * w13_y4 + w1_b * w13_u4;

    /* r3_w13: stage 3 */
    const real w13_u3 = w13_y4 + w13_p1_3 - w13_p1_2;
    const real w13_y3 = x->r3_w13_s3 + w1_b * w13_u3;
    x->r3_w13_s3 = w1_a * w13_y3 + w1_b * w13_u3;

    /* r3_w13: stage 2 */
    const real w13_u2 = w13_y3 + w13_p1_2 - w13_p1_1;
    const real w13_y2 = x->r3_w13_s2 + w1_b * w13_u2;
    x->r3_w13_s2 = w1_a * w13_y2 + w1_b * w13_u2;

    /* r3_w13: stage 1 */
    const real w13_u1 = w13_y2 + w13_p1_1 + w13_e2;
    const real w13_y1 = x->r3_w13_s1 + w1_b * w13_u1;
    x->r3_w13_s1 = w1_a * w13_y1 + w1_b * w13_u1;

    /* second order of what the tolerance of m[2].el.k can do */
    const real w13 = w13_y1 - w13_e2;

    return w13;
}

/* r3 on one sample.
 * khepera.bg:17: r3: how far r3 can be from zero if no parameter is out of tolerance */
static void bound_r3(
    const khepera_encoders_threshold_coefficients *c, khepera_encoders_threshold_memory *x, const khepera_encoders_samples *s, real *r)
{
    const bool first = x->youngest == 0u && x->age[2] == 0u;

    count_on(&x->e.m__2__motor_r3, s->m__2__motor, first);
    count_on(&x->e.m__2__wheel_r3, s->m__2__wheel, first);

    real w1_a;
    real w1_b;
    real w1_m__2__motor_speed_2;

    bound_r3_w1_a_to_w1_m__2__motor_speed_2(c, x, first, &w1_a, &w1_b, &w1_m__2__motor_speed_2);
    const real w1 = bound_r3_w1(c, x, w1_a, w1_b, w1_m__2__motor_speed_2);
    const real w2_m__2__wheel_speed_2 = bound_r3_w2_m__2__wheel_speed_2(c, x, first);
    const real w2 = bound_r3_w2(c, x, w1_a, w1_b, w2_m__2__wheel_speed_2);
    const real w3_m__2__wheel_speed_2 = bound_r3_w3_m__2__wheel_speed_2(c, x, first);
    const real w3 = bound_r3_w3(c, x, w1_a, w1_b, w3_m__2__wheel_speed_2);
    const real w4_m__2__wheel_speed_2 = bound_r3_w4_m__2__wheel_speed_2(c, x, first);
    const real w4_y1 = bound_r3_w4_y1(c, x, s, w1_a, w1_b, w4_m__2__wheel_speed_2);

    /* what the tolerance of m[2].el.Re can do */
    const real w4 = w4_y1;

    real w5_n1;
    real w5_e1;
    real w5_n2;
    real w5_e2;
    real w5_n3;

    bound_r3_w5_n1_to_w5_n3(c, x, first, &w5_n1, &w5_e1, &w5_n2, &w5_e2, &w5_n3);
    const real w5 = bound_r3_w5(c, x, s, w1_a, w1_b, w5_n1, w5_e1, w5_n2, w5_e2, w5_n3);
    const real w6 = bound_r3_w6(c, x, first, w1_a, w1_b);
    const real w7 = bound_r3_w7(c, x, w1_a, w1_b);
    const real w8 = bound_r3_w8(c, x, first, w1_a, w1_b);
    const real w9 = bound_r3_w9(c, x, w1_a, w1_b);
    const real w10 = bound_r3_w10(c, x, first, w1_a, w1_b);
    const real w11 = bound_r3_w11(c, x, w1_a, w1_b);
    const real w12_m__2__motor_speed_2 = bound_r3_w12_m__2__motor_speed_2(c, x, first);
    const real w12_y1 = bound_r3_w12_y1(c, x, s, w1_a, w1_b, w12_m__2__motor_speed_2);

    /* what the tolerances of m[2].el.Re and m[2].el.k can do together */
    const real w12 = w12_y1;

    real w13_n1;
    real w13_e1;
    real w13_n2;
    real w13_e2;
    real w13_n3;

    bound_r3_w13_n1_to_w13_n3(c, x, first, &w13_n1, &w13_e1, &w13_n2, &w13_e2, &w13_n3);
    const real w13 = bound_r3_w13(c, x, s, w1_a, w1_b, w13_n1, w13_e1, w13_n2, w13_e2, w13_n3);

    r[KHEPERA_ENCODERS_R3] = MATH(fabs)(w1) + MATH(fabs)(w2) + MATH(fabs)(w3) + MATH(fabs)(w4)
        + MATH(fabs)(w5) + MATH(fabs)(w6) + MATH(fabs)(w7) + MATH(fabs)(w8) + MATH(fabs)(w9)
        + MATH(fabs)(w10) + MATH(fabs)(w11) + MATH(fabs)(w12) + MATH(fabs)(w13);
}

/* what the tolerance of m[2].K can do */
static real bound_r4_w1(const khepera_encoders_threshold_coefficients *c,
        khepera_encoders_threshold_memory *x, bool first, real w1_a, real w1_b)
{
    const khepera_encoders_threshold_encoders *e = &x->e;

    /* m[2].wheel */
    const real w1_m__2__wheel = c->m__2__wheel__int__x0
        + REAL(9.587379924285257e-05) * (real)e->m__2__wheel_r4.total;

    if (first) {
        /* change of D(m[2].wheel) */
        x->r4_w1_start = w1_m__2__wheel;
    }

    /* change of D(m[2].wheel) */
    const real w1_change = w1_m__2__wheel - x->r4_w1_start;

    /* m[2].motor */
    const real w1_m__2__motor = c->m__2__motor__int__x0
        + REAL(0.0015339807878856412) * (real)e->m__2__motor_r4.total;

    if (first) {
        /* change of D(m[2].motor) */
        x->r4_w1_start_2 = w1_m__2__motor;
    }

    /* change of D(m[2].motor) */
    const real w1_change_2 = w1_m__2__motor - x->r4_w1_start_2;

    /* tanh(Int(D(m[2].motor))/(4*m[2].tau0) - m[2].ge.N*Int(D(m[2].wheel))/(4*m[2].tau0)) */
    const real w1_tanh = near_tanh(c->scaled_one_over_tau0_4 * w1_change_2
            - c->scaled_N_over_tau0_4 * w1_change);

    /* r4_w1: stage 3 */
    const real w1_u3 = c->r4_w1_integral_2 * w1_change - c->r4_w1_integral * w1_change_2
        - c->r4_w1_tanh * w1_tanh;
    const real w1_y3 = x->r4_w1_s3 + w1_b * w1_u3;
    x->r4_w1_s3 = w1_a * w1_y3 + w1_b * w1_u3;

    /* r4_w1: stage 2 */
    const real w1_u2 = w1_y3;
    const real w1_y2 = x->r4_w1_s2 + w1_b * w1_u2;
    x->r4_w1_s2 = w1_a * w1_y2 + w1_b * w1_u2;

    /* r4_w1: stage 1 */
    const real w1_u1 = w1_y2;
    const real w1_y1 = x->r4_w1_s1 + w1_b * w1_u1;
    x->r4_w1_s1 = w1_a * w1_y1 + w1_b * w1_u1;

    /* what the tolerance of m[2].K can do */
    const real w1 = w1_y1;

    if (first) {
        /* nothing is remembered yet */
        x->r4_w2_s3 = REAL(0.0);
        x->r4_w2_s2 = REAL(0.0);
        x->r4_w2_s1 = REAL(0.0);
    }

    return w1;
}

/* what the tolerance of m[2].tau0 can do */
static real bound_r4_w2(const khepera_encoders_threshold_coefficients *c,
        khepera_encoders_threshold_memory *x, bool first, real w1_a, real w1_b)
{
    const khepera_encoders_threshold_encoders *e = &x->e;

    /* m[2].wheel */
    const real w2_m__2__wheel = c->m__2__wheel__int__x0
        + REAL(9.587379924285257e-05) * (real)e->m__2__wheel_r4.total;

    if (first) {
        /* change of D(m[2].wheel) */
        x->r4_w2_start = w2_m__2__wheel;
    }

    /* change of D(m[2].wheel) */
    const real w2_change = w2_m__2__wheel - x->r4_w2_start;

    /* m[2].motor */
    const real w2_m__2__motor = c->m__2__motor__int__x0
        + REAL(0.0015339807878856412) * (real)e->m__2__motor_r4.total;

    if (first) {
        /* change of D(m[2].motor) */
        x->r4_w2_start_2 = w2_m__2__motor;
    }

    /* change of D(m[2].motor) */
    const real w2_change_2 = w2_m__2__motor - x->r4_w2_start_2;

    /* tanh(Int(D(m[2].motor))/(4*m[2].tau0) - m[2].ge.N*Int(D(m[2].wheel))/(4*m[2].tau0)) */
    const real w2_tanh_x = near_tanh(c->scaled_one_over_tau0_4 * w2_change_2
            - c->scaled_N_over_tau0_4 * w2_change);

    /* (m[2].ge.N*Int(D(m[2].wheel))/(4*m[2].tau0^2) - Int(D(m[2].motor))/(4*m[2].tau0^2))*(1 -
     * tanh(Int(D(m[2].motor))/(4*m[2].tau0) - m[2].ge.N*Int(D(m[2].wheel))/(4*m[2].tau0))^2) */
    const real w2_product = (c->scaled_N_over_tau0_5 * w2_change
            - c->scaled_one_over_tau0_5 * w2_change_2) * (REAL(1.0) - w2_tanh_x * w2_tanh_x);

    /* r4_w2: stage 3 */
    const real w2_u3 = -c->r4_w1_tanh * w2_tanh_x - c->r4_w2_product * w2_product;
    const real w2_y3 = x->r4_w2_s3 + w1_b * w2_u3;
    x->r4_w2_s3 = w1_a * w2_y3 + w1_b * w2_u3;

    /* r4_w2: stage 2 */
    const real w2_u2 = w2_y3;
    const real w2_y2 = x->r4_w2_s2 + w1_b * w2_u2;
    x->r4_w2_s2 = w1_a * w2_y2 + w1_b * w2_u2;

    /* r4_w2: stage 1 */
    const real w2_u1 = w2_y2;
    const real w2_y1 = x->r4_w2_s1 + w1_b * w2_u1;
    x->r4_w2_s1 = w1_a * w2_y1 + w1_b * w2_u1;

    /* what the tolerance of m[2].tau0 can do */
    const real w2 = w2_y1;

    return w2;
}

/* what the tolerance of m[2].Js can do */
static real bound_r4_w3(const khepera_encoders_threshold_coefficients *c,
        khepera_encoders_threshold_memory *x, bool first, real w1_a, real w1_b)
{
    const khepera_encoders_threshold_encoders *e = &x->e;

    if (first) {
        /* nothing is remembered yet */
        x->r4_w3_m__2__wheel_speed = REAL(0.0);
        x->r4_w3_s3 = REAL(0.0);
        x->r4_w3_s2 = REAL(0.0);
        x->r4_w3_s1 = REAL(0.0);
    }

    /* filtered speed of m[2].wheel */
    const real w3_m__2__wheel_speed_2 = c->a * x->r4_w3_m__2__wheel_speed
        + c->m__1__wheel_gain * (real)e->m__2__wheel_r4.increment;
    x->r4_w3_m__2__wheel_speed = w3_m__2__wheel_speed_2;

    /* r4_w3: encoders, order 2 */
    const real w3_n2 = c->r4_w3_w2_m__2__wheel * w3_m__2__wheel_speed_2;

    /* r4_w3: the filter multiplied out */
    const real w3_p1_1 = w3_n2 - w3_n2;

    /* r4_w3: stage 3 */
    const real w3_u3 = -w3_p1_1;
    const real w3_y3 = x->r4_w3_s3 + w1_b * w3_u3;
    x->r4_w3_s3 = w1_a * w3_y3 + w1_b * w3_u3;

    /* r4_w3: stage 2 */
    const real w3_u2 = w3_y3 + w3_p1_1 - w3_n2;
    const real w3_y2 = x->r4_w3_s2 + w1_b * w3_u2;
    x->r4_w3_s2 = w1_a * w3_y2 + w1_b * w3_u2;

    /* r4_w3: stage 1 */
    const real w3_u1 = w3_y2 + w3_n2;
    const real w3_y1 = x->r4_w3_s1 + w1_b * w3_u1;
    x->r4_w3_s1 = w1_a * w3_y1 + w1_b * w3_u1;

    /* what the tolerance of m[2].Js can do */
    const real w3 = w3_y1;

    return w3;
}

/* what the tolerance of m[2].fs can do */
static real bound_r4_w4(const khepera_encoders_threshold_coefficients *c,
        khepera_encoders_threshold_memory *x, bool first, real w1_a, real w1_b)
{
    const khepera_encoders_threshold_encoders *e = &x->e;

    if (first) {
        /* nothing is remembered yet */
        x->r4_w4_m__2__wheel_speed = REAL(0.0);
        x->r4_w4_s3 = REAL(0.0);
        x->r4_w4_s2 = REAL(0.0);
        x->r4_w4_s1 = REAL(0.0);
    }

    /* filtered speed of m[2].wheel */
    const real w4_m__2__wheel_speed_2 = c->a * x->r4_w4_m__2__wheel_speed
        + c->m__1__wheel_gain * (real)e->m__2__wheel_r4.increment;
    x->r4_w4_m__2__wheel_speed = w4_m__2__wheel_speed_2;

    /* r4_w4: encoders, order 1 */
    const real w4_n1 = c->r4_w4_w1_m__2__wheel * w4_m__2__wheel_speed_2;

    /* r4_w4: stage 3 */
    const real w4_u3 = w4_n1 - w4_n1;
    const real w4_y3 = x->r4_w4_s3 + w1_b * w4_u3;
    x->r4_w4_s3 = w1_a * w4_y3 + w1_b * w4_u3;

    /* r4_w4: stage 2 */
    const real w4_u2 = w4_y3 + w4_n1;
    const real w4_y2 = x->r4_w4_s2 + w1_b * w4_u2;
    x->r4_w4_s2 = w1_a * w4_y2 + w1_b * w4_u2;

    /* r4_w4: stage 1 */
    const real w4_u1 = w4_y2;
    const real w4_y1 = x->r4_w4_s1 + w1_b * w4_u1;
    x->r4_w4_s1 = w1_a * w4_y1 + w1_b * w4_u1;

    /* what the tolerance of m[2].fs can do */
    const real w4 = w4_y1;

    if (first) {
        /* nothing is remembered yet */
        x->r4_w5_s3 = REAL(0.0);
        x->r4_w5_s2 = REAL(0.0);
        x->r4_w5_s1 = REAL(0.0);
    }

    return w4;
}

/* what the tolerances of m[2].K and m[2].tau0 can do together */
static real bound_r4_w5(const khepera_encoders_threshold_coefficients *c,
        khepera_encoders_threshold_memory *x, bool first, real w1_a, real w1_b)
{
    const khepera_encoders_threshold_encoders *e = &x->e;

    /* m[2].wheel */
    const real w5_m__2__wheel = c->m__2__wheel__int__x0
        + REAL(9.587379924285257e-05) * (real)e->m__2__wheel_r4.total;

    if (first) {
        /* change of D(m[2].wheel) */
        x->r4_w5_start = w5_m__2__wheel;
    }

    /* change of D(m[2].wheel) */
    const real w5_change = w5_m__2__wheel - x->r4_w5_start;

    /* m[2].motor */
    const real w5_m__2__motor = c->m__2__motor__int__x0
        + REAL(0.0015339807878856412) * (real)e->m__2__motor_r4.total;

    if (first) {
        /* change of D(m[2].motor) */
        x->r4_w5_start_2 = w5_m__2__motor;
    }

    /* change of D(m[2].motor) */
    const real w5_change_2 = w5_m__2__motor - x->r4_w5_start_2;

    /* tanh(Int(D(m[2].motor))/(4*m[2].tau0) - m[2].ge.N*Int(D(m[2].wheel))/(4*m[2].tau0)) */
    const real w5_tanh_x = near_tanh(c->scaled_one_over_tau0_4 * w5_change_2
            - c->scaled_N_over_tau0_4 * w5_change);

    /* (m[2].ge.N*Int(D(m[2].wheel))/(4*m[2].tau0^2) - Int(D(m[2].motor))/(4*m[2].tau0^2))*(1 -
     * tanh(Int(D(m[2].motor))/(4*m[2].tau0) - m[2].ge.N*Int(D(m[2].wheel))/(4*m[2].tau0))^2) */
    const real w5_product = (c->scaled_N_over_tau0_5 * w5_change
            - c->scaled_one_over_tau0_5 * w5_change_2) * (REAL(1.0) - w5_tanh_x * w5_tanh_x);

    /* r4_w5: stage 3 */
    const real w5_u3 = -c->r4_w5_tanh * w5_tanh_x - c->r4_w5_product * w5_product;
    const real w5_y3 = x->r4_w5_s3 + w1_b * w5_u3;
    x->r4_w5_s3 = w1_a * w5_y3 + w1_b * w5_u3;

    /* r4_w5: stage 2 */
    const real w5_u2 = w5_y3;
    const real w5_y2 = x->r4_w5_s2 + w1_b * w5_u2;
    x->r4_w5_s2 = w1_a * w5_y2 + w1_b * w5_u2;

    /* r4_w5: stage 1 */
    const real w5_u1 = w5_y2;
    const real w5_y1 = x->r4_w5_s1 + w1_b * w5_u1;
    x->r4_w5_s1 = w1_a * w5_y1 + w1_b * w5_u1;

    /* what the tolerances of m[2].K and m[2].tau0 can do together */
    const real w5 = w5_y1;

    return w5;
}

/* second order of what the tolerance of m[2].tau0 can do */
static real bound_r4_w6(const khepera_encoders_threshold_coefficients *c,
        khepera_encoders_threshold_memory *x, bool first, real w1_a, real w1_b, real w6_change,
        real w6_m__2__motor)
{
    if (first) {
        /* change of D(m[2].motor) */
        x->r4_w6_start_2 = w6_m__2__motor;
    }

    /* change of D(m[2].motor) */
    const real w6_change_2 = w6_m__2__motor - x->r4_w6_start_2;

    /* tanh(Int(D(m[2].motor))/(4*m[2].tau0) - m[2].ge.N*Int(D(m[2].wheel))/(4*m[2].tau0)) */
    const real w6_tanh_x = near_tanh(c->scaled_one_over_tau0_4 * w6_change_2
            - c->scaled_N_over_tau0_4 * w6_change);

    /* m[2].ge.N*Int(D(m[2].wheel))/(4*m[2].tau0^2) - Int(D(m[2].motor))/(4*m[2].tau0^2) */
    const real w6_sum = c->scaled_N_over_tau0_5 * w6_change
        - c->scaled_one_over_tau0_5 * w6_change_2;

    /* 1 - tanh(Int(D(m[2].motor))/(4*m[2].tau0) - m[2].ge.N*Int(D(m[2].wheel))/(4*m[2].tau0))^2 */
    const real w6_sum_2 = REAL(1.0) - w6_tanh_x * w6_tanh_x;

    /* (m[2].ge.N*Int(D(m[2].wheel))/(4*m[2].tau0^2) - Int(D(m[2].motor))/(4*m[2].tau0^2))*(1 -
     * tanh(Int(D(m[2].motor))/(4*m[2].tau0) - m[2].ge.N*Int(D(m[2].wheel))/(4*m[2].tau0))^2) */
    const real w6_product = w6_sum * w6_sum_2;

    /* (1 - tanh(Int(D(m[2].motor))/(4*m[2].tau0) -
     * m[2].ge.N*Int(D(m[2].wheel))/(4*m[2].tau0))^2)*(Int(D(m[2].motor))/(2*m[2].tau0^3) -
     * m[2].ge.N*Int(D(m[2].wheel))/(2*m[2].tau0^3)) */
    const real w6_product_2 = w6_sum_2 * (c->scaled_one_over_tau0_6 * w6_change_2
            - c->scaled_N_over_tau0_6 * w6_change);

    /* a product */
    const real w6_product_3 = w6_tanh_x * w6_sum * w6_sum * w6_sum_2;

    /* r4_w6: stage 3 */
    const real w6_u3 = c->r4_w6_product_2 * w6_product_3 - c->r4_w5_product * w6_product
        - c->r4_w6_product * w6_product_2;
    const real w6_y3 = x->r4_w6_s3 + w1_b * w6_u3;
    x->r4_w6_s3 = w1_a * w6_y3 + w1_b * w6_u3;

    /* r4_w6: stage 2 */
    const real w6_u2 = w6_y3;
    const real w6_y2 = x->r4_w6_s2 + w1_b * w6_u2;
    x->r4_w6_s2 = w1_a * w6_y2 + w1_b * w6_u2;

    /* r4_w6: stage 1 */
    const real w6_u1 = w6_y2;
    const real w6_y1 = x->r4_w6_s1 + w1_b * w6_u1;
    x->r4_w6_s1 = w1_a * w6_y1 + w1_b * w6_u1;

    /* second order of what the tolerance of m[2].tau0 can do */
    const real w6 = w6_y1;

    return w6;
}

/* r4 on one sample.
 * khepera_encoders.bg:31: r4: how far r4 can be from zero if no parameter is out of tolerance */
static void bound_r4(
    const khepera_encoders_threshold_coefficients *c, khepera_encoders_threshold_memory *x, const khepera_encoders_samples *s, real *r)
{
    const bool first = x->youngest == 0u && x->age[3] == 0u;
    const khepera_encoders_threshold_encoders *e = &x->e;

    count_on(&x->e.m__2__motor_r4, s->m__2__motor, first);
    count_on(&x->e.m__2__wheel_r4, s->m__2__wheel, first);

    if (first) {
        /* nothing is remembered yet */
        x->r4_w1_s3 = REAL(0.0);
        x->r4_w1_s2 = REAL(0.0);
        x->r4_w1_s1 = REAL(0.0);
    }

    /* r4_w1: a stage of the filter; on the first sample it is at rest */
    const real w1_a = first ? -c->b : c->a;
    const real w1_b = first ? REAL(1.0) : c->b;

    const real w1 = bound_r4_w1(c, x, first, w1_a, w1_b);
    const real w2 = bound_r4_w2(c, x, first, w1_a, w1_b);
    const real w3 = bound_r4_w3(c, x, first, w1_a, w1_b);
    const real w4 = bound_r4_w4(c, x, first, w1_a, w1_b);
    const real w5 = bound_r4_w5(c, x, first, w1_a, w1_b);

    if (first) {
        /* nothing is remembered yet */
        x->r4_w6_s3 = REAL(0.0);
        x->r4_w6_s2 = REAL(0.0);
        x->r4_w6_s1 = REAL(0.0);
    }

    /* m[2].wheel */
    const real w6_m__2__wheel = c->m__2__wheel__int__x0
        + REAL(9.587379924285257e-05) * (real)e->m__2__wheel_r4.total;

    if (first) {
        /* change of D(m[2].wheel) */
        x->r4_w6_start = w6_m__2__wheel;
    }

    /* change of D(m[2].wheel) */
    const real w6_change = w6_m__2__wheel - x->r4_w6_start;

    /* m[2].motor */
    const real w6_m__2__motor = c->m__2__motor__int__x0
        + REAL(0.0015339807878856412) * (real)e->m__2__motor_r4.total;

    const real w6 = bound_r4_w6(c, x, first, w1_a, w1_b, w6_change, w6_m__2__motor);

    r[KHEPERA_ENCODERS_R4] = MATH(fabs)(w1) + MATH(fabs)(w2) + MATH(fabs)(w3) + MATH(fabs)(w4)
        + MATH(fabs)(w5) + MATH(fabs)(w6);
}

/* r5 on one sample.
 * khepera.bg:114: r5: how far r5 can be from zero if no parameter is out of tolerance */
static void bound_r5(
    const khepera_encoders_threshold_coefficients *c, khepera_encoders_threshold_memory *x, const khepera_encoders_samples *s, real *r)
{
    const bool first = x->youngest == 0u && x->age[4] == 0u;

    if (first) {
        /* nothing is remembered yet */
        x->r5_w1_s2 = REAL(0.0);
        x->r5_w1_s1 = REAL(0.0);
    }

    /* r5_w1: a stage of the filter; on the first sample it is at rest */
    const real w1_a = first ? -c->b : c->a;
    const real w1_b = first ? REAL(1.0) : c->b;

    /* r5_w1: terms of order 0 */
    const real w1_g0 = c->r5_w1_load * s->load;

    /* r5_w1: degree 1 */
    const real w1_d1 = c->r5_w1_w1_load * s->load;

    /* r5_w1: error of order 0 */
    const real w1_e0 = c->bend1 * w1_g0;

    /* r5_w1: the filter multiplied out */
    const real w1_p1_1 = -w1_d1 - w1_e0;

    /* r5_w1: stage 2 */
    const real w1_u2 = -w1_g0 - w1_p1_1;
    const real w1_y2 = x->r5_w1_s2 + w1_b * w1_u2;
    x->r5_w1_s2 = w1_a * w1_y2 + w1_b * w1_u2;

    /* r5_w1: stage 1 */
    const real w1_u1 = w1_y2 + w1_p1_1 - w1_e0;
    const real w1_y1 = x->r5_w1_s1 + w1_b * w1_u1;
    x->r5_w1_s1 = w1_a * w1_y1 + w1_b * w1_u1;

    /* what the tolerance of R_L can do */
    const real w1 = w1_y1 + w1_e0;

    if (first) {
        /* nothing is remembered yet */
        x->r5_w2_s2 = REAL(0.0);
        x->r5_w2_s1 = REAL(0.0);
    }

    /* r5_w2: degree 1 */
    const real w2_d1 = c->r5_w2_w1_load * s->load;

    /* r5_w2: stage 2 */
    const real w2_u2 = w2_d1;
    const real w2_y2 = x->r5_w2_s2 + w1_b * w2_u2;
    x->r5_w2_s2 = w1_a * w2_y2 + w1_b * w2_u2;

    /* r5_w2: stage 1 */
    const real w2_u1 = w2_y2 - w2_d1;
    const real w2_y1 = x->r5_w2_s1 + w1_b * w2_u1;
    x->r5_w2_s1 = w1_a * w2_y1 + w1_b * w2_u1;

    /* second order of what the tolerance of R_L can do */
    const real w2 = w2_y1;

    r[KHEPERA_ENCODERS_R5] = MATH(fabs)(w1) + MATH(fabs)(w2);
}

/* Ages and validity one by one: a number that is not finite makes the next sample the first. */
static void bound_count_samples(
    const khepera_encoders_threshold_coefficients *c,
    khepera_encoders_threshold_memory *x,
    khepera_encoders_residuals *out)
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

void khepera_encoders_threshold_reset(khepera_encoders_threshold_memory *memory)
{
    int k;

    for (k = 0; k < 5; ++k) {
        memory->age[k] = 0u;
    }
    memory->youngest = 0u;
}

void khepera_encoders_threshold_step(
    const khepera_encoders_threshold_coefficients *coefficients,
    khepera_encoders_threshold_memory *memory,
    const khepera_encoders_samples *samples,
    khepera_encoders_residuals *thresholds)
{
    const khepera_encoders_threshold_coefficients *c = coefficients;
    khepera_encoders_threshold_memory *x = memory;
    const khepera_encoders_samples *s = samples;
    real *r = thresholds->value;
    int k;

    bound_r1(c, x, s, r);
    bound_r2(c, x, s, r);
    bound_r3(c, x, s, r);
    bound_r4(c, x, s, r);
    bound_r5(c, x, s, r);
    /* a sum is finite only if all its terms are */
    if (x->youngest > c->longest
            && finite_number(r[KHEPERA_ENCODERS_R1] + r[KHEPERA_ENCODERS_R2]
                + r[KHEPERA_ENCODERS_R3] + r[KHEPERA_ENCODERS_R4] + r[KHEPERA_ENCODERS_R5])) {
        for (k = 0; k < KHEPERA_ENCODERS_RESIDUALS; ++k) {
            thresholds->valid[k] = true;
        }
    } else {
        bound_count_samples(c, x, thresholds);
    }
}

#endif

const char khepera_encoders_fault_name[KHEPERA_ENCODERS_FAULTS][11] = {
    "m[1].Je", "m[1].fe", "m[1].el.L", "m[1].el.Re", "m[1].el.k", "U0[1]", "m[1].Js", "m[1].fs",
    "m[1].R", "m[1].ge.N", "Fx[1]", "m[1].motor", "m[1].wheel", "m[1].K", "m[1].tau0", "m[2].Je",
    "m[2].fe", "m[2].el.L", "m[2].el.Re", "m[2].el.k", "U0[2]", "m[2].Js", "m[2].fs", "m[2].R",
    "m[2].ge.N", "Fx[2]", "m[2].motor", "m[2].wheel", "m[2].K", "m[2].tau0", "R_L", "load", "Uin",
    "Us",
};

const uint16_t khepera_encoders_fault_class[KHEPERA_ENCODERS_FAULTS] = {
    0u, 0u, 0u, 0u, 0u, 0u, 1u, 1u, 1u, 1u, 1u, 1u, 1u, 2u, 2u, 3u, 3u, 3u, 3u, 3u, 3u, 4u, 4u, 4u,
    4u, 4u, 4u, 4u, 5u, 5u, 6u, 6u, 6u, 6u,
};

const char khepera_encoders_residual_name[KHEPERA_ENCODERS_RESIDUALS][3] = {
    "r1", "r2", "r3", "r4", "r5",
};

/*
 * Signatures: the faults of class c are seen by the residuals of entries first_entry[c] and up to
 * first_entry[c + 1].
 */
static const uint32_t first_entry[KHEPERA_ENCODERS_CLASSES + 1] = {
    0u, 1u, 3u, 4u, 5u, 7u, 8u, 9u,
};

static const uint16_t seen_by[9] = {
    0u, 0u, 1u, 1u, 2u, 2u, 3u, 3u, 4u,
};

/*
 * Sizes of faults in eighths of an octave: a residual in alarm makes a fault so much larger than
 * what is least here as it is out.
 */
static const uint8_t least_size[9] = {
    1u, 1u, 1u, 1u, 1u, 1u, 1u, 1u, 1u,
};

/* A residual is sure to show a fault of this size; 255: of no size. */
static const uint8_t sure_size[9] = {
    0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u,
};

/* The peak of residual k since it went into alarm, beside what is sure to be one. */
static void remember_peak(
    khepera_encoders_diagnosis *d, const khepera_encoders_limit *limit, int k, real out, real bound)
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
static int size_of(const khepera_encoders_diagnosis *d, int c, int alarms)
{
    const uint32_t begin = first_entry[c];
    const uint32_t end = first_entry[c + 1];
    int size = 0;
    int seen = 0;
    uint32_t i;

    for (i = begin; i < end; ++i) {
        const int k = (int)seen_by[i];

        if (d->state[k] == KHEPERA_ENCODERS_ALARM) {
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
static khepera_encoders_candidate left_of(const khepera_encoders_diagnosis *d, int c, int alarms)
{
    const uint32_t begin = first_entry[c];
    const uint32_t end = first_entry[c + 1];
    const int size = size_of(d, c, alarms);
    uint32_t i;

    if (size < 0) {
        return KHEPERA_ENCODERS_RULED_OUT;
    }
    if (d->settled < d->window) {
        return KHEPERA_ENCODERS_LIKELY; /* too soon for what is quiet to say anything */
    }
    for (i = begin; i < end; ++i) {
        const int k = (int)seen_by[i];
        const int sure = (int)sure_size[i];

        if (d->state[k] == KHEPERA_ENCODERS_HEALTHY && sure != 255 && sure <= size) {
            return KHEPERA_ENCODERS_SMALL;
        }
    }
    return KHEPERA_ENCODERS_LIKELY;
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
    khepera_encoders_diagnosis *d, const khepera_encoders_limit *limit, int k, real off, real out, real bound)
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

static bool sums_are_zero(const khepera_encoders_diagnosis *d, int k)
{
    const real sum = d->above[k] + d->below[k] + d->louder[k];

    return !(sum > REAL(0.0));
}

static void forget_sums(khepera_encoders_diagnosis *d, int k)
{
    d->above[k] = REAL(0.0);
    d->below[k] = REAL(0.0);
    d->louder[k] = REAL(0.0);
    d->streak[k] = 0u;
}

/* How far a residual is beyond its bound; off: from its mean. */
static real excess(real off, real bound)
{
#if defined __GNUC__ && !defined KHEPERA_ENCODERS_REAL
    return MATH(__builtin_fabs)(off) - bound; /* one instruction, no library */
#else
    return (off < REAL(0.0) ? -off : off) - bound;
#endif
}

static bool is_within(const khepera_encoders_limit *limit, real value, real bound)
{
    return excess(value - limit->mean, bound) <= limit->level;
}

/* Residual k in one sample; whether it goes into alarm. */
static bool watch(
    khepera_encoders_diagnosis *d, const khepera_encoders_limit *limit, int k, real value, real bound, bool row)
{
    const real off = value - limit->mean;
    const real out = excess(off, bound);
    bool high = false;

    if (row) {
        high = add_row(d, limit, k, off, out, bound);
    }
    if (d->state[k] == KHEPERA_ENCODERS_ALARM) {
        d->since[k] += d->since[k] < UINT32_MAX ? 1u : 0u;
        remember_peak(d, limit, k, out, bound);
        if (!(out < RELEASE * limit->level) || !sums_are_zero(d, k)) {
            d->quiet = 0u;
        }
        return false;
    }
    d->state[k] = KHEPERA_ENCODERS_HEALTHY;
    d->streak[k] = out > limit->level ? d->streak[k] + 1u : 0u;
    if (d->streak[k] < d->least && !high) {
        return false;
    }
    d->state[k] = KHEPERA_ENCODERS_ALARM;
    d->since[k] = 0u;
    d->peak[k] = REAL(0.0);
    remember_peak(d, limit, k, out, bound);
    return true;
}

/* Which classes of faults the residuals leave, and the one if it is one. */
static void judge(khepera_encoders_diagnosis *d)
{
    int likely = 0;
    int alarms = 0;
    int c;
    int k;

    for (k = 0; k < KHEPERA_ENCODERS_RESIDUALS; ++k) {
        alarms += d->state[k] == KHEPERA_ENCODERS_ALARM ? 1 : 0;
    }
    d->fault_class = KHEPERA_ENCODERS_UNKNOWN;
    for (c = 0; c < KHEPERA_ENCODERS_CLASSES; ++c) {
        const khepera_encoders_candidate left = left_of(d, c, alarms);

        d->candidate[c] = (uint8_t)left;
        if (left == KHEPERA_ENCODERS_LIKELY) {
            d->fault_class = (int16_t)c;
            ++likely;
        }
    }
    if (likely != 1 || d->settled < 2u * d->row) {
        d->fault_class = KHEPERA_ENCODERS_UNKNOWN;
    }
}

khepera_encoders_limit khepera_encoders_limit_of(khepera_encoders_real level)
{
    khepera_encoders_limit limit;

    limit.mean = REAL(0.0);
    limit.level = level;
    limit.unit = REAL(0.0);
    limit.loud = REAL(0.0);
    limit.drift = REAL(0.5);
    limit.height = NEVER;
    limit.bound = REAL(0.0);
    return limit;
}

void khepera_encoders_clear(khepera_encoders_diagnosis *diagnosis)
{
    int k;

    for (k = 0; k < KHEPERA_ENCODERS_RESIDUALS; ++k) {
        if (diagnosis->state[k] == KHEPERA_ENCODERS_ALARM) {
            diagnosis->state[k] = KHEPERA_ENCODERS_HEALTHY;
        }
        diagnosis->since[k] = 0u;
        diagnosis->peak[k] = REAL(0.0);
        forget_sums(diagnosis, k);
    }
    for (k = 0; k < KHEPERA_ENCODERS_CLASSES; ++k) {
        diagnosis->candidate[k] = KHEPERA_ENCODERS_RULED_OUT;
    }
    diagnosis->fault_class = KHEPERA_ENCODERS_UNKNOWN;
    diagnosis->quiet = 0u;
    diagnosis->settled = 0u;
    diagnosis->calm = false;
}

void khepera_encoders_diagnosis_reset(khepera_encoders_diagnosis *diagnosis)
{
    int k;

    diagnosis->row = KHEPERA_ENCODERS_ROW;
    diagnosis->least = 15u;
    diagnosis->hold = 10u * KHEPERA_ENCODERS_ROW;
    diagnosis->window = 300u;
    diagnosis->latch = false;
    diagnosis->tick = 0u;
    for (k = 0; k < KHEPERA_ENCODERS_RESIDUALS; ++k) {
        diagnosis->state[k] = KHEPERA_ENCODERS_BLIND;
    }
    khepera_encoders_clear(diagnosis);
}

/* Whether each residual has a value within its level: nearly all samples are so. */
static bool all_within(
    const khepera_encoders_limit *limits, const real *bounds, const khepera_encoders_residuals *residuals)
{
    const real *value = residuals->value;
    int k;

    if (bounds != NULL) {
        for (k = 0; k < KHEPERA_ENCODERS_RESIDUALS; ++k) {
            if (!residuals->valid[k] || !is_within(&limits[k], value[k], bounds[k])) {
                return false;
            }
        }
    } else {
        for (k = 0; k < KHEPERA_ENCODERS_RESIDUALS; ++k) {
            if (!residuals->valid[k] || !is_within(&limits[k], value[k], limits[k].bound)) {
                return false;
            }
        }
    }
    return true;
}

/* Residual k without a value. */
static void blind(khepera_encoders_diagnosis *d, int k)
{
    forget_sums(d, k);
    if (d->state[k] == KHEPERA_ENCODERS_ALARM) {
        d->quiet = 0u; /* nobody knows that it is over */
    } else {
        d->state[k] = KHEPERA_ENCODERS_BLIND;
    }
}

bool khepera_encoders_diagnose(
    khepera_encoders_diagnosis *diagnosis,
    const khepera_encoders_limit *limits,
    const khepera_encoders_real *bounds,
    const khepera_encoders_residuals *residuals)
{
    khepera_encoders_diagnosis *d = diagnosis;
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
    for (k = 0; k < KHEPERA_ENCODERS_RESIDUALS; ++k) {
        if (residuals->valid[k]) {
            const real bound = bounds ? bounds[k] : limits[k].bound;

            fresh = watch(d, &limits[k], k, residuals->value[k], bound, row) || fresh;
        } else {
            blind(d, k);
        }
        d->calm = d->calm && d->state[k] == KHEPERA_ENCODERS_HEALTHY && d->streak[k] == 0u;
        alarm = alarm || d->state[k] == KHEPERA_ENCODERS_ALARM;
    }
    if (fresh) {
        d->quiet = 0u;
        d->settled = 0u;
    }
    if (alarm && !d->latch && d->quiet >= d->hold) {
        khepera_encoders_clear(d);
        return false;
    }
    if (fresh || (alarm && row)) {
        judge(d);
    }
    return alarm;
}
