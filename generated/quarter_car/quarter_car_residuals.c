/* quarter_car_residuals.c: the residuals of QuarterCar; generated, see the header. */
#include "quarter_car_residuals.h"


#if defined __FINITE_MATH_ONLY__ && __FINITE_MATH_ONLY__
#error "this code tells numbers from NaN: compile it without -ffinite-math-only (-ffast-math)"
#endif

typedef quarter_car_real real;

#define REAL(x) QUARTER_CAR_CONSTANT(x)
#if defined QUARTER_CAR_FLOAT && !defined QUARTER_CAR_REAL
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

uint32_t quarter_car_abi(void)
{
    return QUARTER_CAR_ABI;
}

const char *quarter_car_digest(void)
{
    return QUARTER_CAR_DIGEST;
}

void quarter_car_nominal(quarter_car_parameters *parameters)
{
    parameters->g = REAL(9.81);      /* m/s^2 */
    parameters->ms = REAL(320.0);    /* kg */
    parameters->ks = REAL(18000.0);  /* N/m */
    parameters->cs = REAL(1000.0);   /* kg/s */
}

/* The coefficients of exact and of the filter, from the parameters. */
static void compute_coefficients(quarter_car_monitor *monitor, const quarter_car_parameters *p,
        real sample_time, real bandwidth)
{
    quarter_car_coefficients *c = &monitor->c;

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

    /* quarter_car.bg:15: r1: factor of 1: g*ms */
    c->r1_constant = p->g * p->ms;

    /* quarter_car.bg:15: r1: factor of stroke: ks */
    c->r1_stroke = p->ks;

    /* quarter_car.bg:15: r1: factor of vw: cs */
    c->r1_vw = p->cs;

    /* quarter_car.bg:15: r1: factor of vb': ms */
    c->r1_vb_1 = p->ms;

    /* quarter_car.bg:15: r1: factor of vb' */
    c->r1_w1_vb = p->ms * w;

    /* filter: 1 * (w*sample_time)^2/12 */
    c->bend1 = turn * turn / REAL(12.0);

    /* filter: what is left of a memory a sample later */
    c->a = pole;

    /* filter: weight of a sample, new and a sample later */
    c->b = REAL(0.5) * t;

    /* filter: 1 - b, the memory of a constant 1 */
    c->rest = REAL(1.0) - REAL(0.5) * t;

    /* quarter_car.bg:24: r2: factor of stroke' */
    c->r2_w1_stroke = w;
}

static bool parameters_are_finite(const quarter_car_parameters *p)
{
    return finite_number(p->g + p->ms + p->ks + p->cs);
}

static bool coefficients_are_finite(const quarter_car_monitor *monitor)
{
    return finite_number(monitor->c.r1_constant + monitor->c.r1_stroke + monitor->c.r1_vw
            + monitor->c.r1_vb_1 + monitor->c.r1_w1_vb + monitor->c.bend1 + monitor->c.a
            + monitor->c.b + monitor->c.rest + monitor->c.r2_w1_stroke);
}

/* Samples until `constants` time constants of the filter are over. */
static uint32_t samples(real constants, real sample_time, real bandwidth)
{
    const real wait = constants / (bandwidth * sample_time);
    const uint32_t whole = wait < REAL(4.0e9) ? (uint32_t)wait : UINT32_MAX - 1u;

    return (real)whole < wait ? whole + 1u : whole;
}

quarter_car_status quarter_car_configure(
    quarter_car_monitor *monitor,
    const quarter_car_parameters *parameters,
    quarter_car_real sample_time,
    quarter_car_real bandwidth,
    quarter_car_real time_unit)
{
    int k;

    for (k = 0; k < QUARTER_CAR_RESIDUALS; ++k) {
        monitor->settle[k] = UINT32_MAX;
    }
    quarter_car_reset(monitor);
    if (!parameters_are_finite(parameters)) {
        return QUARTER_CAR_BAD_PARAMETER;
    }
    if (!(sample_time > REAL(0.0)) || !finite_number(sample_time)) {
        return QUARTER_CAR_BAD_SAMPLE_TIME;
    }
    if (!(bandwidth * sample_time >= SLOWEST && bandwidth * sample_time <= REAL(3.0))) {
        return QUARTER_CAR_BAD_BANDWIDTH;
    }
    if (!(time_unit > REAL(0.0)) || !finite_number(time_unit)) {
        return QUARTER_CAR_BAD_TIME_UNIT;
    }
    compute_coefficients(monitor, parameters, sample_time, bandwidth);
    if (!coefficients_are_finite(monitor)) {
        return QUARTER_CAR_BAD_COEFFICIENT;
    }
    monitor->settle[QUARTER_CAR_R1] = samples(REAL(9.233413476451586), sample_time, bandwidth);
    monitor->settle[QUARTER_CAR_R2] = samples(REAL(9.233413476451586), sample_time, bandwidth);
    return QUARTER_CAR_OK;
}

