/* two_tanks_residuals.c: the residuals of TwoTanks; generated, see the header. */
#include "two_tanks_residuals.h"

#include <math.h>

#if defined __FINITE_MATH_ONLY__ && __FINITE_MATH_ONLY__
#error "this code tells numbers from NaN: compile it without -ffinite-math-only (-ffast-math)"
#endif

typedef two_tanks_real real;

#define REAL(x) TWO_TANKS_CONSTANT(x)
#if defined TWO_TANKS_FLOAT && !defined TWO_TANKS_REAL
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

/* sign(value) * sqrt(|value|) */
static real signed_root(real value)
{
    return value < REAL(0.0) ? -MATH(sqrt)(-value) : MATH(sqrt)(value);
}

/* The larger of two numbers. */
static real greatest(real left, real right)
{
    return right > left ? right : left;
}

uint32_t two_tanks_abi(void)
{
    return TWO_TANKS_ABI;
}

const char *two_tanks_digest(void)
{
    return TWO_TANKS_DIGEST;
}

void two_tanks_nominal(two_tanks_parameters *parameters)
{
    parameters->rho = REAL(998.0);     /* kg/m^3 */
    parameters->g = REAL(9.81);        /* m/s^2 */
    parameters->A1 = REAL(0.0154);     /* m^2 */
    parameters->A2 = REAL(0.0154);     /* m^2 */
    parameters->k12 = REAL(1.2e-06);   /* m^3/s.Pa^-0.5 */
    parameters->kout = REAL(1.0e-06);  /* m^3/s.Pa^-0.5 */
    parameters->leak = REAL(0.0);      /* m^3/s.Pa^-0.5 */
}

/* The coefficients of exact and of the filter, from the parameters. */
static void compute_coefficients(two_tanks_monitor *monitor, const two_tanks_parameters *p,
        real sample_time, real bandwidth)
{
    two_tanks_coefficients *c = &monitor->c;

    /* bandwidth*sample_time */
    const real x_ = bandwidth * sample_time;

    /* of a stage: what is left of its memory */
    const real pole = greatest(REAL(2.0) - x_, REAL(0.0)) / (x_ + REAL(2.0));

    /* w*sample_time, x or 2 */
    const real turn = REAL(2.0) * (REAL(1.0) - pole) / (pole + REAL(1.0));

    /* w of the filter 1/(1 + D/w) */
    const real w = turn / sample_time;

    /* 1 - pole */
    const real t = REAL(1.0) - pole;

    /* two_tanks.bg:16: r1: factor of ssqrt(p1): leak */
    c->r1_ssqrt = p->leak;

    /* two_tanks.bg:16: r1: factor of ssqrt(p1 - p2): k12 */
    c->r1_ssqrt_2 = p->k12;

    /* two_tanks.bg:16: r1: factor of p1': A1/(rho*g) */
    c->r1_p1_1 = p->A1 / p->rho / p->g;

    /* two_tanks.bg:16: r1: factor of p1' */
    c->r1_w1_p1 = p->A1 * w / p->rho / p->g;

    /* filter: 1 * (w*sample_time)^2/12 */
    c->bend1 = turn * turn / REAL(12.0);

    /* filter: what is left of a memory a sample later */
    c->a = pole;

    /* filter: weight of a sample, new and a sample later */
    c->b = REAL(0.5) * t;

    /* filter: 1 - b, the memory of a constant 1 */
    c->rest = REAL(1.0) - REAL(0.5) * t;

    /* two_tanks.bg:16: r2: factor of ssqrt(p2): kout */
    c->r2_ssqrt = p->kout;

    /* two_tanks.bg:16: r2: factor of p2': A2/(rho*g) */
    c->r2_p2_1 = p->A2 / p->rho / p->g;

    /* two_tanks.bg:16: r2: factor of p2' */
    c->r2_w1_p2 = p->A2 * w / p->rho / p->g;
}

static bool parameters_are_finite(const two_tanks_parameters *p)
{
    return finite_number(p->rho + p->g + p->A1 + p->A2 + p->k12 + p->kout + p->leak);
}

