/* chassis_bench.c: the residuals of ChassisBench; generated, see the header. */
#include "chassis_bench.h"

#include <stddef.h>

#if defined __FINITE_MATH_ONLY__ && __FINITE_MATH_ONLY__
#error "this code tells numbers from NaN: compile it without -ffinite-math-only (-ffast-math)"
#endif

typedef chassis_bench_real real;

#define REAL(x) CHASSIS_BENCH_CONSTANT(x)
#if defined CHASSIS_BENCH_FLOAT && !defined CHASSIS_BENCH_REAL
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
#if defined CHASSIS_BENCH_FLOAT && !defined CHASSIS_BENCH_REAL
#define SLOWEST REAL(0.0001)
#else
#define SLOWEST REAL(1.0e-09)
#endif

uint32_t chassis_bench_abi(void)
{
    return CHASSIS_BENCH_ABI;
}

const char *chassis_bench_digest(void)
{
    return CHASSIS_BENCH_DIGEST;
}

void chassis_bench_nominal(chassis_bench_parameters *parameters)
{
    parameters->body__m = REAL(0.25);     /* kg */
    parameters->body__fm = REAL(0.0001);  /* N.s/m */
    parameters->body__d = REAL(0.04);     /* m */
    parameters->body__Iz = REAL(0.0058);  /* kg.m^2 */
    parameters->body__fz = REAL(0.0005);  /* N.m.s/rad */
}

/* Whether configure may go on with what it is given. */
static chassis_bench_status checked(const chassis_bench_parameters *p, real sample_time, real bandwidth)
{
    const bool finite = finite_number(p->body__m + p->body__fm + p->body__d + p->body__Iz
            + p->body__fz);

    if (!finite) {
        return CHASSIS_BENCH_BAD_PARAMETER;
    }
    if (!(sample_time > REAL(0.0)) || !finite_number(sample_time)) {
        return CHASSIS_BENCH_BAD_SAMPLE_TIME;
    }
    if (!(bandwidth * sample_time >= SLOWEST && bandwidth * sample_time <= REAL(3.0))) {
        return CHASSIS_BENCH_BAD_BANDWIDTH;
    }
    return CHASSIS_BENCH_OK;
}

/* Samples until `constants` time constants of the filter are over. */
static uint32_t samples(real constants, real sample_time, real bandwidth)
{
    const real wait = constants / (bandwidth * sample_time);
    const uint32_t whole = wait < REAL(4.0e9) ? (uint32_t)wait : UINT32_MAX - 1u;

    return (real)whole < wait ? whole + 1u : whole;
}

const chassis_bench_coefficients chassis_bench_nominal_coefficients = {
    REAL(0.0001),                  /* r1_u */
    REAL(5.000000000000004),       /* r1_w1_u */
    REAL(3.3333333333333396e-05),  /* bend1 */
    REAL(0.9801980198019802),      /* a */
    REAL(0.00990099009900991),     /* b */
    REAL(0.0005),                  /* r2_yaw */
    REAL(0.02),                    /* r2_body__Fx__1 */
    REAL(0.11600000000000009),     /* r2_w1_yaw */
    {462u, 462u},                  /* samples until each is valid */
    462u                           /* the longest of these */
};

/* The coefficients, from the parameters. */
static void compute_coefficients(chassis_bench_coefficients *c, const chassis_bench_parameters *p,
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

    /* khepera.bg:93: r1: factor of u: body.fm */
    c->r1_u = p->body__fm;

    /* r1: factor of u' */
    c->r1_w1_u = p->body__m * w;

    /* filter: 1 * (w*sample_time)^2/12 */
    c->bend1 = turn * turn / REAL(12.0);

    /* filter: what is left of a memory a sample later */
    c->a = pole;

    /* filter: weight of a sample, new and a sample later */
    c->b = REAL(0.5) * (REAL(1.0) - pole);

    /* khepera.bg:101: r2: factor of yaw: body.fz */
    c->r2_yaw = p->body__fz;

    /* r2: factor of body.Fx[1]: body.d/2 */
    c->r2_body__Fx__1 = REAL(0.5) * p->body__d;

    /* r2: factor of yaw' */
    c->r2_w1_yaw = p->body__Iz * w;
}

static bool coefficients_are_finite(const chassis_bench_coefficients *c)
{
    return finite_number(c->r1_u + c->r1_w1_u + c->bend1 + c->a + c->b + c->r2_yaw
            + c->r2_body__Fx__1 + c->r2_w1_yaw);
}

