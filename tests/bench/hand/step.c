/*
 * step.c: the robot's five residuals through the same filter, written by hand.
 *
 * The yardstick for the generated step. Both drives and the cable, each residual r/(1 + p/wc)^n
 * as one chain of first-order stages by the trapezoid rule, less what that rule is off by; the
 * backlash angle by the implicit rule of Adams over four samples. It promises what
 * the generated code promises: a sample that is not finite starts a residual anew, and a residual
 * is valid only when its filter has settled.
 */
#include "step.h"

#include <float.h>
#include <math.h>

static int finite_number(double x)
{
    return x >= -DBL_MAX && x <= DBL_MAX;
}

static double stage(const hand_filter *f, double *s, double u)
{
    const double w = f->b * u, y = *s + w;

    *s = f->a * y + w;
    return y;
}

static double steady(const hand_filter *f, double *s, double u)
{
    *s = (1.0 - f->b) * u;
    return u;
}

/* g0 + p g1 + p^2 g2 over (1 + p/w)^3; g1 is times w, g2 times w^2. */
static double chain(const hand_filter *f, double s[3], double g0, double g1, double g2)
{
    const double off = f->bend * g1, d = g2 - 2.0 * f->bend * g0, more = d + 3.0 * off;
    double y = stage(f, &s[2], g0 - g1 + d + off);

    y = stage(f, &s[1], y + g1 - d - more);
    return stage(f, &s[0], y + more) - off;
}

/* The same at rest. */
static double still(const hand_filter *f, double s[3], double g0, double g1, double g2)
{
    const double off = f->bend * g1, d = g2 - 2.0 * f->bend * g0, more = d + 3.0 * off;
    double y = steady(f, &s[2], g0 - g1 + d + off);

    y = steady(f, &s[1], y + g1 - d - more);
    return steady(f, &s[0], y + more) - off;
}

void hand_configure(hand_robot *h, double T, double wc)
{
    /* Table 1 of the paper, K and A as chosen for the model */
    const double L = 300e-6, Re = 17.6, k = 3.51e-3, Je = 1.4e-8, fe = 1.19e-5, K = 0.1;
    const double N = 25.0, Js = 0.1, fs = 3e-4, R = 0.005, tau0 = 0.01, A = -4.0;
    const double x = wc * T;
    int j;

    h->f.a = (2.0 - x) / (2.0 + x);
    h->f.b = 0.5 * (1.0 - h->f.a);
    h->f.bend = x * x / 12.0;
    h->half = 0.5 * T;
    h->slope = T / 24.0;
    for (j = 0; j < 2; ++j) {
        hand_drive *d = &h->drive[j];
        /* r1 = g0 + p g1 + p^2 g2, with g0 = U0 - e0 We - s0 Ws - x0 Fx and so on */
        d->e0 = k + Re / k * fe, d->s0 = Re / k * fs / N, d->x0 = Re / k * R / N;
        d->e1 = wc * (Re / k * Je + L / k * fe), d->s1 = wc * (Re / k * Js + L / k * fs) / N;
        d->x1 = wc * L / k * R / N;
        d->e2 = wc * wc * L / k * Je, d->s2 = wc * wc * L / k * Js / N;
        /* r2 = We - N Ws - p (load)/(N K), the load with the backlash torque */
        d->n = N, d->p1 = wc * fs / (N * K), d->p2 = wc * wc * Js / (N * K);
        d->px = wc * R / (N * K), d->pw = wc * A * tau0;
        d->ge = 1.0 / (4.0 * tau0), d->gs = N / (4.0 * tau0);
        d->age1 = d->age2 = 0;
    }
    h->age3 = 0;
    h->settle3 = (unsigned)(11.3 / x);
    h->settle1 = (unsigned)(6.9 / x);
}

static void first(hand_robot *h, const hand_samples *s, int j)
{
    hand_drive *d = &h->drive[j];
    const double We = s->We[j], Ws = s->Ws[j], Fx = s->Fx[j];
    const double rate = d->ge * We - d->gs * Ws;

    s->r[2 * j] = still(&h->f, d->r1, s->U0[j] - d->e0 * We - d->s0 * Ws - d->x0 * Fx,
        -d->e1 * We - d->s1 * Ws - d->x1 * Fx, -d->e2 * We - d->s2 * Ws);
    s->r[2 * j + 1] = still(&h->f, d->r2, We - d->n * Ws, -d->p1 * Ws - d->px * Fx, -d->p2 * Ws);
    d->q = h->half * rate;
    d->rate1 = d->rate2 = rate;
}

static void next(hand_robot *h, const hand_samples *s, int j)
{
    hand_drive *d = &h->drive[j];
    const double We = s->We[j], Ws = s->Ws[j], Fx = s->Fx[j];
    const double rate = d->ge * We - d->gs * Ws, sum = d->q + h->half * rate;
    const double angle = sum - h->slope * (3.0 * rate - 4.0 * d->rate1 + d->rate2);

    s->r[2 * j] = chain(&h->f, d->r1, s->U0[j] - d->e0 * We - d->s0 * Ws - d->x0 * Fx,
        -d->e1 * We - d->s1 * Ws - d->x1 * Fx, -d->e2 * We - d->s2 * Ws);
    s->r[2 * j + 1] = chain(&h->f, d->r2, We - d->n * Ws,
        d->pw * tanh(angle) - d->p1 * Ws - d->px * Fx, -d->p2 * Ws);
    d->q = sum + h->half * rate;
    d->rate2 = d->rate1;
    d->rate1 = rate;
}

static unsigned older(unsigned age, double sum)
{
    return finite_number(sum) ? age + (age < ~0u) : 0u;
}

void hand_step(hand_robot *h, const hand_samples *s)
{
    int j;

    for (j = 0; j < 2; ++j) {
        hand_drive *d = &h->drive[j];
        const double sum = s->We[j] + s->Ws[j] + s->Fx[j];

        if (d->age1 == 0 || d->age2 == 0) {
            first(h, s, j);
        } else {
            next(h, s, j);
        }
        d->age1 = older(d->age1, sum + s->U0[j] + s->r[2 * j]);
        d->age2 = older(d->age2, sum + s->r[2 * j + 1]);
        s->valid[2 * j] = d->age1 > h->settle3;
        s->valid[2 * j + 1] = d->age2 > h->settle3;
    }
    s->r[4] = h->age3 ? stage(&h->f, &h->r3, s->Uin - s->Us)
                      : steady(&h->f, &h->r3, s->Uin - s->Us);
    h->age3 = older(h->age3, s->Uin + s->Us + s->r[4]);
    s->valid[4] = h->age3 > h->settle1;
}
