/* cable_bench_residuals.c: the residuals of CableBench; generated, see the header. */
#include "cable_bench_residuals.h"


#if defined __FINITE_MATH_ONLY__ && __FINITE_MATH_ONLY__
#error "this code tells numbers from NaN: compile it without -ffinite-math-only (-ffast-math)"
#endif

typedef cable_bench_real real;

#define REAL(x) CABLE_BENCH_CONSTANT(x)
#if defined CABLE_BENCH_FLOAT && !defined CABLE_BENCH_REAL
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

/* The coefficients of exact and of the filter, from the parameters. */
static void compute_coefficients(cable_bench_monitor *monitor, const cable_bench_parameters *p,
        real sample_time, real bandwidth)
{
    cable_bench_coefficients *c = &monitor->c;

    /* bandwidth*sample_time */
    const real x_ = bandwidth * sample_time;

    /* of a stage: what is left of its memory */
    const real pole = greatest(REAL(2.0) - x_, REAL(0.0)) / (x_ + REAL(2.0));

    /* khepera.bg:114: line.L*line.C */
    const real t = p->line__L * p->line__C;

    /* khepera.bg:114: line.L*line.C^2 */
    const real t_2 = p->line__L * p->line__C * p->line__C;

    /* khepera.bg:114: line.R*line.L*line.C^2 */
    const real t_3 = p->line__R * p->line__L * p->line__C * p->line__C;

    /* khepera.bg:114: line.L^2*line.C^2 */
    const real t_4 = p->line__L * p->line__L * p->line__C * p->line__C;

    /* khepera.bg:114: line.R^2*line.C^2 */
    const real t_5 = p->line__R * p->line__R * p->line__C * p->line__C;

    /* khepera.bg:114: line.C*(0.4375*line.L*line.C + 0.0078125*line.R^2*line.C^2) */
    const real t_6 = p->line__C * (REAL(0.4375) * t + REAL(0.0078125) * t_5);

    /* khepera.bg:114: line.R*line.L*line.C^3 */
    const real t_7 = p->line__R * p->line__L * p->line__C * p->line__C * p->line__C;

    /* khepera.bg:114: line.L^2*line.C^3 */
    const real t_8 = p->line__L * p->line__L * p->line__C * p->line__C * p->line__C;

    /* khepera.bg:114: 0.03125*line.L*line.C^2 + line.C*(0.4375*line.L*line.C +
     * 0.0078125*line.R^2*line.C^2)/4 */
    const real t_9 = REAL(0.03125) * t_2 + REAL(0.25) * t_6;

    /* khepera.bg:114: line.L*(0.03125*line.L*line.C^2 + line.C*(0.4375*line.L*line.C +
     * 0.0078125*line.R^2*li ... */
    const real t_10 = p->line__L * t_9;

    /* khepera.bg:114: line.R*(0.03125*line.L*line.C^2 + line.C*(0.4375*line.L*line.C +
     * 0.0078125*line.R^2*li ... */
    const real t_11 = p->line__R * t_9;

    /* khepera.bg:114: line.R^2*line.L*line.C^3 */
    const real t_12 = p->line__R * p->line__R * p->line__L * p->line__C * p->line__C * p->line__C;

    /* khepera.bg:114: line.C*(0.8125*line.L*line.C + 0.04296875*line.R^2*line.C^2) */
    const real t_13 = p->line__C * (REAL(0.8125) * t + REAL(0.04296875) * t_5);

    /* khepera.bg:114: line.C*(0.05078125*line.R*line.L*line.C^2 +
     * line.R*(0.03125*line.L*line.C^2 + line.C*( ... */
    const real t_14 = p->line__C * (REAL(0.05078125) * t_3 + REAL(0.25) * t_11);

    /* khepera.bg:114: line.C*(0.0078125*line.L^2*line.C^2 + line.L*(0.03125*line.L*line.C^2 +
     * line.C*(0.4375 ... */
    const real t_15 = p->line__C * (REAL(0.0078125) * t_4 + REAL(0.25) * t_10
            + REAL(0.0009765625) * t_12);

    /* khepera.bg:114: 0.03125*line.L*line.C^2 + line.C*(0.4375*line.L*line.C +
     * 0.0078125*line.R^2*line.C^2)/ ... */
    const real t_16 = REAL(0.03125) * t_2 + REAL(0.25) * t_6 + REAL(0.25) * t_13;

    /* khepera.bg:114: 0.00390625*line.R*line.L*line.C^3 +
     * line.C*(0.05078125*line.R*line.L*line.C^2 + line.R ... */
    const real t_17 = REAL(0.00390625) * t_7 + REAL(0.25) * t_14;

    /* khepera.bg:114: 0.001953125*line.L^2*line.C^3 + line.C*(0.0078125*line.L^2*line.C^2 +
     * line.L*(0.03125* ... */
    const real t_18 = REAL(0.001953125) * t_8 + REAL(0.25) * t_15;

    /* khepera.bg:114: 1.25*line.L*line.C + 0.12890625*line.R^2*line.C^2 */
    const real t_19 = REAL(1.25) * t + REAL(0.12890625) * t_5;

    /* khepera.bg:114: 0.13671875*line.R*line.L*line.C^2 + line.R*(0.03125*line.L*line.C^2 +
     * line.C*(0.4375*l ... */
    const real t_20 = REAL(0.13671875) * t_3 + REAL(0.25) * t_11 + REAL(0.25) * p->line__R * t_16;

    /* khepera.bg:114: 0.0078125*line.L^2*line.C^2 + line.L*(0.03125*line.L*line.C^2 +
     * line.C*(0.4375*line.L* ... */
    const real t_21 = REAL(0.0078125) * t_4 + REAL(0.25) * t_10 + REAL(0.0009765625) * t_12
        + REAL(0.25) * p->line__L * t_16 + REAL(0.25) * p->line__R * t_17;

    /* khepera.bg:114: 0.00146484375*line.R*line.L^2*line.C^3 +
     * line.L*(0.00390625*line.R*line.L*line.C^3 + l ... */
    const real t_22 = REAL(0.00146484375) * p->line__R * p->line__L * p->line__L * p->line__C
            * p->line__C * p->line__C
        + REAL(0.25) * p->line__L * t_17 + REAL(0.25) * p->line__R * t_18;

    /* khepera.bg:114: 0.00048828125*line.L^3*line.C^3 + line.L*(0.001953125*line.L^2*line.C^3 +
     * line.C*(0.00 ... */
    const real t_23 = REAL(0.00048828125) * p->line__L * p->line__L * p->line__L * p->line__C
            * p->line__C * p->line__C
        + REAL(0.25) * p->line__L * t_18
        + REAL(9.1552734375e-05) * p->line__R * p->line__R * p->line__L * p->line__L * p->line__C
            * p->line__C * p->line__C * p->line__C;

    /* khepera.bg:114: 0.03125*line.L*line.C^2 + line.C*(0.4375*line.L*line.C +
     * 0.0078125*line.R^2*line.C^2)/ ... */
    const real t_24 = REAL(0.03125) * t_2 + REAL(0.25) * t_6 + REAL(0.25) * t_13
        + REAL(0.25) * p->line__C * t_19;

    /* khepera.bg:114: 0.00390625*line.R*line.L*line.C^3 +
     * line.C*(0.05078125*line.R*line.L*line.C^2 + line.R ... */
    const real t_25 = REAL(0.00390625) * t_7 + REAL(0.25) * t_14 + REAL(0.25) * p->line__C * t_20;

    /* khepera.bg:114: 0.001953125*line.L^2*line.C^3 + line.C*(0.0078125*line.L^2*line.C^2 +
     * line.L*(0.03125* ... */
    const real t_26 = REAL(0.001953125) * t_8 + REAL(0.25) * t_15 + REAL(0.25) * p->line__C * t_21;

    /* khepera.bg:114: 0.0003662109375*line.R*line.L^2*line.C^4 +
     * line.C*(0.00146484375*line.R*line.L^2*line. ... */
    const real t_27 = REAL(0.0003662109375) * p->line__R * p->line__L * p->line__L * p->line__C
            * p->line__C * p->line__C * p->line__C
        + REAL(0.25) * p->line__C * t_22;

    /* khepera.bg:114: 0.0001220703125*line.L^3*line.C^4 +
     * line.C*(0.00048828125*line.L^3*line.C^3 + line.L*( ... */
    const real t_28 = REAL(0.0001220703125) * p->line__L * p->line__L * p->line__L * p->line__C
            * p->line__C * p->line__C * p->line__C
        + REAL(0.25) * p->line__C * t_23;

    /* 1 - pole */
    const real t_29 = REAL(1.0) - pole;

    /* khepera.bg:114: r1: factor of Us': 1.5*line.R*line.C */
    c->r1_Us_1 = REAL(1.5) * p->line__R * p->line__C;

    /* khepera.bg:114: r1: factor of Us'': line.L*line.C/4 + 0.08203125*line.R^2*line.C^2 +
     * (1.25*line.L*line.C + 0.12890625*line ... */
    c->r1_Us_2 = REAL(0.25) * t + REAL(0.08203125) * t_5 + t_19;

    /* khepera.bg:114: r1: factor of Us''': 0.08203125*line.R*line.L*line.C^2 +
     * (0.13671875*line.R*line.L*line.C^2 + line.R*(0.031 ... */
    c->r1_Us_3 = REAL(0.08203125) * t_3 + t_20 + REAL(0.125) * p->line__R * t_24;

    /* khepera.bg:114: r1: factor of D(Us, 4): ... */
    c->r1_Us_4 = t_21 + REAL(0.125) * p->line__L * t_24 + REAL(0.125) * p->line__R * t_25;

    /* khepera.bg:114: r1: factor of D(Us, 5): ... */
    c->r1_Us_5 = t_22 + REAL(0.125) * p->line__L * t_25 + REAL(0.125) * p->line__R * t_26;

    /* khepera.bg:114: r1: factor of D(Us, 6): ... */
    c->r1_Us_6 = t_23 + REAL(0.125) * p->line__L * t_26 + REAL(0.125) * p->line__R * t_27;

    /* khepera.bg:114: r1: factor of D(Us, 7): 0.0001220703125*line.R*line.L^3*line.C^4 +
     * line.L*(0.0003662109375*line.R*line.L^2*lin ... */
    c->r1_Us_7 = REAL(0.0001220703125) * p->line__R * p->line__L * p->line__L * p->line__L
            * p->line__C * p->line__C * p->line__C * p->line__C
        + REAL(0.125) * p->line__L * t_27 + REAL(0.125) * p->line__R * t_28;

    /* khepera.bg:114: r1: factor of D(Us, 8): 3.0517578125e-05*line.L^4*line.C^4 +
     * line.L*(0.0001220703125*line.L^3*line.C^4 + line. ... */
    c->r1_Us_8 = REAL(3.0517578125e-05) * p->line__L * p->line__L * p->line__L * p->line__L
            * p->line__C * p->line__C * p->line__C * p->line__C
        + REAL(0.125) * p->line__L * t_28
        + REAL(3.814697265625e-06) * p->line__R * p->line__R * p->line__L * p->line__L * p->line__L
            * p->line__C * p->line__C * p->line__C * p->line__C * p->line__C;

    /* khepera.bg:114: r1: factor of D(Us, 9): 4.76837158203125e-06*line.R*line.L^4*line.C^5 */
    c->r1_Us_9 = REAL(4.76837158203125e-06) * p->line__R * p->line__L * p->line__L * p->line__L
            * p->line__L * p->line__C * p->line__C * p->line__C * p->line__C * p->line__C;

    /* khepera.bg:114: r1: factor of D(Us, 10): 9.5367431640625e-07*line.L^5*line.C^5 */
    c->r1_Us_10 = REAL(9.5367431640625e-07) * p->line__L * p->line__L * p->line__L * p->line__L
            * p->line__L * p->line__C * p->line__C * p->line__C * p->line__C * p->line__C;

    /* filter: what is left of a memory a sample later */
    c->a = pole;

    /* filter: weight of a sample, new and a sample later */
    c->b = REAL(0.5) * t_29;

    /* filter: 1 - b, the memory of a constant 1 */
    c->rest = REAL(1.0) - REAL(0.5) * t_29;
}

