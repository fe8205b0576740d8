/* drive_bench_threshold.c: the thresholds of DriveBench_threshold; generated, see the header. */
#include "drive_bench_threshold.h"

#include <math.h>

#if defined __FINITE_MATH_ONLY__ && __FINITE_MATH_ONLY__
#error "this code tells numbers from NaN: compile it without -ffinite-math-only (-ffast-math)"
#endif

typedef drive_bench_threshold_real real;

#define REAL(x) DRIVE_BENCH_THRESHOLD_CONSTANT(x)
#if defined DRIVE_BENCH_THRESHOLD_FLOAT && !defined DRIVE_BENCH_THRESHOLD_REAL
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

uint32_t drive_bench_threshold_abi(void)
{
    return DRIVE_BENCH_THRESHOLD_ABI;
}

const char *drive_bench_threshold_digest(void)
{
    return DRIVE_BENCH_THRESHOLD_DIGEST;
}

void drive_bench_threshold_nominal(drive_bench_threshold_parameters *parameters)
{
    parameters->m__el__L = REAL(0.0003);     /* H */
    parameters->m__el__Re = REAL(17.6);      /* Ohm */
    parameters->m__el__k = REAL(0.00351);    /* N.m/A */
    parameters->m__me__Je = REAL(1.4e-08);   /* kg.m^2 */
    parameters->m__me__fe = REAL(1.19e-05);  /* N.m.s/rad */
    parameters->m__ge__N = REAL(25.0);       /* 1 */
    parameters->m__wh__Js = REAL(0.1);       /* kg.m^2 */
    parameters->m__wh__fs = REAL(0.0003);    /* N.m.s/rad */
    parameters->m__wh__R = REAL(0.005);      /* m */
}

/* The coefficients of exact and of the filter, from the parameters. */
static void compute_coefficients(drive_bench_threshold_monitor *monitor,
        const drive_bench_threshold_parameters *p, real sample_time, real bandwidth)
{
    drive_bench_threshold_coefficients *c = &monitor->c;

    /* bandwidth*sample_time */
    const real x_ = bandwidth * sample_time;

    /* of a stage: what is left of its memory */
    const real pole = greatest(REAL(2.0) - x_, REAL(0.0)) / (x_ + REAL(2.0));

    /* w*sample_time, x or 2 */
    const real turn = REAL(2.0) * (REAL(1.0) - pole) / (pole + REAL(1.0));

    /* w of the filter 1/(1 + D/w) */
    const real w = turn / sample_time;

    /* khepera.bg:17: m.el.Re*m.me.fe/m.el.k */
    const real t = p->m__el__Re * p->m__me__fe / p->m__el__k;

    /* khepera.bg:17: m.el.Re*m.wh.fs/(m.ge.N*m.el.k) */
    const real t_2 = p->m__el__Re * p->m__wh__fs / p->m__ge__N / p->m__el__k;

    /* khepera.bg:17: m.el.Re*m.wh.R/(m.ge.N*m.el.k) */
    const real t_3 = p->m__el__Re * p->m__wh__R / p->m__ge__N / p->m__el__k;

    /* 1 - pole */
    const real t_4 = REAL(1.0) - pole;

    /* turn^2 */
    const real t_5 = turn * turn;

    /* khepera.bg:17: m.el.L*m.me.Je*w^2/m.el.k */
    const real t_6 = p->m__el__L * p->m__me__Je * w * w / p->m__el__k;

    /* khepera.bg:17: m.el.L*m.wh.Js*w^2/(m.ge.N*m.el.k) */
    const real t_7 = p->m__el__L * p->m__wh__Js * w * w / p->m__ge__N / p->m__el__k;

    /* khepera.bg:17: m.el.L*m.wh.R*w/(m.ge.N*m.el.k) */
    const real t_8 = p->m__el__L * p->m__wh__R * w / p->m__ge__N / p->m__el__k;

    /* khepera.bg:17: m.el.Re*m.wh.Js*w/(m.ge.N*m.el.k) */
    const real t_9 = p->m__el__Re * p->m__wh__Js * w / p->m__ge__N / p->m__el__k;

    /* khepera.bg:17: m.el.Re*m.me.Je*w/m.el.k */
    const real t_10 = p->m__el__Re * p->m__me__Je * w / p->m__el__k;

    /* khepera.bg:17: m.el.L*m.me.fe*w/m.el.k */
    const real t_11 = p->m__el__L * p->m__me__fe * w / p->m__el__k;

    /* khepera.bg:17: m.el.L*m.wh.fs*w/(m.ge.N*m.el.k) */
    const real t_12 = p->m__el__L * p->m__wh__fs * w / p->m__ge__N / p->m__el__k;

    /* khepera.bg:17: r1_w1: factor of Fx */
    c->r1_w1_Fx = t_3 / REAL(20.0);

    /* khepera.bg:17: r1_w1: factor of m.wh.ws */
    c->r1_w1_m__wh__ws = t_2 / REAL(20.0);

    /* khepera.bg:17: r1_w1: factor of m.wh.ws' */
    c->r1_w1_w1_m__wh__ws = t_9 / REAL(20.0);

    /* khepera.bg:17: r1_w1: factor of m.me.we */
    c->r1_w1_m__me__we = t / REAL(20.0);

    /* khepera.bg:17: r1_w1: factor of m.me.we' */
    c->r1_w1_w1_m__me__we = t_10 / REAL(20.0);

    /* filter: 1 * (w*sample_time)^2/12 */
    c->bend1 = t_5 / REAL(12.0);

    /* filter: what is left of a memory a sample later */
    c->a = pole;

    /* filter: weight of a sample, new and a sample later */
    c->b = REAL(0.5) * t_4;

    /* filter: 1 - b, the memory of a constant 1 */
    c->rest = REAL(1.0) - REAL(0.5) * t_4;

    /* khepera.bg:17: r1_w2: factor of m.me.we */
    c->r1_w2_m__me__we = p->m__el__k * (p->m__el__Re * p->m__me__fe / p->m__el__k / p->m__el__k
            - REAL(1.0)) / REAL(50.0);

    /* khepera.bg:17: r1_w2: factor of m.me.we' */
    c->r1_w2_w1_m__me__we = p->m__el__k * w
            * (p->m__el__Re * p->m__me__Je / p->m__el__k / p->m__el__k
            + p->m__el__L * p->m__me__fe / p->m__el__k / p->m__el__k) / REAL(50.0);

    /* khepera.bg:17: r1_w2: factor of m.me.we'' */
    c->r1_w2_w2_m__me__we = t_6 / REAL(50.0);

    /* khepera.bg:17: r1_w2: factor of Fx */
    c->r1_w2_Fx = t_3 / REAL(50.0);

    /* khepera.bg:17: r1_w2: factor of Fx' */
    c->r1_w2_w1_Fx = t_8 / REAL(50.0);

    /* khepera.bg:17: r1_w2: factor of m.wh.ws */
    c->r1_w2_m__wh__ws = t_2 / REAL(50.0);

    /* khepera.bg:17: r1_w2: factor of m.wh.ws' */
    c->r1_w2_w1_m__wh__ws = p->m__el__k * w
            * (p->m__el__Re * p->m__wh__Js / p->m__ge__N / p->m__el__k / p->m__el__k
            + p->m__el__L * p->m__wh__fs / p->m__ge__N / p->m__el__k / p->m__el__k) / REAL(50.0);

    /* khepera.bg:17: r1_w2: factor of m.wh.ws'' */
    c->r1_w2_w2_m__wh__ws = t_7 / REAL(50.0);

    /* filter: 2 * (w*sample_time)^2/12 */
    c->bend2 = t_5 / REAL(6.0);

    /* khepera.bg:17: r1_w3: factor of m.me.we */
    c->r1_w3_m__me__we = t / REAL(10.0);

    /* khepera.bg:17: r1_w3: factor of m.me.we' */
    c->r1_w3_w1_m__me__we = t_11 / REAL(10.0);

    /* khepera.bg:17: r1_w4: factor of m.wh.ws */
    c->r1_w4_m__wh__ws = t_2 / REAL(10.0);

    /* khepera.bg:17: r1_w4: factor of m.wh.ws' */
    c->r1_w4_w1_m__wh__ws = t_12 / REAL(10.0);

    /* khepera.bg:17: r1_w5: factor of m.me.we */
    c->r1_w5_m__me__we = t / REAL(730.0);

    /* khepera.bg:17: r1_w5: factor of m.me.we' */
    c->r1_w5_w1_m__me__we = t_10 / REAL(730.0);

    /* khepera.bg:17: r1_w5: factor of m.wh.ws */
    c->r1_w5_m__wh__ws = t_2 / REAL(730.0);

    /* khepera.bg:17: r1_w5: factor of m.wh.ws' */
    c->r1_w5_w1_m__wh__ws = t_9 / REAL(730.0);

    /* khepera.bg:17: r1_w5: factor of Fx */
    c->r1_w5_Fx = t_3 / REAL(730.0);

    /* khepera.bg:17: r1_w6: factor of m.me.we */
    c->r1_w6_m__me__we = t / REAL(146.0);

    /* khepera.bg:17: r1_w7: factor of m.wh.ws */
    c->r1_w7_m__wh__ws = t_2 / REAL(146.0);

    /* khepera.bg:17: r1_w8: factor of m.me.we */
    c->r1_w8_m__me__we = t / REAL(1825.0);

    /* khepera.bg:17: r1_w8: factor of m.me.we' */
    c->r1_w8_w1_m__me__we = p->m__el__k * p->m__el__k * w
            * (-REAL(2.0) * p->m__el__L * p->m__me__fe / p->m__el__k / p->m__el__k / p->m__el__k
            - REAL(2.0) * p->m__el__Re * p->m__me__Je / p->m__el__k / p->m__el__k / p->m__el__k)
            / REAL(3650.0);

    /* khepera.bg:17: r1_w8: factor of m.me.we'' */
    c->r1_w8_w2_m__me__we = t_6 / REAL(1825.0);

    /* khepera.bg:17: r1_w8: factor of m.wh.ws */
    c->r1_w8_m__wh__ws = t_2 / REAL(1825.0);

    /* khepera.bg:17: r1_w8: factor of m.wh.ws' */
    c->r1_w8_w1_m__wh__ws = p->m__el__k * p->m__el__k * w
            * (-REAL(2.0) * p->m__el__L * p->m__wh__fs / p->m__ge__N / p->m__el__k / p->m__el__k
                / p->m__el__k
            - REAL(2.0) * p->m__el__Re * p->m__wh__Js / p->m__ge__N / p->m__el__k / p->m__el__k
                / p->m__el__k)
            / REAL(3650.0);

    /* khepera.bg:17: r1_w8: factor of m.wh.ws'' */
    c->r1_w8_w2_m__wh__ws = t_7 / REAL(1825.0);

    /* khepera.bg:17: r1_w8: factor of Fx */
    c->r1_w8_Fx = t_3 / REAL(1825.0);

    /* khepera.bg:17: r1_w8: factor of Fx' */
    c->r1_w8_w1_Fx = t_8 / REAL(1825.0);

    /* khepera.bg:17: r1_w9: factor of m.me.we */
    c->r1_w9_m__me__we = t / REAL(365.0);

    /* khepera.bg:17: r1_w9: factor of m.me.we' */
    c->r1_w9_w1_m__me__we = t_11 / REAL(365.0);

    /* khepera.bg:17: r1_w10: factor of m.wh.ws */
    c->r1_w10_m__wh__ws = t_2 / REAL(365.0);

    /* khepera.bg:17: r1_w10: factor of m.wh.ws' */
    c->r1_w10_w1_m__wh__ws = t_12 / REAL(365.0);
}

