/* khepera_built_residuals.c: the residuals of KheperaBuilt; generated, see the header. */
#include "khepera_built_residuals.h"


#if defined __FINITE_MATH_ONLY__ && __FINITE_MATH_ONLY__
#error "this code tells numbers from NaN: compile it without -ffinite-math-only (-ffast-math)"
#endif

typedef khepera_built_real real;

#define REAL(x) KHEPERA_BUILT_CONSTANT(x)
#if defined KHEPERA_BUILT_FLOAT && !defined KHEPERA_BUILT_REAL
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

/* Takes a count; the difference to the one before is right also when the counter runs over. */
static void count_on(khepera_built_encoder *encoder, int32_t count)
{
    const uint32_t step = (uint32_t)count - encoder->count;

    encoder->increment = step <= INT32_MAX ? (int32_t)step : -(int32_t)(UINT32_MAX - step) - 1;
    encoder->total += encoder->increment;
    encoder->count = (uint32_t)count;
}

/* Takes the first count. */
static void count_from(khepera_built_encoder *encoder, int32_t count)
{
    encoder->count = (uint32_t)count;
    encoder->increment = 0;
    encoder->total = 0;
}

uint32_t khepera_built_abi(void)
{
    return KHEPERA_BUILT_ABI;
}

const char *khepera_built_digest(void)
{
    return KHEPERA_BUILT_DIGEST;
}

void khepera_built_nominal(khepera_built_parameters *parameters)
{
    parameters->R_L = REAL(0.85);             /* Ohm */
    parameters->m__1__Je = REAL(1.4e-08);     /* kg.m^2 */
    parameters->m__1__fe = REAL(1.0e-07);     /* N.m.s/rad */
    parameters->m__1__Js = REAL(1.0e-05);     /* kg.m^2 */
    parameters->m__1__fs = REAL(0.0003);      /* N.m.s/rad */
    parameters->m__1__R = REAL(0.008);        /* m */
    parameters->m__1__el__L = REAL(0.0003);   /* H */
    parameters->m__1__el__Re = REAL(17.6);    /* Ohm */
    parameters->m__1__el__k = REAL(0.00351);  /* N.m/A */
    parameters->m__1__ge__N = REAL(25.0);     /* 1 */
    parameters->m__2__Je = REAL(1.4e-08);     /* kg.m^2 */
    parameters->m__2__fe = REAL(1.0e-07);     /* N.m.s/rad */
    parameters->m__2__Js = REAL(1.0e-05);     /* kg.m^2 */
    parameters->m__2__fs = REAL(0.0003);      /* N.m.s/rad */
    parameters->m__2__R = REAL(0.008);        /* m */
    parameters->m__2__el__L = REAL(0.0003);   /* H */
    parameters->m__2__el__Re = REAL(17.6);    /* Ohm */
    parameters->m__2__el__k = REAL(0.00351);  /* N.m/A */
    parameters->m__2__ge__N = REAL(25.0);     /* 1 */
}

