/* khepera_built.c: the residuals of KheperaBuilt; generated, see the header. */
#include "khepera_built.h"

#ifndef KHEPERA_BUILT_NO_THRESHOLDS
#include <math.h>
#endif
#include <stddef.h>

#if defined __FINITE_MATH_ONLY__ && __FINITE_MATH_ONLY__
#error "this code tells numbers from NaN: compile it without -ffinite-math-only (-ffast-math)"
#endif

typedef khepera_built_real real;

#define REAL(x) KHEPERA_BUILT_CONSTANT(x)
#if defined KHEPERA_BUILT_FLOAT && !defined KHEPERA_BUILT_REAL
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

/* Takes a count; the difference to the one before is right also when the counter runs over. */
static void count_on(khepera_built_encoder *encoder, int32_t count, bool first)
{
    const uint32_t step = first ? 0u : (uint32_t)count - encoder->count;

    encoder->increment = step <= INT32_MAX ? (int32_t)step : -(int32_t)(UINT32_MAX - step) - 1;
    encoder->total = first ? 0 : encoder->total + encoder->increment;
    encoder->count = (uint32_t)count;
}

/* The least bandwidth * sample_time at which a filter still moves. */
#if defined KHEPERA_BUILT_FLOAT && !defined KHEPERA_BUILT_REAL
#define SLOWEST REAL(0.0001)
#else
#define SLOWEST REAL(1.0e-09)
#endif

uint32_t khepera_built_abi(void)
{
    return KHEPERA_BUILT_ABI;
}

const char *khepera_built_digest(void)
{
    return KHEPERA_BUILT_DIGEST;
}

void khepera_built_nominal(khepera_built_parameters *parameters)
{
    parameters->R_L = REAL(0.85);             /* Ohm */
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

/* Whether configure may go on with what it is given. */
static khepera_built_status checked(const khepera_built_parameters *p, real sample_time, real bandwidth)
{
    const bool finite = finite_number(p->R_L + p->m__1__Je + p->m__1__fe + p->m__1__Js + p->m__1__fs
            + p->m__1__R + p->m__1__el__L + p->m__1__el__Re + p->m__1__el__k + p->m__1__ge__N
            + p->m__2__Je + p->m__2__fe + p->m__2__Js + p->m__2__fs + p->m__2__R + p->m__2__el__L
            + p->m__2__el__Re + p->m__2__el__k + p->m__2__ge__N);

    if (!finite) {
        return KHEPERA_BUILT_BAD_PARAMETER;
    }
    if (!(sample_time >= REAL(0.000999999)) || !finite_number(sample_time)) {
        return KHEPERA_BUILT_BAD_SAMPLE_TIME;
    }
    if (!(bandwidth * sample_time >= SLOWEST && bandwidth * sample_time <= REAL(3.0))) {
        return KHEPERA_BUILT_BAD_BANDWIDTH;
    }
    return KHEPERA_BUILT_OK;
}

/* Samples until `constants` time constants of the filter are over. */
static uint32_t samples(real constants, real sample_time, real bandwidth)
{
    const real wait = constants / (bandwidth * sample_time);
    const uint32_t whole = wait < REAL(4.0e9) ? (uint32_t)wait : UINT32_MAX - 1u;

    return (real)whole < wait ? whole + 1u : whole;
}

const khepera_built_coefficients khepera_built_nominal_coefficients = {
    REAL(0.006418262108262109),    /* r1_m__1__motor_1 */
    REAL(1.6045584045584047),      /* r1_Fx__1 */
    REAL(5.184146293052469),       /* m__1__motor_gain */
    REAL(0.9801980198019802),      /* a */
    REAL(0.00990099009900991),     /* b */
    -REAL(0.003009538461538465),   /* r1_w2_m__1__motor */
    REAL(1.0256410256410274e-06),  /* r1_w3_m__1__motor */
    REAL(0.0005470085470085475),   /* r1_w1_Fx__1 */
    REAL(6.666666666666679e-05),   /* bend2 */
    REAL(3.3333333333333396e-05),  /* bend1 */
    REAL(0.00010000000000000018),  /* bend3 */
    REAL(0.006418262108262109),    /* r2_m__2__motor_1 */
    REAL(1.6045584045584047),      /* r2_Fx__2 */
    -REAL(0.003009538461538465),   /* r2_w2_m__2__motor */
    REAL(1.0256410256410274e-06),  /* r2_w3_m__2__motor */
    REAL(0.0005470085470085475),   /* r2_w1_Fx__2 */
    {654u, 654u, 346u},            /* samples until each is valid */
    654u                           /* the longest of these */
};

/* r1: coefficients */
static void compute_r1(khepera_built_coefficients *c, const khepera_built_parameters *p, real w)
{
    /* khepera.bg:17: m[1].fe + m[1].fs/m[1].ge.N^2 */
    const real sum = p->m__1__fe + p->m__1__fs / p->m__1__ge__N / p->m__1__ge__N;

    /* m[1].Je + m[1].Js/m[1].ge.N^2 */
    const real sum_2 = p->m__1__Je + p->m__1__Js / p->m__1__ge__N / p->m__1__ge__N;

    /* m[1].el.L*(m[1].fe + m[1].fs/m[1].ge.N^2)/m[1].el.k */
    const real product = p->m__1__el__L * sum / p->m__1__el__k;

    /* m[1].el.Re*(m[1].Je + m[1].Js/m[1].ge.N^2)/m[1].el.k */
    const real product_2 = p->m__1__el__Re * sum_2 / p->m__1__el__k;

    /* r1: factor of m[1].motor': m[1].el.k + m[1].el.Re*(m[1].fe +
     * m[1].fs/m[1].ge.N^2)/m[1].el.k */
    c->r1_m__1__motor_1 = p->m__1__el__k + p->m__1__el__Re * sum / p->m__1__el__k;

    /* r1: factor of Fx[1]: m[1].R*m[1].el.Re/(m[1].el.k*m[1].ge.N) */
    c->r1_Fx__1 = p->m__1__R * p->m__1__el__Re / p->m__1__el__k / p->m__1__ge__N;

    /* r1: factor of m[1].motor'' */
    c->r1_w2_m__1__motor = (-product - product_2) * w;

    /* r1: factor of m[1].motor''' */
    c->r1_w3_m__1__motor = p->m__1__el__L * sum_2 * w * w / p->m__1__el__k;

    /* r1: factor of Fx[1]' */
    c->r1_w1_Fx__1 = p->m__1__R * p->m__1__el__L * w / p->m__1__el__k / p->m__1__ge__N;
}

/* filter: coefficients */
static void compute_filter(khepera_built_coefficients *c, real pole, real turn, real sum_5)
{
    /* turn^2 */
    const real turn_2 = turn * turn;

    /* filter: what is left of a memory a sample later */
    c->a = pole;

    /* filter: weight of a sample, new and a sample later */
    c->b = REAL(0.5) * sum_5;

    /* filter: 2 * (w*sample_time)^2/12 */
    c->bend2 = turn_2 / REAL(6.0);

    /* filter: 1 * (w*sample_time)^2/12 */
    c->bend1 = turn_2 / REAL(12.0);

    /* filter: 3 * (w*sample_time)^2/12 */
    c->bend3 = REAL(0.25) * turn_2;
}

/* r2: coefficients */
static void compute_r2(khepera_built_coefficients *c, const khepera_built_parameters *p, real w)
{
    /* khepera.bg:17: m[2].fe + m[2].fs/m[2].ge.N^2 */
    const real sum_3 = p->m__2__fe + p->m__2__fs / p->m__2__ge__N / p->m__2__ge__N;

    /* m[2].Je + m[2].Js/m[2].ge.N^2 */
    const real sum_4 = p->m__2__Je + p->m__2__Js / p->m__2__ge__N / p->m__2__ge__N;

    /* m[2].el.L*(m[2].fe + m[2].fs/m[2].ge.N^2)/m[2].el.k */
    const real product_3 = p->m__2__el__L * sum_3 / p->m__2__el__k;

    /* m[2].el.Re*(m[2].Je + m[2].Js/m[2].ge.N^2)/m[2].el.k */
    const real product_4 = p->m__2__el__Re * sum_4 / p->m__2__el__k;

    /* r2: factor of m[2].motor': m[2].el.k + m[2].el.Re*(m[2].fe +
     * m[2].fs/m[2].ge.N^2)/m[2].el.k */
    c->r2_m__2__motor_1 = p->m__2__el__k + p->m__2__el__Re * sum_3 / p->m__2__el__k;

    /* r2: factor of Fx[2]: m[2].R*m[2].el.Re/(m[2].el.k*m[2].ge.N) */
    c->r2_Fx__2 = p->m__2__R * p->m__2__el__Re / p->m__2__el__k / p->m__2__ge__N;

    /* r2: factor of m[2].motor'' */
    c->r2_w2_m__2__motor = (-product_3 - product_4) * w;

    /* r2: factor of m[2].motor''' */
    c->r2_w3_m__2__motor = p->m__2__el__L * sum_4 * w * w / p->m__2__el__k;

    /* r2: factor of Fx[2]' */
    c->r2_w1_Fx__2 = p->m__2__R * p->m__2__el__L * w / p->m__2__el__k / p->m__2__ge__N;
}

/* The coefficients, from the parameters. */
static void compute_coefficients(khepera_built_coefficients *c, const khepera_built_parameters *p,
        real sample_time, real bandwidth)
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
    const real sum_5 = REAL(1.0) - pole;

    /* speed of m[1].motor for one count */
    c->m__1__motor_gain = REAL(884279719003555.0) * (REAL(1.0)
            - REAL(0.5) * sum_5) * w / REAL(3377699720527872.0);

    compute_r1(c, p, w);
    compute_filter(c, pole, turn, sum_5);
    compute_r2(c, p, w);
}

static bool coefficients_are_finite(const khepera_built_coefficients *c)
{
    return finite_number(c->r1_m__1__motor_1 + c->r1_Fx__1 + c->m__1__motor_gain + c->a + c->b
            + c->r1_w2_m__1__motor + c->r1_w3_m__1__motor + c->r1_w1_Fx__1 + c->bend2 + c->bend1
            + c->bend3 + c->r2_m__2__motor_1 + c->r2_Fx__2 + c->r2_w2_m__2__motor
            + c->r2_w3_m__2__motor + c->r2_w1_Fx__2);
}

khepera_built_status khepera_built_configure(
    khepera_built_coefficients *coefficients,
    const khepera_built_parameters *parameters,
    khepera_built_real sample_time,
    khepera_built_real bandwidth)
{
    khepera_built_coefficients *c = coefficients;
    const khepera_built_status status = checked(parameters, sample_time, bandwidth);
    int k;

    for (k = 0; k < KHEPERA_BUILT_RESIDUALS; ++k) {
        c->settle[k] = UINT32_MAX;
    }
    c->longest = UINT32_MAX;
    if (status != KHEPERA_BUILT_OK) {
        return status;
    }
    compute_coefficients(c, parameters, sample_time, bandwidth);
    if (!coefficients_are_finite(c)) {
        return KHEPERA_BUILT_BAD_COEFFICIENT;
    }
    c->settle[KHEPERA_BUILT_R1] = samples(REAL(13.062240779188071), sample_time, bandwidth);
    c->settle[KHEPERA_BUILT_R2] = samples(REAL(13.062240779188071), sample_time, bandwidth);
    c->settle[KHEPERA_BUILT_R3] = samples(REAL(6.907755278982138), sample_time, bandwidth);
    c->longest = c->settle[KHEPERA_BUILT_R1];
    return KHEPERA_BUILT_OK;
}

/* stage 1 */
static real run_r1_y1(const khepera_built_coefficients *c, khepera_built_memory *x,
        const khepera_built_samples *s, real a, real b, real m__1__motor_speed_2, real n1, real e1,
        real n2, real e2)
{
    /* encoders, order 3 */
    const real n3 = -c->r1_w3_m__1__motor * m__1__motor_speed_2;

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
 * m[1].fs*D(m[1].motor)/m[1].ge.N + m[1].Js*D(m[1].motor, 2)/m[1].ge.N)/m[1].ge.N */
