/* drive_as_drawn_residuals.c: the residuals of DriveAsDrawn; generated, see the header. */
#include "drive_as_drawn_residuals.h"

#include <math.h>

#if defined __FINITE_MATH_ONLY__ && __FINITE_MATH_ONLY__
#error "this code tells numbers from NaN: compile it without -ffinite-math-only (-ffast-math)"
#endif

typedef drive_as_drawn_real real;

#define REAL(x) DRIVE_AS_DRAWN_CONSTANT(x)
#if defined DRIVE_AS_DRAWN_FLOAT && !defined DRIVE_AS_DRAWN_REAL
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

uint32_t drive_as_drawn_abi(void)
{
    return DRIVE_AS_DRAWN_ABI;
}

const char *drive_as_drawn_digest(void)
{
    return DRIVE_AS_DRAWN_DIGEST;
}

void drive_as_drawn_nominal(drive_as_drawn_parameters *parameters)
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
static void compute_coefficients(drive_as_drawn_monitor *monitor,
        const drive_as_drawn_parameters *p, real sample_time, real bandwidth)
{
    drive_as_drawn_coefficients *c = &monitor->c;

    /* bandwidth*sample_time */
    const real x_ = bandwidth * sample_time;

    /* of a stage: what is left of its memory */
    const real pole = greatest(REAL(2.0) - x_, REAL(0.0)) / (x_ + REAL(2.0));

    /* w*sample_time, x or 2 */
    const real turn = REAL(2.0) * (REAL(1.0) - pole) / (pole + REAL(1.0));

    /* w of the filter 1/(1 + D/w) */
    const real w = turn / sample_time;

    /* khepera.bg:17: el.L*me.fe/el.k */
    const real t = p->el__L * p->me__fe / p->el__k;

    /* khepera.bg:17: el.L*wh.fs/(ge.N*el.k) */
    const real t_2 = p->el__L * p->wh__fs / p->ge__N / p->el__k;

    /* khepera.bg:17: el.Re*me.Je/el.k */
    const real t_3 = p->el__Re * p->me__Je / p->el__k;

    /* khepera.bg:17: el.Re*wh.Js/(ge.N*el.k) */
    const real t_4 = p->el__Re * p->wh__Js / p->ge__N / p->el__k;

    /* 1 - pole */
    const real t_5 = REAL(1.0) - pole;

    /* turn^2 */
    const real t_6 = turn * turn;

    /* khepera.bg:17: 1/(4*tau0) */
    c->g = REAL(0.25) / p->tau0;

    /* khepera.bg:17: ge.N/(4*tau0) */
    c->g_2 = REAL(0.25) * p->ge__N / p->tau0;

    /* khepera.bg:17: r1: factor of me.we: el.k + el.Re*me.fe/el.k */
    c->r1_me__we = p->el__k + p->el__Re * p->me__fe / p->el__k;

    /* khepera.bg:17: r1: factor of me.we': el.L*me.fe/el.k + el.Re*me.Je/el.k */
    c->r1_me__we_1 = t + t_3;

    /* khepera.bg:17: r1: factor of me.we'': el.L*me.Je/el.k */
    c->r1_me__we_2 = p->el__L * p->me__Je / p->el__k;

    /* khepera.bg:17: r1: factor of tanh(Int(me.we)/(4*tau0) - ge.N*Int(wh.ws)/(4*tau0)):
     * 2*tau0*A*me.K*el.Re/el.k */
    c->r1_tanh = REAL(2.0) * p->tau0 * p->A * p->me__K * p->el__Re / p->el__k;

    /* khepera.bg:17: r1: factor of D(tanh(Int(me.we)/(4*tau0) - ge.N*Int(wh.ws)/(4*tau0))):
     * 2*tau0*A*me.K*el.L/el.k */
    c->r1_tanh_1 = REAL(2.0) * p->tau0 * p->A * p->me__K * p->el__L / p->el__k;

    /* khepera.bg:17: r1: factor of wh.ws: el.Re*wh.fs/(ge.N*el.k) */
    c->r1_wh__ws = p->el__Re * p->wh__fs / p->ge__N / p->el__k;

    /* khepera.bg:17: r1: factor of wh.ws': el.L*wh.fs/(ge.N*el.k) + el.Re*wh.Js/(ge.N*el.k) */
    c->r1_wh__ws_1 = t_2 + t_4;

    /* khepera.bg:17: r1: factor of wh.ws'': el.L*wh.Js/(ge.N*el.k) */
    c->r1_wh__ws_2 = p->el__L * p->wh__Js / p->ge__N / p->el__k;

    /* khepera.bg:17: r1: factor of Fx: el.Re*wh.R/(ge.N*el.k) */
    c->r1_Fx = p->el__Re * p->wh__R / p->ge__N / p->el__k;

    /* khepera.bg:17: r1: factor of Fx': el.L*wh.R/(ge.N*el.k) */
    c->r1_Fx_1 = p->el__L * p->wh__R / p->ge__N / p->el__k;

    /* half the sample time */
    c->half_time = REAL(0.5) * sample_time;

    /* sample_time/24 */
    c->half_twelfth = sample_time / REAL(24.0);

    /* khepera.bg:17: r1: factor of me.we' */
    c->r1_w1_me__we = (-t - t_3) * w;

    /* khepera.bg:17: r1: factor of me.we'' */
    c->r1_w2_me__we = p->el__L * p->me__Je * w * w / p->el__k;

    /* khepera.bg:17: r1: factor of D(tanh(Int(me.we)/(4*tau0) - ge.N*Int(wh.ws)/(4*tau0))) */
    c->r1_w1_tanh = REAL(2.0) * p->tau0 * p->A * p->me__K * p->el__L * w / p->el__k;

    /* khepera.bg:17: r1: factor of wh.ws' */
    c->r1_w1_wh__ws = (-t_2 - t_4) * w;

    /* khepera.bg:17: r1: factor of wh.ws'' */
    c->r1_w2_wh__ws = p->el__L * p->wh__Js * w * w / p->ge__N / p->el__k;

    /* khepera.bg:17: r1: factor of Fx' */
    c->r1_w1_Fx = p->el__L * p->wh__R * w / p->ge__N / p->el__k;

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

    /* khepera.bg:41: r2: factor of wh.ws: ge.N */
    c->r2_wh__ws = p->ge__N;

    /* khepera.bg:41: r2: factor of wh.ws': wh.fs/(ge.N*me.K) */
    c->r2_wh__ws_1 = p->wh__fs / p->ge__N / p->me__K;

    /* khepera.bg:41: r2: factor of wh.ws'': wh.Js/(ge.N*me.K) */
    c->r2_wh__ws_2 = p->wh__Js / p->ge__N / p->me__K;

    /* khepera.bg:41: r2: factor of Fx': wh.R/(ge.N*me.K) */
    c->r2_Fx_1 = p->wh__R / p->ge__N / p->me__K;

    /* khepera.bg:41: r2: factor of D(tanh(Int(me.we)/(4*tau0) - ge.N*Int(wh.ws)/(4*tau0))):
     * tau0*A */
    c->r2_tanh_1 = p->tau0 * p->A;

    /* khepera.bg:41: r2: factor of wh.ws'' */
    c->r2_w2_wh__ws = p->wh__Js * w * w / p->ge__N / p->me__K;

    /* khepera.bg:41: r2: factor of Fx' */
    c->r2_w1_Fx = p->wh__R * w / p->ge__N / p->me__K;

    /* khepera.bg:41: r2: factor of D(tanh(Int(me.we)/(4*tau0) - ge.N*Int(wh.ws)/(4*tau0))) */
    c->r2_w1_tanh = p->tau0 * p->A * w;
}

