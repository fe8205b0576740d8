/* rigid_gear_residuals.c: the residuals of RigidGear; generated, see the header. */
#include "rigid_gear_residuals.h"


#if defined __FINITE_MATH_ONLY__ && __FINITE_MATH_ONLY__
#error "this code tells numbers from NaN: compile it without -ffinite-math-only (-ffast-math)"
#endif

typedef rigid_gear_real real;

#define REAL(x) RIGID_GEAR_CONSTANT(x)
#if defined RIGID_GEAR_FLOAT && !defined RIGID_GEAR_REAL
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

uint32_t rigid_gear_abi(void)
{
    return RIGID_GEAR_ABI;
}

const char *rigid_gear_digest(void)
{
    return RIGID_GEAR_DIGEST;
}

void rigid_gear_nominal(rigid_gear_parameters *parameters)
{
    parameters->J1 = REAL(0.002);  /* kg.m^2 */
    parameters->f1 = REAL(0.001);  /* N.m.s/rad */
    parameters->N = REAL(12.0);    /* 1 */
    parameters->J2 = REAL(0.15);   /* kg.m^2 */
    parameters->f2 = REAL(0.02);   /* N.m.s/rad */
}

/* The coefficients of exact and of the filter, from the parameters. */
static void compute_coefficients(rigid_gear_monitor *monitor, const rigid_gear_parameters *p,
        real sample_time, real bandwidth)
{
    rigid_gear_coefficients *c = &monitor->c;

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

    /* rigid_gear.bg:14: r1: factor of w1: f1 */
    c->r1_w1 = p->f1;

    /* rigid_gear.bg:14: r1: factor of w1': J1 */
    c->r1_w1_1 = p->J1;

    /* rigid_gear.bg:14: r1: factor of w2: f2/N */
    c->r1_w2 = p->f2 / p->N;

    /* rigid_gear.bg:14: r1: factor of w2': J2/N */
    c->r1_w2_1 = p->J2 / p->N;

    /* rigid_gear.bg:14: r1: factor of w1' */
    c->r1_w1_w1 = p->J1 * w;

    /* rigid_gear.bg:14: r1: factor of w2' */
    c->r1_w1_w2 = p->J2 * w / p->N;

    /* filter: 1 * (w*sample_time)^2/12 */
    c->bend1 = turn * turn / REAL(12.0);

    /* filter: what is left of a memory a sample later */
    c->a = pole;

    /* filter: weight of a sample, new and a sample later */
    c->b = REAL(0.5) * t;

    /* filter: 1 - b, the memory of a constant 1 */
    c->rest = REAL(1.0) - REAL(0.5) * t;

    /* rigid_gear.bg:14: r2: factor of w2: N */
    c->r2_w2 = p->N;
}

static bool parameters_are_finite(const rigid_gear_parameters *p)
{
    return finite_number(p->J1 + p->f1 + p->N + p->J2 + p->f2);
}

static bool coefficients_are_finite(const rigid_gear_monitor *monitor)
{
    return finite_number(monitor->c.r1_w1 + monitor->c.r1_w1_1 + monitor->c.r1_w2
            + monitor->c.r1_w2_1 + monitor->c.r1_w1_w1 + monitor->c.r1_w1_w2 + monitor->c.bend1
            + monitor->c.a + monitor->c.b + monitor->c.rest + monitor->c.r2_w2);
}

/* Samples until `constants` time constants of the filter are over. */
static uint32_t samples(real constants, real sample_time, real bandwidth)
{
    const real wait = constants / (bandwidth * sample_time);
    const uint32_t whole = wait < REAL(4.0e9) ? (uint32_t)wait : UINT32_MAX - 1u;

    return (real)whole < wait ? whole + 1u : whole;
}