static bool parameters_are_finite(const cable_bench_parameters *p)
{
    return finite_number(p->line__R + p->line__L + p->line__C);
}

static bool coefficients_are_finite(const cable_bench_monitor *monitor)
{
    return finite_number(monitor->c.r1_Us_1 + monitor->c.r1_Us_2 + monitor->c.r1_Us_3
            + monitor->c.r1_Us_4 + monitor->c.r1_Us_5 + monitor->c.r1_Us_6 + monitor->c.r1_Us_7
            + monitor->c.r1_Us_8 + monitor->c.r1_Us_9 + monitor->c.r1_Us_10 + monitor->c.a
            + monitor->c.b + monitor->c.rest);
}

/* Samples until `constants` time constants of the filter are over. */
static uint32_t samples(real constants, real sample_time, real bandwidth)
{
    const real wait = constants / (bandwidth * sample_time);
    const uint32_t whole = wait < REAL(4.0e9) ? (uint32_t)wait : UINT32_MAX - 1u;

    return (real)whole < wait ? whole + 1u : whole;
}

cable_bench_status cable_bench_configure(
    cable_bench_monitor *monitor,
    const cable_bench_parameters *parameters,
    cable_bench_real sample_time,
    cable_bench_real bandwidth,
    cable_bench_real time_unit)
{
    int k;

    for (k = 0; k < CABLE_BENCH_RESIDUALS; ++k) {
        monitor->settle[k] = UINT32_MAX;
    }
    cable_bench_reset(monitor);
    if (!parameters_are_finite(parameters)) {
        return CABLE_BENCH_BAD_PARAMETER;
    }
    if (!(sample_time >= REAL(0.000999999)) || !finite_number(sample_time)) {
        return CABLE_BENCH_BAD_SAMPLE_TIME;
    }
    if (!(bandwidth * sample_time >= SLOWEST && bandwidth * sample_time <= REAL(3.0))) {
        return CABLE_BENCH_BAD_BANDWIDTH;
    }
    if (!(time_unit > REAL(0.0)) || !finite_number(time_unit)) {
        return CABLE_BENCH_BAD_TIME_UNIT;
    }
    compute_coefficients(monitor, parameters, sample_time, bandwidth);
    if (!coefficients_are_finite(monitor)) {
        return CABLE_BENCH_BAD_COEFFICIENT;
    }
    monitor->settle[CABLE_BENCH_R1] = samples(REAL(6.907755278982138), sample_time, bandwidth);
    return CABLE_BENCH_OK;
}

