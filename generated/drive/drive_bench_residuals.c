/* drive_bench_residuals.c: the residuals of DriveBench; generated, see the header. */
#include "drive_bench_residuals.h"

#include <math.h>

#if defined __FINITE_MATH_ONLY__ && __FINITE_MATH_ONLY__
#error "this code tells numbers from NaN: compile it without -ffinite-math-only (-ffast-math)"
#endif

typedef drive_bench_real real;

#define REAL(x) DRIVE_BENCH_CONSTANT(x)
#if defined DRIVE_BENCH_FLOAT && !defined DRIVE_BENCH_REAL
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

uint32_t drive_bench_abi(void)
{
    return DRIVE_BENCH_ABI;
}

const char *drive_bench_digest(void)
{
    return DRIVE_BENCH_DIGEST;
}

void drive_bench_nominal(drive_bench_parameters *parameters)
{
    parameters->m__tau0 = REAL(0.01);        /* rad */
    parameters->m__A = -REAL(4.0);           /* 1 */
    parameters->m__el__L = REAL(0.0003);     /* H */
    parameters->m__el__Re = REAL(17.6);      /* Ohm */
    parameters->m__el__k = REAL(0.00351);    /* N.m/A */
    parameters->m__me__Je = REAL(1.4e-08);   /* kg.m^2 */
    parameters->m__me__fe = REAL(1.19e-05);  /* N.m.s/rad */
    parameters->m__me__K = REAL(0.1);        /* N.m/rad */
    parameters->m__ge__N = REAL(25.0);       /* 1 */
    parameters->m__wh__Js = REAL(0.1);       /* kg.m^2 */
    parameters->m__wh__fs = REAL(0.0003);    /* N.m.s/rad */
    parameters->m__wh__R = REAL(0.005);      /* m */
}

