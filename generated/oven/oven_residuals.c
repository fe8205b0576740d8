/* oven_residuals.c: the residuals of Oven; generated, see the header. */
#include "oven_residuals.h"


#if defined __FINITE_MATH_ONLY__ && __FINITE_MATH_ONLY__
#error "this code tells numbers from NaN: compile it without -ffinite-math-only (-ffast-math)"
#endif

typedef oven_real real;

#define REAL(x) OVEN_CONSTANT(x)
#if defined OVEN_FLOAT && !defined OVEN_REAL
#define SLOWEST REAL(0.0001)
#else
#define SLOWEST REAL(1.0e-09)
#endif

/* Neither NaN nor infinite: infinity minus infinity is NaN, and NaN is not 0. */
static bool finite_number(real value)
{
    return value - value <= REAL(0.0);
}

/* The same number; the model asks for it. */
static bool equal(real left, real right)
{
    return left <= right && left >= right;
}

/* The smaller of two numbers. */
static real least(real left, real right)
{
    return right < left ? right : left;
}

/* The larger of two numbers. */
static real greatest(real left, real right)
{
    return right > left ? right : left;
}

uint32_t oven_abi(void)
{
    return OVEN_ABI;
}

const char *oven_digest(void)
{
    return OVEN_DIGEST;
}

void oven_nominal(oven_parameters *parameters)
{
    parameters->Ch = REAL(120.0);  /* J/K */
    parameters->Co = REAL(900.0);  /* J/K */
    parameters->Gh = REAL(4.0);    /* W/K */
    parameters->Go = REAL(0.8);    /* W/K */
}

/* The coefficients of exact and of the filter, from the parameters. */
static void compute_coefficients(oven_monitor *monitor, const oven_parameters *p, real sample_time,
        real bandwidth)
{
    oven_coefficients *c = &monitor->c;

    /* bandwidth*sample_time */
    const real x_ = bandwidth * sample_time;

    /* of a stage: what is left of its memory */
    const real pole = greatest(REAL(2.0) - x_, REAL(0.0)) / (x_ + REAL(2.0));

    /* w*sample_time, x or 2 */
    const real turn = REAL(2.0) * (REAL(1.0) - pole) / (pole + REAL(1.0));

    /* w of the filter 1/(1 + D/w) */
    const real w = turn / sample_time;

    /* min(x/2, 0.025) */
    const real t = least(REAL(0.5) * x_, REAL(1.0) / REAL(40.0));

    /* oven.bg:15: r1: factor of Th: Gh */
    c->r1_Th = p->Gh;

    /* oven.bg:15: r1: factor of Th': Ch */
    c->r1_Th_1 = p->Ch;

    /* part of the start that a sample is */
    c->r1_pace = t;

    /* 1/w of the filter as part of the start, to the power 1 */
    c->r1_slope1 = t / turn;

    /* oven.bg:15: r1: factor of Th times derivative 1 of the window */
    c->r1_w0_Th_1 = p->Ch * w;

    /* filter: 1 * (w*sample_time)^2/12 */
    c->bend1 = turn * turn / REAL(12.0);

    /* filter: what is left of a memory a sample later */
    c->a = pole;

    /* filter: weight of a sample, new and a sample later */
    c->b = REAL(0.5) * (REAL(1.0) - pole);

    /* oven.bg:15: r2: factor of Ta: Go */
    c->r2_Ta = p->Go;

    /* oven.bg:15: r2: factor of To: Gh + Go */
    c->r2_To = p->Gh + p->Go;

    /* oven.bg:15: r2: factor of To': Co */
    c->r2_To_1 = p->Co;

    /* oven.bg:15: r2: factor of To times derivative 1 of the window */
    c->r2_w0_To_1 = p->Co * w;
}

static bool parameters_are_finite(const oven_parameters *p)
{
    return finite_number(p->Ch + p->Co + p->Gh + p->Go);
}

static bool coefficients_are_finite(const oven_monitor *monitor)
{
    return finite_number(monitor->c.r1_Th + monitor->c.r1_Th_1 + monitor->c.r1_pace
            + monitor->c.r1_slope1 + monitor->c.r1_w0_Th_1 + monitor->c.bend1 + monitor->c.a
            + monitor->c.b + monitor->c.r2_Ta + monitor->c.r2_To + monitor->c.r2_To_1
            + monitor->c.r2_w0_To_1);
}

