/* microphone_residuals.c: the residuals of Microphone; generated, see the header. */
#include "microphone_residuals.h"


#if defined __FINITE_MATH_ONLY__ && __FINITE_MATH_ONLY__
#error "this code tells numbers from NaN: compile it without -ffinite-math-only (-ffast-math)"
#endif

typedef microphone_real real;

#define REAL(x) MICROPHONE_CONSTANT(x)
#if defined MICROPHONE_FLOAT && !defined MICROPHONE_REAL
#define SLOWEST REAL(0.0001)
#else
#define SLOWEST REAL(1.0e-09)
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

uint32_t microphone_abi(void)
{
    return MICROPHONE_ABI;
}

const char *microphone_digest(void)
{
    return MICROPHONE_DIGEST;
}

void microphone_nominal(microphone_parameters *parameters)
{
    parameters->eps = REAL(8.8541878128e-12);  /* F/m */
    parameters->A = REAL(0.0001);              /* m^2 */
    parameters->R = REAL(10000000.0);          /* Ohm */
    parameters->m = REAL(1.0e-06);             /* kg */
    parameters->b = REAL(0.002);               /* N.s/m */
    parameters->k = REAL(5000.0);              /* N/m */
    parameters->x0 = REAL(2.0e-05);            /* m */
}

/* The coefficients of exact and of the filter, from the parameters. */
static void compute_coefficients(microphone_monitor *monitor, const microphone_parameters *p,
        real sample_time, real bandwidth)
{
    microphone_coefficients *c = &monitor->c;

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

    /* microphone.bg:17: mic.mech.q0 */
    c->mic__mech__q0 = p->x0;

    /* microphone.bg:17: r1: factor of U0: 1/R */
    c->r1_U0 = REAL(1.0) / p->R;

    /* microphone.bg:17: r1: factor of D(u/(mic.mech.q0 + Int(v))): eps*A */
    c->r1_product_1 = p->eps * p->A;

    /* half the sample time */
    c->half_time = REAL(0.5) * sample_time;

    /* sample_time/24 */
    c->half_twelfth = sample_time / REAL(24.0);

    /* microphone.bg:17: r1: factor of D(u/(mic.mech.q0 + Int(v))) */
    c->r1_w1_product = p->eps * p->A * w;

    /* filter: 1 * (w*sample_time)^2/12 */
    c->bend1 = turn * turn / REAL(12.0);

    /* filter: what is left of a memory a sample later */
    c->a = pole;

    /* filter: weight of a sample, new and a sample later */
    c->b = REAL(0.5) * t;

    /* filter: 1 - b, the memory of a constant 1 */
    c->rest = REAL(1.0) - REAL(0.5) * t;

    /* microphone.bg:29: r2: factor of pressure: A */
    c->r2_pressure = p->A;

    /* microphone.bg:29: r2: factor of Int(v): k */
    c->r2_v_int = p->k;

    /* microphone.bg:29: r2: factor of v: b */
    c->r2_v = p->b;

    /* microphone.bg:29: r2: factor of v': m */
    c->r2_v_1 = p->m;

    /* microphone.bg:29: r2: factor of u^2/(mic.mech.q0 + Int(v))^2: eps*A/2 */
    c->r2_product = REAL(0.5) * p->eps * p->A;

    /* filter: w*sample_time^2/12 */
    c->bend_int = sample_time * sample_time * w / REAL(12.0);
}

static bool parameters_are_finite(const microphone_parameters *p)
{
    return finite_number(p->eps + p->A + p->R + p->m + p->b + p->k + p->x0);
}

static bool coefficients_are_finite(const microphone_monitor *monitor)
{
    return finite_number(monitor->c.mic__mech__q0 + monitor->c.r1_U0 + monitor->c.r1_product_1
            + monitor->c.half_time + monitor->c.half_twelfth + monitor->c.r1_w1_product
            + monitor->c.bend1 + monitor->c.a + monitor->c.b + monitor->c.rest
            + monitor->c.r2_pressure + monitor->c.r2_v_int + monitor->c.r2_v + monitor->c.r2_v_1
            + monitor->c.r2_product + monitor->c.bend_int);
}

