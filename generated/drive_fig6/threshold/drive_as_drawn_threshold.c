/* drive_as_drawn_threshold.c: the thresholds of DriveAsDrawn_threshold; generated, see the header. */
#include "drive_as_drawn_threshold.h"

#include <math.h>

#if defined __FINITE_MATH_ONLY__ && __FINITE_MATH_ONLY__
#error "this code tells numbers from NaN: compile it without -ffinite-math-only (-ffast-math)"
#endif

typedef drive_as_drawn_threshold_real real;

#define REAL(x) DRIVE_AS_DRAWN_THRESHOLD_CONSTANT(x)
#if defined DRIVE_AS_DRAWN_THRESHOLD_FLOAT && !defined DRIVE_AS_DRAWN_THRESHOLD_REAL
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

uint32_t drive_as_drawn_threshold_abi(void)
{
    return DRIVE_AS_DRAWN_THRESHOLD_ABI;
}

const char *drive_as_drawn_threshold_digest(void)
{
    return DRIVE_AS_DRAWN_THRESHOLD_DIGEST;
}

void drive_as_drawn_threshold_nominal(drive_as_drawn_threshold_parameters *parameters)
{
    parameters->tau0 = REAL(0.01);        /* rad */
    parameters->A = -REAL(4.0);           /* 1 */
    parameters->el__L = REAL(0.0003);     /* H */
    parameters->el__Re = REAL(17.6);      /* Ohm */
    parameters->el__k = REAL(0.00351);    /* N.m/A */
    parameters->me__Je = REAL(1.4e-08);   /* kg.m^2 */
    parameters->me__fe = REAL(1.19e-05);  /* N.m.s/rad */
    parameters->me__K = REAL(0.1);        /* N.m/rad */
    parameters->ge__N = REAL(25.0);       /* 1 */
    parameters->wh__Js = REAL(0.1);       /* kg.m^2 */
    parameters->wh__fs = REAL(0.0003);    /* N.m.s/rad */
    parameters->wh__R = REAL(0.005);      /* m */
}