static bool parameters_are_finite(const drive_bench_threshold_parameters *p)
{
    return finite_number(p->m__el__L + p->m__el__Re + p->m__el__k + p->m__me__Je + p->m__me__fe
            + p->m__ge__N + p->m__wh__Js + p->m__wh__fs + p->m__wh__R);
}

static bool coefficients_are_finite(const drive_bench_threshold_monitor *monitor)
{
    return finite_number(monitor->c.r1_w1_Fx + monitor->c.r1_w1_m__wh__ws
            + monitor->c.r1_w1_w1_m__wh__ws + monitor->c.r1_w1_m__me__we
            + monitor->c.r1_w1_w1_m__me__we + monitor->c.bend1 + monitor->c.a + monitor->c.b
            + monitor->c.rest + monitor->c.r1_w2_m__me__we + monitor->c.r1_w2_w1_m__me__we
            + monitor->c.r1_w2_w2_m__me__we + monitor->c.r1_w2_Fx + monitor->c.r1_w2_w1_Fx
            + monitor->c.r1_w2_m__wh__ws + monitor->c.r1_w2_w1_m__wh__ws
            + monitor->c.r1_w2_w2_m__wh__ws + monitor->c.bend2 + monitor->c.r1_w3_m__me__we
            + monitor->c.r1_w3_w1_m__me__we + monitor->c.r1_w4_m__wh__ws
            + monitor->c.r1_w4_w1_m__wh__ws + monitor->c.r1_w5_m__me__we
            + monitor->c.r1_w5_w1_m__me__we + monitor->c.r1_w5_m__wh__ws
            + monitor->c.r1_w5_w1_m__wh__ws + monitor->c.r1_w5_Fx + monitor->c.r1_w6_m__me__we
            + monitor->c.r1_w7_m__wh__ws + monitor->c.r1_w8_m__me__we
            + monitor->c.r1_w8_w1_m__me__we + monitor->c.r1_w8_w2_m__me__we
            + monitor->c.r1_w8_m__wh__ws + monitor->c.r1_w8_w1_m__wh__ws
            + monitor->c.r1_w8_w2_m__wh__ws + monitor->c.r1_w8_Fx + monitor->c.r1_w8_w1_Fx
            + monitor->c.r1_w9_m__me__we + monitor->c.r1_w9_w1_m__me__we
            + monitor->c.r1_w10_m__wh__ws + monitor->c.r1_w10_w1_m__wh__ws);
}