/* Samples until `constants` time constants of the filter are over. */
static uint32_t samples(real constants, real sample_time, real bandwidth)
{
    const real wait = constants / (bandwidth * sample_time);
    const uint32_t whole = wait < REAL(4.0e9) ? (uint32_t)wait : UINT32_MAX - 1u;

    return (real)whole < wait ? whole + 1u : whole;
}

microphone_status microphone_configure(
    microphone_monitor *monitor,
    const microphone_parameters *parameters,
    microphone_real sample_time,
    microphone_real bandwidth,
    microphone_real time_unit)
{
    int k;

    for (k = 0; k < MICROPHONE_RESIDUALS; ++k) {
        monitor->settle[k] = UINT32_MAX;
    }
    microphone_reset(monitor);
    if (!parameters_are_finite(parameters)) {
        return MICROPHONE_BAD_PARAMETER;
    }
    if (!(sample_time >= REAL(0.000999999)) || !finite_number(sample_time)) {
        return MICROPHONE_BAD_SAMPLE_TIME;
    }
    if (!(bandwidth * sample_time >= SLOWEST && bandwidth * sample_time <= REAL(3.0))) {
        return MICROPHONE_BAD_BANDWIDTH;
    }
    if (!(time_unit > REAL(0.0)) || !finite_number(time_unit)) {
        return MICROPHONE_BAD_TIME_UNIT;
    }
    compute_coefficients(monitor, parameters, sample_time, bandwidth);
    if (!coefficients_are_finite(monitor)) {
        return MICROPHONE_BAD_COEFFICIENT;
    }
    monitor->settle[MICROPHONE_R1] = samples(REAL(9.233413476451586), sample_time, bandwidth);
    monitor->settle[MICROPHONE_R2] = samples(REAL(6.907755278982138), sample_time, bandwidth);
    return MICROPHONE_OK;
}

void microphone_exact(
    const microphone_monitor *monitor,
    const microphone_derivatives *derivatives,
    microphone_real residuals[MICROPHONE_RESIDUALS])
{
    const microphone_coefficients *c = &monitor->c;
    const microphone_derivatives *d = derivatives;
    real *r = residuals;

    /* microphone.bg:17: mic.mech.q0 + Int(v) */
    const real t = d->v_integral + c->mic__mech__q0;

    /* microphone.bg:17: r1 = (U0 - u)/R - eps*A*D(u/Int(v, x0)) */
    r[MICROPHONE_R1] = c->r1_U0 * d->U0 - c->r1_U0 * d->u[0]
        - c->r1_product_1 * (d->u[1] / t - d->u[0] * d->v[0] / t / t);

    /* microphone.bg:29: r2 = pressure*A - b*v - k*Int(v) - eps*A*u^2/(2*Int(v, x0)^2) - m*D(v) */
    r[MICROPHONE_R2] = c->r2_pressure * d->pressure - c->r2_v_int * d->v_integral
        - c->r2_v * d->v[0] - c->r2_v_1 * d->v[1] - c->r2_product * (d->u[0] * d->u[0] / t / t);
}

