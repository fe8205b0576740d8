/* drive_as_drawn.c: the residuals of DriveAsDrawn; generated, see the header. */
#include "drive_as_drawn.h"

#ifndef DRIVE_AS_DRAWN_NO_THRESHOLDS
#include <math.h>
#endif
#include <stddef.h>

#if defined __FINITE_MATH_ONLY__ && __FINITE_MATH_ONLY__
#error "this code tells numbers from NaN: compile it without -ffinite-math-only (-ffast-math)"
#endif

typedef drive_as_drawn_real real;

#define REAL(x) DRIVE_AS_DRAWN_CONSTANT(x)
#if defined DRIVE_AS_DRAWN_FLOAT && !defined DRIVE_AS_DRAWN_REAL
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
#if defined DRIVE_AS_DRAWN_FLOAT && !defined DRIVE_AS_DRAWN_REAL
#define SLOWEST REAL(0.0001)
#else
#define SLOWEST REAL(1.0e-09)
#endif

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

/* Whether configure may go on with what it is given. */
static drive_as_drawn_status checked(const drive_as_drawn_parameters *p, real sample_time, real bandwidth)
{
    const bool finite = finite_number(p->tau0 + p->A + p->el__L + p->el__Re + p->el__k + p->me__Je
            + p->me__fe + p->me__K + p->ge__N + p->wh__Js + p->wh__fs + p->wh__R);

    if (!finite) {
        return DRIVE_AS_DRAWN_BAD_PARAMETER;
    }
    if (!(sample_time >= REAL(0.000999999)) || !finite_number(sample_time)) {
        return DRIVE_AS_DRAWN_BAD_SAMPLE_TIME;
    }
    if (!(bandwidth * sample_time >= SLOWEST && bandwidth * sample_time <= REAL(3.0))) {
        return DRIVE_AS_DRAWN_BAD_BANDWIDTH;
    }
    return DRIVE_AS_DRAWN_OK;
}

/* Samples until `constants` time constants of the filter are over. */
static uint32_t samples(real constants, real sample_time, real bandwidth)
{
    const real wait = constants / (bandwidth * sample_time);
    const uint32_t whole = wait < REAL(4.0e9) ? (uint32_t)wait : UINT32_MAX - 1u;

    return (real)whole < wait ? whole + 1u : whole;
}

const drive_as_drawn_coefficients drive_as_drawn_nominal_coefficients = {
    REAL(0.06317951566951567),     /* r1_me__we */
    -REAL(40.11396011396012),      /* r1_tanh */
    REAL(0.06017094017094017),     /* r1_wh__ws */
    REAL(1.002849002849003),       /* r1_Fx */
    REAL(0.0010416666666666667),   /* scaled_sample_time_over_tau0 */
    REAL(0.026041666666666664),    /* scaled_N_times_sample_time_over_tau0 */
    -REAL(0.0014243304843304858),  /* r1_w1_me__we */
    REAL(4.786324786324794e-07),   /* r1_w2_me__we */
    -REAL(0.013675213675213687),   /* r1_w1_tanh */
    -REAL(401.1396216524221),      /* r1_w1_wh__ws */
    REAL(0.136752136752137),       /* r1_w2_wh__ws */
    REAL(0.00034188034188034215),  /* r1_w1_Fx */
    REAL(6.666666666666679e-05),   /* bend2 */
    REAL(3.3333333333333396e-05),  /* bend1 */
    REAL(0.9801980198019802),      /* a */
    REAL(0.00990099009900991),     /* b */
    REAL(25.0),                    /* r2_wh__ws */
    REAL(16.000000000000025),      /* r2_w2_wh__ws */
    REAL(0.040000000000000036),    /* r2_w1_Fx */
    -REAL(0.8000000000000007),     /* r2_w1_tanh */
    {562u, 562u},                  /* samples until each is valid */
    562u                           /* the longest of these */
};

/* r1: coefficients */
static void compute_r1(drive_as_drawn_coefficients *c, const drive_as_drawn_parameters *p, real w)
{
    /* khepera.bg:17: el.L*me.fe/el.k */
    const real L_times_fe_over_k = p->el__L * p->me__fe / p->el__k;

    /* el.L*wh.fs/(ge.N*el.k) */
    const real product = p->el__L * p->wh__fs / p->ge__N / p->el__k;

    /* el.Re*me.Je/el.k */
    const real Re_times_Je_over_k = p->el__Re * p->me__Je / p->el__k;

    /* el.Re*wh.Js/(ge.N*el.k) */
    const real product_2 = p->el__Re * p->wh__Js / p->ge__N / p->el__k;

    /* r1: factor of me.we: el.k + el.Re*me.fe/el.k */
    c->r1_me__we = p->el__k + p->el__Re * p->me__fe / p->el__k;

    /* r1: factor of tanh(Int(me.we)/(4*tau0) - ge.N*Int(wh.ws)/(4*tau0)):
     * 2*tau0*A*me.K*el.Re/el.k */
    c->r1_tanh = REAL(2.0) * p->tau0 * p->A * p->me__K * p->el__Re / p->el__k;

    /* r1: factor of wh.ws: el.Re*wh.fs/(ge.N*el.k) */
    c->r1_wh__ws = p->el__Re * p->wh__fs / p->ge__N / p->el__k;

    /* r1: factor of Fx: el.Re*wh.R/(ge.N*el.k) */
    c->r1_Fx = p->el__Re * p->wh__R / p->ge__N / p->el__k;

    /* r1: factor of me.we' */
    c->r1_w1_me__we = (-L_times_fe_over_k - Re_times_Je_over_k) * w;

    /* r1: factor of me.we'' */
    c->r1_w2_me__we = p->el__L * p->me__Je * w * w / p->el__k;

    /* r1: factor of D(tanh(Int(me.we)/(4*tau0) - ge.N*Int(wh.ws)/(4*tau0))) */
    c->r1_w1_tanh = REAL(2.0) * p->tau0 * p->A * p->me__K * p->el__L * w / p->el__k;

    /* r1: factor of wh.ws' */
    c->r1_w1_wh__ws = (-product - product_2) * w;

    /* r1: factor of wh.ws'' */
    c->r1_w2_wh__ws = p->el__L * p->wh__Js * w * w / p->ge__N / p->el__k;

    /* r1: factor of Fx' */
    c->r1_w1_Fx = p->el__L * p->wh__R * w / p->ge__N / p->el__k;
}

/* filter: coefficients */
static void compute_filter(drive_as_drawn_coefficients *c, real pole, real turn)
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
static void compute_r2(drive_as_drawn_coefficients *c, const drive_as_drawn_parameters *p, real w)
{
    /* khepera.bg:41: r2: factor of wh.ws: ge.N */
    c->r2_wh__ws = p->ge__N;

    /* r2: factor of wh.ws'' */
    c->r2_w2_wh__ws = p->wh__Js * w * w / p->ge__N / p->me__K;

    /* r2: factor of Fx' */
    c->r2_w1_Fx = p->wh__R * w / p->ge__N / p->me__K;

    /* r2: factor of D(tanh(Int(me.we)/(4*tau0) - ge.N*Int(wh.ws)/(4*tau0))) */
    c->r2_w1_tanh = p->tau0 * p->A * w;
}

/* The coefficients, from the parameters. */
static void compute_coefficients(drive_as_drawn_coefficients *c, const drive_as_drawn_parameters *p,
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

    /* khepera.bg:17: (1/96)*sample_time/tau0 */
    c->scaled_sample_time_over_tau0 = sample_time / REAL(96.0) / p->tau0;

    /* (1/96)*ge.N*sample_time/tau0 */
    c->scaled_N_times_sample_time_over_tau0 = p->ge__N * sample_time / REAL(96.0) / p->tau0;

    compute_r1(c, p, w);
    compute_filter(c, pole, turn);
    compute_r2(c, p, w);
}

static bool coefficients_are_finite(const drive_as_drawn_coefficients *c)
{
    return finite_number(c->r1_me__we + c->r1_tanh + c->r1_wh__ws + c->r1_Fx
            + c->scaled_sample_time_over_tau0 + c->scaled_N_times_sample_time_over_tau0
            + c->r1_w1_me__we + c->r1_w2_me__we + c->r1_w1_tanh + c->r1_w1_wh__ws + c->r1_w2_wh__ws
            + c->r1_w1_Fx + c->bend2 + c->bend1 + c->a + c->b + c->r2_wh__ws + c->r2_w2_wh__ws
            + c->r2_w1_Fx + c->r2_w1_tanh);
}