/* Samples until `constants` time constants of the filter are over. */
static uint32_t samples(real constants, real sample_time, real bandwidth)
{
    const real wait = constants / (bandwidth * sample_time);
    const uint32_t whole = wait < REAL(4.0e9) ? (uint32_t)wait : UINT32_MAX - 1u;

    return (real)whole < wait ? whole + 1u : whole;
}

oven_status oven_configure(
    oven_monitor *monitor,
    const oven_parameters *parameters,
    oven_real sample_time,
    oven_real bandwidth,
    oven_real time_unit)
{
    int k;

    for (k = 0; k < OVEN_RESIDUALS; ++k) {
        monitor->settle[k] = UINT32_MAX;
    }
    oven_reset(monitor);
    if (!parameters_are_finite(parameters)) {
        return OVEN_BAD_PARAMETER;
    }
    if (!(sample_time > REAL(0.0)) || !finite_number(sample_time)) {
        return OVEN_BAD_SAMPLE_TIME;
    }
    if (!(bandwidth * sample_time >= SLOWEST && bandwidth * sample_time <= REAL(3.0))) {
        return OVEN_BAD_BANDWIDTH;
    }
    if (!(time_unit > REAL(0.0)) || !finite_number(time_unit)) {
        return OVEN_BAD_TIME_UNIT;
    }
    compute_coefficients(monitor, parameters, sample_time, bandwidth);
    if (!coefficients_are_finite(monitor)) {
        return OVEN_BAD_COEFFICIENT;
    }
    monitor->settle[OVEN_R1] = samples(REAL(2.0), sample_time, bandwidth);
    monitor->settle[OVEN_R2] = samples(REAL(2.0), sample_time, bandwidth);
    return OVEN_OK;
}

void oven_exact(
    const oven_monitor *monitor,
    const oven_derivatives *derivatives,
    oven_real residuals[OVEN_RESIDUALS])
{
    const oven_coefficients *c = &monitor->c;
    const oven_derivatives *d = derivatives;
    real *r = residuals;

    /* oven.bg:15: r1 = if(on, P, 0) - Gh*(Th - To) - Ch*D(Th) */
    r[OVEN_R1] = (d->on ? d->P : REAL(0.0)) + c->r1_Th * d->To[0] - c->r1_Th * d->Th[0]
        - c->r1_Th_1 * d->Th[1];

    /* oven.bg:15: r2 = Gh*(Th - To) - Go*(To - Ta) - Co*D(To) */
    r[OVEN_R2] = c->r2_Ta * d->Ta + c->r1_Th * d->Th[0] - c->r2_To * d->To[0]
        - c->r2_To_1 * d->To[1];
}

/* r1 on its first sample: nothing is known yet. */
static void start_r1(
    oven_monitor *monitor, const oven_samples *s, real *r)
{
    oven_memory *x = &monitor->x;

    /* oven.bg:15: r1: on for the next sample */
    x->r1_on = s->on ? REAL(1.0) : REAL(0.0);

    /* oven.bg:15: r1: the same, for the next sample */
    x->r1_open = REAL(0.0);

    /* oven.bg:15: r1: stage 2: memory */
    x->r1_s2 = REAL(0.0);

    /* oven.bg:15: r1: stage 1: memory */
    x->r1_s1 = REAL(0.0);

    /* oven.bg:15: r1 = if(on, P, 0) - Gh*(Th - To) - Ch*D(Th) */
    r[OVEN_R1] = REAL(0.0);
}