/* r1 on its first sample: the filter as if it had always been so. */
static void start_r1(
    microphone_monitor *monitor, const microphone_samples *s, real *r)
{
    const microphone_coefficients *c = &monitor->c;
    microphone_memory *x = &monitor->x;

    /* microphone.bg:17: integral of v, at the start */
    const real r1_int = REAL(0.0);

    /* microphone.bg:17: integral of v: memory */
    x->r1_q = c->half_time * s->v;

    /* microphone.bg:17: integral of v */
    const real r1_integral = r1_int;

    /* microphone.bg:17: integral of v: memory */
    x->r1_rate2 = s->v;
    x->r1_rate1 = s->v;

    /* microphone.bg:17: u/(mic.mech.q0 + Int(v)) */
    const real r1_product = s->u / (r1_integral + c->mic__mech__q0);

    /* microphone.bg:17: r1: terms of order 0 */
    const real r1_g0 = c->r1_U0 * s->U0 - c->r1_U0 * s->u;

    /* microphone.bg:17: r1: degree 1 */
    const real r1_d1 = c->r1_w1_product * r1_product;

    /* microphone.bg:17: r1: error of order 0 */
    const real r1_e0 = c->bend1 * r1_g0;

    /* microphone.bg:17: r1: input of stage 2 */
    const real r1_u2 = r1_g0 + r1_d1 - r1_e0;

    /* microphone.bg:17: r1: stage 2, at rest */
    const real r1_y2 = r1_u2;

    /* microphone.bg:17: r1: stage 2: memory */
    x->r1_s2 = c->rest * r1_u2;

    /* microphone.bg:17: r1: input of stage 1 */
    const real r1_u1 = r1_y2 + REAL(2.0) * r1_e0 - r1_d1;

    /* microphone.bg:17: r1: stage 1, at rest */
    const real r1_y1 = r1_u1;

    /* microphone.bg:17: r1: stage 1: memory */
    x->r1_s1 = c->rest * r1_u1;

    /* microphone.bg:17: r1 = (U0 - u)/R - eps*A*D(u/Int(v, x0)) */
    r[MICROPHONE_R1] = r1_y1 - r1_e0;
}

/* r1 on every further sample. */
static void next_r1(
    microphone_monitor *monitor, const microphone_samples *s, real *r)
{
    const microphone_coefficients *c = &monitor->c;
    microphone_memory *x = &monitor->x;

    /* microphone.bg:17: integral of v */
    const real r1_int = x->r1_q + c->half_time * s->v;

    /* microphone.bg:17: integral of v: memory */
    x->r1_q = r1_int + c->half_time * s->v;

    /* microphone.bg:17: integral of v */
    const real r1_integral = r1_int
        - c->half_twelfth * (REAL(3.0) * s->v - REAL(4.0) * x->r1_rate1 + x->r1_rate2);

    /* microphone.bg:17: integral of v: memory */
    x->r1_rate2 = x->r1_rate1;
    x->r1_rate1 = s->v;

    /* microphone.bg:17: u/(mic.mech.q0 + Int(v)) */
    const real r1_product = s->u / (r1_integral + c->mic__mech__q0);

    /* microphone.bg:17: r1: terms of order 0 */
    const real r1_g0 = c->r1_U0 * s->U0 - c->r1_U0 * s->u;

    /* microphone.bg:17: r1: degree 1 */
    const real r1_d1 = c->r1_w1_product * r1_product;

    /* microphone.bg:17: r1: error of order 0 */
    const real r1_e0 = c->bend1 * r1_g0;

    /* microphone.bg:17: r1: input of stage 2 */
    const real r1_u2 = r1_g0 + r1_d1 - r1_e0;

    /* microphone.bg:17: r1: stage 2 */
    const real r1_y2 = x->r1_s2 + c->b * r1_u2;

    /* microphone.bg:17: r1: stage 2: memory */
    x->r1_s2 = c->a * r1_y2 + c->b * r1_u2;

    /* microphone.bg:17: r1: input of stage 1 */
    const real r1_u1 = r1_y2 + REAL(2.0) * r1_e0 - r1_d1;

    /* microphone.bg:17: r1: stage 1 */
    const real r1_y1 = x->r1_s1 + c->b * r1_u1;

    /* microphone.bg:17: r1: stage 1: memory */
    x->r1_s1 = c->a * r1_y1 + c->b * r1_u1;

    /* microphone.bg:17: r1 = (U0 - u)/R - eps*A*D(u/Int(v, x0)) */
    r[MICROPHONE_R1] = r1_y1 - r1_e0;
}

/* One sample for r1; a number that is not finite makes the next sample the first. */
static void run_r1(
    microphone_monitor *monitor, const microphone_samples *s, microphone_residuals *residuals)
{
    real *r = residuals->value;
    uint32_t age = monitor->age[0];

    if (age == 0u) {
        start_r1(monitor, s, r);
    } else {
        next_r1(monitor, s, r);
    }
    /* a sum is finite only if all its terms are */
    if (finite_number(s->U0 + s->u + s->v + r[MICROPHONE_R1])) {
        age += age < UINT32_MAX ? 1u : 0u;
    } else {
        age = 0u;
        r[MICROPHONE_R1] = REAL(0.0);
    }
    monitor->age[0] = age;
    residuals->valid[MICROPHONE_R1] = age > monitor->settle[MICROPHONE_R1];
}

