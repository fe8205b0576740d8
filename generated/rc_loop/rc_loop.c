/* rc_loop.c: the residuals of RcLoop; generated, see the header. */
#include "rc_loop.h"

#include <stddef.h>

#if defined __FINITE_MATH_ONLY__ && __FINITE_MATH_ONLY__
#error "this code tells numbers from NaN: compile it without -ffinite-math-only (-ffast-math)"
#endif

typedef rc_loop_real real;

#define REAL(x) RC_LOOP_CONSTANT(x)
#if defined RC_LOOP_FLOAT && !defined RC_LOOP_REAL
#define MATH(name) name##f
#else
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

/* The least bandwidth * sample_time at which a filter still moves. */
#if defined RC_LOOP_FLOAT && !defined RC_LOOP_REAL
#define SLOWEST REAL(0.0001)
#else
#define SLOWEST REAL(1.0e-09)
#endif

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

/* Whether configure may go on with what it is given. */
static rc_loop_status checked(const rc_loop_parameters *p, real sample_time, real bandwidth)
{
    const bool finite = finite_number(p->R0 + p->Rab + p->Rbc + p->Rca + p->Ca + p->Cc);

    if (!finite) {
        return RC_LOOP_BAD_PARAMETER;
    }
    if (!(sample_time > REAL(0.0)) || !finite_number(sample_time)) {
        return RC_LOOP_BAD_SAMPLE_TIME;
    }
    if (!(bandwidth * sample_time >= SLOWEST && bandwidth * sample_time <= REAL(3.0))) {
        return RC_LOOP_BAD_BANDWIDTH;
    }
    return RC_LOOP_OK;
}

/* Samples until `constants` time constants of the filter are over. */
static uint32_t samples(real constants, real sample_time, real bandwidth)
{
    const real wait = constants / (bandwidth * sample_time);
    const uint32_t whole = wait < REAL(4.0e9) ? (uint32_t)wait : UINT32_MAX - 1u;

    return (real)whole < wait ? whole + 1u : whole;
}

const rc_loop_coefficients rc_loop_nominal_coefficients = {
    REAL(1.6666666666666665),      /* r1_ua */
    REAL(0.6666666666666666),      /* r1_uc */
    -REAL(0.06400000000000006),    /* r1_w1_ua */
    REAL(0.009400000000000007),    /* r1_w1_uc */
    REAL(3.3333333333333396e-05),  /* bend1 */
    REAL(0.9801980198019802),      /* a */
    REAL(0.00990099009900991),     /* b */
    REAL(3.090909090909091),       /* r2_ua */
    REAL(0.04400000000000003),     /* r2_w1_ua */
    REAL(0.04418000000000004),     /* r2_w1_uc */
    {462u, 462u},                  /* samples until each is valid */
    462u                           /* the longest of these */
};

/* The coefficients, from the parameters. */
static void compute_coefficients(rc_loop_coefficients *c, const rc_loop_parameters *p,
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

    /* rc_loop.bg:14: Rab/Rca */
    const real Rab_over_Rca = p->Rab / p->Rca;

    /* Rab*Ca */
    const real Rab_times_Ca = p->Rab * p->Ca;

    /* R0*Ca */
    const real R0_times_Ca = p->R0 * p->Ca;

    /* r1: factor of ua: Rab/Rca + 1 */
    c->r1_ua = Rab_over_Rca + REAL(1.0);

    /* r1: factor of uc: Rab/Rca */
    c->r1_uc = Rab_over_Rca;

    /* r1: factor of ua' */
    c->r1_w1_ua = (-Rab_times_Ca - R0_times_Ca) * w;

    /* r1: factor of uc' */
    c->r1_w1_uc = p->R0 * p->Cc * w;

    /* filter: 1 * (w*sample_time)^2/12 */
    c->bend1 = turn * turn / REAL(12.0);

    /* filter: what is left of a memory a sample later */
    c->a = pole;

    /* filter: weight of a sample, new and a sample later */
    c->b = REAL(0.5) * (REAL(1.0) - pole);

    /* rc_loop.bg:18: r2: factor of ua: Rab/Rca + Rbc/Rca + 1 */
    c->r2_ua = Rab_over_Rca + p->Rbc / p->Rca + REAL(1.0);

    /* r2: factor of ua' */
    c->r2_w1_ua = p->Rab * p->Ca * w;

    /* r2: factor of uc' */
    c->r2_w1_uc = p->Rbc * p->Cc * w;
}