/* The coefficients of exact and of the filter, from the parameters. */
static void compute_coefficients(drive_as_drawn_threshold_monitor *monitor,
        const drive_as_drawn_threshold_parameters *p, real sample_time, real bandwidth)
{
    drive_as_drawn_threshold_coefficients *c = &monitor->c;

    /* bandwidth*sample_time */
    const real x_ = bandwidth * sample_time;

    /* of a stage: what is left of its memory */
    const real pole = greatest(REAL(2.0) - x_, REAL(0.0)) / (x_ + REAL(2.0));

    /* w*sample_time, x or 2 */
    const real turn = REAL(2.0) * (REAL(1.0) - pole) / (pole + REAL(1.0));

    /* w of the filter 1/(1 + D/w) */
    const real w = turn / sample_time;

    /* khepera.bg:17: el.Re*me.fe/el.k */
    const real t = p->el__Re * p->me__fe / p->el__k;

    /* khepera.bg:17: tau0*A*me.K*el.Re/el.k */
    const real t_2 = p->tau0 * p->A * p->me__K * p->el__Re / p->el__k;

    /* khepera.bg:17: el.Re*wh.fs/(ge.N*el.k) */
    const real t_3 = p->el__Re * p->wh__fs / p->ge__N / p->el__k;

    /* khepera.bg:17: el.Re*wh.R/(ge.N*el.k) */
    const real t_4 = p->el__Re * p->wh__R / p->ge__N / p->el__k;

    /* 1 - pole */
    const real t_5 = REAL(1.0) - pole;

    /* turn^2 */
    const real t_6 = turn * turn;

    /* khepera.bg:17: el.L*me.Je*w^2/el.k */
    const real t_7 = p->el__L * p->me__Je * w * w / p->el__k;

    /* khepera.bg:17: tau0*A*me.K*el.L*w/el.k */
    const real t_8 = p->tau0 * p->A * p->me__K * p->el__L * w / p->el__k;

    /* khepera.bg:17: el.L*wh.Js*w^2/(ge.N*el.k) */
    const real t_9 = p->el__L * p->wh__Js * w * w / p->ge__N / p->el__k;

    /* khepera.bg:17: el.L*wh.R*w/(ge.N*el.k) */
    const real t_10 = p->el__L * p->wh__R * w / p->ge__N / p->el__k;

    /* khepera.bg:17: el.Re*me.Je*w/el.k */
    const real t_11 = p->el__Re * p->me__Je * w / p->el__k;

    /* khepera.bg:17: el.Re*wh.Js*w/(ge.N*el.k) */
    const real t_12 = p->el__Re * p->wh__Js * w / p->ge__N / p->el__k;

    /* khepera.bg:17: el.L*me.fe*w/el.k */
    const real t_13 = p->el__L * p->me__fe * w / p->el__k;

    /* khepera.bg:17: el.L*wh.fs*w/(ge.N*el.k) */
    const real t_14 = p->el__L * p->wh__fs * w / p->ge__N / p->el__k;

    /* khepera.bg:17: 1/(4*tau0) */
    c->g = REAL(0.25) / p->tau0;

    /* khepera.bg:17: ge.N/(4*tau0) */
    c->g_2 = REAL(0.25) * p->ge__N / p->tau0;

    /* half the sample time */
    c->half_time = REAL(0.5) * sample_time;

    /* sample_time/24 */
    c->half_twelfth = sample_time / REAL(24.0);

    /* khepera.bg:17: r1_w1: factor of me.we */
    c->r1_w1_me__we = t / REAL(20.0);

    /* khepera.bg:17: r1_w1: factor of me.we' */
    c->r1_w1_w1_me__we = t_11 / REAL(20.0);

    /* khepera.bg:17: r1_w1: factor of tanh(Int(me.we)/(4*tau0) - ge.N*Int(wh.ws)/(4*tau0)) */
    c->r1_w1_tanh = t_2 / REAL(10.0);

    /* khepera.bg:17: r1_w1: factor of wh.ws */
    c->r1_w1_wh__ws = t_3 / REAL(20.0);

    /* khepera.bg:17: r1_w1: factor of wh.ws' */
    c->r1_w1_w1_wh__ws = t_12 / REAL(20.0);

    /* khepera.bg:17: r1_w1: factor of Fx */
    c->r1_w1_Fx = t_4 / REAL(20.0);

    /* filter: 1 * (w*sample_time)^2/12 */
    c->bend1 = t_6 / REAL(12.0);

    /* filter: what is left of a memory a sample later */
    c->a = pole;

    /* filter: weight of a sample, new and a sample later */
    c->b = REAL(0.5) * t_5;

    /* filter: 1 - b, the memory of a constant 1 */
    c->rest = REAL(1.0) - REAL(0.5) * t_5;

    /* khepera.bg:17: r1_w2: factor of tanh(Int(me.we)/(4*tau0) - ge.N*Int(wh.ws)/(4*tau0)) */
    c->r1_w2_tanh = t_2 / REAL(25.0);

    /* khepera.bg:17: r1_w2: factor of D(tanh(Int(me.we)/(4*tau0) - ge.N*Int(wh.ws)/(4*tau0))) */
    c->r1_w2_w1_tanh = t_8 / REAL(25.0);

    /* khepera.bg:17: r1_w2: factor of wh.ws */
    c->r1_w2_wh__ws = t_3 / REAL(50.0);

    /* khepera.bg:17: r1_w2: factor of wh.ws' */
    c->r1_w2_w1_wh__ws = p->el__k * w * (p->el__Re * p->wh__Js / p->ge__N / p->el__k / p->el__k
            + p->el__L * p->wh__fs / p->ge__N / p->el__k / p->el__k) / REAL(50.0);

    /* khepera.bg:17: r1_w2: factor of wh.ws'' */
    c->r1_w2_w2_wh__ws = t_9 / REAL(50.0);

    /* khepera.bg:17: r1_w2: factor of Fx */
    c->r1_w2_Fx = t_4 / REAL(50.0);

    /* khepera.bg:17: r1_w2: factor of Fx' */
    c->r1_w2_w1_Fx = t_10 / REAL(50.0);

    /* khepera.bg:17: r1_w2: factor of me.we */
    c->r1_w2_me__we = p->el__k * (p->el__Re * p->me__fe / p->el__k / p->el__k
            - REAL(1.0)) / REAL(50.0);

    /* khepera.bg:17: r1_w2: factor of me.we' */
    c->r1_w2_w1_me__we = p->el__k * w * (p->el__Re * p->me__Je / p->el__k / p->el__k
            + p->el__L * p->me__fe / p->el__k / p->el__k) / REAL(50.0);

    /* khepera.bg:17: r1_w2: factor of me.we'' */
    c->r1_w2_w2_me__we = t_7 / REAL(50.0);

    /* filter: 2 * (w*sample_time)^2/12 */
    c->bend2 = t_6 / REAL(6.0);

    /* khepera.bg:17: r1_w3: factor of me.we */
    c->r1_w3_me__we = t / REAL(10.0);

    /* khepera.bg:17: r1_w3: factor of me.we' */
    c->r1_w3_w1_me__we = t_13 / REAL(10.0);

    /* khepera.bg:17: r1_w4: factor of wh.ws */
    c->r1_w4_wh__ws = t_3 / REAL(10.0);

    /* khepera.bg:17: r1_w4: factor of wh.ws' */
    c->r1_w4_w1_wh__ws = t_14 / REAL(10.0);

    /* khepera.bg:17: r1_w5: factor of me.we */
    c->r1_w5_me__we = t / REAL(730.0);

    /* khepera.bg:17: r1_w5: factor of me.we' */
    c->r1_w5_w1_me__we = t_11 / REAL(730.0);

    /* khepera.bg:17: r1_w5: factor of tanh(Int(me.we)/(4*tau0) - ge.N*Int(wh.ws)/(4*tau0)) */
    c->r1_w5_tanh = t_2 / REAL(365.0);

    /* khepera.bg:17: r1_w5: factor of wh.ws */
    c->r1_w5_wh__ws = t_3 / REAL(730.0);

    /* khepera.bg:17: r1_w5: factor of wh.ws' */
    c->r1_w5_w1_wh__ws = t_12 / REAL(730.0);

    /* khepera.bg:17: r1_w5: factor of Fx */
    c->r1_w5_Fx = t_4 / REAL(730.0);

    /* khepera.bg:17: r1_w6: factor of me.we */
    c->r1_w6_me__we = t / REAL(146.0);

    /* khepera.bg:17: r1_w7: factor of wh.ws */
    c->r1_w7_wh__ws = t_3 / REAL(146.0);

    /* khepera.bg:17: r1_w8: factor of tanh(Int(me.we)/(4*tau0) - ge.N*Int(wh.ws)/(4*tau0)) */
    c->r1_w8_tanh = REAL(2.0) * t_2 / REAL(1825.0);

    /* khepera.bg:17: r1_w8: factor of D(tanh(Int(me.we)/(4*tau0) - ge.N*Int(wh.ws)/(4*tau0))) */
    c->r1_w8_w1_tanh = REAL(2.0) * t_8 / REAL(1825.0);

    /* khepera.bg:17: r1_w8: factor of wh.ws */
    c->r1_w8_wh__ws = t_3 / REAL(1825.0);

    /* khepera.bg:17: r1_w8: factor of wh.ws' */
    c->r1_w8_w1_wh__ws = p->el__k * p->el__k * w
            * (-REAL(2.0) * p->el__Re * p->wh__Js / p->ge__N / p->el__k / p->el__k / p->el__k
            - REAL(2.0) * p->el__L * p->wh__fs / p->ge__N / p->el__k / p->el__k / p->el__k)
            / REAL(3650.0);

    /* khepera.bg:17: r1_w8: factor of wh.ws'' */
    c->r1_w8_w2_wh__ws = t_9 / REAL(1825.0);

    /* khepera.bg:17: r1_w8: factor of Fx */
    c->r1_w8_Fx = t_4 / REAL(1825.0);

    /* khepera.bg:17: r1_w8: factor of Fx' */
    c->r1_w8_w1_Fx = t_10 / REAL(1825.0);

    /* khepera.bg:17: r1_w8: factor of me.we */
    c->r1_w8_me__we = t / REAL(1825.0);

    /* khepera.bg:17: r1_w8: factor of me.we' */
    c->r1_w8_w1_me__we = p->el__k * p->el__k * w
            * (-REAL(2.0) * p->el__Re * p->me__Je / p->el__k / p->el__k / p->el__k
            - REAL(2.0) * p->el__L * p->me__fe / p->el__k / p->el__k / p->el__k) / REAL(3650.0);

    /* khepera.bg:17: r1_w8: factor of me.we'' */
    c->r1_w8_w2_me__we = t_7 / REAL(1825.0);

    /* khepera.bg:17: r1_w9: factor of me.we */
    c->r1_w9_me__we = t / REAL(365.0);

    /* khepera.bg:17: r1_w9: factor of me.we' */
    c->r1_w9_w1_me__we = t_13 / REAL(365.0);

    /* khepera.bg:17: r1_w10: factor of wh.ws */
    c->r1_w10_wh__ws = t_3 / REAL(365.0);

    /* khepera.bg:17: r1_w10: factor of wh.ws' */
    c->r1_w10_w1_wh__ws = t_14 / REAL(365.0);
}