/* The coefficients of exact and of the filter, from the parameters. */
static void compute_coefficients(drive_bench_monitor *monitor, const drive_bench_parameters *p,
        real sample_time, real bandwidth)
{
    drive_bench_coefficients *c = &monitor->c;

    /* bandwidth*sample_time */
    const real x_ = bandwidth * sample_time;

    /* of a stage: what is left of its memory */
    const real pole = greatest(REAL(2.0) - x_, REAL(0.0)) / (x_ + REAL(2.0));

    /* w*sample_time, x or 2 */
    const real turn = REAL(2.0) * (REAL(1.0) - pole) / (pole + REAL(1.0));

    /* w of the filter 1/(1 + D/w) */
    const real w = turn / sample_time;

    /* khepera.bg:17: m.el.L*m.me.fe/m.el.k */
    const real t = p->m__el__L * p->m__me__fe / p->m__el__k;

    /* khepera.bg:17: m.el.L*m.wh.fs/(m.ge.N*m.el.k) */
    const real t_2 = p->m__el__L * p->m__wh__fs / p->m__ge__N / p->m__el__k;

    /* khepera.bg:17: m.el.Re*m.me.Je/m.el.k */
    const real t_3 = p->m__el__Re * p->m__me__Je / p->m__el__k;

    /* khepera.bg:17: m.el.Re*m.wh.Js/(m.ge.N*m.el.k) */
    const real t_4 = p->m__el__Re * p->m__wh__Js / p->m__ge__N / p->m__el__k;

    /* 1 - pole */
    const real t_5 = REAL(1.0) - pole;

    /* turn^2 */
    const real t_6 = turn * turn;

    /* khepera.bg:17: r1: factor of m.me.we: m.el.k + m.el.Re*m.me.fe/m.el.k */
    c->r1_m__me__we = p->m__el__k + p->m__el__Re * p->m__me__fe / p->m__el__k;

    /* khepera.bg:17: r1: factor of m.me.we': m.el.L*m.me.fe/m.el.k + m.el.Re*m.me.Je/m.el.k */
    c->r1_m__me__we_1 = t + t_3;

    /* khepera.bg:17: r1: factor of m.me.we'': m.el.L*m.me.Je/m.el.k */
    c->r1_m__me__we_2 = p->m__el__L * p->m__me__Je / p->m__el__k;

    /* khepera.bg:17: r1: factor of m.wh.ws: m.el.Re*m.wh.fs/(m.ge.N*m.el.k) */
    c->r1_m__wh__ws = p->m__el__Re * p->m__wh__fs / p->m__ge__N / p->m__el__k;

    /* khepera.bg:17: r1: factor of m.wh.ws': m.el.L*m.wh.fs/(m.ge.N*m.el.k) +
     * m.el.Re*m.wh.Js/(m.ge.N*m.el.k) */
    c->r1_m__wh__ws_1 = t_2 + t_4;

    /* khepera.bg:17: r1: factor of m.wh.ws'': m.el.L*m.wh.Js/(m.ge.N*m.el.k) */
    c->r1_m__wh__ws_2 = p->m__el__L * p->m__wh__Js / p->m__ge__N / p->m__el__k;

    /* khepera.bg:17: r1: factor of Fx: m.el.Re*m.wh.R/(m.ge.N*m.el.k) */
    c->r1_Fx = p->m__el__Re * p->m__wh__R / p->m__ge__N / p->m__el__k;

    /* khepera.bg:17: r1: factor of Fx': m.el.L*m.wh.R/(m.ge.N*m.el.k) */
    c->r1_Fx_1 = p->m__el__L * p->m__wh__R / p->m__ge__N / p->m__el__k;

    /* khepera.bg:17: r1: factor of m.me.we' */
    c->r1_w1_m__me__we = (-t - t_3) * w;

    /* khepera.bg:17: r1: factor of m.me.we'' */
    c->r1_w2_m__me__we = p->m__el__L * p->m__me__Je * w * w / p->m__el__k;

    /* khepera.bg:17: r1: factor of m.wh.ws' */
    c->r1_w1_m__wh__ws = (-t_2 - t_4) * w;

    /* khepera.bg:17: r1: factor of m.wh.ws'' */
    c->r1_w2_m__wh__ws = p->m__el__L * p->m__wh__Js * w * w / p->m__ge__N / p->m__el__k;

    /* khepera.bg:17: r1: factor of Fx' */
    c->r1_w1_Fx = p->m__el__L * p->m__wh__R * w / p->m__ge__N / p->m__el__k;

    /* filter: 2 * (w*sample_time)^2/12 */
    c->bend2 = t_6 / REAL(6.0);

    /* filter: 1 * (w*sample_time)^2/12 */
    c->bend1 = t_6 / REAL(12.0);

    /* filter: what is left of a memory a sample later */
    c->a = pole;

    /* filter: weight of a sample, new and a sample later */
    c->b = REAL(0.5) * t_5;

    /* filter: 1 - b, the memory of a constant 1 */
    c->rest = REAL(1.0) - REAL(0.5) * t_5;

    /* khepera.bg:41: 1/(4*m.tau0) */
    c->g = REAL(0.25) / p->m__tau0;

    /* khepera.bg:41: m.ge.N/(4*m.tau0) */
    c->g_2 = REAL(0.25) * p->m__ge__N / p->m__tau0;

    /* khepera.bg:41: r2: factor of m.wh.ws: m.ge.N */
    c->r2_m__wh__ws = p->m__ge__N;

    /* khepera.bg:41: r2: factor of m.wh.ws': m.wh.fs/(m.ge.N*m.me.K) */
    c->r2_m__wh__ws_1 = p->m__wh__fs / p->m__ge__N / p->m__me__K;

    /* khepera.bg:41: r2: factor of m.wh.ws'': m.wh.Js/(m.ge.N*m.me.K) */
    c->r2_m__wh__ws_2 = p->m__wh__Js / p->m__ge__N / p->m__me__K;

    /* khepera.bg:41: r2: factor of Fx': m.wh.R/(m.ge.N*m.me.K) */
    c->r2_Fx_1 = p->m__wh__R / p->m__ge__N / p->m__me__K;

    /* khepera.bg:41: r2: factor of D(tanh(Int(m.me.we)/(4*m.tau0) - m.ge.N*Int(m.wh.ws)/(4*m.
     * ...): m.tau0*m.A */
    c->r2_tanh_1 = p->m__tau0 * p->m__A;

    /* half the sample time */
    c->half_time = REAL(0.5) * sample_time;

    /* sample_time/24 */
    c->half_twelfth = sample_time / REAL(24.0);

    /* khepera.bg:41: r2: factor of m.wh.ws'' */
    c->r2_w2_m__wh__ws = p->m__wh__Js * w * w / p->m__ge__N / p->m__me__K;

    /* khepera.bg:41: r2: factor of Fx' */
    c->r2_w1_Fx = p->m__wh__R * w / p->m__ge__N / p->m__me__K;

    /* khepera.bg:41: r2: factor of D(tanh(Int(m.me.we)/(4*m.tau0) - m.ge.N*Int(m.wh.ws)/(4*m.
     * ...) */
    c->r2_w1_tanh = p->m__tau0 * p->m__A * w;
}

static bool parameters_are_finite(const drive_bench_parameters *p)
{
    return finite_number(p->m__tau0 + p->m__A + p->m__el__L + p->m__el__Re + p->m__el__k
            + p->m__me__Je + p->m__me__fe + p->m__me__K + p->m__ge__N + p->m__wh__Js + p->m__wh__fs
            + p->m__wh__R);
}