static bool parameters_are_finite(const drive_as_drawn_parameters *p)
{
    return finite_number(p->tau0 + p->A + p->el__L + p->el__Re + p->el__k + p->me__Je + p->me__fe
            + p->me__K + p->ge__N + p->wh__Js + p->wh__fs + p->wh__R);
}

static bool coefficients_are_finite(const drive_as_drawn_monitor *monitor)
{
    return finite_number(monitor->c.g + monitor->c.g_2 + monitor->c.r1_me__we
            + monitor->c.r1_me__we_1 + monitor->c.r1_me__we_2 + monitor->c.r1_tanh
            + monitor->c.r1_tanh_1 + monitor->c.r1_wh__ws + monitor->c.r1_wh__ws_1
            + monitor->c.r1_wh__ws_2 + monitor->c.r1_Fx + monitor->c.r1_Fx_1 + monitor->c.half_time
            + monitor->c.half_twelfth + monitor->c.r1_w1_me__we + monitor->c.r1_w2_me__we
            + monitor->c.r1_w1_tanh + monitor->c.r1_w1_wh__ws + monitor->c.r1_w2_wh__ws
            + monitor->c.r1_w1_Fx + monitor->c.bend2 + monitor->c.bend1 + monitor->c.a
            + monitor->c.b + monitor->c.rest + monitor->c.r2_wh__ws + monitor->c.r2_wh__ws_1
            + monitor->c.r2_wh__ws_2 + monitor->c.r2_Fx_1 + monitor->c.r2_tanh_1
            + monitor->c.r2_w2_wh__ws + monitor->c.r2_w1_Fx + monitor->c.r2_w1_tanh);
}