static bool parameters_are_finite(const drive_as_drawn_threshold_parameters *p)
{
    return finite_number(p->tau0 + p->A + p->el__L + p->el__Re + p->el__k + p->me__Je + p->me__fe
            + p->me__K + p->ge__N + p->wh__Js + p->wh__fs + p->wh__R);
}

static bool coefficients_are_finite(const drive_as_drawn_threshold_monitor *monitor)
{
    return finite_number(monitor->c.g + monitor->c.g_2 + monitor->c.half_time
            + monitor->c.half_twelfth + monitor->c.r1_w1_me__we + monitor->c.r1_w1_w1_me__we
            + monitor->c.r1_w1_tanh + monitor->c.r1_w1_wh__ws + monitor->c.r1_w1_w1_wh__ws
            + monitor->c.r1_w1_Fx + monitor->c.bend1 + monitor->c.a + monitor->c.b + monitor->c.rest
            + monitor->c.r1_w2_tanh + monitor->c.r1_w2_w1_tanh + monitor->c.r1_w2_wh__ws
            + monitor->c.r1_w2_w1_wh__ws + monitor->c.r1_w2_w2_wh__ws + monitor->c.r1_w2_Fx
            + monitor->c.r1_w2_w1_Fx + monitor->c.r1_w2_me__we + monitor->c.r1_w2_w1_me__we
            + monitor->c.r1_w2_w2_me__we + monitor->c.bend2 + monitor->c.r1_w3_me__we
            + monitor->c.r1_w3_w1_me__we + monitor->c.r1_w4_wh__ws + monitor->c.r1_w4_w1_wh__ws
            + monitor->c.r1_w5_me__we + monitor->c.r1_w5_w1_me__we + monitor->c.r1_w5_tanh
            + monitor->c.r1_w5_wh__ws + monitor->c.r1_w5_w1_wh__ws + monitor->c.r1_w5_Fx
            + monitor->c.r1_w6_me__we + monitor->c.r1_w7_wh__ws + monitor->c.r1_w8_tanh
            + monitor->c.r1_w8_w1_tanh + monitor->c.r1_w8_wh__ws + monitor->c.r1_w8_w1_wh__ws
            + monitor->c.r1_w8_w2_wh__ws + monitor->c.r1_w8_Fx + monitor->c.r1_w8_w1_Fx
            + monitor->c.r1_w8_me__we + monitor->c.r1_w8_w1_me__we + monitor->c.r1_w8_w2_me__we
            + monitor->c.r1_w9_me__we + monitor->c.r1_w9_w1_me__we + monitor->c.r1_w10_wh__ws
            + monitor->c.r1_w10_w1_wh__ws);
}

/* Samples until `constants` time constants of the filter are over. */
static uint32_t samples(real constants, real sample_time, real bandwidth)
{
    const real wait = constants / (bandwidth * sample_time);
    const uint32_t whole = wait < REAL(4.0e9) ? (uint32_t)wait : UINT32_MAX - 1u;

    return (real)whole < wait ? whole + 1u : whole;
}

drive_as_drawn_threshold_status drive_as_drawn_threshold_configure(
    drive_as_drawn_threshold_monitor *monitor,
    const drive_as_drawn_threshold_parameters *parameters,
    drive_as_drawn_threshold_real sample_time,
    drive_as_drawn_threshold_real bandwidth,
    drive_as_drawn_threshold_real time_unit)
{
    int k;

    for (k = 0; k < DRIVE_AS_DRAWN_THRESHOLD_RESIDUALS; ++k) {
        monitor->settle[k] = UINT32_MAX;
    }
    drive_as_drawn_threshold_reset(monitor);
    if (!parameters_are_finite(parameters)) {
        return DRIVE_AS_DRAWN_THRESHOLD_BAD_PARAMETER;
    }
    if (!(sample_time >= REAL(0.000999999)) || !finite_number(sample_time)) {
        return DRIVE_AS_DRAWN_THRESHOLD_BAD_SAMPLE_TIME;
    }
    if (!(bandwidth * sample_time >= SLOWEST && bandwidth * sample_time <= REAL(3.0))) {
        return DRIVE_AS_DRAWN_THRESHOLD_BAD_BANDWIDTH;
    }
    if (!(time_unit > REAL(0.0)) || !finite_number(time_unit)) {
        return DRIVE_AS_DRAWN_THRESHOLD_BAD_TIME_UNIT;
    }
    compute_coefficients(monitor, parameters, sample_time, bandwidth);
    if (!coefficients_are_finite(monitor)) {
        return DRIVE_AS_DRAWN_THRESHOLD_BAD_COEFFICIENT;
    }
    monitor->settle[DRIVE_AS_DRAWN_THRESHOLD_R1] =
        samples(REAL(11.228872242412663), sample_time, bandwidth);
    monitor->settle[DRIVE_AS_DRAWN_THRESHOLD_R2] =
        samples(REAL(11.228872242412663), sample_time, bandwidth);
    return DRIVE_AS_DRAWN_THRESHOLD_OK;
}