/* Samples until `constants` time constants of the filter are over. */
static uint32_t samples(real constants, real sample_time, real bandwidth)
{
    const real wait = constants / (bandwidth * sample_time);
    const uint32_t whole = wait < REAL(4.0e9) ? (uint32_t)wait : UINT32_MAX - 1u;

    return (real)whole < wait ? whole + 1u : whole;
}

drive_bench_threshold_status drive_bench_threshold_configure(
    drive_bench_threshold_monitor *monitor,
    const drive_bench_threshold_parameters *parameters,
    drive_bench_threshold_real sample_time,
    drive_bench_threshold_real bandwidth,
    drive_bench_threshold_real time_unit)
{
    int k;

    for (k = 0; k < DRIVE_BENCH_THRESHOLD_RESIDUALS; ++k) {
        monitor->settle[k] = UINT32_MAX;
    }
    drive_bench_threshold_reset(monitor);
    if (!parameters_are_finite(parameters)) {
        return DRIVE_BENCH_THRESHOLD_BAD_PARAMETER;
    }
    if (!(sample_time >= REAL(0.000999999)) || !finite_number(sample_time)) {
        return DRIVE_BENCH_THRESHOLD_BAD_SAMPLE_TIME;
    }
    if (!(bandwidth * sample_time >= SLOWEST && bandwidth * sample_time <= REAL(3.0))) {
        return DRIVE_BENCH_THRESHOLD_BAD_BANDWIDTH;
    }
    if (!(time_unit > REAL(0.0)) || !finite_number(time_unit)) {
        return DRIVE_BENCH_THRESHOLD_BAD_TIME_UNIT;
    }
    compute_coefficients(monitor, parameters, sample_time, bandwidth);
    if (!coefficients_are_finite(monitor)) {
        return DRIVE_BENCH_THRESHOLD_BAD_COEFFICIENT;
    }
    monitor->settle[DRIVE_BENCH_THRESHOLD_R1] =
        samples(REAL(11.228872242412663), sample_time, bandwidth);
    monitor->settle[DRIVE_BENCH_THRESHOLD_R2] =
        samples(REAL(11.228872242412663), sample_time, bandwidth);
    return DRIVE_BENCH_THRESHOLD_OK;
}

void drive_bench_threshold_exact(
    const drive_bench_threshold_monitor *monitor,
    const drive_bench_threshold_derivatives *derivatives,
    drive_bench_threshold_real residuals[DRIVE_BENCH_THRESHOLD_RESIDUALS])
{
    real *r = residuals;

    (void)monitor;
    (void)derivatives;

    /* khepera.bg:17: r1: a threshold is made of filtered signals, only step has it */
    r[DRIVE_BENCH_THRESHOLD_R1] = (real)NAN;

    /* khepera.bg:41: r2: a threshold is made of filtered signals, only step has it */
    r[DRIVE_BENCH_THRESHOLD_R2] = (real)NAN;
}

