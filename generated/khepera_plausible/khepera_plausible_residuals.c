/* khepera_plausible_residuals.c: the residuals of KheperaPlausible; generated, see the header. */
#include "khepera_plausible_residuals.h"

#include <math.h>

#if defined __FINITE_MATH_ONLY__ && __FINITE_MATH_ONLY__
#error "this code tells numbers from NaN: compile it without -ffinite-math-only (-ffast-math)"
#endif

typedef khepera_plausible_real real;

#define REAL(x) KHEPERA_PLAUSIBLE_CONSTANT(x)
#if defined KHEPERA_PLAUSIBLE_FLOAT && !defined KHEPERA_PLAUSIBLE_REAL
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

uint32_t khepera_plausible_abi(void)
{
    return KHEPERA_PLAUSIBLE_ABI;
}

const char *khepera_plausible_digest(void)
{
    return KHEPERA_PLAUSIBLE_DIGEST;
}

void khepera_plausible_nominal(khepera_plausible_parameters *parameters)
{
    parameters->Js__1 = REAL(1.0e-05);                /* kg.m^2 */
    parameters->Js__2 = REAL(1.0e-05);                /* kg.m^2 */
    parameters->fe__1 = REAL(1.0e-07);                /* N.m.s/rad */
    parameters->fe__2 = REAL(1.0e-07);                /* N.m.s/rad */
    parameters->R__1 = REAL(0.008);                   /* m */
    parameters->R__2 = REAL(0.008);                   /* m */
    parameters->RL = REAL(0.85);                      /* Ohm */
    parameters->LL = REAL(5.0e-07);                   /* H */
    parameters->CL = REAL(2.2e-10);                   /* F */
    parameters->robot__m__1__tau0 = REAL(0.01);       /* rad */
    parameters->robot__m__1__A = -REAL(4.0);          /* 1 */
    parameters->robot__m__1__el__L = REAL(0.0003);    /* H */
    parameters->robot__m__1__el__Re = REAL(17.6);     /* Ohm */
    parameters->robot__m__1__el__k = REAL(0.00351);   /* N.m/A */
    parameters->robot__m__1__me__Je = REAL(1.4e-08);  /* kg.m^2 */
    parameters->robot__m__1__me__K = REAL(0.1);       /* N.m/rad */
    parameters->robot__m__1__ge__N = REAL(25.0);      /* 1 */
    parameters->robot__m__1__wh__fs = REAL(0.0003);   /* N.m.s/rad */
    parameters->robot__m__2__tau0 = REAL(0.01);       /* rad */
    parameters->robot__m__2__A = -REAL(4.0);          /* 1 */
    parameters->robot__m__2__el__L = REAL(0.0003);    /* H */
    parameters->robot__m__2__el__Re = REAL(17.6);     /* Ohm */
    parameters->robot__m__2__el__k = REAL(0.00351);   /* N.m/A */
    parameters->robot__m__2__me__Je = REAL(1.4e-08);  /* kg.m^2 */
    parameters->robot__m__2__me__K = REAL(0.1);       /* N.m/rad */
    parameters->robot__m__2__ge__N = REAL(25.0);      /* 1 */
    parameters->robot__m__2__wh__fs = REAL(0.0003);   /* N.m.s/rad */
}