void cable_bench_exact(
    const cable_bench_monitor *monitor,
    const cable_bench_derivatives *derivatives,
    cable_bench_real residuals[CABLE_BENCH_RESIDUALS])
{
    const cable_bench_coefficients *c = &monitor->c;
    const cable_bench_derivatives *d = derivatives;
    real *r = residuals;

    /* khepera.bg:114: r1: line.cell[1].left with everything else inserted */
    r[CABLE_BENCH_R1] = d->Uin - d->Us[0] - c->r1_Us_1 * d->Us[1] - c->r1_Us_2 * d->Us[2]
        - c->r1_Us_3 * d->Us[3] - c->r1_Us_4 * d->Us[4] - c->r1_Us_5 * d->Us[5]
        - c->r1_Us_6 * d->Us[6] - c->r1_Us_7 * d->Us[7] - c->r1_Us_8 * d->Us[8]
        - c->r1_Us_9 * d->Us[9] - c->r1_Us_10 * d->Us[10];
}

/* r1 on its first sample: the filter as if it had always been so. */
static void start_r1(
    cable_bench_monitor *monitor, const cable_bench_samples *s, real *r)
{
    const cable_bench_coefficients *c = &monitor->c;
    cable_bench_memory *x = &monitor->x;

    /* khepera.bg:114: r1: input of stage 1 */
    const real r1_u1 = s->Uin - s->Us;

    /* khepera.bg:114: r1: stage 1, at rest */
    const real r1_y1 = r1_u1;

    /* khepera.bg:114: r1: stage 1: memory */
    x->r1_s1 = c->rest * r1_u1;

    /* khepera.bg:114: r1: line.cell[1].left with everything else inserted */
    r[CABLE_BENCH_R1] = r1_y1;
}