drive_as_drawn_status drive_as_drawn_configure(
    drive_as_drawn_coefficients *coefficients,
    const drive_as_drawn_parameters *parameters,
    drive_as_drawn_real sample_time,
    drive_as_drawn_real bandwidth)
{
    drive_as_drawn_coefficients *c = coefficients;
    const drive_as_drawn_status status = checked(parameters, sample_time, bandwidth);
    int k;

    for (k = 0; k < DRIVE_AS_DRAWN_RESIDUALS; ++k) {
        c->settle[k] = UINT32_MAX;
    }
    c->longest = UINT32_MAX;
    if (status != DRIVE_AS_DRAWN_OK) {
        return status;
    }
    compute_coefficients(c, parameters, sample_time, bandwidth);
    if (!coefficients_are_finite(c)) {
        return DRIVE_AS_DRAWN_BAD_COEFFICIENT;
    }
    c->settle[DRIVE_AS_DRAWN_R1] = samples(REAL(11.228872242412663), sample_time, bandwidth);
    c->settle[DRIVE_AS_DRAWN_R2] = samples(REAL(11.228872242412663), sample_time, bandwidth);
    c->longest = c->settle[DRIVE_AS_DRAWN_R1];
    return DRIVE_AS_DRAWN_OK;
}

/* tanh(Int(me.we)/(4*tau0) - ge.N*Int(wh.ws)/(4*tau0)) */
static real run_r1_tanh(const drive_as_drawn_coefficients *c, drive_as_drawn_memory *x,
        const drive_as_drawn_samples *s, bool first)
{
    /* sample_time/24 times me.we/(4*tau0) - ge.N*wh.ws/(4*tau0), what is integrated */
    const real rate = c->scaled_sample_time_over_tau0 * s->me__we
        - c->scaled_N_times_sample_time_over_tau0 * s->wh__ws;

    if (first) {
        /* r1: the integral is 0 at the start */
        x->r1_q = -REAL(12.0) * rate;
        x->r1_rate1 = rate;
        x->r1_rate2 = rate;
    }

    /* its integral since the start, by the rule of Adams */
    const real integral = x->r1_q + REAL(9.0) * rate + REAL(4.0) * x->r1_rate1 - x->r1_rate2;
    x->r1_q = x->r1_q + REAL(24.0) * rate;
    x->r1_rate2 = x->r1_rate1;
    x->r1_rate1 = rate;

    /* tanh(Int(me.we)/(4*tau0) - ge.N*Int(wh.ws)/(4*tau0)) */
    const real tanh_ = near_tanh(integral);

    return tanh_;
}

/* r1 on one sample.
 * khepera.bg:17: r1 = U0 - el.k*me.we - el.Re*el.k.e2/el.k - el.L*D(el.k.e2)/el.k
 * where el.k.e2 = me.fe*me.we + me.Je*D(me.we) + (wh.fs*wh.ws + wh.R*Fx + wh.Js*D(wh.ws) -
 * tau0*A*ge.N*me.K*x1)/ge.N - tau0*A*me.K*x1
 * x1 = tanh((Int(me.we) - ge.N*Int(wh.ws))/(4*tau0)) */
static void run_r1(
    const drive_as_drawn_coefficients *c, drive_as_drawn_memory *x, const drive_as_drawn_samples *s, real *r)
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

    const real tanh_ = run_r1_tanh(c, x, s, first);

    /* terms of order 0 */
    const real g0 = s->U0 + c->r1_tanh * tanh_ - c->r1_me__we * s->me__we - c->r1_wh__ws * s->wh__ws
        - c->r1_Fx * s->Fx;

    /* terms of order 1 */
    const real g1 = c->r1_w1_me__we * s->me__we + c->r1_w1_tanh * tanh_
        + c->r1_w1_wh__ws * s->wh__ws - c->r1_w1_Fx * s->Fx;

    /* error of order 0 */
    const real e0 = c->bend2 * g0;

    /* degree 2 */
    const real d2 = c->r1_w2_me__we * s->me__we + c->r1_w2_wh__ws * s->wh__ws + e0;

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

    r[DRIVE_AS_DRAWN_R1] = y1 - e1;
}

/* tanh(Int(me.we)/(4*tau0) - ge.N*Int(wh.ws)/(4*tau0)) */
static real run_r2_tanh(const drive_as_drawn_coefficients *c, drive_as_drawn_memory *x,
        const drive_as_drawn_samples *s, bool first)
{
    /* sample_time/24 times me.we/(4*tau0) - ge.N*wh.ws/(4*tau0), what is integrated */
    const real rate = c->scaled_sample_time_over_tau0 * s->me__we
        - c->scaled_N_times_sample_time_over_tau0 * s->wh__ws;

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

    /* tanh(Int(me.we)/(4*tau0) - ge.N*Int(wh.ws)/(4*tau0)) */
    const real tanh_ = near_tanh(integral);

    return tanh_;
}

/* r2 on one sample.
 * khepera.bg:41: r2 = me.we - ge.N*wh.ws - D(wh.fs*wh.ws + wh.R*Fx + wh.Js*D(wh.ws) -
 * tau0*A*ge.N*me.K*tanh((Int(me.we) - ge.N*Int(wh.ws))/(4*tau0)))/(ge.N*me.K) */
static void run_r2(
    const drive_as_drawn_coefficients *c, drive_as_drawn_memory *x, const drive_as_drawn_samples *s, real *r)
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
    const real g0 = s->me__we - c->r2_wh__ws * s->wh__ws;

    /* terms of order 1 */
    const real g1 = c->r2_w1_tanh * tanh_ - c->r2_w1_Fx * s->Fx;

    /* error of order 0 */
    const real e0 = c->bend2 * g0;

    /* degree 2 */
    const real d2 = c->r2_w2_wh__ws * s->wh__ws + e0;

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

    r[DRIVE_AS_DRAWN_R2] = y1 - e1;
}

/* Ages and validity one by one: a number that is not finite makes the next sample the first. */
static void count_samples(
    const drive_as_drawn_coefficients *c,
    drive_as_drawn_memory *x,
    drive_as_drawn_residuals *out)
{
    /* the residuals that are computed, and what each one goes with */
    static const uint8_t number[] = {
        0, 1
    };
    static const uint8_t part[] = {
        0, 1
    };
    bool finite[2];
    int k;

    finite[0] = true;
    finite[1] = true;
    for (k = 0; k < 2; ++k) {
        finite[part[k]] = finite[part[k]] && finite_number(out->value[number[k]]);
    }
    x->youngest = UINT32_MAX;
    for (k = 0; k < 2; ++k) {
        x->age[k] = finite[k] ? x->age[k] + (x->age[k] < UINT32_MAX ? 1u : 0u) : 0u;
        x->youngest = x->age[k] < x->youngest ? x->age[k] : x->youngest;
    }
    for (k = 0; k < 2; ++k) {
        out->value[number[k]] = finite[part[k]] ? out->value[number[k]] : REAL(0.0);
        out->valid[number[k]] = x->age[part[k]] > c->settle[number[k]];
    }
}

void drive_as_drawn_reset(drive_as_drawn_memory *memory)
{
    int k;

    for (k = 0; k < 2; ++k) {
        memory->age[k] = 0u;
    }
    memory->youngest = 0u;
}

void drive_as_drawn_step(
    const drive_as_drawn_coefficients *coefficients,
    drive_as_drawn_memory *memory,
    const drive_as_drawn_samples *samples,
    drive_as_drawn_residuals *residuals)
{
    const drive_as_drawn_coefficients *c = coefficients;
    drive_as_drawn_memory *x = memory;
    const drive_as_drawn_samples *s = samples;
    real *r = residuals->value;
    int k;

    run_r1(c, x, s, r);
    run_r2(c, x, s, r);
    /* a sum is finite only if all its terms are */
    if (x->youngest > c->longest && finite_number(r[DRIVE_AS_DRAWN_R1] + r[DRIVE_AS_DRAWN_R2])) {
        for (k = 0; k < DRIVE_AS_DRAWN_RESIDUALS; ++k) {
            residuals->valid[k] = true;
        }
    } else {
        count_samples(c, x, residuals);
    }
}

#ifndef DRIVE_AS_DRAWN_NO_THRESHOLDS