static bool coefficients_are_finite(const drive_bench_monitor *monitor)
{
    return finite_number(monitor->c.r1_m__me__we + monitor->c.r1_m__me__we_1
            + monitor->c.r1_m__me__we_2 + monitor->c.r1_m__wh__ws + monitor->c.r1_m__wh__ws_1
            + monitor->c.r1_m__wh__ws_2 + monitor->c.r1_Fx + monitor->c.r1_Fx_1
            + monitor->c.r1_w1_m__me__we + monitor->c.r1_w2_m__me__we + monitor->c.r1_w1_m__wh__ws
            + monitor->c.r1_w2_m__wh__ws + monitor->c.r1_w1_Fx + monitor->c.bend2 + monitor->c.bend1
            + monitor->c.a + monitor->c.b + monitor->c.rest + monitor->c.g + monitor->c.g_2
            + monitor->c.r2_m__wh__ws + monitor->c.r2_m__wh__ws_1 + monitor->c.r2_m__wh__ws_2
            + monitor->c.r2_Fx_1 + monitor->c.r2_tanh_1 + monitor->c.half_time
            + monitor->c.half_twelfth + monitor->c.r2_w2_m__wh__ws + monitor->c.r2_w1_Fx
            + monitor->c.r2_w1_tanh);
}

/* Samples until `constants` time constants of the filter are over. */
static uint32_t samples(real constants, real sample_time, real bandwidth)
{
    const real wait = constants / (bandwidth * sample_time);
    const uint32_t whole = wait < REAL(4.0e9) ? (uint32_t)wait : UINT32_MAX - 1u;

    return (real)whole < wait ? whole + 1u : whole;
}

drive_bench_status drive_bench_configure(
    drive_bench_monitor *monitor,
    const drive_bench_parameters *parameters,
    drive_bench_real sample_time,
    drive_bench_real bandwidth,
    drive_bench_real time_unit)
{
    int k;

    for (k = 0; k < DRIVE_BENCH_RESIDUALS; ++k) {
        monitor->settle[k] = UINT32_MAX;
    }
    drive_bench_reset(monitor);
    if (!parameters_are_finite(parameters)) {
        return DRIVE_BENCH_BAD_PARAMETER;
    }
    if (!(sample_time >= REAL(0.000999999)) || !finite_number(sample_time)) {
        return DRIVE_BENCH_BAD_SAMPLE_TIME;
    }
    if (!(bandwidth * sample_time >= SLOWEST && bandwidth * sample_time <= REAL(3.0))) {
        return DRIVE_BENCH_BAD_BANDWIDTH;
    }
    if (!(time_unit > REAL(0.0)) || !finite_number(time_unit)) {
        return DRIVE_BENCH_BAD_TIME_UNIT;
    }
    compute_coefficients(monitor, parameters, sample_time, bandwidth);
    if (!coefficients_are_finite(monitor)) {
        return DRIVE_BENCH_BAD_COEFFICIENT;
    }
    monitor->settle[DRIVE_BENCH_R1] = samples(REAL(11.228872242412663), sample_time, bandwidth);
    monitor->settle[DRIVE_BENCH_R2] = samples(REAL(11.228872242412663), sample_time, bandwidth);
    return DRIVE_BENCH_OK;
}

void drive_bench_exact(
    const drive_bench_monitor *monitor,
    const drive_bench_derivatives *derivatives,
    drive_bench_real residuals[DRIVE_BENCH_RESIDUALS])
{
    const drive_bench_coefficients *c = &monitor->c;
    const drive_bench_derivatives *d = derivatives;
    real *r = residuals;

    /* khepera.bg:17: r1 = U0 - m.el.k*m.me.we - m.el.Re*m.el.k.e2/m.el.k -
     * m.el.L*D(m.el.k.e2)/m.el.k
     * where m.el.k.e2 = m.me.fe*m.me.we + m.me.Je*D(m.me.we) + (m.wh.fs*m.wh.ws + m.wh.R*Fx +
     * m.wh.Js*D(m.wh.ws))/m.ge.N */
    r[DRIVE_BENCH_R1] = d->U0 - c->r1_m__me__we * d->m__me__we[0]
        - c->r1_m__me__we_1 * d->m__me__we[1] - c->r1_m__me__we_2 * d->m__me__we[2]
        - c->r1_m__wh__ws * d->m__wh__ws[0] - c->r1_m__wh__ws_1 * d->m__wh__ws[1]
        - c->r1_m__wh__ws_2 * d->m__wh__ws[2] - c->r1_Fx * d->Fx[0] - c->r1_Fx_1 * d->Fx[1];

    /* khepera.bg:41: tanh(Int(m.me.we)/(4*m.tau0) - m.ge.N*Int(m.wh.ws)/(4*m.tau0)) */
    const real t = MATH(tanh)(c->g * d->m__me__we_integral - c->g_2 * d->m__wh__ws_integral);

    /* khepera.bg:41: r2 = m.me.we - m.ge.N*m.wh.ws - D(m.wh.fs*m.wh.ws + m.wh.R*Fx +
     * m.wh.Js*D(m.wh.ws) - m.tau0*m.A*m.ge.N*m.me.K*tanh((Int(m.me.we) -
     * m.ge.N*Int(m.wh.ws))/(4*m.tau0)))/(m.ge.N*m.me.K) */
    r[DRIVE_BENCH_R2] = d->m__me__we[0]
        + c->r2_tanh_1 * ((c->g * d->m__me__we[0] - c->g_2 * d->m__wh__ws[0]) * (REAL(1.0) - t * t))
        - c->r2_m__wh__ws * d->m__wh__ws[0] - c->r2_m__wh__ws_1 * d->m__wh__ws[1]
        - c->r2_m__wh__ws_2 * d->m__wh__ws[2] - c->r2_Fx_1 * d->Fx[1];
}