void quarter_car_exact(
    const quarter_car_monitor *monitor,
    const quarter_car_derivatives *derivatives,
    quarter_car_real residuals[QUARTER_CAR_RESIDUALS])
{
    const quarter_car_coefficients *c = &monitor->c;
    const quarter_car_derivatives *d = derivatives;
    real *r = residuals;

    /* quarter_car.bg:15: r1 = ks*stroke + cs*(vw - vb) - g*ms - ms*D(vb) */
    r[QUARTER_CAR_R1] = c->r1_stroke * d->stroke[0] + c->r1_vw * d->vw - c->r1_constant
        - c->r1_vw * d->vb[0] - c->r1_vb_1 * d->vb[1];

    /* quarter_car.bg:24: r2 = vw - vb - D(stroke) */
    r[QUARTER_CAR_R2] = d->vw - d->vb[0] - d->stroke[1];
}

/* r1 on its first sample: the filter as if it had always been so. */
static void start_r1(
    quarter_car_monitor *monitor, const quarter_car_samples *s, real *r)
{
    const quarter_car_coefficients *c = &monitor->c;
    quarter_car_memory *x = &monitor->x;

    /* quarter_car.bg:15: r1: terms of order 0 */
    const real r1_g0 = c->r1_stroke * s->stroke + c->r1_vw * s->vw - c->r1_constant
        - c->r1_vw * s->vb;

    /* quarter_car.bg:15: r1: degree 1 */
    const real r1_d1 = c->r1_w1_vb * s->vb;

    /* quarter_car.bg:15: r1: error of order 0 */
    const real r1_e0 = c->bend1 * r1_g0;

    /* quarter_car.bg:15: r1: input of stage 2 */
    const real r1_u2 = r1_g0 + r1_d1 - r1_e0;

    /* quarter_car.bg:15: r1: stage 2, at rest */
    const real r1_y2 = r1_u2;

    /* quarter_car.bg:15: r1: stage 2: memory */
    x->r1_s2 = c->rest * r1_u2;

    /* quarter_car.bg:15: r1: input of stage 1 */
    const real r1_u1 = r1_y2 + REAL(2.0) * r1_e0 - r1_d1;

    /* quarter_car.bg:15: r1: stage 1, at rest */
    const real r1_y1 = r1_u1;

    /* quarter_car.bg:15: r1: stage 1: memory */
    x->r1_s1 = c->rest * r1_u1;

    /* quarter_car.bg:15: r1 = ks*stroke + cs*(vw - vb) - g*ms - ms*D(vb) */
    r[QUARTER_CAR_R1] = r1_y1 - r1_e0;
}

/* r1 on every further sample. */
static void next_r1(
    quarter_car_monitor *monitor, const quarter_car_samples *s, real *r)
{
    const quarter_car_coefficients *c = &monitor->c;
    quarter_car_memory *x = &monitor->x;

    /* quarter_car.bg:15: r1: terms of order 0 */
    const real r1_g0 = c->r1_stroke * s->stroke + c->r1_vw * s->vw - c->r1_constant
        - c->r1_vw * s->vb;

    /* quarter_car.bg:15: r1: degree 1 */
    const real r1_d1 = c->r1_w1_vb * s->vb;

    /* quarter_car.bg:15: r1: error of order 0 */
    const real r1_e0 = c->bend1 * r1_g0;

    /* quarter_car.bg:15: r1: input of stage 2 */
    const real r1_u2 = r1_g0 + r1_d1 - r1_e0;

    /* quarter_car.bg:15: r1: stage 2 */
    const real r1_y2 = x->r1_s2 + c->b * r1_u2;

    /* quarter_car.bg:15: r1: stage 2: memory */
    x->r1_s2 = c->a * r1_y2 + c->b * r1_u2;

    /* quarter_car.bg:15: r1: input of stage 1 */
    const real r1_u1 = r1_y2 + REAL(2.0) * r1_e0 - r1_d1;

    /* quarter_car.bg:15: r1: stage 1 */
    const real r1_y1 = x->r1_s1 + c->b * r1_u1;

    /* quarter_car.bg:15: r1: stage 1: memory */
    x->r1_s1 = c->a * r1_y1 + c->b * r1_u1;

    /* quarter_car.bg:15: r1 = ks*stroke + cs*(vw - vb) - g*ms - ms*D(vb) */
    r[QUARTER_CAR_R1] = r1_y1 - r1_e0;
}