/* r1 on its first sample: the filter as if it had always been so. */
static void start_r1(
    drive_bench_threshold_monitor *monitor, const drive_bench_threshold_samples *s, real *r)
{
    const drive_bench_threshold_coefficients *c = &monitor->c;
    drive_bench_threshold_memory *x = &monitor->x;

    /* khepera.bg:17: r1_w1: terms of order 0 */
    const real r1_w1_g0 = -c->r1_w1_Fx * s->Fx - c->r1_w1_m__wh__ws * s->m__wh__ws
        - c->r1_w1_m__me__we * s->m__me__we;

    /* khepera.bg:17: r1_w1: degree 1 */
    const real r1_w1_d1 = -c->r1_w1_w1_m__wh__ws * s->m__wh__ws
        - c->r1_w1_w1_m__me__we * s->m__me__we;

    /* khepera.bg:17: r1_w1: error of order 0 */
    const real r1_w1_e0 = c->bend1 * r1_w1_g0;

    /* khepera.bg:17: r1_w1: input of stage 3 */
    const real r1_w1_u3 = r1_w1_g0 - r1_w1_d1 - r1_w1_e0;

    /* khepera.bg:17: r1_w1: stage 3, at rest */
    const real r1_w1_y3 = r1_w1_u3;

    /* khepera.bg:17: r1_w1: stage 3: memory */
    x->r1_w1_s3 = c->rest * r1_w1_u3;

    /* khepera.bg:17: r1_w1: input of stage 2 */
    const real r1_w1_u2 = r1_w1_y3 + r1_w1_d1 + REAL(2.0) * r1_w1_e0;

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

    /* khepera.bg:17: r1: what the tolerance of m.el.Re can do */
    const real r1_w1 = r1_w1_y1;

    /* khepera.bg:17: r1_w2: terms of order 0 */
    const real r1_w2_g0 = c->r1_w2_m__me__we * s->m__me__we + c->r1_w2_Fx * s->Fx
        + c->r1_w2_m__wh__ws * s->m__wh__ws;

    /* khepera.bg:17: r1_w2: terms of order 1 */
    const real r1_w2_g1 = c->r1_w2_w1_m__me__we * s->m__me__we + c->r1_w2_w1_Fx * s->Fx
        + c->r1_w2_w1_m__wh__ws * s->m__wh__ws;

    /* khepera.bg:17: r1_w2: error of order 0 */
    const real r1_w2_e0 = c->bend2 * r1_w2_g0;

    /* khepera.bg:17: r1_w2: degree 2 */
    const real r1_w2_d2 = c->r1_w2_w2_m__me__we * s->m__me__we
        + c->r1_w2_w2_m__wh__ws * s->m__wh__ws - r1_w2_e0;

    /* khepera.bg:17: r1_w2: error of order 1 */
    const real r1_w2_e1 = c->bend1 * r1_w2_g1;

    /* khepera.bg:17: r1_w2: input of stage 3 */
    const real r1_w2_u3 = r1_w2_g0 + r1_w2_d2 + r1_w2_e1 - r1_w2_g1;

    /* khepera.bg:17: r1_w2: stage 3, at rest */
    const real r1_w2_y3 = r1_w2_u3;

    /* khepera.bg:17: r1_w2: stage 3: memory */
    x->r1_w2_s3 = c->rest * r1_w2_u3;

    /* khepera.bg:17: r1_w2: input of stage 2 */
    const real r1_w2_u2 = r1_w2_y3 + r1_w2_g1 - REAL(2.0) * r1_w2_d2 - REAL(3.0) * r1_w2_e1;

    /* khepera.bg:17: r1_w2: stage 2, at rest */
    const real r1_w2_y2 = r1_w2_u2;

    /* khepera.bg:17: r1_w2: stage 2: memory */
    x->r1_w2_s2 = c->rest * r1_w2_u2;

    /* khepera.bg:17: r1_w2: input of stage 1 */
    const real r1_w2_u1 = r1_w2_y2 + r1_w2_d2 + REAL(3.0) * r1_w2_e1;

    /* khepera.bg:17: r1_w2: stage 1, at rest */
    const real r1_w2_y1 = r1_w2_u1;

    /* khepera.bg:17: r1_w2: stage 1: memory */
    x->r1_w2_s1 = c->rest * r1_w2_u1;

    /* khepera.bg:17: r1: what the tolerance of m.el.k can do */
    const real r1_w2 = r1_w2_y1 - r1_w2_e1;

    /* khepera.bg:17: r1_w3: terms of order 0 */
    const real r1_w3_g0 = -c->r1_w3_m__me__we * s->m__me__we;

    /* khepera.bg:17: r1_w3: degree 1 */
    const real r1_w3_d1 = c->r1_w3_w1_m__me__we * s->m__me__we;

    /* khepera.bg:17: r1_w3: error of order 0 */
    const real r1_w3_e0 = c->bend1 * r1_w3_g0;

    /* khepera.bg:17: r1_w3: input of stage 3 */
    const real r1_w3_u3 = r1_w3_g0 + r1_w3_d1 - r1_w3_e0;

    /* khepera.bg:17: r1_w3: stage 3, at rest */
    const real r1_w3_y3 = r1_w3_u3;

    /* khepera.bg:17: r1_w3: stage 3: memory */
    x->r1_w3_s3 = c->rest * r1_w3_u3;

    /* khepera.bg:17: r1_w3: input of stage 2 */
    const real r1_w3_u2 = r1_w3_y3 + REAL(2.0) * r1_w3_e0 - r1_w3_d1;

    /* khepera.bg:17: r1_w3: stage 2, at rest */
    const real r1_w3_y2 = r1_w3_u2;

    /* khepera.bg:17: r1_w3: stage 2: memory */
    x->r1_w3_s2 = c->rest * r1_w3_u2;

    /* khepera.bg:17: r1_w3: input of stage 1 */
    const real r1_w3_u1 = r1_w3_y2 - r1_w3_e0;

    /* khepera.bg:17: r1_w3: stage 1, at rest */
    const real r1_w3_y1 = r1_w3_u1;

    /* khepera.bg:17: r1_w3: stage 1: memory */
    x->r1_w3_s1 = c->rest * r1_w3_u1;

    /* khepera.bg:17: r1: what the tolerance of m.me.fe can do */
    const real r1_w3 = r1_w3_y1;

    /* khepera.bg:17: r1_w4: terms of order 0 */
    const real r1_w4_g0 = -c->r1_w4_m__wh__ws * s->m__wh__ws;

    /* khepera.bg:17: r1_w4: degree 1 */
    const real r1_w4_d1 = c->r1_w4_w1_m__wh__ws * s->m__wh__ws;

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

    /* khepera.bg:17: r1: what the tolerance of m.wh.fs can do */
    const real r1_w4 = r1_w4_y1;

    /* khepera.bg:17: r1_w5: terms of order 0 */
    const real r1_w5_g0 = c->r1_w5_m__me__we * s->m__me__we + c->r1_w5_m__wh__ws * s->m__wh__ws
        + c->r1_w5_Fx * s->Fx;

    /* khepera.bg:17: r1_w5: degree 1 */
    const real r1_w5_d1 = c->r1_w5_w1_m__me__we * s->m__me__we
        + c->r1_w5_w1_m__wh__ws * s->m__wh__ws;

    /* khepera.bg:17: r1_w5: error of order 0 */
    const real r1_w5_e0 = c->bend1 * r1_w5_g0;

    /* khepera.bg:17: r1_w5: input of stage 3 */
    const real r1_w5_u3 = r1_w5_g0 - r1_w5_d1 - r1_w5_e0;

    /* khepera.bg:17: r1_w5: stage 3, at rest */
    const real r1_w5_y3 = r1_w5_u3;

    /* khepera.bg:17: r1_w5: stage 3: memory */
    x->r1_w5_s3 = c->rest * r1_w5_u3;

    /* khepera.bg:17: r1_w5: input of stage 2 */
    const real r1_w5_u2 = r1_w5_y3 + r1_w5_d1 + REAL(2.0) * r1_w5_e0;

    /* khepera.bg:17: r1_w5: stage 2, at rest */
    const real r1_w5_y2 = r1_w5_u2;

    /* khepera.bg:17: r1_w5: stage 2: memory */
    x->r1_w5_s2 = c->rest * r1_w5_u2;

    /* khepera.bg:17: r1_w5: input of stage 1 */
    const real r1_w5_u1 = r1_w5_y2 - r1_w5_e0;

    /* khepera.bg:17: r1_w5: stage 1, at rest */
    const real r1_w5_y1 = r1_w5_u1;

    /* khepera.bg:17: r1_w5: stage 1: memory */
    x->r1_w5_s1 = c->rest * r1_w5_u1;

    /* khepera.bg:17: r1: what the tolerances of m.el.Re and m.el.k can do together */
    const real r1_w5 = r1_w5_y1;

    /* khepera.bg:17: r1_w6: input of stage 3 */
    const real r1_w6_u3 = -c->r1_w6_m__me__we * s->m__me__we;

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

    /* khepera.bg:17: r1: what the tolerances of m.el.Re and m.me.fe can do together */
    const real r1_w6 = r1_w6_y1;

    /* khepera.bg:17: r1_w7: input of stage 3 */
    const real r1_w7_u3 = -c->r1_w7_m__wh__ws * s->m__wh__ws;

    /* khepera.bg:17: r1_w7: stage 3, at rest */
    const real r1_w7_y3 = r1_w7_u3;

    /* khepera.bg:17: r1_w7: stage 3: memory */
    x->r1_w7_s3 = c->rest * r1_w7_u3;

    /* khepera.bg:17: r1_w7: input of stage 2 */
    const real r1_w7_u2 = r1_w7_y3;

    /* khepera.bg:17: r1_w7: stage 2, at rest */
    const real r1_w7_y2 = r1_w7_u2;

    /* khepera.bg:17: r1_w7: stage 2: memory */
    x->r1_w7_s2 = c->rest * r1_w7_u2;

    /* khepera.bg:17: r1_w7: input of stage 1 */
    const real r1_w7_u1 = r1_w7_y2;

    /* khepera.bg:17: r1_w7: stage 1, at rest */
    const real r1_w7_y1 = r1_w7_u1;

    /* khepera.bg:17: r1_w7: stage 1: memory */
    x->r1_w7_s1 = c->rest * r1_w7_u1;

    /* khepera.bg:17: r1: what the tolerances of m.el.Re and m.wh.fs can do together */
    const real r1_w7 = r1_w7_y1;

    /* khepera.bg:17: r1_w8: terms of order 0 */
    const real r1_w8_g0 = -c->r1_w8_m__me__we * s->m__me__we - c->r1_w8_m__wh__ws * s->m__wh__ws
        - c->r1_w8_Fx * s->Fx;

    /* khepera.bg:17: r1_w8: terms of order 1 */
    const real r1_w8_g1 = c->r1_w8_w1_m__me__we * s->m__me__we
        + c->r1_w8_w1_m__wh__ws * s->m__wh__ws - c->r1_w8_w1_Fx * s->Fx;

    /* khepera.bg:17: r1_w8: error of order 0 */
    const real r1_w8_e0 = c->bend2 * r1_w8_g0;

    /* khepera.bg:17: r1_w8: degree 2 */
    const real r1_w8_d2 = -c->r1_w8_w2_m__me__we * s->m__me__we
        - c->r1_w8_w2_m__wh__ws * s->m__wh__ws - r1_w8_e0;

    /* khepera.bg:17: r1_w8: error of order 1 */
    const real r1_w8_e1 = c->bend1 * r1_w8_g1;

    /* khepera.bg:17: r1_w8: input of stage 3 */
    const real r1_w8_u3 = r1_w8_g0 + r1_w8_d2 + r1_w8_e1 - r1_w8_g1;

    /* khepera.bg:17: r1_w8: stage 3, at rest */
    const real r1_w8_y3 = r1_w8_u3;

    /* khepera.bg:17: r1_w8: stage 3: memory */
    x->r1_w8_s3 = c->rest * r1_w8_u3;

    /* khepera.bg:17: r1_w8: input of stage 2 */
    const real r1_w8_u2 = r1_w8_y3 + r1_w8_g1 - REAL(2.0) * r1_w8_d2 - REAL(3.0) * r1_w8_e1;

    /* khepera.bg:17: r1_w8: stage 2, at rest */
    const real r1_w8_y2 = r1_w8_u2;

    /* khepera.bg:17: r1_w8: stage 2: memory */
    x->r1_w8_s2 = c->rest * r1_w8_u2;

    /* khepera.bg:17: r1_w8: input of stage 1 */
    const real r1_w8_u1 = r1_w8_y2 + r1_w8_d2 + REAL(3.0) * r1_w8_e1;

    /* khepera.bg:17: r1_w8: stage 1, at rest */
    const real r1_w8_y1 = r1_w8_u1;

    /* khepera.bg:17: r1_w8: stage 1: memory */
    x->r1_w8_s1 = c->rest * r1_w8_u1;

    /* khepera.bg:17: r1: second order of what the tolerance of m.el.k can do */
    const real r1_w8 = r1_w8_y1 - r1_w8_e1;

    /* khepera.bg:17: r1_w9: terms of order 0 */
    const real r1_w9_g0 = c->r1_w9_m__me__we * s->m__me__we;

    /* khepera.bg:17: r1_w9: degree 1 */
    const real r1_w9_d1 = c->r1_w9_w1_m__me__we * s->m__me__we;

    /* khepera.bg:17: r1_w9: error of order 0 */
    const real r1_w9_e0 = c->bend1 * r1_w9_g0;

    /* khepera.bg:17: r1_w9: input of stage 3 */
    const real r1_w9_u3 = r1_w9_g0 - r1_w9_d1 - r1_w9_e0;

    /* khepera.bg:17: r1_w9: stage 3, at rest */
    const real r1_w9_y3 = r1_w9_u3;

    /* khepera.bg:17: r1_w9: stage 3: memory */
    x->r1_w9_s3 = c->rest * r1_w9_u3;

    /* khepera.bg:17: r1_w9: input of stage 2 */
    const real r1_w9_u2 = r1_w9_y3 + r1_w9_d1 + REAL(2.0) * r1_w9_e0;

    /* khepera.bg:17: r1_w9: stage 2, at rest */
    const real r1_w9_y2 = r1_w9_u2;

    /* khepera.bg:17: r1_w9: stage 2: memory */
    x->r1_w9_s2 = c->rest * r1_w9_u2;

    /* khepera.bg:17: r1_w9: input of stage 1 */
    const real r1_w9_u1 = r1_w9_y2 - r1_w9_e0;

    /* khepera.bg:17: r1_w9: stage 1, at rest */
    const real r1_w9_y1 = r1_w9_u1;

    /* khepera.bg:17: r1_w9: stage 1: memory */
    x->r1_w9_s1 = c->rest * r1_w9_u1;

    /* khepera.bg:17: r1: what the tolerances of m.el.k and m.me.fe can do together */
    const real r1_w9 = r1_w9_y1;

    /* khepera.bg:17: r1_w10: terms of order 0 */
    const real r1_w10_g0 = c->r1_w10_m__wh__ws * s->m__wh__ws;

    /* khepera.bg:17: r1_w10: degree 1 */
    const real r1_w10_d1 = c->r1_w10_w1_m__wh__ws * s->m__wh__ws;

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

    /* khepera.bg:17: r1: what the tolerances of m.el.k and m.wh.fs can do together */
    const real r1_w10 = r1_w10_y1;

    /* khepera.bg:17: r1: how far r1 can be from zero if no parameter is out of tolerance */
    r[DRIVE_BENCH_THRESHOLD_R1] = MATH(fabs)(r1_w1) + MATH(fabs)(r1_w2) + MATH(fabs)(r1_w3)
        + MATH(fabs)(r1_w4) + MATH(fabs)(r1_w5) + MATH(fabs)(r1_w6) + MATH(fabs)(r1_w7)
        + MATH(fabs)(r1_w8) + MATH(fabs)(r1_w9) + MATH(fabs)(r1_w10);
}

