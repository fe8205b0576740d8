/* cable_bench.c: the residuals of CableBench; generated, see the header. */
#include "cable_bench.h"

#include <stddef.h>

#if defined __FINITE_MATH_ONLY__ && __FINITE_MATH_ONLY__
#error "this code tells numbers from NaN: compile it without -ffinite-math-only (-ffast-math)"
#endif

typedef cable_bench_real real;

#define REAL(x) CABLE_BENCH_CONSTANT(x)
#if defined CABLE_BENCH_FLOAT && !defined CABLE_BENCH_REAL
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
#if defined CABLE_BENCH_FLOAT && !defined CABLE_BENCH_REAL
#define SLOWEST REAL(0.0001)
#else
#define SLOWEST REAL(1.0e-09)
#endif

uint32_t cable_bench_abi(void)
{
    return CABLE_BENCH_ABI;
}

const char *cable_bench_digest(void)
{
    return CABLE_BENCH_DIGEST;
}

void cable_bench_nominal(cable_bench_parameters *parameters)
{
    parameters->line__R = REAL(3.2);      /* Ohm */
    parameters->line__L = REAL(2.5e-07);  /* H */
    parameters->line__C = REAL(1.1e-10);  /* F */
}

/* Whether configure may go on with what it is given. */
static cable_bench_status checked(const cable_bench_parameters *p, real sample_time, real bandwidth)
{
    const bool finite = finite_number(p->line__R + p->line__L + p->line__C);

    if (!finite) {
        return CABLE_BENCH_BAD_PARAMETER;
    }
    if (!(sample_time >= REAL(0.000999999)) || !finite_number(sample_time)) {
        return CABLE_BENCH_BAD_SAMPLE_TIME;
    }
    if (!(bandwidth * sample_time >= SLOWEST && bandwidth * sample_time <= REAL(3.0))) {
        return CABLE_BENCH_BAD_BANDWIDTH;
    }
    return CABLE_BENCH_OK;
}

/* Samples until `constants` time constants of the filter are over. */
static uint32_t samples(real constants, real sample_time, real bandwidth)
{
    const real wait = constants / (bandwidth * sample_time);
    const uint32_t whole = wait < REAL(4.0e9) ? (uint32_t)wait : UINT32_MAX - 1u;

    return (real)whole < wait ? whole + 1u : whole;
}

const cable_bench_coefficients cable_bench_nominal_coefficients = {
    REAL(0.9801980198019802),   /* a */
    REAL(0.00990099009900991),  /* b */
    {346u},                     /* samples until each is valid */
    346u                        /* the longest of these */
};

/* The coefficients, from the parameters. */
static void compute_coefficients(cable_bench_coefficients *c, real sample_time, real bandwidth)
{
    /* bandwidth*sample_time */
    const real x_ = bandwidth * sample_time;

    /* of a stage: what is left of its memory */
    const real pole = greatest(REAL(2.0) - x_, REAL(0.0)) / (x_ + REAL(2.0));

    /* filter: what is left of a memory a sample later */
    c->a = pole;

    /* filter: weight of a sample, new and a sample later */
    c->b = REAL(0.5) * (REAL(1.0) - pole);
}

static bool coefficients_are_finite(const cable_bench_coefficients *c)
{
    return finite_number(c->a + c->b);
}

cable_bench_status cable_bench_configure(
    cable_bench_coefficients *coefficients,
    const cable_bench_parameters *parameters,
    cable_bench_real sample_time,
    cable_bench_real bandwidth)
{
    cable_bench_coefficients *c = coefficients;
    const cable_bench_status status = checked(parameters, sample_time, bandwidth);
    int k;

    for (k = 0; k < CABLE_BENCH_RESIDUALS; ++k) {
        c->settle[k] = UINT32_MAX;
    }
    c->longest = UINT32_MAX;
    if (status != CABLE_BENCH_OK) {
        return status;
    }
    compute_coefficients(c, sample_time, bandwidth);
    if (!coefficients_are_finite(c)) {
        return CABLE_BENCH_BAD_COEFFICIENT;
    }
    c->settle[CABLE_BENCH_R1] = samples(REAL(6.907755278982138), sample_time, bandwidth);
    c->longest = c->settle[CABLE_BENCH_R1];
    return CABLE_BENCH_OK;
}