const drive_as_drawn_threshold_coefficients drive_as_drawn_threshold_nominal_coefficients = {
    REAL(0.0010416666666666667),    /* scaled_sample_time_over_tau0 */
    REAL(0.026041666666666664),     /* scaled_N_times_sample_time_over_tau0 */
    REAL(0.0029834757834757836),    /* r1_w1_me__we */
    REAL(7.019943019943026e-05),    /* r1_w1_w1_me__we */
    -REAL(2.005698005698006),       /* r1_w1_tanh */
    REAL(0.0030085470085470085),    /* r1_w1_wh__ws */
    REAL(20.056980056980077),       /* r1_w1_w1_wh__ws */
    REAL(0.05014245014245015),      /* r1_w1_Fx */
    REAL(3.3333333333333396e-05),   /* bend1 */
    REAL(0.9801980198019802),       /* a */
    REAL(0.00990099009900991),      /* b */
    -REAL(0.8022792022792024),      /* r1_w2_tanh */
    -REAL(0.00027350427350427374),  /* r1_w2_w1_tanh */
    REAL(0.0012034188034188034),    /* r1_w2_wh__ws */
    REAL(8.02279243304844),         /* r1_w2_w1_wh__ws */
    REAL(0.00273504273504274),      /* r1_w2_w2_wh__ws */
    REAL(0.020056980056980058),     /* r1_w2_Fx */
    REAL(6.837606837606843e-06),    /* r1_w2_w1_Fx */
    REAL(0.0011231903133903133),    /* r1_w2_me__we */
    REAL(2.8486609686609715e-05),   /* r1_w2_w1_me__we */
    REAL(9.572649572649589e-09),    /* r1_w2_w2_me__we */
    REAL(6.666666666666679e-05),    /* bend2 */
    REAL(0.005966951566951567),     /* r1_w3_me__we */
    REAL(2.0341880341880358e-06),   /* r1_w3_w1_me__we */
    REAL(0.006017094017094017),     /* r1_w4_wh__ws */
    REAL(2.051282051282053e-06),    /* r1_w4_w1_wh__ws */
    REAL(6.208582901496288e-05),    /* r1_w5_me__we */
    REAL(1.4608430356461866e-06),   /* r1_w5_w1_me__we */
    -REAL(0.04173837244703387),     /* r1_w5_tanh */
    REAL(6.260755867055079e-05),    /* r1_w5_wh__ws */
    REAL(0.4173837244703391),       /* r1_w5_w1_wh__ws */
    REAL(0.0010434593111758466),    /* r1_w5_Fx */
    REAL(0.0003104291450748144),    /* r1_w6_me__we */
    REAL(0.00031303779335275394),   /* r1_w7_wh__ws */
    -REAL(0.01669534897881355),     /* r1_w8_tanh */
    -REAL(5.69159624277735e-06),    /* r1_w8_w1_tanh */
    REAL(2.5043023468220318e-05),   /* r1_w8_wh__ws */
    -REAL(0.16695349832553),        /* r1_w8_w1_wh__ws */
    REAL(5.691596242777355e-05),    /* r1_w8_w2_wh__ws */
    REAL(0.00041738372447033866),   /* r1_w8_Fx */
    REAL(1.4228990606943374e-07),   /* r1_w8_w1_Fx */
    REAL(2.483433160598515e-05),    /* r1_w8_me__we */
    -REAL(5.928034636696059e-07),   /* r1_w8_w1_me__we */
    REAL(1.992058684972074e-10),    /* r1_w8_w2_me__we */
    REAL(0.00012417165802992576),   /* r1_w9_me__we */
    REAL(4.2331247055656536e-08),   /* r1_w9_w1_me__we */
    REAL(0.00012521511734110157),   /* r1_w10_wh__ws */
    REAL(4.2686971820830126e-08),   /* r1_w10_w1_wh__ws */
    {562u, 562u},                   /* samples until each is valid */
    562u                            /* the longest of these */
};

/* r1_w1: coefficients */
static void bound_compute_r1_w1(drive_as_drawn_threshold_coefficients *c, real Re_times_fe_over_k,
        real product, real product_2, real product_3, real product_8, real product_9)
{
    /* khepera.bg:17: r1_w1: factor of me.we */
    c->r1_w1_me__we = Re_times_fe_over_k / REAL(20.0);

    /* r1_w1: factor of me.we' */
    c->r1_w1_w1_me__we = product_8 / REAL(20.0);

    /* r1_w1: factor of tanh(Int(me.we)/(4*tau0) - ge.N*Int(wh.ws)/(4*tau0)) */
    c->r1_w1_tanh = product / REAL(10.0);

    /* r1_w1: factor of wh.ws */
    c->r1_w1_wh__ws = product_2 / REAL(20.0);

    /* r1_w1: factor of wh.ws' */
    c->r1_w1_w1_wh__ws = product_9 / REAL(20.0);

    /* r1_w1: factor of Fx */
    c->r1_w1_Fx = product_3 / REAL(20.0);
}

/* r1_w2: coefficients */
static void bound_compute_r1_w2(drive_as_drawn_threshold_coefficients *c,
        const drive_as_drawn_parameters *p, real w, real product, real product_2, real product_3,
        real product_4, real product_5, real product_6, real product_7)
{
    /* khepera.bg:17: r1_w2: factor of tanh(Int(me.we)/(4*tau0) - ge.N*Int(wh.ws)/(4*tau0)) */
    c->r1_w2_tanh = product / REAL(25.0);

    /* r1_w2: factor of D(tanh(Int(me.we)/(4*tau0) - ge.N*Int(wh.ws)/(4*tau0))) */
    c->r1_w2_w1_tanh = product_5 / REAL(25.0);

    /* r1_w2: factor of wh.ws */
    c->r1_w2_wh__ws = product_2 / REAL(50.0);

    /* r1_w2: factor of wh.ws' */
    c->r1_w2_w1_wh__ws = p->el__k * w * (p->el__Re * p->wh__Js / p->ge__N / p->el__k / p->el__k
            + p->el__L * p->wh__fs / p->ge__N / p->el__k / p->el__k) / REAL(50.0);

    /* r1_w2: factor of wh.ws'' */
    c->r1_w2_w2_wh__ws = product_6 / REAL(50.0);

    /* r1_w2: factor of Fx */
    c->r1_w2_Fx = product_3 / REAL(50.0);

    /* r1_w2: factor of Fx' */
    c->r1_w2_w1_Fx = product_7 / REAL(50.0);

    /* r1_w2: factor of me.we */
    c->r1_w2_me__we = p->el__k * (p->el__Re * p->me__fe / p->el__k / p->el__k
            - REAL(1.0)) / REAL(50.0);

    /* r1_w2: factor of me.we' */
    c->r1_w2_w1_me__we = p->el__k * w * (p->el__Re * p->me__Je / p->el__k / p->el__k
            + p->el__L * p->me__fe / p->el__k / p->el__k) / REAL(50.0);

    /* r1_w2: factor of me.we'' */
    c->r1_w2_w2_me__we = product_4 / REAL(50.0);
}

/* r1_w5: coefficients */
static void bound_compute_r1_w5(drive_as_drawn_threshold_coefficients *c, real Re_times_fe_over_k,
        real product, real product_2, real product_3, real product_8, real product_9)
{
    /* khepera.bg:17: r1_w5: factor of me.we */
    c->r1_w5_me__we = REAL(37.0) * Re_times_fe_over_k / REAL(35560.0);

    /* r1_w5: factor of me.we' */
    c->r1_w5_w1_me__we = REAL(37.0) * product_8 / REAL(35560.0);

    /* r1_w5: factor of tanh(Int(me.we)/(4*tau0) - ge.N*Int(wh.ws)/(4*tau0)) */
    c->r1_w5_tanh = REAL(37.0) * product / REAL(17780.0);

    /* r1_w5: factor of wh.ws */
    c->r1_w5_wh__ws = REAL(37.0) * product_2 / REAL(35560.0);

    /* r1_w5: factor of wh.ws' */
    c->r1_w5_w1_wh__ws = REAL(37.0) * product_9 / REAL(35560.0);

    /* r1_w5: factor of Fx */
    c->r1_w5_Fx = REAL(37.0) * product_3 / REAL(35560.0);
}

/* r1_w3 to r1_w6: coefficients */
static void bound_compute_r1_w3_to_r1_w6(drive_as_drawn_threshold_coefficients *c,
        real Re_times_fe_over_k, real product, real product_2, real product_3, real product_8,
        real product_9, real product_10, real product_11)
{
    /* khepera.bg:17: r1_w3: factor of me.we */
    c->r1_w3_me__we = Re_times_fe_over_k / REAL(10.0);

    /* r1_w3: factor of me.we' */
    c->r1_w3_w1_me__we = product_10 / REAL(10.0);

    /* r1_w4: factor of wh.ws */
    c->r1_w4_wh__ws = product_2 / REAL(10.0);

    /* r1_w4: factor of wh.ws' */
    c->r1_w4_w1_wh__ws = product_11 / REAL(10.0);

    bound_compute_r1_w5(c, Re_times_fe_over_k, product, product_2, product_3, product_8, product_9);

    /* khepera.bg:17: r1_w6: factor of me.we */
    c->r1_w6_me__we = REAL(37.0) * Re_times_fe_over_k / REAL(7112.0);
}

