/* khepera_encoders_residuals.c: the residuals of KheperaEncoders; generated, see the header. */
#include "khepera_encoders_residuals.h"

#include <math.h>

#if defined __FINITE_MATH_ONLY__ && __FINITE_MATH_ONLY__
#error "this code tells numbers from NaN: compile it without -ffinite-math-only (-ffast-math)"
#endif

typedef khepera_encoders_real real;

#define REAL(x) KHEPERA_ENCODERS_CONSTANT(x)
#if defined KHEPERA_ENCODERS_FLOAT && !defined KHEPERA_ENCODERS_REAL
#define SLOWEST REAL(0.0001)
#define MATH(name) name##f
#else
#define SLOWEST REAL(1.0e-09)
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

/* Takes a count; the difference to the one before is right also when the counter runs over. */
static void count_on(khepera_encoders_encoder *encoder, int32_t count)
{
    const uint32_t step = (uint32_t)count - encoder->count;

    encoder->increment = step <= INT32_MAX ? (int32_t)step : -(int32_t)(UINT32_MAX - step) - 1;
    encoder->total += encoder->increment;
    encoder->count = (uint32_t)count;
}

/* Takes the first count. */
static void count_from(khepera_encoders_encoder *encoder, int32_t count)
{
    encoder->count = (uint32_t)count;
    encoder->increment = 0;
    encoder->total = 0;
}

uint32_t khepera_encoders_abi(void)
{
    return KHEPERA_ENCODERS_ABI;
}

const char *khepera_encoders_digest(void)
{
    return KHEPERA_ENCODERS_DIGEST;
}

void khepera_encoders_nominal(khepera_encoders_parameters *parameters)
{
    parameters->R_L = REAL(0.85);             /* Ohm */
    parameters->m__1__Je = REAL(1.4e-08);     /* kg.m^2 */
    parameters->m__1__fe = REAL(1.0e-07);     /* N.m.s/rad */
    parameters->m__1__K = REAL(0.1);          /* N.m/rad */
    parameters->m__1__tau0 = REAL(0.01);      /* rad */
    parameters->m__1__A = -REAL(4.0);         /* 1 */
    parameters->m__1__Js = REAL(1.0e-05);     /* kg.m^2 */
    parameters->m__1__fs = REAL(0.0003);      /* N.m.s/rad */
    parameters->m__1__R = REAL(0.008);        /* m */
    parameters->m__1__el__L = REAL(0.0003);   /* H */
    parameters->m__1__el__Re = REAL(17.6);    /* Ohm */
    parameters->m__1__el__k = REAL(0.00351);  /* N.m/A */
    parameters->m__1__ge__N = REAL(25.0);     /* 1 */
    parameters->m__2__Je = REAL(1.4e-08);     /* kg.m^2 */
    parameters->m__2__fe = REAL(1.0e-07);     /* N.m.s/rad */
    parameters->m__2__K = REAL(0.1);          /* N.m/rad */
    parameters->m__2__tau0 = REAL(0.01);      /* rad */
    parameters->m__2__A = -REAL(4.0);         /* 1 */
    parameters->m__2__Js = REAL(1.0e-05);     /* kg.m^2 */
    parameters->m__2__fs = REAL(0.0003);      /* N.m.s/rad */
    parameters->m__2__R = REAL(0.008);        /* m */
    parameters->m__2__el__L = REAL(0.0003);   /* H */
    parameters->m__2__el__Re = REAL(17.6);    /* Ohm */
    parameters->m__2__el__k = REAL(0.00351);  /* N.m/A */
    parameters->m__2__ge__N = REAL(25.0);     /* 1 */
}