rigid_gear_status rigid_gear_configure(
    rigid_gear_monitor *monitor,
    const rigid_gear_parameters *parameters,
    rigid_gear_real sample_time,
    rigid_gear_real bandwidth,
    rigid_gear_real time_unit)
{
    int k;

    for (k = 0; k < RIGID_GEAR_RESIDUALS; ++k) {
        monitor->settle[k] = UINT32_MAX;
    }
    rigid_gear_reset(monitor);
    if (!parameters_are_finite(parameters)) {
        return RIGID_GEAR_BAD_PARAMETER;
    }
    if (!(sample_time > REAL(0.0)) || !finite_number(sample_time)) {
        return RIGID_GEAR_BAD_SAMPLE_TIME;
    }
    if (!(bandwidth * sample_time >= SLOWEST && bandwidth * sample_time <= REAL(3.0))) {
        return RIGID_GEAR_BAD_BANDWIDTH;
    }
    if (!(time_unit > REAL(0.0)) || !finite_number(time_unit)) {
        return RIGID_GEAR_BAD_TIME_UNIT;
    }
    compute_coefficients(monitor, parameters, sample_time, bandwidth);
    if (!coefficients_are_finite(monitor)) {
        return RIGID_GEAR_BAD_COEFFICIENT;
    }
    monitor->settle[RIGID_GEAR_R1] = samples(REAL(9.233413476451586), sample_time, bandwidth);
    monitor->settle[RIGID_GEAR_R2] = samples(REAL(6.907755278982138), sample_time, bandwidth);
    return RIGID_GEAR_OK;
}

void rigid_gear_exact(
    const rigid_gear_monitor *monitor,
    const rigid_gear_derivatives *derivatives,
    rigid_gear_real residuals[RIGID_GEAR_RESIDUALS])
{
    const rigid_gear_coefficients *c = &monitor->c;
    const rigid_gear_derivatives *d = derivatives;
    real *r = residuals;

    /* rigid_gear.bg:14: r1 = T - f1*w1 - J1*D(w1) - (f2*w2 + J2*D(w2))/N */
    r[RIGID_GEAR_R1] = d->T - c->r1_w1 * d->w1[0] - c->r1_w1_1 * d->w1[1] - c->r1_w2 * d->w2[0]
        - c->r1_w2_1 * d->w2[1];

    /* rigid_gear.bg:14: r2 = w1 - N*w2 */
    r[RIGID_GEAR_R2] = d->w1[0] - c->r2_w2 * d->w2[0];
}

/* r1 on its first sample: the filter as if it had always been so. */
static void start_r1(
    rigid_gear_monitor *monitor, const rigid_gear_samples *s, real *r)
{
    const rigid_gear_coefficients *c = &monitor->c;
    rigid_gear_memory *x = &monitor->x;

    /* rigid_gear.bg:14: r1: terms of order 0 */
    const real r1_g0 = s->T - c->r1_w1 * s->w1 - c->r1_w2 * s->w2;

    /* rigid_gear.bg:14: r1: degree 1 */
    const real r1_d1 = -c->r1_w1_w1 * s->w1 - c->r1_w1_w2 * s->w2;

    /* rigid_gear.bg:14: r1: error of order 0 */
    const real r1_e0 = c->bend1 * r1_g0;

    /* rigid_gear.bg:14: r1: input of stage 2 */
    const real r1_u2 = r1_g0 - r1_d1 - r1_e0;

    /* rigid_gear.bg:14: r1: stage 2, at rest */
    const real r1_y2 = r1_u2;

    /* rigid_gear.bg:14: r1: stage 2: memory */
    x->r1_s2 = c->rest * r1_u2;

    /* rigid_gear.bg:14: r1: input of stage 1 */
    const real r1_u1 = r1_y2 + r1_d1 + REAL(2.0) * r1_e0;

    /* rigid_gear.bg:14: r1: stage 1, at rest */
    const real r1_y1 = r1_u1;

    /* rigid_gear.bg:14: r1: stage 1: memory */
    x->r1_s1 = c->rest * r1_u1;

    /* rigid_gear.bg:14: r1 = T - f1*w1 - J1*D(w1) - (f2*w2 + J2*D(w2))/N */
    r[RIGID_GEAR_R1] = r1_y1 - r1_e0;
}

