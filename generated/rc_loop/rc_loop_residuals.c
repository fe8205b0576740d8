/* rc_loop_residuals.c: the residuals of RcLoop; generated, see the header. */
#include "rc_loop_residuals.h"


#if defined __FINITE_MATH_ONLY__ && __FINITE_MATH_ONLY__
#error "this code tells numbers from NaN: compile it without -ffinite-math-only (-ffast-math)"
#endif

typedef rc_loop_real real;

#define REAL(x) RC_LOOP_CONSTANT(x)
#if defined RC_LOOP_FLOAT && !defined RC_LOOP_REAL
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

uint32_t rc_loop_abi(void)
{
    return RC_LOOP_ABI;
}

const char *rc_loop_digest(void)
{
    return RC_LOOP_DIGEST;
}

void rc_loop_nominal(rc_loop_parameters *parameters)
{
    parameters->R0 = REAL(1000.0);   /* Ohm */
    parameters->Rab = REAL(2200.0);  /* Ohm */
    parameters->Rbc = REAL(4700.0);  /* Ohm */
    parameters->Rca = REAL(3300.0);  /* Ohm */
    parameters->Ca = REAL(1.0e-06);  /* F */
    parameters->Cc = REAL(4.7e-07);  /* F */
}

/* The coefficients of exact and of the filter, from the parameters. */
static void compute_coefficients(rc_loop_monitor *monitor, const rc_loop_parameters *p,
        real sample_time, real bandwidth)
{
    rc_loop_coefficients *c = &monitor->c;

    /* bandwidth*sample_time */
    const real x_ = bandwidth * sample_time;

    /* of a stage: what is left of its memory */
    const real pole = greatest(REAL(2.0) - x_, REAL(0.0)) / (x_ + REAL(2.0));

    /* w*sample_time, x or 2 */
    const real turn = REAL(2.0) * (REAL(1.0) - pole) / (pole + REAL(1.0));

    /* w of the filter 1/(1 + D/w) */
    const real w = turn / sample_time;

    /* rc_loop.bg:14: Rab/Rca */
    const real t = p->Rab / p->Rca;

    /* rc_loop.bg:14: Rab*Ca */
    const real t_2 = p->Rab * p->Ca;

    /* rc_loop.bg:14: R0*Ca */
    const real t_3 = p->R0 * p->Ca;

    /* 1 - pole */
    const real t_4 = REAL(1.0) - pole;

    /* rc_loop.bg:14: r1: factor of ua: Rab/Rca + 1 */
    c->r1_ua = t + REAL(1.0);

    /* rc_loop.bg:14: r1: factor of ua': Rab*Ca + R0*Ca */
    c->r1_ua_1 = t_2 + t_3;

    /* rc_loop.bg:14: r1: factor of uc: Rab/Rca */
    c->r1_uc = t;

    /* rc_loop.bg:14: r1: factor of uc': R0*Cc */
    c->r1_uc_1 = p->R0 * p->Cc;

    /* rc_loop.bg:14: r1: factor of ua' */
    c->r1_w1_ua = (-t_2 - t_3) * w;

    /* rc_loop.bg:14: r1: factor of uc' */
    c->r1_w1_uc = p->R0 * p->Cc * w;

    /* filter: 1 * (w*sample_time)^2/12 */
    c->bend1 = turn * turn / REAL(12.0);

    /* filter: what is left of a memory a sample later */
    c->a = pole;

    /* filter: weight of a sample, new and a sample later */
    c->b = REAL(0.5) * t_4;

    /* filter: 1 - b, the memory of a constant 1 */
    c->rest = REAL(1.0) - REAL(0.5) * t_4;

    /* rc_loop.bg:18: r2: factor of ua: Rab/Rca + Rbc/Rca + 1 */
    c->r2_ua = t + p->Rbc / p->Rca + REAL(1.0);

    /* rc_loop.bg:18: r2: factor of ua': Rab*Ca */
    c->r2_ua_1 = t_2;

    /* rc_loop.bg:18: r2: factor of uc': Rbc*Cc */
    c->r2_uc_1 = p->Rbc * p->Cc;

    /* rc_loop.bg:18: r2: factor of ua' */
    c->r2_w1_ua = p->Rab * p->Ca * w;

    /* rc_loop.bg:18: r2: factor of uc' */
    c->r2_w1_uc = p->Rbc * p->Cc * w;
}