/* r2 on its first sample: the filter as if it had always been so. */
static void start_r2(
    microphone_monitor *monitor, const microphone_samples *s, real *r)
{
    const microphone_coefficients *c = &monitor->c;
    microphone_memory *x = &monitor->x;

    /* microphone.bg:29: integral of v, at the start */
    const real r2_int = REAL(0.0);

    /* microphone.bg:29: integral of v: memory */
    x->r2_q = c->half_time * s->v;

    /* microphone.bg:29: integral of v */
    const real r2_integral = r2_int;

    /* microphone.bg:29: integral of v: memory */
    x->r2_rate2 = s->v;
    x->r2_rate1 = s->v;

    /* microphone.bg:29: mic.mech.q0 + Int(v) */
    const real r2_t = r2_integral + c->mic__mech__q0;

    /* microphone.bg:29: u^2/(mic.mech.q0 + Int(v))^2 */
    const real r2_product = s->u * s->u / r2_t / r2_t;

    /* microphone.bg:29: r2: integral, what is integrated */
    const real r2_rate = -c->r2_v_int * s->v;

    /* microphone.bg:29: r2: integral, at the start */
    const real r2_int_2 = REAL(0.0);

    /* microphone.bg:29: r2: integral: memory */
    x->r2_q_2 = c->half_time * r2_rate;

    /* microphone.bg:29: r2: error of order -1 */
    const real r2_i = c->bend_int * r2_rate;

    /* microphone.bg:29: r2: input of stage 1 */
    const real r2_u1 = c->r2_pressure * s->pressure + r2_int_2 + r2_i - c->r2_v * s->v
        - c->r2_product * r2_product;

    /* microphone.bg:29: r2: stage 1, at rest */
    const real r2_y1 = r2_u1;

    /* microphone.bg:29: r2: stage 1: memory */
    x->r2_s1 = c->rest * r2_u1;

    /* microphone.bg:29: r2 = pressure*A - b*v - k*Int(v) - eps*A*u^2/(2*Int(v, x0)^2) - m*D(v) */
    r[MICROPHONE_R2] = r2_y1 - r2_i;
}

/* r2 on every further sample. */
static void next_r2(
    microphone_monitor *monitor, const microphone_samples *s, real *r)
{
    const microphone_coefficients *c = &monitor->c;
    microphone_memory *x = &monitor->x;

    /* microphone.bg:29: integral of v */
    const real r2_int = x->r2_q + c->half_time * s->v;

    /* microphone.bg:29: integral of v: memory */
    x->r2_q = r2_int + c->half_time * s->v;

    /* microphone.bg:29: integral of v */
    const real r2_integral = r2_int
        - c->half_twelfth * (REAL(3.0) * s->v - REAL(4.0) * x->r2_rate1 + x->r2_rate2);

    /* microphone.bg:29: integral of v: memory */
    x->r2_rate2 = x->r2_rate1;
    x->r2_rate1 = s->v;

    /* microphone.bg:29: mic.mech.q0 + Int(v) */
    const real r2_t = r2_integral + c->mic__mech__q0;

    /* microphone.bg:29: u^2/(mic.mech.q0 + Int(v))^2 */
    const real r2_product = s->u * s->u / r2_t / r2_t;

    /* microphone.bg:29: r2: integral, what is integrated */
    const real r2_rate = -c->r2_v_int * s->v;

    /* microphone.bg:29: r2: integral */
    const real r2_int_2 = x->r2_q_2 + c->half_time * r2_rate;

    /* microphone.bg:29: r2: integral: memory */
    x->r2_q_2 = r2_int_2 + c->half_time * r2_rate;

    /* microphone.bg:29: r2: error of order -1 */
    const real r2_i = c->bend_int * r2_rate;

    /* microphone.bg:29: r2: input of stage 1 */
    const real r2_u1 = c->r2_pressure * s->pressure + r2_int_2 + r2_i - c->r2_v * s->v
        - c->r2_product * r2_product;

    /* microphone.bg:29: r2: stage 1 */
    const real r2_y1 = x->r2_s1 + c->b * r2_u1;

    /* microphone.bg:29: r2: stage 1: memory */
    x->r2_s1 = c->a * r2_y1 + c->b * r2_u1;

    /* microphone.bg:29: r2 = pressure*A - b*v - k*Int(v) - eps*A*u^2/(2*Int(v, x0)^2) - m*D(v) */
    r[MICROPHONE_R2] = r2_y1 - r2_i;
}