/* r1 on its first sample: the filter as if it had always been so. */
static void start_r1(
    drive_bench_monitor *monitor, const drive_bench_samples *s, real *r)
{
    const drive_bench_coefficients *c = &monitor->c;
    drive_bench_memory *x = &monitor->x;

    /* khepera.bg:17: r1: terms of order 0 */
    const real r1_g0 = s->U0 - c->r1_m__me__we * s->m__me__we - c->r1_m__wh__ws * s->m__wh__ws
        - c->r1_Fx * s->Fx;

    /* khepera.bg:17: r1: terms of order 1 */
    const real r1_g1 = c->r1_w1_m__me__we * s->m__me__we + c->r1_w1_m__wh__ws * s->m__wh__ws
        - c->r1_w1_Fx * s->Fx;

    /* khepera.bg:17: r1: error of order 0 */
    const real r1_e0 = c->bend2 * r1_g0;

    /* khepera.bg:17: r1: degree 2 */
    const real r1_d2 = -c->r1_w2_m__me__we * s->m__me__we - c->r1_w2_m__wh__ws * s->m__wh__ws
        - r1_e0;

    /* khepera.bg:17: r1: error of order 1 */
    const real r1_e1 = c->bend1 * r1_g1;

    /* khepera.bg:17: r1: input of stage 3 */
    const real r1_u3 = r1_g0 + r1_d2 + r1_e1 - r1_g1;

    /* khepera.bg:17: r1: stage 3, at rest */
    const real r1_y3 = r1_u3;

    /* khepera.bg:17: r1: stage 3: memory */
    x->r1_s3 = c->rest * r1_u3;

    /* khepera.bg:17: r1: input of stage 2 */
    const real r1_u2 = r1_y3 + r1_g1 - REAL(2.0) * r1_d2 - REAL(3.0) * r1_e1;

    /* khepera.bg:17: r1: stage 2, at rest */
    const real r1_y2 = r1_u2;

    /* khepera.bg:17: r1: stage 2: memory */
    x->r1_s2 = c->rest * r1_u2;

    /* khepera.bg:17: r1: input of stage 1 */
    const real r1_u1 = r1_y2 + r1_d2 + REAL(3.0) * r1_e1;

    /* khepera.bg:17: r1: stage 1, at rest */
    const real r1_y1 = r1_u1;

    /* khepera.bg:17: r1: stage 1: memory */
    x->r1_s1 = c->rest * r1_u1;

    /* khepera.bg:17: r1 = U0 - m.el.k*m.me.we - m.el.Re*m.el.k.e2/m.el.k -
     * m.el.L*D(m.el.k.e2)/m.el.k
     * where m.el.k.e2 = m.me.fe*m.me.we + m.me.Je*D(m.me.we) + (m.wh.fs*m.wh.ws + m.wh.R*Fx +
     * m.wh.Js*D(m.wh.ws))/m.ge.N */
    r[DRIVE_BENCH_R1] = r1_y1 - r1_e1;
}