void drive_as_drawn_threshold_exact(
    const drive_as_drawn_threshold_monitor *monitor,
    const drive_as_drawn_threshold_derivatives *derivatives,
    drive_as_drawn_threshold_real residuals[DRIVE_AS_DRAWN_THRESHOLD_RESIDUALS])
{
    real *r = residuals;

    (void)monitor;
    (void)derivatives;

    /* khepera.bg:17: r1: a threshold is made of filtered signals, only step has it */
    r[DRIVE_AS_DRAWN_THRESHOLD_R1] = (real)NAN;

    /* khepera.bg:41: r2: a threshold is made of filtered signals, only step has it */
    r[DRIVE_AS_DRAWN_THRESHOLD_R2] = (real)NAN;
}

/* r1 on its first sample: the filter as if it had always been so. */
static void start_r1(
    drive_as_drawn_threshold_monitor *monitor, const drive_as_drawn_threshold_samples *s, real *r)
{
    const drive_as_drawn_threshold_coefficients *c = &monitor->c;
    drive_as_drawn_threshold_memory *x = &monitor->x;

    /* khepera.bg:17: integral of me.we/(4*tau0) - ge.N*wh.ws/(4*tau0), what is integrated */
    const real r1_w1_rate = c->g * s->me__we - c->g_2 * s->wh__ws;

    /* khepera.bg:17: integral of me.we/(4*tau0) - ge.N*wh.ws/(4*tau0), at the start */
    const real r1_w1_int = REAL(0.0);

    /* khepera.bg:17: integral of me.we/(4*tau0) - ge.N*wh.ws/(4*tau0): memory */
    x->r1_w1_q = c->half_time * r1_w1_rate;

    /* khepera.bg:17: integral of me.we/(4*tau0) - ge.N*wh.ws/(4*tau0) */
    const real r1_w1_integral = r1_w1_int;

    /* khepera.bg:17: integral of me.we/(4*tau0) - ge.N*wh.ws/(4*tau0): memory */
    x->r1_w1_rate2 = r1_w1_rate;
    x->r1_w1_rate1 = r1_w1_rate;

    /* khepera.bg:17: tanh(Int(me.we)/(4*tau0) - ge.N*Int(wh.ws)/(4*tau0)) */
    const real r1_w1_tanh = MATH(tanh)(r1_w1_integral);

    /* khepera.bg:17: r1_w1: terms of order 0 */
    const real r1_w1_g0 = c->r1_w1_tanh * r1_w1_tanh - c->r1_w1_me__we * s->me__we
        - c->r1_w1_wh__ws * s->wh__ws - c->r1_w1_Fx * s->Fx;

    /* khepera.bg:17: r1_w1: degree 1 */
    const real r1_w1_d1 = -c->r1_w1_w1_me__we * s->me__we - c->r1_w1_w1_wh__ws * s->wh__ws;

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

    /* khepera.bg:17: r1: what the tolerance of el.Re can do */
    const real r1_w1 = r1_w1_y1;

    /* khepera.bg:17: integral of me.we/(4*tau0) - ge.N*wh.ws/(4*tau0), what is integrated */
    const real r1_w2_rate = c->g * s->me__we - c->g_2 * s->wh__ws;

    /* khepera.bg:17: integral of me.we/(4*tau0) - ge.N*wh.ws/(4*tau0), at the start */
    const real r1_w2_int = REAL(0.0);

    /* khepera.bg:17: integral of me.we/(4*tau0) - ge.N*wh.ws/(4*tau0): memory */
    x->r1_w2_q = c->half_time * r1_w2_rate;

    /* khepera.bg:17: integral of me.we/(4*tau0) - ge.N*wh.ws/(4*tau0) */
    const real r1_w2_integral = r1_w2_int;

    /* khepera.bg:17: integral of me.we/(4*tau0) - ge.N*wh.ws/(4*tau0): memory */
    x->r1_w2_rate2 = r1_w2_rate;
    x->r1_w2_rate1 = r1_w2_rate;

    /* khepera.bg:17: tanh(Int(me.we)/(4*tau0) - ge.N*Int(wh.ws)/(4*tau0)) */
    const real r1_w2_tanh = MATH(tanh)(r1_w2_integral);

    /* khepera.bg:17: r1_w2: terms of order 0 */
    const real r1_w2_g0 = c->r1_w2_wh__ws * s->wh__ws + c->r1_w2_Fx * s->Fx
        + c->r1_w2_me__we * s->me__we - c->r1_w2_tanh * r1_w2_tanh;

    /* khepera.bg:17: r1_w2: terms of order 1 */
    const real r1_w2_g1 = c->r1_w2_w1_wh__ws * s->wh__ws + c->r1_w2_w1_Fx * s->Fx
        + c->r1_w2_w1_me__we * s->me__we - c->r1_w2_w1_tanh * r1_w2_tanh;

    /* khepera.bg:17: r1_w2: error of order 0 */
    const real r1_w2_e0 = c->bend2 * r1_w2_g0;

    /* khepera.bg:17: r1_w2: degree 2 */
    const real r1_w2_d2 = c->r1_w2_w2_wh__ws * s->wh__ws + c->r1_w2_w2_me__we * s->me__we
        - r1_w2_e0;

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

    /* khepera.bg:17: r1: what the tolerance of el.k can do */
    const real r1_w2 = r1_w2_y1 - r1_w2_e1;

    /* khepera.bg:17: r1_w3: terms of order 0 */
    const real r1_w3_g0 = -c->r1_w3_me__we * s->me__we;

    /* khepera.bg:17: r1_w3: degree 1 */
    const real r1_w3_d1 = c->r1_w3_w1_me__we * s->me__we;

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

    /* khepera.bg:17: r1: what the tolerance of me.fe can do */
    const real r1_w3 = r1_w3_y1;

    /* khepera.bg:17: r1_w4: terms of order 0 */
    const real r1_w4_g0 = -c->r1_w4_wh__ws * s->wh__ws;

    /* khepera.bg:17: r1_w4: degree 1 */
    const real r1_w4_d1 = c->r1_w4_w1_wh__ws * s->wh__ws;

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

    /* khepera.bg:17: r1: what the tolerance of wh.fs can do */
    const real r1_w4 = r1_w4_y1;

    /* khepera.bg:17: integral of me.we/(4*tau0) - ge.N*wh.ws/(4*tau0), what is integrated */
    const real r1_w5_rate = c->g * s->me__we - c->g_2 * s->wh__ws;

    /* khepera.bg:17: integral of me.we/(4*tau0) - ge.N*wh.ws/(4*tau0), at the start */
    const real r1_w5_int = REAL(0.0);

    /* khepera.bg:17: integral of me.we/(4*tau0) - ge.N*wh.ws/(4*tau0): memory */
    x->r1_w5_q = c->half_time * r1_w5_rate;

    /* khepera.bg:17: integral of me.we/(4*tau0) - ge.N*wh.ws/(4*tau0) */
    const real r1_w5_integral = r1_w5_int;

    /* khepera.bg:17: integral of me.we/(4*tau0) - ge.N*wh.ws/(4*tau0): memory */
    x->r1_w5_rate2 = r1_w5_rate;
    x->r1_w5_rate1 = r1_w5_rate;

    /* khepera.bg:17: tanh(Int(me.we)/(4*tau0) - ge.N*Int(wh.ws)/(4*tau0)) */
    const real r1_w5_tanh = MATH(tanh)(r1_w5_integral);

    /* khepera.bg:17: r1_w5: terms of order 0 */
    const real r1_w5_g0 = c->r1_w5_me__we * s->me__we + c->r1_w5_wh__ws * s->wh__ws
        + c->r1_w5_Fx * s->Fx - c->r1_w5_tanh * r1_w5_tanh;

    /* khepera.bg:17: r1_w5: degree 1 */
    const real r1_w5_d1 = c->r1_w5_w1_me__we * s->me__we + c->r1_w5_w1_wh__ws * s->wh__ws;

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

    /* khepera.bg:17: r1: what the tolerances of el.Re and el.k can do together */
    const real r1_w5 = r1_w5_y1;

    /* khepera.bg:17: r1_w6: input of stage 3 */
    const real r1_w6_u3 = -c->r1_w6_me__we * s->me__we;

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

    /* khepera.bg:17: r1: what the tolerances of el.Re and me.fe can do together */
    const real r1_w6 = r1_w6_y1;

    /* khepera.bg:17: r1_w7: input of stage 3 */
    const real r1_w7_u3 = -c->r1_w7_wh__ws * s->wh__ws;

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

    /* khepera.bg:17: r1: what the tolerances of el.Re and wh.fs can do together */
    const real r1_w7 = r1_w7_y1;

    /* khepera.bg:17: integral of me.we/(4*tau0) - ge.N*wh.ws/(4*tau0), what is integrated */
    const real r1_w8_rate = c->g * s->me__we - c->g_2 * s->wh__ws;

    /* khepera.bg:17: integral of me.we/(4*tau0) - ge.N*wh.ws/(4*tau0), at the start */
    const real r1_w8_int = REAL(0.0);

    /* khepera.bg:17: integral of me.we/(4*tau0) - ge.N*wh.ws/(4*tau0): memory */
    x->r1_w8_q = c->half_time * r1_w8_rate;

    /* khepera.bg:17: integral of me.we/(4*tau0) - ge.N*wh.ws/(4*tau0) */
    const real r1_w8_integral = r1_w8_int;

    /* khepera.bg:17: integral of me.we/(4*tau0) - ge.N*wh.ws/(4*tau0): memory */
    x->r1_w8_rate2 = r1_w8_rate;
    x->r1_w8_rate1 = r1_w8_rate;

    /* khepera.bg:17: tanh(Int(me.we)/(4*tau0) - ge.N*Int(wh.ws)/(4*tau0)) */
    const real r1_w8_tanh = MATH(tanh)(r1_w8_integral);

    /* khepera.bg:17: r1_w8: terms of order 0 */
    const real r1_w8_g0 = c->r1_w8_tanh * r1_w8_tanh - c->r1_w8_wh__ws * s->wh__ws
        - c->r1_w8_Fx * s->Fx - c->r1_w8_me__we * s->me__we;

    /* khepera.bg:17: r1_w8: terms of order 1 */
    const real r1_w8_g1 = c->r1_w8_w1_tanh * r1_w8_tanh + c->r1_w8_w1_wh__ws * s->wh__ws
        + c->r1_w8_w1_me__we * s->me__we - c->r1_w8_w1_Fx * s->Fx;

    /* khepera.bg:17: r1_w8: error of order 0 */
    const real r1_w8_e0 = c->bend2 * r1_w8_g0;

    /* khepera.bg:17: r1_w8: degree 2 */
    const real r1_w8_d2 = -c->r1_w8_w2_wh__ws * s->wh__ws - c->r1_w8_w2_me__we * s->me__we
        - r1_w8_e0;

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

    /* khepera.bg:17: r1: second order of what the tolerance of el.k can do */
    const real r1_w8 = r1_w8_y1 - r1_w8_e1;

    /* khepera.bg:17: r1_w9: terms of order 0 */
    const real r1_w9_g0 = c->r1_w9_me__we * s->me__we;

    /* khepera.bg:17: r1_w9: degree 1 */
    const real r1_w9_d1 = c->r1_w9_w1_me__we * s->me__we;

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

    /* khepera.bg:17: r1: what the tolerances of el.k and me.fe can do together */
    const real r1_w9 = r1_w9_y1;

    /* khepera.bg:17: r1_w10: terms of order 0 */
    const real r1_w10_g0 = c->r1_w10_wh__ws * s->wh__ws;

    /* khepera.bg:17: r1_w10: degree 1 */
    const real r1_w10_d1 = c->r1_w10_w1_wh__ws * s->wh__ws;

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

    /* khepera.bg:17: r1: what the tolerances of el.k and wh.fs can do together */
    const real r1_w10 = r1_w10_y1;

    /* khepera.bg:17: r1: how far r1 can be from zero if no parameter is out of tolerance */
    r[DRIVE_AS_DRAWN_THRESHOLD_R1] = MATH(fabs)(r1_w1) + MATH(fabs)(r1_w2) + MATH(fabs)(r1_w3)
        + MATH(fabs)(r1_w4) + MATH(fabs)(r1_w5) + MATH(fabs)(r1_w6) + MATH(fabs)(r1_w7)
        + MATH(fabs)(r1_w8) + MATH(fabs)(r1_w9) + MATH(fabs)(r1_w10);
}