/* r1_w8: coefficients */
static void bound_compute_r1_w8(drive_as_drawn_threshold_coefficients *c,
        const drive_as_drawn_parameters *p, real w, real Re_times_fe_over_k, real product,
        real product_2, real product_3, real product_4, real product_5, real product_6,
        real product_7)
{
    /* khepera.bg:17: r1_w8: factor of tanh(Int(me.we)/(4*tau0) - ge.N*Int(wh.ws)/(4*tau0)) */
    c->r1_w8_tanh = REAL(37.0) * product / REAL(44450.0);

    /* r1_w8: factor of D(tanh(Int(me.we)/(4*tau0) - ge.N*Int(wh.ws)/(4*tau0))) */
    c->r1_w8_w1_tanh = REAL(37.0) * product_5 / REAL(44450.0);

    /* r1_w8: factor of wh.ws */
    c->r1_w8_wh__ws = REAL(37.0) * product_2 / REAL(88900.0);

    /* r1_w8: factor of wh.ws' */
    c->r1_w8_w1_wh__ws = REAL(37.0) * p->el__k * p->el__k * w
            * (-REAL(2.0) * p->el__Re * p->wh__Js / p->ge__N / p->el__k / p->el__k / p->el__k
            - REAL(2.0) * p->el__L * p->wh__fs / p->ge__N / p->el__k / p->el__k / p->el__k)
            / REAL(177800.0);

    /* r1_w8: factor of wh.ws'' */
    c->r1_w8_w2_wh__ws = REAL(37.0) * product_6 / REAL(88900.0);

    /* r1_w8: factor of Fx */
    c->r1_w8_Fx = REAL(37.0) * product_3 / REAL(88900.0);

    /* r1_w8: factor of Fx' */
    c->r1_w8_w1_Fx = REAL(37.0) * product_7 / REAL(88900.0);

    /* r1_w8: factor of me.we */
    c->r1_w8_me__we = REAL(37.0) * Re_times_fe_over_k / REAL(88900.0);

    /* r1_w8: factor of me.we' */
    c->r1_w8_w1_me__we = REAL(37.0) * p->el__k * p->el__k * w
            * (-REAL(2.0) * p->el__Re * p->me__Je / p->el__k / p->el__k / p->el__k
            - REAL(2.0) * p->el__L * p->me__fe / p->el__k / p->el__k / p->el__k) / REAL(177800.0);

    /* r1_w8: factor of me.we'' */
    c->r1_w8_w2_me__we = REAL(37.0) * product_4 / REAL(88900.0);
}

/* r1_w9 to r1_w10: coefficients */
static void bound_compute_r1_w9_to_r1_w10(drive_as_drawn_threshold_coefficients *c,
        real Re_times_fe_over_k, real product_2, real product_10, real product_11)
{
    /* khepera.bg:17: r1_w9: factor of me.we */
    c->r1_w9_me__we = REAL(37.0) * Re_times_fe_over_k / REAL(17780.0);

    /* r1_w9: factor of me.we' */
    c->r1_w9_w1_me__we = REAL(37.0) * product_10 / REAL(17780.0);

    /* r1_w10: factor of wh.ws */
    c->r1_w10_wh__ws = REAL(37.0) * product_2 / REAL(17780.0);

    /* r1_w10: factor of wh.ws' */
    c->r1_w10_w1_wh__ws = REAL(37.0) * product_11 / REAL(17780.0);
}

/* r1: coefficients */
static void bound_compute_r1(drive_as_drawn_threshold_coefficients *c,
        const drive_as_drawn_parameters *p, real sample_time, real turn)
{
    /* w of the filter 1/(1 + D/w) */
    const real w = turn / sample_time;

    /* khepera.bg:17: el.Re*me.fe/el.k */
    const real Re_times_fe_over_k = p->el__Re * p->me__fe / p->el__k;

    /* tau0*A*me.K*el.Re/el.k */
    const real product = p->tau0 * p->A * p->me__K * p->el__Re / p->el__k;

    /* el.Re*wh.fs/(ge.N*el.k) */
    const real product_2 = p->el__Re * p->wh__fs / p->ge__N / p->el__k;

    /* el.Re*wh.R/(ge.N*el.k) */
    const real product_3 = p->el__Re * p->wh__R / p->ge__N / p->el__k;

    /* el.L*me.Je*w^2/el.k */
    const real product_4 = p->el__L * p->me__Je * w * w / p->el__k;

    /* tau0*A*me.K*el.L*w/el.k */
    const real product_5 = p->tau0 * p->A * p->me__K * p->el__L * w / p->el__k;

    /* el.L*wh.Js*w^2/(ge.N*el.k) */
    const real product_6 = p->el__L * p->wh__Js * w * w / p->ge__N / p->el__k;

    /* el.L*wh.R*w/(ge.N*el.k) */
    const real product_7 = p->el__L * p->wh__R * w / p->ge__N / p->el__k;

    /* el.Re*me.Je*w/el.k */
    const real product_8 = p->el__Re * p->me__Je * w / p->el__k;

    /* el.Re*wh.Js*w/(ge.N*el.k) */
    const real product_9 = p->el__Re * p->wh__Js * w / p->ge__N / p->el__k;

    /* el.L*me.fe*w/el.k */
    const real product_10 = p->el__L * p->me__fe * w / p->el__k;

    /* el.L*wh.fs*w/(ge.N*el.k) */
    const real product_11 = p->el__L * p->wh__fs * w / p->ge__N / p->el__k;

    bound_compute_r1_w1(c, Re_times_fe_over_k, product, product_2, product_3, product_8, product_9);
    bound_compute_r1_w2(c, p, w, product, product_2, product_3, product_4, product_5, product_6,
            product_7);
    bound_compute_r1_w3_to_r1_w6(c, Re_times_fe_over_k, product, product_2, product_3, product_8,
            product_9, product_10, product_11);

    /* khepera.bg:17: r1_w7: factor of wh.ws */
    c->r1_w7_wh__ws = REAL(37.0) * product_2 / REAL(7112.0);

    bound_compute_r1_w8(c, p, w, Re_times_fe_over_k, product, product_2, product_3, product_4,
            product_5, product_6, product_7);
    bound_compute_r1_w9_to_r1_w10(c, Re_times_fe_over_k, product_2, product_10, product_11);
}

/* filter: coefficients */
static void bound_compute_filter(drive_as_drawn_threshold_coefficients *c, real pole, real turn)
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

/* The coefficients, from the parameters. */
static void bound_compute_coefficients(drive_as_drawn_threshold_coefficients *c,
        const drive_as_drawn_parameters *p, real sample_time, real bandwidth)
{
    /* bandwidth*sample_time */
    const real x_ = bandwidth * sample_time;

    /* of a stage: what is left of its memory */
    const real pole = greatest(REAL(2.0) - x_, REAL(0.0)) / (x_ + REAL(2.0));

    /* w*sample_time, x or 2 */
    const real turn = REAL(2.0) * (REAL(1.0) - pole) / (pole + REAL(1.0));

    /* khepera.bg:17: (1/96)*sample_time/tau0 */
    c->scaled_sample_time_over_tau0 = sample_time / REAL(96.0) / p->tau0;

    /* (1/96)*ge.N*sample_time/tau0 */
    c->scaled_N_times_sample_time_over_tau0 = p->ge__N * sample_time / REAL(96.0) / p->tau0;

    bound_compute_r1(c, p, sample_time, turn);
    bound_compute_filter(c, pole, turn);
}

static bool bound_coefficients_are_finite(const drive_as_drawn_threshold_coefficients *c)
{
    return finite_number(c->scaled_sample_time_over_tau0 + c->scaled_N_times_sample_time_over_tau0
            + c->r1_w1_me__we + c->r1_w1_w1_me__we + c->r1_w1_tanh + c->r1_w1_wh__ws
            + c->r1_w1_w1_wh__ws + c->r1_w1_Fx + c->bend1 + c->a + c->b + c->r1_w2_tanh
            + c->r1_w2_w1_tanh + c->r1_w2_wh__ws + c->r1_w2_w1_wh__ws + c->r1_w2_w2_wh__ws
            + c->r1_w2_Fx + c->r1_w2_w1_Fx + c->r1_w2_me__we + c->r1_w2_w1_me__we
            + c->r1_w2_w2_me__we + c->bend2 + c->r1_w3_me__we + c->r1_w3_w1_me__we + c->r1_w4_wh__ws
            + c->r1_w4_w1_wh__ws + c->r1_w5_me__we + c->r1_w5_w1_me__we + c->r1_w5_tanh
            + c->r1_w5_wh__ws + c->r1_w5_w1_wh__ws + c->r1_w5_Fx + c->r1_w6_me__we + c->r1_w7_wh__ws
            + c->r1_w8_tanh + c->r1_w8_w1_tanh + c->r1_w8_wh__ws + c->r1_w8_w1_wh__ws
            + c->r1_w8_w2_wh__ws + c->r1_w8_Fx + c->r1_w8_w1_Fx + c->r1_w8_me__we
            + c->r1_w8_w1_me__we + c->r1_w8_w2_me__we + c->r1_w9_me__we + c->r1_w9_w1_me__we
            + c->r1_w10_wh__ws + c->r1_w10_w1_wh__ws);
}