/* Samples until `constants` time constants of the filter are over. */
static uint32_t samples(real constants, real sample_time, real bandwidth)
{
    const real wait = constants / (bandwidth * sample_time);
    const uint32_t whole = wait < REAL(4.0e9) ? (uint32_t)wait : UINT32_MAX - 1u;

    return (real)whole < wait ? whole + 1u : whole;
}

drive_as_drawn_status drive_as_drawn_configure(
    drive_as_drawn_monitor *monitor,
    const drive_as_drawn_parameters *parameters,
    drive_as_drawn_real sample_time,
    drive_as_drawn_real bandwidth,
    drive_as_drawn_real time_unit)
{
    int k;

    for (k = 0; k < DRIVE_AS_DRAWN_RESIDUALS; ++k) {
        monitor->settle[k] = UINT32_MAX;
    }
    drive_as_drawn_reset(monitor);
    if (!parameters_are_finite(parameters)) {
        return DRIVE_AS_DRAWN_BAD_PARAMETER;
    }
    if (!(sample_time >= REAL(0.000999999)) || !finite_number(sample_time)) {
        return DRIVE_AS_DRAWN_BAD_SAMPLE_TIME;
    }
    if (!(bandwidth * sample_time >= SLOWEST && bandwidth * sample_time <= REAL(3.0))) {
        return DRIVE_AS_DRAWN_BAD_BANDWIDTH;
    }
    if (!(time_unit > REAL(0.0)) || !finite_number(time_unit)) {
        return DRIVE_AS_DRAWN_BAD_TIME_UNIT;
    }
    compute_coefficients(monitor, parameters, sample_time, bandwidth);
    if (!coefficients_are_finite(monitor)) {
        return DRIVE_AS_DRAWN_BAD_COEFFICIENT;
    }
    monitor->settle[DRIVE_AS_DRAWN_R1] = samples(REAL(11.228872242412663), sample_time, bandwidth);
    monitor->settle[DRIVE_AS_DRAWN_R2] = samples(REAL(11.228872242412663), sample_time, bandwidth);
    return DRIVE_AS_DRAWN_OK;
}

void drive_as_drawn_exact(
    const drive_as_drawn_monitor *monitor,
    const drive_as_drawn_derivatives *derivatives,
    drive_as_drawn_real residuals[DRIVE_AS_DRAWN_RESIDUALS])
{
    const drive_as_drawn_coefficients *c = &monitor->c;
    const drive_as_drawn_derivatives *d = derivatives;
    real *r = residuals;

    /* khepera.bg:17: tanh(Int(me.we)/(4*tau0) - ge.N*Int(wh.ws)/(4*tau0)) */
    const real t = MATH(tanh)(c->g * d->me__we_integral - c->g_2 * d->wh__ws_integral);

    /* khepera.bg:17: r1 = U0 - el.k*me.we - el.Re*el.k.e2/el.k - el.L*D(el.k.e2)/el.k
     * where el.k.e2 = me.fe*me.we + me.Je*D(me.we) + (wh.fs*wh.ws + wh.R*Fx + wh.Js*D(wh.ws) -
     * tau0*A*ge.N*me.K*x1)/ge.N - tau0*A*me.K*x1
     * x1 = tanh((Int(me.we) - ge.N*Int(wh.ws))/(4*tau0)) */
    r[DRIVE_AS_DRAWN_R1] = d->U0 + c->r1_tanh * t
        + c->r1_tanh_1 * ((c->g * d->me__we[0] - c->g_2 * d->wh__ws[0]) * (REAL(1.0) - t * t))
        - c->r1_me__we * d->me__we[0] - c->r1_me__we_1 * d->me__we[1]
        - c->r1_me__we_2 * d->me__we[2] - c->r1_wh__ws * d->wh__ws[0]
        - c->r1_wh__ws_1 * d->wh__ws[1] - c->r1_wh__ws_2 * d->wh__ws[2] - c->r1_Fx * d->Fx[0]
        - c->r1_Fx_1 * d->Fx[1];

    /* khepera.bg:41: r2 = me.we - ge.N*wh.ws - D(wh.fs*wh.ws + wh.R*Fx + wh.Js*D(wh.ws) -
     * tau0*A*ge.N*me.K*tanh((Int(me.we) - ge.N*Int(wh.ws))/(4*tau0)))/(ge.N*me.K) */
    r[DRIVE_AS_DRAWN_R2] = d->me__we[0]
        + c->r2_tanh_1 * ((c->g * d->me__we[0] - c->g_2 * d->wh__ws[0]) * (REAL(1.0) - t * t))
        - c->r2_wh__ws * d->wh__ws[0] - c->r2_wh__ws_1 * d->wh__ws[1]
        - c->r2_wh__ws_2 * d->wh__ws[2] - c->r2_Fx_1 * d->Fx[1];
}