static bool parameters_are_finite(const rc_loop_parameters *p)
{
    return finite_number(p->R0 + p->Rab + p->Rbc + p->Rca + p->Ca + p->Cc);
}

static bool coefficients_are_finite(const rc_loop_monitor *monitor)
{
    return finite_number(monitor->c.r1_ua + monitor->c.r1_ua_1 + monitor->c.r1_uc
            + monitor->c.r1_uc_1 + monitor->c.r1_w1_ua + monitor->c.r1_w1_uc + monitor->c.bend1
            + monitor->c.a + monitor->c.b + monitor->c.rest + monitor->c.r2_ua + monitor->c.r2_ua_1
            + monitor->c.r2_uc_1 + monitor->c.r2_w1_ua + monitor->c.r2_w1_uc);
}

/* Samples until `constants` time constants of the filter are over. */
static uint32_t samples(real constants, real sample_time, real bandwidth)
{
    const real wait = constants / (bandwidth * sample_time);
    const uint32_t whole = wait < REAL(4.0e9) ? (uint32_t)wait : UINT32_MAX - 1u;

    return (real)whole < wait ? whole + 1u : whole;
}

rc_loop_status rc_loop_configure(
    rc_loop_monitor *monitor,
    const rc_loop_parameters *parameters,
    rc_loop_real sample_time,
    rc_loop_real bandwidth,
    rc_loop_real time_unit)
{
    int k;

    for (k = 0; k < RC_LOOP_RESIDUALS; ++k) {
        monitor->settle[k] = UINT32_MAX;
    }
    rc_loop_reset(monitor);
    if (!parameters_are_finite(parameters)) {
        return RC_LOOP_BAD_PARAMETER;
    }
    if (!(sample_time > REAL(0.0)) || !finite_number(sample_time)) {
        return RC_LOOP_BAD_SAMPLE_TIME;
    }
    if (!(bandwidth * sample_time >= SLOWEST && bandwidth * sample_time <= REAL(3.0))) {
        return RC_LOOP_BAD_BANDWIDTH;
    }
    if (!(time_unit > REAL(0.0)) || !finite_number(time_unit)) {
        return RC_LOOP_BAD_TIME_UNIT;
    }
    compute_coefficients(monitor, parameters, sample_time, bandwidth);
    if (!coefficients_are_finite(monitor)) {
        return RC_LOOP_BAD_COEFFICIENT;
    }
    monitor->settle[RC_LOOP_R1] = samples(REAL(9.233413476451586), sample_time, bandwidth);
    monitor->settle[RC_LOOP_R2] = samples(REAL(9.233413476451586), sample_time, bandwidth);
    return RC_LOOP_OK;
}

void rc_loop_exact(
    const rc_loop_monitor *monitor,
    const rc_loop_derivatives *derivatives,
    rc_loop_real residuals[RC_LOOP_RESIDUALS])
{
    const rc_loop_coefficients *c = &monitor->c;
    const rc_loop_derivatives *d = derivatives;
    real *r = residuals;

    /* rc_loop.bg:14: r1 = U - ua - Rab*ba.f - R0*(ba.f + (Cc*D(uc) - ac.f))
     * where ba.f = ac.f + Ca*D(ua)
     * ac.f = (ua - uc)/Rca */
    r[RC_LOOP_R1] = d->U + c->r1_uc * d->uc[0] - c->r1_ua * d->ua[0] - c->r1_ua_1 * d->ua[1]
        - c->r1_uc_1 * d->uc[1];

    /* rc_loop.bg:18: r2 = ua + Rab*(ac.f + Ca*D(ua)) - uc - Rbc*(Cc*D(uc) - ac.f)
     * where ac.f = (ua - uc)/Rca */
    r[RC_LOOP_R2] = c->r2_ua * d->ua[0] + c->r2_ua_1 * d->ua[1] - c->r2_ua * d->uc[0]
        - c->r2_uc_1 * d->uc[1];
}