drive_as_drawn_status drive_as_drawn_threshold_configure(
    drive_as_drawn_threshold_coefficients *coefficients,
    const drive_as_drawn_parameters *parameters,
    drive_as_drawn_real sample_time,
    drive_as_drawn_real bandwidth)
{
    drive_as_drawn_threshold_coefficients *c = coefficients;
    const drive_as_drawn_status status = checked(parameters, sample_time, bandwidth);
    int k;

    for (k = 0; k < DRIVE_AS_DRAWN_RESIDUALS; ++k) {
        c->settle[k] = UINT32_MAX;
    }
    c->longest = UINT32_MAX;
    if (status != DRIVE_AS_DRAWN_OK) {
        return status;
    }
    bound_compute_coefficients(c, parameters, sample_time, bandwidth);
    if (!bound_coefficients_are_finite(c)) {
        return DRIVE_AS_DRAWN_BAD_COEFFICIENT;
    }
    c->settle[DRIVE_AS_DRAWN_R1] = samples(REAL(11.228872242412663), sample_time, bandwidth);
    c->settle[DRIVE_AS_DRAWN_R2] = samples(REAL(11.228872242412663), sample_time, bandwidth);
    c->longest = c->settle[DRIVE_AS_DRAWN_R1];
    return DRIVE_AS_DRAWN_OK;
}

/* its integral since the start, by the rule of Adams */
static real bound_r1_w1_integral(drive_as_drawn_threshold_memory *x, bool first, real w1_rate)
{
    if (first) {
        /* r1_w1: the integral is 0 at the start */
        x->r1_w1_q = -REAL(12.0) * w1_rate;
        x->r1_w1_rate1 = w1_rate;
        x->r1_w1_rate2 = w1_rate;
    }

    /* r1_w1: its integral since the start, by the rule of Adams */
    const real w1_integral = x->r1_w1_q + REAL(9.0) * w1_rate + REAL(4.0) * x->r1_w1_rate1
        - x->r1_w1_rate2;
    x->r1_w1_q = x->r1_w1_q + REAL(24.0) * w1_rate;
    x->r1_w1_rate2 = x->r1_w1_rate1;
    x->r1_w1_rate1 = w1_rate;

    return w1_integral;
}

/* what the tolerance of el.Re can do */
static real bound_r1_w1(const drive_as_drawn_threshold_coefficients *c,
        drive_as_drawn_threshold_memory *x, const drive_as_drawn_samples *s, real w1_a, real w1_b,
        real w1_tanh)
{
    /* r1_w1: terms of order 0 */
    const real w1_g0 = c->r1_w1_tanh * w1_tanh - c->r1_w1_me__we * s->me__we
        - c->r1_w1_wh__ws * s->wh__ws - c->r1_w1_Fx * s->Fx;

    /* r1_w1: degree 1 */
    const real w1_d1 = c->r1_w1_w1_me__we * s->me__we + c->r1_w1_w1_wh__ws * s->wh__ws;

    /* r1_w1: error of order 0 */
    const real w1_e0 = c->bend1 * w1_g0;

    /* r1_w1: the filter multiplied out */
    const real w1_p1_1 = w1_e0 - w1_d1;

    /* r1_w1: stage 3 */
    const real w1_u3 = w1_g0 - w1_p1_1;
    const real w1_y3 = x->r1_w1_s3 + w1_b * w1_u3;
    x->r1_w1_s3 = w1_a * w1_y3 + w1_b * w1_u3;

    /* r1_w1: stage 2 */
    const real w1_u2 = w1_y3 + w1_p1_1 + w1_e0;
    const real w1_y2 = x->r1_w1_s2 + w1_b * w1_u2;
    x->r1_w1_s2 = w1_a * w1_y2 + w1_b * w1_u2;

    /* r1_w1: stage 1 */
    const real w1_u1 = w1_y2 - w1_e0;
    const real w1_y1 = x->r1_w1_s1 + w1_b * w1_u1;
    x->r1_w1_s1 = w1_a * w1_y1 + w1_b * w1_u1;

    /* what the tolerance of el.Re can do */
    const real w1 = w1_y1;

    return w1;
}

/* its integral since the start, by the rule of Adams */
static real bound_r1_w2_integral(drive_as_drawn_threshold_memory *x, bool first, real w2_rate)
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

/* what the tolerance of el.k can do */
static real bound_r1_w2(const drive_as_drawn_threshold_coefficients *c,
        drive_as_drawn_threshold_memory *x, const drive_as_drawn_samples *s, real w1_a, real w1_b,
        real w2_tanh)
{
    /* r1_w2: terms of order 0 */
    const real w2_g0 = c->r1_w2_wh__ws * s->wh__ws + c->r1_w2_Fx * s->Fx
        + c->r1_w2_me__we * s->me__we - c->r1_w2_tanh * w2_tanh;

    /* r1_w2: terms of order 1 */
    const real w2_g1 = c->r1_w2_w1_wh__ws * s->wh__ws + c->r1_w2_w1_Fx * s->Fx
        + c->r1_w2_w1_me__we * s->me__we - c->r1_w2_w1_tanh * w2_tanh;

    /* r1_w2: error of order 0 */
    const real w2_e0 = c->bend2 * w2_g0;

    /* r1_w2: degree 2 */
    const real w2_d2 = c->r1_w2_w2_wh__ws * s->wh__ws + c->r1_w2_w2_me__we * s->me__we - w2_e0;

    /* r1_w2: error of order 1 */
    const real w2_e1 = c->bend1 * w2_g1;

    /* r1_w2: the filter multiplied out */
    const real w2_p2_1 = w2_d2 + w2_e1;
    const real w2_p1_1 = w2_p2_1 + w2_e1;
    const real w2_p1_2 = w2_g1 - w2_p2_1;

    /* r1_w2: stage 3 */
    const real w2_u3 = w2_g0 - w2_p1_2;
    const real w2_y3 = x->r1_w2_s3 + w1_b * w2_u3;
    x->r1_w2_s3 = w1_a * w2_y3 + w1_b * w2_u3;

    /* r1_w2: stage 2 */
    const real w2_u2 = w2_y3 + w2_p1_2 - w2_p1_1;
    const real w2_y2 = x->r1_w2_s2 + w1_b * w2_u2;
    x->r1_w2_s2 = w1_a * w2_y2 + w1_b * w2_u2;

    /* r1_w2: stage 1 */
    const real w2_u1 = w2_y2 + w2_p1_1 + w2_e1;
    const real w2_y1 = x->r1_w2_s1 + w1_b * w2_u1;
    x->r1_w2_s1 = w1_a * w2_y1 + w1_b * w2_u1;

    /* what the tolerance of el.k can do */
    const real w2 = w2_y1 - w2_e1;

    return w2;
}

/* what the tolerance of me.fe can do */
static real bound_r1_w3(const drive_as_drawn_threshold_coefficients *c,
        drive_as_drawn_threshold_memory *x, const drive_as_drawn_samples *s, bool first, real w1_a,
        real w1_b)
{
    if (first) {
        /* nothing is remembered yet */
        x->r1_w3_s3 = REAL(0.0);
        x->r1_w3_s2 = REAL(0.0);
        x->r1_w3_s1 = REAL(0.0);
    }

    /* r1_w3: terms of order 0 */
    const real w3_g0 = c->r1_w3_me__we * s->me__we;

    /* r1_w3: degree 1 */
    const real w3_d1 = c->r1_w3_w1_me__we * s->me__we;

    /* r1_w3: error of order 0 */
    const real w3_e0 = c->bend1 * w3_g0;

    /* r1_w3: the filter multiplied out */
    const real w3_p1_1 = -w3_d1 - w3_e0;

    /* r1_w3: stage 3 */
    const real w3_u3 = -w3_g0 - w3_p1_1;
    const real w3_y3 = x->r1_w3_s3 + w1_b * w3_u3;
    x->r1_w3_s3 = w1_a * w3_y3 + w1_b * w3_u3;

    /* r1_w3: stage 2 */
    const real w3_u2 = w3_y3 + w3_p1_1 - w3_e0;
    const real w3_y2 = x->r1_w3_s2 + w1_b * w3_u2;
    x->r1_w3_s2 = w1_a * w3_y2 + w1_b * w3_u2;

    /* r1_w3: stage 1 */
    const real w3_u1 = w3_y2 + w3_e0;
    const real w3_y1 = x->r1_w3_s1 + w1_b * w3_u1;
    x->r1_w3_s1 = w1_a * w3_y1 + w1_b * w3_u1;

    /* what the tolerance of me.fe can do */
    const real w3 = w3_y1;

    return w3;
}