chassis_bench_status chassis_bench_configure(
    chassis_bench_coefficients *coefficients,
    const chassis_bench_parameters *parameters,
    chassis_bench_real sample_time,
    chassis_bench_real bandwidth)
{
    chassis_bench_coefficients *c = coefficients;
    const chassis_bench_status status = checked(parameters, sample_time, bandwidth);
    int k;

    for (k = 0; k < CHASSIS_BENCH_RESIDUALS; ++k) {
        c->settle[k] = UINT32_MAX;
    }
    c->longest = UINT32_MAX;
    if (status != CHASSIS_BENCH_OK) {
        return status;
    }
    compute_coefficients(c, parameters, sample_time, bandwidth);
    if (!coefficients_are_finite(c)) {
        return CHASSIS_BENCH_BAD_COEFFICIENT;
    }
    c->settle[CHASSIS_BENCH_R1] = samples(REAL(9.233413476451586), sample_time, bandwidth);
    c->settle[CHASSIS_BENCH_R2] = samples(REAL(9.233413476451586), sample_time, bandwidth);
    c->longest = c->settle[CHASSIS_BENCH_R1];
    return CHASSIS_BENCH_OK;
}

/* r1 on one sample.
 * khepera.bg:93: r1 = body.Fx[1] + body.Fx[2] - body.fm*u - body.m*D(u) */
static void run_r1(
    const chassis_bench_coefficients *c, chassis_bench_memory *x, const chassis_bench_samples *s, real *r)
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
    const real g0 = s->body__Fx__1 + s->body__Fx__2 - c->r1_u * s->u;

    /* degree 1 */
    const real d1 = c->r1_w1_u * s->u;

    /* error of order 0 */
    const real e0 = c->bend1 * g0;

    /* the filter multiplied out */
    const real p1_1 = e0 - d1;

    /* stage 2 */
    const real u2 = g0 - p1_1;
    const real y2 = x->r1_s2 + b * u2;
    x->r1_s2 = a * y2 + b * u2;

    /* stage 1 */
    const real u1 = y2 + p1_1 + e0;
    const real y1 = x->r1_s1 + b * u1;
    x->r1_s1 = a * y1 + b * u1;

    r[CHASSIS_BENCH_R1] = y1 - e0;
}

/* r2 on one sample.
 * khepera.bg:101: r2 = body.Fx[1]*body.d/2 - body.fz*yaw - body.Fx[2]*body.d/2 - body.Iz*D(yaw) */
static void run_r2(
    const chassis_bench_coefficients *c, chassis_bench_memory *x, const chassis_bench_samples *s, real *r)
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
    const real g0 = c->r2_body__Fx__1 * s->body__Fx__1 - c->r2_yaw * s->yaw
        - c->r2_body__Fx__1 * s->body__Fx__2;

    /* degree 1 */
    const real d1 = c->r2_w1_yaw * s->yaw;

    /* error of order 0 */
    const real e0 = c->bend1 * g0;

    /* the filter multiplied out */
    const real p1_1 = e0 - d1;

    /* stage 2 */
    const real u2 = g0 - p1_1;
    const real y2 = x->r2_s2 + b * u2;
    x->r2_s2 = a * y2 + b * u2;

    /* stage 1 */
    const real u1 = y2 + p1_1 + e0;
    const real y1 = x->r2_s1 + b * u1;
    x->r2_s1 = a * y1 + b * u1;

    r[CHASSIS_BENCH_R2] = y1 - e0;
}

/* Ages and validity one by one: a number that is not finite makes the next sample the first. */
static void count_samples(
    const chassis_bench_coefficients *c,
    chassis_bench_memory *x,
    chassis_bench_residuals *out)
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

void chassis_bench_reset(chassis_bench_memory *memory)
{
    int k;

    for (k = 0; k < 2; ++k) {
        memory->age[k] = 0u;
    }
    memory->youngest = 0u;
}

void chassis_bench_step(
    const chassis_bench_coefficients *coefficients,
    chassis_bench_memory *memory,
    const chassis_bench_samples *samples,
    chassis_bench_residuals *residuals)
{
    const chassis_bench_coefficients *c = coefficients;
    chassis_bench_memory *x = memory;
    const chassis_bench_samples *s = samples;
    real *r = residuals->value;
    int k;

    run_r1(c, x, s, r);
    run_r2(c, x, s, r);
    /* a sum is finite only if all its terms are */
    if (x->youngest > c->longest && finite_number(r[CHASSIS_BENCH_R1] + r[CHASSIS_BENCH_R2])) {
        for (k = 0; k < CHASSIS_BENCH_RESIDUALS; ++k) {
            residuals->valid[k] = true;
        }
    } else {
        count_samples(c, x, residuals);
    }
}

