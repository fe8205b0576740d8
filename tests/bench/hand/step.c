/*
 * step.c: the robot's five residuals through the same filter, written by hand.
 *
 * The yardstick for the generated step. Both drives and the cable, each residual r/(1 + p/wc)^n
 * as one chain of first-order stages; the backlash angle by the trapezoid rule. It promises what
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
    const double y = *s + f->b0 * u;

    *s = f->a * y + f->b1 * u;
    return y;
}

static double steady(const hand_filter *f, double *s, double u)
{
    *s = (1.0 - f->b0) * u;
    return u;
}

void hand_configure(hand_robot *h, double T, double wc)
{
    /* Table 1 of the paper, K and A as chosen for the model */
    const double L = 300e-6, Re = 17.6, k = 3.51e-3, Je = 1.4e-8, fe = 1.19e-5, K = 0.1;
    const double N = 25.0, Js = 0.1, fs = 3e-4, R = 0.005, tau0 = 0.01, A = -4.0;
    const double x = wc * T, e = (1.0 - exp(-x)) / x;
    int j;

    h->f.a = exp(-x);
    h->f.b0 = 1.0 - e;
    h->f.b1 = e - h->f.a;
    h->half = 0.5 * T;
    for (j = 0; j < 2; ++j) {
        hand_drive *d = &h->drive[j];
        /* r1 = g0 + p g1 + p^2 g2, with g0 = U0 - e0 We - s0 Ws - x0 Fx and so on */
        const double e0 = k + Re / k * fe, s0 = Re / k * fs / N, x0 = Re / k * R / N;
        const double e1 = wc * (Re / k * Je + L / k * fe), s1 = wc * (Re / k * Js + L / k * fs) / N;
        const double x1 = wc * L / k * R / N;
        const double e2 = wc * wc * L / k * Je, s2 = wc * wc * L / k * Js / N;
        /* r2 = We - N Ws - p (load)/(N K), the load with the backlash torque */
        const double p1 = wc * fs / (N * K), p2 = wc * wc * Js / (N * K), px = wc * R / (N * K);

        d->e3 = e0 - e1 + e2, d->s3 = s0 - s1 + s2, d->x3 = x0 - x1;
        d->e2 = e1 - 2.0 * e2, d->s2 = s1 - 2.0 * s2, d->x2 = x1;
        d->e1 = e2, d->s1 = s2;
        d->p3 = N - p1 + p2, d->p2 = p1 - 2.0 * p2, d->p1 = p2;
        d->px = px, d->pw = wc * A * tau0;
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
    double y;

    y = steady(&h->f, &d->r1[2], s->U0[j] - d->e3 * We - d->s3 * Ws - d->x3 * Fx);
    y = steady(&h->f, &d->r1[1], y - d->e2 * We - d->s2 * Ws - d->x2 * Fx);
    s->r[2 * j] = steady(&h->f, &d->r1[0], y - d->e1 * We - d->s1 * Ws);
    d->q = h->half * (d->ge * We - d->gs * Ws);
    y = steady(&h->f, &d->r2[2], We - d->p3 * Ws + d->px * Fx);
    y = steady(&h->f, &d->r2[1], y - d->p2 * Ws - d->px * Fx);
    s->r[2 * j + 1] = steady(&h->f, &d->r2[0], y - d->p1 * Ws);
}

static void next(hand_robot *h, const hand_samples *s, int j)
{
    hand_drive *d = &h->drive[j];
    const hand_filter *f = &h->f;
    const double We = s->We[j], Ws = s->Ws[j], Fx = s->Fx[j];
    const double rate = h->half * (d->ge * We - d->gs * Ws);
    const double angle = d->q + rate;
    double y, w;

    y = stage(f, &d->r1[2], s->U0[j] - d->e3 * We - d->s3 * Ws - d->x3 * Fx);
    y = stage(f, &d->r1[1], y - d->e2 * We - d->s2 * Ws - d->x2 * Fx);
    s->r[2 * j] = stage(f, &d->r1[0], y - d->e1 * We - d->s1 * Ws);
    d->q = angle + rate;
    w = d->pw * tanh(angle);
    y = stage(f, &d->r2[2], We - d->p3 * Ws + d->px * Fx - w);
    y = stage(f, &d->r2[1], y - d->p2 * Ws - d->px * Fx + w);
    s->r[2 * j + 1] = stage(f, &d->r2[0], y - d->p1 * Ws);
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