/* The coefficients of exact and of the filter, from the parameters. */
static void compute_coefficients(khepera_encoders_monitor *monitor,
        const khepera_encoders_parameters *p, real sample_time, real bandwidth)
{
    khepera_encoders_coefficients *c = &monitor->c;

    /* bandwidth*sample_time */
    const real x_ = bandwidth * sample_time;

    /* of a stage: what is left of its memory */
    const real pole = greatest(REAL(2.0) - x_, REAL(0.0)) / (x_ + REAL(2.0));

    /* w*sample_time, x or 2 */
    const real turn = REAL(2.0) * (REAL(1.0) - pole) / (pole + REAL(1.0));

    /* w of the filter 1/(1 + D/w) */
    const real w = turn / sample_time;

    /* khepera.bg:17: m[1].fe*m[1].el.L/m[1].el.k */
    const real t = p->m__1__fe * p->m__1__el__L / p->m__1__el__k;

    /* khepera.bg:17: m[1].fs*m[1].el.L/(m[1].el.k*m[1].ge.N) */
    const real t_2 = p->m__1__fs * p->m__1__el__L / p->m__1__el__k / p->m__1__ge__N;

    /* khepera.bg:17: m[1].Je*m[1].el.Re/m[1].el.k */
    const real t_3 = p->m__1__Je * p->m__1__el__Re / p->m__1__el__k;

    /* khepera.bg:17: m[1].Js*m[1].el.Re/(m[1].el.k*m[1].ge.N) */
    const real t_4 = p->m__1__Js * p->m__1__el__Re / p->m__1__el__k / p->m__1__ge__N;

    /* khepera.bg:17: m[2].fe*m[2].el.L/m[2].el.k */
    const real t_5 = p->m__2__fe * p->m__2__el__L / p->m__2__el__k;

    /* khepera.bg:17: m[2].fs*m[2].el.L/(m[2].el.k*m[2].ge.N) */
    const real t_6 = p->m__2__fs * p->m__2__el__L / p->m__2__el__k / p->m__2__ge__N;

    /* khepera.bg:17: m[2].Je*m[2].el.Re/m[2].el.k */
    const real t_7 = p->m__2__Je * p->m__2__el__Re / p->m__2__el__k;

    /* khepera.bg:17: m[2].Js*m[2].el.Re/(m[2].el.k*m[2].ge.N) */
    const real t_8 = p->m__2__Js * p->m__2__el__Re / p->m__2__el__k / p->m__2__ge__N;

    /* khepera.bg:114: R_L^2 */
    const real t_9 = p->R_L * p->R_L;

    /* 1 - pole */
    const real t_10 = REAL(1.0) - pole;

    /* 1 - (1 - pole)/2 */
    const real t_11 = REAL(1.0) - REAL(0.5) * t_10;

    /* turn^2 */
    const real t_12 = turn * turn;

    /* (1 - (1 - pole)/2)*w */
    const real t_13 = t_11 * w;

    /* khepera.bg:17: r1: factor of m[1].motor': m[1].el.k + m[1].fe*m[1].el.Re/m[1].el.k */
    c->r1_m__1__motor_1 = p->m__1__el__k + p->m__1__fe * p->m__1__el__Re / p->m__1__el__k;

    /* khepera.bg:17: r1: factor of m[1].motor'': m[1].fe*m[1].el.L/m[1].el.k +
     * m[1].Je*m[1].el.Re/m[1].el.k */
    c->r1_m__1__motor_2 = t + t_3;

    /* khepera.bg:17: r1: factor of m[1].motor''': m[1].Je*m[1].el.L/m[1].el.k */
    c->r1_m__1__motor_3 = p->m__1__Je * p->m__1__el__L / p->m__1__el__k;

    /* khepera.bg:17: r1: factor of Fx[1]: m[1].R*m[1].el.Re/(m[1].el.k*m[1].ge.N) */
    c->r1_Fx__1 = p->m__1__R * p->m__1__el__Re / p->m__1__el__k / p->m__1__ge__N;

    /* khepera.bg:17: r1: factor of Fx[1]': m[1].R*m[1].el.L/(m[1].el.k*m[1].ge.N) */
    c->r1_Fx__1_1 = p->m__1__R * p->m__1__el__L / p->m__1__el__k / p->m__1__ge__N;

    /* khepera.bg:17: r1: factor of m[1].wheel': m[1].fs*m[1].el.Re/(m[1].el.k*m[1].ge.N) */
    c->r1_m__1__wheel_1 = p->m__1__fs * p->m__1__el__Re / p->m__1__el__k / p->m__1__ge__N;

    /* khepera.bg:17: r1: factor of m[1].wheel'': m[1].fs*m[1].el.L/(m[1].el.k*m[1].ge.N) +
     * m[1].Js*m[1].el.Re/(m[1].el.k*m[1].ge.N) */
    c->r1_m__1__wheel_2 = t_2 + t_4;

    /* khepera.bg:17: r1: factor of m[1].wheel''': m[1].Js*m[1].el.L/(m[1].el.k*m[1].ge.N) */
    c->r1_m__1__wheel_3 = p->m__1__Js * p->m__1__el__L / p->m__1__el__k / p->m__1__ge__N;

    /* speed of m[1].motor for one count */
    c->m__1__motor_gain = REAL(0.0015339807878856412) * t_13;

    /* filter: what is left of a memory a sample later */
    c->a = pole;

    /* khepera.bg:17: r1: factor of m[1].motor'' */
    c->r1_w2_m__1__motor = (-t - t_3) * w;

    /* khepera.bg:17: r1: factor of m[1].motor''' */
    c->r1_w3_m__1__motor = p->m__1__Je * p->m__1__el__L * w * w / p->m__1__el__k;

    /* khepera.bg:17: r1: factor of Fx[1]' */
    c->r1_w1_Fx__1 = p->m__1__R * p->m__1__el__L * w / p->m__1__el__k / p->m__1__ge__N;

    /* speed of m[1].wheel for one count */
    c->m__1__wheel_gain = REAL(9.587379924285257e-05) * t_13;

    /* khepera.bg:17: r1: factor of m[1].wheel'' */
    c->r1_w2_m__1__wheel = (-t_2 - t_4) * w;

    /* khepera.bg:17: r1: factor of m[1].wheel''' */
    c->r1_w3_m__1__wheel = p->m__1__Js * p->m__1__el__L * w * w / p->m__1__el__k / p->m__1__ge__N;

    /* filter: 2 * (w*sample_time)^2/12 */
    c->bend2 = t_12 / REAL(6.0);

    /* filter: 1 * (w*sample_time)^2/12 */
    c->bend1 = t_12 / REAL(12.0);

    /* filter: 3 * (w*sample_time)^2/12 */
    c->bend3 = REAL(0.25) * t_12;

    /* filter: weight of a sample, new and a sample later */
    c->b = REAL(0.5) * t_10;

    /* filter: 1 - b, the memory of a constant 1 */
    c->rest = t_11;

    /* khepera_encoders.bg:31: 1/(4*m[1].tau0) */
    c->g = REAL(0.25) / p->m__1__tau0;

    /* khepera_encoders.bg:31: m[1].ge.N/(4*m[1].tau0) */
    c->g_2 = REAL(0.25) * p->m__1__ge__N / p->m__1__tau0;

    /* khepera_encoders.bg:31: r2: factor of Fx[1]: m[1].R/m[1].ge.N */
    c->r2_Fx__1 = p->m__1__R / p->m__1__ge__N;

    /* khepera_encoders.bg:31: r2: factor of m[1].wheel': m[1].fs/m[1].ge.N */
    c->r2_m__1__wheel_1 = p->m__1__fs / p->m__1__ge__N;

    /* khepera_encoders.bg:31: r2: factor of m[1].wheel'': m[1].Js/m[1].ge.N */
    c->r2_m__1__wheel_2 = p->m__1__Js / p->m__1__ge__N;

    /* khepera_encoders.bg:31: r2: factor of Int(D(m[1].motor)): m[1].K */
    c->r2_integral = p->m__1__K;

    /* khepera_encoders.bg:31: r2: factor of Int(D(m[1].wheel)): m[1].K*m[1].ge.N */
    c->r2_integral_2 = p->m__1__K * p->m__1__ge__N;

    /* khepera_encoders.bg:31: r2: factor of tanh(Int(D(m[1].motor))/(4*m[1].tau0) -
     * m[1].ge.N*Int(D( ...: m[1].K*m[1].tau0*m[1].A */
    c->r2_tanh = p->m__1__K * p->m__1__tau0 * p->m__1__A;

    /* khepera_encoders.bg:31: m[1].wheel.int.x0 */
    c->m__1__wheel__int__x0 = REAL(0.0);

    /* khepera_encoders.bg:31: m[1].motor.int.x0 */
    c->m__1__motor__int__x0 = REAL(0.0);

    /* khepera_encoders.bg:31: r2: factor of m[1].wheel'' */
    c->r2_w2_m__1__wheel = p->m__1__Js * w / p->m__1__ge__N;

    /* khepera.bg:17: r3: factor of m[2].motor': m[2].el.k + m[2].fe*m[2].el.Re/m[2].el.k */
    c->r3_m__2__motor_1 = p->m__2__el__k + p->m__2__fe * p->m__2__el__Re / p->m__2__el__k;

    /* khepera.bg:17: r3: factor of m[2].motor'': m[2].fe*m[2].el.L/m[2].el.k +
     * m[2].Je*m[2].el.Re/m[2].el.k */
    c->r3_m__2__motor_2 = t_5 + t_7;

    /* khepera.bg:17: r3: factor of m[2].motor''': m[2].Je*m[2].el.L/m[2].el.k */
    c->r3_m__2__motor_3 = p->m__2__Je * p->m__2__el__L / p->m__2__el__k;

    /* khepera.bg:17: r3: factor of Fx[2]: m[2].R*m[2].el.Re/(m[2].el.k*m[2].ge.N) */
    c->r3_Fx__2 = p->m__2__R * p->m__2__el__Re / p->m__2__el__k / p->m__2__ge__N;

    /* khepera.bg:17: r3: factor of Fx[2]': m[2].R*m[2].el.L/(m[2].el.k*m[2].ge.N) */
    c->r3_Fx__2_1 = p->m__2__R * p->m__2__el__L / p->m__2__el__k / p->m__2__ge__N;

    /* khepera.bg:17: r3: factor of m[2].wheel': m[2].fs*m[2].el.Re/(m[2].el.k*m[2].ge.N) */
    c->r3_m__2__wheel_1 = p->m__2__fs * p->m__2__el__Re / p->m__2__el__k / p->m__2__ge__N;

    /* khepera.bg:17: r3: factor of m[2].wheel'': m[2].fs*m[2].el.L/(m[2].el.k*m[2].ge.N) +
     * m[2].Js*m[2].el.Re/(m[2].el.k*m[2].ge.N) */
    c->r3_m__2__wheel_2 = t_6 + t_8;

    /* khepera.bg:17: r3: factor of m[2].wheel''': m[2].Js*m[2].el.L/(m[2].el.k*m[2].ge.N) */
    c->r3_m__2__wheel_3 = p->m__2__Js * p->m__2__el__L / p->m__2__el__k / p->m__2__ge__N;

    /* khepera.bg:17: r3: factor of m[2].motor'' */
    c->r3_w2_m__2__motor = (-t_5 - t_7) * w;

    /* khepera.bg:17: r3: factor of m[2].motor''' */
    c->r3_w3_m__2__motor = p->m__2__Je * p->m__2__el__L * w * w / p->m__2__el__k;

    /* khepera.bg:17: r3: factor of Fx[2]' */
    c->r3_w1_Fx__2 = p->m__2__R * p->m__2__el__L * w / p->m__2__el__k / p->m__2__ge__N;

    /* khepera.bg:17: r3: factor of m[2].wheel'' */
    c->r3_w2_m__2__wheel = (-t_6 - t_8) * w;

    /* khepera.bg:17: r3: factor of m[2].wheel''' */
    c->r3_w3_m__2__wheel = p->m__2__Js * p->m__2__el__L * w * w / p->m__2__el__k / p->m__2__ge__N;

    /* khepera_encoders.bg:31: 1/(4*m[2].tau0) */
    c->g_3 = REAL(0.25) / p->m__2__tau0;

    /* khepera_encoders.bg:31: m[2].ge.N/(4*m[2].tau0) */
    c->g_4 = REAL(0.25) * p->m__2__ge__N / p->m__2__tau0;

    /* khepera_encoders.bg:31: r4: factor of Fx[2]: m[2].R/m[2].ge.N */
    c->r4_Fx__2 = p->m__2__R / p->m__2__ge__N;

    /* khepera_encoders.bg:31: r4: factor of m[2].wheel': m[2].fs/m[2].ge.N */
    c->r4_m__2__wheel_1 = p->m__2__fs / p->m__2__ge__N;

    /* khepera_encoders.bg:31: r4: factor of m[2].wheel'': m[2].Js/m[2].ge.N */
    c->r4_m__2__wheel_2 = p->m__2__Js / p->m__2__ge__N;

    /* khepera_encoders.bg:31: r4: factor of Int(D(m[2].motor)): m[2].K */
    c->r4_integral = p->m__2__K;

    /* khepera_encoders.bg:31: r4: factor of Int(D(m[2].wheel)): m[2].K*m[2].ge.N */
    c->r4_integral_2 = p->m__2__K * p->m__2__ge__N;

    /* khepera_encoders.bg:31: r4: factor of tanh(Int(D(m[2].motor))/(4*m[2].tau0) -
     * m[2].ge.N*Int(D( ...: m[2].K*m[2].tau0*m[2].A */
    c->r4_tanh = p->m__2__K * p->m__2__tau0 * p->m__2__A;

    /* khepera_encoders.bg:31: m[2].wheel.int.x0 */
    c->m__2__wheel__int__x0 = REAL(0.0);

    /* khepera_encoders.bg:31: m[2].motor.int.x0 */
    c->m__2__motor__int__x0 = REAL(0.0);

    /* khepera_encoders.bg:31: r4: factor of m[2].wheel'' */
    c->r4_w2_m__2__wheel = p->m__2__Js * w / p->m__2__ge__N;

    /* khepera.bg:114: r5: factor of Us': 3.3e-10*R_L */
    c->r5_Us_1 = REAL(33.0) * p->R_L / REAL(100000000000.0);

    /* khepera.bg:114: r5: factor of Us'': 1.21e-20*R_L^2 + 1.65e-16 */
    c->r5_Us_2 = REAL(1.21e-20) * t_9 + REAL(1.65e-16);

    /* khepera.bg:114: r5: factor of Us''': 1.21e-26*R_L */
    c->r5_Us_3 = REAL(1.21e-26) * p->R_L;

    /* khepera.bg:114: r5: factor of load: R_L */
    c->r5_load = p->R_L;

    /* khepera.bg:114: r5: factor of load': 5.5e-11*R_L^2 + 5e-07 */
    c->r5_load_1 = REAL(11.0) * t_9 / REAL(200000000000.0) + REAL(1.0) / REAL(2000000.0);

    /* khepera.bg:114: r5: factor of load'': 5.5e-17*R_L */
    c->r5_load_2 = REAL(5.5e-17) * p->R_L;

    /* khepera.bg:114: r5: factor of load' */
    c->r5_w1_load = (-REAL(11.0) * t_9 / REAL(200000000000.0) - REAL(1.0) / REAL(2000000.0)) * w;
}

static bool parameters_are_finite(const khepera_encoders_parameters *p)
{
    return finite_number(p->R_L + p->m__1__Je + p->m__1__fe + p->m__1__K + p->m__1__tau0
            + p->m__1__A + p->m__1__Js + p->m__1__fs + p->m__1__R + p->m__1__el__L + p->m__1__el__Re
            + p->m__1__el__k + p->m__1__ge__N + p->m__2__Je + p->m__2__fe + p->m__2__K
            + p->m__2__tau0 + p->m__2__A + p->m__2__Js + p->m__2__fs + p->m__2__R + p->m__2__el__L
            + p->m__2__el__Re + p->m__2__el__k + p->m__2__ge__N);
}