const char chassis_bench_fault_name[CHASSIS_BENCH_FAULTS][11] = {
    "body.m", "body.fm", "u", "body.Fx[1]", "body.Fx[2]", "body.d", "body.Iz", "body.fz", "yaw",
};

const uint16_t chassis_bench_fault_class[CHASSIS_BENCH_FAULTS] = {
    0u, 0u, 0u, 1u, 1u, 2u, 2u, 2u, 2u,
};

const char chassis_bench_residual_name[CHASSIS_BENCH_RESIDUALS][3] = {
    "r1", "r2",
};

/*
 * Signatures: the faults of class c are seen by the residuals of entries first_entry[c] and up to
 * first_entry[c + 1].
 */
static const uint32_t first_entry[CHASSIS_BENCH_CLASSES + 1] = {
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
    chassis_bench_diagnosis *d, const chassis_bench_limit *limit, int k, real out, real bound)
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
static int size_of(const chassis_bench_diagnosis *d, int c, int alarms)
{
    const uint32_t begin = first_entry[c];
    const uint32_t end = first_entry[c + 1];
    int size = 0;
    int seen = 0;
    uint32_t i;

    for (i = begin; i < end; ++i) {
        const int k = (int)seen_by[i];

        if (d->state[k] == CHASSIS_BENCH_ALARM) {
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
static chassis_bench_candidate left_of(const chassis_bench_diagnosis *d, int c, int alarms)
{
    const uint32_t begin = first_entry[c];
    const uint32_t end = first_entry[c + 1];
    const int size = size_of(d, c, alarms);
    uint32_t i;

    if (size < 0) {
        return CHASSIS_BENCH_RULED_OUT;
    }
    if (d->settled < d->window) {
        return CHASSIS_BENCH_LIKELY; /* too soon for what is quiet to say anything */
    }
    for (i = begin; i < end; ++i) {
        const int k = (int)seen_by[i];
        const int sure = (int)sure_size[i];

        if (d->state[k] == CHASSIS_BENCH_HEALTHY && sure != 255 && sure <= size) {
            return CHASSIS_BENCH_SMALL;
        }
    }
    return CHASSIS_BENCH_LIKELY;
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
    chassis_bench_diagnosis *d, const chassis_bench_limit *limit, int k, real off, real out, real bound)
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

static bool sums_are_zero(const chassis_bench_diagnosis *d, int k)
{
    const real sum = d->above[k] + d->below[k] + d->louder[k];

    return !(sum > REAL(0.0));
}

static void forget_sums(chassis_bench_diagnosis *d, int k)
{
    d->above[k] = REAL(0.0);
    d->below[k] = REAL(0.0);
    d->louder[k] = REAL(0.0);
    d->streak[k] = 0u;
}

/* How far a residual is beyond its bound; off: from its mean. */
static real excess(real off, real bound)
{
#if defined __GNUC__ && !defined CHASSIS_BENCH_REAL
    return MATH(__builtin_fabs)(off) - bound; /* one instruction, no library */
#else
    return (off < REAL(0.0) ? -off : off) - bound;
#endif
}

static bool is_within(const chassis_bench_limit *limit, real value, real bound)
{
    return excess(value - limit->mean, bound) <= limit->level;
}

/* Residual k in one sample; whether it goes into alarm. */
static bool watch(
    chassis_bench_diagnosis *d, const chassis_bench_limit *limit, int k, real value, real bound, bool row)
{
    const real off = value - limit->mean;
    const real out = excess(off, bound);
    bool high = false;

    if (row) {
        high = add_row(d, limit, k, off, out, bound);
    }
    if (d->state[k] == CHASSIS_BENCH_ALARM) {
        d->since[k] += d->since[k] < UINT32_MAX ? 1u : 0u;
        remember_peak(d, limit, k, out, bound);
        if (!(out < RELEASE * limit->level) || !sums_are_zero(d, k)) {
            d->quiet = 0u;
        }
        return false;
    }
    d->state[k] = CHASSIS_BENCH_HEALTHY;
    d->streak[k] = out > limit->level ? d->streak[k] + 1u : 0u;
    if (d->streak[k] < d->least && !high) {
        return false;
    }
    d->state[k] = CHASSIS_BENCH_ALARM;
    d->since[k] = 0u;
    d->peak[k] = REAL(0.0);
    remember_peak(d, limit, k, out, bound);
    return true;
}

/* Which classes of faults the residuals leave, and the one if it is one. */
static void judge(chassis_bench_diagnosis *d)
{
    int likely = 0;
    int alarms = 0;
    int c;
    int k;

    for (k = 0; k < CHASSIS_BENCH_RESIDUALS; ++k) {
        alarms += d->state[k] == CHASSIS_BENCH_ALARM ? 1 : 0;
    }
    d->fault_class = CHASSIS_BENCH_UNKNOWN;
    for (c = 0; c < CHASSIS_BENCH_CLASSES; ++c) {
        const chassis_bench_candidate left = left_of(d, c, alarms);

        d->candidate[c] = (uint8_t)left;
        if (left == CHASSIS_BENCH_LIKELY) {
            d->fault_class = (int16_t)c;
            ++likely;
        }
    }
    if (likely != 1 || d->settled < 2u * d->row) {
        d->fault_class = CHASSIS_BENCH_UNKNOWN;
    }
}

chassis_bench_limit chassis_bench_limit_of(chassis_bench_real level)
{
    chassis_bench_limit limit;

    limit.mean = REAL(0.0);
    limit.level = level;
    limit.unit = REAL(0.0);
    limit.loud = REAL(0.0);
    limit.drift = REAL(0.5);
    limit.height = NEVER;
    limit.bound = REAL(0.0);
    return limit;
}

void chassis_bench_clear(chassis_bench_diagnosis *diagnosis)
{
    int k;

    for (k = 0; k < CHASSIS_BENCH_RESIDUALS; ++k) {
        if (diagnosis->state[k] == CHASSIS_BENCH_ALARM) {
            diagnosis->state[k] = CHASSIS_BENCH_HEALTHY;
        }
        diagnosis->since[k] = 0u;
        diagnosis->peak[k] = REAL(0.0);
        forget_sums(diagnosis, k);
    }
    for (k = 0; k < CHASSIS_BENCH_CLASSES; ++k) {
        diagnosis->candidate[k] = CHASSIS_BENCH_RULED_OUT;
    }
    diagnosis->fault_class = CHASSIS_BENCH_UNKNOWN;
    diagnosis->quiet = 0u;
    diagnosis->settled = 0u;
    diagnosis->calm = false;
}

void chassis_bench_diagnosis_reset(chassis_bench_diagnosis *diagnosis)
{
    int k;

    diagnosis->row = CHASSIS_BENCH_ROW;
    diagnosis->least = 15u;
    diagnosis->hold = 10u * CHASSIS_BENCH_ROW;
    diagnosis->window = 300u;
    diagnosis->latch = false;
    diagnosis->tick = 0u;
    for (k = 0; k < CHASSIS_BENCH_RESIDUALS; ++k) {
        diagnosis->state[k] = CHASSIS_BENCH_BLIND;
    }
    chassis_bench_clear(diagnosis);
}

/* Whether each residual has a value within its level: nearly all samples are so. */
static bool all_within(
    const chassis_bench_limit *limits, const real *bounds, const chassis_bench_residuals *residuals)
{
    const real *value = residuals->value;
    int k;

    if (bounds != NULL) {
        for (k = 0; k < CHASSIS_BENCH_RESIDUALS; ++k) {
            if (!residuals->valid[k] || !is_within(&limits[k], value[k], bounds[k])) {
                return false;
            }
        }
    } else {
        for (k = 0; k < CHASSIS_BENCH_RESIDUALS; ++k) {
            if (!residuals->valid[k] || !is_within(&limits[k], value[k], limits[k].bound)) {
                return false;
            }
        }
    }
    return true;
}

/* Residual k without a value. */
static void blind(chassis_bench_diagnosis *d, int k)
{
    forget_sums(d, k);
    if (d->state[k] == CHASSIS_BENCH_ALARM) {
        d->quiet = 0u; /* nobody knows that it is over */
    } else {
        d->state[k] = CHASSIS_BENCH_BLIND;
    }
}

bool chassis_bench_diagnose(
    chassis_bench_diagnosis *diagnosis,
    const chassis_bench_limit *limits,
    const chassis_bench_real *bounds,
    const chassis_bench_residuals *residuals)
{
    chassis_bench_diagnosis *d = diagnosis;
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
    for (k = 0; k < CHASSIS_BENCH_RESIDUALS; ++k) {
        if (residuals->valid[k]) {
            const real bound = bounds ? bounds[k] : limits[k].bound;

            fresh = watch(d, &limits[k], k, residuals->value[k], bound, row) || fresh;
        } else {
            blind(d, k);
        }
        d->calm = d->calm && d->state[k] == CHASSIS_BENCH_HEALTHY && d->streak[k] == 0u;
        alarm = alarm || d->state[k] == CHASSIS_BENCH_ALARM;
    }
    if (fresh) {
        d->quiet = 0u;
        d->settled = 0u;
    }
    if (alarm && !d->latch && d->quiet >= d->hold) {
        chassis_bench_clear(d);
        return false;
    }
    if (fresh || (alarm && row)) {
        judge(d);
    }
    return alarm;
}