/* r1 on its first sample: the filter as if it had always been so. */
static void start_r1(
    rc_loop_monitor *monitor, const rc_loop_samples *s, real *r)
{
    const rc_loop_coefficients *c = &monitor->c;
    rc_loop_memory *x = &monitor->x;

    /* rc_loop.bg:14: r1: terms of order 0 */
    const real r1_g0 = s->U + c->r1_uc * s->uc - c->r1_ua * s->ua;

    /* rc_loop.bg:14: r1: degree 1 */
    const real r1_d1 = c->r1_w1_ua * s->ua - c->r1_w1_uc * s->uc;

    /* rc_loop.bg:14: r1: error of order 0 */
    const real r1_e0 = c->bend1 * r1_g0;

    /* rc_loop.bg:14: r1: input of stage 2 */
    const real r1_u2 = r1_g0 - r1_d1 - r1_e0;

    /* rc_loop.bg:14: r1: stage 2, at rest */
    const real r1_y2 = r1_u2;

    /* rc_loop.bg:14: r1: stage 2: memory */
    x->r1_s2 = c->rest * r1_u2;

    /* rc_loop.bg:14: r1: input of stage 1 */
    const real r1_u1 = r1_y2 + r1_d1 + REAL(2.0) * r1_e0;

    /* rc_loop.bg:14: r1: stage 1, at rest */
    const real r1_y1 = r1_u1;

    /* rc_loop.bg:14: r1: stage 1: memory */
    x->r1_s1 = c->rest * r1_u1;

    /* rc_loop.bg:14: r1 = U - ua - Rab*ba.f - R0*(ba.f + (Cc*D(uc) - ac.f))
     * where ba.f = ac.f + Ca*D(ua)
     * ac.f = (ua - uc)/Rca */
    r[RC_LOOP_R1] = r1_y1 - r1_e0;
}

/* r1 on every further sample. */
static void next_r1(
    rc_loop_monitor *monitor, const rc_loop_samples *s, real *r)
{
    const rc_loop_coefficients *c = &monitor->c;
    rc_loop_memory *x = &monitor->x;

    /* rc_loop.bg:14: r1: terms of order 0 */
    const real r1_g0 = s->U + c->r1_uc * s->uc - c->r1_ua * s->ua;

    /* rc_loop.bg:14: r1: degree 1 */
    const real r1_d1 = c->r1_w1_ua * s->ua - c->r1_w1_uc * s->uc;

    /* rc_loop.bg:14: r1: error of order 0 */
    const real r1_e0 = c->bend1 * r1_g0;

    /* rc_loop.bg:14: r1: input of stage 2 */
    const real r1_u2 = r1_g0 - r1_d1 - r1_e0;

    /* rc_loop.bg:14: r1: stage 2 */
    const real r1_y2 = x->r1_s2 + c->b * r1_u2;

    /* rc_loop.bg:14: r1: stage 2: memory */
    x->r1_s2 = c->a * r1_y2 + c->b * r1_u2;

    /* rc_loop.bg:14: r1: input of stage 1 */
    const real r1_u1 = r1_y2 + r1_d1 + REAL(2.0) * r1_e0;

    /* rc_loop.bg:14: r1: stage 1 */
    const real r1_y1 = x->r1_s1 + c->b * r1_u1;

    /* rc_loop.bg:14: r1: stage 1: memory */
    x->r1_s1 = c->a * r1_y1 + c->b * r1_u1;

    /* rc_loop.bg:14: r1 = U - ua - Rab*ba.f - R0*(ba.f + (Cc*D(uc) - ac.f))
     * where ba.f = ac.f + Ca*D(ua)
     * ac.f = (ua - uc)/Rca */
    r[RC_LOOP_R1] = r1_y1 - r1_e0;
}