/* One sample for r2; a number that is not finite makes the next sample the first. */
static void run_r2(
    microphone_monitor *monitor, const microphone_samples *s, microphone_residuals *residuals)
{
    real *r = residuals->value;
    uint32_t age = monitor->age[1];

    if (age == 0u) {
        start_r2(monitor, s, r);
    } else {
        next_r2(monitor, s, r);
    }
    /* a sum is finite only if all its terms are */
    if (finite_number(s->pressure + s->u + s->v + r[MICROPHONE_R2])) {
        age += age < UINT32_MAX ? 1u : 0u;
    } else {
        age = 0u;
        r[MICROPHONE_R2] = REAL(0.0);
    }
    monitor->age[1] = age;
    residuals->valid[MICROPHONE_R2] = age > monitor->settle[MICROPHONE_R2];
}

void microphone_reset(microphone_monitor *monitor)
{
    int k;

    for (k = 0; k < 2; ++k) {
        monitor->age[k] = 0u;
    }
}

void microphone_step(
    microphone_monitor *monitor,
    const microphone_samples *samples,
    microphone_residuals *residuals)
{
    run_r1(monitor, samples, residuals);
    run_r2(monitor, samples, residuals);
}

const char microphone_fault_name[MICROPHONE_FAULTS][9] = {
    "A", "u", "v", "R", "U0", "m", "b", "k", "pressure",
};

const uint16_t microphone_fault_class[MICROPHONE_FAULTS] = {
    0u, 0u, 0u, 1u, 1u, 2u, 3u, 3u, 3u,
};

const char microphone_residual_name[MICROPHONE_RESIDUALS][3] = {
    "r1", "r2",
};

/* Signatures: 1 where a residual may be moved by the faults of a class, 3 where it is for sure. */
static const uint8_t signature[MICROPHONE_CLASSES][MICROPHONE_RESIDUALS] = {
    {3u, 3u},
    {3u, 0u},
    {0u, 1u},
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
    microphone_diagnosis *d, const microphone_limit *limit, int k, real off, real out, real bound)
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

static bool sums_are_zero(const microphone_diagnosis *d, int k)
{
    const real sum = d->above[k] + d->below[k] + d->louder[k];

    return !(sum > REAL(0.0));
}

static void forget_sums(microphone_diagnosis *d, int k)
{
    d->above[k] = REAL(0.0);
    d->below[k] = REAL(0.0);
    d->louder[k] = REAL(0.0);
    d->streak[k] = 0u;
}

/* Residual k in one sample; whether it goes into alarm. */
static bool watch(
    microphone_diagnosis *d, const microphone_limit *limit, int k, real value, real bound, bool row)
{
    const real off = value - limit->mean;
    const real out = (off < REAL(0.0) ? -off : off) - bound;
    bool high = false;

    if (row) {
        high = add_row(d, limit, k, off, out, bound);
    }
    if (d->state[k] == MICROPHONE_ALARM) {
        d->since[k] += d->since[k] < UINT32_MAX ? 1u : 0u;
        if (!(out < RELEASE * limit->level) || !sums_are_zero(d, k)) {
            d->quiet = 0u;
        }
        return false;
    }
    d->state[k] = MICROPHONE_HEALTHY;
    d->streak[k] = out > limit->level ? d->streak[k] + 1u : 0u;
    if (d->streak[k] < d->least && !high) {
        return false;
    }
    d->state[k] = MICROPHONE_ALARM;
    d->since[k] = 0u;
    return true;
}