/* The coefficients of exact and of the filter, from the parameters. */
static void compute_coefficients(khepera_plausible_monitor *monitor,
        const khepera_plausible_parameters *p, real sample_time, real bandwidth)
{
    khepera_plausible_coefficients *c = &monitor->c;

    /* bandwidth*sample_time */
    const real x_ = bandwidth * sample_time;

    /* of a stage: what is left of its memory */
    const real pole = greatest(REAL(2.0) - x_, REAL(0.0)) / (x_ + REAL(2.0));

    /* w*sample_time, x or 2 */
    const real turn = REAL(2.0) * (REAL(1.0) - pole) / (pole + REAL(1.0));

    /* w of the filter 1/(1 + D/w) */
    const real w = turn / sample_time;

    /* khepera.bg:17: fe[1]*robot.m[1].el.L/robot.m[1].el.k */
    const real t = p->fe__1 * p->robot__m__1__el__L / p->robot__m__1__el__k;

    /* khepera.bg:17: robot.m[1].el.L*robot.m[1].wh.fs/(robot.m[1].ge.N*robot.m[1].el.k) */
    const real t_2 = p->robot__m__1__el__L * p->robot__m__1__wh__fs / p->robot__m__1__ge__N
            / p->robot__m__1__el__k;

    /* khepera.bg:17: robot.m[1].el.Re*robot.m[1].me.Je/robot.m[1].el.k */
    const real t_3 = p->robot__m__1__el__Re * p->robot__m__1__me__Je / p->robot__m__1__el__k;

    /* khepera.bg:17: Js[1]*robot.m[1].el.Re/(robot.m[1].ge.N*robot.m[1].el.k) */
    const real t_4 = p->Js__1 * p->robot__m__1__el__Re / p->robot__m__1__ge__N
            / p->robot__m__1__el__k;

    /* khepera.bg:17: fe[2]*robot.m[2].el.L/robot.m[2].el.k */
    const real t_5 = p->fe__2 * p->robot__m__2__el__L / p->robot__m__2__el__k;

    /* khepera.bg:17: robot.m[2].el.L*robot.m[2].wh.fs/(robot.m[2].ge.N*robot.m[2].el.k) */
    const real t_6 = p->robot__m__2__el__L * p->robot__m__2__wh__fs / p->robot__m__2__ge__N
            / p->robot__m__2__el__k;

    /* khepera.bg:17: robot.m[2].el.Re*robot.m[2].me.Je/robot.m[2].el.k */
    const real t_7 = p->robot__m__2__el__Re * p->robot__m__2__me__Je / p->robot__m__2__el__k;

    /* khepera.bg:17: Js[2]*robot.m[2].el.Re/(robot.m[2].ge.N*robot.m[2].el.k) */
    const real t_8 = p->Js__2 * p->robot__m__2__el__Re / p->robot__m__2__ge__N
            / p->robot__m__2__el__k;

    /* 1 - pole */
    const real t_9 = REAL(1.0) - pole;

    /* turn^2 */
    const real t_10 = turn * turn;

    /* khepera.bg:17: r1: factor of robot.m[1].me.we: robot.m[1].el.k +
     * fe[1]*robot.m[1].el.Re/robot.m[1].el.k */
    c->r1_robot__m__1__me__we = p->robot__m__1__el__k
        + p->fe__1 * p->robot__m__1__el__Re / p->robot__m__1__el__k;

    /* khepera.bg:17: r1: factor of robot.m[1].me.we': fe[1]*robot.m[1].el.L/robot.m[1].el.k +
     * robot.m[1].el.Re*robot.m[1].me.Je/robot.m[1].el.k */
    c->r1_robot__m__1__me__we_1 = t + t_3;

    /* khepera.bg:17: r1: factor of robot.m[1].me.we'':
     * robot.m[1].el.L*robot.m[1].me.Je/robot.m[1].el.k */
    c->r1_robot__m__1__me__we_2 = p->robot__m__1__el__L * p->robot__m__1__me__Je
            / p->robot__m__1__el__k;

    /* khepera.bg:17: r1: factor of robot.m[1].wh.ws:
     * robot.m[1].el.Re*robot.m[1].wh.fs/(robot.m[1].ge.N*robot.m[1].el.k) */
    c->r1_robot__m__1__wh__ws = p->robot__m__1__el__Re * p->robot__m__1__wh__fs
            / p->robot__m__1__ge__N / p->robot__m__1__el__k;

    /* khepera.bg:17: r1: factor of robot.m[1].wh.ws':
     * robot.m[1].el.L*robot.m[1].wh.fs/(robot.m[1].ge.N*robot.m[1].el.k) + Js[1]*robot.m[1]. ... */
    c->r1_robot__m__1__wh__ws_1 = t_2 + t_4;

    /* khepera.bg:17: r1: factor of robot.m[1].wh.ws'':
     * Js[1]*robot.m[1].el.L/(robot.m[1].ge.N*robot.m[1].el.k) */
    c->r1_robot__m__1__wh__ws_2 = p->Js__1 * p->robot__m__1__el__L / p->robot__m__1__ge__N
            / p->robot__m__1__el__k;

    /* khepera.bg:17: r1: factor of robot.Fx[1]:
     * R[1]*robot.m[1].el.Re/(robot.m[1].ge.N*robot.m[1].el.k) */
    c->r1_robot__Fx__1 = p->R__1 * p->robot__m__1__el__Re / p->robot__m__1__ge__N
            / p->robot__m__1__el__k;

    /* khepera.bg:17: r1: factor of robot.Fx[1]':
     * R[1]*robot.m[1].el.L/(robot.m[1].ge.N*robot.m[1].el.k) */
    c->r1_robot__Fx__1_1 = p->R__1 * p->robot__m__1__el__L / p->robot__m__1__ge__N
            / p->robot__m__1__el__k;

    /* khepera.bg:17: r1: factor of robot.m[1].me.we' */
    c->r1_w1_robot__m__1__me__we = (-t - t_3) * w;

    /* khepera.bg:17: r1: factor of robot.m[1].me.we'' */
    c->r1_w2_robot__m__1__me__we = p->robot__m__1__el__L * p->robot__m__1__me__Je * w * w
            / p->robot__m__1__el__k;

    /* khepera.bg:17: r1: factor of robot.m[1].wh.ws' */
    c->r1_w1_robot__m__1__wh__ws = (-t_2 - t_4) * w;

    /* khepera.bg:17: r1: factor of robot.m[1].wh.ws'' */
    c->r1_w2_robot__m__1__wh__ws = p->Js__1 * p->robot__m__1__el__L * w * w / p->robot__m__1__ge__N
            / p->robot__m__1__el__k;

    /* khepera.bg:17: r1: factor of robot.Fx[1]' */
    c->r1_w1_robot__Fx__1 = p->R__1 * p->robot__m__1__el__L * w / p->robot__m__1__ge__N
            / p->robot__m__1__el__k;

    /* filter: 2 * (w*sample_time)^2/12 */
    c->bend2 = t_10 / REAL(6.0);

    /* filter: 1 * (w*sample_time)^2/12 */
    c->bend1 = t_10 / REAL(12.0);

    /* filter: what is left of a memory a sample later */
    c->a = pole;

    /* filter: weight of a sample, new and a sample later */
    c->b = REAL(0.5) * t_9;

    /* filter: 1 - b, the memory of a constant 1 */
    c->rest = REAL(1.0) - REAL(0.5) * t_9;

    /* khepera.bg:41: 1/(4*robot.m[1].tau0) */
    c->g = REAL(0.25) / p->robot__m__1__tau0;

    /* khepera.bg:41: robot.m[1].ge.N/(4*robot.m[1].tau0) */
    c->g_2 = REAL(0.25) * p->robot__m__1__ge__N / p->robot__m__1__tau0;

    /* khepera.bg:41: r2: factor of robot.m[1].wh.ws: robot.m[1].ge.N */
    c->r2_robot__m__1__wh__ws = p->robot__m__1__ge__N;

    /* khepera.bg:41: r2: factor of robot.m[1].wh.ws':
     * robot.m[1].wh.fs/(robot.m[1].ge.N*robot.m[1].me.K) */
    c->r2_robot__m__1__wh__ws_1 = p->robot__m__1__wh__fs / p->robot__m__1__ge__N
            / p->robot__m__1__me__K;

    /* khepera.bg:41: r2: factor of robot.m[1].wh.ws'': Js[1]/(robot.m[1].ge.N*robot.m[1].me.K) */
    c->r2_robot__m__1__wh__ws_2 = p->Js__1 / p->robot__m__1__ge__N / p->robot__m__1__me__K;

    /* khepera.bg:41: r2: factor of robot.Fx[1]': R[1]/(robot.m[1].ge.N*robot.m[1].me.K) */
    c->r2_robot__Fx__1_1 = p->R__1 / p->robot__m__1__ge__N / p->robot__m__1__me__K;

    /* khepera.bg:41: r2: factor of D(tanh(Int(robot.m[1].me.we)/(4*robot.m[1].tau0) - robot.m
     * ...): robot.m[1].tau0*robot.m[1].A */
    c->r2_tanh_1 = p->robot__m__1__tau0 * p->robot__m__1__A;

    /* half the sample time */
    c->half_time = REAL(0.5) * sample_time;

    /* sample_time/24 */
    c->half_twelfth = sample_time / REAL(24.0);

    /* khepera.bg:41: r2: factor of robot.m[1].wh.ws' */
    c->r2_w1_robot__m__1__wh__ws = p->robot__m__1__wh__fs * w / p->robot__m__1__ge__N
            / p->robot__m__1__me__K;

    /* khepera.bg:41: r2: factor of robot.m[1].wh.ws'' */
    c->r2_w2_robot__m__1__wh__ws = p->Js__1 * w * w / p->robot__m__1__ge__N / p->robot__m__1__me__K;

    /* khepera.bg:41: r2: factor of robot.Fx[1]' */
    c->r2_w1_robot__Fx__1 = p->R__1 * w / p->robot__m__1__ge__N / p->robot__m__1__me__K;

    /* khepera.bg:41: r2: factor of D(tanh(Int(robot.m[1].me.we)/(4*robot.m[1].tau0) - robot.m
     * ...) */
    c->r2_w1_tanh = p->robot__m__1__tau0 * p->robot__m__1__A * w;

    /* khepera.bg:17: r3: factor of robot.m[2].me.we: robot.m[2].el.k +
     * fe[2]*robot.m[2].el.Re/robot.m[2].el.k */
    c->r3_robot__m__2__me__we = p->robot__m__2__el__k
        + p->fe__2 * p->robot__m__2__el__Re / p->robot__m__2__el__k;

    /* khepera.bg:17: r3: factor of robot.m[2].me.we': fe[2]*robot.m[2].el.L/robot.m[2].el.k +
     * robot.m[2].el.Re*robot.m[2].me.Je/robot.m[2].el.k */
    c->r3_robot__m__2__me__we_1 = t_5 + t_7;

    /* khepera.bg:17: r3: factor of robot.m[2].me.we'':
     * robot.m[2].el.L*robot.m[2].me.Je/robot.m[2].el.k */
    c->r3_robot__m__2__me__we_2 = p->robot__m__2__el__L * p->robot__m__2__me__Je
            / p->robot__m__2__el__k;

    /* khepera.bg:17: r3: factor of robot.m[2].wh.ws:
     * robot.m[2].el.Re*robot.m[2].wh.fs/(robot.m[2].ge.N*robot.m[2].el.k) */
    c->r3_robot__m__2__wh__ws = p->robot__m__2__el__Re * p->robot__m__2__wh__fs
            / p->robot__m__2__ge__N / p->robot__m__2__el__k;

    /* khepera.bg:17: r3: factor of robot.m[2].wh.ws':
     * robot.m[2].el.L*robot.m[2].wh.fs/(robot.m[2].ge.N*robot.m[2].el.k) + Js[2]*robot.m[2]. ... */
    c->r3_robot__m__2__wh__ws_1 = t_6 + t_8;

    /* khepera.bg:17: r3: factor of robot.m[2].wh.ws'':
     * Js[2]*robot.m[2].el.L/(robot.m[2].ge.N*robot.m[2].el.k) */
    c->r3_robot__m__2__wh__ws_2 = p->Js__2 * p->robot__m__2__el__L / p->robot__m__2__ge__N
            / p->robot__m__2__el__k;

    /* khepera.bg:17: r3: factor of robot.Fx[2]:
     * R[2]*robot.m[2].el.Re/(robot.m[2].ge.N*robot.m[2].el.k) */
    c->r3_robot__Fx__2 = p->R__2 * p->robot__m__2__el__Re / p->robot__m__2__ge__N
            / p->robot__m__2__el__k;

    /* khepera.bg:17: r3: factor of robot.Fx[2]':
     * R[2]*robot.m[2].el.L/(robot.m[2].ge.N*robot.m[2].el.k) */
    c->r3_robot__Fx__2_1 = p->R__2 * p->robot__m__2__el__L / p->robot__m__2__ge__N
            / p->robot__m__2__el__k;

    /* khepera.bg:17: r3: factor of robot.m[2].me.we' */
    c->r3_w1_robot__m__2__me__we = (-t_5 - t_7) * w;

    /* khepera.bg:17: r3: factor of robot.m[2].me.we'' */
    c->r3_w2_robot__m__2__me__we = p->robot__m__2__el__L * p->robot__m__2__me__Je * w * w
            / p->robot__m__2__el__k;

    /* khepera.bg:17: r3: factor of robot.m[2].wh.ws' */
    c->r3_w1_robot__m__2__wh__ws = (-t_6 - t_8) * w;

    /* khepera.bg:17: r3: factor of robot.m[2].wh.ws'' */
    c->r3_w2_robot__m__2__wh__ws = p->Js__2 * p->robot__m__2__el__L * w * w / p->robot__m__2__ge__N
            / p->robot__m__2__el__k;

    /* khepera.bg:17: r3: factor of robot.Fx[2]' */
    c->r3_w1_robot__Fx__2 = p->R__2 * p->robot__m__2__el__L * w / p->robot__m__2__ge__N
            / p->robot__m__2__el__k;

    /* khepera.bg:41: 1/(4*robot.m[2].tau0) */
    c->g_3 = REAL(0.25) / p->robot__m__2__tau0;

    /* khepera.bg:41: robot.m[2].ge.N/(4*robot.m[2].tau0) */
    c->g_4 = REAL(0.25) * p->robot__m__2__ge__N / p->robot__m__2__tau0;

    /* khepera.bg:41: r4: factor of robot.m[2].wh.ws: robot.m[2].ge.N */
    c->r4_robot__m__2__wh__ws = p->robot__m__2__ge__N;

    /* khepera.bg:41: r4: factor of robot.m[2].wh.ws':
     * robot.m[2].wh.fs/(robot.m[2].ge.N*robot.m[2].me.K) */
    c->r4_robot__m__2__wh__ws_1 = p->robot__m__2__wh__fs / p->robot__m__2__ge__N
            / p->robot__m__2__me__K;

    /* khepera.bg:41: r4: factor of robot.m[2].wh.ws'': Js[2]/(robot.m[2].ge.N*robot.m[2].me.K) */
    c->r4_robot__m__2__wh__ws_2 = p->Js__2 / p->robot__m__2__ge__N / p->robot__m__2__me__K;

    /* khepera.bg:41: r4: factor of robot.Fx[2]': R[2]/(robot.m[2].ge.N*robot.m[2].me.K) */
    c->r4_robot__Fx__2_1 = p->R__2 / p->robot__m__2__ge__N / p->robot__m__2__me__K;

    /* khepera.bg:41: r4: factor of D(tanh(Int(robot.m[2].me.we)/(4*robot.m[2].tau0) - robot.m
     * ...): robot.m[2].tau0*robot.m[2].A */
    c->r4_tanh_1 = p->robot__m__2__tau0 * p->robot__m__2__A;

    /* khepera.bg:41: r4: factor of robot.m[2].wh.ws' */
    c->r4_w1_robot__m__2__wh__ws = p->robot__m__2__wh__fs * w / p->robot__m__2__ge__N
            / p->robot__m__2__me__K;

    /* khepera.bg:41: r4: factor of robot.m[2].wh.ws'' */
    c->r4_w2_robot__m__2__wh__ws = p->Js__2 * w * w / p->robot__m__2__ge__N / p->robot__m__2__me__K;

    /* khepera.bg:41: r4: factor of robot.Fx[2]' */
    c->r4_w1_robot__Fx__2 = p->R__2 * w / p->robot__m__2__ge__N / p->robot__m__2__me__K;

    /* khepera.bg:41: r4: factor of D(tanh(Int(robot.m[2].me.we)/(4*robot.m[2].tau0) - robot.m
     * ...) */
    c->r4_w1_tanh = p->robot__m__2__tau0 * p->robot__m__2__A * w;

    /* khepera.bg:114: r5: factor of robot.Us': 1.5*RL*CL */
    c->r5_robot__Us_1 = REAL(1.5) * p->RL * p->CL;

    /* khepera.bg:114: r5: factor of robot.Us'': 1.5*LL*CL + RL^2*CL^2/4 */
    c->r5_robot__Us_2 = REAL(1.5) * p->LL * p->CL + REAL(0.25) * p->RL * p->RL * p->CL * p->CL;

    /* khepera.bg:114: r5: factor of robot.Us''': RL*LL*CL^2/2 */
    c->r5_robot__Us_3 = REAL(0.5) * p->RL * p->LL * p->CL * p->CL;

    /* khepera.bg:114: r5: factor of D(robot.Us, 4): LL^2*CL^2/4 */
    c->r5_robot__Us_4 = REAL(0.25) * p->LL * p->LL * p->CL * p->CL;
}