/* The coefficients of exact and of the filter, from the parameters. */
static void compute_coefficients(khepera_built_monitor *monitor, const khepera_built_parameters *p,
        real sample_time, real bandwidth)
{
    khepera_built_coefficients *c = &monitor->c;

    /* bandwidth*sample_time */
    const real x_ = bandwidth * sample_time;

    /* of a stage: what is left of its memory */
    const real pole = greatest(REAL(2.0) - x_, REAL(0.0)) / (x_ + REAL(2.0));

    /* w*sample_time, x or 2 */
    const real turn = REAL(2.0) * (REAL(1.0) - pole) / (pole + REAL(1.0));

    /* w of the filter 1/(1 + D/w) */
    const real w = turn / sample_time;

    /* khepera.bg:17: m[1].fe + m[1].fs/m[1].ge.N^2 */
    const real t = p->m__1__fe + p->m__1__fs / p->m__1__ge__N / p->m__1__ge__N;

    /* khepera.bg:17: m[1].Je + m[1].Js/m[1].ge.N^2 */
    const real t_2 = p->m__1__Je + p->m__1__Js / p->m__1__ge__N / p->m__1__ge__N;

    /* khepera.bg:17: m[1].el.L*(m[1].fe + m[1].fs/m[1].ge.N^2)/m[1].el.k */
    const real t_3 = p->m__1__el__L * t / p->m__1__el__k;

    /* khepera.bg:17: m[1].el.Re*(m[1].Je + m[1].Js/m[1].ge.N^2)/m[1].el.k */
    const real t_4 = p->m__1__el__Re * t_2 / p->m__1__el__k;

    /* khepera.bg:17: m[2].fe + m[2].fs/m[2].ge.N^2 */
    const real t_5 = p->m__2__fe + p->m__2__fs / p->m__2__ge__N / p->m__2__ge__N;

    /* khepera.bg:17: m[2].Je + m[2].Js/m[2].ge.N^2 */
    const real t_6 = p->m__2__Je + p->m__2__Js / p->m__2__ge__N / p->m__2__ge__N;

    /* khepera.bg:17: m[2].el.L*(m[2].fe + m[2].fs/m[2].ge.N^2)/m[2].el.k */
    const real t_7 = p->m__2__el__L * t_5 / p->m__2__el__k;

    /* khepera.bg:17: m[2].el.Re*(m[2].Je + m[2].Js/m[2].ge.N^2)/m[2].el.k */
    const real t_8 = p->m__2__el__Re * t_6 / p->m__2__el__k;

    /* 1 - pole */
    const real t_9 = REAL(1.0) - pole;

    /* 1 - (1 - pole)/2 */
    const real t_10 = REAL(1.0) - REAL(0.5) * t_9;

    /* turn^2 */
    const real t_11 = turn * turn;

    /* khepera.bg:17: r1: factor of m[1].motor': m[1].el.k + m[1].el.Re*(m[1].fe +
     * m[1].fs/m[1].ge.N^2)/m[1].el.k */
    c->r1_m__1__motor_1 = p->m__1__el__k + p->m__1__el__Re * t / p->m__1__el__k;

    /* khepera.bg:17: r1: factor of m[1].motor'': m[1].el.L*(m[1].fe +
     * m[1].fs/m[1].ge.N^2)/m[1].el.k + m[1].el.Re*(m[1].Je + m[1].Js/m[ ... */
    c->r1_m__1__motor_2 = t_3 + t_4;

    /* khepera.bg:17: r1: factor of m[1].motor''': m[1].el.L*(m[1].Je +
     * m[1].Js/m[1].ge.N^2)/m[1].el.k */
    c->r1_m__1__motor_3 = p->m__1__el__L * t_2 / p->m__1__el__k;

    /* khepera.bg:17: r1: factor of Fx[1]: m[1].R*m[1].el.Re/(m[1].el.k*m[1].ge.N) */
    c->r1_Fx__1 = p->m__1__R * p->m__1__el__Re / p->m__1__el__k / p->m__1__ge__N;

    /* khepera.bg:17: r1: factor of Fx[1]': m[1].R*m[1].el.L/(m[1].el.k*m[1].ge.N) */
    c->r1_Fx__1_1 = p->m__1__R * p->m__1__el__L / p->m__1__el__k / p->m__1__ge__N;

    /* speed of m[1].motor for one count */
    c->m__1__motor_gain = REAL(884279719003555.0) * t_10 * w / REAL(3377699720527872.0);

    /* filter: what is left of a memory a sample later */
    c->a = pole;

    /* khepera.bg:17: r1: factor of m[1].motor'' */
    c->r1_w2_m__1__motor = (-t_3 - t_4) * w;

    /* khepera.bg:17: r1: factor of m[1].motor''' */
    c->r1_w3_m__1__motor = p->m__1__el__L * t_2 * w * w / p->m__1__el__k;

    /* khepera.bg:17: r1: factor of Fx[1]' */
    c->r1_w1_Fx__1 = p->m__1__R * p->m__1__el__L * w / p->m__1__el__k / p->m__1__ge__N;

    /* filter: 2 * (w*sample_time)^2/12 */
    c->bend2 = t_11 / REAL(6.0);

    /* filter: 1 * (w*sample_time)^2/12 */
    c->bend1 = t_11 / REAL(12.0);

    /* filter: 3 * (w*sample_time)^2/12 */
    c->bend3 = REAL(0.25) * t_11;

    /* filter: weight of a sample, new and a sample later */
    c->b = REAL(0.5) * t_9;

    /* filter: 1 - b, the memory of a constant 1 */
    c->rest = t_10;

    /* khepera.bg:17: r2: factor of m[2].motor': m[2].el.k + m[2].el.Re*(m[2].fe +
     * m[2].fs/m[2].ge.N^2)/m[2].el.k */
    c->r2_m__2__motor_1 = p->m__2__el__k + p->m__2__el__Re * t_5 / p->m__2__el__k;

    /* khepera.bg:17: r2: factor of m[2].motor'': m[2].el.L*(m[2].fe +
     * m[2].fs/m[2].ge.N^2)/m[2].el.k + m[2].el.Re*(m[2].Je + m[2].Js/m[ ... */
    c->r2_m__2__motor_2 = t_7 + t_8;

    /* khepera.bg:17: r2: factor of m[2].motor''': m[2].el.L*(m[2].Je +
     * m[2].Js/m[2].ge.N^2)/m[2].el.k */
    c->r2_m__2__motor_3 = p->m__2__el__L * t_6 / p->m__2__el__k;

    /* khepera.bg:17: r2: factor of Fx[2]: m[2].R*m[2].el.Re/(m[2].el.k*m[2].ge.N) */
    c->r2_Fx__2 = p->m__2__R * p->m__2__el__Re / p->m__2__el__k / p->m__2__ge__N;

    /* khepera.bg:17: r2: factor of Fx[2]': m[2].R*m[2].el.L/(m[2].el.k*m[2].ge.N) */
    c->r2_Fx__2_1 = p->m__2__R * p->m__2__el__L / p->m__2__el__k / p->m__2__ge__N;

    /* khepera.bg:17: r2: factor of m[2].motor'' */
    c->r2_w2_m__2__motor = (-t_7 - t_8) * w;

    /* khepera.bg:17: r2: factor of m[2].motor''' */
    c->r2_w3_m__2__motor = p->m__2__el__L * t_6 * w * w / p->m__2__el__k;

    /* khepera.bg:17: r2: factor of Fx[2]' */
    c->r2_w1_Fx__2 = p->m__2__R * p->m__2__el__L * w / p->m__2__el__k / p->m__2__ge__N;

    /* khepera.bg:114: r3: factor of Us': 3.3e-10*R_L */
    c->r3_Us_1 = REAL(33.0) * p->R_L / REAL(100000000000.0);

    /* khepera.bg:114: r3: factor of Us'': 1.21e-20*R_L^2 + 1.65e-16 */
    c->r3_Us_2 = REAL(1.21e-20) * p->R_L * p->R_L + REAL(1.65e-16);

    /* khepera.bg:114: r3: factor of Us''': 1.21e-26*R_L */
    c->r3_Us_3 = REAL(1.21e-26) * p->R_L;
}

static bool parameters_are_finite(const khepera_built_parameters *p)
{
    return finite_number(p->R_L + p->m__1__Je + p->m__1__fe + p->m__1__Js + p->m__1__fs + p->m__1__R
            + p->m__1__el__L + p->m__1__el__Re + p->m__1__el__k + p->m__1__ge__N + p->m__2__Je
            + p->m__2__fe + p->m__2__Js + p->m__2__fs + p->m__2__R + p->m__2__el__L
            + p->m__2__el__Re + p->m__2__el__k + p->m__2__ge__N);
}

static bool coefficients_are_finite(const khepera_built_monitor *monitor)
{
    return finite_number(monitor->c.r1_m__1__motor_1 + monitor->c.r1_m__1__motor_2
            + monitor->c.r1_m__1__motor_3 + monitor->c.r1_Fx__1 + monitor->c.r1_Fx__1_1
            + monitor->c.m__1__motor_gain + monitor->c.a + monitor->c.r1_w2_m__1__motor
            + monitor->c.r1_w3_m__1__motor + monitor->c.r1_w1_Fx__1 + monitor->c.bend2
            + monitor->c.bend1 + monitor->c.bend3 + monitor->c.b + monitor->c.rest
            + monitor->c.r2_m__2__motor_1 + monitor->c.r2_m__2__motor_2
            + monitor->c.r2_m__2__motor_3 + monitor->c.r2_Fx__2 + monitor->c.r2_Fx__2_1
            + monitor->c.r2_w2_m__2__motor + monitor->c.r2_w3_m__2__motor + monitor->c.r2_w1_Fx__2
            + monitor->c.r3_Us_1 + monitor->c.r3_Us_2 + monitor->c.r3_Us_3);
}