static bool coefficients_are_finite(const two_tanks_monitor *monitor)
{
    return finite_number(monitor->c.r1_ssqrt + monitor->c.r1_ssqrt_2 + monitor->c.r1_p1_1
            + monitor->c.r1_w1_p1 + monitor->c.bend1 + monitor->c.a + monitor->c.b + monitor->c.rest
            + monitor->c.r2_ssqrt + monitor->c.r2_p2_1 + monitor->c.r2_w1_p2);
}

/* Samples until `constants` time constants of the filter are over. */
static uint32_t samples(real constants, real sample_time, real bandwidth)
{
    const real wait = constants / (bandwidth * sample_time);
    const uint32_t whole = wait < REAL(4.0e9) ? (uint32_t)wait : UINT32_MAX - 1u;

    return (real)whole < wait ? whole + 1u : whole;
}

two_tanks_status two_tanks_configure(
    two_tanks_monitor *monitor,
    const two_tanks_parameters *parameters,
    two_tanks_real sample_time,
    two_tanks_real bandwidth,
    two_tanks_real time_unit)
{
    int k;

    for (k = 0; k < TWO_TANKS_RESIDUALS; ++k) {
        monitor->settle[k] = UINT32_MAX;
    }
    two_tanks_reset(monitor);
    if (!parameters_are_finite(parameters)) {
        return TWO_TANKS_BAD_PARAMETER;
    }
    if (!(sample_time > REAL(0.0)) || !finite_number(sample_time)) {
        return TWO_TANKS_BAD_SAMPLE_TIME;
    }
    if (!(bandwidth * sample_time >= SLOWEST && bandwidth * sample_time <= REAL(3.0))) {
        return TWO_TANKS_BAD_BANDWIDTH;
    }
    if (!(time_unit > REAL(0.0)) || !finite_number(time_unit)) {
        return TWO_TANKS_BAD_TIME_UNIT;
    }
    compute_coefficients(monitor, parameters, sample_time, bandwidth);
    if (!coefficients_are_finite(monitor)) {
        return TWO_TANKS_BAD_COEFFICIENT;
    }
    monitor->settle[TWO_TANKS_R1] = samples(REAL(9.233413476451586), sample_time, bandwidth);
    monitor->settle[TWO_TANKS_R2] = samples(REAL(9.233413476451586), sample_time, bandwidth);
    return TWO_TANKS_OK;
}

void two_tanks_exact(
    const two_tanks_monitor *monitor,
    const two_tanks_derivatives *derivatives,
    two_tanks_real residuals[TWO_TANKS_RESIDUALS])
{
    const two_tanks_coefficients *c = &monitor->c;
    const two_tanks_derivatives *d = derivatives;
    real *r = residuals;

    /* two_tanks.bg:16: r1 = Q - leak*ssqrt(p1) - k12*ssqrt(p1 - p2) - A1*D(p1)/(rho*g) */
    r[TWO_TANKS_R1] = d->Q - c->r1_ssqrt * signed_root(d->p1[0])
        - c->r1_ssqrt_2 * signed_root(d->p1[0] - d->p2[0]) - c->r1_p1_1 * d->p1[1];

    /* two_tanks.bg:16: r2 = k12*ssqrt(p1 - p2) - kout*ssqrt(p2) - A2*D(p2)/(rho*g) */
    r[TWO_TANKS_R2] = c->r1_ssqrt_2 * signed_root(d->p1[0] - d->p2[0])
        - c->r2_ssqrt * signed_root(d->p2[0]) - c->r2_p2_1 * d->p2[1];
}