/* r1 on every further sample. */
static void next_r1(
    rigid_gear_monitor *monitor, const rigid_gear_samples *s, real *r)
{
    const rigid_gear_coefficients *c = &monitor->c;
    rigid_gear_memory *x = &monitor->x;

    /* rigid_gear.bg:14: r1: terms of order 0 */
    const real r1_g0 = s->T - c->r1_w1 * s->w1 - c->r1_w2 * s->w2;

    /* rigid_gear.bg:14: r1: degree 1 */
    const real r1_d1 = -c->r1_w1_w1 * s->w1 - c->r1_w1_w2 * s->w2;

    /* rigid_gear.bg:14: r1: error of order 0 */
    const real r1_e0 = c->bend1 * r1_g0;

    /* rigid_gear.bg:14: r1: input of stage 2 */
    const real r1_u2 = r1_g0 - r1_d1 - r1_e0;

    /* rigid_gear.bg:14: r1: stage 2 */
    const real r1_y2 = x->r1_s2 + c->b * r1_u2;

    /* rigid_gear.bg:14: r1: stage 2: memory */
    x->r1_s2 = c->a * r1_y2 + c->b * r1_u2;

    /* rigid_gear.bg:14: r1: input of stage 1 */
    const real r1_u1 = r1_y2 + r1_d1 + REAL(2.0) * r1_e0;

    /* rigid_gear.bg:14: r1: stage 1 */
    const real r1_y1 = x->r1_s1 + c->b * r1_u1;

    /* rigid_gear.bg:14: r1: stage 1: memory */
    x->r1_s1 = c->a * r1_y1 + c->b * r1_u1;

    /* rigid_gear.bg:14: r1 = T - f1*w1 - J1*D(w1) - (f2*w2 + J2*D(w2))/N */
    r[RIGID_GEAR_R1] = r1_y1 - r1_e0;
}

/* One sample for r1; a number that is not finite makes the next sample the first. */
static void run_r1(
    rigid_gear_monitor *monitor, const rigid_gear_samples *s, rigid_gear_residuals *residuals)
{
    real *r = residuals->value;
    uint32_t age = monitor->age[0];

    if (age == 0u) {
        start_r1(monitor, s, r);
    } else {
        next_r1(monitor, s, r);
    }
    /* a sum is finite only if all its terms are */
    if (finite_number(s->T + s->w1 + s->w2 + r[RIGID_GEAR_R1])) {
        age += age < UINT32_MAX ? 1u : 0u;
    } else {
        age = 0u;
        r[RIGID_GEAR_R1] = REAL(0.0);
    }
    monitor->age[0] = age;
    residuals->valid[RIGID_GEAR_R1] = age > monitor->settle[RIGID_GEAR_R1];
}

/* r2 on its first sample: the filter as if it had always been so. */
static void start_r2(
    rigid_gear_monitor *monitor, const rigid_gear_samples *s, real *r)
{
    const rigid_gear_coefficients *c = &monitor->c;
    rigid_gear_memory *x = &monitor->x;

    /* rigid_gear.bg:14: r2: input of stage 1 */
    const real r2_u1 = s->w1 - c->r2_w2 * s->w2;

    /* rigid_gear.bg:14: r2: stage 1, at rest */
    const real r2_y1 = r2_u1;

    /* rigid_gear.bg:14: r2: stage 1: memory */
    x->r2_s1 = c->rest * r2_u1;

    /* rigid_gear.bg:14: r2 = w1 - N*w2 */
    r[RIGID_GEAR_R2] = r2_y1;
}

/* r2 on every further sample. */
static void next_r2(
    rigid_gear_monitor *monitor, const rigid_gear_samples *s, real *r)
{
    const rigid_gear_coefficients *c = &monitor->c;
    rigid_gear_memory *x = &monitor->x;

    /* rigid_gear.bg:14: r2: input of stage 1 */
    const real r2_u1 = s->w1 - c->r2_w2 * s->w2;

    /* rigid_gear.bg:14: r2: stage 1 */
    const real r2_y1 = x->r2_s1 + c->b * r2_u1;

    /* rigid_gear.bg:14: r2: stage 1: memory */
    x->r2_s1 = c->a * r2_y1 + c->b * r2_u1;

    /* rigid_gear.bg:14: r2 = w1 - N*w2 */
    r[RIGID_GEAR_R2] = r2_y1;
}