/* what the tolerance of wh.fs can do */
static real bound_r1_w4(const drive_as_drawn_threshold_coefficients *c,
        drive_as_drawn_threshold_memory *x, const drive_as_drawn_samples *s, bool first, real w1_a,
        real w1_b)
{
    if (first) {
        /* nothing is remembered yet */
        x->r1_w4_s3 = REAL(0.0);
        x->r1_w4_s2 = REAL(0.0);
        x->r1_w4_s1 = REAL(0.0);
    }

    /* r1_w4: terms of order 0 */
    const real w4_g0 = c->r1_w4_wh__ws * s->wh__ws;

    /* r1_w4: degree 1 */
    const real w4_d1 = c->r1_w4_w1_wh__ws * s->wh__ws;

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

    /* what the tolerance of wh.fs can do */
    const real w4 = w4_y1;

    return w4;
}

/* tanh(Int(me.we)/(4*tau0) - ge.N*Int(wh.ws)/(4*tau0)) */
static real bound_r1_w5_tanh(const drive_as_drawn_threshold_coefficients *c,
        drive_as_drawn_threshold_memory *x, const drive_as_drawn_samples *s, bool first)
{
    if (first) {
        /* nothing is remembered yet */
        x->r1_w5_s3 = REAL(0.0);
        x->r1_w5_s2 = REAL(0.0);
        x->r1_w5_s1 = REAL(0.0);
    }

    /* sample_time/24 times me.we/(4*tau0) - ge.N*wh.ws/(4*tau0), what is integrated */
    const real w5_rate = c->scaled_sample_time_over_tau0 * s->me__we
        - c->scaled_N_times_sample_time_over_tau0 * s->wh__ws;

    if (first) {
        /* r1_w5: the integral is 0 at the start */
        x->r1_w5_q = -REAL(12.0) * w5_rate;
        x->r1_w5_rate1 = w5_rate;
        x->r1_w5_rate2 = w5_rate;
    }

    /* r1_w5: its integral since the start, by the rule of Adams */
    const real w5_integral = x->r1_w5_q + REAL(9.0) * w5_rate + REAL(4.0) * x->r1_w5_rate1
        - x->r1_w5_rate2;
    x->r1_w5_q = x->r1_w5_q + REAL(24.0) * w5_rate;
    x->r1_w5_rate2 = x->r1_w5_rate1;
    x->r1_w5_rate1 = w5_rate;

    /* tanh(Int(me.we)/(4*tau0) - ge.N*Int(wh.ws)/(4*tau0)) */
    const real w5_tanh = near_tanh(w5_integral);

    return w5_tanh;
}

/* what the tolerances of el.Re and el.k can do together */
static real bound_r1_w5(const drive_as_drawn_threshold_coefficients *c,
        drive_as_drawn_threshold_memory *x, const drive_as_drawn_samples *s, real w1_a, real w1_b,
        real w5_tanh)
{
    /* r1_w5: terms of order 0 */
    const real w5_g0 = c->r1_w5_me__we * s->me__we + c->r1_w5_wh__ws * s->wh__ws
        + c->r1_w5_Fx * s->Fx - c->r1_w5_tanh * w5_tanh;

    /* r1_w5: degree 1 */
    const real w5_d1 = c->r1_w5_w1_me__we * s->me__we + c->r1_w5_w1_wh__ws * s->wh__ws;

    /* r1_w5: error of order 0 */
    const real w5_e0 = c->bend1 * w5_g0;

    /* r1_w5: the filter multiplied out */
    const real w5_p1_1 = w5_d1 + w5_e0;

    /* r1_w5: stage 3 */
    const real w5_u3 = w5_g0 - w5_p1_1;
    const real w5_y3 = x->r1_w5_s3 + w1_b * w5_u3;
    x->r1_w5_s3 = w1_a * w5_y3 + w1_b * w5_u3;

    /* r1_w5: stage 2 */
    const real w5_u2 = w5_y3 + w5_p1_1 + w5_e0;
    const real w5_y2 = x->r1_w5_s2 + w1_b * w5_u2;
    x->r1_w5_s2 = w1_a * w5_y2 + w1_b * w5_u2;

    /* r1_w5: stage 1 */
    const real w5_u1 = w5_y2 - w5_e0;
    const real w5_y1 = x->r1_w5_s1 + w1_b * w5_u1;
    x->r1_w5_s1 = w1_a * w5_y1 + w1_b * w5_u1;

    /* what the tolerances of el.Re and el.k can do together */
    const real w5 = w5_y1;

    return w5;
}

/* what the tolerances of el.Re and me.fe can do together */
static real bound_r1_w6(const drive_as_drawn_threshold_coefficients *c,
        drive_as_drawn_threshold_memory *x, const drive_as_drawn_samples *s, bool first, real w1_a,
        real w1_b)
{
    if (first) {
        /* nothing is remembered yet */
        x->r1_w6_s3 = REAL(0.0);
        x->r1_w6_s2 = REAL(0.0);
        x->r1_w6_s1 = REAL(0.0);
    }

    /* r1_w6: stage 3 */
    const real w6_u3 = -c->r1_w6_me__we * s->me__we;
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

    /* what the tolerances of el.Re and me.fe can do together */
    const real w6 = w6_y1;

    return w6;
}

/* what the tolerances of el.Re and wh.fs can do together */
static real bound_r1_w7(const drive_as_drawn_threshold_coefficients *c,
        drive_as_drawn_threshold_memory *x, const drive_as_drawn_samples *s, bool first, real w1_a,
        real w1_b)
{
    if (first) {
        /* nothing is remembered yet */
        x->r1_w7_s3 = REAL(0.0);
        x->r1_w7_s2 = REAL(0.0);
        x->r1_w7_s1 = REAL(0.0);
    }

    /* r1_w7: stage 3 */
    const real w7_u3 = -c->r1_w7_wh__ws * s->wh__ws;
    const real w7_y3 = x->r1_w7_s3 + w1_b * w7_u3;
    x->r1_w7_s3 = w1_a * w7_y3 + w1_b * w7_u3;

    /* r1_w7: stage 2 */
    const real w7_u2 = w7_y3;
    const real w7_y2 = x->r1_w7_s2 + w1_b * w7_u2;
    x->r1_w7_s2 = w1_a * w7_y2 + w1_b * w7_u2;

    /* r1_w7: stage 1 */
    const real w7_u1 = w7_y2;
    const real w7_y1 = x->r1_w7_s1 + w1_b * w7_u1;
    x->r1_w7_s1 = w1_a * w7_y1 + w1_b * w7_u1;

    /* what the tolerances of el.Re and wh.fs can do together */
    const real w7 = w7_y1;

    return w7;
}

/* tanh(Int(me.we)/(4*tau0) - ge.N*Int(wh.ws)/(4*tau0)) */
static real bound_r1_w8_tanh(const drive_as_drawn_threshold_coefficients *c,
        drive_as_drawn_threshold_memory *x, const drive_as_drawn_samples *s, bool first)
{
    if (first) {
        /* nothing is remembered yet */
        x->r1_w8_s3 = REAL(0.0);
        x->r1_w8_s2 = REAL(0.0);
        x->r1_w8_s1 = REAL(0.0);
    }

    /* sample_time/24 times me.we/(4*tau0) - ge.N*wh.ws/(4*tau0), what is integrated */
    const real w8_rate = c->scaled_sample_time_over_tau0 * s->me__we
        - c->scaled_N_times_sample_time_over_tau0 * s->wh__ws;

    if (first) {
        /* r1_w8: the integral is 0 at the start */
        x->r1_w8_q = -REAL(12.0) * w8_rate;
        x->r1_w8_rate1 = w8_rate;
        x->r1_w8_rate2 = w8_rate;
    }

    /* r1_w8: its integral since the start, by the rule of Adams */
    const real w8_integral = x->r1_w8_q + REAL(9.0) * w8_rate + REAL(4.0) * x->r1_w8_rate1
        - x->r1_w8_rate2;
    x->r1_w8_q = x->r1_w8_q + REAL(24.0) * w8_rate;
    x->r1_w8_rate2 = x->r1_w8_rate1;
    x->r1_w8_rate1 = w8_rate;

    /* tanh(Int(me.we)/(4*tau0) - ge.N*Int(wh.ws)/(4*tau0)) */
    const real w8_tanh = near_tanh(w8_integral);

    return w8_tanh;
}