/* r1 on every further sample. */
static void next_r1(
    drive_as_drawn_threshold_monitor *monitor, const drive_as_drawn_threshold_samples *s, real *r)
{
    const drive_as_drawn_threshold_coefficients *c = &monitor->c;
    drive_as_drawn_threshold_memory *x = &monitor->x;

    /* khepera.bg:17: integral of me.we/(4*tau0) - ge.N*wh.ws/(4*tau0), what is integrated */
    const real r1_w1_rate = c->g * s->me__we - c->g_2 * s->wh__ws;

    /* khepera.bg:17: integral of me.we/(4*tau0) - ge.N*wh.ws/(4*tau0) */
    const real r1_w1_int = x->r1_w1_q + c->half_time * r1_w1_rate;

    /* khepera.bg:17: integral of me.we/(4*tau0) - ge.N*wh.ws/(4*tau0): memory */
    x->r1_w1_q = r1_w1_int + c->half_time * r1_w1_rate;

    /* khepera.bg:17: integral of me.we/(4*tau0) - ge.N*wh.ws/(4*tau0) */
    const real r1_w1_integral = r1_w1_int
        - c->half_twelfth * (REAL(3.0) * r1_w1_rate - REAL(4.0) * x->r1_w1_rate1 + x->r1_w1_rate2);

    /* khepera.bg:17: integral of me.we/(4*tau0) - ge.N*wh.ws/(4*tau0): memory */
    x->r1_w1_rate2 = x->r1_w1_rate1;
    x->r1_w1_rate1 = r1_w1_rate;

    /* khepera.bg:17: tanh(Int(me.we)/(4*tau0) - ge.N*Int(wh.ws)/(4*tau0)) */
    const real r1_w1_tanh = MATH(tanh)(r1_w1_integral);

    /* khepera.bg:17: r1_w1: terms of order 0 */
    const real r1_w1_g0 = c->r1_w1_tanh * r1_w1_tanh - c->r1_w1_me__we * s->me__we
        - c->r1_w1_wh__ws * s->wh__ws - c->r1_w1_Fx * s->Fx;

    /* khepera.bg:17: r1_w1: degree 1 */
    const real r1_w1_d1 = -c->r1_w1_w1_me__we * s->me__we - c->r1_w1_w1_wh__ws * s->wh__ws;

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

    /* khepera.bg:17: r1: what the tolerance of el.Re can do */
    const real r1_w1 = r1_w1_y1;

    /* khepera.bg:17: integral of me.we/(4*tau0) - ge.N*wh.ws/(4*tau0), what is integrated */
    const real r1_w2_rate = c->g * s->me__we - c->g_2 * s->wh__ws;

    /* khepera.bg:17: integral of me.we/(4*tau0) - ge.N*wh.ws/(4*tau0) */
    const real r1_w2_int = x->r1_w2_q + c->half_time * r1_w2_rate;

    /* khepera.bg:17: integral of me.we/(4*tau0) - ge.N*wh.ws/(4*tau0): memory */
    x->r1_w2_q = r1_w2_int + c->half_time * r1_w2_rate;

    /* khepera.bg:17: integral of me.we/(4*tau0) - ge.N*wh.ws/(4*tau0) */
    const real r1_w2_integral = r1_w2_int
        - c->half_twelfth * (REAL(3.0) * r1_w2_rate - REAL(4.0) * x->r1_w2_rate1 + x->r1_w2_rate2);

    /* khepera.bg:17: integral of me.we/(4*tau0) - ge.N*wh.ws/(4*tau0): memory */
    x->r1_w2_rate2 = x->r1_w2_rate1;
    x->r1_w2_rate1 = r1_w2_rate;

    /* khepera.bg:17: tanh(Int(me.we)/(4*tau0) - ge.N*Int(wh.ws)/(4*tau0)) */
    const real r1_w2_tanh = MATH(tanh)(r1_w2_integral);

    /* khepera.bg:17: r1_w2: terms of order 0 */
    const real r1_w2_g0 = c->r1_w2_wh__ws * s->wh__ws + c->r1_w2_Fx * s->Fx
        + c->r1_w2_me__we * s->me__we - c->r1_w2_tanh * r1_w2_tanh;

    /* khepera.bg:17: r1_w2: terms of order 1 */
    const real r1_w2_g1 = c->r1_w2_w1_wh__ws * s->wh__ws + c->r1_w2_w1_Fx * s->Fx
        + c->r1_w2_w1_me__we * s->me__we - c->r1_w2_w1_tanh * r1_w2_tanh;

    /* khepera.bg:17: r1_w2: error of order 0 */
    const real r1_w2_e0 = c->bend2 * r1_w2_g0;

    /* khepera.bg:17: r1_w2: degree 2 */
    const real r1_w2_d2 = c->r1_w2_w2_wh__ws * s->wh__ws + c->r1_w2_w2_me__we * s->me__we
        - r1_w2_e0;

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

    /* khepera.bg:17: r1: what the tolerance of el.k can do */
    const real r1_w2 = r1_w2_y1 - r1_w2_e1;

    /* khepera.bg:17: r1_w3: terms of order 0 */
    const real r1_w3_g0 = -c->r1_w3_me__we * s->me__we;

    /* khepera.bg:17: r1_w3: degree 1 */
    const real r1_w3_d1 = c->r1_w3_w1_me__we * s->me__we;

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

    /* khepera.bg:17: r1: what the tolerance of me.fe can do */
    const real r1_w3 = r1_w3_y1;

    /* khepera.bg:17: r1_w4: terms of order 0 */
    const real r1_w4_g0 = -c->r1_w4_wh__ws * s->wh__ws;

    /* khepera.bg:17: r1_w4: degree 1 */
    const real r1_w4_d1 = c->r1_w4_w1_wh__ws * s->wh__ws;

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

    /* khepera.bg:17: r1: what the tolerance of wh.fs can do */
    const real r1_w4 = r1_w4_y1;

    /* khepera.bg:17: integral of me.we/(4*tau0) - ge.N*wh.ws/(4*tau0), what is integrated */
    const real r1_w5_rate = c->g * s->me__we - c->g_2 * s->wh__ws;

    /* khepera.bg:17: integral of me.we/(4*tau0) - ge.N*wh.ws/(4*tau0) */
    const real r1_w5_int = x->r1_w5_q + c->half_time * r1_w5_rate;

    /* khepera.bg:17: integral of me.we/(4*tau0) - ge.N*wh.ws/(4*tau0): memory */
    x->r1_w5_q = r1_w5_int + c->half_time * r1_w5_rate;

    /* khepera.bg:17: integral of me.we/(4*tau0) - ge.N*wh.ws/(4*tau0) */
    const real r1_w5_integral = r1_w5_int
        - c->half_twelfth * (REAL(3.0) * r1_w5_rate - REAL(4.0) * x->r1_w5_rate1 + x->r1_w5_rate2);

    /* khepera.bg:17: integral of me.we/(4*tau0) - ge.N*wh.ws/(4*tau0): memory */
    x->r1_w5_rate2 = x->r1_w5_rate1;
    x->r1_w5_rate1 = r1_w5_rate;

    /* khepera.bg:17: tanh(Int(me.we)/(4*tau0) - ge.N*Int(wh.ws)/(4*tau0)) */
    const real r1_w5_tanh = MATH(tanh)(r1_w5_integral);

    /* khepera.bg:17: r1_w5: terms of order 0 */
    const real r1_w5_g0 = c->r1_w5_me__we * s->me__we + c->r1_w5_wh__ws * s->wh__ws
        + c->r1_w5_Fx * s->Fx - c->r1_w5_tanh * r1_w5_tanh;

    /* khepera.bg:17: r1_w5: degree 1 */
    const real r1_w5_d1 = c->r1_w5_w1_me__we * s->me__we + c->r1_w5_w1_wh__ws * s->wh__ws;

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

    /* khepera.bg:17: r1: what the tolerances of el.Re and el.k can do together */
    const real r1_w5 = r1_w5_y1;

    /* khepera.bg:17: r1_w6: input of stage 3 */
    const real r1_w6_u3 = -c->r1_w6_me__we * s->me__we;

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

    /* khepera.bg:17: r1: what the tolerances of el.Re and me.fe can do together */
    const real r1_w6 = r1_w6_y1;

    /* khepera.bg:17: r1_w7: input of stage 3 */
    const real r1_w7_u3 = -c->r1_w7_wh__ws * s->wh__ws;

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

    /* khepera.bg:17: r1: what the tolerances of el.Re and wh.fs can do together */
    const real r1_w7 = r1_w7_y1;

    /* khepera.bg:17: integral of me.we/(4*tau0) - ge.N*wh.ws/(4*tau0), what is integrated */
    const real r1_w8_rate = c->g * s->me__we - c->g_2 * s->wh__ws;

    /* khepera.bg:17: integral of me.we/(4*tau0) - ge.N*wh.ws/(4*tau0) */
    const real r1_w8_int = x->r1_w8_q + c->half_time * r1_w8_rate;

    /* khepera.bg:17: integral of me.we/(4*tau0) - ge.N*wh.ws/(4*tau0): memory */
    x->r1_w8_q = r1_w8_int + c->half_time * r1_w8_rate;

    /* khepera.bg:17: integral of me.we/(4*tau0) - ge.N*wh.ws/(4*tau0) */
    const real r1_w8_integral = r1_w8_int
        - c->half_twelfth * (REAL(3.0) * r1_w8_rate - REAL(4.0) * x->r1_w8_rate1 + x->r1_w8_rate2);

    /* khepera.bg:17: integral of me.we/(4*tau0) - ge.N*wh.ws/(4*tau0): memory */
    x->r1_w8_rate2 = x->r1_w8_rate1;
    x->r1_w8_rate1 = r1_w8_rate;

    /* khepera.bg:17: tanh(Int(me.we)/(4*tau0) - ge.N*Int(wh.ws)/(4*tau0)) */
    const real r1_w8_tanh = MATH(tanh)(r1_w8_integral);

    /* khepera.bg:17: r1_w8: terms of order 0 */
    const real r1_w8_g0 = c->r1_w8_tanh * r1_w8_tanh - c->r1_w8_wh__ws * s->wh__ws
        - c->r1_w8_Fx * s->Fx - c->r1_w8_me__we * s->me__we;

    /* khepera.bg:17: r1_w8: terms of order 1 */
    const real r1_w8_g1 = c->r1_w8_w1_tanh * r1_w8_tanh + c->r1_w8_w1_wh__ws * s->wh__ws
        + c->r1_w8_w1_me__we * s->me__we - c->r1_w8_w1_Fx * s->Fx;

    /* khepera.bg:17: r1_w8: error of order 0 */
    const real r1_w8_e0 = c->bend2 * r1_w8_g0;

    /* khepera.bg:17: r1_w8: degree 2 */
    const real r1_w8_d2 = -c->r1_w8_w2_wh__ws * s->wh__ws - c->r1_w8_w2_me__we * s->me__we
        - r1_w8_e0;

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

    /* khepera.bg:17: r1: second order of what the tolerance of el.k can do */
    const real r1_w8 = r1_w8_y1 - r1_w8_e1;

    /* khepera.bg:17: r1_w9: terms of order 0 */
    const real r1_w9_g0 = c->r1_w9_me__we * s->me__we;

    /* khepera.bg:17: r1_w9: degree 1 */
    const real r1_w9_d1 = c->r1_w9_w1_me__we * s->me__we;

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

    /* khepera.bg:17: r1: what the tolerances of el.k and me.fe can do together */
    const real r1_w9 = r1_w9_y1;

    /* khepera.bg:17: r1_w10: terms of order 0 */
    const real r1_w10_g0 = c->r1_w10_wh__ws * s->wh__ws;

    /* khepera.bg:17: r1_w10: degree 1 */
    const real r1_w10_d1 = c->r1_w10_w1_wh__ws * s->wh__ws;

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

    /* khepera.bg:17: r1: what the tolerances of el.k and wh.fs can do together */
    const real r1_w10 = r1_w10_y1;

    /* khepera.bg:17: r1: how far r1 can be from zero if no parameter is out of tolerance */
    r[DRIVE_AS_DRAWN_THRESHOLD_R1] = MATH(fabs)(r1_w1) + MATH(fabs)(r1_w2) + MATH(fabs)(r1_w3)
        + MATH(fabs)(r1_w4) + MATH(fabs)(r1_w5) + MATH(fabs)(r1_w6) + MATH(fabs)(r1_w7)
        + MATH(fabs)(r1_w8) + MATH(fabs)(r1_w9) + MATH(fabs)(r1_w10);
}