/* r1 on every further sample. */
static void next_r1(
    drive_bench_monitor *monitor, const drive_bench_samples *s, real *r)
{
    const drive_bench_coefficients *c = &monitor->c;
    drive_bench_memory *x = &monitor->x;

    /* khepera.bg:17: r1: terms of order 0 */
    const real r1_g0 = s->U0 - c->r1_m__me__we * s->m__me__we - c->r1_m__wh__ws * s->m__wh__ws
        - c->r1_Fx * s->Fx;

    /* khepera.bg:17: r1: terms of order 1 */
    const real r1_g1 = c->r1_w1_m__me__we * s->m__me__we + c->r1_w1_m__wh__ws * s->m__wh__ws
        - c->r1_w1_Fx * s->Fx;

    /* khepera.bg:17: r1: error of order 0 */
    const real r1_e0 = c->bend2 * r1_g0;

    /* khepera.bg:17: r1: degree 2 */
    const real r1_d2 = -c->r1_w2_m__me__we * s->m__me__we - c->r1_w2_m__wh__ws * s->m__wh__ws
        - r1_e0;

    /* khepera.bg:17: r1: error of order 1 */
    const real r1_e1 = c->bend1 * r1_g1;

    /* khepera.bg:17: r1: input of stage 3 */
    const real r1_u3 = r1_g0 + r1_d2 + r1_e1 - r1_g1;

    /* khepera.bg:17: r1: stage 3 */
    const real r1_y3 = x->r1_s3 + c->b * r1_u3;

    /* khepera.bg:17: r1: stage 3: memory */
    x->r1_s3 = c->a * r1_y3 + c->b * r1_u3;

    /* khepera.bg:17: r1: input of stage 2 */
    const real r1_u2 = r1_y3 + r1_g1 - REAL(2.0) * r1_d2 - REAL(3.0) * r1_e1;

    /* khepera.bg:17: r1: stage 2 */
    const real r1_y2 = x->r1_s2 + c->b * r1_u2;

    /* khepera.bg:17: r1: stage 2: memory */
    x->r1_s2 = c->a * r1_y2 + c->b * r1_u2;

    /* khepera.bg:17: r1: input of stage 1 */
    const real r1_u1 = r1_y2 + r1_d2 + REAL(3.0) * r1_e1;

    /* khepera.bg:17: r1: stage 1 */
    const real r1_y1 = x->r1_s1 + c->b * r1_u1;

    /* khepera.bg:17: r1: stage 1: memory */
    x->r1_s1 = c->a * r1_y1 + c->b * r1_u1;

    /* khepera.bg:17: r1 = U0 - m.el.k*m.me.we - m.el.Re*m.el.k.e2/m.el.k -
     * m.el.L*D(m.el.k.e2)/m.el.k
     * where m.el.k.e2 = m.me.fe*m.me.we + m.me.Je*D(m.me.we) + (m.wh.fs*m.wh.ws + m.wh.R*Fx +
     * m.wh.Js*D(m.wh.ws))/m.ge.N */
    r[DRIVE_BENCH_R1] = r1_y1 - r1_e1;
}

/* One sample for r1; a number that is not finite makes the next sample the first. */
static void run_r1(
    drive_bench_monitor *monitor, const drive_bench_samples *s, drive_bench_residuals *residuals)
{
    real *r = residuals->value;
    uint32_t age = monitor->age[0];

    if (age == 0u) {
        start_r1(monitor, s, r);
    } else {
        next_r1(monitor, s, r);
    }
    /* a sum is finite only if all its terms are */
    if (finite_number(s->U0 + s->Fx + s->m__me__we + s->m__wh__ws + r[DRIVE_BENCH_R1])) {
        age += age < UINT32_MAX ? 1u : 0u;
    } else {
        age = 0u;
        r[DRIVE_BENCH_R1] = REAL(0.0);
    }
    monitor->age[0] = age;
    residuals->valid[DRIVE_BENCH_R1] = age > monitor->settle[DRIVE_BENCH_R1];
}

/* r2 on its first sample: the filter as if it had always been so. */
static void start_r2(
    drive_bench_monitor *monitor, const drive_bench_samples *s, real *r)
{
    const drive_bench_coefficients *c = &monitor->c;
    drive_bench_memory *x = &monitor->x;

    /* khepera.bg:41: integral of m.me.we/(4*m.tau0) - m.ge.N*m.wh.ws/(4*m.tau0), what is
     * integrated */
    const real r2_rate = c->g * s->m__me__we - c->g_2 * s->m__wh__ws;

    /* khepera.bg:41: integral of m.me.we/(4*m.tau0) - m.ge.N*m.wh.ws/(4*m.tau0), at the start */
    const real r2_int = REAL(0.0);

    /* khepera.bg:41: integral of m.me.we/(4*m.tau0) - m.ge.N*m.wh.ws/(4*m.tau0): memory */
    x->r2_q = c->half_time * r2_rate;

    /* khepera.bg:41: integral of m.me.we/(4*m.tau0) - m.ge.N*m.wh.ws/(4*m.tau0) */
    const real r2_integral = r2_int;

    /* khepera.bg:41: integral of m.me.we/(4*m.tau0) - m.ge.N*m.wh.ws/(4*m.tau0): memory */
    x->r2_rate2 = r2_rate;
    x->r2_rate1 = r2_rate;

    /* khepera.bg:41: tanh(Int(m.me.we)/(4*m.tau0) - m.ge.N*Int(m.wh.ws)/(4*m. ... */
    const real r2_tanh = MATH(tanh)(r2_integral);

    /* khepera.bg:41: r2: terms of order 0 */
    const real r2_g0 = s->m__me__we - c->r2_m__wh__ws * s->m__wh__ws;

    /* khepera.bg:41: r2: terms of order 1 */
    const real r2_g1 = c->r2_w1_tanh * r2_tanh - c->r2_w1_Fx * s->Fx;

    /* khepera.bg:41: r2: error of order 0 */
    const real r2_e0 = c->bend2 * r2_g0;

    /* khepera.bg:41: r2: degree 2 */
    const real r2_d2 = -c->r2_w2_m__wh__ws * s->m__wh__ws - r2_e0;

    /* khepera.bg:41: r2: error of order 1 */
    const real r2_e1 = c->bend1 * r2_g1;

    /* khepera.bg:41: r2: input of stage 3 */
    const real r2_u3 = r2_g0 + r2_d2 + r2_e1 - r2_g1;

    /* khepera.bg:41: r2: stage 3, at rest */
    const real r2_y3 = r2_u3;

    /* khepera.bg:41: r2: stage 3: memory */
    x->r2_s3 = c->rest * r2_u3;

    /* khepera.bg:41: r2: input of stage 2 */
    const real r2_u2 = r2_y3 + r2_g1 - REAL(2.0) * r2_d2 - REAL(3.0) * r2_e1;

    /* khepera.bg:41: r2: stage 2, at rest */
    const real r2_y2 = r2_u2;

    /* khepera.bg:41: r2: stage 2: memory */
    x->r2_s2 = c->rest * r2_u2;

    /* khepera.bg:41: r2: input of stage 1 */
    const real r2_u1 = r2_y2 + r2_d2 + REAL(3.0) * r2_e1;

    /* khepera.bg:41: r2: stage 1, at rest */
    const real r2_y1 = r2_u1;

    /* khepera.bg:41: r2: stage 1: memory */
    x->r2_s1 = c->rest * r2_u1;

    /* khepera.bg:41: r2 = m.me.we - m.ge.N*m.wh.ws - D(m.wh.fs*m.wh.ws + m.wh.R*Fx +
     * m.wh.Js*D(m.wh.ws) - m.tau0*m.A*m.ge.N*m.me.K*tanh((Int(m.me.we) -
     * m.ge.N*Int(m.wh.ws))/(4*m.tau0)))/(m.ge.N*m.me.K) */
    r[DRIVE_BENCH_R2] = r2_y1 - r2_e1;
}