/* second order of what the tolerance of el.k can do */
static real bound_r1_w8(const drive_as_drawn_threshold_coefficients *c,
        drive_as_drawn_threshold_memory *x, const drive_as_drawn_samples *s, real w1_a, real w1_b,
        real w8_tanh)
{
    /* r1_w8: terms of order 0 */
    const real w8_g0 = c->r1_w8_tanh * w8_tanh - c->r1_w8_wh__ws * s->wh__ws - c->r1_w8_Fx * s->Fx
        - c->r1_w8_me__we * s->me__we;

    /* r1_w8: terms of order 1 */
    const real w8_g1 = c->r1_w8_w1_tanh * w8_tanh + c->r1_w8_w1_wh__ws * s->wh__ws
        + c->r1_w8_w1_me__we * s->me__we - c->r1_w8_w1_Fx * s->Fx;

    /* r1_w8: error of order 0 */
    const real w8_e0 = c->bend2 * w8_g0;

    /* r1_w8: degree 2 */
    const real w8_d2 = c->r1_w8_w2_wh__ws * s->wh__ws + c->r1_w8_w2_me__we * s->me__we + w8_e0;

    /* r1_w8: error of order 1 */
    const real w8_e1 = c->bend1 * w8_g1;

    /* r1_w8: the filter multiplied out */
    const real w8_p2_1 = w8_e1 - w8_d2;
    const real w8_p1_1 = w8_p2_1 + w8_e1;
    const real w8_p1_2 = w8_g1 - w8_p2_1;

    /* r1_w8: stage 3 */
    const real w8_u3 = w8_g0 - w8_p1_2;
    const real w8_y3 = x->r1_w8_s3 + w1_b * w8_u3;
    x->r1_w8_s3 = w1_a * w8_y3 + w1_b * w8_u3;

    /* r1_w8: stage 2 */
    const real w8_u2 = w8_y3 + w8_p1_2 - w8_p1_1;
    const real w8_y2 = x->r1_w8_s2 + w1_b * w8_u2;
    x->r1_w8_s2 = w1_a * w8_y2 + w1_b * w8_u2;

    /* r1_w8: stage 1 */
    const real w8_u1 = w8_y2 + w8_p1_1 + w8_e1;
    const real w8_y1 = x->r1_w8_s1 + w1_b * w8_u1;
    x->r1_w8_s1 = w1_a * w8_y1 + w1_b * w8_u1;

    /* second order of what the tolerance of el.k can do */
    const real w8 = w8_y1 - w8_e1;

    return w8;
}

/* what the tolerances of el.k and me.fe can do together */
static real bound_r1_w9(const drive_as_drawn_threshold_coefficients *c,
        drive_as_drawn_threshold_memory *x, const drive_as_drawn_samples *s, bool first, real w1_a,
        real w1_b)
{
    if (first) {
        /* nothing is remembered yet */
        x->r1_w9_s3 = REAL(0.0);
        x->r1_w9_s2 = REAL(0.0);
        x->r1_w9_s1 = REAL(0.0);
    }

    /* r1_w9: terms of order 0 */
    const real w9_g0 = c->r1_w9_me__we * s->me__we;

    /* r1_w9: degree 1 */
    const real w9_d1 = c->r1_w9_w1_me__we * s->me__we;

    /* r1_w9: error of order 0 */
    const real w9_e0 = c->bend1 * w9_g0;

    /* r1_w9: the filter multiplied out */
    const real w9_p1_1 = w9_d1 + w9_e0;

    /* r1_w9: stage 3 */
    const real w9_u3 = w9_g0 - w9_p1_1;
    const real w9_y3 = x->r1_w9_s3 + w1_b * w9_u3;
    x->r1_w9_s3 = w1_a * w9_y3 + w1_b * w9_u3;

    /* r1_w9: stage 2 */
    const real w9_u2 = w9_y3 + w9_p1_1 + w9_e0;
    const real w9_y2 = x->r1_w9_s2 + w1_b * w9_u2;
    x->r1_w9_s2 = w1_a * w9_y2 + w1_b * w9_u2;

    /* r1_w9: stage 1 */
    const real w9_u1 = w9_y2 - w9_e0;
    const real w9_y1 = x->r1_w9_s1 + w1_b * w9_u1;
    x->r1_w9_s1 = w1_a * w9_y1 + w1_b * w9_u1;

    /* what the tolerances of el.k and me.fe can do together */
    const real w9 = w9_y1;

    return w9;
}

/* what the tolerances of el.k and wh.fs can do together */
static real bound_r1_w10(const drive_as_drawn_threshold_coefficients *c,
        drive_as_drawn_threshold_memory *x, const drive_as_drawn_samples *s, bool first, real w1_a,
        real w1_b)
{
    if (first) {
        /* nothing is remembered yet */
        x->r1_w10_s3 = REAL(0.0);
        x->r1_w10_s2 = REAL(0.0);
        x->r1_w10_s1 = REAL(0.0);
    }

    /* r1_w10: terms of order 0 */
    const real w10_g0 = c->r1_w10_wh__ws * s->wh__ws;

    /* r1_w10: degree 1 */
    const real w10_d1 = c->r1_w10_w1_wh__ws * s->wh__ws;

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

    /* what the tolerances of el.k and wh.fs can do together */
    const real w10 = w10_y1;

    return w10;
}

/* r1 on one sample.
 * khepera.bg:17: r1: how far r1 can be from zero if no parameter is out of tolerance */
static void bound_r1(
    const drive_as_drawn_threshold_coefficients *c, drive_as_drawn_threshold_memory *x, const drive_as_drawn_samples *s, real *r)
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

    /* sample_time/24 times me.we/(4*tau0) - ge.N*wh.ws/(4*tau0), what is integrated */
    const real w1_rate = c->scaled_sample_time_over_tau0 * s->me__we
        - c->scaled_N_times_sample_time_over_tau0 * s->wh__ws;

    const real w1_integral = bound_r1_w1_integral(x, first, w1_rate);

    /* tanh(Int(me.we)/(4*tau0) - ge.N*Int(wh.ws)/(4*tau0)) */
    const real w1_tanh = near_tanh(w1_integral);

    const real w1 = bound_r1_w1(c, x, s, w1_a, w1_b, w1_tanh);

    if (first) {
        /* nothing is remembered yet */
        x->r1_w2_s3 = REAL(0.0);
        x->r1_w2_s2 = REAL(0.0);
        x->r1_w2_s1 = REAL(0.0);
    }

    /* sample_time/24 times me.we/(4*tau0) - ge.N*wh.ws/(4*tau0), what is integrated */
    const real w2_rate = c->scaled_sample_time_over_tau0 * s->me__we
        - c->scaled_N_times_sample_time_over_tau0 * s->wh__ws;

    const real w2_integral = bound_r1_w2_integral(x, first, w2_rate);

    /* tanh(Int(me.we)/(4*tau0) - ge.N*Int(wh.ws)/(4*tau0)) */
    const real w2_tanh = near_tanh(w2_integral);

    const real w2 = bound_r1_w2(c, x, s, w1_a, w1_b, w2_tanh);
    const real w3 = bound_r1_w3(c, x, s, first, w1_a, w1_b);
    const real w4 = bound_r1_w4(c, x, s, first, w1_a, w1_b);
    const real w5_tanh = bound_r1_w5_tanh(c, x, s, first);
    const real w5 = bound_r1_w5(c, x, s, w1_a, w1_b, w5_tanh);
    const real w6 = bound_r1_w6(c, x, s, first, w1_a, w1_b);
    const real w7 = bound_r1_w7(c, x, s, first, w1_a, w1_b);
    const real w8_tanh = bound_r1_w8_tanh(c, x, s, first);
    const real w8 = bound_r1_w8(c, x, s, w1_a, w1_b, w8_tanh);
    const real w9 = bound_r1_w9(c, x, s, first, w1_a, w1_b);
    const real w10 = bound_r1_w10(c, x, s, first, w1_a, w1_b);

    r[DRIVE_AS_DRAWN_R1] = MATH(fabs)(w1) + MATH(fabs)(w2) + MATH(fabs)(w3) + MATH(fabs)(w4)
        + MATH(fabs)(w5) + MATH(fabs)(w6) + MATH(fabs)(w7) + MATH(fabs)(w8) + MATH(fabs)(w9)
        + MATH(fabs)(w10);
}

/* r2 on one sample.
 * khepera.bg:41: r2: how far r2 can be from zero if no parameter is out of tolerance */
static void bound_r2(
    const drive_as_drawn_threshold_coefficients *c, drive_as_drawn_threshold_memory *x, const drive_as_drawn_samples *s, real *r)
{
    (void)c;
    (void)x;
    (void)s;

    r[DRIVE_AS_DRAWN_R2] = REAL(0.0);
}