/* r1 on every further sample. */
static void next_r1(
    drive_bench_threshold_monitor *monitor, const drive_bench_threshold_samples *s, real *r)
{
    const drive_bench_threshold_coefficients *c = &monitor->c;
    drive_bench_threshold_memory *x = &monitor->x;

    /* khepera.bg:17: r1_w1: terms of order 0 */
    const real r1_w1_g0 = -c->r1_w1_Fx * s->Fx - c->r1_w1_m__wh__ws * s->m__wh__ws
        - c->r1_w1_m__me__we * s->m__me__we;

    /* khepera.bg:17: r1_w1: degree 1 */
    const real r1_w1_d1 = -c->r1_w1_w1_m__wh__ws * s->m__wh__ws
        - c->r1_w1_w1_m__me__we * s->m__me__we;

    /* khepera.bg:17: r1_w1: error of order 0 */
    const real r1_w1_e0 = c->bend1 * r1_w1_g0;

    /* khepera.bg:17: r1_w1: input of stage 3 */
    const real r1_w1_u3 = r1_w1_g0 - r1_w1_d1 - r1_w1_e0;

    /* khepera.bg:17: r1_w1: stage 3 */
    const real r1_w1_y3 = x->r1_w1_s3 + c->b * r1_w1_u3;

    /* khepera.bg:17: r1_w1: stage 3: memory */
    x->r1_w1_s3 = c->a * r1_w1_y3 + c->b * r1_w1_u3;

    /* khepera.bg:17: r1_w1: input of stage 2 */
    const real r1_w1_u2 = r1_w1_y3 + r1_w1_d1 + REAL(2.0) * r1_w1_e0;

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

    /* khepera.bg:17: r1: what the tolerance of m.el.Re can do */
    const real r1_w1 = r1_w1_y1;

    /* khepera.bg:17: r1_w2: terms of order 0 */
    const real r1_w2_g0 = c->r1_w2_m__me__we * s->m__me__we + c->r1_w2_Fx * s->Fx
        + c->r1_w2_m__wh__ws * s->m__wh__ws;

    /* khepera.bg:17: r1_w2: terms of order 1 */
    const real r1_w2_g1 = c->r1_w2_w1_m__me__we * s->m__me__we + c->r1_w2_w1_Fx * s->Fx
        + c->r1_w2_w1_m__wh__ws * s->m__wh__ws;

    /* khepera.bg:17: r1_w2: error of order 0 */
    const real r1_w2_e0 = c->bend2 * r1_w2_g0;

    /* khepera.bg:17: r1_w2: degree 2 */
    const real r1_w2_d2 = c->r1_w2_w2_m__me__we * s->m__me__we
        + c->r1_w2_w2_m__wh__ws * s->m__wh__ws - r1_w2_e0;

    /* khepera.bg:17: r1_w2: error of order 1 */
    const real r1_w2_e1 = c->bend1 * r1_w2_g1;

    /* khepera.bg:17: r1_w2: input of stage 3 */
    const real r1_w2_u3 = r1_w2_g0 + r1_w2_d2 + r1_w2_e1 - r1_w2_g1;

    /* khepera.bg:17: r1_w2: stage 3 */
    const real r1_w2_y3 = x->r1_w2_s3 + c->b * r1_w2_u3;

    /* khepera.bg:17: r1_w2: stage 3: memory */
    x->r1_w2_s3 = c->a * r1_w2_y3 + c->b * r1_w2_u3;

    /* khepera.bg:17: r1_w2: input of stage 2 */
    const real r1_w2_u2 = r1_w2_y3 + r1_w2_g1 - REAL(2.0) * r1_w2_d2 - REAL(3.0) * r1_w2_e1;

    /* khepera.bg:17: r1_w2: stage 2 */
    const real r1_w2_y2 = x->r1_w2_s2 + c->b * r1_w2_u2;

    /* khepera.bg:17: r1_w2: stage 2: memory */
    x->r1_w2_s2 = c->a * r1_w2_y2 + c->b * r1_w2_u2;

    /* khepera.bg:17: r1_w2: input of stage 1 */
    const real r1_w2_u1 = r1_w2_y2 + r1_w2_d2 + REAL(3.0) * r1_w2_e1;

    /* khepera.bg:17: r1_w2: stage 1 */
    const real r1_w2_y1 = x->r1_w2_s1 + c->b * r1_w2_u1;

    /* khepera.bg:17: r1_w2: stage 1: memory */
    x->r1_w2_s1 = c->a * r1_w2_y1 + c->b * r1_w2_u1;

    /* khepera.bg:17: r1: what the tolerance of m.el.k can do */
    const real r1_w2 = r1_w2_y1 - r1_w2_e1;

    /* khepera.bg:17: r1_w3: terms of order 0 */
    const real r1_w3_g0 = -c->r1_w3_m__me__we * s->m__me__we;

    /* khepera.bg:17: r1_w3: degree 1 */
    const real r1_w3_d1 = c->r1_w3_w1_m__me__we * s->m__me__we;

    /* khepera.bg:17: r1_w3: error of order 0 */
    const real r1_w3_e0 = c->bend1 * r1_w3_g0;

    /* khepera.bg:17: r1_w3: input of stage 3 */
    const real r1_w3_u3 = r1_w3_g0 + r1_w3_d1 - r1_w3_e0;

    /* khepera.bg:17: r1_w3: stage 3 */
    const real r1_w3_y3 = x->r1_w3_s3 + c->b * r1_w3_u3;

    /* khepera.bg:17: r1_w3: stage 3: memory */
    x->r1_w3_s3 = c->a * r1_w3_y3 + c->b * r1_w3_u3;

    /* khepera.bg:17: r1_w3: input of stage 2 */
    const real r1_w3_u2 = r1_w3_y3 + REAL(2.0) * r1_w3_e0 - r1_w3_d1;

    /* khepera.bg:17: r1_w3: stage 2 */
    const real r1_w3_y2 = x->r1_w3_s2 + c->b * r1_w3_u2;

    /* khepera.bg:17: r1_w3: stage 2: memory */
    x->r1_w3_s2 = c->a * r1_w3_y2 + c->b * r1_w3_u2;

    /* khepera.bg:17: r1_w3: input of stage 1 */
    const real r1_w3_u1 = r1_w3_y2 - r1_w3_e0;

    /* khepera.bg:17: r1_w3: stage 1 */
    const real r1_w3_y1 = x->r1_w3_s1 + c->b * r1_w3_u1;

    /* khepera.bg:17: r1_w3: stage 1: memory */
    x->r1_w3_s1 = c->a * r1_w3_y1 + c->b * r1_w3_u1;

    /* khepera.bg:17: r1: what the tolerance of m.me.fe can do */
    const real r1_w3 = r1_w3_y1;

    /* khepera.bg:17: r1_w4: terms of order 0 */
    const real r1_w4_g0 = -c->r1_w4_m__wh__ws * s->m__wh__ws;

    /* khepera.bg:17: r1_w4: degree 1 */
    const real r1_w4_d1 = c->r1_w4_w1_m__wh__ws * s->m__wh__ws;

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

    /* khepera.bg:17: r1: what the tolerance of m.wh.fs can do */
    const real r1_w4 = r1_w4_y1;

    /* khepera.bg:17: r1_w5: terms of order 0 */
    const real r1_w5_g0 = c->r1_w5_m__me__we * s->m__me__we + c->r1_w5_m__wh__ws * s->m__wh__ws
        + c->r1_w5_Fx * s->Fx;

    /* khepera.bg:17: r1_w5: degree 1 */
    const real r1_w5_d1 = c->r1_w5_w1_m__me__we * s->m__me__we
        + c->r1_w5_w1_m__wh__ws * s->m__wh__ws;

    /* khepera.bg:17: r1_w5: error of order 0 */
    const real r1_w5_e0 = c->bend1 * r1_w5_g0;

    /* khepera.bg:17: r1_w5: input of stage 3 */
    const real r1_w5_u3 = r1_w5_g0 - r1_w5_d1 - r1_w5_e0;

    /* khepera.bg:17: r1_w5: stage 3 */
    const real r1_w5_y3 = x->r1_w5_s3 + c->b * r1_w5_u3;

    /* khepera.bg:17: r1_w5: stage 3: memory */
    x->r1_w5_s3 = c->a * r1_w5_y3 + c->b * r1_w5_u3;

    /* khepera.bg:17: r1_w5: input of stage 2 */
    const real r1_w5_u2 = r1_w5_y3 + r1_w5_d1 + REAL(2.0) * r1_w5_e0;

    /* khepera.bg:17: r1_w5: stage 2 */
    const real r1_w5_y2 = x->r1_w5_s2 + c->b * r1_w5_u2;

    /* khepera.bg:17: r1_w5: stage 2: memory */
    x->r1_w5_s2 = c->a * r1_w5_y2 + c->b * r1_w5_u2;

    /* khepera.bg:17: r1_w5: input of stage 1 */
    const real r1_w5_u1 = r1_w5_y2 - r1_w5_e0;

    /* khepera.bg:17: r1_w5: stage 1 */
    const real r1_w5_y1 = x->r1_w5_s1 + c->b * r1_w5_u1;

    /* khepera.bg:17: r1_w5: stage 1: memory */
    x->r1_w5_s1 = c->a * r1_w5_y1 + c->b * r1_w5_u1;

    /* khepera.bg:17: r1: what the tolerances of m.el.Re and m.el.k can do together */
    const real r1_w5 = r1_w5_y1;

    /* khepera.bg:17: r1_w6: input of stage 3 */
    const real r1_w6_u3 = -c->r1_w6_m__me__we * s->m__me__we;

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

    /* khepera.bg:17: r1: what the tolerances of m.el.Re and m.me.fe can do together */
    const real r1_w6 = r1_w6_y1;

    /* khepera.bg:17: r1_w7: input of stage 3 */
    const real r1_w7_u3 = -c->r1_w7_m__wh__ws * s->m__wh__ws;

    /* khepera.bg:17: r1_w7: stage 3 */
    const real r1_w7_y3 = x->r1_w7_s3 + c->b * r1_w7_u3;

    /* khepera.bg:17: r1_w7: stage 3: memory */
    x->r1_w7_s3 = c->a * r1_w7_y3 + c->b * r1_w7_u3;

    /* khepera.bg:17: r1_w7: input of stage 2 */
    const real r1_w7_u2 = r1_w7_y3;

    /* khepera.bg:17: r1_w7: stage 2 */
    const real r1_w7_y2 = x->r1_w7_s2 + c->b * r1_w7_u2;

    /* khepera.bg:17: r1_w7: stage 2: memory */
    x->r1_w7_s2 = c->a * r1_w7_y2 + c->b * r1_w7_u2;

    /* khepera.bg:17: r1_w7: input of stage 1 */
    const real r1_w7_u1 = r1_w7_y2;

    /* khepera.bg:17: r1_w7: stage 1 */
    const real r1_w7_y1 = x->r1_w7_s1 + c->b * r1_w7_u1;

    /* khepera.bg:17: r1_w7: stage 1: memory */
    x->r1_w7_s1 = c->a * r1_w7_y1 + c->b * r1_w7_u1;

    /* khepera.bg:17: r1: what the tolerances of m.el.Re and m.wh.fs can do together */
    const real r1_w7 = r1_w7_y1;

    /* khepera.bg:17: r1_w8: terms of order 0 */
    const real r1_w8_g0 = -c->r1_w8_m__me__we * s->m__me__we - c->r1_w8_m__wh__ws * s->m__wh__ws
        - c->r1_w8_Fx * s->Fx;

    /* khepera.bg:17: r1_w8: terms of order 1 */
    const real r1_w8_g1 = c->r1_w8_w1_m__me__we * s->m__me__we
        + c->r1_w8_w1_m__wh__ws * s->m__wh__ws - c->r1_w8_w1_Fx * s->Fx;

    /* khepera.bg:17: r1_w8: error of order 0 */
    const real r1_w8_e0 = c->bend2 * r1_w8_g0;

    /* khepera.bg:17: r1_w8: degree 2 */
    const real r1_w8_d2 = -c->r1_w8_w2_m__me__we * s->m__me__we
        - c->r1_w8_w2_m__wh__ws * s->m__wh__ws - r1_w8_e0;

    /* khepera.bg:17: r1_w8: error of order 1 */
    const real r1_w8_e1 = c->bend1 * r1_w8_g1;

    /* khepera.bg:17: r1_w8: input of stage 3 */
    const real r1_w8_u3 = r1_w8_g0 + r1_w8_d2 + r1_w8_e1 - r1_w8_g1;

    /* khepera.bg:17: r1_w8: stage 3 */
    const real r1_w8_y3 = x->r1_w8_s3 + c->b * r1_w8_u3;

    /* khepera.bg:17: r1_w8: stage 3: memory */
    x->r1_w8_s3 = c->a * r1_w8_y3 + c->b * r1_w8_u3;

    /* khepera.bg:17: r1_w8: input of stage 2 */
    const real r1_w8_u2 = r1_w8_y3 + r1_w8_g1 - REAL(2.0) * r1_w8_d2 - REAL(3.0) * r1_w8_e1;

    /* khepera.bg:17: r1_w8: stage 2 */
    const real r1_w8_y2 = x->r1_w8_s2 + c->b * r1_w8_u2;

    /* khepera.bg:17: r1_w8: stage 2: memory */
    x->r1_w8_s2 = c->a * r1_w8_y2 + c->b * r1_w8_u2;

    /* khepera.bg:17: r1_w8: input of stage 1 */
    const real r1_w8_u1 = r1_w8_y2 + r1_w8_d2 + REAL(3.0) * r1_w8_e1;

    /* khepera.bg:17: r1_w8: stage 1 */
    const real r1_w8_y1 = x->r1_w8_s1 + c->b * r1_w8_u1;

    /* khepera.bg:17: r1_w8: stage 1: memory */
    x->r1_w8_s1 = c->a * r1_w8_y1 + c->b * r1_w8_u1;

    /* khepera.bg:17: r1: second order of what the tolerance of m.el.k can do */
    const real r1_w8 = r1_w8_y1 - r1_w8_e1;

    /* khepera.bg:17: r1_w9: terms of order 0 */
    const real r1_w9_g0 = c->r1_w9_m__me__we * s->m__me__we;

    /* khepera.bg:17: r1_w9: degree 1 */
    const real r1_w9_d1 = c->r1_w9_w1_m__me__we * s->m__me__we;

    /* khepera.bg:17: r1_w9: error of order 0 */
    const real r1_w9_e0 = c->bend1 * r1_w9_g0;

    /* khepera.bg:17: r1_w9: input of stage 3 */
    const real r1_w9_u3 = r1_w9_g0 - r1_w9_d1 - r1_w9_e0;

    /* khepera.bg:17: r1_w9: stage 3 */
    const real r1_w9_y3 = x->r1_w9_s3 + c->b * r1_w9_u3;

    /* khepera.bg:17: r1_w9: stage 3: memory */
    x->r1_w9_s3 = c->a * r1_w9_y3 + c->b * r1_w9_u3;

    /* khepera.bg:17: r1_w9: input of stage 2 */
    const real r1_w9_u2 = r1_w9_y3 + r1_w9_d1 + REAL(2.0) * r1_w9_e0;

    /* khepera.bg:17: r1_w9: stage 2 */
    const real r1_w9_y2 = x->r1_w9_s2 + c->b * r1_w9_u2;

    /* khepera.bg:17: r1_w9: stage 2: memory */
    x->r1_w9_s2 = c->a * r1_w9_y2 + c->b * r1_w9_u2;

    /* khepera.bg:17: r1_w9: input of stage 1 */
    const real r1_w9_u1 = r1_w9_y2 - r1_w9_e0;

    /* khepera.bg:17: r1_w9: stage 1 */
    const real r1_w9_y1 = x->r1_w9_s1 + c->b * r1_w9_u1;

    /* khepera.bg:17: r1_w9: stage 1: memory */
    x->r1_w9_s1 = c->a * r1_w9_y1 + c->b * r1_w9_u1;

    /* khepera.bg:17: r1: what the tolerances of m.el.k and m.me.fe can do together */
    const real r1_w9 = r1_w9_y1;

    /* khepera.bg:17: r1_w10: terms of order 0 */
    const real r1_w10_g0 = c->r1_w10_m__wh__ws * s->m__wh__ws;

    /* khepera.bg:17: r1_w10: degree 1 */
    const real r1_w10_d1 = c->r1_w10_w1_m__wh__ws * s->m__wh__ws;

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

    /* khepera.bg:17: r1: what the tolerances of m.el.k and m.wh.fs can do together */
    const real r1_w10 = r1_w10_y1;

    /* khepera.bg:17: r1: how far r1 can be from zero if no parameter is out of tolerance */
    r[DRIVE_BENCH_THRESHOLD_R1] = MATH(fabs)(r1_w1) + MATH(fabs)(r1_w2) + MATH(fabs)(r1_w3)
        + MATH(fabs)(r1_w4) + MATH(fabs)(r1_w5) + MATH(fabs)(r1_w6) + MATH(fabs)(r1_w7)
        + MATH(fabs)(r1_w8) + MATH(fabs)(r1_w9) + MATH(fabs)(r1_w10);
}