/* r2 on every further sample. */
static void next_r2(
    drive_bench_monitor *monitor, const drive_bench_samples *s, real *r)
{
    const drive_bench_coefficients *c = &monitor->c;
    drive_bench_memory *x = &monitor->x;

    /* khepera.bg:41: integral of m.me.we/(4*m.tau0) - m.ge.N*m.wh.ws/(4*m.tau0), what is
     * integrated */
    const real r2_rate = c->g * s->m__me__we - c->g_2 * s->m__wh__ws;

    /* khepera.bg:41: integral of m.me.we/(4*m.tau0) - m.ge.N*m.wh.ws/(4*m.tau0) */
    const real r2_int = x->r2_q + c->half_time * r2_rate;

    /* khepera.bg:41: integral of m.me.we/(4*m.tau0) - m.ge.N*m.wh.ws/(4*m.tau0): memory */
    x->r2_q = r2_int + c->half_time * r2_rate;

    /* khepera.bg:41: integral of m.me.we/(4*m.tau0) - m.ge.N*m.wh.ws/(4*m.tau0) */
    const real r2_integral = r2_int
        - c->half_twelfth * (REAL(3.0) * r2_rate - REAL(4.0) * x->r2_rate1 + x->r2_rate2);

    /* khepera.bg:41: integral of m.me.we/(4*m.tau0) - m.ge.N*m.wh.ws/(4*m.tau0): memory */
    x->r2_rate2 = x->r2_rate1;
    x->r2_rate1 = r2_rate;

    /* khepera.bg:41: tanh(Int(m.me.we)/(4*m.tau0) - m.ge.N*Int(m.wh.ws)/(4*m. ... */
    const real r2_tanh = MATH(tanh)(r2_integral);

    /* khepera.bg:41: r2: terms of order 0 */
    const real r2_g0 = s->m__me__we - c->r2_m__wh__ws * s->m__wh__ws;

    /* khepera.bg:41: r2: terms of order 1 */
    const real r2_g1 = c->r2_w1_tanh * r2_tanh - c->r2_w1_Fx * s->Fx;

    /* khepera.bg:41: r2: error of order 0 */
    const real r2_e0 = c->bend2 * r2_g0;

    /* khepera.bg:41: r2: degree 2 */
    const real r2_d2 = -c->r2_w2_m__wh__ws * s->m__wh__ws - r2_e0;

    /* khepera.bg:41: r2: error of order 1 */
    const real r2_e1 = c->bend1 * r2_g1;

    /* khepera.bg:41: r2: input of stage 3 */
    const real r2_u3 = r2_g0 + r2_d2 + r2_e1 - r2_g1;

    /* khepera.bg:41: r2: stage 3 */
    const real r2_y3 = x->r2_s3 + c->b * r2_u3;

    /* khepera.bg:41: r2: stage 3: memory */
    x->r2_s3 = c->a * r2_y3 + c->b * r2_u3;

    /* khepera.bg:41: r2: input of stage 2 */
    const real r2_u2 = r2_y3 + r2_g1 - REAL(2.0) * r2_d2 - REAL(3.0) * r2_e1;

    /* khepera.bg:41: r2: stage 2 */
    const real r2_y2 = x->r2_s2 + c->b * r2_u2;

    /* khepera.bg:41: r2: stage 2: memory */
    x->r2_s2 = c->a * r2_y2 + c->b * r2_u2;

    /* khepera.bg:41: r2: input of stage 1 */
    const real r2_u1 = r2_y2 + r2_d2 + REAL(3.0) * r2_e1;

    /* khepera.bg:41: r2: stage 1 */
    const real r2_y1 = x->r2_s1 + c->b * r2_u1;

    /* khepera.bg:41: r2: stage 1: memory */
    x->r2_s1 = c->a * r2_y1 + c->b * r2_u1;

    /* khepera.bg:41: r2 = m.me.we - m.ge.N*m.wh.ws - D(m.wh.fs*m.wh.ws + m.wh.R*Fx +
     * m.wh.Js*D(m.wh.ws) - m.tau0*m.A*m.ge.N*m.me.K*tanh((Int(m.me.we) -
     * m.ge.N*Int(m.wh.ws))/(4*m.tau0)))/(m.ge.N*m.me.K) */
    r[DRIVE_BENCH_R2] = r2_y1 - r2_e1;
}