/* Samples until `constants` time constants of the filter are over. */
static uint32_t samples(real constants, real sample_time, real bandwidth)
{
    const real wait = constants / (bandwidth * sample_time);
    const uint32_t whole = wait < REAL(4.0e9) ? (uint32_t)wait : UINT32_MAX - 1u;

    return (real)whole < wait ? whole + 1u : whole;
}

khepera_built_status khepera_built_configure(
    khepera_built_monitor *monitor,
    const khepera_built_parameters *parameters,
    khepera_built_real sample_time,
    khepera_built_real bandwidth,
    khepera_built_real time_unit)
{
    int k;

    for (k = 0; k < KHEPERA_BUILT_RESIDUALS; ++k) {
        monitor->settle[k] = UINT32_MAX;
    }
    khepera_built_reset(monitor);
    if (!parameters_are_finite(parameters)) {
        return KHEPERA_BUILT_BAD_PARAMETER;
    }
    if (!(sample_time >= REAL(0.000999999)) || !finite_number(sample_time)) {
        return KHEPERA_BUILT_BAD_SAMPLE_TIME;
    }
    if (!(bandwidth * sample_time >= SLOWEST && bandwidth * sample_time <= REAL(3.0))) {
        return KHEPERA_BUILT_BAD_BANDWIDTH;
    }
    if (!(time_unit > REAL(0.0)) || !finite_number(time_unit)) {
        return KHEPERA_BUILT_BAD_TIME_UNIT;
    }
    compute_coefficients(monitor, parameters, sample_time, bandwidth);
    if (!coefficients_are_finite(monitor)) {
        return KHEPERA_BUILT_BAD_COEFFICIENT;
    }
    monitor->settle[KHEPERA_BUILT_R1] = samples(REAL(13.062240779188071), sample_time, bandwidth);
    monitor->settle[KHEPERA_BUILT_R2] = samples(REAL(13.062240779188071), sample_time, bandwidth);
    monitor->settle[KHEPERA_BUILT_R3] = samples(REAL(6.907755278982138), sample_time, bandwidth);
    return KHEPERA_BUILT_OK;
}

void khepera_built_exact(
    const khepera_built_monitor *monitor,
    const khepera_built_derivatives *derivatives,
    khepera_built_real residuals[KHEPERA_BUILT_RESIDUALS])
{
    const khepera_built_coefficients *c = &monitor->c;
    const khepera_built_derivatives *d = derivatives;
    real *r = residuals;

    /* khepera.bg:17: r1 = U0[1] - m[1].el.k*D(m[1].motor) - m[1].el.Re*m[1].el.k.e2/m[1].el.k -
     * m[1].el.L*D(m[1].el.k.e2)/m[1].el.k
     * where m[1].el.k.e2 = m[1].fe*D(m[1].motor) + m[1].Je*D(m[1].motor, 2) + (Fx[1]*m[1].R +
     * m[1].fs*D(m[1].motor)/m[1].ge.N + m[1].Js*D(m[1].motor, 2)/m[1].ge.N)/m[1].ge.N */
    r[KHEPERA_BUILT_R1] = d->U0__1 - c->r1_m__1__motor_1 * d->m__1__motor[1]
        - c->r1_m__1__motor_2 * d->m__1__motor[2] - c->r1_m__1__motor_3 * d->m__1__motor[3]
        - c->r1_Fx__1 * d->Fx__1[0] - c->r1_Fx__1_1 * d->Fx__1[1];

    /* khepera.bg:17: r2 = U0[2] - m[2].el.k*D(m[2].motor) - m[2].el.Re*m[2].el.k.e2/m[2].el.k -
     * m[2].el.L*D(m[2].el.k.e2)/m[2].el.k
     * where m[2].el.k.e2 = m[2].fe*D(m[2].motor) + m[2].Je*D(m[2].motor, 2) + (Fx[2]*m[2].R +
     * m[2].fs*D(m[2].motor)/m[2].ge.N + m[2].Js*D(m[2].motor, 2)/m[2].ge.N)/m[2].ge.N */
    r[KHEPERA_BUILT_R2] = d->U0__2 - c->r2_m__2__motor_1 * d->m__2__motor[1]
        - c->r2_m__2__motor_2 * d->m__2__motor[2] - c->r2_m__2__motor_3 * d->m__2__motor[3]
        - c->r2_Fx__2 * d->Fx__2[0] - c->r2_Fx__2_1 * d->Fx__2[1];

    /* khepera.bg:114: r3 = Uin - line.cell[1].mid.e - R_L*line.cell[1].left.f/2 -
     * D(line.cell[1].left.f)/4000000
     * where line.cell[1].left.f = 2.2e-10*D(Us) + 2.2e-10*D(line.cell[1].mid.e)
     * line.cell[1].mid.e = Us + 1.1e-10*R_L*D(Us) + 5.5e-17*D(Us, 2) */
    r[KHEPERA_BUILT_R3] = d->Uin - d->Us[0] - c->r3_Us_1 * d->Us[1] - c->r3_Us_2 * d->Us[2]
        - c->r3_Us_3 * d->Us[3] - REAL(3.025e-33) * d->Us[4];
}