static void run_r1(
    const khepera_built_coefficients *c, khepera_built_memory *x, const khepera_built_samples *s, real *r)
{
    const bool first = x->youngest == 0u && x->age[0] == 0u;
    const khepera_built_encoders *e = &x->e;

    count_on(&x->e.m__1__motor, s->m__1__motor, first);

    if (first) {
        /* nothing is remembered yet */
        x->r1_m__1__motor_speed = REAL(0.0);
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
        + c->m__1__motor_gain * (real)e->m__1__motor.increment;
    x->r1_m__1__motor_speed = m__1__motor_speed_2;

    /* encoders, order 1 */
    const real n1 = -c->r1_m__1__motor_1 * m__1__motor_speed_2;

    /* error of order 1 */
    const real e1 = c->bend2 * n1;

    /* encoders, order 2 */
    const real n2 = c->r1_w2_m__1__motor * m__1__motor_speed_2;

    /* error of order 2 */
    const real e2 = c->bend1 * n2;

    const real y1 = run_r1_y1(c, x, s, a, b, m__1__motor_speed_2, n1, e1, n2, e2);

    r[KHEPERA_BUILT_R1] = y1 - e2;
}

/* stage 1 */
static real run_r2_y1(const khepera_built_coefficients *c, khepera_built_memory *x,
        const khepera_built_samples *s, real a, real b, real m__2__motor_speed_2, real n1, real e1,
        real n2, real e2)
{
    /* encoders, order 3 */
    const real n3 = -c->r2_w3_m__2__motor * m__2__motor_speed_2;

    /* terms of order 0 */
    const real g0 = s->U0__2 - c->r2_Fx__2 * s->Fx__2;

    /* terms of order 1 */
    const real g1 = c->r2_w1_Fx__2 * s->Fx__2;

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
    const real y4 = x->r2_s4 + b * u4;
    x->r2_s4 = a * y4 + b * u4;

    /* stage 3 */
    const real u3 = y4 + p1_3 - p1_2;
    const real y3 = x->r2_s3 + b * u3;
    x->r2_s3 = a * y3 + b * u3;

    /* stage 2 */
    const real u2 = y3 + p1_2 - p1_1;
    const real y2 = x->r2_s2 + b * u2;
    x->r2_s2 = a * y2 + b * u2;

    /* stage 1 */
    const real u1 = y2 + p1_1 + e2;
    const real y1 = x->r2_s1 + b * u1;
    x->r2_s1 = a * y1 + b * u1;

    return y1;
}

/* r2 on one sample.
 * khepera.bg:17: r2 = U0[2] - m[2].el.k*D(m[2].motor) - m[2].el.Re*m[2].el.k.e2/m[2].el.k -
 * m[2].el.L*D(m[2].el.k.e2)/m[2].el.k
 * where m[2].el.k.e2 = m[2].fe*D(m[2].motor) + m[2].Je*D(m[2].motor, 2) + (Fx[2]*m[2].R +
 * m[2].fs*D(m[2].motor)/m[2].ge.N + m[2].Js*D(m[2].motor, 2)/m[2].ge.N)/m[2].ge.N */
static void run_r2(
    const khepera_built_coefficients *c, khepera_built_memory *x, const khepera_built_samples *s, real *r)
{
    const bool first = x->youngest == 0u && x->age[1] == 0u;
    const khepera_built_encoders *e = &x->e;

    count_on(&x->e.m__2__motor, s->m__2__motor, first);

    if (first) {
        /* nothing is remembered yet */
        x->r2_m__2__motor_speed = REAL(0.0);
        x->r2_s4 = REAL(0.0);
        x->r2_s3 = REAL(0.0);
        x->r2_s2 = REAL(0.0);
        x->r2_s1 = REAL(0.0);
    }

    /* a stage of the filter; on the first sample it is at rest */
    const real a = first ? -c->b : c->a;
    const real b = first ? REAL(1.0) : c->b;

    /* filtered speed of m[2].motor */
    const real m__2__motor_speed_2 = c->a * x->r2_m__2__motor_speed
        + c->m__1__motor_gain * (real)e->m__2__motor.increment;
    x->r2_m__2__motor_speed = m__2__motor_speed_2;

    /* encoders, order 1 */
    const real n1 = -c->r2_m__2__motor_1 * m__2__motor_speed_2;

    /* error of order 1 */
    const real e1 = c->bend2 * n1;

    /* encoders, order 2 */
    const real n2 = c->r2_w2_m__2__motor * m__2__motor_speed_2;

    /* error of order 2 */
    const real e2 = c->bend1 * n2;

    const real y1 = run_r2_y1(c, x, s, a, b, m__2__motor_speed_2, n1, e1, n2, e2);

    r[KHEPERA_BUILT_R2] = y1 - e2;
}

/* r3 on one sample.
 * khepera.bg:114: r3 = Uin - line.cell[1].mid.e - R_L*line.cell[1].left.f/2 -
 * D(line.cell[1].left.f)/4000000
 * where line.cell[1].left.f = 2.2e-10*D(Us) + 2.2e-10*D(line.cell[1].mid.e)
 * line.cell[1].mid.e = Us + 1.1e-10*R_L*D(Us) + 5.5e-17*D(Us, 2) */
static void run_r3(
    const khepera_built_coefficients *c, khepera_built_memory *x, const khepera_built_samples *s, real *r)
{
    const bool first = x->youngest == 0u && x->age[2] == 0u;

    if (first) {
        /* nothing is remembered yet */
        x->r3_s1 = REAL(0.0);
    }

    /* a stage of the filter; on the first sample it is at rest */
    const real a = first ? -c->b : c->a;
    const real b = first ? REAL(1.0) : c->b;

    /* stage 1 */
    const real u1 = s->Uin - s->Us;
    const real y1 = x->r3_s1 + b * u1;
    x->r3_s1 = a * y1 + b * u1;

    r[KHEPERA_BUILT_R3] = y1;
}

/* Ages and validity one by one: a number that is not finite makes the next sample the first. */
static void count_samples(
    const khepera_built_coefficients *c,
    khepera_built_memory *x,
    khepera_built_residuals *out)
{
    /* the residuals that are computed, and what each one goes with */
    static const uint8_t number[] = {
        0, 1, 2
    };
    static const uint8_t part[] = {
        0, 1, 2
    };
    bool finite[3];
    int k;

    finite[0] = true;
    finite[1] = true;
    finite[2] = true;
    for (k = 0; k < 3; ++k) {
        finite[part[k]] = finite[part[k]] && finite_number(out->value[number[k]]);
    }
    x->youngest = UINT32_MAX;
    for (k = 0; k < 3; ++k) {
        x->age[k] = finite[k] ? x->age[k] + (x->age[k] < UINT32_MAX ? 1u : 0u) : 0u;
        x->youngest = x->age[k] < x->youngest ? x->age[k] : x->youngest;
    }
    for (k = 0; k < 3; ++k) {
        out->value[number[k]] = finite[part[k]] ? out->value[number[k]] : REAL(0.0);
        out->valid[number[k]] = x->age[part[k]] > c->settle[number[k]];
    }
}

void khepera_built_reset(khepera_built_memory *memory)
{
    int k;

    for (k = 0; k < 3; ++k) {
        memory->age[k] = 0u;
    }
    memory->youngest = 0u;
}

void khepera_built_step(
    const khepera_built_coefficients *coefficients,
    khepera_built_memory *memory,
    const khepera_built_samples *samples,
    khepera_built_residuals *residuals)
{
    const khepera_built_coefficients *c = coefficients;
    khepera_built_memory *x = memory;
    const khepera_built_samples *s = samples;
    real *r = residuals->value;
    int k;

    run_r1(c, x, s, r);
    run_r2(c, x, s, r);
    run_r3(c, x, s, r);
    /* a sum is finite only if all its terms are */
    if (x->youngest > c->longest
            && finite_number(r[KHEPERA_BUILT_R1] + r[KHEPERA_BUILT_R2] + r[KHEPERA_BUILT_R3])) {
        for (k = 0; k < KHEPERA_BUILT_RESIDUALS; ++k) {
            residuals->valid[k] = true;
        }
    } else {
        count_samples(c, x, residuals);
    }
}

#ifndef KHEPERA_BUILT_NO_THRESHOLDS

const khepera_built_threshold_coefficients khepera_built_threshold_nominal_coefficients = {
    REAL(5.014245014245014e-05),    /* r1_w1_w1_m__1__motor */
    REAL(5.184146293052469),        /* m__1__motor_gain */
    REAL(0.9801980198019802),       /* a */
    REAL(0.00990099009900991),      /* b */
    REAL(1.7094017094017106e-08),   /* r1_w1_w2_m__1__motor */
    REAL(3.3333333333333396e-05),   /* bend1 */
    REAL(3.2091168091168116e-05),   /* r1_w2_w2_m__1__motor */
    REAL(1.0940170940170958e-08),   /* r1_w2_w3_m__1__motor */
    REAL(0.0002406837606837607),    /* r1_w3_w1_m__1__motor */
    REAL(8.205128205128212e-08),    /* r1_w3_w2_m__1__motor */
    REAL(0.08022792022792023),      /* r1_w4_Fx__1 */
    REAL(0.0001454131054131054),    /* r1_w4_w1_m__1__motor */
    REAL(0.00015042735042735056),   /* r1_w4_w2_m__1__motor */
    REAL(6.666666666666679e-05),    /* bend2 */
    -REAL(1.2034757834757842e-05),  /* r1_w5_w1_m__1__motor */
    REAL(6.019076923076929e-05),    /* r1_w5_w2_m__1__motor */
    REAL(2.051282051282055e-08),    /* r1_w5_w3_m__1__motor */
    REAL(0.0320911680911681),       /* r1_w5_Fx__1 */
    REAL(1.0940170940170949e-05),   /* r1_w5_w1_Fx__1 */
    REAL(0.00010000000000000018),   /* bend3 */
    REAL(2.6338740624454907e-06),   /* r1_w6_w1_m__1__motor */
    REAL(1.0535496249781964e-06),   /* r1_w7_w1_m__1__motor */
    REAL(3.591646448789308e-10),    /* r1_w7_w2_m__1__motor */
    REAL(1.6856793999651158e-06),   /* r1_w8_w2_m__1__motor */
    REAL(6.742717599860463e-07),    /* r1_w9_w2_m__1__motor */
    REAL(2.2986537272251597e-10),   /* r1_w9_w3_m__1__motor */
    REAL(1.2642595499738358e-05),   /* r1_w10_w1_m__1__motor */
    REAL(5.057038199895343e-06),    /* r1_w11_w1_m__1__motor */
    REAL(1.723990295418868e-09),    /* r1_w11_w2_m__1__motor */
    REAL(3.0552939124367693e-06),   /* r1_w12_w1_m__1__motor */
    REAL(3.160648874934592e-06),    /* r1_w12_w2_m__1__motor */
    REAL(0.0016856793999651142),    /* r1_w12_Fx__1 */
    REAL(1.2221175649747078e-06),   /* r1_w13_w1_m__1__motor */
    -REAL(1.264676180961897e-06),   /* r1_w13_w2_m__1__motor */
    REAL(4.309975738547175e-10),    /* r1_w13_w3_m__1__motor */
    REAL(0.0006742717599860457),    /* r1_w13_Fx__1 */
    REAL(2.2986537272251577e-07),   /* r1_w13_w1_Fx__1 */
    REAL(5.014245014245014e-05),    /* r2_w1_w1_m__2__motor */
    REAL(1.7094017094017106e-08),   /* r2_w1_w2_m__2__motor */
    REAL(3.2091168091168116e-05),   /* r2_w2_w2_m__2__motor */
    REAL(1.0940170940170958e-08),   /* r2_w2_w3_m__2__motor */
    REAL(0.0002406837606837607),    /* r2_w3_w1_m__2__motor */
    REAL(8.205128205128212e-08),    /* r2_w3_w2_m__2__motor */
    REAL(0.08022792022792023),      /* r2_w4_Fx__2 */
    REAL(0.0001454131054131054),    /* r2_w4_w1_m__2__motor */
    REAL(0.00015042735042735056),   /* r2_w4_w2_m__2__motor */
    -REAL(1.2034757834757842e-05),  /* r2_w5_w1_m__2__motor */
    REAL(6.019076923076929e-05),    /* r2_w5_w2_m__2__motor */
    REAL(2.051282051282055e-08),    /* r2_w5_w3_m__2__motor */
    REAL(0.0320911680911681),       /* r2_w5_Fx__2 */
    REAL(1.0940170940170949e-05),   /* r2_w5_w1_Fx__2 */
    REAL(2.6338740624454907e-06),   /* r2_w6_w1_m__2__motor */
    REAL(1.0535496249781964e-06),   /* r2_w7_w1_m__2__motor */
    REAL(3.591646448789308e-10),    /* r2_w7_w2_m__2__motor */
    REAL(1.6856793999651158e-06),   /* r2_w8_w2_m__2__motor */
    REAL(6.742717599860463e-07),    /* r2_w9_w2_m__2__motor */
    REAL(2.2986537272251597e-10),   /* r2_w9_w3_m__2__motor */
    REAL(1.2642595499738358e-05),   /* r2_w10_w1_m__2__motor */
    REAL(5.057038199895343e-06),    /* r2_w11_w1_m__2__motor */
    REAL(1.723990295418868e-09),    /* r2_w11_w2_m__2__motor */
    REAL(3.0552939124367693e-06),   /* r2_w12_w1_m__2__motor */
    REAL(3.160648874934592e-06),    /* r2_w12_w2_m__2__motor */
    REAL(0.0016856793999651142),    /* r2_w12_Fx__2 */
    REAL(1.2221175649747078e-06),   /* r2_w13_w1_m__2__motor */
    -REAL(1.264676180961897e-06),   /* r2_w13_w2_m__2__motor */
    REAL(4.309975738547175e-10),    /* r2_w13_w3_m__2__motor */
    REAL(0.0006742717599860457),    /* r2_w13_Fx__2 */
    REAL(2.2986537272251577e-07),   /* r2_w13_w1_Fx__2 */
    {654u, 654u, 346u},             /* samples until each is valid */
    654u                            /* the longest of these */
};

/* m[1].fe*m[1].el.Re/m[1].el.k; ...; m[1].el.Re*(m[1].Je + m[1].Js/m[1].ge.N^2)*w/m[1].el.k */
static void bound_compute_fe_times_Re_over_k_to_product_14(khepera_built_threshold_coefficients *c,
        const khepera_built_parameters *p, real w, real sum_2, real *fe_times_Re_over_k_out,
        real *product_9_out, real *product_10_out, real *product_11_out, real *product_12_out,
        real *product_13_out, real *product_14_out)
{
    /* khepera.bg:17: m[1].fe*m[1].el.Re/m[1].el.k */
    const real fe_times_Re_over_k = p->m__1__fe * p->m__1__el__Re / p->m__1__el__k;

    /* m[1].fe*m[1].el.L*w/m[1].el.k */
    const real product_9 = p->m__1__fe * p->m__1__el__L * w / p->m__1__el__k;

    /* m[1].Js*m[1].el.Re*w/(m[1].el.k*m[1].ge.N^2) */
    const real product_10 = p->m__1__Js * p->m__1__el__Re * w / p->m__1__el__k / p->m__1__ge__N
            / p->m__1__ge__N;

    /* m[1].Js*m[1].el.L*w^2/(m[1].el.k*m[1].ge.N^2) */
    const real product_11 = p->m__1__Js * p->m__1__el__L * w * w / p->m__1__el__k / p->m__1__ge__N
            / p->m__1__ge__N;

    /* m[1].fs*m[1].el.Re/(m[1].el.k*m[1].ge.N^2) */
    const real product_12 = p->m__1__fs * p->m__1__el__Re / p->m__1__el__k / p->m__1__ge__N
            / p->m__1__ge__N;

    /* m[1].fs*m[1].el.L*w/(m[1].el.k*m[1].ge.N^2) */
    const real product_13 = p->m__1__fs * p->m__1__el__L * w / p->m__1__el__k / p->m__1__ge__N
            / p->m__1__ge__N;

    /* m[1].el.Re*(m[1].Je + m[1].Js/m[1].ge.N^2)*w/m[1].el.k */
    const real product_14 = p->m__1__el__Re * sum_2 * w / p->m__1__el__k;

    /* r1_w1: factor of m[1].motor' */
    c->r1_w1_w1_m__1__motor = fe_times_Re_over_k / REAL(10.0);

    /* r1_w1: factor of m[1].motor'' */
    c->r1_w1_w2_m__1__motor = product_9 / REAL(10.0);

    /* r1_w2: factor of m[1].motor'' */
    c->r1_w2_w2_m__1__motor = product_10 / REAL(50.0);

    /* r1_w2: factor of m[1].motor''' */
    c->r1_w2_w3_m__1__motor = product_11 / REAL(50.0);

    /* r1_w3: factor of m[1].motor' */
    c->r1_w3_w1_m__1__motor = product_12 / REAL(10.0);

    /* r1_w3: factor of m[1].motor'' */
    c->r1_w3_w2_m__1__motor = product_13 / REAL(10.0);

    *fe_times_Re_over_k_out = fe_times_Re_over_k;
    *product_9_out = product_9;
    *product_10_out = product_10;
    *product_11_out = product_11;
    *product_12_out = product_12;
    *product_13_out = product_13;
    *product_14_out = product_14;
}

/* r1_w4: coefficients */
static void bound_compute_r1_w4(khepera_built_threshold_coefficients *c, real product,
        real product_2, real product_14)
{
    /* khepera.bg:17: r1_w4: factor of Fx[1] */
    c->r1_w4_Fx__1 = product_2 / REAL(20.0);

    /* r1_w4: factor of m[1].motor' */
    c->r1_w4_w1_m__1__motor = product / REAL(20.0);

    /* r1_w4: factor of m[1].motor'' */
    c->r1_w4_w2_m__1__motor = product_14 / REAL(20.0);
}

/* r1_w5: coefficients */
static void bound_compute_r1_w5(khepera_built_threshold_coefficients *c,
        const khepera_built_parameters *p, real w, real sum, real sum_2, real product_2,
        real product_5, real product_6)
{
    /* khepera.bg:17: r1_w5: factor of m[1].motor' */
    c->r1_w5_w1_m__1__motor = p->m__1__el__k
            * (p->m__1__el__Re * sum / p->m__1__el__k / p->m__1__el__k
            - REAL(1.0)) / REAL(50.0);

    /* r1_w5: factor of m[1].motor'' */
    c->r1_w5_w2_m__1__motor = p->m__1__el__k * w
            * (p->m__1__el__Re * sum_2 / p->m__1__el__k / p->m__1__el__k
            + p->m__1__el__L * sum / p->m__1__el__k / p->m__1__el__k) / REAL(50.0);

    /* r1_w5: factor of m[1].motor''' */
    c->r1_w5_w3_m__1__motor = product_5 / REAL(50.0);

    /* r1_w5: factor of Fx[1] */
    c->r1_w5_Fx__1 = product_2 / REAL(50.0);

    /* r1_w5: factor of Fx[1]' */
    c->r1_w5_w1_Fx__1 = product_6 / REAL(50.0);
}

/* r1_w10 to r1_w11: coefficients */
static void bound_compute_r1_w10_to_r1_w11(khepera_built_threshold_coefficients *c, real product_12,
        real product_13)
{
    /* khepera.bg:17: r1_w10: factor of m[1].motor' */
    c->r1_w10_w1_m__1__motor = REAL(453.0) * product_12 / REAL(86240.0);

    /* r1_w11: factor of m[1].motor' */
    c->r1_w11_w1_m__1__motor = REAL(453.0) * product_12 / REAL(215600.0);

    /* r1_w11: factor of m[1].motor'' */
    c->r1_w11_w2_m__1__motor = REAL(453.0) * product_13 / REAL(215600.0);
}

/* r1_w12: coefficients */
static void bound_compute_r1_w12(khepera_built_threshold_coefficients *c, real product,
        real product_2, real product_14)
{
    /* khepera.bg:17: r1_w12: factor of m[1].motor' */
    c->r1_w12_w1_m__1__motor = REAL(453.0) * product / REAL(431200.0);

    /* r1_w12: factor of m[1].motor'' */
    c->r1_w12_w2_m__1__motor = REAL(453.0) * product_14 / REAL(431200.0);

    /* r1_w12: factor of Fx[1] */
    c->r1_w12_Fx__1 = REAL(453.0) * product_2 / REAL(431200.0);
}

/* r1_w13: coefficients */
static void bound_compute_r1_w13(khepera_built_threshold_coefficients *c,
        const khepera_built_parameters *p, real w, real sum, real sum_2, real product,
        real product_2, real product_5, real product_6)
{
    /* khepera.bg:17: r1_w13: factor of m[1].motor' */
    c->r1_w13_w1_m__1__motor = REAL(453.0) * product / REAL(1078000.0);

    /* r1_w13: factor of m[1].motor'' */
    c->r1_w13_w2_m__1__motor = REAL(453.0) * p->m__1__el__k * p->m__1__el__k * w
            * (-REAL(2.0) * p->m__1__el__L * sum / p->m__1__el__k / p->m__1__el__k / p->m__1__el__k
            - REAL(2.0) * p->m__1__el__Re * sum_2 / p->m__1__el__k / p->m__1__el__k
                / p->m__1__el__k)
            / REAL(2156000.0);

    /* r1_w13: factor of m[1].motor''' */
    c->r1_w13_w3_m__1__motor = REAL(453.0) * product_5 / REAL(1078000.0);

    /* r1_w13: factor of Fx[1] */
    c->r1_w13_Fx__1 = REAL(453.0) * product_2 / REAL(1078000.0);

    /* r1_w13: factor of Fx[1]' */
    c->r1_w13_w1_Fx__1 = REAL(453.0) * product_6 / REAL(1078000.0);
}

/* r1: coefficients */
static void bound_compute_r1(khepera_built_threshold_coefficients *c,
        const khepera_built_parameters *p, real w)
{
    /* khepera.bg:17: m[1].fe + m[1].fs/m[1].ge.N^2 */
    const real sum = p->m__1__fe + p->m__1__fs / p->m__1__ge__N / p->m__1__ge__N;

    /* m[1].Je + m[1].Js/m[1].ge.N^2 */
    const real sum_2 = p->m__1__Je + p->m__1__Js / p->m__1__ge__N / p->m__1__ge__N;

    /* m[1].el.Re*(m[1].fe + m[1].fs/m[1].ge.N^2)/m[1].el.k */
    const real product = p->m__1__el__Re * sum / p->m__1__el__k;

    /* m[1].R*m[1].el.Re/(m[1].el.k*m[1].ge.N) */
    const real product_2 = p->m__1__R * p->m__1__el__Re / p->m__1__el__k / p->m__1__ge__N;

    /* m[1].el.L*(m[1].Je + m[1].Js/m[1].ge.N^2)*w^2/m[1].el.k */
    const real product_5 = p->m__1__el__L * sum_2 * w * w / p->m__1__el__k;

    /* m[1].R*m[1].el.L*w/(m[1].el.k*m[1].ge.N) */
    const real product_6 = p->m__1__R * p->m__1__el__L * w / p->m__1__el__k / p->m__1__ge__N;

    real fe_times_Re_over_k;
    real product_9;
    real product_10;
    real product_11;
    real product_12;
    real product_13;
    real product_14;

    bound_compute_fe_times_Re_over_k_to_product_14(c, p, w, sum_2, &fe_times_Re_over_k, &product_9,
            &product_10, &product_11, &product_12, &product_13, &product_14);
    bound_compute_r1_w4(c, product, product_2, product_14);
    bound_compute_r1_w5(c, p, w, sum, sum_2, product_2, product_5, product_6);

    /* khepera.bg:17: r1_w6: factor of m[1].motor' */
    c->r1_w6_w1_m__1__motor = REAL(453.0) * fe_times_Re_over_k / REAL(86240.0);

    /* r1_w7: factor of m[1].motor' */
    c->r1_w7_w1_m__1__motor = REAL(453.0) * fe_times_Re_over_k / REAL(215600.0);

    /* r1_w7: factor of m[1].motor'' */
    c->r1_w7_w2_m__1__motor = REAL(453.0) * product_9 / REAL(215600.0);

    /* r1_w8: factor of m[1].motor'' */
    c->r1_w8_w2_m__1__motor = REAL(453.0) * product_10 / REAL(431200.0);

    /* r1_w9: factor of m[1].motor'' */
    c->r1_w9_w2_m__1__motor = REAL(453.0) * product_10 / REAL(1078000.0);

    /* r1_w9: factor of m[1].motor''' */
    c->r1_w9_w3_m__1__motor = REAL(453.0) * product_11 / REAL(1078000.0);

    bound_compute_r1_w10_to_r1_w11(c, product_12, product_13);
    bound_compute_r1_w12(c, product, product_2, product_14);
    bound_compute_r1_w13(c, p, w, sum, sum_2, product, product_2, product_5, product_6);
}

/* filter: coefficients */
static void bound_compute_filter(khepera_built_threshold_coefficients *c, real pole, real turn,
        real sum_5)
{
    /* turn^2 */
    const real turn_2 = turn * turn;

    /* filter: what is left of a memory a sample later */
    c->a = pole;

    /* filter: weight of a sample, new and a sample later */
    c->b = REAL(0.5) * sum_5;

    /* filter: 1 * (w*sample_time)^2/12 */
    c->bend1 = turn_2 / REAL(12.0);

    /* filter: 2 * (w*sample_time)^2/12 */
    c->bend2 = turn_2 / REAL(6.0);

    /* filter: 3 * (w*sample_time)^2/12 */
    c->bend3 = REAL(0.25) * turn_2;
}

/* m[2].fe*m[2].el.Re/m[2].el.k; ...; m[2].el.Re*(m[2].Je + m[2].Js/m[2].ge.N^2)*w/m[2].el.k */
static void bound_compute_fe_times_Re_over_k_2_to_product_20(khepera_built_threshold_coefficients
            *c,
        const khepera_built_parameters *p, real w, real sum_4, real *fe_times_Re_over_k_2_out,
        real *product_15_out, real *product_16_out, real *product_17_out, real *product_18_out,
        real *product_19_out, real *product_20_out)
{
    /* khepera.bg:17: m[2].fe*m[2].el.Re/m[2].el.k */
    const real fe_times_Re_over_k_2 = p->m__2__fe * p->m__2__el__Re / p->m__2__el__k;

    /* m[2].fe*m[2].el.L*w/m[2].el.k */
    const real product_15 = p->m__2__fe * p->m__2__el__L * w / p->m__2__el__k;

    /* m[2].Js*m[2].el.Re*w/(m[2].el.k*m[2].ge.N^2) */
    const real product_16 = p->m__2__Js * p->m__2__el__Re * w / p->m__2__el__k / p->m__2__ge__N
            / p->m__2__ge__N;

    /* m[2].Js*m[2].el.L*w^2/(m[2].el.k*m[2].ge.N^2) */
    const real product_17 = p->m__2__Js * p->m__2__el__L * w * w / p->m__2__el__k / p->m__2__ge__N
            / p->m__2__ge__N;

    /* m[2].fs*m[2].el.Re/(m[2].el.k*m[2].ge.N^2) */
    const real product_18 = p->m__2__fs * p->m__2__el__Re / p->m__2__el__k / p->m__2__ge__N
            / p->m__2__ge__N;

    /* m[2].fs*m[2].el.L*w/(m[2].el.k*m[2].ge.N^2) */
    const real product_19 = p->m__2__fs * p->m__2__el__L * w / p->m__2__el__k / p->m__2__ge__N
            / p->m__2__ge__N;

    /* m[2].el.Re*(m[2].Je + m[2].Js/m[2].ge.N^2)*w/m[2].el.k */
    const real product_20 = p->m__2__el__Re * sum_4 * w / p->m__2__el__k;

    /* r2_w1: factor of m[2].motor' */
    c->r2_w1_w1_m__2__motor = fe_times_Re_over_k_2 / REAL(10.0);

    /* r2_w1: factor of m[2].motor'' */
    c->r2_w1_w2_m__2__motor = product_15 / REAL(10.0);

    /* r2_w2: factor of m[2].motor'' */
    c->r2_w2_w2_m__2__motor = product_16 / REAL(50.0);

    /* r2_w2: factor of m[2].motor''' */
    c->r2_w2_w3_m__2__motor = product_17 / REAL(50.0);

    /* r2_w3: factor of m[2].motor' */
    c->r2_w3_w1_m__2__motor = product_18 / REAL(10.0);

    /* r2_w3: factor of m[2].motor'' */
    c->r2_w3_w2_m__2__motor = product_19 / REAL(10.0);

    *fe_times_Re_over_k_2_out = fe_times_Re_over_k_2;
    *product_15_out = product_15;
    *product_16_out = product_16;
    *product_17_out = product_17;
    *product_18_out = product_18;
    *product_19_out = product_19;
    *product_20_out = product_20;
}

/* r2_w4: coefficients */
static void bound_compute_r2_w4(khepera_built_threshold_coefficients *c, real product_3,
        real product_4, real product_20)
{
    /* khepera.bg:17: r2_w4: factor of Fx[2] */
    c->r2_w4_Fx__2 = product_4 / REAL(20.0);

    /* r2_w4: factor of m[2].motor' */
    c->r2_w4_w1_m__2__motor = product_3 / REAL(20.0);

    /* r2_w4: factor of m[2].motor'' */
    c->r2_w4_w2_m__2__motor = product_20 / REAL(20.0);
}

/* r2_w5: coefficients */
static void bound_compute_r2_w5(khepera_built_threshold_coefficients *c,
        const khepera_built_parameters *p, real w, real sum_3, real sum_4, real product_4,
        real product_7, real product_8)
{
    /* khepera.bg:17: r2_w5: factor of m[2].motor' */
    c->r2_w5_w1_m__2__motor = p->m__2__el__k
            * (p->m__2__el__Re * sum_3 / p->m__2__el__k / p->m__2__el__k
            - REAL(1.0)) / REAL(50.0);

    /* r2_w5: factor of m[2].motor'' */
    c->r2_w5_w2_m__2__motor = p->m__2__el__k * w
            * (p->m__2__el__Re * sum_4 / p->m__2__el__k / p->m__2__el__k
            + p->m__2__el__L * sum_3 / p->m__2__el__k / p->m__2__el__k) / REAL(50.0);

    /* r2_w5: factor of m[2].motor''' */
    c->r2_w5_w3_m__2__motor = product_7 / REAL(50.0);

    /* r2_w5: factor of Fx[2] */
    c->r2_w5_Fx__2 = product_4 / REAL(50.0);

    /* r2_w5: factor of Fx[2]' */
    c->r2_w5_w1_Fx__2 = product_8 / REAL(50.0);
}

/* r2_w10 to r2_w11: coefficients */
static void bound_compute_r2_w10_to_r2_w11(khepera_built_threshold_coefficients *c, real product_18,
        real product_19)
{
    /* khepera.bg:17: r2_w10: factor of m[2].motor' */
    c->r2_w10_w1_m__2__motor = REAL(453.0) * product_18 / REAL(86240.0);

    /* r2_w11: factor of m[2].motor' */
    c->r2_w11_w1_m__2__motor = REAL(453.0) * product_18 / REAL(215600.0);

    /* r2_w11: factor of m[2].motor'' */
    c->r2_w11_w2_m__2__motor = REAL(453.0) * product_19 / REAL(215600.0);
}

/* r2_w12: coefficients */
static void bound_compute_r2_w12(khepera_built_threshold_coefficients *c, real product_3,
        real product_4, real product_20)
{
    /* khepera.bg:17: r2_w12: factor of m[2].motor' */
    c->r2_w12_w1_m__2__motor = REAL(453.0) * product_3 / REAL(431200.0);

    /* r2_w12: factor of m[2].motor'' */
    c->r2_w12_w2_m__2__motor = REAL(453.0) * product_20 / REAL(431200.0);

    /* r2_w12: factor of Fx[2] */
    c->r2_w12_Fx__2 = REAL(453.0) * product_4 / REAL(431200.0);
}

/* r2_w13: coefficients */
static void bound_compute_r2_w13(khepera_built_threshold_coefficients *c,
        const khepera_built_parameters *p, real w, real sum_3, real sum_4, real product_3,
        real product_4, real product_7, real product_8)
{
    /* khepera.bg:17: r2_w13: factor of m[2].motor' */
    c->r2_w13_w1_m__2__motor = REAL(453.0) * product_3 / REAL(1078000.0);

    /* r2_w13: factor of m[2].motor'' */
    c->r2_w13_w2_m__2__motor = REAL(453.0) * p->m__2__el__k * p->m__2__el__k * w
            * (-REAL(2.0) * p->m__2__el__L * sum_3 / p->m__2__el__k / p->m__2__el__k
                / p->m__2__el__k
            - REAL(2.0) * p->m__2__el__Re * sum_4 / p->m__2__el__k / p->m__2__el__k
                / p->m__2__el__k)
            / REAL(2156000.0);

    /* r2_w13: factor of m[2].motor''' */
    c->r2_w13_w3_m__2__motor = REAL(453.0) * product_7 / REAL(1078000.0);

    /* r2_w13: factor of Fx[2] */
    c->r2_w13_Fx__2 = REAL(453.0) * product_4 / REAL(1078000.0);

    /* r2_w13: factor of Fx[2]' */
    c->r2_w13_w1_Fx__2 = REAL(453.0) * product_8 / REAL(1078000.0);
}

/* r2: coefficients */
static void bound_compute_r2(khepera_built_threshold_coefficients *c,
        const khepera_built_parameters *p, real w)
{
    /* khepera.bg:17: m[2].fe + m[2].fs/m[2].ge.N^2 */
    const real sum_3 = p->m__2__fe + p->m__2__fs / p->m__2__ge__N / p->m__2__ge__N;

    /* m[2].Je + m[2].Js/m[2].ge.N^2 */
    const real sum_4 = p->m__2__Je + p->m__2__Js / p->m__2__ge__N / p->m__2__ge__N;

    /* m[2].el.Re*(m[2].fe + m[2].fs/m[2].ge.N^2)/m[2].el.k */
    const real product_3 = p->m__2__el__Re * sum_3 / p->m__2__el__k;

    /* m[2].R*m[2].el.Re/(m[2].el.k*m[2].ge.N) */
    const real product_4 = p->m__2__R * p->m__2__el__Re / p->m__2__el__k / p->m__2__ge__N;

    /* m[2].el.L*(m[2].Je + m[2].Js/m[2].ge.N^2)*w^2/m[2].el.k */
    const real product_7 = p->m__2__el__L * sum_4 * w * w / p->m__2__el__k;

    /* m[2].R*m[2].el.L*w/(m[2].el.k*m[2].ge.N) */
    const real product_8 = p->m__2__R * p->m__2__el__L * w / p->m__2__el__k / p->m__2__ge__N;

    real fe_times_Re_over_k_2;
    real product_15;
    real product_16;
    real product_17;
    real product_18;
    real product_19;
    real product_20;

    bound_compute_fe_times_Re_over_k_2_to_product_20(c, p, w, sum_4, &fe_times_Re_over_k_2,
            &product_15, &product_16, &product_17, &product_18, &product_19, &product_20);
    bound_compute_r2_w4(c, product_3, product_4, product_20);
    bound_compute_r2_w5(c, p, w, sum_3, sum_4, product_4, product_7, product_8);

    /* khepera.bg:17: r2_w6: factor of m[2].motor' */
    c->r2_w6_w1_m__2__motor = REAL(453.0) * fe_times_Re_over_k_2 / REAL(86240.0);

    /* r2_w7: factor of m[2].motor' */
    c->r2_w7_w1_m__2__motor = REAL(453.0) * fe_times_Re_over_k_2 / REAL(215600.0);

    /* r2_w7: factor of m[2].motor'' */
    c->r2_w7_w2_m__2__motor = REAL(453.0) * product_15 / REAL(215600.0);

    /* r2_w8: factor of m[2].motor'' */
    c->r2_w8_w2_m__2__motor = REAL(453.0) * product_16 / REAL(431200.0);

    /* r2_w9: factor of m[2].motor'' */
    c->r2_w9_w2_m__2__motor = REAL(453.0) * product_16 / REAL(1078000.0);

    /* r2_w9: factor of m[2].motor''' */
    c->r2_w9_w3_m__2__motor = REAL(453.0) * product_17 / REAL(1078000.0);

    bound_compute_r2_w10_to_r2_w11(c, product_18, product_19);
    bound_compute_r2_w12(c, product_3, product_4, product_20);
    bound_compute_r2_w13(c, p, w, sum_3, sum_4, product_3, product_4, product_7, product_8);
}

/* The coefficients, from the parameters. */
static void bound_compute_coefficients(khepera_built_threshold_coefficients *c,
        const khepera_built_parameters *p, real sample_time, real bandwidth)
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
    const real sum_5 = REAL(1.0) - pole;

    /* speed of m[1].motor for one count */
    c->m__1__motor_gain = REAL(884279719003555.0) * (REAL(1.0)
            - REAL(0.5) * sum_5) * w / REAL(3377699720527872.0);

    bound_compute_r1(c, p, w);
    bound_compute_filter(c, pole, turn, sum_5);
    bound_compute_r2(c, p, w);
}