static bool parameters_are_finite(const khepera_plausible_parameters *p)
{
    return finite_number(p->Js__1 + p->Js__2 + p->fe__1 + p->fe__2 + p->R__1 + p->R__2 + p->RL
            + p->LL + p->CL + p->robot__m__1__tau0 + p->robot__m__1__A + p->robot__m__1__el__L
            + p->robot__m__1__el__Re + p->robot__m__1__el__k + p->robot__m__1__me__Je
            + p->robot__m__1__me__K + p->robot__m__1__ge__N + p->robot__m__1__wh__fs
            + p->robot__m__2__tau0 + p->robot__m__2__A + p->robot__m__2__el__L
            + p->robot__m__2__el__Re + p->robot__m__2__el__k + p->robot__m__2__me__Je
            + p->robot__m__2__me__K + p->robot__m__2__ge__N + p->robot__m__2__wh__fs);
}

static bool coefficients_are_finite(const khepera_plausible_monitor *monitor)
{
    return finite_number(monitor->c.r1_robot__m__1__me__we + monitor->c.r1_robot__m__1__me__we_1
            + monitor->c.r1_robot__m__1__me__we_2 + monitor->c.r1_robot__m__1__wh__ws
            + monitor->c.r1_robot__m__1__wh__ws_1 + monitor->c.r1_robot__m__1__wh__ws_2
            + monitor->c.r1_robot__Fx__1 + monitor->c.r1_robot__Fx__1_1
            + monitor->c.r1_w1_robot__m__1__me__we + monitor->c.r1_w2_robot__m__1__me__we
            + monitor->c.r1_w1_robot__m__1__wh__ws + monitor->c.r1_w2_robot__m__1__wh__ws
            + monitor->c.r1_w1_robot__Fx__1 + monitor->c.bend2 + monitor->c.bend1 + monitor->c.a
            + monitor->c.b + monitor->c.rest + monitor->c.g + monitor->c.g_2
            + monitor->c.r2_robot__m__1__wh__ws + monitor->c.r2_robot__m__1__wh__ws_1
            + monitor->c.r2_robot__m__1__wh__ws_2 + monitor->c.r2_robot__Fx__1_1
            + monitor->c.r2_tanh_1 + monitor->c.half_time + monitor->c.half_twelfth
            + monitor->c.r2_w1_robot__m__1__wh__ws + monitor->c.r2_w2_robot__m__1__wh__ws
            + monitor->c.r2_w1_robot__Fx__1 + monitor->c.r2_w1_tanh
            + monitor->c.r3_robot__m__2__me__we + monitor->c.r3_robot__m__2__me__we_1
            + monitor->c.r3_robot__m__2__me__we_2 + monitor->c.r3_robot__m__2__wh__ws
            + monitor->c.r3_robot__m__2__wh__ws_1 + monitor->c.r3_robot__m__2__wh__ws_2
            + monitor->c.r3_robot__Fx__2 + monitor->c.r3_robot__Fx__2_1
            + monitor->c.r3_w1_robot__m__2__me__we + monitor->c.r3_w2_robot__m__2__me__we
            + monitor->c.r3_w1_robot__m__2__wh__ws + monitor->c.r3_w2_robot__m__2__wh__ws
            + monitor->c.r3_w1_robot__Fx__2 + monitor->c.g_3 + monitor->c.g_4
            + monitor->c.r4_robot__m__2__wh__ws + monitor->c.r4_robot__m__2__wh__ws_1
            + monitor->c.r4_robot__m__2__wh__ws_2 + monitor->c.r4_robot__Fx__2_1
            + monitor->c.r4_tanh_1 + monitor->c.r4_w1_robot__m__2__wh__ws
            + monitor->c.r4_w2_robot__m__2__wh__ws + monitor->c.r4_w1_robot__Fx__2
            + monitor->c.r4_w1_tanh + monitor->c.r5_robot__Us_1 + monitor->c.r5_robot__Us_2
            + monitor->c.r5_robot__Us_3 + monitor->c.r5_robot__Us_4);
}

/* Samples until `constants` time constants of the filter are over. */
static uint32_t samples(real constants, real sample_time, real bandwidth)
{
    const real wait = constants / (bandwidth * sample_time);
    const uint32_t whole = wait < REAL(4.0e9) ? (uint32_t)wait : UINT32_MAX - 1u;

    return (real)whole < wait ? whole + 1u : whole;
}

khepera_plausible_status khepera_plausible_configure(
    khepera_plausible_monitor *monitor,
    const khepera_plausible_parameters *parameters,
    khepera_plausible_real sample_time,
    khepera_plausible_real bandwidth,
    khepera_plausible_real time_unit)
{
    int k;

    for (k = 0; k < KHEPERA_PLAUSIBLE_RESIDUALS; ++k) {
        monitor->settle[k] = UINT32_MAX;
    }
    khepera_plausible_reset(monitor);
    if (!parameters_are_finite(parameters)) {
        return KHEPERA_PLAUSIBLE_BAD_PARAMETER;
    }
    if (!(sample_time >= REAL(0.000999999)) || !finite_number(sample_time)) {
        return KHEPERA_PLAUSIBLE_BAD_SAMPLE_TIME;
    }
    if (!(bandwidth * sample_time >= SLOWEST && bandwidth * sample_time <= REAL(3.0))) {
        return KHEPERA_PLAUSIBLE_BAD_BANDWIDTH;
    }
    if (!(time_unit > REAL(0.0)) || !finite_number(time_unit)) {
        return KHEPERA_PLAUSIBLE_BAD_TIME_UNIT;
    }
    compute_coefficients(monitor, parameters, sample_time, bandwidth);
    if (!coefficients_are_finite(monitor)) {
        return KHEPERA_PLAUSIBLE_BAD_COEFFICIENT;
    }
    monitor->settle[KHEPERA_PLAUSIBLE_R1] =
        samples(REAL(11.228872242412663), sample_time, bandwidth);
    monitor->settle[KHEPERA_PLAUSIBLE_R2] =
        samples(REAL(11.228872242412663), sample_time, bandwidth);
    monitor->settle[KHEPERA_PLAUSIBLE_R3] =
        samples(REAL(11.228872242412663), sample_time, bandwidth);
    monitor->settle[KHEPERA_PLAUSIBLE_R4] =
        samples(REAL(11.228872242412663), sample_time, bandwidth);
    monitor->settle[KHEPERA_PLAUSIBLE_R5] =
        samples(REAL(6.907755278982138), sample_time, bandwidth);
    return KHEPERA_PLAUSIBLE_OK;
}

void khepera_plausible_exact(
    const khepera_plausible_monitor *monitor,
    const khepera_plausible_derivatives *derivatives,
    khepera_plausible_real residuals[KHEPERA_PLAUSIBLE_RESIDUALS])
{
    const khepera_plausible_coefficients *c = &monitor->c;
    const khepera_plausible_derivatives *d = derivatives;
    real *r = residuals;

    /* khepera.bg:17: r1 = robot.U0[1] - robot.m[1].el.k*robot.m[1].me.we -
     * robot.m[1].el.Re*robot.m[1].el.k.e2/robot.m[1].el.k -
     * robot.m[1].el.L*D(robot.m[1].el.k.e2)/robot.m[1].el.k
     * where robot.m[1].el.k.e2 = fe[1]*robot.m[1].me.we + robot.m[1].me.Je*D(robot.m[1].me.we) +
     * (robot.m[1].wh.fs*robot.m[1].wh.ws + R[1]*robot.Fx[1] +
     * Js[1]*D(robot.m[1].wh.ws))/robot.m[1].ge.N */
    r[KHEPERA_PLAUSIBLE_R1] = d->robot__U0__1
        - c->r1_robot__m__1__me__we * d->robot__m__1__me__we[0]
        - c->r1_robot__m__1__me__we_1 * d->robot__m__1__me__we[1]
        - c->r1_robot__m__1__me__we_2 * d->robot__m__1__me__we[2]
        - c->r1_robot__m__1__wh__ws * d->robot__m__1__wh__ws[0]
        - c->r1_robot__m__1__wh__ws_1 * d->robot__m__1__wh__ws[1]
        - c->r1_robot__m__1__wh__ws_2 * d->robot__m__1__wh__ws[2]
        - c->r1_robot__Fx__1 * d->robot__Fx__1[0] - c->r1_robot__Fx__1_1 * d->robot__Fx__1[1];

    /* khepera.bg:41: tanh(Int(robot.m[1].me.we)/(4*robot.m[1].tau0) -
     * robot.m[1].ge.N*Int(robot.m[1].wh.ws) ... */
    const real t = MATH(tanh)(c->g * d->robot__m__1__me__we_integral
            - c->g_2 * d->robot__m__1__wh__ws_integral);

    /* khepera.bg:41: r2 = robot.m[1].me.we - robot.m[1].ge.N*robot.m[1].wh.ws -
     * D(robot.m[1].wh.fs*robot.m[1].wh.ws + R[1]*robot.Fx[1] + Js[1]*D(robot.m[1].wh.ws) -
     * robot.m[1].tau0*robot.m[1].A*robot.m[1].ge.N*robot.m[1].me.K*tanh((Int(robot.m[1].me.we) -
     * robot.m[1].ge.N*Int(robot.m[1].wh.ws))/(4*robot.m[1].tau0)))/(robot.m[1].ge.N*robot.m[1].m
     * e.K) */
    r[KHEPERA_PLAUSIBLE_R2] = d->robot__m__1__me__we[0]
        + c->r2_tanh_1
            * ((c->g * d->robot__m__1__me__we[0] - c->g_2 * d->robot__m__1__wh__ws[0]) * (REAL(1.0)
                - t * t))
        - c->r2_robot__m__1__wh__ws * d->robot__m__1__wh__ws[0]
        - c->r2_robot__m__1__wh__ws_1 * d->robot__m__1__wh__ws[1]
        - c->r2_robot__m__1__wh__ws_2 * d->robot__m__1__wh__ws[2]
        - c->r2_robot__Fx__1_1 * d->robot__Fx__1[1];

    /* khepera.bg:17: r3 = robot.U0[2] - robot.m[2].el.k*robot.m[2].me.we -
     * robot.m[2].el.Re*robot.m[2].el.k.e2/robot.m[2].el.k -
     * robot.m[2].el.L*D(robot.m[2].el.k.e2)/robot.m[2].el.k
     * where robot.m[2].el.k.e2 = fe[2]*robot.m[2].me.we + robot.m[2].me.Je*D(robot.m[2].me.we) +
     * (robot.m[2].wh.fs*robot.m[2].wh.ws + R[2]*robot.Fx[2] +
     * Js[2]*D(robot.m[2].wh.ws))/robot.m[2].ge.N */
    r[KHEPERA_PLAUSIBLE_R3] = d->robot__U0__2
        - c->r3_robot__m__2__me__we * d->robot__m__2__me__we[0]
        - c->r3_robot__m__2__me__we_1 * d->robot__m__2__me__we[1]
        - c->r3_robot__m__2__me__we_2 * d->robot__m__2__me__we[2]
        - c->r3_robot__m__2__wh__ws * d->robot__m__2__wh__ws[0]
        - c->r3_robot__m__2__wh__ws_1 * d->robot__m__2__wh__ws[1]
        - c->r3_robot__m__2__wh__ws_2 * d->robot__m__2__wh__ws[2]
        - c->r3_robot__Fx__2 * d->robot__Fx__2[0] - c->r3_robot__Fx__2_1 * d->robot__Fx__2[1];

    /* khepera.bg:41: tanh(Int(robot.m[2].me.we)/(4*robot.m[2].tau0) -
     * robot.m[2].ge.N*Int(robot.m[2].wh.ws) ... */
    const real t_2 = MATH(tanh)(c->g_3 * d->robot__m__2__me__we_integral
            - c->g_4 * d->robot__m__2__wh__ws_integral);

    /* khepera.bg:41: r4 = robot.m[2].me.we - robot.m[2].ge.N*robot.m[2].wh.ws -
     * D(robot.m[2].wh.fs*robot.m[2].wh.ws + R[2]*robot.Fx[2] + Js[2]*D(robot.m[2].wh.ws) -
     * robot.m[2].tau0*robot.m[2].A*robot.m[2].ge.N*robot.m[2].me.K*tanh((Int(robot.m[2].me.we) -
     * robot.m[2].ge.N*Int(robot.m[2].wh.ws))/(4*robot.m[2].tau0)))/(robot.m[2].ge.N*robot.m[2].m
     * e.K) */
    r[KHEPERA_PLAUSIBLE_R4] = d->robot__m__2__me__we[0]
        + c->r4_tanh_1
            * ((c->g_3 * d->robot__m__2__me__we[0]
                - c->g_4 * d->robot__m__2__wh__ws[0]) * (REAL(1.0) - t_2 * t_2))
        - c->r4_robot__m__2__wh__ws * d->robot__m__2__wh__ws[0]
        - c->r4_robot__m__2__wh__ws_1 * d->robot__m__2__wh__ws[1]
        - c->r4_robot__m__2__wh__ws_2 * d->robot__m__2__wh__ws[2]
        - c->r4_robot__Fx__2_1 * d->robot__Fx__2[1];

    /* khepera.bg:114: r5 = robot.Uin - robot.line.cell[1].mid.e - RL*robot.line.cell[1].left.f/2
     * - LL*D(robot.line.cell[1].left.f)/2
     * where robot.line.cell[1].left.f = CL*D(robot.Us) + CL*D(robot.line.cell[1].mid.e)
     * robot.line.cell[1].mid.e = robot.Us + RL*CL*D(robot.Us)/2 + LL*CL*D(robot.Us, 2)/2 */
    r[KHEPERA_PLAUSIBLE_R5] = d->robot__Uin - d->robot__Us[0] - c->r5_robot__Us_1 * d->robot__Us[1]
        - c->r5_robot__Us_2 * d->robot__Us[2] - c->r5_robot__Us_3 * d->robot__Us[3]
        - c->r5_robot__Us_4 * d->robot__Us[4];
}