/* One sample for r1; a number that is not finite makes the next sample the first. */
static void run_r1(
    drive_bench_threshold_monitor *monitor, const drive_bench_threshold_samples *s, drive_bench_threshold_residuals *residuals)
{
    real *r = residuals->value;
    uint32_t age = monitor->age[0];

    if (age == 0u) {
        start_r1(monitor, s, r);
    } else {
        next_r1(monitor, s, r);
    }
    /* a sum is finite only if all its terms are */
    if (finite_number(s->Fx + s->m__me__we + s->m__wh__ws + r[DRIVE_BENCH_THRESHOLD_R1])) {
        age += age < UINT32_MAX ? 1u : 0u;
    } else {
        age = 0u;
        r[DRIVE_BENCH_THRESHOLD_R1] = REAL(0.0);
    }
    monitor->age[0] = age;
    residuals->valid[DRIVE_BENCH_THRESHOLD_R1] = age > monitor->settle[DRIVE_BENCH_THRESHOLD_R1];
}

/* r2 on its first sample: the filter as if it had always been so. */
static void start_r2(
    drive_bench_threshold_monitor *monitor, const drive_bench_threshold_samples *s, real *r)
{
    (void)monitor;
    (void)s;

    /* khepera.bg:41: r2: how far r2 can be from zero if no parameter is out of tolerance */
    r[DRIVE_BENCH_THRESHOLD_R2] = REAL(0.0);
}