static bool bound_coefficients_are_finite(const khepera_built_threshold_coefficients *c)
{
    return finite_number(c->r1_w1_w1_m__1__motor + c->m__1__motor_gain + c->a + c->b
            + c->r1_w1_w2_m__1__motor + c->bend1 + c->r1_w2_w2_m__1__motor + c->r1_w2_w3_m__1__motor
            + c->r1_w3_w1_m__1__motor + c->r1_w3_w2_m__1__motor + c->r1_w4_Fx__1
            + c->r1_w4_w1_m__1__motor + c->r1_w4_w2_m__1__motor + c->bend2 + c->r1_w5_w1_m__1__motor
            + c->r1_w5_w2_m__1__motor + c->r1_w5_w3_m__1__motor + c->r1_w5_Fx__1 + c->r1_w5_w1_Fx__1
            + c->bend3 + c->r1_w6_w1_m__1__motor + c->r1_w7_w1_m__1__motor + c->r1_w7_w2_m__1__motor
            + c->r1_w8_w2_m__1__motor + c->r1_w9_w2_m__1__motor + c->r1_w9_w3_m__1__motor
            + c->r1_w10_w1_m__1__motor + c->r1_w11_w1_m__1__motor + c->r1_w11_w2_m__1__motor
            + c->r1_w12_w1_m__1__motor + c->r1_w12_w2_m__1__motor + c->r1_w12_Fx__1
            + c->r1_w13_w1_m__1__motor + c->r1_w13_w2_m__1__motor + c->r1_w13_w3_m__1__motor
            + c->r1_w13_Fx__1 + c->r1_w13_w1_Fx__1 + c->r2_w1_w1_m__2__motor
            + c->r2_w1_w2_m__2__motor + c->r2_w2_w2_m__2__motor + c->r2_w2_w3_m__2__motor
            + c->r2_w3_w1_m__2__motor + c->r2_w3_w2_m__2__motor + c->r2_w4_Fx__2
            + c->r2_w4_w1_m__2__motor + c->r2_w4_w2_m__2__motor + c->r2_w5_w1_m__2__motor
            + c->r2_w5_w2_m__2__motor + c->r2_w5_w3_m__2__motor + c->r2_w5_Fx__2 + c->r2_w5_w1_Fx__2
            + c->r2_w6_w1_m__2__motor + c->r2_w7_w1_m__2__motor + c->r2_w7_w2_m__2__motor
            + c->r2_w8_w2_m__2__motor + c->r2_w9_w2_m__2__motor + c->r2_w9_w3_m__2__motor
            + c->r2_w10_w1_m__2__motor + c->r2_w11_w1_m__2__motor + c->r2_w11_w2_m__2__motor
            + c->r2_w12_w1_m__2__motor + c->r2_w12_w2_m__2__motor + c->r2_w12_Fx__2
            + c->r2_w13_w1_m__2__motor + c->r2_w13_w2_m__2__motor + c->r2_w13_w3_m__2__motor
            + c->r2_w13_Fx__2 + c->r2_w13_w1_Fx__2);
}