/* r1 on its first sample: the filter as if it had always been so. */
static void start_r1(
    drive_as_drawn_monitor *monitor, const drive_as_drawn_samples *s, real *r)
{
    const drive_as_drawn_coefficients *c = &monitor->c;
    drive_as_drawn_memory *x = &monitor->x;

    /* khepera.bg:17: integral of me.we/(4*tau0) - ge.N*wh.ws/(4*tau0), what is integrated */
    const real r1_rate = c->g * s->me__we - c->g_2 * s->wh__ws;

    /* khepera.bg:17: integral of me.we/(4*tau0) - ge.N*wh.ws/(4*tau0), at the start */
    const real r1_int = REAL(0.0);

    /* khepera.bg:17: integral of me.we/(4*tau0) - ge.N*wh.ws/(4*tau0): memory */
    x->r1_q = c->half_time * r1_rate;

    /* khepera.bg:17: integral of me.we/(4*tau0) - ge.N*wh.ws/(4*tau0) */
    const real r1_integral = r1_int;

    /* khepera.bg:17: integral of me.we/(4*tau0) - ge.N*wh.ws/(4*tau0): memory */
    x->r1_rate2 = r1_rate;
    x->r1_rate1 = r1_rate;

    /* khepera.bg:17: tanh(Int(me.we)/(4*tau0) - ge.N*Int(wh.ws)/(4*tau0)) */
    const real r1_tanh = MATH(tanh)(r1_integral);

    /* khepera.bg:17: r1: terms of order 0 */
    const real r1_g0 = s->U0 + c->r1_tanh * r1_tanh - c->r1_me__we * s->me__we
        - c->r1_wh__ws * s->wh__ws - c->r1_Fx * s->Fx;

    /* khepera.bg:17: r1: terms of order 1 */
    const real r1_g1 = c->r1_w1_me__we * s->me__we + c->r1_w1_tanh * r1_tanh
        + c->r1_w1_wh__ws * s->wh__ws - c->r1_w1_Fx * s->Fx;

    /* khepera.bg:17: r1: error of order 0 */
    const real r1_e0 = c->bend2 * r1_g0;

    /* khepera.bg:17: r1: degree 2 */
    const real r1_d2 = -c->r1_w2_me__we * s->me__we - c->r1_w2_wh__ws * s->wh__ws - r1_e0;

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

    /* khepera.bg:17: r1 = U0 - el.k*me.we - el.Re*el.k.e2/el.k - el.L*D(el.k.e2)/el.k
     * where el.k.e2 = me.fe*me.we + me.Je*D(me.we) + (wh.fs*wh.ws + wh.R*Fx + wh.Js*D(wh.ws) -
     * tau0*A*ge.N*me.K*x1)/ge.N - tau0*A*me.K*x1
     * x1 = tanh((Int(me.we) - ge.N*Int(wh.ws))/(4*tau0)) */
    r[DRIVE_AS_DRAWN_R1] = r1_y1 - r1_e1;
}

