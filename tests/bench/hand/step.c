/*
 * step.c: the robot's five residuals through the same filter, written by hand.
 *
 * The yardstick for the generated step, with every trick that its author knows. Both drives and the
 * cable, each residual r/(1 + p/wc)^n as one chain of first-order stages by the trapezoid rule, less
 * what that rule is off by; the backlash angle by the implicit rule of Adams over four samples, and
 * tanh by a quotient of polynomials that is right to 1e-8. It promises what the generated code
 * promises: a sample that is not finite starts a residual anew, and no other one, and a residual is
 * valid only when its filter has settled.
 */
#include "step.h"

#include <float.h>

typedef struct gains {
    double a, b;
} gains;

static int finite_number(double x)
{
    return x >= -DBL_MAX && x <= DBL_MAX;
}

static inline double stage(gains g, double *s, double u)
{
    const double w = g.b * u, y = *s + w;

    *s = g.a * y + w;
    return y;
}

/* On its first sample a stage takes all of it, and remembers that as if it had always been so. */
static inline gains begin(const hand_filter *f, unsigned age, double *s, int stages)
{
    gains g = {f->a, f->b};

    if (age == 0u) {
        g.a = -f->b;
        g.b = 1.0;
        while (stages > 0) {
            s[--stages] = 0.0;
        }
    }
    return g;
}

/* g0 + p g1 - p^2 g2 over (1 + p/w)^3; g1 is times w, g2 times w^2. */
static inline double chain(gains g, double bend, double s[3], double g0, double g1, double g2)
{
    const double off = bend * g1, d = g2 + 2.0 * bend * g0;
    const double low = off - d, more = low + off, high = g1 - low;
    double y = stage(g, &s[2], g0 - high);

    y = stage(g, &s[1], y + high - more);
    return stage(g, &s[0], y + more + off) - off;
}

static double quick_tanh(double x)
{
    const double z = x * x;

    if (z > 92.16) {
        return x < 0.0 ? -1.0 : 1.0;
    }
    return x * (((((0.0121918445997 * z + 38.3188174726) * z + 14915.8926299) * z + 1581360.68088)
        * z + 50661031.066) * z + 359943924.938) / (((((z + 909.519092296) * z + 178021.202073) * z
        + 10469617.8247) * z + 170642338.756) * z + 359943925.083);
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
    for (j = 0; j < 2; ++j) {
        hand_drive *d = &h->drive[j];
        /* r1 = g0 + p g1 + p^2 g2, with g0 = U0 - e0 We - s0 Ws - x0 Fx and so on */
        d->e0 = k + Re / k * fe, d->s0 = Re / k * fs / N, d->x0 = Re / k * R / N;
        d->e1 = wc * (Re / k * Je + L / k * fe), d->s1 = wc * (Re / k * Js + L / k * fs) / N;
        d->x1 = wc * L / k * R / N;
        d->e2 = wc * wc * L / k * Je, d->s2 = wc * wc * L / k * Js / N;
        /* r2 = We - N Ws - p (load)/(N K), the load with the backlash torque, without fs Ws, which
         * nobody sees at this rate */
        d->n = N, d->p2 = wc * wc * Js / (N * K), d->px = wc * R / (N * K), d->pw = wc * A * tau0;
        d->ge = T / 24.0 / (4.0 * tau0), d->gs = T / 24.0 * N / (4.0 * tau0);
        d->age1 = d->age2 = 0;
    }
    h->age3 = 0;
    h->settled = 0;
    h->settle3 = (unsigned)(11.3 / x);
    h->settle1 = (unsigned)(6.9 / x);
}

static inline void drive(const hand_filter *f, hand_drive *d, const hand_samples *s, int j)
{
    const double We = s->We[j], Ws = s->Ws[j], Fx = s->Fx[j], bend = f->bend;
    const double rate = d->ge * We - d->gs * Ws;
    double w;

    s->r[2 * j] = chain(begin(f, d->age1, d->r1, 3), bend, d->r1,
        s->U0[j] - d->e0 * We - d->s0 * Ws - d->x0 * Fx, -d->e1 * We - d->s1 * Ws - d->x1 * Fx,
        d->e2 * We + d->s2 * Ws);
    if (d->age2 == 0u) {
        d->q = -12.0 * rate;
        d->rate1 = d->rate2 = rate;
    }
    w = quick_tanh(d->q + 9.0 * rate + 4.0 * d->rate1 - d->rate2);
    d->q += 24.0 * rate;
    d->rate2 = d->rate1;
    d->rate1 = rate;
    s->r[2 * j + 1] = chain(begin(f, d->age2, d->r2, 3), bend, d->r2, We - d->n * Ws,
        d->pw * w - d->px * Fx, d->p2 * Ws);
}

/* The age and the validity of one residual; whether it is valid. */
static int older(unsigned *age, unsigned settle, double *r, int *valid)
{
    if (finite_number(*r)) {
        *age += *age < ~0u;
    } else {
        *age = 0u;
        *r = 0.0;
    }
    *valid = *age > settle;
    return *valid;
}

static void settle(hand_robot *h, const hand_samples *s)
{
    int j, all = older(&h->age3, h->settle1, &s->r[4], &s->valid[4]);

    for (j = 0; j < 2; ++j) {
        hand_drive *d = &h->drive[j];

        all &= older(&d->age1, h->settle3, &s->r[2 * j], &s->valid[2 * j]);
        all &= older(&d->age2, h->settle3, &s->r[2 * j + 1], &s->valid[2 * j + 1]);
    }
    h->settled = all;
}

void hand_step(hand_robot *h, const hand_samples *s)
{
    double *r = s->r;
    int *valid = s->valid;

    drive(&h->f, &h->drive[0], s, 0);
    drive(&h->f, &h->drive[1], s, 1);
    r[4] = stage(begin(&h->f, h->age3, &h->r3, 1), &h->r3, s->Uin - s->Us);
    if (h->settled && finite_number(r[0] + r[1] + r[2] + r[3] + r[4])) {
        valid[0] = valid[1] = valid[2] = valid[3] = valid[4] = 1; /* ages may stand still */
    } else {
        settle(h, s);
    }
}