/* r1 on its first sample: the filter as if it had always been so. */
static void start_r1(
    khepera_built_monitor *monitor, const khepera_built_samples *s, real *r)
{
    const khepera_built_coefficients *c = &monitor->c;
    khepera_built_memory *x = &monitor->x;

    count_from(&monitor->e.m__1__motor, s->m__1__motor);

    /* khepera.bg:17: filtered speed of m[1].motor, at rest */
    const real r1_m__1__motor_speed_2 = REAL(0.0);

    /* khepera.bg:17: filtered speed of m[1].motor */
    x->r1_m__1__motor_speed = r1_m__1__motor_speed_2;

    /* khepera.bg:17: r1: encoders, order 1 */
    const real r1_n1 = -c->r1_m__1__motor_1 * r1_m__1__motor_speed_2;

    /* khepera.bg:17: r1: error of order 1 */
    const real r1_e1 = c->bend2 * r1_n1;

    /* khepera.bg:17: r1: encoders, order 2 */
    const real r1_n2 = c->r1_w2_m__1__motor * r1_m__1__motor_speed_2;

    /* khepera.bg:17: r1: error of order 2 */
    const real r1_e2 = c->bend1 * r1_n2;

    /* khepera.bg:17: r1: encoders, order 3 */
    const real r1_n3 = -c->r1_w3_m__1__motor * r1_m__1__motor_speed_2;

    /* khepera.bg:17: r1: terms of order 0 */
    const real r1_g0 = s->U0__1 - c->r1_Fx__1 * s->Fx__1;

    /* khepera.bg:17: r1: terms of order 1 */
    const real r1_g1 = -c->r1_w1_Fx__1 * s->Fx__1;

    /* khepera.bg:17: r1: degree 1 */
    const real r1_d1 = r1_g1 + r1_n1 + r1_n2;

    /* khepera.bg:17: r1: error of order 0 */
    const real r1_e0 = c->bend3 * r1_g0;

    /* khepera.bg:17: r1: degree 2 */
    const real r1_d2 = r1_n2 + r1_n3 - r1_e1 - r1_e0;

    /* khepera.bg:17: r1: error of order 1 */
    const real r1_e1_2 = c->bend2 * r1_g1;

    /* khepera.bg:17: r1: degree 3 */
    const real r1_d3 = r1_n3 - r1_e1 - r1_e2 - r1_e1_2;

    /* khepera.bg:17: r1: input of stage 4 */
    const real r1_u4 = r1_g0 + r1_n1 + r1_d2 - r1_d1 - r1_d3 - r1_e2;

    /* khepera.bg:17: r1: stage 4, at rest */
    const real r1_y4 = r1_u4;

    /* khepera.bg:17: r1: stage 4: memory */
    x->r1_s4 = c->rest * r1_u4;

    /* khepera.bg:17: r1: input of stage 3 */
    const real r1_u3 = r1_y4 + r1_d1 + REAL(3.0) * r1_d3 + REAL(4.0) * r1_e2 - REAL(2.0) * r1_d2;

    /* khepera.bg:17: r1: stage 3, at rest */
    const real r1_y3 = r1_u3;

    /* khepera.bg:17: r1: stage 3: memory */
    x->r1_s3 = c->rest * r1_u3;

    /* khepera.bg:17: r1: input of stage 2 */
    const real r1_u2 = r1_y3 + r1_d2 - REAL(3.0) * r1_d3 - REAL(6.0) * r1_e2;

    /* khepera.bg:17: r1: stage 2, at rest */
    const real r1_y2 = r1_u2;

    /* khepera.bg:17: r1: stage 2: memory */
    x->r1_s2 = c->rest * r1_u2;

    /* khepera.bg:17: r1: input of stage 1 */
    const real r1_u1 = r1_y2 + r1_d3 + REAL(4.0) * r1_e2;

    /* khepera.bg:17: r1: stage 1, at rest */
    const real r1_y1 = r1_u1;

    /* khepera.bg:17: r1: stage 1: memory */
    x->r1_s1 = c->rest * r1_u1;

    /* khepera.bg:17: r1 = U0[1] - m[1].el.k*D(m[1].motor) - m[1].el.Re*m[1].el.k.e2/m[1].el.k -
     * m[1].el.L*D(m[1].el.k.e2)/m[1].el.k
     * where m[1].el.k.e2 = m[1].fe*D(m[1].motor) + m[1].Je*D(m[1].motor, 2) + (Fx[1]*m[1].R +
     * m[1].fs*D(m[1].motor)/m[1].ge.N + m[1].Js*D(m[1].motor, 2)/m[1].ge.N)/m[1].ge.N */
    r[KHEPERA_BUILT_R1] = r1_y1 - r1_e2;
}