/* r1 on every further sample. */
static void next_r1(
    oven_monitor *monitor, const oven_samples *s, real *r)
{
    const oven_coefficients *c = &monitor->c;
    oven_memory *x = &monitor->x;

    /* oven.bg:15: r1: 0 where on changes */
    const real r1_kept = equal(x->r1_on, (s->on ? REAL(1.0) : REAL(0.0))) ? REAL(1.0) : REAL(0.0);

    /* oven.bg:15: r1: on for the next sample */
    x->r1_on = s->on ? REAL(1.0) : REAL(0.0);

    /* oven.bg:15: r1: how much of the start is over */
    const real r1_u = r1_kept * least(REAL(1.0), x->r1_open + c->r1_pace);

    /* oven.bg:15: r1: the same, for the next sample */
    x->r1_open = r1_u;

    /* oven.bg:15: r1: how much is to come */
    const real r1_rest = REAL(1.0) - r1_u;

    /* oven.bg:15: r1: the window */
    const real r1_phi0 = r1_u * r1_u * r1_u * (REAL(1.0)
            + r1_rest * (REAL(3.0) + r1_rest * REAL(6.0)));

    /* oven.bg:15: r1: derivative 1 of the window */
    const real r1_phi1 = c->r1_slope1 * (REAL(30.0) * (r1_u * r1_u) * (r1_rest * r1_rest));

    /* oven.bg:15: if(on, P, 0) */
    const real r1_choice = s->on ? s->P : REAL(0.0);

    /* oven.bg:15: r1: terms of order 0 */
    const real r1_g0 = r1_phi0 * (r1_choice + c->r1_Th * s->To - c->r1_Th * s->Th)
        + r1_phi1 * (c->r1_w0_Th_1 * s->Th);

    /* oven.bg:15: r1: degree 1 */
    const real r1_d1 = r1_phi0 * (c->r1_w0_Th_1 * s->Th);

    /* oven.bg:15: r1: error of order 0 */
    const real r1_e0 = c->bend1 * r1_g0;

    /* oven.bg:15: r1: input of stage 2 */
    const real r1_u2 = r1_g0 + r1_d1 - r1_e0;

    /* oven.bg:15: r1: stage 2 */
    const real r1_y2 = r1_kept * x->r1_s2 + c->b * r1_u2;

    /* oven.bg:15: r1: stage 2: memory */
    x->r1_s2 = c->a * r1_y2 + c->b * r1_u2;

    /* oven.bg:15: r1: input of stage 1 */
    const real r1_u1 = r1_y2 + REAL(2.0) * r1_e0 - r1_d1;

    /* oven.bg:15: r1: stage 1 */
    const real r1_y1 = r1_kept * x->r1_s1 + c->b * r1_u1;

    /* oven.bg:15: r1: stage 1: memory */
    x->r1_s1 = c->a * r1_y1 + c->b * r1_u1;

    /* oven.bg:15: r1 = if(on, P, 0) - Gh*(Th - To) - Ch*D(Th) */
    r[OVEN_R1] = r1_y1 - r1_e0;
}

/* One sample for r1; a number that is not finite makes the next sample the first. */
static void run_r1(
    oven_monitor *monitor, const oven_samples *s, oven_residuals *residuals)
{
    real *r = residuals->value;
    uint32_t age = monitor->age[0];

    if (age == 0u) {
        start_r1(monitor, s, r);
    } else {
        next_r1(monitor, s, r);
    }
    /* a sum is finite only if all its terms are */
    if (finite_number(s->P + s->Th + s->To + r[OVEN_R1])) {
        age += age < UINT32_MAX ? 1u : 0u;
    } else {
        age = 0u;
        r[OVEN_R1] = REAL(0.0);
    }
    monitor->age[0] = age;
    residuals->valid[OVEN_R1] = age > monitor->settle[OVEN_R1] && monitor->x.r1_open >= REAL(1.0);
}

/* r2 on its first sample: nothing is known yet. */
static void start_r2(
    oven_monitor *monitor, const oven_samples *s, real *r)
{
    oven_memory *x = &monitor->x;

    (void)s;

    /* oven.bg:15: r2: the same, for the next sample */
    x->r2_open = REAL(0.0);

    /* oven.bg:15: r2: stage 2: memory */
    x->r2_s2 = REAL(0.0);

    /* oven.bg:15: r2: stage 1: memory */
    x->r2_s1 = REAL(0.0);

    /* oven.bg:15: r2 = Gh*(Th - To) - Go*(To - Ta) - Co*D(To) */
    r[OVEN_R2] = REAL(0.0);
}