/* r1 on its first sample: the filter as if it had always been so. */
static void start_r1(
    khepera_plausible_monitor *monitor, const khepera_plausible_samples *s, real *r)
{
    const khepera_plausible_coefficients *c = &monitor->c;
    khepera_plausible_memory *x = &monitor->x;

    /* khepera.bg:17: r1: terms of order 0 */
    const real r1_g0 = s->robot__U0__1 - c->r1_robot__m__1__me__we * s->robot__m__1__me__we
        - c->r1_robot__m__1__wh__ws * s->robot__m__1__wh__ws - c->r1_robot__Fx__1 * s->robot__Fx__1;

    /* khepera.bg:17: r1: terms of order 1 */
    const real r1_g1 = c->r1_w1_robot__m__1__me__we * s->robot__m__1__me__we
        + c->r1_w1_robot__m__1__wh__ws * s->robot__m__1__wh__ws
        - c->r1_w1_robot__Fx__1 * s->robot__Fx__1;

    /* khepera.bg:17: r1: error of order 0 */
    const real r1_e0 = c->bend2 * r1_g0;

    /* khepera.bg:17: r1: degree 2 */
    const real r1_d2 = -c->r1_w2_robot__m__1__me__we * s->robot__m__1__me__we
        - c->r1_w2_robot__m__1__wh__ws * s->robot__m__1__wh__ws - r1_e0;

    /* khepera.bg:17: r1: error of order 1 */
    const real r1_e1 = c->bend1 * r1_g1;

    /* khepera.bg:17: r1: input of stage 3 */
    const real r1_u3 = r1_g0 + r1_d2 + r1_e1 - r1_g1;

    /* khepera.bg:17: r1: stage 3, at rest */
    const real r1_y3 = r1_u3;

    /* khepera.bg:17: r1: stage 3: memory */
    x->r1_s3 = c->rest * r1_u3;

    /* khepera.bg:17: r1: input of stage 2 */
    const real r1_u2 = r1_y3 + r1_g1 - REAL(2.0) * r1_d2 - REAL(3.0) * r1_e1;

    /* khepera.bg:17: r1: stage 2, at rest */
    const real r1_y2 = r1_u2;

    /* khepera.bg:17: r1: stage 2: memory */
    x->r1_s2 = c->rest * r1_u2;

    /* khepera.bg:17: r1: input of stage 1 */
    const real r1_u1 = r1_y2 + r1_d2 + REAL(3.0) * r1_e1;

    /* khepera.bg:17: r1: stage 1, at rest */
    const real r1_y1 = r1_u1;

    /* khepera.bg:17: r1: stage 1: memory */
    x->r1_s1 = c->rest * r1_u1;

    /* khepera.bg:17: r1 = robot.U0[1] - robot.m[1].el.k*robot.m[1].me.we -
     * robot.m[1].el.Re*robot.m[1].el.k.e2/robot.m[1].el.k -
     * robot.m[1].el.L*D(robot.m[1].el.k.e2)/robot.m[1].el.k
     * where robot.m[1].el.k.e2 = fe[1]*robot.m[1].me.we + robot.m[1].me.Je*D(robot.m[1].me.we) +
     * (robot.m[1].wh.fs*robot.m[1].wh.ws + R[1]*robot.Fx[1] +
     * Js[1]*D(robot.m[1].wh.ws))/robot.m[1].ge.N */
    r[KHEPERA_PLAUSIBLE_R1] = r1_y1 - r1_e1;
}

/* r1 on every further sample. */
static void next_r1(
    khepera_plausible_monitor *monitor, const khepera_plausible_samples *s, real *r)
{
    const khepera_plausible_coefficients *c = &monitor->c;
    khepera_plausible_memory *x = &monitor->x;

    /* khepera.bg:17: r1: terms of order 0 */
    const real r1_g0 = s->robot__U0__1 - c->r1_robot__m__1__me__we * s->robot__m__1__me__we
        - c->r1_robot__m__1__wh__ws * s->robot__m__1__wh__ws - c->r1_robot__Fx__1 * s->robot__Fx__1;

    /* khepera.bg:17: r1: terms of order 1 */
    const real r1_g1 = c->r1_w1_robot__m__1__me__we * s->robot__m__1__me__we
        + c->r1_w1_robot__m__1__wh__ws * s->robot__m__1__wh__ws
        - c->r1_w1_robot__Fx__1 * s->robot__Fx__1;

    /* khepera.bg:17: r1: error of order 0 */
    const real r1_e0 = c->bend2 * r1_g0;

    /* khepera.bg:17: r1: degree 2 */
    const real r1_d2 = -c->r1_w2_robot__m__1__me__we * s->robot__m__1__me__we
        - c->r1_w2_robot__m__1__wh__ws * s->robot__m__1__wh__ws - r1_e0;

    /* khepera.bg:17: r1: error of order 1 */
    const real r1_e1 = c->bend1 * r1_g1;

    /* khepera.bg:17: r1: input of stage 3 */
    const real r1_u3 = r1_g0 + r1_d2 + r1_e1 - r1_g1;

    /* khepera.bg:17: r1: stage 3 */
    const real r1_y3 = x->r1_s3 + c->b * r1_u3;

    /* khepera.bg:17: r1: stage 3: memory */
    x->r1_s3 = c->a * r1_y3 + c->b * r1_u3;

    /* khepera.bg:17: r1: input of stage 2 */
    const real r1_u2 = r1_y3 + r1_g1 - REAL(2.0) * r1_d2 - REAL(3.0) * r1_e1;

    /* khepera.bg:17: r1: stage 2 */
    const real r1_y2 = x->r1_s2 + c->b * r1_u2;

    /* khepera.bg:17: r1: stage 2: memory */
    x->r1_s2 = c->a * r1_y2 + c->b * r1_u2;

    /* khepera.bg:17: r1: input of stage 1 */
    const real r1_u1 = r1_y2 + r1_d2 + REAL(3.0) * r1_e1;

    /* khepera.bg:17: r1: stage 1 */
    const real r1_y1 = x->r1_s1 + c->b * r1_u1;

    /* khepera.bg:17: r1: stage 1: memory */
    x->r1_s1 = c->a * r1_y1 + c->b * r1_u1;

    /* khepera.bg:17: r1 = robot.U0[1] - robot.m[1].el.k*robot.m[1].me.we -
     * robot.m[1].el.Re*robot.m[1].el.k.e2/robot.m[1].el.k -
     * robot.m[1].el.L*D(robot.m[1].el.k.e2)/robot.m[1].el.k
     * where robot.m[1].el.k.e2 = fe[1]*robot.m[1].me.we + robot.m[1].me.Je*D(robot.m[1].me.we) +
     * (robot.m[1].wh.fs*robot.m[1].wh.ws + R[1]*robot.Fx[1] +
     * Js[1]*D(robot.m[1].wh.ws))/robot.m[1].ge.N */
    r[KHEPERA_PLAUSIBLE_R1] = r1_y1 - r1_e1;
}