/* One sample for r2; a number that is not finite makes the next sample the first. */
static void run_r2(
    drive_bench_monitor *monitor, const drive_bench_samples *s, drive_bench_residuals *residuals)
{
    real *r = residuals->value;
    uint32_t age = monitor->age[1];

    if (age == 0u) {
        start_r2(monitor, s, r);
    } else {
        next_r2(monitor, s, r);
    }
    /* a sum is finite only if all its terms are */
    if (finite_number(s->Fx + s->m__me__we + s->m__wh__ws + r[DRIVE_BENCH_R2])) {
        age += age < UINT32_MAX ? 1u : 0u;
    } else {
        age = 0u;
        r[DRIVE_BENCH_R2] = REAL(0.0);
    }
    monitor->age[1] = age;
    residuals->valid[DRIVE_BENCH_R2] = age > monitor->settle[DRIVE_BENCH_R2];
}

void drive_bench_reset(drive_bench_monitor *monitor)
{
    int k;

    for (k = 0; k < 2; ++k) {
        monitor->age[k] = 0u;
    }
}

void drive_bench_step(
    drive_bench_monitor *monitor,
    const drive_bench_samples *samples,
    drive_bench_residuals *residuals)
{
    run_r1(monitor, samples, residuals);
    run_r2(monitor, samples, residuals);
}

const char drive_bench_fault_name[DRIVE_BENCH_FAULTS][8] = {
    "m.el.L", "m.el.Re", "m.el.k", "m.me.Je", "m.me.fe", "U0", "m.ge.N", "m.wh.Js", "m.wh.R", "Fx",
    "m.me.we", "m.wh.ws", "m.wh.fs", "m.tau0", "m.A", "m.me.K",
};

const uint16_t drive_bench_fault_class[DRIVE_BENCH_FAULTS] = {
    0u, 0u, 0u, 0u, 0u, 0u, 1u, 1u, 1u, 1u, 1u, 1u, 2u, 3u, 3u, 3u,
};

const char drive_bench_residual_name[DRIVE_BENCH_RESIDUALS][3] = {
    "r1", "r2",
};

/* Signatures: 1 where a residual may be moved by the faults of a class, 3 where it is for sure. */
static const uint8_t signature[DRIVE_BENCH_CLASSES][DRIVE_BENCH_RESIDUALS] = {
    {3u, 0u},
    {3u, 3u},
    {3u, 1u},
    {0u, 3u},
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
    drive_bench_diagnosis *d, const drive_bench_limit *limit, int k, real off, real out, real bound)
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

static bool sums_are_zero(const drive_bench_diagnosis *d, int k)
{
    const real sum = d->above[k] + d->below[k] + d->louder[k];

    return !(sum > REAL(0.0));
}

static void forget_sums(drive_bench_diagnosis *d, int k)
{
    d->above[k] = REAL(0.0);
    d->below[k] = REAL(0.0);
    d->louder[k] = REAL(0.0);
    d->streak[k] = 0u;
}