static bool coefficients_are_finite(const khepera_encoders_monitor *monitor)
{
    return finite_number(monitor->c.r1_m__1__motor_1 + monitor->c.r1_m__1__motor_2
            + monitor->c.r1_m__1__motor_3 + monitor->c.r1_Fx__1 + monitor->c.r1_Fx__1_1
            + monitor->c.r1_m__1__wheel_1 + monitor->c.r1_m__1__wheel_2
            + monitor->c.r1_m__1__wheel_3 + monitor->c.m__1__motor_gain + monitor->c.a
            + monitor->c.r1_w2_m__1__motor + monitor->c.r1_w3_m__1__motor + monitor->c.r1_w1_Fx__1
            + monitor->c.m__1__wheel_gain + monitor->c.r1_w2_m__1__wheel
            + monitor->c.r1_w3_m__1__wheel + monitor->c.bend2 + monitor->c.bend1 + monitor->c.bend3
            + monitor->c.b + monitor->c.rest + monitor->c.g + monitor->c.g_2 + monitor->c.r2_Fx__1
            + monitor->c.r2_m__1__wheel_1 + monitor->c.r2_m__1__wheel_2 + monitor->c.r2_integral
            + monitor->c.r2_integral_2 + monitor->c.r2_tanh + monitor->c.m__1__wheel__int__x0
            + monitor->c.m__1__motor__int__x0 + monitor->c.r2_w2_m__1__wheel
            + monitor->c.r3_m__2__motor_1 + monitor->c.r3_m__2__motor_2
            + monitor->c.r3_m__2__motor_3 + monitor->c.r3_Fx__2 + monitor->c.r3_Fx__2_1
            + monitor->c.r3_m__2__wheel_1 + monitor->c.r3_m__2__wheel_2
            + monitor->c.r3_m__2__wheel_3 + monitor->c.r3_w2_m__2__motor
            + monitor->c.r3_w3_m__2__motor + monitor->c.r3_w1_Fx__2 + monitor->c.r3_w2_m__2__wheel
            + monitor->c.r3_w3_m__2__wheel + monitor->c.g_3 + monitor->c.g_4 + monitor->c.r4_Fx__2
            + monitor->c.r4_m__2__wheel_1 + monitor->c.r4_m__2__wheel_2 + monitor->c.r4_integral
            + monitor->c.r4_integral_2 + monitor->c.r4_tanh + monitor->c.m__2__wheel__int__x0
            + monitor->c.m__2__motor__int__x0 + monitor->c.r4_w2_m__2__wheel + monitor->c.r5_Us_1
            + monitor->c.r5_Us_2 + monitor->c.r5_Us_3 + monitor->c.r5_load + monitor->c.r5_load_1
            + monitor->c.r5_load_2 + monitor->c.r5_w1_load);
}

/* Samples until `constants` time constants of the filter are over. */
static uint32_t samples(real constants, real sample_time, real bandwidth)
{
    const real wait = constants / (bandwidth * sample_time);
    const uint32_t whole = wait < REAL(4.0e9) ? (uint32_t)wait : UINT32_MAX - 1u;

    return (real)whole < wait ? whole + 1u : whole;
}

khepera_encoders_status khepera_encoders_configure(
    khepera_encoders_monitor *monitor,
    const khepera_encoders_parameters *parameters,
    khepera_encoders_real sample_time,
    khepera_encoders_real bandwidth,
    khepera_encoders_real time_unit)
{
    int k;

    for (k = 0; k < KHEPERA_ENCODERS_RESIDUALS; ++k) {
        monitor->settle[k] = UINT32_MAX;
    }
    khepera_encoders_reset(monitor);
    if (!parameters_are_finite(parameters)) {
        return KHEPERA_ENCODERS_BAD_PARAMETER;
    }
    if (!(sample_time >= REAL(0.000999999)) || !finite_number(sample_time)) {
        return KHEPERA_ENCODERS_BAD_SAMPLE_TIME;
    }
    if (!(bandwidth * sample_time >= SLOWEST && bandwidth * sample_time <= REAL(3.0))) {
        return KHEPERA_ENCODERS_BAD_BANDWIDTH;
    }
    if (!(time_unit > REAL(0.0)) || !finite_number(time_unit)) {
        return KHEPERA_ENCODERS_BAD_TIME_UNIT;
    }
    compute_coefficients(monitor, parameters, sample_time, bandwidth);
    if (!coefficients_are_finite(monitor)) {
        return KHEPERA_ENCODERS_BAD_COEFFICIENT;
    }
    monitor->settle[KHEPERA_ENCODERS_R1] =
        samples(REAL(13.062240779188071), sample_time, bandwidth);
    monitor->settle[KHEPERA_ENCODERS_R2] =
        samples(REAL(11.228872242412663), sample_time, bandwidth);
    monitor->settle[KHEPERA_ENCODERS_R3] =
        samples(REAL(13.062240779188071), sample_time, bandwidth);
    monitor->settle[KHEPERA_ENCODERS_R4] =
        samples(REAL(11.228872242412663), sample_time, bandwidth);
    monitor->settle[KHEPERA_ENCODERS_R5] = samples(REAL(9.233413476451586), sample_time, bandwidth);
    return KHEPERA_ENCODERS_OK;
}

void khepera_encoders_exact(
    const khepera_encoders_monitor *monitor,
    const khepera_encoders_derivatives *derivatives,
    khepera_encoders_real residuals[KHEPERA_ENCODERS_RESIDUALS])
{
    const khepera_encoders_coefficients *c = &monitor->c;
    const khepera_encoders_derivatives *d = derivatives;
    real *r = residuals;

    /* khepera.bg:17: r1 = U0[1] - m[1].el.k*D(m[1].motor) - m[1].el.Re*m[1].el.k.e2/m[1].el.k -
     * m[1].el.L*D(m[1].el.k.e2)/m[1].el.k
     * where m[1].el.k.e2 = m[1].fe*D(m[1].motor) + m[1].Je*D(m[1].motor, 2) + (Fx[1]*m[1].R +
     * m[1].fs*D(m[1].wheel) + m[1].Js*D(m[1].wheel, 2))/m[1].ge.N */
    r[KHEPERA_ENCODERS_R1] = d->U0__1 - c->r1_m__1__motor_1 * d->m__1__motor[1]
        - c->r1_m__1__motor_2 * d->m__1__motor[2] - c->r1_m__1__motor_3 * d->m__1__motor[3]
        - c->r1_Fx__1 * d->Fx__1[0] - c->r1_Fx__1_1 * d->Fx__1[1]
        - c->r1_m__1__wheel_1 * d->m__1__wheel[1] - c->r1_m__1__wheel_2 * d->m__1__wheel[2]
        - c->r1_m__1__wheel_3 * d->m__1__wheel[3];

    /* khepera_encoders.bg:31: r2 = (Fx[1]*m[1].R + m[1].fs*D(m[1].wheel) + m[1].Js*D(m[1].wheel,
     * 2))/m[1].ge.N - m[1].K*(m[1].spring.q +
     * m[1].tau0*m[1].A*tanh(m[1].spring.q/(4*m[1].tau0)))
     * where m[1].spring.q = Int(D(m[1].motor) - m[1].ge.N*D(m[1].wheel)) */
    r[KHEPERA_ENCODERS_R2] = c->r2_Fx__1 * d->Fx__1[0] + c->r2_m__1__wheel_1 * d->m__1__wheel[1]
        + c->r2_m__1__wheel_2 * d->m__1__wheel[2]
        + c->r2_integral_2 * (d->m__1__wheel[0] - d->m__1__wheel_start)
        - c->r2_integral * (d->m__1__motor[0] - d->m__1__motor_start)
        - c->r2_tanh * MATH(tanh)(c->g * (d->m__1__motor[0] - d->m__1__motor_start)
            - c->g_2 * (d->m__1__wheel[0] - d->m__1__wheel_start));

    /* khepera.bg:17: r3 = U0[2] - m[2].el.k*D(m[2].motor) - m[2].el.Re*m[2].el.k.e2/m[2].el.k -
     * m[2].el.L*D(m[2].el.k.e2)/m[2].el.k
     * where m[2].el.k.e2 = m[2].fe*D(m[2].motor) + m[2].Je*D(m[2].motor, 2) + (Fx[2]*m[2].R +
     * m[2].fs*D(m[2].wheel) + m[2].Js*D(m[2].wheel, 2))/m[2].ge.N */
    r[KHEPERA_ENCODERS_R3] = d->U0__2 - c->r3_m__2__motor_1 * d->m__2__motor[1]
        - c->r3_m__2__motor_2 * d->m__2__motor[2] - c->r3_m__2__motor_3 * d->m__2__motor[3]
        - c->r3_Fx__2 * d->Fx__2[0] - c->r3_Fx__2_1 * d->Fx__2[1]
        - c->r3_m__2__wheel_1 * d->m__2__wheel[1] - c->r3_m__2__wheel_2 * d->m__2__wheel[2]
        - c->r3_m__2__wheel_3 * d->m__2__wheel[3];

    /* khepera_encoders.bg:31: r4 = (Fx[2]*m[2].R + m[2].fs*D(m[2].wheel) + m[2].Js*D(m[2].wheel,
     * 2))/m[2].ge.N - m[2].K*(m[2].spring.q +
     * m[2].tau0*m[2].A*tanh(m[2].spring.q/(4*m[2].tau0)))
     * where m[2].spring.q = Int(D(m[2].motor) - m[2].ge.N*D(m[2].wheel)) */
    r[KHEPERA_ENCODERS_R4] = c->r4_Fx__2 * d->Fx__2[0] + c->r4_m__2__wheel_1 * d->m__2__wheel[1]
        + c->r4_m__2__wheel_2 * d->m__2__wheel[2]
        + c->r4_integral_2 * (d->m__2__wheel[0] - d->m__2__wheel_start)
        - c->r4_integral * (d->m__2__motor[0] - d->m__2__motor_start)
        - c->r4_tanh * MATH(tanh)(c->g_3 * (d->m__2__motor[0] - d->m__2__motor_start)
            - c->g_4 * (d->m__2__wheel[0] - d->m__2__wheel_start));

    /* khepera.bg:114: r5 = Uin - line.cell[1].mid.e - R_L*line.cell[1].left.f/2 -
     * D(line.cell[1].left.f)/4000000
     * where line.cell[1].left.f = line.cell[1].right.f + 2.2e-10*D(line.cell[1].mid.e)
     * line.cell[1].mid.e = Us + R_L*line.cell[1].right.f/2 + D(line.cell[1].right.f)/4000000
     * line.cell[1].right.f = load + 2.2e-10*D(Us) */
    r[KHEPERA_ENCODERS_R5] = d->Uin - d->Us[0] - c->r5_Us_1 * d->Us[1] - c->r5_Us_2 * d->Us[2]
        - c->r5_Us_3 * d->Us[3] - REAL(3.025e-33) * d->Us[4] - c->r5_load * d->load[0]
        - c->r5_load_1 * d->load[1] - c->r5_load_2 * d->load[2] - REAL(1.375e-23) * d->load[3];
}