/* r1 on its first sample: the filter as if it had always been so. */
static void start_r1(
    two_tanks_monitor *monitor, const two_tanks_samples *s, real *r)
{
    const two_tanks_coefficients *c = &monitor->c;
    two_tanks_memory *x = &monitor->x;

    /* two_tanks.bg:16: ssqrt(p1) */
    const real r1_ssqrt = signed_root(s->p1);

    /* two_tanks.bg:16: ssqrt(p1 - p2) */
    const real r1_ssqrt_2 = signed_root(s->p1 - s->p2);

    /* two_tanks.bg:16: r1: terms of order 0 */
    const real r1_g0 = s->Q - c->r1_ssqrt * r1_ssqrt - c->r1_ssqrt_2 * r1_ssqrt_2;

    /* two_tanks.bg:16: r1: degree 1 */
    const real r1_d1 = c->r1_w1_p1 * s->p1;

    /* two_tanks.bg:16: r1: error of order 0 */
    const real r1_e0 = c->bend1 * r1_g0;

    /* two_tanks.bg:16: r1: input of stage 2 */
    const real r1_u2 = r1_g0 + r1_d1 - r1_e0;

    /* two_tanks.bg:16: r1: stage 2, at rest */
    const real r1_y2 = r1_u2;

    /* two_tanks.bg:16: r1: stage 2: memory */
    x->r1_s2 = c->rest * r1_u2;

    /* two_tanks.bg:16: r1: input of stage 1 */
    const real r1_u1 = r1_y2 + REAL(2.0) * r1_e0 - r1_d1;

    /* two_tanks.bg:16: r1: stage 1, at rest */
    const real r1_y1 = r1_u1;

    /* two_tanks.bg:16: r1: stage 1: memory */
    x->r1_s1 = c->rest * r1_u1;

    /* two_tanks.bg:16: r1 = Q - leak*ssqrt(p1) - k12*ssqrt(p1 - p2) - A1*D(p1)/(rho*g) */
    r[TWO_TANKS_R1] = r1_y1 - r1_e0;
}

/* r1 on every further sample. */
static void next_r1(
    two_tanks_monitor *monitor, const two_tanks_samples *s, real *r)
{
    const two_tanks_coefficients *c = &monitor->c;
    two_tanks_memory *x = &monitor->x;

    /* two_tanks.bg:16: ssqrt(p1) */
    const real r1_ssqrt = signed_root(s->p1);

    /* two_tanks.bg:16: ssqrt(p1 - p2) */
    const real r1_ssqrt_2 = signed_root(s->p1 - s->p2);

    /* two_tanks.bg:16: r1: terms of order 0 */
    const real r1_g0 = s->Q - c->r1_ssqrt * r1_ssqrt - c->r1_ssqrt_2 * r1_ssqrt_2;

    /* two_tanks.bg:16: r1: degree 1 */
    const real r1_d1 = c->r1_w1_p1 * s->p1;

    /* two_tanks.bg:16: r1: error of order 0 */
    const real r1_e0 = c->bend1 * r1_g0;

    /* two_tanks.bg:16: r1: input of stage 2 */
    const real r1_u2 = r1_g0 + r1_d1 - r1_e0;

    /* two_tanks.bg:16: r1: stage 2 */
    const real r1_y2 = x->r1_s2 + c->b * r1_u2;

    /* two_tanks.bg:16: r1: stage 2: memory */
    x->r1_s2 = c->a * r1_y2 + c->b * r1_u2;

    /* two_tanks.bg:16: r1: input of stage 1 */
    const real r1_u1 = r1_y2 + REAL(2.0) * r1_e0 - r1_d1;

    /* two_tanks.bg:16: r1: stage 1 */
    const real r1_y1 = x->r1_s1 + c->b * r1_u1;

    /* two_tanks.bg:16: r1: stage 1: memory */
    x->r1_s1 = c->a * r1_y1 + c->b * r1_u1;

    /* two_tanks.bg:16: r1 = Q - leak*ssqrt(p1) - k12*ssqrt(p1 - p2) - A1*D(p1)/(rho*g) */
    r[TWO_TANKS_R1] = r1_y1 - r1_e0;
}

/* One sample for r1; a number that is not finite makes the next sample the first. */
static void run_r1(
    two_tanks_monitor *monitor, const two_tanks_samples *s, two_tanks_residuals *residuals)
{
    real *r = residuals->value;
    uint32_t age = monitor->age[0];

    if (age == 0u) {
        start_r1(monitor, s, r);
    } else {
        next_r1(monitor, s, r);
    }
    /* a sum is finite only if all its terms are */
    if (finite_number(s->Q + s->p1 + s->p2 + r[TWO_TANKS_R1])) {
        age += age < UINT32_MAX ? 1u : 0u;
    } else {
        age = 0u;
        r[TWO_TANKS_R1] = REAL(0.0);
    }
    monitor->age[0] = age;
    residuals->valid[TWO_TANKS_R1] = age > monitor->settle[TWO_TANKS_R1];
}