/* r1 on one sample.
 * khepera.bg:114: r1: line.cell[1].left with everything else inserted */
static void run_r1(
    const cable_bench_coefficients *c, cable_bench_memory *x, const cable_bench_samples *s, real *r)
{
    const bool first = x->youngest == 0u && x->age[0] == 0u;

    if (first) {
        /* nothing is remembered yet */
        x->r1_s1 = REAL(0.0);
    }

    /* a stage of the filter; on the first sample it is at rest */
    const real a = first ? -c->b : c->a;
    const real b = first ? REAL(1.0) : c->b;

    /* stage 1 */
    const real u1 = s->Uin - s->Us;
    const real y1 = x->r1_s1 + b * u1;
    x->r1_s1 = a * y1 + b * u1;

    r[CABLE_BENCH_R1] = y1;
}

/* Ages and validity one by one: a number that is not finite makes the next sample the first. */
static void count_samples(
    const cable_bench_coefficients *c,
    cable_bench_memory *x,
    cable_bench_residuals *out)
{
    /* the residuals that are computed, and what each one goes with */
    static const uint8_t number[] = {
        0
    };
    static const uint8_t part[] = {
        0
    };
    bool finite[1];
    int k;

    finite[0] = true;
    for (k = 0; k < 1; ++k) {
        finite[part[k]] = finite[part[k]] && finite_number(out->value[number[k]]);
    }
    x->youngest = UINT32_MAX;
    for (k = 0; k < 1; ++k) {
        x->age[k] = finite[k] ? x->age[k] + (x->age[k] < UINT32_MAX ? 1u : 0u) : 0u;
        x->youngest = x->age[k] < x->youngest ? x->age[k] : x->youngest;
    }
    for (k = 0; k < 1; ++k) {
        out->value[number[k]] = finite[part[k]] ? out->value[number[k]] : REAL(0.0);
        out->valid[number[k]] = x->age[part[k]] > c->settle[number[k]];
    }
}

void cable_bench_reset(cable_bench_memory *memory)
{
    int k;

    for (k = 0; k < 1; ++k) {
        memory->age[k] = 0u;
    }
    memory->youngest = 0u;
}

void cable_bench_step(
    const cable_bench_coefficients *coefficients,
    cable_bench_memory *memory,
    const cable_bench_samples *samples,
    cable_bench_residuals *residuals)
{
    const cable_bench_coefficients *c = coefficients;
    cable_bench_memory *x = memory;
    const cable_bench_samples *s = samples;
    real *r = residuals->value;
    int k;

    run_r1(c, x, s, r);
    /* a sum is finite only if all its terms are */
    if (x->youngest > c->longest && finite_number(r[CABLE_BENCH_R1])) {
        for (k = 0; k < CABLE_BENCH_RESIDUALS; ++k) {
            residuals->valid[k] = true;
        }
    } else {
        count_samples(c, x, residuals);
    }
}

const char cable_bench_fault_name[CABLE_BENCH_FAULTS][7] = {
    "line.R", "line.L", "line.C", "Uin", "Us",
};

const uint16_t cable_bench_fault_class[CABLE_BENCH_FAULTS] = {
    0u, 0u, 0u, 1u, 1u,
};

const char cable_bench_residual_name[CABLE_BENCH_RESIDUALS][3] = {
    "r1",
};

/*
 * Signatures: the faults of class c are seen by the residuals of entries first_entry[c] and up to
 * first_entry[c + 1].
 */
static const uint32_t first_entry[CABLE_BENCH_CLASSES + 1] = {
    0u, 1u, 2u,
};

static const uint16_t seen_by[2] = {
    0u, 0u,
};

/*
 * Sizes of faults in eighths of an octave: a residual in alarm makes a fault so much larger than
 * what is least here as it is out.
 */
static const uint8_t least_size[2] = {
    1u, 1u,
};

/* A residual is sure to show a fault of this size; 255: of no size. */
static const uint8_t sure_size[2] = {
    255u, 0u,
};