/* r1 on its first sample: the filter as if it had always been so. */
static void start_r1(
    khepera_encoders_monitor *monitor, const khepera_encoders_samples *s, real *r)
{
    const khepera_encoders_coefficients *c = &monitor->c;
    khepera_encoders_memory *x = &monitor->x;

    count_from(&monitor->e.m__1__motor_r1, s->m__1__motor);
    count_from(&monitor->e.m__1__wheel_r1, s->m__1__wheel);

    /* khepera.bg:17: filtered speed of m[1].motor, at rest */
    const real r1_m__1__motor_speed_2 = REAL(0.0);

    /* khepera.bg:17: filtered speed of m[1].motor */
    x->r1_m__1__motor_speed = r1_m__1__motor_speed_2;

    /* khepera.bg:17: filtered speed of m[1].wheel, at rest */
    const real r1_m__1__wheel_speed_2 = REAL(0.0);

    /* khepera.bg:17: filtered speed of m[1].wheel */
    x->r1_m__1__wheel_speed = r1_m__1__wheel_speed_2;

    /* khepera.bg:17: r1: encoders, order 1 */
    const real r1_n1 = -c->r1_m__1__motor_1 * r1_m__1__motor_speed_2
        - c->r1_m__1__wheel_1 * r1_m__1__wheel_speed_2;

    /* khepera.bg:17: r1: error of order 1 */
    const real r1_e1 = c->bend2 * r1_n1;

    /* khepera.bg:17: r1: encoders, order 2 */
    const real r1_n2 = c->r1_w2_m__1__motor * r1_m__1__motor_speed_2
        + c->r1_w2_m__1__wheel * r1_m__1__wheel_speed_2;

    /* khepera.bg:17: r1: error of order 2 */
    const real r1_e2 = c->bend1 * r1_n2;

    /* khepera.bg:17: r1: encoders, order 3 */
    const real r1_n3 = -c->r1_w3_m__1__motor * r1_m__1__motor_speed_2
        - c->r1_w3_m__1__wheel * r1_m__1__wheel_speed_2;

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
     * m[1].fs*D(m[1].wheel) + m[1].Js*D(m[1].wheel, 2))/m[1].ge.N */
    r[KHEPERA_ENCODERS_R1] = r1_y1 - r1_e2;
}

/* r1 on every further sample. */
static void next_r1(
    khepera_encoders_monitor *monitor, const khepera_encoders_samples *s, real *r)
{
    const khepera_encoders_coefficients *c = &monitor->c;
    khepera_encoders_memory *x = &monitor->x;
    const khepera_encoders_encoders *e = &monitor->e;

    count_on(&monitor->e.m__1__motor_r1, s->m__1__motor);
    count_on(&monitor->e.m__1__wheel_r1, s->m__1__wheel);

    /* khepera.bg:17: filtered speed of m[1].motor */
    const real r1_m__1__motor_speed_2 = c->a * x->r1_m__1__motor_speed
        + c->m__1__motor_gain * (real)e->m__1__motor_r1.increment;
    x->r1_m__1__motor_speed = r1_m__1__motor_speed_2;

    /* khepera.bg:17: filtered speed of m[1].wheel */
    const real r1_m__1__wheel_speed_2 = c->a * x->r1_m__1__wheel_speed
        + c->m__1__wheel_gain * (real)e->m__1__wheel_r1.increment;
    x->r1_m__1__wheel_speed = r1_m__1__wheel_speed_2;

    /* khepera.bg:17: r1: encoders, order 1 */
    const real r1_n1 = -c->r1_m__1__motor_1 * r1_m__1__motor_speed_2
        - c->r1_m__1__wheel_1 * r1_m__1__wheel_speed_2;

    /* khepera.bg:17: r1: error of order 1 */
    const real r1_e1 = c->bend2 * r1_n1;

    /* khepera.bg:17: r1: encoders, order 2 */
    const real r1_n2 = c->r1_w2_m__1__motor * r1_m__1__motor_speed_2
        + c->r1_w2_m__1__wheel * r1_m__1__wheel_speed_2;

    /* khepera.bg:17: r1: error of order 2 */
    const real r1_e2 = c->bend1 * r1_n2;

    /* khepera.bg:17: r1: encoders, order 3 */
    const real r1_n3 = -c->r1_w3_m__1__motor * r1_m__1__motor_speed_2
        - c->r1_w3_m__1__wheel * r1_m__1__wheel_speed_2;

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
     * m[1].fs*D(m[1].wheel) + m[1].Js*D(m[1].wheel, 2))/m[1].ge.N */
    r[KHEPERA_ENCODERS_R1] = r1_y1 - r1_e2;
}

/* One sample for r1; a number that is not finite makes the next sample the first. */
static void run_r1(
    khepera_encoders_monitor *monitor, const khepera_encoders_samples *s, khepera_encoders_residuals *residuals)
{
    real *r = residuals->value;
    uint32_t age = monitor->age[0];

    if (age == 0u) {
        start_r1(monitor, s, r);
    } else {
        next_r1(monitor, s, r);
    }
    /* a sum is finite only if all its terms are */
    if (finite_number(s->Fx__1 + s->U0__1 + r[KHEPERA_ENCODERS_R1])) {
        age += age < UINT32_MAX ? 1u : 0u;
    } else {
        age = 0u;
        r[KHEPERA_ENCODERS_R1] = REAL(0.0);
    }
    monitor->age[0] = age;
    residuals->valid[KHEPERA_ENCODERS_R1] = age > monitor->settle[KHEPERA_ENCODERS_R1];
}

/* r2 on its first sample: the filter as if it had always been so. */
static void start_r2(
    khepera_encoders_monitor *monitor, const khepera_encoders_samples *s, real *r)
{
    const khepera_encoders_coefficients *c = &monitor->c;
    khepera_encoders_memory *x = &monitor->x;
    const khepera_encoders_encoders *e = &monitor->e;

    count_from(&monitor->e.m__1__motor_r2, s->m__1__motor);
    count_from(&monitor->e.m__1__wheel_r2, s->m__1__wheel);

    /* khepera_encoders.bg:31: m[1].wheel */
    const real r2_m__1__wheel = c->m__1__wheel__int__x0
        + REAL(9.587379924285257e-05) * (real)e->m__1__wheel_r2.total;

    /* khepera_encoders.bg:31: change of D(m[1].wheel) */
    x->r2_start = r2_m__1__wheel;
    const real r2_change = r2_m__1__wheel - x->r2_start;

    /* khepera_encoders.bg:31: m[1].motor */
    const real r2_m__1__motor = c->m__1__motor__int__x0
        + REAL(0.0015339807878856412) * (real)e->m__1__motor_r2.total;

    /* khepera_encoders.bg:31: change of D(m[1].motor) */
    x->r2_start_2 = r2_m__1__motor;
    const real r2_change_2 = r2_m__1__motor - x->r2_start_2;

    /* khepera_encoders.bg:31: tanh(Int(D(m[1].motor))/(4*m[1].tau0) - m[1].ge.N*Int(D( ... */
    const real r2_tanh = MATH(tanh)(c->g * r2_change_2 - c->g_2 * r2_change);

    /* khepera_encoders.bg:31: filtered speed of m[1].wheel, at rest */
    const real r2_m__1__wheel_speed_2 = REAL(0.0);

    /* khepera_encoders.bg:31: filtered speed of m[1].wheel */
    x->r2_m__1__wheel_speed = r2_m__1__wheel_speed_2;

    /* khepera_encoders.bg:31: r2: encoders, order 1 */
    const real r2_n1 = c->r2_m__1__wheel_1 * r2_m__1__wheel_speed_2;

    /* khepera_encoders.bg:31: r2: error of order 1 */
    const real r2_e1 = c->bend1 * r2_n1;

    /* khepera_encoders.bg:31: r2: encoders, order 2 */
    const real r2_n2 = c->r2_w2_m__1__wheel * r2_m__1__wheel_speed_2;

    /* khepera_encoders.bg:31: r2: terms of order 0 */
    const real r2_g0 = c->r2_Fx__1 * s->Fx__1 + c->r2_integral_2 * r2_change
        - c->r2_integral * r2_change_2 - c->r2_tanh * r2_tanh;

    /* khepera_encoders.bg:31: r2: degree 1 */
    const real r2_d1 = r2_n1 + r2_n2;

    /* khepera_encoders.bg:31: r2: error of order 0 */
    const real r2_e0 = c->bend2 * r2_g0;

    /* khepera_encoders.bg:31: r2: degree 2 */
    const real r2_d2 = r2_n2 - r2_e1 - r2_e0;

    /* khepera_encoders.bg:31: r2: input of stage 3 */
    const real r2_u3 = r2_g0 + r2_n1 + r2_d2 + r2_e1 - r2_d1;

    /* khepera_encoders.bg:31: r2: stage 3, at rest */
    const real r2_y3 = r2_u3;

    /* khepera_encoders.bg:31: r2: stage 3: memory */
    x->r2_s3 = c->rest * r2_u3;

    /* khepera_encoders.bg:31: r2: input of stage 2 */
    const real r2_u2 = r2_y3 + r2_d1 - REAL(2.0) * r2_d2 - REAL(3.0) * r2_e1;

    /* khepera_encoders.bg:31: r2: stage 2, at rest */
    const real r2_y2 = r2_u2;

    /* khepera_encoders.bg:31: r2: stage 2: memory */
    x->r2_s2 = c->rest * r2_u2;

    /* khepera_encoders.bg:31: r2: input of stage 1 */
    const real r2_u1 = r2_y2 + r2_d2 + REAL(3.0) * r2_e1;

    /* khepera_encoders.bg:31: r2: stage 1, at rest */
    const real r2_y1 = r2_u1;

    /* khepera_encoders.bg:31: r2: stage 1: memory */
    x->r2_s1 = c->rest * r2_u1;

    /* khepera_encoders.bg:31: r2 = (Fx[1]*m[1].R + m[1].fs*D(m[1].wheel) + m[1].Js*D(m[1].wheel,
     * 2))/m[1].ge.N - m[1].K*(m[1].spring.q +
     * m[1].tau0*m[1].A*tanh(m[1].spring.q/(4*m[1].tau0)))
     * where m[1].spring.q = Int(D(m[1].motor) - m[1].ge.N*D(m[1].wheel)) */
    r[KHEPERA_ENCODERS_R2] = r2_y1 - r2_e1;
}