/* Residual k in one sample; whether it goes into alarm. */
static bool watch(
    drive_bench_diagnosis *d, const drive_bench_limit *limit, int k, real value, real bound, bool row)
{
    const real off = value - limit->mean;
    const real out = (off < REAL(0.0) ? -off : off) - bound;
    bool high = false;

    if (row) {
        high = add_row(d, limit, k, off, out, bound);
    }
    if (d->state[k] == DRIVE_BENCH_ALARM) {
        d->since[k] += d->since[k] < UINT32_MAX ? 1u : 0u;
        if (!(out < RELEASE * limit->level) || !sums_are_zero(d, k)) {
            d->quiet = 0u;
        }
        return false;
    }
    d->state[k] = DRIVE_BENCH_HEALTHY;
    d->streak[k] = out > limit->level ? d->streak[k] + 1u : 0u;
    if (d->streak[k] < d->least && !high) {
        return false;
    }
    d->state[k] = DRIVE_BENCH_ALARM;
    d->since[k] = 0u;
    return true;
}

/* What is left of a class of faults. */
static drive_bench_candidate left_of(const drive_bench_diagnosis *d, const uint8_t *own)
{
    drive_bench_candidate found = DRIVE_BENCH_LIKELY;
    int k;

    for (k = 0; k < DRIVE_BENCH_RESIDUALS; ++k) {
        if (d->state[k] == DRIVE_BENCH_ALARM && own[k] == 0u) {
            return DRIVE_BENCH_RULED_OUT;
        }
        if (d->state[k] == DRIVE_BENCH_HEALTHY && own[k] == 3u) {
            found = DRIVE_BENCH_SMALL;
        }
    }
    return found;
}

/* Which classes of faults the residuals leave, and the one if it is one. */
static void judge(drive_bench_diagnosis *d)
{
    int likely = 0;
    int c;

    d->fault_class = DRIVE_BENCH_UNKNOWN;
    for (c = 0; c < DRIVE_BENCH_CLASSES; ++c) {
        const drive_bench_candidate left = left_of(d, signature[c]);

        d->candidate[c] = (uint8_t)left;
        if (left == DRIVE_BENCH_LIKELY) {
            d->fault_class = (int16_t)c;
            ++likely;
        }
    }
    if (likely != 1 || d->settled < 2u * d->row) {
        d->fault_class = DRIVE_BENCH_UNKNOWN;
    }
}

drive_bench_limit drive_bench_limit_of(drive_bench_real level)
{
    drive_bench_limit limit;

    limit.mean = REAL(0.0);
    limit.level = level;
    limit.unit = REAL(0.0);
    limit.loud = REAL(0.0);
    limit.drift = REAL(0.5);
    limit.height = NEVER;
    limit.bound = REAL(0.0);
    return limit;
}

void drive_bench_clear(drive_bench_diagnosis *diagnosis)
{
    int k;

    for (k = 0; k < DRIVE_BENCH_RESIDUALS; ++k) {
        if (diagnosis->state[k] == DRIVE_BENCH_ALARM) {
            diagnosis->state[k] = DRIVE_BENCH_HEALTHY;
        }
        diagnosis->since[k] = 0u;
        forget_sums(diagnosis, k);
    }
    for (k = 0; k < DRIVE_BENCH_CLASSES; ++k) {
        diagnosis->candidate[k] = DRIVE_BENCH_RULED_OUT;
    }
    diagnosis->fault_class = DRIVE_BENCH_UNKNOWN;
    diagnosis->quiet = 0u;
    diagnosis->settled = 0u;
}

void drive_bench_diagnosis_reset(drive_bench_diagnosis *diagnosis)
{
    int k;

    diagnosis->row = DRIVE_BENCH_ROW;
    diagnosis->least = 15u;
    diagnosis->hold = 10u * DRIVE_BENCH_ROW;
    diagnosis->latch = false;
    diagnosis->tick = 0u;
    for (k = 0; k < DRIVE_BENCH_RESIDUALS; ++k) {
        diagnosis->state[k] = DRIVE_BENCH_BLIND;
    }
    drive_bench_clear(diagnosis);
}

bool drive_bench_diagnose(
    drive_bench_diagnosis *diagnosis,
    const drive_bench_limit *limits,
    const drive_bench_real *bounds,
    const drive_bench_residuals *residuals)
{
    drive_bench_diagnosis *d = diagnosis;
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
    for (k = 0; k < DRIVE_BENCH_RESIDUALS; ++k) {
        if (residuals->valid[k]) {
            const real bound = bounds ? bounds[k] : limits[k].bound;

            fresh = watch(d, &limits[k], k, residuals->value[k], bound, row) || fresh;
        } else {
            forget_sums(d, k);
            if (d->state[k] == DRIVE_BENCH_ALARM) {
                d->quiet = 0u; /* nobody knows that it is over */
            } else {
                d->state[k] = DRIVE_BENCH_BLIND;
            }
        }
        alarm = alarm || d->state[k] == DRIVE_BENCH_ALARM;
    }
    if (fresh) {
        d->quiet = 0u;
        d->settled = 0u;
    }
    if (alarm && !d->latch && d->quiet >= d->hold) {
        drive_bench_clear(d);
        return false;
    }
    if (fresh || (alarm && row)) {
        judge(d);
    }
    return alarm;
}