/* r2 on its first sample: the filter as if it had always been so. */
static void start_r2(
    two_tanks_monitor *monitor, const two_tanks_samples *s, real *r)
{
    const two_tanks_coefficients *c = &monitor->c;
    two_tanks_memory *x = &monitor->x;

    /* two_tanks.bg:16: ssqrt(p2) */
    const real r2_ssqrt = signed_root(s->p2);

    /* two_tanks.bg:16: ssqrt(p1 - p2) */
    const real r2_ssqrt_2 = signed_root(s->p1 - s->p2);

    /* two_tanks.bg:16: r2: terms of order 0 */
    const real r2_g0 = c->r1_ssqrt_2 * r2_ssqrt_2 - c->r2_ssqrt * r2_ssqrt;

    /* two_tanks.bg:16: r2: degree 1 */
    const real r2_d1 = c->r2_w1_p2 * s->p2;

    /* two_tanks.bg:16: r2: error of order 0 */
    const real r2_e0 = c->bend1 * r2_g0;

    /* two_tanks.bg:16: r2: input of stage 2 */
    const real r2_u2 = r2_g0 + r2_d1 - r2_e0;

    /* two_tanks.bg:16: r2: stage 2, at rest */
    const real r2_y2 = r2_u2;

    /* two_tanks.bg:16: r2: stage 2: memory */
    x->r2_s2 = c->rest * r2_u2;

    /* two_tanks.bg:16: r2: input of stage 1 */
    const real r2_u1 = r2_y2 + REAL(2.0) * r2_e0 - r2_d1;

    /* two_tanks.bg:16: r2: stage 1, at rest */
    const real r2_y1 = r2_u1;

    /* two_tanks.bg:16: r2: stage 1: memory */
    x->r2_s1 = c->rest * r2_u1;

    /* two_tanks.bg:16: r2 = k12*ssqrt(p1 - p2) - kout*ssqrt(p2) - A2*D(p2)/(rho*g) */
    r[TWO_TANKS_R2] = r2_y1 - r2_e0;
}

/* r2 on every further sample. */
static void next_r2(
    two_tanks_monitor *monitor, const two_tanks_samples *s, real *r)
{
    const two_tanks_coefficients *c = &monitor->c;
    two_tanks_memory *x = &monitor->x;

    /* two_tanks.bg:16: ssqrt(p2) */
    const real r2_ssqrt = signed_root(s->p2);

    /* two_tanks.bg:16: ssqrt(p1 - p2) */
    const real r2_ssqrt_2 = signed_root(s->p1 - s->p2);

    /* two_tanks.bg:16: r2: terms of order 0 */
    const real r2_g0 = c->r1_ssqrt_2 * r2_ssqrt_2 - c->r2_ssqrt * r2_ssqrt;

    /* two_tanks.bg:16: r2: degree 1 */
    const real r2_d1 = c->r2_w1_p2 * s->p2;

    /* two_tanks.bg:16: r2: error of order 0 */
    const real r2_e0 = c->bend1 * r2_g0;

    /* two_tanks.bg:16: r2: input of stage 2 */
    const real r2_u2 = r2_g0 + r2_d1 - r2_e0;

    /* two_tanks.bg:16: r2: stage 2 */
    const real r2_y2 = x->r2_s2 + c->b * r2_u2;

    /* two_tanks.bg:16: r2: stage 2: memory */
    x->r2_s2 = c->a * r2_y2 + c->b * r2_u2;

    /* two_tanks.bg:16: r2: input of stage 1 */
    const real r2_u1 = r2_y2 + REAL(2.0) * r2_e0 - r2_d1;

    /* two_tanks.bg:16: r2: stage 1 */
    const real r2_y1 = x->r2_s1 + c->b * r2_u1;

    /* two_tanks.bg:16: r2: stage 1: memory */
    x->r2_s1 = c->a * r2_y1 + c->b * r2_u1;

    /* two_tanks.bg:16: r2 = k12*ssqrt(p1 - p2) - kout*ssqrt(p2) - A2*D(p2)/(rho*g) */
    r[TWO_TANKS_R2] = r2_y1 - r2_e0;
}