/* r1 on every further sample. */
static void next_r1(
    drive_as_drawn_monitor *monitor, const drive_as_drawn_samples *s, real *r)
{
    const drive_as_drawn_coefficients *c = &monitor->c;
    drive_as_drawn_memory *x = &monitor->x;

    /* khepera.bg:17: integral of me.we/(4*tau0) - ge.N*wh.ws/(4*tau0), what is integrated */
    const real r1_rate = c->g * s->me__we - c->g_2 * s->wh__ws;

    /* khepera.bg:17: integral of me.we/(4*tau0) - ge.N*wh.ws/(4*tau0) */
    const real r1_int = x->r1_q + c->half_time * r1_rate;

    /* khepera.bg:17: integral of me.we/(4*tau0) - ge.N*wh.ws/(4*tau0): memory */
    x->r1_q = r1_int + c->half_time * r1_rate;

    /* khepera.bg:17: integral of me.we/(4*tau0) - ge.N*wh.ws/(4*tau0) */
    const real r1_integral = r1_int
        - c->half_twelfth * (REAL(3.0) * r1_rate - REAL(4.0) * x->r1_rate1 + x->r1_rate2);

    /* khepera.bg:17: integral of me.we/(4*tau0) - ge.N*wh.ws/(4*tau0): memory */
    x->r1_rate2 = x->r1_rate1;
    x->r1_rate1 = r1_rate;

    /* khepera.bg:17: tanh(Int(me.we)/(4*tau0) - ge.N*Int(wh.ws)/(4*tau0)) */
    const real r1_tanh = MATH(tanh)(r1_integral);

    /* khepera.bg:17: r1: terms of order 0 */
    const real r1_g0 = s->U0 + c->r1_tanh * r1_tanh - c->r1_me__we * s->me__we
        - c->r1_wh__ws * s->wh__ws - c->r1_Fx * s->Fx;

    /* khepera.bg:17: r1: terms of order 1 */
    const real r1_g1 = c->r1_w1_me__we * s->me__we + c->r1_w1_tanh * r1_tanh
        + c->r1_w1_wh__ws * s->wh__ws - c->r1_w1_Fx * s->Fx;

    /* khepera.bg:17: r1: error of order 0 */
    const real r1_e0 = c->bend2 * r1_g0;

    /* khepera.bg:17: r1: degree 2 */
    const real r1_d2 = -c->r1_w2_me__we * s->me__we - c->r1_w2_wh__ws * s->wh__ws - r1_e0;

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

    /* khepera.bg:17: r1 = U0 - el.k*me.we - el.Re*el.k.e2/el.k - el.L*D(el.k.e2)/el.k
     * where el.k.e2 = me.fe*me.we + me.Je*D(me.we) + (wh.fs*wh.ws + wh.R*Fx + wh.Js*D(wh.ws) -
     * tau0*A*ge.N*me.K*x1)/ge.N - tau0*A*me.K*x1
     * x1 = tanh((Int(me.we) - ge.N*Int(wh.ws))/(4*tau0)) */
    r[DRIVE_AS_DRAWN_R1] = r1_y1 - r1_e1;
}

/* One sample for r1; a number that is not finite makes the next sample the first. */
static void run_r1(
    drive_as_drawn_monitor *monitor, const drive_as_drawn_samples *s, drive_as_drawn_residuals *residuals)
{
    real *r = residuals->value;
    uint32_t age = monitor->age[0];

    if (age == 0u) {
        start_r1(monitor, s, r);
    } else {
        next_r1(monitor, s, r);
    }
    /* a sum is finite only if all its terms are */
    if (finite_number(s->U0 + s->Fx + s->me__we + s->wh__ws + r[DRIVE_AS_DRAWN_R1])) {
        age += age < UINT32_MAX ? 1u : 0u;
    } else {
        age = 0u;
        r[DRIVE_AS_DRAWN_R1] = REAL(0.0);
    }
    monitor->age[0] = age;
    residuals->valid[DRIVE_AS_DRAWN_R1] = age > monitor->settle[DRIVE_AS_DRAWN_R1];
}