/* One sample for r1; a number that is not finite makes the next sample the first. */
static void run_r1(
    rc_loop_monitor *monitor, const rc_loop_samples *s, rc_loop_residuals *residuals)
{
    real *r = residuals->value;
    uint32_t age = monitor->age[0];

    if (age == 0u) {
        start_r1(monitor, s, r);
    } else {
        next_r1(monitor, s, r);
    }
    /* a sum is finite only if all its terms are */
    if (finite_number(s->U + s->ua + s->uc + r[RC_LOOP_R1])) {
        age += age < UINT32_MAX ? 1u : 0u;
    } else {
        age = 0u;
        r[RC_LOOP_R1] = REAL(0.0);
    }
    monitor->age[0] = age;
    residuals->valid[RC_LOOP_R1] = age > monitor->settle[RC_LOOP_R1];
}

/* r2 on its first sample: the filter as if it had always been so. */
static void start_r2(
    rc_loop_monitor *monitor, const rc_loop_samples *s, real *r)
{
    const rc_loop_coefficients *c = &monitor->c;
    rc_loop_memory *x = &monitor->x;

    /* rc_loop.bg:18: r2: terms of order 0 */
    const real r2_g0 = c->r2_ua * s->ua - c->r2_ua * s->uc;

    /* rc_loop.bg:18: r2: degree 1 */
    const real r2_d1 = c->r2_w1_ua * s->ua - c->r2_w1_uc * s->uc;

    /* rc_loop.bg:18: r2: error of order 0 */
    const real r2_e0 = c->bend1 * r2_g0;

    /* rc_loop.bg:18: r2: input of stage 2 */
    const real r2_u2 = r2_g0 - r2_d1 - r2_e0;

    /* rc_loop.bg:18: r2: stage 2, at rest */
    const real r2_y2 = r2_u2;

    /* rc_loop.bg:18: r2: stage 2: memory */
    x->r2_s2 = c->rest * r2_u2;

    /* rc_loop.bg:18: r2: input of stage 1 */
    const real r2_u1 = r2_y2 + r2_d1 + REAL(2.0) * r2_e0;

    /* rc_loop.bg:18: r2: stage 1, at rest */
    const real r2_y1 = r2_u1;

    /* rc_loop.bg:18: r2: stage 1: memory */
    x->r2_s1 = c->rest * r2_u1;

    /* rc_loop.bg:18: r2 = ua + Rab*(ac.f + Ca*D(ua)) - uc - Rbc*(Cc*D(uc) - ac.f)
     * where ac.f = (ua - uc)/Rca */
    r[RC_LOOP_R2] = r2_y1 - r2_e0;
}

/* r2 on every further sample. */
static void next_r2(
    rc_loop_monitor *monitor, const rc_loop_samples *s, real *r)
{
    const rc_loop_coefficients *c = &monitor->c;
    rc_loop_memory *x = &monitor->x;

    /* rc_loop.bg:18: r2: terms of order 0 */
    const real r2_g0 = c->r2_ua * s->ua - c->r2_ua * s->uc;

    /* rc_loop.bg:18: r2: degree 1 */
    const real r2_d1 = c->r2_w1_ua * s->ua - c->r2_w1_uc * s->uc;

    /* rc_loop.bg:18: r2: error of order 0 */
    const real r2_e0 = c->bend1 * r2_g0;

    /* rc_loop.bg:18: r2: input of stage 2 */
    const real r2_u2 = r2_g0 - r2_d1 - r2_e0;

    /* rc_loop.bg:18: r2: stage 2 */
    const real r2_y2 = x->r2_s2 + c->b * r2_u2;

    /* rc_loop.bg:18: r2: stage 2: memory */
    x->r2_s2 = c->a * r2_y2 + c->b * r2_u2;

    /* rc_loop.bg:18: r2: input of stage 1 */
    const real r2_u1 = r2_y2 + r2_d1 + REAL(2.0) * r2_e0;

    /* rc_loop.bg:18: r2: stage 1 */
    const real r2_y1 = x->r2_s1 + c->b * r2_u1;

    /* rc_loop.bg:18: r2: stage 1: memory */
    x->r2_s1 = c->a * r2_y1 + c->b * r2_u1;

    /* rc_loop.bg:18: r2 = ua + Rab*(ac.f + Ca*D(ua)) - uc - Rbc*(Cc*D(uc) - ac.f)
     * where ac.f = (ua - uc)/Rca */
    r[RC_LOOP_R2] = r2_y1 - r2_e0;
}