/* One sample for r2; a number that is not finite makes the next sample the first. */
static void run_r2(
    rigid_gear_monitor *monitor, const rigid_gear_samples *s, rigid_gear_residuals *residuals)
{
    real *r = residuals->value;
    uint32_t age = monitor->age[1];

    if (age == 0u) {
        start_r2(monitor, s, r);
    } else {
        next_r2(monitor, s, r);
    }
    /* a sum is finite only if all its terms are */
    if (finite_number(s->w1 + s->w2 + r[RIGID_GEAR_R2])) {
        age += age < UINT32_MAX ? 1u : 0u;
    } else {
        age = 0u;
        r[RIGID_GEAR_R2] = REAL(0.0);
    }
    monitor->age[1] = age;
    residuals->valid[RIGID_GEAR_R2] = age > monitor->settle[RIGID_GEAR_R2];
}

void rigid_gear_reset(rigid_gear_monitor *monitor)
{
    int k;

    for (k = 0; k < 2; ++k) {
        monitor->age[k] = 0u;
    }
}

void rigid_gear_step(
    rigid_gear_monitor *monitor,
    const rigid_gear_samples *samples,
    rigid_gear_residuals *residuals)
{
    run_r1(monitor, samples, residuals);
    run_r2(monitor, samples, residuals);
}

const char rigid_gear_fault_name[RIGID_GEAR_FAULTS][3] = {
    "J1", "f1", "J2", "f2", "T", "N", "w1", "w2",
};

const uint16_t rigid_gear_fault_class[RIGID_GEAR_FAULTS] = {
    0u, 0u, 0u, 0u, 0u, 1u, 1u, 1u,
};

const char rigid_gear_residual_name[RIGID_GEAR_RESIDUALS][3] = {
    "r1", "r2",
};

/* Signatures: 1 where a residual may be moved by the faults of a class, 3 where it is for sure. */
static const uint8_t signature[RIGID_GEAR_CLASSES][RIGID_GEAR_RESIDUALS] = {
    {3u, 0u},
    {3u, 3u},
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
    rigid_gear_diagnosis *d, const rigid_gear_limit *limit, int k, real off, real out, real bound)
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

static bool sums_are_zero(const rigid_gear_diagnosis *d, int k)
{
    const real sum = d->above[k] + d->below[k] + d->louder[k];

    return !(sum > REAL(0.0));
}

static void forget_sums(rigid_gear_diagnosis *d, int k)
{
    d->above[k] = REAL(0.0);
    d->below[k] = REAL(0.0);
    d->louder[k] = REAL(0.0);
    d->streak[k] = 0u;
}

/* Residual k in one sample; whether it goes into alarm. */
static bool watch(
    rigid_gear_diagnosis *d, const rigid_gear_limit *limit, int k, real value, real bound, bool row)
{
    const real off = value - limit->mean;
    const real out = (off < REAL(0.0) ? -off : off) - bound;
    bool high = false;

    if (row) {
        high = add_row(d, limit, k, off, out, bound);
    }
    if (d->state[k] == RIGID_GEAR_ALARM) {
        d->since[k] += d->since[k] < UINT32_MAX ? 1u : 0u;
        if (!(out < RELEASE * limit->level) || !sums_are_zero(d, k)) {
            d->quiet = 0u;
        }
        return false;
    }
    d->state[k] = RIGID_GEAR_HEALTHY;
    d->streak[k] = out > limit->level ? d->streak[k] + 1u : 0u;
    if (d->streak[k] < d->least && !high) {
        return false;
    }
    d->state[k] = RIGID_GEAR_ALARM;
    d->since[k] = 0u;
    return true;
}