/* The peak of residual k since it went into alarm, beside what is sure to be one. */
static void remember_peak(
    cable_bench_diagnosis *d, const cable_bench_limit *limit, int k, real out, real bound)
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
static int size_of(const cable_bench_diagnosis *d, int c, int alarms)
{
    const uint32_t begin = first_entry[c];
    const uint32_t end = first_entry[c + 1];
    int size = 0;
    int seen = 0;
    uint32_t i;

    for (i = begin; i < end; ++i) {
        const int k = (int)seen_by[i];

        if (d->state[k] == CABLE_BENCH_ALARM) {
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
static cable_bench_candidate left_of(const cable_bench_diagnosis *d, int c, int alarms)
{
    const uint32_t begin = first_entry[c];
    const uint32_t end = first_entry[c + 1];
    const int size = size_of(d, c, alarms);
    uint32_t i;

    if (size < 0) {
        return CABLE_BENCH_RULED_OUT;
    }
    if (d->settled < d->window) {
        return CABLE_BENCH_LIKELY; /* too soon for what is quiet to say anything */
    }
    for (i = begin; i < end; ++i) {
        const int k = (int)seen_by[i];
        const int sure = (int)sure_size[i];

        if (d->state[k] == CABLE_BENCH_HEALTHY && sure != 255 && sure <= size) {
            return CABLE_BENCH_SMALL;
        }
    }
    return CABLE_BENCH_LIKELY;
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
    cable_bench_diagnosis *d, const cable_bench_limit *limit, int k, real off, real out, real bound)
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

static bool sums_are_zero(const cable_bench_diagnosis *d, int k)
{
    const real sum = d->above[k] + d->below[k] + d->louder[k];

    return !(sum > REAL(0.0));
}

static void forget_sums(cable_bench_diagnosis *d, int k)
{
    d->above[k] = REAL(0.0);
    d->below[k] = REAL(0.0);
    d->louder[k] = REAL(0.0);
    d->streak[k] = 0u;
}

/* How far a residual is beyond its bound; off: from its mean. */
static real excess(real off, real bound)
{
#if defined __GNUC__ && !defined CABLE_BENCH_REAL
    return MATH(__builtin_fabs)(off) - bound; /* one instruction, no library */
#else
    return (off < REAL(0.0) ? -off : off) - bound;
#endif
}

static bool is_within(const cable_bench_limit *limit, real value, real bound)
{
    return excess(value - limit->mean, bound) <= limit->level;
}

/* Residual k in one sample; whether it goes into alarm. */
static bool watch(
    cable_bench_diagnosis *d, const cable_bench_limit *limit, int k, real value, real bound, bool row)
{
    const real off = value - limit->mean;
    const real out = excess(off, bound);
    bool high = false;

    if (row) {
        high = add_row(d, limit, k, off, out, bound);
    }
    if (d->state[k] == CABLE_BENCH_ALARM) {
        d->since[k] += d->since[k] < UINT32_MAX ? 1u : 0u;
        remember_peak(d, limit, k, out, bound);
        if (!(out < RELEASE * limit->level) || !sums_are_zero(d, k)) {
            d->quiet = 0u;
        }
        return false;
    }
    d->state[k] = CABLE_BENCH_HEALTHY;
    d->streak[k] = out > limit->level ? d->streak[k] + 1u : 0u;
    if (d->streak[k] < d->least && !high) {
        return false;
    }
    d->state[k] = CABLE_BENCH_ALARM;
    d->since[k] = 0u;
    d->peak[k] = REAL(0.0);
    remember_peak(d, limit, k, out, bound);
    return true;
}

/* Which classes of faults the residuals leave, and the one if it is one. */
static void judge(cable_bench_diagnosis *d)
{
    int likely = 0;
    int alarms = 0;
    int c;
    int k;

    for (k = 0; k < CABLE_BENCH_RESIDUALS; ++k) {
        alarms += d->state[k] == CABLE_BENCH_ALARM ? 1 : 0;
    }
    d->fault_class = CABLE_BENCH_UNKNOWN;
    for (c = 0; c < CABLE_BENCH_CLASSES; ++c) {
        const cable_bench_candidate left = left_of(d, c, alarms);

        d->candidate[c] = (uint8_t)left;
        if (left == CABLE_BENCH_LIKELY) {
            d->fault_class = (int16_t)c;
            ++likely;
        }
    }
    if (likely != 1 || d->settled < 2u * d->row) {
        d->fault_class = CABLE_BENCH_UNKNOWN;
    }
}

cable_bench_limit cable_bench_limit_of(cable_bench_real level)
{
    cable_bench_limit limit;

    limit.mean = REAL(0.0);
    limit.level = level;
    limit.unit = REAL(0.0);
    limit.loud = REAL(0.0);
    limit.drift = REAL(0.5);
    limit.height = NEVER;
    limit.bound = REAL(0.0);
    return limit;
}

void cable_bench_clear(cable_bench_diagnosis *diagnosis)
{
    int k;

    for (k = 0; k < CABLE_BENCH_RESIDUALS; ++k) {
        if (diagnosis->state[k] == CABLE_BENCH_ALARM) {
            diagnosis->state[k] = CABLE_BENCH_HEALTHY;
        }
        diagnosis->since[k] = 0u;
        diagnosis->peak[k] = REAL(0.0);
        forget_sums(diagnosis, k);
    }
    for (k = 0; k < CABLE_BENCH_CLASSES; ++k) {
        diagnosis->candidate[k] = CABLE_BENCH_RULED_OUT;
    }
    diagnosis->fault_class = CABLE_BENCH_UNKNOWN;
    diagnosis->quiet = 0u;
    diagnosis->settled = 0u;
    diagnosis->calm = false;
}

void cable_bench_diagnosis_reset(cable_bench_diagnosis *diagnosis)
{
    int k;

    diagnosis->row = CABLE_BENCH_ROW;
    diagnosis->least = 15u;
    diagnosis->hold = 10u * CABLE_BENCH_ROW;
    diagnosis->window = 300u;
    diagnosis->latch = false;
    diagnosis->tick = 0u;
    for (k = 0; k < CABLE_BENCH_RESIDUALS; ++k) {
        diagnosis->state[k] = CABLE_BENCH_BLIND;
    }
    cable_bench_clear(diagnosis);
}

/* Whether each residual has a value within its level: nearly all samples are so. */
static bool all_within(
    const cable_bench_limit *limits, const real *bounds, const cable_bench_residuals *residuals)
{
    const real *value = residuals->value;
    int k;

    if (bounds != NULL) {
        for (k = 0; k < CABLE_BENCH_RESIDUALS; ++k) {
            if (!residuals->valid[k] || !is_within(&limits[k], value[k], bounds[k])) {
                return false;
            }
        }
    } else {
        for (k = 0; k < CABLE_BENCH_RESIDUALS; ++k) {
            if (!residuals->valid[k] || !is_within(&limits[k], value[k], limits[k].bound)) {
                return false;
            }
        }
    }
    return true;
}

/* Residual k without a value. */
static void blind(cable_bench_diagnosis *d, int k)
{
    forget_sums(d, k);
    if (d->state[k] == CABLE_BENCH_ALARM) {
        d->quiet = 0u; /* nobody knows that it is over */
    } else {
        d->state[k] = CABLE_BENCH_BLIND;
    }
}

bool cable_bench_diagnose(
    cable_bench_diagnosis *diagnosis,
    const cable_bench_limit *limits,
    const cable_bench_real *bounds,
    const cable_bench_residuals *residuals)
{
    cable_bench_diagnosis *d = diagnosis;
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
    for (k = 0; k < CABLE_BENCH_RESIDUALS; ++k) {
        if (residuals->valid[k]) {
            const real bound = bounds ? bounds[k] : limits[k].bound;

            fresh = watch(d, &limits[k], k, residuals->value[k], bound, row) || fresh;
        } else {
            blind(d, k);
        }
        d->calm = d->calm && d->state[k] == CABLE_BENCH_HEALTHY && d->streak[k] == 0u;
        alarm = alarm || d->state[k] == CABLE_BENCH_ALARM;
    }
    if (fresh) {
        d->quiet = 0u;
        d->settled = 0u;
    }
    if (alarm && !d->latch && d->quiet >= d->hold) {
        cable_bench_clear(d);
        return false;
    }
    if (fresh || (alarm && row)) {
        judge(d);
    }
    return alarm;
}