/* One sample for r2; a number that is not finite makes the next sample the first. */
static void run_r2(
    rc_loop_monitor *monitor, const rc_loop_samples *s, rc_loop_residuals *residuals)
{
    real *r = residuals->value;
    uint32_t age = monitor->age[1];

    if (age == 0u) {
        start_r2(monitor, s, r);
    } else {
        next_r2(monitor, s, r);
    }
    /* a sum is finite only if all its terms are */
    if (finite_number(s->ua + s->uc + r[RC_LOOP_R2])) {
        age += age < UINT32_MAX ? 1u : 0u;
    } else {
        age = 0u;
        r[RC_LOOP_R2] = REAL(0.0);
    }
    monitor->age[1] = age;
    residuals->valid[RC_LOOP_R2] = age > monitor->settle[RC_LOOP_R2];
}

void rc_loop_reset(rc_loop_monitor *monitor)
{
    int k;

    for (k = 0; k < 2; ++k) {
        monitor->age[k] = 0u;
    }
}

void rc_loop_step(
    rc_loop_monitor *monitor,
    const rc_loop_samples *samples,
    rc_loop_residuals *residuals)
{
    run_r1(monitor, samples, residuals);
    run_r2(monitor, samples, residuals);
}

const char rc_loop_fault_name[RC_LOOP_FAULTS][4] = {
    "R0", "U", "Rab", "Rca", "Ca", "Cc", "ua", "uc", "Rbc",
};

const uint16_t rc_loop_fault_class[RC_LOOP_FAULTS] = {
    0u, 0u, 1u, 1u, 1u, 1u, 1u, 1u, 2u,
};

const char rc_loop_residual_name[RC_LOOP_RESIDUALS][3] = {
    "r1", "r2",
};

/* Signatures: 1 where a residual may be moved by the faults of a class, 3 where it is for sure. */
static const uint8_t signature[RC_LOOP_CLASSES][RC_LOOP_RESIDUALS] = {
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
    rc_loop_diagnosis *d, const rc_loop_limit *limit, int k, real off, real out, real bound)
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

static bool sums_are_zero(const rc_loop_diagnosis *d, int k)
{
    const real sum = d->above[k] + d->below[k] + d->louder[k];

    return !(sum > REAL(0.0));
}

static void forget_sums(rc_loop_diagnosis *d, int k)
{
    d->above[k] = REAL(0.0);
    d->below[k] = REAL(0.0);
    d->louder[k] = REAL(0.0);
    d->streak[k] = 0u;
}

/* Residual k in one sample; whether it goes into alarm. */
static bool watch(
    rc_loop_diagnosis *d, const rc_loop_limit *limit, int k, real value, real bound, bool row)
{
    const real off = value - limit->mean;
    const real out = (off < REAL(0.0) ? -off : off) - bound;
    bool high = false;

    if (row) {
        high = add_row(d, limit, k, off, out, bound);
    }
    if (d->state[k] == RC_LOOP_ALARM) {
        d->since[k] += d->since[k] < UINT32_MAX ? 1u : 0u;
        if (!(out < RELEASE * limit->level) || !sums_are_zero(d, k)) {
            d->quiet = 0u;
        }
        return false;
    }
    d->state[k] = RC_LOOP_HEALTHY;
    d->streak[k] = out > limit->level ? d->streak[k] + 1u : 0u;
    if (d->streak[k] < d->least && !high) {
        return false;
    }
    d->state[k] = RC_LOOP_ALARM;
    d->since[k] = 0u;
    return true;
}

