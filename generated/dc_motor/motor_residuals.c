/* motor_residuals.c: the residuals of Motor; generated, see the header. */
#include "motor_residuals.h"


#if defined __FINITE_MATH_ONLY__ && __FINITE_MATH_ONLY__
#error "this code tells numbers from NaN: compile it without -ffinite-math-only (-ffast-math)"
#endif

typedef motor_real real;

#define REAL(x) MOTOR_CONSTANT(x)
#if defined MOTOR_FLOAT && !defined MOTOR_REAL
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

uint32_t motor_abi(void)
{
    return MOTOR_ABI;
}

const char *motor_digest(void)
{
    return MOTOR_DIGEST;
}

void motor_nominal(motor_parameters *parameters)
{
    parameters->L = REAL(0.0003);    /* H */
    parameters->R = REAL(17.6);      /* Ohm */
    parameters->k = REAL(0.00351);   /* N.m/A */
    parameters->J = REAL(1.4e-08);   /* kg.m^2 */
    parameters->f = REAL(1.19e-05);  /* N.m.s/rad */
}

/* The coefficients of exact and of the filter, from the parameters. */
static void compute_coefficients(motor_monitor *monitor, const motor_parameters *p,
        real sample_time, real bandwidth)
{
    motor_coefficients *c = &monitor->c;

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

    /* dc_motor.bg:13: r1: factor of speed: k */
    c->r1_speed = p->k;

    /* dc_motor.bg:13: r1: factor of current: R */
    c->r1_current = p->R;

    /* dc_motor.bg:13: r1: factor of current': L */
    c->r1_current_1 = p->L;

    /* dc_motor.bg:13: r1: factor of current' */
    c->r1_w1_current = p->L * w;

    /* filter: 1 * (w*sample_time)^2/12 */
    c->bend1 = turn * turn / REAL(12.0);

    /* filter: what is left of a memory a sample later */
    c->a = pole;

    /* filter: weight of a sample, new and a sample later */
    c->b = REAL(0.5) * t;

    /* filter: 1 - b, the memory of a constant 1 */
    c->rest = REAL(1.0) - REAL(0.5) * t;

    /* dc_motor.bg:20: r2: factor of speed: f */
    c->r2_speed = p->f;

    /* dc_motor.bg:20: r2: factor of speed': J */
    c->r2_speed_1 = p->J;

    /* dc_motor.bg:20: r2: factor of speed' */
    c->r2_w1_speed = p->J * w;
}

static bool parameters_are_finite(const motor_parameters *p)
{
    return finite_number(p->L + p->R + p->k + p->J + p->f);
}

static bool coefficients_are_finite(const motor_monitor *monitor)
{
    return finite_number(monitor->c.r1_speed + monitor->c.r1_current + monitor->c.r1_current_1
            + monitor->c.r1_w1_current + monitor->c.bend1 + monitor->c.a + monitor->c.b
            + monitor->c.rest + monitor->c.r2_speed + monitor->c.r2_speed_1
            + monitor->c.r2_w1_speed);
}

/* Samples until `constants` time constants of the filter are over. */
static uint32_t samples(real constants, real sample_time, real bandwidth)
{
    const real wait = constants / (bandwidth * sample_time);
    const uint32_t whole = wait < REAL(4.0e9) ? (uint32_t)wait : UINT32_MAX - 1u;

    return (real)whole < wait ? whole + 1u : whole;
}