/* One sample for r1; a number that is not finite makes the next sample the first. */
static void run_r1(
    drive_as_drawn_threshold_monitor *monitor, const drive_as_drawn_threshold_samples *s, drive_as_drawn_threshold_residuals *residuals)
{
    real *r = residuals->value;
    uint32_t age = monitor->age[0];

    if (age == 0u) {
        start_r1(monitor, s, r);
    } else {
        next_r1(monitor, s, r);
    }
    /* a sum is finite only if all its terms are */
    if (finite_number(s->Fx + s->me__we + s->wh__ws + r[DRIVE_AS_DRAWN_THRESHOLD_R1])) {
        age += age < UINT32_MAX ? 1u : 0u;
    } else {
        age = 0u;
        r[DRIVE_AS_DRAWN_THRESHOLD_R1] = REAL(0.0);
    }
    monitor->age[0] = age;
    residuals->valid[DRIVE_AS_DRAWN_THRESHOLD_R1] = age > monitor->settle[DRIVE_AS_DRAWN_THRESHOLD_R1];
}

/* r2 on its first sample: the filter as if it had always been so. */
static void start_r2(
    drive_as_drawn_threshold_monitor *monitor, const drive_as_drawn_threshold_samples *s, real *r)
{
    (void)monitor;
    (void)s;

    /* khepera.bg:41: r2: how far r2 can be from zero if no parameter is out of tolerance */
    r[DRIVE_AS_DRAWN_THRESHOLD_R2] = REAL(0.0);
}