/* r2 on every further sample. */
static void next_r2(
    oven_monitor *monitor, const oven_samples *s, real *r)
{
    const oven_coefficients *c = &monitor->c;
    oven_memory *x = &monitor->x;

    /* oven.bg:15: r2: how much of the start is over */
    const real r2_u = least(REAL(1.0), x->r2_open + c->r1_pace);

    /* oven.bg:15: r2: the same, for the next sample */
    x->r2_open = r2_u;

    /* oven.bg:15: r2: how much is to come */
    const real r2_rest = REAL(1.0) - r2_u;

    /* oven.bg:15: r2: the window */
    const real r2_phi0 = r2_u * r2_u * r2_u * (REAL(1.0)
            + r2_rest * (REAL(3.0) + r2_rest * REAL(6.0)));

    /* oven.bg:15: r2: derivative 1 of the window */
    const real r2_phi1 = c->r1_slope1 * (REAL(30.0) * (r2_u * r2_u) * (r2_rest * r2_rest));

    /* oven.bg:15: r2: terms of order 0 */
    const real r2_g0 = r2_phi0 * (c->r2_Ta * s->Ta + c->r1_Th * s->Th - c->r2_To * s->To)
        + r2_phi1 * (c->r2_w0_To_1 * s->To);

    /* oven.bg:15: r2: degree 1 */
    const real r2_d1 = r2_phi0 * (c->r2_w0_To_1 * s->To);

    /* oven.bg:15: r2: error of order 0 */
    const real r2_e0 = c->bend1 * r2_g0;

    /* oven.bg:15: r2: input of stage 2 */
    const real r2_u2 = r2_g0 + r2_d1 - r2_e0;

    /* oven.bg:15: r2: stage 2 */
    const real r2_y2 = x->r2_s2 + c->b * r2_u2;

    /* oven.bg:15: r2: stage 2: memory */
    x->r2_s2 = c->a * r2_y2 + c->b * r2_u2;

    /* oven.bg:15: r2: input of stage 1 */
    const real r2_u1 = r2_y2 + REAL(2.0) * r2_e0 - r2_d1;

    /* oven.bg:15: r2: stage 1 */
    const real r2_y1 = x->r2_s1 + c->b * r2_u1;

    /* oven.bg:15: r2: stage 1: memory */
    x->r2_s1 = c->a * r2_y1 + c->b * r2_u1;

    /* oven.bg:15: r2 = Gh*(Th - To) - Go*(To - Ta) - Co*D(To) */
    r[OVEN_R2] = r2_y1 - r2_e0;
}

/* One sample for r2; a number that is not finite makes the next sample the first. */
static void run_r2(
    oven_monitor *monitor, const oven_samples *s, oven_residuals *residuals)
{
    real *r = residuals->value;
    uint32_t age = monitor->age[1];

    if (age == 0u) {
        start_r2(monitor, s, r);
    } else {
        next_r2(monitor, s, r);
    }
    /* a sum is finite only if all its terms are */
    if (finite_number(s->Ta + s->Th + s->To + r[OVEN_R2])) {
        age += age < UINT32_MAX ? 1u : 0u;
    } else {
        age = 0u;
        r[OVEN_R2] = REAL(0.0);
    }
    monitor->age[1] = age;
    residuals->valid[OVEN_R2] = age > monitor->settle[OVEN_R2] && monitor->x.r2_open >= REAL(1.0);
}

void oven_reset(oven_monitor *monitor)
{
    int k;

    for (k = 0; k < 2; ++k) {
        monitor->age[k] = 0u;
    }
}

void oven_step(
    oven_monitor *monitor,
    const oven_samples *samples,
    oven_residuals *residuals)
{
    run_r1(monitor, samples, residuals);
    run_r2(monitor, samples, residuals);
}

const char oven_fault_name[OVEN_FAULTS][3] = {
    "Ch", "P", "Gh", "Th", "To", "Co", "Go", "Ta",
};

const uint16_t oven_fault_class[OVEN_FAULTS] = {
    0u, 0u, 1u, 1u, 1u, 2u, 2u, 2u,
};

const char oven_residual_name[OVEN_RESIDUALS][3] = {
    "r1", "r2",
};

/* Signatures: 1 where a residual may be moved by the faults of a class, 3 where it is for sure. */
static const uint8_t signature[OVEN_CLASSES][OVEN_RESIDUALS] = {
    {1u, 0u},
    {1u, 1u},
    {0u, 1u},
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
    oven_diagnosis *d, const oven_limit *limit, int k, real off, real out, real bound)
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

static bool sums_are_zero(const oven_diagnosis *d, int k)
{
    const real sum = d->above[k] + d->below[k] + d->louder[k];

    return !(sum > REAL(0.0));
}

static void forget_sums(oven_diagnosis *d, int k)
{
    d->above[k] = REAL(0.0);
    d->below[k] = REAL(0.0);
    d->louder[k] = REAL(0.0);
    d->streak[k] = 0u;
}