/* r1 on every further sample. */
static void next_r1(
    cable_bench_monitor *monitor, const cable_bench_samples *s, real *r)
{
    const cable_bench_coefficients *c = &monitor->c;
    cable_bench_memory *x = &monitor->x;

    /* khepera.bg:114: r1: input of stage 1 */
    const real r1_u1 = s->Uin - s->Us;

    /* khepera.bg:114: r1: stage 1 */
    const real r1_y1 = x->r1_s1 + c->b * r1_u1;

    /* khepera.bg:114: r1: stage 1: memory */
    x->r1_s1 = c->a * r1_y1 + c->b * r1_u1;

    /* khepera.bg:114: r1: line.cell[1].left with everything else inserted */
    r[CABLE_BENCH_R1] = r1_y1;
}

/* One sample for r1; a number that is not finite makes the next sample the first. */
static void run_r1(
    cable_bench_monitor *monitor, const cable_bench_samples *s, cable_bench_residuals *residuals)
{
    real *r = residuals->value;
    uint32_t age = monitor->age[0];

    if (age == 0u) {
        start_r1(monitor, s, r);
    } else {
        next_r1(monitor, s, r);
    }
    /* a sum is finite only if all its terms are */
    if (finite_number(s->Uin + s->Us + r[CABLE_BENCH_R1])) {
        age += age < UINT32_MAX ? 1u : 0u;
    } else {
        age = 0u;
        r[CABLE_BENCH_R1] = REAL(0.0);
    }
    monitor->age[0] = age;
    residuals->valid[CABLE_BENCH_R1] = age > monitor->settle[CABLE_BENCH_R1];
}