motor_status motor_configure(
    motor_monitor *monitor,
    const motor_parameters *parameters,
    motor_real sample_time,
    motor_real bandwidth,
    motor_real time_unit)
{
    int k;

    for (k = 0; k < MOTOR_RESIDUALS; ++k) {
        monitor->settle[k] = UINT32_MAX;
    }
    motor_reset(monitor);
    if (!parameters_are_finite(parameters)) {
        return MOTOR_BAD_PARAMETER;
    }
    if (!(sample_time > REAL(0.0)) || !finite_number(sample_time)) {
        return MOTOR_BAD_SAMPLE_TIME;
    }
    if (!(bandwidth * sample_time >= SLOWEST && bandwidth * sample_time <= REAL(3.0))) {
        return MOTOR_BAD_BANDWIDTH;
    }
    if (!(time_unit > REAL(0.0)) || !finite_number(time_unit)) {
        return MOTOR_BAD_TIME_UNIT;
    }
    compute_coefficients(monitor, parameters, sample_time, bandwidth);
    if (!coefficients_are_finite(monitor)) {
        return MOTOR_BAD_COEFFICIENT;
    }
    monitor->settle[MOTOR_R1] = samples(REAL(9.233413476451586), sample_time, bandwidth);
    monitor->settle[MOTOR_R2] = samples(REAL(9.233413476451586), sample_time, bandwidth);
    return MOTOR_OK;
}

void motor_exact(
    const motor_monitor *monitor,
    const motor_derivatives *derivatives,
    motor_real residuals[MOTOR_RESIDUALS])
{
    const motor_coefficients *c = &monitor->c;
    const motor_derivatives *d = derivatives;
    real *r = residuals;

    /* dc_motor.bg:13: r1 = U - k*speed - R*current - L*D(current) */
    r[MOTOR_R1] = d->U - c->r1_speed * d->speed[0] - c->r1_current * d->current[0]
        - c->r1_current_1 * d->current[1];

    /* dc_motor.bg:20: r2 = load + f*speed + J*D(speed) - k*current */
    r[MOTOR_R2] = d->load + c->r2_speed * d->speed[0] + c->r2_speed_1 * d->speed[1]
        - c->r1_speed * d->current[0];
}

/* r1 on its first sample: the filter as if it had always been so. */
static void start_r1(
    motor_monitor *monitor, const motor_samples *s, real *r)
{
    const motor_coefficients *c = &monitor->c;
    motor_memory *x = &monitor->x;

    /* dc_motor.bg:13: r1: terms of order 0 */
    const real r1_g0 = s->U - c->r1_speed * s->speed - c->r1_current * s->current;

    /* dc_motor.bg:13: r1: degree 1 */
    const real r1_d1 = c->r1_w1_current * s->current;

    /* dc_motor.bg:13: r1: error of order 0 */
    const real r1_e0 = c->bend1 * r1_g0;

    /* dc_motor.bg:13: r1: input of stage 2 */
    const real r1_u2 = r1_g0 + r1_d1 - r1_e0;

    /* dc_motor.bg:13: r1: stage 2, at rest */
    const real r1_y2 = r1_u2;

    /* dc_motor.bg:13: r1: stage 2: memory */
    x->r1_s2 = c->rest * r1_u2;

    /* dc_motor.bg:13: r1: input of stage 1 */
    const real r1_u1 = r1_y2 + REAL(2.0) * r1_e0 - r1_d1;

    /* dc_motor.bg:13: r1: stage 1, at rest */
    const real r1_y1 = r1_u1;

    /* dc_motor.bg:13: r1: stage 1: memory */
    x->r1_s1 = c->rest * r1_u1;

    /* dc_motor.bg:13: r1 = U - k*speed - R*current - L*D(current) */
    r[MOTOR_R1] = r1_y1 - r1_e0;
}