/* r1 on every further sample. */
static void next_r1(
    khepera_built_monitor *monitor, const khepera_built_samples *s, real *r)
{
    const khepera_built_coefficients *c = &monitor->c;
    khepera_built_memory *x = &monitor->x;
    const khepera_built_encoders *e = &monitor->e;

    count_on(&monitor->e.m__1__motor, s->m__1__motor);

    /* khepera.bg:17: filtered speed of m[1].motor */
    const real r1_m__1__motor_speed_2 = c->a * x->r1_m__1__motor_speed
        + c->m__1__motor_gain * (real)e->m__1__motor.increment;
    x->r1_m__1__motor_speed = r1_m__1__motor_speed_2;

    /* khepera.bg:17: r1: encoders, order 1 */
    const real r1_n1 = -c->r1_m__1__motor_1 * r1_m__1__motor_speed_2;

    /* khepera.bg:17: r1: error of order 1 */
    const real r1_e1 = c->bend2 * r1_n1;

    /* khepera.bg:17: r1: encoders, order 2 */
    const real r1_n2 = c->r1_w2_m__1__motor * r1_m__1__motor_speed_2;

    /* khepera.bg:17: r1: error of order 2 */
    const real r1_e2 = c->bend1 * r1_n2;

    /* khepera.bg:17: r1: encoders, order 3 */
    const real r1_n3 = -c->r1_w3_m__1__motor * r1_m__1__motor_speed_2;

    /* khepera.bg:17: r1: terms of order 0 */
    const real r1_g0 = s->U0__1 - c->r1_Fx__1 * s->Fx__1;

    /* khepera.bg:17: r1: terms of order 1 */
    const real r1_g1 = -c->r1_w1_Fx__1 * s->Fx__1;

    /* khepera.bg:17: r1: degree 1 */
    const real r1_d1 = r1_g1 + r1_n1 + r1_n2;

    /* khepera.bg:17: r1: error of order 0 */
    const real r1_e0 = c->bend3 * r1_g0;

    /* khepera.bg:17: r1: degree 2 */
    const real r1_d2 = r1_n2 + r1_n3 - r1_e1 - r1_e0;

    /* khepera.bg:17: r1: error of order 1 */
    const real r1_e1_2 = c->bend2 * r1_g1;

    /* khepera.bg:17: r1: degree 3 */
    const real r1_d3 = r1_n3 - r1_e1 - r1_e2 - r1_e1_2;

    /* khepera.bg:17: r1: input of stage 4 */
    const real r1_u4 = r1_g0 + r1_n1 + r1_d2 - r1_d1 - r1_d3 - r1_e2;

    /* khepera.bg:17: r1: stage 4 */
    const real r1_y4 = x->r1_s4 + c->b * r1_u4;

    /* khepera.bg:17: r1: stage 4: memory */
    x->r1_s4 = c->a * r1_y4 + c->b * r1_u4;

    /* khepera.bg:17: r1: input of stage 3 */
    const real r1_u3 = r1_y4 + r1_d1 + REAL(3.0) * r1_d3 + REAL(4.0) * r1_e2 - REAL(2.0) * r1_d2;

    /* khepera.bg:17: r1: stage 3 */
    const real r1_y3 = x->r1_s3 + c->b * r1_u3;

    /* khepera.bg:17: r1: stage 3: memory */
    x->r1_s3 = c->a * r1_y3 + c->b * r1_u3;

    /* khepera.bg:17: r1: input of stage 2 */
    const real r1_u2 = r1_y3 + r1_d2 - REAL(3.0) * r1_d3 - REAL(6.0) * r1_e2;

    /* khepera.bg:17: r1: stage 2 */
    const real r1_y2 = x->r1_s2 + c->b * r1_u2;

    /* khepera.bg:17: r1: stage 2: memory */
    x->r1_s2 = c->a * r1_y2 + c->b * r1_u2;

    /* khepera.bg:17: r1: input of stage 1 */
    const real r1_u1 = r1_y2 + r1_d3 + REAL(4.0) * r1_e2;

    /* khepera.bg:17: r1: stage 1 */
    const real r1_y1 = x->r1_s1 + c->b * r1_u1;

    /* khepera.bg:17: r1: stage 1: memory */
    x->r1_s1 = c->a * r1_y1 + c->b * r1_u1;

    /* khepera.bg:17: r1 = U0[1] - m[1].el.k*D(m[1].motor) - m[1].el.Re*m[1].el.k.e2/m[1].el.k -
     * m[1].el.L*D(m[1].el.k.e2)/m[1].el.k
     * where m[1].el.k.e2 = m[1].fe*D(m[1].motor) + m[1].Je*D(m[1].motor, 2) + (Fx[1]*m[1].R +
     * m[1].fs*D(m[1].motor)/m[1].ge.N + m[1].Js*D(m[1].motor, 2)/m[1].ge.N)/m[1].ge.N */
    r[KHEPERA_BUILT_R1] = r1_y1 - r1_e2;
}

/* One sample for r1; a number that is not finite makes the next sample the first. */
static void run_r1(
    khepera_built_monitor *monitor, const khepera_built_samples *s, khepera_built_residuals *residuals)
{
    real *r = residuals->value;
    uint32_t age = monitor->age[0];

    if (age == 0u) {
        start_r1(monitor, s, r);
    } else {
        next_r1(monitor, s, r);
    }
    /* a sum is finite only if all its terms are */
    if (finite_number(s->Fx__1 + s->U0__1 + r[KHEPERA_BUILT_R1])) {
        age += age < UINT32_MAX ? 1u : 0u;
    } else {
        age = 0u;
        r[KHEPERA_BUILT_R1] = REAL(0.0);
    }
    monitor->age[0] = age;
    residuals->valid[KHEPERA_BUILT_R1] = age > monitor->settle[KHEPERA_BUILT_R1];
}

/* r2 on its first sample: the filter as if it had always been so. */
static void start_r2(
    khepera_built_monitor *monitor, const khepera_built_samples *s, real *r)
{
    const khepera_built_coefficients *c = &monitor->c;
    khepera_built_memory *x = &monitor->x;

    count_from(&monitor->e.m__2__motor, s->m__2__motor);

    /* khepera.bg:17: filtered speed of m[2].motor, at rest */
    const real r2_m__2__motor_speed_2 = REAL(0.0);

    /* khepera.bg:17: filtered speed of m[2].motor */
    x->r2_m__2__motor_speed = r2_m__2__motor_speed_2;

    /* khepera.bg:17: r2: encoders, order 1 */
    const real r2_n1 = -c->r2_m__2__motor_1 * r2_m__2__motor_speed_2;

    /* khepera.bg:17: r2: error of order 1 */
    const real r2_e1 = c->bend2 * r2_n1;

    /* khepera.bg:17: r2: encoders, order 2 */
    const real r2_n2 = c->r2_w2_m__2__motor * r2_m__2__motor_speed_2;

    /* khepera.bg:17: r2: error of order 2 */
    const real r2_e2 = c->bend1 * r2_n2;

    /* khepera.bg:17: r2: encoders, order 3 */
    const real r2_n3 = -c->r2_w3_m__2__motor * r2_m__2__motor_speed_2;

    /* khepera.bg:17: r2: terms of order 0 */
    const real r2_g0 = s->U0__2 - c->r2_Fx__2 * s->Fx__2;

    /* khepera.bg:17: r2: terms of order 1 */
    const real r2_g1 = -c->r2_w1_Fx__2 * s->Fx__2;

    /* khepera.bg:17: r2: degree 1 */
    const real r2_d1 = r2_g1 + r2_n1 + r2_n2;

    /* khepera.bg:17: r2: error of order 0 */
    const real r2_e0 = c->bend3 * r2_g0;

    /* khepera.bg:17: r2: degree 2 */
    const real r2_d2 = r2_n2 + r2_n3 - r2_e1 - r2_e0;

    /* khepera.bg:17: r2: error of order 1 */
    const real r2_e1_2 = c->bend2 * r2_g1;

    /* khepera.bg:17: r2: degree 3 */
    const real r2_d3 = r2_n3 - r2_e1 - r2_e2 - r2_e1_2;

    /* khepera.bg:17: r2: input of stage 4 */
    const real r2_u4 = r2_g0 + r2_n1 + r2_d2 - r2_d1 - r2_d3 - r2_e2;

    /* khepera.bg:17: r2: stage 4, at rest */
    const real r2_y4 = r2_u4;

    /* khepera.bg:17: r2: stage 4: memory */
    x->r2_s4 = c->rest * r2_u4;

    /* khepera.bg:17: r2: input of stage 3 */
    const real r2_u3 = r2_y4 + r2_d1 + REAL(3.0) * r2_d3 + REAL(4.0) * r2_e2 - REAL(2.0) * r2_d2;

    /* khepera.bg:17: r2: stage 3, at rest */
    const real r2_y3 = r2_u3;

    /* khepera.bg:17: r2: stage 3: memory */
    x->r2_s3 = c->rest * r2_u3;

    /* khepera.bg:17: r2: input of stage 2 */
    const real r2_u2 = r2_y3 + r2_d2 - REAL(3.0) * r2_d3 - REAL(6.0) * r2_e2;

    /* khepera.bg:17: r2: stage 2, at rest */
    const real r2_y2 = r2_u2;

    /* khepera.bg:17: r2: stage 2: memory */
    x->r2_s2 = c->rest * r2_u2;

    /* khepera.bg:17: r2: input of stage 1 */
    const real r2_u1 = r2_y2 + r2_d3 + REAL(4.0) * r2_e2;

    /* khepera.bg:17: r2: stage 1, at rest */
    const real r2_y1 = r2_u1;

    /* khepera.bg:17: r2: stage 1: memory */
    x->r2_s1 = c->rest * r2_u1;

    /* khepera.bg:17: r2 = U0[2] - m[2].el.k*D(m[2].motor) - m[2].el.Re*m[2].el.k.e2/m[2].el.k -
     * m[2].el.L*D(m[2].el.k.e2)/m[2].el.k
     * where m[2].el.k.e2 = m[2].fe*D(m[2].motor) + m[2].Je*D(m[2].motor, 2) + (Fx[2]*m[2].R +
     * m[2].fs*D(m[2].motor)/m[2].ge.N + m[2].Js*D(m[2].motor, 2)/m[2].ge.N)/m[2].ge.N */
    r[KHEPERA_BUILT_R2] = r2_y1 - r2_e2;
}