/* r2 on every further sample. */
static void next_r2(
    khepera_encoders_monitor *monitor, const khepera_encoders_samples *s, real *r)
{
    const khepera_encoders_coefficients *c = &monitor->c;
    khepera_encoders_memory *x = &monitor->x;
    const khepera_encoders_encoders *e = &monitor->e;

    count_on(&monitor->e.m__1__motor_r2, s->m__1__motor);
    count_on(&monitor->e.m__1__wheel_r2, s->m__1__wheel);

    /* khepera_encoders.bg:31: m[1].wheel */
    const real r2_m__1__wheel = c->m__1__wheel__int__x0
        + REAL(9.587379924285257e-05) * (real)e->m__1__wheel_r2.total;

    /* khepera_encoders.bg:31: change of D(m[1].wheel) */
    const real r2_change = r2_m__1__wheel - x->r2_start;

    /* khepera_encoders.bg:31: m[1].motor */
    const real r2_m__1__motor = c->m__1__motor__int__x0
        + REAL(0.0015339807878856412) * (real)e->m__1__motor_r2.total;

    /* khepera_encoders.bg:31: change of D(m[1].motor) */
    const real r2_change_2 = r2_m__1__motor - x->r2_start_2;

    /* khepera_encoders.bg:31: tanh(Int(D(m[1].motor))/(4*m[1].tau0) - m[1].ge.N*Int(D( ... */
    const real r2_tanh = MATH(tanh)(c->g * r2_change_2 - c->g_2 * r2_change);

    /* khepera_encoders.bg:31: filtered speed of m[1].wheel */
    const real r2_m__1__wheel_speed_2 = c->a * x->r2_m__1__wheel_speed
        + c->m__1__wheel_gain * (real)e->m__1__wheel_r2.increment;
    x->r2_m__1__wheel_speed = r2_m__1__wheel_speed_2;

    /* khepera_encoders.bg:31: r2: encoders, order 1 */
    const real r2_n1 = c->r2_m__1__wheel_1 * r2_m__1__wheel_speed_2;

    /* khepera_encoders.bg:31: r2: error of order 1 */
    const real r2_e1 = c->bend1 * r2_n1;

    /* khepera_encoders.bg:31: r2: encoders, order 2 */
    const real r2_n2 = c->r2_w2_m__1__wheel * r2_m__1__wheel_speed_2;

    /* khepera_encoders.bg:31: r2: terms of order 0 */
    const real r2_g0 = c->r2_Fx__1 * s->Fx__1 + c->r2_integral_2 * r2_change
        - c->r2_integral * r2_change_2 - c->r2_tanh * r2_tanh;

    /* khepera_encoders.bg:31: r2: degree 1 */
    const real r2_d1 = r2_n1 + r2_n2;

    /* khepera_encoders.bg:31: r2: error of order 0 */
    const real r2_e0 = c->bend2 * r2_g0;

    /* khepera_encoders.bg:31: r2: degree 2 */
    const real r2_d2 = r2_n2 - r2_e1 - r2_e0;

    /* khepera_encoders.bg:31: r2: input of stage 3 */
    const real r2_u3 = r2_g0 + r2_n1 + r2_d2 + r2_e1 - r2_d1;

    /* khepera_encoders.bg:31: r2: stage 3 */
    const real r2_y3 = x->r2_s3 + c->b * r2_u3;

    /* khepera_encoders.bg:31: r2: stage 3: memory */
    x->r2_s3 = c->a * r2_y3 + c->b * r2_u3;

    /* khepera_encoders.bg:31: r2: input of stage 2 */
    const real r2_u2 = r2_y3 + r2_d1 - REAL(2.0) * r2_d2 - REAL(3.0) * r2_e1;

    /* khepera_encoders.bg:31: r2: stage 2 */
    const real r2_y2 = x->r2_s2 + c->b * r2_u2;

    /* khepera_encoders.bg:31: r2: stage 2: memory */
    x->r2_s2 = c->a * r2_y2 + c->b * r2_u2;

    /* khepera_encoders.bg:31: r2: input of stage 1 */
    const real r2_u1 = r2_y2 + r2_d2 + REAL(3.0) * r2_e1;

    /* khepera_encoders.bg:31: r2: stage 1 */
    const real r2_y1 = x->r2_s1 + c->b * r2_u1;

    /* khepera_encoders.bg:31: r2: stage 1: memory */
    x->r2_s1 = c->a * r2_y1 + c->b * r2_u1;

    /* khepera_encoders.bg:31: r2 = (Fx[1]*m[1].R + m[1].fs*D(m[1].wheel) + m[1].Js*D(m[1].wheel,
     * 2))/m[1].ge.N - m[1].K*(m[1].spring.q +
     * m[1].tau0*m[1].A*tanh(m[1].spring.q/(4*m[1].tau0)))
     * where m[1].spring.q = Int(D(m[1].motor) - m[1].ge.N*D(m[1].wheel)) */
    r[KHEPERA_ENCODERS_R2] = r2_y1 - r2_e1;
}

/* One sample for r2; a number that is not finite makes the next sample the first. */
static void run_r2(
    khepera_encoders_monitor *monitor, const khepera_encoders_samples *s, khepera_encoders_residuals *residuals)
{
    real *r = residuals->value;
    uint32_t age = monitor->age[1];

    if (age == 0u) {
        start_r2(monitor, s, r);
    } else {
        next_r2(monitor, s, r);
    }
    /* a sum is finite only if all its terms are */
    if (finite_number(s->Fx__1 + r[KHEPERA_ENCODERS_R2])) {
        age += age < UINT32_MAX ? 1u : 0u;
    } else {
        age = 0u;
        r[KHEPERA_ENCODERS_R2] = REAL(0.0);
    }
    monitor->age[1] = age;
    residuals->valid[KHEPERA_ENCODERS_R2] = age > monitor->settle[KHEPERA_ENCODERS_R2];
}

/* r3 on its first sample: the filter as if it had always been so. */
static void start_r3(
    khepera_encoders_monitor *monitor, const khepera_encoders_samples *s, real *r)
{
    const khepera_encoders_coefficients *c = &monitor->c;
    khepera_encoders_memory *x = &monitor->x;

    count_from(&monitor->e.m__2__motor_r3, s->m__2__motor);
    count_from(&monitor->e.m__2__wheel_r3, s->m__2__wheel);

    /* khepera.bg:17: filtered speed of m[2].motor, at rest */
    const real r3_m__2__motor_speed_2 = REAL(0.0);

    /* khepera.bg:17: filtered speed of m[2].motor */
    x->r3_m__2__motor_speed = r3_m__2__motor_speed_2;

    /* khepera.bg:17: filtered speed of m[2].wheel, at rest */
    const real r3_m__2__wheel_speed_2 = REAL(0.0);

    /* khepera.bg:17: filtered speed of m[2].wheel */
    x->r3_m__2__wheel_speed = r3_m__2__wheel_speed_2;

    /* khepera.bg:17: r3: encoders, order 1 */
    const real r3_n1 = -c->r3_m__2__motor_1 * r3_m__2__motor_speed_2
        - c->r3_m__2__wheel_1 * r3_m__2__wheel_speed_2;

    /* khepera.bg:17: r3: error of order 1 */
    const real r3_e1 = c->bend2 * r3_n1;

    /* khepera.bg:17: r3: encoders, order 2 */
    const real r3_n2 = c->r3_w2_m__2__motor * r3_m__2__motor_speed_2
        + c->r3_w2_m__2__wheel * r3_m__2__wheel_speed_2;

    /* khepera.bg:17: r3: error of order 2 */
    const real r3_e2 = c->bend1 * r3_n2;

    /* khepera.bg:17: r3: encoders, order 3 */
    const real r3_n3 = -c->r3_w3_m__2__motor * r3_m__2__motor_speed_2
        - c->r3_w3_m__2__wheel * r3_m__2__wheel_speed_2;

    /* khepera.bg:17: r3: terms of order 0 */
    const real r3_g0 = s->U0__2 - c->r3_Fx__2 * s->Fx__2;

    /* khepera.bg:17: r3: terms of order 1 */
    const real r3_g1 = -c->r3_w1_Fx__2 * s->Fx__2;

    /* khepera.bg:17: r3: degree 1 */
    const real r3_d1 = r3_g1 + r3_n1 + r3_n2;

    /* khepera.bg:17: r3: error of order 0 */
    const real r3_e0 = c->bend3 * r3_g0;

    /* khepera.bg:17: r3: degree 2 */
    const real r3_d2 = r3_n2 + r3_n3 - r3_e1 - r3_e0;

    /* khepera.bg:17: r3: error of order 1 */
    const real r3_e1_2 = c->bend2 * r3_g1;

    /* khepera.bg:17: r3: degree 3 */
    const real r3_d3 = r3_n3 - r3_e1 - r3_e2 - r3_e1_2;

    /* khepera.bg:17: r3: input of stage 4 */
    const real r3_u4 = r3_g0 + r3_n1 + r3_d2 - r3_d1 - r3_d3 - r3_e2;

    /* khepera.bg:17: r3: stage 4, at rest */
    const real r3_y4 = r3_u4;

    /* khepera.bg:17: r3: stage 4: memory */
    x->r3_s4 = c->rest * r3_u4;

    /* khepera.bg:17: r3: input of stage 3 */
    const real r3_u3 = r3_y4 + r3_d1 + REAL(3.0) * r3_d3 + REAL(4.0) * r3_e2 - REAL(2.0) * r3_d2;

    /* khepera.bg:17: r3: stage 3, at rest */
    const real r3_y3 = r3_u3;

    /* khepera.bg:17: r3: stage 3: memory */
    x->r3_s3 = c->rest * r3_u3;

    /* khepera.bg:17: r3: input of stage 2 */
    const real r3_u2 = r3_y3 + r3_d2 - REAL(3.0) * r3_d3 - REAL(6.0) * r3_e2;

    /* khepera.bg:17: r3: stage 2, at rest */
    const real r3_y2 = r3_u2;

    /* khepera.bg:17: r3: stage 2: memory */
    x->r3_s2 = c->rest * r3_u2;

    /* khepera.bg:17: r3: input of stage 1 */
    const real r3_u1 = r3_y2 + r3_d3 + REAL(4.0) * r3_e2;

    /* khepera.bg:17: r3: stage 1, at rest */
    const real r3_y1 = r3_u1;

    /* khepera.bg:17: r3: stage 1: memory */
    x->r3_s1 = c->rest * r3_u1;

    /* khepera.bg:17: r3 = U0[2] - m[2].el.k*D(m[2].motor) - m[2].el.Re*m[2].el.k.e2/m[2].el.k -
     * m[2].el.L*D(m[2].el.k.e2)/m[2].el.k
     * where m[2].el.k.e2 = m[2].fe*D(m[2].motor) + m[2].Je*D(m[2].motor, 2) + (Fx[2]*m[2].R +
     * m[2].fs*D(m[2].wheel) + m[2].Js*D(m[2].wheel, 2))/m[2].ge.N */
    r[KHEPERA_ENCODERS_R3] = r3_y1 - r3_e2;
}