/* One sample for r2; a number that is not finite makes the next sample the first. */
static void run_r2(
    two_tanks_monitor *monitor, const two_tanks_samples *s, two_tanks_residuals *residuals)
{
    real *r = residuals->value;
    uint32_t age = monitor->age[1];

    if (age == 0u) {
        start_r2(monitor, s, r);
    } else {
        next_r2(monitor, s, r);
    }
    /* a sum is finite only if all its terms are */
    if (finite_number(s->p1 + s->p2 + r[TWO_TANKS_R2])) {
        age += age < UINT32_MAX ? 1u : 0u;
    } else {
        age = 0u;
        r[TWO_TANKS_R2] = REAL(0.0);
    }
    monitor->age[1] = age;
    residuals->valid[TWO_TANKS_R2] = age > monitor->settle[TWO_TANKS_R2];
}

void two_tanks_reset(two_tanks_monitor *monitor)
{
    int k;

    for (k = 0; k < 2; ++k) {
        monitor->age[k] = 0u;
    }
}

void two_tanks_step(
    two_tanks_monitor *monitor,
    const two_tanks_samples *samples,
    two_tanks_residuals *residuals)
{
    run_r1(monitor, samples, residuals);
    run_r2(monitor, samples, residuals);
}

const char two_tanks_fault_name[TWO_TANKS_FAULTS][5] = {
    "A1", "leak", "Q", "k12", "p1", "p2", "A2", "kout",
};

const uint16_t two_tanks_fault_class[TWO_TANKS_FAULTS] = {
    0u, 0u, 0u, 1u, 1u, 1u, 2u, 2u,
};

const char two_tanks_residual_name[TWO_TANKS_RESIDUALS][3] = {
    "r1", "r2",
};

/* Signatures: 1 where a residual may be moved by the faults of a class, 3 where it is for sure. */
static const uint8_t signature[TWO_TANKS_CLASSES][TWO_TANKS_RESIDUALS] = {
    {3u, 0u},
    {3u, 3u},
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
    two_tanks_diagnosis *d, const two_tanks_limit *limit, int k, real off, real out, real bound)
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

static bool sums_are_zero(const two_tanks_diagnosis *d, int k)
{
    const real sum = d->above[k] + d->below[k] + d->louder[k];

    return !(sum > REAL(0.0));
}

static void forget_sums(two_tanks_diagnosis *d, int k)
{
    d->above[k] = REAL(0.0);
    d->below[k] = REAL(0.0);
    d->louder[k] = REAL(0.0);
    d->streak[k] = 0u;
}

/* Residual k in one sample; whether it goes into alarm. */
static bool watch(
    two_tanks_diagnosis *d, const two_tanks_limit *limit, int k, real value, real bound, bool row)
{
    const real off = value - limit->mean;
    const real out = (off < REAL(0.0) ? -off : off) - bound;
    bool high = false;

    if (row) {
        high = add_row(d, limit, k, off, out, bound);
    }
    if (d->state[k] == TWO_TANKS_ALARM) {
        d->since[k] += d->since[k] < UINT32_MAX ? 1u : 0u;
        if (!(out < RELEASE * limit->level) || !sums_are_zero(d, k)) {
            d->quiet = 0u;
        }
        return false;
    }
    d->state[k] = TWO_TANKS_HEALTHY;
    d->streak[k] = out > limit->level ? d->streak[k] + 1u : 0u;
    if (d->streak[k] < d->least && !high) {
        return false;
    }
    d->state[k] = TWO_TANKS_ALARM;
    d->since[k] = 0u;
    return true;
}