/* r2 on every further sample. */
static void next_r2(
    drive_bench_threshold_monitor *monitor, const drive_bench_threshold_samples *s, real *r)
{
    (void)monitor;
    (void)s;

    /* khepera.bg:41: r2: how far r2 can be from zero if no parameter is out of tolerance */
    r[DRIVE_BENCH_THRESHOLD_R2] = REAL(0.0);
}

/* One sample for r2; a number that is not finite makes the next sample the first. */
static void run_r2(
    drive_bench_threshold_monitor *monitor, const drive_bench_threshold_samples *s, drive_bench_threshold_residuals *residuals)
{
    real *r = residuals->value;
    uint32_t age = monitor->age[1];

    if (age == 0u) {
        start_r2(monitor, s, r);
    } else {
        next_r2(monitor, s, r);
    }
    /* a sum is finite only if all its terms are */
    if (finite_number(r[DRIVE_BENCH_THRESHOLD_R2])) {
        age += age < UINT32_MAX ? 1u : 0u;
    } else {
        age = 0u;
        r[DRIVE_BENCH_THRESHOLD_R2] = REAL(0.0);
    }
    monitor->age[1] = age;
    residuals->valid[DRIVE_BENCH_THRESHOLD_R2] = age > monitor->settle[DRIVE_BENCH_THRESHOLD_R2];
}

void drive_bench_threshold_reset(drive_bench_threshold_monitor *monitor)
{
    int k;

    for (k = 0; k < 2; ++k) {
        monitor->age[k] = 0u;
    }
}

void drive_bench_threshold_step(
    drive_bench_threshold_monitor *monitor,
    const drive_bench_threshold_samples *samples,
    drive_bench_threshold_residuals *residuals)
{
    run_r1(monitor, samples, residuals);
    run_r2(monitor, samples, residuals);
}