/* One sample for r1; a number that is not finite makes the next sample the first. */
static void run_r1(
    quarter_car_monitor *monitor, const quarter_car_samples *s, quarter_car_residuals *residuals)
{
    real *r = residuals->value;
    uint32_t age = monitor->age[0];

    if (age == 0u) {
        start_r1(monitor, s, r);
    } else {
        next_r1(monitor, s, r);
    }
    /* a sum is finite only if all its terms are */
    if (finite_number(s->vw + s->vb + s->stroke + r[QUARTER_CAR_R1])) {
        age += age < UINT32_MAX ? 1u : 0u;
    } else {
        age = 0u;
        r[QUARTER_CAR_R1] = REAL(0.0);
    }
    monitor->age[0] = age;
    residuals->valid[QUARTER_CAR_R1] = age > monitor->settle[QUARTER_CAR_R1];
}

/* r2 on its first sample: the filter as if it had always been so. */
static void start_r2(
    quarter_car_monitor *monitor, const quarter_car_samples *s, real *r)
{
    const quarter_car_coefficients *c = &monitor->c;
    quarter_car_memory *x = &monitor->x;

    /* quarter_car.bg:24: r2: terms of order 0 */
    const real r2_g0 = s->vw - s->vb;

    /* quarter_car.bg:24: r2: degree 1 */
    const real r2_d1 = c->r2_w1_stroke * s->stroke;

    /* quarter_car.bg:24: r2: error of order 0 */
    const real r2_e0 = c->bend1 * r2_g0;

    /* quarter_car.bg:24: r2: input of stage 2 */
    const real r2_u2 = r2_g0 + r2_d1 - r2_e0;

    /* quarter_car.bg:24: r2: stage 2, at rest */
    const real r2_y2 = r2_u2;

    /* quarter_car.bg:24: r2: stage 2: memory */
    x->r2_s2 = c->rest * r2_u2;

    /* quarter_car.bg:24: r2: input of stage 1 */
    const real r2_u1 = r2_y2 + REAL(2.0) * r2_e0 - r2_d1;

    /* quarter_car.bg:24: r2: stage 1, at rest */
    const real r2_y1 = r2_u1;

    /* quarter_car.bg:24: r2: stage 1: memory */
    x->r2_s1 = c->rest * r2_u1;

    /* quarter_car.bg:24: r2 = vw - vb - D(stroke) */
    r[QUARTER_CAR_R2] = r2_y1 - r2_e0;
}

/* r2 on every further sample. */
static void next_r2(
    quarter_car_monitor *monitor, const quarter_car_samples *s, real *r)
{
    const quarter_car_coefficients *c = &monitor->c;
    quarter_car_memory *x = &monitor->x;

    /* quarter_car.bg:24: r2: terms of order 0 */
    const real r2_g0 = s->vw - s->vb;

    /* quarter_car.bg:24: r2: degree 1 */
    const real r2_d1 = c->r2_w1_stroke * s->stroke;

    /* quarter_car.bg:24: r2: error of order 0 */
    const real r2_e0 = c->bend1 * r2_g0;

    /* quarter_car.bg:24: r2: input of stage 2 */
    const real r2_u2 = r2_g0 + r2_d1 - r2_e0;

    /* quarter_car.bg:24: r2: stage 2 */
    const real r2_y2 = x->r2_s2 + c->b * r2_u2;

    /* quarter_car.bg:24: r2: stage 2: memory */
    x->r2_s2 = c->a * r2_y2 + c->b * r2_u2;

    /* quarter_car.bg:24: r2: input of stage 1 */
    const real r2_u1 = r2_y2 + REAL(2.0) * r2_e0 - r2_d1;

    /* quarter_car.bg:24: r2: stage 1 */
    const real r2_y1 = x->r2_s1 + c->b * r2_u1;

    /* quarter_car.bg:24: r2: stage 1: memory */
    x->r2_s1 = c->a * r2_y1 + c->b * r2_u1;

    /* quarter_car.bg:24: r2 = vw - vb - D(stroke) */
    r[QUARTER_CAR_R2] = r2_y1 - r2_e0;
}