/* What is left of a class of faults. */
static rigid_gear_candidate left_of(const rigid_gear_diagnosis *d, const uint8_t *own)
{
    rigid_gear_candidate found = RIGID_GEAR_LIKELY;
    int k;

    for (k = 0; k < RIGID_GEAR_RESIDUALS; ++k) {
        if (d->state[k] == RIGID_GEAR_ALARM && own[k] == 0u) {
            return RIGID_GEAR_RULED_OUT;
        }
        if (d->state[k] == RIGID_GEAR_HEALTHY && own[k] == 3u) {
            found = RIGID_GEAR_SMALL;
        }
    }
    return found;
}

/* Which classes of faults the residuals leave, and the one if it is one. */
static void judge(rigid_gear_diagnosis *d)
{
    int likely = 0;
    int c;

    d->fault_class = RIGID_GEAR_UNKNOWN;
    for (c = 0; c < RIGID_GEAR_CLASSES; ++c) {
        const rigid_gear_candidate left = left_of(d, signature[c]);

        d->candidate[c] = (uint8_t)left;
        if (left == RIGID_GEAR_LIKELY) {
            d->fault_class = (int16_t)c;
            ++likely;
        }
    }
    if (likely != 1 || d->settled < 2u * d->row) {
        d->fault_class = RIGID_GEAR_UNKNOWN;
    }
}

rigid_gear_limit rigid_gear_limit_of(rigid_gear_real level)
{
    rigid_gear_limit limit;

    limit.mean = REAL(0.0);
    limit.level = level;
    limit.unit = REAL(0.0);
    limit.loud = REAL(0.0);
    limit.drift = REAL(0.5);
    limit.height = NEVER;
    limit.bound = REAL(0.0);
    return limit;
}

void rigid_gear_clear(rigid_gear_diagnosis *diagnosis)
{
    int k;

    for (k = 0; k < RIGID_GEAR_RESIDUALS; ++k) {
        if (diagnosis->state[k] == RIGID_GEAR_ALARM) {
            diagnosis->state[k] = RIGID_GEAR_HEALTHY;
        }
        diagnosis->since[k] = 0u;
        forget_sums(diagnosis, k);
    }
    for (k = 0; k < RIGID_GEAR_CLASSES; ++k) {
        diagnosis->candidate[k] = RIGID_GEAR_RULED_OUT;
    }
    diagnosis->fault_class = RIGID_GEAR_UNKNOWN;
    diagnosis->quiet = 0u;
    diagnosis->settled = 0u;
}

void rigid_gear_diagnosis_reset(rigid_gear_diagnosis *diagnosis)
{
    int k;

    diagnosis->row = RIGID_GEAR_ROW;
    diagnosis->least = 15u;
    diagnosis->hold = 10u * RIGID_GEAR_ROW;
    diagnosis->latch = false;
    diagnosis->tick = 0u;
    for (k = 0; k < RIGID_GEAR_RESIDUALS; ++k) {
        diagnosis->state[k] = RIGID_GEAR_BLIND;
    }
    rigid_gear_clear(diagnosis);
}

bool rigid_gear_diagnose(
    rigid_gear_diagnosis *diagnosis,
    const rigid_gear_limit *limits,
    const rigid_gear_real *bounds,
    const rigid_gear_residuals *residuals)
{
    rigid_gear_diagnosis *d = diagnosis;
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
    for (k = 0; k < RIGID_GEAR_RESIDUALS; ++k) {
        if (residuals->valid[k]) {
            const real bound = bounds ? bounds[k] : limits[k].bound;

            fresh = watch(d, &limits[k], k, residuals->value[k], bound, row) || fresh;
        } else {
            forget_sums(d, k);
            if (d->state[k] == RIGID_GEAR_ALARM) {
                d->quiet = 0u; /* nobody knows that it is over */
            } else {
                d->state[k] = RIGID_GEAR_BLIND;
            }
        }
        alarm = alarm || d->state[k] == RIGID_GEAR_ALARM;
    }
    if (fresh) {
        d->quiet = 0u;
        d->settled = 0u;
    }
    if (alarm && !d->latch && d->quiet >= d->hold) {
        rigid_gear_clear(d);
        return false;
    }
    if (fresh || (alarm && row)) {
        judge(d);
    }
    return alarm;
}