/* r1 on every further sample. */
static void next_r1(
    motor_monitor *monitor, const motor_samples *s, real *r)
{
    const motor_coefficients *c = &monitor->c;
    motor_memory *x = &monitor->x;

    /* dc_motor.bg:13: r1: terms of order 0 */
    const real r1_g0 = s->U - c->r1_speed * s->speed - c->r1_current * s->current;

    /* dc_motor.bg:13: r1: degree 1 */
    const real r1_d1 = c->r1_w1_current * s->current;

    /* dc_motor.bg:13: r1: error of order 0 */
    const real r1_e0 = c->bend1 * r1_g0;

    /* dc_motor.bg:13: r1: input of stage 2 */
    const real r1_u2 = r1_g0 + r1_d1 - r1_e0;

    /* dc_motor.bg:13: r1: stage 2 */
    const real r1_y2 = x->r1_s2 + c->b * r1_u2;

    /* dc_motor.bg:13: r1: stage 2: memory */
    x->r1_s2 = c->a * r1_y2 + c->b * r1_u2;

    /* dc_motor.bg:13: r1: input of stage 1 */
    const real r1_u1 = r1_y2 + REAL(2.0) * r1_e0 - r1_d1;

    /* dc_motor.bg:13: r1: stage 1 */
    const real r1_y1 = x->r1_s1 + c->b * r1_u1;

    /* dc_motor.bg:13: r1: stage 1: memory */
    x->r1_s1 = c->a * r1_y1 + c->b * r1_u1;

    /* dc_motor.bg:13: r1 = U - k*speed - R*current - L*D(current) */
    r[MOTOR_R1] = r1_y1 - r1_e0;
}

/* One sample for r1; a number that is not finite makes the next sample the first. */
static void run_r1(
    motor_monitor *monitor, const motor_samples *s, motor_residuals *residuals)
{
    real *r = residuals->value;
    uint32_t age = monitor->age[0];

    if (age == 0u) {
        start_r1(monitor, s, r);
    } else {
        next_r1(monitor, s, r);
    }
    /* a sum is finite only if all its terms are */
    if (finite_number(s->U + s->current + s->speed + r[MOTOR_R1])) {
        age += age < UINT32_MAX ? 1u : 0u;
    } else {
        age = 0u;
        r[MOTOR_R1] = REAL(0.0);
    }
    monitor->age[0] = age;
    residuals->valid[MOTOR_R1] = age > monitor->settle[MOTOR_R1];
}

/* r2 on its first sample: the filter as if it had always been so. */
static void start_r2(
    motor_monitor *monitor, const motor_samples *s, real *r)
{
    const motor_coefficients *c = &monitor->c;
    motor_memory *x = &monitor->x;

    /* dc_motor.bg:20: r2: terms of order 0 */
    const real r2_g0 = s->load + c->r2_speed * s->speed - c->r1_speed * s->current;

    /* dc_motor.bg:20: r2: degree 1 */
    const real r2_d1 = c->r2_w1_speed * s->speed;

    /* dc_motor.bg:20: r2: error of order 0 */
    const real r2_e0 = c->bend1 * r2_g0;

    /* dc_motor.bg:20: r2: input of stage 2 */
    const real r2_u2 = r2_g0 - r2_d1 - r2_e0;

    /* dc_motor.bg:20: r2: stage 2, at rest */
    const real r2_y2 = r2_u2;

    /* dc_motor.bg:20: r2: stage 2: memory */
    x->r2_s2 = c->rest * r2_u2;

    /* dc_motor.bg:20: r2: input of stage 1 */
    const real r2_u1 = r2_y2 + r2_d1 + REAL(2.0) * r2_e0;

    /* dc_motor.bg:20: r2: stage 1, at rest */
    const real r2_y1 = r2_u1;

    /* dc_motor.bg:20: r2: stage 1: memory */
    x->r2_s1 = c->rest * r2_u1;

    /* dc_motor.bg:20: r2 = load + f*speed + J*D(speed) - k*current */
    r[MOTOR_R2] = r2_y1 - r2_e0;
}