khepera_built_status khepera_built_threshold_configure(
    khepera_built_threshold_coefficients *coefficients,
    const khepera_built_parameters *parameters,
    khepera_built_real sample_time,
    khepera_built_real bandwidth)
{
    khepera_built_threshold_coefficients *c = coefficients;
    const khepera_built_status status = checked(parameters, sample_time, bandwidth);
    int k;

    for (k = 0; k < KHEPERA_BUILT_RESIDUALS; ++k) {
        c->settle[k] = UINT32_MAX;
    }
    c->longest = UINT32_MAX;
    if (status != KHEPERA_BUILT_OK) {
        return status;
    }
    bound_compute_coefficients(c, parameters, sample_time, bandwidth);
    if (!bound_coefficients_are_finite(c)) {
        return KHEPERA_BUILT_BAD_COEFFICIENT;
    }
    c->settle[KHEPERA_BUILT_R1] = samples(REAL(13.062240779188071), sample_time, bandwidth);
    c->settle[KHEPERA_BUILT_R2] = samples(REAL(13.062240779188071), sample_time, bandwidth);
    c->settle[KHEPERA_BUILT_R3] = samples(REAL(6.907755278982138), sample_time, bandwidth);
    c->longest = c->settle[KHEPERA_BUILT_R1];
    return KHEPERA_BUILT_OK;
}

/* a stage of the filter; on the first sample it is at rest */
static void bound_r1_w1_a_to_w1_b(const khepera_built_threshold_coefficients *c,
        khepera_built_threshold_memory *x, bool first, real *w1_a_out, real *w1_b_out)
{
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

    *w1_a_out = w1_a;
    *w1_b_out = w1_b;
}