/* r2 on every further sample. */
static void next_r2(
    drive_as_drawn_threshold_monitor *monitor, const drive_as_drawn_threshold_samples *s, real *r)
{
    (void)monitor;
    (void)s;

    /* khepera.bg:41: r2: how far r2 can be from zero if no parameter is out of tolerance */
    r[DRIVE_AS_DRAWN_THRESHOLD_R2] = REAL(0.0);
}

/* One sample for r2; a number that is not finite makes the next sample the first. */
static void run_r2(
    drive_as_drawn_threshold_monitor *monitor, const drive_as_drawn_threshold_samples *s, drive_as_drawn_threshold_residuals *residuals)
{
    real *r = residuals->value;
    uint32_t age = monitor->age[1];

    if (age == 0u) {
        start_r2(monitor, s, r);
    } else {
        next_r2(monitor, s, r);
    }
    /* a sum is finite only if all its terms are */
    if (finite_number(r[DRIVE_AS_DRAWN_THRESHOLD_R2])) {
        age += age < UINT32_MAX ? 1u : 0u;
    } else {
        age = 0u;
        r[DRIVE_AS_DRAWN_THRESHOLD_R2] = REAL(0.0);
    }
    monitor->age[1] = age;
    residuals->valid[DRIVE_AS_DRAWN_THRESHOLD_R2] = age > monitor->settle[DRIVE_AS_DRAWN_THRESHOLD_R2];
}

void drive_as_drawn_threshold_reset(drive_as_drawn_threshold_monitor *monitor)
{
    int k;

    for (k = 0; k < 2; ++k) {
        monitor->age[k] = 0u;
    }
}

void drive_as_drawn_threshold_step(
    drive_as_drawn_threshold_monitor *monitor,
    const drive_as_drawn_threshold_samples *samples,
    drive_as_drawn_threshold_residuals *residuals)
{
    run_r1(monitor, samples, residuals);
    run_r2(monitor, samples, residuals);
}