/* r2 on its first sample: the filter as if it had always been so. */
static void start_r2(
    drive_as_drawn_monitor *monitor, const drive_as_drawn_samples *s, real *r)
{
    const drive_as_drawn_coefficients *c = &monitor->c;
    drive_as_drawn_memory *x = &monitor->x;

    /* khepera.bg:41: integral of me.we/(4*tau0) - ge.N*wh.ws/(4*tau0), what is integrated */
    const real r2_rate = c->g * s->me__we - c->g_2 * s->wh__ws;

    /* khepera.bg:41: integral of me.we/(4*tau0) - ge.N*wh.ws/(4*tau0), at the start */
    const real r2_int = REAL(0.0);

    /* khepera.bg:41: integral of me.we/(4*tau0) - ge.N*wh.ws/(4*tau0): memory */
    x->r2_q = c->half_time * r2_rate;

    /* khepera.bg:41: integral of me.we/(4*tau0) - ge.N*wh.ws/(4*tau0) */
    const real r2_integral = r2_int;

    /* khepera.bg:41: integral of me.we/(4*tau0) - ge.N*wh.ws/(4*tau0): memory */
    x->r2_rate2 = r2_rate;
    x->r2_rate1 = r2_rate;

    /* khepera.bg:41: tanh(Int(me.we)/(4*tau0) - ge.N*Int(wh.ws)/(4*tau0)) */
    const real r2_tanh = MATH(tanh)(r2_integral);

    /* khepera.bg:41: r2: terms of order 0 */
    const real r2_g0 = s->me__we - c->r2_wh__ws * s->wh__ws;

    /* khepera.bg:41: r2: terms of order 1 */
    const real r2_g1 = c->r2_w1_tanh * r2_tanh - c->r2_w1_Fx * s->Fx;

    /* khepera.bg:41: r2: error of order 0 */
    const real r2_e0 = c->bend2 * r2_g0;

    /* khepera.bg:41: r2: degree 2 */
    const real r2_d2 = -c->r2_w2_wh__ws * s->wh__ws - r2_e0;

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

    /* khepera.bg:41: r2 = me.we - ge.N*wh.ws - D(wh.fs*wh.ws + wh.R*Fx + wh.Js*D(wh.ws) -
     * tau0*A*ge.N*me.K*tanh((Int(me.we) - ge.N*Int(wh.ws))/(4*tau0)))/(ge.N*me.K) */
    r[DRIVE_AS_DRAWN_R2] = r2_y1 - r2_e1;
}

/* r2 on every further sample. */
static void next_r2(
    drive_as_drawn_monitor *monitor, const drive_as_drawn_samples *s, real *r)
{
    const drive_as_drawn_coefficients *c = &monitor->c;
    drive_as_drawn_memory *x = &monitor->x;

    /* khepera.bg:41: integral of me.we/(4*tau0) - ge.N*wh.ws/(4*tau0), what is integrated */
    const real r2_rate = c->g * s->me__we - c->g_2 * s->wh__ws;

    /* khepera.bg:41: integral of me.we/(4*tau0) - ge.N*wh.ws/(4*tau0) */
    const real r2_int = x->r2_q + c->half_time * r2_rate;

    /* khepera.bg:41: integral of me.we/(4*tau0) - ge.N*wh.ws/(4*tau0): memory */
    x->r2_q = r2_int + c->half_time * r2_rate;

    /* khepera.bg:41: integral of me.we/(4*tau0) - ge.N*wh.ws/(4*tau0) */
    const real r2_integral = r2_int
        - c->half_twelfth * (REAL(3.0) * r2_rate - REAL(4.0) * x->r2_rate1 + x->r2_rate2);

    /* khepera.bg:41: integral of me.we/(4*tau0) - ge.N*wh.ws/(4*tau0): memory */
    x->r2_rate2 = x->r2_rate1;
    x->r2_rate1 = r2_rate;

    /* khepera.bg:41: tanh(Int(me.we)/(4*tau0) - ge.N*Int(wh.ws)/(4*tau0)) */
    const real r2_tanh = MATH(tanh)(r2_integral);

    /* khepera.bg:41: r2: terms of order 0 */
    const real r2_g0 = s->me__we - c->r2_wh__ws * s->wh__ws;

    /* khepera.bg:41: r2: terms of order 1 */
    const real r2_g1 = c->r2_w1_tanh * r2_tanh - c->r2_w1_Fx * s->Fx;

    /* khepera.bg:41: r2: error of order 0 */
    const real r2_e0 = c->bend2 * r2_g0;

    /* khepera.bg:41: r2: degree 2 */
    const real r2_d2 = -c->r2_w2_wh__ws * s->wh__ws - r2_e0;

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

    /* khepera.bg:41: r2 = me.we - ge.N*wh.ws - D(wh.fs*wh.ws + wh.R*Fx + wh.Js*D(wh.ws) -
     * tau0*A*ge.N*me.K*tanh((Int(me.we) - ge.N*Int(wh.ws))/(4*tau0)))/(ge.N*me.K) */
    r[DRIVE_AS_DRAWN_R2] = r2_y1 - r2_e1;
}