static bool coefficients_are_finite(const rc_loop_coefficients *c)
{
    return finite_number(c->r1_ua + c->r1_uc + c->r1_w1_ua + c->r1_w1_uc + c->bend1 + c->a + c->b
            + c->r2_ua + c->r2_w1_ua + c->r2_w1_uc);
}

rc_loop_status rc_loop_configure(
    rc_loop_coefficients *coefficients,
    const rc_loop_parameters *parameters,
    rc_loop_real sample_time,
    rc_loop_real bandwidth)
{
    rc_loop_coefficients *c = coefficients;
    const rc_loop_status status = checked(parameters, sample_time, bandwidth);
    int k;

    for (k = 0; k < RC_LOOP_RESIDUALS; ++k) {
        c->settle[k] = UINT32_MAX;
    }
    c->longest = UINT32_MAX;
    if (status != RC_LOOP_OK) {
        return status;
    }
    compute_coefficients(c, parameters, sample_time, bandwidth);
    if (!coefficients_are_finite(c)) {
        return RC_LOOP_BAD_COEFFICIENT;
    }
    c->settle[RC_LOOP_R1] = samples(REAL(9.233413476451586), sample_time, bandwidth);
    c->settle[RC_LOOP_R2] = samples(REAL(9.233413476451586), sample_time, bandwidth);
    c->longest = c->settle[RC_LOOP_R1];
    return RC_LOOP_OK;
}

/* r1 on one sample.
 * rc_loop.bg:14: r1 = U - ua - Rab*ba.f - R0*(ba.f + (Cc*D(uc) - ac.f))
 * where ba.f = ac.f + Ca*D(ua)
 * ac.f = (ua - uc)/Rca */
static void run_r1(
    const rc_loop_coefficients *c, rc_loop_memory *x, const rc_loop_samples *s, real *r)
{
    const bool first = x->youngest == 0u && x->age[0] == 0u;

    if (first) {
        /* nothing is remembered yet */
        x->r1_s2 = REAL(0.0);
        x->r1_s1 = REAL(0.0);
    }

    /* a stage of the filter; on the first sample it is at rest */
    const real a = first ? -c->b : c->a;
    const real b = first ? REAL(1.0) : c->b;

    /* terms of order 0 */
    const real g0 = s->U + c->r1_uc * s->uc - c->r1_ua * s->ua;

    /* degree 1 */
    const real d1 = c->r1_w1_ua * s->ua - c->r1_w1_uc * s->uc;

    /* error of order 0 */
    const real e0 = c->bend1 * g0;

    /* the filter multiplied out */
    const real p1_1 = d1 + e0;

    /* stage 2 */
    const real u2 = g0 - p1_1;
    const real y2 = x->r1_s2 + b * u2;
    x->r1_s2 = a * y2 + b * u2;

    /* stage 1 */
    const real u1 = y2 + p1_1 + e0;
    const real y1 = x->r1_s1 + b * u1;
    x->r1_s1 = a * y1 + b * u1;

    r[RC_LOOP_R1] = y1 - e0;
}

/* r2 on one sample.
 * rc_loop.bg:18: r2 = ua + Rab*(ac.f + Ca*D(ua)) - uc - Rbc*(Cc*D(uc) - ac.f)
 * where ac.f = (ua - uc)/Rca */