/* What is left of a class of faults. */
static microphone_candidate left_of(const microphone_diagnosis *d, const uint8_t *own)
{
    microphone_candidate found = MICROPHONE_LIKELY;
    int k;

    for (k = 0; k < MICROPHONE_RESIDUALS; ++k) {
        if (d->state[k] == MICROPHONE_ALARM && own[k] == 0u) {
            return MICROPHONE_RULED_OUT;
        }
        if (d->state[k] == MICROPHONE_HEALTHY && own[k] == 3u) {
            found = MICROPHONE_SMALL;
        }
    }
    return found;
}

/* Which classes of faults the residuals leave, and the one if it is one. */
static void judge(microphone_diagnosis *d)
{
    int likely = 0;
    int c;

    d->fault_class = MICROPHONE_UNKNOWN;
    for (c = 0; c < MICROPHONE_CLASSES; ++c) {
        const microphone_candidate left = left_of(d, signature[c]);

        d->candidate[c] = (uint8_t)left;
        if (left == MICROPHONE_LIKELY) {
            d->fault_class = (int16_t)c;
            ++likely;
        }
    }
    if (likely != 1 || d->settled < 2u * d->row) {
        d->fault_class = MICROPHONE_UNKNOWN;
    }
}

microphone_limit microphone_limit_of(microphone_real level)
{
    microphone_limit limit;

    limit.mean = REAL(0.0);
    limit.level = level;
    limit.unit = REAL(0.0);
    limit.loud = REAL(0.0);
    limit.drift = REAL(0.5);
    limit.height = NEVER;
    limit.bound = REAL(0.0);
    return limit;
}

void microphone_clear(microphone_diagnosis *diagnosis)
{
    int k;

    for (k = 0; k < MICROPHONE_RESIDUALS; ++k) {
        if (diagnosis->state[k] == MICROPHONE_ALARM) {
            diagnosis->state[k] = MICROPHONE_HEALTHY;
        }
        diagnosis->since[k] = 0u;
        forget_sums(diagnosis, k);
    }
    for (k = 0; k < MICROPHONE_CLASSES; ++k) {
        diagnosis->candidate[k] = MICROPHONE_RULED_OUT;
    }
    diagnosis->fault_class = MICROPHONE_UNKNOWN;
    diagnosis->quiet = 0u;
    diagnosis->settled = 0u;
}

void microphone_diagnosis_reset(microphone_diagnosis *diagnosis)
{
    int k;

    diagnosis->row = MICROPHONE_ROW;
    diagnosis->least = 15u;
    diagnosis->hold = 10u * MICROPHONE_ROW;
    diagnosis->latch = false;
    diagnosis->tick = 0u;
    for (k = 0; k < MICROPHONE_RESIDUALS; ++k) {
        diagnosis->state[k] = MICROPHONE_BLIND;
    }
    microphone_clear(diagnosis);
}

bool microphone_diagnose(
    microphone_diagnosis *diagnosis,
    const microphone_limit *limits,
    const microphone_real *bounds,
    const microphone_residuals *residuals)
{
    microphone_diagnosis *d = diagnosis;
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
    for (k = 0; k < MICROPHONE_RESIDUALS; ++k) {
        if (residuals->valid[k]) {
            const real bound = bounds ? bounds[k] : limits[k].bound;

            fresh = watch(d, &limits[k], k, residuals->value[k], bound, row) || fresh;
        } else {
            forget_sums(d, k);
            if (d->state[k] == MICROPHONE_ALARM) {
                d->quiet = 0u; /* nobody knows that it is over */
            } else {
                d->state[k] = MICROPHONE_BLIND;
            }
        }
        alarm = alarm || d->state[k] == MICROPHONE_ALARM;
    }
    if (fresh) {
        d->quiet = 0u;
        d->settled = 0u;
    }
    if (alarm && !d->latch && d->quiet >= d->hold) {
        microphone_clear(d);
        return false;
    }
    if (fresh || (alarm && row)) {
        judge(d);
    }
    return alarm;
}