/* One sample for r1; a number that is not finite makes the next sample the first. */
static void run_r1(
    khepera_plausible_monitor *monitor, const khepera_plausible_samples *s, khepera_plausible_residuals *residuals)
{
    real *r = residuals->value;
    uint32_t age = monitor->age[0];

    if (age == 0u) {
        start_r1(monitor, s, r);
    } else {
        next_r1(monitor, s, r);
    }
    /* a sum is finite only if all its terms are */
    if (finite_number(s->robot__Fx__1 + s->robot__U0__1 + s->robot__m__1__me__we
                + s->robot__m__1__wh__ws + r[KHEPERA_PLAUSIBLE_R1])) {
        age += age < UINT32_MAX ? 1u : 0u;
    } else {
        age = 0u;
        r[KHEPERA_PLAUSIBLE_R1] = REAL(0.0);
    }
    monitor->age[0] = age;
    residuals->valid[KHEPERA_PLAUSIBLE_R1] = age > monitor->settle[KHEPERA_PLAUSIBLE_R1];
}

/* r2 on its first sample: the filter as if it had always been so. */
static void start_r2(
    khepera_plausible_monitor *monitor, const khepera_plausible_samples *s, real *r)
{
    const khepera_plausible_coefficients *c = &monitor->c;
    khepera_plausible_memory *x = &monitor->x;

    /* khepera.bg:41: integral of robot.m[1].me.we/(4*robot.m[1].tau0) - robot.m[1].ge.N*r ...,
     * what is integrated */
    const real r2_rate = c->g * s->robot__m__1__me__we - c->g_2 * s->robot__m__1__wh__ws;

    /* khepera.bg:41: integral of robot.m[1].me.we/(4*robot.m[1].tau0) - robot.m[1].ge.N*r ...,
     * at the start */
    const real r2_int = REAL(0.0);

    /* khepera.bg:41: integral of robot.m[1].me.we/(4*robot.m[1].tau0) - robot.m[1].ge.N*r ...:
     * memory */
    x->r2_q = c->half_time * r2_rate;

    /* khepera.bg:41: integral of robot.m[1].me.we/(4*robot.m[1].tau0) - robot.m[1].ge.N*r ... */
    const real r2_integral = r2_int;

    /* khepera.bg:41: integral of robot.m[1].me.we/(4*robot.m[1].tau0) - robot.m[1].ge.N*r ...:
     * memory */
    x->r2_rate2 = r2_rate;
    x->r2_rate1 = r2_rate;

    /* khepera.bg:41: tanh(Int(robot.m[1].me.we)/(4*robot.m[1].tau0) - robot.m ... */
    const real r2_tanh = MATH(tanh)(r2_integral);

    /* khepera.bg:41: r2: terms of order 0 */
    const real r2_g0 = s->robot__m__1__me__we - c->r2_robot__m__1__wh__ws * s->robot__m__1__wh__ws;

    /* khepera.bg:41: r2: terms of order 1 */
    const real r2_g1 = c->r2_w1_tanh * r2_tanh
        - c->r2_w1_robot__m__1__wh__ws * s->robot__m__1__wh__ws
        - c->r2_w1_robot__Fx__1 * s->robot__Fx__1;

    /* khepera.bg:41: r2: error of order 0 */
    const real r2_e0 = c->bend2 * r2_g0;

    /* khepera.bg:41: r2: degree 2 */
    const real r2_d2 = -c->r2_w2_robot__m__1__wh__ws * s->robot__m__1__wh__ws - r2_e0;

    /* khepera.bg:41: r2: error of order 1 */
    const real r2_e1 = c->bend1 * r2_g1;

    /* khepera.bg:41: r2: input of stage 3 */
    const real r2_u3 = r2_g0 + r2_d2 + r2_e1 - r2_g1;

    /* khepera.bg:41: r2: stage 3, at rest */
    const real r2_y3 = r2_u3;

    /* khepera.bg:41: r2: stage 3: memory */
    x->r2_s3 = c->rest * r2_u3;

    /* khepera.bg:41: r2: input of stage 2 */
    const real r2_u2 = r2_y3 + r2_g1 - REAL(2.0) * r2_d2 - REAL(3.0) * r2_e1;

    /* khepera.bg:41: r2: stage 2, at rest */
    const real r2_y2 = r2_u2;

    /* khepera.bg:41: r2: stage 2: memory */
    x->r2_s2 = c->rest * r2_u2;

    /* khepera.bg:41: r2: input of stage 1 */
    const real r2_u1 = r2_y2 + r2_d2 + REAL(3.0) * r2_e1;

    /* khepera.bg:41: r2: stage 1, at rest */
    const real r2_y1 = r2_u1;

    /* khepera.bg:41: r2: stage 1: memory */
    x->r2_s1 = c->rest * r2_u1;

    /* khepera.bg:41: r2 = robot.m[1].me.we - robot.m[1].ge.N*robot.m[1].wh.ws -
     * D(robot.m[1].wh.fs*robot.m[1].wh.ws + R[1]*robot.Fx[1] + Js[1]*D(robot.m[1].wh.ws) -
     * robot.m[1].tau0*robot.m[1].A*robot.m[1].ge.N*robot.m[1].me.K*tanh((Int(robot.m[1].me.we) -
     * robot.m[1].ge.N*Int(robot.m[1].wh.ws))/(4*robot.m[1].tau0)))/(robot.m[1].ge.N*robot.m[1].m
     * e.K) */
    r[KHEPERA_PLAUSIBLE_R2] = r2_y1 - r2_e1;
}

/* r2 on every further sample. */
static void next_r2(
    khepera_plausible_monitor *monitor, const khepera_plausible_samples *s, real *r)
{
    const khepera_plausible_coefficients *c = &monitor->c;
    khepera_plausible_memory *x = &monitor->x;

    /* khepera.bg:41: integral of robot.m[1].me.we/(4*robot.m[1].tau0) - robot.m[1].ge.N*r ...,
     * what is integrated */
    const real r2_rate = c->g * s->robot__m__1__me__we - c->g_2 * s->robot__m__1__wh__ws;

    /* khepera.bg:41: integral of robot.m[1].me.we/(4*robot.m[1].tau0) - robot.m[1].ge.N*r ... */
    const real r2_int = x->r2_q + c->half_time * r2_rate;

    /* khepera.bg:41: integral of robot.m[1].me.we/(4*robot.m[1].tau0) - robot.m[1].ge.N*r ...:
     * memory */
    x->r2_q = r2_int + c->half_time * r2_rate;

    /* khepera.bg:41: integral of robot.m[1].me.we/(4*robot.m[1].tau0) - robot.m[1].ge.N*r ... */
    const real r2_integral = r2_int
        - c->half_twelfth * (REAL(3.0) * r2_rate - REAL(4.0) * x->r2_rate1 + x->r2_rate2);

    /* khepera.bg:41: integral of robot.m[1].me.we/(4*robot.m[1].tau0) - robot.m[1].ge.N*r ...:
     * memory */
    x->r2_rate2 = x->r2_rate1;
    x->r2_rate1 = r2_rate;

    /* khepera.bg:41: tanh(Int(robot.m[1].me.we)/(4*robot.m[1].tau0) - robot.m ... */
    const real r2_tanh = MATH(tanh)(r2_integral);

    /* khepera.bg:41: r2: terms of order 0 */
    const real r2_g0 = s->robot__m__1__me__we - c->r2_robot__m__1__wh__ws * s->robot__m__1__wh__ws;

    /* khepera.bg:41: r2: terms of order 1 */
    const real r2_g1 = c->r2_w1_tanh * r2_tanh
        - c->r2_w1_robot__m__1__wh__ws * s->robot__m__1__wh__ws
        - c->r2_w1_robot__Fx__1 * s->robot__Fx__1;

    /* khepera.bg:41: r2: error of order 0 */
    const real r2_e0 = c->bend2 * r2_g0;

    /* khepera.bg:41: r2: degree 2 */
    const real r2_d2 = -c->r2_w2_robot__m__1__wh__ws * s->robot__m__1__wh__ws - r2_e0;

    /* khepera.bg:41: r2: error of order 1 */
    const real r2_e1 = c->bend1 * r2_g1;

    /* khepera.bg:41: r2: input of stage 3 */
    const real r2_u3 = r2_g0 + r2_d2 + r2_e1 - r2_g1;

    /* khepera.bg:41: r2: stage 3 */
    const real r2_y3 = x->r2_s3 + c->b * r2_u3;

    /* khepera.bg:41: r2: stage 3: memory */
    x->r2_s3 = c->a * r2_y3 + c->b * r2_u3;

    /* khepera.bg:41: r2: input of stage 2 */
    const real r2_u2 = r2_y3 + r2_g1 - REAL(2.0) * r2_d2 - REAL(3.0) * r2_e1;

    /* khepera.bg:41: r2: stage 2 */
    const real r2_y2 = x->r2_s2 + c->b * r2_u2;

    /* khepera.bg:41: r2: stage 2: memory */
    x->r2_s2 = c->a * r2_y2 + c->b * r2_u2;

    /* khepera.bg:41: r2: input of stage 1 */
    const real r2_u1 = r2_y2 + r2_d2 + REAL(3.0) * r2_e1;

    /* khepera.bg:41: r2: stage 1 */
    const real r2_y1 = x->r2_s1 + c->b * r2_u1;

    /* khepera.bg:41: r2: stage 1: memory */
    x->r2_s1 = c->a * r2_y1 + c->b * r2_u1;

    /* khepera.bg:41: r2 = robot.m[1].me.we - robot.m[1].ge.N*robot.m[1].wh.ws -
     * D(robot.m[1].wh.fs*robot.m[1].wh.ws + R[1]*robot.Fx[1] + Js[1]*D(robot.m[1].wh.ws) -
     * robot.m[1].tau0*robot.m[1].A*robot.m[1].ge.N*robot.m[1].me.K*tanh((Int(robot.m[1].me.we) -
     * robot.m[1].ge.N*Int(robot.m[1].wh.ws))/(4*robot.m[1].tau0)))/(robot.m[1].ge.N*robot.m[1].m
     * e.K) */
    r[KHEPERA_PLAUSIBLE_R2] = r2_y1 - r2_e1;
}