/* Residual k in one sample; whether it goes into alarm. */
static bool watch(
    oven_diagnosis *d, const oven_limit *limit, int k, real value, real bound, bool row)
{
    const real off = value - limit->mean;
    const real out = (off < REAL(0.0) ? -off : off) - bound;
    bool high = false;

    if (row) {
        high = add_row(d, limit, k, off, out, bound);
    }
    if (d->state[k] == OVEN_ALARM) {
        d->since[k] += d->since[k] < UINT32_MAX ? 1u : 0u;
        if (!(out < RELEASE * limit->level) || !sums_are_zero(d, k)) {
            d->quiet = 0u;
        }
        return false;
    }
    d->state[k] = OVEN_HEALTHY;
    d->streak[k] = out > limit->level ? d->streak[k] + 1u : 0u;
    if (d->streak[k] < d->least && !high) {
        return false;
    }
    d->state[k] = OVEN_ALARM;
    d->since[k] = 0u;
    return true;
}

/* What is left of a class of faults. */
static oven_candidate left_of(const oven_diagnosis *d, const uint8_t *own)
{
    oven_candidate found = OVEN_LIKELY;
    int k;

    for (k = 0; k < OVEN_RESIDUALS; ++k) {
        if (d->state[k] == OVEN_ALARM && own[k] == 0u) {
            return OVEN_RULED_OUT;
        }
        if (d->state[k] == OVEN_HEALTHY && own[k] == 3u) {
            found = OVEN_SMALL;
        }
    }
    return found;
}

/* Which classes of faults the residuals leave, and the one if it is one. */
static void judge(oven_diagnosis *d)
{
    int likely = 0;
    int c;

    d->fault_class = OVEN_UNKNOWN;
    for (c = 0; c < OVEN_CLASSES; ++c) {
        const oven_candidate left = left_of(d, signature[c]);

        d->candidate[c] = (uint8_t)left;
        if (left == OVEN_LIKELY) {
            d->fault_class = (int16_t)c;
            ++likely;
        }
    }
    if (likely != 1 || d->settled < 2u * d->row) {
        d->fault_class = OVEN_UNKNOWN;
    }
}

oven_limit oven_limit_of(oven_real level)
{
    oven_limit limit;

    limit.mean = REAL(0.0);
    limit.level = level;
    limit.unit = REAL(0.0);
    limit.loud = REAL(0.0);
    limit.drift = REAL(0.5);
    limit.height = NEVER;
    limit.bound = REAL(0.0);
    return limit;
}

void oven_clear(oven_diagnosis *diagnosis)
{
    int k;

    for (k = 0; k < OVEN_RESIDUALS; ++k) {
        if (diagnosis->state[k] == OVEN_ALARM) {
            diagnosis->state[k] = OVEN_HEALTHY;
        }
        diagnosis->since[k] = 0u;
        forget_sums(diagnosis, k);
    }
    for (k = 0; k < OVEN_CLASSES; ++k) {
        diagnosis->candidate[k] = OVEN_RULED_OUT;
    }
    diagnosis->fault_class = OVEN_UNKNOWN;
    diagnosis->quiet = 0u;
    diagnosis->settled = 0u;
}

void oven_diagnosis_reset(oven_diagnosis *diagnosis)
{
    int k;

    diagnosis->row = OVEN_ROW;
    diagnosis->least = 15u;
    diagnosis->hold = 10u * OVEN_ROW;
    diagnosis->latch = false;
    diagnosis->tick = 0u;
    for (k = 0; k < OVEN_RESIDUALS; ++k) {
        diagnosis->state[k] = OVEN_BLIND;
    }
    oven_clear(diagnosis);
}

bool oven_diagnose(
    oven_diagnosis *diagnosis,
    const oven_limit *limits,
    const oven_real *bounds,
    const oven_residuals *residuals)
{
    oven_diagnosis *d = diagnosis;
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
    for (k = 0; k < OVEN_RESIDUALS; ++k) {
        if (residuals->valid[k]) {
            const real bound = bounds ? bounds[k] : limits[k].bound;

            fresh = watch(d, &limits[k], k, residuals->value[k], bound, row) || fresh;
        } else {
            forget_sums(d, k);
            if (d->state[k] == OVEN_ALARM) {
                d->quiet = 0u; /* nobody knows that it is over */
            } else {
                d->state[k] = OVEN_BLIND;
            }
        }
        alarm = alarm || d->state[k] == OVEN_ALARM;
    }
    if (fresh) {
        d->quiet = 0u;
        d->settled = 0u;
    }
    if (alarm && !d->latch && d->quiet >= d->hold) {
        oven_clear(d);
        return false;
    }
    if (fresh || (alarm && row)) {
        judge(d);
    }
    return alarm;
}