/* One sample for r2; a number that is not finite makes the next sample the first. */
static void run_r2(
    quarter_car_monitor *monitor, const quarter_car_samples *s, quarter_car_residuals *residuals)
{
    real *r = residuals->value;
    uint32_t age = monitor->age[1];

    if (age == 0u) {
        start_r2(monitor, s, r);
    } else {
        next_r2(monitor, s, r);
    }
    /* a sum is finite only if all its terms are */
    if (finite_number(s->vw + s->vb + s->stroke + r[QUARTER_CAR_R2])) {
        age += age < UINT32_MAX ? 1u : 0u;
    } else {
        age = 0u;
        r[QUARTER_CAR_R2] = REAL(0.0);
    }
    monitor->age[1] = age;
    residuals->valid[QUARTER_CAR_R2] = age > monitor->settle[QUARTER_CAR_R2];
}

void quarter_car_reset(quarter_car_monitor *monitor)
{
    int k;

    for (k = 0; k < 2; ++k) {
        monitor->age[k] = 0u;
    }
}

void quarter_car_step(
    quarter_car_monitor *monitor,
    const quarter_car_samples *samples,
    quarter_car_residuals *residuals)
{
    run_r1(monitor, samples, residuals);
    run_r2(monitor, samples, residuals);
}

const char quarter_car_fault_name[QUARTER_CAR_FAULTS][7] = {
    "ms", "ks", "cs", "vw", "vb", "stroke",
};

const uint16_t quarter_car_fault_class[QUARTER_CAR_FAULTS] = {
    0u, 0u, 0u, 1u, 1u, 1u,
};

const char quarter_car_residual_name[QUARTER_CAR_RESIDUALS][3] = {
    "r1", "r2",
};

/* Signatures: 1 where a residual may be moved by the faults of a class, 3 where it is for sure. */
static const uint8_t signature[QUARTER_CAR_CLASSES][QUARTER_CAR_RESIDUALS] = {
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
    quarter_car_diagnosis *d, const quarter_car_limit *limit, int k, real off, real out, real bound)
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

static bool sums_are_zero(const quarter_car_diagnosis *d, int k)
{
    const real sum = d->above[k] + d->below[k] + d->louder[k];

    return !(sum > REAL(0.0));
}

static void forget_sums(quarter_car_diagnosis *d, int k)
{
    d->above[k] = REAL(0.0);
    d->below[k] = REAL(0.0);
    d->louder[k] = REAL(0.0);
    d->streak[k] = 0u;
}

/* Residual k in one sample; whether it goes into alarm. */
static bool watch(
    quarter_car_diagnosis *d, const quarter_car_limit *limit, int k, real value, real bound, bool row)
{
    const real off = value - limit->mean;
    const real out = (off < REAL(0.0) ? -off : off) - bound;
    bool high = false;

    if (row) {
        high = add_row(d, limit, k, off, out, bound);
    }
    if (d->state[k] == QUARTER_CAR_ALARM) {
        d->since[k] += d->since[k] < UINT32_MAX ? 1u : 0u;
        if (!(out < RELEASE * limit->level) || !sums_are_zero(d, k)) {
            d->quiet = 0u;
        }
        return false;
    }
    d->state[k] = QUARTER_CAR_HEALTHY;
    d->streak[k] = out > limit->level ? d->streak[k] + 1u : 0u;
    if (d->streak[k] < d->least && !high) {
        return false;
    }
    d->state[k] = QUARTER_CAR_ALARM;
    d->since[k] = 0u;
    return true;
}