static void run_r2(
    const rc_loop_coefficients *c, rc_loop_memory *x, const rc_loop_samples *s, real *r)
{
    const bool first = x->youngest == 0u && x->age[1] == 0u;

    if (first) {
        /* nothing is remembered yet */
        x->r2_s2 = REAL(0.0);
        x->r2_s1 = REAL(0.0);
    }

    /* a stage of the filter; on the first sample it is at rest */
    const real a = first ? -c->b : c->a;
    const real b = first ? REAL(1.0) : c->b;

    /* terms of order 0 */
    const real g0 = c->r2_ua * s->ua - c->r2_ua * s->uc;

    /* degree 1 */
    const real d1 = c->r2_w1_ua * s->ua - c->r2_w1_uc * s->uc;

    /* error of order 0 */
    const real e0 = c->bend1 * g0;

    /* the filter multiplied out */
    const real p1_1 = d1 + e0;

    /* stage 2 */
    const real u2 = g0 - p1_1;
    const real y2 = x->r2_s2 + b * u2;
    x->r2_s2 = a * y2 + b * u2;

    /* stage 1 */
    const real u1 = y2 + p1_1 + e0;
    const real y1 = x->r2_s1 + b * u1;
    x->r2_s1 = a * y1 + b * u1;

    r[RC_LOOP_R2] = y1 - e0;
}

/* Ages and validity one by one: a number that is not finite makes the next sample the first. */
static void count_samples(
    const rc_loop_coefficients *c,
    rc_loop_memory *x,
    rc_loop_residuals *out)
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

void rc_loop_reset(rc_loop_memory *memory)
{
    int k;

    for (k = 0; k < 2; ++k) {
        memory->age[k] = 0u;
    }
    memory->youngest = 0u;
}