/* One sample for r2; a number that is not finite makes the next sample the first. */
static void run_r2(
    drive_as_drawn_monitor *monitor, const drive_as_drawn_samples *s, drive_as_drawn_residuals *residuals)
{
    real *r = residuals->value;
    uint32_t age = monitor->age[1];

    if (age == 0u) {
        start_r2(monitor, s, r);
    } else {
        next_r2(monitor, s, r);
    }
    /* a sum is finite only if all its terms are */
    if (finite_number(s->Fx + s->me__we + s->wh__ws + r[DRIVE_AS_DRAWN_R2])) {
        age += age < UINT32_MAX ? 1u : 0u;
    } else {
        age = 0u;
        r[DRIVE_AS_DRAWN_R2] = REAL(0.0);
    }
    monitor->age[1] = age;
    residuals->valid[DRIVE_AS_DRAWN_R2] = age > monitor->settle[DRIVE_AS_DRAWN_R2];
}

void drive_as_drawn_reset(drive_as_drawn_monitor *monitor)
{
    int k;

    for (k = 0; k < 2; ++k) {
        monitor->age[k] = 0u;
    }
}

void drive_as_drawn_step(
    drive_as_drawn_monitor *monitor,
    const drive_as_drawn_samples *samples,
    drive_as_drawn_residuals *residuals)
{
    run_r1(monitor, samples, residuals);
    run_r2(monitor, samples, residuals);
}

const char drive_as_drawn_fault_name[DRIVE_AS_DRAWN_FAULTS][6] = {
    "tau0", "A", "me.K", "ge.N", "wh.Js", "wh.R", "Fx", "me.we", "wh.ws", "el.L", "el.Re", "el.k",
    "me.Je", "me.fe", "U0", "wh.fs",
};

const uint16_t drive_as_drawn_fault_class[DRIVE_AS_DRAWN_FAULTS] = {
    0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 1u, 1u, 1u, 1u, 1u, 1u, 2u,
};

const char drive_as_drawn_residual_name[DRIVE_AS_DRAWN_RESIDUALS][3] = {
    "r1", "r2",
};

/* Signatures: 1 where a residual may be moved by the faults of a class, 3 where it is for sure. */
static const uint8_t signature[DRIVE_AS_DRAWN_CLASSES][DRIVE_AS_DRAWN_RESIDUALS] = {
    {3u, 3u},
    {3u, 0u},
    {3u, 1u},
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
    drive_as_drawn_diagnosis *d, const drive_as_drawn_limit *limit, int k, real off, real out, real bound)
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

static bool sums_are_zero(const drive_as_drawn_diagnosis *d, int k)
{
    const real sum = d->above[k] + d->below[k] + d->louder[k];

    return !(sum > REAL(0.0));
}

static void forget_sums(drive_as_drawn_diagnosis *d, int k)
{
    d->above[k] = REAL(0.0);
    d->below[k] = REAL(0.0);
    d->louder[k] = REAL(0.0);
    d->streak[k] = 0u;
}

/* Residual k in one sample; whether it goes into alarm. */
static bool watch(
    drive_as_drawn_diagnosis *d, const drive_as_drawn_limit *limit, int k, real value, real bound, bool row)
{
    const real off = value - limit->mean;
    const real out = (off < REAL(0.0) ? -off : off) - bound;
    bool high = false;

    if (row) {
        high = add_row(d, limit, k, off, out, bound);
    }
    if (d->state[k] == DRIVE_AS_DRAWN_ALARM) {
        d->since[k] += d->since[k] < UINT32_MAX ? 1u : 0u;
        if (!(out < RELEASE * limit->level) || !sums_are_zero(d, k)) {
            d->quiet = 0u;
        }
        return false;
    }
    d->state[k] = DRIVE_AS_DRAWN_HEALTHY;
    d->streak[k] = out > limit->level ? d->streak[k] + 1u : 0u;
    if (d->streak[k] < d->least && !high) {
        return false;
    }
    d->state[k] = DRIVE_AS_DRAWN_ALARM;
    d->since[k] = 0u;
    return true;
}