/* What is left of a class of faults. */
static quarter_car_candidate left_of(const quarter_car_diagnosis *d, const uint8_t *own)
{
    quarter_car_candidate found = QUARTER_CAR_LIKELY;
    int k;

    for (k = 0; k < QUARTER_CAR_RESIDUALS; ++k) {
        if (d->state[k] == QUARTER_CAR_ALARM && own[k] == 0u) {
            return QUARTER_CAR_RULED_OUT;
        }
        if (d->state[k] == QUARTER_CAR_HEALTHY && own[k] == 3u) {
            found = QUARTER_CAR_SMALL;
        }
    }
    return found;
}

/* Which classes of faults the residuals leave, and the one if it is one. */
static void judge(quarter_car_diagnosis *d)
{
    int likely = 0;
    int c;

    d->fault_class = QUARTER_CAR_UNKNOWN;
    for (c = 0; c < QUARTER_CAR_CLASSES; ++c) {
        const quarter_car_candidate left = left_of(d, signature[c]);

        d->candidate[c] = (uint8_t)left;
        if (left == QUARTER_CAR_LIKELY) {
            d->fault_class = (int16_t)c;
            ++likely;
        }
    }
    if (likely != 1 || d->settled < 2u * d->row) {
        d->fault_class = QUARTER_CAR_UNKNOWN;
    }
}

quarter_car_limit quarter_car_limit_of(quarter_car_real level)
{
    quarter_car_limit limit;

    limit.mean = REAL(0.0);
    limit.level = level;
    limit.unit = REAL(0.0);
    limit.loud = REAL(0.0);
    limit.drift = REAL(0.5);
    limit.height = NEVER;
    limit.bound = REAL(0.0);
    return limit;
}

void quarter_car_clear(quarter_car_diagnosis *diagnosis)
{
    int k;

    for (k = 0; k < QUARTER_CAR_RESIDUALS; ++k) {
        if (diagnosis->state[k] == QUARTER_CAR_ALARM) {
            diagnosis->state[k] = QUARTER_CAR_HEALTHY;
        }
        diagnosis->since[k] = 0u;
        forget_sums(diagnosis, k);
    }
    for (k = 0; k < QUARTER_CAR_CLASSES; ++k) {
        diagnosis->candidate[k] = QUARTER_CAR_RULED_OUT;
    }
    diagnosis->fault_class = QUARTER_CAR_UNKNOWN;
    diagnosis->quiet = 0u;
    diagnosis->settled = 0u;
}

void quarter_car_diagnosis_reset(quarter_car_diagnosis *diagnosis)
{
    int k;

    diagnosis->row = QUARTER_CAR_ROW;
    diagnosis->least = 15u;
    diagnosis->hold = 10u * QUARTER_CAR_ROW;
    diagnosis->latch = false;
    diagnosis->tick = 0u;
    for (k = 0; k < QUARTER_CAR_RESIDUALS; ++k) {
        diagnosis->state[k] = QUARTER_CAR_BLIND;
    }
    quarter_car_clear(diagnosis);
}

bool quarter_car_diagnose(
    quarter_car_diagnosis *diagnosis,
    const quarter_car_limit *limits,
    const quarter_car_real *bounds,
    const quarter_car_residuals *residuals)
{
    quarter_car_diagnosis *d = diagnosis;
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
    for (k = 0; k < QUARTER_CAR_RESIDUALS; ++k) {
        if (residuals->valid[k]) {
            const real bound = bounds ? bounds[k] : limits[k].bound;

            fresh = watch(d, &limits[k], k, residuals->value[k], bound, row) || fresh;
        } else {
            forget_sums(d, k);
            if (d->state[k] == QUARTER_CAR_ALARM) {
                d->quiet = 0u; /* nobody knows that it is over */
            } else {
                d->state[k] = QUARTER_CAR_BLIND;
            }
        }
        alarm = alarm || d->state[k] == QUARTER_CAR_ALARM;
    }
    if (fresh) {
        d->quiet = 0u;
        d->settled = 0u;
    }
    if (alarm && !d->latch && d->quiet >= d->hold) {
        quarter_car_clear(d);
        return false;
    }
    if (fresh || (alarm && row)) {
        judge(d);
    }
    return alarm;
}