void rc_loop_step(
    const rc_loop_coefficients *coefficients,
    rc_loop_memory *memory,
    const rc_loop_samples *samples,
    rc_loop_residuals *residuals)
{
    const rc_loop_coefficients *c = coefficients;
    rc_loop_memory *x = memory;
    const rc_loop_samples *s = samples;
    real *r = residuals->value;
    int k;

    run_r1(c, x, s, r);
    run_r2(c, x, s, r);
    /* a sum is finite only if all its terms are */
    if (x->youngest > c->longest && finite_number(r[RC_LOOP_R1] + r[RC_LOOP_R2])) {
        for (k = 0; k < RC_LOOP_RESIDUALS; ++k) {
            residuals->valid[k] = true;
        }
    } else {
        count_samples(c, x, residuals);
    }
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

/*
 * Signatures: the faults of class c are seen by the residuals of entries first_entry[c] and up to
 * first_entry[c + 1].
 */
static const uint32_t first_entry[RC_LOOP_CLASSES + 1] = {
    0u, 1u, 3u, 4u,
};

static const uint16_t seen_by[4] = {
    0u, 0u, 1u, 1u,
};

/*
 * Sizes of faults in eighths of an octave: a residual in alarm makes a fault so much larger than
 * what is least here as it is out.
 */
static const uint8_t least_size[4] = {
    1u, 1u, 1u, 1u,
};

/* A residual is sure to show a fault of this size; 255: of no size. */
static const uint8_t sure_size[4] = {
    0u, 0u, 0u, 0u,
};

/* The peak of residual k since it went into alarm, beside what is sure to be one. */
static void remember_peak(
    rc_loop_diagnosis *d, const rc_loop_limit *limit, int k, real out, real bound)
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
static int size_of(const rc_loop_diagnosis *d, int c, int alarms)
{
    const uint32_t begin = first_entry[c];
    const uint32_t end = first_entry[c + 1];
    int size = 0;
    int seen = 0;
    uint32_t i;

    for (i = begin; i < end; ++i) {
        const int k = (int)seen_by[i];

        if (d->state[k] == RC_LOOP_ALARM) {
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
static rc_loop_candidate left_of(const rc_loop_diagnosis *d, int c, int alarms)
{
    const uint32_t begin = first_entry[c];
    const uint32_t end = first_entry[c + 1];
    const int size = size_of(d, c, alarms);
    uint32_t i;

    if (size < 0) {
        return RC_LOOP_RULED_OUT;
    }
    if (d->settled < d->window) {
        return RC_LOOP_LIKELY; /* too soon for what is quiet to say anything */
    }
    for (i = begin; i < end; ++i) {
        const int k = (int)seen_by[i];
        const int sure = (int)sure_size[i];

        if (d->state[k] == RC_LOOP_HEALTHY && sure != 255 && sure <= size) {
            return RC_LOOP_SMALL;
        }
    }
    return RC_LOOP_LIKELY;
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

/* How far a residual is beyond its bound; off: from its mean. */
static real excess(real off, real bound)
{
#if defined __GNUC__ && !defined RC_LOOP_REAL
    return MATH(__builtin_fabs)(off) - bound; /* one instruction, no library */
#else
    return (off < REAL(0.0) ? -off : off) - bound;
#endif
}

static bool is_within(const rc_loop_limit *limit, real value, real bound)
{
    return excess(value - limit->mean, bound) <= limit->level;
}

/* Residual k in one sample; whether it goes into alarm. */
static bool watch(
    rc_loop_diagnosis *d, const rc_loop_limit *limit, int k, real value, real bound, bool row)
{
    const real off = value - limit->mean;
    const real out = excess(off, bound);
    bool high = false;

    if (row) {
        high = add_row(d, limit, k, off, out, bound);
    }
    if (d->state[k] == RC_LOOP_ALARM) {
        d->since[k] += d->since[k] < UINT32_MAX ? 1u : 0u;
        remember_peak(d, limit, k, out, bound);
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
    d->peak[k] = REAL(0.0);
    remember_peak(d, limit, k, out, bound);
    return true;
}

/* Which classes of faults the residuals leave, and the one if it is one. */
static void judge(rc_loop_diagnosis *d)
{
    int likely = 0;
    int alarms = 0;
    int c;
    int k;

    for (k = 0; k < RC_LOOP_RESIDUALS; ++k) {
        alarms += d->state[k] == RC_LOOP_ALARM ? 1 : 0;
    }
    d->fault_class = RC_LOOP_UNKNOWN;
    for (c = 0; c < RC_LOOP_CLASSES; ++c) {
        const rc_loop_candidate left = left_of(d, c, alarms);

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
        diagnosis->peak[k] = REAL(0.0);
        forget_sums(diagnosis, k);
    }
    for (k = 0; k < RC_LOOP_CLASSES; ++k) {
        diagnosis->candidate[k] = RC_LOOP_RULED_OUT;
    }
    diagnosis->fault_class = RC_LOOP_UNKNOWN;
    diagnosis->quiet = 0u;
    diagnosis->settled = 0u;
    diagnosis->calm = false;
}

void rc_loop_diagnosis_reset(rc_loop_diagnosis *diagnosis)
{
    int k;

    diagnosis->row = RC_LOOP_ROW;
    diagnosis->least = 15u;
    diagnosis->hold = 10u * RC_LOOP_ROW;
    diagnosis->window = 300u;
    diagnosis->latch = false;
    diagnosis->tick = 0u;
    for (k = 0; k < RC_LOOP_RESIDUALS; ++k) {
        diagnosis->state[k] = RC_LOOP_BLIND;
    }
    rc_loop_clear(diagnosis);
}

/* Whether each residual has a value within its level: nearly all samples are so. */
static bool all_within(
    const rc_loop_limit *limits, const real *bounds, const rc_loop_residuals *residuals)
{
    const real *value = residuals->value;
    int k;

    if (bounds != NULL) {
        for (k = 0; k < RC_LOOP_RESIDUALS; ++k) {
            if (!residuals->valid[k] || !is_within(&limits[k], value[k], bounds[k])) {
                return false;
            }
        }
    } else {
        for (k = 0; k < RC_LOOP_RESIDUALS; ++k) {
            if (!residuals->valid[k] || !is_within(&limits[k], value[k], limits[k].bound)) {
                return false;
            }
        }
    }
    return true;
}

/* Residual k without a value. */
static void blind(rc_loop_diagnosis *d, int k)
{
    forget_sums(d, k);
    if (d->state[k] == RC_LOOP_ALARM) {
        d->quiet = 0u; /* nobody knows that it is over */
    } else {
        d->state[k] = RC_LOOP_BLIND;
    }
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
    if (d->calm && !row && all_within(limits, bounds, residuals)) {
        return false;
    }
    d->calm = true;
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
            blind(d, k);
        }
        d->calm = d->calm && d->state[k] == RC_LOOP_HEALTHY && d->streak[k] == 0u;
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