/* r3 on every further sample. */
static void next_r3(
    khepera_encoders_monitor *monitor, const khepera_encoders_samples *s, real *r)
{
    const khepera_encoders_coefficients *c = &monitor->c;
    khepera_encoders_memory *x = &monitor->x;
    const khepera_encoders_encoders *e = &monitor->e;

    count_on(&monitor->e.m__2__motor_r3, s->m__2__motor);
    count_on(&monitor->e.m__2__wheel_r3, s->m__2__wheel);

    /* khepera.bg:17: filtered speed of m[2].motor */
    const real r3_m__2__motor_speed_2 = c->a * x->r3_m__2__motor_speed
        + c->m__1__motor_gain * (real)e->m__2__motor_r3.increment;
    x->r3_m__2__motor_speed = r3_m__2__motor_speed_2;

    /* khepera.bg:17: filtered speed of m[2].wheel */
    const real r3_m__2__wheel_speed_2 = c->a * x->r3_m__2__wheel_speed
        + c->m__1__wheel_gain * (real)e->m__2__wheel_r3.increment;
    x->r3_m__2__wheel_speed = r3_m__2__wheel_speed_2;

    /* khepera.bg:17: r3: encoders, order 1 */
    const real r3_n1 = -c->r3_m__2__motor_1 * r3_m__2__motor_speed_2
        - c->r3_m__2__wheel_1 * r3_m__2__wheel_speed_2;

    /* khepera.bg:17: r3: error of order 1 */
    const real r3_e1 = c->bend2 * r3_n1;

    /* khepera.bg:17: r3: encoders, order 2 */
    const real r3_n2 = c->r3_w2_m__2__motor * r3_m__2__motor_speed_2
        + c->r3_w2_m__2__wheel * r3_m__2__wheel_speed_2;

    /* khepera.bg:17: r3: error of order 2 */
    const real r3_e2 = c->bend1 * r3_n2;

    /* khepera.bg:17: r3: encoders, order 3 */
    const real r3_n3 = -c->r3_w3_m__2__motor * r3_m__2__motor_speed_2
        - c->r3_w3_m__2__wheel * r3_m__2__wheel_speed_2;

    /* khepera.bg:17: r3: terms of order 0 */
    const real r3_g0 = s->U0__2 - c->r3_Fx__2 * s->Fx__2;

    /* khepera.bg:17: r3: terms of order 1 */
    const real r3_g1 = -c->r3_w1_Fx__2 * s->Fx__2;

    /* khepera.bg:17: r3: degree 1 */
    const real r3_d1 = r3_g1 + r3_n1 + r3_n2;

    /* khepera.bg:17: r3: error of order 0 */
    const real r3_e0 = c->bend3 * r3_g0;

    /* khepera.bg:17: r3: degree 2 */
    const real r3_d2 = r3_n2 + r3_n3 - r3_e1 - r3_e0;

    /* khepera.bg:17: r3: error of order 1 */
    const real r3_e1_2 = c->bend2 * r3_g1;

    /* khepera.bg:17: r3: degree 3 */
    const real r3_d3 = r3_n3 - r3_e1 - r3_e2 - r3_e1_2;

    /* khepera.bg:17: r3: input of stage 4 */
    const real r3_u4 = r3_g0 + r3_n1 + r3_d2 - r3_d1 - r3_d3 - r3_e2;

    /* khepera.bg:17: r3: stage 4 */
    const real r3_y4 = x->r3_s4 + c->b * r3_u4;

    /* khepera.bg:17: r3: stage 4: memory */
    x->r3_s4 = c->a * r3_y4 + c->b * r3_u4;

    /* khepera.bg:17: r3: input of stage 3 */
    const real r3_u3 = r3_y4 + r3_d1 + REAL(3.0) * r3_d3 + REAL(4.0) * r3_e2 - REAL(2.0) * r3_d2;

    /* khepera.bg:17: r3: stage 3 */
    const real r3_y3 = x->r3_s3 + c->b * r3_u3;

    /* khepera.bg:17: r3: stage 3: memory */
    x->r3_s3 = c->a * r3_y3 + c->b * r3_u3;

    /* khepera.bg:17: r3: input of stage 2 */
    const real r3_u2 = r3_y3 + r3_d2 - REAL(3.0) * r3_d3 - REAL(6.0) * r3_e2;

    /* khepera.bg:17: r3: stage 2 */
    const real r3_y2 = x->r3_s2 + c->b * r3_u2;

    /* khepera.bg:17: r3: stage 2: memory */
    x->r3_s2 = c->a * r3_y2 + c->b * r3_u2;

    /* khepera.bg:17: r3: input of stage 1 */
    const real r3_u1 = r3_y2 + r3_d3 + REAL(4.0) * r3_e2;

    /* khepera.bg:17: r3: stage 1 */
    const real r3_y1 = x->r3_s1 + c->b * r3_u1;

    /* khepera.bg:17: r3: stage 1: memory */
    x->r3_s1 = c->a * r3_y1 + c->b * r3_u1;

    /* khepera.bg:17: r3 = U0[2] - m[2].el.k*D(m[2].motor) - m[2].el.Re*m[2].el.k.e2/m[2].el.k -
     * m[2].el.L*D(m[2].el.k.e2)/m[2].el.k
     * where m[2].el.k.e2 = m[2].fe*D(m[2].motor) + m[2].Je*D(m[2].motor, 2) + (Fx[2]*m[2].R +
     * m[2].fs*D(m[2].wheel) + m[2].Js*D(m[2].wheel, 2))/m[2].ge.N */
    r[KHEPERA_ENCODERS_R3] = r3_y1 - r3_e2;
}

/* One sample for r3; a number that is not finite makes the next sample the first. */
static void run_r3(
    khepera_encoders_monitor *monitor, const khepera_encoders_samples *s, khepera_encoders_residuals *residuals)
{
    real *r = residuals->value;
    uint32_t age = monitor->age[2];

    if (age == 0u) {
        start_r3(monitor, s, r);
    } else {
        next_r3(monitor, s, r);
    }
    /* a sum is finite only if all its terms are */
    if (finite_number(s->Fx__2 + s->U0__2 + r[KHEPERA_ENCODERS_R3])) {
        age += age < UINT32_MAX ? 1u : 0u;
    } else {
        age = 0u;
        r[KHEPERA_ENCODERS_R3] = REAL(0.0);
    }
    monitor->age[2] = age;
    residuals->valid[KHEPERA_ENCODERS_R3] = age > monitor->settle[KHEPERA_ENCODERS_R3];
}

/* r4 on its first sample: the filter as if it had always been so. */
static void start_r4(
    khepera_encoders_monitor *monitor, const khepera_encoders_samples *s, real *r)
{
    const khepera_encoders_coefficients *c = &monitor->c;
    khepera_encoders_memory *x = &monitor->x;
    const khepera_encoders_encoders *e = &monitor->e;

    count_from(&monitor->e.m__2__motor_r4, s->m__2__motor);
    count_from(&monitor->e.m__2__wheel_r4, s->m__2__wheel);

    /* khepera_encoders.bg:31: m[2].wheel */
    const real r4_m__2__wheel = c->m__2__wheel__int__x0
        + REAL(9.587379924285257e-05) * (real)e->m__2__wheel_r4.total;

    /* khepera_encoders.bg:31: change of D(m[2].wheel) */
    x->r4_start = r4_m__2__wheel;
    const real r4_change = r4_m__2__wheel - x->r4_start;

    /* khepera_encoders.bg:31: m[2].motor */
    const real r4_m__2__motor = c->m__2__motor__int__x0
        + REAL(0.0015339807878856412) * (real)e->m__2__motor_r4.total;

    /* khepera_encoders.bg:31: change of D(m[2].motor) */
    x->r4_start_2 = r4_m__2__motor;
    const real r4_change_2 = r4_m__2__motor - x->r4_start_2;

    /* khepera_encoders.bg:31: tanh(Int(D(m[2].motor))/(4*m[2].tau0) - m[2].ge.N*Int(D( ... */
    const real r4_tanh = MATH(tanh)(c->g_3 * r4_change_2 - c->g_4 * r4_change);

    /* khepera_encoders.bg:31: filtered speed of m[2].wheel, at rest */
    const real r4_m__2__wheel_speed_2 = REAL(0.0);

    /* khepera_encoders.bg:31: filtered speed of m[2].wheel */
    x->r4_m__2__wheel_speed = r4_m__2__wheel_speed_2;

    /* khepera_encoders.bg:31: r4: encoders, order 1 */
    const real r4_n1 = c->r4_m__2__wheel_1 * r4_m__2__wheel_speed_2;

    /* khepera_encoders.bg:31: r4: error of order 1 */
    const real r4_e1 = c->bend1 * r4_n1;

    /* khepera_encoders.bg:31: r4: encoders, order 2 */
    const real r4_n2 = c->r4_w2_m__2__wheel * r4_m__2__wheel_speed_2;

    /* khepera_encoders.bg:31: r4: terms of order 0 */
    const real r4_g0 = c->r4_Fx__2 * s->Fx__2 + c->r4_integral_2 * r4_change
        - c->r4_integral * r4_change_2 - c->r4_tanh * r4_tanh;

    /* khepera_encoders.bg:31: r4: degree 1 */
    const real r4_d1 = r4_n1 + r4_n2;

    /* khepera_encoders.bg:31: r4: error of order 0 */
    const real r4_e0 = c->bend2 * r4_g0;

    /* khepera_encoders.bg:31: r4: degree 2 */
    const real r4_d2 = r4_n2 - r4_e1 - r4_e0;

    /* khepera_encoders.bg:31: r4: input of stage 3 */
    const real r4_u3 = r4_g0 + r4_n1 + r4_d2 + r4_e1 - r4_d1;

    /* khepera_encoders.bg:31: r4: stage 3, at rest */
    const real r4_y3 = r4_u3;

    /* khepera_encoders.bg:31: r4: stage 3: memory */
    x->r4_s3 = c->rest * r4_u3;

    /* khepera_encoders.bg:31: r4: input of stage 2 */
    const real r4_u2 = r4_y3 + r4_d1 - REAL(2.0) * r4_d2 - REAL(3.0) * r4_e1;

    /* khepera_encoders.bg:31: r4: stage 2, at rest */
    const real r4_y2 = r4_u2;

    /* khepera_encoders.bg:31: r4: stage 2: memory */
    x->r4_s2 = c->rest * r4_u2;

    /* khepera_encoders.bg:31: r4: input of stage 1 */
    const real r4_u1 = r4_y2 + r4_d2 + REAL(3.0) * r4_e1;

    /* khepera_encoders.bg:31: r4: stage 1, at rest */
    const real r4_y1 = r4_u1;

    /* khepera_encoders.bg:31: r4: stage 1: memory */
    x->r4_s1 = c->rest * r4_u1;

    /* khepera_encoders.bg:31: r4 = (Fx[2]*m[2].R + m[2].fs*D(m[2].wheel) + m[2].Js*D(m[2].wheel,
     * 2))/m[2].ge.N - m[2].K*(m[2].spring.q +
     * m[2].tau0*m[2].A*tanh(m[2].spring.q/(4*m[2].tau0)))
     * where m[2].spring.q = Int(D(m[2].motor) - m[2].ge.N*D(m[2].wheel)) */
    r[KHEPERA_ENCODERS_R4] = r4_y1 - r4_e1;
}