/* r2 on every further sample. */
static void next_r2(
    khepera_built_monitor *monitor, const khepera_built_samples *s, real *r)
{
    const khepera_built_coefficients *c = &monitor->c;
    khepera_built_memory *x = &monitor->x;
    const khepera_built_encoders *e = &monitor->e;

    count_on(&monitor->e.m__2__motor, s->m__2__motor);

    /* khepera.bg:17: filtered speed of m[2].motor */
    const real r2_m__2__motor_speed_2 = c->a * x->r2_m__2__motor_speed
        + c->m__1__motor_gain * (real)e->m__2__motor.increment;
    x->r2_m__2__motor_speed = r2_m__2__motor_speed_2;

    /* khepera.bg:17: r2: encoders, order 1 */
    const real r2_n1 = -c->r2_m__2__motor_1 * r2_m__2__motor_speed_2;

    /* khepera.bg:17: r2: error of order 1 */
    const real r2_e1 = c->bend2 * r2_n1;

    /* khepera.bg:17: r2: encoders, order 2 */
    const real r2_n2 = c->r2_w2_m__2__motor * r2_m__2__motor_speed_2;

    /* khepera.bg:17: r2: error of order 2 */
    const real r2_e2 = c->bend1 * r2_n2;

    /* khepera.bg:17: r2: encoders, order 3 */
    const real r2_n3 = -c->r2_w3_m__2__motor * r2_m__2__motor_speed_2;

    /* khepera.bg:17: r2: terms of order 0 */
    const real r2_g0 = s->U0__2 - c->r2_Fx__2 * s->Fx__2;

    /* khepera.bg:17: r2: terms of order 1 */
    const real r2_g1 = -c->r2_w1_Fx__2 * s->Fx__2;

    /* khepera.bg:17: r2: degree 1 */
    const real r2_d1 = r2_g1 + r2_n1 + r2_n2;

    /* khepera.bg:17: r2: error of order 0 */
    const real r2_e0 = c->bend3 * r2_g0;

    /* khepera.bg:17: r2: degree 2 */
    const real r2_d2 = r2_n2 + r2_n3 - r2_e1 - r2_e0;

    /* khepera.bg:17: r2: error of order 1 */
    const real r2_e1_2 = c->bend2 * r2_g1;

    /* khepera.bg:17: r2: degree 3 */
    const real r2_d3 = r2_n3 - r2_e1 - r2_e2 - r2_e1_2;

    /* khepera.bg:17: r2: input of stage 4 */
    const real r2_u4 = r2_g0 + r2_n1 + r2_d2 - r2_d1 - r2_d3 - r2_e2;

    /* khepera.bg:17: r2: stage 4 */
    const real r2_y4 = x->r2_s4 + c->b * r2_u4;

    /* khepera.bg:17: r2: stage 4: memory */
    x->r2_s4 = c->a * r2_y4 + c->b * r2_u4;

    /* khepera.bg:17: r2: input of stage 3 */
    const real r2_u3 = r2_y4 + r2_d1 + REAL(3.0) * r2_d3 + REAL(4.0) * r2_e2 - REAL(2.0) * r2_d2;

    /* khepera.bg:17: r2: stage 3 */
    const real r2_y3 = x->r2_s3 + c->b * r2_u3;

    /* khepera.bg:17: r2: stage 3: memory */
    x->r2_s3 = c->a * r2_y3 + c->b * r2_u3;

    /* khepera.bg:17: r2: input of stage 2 */
    const real r2_u2 = r2_y3 + r2_d2 - REAL(3.0) * r2_d3 - REAL(6.0) * r2_e2;

    /* khepera.bg:17: r2: stage 2 */
    const real r2_y2 = x->r2_s2 + c->b * r2_u2;

    /* khepera.bg:17: r2: stage 2: memory */
    x->r2_s2 = c->a * r2_y2 + c->b * r2_u2;

    /* khepera.bg:17: r2: input of stage 1 */
    const real r2_u1 = r2_y2 + r2_d3 + REAL(4.0) * r2_e2;

    /* khepera.bg:17: r2: stage 1 */
    const real r2_y1 = x->r2_s1 + c->b * r2_u1;

    /* khepera.bg:17: r2: stage 1: memory */
    x->r2_s1 = c->a * r2_y1 + c->b * r2_u1;

    /* khepera.bg:17: r2 = U0[2] - m[2].el.k*D(m[2].motor) - m[2].el.Re*m[2].el.k.e2/m[2].el.k -
     * m[2].el.L*D(m[2].el.k.e2)/m[2].el.k
     * where m[2].el.k.e2 = m[2].fe*D(m[2].motor) + m[2].Je*D(m[2].motor, 2) + (Fx[2]*m[2].R +
     * m[2].fs*D(m[2].motor)/m[2].ge.N + m[2].Js*D(m[2].motor, 2)/m[2].ge.N)/m[2].ge.N */
    r[KHEPERA_BUILT_R2] = r2_y1 - r2_e2;
}