/* One sample for r2; a number that is not finite makes the next sample the first. */
static void run_r2(
    khepera_plausible_monitor *monitor, const khepera_plausible_samples *s, khepera_plausible_residuals *residuals)
{
    real *r = residuals->value;
    uint32_t age = monitor->age[1];

    if (age == 0u) {
        start_r2(monitor, s, r);
    } else {
        next_r2(monitor, s, r);
    }
    /* a sum is finite only if all its terms are */
    if (finite_number(s->robot__Fx__1 + s->robot__m__1__me__we + s->robot__m__1__wh__ws
                + r[KHEPERA_PLAUSIBLE_R2])) {
        age += age < UINT32_MAX ? 1u : 0u;
    } else {
        age = 0u;
        r[KHEPERA_PLAUSIBLE_R2] = REAL(0.0);
    }
    monitor->age[1] = age;
    residuals->valid[KHEPERA_PLAUSIBLE_R2] = age > monitor->settle[KHEPERA_PLAUSIBLE_R2];
}

/* r3 on its first sample: the filter as if it had always been so. */
static void start_r3(
    khepera_plausible_monitor *monitor, const khepera_plausible_samples *s, real *r)
{
    const khepera_plausible_coefficients *c = &monitor->c;
    khepera_plausible_memory *x = &monitor->x;

    /* khepera.bg:17: r3: terms of order 0 */
    const real r3_g0 = s->robot__U0__2 - c->r3_robot__m__2__me__we * s->robot__m__2__me__we
        - c->r3_robot__m__2__wh__ws * s->robot__m__2__wh__ws - c->r3_robot__Fx__2 * s->robot__Fx__2;

    /* khepera.bg:17: r3: terms of order 1 */
    const real r3_g1 = c->r3_w1_robot__m__2__me__we * s->robot__m__2__me__we
        + c->r3_w1_robot__m__2__wh__ws * s->robot__m__2__wh__ws
        - c->r3_w1_robot__Fx__2 * s->robot__Fx__2;

    /* khepera.bg:17: r3: error of order 0 */
    const real r3_e0 = c->bend2 * r3_g0;

    /* khepera.bg:17: r3: degree 2 */
    const real r3_d2 = -c->r3_w2_robot__m__2__me__we * s->robot__m__2__me__we
        - c->r3_w2_robot__m__2__wh__ws * s->robot__m__2__wh__ws - r3_e0;

    /* khepera.bg:17: r3: error of order 1 */
    const real r3_e1 = c->bend1 * r3_g1;

    /* khepera.bg:17: r3: input of stage 3 */
    const real r3_u3 = r3_g0 + r3_d2 + r3_e1 - r3_g1;

    /* khepera.bg:17: r3: stage 3, at rest */
    const real r3_y3 = r3_u3;

    /* khepera.bg:17: r3: stage 3: memory */
    x->r3_s3 = c->rest * r3_u3;

    /* khepera.bg:17: r3: input of stage 2 */
    const real r3_u2 = r3_y3 + r3_g1 - REAL(2.0) * r3_d2 - REAL(3.0) * r3_e1;

    /* khepera.bg:17: r3: stage 2, at rest */
    const real r3_y2 = r3_u2;

    /* khepera.bg:17: r3: stage 2: memory */
    x->r3_s2 = c->rest * r3_u2;

    /* khepera.bg:17: r3: input of stage 1 */
    const real r3_u1 = r3_y2 + r3_d2 + REAL(3.0) * r3_e1;

    /* khepera.bg:17: r3: stage 1, at rest */
    const real r3_y1 = r3_u1;

    /* khepera.bg:17: r3: stage 1: memory */
    x->r3_s1 = c->rest * r3_u1;

    /* khepera.bg:17: r3 = robot.U0[2] - robot.m[2].el.k*robot.m[2].me.we -
     * robot.m[2].el.Re*robot.m[2].el.k.e2/robot.m[2].el.k -
     * robot.m[2].el.L*D(robot.m[2].el.k.e2)/robot.m[2].el.k
     * where robot.m[2].el.k.e2 = fe[2]*robot.m[2].me.we + robot.m[2].me.Je*D(robot.m[2].me.we) +
     * (robot.m[2].wh.fs*robot.m[2].wh.ws + R[2]*robot.Fx[2] +
     * Js[2]*D(robot.m[2].wh.ws))/robot.m[2].ge.N */
    r[KHEPERA_PLAUSIBLE_R3] = r3_y1 - r3_e1;
}

/* r3 on every further sample. */
static void next_r3(
    khepera_plausible_monitor *monitor, const khepera_plausible_samples *s, real *r)
{
    const khepera_plausible_coefficients *c = &monitor->c;
    khepera_plausible_memory *x = &monitor->x;

    /* khepera.bg:17: r3: terms of order 0 */
    const real r3_g0 = s->robot__U0__2 - c->r3_robot__m__2__me__we * s->robot__m__2__me__we
        - c->r3_robot__m__2__wh__ws * s->robot__m__2__wh__ws - c->r3_robot__Fx__2 * s->robot__Fx__2;

    /* khepera.bg:17: r3: terms of order 1 */
    const real r3_g1 = c->r3_w1_robot__m__2__me__we * s->robot__m__2__me__we
        + c->r3_w1_robot__m__2__wh__ws * s->robot__m__2__wh__ws
        - c->r3_w1_robot__Fx__2 * s->robot__Fx__2;

    /* khepera.bg:17: r3: error of order 0 */
    const real r3_e0 = c->bend2 * r3_g0;

    /* khepera.bg:17: r3: degree 2 */
    const real r3_d2 = -c->r3_w2_robot__m__2__me__we * s->robot__m__2__me__we
        - c->r3_w2_robot__m__2__wh__ws * s->robot__m__2__wh__ws - r3_e0;

    /* khepera.bg:17: r3: error of order 1 */
    const real r3_e1 = c->bend1 * r3_g1;

    /* khepera.bg:17: r3: input of stage 3 */
    const real r3_u3 = r3_g0 + r3_d2 + r3_e1 - r3_g1;

    /* khepera.bg:17: r3: stage 3 */
    const real r3_y3 = x->r3_s3 + c->b * r3_u3;

    /* khepera.bg:17: r3: stage 3: memory */
    x->r3_s3 = c->a * r3_y3 + c->b * r3_u3;

    /* khepera.bg:17: r3: input of stage 2 */
    const real r3_u2 = r3_y3 + r3_g1 - REAL(2.0) * r3_d2 - REAL(3.0) * r3_e1;

    /* khepera.bg:17: r3: stage 2 */
    const real r3_y2 = x->r3_s2 + c->b * r3_u2;

    /* khepera.bg:17: r3: stage 2: memory */
    x->r3_s2 = c->a * r3_y2 + c->b * r3_u2;

    /* khepera.bg:17: r3: input of stage 1 */
    const real r3_u1 = r3_y2 + r3_d2 + REAL(3.0) * r3_e1;

    /* khepera.bg:17: r3: stage 1 */
    const real r3_y1 = x->r3_s1 + c->b * r3_u1;

    /* khepera.bg:17: r3: stage 1: memory */
    x->r3_s1 = c->a * r3_y1 + c->b * r3_u1;

    /* khepera.bg:17: r3 = robot.U0[2] - robot.m[2].el.k*robot.m[2].me.we -
     * robot.m[2].el.Re*robot.m[2].el.k.e2/robot.m[2].el.k -
     * robot.m[2].el.L*D(robot.m[2].el.k.e2)/robot.m[2].el.k
     * where robot.m[2].el.k.e2 = fe[2]*robot.m[2].me.we + robot.m[2].me.Je*D(robot.m[2].me.we) +
     * (robot.m[2].wh.fs*robot.m[2].wh.ws + R[2]*robot.Fx[2] +
     * Js[2]*D(robot.m[2].wh.ws))/robot.m[2].ge.N */
    r[KHEPERA_PLAUSIBLE_R3] = r3_y1 - r3_e1;
}

/* One sample for r3; a number that is not finite makes the next sample the first. */
static void run_r3(
    khepera_plausible_monitor *monitor, const khepera_plausible_samples *s, khepera_plausible_residuals *residuals)
{
    real *r = residuals->value;
    uint32_t age = monitor->age[2];

    if (age == 0u) {
        start_r3(monitor, s, r);
    } else {
        next_r3(monitor, s, r);
    }
    /* a sum is finite only if all its terms are */
    if (finite_number(s->robot__Fx__2 + s->robot__U0__2 + s->robot__m__2__me__we
                + s->robot__m__2__wh__ws + r[KHEPERA_PLAUSIBLE_R3])) {
        age += age < UINT32_MAX ? 1u : 0u;
    } else {
        age = 0u;
        r[KHEPERA_PLAUSIBLE_R3] = REAL(0.0);
    }
    monitor->age[2] = age;
    residuals->valid[KHEPERA_PLAUSIBLE_R3] = age > monitor->settle[KHEPERA_PLAUSIBLE_R3];
}