/* Ages and validity one by one: a number that is not finite makes the next sample the first. */
static void bound_count_samples(
    const drive_as_drawn_threshold_coefficients *c,
    drive_as_drawn_threshold_memory *x,
    drive_as_drawn_residuals *out)
{
    /* the thresholds that are computed, and what each one goes with */
    static const uint8_t number[] = {
        0, 1
    };
    static const uint8_t part[] = {
        0, 1
    };
    bool finite[2];
    int k;

    finite[0] = true;
    finite[1] = true;
    for (k = 0; k < 2; ++k) {
        finite[part[k]] = finite[part[k]] && finite_number(out->value[number[k]]);
    }
    x->youngest = UINT32_MAX;
    for (k = 0; k < 2; ++k) {
        x->age[k] = finite[k] ? x->age[k] + (x->age[k] < UINT32_MAX ? 1u : 0u) : 0u;
        x->youngest = x->age[k] < x->youngest ? x->age[k] : x->youngest;
    }
    for (k = 0; k < 2; ++k) {
        out->value[number[k]] = finite[part[k]] ? out->value[number[k]] : REAL(0.0);
        out->valid[number[k]] = x->age[part[k]] > c->settle[number[k]];
    }
}

void drive_as_drawn_threshold_reset(drive_as_drawn_threshold_memory *memory)
{
    int k;

    for (k = 0; k < 2; ++k) {
        memory->age[k] = 0u;
    }
    memory->youngest = 0u;
}

void drive_as_drawn_threshold_step(
    const drive_as_drawn_threshold_coefficients *coefficients,
    drive_as_drawn_threshold_memory *memory,
    const drive_as_drawn_samples *samples,
    drive_as_drawn_residuals *thresholds)
{
    const drive_as_drawn_threshold_coefficients *c = coefficients;
    drive_as_drawn_threshold_memory *x = memory;
    const drive_as_drawn_samples *s = samples;
    real *r = thresholds->value;
    int k;

    bound_r1(c, x, s, r);
    bound_r2(c, x, s, r);
    /* a sum is finite only if all its terms are */
    if (x->youngest > c->longest && finite_number(r[DRIVE_AS_DRAWN_R1] + r[DRIVE_AS_DRAWN_R2])) {
        for (k = 0; k < DRIVE_AS_DRAWN_RESIDUALS; ++k) {
            thresholds->valid[k] = true;
        }
    } else {
        bound_count_samples(c, x, thresholds);
    }
}

#endif

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

/*
 * Signatures: the faults of class c are seen by the residuals of entries first_entry[c] and up to
 * first_entry[c + 1].
 */
static const uint32_t first_entry[DRIVE_AS_DRAWN_CLASSES + 1] = {
    0u, 2u, 3u, 5u,
};

static const uint16_t seen_by[5] = {
    0u, 1u, 0u, 0u, 1u,
};

/*
 * Sizes of faults in eighths of an octave: a residual in alarm makes a fault so much larger than
 * what is least here as it is out.
 */
static const uint8_t least_size[5] = {
    1u, 1u, 1u, 1u, 1u,
};

/* A residual is sure to show a fault of this size; 255: of no size. */
static const uint8_t sure_size[5] = {
    0u, 0u, 0u, 0u, 255u,
};

/* The peak of residual k since it went into alarm, beside what is sure to be one. */
static void remember_peak(
    drive_as_drawn_diagnosis *d, const drive_as_drawn_limit *limit, int k, real out, real bound)
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
static int size_of(const drive_as_drawn_diagnosis *d, int c, int alarms)
{
    const uint32_t begin = first_entry[c];
    const uint32_t end = first_entry[c + 1];
    int size = 0;
    int seen = 0;
    uint32_t i;

    for (i = begin; i < end; ++i) {
        const int k = (int)seen_by[i];

        if (d->state[k] == DRIVE_AS_DRAWN_ALARM) {
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
static drive_as_drawn_candidate left_of(const drive_as_drawn_diagnosis *d, int c, int alarms)
{
    const uint32_t begin = first_entry[c];
    const uint32_t end = first_entry[c + 1];
    const int size = size_of(d, c, alarms);
    uint32_t i;

    if (size < 0) {
        return DRIVE_AS_DRAWN_RULED_OUT;
    }
    if (d->settled < d->window) {
        return DRIVE_AS_DRAWN_LIKELY; /* too soon for what is quiet to say anything */
    }
    for (i = begin; i < end; ++i) {
        const int k = (int)seen_by[i];
        const int sure = (int)sure_size[i];

        if (d->state[k] == DRIVE_AS_DRAWN_HEALTHY && sure != 255 && sure <= size) {
            return DRIVE_AS_DRAWN_SMALL;
        }
    }
    return DRIVE_AS_DRAWN_LIKELY;
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

/* How far a residual is beyond its bound; off: from its mean. */
static real excess(real off, real bound)
{
#if defined __GNUC__ && !defined DRIVE_AS_DRAWN_REAL
    return MATH(__builtin_fabs)(off) - bound; /* one instruction, no library */
#else
    return (off < REAL(0.0) ? -off : off) - bound;
#endif
}

static bool is_within(const drive_as_drawn_limit *limit, real value, real bound)
{
    return excess(value - limit->mean, bound) <= limit->level;
}

/* Residual k in one sample; whether it goes into alarm. */
static bool watch(
    drive_as_drawn_diagnosis *d, const drive_as_drawn_limit *limit, int k, real value, real bound, bool row)
{
    const real off = value - limit->mean;
    const real out = excess(off, bound);
    bool high = false;

    if (row) {
        high = add_row(d, limit, k, off, out, bound);
    }
    if (d->state[k] == DRIVE_AS_DRAWN_ALARM) {
        d->since[k] += d->since[k] < UINT32_MAX ? 1u : 0u;
        remember_peak(d, limit, k, out, bound);
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
    d->peak[k] = REAL(0.0);
    remember_peak(d, limit, k, out, bound);
    return true;
}

/* Which classes of faults the residuals leave, and the one if it is one. */
static void judge(drive_as_drawn_diagnosis *d)
{
    int likely = 0;
    int alarms = 0;
    int c;
    int k;

    for (k = 0; k < DRIVE_AS_DRAWN_RESIDUALS; ++k) {
        alarms += d->state[k] == DRIVE_AS_DRAWN_ALARM ? 1 : 0;
    }
    d->fault_class = DRIVE_AS_DRAWN_UNKNOWN;
    for (c = 0; c < DRIVE_AS_DRAWN_CLASSES; ++c) {
        const drive_as_drawn_candidate left = left_of(d, c, alarms);

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
        diagnosis->peak[k] = REAL(0.0);
        forget_sums(diagnosis, k);
    }
    for (k = 0; k < DRIVE_AS_DRAWN_CLASSES; ++k) {
        diagnosis->candidate[k] = DRIVE_AS_DRAWN_RULED_OUT;
    }
    diagnosis->fault_class = DRIVE_AS_DRAWN_UNKNOWN;
    diagnosis->quiet = 0u;
    diagnosis->settled = 0u;
    diagnosis->calm = false;
}

void drive_as_drawn_diagnosis_reset(drive_as_drawn_diagnosis *diagnosis)
{
    int k;

    diagnosis->row = DRIVE_AS_DRAWN_ROW;
    diagnosis->least = 15u;
    diagnosis->hold = 10u * DRIVE_AS_DRAWN_ROW;
    diagnosis->window = 300u;
    diagnosis->latch = false;
    diagnosis->tick = 0u;
    for (k = 0; k < DRIVE_AS_DRAWN_RESIDUALS; ++k) {
        diagnosis->state[k] = DRIVE_AS_DRAWN_BLIND;
    }
    drive_as_drawn_clear(diagnosis);
}

/* Whether each residual has a value within its level: nearly all samples are so. */
static bool all_within(
    const drive_as_drawn_limit *limits, const real *bounds, const drive_as_drawn_residuals *residuals)
{
    const real *value = residuals->value;
    int k;

    if (bounds != NULL) {
        for (k = 0; k < DRIVE_AS_DRAWN_RESIDUALS; ++k) {
            if (!residuals->valid[k] || !is_within(&limits[k], value[k], bounds[k])) {
                return false;
            }
        }
    } else {
        for (k = 0; k < DRIVE_AS_DRAWN_RESIDUALS; ++k) {
            if (!residuals->valid[k] || !is_within(&limits[k], value[k], limits[k].bound)) {
                return false;
            }
        }
    }
    return true;
}

/* Residual k without a value. */
static void blind(drive_as_drawn_diagnosis *d, int k)
{
    forget_sums(d, k);
    if (d->state[k] == DRIVE_AS_DRAWN_ALARM) {
        d->quiet = 0u; /* nobody knows that it is over */
    } else {
        d->state[k] = DRIVE_AS_DRAWN_BLIND;
    }
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
    if (d->calm && !row && all_within(limits, bounds, residuals)) {
        return false;
    }
    d->calm = true;
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
            blind(d, k);
        }
        d->calm = d->calm && d->state[k] == DRIVE_AS_DRAWN_HEALTHY && d->streak[k] == 0u;
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