/* One sample for r2; a number that is not finite makes the next sample the first. */
static void run_r2(
    khepera_built_monitor *monitor, const khepera_built_samples *s, khepera_built_residuals *residuals)
{
    real *r = residuals->value;
    uint32_t age = monitor->age[1];

    if (age == 0u) {
        start_r2(monitor, s, r);
    } else {
        next_r2(monitor, s, r);
    }
    /* a sum is finite only if all its terms are */
    if (finite_number(s->Fx__2 + s->U0__2 + r[KHEPERA_BUILT_R2])) {
        age += age < UINT32_MAX ? 1u : 0u;
    } else {
        age = 0u;
        r[KHEPERA_BUILT_R2] = REAL(0.0);
    }
    monitor->age[1] = age;
    residuals->valid[KHEPERA_BUILT_R2] = age > monitor->settle[KHEPERA_BUILT_R2];
}

/* r3 on its first sample: the filter as if it had always been so. */
static void start_r3(
    khepera_built_monitor *monitor, const khepera_built_samples *s, real *r)
{
    const khepera_built_coefficients *c = &monitor->c;
    khepera_built_memory *x = &monitor->x;

    /* khepera.bg:114: r3: input of stage 1 */
    const real r3_u1 = s->Uin - s->Us;

    /* khepera.bg:114: r3: stage 1, at rest */
    const real r3_y1 = r3_u1;

    /* khepera.bg:114: r3: stage 1: memory */
    x->r3_s1 = c->rest * r3_u1;

    /* khepera.bg:114: r3 = Uin - line.cell[1].mid.e - R_L*line.cell[1].left.f/2 -
     * D(line.cell[1].left.f)/4000000
     * where line.cell[1].left.f = 2.2e-10*D(Us) + 2.2e-10*D(line.cell[1].mid.e)
     * line.cell[1].mid.e = Us + 1.1e-10*R_L*D(Us) + 5.5e-17*D(Us, 2) */
    r[KHEPERA_BUILT_R3] = r3_y1;
}

/* r3 on every further sample. */
static void next_r3(
    khepera_built_monitor *monitor, const khepera_built_samples *s, real *r)
{
    const khepera_built_coefficients *c = &monitor->c;
    khepera_built_memory *x = &monitor->x;

    /* khepera.bg:114: r3: input of stage 1 */
    const real r3_u1 = s->Uin - s->Us;

    /* khepera.bg:114: r3: stage 1 */
    const real r3_y1 = x->r3_s1 + c->b * r3_u1;

    /* khepera.bg:114: r3: stage 1: memory */
    x->r3_s1 = c->a * r3_y1 + c->b * r3_u1;

    /* khepera.bg:114: r3 = Uin - line.cell[1].mid.e - R_L*line.cell[1].left.f/2 -
     * D(line.cell[1].left.f)/4000000
     * where line.cell[1].left.f = 2.2e-10*D(Us) + 2.2e-10*D(line.cell[1].mid.e)
     * line.cell[1].mid.e = Us + 1.1e-10*R_L*D(Us) + 5.5e-17*D(Us, 2) */
    r[KHEPERA_BUILT_R3] = r3_y1;
}

/* One sample for r3; a number that is not finite makes the next sample the first. */
static void run_r3(
    khepera_built_monitor *monitor, const khepera_built_samples *s, khepera_built_residuals *residuals)
{
    real *r = residuals->value;
    uint32_t age = monitor->age[2];

    if (age == 0u) {
        start_r3(monitor, s, r);
    } else {
        next_r3(monitor, s, r);
    }
    /* a sum is finite only if all its terms are */
    if (finite_number(s->Uin + s->Us + r[KHEPERA_BUILT_R3])) {
        age += age < UINT32_MAX ? 1u : 0u;
    } else {
        age = 0u;
        r[KHEPERA_BUILT_R3] = REAL(0.0);
    }
    monitor->age[2] = age;
    residuals->valid[KHEPERA_BUILT_R3] = age > monitor->settle[KHEPERA_BUILT_R3];
}

void khepera_built_reset(khepera_built_monitor *monitor)
{
    int k;

    for (k = 0; k < 3; ++k) {
        monitor->age[k] = 0u;
    }
}

void khepera_built_step(
    khepera_built_monitor *monitor,
    const khepera_built_samples *samples,
    khepera_built_residuals *residuals)
{
    run_r1(monitor, samples, residuals);
    run_r2(monitor, samples, residuals);
    run_r3(monitor, samples, residuals);
}

const char khepera_built_fault_name[KHEPERA_BUILT_FAULTS][11] = {
    "m[1].Je", "m[1].fe", "m[1].Js", "m[1].fs", "m[1].R", "m[1].el.L", "m[1].el.Re", "m[1].el.k",
    "m[1].ge.N", "Fx[1]", "U0[1]", "m[1].motor", "m[2].Je", "m[2].fe", "m[2].Js", "m[2].fs",
    "m[2].R", "m[2].el.L", "m[2].el.Re", "m[2].el.k", "m[2].ge.N", "Fx[2]", "U0[2]", "m[2].motor",
    "R_L", "Uin", "Us",
};

const uint16_t khepera_built_fault_class[KHEPERA_BUILT_FAULTS] = {
    0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 1u, 1u, 1u, 1u, 1u, 1u, 1u, 1u, 1u, 1u, 1u, 1u,
    2u, 3u, 3u,
};

const char khepera_built_residual_name[KHEPERA_BUILT_RESIDUALS][3] = {
    "r1", "r2", "r3",
};