/* r4 on its first sample: the filter as if it had always been so. */
static void start_r4(
    khepera_plausible_monitor *monitor, const khepera_plausible_samples *s, real *r)
{
    const khepera_plausible_coefficients *c = &monitor->c;
    khepera_plausible_memory *x = &monitor->x;

    /* khepera.bg:41: integral of robot.m[2].me.we/(4*robot.m[2].tau0) - robot.m[2].ge.N*r ...,
     * what is integrated */
    const real r4_rate = c->g_3 * s->robot__m__2__me__we - c->g_4 * s->robot__m__2__wh__ws;

    /* khepera.bg:41: integral of robot.m[2].me.we/(4*robot.m[2].tau0) - robot.m[2].ge.N*r ...,
     * at the start */
    const real r4_int = REAL(0.0);

    /* khepera.bg:41: integral of robot.m[2].me.we/(4*robot.m[2].tau0) - robot.m[2].ge.N*r ...:
     * memory */
    x->r4_q = c->half_time * r4_rate;

    /* khepera.bg:41: integral of robot.m[2].me.we/(4*robot.m[2].tau0) - robot.m[2].ge.N*r ... */
    const real r4_integral = r4_int;

    /* khepera.bg:41: integral of robot.m[2].me.we/(4*robot.m[2].tau0) - robot.m[2].ge.N*r ...:
     * memory */
    x->r4_rate2 = r4_rate;
    x->r4_rate1 = r4_rate;

    /* khepera.bg:41: tanh(Int(robot.m[2].me.we)/(4*robot.m[2].tau0) - robot.m ... */
    const real r4_tanh = MATH(tanh)(r4_integral);

    /* khepera.bg:41: r4: terms of order 0 */
    const real r4_g0 = s->robot__m__2__me__we - c->r4_robot__m__2__wh__ws * s->robot__m__2__wh__ws;

    /* khepera.bg:41: r4: terms of order 1 */
    const real r4_g1 = c->r4_w1_tanh * r4_tanh
        - c->r4_w1_robot__m__2__wh__ws * s->robot__m__2__wh__ws
        - c->r4_w1_robot__Fx__2 * s->robot__Fx__2;

    /* khepera.bg:41: r4: error of order 0 */
    const real r4_e0 = c->bend2 * r4_g0;

    /* khepera.bg:41: r4: degree 2 */
    const real r4_d2 = -c->r4_w2_robot__m__2__wh__ws * s->robot__m__2__wh__ws - r4_e0;

    /* khepera.bg:41: r4: error of order 1 */
    const real r4_e1 = c->bend1 * r4_g1;

    /* khepera.bg:41: r4: input of stage 3 */
    const real r4_u3 = r4_g0 + r4_d2 + r4_e1 - r4_g1;

    /* khepera.bg:41: r4: stage 3, at rest */
    const real r4_y3 = r4_u3;

    /* khepera.bg:41: r4: stage 3: memory */
    x->r4_s3 = c->rest * r4_u3;

    /* khepera.bg:41: r4: input of stage 2 */
    const real r4_u2 = r4_y3 + r4_g1 - REAL(2.0) * r4_d2 - REAL(3.0) * r4_e1;

    /* khepera.bg:41: r4: stage 2, at rest */
    const real r4_y2 = r4_u2;

    /* khepera.bg:41: r4: stage 2: memory */
    x->r4_s2 = c->rest * r4_u2;

    /* khepera.bg:41: r4: input of stage 1 */
    const real r4_u1 = r4_y2 + r4_d2 + REAL(3.0) * r4_e1;

    /* khepera.bg:41: r4: stage 1, at rest */
    const real r4_y1 = r4_u1;

    /* khepera.bg:41: r4: stage 1: memory */
    x->r4_s1 = c->rest * r4_u1;

    /* khepera.bg:41: r4 = robot.m[2].me.we - robot.m[2].ge.N*robot.m[2].wh.ws -
     * D(robot.m[2].wh.fs*robot.m[2].wh.ws + R[2]*robot.Fx[2] + Js[2]*D(robot.m[2].wh.ws) -
     * robot.m[2].tau0*robot.m[2].A*robot.m[2].ge.N*robot.m[2].me.K*tanh((Int(robot.m[2].me.we) -
     * robot.m[2].ge.N*Int(robot.m[2].wh.ws))/(4*robot.m[2].tau0)))/(robot.m[2].ge.N*robot.m[2].m
     * e.K) */
    r[KHEPERA_PLAUSIBLE_R4] = r4_y1 - r4_e1;
}

/* r4 on every further sample. */
static void next_r4(
    khepera_plausible_monitor *monitor, const khepera_plausible_samples *s, real *r)
{
    const khepera_plausible_coefficients *c = &monitor->c;
    khepera_plausible_memory *x = &monitor->x;

    /* khepera.bg:41: integral of robot.m[2].me.we/(4*robot.m[2].tau0) - robot.m[2].ge.N*r ...,
     * what is integrated */
    const real r4_rate = c->g_3 * s->robot__m__2__me__we - c->g_4 * s->robot__m__2__wh__ws;

    /* khepera.bg:41: integral of robot.m[2].me.we/(4*robot.m[2].tau0) - robot.m[2].ge.N*r ... */
    const real r4_int = x->r4_q + c->half_time * r4_rate;

    /* khepera.bg:41: integral of robot.m[2].me.we/(4*robot.m[2].tau0) - robot.m[2].ge.N*r ...:
     * memory */
    x->r4_q = r4_int + c->half_time * r4_rate;

    /* khepera.bg:41: integral of robot.m[2].me.we/(4*robot.m[2].tau0) - robot.m[2].ge.N*r ... */
    const real r4_integral = r4_int
        - c->half_twelfth * (REAL(3.0) * r4_rate - REAL(4.0) * x->r4_rate1 + x->r4_rate2);

    /* khepera.bg:41: integral of robot.m[2].me.we/(4*robot.m[2].tau0) - robot.m[2].ge.N*r ...:
     * memory */
    x->r4_rate2 = x->r4_rate1;
    x->r4_rate1 = r4_rate;

    /* khepera.bg:41: tanh(Int(robot.m[2].me.we)/(4*robot.m[2].tau0) - robot.m ... */
    const real r4_tanh = MATH(tanh)(r4_integral);

    /* khepera.bg:41: r4: terms of order 0 */
    const real r4_g0 = s->robot__m__2__me__we - c->r4_robot__m__2__wh__ws * s->robot__m__2__wh__ws;

    /* khepera.bg:41: r4: terms of order 1 */
    const real r4_g1 = c->r4_w1_tanh * r4_tanh
        - c->r4_w1_robot__m__2__wh__ws * s->robot__m__2__wh__ws
        - c->r4_w1_robot__Fx__2 * s->robot__Fx__2;

    /* khepera.bg:41: r4: error of order 0 */
    const real r4_e0 = c->bend2 * r4_g0;

    /* khepera.bg:41: r4: degree 2 */
    const real r4_d2 = -c->r4_w2_robot__m__2__wh__ws * s->robot__m__2__wh__ws - r4_e0;

    /* khepera.bg:41: r4: error of order 1 */
    const real r4_e1 = c->bend1 * r4_g1;

    /* khepera.bg:41: r4: input of stage 3 */
    const real r4_u3 = r4_g0 + r4_d2 + r4_e1 - r4_g1;

    /* khepera.bg:41: r4: stage 3 */
    const real r4_y3 = x->r4_s3 + c->b * r4_u3;

    /* khepera.bg:41: r4: stage 3: memory */
    x->r4_s3 = c->a * r4_y3 + c->b * r4_u3;

    /* khepera.bg:41: r4: input of stage 2 */
    const real r4_u2 = r4_y3 + r4_g1 - REAL(2.0) * r4_d2 - REAL(3.0) * r4_e1;

    /* khepera.bg:41: r4: stage 2 */
    const real r4_y2 = x->r4_s2 + c->b * r4_u2;

    /* khepera.bg:41: r4: stage 2: memory */
    x->r4_s2 = c->a * r4_y2 + c->b * r4_u2;

    /* khepera.bg:41: r4: input of stage 1 */
    const real r4_u1 = r4_y2 + r4_d2 + REAL(3.0) * r4_e1;

    /* khepera.bg:41: r4: stage 1 */
    const real r4_y1 = x->r4_s1 + c->b * r4_u1;

    /* khepera.bg:41: r4: stage 1: memory */
    x->r4_s1 = c->a * r4_y1 + c->b * r4_u1;

    /* khepera.bg:41: r4 = robot.m[2].me.we - robot.m[2].ge.N*robot.m[2].wh.ws -
     * D(robot.m[2].wh.fs*robot.m[2].wh.ws + R[2]*robot.Fx[2] + Js[2]*D(robot.m[2].wh.ws) -
     * robot.m[2].tau0*robot.m[2].A*robot.m[2].ge.N*robot.m[2].me.K*tanh((Int(robot.m[2].me.we) -
     * robot.m[2].ge.N*Int(robot.m[2].wh.ws))/(4*robot.m[2].tau0)))/(robot.m[2].ge.N*robot.m[2].m
     * e.K) */
    r[KHEPERA_PLAUSIBLE_R4] = r4_y1 - r4_e1;
}

/* One sample for r4; a number that is not finite makes the next sample the first. */
static void run_r4(
    khepera_plausible_monitor *monitor, const khepera_plausible_samples *s, khepera_plausible_residuals *residuals)
{
    real *r = residuals->value;
    uint32_t age = monitor->age[3];

    if (age == 0u) {
        start_r4(monitor, s, r);
    } else {
        next_r4(monitor, s, r);
    }
    /* a sum is finite only if all its terms are */
    if (finite_number(s->robot__Fx__2 + s->robot__m__2__me__we + s->robot__m__2__wh__ws
                + r[KHEPERA_PLAUSIBLE_R4])) {
        age += age < UINT32_MAX ? 1u : 0u;
    } else {
        age = 0u;
        r[KHEPERA_PLAUSIBLE_R4] = REAL(0.0);
    }
    monitor->age[3] = age;
    residuals->valid[KHEPERA_PLAUSIBLE_R4] = age > monitor->settle[KHEPERA_PLAUSIBLE_R4];
}

/* r5 on its first sample: the filter as if it had always been so. */
static void start_r5(
    khepera_plausible_monitor *monitor, const khepera_plausible_samples *s, real *r)
{
    const khepera_plausible_coefficients *c = &monitor->c;
    khepera_plausible_memory *x = &monitor->x;

    /* khepera.bg:114: r5: input of stage 1 */
    const real r5_u1 = s->robot__Uin - s->robot__Us;

    /* khepera.bg:114: r5: stage 1, at rest */
    const real r5_y1 = r5_u1;

    /* khepera.bg:114: r5: stage 1: memory */
    x->r5_s1 = c->rest * r5_u1;

    /* khepera.bg:114: r5 = robot.Uin - robot.line.cell[1].mid.e - RL*robot.line.cell[1].left.f/2
     * - LL*D(robot.line.cell[1].left.f)/2
     * where robot.line.cell[1].left.f = CL*D(robot.Us) + CL*D(robot.line.cell[1].mid.e)
     * robot.line.cell[1].mid.e = robot.Us + RL*CL*D(robot.Us)/2 + LL*CL*D(robot.Us, 2)/2 */
    r[KHEPERA_PLAUSIBLE_R5] = r5_y1;
}

/* r5 on every further sample. */
static void next_r5(
    khepera_plausible_monitor *monitor, const khepera_plausible_samples *s, real *r)
{
    const khepera_plausible_coefficients *c = &monitor->c;
    khepera_plausible_memory *x = &monitor->x;

    /* khepera.bg:114: r5: input of stage 1 */
    const real r5_u1 = s->robot__Uin - s->robot__Us;

    /* khepera.bg:114: r5: stage 1 */
    const real r5_y1 = x->r5_s1 + c->b * r5_u1;

    /* khepera.bg:114: r5: stage 1: memory */
    x->r5_s1 = c->a * r5_y1 + c->b * r5_u1;

    /* khepera.bg:114: r5 = robot.Uin - robot.line.cell[1].mid.e - RL*robot.line.cell[1].left.f/2
     * - LL*D(robot.line.cell[1].left.f)/2
     * where robot.line.cell[1].left.f = CL*D(robot.Us) + CL*D(robot.line.cell[1].mid.e)
     * robot.line.cell[1].mid.e = robot.Us + RL*CL*D(robot.Us)/2 + LL*CL*D(robot.Us, 2)/2 */
    r[KHEPERA_PLAUSIBLE_R5] = r5_y1;
}