/* What is left of a class of faults. */
static rc_loop_candidate left_of(const rc_loop_diagnosis *d, const uint8_t *own)
{
    rc_loop_candidate found = RC_LOOP_LIKELY;
    int k;

    for (k = 0; k < RC_LOOP_RESIDUALS; ++k) {
        if (d->state[k] == RC_LOOP_ALARM && own[k] == 0u) {
            return RC_LOOP_RULED_OUT;
        }
        if (d->state[k] == RC_LOOP_HEALTHY && own[k] == 3u) {
            found = RC_LOOP_SMALL;
        }
    }
    return found;
}

/* Which classes of faults the residuals leave, and the one if it is one. */
static void judge(rc_loop_diagnosis *d)
{
    int likely = 0;
    int c;

    d->fault_class = RC_LOOP_UNKNOWN;
    for (c = 0; c < RC_LOOP_CLASSES; ++c) {
        const rc_loop_candidate left = left_of(d, signature[c]);

        d->candidate[c] = (uint8_t)left;
        if (left == RC_LOOP_LIKELY) {
            d->fault_class = (int16_t)c;
            ++likely;
        }
    }
    if (likely != 1 || d->settled < 2u * d->row) {
        d->fault_class = RC_LOOP_UNKNOWN;
    }
}

rc_loop_limit rc_loop_limit_of(rc_loop_real level)
{
    rc_loop_limit limit;

    limit.mean = REAL(0.0);
    limit.level = level;
    limit.unit = REAL(0.0);
    limit.loud = REAL(0.0);
    limit.drift = REAL(0.5);
    limit.height = NEVER;
    limit.bound = REAL(0.0);
    return limit;
}

void rc_loop_clear(rc_loop_diagnosis *diagnosis)
{
    int k;

    for (k = 0; k < RC_LOOP_RESIDUALS; ++k) {
        if (diagnosis->state[k] == RC_LOOP_ALARM) {
            diagnosis->state[k] = RC_LOOP_HEALTHY;
        }
        diagnosis->since[k] = 0u;
        forget_sums(diagnosis, k);
    }
    for (k = 0; k < RC_LOOP_CLASSES; ++k) {
        diagnosis->candidate[k] = RC_LOOP_RULED_OUT;
    }
    diagnosis->fault_class = RC_LOOP_UNKNOWN;
    diagnosis->quiet = 0u;
    diagnosis->settled = 0u;
}

void rc_loop_diagnosis_reset(rc_loop_diagnosis *diagnosis)
{
    int k;

    diagnosis->row = RC_LOOP_ROW;
    diagnosis->least = 15u;
    diagnosis->hold = 10u * RC_LOOP_ROW;
    diagnosis->latch = false;
    diagnosis->tick = 0u;
    for (k = 0; k < RC_LOOP_RESIDUALS; ++k) {
        diagnosis->state[k] = RC_LOOP_BLIND;
    }
    rc_loop_clear(diagnosis);
}

bool rc_loop_diagnose(
    rc_loop_diagnosis *diagnosis,
    const rc_loop_limit *limits,
    const rc_loop_real *bounds,
    const rc_loop_residuals *residuals)
{
    rc_loop_diagnosis *d = diagnosis;
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
    for (k = 0; k < RC_LOOP_RESIDUALS; ++k) {
        if (residuals->valid[k]) {
            const real bound = bounds ? bounds[k] : limits[k].bound;

            fresh = watch(d, &limits[k], k, residuals->value[k], bound, row) || fresh;
        } else {
            forget_sums(d, k);
            if (d->state[k] == RC_LOOP_ALARM) {
                d->quiet = 0u; /* nobody knows that it is over */
            } else {
                d->state[k] = RC_LOOP_BLIND;
            }
        }
        alarm = alarm || d->state[k] == RC_LOOP_ALARM;
    }
    if (fresh) {
        d->quiet = 0u;
        d->settled = 0u;
    }
    if (alarm && !d->latch && d->quiet >= d->hold) {
        rc_loop_clear(d);
        return false;
    }
    if (fresh || (alarm && row)) {
        judge(d);
    }
    return alarm;
}