/* r2 on every further sample. */
static void next_r2(
    motor_monitor *monitor, const motor_samples *s, real *r)
{
    const motor_coefficients *c = &monitor->c;
    motor_memory *x = &monitor->x;

    /* dc_motor.bg:20: r2: terms of order 0 */
    const real r2_g0 = s->load + c->r2_speed * s->speed - c->r1_speed * s->current;

    /* dc_motor.bg:20: r2: degree 1 */
    const real r2_d1 = c->r2_w1_speed * s->speed;

    /* dc_motor.bg:20: r2: error of order 0 */
    const real r2_e0 = c->bend1 * r2_g0;

    /* dc_motor.bg:20: r2: input of stage 2 */
    const real r2_u2 = r2_g0 - r2_d1 - r2_e0;

    /* dc_motor.bg:20: r2: stage 2 */
    const real r2_y2 = x->r2_s2 + c->b * r2_u2;

    /* dc_motor.bg:20: r2: stage 2: memory */
    x->r2_s2 = c->a * r2_y2 + c->b * r2_u2;

    /* dc_motor.bg:20: r2: input of stage 1 */
    const real r2_u1 = r2_y2 + r2_d1 + REAL(2.0) * r2_e0;

    /* dc_motor.bg:20: r2: stage 1 */
    const real r2_y1 = x->r2_s1 + c->b * r2_u1;

    /* dc_motor.bg:20: r2: stage 1: memory */
    x->r2_s1 = c->a * r2_y1 + c->b * r2_u1;

    /* dc_motor.bg:20: r2 = load + f*speed + J*D(speed) - k*current */
    r[MOTOR_R2] = r2_y1 - r2_e0;
}

/* One sample for r2; a number that is not finite makes the next sample the first. */
static void run_r2(
    motor_monitor *monitor, const motor_samples *s, motor_residuals *residuals)
{
    real *r = residuals->value;
    uint32_t age = monitor->age[1];

    if (age == 0u) {
        start_r2(monitor, s, r);
    } else {
        next_r2(monitor, s, r);
    }
    /* a sum is finite only if all its terms are */
    if (finite_number(s->load + s->current + s->speed + r[MOTOR_R2])) {
        age += age < UINT32_MAX ? 1u : 0u;
    } else {
        age = 0u;
        r[MOTOR_R2] = REAL(0.0);
    }
    monitor->age[1] = age;
    residuals->valid[MOTOR_R2] = age > monitor->settle[MOTOR_R2];
}

void motor_reset(motor_monitor *monitor)
{
    int k;

    for (k = 0; k < 2; ++k) {
        monitor->age[k] = 0u;
    }
}

void motor_step(
    motor_monitor *monitor,
    const motor_samples *samples,
    motor_residuals *residuals)
{
    run_r1(monitor, samples, residuals);
    run_r2(monitor, samples, residuals);
}

const char motor_fault_name[MOTOR_FAULTS][8] = {
    "L", "R", "U", "k", "current", "speed", "J", "f", "load",
};

const uint16_t motor_fault_class[MOTOR_FAULTS] = {
    0u, 0u, 0u, 1u, 1u, 1u, 2u, 2u, 2u,
};

const char motor_residual_name[MOTOR_RESIDUALS][3] = {
    "r1", "r2",
};

/* Signatures: 1 where a residual may be moved by the faults of a class, 3 where it is for sure. */
static const uint8_t signature[MOTOR_CLASSES][MOTOR_RESIDUALS] = {
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
    motor_diagnosis *d, const motor_limit *limit, int k, real off, real out, real bound)
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

static bool sums_are_zero(const motor_diagnosis *d, int k)
{
    const real sum = d->above[k] + d->below[k] + d->louder[k];

    return !(sum > REAL(0.0));
}

static void forget_sums(motor_diagnosis *d, int k)
{
    d->above[k] = REAL(0.0);
    d->below[k] = REAL(0.0);
    d->louder[k] = REAL(0.0);
    d->streak[k] = 0u;
}

/* Residual k in one sample; whether it goes into alarm. */
static bool watch(
    motor_diagnosis *d, const motor_limit *limit, int k, real value, real bound, bool row)
{
    const real off = value - limit->mean;
    const real out = (off < REAL(0.0) ? -off : off) - bound;
    bool high = false;

    if (row) {
        high = add_row(d, limit, k, off, out, bound);
    }
    if (d->state[k] == MOTOR_ALARM) {
        d->since[k] += d->since[k] < UINT32_MAX ? 1u : 0u;
        if (!(out < RELEASE * limit->level) || !sums_are_zero(d, k)) {
            d->quiet = 0u;
        }
        return false;
    }
    d->state[k] = MOTOR_HEALTHY;
    d->streak[k] = out > limit->level ? d->streak[k] + 1u : 0u;
    if (d->streak[k] < d->least && !high) {
        return false;
    }
    d->state[k] = MOTOR_ALARM;
    d->since[k] = 0u;
    return true;
}