/* r4 on every further sample. */
static void next_r4(
    khepera_encoders_monitor *monitor, const khepera_encoders_samples *s, real *r)
{
    const khepera_encoders_coefficients *c = &monitor->c;
    khepera_encoders_memory *x = &monitor->x;
    const khepera_encoders_encoders *e = &monitor->e;

    count_on(&monitor->e.m__2__motor_r4, s->m__2__motor);
    count_on(&monitor->e.m__2__wheel_r4, s->m__2__wheel);

    /* khepera_encoders.bg:31: m[2].wheel */
    const real r4_m__2__wheel = c->m__2__wheel__int__x0
        + REAL(9.587379924285257e-05) * (real)e->m__2__wheel_r4.total;

    /* khepera_encoders.bg:31: change of D(m[2].wheel) */
    const real r4_change = r4_m__2__wheel - x->r4_start;

    /* khepera_encoders.bg:31: m[2].motor */
    const real r4_m__2__motor = c->m__2__motor__int__x0
        + REAL(0.0015339807878856412) * (real)e->m__2__motor_r4.total;

    /* khepera_encoders.bg:31: change of D(m[2].motor) */
    const real r4_change_2 = r4_m__2__motor - x->r4_start_2;

    /* khepera_encoders.bg:31: tanh(Int(D(m[2].motor))/(4*m[2].tau0) - m[2].ge.N*Int(D( ... */
    const real r4_tanh = MATH(tanh)(c->g_3 * r4_change_2 - c->g_4 * r4_change);

    /* khepera_encoders.bg:31: filtered speed of m[2].wheel */
    const real r4_m__2__wheel_speed_2 = c->a * x->r4_m__2__wheel_speed
        + c->m__1__wheel_gain * (real)e->m__2__wheel_r4.increment;
    x->r4_m__2__wheel_speed = r4_m__2__wheel_speed_2;

    /* khepera_encoders.bg:31: r4: encoders, order 1 */
    const real r4_n1 = c->r4_m__2__wheel_1 * r4_m__2__wheel_speed_2;

    /* khepera_encoders.bg:31: r4: error of order 1 */
    const real r4_e1 = c->bend1 * r4_n1;

    /* khepera_encoders.bg:31: r4: encoders, order 2 */
    const real r4_n2 = c->r4_w2_m__2__wheel * r4_m__2__wheel_speed_2;

    /* khepera_encoders.bg:31: r4: terms of order 0 */
    const real r4_g0 = c->r4_Fx__2 * s->Fx__2 + c->r4_integral_2 * r4_change
        - c->r4_integral * r4_change_2 - c->r4_tanh * r4_tanh;

    /* khepera_encoders.bg:31: r4: degree 1 */
    const real r4_d1 = r4_n1 + r4_n2;

    /* khepera_encoders.bg:31: r4: error of order 0 */
    const real r4_e0 = c->bend2 * r4_g0;

    /* khepera_encoders.bg:31: r4: degree 2 */
    const real r4_d2 = r4_n2 - r4_e1 - r4_e0;

    /* khepera_encoders.bg:31: r4: input of stage 3 */
    const real r4_u3 = r4_g0 + r4_n1 + r4_d2 + r4_e1 - r4_d1;

    /* khepera_encoders.bg:31: r4: stage 3 */
    const real r4_y3 = x->r4_s3 + c->b * r4_u3;

    /* khepera_encoders.bg:31: r4: stage 3: memory */
    x->r4_s3 = c->a * r4_y3 + c->b * r4_u3;

    /* khepera_encoders.bg:31: r4: input of stage 2 */
    const real r4_u2 = r4_y3 + r4_d1 - REAL(2.0) * r4_d2 - REAL(3.0) * r4_e1;

    /* khepera_encoders.bg:31: r4: stage 2 */
    const real r4_y2 = x->r4_s2 + c->b * r4_u2;

    /* khepera_encoders.bg:31: r4: stage 2: memory */
    x->r4_s2 = c->a * r4_y2 + c->b * r4_u2;

    /* khepera_encoders.bg:31: r4: input of stage 1 */
    const real r4_u1 = r4_y2 + r4_d2 + REAL(3.0) * r4_e1;

    /* khepera_encoders.bg:31: r4: stage 1 */
    const real r4_y1 = x->r4_s1 + c->b * r4_u1;

    /* khepera_encoders.bg:31: r4: stage 1: memory */
    x->r4_s1 = c->a * r4_y1 + c->b * r4_u1;

    /* khepera_encoders.bg:31: r4 = (Fx[2]*m[2].R + m[2].fs*D(m[2].wheel) + m[2].Js*D(m[2].wheel,
     * 2))/m[2].ge.N - m[2].K*(m[2].spring.q +
     * m[2].tau0*m[2].A*tanh(m[2].spring.q/(4*m[2].tau0)))
     * where m[2].spring.q = Int(D(m[2].motor) - m[2].ge.N*D(m[2].wheel)) */
    r[KHEPERA_ENCODERS_R4] = r4_y1 - r4_e1;
}

/* One sample for r4; a number that is not finite makes the next sample the first. */
static void run_r4(
    khepera_encoders_monitor *monitor, const khepera_encoders_samples *s, khepera_encoders_residuals *residuals)
{
    real *r = residuals->value;
    uint32_t age = monitor->age[3];

    if (age == 0u) {
        start_r4(monitor, s, r);
    } else {
        next_r4(monitor, s, r);
    }
    /* a sum is finite only if all its terms are */
    if (finite_number(s->Fx__2 + r[KHEPERA_ENCODERS_R4])) {
        age += age < UINT32_MAX ? 1u : 0u;
    } else {
        age = 0u;
        r[KHEPERA_ENCODERS_R4] = REAL(0.0);
    }
    monitor->age[3] = age;
    residuals->valid[KHEPERA_ENCODERS_R4] = age > monitor->settle[KHEPERA_ENCODERS_R4];
}

/* r5 on its first sample: the filter as if it had always been so. */
static void start_r5(
    khepera_encoders_monitor *monitor, const khepera_encoders_samples *s, real *r)
{
    const khepera_encoders_coefficients *c = &monitor->c;
    khepera_encoders_memory *x = &monitor->x;

    /* khepera.bg:114: r5: terms of order 0 */
    const real r5_g0 = s->Uin - s->Us - c->r5_load * s->load;

    /* khepera.bg:114: r5: degree 1 */
    const real r5_d1 = c->r5_w1_load * s->load;

    /* khepera.bg:114: r5: error of order 0 */
    const real r5_e0 = c->bend1 * r5_g0;

    /* khepera.bg:114: r5: input of stage 2 */
    const real r5_u2 = r5_g0 - r5_d1 - r5_e0;

    /* khepera.bg:114: r5: stage 2, at rest */
    const real r5_y2 = r5_u2;

    /* khepera.bg:114: r5: stage 2: memory */
    x->r5_s2 = c->rest * r5_u2;

    /* khepera.bg:114: r5: input of stage 1 */
    const real r5_u1 = r5_y2 + r5_d1 + REAL(2.0) * r5_e0;

    /* khepera.bg:114: r5: stage 1, at rest */
    const real r5_y1 = r5_u1;

    /* khepera.bg:114: r5: stage 1: memory */
    x->r5_s1 = c->rest * r5_u1;

    /* khepera.bg:114: r5 = Uin - line.cell[1].mid.e - R_L*line.cell[1].left.f/2 -
     * D(line.cell[1].left.f)/4000000
     * where line.cell[1].left.f = line.cell[1].right.f + 2.2e-10*D(line.cell[1].mid.e)
     * line.cell[1].mid.e = Us + R_L*line.cell[1].right.f/2 + D(line.cell[1].right.f)/4000000
     * line.cell[1].right.f = load + 2.2e-10*D(Us) */
    r[KHEPERA_ENCODERS_R5] = r5_y1 - r5_e0;
}

/* r5 on every further sample. */
static void next_r5(
    khepera_encoders_monitor *monitor, const khepera_encoders_samples *s, real *r)
{
    const khepera_encoders_coefficients *c = &monitor->c;
    khepera_encoders_memory *x = &monitor->x;

    /* khepera.bg:114: r5: terms of order 0 */
    const real r5_g0 = s->Uin - s->Us - c->r5_load * s->load;

    /* khepera.bg:114: r5: degree 1 */
    const real r5_d1 = c->r5_w1_load * s->load;

    /* khepera.bg:114: r5: error of order 0 */
    const real r5_e0 = c->bend1 * r5_g0;

    /* khepera.bg:114: r5: input of stage 2 */
    const real r5_u2 = r5_g0 - r5_d1 - r5_e0;

    /* khepera.bg:114: r5: stage 2 */
    const real r5_y2 = x->r5_s2 + c->b * r5_u2;

    /* khepera.bg:114: r5: stage 2: memory */
    x->r5_s2 = c->a * r5_y2 + c->b * r5_u2;

    /* khepera.bg:114: r5: input of stage 1 */
    const real r5_u1 = r5_y2 + r5_d1 + REAL(2.0) * r5_e0;

    /* khepera.bg:114: r5: stage 1 */
    const real r5_y1 = x->r5_s1 + c->b * r5_u1;

    /* khepera.bg:114: r5: stage 1: memory */
    x->r5_s1 = c->a * r5_y1 + c->b * r5_u1;

    /* khepera.bg:114: r5 = Uin - line.cell[1].mid.e - R_L*line.cell[1].left.f/2 -
     * D(line.cell[1].left.f)/4000000
     * where line.cell[1].left.f = line.cell[1].right.f + 2.2e-10*D(line.cell[1].mid.e)
     * line.cell[1].mid.e = Us + R_L*line.cell[1].right.f/2 + D(line.cell[1].right.f)/4000000
     * line.cell[1].right.f = load + 2.2e-10*D(Us) */
    r[KHEPERA_ENCODERS_R5] = r5_y1 - r5_e0;
}