/* What is left of a class of faults. */
static drive_as_drawn_candidate left_of(const drive_as_drawn_diagnosis *d, const uint8_t *own)
{
    drive_as_drawn_candidate found = DRIVE_AS_DRAWN_LIKELY;
    int k;

    for (k = 0; k < DRIVE_AS_DRAWN_RESIDUALS; ++k) {
        if (d->state[k] == DRIVE_AS_DRAWN_ALARM && own[k] == 0u) {
            return DRIVE_AS_DRAWN_RULED_OUT;
        }
        if (d->state[k] == DRIVE_AS_DRAWN_HEALTHY && own[k] == 3u) {
            found = DRIVE_AS_DRAWN_SMALL;
        }
    }
    return found;
}

/* Which classes of faults the residuals leave, and the one if it is one. */
static void judge(drive_as_drawn_diagnosis *d)
{
    int likely = 0;
    int c;

    d->fault_class = DRIVE_AS_DRAWN_UNKNOWN;
    for (c = 0; c < DRIVE_AS_DRAWN_CLASSES; ++c) {
        const drive_as_drawn_candidate left = left_of(d, signature[c]);

        d->candidate[c] = (uint8_t)left;
        if (left == DRIVE_AS_DRAWN_LIKELY) {
            d->fault_class = (int16_t)c;
            ++likely;
        }
    }
    if (likely != 1 || d->settled < 2u * d->row) {
        d->fault_class = DRIVE_AS_DRAWN_UNKNOWN;
    }
}

drive_as_drawn_limit drive_as_drawn_limit_of(drive_as_drawn_real level)
{
    drive_as_drawn_limit limit;

    limit.mean = REAL(0.0);
    limit.level = level;
    limit.unit = REAL(0.0);
    limit.loud = REAL(0.0);
    limit.drift = REAL(0.5);
    limit.height = NEVER;
    limit.bound = REAL(0.0);
    return limit;
}

void drive_as_drawn_clear(drive_as_drawn_diagnosis *diagnosis)
{
    int k;

    for (k = 0; k < DRIVE_AS_DRAWN_RESIDUALS; ++k) {
        if (diagnosis->state[k] == DRIVE_AS_DRAWN_ALARM) {
            diagnosis->state[k] = DRIVE_AS_DRAWN_HEALTHY;
        }
        diagnosis->since[k] = 0u;
        forget_sums(diagnosis, k);
    }
    for (k = 0; k < DRIVE_AS_DRAWN_CLASSES; ++k) {
        diagnosis->candidate[k] = DRIVE_AS_DRAWN_RULED_OUT;
    }
    diagnosis->fault_class = DRIVE_AS_DRAWN_UNKNOWN;
    diagnosis->quiet = 0u;
    diagnosis->settled = 0u;
}

void drive_as_drawn_diagnosis_reset(drive_as_drawn_diagnosis *diagnosis)
{
    int k;

    diagnosis->row = DRIVE_AS_DRAWN_ROW;
    diagnosis->least = 15u;
    diagnosis->hold = 10u * DRIVE_AS_DRAWN_ROW;
    diagnosis->latch = false;
    diagnosis->tick = 0u;
    for (k = 0; k < DRIVE_AS_DRAWN_RESIDUALS; ++k) {
        diagnosis->state[k] = DRIVE_AS_DRAWN_BLIND;
    }
    drive_as_drawn_clear(diagnosis);
}

bool drive_as_drawn_diagnose(
    drive_as_drawn_diagnosis *diagnosis,
    const drive_as_drawn_limit *limits,
    const drive_as_drawn_real *bounds,
    const drive_as_drawn_residuals *residuals)
{
    drive_as_drawn_diagnosis *d = diagnosis;
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
    for (k = 0; k < DRIVE_AS_DRAWN_RESIDUALS; ++k) {
        if (residuals->valid[k]) {
            const real bound = bounds ? bounds[k] : limits[k].bound;

            fresh = watch(d, &limits[k], k, residuals->value[k], bound, row) || fresh;
        } else {
            forget_sums(d, k);
            if (d->state[k] == DRIVE_AS_DRAWN_ALARM) {
                d->quiet = 0u; /* nobody knows that it is over */
            } else {
                d->state[k] = DRIVE_AS_DRAWN_BLIND;
            }
        }
        alarm = alarm || d->state[k] == DRIVE_AS_DRAWN_ALARM;
    }
    if (fresh) {
        d->quiet = 0u;
        d->settled = 0u;
    }
    if (alarm && !d->latch && d->quiet >= d->hold) {
        drive_as_drawn_clear(d);
        return false;
    }
    if (fresh || (alarm && row)) {
        judge(d);
    }
    return alarm;
}
