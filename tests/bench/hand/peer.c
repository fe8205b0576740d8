/* peer.c: run the step of another generator on the samples of main.c; `peer STEPS`. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "numbers.h"
#include "signals.h"

enum { STATES = 19, DRIVE = 9, Q = 6 }; /* as in chain.py: q, then both rates before it */

/* In code made by the other generator; numbers as in chain.py. */
void peer_step(const double *c, const double *x, double *next, const double *s, double *r);

static void sample(long n, double out[10])
{
    hand_samples s;
    int j;

    signals(0.001 * (double)(n % 64), &s);
    for (j = 0; j < 2; ++j) {
        const double own[] = {s.U0[j], s.We[j], s.Ws[j], s.Fx[j]};

        memcpy(out + 4 * j, own, sizeof own);
    }
    out[8] = s.Uin, out[9] = s.Us;
}

int main(int count, char **words)
{
    const long steps = count > 1 ? atol(words[1]) : 10;
    static double x[2][STATES];
    double s[10], r[5];
    long n;
    int j;

    sample(0, s); /* the backlash starts at rest on the first sample */
    peer_step(coefficients, x[0], x[1], s, r);
    memset(x[0], 0, sizeof x[0]);
    for (j = 0; j < 2; ++j) {
        double *q = x[0] + j * DRIVE + Q;

        q[1] = q[2] = x[1][j * DRIVE + Q + 1];
        q[0] = -12.0 * q[1];
    }
    for (n = 0; n < steps; ++n) {
        sample(n, s);
        peer_step(coefficients, x[n % 2], x[(n + 1) % 2], s, r);
    }
    for (n = 0; n < 5; ++n) {
        printf("%.12g\n", r[n]);
    }
    return 0;
}