/* what the tolerance of m[1].fe can do */
static real bound_r1_w1(const khepera_built_threshold_coefficients *c,
        khepera_built_threshold_memory *x, real w1_a, real w1_b)
{
    const khepera_built_threshold_encoders *e = &x->e;

    /* filtered speed of m[1].motor */
    const real w1_m__1__motor_speed_2 = c->a * x->r1_w1_m__1__motor_speed
        + c->m__1__motor_gain * (real)e->m__1__motor.increment;
    x->r1_w1_m__1__motor_speed = w1_m__1__motor_speed_2;

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

/* filtered speed of m[1].motor */
static real bound_r1_w2_m__1__motor_speed_2(const khepera_built_threshold_coefficients *c,
        khepera_built_threshold_memory *x, bool first)
{
    const khepera_built_threshold_encoders *e = &x->e;

    if (first) {
        /* nothing is remembered yet */
        x->r1_w2_m__1__motor_speed = REAL(0.0);
        x->r1_w2_s4 = REAL(0.0);
        x->r1_w2_s3 = REAL(0.0);
        x->r1_w2_s2 = REAL(0.0);
        x->r1_w2_s1 = REAL(0.0);
    }

    /* filtered speed of m[1].motor */
    const real w2_m__1__motor_speed_2 = c->a * x->r1_w2_m__1__motor_speed
        + c->m__1__motor_gain * (real)e->m__1__motor.increment;
    x->r1_w2_m__1__motor_speed = w2_m__1__motor_speed_2;

    return w2_m__1__motor_speed_2;
}

/* what the tolerance of m[1].Js can do */
static real bound_r1_w2(const khepera_built_threshold_coefficients *c,
        khepera_built_threshold_memory *x, real w1_a, real w1_b, real w2_m__1__motor_speed_2)
{
    /* r1_w2: encoders, order 2 */
    const real w2_n2 = -c->r1_w2_w2_m__1__motor * w2_m__1__motor_speed_2;

    /* r1_w2: error of order 2 */
    const real w2_e2 = c->bend1 * w2_n2;

    /* r1_w2: encoders, order 3 */
    const real w2_n3 = -c->r1_w2_w3_m__1__motor * w2_m__1__motor_speed_2;

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

/* filtered speed of m[1].motor */
static real bound_r1_w3_m__1__motor_speed_2(const khepera_built_threshold_coefficients *c,
        khepera_built_threshold_memory *x, bool first)
{
    const khepera_built_threshold_encoders *e = &x->e;

    if (first) {
        /* nothing is remembered yet */
        x->r1_w3_m__1__motor_speed = REAL(0.0);
        x->r1_w3_s4 = REAL(0.0);
        x->r1_w3_s3 = REAL(0.0);
        x->r1_w3_s2 = REAL(0.0);
        x->r1_w3_s1 = REAL(0.0);
    }

    /* filtered speed of m[1].motor */
    const real w3_m__1__motor_speed_2 = c->a * x->r1_w3_m__1__motor_speed
        + c->m__1__motor_gain * (real)e->m__1__motor.increment;
    x->r1_w3_m__1__motor_speed = w3_m__1__motor_speed_2;

    return w3_m__1__motor_speed_2;
}

/* what the tolerance of m[1].fs can do */
static real bound_r1_w3(const khepera_built_threshold_coefficients *c,
        khepera_built_threshold_memory *x, real w1_a, real w1_b, real w3_m__1__motor_speed_2)
{
    /* r1_w3: encoders, order 1 */
    const real w3_n1 = -c->r1_w3_w1_m__1__motor * w3_m__1__motor_speed_2;

    /* r1_w3: error of order 1 */
    const real w3_e1 = c->bend1 * w3_n1;

    /* r1_w3: encoders, order 2 */
    const real w3_n2 = -c->r1_w3_w2_m__1__motor * w3_m__1__motor_speed_2;

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

/* filtered speed of m[1].motor */
static real bound_r1_w4_m__1__motor_speed_2(const khepera_built_threshold_coefficients *c,
        khepera_built_threshold_memory *x, bool first)
{
    const khepera_built_threshold_encoders *e = &x->e;

    if (first) {
        /* nothing is remembered yet */
        x->r1_w4_m__1__motor_speed = REAL(0.0);
        x->r1_w4_s4 = REAL(0.0);
        x->r1_w4_s3 = REAL(0.0);
        x->r1_w4_s2 = REAL(0.0);
        x->r1_w4_s1 = REAL(0.0);
    }

    /* filtered speed of m[1].motor */
    const real w4_m__1__motor_speed_2 = c->a * x->r1_w4_m__1__motor_speed
        + c->m__1__motor_gain * (real)e->m__1__motor.increment;
    x->r1_w4_m__1__motor_speed = w4_m__1__motor_speed_2;

    return w4_m__1__motor_speed_2;
}

/* what the tolerance of m[1].el.Re can do */
static real bound_r1_w4(const khepera_built_threshold_coefficients *c,
        khepera_built_threshold_memory *x, const khepera_built_samples *s, real w1_a, real w1_b,
        real w4_m__1__motor_speed_2)
{
    /* r1_w4: encoders, order 1 */
    const real w4_n1 = -c->r1_w4_w1_m__1__motor * w4_m__1__motor_speed_2;

    /* r1_w4: error of order 1 */
    const real w4_e1 = c->bend1 * w4_n1;

    /* r1_w4: encoders, order 2 */
    const real w4_n2 = -c->r1_w4_w2_m__1__motor * w4_m__1__motor_speed_2;

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

    /* what the tolerance of m[1].el.Re can do */
    const real w4 = w4_y1;

    return w4;
}

/* filtered speed of m[1].motor */
static real bound_r1_w5_m__1__motor_speed_2(const khepera_built_threshold_coefficients *c,
        khepera_built_threshold_memory *x, bool first)
{
    const khepera_built_threshold_encoders *e = &x->e;

    if (first) {
        /* nothing is remembered yet */
        x->r1_w5_m__1__motor_speed = REAL(0.0);
        x->r1_w5_s4 = REAL(0.0);
        x->r1_w5_s3 = REAL(0.0);
        x->r1_w5_s2 = REAL(0.0);
        x->r1_w5_s1 = REAL(0.0);
    }

    /* filtered speed of m[1].motor */
    const real w5_m__1__motor_speed_2 = c->a * x->r1_w5_m__1__motor_speed
        + c->m__1__motor_gain * (real)e->m__1__motor.increment;
    x->r1_w5_m__1__motor_speed = w5_m__1__motor_speed_2;

    return w5_m__1__motor_speed_2;
}

/* what the tolerance of m[1].el.k can do */
static real bound_r1_w5(const khepera_built_threshold_coefficients *c,
        khepera_built_threshold_memory *x, const khepera_built_samples *s, real w1_a, real w1_b,
        real w5_n1, real w5_e1, real w5_n2, real w5_e2, real w5_n3)
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
static real bound_r1_w6(const khepera_built_threshold_coefficients *c,
        khepera_built_threshold_memory *x, bool first, real w1_a, real w1_b)
{
    const khepera_built_threshold_encoders *e = &x->e;

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
        + c->m__1__motor_gain * (real)e->m__1__motor.increment;
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
static real bound_r1_w7(const khepera_built_threshold_coefficients *c,
        khepera_built_threshold_memory *x, real w1_a, real w1_b)
{
    const khepera_built_threshold_encoders *e = &x->e;

    /* filtered speed of m[1].motor */
    const real w7_m__1__motor_speed_2 = c->a * x->r1_w7_m__1__motor_speed
        + c->m__1__motor_gain * (real)e->m__1__motor.increment;
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
static real bound_r1_w8(const khepera_built_threshold_coefficients *c,
        khepera_built_threshold_memory *x, bool first, real w1_a, real w1_b)
{
    const khepera_built_threshold_encoders *e = &x->e;

    if (first) {
        /* nothing is remembered yet */
        x->r1_w8_m__1__motor_speed = REAL(0.0);
        x->r1_w8_s4 = REAL(0.0);
        x->r1_w8_s3 = REAL(0.0);
        x->r1_w8_s2 = REAL(0.0);
        x->r1_w8_s1 = REAL(0.0);
    }

    /* filtered speed of m[1].motor */
    const real w8_m__1__motor_speed_2 = c->a * x->r1_w8_m__1__motor_speed
        + c->m__1__motor_gain * (real)e->m__1__motor.increment;
    x->r1_w8_m__1__motor_speed = w8_m__1__motor_speed_2;

    /* r1_w8: encoders, order 2 */
    const real w8_n2 = -c->r1_w8_w2_m__1__motor * w8_m__1__motor_speed_2;

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
        x->r1_w9_m__1__motor_speed = REAL(0.0);
        x->r1_w9_s4 = REAL(0.0);
        x->r1_w9_s3 = REAL(0.0);
        x->r1_w9_s2 = REAL(0.0);
        x->r1_w9_s1 = REAL(0.0);
    }

    return w8;
}

/* what the tolerances of m[1].Js and m[1].el.k can do together */
static real bound_r1_w9(const khepera_built_threshold_coefficients *c,
        khepera_built_threshold_memory *x, real w1_a, real w1_b)
{
    const khepera_built_threshold_encoders *e = &x->e;

    /* filtered speed of m[1].motor */
    const real w9_m__1__motor_speed_2 = c->a * x->r1_w9_m__1__motor_speed
        + c->m__1__motor_gain * (real)e->m__1__motor.increment;
    x->r1_w9_m__1__motor_speed = w9_m__1__motor_speed_2;

    /* r1_w9: encoders, order 2 */
    const real w9_n2 = c->r1_w9_w2_m__1__motor * w9_m__1__motor_speed_2;

    /* r1_w9: error of order 2 */
    const real w9_e2 = c->bend1 * w9_n2;

    /* r1_w9: encoders, order 3 */
    const real w9_n3 = c->r1_w9_w3_m__1__motor * w9_m__1__motor_speed_2;

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
static real bound_r1_w10(const khepera_built_threshold_coefficients *c,
        khepera_built_threshold_memory *x, bool first, real w1_a, real w1_b)
{
    const khepera_built_threshold_encoders *e = &x->e;

    if (first) {
        /* nothing is remembered yet */
        x->r1_w10_m__1__motor_speed = REAL(0.0);
        x->r1_w10_s4 = REAL(0.0);
        x->r1_w10_s3 = REAL(0.0);
        x->r1_w10_s2 = REAL(0.0);
        x->r1_w10_s1 = REAL(0.0);
    }

    /* filtered speed of m[1].motor */
    const real w10_m__1__motor_speed_2 = c->a * x->r1_w10_m__1__motor_speed
        + c->m__1__motor_gain * (real)e->m__1__motor.increment;
    x->r1_w10_m__1__motor_speed = w10_m__1__motor_speed_2;

    /* r1_w10: encoders, order 1 */
    const real w10_n1 = -c->r1_w10_w1_m__1__motor * w10_m__1__motor_speed_2;

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
        x->r1_w11_m__1__motor_speed = REAL(0.0);
        x->r1_w11_s4 = REAL(0.0);
        x->r1_w11_s3 = REAL(0.0);
        x->r1_w11_s2 = REAL(0.0);
        x->r1_w11_s1 = REAL(0.0);
    }

    return w10;
}

/* what the tolerances of m[1].fs and m[1].el.k can do together */
static real bound_r1_w11(const khepera_built_threshold_coefficients *c,
        khepera_built_threshold_memory *x, real w1_a, real w1_b)
{
    const khepera_built_threshold_encoders *e = &x->e;

    /* filtered speed of m[1].motor */
    const real w11_m__1__motor_speed_2 = c->a * x->r1_w11_m__1__motor_speed
        + c->m__1__motor_gain * (real)e->m__1__motor.increment;
    x->r1_w11_m__1__motor_speed = w11_m__1__motor_speed_2;

    /* r1_w11: encoders, order 1 */
    const real w11_n1 = c->r1_w11_w1_m__1__motor * w11_m__1__motor_speed_2;

    /* r1_w11: error of order 1 */
    const real w11_e1 = c->bend1 * w11_n1;

    /* r1_w11: encoders, order 2 */
    const real w11_n2 = c->r1_w11_w2_m__1__motor * w11_m__1__motor_speed_2;

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
static real bound_r1_w12_m__1__motor_speed_2(const khepera_built_threshold_coefficients *c,
        khepera_built_threshold_memory *x, bool first)
{
    const khepera_built_threshold_encoders *e = &x->e;

    if (first) {
        /* nothing is remembered yet */
        x->r1_w12_m__1__motor_speed = REAL(0.0);
        x->r1_w12_s4 = REAL(0.0);
        x->r1_w12_s3 = REAL(0.0);
        x->r1_w12_s2 = REAL(0.0);
        x->r1_w12_s1 = REAL(0.0);
    }

    /* filtered speed of m[1].motor */
    const real w12_m__1__motor_speed_2 = c->a * x->r1_w12_m__1__motor_speed
        + c->m__1__motor_gain * (real)e->m__1__motor.increment;
    x->r1_w12_m__1__motor_speed = w12_m__1__motor_speed_2;

    return w12_m__1__motor_speed_2;
}

/* what the tolerances of m[1].el.Re and m[1].el.k can do together */
static real bound_r1_w12(const khepera_built_threshold_coefficients *c,
        khepera_built_threshold_memory *x, const khepera_built_samples *s, real w1_a, real w1_b,
        real w12_m__1__motor_speed_2)
{
    /* r1_w12: encoders, order 1 */
    const real w12_n1 = c->r1_w12_w1_m__1__motor * w12_m__1__motor_speed_2;

    /* r1_w12: error of order 1 */
    const real w12_e1 = c->bend1 * w12_n1;

    /* r1_w12: encoders, order 2 */
    const real w12_n2 = c->r1_w12_w2_m__1__motor * w12_m__1__motor_speed_2;

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

    /* what the tolerances of m[1].el.Re and m[1].el.k can do together */
    const real w12 = w12_y1;

    return w12;
}

/* encoders, order 1; ...; encoders, order 3 */
static void bound_r1_w13_n1_to_w13_n3(const khepera_built_threshold_coefficients *c,
        khepera_built_threshold_memory *x, bool first, real *w13_n1_out, real *w13_e1_out,
        real *w13_n2_out, real *w13_e2_out, real *w13_n3_out)
{
    const khepera_built_threshold_encoders *e = &x->e;

    if (first) {
        /* nothing is remembered yet */
        x->r1_w13_m__1__motor_speed = REAL(0.0);
        x->r1_w13_s4 = REAL(0.0);
        x->r1_w13_s3 = REAL(0.0);
        x->r1_w13_s2 = REAL(0.0);
        x->r1_w13_s1 = REAL(0.0);
    }

    /* filtered speed of m[1].motor */
    const real w13_m__1__motor_speed_2 = c->a * x->r1_w13_m__1__motor_speed
        + c->m__1__motor_gain * (real)e->m__1__motor.increment;
    x->r1_w13_m__1__motor_speed = w13_m__1__motor_speed_2;

    /* r1_w13: encoders, order 1 */
    const real w13_n1 = -c->r1_w13_w1_m__1__motor * w13_m__1__motor_speed_2;

    /* r1_w13: error of order 1 */
    const real w13_e1 = c->bend2 * w13_n1;

    /* r1_w13: encoders, order 2 */
    const real w13_n2 = c->r1_w13_w2_m__1__motor * w13_m__1__motor_speed_2;

    /* r1_w13: error of order 2 */
    const real w13_e2 = c->bend1 * w13_n2;

    /* r1_w13: encoders, order 3 */
    const real w13_n3 = -c->r1_w13_w3_m__1__motor * w13_m__1__motor_speed_2;

    *w13_n1_out = w13_n1;
    *w13_e1_out = w13_e1;
    *w13_n2_out = w13_n2;
    *w13_e2_out = w13_e2;
    *w13_n3_out = w13_n3;
}

/* second order of what the tolerance of m[1].el.k can do */
static real bound_r1_w13(const khepera_built_threshold_coefficients *c,
        khepera_built_threshold_memory *x, const khepera_built_samples *s, real w1_a, real w1_b,
        real w13_n1, real w13_e1, real w13_n2, real w13_e2, real w13_n3)
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
    const khepera_built_threshold_coefficients *c, khepera_built_threshold_memory *x, const khepera_built_samples *s, real *r)
{
    const bool first = x->youngest == 0u && x->age[0] == 0u;

    count_on(&x->e.m__1__motor, s->m__1__motor, first);

    real w1_a;
    real w1_b;

    bound_r1_w1_a_to_w1_b(c, x, first, &w1_a, &w1_b);
    const real w1 = bound_r1_w1(c, x, w1_a, w1_b);
    const real w2_m__1__motor_speed_2 = bound_r1_w2_m__1__motor_speed_2(c, x, first);
    const real w2 = bound_r1_w2(c, x, w1_a, w1_b, w2_m__1__motor_speed_2);
    const real w3_m__1__motor_speed_2 = bound_r1_w3_m__1__motor_speed_2(c, x, first);
    const real w3 = bound_r1_w3(c, x, w1_a, w1_b, w3_m__1__motor_speed_2);
    const real w4_m__1__motor_speed_2 = bound_r1_w4_m__1__motor_speed_2(c, x, first);
    const real w4 = bound_r1_w4(c, x, s, w1_a, w1_b, w4_m__1__motor_speed_2);
    const real w5_m__1__motor_speed_2 = bound_r1_w5_m__1__motor_speed_2(c, x, first);

    /* r1_w5: encoders, order 1 */
    const real w5_n1 = c->r1_w5_w1_m__1__motor * w5_m__1__motor_speed_2;

    /* r1_w5: error of order 1 */
    const real w5_e1 = c->bend2 * w5_n1;

    /* r1_w5: encoders, order 2 */
    const real w5_n2 = c->r1_w5_w2_m__1__motor * w5_m__1__motor_speed_2;

    /* r1_w5: error of order 2 */
    const real w5_e2 = c->bend1 * w5_n2;

    /* r1_w5: encoders, order 3 */
    const real w5_n3 = c->r1_w5_w3_m__1__motor * w5_m__1__motor_speed_2;

    const real w5 = bound_r1_w5(c, x, s, w1_a, w1_b, w5_n1, w5_e1, w5_n2, w5_e2, w5_n3);
    const real w6 = bound_r1_w6(c, x, first, w1_a, w1_b);
    const real w7 = bound_r1_w7(c, x, w1_a, w1_b);
    const real w8 = bound_r1_w8(c, x, first, w1_a, w1_b);
    const real w9 = bound_r1_w9(c, x, w1_a, w1_b);
    const real w10 = bound_r1_w10(c, x, first, w1_a, w1_b);
    const real w11 = bound_r1_w11(c, x, w1_a, w1_b);
    const real w12_m__1__motor_speed_2 = bound_r1_w12_m__1__motor_speed_2(c, x, first);
    const real w12 = bound_r1_w12(c, x, s, w1_a, w1_b, w12_m__1__motor_speed_2);

    real w13_n1;
    real w13_e1;
    real w13_n2;
    real w13_e2;
    real w13_n3;

    bound_r1_w13_n1_to_w13_n3(c, x, first, &w13_n1, &w13_e1, &w13_n2, &w13_e2, &w13_n3);
    const real w13 = bound_r1_w13(c, x, s, w1_a, w1_b, w13_n1, w13_e1, w13_n2, w13_e2, w13_n3);

    r[KHEPERA_BUILT_R1] = MATH(fabs)(w1) + MATH(fabs)(w2) + MATH(fabs)(w3) + MATH(fabs)(w4)
        + MATH(fabs)(w5) + MATH(fabs)(w6) + MATH(fabs)(w7) + MATH(fabs)(w8) + MATH(fabs)(w9)
        + MATH(fabs)(w10) + MATH(fabs)(w11) + MATH(fabs)(w12) + MATH(fabs)(w13);
}

/* a stage of the filter; on the first sample it is at rest */
static void bound_r2_w1_a_to_w1_b(const khepera_built_threshold_coefficients *c,
        khepera_built_threshold_memory *x, bool first, real *w1_a_out, real *w1_b_out)
{
    if (first) {
        /* nothing is remembered yet */
        x->r2_w1_m__2__motor_speed = REAL(0.0);
        x->r2_w1_s4 = REAL(0.0);
        x->r2_w1_s3 = REAL(0.0);
        x->r2_w1_s2 = REAL(0.0);
        x->r2_w1_s1 = REAL(0.0);
    }

    /* r2_w1: a stage of the filter; on the first sample it is at rest */
    const real w1_a = first ? -c->b : c->a;
    const real w1_b = first ? REAL(1.0) : c->b;

    *w1_a_out = w1_a;
    *w1_b_out = w1_b;
}

/* what the tolerance of m[2].fe can do */
static real bound_r2_w1(const khepera_built_threshold_coefficients *c,
        khepera_built_threshold_memory *x, real w1_a, real w1_b)
{
    const khepera_built_threshold_encoders *e = &x->e;

    /* filtered speed of m[2].motor */
    const real w1_m__2__motor_speed_2 = c->a * x->r2_w1_m__2__motor_speed
        + c->m__1__motor_gain * (real)e->m__2__motor.increment;
    x->r2_w1_m__2__motor_speed = w1_m__2__motor_speed_2;

    /* r2_w1: encoders, order 1 */
    const real w1_n1 = -c->r2_w1_w1_m__2__motor * w1_m__2__motor_speed_2;

    /* r2_w1: error of order 1 */
    const real w1_e1 = c->bend1 * w1_n1;

    /* r2_w1: encoders, order 2 */
    const real w1_n2 = -c->r2_w1_w2_m__2__motor * w1_m__2__motor_speed_2;

    /* r2_w1: degree 1 */
    const real w1_d1 = w1_n1 + w1_n2;

    /* r2_w1: degree 2 */
    const real w1_d2 = w1_n2 - w1_e1;

    /* r2_w1: the filter multiplied out */
    const real w1_p2_1 = w1_d2 + w1_e1;
    const real w1_p1_1 = w1_p2_1 + w1_e1;
    const real w1_p1_2 = w1_d1 - w1_p2_1;

    /* r2_w1: stage 4 */
    const real w1_u4 = w1_n1 - w1_p1_2;
    const real w1_y4 = x->r2_w1_s4 + w1_b * w1_u4;
    x->r2_w1_s4 = w1_a * w1_y4 + w1_b * w1_u4;

    /* r2_w1: stage 3 */
    const real w1_u3 = w1_y4 + w1_p1_2 - w1_p1_1;
    const real w1_y3 = x->r2_w1_s3 + w1_b * w1_u3;
    x->r2_w1_s3 = w1_a * w1_y3 + w1_b * w1_u3;

    /* r2_w1: stage 2 */
    const real w1_u2 = w1_y3 + w1_p1_1 + w1_e1;
    const real w1_y2 = x->r2_w1_s2 + w1_b * w1_u2;
    x->r2_w1_s2 = w1_a * w1_y2 + w1_b * w1_u2;

    /* r2_w1: stage 1 */
    const real w1_u1 = w1_y2 - w1_e1;
    const real w1_y1 = x->r2_w1_s1 + w1_b * w1_u1;
    x->r2_w1_s1 = w1_a * w1_y1 + w1_b * w1_u1;

    /* what the tolerance of m[2].fe can do */
    const real w1 = w1_y1;

    return w1;
}

/* filtered speed of m[2].motor */
static real bound_r2_w2_m__2__motor_speed_2(const khepera_built_threshold_coefficients *c,
        khepera_built_threshold_memory *x, bool first)
{
    const khepera_built_threshold_encoders *e = &x->e;

    if (first) {
        /* nothing is remembered yet */
        x->r2_w2_m__2__motor_speed = REAL(0.0);
        x->r2_w2_s4 = REAL(0.0);
        x->r2_w2_s3 = REAL(0.0);
        x->r2_w2_s2 = REAL(0.0);
        x->r2_w2_s1 = REAL(0.0);
    }

    /* filtered speed of m[2].motor */
    const real w2_m__2__motor_speed_2 = c->a * x->r2_w2_m__2__motor_speed
        + c->m__1__motor_gain * (real)e->m__2__motor.increment;
    x->r2_w2_m__2__motor_speed = w2_m__2__motor_speed_2;

    return w2_m__2__motor_speed_2;
}

/* what the tolerance of m[2].Js can do */
static real bound_r2_w2(const khepera_built_threshold_coefficients *c,
        khepera_built_threshold_memory *x, real w1_a, real w1_b, real w2_m__2__motor_speed_2)
{
    /* r2_w2: encoders, order 2 */
    const real w2_n2 = -c->r2_w2_w2_m__2__motor * w2_m__2__motor_speed_2;

    /* r2_w2: error of order 2 */
    const real w2_e2 = c->bend1 * w2_n2;

    /* r2_w2: encoders, order 3 */
    const real w2_n3 = -c->r2_w2_w3_m__2__motor * w2_m__2__motor_speed_2;

    /* r2_w2: degree 2 */
    const real w2_d2 = w2_n2 + w2_n3;

    /* r2_w2: degree 3 */
    const real w2_d3 = w2_n3 - w2_e2;

    /* r2_w2: the filter multiplied out */
    const real w2_p3_1 = w2_d3 + w2_e2;
    const real w2_p2_1 = w2_p3_1 + w2_e2;
    const real w2_p2_2 = w2_d2 - w2_p3_1;
    const real w2_p1_1 = w2_p2_1 + w2_e2;
    const real w2_p1_2 = w2_p2_2 - w2_p2_1;
    const real w2_p1_3 = w2_n2 - w2_p2_2;

    /* r2_w2: stage 4 */
    const real w2_u4 = -w2_p1_3;
    const real w2_y4 = x->r2_w2_s4 + w1_b * w2_u4;
    x->r2_w2_s4 = w1_a * w2_y4 + w1_b * w2_u4;

    /* r2_w2: stage 3 */
    const real w2_u3 = w2_y4 + w2_p1_3 - w2_p1_2;
    const real w2_y3 = x->r2_w2_s3 + w1_b * w2_u3;
    x->r2_w2_s3 = w1_a * w2_y3 + w1_b * w2_u3;

    /* r2_w2: stage 2 */
    const real w2_u2 = w2_y3 + w2_p1_2 - w2_p1_1;
    const real w2_y2 = x->r2_w2_s2 + w1_b * w2_u2;
    x->r2_w2_s2 = w1_a * w2_y2 + w1_b * w2_u2;

    /* r2_w2: stage 1 */
    const real w2_u1 = w2_y2 + w2_p1_1 + w2_e2;
    const real w2_y1 = x->r2_w2_s1 + w1_b * w2_u1;
    x->r2_w2_s1 = w1_a * w2_y1 + w1_b * w2_u1;

    /* what the tolerance of m[2].Js can do */
    const real w2 = w2_y1 - w2_e2;

    return w2;
}

/* filtered speed of m[2].motor */
static real bound_r2_w3_m__2__motor_speed_2(const khepera_built_threshold_coefficients *c,
        khepera_built_threshold_memory *x, bool first)
{
    const khepera_built_threshold_encoders *e = &x->e;

    if (first) {
        /* nothing is remembered yet */
        x->r2_w3_m__2__motor_speed = REAL(0.0);
        x->r2_w3_s4 = REAL(0.0);
        x->r2_w3_s3 = REAL(0.0);
        x->r2_w3_s2 = REAL(0.0);
        x->r2_w3_s1 = REAL(0.0);
    }

    /* filtered speed of m[2].motor */
    const real w3_m__2__motor_speed_2 = c->a * x->r2_w3_m__2__motor_speed
        + c->m__1__motor_gain * (real)e->m__2__motor.increment;
    x->r2_w3_m__2__motor_speed = w3_m__2__motor_speed_2;

    return w3_m__2__motor_speed_2;
}

/* what the tolerance of m[2].fs can do */
static real bound_r2_w3(const khepera_built_threshold_coefficients *c,
        khepera_built_threshold_memory *x, real w1_a, real w1_b, real w3_m__2__motor_speed_2)
{
    /* r2_w3: encoders, order 1 */
    const real w3_n1 = -c->r2_w3_w1_m__2__motor * w3_m__2__motor_speed_2;

    /* r2_w3: error of order 1 */
    const real w3_e1 = c->bend1 * w3_n1;

    /* r2_w3: encoders, order 2 */
    const real w3_n2 = -c->r2_w3_w2_m__2__motor * w3_m__2__motor_speed_2;

    /* r2_w3: degree 1 */
    const real w3_d1 = w3_n1 + w3_n2;

    /* r2_w3: degree 2 */
    const real w3_d2 = w3_n2 - w3_e1;

    /* r2_w3: the filter multiplied out */
    const real w3_p2_1 = w3_d2 + w3_e1;
    const real w3_p1_1 = w3_p2_1 + w3_e1;
    const real w3_p1_2 = w3_d1 - w3_p2_1;

    /* r2_w3: stage 4 */
    const real w3_u4 = w3_n1 - w3_p1_2;
    const real w3_y4 = x->r2_w3_s4 + w1_b * w3_u4;
    x->r2_w3_s4 = w1_a * w3_y4 + w1_b * w3_u4;

    /* r2_w3: stage 3 */
    const real w3_u3 = w3_y4 + w3_p1_2 - w3_p1_1;
    const real w3_y3 = x->r2_w3_s3 + w1_b * w3_u3;
    x->r2_w3_s3 = w1_a * w3_y3 + w1_b * w3_u3;

    /* r2_w3: stage 2 */
    const real w3_u2 = w3_y3 + w3_p1_1 + w3_e1;
    const real w3_y2 = x->r2_w3_s2 + w1_b * w3_u2;
    x->r2_w3_s2 = w1_a * w3_y2 + w1_b * w3_u2;

    /* r2_w3: stage 1 */
    const real w3_u1 = w3_y2 - w3_e1;
    const real w3_y1 = x->r2_w3_s1 + w1_b * w3_u1;
    x->r2_w3_s1 = w1_a * w3_y1 + w1_b * w3_u1;

    /* what the tolerance of m[2].fs can do */
    const real w3 = w3_y1;

    return w3;
}

/* filtered speed of m[2].motor */
static real bound_r2_w4_m__2__motor_speed_2(const khepera_built_threshold_coefficients *c,
        khepera_built_threshold_memory *x, bool first)
{
    const khepera_built_threshold_encoders *e = &x->e;

    if (first) {
        /* nothing is remembered yet */
        x->r2_w4_m__2__motor_speed = REAL(0.0);
        x->r2_w4_s4 = REAL(0.0);
        x->r2_w4_s3 = REAL(0.0);
        x->r2_w4_s2 = REAL(0.0);
        x->r2_w4_s1 = REAL(0.0);
    }

    /* filtered speed of m[2].motor */
    const real w4_m__2__motor_speed_2 = c->a * x->r2_w4_m__2__motor_speed
        + c->m__1__motor_gain * (real)e->m__2__motor.increment;
    x->r2_w4_m__2__motor_speed = w4_m__2__motor_speed_2;

    return w4_m__2__motor_speed_2;
}

/* what the tolerance of m[2].el.Re can do */
static real bound_r2_w4(const khepera_built_threshold_coefficients *c,
        khepera_built_threshold_memory *x, const khepera_built_samples *s, real w1_a, real w1_b,
        real w4_m__2__motor_speed_2)
{
    /* r2_w4: encoders, order 1 */
    const real w4_n1 = -c->r2_w4_w1_m__2__motor * w4_m__2__motor_speed_2;

    /* r2_w4: error of order 1 */
    const real w4_e1 = c->bend1 * w4_n1;

    /* r2_w4: encoders, order 2 */
    const real w4_n2 = -c->r2_w4_w2_m__2__motor * w4_m__2__motor_speed_2;

    /* r2_w4: terms of order 0 */
    const real w4_g0 = c->r2_w4_Fx__2 * s->Fx__2;

    /* r2_w4: degree 1 */
    const real w4_d1 = w4_n1 + w4_n2;

    /* r2_w4: error of order 0 */
    const real w4_e0 = c->bend2 * w4_g0;

    /* r2_w4: degree 2 */
    const real w4_d2 = w4_n2 + w4_e0 - w4_e1;

    /* r2_w4: the filter multiplied out */
    const real w4_p2_1 = w4_d2 + w4_e1;
    const real w4_p1_1 = w4_p2_1 + w4_e1;
    const real w4_p1_2 = w4_d1 - w4_p2_1;

    /* r2_w4: stage 4 */
    const real w4_u4 = w4_n1 - w4_g0 - w4_p1_2;
    const real w4_y4 = x->r2_w4_s4 + w1_b * w4_u4;
    x->r2_w4_s4 = w1_a * w4_y4 + w1_b * w4_u4;

    /* r2_w4: stage 3 */
    const real w4_u3 = w4_y4 + w4_p1_2 - w4_p1_1;
    const real w4_y3 = x->r2_w4_s3 + w1_b * w4_u3;
    x->r2_w4_s3 = w1_a * w4_y3 + w1_b * w4_u3;

    /* r2_w4: stage 2 */
    const real w4_u2 = w4_y3 + w4_p1_1 + w4_e1;
    const real w4_y2 = x->r2_w4_s2 + w1_b * w4_u2;
    x->r2_w4_s2 = w1_a * w4_y2 + w1_b * w4_u2;

    /* r2_w4: stage 1 */
    const real w4_u1 = w4_y2 - w4_e1;
    const real w4_y1 = x->r2_w4_s1 + w1_b * w4_u1;
    x->r2_w4_s1 = w1_a * w4_y1 + w1_b * w4_u1;

    /* what the tolerance of m[2].el.Re can do */
    const real w4 = w4_y1;

    return w4;
}

/* filtered speed of m[2].motor */
static real bound_r2_w5_m__2__motor_speed_2(const khepera_built_threshold_coefficients *c,
        khepera_built_threshold_memory *x, bool first)
{
    const khepera_built_threshold_encoders *e = &x->e;

    if (first) {
        /* nothing is remembered yet */
        x->r2_w5_m__2__motor_speed = REAL(0.0);
        x->r2_w5_s4 = REAL(0.0);
        x->r2_w5_s3 = REAL(0.0);
        x->r2_w5_s2 = REAL(0.0);
        x->r2_w5_s1 = REAL(0.0);
    }

    /* filtered speed of m[2].motor */
    const real w5_m__2__motor_speed_2 = c->a * x->r2_w5_m__2__motor_speed
        + c->m__1__motor_gain * (real)e->m__2__motor.increment;
    x->r2_w5_m__2__motor_speed = w5_m__2__motor_speed_2;

    return w5_m__2__motor_speed_2;
}

/* what the tolerance of m[2].el.k can do */
static real bound_r2_w5(const khepera_built_threshold_coefficients *c,
        khepera_built_threshold_memory *x, const khepera_built_samples *s, real w1_a, real w1_b,
        real w5_n1, real w5_e1, real w5_n2, real w5_e2, real w5_n3)
{
    /* r2_w5: terms of order 0 */
    const real w5_g0 = c->r2_w5_Fx__2 * s->Fx__2;

    /* r2_w5: terms of order 1 */
    const real w5_g1 = c->r2_w5_w1_Fx__2 * s->Fx__2;

    /* r2_w5: degree 1 */
    const real w5_d1 = w5_g1 + w5_n1 + w5_n2;

    /* r2_w5: error of order 0 */
    const real w5_e0 = c->bend3 * w5_g0;

    /* r2_w5: degree 2 */
    const real w5_d2 = w5_n2 + w5_n3 - w5_e1 - w5_e0;

    /* r2_w5: error of order 1 */
    const real w5_e1_2 = c->bend2 * w5_g1;

    /* r2_w5: degree 3 */
    const real w5_d3 = w5_n3 - w5_e1 - w5_e2 - w5_e1_2;

    /* r2_w5: the filter multiplied out */
    const real w5_p3_1 = w5_d3 + w5_e2;
    const real w5_p2_1 = w5_p3_1 + w5_e2;
    const real w5_p2_2 = w5_d2 - w5_p3_1;
    const real w5_p1_1 = w5_p2_1 + w5_e2;
    const real w5_p1_2 = w5_p2_2 - w5_p2_1;
    const real w5_p1_3 = w5_d1 - w5_p2_2;

    /* r2_w5: stage 4 */
    const real w5_u4 = w5_g0 + w5_n1 - w5_p1_3;
    const real w5_y4 = x->r2_w5_s4 + w1_b * w5_u4;
    x->r2_w5_s4 = w1_a * w5_y4 + w1_b * w5_u4;

    /* r2_w5: stage 3 */
    const real w5_u3 = w5_y4 + w5_p1_3 - w5_p1_2;
    const real w5_y3 = x->r2_w5_s3 + w1_b * w5_u3;
    x->r2_w5_s3 = w1_a * w5_y3 + w1_b * w5_u3;

    /* r2_w5: stage 2 */
    const real w5_u2 = w5_y3 + w5_p1_2 - w5_p1_1;
    const real w5_y2 = x->r2_w5_s2 + w1_b * w5_u2;
    x->r2_w5_s2 = w1_a * w5_y2 + w1_b * w5_u2;

    /* r2_w5: stage 1 */
    const real w5_u1 = w5_y2 + w5_p1_1 + w5_e2;
    const real w5_y1 = x->r2_w5_s1 + w1_b * w5_u1;
    x->r2_w5_s1 = w1_a * w5_y1 + w1_b * w5_u1;

    /* what the tolerance of m[2].el.k can do */
    const real w5 = w5_y1 - w5_e2;

    return w5;
}

/* what the tolerances of m[2].fe and m[2].el.Re can do together */
static real bound_r2_w6(const khepera_built_threshold_coefficients *c,
        khepera_built_threshold_memory *x, bool first, real w1_a, real w1_b)
{
    const khepera_built_threshold_encoders *e = &x->e;

    if (first) {
        /* nothing is remembered yet */
        x->r2_w6_m__2__motor_speed = REAL(0.0);
        x->r2_w6_s4 = REAL(0.0);
        x->r2_w6_s3 = REAL(0.0);
        x->r2_w6_s2 = REAL(0.0);
        x->r2_w6_s1 = REAL(0.0);
    }

    /* filtered speed of m[2].motor */
    const real w6_m__2__motor_speed_2 = c->a * x->r2_w6_m__2__motor_speed
        + c->m__1__motor_gain * (real)e->m__2__motor.increment;
    x->r2_w6_m__2__motor_speed = w6_m__2__motor_speed_2;

    /* r2_w6: encoders, order 1 */
    const real w6_n1 = -c->r2_w6_w1_m__2__motor * w6_m__2__motor_speed_2;

    /* r2_w6: stage 4 */
    const real w6_u4 = w6_n1 - w6_n1;
    const real w6_y4 = x->r2_w6_s4 + w1_b * w6_u4;
    x->r2_w6_s4 = w1_a * w6_y4 + w1_b * w6_u4;

    /* r2_w6: stage 3 */
    const real w6_u3 = w6_y4 + w6_n1;
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

    /* what the tolerances of m[2].fe and m[2].el.Re can do together */
    const real w6 = w6_y1;

    if (first) {
        /* nothing is remembered yet */
        x->r2_w7_m__2__motor_speed = REAL(0.0);
        x->r2_w7_s4 = REAL(0.0);
        x->r2_w7_s3 = REAL(0.0);
        x->r2_w7_s2 = REAL(0.0);
        x->r2_w7_s1 = REAL(0.0);
    }

    return w6;
}

/* what the tolerances of m[2].fe and m[2].el.k can do together */
static real bound_r2_w7(const khepera_built_threshold_coefficients *c,
        khepera_built_threshold_memory *x, real w1_a, real w1_b)
{
    const khepera_built_threshold_encoders *e = &x->e;

    /* filtered speed of m[2].motor */
    const real w7_m__2__motor_speed_2 = c->a * x->r2_w7_m__2__motor_speed
        + c->m__1__motor_gain * (real)e->m__2__motor.increment;
    x->r2_w7_m__2__motor_speed = w7_m__2__motor_speed_2;

    /* r2_w7: encoders, order 1 */
    const real w7_n1 = c->r2_w7_w1_m__2__motor * w7_m__2__motor_speed_2;

    /* r2_w7: error of order 1 */
    const real w7_e1 = c->bend1 * w7_n1;

    /* r2_w7: encoders, order 2 */
    const real w7_n2 = c->r2_w7_w2_m__2__motor * w7_m__2__motor_speed_2;

    /* r2_w7: degree 1 */
    const real w7_d1 = w7_n1 + w7_n2;

    /* r2_w7: degree 2 */
    const real w7_d2 = w7_n2 - w7_e1;

    /* r2_w7: the filter multiplied out */
    const real w7_p2_1 = w7_d2 + w7_e1;
    const real w7_p1_1 = w7_p2_1 + w7_e1;
    const real w7_p1_2 = w7_d1 - w7_p2_1;

    /* r2_w7: stage 4 */
    const real w7_u4 = w7_n1 - w7_p1_2;
    const real w7_y4 = x->r2_w7_s4 + w1_b * w7_u4;
    x->r2_w7_s4 = w1_a * w7_y4 + w1_b * w7_u4;

    /* r2_w7: stage 3 */
    const real w7_u3 = w7_y4 + w7_p1_2 - w7_p1_1;
    const real w7_y3 = x->r2_w7_s3 + w1_b * w7_u3;
    x->r2_w7_s3 = w1_a * w7_y3 + w1_b * w7_u3;

    /* r2_w7: stage 2 */
    const real w7_u2 = w7_y3 + w7_p1_1 + w7_e1;
    const real w7_y2 = x->r2_w7_s2 + w1_b * w7_u2;
    x->r2_w7_s2 = w1_a * w7_y2 + w1_b * w7_u2;

    /* r2_w7: stage 1 */
    const real w7_u1 = w7_y2 - w7_e1;
    const real w7_y1 = x->r2_w7_s1 + w1_b * w7_u1;
    x->r2_w7_s1 = w1_a * w7_y1 + w1_b * w7_u1;

    /* what the tolerances of m[2].fe and m[2].el.k can do together */
    const real w7 = w7_y1;

    return w7;
}

/* what the tolerances of m[2].Js and m[2].el.Re can do together */
static real bound_r2_w8(const khepera_built_threshold_coefficients *c,
        khepera_built_threshold_memory *x, bool first, real w1_a, real w1_b)
{
    const khepera_built_threshold_encoders *e = &x->e;

    if (first) {
        /* nothing is remembered yet */
        x->r2_w8_m__2__motor_speed = REAL(0.0);
        x->r2_w8_s4 = REAL(0.0);
        x->r2_w8_s3 = REAL(0.0);
        x->r2_w8_s2 = REAL(0.0);
        x->r2_w8_s1 = REAL(0.0);
    }

    /* filtered speed of m[2].motor */
    const real w8_m__2__motor_speed_2 = c->a * x->r2_w8_m__2__motor_speed
        + c->m__1__motor_gain * (real)e->m__2__motor.increment;
    x->r2_w8_m__2__motor_speed = w8_m__2__motor_speed_2;

    /* r2_w8: encoders, order 2 */
    const real w8_n2 = -c->r2_w8_w2_m__2__motor * w8_m__2__motor_speed_2;

    /* r2_w8: the filter multiplied out */
    const real w8_p1_1 = w8_n2 - w8_n2;

    /* r2_w8: stage 4 */
    const real w8_u4 = -w8_p1_1;
    const real w8_y4 = x->r2_w8_s4 + w1_b * w8_u4;
    x->r2_w8_s4 = w1_a * w8_y4 + w1_b * w8_u4;

    /* r2_w8: stage 3 */
    const real w8_u3 = w8_y4 + w8_p1_1 - w8_n2;
    const real w8_y3 = x->r2_w8_s3 + w1_b * w8_u3;
    x->r2_w8_s3 = w1_a * w8_y3 + w1_b * w8_u3;

    /* r2_w8: stage 2 */
    const real w8_u2 = w8_y3 + w8_n2;
    const real w8_y2 = x->r2_w8_s2 + w1_b * w8_u2;
    x->r2_w8_s2 = w1_a * w8_y2 + w1_b * w8_u2;

    /* r2_w8: stage 1 */
    const real w8_u1 = w8_y2;
    const real w8_y1 = x->r2_w8_s1 + w1_b * w8_u1;
    x->r2_w8_s1 = w1_a * w8_y1 + w1_b * w8_u1;

    /* what the tolerances of m[2].Js and m[2].el.Re can do together */
    const real w8 = w8_y1;

    if (first) {
        /* nothing is remembered yet */
        x->r2_w9_m__2__motor_speed = REAL(0.0);
        x->r2_w9_s4 = REAL(0.0);
        x->r2_w9_s3 = REAL(0.0);
        x->r2_w9_s2 = REAL(0.0);
        x->r2_w9_s1 = REAL(0.0);
    }

    return w8;
}

/* what the tolerances of m[2].Js and m[2].el.k can do together */
static real bound_r2_w9(const khepera_built_threshold_coefficients *c,
        khepera_built_threshold_memory *x, real w1_a, real w1_b)
{
    const khepera_built_threshold_encoders *e = &x->e;

    /* filtered speed of m[2].motor */
    const real w9_m__2__motor_speed_2 = c->a * x->r2_w9_m__2__motor_speed
        + c->m__1__motor_gain * (real)e->m__2__motor.increment;
    x->r2_w9_m__2__motor_speed = w9_m__2__motor_speed_2;

    /* r2_w9: encoders, order 2 */
    const real w9_n2 = c->r2_w9_w2_m__2__motor * w9_m__2__motor_speed_2;

    /* r2_w9: error of order 2 */
    const real w9_e2 = c->bend1 * w9_n2;

    /* r2_w9: encoders, order 3 */
    const real w9_n3 = c->r2_w9_w3_m__2__motor * w9_m__2__motor_speed_2;

    /* r2_w9: degree 2 */
    const real w9_d2 = w9_n2 + w9_n3;

    /* r2_w9: degree 3 */
    const real w9_d3 = w9_n3 - w9_e2;

    /* r2_w9: the filter multiplied out */
    const real w9_p3_1 = w9_d3 + w9_e2;
    const real w9_p2_1 = w9_p3_1 + w9_e2;
    const real w9_p2_2 = w9_d2 - w9_p3_1;
    const real w9_p1_1 = w9_p2_1 + w9_e2;
    const real w9_p1_2 = w9_p2_2 - w9_p2_1;
    const real w9_p1_3 = w9_n2 - w9_p2_2;

    /* r2_w9: stage 4 */
    const real w9_u4 = -w9_p1_3;
    const real w9_y4 = x->r2_w9_s4 + w1_b * w9_u4;
    x->r2_w9_s4 = w1_a * w9_y4 + w1_b * w9_u4;

    /* r2_w9: stage 3 */
    const real w9_u3 = w9_y4 + w9_p1_3 - w9_p1_2;
    const real w9_y3 = x->r2_w9_s3 + w1_b * w9_u3;
    x->r2_w9_s3 = w1_a * w9_y3 + w1_b * w9_u3;

    /* r2_w9: stage 2 */
    const real w9_u2 = w9_y3 + w9_p1_2 - w9_p1_1;
    const real w9_y2 = x->r2_w9_s2 + w1_b * w9_u2;
    x->r2_w9_s2 = w1_a * w9_y2 + w1_b * w9_u2;

    /* r2_w9: stage 1 */
    const real w9_u1 = w9_y2 + w9_p1_1 + w9_e2;
    const real w9_y1 = x->r2_w9_s1 + w1_b * w9_u1;
    x->r2_w9_s1 = w1_a * w9_y1 + w1_b * w9_u1;

    /* what the tolerances of m[2].Js and m[2].el.k can do together */
    const real w9 = w9_y1 - w9_e2;

    return w9;
}

/* what the tolerances of m[2].fs and m[2].el.Re can do together */
static real bound_r2_w10(const khepera_built_threshold_coefficients *c,
        khepera_built_threshold_memory *x, bool first, real w1_a, real w1_b)
{
    const khepera_built_threshold_encoders *e = &x->e;

    if (first) {
        /* nothing is remembered yet */
        x->r2_w10_m__2__motor_speed = REAL(0.0);
        x->r2_w10_s4 = REAL(0.0);
        x->r2_w10_s3 = REAL(0.0);
        x->r2_w10_s2 = REAL(0.0);
        x->r2_w10_s1 = REAL(0.0);
    }

    /* filtered speed of m[2].motor */
    const real w10_m__2__motor_speed_2 = c->a * x->r2_w10_m__2__motor_speed
        + c->m__1__motor_gain * (real)e->m__2__motor.increment;
    x->r2_w10_m__2__motor_speed = w10_m__2__motor_speed_2;

    /* r2_w10: encoders, order 1 */
    const real w10_n1 = -c->r2_w10_w1_m__2__motor * w10_m__2__motor_speed_2;

    /* r2_w10: stage 4 */
    const real w10_u4 = w10_n1 - w10_n1;
    const real w10_y4 = x->r2_w10_s4 + w1_b * w10_u4;
    x->r2_w10_s4 = w1_a * w10_y4 + w1_b * w10_u4;

    /* r2_w10: stage 3 */
    const real w10_u3 = w10_y4 + w10_n1;
    const real w10_y3 = x->r2_w10_s3 + w1_b * w10_u3;
    x->r2_w10_s3 = w1_a * w10_y3 + w1_b * w10_u3;

    /* r2_w10: stage 2 */
    const real w10_u2 = w10_y3;
    const real w10_y2 = x->r2_w10_s2 + w1_b * w10_u2;
    x->r2_w10_s2 = w1_a * w10_y2 + w1_b * w10_u2;

    /* r2_w10: stage 1 */
    const real w10_u1 = w10_y2;
    const real w10_y1 = x->r2_w10_s1 + w1_b * w10_u1;
    x->r2_w10_s1 = w1_a * w10_y1 + w1_b * w10_u1;

    /* what the tolerances of m[2].fs and m[2].el.Re can do together */
    const real w10 = w10_y1;

    if (first) {
        /* nothing is remembered yet */
        x->r2_w11_m__2__motor_speed = REAL(0.0);
        x->r2_w11_s4 = REAL(0.0);
        x->r2_w11_s3 = REAL(0.0);
        x->r2_w11_s2 = REAL(0.0);
        x->r2_w11_s1 = REAL(0.0);
    }

    return w10;
}

/* what the tolerances of m[2].fs and m[2].el.k can do together */
static real bound_r2_w11(const khepera_built_threshold_coefficients *c,
        khepera_built_threshold_memory *x, real w1_a, real w1_b)
{
    const khepera_built_threshold_encoders *e = &x->e;

    /* filtered speed of m[2].motor */
    const real w11_m__2__motor_speed_2 = c->a * x->r2_w11_m__2__motor_speed
        + c->m__1__motor_gain * (real)e->m__2__motor.increment;
    x->r2_w11_m__2__motor_speed = w11_m__2__motor_speed_2;

    /* r2_w11: encoders, order 1 */
    const real w11_n1 = c->r2_w11_w1_m__2__motor * w11_m__2__motor_speed_2;

    /* r2_w11: error of order 1 */
    const real w11_e1 = c->bend1 * w11_n1;

    /* r2_w11: encoders, order 2 */
    const real w11_n2 = c->r2_w11_w2_m__2__motor * w11_m__2__motor_speed_2;

    /* r2_w11: degree 1 */
    const real w11_d1 = w11_n1 + w11_n2;

    /* r2_w11: degree 2 */
    const real w11_d2 = w11_n2 - w11_e1;

    /* r2_w11: the filter multiplied out */
    const real w11_p2_1 = w11_d2 + w11_e1;
    const real w11_p1_1 = w11_p2_1 + w11_e1;
    const real w11_p1_2 = w11_d1 - w11_p2_1;

    /* r2_w11: stage 4 */
    const real w11_u4 = w11_n1 - w11_p1_2;
    const real w11_y4 = x->r2_w11_s4 + w1_b * w11_u4;
    x->r2_w11_s4 = w1_a * w11_y4 + w1_b * w11_u4;

    /* r2_w11: stage 3 */
    const real w11_u3 = w11_y4 + w11_p1_2 - w11_p1_1;
    const real w11_y3 = x->r2_w11_s3 + w1_b * w11_u3;
    x->r2_w11_s3 = w1_a * w11_y3 + w1_b * w11_u3;

    /* r2_w11: stage 2 */
    const real w11_u2 = w11_y3 + w11_p1_1 + w11_e1;
    const real w11_y2 = x->r2_w11_s2 + w1_b * w11_u2;
    x->r2_w11_s2 = w1_a * w11_y2 + w1_b * w11_u2;

    /* r2_w11: stage 1 */
    const real w11_u1 = w11_y2 - w11_e1;
    const real w11_y1 = x->r2_w11_s1 + w1_b * w11_u1;
    x->r2_w11_s1 = w1_a * w11_y1 + w1_b * w11_u1;

    /* what the tolerances of m[2].fs and m[2].el.k can do together */
    const real w11 = w11_y1;

    return w11;
}

/* filtered speed of m[2].motor */
static real bound_r2_w12_m__2__motor_speed_2(const khepera_built_threshold_coefficients *c,
        khepera_built_threshold_memory *x, bool first)
{
    const khepera_built_threshold_encoders *e = &x->e;

    if (first) {
        /* nothing is remembered yet */
        x->r2_w12_m__2__motor_speed = REAL(0.0);
        x->r2_w12_s4 = REAL(0.0);
        x->r2_w12_s3 = REAL(0.0);
        x->r2_w12_s2 = REAL(0.0);
        x->r2_w12_s1 = REAL(0.0);
    }

    /* filtered speed of m[2].motor */
    const real w12_m__2__motor_speed_2 = c->a * x->r2_w12_m__2__motor_speed
        + c->m__1__motor_gain * (real)e->m__2__motor.increment;
    x->r2_w12_m__2__motor_speed = w12_m__2__motor_speed_2;

    return w12_m__2__motor_speed_2;
}

/* what the tolerances of m[2].el.Re and m[2].el.k can do together */
static real bound_r2_w12(const khepera_built_threshold_coefficients *c,
        khepera_built_threshold_memory *x, const khepera_built_samples *s, real w1_a, real w1_b,
        real w12_m__2__motor_speed_2)
{
    /* r2_w12: encoders, order 1 */
    const real w12_n1 = c->r2_w12_w1_m__2__motor * w12_m__2__motor_speed_2;

    /* r2_w12: error of order 1 */
    const real w12_e1 = c->bend1 * w12_n1;

    /* r2_w12: encoders, order 2 */
    const real w12_n2 = c->r2_w12_w2_m__2__motor * w12_m__2__motor_speed_2;

    /* r2_w12: terms of order 0 */
    const real w12_g0 = c->r2_w12_Fx__2 * s->Fx__2;

    /* r2_w12: degree 1 */
    const real w12_d1 = w12_n1 + w12_n2;

    /* r2_w12: error of order 0 */
    const real w12_e0 = c->bend2 * w12_g0;

    /* r2_w12: degree 2 */
    const real w12_d2 = w12_n2 - w12_e1 - w12_e0;

    /* r2_w12: the filter multiplied out */
    const real w12_p2_1 = w12_d2 + w12_e1;
    const real w12_p1_1 = w12_p2_1 + w12_e1;
    const real w12_p1_2 = w12_d1 - w12_p2_1;

    /* r2_w12: stage 4 */
    const real w12_u4 = w12_g0 + w12_n1 - w12_p1_2;
    const real w12_y4 = x->r2_w12_s4 + w1_b * w12_u4;
    x->r2_w12_s4 = w1_a * w12_y4 + w1_b * w12_u4;

    /* r2_w12: stage 3 */
    const real w12_u3 = w12_y4 + w12_p1_2 - w12_p1_1;
    const real w12_y3 = x->r2_w12_s3 + w1_b * w12_u3;
    x->r2_w12_s3 = w1_a * w12_y3 + w1_b * w12_u3;

    /* r2_w12: stage 2 */
    const real w12_u2 = w12_y3 + w12_p1_1 + w12_e1;
    const real w12_y2 = x->r2_w12_s2 + w1_b * w12_u2;
    x->r2_w12_s2 = w1_a * w12_y2 + w1_b * w12_u2;

    /* r2_w12: stage 1 */
    const real w12_u1 = w12_y2 - w12_e1;
    const real w12_y1 = x->r2_w12_s1 + w1_b * w12_u1;
    x->r2_w12_s1 = w1_a * w12_y1 + w1_b * w12_u1;

    /* what the tolerances of m[2].el.Re and m[2].el.k can do together */
    const real w12 = w12_y1;

    return w12;
}

/* encoders, order 1; ...; encoders, order 3 */
static void bound_r2_w13_n1_to_w13_n3(const khepera_built_threshold_coefficients *c,
        khepera_built_threshold_memory *x, bool first, real *w13_n1_out, real *w13_e1_out,
        real *w13_n2_out, real *w13_e2_out, real *w13_n3_out)
{
    const khepera_built_threshold_encoders *e = &x->e;

    if (first) {
        /* nothing is remembered yet */
        x->r2_w13_m__2__motor_speed = REAL(0.0);
        x->r2_w13_s4 = REAL(0.0);
        x->r2_w13_s3 = REAL(0.0);
        x->r2_w13_s2 = REAL(0.0);
        x->r2_w13_s1 = REAL(0.0);
    }

    /* filtered speed of m[2].motor */
    const real w13_m__2__motor_speed_2 = c->a * x->r2_w13_m__2__motor_speed
        + c->m__1__motor_gain * (real)e->m__2__motor.increment;
    x->r2_w13_m__2__motor_speed = w13_m__2__motor_speed_2;

    /* r2_w13: encoders, order 1 */
    const real w13_n1 = -c->r2_w13_w1_m__2__motor * w13_m__2__motor_speed_2;

    /* r2_w13: error of order 1 */
    const real w13_e1 = c->bend2 * w13_n1;

    /* r2_w13: encoders, order 2 */
    const real w13_n2 = c->r2_w13_w2_m__2__motor * w13_m__2__motor_speed_2;

    /* r2_w13: error of order 2 */
    const real w13_e2 = c->bend1 * w13_n2;

    /* r2_w13: encoders, order 3 */
    const real w13_n3 = -c->r2_w13_w3_m__2__motor * w13_m__2__motor_speed_2;

    *w13_n1_out = w13_n1;
    *w13_e1_out = w13_e1;
    *w13_n2_out = w13_n2;
    *w13_e2_out = w13_e2;
    *w13_n3_out = w13_n3;
}

/* second order of what the tolerance of m[2].el.k can do */
static real bound_r2_w13(const khepera_built_threshold_coefficients *c,
        khepera_built_threshold_memory *x, const khepera_built_samples *s, real w1_a, real w1_b,
        real w13_n1, real w13_e1, real w13_n2, real w13_e2, real w13_n3)
{
    /* r2_w13: terms of order 0 */
    const real w13_g0 = c->r2_w13_Fx__2 * s->Fx__2;

    /* r2_w13: terms of order 1 */
    const real w13_g1 = c->r2_w13_w1_Fx__2 * s->Fx__2;

    /* r2_w13: degree 1 */
    const real w13_d1 = w13_n1 + w13_n2 - w13_g1;

    /* r2_w13: error of order 0 */
    const real w13_e0 = c->bend3 * w13_g0;

    /* r2_w13: degree 2 */
    const real w13_d2 = w13_n2 + w13_n3 + w13_e0 - w13_e1;

    /* r2_w13: error of order 1 */
    const real w13_e1_2 = c->bend2 * w13_g1;

    /* r2_w13: degree 3 */
    const real w13_d3 = w13_n3 + w13_e1_2 - w13_e1 - w13_e2;

    /* r2_w13: the filter multiplied out */
    const real w13_p3_1 = w13_d3 + w13_e2;
    const real w13_p2_1 = w13_p3_1 + w13_e2;
    const real w13_p2_2 = w13_d2 - w13_p3_1;
    const real w13_p1_1 = w13_p2_1 + w13_e2;
    const real w13_p1_2 = w13_p2_2 - w13_p2_1;
    const real w13_p1_3 = w13_d1 - w13_p2_2;

    /* r2_w13: stage 4 */
    const real w13_u4 = w13_n1 - w13_g0 - w13_p1_3;
    const real w13_y4 = x->r2_w13_s4 + w1_b * w13_u4;
    x->r2_w13_s4 = w1_a * w13_y4 + w1_b * w13_u4;

    /* r2_w13: stage 3 */
    const real w13_u3 = w13_y4 + w13_p1_3 - w13_p1_2;
    const real w13_y3 = x->r2_w13_s3 + w1_b * w13_u3;
    x->r2_w13_s3 = w1_a * w13_y3 + w1_b * w13_u3;

    /* r2_w13: stage 2 */
    const real w13_u2 = w13_y3 + w13_p1_2 - w13_p1_1;
    const real w13_y2 = x->r2_w13_s2 + w1_b * w13_u2;
    x->r2_w13_s2 = w1_a * w13_y2 + w1_b * w13_u2;

    /* r2_w13: stage 1 */
    const real w13_u1 = w13_y2 + w13_p1_1 + w13_e2;
    const real w13_y1 = x->r2_w13_s1 + w1_b * w13_u1;
    x->r2_w13_s1 = w1_a * w13_y1 + w1_b * w13_u1;

    /* second order of what the tolerance of m[2].el.k can do */
    const real w13 = w13_y1 - w13_e2;

    return w13;
}

/* r2 on one sample.
 * khepera.bg:17: r2: how far r2 can be from zero if no parameter is out of tolerance */
static void bound_r2(
    const khepera_built_threshold_coefficients *c, khepera_built_threshold_memory *x, const khepera_built_samples *s, real *r)
{
    const bool first = x->youngest == 0u && x->age[1] == 0u;

    count_on(&x->e.m__2__motor, s->m__2__motor, first);

    real w1_a;
    real w1_b;

    bound_r2_w1_a_to_w1_b(c, x, first, &w1_a, &w1_b);
    const real w1 = bound_r2_w1(c, x, w1_a, w1_b);
    const real w2_m__2__motor_speed_2 = bound_r2_w2_m__2__motor_speed_2(c, x, first);
    const real w2 = bound_r2_w2(c, x, w1_a, w1_b, w2_m__2__motor_speed_2);
    const real w3_m__2__motor_speed_2 = bound_r2_w3_m__2__motor_speed_2(c, x, first);
    const real w3 = bound_r2_w3(c, x, w1_a, w1_b, w3_m__2__motor_speed_2);
    const real w4_m__2__motor_speed_2 = bound_r2_w4_m__2__motor_speed_2(c, x, first);
    const real w4 = bound_r2_w4(c, x, s, w1_a, w1_b, w4_m__2__motor_speed_2);
    const real w5_m__2__motor_speed_2 = bound_r2_w5_m__2__motor_speed_2(c, x, first);

    /* r2_w5: encoders, order 1 */
    const real w5_n1 = c->r2_w5_w1_m__2__motor * w5_m__2__motor_speed_2;

    /* r2_w5: error of order 1 */
    const real w5_e1 = c->bend2 * w5_n1;

    /* r2_w5: encoders, order 2 */
    const real w5_n2 = c->r2_w5_w2_m__2__motor * w5_m__2__motor_speed_2;

    /* r2_w5: error of order 2 */
    const real w5_e2 = c->bend1 * w5_n2;

    /* r2_w5: encoders, order 3 */
    const real w5_n3 = c->r2_w5_w3_m__2__motor * w5_m__2__motor_speed_2;

    const real w5 = bound_r2_w5(c, x, s, w1_a, w1_b, w5_n1, w5_e1, w5_n2, w5_e2, w5_n3);
    const real w6 = bound_r2_w6(c, x, first, w1_a, w1_b);
    const real w7 = bound_r2_w7(c, x, w1_a, w1_b);
    const real w8 = bound_r2_w8(c, x, first, w1_a, w1_b);
    const real w9 = bound_r2_w9(c, x, w1_a, w1_b);
    const real w10 = bound_r2_w10(c, x, first, w1_a, w1_b);
    const real w11 = bound_r2_w11(c, x, w1_a, w1_b);
    const real w12_m__2__motor_speed_2 = bound_r2_w12_m__2__motor_speed_2(c, x, first);
    const real w12 = bound_r2_w12(c, x, s, w1_a, w1_b, w12_m__2__motor_speed_2);

    real w13_n1;
    real w13_e1;
    real w13_n2;
    real w13_e2;
    real w13_n3;

    bound_r2_w13_n1_to_w13_n3(c, x, first, &w13_n1, &w13_e1, &w13_n2, &w13_e2, &w13_n3);
    const real w13 = bound_r2_w13(c, x, s, w1_a, w1_b, w13_n1, w13_e1, w13_n2, w13_e2, w13_n3);

    r[KHEPERA_BUILT_R2] = MATH(fabs)(w1) + MATH(fabs)(w2) + MATH(fabs)(w3) + MATH(fabs)(w4)
        + MATH(fabs)(w5) + MATH(fabs)(w6) + MATH(fabs)(w7) + MATH(fabs)(w8) + MATH(fabs)(w9)
        + MATH(fabs)(w10) + MATH(fabs)(w11) + MATH(fabs)(w12) + MATH(fabs)(w13);
}

/* r3 on one sample.
 * khepera.bg:114: r3: how far r3 can be from zero if no parameter is out of tolerance */
static void bound_r3(
    const khepera_built_threshold_coefficients *c, khepera_built_threshold_memory *x, const khepera_built_samples *s, real *r)
{
    (void)c;
    (void)x;
    (void)s;

    r[KHEPERA_BUILT_R3] = REAL(0.0);
}

/* Ages and validity one by one: a number that is not finite makes the next sample the first. */
static void bound_count_samples(
    const khepera_built_threshold_coefficients *c,
    khepera_built_threshold_memory *x,
    khepera_built_residuals *out)
{
    /* the thresholds that are computed, and what each one goes with */
    static const uint8_t number[] = {
        0, 1, 2
    };
    static const uint8_t part[] = {
        0, 1, 2
    };
    bool finite[3];
    int k;

    finite[0] = true;
    finite[1] = true;
    finite[2] = true;
    for (k = 0; k < 3; ++k) {
        finite[part[k]] = finite[part[k]] && finite_number(out->value[number[k]]);
    }
    x->youngest = UINT32_MAX;
    for (k = 0; k < 3; ++k) {
        x->age[k] = finite[k] ? x->age[k] + (x->age[k] < UINT32_MAX ? 1u : 0u) : 0u;
        x->youngest = x->age[k] < x->youngest ? x->age[k] : x->youngest;
    }
    for (k = 0; k < 3; ++k) {
        out->value[number[k]] = finite[part[k]] ? out->value[number[k]] : REAL(0.0);
        out->valid[number[k]] = x->age[part[k]] > c->settle[number[k]];
    }
}

void khepera_built_threshold_reset(khepera_built_threshold_memory *memory)
{
    int k;

    for (k = 0; k < 3; ++k) {
        memory->age[k] = 0u;
    }
    memory->youngest = 0u;
}

void khepera_built_threshold_step(
    const khepera_built_threshold_coefficients *coefficients,
    khepera_built_threshold_memory *memory,
    const khepera_built_samples *samples,
    khepera_built_residuals *thresholds)
{
    const khepera_built_threshold_coefficients *c = coefficients;
    khepera_built_threshold_memory *x = memory;
    const khepera_built_samples *s = samples;
    real *r = thresholds->value;
    int k;

    bound_r1(c, x, s, r);
    bound_r2(c, x, s, r);
    bound_r3(c, x, s, r);
    /* a sum is finite only if all its terms are */
    if (x->youngest > c->longest
            && finite_number(r[KHEPERA_BUILT_R1] + r[KHEPERA_BUILT_R2] + r[KHEPERA_BUILT_R3])) {
        for (k = 0; k < KHEPERA_BUILT_RESIDUALS; ++k) {
            thresholds->valid[k] = true;
        }
    } else {
        bound_count_samples(c, x, thresholds);
    }
}

#endif

const char khepera_built_fault_name[KHEPERA_BUILT_FAULTS][11] = {
    "m[1].Je", "m[1].fe", "m[1].Js", "m[1].fs", "m[1].R", "m[1].el.L", "m[1].el.Re", "m[1].el.k",
    "m[1].ge.N", "Fx[1]", "U0[1]", "m[1].motor", "m[2].Je", "m[2].fe", "m[2].Js", "m[2].fs",
    "m[2].R", "m[2].el.L", "m[2].el.Re", "m[2].el.k", "m[2].ge.N", "Fx[2]", "U0[2]", "m[2].motor",
    "R_L", "Uin", "Us",
};

const uint16_t khepera_built_fault_class[KHEPERA_BUILT_FAULTS] = {
    0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 1u, 1u, 1u, 1u, 1u, 1u, 1u, 1u, 1u, 1u, 1u, 1u,
    2u, 3u, 3u,
};

const char khepera_built_residual_name[KHEPERA_BUILT_RESIDUALS][3] = {
    "r1", "r2", "r3",
};

/*
 * Signatures: the faults of class c are seen by the residuals of entries first_entry[c] and up to
 * first_entry[c + 1].
 */
static const uint32_t first_entry[KHEPERA_BUILT_CLASSES + 1] = {
    0u, 1u, 2u, 3u, 4u,
};

static const uint16_t seen_by[4] = {
    0u, 1u, 2u, 2u,
};

/*
 * Sizes of faults in eighths of an octave: a residual in alarm makes a fault so much larger than
 * what is least here as it is out.
 */
static const uint8_t least_size[4] = {
    1u, 1u, 1u, 1u,
};

/* A residual is sure to show a fault of this size; 255: of no size. */
static const uint8_t sure_size[4] = {
    0u, 0u, 255u, 0u,
};

/* The peak of residual k since it went into alarm, beside what is sure to be one. */
static void remember_peak(
    khepera_built_diagnosis *d, const khepera_built_limit *limit, int k, real out, real bound)
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
static int size_of(const khepera_built_diagnosis *d, int c, int alarms)
{
    const uint32_t begin = first_entry[c];
    const uint32_t end = first_entry[c + 1];
    int size = 0;
    int seen = 0;
    uint32_t i;

    for (i = begin; i < end; ++i) {
        const int k = (int)seen_by[i];

        if (d->state[k] == KHEPERA_BUILT_ALARM) {
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
static khepera_built_candidate left_of(const khepera_built_diagnosis *d, int c, int alarms)
{
    const uint32_t begin = first_entry[c];
    const uint32_t end = first_entry[c + 1];
    const int size = size_of(d, c, alarms);
    uint32_t i;

    if (size < 0) {
        return KHEPERA_BUILT_RULED_OUT;
    }
    if (d->settled < d->window) {
        return KHEPERA_BUILT_LIKELY; /* too soon for what is quiet to say anything */
    }
    for (i = begin; i < end; ++i) {
        const int k = (int)seen_by[i];
        const int sure = (int)sure_size[i];

        if (d->state[k] == KHEPERA_BUILT_HEALTHY && sure != 255 && sure <= size) {
            return KHEPERA_BUILT_SMALL;
        }
    }
    return KHEPERA_BUILT_LIKELY;
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
    khepera_built_diagnosis *d, const khepera_built_limit *limit, int k, real off, real out, real bound)
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

static bool sums_are_zero(const khepera_built_diagnosis *d, int k)
{
    const real sum = d->above[k] + d->below[k] + d->louder[k];

    return !(sum > REAL(0.0));
}

static void forget_sums(khepera_built_diagnosis *d, int k)
{
    d->above[k] = REAL(0.0);
    d->below[k] = REAL(0.0);
    d->louder[k] = REAL(0.0);
    d->streak[k] = 0u;
}

/* How far a residual is beyond its bound; off: from its mean. */
static real excess(real off, real bound)
{
#if defined __GNUC__ && !defined KHEPERA_BUILT_REAL
    return MATH(__builtin_fabs)(off) - bound; /* one instruction, no library */
#else
    return (off < REAL(0.0) ? -off : off) - bound;
#endif
}

static bool is_within(const khepera_built_limit *limit, real value, real bound)
{
    return excess(value - limit->mean, bound) <= limit->level;
}

/* Residual k in one sample; whether it goes into alarm. */
static bool watch(
    khepera_built_diagnosis *d, const khepera_built_limit *limit, int k, real value, real bound, bool row)
{
    const real off = value - limit->mean;
    const real out = excess(off, bound);
    bool high = false;

    if (row) {
        high = add_row(d, limit, k, off, out, bound);
    }
    if (d->state[k] == KHEPERA_BUILT_ALARM) {
        d->since[k] += d->since[k] < UINT32_MAX ? 1u : 0u;
        remember_peak(d, limit, k, out, bound);
        if (!(out < RELEASE * limit->level) || !sums_are_zero(d, k)) {
            d->quiet = 0u;
        }
        return false;
    }
    d->state[k] = KHEPERA_BUILT_HEALTHY;
    d->streak[k] = out > limit->level ? d->streak[k] + 1u : 0u;
    if (d->streak[k] < d->least && !high) {
        return false;
    }
    d->state[k] = KHEPERA_BUILT_ALARM;
    d->since[k] = 0u;
    d->peak[k] = REAL(0.0);
    remember_peak(d, limit, k, out, bound);
    return true;
}

/* Which classes of faults the residuals leave, and the one if it is one. */
static void judge(khepera_built_diagnosis *d)
{
    int likely = 0;
    int alarms = 0;
    int c;
    int k;

    for (k = 0; k < KHEPERA_BUILT_RESIDUALS; ++k) {
        alarms += d->state[k] == KHEPERA_BUILT_ALARM ? 1 : 0;
    }
    d->fault_class = KHEPERA_BUILT_UNKNOWN;
    for (c = 0; c < KHEPERA_BUILT_CLASSES; ++c) {
        const khepera_built_candidate left = left_of(d, c, alarms);

        d->candidate[c] = (uint8_t)left;
        if (left == KHEPERA_BUILT_LIKELY) {
            d->fault_class = (int16_t)c;
            ++likely;
        }
    }
    if (likely != 1 || d->settled < 2u * d->row) {
        d->fault_class = KHEPERA_BUILT_UNKNOWN;
    }
}

khepera_built_limit khepera_built_limit_of(khepera_built_real level)
{
    khepera_built_limit limit;

    limit.mean = REAL(0.0);
    limit.level = level;
    limit.unit = REAL(0.0);
    limit.loud = REAL(0.0);
    limit.drift = REAL(0.5);
    limit.height = NEVER;
    limit.bound = REAL(0.0);
    return limit;
}

void khepera_built_clear(khepera_built_diagnosis *diagnosis)
{
    int k;

    for (k = 0; k < KHEPERA_BUILT_RESIDUALS; ++k) {
        if (diagnosis->state[k] == KHEPERA_BUILT_ALARM) {
            diagnosis->state[k] = KHEPERA_BUILT_HEALTHY;
        }
        diagnosis->since[k] = 0u;
        diagnosis->peak[k] = REAL(0.0);
        forget_sums(diagnosis, k);
    }
    for (k = 0; k < KHEPERA_BUILT_CLASSES; ++k) {
        diagnosis->candidate[k] = KHEPERA_BUILT_RULED_OUT;
    }
    diagnosis->fault_class = KHEPERA_BUILT_UNKNOWN;
    diagnosis->quiet = 0u;
    diagnosis->settled = 0u;
    diagnosis->calm = false;
}

void khepera_built_diagnosis_reset(khepera_built_diagnosis *diagnosis)
{
    int k;

    diagnosis->row = KHEPERA_BUILT_ROW;
    diagnosis->least = 15u;
    diagnosis->hold = 10u * KHEPERA_BUILT_ROW;
    diagnosis->window = 300u;
    diagnosis->latch = false;
    diagnosis->tick = 0u;
    for (k = 0; k < KHEPERA_BUILT_RESIDUALS; ++k) {
        diagnosis->state[k] = KHEPERA_BUILT_BLIND;
    }
    khepera_built_clear(diagnosis);
}

/* Whether each residual has a value within its level: nearly all samples are so. */
static bool all_within(
    const khepera_built_limit *limits, const real *bounds, const khepera_built_residuals *residuals)
{
    const real *value = residuals->value;
    int k;

    if (bounds != NULL) {
        for (k = 0; k < KHEPERA_BUILT_RESIDUALS; ++k) {
            if (!residuals->valid[k] || !is_within(&limits[k], value[k], bounds[k])) {
                return false;
            }
        }
    } else {
        for (k = 0; k < KHEPERA_BUILT_RESIDUALS; ++k) {
            if (!residuals->valid[k] || !is_within(&limits[k], value[k], limits[k].bound)) {
                return false;
            }
        }
    }
    return true;
}

/* Residual k without a value. */
static void blind(khepera_built_diagnosis *d, int k)
{
    forget_sums(d, k);
    if (d->state[k] == KHEPERA_BUILT_ALARM) {
        d->quiet = 0u; /* nobody knows that it is over */
    } else {
        d->state[k] = KHEPERA_BUILT_BLIND;
    }
}

bool khepera_built_diagnose(
    khepera_built_diagnosis *diagnosis,
    const khepera_built_limit *limits,
    const khepera_built_real *bounds,
    const khepera_built_residuals *residuals)
{
    khepera_built_diagnosis *d = diagnosis;
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
    for (k = 0; k < KHEPERA_BUILT_RESIDUALS; ++k) {
        if (residuals->valid[k]) {
            const real bound = bounds ? bounds[k] : limits[k].bound;

            fresh = watch(d, &limits[k], k, residuals->value[k], bound, row) || fresh;
        } else {
            blind(d, k);
        }
        d->calm = d->calm && d->state[k] == KHEPERA_BUILT_HEALTHY && d->streak[k] == 0u;
        alarm = alarm || d->state[k] == KHEPERA_BUILT_ALARM;
    }
    if (fresh) {
        d->quiet = 0u;
        d->settled = 0u;
    }
    if (alarm && !d->latch && d->quiet >= d->hold) {
        khepera_built_clear(d);
        return false;
    }
    if (fresh || (alarm && row)) {
        judge(d);
    }
    return alarm;
}