void cable_bench_reset(cable_bench_monitor *monitor)
{
    int k;

    for (k = 0; k < 1; ++k) {
        monitor->age[k] = 0u;
    }
}

void cable_bench_step(
    cable_bench_monitor *monitor,
    const cable_bench_samples *samples,
    cable_bench_residuals *residuals)
{
    run_r1(monitor, samples, residuals);
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

/* Signatures: 1 where a residual may be moved by the faults of a class, 3 where it is for sure. */
static const uint8_t signature[CABLE_BENCH_CLASSES][CABLE_BENCH_RESIDUALS] = {
    {1u},
    {3u},
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

/* Residual k in one sample; whether it goes into alarm. */
static bool watch(
    cable_bench_diagnosis *d, const cable_bench_limit *limit, int k, real value, real bound, bool row)
{
    const real off = value - limit->mean;
    const real out = (off < REAL(0.0) ? -off : off) - bound;
    bool high = false;

    if (row) {
        high = add_row(d, limit, k, off, out, bound);
    }
    if (d->state[k] == CABLE_BENCH_ALARM) {
        d->since[k] += d->since[k] < UINT32_MAX ? 1u : 0u;
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
    return true;
}

/* What is left of a class of faults. */
static cable_bench_candidate left_of(const cable_bench_diagnosis *d, const uint8_t *own)
{
    cable_bench_candidate found = CABLE_BENCH_LIKELY;
    int k;

    for (k = 0; k < CABLE_BENCH_RESIDUALS; ++k) {
        if (d->state[k] == CABLE_BENCH_ALARM && own[k] == 0u) {
            return CABLE_BENCH_RULED_OUT;
        }
        if (d->state[k] == CABLE_BENCH_HEALTHY && own[k] == 3u) {
            found = CABLE_BENCH_SMALL;
        }
    }
    return found;
}

/* Which classes of faults the residuals leave, and the one if it is one. */
static void judge(cable_bench_diagnosis *d)
{
    int likely = 0;
    int c;

    d->fault_class = CABLE_BENCH_UNKNOWN;
    for (c = 0; c < CABLE_BENCH_CLASSES; ++c) {
        const cable_bench_candidate left = left_of(d, signature[c]);

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
        forget_sums(diagnosis, k);
    }
    for (k = 0; k < CABLE_BENCH_CLASSES; ++k) {
        diagnosis->candidate[k] = CABLE_BENCH_RULED_OUT;
    }
    diagnosis->fault_class = CABLE_BENCH_UNKNOWN;
    diagnosis->quiet = 0u;
    diagnosis->settled = 0u;
}

void cable_bench_diagnosis_reset(cable_bench_diagnosis *diagnosis)
{
    int k;

    diagnosis->row = CABLE_BENCH_ROW;
    diagnosis->least = 15u;
    diagnosis->hold = 10u * CABLE_BENCH_ROW;
    diagnosis->latch = false;
    diagnosis->tick = 0u;
    for (k = 0; k < CABLE_BENCH_RESIDUALS; ++k) {
        diagnosis->state[k] = CABLE_BENCH_BLIND;
    }
    cable_bench_clear(diagnosis);
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
            forget_sums(d, k);
            if (d->state[k] == CABLE_BENCH_ALARM) {
                d->quiet = 0u; /* nobody knows that it is over */
            } else {
                d->state[k] = CABLE_BENCH_BLIND;
            }
        }
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