/* What is left of a class of faults. */
static motor_candidate left_of(const motor_diagnosis *d, const uint8_t *own)
{
    motor_candidate found = MOTOR_LIKELY;
    int k;

    for (k = 0; k < MOTOR_RESIDUALS; ++k) {
        if (d->state[k] == MOTOR_ALARM && own[k] == 0u) {
            return MOTOR_RULED_OUT;
        }
        if (d->state[k] == MOTOR_HEALTHY && own[k] == 3u) {
            found = MOTOR_SMALL;
        }
    }
    return found;
}

/* Which classes of faults the residuals leave, and the one if it is one. */
static void judge(motor_diagnosis *d)
{
    int likely = 0;
    int c;

    d->fault_class = MOTOR_UNKNOWN;
    for (c = 0; c < MOTOR_CLASSES; ++c) {
        const motor_candidate left = left_of(d, signature[c]);

        d->candidate[c] = (uint8_t)left;
        if (left == MOTOR_LIKELY) {
            d->fault_class = (int16_t)c;
            ++likely;
        }
    }
    if (likely != 1 || d->settled < 2u * d->row) {
        d->fault_class = MOTOR_UNKNOWN;
    }
}

motor_limit motor_limit_of(motor_real level)
{
    motor_limit limit;

    limit.mean = REAL(0.0);
    limit.level = level;
    limit.unit = REAL(0.0);
    limit.loud = REAL(0.0);
    limit.drift = REAL(0.5);
    limit.height = NEVER;
    limit.bound = REAL(0.0);
    return limit;
}

void motor_clear(motor_diagnosis *diagnosis)
{
    int k;

    for (k = 0; k < MOTOR_RESIDUALS; ++k) {
        if (diagnosis->state[k] == MOTOR_ALARM) {
            diagnosis->state[k] = MOTOR_HEALTHY;
        }
        diagnosis->since[k] = 0u;
        forget_sums(diagnosis, k);
    }
    for (k = 0; k < MOTOR_CLASSES; ++k) {
        diagnosis->candidate[k] = MOTOR_RULED_OUT;
    }
    diagnosis->fault_class = MOTOR_UNKNOWN;
    diagnosis->quiet = 0u;
    diagnosis->settled = 0u;
}

void motor_diagnosis_reset(motor_diagnosis *diagnosis)
{
    int k;

    diagnosis->row = MOTOR_ROW;
    diagnosis->least = 15u;
    diagnosis->hold = 10u * MOTOR_ROW;
    diagnosis->latch = false;
    diagnosis->tick = 0u;
    for (k = 0; k < MOTOR_RESIDUALS; ++k) {
        diagnosis->state[k] = MOTOR_BLIND;
    }
    motor_clear(diagnosis);
}

bool motor_diagnose(
    motor_diagnosis *diagnosis,
    const motor_limit *limits,
    const motor_real *bounds,
    const motor_residuals *residuals)
{
    motor_diagnosis *d = diagnosis;
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
    for (k = 0; k < MOTOR_RESIDUALS; ++k) {
        if (residuals->valid[k]) {
            const real bound = bounds ? bounds[k] : limits[k].bound;

            fresh = watch(d, &limits[k], k, residuals->value[k], bound, row) || fresh;
        } else {
            forget_sums(d, k);
            if (d->state[k] == MOTOR_ALARM) {
                d->quiet = 0u; /* nobody knows that it is over */
            } else {
                d->state[k] = MOTOR_BLIND;
            }
        }
        alarm = alarm || d->state[k] == MOTOR_ALARM;
    }
    if (fresh) {
        d->quiet = 0u;
        d->settled = 0u;
    }
    if (alarm && !d->latch && d->quiet >= d->hold) {
        motor_clear(d);
        return false;
    }
    if (fresh || (alarm && row)) {
        judge(d);
    }
    return alarm;
}