/* Signatures: 1 where a residual may be moved by the faults of a class, 3 where it is for sure. */
static const uint8_t signature[KHEPERA_BUILT_CLASSES][KHEPERA_BUILT_RESIDUALS] = {
    {3u, 0u, 0u},
    {0u, 3u, 0u},
    {0u, 0u, 1u},
    {0u, 0u, 3u},
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
    khepera_built_diagnosis *d, const khepera_built_limit *limit, int k, real off, real out, real bound)
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

static bool sums_are_zero(const khepera_built_diagnosis *d, int k)
{
    const real sum = d->above[k] + d->below[k] + d->louder[k];

    return !(sum > REAL(0.0));
}

static void forget_sums(khepera_built_diagnosis *d, int k)
{
    d->above[k] = REAL(0.0);
    d->below[k] = REAL(0.0);
    d->louder[k] = REAL(0.0);
    d->streak[k] = 0u;
}

/* Residual k in one sample; whether it goes into alarm. */
static bool watch(
    khepera_built_diagnosis *d, const khepera_built_limit *limit, int k, real value, real bound, bool row)
{
    const real off = value - limit->mean;
    const real out = (off < REAL(0.0) ? -off : off) - bound;
    bool high = false;

    if (row) {
        high = add_row(d, limit, k, off, out, bound);
    }
    if (d->state[k] == KHEPERA_BUILT_ALARM) {
        d->since[k] += d->since[k] < UINT32_MAX ? 1u : 0u;
        if (!(out < RELEASE * limit->level) || !sums_are_zero(d, k)) {
            d->quiet = 0u;
        }
        return false;
    }
    d->state[k] = KHEPERA_BUILT_HEALTHY;
    d->streak[k] = out > limit->level ? d->streak[k] + 1u : 0u;
    if (d->streak[k] < d->least && !high) {
        return false;
    }
    d->state[k] = KHEPERA_BUILT_ALARM;
    d->since[k] = 0u;
    return true;
}

/* What is left of a class of faults. */
static khepera_built_candidate left_of(const khepera_built_diagnosis *d, const uint8_t *own)
{
    khepera_built_candidate found = KHEPERA_BUILT_LIKELY;
    int k;

    for (k = 0; k < KHEPERA_BUILT_RESIDUALS; ++k) {
        if (d->state[k] == KHEPERA_BUILT_ALARM && own[k] == 0u) {
            return KHEPERA_BUILT_RULED_OUT;
        }
        if (d->state[k] == KHEPERA_BUILT_HEALTHY && own[k] == 3u) {
            found = KHEPERA_BUILT_SMALL;
        }
    }
    return found;
}

/* Which classes of faults the residuals leave, and the one if it is one. */
static void judge(khepera_built_diagnosis *d)
{
    int likely = 0;
    int c;

    d->fault_class = KHEPERA_BUILT_UNKNOWN;
    for (c = 0; c < KHEPERA_BUILT_CLASSES; ++c) {
        const khepera_built_candidate left = left_of(d, signature[c]);

        d->candidate[c] = (uint8_t)left;
        if (left == KHEPERA_BUILT_LIKELY) {
            d->fault_class = (int16_t)c;
            ++likely;
        }
    }
    if (likely != 1 || d->settled < 2u * d->row) {
        d->fault_class = KHEPERA_BUILT_UNKNOWN;
    }
}

khepera_built_limit khepera_built_limit_of(khepera_built_real level)
{
    khepera_built_limit limit;

    limit.mean = REAL(0.0);
    limit.level = level;
    limit.unit = REAL(0.0);
    limit.loud = REAL(0.0);
    limit.drift = REAL(0.5);
    limit.height = NEVER;
    limit.bound = REAL(0.0);
    return limit;
}

void khepera_built_clear(khepera_built_diagnosis *diagnosis)
{
    int k;

    for (k = 0; k < KHEPERA_BUILT_RESIDUALS; ++k) {
        if (diagnosis->state[k] == KHEPERA_BUILT_ALARM) {
            diagnosis->state[k] = KHEPERA_BUILT_HEALTHY;
        }
        diagnosis->since[k] = 0u;
        forget_sums(diagnosis, k);
    }
    for (k = 0; k < KHEPERA_BUILT_CLASSES; ++k) {
        diagnosis->candidate[k] = KHEPERA_BUILT_RULED_OUT;
    }
    diagnosis->fault_class = KHEPERA_BUILT_UNKNOWN;
    diagnosis->quiet = 0u;
    diagnosis->settled = 0u;
}

void khepera_built_diagnosis_reset(khepera_built_diagnosis *diagnosis)
{
    int k;

    diagnosis->row = KHEPERA_BUILT_ROW;
    diagnosis->least = 15u;
    diagnosis->hold = 10u * KHEPERA_BUILT_ROW;
    diagnosis->latch = false;
    diagnosis->tick = 0u;
    for (k = 0; k < KHEPERA_BUILT_RESIDUALS; ++k) {
        diagnosis->state[k] = KHEPERA_BUILT_BLIND;
    }
    khepera_built_clear(diagnosis);
}

bool khepera_built_diagnose(
    khepera_built_diagnosis *diagnosis,
    const khepera_built_limit *limits,
    const khepera_built_real *bounds,
    const khepera_built_residuals *residuals)
{
    khepera_built_diagnosis *d = diagnosis;
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
    for (k = 0; k < KHEPERA_BUILT_RESIDUALS; ++k) {
        if (residuals->valid[k]) {
            const real bound = bounds ? bounds[k] : limits[k].bound;

            fresh = watch(d, &limits[k], k, residuals->value[k], bound, row) || fresh;
        } else {
            forget_sums(d, k);
            if (d->state[k] == KHEPERA_BUILT_ALARM) {
                d->quiet = 0u; /* nobody knows that it is over */
            } else {
                d->state[k] = KHEPERA_BUILT_BLIND;
            }
        }
        alarm = alarm || d->state[k] == KHEPERA_BUILT_ALARM;
    }
    if (fresh) {
        d->quiet = 0u;
        d->settled = 0u;
    }
    if (alarm && !d->latch && d->quiet >= d->hold) {
        khepera_built_clear(d);
        return false;
    }
    if (fresh || (alarm && row)) {
        judge(d);
    }
    return alarm;
}