/* One sample for r5; a number that is not finite makes the next sample the first. */
static void run_r5(
    khepera_plausible_monitor *monitor, const khepera_plausible_samples *s, khepera_plausible_residuals *residuals)
{
    real *r = residuals->value;
    uint32_t age = monitor->age[4];

    if (age == 0u) {
        start_r5(monitor, s, r);
    } else {
        next_r5(monitor, s, r);
    }
    /* a sum is finite only if all its terms are */
    if (finite_number(s->robot__Uin + s->robot__Us + r[KHEPERA_PLAUSIBLE_R5])) {
        age += age < UINT32_MAX ? 1u : 0u;
    } else {
        age = 0u;
        r[KHEPERA_PLAUSIBLE_R5] = REAL(0.0);
    }
    monitor->age[4] = age;
    residuals->valid[KHEPERA_PLAUSIBLE_R5] = age > monitor->settle[KHEPERA_PLAUSIBLE_R5];
}

void khepera_plausible_reset(khepera_plausible_monitor *monitor)
{
    int k;

    for (k = 0; k < 5; ++k) {
        monitor->age[k] = 0u;
    }
}

void khepera_plausible_step(
    khepera_plausible_monitor *monitor,
    const khepera_plausible_samples *samples,
    khepera_plausible_residuals *residuals)
{
    run_r1(monitor, samples, residuals);
    run_r2(monitor, samples, residuals);
    run_r3(monitor, samples, residuals);
    run_r4(monitor, samples, residuals);
    run_r5(monitor, samples, residuals);
}

const char khepera_plausible_fault_name[KHEPERA_PLAUSIBLE_FAULTS][17] = {
    "Js[1]", "R[1]", "robot.m[1].ge.N", "robot.m[1].wh.fs", "robot.Fx[1]", "robot.m[1].me.we",
    "robot.m[1].wh.ws", "fe[1]", "robot.m[1].el.L", "robot.m[1].el.Re", "robot.m[1].el.k",
    "robot.m[1].me.Je", "robot.U0[1]", "robot.m[1].tau0", "robot.m[1].A", "robot.m[1].me.K",
    "Js[2]", "R[2]", "robot.m[2].ge.N", "robot.m[2].wh.fs", "robot.Fx[2]", "robot.m[2].me.we",
    "robot.m[2].wh.ws", "fe[2]", "robot.m[2].el.L", "robot.m[2].el.Re", "robot.m[2].el.k",
    "robot.m[2].me.Je", "robot.U0[2]", "robot.m[2].tau0", "robot.m[2].A", "robot.m[2].me.K", "RL",
    "LL", "CL", "robot.Uin", "robot.Us",
};

const uint16_t khepera_plausible_fault_class[KHEPERA_PLAUSIBLE_FAULTS] = {
    0u, 0u, 0u, 0u, 0u, 0u, 0u, 1u, 1u, 1u, 1u, 1u, 1u, 2u, 2u, 2u, 3u, 3u, 3u, 3u, 3u, 3u, 3u, 4u,
    4u, 4u, 4u, 4u, 4u, 5u, 5u, 5u, 6u, 6u, 6u, 7u, 7u,
};

const char khepera_plausible_residual_name[KHEPERA_PLAUSIBLE_RESIDUALS][3] = {
    "r1", "r2", "r3", "r4", "r5",
};

/* Signatures: 1 where a residual may be moved by the faults of a class, 3 where it is for sure. */
static const uint8_t signature[KHEPERA_PLAUSIBLE_CLASSES][KHEPERA_PLAUSIBLE_RESIDUALS] = {
    {3u, 3u, 0u, 0u, 0u},
    {3u, 0u, 0u, 0u, 0u},
    {0u, 3u, 0u, 0u, 0u},
    {0u, 0u, 3u, 3u, 0u},
    {0u, 0u, 3u, 0u, 0u},
    {0u, 0u, 0u, 3u, 0u},
    {0u, 0u, 0u, 0u, 1u},
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
    khepera_plausible_diagnosis *d, const khepera_plausible_limit *limit, int k, real off, real out, real bound)
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

static bool sums_are_zero(const khepera_plausible_diagnosis *d, int k)
{
    const real sum = d->above[k] + d->below[k] + d->louder[k];

    return !(sum > REAL(0.0));
}

static void forget_sums(khepera_plausible_diagnosis *d, int k)
{
    d->above[k] = REAL(0.0);
    d->below[k] = REAL(0.0);
    d->louder[k] = REAL(0.0);
    d->streak[k] = 0u;
}

/* Residual k in one sample; whether it goes into alarm. */
static bool watch(
    khepera_plausible_diagnosis *d, const khepera_plausible_limit *limit, int k, real value, real bound, bool row)
{
    const real off = value - limit->mean;
    const real out = (off < REAL(0.0) ? -off : off) - bound;
    bool high = false;

    if (row) {
        high = add_row(d, limit, k, off, out, bound);
    }
    if (d->state[k] == KHEPERA_PLAUSIBLE_ALARM) {
        d->since[k] += d->since[k] < UINT32_MAX ? 1u : 0u;
        if (!(out < RELEASE * limit->level) || !sums_are_zero(d, k)) {
            d->quiet = 0u;
        }
        return false;
    }
    d->state[k] = KHEPERA_PLAUSIBLE_HEALTHY;
    d->streak[k] = out > limit->level ? d->streak[k] + 1u : 0u;
    if (d->streak[k] < d->least && !high) {
        return false;
    }
    d->state[k] = KHEPERA_PLAUSIBLE_ALARM;
    d->since[k] = 0u;
    return true;
}

/* What is left of a class of faults. */
static khepera_plausible_candidate left_of(const khepera_plausible_diagnosis *d, const uint8_t *own)
{
    khepera_plausible_candidate found = KHEPERA_PLAUSIBLE_LIKELY;
    int k;

    for (k = 0; k < KHEPERA_PLAUSIBLE_RESIDUALS; ++k) {
        if (d->state[k] == KHEPERA_PLAUSIBLE_ALARM && own[k] == 0u) {
            return KHEPERA_PLAUSIBLE_RULED_OUT;
        }
        if (d->state[k] == KHEPERA_PLAUSIBLE_HEALTHY && own[k] == 3u) {
            found = KHEPERA_PLAUSIBLE_SMALL;
        }
    }
    return found;
}

/* Which classes of faults the residuals leave, and the one if it is one. */
static void judge(khepera_plausible_diagnosis *d)
{
    int likely = 0;
    int c;

    d->fault_class = KHEPERA_PLAUSIBLE_UNKNOWN;
    for (c = 0; c < KHEPERA_PLAUSIBLE_CLASSES; ++c) {
        const khepera_plausible_candidate left = left_of(d, signature[c]);

        d->candidate[c] = (uint8_t)left;
        if (left == KHEPERA_PLAUSIBLE_LIKELY) {
            d->fault_class = (int16_t)c;
            ++likely;
        }
    }
    if (likely != 1 || d->settled < 2u * d->row) {
        d->fault_class = KHEPERA_PLAUSIBLE_UNKNOWN;
    }
}

khepera_plausible_limit khepera_plausible_limit_of(khepera_plausible_real level)
{
    khepera_plausible_limit limit;

    limit.mean = REAL(0.0);
    limit.level = level;
    limit.unit = REAL(0.0);
    limit.loud = REAL(0.0);
    limit.drift = REAL(0.5);
    limit.height = NEVER;
    limit.bound = REAL(0.0);
    return limit;
}

void khepera_plausible_clear(khepera_plausible_diagnosis *diagnosis)
{
    int k;

    for (k = 0; k < KHEPERA_PLAUSIBLE_RESIDUALS; ++k) {
        if (diagnosis->state[k] == KHEPERA_PLAUSIBLE_ALARM) {
            diagnosis->state[k] = KHEPERA_PLAUSIBLE_HEALTHY;
        }
        diagnosis->since[k] = 0u;
        forget_sums(diagnosis, k);
    }
    for (k = 0; k < KHEPERA_PLAUSIBLE_CLASSES; ++k) {
        diagnosis->candidate[k] = KHEPERA_PLAUSIBLE_RULED_OUT;
    }
    diagnosis->fault_class = KHEPERA_PLAUSIBLE_UNKNOWN;
    diagnosis->quiet = 0u;
    diagnosis->settled = 0u;
}

void khepera_plausible_diagnosis_reset(khepera_plausible_diagnosis *diagnosis)
{
    int k;

    diagnosis->row = KHEPERA_PLAUSIBLE_ROW;
    diagnosis->least = 15u;
    diagnosis->hold = 10u * KHEPERA_PLAUSIBLE_ROW;
    diagnosis->latch = false;
    diagnosis->tick = 0u;
    for (k = 0; k < KHEPERA_PLAUSIBLE_RESIDUALS; ++k) {
        diagnosis->state[k] = KHEPERA_PLAUSIBLE_BLIND;
    }
    khepera_plausible_clear(diagnosis);
}

bool khepera_plausible_diagnose(
    khepera_plausible_diagnosis *diagnosis,
    const khepera_plausible_limit *limits,
    const khepera_plausible_real *bounds,
    const khepera_plausible_residuals *residuals)
{
    khepera_plausible_diagnosis *d = diagnosis;
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
    for (k = 0; k < KHEPERA_PLAUSIBLE_RESIDUALS; ++k) {
        if (residuals->valid[k]) {
            const real bound = bounds ? bounds[k] : limits[k].bound;

            fresh = watch(d, &limits[k], k, residuals->value[k], bound, row) || fresh;
        } else {
            forget_sums(d, k);
            if (d->state[k] == KHEPERA_PLAUSIBLE_ALARM) {
                d->quiet = 0u; /* nobody knows that it is over */
            } else {
                d->state[k] = KHEPERA_PLAUSIBLE_BLIND;
            }
        }
        alarm = alarm || d->state[k] == KHEPERA_PLAUSIBLE_ALARM;
    }
    if (fresh) {
        d->quiet = 0u;
        d->settled = 0u;
    }
    if (alarm && !d->latch && d->quiet >= d->hold) {
        khepera_plausible_clear(d);
        return false;
    }
    if (fresh || (alarm && row)) {
        judge(d);
    }
    return alarm;
}