/* What is left of a class of faults. */
static two_tanks_candidate left_of(const two_tanks_diagnosis *d, const uint8_t *own)
{
    two_tanks_candidate found = TWO_TANKS_LIKELY;
    int k;

    for (k = 0; k < TWO_TANKS_RESIDUALS; ++k) {
        if (d->state[k] == TWO_TANKS_ALARM && own[k] == 0u) {
            return TWO_TANKS_RULED_OUT;
        }
        if (d->state[k] == TWO_TANKS_HEALTHY && own[k] == 3u) {
            found = TWO_TANKS_SMALL;
        }
    }
    return found;
}

/* Which classes of faults the residuals leave, and the one if it is one. */
static void judge(two_tanks_diagnosis *d)
{
    int likely = 0;
    int c;

    d->fault_class = TWO_TANKS_UNKNOWN;
    for (c = 0; c < TWO_TANKS_CLASSES; ++c) {
        const two_tanks_candidate left = left_of(d, signature[c]);

        d->candidate[c] = (uint8_t)left;
        if (left == TWO_TANKS_LIKELY) {
            d->fault_class = (int16_t)c;
            ++likely;
        }
    }
    if (likely != 1 || d->settled < 2u * d->row) {
        d->fault_class = TWO_TANKS_UNKNOWN;
    }
}

two_tanks_limit two_tanks_limit_of(two_tanks_real level)
{
    two_tanks_limit limit;

    limit.mean = REAL(0.0);
    limit.level = level;
    limit.unit = REAL(0.0);
    limit.loud = REAL(0.0);
    limit.drift = REAL(0.5);
    limit.height = NEVER;
    limit.bound = REAL(0.0);
    return limit;
}

void two_tanks_clear(two_tanks_diagnosis *diagnosis)
{
    int k;

    for (k = 0; k < TWO_TANKS_RESIDUALS; ++k) {
        if (diagnosis->state[k] == TWO_TANKS_ALARM) {
            diagnosis->state[k] = TWO_TANKS_HEALTHY;
        }
        diagnosis->since[k] = 0u;
        forget_sums(diagnosis, k);
    }
    for (k = 0; k < TWO_TANKS_CLASSES; ++k) {
        diagnosis->candidate[k] = TWO_TANKS_RULED_OUT;
    }
    diagnosis->fault_class = TWO_TANKS_UNKNOWN;
    diagnosis->quiet = 0u;
    diagnosis->settled = 0u;
}

void two_tanks_diagnosis_reset(two_tanks_diagnosis *diagnosis)
{
    int k;

    diagnosis->row = TWO_TANKS_ROW;
    diagnosis->least = 15u;
    diagnosis->hold = 10u * TWO_TANKS_ROW;
    diagnosis->latch = false;
    diagnosis->tick = 0u;
    for (k = 0; k < TWO_TANKS_RESIDUALS; ++k) {
        diagnosis->state[k] = TWO_TANKS_BLIND;
    }
    two_tanks_clear(diagnosis);
}

bool two_tanks_diagnose(
    two_tanks_diagnosis *diagnosis,
    const two_tanks_limit *limits,
    const two_tanks_real *bounds,
    const two_tanks_residuals *residuals)
{
    two_tanks_diagnosis *d = diagnosis;
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
    for (k = 0; k < TWO_TANKS_RESIDUALS; ++k) {
        if (residuals->valid[k]) {
            const real bound = bounds ? bounds[k] : limits[k].bound;

            fresh = watch(d, &limits[k], k, residuals->value[k], bound, row) || fresh;
        } else {
            forget_sums(d, k);
            if (d->state[k] == TWO_TANKS_ALARM) {
                d->quiet = 0u; /* nobody knows that it is over */
            } else {
                d->state[k] = TWO_TANKS_BLIND;
            }
        }
        alarm = alarm || d->state[k] == TWO_TANKS_ALARM;
    }
    if (fresh) {
        d->quiet = 0u;
        d->settled = 0u;
    }
    if (alarm && !d->latch && d->quiet >= d->hold) {
        two_tanks_clear(d);
        return false;
    }
    if (fresh || (alarm && row)) {
        judge(d);
    }
    return alarm;
}