/* One sample for r5; a number that is not finite makes the next sample the first. */
static void run_r5(
    khepera_encoders_monitor *monitor, const khepera_encoders_samples *s, khepera_encoders_residuals *residuals)
{
    real *r = residuals->value;
    uint32_t age = monitor->age[4];

    if (age == 0u) {
        start_r5(monitor, s, r);
    } else {
        next_r5(monitor, s, r);
    }
    /* a sum is finite only if all its terms are */
    if (finite_number(s->load + s->Uin + s->Us + r[KHEPERA_ENCODERS_R5])) {
        age += age < UINT32_MAX ? 1u : 0u;
    } else {
        age = 0u;
        r[KHEPERA_ENCODERS_R5] = REAL(0.0);
    }
    monitor->age[4] = age;
    residuals->valid[KHEPERA_ENCODERS_R5] = age > monitor->settle[KHEPERA_ENCODERS_R5];
}

void khepera_encoders_reset(khepera_encoders_monitor *monitor)
{
    int k;

    for (k = 0; k < 5; ++k) {
        monitor->age[k] = 0u;
    }
}

void khepera_encoders_step(
    khepera_encoders_monitor *monitor,
    const khepera_encoders_samples *samples,
    khepera_encoders_residuals *residuals)
{
    run_r1(monitor, samples, residuals);
    run_r2(monitor, samples, residuals);
    run_r3(monitor, samples, residuals);
    run_r4(monitor, samples, residuals);
    run_r5(monitor, samples, residuals);
}

const char khepera_encoders_fault_name[KHEPERA_ENCODERS_FAULTS][11] = {
    "m[1].Je", "m[1].fe", "m[1].el.L", "m[1].el.Re", "m[1].el.k", "U0[1]", "m[1].Js", "m[1].fs",
    "m[1].R", "m[1].ge.N", "Fx[1]", "m[1].motor", "m[1].wheel", "m[1].K", "m[1].tau0", "m[2].Je",
    "m[2].fe", "m[2].el.L", "m[2].el.Re", "m[2].el.k", "U0[2]", "m[2].Js", "m[2].fs", "m[2].R",
    "m[2].ge.N", "Fx[2]", "m[2].motor", "m[2].wheel", "m[2].K", "m[2].tau0", "R_L", "load", "Uin",
    "Us",
};

const uint16_t khepera_encoders_fault_class[KHEPERA_ENCODERS_FAULTS] = {
    0u, 0u, 0u, 0u, 0u, 0u, 1u, 1u, 1u, 1u, 1u, 1u, 1u, 2u, 2u, 3u, 3u, 3u, 3u, 3u, 3u, 4u, 4u, 4u,
    4u, 4u, 4u, 4u, 5u, 5u, 6u, 6u, 6u, 6u,
};

const char khepera_encoders_residual_name[KHEPERA_ENCODERS_RESIDUALS][3] = {
    "r1", "r2", "r3", "r4", "r5",
};

/* Signatures: 1 where a residual may be moved by the faults of a class, 3 where it is for sure. */
static const uint8_t signature[KHEPERA_ENCODERS_CLASSES][KHEPERA_ENCODERS_RESIDUALS] = {
    {3u, 0u, 0u, 0u, 0u},
    {3u, 3u, 0u, 0u, 0u},
    {0u, 3u, 0u, 0u, 0u},
    {0u, 0u, 3u, 0u, 0u},
    {0u, 0u, 3u, 3u, 0u},
    {0u, 0u, 0u, 3u, 0u},
    {0u, 0u, 0u, 0u, 3u},
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
    khepera_encoders_diagnosis *d, const khepera_encoders_limit *limit, int k, real off, real out, real bound)
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

static bool sums_are_zero(const khepera_encoders_diagnosis *d, int k)
{
    const real sum = d->above[k] + d->below[k] + d->louder[k];

    return !(sum > REAL(0.0));
}

static void forget_sums(khepera_encoders_diagnosis *d, int k)
{
    d->above[k] = REAL(0.0);
    d->below[k] = REAL(0.0);
    d->louder[k] = REAL(0.0);
    d->streak[k] = 0u;
}

/* Residual k in one sample; whether it goes into alarm. */
static bool watch(
    khepera_encoders_diagnosis *d, const khepera_encoders_limit *limit, int k, real value, real bound, bool row)
{
    const real off = value - limit->mean;
    const real out = (off < REAL(0.0) ? -off : off) - bound;
    bool high = false;

    if (row) {
        high = add_row(d, limit, k, off, out, bound);
    }
    if (d->state[k] == KHEPERA_ENCODERS_ALARM) {
        d->since[k] += d->since[k] < UINT32_MAX ? 1u : 0u;
        if (!(out < RELEASE * limit->level) || !sums_are_zero(d, k)) {
            d->quiet = 0u;
        }
        return false;
    }
    d->state[k] = KHEPERA_ENCODERS_HEALTHY;
    d->streak[k] = out > limit->level ? d->streak[k] + 1u : 0u;
    if (d->streak[k] < d->least && !high) {
        return false;
    }
    d->state[k] = KHEPERA_ENCODERS_ALARM;
    d->since[k] = 0u;
    return true;
}

/* What is left of a class of faults. */
static khepera_encoders_candidate left_of(const khepera_encoders_diagnosis *d, const uint8_t *own)
{
    khepera_encoders_candidate found = KHEPERA_ENCODERS_LIKELY;
    int k;

    for (k = 0; k < KHEPERA_ENCODERS_RESIDUALS; ++k) {
        if (d->state[k] == KHEPERA_ENCODERS_ALARM && own[k] == 0u) {
            return KHEPERA_ENCODERS_RULED_OUT;
        }
        if (d->state[k] == KHEPERA_ENCODERS_HEALTHY && own[k] == 3u) {
            found = KHEPERA_ENCODERS_SMALL;
        }
    }
    return found;
}

/* Which classes of faults the residuals leave, and the one if it is one. */
static void judge(khepera_encoders_diagnosis *d)
{
    int likely = 0;
    int c;

    d->fault_class = KHEPERA_ENCODERS_UNKNOWN;
    for (c = 0; c < KHEPERA_ENCODERS_CLASSES; ++c) {
        const khepera_encoders_candidate left = left_of(d, signature[c]);

        d->candidate[c] = (uint8_t)left;
        if (left == KHEPERA_ENCODERS_LIKELY) {
            d->fault_class = (int16_t)c;
            ++likely;
        }
    }
    if (likely != 1 || d->settled < 2u * d->row) {
        d->fault_class = KHEPERA_ENCODERS_UNKNOWN;
    }
}

khepera_encoders_limit khepera_encoders_limit_of(khepera_encoders_real level)
{
    khepera_encoders_limit limit;

    limit.mean = REAL(0.0);
    limit.level = level;
    limit.unit = REAL(0.0);
    limit.loud = REAL(0.0);
    limit.drift = REAL(0.5);
    limit.height = NEVER;
    limit.bound = REAL(0.0);
    return limit;
}

void khepera_encoders_clear(khepera_encoders_diagnosis *diagnosis)
{
    int k;

    for (k = 0; k < KHEPERA_ENCODERS_RESIDUALS; ++k) {
        if (diagnosis->state[k] == KHEPERA_ENCODERS_ALARM) {
            diagnosis->state[k] = KHEPERA_ENCODERS_HEALTHY;
        }
        diagnosis->since[k] = 0u;
        forget_sums(diagnosis, k);
    }
    for (k = 0; k < KHEPERA_ENCODERS_CLASSES; ++k) {
        diagnosis->candidate[k] = KHEPERA_ENCODERS_RULED_OUT;
    }
    diagnosis->fault_class = KHEPERA_ENCODERS_UNKNOWN;
    diagnosis->quiet = 0u;
    diagnosis->settled = 0u;
}

void khepera_encoders_diagnosis_reset(khepera_encoders_diagnosis *diagnosis)
{
    int k;

    diagnosis->row = KHEPERA_ENCODERS_ROW;
    diagnosis->least = 15u;
    diagnosis->hold = 10u * KHEPERA_ENCODERS_ROW;
    diagnosis->latch = false;
    diagnosis->tick = 0u;
    for (k = 0; k < KHEPERA_ENCODERS_RESIDUALS; ++k) {
        diagnosis->state[k] = KHEPERA_ENCODERS_BLIND;
    }
    khepera_encoders_clear(diagnosis);
}

bool khepera_encoders_diagnose(
    khepera_encoders_diagnosis *diagnosis,
    const khepera_encoders_limit *limits,
    const khepera_encoders_real *bounds,
    const khepera_encoders_residuals *residuals)
{
    khepera_encoders_diagnosis *d = diagnosis;
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
    for (k = 0; k < KHEPERA_ENCODERS_RESIDUALS; ++k) {
        if (residuals->valid[k]) {
            const real bound = bounds ? bounds[k] : limits[k].bound;

            fresh = watch(d, &limits[k], k, residuals->value[k], bound, row) || fresh;
        } else {
            forget_sums(d, k);
            if (d->state[k] == KHEPERA_ENCODERS_ALARM) {
                d->quiet = 0u; /* nobody knows that it is over */
            } else {
                d->state[k] = KHEPERA_ENCODERS_BLIND;
            }
        }
        alarm = alarm || d->state[k] == KHEPERA_ENCODERS_ALARM;
    }
    if (fresh) {
        d->quiet = 0u;
        d->settled = 0u;
    }
    if (alarm && !d->latch && d->quiet >= d->hold) {
        khepera_encoders_clear(d);
        return false;
    }
    if (fresh || (alarm && row)) {
        judge(d);
    }
    return alarm;
}
